"""Loads of pulleys in every state, and lengths of transitions: by hand from the loop's own tensions."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from conveyor import analyse
from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.pulley_checks import (
    belt_transitions,
    lagging_pressure,
    pulley_bearings,
    pulley_diameter,
    pulley_shaft,
)
from conveyor.errors import InputError
from conveyor.forces import rubber_free_forces
from conveyor.laws.pulley import hub_moment, least_shaft_diameter, shaft_safety, shaft_slope
from conveyor.laws.transition import transition_stretch
from conveyor.line.contacts import Contacts
from conveyor.line.line import Line
from conveyor.loop.belt_duty import belt_duty
from conveyor.loop.start_and_stop import motion_states, start_and_stop
from conveyor.spec import from_data
from tests.loop.loop_lines import DATA, DOWN, SECOND, closed, data, line

SHAFT = {"bearing_centres": "1.9 m", "hub_centres": "1.4 m", "hub_shaft_diameter": "180 mm", "shaft_steel": "C1045",
         "bearing_rating": "800 kN"}  # fmt: skip
HEAD, BEND, TAIL, SNUB = DATA["route"]["pulleys"]


def calculated(**changes):
    conveyor = line(**changes)
    found = closed(conveyor)
    contacts = Contacts(found.line, {}, (), ())
    fixed = rubber_free_forces(found.line.strands)
    return CalculatedConveyor(conveyor, conveyor.temperature, contacts, found, fixed)


def with_pulleys(*pulleys, **changes):
    return calculated(route={"pulleys": list(pulleys)}, **changes)


def duties(found):
    return {duty.pulley.name: duty for duty in found.pulley_duty}


@pytest.fixture(scope="module")
def plain():
    return calculated()


def _degrees(*pulleys, drive):
    made = Line.of(line(route={"pulleys": list(pulleys)}, drive=drive))
    return [round(math.degrees(pulley.wrap_angle), 9) for pulley in made.pulleys]


def test_a_driven_pulley_without_its_own_wrap_has_that_of_its_drive():
    """Given wraps stay; of two drives at a place each its own, of one drive with two pulleys its share."""
    other = HEAD | {"name": "other"}
    one = {"wrap_angle": "200 deg"}
    assert _degrees(HEAD, BEND, TAIL, SNUB, drive=one) == [200.0, 180.0, 180.0, 20.0]
    assert _degrees(HEAD | {"wrap_angle": "190 deg"}, TAIL, drive=one) == [190.0, 180.0]
    assert _degrees(HEAD, other, TAIL, drive=one | {"further_drives": [SECOND]}) == [200.0, 180.0, 180.0]
    assert _degrees(HEAD, other, TAIL, drive={"wrap_angle": "430 deg"}) == [215.0, 215.0, 180.0]
    assert _degrees(HEAD, TAIL, drive={"wrap_angle": "430 deg"}) == [215.0, 180.0]
    assert _degrees(drive=one) == [200.0, 180.0]  # assumed


def test_the_resultant_of_a_driven_pulley_is_that_of_its_wrap():
    """Triangle of the tensions, which meet at the wrap, with the weight beside their sum."""
    found = with_pulleys(HEAD | {"mass": "0 kg"}, TAIL)
    head = duties(found)["head"]
    for load in head.loads:
        tight, slack = load.arriving, load.leaving
        pull = math.sqrt(tight**2 + slack**2 - 2.0 * tight * slack * math.cos(math.radians(200.0)))
        assert load.resultant == pytest.approx(pull, rel=1e-9)


def test_every_pulley_has_the_tensions_of_its_place_in_every_state(plain):
    states, duty = plain.motion_states, duties(plain)
    assert {"steady", "start", "drives off"} <= {state.name for state in states}
    half = plain.line.count
    for k, state in enumerate(states):
        (side,) = state.drives
        head, tail, bend, snub = (duty[name].loads[k] for name in ("head", "tail", "bend", "snub"))
        assert (head.arriving, head.leaving) == pytest.approx((side.arriving, side.leaving), rel=1e-12)
        assert head.torque == pytest.approx(abs(side.force) * 0.5, rel=1e-9)
        assert tail.arriving == pytest.approx(float(state.ends[half - 1]), rel=1e-12)
        assert (tail.torque, bend.arriving) == (0.0, pytest.approx(side.leaving, rel=1e-12))
        # behind section c of the return strand, which the belt meets second
        assert snub.arriving == pytest.approx(float(state.ends[1]), rel=1e-12)
        assert tail.resultant == pytest.approx(2.0 * tail.arriving + 1000.0 * 9.81, rel=1e-9)
        turned = 2.0 * snub.arriving * math.sin(math.radians(10.0))
        assert snub.resultant == pytest.approx(turned + 500.0 * 9.81, rel=1e-9)


def test_the_weight_stands_where_the_pull_says():
    level = duties(with_pulleys(HEAD, TAIL | {"pull_angle": "90 deg"}))["tail"].steady
    assert level.resultant == pytest.approx(math.hypot(2.0 * level.arriving, 1000.0 * 9.81), rel=1e-9)


def test_two_drives_at_the_head_share_two_pulleys():
    drive = DATA["drive"] | {"wrap_angle": "200 deg", "further_drives": [SECOND | {"position": "head"}]}
    second = HEAD | {"name": "second", "diameter": "800 mm"}
    found = calculated(route={"pulleys": [HEAD, second, TAIL]}, drive=drive)
    head, other = duties(found)["head"].steady, duties(found)["second"].steady
    one, two = found.balance.equilibrium.steady.drives
    assert head.leaving == pytest.approx(other.arriving, rel=1e-12)
    assert (head.torque, other.torque) == pytest.approx((0.5 * one.force, 0.4 * two.force), rel=1e-9)
    # one drive round both: its force in equal parts
    both = calculated(route={"pulleys": [HEAD, second, TAIL]}, drive=DATA["drive"] | {"wrap_angle": "400 deg"})
    (side,) = both.balance.equilibrium.steady.drives
    head, other = duties(both)["head"].steady, duties(both)["second"].steady
    assert (head.torque, other.torque) == pytest.approx((0.25 * side.force, 0.2 * side.force), rel=1e-9)
    assert other.leaving == pytest.approx(side.leaving, rel=1e-9)


def test_the_length_coefficient_knows_the_loads_too():
    assert set(duties(calculated(calculation={"secondary": "C"}))) == {"head", "bend", "tail", "snub"}


def test_shaft_bearing_and_lagging_are_those_of_the_laws():
    asked = SHAFT | {"bearing_life": "100000 h", "lagging_pressure": "50 kPa"}
    found = with_pulleys(HEAD | asked, TAIL)
    duty = duties(found)["head"]
    moment = hub_moment(duty.largest.resultant, bearing_centres=1.9, hub_centres=1.4)
    assert duty.slope == pytest.approx(shaft_slope(moment, hub_centres=1.4, diameter=0.18), rel=1e-12)
    start = next(load for load in duty.loads if load.state == "start")
    assert duty.largest is start
    kind = {"steel": "C1045", "keyway": "profiled"}
    assert duty.safety == (
        pytest.approx(shaft_safety(moment, torque=start.torque, diameter=0.18, **kind), rel=1e-12),
        "start",
    )
    least = least_shaft_diameter(moment, torque=start.torque, hub_centres=1.4, **kind)
    assert duty.least_shaft == pytest.approx(least, rel=1e-12)
    turns = 4.0 / math.pi
    hours = (800e3 / (0.5 * duty.steady.resultant)) ** (10.0 / 3.0) * 1e6 / (3600.0 * turns)
    assert duty.bearing_hours == pytest.approx(hours, rel=1e-12)
    assert duty.pressure == pytest.approx(2.0 * start.arriving, rel=1e-12)
    made = {
        check.key: check
        for criterion in (pulley_shaft, pulley_bearings, lagging_pressure)
        for check in criterion(found)
    }
    assert made["lagging_pressure"].verdict == "FAIL"
    assert made["pulley_bearings"].verdict == ("pass" if hours >= 1e5 else "FAIL")
    assert made["pulley_shaft_safety"].calculated == duty.safety[0]


def test_a_thin_shaft_fails_and_says_what_is_needed():
    found = with_pulleys(HEAD | SHAFT | {"hub_shaft_diameter": "90 mm"}, TAIL)
    slope, safety = pulley_shaft(found)
    assert (slope.verdict, safety.verdict) == ("FAIL", "FAIL")
    needed = duties(found)["head"].least_shaft
    assert f"{needed * 1e3:.0f} mm in the hubs" in safety.why.text()


def test_what_is_not_given_is_not_checked(plain):
    assert [
        *pulley_shaft(plain),
        *pulley_bearings(plain),
        *lagging_pressure(plain),
        *belt_transitions(plain),
    ] == []
    distances = {"bearing_centres": "1.9 m", "hub_centres": "1.4 m", "bearing_rating": "800 kN"}
    found = with_pulleys(HEAD | distances, TAIL)
    slope, safety = pulley_shaft(found)
    assert slope.verdict == "pass"
    assert (safety.verdict, safety.asked.text()) == ("not checked", "steel of the shaft not given")
    (life,) = pulley_bearings(found)
    assert (life.verdict, life.asked.text()) == ("not checked", "life asked of it (bearing_life) not given")


@pytest.mark.parametrize("given", ["hub_centres", "bearing_centres"])
def test_one_distance_alone_gives_no_bending(given):
    found = with_pulleys(HEAD | {given: SHAFT[given], "shaft_steel": "C1045"}, TAIL)
    duty = duties(found)["head"]
    assert (duty.moment, duty.slope, duty.safety, duty.least_shaft) == (None, None, None, None)
    assert list(pulley_shaft(found)) == []


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"hub_centres": "2 m"},
            r"hub_centres.*got 2 m, but the bearings stand outside the hubs, 1\.9 m apart",
        ),
        ({"hub_shaft_diameter": "1.2 m"}, "hub_shaft_diameter.*the shaft must be thinner"),
        ({"shaft_steel": "C45"}, "shaft_steel"),
        ({"pull_angle": "190 deg"}, "pull_angle"),
    ],
)
def test_refused(changed, message):
    with pytest.raises(InputError, match=f"(?s){message}"):
        from_data(data(route={"pulleys": [HEAD | SHAFT | changed]}))


def zones(found):
    states = motion_states(found, start_and_stop(found))
    return {check.zone.end: check for check in belt_duty(found, states).transitions}, states


def test_transitions_bear_the_tensions_of_every_state():
    route = {
        "head_transition": {"length": "5 m"},
        "tail_transition": {"length": "3 m", "pulley_height": "50 %"},
    }
    made = calculated(route=route)
    found, states = zones(made.balance)
    stiffness, allowed = 72.0 * 2000e3, 1.3 * 2000e3 / 6.7
    for end, length, height, tensions in (
        ("head", 5.0, 0.0, [float(state.ends[-1]) for state in states]),
        ("tail", 3.0, 0.5, [float(state.starts[made.line.count]) for state in states]),
    ):
        strips = transition_stretch(1.0, middle_roll_length=0.38, trough_angle=math.radians(35.0), pulley_height=height)
        zone = found[end]
        assert (zone.lowest, zone.highest) == pytest.approx((min(tensions), max(tensions)), rel=1e-12)
        assert zone.most == pytest.approx(zone.highest + stiffness * strips.largest / length**2, rel=1e-12)
        assert zone.least == pytest.approx(zone.lowest + stiffness * strips.least / length**2, rel=1e-12)
        assert zone.cema == pytest.approx({"head": 3.6, "tail": 1.8}[end])  # steel cord, 35 deg, 1 m, below 60 %
        assert zone.highest < 0.6 * allowed / 1.3
        # at its least length the strip bears just what it may
        assert zone.highest + stiffness * strips.largest / zone.stretched**2 == pytest.approx(allowed, rel=1e-12)
        assert zone.lowest + stiffness * strips.least / zone.slackened**2 == pytest.approx(0.0, abs=1e-6)
    verdicts = {(check.subject.text(), check.verdict) for check in belt_transitions(made)}
    for end, zone in found.items():
        for words, least in (("overstressed", zone.stretched), ("slack", zone.slackened)):
            holds = "pass" if zone.zone.length >= least else "FAIL"
            assert (f"{end} transition: no strip {words}", holds) in verdicts


def test_a_transition_too_short_fails_and_one_without_length_shows_what_it_needs():
    short = calculated(route={"head_transition": {"length": "1 m"}})
    said = [check.why.text() for check in belt_transitions(short) if check.failed]
    assert any("head transition: a strip of the belt is overstressed over 1 m; at least" in why for why in said)
    assert all("raise the pulley towards half trough" in why for why in said)
    bare = calculated(route={"head_transition": {}})
    (zone,) = bare.belt_duty.transitions
    assert zone.most is None
    assert zone.stretched == pytest.approx(short.belt_duty.transitions[0].stretched, rel=1e-12)
    assert [(check.verdict, check.found.text()) for check in belt_transitions(bare)] == [
        ("not checked", "length not given")
    ] * 2


def test_a_belt_beyond_its_rating_has_no_length_that_helps():
    belt = DATA["belt"] | {"carcass": DATA["belt"]["carcass"] | {"strength": "150 N/mm"}}
    found = calculated(route={"head_transition": {"length": "5 m"}}, belt=belt)
    failed = [check for check in belt_transitions(found) if check.failed]
    assert any("whatever its length" in check.why.text() for check in failed)


@pytest.mark.parametrize(
    ("changes", "missing"),
    [
        ({"kind": "aramid", "strength": None, "rating": "100 N/mm"}, "belt.carcass.stiffness not given"),
        ({"strength": None}, "belt.carcass.strength and rating not given"),
    ],
)
def test_a_belt_that_is_not_known_is_not_checked(changes, missing):
    carcass = DATA["belt"]["carcass"] | {"kind": "EP"} | changes
    kept = {key: value for key, value in carcass.items() if value is not None}
    found = calculated(route={"head_transition": {"length": "5 m"}}, belt=DATA["belt"] | {"carcass": kept})
    assert [(check.verdict, check.asked.text()) for check in belt_transitions(found)] == [("not checked", missing)] * 2


PLACES = {
    "behind the head": ({"kind": "gravity", "position": "head", "mass": "20 t"}, {}),
    "behind a section": ({"kind": "winch", "position": "return", "section": "c", "tension": "98.1 kN"}, {}),
    "slack side": ({"kind": "gravity", "mass": "20 t"}, {}),
    "slack side, driven by the belt": ({"kind": "gravity", "mass": "20 t"}, {"sections": DOWN}),
}


@pytest.mark.parametrize(("take_up", "route"), PLACES.values(), ids=PLACES)
def test_the_pulley_of_a_take_up_bears_what_it_pulls_with(take_up, route):
    """20 t on two strands: 98.1 kN each, in every state, whatever friction stands beside it."""
    found = calculated(route={"take_up": take_up, "pulleys": [HEAD, BEND, TAIL]} | route)
    for load in duties(found)["bend"].loads:
        assert load.resultant == pytest.approx((20e3 + 1e3) * 9.81, rel=1e-9)
    (turn,) = [force.total for force in found.balance.singles if force.name == "bearings, bend"]
    assert turn == pytest.approx(0.005 * 0.2 * math.hypot(20e3 * 9.81, 1e3 * 9.81), rel=1e-9)


def test_a_take_up_on_the_slack_side_of_a_regenerative_drive_is_asked_where_it_is_built():
    words = "give route.take_up.position if it is built elsewhere"
    said = {
        key: any(words in one for one in analyse(line(route=route)).to_dict()["warnings"])
        for key, route in {
            "driven by the belt": {"take_up": {"kind": "gravity"}, "sections": DOWN},
            "pulled": {"take_up": {"kind": "gravity"}},
            "not given": {"sections": DOWN},
            "built": {"take_up": {"kind": "gravity", "position": "tail"}, "sections": DOWN},
        }.items()
    }
    assert said == {"driven by the belt": True, "pulled": False, "not given": True, "built": False}


def test_curves_show_the_tension_of_their_strips():
    """A hill of 400 m: edges over the middle of the belt by w sin λ - w² sin λ/B, middle below by the latter."""
    sections = [section | {} for section in DATA["route"]["sections"]]
    sections[2] = {"name": "c", "length": "60 m", "curve": "convex", "curve_radius": "400 m"}
    made = calculated(route={"sections": sections})
    curve = next(c for c in made.belt_duty.curves if c.strand == "carry")
    wing, sine, stiffness = 0.31, math.sin(math.radians(35.0)), 72.0 * 2000e3
    assert curve.most == pytest.approx(curve.highest + stiffness * (wing - wing**2) * sine / 400.0, rel=1e-12)
    assert curve.least == pytest.approx(curve.lowest - stiffness * wing**2 * sine / 400.0, rel=1e-12)
    # every state of motion, coasting too
    shape = made.line.loop.stretches
    i = next(k for k, s in enumerate(shape) if (s.section, s.strand) == ("c", "carry"))
    ends = [float(t) for state in made.motion_states for t in (state.starts[i], state.ends[i])]
    assert (curve.lowest, curve.highest) == pytest.approx((min(ends), max(ends)), rel=1e-12)


def test_of_states_that_load_a_shaft_alike_the_first_is_named():
    """Rounding in other units does not choose between them."""
    (duty,) = duties(with_pulleys(HEAD | SHAFT)).values()
    _, arriving, leaving = duty.tensions[0]
    alike = replace(duty, tensions=(("steady", arriving, leaving), ("start", arriving * (1.0 + 1e-14), leaving)))
    assert (alike.largest.state, alike.safety[1]) == ("steady", "steady")


def test_pulleys_of_a_belt_without_a_strength_are_for_all_of_it():
    """DIN 22101: D_A = c_tr times the carcass, 145 for steel cord, times 1, 0.8, 0.63 for groups A, B, C."""
    carcass = {"kind": "steel cord", "thickness": "5 mm"}
    found = closed(line(belt=DATA["belt"] | {"carcass": carcass}))
    pulleys = {check.name: check for check in belt_duty(found, motion_states(found, start_and_stop(found))).pulleys}
    assert {check.utilisation for check in pulleys.values()} == {None}
    least = {name: check.least for name, check in pulleys.items()}
    whole = 145 * 0.005
    assert least == pytest.approx({"head": whole, "bend": 0.8 * whole, "tail": 0.8 * whole, "snub": 0.63 * whole})


def test_a_name_that_ends_in_pulley_says_so_once():
    given = HEAD | SHAFT | {"name": "Head Pulley", "bearing_life": "40000 h", "lagging_pressure": "1 MPa"}
    found = with_pulleys(given, TAIL)
    criteria = (pulley_diameter, pulley_shaft, pulley_bearings, lagging_pressure)
    subjects = [check.subject.text() for criterion in criteria for check in criterion(found)]
    assert subjects == [
        "diameter, Head Pulley", "diameter, tail pulley", "slope at the hubs, Head Pulley",
        "safety of the shaft, Head Pulley", "L10 life of a bearing, Head Pulley",
        "pressure on the lagging, Head Pulley",
    ]  # fmt: skip
