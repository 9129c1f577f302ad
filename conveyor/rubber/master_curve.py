"""Isotherms, and the master curve made of them with everything needed to judge it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments.arrays import FloatArray, positive_number, positive_vector
from conveyor.errors import InputError
from conveyor.rubber.monotone import MonotoneCubic
from conveyor.rubber.overlap import Overlap
from conveyor.rubber.shift import celsius_in_message

LEAST_ROWS = 3
"""Least rows of an isotherm: two moduli at three frequencies separate a shift from noise."""
SAME_FREQUENCY = 1.0e-4
"""Frequencies closer than this are one setting of the instrument [decades]."""
COLD_UNIT = 10.0
"""Cold by which a trend is stated [K]."""
TREND_LIMIT = 2.576
"""Standard errors beyond which a trend is none of chance: 99 % of a normal distribution lie within [-]."""
Trend: TypeAlias = Literal["phase", "lag", "cold"]
"""E'' that grows with every decade of measured frequency, or in proportion to it, which no rubber's does; both moduli
that grow with cold, a vertical shift."""


@dataclass(frozen=True, eq=False)
class Isotherm:
    """One frequency sweep at one temperature.

    Parameters
    ----------
    temperature : float
        Absolute temperature [K].
    frequency : array_like
        Cyclic frequency, shape `(n,)`, n >= 3, distinct; sorted ascending with the moduli [Hz].
    storage : array_like
        E' at them, shape `(n,)` [Pa].
    loss : array_like
        E'' at them, shape `(n,)` [Pa].

    Raises
    ------
    InputError
        If shapes differ, a value is not finite and > 0, a frequency repeats, or there are fewer than 3 rows.
    """

    temperature: float
    frequency: FloatArray
    storage: FloatArray
    loss: FloatArray

    def __post_init__(self) -> None:
        """Check, sort, freeze."""
        t = positive_number("temperature", self.temperature, "K")
        f = positive_vector("frequency", self.frequency, "Hz")
        columns = {"frequency": f, "storage": positive_vector("storage", self.storage, "Pa")}
        columns["loss"] = positive_vector("loss", self.loss, "Pa")
        if any(c.shape != f.shape for c in columns.values()) or f.size < LEAST_ROWS:
            sizes = ", ".join(f"{name} {c.size}" for name, c in columns.items())
            raise InputError(
                f"the isotherm at {celsius_in_message(t)} needs >= {LEAST_ROWS} rows, each with E' and E''; got {sizes}"
            )
        order = np.argsort(f, kind="stable")
        if np.any(np.diff(f[order]) == 0.0):
            twice = f[order][1:][np.diff(f[order]) == 0.0][0]
            raise InputError(
                f"the isotherm at {celsius_in_message(t)} holds {twice:g} Hz twice: choose one run, or average the runs"
            )
        for name, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, name, ordered)
        object.__setattr__(self, "temperature", t)


@dataclass(frozen=True)
class Resonance:
    """A resonance of the instrument: its rows are outliers in most isotherms.

    Parameters
    ----------
    frequency : float
        As measured [Hz].
    isotherms : int
        Number of isotherms in which its rows are outliers [-].
    storage : float
        Median of E' over the common curve, less one; 0 if E' did not count [-].
    loss : float
        The same of E'' [-].
    """

    frequency: float
    isotherms: int
    storage: float
    loss: float


@dataclass(frozen=True, eq=False)
class ShiftVariant:
    """The same isotherms placed another way.

    Parameters
    ----------
    by : {"both", "storage", "loss"}
        The moduli that counted.
    vertical : bool
        True with vertical shifts.
    log10_a_T, log10_b_T : numpy.ndarray
        Shifts, shape `(n,)` [decades].
    log10_a_T_error : numpy.ndarray
        Standard uncertainty of log10 a_T, shape `(n,)` [decades].
    joint_covariance : numpy.ndarray
        Of log10 a_T, then log10 b_T, shape `(2n, 2n)` [-].
    correlation : float
        Correlation of residuals of neighbouring rows [-].
    differs : bool
        True if its shifts differ from those chosen beyond chance.
    trends : tuple of {"phase", "lag", "cold"}
        Trends that were fitted with the shifts.
    phase_slope : float
        d ln E''/d log10 f that was fitted; 0 without [-].
    lag_slope : float
        d ln E''/df that was fitted besides; 0 without [1/Hz].
    """

    by: Literal["both", "storage", "loss"]
    vertical: bool
    log10_a_T: FloatArray  # noqa: N815
    log10_b_T: FloatArray  # noqa: N815
    log10_a_T_error: FloatArray  # noqa: N815
    joint_covariance: FloatArray = field(repr=False)
    correlation: float
    differs: bool
    trends: tuple[Trend, ...] = ()
    phase_slope: float = 0.0
    lag_slope: float = 0.0

    @property
    def name(self) -> str:
        """Moduli, vertical shifts and trends in words."""
        moduli = {"both": "from E' and E''", "storage": "from E' only", "loss": "from E'' only"}[self.by]
        fitted = {
            "phase": "E'' free to grow with measured decades", "lag": "E'' with measured frequency",
            "cold": "E' and E'' with cold",
        }  # fmt: skip
        if self.trends:
            return f"{moduli}, {' and '.join(fitted[one] for one in self.trends)}"
        return f"{moduli}, {'with vertical shifts' if self.vertical else 'no vertical shift'}"

    @property
    def shifts(self) -> FloatArray:
        """log10 a_T, then log10 b_T, shape `(2, n)` [decades]."""
        return np.array([self.log10_a_T, self.log10_b_T])


@dataclass(frozen=True)
class TrendSlope:
    """Change of moduli along what they do not depend on, at one reduced frequency; fitted together with the shifts.

    Of E'' with measured frequency: a rubber has none; a phase error of the instrument that grows with frequency leaves
    one. Of both moduli with cold: a vertical shift, of the rubber, or of clamps that stiffen with it.

    Parameters
    ----------
    slope : float
        d ln E''/d log10 f, or d ln E per 10 K of cold [-].
    error : float
        Its standard error [-].
    """

    slope: float
    error: float

    @property
    def found(self) -> bool:
        """True if it is none of chance: beyond 99 % of a normal distribution."""
        return abs(self.slope) > TREND_LIMIT * self.error


class DrawnShift(NamedTuple):
    """Shifts that the isotherms could have had: log10 a_T and log10 b_T, shape `(2, n)`.

    `phase_slope` and `lag_slope` are the d ln E''/d log10 f and d ln E''/df that go with them, 0 of a rubber;
    `vertical` tells whether that shift is the rubber's.
    """

    shifts: FloatArray
    phase_slope: float = 0.0
    lag_slope: float = 0.0
    vertical: bool = True


@dataclass(frozen=True, eq=False)
class Superposition:
    """A master curve and everything needed to judge it; `n` isotherms, `m` rows.

    Parameters
    ----------
    reference : float
        Absolute temperature at which a_T = b_T = 1 [K].
    temperatures : numpy.ndarray
        Of the isotherms, shape `(n,)`, ascending [K].
    log10_a_T : numpy.ndarray
        Shift of each: E(f, T) = b_T E(f a_T, T_ref), shape `(n,)` [decades].
    log10_a_T_error : numpy.ndarray
        Standard uncertainty, shape `(n,)`; 0 at a measured reference, growing along the chain [decades].
    log10_b_T : numpy.ndarray
        Vertical shift, 0 unless it was asked for, shape `(n,)` [decades].
    log10_b_T_error : numpy.ndarray
        Its standard uncertainty, shape `(n,)` [decades].
    joint_covariance : numpy.ndarray
        Of log10 a_T, then log10 b_T, shape `(2n, 2n)`: neighbours share the chain to the reference, and its
        errors; with the spread of `contradicting` [-].
    own_covariance : numpy.ndarray
        The same of scatter and overlap alone [-].
    frequency : numpy.ndarray
        Reduced frequency f a_T of the master curve, ascending, shape `(m,)` [Hz].
    storage : numpy.ndarray
        E'/b_T, shape `(m,)` [Pa].
    loss : numpy.ndarray
        E''/b_T, shape `(m,)` [Pa].
    isotherm : numpy.ndarray
        Index into `temperatures` of each row, shape `(m,)` [-].
    overlaps : tuple of Overlap
        Of each neighbouring pair, coldest first.
    storage_residual : float
        Root mean square difference of ln E' in all overlaps [-].
    loss_residual : float
        The same of ln E'' [-].
    storage_scatter : float or None
        Standard deviation of ln E' about the common curve; None if it did not count [-].
    loss_scatter : float or None
        The same of ln E'' [-].
    correlation : float
        Correlation of residuals of neighbouring rows, the larger of E' and E''; far above 0 where the
        isotherms differ in shape: then they do not superpose, whatever the shift [-].
    resonances : tuple of Resonance
        Frequencies that were left out of every isotherm; their rows are in nothing above.
    with_vertical : Superposition or None
        With vertical shifts, where none were asked for and the isotherms need them: beyond chance, by one per
        cent and more, and they become one curve by it.
    variants : tuple of ShiftVariant
        The same isotherms placed by the other moduli, and with or without vertical shifts. Where one differs beyond
        chance, the isotherms contradict each other, and the errors above hold the spread.
    phase_slope : TrendSlope or None
        Change of ln E'' a decade of measured frequency, mean over the measured ones; None with fewer than three
        isotherms, or where it is not determined.
    cold_slope : TrendSlope or None
        Change of both moduli per 10 K of cold; None likewise, and with vertical shifts.
    """

    reference: float
    temperatures: FloatArray
    log10_a_T: FloatArray  # noqa: N815
    log10_a_T_error: FloatArray  # noqa: N815
    log10_b_T: FloatArray  # noqa: N815
    log10_b_T_error: FloatArray  # noqa: N815
    joint_covariance: FloatArray = field(repr=False)
    own_covariance: FloatArray = field(repr=False)
    frequency: FloatArray = field(repr=False)
    storage: FloatArray = field(repr=False)
    loss: FloatArray = field(repr=False)
    isotherm: NDArray[np.intp] = field(repr=False)
    overlaps: tuple[Overlap, ...] = field(repr=False)
    storage_residual: float
    loss_residual: float
    storage_scatter: float | None
    loss_scatter: float | None
    correlation: float
    resonances: tuple[Resonance, ...] = ()
    with_vertical: Superposition | None = field(default=None, repr=False)
    variants: tuple[ShiftVariant, ...] = field(default=(), repr=False)
    phase_slope: TrendSlope | None = None
    cold_slope: TrendSlope | None = None

    @property
    def covariance(self) -> FloatArray:
        """Covariance of log10 a_T, shape `(n, n)` [-]."""
        n = self.temperatures.size
        return self.joint_covariance[:n, :n]

    @property
    def shifts(self) -> FloatArray:
        """log10 a_T, then log10 b_T, shape `(2, n)` [decades]."""
        return np.array([self.log10_a_T, self.log10_b_T])

    def kept(self, frequency: FloatArray) -> NDArray[np.bool_]:
        """True for rows at frequencies [Hz] without resonance, shape `(m,)`."""
        return off_resonance(np.log10(frequency), [one.frequency for one in self.resonances])

    @property
    def contradicting(self) -> tuple[ShiftVariant, ...]:
        """Variants that contradict the chosen shifts: the one with trends, where it makes the isotherms one curve.

        Else all that differ.
        """
        chance = 2.0 / np.sqrt(self.frequency.size)
        trends = tuple(one for one in self.variants if one.trends and one.correlation <= chance)
        return trends or tuple(one for one in self.variants if one.differs)

    def drawn(self, generator: np.random.Generator) -> tuple[DrawnShift, DrawnShift]:
        """Draw shifts from their covariance: plus an error, and minus the same error.

        Parameters
        ----------
        generator : numpy.random.Generator
            Source of random numbers [-].

        Returns
        -------
        tuple of DrawnShift
            Both.

        Notes
        -----
        Where the isotherms contradict each other, a draw takes the chosen shifts or one of `contradicting`, with equal
        chances, and the error of that one. A vertical shift with cold is taken as the rubber's or as the clamps', with
        equal chances: isotherms do not tell them apart.
        """
        others = self.contradicting
        chosen = int(generator.integers(len(others) + 1)) if others else 0
        other = others[chosen - 1] if chosen else None
        shifts, covariance = (
            (self.shifts, self.own_covariance) if other is None else (other.shifts, other.joint_covariance)
        )
        values, vectors = np.linalg.eigh(covariance)
        error = vectors @ (np.sqrt(np.maximum(values, 0.0)) * generator.standard_normal(values.size))
        drawn_shifts = shifts + np.array([1.0, -1.0])[:, None, None] * error.reshape(2, -1)
        up, down = (
            np.array([row - float(MonotoneCubic(self.temperatures, row)(self.reference)) for row in one])
            for one in drawn_shifts
        )
        if other is None:
            return DrawnShift(up), DrawnShift(down)
        kept = "cold" not in other.trends or bool(generator.integers(2))
        slopes = other.phase_slope, other.lag_slope
        return DrawnShift(up, *slopes, kept), DrawnShift(down, *slopes, kept)


def off_resonance(x: FloatArray, frequencies: list[float]) -> NDArray[np.bool_]:
    """True for log10 frequencies away from the frequencies left out."""
    apart: NDArray[np.bool_] = np.abs(x - np.log10(frequencies)[:, None]) >= SAME_FREQUENCY
    return np.asarray(apart.all(axis=0))
