"""Workbooks as people and programs spoil them: each ends in messages with sheet and cell."""

from __future__ import annotations

import re
import time
import zipfile
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from openpyxl import Workbook, load_workbook
from openpyxl.worksheet.worksheet import Worksheet

from conveyor import spec
from conveyor.errors import InputError
from conveyor.files.workbook_cells import Sheet, SheetCell
from conveyor.forms import form_reader
from conveyor.forms.form_reader import LIMITS, read_template, sheets_of
from conveyor.models import Conveyor
from conveyor.starter.template_writer import write_template


@pytest.fixture(scope="session")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workbook of the ten sections of an example."""
    given = spec.load(Path(__file__).parents[2] / "examples" / "specs" / "overland.yaml")
    return write_template(tmp_path_factory.mktemp("template") / "pristine.xlsx", given)


@pytest.fixture
def path(pristine: Path, tmp_path: Path) -> Path:
    copy = tmp_path / "input.xlsx"
    copy.write_bytes(pristine.read_bytes())
    return copy


def load(path: Path) -> Conveyor:
    filled = read_template(path)
    return spec.from_data(filled.data, where=filled.where, base=path.parent)


def cell(book: Workbook, key: str, column: int = 2) -> Any:
    """The value cell (the unit cell: column 3) of a field of a form."""
    for sheet in book.worksheets:
        for row in range(1, sheet.max_row + 1):
            if sheet.cell(row, 7).value == key:
                return sheet.cell(row, column)
    raise KeyError(key)


def place(path: Path, where: Any) -> str:
    return f"{path}:{where.parent.title}!{where.coordinate}"


# -- cells


Edit = Callable[[str, Any, Any], str]


@pytest.fixture(scope="session")
def sheets(pristine: Path) -> dict[str, Sheet]:
    return sheets_of(pristine)


@pytest.fixture
def retype(path: Path, sheets: dict[str, Sheet], monkeypatch: pytest.MonkeyPatch) -> Edit:
    """Type a value and a unit over those of a field; gives the place of its value cell."""
    grids = {name: replace(grid, cells=dict(grid.cells)) for name, grid in sheets.items()}
    monkeypatch.setattr(form_reader, "sheets_of", lambda *_: grids)

    def typed(key: str, value: Any, unit: Any) -> str:
        for grid in grids.values():
            row = next((row for row in grid.rows() if grid.text(row, 7) == key), None)
            if row is not None:
                grid.cells[row, 2], grid.cells[row, 3] = SheetCell(value), SheetCell(unit)
                for column, given in ((2, value), (3, unit)):
                    if given is None or not str(given).strip():
                        del grid.cells[row, column]
                return f"{path}:{grid.name}!B{row}"
        raise KeyError(key)

    return typed


CELLS: list[tuple[str, Any, Any, str]] = [
    ("belt.width", "1,2", "m", 'belt.width: got "1,2 m": a comma is ambiguous; write a decimal point'),
    ("belt.width", "1 200", "mm", "belt.width: got .* write the number without a thousands sign"),
    (
        "belt.width",
        "1200 mm",
        "m",
        'belt.width: got "1200 mm" beside the unit "m" of its cell or heading; give the number alone',
    ),
    ("belt.width", 1200, None, 'belt.width: got 1200.* without a unit; give the unit, e.g. "1200'),
    ("belt.width", 1200, "kg", r'belt.width: got "1200 kg" \(a mass\), expected a length such as "1200 mm"'),
    ("belt.width", 12, "m", "belt.width: got 12 m, allowed: >= 0.1 m and <= 5 m"),
    ("belt.width", True, "m", "belt.width: expected a length"),
    ("belt.width", "nan", "m", "belt.width: got .* expected a finite number"),
    ("belt.width", " ", "mm", "belt.width: missing; expected a length"),
    ("drive.friction", "0,35", None, 'drive.friction: expected a number, got "0,35"'),
    ("drive.friction", 7, None, "drive.friction: got 7.*, allowed: <= 1"),
    ("idlers.carry.rolls", 7, None, "idlers.carry.rolls: got 7, allowed: 1, 2, 3, 4, 5 or 6"),
    ("idlers.carry.rolls", "three", None, 'idlers.carry.rolls: got "three", allowed: 1, 2, 3, 4, 5 or 6'),
    ("idlers.carry.load_shares", "20 %; 60 %", None, "load_shares: got 2 shares for rolls: 3"),
    ("idlers.carry.load_shares", '"20', None, "load_shares: got .* expected values separated by"),
    ("belt.carcass.kind", "steelcord", None, "belt.carcass.kind: got \"steelcord\", allowed: 'steel cord'"),
    ("belt.bottom_cover.compound", "standard-cove", None, 'did you mean "standard-cover"'),
    ("route.turned_over", "maybe", None, 'route.turned_over: got "maybe", allowed: yes, no'),
    ("calculation.gauss_points", 2.5, None, "calculation.gauss_points: expected a whole number, got 2.5"),
    ("operation.price", "0.12", None, "operation.price: got .* expected a price"),
    (
        "operation.price",
        0.12,
        "EUR/kWh",
        'operation.price: got "0.12" beside .*; write "0.12 EUR/kWh" into the value',
    ),
]


@pytest.mark.parametrize("case", CELLS, ids=lambda case: f"{case[0]} {case[1]} {case[2]}")
def test_spoilt_cells_are_named(path: Path, retype: Edit, case: tuple[str, Any, Any, str]) -> None:
    key, value, unit, message = case
    where = retype(key, value, unit)
    with pytest.raises(InputError, match=re.escape(where) + " .*" + message):
        load(path)


def test_cells_without_a_value_of_their_own_are_named(path: Path) -> None:
    book = load_workbook(path)
    spoilt = {
        "belt.width": (
            datetime(2024, 5, 1, tzinfo=UTC).replace(tzinfo=None),
            "holds a date or time .2024-05-01",
        ),
        "belt.speed": (
            "=A1*2",
            "holds a formula without a result; open the workbook in a spreadsheet program",
        ),
        "belt.mass": ("#REF!", "holds the error #REF!; correct its formula or type the value"),
    }
    for key, (value, _) in spoilt.items():
        cell(book, key).value = value
    book.save(path)
    with pytest.raises(InputError) as refused:
        load(path)
    told = str(refused.value).splitlines()
    assert len(told) == len(spoilt)
    for key, (_, message) in spoilt.items():
        line = re.escape(place(path, cell(book, key))) + f" {key}: {message}"
        assert sum(re.match(line, given) is not None for given in told) == 1


ACCEPTED: list[tuple[Any, Any, str]] = [
    ("1200 mm", None, "1200 mm"),
    ("1200 mm", "mm", "1200 mm"),
    ("1200", "mm", "1200 mm"),
    (1200.0, " mm ", "1200 mm"),
    (1.2, "m", "1.2 m"),
]


@pytest.mark.parametrize(("value", "unit", "expected"), ACCEPTED)
def test_what_has_one_meaning_is_read(path: Path, retype: Edit, value: Any, unit: Any, expected: str) -> None:
    retype("belt.width", value, unit)
    assert load(path).as_data()["belt"]["width"] == expected


def test_switches_and_numbers_as_the_spreadsheet_stores_them(path: Path) -> None:
    book = load_workbook(path)
    cell(book, "route.turned_over").value = True
    cell(book, "idlers.carry.rolls").value = "3"
    cell(book, "calculation.gauss_points").value = 9.0
    cell(book, "drive.friction").value = "0.3"
    cell(book, "name").value = 12
    book.save(path)
    line = load(path)
    assert (line.route.turned_over, line.idlers.carry.rolls, line.calculation.gauss_points) == (True, 3, 9)
    assert (line.drive.friction, line.name) == (0.3, "12")


def test_a_percentage_beside_a_percent_sign_is_refused(path: Path) -> None:
    book = load_workbook(path)
    changed = cell(book, "drive.efficiency")
    changed.value, changed.number_format = 0.94, "0%"
    book.save(path)
    with pytest.raises(InputError, match=re.escape(place(path, changed)) + ".*shown as a percentage beside"):
        load(path)
    cell(book, "drive.efficiency", 3).value = None
    book.save(path)
    assert load(path).as_data()["drive"]["efficiency"] == 0.94


def test_formulas_with_results_are_read(path: Path) -> None:
    # openpyxl writes no results; so the result is put into the sheet's XML as spreadsheet programs do
    book = load_workbook(path)
    where = cell(book, "belt.width").coordinate
    names = book.sheetnames
    book["Belt"][where] = "=600*2"
    book.save(path)
    part = f"xl/worksheets/sheet{names.index('Belt') + 1}.xml"
    edit(path, part, lambda xml: re.sub(rb"<f>600\*2</f><v ?/>", b"<f>600*2</f><v>1200</v>", xml))
    assert load(path).as_data()["belt"]["width"] == "1200 mm"
    edit(path, part, lambda xml: xml.replace(b"<v>1200</v>", b"<v>1e999</v>"))
    with pytest.raises(InputError, match=rf"Belt!{where} belt.width: holds a number that is not finite"):
        load(path)


def test_all_spoilt_cells_are_told_at_once(path: Path) -> None:
    book = load_workbook(path)
    cell(book, "belt.width").value = "=1+1"
    book["Sections"]["C8"] = "=1+1"
    book.save(path)
    with pytest.raises(InputError) as refused:
        load(path)
    assert [line.split()[1] for line in str(refused.value).splitlines()] == [
        "belt.width:",
        "route.sections[1].length:",
    ]


# -- rows, columns, sheets


def test_empty_rows_of_lists_are_passed_over_and_places_stay_right(path: Path) -> None:
    before = [section.name for section in load(path).route.sections]
    book = load_workbook(path)
    book["Sections"].insert_rows(9, 3)
    book.save(path)
    assert [section.name for section in load(path).route.sections] == before
    book["Sections"]["C12"] = -5
    book.save(path)
    with pytest.raises(InputError, match=r"Sections!C12 route.sections\[2\].length: got -5 m, allowed: > 0 m"):
        load(path)


def test_missing_cells_of_a_list_are_named(path: Path) -> None:
    book = load_workbook(path)
    book["Sections"]["C8"] = None
    book.save(path)
    with pytest.raises(InputError, match=r"Sections!C8 route.sections\[1\].length: missing; expected a length"):
        load(path)


def test_a_list_without_items_points_at_its_sheet(path: Path) -> None:
    book = load_workbook(path)
    book["Sections"].delete_rows(7, 100)
    book.save(path)
    with pytest.raises(InputError, match=r"Sections!A6 route.sections: got 0 entries, at least 1 needed"):
        load(path)


def change(edit_book: Callable[[Workbook], object]) -> Callable[[Path], None]:
    def apply(path: Path) -> None:
        book = load_workbook(path)
        edit_book(book)
        book.save(path)

    return apply


def belt(book: Workbook) -> Worksheet:
    return book["Belt"]


SHEETS: dict[str, tuple[Callable[[Workbook], object], str]] = {
    "sheet missing": (
        lambda b: b.remove(belt(b)),
        r'input.xlsx: sheet "Belt" is missing; sheets found: "Conveyor"',
    ),
    "sheet renamed": (
        lambda b: setattr(belt(b), "title", "belt "),
        r'sheet "Belt" is missing; is it "belt "\? Give it its name back',
    ),
    "optional sheet renamed": (
        lambda b: setattr(b["Operation"], "title", "Operations"),
        r'"Operation" is missing; is it "Operations"',
    ),
    "header gone": (
        lambda b: belt(b).delete_rows(1, 4),
        r'sheet "Belt" has no row with "Key", "Value", "Unit"',
    ),
    "list header gone": (lambda b: b["Sections"].delete_rows(1, 6), r'sheet "Sections" has no row with "#"'),
    "key misspelt": (
        lambda b: belt(b).__setitem__("G5", "belt.widht"),
        r'Belt!G5 unknown key "belt.widht"; did you mean "belt.width"\?',
    ),
    "column misspelt": (
        lambda b: b["Sections"].__setitem__("C6", "lenght"),
        r'Sections!C6 unknown key "lenght"; did you mean "length"\?',
    ),
    "column twice": (
        lambda b: b["Sections"].__setitem__("E6", "length"),
        r'Sections!E6 column "length" twice; remove one',
    ),
    "key twice": (
        lambda b: belt(b).__setitem__("G6", "belt.width"),
        r"Belt!B6 belt.width: given twice, first in row 5",
    ),
    "value without field": (
        lambda b: belt(b).__setitem__("B40", 5),
        r'Belt!B40 a value in a row without a field \(column "Key"\)',
    ),
    "stray beside a list": (
        lambda b: b["Sections"].__setitem__("AZ40", 5),
        r"Sections!AZ40 outside the columns of the list",
    ),
    "stray beside a form": (
        lambda b: belt(b).__setitem__("XFD1048576", 1),
        r"Belt!XFD1048576 outside the columns of the form; remove it",
    ),
    "far above a form": (
        lambda b: belt(b).__setitem__("XFD3", 1),
        r"Belt!XFD3 outside the columns of the form; remove it, move it to another sheet, or name its column",
    ),
    "far beside a header": (lambda b: belt(b).__setitem__("XFD4", "Remark"), r"Belt!XFD4 outside the columns of"),
    "far beside a field": (lambda b: belt(b).__setitem__("XFD5", "#REF!"), r"Belt!XFD5 outside the columns of"),
    "near a field": (
        lambda b: belt(b).__setitem__("H5", "as quoted"),
        r"""Belt!H5 outside the columns of the form; .* or name its column beside "Key", such as "Remark\"""",
    ),
    "far above a list": (
        lambda b: b["Sections"].__setitem__("XFD3", 1),
        r"Sections!XFD3 outside the columns of the list; remove it, move it to another sheet$",
    ),
    "far beside an item": (lambda b: b["Sections"].__setitem__("XFD7", 1), r"Sections!XFD7 outside the columns of"),
    "merged value": (lambda b: belt(b).merge_cells("B5:C5"), r"Belt!B5:C5 cells are merged; unmerge them"),
    "merged items": (
        lambda b: b["Sections"].merge_cells("B7:B9"),
        r"Sections!B7:B9 cells are merged; unmerge them",
    ),
    "far cell": (
        lambda b: b["Sections"].__setitem__("XFD1048576", 1),
        r"Sections!XFD1048576 outside the columns of the list",
    ),
}


@pytest.mark.parametrize("case", SHEETS)
def test_spoilt_sheets_are_named(path: Path, case: str) -> None:
    spoil, message = SHEETS[case]
    change(spoil)(path)
    with pytest.raises(InputError, match=message):
        load(path)


def test_other_sheets_moved_rows_and_optional_sheets_are_no_error(path: Path) -> None:
    before = load(path).as_data()

    def spoil(book: Workbook) -> None:
        other = book.create_sheet("My notes", 0)
        other["A1"] = "=1/0"
        other.merge_cells("B1:C3")
        belt(book).insert_rows(1, 3)
        belt(book).insert_cols(4)
        belt(book).move_range("A8:H8", rows=40)
        book.remove(book["Operation"])

    change(spoil)(path)
    assert load(path).as_data() == {key: value for key, value in before.items() if key != "operation"}


def test_remarks_in_columns_with_a_name_are_no_values(path: Path) -> None:
    before = load(path).as_data()

    def remark(book: Workbook) -> None:
        belt(book)["H4"], belt(book)["I4"] = "Remark", "Checked on"
        belt(book)["H5"], belt(book)["I5"], belt(book)["H40"] = "as quoted", datetime(2026, 3, 1), 5

    change(remark)(path)
    assert load(path).as_data() == before


def test_an_absent_optional_column_is_empty_and_a_needed_one_is_missing(path: Path) -> None:
    change(lambda book: book["Sections"].delete_cols(3, 2))(path)
    with pytest.raises(InputError, match=r"Sections!A7 route.sections\[0\].length: missing"):
        load(path)


def test_written_out_compounds_are_named_once(path: Path) -> None:
    from conveyor import shelf

    data = load(path).as_data()
    data["belt"]["bottom_cover"]["compound"] = shelf.compound("s120").as_data() | {"name": "mine"}
    write_template(path, spec.from_data(data))
    book = load_workbook(path)
    own = book["Rubber compound 1"]
    assert (own["B5"].value, own["G5"].value) == ("mine", "@")
    own["B5"] = None
    book.save(path)
    with pytest.raises(InputError, match=r"'Rubber compound 1'!B5 needs a name to be referred to by"):
        load(path)
    own["B5"] = "mine"
    book.copy_worksheet(own).title = "Rubber compound 2"
    for part in ("terms", "shift", "sweeps", "tests"):
        book.copy_worksheet(book[f"Rubber compound 1 {part}"]).title = f"Rubber compound 2 {part}"
    book.save(path)
    with pytest.raises(InputError, match=r"'Rubber compound 2'!B5 \"mine\" is written out twice"):
        load(path)
    book["Rubber compound 2"]["B5"] = "other"
    book["Rubber compound 1 terms"]["B9"] = -1
    book.save(path)
    with pytest.raises(
        InputError,
        match=r"'Rubber compound 1 terms'!B9 belt.bottom_cover.compound.prony.terms\[2\].modulus: got -1",
    ):
        load(path)


# -- files


def edit(path: Path, part: str, how: Callable[[bytes], bytes]) -> None:
    """Rewrite one part of a workbook."""
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    changed = how(parts[part])
    assert changed != parts[part]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, changed if name == part else content)


def crowd(path: Path) -> None:
    with zipfile.ZipFile(path, "a") as archive:
        for i in range(LIMITS.parts):
            archive.writestr(f"xl/media/{i}", b"")


def lying_bomb(path: Path) -> None:
    """State a small size for a part that unpacks to a large one."""
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/media/bomb", b"\0" * 50_000_000)
    size = (50_000_000).to_bytes(4, "little")
    path.write_bytes(path.read_bytes().replace(size, (100).to_bytes(4, "little")))


def encrypted_part(path: Path) -> None:
    """Set the bit that marks encrypted parts in the directory of the archive."""
    content = bytearray(path.read_bytes())
    content[content.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(bytes(content))


def entities(encoding: str) -> Callable[[Path], None]:
    text = '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;">]>'

    def put_in(path: Path) -> None:
        edit(path, "xl/workbook.xml", lambda xml: text.encode(encoding) + xml)

    return put_in


def in_sheet(old: bytes, new: bytes) -> Callable[[Path], None]:
    """Put XML into the second sheet."""
    return lambda path: edit(path, "xl/worksheets/sheet2.xml", lambda xml: xml.replace(old, new))


END = b"</sheetData>"
SWELLING: dict[str, tuple[bytes, bytes, str]] = {
    "merged to the end of the sheet": (
        END,
        END + b'<mergeCells><mergeCell ref="B40:XFD1048576"/></mergeCells>',
        "Belt!B40:XFD1048576 cells are merged; unmerge them",
    ),
    "whole columns merged": (
        END,
        END + b'<mergeCells><mergeCell ref="B:Z"/></mergeCells>',
        "the workbook is damaged or incomplete",
    ),
    "empty cells": (
        END,
        b'<row r="60">' + b"<c/>" * 1_500_000 + b"</row>" + END,
        "more than 150,000 cells and other",
    ),
    "a row of no sheet": (
        END,
        b'<row r="99999999999"/>' + END,
        "row 99999999999, beyond the last of a sheet",
    ),
    "a column of no sheet": (
        END,
        b'<row r="60"><c r="ZZZZ60"/></row>' + END,
        "ZZZZ60, beyond the last of a sheet",
    ),
    "nested": (END, b"<a>" * 300_000 + b"</a>" * 300_000 + END, "nested deeper than 100 levels"),
    "a rule for many ranges": (
        END,
        END + (b'<dataValidation sqref="' + b"A1:B9 " * 32_000 + b'"/>') * 5,
        "more than 150,000 cells",
    ),
    "a tag of a megabyte": (
        b"<sheetData",
        b'<sheetData a="' + b"x" * 1_000_000 + b'"',
        "a tag of more than 262,144 bytes",
    ),
}


@pytest.mark.parametrize("case", SWELLING)
def test_what_would_swell_is_refused_at_once(path: Path, case: str) -> None:
    old, new, message = SWELLING[case]
    in_sheet(old, new)(path)
    assert path.stat().st_size < 300_000
    begun = time.process_time()
    with pytest.raises(InputError, match=message):
        load(path)
    assert time.process_time() - begun < 1.0


FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "encrypted zip": (encrypted_part, "protected by a password; save it without one"),
    "many parts": (crowd, "unpacks to more than 10,000,000 bytes or 2,000 parts"),
    "lying zip bomb": (lying_bomb, r"damaged or cut short"),
    "entities in UTF-16": (entities("utf-16"), "xl/workbook.xml declares a document type"),
    "bad checksum": (
        lambda p: p.write_bytes(p.read_bytes()[:2000] + b"\xff" * 40 + p.read_bytes()[2040:]),
        "damaged or cut short",
    ),
    "no workbook part": (
        lambda p: edit(p, "[Content_Types].xml", lambda _: b"<a/>"),
        "damaged or incomplete",
    ),
    "broken XML": (
        lambda p: edit(p, "xl/workbook.xml", lambda xml: xml[:-30]),
        "damaged or incomplete; save or copy it again",
    ),
    "other zip": (lambda p: zipfile.ZipFile(p, "w").close(), "not a workbook|damaged or incomplete"),
}


@pytest.mark.parametrize("case", FILES)
def test_files_that_are_no_workbooks_are_refused(path: Path, case: str) -> None:
    spoil, message = FILES[case]
    spoil(path)
    with pytest.raises(InputError, match=f"{re.escape(str(path))}: .*(?:{message})"):
        read_template(path)


def test_only_xlsx_is_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'expected a workbook that ends in .xlsx, got "a.xlsm"'):
        read_template(tmp_path / "a.xlsm")


# -- writing


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.xls", "a workbook's name ends in .xlsx"),
        ("none/a.xlsx", "its folder does not exist"),
        ("folder.xlsx", "is a folder"),
    ],
)
def test_paths_that_cannot_be_written_are_refused(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / "folder.xlsx").mkdir()
    with pytest.raises(InputError, match=message):
        write_template(tmp_path / name)
    assert [found.name for found in tmp_path.iterdir()] == ["folder.xlsx"]


def test_a_full_disk_leaves_the_old_workbook_alone(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = path.read_bytes()

    def full(*_: object) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(InputError, match=r"cannot be written .No space left on device."):
        write_template(path)
    assert path.read_bytes() == before
    assert list(path.parent.iterdir()) == [path]
