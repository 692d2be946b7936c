# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The application: files of the table, login, metrics, and the socket of a browser."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
import contextlib
import time
from urllib.parse import parse_qs

from ballscrew_monitor.page import components
from ballscrew_monitor.page.fault import Making
from ballscrew_monitor.page.guard import COOKIE, Guard, MOST_TOKEN, Tokens
from ballscrew_monitor.page.hub import Browser, Hub, PERIOD
from starlette.applications import Starlette
from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect
from surrogate.files import InputError

LARGEST_FORM = 4 * MOST_TOKEN  # [byte]
FORM_TIME = 10.0  # [s] to send it
TRY_LATER, RUDE = 1013, 1008  # codes with which a socket is closed
BUSY = 'Too many browsers look at this page.'
NO_REQUESTS = 'Too much was sent that is no request.'
ATTACHED = {'Content-Disposition': 'attachment; filename="ballscrew_fault.zip"'}
Answering = Callable[[Browser, str], Awaitable[bool]]
"""Answers the text of a browser; returns True if its socket may stay."""


class PageApp:
    """Everything that is served, for one hub."""

    def __init__(
        self,
        hub: Hub,
        answer: Answering,
        tokens: Tokens,
        metrics: Callable[[], Response],
        *,
        language: str = '',
        fault: Making | None = None,
    ) -> None:
        """
        Serve a hub; `answer` is given what browsers say, `metrics` and `fault` make their files.

        The `language` is that of the reader if it is empty.

        """
        self._language = language
        self._fault, self._is_making = fault, False
        self.failure: Exception | None = None
        self._hub, self._answer, self._tokens, self._metrics = hub, answer, tokens, metrics

    def guarded(self, host: str) -> Guard:
        """Return the application behind its guard, as it is served at `host`."""
        routes = [
            Route('/', self._index),
            Route('/components/{name:path}', self._component),
            Route('/login', self._login, methods=['GET', 'POST']),
            Route('/healthz', self._healthz),
            Route('/favicon.ico', lambda request: Response(status_code=204)),
            Route('/metrics', lambda request: self._metrics()),
            Route('/report-fault', self._report_fault, methods=['POST']),
            WebSocketRoute('/live', self._live),
        ]
        return Guard(
            Starlette(routes=routes, lifespan=self._ticking), host=host, tokens=self._tokens
        )

    @contextlib.asynccontextmanager
    async def _ticking(self, app: Starlette) -> AsyncIterator[None]:
        ticking = asyncio.create_task(self._tick())
        yield
        ticking.cancel()

    async def _tick(self) -> None:
        try:
            while True:
                self._hub.tick(time.monotonic())
                await asyncio.sleep(PERIOD)
        except Exception as error:
            self.failure = error

    async def _index(self, request: Request) -> Response:
        return HTMLResponse(components.index(self._language_of(request)))

    async def _component(self, request: Request) -> Response:
        file = components.table().get(request.path_params['name'])
        if file is None:
            return PlainTextResponse('There is no such file.', status_code=404)
        return Response(file[0], media_type=file[1])

    async def _healthz(self, request: Request) -> Response:
        if self.failure is not None:
            return PlainTextResponse('The page sends nothing any more.', status_code=503)
        return PlainTextResponse('ok')

    def _language_of(self, asked: HTTPConnection) -> str:
        accepted = asked.headers.get('accept-language', '')
        return components.language_of(accepted, self._language)

    async def _login(self, request: Request) -> Response:
        language = self._language_of(request)
        if request.method != 'POST':
            return HTMLResponse(components.login(language), status_code=401)
        content = b''
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(FORM_TIME):
                async for part in request.stream():
                    content += part
                    if len(content) > LARGEST_FORM:
                        content = b''  # nor is more of it read
                        break
        fields = parse_qs(content.decode('utf-8', 'replace'))
        accepted = await self._tokens.accept(fields.get('token', [''])[0])
        if accepted is None:
            return HTMLResponse(components.login(language, 'login_busy'), status_code=429)
        if not accepted:
            return HTMLResponse(components.login(language, 'login_wrong'), status_code=401)
        answer = RedirectResponse('/', status_code=303)
        answer.set_cookie(
            COOKIE,
            self._tokens.cookie,
            httponly=True,
            samesite='strict',
            secure=request.url.scheme == 'https',
        )
        return answer

    async def _report_fault(self, request: Request) -> Response:
        if self._fault is None or self._is_making:
            return PlainTextResponse('The file is being made already.', status_code=429)
        self._is_making = True
        try:
            content = await self._fault()
        except (InputError, OSError) as error:
            return PlainTextResponse(str(error), status_code=500)
        finally:
            self._is_making = False
        return Response(content, media_type='application/zip', headers=ATTACHED)

    async def _live(self, socket: WebSocket) -> None:
        await socket.accept()
        browser = Browser(self._language_of(socket))
        if not self._hub.join(browser, time.monotonic()):
            await socket.close(TRY_LATER, BUSY)
            return
        sending = asyncio.create_task(_send(socket, browser))
        try:
            must_leave = await self._hear(socket, browser)
        finally:
            self._hub.leave(browser)
            sending.cancel()
            await asyncio.wait([sending])
        if must_leave:
            await socket.close(RUDE, NO_REQUESTS)

    async def _hear(self, socket: WebSocket, browser: Browser) -> bool:
        """Answer a browser until it leaves; return True if it must."""
        while True:
            message = await socket.receive()
            if message['type'] == 'websocket.disconnect':
                return False
            if not await self._answer(browser, message.get('text') or ''):
                return True


async def _send(socket: WebSocket, browser: Browser) -> None:
    with contextlib.suppress(WebSocketDisconnect):
        while True:
            await socket.send_bytes(await browser.take())
