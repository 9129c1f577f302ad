"""Quantities with units, their kinds, and numbers as text."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from conveyor.units.quantity_kinds import KINDS
from conveyor.units.unit_systems import System

if TYPE_CHECKING:
    from conveyor.units.quantities import *  # noqa: F403
else:

    def __getattr__(name: str) -> Any:
        return getattr(import_module("conveyor.units.quantities"), name)  # pint only where a quantity is read
