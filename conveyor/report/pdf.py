"""The page of a report as it prints: its elements, set by Typst.

A page is made of a few elements of `conveyor.report.page_elements` alone; each has its form on paper here and in
``page.typ``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from typing import Final

from conveyor.errors import InputError
from conveyor.files.atomic_write import check_writable, save_files
from conveyor.models.report import Paper
from conveyor.report.html import build_page
from conveyor.report.matplotlib_settings import load_matplotlib
from conveyor.report.page_elements import COLOURS
from conveyor.report.svg import stand_alone_svg
from conveyor.report.table_model import Contents
from conveyor.text.markup import Html, Markup
from conveyor.text.printable import text_width

_TYPST_FORMS: Final = Path(__file__).with_name("page.typ")
_FONT: Final = "DejaVu Sans"  # comes with matplotlib; missing letters are from the fonts of the machine
_PAPERS: Final = {"A4": "a4", "Letter": "us-letter"}
_CHINESE_FONTS: Final = re.compile(
    r"CJK|\bSC\b|\bCN\b|SimSun|SimHei|YaHei|PingFang|Source Han|WenQuanYi|Heiti|Songti|KaiTi|FangSong"
)
_PAGE_WIDTH: Final = 521.0  # between the margins of A4 [pt]
_SIZE = 8.0  # letters of tables [pt]
_SHORT: Final = 13  # characters up to which a text ("> 100 %") stays on one line
_LONGEST: Final = 22  # characters of a word beyond which a column is not made wider for it
_LETTER, _GAP = 0.62, 1.8  # width of a letter over its size; letters that the room between columns takes
_WANTED: Final = 40  # letters beyond which a longer text makes a column no wider
_NAME: Final = 20  # letters of a name of a row that stand on one line
_BOLD: Final = 1.13  # width of a letter of a heading over that of text
_HEAD_LINES: Final = 3  # of a heading above a narrow column
_SHARES: Final = 20  # steps of the width that parts of a table are filled to
_ROOM: Final = _PAGE_WIDTH / (_SIZE * _LETTER)  # of a line [letters]
_SCREEN_TAGS: Final = frozenset({"head", "nav", "details", "button", "footer"})
_INKS: Final = {"pass": "good", "fail": "bad", "open": "open"}


def write_pdf(contents: Contents, path: Path) -> Path:
    """Write the page of a report as PDF, under a temporary name first.

    Parameters
    ----------
    contents : Contents
        Its tables and drawings, in their unit system.
    path : Path
        Name of the file, ending in ``.pdf``; an older file there is replaced.

    Returns
    -------
    Path
        The path given.

    Raises
    ------
    InputError
        The path does not end in .pdf or cannot be written, or the package typst is not installed.
    """
    if path.suffix.lower() != ".pdf":
        raise InputError(f'{path}: a PDF\'s name ends in .pdf, got "{path.suffix}"')
    require_typst()
    check_writable(path)
    save_files({path: page_pdf(build_page(contents, on_paper=True), contents.document.paper)})
    return path


def require_typst() -> None:
    """Check that the package typst is installed.

    Raises
    ------
    InputError
        It is not installed.
    """
    if find_spec("typst") is None:
        raise InputError(
            'PDF needs the package typst (pip install "conveyor[pdf]"); without it: print the page (.html)'
        )


def page_pdf(page: Html, paper: Paper) -> bytes:
    """Return a page of `conveyor.report.page_elements` as PDF on its paper; the same page gives the same bytes.

    Raises
    ------
    InputError
        The package typst, or a font for the page's language, is not installed.
    """
    require_typst()
    import typst

    with TemporaryDirectory() as folder:
        copy_fonts(Path(folder))
        known = typst.Fonts(font_paths=[folder])
        further = _chinese_font(known.families()) if page.attributes["lang"] == "zh" else ""
        return typst.compile(typst_source(page, paper, further).encode(), format="pdf", font_paths=known)


def copy_fonts(folder: Path) -> None:
    """Copy the fonts of pages from matplotlib, not those beside them that draw missing letters as boxes.

    Typst takes folders only.
    """
    for path in (Path(load_matplotlib().get_data_path()) / "fonts" / "ttf").glob("DejaVuSans*.ttf"):
        copyfile(path, folder / path.name)


def _chinese_font(families: Iterable[str]) -> str:
    """Font of the machine with Chinese letters."""
    found = next(filter(_CHINESE_FONTS.search, families), None)
    if found is None:
        raise InputError(
            "PDF in Chinese needs a font with Chinese letters, and this machine has none (Noto Sans CJK SC, for "
            "example); without it: the page (.html), which the browser prints, or the workbook (.xlsx)"
        )
    return found


def typst_source(page: Html, paper: Paper, further_font: str = "") -> str:
    """Return a page as Typst source; a further font has the letters that the usual one has not."""
    said, language = {"title": "h1", "kind": "p", "foot": "footer"}, page.attributes["lang"]
    given = [
        *(f'#let {name} = rgb("{value}")' for name, value in COLOURS.items()),
        *(f"#let page-{name} = {_typst_string(page.first(tag).text)}" for name, tag in said.items()),
        f'#set page(paper: "{_PAPERS[paper]}")',
        f"#set text(font: ({_typst_string(_FONT)}, {_typst_string(further_font or _FONT)}))",
        f'#set text(lang: "{language}"{", hyphenate: true" if language != "en" else ""})',
    ]
    return "\n".join([*given, _TYPST_FORMS.read_text("utf-8"), _write_content(page)])


def _write_content(element: Html) -> str:
    """Content of an element; consecutive figures side by side."""
    parts: list[str] = []
    for figures, group in groupby(filter(_is_printed, element.content), _is_figure):
        made = map(_write_part, list(group))
        parts += [f"\n#drawings({', '.join(made)},)\n"] if figures else made
    return "".join(parts)


def _write_part(part: Html | str) -> str:
    """An element or text."""
    if isinstance(part, str):
        return f"#{_typst_string(part)}" if part.strip() else " "
    return _FORMS.get(part.tag, _write_content)(part)


def _write_heading(level: int, element: Html) -> str:
    """A heading, also a bookmark of the file."""
    return f"\n#heading(level: {level})[{_write_content(element)}]\n"


def _write_paragraph(element: Html) -> str:
    """A paragraph, a note, or the overall verdict."""
    form = "stands" if "stands" in element.classes else "muted-text" if element.classes else ""
    words = _write_content(element)
    return f"\n#{form}{_verdict_colours(element)}[{words}]\n\n" if form else f"\n{words}\n\n"


def _write_span(element: Html) -> str:
    """Inline text: the verdict of a check, or a unit, which is not broken."""
    form = "verdict" if "verdict" in element.classes else "box" if "unit" in element.classes else ""
    words = _write_content(element)
    return f"#{form}{_verdict_colours(element)}[{words}]" if form else words


def _write_pairs(element: Html) -> str:
    """A definition list: key figures, facts, or terms."""
    kind = next((kind for kind in ("tiles", "facts") if kind in element.classes), "terms")
    pairs = (map(_write_content, pair.elements) for pair in element.elements)
    return f"\n#{kind}({''.join(f'([{name}], [{words}]), ' for name, words in pairs)})\n"


def _write_division(element: Html) -> str:
    """A table, parts side by side, signature lines, a separate sheet, or plain content."""
    if any(one.tag == "table" for one in element.elements):
        return _write_table(element.first("table"), element.classes)
    side_by_side = next((kind for kind in ("beside", "signed") if kind in element.classes), None)
    if side_by_side:
        return f"\n#{side_by_side}({', '.join(f'[{_write_part(part)}]' for part in element.elements)})\n"
    return _write_content(element) + ("\n#pagebreak(weak: true)\n" if "sheet" in element.classes else "")


def _write_table(element: Html, kinds: frozenset[str]) -> str:
    """A table with its caption, in parts where it is too wide; its header repeats on every page."""
    caption, head, *parts = element.elements
    rows = [(row.elements, part.tag == "tfoot") for part in (head, *parts) for row in part.elements]
    name = f"{'hide' if 'further' in caption.classes else 'muted-text'}[{_write_content(caption)}]"
    keep, made = str("keep" in kinds).lower(), []
    needs = [_ColumnNeed.of(top, below) for top, *below in zip(*(row for row, _ in rows), strict=True)]
    named = sum(cell.tag == "th" for cell in rows[-1][0]) if len(rows) > 1 else 0
    for shown in _split_columns([need.least for need in needs], named):
        lines = [([row[j] for j in shown], foot) for row, foot in rows]
        size, columns = _column_layout([needs[j] for j in shown])
        top, *below = (_write_cells(line, strong=foot) for line, foot in lines)
        given = ",\n".join([keep, f"{size:.2f}pt", columns, name, f"table.header({top})", *below])
        made.append(f"\n#captioned({given})\n")
        name = "none"
    return "".join(made)


def _write_cells(row: Sequence[Html], *, strong: bool) -> str:
    """Cells of a row; numbers aligned right."""
    made = []
    for cell in row:
        how = ["align: right"] * bool(cell.classes & {"n", "v"})
        how += ["fill: open-pale"] * ("asked" in cell.classes)
        words = f"#strong[{_write_content(cell)}]" if strong else _write_content(cell)
        made.append(f"table.cell({', '.join(how)})[{words}]" if how else f"[{words}]")
    return ", ".join(made)


def _write_figure(element: Html) -> str:
    """A drawing and its caption."""
    svg = next(part for part in element.first("div").content if isinstance(part, Markup))
    drawing = stand_alone_svg(svg).replace("sans-serif", _FONT)
    return f"({_typst_string(drawing)}, [{_write_content(element.first('figcaption'))}])"


_FORMS: Final[Mapping[str, Callable[[Html], str]]] = {
    **{f"h{level}": partial(_write_heading, level) for level in (1, 2, 3)},
    "p": _write_paragraph,
    "li": lambda item: f"\n- {_write_content(item)}\n",
    "br": lambda _: " \\ ",
    "strong": lambda words: f"#strong[{_write_content(words)}]",
    "small": lambda words: f"#small[{_write_content(words)}]",
    "span": _write_span,
    "dl": _write_pairs,
    "div": _write_division,
    "figure": _write_figure,
}
"""Forms of elements on paper by tag; others are their content."""


@dataclass(frozen=True)
class _ColumnNeed:
    """Letters that a column needs: on one line, on few lines, and at least; with the gap to the next."""

    whole: float
    wanted: float
    least: float

    @classmethod
    def of(cls, head: Html, below: Sequence[Html]) -> _ColumnNeed:
        """Need of a column: at least its longest word, short text or number, and a line of the names of rows."""
        longest, heading = max((text_width(cell.text) for cell in below), default=0), _BOLD * text_width(head.text)
        kept = [
            text_width(cell.text) for cell in below if cell.classes & {"n", "name"} or text_width(cell.text) <= _SHORT
        ]
        words = [min(text_width(word), _LONGEST) for cell in below for word in cell.text.split()]
        names = [min(longest, _NAME)] if any(cell.tag == "th" for cell in below) else []
        least = max(
            [*kept, *words, *names, *(_BOLD * min(text_width(word), _LONGEST) for word in head.text.split())], default=0
        )
        wanted = max(min(longest, _WANTED), heading / _HEAD_LINES, least)
        needs = max(longest, heading), wanted, least
        return cls(*(need + _GAP for need in needs))


def _split_columns(least: Sequence[float], named: int) -> list[list[int]]:
    """Columns of a table in as few parts as fit the page, alike in width, each with the first ones, that name rows."""
    names, rest = list(range(named)), range(named, len(least))
    room = _ROOM - sum(least[:named])
    if sum(least[named:]) <= room or room < max(least[named:], default=0.0):
        return [list(range(len(least)))]

    def packed(most: float) -> list[list[int]]:
        """Columns filled up one after another."""
        parts, filled = [list(names)], 0.0
        for j in rest:
            if filled + least[j] > most and filled:
                parts.append(list(names))
                filled = 0.0
            parts[-1].append(j)
            filled += least[j]
        return parts

    fewest = len(packed(room))
    shares = (room * k / _SHARES for k in range(1, _SHARES + 1))
    return next(parts for share in shares if len(parts := packed(share)) <= fewest)


def _column_layout(needs: Sequence[_ColumnNeed]) -> tuple[float, str]:
    """Letter size [pt] and column widths of a table: as wide as the text where all fit.

    Else the room beyond the least need is shared in proportion to the remaining text; letters shrink where even the
    least does not fit.
    """
    if sum(need.whole for need in needs) <= _ROOM:
        return _SIZE, str(max(1, len(needs)))
    least = sum(need.least for need in needs)
    more = sum(need.wanted for need in needs) - least
    spare = min(1.0, max(0.0, _ROOM - least) / more) if more else 0.0
    widths = (need.least + spare * (need.wanted - need.least) for need in needs)
    return _SIZE * min(1.0, _ROOM / least), f"({', '.join(f'{width:.1f}fr' for width in widths)})"


def _is_printed(part: Html | str) -> bool:
    return isinstance(part, str) or not (part.tag in _SCREEN_TAGS or "unprinted" in part.classes)


def _is_figure(part: Html | str) -> bool:
    return isinstance(part, Html) and part.tag == "figure"


def _verdict_colours(element: Html) -> str:
    """Arguments for the colours of a verdict; empty for other text."""
    ink = next((ink for kind, ink in _INKS.items() if kind in element.classes), None)
    return "" if ink is None else f"({ink}, {ink}-pale)"


def _typst_string(text: str) -> str:
    r"""Return text as a Typst string, so that nothing of it is markup.

    Examples
    --------
    >>> print(_typst_string('a "b" #c' + "\\"))
    "a \"b\" #c\\"
    """
    quoted = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{quoted}"'
