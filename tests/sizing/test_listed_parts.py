"""Designs of makers' items: built of them only, checked as any other, refused where none fits."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import conveyor
from conveyor.errors import InputError, NoSolutionError
from conveyor.laws.loading import cross_section, usable_width
from conveyor.models.belt import RUBBER_DENSITY
from conveyor.models.maker_lists import ListedItem
from conveyor.models.sizing import SizingDuty, size_series
from conveyor.sizing import size_conveyor
from conveyor.sizing.design_choice import WidthSize
from conveyor.sizing.listed_sizes import listed_carcasses, listed_rolls
from conveyor.spec import dump_given, fingerprint
from conveyor.studies.loads import every_load
from conveyor.studies.study_file import read_duty
from conveyor.units import si

LIST = """\
rolls:
  R108-315: {source: "list A", fields: {diameter: 108 mm, length: 315 mm, rotating_mass: 3.9 kg, drag: 1.6 N,
             bearing: {dynamic_rating: 13.5 kN, distance: 275 mm}}}
  R133-315: {source: "list A", fields: {diameter: 133 mm, length: 315 mm, rotating_mass: 5.4 kg,
             bearing: {dynamic_rating: 14.8 kN, distance: 275 mm}}}
  R133-950: {source: "list A", fields: {diameter: 133 mm, length: 950 mm, rotating_mass: 13 kg,
             bearing: {dynamic_rating: 14.8 kN, distance: 910 mm}}}
  bare: {source: "list A", fields: {diameter: 159 mm, length: 315 mm, rotating_mass: 7 kg}}
belts:
  stock: {source: "list B", fields: {carcass: {kind: EP, strength: 630 N/mm, thickness: 4.4 mm},
          top_cover: {thickness: 8 mm}, bottom_cover: {thickness: 3 mm}, thickness: 15.4 mm, mass: 19 kg/m^2}}
  to order: {source: "list B", fields: {carcass: {kind: EP, strength: 630 N/mm, thickness: 4.3 mm, mass: 5.5 kg/m^2,
             stiffness: 6000 N/mm}, mass: 20 kg/m^2}}
  woven: {source: "list B", fields: {carcass: {kind: solid woven, strength: 800 N/mm, thickness: 6 mm}}}
motors:
  M110: {source: "list C", fields: {installed_power: 110 kW, motor_speed: 1485 rpm, inertia: 1.9 kg*m^2}}
  M132: {source: "list C", fields: {installed_power: 132 kW, inertia: 2.7 kg*m^2}}
  plain: {source: "list C", fields: {installed_power: 132 kW, motor_speed: 1485 rpm}}
pulleys:
  narrow: {source: "list D", fields: {diameter: 630 mm, face_width: 850 mm, shaft_diameter: 125 mm, mass: 400 kg}}
  thin: {source: "list D", fields: {diameter: 500 mm, face_width: 950 mm, shaft_diameter: 60 mm, mass: 250 kg,
         bearing_centres: 1.25 m, hub_centres: 0.8 m, shaft_steel: C1045}}
  stout: {source: "list D", fields: {diameter: 500 mm, face_width: 950 mm, shaft_diameter: 140 mm, mass: 400 kg,
          bearing_centres: 1.25 m, hub_centres: 0.8 m, shaft_steel: C1045}}
  bare: {source: "list D", fields: {diameter: 630 mm, shaft_diameter: 125 mm, mass: 400 kg}}
gearboxes:
  G16-12: {source: "list E", fields: {gear_ratio: 16.2, efficiency: 96 %, gear_torque: 12 kN*m}}
  G16-25: {source: "list E", fields: {gear_ratio: 16.2, efficiency: 96 %, gear_torque: 25 kN*m}}
  G16-40: {source: "list E", fields: {gear_ratio: 16.2, efficiency: 96 %, gear_torque: 40 kN*m}}
  G20-16: {source: "list E", fields: {gear_ratio: 20.3, efficiency: 96 %, gear_torque: 16 kN*m}}
  fast: {source: "list E", fields: {gear_ratio: 2.5, efficiency: 98 %, gear_torque: 40 kN*m}}
  old: {source: "list E", fields: {gear_ratio: 20.3, efficiency: 96 %}}
couplings:
  C1000: {source: "list F", fields: {efficiency: 99 %, coupling_torque: 1000 N*m}}
  C1250: {source: "list F", fields: {efficiency: 99 %, coupling_torque: 1250 N*m}}
backstops:
  B1: {source: "list G", fields: {backstop_torque: 1 kN*m}}
  B11: {source: "list G", fields: {backstop_torque: 11 kN*m}}
  B18: {source: "list G", fields: {backstop_torque: 18 kN*m}}
  HS600: {source: "list G", fields: {backstop_torque: 600 N*m, backstop_shaft: motor}}
  HS690: {source: "list G", fields: {backstop_torque: 690 N*m, backstop_shaft: motor}}
brakes:
  BR1: {source: "list H", fields: {brake_force: 1 kN}}
  BR40: {source: "list H", fields: {brake_force: 40 kN, brake_heat: 1 kJ}}
  BR60: {source: "list H", fields: {brake_force: 60 kN, brake_heat: 5 MJ}}
  ED700: {source: "list H", fields: {brake_torque: 700 N*m, brake_shaft: motor}}
  ED1200: {source: "list H", fields: {brake_torque: 1200 N*m, brake_shaft: motor}}
"""
DUTY = """\
name: Listed
material: {name: stone, density: 1600 kg/m^3, flow: 800 t/h, surcharge_angle: 20 deg}
lump: 100 mm
route:
  sections:
    - {name: feed, length: 12 m}
    - {name: incline, length: 190 m, lift: 25 m}
ambient: {temperature: 20 degC}
operation: {hours_per_year: 4200 h, price: 0.12 EUR/kWh}
covers: [standard-cover]
calculation: {strain: "off"}
"""


def duty(folder: Path, listed: str) -> SizingDuty:
    """Duty of a folder with the lists."""
    (folder / "conveyor-library").mkdir(exist_ok=True)
    (folder / "conveyor-library" / "parts.yaml").write_text(LIST, encoding="utf-8")
    path = folder / "duty.yaml"
    path.write_text(f"{DUTY}listed: {listed}\n", encoding="utf-8")
    return read_duty(path)


@pytest.fixture(scope="module")
def best(tmp_path_factory):
    folder = tmp_path_factory.mktemp("listed")
    return size_conveyor(
        duty(folder, "{rolls: [R108-315, R133-315, r133-950], belts: [stock, to order], motors: all}"), best=1
    ).best


def test_a_design_is_built_of_the_listed_items_only(best):
    line = best.conveyor
    carry, back = line.idlers.carry.roll, line.idlers.return_.roll
    assert (carry.listed.name, back.listed.name) == ("R133-315", "R133-950")  # 108 mm has no roll for the return
    assert line.belt.listed.name in {"stock", "to order"}
    assert line.drive.listed[0].name in {"M110", "M132"}
    assert si(carry.rotating_mass) == pytest.approx(5.4)
    assert not [check for check in every_load(line).governing if check.failed]


def test_a_listed_motor_turns_its_pulley_at_the_speed_of_the_belt(tmp_path):
    only = size_conveyor(duty(tmp_path, "{motors: [M110]}"), best=1).best.conveyor
    head = next(pulley for pulley in only.route.pulleys if pulley.position == "head")
    rim = 3.14159265 * si(head.diameter) * (1485.0 / 60.0) / only.drive.gear_ratio
    assert rim == pytest.approx(si(only.belt.speed), rel=1e-5)  # four decimals of the ratio
    without_speed = size_conveyor(duty(tmp_path, "{motors: [M132]}"), best=1).best.conveyor
    assert without_speed.drive.inertia is None


def test_a_written_design_needs_no_list(tmp_path, best):
    path = tmp_path / "design.yaml"
    path.write_text(dump_given(best.conveyor), encoding="utf-8")
    assert fingerprint(conveyor.load(path)) == fingerprint(best.conveyor)


def test_a_belt_listed_with_its_covers_has_those_and_another_those_of_its_wear(tmp_path):
    stock = size_conveyor(duty(tmp_path, "{belts: [stock]}"), best=1).best
    assert (stock.chosen.top, stock.chosen.bottom) == pytest.approx((8e-3, 3e-3))
    assert stock.chosen.carcass.mass == pytest.approx(19.0 - RUBBER_DENSITY * 11e-3)
    assert stock.found.line.belt.width == pytest.approx(0.8)
    made = size_conveyor(duty(tmp_path, "{belts: [to order]}"), best=1).best
    belt = made.conveyor.belt
    assert belt.mass is None
    assert made.found.line.stretches[0].belt_mass == pytest.approx(
        0.8 * (5.5 + RUBBER_DENSITY * (made.chosen.top + made.chosen.bottom))
    )
    assert made.chosen.carcass.stiffness == pytest.approx(6e6)


def test_rolls_of_a_bearing_take_the_next_better_where_a_length_has_none():
    def roll(name: str, length: int, rating: float) -> ListedItem:
        fields = {"diameter": "133 mm", "length": f"{length} mm", "rotating_mass": "5 kg",
                  "bearing": {"dynamic_rating": f"{rating} kN", "distance": "1 m"}}  # fmt: skip
        return ListedItem(kind="rolls", name=name, source="list", fields=fields)

    made = listed_rolls([roll("a", 315, 14.0), roll("b", 315, 22.0), roll("c", 950, 20.0)])
    assert [(of.rating, [of.listed(long).name for long in (0.315, 0.95)]) for of in made] == [
        (pytest.approx(14e3), ["a", "c"]),
        (pytest.approx(20e3), ["b", "c"]),
        (pytest.approx(22e3), ["b", "c"]),
    ]
    assert made[0].listed(0.38) is None


WIDTH_800 = WidthSize(0.8, 0.95, 0.465, 0.315, vee=False)


@pytest.mark.parametrize(
    ("carry", "back", "chosen"),
    [
        (["314 mm", "12.402 in", "340 mm"], ["950 mm"], (0.3150108, 0.95)),  # 12.402 in are the nearest to 315 mm
        (["13.25 in"], ["39 in"], (0.33655, 0.9906)),  # rolls of 36 in belts
        (["11.25 in"], ["950 mm"], None),  # three of 285.75 mm: 57 mm more than the belt, half of 145 mm is 72.5 mm
        (["315 mm"], ["870 mm"], None),  # 70 mm more than the belt, half of 150 mm is 75 mm
        (["340 mm"], ["950 mm"], None),  # 220 mm more than the belt, one and a half times 145 mm is 217.5 mm
    ],
)
def test_rolls_do_where_the_belt_lies_on_them_with_its_edges(carry, back, chosen):
    def roll(name: str, length: str) -> ListedItem:
        fields = {"diameter": "108 mm", "length": length, "rotating_mass": "5 kg",
                  "bearing": {"dynamic_rating": "14 kN", "distance": "1 m"}}  # fmt: skip
        return ListedItem(kind="rolls", name=name, source="list", fields=fields)

    (size,) = listed_rolls([roll(long, long) for long in (*carry, *back)])
    found = WIDTH_800.with_rolls(size)
    assert (found and (found.three, found.one)) == (chosen and pytest.approx(chosen))


@pytest.mark.parametrize("series", ["metric", "US"])
def test_the_shortest_rolls_that_do_bear_every_belt_of_the_series(series):
    for row in size_series(series).widths:
        belt, vee = si(row.belt), si(row.belt) >= si(size_series(series).vee_from)
        width = WidthSize(belt, si(row.one), si(row.two), si(row.three), vee)
        for (_, shortest, _), count in zip(width.suitable_lengths, (3, width.return_rolls[0]), strict=True):
            assert count * shortest > belt + 0.03  # half of what the series' narrowest sets reach beyond, 80 mm


def test_a_design_on_rolls_of_other_lengths_is_calculated_with_those(tmp_path):
    (tmp_path / "conveyor-library").mkdir()
    inches = LIST.replace("133 mm, length: 315 mm", "133 mm, length: 12.6 in")
    (tmp_path / "conveyor-library" / "parts.yaml").write_text(inches, encoding="utf-8")
    path = tmp_path / "duty.yaml"
    rules = "rules: {widths: [800 mm], drives: [head]}"
    path.write_text(f"{DUTY}{rules}\nlisted: {{rolls: [R133-315, R133-950]}}\n", encoding="utf-8")
    best = size_conveyor(read_duty(path), best=1).best
    assert si(best.conveyor.idlers.carry.roll.length) == pytest.approx(12.6 * 0.0254)
    assert best.choice.trough.width.three == pytest.approx(12.6 * 0.0254)
    section = cross_section(usable_width(0.8), middle_roll_length=12.6 * 0.0254, trough_angle=best.choice.trough.angle,
                            surcharge_angle=si(best.conveyor.material.surcharge_angle))  # fmt: skip
    steep = math.asin(25.0 / 190.0)
    area = section.on_slope(steep, surcharge_angle=si(best.conveyor.material.surcharge_angle))
    assert best.choice.filling == pytest.approx(800.0 / 3.6 / 1600.0 / best.choice.speed / area)


def test_a_belt_listed_by_its_rating_breaks_at_ten_times_it():
    fields = {"carcass": {"kind": "EP", "rating": "400 PIW", "thickness": "4 mm"}}
    (one,) = listed_carcasses([ListedItem(kind="belts", name="P", source="list", fields=fields)], "EP")
    assert one.strength == pytest.approx(4000.0 * 175.12684, rel=1e-6)  # N/m of a lbf/in
    assert (one.name, one.safety) == ("P", pytest.approx(10.0))
    assert not listed_carcasses([ListedItem(kind="belts", name="P", source="list", fields=fields)], "steel cord")


@pytest.mark.parametrize(
    ("listed", "told"),
    [
        ("{rolls: [R9]}", r'listed\.rolls\[0\]: "R9" is not in the library of rolls'),
        ("{rolls: all}", r'listed\.rolls\[3\]: "bare" has no bearing\.dynamic_rating, which sizing needs'),
        ("{belts: [woven]}", r'listed\.belts\[0\]: "woven" has no carcass\.stiffness'),
        ("{gearboxes: [G20-16]}", r"listed\.gearboxes: given without listed\.motors, whose speed"),
        ("{gearboxes: [old]}", r'listed\.gearboxes\[0\]: "old" has no gear_torque, which sizing needs'),
        ("{couplings: [C1000]}", r"listed\.couplings: given without listed\.motors"),
        ("{brakes: [ED700]}", r"listed\.brakes: given without listed\.motors, whose speed brakes are chosen by"),
        ("{motors: [M132], backstops: [HS600]}", r'listed\.motors\[0\]: "M132" has no motor_speed'),
        ("{motors: [M132], gearboxes: [G20-16]}", r'listed\.motors\[0\]: "M132" has no motor_speed'),
        ("{motors: [plain], gearboxes: [G20-16]}", r'listed\.motors\[0\]: "plain" has no inertia'),
        ("{pulleys: [narrow, bare]}", r'listed\.pulleys\[1\]: "bare" has no face_width'),
        ("{axles: all}", r'unknown key "axles"; keys allowed: rolls, belts, motors, pulleys'),
        (
            "{belts: [stock]}\nrules: {carcasses: [steel cord]}",
            r"listed\.belts: none is of rules\.carcasses, steel cord",
        ),
    ],
)
def test_items_that_cannot_be_chosen_are_refused_at_their_place(tmp_path, listed, told):
    with pytest.raises(InputError, match=told):
        duty(tmp_path, listed)


def test_lists_that_do_not_exist_are_named(tmp_path, monkeypatch):
    (tmp_path / "none").mkdir()
    monkeypatch.setenv("CONVEYOR_LIBRARY", str(tmp_path / "none"))
    path = tmp_path / "duty.yaml"
    path.write_text(f"{DUTY}listed: {{motors: all}}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"listed\.motors: got all, but makers' lists have no motors"):
        read_duty(path)


def test_where_no_item_fits_the_refusal_says_which_list(tmp_path):
    with pytest.raises(
        NoSolutionError,
        match=r"a belt of 800 mm needs rolls of one diameter, 315 mm \(291 mm to 339 mm\) long for carry sets, 950 mm "
        r"\(875 mm to 1025 mm\) for return; the nearest listed, by diameter, are 108 mm: 315 mm: list further",
    ):
        size_conveyor(duty(tmp_path, "{rolls: [R108-315]}"))


def test_the_example_is_built_of_its_store():
    best = size_conveyor(read_duty(Path(__file__).parents[2] / "examples" / "listed" / "in_plant.yaml"), best=1).best
    assert best.conveyor.idlers.carry.roll.listed.source == "example, no maker's"
    assert best.conveyor.drive.listed[0].name in {"M90", "M110"}
