"""Rows of laboratory files of several kinds, shifted to one master curve."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from conveyor.errors import InputError
from conveyor.laboratory import DmaData
from conveyor.laboratory.groups import ISOTHERM_GAP, set_points, temperature_groups
from conveyor.laboratory.measurement_kinds import UNLIKE_RATIO
from conveyor.rubber import Isotherm, PronyFit, ShiftLaw, Superposition, entropic_b_T, equivalent_sweep
from conveyor.rubber.master_curve import LEAST_ROWS, ShiftVariant
from conveyor.rubber.misfit import MOST_SPENT, scatter_within
from conveyor.units.sentences import to_celsius

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

CURVE_KINDS = frozenset({"master curve", "isotherms", "relaxation", "temperature sweep"})
"""Kinds of file that give rows of a master curve."""
_ROW_RANGES = re.compile(r"(?:(?P<file>.+):)?(?P<rows>\d{1,9}(?:-\d{1,9})?(?:,\d{1,9}(?:-\d{1,9})?)*)")


@dataclass(frozen=True, eq=False)
class FrequencySweep:
    """One frequency sweep at one temperature [K]: rows [Hz, Pa] with their numbers in a file."""

    file: int
    isotherm: Isotherm
    first_row: int


@dataclass(frozen=True, eq=False)
class MeasuredRows:
    """Rows as measured, and their shift: E(f, T) = b_T E(f a_T, reference).

    Attributes
    ----------
    file : ndarray of int
        Number of the file of each row.
    temperature, frequency, storage, loss : ndarray, shape (n,)
        As measured, or as converted from relaxation [K, Hz, Pa, Pa].
    log10_a_T, log10_b_T : ndarray, shape (n,)
        Shift of each row [decades].
    """

    file: Numbers
    temperature: Array
    frequency: Array
    storage: Array
    loss: Array
    log10_a_T: Array  # noqa: N815
    log10_b_T: Array  # noqa: N815

    @property
    def curve(self) -> tuple[Array, Array, Array]:
        """Reduced frequency [Hz], E'/b_T and E''/b_T [Pa]."""
        b = 10.0**self.log10_b_T
        return self.frequency * 10.0**self.log10_a_T, self.storage / b, self.loss / b

    def ordered(self) -> MeasuredRows:
        """Rows by ascending reduced frequency."""
        order = np.argsort(self.curve[0], kind="stable")
        return MeasuredRows(**{name: getattr(self, name)[order] for name in self.__dataclass_fields__})


FEWEST_RESIDUALS = 5
"""Least rows between two others that tell a scatter: of five it is known to 1/sqrt(2 5), a third [-]."""


def isotherm_scatter(rows: MeasuredRows, fit: PronyFit) -> tuple[float | None, float | None]:
    """Scatter of E' and E'' from row to row [-]: within isotherms; of a master curve along it.

    None where fewer than `FEWEST_RESIDUALS` rows tell it, or the series has taken most of it.
    """
    f, storage, loss = rows.curve
    counts = np.unique(rows.temperature, return_counts=True)[1]
    inner = int(np.sum(np.maximum(counts - 2, 0))) or f.size - 2
    if inner < FEWEST_RESIDUALS or fit.spent > MOST_SPENT:
        return None, None
    omega, series = 2.0 * np.pi * f, fit.series
    within = [
        scatter_within(f, modulus, rows.temperature, curve, fit.spent)
        for modulus, curve in ((storage, series.storage(omega)), (loss, series.loss(omega)))
    ]
    if None in within:
        return fit.storage_noise, fit.loss_noise
    return within[0], within[1]


def isotherm_disagreement(rows: MeasuredRows, fit: PronyFit) -> tuple[float, float] | None:
    """Difference of E' and E'' between isotherms on the master curve, beyond scatter [-]; None for one isotherm."""
    counts = np.unique(rows.temperature, return_counts=True)[1]
    pooled, within = (fit.storage_noise, fit.loss_noise), isotherm_scatter(rows, fit)
    if np.count_nonzero(counts > 2) < 2 or None in pooled or None in within:
        return None
    first, second = (
        float(np.sqrt(max(0.0, (p or 0.0) ** 2 - (w or 0.0) ** 2))) for p, w in zip(pooled, within, strict=True)
    )
    return first, second


class ShiftFactors(NamedTuple):
    """Temperatures [K], log10 a_T, its standard error and log10 b_T [decades], None if unknown."""

    temperatures: Array
    log10_a_T: Array  # noqa: N815
    error: Array | None
    log10_b_T: Array | None  # noqa: N815


def shift_factors(superposition: Superposition | None, given: DmaData | None) -> ShiftFactors | None:
    """Shift factors of a superposition, else of a file; None without."""
    if superposition is not None:
        vertical = superposition.log10_b_T if np.any(superposition.log10_b_T) else None
        return ShiftFactors(
            superposition.temperatures, superposition.log10_a_T, superposition.log10_a_T_error, vertical
        )
    if given is None or given.temperature is None or given.log10_a_T is None:
        return None
    return ShiftFactors(given.temperature, given.log10_a_T, None, given.log10_b_T)


def excluded_rows(
    tables: Sequence[tuple[Path, str | None]], exclude: Sequence[str], others: Sequence[Path]
) -> dict[int, str]:
    """Rows to leave out, as 12-15,20, by table number (file and sheet); from FILE:ROWS, or ROWS for a single file.

    Entries that name one of the other files are for `excluded_rows_of_file`.
    """
    rows: dict[int, str] = {}
    for given in exclude:
        match = _ROW_RANGES.fullmatch(given.strip())
        if match is None:
            raise InputError(f'--exclude: got "{given}", expected rows such as 12-15,20 or isotherms.csv:12-15,20')
        named = [k for k, table in enumerate(tables) if _names_table(match["file"], *table)]
        other = [path for path in others if match["file"] is not None and _names_table(match["file"], path, None)]
        if len(other) == 1 and not named:
            continue
        if len(named) != 1 or other:
            files = [*tables, *((path, None) for path in others)]
            names = ", ".join(path.name + (f"[{sheet}]" if sheet else "") for path, sheet in files)
            raise InputError(f'--exclude: "{given}": rows of which file? Write FILE:ROWS; files are {names}')
        rows[named[0]] = ",".join([*filter(None, [rows.get(named[0])]), match["rows"]])
    return rows


def excluded_rows_of_file(path: Path, exclude: Sequence[str]) -> str | None:
    """Rows to leave out of one file, from the entries that name it; None without any."""
    given = [match for match in map(_ROW_RANGES.fullmatch, exclude) if match and match["file"] is not None]
    rows = [match["rows"] for match in given if _names_table(match["file"], path, None)]
    return ",".join(rows) or None


def _names_table(name: str | None, path: Path, sheet: str | None) -> bool:
    """True if a name, file or file[sheet] with or without folder, is of this table."""
    if name is None or name in {str(path), path.name}:
        return True
    file, _, of = name.partition("[")
    return file in {str(path), path.name} and (not of or sheet is None or of == f"{sheet}]")


def frequency_sweeps(
    reads: Sequence[DmaData], stated: Mapping[int, float]
) -> tuple[list[FrequencySweep], tuple[str, ...]]:
    """Frequency sweeps of all files, relaxation converted; `stated` are temperatures by file [K]."""
    taken: list[FrequencySweep] = []
    said = []
    for number, read in enumerate(reads):
        if read.kind == "isotherms":
            taken += [
                _sweep_of_rows(read, number, s.temperature, (s.frequency, s.storage, s.loss), s.row_numbers)
                for s in read.isotherms()
            ]
        elif read.kind == "master curve":
            at = _file_temperature(read, number, stated)
            taken.append(_sweep_of_rows(read, number, at, measured_moduli(read), read.row_numbers))
        elif read.kind == "relaxation":
            converted = list(_relaxation_sweeps(read, number, stated))
            taken += converted
            said.append(
                f"{Path(read.source).name}: {len(converted)} relaxation curve(s), each as the frequency sweep that "
                "says the same, a decade inside its window"
            )
    return taken, tuple(said)


def average_repeats(parts: Sequence[FrequencySweep]) -> tuple[list[FrequencySweep], tuple[str, ...]]:
    """Average the sweeps at each temperature, specimens or runs, with notes."""
    ordered = sorted(parts, key=lambda part: part.isotherm.temperature)
    apart = np.flatnonzero(np.diff([part.isotherm.temperature for part in ordered]) > ISOTHERM_GAP) + 1
    made, said = [], []
    for first, last in pairwise([0, *apart.tolist(), len(ordered)]):
        mean, words = _mean_sweep(ordered[first:last]) if last - first > 1 else (ordered[first], "")
        made.append(mean)
        said += [words] if words else []
    return made, tuple(said)


def _mean_sweep(sweeps: Sequence[FrequencySweep]) -> tuple[FrequencySweep, str]:
    """Geometric mean of sweeps at their common frequencies, and a note on their spread."""
    ones = [sweep.isotherm for sweep in sweeps]
    at = float(np.mean([one.temperature for one in ones]))
    said = f"{len(ones)} sweeps at {to_celsius(at):.2f} degC"
    rows = np.log(np.concatenate([[one.frequency, one.storage, one.loss] for one in ones], axis=1))
    level, sweep = (
        set_points(np.exp(rows[0])),
        np.repeat(range(len(ones)), [one.frequency.size for one in ones]),
    )
    points = (np.flatnonzero(level == k) for k in np.unique(level))
    common = [point for point in points if sweep[point].tolist() == list(range(len(ones)))]
    if len(common) < LEAST_ROWS:
        raise InputError(f"--repeats: {said} have {len(common)} frequencies in common, {LEAST_ROWS} are needed")
    spread = max(float(np.ptp(rows[1, point])) for point in common)
    if spread > np.log(UNLIKE_RATIO):
        raise InputError(
            f"--repeats: {said} are none, their E' differs by a factor of {np.exp(spread):.2g}: correct the"
            " temperature of one, or leave it out with --exclude"
        )
    mean = Isotherm(at, *np.exp([[np.mean(row[point]) for point in common] for row in rows]))
    words = f"{said} averaged at {len(common)} frequencies; their E' differ by up to {100.0 * np.expm1(spread):.1f} %"
    return FrequencySweep(sweeps[0].file, mean, sweeps[0].first_row), words


def _sweep_of_rows(
    read: DmaData, number: int, temperature: float, moduli: tuple[Array, Array, Array], rows: Numbers
) -> FrequencySweep:
    """Sweep of some rows of a file; errors are located at the first of them."""
    try:
        return FrequencySweep(number, Isotherm(temperature, *moduli), int(rows.min()))
    except InputError as error:
        raise InputError(
            f"{read.source}:{rows.min()}: {error}; leave its rows out with --exclude, or put those of another strain "
            "into a file of their own"
        ) from None


def _file_temperature(read: DmaData, number: int, stated: Mapping[int, float]) -> float:
    if read.temperature is not None:
        return float(np.mean(read.temperature))
    if number in stated:
        return stated[number]
    raise InputError(
        f'{read.source}: at which temperature? Give the file a line "# reference_temperature: 20 degC", a column '
        "temperature_degC, or --temperature"
    )


def _relaxation_sweeps(read: DmaData, number: int, stated: Mapping[int, float]) -> Iterator[FrequencySweep]:
    time, modulus = read.columns("relaxation curves", "time", "modulus")
    groups: Numbers | None = np.zeros(time.size, dtype=np.int64)
    if read.temperature is not None:
        groups = temperature_groups(read.temperature, read.run)
    if groups is None:
        raise InputError(f"{read.source}: the temperature is a ramp; relaxation is taken at one temperature at a time")
    for group in np.unique(groups):
        rows = groups == group
        at = (
            _file_temperature(read, number, stated)
            if read.temperature is None
            else float(np.mean(read.temperature[rows]))
        )
        try:
            converted = equivalent_sweep(time[rows], modulus[rows])
        except InputError as error:
            raise InputError(f"{read.source}:{read.row_numbers[rows].min()}: {error}") from None
        yield FrequencySweep(number, Isotherm(at, *converted), int(read.row_numbers[rows].min()))


def override_shifts(superposition: Superposition, given: DmaData) -> tuple[Superposition, tuple[str, ...]]:
    """Replace shift factors by those of a file, each at the isotherm of its temperature."""
    own = shift_factors(None, given)
    if own is None:
        raise InputError(f"{given.source}: holds no shift factors")
    said, places = [], []
    for k, (t, a) in enumerate(zip(own.temperatures.tolist(), own.log10_a_T.tolist(), strict=True)):
        at = int(np.argmin(np.abs(superposition.temperatures - t)))
        if abs(superposition.temperatures[at] - t) > ISOTHERM_GAP:
            raise InputError(
                f"{given.source}:{given.row_numbers[k]}: no isotherm at {t - 273.15:.2f} degC; those measured are at "
                + ", ".join(f"{kelvin - 273.15:.2f}" for kelvin in superposition.temperatures.tolist())
            )
        found = float(superposition.log10_a_T[at])
        said.append(f"shift at {t - 273.15:.2f} degC given, {a:+.4f}; the isotherms give {found:+.4f} decades")
        places.append(at)
    moved = replace(
        _at_given_shifts(superposition, own, places),
        own_covariance=_without_errors(superposition.own_covariance, places),
        variants=tuple(_at_given_shifts(one, own, places) for one in superposition.variants),
    )
    return moved, tuple(said)


_Shifted = TypeVar("_Shifted", Superposition, ShiftVariant)


def _at_given_shifts(one: _Shifted, given: ShiftFactors, places: list[int]) -> _Shifted:
    """The same with the given shifts, without error, at the isotherms numbered."""
    shift, vertical, error = one.log10_a_T.copy(), one.log10_b_T.copy(), one.log10_a_T_error.copy()
    shift[places], error[places] = given.log10_a_T, 0.0
    if given.log10_b_T is not None:
        vertical[places] = given.log10_b_T
    covariance = _without_errors(one.joint_covariance, places)
    return replace(one, log10_a_T=shift, log10_a_T_error=error, log10_b_T=vertical, joint_covariance=covariance)


def _without_errors(covariance: Array, places: list[int]) -> Array:
    """Covariance with those rows and columns 0."""
    known = covariance.copy()
    known[places] = known[:, places] = 0.0
    return known


def entropic_shift(read: DmaData, shifts: DmaData | None, reference: float) -> Array:
    """log10 b_T of an entropic network, T/T_ref, for the rows of a master curve shifted without it [decades].

    Notes
    -----
    Derived: the measured frequencies follow from the ends of the window, f_max/a_T at the coldest and f_min/a_T at the
    hottest isotherm; a row is assumed measured where a_T brings it to their geometric mean. Rows of an isotherm of two
    decades are some 8 K from there at most, 3 % of b_T.
    """
    frequency, _, _ = measured_moduli(read)
    given = shift_factors(None, shifts)
    if shifts is None or given is None:
        raise InputError(
            f"{read.source}: --vertical: which temperature a row of a master curve was measured at its shift factors "
            "tell; give them with --shift"
        )
    if given.log10_b_T is not None:
        raise InputError(f"{shifts.source}: has vertical shifts, the curve is laid with them; leave out --vertical")
    order = np.argsort(given.temperatures)
    kelvin, a = given.temperatures[order], given.log10_a_T[order]
    middle = 0.5 * (np.log10(frequency.max() * frequency.min()) - a[0] - a[-1])
    at = np.interp(middle - np.log10(frequency), -a, kelvin)
    return np.log10([entropic_b_T(t, reference) for t in at.tolist()])


def shift_rows(
    parts: Sequence[FrequencySweep],
    ramps: Sequence[tuple[int, DmaData]],
    law: ShiftLaw | None,
    superposition: Superposition | None,
    whole: tuple[int, float, DmaData, Array | float] | None,
) -> tuple[MeasuredRows, tuple[str, ...]]:
    """Shift sweeps, temperature sweeps and a whole curve (file, reference [K], rows, log10 b_T) by a law."""
    columns: list[tuple[Any, ...]] = []
    vertical: dict[float, float] = {}
    if superposition is not None:
        vertical = dict(zip(superposition.temperatures.tolist(), superposition.log10_b_T.tolist(), strict=True))
    for part in parts:
        one = part.isotherm
        a = 0.0 if law is None else float(law.log10_a_T(one.temperature))
        shift = (a, vertical.get(one.temperature, 0.0))
        rows = np.array([one.frequency, one.storage, one.loss])
        if superposition is not None:
            rows = rows[:, superposition.kept(one.frequency)]
        columns.append(_row_fields(part.file, one.temperature, (rows[0], rows[1], rows[2]), shift))
    if whole is not None:
        number, reference, read, b = whole
        columns.append(_row_fields(number, reference, measured_moduli(read), (0.0, b)))
    said = []
    for number, read in ramps:
        frequency, storage, loss = measured_moduli(read)
        if read.temperature is None or law is None:
            raise InputError(f"{read.source}: a temperature sweep needs shift factors: isotherms beside it, or --shift")
        if any(vertical.values()) or (whole is not None and np.any(whole[3])):
            raise InputError(
                f"{read.source}: a temperature sweep has no vertical shift of its own; leave out --vertical"
            )
        known = getattr(law, "temperatures", None) if superposition is None else superposition.temperatures
        low, high = (read.temperature.min(), read.temperature.max()) if known is None else (known[0], known[-1])
        inside = (read.temperature >= low) & (read.temperature <= high)
        t = read.temperature[inside]
        a_T = law.log10_a_T(t) if t.size else t
        columns.append(_row_fields(number, t, (frequency[inside], storage[inside], loss[inside]), (a_T, 0.0)))
        said.append(
            f"{Path(read.source).name}: {t.size} of {inside.size} rows laid on the master curve"
            + ("" if inside.all() else "; the others are beyond the shift factors")
        )
    return MeasuredRows(*(np.concatenate(column) for column in zip(*columns, strict=True))).ordered(), tuple(said)


def measured_moduli(read: DmaData) -> tuple[Array, Array, Array]:
    """Frequency [Hz], E' and E'' [Pa] of a file, refused where missing."""
    frequency, storage, loss = read.columns("rows of a master curve", "frequency", "storage", "loss")
    return frequency, storage, loss


def _row_fields(
    file: int,
    temperature: float | Array,
    moduli: tuple[Array, Array, Array],
    shift: tuple[float | Array, float | Array],
) -> tuple[Any, ...]:
    """Rows of one sweep as the fields of `MeasuredRows`."""
    one = np.ones(moduli[0].size)
    return (np.full(one.size, file), temperature * one, *moduli, shift[0] * one, shift[1] * one)
