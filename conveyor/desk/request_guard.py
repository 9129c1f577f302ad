"""Refuses what does not come from the desk's own page: other hosts, other origins, no token, too large."""

from __future__ import annotations

import hmac
import secrets
import time
from collections.abc import Awaitable, Callable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any, Final, TypeAlias
from urllib.parse import parse_qs

from starlette.exceptions import HTTPException

Scope: TypeAlias = MutableMapping[str, Any]
Receive: TypeAlias = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send: TypeAlias = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application: TypeAlias = Callable[[Scope, Receive, Send], Awaitable[None]]

LARGEST_BODY: Final = 2 * 1024 * 1024
"""Bytes of a request."""
HOSTS: Final = ("127.0.0.1", "localhost")
"""Names by which a page may call the desk."""
OPENING: Final = "/open"
"""Path of the opening address, which carries the token."""

_HEADERS: Final = (
    (
        b"content-security-policy",
        b"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
        b"base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-store"),
)


class RequestGuard:
    """Lets only the desk's own page through.

    Parameters
    ----------
    app : callable
        The application behind it (ASGI).
    port : int
        Port that the desk listens to.
    token : str, optional
        Secret of the opening address; by default a new one.

    Attributes
    ----------
    token : str
        Secret of the opening address.
    last_request : float
        Time of the last request let through, of `time.monotonic` [s].
    """

    def __init__(self, app: Application, port: int, token: str | None = None) -> None:
        self._app, self._port = app, port
        self.token = secrets.token_urlsafe(24) if token is None else token
        self.last_request = time.monotonic()

    @property
    def cookie(self) -> str:
        """Name of the cookie; one for each port, as browsers share cookies between ports."""
        return f"conveyor_desk_{self._port}"

    @property
    def address(self) -> str:
        """Opening address."""
        return f"http://127.0.0.1:{self._port}{OPENING}?token={self.token}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refused = self._refusal(scope, headers)
        if refused is not None:
            await _answer_text(send, *refused)
        elif scope["path"] == OPENING:
            cookie = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
            await _answer_text(send, 303, "", (b"location", b"/"), (b"set-cookie", cookie.encode("ascii")))
        else:
            self.last_request = time.monotonic()
            await self._pass_on(scope, receive, send)

    async def _pass_on(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand a request on, its body limited, and add the headers of every answer."""
        read = 0

        async def limited() -> MutableMapping[str, Any]:
            nonlocal read
            message = await receive()
            read += len(message.get("body", b""))
            if read > LARGEST_BODY:
                raise HTTPException(413, _TOO_LARGE)
            return message

        async def marked(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), *_HEADERS]
            await send(message)

        await self._app(scope, limited, marked)

    def _refusal(self, scope: Scope, headers: dict[str, str]) -> tuple[int, str] | None:
        """Status and reason of a refusal; None for a request that may pass."""
        if headers.get("host", "") not in {f"{name}:{self._port}" for name in HOSTS}:
            return 421, "the desk answers on this machine only, at 127.0.0.1"
        origin = headers.get("origin")
        own = {f"http://{name}:{self._port}" for name in HOSTS}
        site = headers.get("sec-fetch-site", "same-origin")
        opens = scope["path"] == OPENING and scope["method"] == "GET"
        if (origin is not None and origin not in own) or (site not in {"same-origin", "none"} and not opens):
            return 403, "another page asked for this"
        if opens:
            (given,) = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[:1] or [""]
            return None if hmac.compare_digest(given.encode(), self.token.encode()) else _NO_TOKEN
        if not hmac.compare_digest(_cookie_value(headers.get("cookie", ""), self.cookie).encode(), self.token.encode()):
            return _NO_TOKEN
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > LARGEST_BODY:
            return 413, _TOO_LARGE
        return None


_TOO_LARGE: Final = "larger than 2 MiB"
_NO_TOKEN: Final = (403, "open the desk with the address that `conveyor desk` printed")


def _cookie_value(header: str, name: str) -> str:
    """Value of a cookie; "" without it."""
    try:
        held = SimpleCookie(header).get(name)
    except CookieError:
        return ""
    return "" if held is None else held.value


async def _answer_text(send: Send, status: int, reason: str, *more: tuple[bytes, bytes]) -> None:
    body = reason.encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": status, "headers": [*headers, *more, *_HEADERS]})
    await send({"type": "http.response.body", "body": body})
