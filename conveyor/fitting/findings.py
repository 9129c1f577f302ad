"""Implausible master curves: refused with advice, unless accepted by name."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from conveyor.errors import InputError, NoSolutionError
from conveyor.laboratory.dma_data import FloatArray
from conveyor.rubber.fit import consistency_floor, scatter_about_best
from conveyor.rubber.misfit import LEAST_SCATTER

FINDINGS: Final = {
    "few-rows": "fewer than five frequencies, or less than a decade of them",
    "modulus": "an E' below 0.05 MPa or above 12 GPa, or none below 5 GPa",
    "contradiction": "E' and E'' that no rubber shows together",
}
"""Findings that a fit refuses unless accepted by name."""
FEWEST_FREQUENCIES: Final = 5
LEAST_DECADES: Final = 1.0
"""Least span: a term spreads its loss over more than a decade, less shows no shape [decades]."""
RUBBER_RANGE: Final = (5e4, 1.2e10)
"""E' of rubber, soft gel to glass with filler, with room on both sides (general knowledge) [Pa]."""
GLASS_MODULUS: Final = 5e9
"""Curves wholly above it are not of rubber (general knowledge) [Pa]."""
DOUBTFUL_RESIDUAL: Final = 0.05
"""Residual of the best positive spectrum from which other readings of the columns are tried: measurements leave less,
or no other reading does better [-]."""
BETTER_SHARE: Final = 0.25
"""Largest share of that residual left by the right reading [-]."""
NEAR_SHARE: Final = 0.4
"""The same for a reading that differs little: 0.05 to 0.3 for shelf rubbers through their glass transition with 1 % of
noise; such a reading of right curves, measured ones too, leaves 0.85 and more [-]."""
FEWEST_NEAR_ROWS: Final = 12
"""Least rows for such a reading: of right sweeps with noise, 8 of 628 with 5 to 10 rows had 0.4 and less by chance,
none of 1,123 with 11 to 16 rows less than 0.5."""
LEAST_DEGREES: Final = 1.0
"""Phase angle that most rows of a cover exceed (general knowledge: a tan delta of 0.02) [degrees]."""
CONTRADICTION_RESIDUAL: Final = 0.25
"""Residual above that of any known measurement (S100: 13 %; a published polymer: 17 %) without equal scatter [-]."""
SCATTER_MARGIN: Final = 1.5
_MODULUS_UNITS: Final = (1.0, 1e3, 1e6, 1e9)
_TANGENT_RANGE: Final = (1e-4, 5.0)
_LOGARITHM_RANGE: Final = (-3.0, 12.0)


@dataclass(frozen=True)
class Finding:
    """One of `FINDINGS`, with its observation and advice; `place` is its file where it is of one of several."""

    name: str
    text: str
    place: str = ""


def check_accepted(accepted: frozenset[str]) -> None:
    """Refuse names of findings that are not known."""
    for name in accepted - FINDINGS.keys():
        raise InputError(f'accept: "{name}" (--accept) is not known; allowed: {", ".join(FINDINGS)}')


def check_findings(
    place: str, curve: tuple[FloatArray, FloatArray, FloatArray], accepted: frozenset[str], shear: float
) -> tuple[Finding, ...]:
    """Refuse a master curve for each finding that is not accepted; returns those that are."""
    check_accepted(accepted)
    return refuse_findings(place, _curve_findings(*curve, shear=shear), accepted)


def refuse_findings(place: str, findings: Iterable[Finding], accepted: frozenset[str]) -> tuple[Finding, ...]:
    """Refuse each finding that is not accepted; returns those that are."""
    seen = []
    for finding in findings:
        if finding.name not in accepted:
            raise InputError(
                f"{finding.place or place}: {finding.text}; if it is right as it stands, insist with --accept "
                f'{finding.name} (accept={{"{finding.name}"}})'
            )
        seen.append(finding)
    return tuple(seen)


def _curve_findings(frequency: FloatArray, storage: FloatArray, loss: FloatArray, *, shear: float) -> Iterator[Finding]:
    count, decades = np.unique(frequency).size, float(np.log10(frequency.max() / frequency.min()))
    if count >= FEWEST_FREQUENCIES:
        yield from _contradiction_finding(frequency, storage, loss, shear)
    if count < FEWEST_FREQUENCIES or round(decades, 6) < LEAST_DECADES:
        span = f"{decades:.2g}"
        yield Finding(
            "few-rows",
            f"{count} frequencies over {span} decade{'s' * (span != '1')}; a series needs {FEWEST_FREQUENCIES} over "
            f"{LEAST_DECADES:g}: measure more frequencies, or more temperatures",
        )
    lowest, highest = float(storage.min()), float(storage.max())
    if lowest < RUBBER_RANGE[0] or highest > RUBBER_RANGE[1] or lowest > GLASS_MODULUS:
        seen = lowest if lowest < RUBBER_RANGE[0] or highest <= RUBBER_RANGE[1] else highest
        yield Finding(
            "modulus",
            f"E' = {seen / 1e6:.4g} MPa at {frequency[storage == seen][0]:.3g} Hz; rubber has "
            f"{RUBBER_RANGE[0] / 1e6:g} to "
            f"{RUBBER_RANGE[1] / 1e6:,.0f} MPa, not all of it above {GLASS_MODULUS / 1e6:,.0f}: correct the unit of "
            f"the moduli in "
            "the header, or give --modulus-unit",
        )


def _contradiction_finding(
    frequency: FloatArray, storage: FloatArray, loss: FloatArray, shear: float
) -> Iterator[Finding]:
    left = _spectrum_residual(frequency, storage, loss)
    if left < LEAST_SCATTER:
        return
    seen = (
        f"E' and E'' contradict each other: the best of all positive spectra misses them by {100.0 * left:.2g} % (rms)"
    )
    near = _near_readings(frequency, storage, loss) if frequency.size >= FEWEST_NEAR_ROWS else ()
    readings = [(NEAR_SHARE, *one) for one in near]
    if left >= DOUBTFUL_RESIDUAL:
        readings += [(BETTER_SHARE, *one) for one in _other_readings(frequency, storage, loss, shear)]
    tried = [(_spectrum_residual(*curve), share, advice) for share, curve, advice in readings]
    found = min((one for one in tried if one[0] < one[1] * left), default=None)
    if found is not None:
        yield Finding("contradiction", f"{seen}, but by {100.0 * found[0]:.1f} % {found[2]}")
    elif left > max(CONTRADICTION_RESIDUAL, SCATTER_MARGIN * _spectrum_scatter(frequency, storage, loss)):
        yield Finding(
            "contradiction",
            f"{seen}, far more than they scatter from row to row; look for columns or units mixed up, two "
            "set-ups in one curve, or a wrong shift",
        )


def _near_readings(
    frequency: FloatArray, storage: FloatArray, loss: FloatArray
) -> Iterator[tuple[tuple[FloatArray, FloatArray, FloatArray], str]]:
    """Other readings of the columns that differ little from their names, as `_other_readings`."""
    whole = "if what is named E' is |E*|: name the column |E*|"
    tangent = loss / storage
    if (loss < storage).all():
        yield (frequency, np.sqrt(storage**2 - loss**2), loss), whole
    share = 1.0 / np.sqrt(1.0 + tangent**2)
    yield (frequency, storage * share, loss * share), f"{whole} (E'' was made of it by tan delta)"
    if tangent.max() < math.atan(_TANGENT_RANGE[1]):
        words = "if its tan delta is the phase angle in rad: name the column 'phase [rad]'"
        yield (frequency, storage, storage * np.tan(tangent)), words


def _other_readings(
    frequency: FloatArray, storage: FloatArray, loss: FloatArray, shear: float
) -> Iterator[tuple[tuple[FloatArray, FloatArray, FloatArray], str]]:
    """Other readings of the columns, as frequency, E' and E'', with advice."""
    tangent = loss / storage
    yield (frequency, loss, storage), "with E' and E'' exchanged: exchange the names of the two columns"
    for factor in (1e3, 1e-3):
        yield (
            (frequency, storage, loss * factor),
            f"with E'' times {factor:g}: correct the unit of one of the moduli",
        )
    if np.median(tangent) > LEAST_DEGREES and tangent.max() < 90.0:
        words = "if its tan delta is the phase angle in degrees: name the column 'phase [deg]'"
        yield (frequency, storage, storage * np.tan(np.radians(tangent))), words
    for unit in {unit * factor for unit in _MODULUS_UNITS for factor in (1.0, shear)}:
        named = loss / unit
        if _is_within(named, _TANGENT_RANGE):
            yield (
                (frequency, storage, storage * named),
                "if what is named E'' is tan delta: name the column 'tan delta'",
            )
        first, second = storage / unit, loss / unit
        if np.ptp(first) > 0.0 and _is_within(first, _LOGARITHM_RANGE) and _is_within(second, _LOGARITHM_RANGE):
            moduli = (10.0**first, 10.0**second)
            yield (frequency, *moduli), "if the moduli are log10: name them log10 E' and log10 E''"
            if _is_within(frequency, _LOGARITHM_RANGE):
                yield (
                    (10.0**frequency, *moduli),
                    "if frequency and moduli are log10: name the columns log10 f, log10 E' and log10 E''",
                )
    if _is_within(frequency, _LOGARITHM_RANGE):
        yield (10.0**frequency, storage, loss), "if the frequency is log10: name the column log10 f"


def _is_within(values: FloatArray, limits: tuple[float, float]) -> bool:
    return bool(limits[0] <= values.min() and values.max() <= limits[1])


def _spectrum_scatter(frequency: FloatArray, storage: FloatArray, loss: FloatArray) -> float:
    """Scatter of both moduli from row to row about the best positive spectrum [-]; 0 where none has a loss."""
    try:
        noise = scatter_about_best(frequency, storage, loss)
    except NoSolutionError:
        return 0.0
    return math.sqrt(0.5) * math.hypot(*(value or 0.0 for value in noise))


def _spectrum_residual(frequency: FloatArray, storage: FloatArray, loss: FloatArray) -> float:
    """Residual of the best positive spectrum; infinite where none has a loss."""
    try:
        return consistency_floor(frequency, storage, loss)
    except NoSolutionError:
        return float("inf")
