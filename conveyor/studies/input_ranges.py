"""Uncertainty of the power: every uncertain input recalculated at both ends of its range, and the combined band.

Ranges are taken as 90 % intervals of independent inputs. Bands are 90 % intervals too: the root of the squares of all
changes, and a Latin hypercube (McKay, Beckman, Conover 1979) on the first-order model P = P0 + Σ c_i(z_i), c_i a
straight line from the middle to each end, z_i normal with its ends at the 5 % and 95 % quantiles. Both are exact for a
power that is linear and inputs that are normal.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from conveyor.arguments.argument_types import check_arguments
from conveyor.calculated_conveyor import CalculatedConveyor, NoAnswer, Variant
from conveyor.default_bands import power_range
from conveyor.effects import Effect, root_of_squares
from conveyor.errors import InputError
from conveyor.line.covers import compounds_by_strand
from conveyor.line.stretches import Strand
from conveyor.loop.loop_layout import TakeUpSetting
from conveyor.models import Conveyor, RubberCompound, StrainDependence, Uncertainty
from conveyor.models.variants import scale_quantity, with_alternative, with_belt_temperature_changed
from conveyor.pipeline import ProgressCallback, calculate_many
from conveyor.rubber.rolling_test_factor import BAND_COVERAGE, quantile_band
from conveyor.studies.monte_carlo import DrawnInput, MonteCarlo, calculate_draws
from conveyor.units import Quantity, from_si, interpolate_quantity, text
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import percent

Array = NDArray[np.float64]

BAND_END: Final = float(ndtri(0.5 + 0.5 * BAND_COVERAGE))
"""Standard deviations from the middle of a range to its ends, for a normal distribution."""
SAMPLES: Final = 4096
"""Points of the hypercube: quantiles are then accurate to about 1 % of the band."""


_COVERED_DEFAULTS: Final = {
    "roll_drag": "roll_drag",
    "flexure_share": "flexure",
    "cleaner_pressure": "cleaner_pressure",
    "rubber": "tested_level",
}
"""Ranges that replace the band of a default, with the key of the default."""


@dataclass(frozen=True, eq=False, repr=False)
class CalculatedRanges:
    """Motor power with its band, and the effect of every input.

    Attributes
    ----------
    conveyor : Conveyor
        The spec.
    motor : float
        Motor shaft power of the spec [W].
    effects : tuple of Effect
        One per input, the largest swing first.
    band, sampled : tuple of float
        90 % interval by the root of the squares, and by the hypercube [W].
    notes : tuple of str
        Inputs left out, and the reason.
    monte_carlo : MonteCarlo or None
        Draws of all inputs together, each calculated in full; None if the ranges request none.
    uncovered_defaults : tuple of Effect
        Defaults in use that no range covers, in neither the bands nor the draws.
    """

    conveyor: Conveyor
    motor: float
    effects: tuple[Effect, ...]
    band: tuple[float, float]
    sampled: tuple[float, float]
    notes: tuple[str, ...]
    monte_carlo: MonteCarlo | None = None
    uncovered_defaults: tuple[Effect, ...] = ()

    def __repr__(self) -> str:
        ends = " to ".join(f"{value / 1e3:.1f}" for value in self.band)
        words = f"90 % interval of its ranges {ends} kW"
        if self.uncovered_defaults:
            whole = " to ".join(f"{value / 1e3:.1f}" for value in self.band_with_defaults)
            words += f", with the defaults in use {whole} kW"
        return f'UncertaintyStudy("{self.conveyor.name}": motor power {self.motor / 1e3:.1f} kW, {words})'

    @property
    def band_with_defaults(self) -> tuple[float, float]:
        """90 % interval by the ranges and by the defaults not covered by any range [W]."""
        return root_of_squares(self.motor, (*self.effects, *self.uncovered_defaults))

    @property
    def shares(self) -> tuple[float, ...]:
        """First-order share of each input in the variance of the power [-]; zero without variance."""
        squares = [effect.swing**2 for effect in self.effects]
        whole = math.fsum(squares)
        return tuple(square / whole if whole > 0.0 else 0.0 for square in squares)


_SWEEP_EXTENSION: Final = 2.0
"""Strain up to which sweeps are extended, over the working strain: softer rubber is strained more [-]."""


@dataclass(frozen=True)
class _Variation:
    """An input at both ends of its range."""

    name: str
    low: str
    given: str
    high: str
    variants: tuple[Variant, ...]
    """Low and high end, or replicas whose quantiles are taken."""
    replicas: bool = False
    drawn: DrawnInput | None = None
    """Its change by draws; None if it is not drawn."""


@check_arguments
def analyse_ranges(
    conveyor: Conveyor,
    ranges: Uncertainty | None = None,
    *,
    take_up: TakeUpSetting | None = None,
    rtol: float | None = None,
    samples: int = SAMPLES,
    seed: int = 0,
    progress: ProgressCallback | None = None,
) -> CalculatedRanges:
    """Calculate a conveyor at both ends of every uncertain input.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    ranges : Uncertainty, optional
        Ranges; by default those of the spec.
    take_up : TakeUpSetting, optional
        Setting and side in every variant, as `analyse_studies` determines them for every load; by default the least of
        each, as in `analyse`.
    rtol : float, optional
        Relative tolerance of the contacts [-]; by default that of the spec.
    samples : int
        Points of the hypercube, at least 2.
    seed : int
        Of the hypercube.
    progress : callable, optional
        Called with the items done and their total.

    Returns
    -------
    CalculatedRanges
        Tornado and bands.

    Raises
    ------
    InputError
        There is no range, or an end of one is invalid (bulk that does not fit, a temperature without data).
    NoSolutionError, RangeError
        The conveyor, or an end of a range, has no answer.

    Notes
    -----
    Contacts are solved in one batch; a range that does not change them (roll drag, flexure, cleaners) costs none.

    Examples
    --------
    >>> import conveyor
    >>> line = conveyor.load("examples/specs/overland_10km.yaml")  # doctest: +SKIP
    >>> conveyor.uncertainty.study(line).table  # doctest: +SKIP
    """
    given = conveyor.uncertainty if ranges is None else ranges
    if given is None:
        raise InputError("uncertainty: missing; give the spec ranges, or pass them: nothing to vary")
    notes: list[str] = []
    middle = _require_answer(calculate_many([Variant(conveyor, take_up=take_up)], rtol)[0])
    variations = list(_input_variations(middle, given, notes))
    if not variations:
        why = "; ".join(notes) or "uncertainty: missing; give the spec ranges, or pass them"
        raise InputError(f"{why}: nothing to vary")
    variants = [replace(each, take_up=take_up) for variation in variations for each in variation.variants]
    answers = calculate_many(variants, rtol, progress, known=middle)
    powers = [_require_answer(result).balance.power.motor for result in answers]
    motor, at = middle.balance.power.motor, 0
    effects = []
    for variation in variations:
        mine = powers[at : at + len(variation.variants)]
        at += len(variation.variants)
        low, high = quantile_band(mine) if variation.replicas else (mine[0], mine[1])
        effects.append(Effect(variation.name, variation.low, variation.given, variation.high, low, high))
    effects.sort(key=lambda effect: -effect.swing)
    inputs = [variation.drawn for variation in variations if variation.drawn is not None]
    notes += [f"{one.name}: is not drawn" for one in variations if one.drawn is None and given.draws]
    exact = (
        calculate_draws(middle, inputs, given, end=BAND_END, take_up=take_up, rtol=rtol, progress=progress)
        if given.draws
        else None
    )
    return CalculatedRanges(
        conveyor=conveyor,
        motor=motor,
        effects=tuple(effects),
        band=root_of_squares(motor, effects),
        sampled=hypercube_band(motor, effects, samples=samples, seed=seed),
        notes=tuple(notes),
        monte_carlo=exact,
        uncovered_defaults=_uncovered_defaults(middle, given),
    )


def _uncovered_defaults(result: CalculatedConveyor, ranges: Uncertainty) -> tuple[Effect, ...]:
    """Effects of the defaults in use that no range covers."""
    covered = {key for name, key in _COVERED_DEFAULTS.items() if getattr(ranges, name)}
    return tuple(effect for effect in power_range(result).effects if effect.key not in covered)


def _require_answer(result: CalculatedConveyor | NoAnswer) -> CalculatedConveyor:
    if not isinstance(result, CalculatedConveyor):
        raise result
    return result


def hypercube_band(motor: float, effects: Sequence[Effect], *, samples: int, seed: int) -> tuple[float, float]:
    """Band of the first-order model on a seeded Latin hypercube of normal inputs [W].

    Parameters
    ----------
    motor : float
        Power as given [W].
    effects : sequence of Effect
        One per input.
    samples : int
        Points, at least 2.
    seed : int
        Of the random numbers.

    Raises
    ------
    InputError
        Fewer than 2 points.
    """
    if samples < 2:
        raise InputError(f"samples = {samples}: at least 2 are needed")
    rng = np.random.default_rng(seed)
    power = np.full(samples, motor)
    for effect in effects:
        strata = (rng.permutation(samples) + rng.random(samples)) / samples
        z: Array = ndtri(strata) / BAND_END
        power += np.where(z < 0.0, z * (motor - effect.motor_low), z * (effect.motor_high - motor))
    return quantile_band(power)


def _input_variations(calculated: CalculatedConveyor, ranges: Uncertainty, notes: list[str]) -> Iterator[_Variation]:
    conveyor = calculated.conveyor
    half = ranges.half_width("roll_drag")
    if half is not None:
        ends = (Variant(conveyor, roll_drag=1.0 - half), Variant(conveyor, roll_drag=1.0 + half))
        told = (f"-{percent(half)}", "as computed", f"+{percent(half)}")
        yield _Variation("roll drag", *told, ends, drawn=DrawnInput("roll_drag", drag=half))
    if ranges.flexure_share is not None:
        yield _vary_flexure(conveyor, ranges.flexure_share)
    for name, change in _INPUT_CHANGES.items():
        half = ranges.half_width(name)
        if half is not None:
            yield _vary_factor(conveyor, name, half, change=change, notes=notes)
    change_of_temperature = ranges.half_width("temperature")
    if change_of_temperature is not None:
        yield _vary_temperature(conveyor, change_of_temperature)
    if ranges.rubber:
        yield from _vary_rubber(calculated, notes)


def _change_input(name: str, change: Callable[[], Conveyor]) -> Conveyor:
    """Change a conveyor; an error names the range."""
    try:
        return change()
    except InputError as error:
        raise InputError(f"uncertainty.{name}: an end of the range is refused: {error}") from None


def _vary_flexure(conveyor: Conveyor, ends: Sequence[Quantity]) -> _Variation:
    calculation = conveyor.calculation
    scenes = tuple(Variant(conveyor.replace(calculation=calculation.replace(flexure_share=share))) for share in ends)
    low, high = (text(share) for share in ends)
    given = "by law" if calculation.flexure_share is None else text(calculation.flexure_share)
    drawn = DrawnInput("flexure_share", partial(_with_flexure, ends=ends))
    return _Variation("flexure share", low, given, high, scenes, drawn=drawn)


def _with_flexure(conveyor: Conveyor, away: float, ends: Sequence[Quantity]) -> Conveyor:
    """Conveyor with the flexure share at a distance from the middle of its range, in half widths."""
    share = interpolate_quantity(ends[0], ends[1], 0.5 + 0.5 * away)
    return _change_input(
        "flexure_share",
        lambda: conveyor.replace(calculation=conveyor.calculation.replace(flexure_share=share)),
    )


def _vary_temperature(conveyor: Conveyor, change: float) -> _Variation:
    ends = [
        _change_input("temperature", partial(with_belt_temperature_changed, conveyor, sign * change))
        for sign in (-1.0, 1.0)
    ]
    low, given, high = (
        format_figure(c.temperature, "temperature", conveyor.report.units) for c in (ends[0], conveyor, ends[1])
    )
    drawn = DrawnInput("temperature", lambda given, away: with_belt_temperature_changed(given, away * change))
    return _Variation("temperature of the belt", low, given, high, tuple(map(Variant, ends)), drawn=drawn)


def _with_flow(conveyor: Conveyor, factor: float) -> Conveyor:
    material = conveyor.material
    return conveyor.replace(material=material.replace(flow=scale_quantity(material.flow, factor)))


def _with_density(conveyor: Conveyor, factor: float) -> Conveyor:
    material = conveyor.material
    densities = {"density": scale_quantity(material.density, factor)}
    if material.weight_density is not None:
        densities["weight_density"] = scale_quantity(material.weight_density, factor)
    return conveyor.replace(material=material.replace(**densities))


def _with_belt_mass(conveyor: Conveyor, factor: float) -> Conveyor:
    mass = from_si(factor * conveyor.belt.line_mass, "line mass", "kg/m")
    return conveyor.replace(belt=conveyor.belt.replace(mass=mass))


def _with_cover(conveyor: Conveyor, factor: float) -> Conveyor:
    belt = conveyor.belt
    cover = belt.bottom_cover.replace(thickness=scale_quantity(belt.bottom_cover.thickness, factor))
    return conveyor.replace(belt=belt.replace(bottom_cover=cover))


def _with_cleaners(conveyor: Conveyor, factor: float) -> Conveyor:
    route = conveyor.route
    if not route.cleaners:
        return conveyor
    cleaners = [c.replace(pressure=scale_quantity(c.pressure, factor)) for c in route.cleaners]
    return conveyor.replace(route=route.replace(cleaners=cleaners))


def _with_skirts(conveyor: Conveyor, factor: float) -> Conveyor:
    route = conveyor.route
    points = [p.replace(skirt_friction=p.skirt_friction * factor) for p in route.feeding_points]
    if not points:
        return conveyor
    return conveyor.replace(route=route.replace(feeding=points[0], further_feeding=points[1:]))


def _with_forming(conveyor: Conveyor, factor: float) -> Conveyor:
    belt, idlers = conveyor.belt, conveyor.idlers
    if belt.transverse_stiffness is not None and idlers.carry.pipe is not None:
        stiffness = scale_quantity(belt.transverse_stiffness, factor)
        return conveyor.replace(belt=belt.replace(transverse_stiffness=stiffness))
    changed = {
        field: each.replace(pipe=each.pipe.replace(forming_load=scale_quantity(each.pipe.forming_load, factor)))
        for field, each in (("carry", idlers.carry), ("return_", idlers.return_))
        if each.pipe is not None and each.pipe.forming_load is not None
    }
    return conveyor.replace(idlers=idlers.replace(**changed)) if changed else conveyor


_INPUT_CHANGES: Final[dict[str, Callable[[Conveyor, float], Conveyor]]] = {
    "flow": _with_flow,
    "density": _with_density,
    "cover_thickness": _with_cover,
    "belt_mass": _with_belt_mass,
    "cleaner_pressure": _with_cleaners,
    "skirt_friction": _with_skirts,
    "forming_load": _with_forming,
}


def _vary_factor(
    conveyor: Conveyor,
    name: str,
    half: float,
    *,
    change: Callable[[Conveyor, float], Conveyor],
    notes: list[str],
) -> _Variation:
    ends = [_change_input(name, partial(change, conveyor, factor)) for factor in (1.0 - half, 1.0 + half)]
    if all(end == conveyor for end in ends):
        notes.append(f"uncertainty.{name}: the conveyor has none of it")
    scenes = tuple(Variant(end) for end in ends)
    drawn = DrawnInput(name, lambda given, away: change(given, 1.0 + half * away))
    told = (f"-{percent(half)}", "as given", f"+{percent(half)}")
    return _Variation(name.replace("_", " "), *told, scenes, drawn=drawn)


def _vary_rubber(result: CalculatedConveyor, notes: list[str]) -> Iterator[_Variation]:
    """Replicas of each compound, its test factor, and its strain sweeps if the working strain exceeds them."""
    conveyor, covers = result.conveyor, result.contacts.covers
    compounds = compounds_by_strand(conveyor)
    for name in dict.fromkeys(compound.name for compound in compounds.values()):
        strands = [strand for strand, c in compounds.items() if c.name == name]
        compound, cover = compounds[strands[0]], covers[strands[0]]
        alternatives = compound.alternatives()
        if alternatives:
            scenes = tuple(Variant(with_alternative(conveyor, compound, other)) for other in alternatives)
            yield _Variation(
                f'rubber "{name}"',
                "5th percentile of fits",
                "as fitted",
                "95th percentile of fits",
                scenes,
                replicas=True,
                drawn=DrawnInput(f'rubber "{name}"', rubber=(compound, alternatives)),
            )
        if cover.test_factor is not None:
            yield _vary_test_factor(
                conveyor, name, {strand: result.contacts.test_factor_band(strand) for strand in strands}
            )
        elif not alternatives:
            notes.append(f'compound "{name}" has no replicas and no tests: its rubber is taken as certain')
        factors = compound.amplitude_factors()
        if factors is not None and cover.strain is not None and not factors.known_at(result.temperature):
            linear = with_alternative(conveyor, compound, compound.replace(strain_dependence=None))
            nearest = format_figure(factors.nearest(result.temperature), "temperature", result.conveyor.report.units)
            held = f"held from {nearest}"
            ends = (Variant(linear), Variant(conveyor))
            yield _Variation(f'strain of "{name}"', "that of the master curve", held, held, ends)
        if factors is not None and cover.strain is not None:
            largest = factors.largest_strain(result.temperature)
            if cover.strain.strain > largest:
                softer = compound.replace(strain_dependence=_extend_sweeps(compound, cover.strain.strain))
                held = f"held from {percent(largest, 2)}"
                ends = (Variant(conveyor), Variant(with_alternative(conveyor, compound, softer)))
                yield _Variation(f'largest strain of "{name}"', held, held, "carried on", ends)


def _extend_sweeps(compound: RubberCompound, strain: float) -> StrainDependence:
    """Extend strain sweeps that end below a working strain [-] to twice that strain, steeper than at their end.

    Measured on S100 and S120 cut off at 0.3 to 1 %: over the next factor of five in strain ln E' falls 1.2 to 2.1 times
    as steeply as at the end, ln E'' more steeply by at most the slope of ln E'.
    """
    known = compound.strain_dependence
    if known is None:
        raise TypeError(compound.name)
    reach, sweeps = 100.0 * _SWEEP_EXTENSION * strain, []
    for sweep in known.sweeps:
        if sweep.strain[-1] >= reach:
            sweeps.append(sweep)
            continue
        step, far = math.log(sweep.strain[-1] / sweep.strain[-2]), math.log(reach / sweep.strain[-1])
        stiff, lossy = (math.log(values[-1] / values[-2]) / step for values in (sweep.storage, sweep.loss))
        falls = min(stiff, 0.0)
        longer = {
            name: (*values, values[-1] * math.exp((slope + falls) * far))
            for name, values, slope in (("storage", sweep.storage, stiff), ("loss", sweep.loss, lossy))
        }
        sweeps.append(sweep.replace(strain=(*sweep.strain, reach), **longer))
    return known.replace(sweeps=tuple(sweeps))


def _vary_test_factor(conveyor: Conveyor, name: str, bands: Mapping[Strand, float]) -> _Variation:
    """Test factor of a compound at both ends of its band."""
    ends = tuple(
        Variant(conveyor, indentation_factors={strand: math.exp(sign * half) for strand, half in bands.items()})
        for sign in (-1.0, 1.0)
    )
    low, high = (math.expm1(sign * max(bands.values())) for sign in (-1.0, 1.0))
    return _Variation(
        f'test factor of "{name}"', f"{100.0 * low:+.0f} %", "as tested", f"{100.0 * high:+.0f} %", ends,
        drawn=DrawnInput(f'test factor of "{name}"', indentation_factors=bands),
    )  # fmt: skip
