"""`conveyor desk`: a design on the screen, changed by hand and calculated at once."""

from __future__ import annotations

import webbrowser
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

from conveyor.cli.application import Quiet, Shelves, app, argument, examples_text, option, print_lines
from conveyor.errors import InputError

_PORT = 8765


@app.command(
    short_help="Change a design in the browser and see the figures at once.",
    epilog=examples_text(
        "conveyor desk overland.yaml",
        "conveyor desk overland.yaml downhill.yaml --shelf my-compounds",
        "conveyor desk",
    ),
)
def desk(
    specs: Annotated[
        list[Path] | None, argument("Specs (.yaml, .json, .xlsx); without one, the page offers new ones.", "SPEC")
    ] = None,
    port: Annotated[int, option("Port on this machine; another where it is taken.", "N", min=1024, max=65535)] = _PORT,
    no_browser: Annotated[bool, option("Print the address, open no browser.", None, "--no-browser")] = False,
    quiet: Quiet = False,
    shelf: Shelves = None,
) -> None:
    """Change a design in the browser: sliders, every field, variants beside each other; save spec, workbook, PDF.

    It listens on this machine only, and ends with Ctrl-C, or an hour after its last page was closed.
    """
    missing = [package for package in ("starlette", "uvicorn") if find_spec(package) is None]
    if missing:
        raise InputError(f'conveyor desk: needs {" and ".join(missing)}: pip install "conveyor[desk]"')
    from conveyor.desk.desk_server import DeskServer
    from conveyor.desk.workbench import open_workbench

    workbench = open_workbench(specs or (), shelf or ())
    server = DeskServer(workbench, port)
    print_lines(f"desk: {server.guard.address}")
    if not quiet:
        print_lines(f"files are saved in {workbench.folder}; Ctrl-C ends the desk")
    if not no_browser:
        webbrowser.open(server.guard.address)
    with suppress(KeyboardInterrupt):
        server.run()
    if not quiet:
        print_lines(f"the desk has ended; what you saved is in {workbench.folder}")
