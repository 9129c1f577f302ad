"""The command line: the only place that prints and sets exit codes.

0 done; 1 the calculation has no answer; 2 wrong input; 130 stopped by Ctrl-C.
"""

from __future__ import annotations

import gc

gc.set_threshold(100_000)  # imports create hardly any garbage: collections took 7 % of a short command

from conveyor.cli import (  # noqa: E402, F401 each registers its commands
    anchor_command,
    calibrate_command,
    compare_command,
    desk_command,
    doctor_command,
    dynamics_command,
    library_command,
    new_command,
    optimise_command,
    power_command,
    rubber_commands,
    size_command,
    study_command,
    tool_commands,
    verify_sheet_command,
)
from conveyor.cli.application import app  # noqa: E402
from conveyor.cli.entry_point import main  # noqa: E402

__all__ = ["app", "main"]
