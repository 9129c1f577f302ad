"""Confined cover against the belt itself: what the give changes over tension, spacing, cover and carcass.

python benchmarks/belt_support.py

S100 at 20 °C on rolls of 159 mm at 5 m/s; one figure varied at a time, the others 100 kN/m, 1.2 m, covers of 6 and
6 mm, D 15 N m, K 100 MN/m, no loss in the carcass. Prints the friction on a stiff carcass and its change, in per cent.
"""

from __future__ import annotations

from dataclasses import replace

from conveyor.indentation import Backing, RollContact, indentation_curves
from conveyor.shelf import compound

LOADS = (0.5e3, 1e3, 2e3, 4e3, 6e3)
RTOL = 1e-5
VARIED = {
    "tension [kN/m]": ("tension", 1e3, (10, 20, 50, 100, 200, 400)),
    "bending stiffness [N m]": ("bending", 1.0, (0, 5, 15, 50, 200)),
    "carcass tan δ [-]": ("bending_loss", 1.0, (0, 0.1, 0.3)),
    "in-plane stiffness [MN/m]": ("stretching", 1e6, (1, 10, 100, 1000)),
    "other cover [mm]": ("cover_thickness", 1e-3, (2, 6, 15)),
    "cover on the rolls [mm]": ("own", 1e-3, (2, 4, 6, 10, 15)),
    "spacing [m]": ("spacing", 1.0, (0.6, 1.0, 1.2, 2.0, 4.0)),
}


def main() -> None:
    """Print the table."""
    rubber = compound("s100").series(293.15)
    behind = Backing(100e3, 15.0, 0.0, 100e6, 6e-3, rubber)
    base = RollContact(0.0795, 1.2, 6e-3, 5.0, rubber, support="belt", backing=behind)
    print("| varied | |", *(f"{load / 1e3:g} kN/m |" for load in LOADS))
    print("|---|---|" + "---|" * len(LOADS))
    for name, (field, unit, values) in VARIED.items():
        for value in values:
            belt = varied(base, field, value * unit)
            held = replace(belt, support="confined", backing=None)
            each = indentation_curves([belt, held], [LOADS[0]] * 2, [LOADS[-1]] * 2, RTOL)
            given, fast = (curve.at(LOADS).resistance for curve in each)
            cells = (f"{100.0 * (a / b - 1.0):+.1f} |" for a, b in zip(given, fast, strict=True))
            print(f"| {name} | {value:g} |", *cells)


def varied(base: RollContact, field: str, value: float) -> RollContact:
    """The base with one figure another."""
    if field == "spacing":
        return replace(base, spacing=value)
    if field == "own":
        return replace(base, cover_thickness=value)
    return replace(base, backing=replace(base.backing, **{field: value}))


if __name__ == "__main__":
    main()
