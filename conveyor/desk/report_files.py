"""Reports of a variant as files: the same as the command line writes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final, NamedTuple

from conveyor.errors import InputError
from conveyor.models import Conveyor
from conveyor.units import System


class ReportKind(NamedTuple):
    """Ending and media type of a kind of report."""

    ending: str
    media_type: str


REPORTS: Final[Mapping[str, ReportKind]] = {
    "workbook": ReportKind(".xlsx", "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"),
    "pdf": ReportKind(".pdf", "application/pdf"),
    "page": ReportKind(".html", "text/html; charset=utf-8"),
}
"""Reports by name."""


def report_bytes(conveyor: Conveyor, kind: str, system: System, progress: Callable[..., None]) -> bytes:
    """Content of a report with the studies that the spec has.

    Parameters
    ----------
    conveyor : Conveyor
        The variant.
    kind : str
        One of `REPORTS`.
    system : {"SI", "US"}
        Units.
    progress : callable
        Called between the steps.

    Raises
    ------
    InputError
        Unknown kind, a table that needs a file of its own beside the workbook, or PDF without the package typst.
    NoSolutionError, RangeError
        The variant has no answer.
    """
    if kind not in REPORTS:
        raise InputError(f"kind: {' or '.join(REPORTS)}")
    from conveyor.report import excel, html, pdf
    from conveyor.report.tables.analysis_contents import analysis_contents
    from conveyor.results.analysis import analyse, analyse_studies

    if kind == "pdf":
        pdf.require_typst()
    result = analyse(conveyor)
    progress()
    assessment = result.assess(analyse_studies(conveyor, result, progress=progress))
    contents = analysis_contents(assessment.in_units(system))
    if kind == "workbook":
        path = Path("report.xlsx")
        files = excel.workbook_files(contents, path)
        if len(files) > 1:
            raise InputError("too long for one workbook; conveyor power -o writes the long tables beside it")
        return bytes(files[path])
    page = html.build_page(contents, on_paper=kind == "pdf")
    return bytes(pdf.page_pdf(page, contents.document.paper)) if kind == "pdf" else str(page).encode()
