"""Starter specs: values from this folder, comments from the models' own sentences."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, Final, Literal

from conveyor.forms.layout import FieldGroup, FieldTable, Leaf, Part, layout, like, limits_like
from conveyor.models import Conveyor
from conveyor.models.sizing import SizingDuty
from conveyor.starter.values import LEFT_OUT, OPTIONAL, Kind, in_units, read
from conveyor.units import System
from conveyor.units.kinds import KINDS as QUANTITIES
from conveyor.units.misreadings import on_one_line

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
_OF_SPECS: Final = """\
# All fields: conveyor schema. The same as a workbook to fill in: conveyor template input.xlsx --from {file}"""
_OF_DUTIES: Final = "# All rules and prices: docs/sizing.md. One slope: length and lift instead of route."
_SHOWN_KINDS: Final = (
    "length", "speed", "angle", "mass", "belt mass", "density", "mass flow", "force", "line force", "pressure",
    "power", "temperature", "fraction",
)  # fmt: skip


def written(kind: Kind | Literal["duty"], units: System = "SI", *, file: str = "spec.yaml") -> str:
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
    >>> next(line for line in written("overland").splitlines() if line.startswith("name"))
    'name: My overland conveyor              # What the conveyor is called in reports.'
    """
    name, words = quoted(file), read("words.yaml")
    if kind == "duty":
        words = {path: said for path, said in words.items() if not path.startswith("operation")}
        lines = _Writer(units, words).group(layout(SizingDuty), read("duty.yaml"), ())
        about = (
            "A conveyor's duty",
            f"#   conveyor size {name}\n#   conveyor size {name} -o design.yaml",
            _OF_DUTIES,
        )
    else:
        lines = _Writer(units, words).group(layout(Conveyor), read(f"{kind}.yaml"), ())
        commands = f"#   conveyor power {name}\n#   conveyor power {name} -o report.xlsx"
        about = f"A conveyor ({kind})", commands, _OF_SPECS.format(file=name)
    heading = _HEADING.format(name=about[0], commands=about[1], units=_units(), more=about[2])
    return "\n".join([heading, *lines]).rstrip() + "\n"


def quoted(name: str) -> str:
    """File name for a command line: quoted where it has blanks, always on one line.

    Examples
    --------
    >>> quoted("mine.yaml"), quoted("my belt.yaml")
    ('mine.yaml', '"my belt.yaml"')
    """
    return name if _PLAIN_NAME.fullmatch(name) else f'"{on_one_line(name)}"'


def _units() -> str:
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


class _Writer:
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
                yield from (_commented(line, "  " * len(path)) for line in lines)

    def _part(self, part: Part, data: Any, path: tuple[str, ...]) -> Iterator[str]:
        indent = "  " * (len(path) - 1)
        if len(path) == 1 and part.key != "name":
            yield ""
        if isinstance(part, Leaf):
            value = in_units(data, self._units)
            yield from _beside(f"{indent}{part.key}: {_scalar(value)}", self._comment(part, path, value))
            return
        yield from _beside(f"{indent}{part.key}:", self._comment(part, path))
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
            yield from _wrapped(opening, f"{indent}# {' ' * widest}  ", comment)
        for row in data:
            cells = ", ".join(f"{key}: {_scalar(in_units(value, self._units))}" for key, value in row.items())
            yield f"{indent}- {{{cells}}}"

    def _comment(self, part: Part, path: tuple[str, ...], value: Any = None) -> str:
        """Comment of a field: meaning, range in the unit of its value, default."""
        doc = self._words.get(".".join(path), part.doc)
        said = [doc if doc.endswith(".") or not doc else doc + "."]
        if isinstance(part, Leaf):
            if part.choices:
                said.append(f"One of: {', '.join(map(str, part.choices))}.")
            elif part.allowed and part.kind != "text":
                allowed = limits_like(part.allowed, value)
                said.append(f"{allowed[0].upper()}{allowed[1:]}.")
        if not part.required:
            said.append(_without(part, doc, value))
        return " ".join(filter(None, said))


def _without(part: Part, doc: str, value: Any) -> str:
    """Sentence on the default of an optional field."""
    default = part.default if isinstance(part, Leaf) else None
    if isinstance(default, float) and isinstance(part, Leaf) and "%" in part.units:
        default = f"{100.0 * default:g} %"
    if default is not None and default != []:
        held = like(default, value) if isinstance(part, Leaf) and part.kind == "quantity" else None
        return f"Without it: {_scalar(default) if held is None else f'{held[0]:.4g} {held[1]}'}."
    told = any(word in doc for word in ("ithout", "else ", "needed where", "instead of", "where it differs"))
    return "" if told else "May be left out."


def _scalar(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"[{', '.join(map(_scalar, value))}]" if isinstance(value, list) else str(value)


def _commented(line: str, indent: str) -> str:
    """Comment out a line; its own comment keeps its column where there is room."""
    if not line or line.strip().startswith("#"):
        return line
    left, gap, comment = line.removeprefix(indent).partition("  # ")
    kept = left.rstrip().ljust(len(left) - 2)
    return f"{indent}# {kept}{gap}{comment}"


def _beside(left: str, comment: str) -> list[str]:
    """Value with a comment to its right, over several lines where it is long."""
    if not comment:
        return [left]
    opening = left.ljust(_COMMENT_COLUMN - 2) + "  # "
    return _wrapped(opening, " " * (len(opening) - 2) + "# ", comment)


_LIMIT: Final = re.compile(r"([<>≤≥]) (\S+)(?: (?=\S*[^\W\d]|%)([^\s,.]+))?")


def _wrapped(first: str, further: str, told: str) -> list[str]:
    held = _LIMIT.sub(lambda m: "\u00a0".join(part for part in m.groups() if part), told)
    lines = textwrap.wrap(
        held,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=further,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace("\u00a0", " ") for line in lines]
