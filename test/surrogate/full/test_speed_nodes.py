# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nodes go where the interpolation needs them and no further."""

import math

import numpy as np
import pytest
from surrogate.full.speed_nodes import interpolate, refine_nodes, Sample, Target

TARGET = Target(ideal_torque=0.4, efficiency=0.003, rcs=0.003, rcs_relative=0.05)


def step(places):
    """Return a share that falls from 1 to 0 within half a unit around zero."""
    return {float(s): Sample(0.05, 1 / (1 + math.exp(20 * s))) for s in places}


def test_middles_are_met_and_nodes_crowd_the_step():
    """Between the nodes the step is within the target; most nodes lie where it is."""
    nodes, left = refine_nodes(np.array([-4.0, 0.0, 4.0]), step, TARGET, 40)
    assert left <= 1
    assert len(nodes) < 40
    assert (np.abs(nodes) < 1).mean() >= 0.6
    known = step(nodes)
    for place in np.linspace(-3.9, 3.9, 79):
        wanted = step([place])[float(place)]
        assert TARGET.worst(interpolate(known, place), wanted) < 2


def test_a_limit_is_kept_and_what_is_left_is_said():
    """Six nodes cannot follow the step: the error over the allowed one comes back."""
    nodes, left = refine_nodes(np.array([-4.0, 0.0, 4.0]), step, TARGET, 6)
    assert len(nodes) == 6
    assert left > 1


def test_first_nodes_stay_where_they_are_more_than_the_limit():
    """No room for others, and none is taken."""
    first = np.linspace(-4.0, 4.0, 9)
    nodes, left = refine_nodes(first, step, TARGET, 8)
    assert nodes.tolist() == first.tolist()
    assert left > 1


def test_a_straight_line_needs_no_nodes():
    """Only the middles are tried."""
    tried = []

    def line(places):
        tried.extend(places)
        return {float(s): Sample(0.1 + 0.01 * s, 0.5 - 0.05 * s) for s in places}

    nodes, left = refine_nodes(np.array([-1.0, 0.0, 1.0]), line, TARGET, 40)
    assert nodes.tolist() == [-1.0, 0.0, 1.0]
    assert left < 1e-9
    assert tried == [-1.0, 0.0, 1.0, -0.5, 0.5]


def test_a_solve_that_failed_is_not_met():
    """A middle without a number is no node, and what is left is not known."""

    def failing(places):
        return {float(s): Sample(math.nan if abs(s) == 0.5 else 0.1, 0.0) for s in places}

    nodes, left = refine_nodes(np.array([0.0, 1.0]), failing, TARGET, 5)
    assert nodes.tolist() == [0.0, 1.0]
    assert math.isnan(left)


def test_errors_are_of_efficiency_and_of_rcs():
    """0.4 N m of ideal torque: 0.0015 N m more friction at 0.1 N m is 0.0024; RCS by its size."""
    error = TARGET.worst(Sample(0.1015, 0.0), Sample(0.1, 0.0))
    assert error == pytest.approx((0.4 / 0.5 - 0.4 / 0.5015) / 0.003)
    assert TARGET.worst(Sample(0.1, 0.42), Sample(0.1, 0.4)) == pytest.approx(1.0)
    assert TARGET.worst(Sample(0.1, 0.013), Sample(0.1, 0.01)) == pytest.approx(1.0)
