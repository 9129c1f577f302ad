"""Figures beside the loop, worked out by hand from the masses of one conveyor."""

from __future__ import annotations

import math

import pytest

from tests.loop.loop_lines import BOOSTER, balanced

# 20 kg/m² of 1 m: 20 kg/m; 1200 t/h at 4 m/s: 83.33 kg/m; rolls 3·4 kg/1.2 m and 9 kg/3 m: 10 and 3 kg/m
BELT, BULK, ROLLS, GRAVITY = 20.0, 1200.0 / 3.6 / 4.0, 13.0, 9.81
SECTIONS = ((120.0, 0.0), (400.0, 25.0), (300.0, -8.0), (180.0, 6.0))


def test_the_classical_estimate_is_that_of_din_22101():
    one = balanced()
    found = one.classical
    # F_H = f g Σ l (m'_R + (2 m'_belt + m'_bulk) cos δ), f 0.02; C is 1.09 at 1000 m
    weights = [length * (ROLLS + (2.0 * BELT + BULK) * math.cos(math.asin(rise / length))) for length, rise in SECTIONS]
    main = 0.02 * GRAVITY * sum(weights)
    assert main == pytest.approx(26.7e3, rel=5e-3)
    assert found.main == pytest.approx(main, rel=1e-12)
    assert found.secondary == pytest.approx(0.09 * main, rel=1e-11)
    assert found.lift == pytest.approx(BULK * GRAVITY * 23.0, rel=1e-12)
    assert found.special == pytest.approx(one.forces.special, rel=1e-12)
    total = 1.09 * main + one.forces.special + BULK * GRAVITY * 23.0
    assert found.total == pytest.approx(total, rel=1e-12)
    assert one.layout.motor(found.total) == pytest.approx(total * 4.0 / 0.94, rel=1e-12)


def test_beyond_the_table_of_c_the_secondary_resistances_are_itemised():
    long = [{"name": "a", "length": "5100 m"}, {"name": "c", "length": "100 m"}]
    one = balanced(route={"sections": long})
    assert one.classical.secondary == pytest.approx(one.forces.secondary, rel=1e-12)
    short = [{"name": "a", "length": "4900 m"}, {"name": "c", "length": "100 m"}]
    # C is 1.03 at 5000 m, the last of the table
    one = balanced(route={"sections": short})
    assert one.classical.secondary == pytest.approx(0.03 * one.classical.main, rel=1e-11)


def test_pulleys_of_cema_but_the_driven_ones():
    cema = {"cema": {"flexure_factor": 0.02, "idler_friction": "1.5 lbf"}}
    # bend at the take-up and tail on the slack side, 150 lbf each; the snub wraps little, 100 lbf; the head is driven
    pulleys = (150.0 + 150.0 + 100.0) * 4.4482216152605
    # 1200 t/h from 1 to 4 m/s: Tam = 2.8755e-4 (short tons an hour) (ft/min)
    bulk = 2.8755e-4 * (1200e3 / 907.18474) * (3.0 / 0.00508) * 4.4482216152605
    assert balanced(calculation=cema).cema.secondary == pytest.approx(pulleys + bulk, rel=1e-9)
    # at the tail the tail is driven, and the head counts 200 lbf, on the tight side
    found = balanced(calculation=cema, drive={"position": "tail"}).cema.secondary
    assert found == pytest.approx(pulleys + 50.0 * 4.4482216152605 + bulk, rel=1e-9)


def test_bearings_of_a_pulley_at_its_tensions():
    found = balanced()
    (turn,) = [single for single in found.singles if single.name == "bearings, tail"]
    # 0.005 (d0/D) sqrt((T1 + T2)² + (m g)²): a shaft of 160 in 800 mm, 1 t; both strands have the tail's tension
    return_end = found.equilibrium.steady.ends[len(SECTIONS) - 1]
    load = math.hypot(2.0 * return_end, 1000.0 * GRAVITY)
    assert turn.newtons == pytest.approx(0.005 * 0.2 * load, rel=1e-9)
    names = {single.name for single in found.singles if single.name.startswith("bearings")}
    assert names == {"bearings, bend", "bearings, tail", "bearings, snub"}  # the head's are the drive's


def test_a_booster_takes_its_force_out_behind_its_section():
    found = balanced(drive={"further_drives": [BOOSTER]})
    steady = found.equilibrium.steady
    (side,) = [drive for drive in steady.drives if drive.name == "booster"]
    # return d, c, b, a, carry a, b, c, d: the booster stands behind b, between the sixth stretch and the seventh
    steps = steady.starts[5:8] - steady.ends[4:7]
    assert steps == pytest.approx([0.0, -side.force, 0.0], abs=1e-9 * side.tight)
    assert side.force > 0.0
