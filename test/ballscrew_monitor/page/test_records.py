# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages as records: every code has a word, every sentence its place."""

import json
import math
from types import SimpleNamespace

from ballscrew_monitor.core.advice import Advice
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.memory import RESTARTED
from ballscrew_monitor.core.state import Acknowledgement, NAMELESS
from ballscrew_monitor.page import records
from ballscrew_monitor.page.history import COLUMNS
from ballscrew_msgs import msg
from ballscrew_msgs.msg import BallScrewState
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import to_json
from surrogate.units import RPM

TARGETS = Advice(target_speed=600.0 * RPM, target_load=-812.0)
ADVICE = Advice(target_speed=600.0 * RPM, target_load=-812.0, carry='surely').text


def test_every_message_is_plain_json(filled):
    """Whatever its fields hold, codes of another version included."""
    made = (
        records.state_record(filled(BallScrewState)),
        records.health_record(filled(msg.AxisHealth)),
        records.event_record(filled(msg.OutOfZone)),
        records.surface_record(filled(msg.SurfaceInfo), 'mm/min'),
        records.limits_record(filled(BallScrewState)),
    )
    for record in made:
        json.dumps(to_json(record), allow_nan=False)


def test_a_row_has_a_number_for_each_column(filled):
    row = records.row_of(filled(BallScrewState))
    assert len(row) == len(COLUMNS)
    assert all(isinstance(number, float) for number in row)


@given(speed=st.floats(-500.0, 500.0), torque=st.floats(0.0, 9.0), back=st.booleans())
def test_rows_are_of_the_machine_frame(speed, torque, back):
    state = BallScrewState()
    state.point.speed = speed
    state.point.direction = int(Direction.NEGATIVE if back else Direction.POSITIVE)
    state.result.driving_torque = torque
    row = dict(zip(COLUMNS, records.row_of(state), strict=True))
    assert row['speed_rpm'] == pytest.approx(speed / RPM)
    assert row['torque_N_m'] == (0.0 - torque if back else torque)


def test_what_is_held_or_not_judged_is_no_number():
    state = BallScrewState(active_gates=[BallScrewState.GATE_LIGHT_LOAD])
    state.point.axial_load_source = int(PointSource.HELD)
    row = dict(zip(COLUMNS, records.row_of(state), strict=True))
    assert math.isnan(row['load_N'])
    assert math.isnan(row['efficiency'])
    assert row['rcs'] == 0.0
    state.active_gates = [BallScrewState.GATE_STANDSTILL]
    row = dict(zip(COLUMNS, records.row_of(state), strict=True))
    assert math.isnan(row['rcs'] + row['film_ratio'] + row['torque_N_m'])


def test_the_headline_is_the_worst_finding_else_the_zone(says):
    state = BallScrewState(zone=BallScrewState.ZONE_OUTSIDE)
    state.findings = [
        msg.Finding(severity=msg.Finding.SEVERITY_WARN, text='a warning'),
        msg.Finding(severity=msg.Finding.SEVERITY_ERROR, text='an error'),
    ]
    assert records.headline(state) == 'an error'
    state.findings, state.zone = [], BallScrewState.ZONE_OPTIMAL
    assert records.headline(state) == says('optimal')
    state.active_gates = [BallScrewState.GATE_LIGHT_LOAD]
    assert records.headline(state) == says('light')
    state.active_gates = [BallScrewState.GATE_STANDSTILL]
    assert records.headline(state) == says('still')
    state.active_gates, state.zone = [], BallScrewState.ZONE_UNKNOWN
    assert records.headline(state) == says('nothing')


@pytest.mark.parametrize(
    ('surface', 'words', 'key'),
    [
        (SimpleNamespace(lead=0.01), ADVICE, 'advice'),
        (None, ADVICE, 'advice_without_lead'),
        (SimpleNamespace(lead=0.01), 'the node was shut down', 'shut_down'),
    ],
)
def test_advice_is_in_terms_of_the_axis(page_parts, says, surface, words, key):
    """Without its lead, and where the node ends the event, the words of the node stay."""
    view = page_parts.axis()
    view.surface = surface
    view.hear_event(records.event_record(msg.OutOfZone(event_id=3, active=True, advice=words)))
    (told,) = page_parts.read(view.events_frame())[0]['events']
    assert told['advice'] == says(key)


@given(name=st.text(min_size=1), reason=st.text(), advice=st.sampled_from([Advice(), TARGETS]))
def test_an_event_says_by_whom_it_was_acknowledged_and_keeps_its_advice(name, reason, advice):
    """Whoever did it, on this page or elsewhere; one that ended by itself was not."""
    event = msg.OutOfZone(event_id=3, advice=Acknowledgement(name=name, reason=reason).ending)
    event.cause.target_speed, event.cause.target_load = advice.target_speed, advice.target_load
    record = records.event_record(event)
    assert record['acknowledged']
    assert record['acknowledged_by'] == (f'{name}: {reason}' if reason else name)
    assert record['words'] == advice.text
    event.advice = NAMELESS.ending
    record = records.event_record(event)
    assert (record['acknowledged'], record['acknowledged_by']) == (True, '')
    for words in (advice.text, RESTARTED):
        event.advice = words
        record = records.event_record(event)
        assert (record['acknowledged'], record['words']) == (False, words)


def test_diagnostics_of_axes_are_told_from_others():
    assert records.place_of('ns/monitor: x: Inputs') == ('/ns/monitor', 'x', 'Inputs')
    assert records.place_of('ballscrew_monitor: Recording') is None
    assert records.place_of('a: b: c: d') is None


def test_a_shelved_warning_says_how_long_still():
    state = BallScrewState(shelved=True, shelve_reason='nut is ordered')
    state.header.stamp.sec, state.shelved_until.sec = 100, 160
    assert records.shelving_record(state) == {'left_s': 60.0, 'reason': 'nut is ordered'}
    assert records.shelving_record(BallScrewState()) is None
