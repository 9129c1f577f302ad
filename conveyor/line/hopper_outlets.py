"""Hopper outlets over a belt, in SI."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.feeder import flow_load_factor, gate_flow, hopper_load, initial_load_factor
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
        width, slope, inside = si(hopper.outlet_width), si(hopper.half_angle), si(hopper.internal_friction)
        initial = hopper.initial_factor or initial_load_factor(
            si(hopper.top_width), outlet_width=width, half_angle=slope
        )
        flow = hopper.flow_factor or flow_load_factor(
            slope, internal_friction=inside, wall_friction=si(hopper.wall_friction)
        )
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
