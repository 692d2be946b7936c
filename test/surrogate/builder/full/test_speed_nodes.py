# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nodes go where the interpolation needs them and no further."""

import math

import numpy as np
import pytest
from surrogate.builder.full.speed_nodes import interpolate, NodeSample, refine_nodes, Target

TARGET = Target(ideal_torque=0.4, efficiency=0.003, rcs=0.003, rcs_relative=0.05)


def step(places):
    """Return a share that falls from 1 to 0 within half a unit around zero."""
    return {float(s): NodeSample(0.05, 1 / (1 + math.exp(20 * s))) for s in places}


def test_middles_are_met_and_nodes_crowd_the_step():
    """Between the nodes the step is within the target; most nodes lie where it is."""
    nodes = refine_nodes(np.array([-4.0, 0.0, 4.0]), step, TARGET, 40)
    assert len(nodes) < 40
    assert (np.abs(nodes) < 1).mean() >= 0.6
    known = step(nodes)
    for place in np.linspace(-3.9, 3.9, 79):
        wanted = step([place])[float(place)]
        assert TARGET.worst(interpolate(known, place), wanted) < 2


def test_a_limit_is_kept_and_the_worst_intervals_have_it():
    """Six nodes cannot follow the step; none of them is spent beside it."""
    nodes = refine_nodes(np.array([-4.0, 0.0, 4.0]), step, TARGET, 6)
    assert len(nodes) == 6
    assert (np.abs(nodes[1:-1]) <= 2).all()


def test_first_nodes_stay_where_they_are_more_than_the_limit():
    """No room for others, and none is taken."""
    first = np.linspace(-4.0, 4.0, 9)
    assert refine_nodes(first, step, TARGET, 8).tolist() == first.tolist()


def test_a_straight_line_needs_no_nodes():
    """Only the middles are tried."""
    tried = []

    def line(places):
        tried.extend(places)
        return {float(s): NodeSample(0.1 + 0.01 * s, 0.5 - 0.05 * s) for s in places}

    nodes = refine_nodes(np.array([-1.0, 0.0, 1.0]), line, TARGET, 40)
    assert nodes.tolist() == [-1.0, 0.0, 1.0]
    assert tried == [-1.0, 0.0, 1.0, -0.5, 0.5]


def test_a_solve_that_failed_is_no_node_and_hides_no_other():
    """Beside a middle without a number the worst interval still gets the last node."""

    def failing(places):
        samples = step(places)
        return samples | {place: NodeSample(math.nan, 0.0) for place in samples if place == -2}

    nodes = refine_nodes(np.array([-4.0, 0.0, 4.0]), failing, TARGET, 4)
    assert nodes.tolist() == [-4.0, 0.0, 2.0, 4.0]


def test_profiles_are_samples_too():
    """The worst place of a profile decides."""
    flat, bent = np.zeros(3), np.array([0.0, 0.0, 0.1])
    torque = np.full(3, 0.05)
    error = TARGET.worst(NodeSample(torque, bent), NodeSample(torque, flat))
    assert error == pytest.approx(0.1 / 0.003)
    known = {0.0: NodeSample(torque, flat), 1.0: NodeSample(torque, bent)}
    assert interpolate(known, 0.5).rcs == pytest.approx(bent / 2)


def test_errors_are_of_efficiency_and_of_rcs():
    """0.4 N m of ideal torque: 0.0015 N m more friction at 0.1 N m is 0.0024; RCS by its size."""
    error = TARGET.worst(NodeSample(0.1015, 0.0), NodeSample(0.1, 0.0))
    assert error == pytest.approx((0.4 / 0.5 - 0.4 / 0.5015) / 0.003)
    assert TARGET.worst(NodeSample(0.1, 0.42), NodeSample(0.1, 0.4)) == pytest.approx(1.0)
    assert TARGET.worst(NodeSample(0.1, 0.013), NodeSample(0.1, 0.01)) == pytest.approx(1.0)
