"""Four and five rolls: the belt's polygon integrated, limits to sets of fewer rolls, potential energy of its drift."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from conveyor.errors import InputError
from conveyor.laws import horizontal_curve as curve
from conveyor.laws import transition, vertical_curve
from conveyor.laws.loading import (
    RollLoad,
    Wing,
    cross_section,
    filled_width,
    roll_angles,
    shares_by_area,
    wing_pieces,
)

ROUNDING = 1e-12
WIDTH, ROLL, INNER, OUTER = 1.6, 0.36, math.radians(25), math.radians(55)
SLOPE = math.radians(20)
GARLAND = {"middle_roll_length": ROLL, "trough_angle": OUTER, "inner_wing": Wing(ROLL, INNER)}
PAIRS = {"middle_roll_length": 0.0, "trough_angle": OUTER, "inner_wing": Wing(0.46, INNER)}
SETS = pytest.mark.parametrize("given", [GARLAND, PAIRS])


def _place(given, s):
    """Across and up, of the belt at s from its middle along it."""
    x, y = min(s, 0.5 * given["middle_roll_length"]), 0.0
    s -= x
    for length, angle in ((given["inner_wing"].length, INNER), (math.inf, OUTER)):
        on = min(s, length)
        x, y, s = x + on * math.cos(angle), y + on * math.sin(angle), s - on
    return x, y


def _mean(of, n=4000):
    """Over half the belt; the kinks of the polygon leave the square of a step."""
    return math.fsum(of((i + 0.5) * 0.5 * WIDTH / n) for i in range(n)) / n


@SETS
def test_the_cross_section_is_that_of_the_polygon(given):
    """Shoelace from the edge down to the middle; the heap as the standard has it, over the width of the water line."""
    covered, bends = (
        0.5 * 1.35,
        (0.5 * given["middle_roll_length"], 0.5 * given["middle_roll_length"] + given["inner_wing"].length),
    )
    points = [(0.0, 0.0), *(_place(given, s) for s in (*bends, covered))]
    half, depth = points[-1]
    below = math.fsum((x1 - x0) * (depth - 0.5 * (y0 + y1)) for (x0, y0), (x1, y1) in pairwise(points))
    section = cross_section(2.0 * covered, **given, surcharge_angle=SLOPE)
    assert section.bottom == pytest.approx(2.0 * below, rel=ROUNDING)
    assert section.top == pytest.approx((2.0 * half) ** 2 * math.tan(SLOPE) / 6.0, rel=ROUNDING)


@SETS
@pytest.mark.parametrize("width", [0.2, 0.7, 1.1, 1.5])
def test_the_width_under_the_bulk_is_found_again(given, width):
    """On the middle alone, on the inner and on the outer wings."""
    if width < given["middle_roll_length"]:
        area = width**2 * math.tan(SLOPE) / 6.0
    else:
        area = cross_section(width, **given, surcharge_angle=SLOPE).area
    assert filled_width(area, **given, surcharge_angle=SLOPE) == pytest.approx(width, rel=1e-12)


@SETS
@pytest.mark.parametrize("heap", ["parabola", "triangle"])
def test_shares_by_area_add_up_and_reach_as_far_as_the_bulk(given, heap):
    whole = shares_by_area(1.35, **given, surcharge_angle=SLOPE, heap=heap)
    assert whole[0] + 2.0 * math.fsum(whole[1:]) == pytest.approx(1.0, rel=ROUNDING)
    assert len(whole) == 3
    little = shares_by_area(0.8, **given, surcharge_angle=SLOPE, heap=heap)
    assert len(little) == 2
    assert little[0] + 2.0 * little[1] == pytest.approx(1.0, rel=ROUNDING)


def test_rolls_in_line_are_the_set_of_fewer_rolls():
    """Inner wings of the outer angle are part of the wing, level ones part of the middle."""
    wing = {"middle_roll_length": ROLL, "trough_angle": OUTER}
    flat = {"middle_roll_length": 3.0 * ROLL, "trough_angle": OUTER}
    for fewer, inner in ((wing, Wing(ROLL, OUTER)), (flat, Wing(ROLL, 0.0))):
        more = wing | {"inner_wing": inner}
        for law in (
            lambda given: cross_section(1.45, **given, surcharge_angle=SLOPE).area,
            lambda given: filled_width(0.3, **given, surcharge_angle=SLOPE),
            lambda given: vertical_curve.trough_section(WIDTH, **given).edge_above,
            lambda given: vertical_curve.trough_section(WIDTH, **given).middle_below,
            lambda given: curve.half_span(WIDTH, **given),
            *(
                lambda given, of=of: getattr(transition.transition_stretch(WIDTH, **given, pulley_height=0.6), of)
                for of in ("edge", "middle", "least")
            ),
        ):
            assert law(more) == pytest.approx(law(fewer), rel=ROUNDING)
    pushes = curve.outward_force_factors(
        (0.1, 0.2, 0.3, 0.2, -0.1), trough_angle=OUTER, banking_angle=0.1, inner_angle=OUTER
    )
    three = curve.outward_force_factors((0.1, 0.3, -0.1), trough_angle=OUTER, banking_angle=0.1)
    assert [pushes[0], pushes[2], pushes[4]] == pytest.approx(three, rel=ROUNDING)


@SETS
def test_heights_and_span_of_the_polygon(given):
    section, mean = vertical_curve.trough_section(WIDTH, **given), _mean(lambda s: _place(given, s)[1])
    x, y = _place(given, 0.5 * WIDTH)
    assert section.middle_below == pytest.approx(mean, rel=1e-6)
    assert section.edge_above == pytest.approx(y - mean, rel=1e-6)
    assert curve.half_span(WIDTH, **given) == pytest.approx(x, rel=ROUNDING)


@SETS
@pytest.mark.parametrize("height", [0.0, 0.5, 1.0])
def test_strips_of_a_transition_go_straight_from_pulley_to_polygon(given, height):
    """ε L² is half the square of the way across and up, to first order; of every strip, against their mean."""
    raised = height * _place(given, 0.5 * WIDTH)[1]

    def stretch(s):
        x, y = _place(given, s)
        return 0.5 * ((s - x) ** 2 + (y - raised) ** 2)

    mean, found = _mean(stretch), transition.transition_stretch(WIDTH, **given, pulley_height=height)
    scale = 1e-6 * stretch(0.5 * WIDTH) + 1e-9
    assert found.edge == pytest.approx(stretch(0.5 * WIDTH) - mean, abs=scale)
    assert found.middle == pytest.approx(stretch(0.0) - mean, abs=scale)
    # sampled at 1/1000 of the belt: the least is a parabola's
    least = min(stretch(0.5 * WIDTH * i / 1000) for i in range(1001)) - mean
    assert found.least == pytest.approx(least, abs=1e-5)
    assert found.least <= least + scale


@SETS
@pytest.mark.parametrize("drift", [-0.2, 0.05, 0.25])
def test_without_friction_the_force_is_the_slope_of_the_potential_energy(given, drift):
    """w times the difference of the edges' heights (Leibniz), of a polygon banked as a whole."""
    banking, rolls = math.radians(4), 5 if given is GARLAND else 4
    angles = roll_angles(rolls, trough_angle=OUTER, inner_angle=INNER)
    half = [wing.length for wing in wing_pieces(WIDTH, **given)]
    middle = given["middle_roll_length"]
    lengths = [*reversed(half), *([middle] if middle else []), *half]
    loads = [RollLoad("", 0.0, 250.0 * length, length, "uniform") for length in lengths]

    def height(place):
        x, y = _place(given, abs(place))
        return y * math.cos(banking) + math.copysign(x, place) * math.sin(banking)

    pushes = curve.outward_force_factors((0.0,) * rolls, trough_angle=OUTER, banking_angle=banking, inner_angle=INNER)
    assert pushes == pytest.approx([math.sin(angle + banking) for angle in angles], rel=ROUNDING)
    edges = height(0.5 * WIDTH + drift) - height(-0.5 * WIDTH + drift)
    law = curve.DriftLaw.of(loads, pushes)
    assert law.force(drift) == pytest.approx(250.0 * edges, rel=1e-11)
    assert law.drift(law.force(drift)) == pytest.approx(drift, rel=1e-9)
    moved = curve.drifted_loads(loads, drift, roll_length=10.0)
    assert math.fsum(load.force for load in moved) == pytest.approx(250.0 * WIDTH, rel=ROUNDING)


def test_a_wing_presses_on_every_roll_that_it_slides_toward():
    """sin λ of its weight comes along the belt to a bend of 30 deg, and to one of 25 before the middle."""
    for at, bend in ((1, OUTER - INNER), (2, INNER)):
        frictions = [0.0] * 5
        frictions[at] = 0.2
        pushes = curve.outward_force_factors(frictions, trough_angle=OUTER, banking_angle=0.0, inner_angle=INNER)
        assert pushes[0] == pytest.approx(math.sin(OUTER) * (1.0 + 0.2 * math.sin(bend)), rel=ROUNDING)
        outside = -math.sin(OUTER) * (1.0 - (0.2 * math.sin(bend) if at == 2 else 0.0))
        assert pushes[4] == pytest.approx(outside, rel=ROUNDING)


def test_refusals():
    with pytest.raises(InputError, match="inner_wing_angle: got 2"):
        wing_pieces(1.0, middle_roll_length=0.2, trough_angle=0.5, inner_wing=Wing(0.2, 2.0))
    with pytest.raises(InputError, match=r"inner_angle: got 0\.6"):
        curve.outward_force_factors((0.0,) * 4, trough_angle=0.5, banking_angle=0.0, inner_angle=0.6)
    with pytest.raises(InputError, match="rolls: got 6"):
        roll_angles(6, trough_angle=0.5)
