# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What was recorded: torque beside the model, inputs and their troubles, what could be judged."""

from collections.abc import Iterable, Sequence
import math

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.recordings.words import counted, duration, NONE, number, share, shown_unit
from ballscrew_monitor.report.case import AxisCase
from ballscrew_monitor.report.inputs_seen import inputs_seen, InputSeen, NAMES, Trouble
from ballscrew_monitor.report.markup import element, joined, Markup, table, TableCell, TableRow
from ballscrew_monitor.report.page_budget import MOST_ROWS
from ballscrew_monitor.report.provenance import TAGS
from ballscrew_monitor.report.survey import REST


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
    # What rounding leaves of equal means is no torque.
    friction, offset = (round(0.5 * mean, 6) for mean in (forward - backward, forward + backward))
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
            *_trouble_table(seen),
            element(
                'p', 'Only these columns of the recording were read for this page.', class_='muted'
            ),
        ]
    )


def _input_row(seen: InputSeen) -> TableRow:
    tag = element('span', seen.origin, class_=TAGS[seen.known])
    rate = number(seen.rate, 4) + (' assumed' if seen.rate_assumed else '')
    return TableRow(
        (
            NAMES[seen.source],
            TableCell(tag, kind='place'),
            TableCell(number(seen.low, 4), kind='short'),
            TableCell(number(seen.high, 4), kind='short'),
            TableCell(shown_unit(seen.unit), kind='short'),
            TableCell(rate, kind='number'),
            TableCell(seen.place, kind='place'),
            seen.refused or 'none' if seen.place else '',
        )
    )


def _trouble_table(seen: Sequence[InputSeen]) -> Iterable[Markup]:
    """Yield what is wrong with the messages of the inputs; what went well has no column."""
    heads = [head for head in Trouble if any(head in one.troubles for one in seen)]
    if heads:
        rows = (
            TableRow((NAMES[one.source], *(one.troubles.get(head, NONE) for head in heads)))
            for one in seen
            if one.place
        )
        yield table(('Input', *(head.value for head in heads)), rows)


def gaps_part(case: AxisCase, most: int = MOST_ROWS) -> Markup:
    """Return how long what could not be judged, and the longest gaps in the speed, `most` rows."""
    survey = case.survey
    times = [(_reason_text(reason), time) for reason, time in survey.reasons.items()]
    if survey.rest:
        times.append((f'not judged: {REST}', survey.rest))
    rows = [
        TableRow(
            (
                text,
                TableCell(number(time, 4), kind='number', value=time),
                TableCell(share(time, survey.span), kind='short'),
            )
        )
        for text, time in sorted(times, key=lambda row: -row[1])
    ]
    return joined(
        [
            element('h3', 'What could be judged'),
            table(('State', 'Time [s]', 'Of the recording'), rows),
            *_gap_table(case, most),
        ]
    )


def _reason_text(reason: Reason) -> str:
    if reason is Reason.JUDGED:
        return 'judged'
    still = reason is Reason.STANDSTILL
    return reason.text if still else f'not judged: {reason.text}'


def _gap_table(case: AxisCase, most: int) -> Iterable[Markup]:
    survey = case.survey
    listed = survey.speed_gaps[:most]
    timeout = case.settings.timeouts[Source.SPEED] * 1e-9
    gaps = survey.gaps[Source.SPEED]
    if not gaps.count:
        yield element('p', f'The speed has no gap longer than its timeout of {timeout:g} s.')
        return
    cut = f', the longest {len(listed)} are listed' if len(listed) < gaps.count else ''
    yield element(
        'p',
        f'The speed has {counted(gaps.count, "gap")} longer than its timeout of '
        f'{timeout:g} s, in all {duration(gaps.time)}{cut}.',
    )
    rows = (
        TableRow(
            (
                TableCell(f'{begin:.2f}', kind='number', value=begin),
                TableCell(number(length, 4), kind='number', value=length),
            ),
            begin=begin - 1.0,
            end=begin + length + 1.0,
        )
        for begin, length in ((case.since_first(at), gap * 1e-9) for at, gap in listed)
    )
    yield element(
        'details',
        element('summary', 'Gaps in the speed'),
        table(('Begins at [s]', 'Lasts [s]'), rows, kind='leading sortable'),
    )
