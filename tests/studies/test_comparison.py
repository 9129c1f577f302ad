"""Compounds on one conveyor: the figures of `analyse`, in bulk; ranking, band, coverage, refusals."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple
from multiprocessing import get_context

import numpy as np
import pytest

from conveyor import shelf
from conveyor.errors import ConveyorError, InputError
from conveyor.models import RubberCompound
from conveyor.models.variants import with_compound
from conveyor.pipeline import calculate
from conveyor.report.merged_notes import sort_notes
from conveyor.report.tables.comparison_notes import comparison_notes
from conveyor.report.tables.ranking_tables import rank_compounds
from conveyor.rubber.lots import LOT_SCATTER
from conveyor.spec import load
from conveyor.studies.comparison import RTOL, RankedPower, compare_compounds
from conveyor.studies.duty import analyse_duty
from conveyor.units import quantity, si

SPEC = "examples/specs/overland.yaml"
NAMES = ["standard-cover", "low-rolling-resistance-cover", "s100"]
TEMPERATURES = ["-10 degC", "0 degC", "20 degC"]
SPEEDS = ["4.5 m/s", "5 m/s"]
COSTS = {"low-rolling-resistance-cover": 10_000.0, "S100": 50_000.0}


@pytest.fixture(scope="module")
def line():
    """The example with a given friction to design for: without it a comparison has the expected one."""
    given = load(SPEC)
    return given.replace(drive=given.drive.replace(design_friction="120 %"))


@pytest.fixture(scope="module")
def found(line):
    return compare_compounds(
        line, NAMES, temperatures=TEMPERATURES, speeds=SPEEDS, base="standard-cover", extra_costs=COSTS
    )


def scene(found, name, temperature, speed):
    (one,) = [
        s
        for s in found.scenes
        if (s.compound, s.speed) == (name, speed) and s.temperature == pytest.approx(temperature, abs=1e-9)
    ]
    return one


@pytest.mark.parametrize(("name", "celsius", "speed"), [("standard-cover", 20, 5.0), ("S100", 0, 4.5)])
def test_scenes_are_analyses(line, found, name, celsius, speed):
    changed = with_compound(line, shelf.compound(name), "bottom")
    alone = calculate(
        changed.replace(
            belt=changed.belt.replace(speed=f"{speed} m/s"),
            ambient=changed.ambient.replace(temperature=f"{celsius} degC"),
        )
    )
    one = scene(found, name, celsius + 273.15, speed)
    # contacts to 1e-4 here, to 1e-6 there
    assert one.indentation == pytest.approx(alone.balance.forces.indentation, rel=one.error)
    assert one.motor == pytest.approx(alone.balance.power.motor, rel=one.error)
    assert one.largest_tension == pytest.approx(alone.balance.tensions.largest, rel=one.error)
    assert one.cost_per_year == pytest.approx(alone.year.cost, rel=one.error)


def test_every_scene_is_answered_once(found):
    assert len(found.scenes) == len(NAMES) * len(TEMPERATURES) * len(SPEEDS)
    assert not found.refused
    keys = [(s.compound, s.speed, s.temperature) for s in found.scenes]
    assert len(set(keys)) == len(keys)
    assert max(s.error for s in found.scenes) <= 1e-4


def test_without_temperatures_and_speeds_those_of_the_spec(line):
    (one,) = compare_compounds(line, ["standard-cover"]).scenes
    assert (one.temperature, one.speed) == (si(line.ambient.belt), si(line.belt.speed))


def test_band_is_what_the_replicas_make_of_the_power(line, found):
    # the band is formed from the roll that loses most; all rolls of every replica are the full calculation
    one = scene(found, "S100", 293.15, 5.0)
    compound = shelf.compound("s100")
    powers = []
    for band in compound.replicas(si(compound.reference_temperature)):
        prony = compound.prony.replace(
            equilibrium=quantity(f"{band.equilibrium} Pa"),
            terms=[{"modulus": f"{e} Pa", "time": f"{t} s"} for e, t in zip(band.moduli, band.times, strict=True)],
            band=None,
        )
        other = compound.replace(prony=prony)
        (replica,) = compare_compounds(line, [other], temperatures=["20 degC"], speeds=["5 m/s"]).scenes
        powers.append(replica.motor)
    low, high = np.quantile(powers, (0.05, 0.95), method="weibull")
    (one,) = compare_compounds(line, [compound], temperatures=["20 degC"], speeds=["5 m/s"], lot_scatter=0.0).scenes
    assert one.motor_low < one.motor < one.motor_high
    width = high - low
    # other rolls and the softening at each replica's own strain move the ends by a part of the band
    assert one.motor_low == pytest.approx(low, abs=0.15 * width)
    assert one.motor_high == pytest.approx(high, abs=0.15 * width)


def test_band_of_two_replicas_is_both_of_them(line):
    # one is the fit, which leaves the power as it is; with two, nine tenths reach to both
    compound = shelf.compound("s100")
    fit = compound.series(si(compound.reference_temperature))
    band = {
        "method": "by hand",
        "equilibrium": [f"{share * fit.equilibrium!r} Pa" for share in (1.0, 1.5)],
        "unit": "Pa",
        "moduli": [[share * modulus for modulus in fit.moduli.tolist()] for share in (1.0, 1.5)],
    }
    stiff = compound.replace(prony=compound.prony.replace(band=band))
    (one,) = compare_compounds(line, [stiff], lot_scatter=0.0).scenes
    assert one.motor_low < 0.99 * one.motor  # stiff rubber is indented less
    assert one.motor_high == pytest.approx(one.motor, rel=1e-9)


def test_without_replicas_and_tests_the_band_is_that_of_lots(line):
    cover = shelf.compound("standard-cover")
    untested = cover.replace(strain_dependence=None, tests=(), prony=cover.prony.replace(band=None))
    alone = compare_compounds(line, [untested], lot_scatter=0.1)
    (one,) = alone.scenes
    # the drives' efficiency is constant: power goes with the indentation, all of it but the flexure
    assert one.motor_high - one.motor == pytest.approx(0.1 * one.rubber, rel=1e-9)
    assert one.motor - one.motor_low == pytest.approx(0.1 * one.rubber, rel=1e-9)
    # the rolls of the carry side have most of both strands' indentation
    assert 0.5 < one.rubber / (one.motor * one.indentation / one.effective) < 1.0
    assert any("hold the scatter of lots alone" in said for said in comparison_notes(alone))


def test_compounds_with_sweeps_beside_those_without_are_said(line):
    swept = shelf.compound("s100")
    bare = swept.replace(name="bare", strain_dependence=None)

    def told(*compounds, **calculation):
        spec = line.replace(calculation=line.calculation.replace(**calculation))
        return [said for said in comparison_notes(compare_compounds(spec, compounds)) if "no strain sweeps" in said]

    (said,) = told(swept, bare)
    assert said.startswith('"bare": no strain sweeps, which the others have')
    assert told(swept, swept.replace(name="again")) == told(swept, bare, strain="off") == []


def test_lots_are_given_or_those_of_the_file_or_a_default(line):
    one, other = (shelf.compound(name) for name in NAMES[:2])
    stated = other.replace(lot_scatter="3 %")
    default, filed = compare_compounds(line, [one, stated]).lots.values()
    assert default == (LOT_SCATTER, "default")
    assert (filed.half_width, filed.origin) == (pytest.approx(0.03), "compound")
    given = compare_compounds(line, [one, stated], lot_scatter={stated.name.upper(): 0.02}).lots
    assert [lot.half_width for lot in given.values()] == [LOT_SCATTER, 0.02]
    said = " ".join(comparison_notes(compare_compounds(line, [one, stated])))
    assert f'"{one.name}": scatter from lot to lot assumed, 8 % of the indentation' in said
    assert f'"{stated.name}": 3.0 % of indentation from lot to lot, as stated' in said
    with pytest.raises(InputError, match=r"lot_scatter of .*: got 0\.6, allowed: >= 0 and <= 0\.5"):
        compare_compounds(line, [one], lot_scatter=0.6)


def test_the_default_of_lots_follows_from_hardness_and_loss_tangent():
    """Gent (1958): E = 0.0981 (56 + 7.62336 S)/(0.137505 (254 - 2.54 S)) MPa; indentation goes as tan δ E^(-1/3)."""

    def modulus(shore):
        return 0.0981 * (56.0 + 7.62336 * shore) / (0.137505 * (254.0 - 2.54 * shore))

    stiffness = 0.5 * np.log(modulus(63.0) / modulus(57.0))
    assert stiffness == pytest.approx(0.12, abs=0.005)
    assert np.hypot(stiffness / 3.0, 0.07) == pytest.approx(LOT_SCATTER, abs=0.005)


def test_a_difference_is_what_both_errors_leave_of_it(found):
    """Own errors by the root of their squares; a common one by what it has of the difference."""
    less = RankedPower(NAMES[1], 100.0, (5.0, 5.0), (3.0, 3.0))  # common 4
    more = RankedPower(NAMES[0], 120.0, (13.0, 13.0), (5.0, 5.0))  # common 12
    assert found.difference(more, less) == pytest.approx((20.0 - np.sqrt(98.0), 20.0 + np.sqrt(98.0)))
    assert found.difference(less, more) == pytest.approx((-20.0 - np.sqrt(98.0), -20.0 + np.sqrt(98.0)))


def test_one_rubber_measured_twice_is_not_told_apart(line):
    """Neither a rank, a saving nor a payback: their intervals hold nothing saved."""
    one = shelf.compound("s100")
    again = one.replace(name="again", prony=one.prony.replace(equilibrium=quantity("3.45 MPa")))
    both = compare_compounds(line, [one, again], temperatures=["20 degC"], extra_costs={"again": 2e4})
    rows = {row.compound: row for row in rank_compounds(both, both.scenes[0].speed)}
    assert [row.rank for row in rows.values()] == [1, 1]
    base, other = rows[one.name], rows["again"]
    assert (base.verdict, other.verdict) == ("base", "cannot be told apart")
    assert other.payback is None
    least, largest = other.savings
    assert least < 0.0 < largest
    assert other.paybacks == (pytest.approx(2e4 / largest), np.inf)
    # the power at the ends of the interval, at the price of the year
    price = other.cost / other.motor
    assert largest - least == pytest.approx(price * (other.apart[1] - other.apart[0]), rel=1e-6)
    assert any('"again" and the base "S100" cannot be told apart' in said for said in comparison_notes(both))


def test_coverage_is_the_excited_band_of_the_analysis(line, found):
    changed = with_compound(line, shelf.compound("standard-cover"), "bottom")
    bands = []
    for speed in SPEEDS:
        result = calculate(changed.replace(belt=changed.belt.replace(speed=speed)))
        bands.append(result.contacts.excited_band("carry"))
    (row,) = [c for c in found.coverage if c.compound == "standard-cover" and abs(c.temperature - 293.15) < 1e-9]
    # curves of 1e-4 are sampled at other half widths than those of 1e-6
    assert row.excited == pytest.approx((bands[0][0], bands[1][1]), rel=0.02)
    assert row.covered


def test_data_that_do_not_reach_are_said(line):
    compound = shelf.compound("standard-cover").as_data()
    compound["range"]["frequency"] = ["1 Hz", "100 Hz"]
    narrow = RubberCompound.from_data(compound)
    found = compare_compounds(line, [narrow])
    assert not found.coverage[0].covered


def test_refused_scenes_have_their_reasons(line):
    found = compare_compounds(
        line, ["s100", "standard-cover"], temperatures=["-35 degC", "20 degC"], speeds=["1 m/s", "5 m/s"]
    )
    reasons = {(r.compound, r.speed, round(r.temperature - 273.15)): r.reason for r in found.refused}
    assert "is known from -29.7409 degC" in reasons["S100", 5.0, -35]
    assert "needs a cross-section" in reasons["standard-cover", 1.0, 20]
    assert {(s.compound, round(s.temperature - 273.15)) for s in found.scenes} == {
        ("S100", 20),
        ("standard-cover", -35),
        ("standard-cover", 20),
    }


@pytest.mark.parametrize(("cover", "carry", "back"), [("bottom", 1, 0), ("top", 0, 1), ("both", 1, 1)])
def test_covers(line, cover, carry, back):
    changed = with_compound(line, shelf.compound("s120"), cover)
    assert (changed.carry_compound.name == "S120") == bool(carry)
    assert (changed.return_compound.name == "S120") == bool(back)


def test_a_top_cover_that_followed_the_bottom_keeps_its_rubber(line):
    belt = line.belt
    plain = line.replace(belt=belt.replace(top_cover={"thickness": belt.top_cover.thickness}))
    assert plain.return_compound.name == plain.carry_compound.name
    changed = with_compound(plain, shelf.compound("s120"), "bottom")
    assert changed.return_compound.name == plain.carry_compound.name


def test_softened_compounds_are_compared_softened(line):
    on = compare_compounds(line, ["s100"]).scenes[0]
    linear = line.replace(calculation=line.calculation.replace(strain="off"))
    off = compare_compounds(linear, ["s100"]).scenes[0]
    assert on.indentation > 1.05 * off.indentation


@pytest.mark.parametrize(
    ("names", "options", "message"),
    [
        ([], {}, "give at least one"),
        (["s100", "S100"], {}, '"S100" is given twice'),
        (["s100"], {"base": "s120"}, '"s120" is none of the compounds compared: S100'),
        (["s100"], {"extra_costs": {"x": 1.0}}, '"x" is none of the compounds compared'),
        (["s100"], {"temperatures": ["20"]}, "20"),
        (["s100"], {"temperatures": []}, "temperatures: give at least one"),
        (["s100"], {"speeds": ["20 degC"]}, "speed"),
        (["s100", "s120"], {"extra_costs": {"s120": np.nan}}, 'extra_costs of "S120": got nan, allowed: finite'),
        (["s100", "s120"], {"extra_costs": {"S100": 5.0}}, 'extra_costs: got one for the base "S100"'),
        (["nope"], {}, 'unknown compound "nope"'),
    ],
)
def test_refusals(line, names, options, message):
    with pytest.raises(InputError, match=message):
        compare_compounds(line, names, **options)


def test_workers_find_what_one_process_does(line, found):
    seen = []
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as processes:
        beside = compare_compounds(
            line,
            NAMES,
            temperatures=[quantity(one) for one in TEMPERATURES],
            speeds=SPEEDS,
            executor=processes,
            workers=2,
            progress=lambda *told: seen.append(told),
        )
    assert seen == [(0, 3), (1, 3), (3, 3)]
    assert len(beside.scenes) == len(found.scenes)
    for one, other in zip(beside.scenes, found.scenes, strict=True):
        # rounding of contacts solved beside others
        assert astuple(one)[0] == astuple(other)[0]
        for mine, theirs in zip(astuple(one)[1:-1], astuple(other)[1:-1], strict=True):
            assert mine == (theirs if theirs is None else pytest.approx(theirs, rel=1e-8))
    assert [(o.compound, o.temperature, o.covered) for o in beside.coverage] == [
        (o.compound, o.temperature, o.covered) for o in found.coverage
    ]


def test_a_lost_worker_is_told(line):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as processes:

        def told(*_):
            processes.submit(int).result()
            for process in processes._processes.values():
                process.kill()

        with pytest.raises(ConveyorError, match="a worker of the comparison was lost"):
            compare_compounds(line, NAMES, executor=processes, progress=told)


def test_remarks_are_in_the_units_asked_for():
    line = load("examples/specs/in_plant_us.yaml")
    turning = compare_compounds(line, NAMES[:2], temperatures=["0 degF", "100 degF"], speeds=["400 fpm"])
    metric, us = (" ".join(comparison_notes(turning, system)) for system in ("SI", "US"))
    easy = "low-rolling-resistance-cover, then standard-cover"
    together = "low-rolling-resistance-cover and standard-cover, which cannot be told apart"
    assert f"least motor power first, at 2.032 m/s: -17.78 °C: {together}; 37.78 °C: {easy}" in metric
    assert f"first, at 400 fpm: 0 °F: {together}; 100 °F: {easy}" in us
    assert "m/s" not in us
    _, basis = sort_notes(comparison_notes(turning, "US"))
    assert any(said.startswith("90 % bands are of the rubber alone") for said in basis)


def test_compounds_apart_by_less_than_both_may_be_off_are_one_group(found):
    """Gaps against the root of the squares: 3 up of the one, 4 down of the other are 5 together."""

    def one(name, motor, whole, own):
        return RankedPower(name, motor, (whole, whole), (own, own))

    standard, easy = (shelf.compound(name) for name in NAMES[:2])
    assert {test.conditions for test in standard.tests} == {test.conditions for test in easy.tests}
    assert found.tested_alike(*NAMES[:2])
    assert not found.tested_alike("standard-cover", "S100")
    for gap, apart in ((4.9, False), (5.1, True)):
        # what belts tested alike share does not count between them
        least, most = one(NAMES[1], 100.0, 50.0, 3.0), one(NAMES[0], 100.0 + gap, 50.0, 4.0)
        assert found.differs_clearly(least, most) == apart
        assert [len(group) for group in found.groups([most, least])] == ([1, 1] if apart else [2])
        # it does against one that was not
        other = one("S100", 100.0 + gap, 4.0, 0.1)
        assert found.differs_clearly(one(NAMES[1], 100.0, 3.0, 0.1), other) == apart
    # a third that is near the second but not near the first begins a group of its own
    three = [one(name, motor, 50.0, 3.0) for name, motor in zip(NAMES[:2], (100.0, 103.0), strict=True)]
    assert [[s.motor for s in group] for group in found.groups([*three, one(NAMES[0], 106.0, 50.0, 3.0)])] == [
        [100.0, 103.0],
        [106.0],
    ]


def test_the_ranking_in_the_cold_is_that_of_the_trade(line):
    names = ["standard-cover", "low-rolling-resistance-cover", "cold-resistant-cover"]
    cold = compare_compounds(line, names, temperatures=["-25 degC"], speeds=["5 m/s"])
    by_power = sorted(cold.scenes, key=lambda one: one.motor)
    assert by_power[0].compound == "cold-resistant-cover"
    assert any("which cannot be told apart" in said for said in comparison_notes(cold))
    warm = compare_compounds(line, names, temperatures=["20 degC"], speeds=["5 m/s"])
    (first, *_, last) = warm.groups(RankedPower.of([one]) for one in warm.scenes)
    assert "low-rolling-resistance-cover" in {one.compound for one in first}
    assert {one.compound for one in last} == {"standard-cover"}


def test_a_factor_of_the_belt_that_ran_is_said(line):
    def told(factor):
        given = line.calculation.replace(calibration={"indentation": factor, "idler_rotation": 0.9})
        return " ".join(comparison_notes(compare_compounds(line.replace(calculation=given), NAMES[:2])))

    assert "indentation x 1.25 of every compound, a factor found with the belt that ran" in told(1.25)
    assert "calculation.calibration" not in told(1.0)


def test_progress_counts_the_compounds(line):
    seen = []
    compare_compounds(line, NAMES[:2], progress=lambda done, total: seen.append((done, total)))
    assert seen == [(0, 2), (1, 2), (2, 2)]


@pytest.mark.parametrize("spec", ["examples/specs/downhill_brakes.yaml", "examples/specs/in_plant_us.yaml"])
def test_curves_and_regeneration_are_those_of_the_analysis(spec):
    line = load(spec)
    line = line.replace(drive=line.drive.replace(design_friction="120 %"))
    name = line.carry_compound.name
    (one,) = compare_compounds(line, [line.carry_compound], cover="bottom").scenes
    alone = calculate(line)
    assert one.compound == name
    # tensions in the curves are iterated to the tolerance of the contacts
    assert one.indentation == pytest.approx(alone.balance.forces.indentation, rel=3e-4)
    assert one.motor == pytest.approx(alone.balance.power.motor, rel=3e-4)
    assert one.largest_tension == pytest.approx(alone.balance.tensions.largest, rel=3e-4)


def test_a_duty_decides_the_year():
    """Saving is the difference of two duty studies, not of full load at one temperature all year."""
    line = load(SPEC)
    duty = [
        {"hours": "3000 h", "share": "100 %"},
        {"hours": "1500 h", "share": "60 %", "temperature": "0 degC"},
    ]
    held = {key: value for key, value in line.operation.as_data().items() if key != "hours_per_year"}
    line = line.replace(operation={**held, "duty": duty})
    names = ["standard-cover", "low-rolling-resistance-cover"]
    found = compare_compounds(line, names, speeds=["5 m/s", "5.5 m/s"])
    assert set(found.years) == set(names)
    for name in names:
        alone = analyse_duty(with_compound(line, shelf.compound(name), "bottom"), rtol=RTOL)
        assert found.years[name].cost == pytest.approx(alone.cost, rel=1e-12)
        assert found.years[name].year.net_kwh == pytest.approx(alone.year.net_kwh, rel=1e-12)


def test_the_interval_of_a_duty_is_that_of_its_bars():
    """Whatever temperatures are compared: was taken there, and the payback with it."""
    line, names, rows = load(SPEC), NAMES[:2], []
    held = {key: value for key, value in line.operation.as_data().items() if key != "hours_per_year"}
    duty = [{"hours": "3000 h", "share": "100 %"}, {"hours": "1500 h", "share": "0 %", "temperature": "0 degC"}]
    line = line.replace(operation={**held, "duty": duty})
    for temperatures in (["20 degC"], ["-10 degC", "30 degC"]):
        made = compare_compounds(line, names, temperatures=temperatures, extra_costs={NAMES[1]: 9000.0})
        (row,) = (one for one in rank_compounds(made, made.conveyor.belt_speed) if one.compound == NAMES[1])
        rows.append(row)
    one, other = rows
    assert one.apart != pytest.approx(other.apart, rel=1e-3)
    assert one.savings == pytest.approx(other.savings, rel=1e-9)
    assert one.savings[0] < one.saving < one.savings[1]
    assert one.paybacks == pytest.approx(other.paybacks, rel=1e-9)
    assert one.payback == other.payback
    assert (one.payback is None) == (one.savings[0] <= 0.0 <= one.savings[1])
    (said,) = (said for said in comparison_notes(made) if "operation.duty" in said)
    assert said.endswith("no payback where the saving's interval holds zero")


def test_the_interval_of_a_duty_at_full_load_is_that_of_the_hours():
    """One bar at full load and the temperature compared: as all hours of a year without a duty, within the contacts'
    tolerance; the take-up for the friction to design for tightens the belt by less than a per cent of power."""
    line = load(SPEC)
    held = {key: value for key, value in line.operation.as_data().items() if key != "hours_per_year"}
    barred = line.replace(operation={**held, "duty": [{"hours": line.operation.hours_per_year, "share": "100 %"}]})
    (plain, bar) = (
        next(row for row in rank_compounds(made, line.belt_speed) if row.compound == NAMES[1])
        for made in (compare_compounds(each, NAMES[:2]) for each in (line, barred))
    )
    for mine, theirs in zip(bar.savings, plain.savings, strict=True):
        assert mine - bar.saving == pytest.approx(theirs - plain.saving, rel=0.02)


def test_a_cheaper_belt_pays_at_once():
    line = load(SPEC)
    made = compare_compounds(line, NAMES[:2], extra_costs={NAMES[1]: -100.0})
    (row,) = (one for one in rank_compounds(made, line.belt_speed) if one.compound == NAMES[1])
    assert (row.payback, row.paybacks) == (0.0, (0.0, 0.0))


@pytest.mark.parametrize("drag", [None, "3 N"])
def test_what_follows_the_temperature_is_said(line, drag):
    idlers = line.idlers
    if drag is not None:
        sets = {name: getattr(idlers, name) for name in ("carry", "return_")}
        idlers = idlers.replace(
            **{name: one.replace(roll=one.roll.replace(drag=drag, drag_law=None)) for name, one in sets.items()}
        )
    made = compare_compounds(line.replace(idlers=idlers), NAMES[:1])
    (said,) = (said for said in comparison_notes(made) if said.startswith("means over temperatures"))
    assert said.endswith(
        "only indentation follows the temperature"
        if drag
        else "indentation and the drag of rolls without a given one follow the temperature"
    )
