# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Strips of a raceway: their tile and waves, and marches whose span has to be moved."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities import strips
from surrogate.asperities.running_in import RunningContact
from surrogate.asperities.strips import raceway_strips
from surrogate.asperities.topography_onset import COARSE_FILM
from surrogate.ehl import ContactLubricant
from surrogate.ehl.moving import MarchStatus, SpeedRamp
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.formulas.load_sharing import normal_force

OIL, FLOOR = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8), 3e-9


@pytest.fixture(scope='module')
def coarse(screw):
    return raceway_strips(screw, 'screw', OIL, FLOOR, draws=[0, 3], waves=2.0)


def test_a_strip_is_the_middle_of_the_contact_on_a_tile_of_4_by_2_half_lengths(screw, coarse):
    """Waves of the sheet end at the first that is at most so many times in the half length."""
    force = float(normal_force(screw, screw.preload))
    middle = hertz(screw_contact(screw, 'screw'), force)
    half = float(middle.semi_axis_x)
    for strip in coarse:
        assert strip.strip.max_pressure == pytest.approx(float(middle.max_pressure))
        assert strip.strip.semi_axis == pytest.approx(half)
        assert (strip.tile.length, strip.tile.width) == pytest.approx((4 * half, 2 * half))
        assert strip.shortest >= half / 2 > strip.shortest / screw.roughness.scale_ratio
        power = np.abs(np.fft.rfft2(strip.tile.heights)) ** 2
        shorter = strip.tile.wave_number > 2 * math.pi / (0.7 * strip.shortest)
        assert power[shorter].sum() < 1e-12 * power.sum()  # nothing is cut on waves so long
    assert not np.array_equal(coarse[0].tile.heights, coarse[1].tile.heights)


def test_waves_longer_than_all_take_the_longest(screw):
    contact = RunningContact.of(screw, 'screw')
    longest = 2 * math.pi / contact.waves[0].wave_number[0]
    assert contact.wave_above(1.0) == pytest.approx(longest)
    assert contact.wave_above(0.0) == pytest.approx(contact.resolved_wave)


@pytest.fixture
def spans(monkeypatch):
    """Return the spans of marches, each with RCS as a strip that touches at 1 m/s has it."""
    marched = []

    def ramp_strip(strip, oil, speeds, raceway, *, transits, **settings):
        marched.append(speeds)
        steps = np.geomspace(*speeds, 1200)
        return SpeedRamp(
            status=status[0],
            speeds=steps,
            rcs=0.01 * steps**-4.7,
            transit=1200 / transits,
            steps=1200,
        )

    status = [MarchStatus.CONVERGED]
    monkeypatch.setattr(strips, 'ramp_strip', ramp_strip)
    return marched, status


@pytest.mark.parametrize(('expected', 'count'), [(1.0, 1), (7.0, 2), (0.2, 2), (60.0, 3)])
def test_a_span_that_does_not_hold_the_onset_is_moved(coarse, spans, expected, count):
    """Means over a turn of so steep a curve pass 0.01 at 1.03 m/s: (sinh(0.94)/0.94)^(1/4.7)."""
    onset, ramp = coarse[0].march(expected)
    assert onset == pytest.approx(1.03, rel=0.02)
    assert len(spans[0]) == count
    assert ramp.speeds[0] > onset > ramp.speeds[-1]


def test_the_onset_is_sought_some_spans_away_and_not_where_a_march_stalls(coarse, spans):
    marched, status = spans
    assert math.isnan(coarse[0].march(1e4)[0])
    assert len(marched) == 4
    status[0] = MarchStatus.STALLED
    assert math.isnan(coarse[0].march(7.0)[0])
    assert len(marched) == 5


def test_a_march_that_stalls_on_too_thin_a_film_is_tried_at_faster_speeds(coarse, monkeypatch):
    marched = []

    def ramp_strip(strip, oil, speeds, raceway, *, transits, **settings):
        marched.append(speeds)
        return SpeedRamp(status=MarchStatus.STALLED)

    monkeypatch.setattr(strips, 'ramp_strip', ramp_strip)
    assert math.isnan(coarse[0].march(1.0)[0])
    assert [first for first, last in marched] == sorted(first for first, last in marched)
    assert len(marched) == 4


def test_the_law_tells_a_strip_with_the_bias_of_marches(coarse):
    """The onset of a strip falls as one over the viscosity; marches touch some 4 % faster."""
    thin = replace(coarse[0], oil=ContactLubricant(viscosity=0.03, pressure_viscosity=2e-8))
    assert thin.told / coarse[0].told == pytest.approx(2.0, rel=0.05)


def test_a_strip_that_touches_where_the_law_has_it_has_the_factor_one(coarse):
    """Beyond, films of the power 0.67 of the speed are thicker, over a law that does not fall."""
    strip = coarse[0]
    assert strip.film_factor(strip.told) == pytest.approx(1.0, abs=2e-3)
    assert 1.2**0.2 < strip.film_factor(1.2 * strip.told) < 1.2**0.67
    assert strip.law.film_factor == pytest.approx(1 / COARSE_FILM)
