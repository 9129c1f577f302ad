"""The application, the options its commands share, and how they read and write."""

from __future__ import annotations

import json
import math
import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from enum import StrEnum
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any

import typer
import typer.core

from conveyor.errors import InputError, NoSolutionError
from conveyor.files.compound_folders import compound_files
from conveyor.languages import Language
from conveyor.text.printable import escape_controls, escape_json_controls
from conveyor.text.ranges import MOST_VALUES, range_values
from conveyor.units.unit_systems import SYSTEMS

if TYPE_CHECKING:
    from conveyor.models import Conveyor

# matrices are small: more than one BLAS thread costs time, most on a busy machine
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")


def examples_text(*commands: str) -> str:
    """Examples for the end of a command's help, one a line."""
    return "\b\nExamples:\n" + "\n".join(f"  {command}" for command in commands)


def option(words: str, metavar: str | None = None, *names: str, **more: Any) -> Any:
    """Typer option: help, metavar, names if not those of the parameter."""
    return typer.Option(*names, metavar=metavar, help=words, case_sensitive=False, **more)


def argument(words: str, metavar: str | None = None, **more: Any) -> Any:
    """Typer argument: help, metavar."""
    return typer.Argument(metavar=metavar, help=words, **more)


if TYPE_CHECKING:
    from typing import TypeAlias

    Units: TypeAlias = StrEnum
else:
    Units = StrEnum("Units", {name: name for name in SYSTEMS})


class _CommandGroup(typer.core.TyperGroup):
    """Command group with a fixed order of commands."""

    def list_commands(self, ctx: Any) -> list[str]:
        return sorted(
            super().list_commands(ctx),
            key=lambda name: COMMAND_ORDER.index(name) if name in COMMAND_ORDER else len(COMMAND_ORDER),
        )


COMMAND_ORDER = (
    "new", "desk", "size", "power", "compare", "study", "optimise", "dynamics", "calibrate", "template", "fit",
    "anchor", "shelf", "library",
    "verify-sheet", "contact", "validate", "schema", "doctor",
)  # fmt: skip

app = typer.Typer(
    name="conveyor",
    cls=_CommandGroup,
    add_completion=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help: importing rich would take a third of its time
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=examples_text(
        "conveyor new mine.yaml",
        "conveyor power mine.yaml",
        "conveyor power mine.yaml -o report.xlsx -o report.pdf",
        "conveyor power --help",
        "conveyor --install-completion",
    )
    + "\n\nExit codes: 0 done, 1 the calculation has no answer, 2 wrong input, 130 stopped by Ctrl-C.",
)


def _show_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"conveyor {version('conveyor')}")
        raise typer.Exit


@app.callback(help="Belt-conveyor power from the viscoelastic contact of every idler roll.")
def _common_options(
    _version: Annotated[
        bool,
        typer.Option("--version", help="Show the version and exit.", callback=_show_version, is_eager=True),
    ] = False,
) -> None:
    """Options that belong to no command."""


class ImageKind(StrEnum):
    """Formats of figures."""

    PNG = "png"
    SVG = "svg"
    PDF = "pdf"


Spec = Annotated[Path, argument("Conveyor spec: .yaml, .json or .xlsx.", "SPEC", show_default=False)]
Reports = Annotated[
    list[Path] | None,
    option(
        "Write the report: workbook (.xlsx), web page (.html) or PDF (.pdf); may be repeated.", "FILE", "-o", "--output"
    ),
]
TablesFolder = Annotated[Path | None, option("Folder for the tables, one file each.", "FOLDER", "--tables")]
PlotsFolder = Annotated[Path | None, option("Draw every figure into it.", "FOLDER", "--plots")]
PlotKind = Annotated[ImageKind, option("Format of the figures.", None, "--plot-kind")]
AsParquet = Annotated[bool, option("Tables as Parquet files; without it as CSV.", None, "--parquet")]
Shelves = Annotated[
    list[Path] | None, option("Additional folder of compound files; may be repeated.", "FOLDER", "--shelf")
]
FieldChanges = Annotated[
    list[str] | None,
    option(
        'Change a field of the spec, as in --set "belt.speed=5.5 m/s" or --set "drive.listed=[M315, G20]"; may be '
        "repeated.",
        "FIELD=VALUE",
        "--set",
    ),
]
AsJson = Annotated[bool, option("Print one JSON object on stdout and nothing else.", None, "--json")]
UnitsOption = Annotated[
    Units | None,
    option(
        "Units of the output; else report.units of the spec. Figures of JSON are always SI.",
        None,
        "--units",
        show_default=False,
    ),
]
LanguageOption = Annotated[
    Language | None,
    option(
        "Language of page, PDF and workbook; else report.language of the spec. Other files and JSON are English.",
        None,
        "--language",
        show_default=False,
    ),
]
Force = Annotated[
    bool,
    option(
        "Replace any existing file; without it only what conveyor wrote, unedited. Input files are never overwritten.",
        None,
        "--force",
        "-f",
    ),
]
Quiet = Annotated[bool, option("Print nothing but errors.", None, "--quiet", "-q")]
Drawing = "to this file (.png, .svg, .pdf)."

Progress = Callable[..., None]
"""Callback with the name of a task, steps done, steps in all, and a note."""
_ASSIGNMENT = re.compile(r"\s*([^=]+?)\s*=\s*(.*?)\s*", re.DOTALL)
_BAR_DELAY = 1.0  # seconds before a bar appears


def compound_names(context: typer.Context, incomplete: str) -> list[str]:
    """Completions of a shelf name, including the folders of --shelf."""
    given = context.params.get("shelf") or context.params.get("shelves") or ()
    try:
        known = compound_files(given)
    except InputError:
        return []
    return sorted(name for name in known if name.startswith(incomplete.casefold()))


def read_spec(path: Path, shelves: list[Path] | None, changed: list[str] | None = None) -> Conveyor:
    """Read the conveyor of a spec and change fields by `FIELD=VALUE`."""
    import conveyor
    from conveyor import shelf
    from conveyor.models.fields import with_fields

    line = conveyor.load(path, shelves=shelves or ())
    changes: dict[str, Any] = {}
    refused: list[str] = []
    for given in changed or ():
        parts = _ASSIGNMENT.fullmatch(given)
        if parts is None:
            refused.append(f'--set: got "{given}", expected FIELD=VALUE, as in "belt.speed=5.5 m/s"')
        elif parts[1] in changes:
            refused.append(f"--set: {parts[1]} is given twice")
        else:
            changes[parts[1]] = _parse_value(parts[2])
    try:
        line = with_fields(line, changes, resolve=shelf.resolver(extra=shelves or (), base=path.parent))
    except InputError as error:
        refused += [f"--set {said}" for said in str(error).splitlines()]
    if refused:
        raise InputError("\n".join(refused))
    return line


def _parse_value(written: str) -> Any:
    """JSON number, true, false or list, or a list as in YAML; else text."""
    try:
        return json.loads(written)
    except ValueError:
        if not written.startswith("["):
            return written
    from conveyor.files.document import parse_document

    try:
        return parse_document(f"value: {written}", Path("set.yaml")).data["value"]
    except InputError:
        return written  # refused at its field


class StudyStop(Exception):  # noqa: N818 no fault of anybody
    """A study was stopped by Ctrl-C; its message says what is kept."""


def print_json(data: object) -> None:
    """Print one JSON object in UTF-8, whatever the terminal's encoding: RFC 8259, section 8.1."""
    print_text(json_text(data))


def json_text(data: object) -> str:
    """JSON of a result."""
    try:
        written = json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False)
    except ValueError:
        raise NoSolutionError("the result holds figures that are not finite: look for extreme inputs") from None
    return escape_json_controls(written) + "\n"


def print_text(text: str) -> None:
    """Print text for programs, in UTF-8 whatever the terminal's encoding."""
    with suppress(AttributeError):  # streams of tests cannot be reconfigured
        sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    print(text, end="")


def print_lines(*lines: str) -> None:
    """Print lines for people."""
    print(escape_controls("\n".join(lines)))


@contextmanager
def progress_bar(what: str = "", *, silent: bool) -> Iterator[Progress | None]:
    """Progress bar on stderr after one second; none where output is piped.

    Yields a callback with the name of the task (unless `what` is given), steps done, steps in all, and a note.
    """
    if silent or not sys.stderr.isatty():
        yield None
        return
    begun = perf_counter()
    with ExitStack() as stack:
        bars: dict[str, Any] = {}

        def told(what: str, done: int, whole: int, note: str = "") -> None:
            if not bars and perf_counter() - begun < _BAR_DELAY:
                return
            if not bars:
                bars[""] = stack.enter_context(_rich_bar())
            if what not in bars:
                bars[what] = bars[""].add_task(what, total=whole, completed=done, note="")
            bars[""].update(bars[what], completed=done, total=whole, note=note)

        yield partial(told, what) if what else told


def _rich_bar() -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, TextColumn("{task.fields[note]}"), console=Console(stderr=True), transient=True)


def parse_values(given: str, option: str, *units: str) -> list[str]:
    """Values of ``from:to:step`` or ``a,b,c`` as texts with a unit: the one at the end, else the first allowed."""
    unit = next((known for known in units if given.strip().endswith(known)), units[0])
    body = given.strip().removesuffix(unit).strip()
    try:
        numbers = range_values(body) if ":" in body else [float(part) for part in body.split(",")]
    except ValueError:
        numbers = []
    if not (0 < len(numbers) <= MOST_VALUES and all(map(math.isfinite, numbers))):
        allowed = " or ".join(units)
        raise InputError(
            f'{option}: got "{given}", expected from:to:step (at most {MOST_VALUES} values) or a,b,c in {allowed}, '
            'such as "-30:40:5" or "20"'
        )
    return [f"{value:.12g} {unit}" for value in numbers]


def si_of(option: str, given: str | None, kind: str) -> float | None:
    """Option value in SI; None where it is not given."""
    from conveyor.units import read_si

    return None if given is None else read_si(given, kind, option)


def one_of(option: str, given: str, allowed: tuple[str, ...]) -> Any:
    """Option value, refused unless it is one of the allowed words."""
    if given not in allowed:
        raise InputError(f'{option}: got "{given}", allowed: {", ".join(allowed)}')
    return given
