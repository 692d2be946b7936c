# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page as it is served, over real sockets, without ROS."""

import asyncio
import contextlib
import http.client
import json
import struct
import threading
import types

from ballscrew_monitor.page.app import PageApp
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.guard import Tokens
from ballscrew_monitor.page.history import COLUMNS
from ballscrew_monitor.page.hub import Hub
from ballscrew_monitor.page.metrics import HubCollector, Metrics
from ballscrew_monitor.page.questions import Questions
from ballscrew_monitor.page.server import bound_socket, PageOptions, server_of
import numpy as np
import pytest
from websockets.sync.client import connect

DEADLINE = 600.0  # [s] which only ends a hang
LIMITS = {'efficiency_limit': 0.85, 'rcs_limit': 0.01, 'light_load_N': 200.0}
LIMITS['standstill_rpm'] = 5.0


def read_frame(data):
    """Return record and arrays of a frame, read as the contract with the browser has it."""
    (size,) = struct.unpack_from('<I', data)
    at = 4 + size
    record = json.loads(data[4:at])
    assert at % 8 == 0
    arrays = {}
    for name, count in record.pop('arrays'):
        arrays[name] = np.frombuffer(data, '<f8', count, at)
        at += 8 * count
    assert at == len(data)
    return record, arrays


def row(stamp, level=1.0, **values):
    """Return a row at a stamp [s]."""
    known = {'stamp': stamp, 'speed_rpm': 100.0, 'level': level} | values
    return [known.get(name, 0.5) for name in COLUMNS]


def heard_axis(node='/monitor', axis='x'):
    """Return an axis that has been heard once."""
    view = AxisView(node, axis)
    view.hear(row(1.0), {'level': 'ok', 'zone': 'optimal'}, LIMITS, 0.0)
    return view


class Served:
    """A page on a free port, and what a reader does with it."""

    def __init__(
        self, *, token=None, host='127.0.0.1', cert=None, key=None, handlers=(), fault=None
    ):
        self.hub, self.tokens = Hub(), Tokens(token, slowness=0.0)
        self.options = PageOptions(host=host, port=0, token=token, cert=cert, key=key)
        self._handlers, self._fault = dict(handlers), fault
        self._loop = asyncio.new_event_loop()
        self._started = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()
        assert self._started.wait(DEADLINE)

    def _run(self):
        with contextlib.closing(self._loop), bound_socket(self.options) as bound:
            self.port = bound.getsockname()[1]
            answer = Questions(self._handlers).answer
            metrics = Metrics(HubCollector(self.hub, lambda: self.tokens.wrong))
            fault = self._fault and self._fault(self.hub)
            app = PageApp(self.hub, answer, self.tokens, metrics, fault=fault)
            app = app.guarded(self.options.host)
            self.server = server_of(self.options, app)
            self._loop.run_until_complete(self._serve(bound))

    async def _serve(self, bound):
        self._loop.call_soon(self._started.set)
        await self.server.serve(sockets=[bound])

    def close(self):
        self.server.should_exit = True
        self._thread.join()

    def call(self, function, *arguments):
        """Return what a function gives in the thread of the hub."""

        async def calling():
            return function(*arguments)

        return asyncio.run_coroutine_threadsafe(calling(), self._loop).result()

    def ask(self, path='/', method='GET', body=None, **headers):
        """Return status, headers and text of an answer."""
        connection = http.client.HTTPConnection('127.0.0.1', self.port)
        with contextlib.closing(connection):
            sent = {name.replace('_', '-'): value for name, value in headers.items()}
            connection.request(method, path, body, sent)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read().decode('utf-8', 'replace')

    def status(self, path, **headers):
        """Return the status of an answer that need not end."""
        with contextlib.closing(http.client.HTTPConnection('127.0.0.1', self.port)) as connection:
            sent = {name.replace('_', '-'): value for name, value in headers.items()}
            connection.request('GET', path, headers=sent)
            return connection.getresponse().status

    def look(self, origin=None, **options):
        """Return an open socket of a browser."""
        here = f'127.0.0.1:{self.port}'
        options = {'max_size': None, 'compression': None} | options
        return connect(f'ws://{here}/live', origin=origin or f'http://{here}', **options)


@pytest.fixture
def served():
    """Return what serves a page as asked for, until the end of the test."""
    with contextlib.ExitStack() as stack:
        yield lambda **options: stack.enter_context(contextlib.closing(Served(**options)))


@pytest.fixture(scope='session')
def page_parts():
    """Return what the tests of the page have in common."""
    return types.SimpleNamespace(read=read_frame, row=row, axis=heard_axis, limits=LIMITS)
