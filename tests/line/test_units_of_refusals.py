"""Refusals and errors of a spec tell their figures in the units of its reports; those of SI as the laws write them."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable
from typing import Any, NamedTuple

import pytest

from conveyor import shelf
from conveyor.calculated_conveyor import Variant
from conveyor.errors import ConveyorError, InputError, MessageQuantity, NoSolutionError, RangeError
from conveyor.indentation import RollContact
from conveyor.line.belt_contacts import _accept_interpolation
from conveyor.pipeline import calculate, calculate_many
from conveyor.rubber import PronySeries
from conveyor.spec import from_data
from conveyor.units import is_kind, quantity, si
from conveyor.units.sentences import error_in_units, message
from tests.line.test_anchors import one_test
from tests.loop.loop_lines import DATA, data, line
from tests.loop.test_curves import PULLEYS, VALLEY
from tests.loop.test_horizontal import BACK, CURVE

ROUNDED = 5e-3
"""Of a figure to three digits, the fewest of any message."""
KELVIN = 0.01
"""Temperatures have two decimals, or six digits."""


def roll(law: dict[str, Any] | None = None, **changes: Any) -> dict[str, Any]:
    """Idlers whose carry roll has a law of drag, or none."""
    idlers: dict[str, Any] = copy.deepcopy(DATA["idlers"])
    del idlers["carry"]["roll"]["drag"]
    idlers["carry"]["roll"] |= ({} if law is None else {"drag_law": law}) | changes
    return idlers


QUICK = {"strain": "off", "flexure_share": "11 %"}
OIL = {"law": "bearing", "mean_diameter": "40 mm", "static_rating": "7 kN", "first_viscosity": "100 mm^2/s",
       "second_viscosity": "11 mm^2/s", "seal_moment": "0.02 N*m"}  # fmt: skip
SLIDING = {"law": "maker", "drag": "2 N", "load": "10 kN", "load_slope": 0.01}
LIFTING = {"sections": [VALLEY[0], VALLEY[1] | {"curve_radius": "30 m"}, VALLEY[2]], "pulleys": PULLEYS}
BENDING = {
    "sections": [{"name": "a", "length": "150 m"}, CURVE | {"horizontal_radius": "150 m"}],
    "pulleys": PULLEYS,
}
WINCH = {"kind": "winch", "position": "tail"}
FLYING = {"sections": [{"name": "a", "length": "5 m"}, {"name": "b", "length": "300 m"}], "pulleys": [],
          "feeding": None, "cleaners": [], "take_up": WINCH | {"tension": "1 kN"}}  # fmt: skip


class Case(NamedTuple):
    """What is refused: the message with {} for its figures, and their units in SI and US."""

    words: str
    si: str
    us: str
    refused: Callable[..., object]


def a_line(**given: Any) -> Callable[..., object]:
    """Refused as it is read."""
    return lambda **more: line(**given, **more)


def a_calculation(**given: Any) -> Callable[..., object]:
    """Refused as it is calculated."""
    return lambda **more: calculate(from_data(data(**given, **more)))


def rubber(name: str, **changes: Any) -> dict[str, Any]:
    """A belt on a changed compound of the shelf."""
    compound = shelf.compound(name).replace(**changes).as_data()
    return {"bottom_cover": {"thickness": "4 mm", "compound": compound}}


CASES = {
    "contact": Case(
        "roll of {} on a {} cover (free), {}: ", "mm mm N/m", "in in lbf/in",
        a_calculation(calculation={"support": "free", "gauss_points": 1}),
    ),
    "span of loads": Case(
        " to {}: the load curve reached", "N/m", "lbf/in", a_calculation(calculation=QUICK | {"rtol": 1e-10}),
    ),
    "CEMA class": Case(
        "no set of 3 roll(s) for a belt of {}; give rating", "m", "in",
        a_line(idlers={"carry": DATA["idlers"]["carry"] | {"cema_class": "D"}}, belt={"width": "360 mm"},
               material={"flow": "50 t/h"}),
    ),
    "maker's line": Case(
        "drag_law: reference_drag: got 2.0, its line gives {} at {} and 9.57323 1/s", "N N", "",
        a_calculation(idlers=roll(SLIDING), calculation=QUICK),
    ),
    "maker's line, US": Case(
        "drag_law: reference_drag: got {}, its line gives -21.52 lbf at 51.61 lbf and {};", "", "lbf rpm",
        a_calculation(idlers=roll(SLIDING), calculation=QUICK),
    ),
    "oil": Case(
        "drag_law: temperature: got {}, allowed: hotter ones: the oil is solid there", "", "degF",
        a_calculation(
            idlers=roll(OIL), calculation=QUICK, ambient={"temperature": "-90 degC", "belt_temperature": "10 degC"}
        ),
    ),
    "small roll": Case(
        "allowed: > {}; give the roll's drag", "m", "in",
        a_calculation(idlers=roll(diameter="30 mm"), calculation=QUICK),
    ),
    "flexure": Case(
        "not known at a tension of {}: m' v² is {};", "N N", "lbf lbf",
        a_calculation(calculation={"flexure": {"belt": {"loss_tangent": 0.2, "tension": "1 kN"}}}),
    ),
    "lift-off": Case(
        "pulls up like {}, belt and bulk are {};", "kg/m kg/m", "lb/ft lb/ft", a_calculation(route=LIFTING)
    ),
    "sharp bend": Case(
        "a horizontal_radius well above {}, or", "m", "ft", a_calculation(idlers=BACK, route=BENDING)
    ),
    "belt that flies": Case(
        'in section "a", carry: T - m\' v² is {};', "N", "lbf",
        a_calculation(
            belt={"speed": "8 m/s"}, route=FLYING,
            calculation={"support": "belt", "strain": "off", "not_given": "nothing"},
        ),
    ),
    "length coefficient": Case(
        "route.sections are {} long together and C holds for more than {};", "m m", "ft ft",
        a_line(route={"sections": [{"name": "a", "length": "60 m"}], "pulleys": []}, calculation={"secondary": "C"}),
    ),
    "overfull": Case(
        "needs a cross-section of {}, the belt holds {} and is calculated up to {}, 150 % of that:",
        "m^2 m^2 m^2", "ft^2 ft^2 ft^2", a_line(material={"flow": "9000 t/h"})
    ),
    "too cold": Case(
        'compound "S100" is known from {} to {} (its range.temperature), not at {};', "degC degC degC",
        "degF degF degF", a_line(ambient={"temperature": "-90 degC"}),
    ),
    "no shift": Case(
        "it is known at {} only, not at {};", "degC degC", "degF degF",
        a_line(belt=rubber("s100", shift=None, range=None, strain_dependence=None, tests=()),
               ambient={"temperature": "10 degC"}),
    ),
    "beyond the table": Case(
        "temperature {} is outside the shift table, {} to {};", "degC degC degC", "degF degF degF",
        a_line(belt=rubber("s100", range=None), ambient={"temperature": "-90 degC"}),
    ),
    "pole of WLF": Case(
        "temperature {} is at or below the pole of the WLF law at {};", "degC degC", "degF degF",
        a_line(belt=rubber("s100", range=None, shift={"law": "wlf", "c1": 8.86, "c2": "70 K"}),
               ambient={"temperature": "-90 degC"}),
    ),
    "tests far from the theory": Case(
        "times the theory at {}, where published ones", "degC", "degF",
        a_calculation(belt=rubber("standard-cover", tests=[one_test((1.0, 200.0))]), calculation={"strain": "off"}),
    ),
}  # fmt: skip


def refusal(case: Case, system: str) -> str:
    with pytest.raises(ConveyorError) as caught:
        case.refused(report={"units": system})
    return str(caught.value)


def figures(case: Case, units: str, message: str) -> list[str]:
    """The figures of a message, each in its unit."""
    of = iter(units.split())
    pattern = re.sub(r"\\\{\\\}", lambda _: rf"(-?[\d.]+ {re.escape(next(of))})", re.escape(case.words))
    found = re.search(pattern, message)
    assert found, message
    return list(found.groups())


@pytest.mark.parametrize("name", CASES)
def test_figures_are_in_the_units_of_the_spec(name: str) -> None:
    case = CASES[name]
    in_si = figures(case, case.si, refusal(case, "SI")) if case.si else []
    in_us = figures(case, case.us, refusal(case, "US")) if case.us else []
    for one, other in zip(in_si, in_us, strict=bool(case.si and case.us)):
        warmth = is_kind(quantity(one), "temperature")
        close = pytest.approx(si(quantity(one)), **({"abs": KELVIN} if warmth else {"rel": ROUNDED}))
        assert si(quantity(other)) == close, (one, other)


def test_variants_side_by_side_have_each_its_own_units() -> None:
    flying = {
        "belt": {"speed": "8 m/s"},
        "route": FLYING,
        "calculation": {"support": "belt", "strain": "off", "not_given": "nothing"},
    }
    both = calculate_many([Variant(line(**flying, report={"units": system})) for system in ("SI", "US")])
    assert [re.search(r" is -[\d.]+ (\w+);", str(one))[1] for one in both] == ["N", "lbf"]  # type: ignore[index]


def test_a_belt_read_between_tensions() -> None:
    """More tensions than any belt here needs: judged as the last."""
    contact = RollContact(
        radius=0.08, spacing=1.2, cover_thickness=5e-3, speed=4.0, series=PronySeries(8e6, [4e6], [1e-3])
    )

    class Curve:
        def __init__(self, factor: float) -> None:
            self.contact, self.factor = contact, factor

        def resistance(self, loads: Any) -> Any:
            return self.factor * loads

    curves: Any = [Curve(1.0 + 9.0 * (i % 2)) for i in range(5)]
    refused = _accept_interpolation(curves, ((100.0, 1000.0), (17512.7, 35025.4)), 1e-4, last=True)
    assert isinstance(refused, NoSolutionError)
    assert "between tensions of 1.751e+04 and 3.503e+04 N/m the" in str(refused)
    assert "between tensions of 100 lbf/in and 200 lbf/in the" in str(error_in_units(refused, "US"))


def test_sizes_that_nothing_has_are_in_the_unit_written() -> None:
    with pytest.raises(InputError, match=r"in size from 1e-09 to 1e\+06 m$"):
        quantity("2000000 km", "length")
    with pytest.raises(InputError, match=r"in size from 3.281e-09 to 3.281e\+06 ft$"):
        quantity("9000000 ft", "length")


def test_errors_of_errors_and_sentences_are_told_too() -> None:
    """Braces of a user's name stay; a worker sends what it was made of."""
    why = RangeError("{} for {}", "a{b}", MessageQuantity(1.0, "power", "1 W"))
    error = InputError("{}: {}; {}", "x", why, message("at {}", (0.3048, "length")))
    assert str(error) == "x: a{b} for 1 W; at 0.305 m"
    for one in (error, pickle.loads(pickle.dumps(error))):  # noqa: S301 made here
        assert str(error_in_units(one, "US")) == "x: a{b} for 0.001341 hp; at 1 ft"
        assert error_in_units(one, "SI") is one
    assert str(error_in_units(error_in_units(error, "US"), "US")) == str(error_in_units(error, "US"))
    assert str(error_in_units(InputError("got {}"), "US")) == "got {}"
