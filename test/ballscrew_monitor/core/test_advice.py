# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The nearest speed and load that clear a warning."""

import dataclasses
import math

from ballscrew_monitor.core.advice import Advice, Advisor
from ballscrew_monitor.core.estimate import opposing_load_of
from ballscrew_monitor.core.judgement import efficiency_to_clear, rcs_to_clear
import pytest


def advise(point, surface, limits):
    return Advisor(point=point, surface=surface, limits=limits).advice


def faster_is_better(speed, load):
    return 1.0 if speed < 30.0 else 0.0


def heavier_is_better(speed, load):
    return 0.9 if abs(load) >= 1500.0 else 0.5


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_a_border_is_found_from_its_optimal_side_and_the_load_keeps_its_sense(core, sign):
    point = core.point(speed=sign * 5.0, axial_load=-sign * 1000.0)
    found = advise(point, core.surface(rcs=faster_is_better), core.limits()).target_speed
    assert sign * found == pytest.approx(30.0, rel=1e-5)
    assert sign * found >= 30.0
    point = core.point(speed=10.0, axial_load=sign * 1000.0)
    found = advise(point, core.surface(efficiency=heavier_is_better), core.limits()).target_load
    assert sign * found == pytest.approx(1500.0, rel=1e-4)
    assert sign * found >= 1500.0


def test_the_nearer_of_two_borders_wins(core):
    surface = core.surface(rcs=lambda speed, load: 0.0 if speed < 8.0 or speed > 50.0 else 1.0)
    found = advise(core.point(speed=10.0), surface, core.limits()).target_speed
    assert found == pytest.approx(8.0)
    made = advise(core.point(speed=45.0), surface, core.limits()).target_speed
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
    assert math.isnan(found.target_speed)


def test_advice_under_a_light_load(core):
    surface = core.surface(efficiency=0.5)
    assert math.isnan(advise(core.point(axial_load=300.0), surface, core.limits()).target_load)
    surface = core.surface(
        rcs=lambda speed, load: 1.0 if abs(load) > 100.0 else 0.0, efficiency=0.5
    )
    found = advise(core.point(axial_load=200.0), surface, core.limits()).target_load
    assert found == pytest.approx(100.0, rel=1e-4)


def test_advice_is_a_sentence(core, says):
    assert Advice().text == ''
    advice = advise(core.point(speed=5.0), core.surface(rcs=faster_is_better), core.limits())
    assert advice.text == says('surely')
    both = Advice(target_speed=30.0, target_load=-1500.0)
    assert both.text == says('this_load_run')


@pytest.mark.parametrize(
    ('speed', 'limits', 'numerics', 'carry'),
    [
        (20.0, (0.6, 1.5), (0.8, 1.25), 'perhaps'),  # 20 is between 0.6 and 0.8 of 30
        (20.0, (0.8, 1.5), (0.6, 1.25), 'perhaps'),
        (17.9, (0.8, 1.5), (0.6, 1.25), 'surely'),
        (29.0, (0.99, 1.5), (0.99, 1.25), 'surely'),
        (20.0, (0.6, 1.5), (math.nan, math.nan), 'perhaps'),
        (20.0, (math.nan, math.nan), (math.nan, math.nan), ''),
        (30.0, (0.6, 1.5), (0.8, 1.25), ''),  # too little efficiency is another warning
    ],
)
def test_contact_is_sure_slower_than_both_bands(core, speed, limits, numerics, carry):
    """And perhaps between them; not said of a surface that does not know."""
    surface = core.surface(rcs=faster_is_better)
    surface.limit_band, surface.numerical_band = limits, numerics
    advice = advise(core.point(speed=speed), surface, core.limits())
    assert advice.carry == carry
    assert (f'; asperities {carry} carry here' in advice.text) == bool(carry)
    assert Advice(carry='surely').text == ''  # nothing helps


def test_an_optimal_point_is_its_own_advice(core):
    point = core.point(speed=7.0, axial_load=-600.0)
    expected = Advice(target_speed=7.0, target_load=-600.0)
    assert advise(point, core.surface(), core.limits()) == expected


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(
    ('name', 'sensitive'),
    [
        ('rcs', lambda speed, load: 2.0**-speed),
        ('efficiency', lambda speed, load: 1.0 - 0.5**speed),
        ('rcs', lambda speed, load: min(1.0, abs(load) / 4000.0)),
        ('efficiency', lambda speed, load: abs(load) / 4000.0),
    ],
)
def test_who_follows_the_advice_clears_the_warning(core, sign, name, sensitive):
    surface, limits = core.surface(**{name: sensitive}), core.limits(light_load=1.0)
    load = sign * (2000.0 if name == 'rcs' else 1000.0)
    point = core.point(speed=sign * 1.5, axial_load=load)
    advice = advise(point, surface, limits)
    followed = [
        dataclasses.replace(point, **{field: target})
        for field, target in (('speed', advice.target_speed), ('axial_load', advice.target_load))
        if math.isfinite(target)
    ]
    assert followed
    for there in followed:
        numbers = surface.lookup(abs(there.speed), opposing_load_of(there), there.temperature)
        assert numbers.rcs < rcs_to_clear(limits)
        assert numbers.efficiency >= efficiency_to_clear(limits)
