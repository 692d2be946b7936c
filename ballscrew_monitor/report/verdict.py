# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The verdict on an axis: whether it is normal, how long outside the zone, and what to do."""

from collections.abc import Mapping
import dataclasses
import enum
import math

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.health.words import normal_answer
from ballscrew_monitor.recordings.summary import EventRecord, Summary
from ballscrew_monitor.recordings.words import counted, duration, list_of, percent, share
from ballscrew_monitor.report.judging import AxisCase, LogCase, RCS
from ballscrew_monitor.report.ledger import speed_ledger
from ballscrew_monitor.report.survey import REST

UNKNOWN_PART = 0.5  # of the motion that is not judged, from which on there is no verdict
OUTSIDE_PART = 0.5  # of the judged motion that is outside, from which on nothing is good
TOLD_PART = 0.01  # of the motion that is not judged, from which on the verdict says so
BEYOND = (
    Reason.SPEED_BELOW_RANGE,
    Reason.SPEED_ABOVE_RANGE,
    Reason.LOAD_OUT_OF_RANGE,
    Reason.TEMPERATURE_OUT_OF_RANGE,
)
"""Reasons outside of the surface."""
ROUNDING = 0.01  # of the time outside, less of which is no part of it
REMEDIES = {
    Reason.NO_DIRECTION: 'record a motion of the axis',
    Reason.SPEED_BELOW_RANGE: 'build a surface that begins at a slower speed, '
    'or check the unit of the speed',
    Reason.SPEED_ABOVE_RANGE: 'build a surface for higher speeds, or check the unit of the speed',
    Reason.LOAD_OUT_OF_RANGE: 'build a surface for higher loads, or check the unit of the load',
    Reason.TEMPERATURE_OUT_OF_RANGE: 'build a surface for these oil temperatures, '
    'or check their unit',
    Reason.MASKED: 'build the surface again, its model did not converge there',
    Reason.NO_NUMBER: 'build the surface again, it holds no number there',
    Reason.NO_SPEED: 'record the speed without interruption',
    Reason.NO_LOAD: 'record the axial load, or a torque that it can be worked out from',
    Reason.NO_TEMPERATURE: 'record the oil temperature, or state a default one',
    Reason.NO_INPUTS: 'record speed, load and oil temperature without interruption',
    Reason.NO_TORQUE: 'record the motor torque without interruption',
    Reason.NO_DERIVED_LOAD: 'record the axial load, or check unit and uncertainty of the motor '
    'torque',
}


class VerdictKind(enum.Enum):
    """What a verdict comes to."""

    GOOD = 'good'
    BAD = 'bad'
    PERHAPS = 'perhaps'
    UNKNOWN = 'unknown'

    @property
    def word(self) -> str:
        """Return how a verdict begins."""
        return {
            'good': 'Good',
            'bad': 'Outside',
            'perhaps': 'Perhaps outside',
            'unknown': 'Not known',
        }[self.value]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisVerdict:
    """
    The standing, in the rest of a sentence; why, what to do, and where contact begins.

    `normal` says whether the axis is as usual, empty where its health was not asked for.

    """

    standing: VerdictKind = VerdictKind.UNKNOWN
    sentence: str
    why: str = ''
    remedy: str = ''
    contact: str = ''
    normal: str = ''

    @property
    def whole(self) -> str:
        """Return the sentence with the word that it begins with."""
        return f'{self.standing.word}: {self.sentence}'


def verdicts_of(log: LogCase) -> list[AxisVerdict]:
    """Return the verdicts on all axes, also on those without rows."""
    return [verdict_of(case) for case in log.axes] + [_no_rows(axis) for axis in log.empty]


def _no_rows(axis: str) -> AxisVerdict:
    return AxisVerdict(
        sentence=f'the recording holds no usable sample of axis {axis}.',
        remedy='Check topics, fields and joints in the parameters.',
    )


def verdict_of(case: AxisCase) -> AxisVerdict:
    """Return the verdict on an axis that has rows, in the unit in which its log speaks."""
    verdict = _verdict(case)
    remedy = case.in_its_unit(verdict.remedy)
    normal = ''
    if case.health is not None:
        normal = normal_answer(case.health)
        if verdict.standing in (VerdictKind.BAD, VerdictKind.PERHAPS):
            # What the workshop can change by itself stands before what the process would.
            advice = case.health.advice
            workshop = f'{advice[:1].upper()}{advice[1:]}' if advice else ''
            remedy = f'{workshop}; or {remedy}' if workshop and remedy else remedy
            remedy = remedy or (f'{workshop}.' if workshop else '')
    return dataclasses.replace(verdict, remedy=remedy, contact=case.contact, normal=normal)


def _verdict(case: AxisCase) -> AxisVerdict:
    summary = case.outcome.summary()
    if summary is None or not summary.running_time:
        return _unmoved(case)
    unjudged = summary.unjudged_time / summary.running_time
    if unjudged > UNKNOWN_PART and not summary.events:
        return _unjudged(case, summary, unjudged)
    judged = summary.optimal_time + summary.outside_time
    whole = max(summary.running_time, case.survey.possible_motion)
    if whole - judged > UNKNOWN_PART * whole and not summary.events:
        return _hardly_judged(case, judged, whole)
    if not summary.events and (ledger := speed_ledger(case)):
        if ledger.unjudged_share > UNKNOWN_PART:
            part = percent(ledger.judged / ledger.expected)
            reasons = {key: time for key, time in case.survey.reasons.items() if time}
            return AxisVerdict(
                sentence=f'of {ledger.expected} samples of the speed of axis {case.axis} '
                f'{ledger.judged} ({part}) were judged: {ledger.words}.',
                remedy=_remedy(_longest(reasons))
                or 'Record it again, or find the files that are missing.',
            )
        beyond = math.fsum(case.survey.moving.get(reason, 0.0) for reason in BEYOND)
        away = summary.outside_time + beyond > OUTSIDE_PART * summary.running_time
        if beyond and away and not _mostly_outside(summary):
            part = share(summary.optimal_time, summary.running_time)
            more = _unjudged_part(case, summary)
            return AxisVerdict(
                sentence=f'axis {case.axis} was in its optimal zone for {part} of its motion: it '
                f'was outside for {duration(summary.outside_time)}{more}.',
                remedy=_remedy(_longest(case.survey.moving)),
            )
    more = _unjudged_part(case, summary) if unjudged > TOLD_PART else ''
    if not summary.outside_time:
        return AxisVerdict(
            standing=VerdictKind.GOOD,
            sentence=f'axis {case.axis} stayed in its optimal zone for all '
            f'{duration(summary.running_time - summary.unjudged_time)} of motion '
            f'that could be judged{more}.',
        )
    return _outside(case, summary, more)


def _unmoved(case: AxisCase) -> AxisVerdict:
    reason = _longest(case.survey.reasons)
    if never_moved(case):
        limit = case.settings.limits.standstill_speed
        return AxisVerdict(
            sentence=f'axis {case.axis} never moved: its speed stayed below {limit:g} rad/s, '
            'and at standstill nothing is judged.',
            remedy='Check the unit of the speed if the machine did move.',
        )
    why = reason.text if reason else 'no motion was recorded'
    return AxisVerdict(
        sentence=f'nothing could be judged on axis {case.axis}: {why}.', remedy=_remedy(reason)
    )


def never_moved(case: AxisCase) -> bool:
    """Return True if the speed is known for most of the time and the screw always stood still."""
    summary = case.outcome.summary()
    if summary is not None and summary.running_time:
        return False
    speed, limit = case.survey.inputs[Source.SPEED], case.settings.limits.standstill_speed
    still = -limit < speed.low <= speed.high < limit  # NaN where it is not known
    return still and _longest(case.survey.reasons) in (None, Reason.STANDSTILL)


def _unjudged(case: AxisCase, summary: Summary, part: float) -> AxisVerdict:
    reason = _longest(case.survey.moving)
    why = reason.text if reason else 'the reason is not known'
    return AxisVerdict(
        sentence=f'axis {case.axis} could not be judged for {duration(summary.unjudged_time)} '
        f'({percent(part)}) of its motion: {why}.',
        remedy=_remedy(reason),
    )


def _hardly_judged(case: AxisCase, judged: float, whole: float) -> AxisVerdict:
    """Return how much [s] was judged of the possible motion, and why no more."""
    reasons = case.survey.reasons
    reason = _longest({key: reasons[key] for key in reasons if key is not Reason.STANDSTILL})
    why = reason.text if reason else 'the reason is not known'
    rest = case.survey.rest
    if rest > (reasons[reason] if reason else 0.0):
        reason, why = Reason.NO_SPEED, f'{REST} for {duration(rest)}'
    return AxisVerdict(
        sentence=f'axis {case.axis} was judged for {duration(judged)} ({percent(judged / whole)}) '
        f'of the {duration(whole)} in which it moved or may have moved: {why}.',
        remedy=_remedy(reason),
    )


def _mostly_outside(summary: Summary) -> bool:
    judged = summary.optimal_time + summary.outside_time
    return summary.outside_time > OUTSIDE_PART * judged


def _outside(case: AxisCase, summary: Summary, more: str) -> AxisVerdict:
    running = summary.running_time
    time = ' and '.join(
        f'{word} for {duration(time)} ({share(time, running)} of its motion)'.lstrip()
        for word, time in parts_outside(case, summary).items()
    )
    sure = not case.surely_outside <= ROUNDING * summary.outside_time
    standing = VerdictKind.BAD if sure else VerdictKind.PERHAPS
    if not summary.events and _mostly_outside(summary):
        return AxisVerdict(
            standing=standing,
            sentence=f'axis {case.axis} was outside its optimal zone {time}, each time too '
            f'briefly for a warning{more}.',
        )
    if not summary.events:
        return AxisVerdict(
            standing=VerdictKind.GOOD,
            sentence=f'axis {case.axis} left its optimal zone {time}, each time too briefly '
            f'for a warning{more}.',
        )
    return AxisVerdict(
        standing=standing,
        sentence=f'axis {case.axis} ran outside its optimal zone {time}, '
        f'with {counted(len(summary.events), "warning")}{more}.',
        why=_why(summary.events),
        remedy=_advice(case),
    )


def parts_outside(case: AxisCase, summary: Summary) -> dict[str, float]:
    """
    Return the time outside [s], *surely* and *perhaps*, by the bands of the limit.

    It has no word where nothing tells how surely, and where there is none.

    """
    outside = summary.outside_time
    sure = min(case.surely_outside, outside)
    if math.isnan(sure) or not outside:
        return {'': outside}
    # A row lasts a little longer or shorter than the judgement has it: less than that is nothing.
    times = {'surely': sure, 'perhaps': outside - sure}
    return {word: time for word, time in times.items() if time > ROUNDING * outside}


def _why(events: tuple[EventRecord, ...]) -> str:
    metal = [event for event in events if event.quantity == RCS]
    loss = [event for event in events if event.quantity == 'efficiency']
    parts = []
    if metal:
        worst = max(event.worst_value for event in metal)
        parts.append(
            f'the oil film was too thin: up to {percent(worst)} of the load was carried where '
            f'metal pierces it, the limit is {percent(metal[0].limit)} '
            f'({counted(len(metal), "warning")})'
        )
    if loss:
        worst = min(event.worst_value for event in loss)
        parts.append(
            f'friction took too much: the efficiency fell to {loss[0].shown(worst)}, '
            f'the limit is {loss[0].shown(loss[0].limit)} ({counted(len(loss), "warning")})'
        )
    return f'{list_of(parts).capitalize()}.' if parts else ''


def _advice(case: AxisCase) -> str:
    """Return for each cause the strictest advice to run faster and to run slower, if any."""
    events = [event for event in case.worst_first if event.advice]
    parts = []
    for quantity in dict.fromkeys(event.quantity for event in events):
        advised = [event for event in events if event.quantity == quantity]
        slowest_first = sorted(advised, key=lambda event: abs(event.target_speed))
        fastest_first = sorted(advised, key=lambda event: -abs(event.target_speed))
        slower = [event for event in slowest_first if abs(event.target_speed) < abs(event.speed)]
        faster = [event for event in fastest_first if event not in slower]
        for first, *rest in filter(None, (faster, slower)):
            others = f', the strictest of {len(rest) + 1}' if rest else ''
            place = f' (at {first.place})' if first.place else ''
            parts.append(f'as in warning {first.event_id}{others}{place}, {first.advice}')
    return f'{list_of(parts)}.' if parts else ''


def _unjudged_part(case: AxisCase, summary: Summary) -> str:
    reason = _longest(case.survey.moving)
    why = f', {reason.text}' if reason else ''
    part = share(summary.unjudged_time, summary.running_time)
    return f'; {duration(summary.unjudged_time)} ({part}) could not be judged{why}'


def _longest(reasons: Mapping[Reason, float]) -> Reason | None:
    """Return for what most time [s] could not be judged."""
    chosen = {reason: time for reason, time in reasons.items() if reason is not Reason.JUDGED}
    return max(chosen, key=lambda reason: chosen[reason]) if chosen else None


def _remedy(reason: Reason | None) -> str:
    remedy = REMEDIES.get(reason) if reason else None
    return f'{remedy[0].upper()}{remedy[1:]}.' if remedy else ''
