# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording plays as the node would have said it, along a clock of its own."""

import asyncio
import math
from types import SimpleNamespace

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.options import PARAMS
from ballscrew_monitor.page import recording, records
from ballscrew_monitor.page.history import COLUMNS, STEP
from ballscrew_monitor.page.hub import Browser, Hub
from ballscrew_monitor.page.phrases import phrase
from ballscrew_monitor.page.recording import recorded_axes, Recording
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import ignore, replay
from ballscrew_monitor.report.parameters import parameters_for
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest


@pytest.fixture(scope='module')
def judged(short_bag):
    """Return the states that the node publishes for 3 s, as rows and records, and its events."""
    bag = Bag(short_bag)
    found = replay(bag, parameters_for(bag, None, PARAMS).values)
    return [(records.row_of(state), records.state_record(state)) for state, _ in found]


@pytest.fixture(scope='module')
def axes_of(short_bag):
    bag = Bag(short_bag)
    parameters = parameters_for(bag, None, PARAMS)
    return lambda: recorded_axes(bag, parameters, ignore)


@pytest.fixture
def playing(axes_of):
    return Recording(Hub(), axes_of())


def axis_of(playing):
    (view,) = playing._hub.axes.values()
    return view


def ask(playing, do, **request):
    return asyncio.run(playing.handlers[do](Browser(), {'id': 1, **request}))


def test_rows_are_those_of_the_states_that_the_node_publishes(axes_of, judged):
    """To the last bit, the stamp to a microsecond."""
    (axis,) = axes_of()
    said = np.array([row for row, _ in judged])
    np.testing.assert_array_equal(axis.rows[:, 1:], said[:, 1:])
    np.testing.assert_allclose(axis.rows[:, 0], said[:, 0], rtol=0.0, atol=1e-6)


def test_what_is_shown_is_what_the_state_said(playing, judged):
    begin = judged[0][0][0]
    for at in range(0, len(judged), 7):
        row, record = judged[at]
        ask(playing, 'seek', s=row[0] - begin + 1e-4)
        playing.advance(0.0, 0.0)
        shown = axis_of(playing)
        assert -2.0 * STEP < shown.history.since(0)[-1, 0] - row[0] < 1e-4
        for name in ('level', 'zone'):
            assert shown.state[name] == record[name], name
        if record['zone'] in ('outside', 'optimal'):
            assert shown.state['headline'] == record['headline']


def test_a_light_load_in_the_optimal_zone_is_said_as_the_state_says_it(axes_of):
    """Also where the load is above its limit, and the gate of the light load is still shut."""
    (axis,) = axes_of()
    row = axis.rows[-1].copy()
    row[[COLUMNS.index(name) for name in ('load_N', 'efficiency')]] = 1e3, math.nan
    codes = np.array([Zone.OPTIMAL, 0], np.uint8)
    row[COLUMNS.index('rcs')] = 0.0
    assert axis._state_record(row, codes)['headline'] == phrase('optimal_light')


def test_the_totals_are_those_that_the_node_ends_with(playing, judged):
    """Wherever the clock stands."""
    ended = judged[-1][1]['totals']
    assert ended['outside_time'] > 0.0 < ended['energy_lost']
    for place in (0.0, 1.0):
        ask(playing, 'seek', s=place)
        playing.advance(0.0, 0.0)
        assert axis_of(playing).state['totals'] == ended


def test_it_plays_at_its_rate_and_stops_at_its_end(playing):
    span = playing.clock()['span_s']
    assert span == pytest.approx(3.0, abs=0.1)
    playing.advance(1.0, 0.0)
    assert playing.clock() == {'at_s': 1.0, 'span_s': span, 'rate': 1.0, 'playing': True}
    ask(playing, 'rate', x=0.5)
    playing.advance(1.0, 1.0)
    assert playing.clock()['at_s'] == 1.5
    ask(playing, 'pause')
    playing.advance(1.0, 2.0)
    assert playing.clock()['at_s'] == 1.5
    ask(playing, 'play')
    playing.advance(100.0, 3.0)
    assert (playing.clock()['at_s'], playing.clock()['playing']) == (span, False)
    ask(playing, 'play')
    playing.advance(0.25, 4.0)
    assert playing.clock()['at_s'] == pytest.approx(0.125)


@given(st.lists(st.floats(-1.0, 4.0), min_size=1, max_size=8))
def test_wherever_it_jumps_the_rows_before_are_there(axes_of, playing_once, places):
    """Those of a recording that was played to there."""
    for place in places:
        ask(playing_once, 'seek', s=place)
        playing_once.advance(0.0, 0.0)
        at = min(max(place, 0.0), playing_once.clock()['span_s'])
        course = playing_once._axes[0].rows
        stamps = axis_of(playing_once).history.since(0)[:, 0]
        until = course[course[:, 0] <= course[0, 0] + at, 0]
        assert until[-1] - STEP < stamps[-1] <= until[-1]
        assert stamps[0] == course[0, 0]
        assert np.all(np.diff(stamps) >= 0.0)


@pytest.fixture(scope='module')
def playing_once(axes_of):
    made = Recording(Hub(), axes_of())
    ask(made, 'pause')
    return made


def test_events_are_shown_from_their_begin_as_far_as_they_have_come(playing):
    view = axis_of(playing)
    (event,) = playing._axes[0]._case.outcome.events
    begin = event.start / 1e9 - playing._first
    ask(playing, 'pause')
    assert view.events == {}
    ask(playing, 'seek', s=begin + 0.25 * event.duration)
    playing.advance(0.0, 0.0)
    assert view.events[event.event_id]['active']
    assert view.events[event.event_id]['duration_s'] == pytest.approx(0.25 * event.duration)
    acts = {name: view.events[event.event_id][name] for name in ('shelved', 'acknowledged')}
    assert acts == {'shelved': False, 'acknowledged': False}
    ask(playing, 'seek', s=3.0)
    playing.advance(0.0, 0.0)
    assert view.events[event.event_id]['duration_s'] <= event.duration


def test_a_recording_that_is_paused_has_no_news(playing, monkeypatch):
    """Not even of events with numbers that are not known, nor long after the last row."""
    view, of_event = axis_of(playing), recording._event_record
    unknown = {'worst': math.nan}
    monkeypatch.setattr(recording, '_event_record', lambda *known: of_event(*known) | unknown)
    ask(playing, 'pause')
    ask(playing, 'seek', s=3.0)
    playing.advance(0.0, 0.0)
    view.news(0.0, 1.0)
    (event,) = view.events.values()
    assert math.isnan(event['worst'])
    monkeypatch.setattr(recording, 'SPAN', 1.0)
    for past in (0.0, 2.0):
        playing._axes[0].show(playing._last + past, 0.5)
        assert view.news(0.5, 1.0) == []
        assert view.history.count
    assert len(view.news(1.0, 1.0)) == 1  # a state comes after the period anyway


def test_browsers_are_told_the_clock(playing, page_parts):
    browser = Browser()
    playing._hub.join(browser, 0.0)
    assert [page_parts.read(made)[0]['kind'] for made in browser._waiting][:2] == [
        'hello',
        'clock',
    ]
    ask(playing, 'pause')
    told, _ = page_parts.read(browser._waiting[-1])
    assert (told['kind'], told['playing']) == ('clock', False)


@pytest.mark.parametrize(
    ('do', 'key', 'request_made'),
    [('rate', 'slow', {'x': 0}), ('rate', 'number', {'x': 'x'}), ('seek', 'seek', {})],
)
def test_what_the_clock_cannot_do_is_refused(playing, refused, do, key, request_made):
    refused(key, ask, playing, do, **request_made)


def test_a_recording_without_a_row_is_refused(short_bag, monkeypatch, refused):
    nothing = SimpleNamespace(axes=[], name='short')
    monkeypatch.setattr(recording, 'judge_log', lambda *given, **named: nothing)
    bag = Bag(short_bag)
    with refused('empty', path=bag.path):
        recorded_axes(bag, parameters_for(bag, None, PARAMS), ignore)
