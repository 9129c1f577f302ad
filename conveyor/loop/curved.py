"""Vertical curves: tension presses on the rolls, their resistance adds to the tension; iterated to convergence."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from conveyor.errors import NoSolutionError
from conveyor.laws.loading.curves import curve_belt_mass, curve_set_force, effective_tension
from conveyor.line.stretches import Strand, Stretch
from conveyor.line.walk import StretchResult, Track, indented, surfaces, worked_surfaces
from conveyor.loop.balance import Balance, balance
from conveyor.models import Conveyor
from conveyor.units import si

Masses = Mapping[tuple[str, Strand], float]

_STEPS = 40


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


@dataclass(frozen=True, eq=False)
class Run:
    """A conveyor calculated: forces along the belt, the whole, the mass that tension adds on curves [kg/m]."""

    stretches: tuple[StretchResult, ...]
    balance: Balance
    pressing: Masses
    convergence: Convergence | None


Settling: TypeAlias = Generator[Masses, tuple[StretchResult, ...], Run]
"""Asks for the forces along the belt under a pressing mass [kg/m], is sent them, and returns the run."""


def run(conveyor: Conveyor) -> Run:
    """Calculate a conveyor; with vertical curves tensions and rolls' loads are iterated until they agree.

    Raises
    ------
    NoSolutionError
        A roll's contact has no answer, the tensions do not settle, or the belt lifts off with its bulk.
    RangeError
        A compound is not known at the belt's temperature.
    """
    steps = settling(conveyor)
    pressing = next(steps)
    while True:
        try:
            pressing = steps.send(_walk(conveyor, pressing))
        except StopIteration as end:
            done: Run = end.value
            return done


def settling(conveyor: Conveyor) -> Settling:
    """The iteration of `run`, step by step, so that many conveyors can be settled side by side.

    Raises
    ------
    NoSolutionError
        The tensions do not settle, or the belt lifts off with its bulk.
    """
    stretches = yield {}
    found = balance(conveyor, stretches)
    if not any(section.curve for section in conveyor.route.sections):
        return Run(stretches, found, {}, None)
    before, change = _curve_tensions(conveyor, found), 1.0
    for step in range(1, _STEPS + 1):
        pressing = pressing_masses(conveyor, found)
        stretches = yield pressing
        found = balance(conveyor, stretches)
        now, last = _curve_tensions(conveyor, found), change
        change = max(abs(now[key] - before[key]) for key in now) / found.tensions.largest
        before = now
        ratio = change / last
        bound = change * ratio / (1.0 - ratio) if ratio < 1.0 else change
        if step > 1 and ratio < 1.0 and max(change, bound) <= conveyor.calculation.rtol:
            return Run(stretches, found, pressing, Convergence(step, change, ratio, bound))
    raise NoSolutionError(
        f"tensions and roll loads on the vertical curves do not settle in {_STEPS} steps (last change {change:.2g}): "
        "choose larger radii"
    )


def _walk(conveyor: Conveyor, pressing: Masses) -> tuple[StretchResult, ...]:
    track = Track(conveyor, extra_mass=pressing)
    (found,) = indented([track], [worked_surfaces(track, surfaces(conveyor), si(conveyor.ambient.belt))])
    if isinstance(found, NoSolutionError):
        raise found
    return found


def pressing_masses(conveyor: Conveyor, found: Balance) -> dict[tuple[str, Strand], float]:
    """Mass per length like which tension presses on the rolls of every curve [kg/m]; negative where it lifts."""
    speed, gravity = si(conveyor.belt.speed), si(conveyor.calculation.gravity)
    radii = {s.name: s.signed_radius for s in conveyor.route.sections if s.curve is not None}
    pressing = {}
    for stretch, tension in _tensions(found, radii):
        pull = effective_tension(tension, line_mass=stretch.line_mass, belt_speed=speed)
        force = curve_set_force(abs(pull), radius=radii[stretch.section], spacing=stretch.spacing)
        pressing[stretch.section, stretch.strand] = curve_belt_mass(
            force if pull >= 0.0 else -force,
            spacing=stretch.spacing,
            inclination=stretch.inclination,
            gravity=gravity,
        )
    return pressing


def _tensions(found: Balance, radii: Mapping[str, float]) -> list[tuple[Stretch, float]]:
    """Curved stretches and their mean tension in steady running [N]."""
    steady, order = found.settled.steady, found.settled.loop.geometry.stretches
    means = (0.5 * (steady.starts + steady.ends)).tolist()
    return [
        (stretch, tension) for stretch, tension in zip(order, means, strict=True) if stretch.section in radii
    ]


def _curve_tensions(conveyor: Conveyor, found: Balance) -> dict[tuple[str, Strand], float]:
    radii = {s.name: s.signed_radius for s in conveyor.route.sections if s.curve is not None}
    return {(stretch.section, stretch.strand): tension for stretch, tension in _tensions(found, radii)}
