# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The health of an axis as parts of pages: a chapter, and trends over dates with intervals."""

from collections.abc import Iterable, Sequence

from ballscrew_monitor.core.conversions import clock_text, seconds
from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.peers import Peer
from ballscrew_monitor.health.records import Condition, Health, Quantity, TOLERANCE
from ballscrew_monitor.recordings.words import number
from ballscrew_monitor.report.page import element, joined, Markup, table, TableCell, TableRow
from ballscrew_monitor.report.trend import Mark, trend

CONDITIONS = {
    Condition.NORMAL: 'good',
    Condition.SLIGHTLY_CHANGED: 'unknown',
    Condition.WORSE: 'bad',
    Condition.UNKNOWN: 'unknown',
}
MARKS = {
    Condition.NORMAL: 'optimal',
    Condition.SLIGHTLY_CHANGED: 'unjudged',
    Condition.WORSE: 'outside',
    Condition.UNKNOWN: 'unjudged',
}


def verdict_box(health: Health) -> Markup:
    """Return the sentence about an axis, with what to do."""
    advice = f' {health.advice[:1].upper()}{health.advice[1:]}.' if health.advice else ''
    sentence = element('p', health.verdict + advice, class_='sentence')
    return element('div', sentence, class_=f'verdict {CONDITIONS[health.condition]}')


def health_chapter(health: Health) -> Markup:
    """Return the health of an axis: the verdict, what is known and what is not, and causes."""
    known = [one for one in health.quantities if one.is_known]
    return joined(
        element('h3', 'Health: normal or worse'),
        verdict_box(health),
        *_known(known),
        *_causes(health),
        *(
            element('p', f'{", ".join(names)}: {reason}.', class_='muted')
            for reason, names in health.unknown.items()
        ),
        *(element('p', f'Note: {note}.', class_='hint') for note in health.notes),
    )


def _known(quantities: Sequence[Quantity]) -> Iterable[Markup]:
    if quantities:
        heads = 'Quantity', 'Value', '95 % interval', 'Unit', 'Rests on'
        yield table(heads, (_row(one) for one in quantities))


def _row(one: Quantity) -> TableRow:
    return TableRow(
        (
            one.name,
            TableCell(number(one.value), kind='number'),
            TableCell(f'{number(one.low)} to {number(one.high)}', kind='short'),
            one.unit,
            one.evidence,
        )
    )


def _causes(health: Health) -> Iterable[Markup]:
    if health.causes:
        rows = (
            TableRow(('excluded' if one.excluded else f'{100.0 * one.weight:.0f} %', one.text))
            for one in health.causes
        )
        yield table(('Weight', 'Cause'), rows)


def peers_table(peers: Sequence[Peer]) -> Iterable[Markup]:
    """Yield how axes with one programme rank, the one that differs most first."""
    if peers:
        yield element('h3', 'Axes with the same programme, beside each other')
        heads = 'Axis', 'Friction [%]', '95 % interval [%]', 'Peers', 'Said'
        yield table(heads, (_peer_row(one) for one in peers))


def _peer_row(one: Peer) -> TableRow:
    value, low, high = (
        100.0 * part for part in (one.difference.value, one.difference.low, one.difference.high)
    )
    return TableRow(
        (
            one.axis,
            TableCell(f'{value:+.0f}', kind='number', value=value),
            TableCell(f'{low:+.0f} to {high:+.0f}', kind='number', value=low),
            TableCell(f'{one.peers}', kind='number', value=one.peers),
            'apart from its peers' if one.is_apart else 'as its peers',
        ),
        kind='bad' if one.is_apart else '',
    )


def health_trends(courses: Sequence[Health]) -> Iterable[Markup]:
    """Yield the change of the friction with its intervals, if it is known at two dates or more."""
    marks = [_mark(one, one.quantity(DRAG)) for one in courses if one.quantity(DRAG).is_known]
    drawn = trend(marks, normal=0.0, tolerance=TOLERANCE)
    if drawn:
        title = 'change of the friction, with 95 % intervals'
        yield element('h3', f'Axis {courses[-1].axis}: {title}')
        yield drawn


def _mark(health: Health, quantity: Quantity) -> Mark:
    percent = f'{100.0 * quantity.value:.0f} %'
    between = f'{100.0 * quantity.low:.0f} to {100.0 * quantity.high:.0f} %'
    return Mark(
        at=seconds(health.stamp),
        value=quantity.value,
        low=quantity.low,
        high=quantity.high,
        kind=MARKS[health.condition],
        title=f'{clock_text(health.stamp)[:10]}: {percent} ({between})',
    )
