"""Five duties sized, and beside them what the steps of a manual give: DIN 22101, for the US one CEMA's classic form.

    python benchmarks/sizing_by_manual.py

The manual's steps are written out here, by the masses of the sized design, so that what differs is the method: f of
0.02 and C of DIN 22101 (0.012 where the belt drives the motors), Kx of CEMA with Ai by diameter and Ky entered as 0.03;
Eytelwein with the start factor, sag, classic safety, the next motor of the series.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

from conveyor import shelf
from conveyor.laws.energy import MOTOR_SERIES, NEMA_MOTORS
from conveyor.laws.preliminary_sizing import recommended_speed
from conveyor.models.sizing import SizingDuty
from conveyor.sizing import size_conveyor
from conveyor.sizing.sized_design import SizedDesign
from conveyor.sizing.sizing_task import SizingTask
from conveyor.studies.study_file import read_duty

DUTIES = Path(__file__).parent.parent / "examples" / "duties"
GRAVITY = 9.81
FILLING = 0.9
LENGTH_FACTORS = ((80, 1.92), (100, 1.78), (150, 1.58), (200, 1.45), (300, 1.31), (400, 1.25), (500, 1.2), (600, 1.17),
                  (700, 1.14), (800, 1.12), (900, 1.1), (1000, 1.09), (1500, 1.06), (2000, 1.05), (2500, 1.04),
                  (5000, 1.03), (9e9, 1.03))  # fmt: skip
LEVEL = {
    "name": "Coal, level",
    "material": {"name": "coal", "density": "850 kg/m^3", "flow": "460 t/h", "surcharge_angle": "20 deg"},
    "lump": "150 mm",
    "length": "214 m",
    "lift": "0 m",
    "ambient": {"temperature": "20 degC"},
    "operation": {"hours_per_year": "5000 h", "price": "0.12 EUR/kWh"},
}


def narrowest(task: SizingTask) -> str:
    """Narrowest belt at the speed that CEMA recommends at most, and its filling."""
    for trough in task.troughs:
        fastest = recommended_speed(trough.width.belt, abrasiveness=task.duty.abrasiveness)
        speed = max((v for v in task.speeds if v <= fastest * (1.0 + 1e-9)), default=None)
        if speed is not None and (filling := task.flow / (task.density * speed * trough.area)) <= FILLING:
            return f"{1e3 * trough.width.belt:.0f} mm, {speed:.2f} m/s, {100 * filling:.0f} %"
    return "none"


def din_force(task: SizingTask, design: SizedDesign) -> float:
    """C f L g (m'R + 2 m'G + m'L) + H g m'L, the belt full [N]."""
    line, length = design.found.line, task.length
    lift = math.fsum(rise for _, rise in task.sections)
    belt, bulk = line.stretches[0].belt_mass, task.flow / line.speed
    rolls = math.fsum(stretch.sets * stretch.set_mass for stretch in line.stretches) / length
    factor = next(
        c0 + (c1 - c0) * (length - l0) / (l1 - l0)
        for (l0, c0), (l1, c1) in pairwise(LENGTH_FACTORS)
        if l0 <= length <= l1
    )
    friction = 0.012 if lift < -0.02 * length else 0.02
    return factor * friction * length * GRAVITY * (rolls + 2.0 * belt + bulk) + lift * GRAVITY * bulk


def cema_force(task: SizingTask, design: SizedDesign) -> float:
    """L (Kx + Ky Wb + 0.015 Wb) + Wm (L Ky + H), and 5 % for pulleys, skirts and cleaners [N]."""
    foot, pound = 0.3048, 4.4482216
    length = task.length / foot
    lift = math.fsum(rise for _, rise in task.sections) / foot
    belt, bulk = (
        mass * foot / 0.45359237
        for mass in (design.found.line.stretches[0].belt_mass, task.flow / design.found.line.speed)
    )
    inches = round(design.choice.roll.diameter / 0.0254)
    idlers = {4: 2.3, 5: 1.8, 6: 1.5, 7: 2.4}[inches]
    kx = 0.00068 * (belt + bulk) + idlers * foot / design.choice.carry
    ky = 0.03
    return 1.05 * pound * (length * (kx + ky * belt + 0.015 * belt) + bulk * (length * ky + lift))


def steps(name: str, task: SizingTask) -> None:
    """Print the steps of a duty."""
    design = size_conveyor(task.duty).best
    us, choice, line = task.duty.series == "US", design.choice, design.found.line
    force = cema_force(task, design) if us else din_force(task, design)
    power = force * line.speed / task.efficiency if force > 0.0 else -force * line.speed * task.efficiency
    drives = len(design.chosen.motors)
    series = NEMA_MOTORS if us else MOTOR_SERIES
    motor = next((each for each in series if each >= power / drives), math.inf)
    pairs = 2.0 if choice.drives.startswith("head, two pulleys") else 1.0
    grip = task.rules.start_factor / math.expm1(task.grip[0] * task.grip[1] * pairs)
    first = abs(force) / (drives if "tail" in choice.drives and "head" in choice.drives else 1.0)
    sag = GRAVITY * choice.carry * (line.stretches[0].belt_mass + task.flow / line.speed) / (8.0 * task.sags[0])
    highest = abs(force) + max(first * grip, sag)
    strength = design.chosen.carcass.safety * highest / choice.trough.width.belt
    classes = task.carcasses[choice.kind]
    carcass = next((one.name for one in classes if one.strength >= strength), f"above {classes[-1].name}")
    ours = design.found.balance
    print(f"\n{name}: {'CEMA' if us else 'DIN 22101'} | sized")
    chosen = f"{1e3 * choice.trough.width.belt:.0f} mm, {line.speed:.2f} m/s, {100 * choice.filling:.0f} %"
    print(f"  width, speed, filling: {narrowest(task)} | {chosen}")
    print(f"  rolls, carry spacing: {1e3 * choice.roll.diameter:.0f} mm, {choice.carry:.2f} m")
    print(f"  force: {force / 1e3:.1f} kN | {ours.forces.total / 1e3:.1f} kN")
    print(f"  motor power: {power / 1e3:.1f} kW | {abs(ours.power.motor) / 1e3:.1f} kW")
    rated = " + ".join(f"{each / 1e3:.0f}" for each in design.chosen.motors)
    print(f"  motors: {drives} x {motor / 1e3:.0f} kW | {rated} kW")
    print(f"  highest tension: {highest / 1e3:.1f} kN | {design.found.belt_duty.largest_steady / 1e3:.1f} kN")
    print(f"  belt: {carcass} | {design.chosen.carcass.name}", flush=True)


def main() -> None:
    duties = {path.stem: read_duty(path) for path in sorted(DUTIES.glob("*.yaml"))}
    duties["level"] = SizingDuty.from_data(LEVEL | {"covers": [shelf.compound("standard-cover")]})
    for name, duty in duties.items():
        steps(name, SizingTask(duty))


if __name__ == "__main__":
    main()
