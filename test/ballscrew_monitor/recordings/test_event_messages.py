# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Events are the same after they were a message, which any ROS node reads too."""

import contextlib

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Source, StampSource, Why
from ballscrew_monitor.judge.monitor import EARLIEST, LATEST
from ballscrew_monitor.judge.records import (
    ALL_AXES,
    EVENT,
    EVENTS_VERSION,
    MEMORY_VERSION,
    NOT_KNOWN,
    REFUSAL,
    SAMPLE,
    STEP,
    TICK,
)
from ballscrew_monitor.recordings.bulk.events import blank, joined, Notes, TICK_SOURCE
from ballscrew_monitor.recordings.event_messages import events_of, note_text, packed, read
from ballscrew_msgs.msg import JudgeEvents
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from surrogate.files import InputError

NOTES = [OtherJoints('velocity', 'x_axis', names) for names in ((), ('a',), ('b', 'ü"\n'))]
times = st.integers(EARLIEST, LATEST)
numbers = st.floats(allow_nan=True)
placed = {
    'axis': st.integers(0, ALL_AXES - 1),
    'source': st.sampled_from([int(source) for source in Source]),
    'lost': st.integers(NOT_KNOWN, 2**40),
    'steady': st.sampled_from([0, 5, 2**60]),
    'arrival': times,
}
samples = st.fixed_dictionaries(
    placed
    | {
        'kind': st.just(SAMPLE),
        'stamp': times,
        'value': numbers,
        'stamp_source': st.integers(0, max(StampSource)),
    }
)
refusals = st.fixed_dictionaries(
    placed
    | {
        'kind': st.just(REFUSAL),
        'stamp': times,
        'why': st.integers(0, max(Why)),
        'first': numbers,
        'second': numbers,
        'note': st.integers(NOT_KNOWN, len(NOTES) - 1),
    }
)
ticks = st.fixed_dictionaries(
    {
        'kind': st.sampled_from([TICK, STEP]),
        'source': st.just(TICK_SOURCE),
        'axis': st.just(ALL_AXES),
        'steady': placed['steady'],
        'stamp': times,
        'arrival': times,
    }
)


@st.composite
def events(draw):
    found = draw(st.lists(samples | refusals | ticks, max_size=30))
    return joined([blank(1, **one) for one in found])


def notes():
    made = Notes()
    for joints in NOTES:
        made.number(joints)
    return made


TEXTS = {number: note_text(joints) for number, joints in enumerate(NOTES)}


@given(events(), st.integers(0, 2**63), st.lists(st.text(), max_size=3))
def test_what_is_read_is_what_was_written(made, number, snapshots):
    message = read(packed(number, made, TEXTS, snapshots))
    assert (message.number, message.snapshots) == (number, tuple(snapshots))
    assert (message.events_version, message.memory_version) == (EVENTS_VERSION, MEMORY_VERSION)
    found = events_of([message], notes())
    expected = made.copy()
    is_tick = made['kind'] == TICK
    expected['log_time'] = np.where(is_tick, made['stamp'], made['arrival'])
    for name in EVENT.names:
        assert found[name].tobytes() == expected[name].tobytes()


@given(events())
def test_ros_reads_the_same(made):
    message = deserialize_message(packed(7, made, TEXTS, ['one']), JudgeEvents)
    assert (message.number, message.snapshots) == (7, ['one'])
    for name in ('kind', 'axis', 'source', 'stamp', 'arrival'):
        assert list(getattr(message, name)) == made[name].tolist()
    values = np.array(message.value)
    assert values.tobytes() == made['value'][made['kind'] == SAMPLE].tobytes()
    named = [message.notes[at] if at >= 0 else None for at in message.note]
    assert named == [TEXTS.get(one) for one in made['note'][made['kind'] == REFUSAL].tolist()]


@given(events(), st.data())
def test_a_byte_that_is_another_or_gone_is_read_or_refused(made, data):
    """Nothing that the step would take for a place is let through."""
    whole = bytearray(packed(0, made, TEXTS))
    place = data.draw(st.integers(0, len(whole) - 1))
    if data.draw(st.booleans()):
        whole[place] = data.draw(st.integers(0, 255))
    else:
        del whole[place:]
    with contextlib.suppress(InputError):
        found = events_of([read(bytes(whole))], notes())
        has_input = (found['kind'] != TICK) & (found['kind'] != STEP)
        assert (found['source'][has_input] <= max(Source)).all()
        assert (found['why'] <= max(Why)).all()
        assert (np.abs(found['stamp']) <= LATEST).all()


@pytest.mark.parametrize(
    ('column', 'value'),
    [
        ('kind', 3),
        ('source', 4),
        ('source', 5),
        ('stamp_source', 3),
        ('stamp', 2**62),
        ('arrival', -(2**62)),
        ('axis', ALL_AXES),
        ('lost', -2),
    ],
)
def test_a_number_that_no_event_has_is_refused(column, value, says):
    made = blank(2, kind=SAMPLE, source=int(Source.SPEED), axis=0)
    made[column][1] = value
    with pytest.raises(InputError) as caught:
        events_of([read(packed(4, made, {}))], notes())
    assert says('message_damaged') in str(caught.value)


def test_what_is_no_message_is_refused(refused):
    refused('no_cdr', read, b'')
    refused('no_cdr', read, packed(0, np.empty(0, EVENT), {})[::-1])
