"""Starter specs: each loads and runs as it stands, and with everything it shows as a comment taken in."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import conveyor
from conveyor import spec, starter
from conveyor.checks import run_checks
from conveyor.cli.new_command import StarterKind
from conveyor.errors import InputError
from conveyor.studies.study_file import read_plan, read_search
from conveyor.units import System
from tests.command_line import ROOT, run

KINDS = [(kind, units) for kind in starter.KINDS for units in ("SI", "US")]


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_say_what_their_values_say(kind: starter.Kind, units: System, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(starter.starter_text(kind, units), encoding="utf-8")
    assert conveyor.load(path) == spec.from_data(starter.starter_values(kind, units))


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_with_every_comment_taken_in_are_valid(kind: starter.Kind, units: System, tmp_path: Path) -> None:
    text = re.sub(
        r"^( {0,6})# (?= {0,6}(?:[a-z_]+: |- \{))",
        r"\1",
        _body(starter.starter_text(kind, units)),
        flags=re.M,
    )
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    assert conveyor.load(path) == spec.from_data(starter.starter_values(kind, units, optional=True))


def _body(text: str) -> str:
    return text[text.index("\nname:") + 1 :]


@pytest.mark.parametrize("optional", [False, True])
@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_fail_no_check_and_have_an_answer_of_the_right_sign(
    kind: starter.Kind, units: System, optional: bool
) -> None:
    line = spec.from_data(starter.starter_values(kind, units, optional=optional))
    found = conveyor.analyse(line)
    motor = found.balance.power.motor
    assert (motor < 0.0) == (kind == "downhill")
    installed = line.drive.installed_power
    assert installed is not None
    assert abs(motor) < installed.to("W").magnitude
    assert [check.subject for check in run_checks(found) if check.verdict == "FAIL"] == []


@pytest.mark.parametrize("kind", starter.KINDS)
def test_a_starter_in_us_units_has_us_units_in_values_and_limits(kind: starter.Kind) -> None:
    body = _body(starter.starter_text(kind, "US")).replace("(ST1600: 1600 N/mm)", "")
    metric = re.findall(r"[0-9] (?:mm|cm|m|km|kg|t|N|kN|W|kW|Pa|kPa|m/s|t/h|degC|K|kg/m\^[23])\b", body)
    assert metric == []
    assert "  units: US " in body


def test_limits_are_in_the_unit_of_the_value_and_what_they_say_is_allowed() -> None:
    """Rounded inwards: a belt of exactly each limit is accepted."""
    text = starter.starter_text("overland", "US")
    found = re.search(r"  width: 48 in +# .* ≥ (\S+ in), ≤ (\S+ in)\.", text)
    assert found is not None
    for limit in found.groups():
        data = starter.starter_values("overland", "US")
        data["belt"]["width"] = limit
        with pytest.raises(InputError) as refused:  # rolls and bulk do not fit such a belt
            spec.from_data(data)
        assert "belt.width: got" not in str(refused.value)
    assert "≤ 8784 h" in text  # in the limit's own unit it stays as it is, unrounded


def test_the_systems_of_units_describe_about_the_same_conveyor() -> None:
    """US values are rounded to what is sold there: a tenth or so apart, a slipped unit is a factor of two and more."""
    for kind in starter.KINDS:
        si, us = (conveyor.analyse(spec.from_data(starter.starter_values(kind, units))) for units in ("SI", "US"))
        assert us.balance.forces.lift == pytest.approx(si.balance.forces.lift, rel=0.2)
        assert us.balance.forces.main == pytest.approx(si.balance.forces.main, rel=0.2)


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_every_line_has_a_comment_and_fits_a_screen(kind: starter.Kind, units: System) -> None:
    for line in starter.starter_text(kind, units).splitlines():
        if re.match(r" *(?:# )?[a-z_]+: \S", line):
            assert " # " in line, line
        if not line.lstrip().startswith("- {") and not line.lstrip("# ").startswith("- {"):
            assert len(line) <= 112, line


@pytest.mark.parametrize("name", ["my belt.yaml", "a\nb: 1.yaml", 'he said "x".yaml', "# 1.yaml"])
def test_any_name_of_a_file_stays_inside_the_heading(name: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(starter.starter_text("overland", file=name), encoding="utf-8")
    assert conveyor.load(path) == spec.from_data(starter.starter_values("overland"))


@pytest.mark.parametrize("kind", starter.EXAMPLES)
def test_a_full_example_is_written_whole_and_read_as_it_stands(kind: str, tmp_path: Path) -> None:
    shown = starter.EXAMPLES[kind]
    for path, content in starter.example_files(kind, tmp_path / "mine.yaml").items():
        path.write_bytes(content)
    path = tmp_path / "mine.yaml"
    if shown.base is None:
        assert path.read_bytes() == (ROOT / "examples" / shown.file).read_bytes()
        assert conveyor.load(path).name
    else:
        read = read_search(path) if shown.command == "optimise" else read_plan(path)
        assert conveyor.load(tmp_path / read.base) == conveyor.load(ROOT / "examples" / shown.base)


def test_new_offers_every_kind_and_says_how_it_runs(tmp_path: Path) -> None:
    offered = {kind.value for kind in StarterKind}
    assert offered == {*starter.KINDS, "duty", *starter.EXAMPLES}
    done = run("new", str(tmp_path / "s.yaml"), "--kind", "study")
    assert done.returncode == 0
    assert "next: conveyor study" in done.stdout
    assert (tmp_path / "s_base.yaml").is_file()
    refused = run("new", str(tmp_path / "t.yaml"), "--kind", "shuttle", "--units", "US")
    assert refused.returncode == 2
    assert "in SI only" in refused.stderr
    assert f"conveyor power {tmp_path / 't.yaml'} --units us" in " ".join(refused.stderr.split())


def test_the_example_of_a_transfer_keeps_its_checks() -> None:
    found = conveyor.analyse(conveyor.load(ROOT / "examples" / "specs" / "transfer.yaml"))
    assert found.trajectory.wraps
    assert not [check.subject.text() for check in run_checks(found) if check.failed]
