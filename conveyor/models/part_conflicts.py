"""Checks between the parts of a conveyor, each naming both fields and what to change."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from conveyor.errors import InputError, MessageQuantity, RangeError
from conveyor.laws.idler_sets import rated_set_load
from conveyor.laws.loading import bulk_line_mass
from conveyor.laws.pipe_geometry import FURTHEST_LAP
from conveyor.laws.resistance import SHORTEST_FOR_FACTOR
from conveyor.laws.tension import usual_stiffness
from conveyor.models.base import Problem
from conveyor.models.belt import Cover, TopCover
from conveyor.models.belt_shapes import OVERFILL_LIMIT
from conveyor.models.bulk_sections import skirted_areas
from conveyor.models.calculation_methods import FACTOR_METHODS
from conveyor.models.drive import DrivePulley
from conveyor.models.driven_pulleys import driven_pulleys
from conveyor.models.feeder_conflicts import hopper_problems, located_feeding
from conveyor.models.idlers import IdlerSet, overlap_problems
from conveyor.models.parts import Calculation, ConveyorParts
from conveyor.models.route import Route
from conveyor.models.validation_messages import Location
from conveyor.units import Quantity, from_si, si, text, unit_system
from conveyor.units.presentation import format_figure

_FLOW_ROUNDING: Final = 1e-9
"""Relative rounding of a flow derived from a cross-section [-]."""
_ROUNDED_DIAMETER: Final = 1e-3
"""Relative rounding of a diameter in another unit, 610 mm for 24 in [-]."""


def _idler_sets(conveyor: ConveyorParts) -> tuple[tuple[str, IdlerSet], tuple[str, IdlerSet]]:
    return (("carry", conveyor.idlers.carry), ("return", conveyor.idlers.return_))


def _roll_length_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse rolls that together are narrower than the belt, or inner rolls as wide as the belt."""
    width = conveyor.belt.width
    for strand, idlers in _idler_sets(conveyor):
        each = si(idlers.roll.length)
        location = ("idlers", strand, "roll", "length")
        if idlers.shape.closed:
            continue
        if idlers.rolls * each < si(width):
            yield Problem(
                location,
                f"got {text(idlers.roll.length)}: {idlers.rolls} roll(s) side by side are "
                f"{_in_roll_unit(idlers.rolls * each, idlers)} wide, the belt (belt.width) {text(width)}; "
                "take longer rolls or a narrower belt",
            )
        elif (idlers.rolls - 2) * each >= si(width):
            yield Problem(
                location,
                f"got {text(idlers.roll.length)}: the inner rolls alone are as wide as the belt "
                f"(belt.width {text(width)}); take shorter rolls or a wider belt",
            )


def _in_roll_unit(length: float, idlers: IdlerSet) -> str:
    unit = text(idlers.roll.length).split()[1]
    return text(from_si(float(f"{length:.6g}"), "length", unit))


def _fill_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a flow beyond the calculated range; up to it an overfull trough (ISO 5048) only fails its check."""
    belt, material = conveyor.belt, conveyor.material
    if si(material.flow) == 0.0:
        return
    needed = bulk_line_mass(si(material.flow), belt_speed=si(belt.speed)) / si(material.density)
    skirted = skirted_areas(conveyor)
    between = [skirted.get(section.name, 0.0) for section in conveyor.route.sections if section.loaded]
    if between and needed <= OVERFILL_LIMIT * min(between):
        return
    shape, of_belt = conveyor.idlers.carry.shape, (conveyor.belt_width, conveyor.material.surcharge)
    area, flooded = shape.largest_section(*of_belt).area, shape.flooded_section(*of_belt).area
    calculated = shape.most_calculated(*of_belt)
    if needed <= calculated * (1.0 + _FLOW_ROUNDING):
        return
    system = unit_system(belt.width)
    sections_of = (
        MessageQuantity(each, "area", format_figure(each, "area", system, as_input=True))
        for each in (needed, area, calculated)
    )
    most = from_si(si(material.flow) * area / needed, "mass flow", text(material.flow).split()[1])
    least = from_si(si(belt.speed) * needed / area, "speed", text(belt.speed).split()[1])
    metric = ""
    if system == "US" and text(material.flow).endswith(" tph"):
        metric = "; tph are metric tonnes per hour, short tons per hour are stph"
    why = shape.brim if calculated == flooded else f"{100.0 * OVERFILL_LIMIT:g} % of that"
    yield Problem(
        ("material", "flow"),
        InputError(
            f"got {text(material.flow)}, which at {text(belt.speed)} (belt.speed) and {text(material.density)} "
            f"(material.density) needs a cross-section of {{}}, the belt holds {{}} and is calculated up to {{}}, "
            f"{why}: reduce material.flow to {_safe_limit(most, down=True)} or less, raise belt.speed to "
            f"{_safe_limit(least, down=False)} or more, or take {shape.larger}{metric}",
            *sections_of,
        ),
    )


def _safe_limit(value: Quantity, *, down: bool) -> str:
    """Limit as text of three digits, rounded to the safe side."""
    number, unit = float(value.magnitude), text(value).split()[1]
    step = 10.0 ** (math.floor(math.log10(number)) - 2)
    whole = math.floor(number / step) if down else math.ceil(number / step)
    return f"{whole * step:.6g} {unit}"


def _idler_class_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse an idler class without a rating for the belt width, number of rolls and trough."""
    for strand, idlers in _idler_sets(conveyor):
        if idlers.cema_class is None:
            continue
        try:
            rated_set_load(
                idlers.cema_class,
                belt_width=conveyor.belt_width,
                trough_angle=si(idlers.trough_angle),
                rolls=idlers.rolls,
            )
        except RangeError as error:
            why = InputError("{}; give rating, of its maker, instead", error)
            yield Problem(("idlers", strand, "cema_class"), why)


def _wear_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Require the severity of loading or the drop height for belt wear."""
    wear, feeding = conveyor.belt.wear, conveyor.route.feeding
    if wear is not None and wear.loading is None and (feeding is None or feeding.drop_height is None):
        message = "missing: give it, or the height of fall as route.feeding.drop_height"
        yield Problem(("belt", "wear", "loading"), message)


def _spacing_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse section spacings at which rolls of neighbouring sets overlap."""
    for i, section in enumerate(conveyor.route.sections):
        for strand, idlers in _idler_sets(conveyor):
            spacing = section.carry_spacing if strand == "carry" else section.return_spacing
            if spacing is not None:
                yield from overlap_problems(("route", "sections", i, f"{strand}_spacing"), spacing, idlers)


def _scale_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a belt scale that does not end within its section."""
    lengths = {section.name: section for section in conveyor.route.sections}
    for i, scale in enumerate(conveyor.route.belt_scales):
        section = lengths[scale.section]
        spacing = section.carry_spacing or conveyor.idlers.carry.spacing
        if si(scale.distance) + (scale.weigh_sets - 1) * si(spacing) > si(section.length):
            yield Problem(
                ("route", "belt_scales", i, "distance"),
                f"got {text(scale.distance)} and {scale.weigh_sets} weigh_sets {text(spacing)} apart, but section "
                f'"{section.name}" is only {text(section.length)} long: stand it nearer, or name the section it is in',
            )


def _cover_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a cover as thick as the radius of a roll that runs on it."""
    belt, idlers = conveyor.belt, conveyor.idlers
    bottom_on_both = conveyor.bottom_cover_on_both
    under: dict[str, tuple[Cover | TopCover, list[IdlerSet]]] = {
        "bottom_cover": (belt.bottom_cover, [idlers.carry] + [idlers.return_] * bottom_on_both),
        "top_cover": (belt.top_cover, [] if bottom_on_both else [idlers.return_]),
    }
    for name, (cover, sets) in under.items():
        rolls = [roll for idler_set in sets for roll in (idler_set.roll, idler_set.middle)]
        thinnest = min(rolls, key=lambda roll: si(roll.diameter), default=None)
        if thinnest is not None and si(cover.thickness) >= si(thinnest.diameter) / 2.0:
            yield Problem(
                ("belt", name, "thickness"),
                f"got {text(cover.thickness)}, but the rolls it runs on are {text(thinnest.diameter)} in diameter: "
                "a cover must be thinner than their radius; correct the thickness or the roll diameter",
            )


def _temperature_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a belt temperature at which a compound is not known."""
    ambient = conveyor.ambient
    field = "temperature" if ambient.belt_temperature is None else "belt_temperature"
    compounds = {"belt.bottom_cover.compound": conveyor.carry_compound}
    if conveyor.return_compound is not conveyor.carry_compound:
        compounds["belt.top_cover.compound"] = conveyor.return_compound
    for name, compound in compounds.items():
        try:
            compound.check_temperature(si(ambient.belt))
        except RangeError as error:
            why = InputError('got {}, but {} is "{}": {}', text(ambient.belt), name, compound.name, error)
            yield Problem(("ambient", field), why)


def _feeding_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse feeding faster than the belt, and skirts, cleaners or ploughs wider than it."""
    belt, route = conveyor.belt, conveyor.route
    points = located_feeding(route)
    for location, point in points.items():
        if si(point.speed) > si(belt.speed):
            yield Problem(
                ("route", *location, "speed"),
                f"got {text(point.speed)}, faster than the belt (belt.speed {text(belt.speed)}); "
                "the law holds for bulk that the belt accelerates: correct one of the two",
            )
    widths: dict[Location, Quantity] = {
        (*location, "skirt_width"): point.skirt_width for location, point in points.items()
    }
    widths |= {("cleaners", i, "width"): cleaner.width for i, cleaner in enumerate(route.cleaners)}
    widths |= {("ploughs", i, "width"): plough.width for i, plough in enumerate(route.ploughs)}
    for location, width in widths.items():
        if si(width) > si(belt.width):
            yield Problem(
                ("route", *location),
                f"got {text(width)}, wider than the belt (belt.width {text(belt.width)}); correct one of the two",
            )


def _discharge_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Require the diameter of the discharge pulley."""
    route = conveyor.route
    if route.discharge is None or route.discharge.pulley_diameter is not None:
        return
    usual = not route.pulleys and conveyor.calculation.not_given == "usual values"
    if not usual and all(pulley.position != "head" for pulley in route.pulleys):
        message = "missing: no pulley of route.pulleys stands at the head; give the diameter, or the pulley"
        yield Problem(("route", "discharge", "pulley_diameter"), message)


def _drive_section_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse drives at sections that the route does not have."""
    drive = conveyor.drive
    named: dict[Location, str | None] = {("drive", "section"): drive.section}
    named |= {("drive", "further_drives", i, "section"): d.section for i, d in enumerate(drive.further_drives)}
    for location, name in named.items():
        if name is not None:
            yield from conveyor.route.section_problem(location, name)


def drive_diameter(conveyor: ConveyorParts, drive: DrivePulley) -> Quantity | None:
    """Drive pulley diameter: as given, else of the pulley there with the largest wrap; None without one."""
    if drive.pulley_diameter is not None:
        return drive.pulley_diameter
    place = (drive.position, drive.section)
    here = [pulley for pulley in conveyor.route.pulleys if (pulley.position, pulley.section) == place]
    return max(here, key=lambda pulley: pulley.wrap_or_half_turn).diameter if here else None


def _driven_diameter_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse driven pulleys of another diameter than their drive gives."""
    drive, pulleys = conveyor.drive, conveyor.route.pulleys
    for number, turned, _ in driven_pulleys(drive, pulleys):
        own, given = pulleys[number].diameter, drive.pulleys[turned].pulley_diameter
        if given is None or math.isclose(si(own), si(given), rel_tol=_ROUNDED_DIAMETER):
            continue
        field = "drive.pulley_diameter" if turned == 0 else f"drive.further_drives[{turned - 1}].pulley_diameter"
        message = f"got {text(own)}, but the drive that turns it has {text(given)} ({field}); correct one of the two"
        yield Problem(("route", "pulleys", number, "diameter"), message)


def _radius_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Require the pulley diameter of a drive with a moment of inertia, or a torque that acts by it."""
    drive = conveyor.drive
    for i, pulley in enumerate(drive.pulleys):
        place: Location = ("drive",) if i == 0 else ("drive", "further_drives", i - 1)
        turned = pulley.motor_shaft_field if pulley.gear_ratio is None else ""
        field = (
            "inertia" if pulley.inertia is not None else "brake_torque" if pulley.brake_torque is not None else turned
        )
        if field and drive_diameter(conveyor, pulley) is None:
            message = f"missing: {field} acts over the pulley's radius; give it, or the pulley in route.pulleys"
            yield Problem((*place, "pulley_diameter"), message)


def _face_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse pulleys that are not wider than the belt."""
    for i, pulley in enumerate(conveyor.route.pulleys):
        if pulley.face_width is not None and si(pulley.face_width) <= si(conveyor.belt.width):
            message = f"got {text(pulley.face_width)}, not wider than the belt (belt.width {text(conveyor.belt.width)})"
            yield Problem(("route", "pulleys", i, "face_width"), f"{message}; take a wider pulley")


def _bulk_flexure_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse bulk flexure with four or five rolls."""
    flexure, rolls = conveyor.calculation.flexure, conveyor.idlers.carry.rolls
    if flexure is not None and flexure.bulk is not None and rolls in {4, 5, 6}:
        yield Problem(
            ("calculation", "flexure", "bulk"),
            f"given, but the wings of {rolls} rolls (idlers.carry.rolls) have no law; remove it, or take 2 or 3 rolls",
        )


def _belt_support_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Require incompressible covers and the carcass stiffness for the support "belt"."""
    if conveyor.calculation.support != "belt":
        return
    carcass = conveyor.belt.carcass
    strength, rating = (None if each is None else si(each) for each in (carcass.strength, carcass.rating))
    usual = usual_stiffness(strength, rating=rating, carcass=carcass.kind)
    if carcass.stiffness is None and usual is None:
        message = (
            'missing: calculation.support "belt" needs it; give it, or strength or rating of a carcass of steel '
            "cord, EP or polyamide"
        )
        yield Problem(("belt", "carcass", "stiffness"), message)
    for name, cover in (("bottom_cover", conveyor.belt.bottom_cover), ("top_cover", conveyor.belt.top_cover)):
        if cover.compound is not None and cover.compound.poisson_ratio != 0.5:
            yield Problem(
                ("belt", name, "compound"),
                f"has the poisson_ratio {cover.compound.poisson_ratio:g}: the covers of calculation.support "
                '"belt" are incompressible; set it to 0.5, or take the support "confined"',
            )


def _curve_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse flat sets of several rolls in a horizontal curve."""
    curved = next((s.name for s in conveyor.route.sections if s.horizontal_curve is not None), None)
    if curved is None:
        return
    where = f'section "{curved}" is a horizontal curve'
    for strand, idlers in _idler_sets(conveyor):
        if idlers.rolls > 1 and si(idlers.trough_angle) == 0.0 and not idlers.shape.closed:
            message = (
                f"got {text(idlers.trough_angle)}, but {where}, in which nothing holds a flat belt on several rolls: "
                "take a trough, or rolls: 1"
            )
            yield Problem(("idlers", strand, "trough_angle"), message)


def _pipe_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a pipe without closing belt or own f, one on the return strand alone, and banking of pipes."""
    carry, back = conveyor.idlers.carry.pipe, conveyor.idlers.return_.pipe
    if back is not None and (carry is None or si(carry.diameter) != si(back.diameter)):
        beside = "the carry strand is none" if carry is None else f"the carry strand's is {text(carry.diameter)}"
        message = f"got {text(back.diameter)}, but {beside}: both strands are the same pipe, or the return is flat"
        yield Problem(("idlers", "return", "pipe", "diameter"), message)
    if carry is None:
        return
    yield from _forming_problems(conveyor)
    calculation = conveyor.calculation
    if calculation.method in FACTOR_METHODS and "friction_factor" not in calculation.model_fields_set:
        message = (
            f'missing: method "{calculation.method}" takes f of a trough where none is given, without what forms the '
            "pipe: give that of pipe conveyors, or take method viscoelastic"
        )
        yield Problem(("calculation", "friction_factor"), message)
    belt = conveyor.belt
    if 2.0 * math.pi * carry.carcass_radius(belt.top_cover.thickness, belt.carcass.thickness) > si(belt.width):
        message = (
            f"got {text(carry.diameter)}, round which the carcass of the belt (belt.width {text(belt.width)}) does not "
            "close: take a smaller pipe or a wider belt"
        )
        yield Problem(("idlers", "carry", "pipe", "diameter"), message)
    if si(conveyor.belt.width) >= FURTHEST_LAP * math.pi * si(carry.diameter):
        message = (
            f"got {text(carry.diameter)}, round which the belt (belt.width {text(conveyor.belt.width)}) laps more than "
            "twice: take a larger pipe or a narrower belt"
        )
        yield Problem(("idlers", "carry", "pipe", "diameter"), message)
    if back is not None and conveyor.route.turned_over:
        message = "got true, but the return strand is a pipe too, whose rolls run on the bottom cover anyway: remove it"
        yield Problem(("route", "turned_over"), message)
    why = "given, but a pipe (idlers.carry.pipe)"
    for i, section in enumerate(conveyor.route.sections):
        for name in ("carry_banking", "carry_skew", *(() if back is None else ("return_banking", "return_skew"))):
            if getattr(section, name) is not None:
                message = f"{why} is held by its rolls all round, which bank and steer nothing; remove it"
                yield Problem(("route", "sections", i, name), message)


def _forming_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Require what holds the pipe open, once."""
    stiffness = conveyor.belt.transverse_stiffness
    for strand, idlers in _idler_sets(conveyor):
        if (pipe := idlers.pipe) is None:
            continue
        location = ("idlers", strand, "pipe", "forming_load")
        if stiffness is None and pipe.forming_load is None:
            message = "missing: give it or belt.transverse_stiffness, by which the belt holds the pipe open: no default"
            yield Problem(location, message)
        elif stiffness is not None and pipe.forming_load is not None:
            message = (
                f"got {text(pipe.forming_load)} beside belt.transverse_stiffness {text(stiffness)}; give one of the two"
            )
            yield Problem(location, message)


def _length_coefficient_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse the length coefficient C for short conveyors."""
    if conveyor.calculation.secondary == "C" and (length := conveyor.route.length) <= SHORTEST_FOR_FACTOR:
        yield Problem(
            ("calculation", "secondary"),
            InputError(
                'got "C", but route.sections are {} long together and C holds for more than {}; set '
                'calculation.secondary to "itemised"',
                *(
                    MessageQuantity(each, "length", format_figure(each, "length", as_input=True))
                    for each in (length, SHORTEST_FOR_FACTOR)
                ),
            ),
        )


def _flexure_factor_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    yield from flexure_factor_problems(conveyor.route, conveyor.calculation)


def flexure_factor_problems(route: Route, calculation: Calculation) -> Iterator[Problem]:
    """Refuse Ky of a section without the other factors of CEMA."""
    for i, section in enumerate(route.sections):
        if section.flexure_factor is not None and calculation.cema is None:
            message = (
                f"got {section.flexure_factor:g}, Ky of CEMA, without its other factors; give calculation.cema, or "
                "remove it"
            )
            yield Problem(("route", "sections", i, "flexure_factor"), message)


def _belt_on_bed_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse a plate under a pipe, and under steel cord without its cover."""
    for i, section in enumerate(conveyor.route.sections):
        if section.bed is None:
            continue
        if conveyor.idlers.carry.shape.closed:
            message = "given, but rings of rolls hold the belt as a pipe (idlers.carry.pipe); remove one of the two"
            yield Problem(("route", "sections", i, "bed"), message)
        if conveyor.belt.carcass.kind == "steel cord" and section.bed.underside != "rubber cover":
            message = (
                f'got "{section.bed.underside}", but cords of steel (belt.carcass.kind) lie between covers: take '
                '"rubber cover"'
            )
            yield Problem(("route", "sections", i, "bed", "underside"), message)


def _bed_problems(conveyor: ConveyorParts) -> Iterator[Problem]:
    """Refuse sets, scales, and a yielding carcass on a plate."""
    route = conveyor.route
    plates = {section.name for section in route.sections if section.bed is not None}
    if not plates:
        return
    if conveyor.calculation.support == "belt":
        first = next(i for i, section in enumerate(route.sections) if section.bed is not None)
        message = 'given with calculation.support "belt", a carcass that gives way between rolls; take "confined"'
        yield Problem(("route", "sections", first, "bed"), message)
    for i, scale in enumerate(route.belt_scales):
        if scale.section in plates:
            message = f'got "{scale.section}", a plate (bed): a belt scale weighs on idler sets; name another section'
            yield Problem(("route", "belt_scales", i, "section"), message)
    for location, point in located_feeding(route).items():
        if (point.section or route.sections[0].name) not in plates:
            continue
        of_sets = {
            "idler_spacing": point.idler_spacing,
            "idler_stiffness": point.idler_stiffness,
            "idler_rating": point.idler_rating,
        }
        for name, given in of_sets.items():
            if given is not None:
                message = "given, but the bulk lands over a plate (bed), not over idler sets; remove it"
                yield Problem(("route", *location, name), message)


CONFLICTS: Final[Mapping[Callable[[ConveyorParts], Iterator[Problem]], tuple[str, ...]]] = {
    _roll_length_problems: ("belt", "idlers"),
    _fill_problems: ("belt", "idlers", "material", "route"),
    _spacing_problems: ("idlers", "route"),
    _scale_problems: ("idlers", "route"),
    _idler_class_problems: ("belt", "idlers"),
    _wear_problems: ("belt", "route"),
    _cover_problems: ("belt", "idlers", "route"),
    _temperature_problems: ("ambient", "belt", "idlers", "route"),
    _feeding_problems: ("belt", "route"),
    hopper_problems: ("belt", "idlers", "route"),
    _discharge_problems: ("calculation", "route"),
    _drive_section_problems: ("drive", "route"),
    _driven_diameter_problems: ("drive", "route"),
    _radius_problems: ("drive", "route"),
    _face_problems: ("belt", "route"),
    _length_coefficient_problems: ("calculation", "route"),
    _flexure_factor_problems: ("calculation", "route"),
    _bulk_flexure_problems: ("calculation", "idlers"),
    _belt_support_problems: ("belt", "calculation"),
    _curve_problems: ("idlers", "route"),
    _bed_problems: ("calculation", "route"),
    _belt_on_bed_problems: ("belt", "idlers", "route"),
    _pipe_problems: ("belt", "calculation", "idlers", "route"),
}
"""Checks between the parts, and the parts that each check reads."""
