"""Quantities with units, their kinds, and numbers as text."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from conveyor.units.quantity_kinds import KINDS
from conveyor.units.unit_systems import System

if TYPE_CHECKING:
    from conveyor.units.quantities import (
        Acceleration,
        Angle,
        AreaMass,
        BeltMass,
        BendingStiffness,
        Bounds,
        Density,
        Distance,
        Duration,
        Force,
        ForcePerRotation,
        Fraction,
        Frequency,
        Heat,
        Inertia,
        Length,
        LineForce,
        Mass,
        MassFlow,
        Measure,
        Modulus,
        MolarEnergy,
        Moment,
        Power,
        Pressure,
        Quantity,
        Rotation,
        SetMass,
        Speed,
        SpringRate,
        Temperature,
        TemperatureDifference,
        Thickness,
        Time,
        Torque,
        Viscosity,
        WindSpeed,
        from_si,
        interpolate_quantity,
        is_kind,
        is_quantity,
        quantity,
        read_si,
        same_value,
        si,
        si_with_unit,
        spec_value,
        text,
        unit_system,
    )
else:

    def __getattr__(name: str) -> Any:
        return getattr(import_module("conveyor.units.quantities"), name)  # pint only where a quantity is read
