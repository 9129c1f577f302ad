"""Loads of the rolls of a strand's sets, SI; prepared once for all stretches."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.loading import (
    BulkSpread,
    Heap,
    RollLoad,
    least_pipe_stiffness,
    pipe_area,
    pipe_forming_load,
    pipe_roll_loads,
    pipe_transverse_stiffness,
    roll_loads,
    shares_by_area,
    spread_bulk,
)
from conveyor.models import Conveyor, IdlerSet
from conveyor.units import Quantity, si


@dataclass(frozen=True)
class FormedPipe:
    """A pipe as its belt forms it.

    Attributes
    ----------
    diameter, carcass_radius, outer_radius : float
        Inner diameter; radius to the carcass and to the rolls [m].
    half_angle : float
        Half of the belt's width over the radius of its carcass [rad].
    spacing : float
        Of its sets [m].
    stiffness : float
        Bending stiffness across the belt over its length [N m²/m].
    belt_weight : float
        Of the belt over its length [N/m].
    roll_length : float
        Of each roll [m].
    offset : bool
        True where every other roll stands behind the panel.
    """

    diameter: float
    carcass_radius: float
    outer_radius: float
    half_angle: float
    spacing: float
    stiffness: float
    belt_weight: float
    roll_length: float
    offset: bool

    @property
    def circumference(self) -> float:
        """Circumference of the carcass [m]."""
        return 2.0 * math.pi * self.carcass_radius

    @property
    def lap(self) -> float:
        """Width of the belt less the circumference of its carcass [m]."""
        return 2.0 * self.half_angle * self.carcass_radius - self.circumference

    @property
    def forming_load(self) -> float:
        """Mean of what the belt without weight presses on the rolls of a panel at the spacing of its sets [N]."""
        return pipe_forming_load(
            self.stiffness, half_angle=self.half_angle, radius=self.carcass_radius, spacing=self.spacing
        )

    @property
    def least_stiffness(self) -> float | None:
        """Least stiffness with which the empty pipe bears on all six rolls [N m²/m]; None where one never bears."""
        return least_pipe_stiffness(self.belt_weight, half_angle=self.half_angle, radius=self.carcass_radius)

    @classmethod
    def of(cls, conveyor: Conveyor, idlers: IdlerSet) -> FormedPipe | None:
        """Return the pipe of a strand's sets; None of a trough."""
        belt, pipe = conveyor.belt, idlers.pipe
        if pipe is None:
            return None
        radius, spacing = pipe.carcass_radius(belt.top_cover.thickness, belt.carcass.thickness), si(idlers.spacing)
        half_angle = 0.5 * si(belt.width) / radius
        if belt.transverse_stiffness is not None:
            stiffness = si(belt.transverse_stiffness)
        elif pipe.forming_load is not None:
            load = si(pipe.forming_load)
            stiffness = pipe_transverse_stiffness(load, half_angle=half_angle, radius=radius, spacing=spacing)
        else:
            raise TypeError(pipe)
        weight = belt.line_mass * si(conveyor.calculation.gravity)
        outer = radius + 0.5 * si(belt.carcass.thickness) + si(belt.bottom_cover.thickness)
        length, offset = si(idlers.roll.length), si(idlers.offset) > 0.0
        return cls(si(pipe.diameter), radius, outer, half_angle, spacing, stiffness, weight, length, offset)


class SetLoads:
    """Loads of the rolls of one set by spacing, slope and masses.

    Parameters
    ----------
    conveyor : Conveyor
        Belt, material, gravity.
    idlers : IdlerSet
        The sets of the strand.
    """

    def __init__(self, conveyor: Conveyor, idlers: IdlerSet) -> None:
        self.idlers = idlers
        self._trough = si(idlers.trough_angle)
        self._roll_length = si(idlers.roll.length)
        self._width = si(conveyor.belt.width)
        self._middle = idlers.middle_belt(self._width)
        self._gravity = si(conveyor.calculation.gravity)
        self._density = si(conveyor.material.density)
        self._surcharge = conveyor.material.surcharge
        iso = conveyor.material.surcharge_convention == "ISO 5048"
        self._heap: Heap = "parabola" if iso else "triangle"
        self._bulk_shares = _si_shares(idlers.load_shares)
        self._belt_shares = _si_shares(idlers.belt_shares)
        self._by_area = idlers.share_rule == "cross-section" and idlers.rolls > 2
        self._found: dict[tuple[float, ...], tuple[RollLoad, ...]] = {}
        self._known_shares: dict[float, tuple[float, ...]] = {}
        self._pipe = FormedPipe.of(conveyor, idlers)

    def of(
        self,
        *,
        spacing: float,
        inclination: float,
        belt_mass: float,
        bulk_mass: float,
        flow_mass: float,
        pull: tuple[float, float] = (0.0, 0.0),
    ) -> tuple[RollLoad, ...]:
        """Load of each roll of one set.

        Parameters
        ----------
        spacing : float
            Of the sets [m].
        inclination : float
            Slope angle [rad].
        belt_mass, bulk_mass : float
            Masses as they press on the rolls [kg/m].
        flow_mass : float
            Bulk on the belt [kg/m], which decides the cross-section.
        pull : tuple of float
            Forces of the tension on a panel around a pipe, down and to the right [N].
        """
        key = (spacing, inclination, belt_mass, bulk_mass, flow_mass, *pull)
        known = self._found.get(key)
        if known is None and self._pipe is not None:
            known = self._found[key] = pipe_roll_loads(
                bulk_line_mass=bulk_mass,
                belt_line_mass=belt_mass,
                spacing=spacing,
                diameter=self._pipe.diameter,
                carcass_radius=self._pipe.carcass_radius,
                half_angle=self._pipe.half_angle,
                transverse_stiffness=self._pipe.stiffness,
                filling=flow_mass / (self._density * pipe_area(self._pipe.diameter)),
                roll_length=self._roll_length,
                inclination=inclination,
                gravity=self._gravity,
                curve_down=pull[0],
                curve_right=pull[1],
            )
        if known is None:
            known = self._found[key] = roll_loads(
                bulk_line_mass=bulk_mass,
                belt_line_mass=belt_mass,
                spacing=spacing,
                n_rolls=self.idlers.rolls,
                trough_angle=self._trough,
                roll_length=self._roll_length,
                belt_width=self._width,
                inclination=inclination,
                gravity=self._gravity,
                bulk_shares=self._shares_of(flow_mass),
                belt_shares=self._belt_shares,
                outer_shape=self.idlers.wing_load,
            )
        return known

    def _shares_of(self, flow_mass: float) -> tuple[float, ...] | None:
        if not self._by_area:
            return self._bulk_shares
        if flow_mass not in self._known_shares:
            self._known_shares[flow_mass] = self._shares_by_area(flow_mass)
        return self._known_shares[flow_mass]

    def _shares_by_area(self, flow_mass: float) -> tuple[float, ...]:
        """Load shares by the area above each roll; a narrow heap lies on the inner rolls alone."""
        rolls, (across, surcharge) = self.idlers.rolls, self.spread(flow_mass)
        if across <= self._middle:
            return tuple(float(place == rolls // 2) for place in range(rolls))
        middle, *wings = shares_by_area(
            across,
            middle_roll_length=self._middle,
            trough_angle=self._trough,
            surcharge_angle=surcharge,
            heap=self._heap,
            inner_wing=self.idlers.inner_wing,
        )
        wings += [0.0] * (rolls // 2 - len(wings))
        return (*reversed(wings), *([middle] * (rolls % 2)), *wings)

    def spread(self, flow_mass: float) -> BulkSpread:
        """Width of the belt under the bulk of a mass per length and the slope of its heap [m, rad]."""
        if flow_mass == 0.0 or self.idlers.shape.closed:
            return BulkSpread(0.0, self._surcharge)
        return spread_bulk(
            flow_mass / self._density,
            belt_width=self._width,
            middle_roll_length=self._middle,
            trough_angle=self._trough,
            surcharge_angle=self._surcharge,
            inner_wing=self.idlers.inner_wing,
        )

    def wing_contact(self, flow_mass: float) -> float:
        """Width of each wing's belt under the bulk, for sets of up to 3 rolls [m]; none on a flat belt."""
        if self.idlers.rolls == 1:
            return 0.0
        return max(0.5 * (self.spread(flow_mass).width - self._middle), 0.0)


def _si_shares(given: tuple[Quantity, ...] | None) -> tuple[float, ...] | None:
    return None if given is None else tuple(si(share) for share in given)
