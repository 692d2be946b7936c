# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The guard before every request and every socket: Host, Origin, token, and headers of answers.

A name in Host that is not ours betrays a page elsewhere whose name was bound to this address (DNS
rebinding); an Origin that is not Host, a page elsewhere that asks through the reader's browser.

"""

import asyncio
import hashlib
import hmac
from http.cookies import CookieError, SimpleCookie
import ipaddress
from pathlib import Path
import re
import socket
from typing import Any

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import Message, Receive, Scope, Send
from surrogate.files import InputError

COOKIE = 'ballscrew_page'
LEAST_TOKEN, MOST_TOKEN = 16, 200  # characters
SLOWNESS = 1.0  # [s] until the answer to a wrong token
MOST_WRONG = 20  # that are answered at the same time
OPEN = ('/login', '/healthz')
"""Paths that need no token."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
HEADERS = {
    'Content-Security-Policy': POLICY,
    'X-Content-Type-Options': 'nosniff',
    'X-Frame-Options': 'DENY',
    'Referrer-Policy': 'no-referrer',
    'Cross-Origin-Opener-Policy': 'same-origin',
    'Cross-Origin-Resource-Policy': 'same-origin',
    'Cache-Control': 'no-store',
}
_HOST = re.compile(r'(?P<name>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(?::\d{1,5})?')


def is_loopback(host: str) -> bool:
    """Return True if nobody but this machine reaches an address."""
    try:
        return host == 'localhost' or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def read_token(path: Path) -> str:
    """Return the token in the first line of a file; raises InputError."""
    try:
        with path.open(encoding='utf-8') as stream:
            token = stream.readline(MOST_TOKEN + 2).strip()
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, 'strerror', None) or 'it is no text'
        raise InputError(f'token file {path} cannot be read: {why}') from None
    if not LEAST_TOKEN <= len(token) <= MOST_TOKEN:
        raise InputError(
            f'token in {path} has {len(token)} characters, allowed are {LEAST_TOKEN} to '
            f'{MOST_TOKEN}'
        )
    return token


class Tokens:
    """The token, if one is needed; wrong ones are slowed and counted."""

    def __init__(self, token: str | None, *, slowness: float = SLOWNESS) -> None:
        """Answer a wrong token after `slowness` [s]."""
        self._token, self._slowness = token, slowness
        self.wrong = 0
        self._waiting = 0

    @property
    def cookie(self) -> str:
        """Return what the cookie holds, which does not tell the token."""
        return hmac.digest((self._token or '').encode(), b'page', hashlib.sha256).hex()

    def admits(self, headers: Headers) -> bool:
        """Return True if a request carries cookie or token, a bearer; count wrong ones."""
        if self._token is None:
            return True
        cookies = SimpleCookie()
        try:
            cookies.load(headers.get('cookie', ''))
        except CookieError:
            return False
        carried = cookies[COOKIE].value if COOKIE in cookies else ''
        bearer = headers.get('authorization', '').removeprefix('Bearer ')
        admitted = _same(carried, self.cookie) or _same(bearer, self._token)
        self.wrong += bool((carried or bearer) and not admitted)
        return admitted

    async def accept(self, token: str) -> bool | None:
        """
        Return True if a token is right; None for one that is not while too many others wait.

        The right one always opens: nobody shuts the reader out by wrong ones. The length of the
        token guards against guesses; that they wait bounds how many are at work.

        """
        if self._token is not None and _same(token, self._token):
            return True
        self.wrong += 1
        if self._waiting >= MOST_WRONG:
            return None
        self._waiting += 1
        try:
            await asyncio.sleep(self._slowness)
        finally:
            self._waiting -= 1
        return False


def _same(text: str, other: str) -> bool:
    return hmac.compare_digest(text.encode(), other.encode())


class Guard:
    """An application behind the checks."""

    def __init__(self, app: Any, *, host: str, tokens: Tokens) -> None:
        self._app, self._tokens = app, tokens
        self._only_here = is_loopback(host)
        self._names = {'localhost', host.lower()}
        if not self._only_here:
            self._names |= {socket.gethostname().lower(), socket.getfqdn().lower()}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Hand on what is in order, refuse the rest with a sentence."""
        if scope['type'] not in ('http', 'websocket'):
            await self._app(scope, receive, send)
            return
        problem = self._problem(scope)
        if problem is None:
            await self._app(scope, receive, _with_headers(send))
        elif scope['type'] == 'websocket':
            await send({'type': 'websocket.close', 'code': 1008, 'reason': problem[1]})
        elif problem[0] == 401 and scope['path'] == '/':
            await self._app({**scope, 'path': '/login'}, receive, _with_headers(send))
        else:
            answer = PlainTextResponse(problem[1], status_code=problem[0])
            await answer(scope, receive, _with_headers(send))

    def _problem(self, scope: Scope) -> tuple[int, str] | None:
        """Return status and sentence of what is wrong with a request, None for nothing."""
        headers = Headers(scope=scope)
        hosts, origins = headers.getlist('host'), headers.getlist('origin')
        if len(hosts) != 1 or not self._knows(hosts[0]):
            return 421, 'This page is not served under the name in Host.'
        secure = scope['scheme'] in ('https', 'wss')
        own = f'{"https" if secure else "http"}://{hosts[0]}'
        if any(origin != own for origin in origins):
            return 403, 'Origin is another page than this one.'
        if scope['type'] == 'websocket' and not origins:
            return 403, 'A socket needs Origin.'
        if scope['path'] not in OPEN and not self._tokens.admits(headers):
            return 401, 'This page needs its token: open / to give it.'
        return None

    def _knows(self, host: str) -> bool:
        """Return True if Host is a name of ours; an address cannot be rebound."""
        parts = _HOST.fullmatch(host)
        if parts is None:
            return False
        name = parts['name'].strip('[]').lower()
        if name in self._names or is_loopback(name):
            return True
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return False
        return not self._only_here


def _with_headers(send: Send) -> Send:
    """Return `send` with the headers of this page on every answer."""

    async def sending(message: Message) -> None:
        if message['type'] in ('http.response.start', 'websocket.http.response.start'):
            MutableHeaders(scope=message).update(HEADERS)
        await send(message)

    return sending
