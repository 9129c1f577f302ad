"""What a request of the page says: its values, refused where they are none."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import Response

from conveyor.errors import InputError


async def request_data(request: Request) -> dict[str, Any]:
    """JSON object of a request."""
    try:
        asked = json.loads(await request.body())
    except (ValueError, RecursionError):
        asked = None
    if not isinstance(asked, dict):
        raise InputError("expected a JSON object")
    return asked


def text_value(asked: Mapping[str, Any], key: str) -> str:
    """Text of a request; an error where it is none."""
    value = asked.get(key)
    if not isinstance(value, str):
        raise InputError(f"{key}: expected text")
    return value


def units_value(asked: Mapping[str, Any]) -> str | None:
    """Unit system of a request, None for that of the spec."""
    value = asked.get("units")
    return value if isinstance(value, str) and value else None


def variant_names(asked: Mapping[str, Any]) -> list[str]:
    """Return the names of the first and of the second variant."""
    given = asked.get("names")
    if isinstance(given, list) and len(given) == 2 and all(isinstance(name, str) for name in given):
        return [name.strip()[:60] or letter for name, letter in zip(given, "AB", strict=True)]
    return ["A", "B"]


def variant_changes(asked: Mapping[str, Any], key: str) -> Any:
    """Changes of a variant; {} for those of a page that has none, None without the variant."""
    given = asked.get(key)
    if given is None:
        return {} if key == "changes" else None
    if not isinstance(given, dict) or not all(text is None or isinstance(text, str) for text in given.values()):
        raise InputError(f"{key}: expected texts by the path of their field")
    return given


def file_answer(content: bytes, name: str, media_type: str) -> Response:
    """Answer that the browser saves as a file."""
    said = f"attachment; filename*=UTF-8''{quote(name)}"
    return Response(content, media_type=media_type, headers={"content-disposition": said})
