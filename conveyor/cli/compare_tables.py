"""What `conveyor compare` shows: the ranking, and what to know of it."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from conveyor.cli import notes
from conveyor.cli.terminal import console, table, words
from conveyor.figures import ZERO_CELSIUS
from conveyor.report import comparing
from conveyor.report.axes import scale
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison

Row = Mapping[Hashable, Any]


def show(found: Comparison, system: System) -> None:
    """Print the ranking and its remarks."""
    frame = found.ranking
    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    made = table(f"{found.conveyor.name}: {found.cover} cover, against {found.base}")
    columns = _columns(rows, several_speeds=frame["belt speed [m/s]"].nunique() > 1, system=system)
    for heading in columns:
        made.add_column(words(heading), justify="left" if heading == "compound" else "right", no_wrap=True)
    for row in rows:
        made.add_row(*(words(shown(row)) for shown in columns.values()))
    screen = console()
    screen.print(made)
    notes.show(screen, comparing.remarks(found))


def _columns(rows: Sequence[Row], *, several_speeds: bool, system: System) -> dict[str, Callable[[Row], str]]:
    """Headings and what stands under them, of what the ranking knows."""
    power, speed, warmth = (scale(kind, system) for kind in ("power", "speed", "temperature"))

    def watts(value: float | None) -> str:
        return "" if value is None else _number(float(power(1e3 * value)))

    def band(row: Row) -> str:
        low, high = row["mean motor power, low [kW]"], row["mean motor power, high [kW]"]
        return "" if low is None or high is None else f"{watts(low)}-{watts(high)}"

    saving = next((str(name) for name in rows[0] if str(name).startswith("saving")), None)
    columns: dict[str, Callable[[Row], str]] = {"compound": lambda row: str(row["compound"])}
    if several_speeds:
        columns[speed.unit] = lambda row: f"{float(speed(row['belt speed [m/s]'])):.4g}"
    columns[f"mean\n[{power.unit}]"] = lambda row: watts(row["mean motor power [kW]"])
    if any(row.get("mean motor power, low [kW]") is not None for row in rows):
        columns[f"90 % band\n[{power.unit}]"] = band
    columns["change"] = lambda row: _change(row["motor power against base [-]"])
    columns[f"peak\n[{power.unit}]"] = lambda row: watts(row["peak motor power [kW]"])
    columns[f"at\n[{warmth.unit}]"] = lambda row: (
        f"{float(warmth(row['at temperature [degC]'] + ZERO_CELSIUS)):g}"
    )
    if saving is not None:
        columns[saving.replace("saving per year", "saved/a\n")] = lambda row: _number(row[saving])
    if any(row.get("payback [a]") is not None for row in rows):
        columns["payback\n[a]"] = lambda row: _number(row["payback [a]"])
    return columns


def _change(share: float | None) -> str:
    return "" if share is None else f"{share:+.1%}"


def _number(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:,.0f}" if abs(value) >= 100.0 else f"{value:.1f}"
