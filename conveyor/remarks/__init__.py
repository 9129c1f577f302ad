"""What a reader of the results must know: the assumptions behind every figure, and warnings where one is strained."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from conveyor.checks import Check
from conveyor.line.covers import compounds_by_strand
from conveyor.loop.year import earns_nothing
from conveyor.models import Conveyor
from conveyor.pipeline import CalculatedConveyor
from conveyor.remarks.rolls import roll_assumptions, roll_warnings
from conveyor.units import text
from conveyor.units.sentences import Said, quoted, said


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


def warnings(found: CalculatedConveyor, checked: Iterable[Check]) -> tuple[Said, ...]:
    """Where an assumption is strained, a default stands in, a criterion is not met, or a figure needs a second look."""
    conveyor = found.conveyor
    return tuple(
        dict.fromkeys(
            (
                *_rubber(conveyor),
                *_strain(found),
                *_contact(conveyor),
                *roll_warnings(found),
                *_left_out(found),
                *_drive(found),
                *(
                    _of_case(check, check.why)
                    for check in checked
                    if check.verdict != "pass" and check.why is not None
                ),
            )
        )
    )


def _of_case(check: Check, why: Said) -> Said:
    if check.case is None:
        return why
    return Said(f"{check.case.words}: {why.words}", check.case.figures + why.figures)


def _rubber(conveyor: Conveyor) -> Iterator[Said]:
    for strand, compound in compounds_by_strand(conveyor).items():
        name = quoted(compound.name)
        if compound.kind == "illustrative":
            yield said(
                f'compound "{name}" is illustrative, not measured: compare with it, do not design with it'
            )
        if strand == "return" and conveyor.belt.top_cover.compound is None and not conveyor.route.turned_over:
            yield said(
                f'top_cover.compound is not given: the return rolls run on the bottom cover\'s, "{name}"'
            )
        if compound.missing and compound.kind == "measured":
            yield said(f'compound "{name}": not known are {quoted("; ".join(compound.missing))}')


def _strain(found: CalculatedConveyor) -> Iterator[Said]:
    """At which strain the moduli were taken, where the compound knows what strain does to it."""
    for strand, compound in compounds_by_strand(found.conveyor).items():
        known, name = compound.strain_dependence, quoted(compound.name)
        if known is None:
            continue
        worked = found.contacts.covers[strand].strain
        if worked is not None:
            note = f" ({quoted(known.reference_note)})" if known.reference_note else ""
            yield said(
                f'compound "{name}": the {strand} rolls work it at {worked.strain:.2%} strain, '
                f"{worked.frequency:.3g} Hz: E' taken {worked.storage_factor:.3f} and E'' {worked.loss_factor:.3f} "
                f"times those at the master curve's {text(known.reference_strain)}{note}"
            )
        elif not found.line.softened:
            yield said(f'compound "{name}": calculation.strain is off, its strain sweeps are not used')
        else:
            reached = " to ".join(text(sweep.temperature) for sweep in (known.sweeps[0], known.sweeps[-1]))
            yield said(
                f'compound "{name}": its strain sweeps ({reached}) do not reach '
                f"{text(found.conveyor.ambient.belt)}: taken as linear, at the strain of its master curve"
            )


def _contact(conveyor: Conveyor) -> Iterator[Said]:
    support = conveyor.calculation.support
    if support != "confined":
        yield said(
            f'calculation.support is "{support}": a real cover is bonded to a carcass far stiffer than rubber, '
            '"confined" is meaningful for it; use this one to compare with the paper'
        )


def _left_out(found: CalculatedConveyor) -> Iterator[Said]:
    line = found.line
    if line.secondary == "itemised":
        if not line.pulleys:
            yield said("route.pulleys not given: wraps and pulley bearings are not in the figures")
        elif line.belt.steel_cord:
            yield said(
                "wrap of a steel-cord belt: coefficients are general knowledge, not read in the standard"
            )
        if not line.loading and line.flow > 0.0:
            yield said("route.feeding not given: acceleration of the bulk and skirts are not in the figures")
    if not line.scrapers:
        yield said("route.cleaners not given: no cleaner in the figures")


def _drive(found: CalculatedConveyor) -> Iterator[Said]:
    drive, balance = found.conveyor.drive, found.balance
    if balance.settled.least_force < 0.0:
        given = "least_friction" in drive.model_fields_set
        source = "" if given else ", general knowledge: f 0.012 downhill over 0.020"
        yield said(
            f"drive force {{}} where only {drive.certain_friction:.0%} of the friction is certain "
            f"(drive.least_friction{source}), {{}} as computed; grip and brakes are for the former",
            (balance.settled.least_force, "force"),
            (balance.forces.total, "force"),
        )
    if "start_factor" not in drive.model_fields_set:
        yield said(f"drive.start_factor not given: {drive.start_factor:g} assumed, 1.2 to 1.5 are usual")
    if balance.power.mains < 0.0 and earns_nothing(found.conveyor.operation):
        yield said("operation.feed_in_price not given: energy that is fed back earns nothing")
