"""Values of a YAML or JSON file replaced between their marks: comments, order and layout stay."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final, NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from conveyor.errors import InputError
from conveyor.files.document import parse_document

_PATH_PART: Final = re.compile(r"([^.\[\]]+)|\[(\d+)\]")
_PLAIN: Final = re.compile(r"(?:[^\W_]|[-+.]\d)(?:[\w ./()+*^%°²³=<>~;–-]*[\w./)+*^%°²³=<>~;–-])?")
"""Text that may stand without quotes, in flow style too."""
_TEXT_TAG: Final = "tag:yaml.org,2002:str"
_INDENT: Final = 2
_COMMENT_BLANKS: Final = 2
"""Blanks left before a comment, if there were as many."""


class _MissingKeys(NamedTuple):
    """Deepest block of the file on the way to a field, its own key, and the keys below it that are missing."""

    block: Node
    key: Node | None
    missing: tuple[str, ...]


def edit_values(content: str, changes: Mapping[str, Any], path: Path) -> str:
    r"""Replace values in the text of a file; keys that it does not have are added to their blocks.

    Parameters
    ----------
    content : str
        The file's text.
    changes : mapping of str to value
        New values by path: text, numbers, true or false, None, lists of these. An item of a list is named by its
        number from 0 in brackets or by its `name`.
    path : Path
        The file, for its format and for messages.

    Returns
    -------
    str
        The text with these values and nothing else changed.

    Raises
    ------
    InputError
        The file is no YAML or JSON, a path leads nowhere or to a value shared by an anchor (&), or the value cannot
        stand there.

    Examples
    --------
    >>> print(
    ...     edit_values(
    ...         "belt:\n  speed: 5 m/s  # from the mine\n", {"belt.speed": "5.5 m/s", "site": "poor"}, Path("s.yaml")
    ...     )
    ... )
    belt:
      speed: 5.5 m/s  # from the mine
    site: poor
    <BLANKLINE>
    """
    mark = "\ufeff" if content.startswith("\ufeff") else ""
    before = content.removeprefix(mark)
    is_json = path.suffix.lower() == ".json"
    root = parse_document(before, path).root
    wanted = parse_document(before, path).data
    spans: list[tuple[int, int, str]] = []
    later: list[str] = []
    for field, value in changes.items():
        found = _find_value(root, field, path)
        _set_data(wanted, field, value, path)
        if isinstance(found, _MissingKeys) or (isinstance(found, ScalarNode) and _is_empty(found)):
            later.append(field)
        else:
            end = _content_end(found)
            text = _value_text(value, found, is_json=is_json)
            text += "\n" if before[end - 1 : end] == "\n" else ""
            spans.append((found.start_mark.index, end, text))
    text = before
    for start, end, new in sorted(spans, reverse=True):
        text = text[:start] + new + _comment_in_place(text[start:end], new, text[end:])
    for field in later:
        text = _insert_value(text, field, changes[field], path, is_json=is_json)
    if parse_document(text, path).data != wanted:
        raise InputError(f"{path}: {', '.join(changes)}: cannot be changed in place; change the file in an editor")
    return mark + text


def _comment_in_place(old: str, new: str, rest: str) -> str:
    """Rest of a file behind a value, its comment in its column where there are blanks enough."""
    blanks = len(rest) - len(rest.lstrip(" "))
    if "\n" in old + new or rest[blanks : blanks + 1] != "#":
        return rest
    return " " * max(min(blanks, _COMMENT_BLANKS), blanks + len(old) - len(new)) + rest[blanks:]


def _path_steps(field: str) -> list[int | str]:
    return [name or int(number) for name, number in _PATH_PART.findall(field)]


def _find_value(root: Node, field: str, path: Path) -> Node | _MissingKeys:
    """Node of a value, or the deepest block on the way and the missing keys."""
    node, key = root, None
    steps = _path_steps(field)
    for i, step in enumerate(steps):
        if getattr(node, "anchor", None) is not None:
            raise InputError(f"{path}: {field}: is shared by the anchor &{node.anchor}; change the file in an editor")
        if isinstance(node, SequenceNode):
            number = _item_index(node, step)
            if number is None:
                raise InputError(f"{path}: {field}: the file has no item {step} there")
            node, key = node.value[number], None
        elif isinstance(node, MappingNode):
            pair = next(((k, v) for k, v in node.value if str(k.value) == str(step)), None)
            if pair is None:
                return _missing_keys(node, key, steps[i:], path)
            key, node = pair
        elif _is_null(node):
            return _missing_keys(node, key, steps[i:], path)
        else:
            raise InputError(f"{path}: {field}: the file has a single value at {steps[i - 1]}")
    if getattr(node, "anchor", None) is not None:
        raise InputError(f"{path}: {field}: is shared by the anchor &{node.anchor}; change the file in an editor")
    return node


def _missing_keys(node: Node, key: Node | None, missing: Sequence[int | str], path: Path) -> _MissingKeys:
    if any(isinstance(step, int) for step in missing):
        raise InputError(f"{path}: {'.'.join(map(str, missing))}: the file has no such list")
    return _MissingKeys(node, key, tuple(map(str, missing)))


def _item_index(node: SequenceNode, step: int | str) -> int | None:
    """Index of an item by its number or its name."""
    if isinstance(step, int) or step.isdecimal():
        return int(step) if int(step) < len(node.value) else None
    for i, item in enumerate(node.value):
        pairs = item.value if isinstance(item, MappingNode) else []
        if any(str(k.value) == "name" and str(v.value) == step for k, v in pairs):
            return i
    return None


def _is_null(node: Node) -> bool:
    return isinstance(node, ScalarNode) and str(node.tag).endswith(":null")


def _is_empty(node: ScalarNode) -> bool:
    return bool(node.value == "" and node.style is None)


def _content_end(node: Node) -> int:
    """Index behind the last character of a value; marks of blocks end at the next token."""
    while isinstance(node, MappingNode | SequenceNode) and not node.flow_style and node.value:
        last = node.value[-1]
        if isinstance(node, MappingNode):
            key, value = last
            node = key if isinstance(value, ScalarNode) and _is_empty(value) else value
        else:
            node = last
    return int(node.end_mark.index)


def _insert_value(text: str, field: str, value: Any, path: Path, *, is_json: bool) -> str:
    """Text with a value at a place where the file has none."""
    root = parse_document(text, path).root
    found = _find_value(root, field, path)
    if isinstance(found, _MissingKeys):
        return _fill_gap(text, found, value, is_json=is_json)
    made = _value_text(value, found, is_json=is_json)
    if isinstance(found, ScalarNode) and _is_empty(found):
        *above, last = _path_steps(field)
        block = _find_value(root, _field_text(above), path)
        pairs = block.value if isinstance(block, MappingNode) else []
        (key,) = (k for k, _ in pairs if str(k.value) == str(last))
        return _fill_empty(text, key, made)
    return text[: found.start_mark.index] + made + text[_content_end(found) :]  # made for another change


def _fill_gap(text: str, gap: _MissingKeys, value: Any, *, is_json: bool) -> str:
    """Text with the missing keys and the value at the end of their block."""
    if isinstance(gap.block, ScalarNode):  # null, in words or left empty
        made = _flow_text(gap.missing, value, is_json=is_json)
        if _is_empty(gap.block) and gap.key is not None:
            return _fill_empty(text, gap.key, made)
        return text[: gap.block.start_mark.index] + made + text[gap.block.end_mark.index :]
    pairs = gap.block.value
    if not isinstance(gap.block, MappingNode) or gap.block.flow_style or not pairs:
        made = _flow_text(gap.missing, value, is_json=is_json)[1:-1]
        at = _content_end(pairs[-1][1]) if pairs else gap.block.start_mark.index + 1
        return f"{text[:at]}{', ' if pairs else ''}{made}{text[at:]}"
    column = pairs[0][0].start_mark.column
    lines = [f"{' ' * (column + _INDENT * i)}{key}:" for i, key in enumerate(gap.missing)]
    lines[-1] += f" {_value_text(value, None, is_json=is_json)}"
    return _insert_lines(text, _content_end(gap.block), lines, "\r\n" if "\r\n" in text else "\n")


def _insert_lines(text: str, end: int, lines: Sequence[str], newline: str) -> str:
    """Text with lines below the line that holds an index."""
    if text[end - 1 : end] != "\n":
        line_end = text.find("\n", end)
        if line_end < 0:
            text += newline
        end = len(text) if line_end < 0 else line_end + 1
    return text[:end] + newline.join(lines) + newline + text[end:]


def _fill_empty(text: str, key: Node, made: str) -> str:
    """Text with a value behind a key that has none."""
    at = text.index(":", key.end_mark.index) + 1
    return f"{text[:at]} {made}{text[at:]}"


def _flow_text(keys: Sequence[str], value: Any, *, is_json: bool) -> str:
    """Nested keys and a value in flow style."""
    made = _value_text(value, None, is_json=is_json)
    for key in reversed(keys):
        name = json.dumps(key, ensure_ascii=False) if is_json else key
        made = f"{{{name}: {made}}}"
    return made


def _value_text(value: Any, old: Node | None, *, is_json: bool) -> str:
    """Value as it is written, quoted as the old one was."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value_text(item, None, is_json=is_json) for item in value)}]"
    if not isinstance(value, str):
        return json.dumps(value, allow_nan=False)
    style = old.style if isinstance(old, ScalarNode) else None
    if not is_json and style == "'" and "\n" not in value:
        return "'" + value.replace("'", "''") + "'"
    if is_json or style == '"' or not _is_plain(value):
        return json.dumps(value, ensure_ascii=False)
    return value


def _is_plain(value: str) -> bool:
    """True for text that YAML reads as the same text without quotes, other readers too: 01 and 2020-01-01 are none."""
    if _PLAIN.fullmatch(value) is None:
        return False
    if YAML(typ="safe", pure=True).resolver.resolve(ScalarNode, value, (True, False)) != _TEXT_TAG:
        return False
    return bool(parse_document(f"value: {{value: {value}}}", Path("value.yaml")).data["value"]["value"] == value)


def _set_data(data: Any, field: str, value: Any, path: Path) -> None:
    """Set a value in plain data."""
    *above, last = _path_steps(field)
    for step in above:
        inner = data[_data_key(data, step)] if isinstance(data, list) else data.get(step)
        if inner is None:
            inner = data[step] = {}
        data = inner
    if not isinstance(data, dict | list):
        raise InputError(f"{path}: {field}: the file has a single value above it")
    data[_data_key(data, last)] = copy.copy(value)


def _data_key(data: Any, step: int | str) -> Any:
    if isinstance(data, dict):
        return step
    names = [item.get("name") if isinstance(item, dict) else None for item in data]
    return names.index(step) if step in names else int(step)


def _field_text(steps: Sequence[int | str]) -> str:
    path = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return path.removeprefix(".")
