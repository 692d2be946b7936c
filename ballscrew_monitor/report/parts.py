# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parts of a report on one axis, from the verdict to the warnings."""

from collections.abc import Iterable, Sequence
import math
from typing import Any

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.summary import EventRecord, Summary
from ballscrew_monitor.recordings.words import duration, NONE, number, share
from ballscrew_monitor.report.judging import AxisCase, badness, RCS
from ballscrew_monitor.report.page import (
    element,
    joined,
    Markup,
    share_bar,
    swatch,
    table,
    TableCell,
    TableRow,
)
from ballscrew_monitor.report.page_budget import MOST_ROWS
from ballscrew_monitor.report.verdict import AxisVerdict

SIGNS = {'>=': '≥'}
LASTING = ' A warning goes on over standstill and over what could not be judged.'


def verdict_part(verdict: AxisVerdict) -> Markup:
    """Return the verdict as a box."""
    lines = [line for line in (verdict.why, verdict.remedy) if line]
    if verdict.remedy:
        lines[-1] = f'What to do: {verdict.remedy[0].lower()}{verdict.remedy[1:]}'
    return element(
        'div',
        element(
            'p',
            element('strong', f'{verdict.standing.word}:'),
            f' {verdict.sentence}',
            class_='sentence',
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
        (
            NONE if summary.says_nothing else share(summary.outside_time, running),
            'of the motion outside the optimal zone',
        ),
        (str(len(summary.events)), 'warning' if len(summary.events) == 1 else 'warnings'),
        (f'{number(summary.energy_lost, 4)} J', 'lost to friction in the screw'),
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
        element('h3', f'Time in the optimal zone, of {duration(running)} in motion'),
        _bar(zone, running, duration),
        element('h3', 'Time in each lubrication regime'),
        _bar(regime, running, duration),
        *_energy(case, summary),
    )


def _bar(parts: Sequence[tuple[float, str, str]], whole: float, show: Any) -> Markup:
    texts = [f'{text}: {show(amount)} ({share(amount, whole)})' for amount, _, text in parts]
    drawn = share_bar([(amount, f'fill-{kind}') for amount, kind, _ in parts], '; '.join(texts))
    items = (
        element('li', swatch(kind), text) for (_, kind, _), text in zip(parts, texts, strict=True)
    )
    return joined(drawn, element('ul', *items, class_='legend'))


def _energy(case: AxisCase, summary: Summary) -> Iterable[Markup]:
    energy, total = case.survey.energy, summary.energy_lost
    if not total > 0.0:
        return
    power = total / summary.running_time
    yield element(
        'h3', f'Energy lost to friction: {number(total, 4)} J, {number(power)} W on average'
    )
    parts = [
        (energy[Zone.OPTIMAL], 'optimal', 'while optimal'),
        (energy[Zone.OUTSIDE], 'outside', 'while outside the zone'),
    ]
    yield _bar(parts, math.fsum(energy.values()), lambda joules: f'{number(joules, 4)} J')
    yield element(
        'p',
        'Losses in the screw as the model works them out, while it knows them; bearings, guides '
        'and motor are not in them.',
        class_='muted',
    )


def events_part(case: AxisCase, most: int = MOST_ROWS) -> Markup:
    """Return the table of the worst warnings, `most` rows, which lead to their moment."""
    events = case.worst_first[:most]
    if not events:
        return joined(element('h3', 'Warnings'), element('p', 'None.'))
    count = len(case.outcome.events)
    cut = f' The worst {most} of {count} are shown.' if count > most else ''
    worst = events[0].event_id
    in_order = sorted(events, key=lambda event: event.event_id)
    rows = (_event_row(case, event, event.event_id == worst) for event in in_order)
    return joined(
        element('h3', f'Warnings: {count}'),
        element(
            'p',
            'A click on a row shows that moment in the charts. The worst one is marked.'
            + cut
            + LASTING,
            class_='muted',
        ),
        table(
            ('No.', 'Begins at [s]', 'Lasts [s]', 'Cause', 'Worst', 'Limit', 'What to do'),
            rows,
            kind='leading sortable',
        ),
    )


def _event_row(case: AxisCase, event: EventRecord, worst: bool) -> TableRow:
    begin, shown = case.since_first(event.start), case.shown(event)
    metal = event.quantity == RCS
    cause = 'oil film too thin (RCS)' if metal else f'too much friction ({event.quantity})'
    todo = event.what_to_do
    lasts = number(event.duration, 4) + (' and still on' if event.active else '')
    return TableRow(
        (
            TableCell(str(event.event_id), kind='number', value=event.event_id),
            TableCell(f'{begin:.2f}', kind='number', value=begin),
            TableCell(lasts, kind='number', value=event.duration),
            cause,
            TableCell(event.shown(event.worst_value), kind='short', value=badness(event)[0]),
            TableCell(
                text=f'{SIGNS.get(event.relation, event.relation)} {event.shown(event.limit)}',
                kind='short',
            ),
            f'at {event.place}: {todo}' if event.place else todo or NONE,
        ),
        begin=shown[0],
        end=shown[1],
        kind='bad' if worst else '',
    )
