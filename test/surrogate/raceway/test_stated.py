# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Roughness as a datasheet states it: its spectrum, its ball and the sentence of results."""

from dataclasses import replace
import math

import pytest
from surrogate.parameters import load_screw
from surrogate.raceway.ball import ball_of, roughness_sentence
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stated import BallRoughness, Roughness

STATED = load_screw('nominal').roughness
SMOOTH = Roughness(rms=0.0, asperity_friction=0.1)
BALL = BallRoughness(grade='G10')


def test_every_number_of_a_sheet_reaches_the_spectrum():
    """Each under its own name; those of the generator too."""
    numbers = {
        'rms': 0.2e-6,
        'cutoff_long': 0.8e-3,
        'cutoff_short': 8e-6,
        'rms_slope': math.radians(1.0),
        'lay': 'longitudinal',
        'fan_angle': math.radians(20.0),
        'scale_ratio': 1.4,
        'ridges': 7,
    }
    sheet = Roughness(**numbers, asperity_friction=0.12)
    assert sheet.spectrum == RoughnessSpectrum(**numbers)
    nominal = scale_spectrum(STATED)
    assert (nominal.rms, nominal.fractal_dimension) == (0.12e-6, 2.68)
    assert nominal.band.cutoff_long == pytest.approx(0.25e-3)
    assert not nominal.cutoff_by_table


def test_the_state_is_said_and_changes_no_wave():
    """Run in by default."""
    run_in = replace(STATED, state='run_in')
    assert run_in.spectrum == STATED.spectrum
    assert SMOOTH.state == 'run_in'
    assert roughness_sentence(run_in, None).startswith('raceway (run in): Rq 0.12 um between')
    assert roughness_sentence(STATED, None).startswith('raceway (new): Rq 0.12 um between')


@pytest.mark.parametrize(
    ('state', 'traced', 'pressure'),
    [('new', 'new', 6e9), ('run_in', 'new', 4e9), ('run_in', 'run_in', 6e9)],
)
def test_each_state_is_cut_at_its_own_pressure(state, traced, pressure):
    sheet = replace(STATED, state=state, traced=traced, hardness=6e9, run_in_pressure=4e9)
    assert sheet.cutting_pressure == pressure


def test_a_calibration_has_its_day_and_its_band(refused):
    """The sentence of results says both."""
    sheet = replace(STATED, onset_factor=0.6, calibrated='2026-11-24', onset_band=1.15)
    assert sheet.calibration == 'onset calibrated on 2026-11-24 within 1.15'
    assert roughness_sentence(sheet, None).startswith(roughness_sentence(STATED, None)[:20])
    assert sheet.calibration in roughness_sentence(sheet, None)
    assert replace(STATED, onset_factor=0.6).calibration == ''
    marched = replace(STATED, marched_film=0.95, marched_error=0.05)
    assert marched.calibration == (
        'film at the onset 0.95 times that by the topography, marched on this raceway within 1.09'
    )
    assert [one.measured for one in (sheet, marched, STATED)] == [True, True, False]
    with refused('marched_alone', name='marched_film'):
        replace(STATED, marched_film=0.95)
    with refused('marched_alone', name='marched_error'):
        replace(STATED, marched_error=0.05)
    with refused('given_alone', name='onset_band'):
        replace(STATED, onset_band=1.15)
    with refused('given_alone', name='calibrated'):
        replace(STATED, calibrated='2026-11-24')


def test_a_typical_rq_lies_in_its_range(refused):
    """Which is given with both ends, and of which the waves know nothing."""
    known = replace(STATED, rms=0.12e-6)
    sheet = replace(known, rms_low=0.1e-6, rms_high=0.12e-6)
    assert sheet.spectrum == known.spectrum
    for ends, (low, high) in (('0.13 to 0.2', (0.13e-6, 0.2e-6)), ('0.05 to 0.1', (5e-8, 1e-7))):
        with refused('likely_range', ends=ends):
            replace(known, rms_low=low, rms_high=high)
    for name in ('rms_low', 'rms_high'):
        with refused('likely_alone', name=name):
            replace(known, **{name: 0.12e-6})


def test_pressures_may_be_equal():
    """One that is sure, up to the hardness."""
    same = dict.fromkeys(('hardness', 'run_in_pressure', 'run_in_low', 'run_in_high'), 5e9)
    assert replace(STATED, state='run_in', **same).cutting_pressure == 5e9


def test_what_nobody_stated_is_said(says):
    raceway, _, ball = roughness_sentence(STATED, BALL).partition('; ')
    assert 'not stated' not in raceway
    assert ball.startswith('ball (G10): Rq 0.025 um')
    assert 'by the table for Ra = 0.8 Rq, not stated' in ball
    by_table = roughness_sentence(replace(STATED, cutoff_long=None), None)
    assert says('0_25_mm') in by_table
    assert by_table.endswith('ball: smooth, not stated')
    assert roughness_sentence(SMOOTH, BallRoughness(rms=0.0)) == 'raceway: smooth; ball: smooth'


def test_the_ball_shares_dimension_and_generator_of_the_raceway():
    """Its long cut-off is that of the table, by which balls are measured; none where smooth."""
    assert ball_of(STATED, BallRoughness(rms=0.0)) is None
    ball = ball_of(replace(STATED, ridges=4, scale_ratio=1.3), BALL)
    assert ball.fractal_dimension == 2.68
    assert ball.direction.size == 4
    assert ball.wave_number[1] / ball.wave_number[0] == pytest.approx(1.3)
    assert ball.band.cutoff_long == pytest.approx(0.08e-3)
    assert ball.rms == pytest.approx(0.025e-6)
