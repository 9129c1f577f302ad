"""The application, the options its commands share, and how errors become exit codes."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from conveyor.errors import ConveyorError, InputError

# matrices here are small: more BLAS threads than one cost time, and a lot of it on a busy machine
for _threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_threads, "1")

app = typer.Typer(
    name="conveyor",
    help="Belt-conveyor power from the viscoelastic contact of every idler roll.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Spec = Annotated[Path, typer.Argument(help="Conveyor spec: .yaml, .json or .xlsx.", show_default=False)]
Shelves = Annotated[
    list[Path] | None, typer.Option("--shelf", help="Further folder of compound files; may be repeated.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print nothing but errors.")]
Drawing = "to this file (.png, .svg, .pdf)."

_MOST_VALUES = 1000


def main() -> None:
    """Run the command line; errors become one message on stderr and an exit code, never a traceback."""
    try:
        app()
    except InputError as error:
        _fail(error, 2)
    except ConveyorError as error:
        _fail(error, 1)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)


def _fail(error: ConveyorError, code: int) -> None:
    print(f"conveyor: {error}" if code == 1 else str(error), file=sys.stderr)
    sys.exit(code)


def write_text(path: Path, text: str) -> None:
    """Write a text under a temporary name, then rename.

    Raises
    ------
    InputError
        The path cannot be written.
    """
    partial = path.with_name(path.name + ".part")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None


@contextmanager
def progress(what: str, *, silent: bool) -> Iterator[Callable[[int, int], None] | None]:
    """A bar with the time left on stderr, for what takes longer than a second; none where output is piped."""
    if silent or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def values(given: str, option: str, unit: str) -> list[str]:
    """``from:to:step`` or ``a,b,c``, with or without the unit at the end, as texts with the unit.

    Raises
    ------
    InputError
        Anything else, or more than 1000 values.
    """
    body = given.strip().removesuffix(unit).strip()
    try:
        found = _range(body) if ":" in body else [float(part) for part in body.split(",")]
    except ValueError:
        found = []
    if not (0 < len(found) <= _MOST_VALUES and all(map(math.isfinite, found))):
        raise InputError(
            f'{option}: got "{given}", expected from:to:step (at most {_MOST_VALUES} values) or a,b,c in {unit}, '
            'such as "-30:40:5" or "20"'
        )
    return [f"{value:.12g} {unit}" for value in found]


def _range(given: str) -> list[float]:
    """Values of ``from:to:step``, the end included; none where the step leads nowhere or to too many."""
    low, high, step = (float(part) for part in given.split(":"))
    if not (math.isfinite(low + high + step) and step > 0.0 and (high - low) / step <= _MOST_VALUES):
        return []
    return [low + k * step for k in range(math.floor((high - low) / step + 1e-9) + 1)]


def one_of(option: str, given: str, allowed: tuple[str, ...]) -> Any:
    """One of the words an option allows.

    Raises
    ------
    InputError
        Another word.
    """
    if given not in allowed:
        raise InputError(f'{option}: got "{given}", allowed: {", ".join(allowed)}')
    return given
