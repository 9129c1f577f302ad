"""A comparison of compounds as tables: pandas, units in the names. Column names are stable."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

import pandas as pd

from conveyor.figures import celsius
from conveyor.loop.year import earns_nothing
from conveyor.units import si

if TYPE_CHECKING:
    from conveyor.studies.comparison import Comparison, Scene


def scenes(comparison: Comparison) -> pd.DataFrame:
    """One row a scene, in the order compound, speed, temperature."""
    currency = _currency(comparison)
    rows = [
        {
            "compound": scene.compound,
            "temperature [degC]": celsius(scene.temperature),
            "belt speed [m/s]": scene.speed,
            "indentation [N]": scene.indentation,
            "effective tension [N]": scene.effective,
            "equivalent DIN f [-]": scene.friction_factor,
            "motor power [kW]": scene.motor / 1e3,
            "motor power, low [kW]": _kilo(scene.motor_low),
            "motor power, high [kW]": _kilo(scene.motor_high),
            "largest tension [N]": scene.largest_tension,
            "energy [kWh/(t km)]": scene.energy_per_tonne_km,
            "energy per year [MWh]": _kilo(scene.energy_per_year),
            f"cost per year [{currency}]": scene.cost_per_year,
            "error estimate [-]": scene.error,
        }
        for scene in comparison.scenes
    ]
    return _answered(pd.DataFrame(rows))


def _kilo(value: float | None) -> float | None:
    return None if value is None else value / 1e3


def _currency(comparison: Comparison) -> str:
    operation = comparison.conveyor.operation
    return "-" if operation is None or operation.price is None else operation.price.currency


def _answered(frame: pd.DataFrame) -> pd.DataFrame:
    """Without the columns that no row fills."""
    return frame.dropna(axis="columns", how="all")


def ranking(comparison: Comparison) -> pd.DataFrame:
    """One row a compound and speed, the least mean power of each speed first.

    Means are over the temperatures that every compound has an answer for at that speed, each of the same weight; the
    peak is the largest over all answered ones: the cold start of the rubber.
    """
    rows = [
        row
        for speed in dict.fromkeys(s.speed for s in comparison.scenes)
        for row in _ranked(comparison, speed)
    ]
    return _answered(pd.DataFrame(rows))


def _ranked(comparison: Comparison, speed: float) -> list[dict[str, object]]:
    by_compound: dict[str, dict[float, Scene]] = {}
    for scene in comparison.scenes:
        if scene.speed == speed:
            by_compound.setdefault(scene.compound, {})[scene.temperature] = scene
    common = set.intersection(*(set(found) for found in by_compound.values()))
    means = {name: [found[t] for t in sorted(common)] for name, found in by_compound.items()}
    base = means.get(comparison.base, [])
    order = sorted(by_compound, key=lambda name: _mean([s.motor for s in means[name]]) or 0.0)
    return [_row(comparison, (name, speed), by_compound[name], means[name], base) for name in order]


def _row(
    comparison: Comparison,
    key: tuple[str, float],
    found: dict[float, Scene],
    at: list[Scene],
    base: list[Scene],
) -> dict[str, object]:
    name, speed = key
    currency = _currency(comparison)
    (energy, cost), (_, before) = (
        _year(comparison, other, speed, group) for other, group in ((name, at), (comparison.base, base))
    )
    saved = None if cost is None or before is None else before - cost
    extra = comparison.extra_costs.get(name)
    peak = max(found.values(), key=lambda scene: scene.motor)
    motor, motor_before = (_mean([s.motor for s in group]) for group in (at, base))
    return {
        "compound": name,
        "belt speed [m/s]": speed,
        "temperatures averaged": len(at),
        "mean indentation [N]": _mean([s.indentation for s in at]),
        "mean motor power [kW]": _kilo(motor),
        "mean motor power, low [kW]": _kilo(_mean([s.motor_low for s in at])),
        "mean motor power, high [kW]": _kilo(_mean([s.motor_high for s in at])),
        "motor power against base [-]": None if not motor or not motor_before else motor / motor_before - 1.0,
        "peak motor power [kW]": peak.motor / 1e3,
        "at temperature [degC]": celsius(peak.temperature),
        "energy per year [MWh]": _kilo(energy),
        f"cost per year [{currency}]": cost,
        f"saving per year [{currency}]": saved,
        f"extra cost of the belt [{currency}]": extra,
        "payback [a]": None if extra is None or saved is None or saved <= 0.0 else extra / saved,
    }


def _year(
    comparison: Comparison, name: str, speed: float, at: list[Scene]
) -> tuple[float | None, float | None]:
    """Energy [kWh] and cost of a year: of the duty, where there is one, at the spec's speed; else of all hours."""
    if not comparison.conveyor.duty:
        return _mean([s.energy_per_year for s in at]), _mean([s.cost_per_year for s in at])
    study = comparison.years.get(name) if speed == si(comparison.conveyor.belt.speed) else None
    return (None, None) if study is None else (study.year.net_kwh, study.cost)


def _mean(values: list[float] | list[float | None]) -> float | None:
    """Mean; None of nothing, or where one is not known."""
    known = [value for value in values if value is not None]
    return math.fsum(known) / len(known) if known and len(known) == len(values) else None


def coverage(comparison: Comparison) -> pd.DataFrame:
    """What the rolls ask of each compound at each temperature, and what its data hold."""
    return pd.DataFrame(
        [
            {
                "compound": row.compound,
                "temperature [degC]": celsius(row.temperature),
                "excited from [Hz]": row.excited[0],
                "excited to [Hz]": row.excited[1],
                "data from [Hz]": None if row.data is None else row.data[0],
                "data to [Hz]": None if row.data is None else row.data[1],
                "covered": "yes" if row.covered else "NO",
            }
            for row in comparison.coverage
        ]
    )


def refused(comparison: Comparison) -> pd.DataFrame:
    """Scenes without an answer, and why."""
    return pd.DataFrame(
        [
            {
                "compound": row.compound,
                "temperature [degC]": celsius(row.temperature),
                "belt speed [m/s]": row.speed,
                "reason": row.reason,
            }
            for row in comparison.refused
        ],
        columns=["compound", "temperature [degC]", "belt speed [m/s]", "reason"],
    )


def remarks(comparison: Comparison) -> tuple[str, ...]:
    """What to know of a comparison before believing it."""
    lines = []
    for compound in comparison.compounds:
        if compound.kind == "illustrative":
            lines.append(f'compound "{compound.name}" is illustrative, not measured: no choice rests on it')
        rows = [row for row in comparison.coverage if row.compound == compound.name and not row.covered]
        if rows:
            at = _listed([celsius(row.temperature) for row in rows])
            lines.append(
                f'compound "{compound.name}": its data do not cover what the rolls excite at {at} degC'
            )
        reasons = {row.reason: row for row in comparison.refused if row.compound == compound.name}
        lines.extend(f'compound "{compound.name}": no answer for some scenes: {reason}' for reason in reasons)
    lines += turned(comparison)
    price = comparison.conveyor.operation is not None and comparison.conveyor.operation.price is not None
    if not price:
        lines.append("operation.price not given: no cost, saving or payback")
    elif not comparison.conveyor.drive.knows_mains:
        lines.append(
            "energy and cost are those of the motors' shafts: drive.train has no part on the mains' side"
        )
    fed_back = any(scene.motor < 0.0 for scene in comparison.scenes) or any(
        study.year.fed_back_kwh > 0.0 for study in comparison.years.values()
    )
    if fed_back and earns_nothing(comparison.conveyor.operation):
        lines.append("operation.feed_in_price not given: energy that is fed back earns nothing")
    if comparison.conveyor.duty:
        lines.append("energy, cost and saving of a year are those of operation.duty, at the spec's own speed")
        lines += [
            f'compound "{compound.name}": a bar of operation.duty has no answer with it, so it has no year'
            for compound in comparison.compounds
            if compound.name not in comparison.years
        ]
    lines.append(
        "means over temperatures give each the same weight; only indentation follows the temperature"
    )
    return tuple(lines)


def turned(comparison: Comparison) -> list[str]:
    """Speeds at which the ranking is another at another temperature, beyond the errors; the order at each."""
    lines = []
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        at: dict[float, list[Scene]] = {}
        for scene in sorted(comparison.scenes, key=lambda s: (s.temperature, s.motor)):
            if scene.speed == speed:
                at.setdefault(scene.temperature, []).append(scene)
        shared = {warmth: row for warmth, row in at.items() if len(row) == len(comparison.compounds)}
        before = {
            (one.compound, other.compound)
            for row in shared.values()
            for one, other in combinations(row, 2)
            if other.motor - one.motor > one.error * abs(one.motor) + other.error * abs(other.motor)
        }
        if any((second, first) in before for first, second in before):
            by_order: dict[tuple[str, ...], list[float]] = {}
            for warmth, row in shared.items():
                by_order.setdefault(tuple(s.compound for s in row), []).append(celsius(warmth))
            orders = (f"{_listed(warm)} degC: {' < '.join(order)}" for order, warm in by_order.items())
            lines.append(
                f"the ranking turns with the temperature; motor power at {speed:g} m/s: {'; '.join(orders)}"
            )
    return lines


def _listed(values: list[float]) -> str:
    return ", ".join(f"{value:g}" for value in values)


def to_dict(comparison: Comparison) -> dict[str, object]:
    """Plain numbers for JSON; units in the keys."""
    return {
        "conveyor": comparison.conveyor.name,
        "base": comparison.base,
        "cover": comparison.cover,
        "ranking": _records(comparison.ranking),
        "scenes": _records(comparison.table),
        "coverage": _records(coverage(comparison)),
        "refused": _records(refused(comparison)),
        "warnings": list(remarks(comparison)),
    }


def _records(frame: pd.DataFrame) -> list[dict[str, object]]:
    """Rows with None where a figure is not known."""
    rows = frame.astype(object).where(frame.notna(), None).to_dict("records")
    return [{str(name): value for name, value in row.items()} for row in rows]
