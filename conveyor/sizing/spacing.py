"""Spacing of the idler sets of a design in each section: by sag, bearing life and cost."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.laws.resistance import roll_line_mass
from conveyor.laws.roll_life import BALL_EXPONENT
from conveyor.line.roll_lives import idler_set_life
from conveyor.sizing.sized_design import SizedDesign
from conveyor.sizing.sizing_task import SizingTask

_ROUNDING: Final = 1e-5  # of six digits written


@dataclass(frozen=True)
class SectionSpacing:
    """The sets of one strand in a section.

    Attributes
    ----------
    section, strand : str
        Location.
    loading : bool
        Whether carry sets stand closer here because the bulk lands.
    length, built : float
        Length of the section; present spacing [m].
    sag : float
        Widest spacing by sag at the lowest steady tension [m].
    tension_per_spacing : float
        Tension required by sag per metre of spacing [N/m].
    bearings : float
        Widest spacing by the required L10 of a set's bearings; infinite without load [m].
    grows, falls : float
        Coefficients of the yearly cost of a metre at a spacing a, grows a^(1/3) + falls/a [currency/a]; grows is 0 by
        a classical method.
    """

    section: str
    strand: str
    loading: bool
    length: float
    built: float
    sag: float
    tension_per_spacing: float
    bearings: float
    grows: float
    falls: float

    @property
    def cheapest(self) -> float:
        """Spacing of minimum cost, (3 falls/grows)^(3/4) [m]; infinite where no resistance grows with it."""
        if self.grows == 0.0:
            return math.inf
        return math.pow(3.0 * self.falls / self.grows, 0.75)

    def cost(self, spacing: float) -> float:
        """Yearly cost of indentation, rotation and the sets themselves [currency/(a m)]."""
        return self.grows * math.cbrt(spacing) + self.falls / spacing


def section_spacings(task: SizingTask, design: SizedDesign) -> Iterator[SectionSpacing]:
    """The sections of both strands, each from the tail: carry sets first.

    Parameters
    ----------
    task : SizingTask
        The duty.
    design : SizedDesign
        The design, with its tensions and friction.

    Notes
    -----
    Per metre of section at a spacing a: indentation as a^(1/3), rotation and cost of the sets as 1/a (derived, by the
    scaling of the estimate); by a classical method the mass of the rolls or Ai alone, as 1/a. Sag a (m'_B + m'_G)
    g/(8 T) at the lowest steady tension. Bearing life falls with the third power of the load.
    """
    line, prices = design.found.line, task.duty.prices.amounts
    width, roll = design.choice.trough.width, design.choice.roll
    even = _spacing_by_section(task, design)
    yearly = float(design.costs.yearly["rolls"]) / float(design.costs.capital["rolls"])
    worth = line.speed / task.efficiency * task.seconds / JOULE_PER_KWH * task.energy_price
    rolls = {"carry": (3, width.three), "return": width.return_rolls[:2]}
    for k, strand in enumerate(("carry", "return")):
        number, long = rolls[strand]
        one_set = number * (prices["roll"] + prices["roll_mass"] * roll.mass(long)) + prices["set"] * width.belt
        for i in range(line.count):
            at = i if strand == "carry" else 2 * line.count - 1 - i
            stretch = line.stretches[at]
            length = stretch.length
            indentation, rotation = _spacing_forces(task, design.found, at)
            now, lowest = stretch.spacing, min(_lowest_tension(one, at) for one in design.pair)
            per_spacing = stretch.line_mass * line.gravity / (8.0 * task.sags[k])
            life = idler_set_life(stretch, line.speed)
            yield SectionSpacing(
                section=stretch.section,
                strand=strand,
                loading=strand == "carry" and now < (1.0 - _ROUNDING) * even.get(stretch.section, math.inf),
                length=length,
                built=now,
                sag=max(0.0, lowest) / per_spacing,
                tension_per_spacing=per_spacing,
                bearings=math.inf
                if life is None
                else now * math.pow(3600.0 * life.hours / task.roll_life, 1.0 / BALL_EXPONENT),
                grows=worth * indentation / length / math.cbrt(now),
                falls=worth * rotation / length * now + yearly * one_set,
            )


def _spacing_by_section(task: SizingTask, design: SizedDesign) -> dict[str, float]:
    """Carry spacing of each section of the duty, where no bulk lands [m]."""
    names = [section.name for section in task.duty.sized_route.sections]
    return dict(zip(names, design.choice.graduated or (design.choice.carry,) * len(names), strict=True))


def _spacing_forces(task: SizingTask, found: CalculatedConveyor, at: int) -> tuple[float, float]:
    """Resistances of a stretch that go as a^(1/3) and as 1/a with its spacing a [N]."""
    line, stretch, classical = found.line, found.line.stretches[at], task.classical
    if classical is None:
        forces = found.stretches[at].forces
        return forces["indentation"], forces["idler_rotation"]
    if classical.cema is not None:
        idlers = classical.cema.temperature * classical.cema.idler_friction if stretch.strand == "carry" else 0.0
        return 0.0, stretch.length * idlers / stretch.spacing
    rolls = roll_line_mass(stretch.set_mass, spacing=stretch.spacing)
    factor = classical.coefficient * float(line.friction_factors[at])
    return 0.0, factor * stretch.length * line.gravity * rolls


def _lowest_tension(one: CalculatedConveyor, at: int) -> float:
    """Lowest steady tension of a stretch [N]; `at` counts as in the line, the loop begins at the head."""
    steady, i = one.balance.equilibrium.steady, (at + one.line.count) % (2 * one.line.count)
    return float(min(steady.starts[i], steady.ends[i]))


def graduated_spacings(task: SizingTask, design: SizedDesign) -> Iterator[tuple[float, ...]]:
    """Carry spacings of each section, the cheapest that sag and bearings allow [m].

    At the tensions of the design; if sag sets the take-up, also at tensions reduced as far as closer sets in the
    slackest section, and everything else, allow.
    """
    names = [section.name for section in task.duty.sized_route.sections]
    carry = {one.section: one for one in section_spacings(task, design) if one.strand == "carry" and not one.loading}
    if not carry:
        return
    slackest = min(carry.values(), key=lambda one: one.sag / one.built)
    spare, per_metre = _sag_reserve(design), slackest.tension_per_spacing
    closer = (min(spare, (slackest.sag - a) * per_metre) for a in task.spacings[0] if a < slackest.built)
    for let_down in dict.fromkeys((0.0, *(closer if spare > 0.0 else ()))):
        cheapest = {
            name: min(_allowed_spacings(task, design, one, let_down), key=one.cost) for name, one in carry.items()
        }
        yield tuple(cheapest.get(name, design.choice.carry) for name in names)


def _allowed_spacings(task: SizingTask, design: SizedDesign, one: SectionSpacing, let_down: float) -> tuple[float, ...]:
    """Spacings of the series allowed in a section; the present one is allowed at its own tensions."""
    usual, _ = task.widest_spacings(design.choice.trough)
    widest = min(one.sag - let_down / one.tension_per_spacing, one.bearings, design.choice.back, usual)
    borne = tuple(a for a in task.spacings[0] if a <= widest or (a == one.built and let_down == 0.0))
    return borne or (min(task.spacings[0]),)


def _sag_reserve(design: SizedDesign) -> float:
    """Take-up tension required by carry sag beyond all other conditions, the least of both calculations [N]."""
    return max(
        0.0,
        min(
            one.balance.equilibrium.setting
            - max(
                needed
                for name, needed in one.balance.equilibrium.conditions.items()
                if not name.startswith("sag, carry")
            )
            for one in design.pair
        ),
    )
