"""Sheets on paper: letters of 8 pt and more, no paragraph across two pages, no chart that a page cuts."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import openpyxl
import pytest
from openpyxl import Workbook
from openpyxl.chart import BarChart
from openpyxl.utils import get_column_letter, range_boundaries

import conveyor
from conveyor.report.sheet_paper import set_up_print
from tests.command_line import run

SPECS = Path(__file__).parent.parent.parent / "examples" / "specs"
CELL, PAPER = 11.0, 8.0  # letters of cells, smallest letters on paper [pt]
DIGIT = 7.0 / 96.0  # width of a digit of Calibri 11 [in]
PAGES = {9: (8.27, 11.69), 1: (8.5, 11.0)}  # A4, Letter [in]
CHART_HEIGHT = 7.5 / 2.54 * 72.0  # that of openpyxl [pt]


def page_of(sheet):
    """Width and height that a page has for cells [in, pt]."""
    wide, high = PAGES[int(sheet.page_setup.paperSize)]
    if sheet.page_setup.orientation == "landscape":
        wide, high = high, wide
    margins = sheet.page_margins
    return wide - margins.left - margins.right, 72.0 * (high - margins.top - margins.bottom)


def parts_of(sheet):
    """Columns of every page, and the scale that a spreadsheet gives them."""
    last = range_boundaries(sheet.print_area.split("!")[-1] or sheet.dimensions)[2]
    ends = [0, *sorted(one.id for one in sheet.col_breaks.brk), last]
    parts = [range(first + 1, end + 1) for first, end in pairwise(ends)]
    widths = [sum(DIGIT * sheet.column_dimensions[get_column_letter(i)].width for i in part) for part in parts]
    room = page_of(sheet)[0]
    if sheet.sheet_properties.pageSetUpPr is not None and sheet.sheet_properties.pageSetUpPr.fitToPage:
        return parts, widths, min(1.0, room / max(widths))
    return parts, widths, sheet.page_setup.scale / 100.0


@pytest.fixture(scope="module")
def books(tmp_path_factory):
    folder = tmp_path_factory.mktemp("paper")
    line = conveyor.load(SPECS / "overland.yaml")
    conveyor.analyse(line).to_excel(folder / "power.xlsx")
    covers = ["-c", "standard-cover", "-c", "low-rolling-resistance-cover", "--speed", "4,5"]
    run("compare", SPECS / "overland.yaml", *covers, "-o", folder / "compare.xlsx")
    conveyor.analyse(conveyor.load(SPECS / "in_plant_us.yaml")).to_excel(folder / "us.xlsx")
    return [openpyxl.load_workbook(path) for path in sorted(folder.glob("*.xlsx"))]


def test_no_letter_of_a_sheet_is_smaller_than_eight_points(books):
    for sheet in (sheet for book in books for sheet in book):
        _, widths, scale = parts_of(sheet)
        assert CELL * scale >= PAPER, sheet.title
        assert scale * max(widths) <= page_of(sheet)[0] * (1.0 + 1e-9), sheet.title
        sizes = {cell.font.sz or CELL for row in sheet.iter_rows() for cell in row if cell.value is not None}
        assert min(sizes) >= CELL, sheet.title


def test_no_paragraph_goes_over_two_pages(books):
    parted = 0
    for sheet in (sheet for book in books for sheet in book):
        for end in (one.id for one in sheet.col_breaks.brk):
            parted += 1
            crossing = [cells for cells in sheet.merged_cells.ranges if cells.min_col <= end < cells.max_col]
            assert crossing == [], (sheet.title, end)
    assert parted > 3


def test_a_page_that_ends_in_a_chart_ends_before_it():
    book = Workbook()
    sheet = book.worksheets[0]
    sheet["A45"] = "above"  # 45 rows of 15 pt are 675 pt, of the 990 that a page has at 8 pt
    for at in ("A46", "A60"):
        sheet.add_chart(BarChart(), at)
    sheet["A80"] = "below"
    set_up_print(sheet, "two charts")
    (end,) = (one.id for one in sheet.row_breaks.brk)
    height = page_of(sheet)[1] / (PAPER / CELL)
    assert height > 15.0 * 45 + CHART_HEIGHT  # the first has room
    assert end == 59
    assert not (sheet.sheet_properties.pageSetUpPr and sheet.sheet_properties.pageSetUpPr.fitToPage)
    assert CELL * sheet.page_setup.scale / 100.0 >= PAPER


def test_a_table_that_fits_a_page_is_on_one():
    """990 pt a page, 62 rows of 15.75: the second table would begin on the first page, the third is longer than one."""
    sheet = Workbook().worksheets[0]
    sheet["A150"] = "last"
    set_up_print(sheet, "three tables", blocks=[range(1, 41), range(42, 71), range(72, 151)])
    assert [one.id for one in sheet.row_breaks.brk] == [41]
    assert sheet.page_setup.scale / 100.0 >= PAPER / CELL


def test_no_table_of_a_workbook_is_cut_that_fits_a_page(books):
    """Tables one below the other, by their headings: between two ends of pages each has its place."""
    (results,) = (book["Results"] for book in books[1:2])
    ends = [one.id for one in results.row_breaks.brk]
    heading = next(cell.row for cell in results["A"] if str(cell.value).startswith("What if"))
    assert ends == [heading - 1]


def test_the_rubber_is_on_pages_of_one_width(books, tmp_path):
    line = conveyor.load(SPECS / "overland.yaml")
    letter = line.replace(report=line.report.replace(paper="Letter"))
    conveyor.analyse(letter).to_excel(tmp_path / "letter.xlsx")
    every = [*books, openpyxl.load_workbook(tmp_path / "letter.xlsx")]
    for book in (book for book in every if "Rubber" in book.sheetnames):
        sheet = book["Rubber"]
        assert list(sheet.col_breaks.brk) == []
        assert sheet.page_setup.orientation == "landscape"


@pytest.mark.parametrize(
    ("columns", "orientation", "pages"), [(10, "portrait", 1), (14, "landscape", 1), (30, "landscape", 3)]
)
def test_a_sheet_is_upright_as_long_as_it_fits(columns, orientation, pages):
    """Columns of 13: 9.5 in at full scale fit upright (7.5 in over 8 / 11 are 10.3), 13.3 across (15), 28 in not."""
    sheet = Workbook().worksheets[0]
    for column in range(1, columns + 1):
        sheet.column_dimensions[get_column_letter(column)].width = 13.0
        sheet.cell(1, column, "name")
    set_up_print(sheet, "wide")
    assert (sheet.page_setup.orientation, len(sheet.col_breaks.brk) + 1) == (orientation, pages)
    assert (sheet.print_title_cols is not None) is (pages > 1)
