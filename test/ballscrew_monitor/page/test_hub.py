# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Frames for browsers, and the fate of one that does not keep up."""

import asyncio

from ballscrew_monitor.page import hub as hubs
from ballscrew_monitor.page.hub import Browser, Hub


def read_all(parts, browser):
    """Return the frames that wait for a browser."""

    async def reading():
        count = len(browser._replies) + len(browser._waiting)
        return [await browser.take() for _ in range(count)]

    return [parts.read(made) for made in asyncio.run(reading())]


def kinds(found):
    return [record['kind'] for record, _ in found]


def test_a_browser_is_greeted_with_all_and_then_told_the_news(page_parts):
    hub, view, browser = Hub(), page_parts.axis(), Browser()
    hub.add(view)
    hub.tick(0.0)
    assert hub.join(browser, 1.0)
    found = read_all(page_parts, browser)
    assert kinds(found) == ['hello', 'history', 'events', 'state']
    (axis,) = found[0][0]['axes']
    assert {name: axis[name] for name in page_parts.limits} == page_parts.limits
    assert found[1][1]['stamp'].tolist() == [1.0]
    assert found[3][0]['age_s'] == 1.0
    view.hear(page_parts.row(2.0), {'level': 'warn'}, page_parts.limits, 1.0)
    view.hear(page_parts.row(3.0), {'level': 'ok'}, page_parts.limits, 1.5)
    hub.tick(2.0)
    ((record, arrays),) = read_all(page_parts, browser)
    assert (record['level'], record['age_s']) == ('ok', 0.5)
    assert arrays['stamp'].tolist() == [2.0, 3.0]


def test_without_news_a_state_tells_its_age(page_parts):
    hub, browser = Hub(), Browser()
    hub.add(page_parts.axis())
    hub.tick(0.0)
    hub.join(browser, 0.0)
    read_all(page_parts, browser)
    hub.tick(0.5 * hubs.IDLE_PERIOD)
    assert not read_all(page_parts, browser)
    hub.tick(hubs.IDLE_PERIOD)
    ((record, arrays),) = read_all(page_parts, browser)
    assert record['age_s'] == hubs.IDLE_PERIOD
    assert not arrays['stamp'].size


def test_health_comes_when_it_changes_and_with_the_greeting(page_parts):
    hub, view, browser = Hub(), page_parts.axis(), Browser()
    hub.add(view)
    hub.tick(0.0)
    view.hear_health({'verdict': 'normal'})
    hub.join(browser, 0.0)
    assert read_all(page_parts, browser)[-1][0]['health'] == {'verdict': 'normal'}
    hub.tick(0.0)
    assert read_all(page_parts, browser)[-1][0]['health'] == {'verdict': 'normal'}
    hub.tick(9.0)
    assert 'health' not in read_all(page_parts, browser)[-1][0]


def test_new_limits_and_new_axes_greet_again(page_parts):
    hub, view, browser = Hub(), page_parts.axis(), Browser()
    hub.join(browser, 0.0)
    ((record, _),) = read_all(page_parts, browser)
    assert record['waiting'] == hubs.NO_NODE
    hub.add(view)
    hub.tick(0.0)
    assert 'hello' in kinds(read_all(page_parts, browser))
    view.hear(page_parts.row(2.0), {}, page_parts.limits | {'rcs_limit': 0.5}, 0.0)
    hub.tick(0.1)
    (hello,) = [one for one, _ in read_all(page_parts, browser) if one['kind'] == 'hello']
    assert hello['axes'][0]['rcs_limit'] == 0.5
    assert hello['waiting'] == ''


def test_a_node_that_is_gone_is_told_and_what_it_said_stays(page_parts):
    hub, browser = Hub(), Browser()
    hub.add(page_parts.axis())
    hub.add(page_parts.axis(axis='y'))
    hub.tick(0.0)
    hub.join(browser, 0.0)
    hub.lose('/monitor/x')
    hub.tick(1.0)
    found = read_all(page_parts, browser)
    hello = [record for record, _ in found if record['kind'] == 'hello'][-1]
    assert hello['nodes'] == [{'name': '/monitor', 'state': 'active'}]
    hub.lose('/monitor/y')
    hub.tick(5.0)
    found = read_all(page_parts, browser)
    hello = next(record for record, _ in found if record['kind'] == 'hello')
    assert hello['nodes'] == [{'name': '/monitor', 'state': 'gone'}]
    last = {'standing': 'gone', 'level': 'ok', 'age_s': 5.0}
    assert last.items() <= found[-1][0].items()
    hub.add(hub.axes['/monitor/x'])
    hub.tick(6.0)
    hello = next(one for one, _ in read_all(page_parts, browser) if one['kind'] == 'hello')
    assert hello['nodes'][0]['state'] == 'active'


def test_a_browser_that_reads_no_more_holds_nothing_and_is_greeted_when_it_does(page_parts):
    async def running():
        hub, view, slow = Hub(), page_parts.axis(), Browser()
        hub.add(view)
        hub.tick(0.0)
        hub.join(slow, 0.0)
        for number in range(2 * hubs.MOST_WAITING):
            view.hear(page_parts.row(2.0 + number), {}, page_parts.limits, 0.0)
            hub.tick(0.0)
        assert slow.is_behind
        assert not slow._waiting
        # Of the greeting and the news none was read.
        assert hub.dropped == 4 + 2 * hubs.MOST_WAITING
        reading = asyncio.create_task(slow.take())
        await asyncio.sleep(0)
        hub.tick(0.0)
        assert page_parts.read(await reading)[0]['kind'] == 'hello'
        history = page_parts.read(await slow.take())[1]
        assert history['stamp'][-1] == 1.0 + 2 * hubs.MOST_WAITING
        hub.leave(slow)
        assert hub.dropped == 4 + 2 * hubs.MOST_WAITING

    asyncio.run(running())


def test_axes_and_browsers_are_bounded(page_parts):
    hub = Hub()
    for number in range(hubs.MOST_AXES + 1):
        hub.add(page_parts.axis(axis=f'a{number}'))
    assert len(hub.axes) == hubs.MOST_AXES
    # A greeting of all fits.
    browser = Browser()
    hub.join(browser, 0.0)
    assert not browser.is_behind
    assert all(hub.join(Browser(), 0.0) for _ in range(hubs.MOST_BROWSERS - 1))
    assert not hub.join(Browser(), 0.0)


def test_an_axis_that_is_forgotten_is_shown_no_more(page_parts):
    hub, browser = Hub(), Browser()
    hub.add(page_parts.axis())
    hub.add(page_parts.axis(axis='y'))
    hub.join(browser, 0.0)
    hub.tick(0.0)
    read_all(page_parts, browser)
    hub.forget('/monitor/x')
    hub.forget('/monitor/none')
    hub.tick(0.1)
    hello = next(one for one, _ in read_all(page_parts, browser) if one['kind'] == 'hello')
    assert [axis['id'] for axis in hello['axes']] == ['/monitor/y']


def test_a_notice_names_a_node_that_is_not_shown():
    hub = Hub()
    hub.notice('/old', 'it speaks another version')
    assert hub.hello()['notices'] == ['it speaks another version']
    hub.notice('/old', '')
    assert hub.hello()['notices'] == []
    assert not hub.notices  # however many nodes come and go
