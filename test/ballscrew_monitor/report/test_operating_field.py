# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The surface on a grid around a run."""

import dataclasses
import math

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.report.operating_field import (
    judged_speeds,
    loads_around,
    map_temperatures,
    sample,
)
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM


@pytest.fixture(scope='module')
def surface():
    return Surface.load(shipped_surface())


SPEEDS = (0.5, 200.0)


def field_of(surface, loads, temperature=40.0, speeds=SPEEDS):
    return sample(surface, temperature, speeds=speeds, loads=loads)


def test_it_is_the_surface_and_the_zone_is_where_limits_are_kept(surface):
    field = field_of(surface, (-500.0, 2000.0))
    assert field.efficiency.shape == (field.load.size, field.speed.size)
    point = surface.lookup(field.speed[50] * RPM, field.load[90], 313.15)
    assert field.efficiency[90, 50] == pytest.approx(point.efficiency, rel=1e-9)
    assert field.rcs[90, 50] == pytest.approx(point.rcs, rel=1e-9)
    assert field.film_ratio[90, 50] == pytest.approx(point.film_ratio, rel=1e-9)
    middles = field.middles()
    assert middles.rcs.shape == (field.load.size - 1, field.speed.size - 1)
    assert (middles.speed > field.speed[:-1]).all()
    assert middles.rcs[3, 5] == pytest.approx(field.rcs[3:5, 5:7].mean())
    assert np.isnan(field_of(surface, (-500.0, 500.0), 200.0).rcs).all()
    times = {'raise_delay': 0, 'clear_delay': 0, 'hysteresis': 0.0}
    limits = Limits(rcs=0.01, efficiency=0.85, light_load=0.0, standstill_speed=0.5, **times)
    strict = field.is_optimal(limits)
    assert (strict == ((field.rcs < 0.01) & (field.efficiency >= 0.85))).all()
    light = dataclasses.replace(limits, light_load=1e4)
    assert field.is_optimal(light).sum() > strict.sum()


def test_loads_go_around_the_run_and_speeds_begin_where_they_are_judged(surface):
    low, high = loads_around(surface, -500.0, 2000.0, light_load=250.0)
    assert -700.0 < low < -500.0
    assert 2000.0 < high < 2200.0
    far = loads_around(surface, -9e3, 9e3, light_load=250.0)
    assert far == pytest.approx(surface.load_range)
    assert loads_around(surface, math.nan, math.nan, light_load=250.0) == (-420.0, 420.0)
    assert judged_speeds(surface, 0.5) == pytest.approx((0.5, surface.speed_range[1]))
    assert judged_speeds(surface, 1e4) == pytest.approx(surface.speed_range)


def test_a_map_is_at_a_whole_degree_and_others_are_further_than_two():
    assert map_temperatures(38.5, 39.7, 41.0) == (40.0, [])
    assert map_temperatures(20.0, 39.7, 41.0) == (40.0, [20.0])
