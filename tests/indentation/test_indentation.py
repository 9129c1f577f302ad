"""From a roll's metres and newtons to the dimensionless contact and back, by figures worked out by hand."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import InputError, RangeError
from conveyor.indentation import (
    RollContact,
    indentation_curve,
    indentation_resistance,
    indentation_resistances,
    resolved_relaxation_times,
    to_problem,
)
from conveyor.rubber import PronySeries

# E0/(1-ν²) = 3 MPa/0.75 = 4 MPa; a roll of R = 0.1 m under w = 10 π N/m:
# a = sqrt(4 w R (1-ν²)/(π E0)) = sqrt(4·10·0.1/4e6) = 1 mm,   p0 = 2 w/(π a) = 20 kPa
RIGID = RollContact(
    radius=0.1,
    spacing=1.2,
    cover_thickness=6e-3,
    speed=4.8,
    series=PronySeries(3e6, [], []),
    support="half-space",
)
LOAD = 10.0 * np.pi
HERTZ = 1e-4
"""Hertz's parabola and lone roll, against the circle, (a/R)²/8 of them, and rolls 1.2 m apart, (2 π a/λ)²."""

LOSSY = RollContact(radius=0.08, spacing=1.2, cover_thickness=6e-3, speed=4.8, series=PronySeries(8e6, [4e6], [1e-3]))


@pytest.mark.parametrize(("load", "wider"), [(LOAD, 1.0), (4.0 * LOAD, 2.0)])
def test_an_elastic_half_space_is_that_of_hertz(load, wider):
    curve = indentation_curve(RIGID, 0.5 * LOAD, 8.0 * LOAD)
    for one in (curve.at(load), indentation_resistance(RIGID, load)):
        assert one.half_width == pytest.approx(1e-3 * wider, rel=HERTZ)
        assert one.peak_pressure == pytest.approx(20e3 * wider, rel=HERTZ)
        assert one.line_load == pytest.approx(load, rel=1e-15)
        assert one.resistance == pytest.approx(0.0, abs=1e-9 * load)
        assert one.eccentricity == pytest.approx(0.0, abs=1e-9)


def test_the_problem_of_a_roll_by_hand():
    # k = 2 π/1.2 = 5.235988 1/m, p̃_m = 0.75·2000/(π 8e6·0.08) = 7.460388e-4, k h = 0.03141593
    problem = to_problem(LOSSY, 2000.0)
    assert problem.radius == pytest.approx(0.08 / 1.2, rel=1e-14)
    assert problem.pressure == pytest.approx(7.460388e-4, rel=1e-6)
    assert problem.thickness == pytest.approx(0.03141593, rel=1e-6)
    # one term: E∞ = 12 MPa, j∞ = 8/12, retardation time τ E∞/E0 = 1.5 ms, ζ = 4.8·1.5e-3·5.235988
    assert problem.creep.instantaneous == pytest.approx(2.0 / 3.0, rel=1e-12)
    assert problem.creep.weights == pytest.approx([1.0 / 3.0], rel=1e-12)
    assert problem.creep.times == pytest.approx([0.03769911], rel=1e-6)


def test_the_mean_pressure_is_within_the_peak():
    # half an ellipse of pressure, of peak p0 over 2 a, holds w = (π/2) a p0; a lossy one leans but keeps near it
    curve = indentation_curve(LOSSY, 500.0, 2000.0)
    loads = np.array([500.0, 1000.0, 2000.0])
    along = curve.at(loads)
    for k, load in enumerate(loads):
        alone = indentation_resistance(LOSSY, float(load))
        for name in ("resistance", "half_width", "eccentricity", "penetration", "peak_pressure"):
            assert getattr(along, name)[k] == pytest.approx(float(getattr(alone, name)), rel=1e-5), name
    assert curve.resistance(loads) == pytest.approx(along.resistance, rel=1e-12)


def test_harmonic_m_of_the_rolls_passes_m_times_a_second_at_one_spacing_a_second():
    # 4.8 m/s over rolls 1.2 m apart: four rolls a second, harmonic m passes at 4 m Hz
    curve = indentation_curve(LOSSY, 500.0, 2000.0)
    assert curve.slowest_excited == pytest.approx(4.0 * curve.curve.excitation_widest[0], rel=1e-12)
    assert curve.fastest_excited == pytest.approx(4.0 * curve.curve.excitation_narrowest[-1], rel=1e-12)
    # a contact of half width a is passed in 2 a/V: its losses lie about V/(2 a)
    passed = 4.8 / (2.0 * float(curve.at(2000.0).half_width))
    assert curve.slowest_excited < passed < curve.fastest_excited


def test_a_rubber_without_loss_excites_nothing():
    curve = indentation_curve(RIGID, LOAD, 2.0 * LOAD)
    assert (curve.slowest_excited, curve.fastest_excited) == (None, None)


@pytest.mark.parametrize(("at", "speed", "load"), [(263.15, 1.0, 300.0), (293.15, 6.0, 3000.0)])
def test_terms_that_a_roll_does_not_tell_apart_change_no_more_than_allowed(at, speed, load):
    rubber = shelf.compound("standard-cover").series(at)
    roll = RollContact(radius=0.0795, spacing=1.2, cover_thickness=8e-3, speed=speed, series=rubber)
    errors = (1e-3, 1e-5)
    rolls = [roll, *(less(roll, load, error) for error in errors)]
    whole, *merged = indentation_resistances(rolls, [load] * 3, 1e-7)
    for value, error in zip(merged, errors, strict=True):
        # either side makes at most so much
        assert 1e-7 < abs(value / whole - 1.0) < 2.0 * error


def less(roll, load, error):
    """The roll on its cover of fewer terms."""
    fastest, slowest = resolved_relaxation_times(roll, load, error)
    fewer = roll.series.merged(fastest=fastest, slowest=slowest)
    assert fewer.times.size < roll.series.times.size - 8
    return replace(roll, series=fewer)


def test_loads_outside_a_curve_are_refused_in_newtons():
    rubber = PronySeries(4e6, np.array([1e6]), np.array([1e-3]))
    contact = RollContact(
        radius=0.0795,
        spacing=1.5,
        cover_thickness=0.005,
        speed=5.0,
        series=rubber,
        poisson=0.5,
        support="confined",
    )
    curve = indentation_curve(contact, 500.0, 4000.0)
    for ask in (curve.resistance, curve.at, curve.penetration):
        with pytest.raises(
            RangeError, match=r"from 600 N/m to 8000 N/m: the curve was solved from 500 N/m to 4000 N/m"
        ):
            ask([600.0, 8000.0])
        ask([500.0, 4000.0])


def test_a_cover_in_millimetres_is_refused():
    with pytest.raises(InputError, match=r"cover_thickness = 5 m is more than spacing = 1\.2 m: both are in metres"):
        replace(RIGID, support="confined", cover_thickness=5.0)
    assert replace(RIGID, support="half-space", cover_thickness=5.0).cover_thickness > RIGID.spacing


@pytest.mark.parametrize("words", ["80 mm", [0.08], None])
def test_what_is_no_number_is_refused_by_its_name(words):
    rubber = shelf.compound("s100").series(293.15)
    with pytest.raises(InputError, match=re.escape(f"radius: got {words!r}, allowed: a number without a unit")):
        RollContact(words, 1.5, 0.005, 5.0, rubber)
    with pytest.raises(InputError, match=re.escape(f"temperature: got {words!r}, allowed: a number without")):
        shelf.compound("s100").series(words)
