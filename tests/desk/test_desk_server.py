"""The desk behind its guard, through Starlette's client: answers, variants, saves, forged requests, two pages."""

from __future__ import annotations

import asyncio
import base64
import json
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

pytest.importorskip("starlette")
pytest.importorskip("httpx2")
from starlette.testclient import TestClient

import conveyor
from conveyor import shelf
from conveyor.desk import desk_server
from conveyor.desk.desk_server import Desk, DeskServer
from conveyor.desk.request_guard import LARGEST_BODY, RequestGuard
from conveyor.desk.stop_signal import CalculationStopped, StopSignal
from conveyor.desk.workbench import open_workbench
from conveyor.dynamics.simulation import standard_scenarios
from conveyor.errors import InputError, NoSolutionError
from conveyor.models.fields import with_fields
from conveyor.report.tables.result_schema import analysis_json
from conveyor.report.tables.study_tables import year_table
from conveyor.results.analysis import analyse, analyse_studies
from conveyor.studies.duty import analyse_duty
from conveyor.studies.loads import every_load
from tests.command_line import run

PORT = 8123
TWICE_RTOL = 2e-4
"""Two calculations, each to the rtol of the contacts in the specs, 1e-4."""
SPECS = Path("examples/specs").resolve()


@pytest.fixture
def folder(tmp_path):
    for name in ("overland.yaml", "downhill.yaml", "shuttle.yaml"):
        shutil.copy(SPECS / name, tmp_path / name)
    return tmp_path


@pytest.fixture
def desk(folder):
    bench = open_workbench([folder / "overland.yaml", folder / "downhill.yaml"], ())
    made = Desk(bench)
    yield made
    made.close()
    bench.close()


def client_of(desk, *, opened=True, **more):
    guard = RequestGuard(desk.app(), PORT, "the-token")
    client = TestClient(guard, base_url=f"http://127.0.0.1:{PORT}", raise_server_exceptions=False, **more)
    if opened:
        assert client.get("/open?token=the-token", follow_redirects=False).status_code == 303
    return client


@pytest.fixture
def client(desk):
    return client_of(desk)


def ask(client, path, **body):
    return client.post(path, json=body)


# ---- the guard


def test_the_opening_address_sets_a_strict_cookie(desk):
    answer = client_of(desk, opened=False).get("/open?token=the-token", follow_redirects=False)
    cookie = answer.headers["set-cookie"]
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert cookie.startswith(f"conveyor_desk_{PORT}=the-token;")


@pytest.mark.parametrize("token", ["", "wrong", "the-toke", "the-token2", "%ff"])
def test_a_wrong_token_opens_nothing(desk, token):
    answer = client_of(desk, opened=False).get(f"/open?token={token}", follow_redirects=False)
    assert answer.status_code == 403
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize("path", ["/", "/desk.js", "/desk.css"])
def test_without_the_cookie_not_even_the_page(desk, path):
    assert client_of(desk, opened=False).get(path).status_code == 403
    assert client_of(desk).get(path).status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", f"evil.example:{PORT}", f"127.0.0.1:{PORT + 1}", ""])
def test_a_forged_host_is_misdirected(client, host):
    assert client.post("/files", json={}, headers={"host": host}).status_code == 421


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", f"https://127.0.0.1:{PORT}", f"http://127.0.0.1:{PORT + 1}"]
)
def test_a_foreign_origin_is_refused(client, origin):
    assert client.post("/files", json={}, headers={"origin": origin}).status_code == 403


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_a_request_from_another_site_is_refused(client, site):
    assert client.get("/desk.js", headers={"sec-fetch-site": site}).status_code == 403


def test_the_own_page_may_ask(client):
    own = {"origin": f"http://127.0.0.1:{PORT}", "sec-fetch-site": "same-origin"}
    assert client.post("/files", json={}, headers=own).status_code == 200
    assert client.post("/files", json={}, headers={"host": f"localhost:{PORT}"}).status_code in {200, 403}


# ---- for an intranet


HOST = "192.0.2.7"
PASSWORD = "long enough, ä"  # noqa: S105 of a test


@pytest.fixture
def shared(desk):
    """A client of a desk on an address of an intranet, before the password."""
    guard = RequestGuard(desk.app(), PORT, "the-token", host=HOST, password=PASSWORD)
    return TestClient(guard, base_url=f"http://{HOST}:{PORT}", raise_server_exceptions=False, follow_redirects=False)


def test_without_the_password_there_is_a_form_and_nothing_else(shared):
    assert shared.get("/").headers["location"] == "/open"
    form = shared.get("/open")
    assert form.status_code == 200
    assert 'type="password"' in form.text
    assert "form-action 'self'" in form.headers["content-security-policy"]
    assert form.headers["referrer-policy"] == "same-origin"  # else a browser sends the form's origin as null
    for path in ("/desk.js", "/desk.css"):
        assert shared.get(path).status_code == 403
    assert shared.post("/files", json={}).status_code == 403
    assert shared.get("/open?token=wrong").status_code == 403


def test_the_password_opens_the_page(shared):
    opened = shared.post("/open", data={"password": PASSWORD}, headers={"origin": f"http://{HOST}:{PORT}"})
    assert (opened.status_code, opened.headers["location"]) == (303, "/")
    assert "SameSite=Strict" in opened.headers["set-cookie"]
    assert shared.get("/").status_code == 200
    assert shared.post("/files", json={}).json()["files"]


def test_wrong_passwords_are_counted(shared):
    for given in ("", "x", PASSWORD[:-1], PASSWORD + "x", "y" * 10000):
        refused = shared.post("/open", data={"password": given})
        assert refused.status_code == 403
        assert "set-cookie" not in refused.headers
        assert "This is not the password." in refused.text
    late = shared.post("/open", data={"password": PASSWORD})
    assert late.status_code == 429
    assert "wait a minute" in late.text
    assert "set-cookie" not in late.headers


def test_an_intranet_forges_no_hosts_or_origins_either(shared):
    for host in (f"evil.example:{PORT}", f"127.0.0.1:{PORT}", f"localhost:{PORT}"):
        assert shared.post("/open", data={"password": PASSWORD}, headers={"host": host}).status_code == 421
    foreign = {"origin": "http://evil.example"}
    assert shared.post("/open", data={"password": PASSWORD}, headers=foreign).status_code == 403


def test_another_host_needs_a_password_and_to_be_of_this_machine(desk):
    with pytest.raises(InputError, match=r"host 192\.0\.2\.7: other machines reach it, so it needs a password"):
        DeskServer(desk.workbench, host=HOST)
    with pytest.raises(InputError, match=r"host 192\.0\.2\.7: no address of this machine"):
        DeskServer(desk.workbench, host=HOST, password=PASSWORD)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--host", "127.0.0.2"], "--host: needs a password: --password-file FILE, or CONVEYOR_DESK_PASSWORD"),
        (["--host", "127.0.0.2", "--password-file", "short"], "short: a password of at least 12 characters, got 5"),
        (["--host", "127.0.0.2", "--password-file", "none"], "none: no such file"),
        (["--password-file", "short"], "--password-file: only --host needs a password"),
    ],
)
def test_what_is_no_password_is_refused(folder, more, said):
    (folder / "short").write_text("abcde\n", encoding="utf-8")
    done = run("desk", "overland.yaml", "--no-browser", *more, cwd=folder)
    assert done.returncode == 2
    assert said in done.stderr


def test_bodies_are_limited_whether_they_say_their_size_or_not(client):
    def pieces():
        for _ in range(LARGEST_BODY // 65536 + 2):
            yield b"x" * 65536

    assert client.post("/drop?name=a.yaml", content=b"x" * (LARGEST_BODY + 1)).status_code == 413
    assert client.post("/drop?name=a.yaml", content=pieces()).status_code == 413


def test_every_answer_tells_the_browser_to_trust_nothing_else(client):
    for answer in (client.get("/"), client.post("/files", json={}), client.get("/nothing")):
        assert "default-src 'none'" in answer.headers["content-security-policy"]
        assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path", ["/../pyproject.toml", "/desk.py", "/page/desk.js", "/%2e%2e/desk_server.py", "/files"]
)
def test_only_the_three_files_of_the_page_are_served(client, path):
    assert client.get(path).status_code in {404, 405}


@pytest.mark.parametrize("body", [b"", b"[]", b"{", b'{"file": 3}', b'{"file": "x.yaml"}', b"[" * 5000])
@pytest.mark.parametrize(
    "path", ["/form", "/answer", "/curves", "/passing", "/save", "/difference", "/report", "/study"]
)
def test_malformed_requests_are_refused_in_words(client, path, body):
    answer = client.post(path, content=body)
    assert answer.status_code == 422
    assert answer.json()["errors"][0]["message"]


# ---- answers


def test_the_answer_has_the_digits_of_power_json(client, folder):
    changes = {"belt.speed": "5.5 m/s", "idlers.carry.spacing": "1.8 m"}
    got = ask(client, "/result", file="overland.yaml", changes=changes).json()
    line = with_fields(conveyor.load(folder / "overland.yaml"), changes)
    result = analyse(line)
    expected = json.loads(json.dumps(analysis_json(result.assess(analyse_studies(line, result)))))

    def compare(one, other, where=""):
        if isinstance(one, dict):
            assert set(one) == set(other), where
            for key in one:
                compare(one[key], other[key], f"{where}.{key}")
        elif isinstance(one, list):
            assert len(one) == len(other), where
            for i, pair in enumerate(zip(one, other, strict=True)):
                compare(*pair, f"{where}[{i}]")
        elif isinstance(one, float) and isinstance(other, float):
            assert one == pytest.approx(other, rel=TWICE_RTOL, abs=1e-9), where
        elif where.rpartition(".")[2] not in {"date", "seconds"}:
            assert one == other, where

    compare(got["power_kW"], expected["power_kW"])
    compare(got["forces_N"], expected["forces_N"])
    assert [c["verdict"] for c in got["checks"]] == [c["verdict"] for c in expected["checks"]]


def test_the_page_shows_the_figures_of_the_report(client):
    got = ask(client, "/answer", file="overland.yaml", changes={}).json()
    kilowatts = ask(client, "/result", file="overland.yaml", changes={}).json()["power_kW"]["motor"]
    assert f"{kilowatts:,.0f}" in got["parts"]["power"]
    assert "Adequate as given" in got["parts"]["verdict"]
    assert got["parts"]["checks"].index("not checked") < got["parts"]["checks"].index("✓")
    assert got["command"] == "conveyor power overland.yaml"


def test_units_change_what_is_shown_and_nothing_else(client):
    si = ask(client, "/answer", file="overland.yaml", changes={}, units="SI").json()["parts"]
    us = ask(client, "/answer", file="overland.yaml", changes={}, units="US").json()["parts"]
    assert "kW" in si["power"]
    assert "hp" in us["power"]
    assert "kW" not in us["power"]
    assert si["checks"].count("<tr>") == us["checks"].count("<tr>")


def test_a_second_variant_is_compared(client):
    got = ask(
        client, "/answer", file="overland.yaml", changes={"belt.speed": "4 m/s"}, beside={}, second=True,
        names=["as built", "slow"],
    ).json()["parts"]  # fmt: skip
    assert "slow against as built" in got["compared"]
    assert "filling of the belt" in got["compared"]  # passes before, fails after
    assert "Not adequate" in got["verdict"]
    assert "Adequate" in got["verdict_beside"]
    assert "as built, steady" in got["tensions"]
    assert "as built" not in got["profile"]  # one route
    one = ask(client, "/result", file="overland.yaml", changes={}).json()["power_kW"]["motor"]
    two = ask(client, "/result", file="overland.yaml", changes={"belt.speed": "4 m/s"}).json()["power_kW"]["motor"]
    assert f"{two - one:,.1f}" in got["compared"]
    assert "[kN]" in got["compared"]
    assert "[N]" not in got["compared"]
    lines = re.findall(r"<tr>.*?</tr>", got["compared"])
    numbers = [tuple(re.findall(r">([^<]*)</td>", line)) for line in lines if "[kN]" in line]
    assert len(numbers) == len(set(numbers)) > 5  # no force twice


def test_a_refusal_names_its_field_and_the_desk_goes_on(client):
    got = ask(client, "/answer", file="overland.yaml", changes={"belt.speed": "90 m/s"})
    assert got.status_code == 422
    assert [error["path"] for error in got.json()["errors"]] == ["belt.speed"]
    assert ask(client, "/answer", file="overland.yaml", changes={}).status_code == 200


def test_the_other_variant_may_be_wrong(client):
    got = ask(client, "/answer", file="overland.yaml", changes={}, beside={"belt.speed": "x"}, second=False).json()
    assert got["beside"][0]["path"] == "belt.speed"
    assert got["parts"]["power"]


def test_markup_in_a_name_stays_text(client):
    got = ask(
        client, "/answer", file="overland.yaml", changes={"name": "<img src=x>"}, beside={}, second=True,
        names=["<script>", "B"],
    ).json()  # fmt: skip
    assert "<script>" not in json.dumps(got["parts"])
    assert "<img" not in json.dumps(got["parts"])


def test_the_own_load_comes_alone_when_asked(client):
    got = ask(client, "/answer", file="overland.yaml", changes={}, every=False).json()
    assert got["every"] is False
    assert set(got["parts"]) == {"power", "shares"}  # what other loads decide is not said before they are known
    own = analyse(conveyor.load(SPECS / "overland.yaml"))
    assert f"{1e-3 * own.balance.power.motor:,.0f}" in got["parts"]["power"]


def test_curves_and_passing_of_a_slider(client):
    body = {"file": "overland.yaml", "changes": {}, "paths": ["belt.speed", "idlers.carry.spacing"]}
    got = client.post("/curves", json=body).json()
    assert (got["unit"], [len(curve) for curve in got["curves"]]) == ("kW", [9, 9])
    at_five = dict(map(tuple, got["curves"][0]))[5.0]
    own = analyse(conveyor.load(SPECS / "overland.yaml"))  # at its own take-up setting, as curves are
    assert at_five == pytest.approx(1e-3 * own.balance.power.motor, rel=TWICE_RTOL)
    passing = ask(client, "/passing", file="overland.yaml", changes={}, paths=["belt.speed"]).json()["passing"]
    line = conveyor.load(SPECS / "overland.yaml")
    speeds = (3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0)
    assert passing == [every_load(with_fields(line, {"belt.speed": f"{v} m/s"})).failed == 0 for v in speeds]
    assert set(passing) == {True, False}


@pytest.mark.parametrize("paths", [[], ["nope"], ["name"], "belt.speed", ["belt.speed"] * 13])
def test_curves_of_no_slider_are_refused(client, paths):
    assert ask(client, "/curves", file="overland.yaml", changes={}, paths=paths).status_code == 422


def test_tables_by_name(client):
    names = ask(client, "/table", file="overland.yaml", changes={}).json()["tables"]
    assert ["pulleys", "Pulleys"] in names
    assert "<table" in ask(client, "/table", file="overland.yaml", changes={}, key="pulleys").json()["table"]
    assert ask(client, "/table", file="overland.yaml", changes={}, key="nope").status_code == 422


def test_figures_by_name_are_images_of_the_units_asked_for(client):
    names = ask(client, "/table", file="overland.yaml", changes={}).json()["tables"]
    assert {"figure tensions", "figure profile", "figure pressure"} <= {key for key, _ in names}
    for units, force in (("SI", "kN"), ("US", "lbf")):
        got = ask(client, "/table", file="overland.yaml", changes={}, units=units, key="figure tensions").json()
        source = re.search(r'<img src="data:image/svg\+xml;base64,([^"]+)" alt="Tension round the loop', got["table"])
        drawn = base64.b64decode(source[1]).decode()
        assert drawn.startswith("<svg")
        assert force in drawn
    assert ask(client, "/table", file="overland.yaml", changes={}, key="figure nope").status_code == 422


def test_two_pages_at_once_have_each_its_own_answer(desk):
    found = {}

    def work(file, speed):
        page = client_of(desk)
        found[file] = [
            ask(page, "/result", file=file, changes={"belt.speed": f"{speed + 0.1 * i:.1f} m/s"}).json()["power_kW"][
                "motor"
            ]
            for i in range(3)
        ]

    threads = [threading.Thread(target=work, args=of) for of in (("overland.yaml", 5.0), ("downhill.yaml", 4.0))]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    for file, speed in (("overland.yaml", 5.0), ("downhill.yaml", 4.0)):
        line = conveyor.load(SPECS / file)
        for i, power in enumerate(found[file]):
            exact = every_load(with_fields(line, {"belt.speed": f"{speed + 0.1 * i:.1f} m/s"})).own.balance.power.motor
            assert power == pytest.approx(1e-3 * exact, rel=TWICE_RTOL)


# ---- saving


def test_saving_changes_two_lines_and_keeps_the_rest_byte_for_byte(client, folder):
    before = (folder / "overland.yaml").read_bytes()
    changes = {"belt.speed": "5.5 m/s", "idlers.carry.spacing": "1.8 m"}
    digest = ask(client, "/form", file="overland.yaml").json()["digest"]
    shown = ask(client, "/difference", file="overland.yaml", changes=changes, target="overland.yaml").json()
    assert [line for line in shown["lines"] if line[0] in "+-"] == [
        "-  speed: 5 m/s", "+  speed: 5.5 m/s", "-    spacing: 1.5 m", "+    spacing: 1.8 m",
    ]  # fmt: skip
    got = ask(client, "/save", file="overland.yaml", changes=changes, target="overland.yaml", digest=digest)
    assert got.json()["saved"] == "overland.yaml"
    after = (folder / "overland.yaml").read_bytes()
    assert after == before.replace(b"speed: 5 m/s", b"speed: 5.5 m/s", 1).replace(
        b"spacing: 1.5 m", b"spacing: 1.8 m", 1
    )
    assert {row["path"]: row.get("value") for row in ask(client, "/form", file="overland.yaml").json()["rows"]}[
        "belt.speed"
    ] == "5.5 m/s"


def test_saving_under_another_name_opens_it_and_replaces_nothing_unasked(client, folder):
    digest = ask(client, "/form", file="overland.yaml").json()["digest"]
    body = {"file": "overland.yaml", "changes": {"site": "poor"}, "digest": digest}
    assert ask(client, "/save", **body, target="worse.yaml").json()["files"] == [
        "overland.yaml", "downhill.yaml", "worse.yaml",
    ]  # fmt: skip
    assert conveyor.load(folder / "worse.yaml").site == "poor"
    assert ask(client, "/save", **body, target="shuttle.yaml").status_code == 422
    assert (folder / "shuttle.yaml").read_bytes() == (SPECS / "shuttle.yaml").read_bytes()
    assert ask(client, "/save", **body, target="shuttle.yaml", replace=True).status_code == 200
    assert (folder / "overland.yaml").read_bytes() == (SPECS / "overland.yaml").read_bytes()


@pytest.mark.parametrize(
    "target",
    [
        "../x.yaml",
        "/x.yaml",
        "a/b.yaml",
        "a\\b.yaml",
        ".x.yaml",
        "",
        "x.txt",
        "x.yaml\0",
        "C:x.yaml",
        "x" * 130 + ".yaml",
    ],
)
def test_saving_outside_the_folder_is_refused(client, folder, target):
    digest = ask(client, "/form", file="overland.yaml").json()["digest"]
    listed = sorted(folder.parent.rglob("*"))
    for path in ("/difference", "/save"):
        got = ask(client, path, file="overland.yaml", changes={}, target=target, digest=digest, replace=True)
        assert got.status_code == 422
    assert sorted(folder.parent.rglob("*")) == listed


def test_a_file_that_another_program_changed_is_not_overwritten(client, folder):
    digest = ask(client, "/form", file="overland.yaml").json()["digest"]
    path = folder / "overland.yaml"
    time.sleep(0.01)
    path.write_text(path.read_text(encoding="utf-8").replace("flow: 2400", "flow: 2300"), encoding="utf-8")
    body = {"file": "overland.yaml", "changes": {"belt.speed": "5.5 m/s"}, "target": "overland.yaml"}
    got = ask(client, "/save", **body, digest=digest)
    assert "another program has changed it" in got.json()["errors"][0]["message"]
    assert ask(client, "/form", file="overland.yaml").json()["digest"] != digest  # read again by itself


@pytest.mark.parametrize(("kind", "begins"), [("workbook", b"PK"), ("page", b"<!DOCTYPE html>"), ("pdf", b"%PDF")])
def test_reports_are_files_to_download(client, kind, begins):
    if kind == "pdf":
        pytest.importorskip("typst")
    got = ask(client, "/report", file="overland.yaml", changes={"belt.speed": "5.5 m/s"}, kind=kind)
    assert got.content.startswith(begins)
    assert got.headers["content-disposition"].startswith("attachment; filename*=UTF-8''overland.")


def test_variants_are_a_study_that_runs(client, folder):
    got = ask(client, "/study", file="overland.yaml", changes={"belt.speed": "4.5 m/s"}, beside={"site": "plant"})
    (folder / "variants.yaml").write_bytes(got.content)
    plan = conveyor.study(folder / "variants.yaml")
    assert len(plan.table) == 3
    assert ask(client, "/study", file="overland.yaml", changes={}).status_code == 422


# ---- files from the page


def test_a_dropped_spec_is_opened_and_saved_beside_the_others(client, folder):
    content = (SPECS / "transfer.yaml").read_bytes()
    got = client.post("/drop?name=transfer.yaml", content=content).json()
    assert got["file"] == "transfer.yaml"
    form = ask(client, "/form", file="transfer.yaml").json()
    assert not form["own"]
    assert not (folder / "transfer.yaml").exists()
    changes = {"belt.speed": "1.6 m/s"}
    saved = ask(client, "/save", file="transfer.yaml", changes=changes, target="transfer.yaml", digest=form["digest"])
    assert saved.status_code == 200, saved.text
    assert (folder / "transfer.yaml").read_bytes() == content.replace(b"speed: 1.5 m/s", b"speed: 1.6 m/s", 1)
    assert ask(client, "/form", file="transfer.yaml").json()["own"]


def test_a_filled_in_template_is_opened_and_saved_as_a_spec(client, folder):
    from conveyor.starter.template_writer import template_bytes

    content = template_bytes(conveyor.load(SPECS / "overland.yaml"), shelves=(), units="SI")
    assert client.post("/drop?name=form.xlsx", content=content).json()["file"] == "form.xlsx"
    form = ask(client, "/form", file="form.xlsx").json()
    assert form["saved"] == "form.yaml"
    got = ask(client, "/save", file="form.xlsx", changes={"site": "poor"}, target="form.yaml", digest=form["digest"])
    assert got.status_code == 200, got.text
    assert conveyor.load(folder / "form.yaml").site == "poor"


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("x.yaml", b"name: [", "syntax"),
        ("x.yaml", b"name: only\n", "missing"),
        ("x.exe", b"", "ends in"),
        ("../x.yaml", b"a: 1", "no name of a file"),
        ("x.xlsx", b"PK nonsense", "damaged"),
        ("x.yaml", b"\xff\xfe\0", "UTF"),
    ],
)
def test_dropped_files_with_errors_are_refused_without_paths_of_this_machine(client, name, content, message):
    got = client.post("/drop", params={"name": name}, content=content)
    assert got.status_code == 422
    text = " ".join(error["message"] for error in got.json()["errors"])
    assert message in text
    assert "conveyor-desk-" not in text


def test_a_dropped_spec_reads_no_compound_outside_the_folder(client, folder):
    secret = folder.parent / "secret.yaml"
    secret.write_text(shelf.dump(shelf.compound("s100")), encoding="utf-8")
    content = (SPECS / "overland.yaml").read_text(encoding="utf-8")
    forged = content.replace("compound: standard-cover", "compound: ../secret.yaml").encode()
    got = client.post("/drop?name=forged.yaml", content=forged)
    assert got.status_code == 422
    assert "outside the folder" in got.text


def test_a_dropped_file_with_other_errors_reads_none_either(client, folder):
    (folder.parent / "secret.yaml").write_text("password: swordfish\n", encoding="utf-8")
    content = (SPECS / "overland.yaml").read_text(encoding="utf-8")
    forged = content.replace("compound: standard-cover", "compound: ../secret.yaml") + "name: given twice\n"
    got = client.post("/drop?name=forged.yaml", content=forged.encode())
    assert got.status_code == 422
    assert "given twice" in got.text
    assert "password" not in got.text


def test_a_dropped_template_reads_no_compound_outside_the_folder(client, folder):
    from io import BytesIO

    import openpyxl

    from conveyor.starter.template_writer import template_bytes

    book = openpyxl.load_workbook(
        BytesIO(template_bytes(conveyor.load(SPECS / "overland.yaml"), shelves=(), units="SI"))
    )
    cells = [c for sheet in book for row in sheet.iter_rows() for c in row if c.value == "standard-cover"]
    assert cells
    for cell in cells:
        cell.value = "../secret.yaml"
    (folder.parent / "secret.yaml").write_text("password: swordfish\n", encoding="utf-8")
    content = BytesIO()
    book.save(content)
    got = client.post("/drop?name=forged.xlsx", content=content.getvalue())
    assert got.status_code == 422
    assert "outside the folder" in got.text
    assert "password" not in got.text


@pytest.mark.parametrize(("kind", "units"), [("overland", "SI"), ("in-plant", "US"), ("downhill", "SI")])
def test_a_new_spec_of_each_kind_calculates(client, kind, units):
    name = ask(client, "/new", kind=kind, units=units).json()["file"]
    assert ask(client, "/form", file=name).json()["kind"] == kind
    assert ask(client, "/answer", file=name, changes={}).status_code == 200


# ---- stopping, ending


def test_a_stopped_calculation_ends_and_its_cache_still_serves(folder):
    bench = open_workbench([folder / "overland.yaml"], ())
    line = bench.variant("overland.yaml", {"belt.speed": "5.3 m/s"})
    stop = StopSignal()
    stop.stop()
    with pytest.raises(CalculationStopped):
        bench.assess(line, stop)
    with pytest.raises(NoSolutionError, match="the limit of the desk"):
        bench.assess(line, StopSignal(seconds=-1.0))
    power = bench.assess(line, StopSignal()).own.balance.power.motor
    assert power == pytest.approx(every_load(line).own.balance.power.motor, rel=TWICE_RTOL)
    bench.close()


def test_background_work_gives_way_to_the_figures(desk):
    begun = threading.Event()
    seen = []

    async def run():
        class Connected:
            async def is_disconnected(self):
                return False

        def slow(stop):
            begun.set()
            for _ in range(500):
                time.sleep(0.01)
                stop.check()

        async def background():
            try:
                await desk._calculate(Connected(), slow, background=True)
            except CalculationStopped:
                seen.append("stopped")

        going = asyncio.ensure_future(background())
        while not begun.is_set():
            await asyncio.sleep(0.01)
        seen.append(await desk._calculate(Connected(), lambda _: "figures"))
        await going

    asyncio.run(run())
    assert sorted(seen) == ["figures", "stopped"]


def test_the_desk_ends_by_itself_when_no_page_calls(folder):
    server = DeskServer(open_workbench([folder / "overland.yaml"], ()), 0, idle_seconds=0.3)
    begun = time.monotonic()
    server.run()
    assert time.monotonic() - begun < 10.0


def test_it_listens_on_this_machine_only_and_takes_another_port_where_one_is_taken(folder):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        server = DeskServer(open_workbench([folder / "overland.yaml"], ()), port, idle_seconds=0.0)
        assert server.port != port
        assert server._socket.getsockname()[0] == "127.0.0.1"
        server.run()


@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT to another process")
def test_ctrl_c_says_where_the_files_are_and_nothing_else_while_it_calculates(folder):
    import http.client
    import signal

    program = [sys.executable, "-m", "conveyor.cli", "desk", "overland.yaml", "--no-browser", "--port", "18991"]
    with subprocess.Popen(program, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        address = process.stdout.readline()
        assert address.startswith("desk: http://127.0.0.1:")
        page = http.client.HTTPConnection("127.0.0.1", int(re.search(r":([0-9]+)/", address)[1]), timeout=60)
        page.request("GET", "/open?" + address.strip().partition("?")[2])
        opened = page.getresponse()
        opened.read()
        cookie = {"cookie": opened.getheader("set-cookie").partition(";")[0]}
        study = json.dumps({"file": "overland.yaml", "changes": {}, "key": "starts", "id": "1"})
        page.request("POST", "/further", study, cookie)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        said, errors = process.communicate(timeout=20)
        page.close()
    assert f"what you saved is in {folder}" in said
    assert errors == ""
    assert process.returncode == 0


def test_a_file_that_is_refused_stops_the_desk_before_it_begins(tmp_path):
    (tmp_path / "x.yaml").write_text("name: 3\n", encoding="utf-8")
    with pytest.raises(InputError, match="name"):
        open_workbench([tmp_path / "x.yaml"], ())


def test_a_shelf_that_does_not_exist_stops_it_too(folder):
    with pytest.raises(InputError, match="no such folder"):
        open_workbench([folder / "overland.yaml"], [folder / "nowhere"])


def test_files_of_one_name_are_kept_apart_and_saved_where_they_were(folder):
    other = folder / "other"
    other.mkdir()
    shutil.copy(SPECS / "overland.yaml", other / "overland.yaml")
    bench = open_workbench([folder / "overland.yaml", other / "overland.yaml"], ())
    assert bench.names == ("overland.yaml", "overland (2).yaml")
    second = bench.file("overland (2).yaml")
    bench.save(second.name, {"site": "poor"}, second.saved_name, second.digest, overwrite=False)
    bench.close()
    assert conveyor.load(other / "overland.yaml").site == "poor"
    assert conveyor.load(folder / "overland.yaml").site == "overland"


def test_the_page_fits_its_budget_and_asks_nobody_else():
    page = Path(desk_server.__file__).parent / "page"
    files = {path.name: path.read_text(encoding="utf-8") for path in page.iterdir()}
    assert set(files) == {"desk.html", "desk.css", "desk.js"}
    assert sum(len(text.encode()) for text in files.values()) <= 60_000
    for text in files.values():
        assert "https://" not in text
        assert "http://" not in text.replace("http://www.w3.org/2000/svg", "")
    assert " style=" not in files["desk.html"]
    assert "onclick" not in files["desk.html"]


# ---- longer studies


def test_longer_studies_are_offered_where_the_spec_has_what_they_need(client, folder, desk):
    shutil.copy(SPECS / "overland_10km.yaml", folder / "overland_10km.yaml")
    desk.workbench.open_path(folder / "overland_10km.yaml")
    assert set(ask(client, "/form", file="overland.yaml").json()["studies"]) == {"starts"}
    assert set(ask(client, "/form", file="overland_10km.yaml").json()["studies"]) == {"year", "ranges", "starts"}
    refused = ask(client, "/further", file="overland.yaml", changes={}, key="year", id="1")
    assert refused.status_code == 422


def test_the_year_of_a_variant_is_that_of_the_report(client, folder, desk):
    shutil.copy(SPECS / "overland_10km.yaml", folder / "overland_10km.yaml")
    desk.workbench.open_path(folder / "overland_10km.yaml")
    changes = {"cases[0].name": "first", "idlers.carry.spacing": "2 m"}
    part = ask(client, "/further", file="overland_10km.yaml", changes=changes, key="year", id="1").json()["part"]
    line = with_fields(conveyor.load(folder / "overland_10km.yaml"), changes)
    loads = every_load(line)
    year = analyse_duty(line, take_up=loads.states.take_up)
    row = year_table(year).rows[0]
    assert row.label in part
    assert row.unit("SI").written(row.value) in part


def test_starts_are_followed_through_time_and_each_tells_its_own_progress(desk, client, monkeypatch):
    parts, told = [], []
    study = desk_server.study_part

    def slowly(assessment, key, progress):
        def step(*items):
            progress(*items)
            time.sleep(0.3)  # some looks at the progress

        return study(assessment, key, step)

    monkeypatch.setattr(desk_server, "study_part", slowly)

    def work():
        page = client_of(desk)
        parts.append(ask(page, "/further", file="downhill.yaml", changes={}, key="starts", id="mine").json()["part"])

    going = threading.Thread(target=work)
    going.start()
    while going.is_alive():
        told.append(ask(client, "/progress", id="mine").json()["whole"])
        assert ask(client, "/progress", id="other").json() == {"done": 0, "whole": 0}
        time.sleep(0.02)
    assert "<table" in parts[0]
    scenarios = len(standard_scenarios(conveyor.load(SPECS / "downhill.yaml")))
    assert scenarios in told
    assert ask(client, "/progress", id="mine").json() == {"done": 0, "whole": 0}  # it has ended


# ---- the command


def test_without_its_packages_the_command_says_what_to_install():
    from conveyor.cli import desk_command

    done = run("desk", spoil=lambda patched: patched.setattr(desk_command, "find_spec", lambda _: None))
    assert done.returncode == 2
    assert 'pip install "conveyor[desk]"' in done.stderr


def test_answers_do_not_wait_for_packets_to_be_acknowledged():
    """asyncio turns the waiting off only where a socket names its protocol, which accepted ones have from it."""
    with desk_server._listening_socket("127.0.0.1", 0) as waiting:
        assert waiting.proto == socket.IPPROTO_TCP
