"""Hopper outlets over a belt, in SI."""

from __future__ import annotations

import math
from dataclasses import dataclass

from conveyor.laws.feeder import gate_flow, hopper_load, hopper_skirt_resistance, mass_flow_half_angle
from conveyor.models import Conveyor
from conveyor.models.hoppers import Hopper
from conveyor.units import si


@dataclass(frozen=True)
class HopperSkirts:
    """Skirts between a hopper's outlet and the belt, as `hopper_skirt_resistance` takes them, SI."""

    pressure_ratio: float
    friction: float
    density: float
    outlet_length: float
    outlet_width: float
    gate_height: float
    gravity: float

    def resistance(self, load: float) -> float:
        """Friction of the bulk on both at a load on the outlet [N]."""
        return hopper_skirt_resistance(load, **vars(self))


@dataclass(frozen=True)
class HopperOutlet:
    """Outlet of a hopper over the belt.

    Attributes
    ----------
    length : float
        Of the outlet along the belt, over which the bulk is pulled [m].
    initial_factor, flow_factor : float
        Load after filling and in flow over ρ g L B² [-].
    initial_load, flow_load : float
        Vertical load on the belt [N].
    shear_friction : float
        Pull-out force over that load [-].
    rated_flow : float
        Mass flow under the gate at belt speed [kg/s].
    half_angle : float
        Slope of the hopper's walls to the vertical [rad].
    mass_flow_angle : float or None
        The largest in mass flow [rad]; None where the load in flow is given.
    skirts : HopperSkirts or None
        Skirts between outlet and belt; None where their friction is not asked.
    """

    length: float
    initial_factor: float
    flow_factor: float
    initial_load: float
    flow_load: float
    shear_friction: float
    rated_flow: float
    half_angle: float
    mass_flow_angle: float | None
    skirts: HopperSkirts | None = None

    @classmethod
    def of(cls, hopper: Hopper, conveyor: Conveyor, *, skirt_friction: float) -> HopperOutlet:
        """Outlet of a hopper over a conveyor's belt, between skirts of a friction [-]."""
        length, width, inside = si(hopper.outlet_length), si(hopper.outlet_width), si(hopper.internal_friction)
        initial, flow = hopper.load_factors
        after_filling, flowing = (
            hopper_load(
                factor,
                density=si(conveyor.material.heaviest),
                outlet_length=length,
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
        skirts = None
        if hopper.skirt_pressure_ratio is not None:
            skirts = HopperSkirts(
                hopper.skirt_pressure_ratio,
                skirt_friction,
                si(conveyor.material.heaviest),
                length,
                width,
                si(hopper.gate_height),
                si(conveyor.calculation.gravity),
            )
        steep = None
        if hopper.flow_factor is None:
            steep = mass_flow_half_angle(inside, wall_friction=si(hopper.wall_friction))
        shear, slope = hopper.shear_friction or math.sin(inside), si(hopper.half_angle)
        return cls(length, initial, flow, after_filling, flowing, shear, rated, slope, steep, skirts)
