"""The replicas of a compound file: read, shifted like the series, refused where they do not fit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from conveyor.errors import RangeError, SpecError
from conveyor.models import RubberCompound

BAND: dict[str, Any] = {
    "method": "block bootstrap",
    "equilibrium": ["4.1 MPa", "3900 kPa"],
    "unit": "MPa",
    "moduli": [[2.5, 0.5], [0, 1.5]],
}


@pytest.fixture
def banded(compound_data: dict[str, Any]) -> dict[str, Any]:
    compound_data["prony"]["band"] = {**BAND, "moduli": [list(row) for row in BAND["moduli"]]}
    return compound_data


def test_replicas_in_si_at_the_times_of_the_terms(banded: dict[str, Any]) -> None:
    one, two = RubberCompound.model_validate(banded).replicas(293.15)
    np.testing.assert_allclose([one.equilibrium, two.equilibrium], [4.1e6, 3.9e6], rtol=1e-15)
    np.testing.assert_allclose(one.moduli, [2.5e6, 0.5e6], rtol=1e-15)
    np.testing.assert_allclose(one.times, [1e-3, 1.0], rtol=1e-15)
    # a modulus of 0 is a term that this replica does not have
    assert (two.moduli.tolist(), two.times.tolist()) == ([1.5e6], [1.0])


def test_moduli_follow_the_order_of_the_terms(banded: dict[str, Any]) -> None:
    plain = RubberCompound.model_validate(banded).replicas(293.15)
    banded["prony"]["terms"].reverse()
    for row in banded["prony"]["band"]["moduli"]:
        row.reverse()
    for a, b in zip(plain, RubberCompound.model_validate(banded).replicas(293.15), strict=True):
        np.testing.assert_array_equal(a.moduli, b.moduli)
        np.testing.assert_array_equal(a.times, b.times)


@pytest.mark.parametrize(("unit", "factor"), [("Pa", 1e6), ("kPa", 1e3), ("GPa", 1e-3)])
def test_units_scale_out(banded: dict[str, Any], unit: str, factor: float) -> None:
    plain = RubberCompound.model_validate(banded).replicas(293.15)
    rows = banded["prony"]["band"]["moduli"]
    banded["prony"]["band"] |= {"unit": unit, "moduli": [[e * factor for e in row] for row in rows]}
    for a, b in zip(plain, RubberCompound.model_validate(banded).replicas(293.15), strict=True):
        np.testing.assert_allclose(a.moduli, b.moduli, rtol=1e-14)


def test_replicas_shift_like_the_series(banded: dict[str, Any]) -> None:
    compound = RubberCompound.model_validate(banded)
    first = compound.replicas(263.15)[0]
    np.testing.assert_array_equal(first.times, compound.series(263.15).times)
    with pytest.raises(RangeError, match="outside the shift table"):
        compound.replicas(263.14)


def test_replicas_go_with_their_own_shifts(banded: dict[str, Any]) -> None:
    shift = banded["shift"]
    own = [list(shift["log10_aT"]), [2.0 * y for y in shift["log10_aT"]]]
    vertical = [[0.0] * len(own[0]), [0.3 * (y != 0.0) for y in own[0]]]
    banded["prony"]["band"] |= {"log10_aT": own, "log10_bT": vertical}
    compound = RubberCompound.model_validate(banded)
    coldest = 263.15
    one, two = compound.replicas(coldest)
    base = compound.replicas(293.15)
    a = 10.0 ** float(compound.shift_law().log10_a_T(coldest))
    np.testing.assert_allclose(one.times, base[0].times * a, rtol=1e-12)
    np.testing.assert_allclose(two.times, base[1].times * a**2, rtol=1e-12)
    assert two.equilibrium == pytest.approx(base[1].equilibrium * 10.0**0.3, rel=1e-12)
    for alternative, replica in zip(compound.alternatives(), (one, two), strict=True):
        np.testing.assert_allclose(alternative.series(coldest).times, replica.times, rtol=1e-12)
    assert RubberCompound.model_validate(compound.as_data()) == compound


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"log10_aT": [[1.0, 0.0]]}, "got 1 lists for 2 values of equilibrium"),
        ({"log10_aT": [[0.0] * 9] * 2}, "a shift table needs >= 2 temperatures and one log10 a_T for each"),
    ],
)
def test_shifts_of_replicas_that_do_not_fit(banded: dict[str, Any], change: dict[str, Any], message: str) -> None:
    banded["prony"]["band"] |= change
    with pytest.raises(SpecError, match=message):
        RubberCompound.model_validate(banded)


def test_without_shift_or_band(banded: dict[str, Any]) -> None:
    del banded["shift"]
    compound = RubberCompound.model_validate(banded)
    assert len(compound.replicas(293.15)) == 2
    with pytest.raises(RangeError, match="it is known at 20 degC only"):
        compound.replicas(294.15)
    del banded["prony"]["band"]
    bare = RubberCompound.model_validate(banded)
    assert bare.replicas(293.15) == ()
    with pytest.raises(RangeError, match="it is known at 20 degC only"):
        bare.replicas(294.15)


def test_data_round_trip(banded: dict[str, Any]) -> None:
    compound = RubberCompound.model_validate(banded)
    assert RubberCompound.model_validate(compound.as_data()) == compound
    assert compound.as_data()["prony"]["band"] == BAND


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("moduli", [[2.5, 0.5]], r"prony\.band\.moduli: .*got 1 lists for 2 values of equilibrium"),
        (
            "moduli",
            [[2.5, 0.5], [1.0]],
            r"prony\.band\.moduli\[1\]: .*got 1 moduli, 2 are needed, one per term",
        ),
        ("moduli", [[2.5, 0.5], [-1.0, 1.0]], r"prony\.band\.moduli\[1\]\[0\]: got -1.0, allowed: >= 0"),
        ("moduli", [[2.5, 0.5], ["1 MPa", 1.0]], r"prony\.band\.moduli\[1\]\[0\]: expected a number"),
        ("equilibrium", ["4 MPa", "0 MPa"], r"prony\.band\.equilibrium\[1\]: .*allowed: > 0 MPa"),
        ("equilibrium", [], r"prony\.band\.equilibrium: .*at least 1 needed"),
        ("unit", "psi", r"prony\.band\.unit: .*'Pa', 'kPa', 'MPa' or 'GPa'"),
        ("seed", 3, r"prony\.band\.seed: unknown key .seed"),
    ],
)
def test_refused(banded: dict[str, Any], key: str, value: object, message: str) -> None:
    banded["prony"]["band"][key] = value
    with pytest.raises(SpecError, match=message):
        RubberCompound.model_validate(banded)
