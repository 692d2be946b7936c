# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Hermite interpolation: slopes, breaks, holes, weights."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface.hermite import (
    first_rows,
    hermite_weights,
    monotone_slopes,
    patch_table,
    patch_weights,
    split_at,
)

NONE = np.empty(0)


def curve(nodes, values, breaks=NONE):
    """Return a function of one dimension by the same table and weights as the lookup."""
    table, first = patch_table([nodes], [breaks], values), first_rows(nodes, breaks)

    def at(x):
        cell = min(int(np.searchsorted(nodes, x, side='right')) - 1, len(nodes) - 2)
        width = nodes[cell + 1] - nodes[cell]
        weights = hermite_weights(width, (x - nodes[cell]) / width)
        return float(np.dot(weights, table[[first[cell], first[cell] + 1]].ravel()))

    return at


def interpolate(nodes, values, x, breaks=NONE):
    return curve(nodes, values, breaks)(x)


@given(
    st.lists(st.floats(0.01, 10), min_size=3, max_size=9),
    st.lists(st.floats(0, 10), min_size=9, max_size=9),
)
def test_rising_data_rise_between_the_nodes(widths, rises):
    """Monotone in, monotone out."""
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    values = np.concatenate([[0.0], np.cumsum(rises)])[: len(nodes)]
    fine = np.linspace(nodes[0], nodes[-1], 200)
    found = np.array([*map(curve(nodes, values), fine)])
    assert np.all(np.diff(found) >= -1e-9 * max(values[-1], 1))


def test_straight_lines_are_exact_and_nodes_are_hit():
    nodes = np.array([0.0, 1.0, 3.0, 4.0])
    assert monotone_slopes(nodes, 2 * nodes + 1) == pytest.approx(np.full(4, 2.0))
    values = np.array([1.0, 5.0, 2.0, 2.0])
    for node, value in zip(nodes, values, strict=True):
        assert interpolate(nodes, values, node) == value


@pytest.mark.parametrize('scale', [1e-3, -1e-3, 1.0, 1e3])
def test_slopes_are_those_of_fritsch_and_butland(scale):
    """
    Closed forms: within, the weighted harmonic mean of two secants or 0 at an extremum.

    At an end three points, exact for a parabola, but at most three secants, and never against one.

    """
    nodes = np.array([1.0, 2.0, 4.0, 5.0])
    found = monotone_slopes(nodes, scale * nodes**2)
    assert found[[0, -1]] == pytest.approx(scale * np.array([2.0, 10.0]))
    # Widths 1, 2, 1 and secants 3, 6, 9.
    expected = [9 / (5 / 3 + 4 / 6), 9 / (4 / 6 + 5 / 9)]
    assert found[1:-1] == pytest.approx(scale * np.array(expected))
    even = np.array([0.0, 1.0, 2.0])
    for rises, slopes in (
        ((1.0, -10.0), (3.0, 0.0, -15.5)),
        ((10.0, -1.0), (15.5, 0.0, -3.0)),
        ((1.0, 10.0), (0.0, 20 / 11, 14.5)),
        ((0.0, 2.0), (0.0, 0.0, 3.0)),
        ((2.0, -2.0), (4.0, 0.0, -4.0)),
    ):
        values = scale * np.concatenate([[0.0], np.cumsum(rises)])
        assert monotone_slopes(even, values) == pytest.approx(scale * np.array(slopes))


def test_smooth_monotone_data_converge_at_second_order_or_better():
    """Halving the cells of exp(x) cuts the error by more than four."""

    def error(cells):
        nodes = np.linspace(0, 2, cells + 1)
        fine = np.linspace(0, 2, 301)
        found = curve(nodes, np.exp(nodes))
        return max(abs(found(x) - np.exp(x)) for x in fine)

    assert error(16) / error(32) > 4


def test_a_break_keeps_a_kink_and_changes_nothing_at_an_end():
    """|x| is exact with a break at zero, and rounded off without."""
    nodes = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    with_break = interpolate(nodes, np.abs(nodes), 0.3, np.array([0.0]))
    assert with_break == pytest.approx(0.3, abs=1e-15)
    assert interpolate(nodes, np.abs(nodes), 0.3) < 0.29
    nodes = np.array([0.0, 1.0, 2.0])
    assert split_at(nodes, np.array([0.0, 2.0])) == [slice(0, 3)]
    assert first_rows(nodes, np.array([1.0])) == [0, 2]


def test_a_hole_or_a_change_spoils_only_the_cells_beside_it():
    """Beside a NaN the slope is one-sided; two cells away nothing changes, to the last bit."""
    nodes = np.arange(7.0)
    values = nodes**2
    holed = values.copy()
    holed[3] = np.nan
    slopes, expected = monotone_slopes(nodes, holed), monotone_slopes(nodes, values)
    assert np.isnan(slopes[3])
    assert np.all(np.isfinite(np.delete(slopes, 3)))
    assert slopes[[0, 1, 5, 6]] == pytest.approx(expected[[0, 1, 5, 6]])
    assert slopes[[2, 4]] == pytest.approx([3.0, 9.0])  # secants of 1 to 2 and of 4 to 5
    assert not monotone_slopes(nodes, np.array([0.0, *[-0.0] * 6])).any()
    nodes = np.arange(9.0)
    values = np.exp(-nodes)
    changed = values.copy()
    changed[4] *= 1.1
    for x in (0.5, 1.5, 6.5, 7.5):
        assert interpolate(nodes, values, x) == interpolate(nodes, changed, x)
    assert interpolate(nodes, values, 4.5) != interpolate(nodes, changed, 4.5)


@given(*[st.floats(0, 1)] * 2)
def test_patch_weights_reproduce_planes(x, y):
    """Value weights sum to one and a plane is exact."""
    weights = np.array(patch_weights(*(hermite_weights(1.0, t) for t in (x, y)))).reshape(4, 3)
    assert weights[:, 0].sum() == pytest.approx(1.0)
    corners = np.array([[value, 3.0, 5.0] for value in (0.0, 5.0, 3.0, 8.0)])
    assert (weights * corners).sum() == pytest.approx(3 * x + 5 * y, abs=1e-12)


def test_tables_of_several_axes_agree_with_one_axis_each():
    """A table over two axes holds, per axis, the slopes of one dimension."""
    a, b = np.array([0.0, 1.0, 3.0]), np.array([-1.0, 0.0, 2.0, 5.0])
    values = np.outer(a**2 + 1, np.exp(b))
    table = patch_table([a, b], [NONE, np.array([0.0])], values)
    assert table.shape == (3, 5, 3)
    assert table[:, 0, 1] == pytest.approx(monotone_slopes(a, values[:, 0]))
    assert table[1, 2:, 2] == pytest.approx(monotone_slopes(b[1:], values[1, 1:]))
