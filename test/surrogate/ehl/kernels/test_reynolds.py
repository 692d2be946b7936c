# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reynolds rows against a plain twin and against finite differences of themselves."""

import numpy as np
import pytest
from surrogate.ehl.kernels.reynolds import (
    contact_set,
    film_properties,
    fluid_at,
    free_boundary_rows,
    LEAST_REACTION,
    reynolds_rows,
)
from surrogate.formulas.lubricant import viscosity_roelands_1966

LAWS = {'roelands_dh': (np.log(0.04) + 9.67, 0.55, 0.34), 'barus_incompressible': (4.0, 1.0, 0.0)}
SCALE, FLOOR, MOBILITY, ASPECT = 0.7e9, 0.02, 3.0, 0.4
FADING = 2.5


def plain_mean(a, b, climbs):
    """Return the mean of the fluidities exp(-a) and exp(-b): over the pressures, or plain."""
    if not climbs or a == b:
        return 0.5 * (np.exp(-a) + np.exp(-b))
    return (np.exp(-a) - np.exp(-b)) / (b - a)


def plain_mass(mass, logs, i, j, order, fading):
    """Return what leaves node (i, j) downstream."""
    change, share = mass[i - 1, j] - mass[i, j], 0.5 * (order - 1)
    if fading:
        change *= mass[i, j] / (mass[i, j] + abs(change))
        share /= 1 + (logs[i, j] / fading) ** 4
    return mass[i, j] - share * change


def plain_cube(a, b, series):
    """Return the mean of a^3 and b^3: plain, or of films in series."""
    return 2 * (a * b) ** 2 / (a + b) if series else 0.5 * (a**3 + b**3)


def plain_rows(pressure, gap, contact, law, order, inlet, fading=FADING):
    """Return F of the docstring, node by node."""
    limited = fading > 0
    growth, exponent, gain = law
    film = np.where(contact, FLOOR, np.maximum(gap, FLOOR))
    density = 1 + gain * pressure * SCALE / (5.9e8 + pressure * SCALE)
    logs = growth * ((1 + pressure * SCALE / 1.96e8) ** exponent - 1)
    mass = density * film
    rows = np.zeros_like(pressure)
    for i in range(1, pressure.shape[0] - 1):
        for j in range(1, pressure.shape[1] - 1):
            for di, dj, weight in ((-1, 0, 1), (1, 0, 1), (0, -1, ASPECT), (0, 1, ASPECT)):
                here, there = (i, j), (i + di, j + dj)
                outside = pressure[there] if i + di else inlet[j] * pressure[here]
                climbs = di * (outside - pressure[here]) > 0 if di else limited
                cube = plain_cube(film[here], film[there], limited)
                face = MOBILITY * 0.5 * (density[here] + density[there]) * cube
                face *= plain_mean(logs[here], logs[there], climbs)
                rows[here] -= weight * face * (outside - pressure[here])
            rows[i, j] += plain_mass(mass, logs, i, j, order if i > 1 else 1.0, fading)
            come = plain_mass(mass, logs, i - 1, j, order, fading) if i > 2 else mass[i - 1, j]
            rows[i, j] -= come
    return rows


@pytest.fixture
def fields():
    """Random pressures, gaps above the floor and a contact set."""
    rng = np.random.default_rng(3)
    pressure = np.zeros((9, 8))
    pressure[1:-1, 1:-1] = rng.random((7, 6))
    gap = FLOOR * (1.1 + 2 * rng.random((9, 8)))
    contact = np.zeros((9, 8), bool)
    contact[3:5, 2:5] = True
    return pressure, gap, contact, np.linspace(0, 0.9, 8)


def assembled(pressure, gap, contact, law, order, inlet, fading=FADING):
    """Return F, dF/dp and dF/dh of the kernels."""
    film = np.empty((7, *gap.shape))
    film_properties(pressure, gap, contact, FLOOR, SCALE, *law, film)
    rows, by_p, by_h = np.empty_like(gap), np.empty((6, *gap.shape)), np.empty((6, *gap.shape))
    reynolds_rows(pressure, film, MOBILITY, ASPECT, order, fading, inlet, rows, by_p, by_h)
    return rows, by_p, by_h


@pytest.mark.parametrize('law', LAWS.values(), ids=LAWS)
@pytest.mark.parametrize('order', [1.0, 1.3, 2.0])
@pytest.mark.parametrize('fading', [0.0, 2.5, 4.0])
def test_rows_are_the_plain_twins(fields, law, order, fading):
    pressure, gap, contact, inlet = fields
    rows, _, _ = assembled(pressure, gap, contact, law, order, inlet, fading)
    twin = plain_rows(pressure, gap, contact, law, order, inlet, fading)
    assert rows == pytest.approx(twin, rel=1e-12)


@pytest.mark.parametrize('law', LAWS.values(), ids=LAWS)
@pytest.mark.parametrize('fading', [0.0, 2.5, 4.0])
def test_planes_are_the_derivatives(fields, law, fading):
    """Central differences of every row in every pressure and gap."""
    pressure, gap, contact, inlet = fields
    _, by_p, by_h = assembled(pressure, gap, contact, law, 2.0, inlet, fading)
    steps = ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-2, 0))
    for field, planes in ((pressure, by_p), (gap, by_h)):
        for i, j in ((1, 3), (2, 2), (3, 3), (5, 4), (7, 6)):
            for plane, (di, dj) in enumerate(steps):
                place = (i + di, j + dj)
                if place[0] < 0 or place[0] == 0 and field is pressure:
                    continue  # outside the first row the inlet rules
                ends = []
                for sign in (1, -1):
                    moved = field.copy()
                    moved[place] += sign * 1e-7
                    both = (moved, gap) if field is pressure else (pressure, moved)
                    ends.append(plain_rows(*both, contact, law, 2.0, inlet, fading)[i, j])
                slope = (ends[0] - ends[1]) / 2e-7
                assert planes[plane, i, j] == pytest.approx(slope, rel=1e-5, abs=1e-6)


def test_fluid_is_the_published_law():
    eta, alpha, pressure = 0.05, 2e-8, 1.1e9
    growth = np.log(eta) + 9.67
    log, slope, density, _ = fluid_at(1.0, pressure, growth, alpha * 1.96e8 / growth, 0.34)
    expected = float(viscosity_roelands_1966(pressure, eta, alpha))
    assert eta * np.exp(log) == pytest.approx(expected, rel=1e-12)
    assert density == pytest.approx((5.9e8 + 1.34 * pressure) / (5.9e8 + pressure), rel=1e-12)
    log, slope, density, compression = fluid_at(1.0, pressure, alpha * 1.96e8, 1.0, 0.0)
    assert (log, slope) == pytest.approx((alpha * pressure, alpha * pressure), rel=1e-12)
    assert (density, compression) == (1.0, 0.0)


@pytest.mark.parametrize(('stiffness', 'least'), [(2.0, 0.9), (2e-3, LEAST_REACTION)])
def test_sets_and_row_scaling(fields, stiffness, least):
    """Contact by pa T > h - floor, rupture by p times the row size < F, rows of size one; flux."""
    pressure, gap, contact, inlet = fields
    asperity = np.where(contact, 0.01, 0.0)
    found = np.zeros_like(contact)
    count = contact_set(asperity, gap, FLOOR, stiffness, False, found)
    inner = np.zeros_like(contact)
    inner[1:-1, 1:-1] = True
    assert (found == (inner & (stiffness * asperity > gap - FLOOR))).all()
    assert count == found.sum()
    rows, by_p, by_h = assembled(pressure, gap, contact, LAWS['roelands_dh'], 1.0, inlet)
    size = np.abs(by_p[0]) + np.abs(by_h[0]) * stiffness
    ruptured = inner & (pressure * size < rows)
    lift = np.abs(by_h[0])[inner & ~ruptured] * stiffness
    share = np.where(lift > 0, np.maximum(lift / size[inner & ~ruptured], LEAST_REACTION), 1.0)
    assert (lift == 0).any()
    assert least <= share.min() < least + 0.1
    flux = (share * np.abs(rows[inner & ~ruptured])).sum() / 0.5
    mask, sizes = np.zeros_like(contact), np.ones((9, 8))
    total = free_boundary_rows(
        pressure, np.full((9, 8), 0.5), False, stiffness, np.ones(8), rows, by_p, by_h, mask, sizes
    )
    assert total == pytest.approx(flux)
    assert (mask == ruptured).all()
    assert (rows[ruptured] == pressure[ruptured]).all()
    kept = inner & ~ruptured
    assert sizes == pytest.approx(np.where(kept, size, 0.0))
    assert (np.abs(by_p[0]) + np.abs(by_h[0]) * stiffness)[kept] == pytest.approx(1.0)
