# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Samples and refusals as records, and the joints that messages about others name."""

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.judge.records import Event, REFUSAL, SAMPLE
from ballscrew_monitor.judge.words import EARLIEST, fill, LATEST, MOST_OTHERS, within
from hypothesis import given
from hypothesis import strategies as st


def others(*names):
    return Refusal(
        source=Source.LOAD, why=Why.OTHER_JOINTS, joints=OtherJoints('velocity', 'x', names)
    )


def heard(monitor):
    """Return the joints that the status of the load names."""
    return monitor.input_status(0)[1].joints


def test_joints_of_messages_about_others_are_collected_until_a_sample_comes(core):
    monitor = core.monitor()
    assert heard(monitor) is None
    for names in (('c', 'a'), ('b',), ('c', 'a')):
        monitor.update(others(*names))
    assert heard(monitor) == OtherJoints('velocity', 'x', ('a', 'b', 'c'))
    monitor.update(core.sample(Source.LOAD, 1.0))
    assert heard(monitor) is None
    monitor.update(others('d'))
    assert heard(monitor).names == ('d',)


def test_of_joints_without_end_a_part_is_kept(core):
    monitor = core.monitor()
    for i in range(3 * MOST_OTHERS):
        monitor.update(others(f'joint{i}'))
    assert len(heard(monitor).names) == MOST_OTHERS


def test_a_refusal_is_told_in_its_own_words(core):
    monitor = core.monitor()
    for text in ('one', 'two'):
        monitor.update(Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER, text=text))
        assert monitor.input_status(0)[1].refusal == text


@given(st.integers(-(2**70), 2**70), st.integers(-(2**70), 2**70), st.none() | st.integers(0, 9))
def test_a_record_holds_an_event_whose_stamps_fit(stamp, arrival, lost):
    """Differences of stamps stay within 64 bits."""
    record, known = Event(), -1 if lost is None else lost
    changes = {'arrival': arrival, 'lost': lost}
    fill(record, Refusal(source=Source.TORQUE, why=Why.NOT_A_NUMBER, **changes))
    assert (record.kind, record.source, record.why) == (REFUSAL, 2, Why.NOT_A_NUMBER)
    assert (record.arrival, record.lost) == (min(max(arrival, EARLIEST), LATEST), known)
    receive = StampSource.RECEIVE
    fill(record, InputSample(source=Source.SPEED, value=2, stamp=stamp, stamp_source=receive))
    assert (record.kind, record.source, record.value) == (SAMPLE, Source.SPEED, 2.0)
    assert (record.stamp, record.stamp_source) == (within(stamp), receive)
    assert isinstance(record.value, float)
    assert within(LATEST) - within(EARLIEST) < 2**63
