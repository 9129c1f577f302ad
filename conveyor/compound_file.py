"""From laboratory files to a compound: master curve, fit, band, shift, strain, provenance, and what is not known."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
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
from conveyor.models import RubberCompound
from conveyor.rubber import (
    Isotherm,
    KramersKronig,
    PronyFit,
    ShiftComparison,
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
    frequency, storage, loss : ndarray
        The master curve that was fitted [Hz], [Pa], [Pa].
    """

    compound: RubberCompound
    fit: PronyFit
    consistency: KramersKronig | None
    superposition: Superposition | None
    laws: tuple[ShiftComparison, ...]
    understood: tuple[str, ...]
    frequency: Array
    storage: Array
    loss: Array


@checked
def fit_file(data: Path, request: Request) -> Fitted:
    """Fit a master curve or isotherms and describe the result as a compound.

    Parameters
    ----------
    data : Path
        Master curve or isotherms, of any layout `conveyor.laboratory.read_dma` understands.
    request : Request
        What it is to become.

    Raises
    ------
    InputError
        A file is refused or of another kind, or a value is missing or outside its range.
    NoSolutionError
        No solid fits the data.
    """
    several = request.shift is not None or request.strain is not None
    read = read_answered(data, request.reading, poisson_ratio=request.poisson_ratio, several=several)
    if request.terms_per_decade is not None and not 0.1 <= request.terms_per_decade <= 20.0:
        raise InputError(f"--terms-per-decade: got {request.terms_per_decade:g}, allowed: >= 0.1 and <= 20")
    reference = _reference(data, read, request)
    superposition = _superposed(data, read, reference, request)
    f, e1, e2 = _rows(data, read, superposition)
    accepted = check_findings(str(data), (f, e1, e2), request.accept, 2.0 * (1.0 + request.poisson_ratio))
    fit = fit_prony(f, e1, e2, terms_per_decade=request.terms_per_decade, equilibrium=request.equilibrium)
    shifts = None if request.shift is None else _of_kind(request.shift, "shift factors", request)
    sweeps = None if request.strain is None else _of_kind(request.strain, "strain sweep", request)
    described = _described(data, read, request, (reference, fit), superposition)
    described["fit"]["method"] = "; ".join([described["fit"]["method"], *accepted])
    _add_shift(described, superposition, shifts)
    if sweeps is not None:
        described["strain_dependence"] = _strain(request, sweeps)
        described["missing"].remove("strain dependence")
    files = [file for file in (read, shifts, sweeps) if file is not None]
    return Fitted(
        compound=_compound(described, data if request.shift is None else request.shift),
        fit=fit,
        consistency=kramers_kronig(f, e1, e2) if testable(f) else None,
        superposition=superposition,
        laws=_laws(superposition, shifts, _kelvin(reference)),
        understood=tuple(f"{Path(file.source).name}: {line}" for file in files for line in file.understood)
        + accepted,
        frequency=f,
        storage=e1,
        loss=e2,
    )


def _reference(data: Path, read: DmaData, request: Request) -> str:
    """Reference temperature: given, or stated by the file; one that contradicts the other is refused."""
    given = request.reference_temperature
    if given is not None:
        _kelvin(given)
    stated = dict(_stated(data, read))
    if read.kind == "isotherms":
        if given or stated:
            return given or next(iter(stated.values()))
        middle = sorted(sweep.temperature for sweep in read.isotherms())
        return f"{middle[len(middle) // 2] - ZERO_CELSIUS:.{_DIGITS}g} degC"
    told = [*stated.items(), *([] if given is None else [("--at", given)])]
    if not told:
        raise InputError(
            f'{data}: the temperature of the master curve is not stated; give it, e.g. --at "20 degC", or write '
            '"# reference_temperature: 20 degC" into the file'
        )
    place, first = told[0]
    for other, temperature in told[1:]:
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


def _stated(data: Path, read: DmaData) -> Iterator[tuple[str, str]]:
    """Where a file states the temperature of its curve, and which: a remark, a column that does not vary."""
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
    constant = read.kind == "master curve" and read.temperature is not None
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


def _superposed(data: Path, read: DmaData, reference: str, request: Request) -> Superposition | None:
    if read.kind != "isotherms":
        if request.vertical:
            raise InputError(f"{data}: --vertical shifts isotherms; this file holds a {read.kind}")
        return None
    if request.shift is not None:
        raise InputError(f"{data}: holds isotherms, their shift is found from them; leave out --shift")
    sweeps = [Isotherm(s.temperature, s.frequency, s.storage, s.loss) for s in read.isotherms()]
    found = superpose(sweeps, _kelvin(reference), vertical=request.vertical, by=request.by)
    _check_order(data, read, found, request.by)
    return found


def _check_order(data: Path, read: DmaData, found: Superposition, by: str) -> None:
    """Refuse shifts that do not fall with temperature, with the exchange of two temperatures that would mend them."""
    shifts = found.log10_a_T
    rising = np.flatnonzero(np.diff(shifts) >= 0.0)
    if not rising.size:
        return
    names = [f"{celsius(t):.2f} degC" for t in found.temperatures.tolist()]
    rows = [min(sweep.row_numbers) for sweep in read.isotherms()]
    cold = int(rising[0])
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
    raise InputError(
        f"{data}:{rows[cold + 1]}: the isotherm at {names[cold + 1]} lies on the master curve as if it were colder "
        f"than the one at {names[cold]} (log10 a_T {shifts[cold + 1]:+.3f} and {shifts[cold]:+.3f}); {advice}"
    )


def _rows(data: Path, read: DmaData, found: Superposition | None) -> tuple[Array, Array, Array]:
    if found is not None:
        return found.frequency, found.storage, found.loss
    if read.kind != "master curve" or read.frequency is None or read.storage is None or read.loss is None:
        raise InputError(
            f"{data}: holds a {read.kind}; a master curve or isotherms with E' and E'' over frequency are needed"
        )
    return read.frequency, read.storage, read.loss


def _of_kind(path: Path, kind: str, request: Request) -> DmaData:
    answers = {key: value for key, value in request.reading.items() if key not in {"kind", "sheet"}}
    read = read_answered(path, answers, poisson_ratio=request.poisson_ratio, several=True)
    if read.kind != kind:
        raise InputError(f"{path}: holds {read.kind}, {kind} are needed here")
    return read


def _described(
    data: Path,
    read: DmaData,
    request: Request,
    found: tuple[str, PronyFit],
    superposition: Superposition | None,
) -> dict[str, Any]:
    reference, fit = found
    series = fit.series
    prony: dict[str, Any] = {
        "equilibrium": _mega(series.equilibrium),
        "terms": [
            {"modulus": _mega(modulus), "time": f"{time:.{_DIGITS}g} s"}
            for modulus, time in zip(series.moduli, series.times, strict=True)
        ],
    }
    if request.replicas:
        prony["band"] = _band(fit, superposition, request.replicas)
    return {
        "name": request.name,
        "kind": "measured",
        "source": {
            "origin": read.metadata.get("origin", _UNKNOWN),
            "licence": read.metadata.get("licence", _UNKNOWN),
            "data": data.name,
        },
        "poisson_ratio": request.poisson_ratio,
        "strain": read.metadata.get("strain", _UNKNOWN),
        "reference_temperature": reference,
        "prony": prony,
        "range": {
            "frequency": [f"{limit:.{_DIGITS}g} Hz" for limit in fit.window],
            "temperature": [reference] * 2,
        },
        "fit": {
            "storage_rms": _six(round(fit.storage.rms, _ERROR_DECIMALS)),
            "loss_rms": _six(round(fit.loss.rms, _ERROR_DECIMALS)),
            "storage_worst": _six(round(abs(fit.storage.worst), _ERROR_DECIMALS)),
            "loss_worst": _six(round(abs(fit.loss.worst), _ERROR_DECIMALS)),
            "method": _method(fit, request),
        },
        "missing": ["strain dependence", "density"],
    }


def _mega(modulus: float, digits: int = _DIGITS) -> str:
    return f"{modulus / 1e6:.{digits}g} MPa"


def _six(value: float) -> float:
    return float(f"{value:.6g}")


def _band(fit: PronyFit, superposition: Superposition | None, replicas: int) -> dict[str, Any]:
    band = bootstrap(fit, superposition, replicas=replicas)
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
    described: dict[str, Any], superposition: Superposition | None, shifts: DmaData | None
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
    described["shift"] = {
        "law": "table",
        "temperature": temperatures,
        "log10_aT": [float(f"{y:.{_DIGITS}g}") for y in decades[order]],
    }
    if vertical is None:
        described["missing"].append("vertical shift (none applied)")
    else:
        described["shift"]["log10_bT"] = [float(f"{y:.{_DIGITS}g}") for y in vertical[order]]
    described["range"]["temperature"] = [temperatures[0], temperatures[-1]]


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
