# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many points at once give what single lookups give, to rounding."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from surrogate.surface import FIELDS, ManyLookup, shipped_surface, Surface, Validity

COUNT = 2000


@pytest.fixture(scope='module')
def surface():
    """Return the shipped surface of the full tier."""
    return Surface.load(shipped_surface())


def drawn_points(surface, beyond):
    """Return points all over the surface, and `beyond` its ends."""
    drawn = np.random.default_rng(7)
    slow, fast = np.log(surface.speed_range)
    parts = [(slow, fast), surface.load_range, surface.temperature_range]
    return [
        drawn.uniform(low - beyond * (high - low), high + beyond * (high - low), COUNT)
        for low, high in parts
    ]


def compare(surface, speed, load, temperature, fields=FIELDS):
    found = ManyLookup(surface, fields)(speed, load, temperature)
    for at in np.flatnonzero(~found.doubtful).tolist():
        single = surface.lookup(float(speed[at]), float(load[at]), float(temperature[at]))
        assert found.validity[at] == single.validity
        assert found.worst_contact[at] == single.worst_contact
        for name in fields:
            expected = single.values[FIELDS.index(name)]
            assert found.values[name][at] == pytest.approx(
                expected, rel=1e-12, abs=1e-14, nan_ok=True
            )
    return found


def test_points_all_over_the_surface(surface):
    speed, load, temperature = drawn_points(surface, 0.0)
    found = compare(surface, np.exp(speed), load, temperature)
    assert np.count_nonzero(found.validity == Validity.VALID) > 0.9 * COUNT
    assert np.count_nonzero(found.doubtful) < 5


def test_points_beyond_the_ends_say_which_was_passed(surface):
    speed, load, temperature = drawn_points(surface, 0.2)
    found = compare(surface, np.exp(speed), load, temperature, ('rcs', 'film_ratio'))
    assert set(found.validity) >= {
        Validity.VALID,
        Validity.SPEED_ABOVE_RANGE,
        Validity.SPEED_BELOW_RANGE,
        Validity.LOAD_OUT_OF_RANGE,
        Validity.TEMPERATURE_OUT_OF_RANGE,
    }


def test_ends_nodes_and_no_numbers(surface):
    odd = [0.0, math.nan, math.inf, -1.0, *surface.speed_range, 50.0]
    loads = [math.nan, *surface.load_range, *surface._lists[1], 0.0, -0.0]
    heats = [math.nan, *surface.temperature_range, *surface._lists[2], 300.0]
    grid = np.meshgrid(odd, loads, heats, indexing='ij')
    with np.errstate(invalid='ignore'):
        compare(surface, *(axis.ravel() for axis in grid))


def test_cells_that_a_full_solve_has_pulled_are_doubtful(surface):
    point = SimpleNamespace(speed=50.0, opposing_load=1010.0, temperature=311.0)
    solution = SimpleNamespace(converged=True, friction_torque=0.4)
    corrected = surface.with_correction(point, solution)
    found = ManyLookup(corrected)(*(np.array([value]) for value in (50.0, 1010.0, 311.0)))
    assert found.doubtful.all()


def test_no_point_at_all(surface):
    nothing = np.empty(0)
    assert not len(ManyLookup(surface)(nothing, nothing, nothing).validity)
