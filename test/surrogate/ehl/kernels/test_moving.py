# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of moving columns against a plain twin, finite differences and the wedge at rest."""

import numpy as np
import pytest
from surrogate.ehl.interface import NO_FADING
from surrogate.ehl.kernels.moving import column_rows, dissipated, thin_by_shear
from surrogate.ehl.kernels.reynolds import film_properties, reynolds_rows

LAW = (np.log(0.04) + 9.67, 0.55, 0.34)
SCALE, FLOOR, ASPECT = 0.7e9, 0.02, 0.4


@pytest.fixture
def film():
    """Return the planes of a random film, partly in contact."""
    rng = np.random.default_rng(3)
    pressure, gap = rng.random((9, 8)), FLOOR * (1.1 + 2 * rng.random((9, 8)))
    contact = np.zeros((9, 8), bool)
    contact[3:5, 2:5] = True
    out = np.empty((7, 9, 8))
    film_properties(pressure, gap, contact, FLOOR, SCALE, *LAW, out)
    return out


def plain_carried(here, before):
    """Return G of the docstring."""
    change = before - here
    return here - 0.5 * change * here / (here + abs(change))


def rows_of(film, mass, carried, stride=1):
    """Return residual, both planes of the node itself, and the mass carried on."""
    shape = film.shape[1:]
    rows, by_p, by_h, out = np.zeros(shape), np.zeros((6, *shape)), np.zeros((6, *shape)), 0 * mass
    column_rows(film, mass, carried, stride, out, rows, by_p, by_h)
    assert not by_p[1:].any()  # the derivative is local
    assert not by_h[1:].any()
    return rows, by_p[0], by_h[0], out


@pytest.mark.parametrize('stride', [1, 2, 3])
def test_rows_are_the_plain_twins(film, stride):
    rng = np.random.default_rng(4)
    mass, carried = 0.05 * rng.random((2, 9, 8)) + 0.01
    rows, _, _, out = rows_of(film, mass, carried, stride)
    here = film[0] * film[2]
    twin = plain_carried(here, mass)
    twin[: stride + 1] = here[: stride + 1]
    assert out == pytest.approx(twin, rel=1e-13)
    assert rows == pytest.approx((twin - carried) / stride, rel=1e-12)


def test_planes_are_the_derivatives(film):
    """Central differences in density and film; a contact node does not react to its gap."""
    mass = 0.03 + 0.01 * np.random.default_rng(5).random((9, 8))
    carried = np.zeros((9, 8))
    _, by_p, by_h, _ = rows_of(film, mass, carried, 2)
    for plane, found, slope in ((0, by_p, film[1]), (2, by_h, film[6])):
        ends = []
        for sign in (1, -1):
            moved = film.copy()
            moved[plane] *= 1 + sign * 1e-6
            ends.append(rows_of(moved, mass, carried, 2)[0])
        change = (ends[0] - ends[1]) / 2e-6 / film[plane]
        assert found == pytest.approx(change * slope, rel=1e-6)


def test_at_rest_it_is_the_upstream_wedge(film):
    """Columns that were at the node before bring what the steady wedge of order 2 takes there."""
    shape = film.shape[1:]
    rows, by_p, by_h = np.zeros(shape), np.zeros((6, *shape)), np.zeros((6, *shape))
    nothing = np.zeros(shape[1])
    reynolds_rows(0 * film[0], film, 0.0, ASPECT, 2.0, NO_FADING, nothing, rows, by_p, by_h)
    mass = film[0] * film[2]
    before = np.vstack([mass[:1], mass[:-1]])
    _, _, _, steady = rows_of(film, before, 0 * mass)
    carried = np.vstack([steady[:1], steady[:-1]])
    found = rows_of(film, before, carried)[0][1:-1, 1:-1]
    assert found == pytest.approx(rows[1:-1, 1:-1], rel=1e-12, abs=1e-16)


def test_dissipation_is_flow_times_rise(film):
    """The work of the flow: sum of p times what Poiseuille flow leaves, here incompressible."""
    rng = np.random.default_rng(6)
    pressure, shape = np.zeros((9, 8)), (9, 8)
    pressure[1:-1, 1:-1] = rng.random((7, 6))
    gap, contact = FLOOR * (1.1 + 2 * rng.random(shape)), np.zeros(shape, bool)
    planes = np.empty((7, *shape))
    film_properties(pressure, gap, contact, FLOOR, SCALE, LAW[0], LAW[1], 0.0, planes)
    rows, by_p, by_h = np.zeros(shape), np.zeros((6, *shape)), np.zeros((6, *shape))
    inlet = np.zeros(8)
    reynolds_rows(pressure, planes, 3.0, ASPECT, 1.0, 2.5, inlet, rows, by_p, by_h)
    still, no_flow = np.zeros(shape), np.zeros((6, *shape))
    reynolds_rows(pressure, planes, 0.0, ASPECT, 1.0, 2.5, inlet, still, no_flow, no_flow.copy())
    work = float((pressure * (rows - still)).sum())
    lost = dissipated(pressure, planes, 3.0, ASPECT, True, inlet, False)
    assert lost == pytest.approx(work, rel=1e-12)


def test_shear_thins_as_the_plain_twin(film):
    rng = np.random.default_rng(7)
    pressure, thinned = rng.random((9, 8)), film.copy()
    thin_by_shear(pressure, thinned, 30.0, 20.0)
    twin = np.ones((9, 8))
    for i in range(1, 8):
        for j in range(1, 7):
            shear = film[2, i, j] * np.hypot(
                30.0 * (pressure[i + 1, j] - pressure[i - 1, j]),
                20.0 * (pressure[i, j + 1] - pressure[i, j - 1]),
            )
            twin[i, j] = np.sinh(shear) / shear
    assert thinned[5] == pytest.approx(film[5] * twin, rel=1e-12)
    assert thinned[3] == pytest.approx(film[3] - np.log(twin), rel=1e-12, abs=1e-12)
    assert twin.max() > 1.05
