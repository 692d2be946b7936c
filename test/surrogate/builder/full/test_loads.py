# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Loads: nodes beside the idle one, and where an interpolation needs more of them."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.full.columns import BESIDE
from surrogate.builder.full.loads import first_loads, refine_loads, signed_loads
from surrogate.builder.full.settings import default_full_settings, error_target
from surrogate.builder.full.speed_nodes import NodeSample
from surrogate.formulas.load_sharing import idle_load


@pytest.fixture(name='settings')
def defaults(screw):
    """Return the defaults of the nominal screw."""
    return default_full_settings(screw)


def test_nodes_sit_on_zero_and_on_both_sides_of_idle(screw, settings):
    """They are the breaks; loads of either sign; the ends of the range."""
    nodes, breaks = signed_loads(screw, settings, first_loads(screw, settings))
    idle = idle_load(screw)
    edges = [(1 - BESIDE) * idle, (1 + BESIDE) * idle]
    assert breaks == pytest.approx([-edges[1], -edges[0], 0.0, *edges])
    assert set(breaks) <= set(nodes.tolist())
    assert nodes.tolist() == (-nodes[::-1]).tolist()
    assert (nodes[0], nodes[-1]) == settings.load_range


def test_loads_crowd_towards_the_idle_one(screw, settings):
    """Each time they halve what is left of the last even cell, and no times change nothing."""
    even = first_loads(screw, replace(settings, idle_halvings=0)).shared
    crowded = first_loads(screw, settings).shared
    assert even == pytest.approx(even[-1] * np.array([0, 0.25, 0.5, 0.75, 1]))
    assert crowded == pytest.approx(even[-1] * np.array([0, 8, 16, 24, 28, 30, 31, 32]) / 32)
    below = replace(settings, load_range=(0.0, 1500.0))
    assert first_loads(screw, below).shared.tolist() == [0.0, 375.0, 750.0, 1125.0, 1500.0]


@pytest.mark.parametrize('ends', [(0.0, 1500.0), (-300.0, 5000.0), (400.0, 900.0), (3e3, 4e3)])
def test_any_range_has_its_ends_as_nodes(screw, settings, ends):
    """One-sided ones too, below and above idle."""
    asked = replace(settings, load_range=ends)
    nodes, breaks = signed_loads(screw, asked, first_loads(screw, asked))
    assert nodes[[0, -1]] == pytest.approx(ends)
    assert len(nodes) >= 2
    assert (0.0 in breaks) == (ends[0] <= 0)


@pytest.mark.parametrize('shift', [-0.5, 0.0, 0.5])
def test_a_range_that_ends_beside_idle_is_covered(screw, settings, shift):
    """Its end is a node, whichever side of it."""
    end = (1 + shift * BESIDE) * idle_load(screw)
    for ends in ((0.0, end), (end, 4000.0)):
        asked = replace(settings, load_range=ends)
        nodes, _ = signed_loads(screw, asked, first_loads(screw, asked))
        assert nodes[[0, -1]].tolist() == list(ends)


def test_a_free_screw_has_even_loads(screw, settings):
    """No idle load; zero is a break."""
    free = replace(screw, preload=0.0)
    nodes, breaks = signed_loads(free, settings, first_loads(free, settings))
    assert breaks == [0.0]
    assert len(nodes) == 2 * settings.load_cells + 1


def test_loads_crowd_where_profiles_change(screw, settings):
    """A step in RCS near 2000 N takes the nodes, and no more than are allowed."""

    def solve(loads):
        steps = np.linspace(0.5, 1.0, 3)
        return {
            float(load): NodeSample(0.05 + 0 * steps, steps / (1 + math.exp((load - 2000) / 60)))
            for load in loads
        }

    first = first_loads(screw, settings)
    pieces = refine_loads(first, solve, error_target(screw, settings), 16)
    assert len(pieces.shared) == 16 - 16 // 3
    assert len(pieces.alone) == len(first.alone)
    added = np.setdiff1d(pieces.shared, first.shared)
    assert (np.abs(added - 2000) < 700).all()


def test_without_room_nothing_is_solved(screw, settings):
    """The first loads are all that the defaults allow."""

    def solve(loads):
        raise AssertionError(f'{loads} N were solved')

    first = first_loads(screw, settings)
    assert len(first.magnitudes) == settings.load_nodes
    found = refine_loads(first, solve, error_target(screw, settings), settings.load_nodes)
    assert found.magnitudes.tolist() == first.magnitudes.tolist()
