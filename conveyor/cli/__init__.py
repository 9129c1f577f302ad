"""The command line: the only place that prints and sets exit codes.

0 done; 1 the calculation has no answer; 2 wrong input; 130 stopped by Ctrl-C.
"""

from __future__ import annotations

from conveyor.cli import anchor, calibrate, compare, dynamics, new, power, rubber, size, study, tools, verify  # noqa: F401 each registers its commands
from conveyor.cli.app import app
from conveyor.cli.run import main

__all__ = ["app", "main"]
