"""Coupling of tension and roll loads: tension loads the rolls, their resistance adds to the tension.

Tension presses on the rolls of vertical curves, draws the belt across on horizontal ones and holds a yielding belt.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import MessageQuantity, NoSolutionError
from conveyor.laws.horizontal_curve import DriftLaw, FlatDrift
from conveyor.laws.loading.curve_loads import curve_belt_mass, curve_set_force, effective_tension
from conveyor.line.line import Line
from conveyor.line.stretches import CurveLoads, Strand, Stretch
from conveyor.loop.tensions import MotionState

Array = NDArray[np.float64]

MAX_COUPLING_STEPS = 40


@dataclass(frozen=True)
class Convergence:
    """Convergence of tensions and roll loads.

    Attributes
    ----------
    steps : int
        Number of iterations.
    change : float
        Largest change of tension on coupled stretches in the last step, over the largest tension [-].
    ratio : float
        Change of the last step over that of the step before [-]; below 1 it converges.
    bound : float
        Remaining error, change · ratio/(1 - ratio), over the largest tension [-].
    """

    steps: int
    change: float
    ratio: float
    bound: float

    def has_converged(self, rtol: float) -> bool:
        """True if converged to a tolerance [-]; one step alone gives no ratio."""
        return self.steps > 1 and self.ratio < 1.0 and max(self.change, self.bound) <= rtol


def next_convergence(
    last: Convergence | None, before: MotionState, now: MotionState, line: Line, largest: float
) -> Convergence:
    """Convergence after one more step of the iteration.

    Parameters
    ----------
    last : Convergence or None
        Convergence after the step before.
    before, now : MotionState
        Steady running before the step and after it.
    line : Line
        The conveyor.
    largest : float
        Largest tension of all states [N].

    Raises
    ------
    NoSolutionError
        The iteration has taken too many steps.
    """
    moved = 0.5 * np.abs((now.starts - before.starts) + (now.ends - before.ends))
    change = float(moved[_coupled_stretches(line)].max()) / largest
    ratio = change / (1.0 if last is None or last.change == 0.0 else last.change)
    bound = change * ratio / (1.0 - ratio) if ratio < 1.0 else change
    state = Convergence(1 if last is None else last.steps + 1, change, ratio, bound)
    if state.steps >= MAX_COUPLING_STEPS and not state.has_converged(line.rtol):
        raise NoSolutionError(
            f"tensions and what they do to the rolls do not settle in {MAX_COUPLING_STEPS} steps (last change "
            f"{change:.2g}): "
            "choose larger radii of curves"
        )
    return state


def _coupled_stretches(line: Line) -> NDArray[np.bool_]:
    """Mask of stretches whose roll loads depend on tension, in loop order, shape (2n,)."""
    curved = {section.name for section in line.sections if section.curved}
    return np.array([line.support == "belt" or stretch.section in curved for stretch in line.loop.stretches])


def pull_per_width(line: Line, steady: MotionState, places: Array) -> Array:
    """T - m' V² per width along every stretch, in the line's order, shape (2n, k) [N/m].

    Parameters
    ----------
    line : Line
        The conveyor.
    steady : MotionState
        Steady running.
    places : ndarray, shape (k,)
        Distance from a stretch's middle over its length [-].

    Raises
    ------
    NoSolutionError
        The belt is slack, or its tension below m' v².
    """
    middle, rise = 0.5 * (steady.starts + steady.ends), steady.ends - steady.starts
    mass = np.array([stretch.line_mass for stretch in line.loop.stretches])
    tensions = middle[:, None] + rise[:, None] * places - (mass * line.speed**2)[:, None]
    least = int(tensions.min(axis=1).argmin())
    if tensions[least].min() <= 0.0:
        stretch = line.loop.stretches[least]
        left = float(tensions[least].min())
        raise NoSolutionError(
            'no tension is left to hold the belt in section "{}", {}: '
            "T - m' v² is {}; raise the take-up's tension (route.take_up.tension)",
            stretch.section,
            stretch.strand,
            MessageQuantity(left, "force", f"{left:.5g} N"),
        )
    return np.roll(tensions, line.count, axis=0) / line.belt.width


def _curve_tensions(line: Line, steady: MotionState) -> Iterator[tuple[Stretch, float, float]]:
    radii = {section.name: section.radius for section in line.sections if section.curve is not None}
    for stretch, tension in zip(line.loop.stretches, _mean_tensions(steady), strict=True):
        if stretch.section in radii and not stretch.closed:
            yield stretch, radii[stretch.section], tension


def _mean_tensions(steady: MotionState) -> list[float]:
    """Mean tension of every stretch in loop order [N]."""
    means: list[float] = (0.5 * (steady.starts + steady.ends)).tolist()
    return means


def inward_pull(line: Line, stretch: Stretch, tension: float) -> float:
    """Inward pull of the tension on one set of a horizontal curve [N]; 0 on the straight."""
    return 0.0 if stretch.turn is None else force_on_set(line, stretch, tension, stretch.turn.radius)


def downward_push(line: Line, stretch: Stretch, tension: float) -> float:
    """Downward push of the tension on one set of a horizontal curve that is vertical too [N]; negative: lift."""
    return 0.0 if stretch.turn is None else force_on_set(line, stretch, tension, stretch.turn.vertical)


def force_on_set(line: Line, stretch: Stretch, tension: float, radius: float) -> float:
    """Force of the tension [N] on one set of a curve of a radius [m], signed as that, in N.

    A slack belt counts as one without tension.
    """
    pull = effective_tension(max(0.0, tension), line_mass=stretch.line_mass, belt_speed=line.speed)
    return math.copysign(curve_set_force(abs(pull), radius=radius, spacing=stretch.spacing), pull * radius)


def loads_on_curves(line: Line, steady: MotionState) -> CurveLoads:
    """Loads of the steady tensions on curves."""
    return CurveLoads(pressing_masses(line, steady), belt_drifts(line, steady), pipe_pulls(line, steady))


def pipe_pulls(line: Line, steady: MotionState) -> dict[tuple[str, Strand], tuple[float, float]]:
    """Forces of the tension on one panel of every curve of a pipe, down and to the right [N]; negative: up, left."""
    curved, pulls = {section.name: section for section in line.sections if section.curved}, {}
    for stretch, tension in zip(line.loop.stretches, _mean_tensions(steady), strict=True):
        if stretch.closed and stretch.section in curved:
            section = curved[stretch.section]
            pulls[stretch.section, stretch.strand] = (
                force_on_set(line, stretch, tension, section.radius),
                force_on_set(line, stretch, tension, section.rightward_radius),
            )
    return pulls


def belt_drifts(line: Line, steady: MotionState) -> dict[tuple[str, Strand], float]:
    """Drift of the belt to the inside of every horizontal curve [m].

    Raises
    ------
    NoSolutionError
        The belt runs off its rolls.
    """
    by_stretch = {}
    for stretch, start, end in zip(line.loop.stretches, steady.starts, steady.ends, strict=True):
        if stretch.turn is not None:
            tension = 0.5 * float(start + end)
            law = stretch.turn.law(downward_push(line, stretch, tension), least=False)
            pull = inward_pull(line, stretch, tension)
            drift = law.drift(pull)
            if math.isinf(drift):
                raise _run_off_error(stretch, stretch.turn.radius, pull, law)
            by_stretch[stretch.section, stretch.strand] = drift
    return by_stretch


def _run_off_error(stretch: Stretch, radius: float, pull: float, law: DriftLaw | FlatDrift) -> NoSolutionError:
    """Error of a belt that runs off its rolls; the radius named would just hold it."""
    most = law.most
    way, cure, radii = "outside", "less banking or skew", list[MessageQuantity]()
    if pull > law.centred:
        way, cure = (
            "inside",
            f"more banking or a {'trough' if isinstance(law, FlatDrift) else 'deeper trough'}",
        )
        if most > 0.0:
            holds = radius * pull / most
            radii.append(MessageQuantity(holds, "length", f"{holds:.4g} m"))
            cure = f"a horizontal_radius well above {{}}, or {cure}"
    return NoSolutionError(
        f'the belt runs off its rolls to the {way} of the horizontal curve in section "{{}}", {stretch.strand}, in '
        f"steady running: choose {cure}",
        stretch.section,
        *radii,
    )


def pressing_masses(line: Line, steady: MotionState) -> dict[tuple[str, Strand], float]:
    """Mass per length equivalent to the tension's push on the rolls of every curve [kg/m]; negative: lift."""
    pressing = {}
    for stretch, radius, tension in _curve_tensions(line, steady):
        pressing[stretch.section, stretch.strand] = curve_belt_mass(
            force_on_set(line, stretch, tension, radius),
            spacing=stretch.spacing,
            inclination=stretch.inclination,
            gravity=line.gravity,
        )
    return pressing
