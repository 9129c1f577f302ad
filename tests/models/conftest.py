"""A small valid conveyor as plain data, compound in place: tests change one thing at a time."""

from __future__ import annotations

import copy
from typing import Any

import pytest

COMPOUND: dict[str, Any] = {
    "name": "test rubber",
    "kind": "illustrative",
    "source": {"origin": "this test", "licence": "MIT"},
    "poisson_ratio": 0.5,
    "density": "1100 kg/m^3",
    "reference_temperature": "20 degC",
    "prony": {
        "equilibrium": "4 MPa",
        "terms": [{"modulus": "2 MPa", "time": "1 ms"}, {"modulus": "1 MPa", "time": "1 s"}],
    },
    "shift": {
        "law": "table",
        "temperature": ["-10 degC", "20 degC", "50 degC"],
        "log10_aT": [3.0, 0.0, -2],
    },
}
CONVEYOR: dict[str, Any] = {
    "name": "test line",
    "belt": {
        "width": "1200 mm",
        "speed": "5 m/s",
        "top_cover": {"thickness": "6 mm"},
        "bottom_cover": {"thickness": "4 mm", "compound": COMPOUND},
        "carcass": {"kind": "steel cord", "thickness": "5 mm", "mass": "12 kg/m^2"},
    },
    "idlers": {
        "carry": {
            "rolls": 3,
            "spacing": "1.5 m",
            "trough_angle": "35 deg",
            "roll": {"diameter": "159 mm", "length": "465 mm", "rotating_mass": "5.2 kg"},
        },
        "return": {
            "rolls": 1,
            "spacing": "3 m",
            "roll": {"diameter": "159 mm", "length": "1400 mm", "rotating_mass": "13.2 kg"},
        },
    },
    "material": {"name": "coal", "density": "850 kg/m^3", "flow": "2000 t/h", "surcharge_angle": "20 deg"},
    "route": {
        "sections": [{"name": "one", "length": "500 m"}, {"name": "two", "length": "300 m", "lift": "10 m"}],
        "feeding": {"skirt_length": "4 m", "skirt_width": "750 mm"},
        "cleaners": [{"width": "1100 mm", "thickness": "8 mm"}],
    },
    "drive": {"wrap_angle": "210 deg", "friction": 0.35, "efficiency": "95 %"},
    "ambient": {"temperature": "20 degC"},
}


@pytest.fixture
def compound_data() -> dict[str, Any]:
    return copy.deepcopy(COMPOUND)


@pytest.fixture
def conveyor_data() -> dict[str, Any]:
    return copy.deepcopy(CONVEYOR)
