# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Damage of a spectrum, life, share used and rate, against closed forms and with gaps."""

import math

from ballscrew_monitor.health.life import (
    damage_of,
    life_quantities,
    NAMES,
    NO_RATING,
    Rated,
    rated_of,
    RECENT,
    shaft_notes,
    SHARED_LEAST,
    WITHIN_BAND,
)
from ballscrew_monitor.health.records import SpectrumBin
from hypothesis import example, given
from hypothesis import strategies as st
import pytest
from surrogate.surface import find_surface, Surface
from surrogate.units import RPM, TURN

TODAY = 20_000
RATED = Rated(dynamic_rating=30e3, static_rating=90e3, preload=0.0, pitch_diameter=0.04)
HEADER = Surface.load(find_surface('closed_form')).header
LOADS = st.floats(-2e4, 2e4)


def turned(load, turns=1e6):
    """Return a bin of a number of turns under a load [N]."""
    return moved(load, hours=turns * TURN / (1000.0 * RPM) / 3600.0)


def moved(load, *, hours=10.0, day=TODAY, rpm=1000.0, **changes):
    """Return a bin of motion under a load [N]."""
    speed, time = rpm * RPM, hours * 3600.0
    values = {'first_day': day, 'load_band': 3, 'speed': speed, 'time': time}
    return SpectrumBin(axial_load=load, angle=speed * time, **values | changes)


def told(bins, rated=RATED):
    """Return the quantities by name."""
    return {one.name: one for one in life_quantities(bins, rated, TODAY)}


def test_a_constant_programme():
    """3 kN of 30 kN is a thousand million revolutions, 16667 h at 1000 rev/min."""
    found = told([moved(3e3)])
    assert set(found) == set(NAMES)
    assert found['life at this programme'].value == pytest.approx(1e9)
    assert found['hours of life at this programme'].value == pytest.approx(1e9 / 6e4)
    assert found['share of life used'].value == pytest.approx(6e5 / 1e9)
    assert found['hours left at this programme'].value == pytest.approx((1 - 6e-4) * 1e9 / 6e4)
    assert found['burn rate'].value == pytest.approx(1.0)
    for one in found.values():
        assert one.is_known
        assert one.low <= one.value <= one.high
        assert one.evidence
        assert one.unit == NAMES[one.name]


def test_a_rate_that_rises():
    """The load of the last days is twice that before: eight times the rate of then."""
    early = moved(3e3, day=TODAY - 100, hours=90.0)
    found = told([early, moved(6e3, hours=10.0)])
    assert found['burn rate'].value == pytest.approx(8 / (0.9 + 0.8))
    assert found['life at this programme'].value == pytest.approx(1e9 / 8)
    assert found['burn rate'].low > 1


def test_only_the_last_days_are_now():
    """A period of days counts while its end is within them."""
    before, since = moved(3e3, day=TODAY - RECENT), moved(6e3, day=TODAY - RECENT + 1)
    assert not told([before])['life at this programme'].is_known
    assert told([before, since])['life at this programme'].value == pytest.approx(1e9 / 8)
    week = moved(6e3, day=TODAY - RECENT - 5, days=7)
    assert told([week])['life at this programme'].is_known


def test_a_life_that_is_over():
    """Nothing is left, and the share says by how much."""
    found = told([moved(30e3, hours=100.0)])
    assert found['share of life used'].value == pytest.approx(6.0)
    assert found['hours left at this programme'].value == 0.0


def test_an_uncertain_load_is_a_wide_interval():
    """The cube of 10 % either way, and more."""
    found = told([moved(3e3)])['life at this programme']
    assert found.low <= 1e9 / 1.1**3
    assert found.high >= 1e9 / 0.9**3


@pytest.mark.parametrize(
    ('bins', 'key'),
    [
        ([], 'nothing'),
        ([moved(3e3, hours=0.25)], 'quarter_hour'),
        ([moved(3e3), moved(math.nan, hours=5.0)], 'unknown_loads'),
        ([moved(0.0)], 'no_load'),
    ],
)
def test_what_is_not_known_says_why(bins, key, says):
    """No interval, and a sentence."""
    found = told(bins)['life at this programme']
    assert not found.is_known
    assert found.reason == says(key)


def test_without_a_rating_nothing_is_told():
    for one in told([moved(3e3)], rated=None).values():
        assert not one.is_known
        assert one.reason == NO_RATING


def test_limits_of_the_shaft(says):
    """Told beyond them and not at them, and never where the sheet states no length."""
    header = {'service': {'critical_speed': 1000 * RPM, 'buckling_load': 2000.0}}
    assert shaft_notes(header, -900 * RPM, -1500.0) == [says('too_fast'), says('too_heavy')]
    assert shaft_notes(header, 0.8 * 1000 * RPM, 1000.0) == []
    assert shaft_notes({}, 1e9, 1e9) == []


def test_a_constant_load_without_preload():
    """A million turns under the rating are the life; a tenth of it needs a thousand times that."""
    found = damage_of([turned(-30e3)], RATED, 0.0)
    assert found.value == pytest.approx(1.0)
    assert found.low == pytest.approx(SHARED_LEAST)
    assert found.high == pytest.approx(WITHIN_BAND)
    assert damage_of([turned(3e3)], RATED, 0.0).value == pytest.approx(1e-3)
    assert (found.turns, found.known) == (pytest.approx(1e6), 1.0)


def test_preload_wears_both_nuts():
    """2^(9/10) of what one nut uses up."""
    rated = Rated(dynamic_rating=30e3, static_rating=9e4, preload=3e3, pitch_diameter=0.04)
    found = damage_of([turned(0.0)], rated, 0.0)
    assert found.value == pytest.approx(1e-3 * 2**0.9)
    assert found.low == pytest.approx(found.value)


@example([2.1e-96], 0.0)  # its damage to a power is 0
@given(st.lists(LOADS, max_size=6), st.floats(0.0, 0.5))
def test_the_interval_holds_the_value(loads, uncertainty):
    """Whatever the loads; more uncertainty is a wider interval."""
    bins = [turned(load) for load in loads]
    found, wider = (damage_of(bins, RATED, one) for one in (uncertainty, uncertainty + 0.1))
    if loads:
        assert wider.low <= found.low <= found.value * (1 + 1e-12)
        assert found.value <= found.high * (1 + 1e-12) <= wider.high * (1 + 1e-9)
    else:
        assert math.isnan(found.value)


def test_motion_under_unknown_loads():
    """It counts like the other, at least with no load and at most with the largest."""
    bins = [turned(3e3), turned(6e3), turned(math.nan)]
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
    found = rated_of({**HEADER, 'service': {'dynamic_rating': 25e3}})
    assert found.dynamic_rating == 25e3
    assert found.preload == pytest.approx(HEADER['inputs']['screw']['preload'])
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
