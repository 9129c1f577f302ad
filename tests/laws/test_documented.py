"""Every public law documents every argument, in order, with a unit, and says what it raises."""

from __future__ import annotations

import inspect
import re

import pytest

from conveyor.contact import closed_forms
from conveyor.laws import belt as belt_check
from conveyor.laws import (
    discharge,
    drives,
    idlers,
    loading,
    power,
    resistance,
    roll_life,
    take_up,
    tension,
    transfer,
    vertical_curve,
    wind,
)
from conveyor.laws import energy as energy_laws
from conveyor.laws import motion as motion_laws

WITHOUT_UNIT = {"minima", "carcass"}  # a mapping whose text states the unit; a name
MODULES = (
    loading, resistance, tension, power, closed_forms, take_up, motion_laws, vertical_curve, roll_life,
    energy_laws, belt_check, drives, idlers, discharge, transfer, wind,
)  # fmt: skip


def _laws():
    for module in MODULES:
        for name, law in vars(module).items():
            if (
                inspect.isfunction(law)
                and not name.startswith("_")
                and law.__module__.startswith(module.__name__)
            ):
                yield pytest.param(law, id=f"{module.__name__}.{name}")


@pytest.mark.parametrize("law", list(_laws()))
def test_arguments_are_documented_in_order_with_units(law):
    doc = inspect.getdoc(law)
    section = doc.split("Parameters\n----------\n")[1].split("\n\n")[0]
    documented = re.findall(r"^\*?(\w+) : .*\n((?:    .*\n?)+)", section, re.MULTILINE)
    assert [name for name, _ in documented] == list(inspect.signature(law).parameters)
    for name, text in documented:
        assert name in WITHOUT_UNIT or re.search(r"\[[^\]]+\]", text), name


@pytest.mark.parametrize("law", list(_laws()))
def test_result_refusal_and_example_are_documented(law):
    doc = inspect.getdoc(law)
    for heading in ("Returns\n-------", "Raises\n------", "Examples\n--------"):
        assert heading in doc
