"""Criteria of the contacts of belt and rolls: penetration, data of the rubber."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit, pass_or_fail, severity_rank
from conveyor.line.covers import compounds_by_strand
from conveyor.line.stretches import STRANDS, Strand
from conveyor.units.sentences import escape_braces, format_band, message, percent

MAX_PENETRATION: Final = 0.2
"""Largest Δ/h for linear small-strain theory; strain is about Δ/h [-]."""


def cover_penetration(result: CalculatedConveyor) -> Iterator[Check]:
    """Penetration of the rolls is within the range of small-strain theory."""
    for strand in STRANDS:
        deepest, thickness = result.contacts.deepest(strand), result.contacts.covers[strand].thickness
        why = message(
            f"{strand} rolls indent the cover by {percent(deepest)} of its thickness ({{}}): beyond small strain, "
            "the linear law is not proven",
            (thickness, "thickness"),
        )
        yield Check(
            "penetration", message(f"penetration of the cover, {strand} rolls"), deepest, MAX_PENETRATION, "fraction",
            message(f"{percent(deepest, 1)} of its thickness"),
            message(f"at most {percent(MAX_PENETRATION)} (small strain)"),
            pass_or_fail(holds=deepest <= MAX_PENETRATION), why, "at most",
        )  # fmt: skip


def rubber_coverage(result: CalculatedConveyor) -> Iterator[Check]:
    """The data of each rubber cover the band of nine tenths of its rolls' energy loss."""
    if result.line.method != "viscoelastic":
        return
    for strand, compound in compounds_by_strand(result.conveyor).items():
        if compound.kind == "illustrative":
            if result.contacts.lossy(strand):
                yield Check(
                    "rubber_coverage", message(f"rubber, {strand}"), None, None, "frequency",
                    message("constructed spectrum"), message("a measured compound required"), "not checked",
                )  # fmt: skip
            continue
        band = result.contacts.excited_band(strand)
        if band is None:
            continue
        yield _coverage_check(
            strand,
            escape_braces(compound.name),
            band,
            compound.frequencies(result.temperature),
            result.temperature,
        )


def _coverage_check(
    strand: Strand, name: str, band: tuple[float, float], data: tuple[float, float] | None, at: float
) -> Check:
    """Check a band against that of the data [Hz]; the end of less margin decides."""
    subject = f"rubber data over the excitation band, {strand}"
    shown = message(f"{format_band(band)} at {{}}", (at, "temperature"))
    if data is None:
        missing = "range of the data not stated"
        return check_against_limit(
            "rubber_coverage", subject, band[1], "at most", None, "frequency", wording=shown, missing=missing
        )
    why = message(
        f'compound "{name}": 90 % of the loss of the {strand} rolls lies between '
        f"{band[0]:.3g} and {band[1]:.3g} Hz, its data cover {data[0]:.3g} to {data[1]:.3g} Hz "
        "at {}: the series is extrapolated: not for design",
        (at, "temperature"),
    )
    ends = (
        check_against_limit(
            "rubber_coverage", subject, band[0], "at least", data[0], "frequency", wording=shown, why=why
        ),
        check_against_limit(
            "rubber_coverage", subject, band[1], "at most", data[1], "frequency", wording=shown, why=why
        ),
    )
    return replace(min(ends, key=severity_rank), asked=message(f"within {format_band(data)}"))
