# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The freeze frame: bounded, thinned out, and true at the event itself."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.records import EVENT_BEGINS, Row
from ballscrew_monitor.node.freeze_frame import FreezeFrame, QUANTITIES, SPAN, STEP
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from surrogate.surface.records import as_array, dtype_of

START = 1000 * SECOND


def row_at(stamp, speed=1.0, **changes):
    row = Row()
    values = {'axial_load': -500.0, 'temperature': 313.15, 'efficiency': 0.9, 'rcs': 0.01}
    for name, value in {'stamp': stamp, 'speed': speed, **values, **changes}.items():
        setattr(row, name, value)
    return row


def test_without_a_row_it_is_empty():
    frame = FreezeFrame()
    frame.take(None)
    frame.take(row_at(START, tick=True))
    assert frame.facts(START) == {'time_s': [], **{name: [] for name in QUANTITIES}}


def test_a_row_has_its_units_and_six_digits():
    frame = FreezeFrame()
    frame.take(row_at(START, speed=1.0 / 3.0, motor_torque=2.5))
    found = frame.facts(START + SECOND // 4)
    assert found == {
        'time_s': [-0.25],
        'speed_rad_s': [0.333333],
        'axial_load_N': [-500.0],
        'temperature_degC': [40.0],
        'efficiency': [0.9],
        'rcs': [0.01],
        'motor_torque_Nm': [2.5],
    }
    frame.take(row_at(START + STEP, efficiency=math.nan))
    assert math.isnan(frame.facts(START + STEP)['efficiency'][-1])


def test_the_row_of_the_event_is_there_however_soon_it_comes():
    frame = FreezeFrame()
    for stamp, edge in ((START, 0), (START + 1, 0), (START + 2, EVENT_BEGINS)):
        frame.take(row_at(stamp, speed=float(stamp - START), edge=edge))
    assert frame.facts(START + 2)['speed_rad_s'] == [0.0, 2.0]


def test_a_clock_that_is_set_back_begins_again():
    frame = FreezeFrame()
    for stamp in (START, START + SECOND, START - SECOND):
        frame.take(row_at(stamp))
    assert frame.facts(START + SECOND)['time_s'] == [-2.0]


@given(
    st.lists(st.integers(0, 2 * SECOND), min_size=1, max_size=400),
    st.sets(st.integers(0, 399), max_size=5),
)
def test_it_is_bounded_and_reaches_back_no_further_than_its_span(gaps, edges):
    frame, stamp, taken = FreezeFrame(), START, []
    for at, gap in enumerate(gaps):
        stamp += gap
        frame.take(row_at(stamp, speed=float(at), edge=EVENT_BEGINS if at in edges else 0))
        taken.append(stamp)
    found = frame.facts(stamp)
    times = found['time_s']
    assert {len(values) for values in found.values()} == {len(times)}
    assert 1 <= len(times) <= SPAN // STEP + 1
    assert times == sorted(times)
    assert -SPAN / SECOND <= times[0] <= times[-1] <= 0.0
    # Nothing that was taken is further than a step from what is kept, but beyond the bound.
    if len(times) <= SPAN // STEP - len(edges):
        kept = [stamp + round(time * SECOND) for time in times]
        for one in taken:
            if 0 <= stamp - one <= SPAN - STEP:
                assert min(abs(one - other) for other in kept) <= STEP + SECOND // 1000


@given(
    st.lists(
        st.tuples(
            st.sampled_from([0, 1, STEP // 3, STEP, SPAN, -1, -SECOND]),
            st.sampled_from([0] * 5 + [EVENT_BEGINS]),
            st.sampled_from([False] * 5 + [True]),
        ),
        max_size=30,
    ),
    st.integers(0, 30),
)
def test_an_array_of_rows_is_taken_as_they_are_one_by_one(steps, begin):
    one, other, rows, stamp = FreezeFrame(), FreezeFrame(), [], START
    for step, edge, tick in steps:
        stamp += step
        rows.append(row_at(stamp, speed=float(len(rows)), edge=edge, tick=tick))
    arrays = np.concatenate([np.empty(0, dtype_of(Row)), *map(as_array, rows)])
    for row in rows:
        one.take(row)
    other.take_many(arrays[:begin])
    other.take_many(arrays[begin:])
    assert repr(other.facts(stamp)) == repr(one.facts(stamp))
