"""Warnings on rolls, idler sets, belt and beds: defaults in use, laws beyond what they hold for."""

from __future__ import annotations

import math
from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.files.libraries import widest_spacings
from conveyor.laws.misalignment import MISALIGNMENT
from conveyor.laws.resistance import (
    FLEXURE_COEFFICIENT,
    FLEXURE_SHARE,
    ROLL_CONDITION,
    ROLL_ON_BELT_FRICTION,
    SCRAPING_FACTOR,
    SERVICE_DRAG,
    SITE_SAG,
)
from conveyor.laws.resistance.cema import DRIVE_PULLEY_FRICTION
from conveyor.line.roll_drags import acceptance_limit, assumed_bearing, bearing_viscosity
from conveyor.loop.belt_limits import allowed_tension
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.models.calculation_methods import METHOD_NAMES
from conveyor.models.library_items import without_entry_fields
from conveyor.models.rolls import BearingDrag
from conveyor.remarks.assumptions import library_models, rolls_by_field
from conveyor.remarks.bed_warnings import bed_warnings
from conveyor.remarks.hopper_warnings import hopper_warnings
from conveyor.units import quantity, same_value, text
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import Message, escape_braces, message

COLD_OIL_VISCOSITY = (
    1e-3  # [m²/s], ten times a usual base oil at 40 degC: its drag is then a multiple of the measured range
)


def part_warnings(result: CalculatedConveyor) -> tuple[Message, ...]:
    """Warnings on defaults in use and strained laws of rolls, sets and belt."""
    conveyor = result.conveyor
    itemised = result.line.method == "viscoelastic"  # a classical method has neither of these in its forces
    return (
        *_mass_warnings(conveyor),
        *(_drag_warnings(result) if itemised else ()),
        *(_flexure_warnings(conveyor) if itemised else ()),
        *_library_warnings(conveyor),
        *(_alignment_warnings(conveyor) if itemised else ()),
        *_cover_warnings(conveyor),
        *_set_warnings(result),
        *_pipe_warnings(conveyor),
        *_pipe_curve_warnings(result),
        *bed_warnings(conveyor),
        *hopper_warnings(conveyor),
        *_other_warnings(conveyor),
    )


def _alignment_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Sets whose misalignment is the site's default."""
    sets = (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_))
    without = [f"idlers.{strand}.misalignment" for strand, idlers in sets if idlers.misalignment is None]
    if without:
        band = MISALIGNMENT[conveyor.site]
        value, low, high = (f"{math.degrees(angle):.2g}" for angle in (band.value, band.low, band.high))
        taken = f"site {conveyor.site}" + ("" if "site" in conveyor.model_fields_set else " by default")
        yield message(
            f"{' and '.join(without)} not given: {value} deg assumed ({taken}; {low} to {high} deg, {band.source}; "
            "general knowledge)"
        )


def _mass_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Sets whose reduced mass is used as rotating mass."""
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        if idlers.reduced_mass is not None and idlers.reduced_only:
            yield message(
                f"idlers.{strand}: rotating_mass not given, reduced_mass ({text(idlers.reduced_mass)}) stands for "
                "it in the classical estimate too, which it lowers a little"
            )


def _drag_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    conveyor = result.conveyor
    air = conveyor.air_temperature
    in_service = conveyor.calculation.roll_drag == "in service"
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        for name, roll in rolls_by_field(idlers) if result.contacts.rolls_on(strand) else ():
            law, field = roll.drag_law, f"idlers.{strand}.{name}"
            if isinstance(law, BearingDrag):
                yield from _bearing_warnings(field, law, air)
            elif law is None and roll.drag is None and idlers.drag is None and in_service:
                drags = _drags_of_roll(result, strand, idlers, roll)
                bearing, band = assumed_bearing(roll), SERVICE_DRAG
                condition = ROLL_CONDITION[conveyor.site].value
                ends = list({format_figure(drag, "force"): drag for drag in (min(drags), max(drags))}.values())
                yield message(
                    f"idlers.{strand}: roll drag not given, {' to '.join('{}' for _ in ends)} a roll assumed (bearings "
                    f"{bearing}, usual grease and seals in service in air of {{}}, {condition:g} times that of rolls "
                    f"in order for site {conveyor.site}; {band.low:g} to {band.high:g} times that is usual, general "
                    f"knowledge), give {field}.drag",
                    *((drag, "force") for drag in ends),
                    (air, "temperature"),
                )
            elif law is None and roll.drag is None and idlers.drag is None:
                limit = acceptance_limit(roll)
                yield message(
                    f"idlers.{strand}: roll drag not given, {{}} a roll assumed ({limit.source}; the limit of a new "
                    f"roll's test, chosen by calculation.roll_drag), give {field}.drag",
                    (limit.value, "force"),
                )


def _drags_of_roll(result: CalculatedConveyor, strand: str, idlers: IdlerSet, roll: Roll) -> list[float]:
    """Drags of one roll in all sets of a strand [N]."""
    places = [place for place in range(idlers.rolls) if idlers.roll_at(place) is roll]
    pairs = zip(result.line.stretches, result.line.roll_drags, strict=True)
    return [drags[place] for stretch, drags in pairs if stretch.strand == strand and drags for place in places]


def _bearing_warnings(field: str, law: BearingDrag, air: float) -> Iterator[Message]:
    missing = [name for name in ("f0", "f1_factor", "f1_exponent") if name not in law.model_fields_set]
    if missing:
        yield message(
            f"{field}.drag_law: {', '.join(missing)} not given, upper ends for greased ball bearings assumed "
            "(general knowledge, Palmgren's range); a measured drag takes precedence over this law"
        )
    viscosity = bearing_viscosity(law, air)
    if viscosity > COLD_OIL_VISCOSITY:
        yield message(
            f"{field}.drag_law: the oil has {viscosity * 1e6:.4g} mm²/s at {{}}: bearings warm themselves, "
            "the drag is overestimated; give a measured drag or drag_law.warming",
            (air, "temperature"),
        )


def _flexure_warnings(conveyor: Conveyor) -> Iterator[Message]:
    calculation = conveyor.calculation
    flexure = calculation.flexure
    if flexure is None:
        if calculation.flexure_share is None:
            c = FLEXURE_COEFFICIENT
            yield message(
                f"calculation.flexure not given: load x sag x {c.value:.3f} ({c.low:.3f} to {c.high:.3f}) assumed, so "
                f"that one measured site has its {100.0 * FLEXURE_SHARE.value:.0f} % at a sag of "
                f"{100.0 * SITE_SAG.value:.1f} %, which is not published"
            )
        return
    left_out = [name for name in ("belt", "bulk") if getattr(flexure, name) is None]
    if left_out:
        yield message(
            f"calculation.flexure.{left_out[0]} not given: flexure of the {left_out[0]} is not in the figures"
        )
    if flexure.belt is not None:
        yield message(
            "calculation.flexure.belt: a derived law of the belt between its sets, not measured on a conveyor"
        )
    if flexure.bulk is not None:
        yield message(
            "calculation.flexure.bulk: an upper bound; its opening angle is the spec's, no law computes it here"
        )


def _library_warnings(conveyor: Conveyor) -> Iterator[Message]:
    for field, model in library_models(conveyor):
        entry = model.entry
        if entry is None or not entry.general_knowledge:
            continue
        given = model.as_data()
        taken = [
            name for name in entry.fields if name != "name" and name not in without_entry_fields(given, entry.fields)
        ]
        if taken:
            spans = "; ".join(f"{name} {entry.range[name]}" for name in taken if name in entry.range)
            met = f", in practice {spans}" if spans else ""
            yield message(f'{field}: {", ".join(taken)} assumed as of "{entry.name}": {entry.source}{met}')


def _cover_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Belt mass of a library entry with other cover thicknesses."""
    belt = conveyor.belt
    held = {} if belt.entry is None else belt.entry.fields
    if belt.mass is None or text(belt.mass) != held.get("mass"):
        return
    for name, cover in (("top_cover", belt.top_cover), ("bottom_cover", belt.bottom_cover)):
        listed = held.get(name, {}).get("thickness")
        if listed is not None and not same_value(quantity(listed), cover.thickness):
            yield message(
                f"belt.mass {text(belt.mass)} is listed for a {name} of {listed}, the spec has "
                f"{text(cover.thickness)}: give belt.mass"
            )


def _set_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    widest, idlers_of = widest_spacings(), result.conveyor.idlers
    for strand, idlers in (("carry", idlers_of.carry), ("return", idlers_of.return_)):
        stretches = [stretch for stretch in result.line.stretches if stretch.strand == strand]
        if any(s.tilt_angle > 0.0 for s in stretches) or any(s.turn is not None and s.turn.guided for s in stretches):
            friction = ROLL_ON_BELT_FRICTION.value
            yield message(
                f"idlers.{strand}: friction of belt on tilted or skewed rolls {friction:g} assumed (general knowledge)"
            )
        if idlers.offset.magnitude > 0.0:
            yield message(f"idlers.{strand}.offset: the loads of the rolls are those of a set in one plane")
        spacing = max((stretch.spacing for stretch in stretches if stretch.bed is None), default=0.0)
        if spacing > widest[strand]:
            yield message(
                f"idlers.{strand}: sets {{}} apart, the widest in use on overland conveyors are {{}}",
                (spacing, "length"),
                (widest[strand], "length"),
            )


def _pipe_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Factors of other belts by which a pipe is calculated."""
    method = conveyor.calculation.method
    if conveyor.idlers.carry.pipe is not None and method != "viscoelastic":
        yield message(
            f"idlers.carry.pipe: usual factors of {METHOD_NAMES[method]} are those of troughed belts, without what "
            "forms the pipe; give factors of pipe conveyors"
        )


def _pipe_curve_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """Curves of a pipe whose strips plane sections take beyond the rated tension, or slack."""
    rated = allowed_tension(result.line)
    for curve in result.pipe_curves:
        if rated is not None and curve.most is not None and curve.most > rated:
            yield message(
                f'section "{escape_braces(curve.section)}", {curve.strand}: on the {curve.kind} curve of {{}} the '
                "outside of the pipe has {} by plane sections, the belt is rated for {}; not judged, makers bend pipes "
                "by their diameter: ask the belt's maker, or a wider curve",
                (curve.radius, "length"),
                (curve.most, "strength"),
                (rated, "strength"),
            )
        if curve.least is not None and curve.least < 0.0:
            yield message(
                f'section "{escape_braces(curve.section)}", {curve.strand}: on the {curve.kind} curve of {{}} the '
                "inside of the pipe is slack by plane sections, where the belt has {}; not judged, rolls hold the pipe "
                "all round: see that it keeps its form there, or set the take-up higher",
                (curve.radius, "length"),
                (curve.lowest, "force"),
            )


def _has_section_flexure(conveyor: Conveyor) -> bool:
    return any(section.flexure_factor is not None for section in conveyor.route.sections)


def _other_warnings(conveyor: Conveyor) -> Iterator[Message]:
    if any("scraping_factor" not in plough.model_fields_set for plough in conveyor.route.ploughs):
        yield message(
            f"route.ploughs: scraping factor {SCRAPING_FACTOR.value:g} N/m assumed, normal value of ISO 5048 as "
            "commonly reproduced: it knows neither density nor speed"
        )
    if conveyor.calculation.cema is not None:
        yield message(
            "CEMA classic form: formulas and figures as commonly reproduced, Ky, Kt, Ai, Cs by the spec"
            + ("" if _has_section_flexure(conveyor) else ", one Ky for the whole conveyor")
        )
        if "drive_pulley_friction" not in conveyor.calculation.cema.model_fields_set:
            yield message(
                "calculation.cema.drive_pulley_friction not given: none in the motor power, CEMA has {} for a drive "
                "pulley",
                (DRIVE_PULLEY_FRICTION, "force"),
            )
        if conveyor.route.feeding is not None and conveyor.calculation.cema.skirt_factor is None:
            yield message("calculation.cema.skirt_factor not given: of the skirts only the seals are in CEMA's figures")
