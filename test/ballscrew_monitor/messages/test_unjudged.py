# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Answers of a surface to a point, findings of a row, and reasons for which there is none."""

import math
import re

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.judgement import (
    Code,
    ContactState,
    PointValidity,
    Reason,
    Severity,
    Zone,
)
from ballscrew_monitor.judge import derived_load
from ballscrew_monitor.judge.full_point import answer
from ballscrew_monitor.judge.records import LIGHT_LOAD, Memory, Row, STANDSTILL
from ballscrew_monitor.judge.zone import set_reason, set_zone, shut_gates
from ballscrew_monitor.messages.state_messages import findings_of
from ballscrew_monitor.messages.unjudged import reason_of
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import Regime, Validity

VALID = {'validity': 1, 'rcs': 0.0, 'efficiency': 0.9, 'direction': 1}
SOURCES = {'speed_source': 1, 'axial_load_source': 1, 'temperature_source': 1}


def judged(core, **changes):
    monitor, place = core.monitor(), {'speed': 10.0, 'axial_load': -1e3, 'temperature': 313.15}
    row = Row(**(place | SOURCES | VALID | changes))
    shut_gates(monitor.numbers, Memory(), row)
    set_zone(monitor.numbers, row)
    set_reason(row)
    return findings_of(row, monitor.settings.limits, reason_of(row, monitor.surface)), row


@pytest.mark.parametrize(
    ('changes', 'gates', 'expected'),
    [
        ({}, 0, []),
        ({'rcs': 0.25}, 0, [Code.RCS_HIGH]),
        ({'efficiency': 0.5}, 0, [Code.EFFICIENCY_LOW]),
        ({'rcs': 1.0, 'efficiency': 0.0}, 0, [Code.RCS_HIGH, Code.EFFICIENCY_LOW]),
        ({'axial_load': 0.0, 'efficiency': 0.5}, LIGHT_LOAD, []),
        ({'axial_load': 0.0, 'rcs': 0.25}, LIGHT_LOAD, [Code.RCS_HIGH]),
        ({'speed': 0.05, 'axial_load': 0.0}, STANDSTILL | LIGHT_LOAD, []),
        ({'speed': 0.05, 'validity': 2}, STANDSTILL, []),  # it creeps below the surface
        ({'speed': 0.0, 'axial_load': math.nan, 'validity': 7}, STANDSTILL, [4]),
        ({'speed': 1e3, 'validity': 3}, 0, [Code.OUT_OF_RANGE]),
        ({'rcs': math.nan}, 0, [Code.OUT_OF_RANGE]),
    ],
)
def test_gates_and_findings_of_a_row(core, changes, gates, expected):
    findings, row = judged(core, **changes)
    assert (row.gates, [finding.code for finding in findings]) == (gates, expected)
    assert (row.zone == Zone.OUTSIDE) == bool({*expected} & {1, 2})


def test_findings_say_value_limit_and_sentence(core, says):
    rcs, efficiency = judged(core, rcs=0.5, efficiency=0.5)[0]
    assert (rcs.value, rcs.limit, rcs.unit) == (0.5, 0.25, '-')
    assert rcs.text == says('asperities_carry_too')
    assert efficiency.text == says('too_much_power')
    _, derived = judged(core, rcs=0.5, efficiency=0.5, derived=3)[0]
    assert derived.text == says('efficiency_judged_from', text=efficiency.text)


@pytest.mark.parametrize(
    ('changes', 'reason', 'text'),
    [
        ({}, Reason.JUDGED, ''),
        ({'speed': 0.2}, Reason.STANDSTILL, ''),
        ({'validity': 0, 'direction': 0}, Reason.NO_DIRECTION, 'the direction of motion is unk'),
        ({'efficiency': math.nan}, Reason.NO_NUMBER, ''),
        ({'validity': 2}, Reason.SPEED_BELOW_RANGE, 'speed 10 rad/s is below the surface, from'),
        ({'validity': 3}, Reason.SPEED_ABOVE_RANGE, 'speed 10 rad/s is above the surface, to'),
        ({'validity': 4}, Reason.LOAD_OUT_OF_RANGE, 'opposing load 1000 N is outside'),
        ({'validity': 5}, Reason.TEMPERATURE_OUT_OF_RANGE, 'oil temperature 40 degC is out'),
        ({'validity': 6}, Reason.MASKED, 'the model did not converge near this point'),
        ({'validity': 7, 'speed_source': 3}, Reason.NO_SPEED, 'no valid sample of speed'),
        ({'validity': 7, 'axial_load': math.nan}, Reason.NO_LOAD, 'no valid sample of load'),
        (
            {'validity': 7, 'temperature_source': 3},
            Reason.NO_TEMPERATURE,
            'no valid sample of temperature',
        ),
        ({'validity': 7, 'derived': 1}, Reason.NO_TORQUE, 'no valid sample of torque'),
        (
            {'validity': 7, 'speed': math.nan, 'axial_load': math.nan},
            Reason.NO_INPUTS,
            'no valid sample of speed and load',
        ),
        ({'validity': 7}, Reason.NO_INPUTS, 'an input is beyond any range'),
        *(
            ({'validity': validity, 'derived': code}, reason, text)
            for code, validity, reason, text in (
                (derived_load.STANDSTILL, 0, Reason.NO_DERIVED_LOAD, 'the screw stands still'),
                (derived_load.NO_ACCELERATION, 0, Reason.NO_DERIVED_LOAD, 'the acceleration is'),
                (derived_load.TOO_MUCH_INERTIA, 0, Reason.NO_DERIVED_LOAD, 'inertia and drag'),
                (derived_load.SEVERAL_LOADS, 0, Reason.NO_DERIVED_LOAD, 'the torque is that of'),
                (derived_load.OUTSIDE, 4, Reason.LOAD_OUT_OF_RANGE, 'the torque along the mot'),
                (derived_load.NO_NUMBER, 6, Reason.MASKED, 'the model did not converge'),
            )
        ),
    ],
)
def test_an_instant_without_a_zone_says_why(core, changes, reason, text):
    findings, row = judged(core, **changes)
    assert row.reason == reason
    assert (reason is Reason.JUDGED) == (row.zone != Zone.UNKNOWN)
    assert reason_of(row, core.surface()).startswith(text)
    for finding in findings:
        lost = row.validity == PointValidity.NO_INPUT
        assert finding.severity == (Severity.ERROR if lost else Severity.WARN)
        assert finding.text


def test_the_surface_is_asked_in_its_own_frame(core):
    surface = core.surface()
    answer(core.point(speed=-20.0, axial_load=-300.0), surface, rcs_limit=0.25)
    answer(core.point(speed=20.0, axial_load=-300.0), surface, rcs_limit=0.25)
    assert surface.asked == [(20.0, -300.0, 313.15), (20.0, 300.0, 313.15)]


def test_a_valid_answer_carries_the_numbers_and_a_masked_cell_says_so(core):
    result = answer(core.point(speed=-20.0), core.surface(rcs=0.25), rcs_limit=0.25)
    assert result.validity == PointValidity.VALID
    assert (result.rcs, result.efficiency) == (0.25, 0.9)
    assert result.machine_torque == -2.0
    assert result.machine_nut == Nut.NEGATIVE
    assert (result.regime, result.contact_state) == (Regime.HYDRODYNAMIC, ContactState.PARTIAL)
    result = answer(core.point(), core.surface(validity=PointValidity.MASKED), rcs_limit=0.25)
    assert result.validity == PointValidity.MASKED
    assert 'did not converge' in reason_of(result, core.surface())


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
def test_what_has_no_answer_has_a_reason_and_no_numbers(core, changes, validity, reason):
    result = answer(core.point(**changes), core.surface(), rcs_limit=0.25)
    assert result.validity == PointValidity[validity]
    assert re.search(reason, reason_of(result, core.surface()))
    assert math.isnan(result.rcs)
    assert math.isnan(result.efficiency)
    assert result.regime == Regime.UNKNOWN
    assert result.contact_state == ContactState.UNKNOWN


@given(
    speed=st.floats(),
    load=st.floats(),
    temperature=st.floats(),
    direction=st.sampled_from(Direction),
)
def test_whatever_the_point_is_there_is_an_answer(core, speed, load, temperature, direction):
    point = core.point(speed=speed, axial_load=load, temperature=temperature, direction=direction)
    result = answer(point, core.surface(), rcs_limit=0.25)
    assert (result.validity == PointValidity.VALID) == (not math.isnan(result.rcs))
    reason = reason_of(result, core.surface())
    assert (result.validity == PointValidity.VALID) == (reason == '')


@given(speed=st.floats(0.5, 90.0), load=st.floats(-3e3, 3e3))
def test_turning_everything_round_changes_nothing_but_the_signs(core, speed, load):
    surface = core.surface(
        rcs=lambda speed, load: 1.0 / speed,
        efficiency=lambda speed, load: abs(load) / 4e3,
        worst_contact=1,
    )
    here, there = (
        answer(core.point(speed=sign * speed, axial_load=sign * load), surface, rcs_limit=0.25)
        for sign in (1, -1)
    )
    assert (here.rcs, here.efficiency, here.regime) == (there.rcs, there.efficiency, there.regime)
    assert here.machine_torque == -there.machine_torque
    assert {here.machine_nut, there.machine_nut} in ({Nut.POSITIVE, Nut.NEGATIVE}, {Nut.UNKNOWN})


def test_validity_repeats_that_of_a_surface():
    for member in Validity:
        assert PointValidity[member.name] == member
