"""The HTML report: one static file with inline figures, for the screen, a phone and paper; no script, no network."""

from __future__ import annotations

from datetime import date
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from conveyor.errors import InputError
from conveyor.files.saving import save, writable
from conveyor.markup import Html, joined
from conveyor.report import html_sections as sections
from conveyor.report.checks import checks
from conveyor.report.html_comparison import parts_of, top_of
from conveyor.report.html_studies import studied
from conveyor.report.page import Part, facts, page
from conveyor.report.unit_systems import chosen
from conveyor.spec import fingerprint
from conveyor.units import System

if TYPE_CHECKING:
    from conveyor.analysis import Analysis
    from conveyor.models import Conveyor
    from conveyor.studies import Studies
    from conveyor.studies.comparison import Comparison

_ENDINGS = (".html", ".htm")


def write(
    analysis: Analysis, path: Path, studies: Studies | None = None, *, system: System | None = None
) -> Path:
    """Write the HTML report of an analysis: under a temporary name beside it first, then renamed.

    Parameters
    ----------
    analysis : Analysis
        What to report.
    path : Path
        Name of the page, ending in ``.html``; an older page there is replaced.
    studies : Studies, optional
        Load cases, duty and uncertainty.
    system : {"SI", "US"}, optional
        Units of the tables, those of the spec's report without it; figures are in SI units.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .html, is a folder, lies in none, or cannot be written; nothing half-written is left,
        and an older page is untouched. Or the system is neither SI nor US.
    """
    _ready(path)
    save({path: build(analysis, studies, system=system).encode()})
    return path


def write_comparison(comparison: Comparison, path: Path, *, system: System | None = None) -> Path:
    """Write the HTML report of a comparison of compounds; as `write`.

    Raises
    ------
    InputError
        As `write`.
    """
    _ready(path)
    save({path: build_comparison(comparison, system=system).encode()})
    return path


def build(analysis: Analysis, studies: Studies | None = None, *, system: System | None = None) -> Html:
    """Report of an analysis and of the studies its spec asks for, as text."""
    system = chosen(analysis.conveyor, system)
    analysis = analysis.in_units(system)
    conveyor = analysis.conveyor
    found = checks(analysis, system, studies)
    parts: list[Part] = [
        sections.key_figures(analysis, found, system),
        sections.checked(found),
        sections.warned(analysis),
        sections.summed_up(analysis, system),
        sections.resistances(analysis, system),
        sections.route(analysis, system),
        sections.tensions(analysis, system),
        sections.rolls(analysis, system),
        sections.rubber(analysis, system),
        sections.start_and_stop(analysis, system),
        sections.belt(analysis, system),
        *(() if studies is None else studied(studies, system)),
        sections.assumed(analysis),
        sections.entered(analysis),
        sections.provenance(analysis, system),
    ]
    return page(
        conveyor.name,
        f"Belt conveyor calculation, {date.today().isoformat()}",
        joined([titled(conveyor), sections.top(analysis, system)]),
        parts,
        stamp(conveyor),
        paper=conveyor.report.sheet(system),
    )


def build_comparison(comparison: Comparison, *, system: System | None = None) -> Html:
    """Report of a comparison, as text."""
    conveyor = comparison.conveyor
    system = chosen(conveyor, system)
    return page(
        conveyor.name,
        f"Comparison of belt covers, {date.today().isoformat()}",
        joined([titled(conveyor), top_of(comparison, system)]),
        parts_of(comparison, system),
        stamp(conveyor),
        paper=conveyor.report.sheet(system),
    )


def titled(conveyor: Conveyor) -> Html:
    """What the spec's report says of the document."""
    report = conveyor.report
    said = {name: getattr(report, name) for name in ("project", "number", "client", "engineer", "revision")}
    given = [(name, value) for name, value in said.items() if value is not None]
    return facts(given, "facts document") if given else Html("")


def stamp(conveyor: Conveyor) -> str:
    """What made a page, and of what."""
    return f"conveyor {version('conveyor')}, {date.today().isoformat()}, spec SHA-256 {fingerprint(conveyor)[:16]}"


def _ready(path: Path) -> None:
    """Refuse a path that no page can stand at, before any time is spent on one."""
    if path.suffix.lower() not in _ENDINGS:
        raise InputError(f'{path}: a page\'s name ends in .html, got "{path.suffix}"')
    writable(path)
