"""Figures of a sizing: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.report.plots import colour, grouped, keyed, stacked, titled
from conveyor.sizing.sized import SizedDesign
from conveyor.sizing.spacing import section_spacings
from conveyor.units import System
from conveyor.units.presentation import MONEY, unit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.sizing.around import VariedChoice
    from conveyor.sizing.designs import CalculatedSizing

_HEIGHT, _TALL = 3.0, 2.7
_OVER_SERIES = 1.5  # of the widest distance in the series: limits far above it say no more


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


def spacing(sizing: CalculatedSizing, *, system: System = "SI") -> Figure:
    """Distances of the sets of the best design along its profile, beside the widest that sag and bearings allow."""
    figure, (profile, axis) = stacked(2, _HEIGHT + _TALL)
    large, apart = unit("length", system, large=True), unit("spacing", system)
    ends = np.vstack([(0.0, 0.0), np.cumsum(sizing.task.sections, axis=0)])
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
                apart(np.array(values)), along, baseline=None, color=colour(k), linestyle=style, linewidth=wide,
                label=label,
            )  # fmt: skip
    most = max(*sizing.task.spacings[0], *sizing.task.spacings[1])
    axis.set(
        xlabel=large.beside("along the belt from the tail"), ylabel=apart.beside("distance of sets"),
        ylim=(0.0, float(apart(_OVER_SERIES * most))),
    )  # fmt: skip
    for each in (profile, axis):
        grouped(each.xaxis)
    keyed(axis)
    titled(figure, f"{sizing.duty.name}: idler sets along the profile")
    return figure
