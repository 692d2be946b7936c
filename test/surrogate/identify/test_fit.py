# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Identification of known answers: exact, noisy, weighed, bounded, degenerate."""

from dataclasses import replace
import math

import numpy as np
import pytest
from scipy.stats import binom
from surrogate.formulas.lubricant import lubricant_state
from surrogate.identify.data import no_load_run
from surrogate.identify.fit import identify
from surrogate.identify.model import anchored, bare, closed_form_model, ContactModel, thickened
from surrogate.identify.record import identification_record, identified_oil, identified_screw, page
from surrogate.parameters import load_lubricant, load_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
WARM = 313.15
SPEED = np.geomspace(50.0, 2000.0, 12) * math.pi / 30
BOTH = np.concatenate([SPEED, -SPEED])
CONSTANT, RATE, OFFSET = 0.12, 4e-4, 0.03
ALL = ('viscosity_factor', 'asperity_friction')


def recording(speed=SPEED, *, factor=1.0, friction=0.1, offset=0.0, noise=None, **columns):
    """Return a run whose torque follows from known parameters, and its contacts."""
    blank = no_load_run(
        {'speed': speed, 'torque': speed} | columns, source='synthetic', temperature=WARM
    )
    contacts = closed_form_model(SCREW, OIL, blank)
    drag = (
        np.sign(speed) * (contacts.torque(factor, friction, 1.0) + CONSTANT)
        + RATE * speed
        + offset
    )
    drag = drag + blank.load * SCREW.lead / (2 * math.pi)
    return replace(blank, torque=drag if noise is None else drag + noise), contacts


def test_known_answers_come_out_of_one_direction():
    """Constant and rate exactly, with what the datasheet said before left out."""
    run, contacts = recording()
    sheet = replace(SCREW, parasitic_torque=0.5, parasitic_torque_rate=0.01)
    found = identify(sheet, run, contacts)
    assert found.converged
    assert [one.name for one in found.estimates] == ['parasitic_torque', 'parasitic_torque_rate']
    assert found.value('parasitic_torque') == pytest.approx(CONSTANT, rel=1e-9)
    assert found.value('parasitic_torque_rate') == pytest.approx(RATE, rel=1e-9)
    assert math.isnan(found.value('torque_offset'))
    np.testing.assert_allclose(found.before - found.contacts, 0.5 + 0.01 * SPEED, rtol=1e-12)
    np.testing.assert_allclose(found.after, run.torque, rtol=1e-12)
    assert found.rms < 1e-12 < found.rms_before


@pytest.mark.parametrize('loss', ['linear', 'soft_l1'])
def test_known_answers_come_out_of_both_directions_with_all_parameters(loss):
    """The offset is what does not change sign; viscosity and asperity friction act apart."""
    run, contacts = recording(BOTH, factor=1.3, friction=0.08, offset=OFFSET)
    found = identify(SCREW, run, contacts, ALL, loss=loss)
    expected = (CONSTANT, RATE, OFFSET, 1.3, 0.08)
    assert [one.value for one in found.estimates] == pytest.approx(expected, rel=1e-6)
    assert found.correlation.shape == (5, 5)
    assert np.diag(found.correlation) == pytest.approx(np.ones(5))


def test_load_and_temperature_of_each_point_are_taken_into_account():
    """The share of the load in the torque has the sign of the load, not of the motion."""
    warmth = np.linspace(300.0, 320.0, 24)
    load = np.linspace(-200.0, 200.0, 24)
    run, contacts = recording(BOTH, offset=OFFSET, load=load, temperature=warmth)
    found = identify(SCREW, run, contacts)
    assert [one.value for one in found.estimates] == pytest.approx((CONSTANT, RATE, OFFSET))
    unaware = replace(run, load=0 * load)
    assert identify(SCREW, unaware, contacts).rms > 0.01


@pytest.mark.parametrize(
    ('fitted', 'loss', 'draws'),
    [((), 'linear', 400), (('viscosity_factor',), 'linear', 100), ((), 'soft_l1', 400)],
)
def test_the_interval_holds_the_truth_as_often_as_it_says(fitted, loss, draws):
    """
    Many seeded draws: 95 % within the bounds of a binomial count at 1 in 10 000.

    Of contacts whose torque is a power of viscosity and speed: no draw waits for formulas.

    """
    clean, contacts = recording(BOTH, offset=OFFSET)
    contacts = replace(contacts, torque=lambda factor, *_: 2e-3 * (factor * np.abs(BOTH)) ** 0.7)
    drag = np.sign(BOTH) * (contacts.torque(1.0) + CONSTANT) + RATE * BOTH + OFFSET
    clean = replace(clean, torque=drag)
    truth = {'parasitic_torque': CONSTANT, 'parasitic_torque_rate': RATE, 'torque_offset': OFFSET}
    truth['viscosity_factor'] = 1.0
    drawn = np.random.default_rng(11)
    held = dict.fromkeys(truth, 0)
    for _ in range(draws):
        noise = 1e-3 * drawn.standard_normal(len(BOTH))
        run = replace(clean, torque=clean.torque + noise)
        for one in identify(SCREW, run, contacts, fitted, loss=loss).estimates:
            held[one.name] += one.low <= truth[one.name] <= one.high
    low, high = binom.interval(1 - 1e-4, draws, 0.95)
    counted = [count for name, count in held.items() if fitted or name != 'viscosity_factor']
    assert all(low <= count <= high for count in counted), held


def test_the_band_holds_as_many_points():
    """The 95 % band of the picture, over fresh points of the same scatter."""
    clean, contacts = recording(BOTH, offset=OFFSET)
    drawn, inside, draws = np.random.default_rng(3), 0, 200
    for _ in range(draws):
        first, second = 1e-3 * drawn.standard_normal((2, len(BOTH)))
        found = identify(SCREW, replace(clean, torque=clean.torque + first), contacts)
        inside += int((np.abs(clean.torque + second - found.after) <= found.band).sum())
    assert inside / (draws * len(BOTH)) == pytest.approx(0.95, abs=0.015)


def test_points_weigh_by_their_deviation_and_a_robust_loss_lets_one_go():
    """A point known badly does not count; a bad one of a dozen hardly moves the robust loss."""
    noise = np.zeros(12)
    noise[5] = 0.1
    sigma = np.full(12, 1e-4)
    sigma[5] = 10.0
    run, contacts = recording(noise=noise, torque_std=sigma)
    found = identify(SCREW, run, contacts)
    assert found.value('parasitic_torque') == pytest.approx(CONSTANT, abs=1e-6)
    assert found.reduced_chi_square < 0.01
    assert math.isnan(identify(SCREW, replace(run, torque_std=None), contacts).reduced_chi_square)
    noise = 1e-4 * np.random.default_rng(2).standard_normal(12)
    noise[3] += 0.2
    run, contacts = recording(noise=noise)
    plain, robust = (identify(SCREW, run, contacts, loss=loss) for loss in ('linear', 'soft_l1'))
    assert abs(plain.value('parasitic_torque') - CONSTANT) > 0.01
    assert robust.value('parasitic_torque') == pytest.approx(CONSTANT, abs=1e-3)


def test_a_bound_that_is_met_is_said_and_has_no_interval():
    """Torque that falls with speed asks for a negative rate; the rest is fitted without it."""
    run, contacts = recording(noise=-1e-3 * SPEED)
    found = identify(SCREW, run, contacts)
    constant, rate = found.estimates
    assert rate.value == 0.0
    assert rate.reason == 'at its lower bound 0, the data ask for less'
    assert math.isnan(rate.low)
    assert math.isnan(rate.high)
    expected = float((run.torque - found.contacts).mean())
    assert constant.value == pytest.approx(expected, rel=1e-9)
    assert constant.low < expected < constant.high
    assert found.correlated == ('parasitic_torque',)
    assert found.degrees_of_freedom == 11
    record = identification_record(SCREW, run, contacts, found)
    assert any('rises less with speed than that of' in text for text in record['warnings'])
    thin, thin_contacts = recording(factor=3.0)
    viscosity = identify(SCREW, thin, thin_contacts, ALL[:1]).estimates[-1]
    assert viscosity.value == 2.0
    assert viscosity.reason == 'at its upper bound 2, the data ask for more'


def test_what_the_data_cannot_tell_has_no_interval(says, one_small_tile):
    """Two speeds and three parameters; and friction of asperities that never touch."""
    run, contacts = recording(np.repeat([95.0, 209.0], 5))
    found = identify(SCREW, run, contacts, ALL[:1])
    assert all('the data cannot tell' in one.reason for one in found.estimates)
    assert all(math.isnan(one.standard_error) for one in found.estimates)
    assert found.correlated == ()
    smooth = replace(SCREW, roughness=replace(SCREW.roughness, rms=1e-9))
    run, _ = recording()
    with one_small_tile():
        found = identify(smooth, run, closed_form_model(smooth, OIL, run), ALL[1:])
    assert found.estimates[-1].reason == says('point_depends_kept')
    assert found.value('asperity_friction') == SCREW.roughness.asperity_friction
    assert math.isfinite(found.estimates[0].standard_error)


@pytest.mark.parametrize(
    ('speed', 'sentence'),
    [
        (SPEED[:3], 'has_3_points'),
        (np.full(9, 60.0), 'speeds_reach_from'),
        (np.linspace(60.0, 119.0, 9), 'span_2_1'),
        (np.zeros(9), 'holds_point_motion'),
        (np.zeros(0), 'holds_point_motion'),
    ],
)
def test_a_run_that_cannot_tell_is_refused(speed, sentence, refused):
    run = no_load_run({'speed': speed, 'torque': speed}, source='synthetic', temperature=WARM)
    nothing = ContactModel(
        torque=lambda factor, friction: 0 * run.speed,
        asperity_share=0 * run.speed,
        tier='none',
        screw=SCREW,
        lubricant=OIL,
    )
    refused(sentence, identify, SCREW, run, nothing)


def test_torque_against_the_motion_is_refused(refused):
    """A sign that is lost, in one direction; in both it shows as no friction at all."""
    run, contacts = recording()
    refused('friction_has_sign', identify, SCREW, replace(run, torque=-run.torque), contacts)
    run, contacts = recording(BOTH)
    found = identify(SCREW, replace(run, torque=np.abs(run.torque)), contacts)
    assert [one.value for one in found.estimates][:2] == [0.0, 0.0]
    record = identification_record(SCREW, run, contacts, found)
    assert any('take more torque than was measured' in text for text in record['warnings'])


def test_parameters_that_cannot_be_told_apart_and_the_offset_are_said(says):
    """0.03 N m on a lead of 10 mm are 18.8 N; nothing is said of one direction."""
    run, contacts = recording(np.geomspace(70.0, 200.0, 12))
    record = identification_record(SCREW, run, contacts, identify(SCREW, run, contacts, ALL[:1]))
    assert says('viscosity_factor_correlated') in ' | '.join(record['warnings'])
    run, contacts = recording(BOTH, offset=OFFSET)
    record = identification_record(SCREW, run, contacts, identify(SCREW, run, contacts))
    assert record['offset_force_N'] == pytest.approx(18.85, abs=0.01)
    assert 'offset as a load       18.8 N' in page(record)
    assert not [text for text in record['warnings'] if 'one direction' in text]


def test_the_record_is_whole_and_warns():
    """Units, shares, correlation; asperities, load and scatter."""
    noise = 1e-3 * np.random.default_rng(4).standard_normal(12)
    run, contacts = recording(noise=noise, torque_std=np.full(12, 1e-5), load=np.full(12, 300.0))
    found = identify(SCREW, run, contacts, ALL[:1])
    record = identification_record(SCREW, run, contacts, found)
    text = ' | '.join(record['warnings'])
    assert 'points have an asperity share above 0.1' in text
    assert 'the residual is ' in text
    assert 'the load is up to 300 N' in text
    assert 'one direction only' in text
    assert math.isnan(record['offset_force_N'])
    low, high = record['contact_share_range']
    assert 0 < low < high < 1
    assert 'parasitic_torque_rate' in page(record)
    assert [one['unit'] for one in record['parameters']] == ['N m', 'N m s/rad', '-']


def test_identified_sheets_hold_what_was_found_and_say_from_where(says):
    """A sheet that is identified again names its last source only."""
    run, contacts = recording(BOTH, factor=1.3, friction=0.08, offset=OFFSET)
    found = identify(SCREW, run, contacts, ALL)
    screw = identified_screw(SCREW, run, contacts, found)
    assert screw.name == 'nominal_identified'
    assert screw.parasitic_torque == pytest.approx(CONSTANT, rel=1e-6)
    assert screw.roughness.asperity_friction == pytest.approx(0.08, rel=1e-6)
    assert screw.source.startswith(SCREW.source)
    assert says('synthetic_24_points') in screw.source
    again = identified_screw(screw, run, contacts, found)
    assert again == screw
    oil = identified_oil(OIL, run, contacts, found)
    assert oil.viscosity == pytest.approx(1.3 * OIL.viscosity, rel=1e-6)
    assert oil.name == 'iso_vg_68_identified'


@pytest.mark.parametrize('kelvin', [293.15, WARM, 340.0])
def test_an_oil_anchored_elsewhere_is_the_same_oil_there(kelvin):
    """Viscosity, pressure-viscosity and density at the anchor; a factor thickens it by that."""
    before, after = lubricant_state(OIL, kelvin), lubricant_state(anchored(OIL, kelvin), kelvin)
    for name in ('viscosity', 'pressure_viscosity', 'density'):
        assert float(getattr(after, name)) == pytest.approx(float(getattr(before, name)))
    thick = lubricant_state(thickened(anchored(OIL, kelvin), 1.5), kelvin)
    assert float(thick.viscosity / before.viscosity) == pytest.approx(1.5)
    assert bare(replace(SCREW, parasitic_torque=1.0)).parasitic_torque == 0.0
