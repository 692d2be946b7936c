# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows hold what the states say, and more of them; all is what a monitor alone says."""

import dataclasses
import math
from pathlib import Path

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.fields import OtherJoints, stamp_of
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, Why
from ballscrew_monitor.core.judgement import PointSource, Reason
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import STANDSTILL
from ballscrew_monitor.judge.snapshot import restored, snapshot
from ballscrew_monitor.messages.state_messages import empty_state, fill_state
from ballscrew_monitor.recordings.axis_run import AxisRows, AxisRun
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk.events import blank, event_of, Notes, ticks
from ballscrew_monitor.recordings.replay import replay, replay_parts
from ballscrew_monitor.recordings.summary import AxisOutcome, summary_of
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

JOINT = 'sensor_msgs/msg/JointState'
CONFIG = Path(__file__).resolve().parents[3] / 'config' / 'nominal_cycle.yaml'


@pytest.fixture(scope='module')
def values():
    """Return the parameters of the nominal cycle, with few states."""
    return parameters.read_file(CONFIG) | {'x.publish_period': 0.1}


def judged_rows(bag, values):
    """Return all rows of the only axis of a bag, and what it comes to."""
    rows, outcome = [], None
    for part in replay_parts(bag, values, states=False):
        if isinstance(part, AxisOutcome):
            outcome = part
        else:
            rows.append(part.rows.copy())  # the next ones overwrite them
    return np.concatenate(rows), outcome


@pytest.fixture(scope='module')
def judged(nominal_bag, values):
    return judged_rows(Bag(nominal_bag), values)


def test_every_sample_is_a_row_and_the_states_are_some_of_them(nominal_bag, judged, values):
    rows, outcome = judged
    bag = Bag(nominal_bag)
    assert len(rows) == bag.topics['/joint_states'].count == outcome.rows
    states = [
        (
            stamp_of(state),
            state.point.speed,
            state.point.axial_load,
            state.result.rcs,
            state.result.efficiency,
            state.result.film_ratio,
            state.result.friction_torque,
            state.zone,
            state.level,
            state.event_id,
        )
        for state, _ in replay(bag, values)
    ]
    names = 'stamp speed axial_load rcs efficiency film_ratio friction_torque zone level event_id'
    shown = [rows[name][rows['published']].tolist() for name in names.split()]
    np.testing.assert_equal(list(zip(*shown)), states)


def test_the_outcome_is_that_of_the_states(nominal_bag, judged, values):
    said = (one for pair in replay(Bag(nominal_bag), values) for one in pair if one is not None)
    rows, outcome = judged
    summary, expected = outcome.summary(), summary_of(said)
    assert summary.events == expected.events
    for event, told in zip(summary.events, expected.events, strict=True):
        np.testing.assert_equal(event.target_speed, told.target_speed)
        assert event.place.endswith(' N')
        assert told.place == ''  # a message does not tell
    assert summary.states == expected.states < outcome.rows
    # The last state comes before the last sample, up to which the totals go.
    assert expected.running_time <= summary.running_time <= expected.running_time + 0.1
    still = rows['gates'] & STANDSTILL != 0
    assert outcome.judged == np.count_nonzero((rows['zone'] != 0) | still)


def test_rows_tell_zones_reasons_and_times(judged):
    rows, outcome = judged
    assert set(rows['reason']) == {Reason.JUDGED, Reason.STANDSTILL}
    np.testing.assert_array_equal(rows['zone'] == 0, rows['reason'] == Reason.STANDSTILL)
    outside = np.diff(rows['stamp'])[rows['zone'][:-1] == 2].sum()
    assert seconds(outside) == pytest.approx(outcome.totals.outside_time, abs=0.02)
    assert not rows['motor_torque_source'].any()  # the bag has no torque
    assert all(reason.text for reason in Reason)


def drive_bag(folder, samples):
    """Return a bag of pairs of speed [rad/s] and effort, at 200 Hz."""
    topic = Topic(name='/joint_states', type_name=JOINT, offer=Offer.SENSOR)
    with BagWriter(folder, 'bag') as writer:
        writer.add_topic(topic)
        for number, (speed, effort) in enumerate(samples):
            stamp = 10**9 + number * 5_000_000
            message = JointState(name=['x_axis'], velocity=[speed], effort=[effort])
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
            data = serialize_message(message)
            writer.write(topic.name, data, log_time=stamp, publish_time=stamp)
    return Bag(folder)


@pytest.fixture
def derived(tmp_path):
    """Return the rows of an axis whose load is derived, the torque lost at the end."""
    efforts = [3.0] * 150 + [math.nan] * 50
    bag = drive_bag(tmp_path, [(60.0, effort) for effort in efforts])
    values = parameters.defaults(['x']) | {
        'x.load.source': 'motor_torque',
        'x.torque.topic': 'joint_states',
        'x.torque.type': JOINT,
        'x.torque.field': 'effort[x_axis]',
        'x.torque.uncertainty': 0.1,
    }
    return judged_rows(bag, values)


def test_a_derived_load_has_its_range(derived):
    rows, outcome = derived
    told = rows['axial_load_source'] == PointSource.DERIVED
    assert np.count_nonzero(told) > 100
    assert (rows['axial_load_uncertainty'][told] > 0.0).all()
    assert np.isnan(rows['axial_load_uncertainty'][~told]).all()
    assert set(rows['reason'][150:]) == {Reason.NO_TORQUE}
    assert outcome.refused[Source.TORQUE] == {Why.NOT_A_NUMBER: 50}


def test_a_screw_that_stands_stands_whether_or_not_its_load_is_known(tmp_path):
    speeds = [60.0] * 50 + [0.0] * 150
    bag = drive_bag(tmp_path, [(speed, math.nan) for speed in speeds])
    values = parameters.defaults(['x']) | {
        'x.load.topic': 'joint_states',
        'x.load.type': JOINT,
        'x.load.field': 'effort[x_axis]',
    }
    rows, _ = judged_rows(bag, values)
    samples = rows['reason'][~rows['tick']]
    assert set(samples[:50]) == {Reason.NO_LOAD}
    assert set(samples[50:]) == {Reason.STANDSTILL}


AXIS = build_axis('x', parameters.defaults(['x']) | {'x.limits.raise_delay': 0.03})
STEP = 10_000_000  # [ns]


def alone():
    monitor = Monitor(AXIS.surface, AXIS.monitor.settings)
    return dataclasses.replace(AXIS, monitor=monitor)


def happening(now, source, choice):
    """Return a sample, now and then a refusal or a tick."""
    if choice == 7:
        return now
    if choice > 7:
        joints = OtherJoints('velocity', 'x', (f'joint{choice}',)) if choice > 8 else None
        why = Why.NOT_A_NUMBER if joints is None else Why.OTHER_JOINTS
        return Refusal(source=source, why=why, first=float(now), joints=joints, arrival=now)
    value = (60.0, 3.0, 0.0, -1000.0, 900.0, 1e9, math.nan)[choice]
    return InputSample(source=source, value=value, stamp=now)


def event_array(event, now, notes):
    if isinstance(event, int):
        return ticks(np.array([event]), place=0)
    return event_of(event, notes, axis=0, log_time=now, place=0)


@given(
    st.lists(
        st.tuples(
            st.sampled_from([1, 1, 5, 80, -300]),
            st.sampled_from([Source.SPEED, Source.LOAD]),
            st.integers(0, 11),
        ),
        max_size=60,
    ),
    st.integers(0, 60),
)
def test_states_and_outcome_are_those_of_a_monitor_alone(happened, cut):
    """In two parts, with an acknowledgement between them; joints are told at the ends of parts."""
    now, told = 10**12, []
    for step, source, choice in happened:
        now += step * STEP
        told.append((happening(now, source, choice), now))
    axis, other = alone(), alone().monitor
    notes = Notes()
    run, events, states, wanted, edges = AxisRun(axis, notes), [], [], [], 0
    for part in (told[:cut], told[cut:]):
        for event, _ in part:
            row = other.tick(event) if isinstance(event, int) else other.update(event)
            if row is not None:
                message = empty_state('x')
                edges += row.edge != 0
                wanted.append((message, fill_state(message, row, other)))
        arrays = [event_array(*timed, notes) for timed in part]
        array = np.concatenate(arrays or [blank(0)])
        found = [one[1] for one in run.take(array) if not isinstance(one, AxisRows)]
        states += [(one.state, one.inputs) for one in found]
        events += [one.event for one in found if one.event is not None]
        assert repr(axis.monitor.input_status(now)) == repr(other.input_status(now))
        assert axis.monitor.kept(1) == other.kept(1)
        changed = alone()
        changed.monitor = restored(snapshot(axis.monitor), AXIS.surface, AXIS.monitor.settings)
        ended = [one.acknowledge(now) for one in (changed.monitor, other)]
        assert ended[0] == ended[1]
        run.change(changed)
        axis = changed
    assert list(map(without_joints, states)) == list(map(without_joints, wanted))
    assert edges <= len(events)
    outcome = run.outcome()
    assert (outcome.states, outcome.judged) == (len(wanted), other.memory.judged)
    assert len(outcome.events) == other.memory.event_number


def without_joints(state):
    """Return a message and its inputs as text, without the joints that these name."""
    message, inputs = state
    return repr((message, [dataclasses.replace(status, joints=None) for status in inputs]))
