# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A solve on demand: the model itself, told step by step, and taken back at any of them."""

from dataclasses import asdict, replace
import re

import pytest
from surrogate.builder.full.tier import solve_full
from surrogate.builder.on_demand import Cancelled, solve, solve_point
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import ScrewSettings, solve_screw
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import FIELDS
from surrogate.tasks.worker import cancelled, listener, plain_result, run_task

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
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
        assert getattr(found, name) == pytest.approx(getattr(whole, name), rel=1e-4)


def test_a_surface_of_formulas_is_solved_as_its_screw_is():
    found = solve_point(request(HEADER | {'tier': 'closed_form'}))
    point = OperatingPoint(speed=6.0, load=500.0, temperature=313.15)
    alone = solve_screw(OPENED, OIL, point)
    expected = {name: getattr(alone, name) for name in FIELDS}
    assert {name: getattr(found, name) for name in FIELDS} == expected
    assert found.worst_contact == alone.worst_contact
    assert found.status == alone.status
    run_in = HEADER['inputs'] | {'screw': asdict(with_raceway(SCREW, state='run_in'))}
    assert found.rcs > solve_point(request({'inputs': run_in})).rcs > 0


def test_what_is_uncertain_is_the_rcs_between_strips(solved):
    found, _ = solved
    assert 0.0 < found.rcs_deviation < found.rcs


def test_draws_are_ignored_and_steps_name_every_contact_from_begin_to_end(solved):
    found, _ = solved
    assert solve_point(request() | {'draws': 16}) == found
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
    alone = solve_screw(OPENED, OIL, point, settings=ScrewSettings(kinematics='smooth'))
    stalled = replace(alone, converged=False, status='Stalled.')
    monkeypatch.setattr('surrogate.builder.on_demand.solve_screw', lambda *given, **how: stalled)
    found = solve_point(request())
    assert (found.converged, found.status) == (False, 'Stalled.')


def test_a_worker_tells_its_steps_and_is_taken_back_in_the_middle(monkeypatch):
    """The result is what a surface reads, as plain JSON; a want of memory is a sentence."""
    told = []
    token = listener.set(told.append)
    try:
        result = solve(request())
    finally:
        listener.reset(token)
    assert result == plain_result(result)
    assert result == asdict(solve_point(request()))
    assert told[0]['fraction'] == 0.0
    monkeypatch.setattr(cancelled, 'is_set', lambda: True)
    answer = run_task('surrogate.builder.on_demand:solve', request())
    assert answer['sentence'].startswith('Cancelled')

    def starve(*given, **how):
        raise MemoryError

    monkeypatch.setattr('surrogate.builder.on_demand.solve_screw', starve)
    sentence = run_task('surrogate.builder.on_demand:solve', request())['sentence']
    assert re.fullmatch(r'the solve needs more than \S+ GiB of memory', sentence)


def test_a_worker_without_a_compiler_says_what_to_install(monkeypatch):
    def refuse():
        raise ModuleNotFoundError("No module named 'numba'", name='numba')

    monkeypatch.setattr('surrogate.builder.on_demand.check', refuse)
    sentence = run_task('surrogate.builder.on_demand:solve', request())['sentence']
    assert sentence == (
        "a full solve needs numba: No module named 'numba': pip install numba where the node runs"
    )
