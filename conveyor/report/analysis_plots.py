"""Figures of one analysis and of its studies: matplotlib figures returned, never shown or saved."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from conveyor.contact import solve
from conveyor.errors import InputError
from conveyor.indentation import to_problem
from conveyor.line import RollResult, StretchResult, excited_band
from conveyor.report.comparing import celsius
from conveyor.report.plots import colour, master_curve, stacked

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.balance import Balance, Classical
    from conveyor.cases import CaseResult, CaseStudy
    from conveyor.models import RubberCompound
    from conveyor.stretches import Strand
    from conveyor.uncertainty import UncertaintyStudy

_PARTS = ("indentation", "idler_rotation", "flexure")
_SUMS = ("main", "secondary", "special", "lift", "total")
_BAR = 0.8  # of the distance of two rows
_HATCH = ("", "////", "\\\\\\\\")
_BAND, _BAND_LINES = (0.5, 0.5, 0.5, 0.15), (0.3, 0.3, 0.3, 0.45)
_POINTS = 300
_BESIDE = 1.25  # half widths drawn on either side of a contact
_PRESSURE_RTOL = 1e-6  # of friction; the pressure is then good to about 1 % at the edges
_TORNADO = 12  # inputs drawn, those that matter most


def resistance_breakdown(found: Balance) -> Figure:
    """Every kind of resistance [kN], the classical estimates beside their sums; numbers at the bars."""
    figure, (axis,) = stacked(1, 4.4)
    estimates: list[tuple[str, Classical]] = [
        (f"classical, f = {found.classical.friction_factor:g}", found.classical)
    ]
    if found.cema is not None:
        estimates.append(("CEMA classic, given Ky", found.cema))
    names = [*_PARTS, *_SUMS]
    width = _BAR / (1 + len(estimates))
    forces = [1e-3 * getattr(found.forces, name) for name in names]
    columns = [("this calculation", list(range(len(names))), forces)]
    sums = list(range(len(_PARTS), len(names)))
    columns += [(label, sums, [1e-3 * getattr(made, name) for name in _SUMS]) for label, made in estimates]
    for k, (label, rows, values) in enumerate(columns):
        at = [row + (width * k if row in sums else 0.0) for row in rows]
        bars = axis.barh(
            at,
            values,
            height=width,
            label=label,
            color=colour(0) if k == 0 else "white",
            edgecolor=colour(k),
            hatch=_HATCH[k],
        )
        axis.bar_label(bars, fmt="{:,.1f}", padding=3, fontsize=9)
    middle = 0.5 * width * len(estimates)
    axis.set_yticks(
        [row + (middle if row in sums else 0.0) for row in range(len(names))],
        [_worded(name) for name in names],
    )
    axis.axhline(len(_PARTS) - 0.5, color="0.75", linewidth=0.8)
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.invert_yaxis()
    axis.margins(x=0.12)
    axis.grid(visible=False, axis="y")
    axis.set(xlabel="force [kN]", title="Resistances")
    axis.legend(fontsize=8)
    return figure


def _worded(name: str) -> str:
    words = {"total": "effective tension", "main": "main resistance"}
    return words.get(name, name.replace("_", " "))


def governing_roll(results: tuple[StretchResult, ...], strand: Strand) -> tuple[StretchResult, RollResult]:
    """Roll of the highest line load on a strand, and where it is."""
    found = [(r, roll) for r in results if r.stretch.strand == strand for roll in r.rolls]
    return max(found, key=lambda pair: pair[1].load.peak_line_load)


def pressure_under_rolls(results: tuple[StretchResult, ...]) -> Figure:
    """Contact pressure [MPa] under the highest line load of each strand, over the distance from the roll's axis [mm].

    Positive distances are on the side the belt comes from. The load is that of the contact at the inner end of a wing,
    or along a middle roll.

    Raises
    ------
    NoSolutionError
        A contact that was interpolated between others has no answer of its own.
    """
    figure, (axis,) = stacked(1, 3.6)
    strands: tuple[Strand, ...] = ("carry", "return")
    for k, strand in enumerate(strands):
        _, roll = governing_roll(results, strand)
        contact, load = roll.curve.contact, roll.load.peak_line_load
        problem = to_problem(contact, load)
        solution = solve(problem, _PRESSURE_RTOL)
        pascal = load / (contact.spacing * problem.pressure)
        reach = _BESIDE * solution.half_width
        x = np.linspace(solution.eccentricity - reach, solution.eccentricity + reach, _POINTS)
        edges = solution.patches.ravel()  # the curve meets zero at the edges, whatever the grid
        x = np.sort(np.concatenate([x, edges]))
        axis.plot(
            1e3 * contact.radius * x,
            1e-6 * pascal * solution.pressure(x),
            color=colour(k),
            label=f"{strand}: {load:,.0f} N/m, roll {2e3 * contact.radius:.0f} mm, "
            f"cover {1e3 * contact.cover_thickness:g} mm",
        )
    axis.axvline(0.0, color="0.75", linewidth=0.8, zorder=0)
    axis.set(
        xlabel="distance from the roll's axis, positive where the belt arrives [mm]",
        ylabel="pressure [MPa]",
        title="Pressure under the rolls of the highest line load",
    )
    axis.margins(y=0.4)  # room for the legend above the curves
    axis.set_ylim(bottom=0.0)
    axis.legend(fontsize=8)
    return figure


def rubber_at_work(
    compound: RubberCompound,
    temperature: float,
    results: tuple[StretchResult, ...],
    strands: tuple[Strand, ...],
) -> Figure:
    """Master curve of a compound at a temperature [K], with the band each strand's rolls excite [Hz] shaded."""
    figure = master_curve(compound, temperature)
    for k, strand in enumerate(strands):
        band = excited_band(results, strand)
        if band is None:
            continue
        for axis in figure.axes:
            axis.axvspan(
                *band,
                facecolor=_BAND,
                hatch=_HATCH[k + 1][:2],
                edgecolor=_BAND_LINES,
                linewidth=0,
                label=f"{strand} rolls: nine tenths of their loss",
            )
    below = figure.axes[-1]
    below.legend(fontsize=8)
    return figure


def case_power_against_temperature(study: CaseStudy, speed: float | None = None) -> Figure:
    """Motor power [kW] of every load case over temperature at one speed [m/s], the conveyor's highest without.

    Raises
    ------
    InputError
        No case was answered, or none at that speed.
    """
    chosen, found = _at(study, "speed", speed, "m/s")
    figure = _power_lines(study, found, "temperature")
    figure.axes[0].set(xlabel="belt temperature [°C]", title=f"{study.conveyor.name}, {chosen:g} m/s")
    return figure


def case_power_against_speed(study: CaseStudy, temperature: float | None = None) -> Figure:
    """Motor power [kW] of every load case over belt speed at one temperature [K], the one of most speeds without.

    Raises
    ------
    InputError
        No case was answered, or none at that temperature.
    """
    chosen, found = _at(study, "temperature", temperature, "K")
    figure = _power_lines(study, found, "speed")
    figure.axes[0].set(xlabel="belt speed [m/s]", title=f"{study.conveyor.name}, {celsius(chosen):g} °C")
    return figure


def _at(study: CaseStudy, name: str, value: float | None, unit: str) -> tuple[float, list[CaseResult]]:
    values = [getattr(result, name) for result in study.results]
    if not values:
        raise InputError("no load case has an answer: nothing to draw")
    chosen = max(sorted(set(values)), key=values.count) if value is None else value
    found = [result for result in study.results if getattr(result, name) == chosen]
    if not found:
        listed = ", ".join(f"{known:g}" for known in sorted(set(values)))
        raise InputError(f"{name} = {chosen!r} {unit}: no load case has it, there are {listed}")
    return chosen, found


def _power_lines(study: CaseStudy, found: list[CaseResult], over: str) -> Figure:
    figure, (axis,) = stacked(1, 3.8)
    for k, case in enumerate(dict.fromkeys(result.case for result in found)):
        rows = sorted((r for r in found if r.case == case), key=lambda r: float(getattr(r, over)))
        at = [celsius(r.temperature) if over == "temperature" else r.speed for r in rows]
        axis.plot(at, [r.motor / 1e3 for r in rows], color=colour(k), marker="o", markersize=4, label=case)
        low, high = ([getattr(r, f"motor_{end}") / 1e3 for r in rows] for end in ("low", "high"))
        axis.fill_between(at, low, high, color=colour(k), alpha=0.12, linewidth=0)
    low_end, high_end = study.friction_band
    axis.set_ylabel("motor power [kW]")
    axis.annotate(
        f"shaded: friction {low_end:g} to {high_end:g} of the computed one",
        (0.0, 1.02),
        xycoords="axes fraction",
        fontsize=9,
        color="0.3",
    )
    axis.legend(fontsize=8)
    return figure


def tornado(study: UncertaintyStudy) -> Figure:
    """Change of the motor power [kW] at both ends of every input's range, the one that matters most on top."""
    effects = study.effects[:_TORNADO]
    figure, (axis,) = stacked(1, 1.2 + 0.32 * len(effects))
    rows = range(len(effects))
    for label, k, ends in (
        ("at the low end", 0, [effect.motor_low for effect in effects]),
        ("at the high end", 1, [effect.motor_high for effect in effects]),
    ):
        axis.barh(
            rows,
            [(end - study.motor) / 1e3 for end in ends],
            label=label,
            color=colour(0) if k == 0 else "white",
            edgecolor=colour(k),
            hatch=_HATCH[k],
            height=0.6,
        )
    axis.set_yticks(list(rows), [effect.name for effect in effects])
    axis.axvline(0.0, color="0.3", linewidth=0.8)
    axis.invert_yaxis()
    axis.grid(visible=False, axis="y")
    axis.set(xlabel="change of the motor power [kW]", title=study.conveyor.name)
    axis.legend(fontsize=8)
    return figure
