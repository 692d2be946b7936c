# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Estimates against a surface of constants."""

import math
import re

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.estimate import contact_state_of, ContactState, estimate, PointValidity
from hypothesis import given
from hypothesis import strategies as st
import pytest
import surrogate.surface
from surrogate.surface import Regime

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ('rcs', 'state'),
    [
        (0.0, ContactState.NONE),
        (math.nextafter(0.25, 0.0), ContactState.NONE),
        (0.25, ContactState.PARTIAL),
        (math.nextafter(0.5, 0.0), ContactState.PARTIAL),
        (0.5, ContactState.DOMINANT),
        (1.0, ContactState.DOMINANT),
        (math.nan, ContactState.UNKNOWN),
    ],
)
def test_contact_state_on_its_limits(rcs, state):
    assert contact_state_of(rcs, limit=0.25) is state


@given(st.floats())
def test_bands_are_exhaustive_and_only_nan_is_unknown(value):
    assert (contact_state_of(value, limit=0.25) is ContactState.UNKNOWN) == math.isnan(value)


@given(first=st.floats(0.0, 10.0), second=st.floats(0.0, 10.0))
def test_bands_are_in_order(first, second):
    low, high = sorted((first, second))
    assert contact_state_of(low, limit=0.25) <= contact_state_of(high, limit=0.25)


def test_the_surface_is_asked_in_its_own_frame(core):
    surface = core.surface()
    estimate(core.point(speed=-20.0, axial_load=-300.0), surface, rcs_limit=0.25)
    estimate(core.point(speed=20.0, axial_load=-300.0), surface, rcs_limit=0.25)
    assert surface.asked == [(20.0, -300.0, 313.15), (20.0, 300.0, 313.15)]


def test_a_valid_estimate_carries_the_numbers_and_a_masked_cell_says_so(core):
    result = estimate(core.point(speed=-20.0), core.surface(rcs=0.25), rcs_limit=0.25)
    assert (result.validity, result.reason) == (PointValidity.VALID, '')
    assert (result.rcs, result.efficiency) == (0.25, 0.9)
    assert result.machine_torque == -2.0
    assert result.worst_nut is Nut.NEGATIVE
    assert (result.regime, result.contact_state) == (Regime.HYDRODYNAMIC, ContactState.PARTIAL)
    result = estimate(core.point(), core.surface(validity=PointValidity.MASKED), rcs_limit=0.25)
    assert (result.validity, result.numbers) == (PointValidity.MASKED, None)
    assert 'did not converge' in result.reason


@pytest.mark.parametrize(
    ('changes', 'validity', 'reason'),
    [
        ({'speed': 0.05}, 'SPEED_BELOW_RANGE', 'speed 0.05 rad/s is below .* from 0.1 rad/s'),
        ({'speed': 200.0}, 'SPEED_ABOVE_RANGE', 'speed 200 rad/s is above .* to 100 rad/s'),
        ({'axial_load': 5e3}, 'LOAD_OUT_OF_RANGE', 'opposing load -5000 N .* -4000 to 4000 N'),
        ({'temperature': 373.15}, 'TEMPERATURE_OUT_OF_RANGE', '100 degC .* 10 to 80 degC'),
        ({'direction': Direction.UNKNOWN}, 'UNKNOWN', 'has not moved yet'),
        ({'speed': math.nan}, 'NO_INPUT', 'no valid sample of speed'),
        (
            {'axial_load': math.nan, 'temperature': math.inf},
            'NO_INPUT',
            'no valid sample of load and temperature',
        ),
    ],
)
def test_what_cannot_be_estimated_has_a_reason_and_no_numbers(core, changes, validity, reason):
    result = estimate(core.point(**changes), core.surface(), rcs_limit=0.25)
    assert result.validity is PointValidity[validity]
    assert re.search(reason, result.reason)
    assert result.numbers is None
    assert math.isnan(result.rcs)
    assert math.isnan(result.efficiency)
    assert result.regime is Regime.UNKNOWN
    assert result.contact_state is ContactState.UNKNOWN


@given(
    speed=st.floats(),
    load=st.floats(),
    temperature=st.floats(),
    direction=st.sampled_from(Direction),
)
def test_whatever_the_point_is_there_is_an_answer(core, speed, load, temperature, direction):
    point = core.point(speed=speed, axial_load=load, temperature=temperature, direction=direction)
    result = estimate(point, core.surface(), rcs_limit=0.25)
    assert (result.validity is PointValidity.VALID) == (result.numbers is not None)
    assert (result.validity is PointValidity.VALID) == (result.reason == '')


@given(speed=st.floats(0.5, 90.0), load=st.floats(-3e3, 3e3))
def test_turning_everything_round_changes_nothing_but_the_signs(core, speed, load):
    surface = core.surface(
        rcs=lambda speed, load: 1.0 / speed,
        efficiency=lambda speed, load: abs(load) / 4e3,
        worst_nut=1,
    )
    here, there = (
        estimate(core.point(speed=sign * speed, axial_load=sign * load), surface, rcs_limit=0.25)
        for sign in (1, -1)
    )
    assert (here.rcs, here.efficiency, here.regime) == (there.rcs, there.efficiency, there.regime)
    assert here.machine_torque == -there.machine_torque
    assert {here.worst_nut, there.worst_nut} in ({Nut.POSITIVE, Nut.NEGATIVE}, {Nut.UNKNOWN})


def test_validity_repeats_that_of_a_surface():
    for member in surrogate.surface.Validity:
        assert PointValidity[member.name] == member
