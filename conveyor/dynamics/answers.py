"""What scenarios are checked for: one function a criterion, as in `conveyor.checks`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from conveyor.checks import Check, compared, verdict
from conveyor.dynamics.follow import CalculatedDynamics, Followed
from conveyor.laws.belt import CLASSIC_SAFETY, RATED_START, belt_safety
from conveyor.laws.motion import bulk_slip_limits
from conveyor.laws.vertical_curve import lift_off_radius
from conveyor.units.sentences import Said, quoted, said

FULL_SPEED: Final = 0.95
"""Speed over the steady one at which a start is over [-]; general knowledge: motors run within their slip."""
OVERSPEED: Final = 1.1
"""Speed over the steady one that a belt may reach without power [-]; general knowledge."""


@dataclass(frozen=True)
class Peak:
    """An extreme tension of a stretch: N, s, and the least that its sag allows in steady running [N]."""

    section: str
    strand: str
    highest: float
    highest_at: float
    lowest: float
    lowest_at: float
    least_for_sag: float


def peaks(found: Followed) -> Iterator[Peak]:
    """Extreme tensions of every stretch, as the belt meets them from the take-up."""
    record, shape = found.record, found.line.loop
    for k, cells in found.stretches():
        stretch = shape.stretches[k]
        high, low = int(record.highest[cells].argmax()), int(record.lowest[cells].argmin())
        yield Peak(
            stretch.section, stretch.strand, float(record.highest[cells][high]), float(record.highest_at[cells][high]),
            float(record.lowest[cells][low]), float(record.lowest_at[cells][low]), float(shape.least[k]),
        )  # fmt: skip


def _strength(found: Followed) -> Iterator[Check]:
    belt = found.line.belt
    i = int(found.record.highest.argmax())
    where = f"{found.place(i)}, {found.record.highest_at[i]:.1f} s"
    most = "1.5 times the tension in steady running, general knowledge"
    if belt.strength is not None:
        needed = CLASSIC_SAFETY["steel cord" if belt.steel_cord else "textile"] / RATED_START
        safety = belt_safety(found.highest, nominal_strength=belt.strength, belt_width=belt.width)
        why = said("safety of the belt {} at {}, {} are asked for", (safety, "safety"), (found.highest, "force"),
                   (needed, "safety"))  # fmt: skip
        yield compared("dynamic_safety", "safety of the belt", safety, "at least", needed, "safety",
                       source=most, why=why, where=where)  # fmt: skip
    if belt.rating is not None:
        tension = found.highest / belt.width
        why = said("the belt bears {}", (tension, "belt rating"))
        yield compared("dynamic_rating", "belt tension per width", tension, "at most", RATED_START * belt.rating,
                       "belt rating", source=most, why=why, where=where)  # fmt: skip


def _slack(found: Followed) -> Iterator[Check]:
    i = int(found.record.lowest.argmin())
    at = found.record.lowest_at[i]
    why = said(
        f"the belt goes slack in {quoted(found.place(i))} at {at:.1f} s: down to {{}}, from then on the figures are "
        "none of a real belt; raise the take-up's tension, or slow the motion by ramps or flywheels",
        (found.lowest, "force"),
    )
    made = compared("dynamic_slack", "lowest tension", found.lowest, "at least", 0.0, "force", why=why,
                    where=f"{found.place(i)}, {at:.1f} s")  # fmt: skip
    yield replace(made, asked=said("not slack: at least 0"))


def _lift_off(found: Followed) -> Iterator[Check]:
    sections = {section.name: section for section in found.line.sections if section.curve == "concave"}
    stretches = {f"{s.section}, {s.strand}": s for s in found.line.loop.stretches}
    for peak in peaks(found):
        if peak.section not in sections:
            continue
        stretch, radius = stretches[f"{peak.section}, {peak.strand}"], abs(sections[peak.section].radius)
        least = lift_off_radius(max(peak.highest, 0.0), belt_mass=stretch.belt_mass, inclination=stretch.inclination,
                                gravity=found.line.gravity)  # fmt: skip
        why = said("the empty belt lifts off on the concave curve of {}; at least {} are needed", (radius, "length"),
                   (least, "length"))  # fmt: skip
        yield compared("dynamic_lift_off", f"empty belt stays down, {quoted(peak.section)}, {peak.strand}", radius,
                       "at least", least, "length", why=why, where=f"{peak.highest_at:.1f} s")  # fmt: skip


def _grip(found: Followed) -> Iterator[Check]:
    for d, drive in enumerate(found.ride.drives):
        way, heat = float(found.record.slipped[d]), float(found.record.heat[d])
        why = said(
            f'the belt slips on "{quoted(drive.name)}" by {{}} and heats it with {heat / 1e6:.3g} MJ; raise the '
            "take-up's tension, the wrap or the friction, or slow the motion",
            (way, "length"),
        )
        made = compared(
            "dynamic_grip", f"grip of {quoted(drive.name)}", way, "at most", 0.0, "length", why=why
        )
        yield replace(made, found=said("no slip") if way == 0.0 else said("slips {}", (way, "length")),
                      asked=said("no slip"))  # fmt: skip


def _end(found: Followed) -> Iterator[Check]:
    """A stop comes to rest without running away; a start reaches full speed."""
    full, top = found.line.speed, float(np.abs(found.belt_speed).max())
    if found.stops:
        words = said("does not within the time followed")
        if found.rests_at is not None:
            words = said(f"in {found.rests_at:,.1f} s, {{}}", (found.way, "length"))
        why = said("the belt does not come to rest; {} at the end", (float(found.belt_speed[-1]), "speed"))
        yield Check("dynamic_rest", said("comes to rest"), found.rests_at, None, "duration", words, said("a stop"),
                    verdict(holds=found.rests_at is not None), why)  # fmt: skip
        why = said("the belt runs away to {}", (top, "speed"))
        yield compared("dynamic_overspeed", "speed of the belt", top, "at most", OVERSPEED * full, "speed",
                       source="general knowledge", why=why)  # fmt: skip
    elif not found.ride.scene.running:
        end = float(found.belt_speed[-1])
        why = said("the belt reaches {}", (end, "speed"))
        yield compared(
            "dynamic_full_speed", "speed at the end", end, "at least", FULL_SPEED * full, "speed", why=why
        )


def _bulk(found: Followed) -> Iterator[Check]:
    """The bulk stays on the belt, by the mean acceleration between two samples, where it stays at even speed."""
    line, worst = found.line, []
    for k, cells in found.stretches():
        stretch = line.loop.stretches[k]
        grip = line.bulk_on_belt - abs(np.tan(stretch.inclination))
        if stretch.bulk_mass == 0.0 or grip <= 0.0:
            continue
        low, high = bulk_slip_limits(line.bulk_on_belt, inclination=stretch.inclination, gravity=line.gravity)
        hardest = float(found.record.slowest[cells.start : cells.stop + 1].min())
        fastest = float(found.record.fastest[cells.start : cells.stop + 1].max())
        worst += [
            (-hardest / -low, -hardest, -low, stretch.section),
            (fastest / high, fastest, high, stretch.section),
        ]
    if worst:
        _, most, allowed, section = max(worst)
        why = said(f'the bulk slides in "{quoted(section)}": {{}}, {{}} are allowed', (most, "acceleration"),
                   (allowed, "acceleration"))  # fmt: skip
        yield compared("dynamic_bulk", "bulk lies still", most, "at most", allowed, "acceleration", why=why,
                       where=section)  # fmt: skip


CRITERIA: Final[tuple[Callable[[Followed], Iterator[Check]], ...]] = (
    _strength, _slack, _lift_off, _grip, _end, _bulk,
)  # fmt: skip


def checks_of(found: CalculatedDynamics) -> tuple[Check, ...]:
    """Every criterion of every scenario."""
    return tuple(
        replace(check, case=scenario_case(followed))
        for followed in found.followed
        for criterion in CRITERIA
        for check in criterion(followed)
    )


def scenario_case(found: Followed) -> Said:
    """A scenario as the case of a check."""
    return said(quoted(found.name))
