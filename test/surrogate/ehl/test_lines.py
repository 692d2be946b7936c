# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lines of film pressure on contact nodes: their equations, and the box that they keep to."""

import numpy as np
import pytest
from surrogate.ehl._line import line_factors, solve_film_lines
from surrogate.ehl.linear import contact_box

SHAPE = (11, 14)
WHOLE = (1, SHAPE[0] - 1, 1, SHAPE[1] - 1)


@pytest.fixture(name='planes')
def make_planes():
    """Return pressure planes of unlike rows with dominant diagonals."""
    planes = -np.random.default_rng(5).uniform(0.1, 1.0, (6, *SHAPE))
    planes[0] = 0.5 - planes[1:].sum(axis=0)
    return planes


def marked(*nodes):
    """Return a mask of nodes."""
    mask = np.zeros(SHAPE, bool)
    for node in nodes:
        mask[node] = True
    return mask


def solve(planes, contact, rhs, total, steps, box):
    """Return the film pressure after some line steps."""
    bands, sides = np.zeros((5, *SHAPE)), np.zeros((6, *SHAPE))
    film_bands, work = np.zeros((3, *SHAPE)), np.full((3, *SHAPE), np.nan)
    near = np.array([1.0, 0.2, 0.1, 0.05])
    line_factors(planes, planes, contact, near, np.float64(1.0), bands, sides, film_bands)
    found = np.zeros(SHAPE)
    solve_film_lines(planes, film_bands, contact, box, rhs, total, steps, False, work, found)
    return found


CONTACTS = {
    'inside': marked((4, 5), (5, 5), (5, 6), (7, 9)),
    'at all borders': marked((1, 1), (1, 12), (9, 1), (9, 12), (5, 5)),
    'one': marked((3, 12)),
}


@pytest.mark.parametrize('contact', CONTACTS.values(), ids=CONTACTS)
def test_film_lines_solve_the_rows_of_contact_nodes(planes, contact):
    """Without the second west plane, from the total pressure around."""
    rng = np.random.default_rng(6)
    rhs, total = rng.normal(size=SHAPE), np.zeros(SHAPE)
    total[1:-1, 1:-1] = rng.normal(size=(SHAPE[0] - 2, SHAPE[1] - 2))
    found = solve(planes, contact, rhs, total, 60, contact_box(contact))
    assert found[~contact] == pytest.approx(total[~contact], abs=0)
    for i, j in zip(*np.nonzero(contact), strict=True):
        row = (
            planes[0, i, j] * found[i, j]
            + planes[1, i, j] * found[i - 1, j]
            + planes[2, i, j] * found[i + 1, j]
            + planes[3, i, j] * found[i, j - 1]
            + planes[4, i, j] * found[i, j + 1]
        )
        assert row == pytest.approx(rhs[i, j], abs=1e-9)


@pytest.mark.parametrize('contact', CONTACTS.values(), ids=CONTACTS)
def test_the_box_changes_no_bit(planes, contact):
    """Same as on the whole grid after one step and after three."""
    rng = np.random.default_rng(7)
    rhs, total = rng.normal(size=(2, *SHAPE))
    total[[0, -1]] = total[:, [0, -1]] = 0
    for steps in (1, 3):
        boxed = solve(planes, contact, rhs, total, steps, contact_box(contact))
        np.testing.assert_array_equal(boxed, solve(planes, contact, rhs, total, steps, WHOLE))


def test_the_box_has_a_node_to_spare_off_the_border():
    """Ends are excluded; nothing is in the box of no contact."""
    assert contact_box(CONTACTS['inside']) == (3, 9, 4, 11)
    assert contact_box(CONTACTS['at all borders']) == WHOLE
    assert contact_box(CONTACTS['one']) == (2, 5, 11, 13)
    assert contact_box(marked()) == (1, 1, 1, 1)
