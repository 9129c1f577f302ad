"""What the load cases of a conveyor are checked for: the governing case against what is installed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from conveyor.figures import figure
from conveyor.loop.belt_duty import belt_duty
from conveyor.loop.settled import holds
from conveyor.report.verdicts import Check, verdict
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.studies.cases import CalculatedCases, CaseResult, Governing

_CASES = "load cases"


def case_checks(study: CalculatedCases, system: System) -> Iterator[Check]:
    """Check the load cases: answers, motors, take-up, slack belt, safety; the case that decides is named.

    Parameters
    ----------
    study : CalculatedCases
        Load cases with their results, at least one; friction between the ends of its band, to the safe side.
    system : {"SI", "US"}
        Units of what was found and asked for.
    """
    if study.refused:
        cases = len(study.results) + len(study.refused)
        yield Check(f"{_CASES}: answers", f"{len(study.results)} of {cases}", "all", "FAIL")
    if not study.results:
        return
    deciding = {found.figure: found for found in study.governing}
    yield from _motors(deciding, system)
    yield from _take_up(study, deciding["largest tension asked of the take-up"], system)
    slackest = deciding["least belt tension"]
    yield Check(
        f"{_CASES}: smallest tension ({_at(slackest.result, system)})",
        figure(slackest.value, "force", system),
        "not slack: at least 0",
        verdict(holds=slackest.value >= 0.0),
    )
    yield from _belt(study, system)


def _at(result: CaseResult, system: System) -> str:
    """Case, temperature and speed."""
    temperature = figure(result.temperature, "temperature", system)
    return f"{result.case}, {temperature}, {figure(result.speed, 'speed', system)}"


def _motors(deciding: dict[str, Governing], system: System) -> Iterator[Check]:
    ends = (deciding["largest motor power, friction high"], deciding["least motor power, friction low"])
    most = max(ends, key=lambda found: abs(found.value))
    for drive in most.result.balance.settled.loop.data.drives:
        needed = drive.share * most.value
        subject = f"{_CASES}: motor power, {drive.name} ({_at(most.result, system)})"
        found = figure(abs(needed), "power", system) + (" (generating)" if needed < 0.0 else "")
        if drive.power is None:
            yield Check(subject, found, "installed power not given", "not checked")
        else:
            asked = f"at most {figure(drive.power, 'power', system)}"
            yield Check(subject, found, asked, verdict(holds=abs(needed) <= drive.power))


def _take_up(study: CalculatedCases, most: Governing, system: System) -> Iterator[Check]:
    held = most.result.balance.settled.loop.data.take_up.tension
    subject = f"{_CASES}: tension of the take-up ({_at(most.result, system)})"
    asked = f"at least {figure(most.value, 'force', system)}"
    if held is not None:
        yield Check(subject, figure(held, "force", system), asked, verdict(holds=holds(held, most.value)))
    elif len(study.results) > 1:
        yield Check(subject, "set anew in each case", asked, "not checked")


def _belt(study: CalculatedCases, system: System) -> Iterator[Check]:
    duties = [(belt_duty(study.conveyor, result.balance), result) for result in study.results]
    known = [(duty.safety_steady, duty, result) for duty, result in duties if duty.safety_steady is not None]
    if not known:
        return
    least, duty, result = min(known, key=lambda row: row[0])
    yield Check(
        f"{_CASES}: safety of the belt, steady ({_at(result, system)})",
        f"{least:.2f}",
        f"at least {duty.safety_needed:g} (DIN 22101:1982)",
        verdict(holds=least >= duty.safety_needed),
    )
