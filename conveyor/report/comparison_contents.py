"""What the report of a comparison holds: its tables under names that others link to; no spreadsheet in sight."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

import pandas as pd

from conveyor.report import comparing
from conveyor.report.contents import Contents, Part, gathered, provenance
from conveyor.spec import fingerprint
from conveyor.units import System, display

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison

SPEED: Final = "belt speed [m/s]"
_COSTS: Final = ("energy per year", "cost per year", "saving per year", "extra cost", "payback")
TEMPERATURE: Final = "temperature [degC]"


def of_comparison(comparison: Comparison, system: System) -> Contents:
    """Every table of a comparison in a unit system."""
    return gathered(_parts(comparison, system), system)


def _parts(comparison: Comparison, system: System) -> Iterator[Part]:
    ranked = comparison.ranking
    money = [name for name in ranked.columns if str(name).startswith(_COSTS)]
    heading = "Ranking, the least mean power of each speed first"
    yield Part("Ranking", "ranking", heading, ranked.drop(columns=money))
    if money:
        costs = ranked[["compound", SPEED, *money]]
        yield Part("Ranking", "costs", "Energy, cost and saving of a year", costs)
    for number, (speed, block) in enumerate(blocks(comparison).items(), start=1):
        heading = f"Motor power over temperature at {display(speed, 'speed', system)}"
        yield Part("Power", f"power_{number}", heading, block)
    yield Part("Scenes", "scenes", "Every scene that has an answer", comparison.table)
    heading = "Frequencies that hold nine tenths of the loss, against the compounds' data"
    yield Part("Coverage", "coverage", heading, comparing.coverage(comparison))
    refused = comparing.refused(comparison).drop_duplicates()
    yield Part("Coverage", "refused", "Scenes without an answer", refused)
    remarks = pd.DataFrame({"remark": list(comparing.remarks(comparison))})
    yield Part("Notes", "remarks", "Remarks", remarks)
    yield Part("Notes", "compounds", "Compounds", compounds(comparison))
    yield Part("Notes", "provenance", "Provenance", provenance(fingerprint(comparison.conveyor)))


def blocks(comparison: Comparison) -> dict[float, pd.DataFrame]:
    """Motor power over temperature, one column a compound, at each speed [m/s] in rising order.

    Only temperatures that every compound has an answer for: a gap in one column would break its line.
    """
    frame = comparison.table
    if frame.empty:
        return {}
    found = {}
    for speed in sorted(frame[SPEED].unique()):
        block = frame[frame[SPEED] == speed].pivot_table(
            index=TEMPERATURE, columns="compound", values="motor power [kW]", sort=False
        )
        names = [compound.name for compound in comparison.compounds if compound.name in block.columns]
        block = block.sort_index()[names].dropna()
        found[float(speed)] = block.rename(columns={name: f"{name} [kW]" for name in names}).reset_index()
    return found


def compounds(comparison: Comparison) -> pd.DataFrame:
    """What is known of each compound."""
    return pd.DataFrame(
        [
            {
                "compound": compound.name,
                "kind": compound.kind,
                "strain": compound.strain or "not stated",
                "origin": compound.source.origin,
                "licence": compound.source.licence,
                "not known": "; ".join(compound.missing) or "nothing listed",
            }
            for compound in comparison.compounds
        ]
    )
