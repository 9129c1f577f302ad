"""Tables as files of their own, and tables too long for a sheet."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path

import openpyxl
import pandas as pd
import pytest

import conveyor
from conveyor.errors import InputError
from conveyor.files.atomic_write import save_files
from conveyor.report import sheet_writer, table_files
from conveyor.report.excel import build_workbook, workbook_files
from conveyor.results.comparisons import compare_compounds
from conveyor.text.printable import escape_controls

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
DIGITS = 1e-15  # pandas writes the shortest decimal that reads back


@pytest.fixture(scope="module")
def result():
    return conveyor.analyse(conveyor.load(SPECS / "in_plant_us.yaml"))


def test_every_table_has_its_file(result, tmp_path):
    written = result.to_tables(tmp_path)
    found = result.contents()
    assert [path.name for path in written] == [f"{part.key}.csv" for part in found.tables]
    assert sorted(tmp_path.iterdir()) == sorted(written)
    for part, path in zip(found.tables, written, strict=True):
        read = pd.read_csv(path, encoding="utf-8-sig")
        assert list(read.columns) == list(part.frame(found.system).columns)
        assert len(read) == len(part.rows)


def test_files_hold_the_figures(result, tmp_path):
    for system, unit in (("SI", "N"), ("US", "lbf")):
        result.to_tables(tmp_path, system=system)
        read = pd.read_csv(tmp_path / "resistances.csv", encoding="utf-8-sig")
        expected = result.tables["resistances"].frame(system)
        assert read[f"force [{unit}]"].tolist() == pytest.approx(expected[f"force [{unit}]"].tolist(), rel=DIGITS)


def test_a_comparison_has_its_files(tmp_path):
    line = conveyor.load(SPECS / "in_plant_us.yaml")
    found = compare_compounds(line, ["standard-cover", "S100"], rtol=1e-3)
    names = [path.name for path in found.to_tables(str(tmp_path), system="US")]
    assert names == [
        "ranking.csv", "costs.csv", "what_if.csv", "power_1.csv", "scenes.csv", "coverage.csv", "remarks.csv",
        "compounds.csv", "provenance.csv",
    ]  # fmt: skip
    read = pd.read_csv(tmp_path / "scenes.csv", encoding="utf-8-sig")
    assert len(read) == len(found.table)
    assert "motor power [hp]" in read.columns


@pytest.mark.parametrize("typed", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "\r=1"])
def test_no_text_of_a_file_is_a_formula(typed):
    written = table_files.csv_bytes(pd.DataFrame({typed: [typed], "power [kW]": [-1.5]}))
    read = pd.read_csv(BytesIO(written), encoding="utf-8-sig")
    assert read.columns[0] == f"'{escape_controls(typed)}"
    assert read.iloc[0].tolist() == [f"'{escape_controls(typed)}", -1.5]  # a negative number stays one


def test_what_a_user_types_is_safe_in_every_file(result, tmp_path):
    line = result.conveyor
    named = [line.route.sections[0].replace(name="=1+1"), *line.route.sections[1:]]
    conveyor.analyse(line.replace(name="@x", route=line.route.replace(sections=named))).to_tables(tmp_path)
    read = pd.read_csv(tmp_path / "sections.csv", encoding="utf-8-sig")
    assert "'=1+1" in read["section"].tolist()
    assert "'@x" in pd.read_csv(tmp_path / "inputs.csv", encoding="utf-8-sig")["as entered"].tolist()


def test_parquet_without_its_package_says_how_to_get_it(result, tmp_path, monkeypatch):
    monkeypatch.setattr("conveyor.report.table_files.find_spec", lambda _: None)
    with pytest.raises(InputError, match=r'pip install "conveyor\[parquet\]"; or write CSV'):
        result.to_tables(tmp_path, kind="parquet")
    assert list(tmp_path.iterdir()) == []


def test_parquet_holds_the_tables(result, tmp_path):
    pytest.importorskip("pyarrow")
    written = result.to_tables(tmp_path, kind="parquet", system="US")
    for part, path in zip(result.contents(system="US").tables, written, strict=True):
        read = pd.read_parquet(path)
        assert list(read.columns) == list(part.frame("US").columns)
        assert len(read) == len(part.rows)


def test_refusals(result, tmp_path):
    with pytest.raises(InputError, match=r"nowhere: is no folder; create it"):
        result.to_tables(tmp_path / "nowhere")
    with pytest.raises(InputError, match='kind = "xml": csv or parquet'):
        result.to_tables(tmp_path, kind="xml")
    with pytest.raises(InputError, match='system = "metric"'):
        result.to_tables(tmp_path, system="metric")
    assert list(tmp_path.iterdir()) == []


def test_nothing_half_written_stays(tmp_path, monkeypatch):
    """The second of two files fails: neither is there, an older one is untouched."""
    first, second = tmp_path / "a.csv", tmp_path / "b.csv"
    first.write_bytes(b"old")
    write = Path.write_bytes
    calls = []

    def fail(path, data):
        calls.append(path)
        if len(calls) == 2:
            raise OSError(28, "No space left on device")
        return write(path, data)

    monkeypatch.setattr(Path, "write_bytes", fail)
    with pytest.raises(InputError, match=r"b\.csv: cannot be written \(No space left on device\)"):
        save_files({first: b"new", second: b"new"})
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]
    assert first.read_bytes() == b"old"


def lengthened(found, key, rows):
    """Contents with one table repeated to so many rows."""
    part = found[key]
    longer = replace(part, rows=(tuple(part.rows) * -(-rows // len(part.rows)))[:rows])
    return replace(found, by_key={**found.by_key, key: longer})


@pytest.mark.parametrize("key", ["rolls", "tensions", "sections", "indentation"])
def test_a_long_table_goes_beside_the_workbook(result, tmp_path, key):
    found = lengthened(result.contents(), key, sheet_writer.MOST_ROWS + 1)
    path = tmp_path / "line.xlsx"
    save_files(workbook_files(found, path))
    assert sorted(item.name for item in tmp_path.iterdir()) == ["line.xlsx", f"line_{key}.csv"]
    beside = pd.read_csv(tmp_path / f"line_{key}.csv", encoding="utf-8-sig")
    assert len(beside) == sheet_writer.MOST_ROWS + 1
    book = openpyxl.load_workbook(path)
    sheet = book[found[key].sheet]
    words = [str(cell.value) for row in sheet.iter_rows() for cell in row if cell.value is not None]
    assert any(f"10,001 rows, the first 100 here; all of them: line_{key}.csv" in text for text in words)
    assert sheet.max_row < 200
    assert f"table_{key}" not in book.defined_names
    assert sheet._charts == []


def test_ten_thousand_rows_stay_in_the_sheet(result, monkeypatch):
    monkeypatch.setattr(sheet_writer, "MOST_ROWS", 40)  # the same border, quicker to write
    for rows, there in ((40, True), (41, False)):
        found = lengthened(result.contents(), "rolls", rows)
        assert ("table_rolls" in build_workbook(found).defined_names) is there
