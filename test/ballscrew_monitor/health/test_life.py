# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Life, share used and rate of now, against closed forms and with what is missing."""

import math

from ballscrew_monitor.health.damage import Rated
from ballscrew_monitor.health.life import life_quantities, NAMES, NO_RATING, RECENT, shaft_notes
from ballscrew_monitor.health.records import SpectrumBin
import pytest
from surrogate.units import RPM

TODAY = 20_000
RATED = Rated(dynamic_rating=30e3, static_rating=90e3, preload=0.0, pitch_diameter=0.04)


def moved(load, *, hours=10.0, day=TODAY, rpm=1000.0, **changes):
    """Return a bin of motion under a load [N]."""
    speed, time = rpm * RPM, hours * 3600.0
    values = {'first_day': day, 'load_band': 3, 'speed': speed, 'time': time}
    return SpectrumBin(axial_load=load, angle=speed * time, **values | changes)


def told(bins, rated=RATED, **options):
    """Return the quantities by name."""
    return {one.name: one for one in life_quantities(bins, rated, TODAY, **options)}


def test_a_constant_programme():
    """3 kN of 30 kN is a thousand million revolutions, 16667 h at 1000 rev/min."""
    found = told([moved(3e3)], load_uncertainty=0.0)
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


def test_revolutions_before_monitoring():
    """Counted at the mean damage per turn; unknown ones are named."""
    found = told([moved(3e3)], turns_before=5.4e6, load_uncertainty=0.0)['share of life used']
    assert found.value == pytest.approx(6e6 / 1e9)
    assert 'before monitoring' in found.evidence
    assert 'are not known' in told([moved(3e3)])['share of life used'].evidence


def test_a_life_that_is_over():
    """Nothing is left, and the share says by how much."""
    found = told([moved(30e3, hours=100.0)], load_uncertainty=0.0)
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


def test_an_uncertainty_beyond_all(refused):
    refused('uncertainty', life_quantities, [], RATED, TODAY, load_uncertainty=1.0)


def test_limits_of_the_shaft(says):
    """Told beyond them and not at them, and never where the sheet states no length."""
    header = {'service': {'critical_speed': 1000 * RPM, 'buckling_load': 2000.0}}
    assert shaft_notes(header, -900 * RPM, -1500.0) == [says('too_fast'), says('too_heavy')]
    assert shaft_notes(header, 0.8 * 1000 * RPM, 1000.0) == []
    assert shaft_notes({}, 1e9, 1e9) == []
