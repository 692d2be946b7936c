# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Requests of a browser over its socket: read within bounds, answered one at a time."""

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Collection, Mapping
import logging
import time
from typing import Any
import weakref

from ballscrew_monitor.page.frames import frame
from ballscrew_monitor.page.hub import Browser
from ballscrew_monitor.page.phrases import free, phrase, Refused
from surrogate.files import InputError
from surrogate.files.limits import read_json

LOG = logging.getLogger(__name__)
LARGEST = 4000  # [byte] of a request
MOST_A_SECOND = 20
MOST_FAULTS = 20  # after which a socket is closed
Answer = tuple[Mapping[str, Any], Mapping[str, Any]]
"""Record and arrays of an answer."""
Handler = Callable[[Browser, Mapping[str, Any]], Awaitable[Answer]]
Clock = Callable[[], float]


class Manners:
    """How a browser has behaved: times of its last requests [s], and its faults."""

    def __init__(self) -> None:
        self.times: deque[float] = deque(maxlen=MOST_A_SECOND)
        self.faults = 0


class Questions:
    """Hands requests to their handlers."""

    def __init__(
        self,
        handlers: Mapping[str, Handler],
        clock: Clock = time.monotonic,
        *,
        long: Collection[str] = (),
    ) -> None:
        """
        Answer by `handlers` by name, on a steady `clock` [s].

        While one of those named `long` answers, the browser may ask for more.

        """
        self._handlers, self._clock, self._long = handlers, clock, long
        self._under_way: set[asyncio.Task[None]] = set()
        self._manners: weakref.WeakKeyDictionary[Browser, Manners] = weakref.WeakKeyDictionary()

    async def answer(self, browser: Browser, text: str) -> bool:
        """Answer a request; return True if the browser may stay."""
        manners = self._manners.setdefault(browser, Manners())
        request: Mapping[str, Any] = {'id': None}
        try:
            now, times = self._clock(), manners.times
            quick = len(times) == MOST_A_SECOND and now - times[0] < 1.0
            times.append(now)
            if quick:
                raise InputError(f'more than {MOST_A_SECOND} requests came within a second')
            request = _read(text)
            known, act = self._handlers, request.get('do')
            if not isinstance(act, str) or act not in known:
                allowed = ', '.join(known) or 'nothing'
                raise InputError(f'do is {act!r:.40}, allowed is {allowed}')
        except InputError as error:
            manners.faults += 1
            _tell(browser, request, _refusal(error))
            return manners.faults <= MOST_FAULTS
        answering = asyncio.create_task(self._answer(known[act], browser, request))
        if act in self._long:
            self._under_way.add(answering)
            answering.add_done_callback(self._under_way.discard)
        else:
            await answering
        return True

    async def _answer(
        self, handler: Handler, browser: Browser, request: Mapping[str, Any]
    ) -> None:
        """Answer a request by its handler, whatever becomes of that."""
        try:
            answer = await handler(browser, request)
        except InputError as error:
            answer = _refusal(error)
        except Exception as error:  # the page goes on, whatever it is
            LOG.exception('a request failed')
            answer = _refusal(Refused(phrase('program_fault', why=free(repr(error)))))
        _tell(browser, request, answer)


def _refusal(error: InputError) -> Answer:
    message = error.sentence if isinstance(error, Refused) else str(error)
    return {'ok': False, 'message': message}, {}


def _tell(browser: Browser, request: Mapping[str, Any], answer: Answer) -> None:
    record = {'id': request['id'], 'ok': True, 'message': '', **answer[0]}
    browser.reply(frame('answer', record, answer[1]))


def _read(text: str) -> Mapping[str, Any]:
    """Return a request; raises InputError for anything else."""
    if len(text) > LARGEST:
        raise InputError(f'the request has {len(text)} characters, allowed are {LARGEST}')
    try:
        request = read_json(text)
    except InputError as error:
        raise InputError(f'the request cannot be read: {error}') from None
    if not isinstance(request, dict) or type(request.get('id')) is not int:
        raise InputError('a request is a JSON object with a whole number id')
    return request


def number_in(request: Mapping[str, Any], name: str, default: float | None = None) -> float:
    """Return a number of a request, the default for null; raises InputError."""
    value: Any = request.get(name)
    if value is None and default is not None:
        return default
    if type(value) not in (int, float) or not abs(value) < 1e300:
        raise InputError(f'{name} is {value!r:.40}, it must be a finite number')
    return float(value)


def text_in(request: Mapping[str, Any], name: str, most: int = 200) -> str:
    """Return a text of one line of a request; raises InputError for anything else."""
    value = request.get(name)
    if not isinstance(value, str) or not 1 <= len(value) <= most or not value.isprintable():
        raise InputError(f'{name} must be a text of 1 to {most} printable characters')
    return value
