"""What a reader of the results must know: the assumptions behind every figure, and warnings where one is strained."""

from __future__ import annotations

from collections.abc import Iterator

from conveyor.figures import figure
from conveyor.indentation import IndentationCurve
from conveyor.line.stretches import Strand
from conveyor.line.walk import RollResult, StretchResult, excited_band
from conveyor.loop.balance import Balance
from conveyor.loop.year import earns_nothing
from conveyor.models import Conveyor, RubberCompound
from conveyor.remarks.loop import loop_warnings
from conveyor.remarks.rolls import roll_assumptions, roll_warnings
from conveyor.units import Quantity, si, text

DEEP = 0.2  # Δ/h beyond which a linear small-strain cover is a stretch of the law; strain is about Δ/h


def assumptions(conveyor: Conveyor) -> tuple[str, ...]:
    """What every figure of an analysis rests on, in words."""
    support = {
        "confined": "the cover is bonded to a carcass that does not give (a real belt differs by 1 to 8 %)",
        "free": "the cover is a free layer that bends between the rolls (the paper's belt)",
        "half-space": "the cover is endlessly thick",
    }[conveyor.calculation.support]
    return (
        "Rubber is linearly viscoelastic at the strain its data were measured at; Poisson's ratio is constant.",
        f"Contact is plane strain, frictionless, steady, on cylinders in line: {support}.",
        "Error estimates are those of the indentation resistance; peak pressures are good to about 0.1 % "
        "at the default tolerance.",
        *roll_assumptions(conveyor),
        "Bearings of the driven pulleys (at each drive's place the most wrapped, as many as it stands for) are in the "
        "drive's efficiency; tension changes the load of the rolls on "
        "vertical curves only.",
        f"Covers are at {text(conveyor.ambient.belt)} throughout.",
        *_energy(conveyor),
    )


def _energy(conveyor: Conveyor) -> Iterator[str]:
    if conveyor.operation is not None and not conveyor.drive.knows_mains:
        yield (
            "Energy and cost are those of the motors' shafts: drive.train has no part between mains and motor shaft, "
            "such as the motor itself or a converter."
        )


def warnings(conveyor: Conveyor, results: tuple[StretchResult, ...], found: Balance) -> tuple[str, ...]:
    """Where an assumption is strained, a default stands in, or a figure needs a second look."""
    return tuple(
        dict.fromkeys(
            (
                *_rubber(conveyor),
                *_frequency(conveyor, results),
                *_strain(conveyor, results),
                *_contact(conveyor, results),
                *roll_warnings(conveyor, results),
                *_left_out(conveyor),
                *_loop(conveyor, found),
                *loop_warnings(conveyor, results, found),
            )
        )
    )


def _compounds(conveyor: Conveyor) -> dict[Strand, RubberCompound]:
    return {"carry": conveyor.carry_compound, "return": conveyor.return_compound}


def _rubber(conveyor: Conveyor) -> Iterator[str]:
    for strand, compound in _compounds(conveyor).items():
        if compound.kind == "illustrative":
            yield f'compound "{compound.name}" is illustrative, not measured: compare with it, do not design with it'
        if strand == "return" and conveyor.belt.top_cover.compound is None and not conveyor.route.turned_over:
            yield f'top_cover.compound is not given: the return rolls run on the bottom cover\'s, "{compound.name}"'
        if compound.missing and compound.kind == "measured":
            yield f'compound "{compound.name}": not known are {"; ".join(compound.missing)}'


def _frequency(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> Iterator[str]:
    """The band in which the contacts lose their energy, against the data's at the belt's temperature."""
    for strand, compound in _compounds(conveyor).items():
        band = excited_band(results, strand)
        data = compound.frequencies(si(conveyor.ambient.belt))
        if band is None or data is None:
            continue
        if band[0] < data[0] or band[1] > data[1]:
            yield (
                f'compound "{compound.name}": nine tenths of the {strand} rolls\' loss lie between {band[0]:.3g} and '
                f"{band[1]:.3g} Hz, its data cover {data[0]:.3g} to {data[1]:.3g} Hz at {text(conveyor.ambient.belt)}: "
                "the series is extrapolated"
            )


def _strain(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> Iterator[str]:
    """At which strain the moduli were taken, where the compound knows what strain does to it."""
    for strand, compound in _compounds(conveyor).items():
        known = compound.strain_dependence
        if known is None:
            continue
        worked = next(r.surface.strain for r in results if r.stretch.strand == strand)
        if worked is not None:
            note = f" ({known.reference_note})" if known.reference_note else ""
            yield (
                f'compound "{compound.name}": the {strand} rolls work it at {worked.strain:.2%} strain, '
                f"{worked.frequency:.3g} Hz: E' taken {worked.storage_factor:.3f} and E'' {worked.loss_factor:.3f} "
                f"times those at the master curve's {text(known.reference_strain)}{note}"
            )
        elif conveyor.calculation.strain == "off":
            yield f'compound "{compound.name}": calculation.strain is off, its strain sweeps are not used'
        else:
            reached = " to ".join(text(sweep.temperature) for sweep in (known.sweeps[0], known.sweeps[-1]))
            yield (
                f'compound "{compound.name}": its strain sweeps ({reached}) do not reach '
                f"{text(conveyor.ambient.belt)}: taken as linear, at the strain of its master curve"
            )


def _contact(conveyor: Conveyor, results: tuple[StretchResult, ...]) -> Iterator[str]:
    support = conveyor.calculation.support
    if support != "confined":
        yield (
            f'calculation.support is "{support}": a real cover is bonded to a carcass far stiffer than rubber, '
            '"confined" is meaningful for it; use this one to compare with the paper'
        )
    covers: dict[Strand, Quantity] = {
        "carry": conveyor.belt.bottom_cover.thickness,
        "return": conveyor.return_cover_thickness,
    }
    for strand, thickness in covers.items():
        deepest = _deepest(results, strand) / si(thickness)
        if deepest > DEEP:
            yield (
                f"{strand} rolls press in by {deepest:.0%} of the cover ({text(thickness)}): "
                "beyond small strain, the linear law is strained"
            )


def _deepest(results: tuple[StretchResult, ...], strand: Strand) -> float:
    """Largest penetration of a strand's rolls [m]: of each contact at its highest load, the depth grows with it."""
    highest: dict[IndentationCurve, RollResult] = {}
    for r in results:
        if r.stretch.strand == strand:
            for roll in r.rolls:
                known = highest.setdefault(roll.curve, roll)
                if roll.load.peak_line_load > known.load.peak_line_load:
                    highest[roll.curve] = roll
    return max(float(roll.peak.penetration) for roll in highest.values())


def _left_out(conveyor: Conveyor) -> Iterator[str]:
    route = conveyor.route
    if conveyor.calculation.secondary == "itemised":
        if not route.pulleys:
            yield "route.pulleys not given: wraps and pulley bearings are not in the figures"
        elif conveyor.belt.carcass.kind == "steel cord":
            yield "wrap of a steel-cord belt: coefficients are general knowledge, not read in the standard"
        if route.feeding is None and si(conveyor.material.flow) > 0.0:
            yield "route.feeding not given: acceleration of the bulk and skirts are not in the figures"
    if not route.cleaners:
        yield "route.cleaners not given: no cleaner in the figures"


def _loop(conveyor: Conveyor, found: Balance) -> Iterator[str]:
    units = conveyor.report.units
    if found.power.mains < 0.0 and earns_nothing(conveyor.operation):
        yield "operation.feed_in_price not given: energy that is fed back earns nothing"
    installed = None if conveyor.drive.further_drives else conveyor.drive.installed_power
    if installed is not None and abs(found.power.motor) > si(installed):
        yield f"the motor needs {figure(found.power.motor, 'power', units)}, installed are {text(installed)}"
    strength = conveyor.belt.carcass.strength
    if strength is not None:
        safety = si(strength) * si(conveyor.belt.width) / found.tensions.largest
        if safety < 1.0:
            largest = figure(found.tensions.largest, "force", units)
            yield f"the belt's strength is exceeded: safety {safety:.2f} at {largest}"
