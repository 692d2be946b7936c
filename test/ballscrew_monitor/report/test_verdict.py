# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The sentence that comes first: what is said, and what is said to be unknown."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.recordings.columns import Reason
from ballscrew_monitor.report.verdict import REMEDIES, verdict_of, VerdictKind


def totals(running, optimal, outside=0.0):
    """Return totals of times in motion [s]; the rest could not be judged."""
    running, optimal, outside = (round(time * SECOND) for time in (running, optimal, outside))
    return Totals(
        running_time=running,
        optimal_time=optimal,
        outside_time=outside,
        unjudged_time=running - optimal - outside,
    )


def test_every_reason_has_a_remedy():
    assert set(REMEDIES) == set(Reason) - {Reason.JUDGED, Reason.STANDSTILL}


def test_good(judged):
    verdict = verdict_of(judged.case([judged.columns()], totals=totals(60.0, 60.0)))
    assert verdict.standing is VerdictKind.GOOD
    assert verdict.sentence == (
        'axis x stayed in its optimal zone for all 60 s of motion that could be judged.'
    )


def test_outside_says_how_long_why_and_what_to_do(judged):
    events = [
        judged.event(1, 0.1, 0.2, worst_value=0.42),
        judged.event(
            2,
            0.5,
            0.1,
            quantity='efficiency',
            relation='<',
            worst_value=0.6,
            limit=0.85,
            advice='at this speed load with -1500 N',
        ),
    ]
    verdict = verdict_of(judged.case([judged.columns()], events, totals=totals(60.0, 45.0, 15.0)))
    assert verdict.standing is VerdictKind.BAD
    assert verdict.sentence == (
        'axis x ran outside its optimal zone for 15 s (25 % of its motion), with 2 warnings.'
    )
    assert (
        'up to 42 % of the load was carried where metal pierces it, the limit is 1 %'
        in verdict.why
    )
    assert 'the efficiency fell to 60 %, the limit is 85 %' in verdict.why
    assert 'as in warning 1, at this load run at 60 rad/s (573 rev/min)' in verdict.remedy
    assert 'as in warning 2, at this speed load with -1500 N' in verdict.remedy


def test_without_advice_there_is_none(judged):
    case = judged.case([judged.columns()], [judged.event(1, 0.1, 0.2, advice='')])
    assert verdict_of(case).remedy.startswith('No speed or load within the surface would')


def test_short_excursions_are_no_warning(judged):
    verdict = verdict_of(judged.case([judged.columns()], totals=totals(60.0, 59.0, 1.0)))
    assert verdict.standing is VerdictKind.GOOD
    assert 'each time too briefly for a warning' in verdict.sentence


def test_a_part_that_could_not_be_judged_is_told(judged):
    block = judged.columns(
        reason=[Reason.NO_LOAD] * 20 + [Reason.JUDGED] * 80,
        zone=[Zone.UNKNOWN] * 20 + [Zone.OPTIMAL] * 80,
    )
    verdict = verdict_of(judged.case([block], totals=totals(60.0, 48.0)))
    assert '12 s (20 %) could not be judged, no valid sample of the load' in verdict.sentence


def test_mostly_unjudged_is_unknown(judged):
    block = judged.columns(reason=Reason.TEMPERATURE_OUT_OF_RANGE, zone=Zone.UNKNOWN)
    verdict = verdict_of(judged.case([block], totals=totals(60.0, 6.0)))
    assert verdict.standing is VerdictKind.UNKNOWN
    assert (
        'could not be judged for 54 s (90 %) of its motion: the oil temperature'
        in verdict.sentence
    )
    assert verdict.remedy.startswith('Build a surface for these oil temperatures')


def test_an_axis_that_never_moved(judged):
    block = judged.columns(speed=0.0, reason=Reason.STANDSTILL, zone=Zone.UNKNOWN)
    verdict = verdict_of(judged.case([block], totals=Totals()))
    assert verdict.standing is VerdictKind.UNKNOWN
    assert 'axis x never moved' in verdict.sentence
    assert 'Check the unit of the speed' in verdict.remedy


def test_a_gap_does_not_hide_that_an_axis_never_moved(judged):
    still = {'speed': 0.1, 'zone': Zone.UNKNOWN}
    gap = {'reason': Reason.NO_INPUTS, 'speed_source': PointSource.HELD, 'tick': True}
    blocks = [
        judged.columns(0, 90, reason=Reason.STANDSTILL, **still),
        judged.columns(90, 10, **still, **gap),
    ]
    verdict = verdict_of(judged.case(blocks, totals=Totals()))
    assert 'axis x never moved' in verdict.sentence
    blocks = [blocks[0], judged.columns(90, 200, **still, **gap)]
    verdict = verdict_of(judged.case(blocks, totals=Totals()))
    assert verdict.sentence.endswith('axis x: no valid sample of several inputs.')


def test_why_a_motion_was_not_judged_does_not_count_gaps(judged):
    gap = {'reason': Reason.NO_INPUTS, 'speed_source': PointSource.HELD, 'tick': True}
    blocks = [
        judged.columns(0, 10, reason=Reason.NO_LOAD, zone=Zone.UNKNOWN),
        judged.columns(10, 90, zone=Zone.UNKNOWN, **gap),
    ]
    verdict = verdict_of(judged.case(blocks, totals=totals(0.1, 0.0)))
    assert verdict.sentence.endswith('of its motion: no valid sample of the load.')


def test_a_speed_that_never_came(judged):
    block = judged.columns(
        speed=math.nan, speed_source=0, reason=Reason.NO_SPEED, zone=Zone.UNKNOWN, tick=True
    )
    verdict = verdict_of(judged.case([block], totals=Totals()))
    assert verdict.sentence == ('nothing could be judged on axis x: no valid sample of the speed.')
