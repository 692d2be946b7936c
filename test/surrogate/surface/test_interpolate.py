# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a lookup by hand: cells, trust regions, and what is linear between the nodes."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from surrogate.surface import interpolate
from surrogate.surface.fields import FIELDS
from surrogate.surface.tables import ONSETS, SPREADS, WIDTH

NODES = [0.0, 1.0, 3.0, 4.0]


@pytest.mark.parametrize(
    ('value', 'cell'),
    [(0.0, 0), (0.5, 0), (1.0, 1), (2.9, 1), (3.0, 2), (4.0, 2), (-1.0, 0), (5.0, 2)],
)
def test_a_node_belongs_to_the_cell_above_it(value, cell):
    assert interpolate.cell_below(NODES, value) == cell
    assert (
        interpolate.fraction_of(
            NODES, cell, NODES[cell] + 0.25 * interpolate.width_of(NODES, cell)
        )
        == 0.25
    )


@pytest.mark.parametrize(
    ('fraction', 'centre', 'height'),
    [
        (0.5, 0.5, 1.0),
        (0.25, 0.5, 0.5),
        (0.375, 0.5, 0.84375),
        (0.5, 0.75, 0.5),  # half a cell at most
        (0.25, 0.75, 0.0),
        (0.0, 0.75, 0.0),
        (0.875, 0.75, 0.5),  # and up to the end of the cell
        (1.0, 0.75, 0.0),
        (0.0, 0.0, 1.0),
        (0.25, 0.0, 0.5),
    ],
)
def test_a_trust_region_is_a_smoothstep_up_and_down(fraction, centre, height):
    assert interpolate.bump(fraction, centre) == pytest.approx(height)


@pytest.mark.parametrize('place', [(0.25, 0.5, 0.125), (0.0, 1.0, 0.5), (1.0, 1.0, 1.0)])
def test_spreads_are_linear_along_each_axis(place):
    """(1 + x)(1 + 2 y)(1 + 4 z) at the corners of a cell is that everywhere in it."""
    value = lambda x, y, z: (1.0 + x) * (1.0 + 2.0 * y) * (1.0 + 4.0 * z)  # noqa: E731
    across, along = 3 * SPREADS, 15 * SPREADS
    table = [math.nan] * (along + across + 2 * SPREADS)
    for x, y, z in itertools.product((0, 1), repeat=3):
        table[x * along + y * across + z * SPREADS] = value(x, y, z)
    weights = interpolate.corner_weights(*place)
    assert interpolate.spread(table, 0, across, along, weights) == pytest.approx(value(*place))


def test_shares_and_exponentials_stay_in_their_range():
    assert [interpolate.share(value) for value in (-1e-9, 0.5, 1.0 + 1e-9)] == [0.0, 0.5, 1.0]
    assert math.isnan(interpolate.share(math.nan))
    assert interpolate.exponential(709.0) == math.exp(709.0)
    assert interpolate.exponential(709.1) == interpolate.exponential(1e9) == math.inf
    assert (interpolate.part(0.5, 3.0), interpolate.part(0.0, math.nan)) == (1.5, 0.0)


AXES = np.array([0.0, 0.5, 1.5]), np.array([-1.0, 1.0, 4.0, 4.5]), np.array([2.0, 3.0, 5.0, 9.0])
"""Speeds, loads and temperatures of a table."""


def cubics(x, y, z):
    """Return a sum of cubics, another one for each field, and its slopes along the axes."""
    a = 1.0 + np.arange(len(FIELDS))
    value = x**3 + a * y**3 - 2.0 * y + 0.5 * z**3 - a * a * z + a
    return np.stack([value, 3.0 * x**2 + 0.0 * a, 3.0 * a * y**2 - 2.0, 1.5 * z**2 - a * a])


def test_a_sum_of_cubics_comes_back_in_every_cell():
    """Value and slopes of every node and every field count, with weights that add up."""
    table = np.array([[[cubics(x, y, z) for z in AXES[2]] for y in AXES[1]] for x in AXES[0]])
    across, along = len(AXES[2]), len(AXES[1])
    values, onset = table.ravel(), table[0, :, :, :, 2][:, :, [0, 2, 3]].ravel()
    assert (table[0, 0, 0].size, onset.size) == (WIDTH, ONSETS * across * along)
    for i, j, k in np.ndindex(*(len(axis) - 1 for axis in AXES)):
        u, v, w = 0.25, 0.625, 0.375
        place = [
            axis[cell] + part * (axis[cell + 1] - axis[cell])
            for axis, cell, part in zip(AXES, (i, j, k), (u, v, w))
        ]
        face = interpolate.face_weights(AXES[1], j, v, AXES[2], k, w)
        fast = interpolate.hermite_weights(interpolate.width_of(AXES[0], i), u)
        node = (i * along + j) * across + k
        back = [
            interpolate.field(values, name, node, across, along, fast, face)
            for name in range(len(FIELDS))
        ]
        assert back == pytest.approx(cubics(*place)[0], rel=1e-12, abs=1e-10)
        begins = interpolate.onset_on_face(onset, j * across + k, across, face)
        assert begins == pytest.approx(cubics(AXES[0][0], *place[1:])[0][2], rel=1e-12, abs=1e-10)


def test_a_point_without_an_answer_is_as_if_nothing_had_been_found():
    """Whatever an earlier point has left; the two halves together leave nothing of it."""
    used = interpolate.Found(**{one.name: 1 for one in dataclasses.fields(interpolate.Found)})
    assert interpolate.leave(used, interpolate.MASKED) == interpolate.MASKED
    judged = {'validity', 'corrected', 'worst_contact', 'rcs', 'efficiency', 'film_ratio'}
    judged |= {'friction_torque', 'driving_torque', *(n for n in used.__slots__ if '_cell' in n)}
    judged |= {name for name in used.__slots__ if name.endswith('_fraction')}
    fresh = interpolate.Found(validity=interpolate.MASKED)
    for name in used.__slots__:
        left = getattr(fresh, name) if name in judged else 1
        np.testing.assert_equal(getattr(used, name), left, name)
    interpolate.leave_rest(used)
    assert repr(used) == repr(fresh)


@pytest.mark.parametrize(('contact', 'nut', 'side'), [(-1, 0, 0), (0, 1, 1), (1, 1, 2), (2, 2, 1)])
def test_contacts_count_by_nut_and_side(contact, nut, side):
    place = interpolate.Found(worst_contact=contact)
    assert (place.worst_nut, place.worst_side) == (nut, side)
