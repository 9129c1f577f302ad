"""Assumptions behind the results, and the method in words."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.horizontal_curve import FULL_SLIP_TILT
from conveyor.laws.resistance import FLEXURE_COEFFICIENT, FLEXURE_SHARE, ROLL_ON_BELT_FRICTION
from conveyor.laws.resistance.service_drag import USUAL_BEARINGS
from conveyor.laws.wind import WIND_DRAG, WIND_LIFT
from conveyor.line.covers import compounds_by_strand
from conveyor.line.stretches import misalignment_angle
from conveyor.models import Conveyor, IdlerSet, Roll, RubberCompound
from conveyor.models.calculation_methods import FACTOR_METHODS, METHOD_NAMES
from conveyor.models.library_items import LibraryItem
from conveyor.models.maker_lists import ListedItem
from conveyor.models.rolls import BearingDrag, MakerDrag
from conveyor.units import text
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import percent

_USUAL_BEARINGS: Final = ", ".join(
    f"{bearing.name} to {1e3 * largest:.0f} mm" for largest, bearing in USUAL_BEARINGS if largest < math.inf
)
"""Usual bearings of rolls by the largest diameter that has them."""


def analysis_assumptions(conveyor: Conveyor) -> tuple[str, ...]:
    """Assumptions behind all results of an analysis, in words."""
    support = {
        "confined": "the cover is bonded to a carcass that does not give (a real belt differs by 1 to 8 %)",
        "belt": "the cover is bonded to a carcass that gives, held by its tension, the other cover above; all flat",
        "free": "the cover is a free layer that bends between the rolls (the paper's belt)",
        "half-space": "the cover is endlessly thick",
    }[conveyor.calculation.support]
    return (
        _rubber_assumption(conveyor),
        f"Contact is plane strain, frictionless, steady, on cylinders in line: {support}.",
        f"Contacts are solved to a relative tolerance of {conveyor.calculation.rtol:g} of the indentation resistance "
        "(calculation.rtol); at 1e-4 half widths are good to 0.1 %. Peak pressures have an error estimate of their "
        "own.",
        *roll_assumptions(conveyor),
        "The bearings of driven pulleys (at each drive's place the most wrapped ones) are included in the drive's "
        "efficiency; tension changes the load of the rolls on curves only.",
        *_horizontal_assumptions(conveyor),
        *_wind_assumption(conveyor),
        f"Covers are at {format_figure(conveyor.temperature, 'temperature', conveyor.report.units)} throughout; "
        "their warming by their own loss stands in the table of the rubber and is left out. Their rubber is that of "
        "the data: as conditioned there, of that lot, not aged.",
        *_energy_assumption(conveyor),
    )


def failed_fits(compounds: Iterable[RubberCompound]) -> Iterator[str]:
    """Compounds whose fit does not meet its criteria, with those, in words."""
    failed = ((one.name, one.fit.failed) for one in compounds if one.fit is not None and one.fit.failed)
    for name, criteria in dict.fromkeys(failed):
        yield f'the fit of "{name}" fails, do not design by it: {"; ".join(criteria)}'


def stepped_drags(conveyor: Conveyor, paths: Iterable[str]) -> Iterator[str]:
    """Diameters of rolls among varied fields whose drag is that of usual bearings, which change with the diameter."""
    sets = {"carry": conveyor.idlers.carry, "return": conveyor.idlers.return_}
    for path in paths:
        _, _, below = path.partition("idlers.")
        strand, _, field = below.partition(".")
        given = sets.get(strand)
        if given is None or given.drag is not None or field not in {"roll.diameter", "middle_roll.diameter"}:
            continue
        roll = given.middle if field.startswith("middle") else given.roll
        if roll.drag is None and roll.drag_law is None:
            yield (
                f"{path} varies, the drag of its rolls is not given: their usual bearing changes with the diameter, "
                f"{_USUAL_BEARINGS}, and the drag with it in steps"
            )


def _horizontal_assumptions(conveyor: Conveyor) -> Iterator[str]:
    """Assumptions on drift in horizontal curves."""
    sets = (conveyor.idlers.carry, conveyor.idlers.return_)
    straight = all(section.horizontal_curve is None for section in conveyor.route.sections)
    if straight or all(each.shape.closed for each in sets):
        return
    slip, friction = math.degrees(FULL_SLIP_TILT.value), ROLL_ON_BELT_FRICTION.value
    yield (
        "Horizontal curves: T - m' v² over the radius against the weights along the wings (Grimmer, Kessler 1987, "
        "Part II, load factors 1). Belt and bulk keep their place on each other as the belt drifts; the rolls bear "
        "what then lies over them, and the part of the pull that is square to them. Each section has one drift, of its "
        f"mean tension: divide long curves. Tilted and skewed rolls guide by a friction of at most {friction:g}, "
        f"reached at {slip:.0f} deg (general knowledge), of which 70 to 100 % is counted on. The way "
        "into the banking at the ends of a curve, and edge rolls, are left out."
    )
    if any(each.rolls == 1 for each in sets):
        yield (
            "A flat set in a horizontal curve holds the course of its belt by banking and guiding friction, not its "
            "place (derived): the belt comes in along the middle and drifts all along; its drift is that at the end."
        )


def _wind_assumption(conveyor: Conveyor) -> Iterator[str]:
    """Assumptions on wind on a strand without bulk."""
    if conveyor.ambient.wind_speed is not None:
        yield (
            f"Wind on a strand without bulk, no hood: it lifts by {WIND_LIFT.value:g} of its dynamic pressure on the "
            f"belt's width ({WIND_LIFT.low:g} to {WIND_LIFT.high:g}, most if dammed below; general knowledge), "
            "held against the belt's weight, in concave curves together with the tension. In horizontal curves it "
            f"pushes across by {WIND_DRAG.value:g} (general knowledge) on the height of the trough, either way; the "
            "weights that hold the belt there are taken without its lift."
        )


def method_summary(result: CalculatedConveyor) -> tuple[str, ...]:
    """Method of calculation, for readers of the report alone."""
    least = percent(result.conveyor.certain_friction)
    return (
        *_resistance_method(result),
        "Tensions: all forces are summed round the loop in steady running, starting and stopping; the take-up is set "
        "for the grip of the drives (Eytelwein) and the sag between idlers, in every load and state together.",
        "Load states: all sections loaded or empty in the combination that is worst for each figure; friction is "
        f"{result.line.design_friction:.3g} times the calculated one for motors, belt, grip and take-up (design), "
        f"{least} of it where the belt drives or is to be held (least).",
        "Checks: calculated against required, of all loads the least margin; the source of a limit stands beside it.",
    )


def _resistance_method(result: CalculatedConveyor) -> Iterator[str]:
    """Sentences on the method of the resistances."""
    line = result.line
    if line.method != "viscoelastic":
        factors = f"the factor {line.friction_text}" if line.method in FACTOR_METHODS else "Kx, Ky and Kt"
        yield (
            f"Resistances: {METHOD_NAMES[line.method]} with {factors}; tensions, motors, take-up and checks follow it. "
            "The rolling contact of every roll is computed beside, for loads of rolls and covers."
        )
        return
    tested = any(cover.test_factor is not None for cover in result.contacts.covers.values())
    scaled = ", scaled to the rolling-resistance tests of the compound" if tested else ""
    yield (
        "Indentation: steady rolling contact of a viscoelastic cover on cylinders (Menga, Bottiglione, Carbone, "
        "Lubricants 7 (2019), with its errata), solved for every distinct roll with the relaxation spectrum of the "
        f"rubber at belt speed and temperature{scaled}; numerical error at most {result.error_estimate:.0e}."
    )
    yield "Other resistances: DIN 22101 / ISO 5048, item by item; the source stands beside every force."


def _rubber_assumption(conveyor: Conveyor) -> str:
    softened = list(
        dict.fromkeys(
            compound.name
            for compound in compounds_by_strand(conveyor).values()
            if compound.strain_dependence is not None and conveyor.calculation.strain != "off"
        )
    )
    at = "at the strain its data were measured at"
    if softened:
        rest = "" if len(softened) == len({c.name for c in compounds_by_strand(conveyor).values()}) else f", else {at}"
        at = f"at its working strain under the rolls ({', '.join(softened)}{rest})"
    return f"Rubber is linearly viscoelastic {at}; Poisson's ratio is constant."


def _energy_assumption(conveyor: Conveyor) -> Iterator[str]:
    if conveyor.operation is not None and not conveyor.drive.knows_mains:
        yield (
            "Energy and cost are those of the motors' shafts: drive.train has no part between mains and motor shaft, "
            "such as the motor itself or a converter."
        )


def roll_assumptions(conveyor: Conveyor) -> tuple[str, ...]:
    """Assumptions on load shares, flexure, drag and alignment; library entries with their sources."""
    return (
        _share_assumption(conveyor), _flexure_assumption(conveyor), _drag_assumption(conveyor),
        _alignment_assumption(conveyor), *_library_assumptions(conveyor)
    )  # fmt: skip


def _share_assumption(conveyor: Conveyor) -> str:
    sets = (conveyor.idlers.carry, conveyor.idlers.return_)
    rule = "VDI 2341"
    if conveyor.idlers.carry.shape.closed:
        return (
            "Loads of the six rolls of a pipe: the belt as an elastic strip without friction, its edges lapping on "
            "top, under weights and tension in curves; a roll that it does not touch has its drag alone. Each load "
            "lies evenly over a sixth of the circumference; the resistance of forming, flexure and twist of the pipe "
            "are left out."
        )
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


def _alignment_assumption(conveyor: Conveyor) -> str:
    carry, back = (
        math.degrees(misalignment_angle(conveyor, idlers))
        for idlers in (conveyor.idlers.carry, conveyor.idlers.return_)
    )
    return (
        f"The axes of the idler sets are randomly misaligned, carry {carry:.2g} deg, return {back:.2g} deg (standard "
        f"deviation); belt on rolls has a friction of at most {ROLL_ON_BELT_FRICTION.value:g} (general knowledge)."
    )


def _flexure_assumption(conveyor: Conveyor) -> str:
    calculation = conveyor.calculation
    if calculation.flexure_share is not None:
        return (
            f"Flexure of belt and bulk is {text(calculation.flexure_share)} of the main resistance (no model: "
            f"{100.0 * FLEXURE_SHARE.value:.0f} % of the total were measured at one overland site)."
        )
    if calculation.flexure is None:
        carry, back = (text(idlers.sag) for idlers in (conveyor.idlers.carry, conveyor.idlers.return_))
        return (
            f"Flexure of belt and bulk is {FLEXURE_COEFFICIENT.value:.3f} of load times relative sag, at the steady "
            f"tension that stands there, at most at the sag the sets are designed for (carry {carry}, return {back})."
        )
    laws = []
    if calculation.flexure.belt is not None:
        given = calculation.flexure.belt.tension
        at = "the least tension that the sag allows, on the safe side" if given is None else text(given)
        laws.append(f"of the belt as a tensioned beam with a constant loss tangent, at {at}")
    if calculation.flexure.bulk is not None:
        laws.append("of the bulk by Rankine's states at the opening angle given, an upper bound")
    return f"Flexure {'; '.join(laws)}."


def _drag_assumption(conveyor: Conveyor) -> str:
    in_service = conveyor.calculation.roll_drag == "in service"
    laws = {
        strand: sorted({_law_in_words(roll, in_service=in_service) for _, roll in rolls_by_field(idlers)})
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


def rolls_by_field(idlers: IdlerSet) -> list[tuple[str, Roll]]:
    """Rolls of a set with their field names."""
    rolls = [("roll", idlers.roll)]
    return rolls if idlers.middle_roll is None else [*rolls, ("middle_roll", idlers.middle_roll)]


def library_models(conveyor: Conveyor) -> Iterator[tuple[str, LibraryItem]]:
    """Field and model of every part that a library may hold."""
    yield "belt", conveyor.belt
    yield "material", conveyor.material
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        for name, roll in rolls_by_field(idlers):
            yield f"idlers.{strand}.{name}", roll
    for i, pulley in enumerate(conveyor.route.pulleys):
        yield f"route.pulleys[{i}]", pulley


def _library_assumptions(conveyor: Conveyor) -> Iterator[str]:
    entries = [(field, model.entry) for field, model in library_models(conveyor)]
    for i, drive in enumerate(conveyor.drive.pulleys):
        field = f"drive.further_drives[{i - 1}]" if i else "drive"
        entries += [(field, item.entry) for item in drive.listed if isinstance(item, ListedItem)]
    for field, entry in entries:
        if entry is not None:
            note = f"; {entry.note}" if entry.note else ""
            yield f'{field}: "{entry.name}" of the library where the spec gives nothing ({entry.source}){note}.'
