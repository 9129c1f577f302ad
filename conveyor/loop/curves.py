"""Vertical curves: tension presses on the rolls, their resistance adds to the tension, until both agree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from conveyor.errors import NoSolutionError
from conveyor.laws.loading.curves import curve_belt_mass, curve_set_force, effective_tension
from conveyor.line.line import Line
from conveyor.line.stretches import Strand, Stretch
from conveyor.loop.tensions import MotionState

MOST_STEPS = 40


@dataclass(frozen=True)
class Convergence:
    """How the tensions and the rolls' loads settled.

    Attributes
    ----------
    steps : int
        Times the rolls were loaded anew.
    change : float
        Largest change of the tension in a curve in the last step, over the largest tension [-].
    ratio : float
        Change of the last step over that of the step before [-]; below 1 it converges.
    bound : float
        How far the tensions may still be off, change · ratio/(1 - ratio), over the largest tension [-].
    """

    steps: int
    change: float
    ratio: float
    bound: float

    def settled(self, rtol: float) -> bool:
        """Whether the tensions are known to a tolerance [-]; one step alone shows no ratio."""
        return self.steps > 1 and self.ratio < 1.0 and max(self.change, self.bound) <= rtol


def converged(
    last: Convergence | None, before: MotionState, now: MotionState, line: Line, largest: float
) -> Convergence:
    """Judge one more step of the iteration.

    Parameters
    ----------
    last : Convergence or None
        Of the step before.
    before, now : State
        Steady running before the rolls were loaded anew, and after.
    line : Line
        The conveyor.
    largest : float
        Largest tension of all states [N].

    Raises
    ------
    NoSolutionError
        The iteration has taken too many steps.
    """
    old, new = curve_tensions(line, before), curve_tensions(line, now)
    change = max(abs(b - a) for (_, _, a), (_, _, b) in zip(old, new, strict=True)) / largest
    ratio = change / (1.0 if last is None or last.change == 0.0 else last.change)
    bound = change * ratio / (1.0 - ratio) if ratio < 1.0 else change
    found = Convergence(1 if last is None else last.steps + 1, change, ratio, bound)
    if found.steps >= MOST_STEPS and not found.settled(line.rtol):
        raise NoSolutionError(
            f"tensions and roll loads on the vertical curves do not settle in {MOST_STEPS} steps (last change "
            f"{change:.2g}): choose larger radii"
        )
    return found


def curve_tensions(line: Line, steady: MotionState) -> list[tuple[Stretch, float, float]]:
    """Stretches on vertical curves with their radius [m] and mean tension in steady running [N]."""
    return list(_curve_tensions(line, steady))


def _curve_tensions(line: Line, steady: MotionState) -> Iterator[tuple[Stretch, float, float]]:
    radii = {section.name: section.radius for section in line.sections if section.curve is not None}
    means = (0.5 * (steady.starts + steady.ends)).tolist()
    for stretch, tension in zip(line.loop.stretches, means, strict=True):
        if stretch.section in radii:
            yield stretch, radii[stretch.section], tension


def pressing_masses(line: Line, steady: MotionState) -> dict[tuple[str, Strand], float]:
    """Mass per length like which tension presses on the rolls of every curve [kg/m]; negative where it lifts."""
    pressing = {}
    for stretch, radius, tension in curve_tensions(line, steady):
        pull = effective_tension(tension, line_mass=stretch.line_mass, belt_speed=line.speed)
        force = curve_set_force(abs(pull), radius=radius, spacing=stretch.spacing)
        pressing[stretch.section, stretch.strand] = curve_belt_mass(
            force if pull >= 0.0 else -force,
            spacing=stretch.spacing,
            inclination=stretch.inclination,
            gravity=line.gravity,
        )
    return pressing
