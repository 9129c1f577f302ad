"""Output files of a command: checked before the calculation, then written all or none.

An output that is also an input is always refused; replacing a file of another kind needs --force.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from conveyor.errors import InputError
from conveyor.files import atomic_write, output_marks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.cli.application import Progress
    from conveyor.report.table_model import Contents
    from conveyor.text.markup import Html

PAGE = (".html", ".htm")
FIGURE = (".png", ".svg", ".pdf")
SPEC = (".yaml", ".yml")
_KINDS = {
    ".xlsx": output_marks.REPORT,
    **dict.fromkeys(PAGE, output_marks.PAGE),
    **dict.fromkeys(FIGURE, output_marks.FIGURE),
    **dict.fromkeys(SPEC, output_marks.TO_FILL_IN),
}
"""Kind of an older file that may be replaced, by its ending."""
_OWN_OPTIONS = {".pdf": "--pdf", **dict.fromkeys(PAGE, "--html")}
"""Options of reports that are no workbook, by ending."""
_LARGEST_FILE = 100_000_000
"""Largest older file examined [bytes]; no output of this program is larger."""


class Outputs:
    """Inputs of a command, its output files, and their contents."""

    def __init__(self, *inputs: str | Path | None, force: bool) -> None:
        self._inputs = [Path(path) for path in inputs if path is not None]
        self._force = force
        self._asked: list[tuple[str, Path]] = []
        self._folders: list[Path] = []
        self._contents: dict[Path, bytes] = {}
        self._said: list[str] = []
        self._reports: list[Callable[[Contents], None]] = []

    def file(self, option: str, path: Path | None, *endings: str, kind: str | None = None) -> None:
        """Register an output file; refuse one that cannot be written, has another ending, or replaces another kind."""
        if path is None:
            return
        if path.suffix.lower() not in endings:
            *others, last = endings
            allowed = f"{', '.join(others)} or {last}" if others else last
            raise InputError(f'{option}: {path}: its name ends in {allowed}, got "{path.suffix}"')
        if path.suffix.lower() == ".parquet" and find_spec("pyarrow") is None:
            raise InputError(f'{option}: {path}: needs pyarrow (pip install "conveyor[parquet]"); without it: .csv')
        atomic_write.check_writable(path)
        for other, taken in self._asked:
            if _same_file(path, taken):
                raise InputError(f"{option}: {path}: is the file of {other}, too; give each its own")
        self._asked.append((option, path))
        self._refuse_older(path, _KINDS.get(path.suffix.lower(), "") if kind is None else kind)

    def folder(self, option: str, path: Path | None) -> None:
        """Register an output folder; refuse one that is a file or cannot be created."""
        if path is None:
            return
        if path.exists() and not path.is_dir():
            raise InputError(f"{option}: {path}: is a file; give the name of a folder")
        holder = path if path.is_dir() else path.absolute().parent
        if not holder.is_dir():
            raise InputError(f"{option}: {path}: its folder does not exist; create it or choose another")
        if not os.access(holder, os.W_OK):
            raise InputError(f"{option}: {path}: {holder} is read-only; choose another folder")
        self._folders.append(path)

    def tables(self, path: Path | None, *, parquet: bool) -> None:
        """Register the folder for tables; refuse Parquet without a folder or without pyarrow."""
        self.folder("--tables", path)
        if not parquet:
            return
        if path is None:
            raise InputError("--parquet: says how tables are written; give --tables FOLDER, too")
        if find_spec("pyarrow") is None:
            raise InputError("--parquet: needs the package pyarrow (pip install pyarrow); without it: CSV")

    def reports(
        self,
        output: Path | None = None,
        html: Path | None = None,
        tables: Path | None = None,
        *,
        parquet: bool = False,
        pdf: Path | None = None,
    ) -> None:
        """Register the files of a report; `write` makes them."""
        own = None if output is None else _OWN_OPTIONS.get(output.suffix.lower())
        if own is not None:
            raise InputError(f"--output: {output}: is for the workbook (.xlsx); give {own} {output}")
        self.file("--output", output, ".xlsx")
        paged = self.pages(html, pdf)
        self.tables(tables, parquet=parquet)
        if output is not None:
            self._reports.append(partial(self.report, path=output))
        if paged:
            self._reports.append(partial(self._paged, paths=paged))
        if tables is not None:
            self._reports.append(partial(self.tabled, folder=tables, parquet=parquet))

    def pages(self, html: Path | None, pdf: Path | None) -> list[Path]:
        """Register the files of a page and return them; refuse PDF without the package that sets it."""
        self.file("--html", html, *PAGE)
        self.file("--pdf", pdf, ".pdf", kind=output_marks.PAGE)
        if pdf is not None:
            from conveyor.report.pdf import require_typst

            require_typst()
        return [path for path in (html, pdf) if path is not None]

    def write(self, contents: Contents, told: Progress | None = None) -> None:
        """Make the registered files of a report."""
        for done, make in enumerate(self._reports):
            if told is not None:
                told("writing", done, len(self._reports))
            make(contents)

    def report(self, contents: Contents, path: Path) -> None:
        """Make the workbook or page of a report, by file ending."""
        if path.suffix.lower() == ".xlsx":
            from conveyor.report import excel

            self.add("workbook", path, excel.workbook_files(contents, path))
        else:
            self._paged(contents, [path])

    def _paged(self, contents: Contents, paths: Iterable[Path]) -> None:
        """Make the page of a report as HTML or PDF files."""
        from conveyor.report import html

        self.page(partial(html.build_page, contents), paths)

    def page(self, build: Callable[..., Html], paths: Iterable[Path]) -> None:
        """Make a page as HTML or PDF, by file ending, from its builder with `on_paper`."""
        for path in paths:
            if path.suffix.lower() == ".pdf":
                from conveyor.report import pdf

                with atomic_write.name_write_errors(path):
                    made = pdf.page_pdf(build(on_paper=True))
                self.add("PDF", path, {path: made})
            else:
                self.add("page", path, {path: build().encode()})

    def tabled(self, contents: Contents, folder: Path, *, parquet: bool) -> None:
        """Make a file for each table of a report."""
        from conveyor.report import table_files

        self.add("tables", folder, table_files.encode_tables(contents, folder, "parquet" if parquet else "csv"))

    def figure(self, figure: Figure, path: Path) -> None:
        """Make the file of a figure."""
        from conveyor.report.plots import figure_bytes

        self.add("figure", path, {path: figure_bytes(figure, path)})

    def figures(self, figures: Mapping[str, Figure], folder: Path, kind: str = "png") -> None:
        """Make a file for each figure, by its name."""
        from conveyor.report.plots import figure_bytes

        paths = {folder / f"{name}.{kind}": figure for name, figure in figures.items()}
        self.add("figures", folder, {path: figure_bytes(figure, path) for path, figure in paths.items()})

    def add(self, what: str, where: Path, contents: Mapping[Path, bytes]) -> None:
        """Add the contents of a file and its companions, or of the files of a folder."""
        for path, content in contents.items():
            if any(_same_file(path, other) for other in self._contents):
                raise InputError(f"{path}: two outputs go to this file; choose another name or folder")
            self._refuse_older(path, output_marks.output_kind(content) or output_marks.TO_FILL_IN)
            self._contents[path] = content
        self._said.append(f"{what}: {where if where in contents else f'{len(contents)} in {where}'}")

    def save(self) -> list[str]:
        """Write all files or none; returns a line on each."""
        atomic_write.save_files(self._contents, folders=self._folders)
        return self._said

    def _refuse_older(self, path: Path, kind: str) -> None:
        """Refuse to replace an input or, without --force, a file of another kind."""
        if any(_same_file(path, read) for read in self._inputs):
            raise InputError(f"{path}: is an input of this command; choose another name for the output")
        if not kind or self._force or not path.exists():
            return
        try:
            mark = output_marks.output_kind(path.read_bytes()) if path.stat().st_size <= _LARGEST_FILE else None
        except OSError as error:
            raise InputError(f"{path}: exists and cannot be read ({error.strerror or error})") from None
        if mark != kind:
            named = kind.partition(":")[0]
            unlike = f"no {named} that conveyor wrote" if mark is None else "another output of conveyor"
            what = "" if kind == output_marks.TO_FILL_IN else f" and is {unlike}"
            raise InputError(f"{path}: exists{what}; choose another name, or replace it with --force")


def _same_file(path: Path, other: Path) -> bool:
    """True if two paths are the same file, links followed; missing files are compared by path."""
    try:
        if path.exists() and other.exists():
            return path.samefile(other)
        return path.resolve() == other.resolve()
    except (OSError, RuntimeError, ValueError):  # links in a circle, a null byte: refused where they are used
        return False
