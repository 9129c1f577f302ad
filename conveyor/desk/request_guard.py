"""Refuses what does not come from the desk's own page: other hosts, other origins, no token, too large.

On an address of an intranet the page opens with a password too.
"""

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
LOOPBACK: Final = "127.0.0.1"
"""Address that only this machine reaches."""
OPENING: Final = "/open"
"""Path of the opening address, which carries the token, and of the form for the password."""
MOST_WRONG: Final = 5
"""Wrong passwords in a minute; no more are compared until it is over."""
_MINUTE: Final = 60.0
_LARGEST_FORM: Final = 4096

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
    host : str
        Address that the desk listens to.
    password : str, optional
        Opens the page without the opening address; without it nothing else does.

    Attributes
    ----------
    token : str
        Secret of the opening address.
    last_request : float
        Time of the last request let through, of `time.monotonic` [s].
    """

    def __init__(
        self,
        app: Application,
        port: int,
        token: str | None = None,
        *,
        host: str = LOOPBACK,
        password: str | None = None,
    ) -> None:
        self._app, self._port, self._host, self._password = app, port, host, password
        self._hosts = {f"{name}:{port}" for name in ({host, "localhost"} if host == LOOPBACK else {host})}
        self._wrong: list[float] = []
        self.token = secrets.token_urlsafe(24) if token is None else token
        self.last_request = time.monotonic()

    @property
    def cookie(self) -> str:
        """Name of the cookie; one for each port, as browsers share cookies between ports."""
        return f"conveyor_desk_{self._port}"

    @property
    def address(self) -> str:
        """Opening address."""
        return f"http://{self._host}:{self._port}{OPENING}?token={self.token}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] != "http":
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        refused = self._refusal(scope, headers)
        if refused is not None:
            await _answer_text(send, *refused)
        elif scope["path"] == OPENING and self._asks_for_password(scope):
            await self._answer_password(scope, receive, send)
        elif scope["path"] == OPENING:
            await self._open(send)
        elif self._password is not None and not self._has_cookie(headers):
            await _answer_text(send, 303, "", (b"location", OPENING.encode("ascii")))
        else:
            self.last_request = time.monotonic()
            await self._pass_on(scope, receive, send)

    def _asks_for_password(self, scope: Scope) -> bool:
        return self._password is not None and b"token=" not in scope.get("query_string", b"")

    async def _open(self, send: Send) -> None:
        cookie = f"{self.cookie}={self.token}; Path=/; HttpOnly; SameSite=Strict"
        await _answer_text(send, 303, "", (b"location", b"/"), (b"set-cookie", cookie.encode("ascii")))

    async def _answer_password(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Show the form for the password, or compare the one that was sent."""
        if scope["method"] != "POST":
            await _answer_form(send, 200, "")
            return
        now = time.monotonic()
        self._wrong = [at for at in self._wrong if now - at < _MINUTE]
        if len(self._wrong) >= MOST_WRONG:
            await _answer_form(send, 429, "Too many wrong passwords: wait a minute.")
            return
        given = parse_qs(await _form_body(receive), keep_blank_values=True).get("password", [""])[0]
        if hmac.compare_digest(given.encode(), (self._password or "").encode()):
            await self._open(send)
        else:
            self._wrong.append(now)
            await _answer_form(send, 403, "This is not the password.")

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
        if headers.get("host", "") not in self._hosts:
            where = "on this machine only, at" if self._host == LOOPBACK else "at"
            return 421, f"the desk answers {where} {self._host}"
        origin = headers.get("origin")
        own = {f"http://{host}" for host in self._hosts}
        site = headers.get("sec-fetch-site", "same-origin")
        opens = scope["path"] == OPENING and scope["method"] == "GET"
        if (origin is not None and origin not in own) or (site not in {"same-origin", "none"} and not opens):
            return 403, "another page asked for this"
        if not self._is_known(scope, headers, opens=opens):
            return _NO_TOKEN
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > LARGEST_BODY:
            return 413, _TOO_LARGE
        return None

    def _is_known(self, scope: Scope, headers: dict[str, str], *, opens: bool) -> bool:
        """True with the token or the cookie, and for what leads to the form for the password."""
        if scope["path"] == OPENING and self._asks_for_password(scope):
            return True
        if opens:
            given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
            return hmac.compare_digest(given.encode(), self.token.encode())
        return self._has_cookie(headers) or (self._password is not None and scope["path"] == "/")

    def _has_cookie(self, headers: dict[str, str]) -> bool:
        held = _cookie_value(headers.get("cookie", ""), self.cookie)
        return hmac.compare_digest(held.encode(), self.token.encode())


_TOO_LARGE: Final = "larger than 2 MiB"
_NO_TOKEN: Final = (403, "open the desk with the address that `conveyor desk` printed")


def _cookie_value(header: str, name: str) -> str:
    """Value of a cookie; "" without it."""
    try:
        held = SimpleCookie(header).get(name)
    except CookieError:
        return ""
    return "" if held is None else held.value


async def _form_body(receive: Receive) -> str:
    """Text of a form's body, of at most a few kilobytes; more is cut off, and then no password."""
    body, more = b"", True
    while more and len(body) <= _LARGEST_FORM:
        message = await receive()
        body, more = body + message.get("body", b""), message.get("more_body", False)
    return body[:_LARGEST_FORM].decode("latin-1")


_FORM: Final = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Conveyor desk</title></head><body><main><h1>Conveyor desk</h1><form method="post" action="/open">
<p role="alert">{said}</p><p><label>Password
<input type="password" name="password" autocomplete="current-password" autofocus></label>
<button type="submit">Open</button></p></form></main></body></html>
"""


async def _answer_form(send: Send, status: int, said: str) -> None:
    body = _FORM.format(said=said).encode()
    # without a referrer a browser sends the form's origin as null
    changes = {b"form-action 'none'": b"form-action 'self'", b"no-referrer": b"same-origin"}
    own = list(_HEADERS)
    for old, new in changes.items():
        own = [(name, value.replace(old, new)) for name, value in own]
    headers = [(b"content-type", b"text/html; charset=utf-8"), (b"content-length", str(len(body)).encode()), *own]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


async def _answer_text(send: Send, status: int, reason: str, *more: tuple[bytes, bytes]) -> None:
    body = reason.encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": status, "headers": [*headers, *more, *_HEADERS]})
    await send({"type": "http.response.body", "body": body})
