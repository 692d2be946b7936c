# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files that are served, and sockets that are misused."""

from collections import deque
import contextlib
import socket

from ballscrew_monitor.page import app, components, hub, server
from ballscrew_monitor.page.questions import MOST_FAULTS
import pytest
from websockets.exceptions import ConnectionClosed


def test_the_page_names_files_that_are_there(served):
    page = served()
    status, headers, text = page.ask('/')
    assert (status, headers['Content-Type']) == (200, 'text/html; charset=utf-8')
    for name, (content, kind) in components.table().items():
        assert f'/components/{name}"' in text
        status, headers, found = page.ask(f'/components/{name}')
        assert (status, headers['Content-Type'], found.encode()) == (200, kind, content)


@pytest.mark.parametrize(
    'path',
    [
        '/components/',
        '/components/none.js',
        '/components/../page.py',
        '/components/%2e%2e/page.py',
        '/components//etc/passwd',
        '/components/uplot',
        '/components/page.js',
        '/components/uplot/LICENSE',
        '/components/format.js%00',
    ],
)
def test_nothing_else_is_served(served, path):
    assert served().ask(path)[0] == 404


def test_there_is_no_icon(served):
    assert served().ask('/favicon.ico')[::2] == (204, '')


@pytest.mark.parametrize('method', ['POST', 'PUT', 'DELETE', 'OPTIONS'])
def test_the_page_is_only_read(served, method):
    assert served().ask('/', method)[0] == 405


def test_names_with_markup_come_as_json_alone(served, page_parts):
    name = '<script>alert(1)</script>'
    page = served()
    page.call(page.hub.add, page_parts.axis(axis=name))
    assert name not in page.ask('/')[2]
    with page.look() as socket:
        record, _ = page_parts.read(socket.recv())
    assert record['axes'][0]['axis'] == name


def test_garbage_is_answered_until_it_is_too_much(served, page_parts):
    with served().look() as socket:
        assert page_parts.read(socket.recv())[0]['kind'] == 'hello'
        for number in range(MOST_FAULTS):
            socket.send(b'\x00\xff' if number % 2 else 'garbage')
            assert not page_parts.read(socket.recv())[0]['ok']
        socket.send('garbage')
        with pytest.raises(ConnectionClosed):
            deque(socket)
    assert (socket.close_code, socket.close_reason) == (app.RUDE, app.NO_REQUESTS)


def test_a_hundred_megabytes_are_not_taken(served):
    """Neither at once nor in parts: the socket is closed, and the page goes on."""
    page = served()

    def send(socket, message):
        socket.recv()
        socket.send(message)
        socket.recv()

    for message in ('x' * 100_000_000, iter(['x' * 1_000_000] * 100)):
        with page.look() as socket, pytest.raises(ConnectionClosed):
            send(socket, message)
    assert page.ask('/healthz')[::2] == (200, 'ok')


def test_a_connection_that_asks_for_nothing_is_closed(served, page_parts, monkeypatch):
    """A browser that listens stays."""
    monkeypatch.setattr(server, 'FIRST_WORDS', 0.2)
    page = served()
    with page.look() as browser:
        with socket.create_connection(('127.0.0.1', page.port)) as silent:
            assert silent.recv(1) == b''
        page.call(page.hub.tell, b'more')
        while browser.recv() != b'more':
            pass


def test_a_page_that_sends_nothing_any_more_says_so(served, wait_for):
    page = served()
    page.call(setattr, page.hub, 'tick', None)
    wait_for(lambda: page.ask('/healthz')[0] == 503)


def test_browsers_that_leave_are_forgotten(served, wait_for):
    page = served()
    with contextlib.ExitStack() as stack:
        for _ in range(5):
            stack.enter_context(page.look())
        wait_for(lambda: len(page.hub.browsers) == 5)
        assert 'ballscrew_page_browsers 5.0' in page.ask('/metrics')[2]
    wait_for(lambda: not page.hub.browsers)


def test_one_browser_too_many_is_told(served, monkeypatch):
    monkeypatch.setattr(hub, 'MOST_BROWSERS', 0)
    with served().look() as socket:
        with pytest.raises(ConnectionClosed) as caught:
            socket.recv()
    assert (caught.value.rcvd.code, caught.value.rcvd.reason) == (app.TRY_LATER, app.BUSY)


def test_a_browser_that_stops_reading_does_not_stop_others(
    served, page_parts, wait_for, monkeypatch
):
    """What it does not get is counted; one that reads hears the last row."""
    monkeypatch.setattr(hub, 'MOST_WAITING', 8)
    page, view = served(), page_parts.axis()
    page.call(page.hub.add, view)

    def hear():
        """Let more wait than the buffers of sockets hold."""
        page.call(page.hub.tell, bytes(1_000_000))

    with page.look(max_queue=1) as slow, page.look(max_queue=None) as good:
        slow.recv()
        wait_for(lambda: page.hub.dropped > 0, meanwhile=hear)
        count, heard = 2.0, set()

        def read():
            page.call(view.hear, page_parts.row(count), {}, page_parts.limits, 0.0)
            made = good.recv()
            record, arrays = page_parts.read(made) if any(made) else ({'kind': ''}, {})
            if record['kind'] in ('state', 'history'):
                heard.update(arrays['stamp'].tolist())

        wait_for(lambda: count in heard, meanwhile=read)
    assert 'ballscrew_page_dropped_frames_total 0.0' not in page.ask('/metrics')[2]
