"""Moduli of one file beside those of the others, and of strain sweeps beside the master curve: factors apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from conveyor.arguments.arrays import FloatArray
from conveyor.errors import RangeError
from conveyor.fitting.amplitude import strain_text
from conveyor.fitting.findings import Finding
from conveyor.fitting.measured_rows import MeasuredRows
from conveyor.laboratory import DmaData
from conveyor.laboratory.measurement_kinds import UNLIKE_RATIO
from conveyor.models import RubberCompound
from conveyor.units.sentences import to_celsius

LEVEL_LIMIT: Final = UNLIKE_RATIO
"""Factor between moduli of one rubber at one strain, temperature and frequency from which they are refused [-]."""
STANDING_OFF: Final = 1.25
"""Least factor by which nine tenths of the rows of a file that stands off do so: the others only scatter [-]."""
FEWEST_BESIDE: Final = 3
"""Least rows of a file within the frequencies of another."""
_NEAR: Final = 1.15  # of a known factor, between moduli of two instruments


@dataclass(frozen=True)
class SweepLevel:
    """E' of one strain sweep beside that of the master curve, at the strain of the latter or the nearest measured.

    Attributes
    ----------
    temperature, frequency, strain : float
        Where they are compared [K, Hz, -].
    ratio : float
        E' of the sweep over that of the master curve [-].
    """

    temperature: float
    frequency: float
    strain: float
    ratio: float

    @property
    def factor(self) -> float:
        """Larger of both over the smaller [-]."""
        return max(self.ratio, 1.0 / self.ratio)


def sweep_levels(compound: RubberCompound) -> tuple[SweepLevel, ...]:
    """Levels of the strain sweeps of a compound that are within its data."""
    known = compound.amplitude_factors()
    if known is None:
        return ()
    made = []
    for sweep in known.sweeps:
        try:
            window, series = compound.frequencies(sweep.temperature), compound.series(sweep.temperature)
        except RangeError:
            continue
        if window is None or not window[0] <= sweep.frequency <= window[1]:
            continue
        strain = float(np.clip(known.reference_strain, sweep.strain[0], sweep.strain[-1]))
        storage = np.exp(np.interp(np.log(strain), np.log(sweep.strain), np.log(sweep.storage)))
        ratio = float(storage / series.storage(2.0 * np.pi * sweep.frequency))
        made.append(SweepLevel(sweep.temperature, sweep.frequency, strain, ratio))
    return tuple(made)


def sweep_level_findings(levels: Sequence[SweepLevel], read: DmaData, shear: float) -> Iterator[Finding]:
    """The strain sweep that is farthest from the master curve, if beyond `LEVEL_LIMIT`; `shear` is E/G [-]."""
    worst = max(levels, key=lambda one: one.factor, default=None)
    if worst is not None and worst.factor > LEVEL_LIMIT:
        yield Finding(
            "contradiction",
            f"E' of the strain sweep is {worst.ratio:.3g} times that of the master curve at "
            f"{strain_text(worst.strain)}, {to_celsius(worst.temperature):.4g} degC and {worst.frequency:.3g} Hz: "
            f"{_factor_advice(worst.ratio, shear, as_shear=read.shear)}",
            read.source,
        )


def file_level_findings(rows: MeasuredRows, read: Sequence[DmaData], shear: float) -> Iterator[Finding]:
    """The file whose rows all stand off those of the others by a factor beyond `LEVEL_LIMIT`; `shear` is E/G [-].

    Named is the one that most others contradict; of two either may be wrong: the one of fewer rows.
    """
    numbers, counts = np.unique(rows.file, return_counts=True)
    found = []
    for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
        beside = [_log_ratio_of_files(rows, number, other) for other in numbers.tolist() if other != number]
        apart = [logarithms for logarithms in beside if _stands_off(logarithms)]
        if apart:
            ratio = float(np.exp(np.median(np.concatenate(apart))))
            found.append((-len(apart), count, number, ratio))
    if found:
        *_, number, ratio = min(found)
        yield Finding(
            "contradiction",
            f"E' of its rows is {ratio:.3g} times that of the other files at the same reduced frequency: "
            f"{_factor_advice(ratio, shear, as_shear=read[number].shear)}",
            read[number].source,
        )


def _log_ratio_of_files(rows: MeasuredRows, number: int, other: int) -> FloatArray:
    """Ln E' of the rows of a file less that of another at their reduced frequency, where that has any."""
    reduced, storage, _ = rows.curve
    mine, its = rows.file == number, rows.file == other
    x, y = np.log(reduced), np.log(storage)
    inside = mine & (x >= x[its].min()) & (x <= x[its].max())
    return np.asarray(y[inside] - np.interp(x[inside], x[its], y[its]))


def _stands_off(logarithms: FloatArray) -> bool:
    """True if nearly all rows differ one way, by `LEVEL_LIMIT` in the middle."""
    if logarithms.size < FEWEST_BESIDE:
        return False
    low, middle, high = np.quantile(logarithms, (0.1, 0.5, 0.9)).tolist()
    return bool(abs(middle) > np.log(LEVEL_LIMIT) and max(low, -high) > np.log(STANDING_OFF))


def _factor_advice(ratio: float, shear: float, *, as_shear: bool) -> str:
    """Return what a factor may come from, and what to do; `as_shear` where the moduli were read as G."""
    if _is_near(ratio, shear) and as_shear:
        return "about that of E over G; are its moduli E, taken for G? Name its columns E' and E'', or give --moduli E"
    if _is_near(ratio, 1.0 / shear) and not as_shear:
        return "about that of G over E; are its moduli G, taken for E? Name its columns G' and G'', or give --moduli G"
    if _is_near(ratio, shear) or _is_near(ratio, 1.0 / shear):
        return "about that between E and G: name the columns of every file as what it holds, E' or G', or give --moduli"
    if _is_near(ratio, 10.0 ** round(np.log10(ratio))):
        return "correct the unit of its moduli in the header"
    return "another rubber, temperature or strain, or a wrong unit? Correct it, or leave it out"


def _is_near(ratio: float, factor: float) -> bool:
    return max(ratio / factor, factor / ratio) < _NEAR
