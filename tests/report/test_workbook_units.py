"""The workbook in SI and US units: the same figures, converted; what can be checked without an office program."""

from __future__ import annotations

import re
from pathlib import Path

import openpyxl
import pytest
from openpyxl.utils import range_boundaries

import conveyor
from conveyor.errors import InputError
from conveyor.report.cells import INFINITY_SIGN, VERDICT_STYLES
from conveyor.results.comparisons import compare_compounds
from conveyor.units.presentation import display_unit
from tests.report.checking import checks

SPECS = sorted((Path(__file__).parent.parent.parent / "examples" / "specs").glob("*.yaml"))
ROUNDED = 1e-11  # twelve significant digits of a conversion, and one division
FACTORS = {  # NIST SP 811, appendix B.8; exact but for the horsepower (550 ft lbf/s) and pound-force
    ("m", "ft"): 1.0 / 0.3048,
    ("mm", "in"): 1.0 / 25.4,
    ("m/s", "fpm"): 60.0 / 0.3048,
    ("m/s²", "ft/s²"): 1.0 / 0.3048,
    ("kg", "lb"): 1.0 / 0.45359237,
    ("kg/m", "lb/ft"): 0.3048 / 0.45359237,
    ("kg/m²", "lb/ft²"): 0.3048**2 / 0.45359237,
    ("kg/h", "lb/h"): 1.0 / 0.45359237,
    ("m²", "ft²"): 1.0 / 0.3048**2,
    ("K", "Δ°F"): 1.8,
    ("kg m²", "lb ft²"): 1.0 / 0.45359237 / 0.3048**2,
    ("N", "lbf"): 1.0 / 4.4482216152605,
    ("N/m", "lbf/in"): 0.0254 / 4.4482216152605,
    ("N/mm", "lbf/in"): 25.4 / 4.4482216152605,
    ("MPa", "psi"): 1e6 * 0.0254**2 / 4.4482216152605,
    ("kW", "hp"): 1e3 / (550.0 * 0.3048 * 4.4482216152605),
    ("N m", "lbf ft"): 1.0 / (0.3048 * 4.4482216152605),
    ("t/h", "stph"): 1000.0 / 907.18474,
    ("t", "short ton"): 1000.0 / 907.18474,
    ("t", "metric ton"): 1.0,
    ("kWh/(t km)", "kWh/(short ton mile)"): 0.90718474 * 1.609344,
}
UNIT = re.compile(r" \[([^\]]*)\]$")
SYMBOL = re.compile(r" (Te|T1|T2|Tmax)$")
SAME = {"MJ", "Hz", "s", "-", "°", "rpm", "h", "MWh", "a", "EUR", "USD", "kg/kWh", "EUR/kWh", "USD/kWh"}


@pytest.fixture(scope="module", params=SPECS, ids=lambda path: path.stem)
def pair(request, studied, tmp_path_factory):
    """Workbooks of one spec in SI and in US units."""
    folder = tmp_path_factory.mktemp("w")
    result, asked = studied(request.param.stem)
    return tuple(
        openpyxl.load_workbook(result.to_excel(folder / f"{system}.xlsx", asked, system=system))
        for system in ("SI", "US")
    )


def tables(book):
    """Every named table: its header and its rows."""
    for name, defined in book.defined_names.items():
        if name.startswith("table_"):
            sheet, cells = next(iter(defined.destinations))
            left, top, right, bottom = range_boundaries(cells.replace("$", ""))
            rows = list(
                book[sheet].iter_rows(min_row=top, max_row=bottom, min_col=left, max_col=right, values_only=True)
            )
            yield name, rows[0], rows[1:]


def by_row(header):
    """Whether figures are named in the first column: another one has no unit but holds them."""
    return header[0] in {"quantity", "figure"}


def converted(si_name, us_name, value):
    """Return an SI figure in the unit of the US name; the words of both are the same but for US symbols."""
    sign, other = (UNIT.search(name)[1] if UNIT.search(name) else "" for name in (si_name, us_name))
    assert UNIT.sub("", si_name) == SYMBOL.sub("", UNIT.sub("", us_name))
    if (sign, other) == ("°C", "°F"):
        return 1.8 * value + 32.0
    if sign == other:
        assert sign in SAME or not sign, si_name
        return value
    return value * FACTORS[sign, other]


def test_us_figures_are_the_si_figures_converted(pair):
    si_tables, us_tables = ({name: (header, rows) for name, header, rows in tables(book)} for book in pair)
    assert si_tables.keys() == us_tables.keys()
    compared = 0
    for name, (header, rows) in si_tables.items():
        us_header, us_rows = us_tables[name]
        if name in {
            "table_inputs",
            "table_inputs_given",
            "table_inputs_default",
            "table_checks",
            "table_provenance",
        }:
            continue
        for row, us_row in zip(rows, us_rows, strict=True):
            for j, (value, us_value) in enumerate(zip(row, us_row, strict=True)):
                if isinstance(value, int | float):
                    figured = by_row(header) and not UNIT.search(header[j])
                    names = (row[0], us_row[0]) if figured else (header[j], us_header[j])
                    assert us_value == pytest.approx(converted(*names, value), rel=ROUNDED, abs=1e-12), names
                    compared += 1
    assert compared > 500


def test_no_metric_unit_is_left_where_us_units_are_asked_for(pair):
    for sheet in pair[1]:
        if sheet.title not in {"Inputs", "Given"}:
            names = [c.value for row in sheet.iter_rows() for c in row if isinstance(c.value, str)]
            units = {UNIT.search(name)[1] for name in names if UNIT.search(name)}
            assert not units & {unit for unit, _ in FACTORS} | units & {"degC", "°C"}, sheet.title


def test_axes_carry_the_units_of_their_columns(pair):
    def words(title):
        return "".join(run.t for p in title.tx.rich.p for run in (p.r or ()))

    for book, sign in zip(pair, ("[kN]", "[lbf]"), strict=True):
        chart = book["Tension diagram"]._charts[0]
        assert words(chart.y_axis.title) == f"tension {sign}"
        assert words(book["Summary"]._charts[0].y_axis.title) == f"force {sign}"


def test_columns_of_numbers_hold_numbers_only(pair):
    """A column with a unit holds numbers, gaps, or the sign of no bound; never a number with its unit as text."""
    for book in pair:
        for name, header, rows in tables(book):
            for j, title in enumerate(header):
                if UNIT.search(title):
                    cells = {type(row[j]) for row in rows if row[j] not in (None, INFINITY_SIGN)}
                    assert cells <= {int, float}, (name, title)


def test_no_cell_is_an_error(pair):
    for book in pair:
        types = {cell.data_type for sheet in book for row in sheet.iter_rows() for cell in row}
        assert "e" not in types


def test_every_unit_has_its_number_format(pair):
    for book in pair:
        for sheet in book:
            if sheet.title == "Inputs":
                continue
            for row in sheet.iter_rows():
                for cell in row:
                    if isinstance(cell.value, float):
                        assert cell.number_format != "General", (sheet.title, cell.coordinate)


def test_paper_follows_the_units(pair):
    assert [int(book["Summary"].page_setup.paperSize) for book in pair] == [
        9,
        1,
    ]  # ECMA-376 18.18.57: A4, Letter


def test_cover_is_one_page_with_the_checks_on_it_or_behind_it(pair):
    for book in pair:
        sheet = book["Summary"]
        assert sheet.page_setup.orientation == "portrait"
        assert sheet.max_column == 7
        (checks,) = (row for row in range(1, sheet.max_row) if str(sheet.cell(row, 1).value).startswith("Checks:"))
        last = sheet.max_row
        if sheet.row_breaks.brk:
            last = checks - 1
            assert [one.id for one in sheet.row_breaks.brk] == [last]
            assert sheet.page_setup.fitToHeight == 0
        else:
            assert sheet.page_setup.fitToHeight == 1
        assert sheet.page_setup.fitToWidth == 1  # in any font
        assert sheet.sheet_properties.pageSetUpPr.fitToPage
        heights = (sheet.row_dimensions[row].height or 15.0 for row in range(1, last + 1))
        assert sum(heights) < 925.0  # 673 pt of paper of the US, letters of 8 pt for 11


def test_names_of_figures_point_to_numbers(pair):
    for book in pair:
        for name, defined in book.defined_names.items():
            if not name.startswith("table_"):
                sheet, cell = next(iter(defined.destinations))
                value = book[sheet][cell.replace("$", "")].value
                live = name.startswith("what_if_") and str(value).startswith("=")
                assert live or isinstance(value, int | float), name


@pytest.fixture(scope="module")
def brakes(studied):
    return studied("downhill_brakes")[0]


def named(book, name):
    sheet, cell = next(iter(book.defined_names[name].destinations))
    return book[sheet][cell.replace("$", "")].value


def test_names_hold_the_figures_of_the_analysis(brakes, tmp_path):
    book = openpyxl.load_workbook(brakes.to_excel(tmp_path / "b.xlsx"))
    balance, moving = brakes.balance, brakes.motions
    expected = {
        "motor_power": balance.power.motor / 1e3,
        "belt_power": balance.power.belt / 1e3,
        "effective_tension": balance.forces.total,
        "tight_side_tension": balance.tensions.tight,
        "slack_side_tension": balance.tensions.slack,
        "take_up_setting": balance.equilibrium.setting,
        "equivalent_f": balance.friction_factor,
        "indentation_force": balance.forces.indentation,
        "indentation_share": balance.forces.indentation / balance.forces.main,
        "motion_moving_mass": moving.moving_mass,
        "belt_safety_steady": brakes.belt_duty.safety_steady,
    }
    assert {name: named(book, name) for name in expected} == pytest.approx(expected, rel=1e-15)


def test_verdicts_are_words_on_their_colours(brakes, tmp_path):
    book = openpyxl.load_workbook(brakes.to_excel(tmp_path / "b.xlsx"))
    found = checks(brakes)
    sheet = book["Checks and notes"]
    rows = [list(row[:5]) for row in sheet.iter_rows(min_row=3, max_row=2 + len(found))]
    assert [tuple(row[i].value for i in (0, 1, 2, 4)) for row in rows] == [
        (c.subject, c.found, c.asked, c.verdict) for c in found
    ]
    for *_, cell in rows:
        assert cell.fill.fgColor.rgb == VERDICT_STYLES[cell.value].fill.fgColor.rgb
    cover = [row[6] for row in book["Summary"].iter_rows() if row[6].value in {"pass", "FAIL", "not checked"}]
    assert 0 < len(cover) <= len(found)
    assert all(cell.fill.fgColor.rgb == VERDICT_STYLES[cell.value].fill.fgColor.rgb for cell in cover)
    assert VERDICT_STYLES["FAIL"].font.b  # a failure without colours, too
    assert not VERDICT_STYLES["pass"].font.b


def test_margins_of_the_cover_are_written_as_those_of_every_check(brakes, tmp_path):
    """A spreadsheet's format has its conditions in brackets: beyond 100 % it shows no more than that."""
    book = openpyxl.load_workbook(brakes.to_excel(tmp_path / "b.xlsx"))
    cover = [row[4] for row in book["Summary"].iter_rows() if row[6].value in {"pass", "FAIL"}]
    margins = [cell for cell in cover if isinstance(cell.value, float)]
    assert any(cell.value > 1.0 for cell in margins)
    assert all(cell.number_format.startswith('[>1]"> 100 %";') for cell in margins)


def test_what_failed_is_on_the_cover_however_many_passed(brakes, tmp_path):
    """Of every criterion the cover shows the least margin; a brake too weak fails and stays."""
    pulley = brakes.conveyor.drive.replace(brake_force="1 kN")
    weak = conveyor.analyse(brakes.conveyor.replace(drive=pulley))
    failed = [check.subject for check in checks(weak) if check.verdict == "FAIL"]
    assert failed
    sheet = openpyxl.load_workbook(weak.to_excel(tmp_path / "w.xlsx"))["Summary"]
    shown = {row[0].value for row in sheet.iter_rows() if row[6].value == "FAIL"}
    assert shown == set(failed)
    last = next(str(row[0].value) for row in sheet if "of each criterion" in str(row[0].value))
    assert last.endswith(f"all {len(checks(weak))} checks: see Checks and notes")


def test_the_spec_says_units_paper_and_head(brakes, tmp_path):
    report = brakes.conveyor.report.replace(
        units="US", paper="A4", project="=Quarry", number="C-101", client="N", engineer="E", revision="B"
    )
    result = conveyor.analyse(brakes.conveyor.replace(report=report))
    book = openpyxl.load_workbook(result.to_excel(tmp_path / "u.xlsx"))
    assert book["Results"]["A3"].value == "length [ft]"
    assert int(book["Summary"].page_setup.paperSize) == 9
    said = {(a.value, b.value) for row in book["Summary"]["A1:E6"] for a, b in ((row[0], row[1]), (row[3], row[4]))}
    assert {
        ("project", "=Quarry"),
        ("number", "C-101"),
        ("client", "N"),
        ("engineer", "E"),
        ("revision", "B"),
    } <= said
    assert book["Summary"].oddHeader.left.text.startswith("=Quarry, ")
    in_si = openpyxl.load_workbook(result.to_excel(tmp_path / "s.xlsx", system="SI"))
    assert in_si["Results"]["A3"].value == "length [m]"


def test_unknown_systems_are_refused(brakes, tmp_path):
    with pytest.raises(InputError, match='system = "metric": SI or US'):
        brakes.to_excel(tmp_path / "m.xlsx", system="metric")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("kind", "system", "shown"),
    [
        ("force", "US", "#,##0"),
        ("line force", "US", "#,##0.0000"),
        ("size", "US", "#,##0.00"),
        ("thickness", "US", "0.0000"),
        ("relaxation time", "SI", "0.00E+00"),
        ("time", "SI", "#,##0.0"),
        ("money USD", "US", "#,##0"),
        ("share", "SI", "0.0 %"),
        ("text", "SI", "General"),
    ],
)
def test_formats(kind, system, shown):
    assert display_unit(kind, system).pattern == shown


def test_comparison_in_us_units(tmp_path):
    line = conveyor.load(next(p for p in SPECS if p.stem == "in_plant_us"))
    found = compare_compounds(
        line,
        ["standard-cover", "S100"],
        temperatures=["0 degC", "20 degC"],
        rtol=1e-3,
        extra_costs={"S100": 1000},
    )
    books = [
        openpyxl.load_workbook(found.to_excel(tmp_path / f"{system}.xlsx", system=system)) for system in ("SI", "US")
    ]
    assert books[0].sheetnames == ["Ranking", "Power", "Scenes", "Coverage", "Notes"]
    si_power, us_power = (
        {name: (header, rows) for name, header, rows in tables(book)}["table_power_1"] for book in books
    )
    assert us_power[0] == ("temperature [°F]", "standard-cover [hp]", "S100 [hp]")
    for row, us_row in zip(si_power[1], us_power[1], strict=True):
        assert us_row[0] == pytest.approx(1.8 * row[0] + 32.0, rel=ROUNDED)
        assert us_row[1:] == pytest.approx([v * FACTORS["kW", "hp"] for v in row[1:]], rel=ROUNDED)
    covered = [row[6] for row in books[1]["Coverage"]["A3:G6"]]
    assert all(cell.fill.fgColor.rgb == VERDICT_STYLES[cell.value].fill.fgColor.rgb for cell in covered)


def test_what_stands_beside_a_governing_figure_keeps_to_its_columns(pair):
    """Wrapped over the columns to the right edge, as high as its lines."""
    for book in pair:
        sheet = book["Summary"]
        column = [sheet.cell(row, 1).value for row in range(1, sheet.max_row)]
        first, last = (column.index(heading) for heading in ("What governs the design", "The conveyor"))
        rows = [row for row in range(first + 2, last + 1) if sheet.cell(row, 4).value]
        assert any("classical motor power" in sheet.cell(row, 1).value for row in rows)
        for row in rows:
            assert sheet.cell(row, 4).alignment.wrap_text
            assert f"D{row}:G{row}" in {str(merged) for merged in sheet.merged_cells.ranges}
            assert sheet.row_dimensions[row].height >= 15.0 * (len(sheet.cell(row, 4).value) / 118)
