"""From laboratory files to a compound: master curve, fit, band, shift, strain, provenance, and what is not known."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from conveyor.arguments import checked
from conveyor.errors import InputError
from conveyor.laboratory import DmaData
from conveyor.laboratory.answered import read_answered
from conveyor.laboratory.findings import check_findings
from conveyor.laboratory.groups import ISOTHERM_GAP
from conveyor.measured_rows import CURVES, MeasuredRows, Sweep, laid, overridden, sweeps, without
from conveyor.models import RubberCompound
from conveyor.rubber import (
    WLF,
    Arrhenius,
    KramersKronig,
    PronyFit,
    PronySeries,
    ShiftComparison,
    ShiftLaw,
    ShiftTable,
    Superposition,
    bootstrap,
    compare_shift_laws,
    fit_prony,
    kramers_kronig,
    superpose,
    testable,
)
from conveyor.rubber.band import METHOD
from conveyor.rubber.shift_laws import LEAST_TEMPERATURES
from conveyor.rubber.strain import SAME_TEMPERATURE
from conveyor.units import in_si
from conveyor.units.sentences import ZERO_CELSIUS, celsius

Array = NDArray[np.float64]

REPLICAS = 20
"""Of the bootstrap in a compound file: nineteen of twenty leave nine tenths between the outermost ones."""
_DIGITS = 12  # read back, the series is the fit to 1e-11
_BAND_DIGITS = 6  # the band is known to one or two
_ERROR_DECIMALS = 8  # of a relative error: an exact fit leaves rounding, which is none
_UNKNOWN = "not stated"
_REFERENCE_NAMES = frozenset(
    {
        "referencetemperature",
        "referencetemp",
        "reftemperature",
        "tref",
        "referenztemperatur",
        "bezugstemperatur",
    }
)
_NUMBER = re.compile(r"\s*([+-]?\d+(?:[.,]\d*)?)\s*(degC|degF|K|°C|°F)?(?![\w.,])")
_SMALLEST_ERROR = (
    1e-3  # of log10 a_T where laws are weighed: a measured reference has none of its own [decades]
)
_FEWEST_STRAINS = 4  # of a run that can be interpolated; a stray row is a run of one


@dataclass(frozen=True)
class Request:
    """What a laboratory file is to become.

    Parameters
    ----------
    name : str
        Name of the compound.
    reference_temperature : str, optional
        Of the master curve, with unit ("20 degC"); else the file's line ``# reference_temperature: …``.
    shift : Path, optional
        File of shift factors; without it, and without isotherms, the compound holds at its reference only.
    strain : Path, optional
        File of strain sweeps.
    reference_strain : str, optional
        Single strain amplitude of the master curve, with unit ("0.1 %"); needed with `strain`.
    poisson_ratio : float
        ν; also turns shear moduli into tensile ones [-].
    equilibrium : float, optional
        E_e held in the fit [Pa]; fitted without it.
    terms_per_decade : float, optional
        Density of the times; chosen by AICc without it [1/decade].
    vertical : bool
        Whether isotherms may be shifted vertically, too.
    by : {"both", "storage", "loss"}
        Modulus whose overlap places the isotherms.
    law : {"table", "wlf", "arrhenius"}
        Shift law that the compound keeps, and that its master curve is laid by.
    exclude : tuple of str
        Rows left out, "12-15,20" or "isotherms.csv:12-15,20".
    storage_error, loss_error : float, optional
        Relative standard errors of E' and E'' that weigh them [-]; both or neither, equal without.
    replicas : int
        Of the bootstrap band; 0 for none.
    accept : frozenset of str
        Findings on which a person insists, names of `conveyor.laboratory.findings.FINDINGS`; others are refused.
    reading : mapping
        Answers to what a file leaves open: keywords of `conveyor.laboratory.read_dma`.
    """

    name: str
    reference_temperature: str | None = None
    shift: Path | None = None
    strain: Path | None = None
    reference_strain: str | None = None
    poisson_ratio: float = 0.5
    equilibrium: float | None = None
    terms_per_decade: float | None = None
    vertical: bool = False
    by: Literal["both", "storage", "loss"] = "both"
    law: Literal["table", "wlf", "arrhenius"] = "table"
    exclude: tuple[str, ...] = ()
    storage_error: float | None = None
    loss_error: float | None = None
    replicas: int = REPLICAS
    accept: frozenset[str] = frozenset()
    reading: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Fitted:
    """A compound and everything needed to judge it.

    Attributes
    ----------
    compound : RubberCompound
        As the shelf holds it.
    fit : PronyFit
        Series, errors, criterion.
    consistency : KramersKronig or None
        Whether E' and E'' belong together.
    superposition : Superposition or None
        Where isotherms were shifted.
    laws : tuple of ShiftComparison
        Table, WLF and Arrhenius on the shifts, the best first; empty without shifts.
    understood : tuple of str
        What was read from each file, one sentence a decision.
    rows : MeasuredRows
        Every row as measured, with its shift.
    files : tuple of str
        That the rows are numbered by.
    metadata : mapping of str to str
        What the files state of themselves.
    """

    compound: RubberCompound
    fit: PronyFit
    consistency: KramersKronig | None
    superposition: Superposition | None
    laws: tuple[ShiftComparison, ...]
    understood: tuple[str, ...]
    rows: MeasuredRows
    files: tuple[str, ...]
    metadata: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A compound of a Prony table, and what was read of it."""

    compound: RubberCompound
    understood: tuple[str, ...]


@checked
def from_files(data: Path | Sequence[Path], request: Request) -> Fitted | Tabulated:
    """Make a compound of what the files hold: a Prony table as it stands, anything else by `fit_file`.

    Parameters
    ----------
    data : Path or sequence of Path
        A file alone, or the files of one rubber.
    request : Request
        What they are to become; of a table name, reference, shift, strain, ν and equilibrium modulus.

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
    several = request.shift is not None or request.strain is not None
    read = read_answered(paths[0], request.reading, poisson_ratio=request.poisson_ratio, several=several)
    return _tabulated(read, request) if read.kind == "Prony series" else fit_file(paths, request)


def _tabulated(read: DmaData, request: Request) -> Tabulated:
    if read.time is None or read.modulus is None:
        raise InputError(f"{read.source}: holds no relaxation times with their moduli")
    equilibrium = request.equilibrium
    if equilibrium is None:
        if read.instantaneous is None:
            raise InputError(
                f"{read.source}: E_e is not stated: add a column 'E_0 [MPa]', or give --instantaneous or --equilibrium"
            )
        equilibrium = read.instantaneous - float(np.sum(read.modulus))
        if equilibrium <= 0.0:
            raise InputError(
                f"{read.source}: the moduli add up to more than E_0 = {_mega(read.instantaneous, 6)}"
            )
    shifts = None if request.shift is None else _of_kind(request.shift, "shift factors", request)
    strains = None if request.strain is None else _of_kind(request.strain, "strain sweep", request)
    series = PronySeries(equilibrium, read.modulus, read.time)
    window = tuple(1.0 / (2.0 * np.pi * float(t)) for t in (np.max(read.time), np.min(read.time)))
    described = _compound_of([read], request, _reference([read], request), series, window)
    described["missing"] = ["the measurement behind the table", "density"]
    _add_shift(described, None, shifts, _law_of_table(shifts, described, request))
    if strains is not None:
        described["strain_dependence"] = _strain(request, strains)
    return Tabulated(
        _compound(described, Path((shifts or read).source)),
        tuple(
            f"{Path(each.source).name}: {line}"
            for each in (read, shifts, strains)
            if each
            for line in each.understood
        ),
    )


def _law_of_table(
    shifts: DmaData | None, described: Mapping[str, Any], request: Request
) -> WLF | Arrhenius | None:
    reference = _kelvin(described["reference_temperature"])
    return _stored(_laws(None, shifts, reference), reference, request)


@checked
def fit_file(data: Path | Sequence[Path], request: Request) -> Fitted:
    """Fit the files of one rubber and describe the result as a compound.

    Parameters
    ----------
    data : Path or sequence of Path
        One master curve, or isotherms, sweeps at one temperature, relaxation curves and temperature sweeps in any
        number of files; files of shift factors and strain sweeps among them are taken as `shift` and `strain`. Of
        any layout `conveyor.laboratory.read_dma` understands.
    request : Request
        What they are to become.

    Raises
    ------
    InputError
        A file is refused or of another kind, or a value is missing or outside its range.
    NoSolutionError
        No solid fits the data.
    """
    paths = [data] if isinstance(data, Path) else list(data)
    read, shifts, strains, said = _read(paths, request)
    if request.terms_per_decade is not None and not 0.1 <= request.terms_per_decade <= 20.0:
        raise InputError(f"--terms-per-decade: got {request.terms_per_decade:g}, allowed: >= 0.1 and <= 20")
    reference = _reference(read, request)
    rows, superposition, told = _laid(read, shifts, reference, request)
    f, e1, e2 = rows.curve
    place = ", ".join(each.source for each in read)
    accepted = check_findings(place, (f, e1, e2), request.accept, 2.0 * (1.0 + request.poisson_ratio))
    fit = fit_prony(
        f, e1, e2, terms_per_decade=request.terms_per_decade, equilibrium=request.equilibrium,
        storage_error=request.storage_error, loss_error=request.loss_error,
    )  # fmt: skip
    laws = _laws(superposition, shifts, _kelvin(reference))
    law = _stored(laws, _kelvin(reference), request)
    # a law that stands in place of the table has no shifts of replicas
    band_of = superposition if law is None else None
    described = _described(read, request, (reference, fit), (rows, band_of))
    described["fit"]["method"] = "; ".join([described["fit"]["method"], *accepted, *said, *told])
    _add_shift(described, superposition, shifts, law)
    if strains is not None:
        described["strain_dependence"] = _strain(request, strains)
        described["missing"].remove("strain dependence")
    files = [file for file in (*read, shifts, strains) if file is not None]
    return Fitted(
        compound=_compound(described, Path((shifts or read[0]).source)),
        fit=fit,
        consistency=kramers_kronig(f, e1, e2) if testable(f) else None,
        superposition=superposition,
        laws=laws,
        understood=(
            *(f"{Path(file.source).name}: {line}" for file in files for line in file.understood),
            *(*said, *told, *accepted),
        ),
        rows=rows,
        files=tuple(Path(each.source).name for each in read),
        metadata={key: value for each in reversed(files) for key, value in each.metadata.items()},
    )


def _read(
    paths: Sequence[Path], request: Request
) -> tuple[list[DmaData], DmaData | None, DmaData | None, tuple[str, ...]]:
    """Files of curves, shift factors, strain sweeps; what was left out."""
    several = len(paths) > 1 or request.shift is not None or request.strain is not None
    files = [
        read_answered(p, request.reading, poisson_ratio=request.poisson_ratio, several=several) for p in paths
    ]
    curves = [file for file in files if file.kind in CURVES or len(files) == 1]
    others: dict[str, list[DmaData]] = {"shift factors": [], "strain sweep": []}
    for file in files:
        if file not in curves and file.kind not in others:
            raise InputError(f"{file.source}: holds a {file.kind}; it is read alone, not beside other files")
        if file not in curves:
            others[file.kind].append(file)
    for kind, path in (("shift factors", request.shift), ("strain sweep", request.strain)):
        if path is not None:
            others[kind].append(_of_kind(path, kind, request))
        if len(others[kind]) > 1:
            raise InputError(f"{others[kind][1].source}: a second file of {kind}; give one")
    if not curves:
        raise InputError(
            f"{paths[0]}: no file holds a master curve, isotherms, relaxation or a temperature sweep"
        )
    kept, said = without(curves, request.exclude)
    shifts, strains = (next(iter(others[kind]), None) for kind in others)
    return kept, shifts, strains, said


def _laid(
    read: Sequence[DmaData], shifts: DmaData | None, reference: str, request: Request
) -> tuple[MeasuredRows, Superposition | None, tuple[str, ...]]:
    """Every row with its shift, the superposition of isotherms, and what was done."""
    for each in read:
        if each.kind not in CURVES:
            raise InputError(
                f"{each.source}: holds a {each.kind}; a master curve or isotherms with E' and E'' over frequency are "
                "needed"
            )
    kelvin, whole = _kelvin(reference), _whole(read)
    ramps = [(k, each) for k, each in enumerate(read) if each.kind == "temperature sweep"]
    stated = {k: _kelvin(t) for k, each in enumerate(read) for _, t in _stated(each)}
    parts, said = ([], ()) if whole else sweeps(read, {0: kelvin} | stated if len(read) == 1 else stated)
    if request.vertical and len(parts) < 2:
        raise InputError(f"{read[0].source}: --vertical shifts isotherms; this file holds a {read[0].kind}")
    superposition = None
    dynamic = [part for part in parts if read[part.file].kind != "relaxation"]
    chain = dynamic if len(dynamic) > 1 else parts
    if len(chain) > 1:
        isotherms = [part.isotherm for part in chain]
        superposition = superpose(isotherms, kelvin, vertical=request.vertical, by=request.by)
        if shifts is not None:
            superposition, told = overridden(superposition, shifts)
            said += told
        _check_order(read, chain, superposition, request.by)
        for part in parts:
            low, high = superposition.temperatures[0], superposition.temperatures[-1]
            if part not in chain and (request.vertical or not low <= part.isotherm.temperature <= high):
                raise InputError(
                    f"{read[part.file].source}:{part.first_row}: relaxation beside isotherms is laid by their shift "
                    f"factors, {celsius(low):.0f} to {celsius(high):.0f} degC, without vertical shift; fit it alone, "
                    "or leave it out"
                )
    law = _law(superposition, shifts, kelvin, request) if superposition is not None or ramps else None
    if law is None and any(part.isotherm.temperature != kelvin for part in parts):
        raise InputError(f"{read[0].source}: one sweep; the reference is its temperature, leave out --at")
    rows, told = laid(
        parts, ramps, law, superposition, whole if whole is None else (read.index(whole), kelvin, whole)
    )
    return rows, superposition, (*said, *told)


def _whole(read: Sequence[DmaData]) -> DmaData | None:
    """The file that is a master curve as it stands: the only one beside temperature sweeps."""
    curves = [each for each in read if each.kind != "temperature sweep"]
    return curves[0] if len(curves) == 1 and curves[0].kind == "master curve" else None


def _law(
    superposition: Superposition | None, shifts: DmaData | None, reference: float, request: Request
) -> ShiftLaw | None:
    """The law that rows are laid by: the one asked for, of the shifts found or given; None without shifts."""
    stored = _stored(_laws(superposition, shifts, reference), reference, request)
    if stored is not None:
        return stored
    if superposition is not None:
        return ShiftTable(superposition.temperatures, superposition.log10_a_T, reference)
    if shifts is not None and shifts.temperature is not None and shifts.log10_a_T is not None:
        return ShiftTable(shifts.temperature, shifts.log10_a_T, reference)
    return None


def _stored(laws: Sequence[ShiftComparison], reference: float, request: Request) -> WLF | Arrhenius | None:
    """The formula that a person chose in place of the table, at the reference [K]."""
    if request.law == "table":
        return None
    if request.vertical:
        raise InputError(
            f"--law {request.law}: it has no vertical shift; keep the table, or leave out --vertical"
        )
    if not laws:
        raise InputError(
            f"--law {request.law}: shifts at {LEAST_TEMPERATURES} temperatures and more are needed"
        )
    (found,) = (law for law in laws if law.name.lower() == request.law)
    if isinstance(found.law, WLF):
        c2 = found.law.c2 + reference - found.law.reference
        return WLF(found.law.c1 * found.law.c2 / c2, c2, reference)
    if isinstance(found.law, Arrhenius):
        return Arrhenius(found.law.activation_energy, reference)
    raise InputError(f"--law {request.law}: the shifts do not follow it: {found.remark}")


def _reference(read: Sequence[DmaData], request: Request) -> str:
    """Reference temperature: given, or stated by a file; one that contradicts the other is refused."""
    given = request.reference_temperature
    if given is not None:
        _kelvin(given)
    whole = _whole(read)
    if whole is None and (len(read) > 1 or read[0].kind == "isotherms"):
        stated = [text for each in read if each.kind == "isotherms" for _, text in _stated(each)]
        if given or stated:
            return given or stated[0]
        told = {k: _kelvin(text) for k, each in enumerate(read) for _, text in _stated(each)}
        middle = sorted(part.isotherm.temperature for part in sweeps(read, told)[0])
        if middle:
            return f"{middle[len(middle) // 2] - ZERO_CELSIUS:.{_DIGITS}g} degC"
    one = whole or read[0]
    if one.kind == "temperature sweep" and given is None:
        raise InputError(f"{one.source}: a temperature sweep needs isotherms beside it, or --shift and --at")
    told_of = [*_stated(one), *([] if given is None else [("--at", given)])]
    if not told_of:
        raise InputError(
            f'{one.source}: the temperature of the master curve is not stated; give it, e.g. --at "20 degC", or write '
            '"# reference_temperature: 20 degC" into the file'
        )
    place, first = told_of[0]
    for other, temperature in told_of[1:]:
        if abs(_kelvin(temperature) - _kelvin(first)) > SAME_TEMPERATURE:
            raise InputError(
                f"{place}: the temperature is {first}, but {other} says {temperature}: "
                + ("leave out --at, or correct the file" if other == "--at" else "correct one of them")
            )
    return given or first


def _kelvin(temperature: str, place: str = "--at") -> float:
    kelvin = in_si(temperature, "temperature")
    if kelvin <= 0.0:
        raise InputError(f"{place}: got {temperature}, a temperature above absolute zero is needed")
    return kelvin


def _stated(read: DmaData) -> Iterator[tuple[str, str]]:
    """Where a file states the temperature of its curve, and which: a remark, a column that does not vary."""
    data = read.source.partition("[")[0]
    for key, value in read.metadata.items():
        if re.sub(r"[\s_-]", "", key.lower()) not in _REFERENCE_NAMES or not re.search(r"\d", value):
            continue
        number = _NUMBER.match(value)
        place = f'{data}:{read.metadata_rows[key]}: "{key}"'
        if number is None or number[2] is None:
            raise InputError(
                f'{place}: {value[:40]!r} is no temperature with its unit; write it as in "40 degC"'
            )
        temperature = f"{number[1].replace(',', '.')} {number[2].replace('°', 'deg')}"
        _kelvin(temperature, place)
        yield place, temperature
    constant = read.kind in {"master curve", "relaxation"} and read.temperature is not None
    if constant and read.temperature is not None and float(np.ptp(read.temperature)) <= ISOTHERM_GAP:
        mean = float(np.mean(read.temperature)) - ZERO_CELSIUS
        yield f"{data}:{read.row_numbers[0]}: column of the temperature", f"{mean:.{_DIGITS}g} degC"


def _compound(described: dict[str, Any], shifted_by: Path) -> RubberCompound:
    """The compound; what contradicts itself in its shift is a matter of the file the shift came from."""
    try:
        return RubberCompound.from_data(described)
    except InputError as error:
        if not str(error).startswith("shift"):
            raise
        raise InputError(f"{shifted_by}: {error}") from None


def _check_order(read: Sequence[DmaData], parts: Sequence[Sweep], found: Superposition, by: str) -> None:
    """Refuse shifts that do not fall with temperature, with the exchange of two temperatures that would mend them."""
    shifts = found.log10_a_T
    rising = np.flatnonzero(np.diff(shifts) >= 0.0)
    if not rising.size:
        return
    names = [f"{celsius(t):.2f} degC" for t in found.temperatures.tolist()]
    ordered = sorted(parts, key=lambda part: part.isotherm.temperature)
    rows, cold = [part.first_row for part in ordered], int(rising[0])
    advice = (
        "its rows may carry another temperature, or the isotherms are too alike to be placed; correct the "
        "temperatures, or leave one out"
    )
    for i, j in combinations(range(shifts.size), 2):
        order = np.arange(shifts.size)
        order[[i, j]] = j, i
        if np.all(np.diff(shifts[order]) < 0.0):
            advice = (
                f"with the temperatures of the isotherms at {names[i]} (from row {rows[i]} on) and {names[j]} "
                f"(from row {rows[j]} on) exchanged all shifts fall: are they exchanged in the file?"
            )
            break
    if by != "both":
        advice += f" Or place them by both moduli, without --by {by}"
    place = f"{read[ordered[cold + 1].file].source}:{rows[cold + 1]}"
    raise InputError(
        f"{place}: the isotherm at {names[cold + 1]} lies on the master curve as if it were colder "
        f"than the one at {names[cold]} (log10 a_T {shifts[cold + 1]:+.3f} and {shifts[cold]:+.3f}); {advice}"
    )


def _of_kind(path: Path, kind: str, request: Request) -> DmaData:
    answers = {key: value for key, value in request.reading.items() if key not in {"kind", "sheet"}}
    read = read_answered(path, answers, poisson_ratio=request.poisson_ratio, several=True)
    if read.kind != kind:
        raise InputError(f"{path}: holds {read.kind}, {kind} are needed here")
    return read


def _described(
    read: Sequence[DmaData],
    request: Request,
    found: tuple[str, PronyFit],
    shifted: tuple[MeasuredRows, Superposition | None],
) -> dict[str, Any]:
    reference, fit = found
    described = _compound_of(read, request, reference, fit.series, fit.window)
    if request.replicas:
        described["prony"]["band"] = _band(fit, *shifted, request.replicas)
    described["fit"] = {
        "storage_rms": _six(round(fit.storage.rms, _ERROR_DECIMALS)),
        "loss_rms": _six(round(fit.loss.rms, _ERROR_DECIMALS)),
        "storage_worst": _six(round(abs(fit.storage.worst), _ERROR_DECIMALS)),
        "loss_worst": _six(round(abs(fit.loss.worst), _ERROR_DECIMALS)),
        "method": _method(fit, request),
    }
    described["missing"] = ["strain dependence", "density"]
    return described


def _compound_of(
    read: Sequence[DmaData], request: Request, reference: str, series: PronySeries, window: Sequence[float]
) -> dict[str, Any]:
    """What a compound file says of a series at its reference temperature."""
    stated = {key: value for each in reversed(read) for key, value in each.metadata.items()}
    prony: dict[str, Any] = {
        "equilibrium": _mega(series.equilibrium),
        "terms": [
            {"modulus": _mega(modulus), "time": f"{time:.{_DIGITS}g} s"}
            for modulus, time in zip(series.moduli, series.times, strict=True)
        ],
    }
    return {
        "name": request.name,
        "kind": "measured",
        "source": {
            "origin": stated.get("origin", _UNKNOWN),
            "licence": stated.get("licence", _UNKNOWN),
            "data": ", ".join(Path(each.source.partition("[")[0]).name for each in read),
        },
        "poisson_ratio": request.poisson_ratio,
        "strain": stated.get("strain", _UNKNOWN),
        "reference_temperature": reference,
        "prony": prony,
        "range": {
            "frequency": [f"{limit:.{_DIGITS}g} Hz" for limit in window],
            "temperature": [reference] * 2,
        },
    }


def _mega(modulus: float, digits: int = _DIGITS) -> str:
    return f"{modulus / 1e6:.{digits}g} MPa"


def _six(value: float) -> float:
    return float(f"{value:.6g}")


def _band(
    fit: PronyFit, rows: MeasuredRows, superposition: Superposition | None, replicas: int
) -> dict[str, Any]:
    band = bootstrap(fit, superposition, rows.temperature, replicas=replicas)
    described: dict[str, Any] = {
        "method": METHOD,
        "equilibrium": [_mega(modulus, _BAND_DIGITS) for modulus in band.equilibrium],
        "unit": "MPa",
        "moduli": [[_six(modulus / 1e6) for modulus in row] for row in band.moduli],
    }
    shifts = {"log10_aT": band.log10_a_T, "log10_bT": band.log10_b_T}
    described |= {
        key: [[_six(y) for y in row] for row in rows] for key, rows in shifts.items() if rows is not None
    }
    return described


def _method(fit: PronyFit, request: Request) -> str:
    equilibrium = "free" if request.equilibrium is None else "held"
    left = f"leaves {fit.residual:.1%} rms of both, the best positive spectrum of all {fit.consistency_floor:.1%}"
    if request.terms_per_decade is not None:
        return (
            f"NNLS on relative errors of E' and E'', {request.terms_per_decade:g} times per decade inside the data "
            f"window, equilibrium {equilibrium}; {left}"
        )
    scatter = (
        ""
        if fit.storage_noise is None or fit.loss_noise is None
        else f"; scatter of the data from row to row {fit.storage_noise:.1%} (E') and {fit.loss_noise:.1%} (E'')"
    )
    return (
        f"NNLS on errors of E' and E'' relative to the fit, {fit.candidates[0].terms_per_decade:g} relaxation times "
        f"per decade to a decade beyond the data window and penalty {fit.regularisation:g} on the curvature of the "
        f"spectrum by AICc, outliers without weight, equilibrium {equilibrium}; {left}{scatter}"
    )


def _add_shift(
    described: dict[str, Any],
    superposition: Superposition | None,
    shifts: DmaData | None,
    law: WLF | Arrhenius | None,
) -> None:
    """Shift table and the range of temperature that it opens."""
    vertical: Array | None = None
    if superposition is not None:
        kelvin, decades = superposition.temperatures, superposition.log10_a_T
        vertical = superposition.log10_b_T if np.any(superposition.log10_b_T) else None
    elif shifts is not None and shifts.temperature is not None and shifts.log10_a_T is not None:
        kelvin, decades, vertical = shifts.temperature, shifts.log10_a_T, shifts.log10_b_T
    else:
        described["missing"].append("temperature shift: known at the reference temperature only")
        return
    order = np.argsort(kelvin)
    temperatures = [f"{t - ZERO_CELSIUS:.{_DIGITS}g} degC" for t in kelvin[order]]
    described["range"]["temperature"] = [temperatures[0], temperatures[-1]]
    if isinstance(law, WLF):
        described["shift"] = {
            "law": "wlf",
            "c1": float(f"{law.c1:.{_DIGITS}g}"),
            "c2": f"{law.c2:.{_DIGITS}g} K",
        }
    elif isinstance(law, Arrhenius):
        energy = f"{law.activation_energy / 1e3:.{_DIGITS}g} kJ/mol"
        described["shift"] = {"law": "arrhenius", "activation_energy": energy}
    if law is not None:
        described["missing"] += ["vertical shift (none applied)", "error of the shift in the band"]
        return
    described["shift"] = {
        "law": "table",
        "temperature": temperatures,
        "log10_aT": [float(f"{y:.{_DIGITS}g}") for y in decades[order]],
    }
    if vertical is None:
        described["missing"].append("vertical shift (none applied)")
    else:
        described["shift"]["log10_bT"] = [float(f"{y:.{_DIGITS}g}") for y in vertical[order]]


def _laws(
    superposition: Superposition | None, shifts: DmaData | None, reference: float
) -> tuple[ShiftComparison, ...]:
    """How well each law follows the shifts; with too few of them none can be judged."""
    if superposition is not None:
        kelvin, decades = superposition.temperatures, superposition.log10_a_T
        error = np.maximum(superposition.log10_a_T_error, _SMALLEST_ERROR)
    elif shifts is not None and shifts.temperature is not None and shifts.log10_a_T is not None:
        kelvin, decades, error = shifts.temperature, shifts.log10_a_T, None
    else:
        return ()
    if kelvin.size < LEAST_TEMPERATURES:
        return ()
    return compare_shift_laws(kelvin, decades, reference, error=error)


def _strain(request: Request, sweeps: DmaData) -> dict[str, Any]:
    """Strain dependence: runs of four rows and more; shorter ones are strays."""
    if request.reference_strain is None:
        raise InputError(
            f"{request.strain}: at which strain was the master curve measured? Give it, e.g. "
            '--reference-strain "0.1 %"; everything is counted from it'
        )
    runs = [run for run in sweeps.strain_sweeps() if run.strain.size >= _FEWEST_STRAINS]
    if not runs or any(run.temperature is None or run.frequency is None for run in runs):
        raise InputError(
            f"{request.strain}: sweeps of four strains and more, each at a stated temperature and frequency"
        )
    return {
        "reference_strain": request.reference_strain,
        "reference_note": sweeps.metadata.get("reference_strain", ""),
        "source": Path(sweeps.source).name,
        "sweeps": [
            {
                "temperature": f"{(run.temperature or 0.0) - ZERO_CELSIUS:.6g} degC",
                "frequency": f"{run.frequency:.6g} Hz",
                "strain": [_six(100.0 * strain) for strain in run.strain],
                "unit": "MPa",
                "storage": [_six(modulus / 1e6) for modulus in run.storage],
                "loss": [_six(modulus / 1e6) for modulus in run.loss],
            }
            for run in runs
        ],
    }
