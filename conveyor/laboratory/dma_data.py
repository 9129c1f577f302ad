"""Data of a laboratory file in SI: frozen arrays, split into sweeps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

ISOTHERM_DRIFT: Final = 3.0
"""Largest temperature drift of an isotherm [K]; beyond it the temperature is a ramp."""


@dataclass(frozen=True, eq=False)
class IsothermRows:
    """One frequency sweep at one temperature, by ascending frequency.

    Attributes
    ----------
    temperature, temperature_spread : float
        Mean of its rows, and highest minus lowest [K].
    frequency, storage, loss : numpy.ndarray
        Cyclic frequency [Hz], E' and E'' [Pa], each of shape `(n,)`.
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

    Attributes
    ----------
    temperature, frequency : float or None
        Means of its rows [K, Hz], None if not stated.
    strain, storage, loss : numpy.ndarray
        Amplitude [-], E' and E'' [Pa], each of shape `(n,)`.
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
    """One laboratory file in SI: columns that it has not are None, the others of shape `(n,)`.

    Attributes
    ----------
    kind : str
        One of `conveyor.laboratory.KINDS` [-].
    frequency, temperature, strain : numpy.ndarray or None
        Cyclic frequency [Hz], temperature [K], amplitude [-].
    time : numpy.ndarray or None
        Of a Prony series its relaxation times [s].
    storage, loss : numpy.ndarray or None
        E' and E'' [Pa].
    modulus : numpy.ndarray or None
        Relaxation modulus E(t), of a Prony series its E_i [Pa].
    log10_a_T, log10_b_T : numpy.ndarray or None
        Horizontal and vertical shift [decades].
    run : numpy.ndarray or None
        Labels of a run column, or of duplicate runs [-].
    group : numpy.ndarray or None
        Rows of one temperature (for a temperature sweep: of one frequency) share a number [-].
    row_numbers : numpy.ndarray
        Line or row of each row in the file [-].
    metadata, metadata_rows : mapping
        `key: value` lines, and their rows [-].
    understood : tuple of str
        One sentence for each decision [-].
    source : str
        The file, for a workbook with its sheet [-].
    instantaneous : float or None
        E_e + sum of E_i of a Prony series, if stated [Pa].
    shear : bool
        Whether the file holds shear moduli, converted to these [-].
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
    shear: bool = False

    def columns(self, what: str, *names: str) -> tuple[FloatArray, ...]:
        """Columns by name, all required for `what`.

        Raises
        ------
        InputError
            If one of them is not there.
        """
        by_name = {name: getattr(self, name) for name in names}
        missing = [name for name, values in by_name.items() if values is None]
        if missing:
            advice = "or give temperature (--temperature)" if missing == ["temperature"] else "with its unit"
            raise InputError(f"{self.source}: {what} need {' and '.join(missing)}; add the column, {advice}")
        return tuple(by_name.values())

    def isotherms(self) -> tuple[IsothermRows, ...]:
        """Frequency sweeps by ascending temperature, one for each temperature and run.

        Raises
        ------
        InputError
            If the file has no frequency, temperature, E' and E'', or its temperature is a ramp.
        """
        f, t, e1, e2 = self.columns("isotherms", "frequency", "temperature", "storage", "loss")
        if self.kind not in {"isotherms", "master curve"}:
            raise InputError(
                f'{self.source}: a {self.kind}, not isotherms; give kind="isotherms" (--kind) if it holds them'
            )
        groups = []
        for run, rows in self._sweeps("isotherms", f):
            temperature = t[rows]
            spread = float(np.ptp(temperature))
            if spread > ISOTHERM_DRIFT:
                raise InputError(
                    f"{self.source}:{self.row_numbers[rows[0]]}: the rows of this {self.kind} span"
                    f" {spread:.3g} K, not one temperature; a column 'set' can tell isotherms apart"
                )
            mean, numbers = float(np.mean(temperature)), self.row_numbers[rows]
            groups.append(IsothermRows(mean, spread, f[rows], e1[rows], e2[rows], run, numbers))
        return tuple(sorted(groups, key=lambda isotherm: isotherm.temperature))

    def strain_sweeps(self) -> tuple[StrainRows, ...]:
        """Strain sweeps by ascending temperature, one for each temperature, frequency and run.

        Raises
        ------
        InputError
            If the file is not a strain sweep.
        """
        if self.kind != "strain sweep":
            raise InputError(f"{self.source}: holds a {self.kind}, not a strain sweep; give kind (--kind)")
        strain, e1, e2 = self.columns("strain sweeps", "strain", "storage", "loss")
        sweeps = []
        for run, rows in self._sweeps("strain sweeps", strain):
            t, f = (None if c is None else float(np.mean(c[rows])) for c in (self.temperature, self.frequency))
            sweeps.append(StrainRows(t, f, strain[rows], e1[rows], e2[rows], run, self.row_numbers[rows]))
        return tuple(sweeps)

    def _sweeps(self, what: str, swept: FloatArray) -> Iterator[tuple[int | None, IntArray]]:
        """Rows of each group and run, by the swept quantity."""
        if self.group is None:
            raise InputError(
                f"{self.source}:{self.row_numbers[0]}: the temperature is a ramp, so its rows form no {what};"
                " a column 'set' can tell the steps apart"
            )
        run = np.zeros(swept.size, dtype=np.int64) if self.run is None else self.run
        for group, label in np.unique(np.stack([self.group, run]), axis=1).T:
            rows = np.flatnonzero((self.group == group) & (run == label))
            yield None if self.run is None else int(label), rows[np.argsort(swept[rows], kind="stable")]
