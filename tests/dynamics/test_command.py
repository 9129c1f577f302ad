"""`conveyor dynamics` as its user meets it: files, JSON, refusals; the shortest ramp."""

from __future__ import annotations

import json
import os
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import pytest
from openpyxl import load_workbook

from conveyor.dynamics import scenario_sizing
from conveyor.dynamics import simulation as following
from conveyor.dynamics.scenario_sizing import size_scenario
from conveyor.dynamics.simulation import simulate_batch, simulate_scenarios, standard_scenarios
from conveyor.errors import ConveyorError, InputError, NoSolutionError
from conveyor.models import Scenario
from conveyor.report.tables.dynamics_tables import dynamics_contents, dynamics_json
from conveyor.report.tables.result_schema import result_schema
from conveyor.spec import from_data
from tests.command_line import run
from tests.loop.loop_lines import DOWN, SECOND, data, line
from tests.report.test_result_schema import faults
from tests.validation.test_start_stop_limits import ridden

STOP = {
    "name": "power failure",
    "begins": "running",
    "loading": "full",
    "events": [{"do": "power off"}],
    "duration": "4 s",
}
BRAKED = STOP | {"name": "with brakes", "events": [{"do": "power off"}, {"at": "1 s", "do": "brake"}]}


@pytest.fixture(scope="module")
def spec(tmp_path_factory):
    path = tmp_path_factory.mktemp("dynamics") / "line.json"
    path.write_text(json.dumps(data() | {"scenarios": [STOP, BRAKED]}), encoding="utf-8")
    return path


@pytest.fixture
def rigged(monkeypatch):
    """Loads without contacts: what they resist is a share of them."""

    def setups(conveyor, scenarios, _loads=None):
        made = [ridden(conveyor, one.as_data()) for one in scenarios]
        return made, made[0].loop.steady

    for module in (scenario_sizing, following):
        monkeypatch.setattr(module, "prepare_setups", setups)
    monkeypatch.setattr(scenario_sizing, "_CELLS", 25)


def test_it_writes_what_it_is_asked_for_and_its_json_has_every_peak_and_check(spec):
    names = ("starts.xlsx", "starts.html", "starts.png")
    outputs = [word for name in names for word in ("-o", str(spec.with_name(name)))]
    code, out, err = run("dynamics", spec, *outputs, "--error", "0.05", "--json")
    assert (code, err) == (0, "")
    for name in ("starts.xlsx", "starts.html", "starts_power_failure.png", "starts_with_brakes.png"):
        assert spec.with_name(name).stat().st_size > 5000
    found = json.loads(out)
    scenario = found["scenarios"][0]
    assert scenario["scenario"] == "power failure"
    schema = result_schema()
    assert list(faults(found, schema, schema)) == []
    assert list(faults(found, schema["$defs"]["dynamics"], schema)) == []
    assert scenario["lowest_tension_N"] < scenario["highest_tension_N"]
    assert 0.0 <= scenario["error"] <= 0.05
    assert abs(scenario["energy_error"]) < 1e-3
    assert len(found["tensions"]) == 16
    assert {
        "dynamic_safety", "dynamic_slack", "dynamic_sag", "dynamic_grip", "dynamic_torque", "dynamic_power",
        "dynamic_backward", "dynamic_backstop", "dynamic_travel", "dynamic_rest", "dynamic_overspeed", "dynamic_bulk",
    } == {check["key"] for check in found["checks"]}  # fmt: skip
    assert "belt.carcass.retardation_time not given: 0.1 s, general knowledge" in found["assumptions"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("-s", "start"), 'there are: "power failure", "with brakes"'),
        (("-o", "x.txt"), "its name ends in"),
        (("--error", "2"), "between 0 and 1"),
    ],
)
def test_it_refuses_in_words(spec, arguments, message):
    code, _, err = run("dynamics", spec, *arguments)
    assert code == 2
    assert message in err


def test_standard_scenarios_fit_the_drives():
    """Failures of one drive of several; no led stop without inverters; brakes only where there are any."""
    one = {scenario.name for scenario in standard_scenarios(line())}
    assert one == {"start full", "start empty", "stop full", "emergency stop full"}
    drive = {"further_drives": [SECOND], "torque_factor": 1.4, "brake_force": "10 kN", "brake_delay": "2 s"}
    several = {scenario.name: scenario for scenario in standard_scenarios(line(drive=data()["drive"] | drive))}
    assert {"power failure of drive", "power failure of second", "power failure full, brakes fail"} <= set(several)
    assert "stop full" not in several
    assert [event.do for event in several["emergency stop full"].events] == ["power off", "brake"]


@pytest.mark.usefixtures("rigged")
def test_peaks_hold_and_tables_say_so():
    """An error asked for is kept by cells half as long."""
    conveyor = from_data(data() | {"scenarios": [STOP], "drive": data()["drive"] | {"reduced_mass": "4 t"}})
    found = simulate_scenarios(conveyor, error=0.02)
    (one,) = found.followed
    (finer,) = simulate_scenarios(conveyor, step=0.25 * one.record.step).followed
    assert one.error <= 0.02
    assert abs(finer.highest - one.highest) <= 0.02 * finer.highest
    assert abs(finer.lowest - one.lowest) <= 0.02 * finer.highest
    assert {"scenarios", "scenario_drives", "scenario_tensions", "histories", "checks", "remarks"} <= set(
        dynamics_contents(found, "US").by_key
    )
    assert dynamics_json(found)["conveyor"] == "loop"


QUIET = STOP | {"name": "nothing happens", "events": [{"at": "1 h", "do": "power off"}]}


@pytest.mark.usefixtures("rigged")
def test_a_scenario_without_an_answer_leaves_the_others_theirs():
    """It is named with its reason among the checks and remarks; alone, or with its like, it is refused."""
    led = STOP | {"name": "led stop", "events": [{"do": "ramp down"}], "starter": {"kind": "direct"}}
    drive = data()["drive"] | {"reduced_mass": "4 t"}
    found = simulate_scenarios(from_data(data() | {"scenarios": [led, QUIET], "drive": drive}))
    assert [one.name for one in found.followed] == ["nothing happens"]
    (check,) = (one for one in dynamics_json(found)["checks"] if one["key"] == "dynamic_answer")
    assert (check["case"], check["verdict"]) == ("led stop", "fail")
    (warned,) = (one for one in dynamics_contents(found, "SI").lines("warning") if "led stop" in one)
    assert "has no inverter (direct) and cannot ramp down" in warned
    again = [led, led | {"name": "again"}]
    with pytest.raises(NoSolutionError, match='scenario "led stop", "again": drive "drive" has no inverter'):
        simulate_scenarios(from_data(data() | {"scenarios": again, "drive": drive}))


@pytest.mark.usefixtures("rigged")
def test_peaks_that_do_not_hold_are_refused_with_both_figures_and_what_helps(monkeypatch):
    """A winch with hardly any run-up pulls the belt the harder the shorter the cell."""
    monkeypatch.setattr(following, "_REFINEMENTS", 3)
    winch = {"kind": "winch", "position": "tail", "winch_speed": "1 m/s", "winch_band": "1 %"}
    given = data(route={"take_up": winch | {"winch_run_up": "1 ms"}}, drive={"reduced_mass": "4 t"})
    found = simulate_scenarios(from_data(given | {"scenarios": [STOP, QUIET]}))
    assert [one.name for one in found.followed] == ["nothing happens"]
    (refusal,) = found.refused
    assert refusal.scenario == "power failure"
    why = refusal.reason.text()
    assert why.count("kN") == 4
    assert why.count("at steps of") == 2
    assert "shorter cells bring them no closer" in why
    assert "larger error" in why
    once = from_data(data() | {"scenarios": [STOP], "drive": data()["drive"] | {"reduced_mass": "4 t"}})
    peaks = r'scenario "power failure": highest and lowest tension are .* {0} and .* {0} at .* they come closer: '
    for system, unit in (("SI", "kN"), ("US", "lbf")):
        with pytest.raises(NoSolutionError, match=peaks.format(unit)):
            simulate_scenarios(once.replace(report={"units": system}), error=1e-6)


@pytest.mark.usefixtures("rigged")
def test_a_scenario_that_the_longest_cells_cannot_answer_is_followed_in_shorter_ones(monkeypatch):
    """As drives that have no room beside each other in 50 cells."""
    longest = []

    def beside(setups, step):
        longest.append(max(step))
        if max(step) > 0.3 * longest[0]:
            raise NoSolutionError("the belt is too short")
        return side_by_side(setups, step)

    side_by_side = following.simulate_batch
    monkeypatch.setattr(following, "simulate_batch", beside)
    found = simulate_scenarios(from_data(data(drive={"reduced_mass": "4 t"}) | {"scenarios": [STOP]}), error=0.05)
    assert [one.name for one in found.followed] == ["power failure"]
    assert found.refused == ()


@pytest.mark.usefixtures("rigged")
def test_a_winch_with_a_speed_needs_its_run_up_in_scenarios():
    winch = {"kind": "winch", "position": "tail", "winch_speed": "1 m/s"}
    given = data(route={"take_up": winch}, drive={"reduced_mass": "4 t"}) | {"scenarios": [STOP]}
    with pytest.raises(NoSolutionError, match=r"give route\.take_up\.winch_run_up, the time in which"):
        simulate_scenarios(from_data(given))
    with pytest.raises(InputError, match="given without winch_speed"):
        from_data(data(route={"take_up": {"kind": "winch", "winch_run_up": "1 s"}}))


@pytest.mark.parametrize(
    ("highest", "error"),
    [
        ((104.0, 102.0, 101.0), 2.0),  # first order: as much again is missing
        ((106.0, 102.0, 101.5), 2.0 * 2.0),  # faster: half the change before
        ((102.0, 100.0, 100.0), 2.0),  # no change by chance
        ((101.0, 102.0, 105.0), 2.0 * 3.0 / (2.0**0.5 - 1.0)),  # apart: as of order 1/2
        ((102.0, 104.0, 103.0), 2.0 * 2.0),  # back
        ((100.0, 100.0, 100.0), 0.0),
    ],
)
def test_the_error_of_peaks_is_the_grid_convergence_index_of_three_sizes(highest, error):
    peaks = [following._Peaks(one, 10.0, 0.1) for one in highest]
    assert following._peak_error(peaks[:2]) is None
    assert following._peak_error(peaks) == pytest.approx(error / highest[-1], rel=1e-12)


@pytest.mark.parametrize(
    ("lowest", "swing", "error"),
    [
        ((28.0, 26.0, 25.0), 0.0, 2.0 * 2.0**0.5 / (2.0**0.5 - 1.0)),  # counts 2/√2, falls no faster than √2
        ((28.0, 26.0, 27.0), 0.0, 2.0 * 2.0**0.5 / (2.0**0.5 - 1.0)),  # back
        ((28.0, 26.0, 25.0), 9.0, 9.0),
        ((26.0, 26.0, 26.0), 0.0, 0.0),
    ],
)
def test_a_lowest_tension_that_comes_at_once_converges_with_order_one_half(lowest, swing, error):
    peaks = [following._Peaks(100.0, one, 0.1, swing) for one in lowest]
    assert following._peak_error(peaks) == pytest.approx(error / 100.0, rel=1e-12)


@pytest.mark.usefixtures("rigged")
def test_the_shortest_ramp_keeps_every_criterion():
    """Shorter ones do not; without an inverter there is none."""
    start = {"name": "start", "begins": "at rest", "loading": "full", "events": [{"do": "start"}]}
    taut = data()["route"] | {"take_up": {"kind": "gravity", "tension": "60 kN"}}
    conveyor = from_data(data() | {"route": taut, "drive": data()["drive"] | {"reduced_mass": "4 t"}})
    scenario = Scenario.from_data(start)
    found = size_scenario(conveyor, scenario, "ramp", between=(4.0, 40.0))
    assert 4.0 <= found.value < 40.0
    assert found.setup.starters[0].time == pytest.approx(found.value, rel=1e-12)
    assert 0.0 < found.error < 0.05
    assert found.governs.text()
    with pytest.raises(InputError, match="a ramp needs inverters"):
        size_scenario(conveyor, Scenario.from_data(start | {"starter": {"kind": "direct"}}), "ramp")
    with pytest.raises(NoSolutionError, match="nothing from 1 to 2"):
        size_scenario(conveyor, scenario, "ramp", between=(1.0, 2.0))
    us = conveyor.replace(report={"units": "US"})
    with pytest.raises(NoSolutionError, match=r"nothing from 1 s to 2 s keeps every check; at best: .* ft "):
        size_scenario(us, scenario, "ramp", between=(1.0, 2.0))
    with pytest.raises(
        NoSolutionError, match=r"nothing from 224\.8 lbf to 449\.6 lbf keeps every check; at best: .* lbf;"
    ):
        size_scenario(us, scenario, "take-up", between=(1e3, 2e3))
    with pytest.raises(NoSolutionError, match=r"nothing from 1000 to 2000 \(SI\) keeps every check; at best: .* N;"):
        size_scenario(conveyor, scenario, "take-up", between=(1e3, 2e3))


@pytest.mark.usefixtures("rigged")
def test_the_least_brake_stops_a_downhill_belt_in_the_time_of_its_scenario():
    """By hand: what the stiff belt needs to stop so soon, waves aside; more of it makes the belt slip or slack."""
    taut = {
        "sections": DOWN,
        "pulleys": data()["route"]["pulleys"][:3],
        "take_up": {"kind": "gravity", "tension": "80 kN"},
    }
    conveyor = from_data(data(route=taut, drive={"reduced_mass": "4 t"}))
    stop = {"name": "stop", "begins": "running", "loading": "full", "duration": "20 s",
            "events": [{"do": "power off"}, {"do": "brake"}]}  # fmt: skip
    found = size_scenario(conveyor, Scenario.from_data(stop), "brake")
    (setup,), _ = scenario_sizing.prepare_setups(conveyor, [Scenario.from_data(stop)])
    mass = setup.loop.mass.sum() + setup.rims.sum() + sum(lump.mass for lump in setup.loop.lumps)
    hold = -setup.loop.steady.balance.equilibrium.force
    assert found.value == pytest.approx(hold + mass * 4.0 / 20.0, rel=0.1)
    assert found.governs.text() == "stopping"
    assert found.setup.brakes == pytest.approx([found.value], rel=1e-12)
    with pytest.raises(InputError, match="no brake grips in it"):
        size_scenario(conveyor, Scenario.from_data(STOP), "brake")


@pytest.mark.usefixtures("rigged")
def test_the_take_up_is_as_heavy_as_a_fast_start_needs():
    """The belt slips with less; the mass is that of the tension."""
    start = {"name": "start", "begins": "at rest", "loading": "full", "events": [{"do": "start"}],
             "starter": {"time": "14 s"}, "duration": "16 s"}  # fmt: skip
    conveyor = from_data(data(drive={"reduced_mass": "4 t"}))
    found = size_scenario(conveyor, Scenario.from_data(start), "take-up")
    assert found.kind == "mass"
    assert found.setup.setting == pytest.approx(found.value * 9.80665 / 2.0, rel=1e-3)
    assert found.governs.text().startswith(("grip of", "sag", "belt is taut"))
    assert 0.0 < found.error < 0.05


@pytest.mark.usefixtures("rigged")
def test_a_delay_is_found_that_keeps_every_criterion():
    second = SECOND | {"reduced_mass": "4 t", "starter": {"time": "10 s"}}
    taut = {"take_up": {"kind": "gravity", "tension": "80 kN"}}
    drive = {"reduced_mass": "4 t", "further_drives": [second], "starter": {"time": "10 s"}}
    conveyor = from_data(data(route=taut, drive=drive))
    start = {
        "name": "start",
        "begins": "at rest",
        "loading": "full",
        "events": [{"do": "start"}],
        "duration": "30 s",
    }
    found = size_scenario(conveyor, Scenario.from_data(start), "delay", between=(0.0, 10.0))
    assert 0.0 <= found.value <= 10.0
    assert found.setup.starters[1].delay == pytest.approx(found.value, abs=1e-12)
    # eight trials, three times, each time between the neighbours of the best; at an end there is one neighbour
    spacing = found.error * found.value
    shown, unit = found.why.text("SI").removeprefix("lowest peak: ").split()
    (again,) = simulate_batch([found.setup], float(found.setup.loop.travel[-1]) / 100)
    # trials have 25, 50 and 100 cells here
    assert (float(shown.replace(",", "")), unit) == (pytest.approx(again.highest / 1e3, rel=0.03), "kN")
    assert found.why.text("US").endswith(" lbf")
    assert any(spacing == pytest.approx(10.0 * sides / 7.0**3, rel=1e-9) for sides in (1.0, 2.0, 4.0))
    with pytest.raises(InputError, match="one drive only"):
        size_scenario(from_data(data()), Scenario.from_data(start), "delay")


@pytest.mark.usefixtures("rigged")
def test_an_executor_gives_the_same_answers():
    """Every scenario in its place, whatever the groups."""
    names = [BRAKED | {"name": f"stop {k}", "friction": f"{100 - 10 * k} %"} for k in range(3)]
    conveyor = from_data(data() | {"scenarios": names, "drive": data()["drive"] | {"reduced_mass": "4 t"}})
    here = simulate_scenarios(conveyor, error=0.1)
    with ThreadPoolExecutor(2) as pool:
        there = simulate_scenarios(conveyor, error=0.1, executor=pool, workers=2)
    assert [one.name for one in there.followed] == [one.name for one in here.followed]
    for one, other in zip(here.followed, there.followed, strict=True):
        assert other.way == pytest.approx(one.way, rel=1e-3)
        assert other.lowest == pytest.approx(one.lowest, rel=1e-2)


@pytest.mark.usefixtures("rigged")
def test_a_lost_worker_is_told():
    conveyor = from_data(data() | {"scenarios": [BRAKED | {"name": "stop"}]})
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:
        processes.submit(os._exit, 1)
        with pytest.raises(ConveyorError, match="a worker of the scenarios was lost"):
            simulate_scenarios(conveyor, executor=processes)


def test_power_reports_the_scenarios_of_a_spec(spec, tmp_path):
    """Sheet, part of the page, checks beside the others, plain figures; without scenarios nothing of it."""
    to = [tmp_path / name for name in ("power.xlsx", "power.html")]
    code, out, err = run("power", spec, "-o", str(to[0]), "-o", str(to[1]), "--json")
    assert (code, err) == (0, "")
    told = json.loads(out)
    schema = result_schema()
    assert list(faults(told, schema["$defs"]["power"], schema)) == []
    assert [row["scenario"] for row in told["dynamics"]["scenarios"]] == ["power failure", "with brakes"]
    cases = {row["case"] for row in told["checks"] if row["key"].startswith("dynamic_")}
    assert cases == {"power failure", "with brakes"}
    book = load_workbook(to[0], read_only=True)
    assert {"Scenarios", "Histories"} <= set(book.sheetnames)
    page = to[1].read_text(encoding="utf-8")
    assert 'id="dynamics"' in page
    assert 'id="through-time"' in page
    assert 'begin="moving_power_failure_play.click"' in page
    assert "<script" not in page
