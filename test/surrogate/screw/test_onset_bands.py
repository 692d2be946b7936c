# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The one band of an onset: its causes, what narrows it, and who shows it."""

from dataclasses import replace
import math

import pytest
from surrogate.asperities.law import FILM_POWER, SLOPE
from surrogate.catalogue.screw import screw_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.parameters import OperatingPoint
from surrogate.screw.onset_bands import (
    INTERPOLATION,
    onset_bands,
    OnsetBands,
    spread,
    unknown_band,
)
from surrogate.screw.onset_record import onset_page, onset_record
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import law_band, with_raceway
from surrogate.screw.sensitivity import sensitivity_record
from surrogate.screw.uncertain_inputs import INPUTS, ScrewCase
from surrogate.units import RPM

pytestmark = pytest.mark.usefixtures('small_tiles')
KELVIN = 313.15
OWN = CatalogueScrew(
    nominal_diameter=0.036, lead=0.012, nut='double', turns=3.5, dynamic_rating=30e3
)
BY_NAME = {one.name: one for one in INPUTS}


@pytest.fixture(scope='module')
def own():
    """Return a screw out of a catalogue, whose Ra is a typical one."""
    return screw_of(OWN)[0]


@pytest.fixture(scope='module')
def bands(own, oil):
    """Return its bands without load."""
    return onset_bands(own, oil, 0.0, KELVIN)


def test_the_band_is_what_is_not_known_and_the_numerics(own, oil, bands):
    """Squares of logarithms, each side for itself; each measurement leaves less."""
    for end, found in enumerate(bands.whole):
        parts = [math.log(band[end]) for band in (bands.unknown, bands.numerics)]
        assert abs(math.log(found)) == pytest.approx(math.hypot(*parts))
    (_, first), (_, second) = bands.measure
    assert bands.unknown[0] < first[0] < second[0] < 1 < second[1] < first[1] < bands.unknown[1]
    law = law_band(Contacts.of(own), oil, 0.0, KELVIN)['band']
    for end, found in enumerate(bands.numerics):
        parts = math.log(law[end]), INTERPOLATION
        assert abs(math.log(found)) == pytest.approx(math.hypot(*parts))
    assert INTERPOLATION * -SLOPE * FILM_POWER == pytest.approx(0.1)


def test_a_typical_ra_is_in_the_band_and_a_trace_narrows_it_most(own, oil, bands):
    """Rq 0.125 to 0.5 um; a measured one leaves a tenth either way, and a narrower band."""
    sheet = own.roughness
    case = ScrewCase(
        screw=own, lubricant=oil, point=OperatingPoint(speed=0.0, load=0.0, temperature=KELVIN)
    )
    assert BY_NAME['rms'].bounds(case) == (sheet.rms_low, sheet.rms_high)
    assert (sheet.rms_low, sheet.rms_high) == pytest.approx((0.125e-6, 0.5e-6))
    assert bands.narrowed[0] == 'trace of the raceway as it runs'
    traced = screw_of(replace(OWN, ra=0.16e-6))[0]
    assert (traced.roughness.rms_low, traced.roughness.rms) == (None, sheet.rms)
    known = onset_bands(traced, oil, 0.0, KELVIN)
    assert spread(known.whole) < 0.8 * spread(bands.whole)
    assert BY_NAME['rms'].bounds(replace(case, screw=traced)) == pytest.approx(
        (sheet.rms / 1.1, 1.1 * sheet.rms)
    )


def test_onset_and_sensitivity_show_this_band(own, oil, bands):
    """In speeds of each state, with what the measurement leaves, and as factors."""
    record = onset_record(own, oil, 0.0, KELVIN)
    state = record['states']['run_in']
    assert state['band'] == list(bands.whole)
    assert {name: state[name] for name in bands.record()} == bands.record()
    speed = state['speed_rad_s'] / RPM
    low, high = (speed * factor for factor in bands.narrowed[1])
    page = onset_page(record)
    assert f'a measured {bands.narrowed[0]} leaves {low:.3g} to {high:.3g} rev/min' in page
    point = OperatingPoint(speed=600 * RPM, load=0.0, temperature=KELVIN)
    used = [one for one in INPUTS if one.measured]
    found = sensitivity_record(own, oil, point, inputs=used)
    assert found['band'] == pytest.approx(bands.whole)
    assert found['measure'][0]['measurement'] == bands.narrowed[0]


@pytest.mark.parametrize(('side', 'grooves'), [('nut', (0.505, 0.6)), ('screw', (0.6, 0.505))])
def test_other_raceways_have_the_onset_of_both_sides_on_that_which_is_clearly_faster(
    screw, oil, side, grooves
):
    """That of the wider groove; another oil, which costs nothing, is told on both sides."""
    uneven = replace(screw, conformity_screw=grooves[0], conformity_nut=grooves[1])
    point = OperatingPoint(speed=0.0, load=0.0, temperature=KELVIN)
    both = ScrewCase(screw=uneven, lubricant=oil, point=point)
    alone = both.faster_side
    assert (both.side, alone.side) == (None, side)
    for end in BY_NAME['rms'].bounds(both):
        one, two = (BY_NAME['rms'].at(case, end) for case in (alone, both))
        assert one.side == side
        assert one.onset == two.onset
    assert BY_NAME['viscosity'].at(alone, 0.1).side is None


def test_a_calibrated_onset_has_the_band_of_its_calibration(screw, oil):
    sheet = with_raceway(screw, onset_band=1.25, calibrated='2026-11-24')
    found = onset_bands(sheet, oil, 0.0, KELVIN)
    assert (found.unknown, found.narrowed) == ((0.8, 1.25), None)
    assert found.numerics == pytest.approx((math.exp(-INTERPOLATION), math.exp(INTERPOLATION)))


def test_smooth_raceways_have_no_band(screw, oil):
    found = onset_bands(with_raceway(screw, rms=0.0), oil, 0.0, KELVIN)
    assert found == OnsetBands(unknown=(1.0, 1.0), numerics=(1.0, 1.0))


def test_independent_inputs_add_up_as_squares_of_logarithms():
    def band(*factors):
        return unknown_band([('', ends) for ends in factors])

    assert band() == (1.0, 1.0)
    assert band([0.5, 1.5]) == pytest.approx((0.5, 1.5))
    assert band([0.5, 2.0], [2.0, 0.5]) == pytest.approx((0.5 ** math.sqrt(2), 2 ** math.sqrt(2)))
    # Both ends below: nothing above.
    assert band([0.8, 0.9]) == pytest.approx((0.8, 1.0))
    assert all(map(math.isnan, band([math.nan, 1.5])))


def test_a_spread_reaches_from_the_lowest_to_the_highest_and_over_the_stated_one():
    assert spread([0.5, 2.0]) == pytest.approx(math.log(4.0))
    assert spread([2.0, 4.0]) == pytest.approx(math.log(4.0))
    assert spread([0.25, 0.5]) == pytest.approx(math.log(4.0))
    assert spread([0.5, math.nan]) > 1e300
