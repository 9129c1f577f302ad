"""Figures of an analysis and of its studies: what is drawn is what was computed."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.patches import Rectangle

import conveyor
from conveyor.errors import InputError
from conveyor.line.line import Line
from conveyor.models import LoadCase
from conveyor.report import analysis_plots as plots
from conveyor.report.analysis_plots import route_profile
from conveyor.report.plots import master_curve, stacked_axes
from conveyor.report.svg import figure_svg, restyle_figure
from conveyor.results.analysis import study_ranges as uncertain
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
PRESSURE = 2e-2
"""Of the peak and of the load: what a spectrum solved to 1e-6 in friction is known to at the edges, and trapezia."""


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "in_plant_us.yaml")


@pytest.fixture(scope="module")
def result(line):
    return conveyor.analyse(line)


@pytest.fixture(scope="module")
def cases(line):
    return conveyor.analyse_cases(
        line,
        [
            LoadCase.from_data({"name": "full", "loading": "full", "temperatures": ["10 degC", "30 degC"]}),
            LoadCase.from_data({"name": "empty", "loading": "empty", "temperatures": ["10 degC", "30 degC"]}),
            LoadCase.from_data(
                {"name": "half", "loading": "part load", "share": "50 %", "speeds": ["500 fpm", "600 fpm"]}
            ),
        ],
    )


def bars(axis, label):
    container = next(c for c in axis.containers if c.get_label() == label)
    return [patch.get_width() for patch in container]


def test_bars_are_the_forces(result):
    (axis,) = plots.resistance_breakdown(result.balance).axes
    forces, classical = result.balance.forces, result.balance.classical
    names = ("main", "secondary", "special", "lift", "total")
    parts = [forces.parts[name] for name in ("indentation", "idler_rotation", "flexure", "misalignment")]
    drawn = bars(axis, "this calculation")
    assert drawn == pytest.approx([newtons / 1e3 for newtons in (*parts, *(getattr(forces, name) for name in names))])
    assert sum(drawn[:4]) == pytest.approx(drawn[4])
    assert sum(drawn[4:8]) == pytest.approx(drawn[8])
    assert bars(axis, f"ISO 5048 / DIN 22101, f = {classical.friction_factor:g}") == pytest.approx(
        [getattr(classical, name) / 1e3 for name in names]
    )
    assert axis.get_xlabel() == "force [kN]"
    hatches = {c[0].get_hatch() for c in axis.containers if hasattr(c[0], "get_hatch")}
    assert len(hatches) == len([c for c in axis.containers if hasattr(c[0], "get_hatch")])


def test_breakdown_with_cema_has_a_third_bar(line):
    factors = {"flexure_factor": 0.03, "idler_friction": "1.8 lbf"}
    found = conveyor.analyse(line.replace(calculation=line.calculation.replace(cema=factors))).balance
    (axis,) = plots.resistance_breakdown(found).axes
    assert found.cema is not None
    assert bars(axis, "CEMA classic, given Ky")[-1] == pytest.approx(found.cema.total / 1e3)
    assert len(bars(axis, "CEMA classic, given Ky")) == 5
    for on_paper in (None, False, True):  # as a file, on a page, in a PDF
        (axis,) = plots.resistance_breakdown(found).axes
        if on_paper is not None:
            restyle_figure(axis.figure, on_paper=on_paper)
        axis.figure.draw_without_rendering()
        boxes = sorted((text.get_window_extent() for text in axis.texts), key=lambda box: -box.y0)
        assert all(upper.y0 >= lower.y1 for upper, lower in pairwise(boxes))  # no number on another


def test_pressure_carries_the_load_and_peaks_as_the_roll_says(result):
    (axis,) = plots.pressure_under_rolls(result.contacts).axes
    for curve, strand in zip(axis.lines[:2], ("carry", "return"), strict=True):
        x, pressure = (np.asarray(values) for values in curve.get_data())
        roll = plots.governing_roll(result.contacts, strand)
        load = roll.load.peak_line_load
        assert np.trapezoid(1e6 * pressure, 1e-3 * x) == pytest.approx(load, rel=PRESSURE)
        assert pressure.max() * 1e6 == pytest.approx(float(roll.peak.peak_pressure), rel=PRESSURE)
        inside = x[pressure > 0.0]
        middle = 0.5 * (inside[0] + inside[-1])
        assert middle == pytest.approx(1e3 * float(roll.peak.eccentricity), abs=np.diff(x).max())
        assert middle > 0.0
        assert f"{load:,.0f} N/m" in curve.get_label()
    assert "[mm]" in axis.get_xlabel()
    assert axis.get_ylabel() == "pressure [MPa]"


def test_governing_roll_bears_the_highest_line_load(result):
    for strand in ("carry", "return"):
        roll = plots.governing_roll(result.contacts, strand)
        rows = result.rolls[result.rolls["strand"] == strand]
        assert roll.load.peak_line_load == pytest.approx(rows["highest line load [N/m]"].max(), rel=1e-14)


def test_band_on_the_master_curve_is_that_of_the_rolls(line, result):
    figure = plots.excited_master_curve(
        line.carry_compound, si(line.ambient.belt), result.contacts, ("carry", "return")
    )
    assert len(figure.axes) == 2
    sizes = {text.get_fontsize() for axis in figure.axes for text in axis.get_legend().get_texts()}
    assert len(sizes) == 1
    for axis in figure.axes:
        spans = {p.get_label(): p for p in axis.patches if isinstance(p, Rectangle)}
        assert len(spans) == 2
        for strand in ("carry", "return"):
            span = spans[f"{strand} rolls: 90 % loss band"]
            low, high = result.contacts.excited_band(strand)
            assert (span.get_x(), span.get_x() + span.get_width()) == pytest.approx((low, high))
        assert len({p.get_hatch() for p in spans.values()}) == 2


def test_power_over_temperature_is_that_of_the_cases(cases):
    (axis,) = plots.case_power(cases, "temperature").axes
    curves = {curve.get_label(): curve for curve in axis.lines}
    assert set(curves) == {"full", "empty"}  # "half" is at one temperature only: no line
    for name in ("full", "empty"):
        found = [r for r in cases.results if r.case.name == name]
        assert curves[name].get_xdata() == pytest.approx([10.0, 30.0])
        assert curves[name].get_ydata() == pytest.approx([r.found.balance.power.motor / 1e3 for r in found])
    assert axis.get_xlabel() == "belt temperature [°C]"
    assert axis.get_ylabel() == "motor power [kW]"


def test_power_over_speed_is_that_of_the_cases(cases):
    temperature = next(r.temperature for r in cases.results if r.case.name == "half")
    (axis,) = plots.case_power(cases, "speed", temperature).axes
    (curve,) = (curve for curve in axis.lines if curve.get_label() == "half")
    assert curve.get_xdata() == pytest.approx([2.54, 3.048])  # 500 and 600 ft/min
    assert axis.get_xlabel() == "belt speed [m/s]"


def test_cases_that_are_not_there(cases):
    with pytest.raises(InputError, match=r"speed = 9.0 m/s: no load case has it, there are 2.54, 3.048"):
        plots.case_power(cases, "temperature", 9.0)
    with pytest.raises(InputError, match=r"temperature = 1.0 K: no load case has it"):
        plots.case_power(cases, "speed", 1.0)


def test_no_case_answered(cases):
    from dataclasses import replace

    with pytest.raises(InputError, match="no load case has an answer"):
        plots.case_power(replace(cases, results=()), "speed")


def test_tornado_is_the_study(line):
    study = uncertain(line.replace(uncertainty={"roll_drag": "30 %", "flow": "5 %"}))
    (axis,) = plots.tornado_chart(study).axes
    assert [label.get_text() for label in axis.get_yticklabels()] == [effect.name for effect in study.effects]
    assert bars(axis, "at the low end") == pytest.approx([(e.motor_low - study.motor) / 1e3 for e in study.effects])
    assert bars(axis, "at the high end") == pytest.approx([(e.motor_high - study.motor) / 1e3 for e in study.effects])


def test_restyled_curves_keep_their_house_colours_and_differ_in_dashes(cases):
    figure = plots.case_power(cases, "temperature")
    before = [to_hex(curve.get_color()) for curve in figure.axes[0].lines]
    restyle_figure(figure)
    curves = figure.axes[0].lines
    assert [to_hex(curve.get_color()) for curve in curves] == before
    assert len({str(curve.get_linestyle()) + str(curve._dash_pattern) for curve in curves}) == len(curves)
    assert figure.axes[0].get_title() == ""


def test_drawn_twice_it_is_the_same(result):
    """Identifiers are hashes without salt of the day: a report of the same figures is the same text."""
    first, second = (figure_svg(plots.resistance_breakdown(result.balance), "x", "bars") for _ in range(2))
    assert first == second


def test_between_two_axes_is_as_much_room_as_below_and_above_them():
    figure, axes = stacked_axes(2, 7.0)
    for axis in axes:
        axis.set(xlabel="belt speed [m/s]", ylabel="motor power [kW]")
    restyle_figure(figure)
    above, below = (axis.get_position() for axis in axes)
    assert above.y0 - below.y1 == pytest.approx(below.y0 + 1.0 - above.y1, rel=1e-9)


def test_a_master_curve_is_that_of_the_series(line):
    compound = line.carry_compound
    upper, lower = master_curve(compound).axes
    series = compound.series(compound.reference)
    for axis, values in ((upper, (series.storage, series.loss)), (lower, (series.tan_delta,))):
        solid = [curve for curve in axis.lines if curve.get_linestyle() == "-"]  # dotted ones are beyond the data
        for curve, value in zip(solid, values, strict=True):
            unit = 1e-6 if axis is upper else 1.0  # [MPa]
            assert curve.get_ydata() == pytest.approx(unit * value(2.0 * np.pi * curve.get_xdata()), rel=1e-12)


def test_a_level_route_is_drawn_with_room_above_and_below(line):
    level = [(50.0 * i, 0.0) for i in range(len(line.route.sections) + 1)]
    (axis,) = route_profile(line, Line.of(line), level).axes
    low, high = axis.get_ylim()
    assert low == -high
    (axis,) = route_profile(line, Line.of(line), [*level[:-1], (level[-1][0], 30.0)]).axes
    assert axis.get_ylim()[1] > -axis.get_ylim()[0]


@pytest.mark.parametrize("on_paper", [False, True])
def test_a_long_name_in_a_legend_is_broken_into_lines(on_paper):
    """One word after the other of a name longer than the figure; the plot keeps more than half of the width."""
    figure, (axis,) = stacked_axes(1, 3.0)
    name = "worst for drift to the outside, left bend, return strand, and for the edges of both bends, -15 °C"
    for label in ("as given", name):
        axis.plot([0.0, 1.0], [0.0, 1.0], label=label)
    axis.legend()
    restyle_figure(figure, on_paper=on_paper)
    shown = [words.get_text() for words in axis.get_legend().get_texts()]
    assert [" ".join(words.split("\n")) for words in shown] == ["as given", name]
    assert figure.subplotpars.right - figure.subplotpars.left > 0.5
