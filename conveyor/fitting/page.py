"""The page that a laboratory signs: the verdict on one sheet, figures and glossary behind it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import date
from operator import attrgetter
from typing import Final

import numpy as np

from conveyor.files import marks
from conveyor.fitting.compound import Fitted
from conveyor.fitting.figures import figures
from conveyor.fitting.verdict import GLOSSARY, Criterion, kept, passed
from conveyor.markup import Html, element, joined
from conveyor.models.report import Paper
from conveyor.report.columns import Column, Table
from conveyor.report.page import Part, bullets, facts, page, table
from conveyor.report.page import verdict as mark
from conveyor.report.svg import figure, inline
from conveyor.units.sentences import celsius

DOCUMENT: Final = ("laboratory", "number", "specimen", "instrument", "method", "measured", "by")
"""What a page says of its document: given, or stated by the files under these names."""
_LINE: Final = "flex: 1; border-top: 1px solid; padding-top: .2rem; margin-top: 2.6rem"
_TERMS: Final = "facts"


def build(
    found: Fitted, criteria: Sequence[Criterion], document: Mapping[str, str], *, paper: Paper = "A4"
) -> Html:
    """Return the page of a fit.

    Parameters
    ----------
    found : Fitted
        The fit.
    criteria : sequence of Criterion
        Of `conveyor.fitting.verdict.verdict`.
    document : mapping of str to str
        Laboratory, number, specimen, instrument, method, measured, by; what is left out and what the files do not
        state stays blank, to be written by hand.
    paper : {"A4", "Letter"}
        To print on.
    """
    stated = {key.lower(): value for key, value in found.metadata.items()}
    said = [(name, document.get(name) or stated.get(name) or Html("&nbsp;")) for name in DOCUMENT]
    compound = found.compound
    drawn = [figure(inline(made, f"fit-{name}", caption), caption) for name, caption, made in figures(found)]
    parts = (
        Part("verdict", "Verdict", _verdict(found, criteria)),
        Part("figures", "Figures", joined(drawn)),
        Part("tables", "Shifts and files", joined([_shifts(found), _files(found)])),
        Part("read", "What was read and done", element("div", bullets(found.understood), class_="note")),
        Part("unknown", "Not known", bullets(compound.missing)),
        Part("glossary", "Glossary", _glossary()),
    )
    return page(
        compound.name, "Master curve of a rubber", facts(said, "facts document"), parts,
        f"{marks.maker()}, {date.today().isoformat()}", paper=paper,
    )  # fmt: skip


def _verdict(found: Fitted, criteria: Sequence[Criterion]) -> Html:
    """The verdict, its criteria, what the compound is, and lines to sign on: the first sheet."""
    count = {word: sum(one.verdict == word for one in criteria) for word in ("pass", "FAIL", "not checked")}
    counted = joined(part for word, n in count.items() if n for part in (f"{n} ", mark(word), Html("&ensp;")))
    word = "pass" if passed(tuple(criteria)) else "FAIL"
    line = element("p", element("strong", "Master curve: "), mark(word), Html("&ensp; Criteria: "), counted)
    columns = (
        Column("criterion", "text", attrgetter("name")),
        Column("calculated", "text", attrgetter("calculated")),
        Column("required", "text", attrgetter("required")),
        Column("verdict", "verdict", attrgetter("verdict")),
        Column("what it says", "text", attrgetter("why")),
    )
    shown = table(
        Table("criteria", "", "Criteria", columns, tuple(criteria)), "Every criterion, and what it requires"
    )
    names = ("measured by, date", "approved by, date")
    signed = element(
        "div",
        *(element("div", name, style=_LINE) for name in names),
        style="display: flex; gap: 3rem",
        class_="keep",
    )
    sheet = element("div", line, facts(_figures(found)), shown, signed, style="break-after: page")
    return joined([sheet])


def _figures(found: Fitted) -> list[tuple[str, str]]:
    fit, compound = found.fit, found.compound
    low, high = fit.window
    law = kept(found).name if found.laws else "none"
    kelvin = () if compound.range is None else compound.range.kelvin
    return [
        ("window", f"{low:.2g} to {high:.2g} Hz at {celsius(compound.reference):.4g} °C"),
        ("temperatures", " to ".join(f"{celsius(t):.0f} °C" for t in dict.fromkeys(kelvin))),
        ("shift law kept", law),
        ("rows", f"{found.rows.frequency.size} of {len(found.files)} file{'s' * (len(found.files) > 1)}"),
        ("terms", f"{fit.active_terms}, E_e {fit.series.equilibrium / 1e6:.3g} MPa"),
        ("error of the series, rms", f"E' {fit.storage.rms:.1%}, E'' {fit.loss.rms:.1%}"),
        ("strain", compound.strain or "not stated"),
        ("Poisson's ratio", f"{compound.poisson_ratio:g}"),
    ]


def _shifts(found: Fitted) -> Html:
    shifted = found.superposition
    if shifted is None:
        return Html("")
    numbers = range(shifted.temperatures.size)
    columns = (
        Column("temperature", "temperature", lambda k: float(shifted.temperatures[k])),
        Column("log10 a_T", "text", lambda k: f"{shifted.log10_a_T[k]:+.4f}"),
        Column("standard error", "text", lambda k: f"{shifted.log10_a_T_error[k]:.4f}"),
        Column("log10 b_T", "text", lambda k: f"{shifted.log10_b_T[k]:+.4f}"),
    )
    return table(
        Table("shifts", "", "Shift factors", columns, tuple(numbers)), "Shift factors found [decades]"
    )


def _files(found: Fitted) -> Html:
    f, storage, loss = found.rows.curve
    omega, series = 2.0 * np.pi * f, found.fit.series
    errors = (series.storage(omega) / storage - 1.0, series.loss(omega) / loss - 1.0)

    def rms(error: np.ndarray, number: int) -> str:
        return f"{float(np.sqrt(np.mean(error[found.rows.file == number] ** 2))):.1%}"

    columns = (
        Column("file", "text", lambda k: found.files[k]),
        Column("rows", "count", lambda k: int(np.count_nonzero(found.rows.file == k))),
        Column("E', rms", "text", lambda k: rms(errors[0], k)),
        Column("E'', rms", "text", lambda k: rms(errors[1], k)),
    )
    numbers = tuple(k for k in range(len(found.files)) if (found.rows.file == k).any())
    return table(Table("files", "", "Files", columns, numbers), "Error of the series, file by file")


def _glossary() -> Html:
    said = ((element("dt", element("strong", term)), element("dd", words)) for term, words in GLOSSARY)
    return element("dl", *(element("div", *both, class_="keep") for both in said), style="columns: 18rem")
