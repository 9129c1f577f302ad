"""Compounds: series at a temperature, laws, what is refused and where."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from conveyor.errors import InputError, RangeError, SpecError
from conveyor.models import Cover, RubberCompound


def test_series_at_the_reference_is_the_file(compound_data: dict[str, Any]) -> None:
    series = RubberCompound.model_validate(compound_data).series(293.15)
    assert series.equilibrium == 4e6
    np.testing.assert_array_equal(series.moduli, [2e6, 1e6])
    np.testing.assert_array_equal(series.times, [1e-3, 1.0])


def test_table_shift_moves_every_time_by_its_decades(compound_data: dict[str, Any]) -> None:
    compound = RubberCompound.model_validate(compound_data)
    cold = compound.series(263.15)
    # 10**3.0 and the product round once each.
    np.testing.assert_allclose(cold.times, [1.0, 1000.0], rtol=1e-15)
    np.testing.assert_array_equal(cold.moduli, [2e6, 1e6])
    with pytest.raises(RangeError, match="outside the shift table"):
        compound.series(263.14)


def test_wlf_shift(compound_data: dict[str, Any]) -> None:
    compound_data["shift"] = {"law": "wlf", "c1": 8.86, "c2": "101.6 K"}
    warm = RubberCompound.model_validate(compound_data).series(293.15 + 101.6)
    # At T - T_ref = c2 the law gives -c1/2 decades; 1e-13 relative in T costs as much in the exponent.
    np.testing.assert_allclose(warm.times, np.array([1e-3, 1.0]) * 10**-4.43, rtol=1e-11)


def test_wlf_difference_in_fahrenheit_is_the_same(compound_data: dict[str, Any]) -> None:
    compound_data["shift"] = {"law": "wlf", "c1": 8.86, "c2": "90 K"}
    metric = RubberCompound.model_validate(compound_data)
    compound_data["shift"]["c2"] = "162 delta_degF"
    us = RubberCompound.model_validate(compound_data)
    np.testing.assert_allclose(us.series(313.15).times, metric.series(313.15).times, rtol=1e-13)


def test_arrhenius_shift(compound_data: dict[str, Any]) -> None:
    compound_data["shift"] = {"law": "arrhenius", "activation_energy": "120 kJ/mol"}
    cold = RubberCompound.model_validate(compound_data).series(283.15)
    # R = 8.31446261815324 J/(mol K), exact in the SI of 2019.
    expected = math.exp(120e3 / 8.31446261815324 * (1 / 283.15 - 1 / 293.15))
    # SciPy before 1.15 has R to ten digits, 2e-11 off, times the exponent of 1.7
    assert cold.times[1] == pytest.approx(expected, rel=5e-11)


def test_without_shift_only_the_reference(compound_data: dict[str, Any]) -> None:
    del compound_data["shift"]
    compound = RubberCompound.model_validate(compound_data)
    assert compound.shift_law() is None
    assert compound.series(293.15).equilibrium == 4e6
    with pytest.raises(RangeError, match='"test rubber" has no temperature shift: it is known at 20 degC only'):
        compound.series(294.15)


def test_reference_may_be_given_in_fahrenheit(compound_data: dict[str, Any]) -> None:
    del compound_data["shift"]
    compound_data["reference_temperature"] = "68 degF"
    assert RubberCompound.model_validate(compound_data).series(293.15).equilibrium == 4e6


REFUSED = [
    (("poisson_ratio",), 0.6, r"poisson_ratio: .*got 0.6, allowed: <= 0.5"),
    (("kind",), "guessed", r"kind: .*'measured' or 'illustrative'"),
    (("prony", "equilibrium"), "0 MPa", r"prony\.equilibrium: .*got 0 MPa, allowed: > 0 MPa"),
    (("prony", "equilibrium"), "4 mm", r"prony\.equilibrium: .*expected a pressure such as"),
    (("prony", "terms", 1, "time"), "-1 s", r"prony\.terms\[1\]\.time: .*allowed: > 0 s"),
    (("prony", "terms", 1, "time"), "1 ms", r"prony: .*times"),
    (("shift", "law"), "magic", r"shift: .*'table', 'wlf', 'arrhenius'"),
    (("shift", "log10_aT"), [3.0, 0.0], r"shift: .*one log10 a_T for each"),
    (("shift", "log10_aT"), [-3.0, 0.0, 2.0], r"shift: .*must fall with rising temperature"),
    (("shift", "log10_aT"), [3.5, 0.5, -2.0], r"shift: .*must be 0"),
    (("reference_temperature",), "80 degC", r"shift: .*outside the shift table"),
    (("range",), {"frequency": ["9 Hz", "1 Hz"], "temperature": ["1 K", "2 K"]}, "lower value first"),
    (("density",), "1100", r"density: .*without a unit"),
]


@pytest.mark.parametrize(("location", "value", "message"), REFUSED)
def test_refused(compound_data: dict[str, Any], location: tuple[Any, ...], value: object, message: str) -> None:
    RubberCompound.model_validate(compound_data)
    inner = compound_data
    for part in location[:-1]:
        inner = inner[part]
    inner[location[-1]] = value
    with pytest.raises(SpecError, match=message):
        RubberCompound.model_validate(compound_data)


def test_stated_range_is_not_left(compound_data: dict[str, Any]) -> None:
    compound_data["shift"] = {"law": "wlf", "c1": 8.86, "c2": "101.6 K"}
    compound_data["range"] = {"frequency": ["1 Hz", "1 kHz"], "temperature": ["0 degC", "40 degC"]}
    compound = RubberCompound.model_validate(compound_data)
    assert compound.series(313.15).times[0] < 1e-3 < compound.series(273.15).times[0]
    for outside in (273.14, 313.16):
        with pytest.raises(RangeError, match=r'"test rubber" is known from 0 degC to 40 degC .*, not at'):
            compound.series(outside)


def test_data_round_trip(compound_data: dict[str, Any]) -> None:
    compound = RubberCompound.model_validate(compound_data)
    assert RubberCompound.model_validate(compound.as_data()) == compound
    assert compound.as_data()["shift"] == {**compound_data["shift"], "log10_aT": [3.0, 0.0, -2.0]}


def test_compound_by_name_needs_a_resolver(compound_data: dict[str, Any]) -> None:
    compound = RubberCompound.model_validate(compound_data)
    data = {"thickness": "5 mm", "compound": "R1"}
    with pytest.raises(SpecError, match=r'"R1": a compound by name needs a shelf'):
        Cover.model_validate(data)
    cover = Cover.model_validate(data, context={"compound": {"R1": compound}.__getitem__})
    assert cover.compound is compound

    def unknown(name: str) -> RubberCompound:
        raise InputError(f"no {name} here")

    with pytest.raises(SpecError, match=r"compound: .*no R1 here"):
        Cover.model_validate(data, context={"compound": unknown})
