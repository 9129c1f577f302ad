"""Calibrate a compound by rolling-resistance tests, and tabulate measured against calculated indentation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError
from conveyor.line.rolling_test_theory import (
    RollingTestRow,
    factor_from_rows,
    load_exponents,
    rolling_test_rows,
)
from conveyor.models import RubberCompound
from conveyor.models.rolling_tests import RollingTest
from conveyor.report.table_model import Column, Table
from conveyor.rubber.rolling_test_factor import (
    UNTESTED_FACTOR,
    USUAL_COVER_THICKNESS,
    USUAL_FACTOR,
    USUAL_ROLL_DIAMETER,
    RollingTestFactor,
)
from conveyor.units.sentences import percent, to_celsius

SHEET_NAME = "Anchor"


@dataclass(frozen=True, eq=False)
class RollingTestCalibration:
    """A compound calibrated by rolling-resistance tests.

    Attributes
    ----------
    compound : RubberCompound
        With the tests; of a carrier's spectrum where it has none of its own.
    rows : tuple of RollingTestRow
        Each test point, measured and calculated.
    anchor : RollingTestFactor
        Test factor: measured over calculated indentation.
    softened : bool
        Whether the theory took the rubber at the strain of each test.
    """

    compound: RubberCompound
    rows: tuple[RollingTestRow, ...]
    anchor: RollingTestFactor
    softened: bool

    def left(self, row: RollingTestRow) -> float:
        """Residual of a test point: measured over theory times test factor, less 1 [-]."""
        factor = float(self.anchor.factor(row.line_load, row.temperature))
        return row.measured / (factor * row.calculated) - 1.0


@check_arguments
def calibrate_compound(
    compound: RubberCompound, tests: Sequence[RollingTest], *, name: str | None = None, softened: bool = True
) -> RollingTestCalibration:
    """Fit the test factor of a compound to rolling-resistance tests.

    Parameters
    ----------
    compound : RubberCompound
        Gives spectrum, shift and strain sweeps to the theory; tests it already has are replaced.
    tests : sequence of RollingTest
        Of the compound itself, or of the one called `name`.
    name : str, optional
        Name of the tested compound where its spectrum was not measured: `compound` is then its carrier.
    softened : bool
        Take the rubber at the strain of each test, where the compound knows it.

    Returns
    -------
    RollingTestCalibration
        The compound with its tests, each point measured and calculated, and the test factor.

    Raises
    ------
    InputError
        There is no test.
    NoSolutionError
        A test's contact has no answer.
    RangeError
        The compound is not known at a test's temperature or strain.
    """
    if not tests:
        raise InputError("tests: give at least one")
    missing = tuple(line for line in compound.missing if not line.startswith("rolling-resistance tests"))
    changes: dict[str, Any] = {"tests": tuple(tests), "missing": missing}
    if name is not None and name != compound.name:
        lacking = f"its spectrum, shift and strain dependence: those of {compound.name} carry the tests"
        changes |= {"name": name, "carrier": compound.name, "missing": (lacking, *missing)}
        changes["description"] = f"Tested; carried by the spectrum of {compound.name}: {compound.description}"
    made = compound.replace(**changes)
    level = rolling_test_rows(made, softened=softened)
    return RollingTestCalibration(made, level, factor_from_rows(made, level), softened)


def factor_table(anchored: RollingTestCalibration) -> Table:
    """Test factor and its band at each tested temperature."""
    level = anchored.anchor
    low, high = level.loads
    columns = (
        Column("temperature", "temperature", lambda at: at, json="temperature_degC"),
        Column("factor at lowest load", "factor", lambda at: float(level.factor(low, at)), json="factor_low"),
        Column("factor in the middle", "factor", lambda at: float(level.factor(level.load, at)), json="factor"),
        Column("factor at highest load", "factor", lambda at: float(level.factor(high, at)), json="factor_high"),
        Column("band, down", "share", lambda at: math.expm1(-level.band(level.load, at)), json="band_down"),
        Column("band, up", "share", lambda at: math.expm1(level.band(level.load, at)), json="band_up"),
    )  # fmt: skip
    rows = tuple(anchored.anchor.temperatures.tolist())
    return Table("levels", SHEET_NAME, "Measured over calculated, 90 % interval", columns, rows)


def residual_table(anchored: RollingTestCalibration) -> Table:
    """Measured and calculated resistance, their ratio and the residual of each test point."""
    tests = anchored.compound.tests
    points = [test.points() for test in tests]
    columns = (
        Column("line load", "line force", "line_load", json="line_load_N_per_m"),
        Column("roll", "size", lambda row: 2.0 * points[row.test].radius, json="roll_mm"),
        Column("cover", "size", lambda row: points[row.test].cover_thickness, json="cover_mm"),
        Column("speed", "speed", lambda row: points[row.test].speed, json="speed_m_per_s"),
        Column("temperature", "temperature", "temperature", json="temperature_degC"),
        Column("measured", "line force", "measured", json="measured_N_per_m"),
        Column("theory", "line force", "calculated", json="theory_N_per_m"),
        Column("ratio", "factor", lambda row: row.measured / row.calculated, json="ratio"),
        Column("residual", "share", anchored.left, json="left"),
    )
    return Table("tests", SHEET_NAME, "Tests beside the theory", columns, anchored.rows)


def calibration_notes(anchored: RollingTestCalibration) -> tuple[str, ...]:
    """Notes on a calibration: points, residuals, limits and unusual figures."""
    left = [abs(anchored.left(row)) for row in anchored.rows]
    level, tests = anchored.anchor, anchored.compound.tests
    moved = {(test.points().radius, test.points().cover_thickness, test.points().speed) for test in tests}
    strain = "at the strain of each test" if anchored.softened and anchored.compound.strain_dependence else "linear"
    count = "1 test" if len(tests) == 1 else f"{len(tests)} tests"
    said = [
        f"{level.points} points of {count}; residual {percent(float(np.median(left)), 1)} in the median, "
        f"{percent(max(left), 1)} at most; rubber taken {strain}",
        f"factor over the line load: exponent {level.slope:+.3f}"
        if level.slope
        else "one factor for all line loads: the tests do not tell more",
    ]
    if len(moved) == 1:
        said.append("one roll, cover and speed: what the theory errs in carrying it to others is not tested")
    if level.temperatures.size == 1:
        said.append("one temperature: the factor is held at others, its band widens by 0.5 % a kelvin")
    return (*said, *_unusual_figures(anchored))


def _unusual_figures(anchored: RollingTestCalibration) -> Iterator[str]:
    """Notes on unusual exponents, dimensions and factors, with their likely cause."""
    for number, exponent, (least, most) in load_exponents(anchored.rows):
        if not least <= exponent <= most:
            yield (
                f"test {number + 1}: resistance goes as the line load to the power of {exponent:.2f}, rolls have "
                f"{least:.3g} to {most:.3g}: is the drag of bearings in it, or a load a roll taken for one a width?"
            )
    for number, test in enumerate(anchored.compound.tests, start=1):
        points = test.points()
        for name, value, usual, slip in (
            ("roll diameter", 2.0 * points.radius, USUAL_ROLL_DIAMETER, "is it a radius, or a drum?"),
            (
                "cover thickness",
                points.cover_thickness,
                USUAL_COVER_THICKNESS,
                "is it the thickness of the belt?",
            ),
        ):
            if not usual[0] <= value <= usual[1]:
                yield (
                    f"test {number}: {name} {1e3 * value:.3g} mm, usual are {1e3 * usual[0]:g} to "
                    f"{1e3 * usual[1]:g} mm: {slip}"
                )
    level, (least, most) = anchored.anchor, USUAL_FACTOR
    for t in level.temperatures.tolist():
        factor = max(level.factor(level.loads, t).tolist(), key=lambda value: abs(math.log(value)))
        if not least <= factor <= most:
            yield (
                f"{factor:.2f} times the theory at {to_celsius(t):.0f} degC, published tests lie at 1 to "
                f"{UNTESTED_FACTOR:g}: "
                "a radius given as roll diameter makes 0.6 of it, a belt's thickness given as cover changes it as much"
            )


def calibration_to_dict(anchored: RollingTestCalibration) -> dict[str, Any]:
    """A calibration as plain numbers for JSON, units in the keys."""
    return {
        "compound": anchored.compound.name,
        "carrier": anchored.compound.carrier,
        "levels": factor_table(anchored).plain(),
        "exponent": anchored.anchor.slope,
        "tests": residual_table(anchored).plain(),
        "notes": list(calibration_notes(anchored)),
    }
