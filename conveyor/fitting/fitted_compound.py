"""Laboratory files to a compound: master curve, fit, band, shift, strain, provenance and open points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError
from conveyor.fitting.amplitude import StrainAmplitudes, reference_strain, short_sweep_note, stated_amplitudes
from conveyor.fitting.compound_file import (
    add_shift,
    describe_fit,
    describe_series,
    describe_strain,
    modulus_text,
)
from conveyor.fitting.findings import Finding, check_accepted, check_findings, refuse_findings
from conveyor.fitting.levels import SweepLevel, file_level_findings, sweep_level_findings, sweep_levels
from conveyor.fitting.measured_rows import (
    CURVE_KINDS,
    MeasuredRows,
    entropic_shift,
    excluded_rows,
    excluded_rows_of_file,
    isotherm_disagreement,
    isotherm_scatter,
    measured_moduli,
)
from conveyor.fitting.request import Request
from conveyor.fitting.shift_choice import (
    chosen_law,
    compare_laws,
    find_reference,
    law_fitter,
    master_curve_rows,
    parse_kelvin,
    whole_master_curve,
)
from conveyor.laboratory import DmaData
from conveyor.laboratory.dma_file import answers_for_file, read_with_answers
from conveyor.laboratory.table_file import matching_sheets
from conveyor.models import RubberCompound
from conveyor.rubber import (
    WLF,
    Arrhenius,
    KramersKronig,
    PronyFit,
    PronySeries,
    ShiftComparison,
    Superposition,
    bootstrap,
    fit_prony,
    kramers_kronig,
    kramers_kronig_applicable,
)
from conveyor.rubber.fit import consistency_floor
from conveyor.rubber.term_count import AICC_NO_SUPPORT

__all__ = ["FittedCompound", "Request", "TabulatedCompound", "compound_from_files", "fit_file"]


@dataclass(frozen=True, eq=False)
class FittedCompound:
    """A compound and everything needed to judge it.

    Attributes
    ----------
    compound : RubberCompound
        As the shelf holds it.
    fit : PronyFit
        Series, errors, criterion.
    consistency : KramersKronig or None
        Kramers-Kronig test of E' and E''.
    superposition : Superposition or None
        Of isotherms only.
    laws : tuple of ShiftComparison
        Table, WLF and Arrhenius on the shifts, the best first; empty without shifts.
    understood : tuple of str
        Notes on reading each file, one a decision.
    entropic_floor : float or None
        Residual of the best positive spectrum with the vertical shift of an entropic network, where that differs
        significantly from none [-].
    rows : MeasuredRows
        Every row as measured, with its shift.
    files : tuple of str
        Names of the files, by the file number of the rows.
    metadata : mapping of str to str
        Remarks of the files by their keys.
    amplitudes : tuple of StrainAmplitudes
        Strain of each file that states it.
    accepted : tuple of Finding
        Findings that are refused unless accepted, and were.
    levels : tuple of SweepLevel
        E' of the strain sweeps beside that of the master curve.
    """

    compound: RubberCompound
    fit: PronyFit
    consistency: KramersKronig | None
    superposition: Superposition | None
    laws: tuple[ShiftComparison, ...]
    understood: tuple[str, ...]
    entropic_floor: float | None
    rows: MeasuredRows
    files: tuple[str, ...]
    metadata: Mapping[str, str]
    amplitudes: tuple[StrainAmplitudes, ...] = ()
    accepted: tuple[Finding, ...] = ()
    levels: tuple[SweepLevel, ...] = ()

    @property
    def noise(self) -> tuple[float | None, float | None]:
        """Scatter of E' and E'' from row to row within isotherms, of a master curve along it [-]."""
        return isotherm_scatter(self.rows, self.fit)

    @property
    def disagreement(self) -> tuple[float, float] | None:
        """Difference of E' and E'' between overlapping isotherms, beyond their scatter [-]."""
        return isotherm_disagreement(self.rows, self.fit)


@dataclass(frozen=True, eq=False)
class TabulatedCompound:
    """A compound of a Prony table, and notes on reading it."""

    compound: RubberCompound
    understood: tuple[str, ...]


@check_arguments
def compound_from_files(data: Path | Sequence[Path], request: Request) -> FittedCompound | TabulatedCompound:
    """Make a compound from files: of a Prony table unchanged, of measurements by `fit_file`.

    Parameters
    ----------
    data : Path or sequence of Path
        A file alone, or the files of one rubber.
    request : Request
        Options of the compound; of a table name, reference, shift, strain, ν and equilibrium modulus.

    Raises
    ------
    InputError
        As `fit_file`; a table whose equilibrium modulus is not known or not > 0.
    NoSolutionError
        No solid fits the data.
    """
    paths = [data] if isinstance(data, Path) else list(data)
    if len(paths) > 1:
        return fit_file(paths, request)
    files, _ = _read_files(paths, request)
    return (
        _compound_of_table(files[0], request)
        if [f.kind for f in files] == ["Prony series"]
        else fit_file(paths, request)
    )


def _compound_of_table(read: DmaData, request: Request) -> TabulatedCompound:
    times, moduli = read.columns("Prony tables", "time", "modulus")
    equilibrium = request.equilibrium
    if equilibrium is None:
        if read.instantaneous is None:
            raise InputError(
                f"{read.source}: E_e is not stated: add a column 'E_0 [MPa]', or give --instantaneous or --equilibrium"
            )
        equilibrium = read.instantaneous - float(np.sum(moduli))
        if equilibrium <= 0.0:
            raise InputError(
                f"{read.source}: the moduli add up to more than E_0 = {modulus_text(read.instantaneous, 6)}"
            )
    shifts = None if request.shift is None else _read_of_kind(request.shift, "shift factors", request)
    strains = None if request.strain is None else _read_of_kind(request.strain, "strain sweep", request)
    series = PronySeries(equilibrium, moduli, times)
    window = tuple(1.0 / (2.0 * np.pi * float(t)) for t in (np.max(times), np.min(times)))
    at_strain = reference_strain([read], (), request, needed=strains is not None)
    described = describe_series([read], (request, at_strain), find_reference([read], request), series, window)
    described["missing"] = ["the measurement behind the table", "density"]
    add_shift(described, None, shifts, _law_of_table(shifts, described, request))
    if strains is not None:
        described["strain_dependence"] = describe_strain(at_strain, strains)
    return TabulatedCompound(
        _build_compound(described, Path((shifts or read).source)),
        tuple(
            f"{Path(each.source).name}: {line}" for each in (read, shifts, strains) if each for line in each.understood
        ),
    )


def _law_of_table(shifts: DmaData | None, described: Mapping[str, Any], request: Request) -> WLF | Arrhenius | None:
    reference = parse_kelvin(described["reference_temperature"])
    return chosen_law(compare_laws(None, shifts, reference), reference, request)


@check_arguments
def fit_file(data: Path | Sequence[Path], request: Request) -> FittedCompound:
    """Fit the files of one rubber and describe the result as a compound.

    Parameters
    ----------
    data : Path or sequence of Path
        One master curve, or isotherms, sweeps at one temperature, relaxation curves and temperature sweeps in any
        number of files; files of shift factors and strain sweeps among them are taken as `shift` and `strain`. Of
        any layout `conveyor.laboratory.read_dma` understands.
    request : Request
        Options of the fit.

    Raises
    ------
    InputError
        A file is refused or of another kind, or a value is missing or outside its range.
    NoSolutionError
        No solid fits the data.
    """
    paths = [data] if isinstance(data, Path) else list(data)
    read, shifts, strains, said = _read_by_kind(paths, request)
    if request.terms_per_decade is not None and not 0.1 <= request.terms_per_decade <= 20.0:
        raise InputError(f"--terms-per-decade: got {request.terms_per_decade:g}, allowed: >= 0.1 and <= 20")
    reference = find_reference(read, request)
    amplitudes = stated_amplitudes(read, request.poisson_ratio)
    at_strain = reference_strain(read, amplitudes, request, needed=strains is not None)
    rows, superposition, told = master_curve_rows(read, shifts, reference, request)
    f, e1, e2 = rows.curve
    place = ", ".join(each.source for each in read)
    shear = 2.0 * (1.0 + request.poisson_ratio)
    check_accepted(request.accept)
    apart = file_level_findings(rows, read, shear)
    accepted = (
        *refuse_findings(place, apart, request.accept),
        *check_findings(place, (f, e1, e2), request.accept, shear),
    )
    fit = fit_prony(
        f, e1, e2, terms_per_decade=request.terms_per_decade, equilibrium=request.equilibrium,
        storage_error=request.storage_error, loss_error=request.loss_error,
    )  # fmt: skip
    laws = compare_laws(superposition, shifts, parse_kelvin(reference))
    law = chosen_law(laws, parse_kelvin(reference), request)
    advised = _entropic_floor(read, shifts, fit, reference, request)
    if request.vertical and superposition is None and shifts is not None and shifts.temperature is not None:
        shifts = replace(shifts, log10_b_T=np.log10(shifts.temperature / parse_kelvin(reference)))
    maker = None if law is None or superposition is None else law_fitter(superposition, law)
    band = None
    if request.replicas:
        band = bootstrap(fit, superposition, rows.temperature, law=maker, replicas=request.replicas)
    described = describe_fit(read, (request, at_strain), (reference, fit), (band, rows))
    add_shift(described, superposition, shifts, law)
    if strains is not None:
        described["strain_dependence"] = describe_strain(at_strain, strains)
        described["missing"].remove("strain dependence")
        if short := short_sweep_note(strains):
            described["missing"].append(short)
    shifted_by = Path((shifts or read[0]).source)
    levels: tuple[SweepLevel, ...] = ()
    if strains is not None:
        levels = sweep_levels(_build_compound(described, shifted_by))
        found = sweep_level_findings(levels, strains, shear)
        accepted += refuse_findings(place, found, request.accept)
    insisted = tuple(f"accepted ({one.name}): {one.text}" for one in accepted)
    described["fit"]["method"] = "; ".join([described["fit"]["method"], *insisted, *said, *told])
    files = [file for file in (*read, shifts, strains) if file is not None]
    return FittedCompound(
        compound=_build_compound(described, shifted_by),
        fit=fit,
        consistency=kramers_kronig(f, e1, e2) if kramers_kronig_applicable(f) else None,
        superposition=superposition,
        laws=laws,
        understood=(
            *(f"{Path(file.source).name}: {line}" for file in files for line in file.understood),
            *(*told, *insisted),
            *(f"{each.place}: the master curve was measured at {each.text}" for each in amplitudes),
        ),
        entropic_floor=advised,
        rows=rows,
        files=tuple(Path(each.source).name for each in read),
        metadata={key: value for each in reversed(files) for key, value in each.metadata.items()},
        amplitudes=amplitudes,
        accepted=accepted,
        levels=levels,
    )


def _entropic_floor(
    read: Sequence[DmaData], shifts: DmaData | None, fit: PronyFit, reference: str, request: Request
) -> float | None:
    """`Fitted.entropic_floor`, or None where AICc still supports no vertical shift."""
    curve = whole_master_curve(read)
    if curve is None or shifts is None or shifts.log10_b_T is not None or request.vertical:
        return None
    f, storage, loss = measured_moduli(curve)
    b = 10.0 ** entropic_shift(curve, shifts, parse_kelvin(reference))
    left = consistency_floor(f, storage / b, loss / b)
    better = 4.0 * f.size * np.log(fit.consistency_floor / left)
    return left if better > AICC_NO_SUPPORT else None


def _read_by_kind(
    paths: Sequence[Path], request: Request
) -> tuple[list[DmaData], DmaData | None, DmaData | None, tuple[str, ...]]:
    """Read files as curves, shift factors and strain sweeps; with notes on excluded rows."""
    files, said = _read_files(paths, request)
    curves = [file for file in files if file.kind in CURVE_KINDS or len(files) == 1]
    others: dict[str, list[DmaData]] = {"shift factors": [], "strain sweep": []}
    for file in files:
        if file not in curves and file.kind not in others:
            raise InputError(f"{file.source}: holds a {file.kind}; it is read alone, not beside other files")
        if file not in curves:
            others[file.kind].append(file)
    for kind, path in (("shift factors", request.shift), ("strain sweep", request.strain)):
        if path is not None:
            others[kind].append(_read_of_kind(path, kind, request))
        if len(others[kind]) > 1:
            raise InputError(f"{others[kind][1].source}: a second file of {kind}; give one")
    if not curves:
        raise InputError(f"{paths[0]}: no file holds a master curve, isotherms, relaxation or a temperature sweep")
    shifts, strains = (next(iter(others[kind]), None) for kind in others)
    return curves, shifts, strains, said


def _read_files(paths: Sequence[Path], request: Request) -> tuple[list[DmaData], tuple[str, ...]]:
    """Read every file, of a workbook every matching sheet; with notes on excluded rows."""
    tables = [(path, sheet) for path in paths for sheet in matching_sheets(path, request.reading.get("sheet"))]
    several = len(tables) > 1 or request.shift is not None or request.strain is not None
    rows = excluded_rows(
        tables, request.exclude, [path for path in (request.shift, request.strain) if path is not None]
    )
    _check_columns([*tables, *((p, None) for p in (request.shift, request.strain) if p is not None)], request)
    files = []
    for k, (path, sheet) in enumerate(tables):
        answers = {**request.reading, "sheet": sheet, "exclude": rows.get(k)}
        files.append(read_with_answers(path, answers, poisson_ratio=request.poisson_ratio, several=several))
    return files, tuple(
        f"{Path(files[k].source).name}: rows excluded by hand: {left_out}" for k, left_out in rows.items()
    )


def _check_columns(tables: Sequence[tuple[Path, str | None]], request: Request) -> None:
    """Refuse names of columns, of --column and --ignore, that no file has."""
    for option, key in (("--column", "columns"), ("--ignore", "ignore")):
        for name in request.reading.get(key) or ():
            one = {"columns": {name: ""}} if key == "columns" else {"ignore": [name]}
            if not any(answers_for_file(path, {**one, "sheet": sheet})[key] for path, sheet in tables):
                raise InputError(f'{option}: no file has a column "{name}"')


def _build_compound(described: dict[str, Any], shifted_by: Path) -> RubberCompound:
    """Build the compound; errors of its shift are located in the file of the shift."""
    try:
        return RubberCompound.from_data(described)
    except InputError as error:
        if not str(error).startswith("shift"):
            raise
        raise InputError(f"{shifted_by}: {error}") from None


def _read_of_kind(path: Path, kind: str, request: Request) -> DmaData:
    answers = {key: value for key, value in request.reading.items() if key not in {"kind", "sheet"}}
    answers["exclude"] = excluded_rows_of_file(path, request.exclude)
    read = read_with_answers(path, answers, poisson_ratio=request.poisson_ratio, several=True)
    if read.kind != kind:
        raise InputError(f"{path}: holds {read.kind}, {kind} are needed here")
    return read
