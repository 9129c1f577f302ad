"""Tables and figures of starts and stops, declared once."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from conveyor.checks import Check, governing_by_subject
from conveyor.dynamics.criteria import dynamics_checks, pulley_peak, tension_peaks
from conveyor.dynamics.scenario_result import ScenarioResult
from conveyor.dynamics.simulation import CalculatedDynamics
from conveyor.laws.belt_strength import DUTY_SAFETY, SPLICE_SAFETY, belt_safety, required_strength
from conveyor.report.analysis_tables import (
    ReportAdditions,
    check_json,
    check_table,
    provenance_table,
    report_head,
)
from conveyor.report.animation import Panel, animated_curves
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import curve_colour, label_axes, set_title, stacked_axes
from conveyor.report.result_schema import SCHEMA_VERSION
from conveyor.report.table_model import (
    FIGURE_NAME,
    ROW_KIND,
    Column,
    Contents,
    Drawing,
    Figure,
    PagePlacement,
    Table,
    remark_table,
    slug,
)
from conveyor.spec import fingerprint
from conveyor.units import System
from conveyor.units.presentation import display_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Picture

    from conveyor.text.markup import Html

PARTS: Final = (
    ("dynamics", "Starting and stopping"),
    ("checks", "Checks"),
    ("warnings", "Warnings"),
    ("through-time", "Through time"),
    ("assumptions", "Assumptions"),
    ("provenance", "Provenance"),
)
"""Parts of the page; the first and fourth are also parts of a conveyor's page."""
_SAMPLES = 200  # rows of histories of a scenario
_SCENARIO = Column("scenario", "text", "0", json="scenario")


def dynamics_contents(dynamics: CalculatedDynamics, system: System) -> Contents:
    """Contents of the report on starts and stops in a unit system."""
    every = dynamics_checks(dynamics)
    parts = (
        *scenario_tables(dynamics), check_table(governing_by_subject(every), system),
        _dynamics_remarks(dynamics, every, system),
        provenance_table(fingerprint(dynamics.conveyor)),
    )  # fmt: skip
    names = ", ".join(one.name for one in dynamics.followed)
    about = report_head(dynamics.conveyor, "Starting and stopping", system, (("scenarios", names),))
    return Contents(about, parts, system, tuple(dynamics_drawings(dynamics, system)), PARTS)


def report_additions(dynamics: CalculatedDynamics, system: System) -> ReportAdditions:
    """Checks, tables and drawings of the scenarios for the report of the conveyor."""
    shown, drawn = tuple(scenario_tables(dynamics)), tuple(dynamics_drawings(dynamics, system))
    return ReportAdditions(dynamics_checks(dynamics), shown, drawn, dynamics.assumptions, scenarios_json(dynamics))


def scenario_tables(dynamics: CalculatedDynamics) -> Iterator[Table]:
    """Tables of the scenarios that have rows."""
    for made in (
        scenario_table, size_table, scenario_drives, scenario_pulleys, scenario_tensions, splice_tensions, history_table
    ):  # fmt: skip
        table = made(dynamics)
        if table.rows:
            yield table


_PEAKS: Final = (
    Column("highest tension", "force", "1.highest", json="highest_N"),
    Column("at", "duration", "1.highest_at", json="highest_at_s"),
    Column("lowest tension", "force", "1.lowest", json="lowest_N"),
    Column("at", "duration", "1.lowest_at", json="lowest_at_s", key="lowest_at"),
)


def scenario_table(dynamics: CalculatedDynamics) -> Table:
    """Extremes of every scenario."""

    def peak(one: ScenarioResult, *, high: bool) -> tuple[float, str]:
        i = int(one.record.highest.argmax() if high else one.record.lowest.argmin())
        return float((one.record.highest_at if high else one.record.lowest_at)[i]), one.place(i)

    columns = (
        Column("scenario", "text", "name", json="scenario"),
        Column("followed for", "duration", lambda r: float(r.times[-1]), json="duration_s"),
        Column("highest tension", "force", "highest", json="highest_tension_N"),
        Column("at", "duration", lambda r: peak(r, high=True)[0], json="highest_at_s"),
        Column("in", "text", lambda r: peak(r, high=True)[1], json="highest_in"),
        Column("lowest tension", "force", "lowest", json="lowest_tension_N"),
        Column("at", "duration", lambda r: peak(r, high=False)[0], json="lowest_at_s", key="lowest_at"),
        Column("in", "text", lambda r: peak(r, high=False)[1], json="lowest_in", key="lowest_in"),
        Column("highest speed", "speed", lambda r: r.top_speed[0], json="highest_speed_m_per_s"),
        Column("stops after", "duration", lambda r: r.rests_at if r.stops else None, json="rest_s"),
        Column("way", "length", "way", json="way_m"),
        Column("error of the peaks", "share", "error", json="error"),
        Column("energy missing", "error", "missing_energy", None, json="energy_error"),
        Column("cells", "count", "middles.size", None, json="cells"),
        Column("step", "time", "record.step", None, json="step_s"),
    )  # fmt: skip
    caption = "Starts and stops; distance is that of the belt at the first drive"
    return Table("scenarios", "Scenarios", caption, columns, dynamics.followed, "dynamics")


def size_table(dynamics: CalculatedDynamics) -> Table:
    """Sizes that keep every criterion: value, error, governing check."""
    columns = (
        Column("sought", FIGURE_NAME, "label", json="sought"),
        Column("scenario", "text", "value.scenario", json="scenario"),
        Column("found", ROW_KIND, "value.value", json="value"),
        Column("to", "share", "value.error", json="error"),
        Column("serves up to", ROW_KIND, "value.most", json="most"),
        Column("governing check", "text", "value.governs", json="governs"),
        Column("what fails with less", "text", "value.why", json="fails_with_less"),
    )
    rows = [Figure(size.label, size.kind, size) for size in dynamics.sized]
    caption = "What was sought so that every criterion is kept, and which one decides"
    return Table("scenario_sizes", "Scenarios", "Sizes", columns, rows, (PagePlacement("dynamics", caption),))


def scenario_drives(dynamics: CalculatedDynamics) -> Table:
    """Extremes of every drive in every scenario, with the take-up."""
    rows = [(one.name, one, d) for one in dynamics.followed for d in range(len(one.setup.drives))]

    def drive(name: str, of: Any) -> Any:
        return lambda row: float(of(row[1].record.drives[name][:, row[2]]))

    def held(of: Any, there: Any) -> Any:
        """Force held by a brake or a backstop; None where there is none."""
        return lambda row: drive("holding", of)(row) if there(row[1].setup)[row[2]] else None

    def torque(of: Any) -> Any:
        return lambda row: float(of(row[1].torque[:, row[2]]))

    def power(row: Any) -> float:
        drives = row[1].record.drives
        return float(np.max(np.abs(drives["motor"][:, row[2]] * drives["rim"][:, row[2]])))

    def take_up(get: Any, of: Any) -> Any:
        return lambda row: float(of(get(row[1])))

    pull = lambda one: one.record.take_up["tension"]  # noqa: E731 two words for one figure
    columns = (
        _SCENARIO,
        Column("drive", "text", lambda row: row[1].setup.drives[row[2]].name, json="drive"),
        Column("highest torque over rated", "ratio", torque(np.max), json="torque_max"),
        Column("lowest torque over rated", "ratio", torque(np.min), json="torque_min"),
        Column("highest force on the belt", "force", drive("force", np.max), json="force_max_N"),
        Column("lowest force on the belt", "force", drive("force", np.min), json="force_min_N"),
        Column("highest power at the rim", "power", power, json="power_kW"),
        Column("slip", "length", lambda row: float(row[1].record.slipped[row[2]]), json="slip_m"),
        Column("heat of slip", "heat", lambda row: float(row[1].record.heat[row[2]]), json="slip_heat_MJ"),
        Column("brake", "force", held(np.max, lambda setup: setup.brakes), json="brake_N"),
        Column("backstop", "force", held(lambda force: max(0.0, -np.min(force)), lambda setup: setup.backstops),
               json="backstop_N"),
        Column("take-up, setting", "force", "1.setup.setting", json="take_up_setting_N"),
        Column("take-up, lowest", "force", take_up(pull, np.min), json="take_up_min_N"),
        Column("take-up, highest", "force", take_up(pull, np.max), json="take_up_max_N"),
        Column("carriage, out", "length", take_up(attrgetter("travel"), np.max), json="carriage_out_m"),
        Column("carriage, in", "length", take_up(attrgetter("travel"), np.min), json="carriage_in_m"),
    )  # fmt: skip
    caption = "Drives and take-up; brake and backstop as they act at the belt, the carriage against its begin"
    return Table("scenario_drives", "Scenarios", caption, columns, rows, "dynamics", named=2)


def scenario_pulleys(dynamics: CalculatedDynamics) -> Table:
    """Highest and lowest tension at every pulley in every scenario, with their times; safety of the belt."""
    belt = dynamics.given.line.belt

    def safety(row: Any) -> float | None:
        if belt.strength is None:
            return None
        return belt_safety(row[1].highest, nominal_strength=belt.strength, belt_width=belt.width)

    rows = [
        (one.name, peak)
        for one in dynamics.followed
        for i in range(len(one.line.pulleys))
        for peak in (pulley_peak(one, i),)
    ]
    columns = (_SCENARIO, Column("pulley", "text", "1.section", json="pulley"), *_PEAKS,
               Column("safety of the belt", "ratio", safety, json="safety", sparse=True))  # fmt: skip
    caption = "Highest and lowest tension of the belt at every pulley"
    return Table("scenario_pulleys", "Scenarios", caption, columns, rows, "dynamics", named=2)


def splice_tensions(dynamics: CalculatedDynamics) -> Table:
    """Range of tension that a splice sees in every scenario."""
    belt = dynamics.given.line.belt

    def needed(one: ScenarioResult) -> float | None:
        if belt.splice_strength is None:
            return None
        return required_strength(
            one.highest / belt.width, splice_strength=belt.splice_strength,
            s0=SPLICE_SAFETY[belt.splice_making], s1=DUTY_SAFETY[belt.duty],
        )  # fmt: skip

    columns = (
        Column("scenario", "text", "name", json="scenario"),
        Column("highest tension per width", "strength", lambda r: r.highest / belt.width, json="highest_N_per_mm"),
        Column("lowest tension per width", "strength", lambda r: r.lowest / belt.width, json="lowest_N_per_mm"),
        Column("required strength, as if steady", "strength", needed, json="strength_N_per_mm", sparse=True),
    )  # fmt: skip
    caption = "What every splice bears as it goes round; strength by its endurance (DIN 22101:2002)"
    return Table("scenario_splices", "Scenarios", caption, columns, dynamics.followed, "dynamics")


def scenario_tensions(dynamics: CalculatedDynamics) -> Table:
    """Highest and lowest tension of every section and strand in every scenario, with their times."""
    rows = [(one.name, peak) for one in dynamics.followed for peak in tension_peaks(one)]
    columns = (
        _SCENARIO,
        Column("section", "text", "1.section", json="section"),
        Column("strand", "text", "1.strand", json="strand"),
        *_PEAKS,
        Column("least for sag, steady", "force", "1.least_for_sag", json="least_for_sag_N"),
        Column("largest sag over the span", "share", "1.sag", json="sag"),
    )
    caption = "Highest and lowest tension of every section and strand, from the take-up round"
    return Table("scenario_tensions", "Scenarios", caption, columns, rows, "dynamics", named=3)


def history_table(dynamics: CalculatedDynamics) -> Table:
    """Speeds and tensions over time."""
    rows = [
        (one.name, one, int(i), d)
        for one in dynamics.followed
        for d in range(len(one.setup.drives))
        for i in np.unique(np.linspace(0, one.times.size - 1, _SAMPLES).astype(int))
    ]

    def of(name: str) -> Any:
        return lambda row: float(row[1].record.drives[name][row[2], row[3]])

    columns = (
        _SCENARIO,
        Column("drive", "text", lambda row: row[1].setup.drives[row[3]].name),
        Column("time", "duration", lambda row: float(row[1].times[row[2]])),
        Column("speed of the belt", "speed", of("belt")),
        Column("speed of the rim", "speed", of("rim")),
        Column("tension arriving", "force", of("arriving")),
        Column("tension leaving", "force", of("leaving")),
        Column("force on the belt", "force", of("force")),
        Column("force of the motor", "force", of("motor")),
        Column("tension at the take-up", "force", lambda row: float(row[1].record.take_up["tension"][row[2]])),
        Column("travel of the carriage", "length", lambda row: float(row[1].travel[row[2]])),
    )
    return Table("histories", "Histories", "Drives and take-up over time", columns, rows, named=2)


def _dynamics_remarks(dynamics: CalculatedDynamics, every: tuple[Check, ...], system: System) -> Table:
    """Failed checks and assumptions."""
    warned = [
        f"{check.case.text(system)}: {check.why.text(system)}"
        for check in every
        if check.failed and check.why is not None and check.case is not None
    ]
    return remark_table({"warning": warned, "assumption": dynamics.assumptions})


def dynamics_drawings(dynamics: CalculatedDynamics, system: System) -> Iterator[Drawing]:
    """Five drawings per scenario, the first animated."""
    for one in dynamics.followed:
        for name, words in (
            ("profile", "tension and speed round the loop; the tail is dashed, shaded what occurs"),
            ("tension_map", "tension over place and time; the tail is white, slack belt red"),
            ("envelope", "highest and lowest tension round the loop"),
            ("speeds", "speeds at drives and tail"),
            ("forces", "tensions at drives, tail and take-up, forces of the motors"),
        ):
            draw = partial(tension_animation, one) if name == "profile" else partial(scenario_figure, one, name)
            draw = partial(draw, system=system)
            yield Drawing(f"{slug(one.name)}_{name}", f"{one.name}: {words}.", draw, "through-time")


def scenarios_json(dynamics: CalculatedDynamics) -> dict[str, Any]:
    """Plain numbers of every scenario; units in the keys."""
    return {
        table.key.removeprefix("scenario_"): table.plain()
        for table in scenario_tables(dynamics)
        if table.key != "histories"
    }


def dynamics_json(dynamics: CalculatedDynamics) -> dict[str, Any]:
    """Plain numbers for JSON, as `result_schema` describes them."""
    every = dynamics_checks(dynamics)
    governing = governing_by_subject(every)
    return {
        "schema_version": SCHEMA_VERSION,
        "conveyor": dynamics.conveyor.name,
        **scenarios_json(dynamics),
        "checks": [check_json(check, governs=any(check is one for one in governing)) for check in every],
        "assumptions": list(dynamics.assumptions),
    }


_LEVELS, _MAP_POINTS = 14, 80  # shades, and points a side, of the map
_POINTS = 1500  # of a history
_FRAMES, _FRAME_POINTS = 45, 60  # times and points of an animation
_LOOP_DISTANCE: Final = "distance from the head, return strand first"
_HEIGHT, _LOW_HEIGHT, _WHOLE_HEIGHT = 4.4, 3.0, 13.0


def tension_animation(scenario: ScenarioResult, *, system: System = "SI") -> Html:
    """Animation of tension and speed round the loop."""
    force, length, speed = (
        display_unit("force", system, large=True),
        display_unit("length", system, large=True),
        display_unit("speed", system),
    )
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _FRAMES).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _FRAME_POINTS).astype(int))
    ends = record.lowest[order][cells], record.highest[order][cells]
    tension = record.tensions[np.ix_(kept, order[cells])].astype(float)
    going = record.speeds[:, order[cells]].astype(float)
    where = length.beside(_LOOP_DISTANCE)
    return animated_curves(
        f"moving_{slug(scenario.name)}", (where, length(distance[cells])),
        (display_unit("duration", system).beside("time"), record.times[kept]),
        (Panel(force.beside("tension"), force(tension), (force(ends[0]), force(ends[1]))),
         Panel(speed.beside("speed"), speed(going[kept]), (speed(going.min(axis=0)), speed(going.max(axis=0))))),
        mark=float(length(scenario.line.loop.way[scenario.line.count])),
    )  # fmt: skip


@own_settings()
def scenario_figure(scenario: ScenarioResult, *names: str, system: System = "SI") -> Picture:
    """Figure of a scenario: tension map, envelope, speeds and forces, or those named."""
    drawn = {"tension_map": (_draw_tension_map, _HEIGHT), "envelope": (_draw_envelope, _HEIGHT),
    "speeds": (_draw_speeds, _LOW_HEIGHT),
             "forces": (_draw_forces, _HEIGHT)}  # fmt: skip
    shown = [drawn[name] for name in names or drawn]
    figure, axes = stacked_axes(len(shown), sum(height for _, height in shown) if names else _WHOLE_HEIGHT)
    for axis, (draw, _) in zip(axes, shown, strict=True):
        draw(axis, scenario, system)
    if not names:
        set_title(figure, scenario.name)
    return figure


def _draw_tension_map(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, length = display_unit("force", system, large=True), display_unit("length", system, large=True)
    order, distance = scenario.round_loop
    record = scenario.record
    kept = np.unique(np.linspace(0, record.times.size - 1, _MAP_POINTS).astype(int))
    cells = np.unique(np.linspace(0, order.size - 1, _MAP_POINTS).astype(int))
    tension = force(record.tensions[np.ix_(kept, order[cells])])
    shaded = axis.contourf(length(distance[cells]), record.times[kept], tension, levels=_LEVELS, cmap="viridis")
    taut = record.tensions[np.ix_(kept, order[cells])] / scenario.cells.slack[order[cells]]
    if float(taut.min()) < 1.0 < float(taut.max()):
        axis.contour(length(distance[cells]), record.times[kept], taut, levels=[1.0], colors="red", linewidths=1.0)
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="white", linewidth=0.8)
    axis.grid(visible=False)
    label_axes(axis, length.beside(_LOOP_DISTANCE), display_unit("duration", system).beside("time"), group="x")
    beside = axis.inset_axes((1.02, 0.0, 0.03, 1.0))  # no axes of its own: those bind the figure's layout
    axis.figure.colorbar(shaded, cax=beside, label=force.beside("tension"))


def _draw_envelope(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, length = display_unit("force", system, large=True), display_unit("length", system, large=True)
    order, distance = scenario.round_loop
    x, record = length(distance), scenario.record
    axis.fill_between(x, force(record.lowest[order]), force(record.highest[order]), color="#1F4E79", alpha=0.15)
    for k, (name, values) in enumerate(
        (("highest", record.highest), ("lowest", record.lowest), ("at the start", record.tensions[0]))
    ):
        axis.plot(x, force(values[order]), color=curve_colour(k), label=name)
    axis.axhline(0.0, color="0.6", linewidth=0.8)
    axis.axvline(float(length(scenario.line.loop.way[scenario.line.count])), color="0.8", zorder=0)
    label_axes(axis, length.beside(_LOOP_DISTANCE), force.beside("tension"), group="xy")


def _draw_speeds(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    speed, time = display_unit("speed", system), display_unit("duration", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives = scenario.record.drives
    for d, drive in enumerate(scenario.setup.drives):
        belt = speed(drives["belt"][kept, d])
        axis.plot(scenario.times[kept], belt, color=curve_colour(2 * d), label=f"belt at {drive.name}")
        if scenario.record.slipped[d]:
            rim = speed(drives["rim"][kept, d])
            axis.plot(
                scenario.times[kept],
                rim,
                color=curve_colour(2 * d),
                linestyle=":",
                label=f"rim of {drive.name}",
            )
    tail = speed(scenario.record.speeds[:, _tail_cell(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="belt at the tail")
    label_axes(axis, time.beside("time"), speed.beside("speed"))


def _draw_forces(axis: Axes, scenario: ScenarioResult, system: System) -> None:
    force, time = display_unit("force", system, large=True), display_unit("duration", system)
    kept = np.unique(np.linspace(0, scenario.times.size - 1, _POINTS).astype(int))
    drives, times = scenario.record.drives, scenario.times[kept]
    for d, drive in enumerate(scenario.setup.drives):
        for k, name in enumerate(("arriving", "leaving")):
            axis.plot(
                times,
                force(drives[name][kept, d]),
                color=curve_colour(2 * d + k),
                label=f"{name} at {drive.name}",
            )
        motor = force(drives["motor"][kept, d])
        axis.plot(
            times,
            motor,
            color=curve_colour(2 * d),
            linestyle="--",
            linewidth=0.9,
            label=f"motor of {drive.name}",
        )
    tail = force(scenario.record.tensions[:, _tail_cell(scenario)])
    axis.plot(scenario.record.times, tail, color="0.4", linewidth=0.9, label="at the tail")
    held = force(scenario.record.take_up["tension"][kept])
    axis.plot(times, held, color=curve_colour(6), linewidth=0.9, label="at the take-up")
    label_axes(axis, time.beside("time"), force.beside("tension, force"), group="y")


def _tail_cell(scenario: ScenarioResult) -> int:
    """Index of the cell at the tail."""
    order, known = scenario.round_loop
    return int(order[int(np.argmin(np.abs(known - scenario.line.loop.way[scenario.line.count])))])
