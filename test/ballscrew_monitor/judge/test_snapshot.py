# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A monitor that was written and read again goes on bit for bit as if nothing had happened."""

import hashlib
import json
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, Why
from ballscrew_monitor.core.judgement import EventEnd
from ballscrew_monitor.core.state import Ending, LoadDerivation, Shelving
from ballscrew_monitor.judge.records import Memory, MEMORY_LAYOUT
from ballscrew_monitor.judge.slopes import SlopeRing
from ballscrew_monitor.judge.snapshot import restored, snapshot
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import InputError
from surrogate.surface.records import dtype_of

START = 1000 * SECOND
STEP = SECOND // 100
DERIVED = {
    'timeouts': dict.fromkeys((Source.SPEED, Source.TORQUE), SECOND // 2),
    'derivation': LoadDerivation(
        inertia=1e-4,
        window=SECOND // 20,
        torque_uncertainty=0.1,
        parts_uncertainty=0.1,
        largest_share=1e9,
    ),
    'position_window': SECOND // 20,
    'wrap': math.tau,
}


def test_another_layout_of_the_memory_is_another_version():
    layout = repr([dtype_of(kind).descr for kind in (Memory, SlopeRing)])
    assert hashlib.sha256(layout.encode()).hexdigest().startswith(MEMORY_LAYOUT), (
        'raise MEMORY_VERSION and renew MEMORY_LAYOUT: older recordings are then not misread'
    )


def through_json(monitor):
    text = json.dumps(snapshot(monitor), allow_nan=False)
    return restored(json.loads(text), monitor.surface, monitor.settings)


@st.composite
def streams(draw):
    """Return samples, refusals and ticks as they may come, in an order that may be wrong."""
    made, now = [], START
    for _ in range(draw(st.integers(2, 50))):
        now += draw(st.sampled_from([STEP, STEP, SECOND // 3, -2 * SECOND]))
        source = draw(st.sampled_from([Source.SPEED, Source.SPEED, Source.LOAD, Source.TORQUE]))
        kind = draw(st.sampled_from(['sample'] * 6 + ['tick', 'other', 'refused']))
        if kind == 'tick':
            made.append(now)
        elif kind == 'sample':
            value = draw(st.sampled_from([10.0, 30.0, -10.0, 0.1, 300.0, math.nan, 1e9]))
            late = draw(st.sampled_from([0, SECOND]))
            made.append(
                InputSample(source=source, value=value, stamp=now, arrival=now + late, lost=None)
            )
        else:
            joints = OtherJoints('velocity', 'x_axis', ('a', 'b'))
            why = Why.OTHER_JOINTS if kind == 'other' else Why.NOT_A_NUMBER
            made.append(
                Refusal(
                    source=source, why=why, first=float(now), joints=joints, arrival=now, lost=2
                )
            )
    return made


@given(streams(), st.booleans(), st.data())
def test_the_monitor_goes_on_as_if_nothing_had_happened(core, stream, derived, data):
    surface = core.surface(rcs=lambda speed, load: 0.5 if speed < 20.0 else 0.0)
    changes = {'plausible': {Source.SPEED: 1000.0}} | (DERIVED if derived else {})
    first = core.monitor(surface, core.limits(raise_delay=0), **changes)
    first.shelving = Shelving(until=START, reason='known')
    cut = data.draw(st.integers(0, len(stream)))
    core.feed(first, stream[:cut])
    if data.draw(st.booleans()):
        first.acknowledge(START, Ending(kind=EventEnd.STOPPED, reason='seen'))
    second = through_json(first)
    assert second.kept(START) == first.kept(START)
    for event in stream[cut:]:
        said, again = core.feed(first, [event]), core.feed(second, [event])
        assert repr([state.message for state in again]) == repr([state.message for state in said])
        if any(state.event for state in said):
            assert repr(second.target_speed) == repr(first.target_speed)
    assert snapshot(second) == snapshot(first)


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'records': {}}, 'memory_damaged_memory'),
        ({'records': {'memory': 'AAAA'}}, 'memory_damaged_buffer'),
        ({'records': {'memory': ''}}, 'memory_damaged_2'),
        ({'records': {'memory': '~'}}, 'memory_damaged_2'),
        ({'records': {'memory': 1}}, 'memory_damaged_2'),
        ({'records': 1}, 'memory_damaged_2'),
        ({'joints': {'HEIGHT': []}}, 'memory_damaged_height'),
        ({'joints': {'LOAD': [['velocity']]}}, 'memory_damaged_enough'),
        ({'joints': None}, 'memory_damaged_2'),
    ],
)
def test_what_no_monitor_has_remembered_is_refused(core, change, text, refused):
    monitor = core.monitor()
    refused(text, restored, snapshot(monitor) | change, monitor.surface, monitor.settings)


def test_a_snapshot_that_lacks_a_part_is_refused(core, refused):
    monitor = core.monitor()
    whole = snapshot(monitor)
    for name in whole:
        refused(
            'memory_2',
            restored,
            {key: value for key, value in whole.items() if key != name},
            monitor.surface,
            monitor.settings,
        )


def test_a_sign_that_no_snapshot_has_is_damage(core, refused):
    monitor = core.monitor()
    whole = snapshot(monitor)
    whole['records']['memory'] = '~' + whole['records']['memory']
    refused('memory_damaged_2', restored, whole, monitor.surface, monitor.settings)


@pytest.mark.parametrize(
    ('name', 'number'),
    [('level', 3), ('direction', -1), ('moment_regime', 4), ('moment_zone', 3), ('refusal', 99)],
)
def test_a_number_that_no_judgement_has_is_damage(core, name, number, refused):
    monitor = core.monitor(core.surface())
    value = getattr(monitor.memory, name)
    if isinstance(value, list):
        value[-1] = number
    else:
        setattr(monitor.memory, name, number)
    refused('memory_damaged', restored, snapshot(monitor), core.surface(), monitor.settings)


@pytest.mark.parametrize('name', ['speeds', 'positions'])
@pytest.mark.parametrize(
    ('count', 'begin', 'damaged'),
    [(512, 511, False), (513, 0, True), (-1, 0, True), (1, 512, True), (1, -1, True)],
)
def test_a_window_beyond_its_ring_is_damage(core, name, count, begin, damaged, says):
    monitor = core.monitor(core.surface())
    setattr(monitor, name, SlopeRing(count=count, begin=begin))
    if damaged:
        with pytest.raises(InputError) as caught:
            restored(snapshot(monitor), core.surface(), monitor.settings)
        assert str(caught.value) == says('window_of_samples', count=count, begin=begin)
    else:
        again = restored(snapshot(monitor), core.surface(), monitor.settings)
        assert getattr(again, name) == getattr(monitor, name)
