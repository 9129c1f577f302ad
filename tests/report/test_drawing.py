"""Figures reached from results: what is drawn is what was computed, in the units asked for."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.report.plots import save_figure
from conveyor.results.analysis import analyse_studies
from conveyor.units import from_si
from conveyor.units.presentation import display_unit

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
WITH_UNIT = re.compile(r"\[[^\]]+\]$")
RTOL = 3e-4
"""Contacts of the figures are solved to 1e-4, and the indentation is a part of the power."""


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "in_plant_us.yaml").replace(
        cases=[{"name": "full $x_1$", "temperatures": ["0 degC", "20 degC"], "speeds": ["550 fpm", "600 fpm"]}],
        uncertainty={"roll_drag": "30 %"},
        report={"units": "SI"},
    )


@pytest.fixture(scope="module")
def result(line):
    return conveyor.analyse(line)


@pytest.fixture(scope="module")
def figures(result, line):
    asked = analyse_studies(line, result)
    return {system: result.plots.every(asked, system=system) for system in ("SI", "US")}


def test_every_figure_there_is(figures):
    assert set(figures["SI"]) == {
        "resistances", "tensions", "profile", "cross-section", "pressure", "rubber-carry", "power-temperature",
        "power-speed",
        "cases-temperature", "cases-speed", "ranges",
    }  # fmt: skip


@pytest.mark.parametrize("system", ["SI", "US"])
def test_units_are_on_every_axis(figures, system):
    for name, figure in figures[system].items():
        labels = [figure.axes[-1].get_xlabel(), *(axis.get_ylabel() for axis in figure.axes)]
        named = labels[:1] if name in {"resistances", "ranges"} else labels  # bars have names on the other axis
        assert all(WITH_UNIT.search(label) for label in named), (name, labels)
        foreign = r"\[(lbf|hp|psi|ft|in|fpm|°F)\]" if system == "SI" else r"\[(kN|kW|MPa|mm?|m/s|°C)\]"
        assert not any(re.search(foreign, label) for label in labels), (name, labels)


def test_both_systems_draw_the_same(figures):
    si, us = (figures[system]["tensions"].axes[0] for system in ("SI", "US"))
    for one, other in zip(si.lines, us.lines, strict=True):
        x, y = (np.asarray(values, dtype=float) for values in (one.get_xdata(), one.get_ydata()))
        if one.get_label().startswith("_"):
            continue
        assert np.asarray(other.get_xdata()) == pytest.approx(x / 0.3048)
        assert np.asarray(other.get_ydata()) == pytest.approx(1e3 * y / 4.4482216152605)


def test_power_over_temperature_passes_through_the_analysis(result, figures):
    (curve, *_) = figures["SI"]["power-temperature"].axes[0].lines
    found = dict(zip(curve.get_xdata(), curve.get_ydata(), strict=True))
    assert found[20.0] == pytest.approx(result.balance.power.motor / 1e3, rel=RTOL)
    assert np.diff(sorted(found)) == pytest.approx(5.0)


def test_power_over_speed_passes_through_the_analysis(result, figures):
    (curve, *_) = figures["US"]["power-speed"].axes[0].lines
    at = np.asarray(curve.get_xdata()) == pytest.approx(600.0)
    assert np.any(np.isclose(curve.get_xdata(), 600.0)), at
    motor = np.asarray(curve.get_ydata())[np.isclose(curve.get_xdata(), 600.0)]
    assert motor == pytest.approx(result.balance.power.motor / 745.69987158227022, rel=RTOL)


def test_values_of_ones_own(result):
    figure = result.plots.power_against_temperature(["50 degF", "20 degC"])
    assert figure.axes[0].lines[0].get_xdata() == pytest.approx([10.0, 20.0])
    with pytest.raises(InputError, match=r"nothing to draw: .*cross-section"):
        result.plots.power_against_speed(["20 fpm"])  # the bulk does not fit the belt
    with pytest.raises(InputError, match="kn"):
        result.plots.power_against_speed(["5 kn"])


def test_beyond_the_data_is_dotted(line):
    cold = conveyor.compare_compounds(line, ["s100"], temperatures=["-20 degC", "20 degC"])
    assert [row.covered for row in cold.coverage] == [False, True]
    (solid,) = (c for c in cold.plots.power_against_temperature().axes[0].lines if c.get_label() == "S100")
    assert np.ma.getmaskarray(solid.get_ydata(orig=True)).tolist() == [True, False]
    warm = conveyor.compare_compounds(line, ["s100"], temperatures=["20 degC"])
    assert not any("beyond" in c.get_label() for c in warm.plots.power_against_temperature().axes[0].lines)


def test_the_system_is_that_of_the_report(line):
    own = conveyor.analyse(line.replace(report={"units": "US"}))
    assert own.plots.tensions().axes[0].get_ylabel() == "tension [lbf]"
    assert own.plots.tensions(system="SI").axes[0].get_ylabel() == "tension [kN]"
    with pytest.raises(InputError, match="SI or US"):
        own.plots.tensions(system="us")


def test_rubber_of_both_strands(result):
    assert result.conveyor.carry_compound.name == result.conveyor.return_compound.name
    labels = result.plots.rubber().axes[-1].get_legend_handles_labels()[1]
    assert {"carry rolls: 90 % loss band", "return rolls: 90 % loss band"} <= set(labels)


def test_a_dollar_in_a_name_is_no_formula(figures, tmp_path):
    for name in ("cases-temperature", "cases-speed"):
        assert save_figure(figures["SI"][name], tmp_path / f"{name}.png").stat().st_size > 1000
        legend = figures["SI"][name].axes[0].get_legend()
        assert "full $x_1$" in [text.get_text() for text in legend.get_texts()]
        assert not any(text.get_parse_math() for text in legend.get_texts())


@pytest.mark.parametrize("kind", ["force", "power", "pressure", "thickness", "length", "speed", "line force"])
def test_scales_agree_with_units(kind):
    us, si = (display_unit(kind, system, large=True) for system in ("US", "SI"))
    assert us(123.4) == pytest.approx(from_si(123.4, kind, us.spelled).magnitude)
    # 123.4 in SI, written in the axis' own unit, is the same quantity
    assert si(123.4) * {"kN": 1e3, "kW": 1e3, "MPa": 1e6, "mm": 1e-3}.get(si.label, 1.0) == pytest.approx(123.4)


def test_temperatures_have_an_offset():
    assert display_unit("temperature")([273.15, 293.15]) == pytest.approx([0.0, 20.0])
    assert display_unit("temperature", "US")([273.15, 310.92777777777775]) == pytest.approx([32.0, 100.0])


def test_a_level_route_is_drawn_level():
    shuttle = conveyor.load(SPECS / "shuttle.yaml")
    low, high = conveyor.analyse(shuttle).plots.profile(system="SI").axes[0].get_ylim()
    assert (low, high) == pytest.approx((-0.05 * 24.0, 0.05 * 24.0))


@pytest.mark.parametrize(("spec", "more"), [("curved", {"plan", "drift"}), ("transfer", {"trajectory", "flap"})])
def test_what_a_spec_asks_for_is_drawn(studied, monkeypatch, spec, more):
    result, _ = studied(spec)
    for name in ("power_against_temperature", "power_against_speed"):  # of every conveyor, and slow
        monkeypatch.setattr(type(result.plots), name, lambda *_, **__: None)
    usual = {
        "resistances",
        "tensions",
        "profile",
        "cross-section",
        "pressure",
        "rubber-carry",
        "power-temperature",
        "power-speed",
    }
    assert set(result.plots.every()) - {"rubber-return"} == usual | more
