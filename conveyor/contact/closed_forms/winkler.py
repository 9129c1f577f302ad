"""Viscoelastic oracle on a Winkler foundation: a cover of independent columns with a Maxwell spectrum.

Sources: Lodewijks (1995); Rudolphi & Reicks (2006), the generalised Maxwell form; Jonkers (1980), small loss.
Any coherent units. With the depth d = a - x behind the entry, u_i = d/k_i and k_i = V τ_i (τ_i relaxation
times), σ R h = E_e (a d - d²/2) + Σ E_i [a d g1(u_i) - (d²/2) g2(u_i)], where
g_m(u) = m ∫_0^1 (1-t)^(m-1) exp(-u t) dt runs from 1 (glassy) to 0 (relaxed): the sources' formula without
its differences.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from conveyor.arguments.limits import require, require_positive

Array = NDArray[np.float64]

JONKERS_FACTOR: Final[float] = (math.pi / 2.0) * (math.pi / 4.0) ** (4.0 / 3.0)  # [-], Jonkers (1980)
_SERIES_TERMS: Final = 18  # 1/18! is below rounding for u < 1
_GAUSS: Final = 24  # points per panel: exact to rounding for exp(-2u) over a doubling of u
_DECAY_LENGTHS: Final = 64.0  # exp(-64) is below rounding beside what remains of the history
_TOLERANCE: Final = 1e-15  # of the roots, relative


def _memory_functions(u: Array) -> tuple[Array, Array, Array]:
    """g1, g2, g3 of the module's docstring, accurate for every u ≥ 0."""
    small = np.minimum(u, 1.0)
    s1, s2, s3 = np.ones_like(u), np.ones_like(u), np.ones_like(u)
    for j in range(_SERIES_TERMS, 0, -1):  # Σ_j (-u)^j m!/(j+m)!, Horner
        s1 = 1.0 - small / (j + 1) * s1
        s2 = 1.0 - small / (j + 2) * s2
        s3 = 1.0 - small / (j + 3) * s3
    large = np.maximum(u, 1.0)
    c1 = -np.expm1(-large) / large
    c2 = 2.0 * (1.0 - c1) / large
    c3 = 3.0 * (1.0 - c2) / large
    near = u < 1.0
    return np.where(near, s1, c1), np.where(near, s2, c2), np.where(near, s3, c3)


def _stress_history(depth: Array, memory: Array) -> Array:
    """Stress of one element over E_i/(R h), a d g1(d/k) - (d²/2) g2(d/k) with a = 1."""
    g1, g2, _ = _memory_functions(depth / memory)
    history: Array = depth * g1 - depth**2 / 2.0 * g2
    return history


def _dissipated_energy(memory: Array, depth: float) -> Array:
    """(1/k) ∫_0^depth stress² dd of each element with a = 1: every term positive."""
    doublings = 2.0 ** np.arange(math.log2(_DECAY_LENGTHS) + 1.0)
    start = np.minimum(memory, depth)[:, None]
    edges = np.concatenate(
        (np.zeros_like(start), np.minimum(start * doublings, depth), np.full_like(start, depth)), axis=1
    )
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
    half = np.diff(edges, axis=1)[:, :, None] / 2.0
    stress = _stress_history(edges[:, :-1, None] + half * (nodes + 1.0), memory[:, None, None])
    integral: Array = ((half * stress**2) @ weights).sum(axis=1)
    return integral / memory


@dataclass(frozen=True, slots=True)
class WinklerContact:
    """Rolling contact on a Winkler foundation.

    Parameters
    ----------
    entry : float
        a, from the cylinder axis to the entry [m].
    exit : float
        b, from the cylinder axis to the exit [m].
    load : float
        W per width [N/m].
    resistance : float
        F per width [N/m].
    """

    entry: float
    exit: float
    load: float
    resistance: float

    @property
    def friction(self) -> float:
        """Resistance over load, f [-]."""
        return self.resistance / self.load


def _active_elements(equilibrium: float, moduli: Array, memories: Array) -> tuple[Array, Array]:
    """Moduli and memories of the elements that carry stress, checked: a memory of 0 is relaxed everywhere."""
    require_positive(equilibrium=equilibrium)
    ok = moduli.ndim == 1 and bool(np.all((moduli >= 0.0) & np.isfinite(moduli)))
    require(ok, "moduli", moduli, ">= 0 and finite, shape (n,)")
    ok = memories.shape == moduli.shape and bool(np.all(memories >= 0.0))
    require(ok, "memories", memories, ">= 0, one for each modulus")
    active = memories > 0.0
    return moduli[active], memories[active]


def winkler_pressure(
    x: Array,
    *,
    equilibrium: float,
    moduli: Array,
    memories: Array,
    entry: float,
    radius: float,
    thickness: float,
) -> Array:
    """Contact pressure σ(x) on a generalised Maxwell foundation (Lodewijks 1995; Rudolphi & Reicks 2006).

    σ = E_e (a² - x²)/(2 R h) + Σ (E_i k_i/(R h)) [(x + k_i) - (a + k_i) exp(-(a - x)/k_i)].

    Parameters
    ----------
    x : ndarray, shape (m,)
        Position ahead of the cylinder axis [m], at most a.
    equilibrium : float
        E_e [N/m²], positive.
    moduli : ndarray, shape (n,)
        E_i [N/m²], at least 0.
    memories : ndarray, shape (n,)
        k_i = V τ_i [m], at least 0, inf allowed.
    entry : float
        a [m], positive.
    radius : float
        R [m], positive.
    thickness : float
        h [m], positive.

    Returns
    -------
    ndarray, shape (m,)
        σ [N/m²]; negative behind the exit.

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> glassy = winkler_pressure(
    ...     np.array([0.0]),
    ...     equilibrium=1.0,
    ...     moduli=np.array([3.0]),
    ...     memories=np.array([math.inf]),
    ...     entry=1.0,
    ...     radius=1.0,
    ...     thickness=1.0,
    ... )
    >>> glassy.tolist()
    [2.0]
    """
    moduli, memories = _active_elements(equilibrium, moduli, memories)
    require_positive(entry=entry, radius=radius, thickness=thickness)
    require(bool(np.all(x <= entry)), "x", x, f"<= entry = {entry!r} m")
    depth = 1.0 - x / entry
    history = _stress_history(depth[:, None], memories / entry)
    shape = equilibrium * (depth - depth**2 / 2.0) + history @ moduli
    return entry**2 / (radius * thickness) * shape


def winkler(
    *, equilibrium: float, moduli: Array, memories: Array, entry: float, radius: float, thickness: float
) -> WinklerContact:
    """Solve the rolling contact for a given entry (Lodewijks 1995; Rudolphi & Reicks 2006).

    The exit is where σ = 0; W = ∫ σ dx, F = ∫ σ x dx/R.

    Parameters
    ----------
    equilibrium : float
        E_e [N/m²], positive.
    moduli : ndarray, shape (n,)
        E_i [N/m²], at least 0.
    memories : ndarray, shape (n,)
        k_i = V τ_i with τ_i the relaxation times [m], at least 0, inf allowed (both lossless).
    entry : float
        a [m], positive.
    radius : float
        R [m], positive.
    thickness : float
        h of the cover [m], positive.

    Returns
    -------
    WinklerContact
        Exit, load, resistance.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Independent columns, parabola for the circle: a ≪ R. F is summed as what the columns dissipate and what
    they still store when they leave, Σ ∫ σ_i² h dx/(E_i k_i) + h Σ σ_i²/(2 E_i) + h σ_e²/(2 E_e), which
    equals ∫ σ x dx/R and keeps its digits when the loss is small.

    Examples
    --------
    >>> c = winkler(
    ...     equilibrium=1.0,
    ...     moduli=np.array([1.0]),
    ...     memories=np.array([1.0]),
    ...     entry=1.0,
    ...     radius=1.0,
    ...     thickness=1.0,
    ... )
    >>> round(c.exit, 8), round(c.load, 8), round(c.friction, 8)
    (0.83312517, 0.95942002, 0.10887526)
    """
    moduli, memories = _active_elements(equilibrium, moduli, memories)
    require_positive(entry=entry, radius=radius, thickness=thickness)
    memory = memories / entry

    def stress_over_depth(depth: float) -> float:
        g1, g2, _ = _memory_functions(depth / memory)
        return equilibrium * (1.0 - depth / 2.0) + float((g1 - depth / 2.0 * g2) @ moduli)

    # σ > 0 at the axis and σ ≤ 0 at x = -a, for every spectrum
    depth = float(brentq(stress_over_depth, 1.0, 2.0, xtol=_TOLERANCE, rtol=4.0 * _TOLERANCE))
    _, g2, g3 = _memory_functions(depth / memory)
    square, cube = depth**2 / 2.0, depth**3 / 6.0
    load = equilibrium * (square - cube) + float((square * g2 - cube * g3) @ moduli)
    stored = _stress_history(np.full_like(memory, depth), memory) ** 2 / 2.0
    rubbery = (depth - depth**2 / 2.0) ** 2 / 2.0
    loss = equilibrium * rubbery + float((stored + _dissipated_energy(memory, depth)) @ moduli)
    scale = entry**3 / (radius * thickness)
    return WinklerContact(
        entry=entry,
        exit=(depth - 1.0) * entry,
        load=scale * load,
        resistance=scale * entry / radius * loss,
    )


def winkler_at_load(
    load: float, *, equilibrium: float, moduli: Array, memories: Array, radius: float, thickness: float
) -> WinklerContact:
    """Solve the rolling contact for a given load (Lodewijks 1995; Rudolphi & Reicks 2006).

    Parameters
    ----------
    load : float
        W per width [N/m], positive.
    equilibrium : float
        E_e [N/m²], positive.
    moduli : ndarray, shape (n,)
        E_i [N/m²], at least 0.
    memories : ndarray, shape (n,)
        k_i = V τ_i [m], at least 0, inf allowed.
    radius : float
        R [m], positive.
    thickness : float
        h [m], positive.

    Returns
    -------
    WinklerContact
        Entry, exit, resistance.

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    E_e a³/3 ≤ W R h ≤ (E_e + Σ E_i) 2a³/3 brackets a.

    Examples
    --------
    >>> c = winkler_at_load(
    ...     0.95942002,
    ...     equilibrium=1.0,
    ...     moduli=np.array([1.0]),
    ...     memories=np.array([1.0]),
    ...     radius=1.0,
    ...     thickness=1.0,
    ... )
    >>> round(c.entry, 7)
    1.0
    """
    _active_elements(equilibrium, moduli, memories)
    require_positive(load=load, radius=radius, thickness=thickness)

    def contact(log_entry: float) -> WinklerContact:
        return winkler(
            equilibrium=equilibrium,
            moduli=moduli,
            memories=memories,
            entry=math.exp(log_entry),
            radius=radius,
            thickness=thickness,
        )

    volume = 3.0 * load * radius * thickness
    glassy = math.log(volume / (2.0 * (equilibrium + float(moduli.sum())))) / 3.0
    rubbery = math.log(volume / equilibrium) / 3.0
    # one unit of ln beyond the bracket: rounding must not spoil its signs
    root = brentq(
        lambda log_entry: math.log(contact(log_entry).load / load),
        glassy - 1.0,
        rubbery + 1.0,
        xtol=_TOLERANCE,
    )
    return contact(root)


def jonkers_friction(load: float, *, thickness: float, storage: float, diameter: float, tan_delta: float) -> float:
    """Indentation friction at small loss, f = (π/2) (π/4)^(4/3) tan δ (W h/(E' D²))^(1/3) (Jonkers 1980).

    Parameters
    ----------
    load : float
        W per width [N/m], at least 0.
    thickness : float
        h of the cover [m], positive.
    storage : float
        E' at the frequency of the contact [N/m²], positive.
    diameter : float
        D of the roll [m], positive.
    tan_delta : float
        Loss factor at that frequency [-], at least 0.

    Returns
    -------
    float
        f [-].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    Half-sine of pressure, small loss: tan δ ≪ 1.

    Examples
    --------
    >>> round(jonkers_friction(1.0, thickness=1.0, storage=1.0, diameter=1.0, tan_delta=1.0), 6)
    1.138255
    """
    require(0.0 <= load < math.inf, "load", load, ">= 0 and finite")
    require(0.0 <= tan_delta < math.inf, "tan_delta", tan_delta, ">= 0 and finite")
    require_positive(thickness=thickness, storage=storage, diameter=diameter)
    return JONKERS_FACTOR * tan_delta * math.cbrt(load * thickness / (storage * diameter**2))
