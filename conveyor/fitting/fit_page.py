"""Page of a fit for a laboratory to sign: verdict on one sheet, then figures and glossary."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import date

from conveyor.files import output_marks
from conveyor.fitting import fit_tables
from conveyor.fitting.fit_verdict import GLOSSARY, Criterion, is_accepted
from conveyor.fitting.fitted_compound import FittedCompound
from conveyor.fitting.quality_figures import fit_figures
from conveyor.languages.translator import Translator
from conveyor.models.report import Paper
from conveyor.report.page_elements import (
    PagePart,
    bullet_list,
    fact_list,
    page_html,
    table_html,
    verdict_counts,
    verdict_mark,
)
from conveyor.report.svg import captioned_drawing, figure_svg
from conveyor.report.table_model import PagePlacement
from conveyor.report.translated_page import translate_page
from conveyor.text.markup import Html, element, join_html


def build_page(
    fitted: FittedCompound,
    criteria: Sequence[Criterion],
    document: Mapping[str, str],
    *,
    paper: Paper = "A4",
    on_paper: bool = False,
    words: Translator | None = None,
) -> Html:
    """Return the page of a fit.

    Parameters
    ----------
    fitted : FittedCompound
        The fit.
    criteria : sequence of Criterion
        Of `conveyor.fitting.fit_verdict.fit_criteria`.
    document : mapping of str to str
        Laboratory, number, specimen, instrument, method, measured, by; blank, to be written by hand, where neither
        given nor stated by the files.
    paper : {"A4", "Letter"}
        To print on.
    on_paper : bool
        True for figures drawn for paper, not for a screen.
    words : Translator, optional
        Translates its texts.
    """
    known = fit_tables.document_fields(fitted, document)
    said = [(name, known.get(name, "\xa0")) for name in fit_tables.DOCUMENT_FIELDS]
    compound = fitted.compound
    *others, errors, curve = [
        captioned_drawing(figure_svg(made, f"fit-{name}", caption, on_paper=on_paper, words=words), caption)
        for name, caption, made in fit_figures(fitted)
    ]
    parts = (
        PagePart("verdict", "Verdict", _verdict_sheet(fitted, criteria, (curve, errors))),
        PagePart("figures", "Figures", join_html(others)),
        PagePart("tables", "Shifts and files", join_html(_figure_tables(fitted))),
        PagePart("read", "What was read and done", element("div", bullet_list(fitted.understood), class_="note")),
        PagePart("unknown", "Not known", bullet_list(compound.missing)),
        PagePart("glossary", "Glossary", _glossary_list()),
    )
    page = page_html(
        compound.name, "Master curve of a rubber", fact_list(said, "facts document"), parts,
        f"{output_marks.program_version()}, {date.today().isoformat()}", paper=paper,
    )  # fmt: skip
    return page if words is None else translate_page(page, words)


def _verdict_sheet(fitted: FittedCompound, criteria: Sequence[Criterion], drawn: Sequence[Html]) -> Html:
    """First sheet: verdict, facts, criteria, the curves that are signed for, and signature lines."""
    counted = verdict_counts(one.verdict for one in criteria)
    word = "pass" if is_accepted(tuple(criteria)) else "FAIL"
    line = element("p", element("strong", "Master curve: "), verdict_mark(word), "\u2002 Criteria: ", counted)
    caption = "Every criterion, and what it requires"
    shown = table_html(fit_tables.criteria_table(criteria).on_page(PagePlacement("verdict", caption)), caption)
    names = ("measured by, date", "approved by, date")
    signed = element("div", *(element("div", name) for name in names), class_="signed keep")
    return element("div", line, fact_list(fit_tables.fit_facts(fitted)), shown, *drawn, signed, class_="sheet")


def _figure_tables(fitted: FittedCompound) -> list[Html]:
    """Tables after the figures, with their headings as captions."""
    every = (
        fit_tables.shift_factor_table(fitted),
        fit_tables.law_table(fitted),
        fit_tables.file_table(fitted),
        fit_tables.strain_sweep_table(fitted),
    )
    return [table_html(shown, shown.heading) for shown in every if shown.rows]


def _glossary_list() -> Html:
    said = ((element("dt", element("strong", term)), element("dd", words)) for term, words in GLOSSARY)
    return element("dl", *(element("div", *both, class_="keep") for both in said), class_="terms")
