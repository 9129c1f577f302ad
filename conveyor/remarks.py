"""Assumptions behind the results, and warnings where one is strained."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import Check
from conveyor.files.libraries import widest_spacings
from conveyor.laws.horizontal_curve import FULL_SLIP_TILT
from conveyor.laws.misalignment import MISALIGNMENT
from conveyor.laws.motion import DRIVE_INERTIA, START_FACTOR
from conveyor.laws.resistance import (
    CARCASS_BENDING,
    FLEXURE_COEFFICIENT,
    FLEXURE_SHARE,
    ROLL_CONDITION,
    ROLL_ON_BELT_FRICTION,
    SCRAPING_FACTOR,
    SERVICE_DRAG,
)
from conveyor.laws.wind import WIND_DRAG, WIND_LIFT
from conveyor.line.belt_contacts import BeltContacts
from conveyor.line.covers import compounds_by_strand
from conveyor.line.line import Line
from conveyor.line.roll_drags import acceptance_limit, assumed_bearing, bearing_viscosity
from conveyor.line.stretches import misalignment_angle
from conveyor.loop.annual_energy import lacks_feed_in_price
from conveyor.models import Conveyor, IdlerSet, Roll
from conveyor.models.library_items import LibraryItem, without_entry_fields
from conveyor.models.plausibility import implausible_inputs
from conveyor.models.rolls import BearingDrag, MakerDrag
from conveyor.units import quantity, same_value, text
from conveyor.units.presentation import format_figure
from conveyor.units.sentences import Message, escape_braces, message, percent

LEAST_PUBLISHED_FRICTION: Final = 0.0075
"""Friction factor measured over six shifts on Henderson PC2, 16.28 km (Alspaugh, MINExpo 2004) [-]."""


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
        "(calculation.rtol); at 1e-4 half widths are good to 0.1 %. Peak pressures stand with their own error.",
        *roll_assumptions(conveyor),
        "The bearings of driven pulleys (at each drive's place the most wrapped ones) are included in the drive's "
        "efficiency; tension changes the load of the rolls on curves only.",
        *_horizontal_assumptions(conveyor),
        *_wind_assumption(conveyor),
        f"Covers are at {format_figure(conveyor.temperature, 'temperature', conveyor.report.units)} throughout.",
        *_energy_assumption(conveyor),
    )


def _horizontal_assumptions(conveyor: Conveyor) -> Iterator[str]:
    """Assumptions on drift in horizontal curves."""
    if all(section.horizontal_curve is None for section in conveyor.route.sections):
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
    if 1 in {conveyor.idlers.carry.rolls, conveyor.idlers.return_.rolls}:
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
    tested = any(level is not None for level in (cover.level for cover in result.contacts.covers.values()))
    scaled = ", scaled to the rolling-resistance tests of the compound" if tested else ""
    return (
        "Indentation: steady rolling contact of a viscoelastic cover on cylinders (Menga, Bottiglione, Carbone, "
        "Lubricants 7 (2019), with its errata), solved for every distinct roll with the relaxation spectrum of the "
        f"rubber at belt speed and temperature{scaled}; numerical error at most {result.error_estimate:.0e}.",
        "Other resistances: DIN 22101 / ISO 5048, item by item; the source stands beside every force.",
        "Tensions: all forces are summed round the loop in steady running, starting and stopping; the take-up is set "
        "for the grip of the drives (Eytelwein) and the sag between idlers, in every load and state together.",
        "Load states: all sections loaded or empty in the combination that is worst for each figure; minimum friction "
        f"is {percent(result.conveyor.drive.certain_friction)} of the calculated one where that is less favourable.",
        "Checks: calculated against required, of all loads the least margin; the source of a limit stands beside it.",
    )


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


def analysis_warnings(result: CalculatedConveyor, checked: Iterable[Check]) -> tuple[Message, ...]:
    """Warnings: strained assumptions, defaults in use, failed checks, doubtful results."""
    conveyor = result.conveyor
    return tuple(
        dict.fromkeys(
            (
                *implausible_inputs(conveyor),
                *_rubber_warnings(conveyor),
                *_strain_warnings(result),
                *_test_factor_warnings(result),
                *_contact_warnings(result),
                *roll_warnings(result),
                *_omission_warnings(result),
                *_tripper_warnings(result.line),
                *_calibration_warnings(conveyor),
                *_drive_warnings(result),
                *_slack_side_warnings(result),
                *(
                    _name_case(check, check.why)
                    for check in checked
                    if check.verdict != "pass" and check.why is not None
                ),
            )
        )
    )


def _name_case(check: Check, why: Message) -> Message:
    if check.case is None:
        return why
    return Message(f"{check.case.words}: {why.words}", check.case.figures + why.figures)


def _rubber_warnings(conveyor: Conveyor) -> Iterator[Message]:
    for strand, compound in compounds_by_strand(conveyor).items():
        name = escape_braces(compound.name)
        if compound.kind == "illustrative":
            yield message(f'compound "{name}" is illustrative, not measured: for comparison, not for design')
        if strand == "return" and conveyor.belt.top_cover.compound is None and not conveyor.route.turned_over:
            yield message(f'top_cover.compound is not given: the return rolls run on the bottom cover\'s, "{name}"')
        if compound.fit is not None and compound.fit.failed:
            failed = escape_braces("; ".join(compound.fit.failed))
            yield message(f'compound "{name}": its fit fails, do not design by it: {failed}')
        if compound.missing and compound.kind == "measured":
            yield message(f'compound "{name}": unknown: {escape_braces("; ".join(compound.missing))}')


def _strain_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """Working strain and its factors on the moduli, for compounds with strain dependence."""
    for strand, compound in compounds_by_strand(result.conveyor).items():
        known, name = compound.strain_dependence, escape_braces(compound.name)
        if known is None:
            continue
        worked = result.contacts.covers[strand].strain
        factors = compound.amplitude_factors()
        if worked is not None and factors is not None:
            note = f" ({escape_braces(known.reference_note)})" if known.reference_note else ""
            yield message(
                f'compound "{name}": working strain under the {strand} rolls {percent(worked.strain, 1)} at '
                f"{worked.frequency:.3g} Hz: E' x {worked.storage_factor:.3g}, E'' x {worked.loss_factor:.3g} of "
                f"the master curve at {text(known.reference_strain)}{note}"
            )
            largest = factors.largest_strain(result.temperature)
            if worked.strain > largest:
                yield message(
                    f'compound "{name}": its strain sweeps end at {percent(largest, 2)}, below the working strain: the '
                    "factors there are held, the rubber is softer than that; measure larger strains, or leave strain "
                    "out (calculation: {{strain: off}})"
                )
            if not factors.known_at(result.temperature):
                reached = [(kelvin, "temperature") for kelvin in factors.temperatures[[0, -1]].tolist()]
                held = (factors.nearest(result.temperature), "temperature")
                yield message(
                    f'compound "{name}": its strain sweeps ({{}} to {{}}) do not reach {{}}: the factors at {{}} '
                    "are used",
                    *reached,
                    (result.temperature, "temperature"),
                    held,
                )
        elif not result.line.softened:
            yield message(f'compound "{name}": calculation.strain is off, its strain sweeps are not used')


def _test_factor_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """Test factor on the indentation and its band, or that it is untested."""
    contacts, calculation = result.contacts, result.conveyor.calculation
    for strand, compound in compounds_by_strand(result.conveyor).items():
        level, name = contacts.covers[strand].level, escape_braces(compound.name)
        if level is not None:
            low, high = contacts.test_factor_range(strand)
            beyond = "" if level.anchor.tested_at(level.temperature) else ", held beyond the tested temperatures"
            yield message(
                f'compound "{name}": indentation of the {strand} rolls {contacts.test_factor(strand):.2f} times '
                f"the theory ({percent(low - 1.0)} to +{percent(high - 1.0)}), the level of its "
                f"rolling-resistance tests{beyond}"
            )
        elif compound.tests:
            why = "calculation.anchor is off" if calculation.anchor == "off" else "the support is not confined"
            yield message(f'compound "{name}": {why}, its rolling-resistance tests are not used')
        else:
            yield message(
                f'compound "{name}": level not tested: published tests of low-resistance covers lie 2 to 2.5 times '
                "above tyre-type small-strain data; give the compound rolling-resistance tests"
            )
    if 0.0 < result.balance.friction_factor < LEAST_PUBLISHED_FRICTION:
        yield message(
            f"friction factor {result.balance.friction_factor:.4f} is below {LEAST_PUBLISHED_FRICTION:g}, the "
            "best ever measured on a conveyor (Henderson PC2, Alspaugh 2004): look for resistances that are missing or "
            "too low"
        )


def _contact_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    conveyor, contacts = result.conveyor, result.contacts
    support = conveyor.calculation.support
    if isinstance(contacts, BeltContacts):
        for give in contacts.gives:
            yield message(
                f"the belt gives under the {give.strand} rolls: indentation changes by {percent(give.change, 1)} "
                "against a stiff carcass, at effective tensions of {} to {}",
                (give.tensions[0], "line force"),
                (give.tensions[2], "line force"),
            )
        if conveyor.calculation.flexure is None:
            yield message(
                "the flexure of the belt by load and sag, {} on a stiff carcass, is not added: the belt that bends "
                "over the rolls holds it, with the loss that its carcass is given",
                (contacts.flexure_left_out, "force"),
            )
        if conveyor.belt.carcass.bending_loss == 0.0:
            yield message(
                "belt.carcass.bending_loss is 0: no figure holds what the carcass loses as it bends, which must be "
                "known before the power on a belt that gives is"
            )
        if conveyor.belt.carcass.bending_stiffness is None:
            yield message(
                f"belt.carcass.bending_stiffness not given: {CARCASS_BENDING.value:g} N m² per metre of width taken "
                f"({CARCASS_BENDING.low:g} to {CARCASS_BENDING.high:g}; general knowledge)"
            )
        if conveyor.belt.carcass.stiffness is None:
            yield message("belt.carcass.stiffness not given: a usual multiple of strength or rating taken")
        if conveyor.calculation.flexure is not None and conveyor.calculation.flexure.belt is not None:
            yield message('calculation.flexure.belt is not used: support "belt" includes that loss')
    elif support != "confined":
        yield message(
            f'calculation.support is "{support}": a real cover is bonded to a carcass far stiffer than rubber, '
            '"confined" is meaningful for it; use this one to compare with the paper'
        )


def _omission_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    line = result.line
    if line.secondary == "itemised":
        if not line.pulleys:
            yield message("route.pulleys not given: wraps and pulley bearings not included")
        elif line.pulleys[0].assumed:
            yield message(
                "route.pulleys not given: a head and a tail pulley of {} assumed, the least the carcass bears (general "
                "knowledge)",
                (line.pulleys[0].diameter, "thickness"),
            )
        elif line.belt.steel_cord:
            yield message("wrap of a steel-cord belt: coefficients are general knowledge, not read in the standard")
        if not line.loading and line.flow > 0.0:
            yield message("route.feeding not given: acceleration of the material and skirts not included")
    if line.loading and line.loading[0].assumed:
        yield message(
            "route.feeding not given: bulk that lands at rest, skirts of {}, {} apart, assumed as in the worked "
            "example of ISO 5048",
            (line.loading[0].skirt_length, "length"),
            (line.loading[0].skirt_width, "thickness"),
        )
    if not line.scrapers:
        yield message("route.cleaners not given: cleaners not included")
    elif line.scrapers[0].assumed:
        yield message(
            f"route.cleaners not given: {line.scrapers[0].count} as wide as the belt assumed, pressed as in the worked "
            "example of ISO 5048 (general knowledge)"
        )


def _tripper_warnings(line: Line) -> Iterator[Message]:
    for point in line.loading:
        if point.lift == 0.0:
            yield message(
                f"tripper at the {escape_braces(point.place)}: tripper_lift not given or 0: lift of its material "
                f"not included"
            )


def _calibration_warnings(conveyor: Conveyor) -> Iterator[Message]:
    given = conveyor.calculation.calibration
    if given is None or all(factor == 1.0 for factor in given.factors.values()):
        return
    factors = ", ".join(f"{name.replace('_', ' ')} x {value:g}" for name, value in given.factors.items())
    source = "no source given" if given.source is None else escape_braces(given.source)
    yield message(
        f"calculation.calibration: {factors} ({source}) in forces, tensions and power, not in figures of single rolls"
    )


def _drive_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    drive, balance = result.conveyor.drive, result.balance
    if balance.settled.least_force < 0.0:
        given = "least_friction" in drive.model_fields_set
        source = "" if given else ", general knowledge: f 0.012 downhill over 0.020"
        yield message(
            f"drive force {{}} at {percent(drive.certain_friction)} of the calculated friction, the minimum "
            f"(drive.least_friction{source}), {{}} at all of it; grip and brakes are checked at the minimum",
            (balance.settled.least_force, "force"),
            (balance.forces.total, "force"),
        )
    line = result.line
    if line.start_factor is None:
        usual = f"{START_FACTOR.low:g} to {START_FACTOR.high:g} are usual"
        if not line.torque_curve or balance.settled.force <= 0.0:
            yield message(f"drive.start_factor not given: {START_FACTOR.value:g} assumed, {usual}")
        else:
            yield message(
                "drive.start_factor not given: an uncontrolled start, all that the motors give reaches the belt"
            )
    if line.start_factor is None and line.torque_curve and any(each.power is None for each in line.drives):
        yield message("drive.installed_power not given: the motors' torque and the start are not known")
    assumed = [each for each in line.drives if not each.mass_given]
    for each in assumed:
        if each.power is None:
            yield message(
                f'rotating masses of "{escape_braces(each.name)}" not given (drive.reduced_mass, inertia), nor its '
                f"power: "
                "start and stop do not include them"
            )
        else:
            yield message(
                f'rotating masses of "{escape_braces(each.name)}" not given (drive.reduced_mass, inertia): {{}} at '
                f"the belt "
                f"assumed, {DRIVE_INERTIA.value:g} s of its rated power ({DRIVE_INERTIA.source}; general knowledge)",
                (each.reduced_mass, "mass"),
            )
    if balance.power.mains < 0.0 and lacks_feed_in_price(result.conveyor.operation):
        yield message("operation.feed_in_price not given: energy that is fed back earns nothing")


def _slack_side_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """A take-up before the drives, as the belt drives the motors."""
    if result.line.take_up.on_slack_side and result.balance.settled.force < 0.0:
        yield message(
            "the belt drives the motors: the slack side, where the take-up stands under every load, is before the "
            "drives; give route.take_up.position if it is built elsewhere"
        )


COLD_OIL_VISCOSITY = (
    1e-3  # [m²/s], ten times a usual base oil at 40 degC: its drag is then a multiple of the measured range
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
        f"The axes of the idler sets are askew at random, carry {carry:.2g} deg, return {back:.2g} deg (standard "
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


def _drag_assumption(conveyor: Conveyor) -> str:
    in_service = conveyor.calculation.roll_drag == "in service"
    laws = {
        strand: sorted({_law_in_words(roll, in_service=in_service) for _, roll in _rolls_by_field(idlers)})
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


def _rolls_by_field(idlers: IdlerSet) -> list[tuple[str, Roll]]:
    """Rolls of a set with their field names."""
    rolls = [("roll", idlers.roll)]
    return rolls if idlers.middle_roll is None else [*rolls, ("middle_roll", idlers.middle_roll)]


def _library_models(conveyor: Conveyor) -> Iterator[tuple[str, LibraryItem]]:
    yield "belt", conveyor.belt
    yield "material", conveyor.material
    for strand, idlers in (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_)):
        for name, roll in _rolls_by_field(idlers):
            yield f"idlers.{strand}.{name}", roll


def _library_assumptions(conveyor: Conveyor) -> Iterator[str]:
    for field, model in _library_models(conveyor):
        entry = model.entry
        if entry is not None:
            note = f"; {entry.note}" if entry.note else ""
            yield f'{field}: "{entry.name}" of the library where the spec gives nothing ({entry.source}){note}.'


def roll_warnings(result: CalculatedConveyor) -> tuple[Message, ...]:
    """Warnings on defaults in use and strained laws of rolls, sets and belt."""
    conveyor = result.conveyor
    return (
        *_mass_warnings(conveyor),
        *_drag_warnings(result),
        *_flexure_warnings(conveyor),
        *_library_warnings(conveyor),
        *_alignment_warnings(conveyor),
        *_cover_warnings(conveyor),
        *_set_warnings(result),
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
        for name, roll in _rolls_by_field(idlers):
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
    return [drags[place] for stretch, drags in pairs if stretch.strand == strand for place in places]


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
                f"that one measured site has its {100.0 * FLEXURE_SHARE.value:.0f} % at 1 % sag (general knowledge)"
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
    for field, model in _library_models(conveyor):
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
        if stretches[0].tilt_angle > 0.0 or any(s.turn is not None and s.turn.guided for s in stretches):
            friction = ROLL_ON_BELT_FRICTION.value
            yield message(
                f"idlers.{strand}: friction of belt on tilted or skewed rolls {friction:g} assumed (general knowledge)"
            )
        if idlers.offset.magnitude > 0.0:
            yield message(f"idlers.{strand}.offset: the loads of the rolls are those of a set in one plane")
        spacing = max(stretch.spacing for stretch in stretches)
        if spacing > widest[strand]:
            yield message(
                f"idlers.{strand}: sets {{}} apart, the widest in use on overland conveyors are {{}}",
                (spacing, "length"),
                (widest[strand], "length"),
            )


def _other_warnings(conveyor: Conveyor) -> Iterator[Message]:
    if any("scraping_factor" not in plough.model_fields_set for plough in conveyor.route.ploughs):
        yield message(
            f"route.ploughs: scraping factor {SCRAPING_FACTOR.value:g} N/m assumed, normal value of ISO 5048 as "
            "commonly reproduced: it knows neither density nor speed"
        )
    if conveyor.calculation.cema is not None:
        yield message(
            "CEMA classic form: formulas and figures as commonly reproduced, Ky, Kt, Ai, Cs by the spec, "
            "one Ky for the whole conveyor"
        )
        if conveyor.route.feeding is not None and conveyor.calculation.cema.skirt_factor is None:
            yield message("calculation.cema.skirt_factor not given: of the skirts only the seals are in CEMA's figures")
