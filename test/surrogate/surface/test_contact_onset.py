# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The sentence about contact, limit and zone follows from what the surface holds."""

import copy
from dataclasses import asdict, replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.screw.onset_record import extrapolated
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import ContactOnset, onset_of_surface, shipped_surface, Surface, ZoneLimits
from surrogate.surface.contact_onset import law_doubt, usual_limits
from surrogate.surface.file import read
from surrogate.units import RPM, ZERO_CELSIUS

FULL = Surface.load(shipped_surface())
DATA = read(shipped_surface(tier='closed_form'))
CELSIUS = st.floats(10.0, 80.0).map(lambda degrees: degrees + ZERO_CELSIUS)
KNOWN = ContactOnset(
    speed=590 * RPM,
    temperature=308.15,
    band=(350 / 590, 800 / 590),
    fastest=3365 * RPM,
    reach=3365 * RPM,
    oil='oil_a',
    zone=True,
    viscosity=68e-6,
    rms=0.12e-6,
    lead=0.01,
)


def changed(*, onset=1.0, friction=1.0):
    """Return the closed-form surface whose contact begins faster and whose friction is larger."""
    torque = friction * DATA.fields['friction_torque']
    return Surface(
        replace(
            DATA,
            log_onset=DATA.log_onset + math.log(onset),
            fields={**DATA.fields, 'friction_torque': torque},
        )
    )


@pytest.mark.parametrize(
    ('key', 'changes'),
    [
        ('zone', {}),
        ('no_band', {'band': (math.nan, math.nan)}),
        ('measured', {'measure': ('trace', (0.8, 1.25))}),
        ('smooth', {'speed': 0.0}),
        ('friction', {'zone': False}),
        ('remedies', {'zone': False, 'slower': 2.0, 'colder': 290.15}),
        ('never_cold_enough', {'zone': False, 'slower': 2.0}),
        ('rough_balls', {'zone': False, 'slower': 2.0, 'rms': 0.0}),
        ('short_surface', {'zone': False, 'slower': 2.0, 'reach': 1000 * RPM}),
        ('small_rms', {'rms': 0.04e-6}),
        ('by_calibration', {'rms': 0.04e-6, 'calibrated': True}),
    ],
)
def test_the_sentence_names_speed_limit_zone_and_what_gives_one(key, changes, says):
    assert replace(KNOWN, **changes).sentence() == says(key)


def test_a_feed_axis_reads_its_own_unit_first(says):
    assert KNOWN.sentence(as_feed=True) == says('feed')
    short = replace(KNOWN, zone=False, reach=1000 * RPM)
    assert short.sentence(as_feed=True) == says('feed_of_short_surface')


@pytest.mark.parametrize(
    ('micrometres', 'key'),
    [
        (0.0, None),  # smooth
        (0.04, 'rms_0_04'),
        (math.nextafter(0.05, 0.0), 'rms_0_05'),
        (0.05, None),
        (0.4, None),
        (0.5, 'rms_0_5'),
    ],
)
def test_the_law_says_where_no_raceway_was_marched(micrometres, key, says):
    """46 marches of Rq 0.05 to 0.4 um bear it out, all lays, new and run in."""
    rms = micrometres * 1e-6
    assert law_doubt(rms=rms) == (says(key) if key else '')
    assert law_doubt(rms=rms, measured=True) == ''


@pytest.mark.parametrize(
    ('low', 'high', 'key'),
    [(0.05, 0.4, None), (0.125, 1.0, 'rms_up_to_1'), (0.04, 0.4, 'rms_from_0_04')],
)
def test_the_law_says_where_a_likely_raceway_was_not_marched(low, high, key, says, screw, oil):
    """A rolled raceway of Ra 0.3 um has 0.1 to 0.8 um; its onset, its surface and its record."""
    likely = [low * 1e-6, high * 1e-6]
    text = says(key) if key else ''
    assert law_doubt(rms=0.3e-6, likely_rms=likely) == text
    assert law_doubt(rms=0.3e-6, likely_rms=likely, measured=True) == ''
    rolled = with_raceway(screw, rms=0.3e-6, rms_low=likely[0], rms_high=likely[1])
    assert extrapolated(rolled) == ([text] if key else [])
    header = copy.deepcopy(DATA.header)
    header['inputs']['screw']['roughness'] |= asdict(rolled.roughness)
    surface = onset_of_surface(Surface(replace(DATA, header=header)))
    assert (f'; {text}; ' in surface.sentence()) is bool(key)


def test_the_record_has_the_numbers_of_the_sentence():
    record = KNOWN.record()
    assert record['sentence'] == f'{KNOWN.sentence()}.'
    assert np.divide(record['speed_range_rad_s'], RPM) == pytest.approx([350, 800])
    assert record['speed_rad_s'] == KNOWN.speed
    assert record['fastest_speed_rad_s'] == KNOWN.fastest
    assert record['temperature_K'] == KNOWN.temperature
    assert record['optimal_zone'] is True


def test_an_onset_that_was_marched_says_so(says):
    """One number, one range, what narrows it most; beyond the Rq of other marches no doubt."""
    changes = {'rms': 0.04e-6, 'marched': True, 'measure': ('trace', (0.8, 1.25))}
    assert replace(KNOWN, **changes).sentence() == says('marched')
    header = copy.deepcopy(DATA.header)
    header['inputs']['screw']['roughness'] |= {'marched_film': 0.9, 'rms': 0.04e-6}
    sentence = onset_of_surface(Surface(replace(DATA, header=header))).sentence()
    assert sentence.startswith('Marched on this raceway: contact begins at ')
    assert 'nobody knows' not in sentence


@given(kelvin=CELSIUS)
def test_speed_and_band_are_those_of_the_surface(kelvin):
    found = onset_of_surface(FULL, kelvin)
    assert found.speed == FULL.onset_speed(0.0, kelvin)
    assert found.band == FULL.onset_band
    assert found.fastest == pytest.approx(FULL.speed_range[1])


def test_what_a_measurement_leaves_has_the_numerics_too():
    steps = [{'measurement': 'trace', 'limit_band': [0.8, 1.25]}]
    bands = {'limit_band': [0.5, 2.0], 'numerical_band': [0.7, 1.4], 'measure': steps}
    surface = Surface(replace(DATA, header={**DATA.header, **bands}))
    found = onset_of_surface(surface)
    whole = [math.hypot(math.log(2.0), math.log(factor)) for factor in (0.7, 1.4)]
    assert found.band == pytest.approx((math.exp(-whole[0]), math.exp(whole[1])))
    name, left = found.measure
    assert name == 'trace'
    assert math.log(left[1]) == pytest.approx(math.hypot(math.log(1.25), math.log(1.4)))


def test_the_temperature_is_that_of_the_oil_sheet_or_the_nearest_that_is_covered():
    assert onset_of_surface(FULL).temperature == FULL.reference_temperature
    assert [onset_of_surface(FULL, kelvin).temperature for kelvin in (0.0, 1e3)] == [
        *FULL.temperature_range
    ]


@given(kelvin=CELSIUS, factor=st.floats(0.5, 20.0))
def test_a_zone_is_where_any_point_keeps_both_limits(kelvin, factor):
    """Looked up one by one, coarser: a point that is found there is a zone."""
    surface, limits = changed(onset=factor), usual_limits(FULL.preload)
    found = [
        surface.lookup(speed, load, kelvin)
        for speed in np.geomspace(10.0, surface.speed_range[1], 12)
        for load in (-3000.0, 0.0, 900.0, 3000.0)
    ]
    loads = np.array([-3000.0, 0.0, 900.0, 3000.0] * 12)
    rcs, efficiency = (np.array([getattr(p, key) for p in found]) for key in ('rcs', 'efficiency'))
    optimal = (rcs < 0.01) & ((efficiency >= 0.85) | (abs(loads) < 247.5))
    assert limits.has_zone(rcs, efficiency, loads) == optimal.any()
    assert onset_of_surface(surface, kelvin).zone or not optimal.any()


def test_limits_are_met_on_their_sides():
    """RCS below its limit, efficiency from its limit on unless the load is light."""
    limits, one = ZoneLimits(rcs=0.01, efficiency=0.85, light_load=100.0), np.ones(1)
    assert limits.has_zone(0.009 * one, 0.85 * one, -100 * one)
    assert not limits.has_zone(0.01 * one, 0.85 * one, 100 * one)
    assert not limits.has_zone(0.0 * one, 0.849 * one, -100 * one)
    assert limits.has_zone(0.0 * one, 0.0 * one, -99 * one)
    assert limits.of_film.has_zone(0.0 * one, 0.0 * one, 100 * one)
    assert not limits.has_zone(math.nan * one, one, one)


def test_below_the_named_temperature_there_is_a_zone_and_above_none():
    surface = changed(onset=4.0)
    found = onset_of_surface(surface, 343.15)
    assert not found.zone
    assert found.slower == surface.onset_speed(0.0, 343.15) / surface.onset_speed(
        0.0, found.colder
    )
    assert onset_of_surface(surface, found.colder - 0.1).zone
    assert not onset_of_surface(surface, found.colder + 0.1).zone


def test_as_many_times_slower_as_named_contact_leaves_a_zone():
    """Also where no temperature of the surface does."""
    for factor in (4.0, 100.0):
        found = onset_of_surface(changed(onset=factor), 343.15)
        assert not found.zone
        assert math.isnan(found.colder) == (factor > 4.0)
        assert onset_of_surface(changed(onset=factor / found.slower / 1.01), 343.15).zone


def test_where_friction_is_what_leaves_no_zone_no_thicker_oil_is_named():
    """All loads are judged, so that a light one does not count."""
    limits = ZoneLimits(rcs=0.01, efficiency=0.85, light_load=0.0)
    found = onset_of_surface(changed(friction=30.0), 313.15, limits)
    assert not found.zone
    assert math.isnan(found.slower)
    assert math.isnan(found.colder)
    assert onset_of_surface(changed(friction=30.0), 313.15).zone  # of light loads
