"""Vertical curves: statics, limits, convergence with its bound, lift-off; belt and pulleys against closed forms."""

from __future__ import annotations

import math

import pytest

import conveyor
from conveyor.errors import NoSolutionError
from conveyor.line.stretches import roll_masses, stretches
from conveyor.loop.balance import balance
from conveyor.loop.belt_duty import LEAST_EDGE_TENSION, belt_duty
from conveyor.loop.curved import pressing_masses, run
from conveyor.remarks.loop import loop_warnings
from conveyor.spec import from_data
from tests.loop.loop_lines import DATA, SPECS, data, forced, line

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
    return run(curved(HILL))


def test_the_rolls_of_a_hill_bear_what_the_tension_turns(hill):
    """Sum of the added forces over the sets is T' times the angle turned; sin x for x leaves (a/2r)²/6 = 4e-7."""
    for result in hill.stretches:
        if result.stretch.section != "top":
            continue
        stretch = result.stretch
        order = hill.balance.settled.loop.geometry.stretches
        i = next(k for k, s in enumerate(order) if (s.section, s.strand) == ("top", stretch.strand))
        steady = hill.balance.settled.steady
        pull = 0.5 * (steady.starts[i] + steady.ends[i]) - stretch.line_mass * 4.0**2
        added = hill.pressing["top", stretch.strand] * 9.81 * stretch.length
        assert added == pytest.approx(pull * stretch.length / 400.0, rel=1e-5)
        borne = stretch.sets * math.fsum(load.force for load in stretch.loads)
        assert borne == pytest.approx(stretch.line_mass * 9.81 * stretch.length + added, rel=1e-5)
    assert set(hill.pressing) == {("top", "carry"), ("top", "return")}


def test_tension_and_loads_agree_within_the_bound(hill):
    found = hill.convergence
    assert found is not None
    assert found.ratio < 1.0
    assert found.bound <= 1e-6
    fine = curved(HILL, calculation={"rtol": 2e-7})
    finer = run(fine)
    # the contacts' own tolerance comes on top of the bound
    assert hill.balance.tensions.largest == pytest.approx(
        finer.balance.tensions.largest, rel=found.bound + 1e-6
    )
    again = pressing_masses(fine, finer.balance)
    assert finer.pressing == pytest.approx(again, rel=1e-6)


def test_a_hill_costs_a_valley_saves_and_an_endless_radius_does_neither(hill):
    straight = [section | {} for section in HILL]
    del straight[2]["curve"], straight[2]["curve_radius"]
    plain = run(curved(straight))
    assert plain.convergence is None
    indentation = plain.balance.forces.indentation
    assert hill.balance.forces.indentation > indentation
    valley = run(curved([*HILL[:2], HILL[2] | {"curve": "concave", "curve_radius": "1500 m"}, HILL[3]]))
    assert valley.balance.forces.indentation < indentation
    far = run(curved([*HILL[:2], HILL[2] | {"curve_radius": "100 km"}, HILL[3]]))
    # the difference goes with 1/r: 400 m over 100 km of the hill's, tolerance of the contacts beside
    extra = (hill.balance.forces.indentation - indentation) * 400.0 / 100e3
    assert far.balance.forces.indentation - indentation == pytest.approx(
        extra, rel=0.1, abs=2e-6 * indentation
    )


def test_a_relieved_belt_keeps_the_sum_of_its_loads():
    assert roll_masses(20.0, 80.0, -5.0, where="dip") == (15.0, 80.0)
    assert roll_masses(20.0, 80.0, -30.0, where="dip") == (0.0, 70.0)
    assert roll_masses(20.0, 80.0, 7.0, where="dip") == (27.0, 80.0)
    with pytest.raises(NoSolutionError, match=r"the belt lifts off in dip: .*choose a larger curve_radius"):
        roll_masses(20.0, 0.0, -20.0, where="dip")
    assert stretches(curved(VALLEY), {("dip", "carry"): -30.0})[1].bulk_mass > 0.0


def test_a_sharp_valley_lifts_the_belt_and_says_so():
    sharp = [VALLEY[0], VALLEY[1] | {"curve_radius": "30 m"}, VALLEY[2]]
    with pytest.raises(NoSolutionError, match=r"the belt lifts off in section \"dip\", (carry|return): "):
        run(curved(sharp))


def test_least_radii_are_those_of_the_laws():
    made = curved(VALLEY)
    found = balance(made, forced(made))
    checks = {(c.section, c.strand): c for c in belt_duty(made, found).curves}
    carry, back = checks["dip", "carry"], checks["dip", "return"]
    assert carry.lift_off == pytest.approx(carry.highest / (20.0 * 9.81), rel=1e-14)
    # flat return belt: no strip is longer than another
    assert (back.overstress, back.buckling) == (0.0, 0.0)
    wing, sine = (1.0 - 0.38) / 2.0, math.sin(math.radians(35.0))
    middle, edge = wing**2 * sine, wing * sine - wing**2 * sine
    stiffness = 72.0 * 2000e3
    assert carry.overstress == pytest.approx(stiffness * middle / (2000e3 / 6.7 - carry.highest), rel=1e-12)
    assert carry.buckling == pytest.approx(stiffness * edge / (carry.lowest - LEAST_EDGE_TENSION), rel=1e-12)
    tight = curved([VALLEY[0], VALLEY[1] | {"curve_radius": "60 m"}, VALLEY[2]])
    results = forced(tight)
    told = [w for w in loop_warnings(tight, results, balance(tight, results)) if 'section "dip"' in w]
    assert any("carry: the empty belt lifts off on the concave curve of 60 m; at least" in w for w in told)
    assert any("carry: a strip of the belt goes slack" in w for w in told)


def test_safety_and_diameters():
    changes = data()
    changes["belt"]["carcass"] |= {"splice_strength": "45 %", "duty": "unfavourable", "strength": "630 N/mm"}
    changes["route"]["pulleys"][0] |= {"diameter": "630 mm", "shaft_diameter": "100 mm"}
    made = from_data(changes)
    results = forced(made)
    found = balance(made, results)
    duty = belt_duty(made, found)
    steady = max(point.tension for point in found.points)
    assert duty.largest_steady == pytest.approx(steady, rel=1e-14)
    assert duty.safety_steady == pytest.approx(630e3 / steady, rel=1e-14)
    assert duty.strength_needed == pytest.approx(steady * 1.1 * 1.9 / 0.45, rel=1e-14)
    assert duty.drive_diameter == pytest.approx(145 * 0.005, rel=1e-14)
    groups = {
        pulley.name: (pulley.group, round(1e3 * pulley.least, 2), pulley.large_enough)
        for pulley in duty.pulleys
    }
    assert groups == {
        "head": ("A", 725.0, False), "bend": ("B", 580.0, True), "tail": ("B", 580.0, True),
        "snub": ("C", 456.75, True),
    }  # fmt: skip
    told = list(loop_warnings(made, results, found))
    assert any(w.startswith('pulley "head" is 630 mm in diameter, the carcass asks for 725 mm') for w in told)
    assert any(w.startswith("the splice asks for a belt of") for w in told) == (duty.strength_needed > 630e3)


@pytest.mark.parametrize("name", ["shuttle", "downhill_brakes"])
def test_examples_with_tables(name):
    done = conveyor.analyse(conveyor.load(SPECS / f"{name}.yaml"))
    found, made, duty = done.balance, done.conveyor, done.belt_duty
    tables = {key: table.frame() for key, table in done.tables.items()}
    assert not [w for w in done.warnings if "lifts off" in w or "does not stop" in w or "asks for" in w]
    drives = tables["drives"]
    steady = drives[drives["state"] == "steady"]
    assert steady["force [N]"].sum() == pytest.approx(found.forces.total, rel=1e-12)
    assert steady["motor power at full speed [kW]"].sum() == pytest.approx(found.power.motor / 1e3, rel=1e-12)
    assert (drives["tension ratio [-]"] <= drives["grip limit [-]"]).all()
    states = tables["tension_states"]
    assert len(states) == 4 * len(made.route.sections)
    assert (states["steady [N]"] >= states["least for sag [N]"]).all()
    assert (tables["tension_conditions"]["margin [N]"] >= -1e-6).all()
    take_up = {row.key: row.value for row in done.tables["take_up"].rows}
    assert take_up["take_up_setting"] == found.settled.setting
    assert "pulleys" not in tables or tables["pulleys"]["large enough"].all()
    curves = 2 * sum(s.curve is not None for s in made.route.sections)
    assert len(tables.get("vertical_curves", ())) == curves
    assert "convergence" not in tables or (tables["convergence"]["value"] >= 0.0).all()
    profile = tables["profile"]
    assert profile["height [m]"].iloc[-1] == pytest.approx(made.route.rise, rel=1e-12, abs=1e-12)
    assert profile["horizontal [m]"].iloc[-1] <= made.route.length
    for figure in (done.plots.profile(system="SI"), done.plots.tensions(system="SI")):
        assert figure.axes[0].lines
    lines = {line.get_label(): line for line in done.plots.tensions(system="SI").axes[0].lines}
    assert 1e3 * lines["steady"].get_ydata()[1:-1] == pytest.approx(
        states["steady [N]"].to_numpy(), rel=1e-12
    )
    told = done.to_dict()
    assert math.fsum(d["force_N"] for d in told["drives"]) == pytest.approx(
        told["forces_N"]["total"], rel=1e-12
    )
    assert told["take_up"]["setting_N"] >= told["take_up"]["least_setting_N"] * (1.0 - 1e-12)
    assert "moving mass [kg]" in tables["start_stop"]["quantity"].tolist()
    strength = {row.key: row.value for row in done.tables["belt_strength"].rows}
    assert strength.get("belt_safety_steady") == duty.safety_steady
