# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Ratios of solved screws to formulas: where they are solved, and what they are in between."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.builder.full.nodes import beside_idle, surface_nodes
from surrogate.builder.full.ratios import (
    CORRECTED,
    LOADS,
    ratios_at,
    solve_ratios,
    solved_grid,
    with_floor,
)
from surrogate.builder.full.settings import default_full_settings
from surrogate.files import InputError
from surrogate.formulas.load_sharing import UNLOADING_RATIO
from surrogate.formulas.lubricant import lubricant_state
from surrogate.screw.opened import Contacts


@pytest.fixture(name='settings')
def defaults(screw):
    """Return the defaults of the nominal screw."""
    return default_full_settings(screw)


@pytest.fixture(name='place')
def make_place(screw, oil, settings):
    """Return the solved grid and the nodes of the defaults."""
    return solved_grid(screw, oil, settings), surface_nodes(Contacts.of(screw), oil, settings)


def logs_of(grid, oil):
    """Return a plane over the axes in which a field is interpolated, of either sense."""
    speed = np.log(grid.speeds)[:, None, None]
    cold = np.log(lubricant_state(oil, grid.temperature).viscosity)
    plane = 0.01 * speed + 2e-5 * grid.loads[:, None] + 0.02 * cold
    return {name: np.stack([plane, plane + 0.1]) for name in CORRECTED}


def test_a_plane_is_found_as_it_is(oil, place):
    """Over speed, load and viscosity, with the sense of the load; constant outside the speeds."""
    grid, nodes = place
    found, failed = ratios_at(logs_of(grid, oil), grid, nodes, oil)
    speed = np.clip(nodes.log_speed, *np.log(grid.speeds[[0, -1]]))
    cold = np.log(lubricant_state(oil, nodes.temperature).viscosity)
    sense = np.where(nodes.load < 0, 0.1, 0.0)[:, None]
    plane = 0.01 * speed + 2e-5 * np.abs(nodes.load)[:, None] + 0.02 * cold + sense
    assert set(found) == set(CORRECTED)
    for values in found.values():
        assert np.log(values) == pytest.approx(plane, abs=1e-12)
    assert not failed.any()


def test_a_range_of_one_kelvin_is_solved_in_its_middle(screw, oil, settings):
    """Its ratio holds at both ends; a wider range has three temperatures."""
    warm = replace(settings, temperature_range=(312.65, 313.65), temperature_nodes=2)
    grid, nodes = solved_grid(screw, oil, warm), surface_nodes(Contacts.of(screw), oil, warm)
    assert grid.temperature == pytest.approx([313.15])
    assert len(nodes.temperature) == 2
    level = logs_of(grid, oil)['friction_torque'][:, :1] + np.zeros((len(grid.speeds), 1, 1))
    found, _ = ratios_at(dict.fromkeys(CORRECTED, level), grid, nodes, oil)
    for values in found.values():
        assert values[..., 0] == pytest.approx(values[..., 1], rel=1e-12)
    wider = replace(settings, temperature_range=(312.0, 314.0))
    assert len(solved_grid(screw, oil, wider).temperature) == 3


def test_nothing_passes_the_idle_load(oil, place):
    """A ratio of the relieved nut alone leaves loads beyond the idle one as they are."""
    grid, nodes = place
    logs, below = logs_of(grid, oil), grid.loads < np.mean([part[-1] for part in grid.pieces[:1]])
    changed = {name: values + 0.2 * below[:, None] for name, values in logs.items()}
    before, after = (ratios_at(one, grid, nodes, oil)[0] for one in (logs, changed))
    idle = grid.pieces[1][0] * (1 - 1e-9)
    for name in CORRECTED:
        beyond = np.abs(nodes.load) >= idle
        assert np.array_equal(before[name][:, beyond], after[name][:, beyond])
        assert not np.array_equal(before[name], after[name])


def test_points_beside_a_failure_have_no_number(oil, place):
    """To the next solved point on every side, of its sense; it takes the ratio of a neighbour."""
    grid, nodes = place
    logs = logs_of(grid, oil)
    for values in logs.values():
        values[0, 4, 1, 1] = np.nan
    found, failed = ratios_at(logs, grid, nodes, oil)
    assert all(np.isfinite(values).all() for values in found.values())
    low, high = np.log(grid.speeds[[3, 5]])
    near = (nodes.log_speed > low) & (nodes.log_speed < high)
    near &= ((nodes.load > grid.loads[0]) & (nodes.load < grid.loads[2]))[:, None]
    near &= (nodes.temperature > grid.temperature[0]) & (nodes.temperature < grid.temperature[2])
    assert near.any()
    assert np.array_equal(failed, near)


@pytest.mark.parametrize(
    ('ends', 'wanted'),
    [
        ((0.0, 1500.0), [[0.0, 1500.0]]),
        ((-300.0, 5000.0), [[0.0, 'below'], ['above', 'unloaded', 5000.0]]),
        ((400.0, 900.0), [[400.0, 900.0]]),
        ((3e3, 4e3), [[3e3, 4e3]]),
        ((-4e3, -2e3), [[2e3, 'below'], ['above', 'unloaded', 4e3]]),
    ],
)
def test_solved_loads_reach_the_ends_of_any_range(screw, oil, settings, ends, wanted):
    """With both sides of the idle load among them where the range has it."""
    marks = dict(zip(('below', 'above'), beside_idle(screw), strict=True))
    marks['unloaded'] = UNLOADING_RATIO * screw.preload
    found = solved_grid(screw, oil, replace(settings, load_range=ends))
    assert len(found.pieces) == len(wanted)
    for piece, edges in zip(found.pieces, wanted, strict=True):
        assert (np.diff(piece) > 0).all()
        outer = piece[[0, -1]] if len(edges) == 2 else piece
        assert outer == pytest.approx([marks.get(edge, edge) for edge in edges])
    assert found.speeds[[0, -1]] == pytest.approx(settings.speed_range)
    assert found.temperature[[0, -1]].tolist() == list(settings.temperature_range)


def test_a_free_screw_is_solved_under_load_alone(screw, oil, settings):
    """Without preload nothing touches at zero load."""
    (loads,) = solved_grid(replace(screw, preload=0.0), oil, settings).pieces
    assert len(loads) == len(LOADS)
    assert 0 < loads[0] < 0.01 * loads[-1]


def test_ratios_are_solved_over_formulas(screw, oil, settings, stand_in):
    """Of both senses at every point; a failed chain and a failed point leave NaN."""
    grid = solved_grid(screw, oil, settings)

    def run(tasks):
        done = stand_in.run(tasks)
        first, second, *_ = done
        done[first] = None
        done[second]['assisting'][0]['converged'] = False
        return done

    logs = solve_ratios(Contacts.of(screw), oil, grid, run)
    torque = logs['friction_torque']
    assert torque.shape == (2, len(grid.speeds), len(grid.loads), settings.solved_temperatures)
    assert np.isnan(torque[:, :, 0, 0]).all()
    assert np.isnan(torque[1, -1, 0, 1])
    assert np.isnan(torque).sum() == 2 * len(grid.speeds) + 1
    i, j, k = 3, 2, 1
    place = float(grid.speeds[i]), float(grid.loads[j]), float(grid.temperature[k])
    for sense, sign in enumerate((1, -1)):
        wanted = stand_in.torque(place[0], sign * place[1], place[2])
        assert torque[sense, i, j, k] == pytest.approx(np.log(wanted))
    assert logs['central_film'][0, i, j, k] == pytest.approx(np.log(0.9))
    assert logs['film_ratio'][0, i, j, k] == pytest.approx(0.0)


def test_films_of_formulas_end_at_the_floor(screw, oil):
    """The film ratio with them; a torque has no floor."""
    fields = dict.fromkeys(CORRECTED, np.array([1e-12, 1e-5]))
    found = with_floor(fields, screw, oil)
    assert found['central_film'] == pytest.approx([oil.film_floor, 1e-5])
    assert found['minimum_film'] == pytest.approx([oil.film_floor, 1e-5])
    assert found['film_ratio'] == pytest.approx([oil.film_floor / screw.composite_rms] * 2)
    assert np.array_equal(found['friction_torque'], fields['friction_torque'])


def test_nothing_that_converges_is_one_sentence(screw, oil, settings):
    """No ratio is known, so there is no surface."""
    with pytest.raises(InputError, match='no point of the surface converged'):
        solve_ratios(Contacts.of(screw), oil, solved_grid(screw, oil, settings), dict.fromkeys)
