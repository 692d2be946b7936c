# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The sentence that comes first: what is said, and what is said to be unknown."""

import dataclasses
import math

from ballscrew_monitor.core.judgement import PointSource, Reason, Zone
from ballscrew_monitor.health.records import Condition, Health, Quantity
from ballscrew_monitor.report.log_page import verdict_part
from ballscrew_monitor.report.printed import axis_lines, axis_record
from ballscrew_monitor.report.verdict import REMEDIES, verdict_of, VerdictKind
from ballscrew_msgs.msg import Totals
from hypothesis import given, settings
from hypothesis import strategies as st
import pytest
from surrogate.surface import onset_of_surface, ZoneLimits


def totals(running, optimal, outside=0.0):
    """Return totals of times in motion [s]; the rest could not be judged."""
    return Totals(
        running_time=running,
        optimal_time=optimal,
        outside_time=outside,
        unjudged_time=running - optimal - outside,
    )


def test_every_reason_has_a_remedy():
    assert set(REMEDIES) == set(Reason) - {Reason.JUDGED, Reason.STANDSTILL}


NO_LOAD_FIRST = {
    'reason': [Reason.NO_LOAD] * 20 + [Reason.JUDGED] * 80,
    'zone': [Zone.UNKNOWN] * 20 + [Zone.OPTIMAL] * 80,
}
NO_SPEED = {
    'speed': math.nan,
    'speed_source': 0,
    'reason': Reason.NO_SPEED,
    'zone': Zone.UNKNOWN,
    'tick': True,
}
SAID = (
    ({}, totals(60.0, 60.0), 'good_stayed_optimal'),
    ({}, totals(60.0, 59.0, 1.0), 'good_left_optimal'),
    (NO_LOAD_FIRST, totals(60.0, 48.0), 'good_stayed'),
    (
        {'reason': Reason.TEMPERATURE_OUT_OF_RANGE, 'zone': Zone.UNKNOWN},
        totals(60.0, 6.0),
        'known_could_judged',
    ),
    (
        {'speed': 0.0, 'reason': Reason.STANDSTILL, 'zone': Zone.UNKNOWN},
        Totals(),
        'known_never_moved',
    ),
    (NO_SPEED, Totals(), 'known_nothing_could'),
)


@pytest.mark.parametrize(('columns', 'total', 'said'), SAID)
def test_sentences_say_how_an_axis_did_and_what_to_do(judged, columns, total, said, says):
    verdict = verdict_of(judged.case([judged.rows(**columns)], totals=total))
    assert f'{verdict.whole} {verdict.remedy}' == says(said)


def rows(judged, *parts, still=0):
    """
    Return the verdict on rows at 100 Hz: counts in turn of rows that are judged and of rows gone.

    `still` rows at standstill follow.

    """
    blocks, begin = [], 0
    for number, count in enumerate(parts):
        blocks += [] if number % 2 else [judged.rows(begin, count)]
        begin += count
    if still:
        rest = {'speed': 0.0, 'reason': Reason.STANDSTILL, 'zone': Zone.UNKNOWN}
        blocks.append(judged.rows(begin, still, **rest))
    moved = sum(parts[::2]) / 100
    return verdict_of(judged.case(blocks, totals=totals(moved, moved)))


def test_below_half_of_what_may_be_motion_nothing_is_good_and_it_is_said_why(judged, says):
    verdict = rows(judged, 100, 400, 100)
    assert f'{verdict.whole} {verdict.remedy}' == says('gaps_in_speed')
    assert rows(judged, 100, 400, 400).standing is VerdictKind.GOOD
    lost = {'speed_source': PointSource.HELD, 'zone': Zone.UNKNOWN, 'tick': True}
    blocks = [judged.rows(0, 20), judged.rows(20, 60, reason=Reason.NO_INPUTS, **lost)]
    verdict = verdict_of(judged.case(blocks, totals=totals(0.2, 0.2)))
    assert f'{verdict.whole} {verdict.remedy}' == says('inputs_lost')
    assert rows(judged, 100, still=900).standing is VerdictKind.GOOD  # no motion to be judged


@given(*[st.integers(60, 400)] * 3, st.integers(0, 400))
@settings(max_examples=settings.default.max_examples // 3)
def test_good_needs_half_of_the_recording_but_for_standstill(judged, first, gap, last, still):
    verdict = rows(judged, first, gap, last, still=still)
    whole, known = first + gap + last, first + last
    if abs(known - whole / 2) > 2:  # the last row before a gap lasts into it
        assert (verdict.standing is VerdictKind.GOOD) == (known > whole / 2)
    assert verdict.standing not in (VerdictKind.BAD, VerdictKind.PERHAPS)


@pytest.mark.parametrize(
    ('outside', 'standing'), [(30.0, VerdictKind.GOOD), (30.1, VerdictKind.PERHAPS)]
)
def test_motion_that_was_mostly_outside_is_not_good_though_no_warning_lasted(
    judged, outside, standing, says
):
    case = judged.case([judged.rows()], totals=totals(70.0, 60.0 - outside, outside))
    verdict = verdict_of(case)
    assert verdict.standing is standing
    assert (verdict.whole == says('mostly_outside')) == (standing is VerdictKind.PERHAPS)
    record = axis_record(case, verdict)
    assert (record['standing'], record['verdict']) == (standing.value, verdict.whole)
    assert f'verdict     {verdict.whole}' in list(axis_lines(case))
    assert f'<strong>{standing.word}:</strong>' in verdict_part(verdict)


def test_outside_says_how_long_why_and_what_to_do(judged, says):
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
            advice='',
            target_speed=math.nan,
        ),
    ]
    verdict = verdict_of(judged.case([judged.rows()], events, totals=totals(60.0, 45.0, 15.0)))
    assert verdict.standing is VerdictKind.PERHAPS
    assert verdict.sentence == says('ran_outside_optimal')
    assert says('up_42_load') in verdict.why
    assert says('efficiency_fell_60') in verdict.why
    assert verdict.remedy == says('as_warning_1')


@pytest.mark.parametrize(
    ('sure', 'standing'),
    [
        (0.0, VerdictKind.PERHAPS),
        (0.14, VerdictKind.PERHAPS),
        (0.16, VerdictKind.BAD),
        (math.nan, VerdictKind.BAD),
    ],
)
def test_only_what_is_surely_outside_is_bad(judged, sure, standing):
    """More of the time outside than the rounding; a surface without bands does not tell."""
    case = judged.case(
        [judged.rows()], [judged.event(1, 0.1, 0.2)], totals=totals(60.0, 45.0, 15.0)
    )
    assert verdict_of(dataclasses.replace(case, surely_outside=sure)).standing is standing


def test_whether_it_is_normal_comes_first_and_the_workshop_before_the_process(judged):
    drag = Quantity(name='drag change', reason='not known yet: 1 of 5 logs')
    health = Health(
        axis='x',
        stamp=0,
        condition=Condition.UNKNOWN,
        verdict='',
        advice='take ISO VG 220',
        quantities=[drag],
    )
    case = judged.case(
        [judged.rows()], [judged.event(1, 0.1, 0.2)], totals=totals(60.0, 45.0, 15.0)
    )
    alone, verdict = verdict_of(case), verdict_of(dataclasses.replace(case, health=health))
    assert alone.normal == ''
    assert verdict.normal == 'not known yet: 1 of 5 logs'
    assert verdict.remedy == f'Take ISO VG 220; or {alone.remedy}'
    part = verdict_part(verdict)
    places = [part.index(text) for text in ('Normal? not', verdict.sentence, 'What to do')]
    assert places == sorted(places)
    assert next(iter(axis_lines(dataclasses.replace(case, health=health)))).startswith('normal ')
    stayed = judged.case([judged.rows()], totals=totals(60.0, 60.0))
    assert verdict_of(dataclasses.replace(stayed, health=health)).remedy == ''


def remedy(judged, *events):
    return verdict_of(judged.case([judged.rows()], events)).remedy


def advised(judged, number, speed, target, **changes):
    """Return an event whose worst value is at a speed [rad/s], with another one as advice."""
    advice = f'run at {target:g} rad/s'
    return judged.event(
        number, 0.1 * number, 0.05, speed=speed, target_speed=target, advice=advice, **changes
    )


def test_the_strictest_advice_stands_for_all_of_its_direction(judged, says):
    mild = advised(judged, 1, 10.0, 44.0, worst_value=0.98)
    strict = advised(judged, 2, -47.0, -98.0, axial_load=1600.0)
    assert remedy(judged, mild, strict) == says('as_warning_2')
    events = [
        advised(judged, number, speed, target, quantity='efficiency', worst_value=0.005)
        for number, speed, target in ((1, 90.0, 70.0), (2, 100.0, 50.0), (3, 10.0, 20.0))
    ]
    faster, slower = remedy(judged, *events).split('; and ')
    assert faster.endswith('run at 20 rad/s')
    assert 'in warning 2, the strictest of 2' in slower
    assert slower.endswith('run at 50 rad/s.')


def test_without_advice_nothing_is_advised(judged):
    helpless = {'advice': '', 'target_speed': math.nan}
    assert remedy(judged, judged.event(1, 0.1, 0.2, **helpless)) == ''
    assert remedy(judged, judged.event(1, 0.1, 0.2, speed=math.nan, **helpless)) == ''


def test_gaps_hide_neither_that_an_axis_never_moved_nor_why_it_was_not_judged(judged):
    still = {'speed': 0.1, 'zone': Zone.UNKNOWN}
    gap = {'reason': Reason.NO_INPUTS, 'speed_source': PointSource.HELD, 'tick': True}
    blocks = [
        judged.rows(0, 90, reason=Reason.STANDSTILL, **still),
        judged.rows(90, 10, **still, **gap),
    ]
    verdict = verdict_of(judged.case(blocks, totals=Totals()))
    assert 'axis x never moved' in verdict.sentence
    blocks = [blocks[0], judged.rows(90, 200, **still, **gap)]
    verdict = verdict_of(judged.case(blocks, totals=Totals()))
    assert verdict.sentence.endswith('axis x: no valid sample of several inputs.')
    blocks = [
        judged.rows(0, 10, reason=Reason.NO_LOAD, zone=Zone.UNKNOWN),
        judged.rows(10, 90, zone=Zone.UNKNOWN, **gap),
    ]
    verdict = verdict_of(judged.case(blocks, totals=totals(0.1, 0.0)))
    assert verdict.sentence.endswith('of its motion: no valid sample of the load.')


FEED = {'x.speed.unit': 'mm/min'}


def test_contact_is_that_of_the_surface_with_the_oil_as_warm_as_in_motion(judged):
    """With the limits of the axis; the sentence has the degrees of the page."""
    case = judged.case([judged.rows(temperature=308.15)])
    limits = case.settings.limits
    bounds = {name: getattr(limits, name) for name in ('rcs', 'efficiency', 'light_load')}
    found = onset_of_surface(case.surface, case.survey.oil.mean, ZoneLimits(**bounds))
    assert case.onset == found
    assert verdict_of(case).contact == f'{found.sentence()}.'.replace(' degC', ' °C')
    unknown = judged.case([judged.rows(temperature=math.nan)])
    assert unknown.onset == onset_of_surface(case.surface, None, ZoneLimits(**bounds))


def test_where_a_log_gives_a_feed_the_verdict_does_too(judged, says):
    """Where its contact begins, and what to do: in m/min first."""
    events = [judged.event(1, 0.1, 0.2)]
    case = judged.case([judged.rows()], events, values=judged.values(**FEED))
    verdict = verdict_of(case)
    assert verdict.remedy == says('feed')
    assert f'{case.onset.sentence(as_feed=True)}.'.replace(' degC', ' °C') == verdict.contact


@pytest.mark.parametrize(
    ('unit', 'motion_unit', 'feed'),
    [
        ('rad/s', '', False),
        ('m/s', '', True),
        ('mm', '', True),
        ('rev', '', False),
        ('rad/s', 'mm/min', True),
        ('rad/s', 'mm', True),
        ('mm/s', 'rev/min', False),
    ],
)
def test_a_log_speaks_the_unit_of_its_column_else_that_of_its_topic(
    judged, unit, motion_unit, feed
):
    values = judged.values(**{'x.speed.unit': unit})
    case = judged.case([judged.rows()], values=values, known={'motion_unit': motion_unit})
    assert case.speaks_feed is feed
    assert ('m/min' in case.contact) is feed
