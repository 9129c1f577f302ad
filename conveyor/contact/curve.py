"""The contact of one scene as a function of load: contacts at Chebyshev points of its half width, interpolated.

With ln α as the parameter nothing has to be searched for: load, friction and place are smooth functions of it, sampled
at Chebyshev-Lobatto points (sampling.py) and inverted by Newton.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from conveyor.contact.excitation import excited_harmonics
from conveyor.contact.fields import peak
from conveyor.contact.problem import ContactProblem
from conveyor.contact.sampling import Sampled, columns, points
from conveyor.contact.scene import Scene, instantly_relaxed
from conveyor.contact.solution import SolveStats
from conveyor.contact.spectral import Contact, penetration
from conveyor.errors import RangeError

Array = NDArray[np.float64]

_NEWTON_STEPS = 40
_LAST_STEP = 1e-9  # leaves its square


@dataclass(frozen=True, eq=False)
class LoadSolutions:
    """Figures of many loads of one scene; arrays of the shape of `pressure`, meanings as in ContactSolution.

    Penetration and peak pressure are formed when asked for.
    """

    pressure: Array
    friction: Array
    half_width: Array
    eccentricity: Array
    dissipation: Array
    energy_error: Array
    error_estimate: Array
    stats: SolveStats
    _later: Callable[[str], Array]  # a partial of a function at the top: solutions pickle

    @cached_property
    def penetration(self) -> Array:
        """Δ/R [-]."""
        return self._later("penetration")

    @cached_property
    def peak_pressure(self) -> Array:
        """Largest p̃ [-]."""
        return self._later("peak_pressure")


@dataclass(frozen=True, eq=False, repr=False)
class LoadCurve:
    """Contact of one scene as a function of load, good between two mean pressures.

    Attributes
    ----------
    problem : ContactProblem
        The scene; its pressure is the largest of the curve.
    lowest, highest : float
        Range of p̃_m [-].
    error : float
        Estimated relative error of friction anywhere on the curve: order, energy and interpolation [-].
    energy_error : float
        Largest relative difference of friction by geometry and by loss at the sampled points [-].
    stats : SolveStats
        What the curve cost.
    """

    problem: ContactProblem
    lowest: float
    highest: float
    error: float
    energy_error: float
    stats: SolveStats
    _centre: float
    _half: float
    _sampled: Sampled

    def _repr_html_(self) -> str:
        """For notebooks: the range of load, and the contact at its ends."""
        from conveyor.markup import listing

        ends = self.at([self.lowest, self.highest])
        there = [("friction there", ends.friction), ("half_width there", ends.half_width)]
        rows = [("mean pressure p̃_m", f"{self.lowest:.6g} to {self.highest:.6g}")]
        rows += [(name, " to ".join(f"{value:.6g}" for value in span)) for name, span in there]
        rows.append(("relative error of friction", f"{self.error:.1e}"))
        return listing("LoadCurve, lengths over R", rows)

    def at(self, pressure: ArrayLike) -> LoadSolutions:
        """Figures at mean pressures p̃_m.

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
            _later=partial(self._figure, t, width),
        )

    def friction(self, pressure: ArrayLike) -> Array:
        """Friction μ at mean pressures p̃_m, as `at`; nothing else is formed.

        Raises
        ------
        RangeError
            As `at`.
        """
        _, t, width = self._places(pressure)
        return np.asarray(chebyshev.chebval(t, self._columns[:, 1]) * width)

    def _places(self, pressure: ArrayLike) -> tuple[Array, Array, Array]:
        """Mean pressures p̃_m, their places t and half widths a/R."""
        p = np.asarray(pressure, dtype=float)
        slack = 1e-12
        if not np.all((p >= self.lowest * (1.0 - slack)) & (p <= self.highest * (1.0 + slack))):
            raise RangeError(
                f"p̃_m from {p.min():.6g} to {p.max():.6g}: the load curve holds from {self.lowest:.6g} "
                f"to {self.highest:.6g}"
            )
        t = self._place(np.log(p))
        return p, t, np.exp(self._centre + self._half * t) / self.problem.rho

    def _figure(self, t: Array, width: Array, name: str) -> Array:
        if name == "penetration":
            return np.asarray(chebyshev.chebval(t, self._depths) * width**2)
        return np.asarray(chebyshev.chebval(t, self._peaks) * width)

    @cached_property
    def excitation_widest(self) -> Array:
        """Harmonics below which 5, 50 and 95 % of the loss under the highest load lie; empty without loss."""
        return self._excitation(self.highest)

    @cached_property
    def excitation_narrowest(self) -> Array:
        """The same under the lowest load."""
        return self._excitation(self.lowest)

    def _excitation(self, pressure: float) -> Array:
        if not (self._sampled.contacts.friction > 0.0).all():
            return np.empty(0)
        order = self._sampled.best.c.shape[1]

        def scaled(contact: Contact) -> Array:
            c = np.zeros((contact.alpha.size, order))
            c[:, : contact.c.shape[1]] = contact.c / contact.alpha[:, None]
            return c

        there = self.at(pressure)
        alpha = float(there.half_width) * self.problem.rho
        t = (math.log(alpha) - self._centre) / self._half
        c: Array = alpha * np.asarray(chebyshev.chebval(t, self._sampled.interpolated(scaled)))
        strip = float(there.eccentricity) * self.problem.rho, alpha, c
        return excited_harmonics(self.problem.layer, instantly_relaxed(self.problem.creep), [strip])

    @cached_property
    def _columns(self) -> Array:
        """Chebyshev coefficients of (ln p, μρ/α, ε/α), shape (k, 3)."""
        return self._sampled.interpolated(partial(columns, self.problem.rho))

    @cached_property
    def _depths(self) -> Array:
        """Chebyshev coefficients of Δρ²/α²."""
        scene, rho = Scene.of(self.problem), self.problem.rho
        rule = scene.rule(float(self._sampled.contacts.alpha.max()))

        def scaled(contact: Contact) -> Array:
            depth = penetration(rule, scene.creep, contact, rho)
            return (depth * (rho / contact.alpha) ** 2)[:, None]

        return self._sampled.interpolated(scaled)[:, 0]

    @cached_property
    def _peaks(self) -> Array:
        """Chebyshev coefficients of p̂ρ/α."""
        rho = self.problem.rho
        return self._sampled.interpolated(lambda contact: (peak(contact.c) * rho / contact.alpha)[:, None])[
            :, 0
        ]

    def _place(self, log_p: Array) -> Array:
        """Place t in [-1, 1] with ln p(t) = log_p: Newton from the chords, on a monotone smooth function."""
        column = self._columns[:, 0]
        rise, degree = chebyshev.chebder(column), column.size - 1
        sampled = points(degree)[::-1]
        t: Array = np.interp(log_p, chebyshev.chebval(sampled, column), sampled)
        for _ in range(_NEWTON_STEPS):
            every = chebyshev.chebvander(t, degree).reshape(*t.shape, -1)
            step = (every @ column - log_p) / (every[..., :-1] @ rise)
            t = t - step
            if np.all(np.abs(step) < _LAST_STEP):
                break
        return t
