# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Which temperatures are solved, which stand in the file, and what lies between."""

import numpy as np
import pytest
from surrogate.builder.full.temperatures import (
    between,
    file_temperatures,
    log_viscosity,
    solved_temperatures,
)

WIDE = (283.15, 353.15)


def test_ends_and_the_reference_are_solved(oil):
    """10, 40 and 80 degC."""
    assert solved_temperatures(oil, WIDE).tolist() == [283.15, 313.15, 353.15]


def test_without_a_reference_inside_the_middle_of_the_viscosity_is(oil):
    """Equal factors of viscosity to either side."""
    solved = solved_temperatures(oil, (323.15, 353.15))
    x = log_viscosity(oil, solved)
    assert x[1] == pytest.approx(0.5 * (x[0] + x[2]), abs=1e-4)


def test_a_narrow_range_is_solved_once(oil):
    """Between its ends, which are the nodes of the file."""
    ends = (312.15, 314.15)
    solved = solved_temperatures(oil, ends)
    assert len(solved) == 1
    assert ends[0] < solved[0] < ends[1]
    assert file_temperatures(oil, ends, solved, 7).tolist() == list(ends)


@pytest.mark.parametrize('count', [2, 3, 5, 7, 9])
def test_solved_temperatures_are_nodes_of_the_file(oil, count):
    """Rising, from end to end, even in viscosity between those solved."""
    solved = solved_temperatures(oil, WIDE)
    nodes = file_temperatures(oil, WIDE, solved, count)
    assert set(solved) <= set(nodes)
    assert (np.diff(nodes) > 0).all()
    assert len(nodes) == max(count, 3)
    steps = np.diff(log_viscosity(oil, nodes))
    half = len(steps) // 2
    for part in (steps[:half], steps[half:]):
        assert part == pytest.approx(part.mean(), rel=1e-3)


def test_smooth_fields_follow_a_square_and_shares_a_line():
    """Exact for what they are; shares stay between their neighbours."""
    x, wanted = np.array([3.0, 1.0, 0.0]), np.array([3.0, 2.2, 1.0, 0.3, 0.0])
    square = np.array([[2.0], [5.0]]) * x**2 + x
    expected = np.array([[2.0], [5.0]]) * wanted**2 + wanted
    assert between(x, square, wanted, smooth=True) == pytest.approx(expected)
    line = between(x, np.array([[0.1, 0.5, 0.2]]), wanted, smooth=False)
    assert line == pytest.approx(np.array([[0.1, 0.26, 0.5, 0.29, 0.2]]))


def test_one_temperature_says_it_for_all():
    """Both kinds of fields."""
    values = np.array([[1.0], [2.0]])
    for smooth in (True, False):
        found = between(np.array([1.0]), values, np.array([1.1, 0.9]), smooth=smooth)
        assert found == pytest.approx(np.array([[1.0, 1.0], [2.0, 2.0]]))
