"""Curves of a pipe in every state of motion: radius by rule and by the strips of the belt, force on a panel."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from conveyor.laws.pipe_geometry import least_pipe_radius, pipe_strip_distance
from conveyor.line.line import Line
from conveyor.line.stretches import RouteSection, Strand
from conveyor.loop.belt_limits import strip_limits
from conveyor.loop.tension_coupling import force_on_set
from conveyor.loop.tensions import MotionState


@dataclass(frozen=True)
class PipeCurveCheck:
    """A curve of the pipe on one strand.

    Attributes
    ----------
    section, strand : str
        Section and strand.
    kind : str
        Which way it bends, in words.
    radius : float
        Radius, of a vertical and a horizontal curve in one section that of both together [m].
    angle : float
        Angle by which it turns [rad].
    lowest, highest : float
        Tensions that occur in it [N].
    push : float
        Largest force of the tension on a panel [N].
    by_rule : float
        Least radius by rule of thumb [m].
    overstress, buckling : float or None
        Least radii at which no strip of the belt bears more than the rated tension, or is slack, by plane sections [m];
        infinite where none helps, None where stiffness or strength are unknown. Told, not judged.
    most, least : float or None
        Highest and lowest tension of a strip that occur on it [N/m].
    """

    section: str
    strand: Strand
    kind: str
    radius: float
    angle: float
    lowest: float
    highest: float
    push: float
    by_rule: float
    overstress: float | None = None
    buckling: float | None = None
    most: float | None = None
    least: float | None = None


def pipe_curve_checks(line: Line, states: Sequence[MotionState]) -> tuple[PipeCurveCheck, ...]:
    """Check every curve of a pipe on both strands in every state, carry strand first.

    Parameters
    ----------
    line : Line
        The conveyor.
    states : sequence of MotionState
        Its states of motion.
    """
    half = line.count
    return tuple(check for i in (*range(half, 2 * half), *range(half)) for check in _curve_check(line, i, states))


def _curve_check(line: Line, i: int, states: Sequence[MotionState]) -> Iterator[PipeCurveCheck]:
    stretch = line.loop.stretches[i]
    pipe, section = stretch.idlers.pipe, next(one for one in line.sections if one.name == stretch.section)
    if pipe is None or not section.curved:
        return
    tensions = [float(end[i]) for state in states for end in (state.starts, state.ends)]
    lowest, highest, radius = min(tensions), max(tensions), section.bend_radius
    width, (inside, _) = line.belt.width, line.belt.cover_thicknesses
    reach = pipe_strip_distance(
        2.0 * pipe.radius, cover_thickness=inside, carcass_thickness=line.belt.carcass_thickness
    )
    yield PipeCurveCheck(
        stretch.section,
        stretch.strand,
        _curve_kind(section),
        radius,
        stretch.length / radius,
        lowest,
        highest,
        max(abs(force_on_set(line, stretch, tension, radius)) for tension in (lowest, highest)),
        least_pipe_radius(2.0 * pipe.radius, steel_cord=line.belt.steel_cord),
        *strip_limits(
            line,
            lowest / width,
            highest / width,
            radius=radius,
            stretched=reach,
            slackened=reach,
            least_tension=0.0,
        ),
    )


def _curve_kind(section: RouteSection) -> str:
    """Kind of curve for reports."""
    ways = [] if section.curve is None else [section.curve]
    if section.horizontal is not None:
        ways.append("horizontal")
    return " and ".join(ways)
