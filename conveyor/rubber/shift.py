"""Time-temperature superposition: the factor a_T that multiplies all times when the temperature changes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from conveyor.arguments.arrays import FloatArray, finite_vector, positive_number, positive_vector, require_all
from conveyor.errors import InputError, MessageQuantity, RangeError
from conveyor.rubber.monotone import MonotoneCubic
from conveyor.rubber.prony import PronySeries

GAS_CONSTANT = 8.31446261815324
"""N_A k_B, exact since 2019 (SI Brochure, 9th edition, table 1) [J/(mol K)]."""
_ZERO_CELSIUS = 273.15  # [K], SI Brochure, 2.3.1
REFERENCE_TOLERANCE = 0.01
"""Decades by which a table may miss log10 a_T = 0 at its reference: tables are printed to 2-3 decimals,
and 0.01 decade is about 0.1 K for a rubber."""
MAX_DECADES = 100.0
"""No measured shift comes near; beyond it times leave the range of double precision."""


def celsius_in_message(temperature: float) -> MessageQuantity:
    """Temperature [K] for a message."""
    return MessageQuantity(temperature, "temperature", f"{temperature - _ZERO_CELSIUS:.2f} degC", digits=6)


def _check_kelvin(temperature: ArrayLike) -> FloatArray:
    """Refuse a temperature [K] that is not finite and > 0."""
    array = np.asarray(temperature, dtype=np.float64)
    ok = np.isfinite(array) & (array > 0.0)
    require_all(ok, "temperature", array, unit="K", limit="> 0", advice=" (this floor counts in kelvin)")
    return array


class ShiftLaw(Protocol):
    """Shift law: a reference temperature [K] and log10 a_T [-] at any other."""

    @property
    def reference(self) -> float:
        """Temperature at which a_T = 1 [K]."""

    def log10_a_T(self, temperature: ArrayLike) -> FloatArray:  # noqa: N802
        """Shift in decades, positive when colder than the reference.

        Parameters
        ----------
        temperature : array_like
            Absolute temperature, any shape [K].

        Returns
        -------
        numpy.ndarray
            log10 a_T, shape of `temperature` [-].

        Raises
        ------
        RangeError
            Where the law is not known.
        InputError
            If a temperature is not finite and > 0.
        """


@dataclass(frozen=True)
class WLF:
    """Williams-Landel-Ferry law ``log10 a_T = -c1 (T - T_ref)/(c2 + T - T_ref)``.

    Parameters
    ----------
    c1 : float
        First coefficient, for the given reference, > 0 [-].
    c2 : float
        Second coefficient, for the given reference, > 0 [K].
    reference : float
        Absolute reference temperature, a_T = 1 [K].

    Raises
    ------
    InputError
        If a number is not finite and > 0.

    Notes
    -----
    Holds from the glass transition T_g to about T_g + 100 K; below T_g it overestimates the shift. The pole
    T_ref - c2 lies some 50 K below T_g: at and below it the law has no meaning and is refused.

    References
    ----------
    M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701-3707, Eq. (1).

    Examples
    --------
    >>> round(float(WLF(c1=8.86, c2=101.6, reference=293.15).log10_a_T(293.15 + 101.6)), 9)
    -4.43
    """

    c1: float
    c2: float
    reference: float

    def __post_init__(self) -> None:
        """Check."""
        positive_number("c1", self.c1, "-")
        positive_number("c2", self.c2, "K")
        positive_number("reference", self.reference, "K")

    def log10_a_T(self, temperature: ArrayLike) -> FloatArray:  # noqa: N802
        """As `ShiftLaw`; at or below the pole ``reference - c2`` there is none (RangeError)."""
        difference = _check_kelvin(temperature) - self.reference
        if np.any(difference <= -self.c2):
            coldest, pole = self.reference + float(difference.min()), self.reference - self.c2
            raise RangeError(
                "temperature {} is at or below the pole of the WLF law at {}; it holds only well above that: use a "
                "shift table or Arrhenius",
                celsius_in_message(coldest),
                celsius_in_message(pole),
            )
        return np.asarray(-self.c1 * difference / (self.c2 + difference))[()]


@dataclass(frozen=True)
class Arrhenius:
    """Arrhenius law ``log10 a_T = E_a/(R ln 10) (1/T - 1/T_ref)``.

    Parameters
    ----------
    activation_energy : float
        Apparent activation energy E_a, > 0 [J/mol].
    reference : float
        Absolute reference temperature, a_T = 1 [K].

    Raises
    ------
    InputError
        If a number is not finite and > 0.

    Notes
    -----
    For glasses, or far (> 100 K) above the glass transition; between the two WLF or a table fits better.

    References
    ----------
    J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 11.

    Examples
    --------
    >>> round(float(Arrhenius(activation_energy=120e3, reference=293.15).log10_a_T(283.15)), 3)
    0.755
    """

    activation_energy: float
    reference: float

    def __post_init__(self) -> None:
        """Check."""
        positive_number("activation_energy", self.activation_energy, "J/mol")
        positive_number("reference", self.reference, "K")

    def log10_a_T(self, temperature: ArrayLike) -> FloatArray:  # noqa: N802
        """As `ShiftLaw`."""
        t = _check_kelvin(temperature)
        slope = self.activation_energy / (GAS_CONSTANT * math.log(10.0))
        return np.asarray(slope * (self.reference - t) / (t * self.reference))[()]


@dataclass(frozen=True, eq=False)
class ShiftTable:
    """Measured shifts, interpolated monotonically (PCHIP) and never extrapolated.

    Parameters
    ----------
    temperatures : array_like
        Absolute temperatures, shape `(n,)`, n >= 2, distinct, any order [K].
    log10_factors : array_like
        log10 a_T at them, shape `(n,)`, falling with rising temperature [-].
    reference : float
        Absolute reference temperature inside the table, where log10 a_T = 0 [K].

    Raises
    ------
    InputError
        If the table is too short, not finite, repeats a temperature, does not fall with rising temperature,
        or is not 0 at its reference (to 0.01 decade).

    References
    ----------
    F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238-246 (monotone cubic interpolation).

    Examples
    --------
    >>> table = ShiftTable([283.15, 293.15, 303.15], [1.1, 0.0, -1.0], reference=293.15)
    >>> table.log10_a_T([283.15, 303.15])
    array([ 1.1, -1. ])
    """

    temperatures: FloatArray
    log10_factors: FloatArray
    reference: float
    _curve: MonotoneCubic = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Check, sort, freeze."""
        t = positive_vector("temperatures", self.temperatures, "K")
        y = finite_vector("log10_factors", self.log10_factors, "decades")
        if t.shape != y.shape or t.size < 2:
            raise InputError(
                f"a shift table needs >= 2 temperatures and one log10 a_T for each; got {t.size} and {y.size}"
            )
        order = np.argsort(t, kind="stable")
        t, y = t[order], y[order]
        if np.any(np.diff(t) == 0.0):
            repeated = float(t[:-1][np.diff(t) == 0.0][0])
            raise InputError(
                f"temperatures of a shift table must be distinct; {celsius_in_message(repeated)} occurs twice"
            )
        rising = np.flatnonzero(np.diff(y) >= 0.0)
        if rising.size:
            i = int(rising[0])
            raise InputError(
                f"log10 a_T must fall with rising temperature; it goes from {y[i]:g} at {celsius_in_message(t[i])}"
                f" to {y[i + 1]:g} at {celsius_in_message(t[i + 1])} (reversed sign, or log of 1/a_T?)"
            )
        for array in (t, y):
            array.setflags(write=False)
        object.__setattr__(self, "temperatures", t)
        object.__setattr__(self, "log10_factors", y)
        object.__setattr__(self, "_curve", MonotoneCubic(t, y))
        at_reference = float(self.log10_a_T(positive_number("reference", self.reference, "K")))
        if abs(at_reference) > REFERENCE_TOLERANCE:
            raise InputError(
                f"log10 a_T at the reference {celsius_in_message(self.reference)} is {at_reference:.4f};"
                f" it must be 0 to {REFERENCE_TOLERANCE} decade: state the temperature at which a_T = 1"
            )

    def log10_a_T(self, temperature: ArrayLike) -> FloatArray:  # noqa: N802
        """As `ShiftLaw`; outside the table there is none (RangeError)."""
        t = _check_kelvin(temperature)
        low, high = float(self.temperatures[0]), float(self.temperatures[-1])
        outside = t[(t < low) | (t > high)]
        if outside.size:
            raise RangeError(
                "temperature {} is outside the shift table, {} to {}; it is not extrapolated: extend the measurement, "
                "or choose a WLF or Arrhenius law knowingly",
                *map(celsius_in_message, (float(outside.flat[0]), low, high)),
            )
        return np.asarray(self._curve(t))[()]


def entropic_b_T(temperature: float, reference: float) -> float:  # noqa: N802
    """Vertical shift of an ideal (entropic) rubber network, ``b_T = T/T_ref`` (density change neglected).

    Parameters
    ----------
    temperature : float
        Absolute temperature [K].
    reference : float
        Absolute reference temperature [K].

    Returns
    -------
    float
        Factor on all moduli [-].

    Raises
    ------
    InputError
        If a temperature is not finite and > 0.

    Notes
    -----
    Right for unfilled networks on the rubbery plateau; carbon-black filled rubber softens when heated, so
    the default everywhere is b_T = 1, which is also how the shelf's master curves were published. Without it E' and E''
    of those contradict each other by 9 and 7 %, with it by 6 and 3 %, least at powers of T/T_ref of 1.25 (derived).

    References
    ----------
    J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 11, Eq. (4).

    Examples
    --------
    >>> entropic_b_T(330.0, reference=300.0)
    1.1
    """
    return positive_number("temperature", temperature, "K") / positive_number("reference", reference, "K")


def shift_series(series: PronySeries, law: ShiftLaw, temperature: float, *, b_T: float = 1.0) -> PronySeries:
    """Series at another temperature: every relaxation time times a_T, every modulus times b_T.

    Parameters
    ----------
    series : PronySeries
        The series at the reference temperature of `law` [Pa, s].
    law : ShiftLaw
        `WLF`, `Arrhenius` or `ShiftTable` [-].
    temperature : float
        Absolute temperature wanted [K].
    b_T : float
        Vertical shift, see `entropic_b_T` [-].

    Returns
    -------
    PronySeries
        The series at `temperature`.

    Raises
    ------
    RangeError
        Where `law` does not hold, or if the shift is above 100 decades.
    InputError
        If a temperature or `b_T` is not finite and > 0.

    Notes
    -----
    Assumes a thermorheologically simple rubber: one a_T for all times.

    Examples
    --------
    >>> series = PronySeries(1e6, [9e6], [1e-3])
    >>> cold = shift_series(series, WLF(c1=10.0, c2=100.0, reference=300.0), 290.0)
    >>> round(float(cold.times[0] / series.times[0]), 3)
    12.915
    """
    decades = float(law.log10_a_T(temperature))
    if abs(decades) > MAX_DECADES:
        raise RangeError(
            f"the shift law gives {decades:.0f} decades at {{}}, above {MAX_DECADES:.0f}: too far from the reference "
            "{}",
            celsius_in_message(temperature),
            celsius_in_message(law.reference),
        )
    return series.scaled(a_T=10.0**decades, b_T=b_T)
