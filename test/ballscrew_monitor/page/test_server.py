# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Connections are ended in time, by the clock of a loop that the test sets; live sockets stay."""

import asyncio
import contextlib
import socket

from ballscrew_monitor.page import server
from ballscrew_monitor.page.server import (
    FIRST_WORDS,
    LONGEST_LIFE,
    LONGEST_WAIT,
    MOST_UNREAD,
    PageOptions,
    PatientProtocol,
)
import pytest
from uvicorn.server import ServerState

GET = b'GET /healthz HTTP/1.1\r\nHost: here\r\n'


class Loop(asyncio.SelectorEventLoop):
    """A loop whose clock stands still until it is set [s]."""

    now = 0.0

    def time(self):
        return self.now


class Transport(asyncio.Transport):
    """What is written to a browser, and whether the connection is still open."""

    def __init__(self):
        super().__init__()
        self.text, self.is_closed, self.is_aborted, self.protocol = b'', False, False, None

    def write(self, data):
        self.text += data

    def close(self):
        self.is_closed = True

    is_closing = property(lambda self: lambda: self.is_closed)

    def abort(self):
        self.is_aborted = True

    def get_write_buffer_size(self):
        return len(self.text)  # nothing is ever read

    def get_protocol(self):
        return self.protocol

    def set_protocol(self, protocol):
        self.protocol = protocol

    def pause_reading(self):
        pass

    def resume_reading(self):
        pass


async def answer(scope, receive, send):
    """Answer at once, and leave the body where it is; hold a live socket."""
    if scope['type'] == 'websocket':
        await send({'type': 'websocket.accept'})
        await asyncio.Event().wait()
    if scope['path'] == '/never':
        await asyncio.Event().wait()
    await send({'type': 'http.response.start', 'status': 200, 'headers': []})
    await send({'type': 'http.response.body', 'body': b'ok'})


class Connection:
    """A connection of a browser that says what the test says."""

    def __init__(self):
        self.loop, self.state = asyncio.get_running_loop(), ServerState()
        options = PageOptions(host='127.0.0.1', port=0)
        config = server.server_of(options, answer).config
        config.load()
        self.protocol = PatientProtocol(config, self.state, {})
        self.transport = Transport()
        self.transport.protocol = self.protocol
        self.protocol.connection_made(self.transport)

    async def hear(self, data):
        """Take data, and give what answer there is."""
        if data:
            self.protocol.data_received(data)
        await self.settle()

    async def settle(self):
        """Let the loop do what is due."""
        for _ in range(10):
            await asyncio.sleep(0)

    async def is_ended_after(self, wait):
        """Return True if the connection is ended `wait` [s] from now, and no sooner."""
        self.loop.now += wait - 0.1
        await self.settle()
        assert not self.transport.is_aborted
        self.loop.now += 0.2
        await self.settle()
        return self.transport.is_aborted

    def lose(self):
        self.protocol.connection_lost(None)
        for task in self.state.tasks:
            task.cancel()


@pytest.fixture
def run():
    """Return what runs a conversation on a connection."""

    async def running(talk):
        connection = Connection()
        try:
            await talk(connection)
        finally:
            connection.lose()

    def begin(talk):
        with asyncio.Runner(loop_factory=Loop) as runner:
            runner.run(running(talk))

    return begin


@pytest.mark.parametrize('data', [b'', b'G', GET])
def test_a_request_that_does_not_come_ends_the_connection(run, data):
    async def talk(connection):
        await connection.hear(data)
        assert await connection.is_ended_after(FIRST_WORDS)

    run(talk)


@pytest.mark.parametrize('rest', [b'x', b'x' * 99])
def test_a_part_of_a_body_keeps_no_connection_that_was_answered(run, rest):
    """It silences the time that the server itself gives to the next request."""

    async def talk(connection):
        await connection.hear(GET + b'Content-Length: 100\r\n\r\n')
        assert connection.transport.text.endswith(b'ok\r\n0\r\n\r\n')
        await connection.hear(rest)
        assert await connection.is_ended_after(LONGEST_WAIT)

    run(talk)


def test_a_part_of_a_head_keeps_no_connection_that_was_answered(run):
    async def talk(connection):
        await connection.hear(GET + b'\r\n')
        for _ in range(4):
            connection.loop.now += LONGEST_WAIT / 5
            await connection.hear(b'G')
        assert await connection.is_ended_after(LONGEST_WAIT / 5)

    run(talk)


def test_requests_one_by_one_keep_a_connection_but_not_for_ever(run):
    async def talk(connection):
        for number in range(5):
            await connection.hear(GET + b'\r\n')
            assert connection.transport.text.count(b'HTTP/1.1 200') == number + 1
            connection.loop.now += 4.0
            await connection.settle()
        assert not connection.transport.is_closed
        assert not connection.transport.is_aborted
        for _ in range(3):
            await connection.hear(GET + b'\r\n')
            connection.loop.now += 4.0
            await connection.settle()
        assert connection.loop.now > LONGEST_LIFE
        assert connection.transport.is_closed

    run(talk)


@pytest.mark.parametrize('promised', [b'', b'Content-Length: 100\r\n'])
def test_a_connection_ends_with_the_answer_that_is_under_way(run, promised):
    async def talk(connection):
        connection.loop.now += FIRST_WORDS / 2
        await connection.hear(GET.replace(b'/healthz', b'/never') + promised + b'\r\n')
        connection.loop.now += LONGEST_WAIT - 0.1
        await connection.settle()
        assert connection.loop.now > LONGEST_LIFE
        assert not connection.transport.is_closed
        assert not connection.transport.is_aborted
        assert await connection.is_ended_after(0.1)

    run(talk)


UPGRADE = (
    b'GET /live HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
    b'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n'
)
PING = b'\x89\xfd\0\0\0\0' + bytes(125)  # of the greatest length, masked by zeros


def test_pings_whose_answers_are_not_read_end_a_live_socket(run):
    async def talk(connection):
        await connection.hear(UPGRADE)
        live = connection.transport.protocol
        for _ in range(MOST_UNREAD // len(PING)):
            live.data_received(PING)
        assert b'101 Switching Protocols' in connection.transport.text
        assert not connection.transport.is_aborted
        for _ in range(MOST_UNREAD // len(PING) // 10):
            live.data_received(PING)
        assert connection.transport.is_aborted
        live.connection_lost(None)
        await connection.settle()

    run(talk)


def test_an_answer_that_is_not_given_or_not_taken_ends_the_connection(run):
    async def never(connection):
        await connection.hear(GET.replace(b'/healthz', b'/never') + b'\r\n')
        assert await connection.is_ended_after(LONGEST_WAIT)

    async def not_taken(connection):
        await connection.hear(GET + b'Connection: close\r\n\r\n')
        assert connection.transport.is_closed  # and waits until all of it is taken
        assert await connection.is_ended_after(LONGEST_WAIT)

    run(never)
    run(not_taken)


def test_a_live_socket_stays(run):
    async def talk(connection):
        connection.transport.set_protocol(asyncio.Protocol())
        assert not await connection.is_ended_after(FIRST_WORDS)

    run(talk)


def test_sockets_that_promise_a_body_shut_nobody_out(served, wait_for, monkeypatch):
    monkeypatch.setattr(server, 'MOST_CONNECTIONS', 5)
    monkeypatch.setattr(server, 'LONGEST_WAIT', 0.5)
    page = served()
    with contextlib.ExitStack() as stack:
        for _ in range(5):
            idle = stack.enter_context(socket.create_connection(('127.0.0.1', page.port)))
            idle.sendall(GET.replace(b'here', b'127.0.0.1') + b'Content-Length: 9\r\n\r\n')
            assert b'HTTP/1.1 ' in idle.recv(4096)
            with contextlib.suppress(OSError):  # it may have ended already
                idle.sendall(b'x')
        with page.look() as browser:
            wait_for(lambda: page.ask('/healthz')[0] == 200)
            browser.recv()
