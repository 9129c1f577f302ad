"""One contact as a function of load: contacts at Chebyshev points of the half width, interpolated.

Load, friction and place are smooth functions of ln α, sampled at Chebyshev-Lobatto points (sampling.py); the load is
inverted by Newton.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from conveyor.contact.fields.excitation import excited_harmonics
from conveyor.contact.galerkin.pressure import largest_pressure
from conveyor.contact.galerkin.sampling import (
    SampledContacts,
    chebyshev_coefficients,
    curve_figures,
    half_degree_errors,
    lobatto_points,
)
from conveyor.contact.galerkin.spectral import (
    Contact,
    assemble_matrix,
    crown_depth,
    select_contacts,
    solve_nested_equilibrium,
)
from conveyor.contact.problem import ContactProblem
from conveyor.contact.solution import SolveStats
from conveyor.contact.solvers.peak_error import flow_order, peak_error
from conveyor.contact.solvers.solver_state import SolverState, merge_instant_terms
from conveyor.errors import InputError, RangeError

Array = NDArray[np.float64]

_NEWTON_STEPS = 40
_LAST_STEP = 1e-9  # leaves its square
_PEAK_ORDER = 64  # of it peaks of covers are off by 2e-5 in the middle, 1e-4 in nine tenths
_PEAK_PLACE = 1e-8  # relative, of eccentricities there
_PEAK_EXPONENT, _PEAK_EXPONENT_SPREAD = 0.5, 0.25  # d ln p̂/d ln p̃_m: 1/2 on a thick layer, 2/3 on a thin one


@dataclass(frozen=True, eq=False)
class LoadSolutions:
    """Results of one problem under many loads; arrays of the shape of `pressure`, meanings as in ContactSolution.

    Penetration, peak pressure and its error are computed on first access.
    """

    pressure: Array
    friction: Array
    half_width: Array
    eccentricity: Array
    dissipation: Array
    energy_error: Array
    error_estimate: Array
    stats: SolveStats
    _form_figure: Callable[[str], Array]  # a partial of a function at the top: solutions pickle

    @cached_property
    def penetration(self) -> Array:
        """Δ/R [-]."""
        return self._form_figure("penetration")

    @cached_property
    def peak_pressure(self) -> Array:
        """Largest p̃ [-]."""
        return self._form_figure("peak_pressure")

    @cached_property
    def peak_error(self) -> Array:
        """Estimated relative error of the largest p̃ [-]."""
        return self._form_figure("peak_error")


@dataclass(frozen=True, eq=False, repr=False)
class LoadCurve:
    """One contact as a function of load, valid between two mean pressures.

    Attributes
    ----------
    problem : ContactProblem
        What was solved; its pressure is the largest of the curve.
    lowest, highest : float
        Range of p̃_m [-].
    error : float
        Estimated relative error of friction anywhere on the curve: order, energy and interpolation [-].
    energy_error : float
        Largest relative difference of friction by geometry and by loss at the sampled points [-].
    stats : SolveStats
        Cost of the curve.
    """

    problem: ContactProblem
    lowest: float
    highest: float
    error: float
    energy_error: float
    stats: SolveStats
    _centre: float
    _half: float
    _sampled: SampledContacts

    def _repr_html_(self) -> str:
        """Range of load and contact at its ends, for notebooks."""
        from conveyor.text.markup import name_value_table

        ends = self.at([self.lowest, self.highest])
        there = [("friction there", ends.friction), ("half_width there", ends.half_width)]
        rows = [("mean pressure p̃_m", f"{self.lowest:.6g} to {self.highest:.6g}")]
        rows += [(name, " to ".join(f"{value:.6g}" for value in span)) for name, span in there]
        rows.append(("relative error of friction", f"{self.error:.1e}"))
        return str(name_value_table("LoadCurve, lengths over R", rows))

    def at(self, pressure: ArrayLike) -> LoadSolutions:
        """Results at mean pressures p̃_m.

        Raises
        ------
        RangeError
            A pressure outside the curve: it is not extrapolated.
        """
        p, t, width = self._places(pressure)
        _, friction, eps = chebyshev.chebval(t, self._columns)
        friction = friction * width
        times = self.problem.creep.times
        return LoadSolutions(
            pressure=p,
            friction=friction,
            half_width=width,
            eccentricity=eps * width,
            dissipation=friction * p * (float(times[0]) if times.size else 0.0),
            energy_error=np.full(p.shape, self.energy_error),
            error_estimate=np.full(p.shape, self.error),
            stats=self.stats,
            _form_figure=partial(self._figure, t, width),
        )

    def friction(self, pressure: ArrayLike) -> Array:
        """Friction μ at mean pressures p̃_m, as `at`, without the other results.

        Raises
        ------
        RangeError
            As `at`.
        """
        (found,) = frictions([self], [pressure])
        return found

    def _places(self, pressure: ArrayLike) -> tuple[Array, Array, Array]:
        """Mean pressures p̃_m, their places t and half widths a/R."""
        p = _pressure_array(pressure)
        self._check(p)
        t = _invert_loads(self._columns[:, :1], [np.log(p).ravel()]).reshape(p.shape)
        return p, t, np.exp(self._centre + self._half * t) / self.problem.rho

    def _check(self, p: Array) -> None:
        """Raise RangeError for pressures outside the curve."""
        if not p.size:
            return
        slack = 1e-12
        low, high = float(p.min()), float(p.max())
        if not self.lowest * (1.0 - slack) <= low <= high <= self.highest * (1.0 + slack):
            raise RangeError(
                f"p̃_m from {low:.6g} to {high:.6g}: the load curve holds from {self.lowest:.6g} to {self.highest:.6g}"
            )

    @property
    def lossy(self) -> bool:
        """True if the contact loses energy."""
        return bool((self._sampled.contacts.friction > 0.0).all())

    def _figure(self, t: Array, width: Array, name: str) -> Array:
        if name == "penetration":
            return np.asarray(chebyshev.chebval(t, self._depths) * width**2)
        if name == "peak_error":
            sampled = lobatto_points(self._peak_errors.size - 1)
            above = np.clip(np.searchsorted(-sampled, -t), 1, sampled.size - 1)
            return np.maximum(self._peak_errors[above - 1], self._peak_errors[above])
        return np.asarray(chebyshev.chebval(t, self._peaks) * width)

    @property
    def peak_error(self) -> float:
        """Estimated relative error of the largest pressure anywhere on the curve [-]."""
        return float(self._peak_errors.max())

    @cached_property
    def _peak_errors(self) -> Array:
        """Errors of the largest pressure at the sampled half widths, shape (k,).

        Sum of the change from half the order, of the change by contacts that resolve flowing rubber where this order
        does not, and of interpolation: the largest pressure has kinks where it jumps from one hump to another.
        """
        fine, lower = self._fine
        n = fine.c.shape[1]
        half_loads = np.where(lower.inside[0], lower.pressure[0], self._sampled_contacts.pressure)
        half = self._carried(lower.c[0, :, : n // 2], half_loads)
        by_order = np.where(lower.inside[0], np.abs(half / self._carried(fine.c, fine.pressure) - 1.0), 1.0)
        creep = merge_instant_terms(self.problem.creep)
        for k, load in enumerate(self._sampled_contacts.pressure):
            if flow_order(creep, float(fine.alpha[k]), n) > n:
                here = select_contacts(fine, slice(k, k + 1))
                by_order[k] += peak_error(replace(self.problem, pressure=float(load)), here)
        moved = np.abs(self._sampled_contacts.pressure / fine.pressure - 1.0)
        between = float(half_degree_errors(self._sampled_peaks)[0] / self._sampled_peaks.min())
        return by_order + _PEAK_EXPONENT_SPREAD * moved + between + self.error

    @cached_property
    def excitation_widest(self) -> Array:
        """Harmonics below which 5, 50 and 95 % of the loss under the highest load lie; empty without loss."""
        return self._excitation(self.highest)

    @cached_property
    def excitation_narrowest(self) -> Array:
        """Harmonics below which 5, 50 and 95 % of the loss under the lowest load lie; empty without loss."""
        return self._excitation(self.lowest)

    def _excitation(self, pressure: float) -> Array:
        if not self.lossy:
            return np.empty(0)
        _, t, _ = self._places(pressure)
        there = self._contacts(t[None])
        strip = float(there.eps[0]), float(there.alpha[0]), there.c[0]
        return excited_harmonics(self.problem.layer, merge_instant_terms(self.problem.creep), [strip])

    def _contacts(self, t: Array) -> Contact:
        """Contacts of the highest order at places t, shape (b,)."""
        order = self._sampled.best.c.shape[1]

        def scaled(contact: Contact) -> Array:
            c = np.zeros((contact.alpha.size, order))
            c[:, : contact.c.shape[1]] = contact.c / contact.alpha[:, None]
            return c

        alpha = np.exp(self._centre + self._half * t)
        log_p, drag, eps = chebyshev.chebval(t, self._columns)
        c: Array = alpha[:, None] * chebyshev.chebval(t, self._sampled.interpolated_series(scaled)).T
        friction = drag * alpha / self.problem.rho
        return Contact(alpha, eps * alpha, c, np.exp(log_p), friction, np.ones(t.shape, dtype=bool))

    @cached_property
    def _columns(self) -> Array:
        """Chebyshev coefficients of (ln p, μρ/α, ε/α), shape (k, 3)."""
        return self._sampled.interpolated_series(partial(curve_figures, self.problem.rho))

    @cached_property
    def _sampled_contacts(self) -> Contact:
        """Contacts at the sampled half widths, shape (k,)."""
        return self._contacts(lobatto_points(self._columns.shape[0] - 1))

    @cached_property
    def _depths(self) -> Array:
        """Chebyshev coefficients of Δρ²/α²."""
        scene, rho = SolverState.of(self.problem), self.problem.rho
        every = self._sampled_contacts
        depth = crown_depth(scene.rule(float(every.alpha[0])), scene.creep, every, rho)
        return chebyshev_coefficients((depth * (rho / every.alpha) ** 2)[:, None])[:, 0]

    @cached_property
    def _fine(self) -> tuple[Contact, Contact]:
        """Contacts at the sampled half widths, of the order that the largest pressure needs; and of lower orders."""
        every, scene = self._sampled_contacts, SolverState.of(self.problem)
        order = max(every.c.shape[1], _PEAK_ORDER)
        matrix = assemble_matrix(scene.rule(float(every.alpha[0])), scene.creep, every.alpha, order)
        return solve_nested_equilibrium(matrix, every.alpha, self.problem.rho, every.eps, _PEAK_PLACE)

    @cached_property
    def _sampled_peaks(self) -> Array:
        """p̂ρ/α at the sampled half widths, shape (k, 1)."""
        fine, _ = self._fine
        return np.asarray(self._carried(fine.c, fine.pressure) * self.problem.rho / fine.alpha)[:, None]

    def _carried(self, c: Array, loads: Array) -> Array:
        """Largest pressures of contacts of coefficients c, scaled from their `loads` to the curve's, shape (k,)."""
        carried: Array = largest_pressure(c) * (self._sampled_contacts.pressure / loads) ** _PEAK_EXPONENT
        return carried

    @cached_property
    def _peaks(self) -> Array:
        """Chebyshev coefficients of p̂ρ/α."""
        return chebyshev_coefficients(self._sampled_peaks)[:, 0]


def frictions(curves: Sequence[LoadCurve], pressures: Sequence[ArrayLike]) -> list[Array]:
    """Friction μ on each of many curves at its own mean pressures p̃_m, as `LoadCurve.friction`, in one batch.

    Raises
    ------
    InputError
        Pressures that are not numbers, or not as many sets of them as curves.
    RangeError
        A pressure outside its curve.
    """
    if len(curves) != len(pressures):
        raise InputError(f"pressures: those of {len(pressures)} curves are given, of {len(curves)} are needed")
    given = [_pressure_array(each) for each in pressures]
    by_degree: dict[int, list[int]] = {}
    for i, (curve, p) in enumerate(zip(curves, given, strict=True)):
        curve._check(p)  # noqa: SLF001 of this module
        by_degree.setdefault(curve._columns.shape[0], []).append(i)  # noqa: SLF001
    found: dict[int, Array] = {}
    for members in by_degree.values():
        chosen = [curves[i] for i in members]
        sizes = [given[i].size for i in members]
        log_p, friction_columns = np.stack([curve._columns[:, :2] for curve in chosen], axis=-1).swapaxes(0, 1)  # noqa: SLF001
        t = _invert_loads(log_p, [np.log(given[i]).ravel() for i in members])
        widths = np.array([(c._centre - math.log(c.problem.rho), c._half) for c in chosen])  # noqa: SLF001
        centre, half = np.repeat(widths, sizes, axis=0).T
        friction = chebyshev.chebval(t, friction_columns.repeat(sizes, axis=1), tensor=False)
        friction *= np.exp(centre + half * t)
        parts = np.split(friction, np.cumsum(sizes)[:-1])
        found.update((i, part.reshape(given[i].shape)) for i, part in zip(members, parts, strict=True))
    return [found[i] for i in range(len(curves))]


def _pressure_array(pressure: ArrayLike) -> Array:
    """Mean pressures as an array."""
    try:
        return np.asarray(pressure, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"pressure: got {pressure!r}, allowed: numbers") from None


def _invert_loads(columns: Array, log_p: Sequence[Array]) -> Array:
    """Places t in [-1, 1] where ln p(t) = log_p, curve after curve; coefficients of ln p have shape (k, b).

    Newton from the chords, on monotone smooth functions.
    """
    degree, sizes = columns.shape[0] - 1, [one.size for one in log_p]
    sampled = lobatto_points(degree)[::-1]
    chords = (chebyshev.chebvander(sampled, degree) @ columns).T
    t = np.concatenate([np.interp(one, chord, sampled) for one, chord in zip(log_p, chords, strict=True)])
    value = columns.repeat(sizes, axis=1)
    rise, target = chebyshev.chebder(value), np.concatenate(log_p)
    for _ in range(_NEWTON_STEPS):
        every = chebyshev.chebvander(t, degree).T
        step = ((every * value).sum(axis=0) - target) / (every[:-1] * rise).sum(axis=0)
        t = t - step
        if np.all(np.abs(step) < _LAST_STEP):
            break
    return t
