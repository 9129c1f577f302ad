"""A conveyor from its spec to power, and what another cover compound would change."""

from pathlib import Path

import conveyor
from conveyor import shelf

spec = Path(__file__).parent / "specs" / "overland.yaml"
line = conveyor.load(spec)
result = conveyor.analyse(line)
print(result.summary.to_string(float_format="{:,.4g}".format))

for name in ("low-rolling-resistance-cover", "standard-cover", "S120"):
    cover = line.belt.bottom_cover.replace(compound=shelf.compound(name))
    other = conveyor.analyse(line.replace(belt=line.belt.replace(bottom_cover=cover)))
    power = other.balance.power.motor / 1e3
    print(f"{name:>30}: motor {power:7.1f} kW, f {other.balance.friction_factor:.4f}")
