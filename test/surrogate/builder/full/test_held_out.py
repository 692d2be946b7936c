# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Held-out points come from all over the range, and each error is stated where it belongs."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import build_closed_form
from surrogate.builder.full.chain import SolvedChain
from surrogate.builder.full.columns import Columns, NEAR_ONSET
from surrogate.builder.full.held_out import (
    cell_errors,
    held_out_points,
    load_bands,
    solve_held_out,
)
from surrogate.builder.full.settings import default_full_settings
from surrogate.formulas.load_sharing import idle_load
from surrogate.surface import SolvedPoint, Surface

POINTS = 180


@pytest.fixture(name='settings')
def many(screw):
    """Return the defaults with many points."""
    return replace(default_full_settings(screw), held_out=POINTS, draws=1)


@pytest.fixture(scope='module', name='coarse')
def build_coarse(screw, oil):
    """Return a surface of formulas whose errors are far from nothing."""
    ranges = default_full_settings(screw)
    return build_closed_form(
        screw, oil, replace(ranges, speed_nodes=9, load_cells=2, unloaded_cells=1)
    )


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
    assert len(points) > 0.9 * POINTS
    s = np.array([math.log(w / surface.onset_speed(load, heat)) for w, load, heat in points])
    speed, load, heat = np.array(points).T
    assert speed.min() >= settings.speed_range[0] * (1 - 1e-9)
    assert speed.max() <= settings.speed_range[1] * (1 + 1e-9)
    for cold in (heat < 300, heat > 335):
        low, high = np.log(settings.speed_range)
        assert np.log(speed[cold]).max() > high - 1
        assert np.log(speed[cold]).min() < low + 1.5
    near = (s >= NEAR_ONSET[0]) & (s <= NEAR_ONSET[1])
    assert 0.25 < near.mean() < 0.45
    assert load.min() < 0 < load.max()


@pytest.mark.parametrize('ends', [(0.0, 1500.0), (-300.0, 5000.0), (400.0, 900.0)])
def test_points_lie_inside_lopsided_ranges(coarse, screw, settings, ends):
    """None at an end of the range, which is a node."""
    points = held_out_points(Surface(coarse), screw, replace(settings, load_range=ends))
    loads = np.array([load for _, load, _ in points if abs(load) < 3960])
    assert ends[0] < loads.min() < loads.max() < ends[1]


def test_errors_stand_in_their_cells_and_strata(coarse, screw, oil, settings, stand_in):
    """The largest of a stratum fills its other cells; with one at fault the others are small."""
    columns = Columns(
        screw=screw,
        lubricant=oil,
        load=coarse.load,
        temperature=coarse.temperature,
        speed_range=settings.speed_range,
        draws=1,
        shared_draws=1,
        log_onset=coarse.log_onset,
    )

    def run(purpose, chains):
        """Return what the surface says, with an offset in RCS at fast speeds beyond unloading."""
        surface, results = Surface(coarse), {}
        for name, chain in chains.items():
            (speed,), load, heat = chain['speeds'], chain['load'], chain['temperature']
            s = math.log(speed / surface.onset_speed(load, heat))
            fault = 0.01 * (s > NEAR_ONSET[1] and load > idle_load(screw))
            results[name] = SolvedChain(
                *(
                    (SolvedPoint(converged=True, **fields | {'rcs': fields['rcs'] + fault}),)
                    for sign in (1, -1)
                    for found in [surface.lookup(speed, sign * load, heat)]
                    for fields in [{field: getattr(found, field) for field in coarse.fields}]
                )
            )
        return results

    points = held_out_points(Surface(coarse), screw, settings)
    solved = solve_held_out(coarse, points, columns, settings, run)
    errors = cell_errors(coarse, solved, screw, settings)
    assert max(one.miss for one in solved) == pytest.approx(0.01 / 0.003, rel=0.3)
    s, load = (0.5 * (axis[1:] + axis[:-1]) for axis in (coarse.speed_coordinate, coarse.load))
    beyond = np.ix_(s > NEAR_ONSET[1], np.abs(load) > idle_load(screw))
    assert errors['rcs'][beyond] == pytest.approx(0.01, abs=1e-9)
    shared = np.ix_(s < NEAR_ONSET[1], np.abs(load) < 0.8 * idle_load(screw))
    assert errors['rcs'][shared].max() < 1e-9
    assert errors['friction_torque'].max() < 1e-9
    worse = [replace(one, mean=replace(one.mean, rcs=one.found.rcs - 0.5)) for one in solved[:9]]
    widened = cell_errors(coarse, solved, screw, settings, worse)['rcs']
    own = {one.cell for one in solved}
    assert all(widened[cell] == errors['rcs'][cell] for cell in own)
    others = [cell for cell in np.ndindex(widened.shape) if cell not in own]
    assert {round(widened[cell], 9) for cell in others if np.isfinite(widened[cell])} == {0.5}
