"""What must not change the figures of a whole conveyor, or must change all of them alike: units, scales, other ways
to ask for the same load."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import conveyor
from conveyor.models import Conveyor
from conveyor.results.analysis import analyse_cases, analyse_duty
from conveyor.spec import from_data, load
from conveyor.units import from_si, quantity, si
from conveyor.units.quantity_kinds import KINDS
from conveyor.units.registry import REGISTRY, UNITS

SPECS = Path(__file__).parents[2] / "examples" / "specs"
NAMES = ("overland", "downhill_brakes", "in_plant_us", "shuttle", "transfer")
ROUNDING = 1e-9
MASS = 1.7  # a kilogram of one conveyor in kilograms of the other


def changed(value: Any, change: Callable[[str], str], key: str = "") -> Any:
    """Plain data with every quantity in it changed; texts stay."""
    if isinstance(value, dict):
        return {name: changed(part, change, name) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [changed(part, change, key) for part in value]
    words = value.split(" ") if isinstance(value, str) else ()
    if len(words) == 2 and words[1] in UNITS and words[0].lstrip("-")[:1].isdigit() and key != "name":
        return change(value)
    return value


def other_unit(text: str) -> str:
    """The quantity in another unit that every kind with its own has, mostly a US one."""
    unit = text.split(" ")[1]
    kinds = [kind for kind in KINDS.values() if unit in kind.units]
    allowed = [one for one in kinds[0].spelled.split() if all(one in kind.units for kind in kinds)]
    name = next(name for name, kind in KINDS.items() if kind is kinds[0])
    there = next((one for one in reversed(allowed) if one != unit), unit)
    return f"{from_si(si(quantity(text)), name, there).magnitude!r} {there}"


def heavier(text: str) -> str:
    """The quantity where a kilogram is MASS."""
    exponent = REGISTRY.get_dimensionality(UNITS[text.split(" ")[1]]).get("[mass]", 0)
    number, unit = text.split(" ")
    return f"{float(number) * MASS**exponent!r} {unit}"


def figures(found: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every number of plain data and where it stands."""
    if isinstance(found, dict):
        for key, part in found.items():
            yield from figures(part, f"{path}/{key}")
    elif isinstance(found, list):
        for i, part in enumerate(found):
            yield from figures(part, f"{path}/{i}")
    elif isinstance(found, float):
        yield path, found


def bare(name: str) -> dict[str, Any]:
    """An example without what stands beside its own load."""
    data = load(SPECS / f"{name}.yaml").as_data()
    return {key: part for key, part in data.items() if key not in {"cases", "uncertainty", "scenarios"}}


@pytest.mark.parametrize("name", NAMES)
def test_a_spec_in_other_units_has_the_same_figures(name):
    data = bare(name)
    spelled = changed(data, other_unit)
    assert spelled["belt"]["width"] != data["belt"]["width"]
    here, there = (dict(figures(conveyor.analyse(from_data(one)).to_dict())) for one in (data, spelled))
    assert here.keys() == there.keys()
    for path, figure in here.items():
        if "error" not in path:
            assert there[path] == pytest.approx(figure, rel=1e-7, abs=1e-7), path


@pytest.mark.parametrize("name", ["overland", "downhill_brakes", "shuttle"])
def test_a_heavier_kilogram_scales_every_force_and_power(name):
    """With all of it given there is no constant that has a mass: of drags, moduli, strengths, brakes and inertias."""
    data = bare(name)
    data["calculation"] |= {"strain": "off", "anchor": "off", "not_given": "nothing"}
    data["route"].pop("pulleys")  # wrap has a constant force
    data.pop("operation", None)
    for roll in (data["idlers"]["carry"]["roll"], data["idlers"]["return"]["roll"]):
        roll.setdefault("drag", "2 N")
    for drive in (data["drive"], *data["drive"]["further_drives"]):
        drive.setdefault("reduced_mass", "4 t")
    here, there = (conveyor.analyse(from_data(one)).to_dict() for one in (data, changed(data, heavier)))
    for block in ("forces_N", "power_kW", "tensions_N", "sections"):
        scaled = dict(figures(there[block]))
        for path, figure in figures(here[block]):
            exponent = 0.0 if path.endswith("_m") else 1.0
            assert scaled[path] == pytest.approx(MASS**exponent * figure, rel=1e-8, abs=1e-8), path
    assert there["take_up"]["setting_N"] == pytest.approx(MASS * here["take_up"]["setting_N"], rel=1e-8)
    assert there["friction_factor"] == pytest.approx(here["friction_factor"], rel=1e-8)


@pytest.mark.parametrize("name", NAMES)
def test_the_own_load_asked_for_in_another_way_is_the_own_load(name):
    """As a case by any of its names, and as bars of a year: hours x power of the mains."""
    data = bare(name)
    given = Conveyor.from_data(data)
    warmth, speed = f"{given.temperature!r} K", data["belt"]["speed"]
    sections = [section["name"] for section in data["route"]["sections"]]
    cases = [
        {"name": "given", "loading": "as given", "temperatures": [warmth], "speeds": [speed]},
        {"name": "full", "loading": "full"},
        {"name": "named", "loading": "sections", "sections": sections},
        {"name": "whole", "loading": "part load", "share": "100 %"},
    ]
    bars = [
        {"hours": "1000 h", "share": "100 %"},
        {"hours": "300 h", "share": "100 %", "temperature": warmth, "speed": speed},
    ]
    alone = conveyor.analyse(given)
    study = analyse_cases(from_data(data | {"cases": cases}))
    assert len(study.results) == len(cases)
    for result in study.results:
        balance = result.found.balance
        assert balance.power.motor == pytest.approx(alone.balance.power.motor, rel=ROUNDING)
        assert balance.equilibrium.setting == pytest.approx(alone.balance.equilibrium.setting, rel=ROUNDING)
        assert [check.verdict for check in result.checks] == [check.verdict for check in alone.checks]
    year = analyse_duty(from_data(data | {"operation": {"duty": bars, "price": "0.1 EUR/kWh"}}))
    assert year.year.net_kwh == pytest.approx(1300.0 * alone.balance.power.mains / 1e3, rel=ROUNDING)
