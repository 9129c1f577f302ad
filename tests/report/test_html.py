"""The HTML report: well formed, self-contained, accessible, escaped; its numbers are the analysis'."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest

import conveyor
from conveyor.checks import governing_by_subject
from conveyor.errors import InputError
from conveyor.report import html
from conveyor.report.page_elements import COLOURS, DARK
from conveyor.results.analysis import analyse_studies
from conveyor.units import sentences
from conveyor.units.presentation import display_unit
from tests.report.checking import checks
from tests.report.reading import HOSTILE, Page

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
LARGEST = 600_000  # bytes of a report
CONTRAST = 4.5  # WCAG 2.2, 1.4.3, normal text
GRAPHIC_CONTRAST = 3.0  # WCAG 2.2, 1.4.11


@pytest.fixture(scope="module")
def line():
    plain = conveyor.load(SPECS / "in_plant_us.yaml")
    return plain.replace(
        report={"units": "SI"},
        cases=[
            {"name": "full", "loading": "full", "temperatures": ["10 degC", "30 degC"]},
            {"name": "half", "loading": "part load", "share": "50 %", "speeds": ["500 fpm", "600 fpm"]},
        ],
        uncertainty={"roll_drag": "30 %", "temperature": "5 K"},
        operation={
            "price": "0.1 USD/kWh",
            "duty": [{"hours": "3000 h", "share": "100 %"}, {"hours": "500 h", "share": "0 %"}],
        },
    )


@pytest.fixture(scope="module")
def studied(line):
    return analyse_studies(line)


@pytest.fixture(scope="module")
def result(line, studied):
    return conveyor.analyse(line).at_common_take_up(studied)


@pytest.fixture(scope="module")
def text(result, studied):
    return str(html.build_page(result.contents(studied)))


@pytest.fixture(scope="module")
def page(text):
    return Page(text)


@pytest.fixture(scope="module")
def comparison(line):
    return conveyor.compare_compounds(
        line.replace(cases=[], uncertainty=None),
        ["standard-cover", "low-rolling-resistance-cover"],
        temperatures=["0 degC", "20 degC"],
        speeds=["550 fpm", "600 fpm"],
        extra_costs={"low-rolling-resistance-cover": 1000.0},
    )


@pytest.fixture(scope="module")
def compared(comparison):
    return str(html.build_page(comparison.contents()))


@pytest.fixture(scope="module", params=["analysis", "comparison"])
def either(request, text, compared):
    return text if request.param == "analysis" else compared


def test_every_tag_is_closed_and_every_identifier_unique(either):
    found = Page(either)
    assert found.faults == []
    names = [attributes["id"] for _, attributes in found.tags if "id" in attributes]
    assert len(names) == len(set(names))


def test_the_parser_finds_faults():
    assert Page("<p><b>x</p></b>").faults
    assert Page("<p>x").faults == ["p is not closed"]


def test_every_reference_is_inside_the_page(either):
    found = Page(either)
    names = {attributes["id"] for _, attributes in found.tags if "id" in attributes}
    links = [value for _, attributes in found.tags for key, value in attributes.items() if key == "href"]
    links += re.findall(r"url\(([^)]*)\)", either)
    assert links
    assert {link.removeprefix("#") for link in links} <= names
    for key in ("aria-labelledby", "aria-describedby"):
        assert {a[key] for _, a in found.tags if key in a} <= names


def test_nothing_is_fetched_and_nothing_runs(either):
    found = Page(either)
    tags = {tag for tag, _ in found.tags}
    assert not tags & {"script", "link", "img", "iframe", "object", "embed", "image"}
    assert not [key for _, attributes in found.tags for key in attributes if key == "src" or key.startswith("on")]
    outside = re.findall(r"https?://[^\s\"'<]+", either)
    assert set(outside) <= {"http://www.w3.org/2000/svg"}
    assert "@import" not in either


def test_small_enough(text, compared):
    assert len(text.encode()) < LARGEST
    assert len(compared.encode()) < LARGEST


def test_headings_in_order(either):
    levels = [int(tag[1]) for tag, _ in Page(either).tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_language_title_and_width_of_phones(either, line):
    found = Page(either)
    assert found.of("html")[0]["lang"] == "en"
    assert line.name in next(data for tag, data in found.texts if tag == "title")
    assert {"name": "viewport", "content": "width=device-width, initial-scale=1"} in found.of("meta")


def test_every_header_says_what_it_heads_and_every_figure_what_it_shows(either):
    found = Page(either)
    assert {attributes.get("scope") for attributes in found.of("th")} == {"col", "row"}
    assert len(found.of("caption")) == len(found.of("table"))
    drawings = found.of("svg")
    assert drawings
    for attributes in drawings:
        assert attributes["role"] == "img"
        assert len(attributes["aria-label"]) > 20
    scrolling = [a for a in found.of("div") if "scroll" in a.get("class", "")]
    assert all(a["tabindex"] == "0" and a["role"] == "group" and a["aria-label"] for a in scrolling)
    assert len(scrolling) == len(drawings) + len(found.of("table"))


def test_columns_of_every_row(either):
    """As many cells in a row as headers above it."""
    for whole in re.findall(r"<table>.*?</table>", either, re.DOTALL):
        rows = [Page(f"<table>{row}</table>") for row in re.findall(r"<tr>.*?</tr>", whole, re.DOTALL)]
        counts = {len(row.of("th")) + len(row.of("td")) for row in rows}
        assert len(counts) == 1


def luminance(colour):
    """Relative luminance of "#RRGGBB" (WCAG 2.2)."""
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def test_contrast_itself():
    assert contrast("#000000", "#FFFFFF") == pytest.approx(21.0)
    assert contrast("#777777", "#FFFFFF") == pytest.approx(4.48, abs=0.005)  # the well-known grey that just fails


def test_contrast_of_every_text(text):
    """Every colour of text on the ground its rule gives it, else on every ground that may lie below."""
    style = re.search(r"<style>(.*?)</style>", text, re.DOTALL)[1]
    light, dark = (dict(re.findall(r"--([\w-]+): (#\w+);", roots)) for roots in re.findall(r":root \{([^}]*)\}", style))
    assert (light, dark) == (COLOURS, DARK)
    rules = re.findall(r"([^{}]+)\{([^{}]*)\}", style)
    pairs = []
    for selector, body in rules:
        ink = re.search(r"(?<![-\w])color: var\(--([\w-]+)\)", body)
        ground = re.search(r"background: var\(--([\w-]+)\)", body)
        if ink is not None:
            grounds = ["paper", "pale"] if ground is None else [ground[1]]
            pairs += [(selector.strip(), ink[1], each) for each in grounds]
    assert len(pairs) > 10
    for colours in (light, dark):
        for selector, ink, ground in pairs:
            assert contrast(colours[ink], colours[ground]) >= CONTRAST, (selector, ink, ground)


def test_contrast_in_figures(either):
    """Letters as text, lines that mean something as graphics."""
    drawings = re.findall(r"<svg.*?</svg>", either, re.DOTALL)
    seen = 0
    for drawing in drawings:
        for attributes in Page(drawing).of("text"):
            fill = re.search(r"fill: (#\w{6})", attributes["style"])
            assert contrast(fill[1] if fill else "#000000", "#FFFFFF") >= CONTRAST
        curves = [a["style"] for a in Page(drawing).of("path") if "stroke-width: 1.6" in a.get("style", "")]
        seen += len(curves)
        for style in curves:
            assert contrast(re.search(r"stroke: (#\w{6})", style)[1].upper(), "#FFFFFF") >= GRAPHIC_CONTRAST
    assert seen >= 4


def test_curves_differ_without_colour(text):
    """Of the curves of the tension diagram no two have the same dashes."""
    drawing = next(d for d in re.findall(r"<svg.*?</svg>", text, re.DOTALL) if "Tension round the loop" in d)
    styles = {
        style
        for a in Page(drawing).of("path")
        if "stroke: #" in (style := a.get("style", "")) and "stroke-width: 1.6" in style
    }
    dashes = [re.search(r"stroke-dasharray: [^;]*", style) for style in styles]
    assert len(dashes) == 5
    assert len({found[0] if found else "solid" for found in dashes}) == 5


def test_verdicts_are_words(result, page, studied):
    words = [check.verdict for check in checks(result, "SI", studied)]
    table = page.prose.split("Calculated against required")[1].split("Warnings")[0]
    for word in ("pass", "FAIL", "not checked"):
        assert table.count(f" {word} ") == words.count(word)


def test_numbers_are_those_of_the_analysis(result, page, studied):
    for figure in result.tables["results"].rows:
        assert figure.unit("SI").written(figure.value) in page.prose
    for row in result.stretches:
        assert display_unit("force").written(row.total) in page.prose
    for remark in (*result.contents(studied).lines("warning"), *result.assumptions):
        assert remark in page.prose
    # the belt loaded on its incline alone rolls back with more than the full one: its level feed holds
    (asked,) = (one.required for one in result.checks if one.key == "holding_brake")
    (worst,) = (one.required for one in governing_by_subject(studied.states.checks) if one.key == "holding_brake")
    assert worst > asked
    assert f"needs a backstop of {sentences.format_figure(worst, 'force')} at the belt" in page.prose


def test_numbers_as_in_the_workbook():
    assert display_unit("power").written(-1234560.0) == "-1,234.6"
    assert display_unit("power").written(-0.04) == "0.0"
    assert display_unit("length").written(float("inf")) == "∞"
    assert display_unit("share").written(-0.1169) == "-11.7 %"
    assert display_unit("count").written(2) == "2"


def test_parts_follow_what_was_studied(result, text):
    asked = {"load-cases", "duty", "uncertainty"}
    assert asked <= set(re.findall(r'<h2 id="([\w-]+)"', text))
    plain = re.findall(r'<h2 id="([\w-]+)"', str(html.build_page(result.contents())))
    assert not asked & set(plain)
    needed = ["key-figures", "checks", "warnings", "resistances", "route", "tensions", "rolls", "rubber"]
    needed += ["start-stop", "belt", "assumptions", "inputs", "provenance"]
    assert [name for name in plain if name in needed] == needed


def test_us_units(result):
    prose = Page(str(html.build_page(result.contents(system="US")))).prose
    power = f"{result.summary['motor power [kW]'] * 1e3 / 745.69987158227022:,.1f}"  # 550 ft lbf/s
    assert f"{power}   hp" in prose or f"{power} hp" in re.sub(r"\s+", " ", prose)
    assert " [N] " not in prose.split("Inputs")[0]
    assert not re.findall(r"\[(?:kN|N|kW|MPa|m|m/s)\]", prose.split("Inputs")[0])
    assert {"force [lbf]", "tension [lbf]", "pressure [psi]"} <= set(re.findall(r"\w+ \[\w+\]", prose))


@pytest.fixture(scope="module")
def hostile(line):
    sections = [section.replace(name=f"{HOSTILE.strip()}{i}") for i, section in enumerate(line.route.sections)]
    named = line.replace(
        name=HOSTILE.strip(),
        notes=f"{HOSTILE}\n</style></body>\x07",
        route=line.route.replace(sections=sections),
        cases=[],
        uncertainty=None,
    )
    return conveyor.analyse(named)


def test_hostile_names_are_text(hostile):
    made = str(html.build_page(hostile.contents()))
    found = Page(made)
    assert found.faults == []
    assert "script" not in {tag for tag, _ in found.tags}
    assert "alert('x')" in found.prose
    assert "\u202e" not in made
    assert "\x07" not in made
    shown = Page(hostile._repr_html_())
    assert shown.faults == []
    assert "script" not in {tag for tag, _ in shown.tags}


def test_hostile_name_in_a_figure_stays_text():
    """matplotlib reads "$" as a formula and refuses half of them; a missing glyph is the browser's matter."""
    from conveyor.report.plots import stacked_axes
    from conveyor.report.svg import figure_svg

    figure, (axis,) = stacked_axes()
    axis.plot([0, 1], [0, 1], label="a $\\frac{1$ <b> 皮带")
    axis.set_title("$\\broken{$")
    axis.legend()
    drawn = figure_svg(figure, "f", 'a "curve" <of> & more')
    found = Page(drawn)
    assert found.faults == []
    assert "a $\\frac{1$ <b> 皮带" in found.prose
    assert found.of("svg")[0]["aria-label"] == 'a "curve" <of> & more'


def test_written_whole_or_not_at_all(result, tmp_path, monkeypatch):
    path = tmp_path / "report.html"
    assert result.to_html(path) == path
    before = path.read_bytes()
    assert before.startswith(b"<!DOCTYPE html>")

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_bytes", full)
        with pytest.raises(InputError, match=r"cannot be written .No space left"):
            result.to_html(path)
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["report.html"]


def test_refused_paths(result, comparison, tmp_path):
    with pytest.raises(InputError, match=r"ends in \.html"):
        result.to_html(tmp_path / "report.pdf")
    with pytest.raises(InputError, match="folder does not exist"):
        comparison.to_html(tmp_path / "none" / "report.html")
    (tmp_path / "a.html").mkdir()
    with pytest.raises(InputError, match="is a folder"):
        result.to_html(tmp_path / "a.html")
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.html"]


def test_comparison_holds_the_ranking(comparison, compared, tmp_path):
    prose = Page(compared).prose
    for _, row in comparison.ranking.iterrows():
        assert row["compound"] in prose
        assert f"{row['mean motor power [kW]']:,.1f}" in prose
    path = comparison.to_html(tmp_path / "c.html", system="US")
    assert "[hp]" in path.read_text(encoding="utf-8")
