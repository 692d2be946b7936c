# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bands of thick film: which nodes they take, their equations, and what they spare GMRES."""

import numpy as np
import pytest
from surrogate.ehl.kernels.bands import (
    _assemble,
    BAND,
    bands_across,
    factor_bands,
    mark_thick_film,
    solve_bands,
)
from surrogate.ehl.kernels.line import line_factors, lines_of_a_kind, solve_lines

NX = 12


@pytest.fixture(name='planes')
def make_planes():
    """Return pressure planes of unlike rows, dominant diagonals, on a grid with a narrow band."""
    drawn = np.random.default_rng(4)
    planes = -drawn.uniform(0.1, 1.0, (6, NX, 2 * BAND + 7)).astype(np.float32)
    planes[0] = 1.5 - planes[1:].sum(axis=0)
    return planes


def solve(planes, thick, rhs):
    """Return the values that the bands give to the nodes."""
    count = bands_across(thick.shape[1])
    rows = np.ones((NX * count, 2 * count + 1), np.float32)
    lower = np.ones((NX * count, count), np.float32)
    values, found = np.ones((NX + 1) * count, np.float32), np.zeros_like(rhs)
    found[1:-1, 1:-1] = 1
    factor_bands(planes, thick, rows, lower)
    solve_bands(rows, lower, thick, rhs, values, found)
    return found


def apply(planes, x):
    """Return the rows of the full equations times a field that is zero on the border."""
    out = np.zeros_like(x)
    for i in range(1, x.shape[0] - 1):
        for j in range(1, x.shape[1] - 1):
            west = planes[5, i, j] * x[i - 2, j] if i > 1 else 0
            out[i, j] = (
                planes[0, i, j] * x[i, j]
                + planes[1, i, j] * x[i - 1, j]
                + planes[2, i, j] * x[i + 1, j]
                + planes[3, i, j] * x[i, j - 1]
                + planes[4, i, j] * x[i, j + 1]
                + west
            )
    return out


def inner(shape, part=slice(None)):
    thick = np.zeros(shape, np.float32)
    thick[1:-1, 1:-1] = 1
    thick[np.setdiff1d(np.arange(shape[0]), np.arange(shape[0])[part])] = 0
    return thick


def test_a_band_alone_has_the_sum_of_its_rows(planes):
    """With one row thick, and no flow to other bands, bands are weighted means."""
    planes[3, :, 1::BAND] = planes[4, :, BAND::BAND] = 0
    thick = inner(planes.shape[1:], slice(4, 5))
    rhs = np.random.default_rng(1).normal(size=thick.shape).astype(np.float32)
    found = solve(planes, thick, rhs)
    for first in range(1, thick.shape[1] - 1, BAND):
        band = slice(first, min(first + BAND, thick.shape[1] - 1))
        rows = planes[0, 4, band].sum()
        rows += planes[3, 4, band][1:].sum() + planes[4, 4, band][:-1].sum()
        assert found[4, band] == pytest.approx(rhs[4, band].sum() / rows, rel=1e-5)
    assert not found[[3, 5]].any()


def test_pressure_without_change_across_is_found(planes):
    """Rows that are alike across: the answer of one line, but beside the edges where it is 0."""
    planes[:] = planes[:, :, 5:6]
    planes[0] -= planes[3] + planes[4]
    planes[3:5] = 0
    planes[0] += 2e-3
    planes[5, 2:] = 0
    line = np.random.default_rng(2).normal(size=NX)
    line[[0, -1]] = 0
    thick = inner(planes.shape[1:])
    field = (thick * line[:, None]).astype(np.float32)
    assert solve(planes, thick, apply(planes, field)) == pytest.approx(field, abs=1e-4)


def test_what_is_thin_or_in_contact_or_empty_has_no_part():
    """Flow has to outweigh deflection by far; contact and cavities have rows of another kind."""
    flow, lift = np.ones((6, 5, 6), np.float32), np.zeros((6, 5, 6), np.float32)
    contact, sizes = np.zeros((5, 6), bool), np.ones((5, 6), np.float32)
    near, thick = np.array([2.0, 0, 0, 0], np.float32), np.full((5, 6), 7, np.float32)
    thick[[0, -1]] = thick[:, [0, -1]] = 0
    lift[0, 2, 2], contact[2, 3], sizes[3, 3] = 0.1, True, 0
    assert mark_thick_film(flow, lift, contact, sizes, near, thick)
    wanted = inner((5, 6))
    wanted[[2, 2, 3], [2, 3, 3]] = 0
    assert np.array_equal(thick, wanted)
    assert not mark_thick_film(flow, lift, contact | True, sizes, near, thick)
    assert not thick.any()


def test_lines_from_bands_leave_less_of_a_slow_wave():
    """What changes little across hardly decays by line steps; the bands take most of it."""
    nx, ny = 40, 6 * BAND + 2
    planes = np.zeros((6, nx, ny), np.float32)
    planes[1:3], planes[3:5] = -1, -0.3
    planes[0] = 2.6
    half, near = lines_of_a_kind(ny), np.zeros(4, np.float32)
    lines = np.zeros((2, 5, nx, half), np.float32)
    sides = np.zeros((2, 6, nx, half), np.float32)
    touches, none = np.zeros((nx, ny), bool), np.zeros_like(planes)
    line_factors(planes, none, touches, near, np.float32(1), lines, sides)
    x, y = np.arange(nx)[:, None] / (nx - 1), np.arange(ny)[None, :] / (ny - 1)
    wave = (np.sin(np.pi * x) * np.sin(np.pi * y)).astype(np.float32)
    wave[[0, -1]] = wave[:, [0, -1]] = 0
    rhs, work = apply(planes, wave), np.zeros((6, nx, half), np.float32)
    rest = {}
    for started in (False, True):
        found = np.zeros_like(wave)
        if started:
            count = bands_across(ny)
            rows = np.zeros((nx * count, 2 * count + 1), np.float32)
            lower = np.zeros((nx * count, count), np.float32)
            thick, values = inner((nx, ny)), np.zeros((nx + 1) * count, np.float32)
            factor_bands(planes, thick, rows, lower)
            solve_bands(rows, lower, thick, rhs, values, found)
        solve_lines(lines, sides, rhs, 4, started, False, False, work, found)
        rest[started] = np.abs(found - wave).max()
    assert rest[False] > 0.8
    assert rest[True] < 0.3 * rest[False]


@pytest.mark.parametrize(
    ('plane', 'node', 'beside'), [(3, 1 + BAND, -1), (4, BAND, 1), (3, 1, 0), (4, 2 * BAND + 5, 0)]
)
def test_a_step_to_the_next_band_is_as_long_as_a_band(plane, node, beside):
    """A share of the flow over an inner edge joins the next band, none of that over a side."""
    shape = (NX, 2 * BAND + 7)
    planes, thick = np.zeros((6, *shape), np.float32), np.ones(shape, np.float32)
    planes[plane, 5, node] = 1.0
    count = bands_across(shape[1])
    rows = np.ones((NX * count, 2 * count + 1), np.float32)
    _assemble(planes, thick, rows)
    expected = np.zeros_like(rows)
    row = expected[5 * count + (node - 1) // BAND]
    share = 1.0 / BAND if beside else 0.0
    row[count + beside] = share
    row[count] = 1.0 - share
    assert rows == pytest.approx(expected)
