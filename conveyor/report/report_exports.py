"""Report files of results."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from conveyor.report.table_files import FileKind
    from conveyor.report.table_model import Contents
    from conveyor.units import System


class ReportExports:
    """Mixin of results: report files of their `contents`."""

    def contents(self, system: System | None = None) -> Contents:
        """Contents of the report in a system of units."""
        raise NotImplementedError

    def to_excel(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the workbook; as `Analysis.to_excel`."""
        from conveyor.report.excel import write_workbook

        return write_workbook(self.contents(system), Path(path))

    def to_tables(
        self, folder: str | Path, *, system: System | None = None, kind: FileKind = "csv"
    ) -> tuple[Path, ...]:
        """Write every table as a file of its own; as `Analysis.to_tables`."""
        from conveyor.report.table_files import write_tables

        return write_tables(self.contents(system), Path(folder), kind)

    def to_html(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the HTML report; as `Analysis.to_html`."""
        from conveyor.report.html import write_page

        return write_page(self.contents(system), Path(path))

    def to_pdf(self, path: str | Path, *, system: System | None = None) -> Path:
        """Write the HTML report as it prints; as `Analysis.to_pdf`."""
        from conveyor.report.pdf import write_pdf

        return write_pdf(self.contents(system), Path(path))
