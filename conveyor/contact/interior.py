"""Stress, strain and dissipation inside the layer of a solved contact, computed only when asked for.

Every harmonic p̂_m e^{imX} of the pressure is a plane-strain layer problem of wave number one in y = m k z (depth),
t = m k (h - z) (height above the far face), q = y + t. With A = 2(1-ν), B = 1-2ν, κ = 3-4ν, C, S = cosh, sinh q and
c, s = cosh, sinh t its Airy stress function gives, per unit pressure,

    D = (σ_xx - σ_zz)/2,  T = τ_xz/i,  H = (σ_xx + σ_zz)/2,  U = 2G k m u_z      (u_z into the layer)

    half-space  D = T = y e^{-y},  H = -e^{-y},  U = (A + y) e^{-y}
    confined    D = [(AB + q t) cosh y + y (B S c + A C s)]/n,   T = [y (A C c + B S s) - (AB + q t) sinh y]/n,
                H = -[A C c + B S s + q sinh y]/n,   U = [κ (A C + q S) s - t (A C c + B S s) - q t sinh y]/n,
                n = κ C² + B² + q²
    free        D = [y S c - q t cosh y]/n,   T = [y S s + q t sinh y]/n,   H = [q sinh y - S s]/n,
                U = [A S c + q (A C c - B S s) + t (q sinh y - S s)]/n,   n = S² - q²

all evaluated with e^{-2q} and e^{-y} taken out, so that nothing overflows, and without a term 1/(1-2ν). The harmonics
travel with the roll: at a constant Poisson's ratio the stresses are the elastic ones and the strains follow by the
correspondence principle, ε̂_m = j(m) σ̂_m ρ/(2(1-ν)) (E0/(1+ν) is 2G; p̃ holds E0 k R/(2(1-ν²)), see problem.py).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import fft, special

from conveyor.contact.bessel import bessel_j
from conveyor.contact.layers import Confined, Creep, Free, HalfSpace, free_symbol
from conveyor.contact.problem import CreepSpectrum
from conveyor.contact.quadrature import series_rule
from conveyor.contact.solution import ContactSolution
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Shapes = tuple[Array, Array, Array, Array]

_HARMONICS = 4.0  # m α up to this many times `points`: two wave numbers for each spacing of the places
_DEEPEST = 12.0  # k z where e^{-2kz} leaves 4e-11 of the dissipation of a half-space
_GRADE = 0.5  # of the half width: depths are linear in z above it, logarithmic below
_NEAR = 2.0  # half widths about a strip that are sampled evenly, octaves beyond
_OCTAVE = 6  # an octave on one side takes a sixth of the places of the near field
# outside the strips the field is smooth over the distance d to them: a flat window ½ erfc((m - m1)/w) ending at 40/d
# blurs over less than d and leaves 2e-4 of it
_FAR, _MIDDLE, _RAMP = 40.0, 0.62, 0.15
_CHUNK = 512
_GRID_TERMS = 256  # sine coefficients of a pressure known on a grid
_FEWEST_DEPTHS, _FEWEST_POINTS = 4, 12
_COARSER = 0.6
_PLAIN = CreepSpectrum(1.0)


class _Unity:
    """A symbol equal to m, whose summation rule carries plain weights."""

    reach = 0.0

    def symbol(self, m: Array, creep: Creep) -> ComplexArray:
        return m * creep.compliance(m)


@dataclass(frozen=True, eq=False)
class _Strip:
    """A strip's pressure: centre X about the roll's axis, half width α, sine coefficients c."""

    centre: float
    alpha: float
    c: Array

    def amplitude(self, m: Array) -> ComplexArray:
        """p̃̂_m about the strip's centre, ½ Σ_v v c_v (-i)^{v-1} J_v(mα)/m (spectral.py)."""
        v = np.arange(1, self.c.size + 1)
        phased = 0.5 * v * self.c * (-1j) ** ((v - 1) % 4)
        out: ComplexArray = (phased @ bessel_j(self.c.size, m * self.alpha)[1:].astype(complex)) / m
        return out


@dataclass(frozen=True, eq=False)
class InteriorFields:
    """Fields at places (x, z), each of shape (nz, nx), about their means over a period.

    Attributes
    ----------
    stress_xx, stress_zz, stress_xz : ndarray
        Stresses in the unit of p̃ [-], tension positive, z into the layer.
    strain_xx, strain_zz, strain_xz : ndarray
        Physical strains [-]; the shear is the angle γ = 2 ε_xz.
    displacement_x, displacement_z : ndarray
        u/R [-], z into the layer.
    """

    stress_xx: Array
    stress_zz: Array
    stress_xz: Array
    strain_xx: Array
    strain_zz: Array
    strain_xz: Array
    displacement_x: Array
    displacement_z: Array


@dataclass(frozen=True, eq=False)
class Interior:
    """What the particles of each depth undergo as the roll passes.

    Attributes
    ----------
    depth : ndarray, shape (nz,)
        z/R [-] below the loaded surface: the surface, Gauss nodes, the far face (a half-space has none).
    weights : ndarray, shape (nz,)
        Of the integral over z/R [-]; zero at the faces.
    amplitude : ndarray, shape (nz,)
        Equivalent strain amplitude [-] of a particle's path: half the largest distance of two of its points in the
        norm sqrt(2/3 e:e) of the deviatoric strain e.
    dissipation : ndarray, shape (nz,)
        Energy lost per volume and passage times R over the line load, D R/F_N [-]; its integral over z/R is μ.
    wave_number : float
        m at which the layer dissipates: mean of ln m, weighted with the dissipation [-]; ω = m k V. Zero for an
        elastic layer.
    """

    depth: Array
    weights: Array
    amplitude: Array
    dissipation: Array
    wave_number: float
    _solution: ContactSolution = field(repr=False)
    _points: int = field(repr=False)

    @property
    def relative_depth(self) -> Array:
        """z/h [-], shape (nz,).

        Raises
        ------
        NoSolutionError
            A half-space has no thickness.
        """
        thickness = getattr(self._solution.problem.layer, "thickness", math.inf)
        if math.isinf(thickness):
            raise NoSolutionError(
                "relative_depth: a half-space has no thickness; use depth, in units of the radius"
            )
        return self.depth * (self._solution.problem.rho / thickness)

    @property
    def friction(self) -> float:
        """μ [-] from the dissipation inside the layer."""
        return float(self.weights @ self.dissipation)

    @property
    def energy_error(self) -> float:
        """Relative difference of that friction and the solution's; zero for an elastic layer [-]."""
        friction = self._solution.friction
        return abs(self.friction / friction - 1.0) if self.dissipation.any() else 0.0

    @property
    def working_strain(self) -> float:
        """Strain amplitude averaged over the depth with the dissipation [-].

        Raises
        ------
        NoSolutionError
            An elastic layer dissipates nothing.
        """
        if not self.dissipation.any():
            raise NoSolutionError(
                "working_strain: an elastic layer dissipates nothing to weight with; use maximum"
            )
        return float((self.weights * self.amplitude) @ self.dissipation) / self.friction

    @property
    def maximum(self) -> float:
        """Largest amplitude of the depths, faces included [-]."""
        return float(self.amplitude.max())

    @cached_property
    def error_estimate(self) -> float:
        """Estimated relative error of the working strain, of the maximum where the layer is elastic [-].

        What 0.6 of the depths, and apart from it 0.6 of the places and wave numbers, change, added up.
        """
        name = "working_strain" if self.dissipation.any() else "maximum"
        nodes = int(np.count_nonzero(self.weights))
        fewer = (
            _interior(self._solution, int(_COARSER * nodes), self._points),
            _interior(self._solution, nodes, int(_COARSER * self._points)),
        )
        here = getattr(self, name)
        return float(sum(abs(getattr(coarse, name) / here - 1.0) for coarse in fewer))


def interior(solution: ContactSolution, *, depths: int = 16, points: int = 48) -> Interior:
    """Strain amplitude and dissipation over the depth of a solved contact.

    Parameters
    ----------
    solution : ContactSolution
        A contact on a half-space, a free or a confined layer.
    depths : int
        Gauss nodes over the depth [-], at least 4.
    points : int
        Places within two half widths of a strip's centre, at least 12 [-]; wave numbers end at m α = 4 `points`.

    Returns
    -------
    Interior
        Depths, amplitudes, dissipation and their means.

    Raises
    ------
    InputError
        `depths` or `points` too small, or a Layer of the user's own: its symbol does not tell its interior.
    NoSolutionError
        The solution holds no contact.

    Notes
    -----
    The amplitude is meant to be set beside the single strain amplitude of a dynamic test. A particle runs through a
    closed path in the space of deviatoric strains, not to and fro on a line: under a rolling contact the principal
    axes turn. Its size is half the path's diameter in the norm sqrt(2/3 e:e), the equivalent strain: a uniaxial
    incompressible test of amplitude ε gives ε, a shear test of amplitude γ gives γ/√3, a shear that turns without
    changing its size (a circle) gives its radius, and a pulse from rest to ε gives ε/2. The mean strain does not
    count. At the same amplitude a circle dissipates twice as much as a line; dissipation is not derived from the
    amplitude here, but summed from the harmonics. Small strain; linear; ν constant.

    Examples
    --------
    >>> from conveyor.contact import ContactProblem, CreepSpectrum, solve
    >>> problem = ContactProblem("confined", 0.066, 0.001, CreepSpectrum(0.5, [0.5], [0.02]), 0.03)
    >>> inside = interior(solve(problem))
    >>> round(inside.working_strain, 4), inside.energy_error < 1e-3
    (0.0153, True)
    """
    for name, value, least in (("depths", depths, _FEWEST_DEPTHS), ("points", points, _FEWEST_POINTS)):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            raise InputError(f"{name} = {value!r}: a whole number, at least {least}")
    return _interior(solution, int(depths), int(points))


def interior_fields(
    solution: ContactSolution, x: ArrayLike, depth: ArrayLike, *, points: int = 48
) -> InteriorFields:
    """Stresses, strains and displacements at every depth below every place.

    Parameters
    ----------
    solution : ContactSolution
        A contact on a half-space, a free or a confined layer.
    x : array_like, shape (nx,)
        x/R about the roll's axis [-].
    depth : array_like, shape (nz,)
        z/R below the loaded surface [-], from 0 to the far face.
    points : int
        Wave numbers end at m α = 4 `points` [-], at least 12.

    Returns
    -------
    InteriorFields
        Without the means over a period, which the harmonics m ≥ 1 do not hold.

    Raises
    ------
    InputError
        A depth outside the layer, `points` too small, or a Layer of the user's own.
    NoSolutionError
        The solution holds no contact.

    Notes
    -----
    The window blurs over R α/(ρ `points`): of use below that depth, and at the surface away from the edges.
    """
    if isinstance(points, bool) or not isinstance(points, (int, np.integer)) or points < _FEWEST_POINTS:
        raise InputError(f"points = {points!r}: a whole number, at least {_FEWEST_POINTS}")
    problem, inside = solution.problem, _Inside(solution, points)
    at, z = np.atleast_1d(np.asarray(x, dtype=float)), np.atleast_1d(np.asarray(depth, dtype=float))
    bottom = inside.thickness / problem.rho
    if at.ndim != 1 or z.ndim != 1 or not (np.all(np.isfinite(at)) and np.all((z >= 0.0) & (z <= bottom))):
        raise InputError(f"x, depth: finite lists, depths z/R from 0 to {bottom:g}, the far face")
    parts = inside.sums(at * problem.rho, z * problem.rho)
    (D, T, H), (d, g, v, u_x, u_z) = parts[:3], parts[3:]
    return InteriorFields(
        stress_xx=H + D,
        stress_zz=H - D,
        stress_xz=T,
        strain_xx=0.5 * v + d,
        strain_zz=0.5 * v - d,
        strain_xz=2.0 * g,
        displacement_x=u_x / problem.rho,
        displacement_z=u_z / problem.rho,
    )


def path_amplitude(*, difference: Array, shear: Array, dilatation: Array) -> Array:
    """Half the diameter of closed paths in the space of deviatoric plane strains.

    Parameters
    ----------
    difference : ndarray, shape (nz, nx)
        ε_xx - ε_zz along each path [-].
    shear : ndarray, shape (nz, nx)
        γ = 2 ε_xz [-].
    dilatation : ndarray, shape (nz, nx)
        ε_xx + ε_zz [-].

    Returns
    -------
    ndarray, shape (nz,)
        Amplitude in the norm sqrt(2/3 e:e), e:e = (difference² + γ²)/2 + dilatation²/6 [-].

    Examples
    --------
    >>> turn = np.linspace(0.0, 2.0 * np.pi, 9)[None]
    >>> circle = path_amplitude(difference=np.cos(turn), shear=np.sin(turn), dilatation=0.0 * turn)
    >>> line = path_amplitude(difference=0.0 * turn, shear=np.sin(turn), dilatation=0.0 * turn)
    >>> circle.round(6).tolist(), line.round(6).tolist()  # 1/√3
    ([0.57735], [0.57735])
    """
    path = np.stack([difference / math.sqrt(3.0), shear / math.sqrt(3.0), dilatation / 3.0], axis=2)
    square = np.einsum("zxi,zxi->zx", path, path)
    distance = square[:, :, None] + square[:, None, :] - 2.0 * (path @ path.swapaxes(1, 2))
    out: Array = 0.5 * np.sqrt(np.maximum(distance.max(axis=(1, 2)), 0.0))
    return out


def _interior(solution: ContactSolution, depths: int, points: int) -> Interior:
    inside, rho = _Inside(solution, points), solution.problem.rho
    z, weights = inside.depths(depths)
    d, g, v = inside.sums(inside.places(), z, strains_only=True)
    dissipation, wave_number = inside.dissipation(z)
    return Interior(
        depth=z / rho,
        weights=weights / rho,
        amplitude=path_amplitude(difference=2.0 * d, shear=2.0 * g, dilatation=v),
        dissipation=dissipation,
        wave_number=wave_number,
        _solution=solution,
        _points=points,
    )


class _Inside:
    """A contact's strips and its layer; lengths X = k x, Z = k z."""

    def __init__(self, solution: ContactSolution, points: int) -> None:
        problem = solution.problem
        layer = problem.layer
        if not isinstance(layer, (HalfSpace, Free, Confined)):
            raise InputError(
                f"support = {problem.support!r}: the interior of a Layer of your own is not known here; "
                "use free, confined or half-space"
            )
        self.problem, self.layer, self.points = problem, layer, points
        self.nu = layer.poisson if isinstance(layer, Confined) else problem.poisson
        self.thickness = math.inf if isinstance(layer, HalfSpace) else layer.thickness
        self.strips = _strips(solution)
        self.pressure = sum(0.25 * s.alpha * float(s.c[0]) for s in self.strips)
        self.scale = 0.5 * problem.rho / (1.0 - self.nu)

    def depths(self, count: int) -> tuple[Array, Array]:
        """The surface, Gauss nodes graded toward it, the far face if there is one, and their weights, in Z."""
        unit = _GRADE * min(s.alpha for s in self.strips)
        end = math.asinh(min(self.thickness, _DEEPEST) / unit)
        x, w = np.polynomial.legendre.leggauss(count)
        at = 0.5 * end * (x + 1.0)
        bottom = [] if math.isinf(self.thickness) else [self.thickness]
        z = np.concatenate([[0.0], unit * np.sinh(at), bottom])
        return z, np.concatenate([[0.0], 0.5 * end * w * unit * np.cosh(at), np.zeros(len(bottom))])

    def places(self) -> Array:
        """X along the path: evenly within two half widths of each strip, then by octaves up to half a period."""
        out = []
        per_octave = max(2, self.points // _OCTAVE)
        for strip in self.strips:
            near = strip.alpha * np.linspace(-_NEAR, _NEAR, self.points + 1)
            octaves = max(math.log2(math.pi / (_NEAR * strip.alpha)), 0.0)
            steps = math.ceil(octaves * per_octave)
            far = _NEAR * strip.alpha * 2.0 ** np.linspace(0.0, octaves, steps + 1)[1:]
            out.append(strip.centre + np.concatenate([-far, near, far]))
        return np.concatenate(out)

    def shapes(self, m: Array, z: Array) -> Shapes:
        """D, T, H, U at wave numbers m, shape (k,), and depths Z, shape (nz,); each (nz, k)."""
        y = np.multiply.outer(z, m)
        if isinstance(self.layer, HalfSpace):
            decay = np.exp(-y)
            return y * decay, y * decay, -decay, (2.0 * (1.0 - self.nu) + y) * decay
        t = np.multiply.outer(np.maximum(self.thickness - z, 0.0), m)
        kind: Callable[[Array, Array, Array, float], Shapes]
        kind = _confined if isinstance(self.layer, Confined) else _free
        return kind(m * self.thickness, y, t, self.nu)

    def sums(self, x: Array, z: Array, *, strains_only: bool = False) -> list[Array]:
        """(σ difference/2, τ, σ sum/2,) ε difference/2, γ/2, dilatation (, k u_x, k u_z), each (nz, nx)."""
        count = 3 if strains_only else 8
        out = np.zeros((count, z.size, x.size))
        for strip in self.strips:
            away = x - strip.centre
            away -= 2.0 * math.pi * np.round(away / (2.0 * math.pi))
            octave = np.floor(np.log2(np.maximum(np.abs(away) / (_NEAR * strip.alpha), 0.5)))
            for group in np.unique(octave):
                chosen = np.flatnonzero(octave == group)
                m, parts = self._coefficients(strip, away[chosen], z, strains_only=strains_only)
                for i in range(0, chosen.size, _CHUNK):
                    part = chosen[i : i + _CHUNK]
                    turn = np.multiply.outer(m, away[part])
                    fields = parts.real @ np.cos(turn) - parts.imag @ np.sin(turn)
                    out[:, :, part] += fields.reshape(count, z.size, part.size)
        return list(out)

    def _coefficients(
        self, strip: _Strip, away: Array, z: Array, *, strains_only: bool
    ) -> tuple[Array, ComplexArray]:
        """Wave numbers and the fields' amplitudes, shape (count · nz, k)."""
        distance = np.abs(away)
        gap, span = float(distance.min()) - strip.alpha, float(distance.max()) + strip.alpha
        end = _HARMONICS * self.points / strip.alpha
        if gap >= 0.5 * strip.alpha:
            end = min(end, _FAR / gap)
        m, weights = series_rule(_Unity(), _PLAIN, span=span, end=end)
        keep = m <= end
        m, window = m[keep], 0.5 * special.erfc((m[keep] / end - _MIDDLE) / _RAMP)
        wave = 2.0 * weights[keep].real * window * strip.amplitude(m)
        strained = self.scale * wave * self.problem.creep.compliance(m)
        D, T, H, U = self.shapes(m, z)
        bulk = 1.0 - 2.0 * self.nu
        parts = [strained * D, 1j * strained * T, 2.0 * bulk * strained * H]
        if not strains_only:
            # i m k u_x = ε_xx
            moved = strained / m
            parts = [wave * D, 1j * wave * T, wave * H, *parts, -1j * moved * (D + bulk * H), moved * U]
        return m, np.concatenate(parts)

    def dissipation(self, z: Array) -> tuple[Array, float]:
        """D R/F_N = ρ²/((1-ν) p̃_m) Σ m Im j 2 (D² + T² + (1-2ν) H²) |p̂_m|², shape (nz,); and its mean m."""
        low = min(s.centre - s.alpha for s in self.strips)
        high = max(s.centre + s.alpha for s in self.strips)
        end = _HARMONICS * self.points / min(s.alpha for s in self.strips)
        m, weights = series_rule(_Unity(), _PLAIN, span=high - low, end=end)
        waves = [s.amplitude(m) * np.exp(-1j * m * (s.centre - low)) for s in self.strips]
        loss = weights.real * np.abs(sum(waves)) ** 2 * self.problem.creep.compliance(m).imag
        D, T, H, _ = self.shapes(m, z)
        density = 2.0 * (D * D + T * T + (1.0 - 2.0 * self.nu) * H * H) @ (m * loss)
        density *= self.problem.rho**2 / ((1.0 - self.nu) * self.pressure)
        # over the whole depth a harmonic loses Im S |p̂|² (energy.py)
        lost = weights.real * np.abs(sum(waves)) ** 2 * self.layer.symbol(m, self.problem.creep).imag
        total = float(lost.sum())
        return density, math.exp(float(lost @ np.log(m)) / total) if total > 0.0 else 0.0


def _strips(solution: ContactSolution) -> list[_Strip]:
    """Sine coefficients of every strip's pressure, exact where the contact was solved spectrally."""
    terms = solution.stats.order or _GRID_TERMS
    angle = np.arange(1, terms + 1) * (math.pi / (terms + 1))
    out = []
    for low, high in solution.patches:
        centre, half = 0.5 * (low + high), 0.5 * (high - low)
        values = solution.pressure(centre + half * np.cos(angle))
        c = fft.dst(values, type=1) / (terms + 1)
        rho = solution.problem.rho
        out.append(_Strip(rho * centre, rho * half, np.asarray(c, dtype=np.float64)))
    return out


def _products(q: Array, t: Array) -> tuple[Array, Array, Array, Array]:
    """Four times C c, C s, S c, S s, each times e^{-(q+t)}."""
    high, low = 1.0 + np.exp(-2.0 * q), -np.expm1(-2.0 * q)
    up, down = 1.0 + np.exp(-2.0 * t), -np.expm1(-2.0 * t)
    return high * up, high * down, low * up, low * down


def _confined(q: Array, y: Array, t: Array, nu: float) -> Shapes:
    A, B, kappa = 2.0 * (1.0 - nu), 1.0 - 2.0 * nu, 3.0 - 4.0 * nu
    Cc, Cs, Sc, Ss = _products(q, t)
    once, twice = np.exp(-2.0 * q), np.exp(-2.0 * t)
    cosh_y, sinh_y = 2.0 * (twice + once), -2.0 * twice * np.expm1(-2.0 * y)
    unit = np.exp(-y) / (kappa * (1.0 + once) ** 2 + 4.0 * (B * B + q * q) * once)
    bent = A * B + q * t
    sum_ = A * Cc + B * Ss
    return (
        (bent * cosh_y + y * (B * Sc + A * Cs)) * unit,
        (y * sum_ - bent * sinh_y) * unit,
        -(sum_ + q * sinh_y) * unit,
        (kappa * (A * Cs + q * Ss) - t * sum_ - q * t * sinh_y) * unit,
    )


def _free(q: Array, y: Array, t: Array, nu: float) -> Shapes:
    A, B = 2.0 * (1.0 - nu), 1.0 - 2.0 * nu
    Cc, _, Sc, Ss = _products(q, t)
    once, twice = np.exp(-2.0 * q), np.exp(-2.0 * t)
    cosh_y, sinh_y = 2.0 * (twice + once), -2.0 * twice * np.expm1(-2.0 * y)
    # S² - q² = (S C + q)/L(q) without its cancellation
    unit = np.exp(-y) * free_symbol(q) / (-np.expm1(-4.0 * q) + 4.0 * q * once)
    spread = q * sinh_y - Ss
    return (
        (y * Sc - q * t * cosh_y) * unit,
        (y * Ss + q * t * sinh_y) * unit,
        spread * unit,
        (A * Sc + q * (A * Cc - B * Ss) + t * spread) * unit,
    )
