"""The search for the best design: known optima of a stand-in, limits, stops and starts, a spec that `power` reads."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import pytest

import conveyor
from conveyor import shelf
from conveyor.errors import InputError, NoSolutionError
from conveyor.models.study import SearchPlan
from conveyor.studies.optimise import optimise
from conveyor.studies.parametric_study import ParametricStudy, ResultStore
from tests.command_line import run as command

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
PLAN = {
    "name": "n",
    "base": "shuttle.yaml",
    "ranges": {"belt.speed": {"low": "1 m/s", "high": "2 m/s"}},
    "axes": {"idlers.carry.spacing": ["1 m", "1.1 m", "1.2 m", "1.3 m"]},
    "best": {"motor_power": "least"},
    "seed": 1,
}


def bowl(job, points):
    """Least at 1.6 m/s and 1.2 m: 100 W; the safety grows with the speed; no answer above 1.9 m/s."""
    _, outputs, *_ = pickle.loads(job.packed)  # noqa: S301
    found = []
    for point in points:
        speed, spacing = (float(point[path].split()[0]) for path in ("belt.speed", "idlers.carry.spacing"))
        power = 100.0 + 100.0 * (speed - 1.6) ** 2 + 1000.0 * (spacing - 1.2) ** 2
        figures = {"motor_power": power, "belt_safety": 10.0 * speed}
        found.append("too fast" if speed > 1.9 else [figures[key] for key in outputs])
    return found


@pytest.fixture
def line(monkeypatch):
    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", bowl)
    return conveyor.load(SPECS / "shuttle.yaml")


def search(line, path, **changes):
    campaign = ParametricStudy.of(SearchPlan.from_data(PLAN | changes), line, shelf.compound)
    with ResultStore(path) as known:
        return optimise(campaign, known), len(known)


def test_the_least_is_found_over_a_range_and_a_list(line, tmp_path):
    found, calculated = search(line, tmp_path / "a")
    assert found.design.changes == {
        "belt.speed": found.design.changes["belt.speed"],
        "idlers.carry.spacing": "1.2 m",
    }
    # the search ends where a generation costs alike to 1 %: 1 W here, (1.6 - v)² is then at most 0.01
    assert float(found.design.changes["belt.speed"].split()[0]) == pytest.approx(1.6, abs=0.1)
    assert list(found.history) == sorted(found.history, reverse=True)
    assert calculated == found.tried


def test_a_limit_moves_the_best_to_its_edge(line, tmp_path):
    found, _ = search(line, tmp_path / "a", limits={"belt_safety": {"least": 17.5}}, generations=60)
    assert found.design.keeps
    assert float(found.design.changes["belt.speed"].split()[0]) == pytest.approx(1.75, abs=0.02)
    with pytest.raises(NoSolutionError, match=r"the closest has belt_safety 1\d(\.\d+)? against least 30.0$"):
        search(line, tmp_path / "b", limits={"belt_safety": {"least": 30.0}}, generations=2)


def test_a_search_that_was_stopped_goes_on_and_ends_alike(line, tmp_path, monkeypatch):
    whole, calculated = search(line, tmp_path / "whole")
    asked = []

    def failing(job, points):
        asked.append(len(points))
        if len(asked) == 4:
            raise KeyboardInterrupt
        return bowl(job, points)

    monkeypatch.setattr("conveyor.studies.parametric_study.evaluate_points", failing)
    with pytest.raises(KeyboardInterrupt):
        search(line, tmp_path / "stopped")
    kept = sum(asked[:3])
    again, both = search(line, tmp_path / "stopped")
    assert (again.design, again.history) == (whole.design, whole.history)
    assert both == calculated
    assert sum(asked) - asked[3] == calculated
    assert 0 < kept < calculated


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"best": {}}, "best: expected one figure"),
        ({"axes": {"idlers.carry.spacing": ["1 m"]}}, "one value leaves no choice"),
        ({"ranges": {}, "axes": {}}, "nothing varies; give ranges, axes or together"),
    ],
)
def test_a_search_without_a_choice_is_refused(changes, said):
    with pytest.raises(InputError, match=said):
        SearchPlan.from_data(PLAN | changes)


def test_the_command_writes_a_spec_that_power_reads(tmp_path):
    file = tmp_path / "search.json"
    plan = PLAN | {"base": str(SPECS / "shuttle.yaml"), "population": 2, "generations": 1}
    file.write_text(json.dumps(plan), encoding="utf-8")
    done = command("optimise", file, "-o", tmp_path / "best.yaml", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    power = json.loads(command("power", tmp_path / "best.yaml", "--json").stdout)["power_kW"]["motor"]
    assert 1e3 * power == pytest.approx(found["figures_SI"]["motor_power"], rel=2e-4)
    again = command("optimise", file, "-o", tmp_path / "best.yaml", "--json")  # it replaces its own spec
    assert json.loads(again.stdout) == found | {"calculated": 0}
