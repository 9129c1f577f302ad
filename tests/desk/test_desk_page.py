"""The page of the desk in a real Chromium: drag, error, undo, save, compare, print, phone."""

from __future__ import annotations

import re
import shutil
import threading
import time
from pathlib import Path

import pytest

import conveyor
from conveyor.desk.workbench import open_workbench
from conveyor.errors import InputError
from conveyor.models.fields import with_fields
from conveyor.studies.loads import every_load
from conveyor.text.markup import element

playwright = pytest.importorskip("playwright.sync_api", reason="needs the package playwright")
pytest.importorskip("starlette")
desk_server = pytest.importorskip("conveyor.desk.desk_server")

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")

SPECS = Path("examples/specs").resolve()
FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-quic", "--no-first-run"]
PASSWORD = "correct horse battery"  # noqa: S105 of a test
AXE = next(iter(sorted(Path("node_modules/axe-core").resolve().glob("axe.min.js"))), None)
"""Rules of axe-core, from `npm install --no-save axe-core` in the checkout."""
FAULTS = (Path(__file__).parent / "page_faults.js").read_text(encoding="utf-8").partition("\n")[2]
"""What a screen reader or a keyboard would miss on a page."""
SPEED = "#sliders input[data-path='belt.speed']"


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        made = started.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield made
        made.close()


@pytest.fixture
def server(tmp_path):
    for name in ("overland.yaml", "downhill.yaml"):
        shutil.copy(SPECS / name, tmp_path / name)
    made = desk_server.DeskServer(open_workbench([tmp_path / "overland.yaml", tmp_path / "downhill.yaml"], ()))
    thread = threading.Thread(target=made.run)
    thread.start()
    yield made
    made.stop()
    thread.join()


@pytest.fixture
def page(browser, server):
    """A page with its first figures; every request to another host, and every error of the script, fails the test."""
    context = browser.new_context(viewport={"width": 1440, "height": 900})
    made = context.new_page()
    made.set_default_timeout(30_000)
    faults, asked = [], []
    made.on("pageerror", lambda error: faults.append(str(error)))
    made.on(
        "console", lambda said: faults.append(said.text) if said.type == "error" and "422" not in said.text else None
    )
    made.on("request", lambda request: asked.append(request.url))
    made.goto(server.guard.address)
    made.wait_for_selector("#answer:not([hidden])")
    yield made
    context.close()
    assert faults == []
    own = f"http://127.0.0.1:{server.port}/"
    assert [url for url in asked if not url.startswith((own, "data:", "blob:"))] == []


def kilowatts(page) -> float:
    return float(page.inner_text("[data-part=power] .large b").replace(",", ""))


def wait_until(page, script: str, seconds: float = 30.0) -> None:
    """Wait for a condition of the page; Playwright's own way is eval, which the page forbids."""
    end = time.monotonic() + seconds
    while not page.evaluate(script):
        assert time.monotonic() < end, script
        page.wait_for_timeout(30)


def set_speed(page, text: str) -> None:
    page.fill(SPEED, text)
    page.press(SPEED, "Enter")


def test_a_drag_asks_for_the_newest_value_and_skips_the_others(page):
    before = kilowatts(page)
    asked, held, flying, most = [], [], set(), []

    def begin(request):
        if request.url.endswith("/answer"):
            asked.append(request.post_data_json)
            flying.add(request)
            most.append(len(flying))

    def end(request):
        flying.discard(request)

    def hold(route):
        """Keep the first value from an answer until the drag has ended."""
        held.append(route)
        if len(held) > 1:
            route.continue_()

    page.on("request", begin)
    page.on("requestfinished", end)
    page.on("requestfailed", end)
    page.route("**/answer", hold)
    box = page.locator("[data-range='belt.speed']").bounding_box()
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + box["width"] / 2, y)
    page.mouse.down()
    for step in range(1, 31):
        page.mouse.move(box["x"] + box["width"] / 2 + step * 3, y)
    page.mouse.up()
    shown = page.input_value(SPEED)
    held[0].continue_()
    wait_until(page, f"document.querySelector('#command').textContent.includes('belt.speed={shown}')")
    wait_until(page, "!document.querySelector('#answer').classList.contains('waiting')")
    assert len(asked) == 2
    assert max(most) == 1
    assert asked[-1]["changes"] == {"belt.speed": shown}
    assert kilowatts(page) > before
    page.keyboard.press("Escape")
    page.click("#undo")  # the whole drag is one step
    wait_until(page, "document.querySelector('#changed').hidden")
    assert page.input_value(SPEED) == "5 m/s"


def test_a_wrong_value_says_so_at_its_field_and_loses_nothing(page):
    before = kilowatts(page)
    set_speed(page, "90 m/s")
    page.wait_for_selector("#answer.stale")
    assert "<= 20 m/s" in page.inner_text("[data-error='belt.speed']")
    assert page.get_attribute(SPEED, "aria-invalid") == "true"
    assert kilowatts(page) == before
    page.click("#alerts button")
    assert page.evaluate("document.activeElement.dataset.path") == "belt.speed"
    set_speed(page, "5.5 m/s")
    page.wait_for_selector("#answer:not(.stale)")
    assert page.inner_text("#alerts") == ""
    assert page.get_attribute(SPEED, "aria-invalid") is None
    assert kilowatts(page) > before


def test_undo_redo_and_the_address_bar_hold_the_state(page):
    before = kilowatts(page)
    set_speed(page, "6 m/s")
    wait_until(page, "document.querySelector('#command').textContent.includes('6 m/s')")
    fast = kilowatts(page)
    page.locator("body").click(position={"x": 700, "y": 5})
    page.keyboard.press("Control+z")
    wait_until(page, "!document.querySelector('#command').textContent.includes('--set')")
    assert kilowatts(page) == before
    page.keyboard.press("Control+y")
    wait_until(page, "document.querySelector('#command').textContent.includes('6 m/s')")
    assert "a%3Abelt.speed=6+m%2Fs" in page.url
    page.reload()
    page.wait_for_selector("#answer:not([hidden])")
    assert kilowatts(page) == pytest.approx(fast, rel=1e-3)  # four digits are shown
    assert page.input_value(SPEED) == "6 m/s"


def test_saving_shows_the_difference_and_undo_goes_back_behind_it(page, tmp_path):
    set_speed(page, "5.5 m/s")
    page.click("#save summary")
    page.click("[data-save=spec]")
    page.wait_for_selector("#diff .add")
    assert page.inner_text("#diff .del").strip() == "-  speed: 5 m/s"
    assert page.inner_text("#diff .add").strip() == "+  speed: 5.5 m/s"
    page.click("#dosave")
    wait_until(page, "document.querySelector('#foot').textContent.startsWith('Saved overland.yaml')")
    before = (SPECS / "overland.yaml").read_bytes()
    assert (tmp_path / "overland.yaml").read_bytes() == before.replace(b"speed: 5 m/s", b"speed: 5.5 m/s", 1)
    assert not page.is_visible("#changed")
    page.click("#undo")
    wait_until(page, "document.querySelector('#command').textContent.includes('belt.speed=5 m/s')")
    assert page.input_value(SPEED) == "5 m/s"


def test_two_variants_stand_beside_each_other(page):
    page.click("#compare")
    set_speed(page, "4 m/s")
    page.wait_for_selector("[data-part=verdict] .fail")
    assert page.is_visible("#comparison")
    assert "filling of the belt" in page.inner_text("[data-part=compared]")
    assert "against A" in page.inner_text("[data-part=power]")
    verdicts = page.locator(".verdicts .stands")
    assert verdicts.count() == 2
    page.click("text=Names")
    page.fill("[aria-label='Name of variant B']", "slow")
    page.press("[aria-label='Name of variant B']", "Enter")
    wait_until(page, "document.querySelector('[data-part=verdict] .variant').textContent === 'slow'")
    page.click("text=Swap")
    wait_until(page, "!document.querySelector('[data-part=verdict] .fail')")
    wait_until(page, "!!document.querySelector('[data-part=verdict_beside] .fail')")
    page.click("text=/^Keep/")
    wait_until(page, "document.querySelector('#comparison').hidden")
    assert page.input_value(SPEED) == "5 m/s"


def test_every_field_is_found_by_its_words_and_changed(page):
    page.fill("#find", "wrap angle")
    page.fill("#fields input[data-path='drive.wrap_angle']", "180 deg")
    page.press("#fields input[data-path='drive.wrap_angle']", "Enter")
    wait_until(page, "document.querySelector('#command').textContent.includes('drive.wrap_angle=180 deg')")
    page.fill("#find", "site")
    page.select_option("#fields select[data-path='site']", "poor")
    wait_until(page, "document.querySelector('#command').textContent.includes('site=poor')")
    page.fill("#find", "nothing is called that")
    assert "No field" in page.inner_text("#fields")


def test_it_is_used_by_keyboard_alone(page):
    page.locator("#file").focus()
    for _ in range(60):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.dataset.range") == "belt.speed":
            break
    else:
        pytest.fail("the slider is not reached by Tab")
    page.keyboard.press("ArrowRight")
    wait_until(page, "document.querySelector('#command').textContent.includes('belt.speed=5.05 m/s')")
    assert page.get_attribute("[data-range='belt.speed']", "aria-valuetext") == "5.05 m/s"


def test_units_change_at_a_click_and_curves_follow(page):
    page.click("#units button[value=US]")
    wait_until(page, "document.querySelector('[data-part=power]').textContent.includes('hp')")
    curve = page.locator("[data-curve='belt.speed'] svg")
    end = time.monotonic() + 60
    while "hp" not in (said := curve.get_attribute("aria-label")) or "passes" not in said:
        assert time.monotonic() < end, said
        page.wait_for_timeout(100)
    line = conveyor.load(SPECS / "overland.yaml")
    speeds = (3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7)
    serve = [v for v in speeds if not every_load(with_fields(line, {"belt.speed": f"{v} m/s"})).failed]
    assert said.endswith(f"every check passes from {serve[0]} to {serve[-1]} m/s")


def test_a_compound_of_the_shelf_is_chosen(page):
    before = kilowatts(page)
    page.select_option("#covers select[data-path='belt.bottom_cover.compound']", "standard-cover")
    wait_until(page, "document.querySelector('#command').textContent.includes('compound=standard-cover')")
    assert kilowatts(page) > before


def test_a_file_is_opened_from_the_page(page):
    page.set_input_files("#upload", SPECS / "shuttle.yaml")
    wait_until(page, "document.querySelector('#file').value === 'shuttle.yaml'")
    wait_until(page, "!document.querySelector('#command').textContent || true")
    page.select_option("#file", "downhill.yaml")
    wait_until(
        page, f"document.querySelector('#title').textContent === '{conveyor.load(SPECS / 'downhill.yaml').name}'"
    )


def test_changes_of_a_file_stay_while_another_is_looked_at(page):
    set_speed(page, "5.5 m/s")
    page.select_option("#file", "downhill.yaml")
    wait_until(page, "document.querySelector('#command').textContent.includes('downhill.yaml')")
    assert not page.is_visible("#changed")
    page.select_option("#file", "overland.yaml")
    wait_until(page, "document.querySelector('#command').textContent.includes('belt.speed=5.5 m/s')")
    page.click("#undo")
    wait_until(page, "!document.querySelector('#command').textContent.includes('--set')")


def test_enter_in_the_name_of_the_file_looks_again_and_does_not_cancel(page):
    page.keyboard.press("Control+s")
    page.fill("#target", "x.txt")
    page.press("#target", "Enter")
    page.wait_for_selector("#saveerror:visible")
    assert page.is_visible("#saver")
    assert page.is_disabled("#dosave")


def test_reports_are_downloaded(page):
    page.click("#save summary")
    with page.expect_download() as found:
        page.click("[data-save=workbook]")
    assert found.value.suggested_filename == "overland.xlsx"
    assert Path(found.value.path()).read_bytes()[:2] == b"PK"


def test_paper_has_the_figures_and_what_was_changed(page):
    set_speed(page, "5.5 m/s")
    wait_until(page, "document.querySelector('#command').textContent.includes('5.5')")
    page.emulate_media(media="print")
    assert not page.is_visible("aside")
    assert not page.is_visible("header")
    assert "belt.speed 5.5 m/s" in page.inner_text(".printed")
    paper = page.pdf(format="A4")
    pypdf = pytest.importorskip("pypdf")
    from io import BytesIO

    read = pypdf.PdfReader(BytesIO(paper))
    text = " ".join(sheet.extract_text() for sheet in read.pages)
    assert len(read.pages) <= 4
    assert re.search(r"belt\.speed 5\.5 m/s", text)
    assert "more that pass" not in text or "holding" in text


def test_a_phone_scrolls_down_only_and_has_the_sliders_near_the_figures(page):
    page.set_viewport_size({"width": 390, "height": 844})
    page.focus("#table")  # its names of figures are long
    page.wait_for_selector("#table option[value=pulleys]", state="attached")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    tops = {
        name: page.locator(place).bounding_box()["y"]
        for name, place in (("power", "[data-part=power]"), ("slider", "#sliders"), ("checks", "[data-part=checks]"))
    }
    assert tops["power"] < tops["slider"] < tops["checks"]
    assert page.locator("[data-range='belt.speed']").bounding_box()["height"] >= 24  # WCAG 2.2, 2.5.8


def test_without_a_spec_it_offers_one_of_each_kind(browser, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    server = desk_server.DeskServer(open_workbench((), ()))
    thread = threading.Thread(target=server.run)
    thread.start()
    context = browser.new_context()
    try:
        page = context.new_page()
        page.goto(server.guard.address)
        page.wait_for_selector("text=in-plant, SI")
        assert page.evaluate(FAULTS) == []
        assert axe_violations(page) == []
        page.click("text=in-plant, SI")
        page.wait_for_selector("#answer:not([hidden])")
        assert kilowatts(page) > 0
        page.keyboard.press("Control+s")
        page.fill("#target", "mine.yaml")
        page.press("#target", "Tab")
        page.wait_for_selector("#dosave:enabled")
        page.click("#dosave")
        wait_until(page, "document.querySelector('#foot').textContent.startsWith('Saved mine.yaml')")
        assert conveyor.load(tmp_path / "mine.yaml").belt_speed > 0
    finally:
        context.close()
        server.stop()
        thread.join()


def test_a_file_changed_in_an_editor_is_read_again(page, tmp_path):
    path = tmp_path / "overland.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("speed: 5 m/s", "speed: 5.2 m/s"), encoding="utf-8")
    page.evaluate("window.dispatchEvent(new Event('focus'))")
    wait_until(page, f"document.querySelector({SPEED!r}.replaceAll('\\\\', '')).value === '5.2 m/s'")
    assert not page.is_visible("#changed")


def test_a_study_that_is_opened_is_made_again_when_the_hand_rests_and_stopped_by_the_next_input(page, monkeypatch):
    def two_seconds(assessment, _, progress):
        for i in range(40):
            progress(i, 40)
            time.sleep(0.05)
        return element("p", f"at {assessment.own.line.speed} m/s")

    monkeypatch.setattr(desk_server, "study_part", two_seconds)
    asked = []
    page.on("request", lambda request: asked.append(request.post_data_json) if "/further" in request.url else None)
    page.click("#offered button")
    wait_until(page, "!!document.querySelector('#further p')")
    assert page.get_attribute("#offered button", "aria-pressed") == "true"
    first = page.inner_text("#further")
    set_speed(page, "5.5 m/s")
    wait_until(page, "!!document.querySelector('#further .old')")
    page.wait_for_selector("#cancel")
    wait_until(page, "!document.querySelector('#progress').hidden")
    set_speed(page, "6 m/s")  # while it is made
    wait_until(page, "!document.querySelector('#further .old')")
    assert [one["changes"] for one in asked] == [{}, {"belt.speed": "5.5 m/s"}, {"belt.speed": "6 m/s"}]
    assert page.inner_text("#further") != first
    set_speed(page, "6.5 m/s")
    page.click("#cancel")
    assert page.get_attribute("#offered button", "aria-pressed") == "false"
    assert page.inner_text("#further") == ""
    set_speed(page, "5 m/s")
    wait_until(page, "document.querySelector('#command').textContent.indexOf('--set') < 0")
    page.wait_for_timeout(1500)
    assert len(asked) == 4  # closed: it is not made again


def test_a_table_that_is_shown_follows_the_design(page):
    asked = []
    page.on("request", lambda request: asked.append(request) if "/table" in request.url else None)
    page.focus("#table")
    page.wait_for_selector("#table option[value=pulleys]", state="attached")
    page.select_option("#table", "pulleys")
    wait_until(page, "!!document.querySelector('#tabled table')")
    first = page.inner_text("#tabled")
    set_speed(page, "6 m/s")
    wait_until(page, "!!document.querySelector('#tabled.old')")
    wait_until(page, "!document.querySelector('#tabled.old')")
    assert page.inner_text("#tabled") != first
    count = len(asked)
    page.evaluate("window.dispatchEvent(new Event('focus'))")
    page.wait_for_timeout(2000)
    assert len(asked) == count  # nothing has changed


def axe_violations(page) -> list[str]:
    """Violations that axe-core finds, with the elements; none where it is not installed."""
    if AXE is None:
        return []
    found = page.evaluate(AXE.read_text(encoding="utf-8") + "; axe.run(document, { resultTypes: ['violations'] })")
    return [f"{one['id']}: {[node['html'] for node in one['nodes']]}" for one in found["violations"]]


def every_state(page):
    """States of a page, each by its name: as opened, unfolded, two variants, phone, a wrong value, saving, print."""
    yield "opened"
    page.fill("#find", "wrap")
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    page.focus("#table")
    page.wait_for_selector("#table option[value=pulleys]", state="attached")
    page.select_option("#table", "pulleys")
    wait_until(page, "!!document.querySelector('#tabled table')")
    yield "unfolded"
    page.click("#compare")
    set_speed(page, "4 m/s")
    page.wait_for_selector("[data-part=verdict] .fail")
    yield "two variants"
    page.set_viewport_size({"width": 390, "height": 844})
    yield "phone"
    page.set_viewport_size({"width": 1440, "height": 900})
    set_speed(page, "90 m/s")
    page.wait_for_selector("#answer.stale")
    yield "wrong value"
    set_speed(page, "4.5 m/s")
    page.wait_for_selector("#answer:not(.stale)")
    page.keyboard.press("Control+s")
    page.locator("#target").wait_for()
    yield "saving"
    page.keyboard.press("Escape")
    page.emulate_media(media="print")
    yield "print"


def test_nothing_is_without_a_name_in_any_state(page):
    faults = {state: page.evaluate(FAULTS) for state in every_state(page)}
    assert {state: found for state, found in faults.items() if found} == {}


@pytest.mark.skipif(AXE is None, reason="no axe-core here: npm install --no-save axe-core")
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing_in_any_state(page, theme):
    page.emulate_media(color_scheme=theme)
    faults = {state: axe_violations(page) for state in every_state(page)}
    assert {state: found for state, found in faults.items() if found} == {}


def test_the_page_of_a_report_has_no_such_fault_either(browser, tmp_path):
    result = conveyor.analyse(conveyor.load(SPECS / "overland.yaml"))
    result.to_html(tmp_path / "report.html")
    for theme in ("light", "dark"):
        context = browser.new_context(color_scheme=theme)
        made = context.new_page()
        made.goto((tmp_path / "report.html").as_uri())
        assert made.evaluate(FAULTS) == []
        assert axe_violations(made) == []
        context.close()


def test_from_another_machine_the_password_opens_it(browser, tmp_path):
    """Through the browser's own form: with an origin, a cookie, and without a secure context."""
    shutil.copy(SPECS / "overland.yaml", tmp_path)
    bench = open_workbench([tmp_path / "overland.yaml"], ())
    try:
        made = desk_server.DeskServer(bench, host="127.0.0.2", password=PASSWORD)
    except InputError:
        bench.close()
        pytest.skip("127.0.0.2 is no address of this machine")
    thread = threading.Thread(target=made.run)
    thread.start()
    context = browser.new_context()
    try:
        page = context.new_page()
        page.set_default_timeout(30_000)
        page.goto(f"http://127.0.0.2:{made.port}/")
        assert page.evaluate(FAULTS) == []
        assert axe_violations(page) == []
        page.fill("input[name=password]", "not this one, no")
        page.click("button")
        assert "This is not the password." in page.inner_text("[role=alert]")
        page.fill("input[name=password]", PASSWORD)
        page.click("button")
        page.wait_for_selector("#answer:not([hidden])")
        assert kilowatts(page) > 0.0
    finally:
        context.close()
        made.stop()
        thread.join()
