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
from surrogate.surface import FIELDS

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
HEADER = {
    'tier': 'full',
    'inputs': {'screw': asdict(SCREW), 'lubricant': asdict(OIL)},
    'settings': {'draws': 2, 'grid_wavelength': 30e-6},
}
POINT = {'speed': 100.0, 'opposing_load': 500.0, 'temperature': 313.15}


def request(draws=0, header=HEADER, **changes):
    return {'header': header, 'point': POINT | changes, 'draws': draws}


@pytest.fixture(scope='module', name='solved')
def solve_once():
    """Return a point solved with the draws of its surface, and the steps on the way."""
    steps = []
    return solve_point(request(), progress=steps.append), steps


def test_without_a_number_of_draws_it_is_solved_as_the_surface_was(solved):
    found, _ = solved
    whole = solve_full(HEADER, 100.0, 500.0, 313.15)
    assert (found.converged, found.draws) == (True, 2)
    for name in FIELDS:
        assert found.means[name] == pytest.approx(getattr(whole, name), rel=1e-12)


@pytest.mark.parametrize('load', [500.0, -500.0])
def test_with_a_number_of_draws_it_is_a_point_by_itself(load):
    found = solve_point(request(1, opposing_load=load))
    point = OperatingPoint(speed=100.0, load=load, temperature=313.15)
    alone = solve_screw(SCREW, OIL, point, settings=replace(ScrewSettings(), draw=0))
    assert {name: found.means[name] for name in FIELDS} == {
        name: getattr(alone, name) for name in FIELDS
    }
    assert found.worst_contact == alone.worst_contact
    assert found.status == alone.status
    assert all(math.isnan(error) for error in found.standard_errors.values())


def test_the_standard_error_is_that_of_the_draws(solved):
    found, _ = solved
    for name in FIELDS:
        assert found.standard_errors[name] == pytest.approx(
            found.deviations[name] / math.sqrt(2), rel=1e-12, abs=1e-15
        )


def test_steps_go_from_begin_to_end_and_name_every_contact(solved):
    _, steps = solved
    fractions = [step['fraction'] for step in steps]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert fractions[-1] == (1 + 3 / 4) / 2
    rough = {(one['nut'], one['side']) for one in steps if 'rough' in one['stage']}
    assert rough == {(1, 1), (1, 2), (2, 1), (2, 2)}
    assert {step['stage'].partition(',')[0] for step in steps} == {'draw 1 of 2', 'draw 2 of 2'}
    assert all(step['residual'] >= 0.0 for step in steps)


@pytest.mark.parametrize('after', [0, 5, 40])
def test_it_can_be_taken_back_at_every_step(after):
    steps = []
    with pytest.raises(Cancelled):
        solve_point(request(), progress=steps.append, cancel=lambda: len(steps) >= after)
    assert len(steps) == after


def test_a_solve_that_does_not_converge_is_a_status(monkeypatch, solved):
    point = OperatingPoint(speed=100.0, load=500.0, temperature=313.15)
    alone = solve_screw(SCREW, OIL, point, settings=replace(ScrewSettings(), draw=None))
    stalled = replace(alone, converged=False, status='Stalled.')
    monkeypatch.setattr('surrogate.on_demand.solve.solve_screw', lambda *given, **how: stalled)
    found = solve_point(request(2))
    assert (found.converged, found.status, found.means) == (False, 'Stalled.', {})


def test_the_frame_is_strict_json(solved):
    found, _ = solved
    frame = json.loads(json.dumps(to_json(solved_frame(found)), allow_nan=False))
    assert frame['means']['rcs'] == found.means['rcs']
    assert set(frame['standard_errors']) == set(FIELDS)
