# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A monitor that was written and read again goes on bit for bit as if nothing had happened."""

import json
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.derived_load import LoadDerivation
from ballscrew_monitor.core.differentiation import PositionSettings
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, Why
from ballscrew_monitor.core.judgement import Level
from ballscrew_monitor.core.snapshot import freeze_monitor, thaw_monitor
from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from surrogate.files import InputError

START = 1000 * SECOND
STEP = SECOND // 100


def is_slow_bad(core):
    """Return a surface that is outside below 20 rad/s."""
    return core.surface(rcs=lambda speed, load: 0.5 if speed < 20.0 else 0.0)


def through_json(monitor):
    text = json.dumps(freeze_monitor(monitor), allow_nan=False)
    return thaw_monitor(json.loads(text), monitor.surface, monitor.settings)


def give(monitor, event):
    """Return what a monitor says of a sample, a refusal, or a tick."""
    return monitor.tick(event) if isinstance(event, int) else monitor.update(event)


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
            made.append(Refusal(source=source, why=why, joints=joints, arrival=now, lost=2))
    return made


DERIVED = {
    'timeouts': dict.fromkeys((Source.SPEED, Source.TORQUE), SECOND // 2),
    'derivation': LoadDerivation(
        inertia=1e-4,
        window=SECOND // 20,
        torque_uncertainty=0.1,
        parts_uncertainty=0.1,
        largest_share=1e9,
    ),
    'positions': PositionSettings(window=SECOND // 20, wrap=math.tau),
}


@settings(max_examples=200)
@given(stream=streams(), derived=st.booleans(), data=st.data())
def test_the_monitor_goes_on_as_if_nothing_had_happened(core, stream, derived, data):
    changes = {'plausible': {Source.SPEED: 1000.0}} | (DERIVED if derived else {})
    surface = is_slow_bad(core)
    surface.numbers['driving_torque'] = lambda speed, load: load / 8.0
    first = core.monitor(surface, core.limits(raise_delay=0), **changes)
    cut = data.draw(st.integers(0, len(stream)))
    for event in stream[:cut]:
        give(first, event)
    second = through_json(first)
    for event in stream[cut:]:
        said, again = give(first, event), give(second, event)
        assert repr(again) == repr(said)
        if said is not None and said.event is not None:
            assert repr(again.event.advice) == repr(said.event.advice)
    assert freeze_monitor(second) == freeze_monitor(first)


def test_a_load_of_the_motor_torque_is_derived_on(core):
    surface = core.surface(driving_torque=lambda speed, load: load / 1024.0)
    first = core.monitor(surface, core.limits(raise_delay=0), **DERIVED)

    def turn(monitor, i):
        stamp = START + i * STEP
        monitor.update(InputSample(source=Source.TORQUE, value=1.0, stamp=stamp))
        angle = math.remainder(0.2 * i + 1e-3 * i**2, math.tau)
        return monitor.update(InputSample(source=Source.SPEED, value=angle, stamp=stamp))

    for i in range(40):
        turn(first, i)
    second = through_json(first)
    said, again = turn(first, 40), turn(second, 40)
    assert said.point.axial_load_source is PointSource.DERIVED
    assert repr(again) == repr(said)


def test_an_event_that_is_on_stays_on_with_its_number_and_totals(core):
    monitor = core.monitor(is_slow_bad(core), core.limits(raise_delay=0))
    for i in range(20):
        monitor.update(InputSample(source=Source.LOAD, value=-1000.0, stamp=START + i * STEP))
        monitor.update(InputSample(source=Source.SPEED, value=10.0, stamp=START + i * STEP))
    again = through_json(monitor)
    assert again.level is Level.WARN
    assert again.event.active
    assert again.event.number == 1
    assert again.current_point(START) == monitor.current_point(START)


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'_hold': 1.0, 'more': 1}, 'another version of the monitor, it differs in more'),
        ({'_hold': {'class': 'Popen', 'parts': {}}}, "no memory of a monitor: 'Popen'"),
        ({'_hold': {'class': 'Hold', 'parts': {'rise': 1}}}, 'no memory of a monitor: .*rise'),
        ({'_hold': {'enum': 'Level', 'value': 9}}, 'no memory of a monitor: 9 is not'),
    ],
)
def test_what_no_monitor_has_written_is_refused(core, change, text):
    monitor = core.monitor()
    with pytest.raises(InputError, match=text):
        thaw_monitor(freeze_monitor(monitor) | change, monitor.surface, monitor.settings)


def test_what_is_not_listed_is_not_written(core):
    monitor = core.monitor()
    monitor.shelving = object()
    with pytest.raises(TypeError, match='object is no part of the memory'):
        freeze_monitor(monitor)


def test_a_recording_with_the_first_name_of_excursions_is_read(core):
    monitor = core.monitor(is_slow_bad(core))
    frozen = freeze_monitor(monitor)
    text = json.dumps(frozen).replace('"Excursions"', '"Stays"')
    assert json.loads(text) != frozen
    again = thaw_monitor(json.loads(text), monitor.surface, monitor.settings)
    assert freeze_monitor(again) == frozen
