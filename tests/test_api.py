"""The package from Python: what `import conveyor` reaches, what pickles, what is refused, what shows itself shortly."""

from __future__ import annotations

import pickle
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor.contact import ContactProblem, CreepSpectrum, load_curve, solve, solve_loads, solve_many
from conveyor.fitting.compound import Request, fit_file
from conveyor.fitting.summary import lines
from conveyor.laboratory.read import read_answered
from conveyor.rubber import PronySeries

ROOT = Path(__file__).parent.parent
SPECS = ROOT / "examples" / "specs"
CREEP = CreepSpectrum(0.1, [0.9], [1.0])
FREE = ContactProblem("free", 0.4, 0.05, CREEP, thickness=1.0)


def test_import_reaches_what_the_pages_name() -> None:
    code = (
        "import conveyor; conveyor.spec.from_data; conveyor.shelf.compound; conveyor.contact.solve; "
        "conveyor.rubber.PronySeries; conveyor.units.si; conveyor.studies.studies; conveyor.libraries.belts; "
        "conveyor.uncertainty.study; conveyor.indentation.RollContact; print(*dir(conveyor))"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert {"load", "analyse", "shelf", "studies", "__version__"} <= set(told.stdout.split())
    assert "TYPE_CHECKING" not in told.stdout


def test_analyse_says_what_it_takes() -> None:
    with pytest.raises(
        conveyor.InputError, match=r"analyse: takes a Conveyor, got str; conveyor\.load\(path\)"
    ):
        conveyor.analyse("mine.yaml")  # type: ignore[arg-type]


def test_an_analysis_shows_itself_in_one_line() -> None:
    shown = repr(conveyor.analyse(conveyor.load(SPECS / "shuttle.yaml")))
    assert shown.startswith('Analysis("')
    assert "kW" in shown
    assert len(shown) < 200


@pytest.mark.parametrize(
    "make",
    [
        lambda: solve(FREE),
        lambda: solve_many([FREE])[0],
        lambda: solve_loads(FREE, [0.01, 0.05]),
        lambda: solve_loads(replace(FREE, radius=0.4), [0.05, 0.4]),
        lambda: load_curve(FREE, 0.01, 0.05).at([0.02]),
    ],
    ids=["solve", "solve_many", "solve_loads", "one by one", "curve"],
)
def test_solutions_pickle_with_what_is_formed_later(make) -> None:
    made = make()
    read = pickle.loads(pickle.dumps(made))  # noqa: S301 made here
    assert np.all(read.friction == made.friction)
    assert np.all(read.penetration == made.penetration)
    assert np.all(read.peak_pressure == made.peak_pressure)


def test_functions_pickle_by_their_names() -> None:
    for name in conveyor.__all__:
        named = getattr(conveyor, name)
        assert pickle.loads(pickle.dumps(named)) is named or name == "__version__"  # noqa: S301 made here


def test_analyses_pickle() -> None:
    result = conveyor.analyse(conveyor.load(SPECS / "shuttle.yaml"))
    shown = result.to_dict(), result.summary.to_dict(), result.checks  # what is kept of them does not travel
    read = pickle.loads(pickle.dumps(result))  # noqa: S301 made here
    assert (read.to_dict(), read.summary.to_dict(), read.checks) == shown


SERIES = PronySeries(4e6, np.full(13, 1e6), np.logspace(-6, 1, 13))


def _master(folder: Path, low: float, high: float) -> Path:
    f = np.logspace(low, high, 24)
    omega = 2.0 * np.pi * f
    rows = zip(f, SERIES.storage(omega), SERIES.loss(omega), strict=True)
    path = folder / "master.csv"
    text = "".join(f"{a:.6g},{b:.6g},{c:.6g}\n" for a, b, c in rows)
    path.write_text("frequency_Hz,E'_Pa,E''_Pa\n" + text, encoding="utf-8")
    return path


def test_a_short_window_is_fitted_and_said_to_be_untested(tmp_path: Path) -> None:
    """Two decades leave no row a decade from both ends: the fit stands, Kramers-Kronig cannot judge it."""
    found = fit_file(_master(tmp_path, -0.3, 1.7), Request("short", "20 degC", replicas=0))
    assert found.consistency is None
    assert any("Kramers-Kronig: not tested" in line for line in lines(found))
    omega = 2.0 * np.pi * np.logspace(-0.2, 1.6, 9)
    series = found.compound.series(293.15)
    assert series.storage(omega) == pytest.approx(SERIES.storage(omega), rel=0.02)


def test_a_wide_window_is_tested(tmp_path: Path) -> None:
    found = fit_file(_master(tmp_path, -2.0, 4.0), Request("wide", "20 degC", replicas=0))
    assert found.consistency is not None
    assert any("E'' predicted from E'" in line for line in lines(found))


def test_an_answer_for_one_file_does_not_refuse_another(tmp_path: Path) -> None:
    master = _master(tmp_path, -2.0, 4.0)  # states Pa in its header
    answers = {"modulus_unit": "MPa"}
    with pytest.raises(conveyor.InputError, match="modulus-unit"):
        read_answered(master, answers, poisson_ratio=0.5, several=False)
    read = read_answered(master, answers, poisson_ratio=0.5, several=True)
    assert read.storage is not None
    assert read.storage.max() == pytest.approx(SERIES.storage(2.0 * np.pi * 1e4), rel=1e-5)
    isotherms = SPECS.parent / "laboratory" / "isotherms.csv"  # states its temperatures
    told = [
        read_answered(p, {"temperature": 293.15}, poisson_ratio=0.5, several=True)
        for p in (isotherms, master)
    ]
    assert np.ptp(told[0].temperature) > 80.0  # -36 to 48 degC
    assert told[1].temperature == pytest.approx(293.15)


def test_studies_show_themselves_in_one_line() -> None:
    line = conveyor.load(SPECS / "shuttle.yaml").replace(
        cases=[{"name": "full"}],
        uncertainty={"roll_drag": "30 %"},
        operation={"price": "0.1 USD/kWh", "duty": [{"hours": "3000 h", "share": "100 %"}]},
    )
    made = conveyor.studies.studies(line)
    compared = conveyor.compare_compounds(line, ["s100"])
    for shown in map(repr, (made, made.states, made.cases, made.duty, made.uncertainty, compared)):
        assert len(shown) < 300
        assert "\n" not in shown
