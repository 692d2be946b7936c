# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The numbers under the operating map."""

import dataclasses

from ballscrew_monitor.cycle.operating_map import sample
from ballscrew_monitor.cycle.state_trace import LimitsInForce, Trace
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import RPM


def make_trace(speed, opposing_load):
    """Return a trace of given speeds [rad/s] and opposing loads [N]."""
    speed, opposing_load = np.array(speed), np.array(opposing_load)
    rest = np.zeros(speed.size)
    return Trace(
        axis='x',
        time=np.arange(speed.size, dtype=float),
        speed=speed,
        axial_load=-opposing_load,
        opposing_load=opposing_load,
        temperature=rest + 40.0,
        efficiency=rest,
        rcs=rest,
        film_ratio=rest,
        zone=rest,
        level=rest,
        limits=LimitsInForce(rcs=0.01, efficiency=0.85, light_load=250.0, standstill=0.5),
        tier=1,
    )


@pytest.fixture(scope='module')
def surface():
    """Return the shipped surface."""
    return Surface.load(shipped_surface())


def test_the_map_is_the_surface(surface):
    field = sample(surface, make_trace([10.0, 50.0], [-500.0, 2000.0]), 40.0)
    assert field.efficiency.shape == (field.load.size, field.speed.size)
    point = surface.lookup(field.speed[50] * RPM, field.load[90], 313.15)
    assert field.efficiency[90, 50] == pytest.approx(point.efficiency, rel=1e-9)
    assert field.rcs[90, 50] == pytest.approx(point.rcs, rel=1e-9)


def test_it_covers_the_loads_in_motion_within_the_surface(surface):
    field = sample(surface, make_trace([10.0, 50.0, 0.0], [-500.0, 2000.0, 3500.0]), 40.0)
    assert -700.0 < field.load[0] < -500.0
    assert 2000.0 < field.load[-1] < 2200.0
    far = sample(surface, make_trace([10.0, 10.0], [-9e3, 9e3]), 40.0)
    assert (far.load[0], far.load[-1]) == pytest.approx(surface.load_range)


def test_a_temperature_outside_says_nothing(surface):
    field = sample(surface, make_trace([10.0], [100.0]), 200.0)
    assert np.isnan(field.rcs).all()


def test_it_begins_where_speeds_are_judged(surface):
    trace = make_trace([10.0], [100.0])
    field = sample(surface, trace, 40.0)
    assert field.speed[0] * RPM == pytest.approx(trace.limits.standstill)
    assert field.speed[-1] * RPM == pytest.approx(surface.speed_range[1])
    never = dataclasses.replace(trace.limits, standstill=1e4)
    field = sample(surface, dataclasses.replace(trace, limits=never), 40.0)
    assert field.speed[0] * RPM == pytest.approx(surface.speed_range[0])
