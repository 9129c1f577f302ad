"""Warnings where an assumption is strained, a default is in use or a result is doubtful."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks import Check
from conveyor.laws.motion import DRIVE_INERTIA, START_FACTOR
from conveyor.laws.resistance import (
    CARCASS_BENDING,
)
from conveyor.line.belt_contacts import BeltContacts
from conveyor.line.covers import compounds_by_strand
from conveyor.line.line import Line
from conveyor.loop.annual_energy import lacks_feed_in_price
from conveyor.models import Conveyor
from conveyor.models.calculation_methods import FACTOR_METHODS
from conveyor.models.driven_pulleys import missing_driven_pulleys
from conveyor.models.plausibility import implausible_inputs
from conveyor.remarks.assumptions import failed_fits
from conveyor.remarks.part_warnings import part_warnings
from conveyor.units import text
from conveyor.units.sentences import ZERO_CELSIUS, Message, escape_braces, message, percent

LEAST_PUBLISHED_FRICTION: Final = 0.0075
"""Friction factor measured over six shifts on Henderson PC2, 16.28 km (Alspaugh, MINExpo 2004) [-]."""
LEAST_FILLING: Final = 0.01
"""Share of the section that the belt holds to its edges below which a unit may be wrong [-]; general knowledge."""
LARGEST_MOTORS: Final = 20.0
"""Installed power over that asked for above which a unit may be wrong [-]; general knowledge."""


def analysis_warnings(result: CalculatedConveyor, checked: Iterable[Check]) -> tuple[Message, ...]:
    """Warnings: strained assumptions, defaults in use, failed checks, doubtful results."""
    conveyor = result.conveyor
    by_rubber = result.line.method == "viscoelastic"
    return tuple(
        dict.fromkeys(
            (
                *implausible_inputs(conveyor),
                *(_rubber_warnings(conveyor) if by_rubber else ()),
                *(_strain_warnings(result) if by_rubber else ()),
                *(_test_factor_warnings(result) if by_rubber else ()),
                *(_contact_warnings(result) if by_rubber else ()),
                *part_warnings(result),
                *_omission_warnings(result),
                *_tripper_warnings(result.line),
                *_calibration_warnings(conveyor),
                *_size_warnings(result),
                *_drive_warnings(result),
                *_driven_pulley_warnings(conveyor),
                *_cold_warnings(conveyor),
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
    by_strand = compounds_by_strand(conveyor)
    yield from (message(escape_braces(failure)) for failure in failed_fits(by_strand.values()))
    for strand, compound in by_strand.items():
        name = escape_braces(compound.name)
        if compound.kind == "illustrative":
            yield message(f'compound "{name}" is illustrative, not measured: for comparison, not for design')
        if strand == "return" and conveyor.belt.top_cover.compound is None and not conveyor.bottom_cover_on_both:
            yield message(f'top_cover.compound is not given: the return rolls run on the bottom cover\'s, "{name}"')
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
            note = f" ({known.reference_note})" if known.reference_note else ""
            reference = escape_braces(f"{text(known.reference_strain)}{note}")
            yield message(
                f'compound "{name}": working strain under the {strand} rolls {percent(worked.strain, 1)} at '
                f"{worked.frequency:.3g} Hz: E' x {worked.storage_factor:.3g}, E'' x {worked.loss_factor:.3g} of "
                f"the master curve at {reference}"
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
        tested, name = contacts.covers[strand].test_factor, escape_braces(compound.name)
        if not contacts.rolls_on(strand):
            continue
        if tested is not None:
            low, high = contacts.test_factor_range(strand)
            within = tested.rolling_tests.tested_at(tested.temperature)
            beyond = "" if within else ", held beyond the tested temperatures"
            yield message(
                f'compound "{name}": indentation of the {strand} rolls {contacts.test_factor(strand):.2f} times '
                f"the theory ({percent(low - 1.0)} to +{percent(high - 1.0)}), by the test factor of "
                f"its rolling-resistance tests{beyond}"
            )
        elif compound.tests:
            why = "calculation.anchor is off" if calculation.anchor == "off" else "the support is not confined"
            yield message(f'compound "{name}": {why}, its rolling-resistance tests are not used')
        else:
            yield message(
                f'compound "{name}": no rolling-resistance tests: published ones of low-resistance covers lie 2 to 2.5 '
                "times above tyre-type small-strain data; give the compound rolling-resistance tests"
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


def _usual_pulleys_message(line: Line) -> Message:
    """Message on the pulleys assumed where the spec gives none."""
    diameters = dict.fromkeys((pulley.position, (pulley.diameter, "thickness")) for pulley in line.pulleys)
    at_take_up = "" if len(diameters) == 2 else ", at the take-up a pulley and two bends of {},"
    return message(
        f"route.pulleys not given: a head pulley of {{}}{at_take_up} and a tail pulley of {{}} assumed, the least the "
        "carcass bears where no drive gives its pulley_diameter (general knowledge)",
        *(diameter for _, diameter in diameters),
    )


def _omission_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    line = result.line
    if line.secondary == "itemised":
        if not line.pulleys:
            yield message("route.pulleys not given: wraps and pulley bearings not included")
        elif line.pulleys[0].assumed:
            yield _usual_pulleys_message(line)
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


def _size_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """A flow far too small for the belt, and motors far too large for the conveyor."""
    conveyor, line, motor = result.conveyor, result.line, result.balance.layout.motor
    share = line.flow / (line.speed * line.density * conveyor.flooded_section)
    if 0.0 < share < LEAST_FILLING:
        yield message(
            f"material.flow {text(conveyor.material.flow)} takes {percent(share, 2)} of what the belt holds to its "
            "edges: its unit?"
        )
    powers = [drive.power for drive in line.drives if drive.power is not None]
    asked = max(abs(motor(force)) for force in result.drive_forces)
    if len(powers) == len(line.drives) and math.fsum(powers) > LARGEST_MOTORS * asked > 0.0:
        yield message(
            f"drive.installed_power: {{}} are {math.fsum(powers) / asked:.0f} times what the conveyor takes or gives: "
            "its unit?",
            (math.fsum(powers), "power"),
        )


def _drive_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    drive, balance = result.conveyor.drive, result.balance
    if balance.equilibrium.least_force < 0.0:
        source = ", general knowledge: f 0.012 downhill over 0.020"
        if drive.least_friction is not None:
            source = ""
        elif result.line.method == "cema classic":
            source = ", half of it: Overland Conveyor, Belt Analyst"
        yield message(
            f"drive force {{}} at {percent(result.line.least_friction)} of the calculated friction, the least "
            f"(drive.least_friction{source}), {{}} at all of it; grip and brakes are checked at the least",
            (balance.equilibrium.least_force, "force"),
            (balance.forces.total, "force"),
        )
    line = result.line
    if line.start_factor is None:
        usual = f"{START_FACTOR.low:g} to {START_FACTOR.high:g} are usual"
        if not line.torque_curve or balance.equilibrium.force <= 0.0:
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
                f"the belt assumed, kinetic energy of {DRIVE_INERTIA.value:g} s at rated power "
                f"({DRIVE_INERTIA.source}; general knowledge)",
                (each.reduced_mass, "mass"),
            )
    if balance.power.mains < 0.0 and lacks_feed_in_price(result.conveyor.operation):
        yield message("operation.feed_in_price not given: energy that is fed back earns nothing")


def _driven_pulley_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Drives whose pulleys are not all listed: what is listed bears the force of all."""
    for place, listed, needed in missing_driven_pulleys(conveyor.drive, conveyor.route.pulleys):
        yield message(
            f"route.pulleys: {listed} driven at {escape_braces(place)}, the drives there turn {needed}: shafts, "
            "bearings and torques are those of the pulleys listed; list all that are driven"
        )


def _cold_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """A classical method below freezing with the factors of a warm day."""
    calculation, lowest = conveyor.calculation, conveyor.lowest_temperature
    if calculation.method == "viscoelastic" or lowest >= ZERO_CELSIUS:  # freezing: above it CEMA's Kt is 1
        return
    if calculation.method in FACTOR_METHODS:
        yield message(
            "calculation.friction_factor: f is one for all temperatures; for {} give that of the cold",
            (lowest, "temperature"),
        )
    elif calculation.cema is not None and calculation.cema.temperature_factor == 1.0:
        yield message(
            "calculation.cema.temperature_factor is 1, which holds above freezing: for {} give the book's Kt",
            (lowest, "temperature"),
        )


def _slack_side_warnings(result: CalculatedConveyor) -> Iterator[Message]:
    """A take-up before the drives, as the belt drives the motors."""
    take_up = result.conveyor.route.take_up
    confirmed = take_up is not None and "position" in take_up.model_fields_set
    if result.line.take_up.on_slack_side and result.balance.equilibrium.force < 0.0 and not confirmed:
        yield message(
            "the belt drives the motors: the slack side, where the take-up stands under every load, is before the "
            "drives; give route.take_up.position if it is built elsewhere"
        )
