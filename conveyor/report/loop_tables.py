"""Tensions, drives, take-up, start and stop, belt checks as tables: pandas, units in the names."""

from __future__ import annotations

import math

import pandas as pd

from conveyor.laws.motion import Stop
from conveyor.laws.take_up import mean_tension, take_up_mass
from conveyor.loop.balance import Balance
from conveyor.loop.belt_duty import BeltDuty
from conveyor.loop.curved import Convergence
from conveyor.loop.starting import Motions
from conveyor.models import Conveyor
from conveyor.units import si


def tension_states(found: Balance, moving: Motions | None = None) -> pd.DataFrame:
    """Tension at both ends of every stretch in every state, in loop order from the head."""
    settled = found.settled
    geometry = settled.loop.geometry
    states = settled.states | ({} if moving is None else moving.states)
    rows: dict[str, list[object]] = {
        "section": [stretch.section for stretch in geometry.stretches for _ in (0, 1)],
        "strand": [stretch.strand for stretch in geometry.stretches for _ in (0, 1)],
        "end": [end for _ in geometry.stretches for end in ("start", "end")],
        "distance from head [m]": [
            way for i in range(len(geometry.length)) for way in geometry.way[i : i + 2].tolist()
        ],
        "least for sag [N]": [least for least in geometry.least.tolist() for _ in (0, 1)],
    }
    for name, state in states.items():
        rows[f"{name} [N]"] = [
            t for pair in zip(state.starts.tolist(), state.ends.tolist(), strict=True) for t in pair
        ]
    return pd.DataFrame(rows)


def profile(conveyor: Conveyor) -> pd.DataFrame:
    """The route from the tail: one row a boundary of sections, horizontal distance and height over the tail."""
    along, across, up = 0.0, 0.0, 0.0
    rows = [{"behind section": "", "along the belt [m]": 0.0, "horizontal [m]": 0.0, "height [m]": 0.0}]
    for section in conveyor.route.sections:
        length = si(section.length)
        along, across, up = along + length, across + math.sqrt(length**2 - section.rise**2), up + section.rise
        rows.append(
            {
                "behind section": section.name,
                "along the belt [m]": along,
                "horizontal [m]": across,
                "height [m]": up,
            }
        )
    return pd.DataFrame(rows)


def drives(found: Balance) -> pd.DataFrame:
    """One row a drive and state: force, power, tensions before and behind, grip used."""
    data = found.settled.loop.data
    rows = []
    for state in found.settled.states.values():
        for drive, side in zip(data.drives, state.drives, strict=True):
            ratio = math.inf if side.slack <= 0.0 else side.tight / side.slack
            rows.append(
                {
                    "drive": drive.name,
                    "state": state.name,
                    "force [N]": side.force,
                    "motor power at full speed [kW]": data.motor(side.force) / 1e3,
                    "installed power [kW]": None if drive.power is None else drive.power / 1e3,
                    "arriving [N]": side.arriving,
                    "leaving [N]": side.leaving,
                    "tension ratio [-]": ratio,
                    "grip limit [-]": math.exp(drive.friction * drive.wrap_angle),
                }
            )
    return pd.DataFrame(rows)


def take_up(found: Balance) -> pd.Series:
    """Setting of the take-up, what asks for it, its mass or pull."""
    settled = found.settled
    data, geometry = settled.loop.data, settled.loop.geometry
    steady = settled.steady
    means = 0.5 * (steady.starts + steady.ends)
    rows: dict[str, object] = {
        "kind": data.take_up.kind,
        "setting [N]": settled.setting,
        "least setting [N]": settled.needed,
        "governed by": settled.condition_name(settled.governed_by),
        "mean tension of the loop [N]": mean_tension(means.tolist(), lengths=geometry.length.tolist()),
    }
    if data.take_up.kind != "fixed":
        mass = take_up_mass(max(settled.setting, 0.0), reeving=data.take_up.reeving, gravity=data.gravity)
        rows["mass of a gravity take-up [kg]"] = mass
        rows["pull on the rope of a winch [N]"] = mass * data.gravity
    return pd.Series(rows, name="take-up", dtype=object)


def conditions(found: Balance) -> pd.DataFrame:
    """Every condition on the tensions and the setting of the take-up it asks for, the governing one first."""
    items = sorted(found.settled.conditions.items(), key=lambda item: -item[1])
    table = pd.DataFrame(items, columns=["condition", "setting it asks for [N]"])
    table["margin [N]"] = found.settled.setting - table["setting it asks for [N]"]
    return table


def start_stop(moving: Motions) -> pd.Series:
    """Start, stop, brakes and the limits of the bulk."""
    start = moving.start
    rows: dict[str, float | None] = {
        "moving mass [kg]": moving.moving_mass,
        "rotating mass of the drives [kg]": moving.rotating_mass,
        "drive force at start [N]": start.force,
        "acceleration at start [m/s²]": start.acceleration,
        "time over the whole speed range [s]": start.time,
        "motor torque at start over rated [-]": start.torque_factor,
        "force the motors give [N]": start.available,
        "resistance after standstill, at most [N]": start.breakaway,
    }
    for label, found in (
        ("drives off", moving.coasting),
        ("drives off, least friction", moving.coasting_least),
        ("brakes on, least friction", moving.braked),
    ):
        rows |= _stop(label, found)
    rows["brake for the deceleration wanted [N]"] = moving.brake_to_stop
    rows["backstop to hold [N]" if moving.rolls_back else "brake to hold [N]"] = moving.brake_to_hold
    if moving.slip is not None:
        rows["hardest braking before the bulk slides [m/s²]"] = -moving.slip.braking
        rows["highest acceleration before the bulk slides [m/s²]"] = moving.slip.starting
    given = {name: value for name, value in rows.items() if value is not None}
    return pd.Series(given, name="start and stop", dtype=float)


def _stop(label: str, found: Stop | None) -> dict[str, float | None]:
    if found is None:
        return {}
    return {
        f"deceleration, {label} [m/s²]": found.deceleration,
        f"stopping time, {label} [s]": found.time,
        f"stopping distance, {label} [m]": found.distance,
    }


def belt(duty: BeltDuty) -> pd.Series:
    """Strength of the belt; figures without which a row has no answer are left out with it."""
    rows = {
        "largest tension, steady [N]": duty.largest_steady,
        "largest tension, all states [N]": duty.largest,
        "safety, steady [-]": duty.safety_steady,
        "safety, all states [-]": duty.safety,
        "classic safety asked for [-]": duty.safety_needed,
        "strength the splice asks for [N/mm]": None
        if duty.strength_needed is None
        else duty.strength_needed / 1e3,
        "least diameter of drive pulleys [mm]": None
        if duty.drive_diameter is None
        else 1e3 * duty.drive_diameter,
    }
    given = {name: value for name, value in rows.items() if value is not None}
    return pd.Series(given, name="belt", dtype=float)


def pulleys(duty: BeltDuty) -> pd.DataFrame:
    """One row a pulley: its diameter beside the least one."""
    return pd.DataFrame(
        [
            {
                "pulley": pulley.name,
                "position": pulley.position,
                "group": pulley.group,
                "diameter [mm]": 1e3 * pulley.diameter,
                "least [mm]": 1e3 * pulley.least,
                "of the series [mm]": None if pulley.next_size is None else 1e3 * pulley.next_size,
                "large enough": pulley.large_enough,
            }
            for pulley in duty.pulleys
        ]
    )


def curves(duty: BeltDuty) -> pd.DataFrame:
    """One row a vertical curve and strand: its radius beside the least ones."""
    return pd.DataFrame(
        [
            {
                "section": curve.section,
                "strand": curve.strand,
                "curve": curve.kind,
                "radius [m]": curve.radius,
                "lowest tension [N]": curve.lowest,
                "highest tension [N]": curve.highest,
                "least against lift-off [m]": curve.lift_off,
                "least against overstress [m]": curve.overstress,
                "least against slack strips [m]": curve.buckling,
            }
            for curve in duty.curves
        ]
    )


def convergence(found: Convergence | None) -> pd.Series:
    """How tensions and roll loads settled on the curves; empty without curves."""
    rows: dict[str, float] = {}
    if found is not None:
        rows = {
            "steps": float(found.steps),
            "last change over largest tension [-]": found.change,
            "ratio of changes [-]": found.ratio,
            "bound over largest tension [-]": found.bound,
        }
    return pd.Series(rows, name="convergence", dtype=float)
