"""Choose temperature, shift and law by which each file of one rubber is shifted to the master curve."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations

import numpy as np

from conveyor.errors import InputError
from conveyor.fitting.compound_file import SERIES_DIGITS, Array
from conveyor.fitting.measured_rows import (
    CURVE_KINDS,
    FrequencySweep,
    MeasuredRows,
    average_repeats,
    entropic_shift,
    frequency_sweeps,
    override_shifts,
    shift_factors,
    shift_rows,
)
from conveyor.fitting.request import Request
from conveyor.laboratory import DmaData
from conveyor.laboratory.arrange import SAME_TEMPERATURE as SAME_PRINTED
from conveyor.laboratory.groups import ISOTHERM_GAP
from conveyor.rubber import (
    WLF,
    Arrhenius,
    Isotherm,
    ShiftComparison,
    ShiftLaw,
    ShiftTable,
    Superposition,
    compare_shift_laws,
    fit_arrhenius,
    fit_wlf,
    superpose,
)
from conveyor.rubber.master_curve import TrendSlope
from conveyor.rubber.shift_laws import LEAST_TEMPERATURES
from conveyor.rubber.strain import SAME_TEMPERATURE
from conveyor.units import read_si
from conveyor.units.sentences import ZERO_CELSIUS, percent, to_celsius

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
_ENTROPIC_NOTE = "vertical shift of an entropic network, b_T = T/T_ref, each row at the temperature of its shift factor"
_TEMPERATURE_TEXT = re.compile(r"\s*([+-]?\d+(?:[.,]\d*)?)\s*(degC|degF|K|°C|°F)?(?![\w.,])")
_SMALLEST_ERROR = 1e-3  # of log10 a_T in comparing laws: a measured reference has none of its own [decades]


def master_curve_rows(
    read: Sequence[DmaData], shifts: DmaData | None, reference: str, request: Request
) -> tuple[MeasuredRows, Superposition | None, tuple[str, ...]]:
    """Shift the rows of all files: rows with their shift, superposition of isotherms, and notes."""
    for each in read:
        if each.kind not in CURVE_KINDS:
            raise InputError(
                f"{each.source}: holds a {each.kind}; a master curve or isotherms with E' and E'' over frequency are "
                "needed"
            )
    kelvin, whole = parse_kelvin(reference), whole_master_curve(read)
    ramps = [(k, each) for k, each in enumerate(read) if each.kind == "temperature sweep"]
    stated = {k: parse_kelvin(t) for k, each in enumerate(read) for _, t in _stated_temperatures(each)}
    parts, said = (
        ([], ()) if whole else _collect_sweeps(read, {0: kelvin} | stated if len(read) == 1 else stated, request)
    )
    if request.vertical and whole is None and len(parts) < 2:
        raise InputError(f"{read[0].source}: --vertical shifts isotherms; this file holds a {read[0].kind}")
    superposition = None
    dynamic = [part for part in parts if read[part.file].kind != "relaxation"]
    chain = dynamic if len(dynamic) > 1 else parts
    if len(chain) > 1:
        _check_sweeps(read, chain)
        isotherms = [part.isotherm for part in chain]
        superposition = superpose(isotherms, kelvin, vertical=request.vertical, by=request.by)
        if shifts is not None:
            superposition, told = override_shifts(superposition, shifts)
            said += told
        _check_order(read, chain, superposition, request.by)
        for part in parts:
            low, high = superposition.temperatures[0], superposition.temperatures[-1]
            if part not in chain and (request.vertical or not low <= part.isotherm.temperature <= high):
                raise InputError(
                    f"{read[part.file].source}:{part.first_row}: relaxation beside isotherms is laid by their shift "
                    f"factors, {to_celsius(low):.0f} to {to_celsius(high):.0f} degC, without vertical shift; fit it "
                    f"alone, "
                    "or leave it out"
                )
    law = _law_of_rows(superposition, shifts, kelvin, request) if superposition is not None or ramps else None
    if law is None and any(part.isotherm.temperature != kelvin for part in parts):
        raise InputError(f"{read[0].source}: one sweep; the reference is its temperature, leave out --at")
    curve = None
    if whole is not None:
        b = 0.0 if not request.vertical else entropic_shift(whole, shifts, kelvin)
        curve = (read.index(whole), kelvin, whole, b)
        said += (_ENTROPIC_NOTE,) if request.vertical else ()
    rows, told = shift_rows(parts, ramps, law, superposition, curve)
    return rows, superposition, (*said, *told)


def _collect_sweeps(
    read: Sequence[DmaData], stated: Mapping[int, float], request: Request
) -> tuple[list[FrequencySweep], tuple[str, ...]]:
    """Sweeps of all files, repeats averaged on request, and notes."""
    parts, said = frequency_sweeps(read, stated)
    if not request.repeats:
        return parts, said
    relaxed = [part for part in parts if read[part.file].kind == "relaxation"]
    made, told = average_repeats([part for part in parts if part not in relaxed])
    return [*made, *relaxed], (*said, *told)


def whole_master_curve(read: Sequence[DmaData]) -> DmaData | None:
    """The single master-curve file, if any: the only file that is no temperature sweep."""
    curves = [each for each in read if each.kind != "temperature sweep"]
    return curves[0] if len(curves) == 1 and curves[0].kind == "master curve" else None


def _law_of_rows(
    superposition: Superposition | None, shifts: DmaData | None, reference: float, request: Request
) -> ShiftLaw | None:
    """Law that shifts the rows: the requested one, from superposition or given shifts; None without shifts."""
    laws = () if request.law == "table" else compare_laws(superposition, shifts, reference)
    stored = chosen_law(laws, reference, request)
    if stored is not None:
        return stored
    known = shift_factors(superposition, shifts)
    return None if known is None else ShiftTable(known.temperatures, known.log10_a_T, reference)


def chosen_law(laws: Sequence[ShiftComparison], reference: float, request: Request) -> WLF | Arrhenius | None:
    """Formula requested in place of the table, at the reference [K]; None for the table."""
    if request.law == "table":
        return None
    if request.vertical:
        raise InputError(f"--law {request.law}: it has no vertical shift; keep the table, or leave out --vertical")
    if not laws:
        raise InputError(f"--law {request.law}: shifts at {LEAST_TEMPERATURES} temperatures and more are needed")
    (law_asked,) = (law for law in laws if law.name.lower() == request.law)
    if isinstance(law_asked.law, WLF | Arrhenius):
        return _law_at_reference(law_asked.law, reference)
    raise InputError(f"--law {request.law}: the shifts do not follow it: {law_asked.remark}")


def law_constants(comparison: ShiftComparison, reference: float) -> str:
    """Constants of a formula of a_T with its reference temperature, that of the master curve [K]; "" for the table."""
    law = comparison.law
    if not isinstance(law, WLF | Arrhenius):
        return ""
    if isinstance(law, Arrhenius) or law.c2 + reference > law.reference:
        law = _law_at_reference(law, reference)
    at = f"at {to_celsius(law.reference):.4g} °C"
    if isinstance(law, WLF):
        return f"c1 {law.c1:.4g}, c2 {law.c2:.4g} K {at}"
    return f"activation energy {law.activation_energy / 1e3:.4g} kJ/mol {at}"


def _law_at_reference(law: WLF | Arrhenius, reference: float) -> WLF | Arrhenius:
    """Same law with a_T = 1 at another temperature [K]."""
    if isinstance(law, Arrhenius):
        return Arrhenius(law.activation_energy, reference)
    c2 = law.c2 + reference - law.reference
    return WLF(law.c1 * law.c2 / c2, c2, reference)


def law_fitter(superposition: Superposition, law: WLF | Arrhenius) -> Callable[[Array], WLF | Arrhenius]:
    """Function that fits a law of the same kind to other log10 a_T of the isotherms, as `compare_laws` does."""
    kelvin, fit = superposition.temperatures, fit_wlf if isinstance(law, WLF) else fit_arrhenius
    nearest = int(np.argmin(np.abs(kelvin - law.reference)))
    error = np.maximum(superposition.log10_a_T_error, _SMALLEST_ERROR)

    def made(decades: Array) -> WLF | Arrhenius:
        return _law_at_reference(
            fit(kelvin, decades - decades[nearest], kelvin[nearest], error=error).law, law.reference
        )

    return made


def find_reference(read: Sequence[DmaData], request: Request) -> str:
    """Reference temperature, given or stated by a file; contradictions are refused."""
    given = request.reference_temperature
    if given is not None:
        parse_kelvin(given)
    whole = whole_master_curve(read)
    if whole is None and (len(read) > 1 or read[0].kind == "isotherms"):
        stated = [text for each in read if each.kind == "isotherms" for _, text in _stated_temperatures(each)]
        if given or stated:
            return given or stated[0]
        told = {k: parse_kelvin(text) for k, each in enumerate(read) for _, text in _stated_temperatures(each)}
        middle = sorted(part.isotherm.temperature for part in frequency_sweeps(read, told)[0])
        if middle:
            return f"{middle[len(middle) // 2] - ZERO_CELSIUS:.{SERIES_DIGITS}g} degC"
    one = whole or read[0]
    if one.kind == "temperature sweep" and given is None:
        raise InputError(f"{one.source}: a temperature sweep needs isotherms beside it, or --shift and --at")
    told_of = [*_stated_temperatures(one), *([] if given is None else [("--at", given)])]
    if not told_of:
        raise InputError(
            f'{one.source}: the temperature of the master curve is not stated; give it, e.g. --at "20 degC", or write '
            '"# reference_temperature: 20 degC" into the file'
        )
    place, first = told_of[0]
    for other, temperature in told_of[1:]:
        if abs(parse_kelvin(temperature) - parse_kelvin(first)) > SAME_TEMPERATURE:
            raise InputError(
                f"{place}: the temperature is {first}, but {other} says {temperature}: "
                + ("leave out --at, or correct the file" if other == "--at" else "correct one of them")
            )
    return given or first


def parse_kelvin(temperature: str, place: str = "--at") -> float:
    """Parse a temperature with its unit [K]; refused below absolute zero."""
    kelvin = read_si(temperature, "temperature", place)
    if kelvin <= 0.0:
        raise InputError(f"{place}: got {temperature}, a temperature above absolute zero is needed")
    return kelvin


def _stated_temperatures(read: DmaData) -> Iterator[tuple[str, str]]:
    """Temperatures stated by a file in a remark or a constant column: place and text."""
    data = read.source.partition("[")[0]
    for key, value in read.metadata.items():
        if re.sub(r"[\s_-]", "", key.lower()) not in _REFERENCE_NAMES or not re.search(r"\d", value):
            continue
        number = _TEMPERATURE_TEXT.match(value)
        place = f'{data}:{read.metadata_rows[key]}: "{key}"'
        if number is None or number[2] is None:
            raise InputError(f'{place}: {value[:40]!r} is no temperature with its unit; write it as in "40 degC"')
        temperature = f"{number[1].replace(',', '.')} {number[2].replace('°', 'deg')}"
        parse_kelvin(temperature, place)
        yield place, temperature
    constant = read.kind in {"master curve", "relaxation"} and read.temperature is not None
    if constant and read.temperature is not None and float(np.ptp(read.temperature)) <= ISOTHERM_GAP:
        mean = float(np.mean(read.temperature)) - ZERO_CELSIUS
        yield f"{data}:{read.row_numbers[0]}: column of the temperature", f"{mean:.{SERIES_DIGITS}g} degC"


def _check_sweeps(read: Sequence[DmaData], chain: Sequence[FrequencySweep]) -> None:
    """Refuse a second isotherm at one temperature."""
    in_files = sorted(chain, key=lambda part: (part.file, part.first_row))
    for first, second in combinations(in_files, 2):
        t = second.isotherm.temperature
        if abs(t - first.isotherm.temperature) < SAME_PRINTED:
            begins = f"{read[first.file].source}:{first.first_row}"
            place = f"{read[second.file].source}:{second.first_row}"
            if _repeats_rows(first.isotherm, second.isotherm):
                raise InputError(
                    f"{place}: its rows at {to_celsius(t):.2f} degC repeat those that begin at {begins} digit for "
                    "digit: delete them, or leave them out with --exclude"
                )
            raise InputError(
                f"{place}: a second sweep at {to_celsius(t):.2f} degC, the first "
                f"begins at {begins}: leave one of them out with --exclude, or have repeats averaged by --repeats"
            )


def _repeats_rows(first: Isotherm, second: Isotherm) -> bool:
    """True if every row of an isotherm stands in another, digit for digit."""
    known, again = (
        {tuple(row) for row in np.array([one.frequency, one.storage, one.loss]).T.tolist()} for one in (first, second)
    )
    return again <= known


def _check_order(
    read: Sequence[DmaData], parts: Sequence[FrequencySweep], superposition: Superposition, by: str
) -> None:
    """Refuse shifts that do not fall with temperature; advise an exchange of two temperatures if it helps."""
    shifts = superposition.log10_a_T
    rising = np.flatnonzero(np.diff(shifts) >= 0.0)
    if not rising.size:
        return
    names = [f"{to_celsius(t):.2f} degC" for t in superposition.temperatures.tolist()]
    ordered = sorted(parts, key=lambda part: part.isotherm.temperature)
    rows, cold = [part.first_row for part in ordered], int(rising[0])
    advice = (
        "its rows may carry another temperature, or the isotherms are too alike to be placed; correct the "
        "temperatures, or leave one out"
    )
    near = float(np.diff(superposition.temperatures)[cold]) <= ISOTHERM_GAP
    if near:
        advice = "are they repeats of one temperature? --repeats averages them"
    for i, j in combinations(range(shifts.size), 2) if not near else ():
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


def compare_laws(
    superposition: Superposition | None, shifts: DmaData | None, reference: float
) -> tuple[ShiftComparison, ...]:
    """Compare the shift laws on the shifts; empty with too few shifts."""
    known = shift_factors(superposition, shifts)
    if known is None or known.temperatures.size < LEAST_TEMPERATURES:
        return ()
    error = None if known.error is None else np.maximum(known.error, _SMALLEST_ERROR)
    return compare_shift_laws(known.temperatures, known.log10_a_T, reference, error=error)


def slope_text(slope: TrendSlope) -> str:
    """Slope of a trend with its standard error."""
    return f"{percent(slope.slope, 1, signed=True)} +- {percent(slope.error, 1)}"
