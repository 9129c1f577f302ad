"""Reference of the file formats, written from the models: docs/spec.md and `conveyor schema --markdown`."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any, Final

from pydantic import BaseModel
from ruamel.yaml import YAML

from conveyor.forms.form_fields import FieldGroup, FieldTable, FormField, Part, model_layout
from conveyor.models import Conveyor, RubberCompound
from conveyor.models.sizing import SizingDuty
from conveyor.starter.starter_data import KINDS as STARTERS
from conveyor.starter.starter_data import starter_values
from conveyor.units.quantity_kinds import INPUT_KINDS

_KnownBlocks = list[tuple[tuple[Part, ...], str]]
ExampleValue = str | float | bool | Sequence[Any]

_FORMATS: Final[Mapping[type[BaseModel], str]] = {
    Conveyor: "spec",
    SizingDuty: "duty",
    RubberCompound: "compound",
}
"""Names of the formats."""
_HEADING_DEPTH: Final = 2  # of the headings of formats
_EMPTY_VALUES: Final[tuple[Any, ...]] = (None, "", [])
_ALIKE_BLOCKS: Final = (
    ("idlers.return.", "idlers.carry."),
    (".middle_roll.", ".roll."),
    ("route.further_feeding[].", "route.feeding."),
)
_SAME_LENGTH: Final = re.compile(r"at least (\d+) values, at most \1 values")
_HEADINGS: Final = (
    "| field | what | for example | allowed | without it |",
    "|---|---|---|---|---|",
)


def markdown_reference() -> str:
    """Write the reference of the file formats: units, every field of a spec, of a duty, of a compound file.

    Returns
    -------
    str
        Markdown: a section for each block in the order of the models, a table of its fields, a heading to
        link to.

    Examples
    --------
    >>> [line for line in markdown_reference().splitlines() if line.startswith("| `width`")][0]
    '| `width` | Width of the belt. | `1200 mm` | ≥ 100 mm, ≤ 5 m | **required** |'
    """
    known: _KnownBlocks = []
    spec, duty, compound = (
        _FormatWriter(Conveyor, known),
        _FormatWriter(SizingDuty, known),
        _FormatWriter(RubberCompound, []),
    )
    written = (
        *_intro_lines("spec"), *_unit_rows(), *spec.whole(), *_intro_lines("duty"), *duty.whole(),
        *_intro_lines("compound"),
        *compound.whole(),
    )  # fmt: skip
    return "\n".join(written) + "\n"


def format_fields(model: type[BaseModel]) -> dict[str, FormField]:
    """Return the value fields of a file format by path; ``[]`` is an entry of a list.

    Parameters
    ----------
    model : type of BaseModel
        `Conveyor` for a spec, `SizingDuty` for a duty, `RubberCompound` for a compound file.

    Examples
    --------
    >>> from conveyor.models import Conveyor
    >>> format_fields(Conveyor)["route.sections[].length"].allowed
    '> 0 m, ≤ 100 km'
    """
    return dict(_known_fields(model))


@cache
def _known_fields(model: type[BaseModel]) -> dict[str, FormField]:
    return dict(_walk_fields(model_layout(model), ""))


def example_value(model: type[BaseModel], path: str) -> ExampleValue | None:
    """Return an example value of a field as in a file; None for names of other files.

    Examples
    --------
    >>> from conveyor.models import Conveyor
    >>> example_value(Conveyor, "drive.wrap_angle")
    '210 deg'
    """
    leaf, first = _known_fields(model)[path], _first_of_kind(path)
    if model is SizingDuty and _known_fields(Conveyor).get(path) == leaf:
        return example_value(Conveyor, path)
    kinds = {Conveyor: STARTERS, SizingDuty: ("duty",)}.get(model, ())
    shown = (_value_at(_starter_data(kind), first) for kind in kinds)
    listed = _extra_examples()[_FORMATS[model]].get(first)
    written = (
        _shown_default(leaf.default, leaf) if leaf.default not in _EMPTY_VALUES else next(iter(leaf.choices), None)
    )
    return next((given for given in (*shown, listed, written) if given is not None), None)


def _first_of_kind(path: str) -> str:
    """Path of the same field in the first block of its kind."""
    for other, first in _ALIKE_BLOCKS:
        path = path.replace(other, first)
    return path


@cache
def _extra_examples() -> dict[str, dict[str, ExampleValue]]:
    """Example values of fields that no starter spec has."""
    text = files("conveyor._reference").joinpath("examples.yaml").read_text(encoding="utf-8")
    read: dict[str, dict[str, ExampleValue]] = YAML(typ="safe", pure=True).load(text)
    return read


@cache
def _starter_data(kind: Any) -> dict[str, Any]:
    return starter_values(kind, optional=True)


def _value_at(data: Any, path: str) -> Any:
    """Value at a path of plain data; in lists of the first entry that has it."""
    if not path:
        return data if not isinstance(data, Mapping) else None
    head, _, rest = path.partition(".")
    if not isinstance(data, Mapping) or head.removesuffix("[]") not in data:
        return None
    inner = data[head.removesuffix("[]")]
    if head.endswith("[]"):
        return next((given for item in inner if (given := _value_at(item, rest)) is not None), None)
    return _value_at(inner, rest)


def _walk_fields(part: Part, path: str) -> Iterator[tuple[str, FormField]]:
    if isinstance(part, FormField):
        yield path, part
        return
    for inner in part.parts:
        yield from _walk_fields(inner, _join_path(path + "[]" * isinstance(part, FieldTable), inner.key))


def _join_path(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def heading_anchor(heading: str) -> str:
    """Return the link target of a heading: lower case, hyphens, no other signs.

    Examples
    --------
    >>> heading_anchor("route.sections[]"), heading_anchor("The spec")
    ('routesections', 'the-spec')
    """
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def _intro_lines(name: str) -> list[str]:
    """Introduction of a format, as lines."""
    text = files("conveyor._reference").joinpath(f"{name}.md").read_text(encoding="utf-8")
    return [text.rstrip(), ""]


def _unit_rows() -> Iterator[str]:
    """Table of the kinds of quantity with their units."""
    yield "## Units"
    yield ""
    yield "`^2` may also be written `²` or `2`; `°C`, `°F` and `°` as well as `degC`, `degF` and `deg`."
    yield ""
    yield "| quantity | for example | units |"
    yield "|---|---|---|"
    said = set()
    for kind in INPUT_KINDS.values():
        units = " ".join(f"`{unit}`" for unit in dict.fromkeys(kind.units.values()) if unit)
        if kind.noun not in said:
            yield f"| {kind.noun} | `{kind.example}` | {units} |"
        said.add(kind.noun)
    yield ""


class _FormatWriter:
    """Sections of a file format; blocks with `known` fields link to their earlier section."""

    def __init__(self, model: type[BaseModel], known: _KnownBlocks) -> None:
        self._model = model
        self._known = known

    def whole(self) -> Iterator[str]:
        """Lines of the whole format."""
        yield from self.section(model_layout(self._model), "", f"The {_FORMATS[self._model]}")

    def section(self, part: FieldGroup | FieldTable, path: str, heading: str) -> Iterator[str]:
        """Lines of a block, then of the blocks in it."""
        level = _HEADING_DEPTH + min(2, path.count(".") + 1) if path else _HEADING_DEPTH
        yield f"{'#' * level} {heading}"
        yield ""
        doc = _as_sentence(part.doc)
        if isinstance(part, FieldTable):
            length = part.allowed.replace("rows", "entries").replace("row", "entry")
            doc = f"{doc} A list{f', {length}' if length else ''}."
        yield f"{doc}{'' if part.required else ' May be left out.'}"
        yield ""
        inside = part.parts
        same = next((title for parts, title in self._known if parts == inside), None)
        if same is not None:
            yield f"Its fields are those of [{same}](#{heading_anchor(same)})."
            yield ""
            return
        self._known.append((inside, heading))
        yield from _HEADINGS
        blocks = []
        for inner in inside:
            inner_path = _join_path(path, inner.key) + "[]" * isinstance(inner, FieldTable)
            if isinstance(inner, FormField):
                yield self._row(inner, inner_path)
            else:
                blocks.append((inner, inner_path))
                yield self._link(inner, inner_path)
        yield ""
        for inner, inner_path in blocks:
            yield from self.section(inner, inner_path, self._title(inner_path))

    def _title(self, path: str) -> str:
        return path if self._model is Conveyor else f"{_FORMATS[self._model]}: {path}"

    def _link(self, part: FieldGroup | FieldTable, path: str) -> str:
        what = "list" if isinstance(part, FieldTable) else "block"
        title = self._title(path)
        linked = f"{what} [{title}](#{heading_anchor(title)})"
        allowed = part.allowed if isinstance(part, FieldTable) else ""
        return _table_row(f"`{part.key}`", _as_sentence(part.doc), linked, allowed, _block_default(part))

    def _row(self, leaf: FormField, path: str) -> str:
        return _table_row(
            f"`{leaf.key}`",
            _as_sentence(leaf.doc),
            self._shown(leaf, path),
            _allowed_text(leaf),
            _default_text(leaf),
        )

    def _shown(self, leaf: FormField, path: str) -> str:
        if leaf.kind == "reference":
            return "`standard-cover`"
        given = example_value(self._model, path)
        return "" if given is None else f"`{_yaml_value(given)}`"


def _table_row(*texts: str) -> str:
    return "| " + " | ".join(text.replace("|", "\\|") for text in texts) + " |"


def _as_sentence(doc: str) -> str:
    plain = doc.strip()
    return plain if not plain or plain.endswith((".", ")")) else plain + "."


def _allowed_text(leaf: FormField) -> str:
    if leaf.kind == "switch":
        return "`true`, `false`"
    words = ", ".join(f"`{choice}`" for choice in leaf.choices)
    if not words:
        said = "" if leaf.kind == "text" and leaf.allowed.startswith("such as") else leaf.allowed
        return _SAME_LENGTH.sub(r"\1 values", said)
    if leaf.kind == "quantity":
        return f"{leaf.allowed.split(' or ', maxsplit=1)[0]} or {words}"
    return ", ".join(filter(None, (words, leaf.allowed)))


def _default_text(leaf: FormField) -> str:
    if leaf.required:
        return "**required**"
    if leaf.default in _EMPTY_VALUES:
        return ""
    return f"`{_yaml_value(_shown_default(leaf.default, leaf))}`"


def _block_default(part: FieldGroup | FieldTable) -> str:
    if part.required:
        return "**required**"
    leaves = [inner for inner in part.parts if isinstance(inner, FormField)]
    optional = isinstance(part, FieldGroup) and not any(inner.required for inner in part.parts)
    given = any(leaf.default not in (*_EMPTY_VALUES, False) for leaf in leaves)
    return "its defaults" if optional and given else "none of it"


def _shown_default(value: Any, leaf: FormField) -> Any:
    """Default as people write it: shares in per cent."""
    if isinstance(value, float) and "%" in leaf.units:
        return f"{100.0 * value:g} %"
    return value


def _yaml_value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return re.sub(r"e([+-])0", r"e\1", f"{value:g}").replace("e+", "e")
    return f"[{', '.join(map(_yaml_value, value))}]" if isinstance(value, list | tuple) else str(value)
