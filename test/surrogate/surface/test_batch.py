# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Compiled and interpreted lookups agree to the last bit, everywhere."""

from dataclasses import replace
import itertools
import math
from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import batch, shipped_surface, Surface, Validity
from surrogate.surface.compiled import compiled
from surrogate.surface.file import read
from surrogate.surface.interpolate import Found, look_up
from surrogate.surface.load_scan import scan
from surrogate.surface.records import as_array

numba = pytest.importorskip('numba')
PULL = SimpleNamespace(speed=50.0, opposing_load=1010.0, temperature=311.0)
SOLVED = SimpleNamespace(converged=True, friction_torque=0.4, rcs=0.3, film_ratio=2.0)
SCAN, LOOK_UP = compiled(scan), compiled(look_up)


def surfaces():
    """Return the shipped ones, one corrected, and one with spreads and a masked node."""
    shipped = [Surface.load(shipped_surface(tier=tier)) for tier in ('closed_form', 'full')]
    data = read(shipped_surface())
    mask = data.mask.copy()
    mask[10, 20, 2] = True
    holed = replace(
        data, mask=mask, deviations={'friction_torque': 0.1 * data.fields['friction_torque']}
    )
    return [*shipped, shipped[1].with_correction(PULL, SOLVED), Surface(holed)]


SURFACES = surfaces()
FLOATS = st.floats() | st.sampled_from([0.0, -0.0, 5e-324, -5e-324, 2.2e-308, 1e308, math.inf])
NEAR_PULL = [st.floats(at - reach, at + reach) for at, reach in ((50, 15), (1010, 60), (311, 5))]


def bits(row):
    return {
        name: np.float64(row[name]).tobytes() if row[name] == row[name] else 'NaN'
        for name in row.dtype.names
    }


def compare(surface, speed, load, temperature):
    """Return the rows of points after they are held against single lookups."""
    found = batch.look_up_many(surface, speed, load, temperature)
    for at, row in enumerate(found):
        single = surface.lookup(float(speed[at]), float(load[at]), float(temperature[at]))
        kept = {name: getattr(single, name) for name in row.dtype.names}
        assert bits(row) == bits(as_array(Found(**kept))[0])
    return found


@given(
    st.sampled_from(SURFACES),
    st.tuples(st.floats(0.05, 229.0), st.floats(-3960.0, 3960.0), st.floats(283.15, 353.15))
    | st.tuples(*NEAR_PULL)
    | st.tuples(FLOATS, FLOATS, FLOATS),
)
def test_any_point_has_the_same_bits(surface, point):
    compare(surface, *([value] for value in point))


@pytest.mark.parametrize('surface', SURFACES)
def test_nodes_and_ends_have_the_same_bits(surface):
    tables = surface.tables
    speeds = [0.0, -1.0, math.nan, math.inf, *surface.speed_range, 50.0]
    loads = [math.nan, *tables.load_nodes, 0.0, -0.0]
    heats = [math.nan, *tables.heat_nodes, 300.0]
    points = np.array(list(itertools.product(speeds, loads, heats))).T
    found = compare(surface, *points)
    assert set(found['validity']) >= set(Validity) - {Validity.UNKNOWN, Validity.MASKED}


def test_masked_and_corrected_points_are_among_them():
    drawn = np.random.default_rng(7)
    holed, pulled = SURFACES[3], SURFACES[2]
    heat, load = holed.tables.heat_nodes[2], holed.tables.load_nodes[20]
    speed = holed.onset_speed(load, heat) * math.exp(holed.tables.speed_nodes[10])
    for surface, name, expected, near in (
        (holed, 'validity', Validity.MASKED, (speed, load, heat)),
        (pulled, 'corrected', True, (50.0, 1010.0, 311.0)),
    ):
        points = [value * drawn.uniform(0.99, 1.01, 200) for value in near]
        points[2] = near[2] + drawn.uniform(-2.0, 2.0, 200)
        assert np.count_nonzero(compare(surface, *points)[name] == expected) > 20


@given(st.sampled_from(SURFACES), st.floats(0.04, 240.0), st.floats(282.0, 354.0))
def test_a_scan_has_the_same_bits(surface, speed, temperature):
    tables = surface.array_tables
    known = SCAN(tables, speed, temperature)
    assert known == scan(surface.tables, speed, temperature)
    np.testing.assert_array_equal(tables.scan_torques, surface.tables.scan_torques)


def test_without_numba_the_lookup_is_interpreted(monkeypatch):
    def missing():
        raise ImportError

    points = [np.array([value, value]) for value in (50.0, 1000.0, 311.0)]
    expected = batch.look_up_many(SURFACES[1], *points)
    monkeypatch.setattr(batch, '_compiled', missing)
    found = batch.look_up_many(SURFACES[1], *points)
    assert [bits(row) for row in found] == [bits(row) for row in expected]


def test_a_lookup_leaves_what_it_does_not_judge_and_no_point_is_none():
    rows = as_array(Found(max_pressure=7.0))
    for speed in (50.0, math.nan):
        LOOK_UP(SURFACES[1].array_tables, speed, 1000.0, 311.0, rows[0])
        assert rows[0]['max_pressure'] == 7.0
        assert (rows[0]['validity'] == Validity.VALID) is not math.isnan(rows[0]['rcs'])
    nothing = np.empty(0)
    assert not len(batch.look_up_many(SURFACES[0], nothing, nothing, nothing))
