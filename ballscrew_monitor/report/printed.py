# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Words of a terminal and JSON about a recording that was judged, beside its page."""

from collections.abc import Iterator, Mapping
import math
from typing import Any

from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.recordings.declared import plain
from ballscrew_monitor.recordings.words import number, shown_unit
from ballscrew_monitor.report.inputs_seen import inputs_seen, NAMES, Trouble
from ballscrew_monitor.report.judging import AxisCase, LogCase
from ballscrew_monitor.report.ledger import Ledger, speed_ledger
from ballscrew_monitor.report.survey import REST
from ballscrew_monitor.report.verdict import AxisVerdict, verdict_of, verdicts_of

PARTS = ('unread_parts',)
"""What is said of a recording with each of its axes, where there is any."""
HEAD = 12
"""Width of the column of heads, as that of `Summary.lines`."""
SAID = {
    Trouble.GAPS: 'gaps {}',
    Trouble.SLOW: 'too slow for its timeout',
    Trouble.LAG: 'stamps {} behind arrival',
    Trouble.LOST: 'lost on the way {}',
    Trouble.LEFT_OUT: '{}',
}


def log_lines(log: LogCase) -> Iterator[str]:
    """Yield the lines about all axes of a recording."""
    for case in log.axes:
        still = ', none of them in motion' if case.outcome.judged and case.is_silent else ''
        yield f'axis {case.axis}: {case.outcome.judged} speed samples judged{still}'
        yield from (f'  {line}' for line in axis_lines(case))
    yield from (f'axis {axis}: no usable sample' for axis in log.empty)


def axis_lines(case: AxisCase) -> Iterator[str]:
    """Yield the lines about an axis that has rows."""
    verdict, summary = verdict_of(case), case.outcome.summary()
    if verdict.normal:
        yield _line('normal', verdict.normal)
    yield _line('verdict', verdict.whole)
    if verdict.why:
        yield _line('why', verdict.why)
    if verdict.remedy:
        yield _line('what to do', verdict.remedy)
    yield _line('contact', verdict.contact)
    seen = inputs_seen(case)
    yield from (_line('check', hint) for input_seen in seen for hint in input_seen.hints)
    yield from [] if summary is None else map(case.in_its_unit, summary.lines())
    for input_seen in seen:
        parts, unit = [input_seen.origin], shown_unit(input_seen.unit)
        if math.isfinite(input_seen.low):
            parts.append(f'{number(input_seen.low, 4)} to {number(input_seen.high, 4)} {unit}')
        if math.isfinite(input_seen.rate):
            assumed = ' assumed' if input_seen.rate_assumed else ''
            parts.append(f'{number(input_seen.rate, 4)} Hz{assumed}')
        parts += [SAID[trouble].format(text) for trouble, text in input_seen.troubles.items()]
        parts += [f'refused {input_seen.refused}'] if input_seen.refused else []
        yield _line('input', f'{NAMES[input_seen.source].lower()}: {", ".join(parts)}')
    for input_seen in seen:
        if ledger := input_seen.ledger:
            promised = 'no number' if ledger.promised is None else str(ledger.promised)
            counts = f'{promised} promised, {ledger.present} present, {ledger.read} read'
            rest = f'; {ledger.words}' if ledger.losses or ledger.missed else ''
            name = NAMES[input_seen.source].lower()
            yield _line('ledger', f'{name}: {counts}, {ledger.judged} judged{rest}')
    yield from (
        _line('not judged', f'{number(time, 4)} s: {reason.text}')
        for reason, time in sorted(case.survey.reasons.items(), key=lambda item: -item[1])
        if reason is not Reason.JUDGED
    )
    if case.survey.rest:
        yield _line('not judged', f'{number(case.survey.rest, 4)} s: {REST}')


def _line(head: str, text: str) -> str:
    return f'{head:{HEAD}}{text}'


def printed_records(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return of the summary of a recording what is printed: its axes, with their totals first."""
    records = dict(summary['axes'])
    for axis, record in records.items():
        if isinstance(record, Mapping):
            rest = {key: value for key, value in record.items() if key != 'totals'}
            rest |= {key: part for key in PARTS if (part := summary.get(key))}
            records[axis] = {'axis': axis, **(record['totals'] or {}), **rest}
    return records


def summary_record(log: LogCase) -> dict[str, Any]:
    """Return what the report says as plain data; a number that is not known has a reason."""
    records: dict[str, Any] = {}
    cases = {case.axis: case for case in log.axes}
    for axis, verdict in zip([*cases, *log.empty], verdicts_of(log), strict=True):
        known = cases.get(axis)
        records |= (
            {axis: axis_record(known, verdict)} if known else without(axis, verdict.sentence)
        )
    return {
        'log': log.name,
        'parameters': log.parameters,
        'unjudged_axes': log.unjudged,
        'unread_topics': dict(log.unread),
        **({'unread_parts': dict(log.unread_parts)} if log.unread_parts else {}),
        'axes': records,
        'assumptions': {key: dict(assumption) for key, assumption in log.assumptions.items()},
        'notes': list(log.notes),
    }


def axis_record(case: AxisCase, verdict: AxisVerdict) -> dict[str, Any]:
    """Return what is known of an axis; `<name>_reason` says why a number is missing."""
    summary, survey, surface = case.outcome.summary(), case.survey, case.surface
    return {
        **({'normal': verdict.normal} if verdict.normal else {}),
        'verdict': verdict.whole,
        'standing': verdict.standing.value,
        'why': verdict.why,
        'what_to_do': verdict.remedy,
        'contact_onset': verdict.contact,
        'model': {'tier': surface.tier, 'screw': surface.screw_name, 'oil': surface.oil_name},
        'recorded_s': survey.span,
        **_share(speed_ledger(case)),
        **(
            without('totals', 'no state was reached')
            if summary is None
            # Without the axis, which is named around them.
            else {
                'totals': {key: total for key, total in summary.record().items() if key != 'axis'}
            }
        ),
        'energy_lost_by_zone_J': plain(survey.energy),
        'time_by_reason_s': plain(survey.reasons),
        'time_without_rows_s': survey.rest,
        'torque_residual': plain(survey.torque),
        'inputs': plain({each.source: each for each in inputs_seen(case)}),
    }


def _share(ledger: Ledger | None) -> dict[str, Any]:
    if ledger is None or math.isnan(ledger.unjudged_share):
        return without('unjudged_share', 'the recording holds no speed')
    return {'unjudged_share': ledger.unjudged_share}


def without(name: str, reason: str) -> dict[str, Any]:
    """Return nothing by a name, and the reason of that."""
    return {name: None, f'{name}_reason': reason}
