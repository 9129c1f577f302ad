"""Scenarios that several tests follow, and their checks."""

from __future__ import annotations

from conveyor.dynamics.criteria import DYNAMICS_CRITERIA
from tests.loop.loop_lines import DATA, TAIL_DRIVE, line
from tests.validation.test_start_stop_limits import MASSES, NO_RUSH, followed

START = {"begins": "at rest", "events": [{"do": "start"}], "duration": "6 s"}
TAUT = {"feeding": NO_RUSH, "take_up": {"kind": "gravity", "tension": "60 kN"}}


def checks_of_one(found):
    return [check for criterion in DYNAMICS_CRITERIA for check in criterion(found)]


def slipping_late(step):
    """A light drive at the tail that is switched on at once, while the head's has begun to pull."""
    late = TAIL_DRIVE | {"reduced_mass": "1 kg", "installed_power": "2000 kW",
                         "starter": {"kind": "direct", "delay": "2 s"}}  # fmt: skip
    drive = DATA["drive"] | MASSES | {"starter": {"time": "20 s"}, "further_drives": [late]}
    return followed(line(drive=drive, route=TAUT), START | {"duration": "3 s"}, step=step)
