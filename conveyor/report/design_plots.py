"""Figures of a study: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from conveyor.report.matplotlib_settings import own_settings
from conveyor.report.plots import add_legend, curve_colour, group_thousands, stacked_axes
from conveyor.report.point_tables import money_kind
from conveyor.units import System
from conveyor.units.presentation import Unit, display_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from conveyor.studies.evaluation import StudySummary, VariedField

_COLUMNS: Final = 2  # panels side by side
_MOST_DOTS: Final = 2000  # dots; of more designs every n-th, and the front
_MOST_LINES: Final = 300
_NUMBERED_CELLS: Final = 16  # a side of a heat map with numbers
_NUMBERED_DESIGNS: Final = 12  # designs of the front with their number
_LINE_LETTERS: Final = 16  # letters of a name on an axis before it is broken
_SHADES: Final = "viridis_r"
_LEVELS: Final = 20  # of them in a map
Array: TypeAlias = "np.ndarray[Any, Any]"


class DesignPlots:
    """Figures of a study's designs in a system of units.

    Parameters
    ----------
    study : StudySummary
        The designs; at least one has a solution.
    system : {"SI", "US"}
        Unit system of the figures.
    """

    def __init__(self, study: StudySummary, system: System) -> None:
        self.found, self.system = study, system
        figures = [study.figures[name] for name in study.objectives]
        self.labels = [figure.label for figure in figures]
        self.units: list[Unit] = [
            display_unit(money_kind(figure.kind, study.currency), system, large=True) for figure in figures
        ]

    def objectives(self, k: int) -> Any:
        """Values of the k-th objective, shape `(n,)`."""
        return self.units[k](self.found.found[:, k])

    def axis(self, k: int) -> str:
        """Axis title of the k-th objective."""
        return self.units[k].beside(self.labels[k])

    @own_settings()
    def effects(self) -> Figure:
        """Main effect of each field on the first objective: mean and range over all other fields.

        Error bars are two standard errors of the mean to both sides.
        """
        from matplotlib.figure import Figure

        order = self.found.ordered
        rows = math.ceil(len(order) / _COLUMNS)
        figure = Figure(figsize=(8.0, 2.8 * rows), layout="constrained")
        first: Axes | None = None
        for place, field in enumerate(order):
            axis = figure.add_subplot(rows, min(len(order), _COLUMNS), place + 1, sharey=first)
            first = first or axis
            effects = self.found.effects(field)
            at = [effect.at for effect in effects]
            low, middle, high = (
                self.units[0]([getattr(effect, name) for effect in effects]) for name in ("least", "mean", "most")
            )
            axis.fill_between(at, low, high, color=curve_colour(0), alpha=0.12, linewidth=0)
            axis.plot(at, middle, color=curve_colour(0), marker="o", markersize=4)
            bars = [(one.at, one.mean, 2.0 * one.error) for one in effects if one.error is not None]
            if bars:
                places, means, spread = zip(*bars, strict=True)
                mean, error = self.units[0](means), self.units[0](spread)
                axis.errorbar(places, mean, error, fmt="none", ecolor=curve_colour(0), capsize=3)
            axis.grid(visible=True, color="0.9")
            axis.spines[["top", "right"]].set_visible(False)
            group_thousands(axis.yaxis)
            _label_axis(axis.xaxis, self.found.fields[field])
            axis.margins(x=0.15 if self.found.fields[field].words else 0.05)
            if place % _COLUMNS == 0:
                axis.set_ylabel(self.axis(0), fontsize=9)
            axis.tick_params(labelsize=8, labelleft=place % _COLUMNS == 0)
        return figure

    @own_settings()
    def heat_map(self) -> Figure:
        """Best first objective at every pair of values of the two most influential fields."""
        from matplotlib import colormaps

        figures, shades = self.found, colormaps[_SHADES].resampled(_LEVELS)
        across, up = figures.ordered[:2]
        figure, (axis,) = stacked_axes(1, 4.4)
        x, y, shown = figures.values[:, across], figures.values[:, up], self.objectives(0)
        if max(len(np.unique(x)), len(np.unique(y))) <= _NUMBERED_CELLS:
            shaded = self._cells(axis, (x, y), shown, (figures.fields[across], figures.fields[up]))
            shaded.set_cmap(shades)
        else:
            shaded = axis.scatter(x, y, c=shown, cmap=shades, s=14)
            _label_axis(axis.xaxis, figures.fields[across])
            _label_axis(axis.yaxis, figures.fields[up])
        axis.grid(visible=False)
        beside = axis.inset_axes((1.02, 0.0, 0.03, 1.0))  # no axes of its own: those bind the figure's layout
        group_thousands(figure.colorbar(shaded, cax=beside, label=self.axis(0)).ax.yaxis)
        return figure

    def _number(self, k: int, value: float) -> str:
        """Value of the k-th objective as text."""
        return f"{value:{self.units[k].digits}}"

    def _cells(self, axis: Axes, at: tuple[Array, Array], shown: Array, fields: tuple[VariedField, VariedField]) -> Any:
        """Draw one cell per pair of values, with its number."""
        columns, rows = (np.unique(values) for values in at)
        least = next(iter(self.found.objectives.values())) == "least"
        best = np.ma.array(np.zeros((len(rows), len(columns))), mask=True)
        kept = np.zeros(best.shape, dtype=bool)
        for i, j in np.ndindex(best.shape):
            here = (at[0] == columns[j]) & (at[1] == rows[i])
            kept[i, j] = (here & self.found.keeps).any()
            values = shown[here & self.found.keeps] if kept[i, j] else shown[here]
            if values.size:
                best[i, j] = values.min() if least else values.max()
        shaded = axis.pcolormesh(range(len(columns) + 1), range(len(rows) + 1), best)
        middle = (best.min() + best.max()) / 2.0
        for i, j in zip(*np.nonzero(~np.ma.getmaskarray(best)), strict=True):
            ink = "white" if best[i, j] > middle else "black"
            number = self._number(0, float(best[i, j]))
            words = number if kept[i, j] else f"({number})"
            axis.text(j + 0.5, i + 0.5, words, ha="center", va="center", fontsize=8, color=ink)
        for scale, field, values in ((axis.xaxis, fields[0], columns), (axis.yaxis, fields[1], rows)):
            scale.set_ticks(np.arange(len(values)) + 0.5, [_value_label(field, value) for value in values])
            scale.set_label_text(_field_heading(field))
        return shaded

    @own_settings()
    def front(self) -> Figure:
        """First two objectives of every design, and the Pareto front."""
        figures = self.found
        figure, (axis,) = stacked_axes(1, 4.4)
        x, y = self.objectives(1), self.objectives(0)
        some = _spread_indices(len(x), _MOST_DOTS)
        for keeps, ink, label in ((True, curve_colour(0), "keeps the limits"), (False, "0.7", "breaks a limit")):
            rows = some[figures.keeps[some] == keeps]
            axis.plot(x[rows], y[rows], ".", color=ink, markersize=5, label=label)
        on = np.flatnonzero(figures.front)
        on = on[np.argsort(x[on], kind="stable")]
        axis.plot(x[on], y[on], "-o", color=curve_colour(1), markersize=5, linewidth=1.0, label="beaten by none")
        for row in on[:_NUMBERED_DESIGNS]:
            number = f"{figures.numbers[row]}"
            axis.annotate(number, (x[row], y[row]), textcoords="offset points", xytext=(5, 4), fontsize=8)
        axis.set(xlabel=self.axis(1), ylabel=self.axis(0))
        group_thousands(axis.xaxis)
        group_thousands(axis.yaxis)
        add_legend(axis)
        return figure

    @own_settings()
    def parallel(self) -> Figure:
        """Parallel coordinates: one line per design over fields and objectives, shaded by the first objective."""
        from matplotlib import colormaps

        figures = self.found
        figure, (axis,) = stacked_axes(1, 4.6)
        heads = [_field_heading(field) for field in figures.fields] + [self.axis(k) for k in range(len(self.units))]
        columns = [*figures.values.T, *(self.objectives(k) for k in range(len(self.units)))]
        ends = [(float(column.min()), float(column.max())) for column in columns]
        level = [(column - low) / ((high - low) or 1.0) for column, (low, high) in zip(columns, ends, strict=True)]
        order = np.argsort(figures.costs[:, 0], kind="stable")[::-1]
        share = np.linspace(0.0, 1.0, len(order))
        for k in _spread_indices(len(order), _MOST_LINES):
            row = order[k]
            shade = colormaps[_SHADES](1.0 - share[k]) if figures.keeps[row] else "0.85"
            axis.plot([one[row] for one in level], color=shade, linewidth=0.8, alpha=0.7)
        axis.set_xticks(range(len(heads)), [_wrap_label(head) for head in heads], fontsize=8, parse_math=False)
        axis.set_yticks([])
        for k, (low, high) in enumerate(ends):
            axis.axvline(k, color="0.3", linewidth=0.8)
            field = figures.fields[k] if k < len(figures.fields) else None
            named = range(len(field.words)) if field is not None and field.words else (low, high)
            for value in named:
                words = self._number(k - len(figures.fields), value) if field is None else _value_label(field, value)
                place = (value - low) / ((high - low) or 1.0)
                axis.annotate(
                    words, (k, place), textcoords="offset points", xytext=(4, 2), fontsize=8, parse_math=False
                )
        axis.set_xlim(-0.1, len(heads) - 0.6)
        axis.set_ylim(-0.03, 1.07)
        axis.grid(visible=False)
        return figure

    @property
    def every(self) -> dict[str, Callable[[], Figure]]:
        """Plots of the study by name."""
        made: dict[str, Callable[[], Figure]] = {"effects": self.effects}
        if len(self.found.fields) > 1:
            made["map"] = self.heat_map
        if len(self.units) > 1:
            made["front"] = self.front
        made["lines"] = self.parallel
        return made


def _spread_indices(count: int, most: int) -> Array:
    """Indices spread evenly, the last always among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))


def _field_heading(field: VariedField) -> str:
    return f"{field.label} [{field.unit}]" if field.unit else field.label


def _value_label(field: VariedField, value: float) -> str:
    return _wrap_label(field.words[int(value)]) if field.words else f"{value:,.5g}"


def _wrap_label(words: str) -> str:
    """Break long text into lines."""
    lines = [""]
    for part in re.split(r"(?<=[-. ])", words):
        if lines[-1] and len(lines[-1]) + len(part) > _LINE_LETTERS:
            lines.append("")
        lines[-1] += part
    return "\n".join(lines)


def _label_axis(axis: Axis, field: VariedField) -> None:
    """Label the axis of a field, with its words if it has no numbers."""
    axis.set_label_text(_field_heading(field), fontsize=9, parse_math=False)
    if field.words:
        axis.set_ticks(range(len(field.words)), [_wrap_label(word) for word in field.words], fontsize=8)
