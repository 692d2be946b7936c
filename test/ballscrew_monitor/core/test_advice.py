# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The nearest speed that clears a warning, where the process leaves the speed free."""

import dataclasses
import math
from pathlib import Path
import re

from ballscrew_monitor.core.advice import advised_speed, speed_advice
from ballscrew_monitor.core.conversions import Direction, opposing_load
from ballscrew_monitor.core.judgement import efficiency_to_clear, rcs_to_clear
from ballscrew_monitor.health.records import Cell, Condition, Health
from ballscrew_monitor.health.remedies import remedy_text
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.messages.state_messages import out_of_zone_message, USUAL
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
SHIPPED = [Surface.load(path) for path in sorted(shipped_surface().parent.glob('*.npz'))]
GOLDEN = Path(__file__).parents[2] / 'golden' / 'data'
TOLD = re.compile(r'(?:advice|remedy|What to do)["\']?\s*[:=]\s*(\S.*)', re.IGNORECASE)
LOAD_OR_SIGN = re.compile(r'\d\s*k?N\b|\bloads? (of|with)\b|[-+\u2212]\s*\d')
SPEED = re.compile(r'rev/min|rad/s|m/min|m/s')


def advise(point, surface, limits):
    place = {name: getattr(point, name) for name in ('speed', 'axial_load', 'temperature')}
    return advised_speed(surface, limits, **place, direction=Direction(point.direction))


def faster_is_better(speed, load):
    return 1.0 if speed < 30.0 else 0.0


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_border_is_found_from_its_optimal_side_and_the_direction_is_kept(core, sign):
    point = core.point(speed=sign * 5.0, axial_load=-sign * 1000.0)
    found = advise(point, core.surface(rcs=faster_is_better), core.limits())
    assert sign * found == pytest.approx(30.0, rel=1e-5)
    assert sign * found >= 30.0


def test_the_nearer_of_two_borders_wins(core):
    surface = core.surface(rcs=lambda speed, load: 0.0 if speed < 8.0 or speed > 50.0 else 1.0)
    found = advise(core.point(speed=10.0), surface, core.limits())
    assert found == pytest.approx(8.0)
    made = advise(core.point(speed=45.0), surface, core.limits())
    assert made == pytest.approx(50.0)


@pytest.mark.parametrize(
    ('speed', 'rcs'),
    [
        (10.0, 1.0),  # no speed helps
        (10.0, lambda speed, load: 1.0 if speed >= 0.5 else 0.0),  # one below standstill
        (5.0, lambda speed, load: 1.0 if speed < 30.0 else 0.2),  # the limit is only met
    ],
)
def test_a_speed_that_is_no_advice(core, speed, rcs):
    found = advise(core.point(speed=speed), core.surface(rcs=rcs), core.limits())
    assert math.isnan(found)


def test_under_a_light_load_the_efficiency_counts_for_nothing(core):
    surface, limits = core.surface(rcs=faster_is_better, efficiency=0.5), core.limits()
    heavy, light = (advise(core.point(5.0, -load), surface, limits) for load in (300.0, 200.0))
    assert math.isnan(heavy)
    assert light == pytest.approx(30.0, rel=1e-5)


def test_advice_is_a_sentence_without_a_sign(core, says):
    assert speed_advice(math.nan) == ''
    surface = core.surface(rcs=faster_is_better)
    for speed in (5.0, -5.0):
        advice = advise(core.point(speed=speed), surface, core.limits())
        assert math.copysign(1.0, advice) == math.copysign(1.0, speed)
        assert speed_advice(advice) == says('run_at')


def test_no_speed_is_advised_unless_the_process_leaves_it_free(core):
    surface = core.surface(rcs=faster_is_better)
    point, monitor = core.point(speed=5.0), core.monitor(surface, core.limits())
    memory = monitor.memory
    memory.event_number, memory.event_direction[0] = 1, point.direction
    memory.event_speed[0], memory.event_load[0] = point.speed, point.axial_load
    memory.event_temperature[0] = point.temperature
    assert math.isnan(monitor.target_speed)
    assert surface.asked == []  # nor is one looked for


def health_of(point, surface, limits, *, free, usual):
    """Return the health of an axis that runs at a point alone."""
    programme = Cell(
        start=20_000 * DAY,
        first_day=20_000,
        speed_band=1,
        direction=1 if point.speed > 0 else -1,
        stretches=9,
        duration=3600.0,
        speed=point.speed,
        axial_load=point.axial_load,
        temperature=point.temperature,
        motor_torque=0.1,
    )
    remedy = remedy_text([programme], surface, limits, speed_allowed=free)
    advice = '' if usual else remedy
    known = {'condition': Condition.NORMAL, 'verdict': 'normal'}
    return Health(axis='x', stamp=0, advice=advice, usual=usual, **known)


@given(
    surface=st.sampled_from(SHIPPED),
    speed=st.floats(-400.0, 400.0),
    load=st.floats(-7000.0, 7000.0),
    temperature=st.floats(280.0, 360.0),
    rcs=st.floats(1e-4, 0.5),
    efficiency=st.sampled_from([0.5, 0.85, 0.95]),
    free=st.booleans(),
    usual=st.sampled_from([None, False, True]),
)
def test_no_advice_names_a_load_or_a_sign(
    core, surface, speed, load, temperature, rcs, efficiency, free, usual
):
    """Neither in words nor in the message, anywhere on each surface and beyond it."""
    point = core.point(speed=speed, axial_load=load, temperature=temperature)
    limits = core.limits(rcs=rcs, efficiency=efficiency)
    monitor = core.monitor(surface, limits, speed_allowed=free)
    memory = monitor.memory
    memory.event_number, memory.event_active, memory.event_direction[0] = 1, True, point.direction
    memory.event_speed[0], memory.event_load[0] = speed, load
    memory.event_temperature[0] = temperature
    health = usual is not None and health_of(point, surface, limits, free=free, usual=usual)
    message = out_of_zone_message(monitor, shelved=False, health=health or None)
    assert math.isnan(message.cause.target_load)
    assert not LOAD_OR_SIGN.search(message.advice)
    named = math.isfinite(message.cause.target_speed)
    assert free or not SPEED.search(message.advice) and not named
    workshop, run_at = health.advice if health else '', speed_advice(monitor.target_speed)
    assert bool(run_at) is named
    assert not run_at or re.fullmatch(r'at this load run at [\d.]+ rev/min', run_at)
    helpful = '; or '.join(filter(None, [workshop, run_at]))
    assert message.advice == (helpful or (USUAL if usual else ''))


def test_no_advice_of_a_scenario_names_a_load_or_a_sign():
    """Of all golden outputs: messages, logs, pages and words of scenarios and recordings."""
    texts = [file.read_text(encoding='utf-8') for file in sorted(GOLDEN.rglob('*.txt'))]
    told = [words for text in texts for words in TOLD.findall(text)]
    assert sum('would with' in words for words in told) > 10
    assert [words for words in told if LOAD_OR_SIGN.search(words)] == []


def test_a_sign_a_load_and_a_speed_are_found_by_the_property():
    for words in ('run at -1.48 m/min', 'at this speed load with 5850 N', 'a load of 3 kN'):
        assert LOAD_OR_SIGN.search(words)
    assert SPEED.search('feeds of 1.5 m/min and more')


def test_an_optimal_point_is_its_own_advice(core):
    point = core.point(speed=7.0, axial_load=-600.0)
    assert advise(point, core.surface(), core.limits()) == 7.0


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(
    ('name', 'sensitive'),
    [
        ('rcs', lambda speed, load: 2.0**-speed),
        ('efficiency', lambda speed, load: 1.0 - 0.5**speed),
    ],
)
def test_who_follows_the_advice_clears_the_warning(core, sign, name, sensitive):
    surface, limits = core.surface(**{name: sensitive}), core.limits(light_load=1.0)
    load = sign * (2000.0 if name == 'rcs' else 1000.0)
    point = core.point(speed=sign * 1.5, axial_load=load)
    advice = advise(point, surface, limits)
    there = dataclasses.replace(point, speed=advice)
    numbers = surface.lookup(
        abs(there.speed), opposing_load(load, Direction(there.direction)), there.temperature
    )
    assert numbers.rcs < rcs_to_clear(limits)
    assert numbers.efficiency >= efficiency_to_clear(limits)
