"""What the tables and figures of the loop show is what was calculated."""

from __future__ import annotations

import math

import pytest

import conveyor
from tests.loop.loop_lines import SPECS
from tests.written_tables import figures, written_tables


@pytest.mark.parametrize("name", ["shuttle", "downhill_brakes"])
def test_tables_are_what_was_calculated(name, tmp_path):
    done = conveyor.analyse(conveyor.load(SPECS / f"{name}.yaml"))
    tables, found, route = written_tables(done, tmp_path), done.balance, done.conveyor.route
    drives = tables["drives"]
    steady = drives[drives["state"] == "steady"]
    assert steady["force [N]"].sum() == pytest.approx(found.forces.total, rel=1e-12)
    assert steady["motor power at full speed [kW]"].sum() == pytest.approx(found.power.motor / 1e3, rel=1e-12)
    assert (drives["tension ratio [-]"] <= drives["grip limit [-]"]).all()
    states = tables["tension_states"]
    assert len(states) == 4 * len(route.sections)
    least = states["minimum tension (sag) [N]"] * (1.0 - 1e-12)
    assert (states["steady [N]"] >= least).all()
    assert (tables["tension_conditions"]["margin [N]"] >= -1e-6).all()
    setting = figures(tables["take_up"])["setting [N]"]
    assert float(setting) == pytest.approx(found.equilibrium.setting, rel=1e-14)
    assert tables["pulleys"]["large enough"].all()
    curves = sum(section.curve is not None for section in route.sections)
    assert len(tables.get("vertical_curves", ())) == 2 * curves
    assert ("convergence" in tables) == (curves > 0)
    if curves:
        assert (figures(tables["convergence"]).astype(float) >= 0.0).all()
    profile = tables["profile"]
    assert profile["height [m]"].iloc[-1] == pytest.approx(route.rise, rel=1e-12, abs=1e-12)
    assert profile["horizontal [m]"].iloc[-1] <= route.length
    along = profile["along the belt [m]"]
    assert (along.iloc[0], along.iloc[-1]) == (0.0, pytest.approx(route.length, rel=1e-12))
    assert "moving mass [kg]" in figures(tables["start_stop"]).index
    safety = figures(tables["belt_strength"]).get("safety, steady [-]")
    assert (safety is None) == (done.belt_duty.safety_steady is None)
    if safety is not None:
        assert float(safety) == pytest.approx(done.belt_duty.safety_steady, rel=1e-14)
    lines = {line.get_label(): line for line in done.plots.tensions().axes[0].lines}
    assert 1e3 * lines["steady"].get_ydata()[1:-1] == pytest.approx(states["steady [N]"].to_numpy(), rel=1e-12)
    assert done.plots.profile().axes[0].lines


@pytest.mark.parametrize("name", ["shuttle", "downhill_brakes"])
def test_plain_data_for_json(name):
    told = conveyor.analyse(conveyor.load(SPECS / f"{name}.yaml")).to_dict()
    assert math.fsum(d["force_N"] for d in told["drives"]) == pytest.approx(told["forces_N"]["total"], rel=1e-12)
    assert told["take_up"]["setting_N"] >= told["take_up"]["least_setting_N"] * (1.0 - 1e-12)
