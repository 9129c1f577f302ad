"""Remarks and fingerprint when a report is written in another system of units."""

from __future__ import annotations

import re

import pytest

import conveyor
from conveyor.checks import run_checks
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import fingerprint, load

_NEWTON, _POUND = (
    re.compile(r"needs a backstop of ([\d.]+) kN "),
    re.compile(r"needs a backstop of ([\d,]+) lbf "),
)
POUND = 4.4482216152605  # [N], international pound times standard gravity
ROUNDED = 50.0 + 5.0 * POUND  # [N], both are printed to three digits: 20.4 kN, 4,590 lbf


@pytest.fixture(scope="module")
def result() -> conveyor.Analysis:
    line = conveyor.load("examples/specs/in_plant_us.yaml")
    return conveyor.analyse(line.replace(report={"units": "SI"}))


def _found(pattern: re.Pattern[str], warnings: tuple[str, ...]) -> float:
    (found,) = [float(match[1].replace(",", "")) for match in map(pattern.search, warnings) if match]
    return found


def test_warnings_are_written_in_any_system() -> None:
    found = calculate(load("examples/specs/in_plant_us.yaml"))
    said = analysis_warnings(found, run_checks(found))
    si, us = (tuple(one.text(system) for one in said) for system in ("SI", "US"))
    assert _found(_POUND, us) * POUND == pytest.approx(1e3 * _found(_NEWTON, si), abs=ROUNDED)
    assert not any(re.search(r"\d k?N\b", warning) for warning in us)


def test_remarks_follow_the_units(result: conveyor.Analysis) -> None:
    us = result.in_units("US")
    newtons, pounds = 1e3 * _found(_NEWTON, result.warnings), _found(_POUND, us.warnings)
    assert pounds * POUND == pytest.approx(newtons, abs=ROUNDED)
    assert not any(re.search(r"\d k?N\b", warning) for warning in us.warnings)


def test_units_change_no_figure_and_no_fingerprint(result: conveyor.Analysis) -> None:
    us = result.in_units("US")
    said: dict[str, list[str]] = {"warnings": [], "assumptions": []}
    assert us.to_dict() | said == result.to_dict() | said
    assert fingerprint(us.conveyor) == fingerprint(result.conveyor)
    assert us.conveyor != result.conveyor


def test_same_units_are_the_same_analysis(result: conveyor.Analysis) -> None:
    assert result.in_units("SI") is result
    assert result.in_units(None) is result
