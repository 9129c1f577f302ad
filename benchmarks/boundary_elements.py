"""The paper's own route to the contact, for comparison: boundary elements in real space on a graded mesh.

    python benchmarks/boundary_elements.py

Menga, Bottiglione and Carbone (Lubricants 2019), Eqs. (1)-(9): displacement u = -∫ Θ(x - s) p(s) ds, constant pressure
on elements graded toward both edges, half width and eccentricity from vanishing stress intensity at both. Corrected:
the free layer has its own symbol (Eq. (5) prints the confined one), and u = Δ - R + v(x + e) (Eq. (9)). Scales:
conveyor/contact/problem.py. Shared with `conveyor.contact.solve`: the symbols of the layers and the problem, no more.

Kinder to the route than the paper, which gives no such detail: the kernel is tabled once, elements are collocated at
their mid-points in angle (at the mid-points in X the half width converges with order 2, not 3), and at each half
width the other unknowns follow from one factorisation.
"""

from __future__ import annotations

import os

os.environ["OMP_NUM_THREADS"] = "1"  # before numpy: BLAS reads it once
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import math
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from numpy.polynomial import chebyshev
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray
from scipy.fft import dct
from scipy.linalg import lu_factor, lu_solve
from scipy.special import digamma, exp1, expi, factorial

from conveyor.contact import ContactProblem, ContactSolution, solve
from conveyor.errors import InputError, NoSolutionError
from conveyor.validation.contact_cases import ReferenceCase, reference_cases

Array = NDArray[np.float64]

FEWEST_ELEMENTS = 8
ELEMENTS = (16, 32, 64, 128, 256, 512)
RTOLS = (1e-4, 1e-6, 1e-8)
CASES = ("free R.4 z1.0", "confined R.4 z1.0", "confined 15 terms conveyor")
RUNS = 5

_SERIES_UP_TO, _SERIES_TERMS = 2.0, 26  # 2^27/27! = 1e-20
_ASYMPTOTIC_FROM, _ASYMPTOTIC_TERMS = 50.0, 20  # 20!/50^20 = 3e-16
_PLAIN, _INTEGRAL = 1, 2
_ONES = 1.0 / factorial(np.arange(_SERIES_TERMS))
_DIGAMMAS = _ONES * digamma(np.arange(_SERIES_TERMS) + 1.0)
_FACTORIALS = factorial(np.arange(_ASYMPTOTIC_TERMS))
_IMAGES_DEGREE = 32  # the images begin at ±2π seen from ±π: (2 + √3)^-32 = 5e-19
_PANEL_DEGREE = 15  # two panels per octave: (5 + √24)^-15 = 1e-15
_LARGEST = 3.25  # tables end at this over a power of two, the largest beyond π
_ROUNDING = 37.0  # -ln 1e-16
_REACH_DEPTH = 20.0  # `Layer.reach` is this over k h; the layer's kernel is analytic for |Im X| < 2 k h
_PANEL_OVER_THICKNESS = 0.8  # keeps the end of that strip as far from a panel as X = 0 is
_SPARE_OCTAVES = 4  # below the smallest distance of the first mesh
_COARSE = 32  # elements of the first mesh, which gives the half width to start from
_STEPS = 60
_INSIDE = 0.999  # of the room between the contact and the edge of the roll
_LOAD_TOLERANCE, _COARSE_TOLERANCE = 1e-10, 1e-4
_PLACE_TOLERANCE = 1e-7  # of α: Newton squares it once more


@dataclass(frozen=True)
class BoundaryElementContact:
    """What the boundary elements found.

    Parameters
    ----------
    friction : float
        μ = -(1/λ) ∫ p u' dx/p_m [-].
    half_width, eccentricity, penetration : float
        a/R, e/R, Δ/R [-].
    iterations : int
        Matrices formed and factorised with all elements.
    """

    friction: float
    half_width: float
    eccentricity: float
    penetration: float
    iterations: int


_Found = BoundaryElementContact | ContactSolution


# Kernel


def _memory(x: Array, first: int) -> Array:
    """Σ_{n >= first} xⁿ/n! (ψ(n+1) - ln|x|): retarded half-space (first = 1) and its integral from 0 (first = 2).

    The first is h(x) = γ + ln|x| + PV ∫_0^∞ e^{-z}/(x + z) dz, the memory integral of Eq. (7) over ln|X + ζz| at
    x = X/ζ, less its constant; it obeys h - h' = ln|x| + γ. The second is ∫_0^x h = h - (1 - γ) x + x ln|x|.
    """
    out = np.zeros_like(x)
    size = np.abs(x)
    near, far = size <= _SERIES_UP_TO, size > _ASYMPTOTIC_FROM
    y = x[near]
    digammas, ones = (polyval(y, coefficients[first:]) for coefficients in (_DIGAMMAS, _ONES))
    out[near] = y**first * (digammas - np.log(size[near]) * ones)
    inverse = 1.0 / x[far]
    out[far] = inverse * polyval(-inverse, _FACTORIALS)
    middle = ~near & ~far
    y = x[middle & (x > 0.0)]
    out[middle & (x > 0.0)] = np.exp(y) * exp1(y)
    y = x[middle & (x < 0.0)]
    out[middle & (x < 0.0)] = -np.exp(y) * expi(-y)
    y, log = x[~near], np.log(size[~near])
    out[~near] += log + np.euler_gamma
    if first == _INTEGRAL:
        out[~near] += y * (log - 1.0 + np.euler_gamma)
    return out


@cache
def _collocation(degree: int) -> tuple[Array, ...]:
    """Chebyshev nodes on (-1, 1), and the matrices of values and slopes there from coefficients."""
    t = chebyshev.chebpts2(degree + 1)
    slopes = [chebyshev.chebval(t, chebyshev.chebder(row)) for row in np.eye(degree + 1)]
    return t, chebyshev.chebvander(t, degree), np.array(slopes).T


class Kernel:
    """Ψ(X) = ∫ Θ dX, Θ(X) = 2 Re Σ_{m>=1} S_m e^{imX}/m, tabled once and interpolated: Eqs. (2)-(7).

    Parameters
    ----------
    problem : ContactProblem
        Layer and creep.
    nearest, farthest : float
        Range of |X| the table covers; |X| counts to the nearest image, so it does not exceed π.
    """

    def __init__(self, problem: ContactProblem, nearest: float, farthest: float) -> None:
        self._problem = problem
        creep = problem.creep
        lasting = creep.times > 0.0
        self._instant = creep.instantaneous + float(creep.weights[~lasting].sum())
        self._weights, self._times = creep.weights[lasting], creep.times[lasting]
        self._top = _octave(min(farthest, math.pi))
        self._bottom = _octave(nearest)
        widths = _LARGEST * 2.0 ** (np.arange(self._top, self._bottom - 1, -1) - 1.0)
        reach = problem.layer.reach
        allowed = _PANEL_OVER_THICKNESS * _REACH_DEPTH / reach if reach else math.inf
        self._panels = 2 * 2 ** np.ceil(np.log2(np.maximum(widths / (2.0 * allowed), 1.0))).astype(int)
        self._offsets = np.concatenate(([0], np.cumsum(self._panels)))
        self._coefficients = self._table(problem, widths)

    def covering(self, nearest: float, farthest: float) -> Kernel:
        """Return this kernel, or one with a larger table where the range of |X| exceeds it."""
        if self._bottom <= _octave(nearest) and _octave(min(farthest, math.pi)) <= self._top:
            return self
        return Kernel(self._problem, nearest * 2.0**-_SPARE_OCTAVES, farthest)

    def _table(self, problem: ContactProblem, widths: Array) -> Array:
        """Chebyshev coefficients of Ψ on each panel, shape (degree + 1, panels of X > 0, then of X < 0)."""
        width = np.repeat(widths / self._panels, self._panels)
        piece = np.arange(width.size) - np.repeat(self._offsets[:-1], self._panels)
        left = np.repeat(widths, self._panels) + piece * width
        nodes = chebyshev.chebpts1(_PANEL_DEGREE + 1)
        X = left + 0.5 * width * (nodes[:, None] + 1.0)
        X = np.concatenate((X, -X), axis=1)
        value = self._singular(X) + chebyshev.chebval(X / math.pi, self._images())
        if problem.layer.reach:
            half = 2.0 * float(widths[0])
            value += chebyshev.chebval(X / half, _layer_part(problem, half))
        return np.asarray(np.linalg.solve(chebyshev.chebvander(nodes, _PANEL_DEGREE), value))

    def _singular(self, X: Array) -> Array:
        """Isolated half-space, instantaneous and retarded: -2 j∞ (X ln|X| - X) - 2 Σ d_t ζ_t ∫ h."""
        value = -2.0 * self._instant * X * (np.log(np.abs(X)) - 1.0)
        if self._times.size:
            value -= 2.0 * np.tensordot(
                self._weights * self._times, _memory(np.divide.outer(X, self._times), _INTEGRAL), (0, -1)
            )
        return value

    def _images(self) -> Array:
        """Chebyshev coefficients on (-π, π) of what periodicity adds to the half-space.

        The periodic kernel obeys θ - ζ θ' = -2 ln|2 sin X/2|, the isolated one -2 h the same with -2 (ln|X/ζ| + γ):
        the difference is smooth, and θ(π) = θ(-π) fixes it.
        """
        t, values, slopes = _collocation(_IMAGES_DEGREE)
        smooth = -2.0 * np.log(np.sinc(t / 2.0))  # 2 sin(X/2)/X at X = πt
        theta = self._instant * np.linalg.solve(values, smooth)
        if self._times.size:
            scale = 1.0 / (1.0 + self._times)[:, None]
            matrix = (values - (self._times / math.pi)[:, None, None] * slopes) * scale[:, :, None]
            right = (smooth + 2.0 * (np.euler_gamma - np.log(self._times))[:, None]) * scale
            matrix[:, -1] = values[-1] - values[0]
            right[:, -1] = 2.0 * (_memory(math.pi / self._times, _PLAIN) - _memory(-math.pi / self._times, _PLAIN))
            theta += self._weights @ np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        return math.pi * chebyshev.chebint(theta)

    def __call__(self, X: Array) -> Array:
        """Ψ up to a constant at any X ≠ 0 whose distance to the nearest image is in the table."""
        X = X - 2.0 * math.pi * np.round(X / (2.0 * math.pi))
        fraction, exponent = np.frexp(np.abs(X) / _LARGEST)
        octave = self._top - exponent
        place = (2.0 * fraction - 1.0) * self._panels[octave]
        piece = place.astype(int)
        panel = self._offsets[octave] + piece
        panel += np.where(X < 0.0, self._offsets[-1], 0)
        t2 = 4.0 * (place - piece) - 2.0
        # Clenshaw
        b1 = self._coefficients[-1][panel]
        b2 = np.zeros_like(b1)
        for c in self._coefficients[-2:0:-1]:
            b2 *= -1.0
            b2 += t2 * b1
            b2 += c[panel]
            b1, b2 = b2, b1
        return self._coefficients[0][panel] + 0.5 * t2 * b1 - b2


def _octave(distance: float) -> int:
    """Exponent e of the octave 2^(e-1) <= |X|/3.25 < 2^e."""
    return math.frexp(distance / _LARGEST)[1]


def _layer_part(problem: ContactProblem, half: float) -> Array:
    """Chebyshev coefficients on (-half, half) of the layer's part 2 Im Σ (S_m - j(m)) e^{imX}/m²: A_m of Eq. (5)."""
    reach = problem.layer.reach
    m = np.arange(1.0, math.ceil(reach) + 1.0)
    amplitude = 2.0 * (problem.layer.symbol(m, problem.creep) - problem.creep.compliance(m)) / (m * m)
    # analytic for |Im X| < 2 k h; that many Chebyshev coefficients reach rounding
    degree = math.ceil(_ROUNDING / math.asinh(2.0 * _REACH_DEPTH / (reach * half)))
    angle: Array = np.multiply.outer(half * chebyshev.chebpts1(degree + 1)[::-1], m)
    value = np.cos(angle) @ amplitude.imag + np.sin(angle) @ amplitude.real
    coefficients = dct(value, type=2) / (degree + 1)
    coefficients[0] *= 0.5
    return np.asarray(coefficients)


# Contact


@dataclass(frozen=True)
class _Mesh:
    """Elements over (-1, 1), finer toward the ends like a cosine.

    Shapes: `ends` (n + 1,), `middles` (in angle) (n,), `intensity` (2, n): from pressures to the stress intensities.
    """

    ends: Array
    middles: Array
    intensity: Array


def _mesh(elements: int) -> _Mesh:
    ends = -np.cos(np.linspace(0.0, np.pi, elements + 1))
    middles = -np.cos((np.arange(elements) + 0.5) * (np.pi / elements))
    # p = K/√d + c √d at distance d from the edge, through the first two elements
    d = middles[:2] + 1.0
    intensity = np.zeros((2, elements))
    intensity[0, :2] = np.array([1.0, -1.0]) * np.sqrt(d) / d / (1 / d[0] - 1 / d[1])
    intensity[1] = intensity[0, ::-1]
    return _Mesh(ends, middles, intensity)


@dataclass(frozen=True)
class _Strip:
    """Contact of half width α whose stress intensities vanish: ε, Δ/R, load p̃_m, friction, lowest pressure."""

    eccentricity: float
    penetration: float
    pressure: float
    friction: float
    lowest: float


def _circle(t: Array) -> tuple[Array, Array]:
    """1 - √(1 - t²), without cancellation, and its derivative t/√(1 - t²): the roll below its top, t = (X + ε)/ρ."""
    root = np.sqrt(1.0 - t * t)
    return t * t / (1.0 + root), t / root


def _strip(kernel: Kernel, mesh: _Mesh, alpha: float, rho: float, eccentricity: float) -> _Strip:
    """Solve Eq. (9) at half width α for the pressures, the eccentricity and the penetration."""
    psi = kernel(alpha * (mesh.middles[:, None] - mesh.ends))
    factors = lu_factor((psi[:, :-1] - psi[:, 1:]) / (2.0 * math.pi), overwrite_a=True, check_finite=False)
    # intensities of the pressures below a displacement w: K = (intensity A⁻¹) w
    lift = lu_solve(factors, mesh.intensity.T, trans=1).T
    lift /= lift.sum(axis=1, keepdims=True)
    tilt = lift[0] - lift[1]
    middles = alpha * mesh.middles
    room = rho - alpha
    for _ in range(_STEPS):
        depth, falling = _circle((middles + eccentricity) / rho)
        step = -float(tilt @ depth) / float(tilt @ falling) * rho
        # the roll's half circle ends at |X + ε| = ρ
        step = min(max(step, -0.5 * (room + eccentricity)), 0.5 * (room - eccentricity))
        eccentricity += step
        if abs(step) <= _PLACE_TOLERANCE * alpha:
            break
    else:
        raise NoSolutionError(f"no eccentricity frees both edges at a/R = {alpha / rho:.6g}")
    depth, _ = _circle((middles + eccentricity) / rho)
    penetration = float(lift[0] @ depth)
    p = lu_solve(factors, penetration - depth)
    load = p * (alpha * np.diff(mesh.ends))
    # -ρ w' = t/√(1 - t²), averaged over each element
    t = (alpha * mesh.ends + eccentricity) / rho
    root = np.sqrt(1.0 - t * t)
    slope = (t[1:] + t[:-1]) / (root[1:] + root[:-1])
    total = float(load.sum())
    return _Strip(eccentricity, penetration, total / (2.0 * math.pi), float(load @ slope) / total, float(p.min()))


@dataclass(frozen=True)
class _Start:
    """Half width and eccentricity to begin with, and the slope of ln p̃_m over ln α there."""

    alpha: float
    eccentricity: float
    slope: float


def _loaded(
    kernel: Kernel, problem: ContactProblem, elements: int, start: _Start, tolerance: float
) -> tuple[_Start, _Strip, int]:
    """Place and contact that carry the load, by secants of ln p̃_m over ln α, and how many half widths were tried."""
    mesh, rho = _mesh(elements), problem.rho
    smallest = float(mesh.middles[0] - mesh.ends[0])
    alpha, eccentricity, slope = start.alpha, start.eccentricity, start.slope
    last = None
    for count in range(1, _STEPS + 1):
        # the far edge may be nearer to the next roll's contact
        kernel = kernel.covering(min(smallest * alpha, 2.0 * (math.pi - alpha)), 2.0 * alpha)
        strip = _strip(kernel, mesh, alpha, rho, eccentricity)
        if strip.pressure <= 0.0:
            raise NoSolutionError(f"a/R = {alpha / rho:.6g} needs tension: more than one strip is in contact")
        here, off = math.log(alpha), math.log(strip.pressure / problem.pressure)
        if last is not None and (off - last[1]) * (here - last[0]) > 0.0:
            slope = (off - last[1]) / (here - last[0])
        if abs(off) <= tolerance:
            return _Start(alpha, strip.eccentricity, slope), strip, count
        last = here, off
        alpha = min(alpha * math.exp(min(max(-off / slope, -1.0), 1.0)), 0.5 * (alpha + rho))
        # the next strip must begin inside the roll's half circle
        room = _INSIDE * (rho - alpha)
        eccentricity = min(max(strip.eccentricity, -room), room)
    raise NoSolutionError(f"{_STEPS} half widths tried, the load is off by {off:.1e}")


def solve_boundary_elements(problem: ContactProblem, elements: int) -> BoundaryElementContact:
    """Solve the periodic viscoelastic contact by boundary elements; one strip in contact is assumed.

    Parameters
    ----------
    problem : ContactProblem
        The contact.
    elements : int
        Number of elements of constant pressure across the contact, at least 8.

    Returns
    -------
    BoundaryElementContact
        Friction and place of the contact.

    Raises
    ------
    InputError
        Too few elements.
    NoSolutionError
        No half width carries the load with both edges free of stress intensity, or one strip would need tension.
    """
    if elements < FEWEST_ELEMENTS:
        raise InputError(f"elements = {elements!r}: at least {FEWEST_ELEMENTS} are needed")
    # Hertz on the relaxed half-space: α = 2 ρ √p̃_m
    alpha = min(2.0 * problem.rho * math.sqrt(problem.pressure), 0.5 * problem.rho)
    # half the smallest angle to an element's end, with octaves to spare
    nearest = alpha * 0.125 * (math.pi / elements) ** 2
    kernel = Kernel(problem, nearest * 2.0**-_SPARE_OCTAVES, 2.0 * alpha)
    start = _Start(alpha, 0.0, 2.0)
    if elements > _COARSE:
        start, _, _ = _loaded(kernel, problem, _COARSE, start, _COARSE_TOLERANCE)
    place, strip, count = _loaded(kernel, problem, elements, start, _LOAD_TOLERANCE)
    if strip.lowest < 0.0:
        raise NoSolutionError(f"one strip would need tension, p̃ = {strip.lowest:.3g}: the contact splits")
    return BoundaryElementContact(
        strip.friction, place.alpha / problem.rho, place.eccentricity / problem.rho, strip.penetration, count
    )


def timed(work: Callable[[], object]) -> float:
    """Median wall time [ms]."""
    work()
    times = []
    for _ in range(RUNS):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return 1e3 * statistics.median(times)


def _errors(found: _Found, case: ReferenceCase) -> list[float]:
    """Relative errors of friction, half width, eccentricity and penetration."""
    names = ("friction", "half_width", "eccentricity", "penetration")
    return [abs(getattr(found, name) / getattr(case, name) - 1.0) for name in names]


def _line(case: ReferenceCase, name: str, work: Callable[[], _Found], before: list[float]) -> list[float]:
    """Print one line and return its errors; `before` are those of half as many elements, if any."""
    found = work()
    matrices = found.iterations if isinstance(found, BoundaryElementContact) else found.stats.matrices
    errors = _errors(found, case)
    orders = [f"({math.log2(b / e):4.1f})" for b, e in zip(before, errors, strict=True)] if before else [""] * 4
    cells = " ".join(f"{e:8.1e} {order:6}" for e, order in zip(errors, orders, strict=True))
    print(f"{name:>10} {matrices:8d} {timed(work):7.1f} {cells}".rstrip())
    return errors


def main() -> None:
    cases = {case.name: case for case in reference_cases()}
    for name in CASES:
        case = cases[name]
        print(f"\n{name}: relative errors, in brackets the order in 1/elements since the line before")
        print(f"{'elements':>10} {'matrices':>8} {'ms':>7} {'friction':15} {'a':15} {'e':15} Δ")
        before: list[float] = []
        for elements in ELEMENTS:
            before = _line(case, f"{elements}", partial(solve_boundary_elements, case.problem, elements), before)
        for rtol in RTOLS:
            _line(case, f"rtol {rtol:.0e}", partial(solve, case.problem, rtol=rtol), [])
    # against `solve` at rtol 1e-12
    print("\nrtol: conveyor.contact.solve. The references are good to 1e-10 in friction and 1e-11 in the places, but")
    print("the conveyor's a to 1.5e-8, e to 5e-7, Δ to 2.1e-8: both methods approach values that far from them.")


if __name__ == "__main__":
    main()
