"""Tables and figures of starts and stops, declared once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from conveyor.checks import Check, governing_by_subject
from conveyor.laws.belt_strength import DUTY_SAFETY, SPLICE_SAFETY, belt_safety, required_strength
from conveyor.line.covers import compounds_by_strand
from conveyor.remarks.assumptions import failed_fits
from conveyor.report.dynamics_plots import scenario_figure, tension_animation
from conveyor.report.json_keys import (
    LEFT_OUT,
    VERSION_KEY,
    JsonKey,
    JsonList,
    JsonObject,
    describe_value,
    number_key,
    row_list,
    row_object,
    text_key,
    text_list,
)
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
from conveyor.report.tables.check_tables import CHECK_KEYS, check_pairs, check_table
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.spec import fingerprint
from conveyor.units import System

if TYPE_CHECKING:  # 0.1 s that a report without starts and stops does not pay
    from conveyor.dynamics.scenario_result import ScenarioResult
    from conveyor.dynamics.simulation import CalculatedDynamics

PARTS: Final = (
    ("verdict", "Verdict"),
    ("checks", "Checks"),
    ("dynamics", "Starting and stopping"),
    ("through-time", "Through time"),
    ("assumptions", "Assumptions"),
    ("provenance", "Provenance"),
)
"""Parts of the page; the third and fourth are also parts of a conveyor's page."""
_SAMPLES = 200  # rows of histories of a scenario
_SCENARIO = Column("scenario", "text", "0", json="scenario")


def dynamics_contents(dynamics: CalculatedDynamics, system: System) -> Contents:
    """Contents of the report on starts and stops in a unit system."""
    every = _every_check(dynamics)
    makers: dict[str, Callable[[CalculatedDynamics], Table]] = {
        **SCENARIO_TABLES,
        "scenario_sizes": partial(size_table, system=system),
    }
    parts = (
        *(make(dynamics) for make in makers.values()), check_table(governing_by_subject(every), system),
        _dynamics_remarks(dynamics, every, system),
        provenance_table(fingerprint(dynamics.conveyor)),
    )  # fmt: skip
    names = ", ".join(one.name for one in dynamics.followed)
    about = report_head(dynamics.conveyor, "Starting and stopping", system, (("scenarios", names),))
    drawn = tuple(dynamics_drawings(dynamics, system))
    return Contents.of(about, parts, system, drawings=drawn, page=PARTS)


def _every_check(dynamics: CalculatedDynamics) -> tuple[Check, ...]:
    """Every check of every scenario."""
    from conveyor.dynamics.criteria import dynamics_checks

    return dynamics_checks(dynamics)


_PEAKS: Final = (
    Column("highest tension", "force", "1.highest", json="highest_N"),
    Column("at", "time", "1.highest_at", json="highest_at_s"),
    Column("lowest tension", "force", "1.lowest", json="lowest_N"),
    Column("at", "time", "1.lowest_at", json="lowest_at_s", key="lowest_at"),
)


def scenario_table(dynamics: CalculatedDynamics) -> Table:
    """Extremes of every scenario."""

    def peak(one: ScenarioResult, *, high: bool) -> tuple[float, str]:
        i = int(one.record.highest.argmax() if high else one.record.lowest.argmin())
        return float((one.record.highest_at if high else one.record.lowest_at)[i]), one.place(i)

    columns = (
        Column("scenario", "text", "name", json="scenario"),
        Column("followed for", "time", lambda r: float(r.times[-1]), None, json="duration_s"),
        Column("highest tension", "force", "highest", json="highest_tension_N"),
        Column("at", "time", lambda r: peak(r, high=True)[0], json="highest_at_s"),
        Column("in", "text", lambda r: peak(r, high=True)[1], json="highest_in"),
        Column("lowest tension", "force", "lowest", json="lowest_tension_N"),
        Column("at", "time", lambda r: peak(r, high=False)[0], json="lowest_at_s", key="lowest_at"),
        Column("in", "text", lambda r: peak(r, high=False)[1], json="lowest_in", key="lowest_in"),
        Column("highest speed", "speed", lambda r: r.top_speed[0], json="highest_speed_m_per_s"),
        Column("stops after", "time", lambda r: r.rests_at if r.stops else None, json="rest_s"),
        Column("way", "length", "way", None, json="way_m"),
        Column("error of the peaks", "share", "error", json="error"),
        Column("energy missing", "error", "missing_energy", None, json="energy_error"),
        Column("cells", "count", "middles.size", None, json="cells"),
        Column("step", "relaxation time", "record.step", None, json="step_s"),
    )  # fmt: skip
    caption = "Starts and stops; distance is that of the belt at the first drive"
    return Table("scenarios", "Scenarios", caption, columns, dynamics.followed, "dynamics")


def size_table(dynamics: CalculatedDynamics, system: System = "SI") -> Table:
    """Sizes that keep every criterion: value, error, governing check."""
    columns = (
        Column("sought", FIGURE_NAME, "label", json="sought"),
        Column("scenario", "text", "value.scenario", json="scenario"),
        Column("found", ROW_KIND, "value.value", json="value"),
        Column("to", "share", "value.error", json="error"),
        Column("serves up to", ROW_KIND, "value.most", json="most"),
        Column("governing check", "text", lambda row: row.value.governs.text(system), json="governs"),
        Column("what fails with less", "text", lambda row: row.value.why.text(system), json="fails_with_less"),
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
        Column("highest force on the belt", "force", drive("force", np.max), None, json="force_max_N"),
        Column("lowest force on the belt", "force", drive("force", np.min), None, json="force_min_N"),
        Column("highest power at the rim", "power", power, json="power_kW"),
        Column("slip", "length", lambda row: float(row[1].record.slipped[row[2]]), json="slip_m"),
        Column("heat of slip", "heat", lambda row: float(row[1].record.heat[row[2]]), json="slip_heat_MJ"),
        Column("brake", "force", held(np.max, lambda setup: setup.brakes), json="brake_N"),
        Column("backstop", "force", held(lambda force: max(0.0, -np.min(force)), lambda setup: setup.backstops),
               json="backstop_N"),
        Column("take-up, setting", "force", "1.setup.setting", None, json="take_up_setting_N"),
        Column("take-up, lowest", "force", take_up(pull, np.min), json="take_up_min_N"),
        Column("take-up, highest", "force", take_up(pull, np.max), json="take_up_max_N"),
        Column("carriage, out", "length", take_up(attrgetter("travel"), np.max), None, json="carriage_out_m"),
        Column("carriage, in", "length", take_up(attrgetter("travel"), np.min), json="carriage_in_m"),
    )  # fmt: skip
    caption = "Drives and take-up; brake and backstop as they act at the belt, the carriage against its begin"
    return Table("scenario_drives", "Scenarios", caption, columns, rows, "dynamics", named=2)


def scenario_pulleys(dynamics: CalculatedDynamics) -> Table:
    """Highest and lowest tension at every pulley in every scenario, with their times; safety of the belt."""
    from conveyor.dynamics.criteria import pulley_peak

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
    from conveyor.dynamics.criteria import tension_peaks

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
        Column("time", "time", lambda row: float(row[1].times[row[2]])),
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


SCENARIO_TABLES: Final[Mapping[str, Callable[[CalculatedDynamics], Table]]] = {
    "scenarios": scenario_table,
    "scenario_sizes": size_table,
    "scenario_drives": scenario_drives,
    "scenario_pulleys": scenario_pulleys,
    "scenario_tensions": scenario_tensions,
    "scenario_splices": splice_tensions,
    "histories": history_table,
}
"""Tables of scenarios by key; in JSON they are named without ``scenario_``."""


def _dynamics_remarks(dynamics: CalculatedDynamics, every: tuple[Check, ...], system: System) -> Table:
    """Failed checks and assumptions."""
    warned = [
        *failed_fits(compounds_by_strand(dynamics.conveyor).values()),
        *(
            f"{check.case.text(system)}: {check.why.text(system)}"
            for check in every
            if check.failed and check.why is not None and check.case is not None
        ),
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


def _scenario_rows(name: str) -> Callable[[CalculatedDynamics], Any]:
    """Rows of a table of scenarios; left out where it has none."""

    def rows(dynamics: CalculatedDynamics) -> Any:
        table = SCENARIO_TABLES[name](dynamics)
        return table.plain() if table.rows else LEFT_OUT

    return rows


_EXTREMES: Final = ("highest_N", "highest_at_s", "lowest_N", "lowest_at_s")
SCENARIO_KEYS: Final[dict[str, JsonKey]] = {
    "scenarios": row_list(
        _scenario_rows("scenarios"), "scenario", "highest_in", "lowest_in",
        numbers=(
            "duration_s", "highest_tension_N", "highest_at_s", "lowest_tension_N", "lowest_at_s",
            "highest_speed_m_per_s", "rest_s", "way_m", "error", "energy_error", "cells", "step_s",
        ),
        of="one row a scenario; error is that of the peaks over the highest tension, by refinement",
    ),
    "drives": row_list(
        _scenario_rows("scenario_drives"), "scenario", "drive",
        numbers=(
            "torque_max", "torque_min", "force_max_N", "force_min_N", "power_kW", "slip_m", "slip_heat_MJ", "brake_N",
            "backstop_N", "take_up_setting_N", "take_up_min_N", "take_up_max_N", "carriage_out_m", "carriage_in_m",
        ),
    ),
    "pulleys": row_list(
        _scenario_rows("scenario_pulleys"), "scenario", "pulley", numbers=_EXTREMES, also=("safety",)
    ),
    "tensions": row_list(
        _scenario_rows("scenario_tensions"), "scenario", "section", "strand",
        numbers=(*_EXTREMES, "least_for_sag_N", "sag"),
    ),
    "splices": row_list(
        _scenario_rows("scenario_splices"), "scenario", numbers=("highest_N_per_mm", "lowest_N_per_mm"),
        also=("strength_N_per_mm",),
    ),
}  # fmt: skip
"""Keys of scenarios; their rows are those of the tables."""
_SIZES: Final = replace(
    JsonList(
        _scenario_rows("scenario_sizes"),
        item=row_object(
            {name: text_key(name) for name in ("sought", "scenario", "governs", "fails_with_less")}
            | {"value": number_key("value"), "error": number_key("error", known=False)}
            | {"most": number_key("most", known=False)},
            describe_value("figures that --size sought, in the unit that `sought` names"),
        ),
    ),
    optional=True,
)
DYNAMICS_KEYS: Final = JsonObject(
    lambda dynamics: dynamics,
    describe_value("conveyor dynamics SPEC --json"),
    keys={
        "schema_version": VERSION_KEY,
        "conveyor": text_key("conveyor.name"),
        "scenarios": SCENARIO_KEYS["scenarios"],
        "sizes": _SIZES,
        **SCENARIO_KEYS,
        "checks": JsonList(
            lambda dynamics: check_pairs(every := _every_check(dynamics), governing_by_subject(every)),
            describe_value("every criterion of every scenario; `case` is the scenario"),
            item=CHECK_KEYS,
        ),
        "assumptions": text_list("assumptions", "what the figures rest on that the spec does not say"),
    },
)
"""Keys of scenarios alone."""


def dynamics_json(dynamics: CalculatedDynamics) -> dict[str, Any]:
    """Plain numbers for JSON; `DYNAMICS_KEYS` describes them."""
    made: dict[str, Any] = DYNAMICS_KEYS.plain(dynamics)
    return made
