# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The levels of many rows are those that are held from row to row."""

from ballscrew_monitor.core.judgement import Hold, hold, Level, Limits, Verdict, Zone
from ballscrew_monitor.recordings.bulk.levels import held_levels, Sign
from hypothesis import given
from hypothesis import strategies as st
import numpy as np

VERDICTS = {
    Sign.NONE: Verdict(zone=Zone.UNKNOWN),
    Sign.OPTIMAL: Verdict(zone=Zone.OPTIMAL),
    Sign.CLEAR: Verdict(zone=Zone.OPTIMAL, clear=True),
    Sign.OUTSIDE: Verdict(zone=Zone.OUTSIDE),
}
MAX_GAP = 5


def limits_of(raise_delay, clear_delay):
    """Return limits with delays [ns]."""
    return Limits(
        rcs=0.01,
        efficiency=0.85,
        light_load=1.0,
        standstill_speed=0.5,
        raise_delay=raise_delay,
        clear_delay=clear_delay,
        hysteresis=0.1,
    )


def one_by_one(rows, memory, limits):
    """Return the memory after each row."""
    found = []
    for stamp, sign, period in rows:
        gaps = {'max_gap': MAX_GAP, 'period': period}
        memory = hold(memory, VERDICTS[sign], stamp, limits, **gaps)
        found.append(memory)
    return found


@given(
    steps=st.lists(
        st.tuples(
            st.sampled_from((0, 1, 1, 2, 3, 5, 6, 9, -1)),
            st.sampled_from((*Sign, Sign.OUTSIDE, Sign.CLEAR)),
            st.sampled_from((0, 0, 0, 9)),
        ),
        max_size=60,
    ),
    cuts=st.lists(st.integers(0, 60), max_size=3),
    raise_delay=st.sampled_from((0, 1, 4, 8)),
    clear_delay=st.sampled_from((0, 2, 7)),
)
def test_levels_are_those_from_row_to_row(steps, cuts, raise_delay, clear_delay):
    stamps = (1000 + np.cumsum([step for step, _, _ in steps], dtype=int)).tolist()
    rows = [(stamp, sign, period) for stamp, (_, sign, period) in zip(stamps, steps)]
    limits = limits_of(raise_delay, clear_delay)
    expected = one_by_one(rows, Hold(), limits)
    memory, found = Hold(), []
    bounds = sorted({0, len(rows), *(min(cut, len(rows)) for cut in cuts)})
    for begin, end in zip(bounds, bounds[1:]):
        stamp, sign, period = (np.array(part) for part in zip(*rows[begin:end]))
        made = held_levels(stamp, sign.astype(np.uint8), period, memory, limits, max_gap=MAX_GAP)
        found += made.level.tolist()
        memory = made.memory
        assert memory == expected[end - 1]
        changed = [begin + row for row, _ in made.changes]
        before = [Level.UNKNOWN, *(each.level for each in expected)]
        assert changed == [
            row for row in range(begin, end) if expected[row].level is not before[row]
        ]
    assert found == [each.level for each in expected]


def test_no_rows_change_nothing():
    nothing = np.empty(0, dtype=np.int64)
    memory = Hold(level=Level.OK, since=3)
    made = held_levels(
        nothing, nothing.astype(np.uint8), nothing, memory, limits_of(1, 1), max_gap=1
    )
    assert made.memory == memory
    assert not made.changes
