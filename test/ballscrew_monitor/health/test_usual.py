# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A warning is usual where the baseline already had it: its kind, band of speed, load and way."""

import types

from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.health.bands import load_band, speed_band
from ballscrew_monitor.health.records import Baseline, Cell, UsualWarning
from ballscrew_monitor.health.usual import is_usual, usual_warnings
import pytest
from surrogate.surface import Validity

BASELINE = Baseline(begin=100, end=200, reason='learned')


def cell(speed=2.0, load=-1000.0, start=150):
    bands = {'speed_band': speed_band(abs(speed)), 'load_band': load_band(load)}
    way = 1 if speed > 0.0 else -1
    place = {'speed': speed, 'axial_load': load, 'temperature': 313.0, 'direction': way}
    return Cell(start=start, **bands, **place)


class Slipping:
    """A surface on which metal carries below 10 rad/s, and efficiency is low below 5 rad/s."""

    def lookup(self, speed, opposing_load, temperature):
        return types.SimpleNamespace(
            validity=Validity.VALID if temperature < 330.0 else Validity.TEMPERATURE_OUT_OF_RANGE,
            rcs=1.0 if speed < 10.0 else 0.0,
            efficiency=0.5 if speed < 5.0 else 0.95,
        )


@pytest.mark.parametrize(
    ('point', 'codes'),
    [
        (cell(), {Code.RCS_HIGH, Code.EFFICIENCY_LOW}),
        (cell(load=-100.0), {Code.RCS_HIGH}),  # too light to judge the efficiency
        (cell(speed=7.0), {Code.RCS_HIGH}),
        (cell(speed=20.0), set()),
        (cell(start=99), set()),
        (cell(start=200), set()),
        (cell(start=100), {Code.RCS_HIGH, Code.EFFICIENCY_LOW}),
    ],
)
def test_what_the_baseline_had_is_known(usual_limits, point, codes):
    known = usual_warnings([point, cell(speed=30.0)], BASELINE, Slipping(), usual_limits)
    place = point.speed_band, point.load_band, point.direction
    assert known == tuple(sorted(UsualWarning(code, *place) for code in codes))
    assert usual_warnings([point], None, Slipping(), usual_limits) == ()


@pytest.mark.parametrize(
    ('changes', 'usual'),
    [
        ({}, True),
        ({'speed': 2.05, 'axial_load': -1020.0}, True),
        ({'speed': -2.0}, False),
        ({'speed': 3.0}, False),
        ({'axial_load': -3000.0}, False),
        ({'axial_load': 1000.0}, False),
        ({'speed': 0.0}, False),
        ({'axial_load': float('nan')}, False),
        ({'code': Code.EFFICIENCY_LOW}, False),
    ],
)
def test_another_kind_speed_load_or_way_is_news(usual_limits, changes, usual):
    point = cell(load=-1000.0, speed=2.0)
    place = point.speed_band, point.load_band, point.direction
    health = types.SimpleNamespace(usual_warnings=(UsualWarning(Code.RCS_HIGH, *place),))
    asked = {'code': Code.RCS_HIGH, 'speed': 2.0, 'axial_load': -1000.0} | changes
    assert is_usual(health, **asked) is usual
