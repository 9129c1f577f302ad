"""Two printed sheets of a maker's program for the classic form of CEMA, item by item.

Rulmeca, Motorized Pulley Power Calculation Program, metric version 5.37, two sheets published on scribd.com
(619284226, 324620244). The program converts by factors of four digits (4.448 N/lbf, 3.281 ft/m), hence 1e-4 of each
factor beside half a unit of the last digit. Its Kx is printed to two digits (0.93 kg/m), its Wb as 13 kg/m: Tx and Tyb
are good to no more. Tp (999 N for four pulleys, 225 N for two) follows none of the book's figures and is entered, as is
the bearing of the drive pulley: 1.07 kW at 2.5 m/s. The second sheet's Kx is three times Ai/Si + 0.00068 (Wb + Wm), so
that its Tx is left out.
"""

from __future__ import annotations

import math

import pytest

from conveyor.laws import resistance
from conveyor.laws.resistance import cema
from conveyor.line.line import Line
from conveyor.loop.estimates import cema_estimate as estimate
from conveyor.spec import from_data

FACTOR = 1e-4
"""Half a unit of the last of four digits of a conversion factor, at worst."""
SPEC = {
    "name": "first sheet",
    "belt": {
        "width": "1000 mm", "speed": "2.5 m/s", "mass": "13.2 kg/m",
        "top_cover": {"thickness": "4 mm"}, "bottom_cover": {"thickness": "3 mm", "compound": "s100"},
        "carcass": {"kind": "EP", "thickness": "4 mm"},
    },
    "idlers": {
        "carry": {"rolls": 3, "spacing": "1.2 m", "trough_angle": "35 deg",
                  "roll": {"diameter": "108 mm", "length": "380 mm", "rotating_mass": "3 kg"}},
        "return": {"rolls": 1, "spacing": "3 m",
                   "roll": {"diameter": "108 mm", "length": "1150 mm", "rotating_mass": "8 kg"}},
    },
    "material": {"name": "sand", "density": "1600 kg/m^3", "flow": "700 t/h", "surcharge_angle": "20 deg"},
    "route": {
        "sections": [{"name": "all", "length": "1000 m"}],
        "feeding": {"skirt_length": "2 m", "skirtboards": "3 m", "skirt_width": "660 mm"},
        "cleaners": [{"count": 2, "width": "1000 mm", "thickness": "10 mm"}],
        "ploughs": [{"width": "1 m", "position": "head"}],
    },
    "drive": {"wrap_angle": "210 deg", "friction": 0.35, "efficiency": "96.9 %"},
    "ambient": {"temperature": "-10 degC"},
    "calculation": {
        "cema": {
            "flexure_factor": 0.019, "temperature_factor": 1.06, "idler_friction": "10.2304 N", "skirt_factor": 0.1378,
            "skirt_depth": "25 mm", "pulley_friction": "999 N", "drive_pulley_friction": "428 N",
        }
    },
}  # fmt: skip


@pytest.fixture(scope="module")
def sheet():
    line = Line.of(from_data(SPEC))
    made = estimate(line, 1.0)
    assert made is not None
    return made, {symbol: newtons for symbol, _, newtons in made.items}


@pytest.mark.parametrize(
    ("symbol", "printed"),
    [("Tam", 486), ("Tp", 999), ("Tsb", 269), ("Tbc", 1751), ("Tpl", 876), ("Tac", 0), ("Tm", 0)],
)
def test_items_to_the_printed_digits(sheet, symbol, printed):
    assert sheet[1][symbol] == pytest.approx(printed, abs=0.5 + 2 * FACTOR * printed)


def test_skirts_stand_in_the_zone_of_acceleration_too(sheet):
    """Without `skirtboards` they begin where the bulk lands, v²/(2 g μ1) before those of `skirt_length`."""
    skirts = {"skirt_length": "2 m", "skirt_width": "660 mm"}
    made = estimate(Line.of(from_data(SPEC | {"route": SPEC["route"] | {"feeding": skirts}})), 1.0)
    assert made is not None
    (found,) = (newtons for symbol, _, newtons in made.items if symbol == "Tsb")
    assert found / sheet[1]["Tsb"] == pytest.approx((2.5**2 / (2.0 * 9.81 * 0.5) + 2.0) / 3.0, rel=1e-12)


def test_friction_of_idlers_belt_and_bulk(sheet):
    """Kx 0.93 to half a hundredth, Wb 13.2 to half a tenth, the bulk's by three conversions (t/h, m/s, N)."""
    of = sheet[1]
    tolerance = {"Tx": 0.005 / 0.93, "Tyc": 0.05 / 13.2, "Tyr": 0.05 / 13.2, "Tym": 3 * 5e-4}
    printed = {"Tx": 9654.0, "Tyc": 2611.0, "Tyr": 2059.0, "Tym": 14504.0}
    for symbol, newtons in printed.items():
        assert of[symbol] == pytest.approx(newtons, rel=tolerance[symbol]), symbol
    main = math.fsum(of[symbol] for symbol in printed)
    assert main == pytest.approx(28829.0, abs=math.fsum(printed[symbol] * tolerance[symbol] for symbol in printed))


def test_effective_tension_and_motor_power(sheet):
    """Te 33,209 N within what Kx, Wb and conversions leave, 0.3 %; 86.79 kW = (83.02 + 1.07) kW/(1 - 2.69/86.79)."""
    made, items = sheet
    assert made.total == pytest.approx(math.fsum(items.values()), rel=1e-12)
    assert made.total == pytest.approx(33209.0, rel=0.003)
    motor = (made.total + made.drive_pulleys) * 2.5 / 0.969
    assert motor == pytest.approx(86.79e3, rel=0.003)
    assert pytest.approx(0.969, abs=5e-4 * 0.969) == 1.0 - 2.69 / 86.79


def test_a_second_sheet():
    """650 mm, 110 t/h at 1 m/s lifted 1.6 m; skirts of 8 m with 200 mm of iron ore, two cleaners, two ploughs."""
    seals = cema.SEALS_PER_FOOT.value * cema.POUND_FORCE / cema.FOOT
    skirts = resistance.cema_skirts(8.0, skirt_factor=0.276, depth=0.2, seals=seals)
    assert skirts == pytest.approx(2698.0, abs=0.5 + 2 * FACTOR * 2698.0)
    blades = 2 * 0.65 / cema.INCH * cema.CLEANER_PER_INCH.value * cema.POUND_FORCE
    assert blades == pytest.approx(1138.0, abs=0.5 + 2 * FACTOR * 1138.0)
    assert cema.PLOUGH_PER_INCH.value == cema.CLEANER_PER_INCH.value  # 1138 N of the ploughs too
    bulk = resistance.cema_acceleration(110.0 / 3.6, belt_speed=1.0, initial_speed=0.0)
    assert bulk == pytest.approx(31.0, abs=0.5 + 2 * FACTOR * 31.0)
    lift = 110.0 / 3.6 / 1.0 * 9.80665 * 1.6
    assert lift == pytest.approx(479.0, abs=0.5 + 2 * FACTOR * 479.0)
