"""A solved contact: results with their errors, and fields computed on demand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require
from conveyor.contact.fields.contact_fields import Fields, SpectralFields
from conveyor.contact.fields.energy_balance import Strip, belt_losses
from conveyor.contact.fields.excitation import LOSS_SHARES, excited_harmonics
from conveyor.contact.layers.belt_layer import BeltSupport
from conveyor.contact.layers.layer_models import Confined, HalfSpace
from conveyor.contact.problem import ContactProblem, Status
from conveyor.contact.solvers.peak_error import FieldErrors
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]

_FIGURES = (
    "friction", "half_width", "eccentricity", "penetration", "peak_pressure", "dissipation", "energy_error",
    "error_estimate",
)  # fmt: skip
_SHALLOW = 0.5
_DEEP_REMARK = "the penetration is {:.2f} R, far outside small strain"


@dataclass(frozen=True)
class SolveStats:
    """Solver statistics.

    Attributes
    ----------
    order : int
        Final Galerkin order; zero where only the grid answered.
    matrices : int
        Galerkin matrices built.
    nodes : int
        Quadrature nodes of one matrix.
    terms : int
        Retardation terms kept: those without time (ζ = 0) are instantaneous.
    grid : int
        Grid nodes in a period; zero where no grid was needed.
    way : str
        "narrow": short rule, gap outside not checked; "one strip"; "strips": located on the grid, refined
        spectrally; "grid": no spectral solution; "curve": interpolated between contacts.
    """

    order: int
    matrices: int
    nodes: int
    terms: int
    grid: int = 0
    way: str = "one strip"


@dataclass(frozen=True, eq=False)
class ContactResult:
    """Contact that carries the load (internal to the solver); lengths X, `centre` of the outer edges."""

    friction: float
    mean_pressure: float
    half_width: float
    centre: float
    strips: Array
    energy_error: float
    error_estimate: float
    edge_error: float  # X
    fields: Fields
    peak_error: float = 0.0  # of the largest pressure, relative, by the places of the strips


@dataclass(frozen=True, eq=False)
class SolveOutcome:
    """Status, result and cost of one solver (internal to the solver)."""

    status: Status
    found: ContactResult | None = None
    order: int = 0
    grid: int = 0
    matrices: int = 0
    nodes: int = 0
    terms: int = 0
    way: str = "one strip"
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class ContactSolution:
    """Result of `solve`.

    Results exist with status OK, TOO_DEEP and, where there is a contact, NOT_CONVERGED; reading one of a refused
    problem raises NoSolutionError with the status' advice.

    Attributes
    ----------
    problem : ContactProblem
        What was solved.
    status : Status
        Reason why the solve stopped.
    stats : SolveStats
        Cost of the solve.
    """

    problem: ContactProblem
    _end_status: Status
    stats: SolveStats
    _remarks: tuple[str, ...] = ()
    _found: ContactResult | None = field(default=None, repr=False)

    def _need(self) -> ContactResult:
        if self._found is None:
            raise NoSolutionError(self.message)
        return self._found

    @cached_property
    def status(self) -> Status:
        """Reason why the solve stopped; TOO_DEEP where a converged contact is deeper than the radius."""
        deep = self._end_status is Status.OK and not self._plainly_shallow and self.penetration > 1.0
        return Status.TOO_DEEP if deep else self._end_status

    @property
    def _plainly_shallow(self) -> bool:
        """True if |S| ≤ 1 and |p̂_m| ≤ p̃_m alone bound Δ far below R: W ≤ 2 p̃_m (ln 1/α + 2), and the drop."""
        solved = self._need()
        if not isinstance(self.problem.layer, (HalfSpace, Confined)):
            return False
        sunk = 2.0 * solved.mean_pressure * (2.0 + max(math.log(1.0 / solved.half_width), 0.0))
        return sunk + self.outer_edge**2 < _SHALLOW

    @cached_property
    def advice(self) -> tuple[str, ...]:
        """Remarks on validity, e.g. a penetration beyond small strain."""
        if self._found is None or self._plainly_shallow or self.penetration <= 1.0:
            return self._remarks
        return (_DEEP_REMARK.format(self.penetration), *self._remarks)

    @property
    def message(self) -> str:
        """Reason why the solve stopped, what to change, and remarks on validity."""
        return "; ".join((self.status.message, *self.advice))

    def _repr_html_(self) -> str:
        """Results, or why there are none, for notebooks."""
        from conveyor.text.markup import name_value_table

        rows: list[tuple[str, object]] = [("status", self.message)]
        if self._found is not None:
            rows += [(name, f"{getattr(self, name):.8g}") for name in _FIGURES]
            rows.append(("patches", "; ".join(f"{left:.6g} to {right:.6g}" for left, right in self.patches)))
        return str(name_value_table("ContactSolution, lengths over R", rows))

    @property
    def friction(self) -> float:
        """μ = F_T/F_N [-]."""
        return self._need().friction

    @property
    def half_width(self) -> float:
        """a/R [-]; of a split contact half the distance of its outer edges."""
        return self._need().half_width / self.problem.rho

    @property
    def eccentricity(self) -> float:
        """e/R [-], centre of the outer edges, positive toward the side the layer comes from (paper, Fig. 1)."""
        return self._need().centre / self.problem.rho

    @property
    def outer_edge(self) -> float:
        """(a + |e|)/R [-], the edge farther from the roll's crown."""
        return self.half_width + abs(self.eccentricity)

    @cached_property
    def penetration(self) -> float:
        """Δ/R [-]: mean line of the deformed surface to the roll's crown."""
        return self._need().fields.depth()

    @property
    def mean_shift(self) -> float:
        """u_m/R [-]: mean line of the deformed surface below the undeformed one, u_m = (1+ν)(1-2ν) p_m h/((1-ν) E0).

        Zero for an incompressible layer (paper, Eq. 8); Δ + u_m is the approach of roll and undeformed surface.

        Raises
        ------
        NoSolutionError
            A compressible half-space, whose mean line sinks without bound, or a layer of the user's own.
        """
        nu, problem = self.problem.poisson, self.problem
        if nu == 0.5:
            return 0.0
        if not isinstance(problem.support, str):
            raise NoSolutionError("mean_shift: the mean compression of a Layer of your own is not known here")
        if problem.support == "half-space" or math.isinf(problem.thickness):
            raise NoSolutionError("mean_shift: a compressible half-space under a mean load sinks without bound")
        return (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu) ** 2) * problem.pressure * problem.thickness

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
    def edge_error(self) -> float:
        """Estimated error of patches, half width and eccentricity over R [-], by a contact of higher order."""
        resolved = self._need().edge_error + self._errors.edges
        return resolved / self.problem.rho + self.outer_edge * self.error_estimate

    @property
    def peak_error(self) -> float:
        """Estimated relative error of the largest pressure [-], by a contact of higher order."""
        return self._need().peak_error + self._errors.peak + self.error_estimate

    @cached_property
    def _errors(self) -> FieldErrors:
        return self._need().fields.errors(self.problem)

    @property
    def patches(self) -> Array:
        """Contact strips in x/R about the roll's axis, shape (l, 2), from left to right."""
        patches: Array = self._need().strips / self.problem.rho
        return patches

    @property
    def strips(self) -> list[Strip] | None:
        """Centre and half width X, and sine coefficients of p̃, of every strip; None for a contact on a grid only."""
        fields = self._need().fields
        return fields.strips if isinstance(fields, SpectralFields) else None

    @cached_property
    def peak_pressure(self) -> float:
        """Largest pressure p̃ [-]."""
        return self._need().fields.peak()

    def excitation(self, shares: Sequence[float] = LOSS_SHARES) -> Array:
        """Harmonics m below which given shares of the loss lie, shape of `shares` [-].

        The layer's particles pass them at the frequency f = m V/λ: between the first and the last of the default
        shares nine tenths of the energy are lost.

        Raises
        ------
        InputError
            Shares outside (0, 1), or not ascending.
        NoSolutionError
            Nothing is lost (an elastic layer), or the contact is known on a grid only.
        """
        try:
            ascending = bool(np.all(np.diff(np.array([0.0, *shares, 1.0], dtype=float)) > 0.0))
        except (TypeError, ValueError):
            ascending = False
        require(ascending, "shares", shares, "ascending numbers > 0 and < 1")
        fields = self._lossy("excitation")
        return excited_harmonics(fields.layer, fields.creep, fields.strips, shares)

    @cached_property
    def loss_shares(self) -> dict[str, float]:
        """Shares of the loss [-], sum 1: of bottom_cover, top_cover and carcass; a single layer is the bottom cover.

        Raises
        ------
        NoSolutionError
            Nothing is lost (an elastic belt), or the contact is known on a grid only.
        """
        fields, top, carcass = self._lossy("loss_shares"), 0.0, 0.0
        if isinstance(fields.layer, BeltSupport):
            whole = self.friction * self._need().mean_pressure / (2.0 * self.problem.rho)
            lost = belt_losses(fields.layer, fields.creep, fields.strips)
            top, carcass = lost[0] / whole, lost[1] / whole
        return {"bottom_cover": 1.0 - top - carcass, "top_cover": top, "carcass": carcass}

    def _lossy(self, asked: str) -> SpectralFields:
        fields = self._need().fields
        if self.friction == 0.0 or not isinstance(fields, SpectralFields):
            raise NoSolutionError(f"{asked}: no loss, or a contact that is known on a grid only, has none")
        return fields

    def pressure(self, x: ArrayLike) -> Array:
        """Contact pressure p̃ at x/R about the roll's axis; zero outside the contact; shape of x."""
        at = self._beside_roll(x)
        return self._need().fields.pressure(at * self.problem.rho)

    def profile(self, x: ArrayLike) -> Array:
        """Surface displacement u/R about its mean line at x/R about the roll's axis; shape of x.

        Inside the contact the roll's own shape, outside the Fourier series up to m α = 600: cut off at about
        1e-7 of the depth, 3e-5 at the very edges.
        """
        solved = self._need()
        at = self._beside_roll(x)
        touching = ((at[..., None] >= self.patches[:, 0]) & (at[..., None] <= self.patches[:, 1])).any(axis=-1)
        out = np.asarray(self.penetration - 1.0 + np.sqrt(1.0 - np.where(touching, at, 0.0) ** 2))
        out[~touching] = solved.fields.outside(at[~touching] * self.problem.rho)
        return out

    def _beside_roll(self, x: ArrayLike) -> Array:
        """x/R shifted by whole periods to within half a period of the contact's centre."""
        try:
            at = np.array(x, dtype=float)
        except (TypeError, ValueError):
            raise InputError(f"x = {x!r}: places x/R are numbers") from None
        if not np.isfinite(at).all():
            raise InputError("x: places x/R are finite numbers")
        period = 2.0 * np.pi / self.problem.rho
        near: Array = at - period * np.round((at - self.eccentricity) / period)
        return near
