# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lines of total pressure, kind by kind, and of film pressure on contact nodes, in their box."""

import numpy as np
import pytest
from scipy.signal import convolve2d
from surrogate.ehl.kernels import line
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
    mask = np.zeros(SHAPE, bool)
    for node in nodes:
        mask[node] = True
    return mask


NEAR = np.array([1.0, 0.2, 0.1, 0.05])


def solve(planes, contact, rhs, total, steps, box):
    """Return the film pressure after some line steps."""
    film, work, found = np.zeros((5, *SHAPE)), np.full((2, *SHAPE), np.nan), np.zeros(SHAPE)
    line.film_factors(planes, contact, film)
    line.solve_film_lines(film, contact, box, rhs, total, steps, False, work, found)
    return found


def solved_lines(planes, contact, rhs, steps, start=None, symmetric=False, periodic=False):
    """Return the total pressure after some steps, with gap planes a tenth of the pressure's."""
    nx, ny = rhs.shape
    half = line.lines_of_a_kind(ny)
    bands, sides = np.zeros((2, 5, nx, half)), np.zeros((2, 6, nx, half))
    line.line_factors(planes, 0.1 * planes, contact, NEAR, np.float64(1.0), bands, sides)
    found, work = np.zeros((nx, ny)) if start is None else start.copy(), np.zeros((6, nx, half))
    started = start is not None
    line.solve_lines(bands, sides, rhs, steps, started, symmetric, periodic, work, found)
    return found


def rows(planes, contact, pressure):
    """Return what the rows say of a pressure: near kernel in a line and beside it [-]."""
    k0, k1, m0, m1 = NEAR
    wide = np.pad(pressure, 3)
    lift = convolve2d(wide, [[m1, k1, m1], [m0, k0, m0], [m1, k1, m1]], mode='same')

    def seen(field, along, across=0):
        return np.roll(field, (-along, -across), axis=(0, 1))[3:-3, 3:-3]

    free = 0.1 * (
        planes[0] * lift[3:-3, 3:-3] + planes[1] * seen(lift, -1) + planes[5] * seen(lift, -2)
    )
    for plane, place in zip(planes, [(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-2, 0)]):
        free += plane * seen(wide, *place)
    return np.where(contact, lift[3:-3, 3:-3], free)


CONTACTS = {
    'inside': marked((4, 5), (5, 5), (5, 6), (7, 9)),
    'at all borders': marked((1, 1), (1, 12), (9, 1), (9, 12), (5, 5)),
    'one': marked((3, 12)),
}


def inner(field):
    return field[1:-1, 1:-1]


@pytest.mark.parametrize('contact', CONTACTS.values(), ids=CONTACTS)
@pytest.mark.parametrize('across', [SHAPE[1], SHAPE[1] - 1], ids=('even', 'odd'))
def test_many_steps_solve_the_rows_of_all_lines(planes, contact, across):
    contact, planes = contact[:, :across], planes[..., :across]
    rhs, start = np.random.default_rng(8).normal(size=(2, SHAPE[0], across))
    start[[0, -1]] = start[:, [0, -1]] = 0
    for begin in (None, start):
        found = solved_lines(planes, contact, rhs, 80, begin)
        assert inner(rows(planes, contact, found)) == pytest.approx(inner(rhs), abs=1e-9)
        assert not found[[0, -1]].any()
        assert not found[:, [0, -1]].any()


def test_a_step_solves_every_other_line(planes):
    """Odd lines first, with nothing on the even ones; these next, with the odd ones held."""
    contact, rhs = CONTACTS['inside'], np.random.default_rng(9).normal(size=SHAPE)
    once, twice = (solved_lines(planes, contact, rhs, steps) for steps in (1, 2))
    assert not once[:, ::2].any()
    assert rows(planes, contact, once)[1:-1, 1:-1:2] == pytest.approx(rhs[1:-1, 1:-1:2], abs=1e-12)
    np.testing.assert_array_equal(twice[:, 1::2], once[:, 1::2])
    expected = rhs[1:-1, 2:-1:2]
    assert rows(planes, contact, twice)[1:-1, 2:-1:2] == pytest.approx(expected, abs=1e-12)


def test_half_of_a_symmetric_field_is_solved_as_the_whole(planes):
    """Column 1 is the axis, column 0 the mirror image of column 2."""
    contact, rhs = CONTACTS['inside'], np.random.default_rng(10).normal(size=SHAPE)
    planes[3, :, 1] = planes[4, :, 1]

    def whole(field):
        return np.concatenate([field[..., :1:-1], field[..., 1:]], axis=-1)

    both = whole(planes)
    both[[3, 4], :, : SHAPE[1] - 2] = both[[4, 3], :, : SHAPE[1] - 2]
    found = solved_lines(planes, contact, rhs, 80, symmetric=True)
    wanted = solved_lines(both, whole(contact), whole(rhs), 80)
    _, half = np.split(wanted, [SHAPE[1] - 2], axis=1)
    assert found[:, 1:] == pytest.approx(half, abs=1e-9)
    np.testing.assert_array_equal(found[:, 0], found[:, 2])


@pytest.mark.parametrize('contact', CONTACTS.values(), ids=CONTACTS)
def test_lines_of_a_period_reach_across_its_sides(planes, contact):
    """The rows hold with the copies on both sides, whatever stood there before."""
    rhs, start = np.random.default_rng(12).normal(size=(2, *SHAPE))
    start[[0, -1]] = 0
    for begin in (None, start):
        found = solved_lines(planes, contact, rhs, 120, begin, periodic=True)
        assert inner(rows(planes, contact, found)) == pytest.approx(inner(rhs), abs=1e-9)
        np.testing.assert_array_equal(found[:, 0], found[:, -2])
        np.testing.assert_array_equal(found[:, -1], found[:, 1])
    other = start.copy()
    other[:, [0, -1]] = 7.0
    few = [solved_lines(planes, contact, rhs, 2, begin, periodic=True) for begin in (start, other)]
    np.testing.assert_array_equal(*few)


@pytest.mark.parametrize('across', [7, 8])
def test_kinds_join_to_what_was_parted(across):
    field, again = np.random.default_rng(11).normal(size=(5, across)), np.zeros((5, across))
    kinds = np.zeros((2, 5, line.lines_of_a_kind(across)))
    line.part(field, kinds)
    line.join(kinds, again)
    np.testing.assert_array_equal(again, field)
    np.testing.assert_array_equal(kinds[1, :, : across // 2], field[:, 1::2])


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
    rng = np.random.default_rng(7)
    rhs, total = rng.normal(size=(2, *SHAPE))
    total[[0, -1]] = total[:, [0, -1]] = 0
    for steps in (1, 3):
        boxed = solve(planes, contact, rhs, total, steps, contact_box(contact))
        np.testing.assert_array_equal(boxed, solve(planes, contact, rhs, total, steps, WHOLE))


def test_the_box_has_a_node_to_spare_off_the_border():
    assert contact_box(CONTACTS['inside']) == (3, 9, 4, 11)
    assert contact_box(CONTACTS['at all borders']) == WHOLE
    assert contact_box(CONTACTS['one']) == (2, 5, 11, 13)
    assert contact_box(marked()) == (1, 1, 1, 1)
