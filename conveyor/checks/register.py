"""All criteria in their order, and their run.

The same functions check a run and each of its load cases; warnings and all outputs use their results.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.bed_checks import bed_speed
from conveyor.checks.belt_checks import (
    belt_rating,
    belt_safety,
    belt_temperature,
    belt_turnover,
    cover_thickness,
    splice_strength,
)
from conveyor.checks.bulk_checks import belt_cleaning, belt_filling, bulk_slip, bulk_slope, impact_load, skirtboards
from conveyor.checks.check import Check
from conveyor.checks.contact_checks import cover_penetration, rubber_coverage
from conveyor.checks.curve_checks import belt_drift, curve_radius, horizontal_edges, pipe_curves, wind_lift
from conveyor.checks.drive_checks import (
    coasting_time,
    comes_to_rest,
    drive_parts,
    drive_speed,
    holding_brake,
    motor_power,
    starting_force,
)
from conveyor.checks.feeder_checks import belt_feeder
from conveyor.checks.idler_checks import belt_flap, roll_axle, roll_life, set_rating
from conveyor.checks.pipe_checks import pipe_bearing, pipe_lap, pipe_lumps, pipe_rolls
from conveyor.checks.pulley_checks import (
    belt_transitions,
    lagging_pressure,
    pulley_bearings,
    pulley_diameter,
    pulley_shaft,
)
from conveyor.checks.scale_checks import belt_scales
from conveyor.checks.tension_checks import (
    belt_sag,
    drive_grip,
    slack_belt,
    take_up_place,
    take_up_tension,
    take_up_travel,
)
from conveyor.line.line import Line
from conveyor.loop.worst_loadings import SINGLE_CHANGE_SECTIONS


def run_checks(result: CalculatedConveyor, *, contacts: bool = True) -> tuple[Check, ...]:
    """Check one calculation for every criterion in the order of `CRITERIA`; `CONTACT_CRITERIA` only with contacts."""
    chosen = [criterion for criterion in CRITERIA if contacts or criterion not in CONTACT_CRITERIA]
    return tuple(check for criterion in chosen for check in criterion(result))


def unsearched_criteria(line: Line) -> frozenset[str]:
    """Keys of criteria that are checked under the calculated loads only, not under the worst loading."""
    return _CALCULATED_LOADS_ONLY | (_SECTION_CRITERIA if line.count > SINGLE_CHANGE_SECTIONS else frozenset())


def rubber_data_suffice(result: CalculatedConveyor) -> bool:
    """True if the rubber's data cover the excited band; otherwise results are not for design."""
    return not any(check.failed for check in rubber_coverage(result))


CONTACT_CRITERIA: Final = (cover_penetration, rubber_coverage)
"""Criteria that need the contacts of all rolls; the others need forces and tensions only."""


_CALCULATED_LOADS_ONLY: Final = frozenset({"belt_flap", "load_sharing", "penetration", "rubber_coverage"})
"""Keys of criteria checked under the calculated loads only."""


_SECTION_CRITERIA: Final = frozenset({"curve_radius", "pipe_radius", "belt_drift", "set_rating"})
"""Keys of criteria of single sections, on long routes checked under the calculated loads only."""


CRITERIA: Final[tuple[Callable[[CalculatedConveyor], Iterable[Check]], ...]] = (
    belt_filling, bulk_slope, motor_power, take_up_tension, take_up_travel, take_up_place, drive_grip, belt_sag,
    slack_belt,
    belt_safety, belt_rating,
    splice_strength, cover_thickness, belt_turnover, belt_temperature, pulley_diameter, curve_radius,
    wind_lift, horizontal_edges, belt_drift, pipe_curves, belt_transitions, pipe_bearing, pipe_lap, pipe_lumps,
    pipe_rolls, impact_load, skirtboards,
    belt_cleaning, belt_scales, belt_feeder, pulley_shaft,
    pulley_bearings, lagging_pressure, starting_force, comes_to_rest, holding_brake, drive_parts, drive_speed,
    coasting_time, bulk_slip, bed_speed,
    cover_penetration, roll_life, set_rating, roll_axle, belt_flap, rubber_coverage,
)  # fmt: skip
