# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Basis of the verdict of a report: model, screw, oil and limits, and how each is known.

And what was recorded: torque beside the model, inputs and their troubles, what could be judged.

"""

from collections.abc import Iterable, Sequence
import math

from ballscrew_monitor.core.conversions import celsius
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.recordings.log_facts import grouped
from ballscrew_monitor.recordings.words import counted, duration, NONE, number, share, shown_unit
from ballscrew_monitor.report.buckets import MOST_ROWS
from ballscrew_monitor.report.inputs_seen import hints_on, inputs_seen, NAMES, Trouble
from ballscrew_monitor.report.judging import AxisCase
from ballscrew_monitor.report.page import element, joined, Markup, table, TableCell, TableRow
from ballscrew_monitor.report.survey import REST
from surrogate.units import MILLI

TIERS = {
    'full': 'full model (solved contacts, roughness that rolls)',
    'closed_form': 'closed-form model (published formulas): an estimate, whose contact begins '
    'within a factor of two in speed',
}
KEYS = {
    'screw': 'the screw',
    'oil': 'the oil',
    'lead_mm': 'lead of {} mm',
    'efficiency': 'efficiency of {} used for the load',
    'torque_constant_Nm_per_A': 'torque constant of the motor of {} N m/A',
    'torque_rated_Nm': 'rated torque of the motor of {} N m',
    'time.rate_Hz': 'rate of the samples of {} Hz',
    'time.epoch': 'date',
}
"""Words for what a log may leave to be assumed, with a place for its value."""
TAGS = {
    'measured': 'tag measured',
    'stated': 'tag',
    'assumed': 'tag assumed',
    'contradiction': 'tag bad',
}


def caution(cases: Sequence[AxisCase]) -> Iterable[Markup]:
    """Yield what the verdicts rest on that is neither measured nor stated, if anything."""
    assumed: dict[str, list[str]] = {case.axis: [] for case in cases}
    for case in cases:
        names, temperature = assumed[case.axis], case.settings.default_temperature
        if case.nominal:
            names += [KEYS['screw'], KEYS['oil']]
        if case.load_origin:
            names.append(f'axial load, {case.load_origin}')
        is_assumed = case.facts.default_temperature_known == 'assumed'
        if Source.TEMPERATURE not in case.inputs and is_assumed:
            names.append(f'oil temperature of {celsius(temperature):g} °C')
        for key, assumption in case.facts.assumed.items():
            if key in ('load.from', 'load', 'temperature_degC'):  # told above
                continue
            value = assumption.get('value')
            shown = f'{value:g}' if isinstance(value, float) else str(value)
            if key == 'efficiency' and isinstance(value, float):
                shown = f'{100.0 * value:g} %'
            quantity, _, part = key.rpartition('.')
            if quantity and part == 'unit':
                names.append(f'{quantity} in {shown_unit(shown)}')
            elif key in KEYS:
                names.append(KEYS[key].format(shown))
            else:
                names.append(key.replace('.', ' ').replace('_', ' '))
    groups = grouped(assumed)
    head, tail = 'Assumed, neither measured nor stated:', 'The verdict holds as far as these do.'
    if not groups:
        return
    if len(cases) == 1:
        yield element('p', f'{head} {", ".join(groups[0][1])}. {tail}', class_='hint')
        return
    items = (element('li', f'{whose}: {", ".join(names)}') for whose, names in groups)
    yield element(
        'div', element('p', head), element('ul', *items), element('p', tail), class_='hint'
    )


def checks(cases: Sequence[AxisCase]) -> Iterable[Markup]:
    """Yield what contradicts itself among the inputs, with what mends it."""
    return (element('p', f'Check: {hint}.', class_='hint') for hint in hints_on(cases))


def assumptions_part(case: AxisCase, parameters: str) -> Markup:
    """Return what the verdict stands on: model, screw, oil, limits, and what was assumed."""
    surface, limits, oil = case.surface, case.settings.limits, case.survey.oil
    conditions = [
        (
            NAMES[seen.source],
            f'{seen.origin}, {seen.place}' if seen.place else seen.origin,
            seen.known,
        )
        for seen in inputs_seen(case)
        if seen.source in (Source.TEMPERATURE, Source.LOAD)
    ]
    if math.isfinite(oil.mean):
        low, high = celsius(oil.low), celsius(oil.high)
        span = f'{low:.3g} °C' if low == high else f'{low:.3g} to {high:.3g} °C'
        conditions.append(('Oil in motion', span, conditions[1][2]))
    applied = (
        f'RCS below {limits.rcs:g}, efficiency from {100 * limits.efficiency:g} %, '
        f'judged from {limits.light_load:.4g} N and {limits.standstill_speed:g} rad/s on'
    )
    used, lead = case.surface.lead, case.facts.lead
    is_other = not (math.isnan(lead) or math.isclose(lead, used, rel_tol=1e-6))
    length = f'{MILLI * (lead if is_other else used):g} mm'
    leads = [('Lead', length, _stated(case, 'lead_mm'))]
    if is_other:
        text = f'{MILLI * used:g} mm, not that of the axis: build the surface of this screw'
        leads.append(('Lead of the surface', text, 'contradiction'))
    facts = [
        ('Model', TIERS.get(surface.tier, surface.tier), _stated(case, 'surface')),
        ('Screw', surface.screw_name, _stated(case, 'screw')),
        *leads,
        ('Preload', f'{surface.preload:g} N', _stated(case, 'screw')),
        ('Oil', surface.oil_name, _stated(case, 'oil')),
        *conditions,
        ('Limits', applied, _stated(case, 'limits')),
        ('Parameters', parameters, _stated(case, 'parameters')),
    ]
    for key, assumption in case.facts.assumed.items():
        value = f'{assumption.get("value")}: {assumption.get("reason", "")}'
        facts.append((f'Assumed: {key}', value, 'assumed'))
    rows = (
        TableRow((name, value, element('span', known, class_=TAGS[known])))
        for name, value, known in facts
    )
    note = (
        'Screw, oil and model are those of the parameters; nothing in a recording tells whether '
        'the machine has them.'
    )
    return joined(
        element('h3', 'What this rests on'),
        table(('What', 'Value', 'Known how'), rows),
        element('p', note, class_='muted'),
    )


def _stated(case: AxisCase, key: str) -> str:
    unsaid = case.nominal or key in case.facts.assumed or key in case.facts.defaulted
    return 'assumed' if unsaid else 'stated'


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
    # What rounding leaves of equal means is no torque.
    friction, offset = (
        round(0.5 * mean, 6) for mean in (fit.forward - fit.backward, fit.forward + fit.backward)
    )
    if math.isnan(offset):
        lines.append(
            'Only one direction was recorded, so friction and offset cannot be told apart.'
        )
    else:
        reason = (
            'friction that the model does not know: wipers, recirculation, bearings, guides. '
            '`ballscrew identify` fits it.'
            if friction > 0
            else 'friction that the model has too much of.'
        )
        lines += [
            f'The part that turns with the direction, {number(friction)} N m, is {reason}',
            f'The part that does not, {number(offset)} N m, is weight of the axis, or a wrong '
            'zero.',
        ]
    return joined(
        element('h3', 'Torque: measured and modelled'), *(element('p', line) for line in lines)
    )


def inputs_part(case: AxisCase) -> Markup:
    """Return what the inputs were like, what interrupted them, and what became of messages."""
    inputs, ledgers, seen = [], [], inputs_seen(case)
    for each in seen:
        cells = (
            TableCell(element('span', each.origin, class_=TAGS[each.known]), kind='place'),
            TableCell(number(each.low, 4), kind='short'),
            TableCell(number(each.high, 4), kind='short'),
            TableCell(shown_unit(each.unit), kind='short'),
            TableCell(
                number(each.rate, 4) + (' assumed' if each.rate_assumed else ''), kind='number'
            ),
            TableCell(each.place, kind='place'),
            each.refused or 'none' if each.place else '',
        )
        inputs.append(TableRow((NAMES[each.source], *cells)))
        if ledger := each.ledger:
            promised = NONE if ledger.promised is None else str(ledger.promised)
            numbers = promised, str(ledger.present), str(ledger.read), str(ledger.judged)
            counts = (TableCell(text, kind='number') for text in numbers)
            ledgers.append(TableRow((NAMES[each.source], *counts, ledger.words)))
    # What went well with the messages of all inputs has no column.
    troubles = {NAMES[each.source]: each.troubles for each in seen if each.place}
    heads = [head for head in Trouble if any(head in amounts for amounts in troubles.values())]
    troubled = (
        TableRow((name, *(amounts.get(head, NONE) for head in heads)))
        for name, amounts in troubles.items()
    )
    columns = 'Input', 'Source', 'Lowest', 'Highest', 'Unit', 'Rate [Hz]', 'Read from', 'Refused'
    counted_as = 'Input', 'Promised', 'Present', 'Read', 'Judged', 'Reasons of the differences'
    return joined(
        element('h3', 'Inputs'),
        table(columns, inputs),
        *([table(('Input', *(head.value for head in heads)), troubled)] if heads else []),
        element('h3', 'What became of each message'),
        table(counted_as, ledgers),
        element(
            'p', 'Only these columns of the recording were read for this page.', class_='muted'
        ),
    )


def gaps_part(case: AxisCase, most: int = MOST_ROWS) -> Markup:
    """Return how long what could not be judged, and the longest gaps in the speed, `most` rows."""
    survey = case.survey
    words = {Reason.JUDGED: 'judged', Reason.STANDSTILL: Reason.STANDSTILL.text}
    times = [
        (words.get(reason, f'not judged: {reason.text}'), time)
        for reason, time in survey.reasons.items()
    ]
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
        element('h3', 'What could be judged'),
        table(('State', 'Time [s]', 'Of the recording'), rows),
        *_gap_table(case, most),
    )


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
