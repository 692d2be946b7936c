# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables of a surface by hand: bounds of the torque, loads of a scan, spreads, cells, pulls."""

from dataclasses import replace
import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.fields import MEASURED
from surrogate.surface.file import read
from surrogate.surface.hermite import hermite_weights
from surrogate.surface.tables import (
    _largest,
    _scan,
    _torque_bounds,
    open_cells,
    ROUNDING,
    SPLITS,
    summary,
)

DATA = read(shipped_surface())
AXES = np.array([0.0, 1.0, 3.0]), np.array([-2.0, 0.0, 4.0]), np.array([280.0, 300.0, 350.0])
ROWS = np.array([0, 2])  # of the cells along the load, with a break between them
WIDTHS = ((1.0, 2.0, 2.0), (2.0, 2.0, 4.0, 4.0), (20.0, 50.0, 50.0))
"""The wider cell beside each row of a table, along each axis."""


@pytest.mark.parametrize('axis', [0, 1, 2])
@pytest.mark.parametrize('slope', [6.0, -6.0])
def test_the_torque_stays_within_a_third_of_slope_and_width(axis, slope):
    """The hull of the control points of a cubic: value and value plus a third of the rise."""
    for place in np.ndindex(3, 4, 3):
        table = np.zeros((3, 4, 3, 4))
        table[..., 0] = 3.0
        table[place][axis + 1] = slope
        reach = 2.0 * WIDTHS[axis][place[axis]]
        margin = ROUNDING * (1.0 + max(abs(3.0 - reach), 3.0 + reach))
        found = _torque_bounds(AXES, ROWS, table)
        assert found == pytest.approx((3.0 - reach - margin, 3.0 + reach + margin), rel=1e-14)


def test_what_is_not_known_bounds_no_torque():
    table = np.zeros((3, 4, 3, 4))
    table[..., 0] = np.arange(36.0).reshape(3, 4, 3) - 5.0
    table[0, 0, 0] = table[2, 3, 2] = math.nan
    low, high = _torque_bounds(AXES, ROWS, table)
    assert (low, high) == pytest.approx((-4.0, 29.0), abs=1e-7)
    assert low < -4.0 < 29.0 < high
    assert (_largest(np.array([1.0, math.nan, 2.0, math.inf])), _largest(np.array([]))) == (2, 0)
    assert summary(np.array([math.nan, 3.0, 1.0, 2.0, 5.0])) == pytest.approx((5.0, 4.7))
    assert all(map(math.isnan, summary(np.array([math.nan]))))


@pytest.mark.parametrize('factor', [0.01, 1.0, 50.0])
def test_bounds_hold_every_torque_pulled_or_not(factor):
    surface = Surface(DATA)
    points = [SimpleNamespace(speed=w, opposing_load=1000.0, temperature=311.0) for w in (50, 90)]
    for point in points:
        here = surface.lookup(point.speed, point.opposing_load, point.temperature)
        solved = SimpleNamespace(friction_torque=factor * here.friction_torque)
        surface = surface.with_correction(point, solved)
    tables = surface.tables
    torques = [
        surface.lookup(w, load, heat).friction_torque
        for w in (0.06, 1.0, 50.0, 90.0, 200.0)
        for load in np.linspace(*surface.load_range, 9).tolist() + [1000.0]
        for heat in (283.15, 311.0, 353.15)
    ]
    assert tables.torque_low <= min(torques) <= max(torques) <= tables.torque_high
    plain = Surface(DATA).tables
    ends = [plain.torque_low, plain.torque_high]
    ends += [end * (1.0 + gain) for end in ends for gain in (tables.pulls[3], tables.pulls[22])]
    assert (tables.torque_low, tables.torque_high) == pytest.approx((min(ends), max(ends)))
    assert (factor == 1.0) is (pytest.approx(ends[:2]) == [min(ends), max(ends)])


def test_a_scan_divides_each_cell_and_ends_on_the_last_node():
    found, loads = _scan(AXES), AXES[1]
    expected = [cell + part / SPLITS for cell in (0, 1) for part in range(SPLITS)] + [2.0]
    assert found['scan_loads'].tolist() == np.interp(expected, [0, 1, 2], loads).tolist()
    assert found['scan_cells'].tolist() == [*[0] * SPLITS, *[1] * SPLITS, 1]
    assert found['scan_fractions'].tolist() == [*(np.array(expected[:-1]) % 1.0), 1.0]
    for place, weights in enumerate(found['scan_weights'].reshape(-1, 4)):
        width = np.diff(loads)[found['scan_cells'][place]]
        assert tuple(weights) == hermite_weights(width, found['scan_fractions'][place])
    count = len(expected)
    assert [found[f'scan_{name}'].shape for name in ('onset', 'values', 'filled', 'torques')] == [
        (count,),
        (2 * count * 3,),
        (count * 3,),
        (count,),
    ]
    assert np.isnan(found['scan_key']).all()
    assert found['scan_key'].size == 2
    assert not found['scan_filled'].any()


def test_a_cell_is_open_without_a_masked_corner():
    for masked in np.ndindex(3, 4, 3):
        mask = np.zeros((3, 4, 3), dtype=bool)
        mask[masked] = True
        cells = open_cells(mask)
        assert cells.shape == (2, 3, 2)
        for cell in np.ndindex(*cells.shape):
            beside = all(0 <= node - low <= 1 for node, low in zip(masked, cell))
            assert cells[cell] == (not beside)


def test_errors_of_a_cell_and_spreads_of_its_corners_are_its_own():
    """Other numbers in every cell and node: nothing is taken from a neighbour or another field."""
    cells = tuple(count - 1 for count in DATA.mask.shape)
    number, node = (
        np.arange(1.0, 1.0 + math.prod(n)).reshape(n) for n in (cells, DATA.mask.shape)
    )
    groups = {
        name: {field: factor * node for field, factor in zip(MEASURED, factors)}
        for name, factors in (('deviations', (1.0, 2.0)), ('standard_errors', (3.0, 4.0)))
    }
    errors = {**DATA.errors, MEASURED[0]: number, MEASURED[1]: 0.5 * number}
    surface = Surface(replace(DATA, errors=errors, **groups))
    assert surface.tables.torque_error == number.max() + 3.0 * node.max()
    assert Surface(replace(DATA, errors=errors)).tables.torque_error == number.max()
    part, checked = (0.25, 0.625, 0.375), 0
    for cell in itertools.product(
        (5, 20, cells[0] - 6), (0, 3, 17, cells[1] - 1), (0, 2, cells[2] - 1)
    ):
        s, load, heat = (
            float(axis[i] + at * (axis[i + 1] - axis[i]))
            for axis, i, at in zip(
                (DATA.speed_coordinate, DATA.load, DATA.temperature), cell, part
            )
        )
        found = surface.lookup(surface.onset_speed(load, heat) * math.exp(s), load, heat)
        if (found.speed_cell, found.load_cell, found.heat_cell) != cell:
            assert found.speed_cell == -1  # off the range of speeds
            continue
        checked += 1
        fractions = found.speed_fraction, found.load_fraction, found.heat_fraction
        assert fractions == pytest.approx(part, abs=1e-9)
        assert (found.friction_torque_error, found.rcs_error) == (number[cell], 0.5 * number[cell])
        corners = list(itertools.product((0, 1), repeat=3))
        between = sum(
            math.prod(at if up else 1.0 - at for at, up in zip(part, corner))
            * node[tuple(np.add(cell, corner))]
            for corner in corners
        )
        told = found.friction_torque_std, found.rcs_std
        told += found.friction_torque_stderr, found.rcs_stderr
        assert told == pytest.approx([factor * between for factor in (1, 2, 3, 4)], rel=1e-9)
        slope = found.efficiency_error / found.friction_torque_error
        assert slope > 0.0
        assert found.efficiency_std == pytest.approx(slope * told[0])
        assert found.efficiency_stderr == pytest.approx(slope * told[2])
    assert checked > 12
