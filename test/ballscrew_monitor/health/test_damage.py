# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Damage of a spectrum, against closed forms."""

import math

from ballscrew_monitor.health.damage import damage_of, Rated, rated_of, SHARED_LEAST, WITHIN_BAND
from ballscrew_monitor.health.records import SpectrumBin
from hypothesis import example, given
from hypothesis import strategies as st
import pytest
from surrogate.surface import find_surface, Surface
from surrogate.units import TURN

RATED = Rated(dynamic_rating=30e3, static_rating=90e3, preload=0.0, pitch_diameter=0.04)
HEADER = Surface.load(find_surface('closed_form')).header
LOADS = st.floats(-2e4, 2e4)


def moved(load, turns=1e6, day=20_000, **changes):
    """Return a bin of motion under a load [N]."""
    values = {'first_day': day, 'load_band': 3, 'angle': turns * TURN, 'speed': 50.0}
    return SpectrumBin(axial_load=load, time=turns * TURN / 50.0, **values | changes)


def test_a_constant_load_without_preload():
    """A million turns under the rating are the life; a tenth of it needs a thousand times that."""
    found = damage_of([moved(-30e3)], RATED, 0.0)
    assert found.value == pytest.approx(1.0)
    assert found.low == pytest.approx(SHARED_LEAST)
    assert found.high == pytest.approx(WITHIN_BAND)
    assert damage_of([moved(3e3)], RATED, 0.0).value == pytest.approx(1e-3)
    assert (found.turns, found.known) == (pytest.approx(1e6), 1.0)


def test_preload_wears_both_nuts():
    """2^(9/10) of what one nut uses up."""
    rated = Rated(dynamic_rating=30e3, static_rating=9e4, preload=3e3, pitch_diameter=0.04)
    found = damage_of([moved(0.0)], rated, 0.0)
    assert found.value == pytest.approx(1e-3 * 2**0.9)
    assert found.low == pytest.approx(found.value)


@example([2.1e-96], 0.0)  # its damage to a power is 0
@given(st.lists(LOADS, max_size=6), st.floats(0.0, 0.5))
def test_the_interval_holds_the_value(loads, uncertainty):
    """Whatever the loads; more uncertainty is a wider interval."""
    bins = [moved(load) for load in loads]
    found, wider = (damage_of(bins, RATED, one) for one in (uncertainty, uncertainty + 0.1))
    if loads:
        assert wider.low <= found.low <= found.value * (1 + 1e-12)
        assert found.value <= found.high * (1 + 1e-12) <= wider.high * (1 + 1e-9)
    else:
        assert math.isnan(found.value)


def test_motion_under_unknown_loads():
    """It counts like the other, at least with no load and at most with the largest."""
    bins = [moved(3e3), moved(6e3), moved(math.nan)]
    found = damage_of(bins, RATED, 0.0)
    assert found.known == pytest.approx(2 / 3)
    assert found.value == pytest.approx(1.5 * (1e-3 + 8e-3))
    assert found.low == pytest.approx(SHARED_LEAST * 9e-3)
    assert found.high == pytest.approx(WITHIN_BAND * (1e-3 + 8e-3 + 8e-3))


def test_the_bound_of_a_band_is_the_worst_pair_of_loads():
    """Any share of loads at both ends of a band of 1.5 has a mean cube below 1.13."""
    shares = [one / 1000 for one in range(1001)]
    worst = max((1 + 2.375 * p) / (1 + 0.5 * p) ** 3 for p in shares)
    assert worst == pytest.approx(1.129, abs=1e-3)
    assert worst < WITHIN_BAND


def test_ratings_of_a_header():
    """None without a dynamic rating, as in surfaces of sheets without one."""
    assert rated_of({**HEADER, 'service': {}}) is None
    found = rated_of({**HEADER, 'service': {'dynamic_rating': 25e3}}, preload_share=0.6)
    assert found.dynamic_rating == 25e3
    assert found.preload == pytest.approx(0.6 * HEADER['inputs']['screw']['preload'])
    assert found.pitch_diameter == pytest.approx(0.032)


@pytest.mark.parametrize(
    ('change', 'key'),
    [
        ({'dynamic_rating': 0.0}, 'no_rating'),
        ({'static_rating': math.nan}, 'static_nan'),
        ({'preload': -1.0}, 'preload_negative'),
        ({'pitch_diameter': math.inf}, 'pitch_infinite'),
    ],
)
def test_ratings_that_no_screw_has(change, key, refused):
    values = {'dynamic_rating': 1e4, 'static_rating': 3e4, 'preload': 1e3, 'pitch_diameter': 0.04}
    refused(key, Rated, **values | change)
