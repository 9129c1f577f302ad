"""Numbers and arrays with a unit: refused by place, value and what is allowed; spectra sorted and read-only."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.errors import InputError

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def require_all(ok: ArrayLike, name: str, values: FloatArray, *, unit: str, limit: str = "", advice: str = "") -> None:
    """Refuse the first number [unit] that is not `ok`, with its place; `limit` is "> 0", ">= 0" or empty."""
    bad = np.argwhere(~np.atleast_1d(ok))
    if bad.size:
        place = tuple(bad[0]) if values.ndim else ()
        shown = "" if unit == "-" else f" {unit}"
        where = name + "".join(f"[{i}]" for i in place)
        allowed = f"{limit}{shown} and finite" if limit else "finite numbers"
        raise InputError(f"{where}: got {values[place]:g}{shown}, allowed: {allowed}{advice}")


def positive_number(name: str, value: float, unit: str, advice: str = "") -> float:
    """Number, refused unless finite and > 0."""
    number = float(value)
    require_all(0.0 < number < math.inf, name, np.array(number), unit=unit, limit="> 0", advice=advice)
    return number


def finite_vector(name: str, values: ArrayLike, unit: str, limit: str = "") -> FloatArray:
    """Copy of a one-dimensional array, refused unless finite."""
    array = np.array(values, dtype=np.float64)
    if array.ndim != 1:
        raise InputError(f"{name} must be one-dimensional, shape (n,); got shape {array.shape}")
    require_all(np.isfinite(array), name, array, unit=unit, limit=limit)
    return array


def positive_vector(name: str, values: ArrayLike, unit: str) -> FloatArray:
    """Copy of a one-dimensional array, refused unless finite and > 0."""
    array = finite_vector(name, values, unit, "> 0")
    require_all(array > 0.0, name, array, unit=unit, limit="> 0")
    return array


def non_negative_array(name: str, values: ArrayLike, unit: str) -> FloatArray:
    """Numbers of any shape, refused unless finite and >= 0."""
    array = np.asarray(values, dtype=np.float64)
    require_all(np.isfinite(array) & (array >= 0.0), name, array, unit=unit, limit=">= 0")
    return array


def sorted_spectrum(weight_name: str, weights: ArrayLike, unit: str, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Weights and times [s] of a discrete spectrum, checked, by ascending time, read-only."""
    w, t = np.array(weights, dtype=np.float64), np.array(times, dtype=np.float64)
    if not _is_ascending_spectrum(w, t):
        w, t = _sort_spectrum(weight_name, weights, unit, times)
    w.setflags(write=False)
    t.setflags(write=False)
    return w, t


def _is_ascending_spectrum(w: FloatArray, t: FloatArray) -> bool:
    """True for a valid spectrum by ascending time, as most are."""
    return (
        w.ndim == 1
        and w.shape == t.shape
        and w.size > 0
        and t.item(0) > 0.0
        and t.item(-1) < math.inf
        and bool((t[1:] > t[:-1]).all())
        and 0.0 < w.min() <= w.max() < math.inf
    )


def _sort_spectrum(weight_name: str, weights: ArrayLike, unit: str, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Check a spectrum and sort it by time."""
    w = positive_vector(weight_name, weights, unit)
    t = positive_vector("times", times, "s")
    if w.shape != t.shape:
        raise InputError(f"{weight_name} and times must have one length; got {w.size} and {t.size}")
    order = np.argsort(t, kind="stable")
    w, t = w[order], t[order]
    equal = np.flatnonzero(np.diff(t) == 0.0)
    if equal.size:
        raise InputError(f"times must be distinct; {t[equal[0]]:g} s occurs twice: add its {weight_name} into one term")
    return w, t
