# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a report on one axis, from the verdict to the assumptions."""

from collections.abc import Iterable, Sequence
import math
from typing import Any

from ballscrew_monitor.core.conversions import celsius
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.columns import Reason
from ballscrew_monitor.recordings.summary import EventRecord, Summary
from ballscrew_monitor.report.case import AxisCase, badness, RCS
from ballscrew_monitor.report.inputs_seen import inputs_seen, InputSeen, NAMES
from ballscrew_monitor.report.markup import (
    Cell,
    element,
    joined,
    Markup,
    Row,
    share_bar,
    swatch,
    table,
)
from ballscrew_monitor.report.verdict import AxisVerdict
from ballscrew_monitor.report.words import duration, number, percent, share

KEYS = {
    'screw': 'the screw',
    'oil': 'the oil',
    'lead_mm': 'its lead',
    'efficiency': 'efficiency used for the load',
    'torque_constant_Nm_per_A': 'torque constant of the motor',
    'time.rate_Hz': 'rate of the samples',
    'time.epoch': 'date',
}
"""Words for what a log may leave to be assumed."""
SIGNS = {'>=': '≥'}
MOST_ROWS = 1000
"""Rows of a table of which there may be any number; the worst are shown."""
TIERS = {
    'full': 'full model (solved contacts, roughness that rolls)',
    'closed_form': 'closed-form model (published formulas): an estimate, whose contact begins '
    'within a factor of two in speed',
}


def verdict_part(verdict: AxisVerdict) -> Markup:
    """Return the verdict as a box."""
    lines = [line for line in (verdict.why, verdict.remedy) if line]
    if verdict.remedy:
        lines[-1] = f'What to do: {verdict.remedy[0].lower()}{verdict.remedy[1:]}'
    return element(
        'div',
        element(
            'p', element('strong', f'{verdict.word}:'), f' {verdict.sentence}', class_='sentence'
        ),
        *(element('p', line) for line in lines),
        class_=f'verdict {verdict.standing.value}',
    )


def tiles(case: AxisCase, summary: Summary) -> Markup:
    """Return the numbers that a reader asks for first."""
    running = summary.running_time
    facts = (
        (duration(case.survey.span), 'recorded'),
        (duration(running), f'in motion ({share(running, case.survey.span)})'),
        (share(summary.outside_time, running), 'of the motion outside the optimal zone'),
        (str(len(summary.events)), 'warning' if len(summary.events) == 1 else 'warnings'),
        (f'{number(summary.energy_lost)} J', 'lost to friction in the screw'),
        (number(summary.revolutions, 4), 'revolutions'),
    )
    made = (
        element('div', element('b', value), element('span', text), class_='tile')
        for value, text in facts
    )
    return element('div', *made, class_='tiles')


def shares(case: AxisCase, summary: Summary) -> Markup:
    """Return time in zone and regime, and the energy lost in each zone, as bars."""
    running = summary.running_time
    zone = [
        (summary.optimal_time, 'optimal', 'optimal'),
        (summary.outside_time, 'outside', 'outside the optimal zone'),
        (summary.unjudged_time, 'unjudged', 'not judged'),
    ]
    regime = [
        (summary.boundary_time, 'boundary', 'boundary: metal touches metal'),
        (summary.mixed_time, 'mixed', 'mixed: oil film and metal share the load'),
        (summary.hydrodynamic_time, 'hydrodynamic', 'hydrodynamic: the oil film carries'),
    ]
    return joined(
        [
            element('h3', f'Time in the optimal zone, of {duration(running)} in motion'),
            _bar(zone, running, duration),
            element('h3', 'Time in each lubrication regime'),
            _bar(regime, running, duration),
            *_energy(case, summary),
        ]
    )


def _bar(parts: Sequence[tuple[float, str, str]], whole: float, show: Any) -> Markup:
    texts = [f'{text}: {show(amount)} ({share(amount, whole)})' for amount, _, text in parts]
    drawn = share_bar([(amount, f'fill-{kind}') for amount, kind, _ in parts], '; '.join(texts))
    items = (
        element('li', swatch(kind), text) for (_, kind, _), text in zip(parts, texts, strict=True)
    )
    return joined([drawn, element('ul', *items, class_='legend')])


def _energy(case: AxisCase, summary: Summary) -> Iterable[Markup]:
    energy, total = case.survey.energy, summary.energy_lost
    if not total > 0.0:
        return
    power = total / summary.running_time
    yield element(
        'h3', f'Energy lost to friction: {number(total)} J, {number(power)} W on average'
    )
    parts = [
        (energy[Zone.OPTIMAL], 'optimal', 'while optimal'),
        (energy[Zone.OUTSIDE], 'outside', 'while outside the zone'),
    ]
    yield _bar(parts, math.fsum(energy.values()), lambda joules: f'{number(joules)} J')
    yield element(
        'p',
        'Losses in the screw as the model works them out, while it knows them; bearings, guides '
        'and motor are not in them.',
        class_='muted',
    )


def events_part(case: AxisCase) -> Markup:
    """Return the table of warnings, whose rows lead to their moment."""
    events = case.worst_first[:MOST_ROWS]
    if not events:
        return joined([element('h3', 'Warnings'), element('p', 'None.')])
    count = len(case.outcome.events)
    cut = f' The worst {MOST_ROWS} of {count} are shown.' if count > MOST_ROWS else ''
    worst = events[0].event_id
    rows = (_event_row(case, event, event.event_id == worst) for event in sorted(events, key=_at))
    return joined(
        [
            element('h3', f'Warnings: {count}'),
            element(
                'p',
                'A click on a row shows that moment in the charts. The worst one is marked.' + cut,
                class_='muted',
            ),
            table(
                ('No.', 'Begins at [s]', 'Lasts [s]', 'Cause', 'Worst', 'Limit', 'What to do'),
                rows,
                kind='leading sortable',
            ),
        ]
    )


def _at(event: EventRecord) -> int:
    return event.event_id


def _event_row(case: AxisCase, event: EventRecord, worst: bool) -> Row:
    begin, end = case.since_first(event.start), case.since_first(event.end)
    margin = max(1.0, 0.2 * (end - begin))
    metal = event.quantity == RCS
    cause = 'oil film too thin (RCS)' if metal else f'too much friction ({event.quantity})'
    show = number if metal else percent
    lasts = number(event.duration, 4) + (' and still on' if event.active else '')
    return Row(
        cells=(
            Cell(text=str(event.event_id), kind='number', value=event.event_id),
            Cell(text=f'{begin:.2f}', kind='number', value=begin),
            Cell(text=lasts, kind='number', value=event.duration),
            Cell(text=cause),
            Cell(text=show(event.worst_value), kind='short', value=badness(event)[0]),
            Cell(
                text=f'{SIGNS.get(event.relation, event.relation)} {show(event.limit)}',
                kind='short',
            ),
            Cell(text=event.advice or 'no better speed or load within the surface'),
        ),
        begin=begin - margin,
        end=end + margin,
        kind='bad' if worst else '',
    )


def torque_part(case: AxisCase) -> Markup:
    """Return how measured and modelled torque compare, nothing where none was measured."""
    fit = case.survey.torque
    if not fit.count:
        return Markup()
    lines = [
        f'In motion the measured torque differs from the model by {number(fit.spread)} N m '
        f'(root mean square) at {number(fit.measured)} N m; on average by '
        f'{number(fit.forward)} N m forward and {number(fit.backward)} N m backward.'
    ]
    lines += _torque_reasons(fit.forward, fit.backward)
    return joined(
        [element('h3', 'Torque: measured and modelled'), *(element('p', line) for line in lines)]
    )


def _torque_reasons(forward: float, backward: float) -> list[str]:
    """Return what a mean difference may come from; both directions must have been seen."""
    if math.isnan(forward + backward):
        return ['Only one direction was recorded, so friction and offset cannot be told apart.']
    friction, offset = 0.5 * (forward - backward), 0.5 * (forward + backward)
    said = [
        f'The part that turns with the direction, {number(friction)} N m, is '
        + (
            'friction that the model does not know: wipers, recirculation, bearings, guides. '
            '`ballscrew identify` fits it.'
            if friction > 0
            else 'friction that the model has too much of.'
        ),
        f'The part that does not, {number(offset)} N m, is weight of the axis, or a wrong zero.',
    ]
    return said


def inputs_part(case: AxisCase) -> Markup:
    """Return what the inputs were like, hints, and what interrupted them."""
    seen = inputs_seen(case)
    hints = [hint for one in seen for hint in one.hints]
    return joined(
        [
            element('h3', 'Inputs'),
            *(element('p', f'Check: {hint}.', class_='hint') for hint in hints),
            table(
                (
                    'Input',
                    'Source',
                    'Lowest',
                    'Highest',
                    'Unit',
                    'Rate [Hz]',
                    'Read from',
                    'Refused',
                ),
                (_input_row(one) for one in seen),
            ),
            element(
                'p', 'Only these columns of the recording were read for this page.', class_='muted'
            ),
        ]
    )


def _input_row(seen: InputSeen) -> Row:
    tag = element('span', seen.origin, class_=f'tag {"measured" if seen.measured else "assumed"}')
    return Row(
        cells=(
            Cell(text=NAMES[seen.source]),
            Cell(text=tag),
            Cell(text=number(seen.low, 4), kind='short'),
            Cell(text=number(seen.high, 4), kind='short'),
            Cell(text=seen.unit, kind='short'),
            Cell(text=number(seen.rate, 4), kind='number'),
            Cell(text=seen.place),
            Cell(text=seen.refused or 'none' if seen.place else ''),
        )
    )


def gaps_part(case: AxisCase) -> Markup:
    """Return how long what could not be judged, and the gaps in the speed."""
    survey = case.survey
    reasons = sorted(survey.reasons.items(), key=lambda item: -item[1])
    rows = [
        Row(
            cells=(
                Cell(text=_reason_text(reason)),
                Cell(text=number(time, 4), kind='number', value=time),
                Cell(text=share(time, survey.span), kind='short'),
            )
        )
        for reason, time in reasons
    ]
    return joined(
        [
            element('h3', 'What could be judged'),
            table(('State', 'Time [s]', 'Of the recording'), rows),
            *_gap_table(case),
        ]
    )


def _reason_text(reason: Reason) -> str:
    if reason is Reason.JUDGED:
        return 'judged'
    still = reason is Reason.STANDSTILL
    return reason.text if still else f'not judged: {reason.text}'


def _gap_table(case: AxisCase) -> Iterable[Markup]:
    survey = case.survey
    timeout = case.settings.timeouts[Source.SPEED] * 1e-9
    if not survey.gap_count:
        yield element('p', f'The speed has no gap longer than its timeout of {timeout:g} s.')
        return
    cut = (
        f', the longest {len(survey.gaps)} are listed'
        if len(survey.gaps) < survey.gap_count
        else ''
    )
    yield element(
        'p',
        f'The speed has {survey.gap_count} gaps longer than its timeout of {timeout:g} s, in all '
        f'{duration(survey.gap_time)}{cut}.',
    )
    rows = (
        Row(
            cells=(
                Cell(text=f'{begin:.2f}', kind='number', value=begin),
                Cell(text=number(length, 4), kind='number', value=length),
            ),
            begin=begin - 1.0,
            end=begin + length + 1.0,
        )
        for begin, length in ((case.since_first(at), gap * 1e-9) for at, gap in survey.gaps)
    )
    yield element(
        'details',
        element('summary', 'Gaps in the speed'),
        table(('Begins at [s]', 'Lasts [s]'), rows, kind='leading sortable'),
    )


def caution(cases: Sequence[AxisCase]) -> Iterable[Markup]:
    """Yield what the verdicts rest on that is neither measured nor stated, if anything."""
    assumed = dict.fromkeys(name for case in cases for name in _assumed_names(case))
    if assumed:
        yield element(
            'p',
            f'Assumed, neither measured nor stated: {", ".join(assumed)}. '
            'The verdict holds as far as these do.',
            class_='hint',
        )


def _assumed_names(case: AxisCase) -> Iterable[str]:
    """Yield in words what is assumed of an axis."""
    if case.load_from:
        yield f'axial load, worked out from the motor {case.load_from}'
    if Source.TEMPERATURE not in case.inputs:
        yield f'oil temperature of {celsius(case.settings.default_temperature):g} °C'
    for key in case.assumed:
        if key not in ('load.from', 'load', 'temperature_degC'):
            yield KEYS.get(key, key.replace('.', ' ').replace('_', ' '))


def assumptions_part(case: AxisCase, parameters: str) -> Markup:
    """Return what the verdict stands on: model, screw, oil, limits, and what was assumed."""
    surface, limits = case.surface, case.settings.limits
    facts = [
        ('Model', TIERS.get(surface.tier, surface.tier), 'stated'),
        ('Screw', surface.screw_name, _stated(case, 'screw')),
        ('Lead', f'{1e3 * surface.lead:g} mm', _stated(case, 'lead_mm')),
        ('Preload', f'{surface.preload:g} N', _stated(case, 'screw')),
        ('Oil', surface.oil_name, _stated(case, 'oil')),
        *_conditions(case),
        (
            'Limits',
            f'RCS below {limits.rcs:g}, efficiency from {100 * limits.efficiency:g} %, '
            f'judged from {limits.light_load:.4g} N and {limits.standstill_speed:g} rad/s on',
            'stated',
        ),
        ('Parameters', parameters, 'stated'),
    ]
    rows = [_fact_row(*fact) for fact in facts]
    rows += [
        _fact_row(f'Assumed: {key}', f'{one.get("value")}: {one.get("reason", "")}', 'assumed')
        for key, one in case.assumed.items()
    ]
    return joined(
        [
            element('h3', 'What this rests on'),
            table(('What', 'Value', 'Known how'), rows),
            element(
                'p',
                'Screw, oil and model are those that the parameters state; nothing in a recording '
                'tells whether the machine has them.',
                class_='muted',
            ),
        ]
    )


def _stated(case: AxisCase, key: str) -> str:
    return 'assumed' if key in case.assumed else 'stated'


def _conditions(case: AxisCase) -> list[tuple[str, str, str]]:
    """Return where oil temperature and load come from."""
    rows = []
    for seen in inputs_seen(case):
        if seen.source in (Source.TEMPERATURE, Source.LOAD):
            known = 'measured' if seen.measured else 'assumed'
            text = f'{seen.origin}, {seen.place}' if seen.place else seen.origin
            rows.append((NAMES[seen.source], text, known))
    oil = case.survey.oil
    if math.isfinite(oil.mean):
        low, high = celsius(oil.low), celsius(oil.high)
        span = f'{low:.3g} °C' if low == high else f'{low:.3g} to {high:.3g} °C'
        rows.append(('Oil in motion', span, rows[1][2] if len(rows) > 1 else 'assumed'))
    return rows


def _fact_row(name: str, value: str, known: str) -> Row:
    kind = {'measured': 'tag measured', 'assumed': 'tag assumed'}.get(known, 'tag')
    return Row(
        cells=(Cell(text=name), Cell(text=value), Cell(text=element('span', known, class_=kind)))
    )
