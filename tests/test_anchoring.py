"""Campaigns of rolling-resistance tests: read, beside the theory, to an anchored compound."""

from __future__ import annotations

import json
import math

import pytest

from conveyor import shelf
from conveyor.errors import InputError
from conveyor.indentation import RollContact, indentation_resistance
from conveyor.measured.rolling_test_table import read_rolling_tests
from conveyor.results import rolling_test_calibration
from tests.test_cli import run

HEAD = "line load [N/mm];resistance [N/m];roll diameter [mm];cover thickness [mm];speed [m/s];temperature [degC]"


@pytest.fixture(scope="module")
def carrier():
    return shelf.compound("standard-cover").replace(strain_dependence=None, tests=())


def theory(carrier, *point) -> float:
    """Resistance per width of one roll [N/m], load in N/mm, lengths in mm."""
    load, diameter, cover, speed, celsius = point
    rubber = carrier.series(celsius + 273.15)
    contact = RollContact(5e-4 * diameter, 1.0, 1e-3 * cover, speed, rubber)
    return float(indentation_resistance(contact, 1e3 * load).resistance)


def campaign(carrier, points, factor) -> str:
    rows = [
        ";".join(f"{value:.9g}" for value in (point[0], factor(*point) * theory(carrier, *point), *point[1:]))
        for point in points
    ]
    return "\n".join([HEAD, *rows, ""])


POINTS = [
    (load, diameter, cover, speed, celsius)
    for diameter, cover, speed in ((219, 7, 5), (159, 5, 2.5))
    for celsius in (-10, 20)
    for load in (1, 2, 4)
]


def test_known_factors_come_back_on_another_roll(carrier, tmp_path):
    """1.8 at -10 degC and 1.4 at 20 degC, falling with the load by its power -0.1, on two rolls, covers and speeds."""

    def factor(load, _diameter, _cover, _speed, celsius):
        return {-10: 1.8, 20: 1.4}[celsius] * load**-0.1

    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, factor), encoding="utf-8")
    tests = read_rolling_tests(path, "laboratory, report 7")
    assert len(tests) == 4
    assert all(len(test.line_load) == 3 and test.source == "laboratory, report 7" for test in tests)
    found = rolling_test_calibration.calibrate_compound(carrier, tests, name="acme-x", softened=False)
    # theory at the tests to 1e-4
    assert found.anchor.slope == pytest.approx(-0.1, abs=2e-4)
    assert found.anchor.factor(1e3, 263.15) == pytest.approx(1.8, rel=5e-4)
    assert found.anchor.factor(4e3, 278.15) == pytest.approx(math.sqrt(1.8 * 1.4) * 4.0**-0.1, rel=5e-4)
    assert max(abs(found.left(row)) for row in found.rows) < 5e-4
    assert (found.compound.name, found.compound.carrier) == ("acme-x", "standard-cover")
    assert "its spectrum, shift and strain dependence" in found.compound.missing[0]
    assert "standard-cover" in found.compound.description


@pytest.mark.parametrize(("times", "refused"), [(0.4, True), (0.6, False), (4.0, False), (14.0, True)])
def test_tests_far_from_any_published_ones_are_refused(carrier, tmp_path, times, refused):
    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, lambda *_: times), encoding="utf-8")
    tests = read_rolling_tests(path, "laboratory, report 7")
    if not refused:
        assert rolling_test_calibration.calibrate_compound(carrier, tests).anchor.levels == pytest.approx(
            math.log(times), abs=1e-3
        )
        return
    with pytest.raises(InputError, match=rf"{times:g} times the theory at -10 degC.*0\.5 to 5 are taken"):
        rolling_test_calibration.calibrate_compound(carrier, tests)


@pytest.mark.parametrize(("tilt", "said"), [(-1.2, "refused"), (-0.4, "remarked"), (0.0, "")])
def test_resistance_goes_with_the_line_load_as_rolls_have_it(carrier, tmp_path, tilt, said):
    """The theory times a power of the line load: of 1.3 to 1.5 of its own, 0.4 less is unusual, 1.2 less no roll's."""
    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, lambda load, *_: 1.5 * (load / 2.0) ** tilt), encoding="utf-8")
    tests = read_rolling_tests(path)
    if said == "refused":
        with pytest.raises(InputError, match=r"line load to the power of \d\.\d+, where rolls have 1\.1 to 1\.[45]"):
            rolling_test_calibration.calibrate_compound(carrier, tests, softened=False)
        return
    lines = rolling_test_calibration.calibration_notes(
        rolling_test_calibration.calibrate_compound(carrier, tests, softened=False)
    )
    assert any("is the drag of bearings in it" in line for line in lines) == (said == "remarked")


@pytest.mark.parametrize(
    ("field", "value", "remark"),
    [
        ("roll_diameter", "45 mm", "roll diameter 45 mm, usual are 50 to 250 mm: is it a radius, or a drum?"),
        ("roll_diameter", "400 mm", "roll diameter 400 mm, usual are 50 to 250 mm"),
        (
            "cover_thickness",
            "18 mm",
            "cover thickness 18 mm, usual are 1 to 15 mm: is it the thickness of the belt?",
        ),
    ],
)
def test_unusual_rolls_and_covers_are_remarked(carrier, tmp_path, field, value, remark):
    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, lambda *_: 1.5), encoding="utf-8")
    tests = read_rolling_tests(path)
    assert not any(
        "usual are" in line
        for line in rolling_test_calibration.calibration_notes(
            rolling_test_calibration.calibrate_compound(carrier, tests)
        )
    )
    changed = [tests[0].replace(**{field: value})]
    lines = rolling_test_calibration.calibration_notes(
        rolling_test_calibration.calibrate_compound(carrier, changed, softened=False)
    )
    assert any(remark in line for line in lines)


@pytest.mark.parametrize(("times", "remarked"), [(0.6, True), (0.8, False), (2.8, False), (3.5, True)])
def test_factors_beyond_published_ones_are_remarked(carrier, tmp_path, times, remarked):
    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, lambda *_: times), encoding="utf-8")
    lines = rolling_test_calibration.calibration_notes(
        rolling_test_calibration.calibrate_compound(carrier, read_rolling_tests(path))
    )
    assert any("published tests lie at 1 to 2.5" in line for line in lines) == remarked


def test_scatter_of_the_transfer_is_the_band(carrier, tmp_path):
    """A roll that reads 10 % higher than the other one does."""

    def factor(_load, diameter, *_):
        return 1.5 * (1.1 if diameter == 159 else 1.0)

    path = tmp_path / "campaign.csv"
    path.write_text(campaign(carrier, POINTS, factor), encoding="utf-8")
    tests = [test.replace(uncertainty="0 %") for test in read_rolling_tests(path)]
    found = rolling_test_calibration.calibrate_compound(carrier, tests, softened=False)
    assert found.compound.carrier is None
    # residuals are half of ln 1.1 everywhere: 12 rows, 3 parameters
    assert found.anchor.half_width == pytest.approx(1.644854 * 0.5 * math.log(1.1) * math.sqrt(12 / 9), rel=5e-3)
    assert any("4 tests" in line for line in rolling_test_calibration.calibration_notes(found))


def test_units_of_the_headers(tmp_path):
    path = tmp_path / "us.csv"
    head = "line load [lbf/in],rolling resistance [lbf/in],drum diameter [in],cover [in],belt speed [fpm]"
    path.write_text(
        f"{head},temperature [degF],uncertainty [%],specimen\n20,0.2,6,0.25,900,68,8,rubber\n",
        encoding="utf-8",
    )
    (test,) = read_rolling_tests(path)
    points = test.points()
    assert points.line_load == pytest.approx([20.0 * 4.4482216152605 / 0.0254])
    assert points.resistance == pytest.approx([0.2 * 4.4482216152605 / 0.0254])
    assert (points.radius, points.cover_thickness) == pytest.approx((0.0762, 0.00635))
    assert (points.speed, points.temperature) == pytest.approx((4.572, 293.15))
    assert (test.specimen, test.relative_uncertainty, test.source) == (
        "rubber",
        pytest.approx(0.08),
        "us.csv",
    )


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (HEAD, "no test in it"),
        (f"{HEAD}\n1;8100;219;7;5;20", r'c.csv:2: column 2 "resistance \[N/m\]".*is 8.1 of its line load'),
        (f"{HEAD}\n1;;219;7;5;20", r"resistance \[N/m\] is missing in the row"),
        (f"{HEAD}\n1;eight;219;7;5;20", r'c.csv:2: column 2 "resistance \[N/m\]"'),
        (f"{HEAD}\n1;8;219;7;5;20;spare", "a cell beyond the last header"),
        (f"{HEAD};load\n1;8;219;7;5;20;3", r'column 7 "load": not known; allowed: line load'),
        (HEAD.replace("[m/s]", "[m]") + "\n1;8;219;7;5;20", "speed"),
        (HEAD.replace(";temperature [degC]", "") + "\n1;8;219;7;5", r"no column temperature \[degC\]"),
        (f"{HEAD};rolling resistance [N/m]\n1;8;219;7;5;20;9", "has a resistance and a rolling resistance"),
        (f"{HEAD}\n1;8;219;7;5;-300", "temperature"),
    ],
)
def test_doubtful_campaigns_are_refused_at_their_row(text, match, tmp_path):
    path = tmp_path / "c.csv"
    path.write_text(text + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=match):
        read_rolling_tests(path)


def test_no_test_is_refused(carrier):
    with pytest.raises(InputError, match="give at least one"):
        rolling_test_calibration.calibrate_compound(carrier, [])


def test_the_command_writes_a_compound_that_specs_take(carrier, tmp_path):
    table = tmp_path / "campaign.csv"
    table.write_text(campaign(carrier, POINTS, lambda *_: 1.7), encoding="utf-8")
    own = tmp_path / "carrier.yaml"
    own.write_text(shelf.dump(carrier), encoding="utf-8")
    out = tmp_path / "acme-x.yaml"
    done = run("anchor", own, "--tests", table, "--name", "acme-x", "-o", out)
    assert done.returncode == 0, done.stderr
    for said in ("measured", "theory", "ratio", "1.700", "12 points of 4 tests"):
        assert said in done.stdout
    compound = shelf.compound(out)
    assert (compound.carrier, len(compound.tests)) == ("standard-cover", 4)
    told = json.loads(run("anchor", own, "--tests", table, "--json").stdout)
    assert told["carrier"] is None
    assert [round(row["factor"], 3) for row in told["levels"]] == [1.7, 1.7]
    refused = run("anchor", own, "--tests", table, "-o", table)
    assert refused.returncode == 2
    assert table.read_text(encoding="utf-8").startswith("line load")
