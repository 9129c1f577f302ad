"""Tables of a comparison of compounds, declared once; its ranking and notes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

from conveyor.laws.energy import DutySums, duty_emission
from conveyor.laws.power import JOULE_PER_KWH
from conveyor.loop.annual_energy import annual_cost, lacks_feed_in_price
from conveyor.report import plots, what_if
from conveyor.report.json_keys import (
    VERSION_KEY,
    JsonList,
    JsonObject,
    describe_value,
    number_key,
    number_list,
    table_rows,
    text_key,
    text_list,
)
from conveyor.report.page_elements import notebook_html
from conveyor.report.table_model import Column, Contents, Drawing, PagePlacement, Remark, Table, figure_table
from conveyor.report.tables.document_tables import provenance_table, report_head
from conveyor.report.tables.rubber_tables import band_columns
from conveyor.rubber.rolling_test_factor import UNTESTED_FACTOR
from conveyor.spec import fingerprint
from conveyor.studies.comparison import RankedPower
from conveyor.text.markup import Html
from conveyor.units import System
from conveyor.units.presentation import MONEY, NEVER, display_unit
from conveyor.units.sentences import degree_signs, to_celsius

if TYPE_CHECKING:
    from conveyor.models import Operation
    from conveyor.studies.comparison import CalculatedComparison, ComparedScene

PARTS: Final = (
    ("ranking", "Ranking"),
    ("warnings", "Action required, basis and limitations"),
    ("power", "Power"),
    ("loss-tangents", "Loss tangents"),
    ("coverage", "Coverage of the data"),
    ("scenes", "Every scene"),
    ("refused", "Without an answer"),
)
"""Parts of the page."""
_COSTS = (
    "energy_per_year", "cost_per_year", "saving_per_year", "carbon_dioxide_per_year", "extra_cost_of_the_belt",
    "payback", "energy_drawn", "energy_fed_back",
)  # fmt: skip
_PAPER_VIEW = "paper"  # a view that no page has: columns of the workbook that it prints
_COMPOUND = Column("compound", "text", "compound")
_TEMPERATURE = Column("temperature", "temperature", "temperature")
_SPEED = Column("belt speed", "speed", "speed", key="speed")


def comparison_contents(comparison: CalculatedComparison, system: System) -> Contents:
    """Contents of the comparison report in a unit system."""
    ranked, every = ranking_table(comparison), scene_table(comparison)
    parts = (
        replace(ranked, columns=tuple(c for c in ranked.columns if c.key not in _COSTS)),
        cost_table(ranked),
        what_if_table(comparison),
        *power_tables(comparison, system),
        every,
        coverage_table(comparison),
        refused_scenes(comparison),
        comparison_remarks(comparison, system),
        compound_table(comparison),
        provenance_table(fingerprint(comparison.conveyor), "Notes"),
    )
    facts = (
        ("compounds", ", ".join(compound.name for compound in comparison.compounds)),
        ("savings against", comparison.base),
        ("cover", comparison.cover),
        *(
            (
                f"belt {name}s",
                _value_range([getattr(scene, name) for scene in comparison.scenes], name, system),
            )
            for name in ("temperature", "speed")
        ),
    )
    about = report_head(comparison.conveyor, "Comparison of belt covers", system, facts)
    drawn = tuple(comparison_drawings(comparison, system))
    return Contents.of(about, parts, system, drawings=drawn, page=PARTS, layout="comparison")


def _value_range(values: list[float], kind: str, system: System) -> str:
    ends = [display_unit(kind, system).four_digits(value) for value in (min(values), max(values))] if values else []
    return " to ".join(dict.fromkeys(ends)) or "none answered"


def _money_kind(comparison: CalculatedComparison) -> str:
    operation = comparison.conveyor.operation
    return MONEY + ("-" if operation is None or operation.price is None else operation.price.currency)


def scene_table(comparison: CalculatedComparison) -> Table:
    """One row per scene, by compound, speed and temperature; no cost where the rubber data do not reach."""
    money = _money_kind(comparison)
    covered = {_scene_key(scene) for scene in comparison.covered}

    def known(row: ComparedScene, figure: float | None) -> float | None:
        return figure if _scene_key(row) in covered else None

    columns = (
        _COMPOUND,
        _TEMPERATURE,
        _SPEED,
        Column("indentation", "force", "indentation"),
        Column("effective tension", "force", "effective"),
        Column("equivalent DIN f", "friction", "friction_factor"),
        Column("motor power", "power", "motor"),
        Column("motor power, low", "power", "motor_low", sparse=True),
        Column("motor power, high", "power", "motor_high", sparse=True),
        Column("largest tension", "force", "largest_tension"),
        Column("energy", "specific energy", "energy_per_tonne_km", sparse=True),
        Column("energy per year", "energy", lambda row: _kwh_in_joules(known(row, row.energy_per_year)), None,
        sparse=True),
        Column("cost per year", money, lambda row: known(row, row.cost_per_year), None, sparse=True),
        Column("error estimate", "error", "error"),
        Column("covered", "verdict", lambda row: "yes" if _scene_key(row) in covered else "NO"),
    )  # fmt: skip
    page = (PagePlacement("scenes", "One row a compound, speed and temperature"),)
    return Table("scenes", "Scenes", "Every scene that has an answer", columns, comparison.scenes, page)


def _scene_key(scene: ComparedScene) -> tuple[str, float, float]:
    """Sort key of a scene."""
    return scene.compound, scene.speed, scene.temperature


def _kwh_in_joules(kwh: float | None) -> float | None:
    return None if kwh is None else kwh * JOULE_PER_KWH


@dataclass(frozen=True)
class RankedCompound:
    """Mean results of a compound at a speed over all temperatures, SI; energies of a year [kWh].

    Attributes
    ----------
    compound : str
        Name.
    speed : float
        Of the belt [m/s].
    temperature : float or None
        Temperature of the peak [K].
    averaged : int
        Number of temperatures averaged: those that the data of every compound reach.
    indentation, motor, low, high, peak : float or None
        Means [N, W], ends of the band [W], peak power [W]; None where its data do not reach.
    base : float or None
        Mean power of the base [W]; None if not comparable.
    year : DutySums or None
        Energy drawn and fed back.
    cost, before, emission, extra : float or None
        Cost of a year [currency]; the base's; carbon dioxide [kg]; extra cost of its belt [currency].
    why : str or None
        Reason why it is not compared with the base.
    rank : int or None
        Rank; equal for compounds whose powers do not differ significantly.
    """

    compound: str
    speed: float
    temperature: float | None
    averaged: int
    indentation: float | None
    motor: float | None
    low: float | None
    high: float | None
    peak: float | None
    base: float | None
    year: DutySums | None
    cost: float | None
    before: float | None
    emission: float | None
    extra: float | None
    why: str | None
    rank: int | None = None

    @property
    def change(self) -> float | None:
        """Relative difference of power to the base [-]."""
        return None if not self.motor or not self.base else self.motor / self.base - 1.0

    @property
    def band(self) -> tuple[float | None, float | None]:
        """Band of the relative difference of power to the base [-]."""
        if not self.base:
            return None, None
        low, high = (None if end is None else end / self.base - 1.0 for end in (self.low, self.high))
        return low, high

    @property
    def saving(self) -> float | None:
        """Saving against the base [currency a year]."""
        return None if self.cost is None or self.before is None else self.before - self.cost

    @property
    def payback(self) -> float | None:
        """Extra cost over saving [a]; infinite where nothing is saved, None where either is not known."""
        saved = self.saving
        if self.extra is None or saved is None:
            return None
        return self.extra / saved if saved > 0.0 else math.inf


def ranking_table(comparison: CalculatedComparison) -> Table:
    """Ranking by mean motor power, one row per compound and speed.

    Means are over the temperatures that the data of every compound reach at that speed, equally weighted; the peak is
    the largest power within the compound's own data. Compounds that are not comparable come last. Powers that do not
    differ significantly have one rank.
    """
    speeds = dict.fromkeys(scene.speed for scene in comparison.scenes)
    rows = tuple(row for speed in speeds for row in _rank_compounds(comparison, speed))
    columns = (
        _COMPOUND,
        Column("rank", "count", "rank", sparse=True),
        _SPEED,
        Column("temperatures averaged", "count", "averaged", page=None),
        Column("mean indentation", "force", "indentation", page=None, sparse=True),
        Column("mean motor power", "power", "motor", sparse=True),
        Column("mean motor power, low", "power", "low", sparse=True),
        Column("mean motor power, high", "power", "high", sparse=True),
        Column("difference to base", "share", "change", json="motor power against base", sparse=True,
               key="motor_power_against_base"),
        Column("difference, low", "share", "band.0", sparse=True),
        Column("difference, high", "share", "band.1", sparse=True),
        Column("peak motor power", "power", "peak", sparse=True),
        Column("at temperature", "temperature", "temperature", sparse=True),
        *_year_columns(comparison, rows),
        Column("not compared", "text", "why", sparse=True),
    )  # fmt: skip
    heading, page = (
        "Ranking by mean motor power, lowest first at each speed",
        (PagePlacement("ranking", "Ranking by mean motor power, lowest first"),),
    )
    return Table("ranking", "Ranking", heading, columns, rows, page)


def _year_columns(comparison: CalculatedComparison, rows: tuple[RankedCompound, ...]) -> Iterator[Column]:
    """Energy, cost, saving, carbon dioxide and payback, as formulas of hours and prices."""
    money, bases = (
        _money_kind(comparison),
        {row.speed: i for i, row in enumerate(rows) if row.compound == comparison.base},
    )
    of = "[energy_drawn]", "[energy_fed_back]"
    shown = "" if comparison.extra_costs else None

    def where(known: str, formula: str) -> Callable[[RankedCompound], str]:
        """Formula of rows whose figure is known."""
        return lambda row: "" if getattr(row, known) is None else formula

    def saving(row: RankedCompound) -> str:
        return "" if row.saving is None else f"[cost_per_year:{bases[row.speed]}]-[cost_per_year]"

    yield Column(
        "energy per year", "energy", _energy_getter("net_kwh"), sparse=True,
        formula=where("year", f"({of[0]}-{of[1]}){what_if.HOURS_RATIO}"),
    )  # fmt: skip
    yield Column("cost per year", money, "cost", sparse=True, formula=where("cost", what_if.cost_formula(*of)))
    yield Column("saving per year", money, "saving", sparse=True, formula=saving)
    yield Column(
        "carbon dioxide per year", "carbon dioxide", "emission", sparse=True,
        formula=where("emission", what_if.emission_formula(*of)),
    )  # fmt: skip
    if any(row.saving is not None for row in rows):
        extra, saved = "[extra_cost_of_the_belt]", "[saving_per_year]"
        formula = f'IF({extra}="","",IF({saved}>0,{extra}/{saved},"{NEVER}"))'
        yield Column("extra cost of the belt", money, "extra", shown, asked=True)
        yield Column("payback", "years", "payback", shown, formula=where("saving", formula))
    yield Column("energy drawn", "energy", _energy_getter("drawn_kwh"), None, sparse=True)
    yield Column("energy fed back", "energy", _energy_getter("fed_back_kwh"), None, sparse=True)


def _energy_getter(name: str) -> Callable[[RankedCompound], float | None]:
    """Getter of an energy of the year [J]."""
    return lambda row: None if row.year is None else _kwh_in_joules(getattr(row.year, name))


def what_if_table(comparison: CalculatedComparison) -> Table:
    """Hours, prices and emission factors, for the reader to change."""
    operation = comparison.conveyor.operation
    rows = () if operation is None else what_if.year_inputs(operation, operation.seconds_per_year, emission=True)
    return figure_table(
        "what_if", "Ranking", "What if: change the yellow cells, extra costs of the belts too", rows,
        note="Energy, cost, saving, carbon dioxide and payback follow; power does not.", prefix="what_if_",
    )  # fmt: skip


def cost_table(ranked: Table) -> Table:
    """Energy, cost and saving of a year; no rows where the ranking has none of them."""
    heading = "Energy, cost and saving of a year"
    columns = ranked.only("compound", "speed", *_COSTS).columns
    rows = ranked.rows if len(columns) > 2 else ()
    return Table("costs", "Ranking", heading, columns, rows, "ranking")


def _rank_compounds(comparison: CalculatedComparison, speed: float) -> list[RankedCompound]:
    common = comparison.common(speed)
    known: dict[str, dict[float, ComparedScene]] = {
        scene.compound: {} for scene in comparison.scenes if scene.speed == speed
    }
    for scene in comparison.covered:
        if scene.speed == speed:
            known[scene.compound][scene.temperature] = scene
    means = {name: [scenes[t] for t in common] if scenes else [] for name, scenes in known.items()}
    base = means.get(comparison.base, [])
    rows = [_ranking_row(comparison, (name, speed), known[name], means[name], base) for name in known]
    places = _mean_ranks(comparison, [means[row.compound] for row in rows if row.why is None])
    rows = [replace(row, rank=places.get(row.compound)) for row in rows]
    return sorted(rows, key=lambda row: (row.motor is None, row.why is not None, row.motor or 0.0))


def _ranking_row(
    comparison: CalculatedComparison,
    key: tuple[str, float],
    scenes: dict[float, ComparedScene],
    at: list[ComparedScene],
    base: list[ComparedScene],
) -> RankedCompound:
    name, speed = key
    why = _why_not_compared(comparison, name, at, base)
    operation = comparison.conveyor.operation
    year = None if why else _year_energies(comparison, name, speed, at)
    before = None if why else _year_energies(comparison, comparison.base, speed, base)
    peak = max(scenes.values(), key=lambda scene: scene.motor) if scenes else None
    return RankedCompound(
        compound=name,
        speed=speed,
        temperature=None if peak is None else peak.temperature,
        averaged=len(at),
        indentation=_mean_or_none([s.indentation for s in at]),
        motor=_mean_or_none([s.motor for s in at]),
        low=_mean_or_none([s.motor_low for s in at]),
        high=_mean_or_none([s.motor_high for s in at]),
        peak=None if peak is None else peak.motor,
        base=None if why else _mean_or_none([s.motor for s in base]),
        year=year,
        cost=_energy_cost(operation, year),
        before=_energy_cost(operation, before),
        emission=_year_emission(operation, year),
        extra=comparison.extra_costs.get(name),
        why=why,
    )


def _mean_ranks(comparison: CalculatedComparison, scenes: Sequence[list[ComparedScene]]) -> dict[str, int]:
    """Rank of each compound by the mean of its scenes; equal where they do not differ significantly."""
    places: dict[str, int] = {}
    for group in comparison.groups(map(RankedPower.of, scenes)):
        places |= dict.fromkeys((one.compound for one in group), len(places) + 1)
    return places


def _why_not_compared(
    comparison: CalculatedComparison, name: str, at: list[ComparedScene], base: list[ComparedScene]
) -> str | None:
    """Reason why a compound is not compared with the base; None if it is."""
    if not at:
        return "its data do not reach"
    if not base:
        return "the base's data do not reach"
    if comparison.test_basis_differs(name):
        return "one level tested, one not"
    return None


def _year_energies(
    comparison: CalculatedComparison, name: str, speed: float, at: list[ComparedScene]
) -> DutySums | None:
    """Energies of a year: from the duty at the spec's speed if there is one, else from all hours."""
    operation = comparison.conveyor.operation
    if comparison.conveyor.duty:
        study = comparison.years.get(name) if speed == comparison.conveyor.belt_speed else None
        return None if study is None else study.year
    net = [scene.energy_per_year for scene in at if scene.energy_per_year is not None]
    if operation is None or not net:
        return None
    drawn, fed_back = (math.fsum(max(sign * kwh, 0.0) for kwh in net) / len(net) for sign in (1.0, -1.0))
    return DutySums(operation.seconds_per_year, drawn, fed_back, 0.0)


def _energy_cost(operation: Operation | None, year: DutySums | None) -> float | None:
    """Cost of a year's energy [currency]; None without hours or price."""
    return None if operation is None or year is None else annual_cost(operation, year)


def _year_emission(operation: Operation | None, year: DutySums | None) -> float | None:
    """Carbon dioxide of a year [kg]; None without hours or factor."""
    if operation is None or year is None or operation.emission is None:
        return None
    saved = operation.feed_in_emission
    credit = 0.0 if saved is None else saved.amount
    return duty_emission(year, factor=operation.emission.amount, credit_factor=credit)


def _mean_or_none(values: list[float] | list[float | None]) -> float | None:
    """Mean; None if empty or if a value is not known."""
    known = [value for value in values if value is not None]
    return math.fsum(known) / len(known) if known and len(known) == len(values) else None


def coverage_table(comparison: CalculatedComparison) -> Table:
    """Excitation band of the rolls and data range of each compound at each temperature."""
    columns = (
        _COMPOUND,
        _TEMPERATURE,
        *(
            replace(column, page=_PAPER_VIEW if column.page is None else column.page)
            for column in band_columns("excited", "data")
        ),
        Column("covered", "verdict", lambda row: "yes" if row.covered else "NO"),
    )
    heading = "90 % loss band of the rolls against the data of the compounds"
    page = (PagePlacement("coverage", "Excitation band of the rolls, and range of the data"),)
    note = "NO: the excitation band reaches beyond the data."
    return Table("coverage", "Coverage", heading, columns, comparison.coverage, page, note)


def refused_scenes(comparison: CalculatedComparison) -> Table:
    """Scenes without a solution, with the reason."""
    columns = (
        _COMPOUND,
        _TEMPERATURE,
        _SPEED,
        Column("reason", "text", lambda row: degree_signs(row.reason)),
    )
    heading, rows = "Scenes without an answer", tuple(dict.fromkeys(comparison.refused))
    return Table("refused", "Coverage", heading, columns, rows, "refused")


def power_tables(comparison: CalculatedComparison, system: System) -> Iterator[Table]:
    """Motor power over temperature, one column per compound, one table per speed.

    Cells without a solution, or beyond the data, are empty: lines of charts break there.
    """
    for number, speed in enumerate(sorted({scene.speed for scene in comparison.scenes}), start=1):
        at = [scene for scene in comparison.covered if scene.speed == speed]
        names = [c.name for c in comparison.compounds if any(scene.compound == c.name for scene in at)]
        power = {(scene.compound, scene.temperature): scene.motor for scene in at}
        rows = tuple(sorted({scene.temperature for scene in at}))
        columns = (
            Column("temperature", "temperature", lambda t: t),
            *(Column(name, "power", _power_getter(name, power)) for name in names),
        )
        said = display_unit("speed", system).four_digits(speed)
        yield Table(f"power_{number}", "Power", f"Motor power over temperature at {said}", columns, rows, note=said)


def _power_getter(name: str, powers: dict[tuple[str, float], float]) -> Any:
    return lambda temperature: powers.get((name, temperature))


def compound_table(comparison: CalculatedComparison) -> Table:
    """Kind, origin and gaps of the data of each compound."""
    columns = (
        Column("compound", "text", "name"),
        Column("kind", "text", "kind"),
        Column("strain", "text", lambda compound: compound.strain or "not stated"),
        Column("origin", "text", lambda c: degree_signs(c.source.origin)),
        Column("licence", "text", "source.licence"),
        Column("unknown", "text", lambda c: degree_signs("; ".join(c.missing)) or "nothing listed"),
    )
    return Table("compounds", "Notes", "Compounds", columns, comparison.compounds)


def comparison_remarks(comparison: CalculatedComparison, system: System) -> Table:
    """Table of the notes of a comparison."""
    columns = (Column("remark", "text", "text"),)
    rows = tuple(Remark("warning", line) for line in comparison_notes(comparison, system))
    return Table("remarks", "Notes", "Remarks", columns, rows)


def comparison_drawings(comparison: CalculatedComparison, system: System) -> Iterator[Drawing]:
    """Drawings of the page."""
    if not comparison.scenes:
        return
    ranked = [row for row in ranking_table(comparison).rows if row.change is not None]
    if len(ranked) > 1:
        shown = [(_compound_label(row, comparison, system), row.change, row.band) for row in ranked]
        yield Drawing(
            "differences",
            f"Difference of the mean motor power to {comparison.base}, with the 90 % band where it is known.",
            lambda: plots.power_differences(shown, comparison.base),
            "ranking",
        )
    speeds, warmth = {scene.speed for scene in comparison.scenes}, plots.fixed_condition(comparison, "speed")
    if len({scene.temperature for scene in comparison.scenes}) > 1:
        at = display_unit("speed", system).four_digits(plots.fixed_condition(comparison, "temperature") or 0.0)
        yield Drawing(
            "power-temperature",
            f"Motor power over the belt's temperature at {at}, dotted beyond the data; shaded: bands.",
            lambda: plots.power_over(comparison, "temperature", system=system),
            "power",
        )
    if len(speeds) > 1 and warmth is not None:
        at = display_unit("temperature", system).four_digits(warmth)
        turning = " The ranking changes with temperature: see the notes." if ranking_changes(comparison) else ""
        yield Drawing(
            "power-speed",
            f"Motor power over belt speed at {at}, next to the spec's of those every compound has an answer for."
            f"{turning}",
            lambda: plots.power_over(comparison, "speed", system=system),
            "power",
        )
    yield Drawing(
        "tangents",
        "Loss tangents, dotted beyond the data; shaded: 90 % loss band of the rolls.",
        lambda: plots.compared_loss_tangents(comparison, system=system),
        "loss-tangents",
    )


def _compound_label(row: RankedCompound, comparison: CalculatedComparison, system: System) -> str:
    """Label of a ranked compound, with its speed if there are several."""
    several = len({scene.speed for scene in comparison.scenes}) > 1
    return f"{row.compound}, {display_unit('speed', system).four_digits(row.speed)}" if several else row.compound


def _untested_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on comparing compounds with rolling-resistance tests and without."""
    bare = [compound.name for compound in comparison.compounds if not compound.tests]
    if any(comparison.test_basis_differs(compound.name) for compound in comparison.compounds):
        told = ", ".join(f'"{name}"' for name in bare)
        yield (
            f"{told}: no rolling-resistance tests, which the others have: the indentation may be up to "
            f"{UNTESTED_FACTOR:g} "
            "times as much; no saving, price or rank beside tested compounds (compare by theory alone: "
            "calculation.anchor: off)"
        )


def _calibration_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on the calibration factor of the indentation, applied to all compounds."""
    given = comparison.conveyor.calculation.calibration
    factor = 1.0 if given is None else given.factors.get("indentation", 1.0)
    if factor != 1.0:
        yield (
            f"calculation.calibration: indentation x {factor:g} of every compound, a factor found with the belt that "
            "ran. What of it is that belt's rubber the others do not have: their power without it is that of conveyor "
            "power with their compound and calculation.calibration.indentation: 1"
        )


def _temperature_notes(comparison: CalculatedComparison, system: System) -> Iterator[str]:
    """Notes on the temperatures compared at each speed."""
    asked = {s.temperature for s in comparison.scenes} | {row.temperature for row in comparison.refused}
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        run = display_unit("speed", system).four_digits(speed)
        common, known = comparison.common(speed), {s.compound for s in comparison.covered if s.speed == speed}
        if comparison.base not in known or (len(known) < 2 < 1 + len(comparison.compounds)):
            yield f"at {run} nothing is compared: the data of the base, or of all others, do not reach"
        elif not common:
            yield f"at {run} nothing is compared: no temperature that the data of all compounds reach"
        elif len(common) < len(asked):
            at = _temperature_list(common, system)
            yield f"at {run} the comparison stands at {at}, which the data of all compounds in it reach"


def comparison_notes(comparison: CalculatedComparison, system: System = "SI") -> tuple[str, ...]:
    """Notes of a comparison in a system of units: conditions and assumptions."""
    lines = [
        *_temperature_notes(comparison, system),
        *_untested_notes(comparison),
        *_calibration_notes(comparison),
    ]
    for compound in comparison.compounds:
        if compound.kind == "illustrative":
            said = "is illustrative, not measured: compare with it, do not design with it"
            lines.append(f'compound "{compound.name}" {said}')
        rows = [row for row in comparison.coverage if row.compound == compound.name and not row.covered]
        if rows:
            at = _temperature_list([row.temperature for row in rows], system)
            lacking = "do not cover what the rolls excite" if compound.range else "state no range, it counts for none"
            lines.append(f'compound "{compound.name}": its data {lacking} at {at}: not averaged, ranked, priced')
        reasons = {row.reason: row for row in comparison.refused if row.compound == compound.name}
        lines.extend(f'compound "{compound.name}": no answer for some scenes: {reason}' for reason in reasons)
    lines += ranking_changes(comparison, system)
    price = comparison.conveyor.operation is not None and comparison.conveyor.operation.price is not None
    if not price:
        lines.append("operation.price not given: no cost, saving or payback")
    elif not comparison.conveyor.drive.knows_mains:
        lines.append("energy and cost are those of the motors' shafts: drive.train has no part on the mains' side")
    fed_back = any(scene.motor < 0.0 for scene in comparison.scenes) or any(
        study.year.fed_back_kwh > 0.0 for study in comparison.years.values()
    )
    if fed_back and lacks_feed_in_price(comparison.conveyor.operation):
        lines.append("operation.feed_in_price not given: energy that is fed back earns nothing")
    if comparison.conveyor.duty:
        lines.append("energy, cost and saving of a year are those of operation.duty, at the spec's own speed")
        lines += [
            f'compound "{compound.name}": a bar of operation.duty has no answer with it, or its data do not reach, '
            "so it has no year"
            for compound in comparison.compounds
            if compound.name not in comparison.years
        ]
    lines.append("means over temperatures give each the same weight; only indentation follows the temperature")
    return (*lines, *_band_notes(comparison))


def _band_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on the bands, which are narrower than the interval of `conveyor power`."""
    if any(scene.motor_low is not None for scene in comparison.scenes):
        yield (
            "90 % bands are of the rubber alone, its data and its tests; the interval of conveyor power has what is "
            "left to defaults, too. One rank: the difference is less than both may be off, without what belts tested "
            "alike have in common"
        )


def ranking_changes(comparison: CalculatedComparison, system: System = "SI") -> list[str]:
    """Notes on speeds whose ranking changes with temperature or has ties, with the order at each."""
    lines = []
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        shared: dict[float, list[ComparedScene]] = {t: [] for t in comparison.common(speed)}
        for scene in comparison.covered:
            if scene.speed != speed or comparison.test_basis_differs(scene.compound):
                continue
            if scene.temperature in shared:
                shared[scene.temperature].append(scene)
        grouped = {
            warmth: comparison.groups(RankedPower.of([scene]) for scene in row) for warmth, row in shared.items()
        }
        by_order: dict[tuple[frozenset[str], ...], list[float]] = {}
        for warmth, groups in grouped.items():
            by_order.setdefault(tuple(frozenset(one.compound for one in group) for group in groups), []).append(warmth)
        together = any(len(group) > 1 for groups in grouped.values() for group in groups)
        if len(by_order) > 1 or together:
            run = display_unit("speed", system).four_digits(speed)
            orders = (
                f"{_temperature_list(warm, system)}: {_order_text(grouped[warm[0]])}" for warm in by_order.values()
            )
            said = "the ranking changes with temperature" if len(by_order) > 1 else "the ranking at a temperature"
            lines.append(f"{said}; least motor power first, at {run}: {'; '.join(orders)}")
    return lines


def _order_text(groups: Sequence[Sequence[RankedPower]]) -> str:
    """Order of the compounds in words, ties named."""
    return ", then ".join(
        group[0].compound
        if len(group) == 1
        else f"{', '.join(one.compound for one in group[:-1])} and {group[-1].compound}, which cannot be told apart"
        for group in groups
    )


def _temperature_list(temperatures: Sequence[float], system: System) -> str:
    """List of temperatures [K] as text, the unit at the end."""
    shown = display_unit("temperature", system)
    return f"{', '.join(f'{value:.4g}' for value in shown(temperatures).tolist())} {degree_signs(shown.label or '')}"


def _compared_speeds(comparison: CalculatedComparison) -> list[tuple[float, list[float]]]:
    """Speeds, each with the temperatures that means are over [degC]."""
    speeds = sorted({scene.speed for scene in comparison.scenes})
    return [(speed, [to_celsius(t) for t in comparison.common(speed)]) for speed in speeds]


COMPARISON_KEYS: Final = JsonObject(
    lambda comparison: comparison,
    describe_value("conveyor compare SPEC --json"),
    keys={
        "schema_version": VERSION_KEY,
        "conveyor": text_key("conveyor.name"),
        "base": text_key("base", "compound of the savings"),
        "cover": text_key("cover"),
        "compared": JsonList(
            _compared_speeds,
            item=JsonObject(
                lambda pair: pair,
                describe_value("temperatures that means are over"),
                keys={"speed_m_per_s": number_key("0"), "temperatures_degC": number_list("1")},
            ),
        ),
        "ranking": table_rows(lambda comparison: ranking_table(comparison).records()),
        "scenes": table_rows(lambda comparison: scene_table(comparison).records()),
        "coverage": table_rows(lambda comparison: coverage_table(comparison).records()),
        "refused": table_rows(lambda comparison: refused_scenes(comparison).records()),
        "warnings": text_list(comparison_notes, "notes"),
    },
)
"""Keys of a comparison."""


def comparison_json(comparison: CalculatedComparison) -> dict[str, Any]:
    """Plain numbers for JSON; units in the keys."""
    made: dict[str, Any] = COMPARISON_KEYS.plain(comparison)
    return made


def comparison_notebook(comparison: CalculatedComparison) -> Html:
    """Ranking and notes for a notebook."""
    tables = [(comparison.conveyor.name, ranking_table(comparison))]
    return notebook_html(
        comparison.conveyor.report.units,
        tables,
        {"notes": comparison_notes(comparison, comparison.conveyor.report.units)},
    )
