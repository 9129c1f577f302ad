"""A solved contact: figures with their errors, and fields computed when asked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.contact.bessel import bessel_j
from conveyor.contact.problem import ContactProblem, CreepSpectrum, Status
from conveyor.contact.quadrature import series_rule
from conveyor.contact.spectral import Contact
from conveyor.errors import NoSolutionError

Array = NDArray[np.float64]

_SERIES_REACH = (
    600.0  # m α where the series outside ends: cut by (m α)^(-5/2) = 1e-7, at an edge (m α)^(-3/2)
)
_FAR = 64.0
_CHUNK = 4_000_000
_PEAK_STEPS = 8


@dataclass(frozen=True)
class SolveStats:
    """What a solve cost: final order, Galerkin matrices built, quadrature nodes, retardation terms kept."""

    order: int
    matrices: int
    nodes: int
    terms: int


@dataclass(frozen=True)
class Found:
    """A single-patch contact that carries the load (internal to the solver)."""

    contact: Contact
    penetration: float
    energy_error: float
    error_estimate: float
    creep: CreepSpectrum


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """Result of `solve`.

    Figures exist where a contact was found (status OK or NOT_CONVERGED, the latter with its error); reading one of a
    refused problem raises NoSolutionError with the status' advice.

    Attributes
    ----------
    problem : ContactProblem
        What was solved.
    status : Status
        Why the solve stopped.
    advice : tuple of str
        Remarks on validity, e.g. a penetration beyond small strain.
    stats : SolveStats
        What it cost.
    """

    problem: ContactProblem
    status: Status
    stats: SolveStats
    advice: tuple[str, ...] = ()
    _found: Found | None = field(default=None, repr=False)

    def _need(self) -> Found:
        if self._found is None:
            raise NoSolutionError(self.message)
        return self._found

    @property
    def message(self) -> str:
        """Why the solve stopped, what to change, and remarks on validity."""
        return "; ".join((self.status.message, *self.advice))

    @property
    def friction(self) -> float:
        """μ = F_T/F_N [-]."""
        return float(self._need().contact.friction[0])

    @property
    def half_width(self) -> float:
        """a/R [-]."""
        return float(self._need().contact.alpha[0]) / self.problem.rho

    @property
    def eccentricity(self) -> float:
        """e/R [-], positive toward the side the layer comes from (paper, Fig. 1)."""
        return float(self._need().contact.eps[0]) / self.problem.rho

    @property
    def outer_edge(self) -> float:
        """(a + |e|)/R [-], the edge farther from the roll's crown."""
        return self.half_width + abs(self.eccentricity)

    @property
    def penetration(self) -> float:
        """Δ/R [-]: mean line of the deformed surface to the roll's crown."""
        return self._need().penetration

    @property
    def dissipation(self) -> float:
        """W̃_d = μ p̃_m ζ_1 [-] (paper, section 3), ζ_1 = creep.times[0]; zero for an elastic layer."""
        times = self.problem.creep.times
        return self.friction * self.problem.pressure * float(times[0]) if times.size else 0.0

    @property
    def energy_error(self) -> float:
        """Relative difference of friction by geometry and by loss compliance [-]."""
        return self._need().energy_error

    @property
    def error_estimate(self) -> float:
        """Estimated relative error of friction [-]."""
        return self._need().error_estimate

    @property
    def patches(self) -> Array:
        """Contact strips in x/R about the roll's axis, shape (1, 2)."""
        e, a = self.eccentricity, self.half_width
        return np.array([[e - a, e + a]])

    @cached_property
    def peak_pressure(self) -> float:
        """Largest pressure p̃ [-]."""
        return float(peak(self._need().contact.c)[0])

    def pressure(self, x: ArrayLike) -> Array:
        """Contact pressure p̃ at x/R about the roll's axis; zero outside the contact; shape of x."""
        contact = self._need().contact
        s = (np.asarray(x, dtype=float) * self.problem.rho - contact.eps[0]) / contact.alpha[0]
        angle = np.arccos(np.clip(s, -1.0, 1.0))
        v = np.arange(1, contact.c.shape[1] + 1)
        return np.where(np.abs(s) < 1.0, np.sin(np.multiply.outer(angle, v)) @ contact.c[0], 0.0)

    def profile(self, x: ArrayLike) -> Array:
        """Surface displacement u/R about its mean line at x/R about the roll's axis; shape of x.

        Inside the contact the roll's own shape, outside the Fourier series up to m α = 600: cut off at about
        1e-7 of the depth, 3e-5 at the very edges.
        """
        found = self._need()
        contact, rho = found.contact, self.problem.rho
        at = np.asarray(x, dtype=float)
        period = 2.0 * np.pi / rho
        wrapped = at - period * np.round((at - self.eccentricity) / period)
        inside = np.abs(wrapped - self.eccentricity) <= self.half_width
        shape = (
            found.penetration
            - 1.0
            + np.sqrt(np.where(inside, 1.0 - np.where(inside, wrapped, 0.0) ** 2, 1.0))
        )
        out = np.where(inside, shape, 0.0)
        outer = wrapped[~inside] * rho - contact.eps[0]
        out[~inside] = surface_series(self.problem, found.creep, contact, outer)
        return out


def peak(c: Array) -> Array:
    """Largest pressure of contacts with coefficients c, shape (b, n): sampled, then Newton on dp/dθ = 0."""
    n = c.shape[1]
    v = np.arange(1.0, n + 1.0)
    angle = np.linspace(0.0, np.pi, 8 * n + 17)
    sampled = c @ np.sin(np.multiply.outer(v, angle))
    best = np.argmax(sampled, axis=1)
    theta = angle[best]
    for _ in range(_PEAK_STEPS):
        turn = np.multiply.outer(theta, v)
        first = np.einsum("bv,bv->b", np.cos(turn), v * c)
        second = -np.einsum("bv,bv->b", np.sin(turn), v * v * c)
        curved = second < 0.0
        theta = np.where(curved, theta - first / np.where(curved, second, -1.0), theta)
        theta = np.clip(theta, angle[best] - angle[1], angle[best] + angle[1])
    refined = np.einsum("bv,bv->b", np.sin(np.multiply.outer(theta, v)), c)
    highest: Array = np.maximum(refined, sampled.max(axis=1))
    return highest


def surface_series(problem: ContactProblem, creep: CreepSpectrum, contact: Contact, x: Array) -> Array:
    """u/R at X = x about the contact's centre, |x| ≤ π, shape (p,): w = 2 Re Σ S_m p̃̂_m e^{imX}/m up to m α = 600."""
    if x.size == 0:
        return np.empty(0)
    alpha, c = float(contact.alpha[0]), contact.c[0]
    v = np.arange(1, c.size + 1)
    amplitudes = 0.5 * v * c * (-1j) ** ((v - 1) % 4)
    out = np.zeros(x.size)
    # far from the contact the series' tail cancels: a wave number turns |x| radians, and 64 x 600 are enough
    octave = np.floor(np.log2(np.maximum(np.abs(x) / alpha, 1.0)))
    for group in np.unique(octave):
        chosen = octave == group
        far = float(np.abs(x[chosen]).max())
        end = _SERIES_REACH / alpha * min(1.0, _FAR * alpha / far)
        m, weights = series_rule(problem.layer, creep, span=alpha + far, end=end)
        step = max(1, _CHUNK // max(int(chosen.sum()), c.size))
        for i in range(0, m.size, step):
            part = m[i : i + step]
            wave = 2.0 * weights[i : i + step] * (amplitudes @ bessel_j(c.size, part * alpha)[1:]) / part
            out[chosen] += np.real(np.exp(1j * np.multiply.outer(x[chosen], part)) @ wave)
    return out
