# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Limits on the limit, gates, and the level held over time."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.estimate import estimate, PointSource
from ballscrew_monitor.core.judgement import (
    Code,
    Gate,
    gates_of,
    Hold,
    hold,
    judge,
    Level,
    Severity,
    Verdict,
    Zone,
)
from ballscrew_msgs.msg import BallScrewState, Finding
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import InputError

GAP = SECOND // 2
STEP = SECOND // 100
OUTSIDE = Verdict(zone=Zone.OUTSIDE)
INSIDE = Verdict(zone=Zone.OPTIMAL, clear=True)
BAND = Verdict(zone=Zone.OPTIMAL, clear=False)
UNKNOWN = Verdict(zone=Zone.UNKNOWN)
below = lambda value: math.nextafter(value, -math.inf)  # noqa: E731


def judged(core, *, limits=None, point=None, **numbers):
    limits, point = limits or core.limits(), point or core.point()
    return judge(point, estimate(point, core.surface(**numbers), rcs_limit=limits.rcs), limits)


def codes(verdict):
    return [finding.code for finding in verdict.findings]


@pytest.mark.parametrize(
    ('rcs', 'efficiency', 'expected'),
    [
        (0.25, 0.75, [Code.RCS_HIGH]),
        (below(0.25), 0.75, []),
        (below(0.25), below(0.75), [Code.EFFICIENCY_LOW]),
        (0.25, below(0.75), [Code.RCS_HIGH, Code.EFFICIENCY_LOW]),
        (0.0, 1.0, []),
        (1.0, 0.0, [Code.RCS_HIGH, Code.EFFICIENCY_LOW]),
    ],
)
def test_zone_on_its_limits(core, rcs, efficiency, expected):
    verdict = judged(core, rcs=rcs, efficiency=efficiency)
    assert codes(verdict) == expected
    assert verdict.zone is (Zone.OUTSIDE if expected else Zone.OPTIMAL)


@pytest.mark.parametrize(
    ('rcs', 'efficiency', 'clear'),
    [(0.125, 0.875, False), (below(0.125), 0.875, True), (below(0.125), below(0.875), False)],
)
def test_hysteresis_on_its_limits(core, rcs, efficiency, clear):
    verdict = judged(core, rcs=rcs, efficiency=efficiency)
    assert verdict.zone is Zone.OPTIMAL
    assert verdict.clear is clear


@pytest.mark.parametrize(
    ('force', 'light'),
    [(256.0, False), (-256.0, False), (below(256.0), True), (-below(256.0), True), (0.0, True)],
)
def test_light_load_on_its_limit(core, force, light):
    verdict = judged(core, point=core.point(axial_load=force), efficiency=0.0)
    assert (Gate.LIGHT_LOAD in verdict.gates) is light
    assert codes(verdict) == ([] if light else [Code.EFFICIENCY_LOW])


def test_a_light_load_does_not_excuse_rcs(core):
    assert codes(judged(core, point=core.point(axial_load=0.0), rcs=0.25)) == [Code.RCS_HIGH]


@pytest.mark.parametrize(
    ('speed', 'still'), [(0.5, False), (-0.5, False), (below(0.5), True), (-below(0.5), True)]
)
def test_standstill_on_its_limit(core, speed, still):
    verdict = judged(core, point=core.point(speed=speed), rcs=1.0)
    assert (Gate.STANDSTILL in verdict.gates) is still
    assert verdict.zone is (Zone.UNKNOWN if still else Zone.OUTSIDE)


def test_numbers_that_are_unknown_or_held_shut_no_gate(core):
    for point in (
        core.point(speed=math.nan, axial_load=math.nan),
        core.point(
            speed=0.0,
            axial_load=0.0,
            speed_source=PointSource.HELD,
            axial_load_source=PointSource.HELD,
        ),
    ):
        assert gates_of(point, core.limits()) == ()


def test_what_cannot_be_judged_is_unknown_and_says_why(core):
    lost = judged(core, point=core.point(axial_load=math.nan))
    assert (lost.zone, codes(lost)) == (Zone.UNKNOWN, [Code.INPUT_LOST])
    assert lost.findings[0].severity is Severity.ERROR
    fast = judged(core, point=core.point(speed=1e3))
    assert (fast.zone, codes(fast)) == (Zone.UNKNOWN, [Code.OUT_OF_RANGE])
    assert 'above the surface' in fast.findings[0].text


def test_a_lost_input_is_told_at_standstill_too(core):
    assert codes(judged(core, point=core.point(speed=0.0, axial_load=math.nan))) == [
        Code.INPUT_LOST
    ]


def test_a_creeping_screw_below_the_surface_is_no_finding(core):
    assert judged(core, point=core.point(speed=0.05)).findings == ()


@pytest.mark.parametrize('name', ['rcs', 'efficiency'])
def test_a_surface_that_answers_nan_is_not_judged(core, name):
    verdict = judged(core, **{name: math.nan})
    assert (verdict.zone, verdict.clear) == (Zone.UNKNOWN, False)


def test_findings_say_value_limit_and_sentence(core):
    rcs, efficiency = judged(core, rcs=0.5, efficiency=0.5).findings
    assert (rcs.value, rcs.limit, rcs.unit) == (0.5, 0.25, '-')
    assert rcs.text == 'asperities carry too much: RCS 0.5, limit 0.25'
    assert efficiency.text == 'too much power is lost: efficiency 0.5, limit 0.75'


@given(rcs=st.floats(0.0, 1.0), efficiency=st.floats(0.0, 1.0))
def test_bands_are_exhaustive(core, rcs, efficiency):
    verdict = judged(core, rcs=rcs, efficiency=efficiency)
    assert (verdict.zone is Zone.OUTSIDE) == (rcs >= 0.25 or efficiency < 0.75)
    assert (verdict.zone is Zone.OPTIMAL) == (rcs < 0.25 and efficiency >= 0.75)
    assert not verdict.clear or verdict.zone is Zone.OPTIMAL


@pytest.mark.parametrize(
    ('changes', 'match'),
    [
        ({'rcs': 0.0}, 'limit rcs is 0.0, it must be between 0 and 1'),
        ({'rcs': 1.0}, 'rcs'),
        ({'efficiency': math.nan}, 'efficiency is nan'),
        ({'light_load': -1.0}, 'light_load'),
        ({'standstill_speed': 0.0}, 'standstill_speed is 0.0, it must be above 0'),
        ({'raise_delay': -1}, 'raise_delay'),
        ({'hysteresis': 1.0}, 'from 0 to below 1'),
    ],
)
def test_limits_without_meaning_are_refused(core, changes, match):
    with pytest.raises(InputError, match=match):
        core.limits(**changes)


def follow(limits, verdicts, *, memory=None, step=STEP):
    """Hold the level over verdicts that are one step apart; return the memory after each."""
    memories = [memory or Hold()]
    for i, verdict in enumerate(verdicts):
        memories.append(hold(memories[-1], verdict, i * step, limits, max_gap=GAP))
    return memories[1:]


def levels(limits, verdicts, **changes):
    return [memory.level for memory in follow(limits, verdicts, **changes)]


WARNING = Hold(level=Level.WARN, since=-1)
FINE = Hold(level=Level.OK, since=-1)


def test_a_warning_is_raised_when_the_delay_is_exactly_over(core):
    assert levels(core.limits(), [OUTSIDE] * 51) == [Level.UNKNOWN] * 50 + [Level.WARN]
    last = follow(core.limits(), [OUTSIDE] * 60, memory=FINE)[-1]
    assert (last.level, last.since) == (Level.WARN, 50 * STEP)


def test_a_warning_is_cleared_when_the_delay_is_exactly_over(core):
    assert levels(core.limits(), [INSIDE] * 101, memory=WARNING) == (
        [Level.WARN] * 100 + [Level.OK]
    )


def test_without_delays_a_single_sample_decides(core):
    limits = core.limits(raise_delay=0, clear_delay=0)
    assert levels(limits, [OUTSIDE, INSIDE, OUTSIDE]) == [Level.WARN, Level.OK, Level.WARN]


def test_one_optimal_sample_starts_the_raising_anew(core):
    verdicts = [OUTSIDE] * 50 + [BAND] + [OUTSIDE] * 50
    assert set(levels(core.limits(), verdicts, memory=FINE)) == {Level.OK}


@pytest.mark.parametrize('spoiler', [OUTSIDE, BAND, UNKNOWN])
def test_anything_else_starts_the_clearing_anew(core, spoiler):
    verdicts = [INSIDE] * 100 + [spoiler] + [INSIDE] * 100
    assert set(levels(core.limits(), verdicts, memory=WARNING)) == {Level.WARN}


def test_the_hysteresis_band_keeps_a_warning_but_brings_the_first_ok(core):
    assert levels(core.limits(), [BAND] * 200, memory=WARNING)[-1] is Level.WARN
    assert levels(core.limits(), [BAND] * 200)[-1] is Level.OK


def test_what_cannot_be_judged_does_not_hide_a_warning(core):
    verdicts = [OUTSIDE, UNKNOWN] * 26
    assert levels(core.limits(), verdicts, memory=FINE)[-2:] == [Level.WARN, Level.WARN]


def test_a_hole_longer_than_the_gap_starts_the_raising_anew(core):
    limits = core.limits()
    near = [OUTSIDE] * 2
    assert levels(limits, near, memory=FINE, step=GAP)[-1] is Level.WARN
    assert levels(limits, near, memory=FINE, step=GAP + 1)[-1] is Level.OK


def test_a_hole_of_a_slow_input_does_not(core):
    limits, period = core.limits(), 3 * GAP
    run = hold(FINE, OUTSIDE, 0, limits, max_gap=GAP, period=period)
    assert hold(run, OUTSIDE, period, limits, max_gap=GAP, period=period).level is Level.WARN
    assert hold(run, OUTSIDE, period + 1, limits, max_gap=GAP, period=period).level is Level.OK
    run = hold(WARNING, INSIDE, 0, limits, max_gap=GAP, period=period)
    assert hold(run, INSIDE, period, limits, max_gap=GAP, period=period).level is Level.WARN


zones = st.lists(st.sampled_from([OUTSIDE, INSIDE, BAND, UNKNOWN]), max_size=300)


@given(verdicts=zones)
def test_unknown_neither_raises_nor_clears(core, verdicts):
    memories = [Hold(), *follow(core.limits(), verdicts)]
    for before, after, verdict in zip(memories, memories[1:], verdicts, strict=False):
        if verdict is UNKNOWN:
            assert after.level is before.level
            assert after.clearing is None
        if after.level is not before.level:
            assert after.level is (Level.WARN if verdict is OUTSIDE else Level.OK)


@given(
    verdicts=st.lists(st.sampled_from([INSIDE, INSIDE, INSIDE, BAND]), max_size=300),
    holes=st.sets(st.integers(0, 299), max_size=3),
)
def test_making_samples_unknown_never_clears_a_warning_sooner(core, verdicts, holes):
    spoiled = [UNKNOWN if i in holes else verdict for i, verdict in enumerate(verdicts)]
    whole = levels(core.limits(), verdicts, memory=WARNING)
    for good, bad in zip(whole, levels(core.limits(), spoiled, memory=WARNING), strict=True):
        assert not (bad is Level.OK and good is Level.WARN)


@given(verdicts=zones)
def test_unknown_is_never_reached_again(core, verdicts):
    seen = levels(core.limits(), verdicts)
    known = [level for level in seen if level is not Level.UNKNOWN]
    assert seen == [Level.UNKNOWN] * (len(seen) - len(known)) + known


@pytest.mark.parametrize(
    ('enumeration', 'message', 'prefix'),
    [
        (Level, BallScrewState, 'LEVEL_'),
        (Zone, BallScrewState, 'ZONE_'),
        (Gate, BallScrewState, 'GATE_'),
        (Code, Finding, 'CODE_'),
        (Severity, Finding, 'SEVERITY_'),
    ],
)
def test_enumerations_have_the_numbers_of_the_messages(enumeration, message, prefix):
    for member in enumeration:
        assert getattr(message, f'{prefix}{member.name}') == member
