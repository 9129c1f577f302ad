"""Systems of units of reports: how each writes the kinds of quantity that it does not write as SI does."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, Literal

from conveyor.errors import InputError
from conveyor.units.quantity_kinds import KINDS, Shown

Trade = Literal["metric", "US"]
"""Trades by their series of parts, paper and symbols, as starter files list their values."""
TRADES: Final[tuple[Trade, ...]] = ("metric", "US")


@dataclass(frozen=True)
class UnitSystem:
    """A system of units.

    Attributes
    ----------
    trade : {"metric", "US"}
        Whose motors, pulleys, paper, symbols and starter values go with it.
    kinds : dict of str to Shown
        How the kinds are written that are not written as with SI units.
    """

    trade: Trade = "metric"
    kinds: dict[str, Shown] = field(default_factory=dict)

    def shown(self, kind: str) -> Shown:
        """Unit and digits of a kind."""
        return self.kinds.get(kind) or KINDS[kind].si


SYSTEMS: Final[dict[str, UnitSystem]] = {
    "SI": UnitSystem(),
    "US": UnitSystem("US", {
        "length": Shown("ft", ",.1f"), "distance": Shown("ft"), "spacing": Shown("ft", ".2f"),
        "thickness": Shown("in", ".4f"), "size": Shown("in", ",.2f"), "area": Shown("ft^2", ".2f"),
        "speed": Shown("fpm", ",.1f"), "wind": Shown("mph", ".1f"), "acceleration": Shown("ft/s^2", ".2f"),
        "mass": Shown("lb", ",.0f"), "line mass": Shown("lb/ft", ".2f"), "area mass": Shown("lb/ft^2", ".4f"),
        "belt mass": Shown("lb/ft^2"), "set mass": Shown("lb"), "density": Shown("lb/ft^3", ",.1f"),
        "force": Shown("lbf", ",.0f"), "roll force": Shown("lbf", ",.2f"), "line force": Shown("lbf/in", ",.4f"),
        "strength": Shown("lbf/in", ",.1f"), "belt strength": Shown("lbf/in", ",.0f"),
        "belt rating": Shown("PIW", ",.1f"), "spring rate": Shown("lbf/in"), "pressure": Shown("psi", ",.1f"),
        "moment": Shown("lbf*in"), "torque": Shown("lbf*ft", ",.0f"), "inertia": Shown("lb*ft^2", ",.1f"),
        "bending stiffness": Shown("lbf*in^2"), "viscosity": Shown("cSt"), "temperature": Shown("degF", ".1f"),
        "temperature difference": Shown("delta_degF"), "rise": Shown("Δ°F", ",.0f"), "warming": Shown("Δ°F", ".2f"),
        "mass flow": Shown("stph", ",.1f"), "volume flow": Shown("ft^3/min"), "carryback": Shown("lb/h", ",.1f"),
        "conveyed": Shown("short ton", ",.0f"), "carbon dioxide": Shown("metric ton", ",.0f"),
        "power": Shown("hp", ",.1f"), "specific energy": Shown("kWh/(short ton mile)", ".4f"),
    }),
}  # fmt: skip
"""Every system by its name."""

if TYPE_CHECKING:
    from typing import TypeAlias

    System: TypeAlias = str
else:
    System = Literal[tuple(SYSTEMS)]


def trade_of(system: System) -> Trade:
    """Trade that a system of units goes with."""
    return SYSTEMS[system].trade


def report_system(own: System, system: System | None) -> System:
    """Return the system of units of a report: the given one, else the spec's own.

    Raises
    ------
    InputError
        Not one of the systems.
    """
    if system is not None and system not in SYSTEMS:
        raise InputError(f'system = "{system}": {" or ".join(SYSTEMS)}, or none for that of the spec (report.units)')
    return system or own
