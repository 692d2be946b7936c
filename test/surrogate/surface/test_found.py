# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a lookup by hand: cells, trust regions, and what is linear between the nodes."""

import itertools
import math

import pytest
from surrogate.surface import found
from surrogate.surface.tables import SPREADS

NODES = [0.0, 1.0, 3.0, 4.0]


@pytest.mark.parametrize(
    ('value', 'cell'),
    [(0.0, 0), (0.5, 0), (1.0, 1), (2.9, 1), (3.0, 2), (4.0, 2), (-1.0, 0), (5.0, 2)],
)
def test_a_node_belongs_to_the_cell_above_it(value, cell):
    assert found.cell_below(NODES, value) == cell
    assert found.fraction_of(NODES, cell, NODES[cell] + 0.25 * found.width_of(NODES, cell)) == 0.25


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
    assert found.bump(fraction, centre) == pytest.approx(height)


@pytest.mark.parametrize('place', [(0.25, 0.5, 0.125), (0.0, 1.0, 0.5), (1.0, 1.0, 1.0)])
def test_spreads_are_linear_along_each_axis(place):
    """(1 + x)(1 + 2 y)(1 + 4 z) at the corners of a cell is that everywhere in it."""
    value = lambda x, y, z: (1.0 + x) * (1.0 + 2.0 * y) * (1.0 + 4.0 * z)  # noqa: E731
    across, along = 3 * SPREADS, 15 * SPREADS
    table = [math.nan] * (along + across + 2 * SPREADS)
    for x, y, z in itertools.product((0, 1), repeat=3):
        table[x * along + y * across + z * SPREADS] = value(x, y, z)
    weights = found.corner_weights(*place)
    assert found.spread(table, 0, across, along, weights) == pytest.approx(value(*place))


def test_shares_and_exponentials_stay_in_their_range():
    assert [found.share(value) for value in (-1e-9, 0.5, 1.0 + 1e-9)] == [0.0, 0.5, 1.0]
    assert math.isnan(found.share(math.nan))
    assert found.exponential(709.0) == math.exp(709.0)
    assert found.exponential(709.1) == found.exponential(1e9) == math.inf
    assert (found.part(0.5, 3.0), found.part(0.0, math.nan)) == (1.5, 0.0)
