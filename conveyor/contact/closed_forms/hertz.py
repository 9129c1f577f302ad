"""Elastic oracles: Hertz' line contact on a half-space, the plate limit of a thin free layer.

Any coherent units. A modulus enters as the plane modulus E' = E/(1-ν²) = 2G/(1-ν).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.limits import require, require_not_negative, require_positive

Array = NDArray[np.float64]


def plane_modulus(shear_modulus: float, *, poisson: float) -> float:
    """Plane-strain modulus from the shear modulus, E' = E/(1-ν²) = 2G/(1-ν).

    Parameters
    ----------
    shear_modulus : float
        G [N/m²], positive.
    poisson : float
        ν [-], from 0 to 0.5.

    Returns
    -------
    float
        E' [N/m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(plane_modulus(571.5, poisson=0.4), 9)
    1905.0
    """
    require_positive(shear_modulus=shear_modulus)
    require(0.0 <= poisson <= 0.5, "poisson", poisson, ">= 0 and <= 0.5")
    return 2.0 * shear_modulus / (1.0 - poisson)


def composite_plane_modulus(*plane_moduli: float) -> float:
    """Plane modulus of a pair of bodies: compliances add, 1/E* = Σ (1-ν_i²)/E_i.

    Parameters
    ----------
    *plane_moduli : float
        E'_i of each deformable body [N/m²], positive. A rigid body is left out.

    Returns
    -------
    float
        E* [N/m²].

    Raises
    ------
    InputError
        No body, or a modulus is not positive.

    Examples
    --------
    >>> composite_plane_modulus(1905.0, 1905.0)
    952.5
    """
    require(len(plane_moduli) > 0, "plane_moduli", plane_moduli, "at least one deformable body")
    for modulus in plane_moduli:
        require_positive(plane_modulus=modulus)
    return 1.0 / math.fsum(1.0 / modulus for modulus in plane_moduli)


def hertz_half_width(load: float, *, radius: float, plane_modulus: float) -> float:
    """Half-width of a line contact, a = sqrt(4 P R/(π E')) (Hertz).

    Parameters
    ----------
    load : float
        P per width [N/m], at least 0.
    radius : float
        R of the cylinder, or of the equivalent one, 1/R = 1/R1 + 1/R2 [m], positive.
    plane_modulus : float
        E' [N/m²], positive.

    Returns
    -------
    float
        a [m].

    Raises
    ------
    InputError
        An argument is outside its range.

    Notes
    -----
    a ≪ R: a parabola stands for the circle.

    Examples
    --------
    >>> round(hertz_half_width(600.0, radius=50.0, plane_modulus=952.5), 4)
    6.3326
    """
    require_not_negative(load=load)
    require_positive(radius=radius, plane_modulus=plane_modulus)
    return math.sqrt(4.0 * load * radius / (math.pi * plane_modulus))


def hertz_peak_pressure(half_width: float, *, radius: float, plane_modulus: float) -> float:
    """Peak pressure of a line contact, p0 = E' a/(2R) (Hertz).

    Parameters
    ----------
    half_width : float
        a [m], at least 0.
    radius : float
        R [m], positive.
    plane_modulus : float
        E' [N/m²], positive.

    Returns
    -------
    float
        p0 [N/m²].

    Raises
    ------
    InputError
        An argument is outside its range.

    Examples
    --------
    >>> round(hertz_peak_pressure(6.33262, radius=50.0, plane_modulus=952.5), 2)
    60.32
    """
    require_not_negative(half_width=half_width)
    require_positive(radius=radius, plane_modulus=plane_modulus)
    return plane_modulus * half_width / (2.0 * radius)


def plate_symbol(q: Array) -> Array:
    """Long-wave limit of the free layer's symbol, L(q) → 6/q³: a Kirchhoff plate.

    Parameters
    ----------
    q : ndarray, shape (...,)
        |m| k h [-], positive, small.

    Returns
    -------
    ndarray, shape (...,)
        6/q³ [-].

    Raises
    ------
    InputError
        A q is not positive.

    Notes
    -----
    A plate of stiffness D = E h³/(12(1-ν²)) under p cos κx deflects by p/(D κ⁴), and L = κ u E/(2(1-ν²) p).
    The free layer's symbol is larger by the relative amount q²/5 + O(q⁴).

    Examples
    --------
    >>> plate_symbol(np.array([0.1, 1.0])).round(9).tolist()
    [6000.0, 6.0]
    """
    require(bool(np.all(q > 0.0)), "q", q, "> 0")
    return 6.0 / q**3
