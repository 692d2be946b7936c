# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The profile over the onset factor: ends of known curves, bounds, and fits of known answers."""

from dataclasses import replace
from functools import cache
import math

import numpy as np
import pytest
from surrogate.identify.data import no_load_run
from surrogate.identify.fit import identify
from surrogate.identify.intervals import student_factor
from surrogate.identify.model import ONSET_BOUNDS
from surrogate.identify.onset import (
    calibrated_band,
    EXTRAPOLATION,
    FITTED,
    onset_speeds,
    OnsetScan,
    scan_onset,
)
from surrogate.identify.problem import drag_problem
from surrogate.identify.record import identification_record, identified_screw, page
from surrogate.identify.table import formula_model
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.units import RPM

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
WARM, FREEDOM = 313.15, 18
SLOW = np.geomspace(5.0, 1000.0, 12) * RPM
FAST = np.geomspace(400.0, 2000.0, 12) * RPM
NOISE = 1e-5
"""Standard deviation of a point [N m], with which all parameters can be told."""
FACTOR, FRICTION, CONSTANT, RATE, SEAL = 0.6, 0.08, 0.05, 3e-4, 4e-3


STAIRS = np.geomspace(3.0, 1000.0, 14)
"""Speeds of a staircase [rev/min]."""
DRAG = {
    'slow_fade': (300.0, 0.3, 0.30),
    'late_contact': (700.0, 0.3, 0.30),
    'quick_fade': (700.0, 0.02, 0.30),
    'half_the_drag': (700.0, 0.02, 0.15),
    'no_film': (500.0, 0.005, 0.30),
}
"""Speed of the onset [rev/min], sliding speed over which a seal fades [m/s], its drag [N m]."""
CAUSES = {
    'slow_fade': 'seal_takes',
    'late_contact': 'seal_takes',
    'quick_fade': 'friction_asks',
    'half_the_drag': 'residual_left',
    'no_film': 'friction_asks',
}


@cache
def stairs():
    """Return a staircase whose torque is still to come, and the contacts that are fitted to it."""
    speed = np.concatenate([STAIRS, -STAIRS]) * RPM
    run = no_load_run({'speed': speed, 'torque': speed}, source='stairs', temperature=WARM)
    return run, formula_model(SCREW, OIL, run, FITTED)


def stribeck(begins, fades, drag):
    """
    Return a staircase by the curve of a textbook, and the contacts that are fitted to it.

    Contacts: 60 mN m of boundary friction that fade exponentially with the speed, and viscous drag
    with its power 0.6. Beside them a constant and an exponentially fading half of `drag` [N m],
    a drag in proportion to the speed and a ripple of 1 %.

    """
    run, model = stairs()
    speed = run.speed
    turns = np.abs(speed) / RPM
    contacts = 0.06 * np.exp(-turns / (0.3 * begins)) + 0.05 * (turns / 600) ** 0.6
    beside = 0.5 * drag * (1 + np.exp(-np.abs(speed) * SCREW.pitch_radius / fades))
    ripple = 1 + 0.01 * np.random.default_rng(7).standard_normal(len(speed))
    torque = run.direction * (contacts + beside) * ripple + 1e-4 * speed
    return replace(run, torque=torque), model


def parabola(centre, error):
    """Return the cost over the logarithm of the factor of a fit with a standard `error` [-]."""
    return lambda factor: (FREEDOM + (math.log(factor / centre) / error) ** 2, math.nan)


def staircase(speed):
    """Return a run of a known onset on a staircase [rad/s], and its contacts."""
    speed = np.concatenate([speed, -speed])
    columns = {'speed': speed, 'torque': speed, 'torque_std': NOISE + 0 * speed}
    run = no_load_run(columns, source='staircase', temperature=WARM)
    contacts = formula_model(SCREW, OIL, run, FITTED)
    seal = SEAL * np.exp(-SCREW.pitch_radius * np.abs(speed) / 0.015)
    drag = contacts.torque(1.0, FRICTION, FACTOR) + CONSTANT + seal
    noise = NOISE * np.random.default_rng(5).standard_normal(len(speed))
    return replace(run, torque=run.direction * drag + RATE * speed + noise), contacts


@pytest.fixture(scope='module')
def slow():
    return staircase(SLOW)


@pytest.fixture(scope='module')
def found(slow):
    return identify(SCREW, *slow, FITTED)


def test_a_parabola_has_the_interval_of_its_error():
    scan = scan_onset(parabola(1.0, 0.3), FREEDOM, 'isotropic')
    assert scan.closed
    assert scan.best == pytest.approx(1.0)
    width = 0.3 * student_factor(FREEDOM)
    assert math.log(scan.high) == pytest.approx(width, rel=0.02)
    assert math.log(scan.low) == pytest.approx(-width, rel=0.02)
    low, high = scan.interval(1.0)
    extrapolated = student_factor(FREEDOM) * math.hypot(0.3, EXTRAPOLATION['isotropic'])
    assert math.log(high / low) == pytest.approx(2 * extrapolated, rel=0.02)


def test_the_extrapolation_to_the_onset_is_less_sure_with_a_lay():
    """Twice as wide and more, in the interval and in a bound."""
    scans = [scan_onset(parabola(1.0, 0.01), FREEDOM, lay) for lay in EXTRAPOLATION]
    isotropic, *ridged = (np.ptp(np.log(scan.interval(1.0))) for scan in scans)
    assert min(ridged) > 2 * isotropic
    opened = [replace(scan, low=0.0).bound(10.0)[0] for scan in scans]
    assert min(opened[1:]) > opened[0]


def test_a_profile_that_falls_again_allows_what_lies_there():
    """Of two valleys both belong to the interval."""
    one, other = parabola(0.5, 0.1), parabola(3.0, 0.1)

    def valleys(factor):
        return min(one(factor)[0], 1.0 + other(factor)[0]), math.nan

    scan = scan_onset(valleys, FREEDOM, 'isotropic')
    assert scan.best == pytest.approx(0.5, rel=0.05)
    assert scan.low < 0.5 < 3.0 < scan.high


@pytest.mark.parametrize(
    ('centre', 'stated', 'kept', 'words'),
    [
        (ONSET_BOUNDS[0], 1.0, False, 'no more than with a seal that fades: at most'),
        (ONSET_BOUNDS[0], 0.1, True, 'no more than with a seal that fades: at most'),
        (ONSET_BOUNDS[1], 1.0, False, 'does not rise at high speed: at least'),
        (ONSET_BOUNDS[1], 10.0, True, 'does not rise at high speed: at least'),
    ],
)
def test_an_open_end_is_a_bound(centre, stated, kept, words):
    """The stated factor stays where the bound allows it."""
    scan = scan_onset(parabola(centre, 0.3), FREEDOM, 'isotropic')
    assert not scan.closed
    value, reason = scan.bound(stated)
    assert words in reason
    assert (value == stated) is kept
    end = scan.high if 'most' in words else scan.low
    beyond = math.exp(1.645 * EXTRAPOLATION['isotropic'])
    assert kept or value == pytest.approx(
        end * beyond if 'most' in words else end / beyond, rel=1e-3
    )


def test_a_flat_profile_tells_nothing():
    flat = OnsetScan(
        costs=np.ones(3), best=1.0, low=0.0, high=math.inf, freedom=18, extrapolation=0.16
    )
    value, reason = flat.bound(0.7)
    assert value == 0.7
    assert 'tells nothing' in reason


def test_the_band_of_nine_of_ten_is_narrower_than_the_interval():
    assert calibrated_band(math.exp(-1.96), math.exp(1.96)) == pytest.approx(
        math.exp(1.645), rel=1e-3
    )


def test_known_answers_come_out_together(found):
    """Onset, boundary friction, seal and both parasitic parts."""
    assert found.converged
    assert found.value('onset_factor') == pytest.approx(FACTOR, rel=0.03)
    assert found.value('asperity_friction') == pytest.approx(FRICTION, rel=0.02)
    assert found.value('parasitic_torque') == pytest.approx(CONSTANT, rel=0.02)
    assert found.value('parasitic_torque_rate') == pytest.approx(RATE, rel=0.03)
    assert found.value('seal_torque') == pytest.approx(SEAL, rel=0.1)
    onset = found.estimate('onset_factor')
    assert onset.low < FACTOR < onset.high
    assert math.log(onset.high / onset.low) > 4 * EXTRAPOLATION['isotropic']


def test_the_sheet_is_calibrated_and_says_so(slow, found):
    """A surface from it begins to touch where the machine does."""
    run, contacts = slow
    sheet = identified_screw(SCREW, run, contacts, found, '2026-11-24')
    assert sheet.roughness.calibration.startswith('onset calibrated on 2026-11-24 within 1.3')
    points = [onset_point(Contacts.of(one), OIL, 0.0, WARM) for one in (SCREW, sheet)]
    behind_inlet = [one['entrainment_speed_m_s'] for one in points]
    factor = found.value('onset_factor')
    assert behind_inlet[1] == pytest.approx(factor * behind_inlet[0])
    begins = [one['speed_rad_s'] for one in points]
    assert begins[1] == pytest.approx(factor * begins[0], rel=0.01)
    assert onset_speeds(contacts, run, (factor, 1.0, 1.0))[:2] == pytest.approx(begins[::-1])


def test_the_page_says_what_is_extrapolated(slow, found, says):
    record = identification_record(SCREW, *slow, found)
    assert record['onset']['speed_low_rad_s'] < record['onset']['speed_rad_s']
    assert record['onset']['turns_up_rad_s'] < record['onset']['speed_rad_s']
    assert says('rcs_itself') in page(record)
    assert says('lumped') in record['warnings']


def test_without_an_upturn_there_is_a_bound_and_no_calibration(says):
    run, contacts = staircase(FAST)
    found = identify(SCREW, run, contacts, FITTED)
    onset = found.estimate('onset_factor')
    assert math.isnan(onset.low)
    assert says('turn_up') in onset.reason
    assert FACTOR <= float(onset.reason.split('at most ')[1].split()[0]) < 3
    assert found.value('asperity_friction') == SCREW.roughness.asperity_friction
    sheet = identified_screw(SCREW, run, contacts, found, '2026-11-24')
    assert sheet.roughness.calibration == ''
    assert 'no more than with a seal' in page(identification_record(SCREW, run, contacts, found))


def test_a_bound_below_the_datasheet_leaves_its_onset_and_calibration(says):
    """A factor that is lowered would tell of an oil film where none is known."""
    run, contacts = staircase(FAST)
    stated = with_raceway(SCREW, onset_factor=9.0, onset_band=1.5, calibrated='2026-01-02')
    found = identify(stated, run, formula_model(stated, OIL, run, FITTED), FITTED)
    onset = found.estimate('onset_factor')
    assert says('turn_up') in onset.reason
    assert float(onset.reason.split('at most ')[1].split()[0]) < 9.0
    sheet = identified_screw(stated, run, contacts, found, '2026-11-24')
    assert sheet.roughness == stated.roughness


@pytest.mark.parametrize('key', DRAG)
def test_drag_beside_the_contacts_makes_no_calibration(key, says):
    """Two to eight times theirs: friction, onset, seal or the residual goes beyond its range."""
    run, contacts = stribeck(*DRAG[key])
    found = identify(SCREW, run, contacts, FITTED)
    assert found.onset_refused
    onset = found.estimate('onset_factor')
    assert (onset.value, math.isnan(onset.low)) == (SCREW.roughness.onset_factor, True)
    assert says(CAUSES[key]) in onset.reason
    assert found.value('asperity_friction') == SCREW.roughness.asperity_friction
    record = identification_record(SCREW, run, contacts, found)
    assert (record['converged'], record['status']) == (True, says('refused'))
    assert f'  contact begins         {onset.reason}\n' in page(record)


def test_a_band_that_tells_no_more_than_the_law_is_no_calibration(says):
    """Both ends are known, but nine of ten lie within more than 2.5."""
    scan = scan_onset(parabola(1.0, 0.6), FREEDOM, 'isotropic')
    assert scan.closed
    assert not scan.calibrates
    low, high = (f'{end:.3g}' for end in scan.interval(scan.best))
    assert scan.bound(1.2) == (1.2, says('wide', low=low, high=high))
    assert scan.bound(9.0)[0] == pytest.approx(math.exp(student_factor(FREEDOM) * 0.62), rel=0.02)


def test_what_both_directions_of_a_speed_share_is_misfit_and_not_noise():
    """Residuals with the sign of the motion are an error of the model, others are an offset."""
    run, model = stairs()
    problem = drag_problem(SCREW, run, model, FITTED)
    groups, values = len(STAIRS), 7
    assert problem.misfit(0.3 * run.direction) == pytest.approx(
        2 * groups * 0.09 / (groups - values)
    )
    assert problem.misfit(np.full(2 * groups, 0.3)) == pytest.approx(0.0)


@pytest.mark.parametrize('fades', [0.007, 0.05, 0.2])
@pytest.mark.parametrize('power', [0.6, 1.0, 1.7])
def test_the_fade_of_a_seal_is_found_with_all_else(fades, power):
    """Within half of a ripple of 1 %, between the fades from which it starts."""
    run, model = stairs()
    problem = drag_problem(SCREW, run, model, FITTED)
    left = np.exp(-((np.abs(run.speed) * SCREW.pitch_radius / fades) ** power))
    contacts = model.torque(1.0, 0.09, 0.7)
    torque = run.direction * (contacts + 0.2 + 0.06 * left) + 1e-4 * run.speed - 0.01
    problem = replace(problem, run=replace(run, torque=torque))
    start = problem.start.copy()
    start[problem.names.index('onset_factor')] = 0.7
    faded, values = problem.with_best_fade(start, (), np.ones_like(torque))
    assert np.abs(faded.residual(values) / torque).max() < 0.005
    assert values[problem.names.index('torque_offset')] == pytest.approx(-0.01, rel=1e-3)
    held = problem.with_best_fade(start, ('asperity_friction',), np.ones_like(torque))[1]
    assert held[problem.names.index('asperity_friction')] == SCREW.roughness.asperity_friction


@pytest.mark.parametrize(('turns', 'seed'), [(60, 0), (60, 2), (120, 1), (250, 3)])
def test_seals_that_fade_as_contact_does_are_not_calibrated_as_contact(turns, seed):
    """0.15 N m that fade over 0.1 to 0.4 m/s beside 0.2 N m, onset at a tenth of the sheet's."""
    run, model = stairs()
    machine = with_raceway(SCREW, onset_factor=0.1, asperity_friction=0.1)
    drag = closed_form.solve(Contacts.of(machine), OIL, np.abs(run.speed), 0.0, WARM)
    seal = 0.15 * np.exp(-np.abs(run.speed) / (turns * RPM))
    ripple = 1 + 0.01 * np.random.default_rng(seed).standard_normal(len(run.speed))
    torque = run.direction * (drag.friction_torque + 0.2 + seal) * ripple
    onset = identify(SCREW, replace(run, torque=torque), model, FITTED).estimate('onset_factor')
    assert onset.reason or onset.low < 0.1 < onset.high


def test_runs_that_tell_no_onset_are_refused(slow, refused):
    """Few speeds, and raceways that never touch."""
    run, contacts = slow
    two = np.tile([5 * RPM, 900 * RPM], 6)
    few = replace(run, speed=two, torque=two, torque_std=None)
    refused('two_speeds', identify, SCREW, few, contacts, FITTED)
    smooth = replace(SCREW, roughness=replace(SCREW.roughness, rms=0.0))
    refused('smooth', identify, smooth, run, replace(contacts, screw=smooth), FITTED)
