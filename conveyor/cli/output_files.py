"""Output files of a command: checked before the calculation, then written all or none.

An output that is also an input is always refused; replacing a file of another kind needs --force.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from conveyor.errors import InputError
from conveyor.files import atomic_write, output_marks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from conveyor.cli.application import Progress
    from conveyor.report.table_model import Contents
    from conveyor.text.markup import Html

PAGE = (".html", ".htm")
REPORT = (".xlsx", *PAGE, ".pdf")
"""Endings of a report's files; a PDF is its page on paper."""
PICTURE = (".png", ".svg")
FIGURE = (*PICTURE, ".pdf")
SPEC = (".yaml", ".yml")
_KINDS = {
    ".xlsx": output_marks.REPORT,
    **dict.fromkeys(PAGE, output_marks.PAGE),
    **dict.fromkeys(FIGURE, output_marks.FIGURE),
    **dict.fromkeys(SPEC, output_marks.TO_FILL_IN),
}
"""Kind of an older file that may be replaced, by its ending."""
_LARGEST_FILE = 100_000_000
"""Largest older file examined [bytes]; no output of this program is larger."""


class Outputs:
    """Inputs of a command, its output files, and their contents."""

    def __init__(self, *inputs: str | Path | None, force: bool, language: str | None = None) -> None:
        self._inputs = [Path(path) for path in inputs if path is not None]
        self._language = language
        self._force = force
        self._asked: list[tuple[str, Path]] = []
        self._folders: list[Path] = []
        self._contents: dict[Path, bytes] = {}
        self._said: list[str] = []
        self._reports: list[Path] = []
        self._plots: tuple[Path, str] | None = None
        self._tables: tuple[Path, Literal["csv", "parquet"]] | None = None

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

    def _register_tables(self, path: Path | None, *, parquet: bool) -> None:
        """Register the folder for tables; refuse Parquet without a folder or without pyarrow."""
        self.folder("--tables", path)
        if parquet and path is None:
            raise InputError("--parquet: says how tables are written; give --tables FOLDER, too")
        if parquet and find_spec("pyarrow") is None:
            raise InputError("--parquet: needs the package pyarrow (pip install pyarrow); without it: CSV")
        if path is not None:
            self._tables = path, "parquet" if parquet else "csv"

    def reports(
        self,
        outputs: Iterable[Path] | None = None,
        *others: str,
        tables: Path | None = None,
        parquet: bool = False,
        plots: Path | None = None,
        plot_kind: str = "png",
        kind: str | None = None,
    ) -> list[Path]:
        """Register the files of a report, which `write` makes, and return those of other endings, of the same kind."""
        rest = []
        for path in outputs or ():
            ending = path.suffix.lower()
            if ending not in REPORT:
                self.file("--output", path, *REPORT, *others, kind=kind)
                rest.append(path)
                continue
            self.file("--output", path, *REPORT, *others, kind=output_marks.PAGE if ending == ".pdf" else None)
            self._reports.append(path)
            if ending == ".pdf":
                from conveyor.report.pdf import require_typst

                require_typst()
        self._register_tables(tables, parquet=parquet)
        self.folder("--plots", plots)
        self._plots = None if plots is None else (plots, plot_kind)
        return rest

    @property
    def reported(self) -> bool:
        """True if a file of a report is registered."""
        return bool(self._reports) or self._tables is not None

    def write(
        self, contents: Contents, told: Progress | None = None, *, page: Callable[..., Html] | None = None
    ) -> None:
        """Make the registered files of a report; its own page is built by `page`, called with `words`, `on_paper`."""
        from conveyor.report import html

        if self._language is not None:
            contents = contents.in_language(self._language)
        page = partial(html.build_page, contents) if page is None else partial(page, words=contents.make_translator())
        for done, path in enumerate(self._reports):
            if told is not None:
                told("writing", done, len(self._reports))
            self._write_report(contents, page, path)
        if self._tables is not None:
            from conveyor.report import table_files

            folder, kind = self._tables
            self.add("tables", folder, table_files.encode_tables(contents, folder, kind))
        if self._plots is not None:
            self.figures({drawing.name: drawing.draw() for drawing in contents.drawings}, *self._plots)

    def _write_report(self, contents: Contents, page: Callable[..., Html], path: Path) -> None:
        """Make the workbook, page or PDF of a report, by file ending."""
        ending = path.suffix.lower()
        if ending == ".xlsx":
            from conveyor.report import excel

            self.add("workbook", path, excel.workbook_files(contents, path))
        elif ending == ".pdf":
            from conveyor.report import pdf

            with atomic_write.name_write_errors(path):
                made = pdf.page_pdf(page(on_paper=True), contents.document.paper)
            self.add("PDF", path, {path: made})
        else:
            self.add("page", path, {path: str(page()).encode()})

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
