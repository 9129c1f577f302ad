"""Strain amplitude (the Payne effect): strain sweeps and the factors on E' and E'' they give.

Filled rubber softens with the amplitude of its strain: A. R. Payne, J. Appl. Polym. Sci. 6 (1962) 57-63.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from conveyor.arguments.arrays import FloatArray, positive_number, positive_vector
from conveyor.arguments.limits import require
from conveyor.errors import InputError, MessageQuantity, RangeError
from conveyor.rubber.monotone import MonotoneCubic

SAME_TEMPERATURE = 0.5
"""Sweeps this close count as one temperature, as does this far beyond the last one [K]: control of a DMA."""
LARGEST_STRAIN = 2.0
"""A larger strain amplitude is taken for a percentage [-]."""
PLATEAU_SPAN = 2.0
"""A plateau is sought from the lowest strain to this multiple of it [-] ..."""
PLATEAU_SPREAD = 0.04
"""... over which highest and lowest modulus differ by at most this part of their mean [-]: repeatability of a DMA."""
LEAST_SCATTER = 1e-3
"""Scatter of a sweep below which nothing is drawn [-]: a DMA resolves no less, and rows of a steep sweep, five a decade
of strain, lie off the cubic through their neighbours by as much without any."""
FEWEST_SCATTER_POINTS = 8
"""Rows of a sweep from which its scatter is told: of fewer, curvature looks like scatter."""
_FEWEST_POINTS = 4
_PLATEAU_POINTS = 3


@dataclass(frozen=True, eq=False)
class StrainSweep:
    """Moduli against strain amplitude at one temperature and frequency.

    Parameters
    ----------
    temperature : float
        Absolute temperature [K].
    frequency : float
        Cyclic frequency [Hz].
    strain : array_like
        Single strain amplitude, shape `(n,)`, ascending, n >= 4 [-].
    storage : array_like
        E', shape `(n,)` [Pa].
    loss : array_like
        E'', shape `(n,)` [Pa].

    Raises
    ------
    InputError
        If a value is not finite and > 0, lengths differ, strains do not ascend (several runs in one), or look like
        percentages.

    Examples
    --------
    >>> sweep = StrainSweep(283.15, 1.0, [1e-4, 1e-3, 1e-2, 1e-1], [11e6, 10.4e6, 7.7e6, 3.5e6], [1.4e6] * 4)
    >>> sweep.strain.size
    4
    """

    temperature: float
    frequency: float
    strain: FloatArray
    storage: FloatArray
    loss: FloatArray

    def __post_init__(self) -> None:
        """Check, copy, freeze."""
        object.__setattr__(self, "temperature", positive_number("temperature", self.temperature, "K"))
        object.__setattr__(self, "frequency", positive_number("frequency", self.frequency, "Hz"))
        for name, unit in (("strain", "-"), ("storage", "Pa"), ("loss", "Pa")):
            values = positive_vector(name, getattr(self, name), unit)
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        if not self.strain.size == self.storage.size == self.loss.size >= _FEWEST_POINTS:
            raise InputError(
                f"strain, storage, loss: one length of at least {_FEWEST_POINTS} points; "
                f"got {self.strain.size}, {self.storage.size}, {self.loss.size}"
            )
        falls = np.flatnonzero(np.diff(self.strain) <= 0.0)
        if falls.size:
            i = int(falls[0]) + 1
            raise InputError(
                f"strain[{i}] = {self.strain[i]:g} follows {self.strain[i - 1]:g}: amplitudes must ascend; "
                "give every run as a sweep of its own"
            )
        if self.strain[-1] > LARGEST_STRAIN:
            raise InputError(
                f"strain reaches {self.strain[-1]:g}, allowed to {LARGEST_STRAIN:g}: amplitudes are numbers, "
                "divide percentages by 100"
            )

    @cached_property
    def scatter(self) -> tuple[float, float] | None:
        """Scatter of E' and E'' from row to row, relative, standard deviation [-]; None for fewer than eight rows.

        From the distances of each row to the cubic through its four neighbours in ln strain, of ln modulus: the
        pseudo-residuals of T. Gasser, L. Sroka, C. Jennen-Steinmetz, Biometrika 73 (1986) 625-633, with a cubic for
        their line, which a Payne step of ten rows bends away from by 2 to 6 %.
        """
        if self.strain.size < FEWEST_SCATTER_POINTS:
            return None
        return _pseudo_scatter(np.log(self.strain), self.storage), _pseudo_scatter(np.log(self.strain), self.loss)

    def plateau(self, name: str) -> NDArray[np.bool_]:
        """Rows of "storage" or "loss" on a plateau at the lowest strains, shape `(n,)`; none where there is no plateau.

        A plateau is three or more rows up to twice the lowest strain, within 4 % of their mean.
        """
        values, head = getattr(self, name), self.strain <= PLATEAU_SPAN * self.strain[0]
        flat = float(np.ptp(values[head])) <= PLATEAU_SPREAD * float(values[head].mean())
        return head if flat and int(head.sum()) >= _PLATEAU_POINTS else np.zeros_like(head)

    def draw(self, random: np.random.Generator) -> StrainSweep:
        """Draw a sweep that the same measurement could have given.

        Rows scatter independently, normal in logarithms, by `scatter`; those of a plateau move as one, by their mean.
        A sweep without known scatter, or of less than `LEAST_SCATTER`, is returned as it is.
        """
        if self.scatter is None or max(self.scatter) < LEAST_SCATTER:
            return self
        drawn = []
        for name, scatter in zip(("storage", "loss"), self.scatter, strict=True):
            apart, plateau = scatter * random.standard_normal(self.strain.size), self.plateau(name)
            if plateau.any():
                apart[plateau] = apart[plateau].mean()
            drawn.append(getattr(self, name) * np.exp(apart))
        return StrainSweep(self.temperature, self.frequency, self.strain, *drawn)


def _pseudo_scatter(x: FloatArray, moduli: FloatArray) -> float:
    """Root mean square distance of ln moduli to the cubic through four neighbours, over that of unit scatter."""
    y, middle = np.log(moduli), np.arange(2, x.size - 2)
    near = middle[:, None] + np.array([-2, -1, 1, 2])
    weights = np.ones(near.shape)  # Lagrange's, at the middle
    for k in range(4):
        for other in range(4):
            if other != k:
                weights[:, k] *= (x[middle] - x[near[:, other]]) / (x[near[:, k]] - x[near[:, other]])
    apart = (y[middle] - np.sum(weights * y[near], axis=1)) / np.sqrt(1.0 + np.sum(weights**2, axis=1))
    return float(np.sqrt(np.mean(apart**2)))


@dataclass(frozen=True, eq=False)
class _RelativeSweep:
    """One sweep relative to its modulus at the reference strain."""

    strain: FloatArray
    curve: MonotoneCubic
    unit: float
    plateau: bool

    @classmethod
    def of(cls, sweep: StrainSweep, name: str, reference: float) -> _RelativeSweep:
        curve = MonotoneCubic(np.log(sweep.strain), getattr(sweep, name))
        flat = bool(sweep.plateau(name).any())
        run = cls(sweep.strain, curve, 1.0, flat)
        label, amplitude = f"reference_strain at {{}} ({name})", np.array([reference])
        at = MessageQuantity(sweep.temperature, "temperature", f"{sweep.temperature:.2f} K", digits=6)
        if reference > sweep.strain[-1]:
            raise RangeError(
                f"{label}: a strain of {reference:.4g} is above the largest measured, {sweep.strain[-1]:.4g}; "
                "measure further, or lower it",
                at,
            )
        return cls(sweep.strain, curve, float(run.at(amplitude, label, sweep.temperature)[0]), flat)

    def at(self, strain: FloatArray, label: str, temperature: float) -> FloatArray:
        """Interpolate the factor, held above the measured strains; below them constant on a plateau, refused elsewhere.

        Refusals have the label, with {} for the temperature [K].
        """
        at = MessageQuantity(temperature, "temperature", f"{temperature:.2f} K", digits=6)
        low, high = float(self.strain[0]), float(self.strain[-1])
        least = float(strain.min())
        if least < low and not self.plateau:
            raise RangeError(
                f"{label}: a strain of {least:.4g} is below the lowest measured, {low:.4g}, where the data show no "
                f"plateau (they differ by more than {100.0 * PLATEAU_SPREAD:.0f} % up to {PLATEAU_SPAN:g} times it); "
                "measure smaller strains",
                at,
            )
        return np.asarray(self.curve(np.log(np.clip(strain, low, high)))) / self.unit


@dataclass(frozen=True, eq=False)
class AmplitudeFactors:
    """Factors of E' and E'' at a strain amplitude, relative to the amplitude at which the master curve was measured.

    Parameters
    ----------
    sweeps : sequence of StrainSweep
        One or more, at one or more temperatures; those within 0.5 K are runs at one temperature, whose factors are
        averaged over the strains that all of them cover [-].
    reference_strain : float
        Single strain amplitude of the measurement the series comes from [-].

    Raises
    ------
    InputError
        No sweep.
    RangeError
        The reference strain lies outside a sweep.

    Notes
    -----
    Monotone cubic (PCHIP) in ln strain, linear in temperature. Beyond the measured temperatures the factors of the
    nearest are held (see `known_at`), above the measured strains those of the largest (`largest_strain`);
    below the lowest measured strain they are constant only where the data show a plateau, i.e. the modulus asked for
    varies by no more than 4 % of its mean over three or more points up to twice that strain.
    The factors are taken to be independent of frequency: they hold near that of the sweeps, in the sense of the
    time-temperature shift.

    Examples
    --------
    >>> strain = [1e-4, 1.5e-4, 2e-4, 1e-3, 1e-2, 1e-1]
    >>> moduli = [11.0e6, 11.0e6, 10.9e6, 10.4e6, 7.7e6, 3.5e6]
    >>> factors = AmplitudeFactors([StrainSweep(283.15, 1.0, strain, moduli, [1.4e6] * 6)], 1e-4)
    >>> round(float(factors.storage(1e-2, 283.15)), 3), float(factors.loss(5e-5, 283.15))
    (0.7, 1.0)
    """

    sweeps: Sequence[StrainSweep]
    reference_strain: float

    def __post_init__(self) -> None:
        """Check and freeze; evaluate the sweeps, so that a bad reference strain is refused here."""
        object.__setattr__(self, "sweeps", tuple(sorted(self.sweeps, key=lambda s: s.temperature)))
        object.__setattr__(self, "reference_strain", positive_number("reference_strain", self.reference_strain, "-"))
        require(bool(self.sweeps), "sweeps", self.sweeps, "at least one strain sweep")
        _ = self._runs

    @cached_property
    def _sweeps_by_temperature(self) -> list[list[StrainSweep]]:
        levels: list[list[StrainSweep]] = []
        for sweep in self.sweeps:
            if levels and sweep.temperature - levels[-1][0].temperature <= SAME_TEMPERATURE:
                levels[-1].append(sweep)
            else:
                levels.append([sweep])
        return levels

    @cached_property
    def _runs(self) -> dict[str, list[list[_RelativeSweep]]]:
        return {
            name: [
                [_RelativeSweep.of(sweep, name, self.reference_strain) for sweep in level]
                for level in self._sweeps_by_temperature
            ]
            for name in ("storage", "loss")
        }

    @cached_property
    def temperatures(self) -> FloatArray:
        """Temperatures of the sweeps, mean over runs, ascending, shape `(t,)` [K]."""
        return np.array(
            [float(np.mean([sweep.temperature for sweep in level])) for level in self._sweeps_by_temperature]
        )

    def known_at(self, temperature: float) -> bool:
        """True if the sweeps reach a temperature [K], half a kelvin beyond the last ones included."""
        low, high = self.temperatures[0] - SAME_TEMPERATURE, self.temperatures[-1] + SAME_TEMPERATURE
        return bool(low <= temperature <= high)

    def largest_strain(self, temperature: float) -> float:
        """Largest strain amplitude [-] measured by all runs that give the factors at a temperature [K]."""
        used = [
            level
            for level, weight in zip(
                self._sweeps_by_temperature, self._temperature_weights(np.array([temperature])), strict=True
            )
            if weight[0]
        ]
        return min(float(sweep.strain[-1]) for level in used for sweep in level)

    def nearest(self, temperature: float) -> float:
        """Temperature limited to the range of the sweeps [K]."""
        return min(max(temperature, float(self.temperatures[0])), float(self.temperatures[-1]))

    def storage(self, strain: ArrayLike, temperature: ArrayLike) -> FloatArray:
        """Factor of E'.

        Parameters
        ----------
        strain : array_like
            Single strain amplitude, > 0, any shape [-].
        temperature : array_like
            Absolute temperature, one or of the shape of `strain` [K].

        Returns
        -------
        numpy.ndarray
            E'(strain)/E'(reference strain), shape of `strain` [-].

        Raises
        ------
        InputError
            If a strain is not finite and > 0.
        RangeError
            If a strain is below the data, where these show no plateau.
        """
        return self._factor("storage", strain, temperature)

    def loss(self, strain: ArrayLike, temperature: ArrayLike) -> FloatArray:
        """Factor of E''.

        Parameters
        ----------
        strain : array_like
            Single strain amplitude, > 0, any shape [-].
        temperature : array_like
            Absolute temperature, one or of the shape of `strain` [K].

        Returns
        -------
        numpy.ndarray
            E''(strain)/E''(reference strain), shape of `strain` [-].

        Raises
        ------
        InputError
            If a strain is not finite and > 0.
        RangeError
            If a strain is below the data, where these show no plateau.
        """
        return self._factor("loss", strain, temperature)

    def _factor(self, name: str, strain: ArrayLike, temperature: ArrayLike) -> FloatArray:
        array = np.asarray(strain, dtype=np.float64)
        flat = positive_vector("strain", array.ravel(), "-")
        at = positive_vector("temperature", np.broadcast_to(temperature, array.shape).ravel(), "K")
        out = np.zeros(flat.shape)
        for level, runs, weight in zip(
            self.temperatures.tolist(), self._runs[name], self._temperature_weights(at), strict=True
        ):
            near = np.flatnonzero(weight)
            label = f"factor of the {name} modulus at {{}}"
            for run in runs if near.size else ():
                out[near] += (weight[near] / len(runs)) * run.at(flat[near], label, level)
        return out.reshape(array.shape)[()]

    def _temperature_weights(self, temperature: FloatArray) -> FloatArray:
        """Linear interpolation weights of the sweep temperatures, shape (t, n), held beyond the last ones."""
        return np.array([np.interp(temperature, self.temperatures, one) for one in np.eye(self.temperatures.size)])
