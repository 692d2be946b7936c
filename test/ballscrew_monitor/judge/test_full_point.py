# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A full solve held against a surface: who may correct whom, and when one is worth its time."""

import math
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge import full_point
from ballscrew_monitor.judge.full_point import Dwell, PAUSE, solved_at, stated_error, STAY
from ballscrew_monitor.judge.records import STANDSTILL
import pytest
from surrogate.surface import shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
START = 1000 * SECOND
CLOSED_FORM = Surface.load(shipped_surface(tier='closed_form'))


def answer(**changes):
    """Return what a surface or a solve says, its numbers exact in binary."""
    numbers = {
        'efficiency': 0.875,
        'rcs': 0.0,
        'efficiency_error': 2.0**-8,
        'rcs_error': 2.0**-9,
        'efficiency_stderr': math.nan,
        'rcs_stderr': math.nan,
        'validity': 1,
    }
    return types.SimpleNamespace(**(numbers | changes))


def full(**changes):
    return answer(**({'efficiency_stderr': 0.0, 'rcs_stderr': 0.0} | changes))


def test_a_point_lies_on_the_surface_by_its_amounts_and_a_request_holds_it(core):
    place = solved_at(core.point(speed=-10.0, axial_load=-500.0))
    assert (place.speed, place.opposing_load, place.temperature) == (10.0, -500.0, 313.15)
    assert solved_at(core.point(speed=10.0, axial_load=-500.0)).opposing_load == 500.0
    request = full_point.request_of(SURFACE, core.point(speed=-10.0, axial_load=500.0))
    assert request['header']['inputs'] == SURFACE.header['inputs']
    assert request['header']['tier'] == 'full'
    assert request['point'] == {'speed': 10.0, 'opposing_load': 500.0, 'temperature': 313.15}
    assert set(request['header']) == {'tier', 'inputs'}


@pytest.mark.parametrize(
    ('changes', 'within'),
    [
        ({}, True),
        ({'efficiency': 0.875 + 2.0**-8}, True),
        ({'efficiency': 0.875 + 2.0**-7}, False),
        ({'efficiency': 0.875 + 2.0**-7, 'efficiency_stderr': 2.0**-8}, True),
        ({'rcs': 2.0**-9}, True),
        ({'rcs': 2.0**-8}, False),
    ],
)
def test_a_difference_is_held_against_the_errors_of_both(changes, within):
    differences, is_within = full_point.compare(full(**changes), answer())
    assert differences['efficiency'] == changes.get('efficiency', 0.875) - 0.875
    assert differences['rcs'] == changes.get('rcs', 0.0)
    assert is_within is within


def test_the_stated_error_is_that_of_interpolation_and_law_or_not_known():
    differences, is_within = full_point.compare(full(), answer(validity=0))
    assert math.isnan(differences['efficiency'])
    assert math.isnan(differences['rcs'])
    assert not is_within
    assert stated_error(answer(), 'rcs') == 2.0**-9
    assert stated_error(answer(rcs_stderr=2.0**-9), 'rcs') == 2.0**-8


@pytest.mark.parametrize(
    ('own', 'theirs', 'surface', 'words'),
    [
        (full(), answer(), SURFACE, ''),
        (full(rcs_stderr=2.0**-9), answer(), SURFACE, ''),
        (full(rcs_stderr=2.0**-8), answer(), SURFACE, 'rcs 0.0039) is above'),
        (full(rcs_stderr=math.nan), answer(), SURFACE, 'result (rcs) is not known'),
        (full(efficiency_stderr=math.nan), answer(), SURFACE, ''),
        (full(), answer(validity=0), SURFACE, 'no answer'),
        (full(), answer(), CLOSED_FORM, 'closed-form tier is not corrected'),
        (full(), answer(rcs_error=math.nan), SURFACE, ''),
    ],
)
def test_only_what_is_known_better_corrects(own, theirs, surface, words):
    said = full_point.objection(own, theirs, surface)
    assert words in said
    assert bool(words) is bool(said)


def test_corrections_are_made_again_on_a_surface_of_the_same_content(core):
    place = solved_at(core.point(speed=63.0, axial_load=-1234.0))
    there = SURFACE.lookup(63.0, 1234.0, 313.15)
    values = {'rcs': there.rcs, 'friction_torque': 1.01 * there.friction_torque}
    once = SURFACE.with_correction(place, types.SimpleNamespace(**values))
    again = full_point.corrected(SURFACE, once.corrections)
    assert again.sha256 == once.sha256 != SURFACE.sha256
    assert again.base_sha256 == SURFACE.sha256
    here = (63.0, 1234.0, 313.15)
    assert str(again.lookup(*here)) == str(once.lookup(*here))


def test_a_request_holds_the_inputs_of_the_surface_and_no_names_to_look_up(core):
    request = full_point.request_of(SURFACE, core.point(speed=-10.0, axial_load=500.0))
    assert request['header']['inputs'] == SURFACE.header['inputs']
    assert request['header']['tier'] == 'full'
    assert request['point'] == {'speed': 10.0, 'opposing_load': 500.0, 'temperature': 313.15}
    assert set(request['header']) == {'tier', 'inputs'}


def row_at(core, stamp, point, surface):
    """Return a row of a stamp, with the gate that is shut at standstill."""
    row = full_point.answer(point, surface, rcs_limit=core.limits().rcs)
    row.stamp, row.gates = stamp, STANDSTILL if abs(point.speed) < 0.5 else 0
    return row


def asked(core, stamps, numbers=None, dwell=None, **point):
    """Return the stamps at which a solve is asked for while a point stays as it is."""
    dwell = dwell or Dwell()
    surface = core.surface(**({'rcs': 0.25, 'rcs_error': 0.0625} if numbers is None else numbers))
    here = core.point(**point)
    return [one for one in stamps if dwell.update(row_at(core, one, here, surface), core.limits())]


def test_a_solve_is_asked_for_after_a_stay_and_not_again_for_a_while(core):
    stamps = range(START, START + STAY + PAUSE + SECOND, SECOND)
    assert asked(core, stamps) == [START + STAY, START + STAY + PAUSE]
    stamps = [START, START + STAY]
    assert asked(core, stamps, speed=0.2) == []
    assert asked(core, stamps, speed=500.0) == []
    dwell, stamps = Dwell(), range(START, START + 2 * STAY, SECOND)
    for stamp in stamps:
        speed = 10.0 * (1.0 + 0.01 * ((stamp - START) // SECOND))
        assert asked(core, [stamp], dwell=dwell, speed=speed) == []
    dwell = Dwell()
    assert asked(core, [START], dwell=dwell) == []
    assert asked(core, [START - STAY, START - 1], dwell=dwell) == []
    assert asked(core, [START], dwell=dwell) == [START]


@pytest.mark.parametrize(
    ('numbers', 'uncertain'),
    [
        ({'rcs': 0.3125, 'rcs_error': 0.0625}, True),
        ({'rcs': 0.34375, 'rcs_error': 0.0625}, False),
        ({'rcs': 0.34375, 'rcs_error': 0.0625, 'rcs_std': 0.125}, True),
        ({'efficiency': 0.78125, 'efficiency_error': 0.03125}, True),
        ({'efficiency': 0.8125, 'efficiency_error': 0.03125}, False),
        ({'rcs': 0.25, 'rcs_error': math.nan}, False),
        ({'rcs': 0.25, 'corrected': True}, False),
    ],
)
def test_only_a_limit_within_reach_of_the_error_is_uncertain(core, numbers, uncertain):
    row = row_at(core, START, core.point(), core.surface(**numbers))
    assert full_point.is_uncertain(row, core.limits()) is uncertain


def test_at_standstill_and_outside_the_surface_there_is_nothing_to_solve(core):
    stamps = [START, START + STAY]
    assert asked(core, stamps, speed=0.2) == []
    assert asked(core, stamps, speed=500.0) == []
