"""Checked input: numbers and arrays that are finite, inside their range, and read-only afterwards."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.errors import InputError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def positive(name: str, value: float, unit: str, advice: str = "") -> float:
    """Refuse a number that is not finite and > 0.

    Parameters
    ----------
    name : str
        Name shown in the message [-].
    value : float
        The number to check [unit].
    unit : str
        Its unit, shown in the message [-].
    advice : str
        What to do instead, appended to the message [-].

    Returns
    -------
    float
        `value` as a plain float [unit].

    Raises
    ------
    InputError
        If `value` is not finite or not > 0.
    """
    number = float(value)
    if not (math.isfinite(number) and number > 0.0):
        raise InputError(f"{name} = {number:g} {unit} must be finite and > 0{advice}")
    return number


def finite_vector(name: str, values: ArrayLike, unit: str) -> FloatArray:
    """Copy a one-dimensional array and refuse entries that are not finite.

    Parameters
    ----------
    name : str
        Name shown in the message [-].
    values : array_like
        Shape `(n,)` [unit].
    unit : str
        Unit shown in the message [-].

    Returns
    -------
    numpy.ndarray
        A copy, shape `(n,)` [unit].

    Raises
    ------
    InputError
        If the shape is not `(n,)` or an entry is not finite.
    """
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1:
        raise InputError(f"{name} must be one-dimensional, shape (n,); got shape {array.shape}")
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        raise InputError(f"{name}[{bad[0]}] = {array[bad[0]]:g} {unit} must be finite")
    return array


def positive_vector(name: str, values: ArrayLike, unit: str) -> FloatArray:
    """Copy a one-dimensional array and refuse entries that are not finite and > 0.

    Parameters
    ----------
    name : str
        Name shown in the message [-].
    values : array_like
        Shape `(n,)` [unit].
    unit : str
        Unit shown in the message [-].

    Returns
    -------
    numpy.ndarray
        A copy, shape `(n,)` [unit].

    Raises
    ------
    InputError
        If the shape is not `(n,)` or an entry is not finite and > 0.
    """
    array = finite_vector(name, values, unit)
    bad = np.flatnonzero(array <= 0.0)
    if bad.size:
        raise InputError(f"{name}[{bad[0]}] = {array[bad[0]]:g} {unit} must be > 0")
    return array


def non_negative(name: str, values: ArrayLike, unit: str) -> FloatArray:
    """Refuse anything but finite numbers >= 0, of any shape.

    Parameters
    ----------
    name : str
        Name shown in the message [-].
    values : array_like
        Any shape [unit].
    unit : str
        Unit shown in the message [-].

    Returns
    -------
    numpy.ndarray
        The values, same shape [unit].

    Raises
    ------
    InputError
        If an entry is negative or not finite.
    """
    array = np.asarray(values, dtype=np.float64)
    bad = array[~(np.isfinite(array) & (array >= 0.0))]
    if bad.size:
        raise InputError(f"{name} = {bad.flat[0]:g} {unit} must be finite and >= 0")
    return array


def spectrum(
    weight_name: str, weights: ArrayLike, unit: str, times: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Check and sort the lines of a discrete spectrum.

    Parameters
    ----------
    weight_name : str
        Name of the weights in messages [-].
    weights : array_like
        Moduli or compliances, shape `(n,)`, > 0 [unit].
    unit : str
        Their unit [-].
    times : array_like
        Distinct times, shape `(n,)`, > 0 [s].

    Returns
    -------
    tuple of numpy.ndarray
        Weights [unit] and times [s] in ascending order of time, read-only, shape `(n,)`.

    Raises
    ------
    InputError
        If shapes differ, an entry is not finite and > 0, or two times are equal.
    """
    w = positive_vector(weight_name, weights, unit)
    t = positive_vector("times", times, "s")
    if w.shape != t.shape:
        raise InputError(f"{weight_name} and times must have one length; got {w.size} and {t.size}")
    order = np.argsort(t, kind="stable")
    w, t = w[order], t[order]
    equal = np.flatnonzero(np.diff(t) == 0.0)
    if equal.size:
        raise InputError(
            f"times must be distinct; {t[equal[0]]:g} s occurs twice: add its {weight_name} into one term"
        )
    w.setflags(write=False)
    t.setflags(write=False)
    return w, t
