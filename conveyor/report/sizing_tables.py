"""Every table of a sizing, declared once."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from operator import attrgetter, itemgetter
from typing import Any, Final

from conveyor.checks import checks
from conveyor.remarks import assumptions
from conveyor.report import sizing_plots
from conveyor.report.columns import Column, Contents, Drawing, OnPage, Table
from conveyor.report.result_schema import SCHEMA_VERSION
from conveyor.report.tables import Remark, checked, document, provenance
from conveyor.sizing.around import VariedChoice, around
from conveyor.sizing.designs import CalculatedSizing
from conveyor.sizing.sized import SizedDesign
from conveyor.sizing.spacing import section_spacings
from conveyor.spec import fingerprint
from conveyor.units import System
from conveyor.units.presentation import MONEY
from conveyor.units.sentences import percent

PARTS: Final = (
    ("designs", "Designs"),
    ("costs", "Costs"),
    ("around", "Around the best design"),
    ("spacing", "Distances of the sets"),
    ("checks", "Checks of the best design"),
    ("remarks", "What it rests on"),
    ("provenance", "Provenance"),
)
"""Parts of the page."""
_TABLES: Final = ("designs", "costs", "around", "spacing")
_WHY: Final = (
    "of {calculated} candidates calculated exactly, chosen by a closed estimate out of {possible} that the series can "
    "build"
)


def of_sizing(sizing: CalculatedSizing, system: System, *, vary: bool = True) -> Contents:
    """Every table of a sizing in a unit system; with `vary` also what varies around the best design."""
    sweeps = around(sizing.task, sizing.best) if vary else ()
    best = sizing.best
    parts = (
        designs(sizing), costs(sizing), *([swept(sizing, sweeps)] if sweeps else []), spacing(sizing),
        checked(checks(best.found), system), _remarks(sizing), provenance(fingerprint(best.conveyor)),
    )  # fmt: skip
    about = document(best.conveyor, "Sizing", system, (("candidates", f"{sizing.candidates}"),))
    drawn = [Drawing("shares", "What a year costs, by part, of every design.",
                     partial(sizing_plots.shares, sizing, system=system), "costs"),
             Drawing("spacing", "Distances of the idler sets of the best design along its profile.",
                     partial(sizing_plots.spacing, sizing, system=system), "spacing")]  # fmt: skip
    if sweeps:
        words = "Cost of a year around the best design: one choice varied, belt class and motors sized again."
        drawn.append(
            Drawing("around", words, partial(sizing_plots.sweeps, sizing, sweeps, system=system), "around")
        )
    return Contents(about, tuple(part for part in parts if not part.empty), system, tuple(drawn))


def _money(sizing: CalculatedSizing) -> str:
    return f"{MONEY}{sizing.duty.prices.currency}"


def _of(get: str) -> Callable[[Any], Any]:
    """Of the design in a row of rank and design."""
    return lambda row: attrgetter(get)(row[1])


def designs(sizing: CalculatedSizing) -> Table:
    """One row a design, the cheapest in a year first."""
    money, saved = _money(sizing), sizing.best.year

    def col(label: str, kind: str, get: Callable[[Any], Any], json: str) -> Column:
        return Column(label, kind, get, json=json)

    columns = (
        col("rank", "count", itemgetter(0), "rank"),
        col("belt width", "size", _of("choice.trough.width.belt"), "width_mm"),
        col("trough", "angle", _of("choice.trough.angle"), "trough_deg"),
        col("speed", "speed", _of("choice.speed"), "speed_m_per_s"),
        col("filling", "share", _of("choice.filling"), "filling"),
        col("belt", "text", lambda row: _belt(row[1]), "belt"),
        col("top cover", "size", _of("chosen.top"), "top_cover_mm"),
        col("bottom cover", "size", _of("chosen.bottom"), "bottom_cover_mm"),
        Column("compound", "text", lambda row: row[1].conveyor.carry_compound.name, json="compound"),
        col("rolls", "size", _of("choice.roll.diameter"), "roll_diameter_mm"),
        col("carry sets", "spacing", lambda row: _widest(row[1]), "carry_spacing_m"),
        col("return sets", "spacing", _of("choice.back"), "return_spacing_m"),
        col("drives", "text", _of("choice.drives"), "drives"),
        col("motors", "power", lambda row: sum(row[1].chosen.motors), "motors_kW"),
        col("motor power", "power", _of("found.balance.power.motor"), "motor_power_kW"),
        col("belt safety", "ratio", _of("safety"), "belt_safety"),
        Column("take-up", "force", _of("found.balance.settled.setting"), json="take_up_N"),
        Column("L10 of a roll set", "life", _of("roll_life"), json="roll_life_h"),
        col("capital", money, lambda row: float(row[1].costs.whole_capital), "capital"),
        col("energy a year", money, lambda row: float(row[1].costs.yearly["energy"]), "energy_per_year"),
        col("cost a year", money, _of("year"), "cost_per_year"),
        Column("over the best", "share", lambda row: row[1].year / saved - 1.0, json="over_the_best"),
        Column("why", "text", lambda row: _why(sizing, row[0] - 1), json="why"),
    )  # fmt: skip
    caption = (
        "Designs, the cheapest in a year first; every one calculated exactly at its own belt class and motors"
    )
    rows = tuple(enumerate(sizing.designs, start=1))
    return Table("designs", "Designs", caption, columns, rows, (OnPage("designs", caption),))


def _belt(design: SizedDesign) -> str:
    carcass = design.chosen.carcass
    return f"{'ST' if carcass.steel_cord else 'EP'}{carcass.strength / 1e3:.0f}"


def _widest(design: SizedDesign) -> float:
    return max(design.choice.graduated or (design.choice.carry,))


def _why(sizing: CalculatedSizing, rank: int) -> str:
    """What it costs more for than the best, and less."""
    if rank == 0:
        shares = {name: value / sizing.best.year for name, value in sizing.best.costs.yearly.items()}
        most = sorted(shares, key=lambda name: -float(shares[name]))[:3]
        return "cheapest: " + ", ".join(f"{name} {percent(float(shares[name]))}" for name in most)
    best, own = sizing.best.costs.yearly, sizing.designs[rank].costs.yearly
    change = {name: float(own[name] - best[name]) for name in own}
    order = sorted(change, key=lambda name: -abs(change[name]))[:2]
    return ", ".join(f"{name} {change[name]:+,.0f}" for name in order if round(change[name]) != 0) + " a year"


def costs(sizing: CalculatedSizing) -> Table:
    """Capital and yearly cost of every design by part."""
    money = _money(sizing)
    rows = [
        (rank, name, design.costs.capital.get(name), float(value))
        for rank, design in enumerate(sizing.designs, start=1)
        for name, value in design.costs.yearly.items()
    ]
    columns = (
        Column("rank", "count", itemgetter(0), json="rank"),
        Column("part", "text", itemgetter(1), json="part"),
        Column("capital", money, lambda row: None if row[2] is None else float(row[2]), json="capital"),
        Column("a year", money, itemgetter(3), json="per_year"),
    )
    caption = "Capital and cost of a year by part: annuity over its life, upkeep, energy"
    note = "prices are general knowledge, known to a factor of two, unless the duty gives them"
    return Table("costs", "Costs", caption, columns, rows, (OnPage("costs", caption, printed=False),), note)


def swept(sizing: CalculatedSizing, sweeps: tuple[VariedChoice, ...]) -> Table:
    """One row a value around the best design."""
    money = _money(sizing)
    rows = [
        (
            sweep,
            value,
            design if isinstance(design, SizedDesign) else None,
            design if isinstance(design, str) else "",
        )
        for sweep in sweeps
        for value, design in zip(sweep.values, sweep.designs, strict=True)
    ]

    def of(get: Callable[[SizedDesign], Any]) -> Callable[[Any], Any]:
        return lambda row: None if row[2] is None else get(row[2])

    columns = (
        Column("choice", "text", lambda row: row[0].name, json="choice"),
        Column(
            "distance", "spacing", lambda row: row[1] if row[0].kind == "spacing" else None, json="distance_m"
        ),
        Column("size", "size", lambda row: row[1] if row[0].kind == "size" else None, json="size_mm"),
        Column(
            "speed", "speed", lambda row: row[1] if row[0].kind == "speed" else None, json="speed_m_per_s"
        ),
        Column("motor power", "power", of(attrgetter("found.balance.power.motor")), json="motor_power_kW"),
        Column("belt", "text", of(_belt), json="belt"),
        Column(
            "energy a year", money, of(lambda one: float(one.costs.yearly["energy"])), json="energy_per_year"
        ),
        Column("idlers a year", money, of(sizing_plots.idlers), json="idlers_per_year"),
        Column("belt a year", money, of(lambda one: float(one.costs.yearly["belt"])), json="belt_per_year"),
        Column("cost a year", money, of(attrgetter("year")), json="cost_per_year"),
        Column("no design because", "text", itemgetter(3), json="why"),
    )
    caption = "One choice varied around the best design, carry sets evenly apart; belt class, motors, brake sized again"
    return Table("around", "Around the best", caption, columns, rows, (OnPage("around", caption),))


def spacing(sizing: CalculatedSizing) -> Table:
    """Distances of the sets of every section, of the best design and of those that have them graduated."""
    rows = [
        (rank, one)
        for rank, design in enumerate(sizing.designs, start=1)
        if rank == 1 or design.choice.graduated
        for one in section_spacings(sizing.task, design)
    ]
    columns = (
        Column("rank", "count", itemgetter(0), json="rank"),
        Column("strand", "text", _of("strand"), json="strand"),
        Column("section", "text", _of("section"), json="section"),
        Column("length", "length", _of("length"), json="length_m"),
        Column("sets", "spacing", _of("built"), json="spacing_m"),
        Column("widest by sag", "spacing", _of("sag"), json="sag_m"),
        Column("widest by bearings", "spacing", _of("bearings"), json="bearings_m"),
        Column("cheapest", "spacing", _of("cheapest"), json="cheapest_m"),
    )
    caption = "Distances of the sets along the profile, and what ends them"
    note = (
        "Widest by sag at the lowest steady tension of the section, by the L10 asked for; cheapest of energy, "
        "rotation and the sets themselves. Where all three are wider than the sets stand, the series ended them "
        "(rules.carry_spacings, rules.return_spacings)"
    )
    return Table("spacing", "Spacing", caption, columns, rows, (OnPage("spacing", caption),), note)


def _remarks(sizing: CalculatedSizing) -> Table:
    best = sizing.best
    told = _WHY.format(calculated=sizing.calculated, possible=f"{sizing.possible:,}")
    lines = [
        f"the ranks are exact: {told}; a candidate that was not calculated may be better by what the estimate is off",
        f"the estimate's cost of a year was off by at most {percent(sizing.estimate_error, 1)} where it was calculated",
        f"{sizing.candidates:,} combinations keep the rules of width, lumps, filling, edge distance and rotation",
        "prices, series and rules without a source are general knowledge, orders of magnitude: give your own in the "
        "duty (prices, rules)",
        "carry and return compounds are those of the duty; covers by DIN 22101's points for wear (general knowledge)",
        *(f"{count} calculated candidates are no designs: {why}" for why, count in sizing.refused.items()),
        *assumptions(best.conveyor),
    ]
    rows = tuple(Remark(("assumption", line)) for line in lines)
    columns = (Column("kind", "text", attrgetter("kind")), Column("text", "text", attrgetter("text")))
    return Table("remarks", "Checks and notes", "Remarks", columns, rows, (OnPage("remarks", "Remarks"),))


def plain(contents: Contents, sizing: CalculatedSizing) -> dict[str, Any]:
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
