"""A column, a figure and a table, each declared in one place, are in every output that should show them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from openpyxl.utils import range_boundaries

import conveyor
from conveyor import pipeline
from conveyor.checks import check_against_limit, register
from conveyor.cli.terminal import show_power
from conveyor.force_sums import Force
from conveyor.report import excel, html, table_files
from conveyor.report.page_elements import notebook_summary
from conveyor.report.table_model import Column, Figure, PagePlacement, Table
from conveyor.report.tables.analysis_contents import TABLES
from conveyor.units.sentences import message

PACKAGE = Path(conveyor.__file__).parent
SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"


@pytest.fixture(scope="module")
def result():
    return conveyor.analyse(conveyor.load(SPECS / "in_plant_us.yaml"))


@pytest.fixture
def probed(result, monkeypatch):
    """Contents with a column, a key figure and a table more, each put in where such a one is declared."""
    sections, results = TABLES["sections"], TABLES["results"]

    def with_column(made):
        table = sections(made)
        more = Column("probe", "force", lambda r: r.forces["indentation"], json="probe_N", total=True)
        return replace(table, columns=(*table.columns, more))

    def with_figure(made):
        table = results(made)
        more = Figure("probing", "power", 12_345.0, "tile large notebook", "power_kW.probing")
        return replace(table, rows=(*table.rows, more))

    def with_table(_):
        columns_of = (Column("what", "text", str), Column("size", "length", len))
        return Table("probes", "Loop", "Probes", columns_of, ("abc",), (PagePlacement("belt", "Probes"),))

    monkeypatch.setitem(TABLES, "sections", with_column)
    monkeypatch.setitem(TABLES, "results", with_figure)
    monkeypatch.setitem(TABLES, "probes", with_table)
    return result.contents(system="SI")


def cells(book, name):
    sheet, where = next(iter(book.defined_names[name].destinations))
    left, top, right, bottom = range_boundaries(where.replace("$", ""))
    return list(book[sheet].iter_rows(min_row=top, max_row=bottom, min_col=left, max_col=right, values_only=True))


def test_in_the_workbook(probed, result, tmp_path):
    book = openpyxl.load_workbook(excel.write_workbook(probed, tmp_path / "probe.xlsx"))
    header, *rows = cells(book, "table_sections")
    assert [row[header.index("probe [N]")] for row in rows] == pytest.approx(
        [r.forces["indentation"] for r in result.stretches]
    )
    assert cells(book, "table_probes") == [("what", "size [m]"), ("abc", 3)]
    sheet, where = next(iter(book.defined_names["probing"].destinations))
    assert book[sheet][where.replace("$", "")].value == pytest.approx(12.345)


def test_in_the_files(probed, tmp_path):
    names = [path.name for path in table_files.write_tables(probed, tmp_path)]
    assert "probes.csv" in names
    assert "probe [N]" in (tmp_path / "sections.csv").read_text(encoding="utf-8-sig").splitlines()[0]
    assert "probing [kW],12.345,probing" in (tmp_path / "results.csv").read_text(encoding="utf-8-sig")


def test_on_the_page_in_a_notebook_and_as_a_data_frame(probed):
    made = str(html.build_page(probed))
    assert re.search(r">probe <span class=\"unit\">\[N\]", made)
    assert ">Probes</caption>" in made
    assert "<dt>probing, as given</dt><dd>12.3 <small>kW</small></dd>" in made
    assert "probing" in str(notebook_summary(probed))
    assert "probe [lbf]" in probed["sections"].frame("US")


@pytest.mark.usefixtures("probed")
def test_in_json(result):
    told = result.to_dict()
    assert told["power_kW"]["probing"] == pytest.approx(12.345)
    assert [row["probe_N"] for row in told["sections"]] == [r.forces["indentation"] for r in result.stretches]


def test_the_terminal_takes_the_same_tables(probed, capsys):
    show_power(probed)
    assert "effective tension" in capsys.readouterr().out


def test_units_are_composed_in_one_place_and_parsed_in_none():
    """No label with a unit in brackets, and no pattern that takes one apart."""
    for path in (path for folder in ("report", "cli", "studies") for path in (PACKAGE / folder).rglob("*.py")):
        code = path.read_text(encoding="utf-8")
        code = re.sub(r'""".*?"""', "", code, flags=re.DOTALL)
        labels = re.findall(r'"[^"\n]* \[(?:-|[A-Za-z%°][^\]"\n]*)\]"', code)
        assert not labels or path.name == "study_file.py", path.name  # says how users head a column
        assert not re.findall(r"re\.compile\([^)\n]* \\\[", code), path.name
        assert path.parent.name == "studies" or not re.findall(r"\bid\(", code), path.name


@pytest.fixture(scope="module")
def strained():
    """A conveyor with one more resistance and one more criterion, each put in where such a one is declared."""
    with pytest.MonkeyPatch.context() as patch:
        along = pipeline.forces_along_belt

        def with_force(line, fixed, indentation, **given):
            more = Force("wind", "wind", "special", np.full(2 * line.count, 7.0), "a probe")
            return (*along(line, fixed, indentation, **given), more)

        def weak(found):
            why = message("the probe bears {}", (found.line.speed, "speed"))
            yield check_against_limit("probe", "strength of the probe", 1.0, "at least", 2.0, "force", why=why)

        patch.setattr(pipeline, "forces_along_belt", with_force)
        patch.setattr(register, "CRITERIA", (*register.CRITERIA, weak))
        made = conveyor.analyse(conveyor.load(SPECS / "in_plant_us.yaml")).in_units("SI")
        yield made, made.contents(), made.to_dict()


def test_a_force_is_in_sums_tables_and_json(strained):
    made, contents, told = strained
    sections = 2 * made.line.count
    assert made.balance.forces.special == pytest.approx(
        sum(force.total for force in made.balance.every if force.kind == "special")
    )
    assert contents["sections"].frame()["wind [N]"].tolist() == pytest.approx([7.0] * sections)
    rows = contents["resistances"].frame().set_index("resistance")["force [N]"]
    assert rows["wind, carry"] + rows["wind, return"] == pytest.approx(7.0 * sections)
    assert [row["wind_N"] for row in told["sections"]] == pytest.approx([7.0] * sections)
    assert told["forces_N"]["special"] == pytest.approx(made.balance.forces.special)


def test_a_criterion_is_in_checks_warnings_and_every_output(strained, tmp_path):
    made, contents, told = strained
    assert [check.key for check in made.checks if check.failed] == ["probe"]
    row = contents["checks"].frame().set_index("check").loc["strength of the probe"]
    assert (row["calculated"], row["required"], row["verdict"]) == ("1 N", "at least 2 N", "FAIL")
    assert any(line.startswith("the probe bears") for line in told["warnings"])
    book = openpyxl.load_workbook(excel.write_workbook(contents, tmp_path / "weak.xlsx"))
    assert "strength of the probe" in {cell.value for row in book["Summary"] for cell in row}
    page = html.write_page(contents, tmp_path / "weak.html").read_text(encoding="utf-8")
    assert "strength of the probe" in page
    assert "strength of the probe" in str(notebook_summary(contents))


def test_a_table_has_the_name_it_is_registered_under(strained):
    _, contents, _ = strained
    assert {name: table.key for name, table in contents.by_key.items()} == {name: name for name in contents.by_key}
    assert len(contents.by_key) == len(contents.parts) < len(TABLES)


def test_a_table_is_built_when_it_is_read(result, monkeypatch):
    """Reading one builds no other; without rows it is not there."""
    built = []
    for name, make in TABLES.items():
        monkeypatch.setitem(TABLES, name, lambda made, name=name, make=make: built.append(name) or make(made))
    contents = result.contents()
    assert built == []
    assert contents["sections"] is contents["sections"]
    assert "duty" not in contents
    assert built == ["sections", "duty"]
