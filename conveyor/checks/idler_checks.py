"""Criteria of idler sets and their rolls."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit, pass_or_fail
from conveyor.line.roll_lives import shortest_set_life
from conveyor.line.stretches import STRANDS, Strand
from conveyor.loop.set_duty import SetDuty
from conveyor.units.sentences import escape_braces, message, percent


def roll_life(result: CalculatedConveyor) -> Iterator[Check]:
    """Idler sets reach the rated life of their CEMA class, or of light series; where their bearings are given."""
    for strand in STRANDS:
        life = shortest_set_life(result.line.stretches, strand, result.line.speed)
        if life is None:
            continue
        why = message(
            f"{strand} rolls: L10 of all bearings of a set in {escape_braces(life.section)} is {{}} (of the "
            f"{life.weakest} "
            f"alone {{}}), less than the {life.rated:,.0f} h that such sets are rated for (CEMA, as commonly "
            "reproduced); seals and dirt may end it sooner",
            *((3600.0 * hours, "duration") for hours in (life.hours, life.weakest_hours)),
        )
        asked, judged = (
            message(f"at least {life.rated:,.0f} h"),
            pass_or_fail(holds=not life.too_short),
        )
        if not life.whole and not life.too_short:
            asked, judged = message("bearings of some rolls not given"), "not checked"
        yield Check(
            "roll_life", message(f"L10 life, {strand} idler sets"), 3600.0 * life.hours, 3600.0 * life.rated,
            "duration", message("{}", (3600.0 * life.hours, "duration")), asked, judged, why,
        )  # fmt: skip


def set_rating(result: CalculatedConveyor) -> Iterator[Check]:
    """No set is loaded above its rating; where a class or rating is given."""
    for strand, duties in _set_duties_by_strand(result):
        rated = [(duty, duty.limits.rating) for duty in duties if duty.limits.rating is not None]
        if not rated:
            continue
        worst, rating = max(rated, key=lambda pair: pair[0].limits.load / pair[1])
        limits = worst.limits
        of_class = "" if limits.cema_class is None else f"CEMA class {limits.cema_class}"
        of_class += ", general knowledge" if limits.cema_class == "E" else ""
        cure = "" if limits.least_class is None else f"; class {limits.least_class} bears it"
        section = worst.stretch.section
        yield check_against_limit(
            "set_rating", f"load of a set, {strand} idlers", limits.load, "at most",
            None if limits.lump_factor is None else rating, "force", source=of_class, where=section,
            missing="lump_factor not given: none is printed for such lumps",
            why=f"{strand} sets in {escape_braces(section)} bear {{calculated}}, they are rated for {{required}}{cure}",
        )  # fmt: skip


def roll_axle(result: CalculatedConveyor) -> Iterator[Check]:
    """Slope of the rolls' axles at their bearings is within its limit; where given."""
    for strand, duties in _set_duties_by_strand(result):
        axles = [(duty.limits.axle, duty.stretch.section) for duty in duties if duty.limits.axle is not None]
        if not axles:
            continue
        axle, section = max(axles, key=lambda of: of[0].slope / of[0].allowed)
        yield check_against_limit(
            "roll_axle", f"slope of the axle at its bearings, {strand} rolls", axle.slope, "at most", axle.allowed,
            "angle", where=f"{axle.roll}, {section}",
            why=f"the axle of the {axle.roll} roll, {strand}, {escape_braces(section)}, slopes by {{calculated}} at "
                f"its "
            "bearings, they bear {required}: a thicker axle, a closer spacing",
        )  # fmt: skip


def belt_flap(result: CalculatedConveyor) -> Iterator[Check]:
    """The rolls' rotation is off the belt's natural frequencies between sets; where a distance is required."""
    for strand, duties in _set_duties_by_strand(result):
        asked = [duty for duty in duties if duty.limits.flap_margin is not None]
        if not asked:
            continue
        worst = min(asked, key=lambda duty: duty.distance)
        cure, figures = "; a higher tension", list[tuple[float, str]]()
        if worst.still_spacing is not None and worst.still_diameter is not None:
            cure = "; sets at most {} apart, or rolls of at least {}, keep it still"
            figures = [(worst.still_spacing, "length"), (worst.still_diameter, "thickness")]
        why = message(
            f"the belt may flap on its {strand} sets in {escape_braces(worst.stretch.section)}: rolls turn at "
            f"{_band_text(worst.rotations)} Hz, the belt swings at {_band_text(worst.frequencies)} Hz and twice "
            f"that{cure}",
            *figures,
        )
        yield check_against_limit(
            "belt_flap", f"distance from resonance of belt and rolls, {strand}", worst.distance, "at least",
            worst.limits.flap_margin, "fraction", wording=message(percent(worst.distance)), why=why,
            asked=message(f"at least {percent(worst.limits.flap_margin or 0.0)}"), where=worst.stretch.section,
        )  # fmt: skip


def _band_text(ends: tuple[float, float]) -> str:
    """Both ends of a band in words, equal ones once."""
    return " to ".join(dict.fromkeys(f"{end:.3g}" for end in ends))


def _set_duties_by_strand(result: CalculatedConveyor) -> Iterator[tuple[Strand, list[SetDuty]]]:
    for strand in STRANDS:
        yield strand, [duty for duty in result.set_duty if duty.stretch.strand == strand]
