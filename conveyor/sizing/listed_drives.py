"""Pulleys, gearboxes, couplings, backstops and brakes of makers' lists, chosen by what a design asks of them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from conveyor.calculated_conveyor import CalculatedConveyor
from conveyor.checks.pulley_checks import lagging_pressure, pulley_bearings, pulley_shaft
from conveyor.laws.belt_strength import pulley_group_diameter
from conveyor.laws.drives import gear_torque
from conveyor.models.maker_lists import ListedItem, MakerKind
from conveyor.models.sizing import within_limit
from conveyor.sizing.design_choice import DesignChoice, ListedPart, ListedParts, SelectedParts
from conveyor.sizing.design_spec import SECOND_DRIVE_PULLEY, has_second_pulley, series_drive_diameter
from conveyor.sizing.sized_design import Shortfall
from conveyor.sizing.sizing_task import SizingTask
from conveyor.units import read_si
from conveyor.units.sentences import escape_braces, message

_KINDS: Final[tuple[MakerKind, ...]] = ("pulleys", "gearboxes", "couplings", "backstops", "brakes")
_PLACES: Final = ("head", "take-up", "tail")


@dataclass(frozen=True)
class HoldingDemand:
    """Demands of the loads on backstop and brake, with their reserve.

    Attributes
    ----------
    backstop, brake : float
        Force that holds the loaded belt [N]; 0 where none is needed.
    stalled : float
        Torque of the motors at the pulley with the belt blocked [N m]; 0 if unknown.
    heat : float
        Heat of a stop in the brake [J]; 0 without a brake.
    """

    backstop: float = 0.0
    brake: float = 0.0
    stalled: float = 0.0
    heat: float = 0.0


class _NoItemError(Exception):
    """No listed item is enough, with the shortfall."""

    def __init__(self, short: Shortfall) -> None:
        super().__init__(short.rule)
        self.short = short


def select_listed_parts(
    task: SizingTask,
    choice: DesignChoice,
    chosen: SelectedParts,
    demand: HoldingDemand,
    loads: Sequence[CalculatedConveyor] = (),
) -> SelectedParts | Shortfall:
    """Select items of the duty's lists of pulleys and parts of drives.

    Parameters
    ----------
    task : SizingTask
        The duty.
    choice : DesignChoice
        Belt width and wanted speed.
    chosen : SelectedParts
        Belt, motors, brake and backstop; `listed` are the items that `loads` were calculated with.
    demand : HoldingDemand
        What backstop and brake have to hold.
    loads : sequence of CalculatedConveyor
        Loads under which a pulley that fails a check gives way to the next larger.

    Returns
    -------
    SelectedParts or Shortfall
        Unchanged if the duty lists no such kind; the shortfall if no listed item is enough.
    """
    if not any(task.duty.listed.items(kind) for kind in _KINDS):
        return chosen
    try:
        return _with_items(_Selection(task, choice, chosen, tuple(loads)), demand)
    except _NoItemError as error:
        return error.short


def _with_items(of: _Selection, demand: HoldingDemand) -> SelectedParts:
    """Chosen parts with their listed items; force and torque of brake and backstop are those of the items."""
    before, pulley, gearbox, speed = of.chosen.listed, *of.drive()
    diameter = pulley if isinstance(pulley, float) else pulley.rated
    held = 0.5 * diameter * demand.backstop
    torque = max(held, demand.stalled if held > 0.0 else 0.0)
    kept = None if before is None else before.backstop
    torque = torque if kept is None else max(torque, kept.needed)
    turning = speed / (math.pi * diameter)
    backstop = of.backstop(torque, turning) if torque > 0.0 else None
    brake = of.brake(demand, 0.5 * diameter, turning) if of.chosen.brake > 0.0 else None
    listed = ListedParts(diameter, speed, of.select_pulleys(pulley), gearbox, of.coupling(), backstop, brake)
    return replace(
        of.chosen,
        listed=listed,
        backstop=of.chosen.backstop if backstop is None else backstop.rated,
        brake=of.chosen.brake if brake is None else brake.rated,
    )


@dataclass(frozen=True, eq=False)
class _Selection:
    """A candidate whose items are selected."""

    task: SizingTask
    choice: DesignChoice
    chosen: SelectedParts
    loads: tuple[CalculatedConveyor, ...]

    def items(self, kind: MakerKind) -> tuple[ListedItem, ...]:
        """Items of a kind."""
        return self.task.duty.listed.items(kind)

    def smallest(
        self, rated: Mapping[str, float], quantity: str, needed: float, fit: Sequence[ListedItem]
    ) -> ListedPart:
        """Item with the smallest rated figure that is enough, of those that fit; `rated` has that of every name."""
        item = min(
            (item for item in fit if within_limit(needed, rated[item.name])),
            key=lambda item: rated[item.name],
            default=None,
        )
        if item is None:
            most = max(self.items(fit[0].kind), key=lambda item: rated[item.name])
            raise _too_small(most, quantity, needed, rated[most.name])
        return ListedPart("drive", item, quantity, needed, rated[item.name])

    def backstop(self, needed: float, turning: float) -> ListedPart | None:
        """Smallest backstop that bears a torque at the pulley [N m], which turns at a speed [1/s]."""
        items = self.items("backstops")
        rated = {item.name: self._torque_at_pulley(item, "backstop", turning) for item in items}
        return self.smallest(rated, "torque", needed, items) if items else None

    def brake(self, demand: HoldingDemand, radius: float, turning: float) -> ListedPart | None:
        """Smallest brake that holds the belt and takes the heat of a stop, if its list has that.

        `radius` [m] and `turning` [1/s] are those of its pulley.
        """
        items = self.items("brakes")
        if not items:
            return None
        needed = demand.brake if demand.brake > 0.0 else self.chosen.brake
        able = [
            item
            for item in items
            if "brake_heat" not in item.fields
            or within_limit(demand.heat, read_si(item.fields["brake_heat"], "heat"))
        ]  # fmt: skip
        if not able:
            heats = {item.name: read_si(item.fields["brake_heat"], "heat") for item in items}
            most = max(items, key=lambda item: heats[item.name])
            raise _too_small(most, "heat", demand.heat, heats[most.name])
        rated = {
            item.name: read_si(item.fields["brake_force"], "force")
            if "brake_force" in item.fields
            else self._torque_at_pulley(item, "brake", turning) / radius
            for item in items
        }
        made = self.smallest(rated, "force", max(needed, self.chosen.brake), able)
        return replace(made, needed=needed)

    def _torque_at_pulley(self, item: ListedItem, part: str, turning: float) -> float:
        """Torque of a brake or backstop at the pulley [N m]; of one at the motor's shaft by the ratio."""
        torque = read_si(item.fields[f"{part}_torque"], "torque")
        motor, _ = self._motor()
        if item.fields.get(f"{part}_shaft", "pulley") == "pulley":
            return torque
        if motor is None:
            raise AssertionError("parts at the motor's shaft are listed with motors only")
        return torque * read_si(motor.fields["motor_speed"], "rotation") / turning

    def coupling(self) -> ListedPart | None:
        """Coupling of a motor by its torque with the service factor."""
        motor, power = self._motor()
        if motor is None or not self.items("couplings"):
            return None
        turn = read_si(motor.fields["motor_speed"], "rotation")
        needed = gear_torque(power, rotation=turn, service=self.task.rules.service_factor)
        items = self.items("couplings")
        rated = {item.name: read_si(item.fields["coupling_torque"], "torque") for item in items}
        return self.smallest(rated, "torque", needed, items)

    def drive(self) -> tuple[ListedPart | float, ListedPart | None, float]:
        """Drive pulley, or its diameter in the series, its gearbox, and the belt speed of both [m/s]."""
        pulleys = list(self._drive_pulleys())
        if not self.items("gearboxes"):
            return pulleys[0], None, self.choice.speed
        for pulley in pulleys:
            found = self._gearbox(pulley if isinstance(pulley, float) else pulley.rated)
            if found is not None:
                return pulley, *found
        raise self._no_gearbox([pulley if isinstance(pulley, float) else pulley.rated for pulley in pulleys])

    def _motor(self) -> tuple[ListedItem | None, float]:
        """Listed motor of a drive, and its power [W]."""
        rated = self.chosen.motors[0]
        return self.task.listed_motor(rated), rated / self.task.motor_count(rated)

    def _geared(self, diameter: float) -> Iterator[tuple[float, float, ListedItem]]:
        """Belt speed [m/s], torque needed at the slow shaft [N m] and gearbox, those within the rules of the speed."""
        motor, power = self._motor()
        if motor is None:
            raise AssertionError("gearboxes are listed with motors only")
        turn, trough, wanted = read_si(motor.fields["motor_speed"], "rotation"), self.choice.trough, self.choice.speed
        for item in self.items("gearboxes"):
            slow = turn / float(item.fields["gear_ratio"])
            speed = math.pi * diameter * slow
            if abs(speed / wanted - 1.0) > self.task.speed_tolerance or self.task.filling(trough, speed) is None:
                continue
            if self.task.turns_slowly(self.choice.roll, speed):
                yield speed, gear_torque(power, rotation=slow, service=self.task.rules.service_factor), item

    def _gearbox(self, diameter: float) -> tuple[ListedPart, float] | None:
        """Gearbox with torque enough whose speed is nearest, of those alike the smallest, and the belt speed [m/s]."""
        fit = [
            (abs(speed / self.choice.speed - 1.0), rated, speed, needed, item)
            for speed, needed, item in self._geared(diameter)
            if within_limit(needed, rated := read_si(item.fields["gear_torque"], "torque"))
        ]
        if not fit:
            return None
        _, rated, speed, needed, item = min(fit, key=lambda each: each[:2])
        return ListedPart("drive", item, "torque", needed, rated), speed

    def _no_gearbox(self, diameters: Sequence[float]) -> _NoItemError:
        """Refusal of the gearboxes: of their torque where a ratio suits, else of their ratio."""
        geared = [(needed, item) for size in diameters for _, needed, item in self._geared(size)]
        if geared:
            rated = {item.name: read_si(item.fields["gear_torque"], "torque") for _, item in geared}
            needed, item = min(geared, key=lambda of: of[0] / rated[of[1].name])
            words = " of a ratio that suits the belt speed (rules.speeds, rules.speed_tolerance)"
            return _too_small(item, "torque", needed, rated[item.name], words)
        motor, _ = self._motor()
        turn = 0.0 if motor is None else read_si(motor.fields["motor_speed"], "rotation")
        ratio = turn * math.pi * diameters[0] / self.choice.speed
        ratios = {item.name: float(item.fields["gear_ratio"]) for item in self.items("gearboxes")}
        name = min(ratios, key=lambda each: abs(math.log(ratios[each] / ratio)))
        why = message(
            f"its gearboxes need a ratio of about {ratio:.4g} for {{}} with drive pulleys of {{}}, the nearest listed, "
            f"{escape_braces(name)}, has {ratios[name]:.4g}: list others, or allow other speeds (rules.speeds, "
            "rules.speed_tolerance, rules.filling, rules.fastest)",
            (self.choice.speed, "speed"),
            (diameters[0], "thickness"),
        )
        return _NoItemError(Shortfall("listed gearboxes", why, max(ratios[name] / ratio, ratio / ratios[name]), {}))

    def _drive_pulleys(self) -> Iterator[ListedPart | float]:
        """Drive pulleys from the smallest that suits the belt, larger ones only for the gearboxes."""
        least = self.chosen.carcass.least_pulley
        if self.items("pulleys"):
            yield from self._wide_enough("head", least, self._alike)
            return
        smallest = series_drive_diameter(self.task, self.chosen)
        yield smallest
        yield from (size for size in self.task.pulley_sizes if size > smallest)

    @property
    def _alike(self) -> tuple[str, ...]:
        """Names of the pulleys that are alike: those at the head, and a driven tail."""
        second = (SECOND_DRIVE_PULLEY,) if has_second_pulley(self.choice.drives) else ()
        return ("head", *second, *(("tail",) if "tail" in self.choice.drives else ()))

    def select_pulleys(self, drive: ListedPart | float) -> tuple[ListedPart, ...]:
        """Listed pulleys of head, take-up and tail; none if they are of the series."""
        if isinstance(drive, float):
            return ()
        least = pulley_group_diameter(self.chosen.carcass.least_pulley, group=self.task.pulleys.bend_group)
        return tuple(
            replace(drive, place=place) if place in self._alike else next(self._wide_enough(place, least, [place]))
            for place in _PLACES
        )

    def _wide_enough(self, place: str, least: float, alike: Sequence[str]) -> Iterator[ListedPart]:
        """Pulleys of a face and diameter [m] that suit the belt, the smallest first, from the present one on."""
        face = self.choice.trough.width.belt + self.task.pulleys.face_allowance
        wide = [
            item for item in self.items("pulleys")
            if within_limit(face, read_si(item.fields["face_width"], "length"))
        ]  # fmt: skip
        wide.sort(key=_pulley_size)
        parts = [
            ListedPart(place, item, "thickness", least, size)
            for item in wide
            if within_limit(least, size := _pulley_size(item)[0])
        ]
        if not parts:
            raise self._no_pulley(least, face, [_pulley_size(item)[0] for item in wide])
        before = self.chosen.listed
        if before is not None and before.pulleys:
            now = before.pulleys[_PLACES.index(place)].item.name
            at = next((i for i, part in enumerate(parts) if part.item.name == now), 0)
            over = any(_fails_its_load(one, name) for one in self.loads for name in alike)
            parts = parts[min(at + over, len(parts) - 1) :]
        yield from parts

    def _no_pulley(self, least: float, face: float, wide: Sequence[float]) -> _NoItemError:
        """Refusal of the pulleys: of their diameter where some are wide enough, else of their faces."""
        if wide:
            had, words, over = max(wide), "the largest listed of that face has {}", least / max(wide)
        else:
            had = max(read_si(item.fields["face_width"], "length") for item in self.items("pulleys"))
            words, over = "the widest listed has a face of {}", face / had
        why = message(
            f"its pulleys need a diameter of {{}} with a face of {{}}, {words}: list others, or allow narrower "
            "belts or thinner carcasses (rules.widths, rules.carcasses, rules.face_allowance)",
            (least, "thickness"),
            (face, "thickness"),
            (had, "thickness"),
        )
        return _NoItemError(Shortfall("listed pulleys", why, over, {}))


def _pulley_size(item: ListedItem) -> tuple[float, float, float]:
    """Diameter, diameter of the shaft [m] and mass [kg]."""
    fields = item.fields
    return (
        read_si(fields["diameter"], "length"),
        read_si(fields["shaft_diameter"], "length"),
        read_si(fields["mass"], "mass"),
    )


def _fails_its_load(one: CalculatedConveyor, name: str) -> bool:
    """True if shaft, bearings or lagging of a pulley fail their check."""
    return any(
        check.failed and check.subject.text("SI").endswith(f"{name} pulley")
        for criterion in (pulley_shaft, pulley_bearings, lagging_pressure)
        for check in criterion(one)
    )


def _too_small(item: ListedItem, kind: str, needed: float, rated: float, words: str = "") -> _NoItemError:
    """Refusal of a kind whose largest item is not enough."""
    why = message(
        f"its {item.kind} need {{}}, the largest listed{words}, {escape_braces(item.name)}, has {{}}: list a larger "
        f"one (listed.{item.kind})",
        (needed, kind),
        (rated, kind),
    )
    return _NoItemError(Shortfall(f"listed {item.kind}", why, needed / rated, {}))
