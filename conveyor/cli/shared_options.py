"""Options shared by the commands that calculate, and how these read, write and answer."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_type_hints

from conveyor.cli.application import (
    AsJson,
    FieldChanges,
    Force,
    LanguageOption,
    Progress,
    Quiet,
    Shelves,
    UnitsOption,
    app,
    examples_text,
    json_text,
    print_lines,
    print_text,
    progress_bar,
    read_spec,
)
from conveyor.cli.output_files import Outputs

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from conveyor.models import Conveyor
    from conveyor.models.sizing import SizingDuty
    from conveyor.units import System


@dataclass(frozen=True)
class Session:
    """Values of the shared options."""

    units: UnitsOption = None
    language: LanguageOption = None
    force: Force = False
    as_json: AsJson = False
    quiet: Quiet = False
    shelf: Shelves = None
    changed: FieldChanges = None

    def outputs(self, *inputs: str | Path | None) -> Outputs:
        """Output files of a command with these inputs."""
        return Outputs(*inputs, force=self.force, language=self.language)

    def read(self, spec: Path) -> Conveyor:
        """Read the conveyor of a spec and change its fields by --set."""
        return read_spec(spec, self.shelf, self.changed)

    def system(self, line: Conveyor | SizingDuty | None = None) -> System:
        """Units of the output: of --units, else of the spec, else SI."""
        if self.units is not None:
            return self.units.value
        return "SI" if line is None else line.report.units

    def progress(self, what: str = "") -> AbstractContextManager[Progress | None]:
        """Progress bar on stderr; none with --quiet or --json."""
        return progress_bar(what, silent=self.quiet or self.as_json)

    def answer(self, figures: Callable[[], object], to: Outputs, show: Callable[[], None]) -> None:
        """Write the files, then print the figures as JSON, or as tables with the names of the files."""
        text = json_text(figures()) if self.as_json else ""
        written = to.save()
        if self.as_json:
            print_text(text)
        elif not self.quiet:
            show()
            if written:
                print_lines("", *written)


def session_command(
    name: str | None = None, *, short_help: str, examples_of: tuple[str, ...], without: tuple[str, ...] = ()
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Register a command whose first parameter is a session; the shared options follow its own.

    Parameters
    ----------
    name : str, optional
        Command name; else that of the function.
    short_help : str
        Help in the list of commands.
    examples_of : tuple of str
        Examples below its help.
    without : tuple of str
        Shared options that it does not have.
    """

    def add(function: Callable[..., None]) -> Callable[..., None]:
        hints = get_type_hints(function, include_extras=True)
        asked = get_type_hints(Session, include_extras=True)
        _, *own = signature(function).parameters.values()
        shared = [
            Parameter(field.name, Parameter.KEYWORD_ONLY, default=field.default, annotation=asked[field.name])
            for field in dataclasses.fields(Session)
            if field.name not in without
        ]

        @wraps(function)
        def called(**given: Any) -> None:
            of_session = {one.name: given.pop(one.name) for one in shared}
            function(Session(**of_session), **given)

        parameters = [
            *(each.replace(annotation=hints[each.name], kind=Parameter.KEYWORD_ONLY) for each in own),
            *shared,
        ]
        called.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
        called.__annotations__ = {each.name: each.annotation for each in parameters}
        return app.command(name, short_help=short_help, epilog=examples_text(*examples_of))(called)

    return add
