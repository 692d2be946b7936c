# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A solve on demand: the model itself, told step by step, and taken back at any of them."""

from dataclasses import asdict, replace
import json
import math

import pytest
from surrogate.builder.full.tier import solve_full
from surrogate.files import to_json
from surrogate.on_demand.solve import Cancelled, solve_point, solved_frame
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import ScrewSettings, solve_screw
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import FIELDS

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
HEADER = {'tier': 'full', 'inputs': {'screw': asdict(SCREW), 'lubricant': asdict(OIL)}}
POINT = {'speed': 6.0, 'opposing_load': 500.0, 'temperature': 313.15}


def request(header=HEADER, **changes):
    return {'header': header, 'point': POINT | changes}


@pytest.fixture(scope='module', name='solved')
def solve_once():
    """Return a point solved from the inputs of its surface, and the steps on the way."""
    steps = []
    return solve_point(request(), progress=steps.append), steps


@pytest.mark.parametrize('load', [500.0, -500.0])
def test_it_is_solved_as_the_surface_was(load):
    found = solve_point(request(opposing_load=load))
    whole = solve_full(HEADER, 6.0, load, 313.15)
    assert found.converged
    # A surface solves both senses of a load on contacts of one of them.
    for name in FIELDS:
        assert found.means[name] == pytest.approx(getattr(whole, name), rel=1e-4)


def test_a_surface_of_formulas_is_solved_as_its_screw_is():
    found = solve_point(request(HEADER | {'tier': 'closed_form'}))
    point = OperatingPoint(speed=6.0, load=500.0, temperature=313.15)
    alone = solve_screw(SCREW, OIL, point)
    expected = {name: getattr(alone, name) for name in FIELDS}
    assert {name: found.means[name] for name in FIELDS} == expected
    assert found.worst_contact == alone.worst_contact
    assert found.status == alone.status
    run_in = HEADER['inputs'] | {'screw': asdict(with_raceway(SCREW, state='run_in'))}
    assert found.means['rcs'] > solve_point(request({'inputs': run_in})).means['rcs'] > 0


def test_what_is_uncertain_is_the_rcs_between_strips_in_strict_json(solved):
    found, _ = solved
    assert found.deviations['rcs'] > 0
    assert found.standard_errors['rcs'] == found.deviations['rcs']
    for name in set(FIELDS) - {'rcs'}:
        assert math.isnan(found.deviations[name])
        assert math.isnan(found.standard_errors[name])
    frame = json.loads(json.dumps(to_json(solved_frame(found)), allow_nan=False))
    assert frame['means']['rcs'] == found.means['rcs']
    assert set(frame['standard_errors']) == set(FIELDS)
    assert frame['standard_errors']['friction_torque'] is None


def test_draws_are_ignored_and_steps_name_every_contact_from_begin_to_end(solved):
    found, _ = solved
    assert solve_point(request() | {'draws': 16}).means == found.means
    _, steps = solved
    fractions = [step['fraction'] for step in steps]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert fractions[-1] == 3 / 4
    assert {(one['nut'], one['side']) for one in steps} == {(1, 1), (1, 2), (2, 1), (2, 2)}
    assert {step['stage'] for step in steps} == {'smooth contact'}
    assert all(step['residual'] >= 0.0 for step in steps)


@pytest.mark.parametrize('after', [0, 5, 12])
def test_it_can_be_taken_back_at_every_step(after):
    steps = []
    with pytest.raises(Cancelled):
        solve_point(request(), progress=steps.append, cancel=lambda: len(steps) >= after)
    assert len(steps) == after


def test_a_solve_that_does_not_converge_is_a_status(monkeypatch):
    point = OperatingPoint(speed=6.0, load=500.0, temperature=313.15)
    alone = solve_screw(SCREW, OIL, point, settings=ScrewSettings(kinematics='smooth'))
    stalled = replace(alone, converged=False, status='Stalled.')
    monkeypatch.setattr('surrogate.on_demand.solve.solve_screw', lambda *given, **how: stalled)
    found = solve_point(request())
    assert (found.converged, found.status, found.means) == (False, 'Stalled.', {})
