"""Starter specs: values from this folder, comments from the models' own sentences."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any, Final, Literal, get_args

from ruamel.yaml import YAML

from conveyor.models import Conveyor
from conveyor.template.layout import FieldGroup, FieldTable, Leaf, Part, layout
from conveyor.units import System, quantity, text
from conveyor.units.kinds import KINDS as QUANTITIES
from conveyor.units.misreadings import on_one_line

Kind = Literal["overland", "in-plant", "downhill"]
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
"""Conveyors there is a starter of."""

_PLAIN_NAME: Final = re.compile(r"[\w.,:/\\+~-]+")
_OPTIONAL: Final = "?"
_WIDTH: Final = 112
_COMMENT_COLUMN: Final = 40
_HEADING: Final = """\
# {name} to begin with. Replace the values by yours, then:
#   conveyor power {file}
#   conveyor power {file} -o report.xlsx
# Lines that begin with "# key:" are fields that may be left out: remove "# " to use them.
# Every value with a dimension carries its unit; a bare number is refused, a decimal comma and "ton" too. Units:
{units}
# All fields: conveyor schema. The same as a workbook to fill in: conveyor template input.xlsx --from {file}
"""
_SHOWN_KINDS: Final = (
    "length", "speed", "angle", "mass", "belt mass", "density", "mass flow", "force", "line force", "pressure",
    "power", "temperature", "fraction",
)  # fmt: skip


@cache
def _read(name: str) -> dict[str, Any]:
    """Read a file of this folder."""
    content = files("conveyor.starter").joinpath(name).read_text(encoding="utf-8")
    read: dict[str, Any] = YAML(typ="safe", pure=True).load(content)
    return read


def values(kind: Kind, units: System = "SI", *, optional: bool = False) -> dict[str, Any]:
    """Return the plain data of a starter spec.

    Parameters
    ----------
    kind : {"overland", "in-plant", "downhill"}
        Conveyor.
    units : {"SI", "US"}
        System of units.
    optional : bool
        Whether the fields that the spec shows as comments are in it, too.

    Examples
    --------
    >>> values("in-plant", "US")["belt"]["width"]
    '42 in'
    """
    found: dict[str, Any] = _plain(_read(f"{kind}.yaml"), units, optional=optional)
    return found


def _plain(value: Any, units: System, *, optional: bool) -> Any:
    if isinstance(value, Mapping):
        return {
            key.removesuffix(_OPTIONAL): _plain(item, units, optional=optional)
            for key, item in value.items()
            if optional or not key.endswith(_OPTIONAL)
        }
    if isinstance(value, list):
        return [_plain(item, units, optional=optional) for item in value]
    return _in(value, units)


def _in(value: Any, units: System) -> Any:
    """Take the value of a system of units from ``SI | US``."""
    if not isinstance(value, str) or " | " not in value:
        return value
    chosen = value.split(" | ")[0 if units == "SI" else 1]
    return chosen.strip("[]").split(", ") if chosen.startswith("[") else chosen


def written(kind: Kind, units: System = "SI", *, file: str = "spec.yaml") -> str:
    """Write a starter spec with a comment for every field.

    Parameters
    ----------
    kind : {"overland", "in-plant", "downhill"}
        Conveyor.
    units : {"SI", "US"}
        System of units.
    file : str
        Name of the spec in the commands its heading shows.

    Examples
    --------
    >>> next(line for line in written("overland").splitlines() if line.startswith("name"))
    'name: My overland conveyor              # What the conveyor is called in reports.'
    """
    lines = _Writer(units).group(layout(Conveyor), _read(f"{kind}.yaml"), ())
    heading = _HEADING.format(name=f"A conveyor ({kind})", file=quoted(file), units=_units())
    return "\n".join([heading, *lines]).rstrip() + "\n"


def quoted(name: str) -> str:
    """Write the name of a file as it stands in a command: in quotes where it has blanks, on one line in any case.

    Examples
    --------
    >>> quoted("mine.yaml"), quoted("my belt.yaml")
    ('mine.yaml', '"my belt.yaml"')
    """
    return name if _PLAIN_NAME.fullmatch(name) else f'"{on_one_line(name)}"'


def _units() -> str:
    """List the units of the kinds of quantity that a newcomer meets first."""
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
    """Lines of a spec: a value on the left, what it means on the right."""

    def __init__(self, units: System) -> None:
        self._units: System = units
        self._words = _read("words.yaml")

    def group(self, group: FieldGroup, data: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
        """Write the fields of a model that the data have, in the model's order."""
        for part in group.parts:
            if part.key in data:
                yield from self._part(part, data[part.key], (*path, part.key))
            elif part.key + _OPTIONAL in data:
                lines = list(self._part(part, data[part.key + _OPTIONAL], (*path, part.key)))
                yield from (_commented(line, "  " * len(path)) for line in lines)

    def _part(self, part: Part, data: Any, path: tuple[str, ...]) -> Iterator[str]:
        indent = "  " * (len(path) - 1)
        if len(path) == 1 and part.key != "name":
            yield ""
        if isinstance(part, Leaf):
            value = _in(data, self._units)
            yield from _beside(f"{indent}{part.key}: {_scalar(value)}", self._comment(part, path, value))
            return
        yield from _beside(f"{indent}{part.key}:", self._comment(part, path))
        if isinstance(part, FieldGroup):
            yield from self.group(part, data, path)
        else:
            yield from self._table(part, data, path)

    def _table(self, table: FieldTable, data: list[dict[str, Any]], path: tuple[str, ...]) -> Iterator[str]:
        """Write what the fields of a row mean, then the rows."""
        indent = "  " * len(path)
        shown = dict.fromkeys(key for row in data for key in row)
        fields = [part for part in table.item.parts if part.key in shown]
        widest = max(len(part.key) for part in fields)
        for part in fields:
            opening = f"{indent}# {part.key.ljust(widest)}  "
            value = _in(next(row[part.key] for row in data if part.key in row), self._units)
            comment = self._comment(part, (*path, part.key), value)
            yield from _wrapped(opening, f"{indent}# {' ' * widest}  ", comment)
        for row in data:
            cells = ", ".join(f"{key}: {_scalar(_in(value, self._units))}" for key, value in row.items())
            yield f"{indent}- {{{cells}}}"

    def _comment(self, part: Part, path: tuple[str, ...], value: Any = None) -> str:
        """Say what a field means, its range in the unit of its value, and what is taken without it."""
        doc = self._words.get(".".join(path), part.doc)
        said = [doc if doc.endswith(".") or not doc else doc + "."]
        if isinstance(part, Leaf):
            if part.choices:
                said.append(f"One of: {', '.join(map(str, part.choices))}.")
            elif part.allowed and part.kind != "text":
                allowed = _BOUND.sub(lambda found: _limit(found, value), part.allowed)
                said.append(f"{allowed[0].upper()}{allowed[1:]}.")
        if not part.required:
            said.append(_without(part, doc, value))
        return " ".join(filter(None, said))


_BOUND: Final = re.compile(r"([<>≤≥]) ([^ ,]+ [^ ,]+)")
_DIGITS: Final = 3


def _limit(found: re.Match[str], value: Any) -> str:
    """Write a limit in the unit of a value, to three digits rounded inwards: what is said is allowed."""
    limit = _like(found[2], value)
    if limit is None or limit[1] == found[2].split(" ")[1]:
        return found[0]
    number, unit = limit
    digits = _DIGITS - 1 - (math.floor(math.log10(abs(number))) if number else 0)
    towards = math.ceil if found[1] in ">≥" else math.floor
    near = round(number, digits)  # of 19999.999999999996 the 20000 that is meant
    inward = (
        near if math.isclose(near, number, rel_tol=1e-9) else towards(number * 10.0**digits) / 10.0**digits
    )
    return f"{found[1]} {_plain_number(inward)} {unit}"


def _like(given: str, value: Any) -> tuple[float, str] | None:
    """Return the number and the unit of a quantity, in the unit of another where both are quantities."""
    value = value[0] if isinstance(value, list) and value else value
    if not isinstance(value, str) or len(value.split(" ")) != 2:
        return None
    like = quantity(value)
    unit = text(like).split(" ")[1]
    return float(quantity(given).to(like.units).magnitude), unit


def _plain_number(number: float) -> str:
    return f"{number:.0f}" if abs(number) >= 10.0**_DIGITS else f"{number:.4g}"


def _without(part: Part, doc: str, value: Any) -> str:
    """Say what happens when a field is left out."""
    default = part.default if isinstance(part, Leaf) else None
    if isinstance(default, float) and isinstance(part, Leaf) and "%" in part.units:
        default = f"{100.0 * default:g} %"
    if default is not None and default != []:
        like = _like(default, value) if isinstance(part, Leaf) and part.kind == "quantity" else None
        return f"Without it: {_scalar(default) if like is None else f'{like[0]:.4g} {like[1]}'}."
    told = any(word in doc for word in ("ithout", "else ", "needed where", "instead of", "where it differs"))
    return "" if told else "May be left out."


def _scalar(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"[{', '.join(map(_scalar, value))}]" if isinstance(value, list) else str(value)


def _commented(line: str, indent: str) -> str:
    """Turn a line into a comment; what stands beside it keeps its column where there is room."""
    if not line or line.strip().startswith("#"):
        return line
    left, gap, comment = line.removeprefix(indent).partition("  # ")
    kept = left.rstrip().ljust(len(left) - 2)
    return f"{indent}# {kept}{gap}{comment}"


def _beside(left: str, comment: str) -> list[str]:
    """Put a comment to the right of a value, over several lines where it is long."""
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
