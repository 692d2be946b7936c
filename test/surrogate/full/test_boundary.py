# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The limit of RCS of the optimal zone: where it is, and how far off in speed."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.full.boundary import boundary_error, boundary_speed
from surrogate.full.held_out import boundary_points, load_bands
from surrogate.full.idle import idle_load
from surrogate.full.settings import default_full_settings
from surrogate.surface import Surface
from surrogate.surface_diff import RCS_LIMIT


@pytest.fixture(name='surface')
def load_surface(surface_data):
    """Return the surface of formulas."""
    return Surface(surface_data)


@pytest.mark.parametrize('load', [-900.0, 0.0, 3300.0])
def test_speed_at_the_limit_is_found(surface, load):
    """The lookup says the limit there."""
    speed = boundary_speed(surface, load, 313.15)
    assert surface.lookup(speed, load, 313.15).rcs == pytest.approx(RCS_LIMIT, rel=1e-6)


def test_no_limit_where_rcs_stays_on_one_side(surface_data):
    """Not within speeds at which contact has ended."""
    rcs = np.zeros_like(surface_data.fields['rcs'])
    calm = replace(surface_data, fields={**surface_data.fields, 'rcs': rcs})
    assert boundary_speed(Surface(calm), 0.0, 313.15) is None


@pytest.mark.parametrize('shift', [-0.03, 0.02])
def test_a_curve_that_is_moved_along_the_speed_is_off_by_as_much(surface, shift):
    """A surface that has the limit at too slow a speed has a negative error."""
    speed = boundary_speed(surface, 500.0, 313.15)
    solved = surface.lookup(speed * math.exp(shift), 500.0, 313.15).rcs
    found = boundary_error(surface, (speed, 500.0, 313.15), solved)
    assert found.error == pytest.approx(shift, rel=0.1)
    assert (found.load, found.temperature) == (500.0, 313.15)


def test_one_point_per_band_of_loads(surface, screw):
    """The same for one seed, others for another."""
    settings = default_full_settings(screw)
    points = boundary_points(surface, screw, settings)
    bands = load_bands(screw, settings)
    assert len(points) == len(bands) == 3
    for (_, load, _), (low, high) in zip(points, bands):
        assert low <= abs(load) <= high
    assert abs(points[1][1]) < idle_load(screw) < abs(points[2][1])
    assert boundary_points(surface, screw, settings) == points
    assert boundary_points(surface, screw, replace(settings, seed=2)) != points
