# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The health of an axis as parts of pages: a chapter, and trends over dates with intervals."""

from collections.abc import Iterable, Sequence

from ballscrew_monitor.core.conversions import clock_text, seconds
from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.peers import Peer
from ballscrew_monitor.health.records import Condition, Health, TOLERANCE
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
    known = [
        TableRow(
            (
                quantity.name,
                TableCell(number(quantity.value), kind='number'),
                TableCell(f'{number(quantity.low)} to {number(quantity.high)}', kind='short'),
                quantity.unit,
                quantity.evidence,
            )
        )
        for quantity in health.quantities
        if quantity.is_known
    ]
    causes = [
        TableRow(('excluded' if cause.excluded else f'{100.0 * cause.weight:.0f} %', cause.text))
        for cause in health.causes
    ]
    heads = 'Quantity', 'Value', '95 % interval', 'Unit', 'Rests on'
    return joined(
        element('h3', 'Health: normal or worse'),
        verdict_box(health),
        table(heads, known) if known else '',
        table(('Weight', 'Cause'), causes) if causes else '',
        *(
            element('p', f'{", ".join(names)}: {reason}.', class_='muted')
            for reason, names in health.unknown.items()
        ),
        *(element('p', f'Note: {note}.', class_='hint') for note in health.notes),
    )


def peers_table(peers: Sequence[Peer]) -> Iterable[Markup]:
    """Yield how axes with one programme rank, the one that differs most first."""
    if not peers:
        return
    rows = []
    for peer in peers:
        difference = peer.difference
        value, low, high = (
            100.0 * part for part in (difference.value, difference.low, difference.high)
        )
        cells = (
            peer.axis,
            TableCell(f'{value:+.0f}', kind='number', value=value),
            TableCell(f'{low:+.0f} to {high:+.0f}', kind='number', value=low),
            TableCell(f'{peer.peers}', kind='number', value=peer.peers),
            'apart from its peers' if peer.is_apart else 'as its peers',
        )
        rows.append(TableRow(cells, kind='bad' if peer.is_apart else ''))
    yield element('h3', 'Axes with the same programme, beside each other')
    yield table(('Axis', 'Friction [%]', '95 % interval [%]', 'Peers', 'Said'), rows)


def health_trends(courses: Sequence[Health]) -> Iterable[Markup]:
    """Yield the change of the friction with its intervals, if it is known at two dates or more."""
    marks = []
    for health in courses:
        drag = health.quantity(DRAG)
        if drag.is_known:
            value, low, high = (
                f'{100.0 * part:.0f}' for part in (drag.value, drag.low, drag.high)
            )
            title = f'{clock_text(health.stamp)[:10]}: {value} % ({low} to {high} %)'
            marks.append(
                Mark(
                    at=seconds(health.stamp),
                    value=drag.value,
                    low=drag.low,
                    high=drag.high,
                    kind=MARKS[health.condition],
                    title=title,
                )
            )
    drawn = trend(marks, normal=0.0, tolerance=TOLERANCE)
    if drawn:
        title = 'change of the friction, with 95 % intervals'
        yield element('h3', f'Axis {courses[-1].axis}: {title}')
        yield drawn
