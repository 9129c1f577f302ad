"""Plain messages for syntax errors of YAML and JSON."""

from __future__ import annotations

import re
from typing import Final

_YAML_MEANING = "it has a meaning in YAML: put the text in quotes"
_BACKSLASH = "a backslash in double quotes begins a code; write it twice, or the text in other quotes or none"
_INDENT_HINT = "indent with the same number of blanks as the lines that belong together, one blank after each colon"

_YAML_MESSAGES: Final[tuple[tuple[str, str], ...]] = (
    (r"flow mapping .*'<stream end>'", "a brace { is opened here and not closed; add the }"),
    (r"flow sequence .*'<stream end>'", "a bracket [ is opened here and not closed; add the ]"),
    (r"flow mapping .*expected ',' or '}'", "a comma or the closing } is missing before this place"),
    (r"flow sequence .*expected ',' or '\]'", "a comma or the closing ] is missing before this place"),
    (r"quoted scalar found unexpected", "a quote is opened here and not closed; add the second one"),
    (
        r"unknown escape character",
        _BACKSLASH,
    ),
    (r"escape sequence of", _BACKSLASH),
    (r"found character '\\t'", "a tab; indent with spaces, not tabs"),
    (r"found character '(.*)' that cannot start any token", rf"a text begins with \1, {_YAML_MEANING}"),
    (
        "mapping values are not allowed here",
        "a colon where none may stand; look here and in the line before: indentation, the blank after each colon, "
        'quotes around a text with ": " in it',
    ),
    (
        r"could not find expected ':'",
        "a line that is no key: value, or a key of more than 1,000 letters; write key: value, on one line",
    ),
    (r"undefined alias", f'a value begins with "*", {_YAML_MEANING}'),
    (r"(?:scanning an (?:alias|anchor)) expected", rf'a value begins with "*" or "&", {_YAML_MEANING}'),
    (r"undefined tag handle|scanning a tag|parsing a tag", rf'a value begins with "!", {_YAML_MEANING}'),
    (r"scanning a directive|YAML directive|version 1", 'a line begins with "%"; remove it, or begin it with "#"'),
    (
        r"block scalar",
        'a value begins with "|" or ">", which opens a text of several lines in YAML: put it in quotes',
    ),
    (
        r"single document|document end|<document start>",
        'a second document begins here; remove lines that begin with "---", "..." or "%", and what follows',
    ),
    (r"expected <block end>, but found ','", "a comma outside of braces and brackets; remove it"),
    (r"expected <block end>, but found '([}\])])'", r"a closing \1 without its opening; remove it"),
    (
        r"expected <block end>, but found '<scalar>'",
        f"a text that does not belong here; after a closing quote or bracket nothing follows; {_INDENT_HINT}",
    ),
    (r"expected <block end>", f"the line does not fit those before it; {_INDENT_HINT}"),
    (r"expected the node content", "a value is missing here, or a bracket or comma is too many"),
    (r"sequence entries are not allowed", f'a list item "- " where none may stand; {_INDENT_HINT}'),
    (r"special characters are not allowed", "a control character; remove it (retype the line)"),
)  # fmt: skip

_JSON_MESSAGES: Final[tuple[tuple[str, str], ...]] = (
    (
        "Expecting property name",
        "a name in double quotes is missing here; a comma before it may be too many, and ' is no \"",
    ),
    ("Expecting value", "a value is missing here; a comma before it may be too many, or the file is cut off"),
    ("Expecting ',' delimiter", "a comma or a closing bracket is missing before this place"),
    ("Expecting ':' delimiter", "a colon is missing before this place"),
    ("Unterminated string", "a quote is opened here and not closed; add the second one"),
    ("Invalid control character", "a line break or control character inside quotes; remove it"),
    ("escape", "a backslash begins a code; write it twice"),
    ("Extra data", "the file goes on after its end; remove what follows"),
    ("Illegal trailing comma", "a comma too many; remove it"),
)  # fmt: skip


def yaml_message(said: str) -> str:
    """Plain message for a YAML parser's; its own where none is known.

    Examples
    --------
    >>> yaml_message("while parsing a flow mapping expected ',' or '}', but got '<stream end>'")
    'a brace { is opened here and not closed; add the }'
    """
    return _plain_message(said, _YAML_MESSAGES)


def json_message(said: str) -> str:
    """Plain message for a JSON parser's; its own where none is known.

    Examples
    --------
    >>> json_message("Expecting ',' delimiter")
    'a comma or a closing bracket is missing before this place'
    """
    return _plain_message(said, _JSON_MESSAGES)


def _plain_message(said: str, words: tuple[tuple[str, str], ...]) -> str:
    for pattern, plain in words:
        match = re.search(pattern, said, re.DOTALL)
        if match is not None:
            return plain.replace(r"\1", match[1]) if match.groups() else plain
    return " ".join(said.split())
