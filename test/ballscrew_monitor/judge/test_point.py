# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The operating point with a load out of the motor torque."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import direction_of, machine_nut, SECOND, signed
from ballscrew_monitor.core.inputs import InputSample, InputState, Refusal, Source, Why
from ballscrew_monitor.core.judgement import (
    ContactState,
    DOMINANT_RCS,
    PointSource,
    PointValidity,
    Zone,
)
from ballscrew_monitor.core.state import LoadDerivation
from ballscrew_monitor.judge.point import set_answer
from ballscrew_monitor.judge.records import Settings, STANDSTILL
from ballscrew_monitor.messages.unjudged import point_or_reason
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import FILM_RATIO_LIMITS, regime_of, shipped_surface, Surface

STEP, TIMEOUT = SECOND // 100, SECOND // 2
START = 1000 * SECOND
STANDS = 'the screw stands still, friction may hold any part of the load'
WINDOW = SECOND // 20
INERTIA = 1.0 / 1024.0  # [kg m2]
SETTINGS = LoadDerivation(
    inertia=0.0, window=WINDOW, torque_uncertainty=0.125, parts_uncertainty=0.25, largest_share=0.5
)


def straight(core, **numbers):
    """Return a surface of 1/1024 N m a newton and 0.125 N m of friction."""
    surface = core.surface(driving_torque=lambda speed, load: load / 1024.0 + 0.125, **numbers)
    surface.lead = math.tau / 1024.0
    return surface


def derived(core, surface=None, limits=None, **changes):
    """Return a monitor that has speed and torque, and no topic of the load."""
    settings = {
        'timeouts': dict.fromkeys((Source.SPEED, Source.TORQUE), TIMEOUT),
        'derivation': dataclasses.replace(SETTINGS, **changes),
    }
    return core.monitor(surface or straight(core), limits, **settings)


def sample(source, value, stamp=START):
    return InputSample(source=source, value=value, stamp=stamp)


def run(core, monitor, speed, torque, stamp=START):
    inputs = ((Source.TORQUE, torque), (Source.SPEED, speed))
    (state,) = core.feed(monitor, [sample(source, value, stamp) for source, value in inputs])
    return state


def test_the_load_and_its_input_are_derived_and_marked(core):
    state = run(core, derived(core), 10.0, 1.125)
    assert state.axial_load == pytest.approx(-1024.0)
    assert state.axial_load_source == PointSource.DERIVED
    assert state.axial_load_uncertainty == pytest.approx(128.0)
    assert state.validity == PointValidity.VALID
    assert (state.zone, state.judged) == (Zone.OPTIMAL, 1)
    assert state.message.measured_torque == 1.125
    assert math.isnan(state.message.torque_residual)
    states = {health.source: health.state for health in run(core, derived(core), 10.0, 1.0).inputs}
    assert states[Source.LOAD] is InputState.DERIVED
    assert states[Source.TORQUE] is InputState.OK


def test_a_load_of_a_topic_has_no_uncertainty(core):
    monitor = core.monitor()
    monitor.update(sample(Source.LOAD, -1000.0))
    point = core.feed(monitor, [sample(Source.SPEED, 10.0)])[-1]
    assert math.isnan(point.axial_load_uncertainty)


def test_a_finding_says_that_the_load_is_derived(core, says):
    surface = straight(core, efficiency=0.5)
    finding = run(core, derived(core, surface), 10.0, 1.125).message.findings[0]
    assert finding.text == says('too_much_power')
    monitor = core.monitor(surface)
    monitor.update(sample(Source.LOAD, -1000.0))
    measured = core.feed(monitor, [sample(Source.SPEED, 10.0)])[-1].message.findings[0]
    assert measured.text == says('too_much')


def test_before_the_torque_arrives_nothing_can_be_judged(core):
    state = core.feed(derived(core), [sample(Source.SPEED, 10.0)])[-1]
    assert state.validity == PointValidity.NO_INPUT
    assert state.message.result.reason == 'no valid sample of torque'
    assert (state.axial_load_source, state.judged) == (PointSource.UNKNOWN, 0)


def test_a_stale_torque_makes_the_load_stale(core):
    monitor = derived(core)
    run(core, monitor, 10.0, 1.125)
    good = core.feed(monitor, [sample(Source.SPEED, 10.0, START + TIMEOUT)])[-1]
    assert good.axial_load_source == PointSource.DERIVED
    stale = core.feed(monitor, [sample(Source.SPEED, 20.0, START + TIMEOUT + 1)])[-1]
    assert stale.axial_load == pytest.approx(-1024.0)
    assert stale.axial_load_source == PointSource.HELD
    assert math.isnan(stale.axial_load_uncertainty)
    assert stale.message.result.reason == 'no valid sample of torque'
    assert math.isnan(stale.message.torque_residual)


def test_a_bad_torque_holds_the_load(core):
    monitor = derived(core)
    run(core, monitor, 10.0, 1.125)
    monitor.update(Refusal(source=Source.TORQUE, why=Why.NOT_A_NUMBER))
    state = core.feed(monitor, [sample(Source.SPEED, 10.0, START + STEP)])[-1]
    assert state.axial_load_source == PointSource.HELD
    assert state.validity == PointValidity.NO_INPUT


def test_at_standstill_friction_hides_the_load(core):
    monitor = derived(core)
    run(core, monitor, 10.0, 1.125)
    state = run(core, monitor, 0.25, 1.125, START + STEP)
    assert math.isnan(state.axial_load)
    assert state.axial_load_source == PointSource.UNKNOWN
    assert (state.validity, state.message.result.reason) == (PointValidity.UNKNOWN, STANDS)
    assert state.gates == STANDSTILL
    assert (state.message.findings, state.judged) == ([], 2)
    assert point_or_reason(monitor, START + STEP) == STANDS


def test_a_load_that_is_not_known_is_not_judged(core):
    surface = straight(core)
    surface.parasitic_torque = 1.0
    monitor = derived(core, surface)
    state = run(core, monitor, 10.0, 1.125)
    assert state.validity == PointValidity.UNKNOWN
    assert state.message.result.reason.startswith('inertia and drag take 1 N m')
    assert (state.zone, state.judged) == (Zone.UNKNOWN, 0)
    assert state.message.findings[0].text == state.message.result.reason
    assert point_or_reason(monitor, START) == state.message.result.reason


@pytest.mark.parametrize(
    ('speed', 'torque', 'validity', 'reason'),
    [
        (10.0, 9.0, PointValidity.LOAD_OUT_OF_RANGE, 'torque_along_motion'),
        (1e3, 1.0, PointValidity.SPEED_ABOVE_RANGE, 'speed_1000_rad'),
    ],
)
def test_outside_the_surface_the_limit_is_named(core, speed, torque, validity, reason, says):
    state = run(core, derived(core), speed, torque)
    assert state.validity == validity
    assert state.message.result.reason.startswith(says(reason))
    assert math.isnan(state.axial_load)


def test_inertia_is_taken_off_while_the_axis_speeds_up(core):
    monitor = derived(core, inertia=INERTIA)
    first = run(core, monitor, 10.0, 1.125)
    assert first.message.result.reason.startswith('the acceleration is not known yet')
    for i in range(1, 30):
        state = run(core, monitor, 10.0 + i, 1.125 + 100.0 * INERTIA, START + i * STEP)
        assert state.axial_load == pytest.approx(-1024.0, rel=1e-9)
    # Half width: torque, and a quarter of what inertia takes.
    assert state.axial_load_uncertainty == pytest.approx(128.0 + 25.0)


def test_a_ramp_that_sets_in_is_within_the_uncertainty(core):
    """From the second sample on: of the first one the speeds know nothing yet."""
    monitor = derived(core, inertia=INERTIA, torque_uncertainty=1e-6, largest_share=1e9)
    for i in range(60):
        speed = 10.0 + 2.0 * max(i - 20, 0)
        torque = 1.125 + (200.0 * INERTIA if i >= 20 else 0.0)
        state = run(core, monitor, speed, torque, START + i * STEP)
        if i not in (0, 20):
            assert abs(state.axial_load + 1024.0) <= state.axial_load_uncertainty


def test_the_filter_of_the_acceleration_follows_a_new_time_line(core):
    monitor = derived(core, inertia=INERTIA)
    for i in range(5):
        run(core, monitor, 10.0 + i, 1.125, START + i * STEP)
    back = run(core, monitor, 50.0, 1.125, START - 10 * SECOND)
    assert back.message.result.reason.startswith('the acceleration is not known yet')
    again = run(core, monitor, 50.0, 1.125, START - 10 * SECOND + STEP)
    assert again.axial_load == pytest.approx(-1024.0)


def test_the_load_of_the_shipped_surface_closes_the_circle(core):
    surface = Surface.load(shipped_surface())
    monitor = derived(core, surface, core.limits(light_load=0.0))
    for speed, force in ((60.0, -1000.0), (60.0, 1000.0), (-60.0, -1000.0), (-60.0, 1000.0)):
        measured = core.monitor(surface)
        measured.update(sample(Source.LOAD, force))
        known = measured.update(sample(Source.SPEED, speed))
        state = run(core, monitor, speed, known.machine_torque)
        assert state.axial_load == pytest.approx(force, rel=1e-9)
        assert state.efficiency == pytest.approx(known.efficiency, rel=1e-9)


def on(*limits):
    """Return numbers, most of them limits or next to one."""
    beside = [math.nextafter(limit, -math.inf) for limit in limits]
    return st.sampled_from([*limits, *beside, math.nan]) | st.floats(0.0, 10.0)


@given(
    on(*FILM_RATIO_LIMITS),
    on(0.25, DOMINANT_RCS),
    st.sampled_from([-1, 0, 1, 2, 3]),
    st.sampled_from([-1000.0, 1000.0, 0.0]),
    st.sampled_from([-10.0, 10.0]),
)
def test_words_follow_the_numbers(core, film_ratio, rcs, contact, axial_load, speed):
    surface = core.surface(
        film_ratio=film_ratio, rcs=rcs, worst_contact=contact, driving_torque=0.5
    )
    row = core.point(speed=speed, axial_load=axial_load)
    set_answer(surface, Settings(rcs=0.25), row)
    assert row.regime == regime_of(film_ratio)
    bands = {ContactState.NONE: rcs < 0.25, ContactState.PARTIAL: 0.25 <= rcs < DOMINANT_RCS}
    bands |= {ContactState.DOMINANT: rcs >= DOMINANT_RCS, ContactState.UNKNOWN: math.isnan(rcs)}
    assert [state for state, inside in bands.items() if inside] == [row.contact_state]
    assert row.machine_nut == machine_nut(contact // 2 + 1, axial_load)
    assert row.machine_torque == signed(0.5, direction_of(speed))
