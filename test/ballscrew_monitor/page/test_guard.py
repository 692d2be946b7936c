# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Readers that are let in, over real sockets, and headers that every answer carries."""

import asyncio
from concurrent.futures import ThreadPoolExecutor

from ballscrew_monitor.page.guard import HEADERS, is_loopback, MOST_WRONG, read_token, Tokens
import pytest
from websockets.exceptions import InvalidStatus

TOKEN = 'correct horse battery staple'
PATHS = ('/', '/metrics', '/healthz', '/login', '/components/format.js', '/none')


def test_loopback_is_what_nobody_else_reaches():
    assert all(map(is_loopback, ('127.0.0.1', 'localhost', '::1', '127.8.0.2')))
    assert not any(map(is_loopback, ('0.0.0.0', '::', '192.168.0.7', 'machine', 'localhost.evil')))


@pytest.mark.parametrize('path', PATHS)
def test_every_answer_carries_the_headers(served, path):
    _, headers, _ = served().ask(path)
    assert {name: headers[name] for name in HEADERS} == HEADERS


@pytest.mark.parametrize('path', PATHS)
@pytest.mark.parametrize('host', ['evil.example', 'evil.example:80', '192.168.0.7', 'a b', ''])
def test_another_name_in_host_is_refused(served, says, path, host):
    """The name of a page elsewhere that was bound to this address, /metrics included."""
    status, headers, text = served().ask(path, Host=host)
    assert (status, text) == (421, says('host'))
    assert headers['X-Frame-Options'] == 'DENY'


@pytest.mark.parametrize('path', PATHS)
def test_another_origin_is_refused(served, says, path):
    page = served()
    for origin in ('http://evil.example', 'null', f'https://127.0.0.1:{page.port}', ''):
        assert page.ask(path, Origin=origin)[::2] == (403, says('origin'))
    assert page.ask('/healthz', Origin=f'http://127.0.0.1:{page.port}')[0] == 200


@pytest.mark.parametrize('name', ['localhost', '127.0.0.1', '[::1]', 'LOCALHOST'])
def test_names_of_this_machine_are_known(served, name):
    """Whatever the port: a tunnel has another one."""
    page = served()
    assert page.ask('/', Host=f'{name}:9000', Origin=f'http://{name}:9000')[0] == 200


@pytest.mark.parametrize('origin', ['http://evil.example', 'null'])
def test_a_socket_of_another_page_is_refused(served, origin):
    with pytest.raises(InvalidStatus, match='403'):
        served().look(origin=origin)


@pytest.mark.parametrize(
    ('changes', 'status'),
    [({}, 101), ({'Origin': None}, 403), ({'Host': 'evil.example'}, 403), ({'Host': ''}, 403)],
)
def test_a_socket_without_origin_or_with_another_host_is_refused(served, changes, status):
    page = served()
    here = f'127.0.0.1:{page.port}'
    asked = {
        'Host': here,
        'Origin': f'http://{here}',
        'Sec_WebSocket_Key': 'AAAAAAAAAAAAAAAAAAAAAA==',
    }
    asked |= {'Connection': 'Upgrade', 'Upgrade': 'websocket', 'Sec_WebSocket_Version': '13'}
    asked = {name: value for name, value in (asked | changes).items() if value is not None}
    assert page.status('/live', **asked) == status


def test_without_the_token_there_is_a_form_and_nothing_else(served, says):
    page = served(token=TOKEN)
    status, headers, text = page.ask('/')
    assert (status, headers['Content-Security-Policy']) == (
        401,
        HEADERS['Content-Security-Policy'],
    )
    assert 'type="password"' in text
    for path in ('/metrics', '/components/format.js', '/none'):
        assert page.ask(path)[::2] == (401, says('token_needed'))
    assert page.ask('/healthz')[0] == 200
    with pytest.raises(InvalidStatus, match='403'):
        page.look()


def test_the_token_gives_a_cookie_that_opens_all(served):
    page = served(token=TOKEN)
    form = f'token={TOKEN.replace(" ", "+")}'
    status, headers, _ = page.ask('/login', 'POST', form)
    assert (status, headers['Location']) == (303, '/')
    cookie = headers['Set-Cookie']
    assert {'HttpOnly', 'SameSite=strict'} <= set(cookie.split('; '))
    assert TOKEN not in cookie
    carried = cookie.split(';')[0]
    assert page.ask('/', Cookie=carried)[0] == 200
    assert page.tokens.wrong == 0
    assert page.ask('/metrics', Cookie=f'{carried}0')[0] == 401
    assert page.ask('/metrics', Authorization='Bearer guessed')[0] == 401
    assert page.tokens.wrong == 2
    assert page.ask('/metrics', Cookie=carried)[0] == 200
    with page.look(additional_headers={'Cookie': carried}) as socket:
        assert b'hello' in socket.recv()
    assert page.ask('/metrics', Authorization=f'Bearer {TOKEN}')[0] == 200
    for wrong in (f'{carried}x', 'ballscrew_page=', 'ballscrew_page="', '\xff=\xfe'):
        assert page.ask('/', Cookie=wrong)[0] == 401


def test_a_thousand_wrong_tokens_do_no_harm(served):
    """They are counted and slowed, too many at the same time refused; the right one opens."""
    page = served(token=TOKEN)

    def guess(number):
        return page.ask('/login', 'POST', f'token={number}')[0]

    with ThreadPoolExecutor(8) as pool:
        statuses = list(pool.map(guess, range(1000)))
    assert set(statuses) <= {401, 429}
    assert page.tokens.wrong == len(statuses)
    assert page.ask('/login', 'POST', f'token={TOKEN}')[0] == 303
    assert (
        f'wrong_tokens_total {page.tokens.wrong:.1f}'
        in page.ask('/metrics', Authorization=f'Bearer {TOKEN}')[2]
    )


def test_the_right_token_opens_while_as_many_wrong_ones_wait_as_may():
    async def guessing():
        tokens = Tokens(TOKEN, slowness=1e6)
        waiting = [asyncio.create_task(tokens.accept('x')) for _ in range(MOST_WRONG)]
        await asyncio.sleep(0)
        assert await tokens.accept('y') is None
        assert await tokens.accept(TOKEN)
        for one in waiting:
            one.cancel()
        await asyncio.wait(waiting)
        assert tokens.wrong == MOST_WRONG + 1
        another = asyncio.create_task(tokens.accept('y'))
        await asyncio.sleep(0)
        assert not another.done()  # it waits again
        another.cancel()

    asyncio.run(guessing())


@pytest.mark.parametrize('form', ['', 'x' * 5000, 'token=%ff', '&' * 700, 'token=' + 'y' * 900])
def test_forms_that_are_none_are_wrong_tokens(served, form):
    assert served(token=TOKEN).ask('/login', 'POST', form)[0] == 401


def test_a_page_for_all_addresses_knows_addresses_and_its_own_names(served):
    """An address in Host cannot be rebound, a name can."""
    page = served(host='0.0.0.0', token=TOKEN)
    assert page.ask('/healthz', Host='192.168.0.7:8090')[0] == 200
    assert page.ask('/healthz', Host='evil.example')[0] == 421


def test_token_files(tmp_path, refused):
    path = tmp_path / 'token'
    refused('token_missing', read_token, path)
    path.write_text(f'{TOKEN}\nanother line\n')
    assert read_token(path) == TOKEN
    for content, key in ((b'short', 'token_short'), (b'\xff' * 20, 'token_no_text')):
        path.write_bytes(content)
        refused(key, read_token, path)
    path.write_text('x' * 10_000)
    refused('token_long', read_token, path)
