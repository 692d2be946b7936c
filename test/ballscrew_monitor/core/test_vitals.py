# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Vital signs: extremes since the last look, and a share over a span of time."""

import math

from ballscrew_monitor.core.vitals import BUSY, SPAN, Vitals, VitalSigns
from hypothesis import given
from hypothesis import strategies as st
import pytest


def test_before_the_second_look_the_share_is_unknown_and_nobody_is_busy():
    first = Vitals().look(100.0, 7.0)
    assert (first.loop_time, first.queue_depth) == (0.0, 0)
    assert math.isnan(first.processor_share)
    assert not first.is_busy


def test_a_look_takes_the_extremes_and_begins_again():
    vitals = Vitals()
    for duration, messages in ((0.25, 3), (0.125, 8), (0.0, 1)):
        vitals.work(duration, messages)
    seen = vitals.look(0.0, 0.0)
    assert (seen.loop_time, seen.queue_depth) == (0.25, 8)
    assert vitals.look(1.0, 0.0) == VitalSigns(processor_share=0.0)


@pytest.mark.parametrize(('share', 'busy'), [(BUSY, True), (math.nextafter(BUSY, 0.0), False)])
def test_it_is_busy_from_the_stated_share_on(share, busy):
    assert VitalSigns(processor_share=share).is_busy is busy


@given(
    st.floats(0.0, 2.0),
    st.lists(st.floats(0.1, 60.0), min_size=1, max_size=30),
    st.floats(0.0, 1e6),
)
def test_a_steady_share_is_told_however_often_it_is_looked_at(share, gaps, begin):
    vitals, now = Vitals(), begin
    vitals.look(now, 5.0)
    for gap in gaps:
        now += gap
        signs = vitals.look(now, 5.0 + share * (now - begin))
    assert signs.processor_share == pytest.approx(share, abs=1e-6)


@given(st.lists(st.floats(0.1, 60.0), min_size=2, max_size=40))
def test_what_is_longer_ago_than_the_span_and_a_look_is_forgotten(gaps):
    """A processor that was used up before, and not since, is forgotten."""
    vitals, now = Vitals(), 0.0
    vitals.look(-1.0, -1.0)
    vitals.look(now, 0.0)
    for gap in gaps:
        now += gap
        signs = vitals.look(now, 0.0)
    if now - gaps[-1] >= SPAN:
        assert signs.processor_share == 0.0
