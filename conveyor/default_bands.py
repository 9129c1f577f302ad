"""Range of the power from the defaults in use: each at both ends of its band.

Forces are linear in the defaults, so neither contacts nor tensions are solved again. Bands are taken to be independent;
changes down and changes up add as the root of their squares. A default is one line of `DEFAULTS`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.effects import Effect, ends_of_band
from conveyor.errors import NoSolutionError
from conveyor.force_sums import Force
from conveyor.laws.misalignment import MISALIGNMENT, misalignment_friction
from conveyor.laws.resistance import (
    BED_FRICTION,
    CLEANER_PRESSURE,
    FLEXURE_COEFFICIENT,
    ROLL_ON_BELT_FRICTION,
    SERVICE_DRAG,
    Default,
    Site,
)
from conveyor.laws.resistance.cema import (
    CLEANER_PER_INCH,
    INCH,
    POUND_FORCE,
    cema_pulley_friction,
)
from conveyor.line.belt_contacts import BeltContacts
from conveyor.line.covers import compounds_by_strand
from conveyor.line.roll_drags import assumed_drag_share
from conveyor.line.stretches import STRANDS
from conveyor.loop.balance import OpenLoop, close_loops
from conveyor.loop.equilibrium import Equilibrium
from conveyor.rubber.rolling_test_factor import UNTESTED_FACTOR
from conveyor.units.sentences import Message, escape_braces, message

Shares: TypeAlias = NDArray[np.float64] | float
"""Share of a force that depends on a default [-]: of every stretch, shape (2n,), or at one place."""
Share: TypeAlias = Callable[[CalculatedConveyor, Force], Shares]
Band: TypeAlias = Callable[[CalculatedConveyor], tuple[float, float]]


@dataclass(frozen=True)
class DefaultBand:
    """A default of the spec: the forces it scales, its band, the fields that replace it.

    Attributes
    ----------
    key, what : str
        Key in files; label for people.
    low, high : float
        90 % band of the dependent forces over those computed [-].
    give : str
        Fields that replace it.
    forces : tuple of str
        Keys of the forces that may depend on it.
    share : callable
        Share of such a force of a conveyor that depends on this default; 0 if it is not in use.
    band : callable, optional
        Band of a conveyor, if it is not the same for all; replaces `low` and `high`.
    """

    key: str
    what: str
    low: float
    high: float
    give: str
    forces: tuple[str, ...]
    share: Share
    band: Band | None = None

    def ends(self, result: CalculatedConveyor) -> tuple[float, float]:
        """Both ends of the band on a conveyor [-]."""
        return (self.low, self.high) if self.band is None else self.band(result)


def _relative_band(of: Default) -> tuple[float, float]:
    """Band of forces proportional to a figure with a range [-]."""
    return of.low / of.value, of.high / of.value


def _usual_part_share(_result: CalculatedConveyor, force: Force) -> float:
    """All of a force from a usual part that stands in for a missing one."""
    return float(force.assumed)


def _roll_drag_share(result: CalculatedConveyor, _force: Force) -> Shares:
    pairs = zip(result.line.stretches, result.line.roll_drags, strict=True)
    return np.array([assumed_drag_share(result.conveyor, stretch.idlers, drags) for stretch, drags in pairs])


def _flexure_share(result: CalculatedConveyor, _force: Force) -> Shares:
    calculation = result.conveyor.calculation
    return float(calculation.flexure is None and calculation.flexure_share is None)


def _misalignment_share(result: CalculatedConveyor, _force: Force) -> Shares:
    """Stretches whose sets have no misalignment of their own."""
    return np.array([float(stretch.idlers.misalignment is None) for stretch in result.line.stretches])


def _misalignment_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band from the best to the worst alignment of such a site."""
    return _site_band(result.conveyor.site)


def _assumed_beds(result: CalculatedConveyor) -> list[tuple[Default, float]]:
    """Friction of every plate that has none of its own, and the weight on it [N]."""
    pairs = zip(result.conveyor.route.sections, result.line.stretches, strict=False)
    return [
        (BED_FRICTION[section.bed.surface, section.bed.underside], stretch.line_mass * stretch.length)
        for section, stretch in pairs
        if section.bed is not None and section.bed.friction is None
    ]


def _bed_share(result: CalculatedConveyor, _force: Force) -> Shares:
    """Stretches on plates without a friction of their own."""
    given = [section.bed is None or section.bed.friction is not None for section in result.conveyor.route.sections]
    return np.array([*(not one for one in given), *(False for _ in given)], dtype=np.float64)


def _bed_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band from the lowest to the highest of makers' figures over those taken, weighted by load."""
    low, middle, high = (
        math.fsum(getattr(of, end) * load for of, load in _assumed_beds(result)) for end in ("low", "value", "high")
    )
    return low / middle, high / middle


def _hopper_share(result: CalculatedConveyor, force: Force) -> Shares:
    """All of the pull of a hopper without a friction of its own."""
    points = zip(result.line.loading, result.conveyor.route.feeding_points, strict=False)
    return float(any(
        point.spot == force.spot and given.hopper is not None and given.hopper.shear_friction is None
        for point, given in points
    ))  # fmt: skip


@cache
def _site_band(site: Site) -> tuple[float, float]:
    of_site = MISALIGNMENT[site]
    low, middle, high = map(misalignment_friction, (of_site.low, of_site.value, of_site.high))
    return low / middle, high / middle


def _untested_share(result: CalculatedConveyor, _force: Force) -> NDArray[np.float64]:
    """Indentation of the strands whose rubber has no rolling-resistance tests."""
    covers = result.contacts.covers
    return np.array([float(covers[stretch.strand].test_factor is None) for stretch in result.line.stretches])


def _tested_share(result: CalculatedConveyor, force: Force) -> Shares:
    """Indentation of the strands whose rubber has tests."""
    return 1.0 - _untested_share(result, force)


def _tests_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band enclosing those of the test factors of both strands, spectra beyond the tests included."""
    lows, highs = zip(*(result.contacts.test_factor_range(strand) for strand in STRANDS), strict=True)
    return min(lows), max(highs)


def _bending_share(result: CalculatedConveyor, _force: Force) -> Shares:
    """Indentation under a flexible belt whose carcass has no bending loss."""
    given = result.conveyor.belt.carcass.bending_loss > 0.0
    return float(isinstance(result.contacts, BeltContacts) and not given)


def _bending_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band up to the flexure by load and sag of a stiff carcass, over the indentation."""
    contacts = result.contacts
    left_out = contacts.flexure_left_out if isinstance(contacts, BeltContacts) else 0.0
    return 1.0, 1.0 + left_out / result.balance.forces.indentation


def _cleaner_pressure_share(result: CalculatedConveyor, force: Force) -> float:
    """1 if a cleaner is given without its pressure, else 0."""
    names = [each.name for each in result.balance.singles if each.key == "cleaner"]
    cleaner = dict(zip(names, result.conveyor.route.cleaners, strict=False)).get(force.name)
    return float(cleaner is not None and "pressure" not in cleaner.model_fields_set)


def _cleaners_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band from one usual cleaner to CEMA's force on each."""
    line = result.line
    usual = math.fsum(force.total for force in result.balance.singles if force.key == "cleaner" and force.assumed)
    by_cema = CLEANER_PER_INCH.value * POUND_FORCE / INCH * line.belt.width
    return 0.5, by_cema * math.fsum(scraper.count for scraper in line.scrapers) / usual


def _pulleys_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band from half the resistance of usual pulleys to CEMA's with a take-up and its bends."""
    usual = math.fsum(force.total for force in result.balance.singles if force.key in _PULLEYS and force.assumed)
    return 0.5, max(2.0, cema_pulley_friction(_CEMA_PULLEYS) / usual)


def _illustrative_share(result: CalculatedConveyor, _force: Force) -> Shares:
    """Indentation of the strands whose compound is illustrative, representing a kind of cover."""
    compounds = compounds_by_strand(result.conveyor)
    kinds = {strand: float(compound.kind == "illustrative") for strand, compound in compounds.items()}
    return np.array([kinds[stretch.strand] for stretch in result.line.stretches])


def _pipe_share(result: CalculatedConveyor, _force: Force) -> NDArray[np.float64]:
    """Indentation of the strands that are pipes."""
    return np.array([float(stretch.idlers.shape.closed) for stretch in result.line.stretches])


def _pipe_band(result: CalculatedConveyor) -> tuple[float, float]:
    """Band of the strip's law; narrower above where the forming load is measured."""
    return PIPE_STRIP_BANDS["forming load" if result.conveyor.belt.transverse_stiffness is None else "stiffness"]


PIPE_STRIP_BANDS: Final = {"stiffness": (0.8, 1.25), "forming load": (0.75, 1.1)}
"""Indentation by the elastica between flat rolls, over that by the linear strip of `pipe_strip_forces` [-], at the same
stiffness and at the same forming load: 36 of 40 cases and more, laps of 6 to 25 %, empty and full
(tests/validation/test_pipe_strip.py)."""
COVERS_OF_A_KIND: Final = (0.7, 1.4)
"""Indentation of covers sold under one name, over their middle [-]: general knowledge; a design program takes 0.80 for
low-resistance covers, tests of single makes differ by as much either way."""
_PULLEYS: Final = ("wrap", "pulley_bearings")
_CEMA_PULLEYS: Final = ("slack", "slack", "other", "other")
"""Tail, take-up and its two bends; CEMA leaves out the driven head."""

_INDENTATION: Final = ("indentation",)

DEFAULTS: Final = (
    DefaultBand("roll_drag", "drag of the rolls in service", *_relative_band(SERVICE_DRAG),
                "idlers.*.roll.drag or drag_law", ("idler_rotation",), _roll_drag_share),
    DefaultBand("flexure", "flexure of belt and bulk over load and sag", *_relative_band(FLEXURE_COEFFICIENT),
                "calculation.flexure or flexure_share", ("flexure",), _flexure_share),
    DefaultBand("tilt", "friction of tilted rolls on the belt", *_relative_band(ROLL_ON_BELT_FRICTION),
                "idlers.*.tilt_angle: 0 deg", ("tilt",), lambda _found, _force: 1.0),
    DefaultBand("misalignment", "alignment of the idlers", 1.0, 1.0, "idlers.*.misalignment",
                ("misalignment",), _misalignment_share, _misalignment_band),
    DefaultBand("bed_friction", "friction of belt on plates", 1.0, 1.0, "route.sections[].bed.friction",
                ("slider_bed",), _bed_share, _bed_band),
    DefaultBand("hopper_shear", "shear of the bulk under hoppers", 0.8, 1.0, "route.feeding.hopper.shear_friction",
                ("hopper_pull",), _hopper_share),
    DefaultBand("feeding", "acceleration of the bulk from rest", 0.5, 1.0, "route.feeding",
                ("acceleration",), _usual_part_share),
    DefaultBand("skirts", "usual skirts and their seals", 0.5, 2.0, "route.feeding",
                ("loading_skirts", "skirts", "skirt_seals"), _usual_part_share),
    DefaultBand("cleaners", "usual cleaners", 1.0, 1.0, "route.cleaners",
                ("cleaner",), _usual_part_share, _cleaners_band),
    DefaultBand("cleaner_pressure", "pressure of the cleaners", *_relative_band(CLEANER_PRESSURE),
                "route.cleaners[].pressure", ("cleaner",), _cleaner_pressure_share),
    DefaultBand("pipe_rolls", "loads of a pipe's rolls by the linear strip", 1.0, 1.0,
                "idlers.*.pipe.forming_load", _INDENTATION, _pipe_share, _pipe_band),
    DefaultBand("level", "test factor of the indentation, no rolling-resistance tests", 1.0, UNTESTED_FACTOR,
                "a compound with tests", _INDENTATION, _untested_share),
    DefaultBand("tested_level", "test factor of the indentation, tests and spectrum", 1.0, 1.0,
                "tests of the belt itself", _INDENTATION, _tested_share, _tests_band),
    DefaultBand("bending_loss", "loss of the carcass that bends, 0", 1.0, 1.0, "belt.carcass.bending_loss",
                _INDENTATION, _bending_share, _bending_band),
    DefaultBand("pulleys", "usual pulleys", 1.0, 1.0, "route.pulleys",
                _PULLEYS, _usual_part_share, _pulleys_band),
    DefaultBand("cover", "make of the covers, others of their kind", *COVERS_OF_A_KIND, "compounds measured and tested",
                _INDENTATION, _illustrative_share),
)  # fmt: skip
"""Every default with a band; one more line is one more default.

Bands of usual parts are general knowledge: bulk landing at half the belt's speed, half and twice the skirts, one
cleaner, half the pulleys' resistance; their high ends are CEMA's: 5 lbf/in of each cleaner, and 150 lbf at tail and
take-up, 100 at the two bends before it.
"""


@dataclass(frozen=True)
class DefaultEffect(Effect):
    """Effect of a default in use on the power; `key` and `give` as in `DefaultBand`.

    Attributes
    ----------
    low_factor, high_factor : float
        Ends of its band [-].
    """

    key: str = ""
    give: str = ""
    low_factor: float = 1.0
    high_factor: float = 1.0


@dataclass(frozen=True)
class PowerRange:
    """Motor power with its range from the defaults.

    Attributes
    ----------
    motor, low, high : float
        At the motors' shafts: computed, and its 90 % band [W].
    effects : tuple of DefaultEffect
        One per default in use, the largest swing first.
    friction : tuple of float
        90 % band of the friction over the computed one [-]: of every force but lift and acceleration of the bulk.
    design_friction, design : float
        Friction that motors, belt, grip and take-up are designed for, over the computed one [-]; the power with it [W].
        The least that is certain where the motors hold more with it than they give with the highest.
    design_source : str
        Where that friction comes from.
    untested : tuple of Message
        Rubbers without rolling-resistance tests at the belt's temperature.
    """

    motor: float
    low: float
    high: float
    effects: tuple[DefaultEffect, ...]
    friction: tuple[float, float] = (1.0, 1.0)
    design_friction: float = 1.0
    design: float = 0.0
    design_source: str = ""
    untested: tuple[Message, ...] = ()


def power_range(result: CalculatedConveyor) -> PowerRange:
    """Range of the motor power from the defaults in use.

    Parameters
    ----------
    result : CalculatedConveyor
        Result of `calculate`.

    Returns
    -------
    PowerRange
        The band, and the effect of every default.

    Notes
    -----
    Rolls keep their loads, and pulleys their wraps but for those that scale with a default of their own; what the
    tensions add to both is of second order.
    """
    motor, equilibrium = result.balance.layout.motor, result.balance.equilibrium
    changes = list(_force_changes(result))
    effects = []
    for assumed, ends, forces in changes:
        low, high = (motor(equilibrium.force + change) for change in forces)
        effects.append(
            DefaultEffect(
                assumed.what, f"x {ends[0]:.3g}", "x 1", f"x {ends[1]:.3g}", low, high,
                assumed.key, assumed.give, *ends,
            )
        )  # fmt: skip
    effects.sort(key=lambda effect: -effect.swing)
    friction = _combined_band(equilibrium, [forces for _, _, forces in changes])
    low, high = sorted(map(motor, map(equilibrium.resistance, friction)))
    return PowerRange(
        motor(equilibrium.force), low, high, tuple(effects), friction, *_power_to_design_for(result),
        tuple(_untested_rubbers(result)),
    )  # fmt: skip


def _power_to_design_for(result: CalculatedConveyor) -> tuple[float, float, str]:
    """Friction over the computed one [-] with which the motors give or hold most, that power [W] and its source."""
    line, equilibrium, motor = result.line, result.balance.equilibrium, result.balance.layout.motor
    most, least = motor(equilibrium.design_force), motor(equilibrium.least_force)
    if abs(least) > abs(most):
        return line.least_friction, least, "the least that is certain"
    given = result.conveyor.drive.design_friction is not None
    return line.design_friction, most, "drive.design_friction" if given else "the upper end of the band"


def friction_band(result: CalculatedConveyor) -> tuple[float, float]:
    """90 % band of the friction over the computed one [-], from the defaults in use; certain forces have none.

    Bands of single defaults are independent: the changes of the drive force add as the root of their squares.
    """
    return _combined_band(result.balance.equilibrium, [forces for _, _, forces in _force_changes(result)])


def close_design_loops(
    results: Sequence[CalculatedConveyor], loops: Sequence[OpenLoop]
) -> list[CalculatedConveyor | NoSolutionError]:
    """Results with their loops closed again, designed for the upper end of the band of friction of each.

    Parameters
    ----------
    results : sequence of CalculatedConveyor
        Calculated with the expected friction alone.
    loops : sequence of OpenLoop
        Their loops.
    """
    asked = [
        loop._replace(layout=loop.layout.designed_for(friction_band(one)[1]))
        for one, loop in zip(results, loops, strict=True)
    ]
    return [
        made if isinstance(made, NoSolutionError) else replace(one, balance=made)
        for one, made in zip(results, close_loops(asked), strict=True)
    ]


def _combined_band(equilibrium: Equilibrium, changes: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """Band of the friction over the computed one [-] from changes of the drive force at both ends [N]."""
    rubbing = equilibrium.force - equilibrium.resistance(0.0)
    if rubbing <= 0.0:
        return 1.0, 1.0
    low, high = ends_of_band(0.0, changes)
    return 1.0 + low / rubbing, 1.0 + high / rubbing


def _force_changes(
    result: CalculatedConveyor,
) -> Iterator[tuple[DefaultBand, tuple[float, float], tuple[float, float]]]:
    """Defaults in use, the ends of their bands, and the change of the drive force at both ends [N].

    None by a classical method: its factors have the allowance of their book.
    """
    if result.line.method != "viscoelastic":
        return
    by_key: dict[str, list[Force]] = {}
    for force in result.balance.every:
        by_key.setdefault(force.key, []).append(force)
    for assumed in DEFAULTS:
        forces = (force for key in assumed.forces for force in by_key.get(key, ()))
        depending = math.fsum(_shared_force(force, assumed.share(result, force)) for force in forces)
        if depending:
            low, high = assumed.ends(result)
            yield assumed, (low, high), ((low - 1.0) * depending, (high - 1.0) * depending)


def _untested_rubbers(result: CalculatedConveyor) -> Iterator[Message]:
    """Notes on rubbers tested at other temperatures: which, and the spectrum that extrapolates the test factor."""
    by_rubber = result.line.method == "viscoelastic"  # the other methods know no rubber
    factors = [result.contacts.covers[strand].test_factor for strand in STRANDS if by_rubber]
    names: dict[tuple[tuple[float, ...], str], dict[str, None]] = {}
    for tested_by in factors:
        if tested_by is None or tested_by.rolling_tests.tested_at(tested_by.temperature):
            continue
        tested = tuple(dict.fromkeys(tested_by.rolling_tests.temperatures[[0, -1]].tolist()))
        spectrum = "constructed" if tested_by.compound.kind == "illustrative" else "measured"
        names.setdefault((tested, spectrum), {})[tested_by.compound.name] = None
    for (tested, spectrum), compounds in names.items():
        several = ", ".join(escape_braces(f'"{name}"') for name in compounds)
        yield message(
            f"{several} {'is' if len(compounds) == 1 else 'are'} tested at {' to '.join('{}' for _ in tested)}, not at "
            f"{{}}: the {spectrum} spectrum extrapolates the test factor",
            *((kelvin, "temperature") for kelvin in (*tested, result.temperature)),
        )


def _shared_force(force: Force, share: Shares) -> float:
    """Share of a force [N]; the same of all stretches, or one for each."""
    return share * force.total if isinstance(share, float) else float(np.sum(force.newtons * share))
