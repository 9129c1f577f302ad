"""The package from Python: what `import conveyor` reaches, what pickles, what is refused, what shows itself shortly."""

from __future__ import annotations

import inspect
import pickle
import pydoc
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import conveyor
from conveyor import sizing
from conveyor.contact import ContactProblem, CreepSpectrum, load_curve, solve, solve_loads, solve_many
from conveyor.fitting.fitted_compound import Request, fit_file
from conveyor.fitting.summary import summary_lines
from conveyor.laboratory.dma_file import read_with_answers
from conveyor.rubber import PronySeries, fit_prony
from conveyor.studies.calibration import fit_factors
from conveyor.studies.comparison import compare_compounds
from conveyor.studies.duty import analyse_duty
from conveyor.studies.verification import verify_compounds

ROOT = Path(__file__).parent.parent
SPECS = ROOT / "examples" / "specs"
CREEP = CreepSpectrum(0.1, [0.9], [1.0])
FREE = ContactProblem("free", 0.4, 0.05, CREEP, thickness=1.0)


def test_import_reaches_what_the_pages_name() -> None:
    code = (
        "import conveyor; conveyor.spec.from_data; conveyor.shelf.compound; conveyor.contact.solve; "
        "conveyor.rubber.PronySeries; conveyor.units.si; conveyor.studies.calculate_studies; conveyor.libraries.belts; "
        "conveyor.uncertainty.study; conveyor.indentation.RollContact; print(*dir(conveyor))"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert {"load", "analyse", "shelf", "studies", "__version__"} <= set(told.stdout.split())
    assert "TYPE_CHECKING" not in told.stdout


FUNCTIONS = [name for name in conveyor.__all__ if inspect.isfunction(getattr(conveyor, name))]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_state_and_document_every_argument(name: str) -> None:
    """No sink of keywords, no name without a type; the docstring describes each once, and what is returned."""
    function = getattr(conveyor, name)
    signature = inspect.signature(function)
    for argument in signature.parameters.values():
        assert argument.kind in {argument.POSITIONAL_OR_KEYWORD, argument.KEYWORD_ONLY}, argument
        assert argument.annotation is not argument.empty, argument
        assert "Any" not in str(argument.annotation), argument
    assert signature.return_annotation is not signature.empty
    doc = inspect.getdoc(function) or ""
    section = doc.split("Parameters\n----------\n")[1].split("\n\n")[0]
    headings = [line.split(" : ")[0] for line in section.splitlines() if not line.startswith(" ")]
    assert [one for heading in headings for one in heading.split(", ")] == sorted(
        signature.parameters, key=lambda one: _place(one, headings)
    )
    assert "Returns\n-------\n" in doc
    returned = doc.split("Returns\n-------\n")[1].splitlines()[0]
    stated = signature.return_annotation
    assert returned.split(".")[-1] == (stated if isinstance(stated, str) else stated.__name__).split(".")[-1]


def _place(argument: str, headings: list[str]) -> int:
    """Number of the heading that names an argument; one that none names fails."""
    return next(i for i, heading in enumerate(headings) if argument in heading.split(", "))


def test_results_are_of_the_type_that_help_states() -> None:
    line = conveyor.load(SPECS / "shuttle.yaml")
    for function in (conveyor.analyse, conveyor.analyse_cases):
        stated = inspect.signature(function).return_annotation
        assert type(function(line)) is stated
        assert f"-> {stated.__module__}.{stated.__name__}" in pydoc.render_doc(function, renderer=pydoc.plaintext)


def test_options_are_those_of_what_is_called() -> None:
    """Names, kinds, types and defaults."""
    pairs = (
        (conveyor.compare, compare_compounds),
        (conveyor.compare_compounds, compare_compounds),
        (conveyor.calibrate, fit_factors),
        (conveyor.size, sizing.size_conveyor),
        (conveyor.verify_sheet, verify_compounds),
        (conveyor.analyse_duty, analyse_duty),
    )
    for door, behind in pairs:
        given, wanted = (
            [p for p in inspect.signature(f).parameters.values() if p.kind is p.KEYWORD_ONLY] for f in (door, behind)
        )
        assert given == wanted
        assert len(given) >= 2


def test_unknown_options_are_refused() -> None:
    line = conveyor.load(SPECS / "shuttle.yaml")
    with pytest.raises(conveyor.InputError, match="compare: got an unexpected keyword argument 'temperature'"):
        conveyor.compare(line, ["s100"], temperature=["20 degC"])  # type: ignore[call-arg]
    with pytest.raises(conveyor.InputError, match="size: got an unexpected keyword argument 'most'"):
        conveyor.size("duty.yaml", most=3)  # type: ignore[call-arg]
    with pytest.raises(conveyor.InputError, match=r"calibrate: error: expected float, got '2 %' \(str\)"):
        conveyor.calibrate(line, "runs.csv", error="2 %")  # type: ignore[arg-type]


def test_what_files_hold_is_data_of_the_public_interface() -> None:
    line = conveyor.load(SPECS / "shuttle.yaml")
    half = conveyor.LoadCase.from_data({"name": "half", "loading": "part load", "share": "50 %"})
    found = conveyor.analyse_cases(line, [half])
    assert [one.case.name for one in found.results] == ["half"]
    assert found.results[0].found.line.flow == pytest.approx(line.mass_flow / 2.0, rel=1e-12)
    for model in (conveyor.LoadCase, conveyor.MeasuredRun, conveyor.SizingDuty, conveyor.StudyPlan):
        with pytest.raises(conveyor.SpecError, match=r"(?m)^flux: unknown key"):
            model.from_data({"flux": 1})


def test_analyse_says_what_it_takes() -> None:
    with pytest.raises(conveyor.InputError, match=r"analyse: takes a Conveyor, got str; conveyor\.load\(path\)"):
        conveyor.analyse("mine.yaml")  # type: ignore[arg-type]


def test_an_analysis_shows_itself_in_one_line() -> None:
    shown = repr(conveyor.analyse(conveyor.load(SPECS / "shuttle.yaml")))
    assert shown.startswith('Analysis("')
    assert "kW" in shown
    assert len(shown) < 200


def test_what_people_print_is_one_line_with_its_figures() -> None:
    line = conveyor.load(SPECS / "overland_10km.yaml")
    result = conveyor.analyse(line)
    omega = 2.0 * np.pi * np.logspace(-2.0, 4.0, 25)
    fit = fit_prony(omega / (2.0 * np.pi), SERIES.storage(omega), SERIES.loss(omega), times=SERIES.times[3:-2])
    for shown in (line, line.carry_compound, result.balance, fit, *result.checks):
        assert str(shown) == repr(shown)
        assert len(repr(shown)) < 300
        assert "\n" not in repr(shown)
    assert f'"{line.name}"' in repr(line)
    assert f"over {line.route.length:.4g} m" in repr(line)
    assert f'"{line.carry_compound.name}"' in repr(line.carry_compound)
    assert f"motor {result.balance.power.motor / 1e3:,.0f}"[:8] in repr(result.balance)
    for check in result.checks:
        assert repr(check) == f'Check("{check.name}": {check.found}, {check.asked}: {check.verdict})'


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
    assert any("Kramers-Kronig: not tested" in line for line in summary_lines(found))
    omega = 2.0 * np.pi * np.logspace(-0.2, 1.6, 9)
    series = found.compound.series(293.15)
    assert series.storage(omega) == pytest.approx(SERIES.storage(omega), rel=0.02)


def test_a_wide_window_is_tested(tmp_path: Path) -> None:
    found = fit_file(_master(tmp_path, -2.0, 4.0), Request("wide", "20 degC", replicas=0))
    assert found.consistency is not None
    assert any("E'' predicted from E'" in line for line in summary_lines(found))


def test_an_answer_for_one_file_does_not_refuse_another(tmp_path: Path) -> None:
    master = _master(tmp_path, -2.0, 4.0)  # states Pa in its header
    answers = {"modulus_unit": "MPa"}
    with pytest.raises(conveyor.InputError, match="modulus-unit"):
        read_with_answers(master, answers, poisson_ratio=0.5, several=False)
    read = read_with_answers(master, answers, poisson_ratio=0.5, several=True)
    assert read.storage is not None
    assert read.storage.max() == pytest.approx(SERIES.storage(2.0 * np.pi * 1e4), rel=1e-5)
    isotherms = SPECS.parent / "laboratory" / "isotherms.csv"  # states its temperatures
    told = [read_with_answers(p, {"temperature": 293.15}, poisson_ratio=0.5, several=True) for p in (isotherms, master)]
    assert np.ptp(told[0].temperature) > 80.0  # -36 to 48 degC
    assert told[1].temperature == pytest.approx(293.15)


def test_studies_show_themselves_in_one_line() -> None:
    line = conveyor.load(SPECS / "shuttle.yaml").replace(
        cases=[{"name": "full"}],
        uncertainty={"roll_drag": "30 %"},
        operation={"price": "0.1 USD/kWh", "duty": [{"hours": "3000 h", "share": "100 %"}]},
    )
    made = conveyor.studies.calculate_studies(line)
    assert repr(made) == repr(conveyor.analyse_studies(line)) == "Studies(states, cases, duty, uncertainty, flooded)"
    compared = conveyor.compare_compounds(line, ["s100"])
    for shown in map(repr, (made, made.states, made.cases, made.duty, made.uncertainty, compared)):
        assert len(shown) < 300
        assert "\n" not in shown


def test_every_result_writes_its_files(tmp_path: Path) -> None:
    """A workbook, a page in US units and a table of each of its kind, with what `contents` holds."""
    sheet = conveyor.verify_sheet(
        ["s100"], line_loads=["2 N/mm"], temperatures=["20 degC"], roll_diameters=["219 mm"], speeds=["5 m/s"],
        covers=["7 mm"],
    )  # fmt: skip
    study = conveyor.study(ROOT / "examples" / "studies" / "spacing.yaml")
    for name, made in (("sheet", sheet), ("study", study)):
        folder = tmp_path / name
        folder.mkdir()
        assert made.to_excel(folder / "a.xlsx").read_bytes().startswith(b"PK")
        page = made.to_html(folder / "a.html").read_text(encoding="utf-8")
        assert page.startswith("<!DOCTYPE html>")
        assert made.to_html(folder / "a.html", system="US").read_text(encoding="utf-8") != page
        written = {path.stem for path in made.to_tables(folder)}
        assert written >= {key for key, table in made.contents().by_key.items() if len(table.rows) > 1}
    for result in (conveyor.Comparison, conveyor.Sizing, conveyor.Study, conveyor.CalibrationStudy):
        assert {"to_excel", "to_html", "to_pdf", "to_tables"} <= set(dir(result))
