"""The HTML report: one static file with inline figures, for the screen, a phone and paper; no script, no network."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date
from pathlib import Path
from typing import Final

from conveyor.errors import InputError
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.files.output_marks import package_version
from conveyor.languages.translator import Translator
from conveyor.report.merged_notes import NOTE_HEADINGS, sort_notes
from conveyor.report.page_elements import (
    PagePart,
    bullet_list,
    fact_list,
    figure_list,
    fold_away,
    key_figure_tiles,
    page_html,
    table_html,
    verdict_counts,
)
from conveyor.report.svg import captioned_drawing, figure_svg
from conveyor.report.table_model import Contents, Drawing, Table
from conveyor.report.translated_page import translate_page
from conveyor.text.markup import Html, element, join_html
from conveyor.units import System

_ENDINGS = (".html", ".htm")


def write_page(contents: Contents, path: Path) -> Path:
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
    check_writable(path)
    save_files({path: str(build_page(contents)).encode()})
    return path


def build_page(contents: Contents, *, on_paper: bool = False) -> Html:
    """Build the page of a report, for a screen or with its figures drawn for paper."""
    about, words = contents.document, contents.make_translator()
    made = f"conveyor {package_version('conveyor')}, {date.today().isoformat()}"
    if about.fingerprint:
        made += f", spec SHA-256 {about.fingerprint[:16]}"
    document = fact_list(about.said.items(), "facts document") if about.said else Html()
    made_parts = (_page_part(contents, *named, words, on_paper=on_paper) for named in contents.page)
    parts = [part for part in made_parts if part.content]
    kind, top = f"{about.kind}, {date.today().isoformat()}", join_html([document, _page_top(contents)])
    page = page_html(about.title, kind, top, parts, made, paper=about.paper)
    return page if words is None else translate_page(page, words)


def _page_top(contents: Contents) -> Html:
    """Facts of the report, and the notes of the spec."""
    said = contents.document.facts
    if not said:
        rows = contents["identity"].rows
        said = tuple((row.label, row.unit(contents.system).said(row.value, 4)) for row in rows)
    return join_html([fact_list(said), *(element("p", line) for line in contents.lines("note of the spec"))])


def _page_part(contents: Contents, name: str, heading: str, words: Translator | None, *, on_paper: bool) -> PagePart:
    """Part of the page: its own content, drawings, tables with their notes."""
    content = [_PART_CONTENT[name](contents)] if name in _PART_CONTENT else []
    content += _page_drawings(contents, name, words, on_paper=on_paper)
    for shown in contents.parts:
        places = [place for place in shown.places if place.part == name]
        for place in places:
            if place == shown.places[0] and shown.key != name:
                content += _page_drawings(contents, shown.key, words, on_paper=on_paper)
            made = _page_table(shown.on_page(place), place.caption, contents.system)
            content.append(made if place.printed else fold_away(place.caption, made))
        if any(place.printed for place in places) and shown.note and shown.key != "defaults":
            content.append(element("p", shown.note, class_="note"))
    every = [place for shown in contents.parts for place in shown.places if place.part == name]
    drawn = any(drawing.above == name for drawing in contents.drawings)
    shown_on_paper = not every or any(place.printed for place in every) or name in _PART_CONTENT or drawn
    return PagePart(name, heading, join_html(content), printed=shown_on_paper)


def _page_table(shown: Table, caption: str, system: System) -> Html:
    if shown.key == "checks":
        return table_html(shown, caption, system, kind="checks")
    return figure_list(shown, caption, system) if shown.figures else table_html(shown, caption, system)


def _page_drawings(contents: Contents, above: str, words: Translator | None, *, on_paper: bool) -> list[Html]:
    """Drawings above a table or part."""
    return [_page_drawing(one, words, on_paper=on_paper) for one in contents.drawings if one.above == above]


def _page_drawing(drawing: Drawing, words: Translator | None, *, on_paper: bool) -> Html:
    made = drawing.draw()
    if isinstance(made, Html):  # an animation: paper has the envelope of it beside
        return captioned_drawing(made, drawing.caption, printed=False)
    drawn = figure_svg(made, drawing.name, drawing.caption, on_paper=on_paper, words=words)
    return captioned_drawing(drawn, drawing.caption)


def _check_counts(contents: Contents) -> tuple[Html, int]:
    """Number of checks by verdict, and of those that fail."""
    verdicts = [check.verdict for check in contents["checks"].rows]
    return join_html(["Checks: ", verdict_counts(verdicts)]), verdicts.count("FAIL")


def _verdict_part(contents: Contents) -> Html:
    """Verdict in a sentence, key figures, and what to do about what fails."""
    counted, failing = _check_counts(contents)
    many = "one check fails" if failing == 1 else f"{failing} checks fail"
    says = f"Not adequate: {many}." if failing else "Adequate: every check that was made passes."
    content = [element("p", says, class_=f"stands {'fail' if failing else 'pass'}"), element("p", counted)]
    if figures := contents.figures_for("tile"):
        content.append(key_figure_tiles(figures, contents.system))
    return join_html([*content, _warning_lists(contents) if contents.lines("warning") else Html()])


def _key_figures(contents: Contents) -> Html:
    """Verdict, governing figures and key figures."""
    counted, failing = _check_counts(contents)
    warned = len(contents.lines("warning"))
    link, governs = element("a", f"{warned} warnings", href="#warnings"), contents["governing_figures"]
    content = [
        element("p", governs.note, class_=f"stands {'fail' if failing else 'pass'}"),
        element("p", counted, " ", link),
        table_html(governs, governs.heading, contents.system),
        key_figure_tiles(contents.figures_for("tile"), contents.system, ", as given"),
    ]
    if "defaults" in contents:
        content.append(element("p", contents["defaults"].note))
    return join_html(content)


def _warning_lists(contents: Contents) -> Html:
    """Lists of warnings: action required, then basis and limitations."""
    lists = zip(NOTE_HEADINGS, sort_notes(contents.lines("warning")), strict=True)
    shown = [(element("h3", heading.capitalize()), bullet_list(lines, "warnings")) for heading, lines in lists if lines]
    return join_html(part for pair in shown for part in pair) if shown else bullet_list(())


_PART_CONTENT: Final[dict[str, Callable[[Contents], Html]]] = {
    "key-figures": _key_figures,
    "verdict": _verdict_part,
    "method": lambda contents: bullet_list(contents.lines("method")),
    "warnings": _warning_lists,
    "assumptions": lambda contents: bullet_list(contents.lines("assumption")),
}
"""Content of parts of the page besides tables and drawings."""
