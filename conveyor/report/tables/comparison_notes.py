"""Notes on a comparison of compounds: what its ranking rests on, and where it changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from conveyor.loop.annual_energy import lacks_feed_in_price
from conveyor.remarks.assumptions import failed_fits
from conveyor.rubber.lots import LOT_SCATTER
from conveyor.rubber.rolling_test_factor import UNTESTED_FACTOR
from conveyor.studies.comparison import RankedPower
from conveyor.units import System
from conveyor.units.presentation import display_unit
from conveyor.units.sentences import degree_signs, percent

if TYPE_CHECKING:
    from conveyor.studies.comparison import CalculatedComparison, ComparedScene


def _untested_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on comparing compounds with rolling-resistance tests and without."""
    bare = [compound.name for compound in comparison.compounds if not compound.tests]
    if any(comparison.test_basis_differs(compound.name) for compound in comparison.compounds):
        told = ", ".join(f'"{name}"' for name in bare)
        yield (
            f"{told}: no rolling-resistance tests, which the others have: the indentation may be up to "
            f"{UNTESTED_FACTOR:g} "
            "times as much; no saving, price or rank beside tested compounds (compare by theory alone: "
            "calculation.anchor: off)"
        )


def _calibration_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on the calibration factor of the indentation, applied to all compounds."""
    given = comparison.conveyor.calculation.calibration
    factor = 1.0 if given is None else given.factors.get("indentation", 1.0)
    if factor != 1.0:
        yield (
            f"calculation.calibration: indentation x {factor:g} of every compound, a factor found with the belt that "
            "ran. What of it is that belt's rubber the others do not have: their power without it is that of conveyor "
            "power with their compound and calculation.calibration.indentation: 1"
        )


def _temperature_notes(comparison: CalculatedComparison, system: System) -> Iterator[str]:
    """Notes on the temperatures compared at each speed."""
    asked = {s.temperature for s in comparison.scenes} | {row.temperature for row in comparison.refused}
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        run = display_unit("speed", system).said(speed, 4)
        common, known = comparison.common(speed), {s.compound for s in comparison.covered if s.speed == speed}
        if comparison.base not in known or (len(known) < 2 < 1 + len(comparison.compounds)):
            yield f"at {run} nothing is compared: the data of the base, or of all others, do not reach"
        elif not common:
            yield f"at {run} nothing is compared: no temperature that the data of all compounds reach"
        elif len(common) < len(asked):
            at = _temperature_list(common, system)
            yield f"at {run} the comparison stands at {at}, which the data of all compounds in it reach"


def comparison_notes(comparison: CalculatedComparison, system: System = "SI") -> tuple[str, ...]:
    """Notes of a comparison in a system of units: conditions and assumptions."""
    lines = [
        *failed_fits(comparison.compounds),
        *_temperature_notes(comparison, system),
        *_tie_notes(comparison, system),
        *_untested_notes(comparison),
        *_strain_notes(comparison),
        *_calibration_notes(comparison),
        "power is compared at the take-up that the expected friction asks for; conveyor power sets it for the friction "
        "to design for, which holds the belt tauter: its power differs by up to a per cent",
    ]
    for compound in comparison.compounds:
        if compound.kind == "illustrative":
            said = "is illustrative, not measured: for comparison, not for design"
            lines.append(f'compound "{compound.name}" {said}')
        rows = [row for row in comparison.coverage if row.compound == compound.name and not row.covered]
        if rows:
            at = _temperature_list([row.temperature for row in rows], system)
            lacking = "do not cover what the rolls excite" if compound.range else "state no range, it counts for none"
            lines.append(f'compound "{compound.name}": its data {lacking} at {at}: not averaged, ranked, priced')
        reasons = {row.reason: row for row in comparison.refused if row.compound == compound.name}
        lines.extend(f'compound "{compound.name}": no answer for some scenes: {reason}' for reason in reasons)
    lines += ranking_changes(comparison, system)
    price = comparison.conveyor.operation is not None and comparison.conveyor.operation.price is not None
    if not price:
        lines.append("operation.price not given: no cost, saving or payback")
    elif not comparison.conveyor.drive.knows_mains:
        lines.append("energy and cost are those of the motors' shafts: drive.train has no part on the mains' side")
    fed_back = any(scene.motor < 0.0 for scene in comparison.scenes) or any(
        study.year.fed_back_kwh > 0.0 for study in comparison.years.values()
    )
    if fed_back and lacks_feed_in_price(comparison.conveyor.operation):
        lines.append("operation.feed_in_price not given: energy that is fed back earns nothing")
    if comparison.conveyor.duty:
        lines.append(
            "energy, cost and saving of a year are those of operation.duty, at the spec's own speed, their intervals "
            "at the loads and temperatures of its bars; no payback where the saving's interval holds zero"
        )
        lines += [
            f'compound "{compound.name}": a bar of operation.duty has no answer with it, or its data do not reach, '
            "so it has no year"
            for compound in comparison.compounds
            if compound.name not in comparison.years
        ]
    if comparison.conveyor.idlers.drag_follows_air:
        follow = "indentation and the drag of rolls without a given one follow the temperature"
    else:
        follow = "only indentation follows the temperature"
    lines.append(f"means over temperatures give each the same weight; {follow}")
    lines += [*_lot_notes(comparison), *_level_notes(comparison), *_scatter_notes(comparison)]
    return (*lines, *_band_notes(comparison))


def _tie_notes(comparison: CalculatedComparison, system: System) -> Iterator[str]:
    """Notes on compounds that cannot be told apart from the base, by the mean over temperatures."""
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        at = comparison.common(speed)
        means: dict[str, list[ComparedScene]] = {}
        for scene in comparison.covered:
            if scene.speed == speed and scene.temperature in at and not comparison.test_basis_differs(scene.compound):
                means.setdefault(scene.compound, []).append(scene)
        if comparison.base not in means:
            continue
        base = RankedPower.of(means.pop(comparison.base))
        alike = [
            name
            for name, scenes in means.items()
            if (ends := comparison.difference(RankedPower.of(scenes), base))[0] <= 0.0 <= ends[1]
        ]
        if alike:
            told = ", ".join(f'"{name}"' for name in alike)
            run = display_unit("speed", system).said(speed, 4)
            said = (
                f'{told} and the base "{comparison.base}" cannot be told apart at {run}: they differ by less than both '
            )
            if comparison.conveyor.duty:
                yield f"{said}may be off, on the mean of these temperatures"
            else:
                yield f"{said}may be off, so neither a saving nor a payback is shown by these data"


def _lot_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Notes on the scatter from lot to lot that intervals hold, and where it is a default."""
    taken = [name for name, lot in comparison.lots.items() if lot.origin == "default"]
    if taken:
        told = ", ".join(f'"{name}"' for name in taken)
        yield (
            f"{told}: scatter from lot to lot assumed, {percent(LOT_SCATTER)} of the indentation; state the maker's in "
            "the compound file (lot_scatter) or with --lot-scatter"
        )
    stated = {name: lot for name, lot in comparison.lots.items() if lot.origin != "default"}
    for name, lot in stated.items():
        yield f'compound "{name}": {percent(lot.half_width, 1)} of indentation from lot to lot, as stated'


def _level_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on differences of compounds without tests: their common level is left out."""
    tests = comparison.conveyor.calculation.anchor == "tests"
    if tests and not any(compound.tests for compound in comparison.compounds):
        yield (
            "no rolling-resistance tests given: with their test factor every indentation, and so every difference and "
            f"saving, may be up to {UNTESTED_FACTOR:g} times as much; which compound needs less does not depend on it"
        )


def _strain_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on comparing compounds with strain sweeps and without: what strain does to both does not cancel."""
    bare = [compound.name for compound in comparison.compounds if compound.strain_dependence is None]
    used = comparison.conveyor.calculation.strain != "off"
    if used and bare and len(bare) < len(comparison.compounds):
        told = ", ".join(f'"{name}"' for name in bare)
        yield (
            f"{told}: no strain sweeps, which the others have: taken at the strain of the master curve, where filled "
            "rubber costs less than under the rolls (8 to 17 % on S100); that is in no interval: measure sweeps, or "
            "compare all without (calculation.strain: off)"
        )


def _scatter_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Notes on compounds without replicas and tests."""
    for compound in comparison.compounds:
        tested = compound.tests and comparison.conveyor.calculation.anchor == "tests"
        if compound.prony.band is None and not tested:
            yield f'compound "{compound.name}" has no band of its data: its intervals hold the scatter of lots alone'


def _band_notes(comparison: CalculatedComparison) -> Iterator[str]:
    """Note on the bands, which are narrower than the interval of `conveyor power`."""
    if comparison.scenes:
        yield (
            "90 % bands are of the rubber alone: its data, its tests, its lots; the interval of conveyor power has "
            "what is left to defaults, too. One rank: the difference is less than both may be off, without what belts "
            "tested alike have in common; intervals of difference, saving and payback likewise"
        )


def ranking_changes(comparison: CalculatedComparison, system: System = "SI") -> list[str]:
    """Notes on speeds whose ranking changes with temperature or has ties, with the order at each."""
    lines = []
    for speed in sorted({scene.speed for scene in comparison.scenes}):
        shared: dict[float, list[ComparedScene]] = {t: [] for t in comparison.common(speed)}
        for scene in comparison.covered:
            if scene.speed != speed or comparison.test_basis_differs(scene.compound):
                continue
            if scene.temperature in shared:
                shared[scene.temperature].append(scene)
        grouped = {
            warmth: comparison.groups(RankedPower.of([scene]) for scene in row) for warmth, row in shared.items()
        }
        by_order: dict[tuple[frozenset[str], ...], list[float]] = {}
        for warmth, groups in grouped.items():
            by_order.setdefault(tuple(frozenset(one.compound for one in group) for group in groups), []).append(warmth)
        together = any(len(group) > 1 for groups in grouped.values() for group in groups)
        if len(by_order) > 1 or together:
            run = display_unit("speed", system).said(speed, 4)
            orders = (
                f"{_temperature_list(warm, system)}: {_order_text(grouped[warm[0]])}" for warm in by_order.values()
            )
            said = "the ranking changes with temperature" if len(by_order) > 1 else "the ranking at a temperature"
            lines.append(f"{said}; least motor power first, at {run}: {'; '.join(orders)}")
    return lines


def _order_text(groups: Sequence[Sequence[RankedPower]]) -> str:
    """Order of the compounds in words, ties named."""
    return ", then ".join(
        group[0].compound
        if len(group) == 1
        else f"{', '.join(one.compound for one in group[:-1])} and {group[-1].compound}, which cannot be told apart"
        for group in groups
    )


def _temperature_list(temperatures: Sequence[float], system: System) -> str:
    """List of temperatures [K] as text, the unit at the end."""
    shown = display_unit("temperature", system)
    return f"{', '.join(f'{value:.4g}' for value in shown(temperatures).tolist())} {degree_signs(shown.label or '')}"
