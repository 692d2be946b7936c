# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""When a full solve is worth its time."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.dwell import Dwell, is_uncertain, LEAST, PAUSE
from ballscrew_monitor.core.estimate import estimate
from ballscrew_monitor.core.judgement import Gate, Verdict, Zone
import pytest

START = 1000 * SECOND


def judged(point):
    """Return a verdict with the gate that is shut at standstill."""
    still = abs(point.speed) < 0.5
    return Verdict(zone=Zone.UNKNOWN, gates=(Gate.STANDSTILL,) if still else ())


def asked(core, stamps, numbers=None, dwell=None, **point):
    """Return the stamps at which a solve is asked for while a point stays as it is."""
    dwell, limits = dwell or Dwell(), core.limits()
    surface = core.surface(**({'rcs': 0.25, 'rcs_error': 0.0625} if numbers is None else numbers))
    here = core.point(**point)
    result = estimate(here, surface, rcs_limit=limits.rcs)
    verdict = judged(here)
    return [one for one in stamps if dwell.update(one, here, result, verdict, limits)]


def test_a_solve_is_asked_for_after_a_stay_and_not_again_for_a_while(core):
    stamps = range(START, START + LEAST + PAUSE + SECOND, SECOND)
    assert asked(core, stamps) == [START + LEAST, START + LEAST + PAUSE]


def test_whoever_moves_on_does_not_dwell(core):
    dwell, stamps = Dwell(), range(START, START + 2 * LEAST, SECOND)
    for stamp in stamps:
        speed = 10.0 * (1.0 + 0.01 * ((stamp - START) // SECOND))
        assert asked(core, [stamp], dwell=dwell, speed=speed) == []


def test_a_clock_that_is_set_back_begins_the_stay_anew(core):
    dwell = Dwell()
    assert asked(core, [START], dwell=dwell) == []
    assert asked(core, [START - LEAST, START - 1], dwell=dwell) == []
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
    limits, here = core.limits(), core.point()
    result = estimate(here, core.surface(**numbers), rcs_limit=limits.rcs)
    assert is_uncertain(result, judged(here), limits) is uncertain


def test_at_standstill_and_outside_the_surface_there_is_nothing_to_solve(core):
    stamps = [START, START + LEAST]
    assert asked(core, stamps, speed=0.2) == []
    assert asked(core, stamps, speed=500.0) == []
