"""Designs over their states: a year as `analyse_duty` has it, reductions, limits, the front, what is written."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError
from conveyor.languages.translator import report_translator
from conveyor.models.study import StudyPlan
from conveyor.remarks.assumptions import stepped_drags
from conveyor.report.tables.design_tables import study_contents
from conveyor.results.analysis import analyse_studies
from conveyor.studies.design_figures import pareto_front, weighted_mean, weighted_percentile
from conveyor.studies.duty import analyse_duty
from conveyor.studies.evaluation import study_objectives, summarise_study
from conveyor.studies.parametric_study import ParametricStudy, ResultStore, design_results, run_study
from conveyor.studies.points import OUTPUTS
from conveyor.studies.study_file import read_plan
from conveyor.units import si
from tests.command_line import run as command

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
DUTY = [
    {"hours": "2000 h", "share": "100 %"},
    {"hours": "500 h", "share": "50 %", "temperature": "0 degC"},
    {"hours": "100 h", "share": "0 %"},
]
PLAN = {
    "name": "n",
    "base": "shuttle.yaml",
    "axes": {"belt.speed": ["1 m/s", "1.2 m/s"], "idlers.carry.spacing": ["1 m", "1.2 m"]},
    "states": "duty",
    "figures": [
        "cost_per_year",
        "energy_per_year",
        "motor_power highest",
        "motor_power 90 %",
        "motor_power 99.5 %",
        "motor_power",
    ],
    "best": {"energy_per_year": "least", "belt_safety lowest": "most"},
}


@pytest.fixture(scope="module")
def line():
    given = conveyor.load(SPECS / "shuttle.yaml")
    return given.replace(operation={"price": "0.1 EUR/kWh", "duty": DUTY})


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    with ResultStore(tmp_path_factory.mktemp("answers") / "a") as known:
        yield known


def campaign(line, **changes):
    return ParametricStudy.of(StudyPlan.from_data(PLAN | changes), line, shelf.compound)


def designed(line, known, **changes):
    study = campaign(line, **changes)
    run_study(study, known)
    return study, list(design_results(study, known))


@pytest.mark.parametrize(
    "plan",
    [
        {"states": [], "figures": ["energy_per_year"], "best": {}},
        {"states": [], "figures": [], "best": {"cost_per_year": "least"}},
        {"states": [], "figures": [], "best": {}, "outputs": ["motor_power", "energy_per_year"]},
        {"figures": ["cost_per_year mean"], "best": {}},
    ],
)
def test_a_year_beside_that_of_the_duty_is_refused(line, plan):
    with pytest.raises(InputError, match=r"per_year.*: the year of this spec is that of its duty; give states: duty"):
        campaign(line, **plan)


def test_points_of_a_spec_with_a_duty_have_no_year_of_their_own(line, answers):
    study = campaign(line, states=[], figures=[], best={}, outputs=[])
    run_study(study, answers)
    assert {one.figures["energy_per_year"] for one in design_results(study, answers)} <= {None}


def test_a_design_over_the_duty_is_the_year_that_the_duty_gives(line, answers):
    _, (first, *_) = designed(line, answers)
    changed = line.replace(
        belt=line.belt.replace(speed="1 m/s"),
        idlers=line.idlers.replace(carry=line.idlers.carry.replace(spacing="1 m")),
    )
    year = analyse_duty(
        changed,
    )
    shafts, hours = np.array([row.shaft for row in year.rows]), np.array([row.hours for row in year.rows])
    expected = {
        "cost_per_year": year.cost,
        "energy_per_year": 3.6e6 * year.year.net_kwh,
        "motor_power highest": shafts.max(),
        "motor_power 90 %": shafts.max(),  # 2000 of 2600 h, the rest is less
        "motor_power": shafts @ hours / hours.sum(),
    }
    assert {key: first.figures[key] for key in expected} == pytest.approx(expected, rel=2e-4)


def test_percentiles_are_of_hours():
    values, hours = np.array([3.0, 1.0, 2.0]), np.array([1.0, 5.0, 4.0])
    assert [weighted_percentile(values, hours, share) for share in (0.5, 0.51, 0.9, 0.91)] == [
        1.0,
        2.0,
        2.0,
        3.0,
    ]
    assert weighted_mean(values, hours) == pytest.approx(1.6)
    assert weighted_mean(np.full(3, 7.0), hours) == pytest.approx(7.0)


def test_the_front_is_that_of_the_definition():
    rng = np.random.default_rng(1)
    for width in (1, 2, 3):
        costs = rng.integers(0, 12, (60, width)).astype(float)
        beaten = [any((other <= one).all() and (other < one).any() for other in costs) for one in costs]
        assert pareto_front(costs).tolist() == [not each for each in beaten]


def test_entries_of_a_duty_that_are_alike_are_one_state(line):
    """A key stands for one answer: two points of one key would be solved in other batches by other workers."""
    parted = [DUTY[0] | {"hours": "1500 h"}, *DUTY[1:], DUTY[0] | {"hours": "500 h"}]
    once, twice = (
        campaign(line.replace(operation={"price": "0.1 EUR/kWh", "duty": duty})).plan for duty in (DUTY, parted)
    )
    assert twice.hours == pytest.approx(once.hours)
    assert list(twice.points_of({})) == list(once.points_of({}))


def test_a_climate_table_gives_states_and_alike_rows_are_one(tmp_path):
    (tmp_path / "year.csv").write_text("hours [h];ambient.temperature [degC]\n10;5\n20;6\n30;5\n", encoding="utf-8")
    file = tmp_path / "study.json"
    file.write_text(json.dumps(PLAN | {"states": "year.csv"}), encoding="utf-8")
    plan = read_plan(file)
    assert plan.hours == (40.0, 20.0)
    assert [row["ambient.temperature"] for row in plan.states] == ["5 degC", "6 degC"]
    assert plan.count == 4 * 2
    for table, said in (
        ("hours\n1\n", "every state has to change a field"),
        ("hours,ambient.temperature [degC]\n,5\n", r"year.csv:2: expected 2 cells"),
        (
            "hours,ambient.temperature [degC]\n-1,5\n",
            r'year.csv:2: column 1 "hours": got "-1.0", expected a time above 0',
        ),
        ("# measured\nhours,ambient.temperature [degC]\n\n-1,5\n", r"year.csv:4: column 1"),
        (
            "hours,a.b [degC],a.b [degC]\n1,5,6\n",
            r"year.csv:1: column 3: a.b has a column already; leave one",
        ),
        ("# 2026\nhours,a.b [degC],hours [h]\n1,5,6\n", r"year.csv:2: column 3: hours has a column already"),
        (
            "hours,a.b [degC]\n1,warm\n2,5\n-1,cold\n",
            r'(?s):2: column 2 "a.b \[degC\]": expected a number.*:4: .*:4: ',
        ),
        ("hours,ambient temperature\n1,5\n", "expected a column a field"),
        ("hours,belt.speed [m/s]\n1,5\n", "belt.speed: varied twice"),
    ):
        (tmp_path / "year.csv").write_text(table, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_plan(file)


def test_every_fault_of_a_study_has_its_file_line_and_column(tmp_path):
    (tmp_path / "year.csv").write_text("hours [h],ambient.temperature [m]\n1,5\n2,5\n3,6\n", encoding="utf-8")
    file = tmp_path / "study.yaml"
    file.write_text(
        f"name: n\nbase: {SPECS / 'shuttle.yaml'}\naxes:\n  belt.sped: [1 m/s]\n  belt.speed: [1 m/s, 1 kg]\n"
        "  belt: [1 m/s]\n  belt.top_cover.compound: [standard-cover, nope]\nstates: year.csv\n"
        "outputs: [motor_power, power]\n",
        encoding="utf-8",
    )
    with pytest.raises(InputError) as refused:
        conveyor.study(file)
    told = [line.removeprefix(f"{tmp_path}/") for line in str(refused.value).splitlines()]
    for line, said in zip(
        told,
        (
            "study.yaml:4:3 axes.belt.sped: no such field; did you mean speed?",
            'study.yaml:5:23 axes.belt.speed[1]: got "1 kg" (a mass), expected a speed such as',
            'study.yaml:6:10 axes.belt[0]: got "1 m/s" for a group of fields; name one field of it',
            'study.yaml:7:45 axes.belt.top_cover.compound[1]: unknown compound "nope"',
            'study.yaml:9:24 outputs[1]: no figure "power"; there are motor_power',
            'year.csv:2: column 2: ambient.temperature: got "5 m" (a length), expected a temperature',
            'year.csv:4: column 2: ambient.temperature: got "6 m" (a length), expected a temperature',
        ),
        strict=True,
    ):
        assert line.startswith(said)
    file.write_text("name: n\nbase: no.yaml\naxes: {belt.speed: [1 m/s]}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"study.yaml:2:1 base: .*no.yaml: no such file$"):
        conveyor.study(file)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"limits": {"motor_power": {"least": "3 MW", "most": "1 kW"}}}, "least, 3 MW, is above most, 1 kW"),
        ({"axes": {"belt": ["1 m/s"]}}, 'belt: got "1 m/s" for a group of fields'),
        ({"states": [{"hours": "1 h", "belt.speed": "1 m/s"}]}, "belt.speed: varied twice"),
        ({"states": [{"hours": "1 kg", "material.flow": "1 t/h"}]}, "expected a time"),
        ({"states": [{"hours": "9000 h", "material.flow": "1 t/h"}]}, "a year has at most 8784 h"),
        ({"states": [{"material.flow": "1 t/h"}, {"material.flow": "2 t/h"}]}, "the states have no hours"),
        ({"figures": ["motor_power most"]}, 'no figure "motor_power most"; expected'),
        ({"figures": ["motor_power 100 %"]}, "above 0 and below 100 %; of all there is motor_power highest"),
        (
            {"limits": {"motor_power": {"most": "3 kg"}}},
            'limits: motor_power: got "3 kg", expected a value such as',
        ),
        ({"limits": {"belt_safety lowest": {"least": "3 m"}}}, "expected a number"),
        ({"limits": {"belt_safety lowest": {}}}, "give least, most or both"),
        ({"states": "year.csv"}, "was not read"),
    ],
)
def test_what_cannot_be_reduced_is_refused(line, changes, said):
    with pytest.raises(InputError, match=said):
        campaign(line, **changes)


def test_without_a_duty_or_a_price_there_is_no_cost(line):
    for operation, said in ((None, "no operation.duty"), ({"duty": DUTY}, "no operation.price")):
        with pytest.raises(InputError, match=said):
            campaign(line.replace(operation=operation))


def test_limits_and_front_and_what_fields_do(line, answers):
    _, every = designed(line, answers)
    highest = sorted(one.figures["motor_power highest"] for one in every)
    limit = {"motor_power highest": {"most": f"{(highest[1] + highest[2]) / 2.0:.9g} W"}}
    study, every = designed(line, answers, limits=limit)
    found = summarise_study(study, every)
    assert sum(one.keeps for one in every) == found.keeps.sum() == 2
    assert [one.broken for one in every if not one.keeps] == [("motor_power highest",)] * 2
    assert [one.keeps for one in found.best] == [True, True, False, False]
    energies = [one.figures["energy_per_year"] for one in found.best]
    assert energies[0] <= energies[1]
    assert not (found.front & ~found.keeps).any()
    for field in range(2):
        effects = found.effects(field)
        assert [effect.count for effect in effects] == [2, 2]
        assert np.mean([effect.mean for effect in effects]) == pytest.approx(found.found[:, 0].mean())


def test_means_of_draws_have_a_standard_error_that_counts_each_draw_once(line, answers):
    drawn = {"belt.speed": {"low": "1 m/s", "high": "1.4 m/s"}}
    study, every = designed(
        line,
        answers,
        axes={"idlers.carry.spacing": ["1 m", "1.2 m"]},
        samples={"count": 12, "fields": drawn},
        states=[],
        figures=["motor_power"],
        best={},
    )
    found = summarise_study(study, every)
    by_path = {one.path: found.effects(k) for k, one in enumerate(found.fields)}
    assert [effect.error for effect in by_path["idlers.carry.spacing"]] == [None, None]
    speeds = found.values[:, [one.path for one in found.fields].index("belt.speed")]
    edges = np.linspace(speeds.min(), speeds.max(), 9)
    for effect in by_path["belt.speed"]:
        low, high = edges[np.searchsorted(edges, effect.at) - 1 :][:2]
        inside = (speeds >= low) & ((speeds < high) | (high == edges[-1]))
        means = [found.found[inside & (speeds == one), 0].mean() for one in np.unique(speeds[inside])]
        assert effect.count == 2 * len(means)
        if len(means) == 1:
            assert effect.error is None
        else:
            assert effect.error == pytest.approx(np.std(means, ddof=1) / np.sqrt(len(means)), rel=1e-9)
    assert any(effect.error for effect in by_path["belt.speed"])
    table = study_contents(found, "SI")["effects"]
    assert [column.key for column in table.columns][-1] == "error"


def test_a_design_with_a_state_without_an_answer_says_which(line, answers):
    states = [{"material.flow": "10 t/h"}, {"material.flow": "90000 t/h"}]
    study, every = designed(
        line, answers, states=states, figures=["motor_power"], best={}, axes={"belt.speed": ["1 m/s"]}
    )
    assert every[0].why.startswith("state 2: material")
    found = summarise_study(study, every)
    assert (found.count, len(found.values), sum(found.refused.values())) == (1, 0, 1)


def test_the_command_writes_page_figures_designs_and_specs_that_power_reads(tmp_path):
    file = tmp_path / "study.json"
    states = [{"hours": 2000, "material.flow": "100 t/h"}, {"hours": 600, "material.flow": "50 t/h"}]
    plan = PLAN | {
        "base": str(SPECS / "shuttle.yaml"),
        "states": states,
        "axes": {"belt.speed": ["1 m/s", "1.2 m/s"]},
    }
    plan |= {
        "figures": ["motor_power highest"],
        "together": [{"idlers.carry.spacing": "1 m", "idlers.return.spacing": "2 m"}],
    }
    file.write_text(json.dumps(plan | {"best": {"motor_power highest": "least"}}), encoding="utf-8")
    outputs = ("--designs", "d.csv", "-o", "p.html", "--plots", "plots", "--specs", "best")
    given = [str(tmp_path / one) if "." in one or one in {"plots", "best"} else one for one in outputs]
    done = command("study", file, "-o", tmp_path / "t.csv", *given)
    assert done.returncode == 0, done.stderr
    assert "motor power, highest" in " ".join(done.stdout.split())
    with (tmp_path / "d.csv").open(encoding="utf-8-sig", newline="") as table:
        rows = list(csv.DictReader(table))
    assert len(rows) == 2
    # of the two fields of the one row nothing varies: no map of two fields
    assert {path.name for path in (tmp_path / "plots").iterdir()} == {"effects.png", "lines.png"}
    page = (tmp_path / "p.html").read_text(encoding="utf-8")
    assert "Main effects" in page
    assert '<section aria-labelledby="effects">' in page  # paper has the figure, if not the table that is folded away
    assert "<svg" in page
    specs = sorted((tmp_path / "best").iterdir())
    assert len(specs) == 2
    shown = command("power", specs[0], "--json", "--set", "material.flow=100 t/h")
    highest = min(float(row["motor power, highest [kW]"]) for row in rows)
    assert json.loads(shown.stdout)["power_kW"]["motor"] == pytest.approx(
        highest,
        rel=1e-3,  # the take-up of every load and its wraps
    )


def test_energy_is_paid_at_the_price_of_the_design(line, answers):
    """Listed or drawn; energy is that of the same states."""
    prices = {"operation.price": ["0.1 EUR/kWh", "0.25 EUR/kWh"]}
    _, (cheap, dear) = designed(line, answers, axes=prices, figures=["cost_per_year", "energy_per_year"], best={})
    assert cheap.figures["energy_per_year"] == dear.figures["energy_per_year"]
    assert dear.figures["cost_per_year"] == pytest.approx(2.5 * cheap.figures["cost_per_year"])
    drawn = {"operation.price": {"low": "0.1 EUR/kWh", "high": "0.25 EUR/kWh"}}
    samples = {"count": 4, "fields": drawn}
    _, some = designed(line, answers, axes={}, samples=samples, figures=["cost_per_year"], best={})
    costs = [one.figures["cost_per_year"] / cheap.figures["cost_per_year"] for one in some]
    told = [float(one.changes["operation.price"].split()[0]) / 0.1 for one in some]
    assert costs == pytest.approx(told)
    with pytest.raises(InputError, match=r"got 0.1 USD/kWh, the study's costs are in EUR"):
        campaign(line, axes={"operation.price": ["0.1 USD/kWh"]})


ALL_LOADS = [key for key, one in OUTPUTS.items() if one.of == "loads"]


def test_figures_of_all_loads_are_those_of_power(tmp_path):
    """In any state of the design: what `power` finds of the design's spec."""
    given = conveyor.load(SPECS / "overland_10km.yaml")
    axes = {"belt.speed": ["5.5 m/s", "4 m/s"]}  # overfull at 4 m/s
    plan = {
        "axes": axes,
        "figures": ["motor_power highest", *ALL_LOADS],
        "limits": {"all_loads_failed": {"most": 0}},
    }
    with ResultStore(tmp_path / "a") as known:
        study, (own, slower) = designed(given, known, **plan, best={})
        assert {len(study.answer(known, (study.key(p), p))) for p in study.require_list_plan().points()} == {
            1 + len(ALL_LOADS)
        }
    assert own.keeps
    assert slower.broken == ("all_loads_failed",)
    found = conveyor.analyse(given)
    studied = analyse_studies(given, found)
    plain = found.at_common_take_up(studied).to_dict(studied)
    governing = [check for check in plain["checks"] if check["governs"]]
    assert own.figures["all_loads_failed"] == sum(check["verdict"] == "fail" for check in governing) == 0
    assert own.figures["all_loads_take_up"] == pytest.approx(plain["take_up"]["setting_N"])
    power, safety = (
        next(check["calculated"] for check in governing if check["key"] == key)
        for key in ("motor_power", "belt_safety")
    )
    assert own.figures["all_loads_motor_power"] == pytest.approx(1e3 * power)
    assert own.figures["all_loads_motor_use"] == pytest.approx(1e3 * power / si(given.drive.installed_power))
    assert own.figures["all_loads_belt_safety"] == pytest.approx(safety)
    assert own.figures["all_loads_tension"] > own.figures["all_loads_take_up"]


def test_a_belt_by_its_rating_has_a_use_and_no_safety(tmp_path):
    given = conveyor.load(SPECS / "in_plant_us.yaml")
    plan = {"axes": {"belt.speed": ["600 fpm"]}, "states": [], "best": {}}
    with pytest.raises(InputError, match=r"all_loads_belt_safety: the spec has no belt\.carcass\.strength"):
        campaign(given, **plan, limits={"all_loads_belt_safety": {"least": 6.7}})
    campaign(
        given,
        **plan | {"axes": {"belt.carcass.strength": ["6000 lbf/in"]}},
        limits={"belt_safety": {"least": 6.7}},
    )
    uses = {"belt_use": {"most": 1}, "all_loads_belt_use": {"most": 1}}
    with ResultStore(tmp_path / "a") as known:
        _, (one,) = designed(given, known, **plan, figures=[*uses], limits=uses)
    assert one.keeps
    found = conveyor.analyse(given)
    rows = [row for row in found.to_dict(analyse_studies(given, found))["checks"] if row["key"] == "belt_rating"]
    highest = max(row["calculated"] / row["required"] for row in rows)
    assert one.figures["all_loads_belt_use"] == pytest.approx(highest)
    assert 0.4 < one.figures["belt_use"] <= one.figures["all_loads_belt_use"] < 1.0


def test_what_is_sought_without_a_word_is_the_least_power_and_the_most_safety(line):
    for asked, sought in (("motor_power", "least"), ("belt_safety_steady", "most"), ("flow", "most")):
        study = campaign(line, states=[], figures=[], best={}, outputs=[asked])
        assert study_objectives(study.require_list_plan(), study.figures, study.base) == {asked: sought}


def test_varied_diameters_say_that_the_usual_bearing_changes_with_them(line):
    paths = ("belt.speed", "idlers.carry.roll.diameter", "idlers.return.roll.diameter")
    carry = line.idlers.carry
    given = line.replace(idlers=line.idlers.replace(carry=carry.replace(roll=carry.roll.replace(drag="2 N"))))
    free = line.replace(
        idlers=line.idlers.replace(carry=carry.replace(drag=None, roll=carry.roll.replace(drag=None, drag_law=None)))
    )
    for made, said in ((free, True), (given, False)):
        notes = [note for note in stepped_drags(made, paths) if note.startswith("idlers.carry.roll.diameter varies")]
        assert len(notes) == said
        assert all("6205 to 133 mm, 6305 to 159 mm" in note for note in notes)
        assert all(report_translator("de").text(note) != note for note in notes)
