"""Vertical curves: statics, limits, convergence with its bound, lift-off; belt and pulleys against closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from conveyor.checks import run_checks
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.vertical_curve import trough_section
from conveyor.line.strands import Strands
from conveyor.line.stretches import CurveLoads, masses_on_rolls
from conveyor.loop.belt_duty import belt_duty, trough_of_stretch
from conveyor.loop.belt_limits import LEAST_EDGE_TENSION
from conveyor.loop.tension_coupling import next_convergence, pressing_masses
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import from_data, load
from tests.loop.loop_lines import DATA, SPECS, closed, data, line, told

HILL = [{"name": "a", "length": "120 m"}, {"name": "b", "length": "200 m", "lift": "12 m"},
        {"name": "top", "length": "60 m", "curve": "convex", "curve_radius": "400 m"},
        {"name": "d", "length": "100 m", "lift": "-3 m"}]  # fmt: skip
VALLEY = [{"name": "a", "length": "100 m"},
          {"name": "dip", "length": "60 m", "curve": "concave", "curve_radius": "900 m"},
          {"name": "c", "length": "400 m", "lift": "30 m"}]  # fmt: skip
PULLEYS = DATA["route"]["pulleys"][:3]


def curved(sections, **changes):
    return line(route={"sections": sections, "pulleys": PULLEYS}, **changes)


@pytest.fixture(scope="module")
def hill():
    return calculate(curved(HILL))


def test_the_rolls_of_a_hill_bear_what_the_tension_turns(hill):
    """Sum of the added forces over the sets is T' times the angle turned; sin x for x leaves (a/2r)²/6 = 4e-7."""
    steady = hill.balance.equilibrium.steady
    pressing = pressing_masses(hill.line, steady)
    assert set(pressing) == {("top", "carry"), ("top", "return")}
    for i, stretch in enumerate(hill.line.loop.stretches):
        if stretch.section != "top":
            continue
        pull = 0.5 * (steady.starts[i] + steady.ends[i]) - stretch.line_mass * 4.0**2
        added = pressing["top", stretch.strand] * 9.81 * stretch.length
        assert added == pytest.approx(pull * stretch.length / 400.0, rel=1e-5)
        borne = stretch.sets * math.fsum(load.force for load in stretch.loads)
        assert borne == pytest.approx(stretch.line_mass * 9.81 * stretch.length + added, rel=1e-5)


def _borne(loaded):
    """Force on every roll [N]."""
    return [load.force for stretch in loaded.stretches for load in stretch.loads]


def test_tension_and_loads_agree_within_the_bound(hill):
    found = hill.convergence
    assert found is not None
    assert found.ratio < 1.0
    assert found.bound <= 1e-6
    fine = curved(HILL, calculation={"rtol": 2e-7})
    finer = calculate(fine)
    # the contacts' own tolerance comes on top of the bound, and with the friction to design for once more
    assert hill.balance.tensions.largest == pytest.approx(finer.balance.tensions.largest, rel=found.bound + 2e-6)
    again = Strands.of(fine, CurveLoads(pressing_masses(finer.line, finer.balance.equilibrium.steady)))
    assert _borne(again) == pytest.approx(_borne(finer.line), rel=1e-6)


def test_a_hill_costs_a_valley_saves_and_an_endless_radius_does_neither(hill):
    straight = [section | {} for section in HILL]
    del straight[2]["curve"], straight[2]["curve_radius"]
    plain = calculate(curved(straight))
    assert plain.convergence is None
    indentation = plain.balance.forces.indentation
    assert hill.balance.forces.indentation > indentation
    valley = calculate(curved([*HILL[:2], HILL[2] | {"curve": "concave", "curve_radius": "1500 m"}, HILL[3]]))
    assert valley.balance.forces.indentation < indentation
    far = calculate(curved([*HILL[:2], HILL[2] | {"curve_radius": "100 km"}, HILL[3]]))
    # the difference goes with 1/r: 400 m over 100 km of the hill's, tolerance of the contacts beside
    extra = (hill.balance.forces.indentation - indentation) * 400.0 / 100e3
    assert far.balance.forces.indentation - indentation == pytest.approx(extra, rel=0.1, abs=2e-6 * indentation)


def test_a_relieved_belt_keeps_the_sum_of_its_loads():
    assert masses_on_rolls(20.0, 80.0, -5.0, radius=120.0, where="dip") == (15.0, 80.0)
    assert masses_on_rolls(20.0, 80.0, -30.0, radius=120.0, where="dip") == (0.0, 70.0)
    assert masses_on_rolls(20.0, 80.0, 7.0, radius=120.0, where="dip") == (27.0, 80.0)
    # 20 kg/m hold down a pull that falls with 1/R: of 25 kg/m at 120 m no more from 150 m on
    with pytest.raises(NoSolutionError, match=r"lifts off in dip: on its concave curve of 120 m .* beyond 150 m"):
        masses_on_rolls(20.0, 0.0, -25.0, radius=120.0, where="dip")
    assert Strands.of(curved(VALLEY), CurveLoads({("dip", "carry"): -30.0})).stretches[1].bulk_mass > 0.0


def test_a_sharp_valley_lifts_the_belt_and_says_so():
    sharp = [VALLEY[0], VALLEY[1] | {"curve_radius": "30 m"}, VALLEY[2]]
    with pytest.raises(NoSolutionError, match=r"the belt lifts off in section \"dip\", (carry|return): "):
        calculate(curved(sharp))


def test_least_radii_are_those_of_the_laws():
    made = curved(VALLEY)
    found = closed(made)
    curves = {(c.section, c.strand): c for c in belt_duty(found).curves}
    carry, back = curves["dip", "carry"], curves["dip", "return"]
    # level chord, 60 m on 900 m: an end slopes by a thirtieth
    assert carry.lift_off == pytest.approx(carry.highest / (20.0 * 9.81 * math.cos(30.0 / 900.0)), rel=1e-14)
    assert carry.cema_lift_off == pytest.approx(1.11 * carry.highest / (20.0 * 9.81), rel=1e-14)
    # flat return belt: no strip is longer than another
    assert (back.overstress, back.buckling) == (0.0, 0.0)
    wing, sine = (1.0 - 0.38) / 2.0, math.sin(math.radians(35.0))
    middle, edge = wing**2 * sine, wing * sine - wing**2 * sine
    stiffness = 72.0 * 2000e3
    assert carry.overstress == pytest.approx(stiffness * middle / (2000e3 / 6.7 - carry.highest), rel=1e-12)
    assert carry.buckling == pytest.approx(stiffness * edge / (carry.lowest - LEAST_EDGE_TENSION), rel=1e-12)
    tight = curved([VALLEY[0], VALLEY[1] | {"curve_radius": "60 m"}, VALLEY[2]])
    said = [w for w in told(tight, closed(tight)) if 'section "dip"' in w]
    assert any("carry: the empty belt lifts off on the concave curve of 60 m; at least" in w for w in said)
    assert any("carry: a strip of the belt goes slack" in w for w in said)


def test_the_middle_of_a_hill_keeps_thirty_pounds_an_inch_by_cema():
    """r = b sin β E/(9 (T - 30)) in feet, for three equal rolls; beside DIN's it is as 4.5 N/mm is to 30 lbf/in."""
    hill = [VALLEY[0], VALLEY[1] | {"curve": "convex"}, VALLEY[2]]
    found = closed(curved(hill))
    carry, back = ({(c.section, c.strand): c for c in belt_duty(found).curves}["dip", s] for s in ("carry", "return"))
    (stretch,) = (s for s in found.line.loop.stretches if (s.section, s.strand) == ("dip", "carry"))
    width, pound, inch = found.line.belt.width, 4.4482216152605, 0.0254
    middle = width * math.sin(math.radians(35.0)) / 9.0
    stiffness = found.line.belt.tensile_stiffness / (pound / inch)  # [lbf/in]
    tension = carry.lowest / width / (pound / inch)
    assert carry.cema_buckling == pytest.approx(middle * stiffness / (tension - 30.0), rel=1e-12)
    equal = trough_section(width, middle_roll_length=width / 3.0, trough_angle=math.radians(35.0))
    assert equal.middle_below == pytest.approx(width * math.sin(math.radians(35.0)) / 9.0, rel=1e-12)
    given = trough_of_stretch(stretch, width).middle_below  # rolls of 380 mm, 38 % of the belt
    over = (carry.lowest / width - LEAST_EDGE_TENSION) / (carry.lowest / width - 30.0 * pound / inch)
    assert carry.cema_buckling == pytest.approx(middle / given * over * carry.buckling, rel=1e-12)
    assert (back.cema_buckling, carry.cema_lift_off) == (0.0, None)


def test_a_curve_that_stands_upright_is_refused():
    """60 m rising by 30: 30 deg, and 0.5 L/r more at an end; 60 deg are left, 60 m/(2 pi/3) = 28.65 m."""
    with pytest.raises(
        InputError, match=r"got 28 m, with which 60 m turn by 123 deg and stand upright .* than 28.6479 m"
    ):
        curved([VALLEY[0], VALLEY[1] | {"curve_radius": "28 m", "lift": "30 m"}, VALLEY[2]])
    curved([VALLEY[0], VALLEY[1] | {"curve_radius": "29 m", "lift": "30 m"}, VALLEY[2]])


def test_a_belt_between_two_rolls_is_a_v():
    """Its centroid is half way up its wings; five rolls are a polygon; without strength nothing is guessed."""
    carry = DATA["idlers"]["carry"]
    roll = carry["roll"] | {"length": "580 mm"}

    def dip(**changes):
        found = closed(curved(VALLEY, **changes))
        return next(c for c in belt_duty(found).curves if (c.section, c.strand) == ("dip", "carry"))

    two = dip(idlers={"carry": carry | {"rolls": 2, "trough_angle": "20 deg", "roll": roll}})
    half, stiffness = 0.25 * math.sin(math.radians(20.0)), 72.0 * 2000e3
    assert two.overstress == pytest.approx(stiffness * half / (2000e3 / 6.7 - two.highest), rel=1e-12)
    assert two.buckling == pytest.approx(stiffness * half / (two.lowest - LEAST_EDGE_TENSION), rel=1e-12)
    five = dip(
        idlers={
            "carry": carry
            | {
                "rolls": 5,
                "inner_trough_angle": "15 deg",
                "load_shares": ["4 %", "24 %", "44 %", "24 %", "4 %"],
                "roll": carry["roll"] | {"length": "230 mm"},
            }
        }
    )
    inner, outer = 0.23 * math.sin(math.radians(15.0)), 0.155 * math.sin(math.radians(35.0))
    middle = 0.23 * inner + 2.0 * 0.155 * (inner + 0.5 * outer)
    assert five.overstress == pytest.approx(stiffness * middle / (2000e3 / 6.7 - five.highest), rel=1e-12)
    edge = inner + outer - middle
    assert five.buckling == pytest.approx(stiffness * edge / (five.lowest - LEAST_EDGE_TENSION), rel=1e-12)
    unknown = dip(belt={"carcass": {"kind": "steel cord", "thickness": "5 mm"}})
    assert (unknown.overstress, unknown.buckling) == (None, None)


def test_strength_is_needed_per_width():
    wide = {"width": "1200 mm", "carcass": DATA["belt"]["carcass"] | {"splice_strength": "45 %"}}
    sets = DATA["idlers"]
    long = {
        "carry": sets["carry"] | {"roll": sets["carry"]["roll"] | {"length": "465 mm"}},
        "return": sets["return"] | {"roll": sets["return"]["roll"] | {"length": "1400 mm"}},
    }
    narrow, duty = (
        belt_duty(closed(made)) for made in (line(belt={"carcass": wide["carcass"]}), line(belt=wide, idlers=long))
    )
    factor = narrow.strength_needed["steady"] / narrow.largest_steady  # the belt is 1 m wide there
    assert duty.strength_needed["steady"] == pytest.approx(factor * duty.largest_steady / 1.2, rel=1e-12)
    assert duty.safety_steady == pytest.approx(1.2 * 2000e3 / duty.largest_steady, rel=1e-12)


def test_the_first_step_on_curves_is_never_the_last(hill):
    """Of one step the ratio of changes is not known."""
    steady = hill.balance.equilibrium.steady
    first = next_convergence(None, steady, steady, hill.line, steady.largest)
    assert (first.steps, first.change) == (1, 0.0)
    assert not first.has_converged(hill.line.rtol)
    second = next_convergence(replace(first, change=1e-3), steady, steady, hill.line, steady.largest)
    assert (second.steps, second.ratio) == (2, 0.0)
    assert second.has_converged(hill.line.rtol)


def test_safety_and_diameters():
    changes = data()
    changes["belt"]["carcass"] |= {"splice_strength": "45 %", "duty": "unfavourable", "strength": "630 N/mm"}
    changes["route"]["pulleys"][0] |= {"diameter": "630 mm", "shaft_diameter": "100 mm"}
    made = from_data(changes)
    found = closed(made)
    duty = belt_duty(found)
    steady = max(point.tension for point in found.tension_points)
    assert duty.largest_steady == pytest.approx(steady, rel=1e-14)
    assert duty.safety_steady == pytest.approx(630e3 / steady, rel=1e-14)
    assert duty.strength_needed["steady"] == pytest.approx(steady * 1.1 * 1.9 / 0.45, rel=1e-14)
    assert duty.drive_diameter == pytest.approx(145 * 0.005, rel=1e-14)
    groups = {pulley.name: (pulley.group, round(1e3 * pulley.least, 2), pulley.large_enough) for pulley in duty.pulleys}
    used = {pulley.name: pulley.utilisation for pulley in duty.pulleys}
    assert used["head"] > 0.6 > max(used["bend"], used["tail"], used["snub"])  # of 630/6.7 N/mm
    assert groups == {
        "head": ("A", 725.0, False), "bend": ("B", 456.75, True), "tail": ("B", 456.75, True),
        "snub": ("C", 362.5, True),
    }  # fmt: skip
    said = told(made, found)
    assert any(w.startswith('pulley "head" is 630 mm in diameter, the carcass requires 725 mm') for w in said)
    assert any(w.startswith("the splice requires a belt of") for w in said) == (
        max(duty.strength_needed.values()) > 630e3
    )


@pytest.mark.parametrize("name", ["shuttle", "downhill_brakes"])
def test_examples_hold(name):
    done = calculate(load(SPECS / f"{name}.yaml"))
    said = [w.text() for w in analysis_warnings(done, run_checks(done))]
    assert not [w for w in said if "lifts off" in w or "does not stop" in w or "asks for" in w]
    found = done.balance
    settled, sides = found.equilibrium, found.equilibrium.steady.drives
    assert math.fsum(side.force for side in sides) == pytest.approx(found.forces.total, rel=1e-12)
    motors = math.fsum(found.layout.motor(side.force) for side in sides)
    assert motors == pytest.approx(found.power.motor, rel=1e-12)
    for state in settled.states.values():
        for drive, side in zip(done.line.drives, state.drives, strict=True):
            assert side.tight / side.slack <= math.exp(drive.friction * drive.wrap_angle)
    least = done.line.loop.least
    assert (settled.steady.starts >= least * (1.0 - 1e-12)).all()
    assert (settled.steady.ends >= least * (1.0 - 1e-12)).all()
    assert settled.setting >= settled.needed * (1.0 - 1e-12)
    assert all(settled.setting - asked >= -1e-6 for asked in settled.conditions.values())
    assert all(pulley.large_enough for pulley in done.belt_duty.pulleys)
    curves = sum(section.curve is not None for section in done.conveyor.route.sections)
    assert len(done.belt_duty.curves) == 2 * curves
    assert (done.convergence is None) == (curves == 0)
    for (
        strand,
        cover,
    ) in done.contacts.covers.items():  # kept from a step before where the tensions moved no load
        assert cover.strain.line_load == pytest.approx(done.contacts.losing_load(strand), rel=done.line.rtol)
    if done.convergence is not None:
        settling = done.convergence
        assert min(settling.steps, settling.change, settling.ratio, settling.bound) >= 0.0
