# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The server of the page: where it listens, and how much it takes."""

from collections.abc import Iterator
import contextlib
import dataclasses
import os
from pathlib import Path
import socket
from typing import Any

from surrogate.files import InputError
from surrogate.surface import Surface
import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

LARGEST_MESSAGE = 65_536  # [byte] from a browser; beyond, its socket is closed unread
MOST_CONNECTIONS = 300
FIRST_WORDS = 10.0  # [s] for a connection to ask for something
LONGEST_WAIT = 30.0  # [s] for an answer, and then for all of the next request
LONGEST_LIFE = 30.0  # [s] of a connection, after which it takes no further request
MOST_UNREAD = 1_000_000  # [byte] for a browser that wants answers to its pings and does not read
LAST_WORDS = 2  # [s] for connections to end


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class PageOptions:
    """
    Where the page is served, to whom, and what of: a node, all of them for an empty name.

    The language is that of the reader if it is empty; `oils` are surfaces of other oils.

    """

    host: str
    port: int
    node: str = ''
    token: str | None = None
    cert: Path | None = None
    key: Path | None = None
    language: str = ''
    acting: bool = False
    oils: tuple[Surface, ...] = ()

    @property
    def url(self) -> str:
        """Return what to type into a browser."""
        host = f'[{self.host}]' if ':' in self.host else self.host
        return f'{"https" if self.cert else "http"}://{host}:{self.port}/'


@contextlib.contextmanager
def bound_socket(options: PageOptions) -> Iterator[socket.socket]:
    """Open the port; raises InputError where it is taken or not of this machine."""
    try:
        family = socket.AF_INET6 if ':' in options.host else socket.AF_INET
        bound = socket.create_server((options.host, options.port), family=family)
    except OSError as error:
        # Without the address that Python adds to it.
        why = str(error) if error.errno is None else os.strerror(error.errno)
        raise InputError(
            f'port {options.port} of {options.host} cannot be opened ({why}): stop the '
            'page that has it, or give another --port or --host'
        ) from None
    with bound:
        yield bound


class PatientProtocol(H11Protocol):
    """
    A connection that is ended if no request comes in time, or no answer is given and taken.

    What comes besides a whole head, such as a part of a body that nobody waits for, is no request.
    After `LONGEST_LIFE` it ends with the answer that is under way. A live socket stays.

    """

    def connection_made(self, transport: Any) -> None:
        """Begin to wait for the head of the first request."""
        super().connection_made(transport)
        self._timer = self.loop.call_later(FIRST_WORDS, self._end)
        self._life = self.loop.call_later(LONGEST_LIFE, self._retire)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._timer.cancel()
        self._life.cancel()
        super().connection_lost(exc)

    def handle_events(self) -> None:
        """Take what came; a request that is among it is to be answered in time."""
        before = self.cycle
        super().handle_events()
        if self.cycle is not before:
            self._wait()

    def on_response_complete(self) -> None:
        """Begin to wait for the next request, and for this answer to be taken."""
        self._wait()
        super().on_response_complete()

    def _wait(self) -> None:
        self._timer.cancel()
        self._timer = self.loop.call_later(LONGEST_WAIT, self._end)

    def _retire(self) -> None:
        if self.transport.get_protocol() is self and not self.transport.is_closing():
            self.shutdown()

    def _end(self) -> None:
        if self.transport.get_protocol() is self:
            self.transport.abort()  # it would wait for what is not taken to be taken


class BoundedSocket(WebSocketsSansIOProtocol):
    """A live socket that is ended if it asks for answers to pings and does not read them."""

    def handle_ping(self) -> None:
        """Answer a ping."""
        super().handle_ping()
        if self.transport.get_write_buffer_size() > MOST_UNREAD:
            self.transport.abort()


class QuietServer(uvicorn.Server):
    """A server that leaves signals to the command."""

    def capture_signals(self) -> Any:
        """Take none."""
        return contextlib.nullcontext()


def server_of(options: PageOptions, app: Any) -> QuietServer:
    """Return what serves an application."""
    config = uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        server_header=False,
        proxy_headers=False,
        http=PatientProtocol,
        ws=BoundedSocket,
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        limit_concurrency=MOST_CONNECTIONS,
        timeout_graceful_shutdown=LAST_WORDS,
        ssl_certfile=options.cert,
        ssl_keyfile=options.key,
    )
    return QuietServer(config)
