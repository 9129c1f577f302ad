"""Entry point: exit codes, and one message on stderr for an error."""

from __future__ import annotations

import difflib
import io
import logging
import os
import re
import signal
import sys
import warnings
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, NoReturn, TextIO

import typer

from conveyor.cli.application import StudyStop, app
from conveyor.errors import ConveyorError, InputError
from conveyor.report.matplotlib_settings import refuse_wrong_date
from conveyor.text.printable import escape_controls

EXIT_DONE: Final = 0
EXIT_NO_SOLUTION: Final = 1
EXIT_WRONG_INPUT: Final = 2
EXIT_INTERRUPTED: Final = 130
"""128 + SIGINT, as shells give it."""
_RESUMABLE_COMMANDS: Final = (["study"], ["optimise"])
"""Commands that keep what they have calculated when they are stopped."""

_UsageError: type[Exception] = next(t for t in typer.BadParameter.__mro__ if t.__name__ == "UsageError")
_REPORT_OPTIONS: Final = ("--xlsx", "--html", "--pdf")
"""Options that people try; the ending of --output says what a report is."""
_SPEC_ENDINGS: Final = (".yaml", ".yml", ".json", ".xlsx")
_PARSER_MESSAGES: Final = {
    "Input should be a valid number.*": "expected a number",
    "Input should be a valid integer.*": "expected a whole number",
}
"""Messages of typer's parsers, and plainer ones."""


def main() -> None:
    """Run the command line; errors become one message on stderr and an exit code, never a traceback."""
    _set_up_streams()
    try:
        refuse_wrong_date()  # scipy fails on it as it is imported
        code = app(None if sys.argv[1:] else ["--help"], prog_name="conveyor", standalone_mode=False)
        sys.stdout.flush()
    except InputError as error:
        _exit_with(str(error), EXIT_WRONG_INPUT)
    except ConveyorError as error:
        _exit_with(f"conveyor: {error}", EXIT_NO_SOLUTION)
    except _UsageError as error:
        _exit_with(usage_message(error), EXIT_WRONG_INPUT)
    except StudyStop as stop:
        _exit_with(f"conveyor: stopped by Ctrl-C; {stop}", EXIT_INTERRUPTED)
    except (KeyboardInterrupt, typer.Abort):
        code = EXIT_INTERRUPTED
    except MemoryError:
        _exit_with(
            "conveyor: this machine has no memory left for it; close other programs, or ask for less at once "
            "(shorter ranges, fewer samples or sections, fewer --workers)",
            EXIT_NO_SOLUTION,
        )
    except OSError as error:
        _discard_output()
        _exit_with(f"conveyor: {error.filename or 'output'}: {error.strerror or error}", EXIT_WRONG_INPUT)
    if code == EXIT_INTERRUPTED:
        kept = "; nothing was finished yet" if sys.argv[1:2] in _RESUMABLE_COMMANDS else ""
        _exit_with(f"conveyor: stopped by Ctrl-C{kept}", EXIT_INTERRUPTED)
    sys.exit(code if isinstance(code, int) else EXIT_DONE)


def _set_up_streams() -> None:
    """End silently where the reader of a pipe goes away; escape characters that a terminal cannot show.

    Streams that were closed at the start are opened on the null device, so that no other file takes their number. An
    unbuffered stdout (PYTHONUNBUFFERED) gets a buffer: without one Python drops, without a word, what a file that may
    not grow did not take.
    """
    sys.stdout = sys.stdout or _null_stream(os.O_RDONLY)
    if isinstance(getattr(sys.stdout, "buffer", None), io.RawIOBase):
        sys.stdout = open(  # noqa: SIM115 kept open as streams are
            sys.stdout.fileno(), "w", buffering=1, encoding=sys.stdout.encoding, closefd=False
        )
    sys.stderr = sys.stderr or _null_stream(os.O_WRONLY)
    if hasattr(signal, "SIGPIPE"):
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError):  # streams of tests cannot be reconfigured
            stream.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    warnings.showwarning = _show_warning
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # warnings about caches it cannot write


def _null_stream(mode: int) -> TextIO:
    return open(os.open(os.devnull, mode), "w", encoding="utf-8")  # noqa: PTH123 kept open as streams are


def _show_warning(
    message: Warning | str,
    category: type[Warning],  # noqa: ARG001 the signature of warnings.showwarning
    filename: str,  # noqa: ARG001
    lineno: int,  # noqa: ARG001
    file: TextIO | None = None,  # noqa: ARG001
    line: str | None = None,  # noqa: ARG001
) -> None:
    print(f"note: {escape_controls(str(message))}", file=sys.stderr)


def _exit_with(message: str, code: int) -> NoReturn:
    try:
        sys.stdout.flush()  # what was printed before the message
    except OSError:
        _discard_output()
    print(escape_controls(message), file=sys.stderr)
    sys.exit(code)


def _discard_output() -> None:
    """Discard buffered output: the interpreter would fail on it again as it ends."""
    with (
        suppress(OSError, ValueError),
        Path(os.devnull).open("wb") as nowhere,
    ):  # streams of tests have no file
        os.dup2(nowhere.fileno(), sys.stdout.fileno())


def usage_message(error: Any) -> str:
    """One-line message for a usage error: the error, a suggestion, the help command."""
    context = error.ctx
    said = str(error.message if getattr(error, "possibilities", None) else error.format_message()).rstrip(".")
    said = said.replace("Value error, ", "")
    for parser, plain in _PARSER_MESSAGES.items():
        said = re.sub(parser, plain, said)
    guess = _closest_option(error, said)
    path = "conveyor" if context is None else context.command_path
    return f"{path}: {said[:1].lower()}{said[1:]}{guess} (see {path} --help)"


def _closest_option(error: Any, said: str) -> str:
    if error.ctx is None or "did you mean" in said.lower():
        return ""
    given = getattr(error, "option_name", None)
    if given is not None:
        known = [name for parameter in error.ctx.command.params for name in parameter.opts if name.startswith("--")]
        if str(given) in _REPORT_OPTIONS and "--output" in known:
            return f"; give a name that ends so: -o report.{str(given).lstrip('-')}"
        near = difflib.get_close_matches(str(given), [*known, "--help"], n=1)
        return f"; did you mean {near[0]}?" if near else ""
    quoted = re.fullmatch(r"No such command '(.*)'", said)
    if quoted is not None and Path(quoted[1]).suffix.lower() in _SPEC_ENDINGS:
        return f"; to calculate it: conveyor power {quoted[1]}"
    return ""
