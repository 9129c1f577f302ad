"""`conveyor desk`: a design on the screen, changed by hand and calculated at once."""

from __future__ import annotations

import os
import sys
import webbrowser
from contextlib import suppress
from getpass import getpass
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

from conveyor.cli.application import Quiet, Shelves, app, argument, examples_text, option, print_lines
from conveyor.errors import InputError
from conveyor.files.file_bytes import file_content

_PORT = 8765
_VARIABLE = "CONVEYOR_DESK_PASSWORD"
"""Environment variable with the password."""
_SHORTEST_PASSWORD = 12
_LARGEST_FILE = 4096  # bytes of a file with a password


@app.command(
    short_help="Change a design in the browser and see the figures at once.",
    epilog=examples_text(
        "conveyor desk overland.yaml",
        "conveyor desk overland.yaml downhill.yaml --shelf my-compounds",
        "conveyor desk overland.yaml --host 192.168.1.20 --password-file desk-password.txt",
        "conveyor desk",
    ),
)
def desk(
    specs: Annotated[
        list[Path] | None, argument("Specs (.yaml, .json, .xlsx); without one, the page offers new ones.", "SPEC")
    ] = None,
    port: Annotated[int, option("Port on this machine; another where it is taken.", "N", min=1024, max=65535)] = _PORT,
    host: Annotated[
        str | None,
        option("Address of this machine that others reach; needs a password.", "ADDRESS"),
    ] = None,
    password_file: Annotated[Path | None, option("File with the password for --host.", "FILE")] = None,
    no_browser: Annotated[bool, option("Print the address, open no browser.", None, "--no-browser")] = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Change a design in the browser: sliders, every field, variants beside each other; save spec, workbook, PDF.

    It listens on this machine only, and ends with Ctrl-C, or an hour after its last page was closed. With --host others
    open it with a password: that of --password-file, of CONVEYOR_DESK_PASSWORD, else it is asked for.
    """
    missing = [package for package in ("starlette", "uvicorn") if find_spec(package) is None]
    if missing:
        raise InputError(f'conveyor desk: needs {" and ".join(missing)}: pip install "conveyor[desk]"')
    from conveyor.desk.desk_server import DeskServer
    from conveyor.desk.request_guard import LOOPBACK
    from conveyor.desk.workbench import open_workbench

    if host is None and password_file is not None:
        raise InputError("--password-file: only --host needs a password")
    password = None if host is None else _read_password(password_file)
    workbench = open_workbench(specs or (), shelf or ())
    server = DeskServer(workbench, port, host=host or LOOPBACK, password=password)
    print_lines(f"desk: {server.guard.address}")
    if host is not None:
        print_lines(
            f"others: http://{host}:{server.port}/ with the password; who has it calculates on this machine, reads and "
            f"saves specs in {workbench.folder}, until the desk ends. Nothing is encrypted: on a net that you trust"
        )
    if not quiet:
        print_lines(f"files are saved in {workbench.folder}; Ctrl-C ends the desk")
    if not no_browser:
        webbrowser.open(server.guard.address)
    with suppress(KeyboardInterrupt):
        server.run()
    if not quiet:
        print_lines(f"the desk has ended; what you saved is in {workbench.folder}")


def _read_password(file: Path | None) -> str:
    """Password from a file, else from the environment, else asked for twice."""
    if file is not None:
        content = file_content(file, largest=_LARGEST_FILE, expected="a line with the password")
        where, password = str(file), content.decode(errors="replace").strip()
    elif _VARIABLE in os.environ:
        where, password = _VARIABLE, os.environ[_VARIABLE]
    elif sys.stdin.isatty():
        where, password = "password", getpass("password for others: ")
        if getpass("again: ") != password:
            raise InputError("password: the two differ")
    else:
        raise InputError(f"--host: needs a password: --password-file FILE, or {_VARIABLE} in the environment")
    if len(password) < _SHORTEST_PASSWORD:
        raise InputError(f"{where}: a password of at least {_SHORTEST_PASSWORD} characters, got {len(password)}")
    return password
