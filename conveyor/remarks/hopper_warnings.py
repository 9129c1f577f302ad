"""Warnings on hoppers from which the belt pulls the bulk."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.laws.feeder import BIN_PRESSURE_RATIO
from conveyor.models import Conveyor
from conveyor.units.sentences import Message, message


def hopper_warnings(conveyor: Conveyor) -> Iterator[Message]:
    """Warnings on load factors and friction that a hopper does not have of its own."""
    hoppers = [point.hopper for point in conveyor.route.feeding_points if point.hopper is not None]
    if any(hopper.flow_factor is None for hopper in hoppers):
        yield message(
            "route.feeding.hopper.flow_factor not given: by the field of stress of a slot hopper in mass flow; funnel "
            "flow leaves more on the belt"
        )
    if any(hopper.initial_factor is None and hopper.bin_height is None for hopper in hoppers):
        yield message(
            "route.feeding.hopper.initial_factor and bin_height not given: the bulk as high as the hopper, no bin "
            "above it"
        )
    if any(hopper.bin_height is not None and hopper.bin_pressure_ratio is None for hopper in hoppers):
        ratio = BIN_PRESSURE_RATIO
        yield message(
            f"route.feeding.hopper.bin_pressure_ratio not given: {ratio.value:g} ({ratio.low:g} to {ratio.high:g}, "
            "general knowledge); less is more load after filling"
        )
    if any(hopper.gate_efficiency is None for hopper in hoppers):
        yield message(
            "route.feeding.hopper.gate_efficiency not given: the bulk moves with the belt under the gate; upper layers "
            "that slip take 0 to 25 % of that flow (general knowledge)"
        )
    if any(hopper.skirt_pressure_ratio is None for hopper in hoppers):
        yield message(
            "route.feeding.hopper.skirt_pressure_ratio not given: the bulk's friction on skirts between outlet and "
            "belt is left out (0.4 to 1, general knowledge)"
        )
    if any(hopper.shear_friction is None for hopper in hoppers):
        yield message(
            "route.feeding.hopper.shear_friction not given: the sine of internal_friction (0.8 to 1 times that, "
            "general knowledge)"
        )
