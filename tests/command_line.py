"""The command line in this process: what it prints where, and its exit code, without a start of Python for each."""

from __future__ import annotations

import contextlib
import io
import signal
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from conveyor.cli import main

ROOT = Path(__file__).parent.parent
TRACEBACK = -1
"""Exit code of an error that is no message."""


class Done(NamedTuple):
    """What a run left."""

    returncode: int
    stdout: str
    stderr: str


def run(
    *arguments: str | Path,
    cwd: Path = ROOT,
    columns: int = 200,
    spoil: Callable[[pytest.MonkeyPatch], None] | None = None,
) -> Done:
    """Run `conveyor` in a folder on a terminal of some columns, warnings as errors, in a world that may be spoiled."""
    out, err = io.StringIO(), io.StringIO()
    handler = signal.getsignal(signal.SIGPIPE) if hasattr(signal, "SIGPIPE") else None
    with pytest.MonkeyPatch.context() as patched, warnings.catch_warnings():
        warnings.simplefilter("error")
        patched.setattr(warnings, "showwarning", warnings.showwarning)  # the command line replaces it
        patched.chdir(cwd)
        patched.setattr(sys, "argv", ["conveyor", *map(str, arguments)])
        patched.setenv("COLUMNS", str(columns))
        patched.delenv("CONVEYOR_SHELF", raising=False)
        if spoil is not None:
            spoil(patched)
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                main()
            code = 0
        except SystemExit as left:
            code = int(left.code or 0)
        except Exception as error:  # noqa: BLE001 a traceback is an outcome, and a fault
            code = TRACEBACK
            err.write(f"Traceback: {type(error).__name__}: {error}")
        finally:
            if handler is not None:
                signal.signal(signal.SIGPIPE, handler)
    return Done(code, out.getvalue(), err.getvalue())
