"""Matplotlib with its own defaults, whatever the user's settings."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Any, Final

from conveyor.errors import InputError, shorten_text

_START_VARIABLES: Final = ("MPLBACKEND", "MATPLOTLIBRC", "MPLCONFIGDIR")
"""Environment variables that matplotlib reads at start."""
_PROCESS_SETTINGS: Final = (
    "backend",
    "interactive",
    "toolbar",
    "timezone",
    "date.epoch",
    "figure.hooks",
    "keymap",
    "webagg",
)
"""Prefixes of settings that do not affect the look of a figure."""
_DATE_VARIABLE: Final = "SOURCE_DATE_EPOCH"
_LAST_DATE: Final = 253_402_300_799  # the end of the year 9999, the last that a date can have
_FIGURE_LOCK = RLock()


def load_matplotlib() -> Any:
    """Import matplotlib.

    Raises
    ------
    InputError
        Settings of the user keep it from being loaded; the message names the variables.
    """
    try:
        import matplotlib as mpl
    except (ValueError, OSError) as error:
        given = [f'{name}="{shorten_text(os.environ[name])}"' for name in _START_VARIABLES if name in os.environ]
        variables = ", ".join(given) or f"none of {', '.join(_START_VARIABLES)} is set"
        said = str(error).partition(";")[0].splitlines()[0]
        raise InputError(
            f"figures: matplotlib does not start with its settings here ({shorten_text(said, 200)}): correct its "
            f"matplotlibrc, or correct or unset the variable ({variables})"
        ) from None
    return mpl


@contextmanager
def own_settings(**more: object) -> Iterator[None]:
    """Matplotlib's defaults and further settings, for one figure at a time, as settings are global.

    Also a decorator of functions that make a figure: texts take their font and the use of TeX when they are made.

    Parameters
    ----------
    more : object
        Settings by name, a dot written as two underscores.

    Raises
    ------
    InputError
        Settings of the user keep matplotlib from being loaded.
    """
    mpl = load_matplotlib()
    with _FIGURE_LOCK:
        own = {
            name: value
            for name, value in mpl.rcParamsDefault.items()
            if not name.startswith(_PROCESS_SETTINGS) and mpl.rcParams[name] != value
        }
        with mpl.rc_context(own | {name.replace("__", "."): value for name, value in more.items()}):
            yield


def refuse_wrong_date() -> None:
    """Refuse an invalid SOURCE_DATE_EPOCH: matplotlib reads it for PDF and SVG.

    Raises
    ------
    InputError
        The variable is not a number of seconds since 1970.
    """
    given = os.environ.get(_DATE_VARIABLE, "")
    if given and not (given.isascii() and given.isdecimal() and int(given) <= _LAST_DATE):
        raise InputError(
            f'{_DATE_VARIABLE}="{shorten_text(given)}": expected whole seconds since 1970, as in "1700000000"; '
            f"correct or unset it"
        )
