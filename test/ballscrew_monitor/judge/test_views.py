# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows and memory as typed values and sentences."""

import math

from ballscrew_monitor.core.estimate import PointValidity
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Code, Gate, Reason, Severity, Zone
from ballscrew_monitor.judge import derived_load, views
from ballscrew_monitor.judge.records import Memory, Row
from ballscrew_monitor.judge.zone import set_reason, set_zone, shut_gates
import pytest

VALID = {'validity': 1, 'rcs': 0.0, 'efficiency': 0.9, 'direction': 1}
SOURCES = {'speed_source': 1, 'axial_load_source': 1, 'temperature_source': 1}


def judged(core, **changes):
    monitor, place = core.monitor(), {'speed': 10.0, 'axial_load': -1e3, 'temperature': 313.15}
    row = Row(**(place | SOURCES | VALID | changes))
    shut_gates(monitor.numbers, Memory(), row)
    set_zone(monitor.numbers, row)
    set_reason(row)
    estimate = views.estimate_of(row, views.point_of(row), monitor.surface)
    return views.verdict_of(row, estimate, monitor.settings.limits), row


def codes(verdict):
    return [finding.code for finding in verdict.findings]


@pytest.mark.parametrize(
    ('changes', 'gates', 'expected'),
    [
        ({}, (), []),
        ({'rcs': 0.25}, (), [Code.RCS_HIGH]),
        ({'efficiency': 0.5}, (), [Code.EFFICIENCY_LOW]),
        ({'rcs': 1.0, 'efficiency': 0.0}, (), [Code.RCS_HIGH, Code.EFFICIENCY_LOW]),
        ({'axial_load': 0.0, 'efficiency': 0.5}, (Gate.LIGHT_LOAD,), []),
        ({'axial_load': 0.0, 'rcs': 0.25}, (Gate.LIGHT_LOAD,), [Code.RCS_HIGH]),
        ({'speed': 0.05, 'axial_load': 0.0}, (Gate.STANDSTILL, Gate.LIGHT_LOAD), []),
        ({'speed': 0.05, 'validity': 2}, (Gate.STANDSTILL,), []),  # it creeps below the surface
        ({'speed': 0.0, 'axial_load': math.nan, 'validity': 7}, (Gate.STANDSTILL,), [4]),
        ({'speed': 1e3, 'validity': 3}, (), [Code.OUT_OF_RANGE]),
        ({'rcs': math.nan}, (), [Code.OUT_OF_RANGE]),
    ],
)
def test_gates_and_findings_of_a_row(core, changes, gates, expected):
    verdict, row = judged(core, **changes)
    assert (verdict.gates, codes(verdict)) == (gates, expected)
    assert verdict.zone is Zone(row.zone)
    assert (verdict.zone is Zone.OUTSIDE) == bool({*expected} & {1, 2})


def test_findings_say_value_limit_and_sentence(core, says):
    rcs, efficiency = judged(core, rcs=0.5, efficiency=0.5)[0].findings
    assert (rcs.value, rcs.limit, rcs.unit) == (0.5, 0.25, '-')
    assert rcs.text == says('asperities_carry_too')
    assert efficiency.text == says('too_much_power')
    _, derived = judged(core, rcs=0.5, efficiency=0.5, derived=3)[0].findings
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
    verdict, row = judged(core, **changes)
    assert row.reason == reason
    assert (reason is Reason.JUDGED) == (verdict.zone is not Zone.UNKNOWN)
    surface = core.surface()
    assert views.reason_of(row, views.point_of(row), surface).startswith(text)
    for one in verdict.findings:
        lost = row.validity == PointValidity.NO_INPUT
        assert one.severity is (Severity.ERROR if lost else Severity.WARN)
        assert one.text


def test_inputs_come_in_the_order_of_a_state(core):
    assert [one.source for one in core.monitor().input_status(0)] == list(views.SOURCES)
    assert set(views.SOURCES) == set(Source)
