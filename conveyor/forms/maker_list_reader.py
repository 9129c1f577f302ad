"""Makers' lists from workbooks: one sheet a kind, one column a field of a spec with its unit, one row an item."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from conveyor.arguments.argument_types import check_arguments
from conveyor.errors import InputError, SpecError
from conveyor.files import libraries
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.files.document import error_lines, yaml_text
from conveyor.files.file_bytes import file_content
from conveyor.files.libraries import flatten_fields
from conveyor.files.workbook_cells import ArchiveLimits, Sheet, SheetCell, cell_name, read_sheets
from conveyor.forms.cell_values import from_cells
from conveyor.forms.form_fields import FieldGroup, FormField, Part, model_layout
from conveyor.models import Belt, Drive, Pulley, Roll, RubberCompound
from conveyor.models.base import Model
from conveyor.models.library_items import merge_fields
from conveyor.models.maker_lists import FOLDER, MAKER_KINDS, SUFFIX, ListedItem, MakerKind, MakerList, maker_items
from conveyor.rubber import PronySeries

LIMITS: Final = ArchiveLimits(content=50_000_000, parts=2_000, elements=1_000_000, expected="maker's list")
"""A list of ten thousand rolls has a tenth of the elements."""
COLUMNS_SHEET: Final = "Columns"
"""Sheet of the form that explains its columns; it is not read."""
_LARGEST_FILE: Final = 20_000_000  # bytes


@dataclass(frozen=True)
class ListForm:
    """Sheet of a kind: the model whose fields its columns are, the fields needed, and those that complete the model.

    Attributes
    ----------
    model : type of Model
        Part of a spec that names an item.
    columns : mapping of str to str
        Unit of each field, "" of one that has none.
    needed : tuple of str
        Fields that every item has.
    either : tuple of str
        Fields of which every item has one at least.
    sample : mapping
        What a spec gives beside the item, to check it by the model; fields that it has not are not checked.
    """

    model: type[Model]
    columns: Mapping[str, str]
    needed: tuple[str, ...]
    sample: Mapping[str, Any]
    either: tuple[str, ...] = ()

    def leaf(self, path: str) -> FormField:
        """Field of a column."""
        part: Part = model_layout(self.model)
        for key in path.split("."):
            part = next(each for each in part.parts if each.key == key) if isinstance(part, FieldGroup) else part
        if not isinstance(part, FormField):
            raise TypeError(f"{path} is no single field")
        return part


_SERIES: Final = PronySeries(1e6, np.array([1e7]), np.array([1e-3]))
_COMPOUND: Final = RubberCompound.from_series(_SERIES, name="any", reference_temperature=293.15)
_DRIVE: Final = {"wrap_angle": "180 deg", "friction": 0.3, "efficiency": "100 %", "installed_power": "1 kW"}
_GEARED: Final = {**_DRIVE, "motor_speed": "1500 rpm"}
LIST_FORMS: Final[Mapping[MakerKind, ListForm]] = {
    "rolls": ListForm(
        Roll,
        {
            "diameter": "mm", "length": "mm", "rotating_mass": "kg", "drag": "N", "bearing.dynamic_rating": "kN",
            "bearing.distance": "mm", "bearing.axle_diameter": "mm", "bearing.support_distance": "mm",
        },
        ("diameter", "length", "rotating_mass"),
        {},
    ),
    "belts": ListForm(
        Belt,
        {
            "carcass.kind": "", "carcass.plies": "", "carcass.strength": "N/mm", "carcass.rating": "PIW",
            "carcass.thickness": "mm", "carcass.mass": "kg/m^2", "carcass.stiffness": "N/mm",
            "carcass.permanent_stretch": "%", "carcass.splice_strength": "%", "top_cover.thickness": "mm",
            "bottom_cover.thickness": "mm", "thickness": "mm", "mass": "kg/m^2", "transverse_stiffness": "N*m",
            "lowest_temperature": "degC", "highest_temperature": "degC",
        },
        ("carcass.kind", "carcass.thickness"),
        {
            "width": "1 m", "speed": "1 m/s", "top_cover": {"thickness": "5 mm"},
            "bottom_cover": {"thickness": "5 mm", "compound": _COMPOUND},
        },
    ),
    "pulleys": ListForm(
        Pulley,
        {
            "diameter": "mm", "shaft_diameter": "mm", "mass": "kg", "bearing_centres": "mm", "hub_centres": "mm",
            "hub_shaft_diameter": "mm", "face_width": "mm", "shaft_steel": "", "bearing_rating": "kN",
            "lagging_pressure": "MPa",
        },
        ("diameter", "shaft_diameter", "mass"),
        {"name": "head", "position": "head"},
    ),
    "motors": ListForm(
        Drive,
        {"installed_power": "kW", "motor_speed": "rpm", "inertia": "kg*m^2", "efficiency": "%", "torque_factor": ""},
        ("installed_power",),
        {**_DRIVE, "inertia": "1 kg*m^2", "gear_ratio": 1.0},
    ),
    "gearboxes": ListForm(Drive, {"gear_ratio": "", "efficiency": "%", "gear_torque": "kN*m"},
                          ("gear_ratio", "efficiency"), {**_DRIVE, "inertia": "1 kg*m^2"}),
    "couplings": ListForm(Drive, {"efficiency": "%", "torque_factor": "", "coupling_torque": "N*m"}, ("efficiency",),
                          {**_DRIVE, "motor_speed": "1500 rpm"}),
    "backstops": ListForm(Drive, {"backstop_torque": "kN*m", "backstop_shaft": ""}, ("backstop_torque",), _GEARED),
    "brakes": ListForm(Drive, {"brake_force": "kN", "brake_torque": "kN*m", "brake_shaft": "", "brake_heat": "MJ",
                               "brake_disc": "kg"}, (), _GEARED, ("brake_force", "brake_torque")),
}  # fmt: skip
"""Sheets of the form by kind: what checks and figures use of an item."""


@dataclass(frozen=True)
class _Column:
    """A column of a sheet: its number, path of its field ("name", "source", "note" beside), unit."""

    number: int
    path: str
    unit: str


@check_arguments
def read_maker_list(path: str | Path) -> MakerList:
    """Read a maker's list from a workbook.

    Parameters
    ----------
    path : str or Path
        Workbook with a sheet for each kind, as `conveyor library template` writes it.

    Returns
    -------
    MakerList
        Its items by kind and name.

    Raises
    ------
    InputError
        The file cannot be read, or cells are refused; all errors at once, each with file, sheet, cell, field, value and
        what to do.
    """
    where = Path(path)
    if where.suffix.lower() != ".xlsx":
        raise InputError(f'{where}: a maker\'s list is a workbook that ends in .xlsx, got "{where.name}"')
    sheets = read_sheets(file_content(where, largest=_LARGEST_FILE, expected="maker's list"), str(where), LIMITS)
    titles: dict[str, MakerKind] = {kind.casefold(): kind for kind in MAKER_KINDS}
    problems: list[str] = []
    read: dict[MakerKind, dict[str, Any]] = {}
    for sheet in sheets:
        kind = titles.get(sheet.name.strip().casefold())
        if kind is None and sheet.name != COLUMNS_SHEET and sheet.cells:
            known = ", ".join(each.capitalize() for each in MAKER_KINDS)
            problems.append(f"{where}:{sheet.name}: no sheet of a maker's list; name it {known}, or remove it")
        elif kind is not None:
            reader = _SheetReader(str(where), sheet, kind)
            read[kind] = reader.items()
            problems += reader.problems
    if not problems and not any(read.values()):
        problems.append(f"{where}: has no items; fill in a row of a sheet below its headings")
    if problems:
        raise InputError(error_lines(problems, str, str(where)))
    return MakerList.from_data({kind: items for kind, items in read.items() if items})


class _SheetReader:
    """Items of a sheet, and what is wrong with its cells."""

    def __init__(self, file: str, sheet: Sheet, kind: MakerKind) -> None:
        self.problems: list[str] = []
        self._file, self._sheet, self._kind, self._form = file, sheet, kind, LIST_FORMS[kind]
        self._columns = list(self._headings())

    def items(self) -> dict[str, Any]:
        """Entries by name."""
        made: dict[str, Any] = {}
        needed = [
            path for path in ("name", "source", *self._form.needed) if path not in {c.path for c in self._columns}
        ]
        if needed and self._sheet.cells:
            self._refuse(1, 1, "", f"no column {', '.join(needed)}; add it to the headings of the first row")
        if self.problems:
            return made
        known = {name.casefold() for name in libraries.built_in_entries(self._kind)}
        rows: dict[str, int] = {}
        for row in self._sheet.rows():
            if row == 1:
                continue
            entry = self._entry(row)
            name, column = str(entry.pop("name", "")), self._number("name")
            if name.casefold() in known:
                self._refuse(row, column, "name", f'got "{name}", which the package\'s own library has; rename it')
            elif name.casefold() in rows:
                self._refuse(row, column, "name", f'got "{name}", which row {rows[name.casefold()]} has; rename one')
            elif name:
                made[name] = entry
                rows[name.casefold()] = row
        return made

    def _headings(self) -> Iterator[_Column]:
        """Columns by the headings of the first row, ``field [unit]``."""
        seen: set[str] = set()
        for row, number in sorted(self._sheet.cells):
            if row != 1:
                continue
            heading = self._sheet.text(1, number)
            path, _, rest = heading.partition("[")
            path, unit = path.strip(), rest.strip().removesuffix("]").strip()
            plain = path in {"name", "source", "note"}
            if not plain and path not in self._form.columns:
                allowed = ", ".join(("name", "source", *self._form.columns, "note"))
                self._refuse(1, number, "", f'got "{heading}", which no figure or check uses; columns are {allowed}')
            elif path in seen:
                self._refuse(1, number, path, "is there twice; remove one column")
            elif not plain and self._form.leaf(path).kind == "quantity" and not unit:
                example = self._form.columns[path]
                self._refuse(1, number, path, f'has no unit; write it behind the field, such as "{path} [{example}]"')
            elif unit and (plain or self._form.leaf(path).kind != "quantity"):
                self._refuse(1, number, path, f'got the unit "{unit}" of a field that has none; remove it')
            else:
                yield _Column(number, path, unit)
            seen.add(path)

    def _entry(self, row: int) -> dict[str, Any]:
        """Entry of a row, with its name."""
        entry: dict[str, Any] = {"fields": {}}
        given: dict[str, int] = {}
        for column in self._columns:
            cell = self._sheet.cells.get((row, column.number))
            if cell is None:
                continue
            given[column.path] = column.number
            value = self._value(row, column, cell)
            if value is None:
                continue
            *above, key = column.path.split(".")
            held = entry if column.path in {"name", "source", "note"} else entry["fields"]
            for group in above:
                held = held.setdefault(group, {})
            held[key] = value
        for path in ("name", "source", *self._form.needed):
            if path not in given:
                self._refuse(row, self._number(path), path, "is empty; every item has it: fill it in")
        either = self._form.either
        if either and not any(path in given for path in either):
            self._refuse(row, self._number(either[0]), either[0], f"is empty; every item has it or {either[1]}")
        elif all(path in given for path in self._form.needed):
            self._check(row, entry["fields"], given)
        return entry

    def _value(self, row: int, column: _Column, cell: SheetCell) -> Any:
        """Value of a cell as in a spec; None of one refused."""
        said = {
            "date": f"got {cell.value}, a date; write a number or text",
            "error": f"got {cell.value}, the error of a formula; write the value",
            "no result": "a formula without a stored value; let a spreadsheet program calculate and save it, or copy "
            "the cells and paste them as values",
        }
        if cell.kind != "value":
            self._refuse(row, column.number, column.path, said[cell.kind])
            return None
        if column.path in {"name", "source", "note"}:
            return str(cell.value).strip()
        value, unit = cell.value, column.unit or None
        if cell.percent and isinstance(value, int | float):
            value, unit = 100.0 * value, "%"
        try:
            return from_cells(self._form.leaf(column.path), value, unit)
        except InputError as error:
            self._refuse(row, column.number, column.path, str(error))
            return None

    def _check(self, row: int, fields: dict[str, Any], given: Mapping[str, int]) -> None:
        """Check an item by the model of the part that names it; only what the item itself has."""
        for path, message in self._model_problems(fields):
            if path in given and path not in flatten_fields(fields):
                continue  # its cell is refused
            column = path if path in given else next((each for each in given if each.startswith(f"{path}.")), "name")
            self._refuse(row, self._number(column), path, message)

    def _model_problems(self, fields: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Refusals of an item by the model of the part that names it, with the values that the spec gives beside."""
        kept = set(flatten_fields(fields))
        try:
            self._form.model.from_data(merge_fields(self._form.sample, fields))
        except SpecError as error:
            for path, message in error.problems:
                if path == "mass" and not kept & {"mass", "carcass.mass"}:
                    continue  # the spec gives it
                if path == "thickness" and not {"top_cover.thickness", "bottom_cover.thickness"} <= kept:
                    continue  # of other covers
                yield path, message

    def _number(self, path: str) -> int:
        """Number of a column, the first where it is not there."""
        return next((column.number for column in self._columns if column.path == path), 1)

    def _refuse(self, row: int, column: int, path: str, message: str) -> None:
        self.problems.append(f"{self._file}:{self._sheet.name}!{cell_name(row, column)} {path or 'heading'}: {message}")


@check_arguments
def add_maker_list(path: str | Path, folder: str | Path | None = None) -> Path:
    """Read a maker's list and keep its items in a folder, in a file of the workbook's name.

    Parameters
    ----------
    path : str or Path
        The workbook; adding it again replaces its items.
    folder : str or Path, optional
        Folder to keep them in, made if it is not there; without it ``conveyor-library`` in the working folder.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        As `read_maker_list`; or another list that is found beside has an item of the same kind and name.
    """
    kept = Path(FOLDER) if folder is None else Path(folder)
    target, content = kept_list(path, kept)
    kept.mkdir(parents=True, exist_ok=True)
    check_writable(target)
    save_files({target: content})
    return target


def kept_list(path: str | Path, folder: Path) -> tuple[Path, bytes]:
    """File of a maker's list in a folder, and its content.

    Raises
    ------
    InputError
        As `add_maker_list`.
    """
    where = Path(path)
    read, target = read_maker_list(where), folder / f"{where.stem}{SUFFIX}"
    others = {
        (item.kind, item.name.casefold()): file
        for item, file in maker_items(folder.parent, folder)
        if file.resolve() != target.resolve()
    }
    clashes: dict[Path, list[ListedItem]] = {}
    for item in read.items:
        if (item.kind, item.name.casefold()) in others:
            clashes.setdefault(others[item.kind, item.name.casefold()], []).append(item)
    if clashes:
        told = [_clash_message(where, items, file) for file, items in clashes.items()]
        raise InputError(error_lines(told, str, str(where)))
    data = {kind: getattr(read, kind) for kind in MAKER_KINDS if getattr(read, kind)}
    plain = {
        kind: {name: {k: v for k, v in entry.as_data().items() if v != ""} for name, entry in items.items()}
        for kind, items in data.items()
    }
    heading = f"# {where.name}, read by conveyor library add; specs name an item with `listed`.\n"
    return target, (heading + yaml_text(plain, width=110)).encode()


def _clash_message(where: Path, items: list[ListedItem], file: Path) -> str:
    """Refusal of the items that another list has, too: one line a list."""
    first = f'{items[0].one} "{items[0].name}"'
    what = f"{first} is" if len(items) == 1 else f"{len(items)} items, {first} the first, are"
    return (
        f"{where}: {what} in {file}, too; rename one of each, or where that is an older edition remove it: "
        f"conveyor library remove {file.stem}"
    )
