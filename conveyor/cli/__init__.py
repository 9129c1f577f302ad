"""The command line: the only place that prints and sets exit codes.

0 done; 1 the calculation has no answer; 2 wrong input; 130 stopped by Ctrl-C.
"""

from __future__ import annotations

from conveyor.cli import (  # noqa: F401 each registers its commands
    anchor,
    calibrate,
    compare,
    dynamics,
    new,
    optimise,
    power,
    rubber,
    size,
    study,
    tools,
    verify,
)
from conveyor.cli.app import app
from conveyor.cli.run import main

__all__ = ["app", "main"]
