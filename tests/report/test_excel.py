"""The workbook read back: numbers as numbers, text as text, charts, refusals."""

from __future__ import annotations

import math
import re
import zipfile
from datetime import date
from pathlib import Path
from xml.etree import ElementTree as ET

import openpyxl
import pandas as pd
import pytest
from openpyxl.utils import get_column_letter

import conveyor
from conveyor.errors import InputError
from conveyor.report.cells import CELL_CHARACTERS
from conveyor.results.analysis import analyse_studies

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
DIGITS = 1e-15  # openpyxl writes 16 significant digits
SHEETS = [
    "Summary", "Results", "Given", "Inputs", "Sections", "Resistances", "Rolls", "Tension diagram", "Tensions",
    "States", "Loop", "Pulleys", "Indentation", "Rubber", "Checks and notes",
]  # fmt: skip
HIDDEN = {"Inputs", "Rolls", "Tensions", "States", "Indentation"}


@pytest.fixture(scope="module")
def overland():
    return conveyor.analyse(conveyor.load(SPECS / "overland.yaml"))


@pytest.fixture(scope="module")
def book(overland, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "overland.xlsx"
    assert overland.to_excel(path) == path
    return path


def test_sheets_and_charts(book):
    read = openpyxl.load_workbook(book)
    assert read.sheetnames == SHEETS, "a new sheet stands in `excel.SHEETS` at its place, and in SHEETS here"
    charts = {sheet.title: len(sheet._charts) for sheet in read}
    assert charts["Summary"] == charts["Rubber"] == 2
    assert charts["Tension diagram"] == 1
    assert {sheet.title for sheet in read if sheet.sheet_state == "hidden"} == HIDDEN


def test_paper_has_what_is_printed_and_no_more(book):
    """What is not printed stands below the print area; a sheet without anything else is hidden."""
    read = openpyxl.load_workbook(book)
    last = {sheet.title: int(sheet.print_area.rpartition("$")[2]) for sheet in read if sheet.print_area}
    for key, printed in {"sections": True, "breakdown": False, "prony_carry": False, "rubber": True}.items():
        name, cells = next(iter(read.defined_names[f"table_{key}"].destinations))
        top = int(cells.split(":")[0].rpartition("$")[2])
        assert (top <= last[name]) is printed, key


def test_facts_of_the_cover_stand_over_lines(book):
    sheet = openpyxl.load_workbook(book)["Summary"]
    rows = {sheet.cell(i, 1).value: i for i in range(1, sheet.max_row + 1)}

    def lined(row):
        return "".join(cell.column_letter for cell in sheet[row] if cell.border.bottom.style)

    assert lined(rows["length [m]"]) == "ABDEFG"  # figures on the left, words on the right, nothing between
    verdict = next(str(value) for value in rows if str(value).startswith(("Adequate", "Not adequate")))
    assert sheet.cell(rows[verdict], 1).font.b
    assert {"maximum motor power", "maximum belt tension", "minimum belt tension", "belt utilisation"} <= set(rows)
    assert {"engineer", "reviewer", "approval"} <= {cell.value for row in sheet["A3:D8"] for cell in row}


def _beneath(sheet, chart):
    """Cells under a chart: its corner, and as many columns and rows as its size takes."""
    corner = chart.anchor._from
    row, column, width, height = corner.row + 1, corner.col + 1, 0.0, 0.0
    last = row
    while height < chart.height / 2.54 * 72.0:
        height += (sheet.row_dimensions[last].height if last in sheet.row_dimensions else None) or 15.0
        last += 1
    columns = []
    while width < chart.width / 2.54 * 96.0:
        letter = get_column_letter(column + len(columns))
        known = sheet.column_dimensions[letter].width if letter in sheet.column_dimensions else 8.43
        width += 7.0 * known + 5.0
        columns.append(column + len(columns))
    return [sheet.cell(i, j) for i in range(row, last) for j in columns]


def test_no_chart_lies_over_cells(book):
    for sheet in openpyxl.load_workbook(book):
        for chart in sheet._charts:
            beneath = [cell for cell in _beneath(sheet, chart) if cell.value is not None]
            assert beneath == [], sheet.title


def test_every_axis_is_shown_and_every_reference_holds_numbers(book, overland):
    """Recent Excel hides an axis that does not say delete=0; a series over text or gaps shows nothing."""
    space = {"c": "http://schemas.openxmlformats.org/drawingml/2006/chart"}
    read = openpyxl.load_workbook(book)
    count, states = 0, overland.balance.equilibrium.states | overland.motions.states
    with zipfile.ZipFile(book) as parts:
        for name in parts.namelist():
            if not name.startswith("xl/charts/chart"):
                continue
            root = ET.fromstring(parts.read(name))  # noqa: S314 our own file
            axes = [axis for kind in ("valAx", "catAx") for axis in root.iterfind(f".//c:{kind}", space)]
            assert len(axes) == 2
            assert all(axis.find("c:delete", space).get("val") == "0" for axis in axes)
            for kind in ("val", "xVal", "yVal"):
                for reference in root.iterfind(f".//c:{kind}//c:f", space):
                    sheet, cells = reference.text.rsplit("!", 1)
                    block = read[sheet.strip("'")][cells.replace("$", "")]
                    known = [cell.value for row in block for cell in row if cell.value is not None]
                    assert known
                    assert all(isinstance(value, int | float) for value in known)
                    count += 1
    assert count == 1 + 2 * (
        len(states) + 1 + 4 + 2 * 2
    )  # bars; x and y of the tensions and the sag, the profile and what stands along it, 2 moduli of 2 compounds


def test_formulas_are_those_to_play_with_and_no_cell_is_an_error(book):
    read = openpyxl.load_workbook(book)
    results = [name for name, at in read.defined_names.items() if name.startswith("what_if_")]
    there = {read.defined_names[name].attr_text.rpartition("!")[2].replace("$", "") for name in results}
    for sheet in read:
        for row in sheet.iter_rows():
            for cell in row:
                assert cell.data_type != "e", (sheet.title, cell.coordinate, cell.value)
                live = cell.data_type == "f"
                assert not live or (sheet.title == "Results" and cell.coordinate in there), cell.coordinate


def test_formulas_have_their_values_beside_them(overland, tmp_path):
    """As a spreadsheet saves them, so that viewers read figures; the formula over the cells named gives the same."""
    priced = overland.conveyor.replace(
        operation={"hours_per_year": "6000 h", "price": "0.1 EUR/kWh", "emission": "0.4 kg/kWh", "emission_source": "x",
                   "duty": [{"hours": "6000 h", "share": "100 %"}]}
    )  # fmt: skip
    found = conveyor.analyse(priced)
    path = found.to_excel(tmp_path / "priced.xlsx", analyse_studies(priced, found))
    values, formulas = (openpyxl.load_workbook(path, data_only=shown) for shown in (True, False))

    def cell(book, name):
        return book["Results"][book.defined_names[name].attr_text.rpartition("!")[2].replace("$", "")].value

    known = {name: cell(values, name) for name in values.defined_names if name.startswith("what_if_")}
    live = {name: str(cell(formulas, name)) for name in known if str(cell(formulas, name)).startswith("=")}
    assert set(live) == {"what_if_cost", "what_if_carbon_dioxide", "what_if_required_rated_power"}
    for name, formula in live.items():
        assert eval(formula[1:], {}, known) == pytest.approx(known[name], rel=1e-12)  # noqa: S307 our own


@pytest.mark.parametrize(
    ("sheet", "name"), [("Sections", "sections"), ("Rolls", "rolls"), ("Resistances", "resistances")]
)
def test_tables_are_the_analysis_to_the_last_digit(book, overland, sheet, name):
    expected = getattr(overland, name)
    read = pd.read_excel(book, sheet_name=sheet, header=1).iloc[: len(expected)]
    read.columns = [str(name).replace("[°", "[deg") for name in read.columns]  # people read signs
    read = read[[name for name in read.columns if not name.startswith("Unnamed")]]
    per_cent = {
        f"{name} [-]": name for name in ("share", "penetration of cover", "error of the peak")
    }  # cells say %, heads nothing
    expected = expected.rename(columns=per_cent)
    assert list(read.columns) == list(expected.columns)
    for column in expected:
        if expected[column].dtype.kind == "f":
            assert read[column].astype(float).tolist() == pytest.approx(expected[column].tolist(), rel=DIGITS), column
        else:
            assert read[column].tolist() == expected[column].tolist(), column


def test_results_hold_every_figure_and_its_name(book, overland):
    read = openpyxl.load_workbook(book)
    rows = list(read["Results"].iter_rows(min_row=3, max_row=2 + len(overland.summary), max_col=3, values_only=True))
    known = {name.replace("resistance [-]", "resistance"): value for name, value in overland.summary.items()}
    assert {row[0]: row[1] for row in rows} == pytest.approx(known, rel=DIGITS)
    for i, (_, _, name) in enumerate(rows, start=3):
        assert read.defined_names[name].attr_text == f"'Results'!$B${i}"


def test_totals_are_the_sums_of_their_columns(book, overland):
    read = openpyxl.load_workbook(book)
    forces = read["Resistances"]
    rows = len(overland.resistances)
    assert forces.cell(rows + 3, 1).value == "effective tension"
    above = math.fsum(forces.cell(i, 3).value for i in range(3, rows + 3))
    assert forces.cell(rows + 3, 3).value == pytest.approx(above, rel=1e-12)  # sums of 1e2 terms in another order
    sections = read["Sections"]
    last = len(overland.sections) + 3
    for name in ("indentation [N]", "idler rotation [N]", "flexure [N]"):
        column = list(overland.sections.columns).index(name) + 1
        assert sections.cell(last, column).value == pytest.approx(overland.summary[name], rel=1e-12)


def test_comparison_is_on_the_resistances_sheet(book, overland):
    sheet = openpyxl.load_workbook(book)["Resistances"]
    rows = {row[0]: row[1:3] for row in sheet.iter_rows(values_only=True)}
    for name, ours, classical in overland.tables["classical"].frame().itertuples(index=False):
        if name != "lift force [N]":  # both name a row of forces too
            assert rows[name] == pytest.approx((ours, classical), rel=DIGITS)


HEADERS = {
    "Inputs": ["field", "as entered", "SI value", "SI unit", "given by"],
    "Tensions": ["place", "distance from drive [m]", "tension [N]", "minimum tension (sag) [N]"],
}  # fmt: skip


@pytest.mark.parametrize("sheet", HEADERS)
def test_headers_others_read_by_do_not_move(book, sheet):
    read = openpyxl.load_workbook(book)[sheet]
    assert [cell.value for cell in read[2]][: len(HEADERS[sheet])] == HEADERS[sheet]
    assert read.freeze_panes == "B3"
    assert read.print_title_rows == "$1:$2"


def test_every_number_fits_its_column(book):
    """Excel shows ### where a number is wider than its column."""
    for sheet in openpyxl.load_workbook(book):
        for row in sheet.iter_rows():
            for cell in row:
                if isinstance(cell.value, float) and cell.number_format.startswith("#,##0"):
                    digits = max(0, len(cell.number_format) - 6)
                    shown = f"{cell.value:,.{digits}f}"
                    width = sheet.column_dimensions[get_column_letter(cell.column)].width
                    assert len(shown) + 1 <= width, (sheet.title, cell.coordinate)


def test_every_sheet_prints_under_the_name(book, overland):
    for sheet in openpyxl.load_workbook(book):
        assert sheet.oddHeader.left.text == overland.conveyor.name
        assert sheet.oddHeader.right.text == "&A"
        assert sheet.oddFooter.right.text == "&P / &N"
        assert sheet.page_setup.paperSize == int(sheet.PAPERSIZE_A4)
        assert sheet.freeze_panes is not None or sheet.title in {"Summary", "Checks and notes"}


def test_inputs_as_entered_and_in_si(book):
    read = pd.read_excel(book, sheet_name="Inputs", header=1).set_index("field")
    assert read.loc["belt.width", "as entered"] == "1200 mm"
    assert read.loc["belt.width", "SI value"] == 1.2
    assert read.loc["belt.width", "SI unit"] == "m"
    assert read.loc["ambient.temperature", "SI value"] == 293.15
    assert read.loc["belt.carcass.strength", "SI unit"] == "N/m"
    assert read.loc["belt.bottom_cover.compound", "as entered"] == "low-rolling-resistance-cover"
    assert read.loc["idlers.return.spacing", "given by"] == "spec"
    assert read.loc["calculation.rtol"].tolist() == ["0.0001", 1e-4, "-", "default"]
    assert read.index.is_unique


def test_inputs_hold_every_field_of_the_spec(book, overland):
    """Every leaf of the conveyor's data, counted by a walk of its plain data, has its row."""

    def leaves(data, path):
        if isinstance(data, dict) and "prony" in data:
            yield path
        elif isinstance(data, dict):
            for key, value in data.items():
                yield from leaves(value, f"{path}.{key}".removeprefix("."))
        elif isinstance(data, list):
            for i, value in enumerate(data):
                yield from leaves(value, f"{path}[{i}]")
        elif data is not None:
            yield path

    read = pd.read_excel(book, sheet_name="Inputs", header=1)
    assert set(leaves(overland.conveyor.as_data(), "")) - {"conveyor"} <= set(read["field"])  # the format's version


def test_warnings_and_provenance_are_in_it(book, overland):
    sheet = openpyxl.load_workbook(book)["Checks and notes"]
    cells = [cell.value for row in sheet.iter_rows() for cell in row if cell.value is not None]
    for line in (*overland.warnings, *overland.assumptions):
        assert line in cells
    assert conveyor.__version__ in cells
    assert conveyor.spec.fingerprint(overland.conveyor) in cells
    assert date.today().isoformat() in cells


@pytest.mark.parametrize("name", ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)"])
def test_what_a_user_types_stays_text(overland, tmp_path, name):
    sections = [overland.conveyor.route.sections[0].replace(name=name), *overland.conveyor.route.sections[1:]]
    line = overland.conveyor
    line = line.replace(name=name, notes=name, route=line.route.replace(sections=sections))
    path = conveyor.analyse(line).to_excel(tmp_path / "typed.xlsx")
    read = openpyxl.load_workbook(path)
    hits = [cell for sheet in read for row in sheet.iter_rows() for cell in row if cell.value == name]
    assert len(hits) >= 4
    for cell in hits:
        assert cell.data_type == "s"
        assert cell.quotePrefix


@pytest.mark.parametrize(
    ("typed", "shown"),
    [
        ("bell\x07 and \uffff", "bell\\x07 and \\uffff"),  # neither may stand in XML
        ("R&D 'belt' <1>", "R&D 'belt' <1>"),
        ("Förderer 带式", "Förderer 带式"),
    ],
)
def test_odd_characters_are_shown_not_lost(overland, tmp_path, typed, shown):
    line = overland.conveyor.replace(name=typed)
    read = openpyxl.load_workbook(conveyor.analyse(line).to_excel(tmp_path / "odd.xlsx"))
    assert read["Summary"]["A1"].value == shown


def test_endless_notes_say_where_they_are_cut(overland, tmp_path):
    typed = "first line\n" + "x" * 40_000
    read = openpyxl.load_workbook(
        conveyor.analyse(overland.conveyor.replace(notes=typed)).to_excel(tmp_path / "notes.xlsx")
    )
    entered = next(row[1] for row in read["Inputs"].iter_rows(values_only=True) if row[0] == "notes")
    assert len(entered) == CELL_CHARACTERS
    assert entered.endswith(f"(cut here: {len(typed)} characters)")
    whole = [row[0] for row in read["Checks and notes"].iter_rows(values_only=True)]
    assert "".join(cell for cell in whole if isinstance(cell, str) and set(cell) == {"x"}) == "x" * 40_000


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ("report.pdf", "ends in .xlsx"),
        ("nowhere/report.xlsx", "does not exist"),
        ("folder.xlsx", "is a folder"),
    ],
)
def test_refused_paths_leave_nothing_behind(overland, tmp_path, target, message):
    (tmp_path / "folder.xlsx").mkdir()
    with pytest.raises(InputError, match=message):
        overland.to_excel(tmp_path / target)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.xlsx"]


def test_a_full_disk_leaves_the_older_workbook(overland, tmp_path):
    """A real refusal of the system, half way through the file: its size is limited to 1 kB."""
    resource = pytest.importorskip("resource")
    path = tmp_path / "report.xlsx"
    path.write_bytes(b"old")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with pytest.raises(InputError, match=r"report\.xlsx: cannot be written \(File too large\)"):
            overland.to_excel(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert path.read_bytes() == b"old"
    assert [item.name for item in tmp_path.iterdir()] == ["report.xlsx"]


def test_a_folder_that_refuses_is_named(overland, tmp_path, monkeypatch):
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "write_bytes", refuse)
    with pytest.raises(InputError, match=r"report\.xlsx: cannot be written \(Permission denied\)"):
        overland.to_excel(tmp_path / "report.xlsx")
    assert list(tmp_path.iterdir()) == []


def test_a_name_too_long_is_refused(overland, tmp_path):
    with pytest.raises(InputError, match="cannot be written"):
        overland.to_excel(tmp_path / ("x" * 300 + ".xlsx"))
    assert list(tmp_path.iterdir()) == []


def test_an_older_workbook_is_replaced(overland, tmp_path):
    path = tmp_path / "report.XLSX"
    path.write_bytes(b"old")
    assert overland.to_excel(str(path)) == path
    assert openpyxl.load_workbook(path).sheetnames == SHEETS


def test_two_workbooks_of_one_analysis_hold_the_same_cells(overland, tmp_path):
    first, second = (
        [
            [cell.value for row in sheet.iter_rows() for cell in row]
            for sheet in openpyxl.load_workbook(overland.to_excel(tmp_path / name))
        ]
        for name in ("a.xlsx", "b.xlsx")
    )
    assert first == second


@pytest.fixture(scope="module")
def covers(overland, tmp_path_factory):
    """A comparison with a year, an emission factor and one extra cost; its workbook."""
    year = {
        "hours_per_year": "6000 h",
        "price": "0.1 EUR/kWh",
        "emission": "0.4 kg/kWh",
        "emission_source": "x",
    }
    names = ["standard-cover", "low-rolling-resistance-cover"]
    found = conveyor.compare_compounds(
        overland.conveyor.replace(operation=year),
        names,
        temperatures=["20 degC"],
        extra_costs={names[1]: 9e3},
    )
    return found.to_excel(tmp_path_factory.mktemp("covers") / "covers.xlsx")


def _recalculated(book, changes):
    """Values of the formulas of the costs by their cells, names and other cells at their values or changed."""
    values, formulas = (openpyxl.load_workbook(book, data_only=shown)["Ranking"] for shown in (True, False))
    names = {
        name: at.attr_text.rpartition("!")[2].replace("$", "")
        for name, at in openpyxl.load_workbook(book).defined_names.items()
    }
    known = {cell.coordinate: cell.value for row in values.iter_rows() for cell in row}
    known |= {names[name]: value for name, value in changes.items()}
    space = {name: known.get(at) for name, at in names.items()}
    for column in formulas.iter_cols():  # a saving takes a cost of a row below it
        for cell in column:
            if cell.data_type == "f":
                paid = r'IF\((\w+)="","",IF\((\w+)>0,MAX\(\1,0\)/\2,"never"\)\)'
                text = re.sub(paid, r'"" if \1 is None else max(\1, 0) / \2 if \2 > 0.0 else "never"', cell.value[1:])
                known[cell.coordinate] = eval(text, {}, space | known)  # noqa: S307 our own
                yield cell.coordinate, known[cell.coordinate], values[cell.coordinate].value


def test_a_year_of_a_comparison_follows_its_formulas(covers):
    rows = list(_recalculated(covers, {}))
    # energy, cost, saving, carbon dioxide of two covers; of one the ends of its saving and its payback with ends
    assert len(rows) == 2 * 4 + 2 + 3
    for at, found, saved in rows:
        assert found == (pytest.approx(saved, rel=1e-12, abs=1e-6) if isinstance(saved, float) else saved or ""), at


def test_twice_the_price_costs_twice_and_pays_back_in_half_the_time(covers):
    for before, after in zip(
        _recalculated(covers, {}), _recalculated(covers, {"what_if_energy_price": 0.2}), strict=True
    ):
        column = before[0][0]
        factor = {"C": 1.0, "D": 2.0, "E": 2.0, "F": 2.0, "G": 2.0, "H": 1.0} | dict.fromkeys("JKL", 0.5)
        if isinstance(before[1], float):
            assert after[1] == pytest.approx(factor[column] * before[1], rel=1e-12), before[0]
