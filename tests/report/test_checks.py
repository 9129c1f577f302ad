"""Checks: each verdict is the comparison of its two figures, and agrees with the warnings."""

from __future__ import annotations

import math
import re
from operator import itemgetter
from pathlib import Path
from types import SimpleNamespace

import pytest

import conveyor
from conveyor.checks import contact_checks, tension_checks
from conveyor.checks.bulk_checks import belt_filling
from conveyor.line.stretches import STRANDS
from conveyor.loop.start_and_stop import motion_states
from conveyor.pipeline import calculate
from conveyor.report.table_model import Column, Figure, Table, figure_table
from conveyor.units import si
from conveyor.units.presentation import display_unit
from conveyor.units.sentences import format_band
from tests.loop.loop_lines import line as loop_line
from tests.loop.test_pulley_duty import calculated
from tests.report.checking import checks

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"


@pytest.fixture(scope="module")
def line():
    return conveyor.load(SPECS / "in_plant_us.yaml").replace(report={"units": "SI"})


def found(line, system="SI"):
    return {check.subject: check for check in checks(conveyor.analyse(line), system)}


@pytest.fixture(scope="module")
def all_of(line):
    return found(line)


def failed(checks_of):
    return [subject for subject, check in checks_of.items() if check.verdict == "FAIL"]


def test_example_passes(line, all_of):
    assert failed(all_of) == []
    balance = conveyor.analyse(line).balance
    motor = balance.layout.motor(balance.equilibrium.design_force)
    assert motor > balance.power.motor
    assert all_of["motor power, drive (design friction)"].found == f"{motor / 1e3:.0f} kW"
    assert all_of["motor power, drive (design friction)"].verdict == "pass"
    rubber = all_of["rubber, carry"]  # of the shelf's constructed covers
    assert (rubber.asked, rubber.verdict) == ("a measured compound required", "not checked")


def test_a_measured_rubber_is_held_to_its_data():
    line = conveyor.load(SPECS / "overland_10km.yaml")
    assert "Hz" in found(line)["rubber data over the excitation band, carry"].asked


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [(0.9, 1.1, "pass"), (1.1, 1.1, "FAIL"), (0.9, 0.9, "FAIL"), (1.1, 0.9, "FAIL")],
)
def test_data_cover_the_excited_band_where_they_reach_beyond_both_its_ends(low, high, verdict):
    given = conveyor.load(SPECS / "overland_10km.yaml")
    band = conveyor.analyse(given).contacts.excited_band("carry")
    compound = given.belt.bottom_cover.compound
    at = compound.frequencies(given.temperature)
    stated = [limit.m_as("Hz") for limit in compound.range.frequency]
    # as stated at the reference temperature, shifted like those of the file
    reach = [
        f"{share * end / now * then!r} Hz" for share, end, now, then in zip((low, high), band, at, stated, strict=True)
    ]
    cover = given.belt.bottom_cover.replace(compound=compound.replace(range=compound.range.replace(frequency=reach)))
    line = given.replace(belt=given.belt.replace(bottom_cover=cover))
    assert found(line)["rubber data over the excitation band, carry"].verdict == verdict


def test_us_units(line):
    of, balance = found(line, "US")["motor power, drive (design friction)"], conveyor.analyse(line).balance
    assert of.found == f"{balance.layout.motor(balance.equilibrium.design_force) / 745.699872:.0f} hp"  # 550 ft lbf/s
    assert of.asked == "at most 300 hp"


@pytest.mark.parametrize(
    ("part", "change", "subject", "warned"),
    [
        ("drive", {"installed_power": "50 kW"}, "motor power, drive (design friction)", "the motor requires"),
        # motors of known power would give their rated force to break away
        (
            "drive",
            {"start_factor": 1.01, "installed_power": None},
            "starting force after standstill (design friction)",
            "raise drive.start_factor",
        ),
        (
            "carcass",
            {"strength": "30 N/mm", "rating": None},
            "belt safety factor, steady",
            "safety of the belt",
        ),
        (
            "carcass",
            {"rating": "60 PIW"},
            "belt tension per width, steady",
            "the belt is rated for 10.5 N/mm",
        ),
        (
            "take-up",
            {"kind": "gravity", "tension": "15 kN"},
            "take-up tension (sag, carry, incline, steady)",
            "requires 25.6 kN",
        ),
    ],
)
def test_what_is_too_weak_fails_and_is_warned_of(line, part, change, subject, warned):
    if part == "carcass":
        changed = line.replace(belt=line.belt.replace(carcass=line.belt.carcass.replace(**change)))
    elif part == "take-up":
        changed = line.replace(route=line.route.replace(take_up=change))
    else:
        changed = line.replace(drive=line.drive.replace(**change))
    result = conveyor.analyse(changed)
    assert subject in [check.subject for check in checks(result) if check.verdict == "FAIL"]
    assert any(warned in warning for warning in result.warnings)


def _failed(result) -> list[str]:
    return [check.subject for check in checks(result) if check.verdict == "FAIL"]


def test_a_regenerative_belt_that_goes_slack_fails_and_is_warned_of():
    """The warning stood behind a return for conveyors that draw no force at the start."""
    line = conveyor.load(SPECS / "downhill_brakes.yaml")
    route = line.route.as_data()
    free = line.replace(route=route | {"take_up": {"kind": "gravity", "position": "head"}})
    needed = conveyor.analyse(free).balance.equilibrium.needed
    held = {"kind": "gravity", "position": "head", "tension": f"{0.7 * needed} N"}
    result = conveyor.analyse(line.replace(route=route | {"take_up": held}))
    assert any(subject.startswith("minimum belt tension, all states") for subject in _failed(result))
    assert any(warning.startswith("the belt goes slack in the state") for warning in result.warnings)


@pytest.mark.parametrize(("rating", "short"), [("6.3 kN", True), ("40 kN", False)])
def test_a_set_that_lives_too_short_fails_and_is_warned_of(rating, short):
    """The check was of the set, the warning of one roll, which lives longer."""
    line = conveyor.load(SPECS / "in_plant_us.yaml")
    data = line.idlers.as_data()
    for strand, distance in (("carry", "17 in"), ("return", "53 in")):
        data[strand]["roll"] |= {"bearing": {"dynamic_rating": rating, "distance": distance}}
    result = conveyor.analyse(line.replace(idlers=data))
    failed = {subject.split()[2] for subject in _failed(result) if "L10" in subject}
    told = {warning.split()[0] for warning in result.warnings if "L10 of all bearings" in warning}
    assert failed == told
    assert bool(told) == short


def test_a_set_with_some_bearings_known_never_passes():
    line = conveyor.load(SPECS / "in_plant_us.yaml")
    data = line.idlers.as_data()
    bearing = {"dynamic_rating": "40 kN", "distance": "17 in"}
    data["carry"] |= {"middle_roll": data["carry"]["roll"] | {"bearing": bearing}}
    (check,) = (c for c in checks(conveyor.analyse(line.replace(idlers=data))) if "L10" in c.subject)
    assert (check.verdict, check.asked) == ("not checked", "bearings of some rolls not given")


def test_small_pulley_fails(line):
    pulleys = [pulley.replace(diameter="250 mm") for pulley in line.route.pulleys]
    of = found(line.replace(route=line.route.replace(pulleys=pulleys)))
    assert of["diameter, head pulley"].verdict == "FAIL"
    assert of["diameter, head pulley"].found == "250 mm"


def test_not_given_is_not_checked(line):
    without = {name: value for name, value in line.drive.as_data().items() if name != "installed_power"}
    carcass = {name: value for name, value in line.belt.carcass.as_data().items() if name != "rating"}
    of = found(line.replace(drive=without, belt=line.belt.replace(carcass=carcass)))
    assert of["motor power, drive (design friction)"].verdict == "not checked"
    assert of["belt safety factor, steady"].verdict == "not checked"
    assert of["holding backstop, loaded belt (least friction)"].verdict == "not checked"


def test_downhill_without_brake_does_not_stop():
    of = found(conveyor.load(SPECS / "downhill.yaml"))
    assert of["coast-down stop"].verdict == "FAIL"
    assert of["motor power, drive (least friction)"].found.endswith("(generating)")
    assert of["belt safety factor, steady"].verdict == "FAIL"


def test_brakes_that_hold():
    of = found(conveyor.load(SPECS / "downhill_brakes.yaml"))
    assert failed(of) == []
    assert of["holding brake, loaded belt (least friction)"].found == "190 kN"
    assert {
        "convex curve, brow, carry: no strip slack",
        "concave curve, hollow, carry: empty belt stays down",
    } <= set(of)


def test_bands_in_words():
    assert format_band((0.5, 99.6)) == "0.5 to 99.6 Hz"
    assert format_band((1e-12, 999999.0)) == "1×10⁻¹² to 1,000,000 Hz"


def test_units_of_tables():
    """Names, numbers, what stays: words, gaps, ratios, infinity."""
    columns = tuple(
        Column(label, kind, itemgetter(i))
        for i, (label, kind) in enumerate(
            (
                ("strand", "text"),
                ("force", "force"),
                ("at", "temperature"),
                ("w", "strength"),
                ("f", "frequency"),
            )
        )
    )
    table = Table("t", "T", "T", columns, (("carry", 4.4482216152605, 373.15, 1000.0, 5.0),))
    shown = table.frame("US")
    assert list(shown.columns) == ["strand", "force [lbf]", "at [degF]", "w [lbf/in]", "f [Hz]"]
    assert shown.iloc[0].tolist() == ["carry", 1.0, 212.0, pytest.approx(5.710147163), 5.0]
    assert table.frame().iloc[0].tolist() == ["carry", 4.4482216152605, 100.0, 1.0, 5.0]
    rows = figure_table("t", "T", "T", (Figure("length", "length", 0.3048), Figure("f", "ratio", float("inf"))))
    shown = rows.frame("US")
    assert shown["quantity"].tolist() == ["length [ft]", "f [-]"]
    assert shown["value"].tolist() == [1.0, float("inf")]


@pytest.mark.parametrize(
    ("kind", "value", "sign", "expected"),
    [
        ("acceleration", 0.3048, "ft/s²", 1.0),
        ("pressure", 6.894757293168e6, "psi", 1000.0),
        ("speed", 0.00508, "fpm", 1.0),
        ("thickness", 0.0254, "in", 1.0),
        ("line mass", 1.488163943570, "lb/ft", 1.0),
        ("mass flow", 0.90718474 / 3.6, "stph", 1.0),
        ("power", 745.69987158, "hp", 1.0),
    ],
)
def test_factors(kind, value, sign, expected):
    """Exact by the international yard and pound; nine digits are printed here."""
    assert display_unit(kind, "US").label == sign
    assert display_unit(kind, "US").shown(value) == pytest.approx(expected, rel=1e-9)


def test_filling_is_bulk_over_what_the_belt_holds(line, all_of):
    """The flow raised by the inverse of the filling is what the belt holds on the level; half of it more is refused."""
    filled = all_of["filling of the belt (incline)"]
    assert filled.verdict == "pass"
    (percent,) = re.findall(r"(\d+) % of the cross-section on its slope", filled.found)
    share = float(percent) / 100.0 * line.section_on_slope(math.asin(70.0 / 700.0)) / line.section_on_slope(0.0)
    flow = line.material.flow
    line.replace(material={**line.material.as_data(), "flow": f"{1.5 * flow.magnitude / (share + 0.005):.6g} stph"})
    with pytest.raises(conveyor.InputError, match="needs a cross-section"):
        line.replace(material={**line.material.as_data(), "flow": f"{1.5 * flow.magnitude / (share - 0.005):.6g} stph"})


def test_on_a_slope_the_belt_holds_less():
    """ISO 5048: of the heap sqrt((cos²δ - cos²θ)/(1 - cos²θ)) stands on the slope, none where δ is θ."""
    made = loop_line(material={"surcharge_angle": "10 deg"})
    level = made.section_on_slope(0.0)
    trough = made.section_on_slope(math.radians(10.0))
    cos_d, cos_t = math.cos(math.asin(25.0 / 400.0)), math.cos(math.radians(10.0))
    k1 = math.sqrt((cos_d**2 - cos_t**2) / (1.0 - cos_t**2))
    (check,) = belt_filling(calculated(material={"surcharge_angle": "10 deg"}))
    assert (check.where, check.verdict) == ("b", "pass")
    assert check.required == pytest.approx(trough + k1 * (level - trough), rel=1e-12)
    steep = {"sections": [{"name": name, "length": "250 m", "slope": "12 deg"} for name in "abcd"]}
    flow = 0.5 * (level + trough) * 1600.0 * 4.0 * 3.6
    (check,) = belt_filling(calculated(material={"surcharge_angle": "10 deg", "flow": f"{flow} t/h"}, route=steep))
    assert check.failed
    assert check.required == pytest.approx(trough, rel=1e-12)


def test_motors_that_generate_are_held_to_the_friction_that_is_certain():
    """Downhill less friction brakes less: the motors hold what the least certain friction leaves them."""
    result = conveyor.analyse(conveyor.load(SPECS / "downhill_brakes.yaml"))
    motor, settled = result.balance.layout.motor, result.balance.equilibrium
    assert settled.least_force < settled.force < 0.0
    found = [check for check in result.checks if check.key == "motor_power"]
    for drive, check in zip(result.line.drives, found, strict=True):
        assert check.calculated == pytest.approx(-motor(drive.share * settled.least_force), rel=1e-12)
        assert (check.where, check.required) == ("least friction", drive.power)


def test_the_tension_for_sag_is_that_of_the_span(line):
    """T = (m_B + m_G) g a/(8 h/a), of the section that has least of it."""
    result = conveyor.analyse(line)
    for check in (check for check in result.checks if check.key == "sag"):
        strand = check.subject.text().rpartition(", ")[2]
        idlers = line.idlers.carry if strand == "carry" else line.idlers.return_
        spans = {
            stretch.section: (stretch.belt_mass + stretch.bulk_mass)
            * result.line.gravity
            * stretch.spacing
            / (8.0 * si(idlers.sag))
            for stretch in result.line.stretches
            if stretch.strand == strand
        }
        section = check.where.partition(", ")[0]
        assert check.required == pytest.approx(spans[section], rel=1e-12)
        assert check.verdict == "pass"


def test_the_classical_power_stands_on_page_one_with_its_difference_by_cause(line):
    """The causes add up to the power of the main resistance, the differences to that of the powers; three digits."""
    result = conveyor.analyse(line)
    rows = {row.subject: row for row in result.contents(system="SI")["governing_figures"].rows}
    row = rows["classical motor power, f = 0.02"]
    balance = result.balance
    there = balance.layout.motor(balance.classical.total)
    assert row.value == f"{there / 1e3:.3g} kW"
    pattern = r"f 0\.0200 for (0\.\d+) \(([\d,.]+) kW for ([\d,.]+) kW: ([^)]*)\)"
    f, by_f, main, parts = re.search(pattern, row.where).groups()
    assert float(f) == pytest.approx(balance.friction_factor, abs=5e-5)
    assert [part.rsplit(" ", 2)[0] for part in parts.split(", ")][:2] == ["indentation", "idler rotation"]
    kilowatts = [float(part.rsplit(" ", 2)[1].replace(",", "")) for part in parts.split(", ")]
    assert sum(kilowatts) == pytest.approx(float(main.replace(",", "")), rel=1e-2)
    per_newton = (there - balance.power.motor) / (balance.classical.total - balance.forces.total) / 1e3
    assert float(main.replace(",", "")) == pytest.approx(per_newton * balance.forces.main, rel=6e-3)
    assert float(by_f.replace(",", "")) == pytest.approx(per_newton * balance.classical.main, rel=6e-3)
    changes = [float(change) for change in re.findall(r"([+-][\d.]+) kW", row.where)]
    assert sum(changes) == pytest.approx((there - balance.power.motor) / 1e3, rel=2e-2)
    by_f = conveyor.analyse(line.replace(calculation=line.calculation.replace(method="din 22101")))
    assert not [row for row in by_f.contents()["governing_figures"].rows if row.subject.startswith("classical")]


@pytest.mark.parametrize("method", ["viscoelastic", "iso 5048"])
def test_six_figures_are_large_by_every_method(line, method):
    made = conveyor.analyse(line.replace(calculation=line.calculation.replace(method=method))).contents()
    for place in ("tile", "large"):
        assert len({figure.label for figure in made.figures_for(place)}) == 6


@pytest.mark.parametrize(("deepest", "verdict"), [(0.2, "pass"), (0.201, "FAIL")])
def test_small_strain_ends_at_a_fifth_of_the_cover(deepest, verdict):
    """Its mean strain under the roll is Δ/h; a fifth itself is still within, on each strand by itself."""
    covers = {strand: SimpleNamespace(thickness=0.006) for strand in STRANDS}
    contacts = SimpleNamespace(deepest=lambda strand: deepest if strand == "return" else 0.01, covers=covers)
    found = contact_checks.cover_penetration(SimpleNamespace(contacts=contacts))
    assert [check.verdict for check in found] == ["pass", verdict]


@pytest.mark.parametrize(
    ("data", "verdict", "decides"),
    [
        ((1.0, 500.0), "FAIL", 1000.0),
        ((50.0, 1e6), "FAIL", 10.0),
        ((8.0, 1e6), "pass", 10.0),
        ((1e-3, 1100.0), "pass", 1000.0),
        ((40.0, 900.0), "FAIL", 10.0),
    ],
)
def test_the_end_of_the_band_that_has_less_of_data_decides(data, verdict, decides):
    """10 to 1000 Hz: short by a factor of 2 above, of 5 below; to spare a factor of 1.25 below, of 1.1 above."""
    check = contact_checks._coverage_check("carry", "mine", (10.0, 1000.0), data, 293.15)
    assert (check.verdict, check.calculated) == (verdict, decides)
    assert check.required == (data[0] if decides == 10.0 else data[1])


def test_a_belt_is_slack_where_it_has_no_tension_at_all(line):
    """Not where it has little: that is for the sag; the lowest of every state of motion is held against 0 N."""
    calculation = calculate(line)
    (check,) = tension_checks.slack_belt(calculation)
    lowest = min(state.smallest for state in motion_states(calculation.balance, calculation.motions))
    assert (check.verdict, check.required) == ("pass", 0.0)
    assert check.calculated == pytest.approx(lowest, rel=1e-12)
