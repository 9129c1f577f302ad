"""Plain duties end with designs that pass every check, or with a limit that a formula by hand confirms."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from conveyor import shelf
from conveyor.calculated_conveyor import CalculatedConveyor, Variant
from conveyor.errors import NoSolutionError
from conveyor.laws.preliminary_sizing import annuity, wear_addition
from conveyor.line.stretches import STRANDS
from conveyor.line.usual_parts import usual_lump_factor
from conveyor.models.sizing import SizingDuty
from conveyor.pipeline import calculate_many
from conveyor.report.tables.sizing_tables import best_design_table
from conveyor.sizing import size_conveyor
from conveyor.sizing.design_search import _calibrate_estimate, _estimated_parts
from conveyor.sizing.design_spec import design_spec
from conveyor.sizing.screen import Candidates, first_calibration, screen_candidates
from conveyor.sizing.sized_design import SizedDesign
from conveyor.sizing.sizing_task import SizingTask
from conveyor.sizing.spacing import section_spacings
from conveyor.studies.loads import every_load
from conveyor.units import si

GRAVITY = 9.80665


def duty(flow: float, length: float, lift: float, *, density: float = 850.0, lump: float = 150.0, **more):
    """A duty of one slope [t/h, m, m, kg/m³, mm]; the rest as in `conveyor new --kind duty`."""
    return SizingDuty.from_data({
        "name": "plain",
        "material": {
            "name": "bulk", "density": f"{density} kg/m^3", "flow": f"{flow} t/h", "surcharge_angle": "20 deg"
        },
        "lump": f"{lump} mm",
        "length": f"{length} m",
        "lift": f"{lift} m",
        "ambient": {"temperature": "20 degC"},
        "operation": {"hours_per_year": "5000 h", "price": "0.12 EUR/kWh"},
        "covers": [shelf.compound("standard-cover")],
        **more,
    })  # fmt: skip


COLD = {"coldest": "0 degC"}
STONE = {"density": 1600.0}
PLAIN = {
    "take-up travel": (2000.0, 1500.0, 30.0, {}),
    "take-up travel, long": (2000.0, 3000.0, 30.0, {}),
    "take-up travel, stone": (1000.0, 1200.0, 15.0, STONE),
    "take-up travel, stone, long": (1000.0, 2000.0, 60.0, STONE | COLD),
    "backstop of the warm belt": (1000.0, 800.0, 15.0, STONE | COLD),
    "backstop of the warm belt, coal": (1000.0, 1000.0, 15.0, COLD),
    "backstop of the warm belt, long": (1000.0, 1200.0, 20.0, STONE | COLD),
    "motor of the warm belt": (175.0, 5680.0, -104.0, {"ambient": {"temperature": "-19 degC"}, "coldest": "-29 degC"}),
    "breaking away": (110.0, 573.0, -12.0, STONE | {"lump": 100.0, "ambient": {"temperature": "41 degC"}}),
    "US trade": (780.0, 3220.0, 47.0, STONE | {"report": {"units": "US"}}),
}  # fmt: skip


@pytest.mark.parametrize("of", PLAIN.values(), ids=PLAIN.keys())
def test_a_plain_duty_ends_with_a_design_that_holds_what_its_report_checks(of):
    """At the temperature of the duty and with its coldest covers, from the spec alone, in every load."""
    *figures, more = of
    given = duty(*figures, **more)
    best = size_conveyor(given, best=1).best
    coldest = given.ambient.belt if given.coldest is None else given.coldest
    for temperature in {si(coldest): coldest, si(given.ambient.belt): given.ambient.belt}.values():
        spec = best.conveyor.replace(ambient=best.conveyor.ambient.replace(belt_temperature=temperature))
        failed = [check for check in every_load(spec).governing if check.failed]
        assert not [check.subject.text() for check in failed]
    assert si(best.conveyor.material.flow) == pytest.approx(figures[0] / 3.6)
    assert _travel_by_hand(best, si(given.ambient.belt) - si(coldest)) <= si(given.rules.take_up_travel)


def _travel_by_hand(design: SizedDesign, warmth: float) -> float:
    """Hooke at the highest mean tension of the full belt, lasting stretch and growth, 20 % kept beyond [m]."""
    line, spec = design.found.line, design.conveyor
    means = [
        np.sum((state.starts + state.ends) / 2.0 * one.line.loop.length) / np.sum(one.line.loop.length)
        for one in design.pair
        for state in one.motion_states
    ]
    steel = spec.belt.carcass.kind == "steel cord"
    strain = max(means) / (line.belt.tensile_stiffness * line.belt.width)
    lasting = 1e-3 + 12e-6 * warmth if steel else 7.5e-3
    return 1.2 * line.length * (strain + lasting)


def test_a_class_stiff_enough_for_the_take_up_is_chosen_where_the_strength_alone_asks_for_less():
    """1,747 m of grain: fabric strong enough stretches too far by load and lasting stretch, a stronger one does not."""
    given = duty(1600.0, 1750.0, 0.0, density=750.0, lump=5.0, rules={"carcasses": ["EP"]})
    best = size_conveyor(given, best=1).best
    classes = SizingTask(given).carcasses["EP"]
    weaker = [one for one in classes if one.strength < best.chosen.carcass.strength][-1]
    tension = best.found.balance.equilibrium.steady.largest
    assert weaker.strength > 8.0 * tension / best.choice.trough.width.belt  # DIN 22101: safety 8
    spec = design_spec(SizingTask(given), best.choice, _of_class(given, best, weaker), "x")
    (as_weak,) = calculate_many([Variant(spec)])
    assert isinstance(as_weak, CalculatedConveyor)
    assert _travel_by_hand(replace(best, found=as_weak, coldest=as_weak), 0.0) > 30.0
    assert _travel_by_hand(best, 0.0) <= 30.0


def _of_class(given: SizingDuty, best: SizedDesign, carcass):
    top, bottom = SizingTask(given).covers(best.choice, carcass)
    return replace(best.chosen, carcass=carcass, top=top, bottom=bottom)


def _figures(message: str, unit: str) -> list[float]:
    """Figures of a message in a unit, in order."""
    return [float(each.replace(",", "")) for each in re.findall(rf"([\d,.]+) {unit}", message)]


def test_a_lift_that_no_motor_gives_is_refused_with_the_power_it_needs():
    """Q g H of the lift alone, over the efficiency and with the reserve, on the most pulleys that the rules allow.

    With two motors a pulley, as is usual, it is a design.
    """
    given = duty(6400.0, 1800.0, 150.0, density=2200.0, lump=100.0, abrasiveness="high")
    one_each = given.replace(rules={"motors_per_pulley": 1})
    with pytest.raises(
        NoSolutionError, match=r"a drive pulley needs motors of .*\(rules\.motors_per_pulley"
    ) as refused:
        size_conveyor(one_each)
    needed, allowed = _figures(str(refused.value), "kW")
    lifting = 6400.0 / 3.6 * GRAVITY * 150.0 / 0.94 * 1.1 / 3.0 / 1e3
    assert allowed == 1000.0
    assert lifting < needed < 1.5 * lifting
    sizing = size_conveyor(given, best=1)
    with_two = sizing.best
    assert sum(with_two.chosen.motors) / 3.0 >= lifting * 1e3
    tile = next(row.value for row in best_design_table(sizing, "SI").rows if row.label == "motors")
    count, each = re.fullmatch(r"(\d)\s×\s(\d+) kW", tile).groups()
    assert int(count) == 6
    assert int(count) * float(each) == pytest.approx(sum(with_two.chosen.motors) / 1e3, rel=1e-12)


def test_a_carcass_that_stretches_too_far_for_good_is_refused_with_the_travel_it_needs():
    """0.75 % of 6 km and 20 % beyond are 54 m."""
    given = duty(500.0, 6000.0, 0.0, rules={"carcasses": ["EP"]})
    message = r"lasting stretch of EP belts alone asks for 54 m .* 30 m are allowed: .*take_up_travel\), or steel cord"
    with pytest.raises(NoSolutionError, match=message):
        size_conveyor(given)
    with pytest.raises(
        NoSolutionError, match=r"steel cord belts alone asks for 7\.2 m .*, 5 m are .*take_up_travel\)$"
    ):
        size_conveyor(given.replace(rules={"carcasses": ["steel cord"], "take_up_travel": "5 m"}))


def test_a_take_up_too_short_for_the_load_is_refused_with_the_travel_it_needs():
    """Of 1,000 m of fabric 9 m are lasting stretch; the load adds at most what a class of safety 8 bears."""
    given = duty(1000.0, 1000.0, 15.0, rules={"carcasses": ["EP"], "take_up_travel": "9.5 m"})
    with pytest.raises(NoSolutionError, match=r"its take-up needs .* of travel, .*\(rules\.take_up_travel") as refused:
        size_conveyor(given)
    needed, allowed = _figures(str(refused.value).partition("take-up needs")[2], "m")
    assert allowed == 9.5
    assert 9.5 < needed < 1.2 * 1000.0 * (7.5e-3 + 1.0 / 8.0 / 5.0)  # EA 5 times the strength: at most all of it
    longer = given.replace(rules=given.rules.replace(take_up_travel=f"{1.02 * needed} m"))
    assert size_conveyor(longer, best=1).best.uses["take-up travel"] <= 1.0


def test_a_climb_that_no_class_bears_is_refused_with_the_strength_it_needs():
    """The tension at the head is more than the bulk's weight on the slope; EP1600 has a safety of 8 to 1600 N/mm."""
    given = duty(2000.0, 600.0, 150.0, rules={"carcasses": ["EP"], "widths": ["1400 mm"], "speeds": ["4 m/s"]})
    with pytest.raises(NoSolutionError, match=r"asks for a belt of .*, the strongest .* 1,600 N/mm") as refused:
        size_conveyor(given)
    needed, strongest = _figures(str(refused.value), "N/mm")
    least = 8.0 * 2000.0 / 3.6 / 4.0 * GRAVITY * 150.0 / 1.4 / 1e3
    assert strongest == 1600.0
    assert least < needed < 2.0 * least
    assert re.search(r"The nearest \(1,400 mm, 4 m/s, EP; drives: ", str(refused.value))


def test_what_a_stiffer_class_leaves_of_the_travel_is_foreseen():
    """The share of the travel used with the strongest class is that of a calculation with it, to what its mass adds."""
    given = duty(1000.0, 1000.0, 15.0, rules={"carcasses": ["EP"]})
    best, task = size_conveyor(given, best=1).best, SizingTask(given)
    strongest = task.carcasses["EP"][-1]
    spec = design_spec(task, best.choice, _of_class(given, best, strongest), "x")
    (found,) = calculate_many([Variant(spec)])
    assert isinstance(found, CalculatedConveyor)
    by_hand = _travel_by_hand(replace(best, found=found, coldest=found), 0.0)
    assert best.uses["take-up travel"] * 30.0 == pytest.approx(
        by_hand, rel=0.05
    )  # the belt's mass is a tenth more, a third of it elastic


def test_a_belt_that_would_go_slack_in_a_stop_has_its_take_up_set_higher():
    """2.5 km that climb 300 m stop hard: at the least setting that grip and sag ask for the belt is slack behind."""
    rules = {
        "widths": ["1000 mm"],
        "speeds": ["3.5 m/s"],
        "drives": ["head, two pulleys"],
        "trough_angles": ["35 deg"],
    }
    best = size_conveyor(duty(1000.0, 2500.0, 300.0, rules=rules), best=1).best
    assert best.conveyor.route.take_up is not None
    assert si(best.conveyor.route.take_up.tension) == pytest.approx(best.chosen.take_up)
    assert not [check.subject.text() for check in every_load(best.conveyor).governing if check.failed]
    least = best.conveyor.route.replace(take_up={"kind": "gravity"})
    loose = every_load(best.conveyor.replace(route=least))
    assert {check.key for check in loose.governing if check.failed} == {"slack_belt"}
    slack = -min(state.smallest for one in loose.designing for state in one.motion_states)
    assert 0.0 <= best.chosen.take_up - loose.take_up - slack < 0.05 * best.chosen.take_up  # a wider class weighs more
    first, second, *_ = best.found.pulley_duty  # both driven pulleys stand in the spec
    assert (first.pulley.name, second.pulley.name) == ("head", "head 2")
    steady = best.found.balance.equilibrium.steady
    assert [side.arriving for side in steady.drives] == pytest.approx([p.steady.arriving for p in (first, second)])
    assert first.steady.leaving == pytest.approx(second.steady.arriving, rel=1e-3)  # nothing but a pulley between


def test_levels_of_one_calculation_make_the_estimate_that_calculation():
    given = duty(800.0, 300.0, 20.0)
    task = SizingTask(given)
    choices, levels = Candidates.of(task), first_calibration(1)
    estimate = screen_candidates(task, choices, levels)
    i = int(np.argmin(estimate.year))
    (found,) = calculate_many(
        [Variant(design_spec(task, choices[i], _estimated_parts(task, choices[i], estimate, i), "probe"))]
    )
    assert isinstance(found, CalculatedConveyor)
    again = screen_candidates(task, choices, made := _calibrate_estimate(choices, estimate, levels, {i: found}, {}))
    assert again.carcass[i] == estimate.carcass[i]
    forces = found.balance.forces
    main = {force.key: force for force in found.balance.along}
    for k, strand in enumerate(STRANDS):
        assert again.scaled_forces[i, k] == pytest.approx(main["indentation"].by_strand()[strand], rel=1e-9)
    assert made.drag * again.rolls[i] == pytest.approx(main["idler_rotation"].total, rel=1e-9)
    assert again.rest[i] == pytest.approx(forces.secondary + forces.special, rel=1e-9)
    used = {
        "belt strength": 1.01 * float(again.uses["belt strength"][i]),
        "motor power": 0.9 * float(again.uses["motor power"][i]),
    }
    leveled = screen_candidates(task, choices, _calibrate_estimate(choices, again, made, {i: found}, {i: used}))
    for limit, share in used.items():
        assert leveled.uses[limit][i] == pytest.approx(share, rel=1e-9)


@pytest.mark.parametrize(
    ("price", "dearer"),
    [
        ("set", "75 EUR/m"),
        ("cover", "5000 EUR/m^3"),
        ("special_cover", "6500 EUR/m^3"),
        ("drive", "10000 EUR"),
    ],
)
def test_the_estimate_costs_the_parts_of_a_candidate(price, dearer):
    """A price raised by a quarter adds a quarter of that part's annuity and upkeep, of amounts counted by hand."""
    given = duty(
        800.0,
        300.0,
        20.0,
        covers=[shelf.compound(name) for name in ("standard-cover", "low-rolling-resistance-cover")],
    )
    task = SizingTask(given)
    choices = Candidates.of(task)
    levels = first_calibration(2)
    estimate = screen_candidates(task, choices, levels)
    usual = given.prices.amounts
    costly = SizingTask(given.replace(prices={price: dearer}))
    assert costly.duty.prices.amounts[price] == pytest.approx(1.25 * usual[price])
    dear = screen_candidates(costly, Candidates.of(costly), levels).year
    rate = {"set": "years", "drive": "years"}.get(price, "textile_life")
    for cover in (0, 1):
        rows = np.flatnonzero((choices.numbers[:, 3] == cover) & np.isfinite(estimate.year))
        i = int(rows[np.argmin(estimate.year[rows])])
        choice, width = choices[i], choices[i].trough.width.belt
        carcass = task.carcasses[choice.kind][int(estimate.carcass[i])]
        assert carcass.kind == "EP"
        top, bottom = task.covers(choice, carcass)
        count = {
            "set": width * (300.0 / choice.carry + 300.0 / choice.back),
            "cover": 600.0 * width * (top + bottom if cover == 0 else top),
            "special_cover": 600.0 * width * (bottom if cover == 1 else 0.0),
            "drive": {"head": 1.0, "tail": 1.0, "head, two pulleys, and tail": 3.0}.get(choice.drives, 2.0),
        }[price]
        yearly = float(annuity(usual[rate], interest=usual["interest"])) + usual["upkeep"]
        assert dear[i] - estimate.year[i] == pytest.approx(
            0.25 * usual[price] * count * yearly, rel=1e-6, abs=1e-9 * estimate.year[i]
        )


def test_what_a_distance_is_worth_is_what_the_energy_of_a_year_costs():
    """Indentation and rotation of all sections at the distances built are their shares of the energy's cost."""
    given = duty(800.0, 300.0, 20.0)
    best = size_conveyor(given, best=1).best
    rows = list(section_spacings(SizingTask(given), best))
    indentation, rotation = (
        next(force.total for force in best.found.balance.along if force.key == key)
        for key in ("indentation", "idler_rotation")
    )
    running = 5000.0 * 0.12 * best.choice.speed / 0.94 / 1e3  # [EUR/(a N)]: W to kW, hours, price
    assert math.fsum(row.grows * math.cbrt(row.built) * row.length for row in rows) == pytest.approx(
        indentation * running, rel=1e-9
    )
    frames = best.costs.yearly["rolls"] * (1.0 + best.costs.capital["idler frames"] / best.costs.capital["rolls"])
    falls = math.fsum(row.falls / row.built * row.length for row in rows)
    assert falls == pytest.approx(rotation * running + float(frames), rel=0.02)  # a set more or less at the ends


def test_lumps_and_wear_are_of_the_bulk_at_its_heaviest():
    """By hand: the wear addition and the lump factor of 1.5 t/m³ where 0.85 t/m³ fills the belt."""
    loose, heavy = (
        SizingTask(given.replace(material=given.material.replace(weight_density=weight)))
        for given in (duty(1000.0, 800.0, 15.0),)
        for weight in (None, "1500 kg/m^3")
    )
    assert heavy.density == loose.density
    for task, density in ((loose, 850.0), (heavy, 1500.0)):
        alone = wear_addition(
            lump=task.lump, density=density, round_time=2.0 * task.length / 2.5,
            abrasiveness=task.duty.abrasiveness, loading=task.duty.loading,
        )  # fmt: skip
        assert task.wear(2.5) == pytest.approx(alone, rel=1e-12)
        assert task.lump_factor == pytest.approx(usual_lump_factor(task.lump, density) or 1.0, rel=1e-12)
