# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The ring of rows against a plain list."""

from ballscrew_monitor.page.history import History, LARGEST, SPAN, STEP
from hypothesis import given
from hypothesis import strategies as st
import numpy as np

STEPS = st.lists(
    st.tuples(st.sampled_from([-1.0, 0.0, 0.25 * STEP, STEP, 7.0, 0.4 * SPAN]), st.booleans()),
    max_size=60,
)


def kept(rows):
    """Return the rows that a history keeps of some, in the plainest way."""
    found = []
    for one in rows:
        if found and one[0] < found[-1][0]:
            found = []
        if not found or one[0] - found[-1][0] >= 0.9 * STEP or one[-1] != found[-1][-1]:
            found.append(one)
    return [one for one in found if one[0] >= found[-1][0] - SPAN]


@given(STEPS)
def test_rows_are_those_of_a_list(page_parts, steps):
    rows, stamp = [], 1e9
    for step, warns in steps:
        stamp += step
        rows.append(page_parts.row(stamp, level=2.0 if warns else 1.0))
    history = History()
    for one in rows:
        history.take(one)
    assert history.since(0).tolist() == kept(rows)


def test_the_ring_goes_round():
    """Its size is for the span; the parts since a count add up to the whole."""
    history = History()
    for number in range(LARGEST + 10):
        history.take([number * STEP, *[0.0] * 8, 1.0])
    rows = history.since(0)
    assert len(rows) == LARGEST
    assert rows[0, 0] == 10 * STEP
    assert np.all(np.diff(rows[:, 0]) > 0.0)
    assert history.since(history.count - 3).tolist() == rows[-3:].tolist()
    assert not len(history.since(history.count))
