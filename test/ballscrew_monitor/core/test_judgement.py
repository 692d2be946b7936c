# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The words of a judgement: limits that make sense, and the numbers of the messages."""

import math

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.inputs import InputState, StampSource
from ballscrew_monitor.core.judgement import (
    Code,
    ContactState,
    EventEnd,
    Gate,
    Level,
    PointSource,
    PointValidity,
    Reason,
    Severity,
    Zone,
)
from ballscrew_msgs.msg import (
    BallScrewState,
    Finding,
    InputHealth,
    OperatingPoint,
    OutOfZone,
    PointResult,
)
import pytest
from surrogate.surface import Regime


@pytest.mark.parametrize(
    ('changes', 'match'),
    [
        ({'rcs': 0.0}, 'limit_rcs_0'),
        ({'rcs': 1.0}, 'limit_rcs_1'),
        ({'efficiency': math.nan}, 'efficiency_nan'),
        ({'light_load': -1.0}, 'light_load_2'),
        ({'standstill_speed': 0.0}, 'standstill_speed_0_0'),
        ({'raise_delay': -1}, 'raise_delay_2'),
        ({'hysteresis': 1.0}, 'from_0_below'),
    ],
)
def test_limits_without_meaning_are_refused(core, changes, match, refused):
    refused(match, core.limits, **changes)


@pytest.mark.parametrize(
    ('enumeration', 'message', 'prefix'),
    [
        (PointValidity, PointResult, 'VALIDITY_'),
        (Regime, PointResult, 'REGIME_'),
        (ContactState, PointResult, 'CONTACT_'),
        (Nut, PointResult, 'NUT_'),
        (PointSource, OperatingPoint, 'SOURCE_'),
        (Direction, OperatingPoint, 'DIRECTION_'),
        (InputState, InputHealth, 'STATE_'),
        (StampSource, InputHealth, 'STAMP_'),
        (Level, BallScrewState, 'LEVEL_'),
        (Zone, BallScrewState, 'ZONE_'),
        (Gate, BallScrewState, 'GATE_'),
        (Code, Finding, 'CODE_'),
        (EventEnd, OutOfZone, 'ENDING_'),
        (Severity, Finding, 'SEVERITY_'),
    ],
)
def test_enumerations_have_the_numbers_of_the_messages(enumeration, message, prefix):
    for member in enumeration:
        assert getattr(message, f'{prefix}{member.name}') == member


def test_every_reason_has_words():
    assert len({reason.text for reason in Reason}) == len(Reason)
