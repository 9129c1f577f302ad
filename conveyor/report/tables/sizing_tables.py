"""Tables and figures of a sizing, declared once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from conveyor.line.covers import compounds_by_strand
from conveyor.models.calculation_methods import FACTOR_METHODS, METHOD_NAMES
from conveyor.remarks.assumptions import analysis_assumptions, failed_fits
from conveyor.report.analysis_plots import cross_section, route_profile
from conveyor.report.json_keys import SCHEMA_VERSION
from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import add_legend, curve_colour, finish_figure, group_thousands, set_title, stacked_axes
from conveyor.report.table_model import (
    Column,
    Contents,
    Drawing,
    Figure,
    PagePlacement,
    Table,
    figure_table,
    remark_table,
)
from conveyor.report.tables.check_tables import check_table
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.report.tables.loop_tables import section_boundaries
from conveyor.sizing.design_choice import ListedPart
from conveyor.sizing.design_search import CalculatedSizing
from conveyor.sizing.part_sizing import BRAKE_RESERVE
from conveyor.sizing.sensitivity import VariedChoice, vary_choices
from conveyor.sizing.sized_design import SizedDesign
from conveyor.sizing.spacing import SectionSpacing, section_spacings
from conveyor.spec import fingerprint
from conveyor.units import System
from conveyor.units.presentation import MONEY, display_unit, format_figure
from conveyor.units.sentences import percent

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

PARTS: Final = (
    ("verdict", "The best design"),
    ("designs", "Designs"),
    ("listed", "Parts of makers' lists"),
    ("costs", "Costs"),
    ("around", "Around the best design"),
    ("spacing", "Distances of the sets"),
    ("checks", "Checks of the best design"),
    ("remarks", "What it rests on"),
    ("provenance", "Provenance"),
)
"""Parts of the page."""
_TABLES: Final = ("designs", "listed_parts", "costs", "around", "spacing")
_JUDGED_BY: Final = {
    ("pulleys", "the shaft"): ("bearing_centres", "hub_centres", "shaft_steel"),
    ("pulleys", "the life of the bearings"): ("bearing_rating",),
    ("pulleys", "the lagging"): ("lagging_pressure",),
    ("brakes", "the heat of a stop"): ("brake_heat",),
}
"""Fields of an item that a part of it is judged by."""
_CANDIDATES: Final = (
    "of {calculated} candidates calculated exactly, chosen by a closed estimate out of {possible} that the series can "
    "build"
)


def sizing_contents(sizing: CalculatedSizing, system: System, *, vary: bool = True) -> Contents:
    """Contents of the sizing report in a unit system; with `vary` also variations of the best design."""
    sweeps = vary_choices(sizing.task, sizing.best, sizing.neighbours) if vary else ()
    best, line = sizing.best, sizing.best.found.line
    parts = (
        best_design_table(sizing, system), design_table(sizing),
        *([listed_part_table(sizing)] if sizing.best.chosen.listed else []), cost_table(sizing),
        *([sweep_table(sizing, sweeps)] if sweeps else []), spacing_table(sizing),
        check_table(best.every_load.governing, system), _sizing_remarks(sizing),
        provenance_table(fingerprint(best.conveyor)),
    )  # fmt: skip
    about = report_head(best.conveyor, "Sizing", system, (("candidates", f"{sizing.candidates:,}"),))
    drawn = [Drawing("sets", "Sets of the best design with belt and bulk, to scale.",
                     partial(cross_section, best.conveyor, line, system=system), "verdict"),
             Drawing("profile", "Profile of the route.",
                     partial(route_profile, best.conveyor, line, section_boundaries(line), system=system), "verdict"),
             Drawing("shares", "What a year costs, by part, of every design.",
                     partial(cost_shares, sizing, system=system), "costs"),
             Drawing("spacing", "Distances of the idler sets of the best design along its profile.",
                     partial(spacing_diagram, sizing, system=system), "spacing")]  # fmt: skip
    if sweeps:
        words = "Cost of a year around the best design: one choice varied, belt class and motors sized again."
        drawn.append(Drawing("around", words, partial(cost_lines, sizing, sweeps, system=system), "around"))
    return Contents.of(about, parts, system, drawings=tuple(drawn), page=PARTS)


def _money_kind(sizing: CalculatedSizing) -> str:
    return f"{MONEY}{sizing.duty.prices.currency}"


def best_design_table(sizing: CalculatedSizing, system: System) -> Table:
    """Figures of the best design; the largest stand as tiles on page one."""
    best, money = sizing.best, _money_kind(sizing)
    choice, found = best.choice, best.found
    rows = (
        Figure("belt width", "size", choice.trough.width.belt, "tile"),
        Figure("belt speed", "speed", choice.speed, "tile"),
        Figure("belt", "text", _belt_name(best), "tile"),
        Figure("roll diameter", "size", choice.roll.diameter, "tile"),
        Figure("carry sets every", "spacing", _widest_spacing(best), "tile"),
        Figure("return sets every", "spacing", choice.back, "tile"),
        Figure("motors", "text", _motor_sizes(best, system), "tile"),
        Figure("motor power", "power", found.balance.power.motor, "tile"),
        Figure("belt safety", "ratio", best.safety, "tile"),
        Figure("take-up", "force", found.balance.equilibrium.setting, "tile"),
        Figure("energy cost a year", money, float(best.costs.yearly["energy"]), "tile"),
        Figure("cost a year", money, best.year, "tile"),
    )
    return figure_table("best_design", "", "The best design", rows)


def _motor_sizes(best: SizedDesign, system: System) -> str:
    """Number and rated power of the motors, which are equal."""
    drive = best.conveyor.drive
    count = sum(one.motors for one in (drive, *drive.further_drives))
    each = format_figure(sum(best.chosen.motors) / count, "power", system)
    return f"{count}\N{NO-BREAK SPACE}×\N{NO-BREAK SPACE}{each}" if count > 1 else each


def design_table(sizing: CalculatedSizing) -> Table:
    """Designs, the lowest yearly cost first."""
    money, saved = _money_kind(sizing), sizing.best.year

    columns = (
        Column("rank", "count", "0", json="rank"),
        Column("belt width", "size", "1.choice.trough.width.belt", json="width_mm"),
        Column("trough", "angle", "1.choice.trough.angle", None, json="trough_deg"),
        Column("speed", "speed", "1.choice.speed", json="speed_m_per_s"),
        Column("filling", "share", "1.choice.filling", None, json="filling"),
        Column("belt", "text", lambda row: _belt_name(row[1]), json="belt"),
        Column("top cover", "size", "1.chosen.top", None, json="top_cover_mm"),
        Column("bottom cover", "size", "1.chosen.bottom", None, json="bottom_cover_mm"),
        Column("compound", "text", "1.conveyor.carry_compound.name", None, json="compound"),
        Column("rolls", "size", "1.choice.roll.diameter", json="roll_diameter_mm"),
        Column("CEMA class", "text", "1.choice.roll.cema_class", None, json="cema_class", sparse=True),
        Column("carry sets", "spacing", lambda row: _widest_spacing(row[1]), json="carry_spacing_m"),
        Column("closest carry sets", "spacing", lambda row: min(row[1].choice.graduated, default=None),
               json="closest_carry_spacing_m", sparse=True),
        Column("return sets", "spacing", "1.choice.back", None, json="return_spacing_m"),
        Column("drives", "text", "1.choice.drives", None, json="drives"),
        Column("motors", "power", lambda row: sum(row[1].chosen.motors), json="motors_kW"),
        Column("motor power", "power", "1.found.balance.power.motor", json="motor_power_kW"),
        Column("belt safety", "ratio", "1.safety", None, json="belt_safety"),
        Column("take-up", "force", "1.found.balance.equilibrium.setting", None, json="take_up_N"),
        Column("L10 of a roll set", "duration", "1.roll_life", None, json="roll_life_h"),
        Column("capital", money, "1.costs.whole_capital", None, json="capital"),
        Column("energy cost a year", money, "1.costs.yearly.energy", None, json="energy_cost_per_year"),
        Column("cost a year", money, "1.year", json="cost_per_year"),
        Column("over the best", "share", lambda row: row[1].year / saved - 1.0, json="over_the_best"),
        Column("why", "text", lambda row: _cost_reason(sizing, row[0] - 1), json="why"),
    )  # fmt: skip
    caption = "Designs, the cheapest in a year first; every one calculated exactly at its own belt class and motors"
    rows = tuple(enumerate(sizing.designs, start=1))
    return Table("designs", "Designs", caption, columns, rows, "designs")


def listed_part_table(sizing: CalculatedSizing) -> Table:
    """Items of makers' lists that pulleys and drives of every design are made of, and their use."""
    rows = [
        (rank, part)
        for rank, design in enumerate(sizing.designs, start=1)
        if design.chosen.listed is not None
        for part in design.chosen.listed.parts
    ]

    def figure(kind: str, name: str) -> Callable[[tuple[int, ListedPart]], float | None]:
        return lambda row: getattr(row[1], name) if row[1].kind == kind else None

    columns = (
        Column("rank", "count", "0", json="rank"),
        Column("place", "text", "1.place", json="place"),
        Column("part", "text", "1.item.one", json="part"),
        Column("item", "text", "1.item.name", json="item"),
        Column("least diameter", "size", figure("thickness", "needed"), json="least_diameter_mm", sparse=True),
        Column("diameter", "size", figure("thickness", "rated"), json="diameter_mm", sparse=True),
        Column("torque needed", "torque", figure("torque", "needed"), json="torque_needed_Nm", sparse=True),
        Column("rated torque", "torque", figure("torque", "rated"), json="rated_torque_Nm", sparse=True),
        Column("force needed", "force", figure("force", "needed"), json="force_needed_N", sparse=True),
        Column("rated force", "force", figure("force", "rated"), json="rated_force_N", sparse=True),
        Column("use", "share", "1.use", json="use"),
        Column("source", "text", "1.item.source", None, json="source"),
    )
    caption = "Items of makers' lists chosen for pulleys and drives"
    note = (
        f"Gearbox and coupling with the service factor {sizing.duty.rules.service_factor:g}; backstop and brake "
        f"{BRAKE_RESERVE:g} times what holds the belt in the worst load with the least friction; pulleys by the "
        "carcass, their shafts, bearings and lagging in the checks where the list has them"
    )
    return Table("listed_parts", "Listed parts", caption, columns, tuple(rows), "listed", note)


def _unjudged_items(design: SizedDesign) -> Iterator[str]:
    """Remarks on chosen items that are not judged, because their lists do not state what they bear."""
    for part in () if design.chosen.listed is None else design.chosen.listed.parts:
        for (kind, what), needed in _JUDGED_BY.items():
            lacking = ", ".join(name for name in needed if name not in part.item.fields)
            if kind == part.item.kind and lacking:
                yield f"{part.item.one} {part.item.name}: {what} is not judged, its list has no {lacking}"


def _widths_without_rolls(sizing: CalculatedSizing) -> Iterator[str]:
    """Remark on belt widths that are not tried because lists have no rolls for them."""
    lost = [format_figure(width, "size", sizing.duty.report.units) for width in sizing.task.widths_without_rolls]
    if lost and sizing.duty.listed.items("rolls"):
        yield f"no listed rolls are of one diameter and the lengths that belts of {' | '.join(lost)} need: not tried"


def _belt_name(design: SizedDesign) -> str:
    return design.chosen.carcass.name


def _widest_spacing(design: SizedDesign) -> float:
    return max(design.choice.graduated or (design.choice.carry,))


def _cost_reason(sizing: CalculatedSizing, rank: int) -> str:
    """Largest cost shares of the best design, or largest differences to it."""
    if rank == 0:
        shares = {name: value / sizing.best.year for name, value in sizing.best.costs.yearly.items()}
        most = sorted(shares, key=lambda name: -float(shares[name]))[:3]
        return "cheapest: " + ", ".join(f"{name} {percent(float(shares[name]))}" for name in most)
    best, own = sizing.best.costs.yearly, sizing.designs[rank].costs.yearly
    change = {name: float(own[name] - best[name]) for name in own}
    order = sorted(change, key=lambda name: -abs(change[name]))[:2]
    told = ", ".join(f"{name} {change[name]:+,.0f}" for name in order if round(change[name]) != 0)
    return f"{told} a year" if told else "as cheap as the first"


def cost_table(sizing: CalculatedSizing) -> Table:
    """Capital and yearly cost of every design by part."""
    money = _money_kind(sizing)
    rows = [
        (rank, name, design.costs.capital.get(name), float(value))
        for rank, design in enumerate(sizing.designs, start=1)
        for name, value in design.costs.yearly.items()
    ]
    columns = (
        Column("rank", "count", "0", json="rank"),
        Column("part", "text", "1", json="part"),
        Column("capital", money, "2", json="capital"),
        Column("a year", money, "3", json="per_year"),
    )
    caption = "Capital and cost of a year by part: annuity over its life, upkeep, energy"
    note = "prices are general knowledge, known to a factor of two, unless the duty gives them"
    return Table("costs", "Costs", caption, columns, rows, (PagePlacement("costs", caption, printed=False),), note)


def sweep_table(sizing: CalculatedSizing, sweeps: tuple[VariedChoice, ...]) -> Table:
    """Variations of one choice around the best design."""
    money = _money_kind(sizing)
    rows = [
        (
            sweep,
            dict.fromkeys(("spacing", "size", "speed")) | {sweep.kind: value},
            design if isinstance(design, SizedDesign) else None,
            design if isinstance(design, str) else "",
            "" if isinstance(design, str) else "every load" if every_load else "full belt",
        )
        for sweep in sweeps
        for value, design, every_load in zip(sweep.values, sweep.designs, sweep.every_load, strict=True)
    ]

    columns = (
        Column("choice", "text", "0.name", json="choice"),
        Column("distance", "spacing", "1.spacing", json="distance_m"),
        Column("size", "size", "1.size", json="size_mm"),
        Column("speed", "speed", "1.speed", json="speed_m_per_s"),
        Column("motor power", "power", "2.found.balance.power.motor", json="motor_power_kW"),
        Column("belt", "text", lambda row: row[2] and _belt_name(row[2]), json="belt"),
        Column("energy cost a year", money, "2.costs.yearly.energy", json="energy_cost_per_year", page=None),
        Column(
            "idler cost a year", money, lambda row: row[2] and idler_cost(row[2]), json="idlers_per_year", page=None
        ),
        Column("belt cost a year", money, "2.costs.yearly.belt", json="belt_per_year", page=None),
        Column("cost a year", money, "2.year", json="cost_per_year"),
        Column("calculated for", "text", "4", json="calculated_for"),
        Column("no design because", "text", "3", json="why"),
    )
    note = (
        "Values beside that of the design, and all that cost less with the full belt, are calculated in every load; "
        "the others with the full belt: further loads only add cost. None that keeps every rule in every load costs "
        "less than rank 1"
    )
    caption = "One choice varied around the best design, carry sets evenly apart; belt class, motors, brake sized again"
    return Table("around", "Around the best", caption, columns, rows, "around", note)


def spacing_table(sizing: CalculatedSizing) -> Table:
    """Idler spacing of every section, of the best design and of those with graduated spacing."""
    rows = [
        (rank, one)
        for rank, design in enumerate(sizing.designs, start=1)
        if rank == 1 or design.choice.graduated
        for one in section_spacings(sizing.task, design)
    ]
    columns = (
        Column("rank", "count", "0", json="rank"),
        Column("strand", "text", "1.strand", json="strand"),
        Column("section", "text", "1.section", json="section"),
        Column("length", "length", "1.length", json="length_m"),
        Column("sets", "spacing", "1.built", json="spacing_m"),
        Column("widest by sag", "spacing", "1.sag", json="sag_m"),
        Column("widest by bearings", "spacing", "1.bearings", json="bearings_m"),
        Column("cheapest", "spacing", _cheapest_spacing, json="cheapest_m", sparse=True),
    )
    caption = "Distances of the sets along the profile, and what ends them"
    note = (
        "Widest by sag at the lowest steady tension of the section, by the L10 asked for; cheapest of energy, "
        "rotation and the sets themselves. Where all three are wider than the sets stand, the series ended them "
        "(rules.carry_spacings, rules.return_spacings)"
    )
    return Table("spacing", "Spacing", caption, columns, rows, "spacing", note)


def _cheapest_spacing(row: tuple[int, SectionSpacing]) -> float | None:
    """Spacing of minimum cost [m]; None by a method none of whose resistances grows with it."""
    return row[1].cheapest if math.isfinite(row[1].cheapest) else None


def _sizing_remarks(sizing: CalculatedSizing) -> Table:
    best = sizing.best
    told = _CANDIDATES.format(calculated=sizing.calculated, possible=f"{sizing.possible:,}")
    lines = [
        *failed_fits(compounds_by_strand(best.conveyor).values()),
        f"ranked by full calculation: {told}; an uncalculated candidate may be better, within the error of the "
        "estimate",
        f"the estimate's cost of a year was off by at most {percent(sizing.estimate_error, 1)} where it was calculated",
        f"{sizing.candidates:,} combinations keep the rules of width, lumps, filling, edge distance and rotation",
        "prices, series and rules without a source are general knowledge, orders of magnitude: give your own in the "
        "duty (prices, rules)",
        "carry and return compounds are those of the duty; covers by DIN 22101's points for wear (general knowledge)",
        *_method_remarks(sizing),
        *(f"{count} calculated candidates are no designs: {why}" for why, count in sizing.refused.items()),
        *_missing_feeding(sizing),
        *_widths_without_rolls(sizing),
        *dict.fromkeys(_unjudged_items(best)),
        *analysis_assumptions(best.conveyor),
    ]
    return remark_table({"assumption": lines}, page="remarks")


def _method_remarks(sizing: CalculatedSizing) -> Iterator[str]:
    """Remarks on the classical method that designs are sized by."""
    method = sizing.duty.calculation.method
    if method == "viscoelastic":
        return
    yield (
        f"forces, tensions, parts and checks are by {METHOD_NAMES[method]}, which knows no rubber: the compounds of "
        "the duty do not change the force, every design has the cheapest"
    )
    yield "no resistance grows with the distance of the sets: the widest that sag, bearings and rules allow costs least"
    if method in FACTOR_METHODS:
        yield "f is that of the duty at every roll, distance of sets and temperature"
    else:
        yield (
            "Ky, Ai and Kt are those of the duty at every roll, distance of sets and temperature: keep to those that "
            "the book's figures are of (rules.roll_diameters, rules.carry_spacings)"
        )


def _missing_feeding(sizing: CalculatedSizing) -> Iterator[str]:
    """Remark on a duty without a loading point: what its designs assume and have not, and what to give."""
    if sizing.duty.sized_route.feeding is None:
        yield (
            "no loading point is given: carry sets stand closer over the distance the belt runs in 1.2 s (skirtboard "
            "length after Martin Engineering), half as far apart as elsewhere (general knowledge; "
            "rules.loading_spacing); "
            "they are not judged for impact, skirts are assumed: give route.feeding with skirt_length, skirt_width and "
            "drop_height"
        )
        if sizing.duty.route is None:
            yield "route.feeding needs a route: give route with one section of the length and lift instead of them"


def sizing_json(contents: Contents, sizing: CalculatedSizing) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys, money in `currency`."""
    return {
        "schema_version": SCHEMA_VERSION,
        "duty": sizing.duty.name,
        "currency": sizing.duty.prices.currency,
        "candidates": sizing.candidates,
        "possible": sizing.possible,
        "calculated": sizing.calculated,
        "estimate_error": sizing.estimate_error,
        "refused": dict(sizing.refused),
        **{key: contents[key].plain() for key in _TABLES if key in contents},
        "assumptions": list(contents.lines("assumption")),
    }


_HEIGHT, _PANEL_HEIGHT = 3.0, 2.7
_OVER_SERIES = 1.5  # of the widest distance in the series: limits far above it say no more


def idler_cost(design: SizedDesign) -> float:
    """Cost of rolls and frames of a year [currency/a]."""
    return float(design.costs.yearly["rolls"] + design.costs.yearly["idler frames"])


@own_settings()
def cost_shares(sizing: CalculatedSizing, *, system: System) -> Picture:
    """Yearly cost by part, one bar per design."""
    money = display_unit(f"{MONEY}{sizing.duty.prices.currency}", system, large=True)
    figure, (axis,) = stacked_axes(1, _HEIGHT + 0.22 * len(sizing.designs))
    ranks = np.arange(1, len(sizing.designs) + 1)
    start = np.zeros(len(ranks))
    for k, name in enumerate(sizing.best.costs.yearly):
        cost = money(np.array([max(0.0, float(design.costs.yearly[name])) for design in sizing.designs]))
        axis.barh(ranks, cost, left=start, color=curve_colour(k), label=name)
        start = start + cost
    axis.set(yticks=ranks)
    axis.invert_yaxis()
    return finish_figure(figure, money.beside("cost of a year"), "rank", sizing.duty.name, group="x")


@own_settings()
def cost_lines(sizing: CalculatedSizing, varied: tuple[VariedChoice, ...], *, system: System) -> Picture:
    """Yearly cost of energy, idlers, belt and the rest, one choice varied around the best design."""
    money = display_unit(f"{MONEY}{sizing.duty.prices.currency}", system, large=True)
    figure, axes = stacked_axes(len(varied), _PANEL_HEIGHT * len(varied))
    for axis, sweep in zip(axes, varied, strict=True):
        kind = display_unit(sweep.kind, system)
        points = [(x, one) for x, one in zip(sweep.values, sweep.designs, strict=True) if isinstance(one, SizedDesign)]
        at = kind(np.array([x for x, _ in points]))
        parts = {
            "energy": [float(one.costs.yearly["energy"]) for _, one in points],
            "idlers": [idler_cost(one) for _, one in points],
            "belt": [float(one.costs.yearly["belt"]) for _, one in points],
        }
        whole = np.array([one.year for _, one in points])
        parts["the rest"] = list(whole - np.sum(list(parts.values()), axis=0))
        for k, (name, cost) in enumerate(parts.items()):
            axis.plot(at, money(np.array(cost)), color=curve_colour(k), marker="o", markersize=3, label=name)
        axis.plot(at, money(whole), color="black", marker="o", linewidth=2.0, markersize=4, label="whole")
        axis.axvline(float(kind(sweep.at)), color="0.6", linestyle="--", linewidth=1.0)
        axis.set(xlabel=kind.beside(sweep.name), ylabel=money.beside("a year"), ylim=(0.0, None))
        group_thousands(axis.yaxis)
    add_legend(axes[0])
    set_title(figure, f"{sizing.duty.name}: around the best design")
    return figure


@own_settings()
def spacing_diagram(sizing: CalculatedSizing, *, system: System) -> Picture:
    """Idler spacing of the best design along its profile, and the widest that sag and bearings allow."""
    figure, (axis, profile) = stacked_axes(2, _HEIGHT + _PANEL_HEIGHT)
    large, apart = display_unit("length", system, large=True), display_unit("spacing", system)
    line = sizing.best.found.line
    steps = [(one.length, one.length * math.sin(one.inclination)) for one in line.stretches[: line.count]]
    ends = np.vstack([(0.0, 0.0), np.cumsum(steps, axis=0)])
    along = large(ends[:, 0])
    profile.plot(along, large(ends[:, 1]), color="#1F4E79", marker=".")
    profile.set(ylabel=large.beside("height over the tail"))
    rows = list(section_spacings(sizing.task, sizing.best))
    for k, strand in enumerate(("carry", "return")):
        mine = [row for row in rows if row.strand == strand]
        for values, style, wide, label in (
            ([row.built for row in mine], "-", 2.0, f"{strand} sets"),
            ([row.sag for row in mine], "--", 1.0, f"{strand}, widest by sag"),
            ([row.bearings for row in mine], ":", 1.0, f"{strand}, widest by L10 of the bearings"),
        ):
            axis.stairs(
                apart(np.array(values)), along, baseline=None, color=curve_colour(k), linestyle=style, linewidth=wide,
                label=label,
            )  # fmt: skip
    most = max(*sizing.task.spacings[0], *sizing.task.spacings[1])
    axis.set(ylabel=apart.beside("distance of sets"), ylim=(0.0, float(apart(_OVER_SERIES * most))))
    profile.set(xlabel=large.beside("along the belt from the tail"))
    for each in (profile, axis):
        group_thousands(each.xaxis)
    add_legend(axis)
    set_title(figure, f"{sizing.duty.name}: idler sets along the profile")
    return figure
