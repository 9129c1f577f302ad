"""Tables and drawing of loading points, cleaners and the discharge; empty where the spec has none."""

from __future__ import annotations

import math
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.laws.transfer import CLEANER_EFFICIENCY
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import curve_colour, finish_figure, stacked_axes
from conveyor.report.row_getters import path_getter
from conveyor.report.table_model import FIGURE_NAME, ROW_KIND, Column, Drawing, Figure, Table, figure_table
from conveyor.units import System
from conveyor.units.presentation import display_unit
from conveyor.units.sentences import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

    from conveyor.loop.transfer_points import LoadingPointDuty, Trajectory

SHEET: Final = "Transfer"
_PAGE: Final = "transfer"
_CIRCLE_POINTS: Final = 49


def _is_detailed(landing: LoadingPointDuty) -> bool:
    """True if the spec gives drop height, skirtboards or seal drag of a loading point."""
    point = landing.point
    if point.assumed:
        return False
    return point.drop_height is not None or point.skirtboards is not None or point.seal_drag > 0.0


def loading_point_table(a: CalculatedConveyor) -> Table:
    """Skirtboards and impact of the loading points, one column each."""
    shown = tuple(each for each in a.loading_point_duty if _is_detailed(each))
    every = (
        ("mass flow", "mass flow", "point.flow"),
        ("length of acceleration", "spacing", "acceleration"),
        ("usual skirtboards", "spacing", "usual_skirts"),
        ("skirtboards", "spacing", "point.skirtboards"),
        ("drop height", "spacing", "point.drop_height"),
        ("resting on a set", "force", "resting"),
        ("impact of the stream", "force", "stream"),
        ("impact of the lump", "force", "lump_force"),
        ("load of a set", "force", "load"),
        ("a set bears", "force", "point.idler_rating"),
        ("impact bed for the lump", "text", "bed"),
    )
    points = [each.point.name.removeprefix(", ") or each.point.place for each in shown]
    columns = (
        Column("quantity", FIGURE_NAME, "label"),
        *(Column(name, ROW_KIND, f"value.{i}", key=f"point_{i}") for i, name in enumerate(points)),
    )
    found = [(label, kind, tuple(map(path_getter(path), shown))) for label, kind, path in every]
    known = tuple(Figure(label, kind, each) for label, kind, each in found if any(value is not None for value in each))
    heading = "Loading points"
    note = (
        "Stream: its momentum; lump: energy on the spring under it, without loss; the larger one falls on one set. "
        "Usual skirtboards and classes of impact beds: CEMA, general knowledge."
    )
    return Table("landings", SHEET, heading, columns, known, _PAGE, note)


def cleaner_table(a: CalculatedConveyor) -> Table:
    """Drag of the belt cleaners and carryback behind them."""
    columns = (
        Column("cleaner", "text", lambda row: row[1].scraper.kind or f"cleaner {row[0]}"),
        Column("count", "count", lambda row: float(row[1].scraper.count)),
        Column("width of the blade", "size", "1.scraper.width"),
        Column("drag of one", "force", "1.drag"),
        Column("efficiency of one", "share", "1.scraper.efficiency"),
        Column("left on the belt", "area mass", "1.left"),
        Column("carried back", "carryback", "1.lost"),
    )
    given = a.line.carryback[0] is not None
    rows = tuple(enumerate(a.cleaner_duty, start=1)) if given else ()
    note = "Every cleaner takes the same share of what reaches it; over the width of its blade."
    if any("efficiency" not in each.model_fields_set for each in a.conveyor.route.cleaners or ()):
        note += f" Efficiency not given: {percent(CLEANER_EFFICIENCY.value)} (general knowledge)."
    heading = "Cleaners"
    return Table("cleaners", SHEET, heading, columns, rows, _PAGE, note)


def discharge_table(a: CalculatedConveyor) -> Table:
    """Discharge over the head pulley: point of leaving, speeds, arrival."""
    stream = a.trajectory
    rows: tuple[Figure, ...] = ()
    if stream is not None:
        end, height = stream.fall, stream.bulk.height
        rows = (
            Figure("diameter of the pulley", "size", stream.head.diameter),
            Figure("slope of the belt", "angle", stream.head.slope),
            Figure("height of the bulk", "size", height),
            Figure("height of its centre", "size", stream.bulk.centroid),
            Figure("V²/(g r) of the centre", "ratio", stream.ratio, key="speed_ratio"),
            Figure("leaves beyond the top", "angle", stream.angle, key="angle"),
            Figure("speed there", "speed", stream.speed, key="speed"),
            Figure("slips beyond the top (Booth)", "angle", stream.slip.slip_angle, key="slip_angle"),
            Figure("leaves beyond the top (Booth)", "angle", stream.slip.angle, key="booth_angle"),
            Figure("speed there (Booth)", "speed", stream.slip.speed, key="booth_speed"),
            Figure("depth below the axis", "spacing", stream.head.drop, key="drop"),
            Figure("time of the fall", "time", float(end.time[-1]), key="time"),
            Figure("forward of the axis", "spacing", float(end.across[-1]), key="across"),
            Figure("forward of the axis (Booth, lower edge)", "spacing", float(stream.lower.across[-1]),
                   key="booth_across"),
            Figure("speed on arrival", "speed", float(end.speed[-1]), key="arrival_speed"),
            Figure("forward speed on arrival", "speed", float(end.speed[-1] * math.cos(end.steepness[-1])),
                   key="forward_speed"),
            Figure("down from the level on arrival", "angle", float(end.steepness[-1]), key="arrival_angle"),
        )  # fmt: skip
    note = "" if stream is None else _discharge_note(stream)
    heading = "Discharge over the head pulley"
    return figure_table("discharge", SHEET, heading, rows, page=_PAGE, note=note, prefix="discharge_")


def _discharge_note(stream: Trajectory) -> str:
    leaves = "is carried round part of the pulley" if stream.wraps else "leaves as the belt meets the pulley"
    return (
        f"The bulk {leaves}. Centre after CEMA, edges at right angles to it; Booth: lower edge, with slip on the belt. "
        "No air."
    )


def trajectory_table(a: CalculatedConveyor) -> Table:
    """Points of the trajectory from the pulley axis, every 1/20 s, the last at the given drop."""
    stream = a.trajectory
    rows: tuple[tuple[Any, ...], ...] = ()
    if stream is not None:
        centre = stream.fall
        lower, upper = _stream_edges(stream)
        paths = [(centre.across, centre.up), lower, upper, (stream.lower.across, stream.lower.up)]
        points = [[*zip(*(axis.tolist() for axis in path), strict=True)] for path in paths]
        of_centre = zip(centre.time.tolist(), centre.speed.tolist(), strict=True)
        rows = tuple(zip_longest(of_centre, *points))

    def part(i: int, k: int) -> Any:
        return lambda row: None if row[i] is None else row[i][k]

    columns = (
        Column("time", "time", part(0, 0)),
        Column("speed", "speed", part(0, 1)),
        *(
            Column(f"{name}, {axis}", "spacing", part(i, k))
            for i, name in enumerate(("centre", "lower edge", "upper edge", "lower edge after Booth"), start=1)
            for k, axis in enumerate(("forward", "up"))
        ),
    )
    return Table("trajectory", SHEET, "Trajectory from the axis of the head pulley", columns, rows, printed=False)


def _stream_edges(stream: Trajectory) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
    """Lower and upper edge of the stream after CEMA [m]."""
    bulk = stream.bulk
    return stream.fall.beside(-bulk.centroid), stream.fall.beside(bulk.height - bulk.centroid)


def pulley_outline(a: CalculatedConveyor) -> Table:
    """Outline of the belt at the head pulley, for the chart."""
    stream = a.trajectory
    rows: tuple[tuple[float, ...], ...] = ()
    if stream is not None:
        rows = tuple(zip(*(axis.tolist() for axis in _belt_outline(stream)), strict=True))
    columns = (Column("belt, forward", "spacing", "0"), Column("belt, up", "spacing", "1"))
    return Table("pulley_outline", SHEET, "Belt round the head pulley", columns, rows, printed=False)


def _belt_outline(stream: Trajectory) -> tuple[Any, Any]:
    """Outline of the belt from two radii before the pulley, once round it [m]."""
    radius, slope = stream.belt_radius, stream.head.slope
    turn = np.linspace(-slope, 2.0 * math.pi - slope, _CIRCLE_POINTS)
    x, y = radius * np.sin(turn), radius * np.cos(turn)
    before = (x[0] - 2.0 * radius * math.cos(slope), y[0] - 2.0 * radius * math.sin(slope))
    return np.append(before[0], x), np.append(before[1], y)


def discharge_drawing(a: CalculatedConveyor, system: System) -> tuple[Drawing, ...]:
    """Drawing of the discharge trajectory, if the spec has one."""
    if a.trajectory is None:
        return ()
    words = "The stream over the head pulley, to scale: centre and edges after CEMA, lower edge after Booth."
    return (Drawing("trajectory", words, lambda: discharge_figure(a, system=system), "discharge"),)


@own_settings()
def discharge_figure(a: CalculatedConveyor, *, system: System) -> Picture:
    """Discharge trajectory over the head pulley, to scale."""
    flight = a.trajectory
    if flight is None:
        raise ValueError("no discharge to draw")
    sheet, (axis,) = stacked_axes(1, 5.6)
    length = display_unit("spacing", system)
    lower, upper = _stream_edges(flight)
    axis.plot(*(length(each) for each in _belt_outline(flight)), color="0.35", linewidth=2, label="belt")
    axis.plot(0.0, 0.0, "+", color="0.35")
    stream = [np.concatenate([one, other[::-1]]) for one, other in zip(lower, upper, strict=True)]
    axis.fill(length(stream[0]), length(stream[1]), color=curve_colour(0), alpha=0.15, linewidth=0)
    axis.plot(length(flight.fall.across), length(flight.fall.up), color=curve_colour(0), label="centre")
    for path, name in ((lower, "edges"), (upper, "edges")):
        axis.plot(length(path[0]), length(path[1]), color=curve_colour(0), linewidth=0.8, label=name)
    booth = flight.lower
    axis.plot(
        length(booth.across),
        length(booth.up),
        color=curve_colour(1),
        linestyle="--",
        label="lower edge (Booth)",
    )
    axis.set_aspect("equal", adjustable="datalim")
    across, up = length.beside("forward of the axis"), length.beside("over the axis")
    return finish_figure(sheet, across, up, "Discharge over the head pulley")
