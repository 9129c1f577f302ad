"""Pulleys that stand in where a route has none: their places, diameters, wraps and resistances."""

from __future__ import annotations

import math

import pytest

from conveyor import load
from conveyor.default_bands import power_range
from conveyor.laws.resistance.cema import POUND_FORCE
from conveyor.line.line import Line
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from tests.loop.loop_lines import SPECS, TAIL_DRIVE, balanced, line

LEAST = 145 * 0.005
"""Least diameter of a drive pulley by DIN 22101 for the 5 mm of steel cord of the plain line [m]."""


def bare(**route):
    return {"pulleys": []} | route


def test_usual_pulleys_at_a_drive_have_its_diameter():
    at_head = Line.of(line(route=bare(), drive={"pulley_diameter": "1 m"}))
    assert [pulley.diameter for pulley in at_head.pulleys] == pytest.approx([1.0, LEAST])
    assert at_head.pulleys[0].shaft_diameter == pytest.approx(0.2)
    second = TAIL_DRIVE | {"pulley_diameter": "1.25 m"}
    at_tail = Line.of(line(route=bare(), drive={"further_drives": [second]}))
    assert [pulley.diameter for pulley in at_tail.pulleys] == pytest.approx([LEAST, 1.25])


def test_a_larger_drive_pulley_wraps_more_easily():
    """DIN 22101: wrap resistance is inverse to the diameter, at the same tensions but for what it changes itself."""
    small, large = (
        next(force.total for force in balanced(route=bare(), drive=drive).singles if force.name == "wrap, head")
        for drive in ({}, {"pulley_diameter": "1.45 m"})
    )
    assert large == pytest.approx(0.5 * small, rel=0.01)


@pytest.mark.parametrize(("kind", "position"), [("gravity", "drive"), ("winch", "head"), ("locked winch", "head")])
def test_a_take_up_in_the_loop_brings_its_pulley_and_two_bends(kind, position):
    found = Line.of(line(route=bare(take_up={"kind": kind, "position": position})))
    assert [pulley.name for pulley in found.pulleys] == ["head", "bend 1", "take-up", "bend 2", "tail"]
    of_take_up = found.pulleys[1:-1]
    assert all(pulley.assumed and pulley.position == "take-up" for pulley in of_take_up)
    assert [math.degrees(pulley.wrap_angle) for pulley in of_take_up] == pytest.approx([90.0, 180.0, 90.0])
    assert [pulley.diameter for pulley in of_take_up] == pytest.approx([0.8 * LEAST] * 3)  # group B of DIN 22101


@pytest.mark.parametrize(
    "take_up", [None, {"kind": "screw"}, {"kind": "fixed"}, {"kind": "gravity", "position": "tail"}]
)
def test_a_take_up_that_moves_the_tail_pulley_has_none_of_its_own(take_up):
    found = Line.of(line(route=bare(take_up=take_up)))
    assert [pulley.name for pulley in found.pulleys] == ["head", "tail"]


def test_usual_take_up_pulleys_resist_as_given_ones():
    """ISO 5048 by wrap and bearings, and the tensions round the loop: as the same massless pulleys in the spec."""
    take_up = {"kind": "gravity", "position": "head"}
    usual = balanced(route=bare(take_up=take_up))
    listed = [
        {"name": pulley.name, "position": pulley.position, "mass": "0 kg"}
        | {name: f"{getattr(pulley, name)!r} m" for name in ("diameter", "shaft_diameter")}
        | {"wrap_angle": f"{math.degrees(pulley.wrap_angle)!r} deg"}
        for pulley in usual.line.pulleys
    ]
    given = balanced(route=bare(take_up=take_up, pulleys=listed))
    assert usual.forces.secondary == pytest.approx(given.forces.secondary, rel=1e-9)
    assert usual.equilibrium.setting == pytest.approx(given.equilibrium.setting, rel=1e-9)
    plain = {force.name for force in balanced(route=bare(take_up={"kind": "screw"})).singles}
    added = {force.name: force.total for force in usual.singles if force.name not in plain}
    assert added.keys() == {
        f"{what}, {name}" for what in ("wrap", "bearings") for name in ("bend 1", "take-up", "bend 2")
    }
    assert min(added.values()) > 0.0


def test_usual_take_up_pulleys_resist_by_cema():
    """150 lbf at tail and take-up, 100 lbf at a bend of less than 150 deg."""
    cema = {"flexure_factor": 0.03, "temperature_factor": 1.0, "idler_friction": "1 lbf"}
    by_cema = {"method": "cema classic", "cema": cema}
    found = balanced(route=bare(take_up={"kind": "gravity"}), calculation=by_cema)
    pulleys = {force.name: force.total / POUND_FORCE for force in found.singles if force.key == "Tp"}
    assert pulleys == pytest.approx({"Tp, bend 1": 100.0, "Tp, take-up": 150.0, "Tp, bend 2": 100.0, "Tp, tail": 150.0})


def test_the_band_of_usual_pulleys_takes_those_of_the_take_up():
    given = load(SPECS / "downhill.yaml")
    given = given.replace(
        route=given.route.replace(take_up={"kind": "gravity", "position": "head"}),
        calculation=given.calculation.replace(rtol=1e-3),
    )
    found = calculate(given)
    usual = sum(force.total for force in found.balance.singles if force.key in {"wrap", "pulley_bearings"})
    band = next(one for one in power_range(found).effects if one.key == "pulleys")
    assert len(found.line.pulleys) == 5
    low = found.balance.power.motor - band.motor_low
    efficiency = found.line.regeneration  # downhill
    assert abs(low) == pytest.approx((1.0 - band.low_factor) * usual * found.line.speed * efficiency, rel=1e-9)
    (told,) = (remark for remark in analysis_warnings(found, []) if "route.pulleys not given" in remark.text())
    assert "at the take-up a pulley and two bends of" in told.text()
