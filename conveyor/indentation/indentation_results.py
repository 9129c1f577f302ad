"""Indentation of rolls in SI units: at line loads, and as a curve between two of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.contact import LoadCurve, SolveStats, Status, frictions, load_curves, solve, solve_many
from conveyor.errors import MessageQuantity, NoSolutionError, RangeError
from conveyor.indentation.roll_contact import RollContact
from conveyor.indentation.scaling import to_problem, to_problems

Array = NDArray[np.float64]


_SLACK = 1e-12  # of the ends of a curve, which rounding may pass [-]


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
    >>> from conveyor.rubber import PronySeries
    >>> rubber = PronySeries(8e6, [4e6], [1e-3])
    >>> roll = RollContact(radius=0.0795, spacing=1.2, cover_thickness=6e-3, speed=5.0, series=rubber)
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
