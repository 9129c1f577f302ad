"""What a notebook shows: well formed, small, escaped, and the numbers of the result."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.contact import ContactProblem, CreepSpectrum, load_curve, solve
from conveyor.models import LoadCase, RubberCompound
from conveyor.results.analysis import analyse_studies
from conveyor.rubber import PronySeries, fit_prony
from tests.report.reading import HOSTILE, Page

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
LARGEST_OF_A_NOTEBOOK = 100_000


@pytest.fixture(scope="module")
def line():
    plain = conveyor.load(SPECS / "in_plant_us.yaml")
    return plain.replace(
        name=HOSTILE.strip(),
        report={"units": "SI"},
        cases=[{"name": "<b>full</b>", "loading": "full"}, {"name": "fast", "speeds": ["100 fpm"]}],
        uncertainty={"roll_drag": "30 %"},
        operation={"price": "0.1 USD/kWh", "duty": [{"hours": "3000 h", "share": "100 %"}]},
    )


@pytest.fixture(scope="module")
def result(line):
    return conveyor.analyse(line)


@pytest.fixture(scope="module")
def asked(line):
    return analyse_studies(line)


@pytest.fixture(scope="module")
def comparison(line):
    return conveyor.compare_compounds(line, ["standard-cover", "low-rolling-resistance-cover"])


@pytest.mark.parametrize("name", ["overland_10km", "downhill_brakes", "shuttle"])
def test_models_in_a_notebook(name):
    shown = conveyor.load(SPECS / f"{name}.yaml")._repr_html_()
    found = Page(shown)
    assert found.faults == []
    assert len(shown.encode()) < LARGEST_OF_A_NOTEBOOK
    assert "1200 mm" in found.prose or "1000 mm" in found.prose or "800 mm" in found.prose


def test_model_in_a_notebook_is_as_entered_and_escaped(line):
    compound = line.carry_compound.replace(description=HOSTILE)
    assert isinstance(compound, RubberCompound)
    found = Page(compound._repr_html_())
    assert found.faults == []
    assert "script" not in {tag for tag, _ in found.tags}
    assert "48 in" in Page(line.belt._repr_html_()).prose


def test_results_in_a_notebook(result, comparison):
    for shown in (result._repr_html_(), comparison._repr_html_()):
        assert Page(shown).faults == []
        assert len(shown.encode()) < LARGEST_OF_A_NOTEBOOK
    assert f"{result.summary['motor power [kW]']:,.1f}" in result._repr_html_()
    assert comparison.base in comparison._repr_html_()


def test_contact_in_a_notebook():
    creep = CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0])
    problem = ContactProblem(support="free", radius=0.4, thickness=1.0, pressure=0.05, creep=creep, poisson=0.5)
    solution = solve(problem, rtol=1e-4)
    prose = Page(solution._repr_html_()).prose
    assert f"{solution.friction:.8g}" in prose
    assert "error_estimate" in prose


def test_refused_contact_in_a_notebook_says_why():
    creep = CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0])
    problem = ContactProblem(support="free", radius=0.1, thickness=1.0, pressure=50.0, creep=creep, poisson=0.5)
    solution = solve(problem, throw=False)
    prose = Page(solution._repr_html_()).prose
    assert solution.status.message in prose
    assert "friction" not in [data for tag, data in Page(solution._repr_html_()).texts if tag == "th"]


def safe(shown):
    found = Page(shown)
    assert found.faults == []
    assert not {"script", "b"} & {tag for tag, _ in found.tags}
    assert len(shown.encode()) < LARGEST_OF_A_NOTEBOOK
    return found.prose


def test_analysis_in_the_units_of_its_report(result):
    shown = safe(result.in_units("US")._repr_html_())
    assert f"{result.balance.power.motor / 745.69987158227022:,.1f} hp" in shown
    assert "kW" not in shown.split("checks failed")[0].replace("kWh", "")


def test_studies_in_a_notebook(asked):
    cases = safe(asked.cases._repr_html_())
    assert f"{asked.cases.governing[0].value / 1e3:,.1f}" in cases
    assert "<b>full</b>" in cases
    assert "without an answer" in cases  # 100 fpm do not carry the flow
    assert f"{asked.duty.summary['net [MWh]']:,.1f}" in safe(asked.duty._repr_html_())
    shown = safe(asked.uncertainty._repr_html_())
    assert f"{asked.uncertainty.band[0] / 1e3:,.1f}" in shown
    assert "roll drag" in shown


def test_nothing_refused_is_not_mentioned(line):
    study = conveyor.analyse_cases(line, [LoadCase.from_data({"name": "one"})])
    assert "without an answer" not in study._repr_html_()


def test_load_curve_in_a_notebook():
    creep = CreepSpectrum(instantaneous=0.1, weights=[0.9], times=[1.0])
    curve = load_curve(ContactProblem("confined", 0.1, 0.02, creep, 0.1), 0.01, 0.02, 1e-4)
    shown = safe(curve._repr_html_())
    low, high = curve.at([0.01, 0.02]).friction
    assert f"{low:.6g} to {high:.6g}" in shown


def test_series_and_fit_in_a_notebook():
    series = PronySeries(2e6, [8e6], [1e-3])
    shown = safe(series._repr_html_())
    assert "2 MPa" in shown
    assert "10 MPa" in shown
    assert "0.001" in shown
    assert "elastic solid" in safe(PronySeries(2e6, [], [])._repr_html_())
    f = np.geomspace(1.0, 1e4, 30)
    omega = 2.0 * np.pi * f
    fit = fit_prony(f, series.storage(omega), series.loss(omega), times=[1e-3])
    shown = safe(fit._repr_html_())
    assert "1 to 1e+04 Hz" in shown
    assert "tan δ, error" in shown


def test_nothing_heavy_is_imported_for_a_notebook():
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys, conveyor; from conveyor.rubber import PronySeries; PronySeries(1e6, [1e6], [1])._repr_html_();"
            "print([m for m in ('pandas', 'matplotlib', 'openpyxl', 'rich') if m in sys.modules])",
        ],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "[]"
