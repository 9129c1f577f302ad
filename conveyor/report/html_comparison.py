"""The parts of the HTML report of a comparison of compounds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pandas as pd

from conveyor.markup import Html, element, joined
from conveyor.report import comparing, plots
from conveyor.report.html_sections import bands, drawn
from conveyor.report.page import Part, bullets, facts, table
from conveyor.units import System, display

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison

_RANKED: Final = (
    "compound", "belt speed [m/s]", "mean motor power [kW]", "mean motor power, low [kW]",
    "mean motor power, high [kW]", "motor power against base [-]", "peak motor power [kW]",
    "at temperature [degC]",
)  # fmt: skip
_COSTS: Final = ("energy per year", "cost per year", "saving per year", "extra cost", "payback")


def top_of(comparison: Comparison, system: System) -> Html:
    """What was compared at what."""
    temperatures = sorted({scene.temperature for scene in comparison.scenes})
    speeds = sorted({scene.speed for scene in comparison.scenes})
    return facts(
        (
            ("compounds", ", ".join(compound.name for compound in comparison.compounds)),
            ("savings against", comparison.base),
            ("cover", comparison.cover),
            ("belt temperatures", _span(temperatures, "temperature", system)),
            ("belt speeds", _span(speeds, "speed", system)),
        )
    )


def _span(values: list[float], kind: str, system: System) -> str:
    ends = list(dict.fromkeys(display(value, kind, system) for value in (values[:1] + values[-1:])))
    return " to ".join(ends).replace("deg", "°") or "none answered"


def parts_of(comparison: Comparison, system: System) -> list[Part]:
    """Ranking, power over temperature and speed, coverage of the data, every scene, what to know."""
    parts = [Part("warnings", "What to know", bullets(comparing.remarks(comparison), "warnings"))]
    if comparison.scenes:
        parts = [
            _ranking(comparison, system),
            *parts,
            *_power(comparison, system),
            _scenes(comparison, system),
        ]
    parts.insert(-1, _coverage(comparison, system))
    refused = comparing.refused(comparison)
    if not refused.empty:
        parts.append(
            Part("refused", "Without an answer", table(refused, "Scenes without an answer", system=system))
        )
    return parts


def _ranking(comparison: Comparison, system: System) -> Part:
    frame = comparison.ranking
    ranked = frame[[name for name in _RANKED if name in frame.columns]]
    content = [table(ranked, "The least mean power first", system=system)]
    costs = [str(name) for name in frame.columns if str(name).startswith(_COSTS)]
    if costs:
        money = frame[["compound", "belt speed [m/s]", *costs]]
        content.append(table(money, "Energy, cost and saving of a year", system=system))
    return Part("ranking", "Ranking", joined(content))


def _power(comparison: Comparison, system: System) -> list[Part]:
    content = []
    if len({scene.temperature for scene in comparison.scenes}) > 1:
        made = plots.power_against_temperature(comparison, system=system)
        at = display(plots.drawn_speed(comparison), "speed", system)
        caption = f"Motor power over the belt's temperature at {at}; shaded: replicas of measured rubber."
        content.append(drawn(made, "power-temperature", caption))
    warmth = plots.drawn_temperature(comparison)
    if len({scene.speed for scene in comparison.scenes}) > 1 and warmth is not None:
        made = plots.power_against_speed(comparison, system=system)
        at = display(warmth, "temperature", system).replace("deg", "°")
        caption = f"Motor power over belt speed at {at}, next to the spec's of those every compound has an answer for."
        turned = comparing.turned(comparison)
        if turned:
            caption += " The ranking turns with the temperature: see what to know."
        content.append(drawn(made, "power-speed", caption))
    tangents = drawn(
        plots.compared_loss_tangents(comparison, system=system),
        "tangents",
        "Loss tangents, dotted beyond the data; shaded: what the rolls excite.",
    )
    power = [Part("power", "Power", joined(content))] if content else []
    return [*power, Part("loss-tangents", "Loss tangents", tangents)]


def _scenes(comparison: Comparison, system: System) -> Part:
    frame = comparison.table
    kept = frame.drop(columns=[name for name in frame.columns if "per year" in str(name)])
    return Part(
        "scenes", "Every scene", table(kept, "One row a compound, speed and temperature", system=system)
    )


def _coverage(comparison: Comparison, system: System) -> Part:
    found = comparing.coverage(comparison)
    frame = pd.concat(
        [found[["compound", "temperature [degC]"]], bands(found), found[["covered"]]], axis="columns"
    )
    note = element(
        "p", "NO in the last column: the rolls ask for frequencies beyond the data.", class_="note"
    )
    content = joined([table(frame, "What the rolls excite, and what the data hold", system=system), note])
    return Part("coverage", "Coverage of the data", content)
