# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The scan over the load says what a lookup says at each of its loads."""

from dataclasses import replace
from types import SimpleNamespace

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import scan, shipped_surface, Surface, Validity
from surrogate.surface.file import read
from surrogate.surface.tables import SPLITS

SHIPPED = [Surface.load(shipped_surface(tier=tier)) for tier in ('closed_form', 'full')]


def scanned(surface, speed, temperature):
    scan(surface.tables, speed, temperature)
    return np.array(surface.tables.scan_loads), np.array(surface.tables.scan_torques)


def looked_up(surface, speed, temperature):
    """Return the driving torque at each scanned load, NaN without an answer."""
    points = [
        surface.lookup(speed, float(load), temperature) for load in surface.tables.scan_loads
    ]
    return np.array(
        [point.driving_torque if point.validity is Validity.VALID else np.nan for point in points]
    )


@given(st.sampled_from(SHIPPED), st.floats(0.05, 229.0), st.floats(283.15, 353.15))
@settings(max_examples=30)
def test_the_scan_is_the_lookup(surface, speed, temperature):
    loads, torques = scanned(surface, speed, temperature)
    expected = looked_up(surface, speed, temperature)
    np.testing.assert_allclose(torques, expected, rtol=1e-12, atol=1e-12)
    assert np.isfinite(torques).any()
    assert (loads[0], loads[-1]) == surface.load_range


def test_loads_are_nodes_and_places_between_with_corrections_and_drag():
    surface = SHIPPED[0]
    loads, _ = scanned(surface, 30.0, 313.15)
    assert (np.diff(loads) > 0).all()
    assert len(loads) == SPLITS * surface.cells[1] + 1
    surface = SHIPPED[1]
    point = SimpleNamespace(speed=62.8, opposing_load=1020.0, temperature=313.15)
    torque = surface.lookup(62.8, 1020.0, 313.15).friction_torque
    scanned(surface, 62.8, 313.15)
    pulled = surface.with_correction(point, SimpleNamespace(friction_torque=1.5 * torque))
    _, before = scanned(surface, 62.8, 313.15)
    _, torques = scanned(pulled, 62.8, 313.15)
    assert (torques != before).any()
    np.testing.assert_allclose(torques, looked_up(pulled, 62.8, 313.15), rtol=1e-12)
    _, beside = scanned(pulled, 62.8, 314.0)
    np.testing.assert_allclose(beside, looked_up(pulled, 62.8, 314.0), rtol=1e-12)
    assert (beside != scanned(surface, 62.8, 314.0)[1]).any()
    data = read(shipped_surface())
    header = dict(data.header)
    screw = header['inputs']['screw'] | {'parasitic_torque': 0.1, 'parasitic_torque_rate': 1e-3}
    header['inputs'] = header['inputs'] | {'screw': screw}
    surface = Surface(replace(data, header=header))
    for made, drag in ((surface, (0.1, 1e-3)), (SHIPPED[0], (0.0, 0.0))):
        assert (made.tables.parasitic_torque, made.tables.parasitic_torque_rate) == drag


@pytest.mark.parametrize(
    ('speed', 'temperature'), [(1e-3, 313.15), (1e3, 313.15), (30.0, 200.0), (np.nan, 313.15)]
)
def test_outside_there_is_no_torque(speed, temperature):
    assert np.isnan(scanned(SHIPPED[0], speed, temperature)[1]).all()


def test_one_scan_goes_through_all_cells_of_the_speed():
    """The onset rises and falls by more than all cells are wide, and begins at any of them."""
    data = read(shipped_surface())
    rise = np.linspace(0.0, 4.0 * np.pi, len(data.load))
    span = data.speed_coordinate[-1] - data.speed_coordinate[0]
    onset = data.log_onset.mean() + 0.6 * span * np.sin(rise)[:, None] * np.ones(
        data.log_onset.shape[1]
    )
    for sign in (1.0, -1.0):
        surface = Surface(replace(data, log_onset=sign * (onset - onset.mean()) + onset.mean()))
        for speed in np.geomspace(*surface.speed_range, 12):
            _, torques = scanned(surface, speed, 300.0)
            np.testing.assert_allclose(torques, looked_up(surface, speed, 300.0), rtol=1e-12)
