"""Flexure of belt and bulk of a stretch, by load and sag or by the laws the spec selects."""

from __future__ import annotations

import math

from conveyor.errors import MessageQuantity, NoSolutionError
from conveyor.laws.loading import effective_tension
from conveyor.laws.resistance import (
    FLEXURE_COEFFICIENT,
    belt_flexure_resistance,
    bulk_flexure_bound,
    sag_flexure_resistance,
)
from conveyor.line.set_loads import SetLoads
from conveyor.models import Conveyor
from conveyor.units import si


class FlexureLaw:
    """Flexure of one span, SI; prepared once for each strand.

    Parameters
    ----------
    conveyor : Conveyor
        The spec, with `calculation.flexure` or without.
    loads : SetLoads
        Sets of the strand: sag, width of the wings under the bulk.

    Notes
    -----
    With a yielding belt (`calculation.support`) the contacts include the belt's flexure; only the bulk's is left, by
    the law of load and sag that of the bulk's load.
    """

    def __init__(self, conveyor: Conveyor, loads: SetLoads) -> None:
        flexure = conveyor.calculation.flexure
        self._named = flexure is not None
        self._sag = si(loads.idlers.sag)
        self._alone = conveyor.calculation.support == "belt"
        self._belt = None if flexure is None or self._alone else flexure.belt
        self._bulk = None if flexure is None else flexure.bulk
        self._loads = loads
        self._speed = si(conveyor.belt.speed)
        self._density = si(conveyor.material.density)
        self._gravity = si(conveyor.calculation.gravity)
        self._trough = si(loads.idlers.trough_angle)
        self._stiffness = 0.0 if self._belt is None else si(self._belt.bending_stiffness)
        given = None if self._belt is None else self._belt.tension
        self._tension = None if given is None else si(given)
        self._bulk_known: dict[float, float] = {}

    def span(
        self, *, belt_mass: float, bulk_mass: float, spacing: float, inclination: float, least_tension: float
    ) -> float:
        """Flexure of one span [N] from masses [kg/m], spacing [m], slope [rad] and the least tension for the sag [N].

        Raises
        ------
        NoSolutionError
            The tension is below m' v²: the belt would lift.
        """
        mass = belt_mass + bulk_mass
        weight = self._gravity * math.cos(inclination)
        load = mass * weight
        if not self._named:
            return sag_flexure_resistance(
                bulk_mass * weight if self._alone else load,
                spacing=spacing,
                relative_sag=self._sag,
                coefficient=FLEXURE_COEFFICIENT.value,
            )
        bulk = 0.0 if self._bulk is None or bulk_mass == 0.0 else self._of_bulk(bulk_mass)
        if self._belt is None:
            return bulk
        tension = least_tension if self._tension is None else self._tension
        effective = effective_tension(tension, line_mass=mass, belt_speed=self._speed)
        if effective <= 0.0:
            raise NoSolutionError(
                "the flexure of the belt is not known at a tension of {}: m' v² is {}; give a larger "
                "calculation.flexure.belt.tension",
                *(MessageQuantity(each, "force", f"{each:.5g} N", digits=5) for each in (tension, tension - effective)),
            )
        return bulk + belt_flexure_resistance(
            load,
            tension=effective,
            spacing=spacing,
            bending_stiffness=self._stiffness,
            loss_tangent=self._belt.loss_tangent,
        )

    def _of_bulk(self, bulk_mass: float) -> float:
        known = self._bulk_known.get(bulk_mass)
        if known is None and self._bulk is not None:
            known = self._bulk_known[bulk_mass] = bulk_flexure_bound(
                si(self._bulk.opening_angle),
                bulk_density=self._density,
                friction_angle=si(self._bulk.friction_angle),
                wing_contact=self._loads.wing_contact(bulk_mass),
                trough_angle=self._trough,
                gravity=self._gravity,
            )
        return known or 0.0
