# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages as records: every code has a word, every sentence its place."""

import json
import math

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.judgement import PointSource, PointValidity
from ballscrew_monitor.messages.diagnostics import code_of
from ballscrew_monitor.page import records
from ballscrew_monitor.page.history import COLUMNS
from ballscrew_monitor.page.phrases import advised, phrase
from ballscrew_msgs import msg
from ballscrew_msgs.msg import BallScrewState
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import to_json
from surrogate.units import RPM

TARGET = -600.0 * RPM


def event_of(target, **more):
    """Return the last word on an event, with the codes and numbers of an advice."""
    event = msg.OutOfZone(event_id=3, **more)
    event.cause.target_speed, event.cause.target_load = target, math.nan
    return event


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


def test_the_headline_is_the_worst_finding_else_the_zone():
    """A finding of another version of the interface keeps its words."""
    low = {'code': msg.Finding.CODE_EFFICIENCY_LOW, 'value': 0.7, 'limit': 0.85}
    state = BallScrewState(zone=BallScrewState.ZONE_OUTSIDE)
    state.findings = [
        msg.Finding(severity=msg.Finding.SEVERITY_WARN, **low),
        msg.Finding(severity=msg.Finding.SEVERITY_ERROR, code=99, text='an error'),
    ]
    assert records.headline(state) == {'free': 'an error'}
    state.findings = state.findings[:1]
    said = {'value': {'efficiency': 0.7}, 'limit': {'efficiency': 0.85}}
    assert records.headline(state) == {'key': 'cause_efficiency', 'values': said}
    state.inputs = [msg.InputHealth(name='load', state=msg.InputHealth.STATE_DERIVED)]
    assert records.headline(state) == {'key': 'cause_efficiency_derived', 'values': said}
    state.findings, state.zone = [], BallScrewState.ZONE_OPTIMAL
    assert records.headline(state)['key'] == 'optimal'
    state.active_gates = [BallScrewState.GATE_LIGHT_LOAD]
    assert records.headline(state)['key'] == 'optimal_light'
    state.active_gates = [BallScrewState.GATE_STANDSTILL]
    assert records.headline(state)['key'] == 'reason_standstill'
    state.active_gates, state.zone = [], BallScrewState.ZONE_UNKNOWN
    assert records.headline(state)['key'] == 'nothing_judged'


@given(
    validity=st.sampled_from([one for one in PointValidity if one is not PointValidity.VALID]),
    speed=st.floats(-500.0, 500.0),
    load=st.floats(-1e5, 1e5),
    derived=st.booleans(),
)
def test_why_nothing_is_judged_is_said_by_code_and_numbers(validity, speed, load, derived):
    """A code that is not known, and what the torque does not tell, keep the words of the node."""
    state = BallScrewState(findings=[msg.Finding(code=msg.Finding.CODE_OUT_OF_RANGE)])
    state.result.validity, state.result.reason = int(validity), 'why'
    state.point.speed, state.point.axial_load, state.point.temperature = speed, load, 40.0
    state.point.direction = int(Direction.NEGATIVE if speed < 0.0 else Direction.POSITIVE)
    kind = msg.InputHealth.STATE_DERIVED if derived else msg.InputHealth.STATE_OK
    state.inputs = [msg.InputHealth(name='load', state=kind)]
    said = records.headline(state)
    if validity is PointValidity.NO_SURFACE:
        assert said == {'free': 'why'}
    elif validity is PointValidity.NO_INPUT:
        assert said['key'] == 'reason_missing'
    elif derived and validity in (PointValidity.UNKNOWN, PointValidity.LOAD_OUT_OF_RANGE):
        assert said['values']['what']['key'] == 'reason_no_derived_load'
        assert said['values']['why'] == {'free': 'why'}
    else:
        key = 'no_direction' if validity is PointValidity.UNKNOWN else validity.name.lower()
        assert said['key'] == f'reason_{key}'
        opposing = 0.0 - load if speed >= 0.0 else load
        assert said['values']['load'] == {'load_N': opposing}
        assert said['values']['speed'] == {'speed': abs(speed) / RPM}


@pytest.mark.parametrize(
    ('derived', 'held', 'names'),
    [
        (False, ('speed', 'axial_load'), ['speed', 'load']),
        (False, ('motor_torque', 'temperature'), ['temperature']),
        (True, ('motor_torque', 'axial_load'), ['torque']),
    ],
)
def test_inputs_without_a_sample_are_named(derived, held, names):
    """A derived load rests on the torque, and a torque that nothing rests on is not missed."""
    state = BallScrewState(findings=[msg.Finding(code=msg.Finding.CODE_INPUT_LOST)])
    state.result.validity = int(PointValidity.NO_INPUT)
    kind = msg.InputHealth.STATE_DERIVED if derived else msg.InputHealth.STATE_OK
    state.inputs = [msg.InputHealth(name='load', state=kind)]
    for name in held:
        setattr(state.point, f'{name}_source', int(PointSource.HELD))
    inputs = records.headline(state)['values']['inputs']
    assert [one['key'] for one in inputs] == [f'input_{name}' for name in names]


@pytest.mark.parametrize(
    ('ending', 'key'), [('CLEARED', 'advice_speed'), ('STOPPED', None), ('RESTARTED', None)]
)
def test_advice_is_said_by_its_numbers_and_why_an_event_ended_in_words(page_parts, ending, key):
    view, code = page_parts.axis(), getattr(msg.OutOfZone, f'ENDING_{ending}')
    view.hear_event(records.event_record(event_of(TARGET, advice='the end', ending=code)))
    (told,) = page_parts.read(view.events_frame())[0]['events']
    assert told['advice'].get('key') == key
    assert key or told['advice'] == {'free': 'the end'}


@pytest.mark.parametrize(
    ('code', 'told'), [(0, []), (101, []), (215, [215]), (401, []), (999, [])]
)
def test_a_fault_is_told_by_its_code_unless_the_screen_says_it_already(page_parts, code, told):
    view = page_parts.axis()
    status = DiagnosticStatus(values=[KeyValue(key='Code', value=str(code))])
    view.hear_code('Inputs', code_of(status))
    assert page_parts.read(view.news(0.0, 0.0)[-1])[0]['faults'] == told
    assert code_of(DiagnosticStatus()) == 0


@pytest.mark.parametrize('value', ['', '-1', 'x', '\u00b2', '9' * 5000])
def test_a_code_that_is_no_number_of_a_fault_is_none(value):
    assert code_of(DiagnosticStatus(values=[KeyValue(key='Code', value=value)])) == 0


@given(name=st.text(min_size=1), reason=st.text(), advice=st.sampled_from([math.nan, TARGET]))
def test_an_event_says_by_whom_it_was_acknowledged_and_keeps_its_advice(name, reason, advice):
    """Whoever did it, on this page or elsewhere; one that ended by itself was not."""
    seen = msg.OutOfZone.ENDING_ACKNOWLEDGED
    event = event_of(advice, ending=seen, acknowledged_by=name, acknowledge_reason=reason)
    record = records.event_record(event)
    assert record['acknowledged']
    assert (record['acknowledged_by'], record['acknowledge_reason']) == (name, reason)
    assert record['advice'] == advised(advice)
    event.acknowledged_by = event.acknowledge_reason = ''
    record = records.event_record(event)
    assert (record['acknowledged'], record['acknowledged_by']) == (True, '')


@given(
    text=st.sampled_from(['acknowledged by Ada', 'ended by a restart of the node', 'bestätigt']),
    ending=st.integers(0, 255),
)
def test_how_an_event_ended_is_read_from_its_code_alone(text, ending):
    """Whatever its sentence says, also by a code of another version."""
    record = records.event_record(event_of(TARGET, advice=text, ending=ending))
    assert record['acknowledged'] == (ending == msg.OutOfZone.ENDING_ACKNOWLEDGED)
    by_node = ending in (msg.OutOfZone.ENDING_STOPPED, msg.OutOfZone.ENDING_RESTARTED)
    assert (record['advice'] == {'free': text}) == by_node


SPEED = advised(TARGET)
OIL = records.health_record(msg.AxisHealth(advice='Fill in ISO VG 220.'))


@pytest.mark.parametrize(
    ('zone', 'health', 'speed', 'advice'),
    [
        ('outside', None, True, SPEED),
        ('outside', OIL, True, phrase('either_or', first=OIL['advice'], second=SPEED)),
        ('outside', OIL, False, OIL['advice']),
        ('outside', None, False, {'free': 'usual'}),
        ('optimal', OIL, True, ''),
        ('unknown', OIL, True, ''),
    ],
)
def test_advice_is_that_of_the_moment_and_begins_with_the_workshop(
    page_parts, zone, health, speed, advice
):
    """A warning that is only held has none: its speed was for another load."""
    view = page_parts.axis()
    view.hear([0.0] * 10, {'level': 'warn', 'zone': zone}, {'rcs_limit': None}, 0.0)
    if health:
        view.hear_health(health)
    event = event_of(TARGET if speed else math.nan, advice='usual', active=True)
    view.hear_event(records.event_record(event))
    assert page_parts.read(view.news(0.0, 0.0)[-1])[0]['advice'] == advice


def test_diagnostics_of_axes_are_told_from_others():
    assert records.place_of('ns/monitor: x: Inputs') == ('/ns/monitor', 'x', 'Inputs')
    assert records.place_of('ballscrew_monitor: Recording') == (
        '/ballscrew_monitor',
        '',
        'Recording',
    )
    assert records.place_of('no_node') is None
    assert records.place_of('a: b: c: d') is None


def test_a_shelved_warning_says_how_long_still():
    state = BallScrewState(shelved=True, shelve_reason='nut is ordered')
    state.header.stamp.sec, state.shelved_until.sec = 100, 160
    assert records.shelving_record(state) == {'left_s': 60.0, 'reason': 'nut is ordered'}
    assert records.shelving_record(BallScrewState()) is None
