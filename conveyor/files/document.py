"""YAML and JSON files with line and column of every value; duplicate keys, tags and huge files are refused."""

from __future__ import annotations

import codecs
import json
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, ReusedAnchorWarning, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from conveyor.errors import InputError
from conveyor.files.file_bytes import file_content
from conveyor.files.syntax_messages import json_message, yaml_message

LARGEST_FILE: Final = 5_000_000
"""Bytes; a spec of 20,000 sections, the most there may be, has half of it."""
MOST_NODES: Final = 500_000
"""Values after aliases are expanded: stops a file whose aliases multiply."""
DEEPEST: Final = 50
"""Levels of nesting; a spec has 7."""

MOST_LINES: Final = 100
"""Errors listed of one file; the rest are counted."""

_BYTE_ORDER_MARKS: Final = {codecs.BOM_UTF32_LE: "UTF-32", codecs.BOM_UTF32_BE: "UTF-32", codecs.BOM_UTF16_LE: "UTF-16",
          codecs.BOM_UTF16_BE: "UTF-16"}  # fmt: skip

_TOO_DEEP: Final = f"nested deeper than {DEEPEST} levels"
_SURROGATES: Final = re.compile("[\ud800-\udfff]")
_BYTES_PROBED: Final = 1000  # bytes searched for nulls

Location = tuple[int | str, ...]
T = TypeVar("T")
_TAG_PREFIX = "tag:yaml.org,2002:"


class Place(NamedTuple):
    """Line and column, both from 1."""

    line: int
    column: int


@dataclass(frozen=True)
class Fault:
    """An error at a place of a file: the field (or subject) and what to change."""

    place: Place
    field: str
    message: str

    def line(self, path: str) -> str:
        """Text ``file:line:column field: message``."""
        return f"{path}:{self.place.line}:{self.place.column} {self.field}: {self.message}"


def error_lines(errors: Sequence[T], line: Callable[[T], str], path: str = "") -> str:
    """Text of the first hundred errors, one a line; the rest are counted."""
    lines = [line(error) for error in errors[:MOST_LINES]]
    if len(errors) > MOST_LINES:
        lines.append(f"{path}{': ' if path else ''}and {len(errors) - MOST_LINES} more errors")
    return "\n".join(lines)


def fault_lines(path: str, findings: Sequence[Fault]) -> str:
    """Text of the first hundred findings, one a line."""
    return error_lines(findings, lambda finding: finding.line(path), path)


def yaml_text(data: Any, *, width: int) -> str:
    """Write plain data as YAML, long lines broken at a width [characters]."""
    writer = YAML(typ="rt", pure=True)
    writer.width = width
    stream = StringIO()
    writer.dump(data, stream)
    return stream.getvalue()


@dataclass(frozen=True)
class Document:
    """Plain data of a file, its findings, and the nodes that give the places."""

    path: str
    data: Any
    root: Node
    findings: tuple[Fault, ...]

    def place(self, location: Location, *, of_key: bool = False) -> Place:
        """Place of a field, or of its nearest existing parent.

        Parameters
        ----------
        location : tuple
            Keys and indices from the root; parts that are not in the file (tags of unions) are skipped.
        of_key : bool
            Point at the key instead of the value.
        """
        known: Location = ()
        for part in location:
            down = next((way for way in ((*known, part), (*known, str(part))) if way in self._places), known)
            known = down
        of_value, of_its_key = self._places[known]
        return of_its_key if of_key else of_value

    @cached_property
    def _places(self) -> dict[Location, tuple[Place, Place]]:
        """Places of every value and of its key, by location."""
        places: dict[Location, tuple[Place, Place]] = {}
        nodes: list[tuple[Location, Node, Node]] = [((), self.root, self.root)]
        while nodes:
            location, key, node = nodes.pop()
            of_key = _node_place(key)
            places[location] = (_node_place(node) if key is node or _has_own_place(node) else of_key), of_key
            if isinstance(node, MappingNode):
                written: dict[str, tuple[Node, Node]] = {}
                for k, v in node.value:
                    written.setdefault(str(k.value), (k, v))
                nodes += [((*location, name), k, v) for name, (k, v) in written.items()]
            elif isinstance(node, SequenceNode):
                nodes += [((*location, i), item, item) for i, item in enumerate(node.value)]
        return places


def _has_own_place(node: Node) -> bool:
    """True for a scalar with text; YAML places empty values and blocks at the start of the next line."""
    return isinstance(node, ScalarNode) and (node.value != "" or node.style is not None)


def _node_place(node: Node) -> Place:
    return Place(node.start_mark.line + 1, node.start_mark.column + 1)


def read_document(path: Path) -> Document:
    """Read a ``.yaml``, ``.yml`` or ``.json`` file.

    Raises
    ------
    InputError
        The file cannot be read, is not UTF-8, too large, empty, of wrong syntax, or no mapping.
        Duplicate keys, tags and merge keys do not raise: they are in `Document.findings`.
    """
    if path.suffix.lower() not in {".yaml", ".yml", ".json"}:
        if path.is_dir():
            raise InputError(f"{path}: is a folder; give a file in it")
        raise InputError(f'{path}: expected a file that ends in .yaml, .yml or .json, got "{path.name}"')
    return parse_document(_file_text(path), path)


def parse_document(content: str, path: Path) -> Document:
    """Read the text of a file; `path` gives its format and stands in messages.

    Raises
    ------
    InputError
        As `read_document`.
    """
    is_json = path.suffix.lower() == ".json"
    data: Any = _json_data(content, path) if is_json else None
    root = _yaml_nodes(content.replace("\t", " ") if is_json else content, path)
    if root is None:
        raise InputError(f"{path}:1:1 file: empty; expected fields (key: value)")
    if not isinstance(root, MappingNode):
        given = "a list" if isinstance(root, SequenceNode) else "a single value"
        place = _node_place(root)
        raise InputError(f"{path}:{place.line}:{place.column} file: expected fields (key: value), got {given}")
    reader = _NodeReader(str(path))
    read = reader.value(root, ())
    return Document(str(path), data if is_json else read, root, tuple(reader.findings))


def _file_text(path: Path) -> str:
    content = file_content(path, largest=LARGEST_FILE, expected="spec or compound file")
    for mark, encoding in _BYTE_ORDER_MARKS.items():
        if content.startswith(mark):
            raise InputError(f"{path}:1:1 file: {encoding} text, expected UTF-8; save it as UTF-8")
    if b"\0" in content[:_BYTES_PROBED]:
        raise InputError(f"{path}:1:1 file: holds null bytes: UTF-16 without its mark, or no text; save it as UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = content[: error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise InputError(
            f"{path}:{line}:{column} file: not UTF-8 text (byte 0x{content[error.start]:02x}); save it as UTF-8"
        ) from None


def _json_data(content: str, path: Path) -> Any:
    if not content.strip():
        return None
    try:
        return json.loads(content, parse_int=lambda digits: _plain_number(digits, "int"))
    except json.JSONDecodeError as error:
        raise InputError(f"{path}:{error.lineno}:{error.colno} syntax: {json_message(error.msg)}") from None
    except RecursionError:
        raise InputError(f"{path}:1:1 syntax: {_TOO_DEEP}") from None


def _parse_yaml(content: str, kind: str) -> Node | None:
    parser = YAML(typ=kind, pure=True)
    parser.max_depth = DEEPEST + 1  # parsing time grows with the square of the depth
    with warnings.catch_warnings():
        warnings.simplefilter("error", ReusedAnchorWarning)
        node: Node | None = parser.compose(content)
    return node


def _yaml_nodes(content: str, path: Path) -> Node | None:
    """YAML nodes of a text; errors come from the slower round-trip parser, whose messages are better."""
    with suppress(YAMLError, ReusedAnchorWarning, RecursionError):
        return _parse_yaml(content, "safe")
    try:
        return _parse_yaml(content, "rt")
    except ReusedAnchorWarning as twice:
        line, column = map(int, re.findall(r"line (\d+), column (\d+)", str(twice))[-1])
        raise InputError(
            f"{path}:{line}:{column} syntax: the anchor (&) is given twice; write the value itself"
        ) from None
    except MarkedYAMLError as error:
        unclosed = "stream" in str(error.problem)
        mark = (error.context_mark if unclosed else None) or error.problem_mark or error.context_mark
        line, column = (1, 1) if mark is None else (mark.line + 1, mark.column + 1)
        what = " ".join(part for part in (error.context, error.problem) if part)
        said = _TOO_DEEP if "maximum depth" in what else yaml_message(what)
        raise InputError(f"{path}:{line}:{column} syntax: {said}") from None
    except YAMLError as error:
        position = getattr(error, "position", 0)
        before = content[:position]
        line, column = before.count("\n") + 1, position - before.rfind("\n")
        reason = getattr(error, "reason", str(error))
        raise InputError(f"{path}:{line}:{column} syntax: {yaml_message(reason)}") from None
    except RecursionError:
        raise InputError(f"{path}:1:1 syntax: {_TOO_DEEP}") from None


class _NodeReader:
    """Turns nodes into plain data and collects findings."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.findings: list[Fault] = []
        self._count = 0

    def value(self, node: Node, location: Location) -> Any:
        """Return the plain data of a node."""
        self._count += 1
        place = _node_place(node)
        if self._count > MOST_NODES:
            raise InputError(
                f"{self.path}:{place.line}:{place.column} file: more than {MOST_NODES:,} values, aliases expanded"
            )
        if len(location) > DEEPEST:
            raise InputError(f"{self.path}:{place.line}:{place.column} file: {_TOO_DEEP}")
        if isinstance(node, MappingNode) and node.tag == _TAG_PREFIX + "map":
            return dict(self._pairs(node, location))
        if isinstance(node, SequenceNode) and node.tag == _TAG_PREFIX + "seq":
            return [self.value(item, (*location, i)) for i, item in enumerate(node.value)]
        if isinstance(node, ScalarNode):
            return self._scalar(node, location)
        return self._not_allowed(node, location)

    def _not_allowed(self, node: Node, location: Location) -> None:
        tag = str(node.tag).replace(_TAG_PREFIX, "!!")
        self.findings.append(
            Fault(
                _node_place(node),
                _location_text(location),
                f"the tag {tag} is not allowed; write plain values",
            )
        )

    def _pairs(self, node: MappingNode, location: Location) -> Iterator[tuple[str, Any]]:
        first: dict[str, Place] = {}
        for key, value in node.value:
            if not isinstance(key, ScalarNode):
                self.findings.append(
                    Fault(
                        _node_place(key),
                        _location_text(location),
                        "expected text before the colon, got a list or fields",
                    )
                )
                continue
            name = self._whole(key)
            field = _location_text((*location, name))
            if key.tag == _TAG_PREFIX + "merge":
                message = "merge keys (<<) are not allowed; write the fields out"
                self.findings.append(Fault(_node_place(key), field, message))
            elif name in first:
                message = f"given twice, first in line {first[name].line}; remove one"
                self.findings.append(Fault(_node_place(key), field, message))
            else:
                first[name] = _node_place(key)
                yield name, self.value(value, (*location, name))

    def _whole(self, node: ScalarNode) -> str:
        """Text of a node, surrogate pairs combined."""
        content = str(node.value)
        try:
            return (
                content.encode("utf-16", "surrogatepass").decode("utf-16") if _SURROGATES.search(content) else content
            )
        except UnicodeDecodeError:
            line, column = _node_place(node)
            raise InputError(
                f"{self.path}:{line}:{column} file: half of a character (a lone surrogate); remove it"
            ) from None

    def _scalar(self, node: ScalarNode, location: Location) -> Any:
        content, kind = self._whole(node), str(node.tag).removeprefix(_TAG_PREFIX)
        if kind in {"str", "timestamp"}:
            return content
        if kind == "null":
            return None
        if kind == "bool":
            return content.lower() in {"true", "yes", "on", "y"}
        if kind in {"int", "float"}:
            return _plain_number(content, kind)
        return self._not_allowed(node, location)


def _plain_number(content: str, kind: str) -> int | float | str:
    """Read a plain number; 1_000 and numbers that are too long stay text, which the models refuse."""
    try:
        if "_" in content:
            return content
        if kind == "int":
            return int(content, 0)
        return float(content.lower().replace(".inf", "inf").replace(".nan", "nan"))
    except ValueError:
        return content


def _location_text(location: Location) -> str:
    path = ""
    for part in location:
        path += f"[{part}]" if isinstance(part, int) else f".{part}"
    return path.removeprefix(".") or "file"
