# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The file to send of a page: behind its guard, one at a time, with what the page knows."""

import asyncio
import csv
import io
import json
import threading
import types
import zipfile

from ballscrew_monitor.clients import fault_report as reports
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.page import fault, records
from ballscrew_monitor.page.fault import fault_maker, places_of
from ballscrew_monitor.page.hub import Hub
from ballscrew_msgs.msg import OutOfZone
import pytest
from surrogate.files import InputError

TOKEN = 'correct-horse-battery'
DEADLINE = 600.0  # [s] which only ends a hang


async def made():
    return b'PK of a fault'


@pytest.fixture(autouse=True)
def no_failures(monkeypatch, tmp_path):
    monkeypatch.setattr(reports.tempfile, 'tempdir', str(tmp_path))


def test_it_is_guarded_as_all_else_is(served):
    page = served(token=TOKEN, fault=lambda hub: made)
    bearer = {'Authorization': f'Bearer {TOKEN}'}
    assert page.ask('/report-fault', 'POST')[0] == 401
    assert page.ask('/report-fault', 'POST', Origin='http://elsewhere', **bearer)[0] == 403
    assert page.ask('/report-fault', 'POST', Host='elsewhere', **bearer)[0] == 421
    assert page.ask('/report-fault', **bearer)[0] == 405
    status, headers, content = page.ask('/report-fault', 'POST', **bearer)
    assert (status, content) == (200, 'PK of a fault')
    assert headers['Content-Disposition'] == 'attachment; filename="ballscrew_fault.zip"'
    assert headers['Cache-Control'] == 'no-store'


def test_what_cannot_be_made_is_a_sentence(served):
    async def refuse():
        raise InputError('log there cannot be read')

    page = served(fault=lambda hub: refuse)
    assert page.ask('/report-fault', 'POST')[::2] == (500, 'log there cannot be read')
    assert page.ask('/report-fault', 'POST')[0] == 500  # it is not taken for one under way


def test_one_is_made_at_a_time(served):
    begun, let_go = threading.Event(), threading.Event()

    async def make_slowly():
        begun.set()
        await asyncio.to_thread(let_go.wait, DEADLINE)
        return b''

    page = served(fault=lambda hub: make_slowly)
    first = threading.Thread(target=page.ask, args=('/report-fault', 'POST'))
    first.start()
    assert begun.wait(DEADLINE)
    assert page.ask('/report-fault', 'POST')[0] == 429
    let_go.set()
    first.join()
    assert page.ask('/report-fault', 'POST')[0] == 200


def test_it_is_made_in_another_thread_than_that_of_the_page(page_parts, monkeypatch):
    hub, threads = Hub(), []
    hub.add(page_parts.axis())
    texts_of, places = fault.texts_of, fault.places_of

    def seen(function):
        return lambda *given: threads.append(threading.current_thread()) or function(*given)

    monkeypatch.setattr(fault, 'texts_of', seen(texts_of))
    monkeypatch.setattr(fault, 'places_of', seen(places))
    asyncio.run(fault_maker(hub, None, None)())
    assert len(threads) == 2
    assert threading.current_thread() not in threads


def test_it_holds_what_the_page_knows_of_each_axis(page_parts, tmp_path):
    log = tmp_path / 'log.csv'
    log.write_text(f'time_s,speed\n0,1\n# {TOKEN}\n')
    view = page_parts.axis()
    for stamp in range(2, 200):
        view.history.take(page_parts.row(float(stamp)))
    view.hear_parameters({'x.speed.topic': '/joint_states'})
    end = OutOfZone.ENDING_ACKNOWLEDGED
    who = {'acknowledged_by': 'Jane Doe', 'acknowledge_reason': 'seen by JD'}
    view.hear_event(records.event_record(OutOfZone(event_id=1, ending=end, **who)))
    again = {'acknowledged_by': 'Jane Doe', 'acknowledge_reason': 'speed'}
    view.hear_event(records.event_record(OutOfZone(event_id=2, ending=end, **again)))
    view.state = {**view.state, 'shelved': {'left_s': 1.0, 'reason': 'oil due (Bo)'}}
    hub = Hub()
    hub.add(view)
    content = asyncio.run(fault_maker(hub, log, TOKEN)())
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        known = json.loads(archive.read('page_monitor_x.json'))
        rows = list(csv.DictReader(io.StringIO(archive.read('page_monitor_x.csv').decode())))
        assert TOKEN.encode() not in archive.read('log_log.csv')
    assert [known['events'][0][key] for key in who] == ['NAME', 'NAME']
    assert known['state']['shelved']['reason'] == 'NAME'
    assert known['parameters'] == {'x.speed.topic': '/joint_states'}
    assert (known['state']['zone'], known['efficiency_limit']) == ('optimal', 0.85)
    assert [float(rows[at]['stamp']) for at in (0, -1)] == [79.0, 199.0]


def test_the_folders_of_a_node_are_found_where_they_lie_here(monkeypatch, tmp_path):
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    own, recordings = tmp_path / 'ballscrew_monitor' / 'monitor', tmp_path / 'recordings'
    nodes = [
        types.SimpleNamespace(node='/monitor', parameters={}),
        types.SimpleNamespace(node='/other', parameters={'record_dir': str(recordings)}),
        types.SimpleNamespace(node='/third', parameters={'record_dir': '/nowhere'}),
    ]
    assert places_of(nodes) == set()
    RestartState(own).close()
    recordings.mkdir()
    assert places_of(nodes) == {own, recordings}

    def refuse(path):
        raise PermissionError(path)

    monkeypatch.setattr(fault, 'is_state', refuse)
    assert places_of(nodes) == {recordings}
