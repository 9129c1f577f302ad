"""Motors, brakes, take-ups and pulleys, each by what it must do by hand."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conveyor.dynamics.belt_chain import friction_at_speed
from conveyor.dynamics.criteria import pulley_peak, tension_peaks
from conveyor.dynamics.machines import prepare_belts
from conveyor.dynamics.simulation import CalculatedDynamics, prepare_setups, simulate_batch, simulate_scenarios
from conveyor.dynamics.wave import simulate_belts
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.waves import STEEPEST_SLOPE, ramp_speed
from conveyor.models import Scenario, Starter
from conveyor.spec import from_data, load
from tests.dynamics.rods import EA, LENGTH, PULL, begun, clamped, follow, idle, rod
from tests.dynamics.scenarios import START, TAUT, checks_of_one, slipping_late
from tests.loop.loop_lines import BOOSTER, DATA, SECOND, TAIL_DRIVE, data, line
from tests.validation.test_start_stop_limits import LONG_SKIRTS, MASSES, NO_RUSH, NOTHING, followed, ridden

SPECS = Path(__file__).parents[2] / "examples" / "specs"
GRIP = 1.5
SLOW = 0.05  # of a winch: its waves, c m' v, stay within its band
HEAVY = 2e6
CELLS = 10
SPAN = LENGTH * (CELLS - 1) / CELLS


def test_every_scenario_is_followed_to_its_own_end():
    """Side by side: as long as each asks for, and no more than a step longer."""
    conveyor = line(drive=DATA["drive"] | MASSES)
    lasting = (2.0, 5.0, 3.3)
    setups = [ridden(conveyor, START | {"duration": f"{time} s"}) for time in lasting]
    for found, time in zip(simulate_batch(setups, 0.1), lasting, strict=True):
        assert time <= found.times[-1] < time + found.record.step
        assert time - 2.0 * found.record.step < found.record.times[-1] <= time


def test_a_scenario_has_the_same_figures_alone_and_beside_others():
    """Longer and shorter ones, in longer and shorter cells: nothing of a belt is in another one, nor after its end."""
    conveyor = line(drive=DATA["drive"] | MASSES)
    setups = [ridden(conveyor, START | {"duration": f"{time} s"}) for time in (2.0, 5.0, 2.0)]
    steps = [0.1, 0.1, 0.05]
    for setup, step, beside in zip(setups, steps, simulate_batch(setups, steps), strict=True):
        (alone,) = simulate_batch([setup], step)
        for name, energy in alone.record.work.items():
            size = max(abs(float(value)) for value in alone.record.work.values())
            assert beside.record.work[name] == pytest.approx(energy, abs=1e-8 * size)
        for name in ("highest", "lowest", "highest_speed", "slipped", "heat"):
            figures = getattr(alone.record, name)
            assert getattr(beside.record, name) == pytest.approx(figures, rel=1e-7, abs=1e-9)


def test_a_motor_at_its_limit_is_told_how_long():
    """A direct start of a heavy drum is at it from the begin to the end; a led one never."""
    drive = DATA["drive"] | {"reduced_mass": "400 t"}
    for starter, words in (({"kind": "direct"}, ", at its limit for 6.0 s"), ({"time": "600 s"}, "")):
        found = followed(line(drive=drive), START | {"starter": starter}, step=0.01)
        (check,) = (one for one in checks_of_one(found) if one.key == "dynamic_torque")
        assert check.found.text("SI").partition(",")[::2] == (
            f"{check.calculated:.2f}",
            words.removeprefix(","),
        )


def test_motors_without_a_power_are_said_to_be_rated_for_the_largest_force():
    plain = {name: value for name, value in DATA["drive"].items() if name != "installed_power"} | MASSES
    words = "drive: installed power not given: motors rated for the largest steady force"
    for drive, said in ((plain, True), (plain | {"installed_power": "400 kW"}, False)):
        conveyor = from_data(DATA | {"drive": drive})
        found = followed(conveyor, START | {"duration": "1 s"}, step=0.1)
        dynamics = CalculatedDynamics(conveyor, found.setup.given.steady, (found,))
        assert (words in dynamics.assumptions) is said


@pytest.mark.parametrize("shares", [(1.0,), (0.7, 0.3)])
def test_motors_without_a_power_bear_their_share_of_the_largest_steady_force(shares):
    """Of the loaded belt, though the empty one is followed; and at least as much as alike motors would."""
    first, *others = (
        {name: value for name, value in given.items() if name != "installed_power"} | MASSES | {"share": share}
        for given, share in zip((DATA["drive"], SECOND), shares, strict=False)
    )
    drive = first | {"further_drives": others} if others else first | {"share": None}
    conveyor = from_data(DATA | {"drive": {name: value for name, value in drive.items() if value is not None}})
    ((setup,), _) = prepare_setups(conveyor, [Scenario.from_data(START | {"name": "empty", "loading": "empty"})])
    full = setup.given.steady.balance.equilibrium.force
    assert full > 1.2 * setup.loop.steady.balance.equilibrium.force
    assert setup.rated == pytest.approx([max(share, 1.0 / len(shares)) * full for share in shares], rel=1e-9)


def test_a_light_rim_comes_to_its_line_and_does_not_swing_about_it():
    """Switched on at once it runs at no load less what its torque takes; never beyond, nor back."""
    found = slipping_late(0.05)
    rim = found.record.drives["rim"][:, 1]
    level = found.line.speed * (1.0 + found.setup.starters[1].slip)
    on = int(np.argmax(rim > 0.5))
    assert np.all(rim[on:] < level)
    assert np.ptp(rim[on:]) < found.setup.starters[1].slip * found.line.speed  # it was 8 and 0 m/s by turns


@pytest.mark.parametrize("step", [0.02, 0.1])
@pytest.mark.parametrize(
    "changes",
    [
        {"drive": {"further_drives": [TAIL_DRIVE | MASSES]}, "route": {"feeding": LONG_SKIRTS}},
        {"drive": {"further_drives": [BOOSTER | MASSES]}},
        {"route": {"take_up": {"kind": "gravity", "position": "tail", "tension": "40 kN"}}},
        {"route": {"take_up": {"kind": "gravity", "position": "tail", "tension": "60 kN"}, "feeding": LONG_SKIRTS},
         "drive": {"further_drives": [TAIL_DRIVE | MASSES]}},
    ],
)  # fmt: skip
def test_a_running_belt_has_the_steady_tensions_on_both_sides_of_its_drives(changes, step):
    """Half a cell of each strand, and what stands there as the belt meets it: skirts come behind a tail drive."""
    drive = DATA["drive"] | MASSES | changes.get("drive", {})
    found = followed(line(drive=drive, route=changes.get("route", {})), NOTHING, step=step)
    steady = found.setup.loop.steady.balance.equilibrium.steady
    for name in ("arriving", "leaving"):
        told = [getattr(one, name) for one in steady.drives]
        # a boundary of stretches that lies within half a cell of a drive has its share on both sides
        assert found.record.drives[name][0] == pytest.approx(told, rel=1e-6)
        assert found.record.drives[name][-1] == pytest.approx(told, rel=1e-6)


def test_the_tension_of_a_winch_holds_as_cells_get_shorter():
    """A belt of c m' takes Δv in over the run-up: the tension rises by c m' Δv/2, at both ends, not by EA Δv dt/Δs."""
    highest = []
    for cells in (20, 80):
        chain = replace(
            rod(cells, winch=np.array([[0.5], [0.1], [1.0]])), retardation=0.1, **clamped(cells, cells // 2)
        )
        found = follow(chain, begun(chain, tension=np.full((1, cells), 0.8 * PULL)), 1.0)
        highest.append(float(found.highest.max()))
    assert highest[0] == pytest.approx(highest[1], rel=0.02)


def test_a_winch_brings_the_tension_into_its_band_and_rests():
    """From a slack belt at its own speed, and then no further."""
    chain = replace(rod(10, winch=np.array([[SLOW], [0.1], [1.0]])), **clamped(10, 5), retardation=0.5)
    found = follow(chain, begun(chain, tension=np.full((1, 10), 0.5 * PULL)), 80.0)
    tension, belt = found.take_up["tension"][:, 0], found.take_up["belt"][:, 0]
    assert tension[-1] == pytest.approx(PULL, rel=0.1)
    assert np.ptp(belt[-100:]) < 1e-9
    assert belt[-1] == pytest.approx(LENGTH / EA * (tension[-1] - 0.5 * PULL), rel=0.02)
    rate = np.diff(belt) / found.step
    assert rate.max() == pytest.approx(SLOW, rel=1e-6)


@pytest.mark.parametrize("shape", ["linear", "cosine", "S"])
def test_ramps_end_at_full_speed_and_are_as_steep_as_said(shape):
    x = np.linspace(0.0, 1.0, 20001)
    made = ramp_speed(x, shape=shape)
    assert made[0] == 0.0
    assert made[-1] == 1.0
    assert np.gradient(made, x).max() == pytest.approx(STEEPEST_SLOPE[shape], rel=1e-3)
    with pytest.raises(InputError, match="linear, cosine, S"):
        ramp_speed(x, shape="steep")


@pytest.mark.parametrize(
    ("starter", "early", "late"),
    [
        ({"kind": "direct"}, 1.6, 1.6),
        ({"kind": "star-delta", "time": "5 s"}, 1.6 / 3.0, 1.6),
        ({"kind": "soft starter", "time": "20 s", "initial_torque": "25 %"}, 0.25 * 1.6, None),
        ({"kind": "fluid coupling", "time": "20 s", "initial_torque": "20 %"}, 0.2 * 1.6, None),
    ],
)
def test_starters_let_through_what_they_say(starter, early, late):
    """At the first step, and after the time; by 1.6 times the rated force, the default."""
    found = followed(line(drive=DATA["drive"] | MASSES), START | {"starter": starter}, step=0.04)
    # beside the torque at the begin what half a step of its growth adds
    assert found.torque[0, 0] == pytest.approx(early, rel=0.01)
    if late is not None:
        assert found.torque[:, 0].max() == pytest.approx(late, rel=1e-9)
    assert "slip" in found.setup.starters[0].assumed


def test_a_later_drive_begins_after_its_delay_and_a_failed_brake_does_not_grip():
    """Delay of one drive; share 0 % of a brake."""
    late = BOOSTER | MASSES | {"starter": {"time": "10 s", "delay": "4 s"}}
    drive = DATA["drive"] | MASSES | {"starter": {"time": "10 s"}, "further_drives": [late]}
    setup = ridden(line(drive=drive), START)
    times = np.arange(0.0, 20.0, 0.5)
    _, share, _ = setup.over_time(times)
    assert np.all(share[:, 0] == 1.0)
    assert np.all(share[:, 1] == (times >= 4.0))
    drive = DATA["drive"] | MASSES | {"brake_force": "20 kN"}
    brake = {"at": "2 s", "do": "brake", "over": "4 s", "share": "50 %"}
    stop = {"begins": "running", "events": [{"do": "power off"}, brake], "duration": "30 s"}
    _, share, force = ridden(line(drive=drive), stop).over_time(times)
    assert np.all(share == 0.0)
    assert force[:, 0] == pytest.approx(10e3 * np.clip((times - 2.0) / 4.0, 0.0, 1.0), rel=1e-12)


"""So that no belt slips."""
FILL = [{"at": "0 s", "share": "0 %"}, {"at": "4 s", "share": "80 %"}, {"at": "8 s", "share": "100 %"}]


def test_a_coupling_lets_through_what_its_fill_says():
    """Linear between the points, held beyond; from its delay on."""
    starter = {"kind": "fluid coupling", "fill": FILL, "delay": "2 s"}
    setup = ridden(line(drive=DATA["drive"] | MASSES), START | {"starter": starter})
    _, share, _ = setup.over_time(np.array([0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 50.0]))
    assert share[:, 0] == pytest.approx([0.0, 0.0, 0.4, 0.8, 0.9, 1.0, 1.0], abs=1e-12)
    assert setup.starters[0].assumed == ("slip",)


@pytest.mark.parametrize(
    ("drives", "shares"),
    [
        ({"further_drives": [SECOND | MASSES]}, (0.5, 0.5)),
        ({"further_drives": [BOOSTER | MASSES]}, (2 / 3, 1 / 3)),
    ],
)
def test_drives_share_the_force_as_they_are_rated(drives, shares):
    """At the end of a start, each on its own slip line, wherever it stands."""
    starter = {"time": "20 s", "slip": "2 %"}
    conveyor = line(drive=DATA["drive"] | MASSES | drives, route={"feeding": NO_RUSH})
    found = followed(conveyor, START | {"starter": starter, "duration": "60 s"}, step=0.1)
    force = found.record.drives["motor"][-1]
    assert force / force.sum() == pytest.approx(shares, abs=0.02)
    assert found.belt_speed[-1] == pytest.approx(found.line.speed, rel=0.01)


def test_a_drive_that_loses_power_leaves_its_share_to_the_other():
    """Both on one pulley's place; the other one takes all, up to its limit of 1.6 times its rating."""
    drive = DATA["drive"] | MASSES | {"further_drives": [SECOND | MASSES]}
    stop = {"begins": "running", "events": [{"do": "power off", "drives": ["second"]}], "duration": "40 s"}
    found = followed(line(drive=drive, route=TAUT), stop, step=0.1)
    motor, whole = found.record.drives["motor"], found.setup.loop.steady.balance.equilibrium.force
    assert np.all(motor[1:, 1] == 0.0)
    assert motor[-1, 0] == pytest.approx(whole, rel=0.02)
    assert float(found.torque[:, 0].max()) <= 1.6 + 1e-9
    assert not found.stops


def test_drives_side_by_side_do_not_swing_against_each_other_in_short_cells():
    """Nearly empty, without power: the belt between them is as stiff as its cell is short."""
    drive = DATA["drive"] | MASSES | {"further_drives": [SECOND | MASSES]}
    off = {"begins": "running", "events": [{"do": "power off"}], "duration": "5 s"}
    setup = ridden(line(drive=drive, material={"flow": "1 t/h"}), off)
    (found,) = simulate_batch([setup], float(setup.loop.travel[-1]) / 800)
    assert np.all(found.record.slipped == 0.0)  # it was 2 mm
    assert found.missing_energy < 1e-5  # of second order; it was 2e-4


def test_drives_out_of_step_come_into_step():
    """The later one is dragged along, then takes its share."""
    late = SECOND | MASSES | {"starter": {"time": "10 s", "delay": "6 s"}}
    drive = DATA["drive"] | MASSES | {"starter": {"time": "10 s"}, "further_drives": [late]}
    found = followed(line(drive=drive), START | {"duration": "40 s"}, step=0.1)
    motor, at = found.record.drives["motor"], found.times
    assert np.all(motor[(at > 0.5) & (at < 5.9), 1] == 0.0)
    assert motor[-1, 1] == pytest.approx(motor[-1, 0], rel=0.05)


def test_an_aborted_start_coasts_and_starts_again():
    events = [{"do": "start"}, {"at": "6 s", "do": "power off"}, {"at": "40 s", "do": "start"}]
    found = followed(
        line(drive=DATA["drive"] | MASSES, route=TAUT),
        {"begins": "at rest", "events": events, "starter": {"time": "12 s"}, "duration": "75 s"},
        step=0.1,
    )
    at, speed = found.times, found.belt_speed
    assert speed[(at > 5.0) & (at < 6.0)].min() > 0.1 * found.line.speed
    assert np.all(speed[(at > 35.0) & (at < 40.0)] == 0.0)
    assert speed[-1] == pytest.approx(found.line.speed, rel=0.05)


def steep(**drive):
    """A loaded belt uphill, whose friction does not hold it."""
    up = [{"name": "a", "length": "60 m"}, {"name": "b", "length": "400 m", "lift": "60 m"}]
    route = {"sections": up, "pulleys": DATA["route"]["pulleys"][:3], "feeding": NO_RUSH}
    return line(drive=DATA["drive"] | MASSES | drive, route=route)


@pytest.mark.parametrize("backstop", [True, False])
def test_a_loaded_incline_restarts_from_its_backstop_or_rolls_back(backstop):
    """Held until the motor pulls; without one it rolls back, and the check says so."""
    events = [{"do": "power off"}, {"at": "20 s", "do": "start"}]
    found = followed(
        steep(backstop=backstop),
        {"begins": "at rest", "events": events, "starter": {"kind": "direct"}, "duration": "40 s"}, step=0.1,
    )  # fmt: skip
    said = {check.key: check for check in checks_of_one(found)}
    least = float(found.belt_speed.min())
    assert (least == 0.0) is backstop
    assert said["dynamic_backward"].failed is not backstop
    if backstop:
        held = found.setup.loop.steady.motions.brake_to_hold
        check = said["dynamic_backstop"]
        assert check.verdict == "pass"
        assert check.calculated >= 0.9 * held
        torque = check.calculated * 0.5 * found.line.pulleys[0].diameter  # of the head, which is driven
        shown, unit, *_ = check.found.text("SI").split(maxsplit=2)
        assert (float(shown.replace(",", "")), unit) == (pytest.approx(torque, rel=5e-3), "N")  # three digits
        assert found.belt_speed[-1] == pytest.approx(found.line.speed, rel=0.05)
    else:
        assert "dynamic_backstop" not in said


def test_bulk_that_is_not_fed_holds_no_belt_at_rest():
    """What brings it to speed falls with the square of the belt's: no mass breaks loose from it with a jump."""
    setups = [
        ridden(line(drive=DATA["drive"] | MASSES, route={"feeding": feeding}), START)
        for feeding in (DATA["route"]["feeding"], NO_RUSH)
    ]
    fed, calm = (float(prepare_belts([setup], 0.04)[1].sticking.sum()) for setup in setups)
    singles = setups[0].loop.steady.balance.singles
    bringing = next(force.total for force in singles if force.key == "acceleration")
    assert fed == pytest.approx(calm, abs=0.05 * bringing)  # wraps feel the tension


def test_a_backstop_that_is_assumed_is_said():
    found = followed(steep(), {"begins": "at rest", "events": [{"do": "power off"}], "duration": "5 s"}, step=0.1)
    said = {check.key: check for check in checks_of_one(found)}
    assert found.setup.assumed_backstop
    assert said["dynamic_backstop"].verdict == "not checked"


def test_drag_brakes_a_drive_without_power_whose_belt_slips():
    """A free rim loses drag over mass a second; under power none of it."""
    cells, rim, drag = 10, 2e3, 400.0
    chain = rod(
        cells, nodes=np.array([[cells]]), rim=np.array([[rim]]), grip=np.zeros((1, 1)),
        backstop=np.array([[False]]), **clamped(cells, 1),
    )  # fmt: skip
    start = begun(chain, rims=np.array([[3.0]]))
    found = simulate_belts(chain, replace(idle(60, 1), drag=np.array([[drag]])), start, step=chain.longest_step)
    rims = found.drives["rim"][:, 0, 0]
    assert np.diff(rims) == pytest.approx(-drag / rim * found.step[0], rel=1e-9)


def test_the_drag_of_a_drive_is_assumed_where_its_belt_slips_alone():
    quiet = followed(line(drive=DATA["drive"] | MASSES, route=TAUT), START, step=0.1)
    for found, slips in ((slipping_late(0.1), True), (quiet, False)):
        given = found.setup.given.steady
        assert (float(found.record.slipped.max()) > 0.0) is slips
        told = CalculatedDynamics(given.conveyor, given, (found,)).assumptions
        assert any("whose belt slips" in one for one in told) is slips


def test_a_belt_that_runs_away_has_the_friction_of_full_speed():
    """The parabola through three speeds up to that says nothing beyond: it may even turn and push."""
    setup = ridden(line(drive=DATA["drive"] | MASSES), START)
    _, chain, _ = prepare_belts([setup], 0.1)
    falling = replace(chain, friction=np.stack([chain.friction[0], 0.0 * chain.mass, -chain.friction[0]]))
    full = np.full_like(chain.mass, setup.loop.line.speed)
    beyond, at = (friction_at_speed(falling.friction, speed, falling.known) for speed in (3.0 * full, full))
    assert np.array_equal(beyond, at)


def test_only_an_inverter_ramps_down():
    stop = {"begins": "running", "events": [{"do": "ramp down"}], "starter": {"kind": "direct"}}
    with pytest.raises(NoSolutionError, match="has no inverter"):
        ridden(line(drive=DATA["drive"] | MASSES), stop).over_time(np.zeros(1))


def test_a_led_stop_comes_to_rest_at_the_end_of_its_ramp():
    stop = {
        "begins": "running",
        "events": [{"do": "ramp down"}],
        "starter": {"time": "20 s"},
        "duration": "30 s",
    }
    found = followed(line(drive=DATA["drive"] | MASSES, route={"feeding": NO_RUSH}), stop, step=0.04)
    assert found.rests_at == pytest.approx(20.0, abs=3.0 * found.setup.loop.travel[-1])
    # of an S the way is half of that at full speed
    assert found.way == pytest.approx(0.5 * found.line.speed * 20.0, rel=0.02)


def test_a_drive_at_rest_has_a_quiet_belt():
    """Friction of a belt that rests is what holds it: it does not change sides with the rounding of the speed."""
    off = {"begins": "running", "events": [{"do": "power off"}], "duration": "80 s"}
    found = followed(load(SPECS / "overland_10km.yaml"), off, step=0.1)
    belt, arriving = found.record.drives["belt"][:, 0], found.record.drives["arriving"][:, 0]
    quiet = arriving[np.flatnonzero(belt)[-1] + 2 :]
    assert quiet.size > 100
    assert np.abs(np.diff(quiet)).max() < 1e-3 * arriving.max()  # it was 4e-3, back and forth


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"kind": "direct", "time": "10 s"}, "nothing is led"),
        ({"kind": "star-delta", "time": "10 s", "stop_time": "5 s"}, "only an inverter"),
        ({"kind": "inverter", "initial_torque": "20 %"}, "given with kind inverter"),
        ({"kind": "inverter", "fill": FILL}, "only a fluid coupling fills"),
        ({"kind": "fluid coupling", "fill": FILL, "time": "5 s"}, "given beside fill"),
        ({"kind": "fluid coupling", "fill": FILL[1:]}, "must begin at 0 s"),
    ],
)
def test_starters_refuse_what_they_do_not_have(given, message):
    with pytest.raises(InputError, match=message):
        Starter.from_data(given)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"events": []}, "events"),
        ({"loading": "part load"}, "needs its share"),
        ({"share": "50 %"}, "remove it"),
        ({"sections": ["a"]}, "names need loading"),
        ({"events": [{"do": "start", "share": "50 %"}]}, "it is of brakes"),
        ({"events": [{"do": "start", "drives": ["other"]}]}, "drives are: drive"),
        ({"loading": "sections", "sections": ["nowhere"]}, "nowhere"),
    ],
)
def test_scenarios_are_refused_by_field(changes, message):
    scenario = {"name": "x", "begins": "at rest", "events": [{"do": "start"}]} | changes
    with pytest.raises(InputError, match=message):
        from_data(data() | {"scenarios": [scenario]})


def test_two_scenarios_of_one_name_are_refused():
    one = {"name": "x", "begins": "at rest", "events": [{"do": "start"}]}
    with pytest.raises(InputError, match="its own name"):
        from_data(data() | {"scenarios": [one, one]})
    assert Scenario.from_data(one).as_data()["begins"] == "at rest"


def test_splice_pulleys_and_curves_are_checked_at_their_own_highest_tensions():
    """By hand: k_N = k S0 S1/k_t over 1.5; R = T/(m' g cos δ) of the empty belt's upper end; a pulley has two sides."""
    carcass = DATA["belt"]["carcass"] | {"splice_strength": "45 %"}
    hollow = [{"name": "a", "length": "300 m"},
              {"name": "hollow", "length": "60 m", "lift": "3 m", "curve": "concave", "curve_radius": "900 m"},
              {"name": "b", "length": "400 m", "lift": "36 m"}]  # fmt: skip
    route = TAUT | {"sections": hollow, "pulleys": DATA["route"]["pulleys"][:3]}
    conveyor = line(belt=DATA["belt"] | {"carcass": carcass}, drive=DATA["drive"] | MASSES, route=route)
    found = followed(conveyor, START | {"starter": {"time": "8 s"}, "duration": "15 s"}, step=0.05)
    said = checks_of_one(found)
    (splice,) = (check for check in said if check.key == "dynamic_splice")
    assert splice.required == pytest.approx(found.highest / 1.5 * 1.1 * 1.7 / 0.45, rel=1e-9)
    there = {peak.strand: peak for peak in tension_peaks(found) if peak.section == "hollow"}
    lifts = {check.subject.text(): check for check in said if check.key == "dynamic_lift_off"}
    assert len(lifts) == 2
    radius = lifts["empty belt stays down, hollow, carry"].required
    slope = found.line.loop.stretches[[s.section for s in found.line.loop.stretches].index("hollow")].inclination
    assert radius == pytest.approx(
        there["carry"].highest / (20.0 * 9.80665 * np.cos(abs(slope) + 30.0 / 900.0)), rel=1e-3
    )
    names = [pulley.name for pulley in found.line.pulleys]
    head = pulley_peak(found, names.index("head"))
    # middles of its cells against their ends at it: a cell of the belt at most lies between
    cell = 1.0 / found.middles.size
    assert head.highest == pytest.approx(float(found.record.drives["arriving"].max()), rel=cell)
    assert head.lowest == pytest.approx(float(found.record.drives["leaving"].min()), rel=cell)


def test_cells_in_belt_order_lie_in_their_stretches():
    """The take-up on the return strand cuts the loop there; figures show the belt from the head on."""
    spec = load(SPECS / "overland.yaml")
    unit = {"kind": "gravity", "position": "return", "section": "plant approach", "tension": "135 kN"}
    cut = spec.replace(route=spec.route.replace(take_up=unit))
    off = Scenario.from_data(
        {"name": "off", "begins": "running", "loading": "full", "events": [{"do": "power off"}], "duration": "1 s"}
    )
    found = simulate_scenarios(cut, [off], error=0.5).followed[0]
    ways, first = found.line.loop.way, found.setup.loop.order[0]
    assert ways[first] not in {0.0, 0.5 * ways[-1]}
    order, distance = found.round_loop
    assert np.all(np.diff(distance) > 0.0)
    place = dict(zip(order.tolist(), distance.tolist(), strict=True))
    for k, cells in found.stretches():
        lie = [place[i] for i in range(cells.start, cells.stop)]
        assert ways[k] - max(np.diff(distance)) < min(lie) <= max(lie) < ways[k + 1] + max(np.diff(distance))
