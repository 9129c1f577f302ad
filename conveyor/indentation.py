"""Conversion between a roll under a belt in SI units and the dimensionless contact, in both directions.

Scales (paper, section 3): k = 2π/λ with λ the idler spacing, E0 the rubbery modulus,

    p̃_m = 2(1-ν²) p_m/(E0 k R) = (1-ν²) w/(π E0 R)   (p_m = w/λ),      ζ_t = V τ_t k,      μ = f/w.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require_number, require_positive
from conveyor.contact import (
    Belt,
    ContactProblem,
    CreepSpectrum,
    LoadCurve,
    SolveStats,
    Status,
    frictions,
    load_curves,
    solve,
    solve_many,
)
from conveyor.errors import InputError, MessageQuantity, NoSolutionError, RangeError
from conveyor.rubber import CreepSeries, PronySeries, creep_forms

Array = NDArray[np.float64]
Support = Literal["confined", "free", "half-space", "belt"]
_SLACK = 1e-12  # of the ends of a curve, which rounding may pass [-]


@dataclass(frozen=True)
class Backing:
    """Carcass and other cover behind the cover that runs on the rolls, per width.

    Parameters
    ----------
    tension : float
        T - m' V², effective tension of the moving belt [N/m].
    bending : float
        D' of the carcass, flat [N m].
    bending_loss : float
        tan δ of the carcass in bending [-].
    stretching : float
        K, in-plane stiffness of the carcass [N/m].
    cover_thickness : float
        Of the other cover [m].
    rubber : PronySeries
        Of the other cover at its temperature [Pa, s].
    """

    tension: float
    bending: float
    bending_loss: float
    stretching: float
    cover_thickness: float
    rubber: PronySeries


@dataclass(frozen=True)
class RollContact:
    """One kind of roll under one cover at one speed and temperature.

    Parameters
    ----------
    radius : float
        R, of the roll [m].
    spacing : float
        λ, of the idler sets [m]; at least 2 R.
    cover_thickness : float
        h, of the cover the roll runs on, at most λ unless `support` is a half-space [m].
    speed : float
        V, of the belt [m/s].
    rubber : PronySeries
        Relaxation spectrum of the cover at its temperature [Pa, s].
    poisson : float
        ν of the rubber [-].
    support : {"confined", "free", "half-space", "belt"}
        Backing of the cover: a stiff carcass, nothing (the paper's belt), endless rubber, or the flexible belt.
    backing : Backing, optional
        Belt behind the cover; with support "belt" only.
    """

    radius: float
    spacing: float
    cover_thickness: float
    speed: float
    rubber: PronySeries
    poisson: float = 0.5
    support: Support = "confined"
    backing: Backing | None = None

    def __post_init__(self) -> None:
        if (self.support == "belt") != (self.backing is not None):
            raise InputError(f"backing = {self.backing!r}: support {self.support!r}; a belt, and no other, has one")
        for name in ("radius", "spacing", "cover_thickness", "speed"):
            require_number(**{name: getattr(self, name)})
            require_positive(**{name: getattr(self, name)})
        if self.support != "half-space" and self.cover_thickness > self.spacing:
            raise InputError(
                f"cover_thickness = {self.cover_thickness:g} m is more than spacing = {self.spacing:g} m: both are in"
                ' metres; endless rubber has support "half-space"'
            )

    @property
    def pull(self) -> float | None:
        """Effective tension of the belt behind the cover, per width [N/m]; None on another support."""
        return None if self.backing is None else self.backing.tension


SPACING_INFLUENCE = 4.0
"""Factor of (h/λ)³, the relative influence of the spacing on friction: at most 1.8 (h/λ)³ was seen on the shelf's
rubbers (λ/h 25 to 800, 0.5 and 8 m/s, -27 to 77 °C)."""


def merge_equal_contacts(contacts: Iterable[RollContact], rtol: float) -> dict[RollContact, RollContact]:
    """Contact to solve for each contact: those that differ in spacing only share the closest, where rtol allows.

    Parameters
    ----------
    contacts : iterable of RollContact
        Contacts of one conveyor.
    rtol : float
        Relative error allowed [-]; spacings that change friction by more, by 4 (h/λ)³, are kept apart.

    Returns
    -------
    dict
        Representative of every contact: itself, or the one of the closest spacing.
    """
    alike: dict[RollContact, list[RollContact]] = {}
    for contact in contacts:
        alike.setdefault(replace(contact, spacing=1.0), []).append(contact)
    first = {}
    for members in alike.values():
        closest = min(members, key=lambda contact: contact.spacing)
        shared = closest.support == "confined" and closest.poisson == 0.5 and spacing_error(closest) <= rtol
        first.update({contact: closest if shared else contact for contact in members})
    return first


def spacing_error(contact: RollContact) -> float:
    """Relative change of a confined contact's friction at a larger roll spacing, an upper estimate [-]."""
    return SPACING_INFLUENCE * (contact.cover_thickness / contact.spacing) ** 3


FAST_TERMS_INFLUENCE, SLOW_TERMS_INFLUENCE = 2.0, 0.1
"""Factors of (V τ/a)^1.5 and (h/(V τ))²: relative change of friction as all terms faster, all slower than τ are
merged. At most 1.03 and 0.044 were seen on four compounds of the shelf (-30 to 50 °C, 0.5 to 9 m/s, 0.1 to 10 N/mm,
2.5 to 16 mm, rolls of 60 to 240 mm)."""


def resolved_relaxation_times(contact: RollContact, line_load: float, error: float) -> tuple[float, float]:
    """Relaxation times between which a roll resolves the terms of its rubber [s].

    Parameters
    ----------
    contact : RollContact
        Confined, of an incompressible cover.
    line_load : float
        w, the least that occurs [N/m].
    error : float
        Relative change of friction allowed [-] for merging the terms beyond either time.

    Returns
    -------
    tuple of float
        Fastest, slowest; a is Hertz' half width at the storage modulus of ω = V/a∞, a∞ that at the glassy modulus.
    """
    rubber, speed = contact.rubber, contact.speed
    unit = 4.0 * (1.0 - contact.poisson**2) * line_load * contact.radius / math.pi
    narrow = math.sqrt(unit / rubber.glassy)
    narrow = math.sqrt(unit / float(rubber.storage(speed / narrow)))
    fastest = (error / FAST_TERMS_INFLUENCE) ** (2.0 / 3.0) * narrow / speed
    return fastest, math.sqrt(SLOW_TERMS_INFLUENCE / error) * contact.cover_thickness / speed


def coarsen_rubber(contact: RollContact, line_load: float, error: float) -> RollContact:
    """Merge the rubber terms that the roll does not resolve; only of a confined, incompressible cover.

    Parameters
    ----------
    contact : RollContact
        Roll, cover and rubber.
    line_load : float
        w, the least that occurs [N/m].
    error : float
        As in `resolved_relaxation_times`, for the fast and for the slow terms each [-].
    """
    if contact.support != "confined" or contact.poisson != 0.5:
        return contact
    fastest, slowest = resolved_relaxation_times(contact, line_load, error)
    return replace(contact, rubber=contact.rubber.merged(fastest=fastest, slowest=slowest))


@dataclass(frozen=True, eq=False)
class Indentation:
    """Rolling contact under line loads, in SI units; arrays of the shape of `line_load`.

    Attributes
    ----------
    line_load : ndarray
        w, load per width [N/m].
    resistance : ndarray
        f = μ w, indentation resistance per width [N/m].
    half_width, eccentricity, penetration : ndarray
        a, e, Δ [m].
    peak_pressure : ndarray
        Largest contact pressure [Pa].
    peak_error : ndarray
        Estimated relative error of the largest contact pressure [-].
    error : float
        Estimated relative error of the resistance [-].
    energy_error : float
        Relative difference of the resistance by geometry and by loss compliance [-].
    """

    line_load: Array
    resistance: Array
    half_width: Array
    eccentricity: Array
    penetration: Array
    peak_pressure: Array
    peak_error: Array
    error: float
    energy_error: float

    @property
    def each(self) -> tuple[Indentation, ...]:
        """One Indentation per line load, in order of a flat array."""
        fields = (self.line_load, self.resistance, self.half_width, self.eccentricity, self.penetration,
                  self.peak_pressure, self.peak_error)  # fmt: skip
        columns = (np.asarray(figures).ravel() for figures in fields)
        return tuple(
            Indentation(w, f, a, e, depth, peak, unsure, self.error, self.energy_error)
            for w, f, a, e, depth, peak, unsure in zip(*columns, strict=True)
        )


def to_problem(contact: RollContact, line_load: float) -> ContactProblem:
    """Dimensionless problem of a roll under a line load.

    Parameters
    ----------
    contact : RollContact
        Roll, cover, speed and rubber.
    line_load : float
        w, load per width [N/m].

    Returns
    -------
    ContactProblem
        With the creep spectrum of the rubber, normalised by E0.

    Raises
    ------
    InputError
        A value outside what the contact allows, e.g. rolls that overlap.
    """
    return to_problems([contact], [line_load])[0]


def to_problems(contacts: Sequence[RollContact], line_loads: Sequence[float]) -> list[ContactProblem]:
    """Dimensionless problems of many rolls, each as `to_problem`; their spectra are inverted in a batch.

    Parameters
    ----------
    contacts : sequence of RollContact
        Rolls, covers, speeds and rubbers.
    line_loads : sequence of float
        Line load w of each [N/m].

    Raises
    ------
    InputError
        As `to_problem`.
    """
    behind = [contact.backing.rubber for contact in contacts if contact.backing is not None]
    rubbers = dict.fromkeys([*(contact.rubber for contact in contacts), *behind])
    creep_of = dict(zip(rubbers, creep_forms(rubbers), strict=True))
    problems = []
    for contact, line_load in zip(contacts, line_loads, strict=True):
        k = 2.0 * math.pi / contact.spacing
        rubbery = contact.rubber.equilibrium
        problems.append(
            ContactProblem(
                support=contact.support
                if contact.backing is None
                else _dimensionless_belt(contact, contact.backing, creep_of[contact.backing.rubber]),
                radius=contact.radius / contact.spacing,
                pressure=(1.0 - contact.poisson**2) * line_load / (math.pi * rubbery * contact.radius),
                creep=_normalised_creep(creep_of[contact.rubber], rubbery, contact.speed * k),
                thickness=math.inf if contact.support == "half-space" else k * contact.cover_thickness,
                poisson=contact.poisson,
            )
        )
    return problems


def _normalised_creep(creep: CreepSeries, rubbery: float, rate: float) -> CreepSpectrum:
    """Creep over 1/E0, times over 1/(V k)."""
    return CreepSpectrum(
        instantaneous=rubbery * creep.instantaneous,
        weights=rubbery * creep.compliances,
        times=creep.times * rate,
    )


def _dimensionless_belt(contact: RollContact, behind: Backing, creep: CreepSeries) -> Belt:
    """Dimensionless belt: tension T k/E0, bending D k³/E0, in-plane stiffness K k/E0."""
    k, rubbery = 2.0 * math.pi / contact.spacing, contact.rubber.equilibrium
    bending = behind.bending * k**3 / rubbery
    return Belt(
        bottom=k * contact.cover_thickness,
        top=k * behind.cover_thickness,
        top_creep=_normalised_creep(creep, behind.rubber.equilibrium, contact.speed * k),
        top_modulus=behind.rubber.equilibrium / rubbery,
        tension=behind.tension * k / rubbery,
        bending=complex(bending, bending * behind.bending_loss),
        stretching=behind.stretching * k / rubbery,
    )


@dataclass(frozen=True, eq=False)
class IndentationCurve:
    """Indentation of one `RollContact` between two line loads, interpolated."""

    contact: RollContact
    curve: LoadCurve
    lowest: float
    highest: float

    @property
    def slowest_excited(self) -> float | None:
        """Frequency below which a twentieth of the widest contact's loss lies [Hz]; None without loss.

        Harmonic m of the rolls passes at f = m V/λ.
        """
        return self._frequency(self.curve.excitation_widest, 0)

    @property
    def fastest_excited(self) -> float | None:
        """Frequency above which a twentieth of the narrowest contact's loss lies [Hz]; None without loss."""
        return self._frequency(self.curve.excitation_narrowest, -1)

    def _frequency(self, harmonics: Array, k: int) -> float | None:
        if harmonics.size == 0:
            return None
        return self.contact.speed / self.contact.spacing * float(harmonics[k])

    @property
    def lossy(self) -> bool:
        """True if the contact loses energy."""
        return self.curve.lossy

    @property
    def error(self) -> float:
        """Estimated relative error of the resistance [-]."""
        return self.curve.error

    @property
    def energy_error(self) -> float:
        """Relative difference of the resistance by geometry and by loss compliance [-]."""
        return self.curve.energy_error

    @property
    def solved(self) -> tuple[IndentationCurve, ...]:
        """Curves solved for this one: itself."""
        return (self,)

    @property
    def stats(self) -> SolveStats:
        """Cost of the curve."""
        return self.curve.stats

    def resistance(self, line_load: ArrayLike) -> Array:
        """Indentation resistance per width f = μ w [N/m] at line loads w [N/m], without the other results.

        Raises
        ------
        RangeError
            A load outside the curve.
        """
        (found,) = curve_resistances([self], [np.asarray(line_load, dtype=float)])
        return found

    def penetration(self, line_load: ArrayLike) -> Array:
        """Penetration Δ [m] at line loads w [N/m], as `at`, without the peak pressure.

        Raises
        ------
        RangeError
            A load outside the curve.
        """
        return self.curve.at(self.pressures(line_load)).penetration * self.contact.radius

    def pressures(self, line_load: ArrayLike) -> Array:
        """Dimensionless mean pressure at line loads w [N/m].

        Raises
        ------
        RangeError
            A load outside the curve.
        """
        w = np.asarray(line_load, dtype=float)
        if w.size and not self.lowest * (1.0 - _SLACK) <= w.min() <= w.max() <= self.highest * (1.0 + _SLACK):
            loads = [float(w.min()), float(w.max()), self.lowest, self.highest]
            raise RangeError(
                "line load from {} to {}: the curve was solved from {} to {}; solve a wider one",
                *(MessageQuantity(each, "line force", f"{each:.6g} N/m") for each in loads),
            )
        return np.asarray(w * (self.curve.problem.pressure / self.highest))

    def at(self, line_load: ArrayLike) -> Indentation:
        """Results in SI units at line loads.

        Parameters
        ----------
        line_load : array_like
            w [N/m], within the curve.

        Raises
        ------
        RangeError
            A load outside the curve.
        """
        w = np.asarray(line_load, dtype=float)
        unit = self.curve.problem.pressure / self.highest
        dimensionless = self.curve.at(self.pressures(w))
        radius = self.contact.radius
        # p = p̃ E0 k R/(2(1-ν²)), and p̃_m = p_m 2(1-ν²)/(E0 k R) with p_m = w/λ gives the scale w/λ/p̃_m
        pascal = 1.0 / (unit * self.contact.spacing)
        return Indentation(
            line_load=w,
            resistance=dimensionless.friction * w,
            half_width=dimensionless.half_width * radius,
            eccentricity=dimensionless.eccentricity * radius,
            penetration=dimensionless.penetration * radius,
            peak_pressure=dimensionless.peak_pressure * pascal,
            peak_error=dimensionless.peak_error,
            error=self.curve.error,
            energy_error=self.curve.energy_error,
        )


def curve_resistances(curves: Sequence[IndentationCurve], line_loads: Sequence[Array]) -> list[Array]:
    """Indentation resistance per width on each of many curves at its own line loads, as `IndentationCurve.resistance`.

    Raises
    ------
    RangeError
        A load outside its curve.
    """
    pressures = [one.pressures(w) for one, w in zip(curves, line_loads, strict=True)]
    found = frictions([one.curve for one in curves], pressures)
    return [friction * w for friction, w in zip(found, line_loads, strict=True)]


def indentation_curve(contact: RollContact, lowest: float, highest: float, rtol: float = 1e-6) -> IndentationCurve:
    """Solve a roll's contact for every line load between two.

    Parameters
    ----------
    contact : RollContact
        Roll, cover, speed and rubber.
    lowest, highest : float
        Range of the line load w [N/m].
    rtol : float
        Relative error allowed [-].

    Raises
    ------
    InputError
        A value outside what the contact allows.
    NoSolutionError
        The contact splits or wraps the roll; the message names the roll and the load.
    """
    (curve,) = indentation_curves([contact], [lowest], [highest], rtol)
    if isinstance(curve, NoSolutionError):
        raise curve
    return curve


def indentation_curves(
    contacts: Sequence[RollContact], lowest: Sequence[float], highest: Sequence[float], rtol: float = 1e-6
) -> list[IndentationCurve | NoSolutionError]:
    """Solve many rolls' contacts in a batch, each for every line load between two: curves, or the errors instead.

    Parameters
    ----------
    contacts : sequence of RollContact
        Rolls, covers, speeds and rubbers.
    lowest, highest : sequence of float
        Range of the line load w of each [N/m].
    rtol : float
        Relative error allowed [-].

    Raises
    ------
    InputError
        A value outside what the contact allows.
    """
    problems = to_problems(contacts, highest)
    pressures = np.array([problem.pressure for problem in problems])
    curves = load_curves(problems, pressures * (np.asarray(lowest) / np.asarray(highest)), pressures, rtol)
    return [
        no_contact_error(contact, (low, high), curve)
        if isinstance(curve, NoSolutionError)
        else IndentationCurve(contact, curve, low, high)
        for contact, curve, low, high in zip(contacts, curves, lowest, highest, strict=True)
    ]


def no_contact_error(contact: RollContact, loads: tuple[float, ...], why: NoSolutionError) -> NoSolutionError:
    """Error of a roll's contact under a line load or between two [N/m], which names roll, cover and load."""
    diameter, cover = 2.0 * contact.radius, contact.cover_thickness
    *least, most = loads
    low = (MessageQuantity(each, "line force", f"{each:.4g}") for each in least)
    return NoSolutionError(
        f"roll of {{}} on a {{}} cover ({contact.support}), {'{} to ' * len(least)}{{}}: {{}}{_cover_hint(contact)}",
        MessageQuantity(diameter, "thickness", f"{1e3 * diameter:.4g} mm"),
        MessageQuantity(cover, "thickness", f"{1e3 * cover:.4g} mm"),
        *low,
        MessageQuantity(most, "line force", f"{most:.4g} N/m"),
        why,
    )


def _cover_hint(contact: RollContact) -> str:
    if contact.support == "confined":
        return ""
    return '; a cover on a real carcass is "confined", not a layer that bends or has no end'


def indentation_resistance(contact: RollContact, line_load: float, rtol: float = 1e-6) -> Indentation:
    """Indentation of one roll under one line load w [N/m].

    Raises
    ------
    InputError, NoSolutionError
        As `indentation_curve`.

    Examples
    --------
    >>> rubber = PronySeries(8e6, [4e6], [1e-3])
    >>> roll = RollContact(radius=0.0795, spacing=1.2, cover_thickness=6e-3, speed=5.0, rubber=rubber)
    >>> one = indentation_resistance(roll, 2000.0)
    >>> round(float(one.resistance), 3), round(1e3 * float(one.half_width), 3)
    (6.13, 3.201)
    """
    problem = to_problem(contact, line_load)
    solution = solve(problem, rtol)
    pascal = line_load / (contact.spacing * problem.pressure)
    return Indentation(
        line_load=np.asarray(line_load),
        resistance=np.asarray(solution.friction * line_load),
        half_width=np.asarray(solution.half_width * contact.radius),
        eccentricity=np.asarray(solution.eccentricity * contact.radius),
        penetration=np.asarray(solution.penetration * contact.radius),
        peak_pressure=np.asarray(solution.peak_pressure * pascal),
        peak_error=np.asarray(solution.peak_error),
        error=solution.error_estimate,
        energy_error=solution.energy_error,
    )


def indentation_resistances(
    contacts: Sequence[RollContact], line_loads: Sequence[float], rtol: float = 1e-6
) -> list[float | NoSolutionError]:
    """Indentation resistance per width of many rolls, each under its line load, in a batch.

    Parameters
    ----------
    contacts : sequence of RollContact
        Rolls, covers, speeds and rubbers.
    line_loads : sequence of float
        Line load w of each [N/m].
    rtol : float
        Relative error allowed [-].

    Returns
    -------
    list
        f [N/m] of each, or the error instead.

    Raises
    ------
    InputError
        A value outside what the contact allows.
    """
    solutions = solve_many(to_problems(contacts, line_loads), rtol)
    return [
        solution.friction * w
        if solution.status is Status.OK
        else no_contact_error(contact, (w,), NoSolutionError(solution.message))
        for contact, w, solution in zip(contacts, line_loads, solutions, strict=True)
    ]
