"""Figures of a sizing: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.report.plots import colour, grouped, keyed, stacked, titled
from conveyor.sizing.designs import SizedDesign
from conveyor.units import System
from conveyor.units.presentation import MONEY, unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.sizing.around import VariedChoice
    from conveyor.sizing.designs import CalculatedSizing

_HEIGHT, _TALL = 3.0, 2.7


def idlers(design: SizedDesign) -> float:
    """Cost of rolls and frames of a year [currency/a]."""
    return float(design.costs.yearly["rolls"] + design.costs.yearly["idler frames"])


def shares(sizing: CalculatedSizing, *, system: System = "SI") -> Figure:
    """What a year costs by part, a bar a design."""
    money = unit(f"{MONEY}{sizing.duty.prices.currency}", system, large=True)
    figure, (axis,) = stacked(1, _HEIGHT + 0.22 * len(sizing.designs))
    ranks = np.arange(1, len(sizing.designs) + 1)
    start = np.zeros(len(ranks))
    for k, name in enumerate(sizing.best.costs.yearly):
        cost = money(np.array([max(0.0, float(design.costs.yearly[name])) for design in sizing.designs]))
        axis.barh(ranks, cost, left=start, color=colour(k), label=name)
        start = start + cost
    axis.set(yticks=ranks, ylabel="rank", xlabel=money.beside("cost of a year"))
    axis.invert_yaxis()
    grouped(axis.xaxis)
    keyed(axis)
    titled(figure, sizing.duty.name)
    return figure


def sweeps(sizing: CalculatedSizing, varied: tuple[VariedChoice, ...], *, system: System = "SI") -> Figure:
    """Energy against idlers, belt and the rest, one choice varied around the best design."""
    money = unit(f"{MONEY}{sizing.duty.prices.currency}", system, large=True)
    figure, axes = stacked(len(varied), _TALL * len(varied))
    for axis, sweep in zip(axes, varied, strict=True):
        kind = unit(sweep.kind, system)
        points = [
            (x, one)
            for x, one in zip(sweep.values, sweep.designs, strict=True)
            if isinstance(one, SizedDesign)
        ]
        at = kind(np.array([x for x, _ in points]))
        parts = {
            "energy": [float(one.costs.yearly["energy"]) for _, one in points],
            "idlers": [idlers(one) for _, one in points],
            "belt": [float(one.costs.yearly["belt"]) for _, one in points],
        }
        whole = np.array([one.year for _, one in points])
        parts["the rest"] = list(whole - np.sum(list(parts.values()), axis=0))
        for k, (name, cost) in enumerate(parts.items()):
            axis.plot(at, money(np.array(cost)), color=colour(k), marker="o", markersize=3, label=name)
        axis.plot(at, money(whole), color="black", marker="o", linewidth=2.0, markersize=4, label="whole")
        axis.axvline(float(kind(sweep.at)), color="0.6", linestyle="--", linewidth=1.0)
        axis.set(xlabel=kind.beside(sweep.name), ylabel=money.beside("a year"), ylim=(0.0, None))
        grouped(axis.yaxis)
    keyed(axes[-1])
    titled(figure, f"{sizing.duty.name}: around the best design")
    return figure
