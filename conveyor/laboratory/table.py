"""What a laboratory file holds, in SI: frozen arrays, and the sweeps they fall into."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ISOTHERM_DRIFT = 3.0
"""Most that one isotherm may drift [K]; beyond it the temperature is a ramp."""
KINDS = (
    "master curve",
    "isotherms",
    "temperature sweep",
    "strain sweep",
    "relaxation",
    "shift factors",
    "Prony series",
)
"""What a file can hold."""


@dataclass(frozen=True, eq=False)
class IsothermRows:
    """One frequency sweep at one temperature, by ascending frequency.

    Parameters
    ----------
    temperature : float
        Mean of its rows [K].
    temperature_spread : float
        Highest minus lowest of its rows [K].
    frequency : numpy.ndarray
        Cyclic frequency, shape `(n,)` [Hz].
    storage : numpy.ndarray
        E', shape `(n,)` [Pa].
    loss : numpy.ndarray
        E'', shape `(n,)` [Pa].
    run : int or None
        Label of the run [-].
    row_numbers : numpy.ndarray
        Rows in the file, shape `(n,)` [-].
    """

    temperature: float
    temperature_spread: float
    frequency: FloatArray
    storage: FloatArray
    loss: FloatArray
    run: int | None
    row_numbers: IntArray


@dataclass(frozen=True, eq=False)
class StrainRows:
    """One strain sweep at one temperature and frequency, by ascending strain.

    Parameters
    ----------
    temperature : float or None
        Mean of its rows, None if the file does not state it [K].
    frequency : float or None
        Mean of its rows, None if the file does not state it [Hz].
    strain : numpy.ndarray
        Amplitude, shape `(n,)` [-].
    storage : numpy.ndarray
        E', shape `(n,)` [Pa].
    loss : numpy.ndarray
        E'', shape `(n,)` [Pa].
    run : int or None
        Label of the run [-].
    row_numbers : numpy.ndarray
        Rows in the file, shape `(n,)` [-].
    """

    temperature: float | None
    frequency: float | None
    strain: FloatArray
    storage: FloatArray
    loss: FloatArray
    run: int | None
    row_numbers: IntArray


@dataclass(frozen=True, eq=False)
class DmaData:
    """One laboratory file in SI.

    Parameters
    ----------
    kind : str
        One of `KINDS` [-].
    frequency : numpy.ndarray or None
        Cyclic frequency, shape `(n,)` [Hz].
    temperature : numpy.ndarray or None
        Shape `(n,)` [K].
    strain : numpy.ndarray or None
        Amplitude, shape `(n,)` [-].
    time : numpy.ndarray or None
        Of a Prony series its relaxation times, shape `(n,)` [s].
    storage : numpy.ndarray or None
        E', shape `(n,)` [Pa].
    loss : numpy.ndarray or None
        E'', shape `(n,)` [Pa].
    modulus : numpy.ndarray or None
        Relaxation modulus E(t), of a Prony series its E_i, shape `(n,)` [Pa].
    instantaneous : float or None
        E_e + sum of E_i of a Prony series, where the file states it [Pa].
    log10_a_T : numpy.ndarray or None
        Horizontal shift, shape `(n,)` [-].
    log10_b_T : numpy.ndarray or None
        Vertical shift, shape `(n,)` [-].
    run : numpy.ndarray or None
        Labels of a run column, or of duplicate runs found, shape `(n,)` [-].
    group : numpy.ndarray or None
        Rows of one temperature (for a temperature sweep: of one frequency) share a number, shape `(n,)` [-].
    row_numbers : numpy.ndarray
        Line or row of each row in the file, shape `(n,)` [-].
    metadata : mapping of str
        `key: value` lines [-].
    metadata_rows : mapping of int
        Where they stand [-].
    understood : tuple of str
        One sentence for each decision [-].
    source : str
        The file, for a workbook with its sheet [-].
    """

    kind: str
    frequency: FloatArray | None
    temperature: FloatArray | None
    strain: FloatArray | None
    time: FloatArray | None
    storage: FloatArray | None
    loss: FloatArray | None
    modulus: FloatArray | None
    log10_a_T: FloatArray | None  # noqa: N815
    log10_b_T: FloatArray | None  # noqa: N815
    run: IntArray | None
    group: IntArray | None
    row_numbers: IntArray
    metadata: Mapping[str, str]
    metadata_rows: Mapping[str, int]
    understood: tuple[str, ...]
    source: str
    instantaneous: float | None = None

    def isotherms(self) -> tuple[IsothermRows, ...]:
        """Frequency sweeps by ascending temperature, duplicate runs apart.

        Returns
        -------
        tuple of Isotherm
            One for each temperature and run [-].

        Raises
        ------
        InputError
            If the file has no frequency, temperature, E' and E'', or its temperature is a ramp.
        """
        if self.frequency is None or self.temperature is None or self.storage is None or self.loss is None:
            missing = [
                name
                for name in ("frequency", "temperature", "storage", "loss")
                if getattr(self, name) is None
            ]
            advice = "; give temperature (--temperature)" if missing == ["temperature"] else ""
            raise InputError(f"{self.source}: isotherms need {' and '.join(missing)}{advice}")
        if self.kind not in {"isotherms", "master curve"}:
            raise InputError(
                f'{self.source}: a {self.kind}, not isotherms; give kind="isotherms" (--kind) if it holds them'
            )
        found = []
        for run, rows in self._sweeps("isotherms", self.frequency):
            inside = self.temperature[rows]
            if np.ptp(inside) > ISOTHERM_DRIFT:
                raise InputError(
                    f"{self.source}:{self.row_numbers[rows[0]]}: the rows of this {self.kind} span"
                    f" {np.ptp(inside):.3g} K, not one temperature; a column 'set' can tell isotherms apart"
                )
            found.append(
                IsothermRows(
                    float(np.mean(inside)),
                    float(np.ptp(inside)),
                    self.frequency[rows],
                    self.storage[rows],
                    self.loss[rows],
                    run,
                    self.row_numbers[rows],
                )
            )
        return tuple(sorted(found, key=lambda isotherm: isotherm.temperature))

    def strain_sweeps(self) -> tuple[StrainRows, ...]:
        """Strain sweeps by ascending temperature, duplicate runs apart.

        Returns
        -------
        tuple of StrainSweep
            One for each temperature, frequency and run [-].

        Raises
        ------
        InputError
            If the file is not a strain sweep.
        """
        if self.kind != "strain sweep" or self.strain is None or self.storage is None or self.loss is None:
            raise InputError(f"{self.source}: holds a {self.kind}, not a strain sweep; give kind (--kind)")
        return tuple(
            StrainRows(
                None if self.temperature is None else float(np.mean(self.temperature[rows])),
                None if self.frequency is None else float(np.mean(self.frequency[rows])),
                self.strain[rows],
                self.storage[rows],
                self.loss[rows],
                run,
                self.row_numbers[rows],
            )
            for run, rows in self._sweeps("strain sweeps", self.strain)
        )

    def _sweeps(self, what: str, swept: FloatArray) -> list[tuple[int | None, IntArray]]:
        """Rows of each group and run, by the swept quantity."""
        if self.group is None:
            raise InputError(
                f"{self.source}:{self.row_numbers[0]}: the temperature is a ramp, so its rows form no {what};"
                " a column 'set' can tell the steps apart"
            )
        run = np.zeros(swept.size, dtype=np.int64) if self.run is None else self.run
        keys = np.stack([self.group, run])
        found = []
        for group, label in np.unique(keys, axis=1).T:
            rows = np.flatnonzero((self.group == group) & (run == label))
            rows = rows[np.argsort(swept[rows], kind="stable")]
            found.append((None if self.run is None else int(label), rows))
        return found
