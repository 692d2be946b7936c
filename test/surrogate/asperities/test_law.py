# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The asperity law: its curves at the onset and beyond both ends, contacts as sums of strips."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.asperities.law import (
    AsperityLaw,
    AT_REST,
    BEND,
    film_of,
    FILM_POWER,
    growth_of,
    LEAST_LOSS,
    loss_at,
    NINE_OF_TEN,
    ONSET_RCS,
    rcs_at,
    share_at,
    SLOPE,
)
from surrogate.asperities.topography import ActingRoughness
from surrogate.asperities.topography_onset import TopographyOnset
from surrogate.ehl import Condition, ContactLubricant
from surrogate.formulas.geometry import screw_contact, SIDES
from surrogate.formulas.line import line_at
from surrogate.parameters import load_screw
from surrogate.screw.opened import Contacts

SCREW = load_screw('nominal')
CONTACT, LOAD, FLOOR = screw_contact(SCREW, 'screw'), 27.6, 3e-9
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
HEIGHT = -16.0
"""Logarithm of a height that acts whatever the contact does [m^0.75]."""
ROUGH = TopographyOnset(
    acting=ActingRoughness(
        log_reduction=(8.0, 10.0, 12.0, 14.0),
        log_pressure=(18.0, 20.0, 22.0),
        log_height=((HEIGHT,) * 3,) * 4,
        lay=0.0,
        cut=0.0,
        shortest_wave=3e-6,
    )
)
SMOOTH = TopographyOnset(acting=None)
LAW = AsperityLaw(onsets={'screw': ROUGH, 'nut': SMOOTH}, deviation=0.15)
ONSET = ROUGH.speed(CONTACT, LOAD, OIL, FLOOR)


def contact_at(speed, side='screw', law=LAW):
    """Return what asperities do at an entrainment speed [m/s]; the nut is smooth."""
    condition = Condition(load=LOAD, entrainment_speed=speed)
    return law.contact(side, CONTACT, condition, OIL, FLOOR)


def test_the_curve_passes_the_marches_and_the_loss_stays_in_its_band():
    """RCS 0.01 at the onset; at half and a quarter of its speed 0.14 and 0.43 in 57 marches."""
    assert float(rcs_at(0.0)) == pytest.approx(ONSET_RCS)
    assert rcs_at(FILM_POWER * np.log([0.5, 0.25])) == pytest.approx([0.135, 0.43], rel=0.15)
    found = rcs_at(np.array([-math.inf, -12.0, 3.0, math.inf]))
    assert found.tolist() == pytest.approx([1.0, 1.0, 0.0, 0.0], abs=1e-4)
    assert found[2:].tolist() == [0.0, 0.0]
    assert share_at(np.array([0.0, 1.0])).tolist() == [0.0, 1.0]
    highest = loss_at(np.array([-1.0]), np.array([0.9e9]), 1.0, 1e3)
    assert highest == pytest.approx([LEAST_LOSS], 0.01)
    light, heavy = (
        loss_at(np.array([-1.0, 0.0]), np.full(2, pressure), 0.0, 17.0)
        for pressure in (0.5e9, 1.2e9)
    )
    assert light[1] < heavy[1]
    assert light[0] - light[1] < heavy[0] - heavy[1]


@pytest.mark.parametrize('curve', [rcs_at, lambda x: loss_at(x, np.array(0.4e9), 1.0, 17.0)])
def test_neither_a_step_nor_a_corner_stands_in_the_curves(curve):
    """Differences on both sides of every place agree, and so do their slopes: C1 in speed."""
    x = np.linspace(-8.0, 6.0, 14001)
    slope = np.diff(curve(x)) / (x[1] - x[0])
    assert np.abs(np.diff(slope)).max() < 4e-3
    assert np.abs(slope).max() < 0.8


def test_the_branch_of_slow_speeds_joins_in_value_and_slope_and_loss_ends_smooth():
    """Where the logit falls as the speed, oil carries in proportion to it; RCS counts in 1e-7."""
    apart = 1e-4
    thinnest = -(SLOPE + 1 / FILM_POWER) / (2 * BEND)
    below, at, above = rcs_at(thinnest + apart * np.array([-1.0, 0.0, 1.0]))
    assert (at - below) / apart == pytest.approx((above - at) / apart, rel=1e-3)
    assert (at - below) / apart == pytest.approx(-at * (1 - at) / FILM_POWER, rel=1e-3)
    slow = 1 - rcs_at(np.array([-10.0, -10.0 - FILM_POWER * math.log(2.0)]))
    assert slow[0] == pytest.approx(2 * slow[1], rel=1e-3)
    assert loss_at(np.array([60.0]), np.array([0.9e9]), 0.0, 17.0).tolist() == [1.0]


@given(x=st.floats(-20.0, 20.0), step=st.floats(1e-3, 3.0))
def test_contact_never_grows_with_the_speed(x, step):
    rcs = rcs_at(np.array([x, x + step]))
    for values in (rcs, share_at(rcs)):
        assert 0 <= values[1] <= values[0] <= 1
    assert (share_at(rcs) <= rcs).all()


@pytest.mark.parametrize(('lay', 'expected'), [(-1.0, 1.50), (0.0, 1.27), (1.0, 1.04)])
def test_the_loss_at_the_onset_falls_with_the_lay_and_far_beyond_it_is_smooth(lay, expected):
    loss = loss_at(np.array([0.0, 60.0]), np.array([0.9e9, 0.9e9]), lay, 17.0)
    assert loss == pytest.approx([expected, 1.0], abs=0.01)


@given(speed=st.floats(1e-5, 10.0), faster=st.floats(1.01, 10.0))
def test_contacts_touch_less_the_faster_they_roll(speed, faster):
    """The integral over the strips as each strip."""
    slow, fast = contact_at(speed), contact_at(faster * speed)
    assert 0 <= fast.rcs <= slow.rcs + 1e-12
    assert slow.rcs <= 1
    assert slow.asperity_share <= slow.rcs + 1e-12
    assert slow.rcs_deviation >= 0


def test_rest_touches_everywhere_a_smooth_raceway_nowhere_and_strips_enclose():
    """RCS over a contact is a mean of its places, between those of its extreme strips."""
    assert contact_at(0.0) == AT_REST
    assert contact_at(1e-9 * ONSET).rcs == pytest.approx(1.0)
    none = contact_at(0.1, 'nut')
    assert (none.rcs, none.asperity_share, none.rcs_deviation) == (0.0, 0.0, 0.0)
    assert none.loss_factor == pytest.approx(1.0)
    assert contact_at(100 * ONSET).rcs == 0.0
    strips = line_at(CONTACT, LOAD, np.linspace(0.0, 0.999, 200))
    onsets = ROUGH.speeds(strips, OIL, FLOOR)
    for over in (0.4, 1.0, 1.5):
        speed = np.array([over * ONSET])
        films = film_of(strips, speed, OIL) / film_of(strips, onsets[:, None], OIL)
        strip = rcs_at(np.log(films[:, 0]))
        assert strip.min() <= contact_at(over * ONSET).rcs <= strip.max()


@given(over=st.floats(0.3, 3.0), deviation=st.floats(0.0, 0.5))
def test_the_deviation_of_rcs_is_that_between_onsets_half_a_deviation_apart(over, deviation):
    """In film where marches set it; in speed where a calibration does."""
    speed = over * ONSET
    film, calibrated = (
        replace(LAW, deviation=deviation),
        replace(LAW, deviation=0.0, speed_deviation=deviation),
    )
    halves = [math.exp(side * 0.5 * deviation) for side in (1, -1)]
    onsets = [replace(ROUGH, film_factor=half) for half in halves]
    later, sooner = (
        contact_at(speed, law=replace(LAW, onsets={'screw': onset})).rcs for onset in onsets
    )
    found = contact_at(speed, law=film).rcs_deviation
    assert found == pytest.approx(later - sooner, abs=1e-12)
    slower, faster = (contact_at(speed / half).rcs for half in halves)
    found = contact_at(speed, law=calibrated).rcs_deviation
    assert found == pytest.approx(slower - faster, abs=1e-12)


def test_contact_grows_slower_on_plateaus():
    """At half of the onset speed marches have 0.13 where nothing was cut, 0.08 on plateaus."""
    uncut, plateau = (replace(ROUGH.acting, cut=cut) for cut in (0.0, -0.6))
    half = FILM_POWER * math.log(0.5)
    found = [float(rcs_at(half, growth_of(acting))) for acting in (uncut, plateau)]
    assert found == pytest.approx([0.13, 0.08], rel=0.25)
    assert found[1] < 0.9 * found[0]


def test_a_screw_has_one_law_whatever_does_not_touch_its_raceways(small_tiles):
    other = replace(
        SCREW,
        name='other',
        source='elsewhere',
        hysteresis_loss=0.01,
        flank_clearance=1e-5,
        parasitic_torque=0.1,
        roughness=replace(SCREW.roughness, asperity_friction=0.12),
    )
    run_in = replace(SCREW, roughness=replace(SCREW.roughness, state='run_in'))
    usual, same, worn = (Contacts.of(one).law.onsets for one in (SCREW, other, run_in))
    assert same == usual
    assert all(same[side].acting is usual[side].acting for side in SIDES)
    assert worn['screw'].acting != usual['screw'].acting


def test_the_onset_factor_scales_the_onset_and_nothing_else(small_tiles):
    """RCS over the speed by that of the onset stays, and a calibration sets the band."""
    faster = replace(SCREW, roughness=replace(SCREW.roughness, onset_factor=1.5))
    usual, law = (Contacts.of(one).law for one in (SCREW, faster))
    onset, scaled = (one.onsets['screw'].speed(CONTACT, LOAD, OIL, FLOOR) for one in (usual, law))
    assert scaled == pytest.approx(1.5 * onset)
    assert law.deviation == usual.deviation
    assert law.speed_deviation == 0
    for over in (0.3, 0.8, 1.2):
        slow, fast = (
            contact_at(over * speed, law=one) for one, speed in ((usual, onset), (law, scaled))
        )
        assert fast.rcs == pytest.approx(slow.rcs)
        assert fast.loss_factor == pytest.approx(slow.loss_factor)
    sheet = replace(faster.roughness, calibrated='2026-11-24', onset_band=1.15)
    sure = Contacts.of(replace(SCREW, roughness=sheet)).law
    assert sure.deviation == 0
    assert sure.speed_deviation == pytest.approx(math.log(1.15) / NINE_OF_TEN)
