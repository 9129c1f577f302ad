"""Starter specs: each loads and runs as it stands, and with everything it shows as a comment taken in."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import conveyor
from conveyor import spec, starter
from conveyor.units import System

KINDS = [(kind, units) for kind in starter.KINDS for units in ("SI", "US")]


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_say_what_their_values_say(kind: starter.Kind, units: System, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(starter.written(kind, units), encoding="utf-8")
    assert conveyor.load(path) == spec.from_data(starter.values(kind, units))


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_with_every_comment_taken_in_are_valid(
    kind: starter.Kind, units: System, tmp_path: Path
) -> None:
    text = re.sub(
        r"^( {0,6})# (?= {0,6}(?:[a-z_]+: |- \{))", r"\1", _body(starter.written(kind, units)), flags=re.M
    )
    path = tmp_path / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    assert conveyor.load(path) == spec.from_data(starter.values(kind, units, optional=True))


def _body(text: str) -> str:
    return text[text.index("\nname:") + 1 :]


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_starters_have_an_answer_of_the_right_sign(kind: starter.Kind, units: System) -> None:
    line = spec.from_data(starter.values(kind, units))
    found = conveyor.analyse(line)
    motor = found.balance.power.motor
    assert (motor < 0.0) == (kind == "downhill")
    installed = line.drive.installed_power
    assert installed is not None
    assert abs(motor) < installed.to("W").magnitude


def test_the_systems_of_units_describe_about_the_same_conveyor() -> None:
    """US values are rounded to what is sold there: a tenth or so apart, a slipped unit is a factor of two and more."""
    for kind in starter.KINDS:
        si, us = (conveyor.analyse(spec.from_data(starter.values(kind, units))) for units in ("SI", "US"))
        assert us.balance.forces.lift == pytest.approx(si.balance.forces.lift, rel=0.2)
        assert us.balance.forces.main == pytest.approx(si.balance.forces.main, rel=0.2)


@pytest.mark.parametrize(("kind", "units"), KINDS)
def test_every_line_has_a_comment_and_fits_a_screen(kind: starter.Kind, units: System) -> None:
    for line in starter.written(kind, units).splitlines():
        if re.match(r" *(?:# )?[a-z_]+: \S", line):
            assert " # " in line, line
        if not line.lstrip().startswith("- {") and not line.lstrip("# ").startswith("- {"):
            assert len(line) <= 112, line
