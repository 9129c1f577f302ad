"""A belt that is slack is answered like any other: tensions as they come out, failing checks, in every output."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import pytest
from ruamel.yaml import YAML

import conveyor
from conveyor.checks import run_checks
from conveyor.errors import NoSolutionError
from conveyor.models.fields import with_fields
from tests.command_line import ROOT, run

SPEC = ROOT / "examples" / "specs" / "downhill_brakes.yaml"


@pytest.fixture(scope="module")
def one_drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The downhill conveyor without the drive at its tail: the one at the head pulls it slack behind the valley."""
    yaml = YAML()
    data = yaml.load(SPEC.read_text(encoding="utf-8"))
    del data["drive"]["further_drives"]
    path = tmp_path_factory.mktemp("slack") / "one_drive.yaml"
    yaml.dump(data, path)
    return path


def numbers(data: object) -> Iterator[float]:
    """Every number of plain data."""
    if isinstance(data, dict):
        for value in data.values():
            yield from numbers(value)
    elif isinstance(data, list):
        for value in data:
            yield from numbers(value)
    elif isinstance(data, float):
        yield data


def test_a_drive_left_out_is_answered_with_failing_checks_in_every_output(one_drive: Path, tmp_path: Path) -> None:
    outputs = ("-o", "a.xlsx", "-o", "a.html", "--tables", ".")
    done = run("power", one_drive, "--json", *outputs, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert all(map(math.isfinite, numbers(result)))
    assert result["tensions_N"]["smallest"] < 0.0
    failed = {check["key"] for check in result["checks"] if check["verdict"] == "fail"}
    assert {"slack_belt", "take_up_tension", "drive_grip"} <= failed
    assert (tmp_path / "a.xlsx").stat().st_size > 0
    assert (tmp_path / "a.html").stat().st_size > 0
    tensions = pd.read_csv(tmp_path / "tensions.csv")["tension [N]"]
    assert tensions.min() == pytest.approx(result["tensions_N"]["smallest"], rel=1e-9)


def test_what_is_missing_is_said_as_tension_and_as_weight(one_drive: Path) -> None:
    done = run("power", one_drive)
    words = " ".join(done.stdout.split())
    assert "the belt goes slack in the state" in words
    assert "raise the take-up's tension from 108 kN to about" in words
    # 22 t hold 107.9 kN: 4.903 N a kg, two strands at 9.80665 m/s²
    lacking = next(
        check for check in run_checks(conveyor.analyse(conveyor.load(one_drive))) if check.key == "take_up_tension"
    )
    assert lacking.failed
    assert lacking.why is not None
    (_, held), (_, asked), (_, weight) = ((kind, value) for value, kind in lacking.why.figures)
    assert weight == pytest.approx(asked / held * 22e3, rel=1e-9)


def test_a_slack_belt_in_a_curve_presses_on_nothing() -> None:
    """At 2 t the belt is slack in the valley: its rolls bear belt and bulk alone."""
    found = conveyor.analyse(with_fields(conveyor.load(SPEC), {"route.take_up.mass": "2 t"}))
    steady = found.balance.equilibrium.steady
    i = next(
        i
        for i, stretch in enumerate(found.line.loop.stretches)
        if (stretch.section, stretch.strand) == ("hollow", "carry")
    )
    stretch = found.line.loop.stretches[i]
    assert max(steady.starts[i], steady.ends[i]) < 0.0
    weight = stretch.line_mass * found.line.gravity * math.cos(stretch.inclination) * stretch.spacing
    # m' v² stays: 3.5² m²/s² over 1800 m against g, in a valley downward
    passing = 1.0 + 3.5**2 / (1800.0 * found.line.gravity * math.cos(stretch.inclination))
    assert sum(roll.force for roll in stretch.loads) == pytest.approx(weight * passing, rel=1e-5)


def test_where_the_rolls_need_the_tension_a_slack_belt_is_refused() -> None:
    """A belt that gives under its rolls is held by its tension alone."""
    gives = with_fields(
        conveyor.load(SPEC),
        {"route.take_up.mass": "2 t", "calculation.support": "belt", "belt.carcass.stiffness": "200000 N/mm"},
    )
    with pytest.raises(NoSolutionError, match=r"no tension is left to hold the belt in section .* raise the"):
        conveyor.analyse(gives)
