# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Held-out points come from all over the range, and each error is stated where it belongs."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import build_closed_form, SurfaceSettings
from surrogate.builder.full.held_out import (
    cell_errors,
    held_out_points,
    judged,
    load_bands,
    NEAR_ONSET,
    SPEEDS,
)
from surrogate.builder.full.settings import default_full_settings
from surrogate.formulas.load_sharing import idle_load
from surrogate.surface import FIELDS, SolvedPoint, Surface
from surrogate.surface.aims import rcs_tolerance

POINTS = 180


@pytest.fixture(name='settings')
def many(screw):
    """Return the defaults with many points."""
    return replace(default_full_settings(screw), held_out=POINTS)


@pytest.fixture(scope='module', name='coarse')
def build_coarse(screw, oil):
    """Return a surface of formulas with few nodes."""
    ranges = default_full_settings(screw)
    return build_closed_form(
        screw,
        oil,
        SurfaceSettings(
            speed_range=ranges.speed_range,
            load_range=ranges.load_range,
            temperature_range=ranges.temperature_range,
            speed_nodes=9,
            load_cells=2,
            unloaded_cells=1,
        ),
    )


@pytest.fixture(name='solve')
def make_solve(coarse, screw):
    """Return what the surface says of a point, with an offset in RCS in one stratum."""
    surface = Surface(coarse)

    def solve(point, fault=0.02):
        speed, load, heat = point
        found = surface.lookup(*point)
        s = math.log(speed / surface.onset_speed(load, heat))
        wrong = fault * (s > NEAR_ONSET[1] and abs(load) > idle_load(screw))
        values = {name: getattr(found, name) for name in FIELDS}
        return SolvedPoint(converged=True, **values | {'rcs': found.rcs + wrong})

    return solve


def test_bands_part_the_loads_of_a_range(screw, settings):
    """At unloading and where the relieved nut is idle, as far as the range goes."""
    idle = idle_load(screw)
    assert load_bands(screw, settings) == [(0.0, 0.8 * idle), (0.8 * idle, idle), (idle, 3960.0)]
    free = replace(screw, preload=0.0)
    assert load_bands(free, settings) == [(0.0, 3960.0)]
    one_sided = replace(settings, load_range=(-900.0, -400.0))
    assert load_bands(screw, one_sided) == [(400.0, 900.0)]


def test_points_reach_all_speeds_at_all_temperatures(coarse, screw, settings):
    """Also those that cold oil alone or hot oil alone has."""
    surface = Surface(coarse)
    points = held_out_points(surface, screw, settings)
    assert len(points) == POINTS
    s = np.array([math.log(w / surface.onset_speed(load, heat)) for w, load, heat in points])
    speed, load, heat = np.array(points).T
    assert speed.min() >= settings.speed_range[0] * (1 - 1e-9)
    assert speed.max() <= settings.speed_range[1] * (1 + 1e-9)
    for cold in (heat < 300, heat > 335):
        low, high = np.log(settings.speed_range)
        assert np.log(speed[cold]).max() > high - 1
        assert np.log(speed[cold]).min() < low + 1.5
    shares = [((s >= low) & (s < high)).mean() for low, high in SPEEDS]
    assert shares == [0.25] * 4
    assert load.min() < 0 < load.max()
    assert held_out_points(surface, screw, settings) == points
    assert held_out_points(surface, screw, replace(settings, seed=2)) != points


@pytest.mark.parametrize('ends', [(0.0, 1500.0), (-300.0, 5000.0), (400.0, 900.0)])
def test_points_lie_inside_lopsided_ranges(coarse, screw, settings, ends):
    """None at an end of the range, which is a node."""
    points = held_out_points(Surface(coarse), screw, replace(settings, load_range=ends))
    loads = np.array([load for _, load, _ in points if abs(load) < 3960])
    assert ends[0] < loads.min() < loads.max() < ends[1]


def test_a_miss_is_the_larger_error_over_the_allowed_one(coarse, screw, solve):
    """In RCS, or in the efficiency that the torque gives; none where both agree."""
    point = (20.0, 900.0, 313.15)
    surface, solved = Surface(coarse), solve(point)
    assert judged(coarse, surface, screw, point, solved).miss == pytest.approx(0.0, abs=1e-9)
    touching = replace(solved, rcs=solved.rcs + 0.3)
    miss = judged(coarse, surface, screw, point, touching).miss
    assert miss == pytest.approx(0.3 / rcs_tolerance(touching.rcs))
    ideal = 900.0 * screw.lead / (2 * math.pi)
    efficiency = ideal / (ideal + solved.friction_torque) - 0.006
    dearer = replace(solved, friction_torque=ideal / efficiency - ideal)
    assert judged(coarse, surface, screw, point, dearer).miss == pytest.approx(2.0, rel=1e-6)


def test_nothing_is_judged_without_both_answers(coarse, screw, solve):
    """A solve that failed, and a point beyond the range."""
    point, surface = (20.0, 900.0, 313.15), Surface(coarse)
    failed = replace(solve(point), converged=False)
    assert judged(coarse, surface, screw, point, failed) is None
    assert judged(coarse, surface, screw, (20.0, 9e4, 313.15), solve(point)) is None


def test_errors_stand_in_their_cells_and_strata(coarse, screw, settings, solve):
    """The largest of a stratum fills its other cells; with one at fault the others are small."""
    surface = Surface(coarse)
    points = held_out_points(surface, screw, settings)
    compared = [judged(coarse, surface, screw, point, solve(point)) for point in points]
    solved = [one for one in compared if one is not None]
    errors = cell_errors(coarse, solved, screw, settings)
    assert max(one.miss for one in solved) == pytest.approx(0.02 / 0.005, rel=0.01)
    s, load = (0.5 * (axis[1:] + axis[:-1]) for axis in (coarse.speed_coordinate, coarse.load))
    beyond = np.ix_(s > NEAR_ONSET[1], np.abs(load) > idle_load(screw))
    assert errors['rcs'][beyond] == pytest.approx(0.02, abs=1e-9)
    shared = np.ix_(s < NEAR_ONSET[1], np.abs(load) < 0.8 * idle_load(screw))
    assert errors['rcs'][shared].max() < 1e-9
    assert errors['friction_torque'].max() < 1e-9


def test_without_points_no_error_is_known(coarse, screw, settings):
    """Unknown everywhere, not nothing."""
    errors = cell_errors(coarse, [], screw, settings)
    assert all(np.isnan(errors[name]).all() for name in FIELDS)
