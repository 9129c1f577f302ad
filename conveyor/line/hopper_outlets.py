"""Hopper outlets over a belt, in SI."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.feeder import gate_flow, hopper_load
from conveyor.models import Conveyor
from conveyor.models.hoppers import Hopper
from conveyor.units import si


@dataclass(frozen=True)
class HopperOutlet:
    """Outlet of a hopper over the belt.

    Attributes
    ----------
    initial_factor, flow_factor : float
        Load after filling and in flow over ρ g L B² [-].
    initial_load, flow_load : float
        Vertical load on the belt [N].
    shear_friction : float
        Pull-out force over that load [-].
    rated_flow : float
        Mass flow under the gate at belt speed [kg/s].
    """

    initial_factor: float
    flow_factor: float
    initial_load: float
    flow_load: float
    shear_friction: float
    rated_flow: float

    @classmethod
    def of(cls, hopper: Hopper, conveyor: Conveyor) -> HopperOutlet:
        """Outlet of a hopper over a conveyor's belt."""
        width, inside = si(hopper.outlet_width), si(hopper.internal_friction)
        initial, flow = hopper.load_factors
        after_filling, flowing = (
            hopper_load(
                factor,
                density=si(conveyor.material.heaviest),
                outlet_length=si(hopper.outlet_length),
                outlet_width=width,
                gravity=si(conveyor.calculation.gravity),
            )
            for factor in (initial, flow)
        )
        rated = gate_flow(
            si(conveyor.belt.speed),
            density=si(conveyor.material.density),
            gate_width=width,
            gate_height=si(hopper.gate_height),
            efficiency=1.0 if hopper.gate_efficiency is None else si(hopper.gate_efficiency),
        )
        return cls(initial, flow, after_filling, flowing, hopper.shear_friction or math.sin(inside), rated)
