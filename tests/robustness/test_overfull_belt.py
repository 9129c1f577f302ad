"""A belt that holds less than its bulk takes is answered: the check fails with both figures, in every output."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

import conveyor
from conveyor.errors import InputError
from tests.command_line import run

PRINTED = """
name: KAB C-1.1
belt:
  width: 1200 mm
  speed: 3.58 m/s
  mass: 23.9 kg/m
  top_cover: {thickness: 6 mm, compound: standard-cover}
  bottom_cover: {thickness: 2 mm, compound: standard-cover}
  carcass: {kind: steel cord, thickness: 4 mm, strength: 1250 N/mm}
idlers:
  carry:
    {rolls: 3, spacing: 1.2 m, trough_angle: 45 deg, roll: {diameter: 139.7 mm, length: 465 mm, rotating_mass: 5 kg}}
  return: {rolls: 1, spacing: 3 m, roll: {diameter: 139.7 mm, length: 1400 mm, rotating_mass: 13 kg}}
material: {name: coal, density: 850 kg/m^3, flow: 2125 t/h, surcharge_angle: 15 deg}
route:
  sections: [{name: all, length: 814 m, lift: 6.1 m}]
drive: {wrap_angle: 210 deg, friction: 0.35, efficiency: 94 %}
ambient: {temperature: 30 degC}
"""
"""Sidewinder's printed report of a coal conveyor (studylib.net/doc/25593897): 2125 t/h at 3.58 m/s and 850 kg/m³."""


@pytest.fixture
def printed(tmp_path: Path) -> Path:
    """The printed design as a spec."""
    path = tmp_path / "kab.yaml"
    path.write_text(PRINTED, encoding="utf-8")
    return path


def test_a_printed_design_fails_its_filling_with_what_it_takes_and_holds(printed: Path) -> None:
    done = run("power", printed, "--json", "-o", "a.xlsx", "-o", "a.html", cwd=printed.parent)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    (filling,) = (check for check in result["checks"] if check["key"] == "filling" and check["governs"])
    assert filling["verdict"] == "fail"
    # 2125/3.6 kg/s over 3.58 m/s and 850 kg/m³
    assert filling["calculated"] == pytest.approx(2125 / 3.6 / 3.58 / 850, rel=1e-12)
    # ISO 5048 by hand: b = 0.9 B - 50 mm, l = 465 mm, 45 and 15 deg; 0.4 % less heap on the slope of 6.1 in 814 m
    wing = 0.5 * (0.9 * 1.2 - 0.05 - 0.465)
    across, up = 2.0 * wing * math.cos(math.radians(45)), wing * math.sin(math.radians(45))
    top = (0.465 + across) ** 2 * math.tan(math.radians(15)) / 6.0
    heap = math.sqrt(1.0 - (6.1 / 814 / math.sin(math.radians(15))) ** 2)
    held = (0.465 + 0.5 * across) * up + heap * top
    assert filling["required"] == pytest.approx(held, rel=1e-12)
    words = filling["why"]
    assert words.startswith('the bulk takes 0.194 m², 117 % of the 0.166 m² that section "all" holds on its slope')
    assert words.endswith("reduce material.flow to 1,820 t/h, raise belt.speed to 4.18 m/s, or take a wider belt")
    assert (printed.parent / "a.xlsx").stat().st_size > 0


def test_what_cures_an_overfull_belt_cures_it(printed: Path) -> None:
    """At the flow named, less what rounding to three digits may add, the check passes."""
    done = run("power", printed, "--set", "material.flow=1815 t/h", "--json")
    (filling,) = (one for one in json.loads(done.stdout)["checks"] if one["key"] == "filling" and one["governs"])
    assert filling["verdict"] == "pass"


def test_beyond_half_as_much_again_it_is_refused_with_the_reason(printed: Path) -> None:
    done = run("power", printed, "--set", "material.flow=3000 t/h")
    assert done.returncode == 2
    assert "the belt holds 0.1662 m^2 and is calculated up to 0.2493 m^2, 150 % of that: reduce" in done.stderr


def test_bulk_beyond_the_edges_is_said_to_spill(printed: Path) -> None:
    """Heaped from edge to edge the belt holds 0.232 m² (the same by hand at b = B): 2600 t/h take 0.237."""
    done = run("power", printed, "--set", "material.flow=2600 t/h")
    assert "and spills beyond 0.232 m², heaped from edge to edge" in " ".join(done.stdout.split())


def test_the_bulk_is_carried_whatever_the_trough_holds(printed: Path) -> None:
    """Lift and acceleration follow the flow, as on a belt that holds it."""
    overfull = conveyor.analyse(conveyor.load(printed)).balance.forces
    wide = conveyor.load(printed)
    steeper = wide.replace(material=wide.material.replace(surcharge_angle="30 deg"))
    held = conveyor.analyse(steeper).balance.forces
    assert overfull.lift == pytest.approx(held.lift, rel=1e-12)
    with pytest.raises(InputError, match="150 % of that"):
        wide.replace(material=wide.material.replace(flow="2900 t/h"))
