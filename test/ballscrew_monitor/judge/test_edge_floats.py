# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""No float that a message may contain ends the judgement."""

import itertools
import math
import sys

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.state import LoadDerivation
from ballscrew_monitor.judge.views import refused_of
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
STEP = SECOND // 100
TINY, SMALL, HUGE = 5e-324, sys.float_info.min, sys.float_info.max
EDGES = [
    sign * size
    for size in (0.0, TINY, 2e-320, SMALL, 1e-200, 30.0, 1e154, 1e308, HUGE, math.inf)
    for sign in (1.0, -1.0)
] + [math.nan]
USUAL = {Source.TEMPERATURE: 313.15, Source.LOAD: -1000.0, Source.TORQUE: 3.0, Source.SPEED: 60.0}
LIMITS = {'rcs': 0.01, 'efficiency': 0.85, 'light_load': 250.0, 'raise_delay': SECOND // 10}
DERIVATION = LoadDerivation(
    inertia=1e-3,
    window=SECOND // 20,
    torque_uncertainty=0.1,
    parts_uncertainty=0.1,
    largest_share=0.5,
)
WAYS = {
    'measured': {},
    'torque': {'derivation': DERIVATION},
    'position': {'position_window': SECOND // 20},
    'angle': {'position_window': SECOND // 20, 'wrap': 2 * math.pi},
}


@pytest.fixture(scope='module')
def make_monitor(core):
    def make(way, plausible=math.inf):
        timeouts = dict.fromkeys(Source, SECOND // 2)
        changes = {'timeouts': timeouts, 'plausible': {Source.SPEED: plausible}}
        limits = core.limits(**LIMITS, hysteresis=0.1)
        return core.monitor(SURFACE, limits, **changes, **WAYS[way])

    return make


def feed(monitor, *readings):
    """Return the last row of a state after readings, each a value for every input."""
    row = None
    for number, reading in enumerate(readings, 1):
        for source in Source:
            sample = InputSample(source=source, value=reading[source], stamp=number * STEP)
            row = monitor.update(sample) or row
    return monitor.tick((len(readings) + 100) * STEP) or row


@pytest.mark.parametrize('way', WAYS)
@pytest.mark.parametrize('source', list(Source))
def test_each_edge_of_each_input_is_judged_or_refused(make_monitor, way, source):
    for value in EDGES:
        monitor = make_monitor(way)
        odd = USUAL | {source: value}
        assert feed(monitor, USUAL, odd, odd, USUAL).stamp > 0
        refused = sum(refused_of(monitor.memory)[source].values())
        assert (refused == 2) is not math.isfinite(value), value


@given(
    st.sampled_from(list(WAYS)),
    st.lists(
        st.fixed_dictionaries(dict.fromkeys(Source, st.sampled_from(EDGES) | st.floats())),
        min_size=1,
        max_size=6,
    ),
    st.sampled_from([math.inf, HUGE, 700.0]),
)
def test_no_course_of_floats_ends_the_judgement(make_monitor, way, readings, plausible):
    monitor = make_monitor(way, plausible)
    feed(monitor, *readings)
    assert not math.isnan(monitor.memory.angle)


@pytest.mark.parametrize('way', ['position', 'angle'])
def test_positions_that_leap_further_than_a_float_reaches(make_monitor, way):
    leaps = [USUAL | {Source.SPEED: value} for value in (HUGE, -HUGE, HUGE, 0.0, 0.3)]
    for plausible, judges in ((math.inf, False), (700.0, True)):
        monitor = make_monitor(way, plausible)
        feed(monitor, *leaps)
        assert (monitor.memory.judged > 0) is judges


@pytest.mark.parametrize('load', [TINY, 2e-320, 1e-322, 0.0])
def test_a_load_of_almost_nothing_is_judged_as_none(make_monitor, load):
    """Its ideal torque underflows: the efficiency is that at zero load, in both directions."""
    for sign, speed in itertools.product((1.0, -1.0), (60.0, -60.0)):
        monitor = make_monitor('measured')
        monitor.update(InputSample(source=Source.LOAD, value=sign * load, stamp=STEP))
        monitor.update(InputSample(source=Source.TEMPERATURE, value=313.15, stamp=STEP))
        row = monitor.update(InputSample(source=Source.SPEED, value=speed, stamp=STEP))
        assert row.efficiency == 0.0
        assert math.isnan(row.efficiency_error)
