"""`conveyor library`: makers' lists of the user's, beside the libraries of the package."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from conveyor.cli.application import (
    AsJson,
    Force,
    Quiet,
    app,
    argument,
    examples_text,
    option,
    print_json,
    print_lines,
)
from conveyor.cli.output_files import Outputs
from conveyor.errors import InputError
from conveyor.files.output_marks import TO_FILL_IN

library = typer.Typer(
    rich_markup_mode=None,
    short_help="Makers' lists of rolls, belts, pulleys and drive parts.",
    help="Keep makers' lists, whose items specs name with `listed`.",
)
app.add_typer(library, name="library")

ListName = Annotated[str, argument("Name of a kept list: that of its file, without .yaml.", "NAME", show_default=False)]
Personal = Annotated[
    bool, option("The one in the home folder (or CONVEYOR_LIBRARY), not in the project.", None, "--personal")
]


@library.command(
    short_help="Write the empty form of a maker's list.", epilog=examples_text("conveyor library template rolls.xlsx")
)
def template(
    output: Annotated[Path, argument("Workbook to write (.xlsx).", show_default=False)],
    force: Force = False,
    quiet: Quiet = False,
) -> None:
    """Write the empty form of a maker's list: a sheet for each kind, every column with its unit and meaning."""
    to = Outputs(force=force)
    to.file("OUTPUT", output, ".xlsx", kind=TO_FILL_IN)
    from conveyor.starter.maker_list_form import maker_list_form

    to.add("form", output, {output: maker_list_form()})
    lines = to.save()
    if not quiet:
        print_lines(*lines, f"next: conveyor library add {output}")


@library.command(
    name="add",
    short_help="Read a maker's list and keep its items.",
    epilog=examples_text("conveyor library add rolls.xlsx", "conveyor library add rolls.xlsx --personal"),
)
def add_lists(
    lists: Annotated[list[Path], argument("Workbooks to read (.xlsx).", "LIST...", show_default=False)],
    personal: Annotated[
        bool, option("Keep them in the home folder (or CONVEYOR_LIBRARY), not in the project.", None, "--personal")
    ] = False,
    quiet: Quiet = False,
) -> None:
    """Read makers' lists, check every row, and keep the items where specs find them.

    They go into the folder conveyor-library of the project, which is the nearest one here or above, else a new one
    here; put it under version control. A list that is added again replaces its items; before a new edition under
    another name, remove the old one.
    """
    from conveyor.forms.maker_list_reader import add_maker_list
    from conveyor.models.maker_lists import FOLDER, personal_folders, project_folder

    folder = personal_folders()[0] if personal else project_folder(Path()) or Path(FOLDER)
    for each in lists:
        written = add_maker_list(each, folder)
        if not quiet:
            print_lines(f"library: {written}")


@library.command(
    name="list",
    short_help="List the items of makers' lists found from here.",
    epilog=examples_text("conveyor library list", "conveyor library list --json | jq .[].name"),
)
def list_items(as_json: AsJson = False) -> None:
    """List the items that specs of this folder find, with kind, source and file."""
    from conveyor.models.maker_lists import library_folders, maker_items

    items = maker_items(Path())
    if as_json:
        print_json([{**item.as_data(), "file": str(path)} for item, path in items])
        return
    if not items:
        folders = ", ".join(map(str, library_folders(Path()))) or "no folder conveyor-library here, above or at home"
        print_lines(f"no items ({folders}); conveyor library add LIST.xlsx reads a maker's list")
        return
    widths = [max(len(item.kind) for item, _ in items), max(len(item.name) for item, _ in items)]
    for item, path in items:
        print_lines(f"{item.kind:{widths[0]}}  {item.name:{widths[1]}}  {item.source}  ({path})")


@library.command(
    name="show",
    short_help="Show a kept list, or one item of it.",
    epilog=examples_text("conveyor library show rolls", 'conveyor library show rolls "R108-315"'),
)
def show_items(
    name: ListName,
    item: Annotated[
        str | None, argument("Name of an item; without it all of the list.", "ITEM", show_default=False)
    ] = None,
    personal: Personal = False,
    as_json: AsJson = False,
) -> None:
    """Show what a kept list says of its items: every value, source and note."""
    from conveyor.files.libraries import flatten_fields
    from conveyor.models.maker_lists import MakerList, list_file, named_items
    from conveyor.models.model_file import read_model

    path = list_file(Path(), name, personal=personal)
    shown = named_items(read_model(MakerList, path), path, item)
    if as_json:
        print_json([{**one.as_data(), "file": str(path)} for one in shown])
        return
    for one in shown:
        print_lines(f"{one.one} {one.name}  ({path})")
        about = {**flatten_fields(one.fields), "source": one.source} | ({"note": one.note} if one.note else {})
        width = max(map(len, about))
        print_lines(*(f"  {field:{width}}  {value}" for field, value in about.items()))


@library.command(
    name="remove",
    short_help="Remove a kept list.",
    epilog=examples_text("conveyor library remove rolls", "conveyor library remove rolls-2025 --yes"),
)
def remove_list(
    name: ListName,
    personal: Personal = False,
    yes: Annotated[bool, option("Remove it without a question.", None, "--yes")] = False,
    quiet: Quiet = False,
) -> None:
    """Remove a kept list with all its items; the maker's workbook stays, and specs that hold its items too."""
    from conveyor.models.maker_lists import list_file

    path = list_file(Path(), name, personal=personal)
    if not yes and not sys.stdin.isatty():
        raise InputError(f"{path}: nobody is there to ask whether to remove it; say --yes")
    if not yes and not typer.confirm(f"remove {path} with all its items?"):
        print_lines("nothing was removed")
        return
    path.unlink()
    if not quiet:
        print_lines(f"library: removed {path}")
