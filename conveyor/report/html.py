"""The HTML report: one static file with inline figures, for the screen, a phone and paper; no script, no network."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date
from pathlib import Path
from typing import Final

from conveyor.errors import InputError
from conveyor.files.marks import version
from conveyor.files.saving import save, writable
from conveyor.markup import Html, element, joined
from conveyor.report.columns import HEADINGS, Contents, Drawing, Table, ordered
from conveyor.report.page import Part, bullets, facts, folded, listed, page, table, tiles, verdict
from conveyor.report.svg import figure, inline
from conveyor.units import System

_ENDINGS = (".html", ".htm")


def write(contents: Contents, path: Path) -> Path:
    """Write the page of a report, under a temporary name first.

    Parameters
    ----------
    contents : Contents
        Its tables and drawings, in their unit system.
    path : Path
        Name of the page, ending in ``.html``; an older page there is replaced.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .html, is a folder, lies in none, or cannot be written; an older page is then
        untouched.
    """
    if path.suffix.lower() not in _ENDINGS:
        raise InputError(f'{path}: a page\'s name ends in .html, got "{path.suffix}"')
    writable(path)
    save({path: build(contents).encode()})
    return path


def build(contents: Contents) -> Html:
    """Build the page of a report."""
    about = contents.document
    made = f"conveyor {version('conveyor')}, {date.today().isoformat()}"
    if about.fingerprint:
        made += f", spec SHA-256 {about.fingerprint[:16]}"
    document = facts(about.said.items(), "facts document") if about.said else Html("")
    parts = [part for named in contents.page if (part := _part(contents, *named)).content]
    kind, top = f"{about.kind}, {date.today().isoformat()}", joined([document, _top(contents)])
    return page(about.title, kind, top, parts, made, paper=about.paper)


def _top(contents: Contents) -> Html:
    """Facts of the report, and the notes of the spec."""
    said = contents.document.facts
    if not said:
        rows = contents["identity"].rows
        said = tuple((row.label, row.unit(contents.system).brief(row.value)) for row in rows)
    return joined([facts(said), *(element("p", line) for line in contents.lines("note of the spec"))])


def _part(contents: Contents, name: str, heading: str) -> Part:
    """Part of the page: its own content, drawings, tables with their notes."""
    content = [_OWN[name](contents)] if name in _OWN else []
    content += [_drawn(drawing) for drawing in contents.drawings if drawing.above == name]
    for shown in contents.parts:
        places = [place for place in shown.places if place.part == name]
        for place in places:
            if place == shown.places[0] and shown.key != name:
                content += [_drawn(drawing) for drawing in contents.drawings if drawing.above == shown.key]
            made = _table(shown.on_page(place), place.caption, contents.system)
            content.append(made if place.printed else folded(place.caption, made))
        if any(place.printed for place in places) and shown.note and shown.key != "defaults":
            content.append(element("p", shown.note, class_="note"))
    every = [place for shown in contents.parts for place in shown.places if place.part == name]
    drawn = any(drawing.above == name for drawing in contents.drawings)
    shown_on_paper = not every or any(place.printed for place in every) or name in _OWN or drawn
    return Part(name, heading, joined(content), printed=shown_on_paper)


def _table(shown: Table, caption: str, system: System) -> Html:
    if shown.key == "checks":
        return table(shown, caption, system, kind="checks")
    return listed(shown, caption, system) if shown.figures else table(shown, caption, system)


def _drawn(drawing: Drawing) -> Html:
    made = drawing.draw()
    return figure(
        made if isinstance(made, Html) else inline(made, drawing.name, drawing.caption), drawing.caption
    )


def _key_figures(contents: Contents) -> Html:
    """Verdict, governing figures and key figures."""
    checks, warned = contents["checks"].rows, len(contents.lines("warning"))
    count = {word: sum(check.verdict == word for check in checks) for word in ("pass", "FAIL", "not checked")}
    counted = joined(
        part for word, n in count.items() if n for part in (f"{n} ", verdict(word), Html("&ensp;"))
    )
    link, governs = element("a", f"{warned} warnings", href="#warnings"), contents["governing_figures"]
    content = [
        element("p", governs.note, class_=f"stands {'fail' if count['FAIL'] else 'pass'}"),
        element("p", "Checks: ", counted, " ", link),
        table(governs, governs.heading, contents.system),
        tiles(contents.marked("tile"), contents.system),
    ]
    if "defaults" in contents:
        content.append(element("p", contents["defaults"].note))
    return joined(content)


def _warnings(contents: Contents) -> Html:
    """Lists of warnings: action required, then basis and limitations."""
    lists = zip(HEADINGS, ordered(contents.lines("warning")), strict=True)
    shown = [
        (element("h3", heading.capitalize()), bullets(lines, "warnings")) for heading, lines in lists if lines
    ]
    return joined(part for pair in shown for part in pair) if shown else bullets(())


_OWN: Final[dict[str, Callable[[Contents], Html]]] = {
    "key-figures": _key_figures,
    "method": lambda contents: bullets(contents.lines("method")),
    "warnings": _warnings,
    "assumptions": lambda contents: bullets(contents.lines("assumption")),
}
"""Content of parts of the page besides tables and drawings."""
