"""Page of a fit for a laboratory to sign: verdict on one sheet, then figures and glossary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import date

from conveyor.files import marks
from conveyor.fitting import tables
from conveyor.fitting.compound import Fitted
from conveyor.fitting.quality import figures
from conveyor.fitting.verdict import GLOSSARY, Criterion, passed
from conveyor.markup import Html, element, joined
from conveyor.models.report import Paper
from conveyor.report.page import Part, bullets, facts, page, table
from conveyor.report.page import verdict as mark
from conveyor.report.svg import figure, inline


def build(
    fitted: Fitted, criteria: Sequence[Criterion], document: Mapping[str, str], *, paper: Paper = "A4"
) -> Html:
    """Return the page of a fit.

    Parameters
    ----------
    fitted : Fitted
        The fit.
    criteria : sequence of Criterion
        Of `conveyor.fitting.verdict.verdict`.
    document : mapping of str to str
        Laboratory, number, specimen, instrument, method, measured, by; blank, to be written by hand, where neither
        given nor stated by the files.
    paper : {"A4", "Letter"}
        To print on.
    """
    known = tables.said(fitted, document)
    said = [(name, known.get(name, Html("&nbsp;"))) for name in tables.DOCUMENT]
    compound = fitted.compound
    drawn = [figure(inline(made, f"fit-{name}", caption), caption) for name, caption, made in figures(fitted)]
    parts = (
        Part("verdict", "Verdict", _verdict(fitted, criteria)),
        Part("figures", "Figures", joined(drawn)),
        Part("tables", "Shifts and files", joined(_tables(fitted))),
        Part("read", "What was read and done", element("div", bullets(fitted.understood), class_="note")),
        Part("unknown", "Not known", bullets(compound.missing)),
        Part("glossary", "Glossary", _glossary()),
    )
    return page(
        compound.name, "Master curve of a rubber", facts(said, "facts document"), parts,
        f"{marks.maker()}, {date.today().isoformat()}", paper=paper,
    )  # fmt: skip


def _verdict(fitted: Fitted, criteria: Sequence[Criterion]) -> Html:
    """First sheet: verdict, facts, criteria and signature lines."""
    count = {word: sum(one.verdict == word for one in criteria) for word in ("pass", "FAIL", "not checked")}
    counted = joined(part for word, n in count.items() if n for part in (f"{n} ", mark(word), Html("&ensp;")))
    word = "pass" if passed(tuple(criteria)) else "FAIL"
    line = element("p", element("strong", "Master curve: "), mark(word), Html("&ensp; Criteria: "), counted)
    shown = table(tables.judged(criteria), "Every criterion, and what it requires")
    names = ("measured by, date", "approved by, date")
    signed = element("div", *(element("div", name) for name in names), class_="signed keep")
    return element("div", line, facts(tables.facts(fitted)), shown, signed, class_="sheet")


def _tables(fitted: Fitted) -> list[Html]:
    """Tables after the figures, with their headings as captions."""
    every = (tables.shifts(fitted), tables.laws(fitted), tables.files(fitted))
    return [table(shown, shown.heading) for shown in every if shown.rows]


def _glossary() -> Html:
    said = ((element("dt", element("strong", term)), element("dd", words)) for term, words in GLOSSARY)
    return element("dl", *(element("div", *both, class_="keep") for both in said), class_="terms")
