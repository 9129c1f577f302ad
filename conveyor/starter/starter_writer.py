"""Starter specs: values from this folder, comments from the models' own sentences."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal

from conveyor.forms.form_fields import (
    FieldGroup,
    FieldTable,
    FormField,
    Part,
    in_unit_of,
    limits_in_unit_of,
    model_layout,
)
from conveyor.models import Conveyor
from conveyor.models.sizing import SizingDuty
from conveyor.starter.starter_data import LEFT_OUT, OPTIONAL, Kind, in_units, read_values
from conveyor.units import System
from conveyor.units.misreadings import escape_line_breaks
from conveyor.units.quantity_kinds import KINDS as QUANTITIES

_PLAIN_NAME: Final = re.compile(r"[\w.,:/\\+~-]+")
_WIDTH: Final = 112
_COMMENT_COLUMN: Final = 40
_HEADING: Final = """\
# {name} to begin with. Replace the values by yours, then:
{commands}
# Lines that begin with "# key:" are fields that may be left out: remove "# " to use them.
# Every value with a dimension carries its unit; a bare number is refused, a decimal comma and "ton" too. Units:
{units}
{more}
"""
_SPEC_HINT: Final = """\
# All fields: conveyor schema. The same as a workbook to fill in: conveyor template input.xlsx --from {file}"""
_DUTY_HINT: Final = "# All rules and prices: docs/sizing.md. One slope: length and lift instead of route."
_SHOWN_KINDS: Final = (
    "length", "speed", "angle", "mass", "belt mass", "density", "mass flow", "force", "line force", "pressure",
    "power", "temperature", "fraction",
)  # fmt: skip


def starter_text(kind: Kind | Literal["duty"], units: System = "SI", *, file: str = "spec.yaml") -> str:
    """Write a starter spec with a comment for every field.

    Parameters
    ----------
    kind : {"overland", "in-plant", "downhill", "duty"}
        Conveyor; or the duty of one that is to be sized.
    units : {"SI", "US"}
        System of units.
    file : str
        Name of the spec in the commands its heading shows.

    Examples
    --------
    >>> next(line for line in starter_text("overland").splitlines() if line.startswith("name"))
    'name: My overland conveyor              # What the conveyor is called in reports.'
    """
    name, words = quote_path(file), read_values("words.yaml")
    if kind == "duty":
        words = {path: said for path, said in words.items() if not path.startswith("operation")}
        lines = _SpecWriter(units, words).group(model_layout(SizingDuty), read_values("duty.yaml"), ())
        about = (
            "A conveyor's duty",
            f"#   conveyor size {name}\n#   conveyor size {name} -o design.yaml",
            _DUTY_HINT,
        )
    else:
        lines = _SpecWriter(units, words).group(model_layout(Conveyor), read_values(f"{kind}.yaml"), ())
        commands = f"#   conveyor power {name}\n#   conveyor power {name} -o report.xlsx"
        about = f"A conveyor ({kind})", commands, _SPEC_HINT.format(file=name)
    heading = _HEADING.format(name=about[0], commands=about[1], units=_unit_lines(), more=about[2])
    return "\n".join([heading, *lines]).rstrip() + "\n"


def quote_path(name: str) -> str:
    """File name for a command line: quoted where it has blanks, always on one line.

    Examples
    --------
    >>> quote_path("mine.yaml"), quote_path("my belt.yaml")
    ('mine.yaml', '"my belt.yaml"')
    """
    return name if _PLAIN_NAME.fullmatch(name) else f'"{escape_line_breaks(name)}"'


def _unit_lines() -> str:
    """Comment lines with the units of common quantities."""
    listed = (f"{kind}: {' '.join(dict.fromkeys(QUANTITIES[kind].units.values()))}" for kind in _SHOWN_KINDS)
    return textwrap.fill(
        "; ".join(part.strip() for part in listed),
        _WIDTH,
        initial_indent="#   ",
        subsequent_indent="#   ",
        break_on_hyphens=False,
        break_long_words=False,
    )


class _SpecWriter:
    """Lines of a spec: values on the left, comments on the right."""

    def __init__(self, units: System, words: Mapping[str, str]) -> None:
        self._units: System = units
        self._words = words

    def group(self, group: FieldGroup, data: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
        """Lines of the fields of a model that the data have, in the model's order."""
        for part in group.parts:
            given = data.get(part.key, data.get(part.key + OPTIONAL, LEFT_OUT))
            if in_units(given, self._units) == LEFT_OUT:
                continue
            if part.key in data:
                yield from self._part(part, data[part.key], (*path, part.key))
            else:
                lines = list(self._part(part, data[part.key + OPTIONAL], (*path, part.key)))
                yield from (_comment_out(line, "  " * len(path)) for line in lines)

    def _part(self, part: Part, data: Any, path: tuple[str, ...]) -> Iterator[str]:
        indent = "  " * (len(path) - 1)
        if len(path) == 1 and part.key != "name":
            yield ""
        if isinstance(part, FormField):
            value = in_units(data, self._units)
            yield from _with_comment(f"{indent}{part.key}: {_scalar_text(value)}", self._comment(part, path, value))
            return
        yield from _with_comment(f"{indent}{part.key}:", self._comment(part, path))
        if isinstance(part, FieldGroup):
            yield from self.group(part, data, path)
        else:
            yield from self._table(part, data, path)

    def _table(self, table: FieldTable, data: list[dict[str, Any]], path: tuple[str, ...]) -> Iterator[str]:
        """Lines of a list: comments on its fields, then the rows."""
        indent = "  " * len(path)
        shown = dict.fromkeys(key for row in data for key in row)
        fields = [part for part in table.parts if part.key in shown]
        widest = max(len(part.key) for part in fields)
        for part in fields:
            opening = f"{indent}# {part.key.ljust(widest)}  "
            value = in_units(next(row[part.key] for row in data if part.key in row), self._units)
            comment = self._comment(part, (*path, part.key), value)
            yield from _wrap_comment(opening, f"{indent}# {' ' * widest}  ", comment)
        for row in data:
            cells = ", ".join(f"{key}: {_scalar_text(in_units(value, self._units))}" for key, value in row.items())
            yield f"{indent}- {{{cells}}}"

    def _comment(self, part: Part, path: tuple[str, ...], value: Any = None) -> str:
        """Comment of a field: meaning, range in the unit of its value, default."""
        doc = self._words.get(".".join(path), part.doc)
        said = [doc if doc.endswith(".") or not doc else doc + "."]
        if isinstance(part, FormField):
            if part.choices:
                said.append(f"One of: {', '.join(map(str, part.choices))}.")
            elif part.allowed and part.kind != "text":
                allowed = limits_in_unit_of(part.allowed, value)
                said.append(f"{allowed[0].upper()}{allowed[1:]}.")
        if not part.required:
            said.append(_default_comment(part, doc, value))
        return " ".join(filter(None, said))


def _default_comment(part: Part, doc: str, value: Any) -> str:
    """Sentence on the default of an optional field."""
    default = part.default if isinstance(part, FormField) else None
    if isinstance(default, float) and isinstance(part, FormField) and "%" in part.units:
        default = f"{100.0 * default:g} %"
    if default is not None and default != []:
        held = in_unit_of(default, value) if isinstance(part, FormField) and part.kind == "quantity" else None
        return f"Without it: {_scalar_text(default) if held is None else f'{held[0]:.4g} {held[1]}'}."
    told = any(word in doc for word in ("ithout", "else ", "needed where", "instead of", "where it differs"))
    return "" if told else "May be left out."


def _scalar_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"[{', '.join(map(_scalar_text, value))}]" if isinstance(value, list) else str(value)


def _comment_out(line: str, indent: str) -> str:
    """Comment out a line; its own comment keeps its column where there is room."""
    if not line or line.strip().startswith("#"):
        return line
    left, gap, comment = line.removeprefix(indent).partition("  # ")
    kept = left.rstrip().ljust(len(left) - 2)
    return f"{indent}# {kept}{gap}{comment}"


def _with_comment(left: str, comment: str) -> list[str]:
    """Value with a comment to its right, over several lines where it is long."""
    if not comment:
        return [left]
    opening = left.ljust(_COMMENT_COLUMN - 2) + "  # "
    return _wrap_comment(opening, " " * (len(opening) - 2) + "# ", comment)


_LIMIT_PATTERN: Final = re.compile(r"([<>≤≥]) (\S+)(?: (?=\S*[^\W\d]|%)([^\s,.]+))?")


def _wrap_comment(first: str, further: str, told: str) -> list[str]:
    held = _LIMIT_PATTERN.sub(lambda m: "\u00a0".join(part for part in m.groups() if part), told)
    lines = textwrap.wrap(
        held,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=further,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace("\u00a0", " ") for line in lines]
