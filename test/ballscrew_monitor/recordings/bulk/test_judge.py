# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Stretches and monitor in turns judge as the monitor alone does, whatever the inputs do."""

import dataclasses
import math

from ballscrew_monitor.core.advice import advise
from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.estimate import MachinePoint
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.core.remembered import NAMES, recall
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.recordings.bulk.entries import entries_of, joined, Kind, made, TICK_SOURCE
from ballscrew_monitor.recordings.bulk.judge import AxisJudge
from ballscrew_monitor.recordings.columns import COLUMNS, JudgedColumns
from ballscrew_monitor.recordings.columns import joined as joined_columns
from ballscrew_monitor.recordings.rows import RowCollector
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis, settings_of
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest

MS = 1_000_000
BEGIN = 1_700_000_000_000 * MS
VALUES = parameters.defaults(['x']) | {
    'x.temperature.topic': 'oil',
    'x.torque.topic': 'joint_states',
    'x.publish_period': 0.05,
    'x.limits.raise_delay': 0.03,
    'x.limits.clear_delay': 0.02,
    'x.speed.timeout': 0.5,
    'x.load.timeout': 0.5,
    'x.temperature.timeout': 2.0,
}


AXIS = build_axis('x', VALUES)


def axis_of(values):
    """Return the axis with these parameters and a fresh monitor."""
    monitor = Monitor(AXIS.surface, settings_of('x', values, AXIS.surface))
    return dataclasses.replace(AXIS, monitor=monitor)


def edge_speed():
    """Return a speed [rad/s] at which the zone just clears at 1000 N."""
    point = MachinePoint(
        speed=1.0, axial_load=-1000.0, temperature=313.15, direction=Direction.POSITIVE
    )
    return advise(point, AXIS.surface, AXIS.monitor.settings.limits).target_speed


EDGE = edge_speed()
SPEEDS = (0.0, 1.0, -1.0, EDGE, EDGE * (1 - 1e-13), EDGE * (1 - 1e-4), -EDGE, 150.0, 400.0, 1e5)
LOADS = (-1000.0, -1000.0, 1000.0, 0.0, 20.0, -2500.0, 1e4, 1e9)
STEPS = (0, 1, 1, 1, 1, 5, 5, 10, 10, 30, 60, 400, 700, 2000, -3, -700, -4000)


@st.composite
def happenings(draw):
    """Return a list of (source or tick, step [ms], lag of the stamp [ms], value or why)."""
    return draw(
        st.lists(
            st.tuples(
                st.sampled_from((*(3 * [Source.SPEED]), *Source, TICK_SOURCE)),
                st.sampled_from(STEPS),
                st.sampled_from((0, 0, 0, 0, 2, -300, 900)),
                st.integers(0, 12),
            ),
            min_size=1,
            max_size=40,
        )
    )


def value_of(source, choice):
    """Return the value of a sample [SI]."""
    if source is Source.SPEED:
        return SPEEDS[choice % len(SPEEDS)]
    if source is Source.LOAD:
        return LOADS[choice % len(LOADS)]
    return 313.15 + choice if source is Source.TEMPERATURE else 0.1 * choice


def event_of(source, now, lag, choice):
    """Return a sample, now and then a refusal."""
    if choice == 11:
        return Refusal(source=source, why=Why.NOT_A_NUMBER, text='no number', arrival=now)
    if choice == 12:
        joints = OtherJoints('velocity', 'x', ('y',))
        return Refusal(source=source, why=Why.OTHER_JOINTS, joints=joints, arrival=now)
    header = lag != 2
    return InputSample(
        source=source,
        value=value_of(source, choice),
        stamp=now - lag * MS if header else now,
        stamp_source=StampSource.HEADER if header else StampSource.RECEIVE,
        arrival=now,
    )


def told(made_up):
    """Return (event or None for a tick, time [ns]) in order."""
    now, found = BEGIN, []
    for source, step, lag, choice in made_up:
        now += step * MS
        event = None if source == TICK_SOURCE else event_of(source, now, lag, choice)
        found.append((event, now))
    return found


def entries_from(happened):
    """Return what happened as entries."""
    parts = []
    for event, now in happened:
        if event is None:
            columns = dict.fromkeys(('log_time', 'stamp', 'arrival'), now)
            parts.append(made(1, source=TICK_SOURCE, kind=Kind.TICK, **columns))
        else:
            parts.append(entries_of([(event, now, 0, 0)]))
    return joined(parts)


def alone(axis, happened):
    """Return rows and outcome of the monitor alone."""
    collector = RowCollector('x', axis.monitor)
    for event, now in happened:
        if event is None:
            axis.monitor.tick(now)
        else:
            axis.monitor.update(event)
    return [collector.block()] if len(collector) else [], collector.outcome()


def plain(value):
    """Return all that an object holds as plain data."""
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if field.name != 'surface']
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    slots = getattr(value, '__slots__', None)
    if slots or hasattr(value, '__dict__') and not isinstance(value, int):
        return {name: plain(getattr(value, name)) for name in slots or vars(value)}
    if hasattr(value, '__iter__') and not isinstance(value, str):
        return dict(enumerate(map(plain, value)))
    return value


def assert_near(found, expected, where=''):
    """Compare plain data, numbers to rounding."""
    if isinstance(expected, dict):
        assert found.keys() == expected.keys(), where
        for key in expected:
            assert_near(found[key], expected[key], f'{where}.{key}')
    elif isinstance(expected, float) and not math.isnan(expected):
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-15), where
    else:
        np.testing.assert_equal(found, expected, where)


def assert_same(blocks, expected):
    """Compare columns: codes and stamps are equal, numbers agree to rounding."""
    assert bool(blocks) == bool(expected)
    if not blocks:
        return
    one, other = joined_columns(blocks), joined_columns(expected)
    for name, kind in COLUMNS.items():
        left, right = getattr(one, name), getattr(other, name)
        if kind is np.float64:
            np.testing.assert_allclose(left, right, rtol=1e-12, atol=0.0, err_msg=name)
        else:
            np.testing.assert_array_equal(left, right, err_msg=name)


def compare(happened, turn, **changes):
    """Judge both ways and compare rows, outcome and memory."""
    values = VALUES | changes
    axis, other = axis_of(values), axis_of(values)
    rows, outcome = alone(other, happened)
    collector = RowCollector('x', axis.monitor)
    judging = AxisJudge(axis, turn=turn)
    assert_same(list(judging.columns(entries_from(happened), collector)), rows)
    assert_near(plain(collector.outcome()), plain(outcome))
    left, right = recall(axis.monitor), recall(other.monitor)
    for name in NAMES:
        assert_near(plain(getattr(left, name)), plain(getattr(right, name)), name)


def states_alone(axis, happened):
    """Return place and state of all that the monitor alone says."""
    found = []
    for at, (event, now) in enumerate(happened):
        state = axis.monitor.tick(now) if event is None else axis.monitor.update(event)
        if state is not None:
            found.append((at, plain(state)))
    return found


def compare_states(happened, turn, **changes):
    """Judge both ways and compare the states."""
    axis, other = axis_of(VALUES | changes), axis_of(VALUES | changes)
    expected = states_alone(other, happened)
    found = AxisJudge(axis, turn=turn).states(entries_from(happened))
    found = [(at, plain(state)) for at, state in found]
    assert [at for at, _ in found] == [at for at, _ in expected]
    for (_, left), (at, right) in zip(found, expected, strict=True):
        assert_near(left, right, f'state {at}')


EXAMPLES = {
    'made_up': happenings(),
    'turn': st.sampled_from((1, 3, 256)),
    'delay': st.sampled_from((0.0, 0.03)),
    'period': st.sampled_from((0.0, 0.05)),
}


def changed(delay, period):
    """Return parameters with these delays and period [s]."""
    limits = dict.fromkeys(('x.limits.raise_delay', 'x.limits.clear_delay'), delay)
    return {**limits, 'x.publish_period': period}


@settings(max_examples=60)
@given(**EXAMPLES)
def test_rows_agree_whatever_happens(made_up, turn, delay, period):
    compare(told(made_up), turn, **changed(delay, period))


@settings(max_examples=30)
@given(**EXAMPLES)
def test_states_agree_whatever_happens(made_up, turn, delay, period):
    compare_states(told(made_up), turn, **changed(delay, period))


@settings(max_examples=30)
@given(**EXAMPLES)
def test_rows_and_states_at_once_are_those_of_each(made_up, turn, delay, period):
    entries = entries_from(told(made_up))
    for_rows, for_states, for_both = (axis_of(VALUES | changed(delay, period)) for _ in range(3))
    rows, both = (RowCollector('x', axis.monitor) for axis in (for_rows, for_both))
    wanted = [*AxisJudge(for_rows, turn=turn).columns(entries, rows)]
    states = [(at, plain(state)) for at, state in AxisJudge(for_states, turn=turn).states(entries)]
    found, found_states = [], []
    for part in AxisJudge(for_both, turn=turn).both(entries, both):
        if isinstance(part, JudgedColumns):
            found.append(part)
        else:
            found_states.append((part[0], plain(part[1])))
    assert repr(found_states) == repr(states)
    assert repr(plain(both.outcome())) == repr(plain(rows.outcome()))
    for one, other in zip(found, wanted, strict=True):
        for name in COLUMNS:
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
