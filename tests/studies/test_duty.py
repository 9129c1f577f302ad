"""A year of a conveyor: sums of its bars, each calculated; price, credit, carbon dioxide; refusals."""

from __future__ import annotations

from pathlib import Path

import pytest

from conveyor.checks import run_checks
from conveyor.errors import InputError
from conveyor.models import Conveyor, DutyEntry
from conveyor.models.operation import EmissionFactor, Operation
from conveyor.pipeline import calculate
from conveyor.remarks.result_warnings import analysis_warnings
from conveyor.spec import load
from conveyor.studies.comparison import compare_compounds
from conveyor.studies.duty import analyse_duty
from conveyor.units import si

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
RTOL = 1e-4
"""Of the contacts, for both sides of a comparison: load ranges differ, so that figures differ by up to twice it."""
HOURS = {"hours": "1000 h", "share": "100 %"}


@pytest.fixture(scope="module")
def line() -> Conveyor:
    return load(SPECS / "overland.yaml")


@pytest.fixture(scope="module")
def downhill() -> Conveyor:
    return load(SPECS / "downhill.yaml")


def operated(given: Conveyor, *duty: dict[str, object], **more: object) -> Conveyor:
    return given.replace(operation={"duty": list(duty), **more})


TRAIN = [
    {"name": "motor", "efficiency": "95 %", "side": "mains"},
    {"name": "converter", "efficiency": "98 %", "side": "mains"},
]


@pytest.mark.parametrize("train", [[], TRAIN])
def test_without_a_duty_the_year_is_that_of_the_analysis(line, train):
    line = line.replace(drive={**line.drive.as_data(), "train": train})
    alone = calculate(line)
    power, year = alone.balance.power, alone.year
    assert power.mains == pytest.approx(power.motor / (0.95 * 0.98 if train else 1.0), rel=1e-14)
    assert year.energy == pytest.approx(power.mains * si(line.operation.hours_per_year) / 3.6e6, rel=1e-14)
    study = analyse_duty(line)
    assert study.year.net_kwh == pytest.approx(year.energy, rel=1e-14)
    assert study.cost == pytest.approx(year.cost, rel=1e-14)
    assert study.energy_per_tonne_km == pytest.approx(power.energy_per_tonne_km, rel=1e-13)
    assert study.emission is None
    assert study.currency == "EUR"


def test_what_is_fed_back_loses_in_the_converter_too(downhill):
    made = downhill.replace(drive={**downhill.drive.as_data(), "train": TRAIN}, operation={"hours_per_year": "4000 h"})
    alone = calculate(made)
    power = alone.balance.power
    assert power.motor < 0.0
    assert power.mains == pytest.approx(power.motor * 0.95 * 0.98, rel=1e-14)
    assert alone.year.energy == pytest.approx(analyse_duty(made).year.net_kwh, rel=1e-14)


def test_a_bar_cut_in_two_changes_nothing(line):
    whole = analyse_duty(operated(line, {"hours": "3000 h", "share": "80 %"}), rtol=RTOL)
    parts = analyse_duty(
        operated(line, {"hours": "1000 h", "share": 0.8}, {"hours": "2000 h", "share": "80 %"}), rtol=RTOL
    )
    assert parts.year.net_kwh == pytest.approx(whole.year.net_kwh, rel=1e-14)
    assert parts.energy_per_tonne_km == pytest.approx(whole.energy_per_tonne_km, rel=1e-14)


def test_every_bar_is_the_analysis_at_its_load_temperature_and_speed(line):
    study = analyse_duty(
        operated(line, HOURS, {"hours": "500 h", "share": "60 %", "temperature": "5 degC", "speed": "4.5 m/s"}),
        rtol=RTOL,
    )
    alone = line.replace(
        material=line.material.replace(flow="1440 t/h"),
        belt=line.belt.replace(speed="4.5 m/s"),
        ambient=line.ambient.replace(temperature="5 degC"),
        calculation=line.calculation.replace(rtol=RTOL),
    )
    row = study.rows[1]
    assert row.shaft == pytest.approx(calculate(alone).balance.power.motor, rel=2.0 * RTOL)
    assert row.energy == pytest.approx(row.shaft * 500.0 / 1e3, rel=1e-14)
    assert row.mass == pytest.approx(1440e3 * 500.0, rel=1e-12)
    # not the full load scaled: the empty belt and the rolls remain
    assert row.shaft > 0.6 * study.rows[0].shaft * 4.5 / 5.0


def test_the_year_is_the_sum_of_its_bars(line):
    made = operated(
        line,
        HOURS,
        {"hours": "300 h", "share": 0.0},
        price="0.2 USD/kWh",
        emission="350 kg/MWh",
        emission_source="test",
    )
    study = analyse_duty(made, rtol=RTOL)
    total = sum(row.energy for row in study.rows)
    assert study.year.drawn_kwh == pytest.approx(total, rel=1e-14)
    assert study.year.fed_back_kwh == 0.0
    assert study.cost == pytest.approx(0.2 * total, rel=1e-14)
    assert study.emission == pytest.approx(0.35 * total, rel=1e-14)
    assert study.emission_source == "test"
    tonne_km = 2400.0 * 1000.0 * line.route.length / 1e3
    assert study.energy_per_tonne_km == pytest.approx(total / tonne_km, rel=1e-12)
    assert study.currency == "USD"
    assert study.year.time / 3600.0 == pytest.approx(1300.0)


def test_an_empty_year_has_no_energy_per_tonne(line):
    study = analyse_duty(operated(line, {"hours": "10 h", "share": 0.0}), rtol=RTOL)
    assert study.energy_per_tonne_km is None


@pytest.mark.parametrize(("feed_in", "price"), [({}, 0.0), ({"feed_in_price": "0.05 EUR/kWh"}, 0.05)])
def test_energy_fed_back_is_worth_the_same_in_a_flat_year_a_duty_and_a_comparison(downhill, feed_in, price):
    """Even hours once earned the price of energy drawn; the same year as one bar of a duty earned nothing."""
    flat = downhill.replace(operation={"hours_per_year": "5000 h", "price": "0.1 EUR/kWh", **feed_in})
    bar = operated(downhill, {"hours": "5000 h", "share": "100 %"}, price="0.1 EUR/kWh", **feed_in)
    found = calculate(flat)
    power = found.balance.power
    assert power.mains < 0.0
    expected = price * 5000.0 * power.mains / 1e3
    assert found.year.cost == pytest.approx(expected, rel=1e-12, abs=1e-9)
    told = [warning.text() for warning in analysis_warnings(found, run_checks(found))]
    said = "operation.feed_in_price not given: energy that is fed back earns nothing"
    assert (said in told) == (not feed_in)
    for spec in (flat, bar):
        assert analyse_duty(spec).cost == pytest.approx(expected, rel=1e-12, abs=1e-9)
    name = downhill.carry_compound.name
    of_hours = compare_compounds(flat, [name])
    assert of_hours.scenes[0].cost_per_year == pytest.approx(expected, rel=1e-3, abs=1e-9)
    of_bars = compare_compounds(bar, [name])
    assert of_bars.years[name].cost == pytest.approx(expected, rel=1e-3, abs=1e-9)


def test_downhill_feeds_back_and_earns_only_its_credit(downhill):
    bars = (HOURS, {"hours": "500 h", "share": 0.0})
    plain = analyse_duty(operated(downhill, *bars, price="0.1 EUR/kWh"), rtol=RTOL)
    assert plain.rows[0].mains < 0.0 < plain.rows[1].mains
    assert plain.year.fed_back_kwh == pytest.approx(-plain.rows[0].energy)
    assert plain.cost == pytest.approx(0.1 * plain.rows[1].energy)  # nothing is credited unasked
    paid = analyse_duty(operated(downhill, *bars, price="0.1 EUR/kWh", feed_in_price="0.04 EUR/kWh"), rtol=RTOL)
    assert paid.cost == pytest.approx(0.1 * plain.rows[1].energy + 0.04 * plain.rows[0].energy)
    saved = analyse_duty(
        operated(downhill, *bars, emission="400 g/kWh", feed_in_emission="0.1 t/MWh", emission_source="test"),
        rtol=RTOL,
    )
    assert saved.emission == pytest.approx(0.4 * plain.rows[1].energy + 0.1 * plain.rows[0].energy)


def test_losses_between_mains_and_motor_count_in_the_energy(line):
    drive = line.drive.replace(train=[{"name": "motor", "efficiency": "95 %", "side": "mains"}])
    with_motor = analyse_duty(line.replace(drive=drive), rtol=RTOL)
    assert with_motor.year.drawn_kwh * 0.95 == pytest.approx(analyse_duty(line, rtol=RTOL).year.drawn_kwh, rel=1e-13)


# the model --------------------------------------------------------------------------------------------------------


def test_hours_of_the_year_are_those_of_the_duty():
    made = Operation.from_data({"duty": [HOURS, {"hours": "2 d", "share": 0.0}]})
    assert si(made.hours_per_year) == pytest.approx(1048.0 * 3600.0)
    assert Operation.from_data(made.as_data()) == made
    assert isinstance(made.duty[0], DutyEntry)


@pytest.mark.parametrize(
    ("text", "amount"),
    [("0.35 kg/kWh", 0.35), ("350 g/kWh", 0.35), ("350 kg/MWh", 0.35), ("0.35 t/MWh", 0.35)],
)
def test_emission_factors_in_their_units(text, amount):
    made = Operation.from_data({"hours_per_year": "1 h", "emission": text, "emission_source": "s"})
    assert isinstance(made.emission, EmissionFactor)
    assert made.emission.amount == pytest.approx(amount, rel=1e-15)
    assert made.as_data()["emission"] == text


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({}, "hours_per_year: missing"),
        ({"hours_per_year": "9 h", "duty": [HOURS]}, "got 9 h, the hours of duty add up to 1000 h; leave"),
        ({"duty": [{"hours": "5000 h", "share": 1.0}] * 2}, "got 10000 h in all, a year has at most 8784 h"),
        ({"duty": [{"hours": "5 h"}]}, r"^duty\[0\].share: missing"),
        ({"duty": [{"hours": "5 h", "share": "300 %"}]}, "got 300 %, allowed: >= 0 % and <= 200 %"),
        (
            {"hours_per_year": "9 h", "emission": "0.3 kg/kWh"},
            "emission_source: missing: an emission factor holds",
        ),
        (
            {"hours_per_year": "9 h", "emission": 0.3},
            'got "0.3", expected a mass of carbon dioxide per energy',
        ),
        ({"hours_per_year": "9 h", "feed_in_price": "1 EUR/kWh"}, "price: missing: feed_in_price is given"),
        (
            {"hours_per_year": "9 h", "price": "1 EUR/kWh", "feed_in_price": "1 USD/kWh"},
            "got USD, price is in EUR; use one currency",
        ),
        (
            {"hours_per_year": "9 h", "feed_in_emission": "1 kg/kWh"},
            "emission: missing: feed_in_emission is given",
        ),
    ],
)
def test_operations_that_contradict_themselves_are_refused(data, message):
    with pytest.raises(InputError, match=message):
        Operation.from_data(data)


def test_refusals_name_the_bar(line):
    with pytest.raises(InputError, match="operation: missing; hours_per_year or duty"):
        analyse_duty(line.replace(operation=None))
    with pytest.raises(InputError, match=r"operation.duty\[1\] \(5 h, share 200 %\): material.flow: got 4800 t/h"):
        analyse_duty(operated(line, HOURS, {"hours": "5 h", "share": "200 %"}))
    with pytest.raises(InputError, match=r"operation.duty\[0\] \(5 h, share 100 %, 190 degC\): ambient.temperature"):
        analyse_duty(operated(line, {"hours": "5 h", "share": "100 %", "temperature": "190 degC"}))


def test_a_duty_has_the_only_year(line):
    """Not that of the own load through all hours beside it: scenes of a comparison told 10 % more on the 10 km belt."""
    spec = operated(line, HOURS, {"hours": "1000 h", "share": "50 %"}, price="0.1 EUR/kWh")
    assert calculate(spec).year is None
    name = spec.carry_compound.name
    compared = compare_compounds(spec, [name])
    assert compared.years[name].cost == pytest.approx(analyse_duty(spec).cost, rel=RTOL)
    assert {(one.energy_per_year, one.cost_per_year) for one in compared.scenes} == {(None, None)}
