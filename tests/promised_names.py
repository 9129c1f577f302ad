"""Names that users' files and scripts rely on, a line each; `python -m tests.promised_names` writes them at a release.

The stored file is that of the last release: what it lists and the package no longer has is a break of the promise in
docs/versions.md, whatever else the tests say.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

import conveyor
from conveyor.cli import app
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.base import Model
from conveyor.models.sizing import SizingDuty
from conveyor.models.study import StudyPlan
from conveyor.report.tables.result_schema import result_schema
from conveyor.starter.format_reference import format_fields
from conveyor.starter.output_reference import output_page

FILE = Path(__file__).parent / "promised_names.txt"
MODULES = ("contact", "indentation", "rubber", "shelf", "spec", "uncertainty", "units")
FORMATS = {"spec": Conveyor, "compound": RubberCompound, "duty": SizingDuty, "study": StudyPlan}


def python_names() -> Iterator[str]:
    """Functions with their arguments, classes with their public attributes; an argument without a default is marked."""
    for module in (conveyor, *(getattr(conveyor, name) for name in MODULES)):
        for name in getattr(module, "__all__", None) or _own_names(module):
            yield from _names_of(f"{module.__name__}.{name}", getattr(module, name))


def _own_names(module: Any) -> Iterator[str]:
    """Public functions and classes that a module defines."""
    for name, member in vars(module).items():
        if not name.startswith("_") and getattr(member, "__module__", "") == module.__name__:
            yield name


def _names_of(path: str, thing: Any) -> Iterator[str]:
    yield f"python {path}"
    if inspect.isclass(thing):
        for name, member in inspect.getmembers(thing):
            ours = any(name in vars(base) and base.__module__.startswith("conveyor") for base in thing.__mro__)
            if ours and not name.startswith("_") and not (issubclass(thing, Model) and name in thing.model_fields):
                yield from _arguments(f"{path}.{name}", member) if callable(member) else [f"python {path}.{name}"]
    elif callable(thing):
        yield from _arguments(path, thing)


def _arguments(path: str, thing: Any) -> Iterator[str]:
    yield f"python {path}()"
    for one in inspect.signature(thing).parameters.values():
        if one.name not in {"self", "cls"} and one.kind not in {one.VAR_KEYWORD, one.VAR_POSITIONAL}:
            yield f"python {path}({one.name})"
            if one.default is not one.empty:
                yield f"python {path}({one.name}) may be left out"


def field_names() -> Iterator[str]:
    """Fields of the file formats; those that may be left out, and the words that a field takes."""
    for name, model in FORMATS.items():
        for path, field in format_fields(model).items():
            yield f"{name} {path}"
            if not field.required:
                yield f"{name} {path} may be left out"
            yield from (f"{name} {path}: {choice}" for choice in field.choices)


def result_names() -> Iterator[str]:
    """Keys of what ``--json`` prints."""
    for command, schema in result_schema()["$defs"].items():
        yield from (f"json {command}{path}" for path in _keys(schema, ""))


def _keys(schema: Any, path: str) -> Iterator[str]:
    for name, inner in schema.get("properties", {}).items():
        yield f"{path} {name}"
        yield from _keys(inner, f"{path} {name}")
    if isinstance(schema.get("items"), dict):
        yield from _keys(schema["items"], f"{path}[]")


def workbook_names() -> Iterator[str]:
    """Sheets, tables, columns and named figures of the workbooks, in SI and in US units."""
    sheet = table = ""
    for line in output_page("workbook").splitlines():
        if line.startswith("## Sheet: "):
            sheet = line.removeprefix("## Sheet: ")
            yield f"sheet {sheet}"
        elif found := re.match(r"### `(\w+)`", line):
            table = found[1]
            yield f"sheet {sheet}, table {table}"
        elif table and (row := re.match(r"\| (?!column |figure |name |---)(.+?) \| ", line)):
            yield f"table {table}: {row[1]}"


def command_names() -> Iterator[str]:
    """Commands and their options."""
    group: Any = typer.main.get_command(app)
    for name, command in _commands(group, "conveyor"):
        yield f"command {name}"
        for one in command.params:
            yield from (f"command {name} {option}" for option in (*one.opts, *one.secondary_opts) if option[0] == "-")


def _commands(group: Any, path: str) -> Iterator[tuple[str, Any]]:
    for name, command in group.commands.items():
        yield f"{path} {name}", command
        if hasattr(command, "commands"):
            yield from _commands(command, f"{path} {name}")


def today() -> list[str]:
    """Every name of the package as it is, sorted."""
    parts = (python_names, field_names, result_names, workbook_names, command_names)
    return sorted({line for part in parts for line in part()})


def promised() -> list[str]:
    """Every name of the last release."""
    return FILE.read_text(encoding="utf-8").splitlines()


if __name__ == "__main__":
    FILE.write_text("".join(f"{line}\n" for line in today()), encoding="utf-8", newline="\n")
