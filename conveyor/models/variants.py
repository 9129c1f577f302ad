"""Variants of a conveyor: load case, speed, temperature, compound, measured run."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from conveyor.errors import ConveyorError, InputError, RangeError
from conveyor.models.cases import LoadCase
from conveyor.models.compound import RubberCompound
from conveyor.models.conveyor import Conveyor
from conveyor.models.fields import with_fields
from conveyor.models.material import BulkMaterial
from conveyor.models.reversal import with_direction_reversed
from conveyor.models.route import Route, Section
from conveyor.models.runs import MeasuredRun
from conveyor.reuse import ReuseCache
from conveyor.units import Quantity, from_si, si

CoverChoice = Literal["bottom", "top", "both"]
"""Cover made of another compound."""


@dataclass(frozen=True, eq=False)
class Setting:
    """Variant at a cover temperature [K] and belt speed [m/s]; its conveyor, or the error."""

    temperature: float
    speed: float
    conveyor: Conveyor | ConveyorError


def scale_quantity(value: Quantity, factor: float) -> Quantity:
    """Quantity times a factor, in its own unit."""
    changed: Quantity = value * factor
    return changed


def with_case(conveyor: Conveyor, case: LoadCase, *, speed: Quantity | None = None) -> Conveyor:
    """Conveyor with the loading of a case, at a belt speed.

    A loading point resists only where bulk lies on the section it feeds; a tripper lifts and speeds up what the section
    before it brings.

    Parameters
    ----------
    conveyor : Conveyor
        The spec.
    case : LoadCase
        Load case.
    speed : Quantity, optional
        Belt speed; that of the spec without it.

    Raises
    ------
    InputError
        The bulk does not fit the belt, a loading point is faster than it, or the route has not a section of the case.
    """
    for name in case.sections:
        for problem in conveyor.route.section_problem(("sections",), name):
            raise InputError(f'load case "{case.name}": sections: {problem.message}')
    if case.reversed:
        conveyor = with_direction_reversed(conveyor)
    changes: dict[str, object] = {}
    if speed is not None and si(speed) != si(conveyor.belt.speed):
        changes["belt"] = conveyor.belt.replace(speed=speed)
    if case.loading in {"empty", "part load"}:
        share = 0.0 if case.share is None else si(case.share)
        changes["material"] = conveyor.material.replace(flow=scale_quantity(conveyor.material.flow, share))
    if case.loading == "heavy bulk":
        changes["material"] = heavy_bulk(conveyor.material)
    if case.loading in {"full", "inclines only", "declines only", "sections"}:
        named = frozenset(case.sections)
        sections = [_load_section(section, case, named) for section in conveyor.route.sections]
        if any(new is not old for new, old in zip(sections, conveyor.route.sections, strict=True)):
            changes["route"] = _feed_sections(conveyor, sections, conveyor.belt.speed if speed is None else speed)
    return conveyor.replace(**changes) if changes else conveyor


def heavy_bulk(material: BulkMaterial) -> BulkMaterial:
    """Bulk of the same volume flow at the density for weight."""
    over = si(material.heaviest) / si(material.density)
    return material.replace(density=material.heaviest, flow=scale_quantity(material.flow, over))


def at_reduced_speed(conveyor: Conveyor, share: float) -> Conveyor:
    """Conveyor at a share of its belt speed [-], with the bulk line mass of full speed."""
    speed = scale_quantity(conveyor.belt.speed, share)
    points = [
        point if si(point.speed) <= si(speed) else point.replace(speed=speed) for point in conveyor.route.feeding_points
    ]
    route = conveyor.route
    if points:
        route = route.replace(feeding=points[0], further_feeding=points[1:])
    return conveyor.replace(
        belt=conveyor.belt.replace(speed=speed),
        material=conveyor.material.replace(flow=scale_quantity(conveyor.material.flow, share)),
        route=route,
    )


def _load_section(section: Section, case: LoadCase, named: Collection[str]) -> Section:
    loaded = {
        "full": True,
        "inclines only": section.rise > 0.0,
        "declines only": section.rise < 0.0,
        "sections": section.name in named,
    }[case.loading]
    return section if section.loaded is loaded else section.replace(loaded=loaded)


def _feed_sections(conveyor: Conveyor, sections: Sequence[Section], speed: Quantity) -> Route:
    """Route with new sections; loading points at empty sections have no resistance, except trippers."""
    route = conveyor.route
    bearing = {section.name: section.loaded for section in sections}
    points = []
    for point in route.feeding_points:
        if bearing[sections[0].name if point.section is None else point.section]:
            points.append(point)
        elif point is not route.feeding and route.feeds_back(point):
            points.append(point.replace(skirt_length="0 m"))
        else:
            points.append(point.replace(speed=speed, skirt_length="0 m"))
    if not points:
        return route.replace(sections=sections)
    return route.replace(sections=sections, feeding=points[0], further_feeding=points[1:])


def with_temperature(conveyor: Conveyor, temperature: Quantity) -> Conveyor:
    """Conveyor with its covers at a temperature; the air changes by the same difference.

    Raises
    ------
    InputError
        A compound is not known there.
    """
    warmth = _temperature_changes(conveyor, temperature)
    return conveyor.replace(ambient=conveyor.ambient.replace(**warmth)) if warmth else conveyor


def _temperature_changes(conveyor: Conveyor, temperature: Quantity) -> dict[str, Quantity]:
    """Changed ambient fields for a temperature of the covers."""
    ambient = conveyor.ambient
    change = si(temperature) - si(ambient.belt)
    if change == 0.0:
        return {}
    if ambient.belt_temperature is None:
        return {"temperature": temperature}
    air = from_si(float(f"{si(ambient.temperature) + change:.9g}"), "temperature", "K")
    return {"temperature": air, "belt_temperature": temperature}


def distinct_values(values: Iterable[Quantity]) -> list[Quantity]:
    """Values without duplicates in another unit."""
    return list({si(value): value for value in values}.values())


def case_settings(conveyor: Conveyor, case: LoadCase) -> Iterator[Setting]:
    """Variants of a load case, at each of its speeds and temperatures."""
    for speed in case.speeds or (conveyor.belt.speed,):
        loaded: Conveyor | ConveyorError
        try:
            loaded = with_case(conveyor, case, speed=speed)
        except ConveyorError as error:
            loaded = error
        for temperature in case.temperatures or (conveyor.ambient.belt,):
            yield _temperature_setting(loaded, temperature, speed)


def crossed_settings(
    conveyor: Conveyor, temperatures: Iterable[Quantity], speeds: Iterable[Quantity]
) -> Iterator[Setting]:
    """Variants at every speed and temperature; the air follows the belt where roll drag depends on it.

    Otherwise nothing but the rubber changes with the temperature, and the conveyors of one speed are one.
    """
    air = conveyor.idlers.drag_follows_air
    given = [
        (si(at), _field_changes("ambient", _temperature_changes(conveyor, at)) if air else {}) for at in temperatures
    ]
    kept = ReuseCache()
    for speed in speeds:
        running = _with_fields_or_error(conveyor, {"belt.speed": speed}, kept)
        for temperature, warmth in given:
            made = running
            if warmth and isinstance(running, Conveyor):
                made = _with_fields_or_error(conveyor, {"belt.speed": speed, **warmth}, kept)
            yield Setting(temperature, si(speed), made)


def _field_changes(part: str, changes: Mapping[str, Quantity]) -> dict[str, Quantity]:
    return {f"{part}.{name}": value for name, value in changes.items()}


def _with_fields_or_error(
    conveyor: Conveyor, changes: Mapping[str, Quantity], kept: ReuseCache
) -> Conveyor | InputError:
    try:
        return with_fields(conveyor, changes, kept=kept)
    except InputError as error:
        return error


def _temperature_setting(loaded: Conveyor | ConveyorError, temperature: Quantity, speed: Quantity) -> Setting:
    if isinstance(loaded, Conveyor):
        try:
            loaded = with_temperature(loaded, temperature)
        except (InputError, RangeError) as error:
            loaded = error
    return Setting(si(temperature), si(speed), loaded)


def require_rolling_contact(conveyor: Conveyor, what: str) -> None:
    """Refuse a classical method where forces must follow the rubber.

    Raises
    ------
    InputError
        The method of the spec is not viscoelastic.
    """
    method = conveyor.calculation.method
    if method != "viscoelastic":
        raise InputError(
            f'calculation.method: "{method}" knows no rubber; {what} by the rolling contact ("viscoelastic")'
        )


def with_compound(conveyor: Conveyor, compound: RubberCompound, cover: CoverChoice) -> Conveyor:
    """Conveyor with one cover or both of another compound.

    A top cover without a compound has that of the bottom cover; it keeps the old one where only the bottom cover
    changes.

    Raises
    ------
    InputError
        The belt's mass does not fit the compound's density.
    """
    belt = conveyor.belt
    top, bottom = belt.top_cover, belt.bottom_cover
    above = (top.compound or bottom.compound) if cover == "bottom" else compound
    below = bottom.compound if cover == "top" else compound
    return conveyor.replace(
        belt=belt.replace(top_cover=top.replace(compound=above), bottom_cover=bottom.replace(compound=below))
    )


def with_alternative(conveyor: Conveyor, compound: RubberCompound, other: RubberCompound) -> Conveyor:
    """Conveyor with one compound replaced by another in all covers."""
    belt = conveyor.belt
    covers = {
        name: cover.replace(compound=other)
        for name, cover in (("top_cover", belt.top_cover), ("bottom_cover", belt.bottom_cover))
        if cover.compound is not None and cover.compound.name == compound.name
    }
    return conveyor.replace(belt=belt.replace(**covers))


def with_belt_temperature_changed(conveyor: Conveyor, change: float) -> Conveyor:
    """Conveyor with its covers warmer or colder by a difference [K].

    Raises
    ------
    InputError
        A compound is not known there.
    """
    at = float(f"{conveyor.temperature + change:.9g}")
    return with_temperature(conveyor, from_si(at, "temperature", "K"))


def with_runs(conveyor: Conveyor, runs: Sequence[MeasuredRun]) -> list[Conveyor]:
    """Conveyor as measured in each run; runs of equal state share one object.

    Raises
    ------
    InputError
        The bulk does not fit the belt; the run is named.
    RangeError
        A compound is not known at a run's temperature.
    """
    known: dict[tuple[float | None, ...], Conveyor] = {}
    for number, run in enumerate(runs, start=1):
        if run.state not in known:
            try:
                known[run.state] = _as_measured(conveyor, run)
            except (InputError, RangeError) as error:
                raise error.at(f"run {number}") from None
    return [known[run.state] for run in runs]


def _as_measured(conveyor: Conveyor, run: MeasuredRun) -> Conveyor:
    made = conveyor.replace(material=conveyor.material.replace(flow=run.flow))
    if run.speed is not None:
        made = made.replace(belt=made.belt.replace(speed=run.speed))
    if run.air_temperature is not None:
        ambient = {"temperature": run.air_temperature, "belt_temperature": run.temperature}
        return made.replace(ambient=made.ambient.replace(**ambient))
    return made if run.temperature is None else with_temperature(made, run.temperature)
