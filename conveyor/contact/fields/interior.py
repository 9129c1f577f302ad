"""Stress, strain and dissipation inside the layer of a solved contact.

The harmonics p̂_m e^{imX} of the pressure travel with the roll: at a constant Poisson's ratio the stresses are the
elastic ones of layer_shapes.py and the strains follow by the correspondence principle, ε̂_m = j(m) σ̂_m ρ/(2(1-ν))
(E0/(1+ν) is 2G; p̃ holds E0 k R/(2(1-ν²)), see problem.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.limits import require, require_count
from conveyor.contact.fields.interior_harmonics import InteriorHarmonics
from conveyor.contact.solution import ContactSolution
from conveyor.errors import InputError, NoSolutionError

Array = NDArray[np.float64]

_FEWEST_DEPTHS, _FEWEST_POINTS = 4, 12
_COARSENING = 0.6


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
    """Strain amplitude and dissipation of the particles at each depth as the roll passes.

    Attributes
    ----------
    depth : ndarray, shape (nz,)
        z/R [-] below the loaded surface: the surface, Gauss nodes, the far face (a half-space has none).
    weights : ndarray, shape (nz,)
        Quadrature weights over z/R [-]; zero at the faces.
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
            raise NoSolutionError("relative_depth: a half-space has no thickness; use depth, in units of the radius")
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
            raise NoSolutionError("working_strain: an elastic layer dissipates nothing to weight with; use maximum")
        return float((self.weights * self.amplitude) @ self.dissipation) / self.friction

    @property
    def maximum(self) -> float:
        """Largest strain amplitude of all depths, faces included [-]."""
        return float(self.amplitude.max())

    @cached_property
    def error_estimate(self) -> float:
        """Estimated relative error of the working strain, of the maximum where the layer is elastic [-].

        Sum of the changes by 0.6 of the depths, and by 0.6 of the places and wave numbers.
        """
        name = "working_strain" if self.dissipation.any() else "maximum"
        nodes = int(np.count_nonzero(self.weights))
        fewer = (
            _depth_profile(self._solution, int(_COARSENING * nodes), self._points),
            _depth_profile(self._solution, nodes, int(_COARSENING * self._points)),
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
        `depths` or `points` too small, or a Layer of the user's own: its symbol does not define its interior.
    NoSolutionError
        The solution holds no contact.

    Notes
    -----
    The amplitude compares with the single strain amplitude of a dynamic test. A particle runs through a
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
    require(isinstance(solution, ContactSolution), "solution", solution, "a ContactSolution")
    for name, value, least in (("depths", depths, _FEWEST_DEPTHS), ("points", points, _FEWEST_POINTS)):
        require_count(least, **{name: value})
    return _depth_profile(solution, int(depths), int(points))


def interior_fields(solution: ContactSolution, x: ArrayLike, depth: ArrayLike, *, points: int = 48) -> InteriorFields:
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
        Without the means over a period: the harmonics start at m = 1.

    Raises
    ------
    InputError
        A depth outside the layer, `points` too small, or a Layer of the user's own.
    NoSolutionError
        The solution holds no contact.

    Notes
    -----
    The window blurs over R α/(ρ `points`): valid below that depth, and at the surface away from the edges.
    """
    require(isinstance(solution, ContactSolution), "solution", solution, "a ContactSolution")
    require_count(_FEWEST_POINTS, points=points)
    problem, inside = solution.problem, InteriorHarmonics(solution, points)
    try:
        at, z = (np.atleast_1d(np.asarray(given, dtype=float)) for given in (x, depth))
    except (TypeError, ValueError):
        raise InputError(f"x, depth: numbers are needed, not {x!r}, {depth!r}") from None
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
    distance = path @ path.swapaxes(1, 2)
    distance *= -2.0
    distance += square[:, :, None]
    distance += square[:, None, :]
    out: Array = 0.5 * np.sqrt(np.maximum(distance.max(axis=(1, 2)), 0.0))
    return out


def _depth_profile(solution: ContactSolution, depths: int, points: int) -> Interior:
    inside, rho = InteriorHarmonics(solution, points), solution.problem.rho
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
