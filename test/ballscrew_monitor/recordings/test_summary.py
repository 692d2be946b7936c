# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The summary of a run."""

import json
import math

from ballscrew_monitor.recordings.summary import summary_of
from ballscrew_msgs.msg import BallScrewState, Finding, OutOfZone
from surrogate.files import json_text


def make_summary():
    """Return the summary of 10 s with one event that ended and one that did not."""
    said = [OutOfZone()]  # event 0: none so far
    for second in (100, 110):
        state = BallScrewState(axis='x', judged=1000)
        state.header.stamp.sec = second
        state.totals.running_time, state.totals.optimal_time = 8.0, 6.0
        state.totals.outside_time, state.totals.mixed_time = 2.0, 8.0
        state.totals.energy_lost = 123.4
        said.append(state)
    for number, active in ((1, True), (1, False), (2, True)):
        event = OutOfZone(event_id=number, active=active, duration=2.0, worst_value=0.25)
        event.start.sec = 100 + 3 * number
        event.cause = Finding(code=Finding.CODE_RCS_HIGH, limit=0.01)
        said.append(event)
    return summary_of(said)


def of_one_state(event=None, **totals):
    """Return the summary of one state, and of an event."""
    state = BallScrewState(axis='x', judged=100)
    for name, value in totals.items():
        setattr(state.totals, name, value)
    return summary_of([state] if event is None else [state, event])


def test_a_summary_has_the_last_totals_and_each_event_once(says):
    summary = make_summary()
    assert (summary.states, summary.judged, summary.running_time) == (2, 1000, 8.0)
    expected = [says('motion_8_0'), says('regime_boundary_0'), says('zone_optimal_6')]
    assert summary.lines()[:3] == expected
    events = make_summary().lines()[3:]
    assert events == ['events      2', says('1_3_0'), says('2_6_0')]
    assert [summary.span(event) for event in summary.events] == [(3.0, 5.0), (6.0, 10.0)]


def test_percents_are_rounded_as_in_a_verdict(says):
    event = OutOfZone(event_id=1, worst_value=0.0656)
    event.cause = Finding(code=Finding.CODE_EFFICIENCY_LOW, limit=0.85)
    found = of_one_state(event)
    assert found.lines()[-1].endswith('efficiency < 85 %, worst 6.6 %')
    assert found.events[0].shown(math.nan) == '–'
    said = of_one_state(running_time=75.6, optimal_time=0.4, outside_time=75.2).lines()[2]
    assert said.startswith(says('zone_optimal_0'))


def test_json_has_units_and_no_nan_and_without_a_state_there_is_none():
    record = json.loads(json_text(of_one_state(energy_lost=math.nan).record()))
    assert record['energy_lost_J'] is None
    assert record['running_time_s'] == 0.0
    assert record['events'] == []
    assert summary_of([]) is None


def test_no_event_reads_well_only_where_a_motion_was_judged():
    moved = of_one_state(running_time=9.0, optimal_time=9.0)
    assert (moved.says_nothing, moved.lines()[-1]) == (False, 'events      none')
    for still in (of_one_state(), of_one_state(running_time=9.0, unjudged_time=9.0)):
        assert still.says_nothing
        assert still.lines()[-1] == 'events      none, for no motion was judged'
