"""What a reader must know of rolls, flexure, shares, ploughs and library entries: assumptions and warnings."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.files.libraries import widest_spacings
from conveyor.laws.resistance import (
    FLEXURE_COEFFICIENT,
    FLEXURE_SHARE,
    ROLL_ON_BELT_FRICTION,
    SCRAPING_FACTOR,
    SERVICE_DRAG,
)
from conveyor.line.roll_drags import acceptance_limit, assumed_bearing, bearing_viscosity
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.models.listed import Listed, without
from conveyor.models.rolls import BearingDrag, MakerDrag
from conveyor.pipeline import CalculatedConveyor
from conveyor.units import quantity, same, text
from conveyor.units.sentences import Said, figure, said

COLD_OIL = (
    1e-3  # [m²/s], ten times a usual base oil at 40 degC: its drag is then a multiple of the measured range
)


def roll_assumptions(conveyor: Conveyor) -> tuple[str, ...]:
    """Shares, flexure, drag: what they rest on; entries of libraries with their sources."""
    return (
        _shares(conveyor),
        _flexure(conveyor),
        _drag(conveyor),
        *_entries(conveyor),
    )


def _shares(conveyor: Conveyor) -> str:
    sets = (conveyor.idlers.carry, conveyor.idlers.return_)
    rule = "VDI 2341"
    if conveyor.idlers.carry.load_shares is not None:
        rule = "the spec (idlers.carry.load_shares)"
    elif conveyor.idlers.carry.share_rule == "cross-section":
        heap = "a parabola" if conveyor.material.surcharge_convention == "ISO 5048" else "a triangle"
        rule = (
            f"the area of bulk above each roll at the section's filling, the heap {heap} "
            f"({conveyor.material.surcharge_convention}), vertical columns"
        )
    even = all(idlers.wing_load == "uniform" for idlers in sets)
    outer = "and outer ones" if even else "triangular on outer ones"
    joined = "bulk uniform on inner rolls " if even else "bulk uniform on inner rolls, "
    return f"Load shares of the rolls after {rule}; {joined}{outer}."


def _flexure(conveyor: Conveyor) -> str:
    calculation = conveyor.calculation
    if calculation.flexure_share is not None:
        return (
            f"Flexure of belt and bulk is {text(calculation.flexure_share)} of the main resistance (no model: "
            f"{100.0 * FLEXURE_SHARE.value:.0f} % of the total were measured at one overland site)."
        )
    if calculation.flexure is None:
        carry, back = (text(idlers.sag) for idlers in (conveyor.idlers.carry, conveyor.idlers.return_))
        return (
            f"Flexure of belt and bulk is {FLEXURE_COEFFICIENT.value:.3f} of load times relative sag, at the sag "
            f"the sets are designed for (carry {carry}, return {back}) at any tension and load."
        )
    laws = []
    if calculation.flexure.belt is not None:
        given = calculation.flexure.belt.tension
        at = "the least tension that the sag allows, on the safe side" if given is None else text(given)
        laws.append(f"of the belt as a tensioned beam with a constant loss tangent, at {at}")
    if calculation.flexure.bulk is not None:
        laws.append("of the bulk by Rankine's states at the opening angle given, an upper bound")
    return f"Flexure {'; '.join(laws)}."


def _drag(conveyor: Conveyor) -> str:
    in_service = conveyor.calculation.roll_drag == "in service"
    laws = {
        strand: sorted({_law_in_words(roll, in_service=in_service) for _, roll in _rolls(idlers)})
        for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_))
    }
    if all(law == ["constant"] for law in laws.values()):
        return "Roll drag does not depend on speed, load or temperature."
    words = [f"{strand} {' and '.join(law)}" for strand, law in laws.items()]
    if laws["carry"] == laws["return"]:
        words = [" and ".join(laws["carry"])]
    return f"Roll drag: {', '.join(words)}."


def _law_in_words(roll: Roll, *, in_service: bool) -> str:
    if isinstance(roll.drag_law, MakerDrag):
        return "over load and speed by the maker's line"
    if isinstance(roll.drag_law, BearingDrag):
        return "over load, speed and air temperature by Palmgren's bearing friction, no warming but the given"
    if roll.drag is None and in_service:
        return (
            "over load, speed and air temperature by Palmgren's friction of usual bearings at their own temperature, "
            "and usual seals"
        )
    return "constant"


def _rolls(idlers: IdlerSet) -> list[tuple[str, Roll]]:
    """Rolls of a set by their field."""
    rolls = [("roll", idlers.roll)]
    return rolls if idlers.middle_roll is None else [*rolls, ("middle_roll", idlers.middle_roll)]


def _listed(conveyor: Conveyor) -> Iterator[tuple[str, Listed]]:
    yield "belt", conveyor.belt
    yield "material", conveyor.material
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        for name, roll in _rolls(idlers):
            yield f"idlers.{strand}.{name}", roll


def _entries(conveyor: Conveyor) -> Iterator[str]:
    for field, model in _listed(conveyor):
        entry = model.entry
        if entry is not None:
            note = f"; {entry.note}" if entry.note else ""
            yield f'{field}: "{entry.name}" of the library where the spec gives nothing ({entry.source}){note}.'


def roll_warnings(result: CalculatedConveyor) -> tuple[Said, ...]:
    """Where a default stands in or a law is strained."""
    conveyor = result.conveyor
    return (
        *_mass_warnings(conveyor),
        *_drag_warnings(result),
        *_flexure_warnings(conveyor),
        *_library_warnings(conveyor),
        *_cover_warnings(conveyor),
        *_set_warnings(result),
        *_other_warnings(conveyor),
    )


def _mass_warnings(conveyor: Conveyor) -> Iterator[Said]:
    """Where the reduced mass of a set must stand for all of it."""
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        if idlers.reduced_mass is not None and idlers.reduced_only:
            yield said(
                f"idlers.{strand}: rotating_mass not given, reduced_mass ({text(idlers.reduced_mass)}) stands for "
                "it in the classical estimate too, which it lowers a little"
            )


def _drag_warnings(result: CalculatedConveyor) -> Iterator[Said]:
    conveyor = result.conveyor
    air = conveyor.air_temperature
    in_service = conveyor.calculation.roll_drag == "in service"
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        for name, roll in _rolls(idlers):
            law, field = roll.drag_law, f"idlers.{strand}.{name}"
            if isinstance(law, BearingDrag):
                yield from _bearing_warnings(field, law, air)
            elif law is None and roll.drag is None and idlers.drag is None and in_service:
                drags = _drags_of(result, strand, idlers, roll)
                bearing, band = assumed_bearing(roll), SERVICE_DRAG
                ends = list({figure(drag, "force"): drag for drag in (min(drags), max(drags))}.values())
                yield said(
                    f"idlers.{strand}: roll drag not given, {' to '.join('{}' for _ in ends)} a roll assumed (bearings "
                    f"{bearing}, usual grease and seals in service in air of {{}}; {band.low:g} to {band.high:g} times "
                    f"that is usual, general knowledge), give {field}.drag",
                    *((drag, "force") for drag in ends),
                    (air, "temperature"),
                )
            elif law is None and roll.drag is None and idlers.drag is None:
                limit = acceptance_limit(roll)
                yield said(
                    f"idlers.{strand}: roll drag not given, {{}} a roll assumed ({limit.source}; the limit of a new "
                    f"roll's test, chosen by calculation.roll_drag), give {field}.drag",
                    (limit.value, "force"),
                )


def _drags_of(result: CalculatedConveyor, strand: str, idlers: IdlerSet, roll: Roll) -> list[float]:
    """Drags of a roll in all sets of a strand [N]."""
    places = [place for place in range(idlers.rolls) if idlers.roll_at(place) is roll]
    pairs = zip(result.line.stretches, result.line.roll_drags, strict=True)
    return [drags[place] for stretch, drags in pairs if stretch.strand == strand for place in places]


def _bearing_warnings(field: str, law: BearingDrag, air: float) -> Iterator[Said]:
    missing = [name for name in ("f0", "f1_factor", "f1_exponent") if name not in law.model_fields_set]
    if missing:
        yield said(
            f"{field}.drag_law: {', '.join(missing)} not given, upper ends for greased ball bearings assumed "
            "(general knowledge, Palmgren's range); a measured drag takes precedence over this law"
        )
    viscosity = bearing_viscosity(law, air)
    if viscosity > COLD_OIL:
        yield said(
            f"{field}.drag_law: the oil has {viscosity * 1e6:.4g} mm²/s at {{}}: bearings warm themselves, "
            "the drag is overestimated; give a measured drag or drag_law.warming",
            (air, "temperature"),
        )


def _flexure_warnings(conveyor: Conveyor) -> Iterator[Said]:
    calculation = conveyor.calculation
    flexure = calculation.flexure
    if flexure is None:
        if calculation.flexure_share is None:
            c = FLEXURE_COEFFICIENT
            yield said(
                f"calculation.flexure not given: load x sag x {c.value:.3f} ({c.low:.3f} to {c.high:.3f}) assumed, so "
                f"that one measured site has its {100.0 * FLEXURE_SHARE.value:.0f} % at 1 % sag (general knowledge)"
            )
        return
    left_out = [name for name in ("belt", "bulk") if getattr(flexure, name) is None]
    if left_out:
        yield said(
            f"calculation.flexure.{left_out[0]} not given: flexure of the {left_out[0]} is not in the figures"
        )
    if flexure.belt is not None:
        yield said(
            "calculation.flexure.belt: a derived law of the belt between its sets, not measured on a conveyor"
        )
    if flexure.bulk is not None:
        yield said(
            "calculation.flexure.bulk: an upper bound; its opening angle is the spec's, no law computes it here"
        )


def _library_warnings(conveyor: Conveyor) -> Iterator[Said]:
    for field, model in _listed(conveyor):
        entry = model.entry
        if entry is None or not entry.general_knowledge:
            continue
        given = model.as_data()
        taken = [name for name in entry.fields if name != "name" and name not in without(given, entry.fields)]
        if taken:
            spans = "; ".join(f"{name} {entry.range[name]}" for name in taken if name in entry.range)
            yield said(
                f'{field}: {", ".join(taken)} of "{entry.name}" are {entry.source}, in practice {spans}'
            )


def _cover_warnings(conveyor: Conveyor) -> Iterator[Said]:
    """A listed mass is that of the listed covers."""
    belt = conveyor.belt
    held = {} if belt.entry is None else belt.entry.fields
    if belt.mass is None or text(belt.mass) != held.get("mass"):
        return
    for name, cover in (("top_cover", belt.top_cover), ("bottom_cover", belt.bottom_cover)):
        listed = held.get(name, {}).get("thickness")
        if listed is not None and not same(quantity(listed), cover.thickness):
            yield said(
                f"belt.mass {text(belt.mass)} is listed for a {name} of {listed}, the spec has "
                f"{text(cover.thickness)}: give belt.mass"
            )


def _set_warnings(result: CalculatedConveyor) -> Iterator[Said]:
    widest, idlers_of = widest_spacings(), result.conveyor.idlers
    for strand, idlers in (("carry", idlers_of.carry), ("return", idlers_of.return_)):
        stretches = [stretch for stretch in result.line.stretches if stretch.strand == strand]
        if stretches[0].tilt_angle > 0.0 or any(s.turn is not None and s.turn.guided for s in stretches):
            friction = ROLL_ON_BELT_FRICTION.value
            yield said(
                f"idlers.{strand}: tilt or skew with μ0 = {friction:g}, general knowledge, not a source"
            )
        if idlers.offset.magnitude > 0.0:
            yield said(f"idlers.{strand}.offset: the loads of the rolls are those of a set in one plane")
        spacing = max(stretch.spacing for stretch in stretches)
        if spacing > widest[strand]:
            yield said(
                f"idlers.{strand}: sets {{}} apart, the widest in use on overland conveyors are {{}}",
                (spacing, "length"),
                (widest[strand], "length"),
            )


def _other_warnings(conveyor: Conveyor) -> Iterator[Said]:
    if any("scraping_factor" not in plough.model_fields_set for plough in conveyor.route.ploughs):
        yield said(
            f"route.ploughs: scraping factor {SCRAPING_FACTOR.value:g} N/m assumed, normal value of ISO 5048 as "
            "commonly reproduced: it knows neither density nor speed"
        )
    if conveyor.calculation.cema is not None:
        yield said(
            "CEMA classic form: formulas and figures as commonly reproduced, Ky, Kt, Ai, Cs by the spec, "
            "one Ky for the whole conveyor"
        )
        if conveyor.route.feeding is not None and conveyor.calculation.cema.skirt_factor is None:
            yield said(
                "calculation.cema.skirt_factor not given: of the skirts only the seals are in CEMA's figures"
            )
