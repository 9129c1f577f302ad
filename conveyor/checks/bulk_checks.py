"""Criteria of the bulk: filling, transfer points, cleaning, slip."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.check import Check, check_against_limit
from conveyor.loop.ties import first_maximum
from conveyor.units.sentences import escape_braces, message, percent


def belt_filling(result: CalculatedConveyor) -> Iterator[Check]:
    """Every section holds its bulk on its slope."""
    line, holds_on, skirted = result.line, result.conveyor.section_on_slope, result.conveyor.skirted_areas
    loaded = [
        (stretch, stretch.bulk_mass / line.density, skirted.get(stretch.section) or holds_on(stretch.inclination))
        for stretch in line.stretches[: line.count]
        if stretch.bulk_mass > 0.0
    ]
    if loaded:
        stretch, bulk, most = first_maximum(loaded, lambda one: -one[2] / one[1])
        shape = result.conveyor.idlers.carry.shape
        whole, held = most, "level cross-section" if stretch.inclination == 0.0 else "cross-section on its slope"
        source = shape.filling_source
        if stretch.section in skirted:
            held, source = "cross-section between the skirts", "route.feeding.skirt_height"
        elif shape.closed:
            whole, held = result.conveyor.flooded_section, "pipe's cross-section"
        section = f'section "{escape_braces(stretch.section)}"'
        why = message(f"the bulk takes {{}}, {section} holds nothing on its slope", (bulk, "area"))
        if most > 0.0:
            flooded = (result.conveyor.flooded_section, "area")
            spills = [flooded] if bulk > flooded[0] and stretch.section not in skirted else []
            why = message(
                f"the bulk takes {{}}, {percent(bulk / most)} of the {{}} that {section} holds on its slope"
                f"{f', and spills beyond {{}}, {shape.brim}' if spills else ''}: reduce "
                f"material.flow to {{}}, raise belt.speed to {{}}, or take {shape.larger}",
                (bulk, "area"), (most, "area"), *spills,
                (line.flow * most / bulk, "mass flow"), (line.speed * bulk / most, "speed"),
            )  # fmt: skip
        yield check_against_limit(
            "filling", "filling of the belt", bulk, "at most", most, "area", source=source,
            wording=message(f"{{}}, {percent(bulk / whole)} of the {held}" if whole else "{}", (bulk, "area")),
            where=stretch.section, why=why,
        )  # fmt: skip


def bulk_slope(result: CalculatedConveyor) -> Iterator[Check]:
    """The steepest loaded section is no steeper than the bulk is carried on."""
    loaded = [stretch for stretch in result.line.stretches[: result.line.count] if stretch.bulk_mass > 0.0]
    if loaded:
        steepest = first_maximum(loaded, lambda stretch: abs(stretch.inclination))
        most, source = result.conveyor.steepest_for_bulk, "material.max_slope"
        if result.conveyor.material.max_slope is None:
            source = result.conveyor.idlers.carry.shape.slope_source
        yield check_against_limit(
            "bulk_slope", "slope of the steepest loaded section", abs(steepest.inclination), "at most", most, "angle",
            source=source, where=steepest.section,
            why=f'section "{escape_braces(steepest.section)}" slopes by {{calculated}}, the bulk is carried on '
            f"{{required}} at most ({source}): a longer route, or material.max_slope where the bulk bears more",
        )  # fmt: skip


def impact_load(result: CalculatedConveyor) -> Iterator[Check]:
    """Impact sets bear resting weight and impact; for loading points with a drop height."""
    for landing in result.loading_point_duty:
        point, load = landing.point, landing.load
        if load is None:
            continue
        missing = "load that a set there bears (idler_rating) not given"
        if point.lump_mass is not None and landing.lump_force is None:
            missing = "spring rate for the lump (idler_stiffness) not given"
        rating = None if point.lump_mass is not None and landing.lump_force is None else point.idler_rating
        yield check_against_limit(
            "impact_load", f"load of an impact set{escape_braces(point.name)}", load, "at most", rating, "force",
            source="its maker", missing=missing,
            why=f"the bulk lands on sets{escape_braces(point.name)} with {{calculated}}, they bear {{required}}: "
                f"less drop, "
            "sets closer together (stream) or softer (lumps), a heavier series",
        )  # fmt: skip


def skirtboards(result: CalculatedConveyor) -> Iterator[Check]:
    """Skirtboards are at least as long as the zone of acceleration; where their length is given."""
    for landing in result.loading_point_duty:
        point = landing.point
        if point.skirtboards is None:
            continue
        if landing.on_slope is None:
            subject = message(f"length of the skirtboards{escape_braces(point.name)}")
            why = message("the belt is too steep for the bulk that lands on it: it slides back")
            shown, asked = message("{}", (point.skirtboards, "length")), message("no length helps")
            yield Check("skirtboards", subject, point.skirtboards, None, "length", shown, asked, "FAIL", why)
        else:
            level = landing.on_slope == landing.acceleration
            source = "zone of acceleration, ISO 5048" if level else "zone of acceleration on its slope, ISO 5048"
            yield check_against_limit(
                "skirtboards", f"length of the skirtboards{escape_braces(point.name)}", point.skirtboards, "at least",
                landing.on_slope, "length", source=source,
                why=f"the skirtboards{escape_braces(point.name)} end {{calculated}} behind the place of loading, "
                    f"the bulk has "
                "the belt's speed after {required}: longer ones, or bulk that lands faster",
            )  # fmt: skip


def belt_cleaning(result: CalculatedConveyor) -> Iterator[Check]:
    """Carryback behind the cleaners is within the limit; if the spec gives the carryback."""
    on_belt, allowed = result.line.carryback
    if on_belt is not None:
        left = result.cleaner_duty[-1].left if result.cleaner_duty else None
        left = on_belt if left is None else left
        yield check_against_limit(
            "belt_cleaning", "bulk left on the belt behind its cleaners", left, "at most", allowed, "area mass",
            missing="carryback_allowed not given",
            why="the cleaners leave {calculated} on the belt, {required} is allowed: one more, or better ones",
        )  # fmt: skip


def bulk_slip(result: CalculatedConveyor) -> Iterator[Check]:
    """The bulk stays on the belt in running, stopping and starting."""
    slip = result.motions.slip
    if slip is None:
        return
    if slip.sliding:
        where = escape_braces(", ".join(slip.sliding))
        yield Check(
            "bulk_slip", message("no material slip in running"), None, None, "acceleration",
            message(f"slips in {where}"),
            message("no slip"), "FAIL",
            message(f'the material slips on the belt in section "{where}" at any speed: too steep for its friction'),
        )  # fmt: skip
        return
    hardest, fastest = result.motions.hardest
    for key, when, occurs, allowed, where in (
        ("bulk_slip_stopping", "on stopping", -hardest, -slip.braking, slip.braking_at),
        ("bulk_slip_start", "on starting", fastest, slip.starting, slip.starting_at),
    ):
        why = f'the material slips {when}: {{calculated}}, section "{escape_braces(where)}" allows {{required}}'
        yield check_against_limit(
            key, f"no material slip {when}", occurs, "at most", allowed, "acceleration", why=why, where=where
        )
