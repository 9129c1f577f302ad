"""Matplotlib figures as inline SVG: text stays text, identifiers are unique in the page, metadata is removed."""

from __future__ import annotations

import math
import re
from io import BytesIO
from textwrap import fill, wrap
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from conveyor.report.plots import curve_colour, drawing_settings
from conveyor.report.translated_page import localise_ticks, translate_figure
from conveyor.text.markup import Html, Markup, element
from conveyor.text.printable import escape_controls
from conveyor.units.sentences import SUPERSCRIPTS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import RendererAgg
    from matplotlib.figure import Figure

    from conveyor.languages.translator import Translator

_NAMESPACE = "http://www.w3.org/2000/svg"
_SVG_NAMESPACE = f"{{{_NAMESPACE}}}"
_LINK_ATTRIBUTE = "{http://www.w3.org/1999/xlink}href"
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_FONT = re.compile(r"font-family:[^;\"]*;?\s*|(font: [^;']*?\d+px )[^;\"]*")
_NUMBER = re.compile(r"-?\d+\.\d{2,}")
_COMMAND = re.compile(r"\s*([A-Za-z])\s*")
_WIDTH = 6.9
"""Width of a figure on a screen [in]: its letters stay legible on a phone."""
_PAPER_WIDTH = 4.0
"""Width of a figure on paper [in]: its letters are of 8 pt in half the width of A4, 3.55 in."""
_PAPER_HEIGHT_POWER = 0.8  # of its width over the figure's own: narrow figures are less flat
_NUMBERED_BARS = 0.8  # least height of bars with numbers, of the figure's own with its title
_PAPER_ROW = 1.5  # least height of a row of axes on paper [in]
_PAPER_TICKS = 4  # spaces between the numbers of a linear axis on paper
_FONT_SIZE = 9.0  # [pt]
_LEAST_LINE = 12  # letters of a line of an axis's label
_LETTERS, _HANDLE = 14.0, 6  # an inch, that stand side by side above a figure; as wide as a line in a legend
_LEGEND_LEFT = 0.01  # of a figure's width
_LEGEND_LINE = 0.17  # [in]
_PAD = 0.06  # [in] about the labels
_MOST_HEIGHT = 4.6
"""Maximum height of a figure of up to two rows [in]; of more in proportion."""
_DASHES = ("-", (0, (6, 2)), (0, (2, 2)), (0, (8, 2, 2, 2)), (0, (4, 1, 1, 1, 1, 1)), (0, (12, 3)))
_OWN_COLOURS = {curve_colour(k) for k in range(8)}
_GUIDE = "#5F6670"
_WRITTEN_DECADES = 3  # decades about 1 that are written out
_REMOVED_TAGS = {f"{_SVG_NAMESPACE}metadata", f"{_SVG_NAMESPACE}style"}
_SIMPLIFY_THRESHOLD = 0.5
"""Deviation below which a point of a line is left out [px]."""


def figure_svg(
    figure: Figure, name: str, label: str, *, on_paper: bool = False, words: Translator | None = None
) -> Markup:
    """Draw a figure as an SVG element.

    Parameters
    ----------
    figure : Figure
        Any of the plots here; it is restyled: no title, the page's width, curves with different dashes.
    name : str
        Prefix of its identifiers, unique in the page.
    label : str
        Text alternative.
    on_paper : bool
        True for half the width of a printed page, where its letters are then of 8 pt.
    words : Translator, optional
        Translates its words.
    """
    with drawing_settings(letters="none"):
        if words is not None:
            translate_figure(figure, words)
        restyle_figure(figure, on_paper=on_paper)
        if words is not None:
            localise_ticks(figure, words)
        drawn = _svg_bytes(figure)
    return Markup(_clean_svg(escape_controls(drawn.decode()), name, escape_controls(label), words))


def restyle_figure(figure: Figure, *, on_paper: bool = False) -> None:
    """Set the width of screen or paper, remove the title (the caption is one), and give curves different dashes."""
    from matplotlib.ticker import AutoLocator, MaxNLocator, NullLocator

    rows, columns = _axes_grid(figure)
    width = _PAPER_WIDTH if on_paper else _WIDTH
    flattened = min(1.0, width / figure.get_figwidth()) ** (_PAPER_HEIGHT_POWER if on_paper else 1.0)
    height = max(figure.get_figheight() * flattened, _PAPER_ROW * rows if on_paper else 0.0)
    height = min(_MOST_HEIGHT * max(1.0, rows / 2.0), height)
    least = _NUMBERED_BARS * figure.get_figheight() if _has_numbered_bars(figure) else 0.0
    figure.set_size_inches(width, max(height, least))
    lines = []
    for axis in figure.axes:
        axis.set_title("", pad=None)
        axis.tick_params(labelsize=_FONT_SIZE)
        axis.set_axisbelow(True)
        for words in (axis.xaxis.label, axis.yaxis.label):
            words.set_fontsize(_FONT_SIZE)
        _distinguish_curves(axis)
        lines.append(_set_legend(axis, figure, int(_LETTERS * width), alone=columns == 1))
        for scale in (axis.xaxis, axis.yaxis):
            if scale.get_scale() == "log":
                scale.set_major_formatter(_power_of_ten)
                scale.set_minor_locator(NullLocator())
        legend = axis.get_legend()
        if on_paper and isinstance(axis.xaxis.get_major_locator(), AutoLocator):
            axis.xaxis.set_major_locator(MaxNLocator(nbins=_PAPER_TICKS, steps=[1, 2, 2.5, 5, 10]))
        for text in axis.texts if on_paper else ():
            text.set_fontsize(max(_FONT_SIZE, text.get_fontsize()))
        for text in (*axis.texts, *(legend.get_texts() if legend is not None else ())):
            text.set_parse_math(False)  # a user's "$" is a dollar
    if on_paper:  # the legend takes no height from the curves
        figure.set_figheight(figure.get_figheight() + _LEGEND_LINE * max(0, max(lines) - 1))
    _fit_margins(figure)
    if on_paper and _wrap_labels(figure):
        _fit_margins(figure)


def _has_numbered_bars(figure: Figure) -> bool:
    """True for bars in rows with their numbers, which would stand on each other in a lower figure."""
    return any(
        axis.texts and any(getattr(bars, "orientation", "") == "horizontal" for bars in axis.containers)
        for axis in figure.axes
    )


def _wrap_labels(figure: Figure) -> bool:
    """Break labels that are longer than their axis into lines; returns whether there were any."""
    renderer, found = _figure_renderer(figure), False
    for axis in figure.axes:
        inner = axis.get_window_extent(renderer)
        for label, room, side in (
            (axis.xaxis.label, inner.width, "width"), (axis.yaxis.label, inner.height, "height"),
        ):  # fmt: skip
            text, needed = label.get_text(), getattr(label.get_window_extent(renderer), side)
            if text and needed > room:
                label.set_text("\n".join(wrap(text, max(_LEAST_LINE, int(len(text) * room / needed)))))
                found = True
    return found


def _figure_renderer(figure: Figure) -> RendererAgg:
    """Renderer that measures letters."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    return FigureCanvasAgg(figure).get_renderer()  # type: ignore[no-any-return, no-untyped-call]


def _fit_margins(figure: Figure) -> None:
    """Set margins that hold the labels; matplotlib's own layouts measure them several times."""
    figure.set_layout_engine("tight")  # what "none" then leaves behind allows margins to be set
    figure.set_layout_engine("none")
    renderer = _figure_renderer(figure)
    width, height = figure.bbox.size
    rows, columns = _axes_grid(figure)
    needed, between = [], [0.0]
    for place, axis in enumerate(figure.axes):
        inner, outer = axis.get_window_extent(renderer), axis.get_tightbbox(renderer)
        if outer is not None:
            needed.append((inner.x0 - outer.x0, outer.x1 - inner.x1, inner.y0 - outer.y0, outer.y1 - inner.y1))
            if place >= columns:  # what stands above the first row does not part the others
                between.append(outer.y1 - inner.y1)
    pad = _PAD * figure.dpi
    left, right, below, above = (max(sides) + pad for sides in zip(*needed, strict=True))
    gap_y, gap_x = below + max(between) + pad, left + right
    plot_y = (height - above - below - (rows - 1) * gap_y) / rows
    plot_x = (width - columns * gap_x) / columns
    figure.subplots_adjust(
        left=left / width,
        right=1.0 - right / width,
        bottom=below / height,
        top=1.0 - above / height,
        hspace=gap_y / max(1.0, plot_y),
        wspace=gap_x / max(1.0, plot_x),
    )


def _axes_grid(figure: Figure) -> tuple[int, int]:
    """Rows and columns of a figure's axes."""
    placed = figure.axes[0].get_subplotspec()
    if placed is None:
        return len(figure.axes), 1
    grid = placed.get_gridspec()
    return len(figure.axes) if grid.ncols == 1 else grid.nrows, grid.ncols


def _power_of_ten(value: float, _: object = None) -> str:
    """Power of ten as text: matplotlib's own formulas are slow, and not text in SVG."""
    exponent = round(math.log10(value))
    return f"{value:g}" if abs(exponent) <= _WRITTEN_DECADES else "10" + str(exponent).translate(SUPERSCRIPTS)


def _distinguish_curves(axis: Axes) -> None:
    _, labels = axis.get_legend_handles_labels()
    lines = [line for line in axis.lines if line.get_label() in labels and line.get_linestyle() != "None"]
    curves = [line for line in lines if line.get_linestyle() == "-" and line.get_linewidth() < 2.5]
    for k, line in enumerate(curves):
        line.set_linestyle(_DASHES[k % len(_DASHES)])  # type: ignore[arg-type]
        if line.get_color() not in _OWN_COLOURS:
            line.set_color(curve_colour(k))
        line.set_linewidth(1.6)
    for line in lines:
        if line.get_linestyle() == ":":
            line.set_color(_GUIDE)


def _set_legend(axis: Axes, figure: Figure, letters: int, *, alone: bool) -> int:
    """Set the legend above the curves, as wide as so many letters of the axis or, alone in a row, of the figure.

    Returns the number of its lines.
    """
    from matplotlib.transforms import blended_transform_factory

    handles, labels = axis.get_legend_handles_labels()
    if not handles or axis.get_legend() is None:
        return 0
    once = dict(zip(labels, handles, strict=True))
    columns = max(1, min(3, letters // (max(map(len, once)) + _HANDLE)))
    words = [fill(label, max(_LEAST_LINE, letters - _HANDLE)) for label in once]
    axis.legend(
        once.values(), words, fontsize=_FONT_SIZE, frameon=False, loc="lower left", ncols=columns,
        columnspacing=1.0, bbox_to_anchor=(_LEGEND_LEFT if alone else 0.0, 1.01), borderaxespad=0.0,
        bbox_transform=blended_transform_factory(figure.transFigure, axis.transAxes) if alone else None,
    )  # fmt: skip
    return math.ceil(sum(1 + label.count("\n") for label in words) / columns)


def _svg_bytes(figure: Figure) -> bytes:
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    for line in (line for axis in figure.axes for line in axis.lines):
        line.get_path().simplify_threshold = _SIMPLIFY_THRESHOLD
    content = BytesIO()  # savefig draws twice, the canvas once
    FigureCanvasSVG(figure).print_svg(content, metadata={"Date": None})  # type: ignore[no-untyped-call]
    return content.getvalue()


def _clean_svg(svg: str, name: str, label: str, words: Translator | None) -> str:
    root = ET.fromstring(svg.encode())  # noqa: S314 drawn here
    used = {_link_target(node) for node in root.iter()} | {
        mark for node in root.iter() for value in node.attrib.values() for mark in _REFERENCE.findall(value)
    }
    _remove_metadata(root)
    for node in root.iter():
        node.tag = node.tag.removeprefix(_SVG_NAMESPACE)
        if node.text is not None and node.tag not in {"text", "tspan", "title"}:
            node.text = None
        node.tail = None
        if node.get("id") in used:
            node.set("id", f"{name}-{node.get('id')}")
        else:
            node.attrib.pop("id", None)
        for key, value in list(node.attrib.items()):
            node.set(key, _shorten_value(key, value, name))
        link = node.attrib.pop(_LINK_ATTRIBUTE, None)
        if link is not None:
            node.set("href", f"#{name}-{link[1:]}")
    for key in ("width", "height", "version"):
        root.attrib.pop(key, None)
    root.set("role", "img")
    root.set("aria-label", label if words is None else words.heading(label))
    _inline_groups(root)
    return ET.tostring(root, encoding="unicode")


def _link_target(node: ET.Element) -> str:
    return node.get(_LINK_ATTRIBUTE, "#")[1:]


def _remove_metadata(node: ET.Element) -> None:
    for child in list(node):
        if child.tag in _REMOVED_TAGS:
            node.remove(child)
        else:
            _remove_metadata(child)


def _inline_groups(node: ET.Element) -> None:
    """Replace empty groups by their content."""
    for child in list(node):
        _inline_groups(child)
    kept: list[ET.Element] = []
    for child in list(node):
        bare = child.tag in {"g", "defs"} and not child.attrib and (child.tag == "g" or len(child) == 0)
        kept.extend(child if bare else [child])
    node[:] = kept


def _shorten_value(key: str, value: str, name: str) -> str:
    value = _REFERENCE.sub(lambda match: f"url(#{name}-{match[1]})", value)
    if key == "style":
        return _FONT.sub(lambda match: f"{match[1]}sans-serif" if match[1] else "", value).strip(" ;")
    if key == "d":
        points = _NUMBER.sub(lambda match: f"{float(match[0]):.1f}".removesuffix(".0"), value)
        return _COMMAND.sub(r"\1", points).strip()
    if key in {"x", "y", "transform"}:
        return _NUMBER.sub(lambda match: f"{float(match[0]):.2f}".rstrip("0").rstrip("."), value)
    return value


def stand_alone_svg(drawn: Markup) -> str:
    """Return a drawing of a page as it is in a file of its own."""
    return drawn.replace("<svg", f'<svg xmlns="{_NAMESPACE}"', 1)


def captioned_drawing(drawing: Html | Markup, caption: str, *, printed: bool = True) -> Html:
    """Return a drawing with its caption; it scrolls by itself on a narrow screen."""
    return element(
        "figure",
        element("div", drawing, class_="scroll drawing", tabindex="0", role="group", aria_label=caption),
        element("figcaption", caption),
        class_=None if printed else "unprinted",
    )
