# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The report of one recording: a page that a person reads, forwards and prints."""

from collections.abc import Iterable, Mapping, Sequence
import math
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.declared import plain
from ballscrew_monitor.recordings.summary import Summary
from ballscrew_monitor.recordings.words import duration, NONE, number, share
from ballscrew_monitor.report import buckets, provenance, time_series
from ballscrew_monitor.report.buckets import axis_budgets, AxisBudget
from ballscrew_monitor.report.health_part import health_chapter
from ballscrew_monitor.report.judging import AxisCase, badness, LogCase, RCS
from ballscrew_monitor.report.map_record import map_legend, operating_map, OperatingMap
from ballscrew_monitor.report.page import (
    CHARTS,
    element,
    joined,
    Markup,
    page,
    script_json,
    share_bar,
    swatch,
    table,
    TableCell,
    TableRow,
)
from ballscrew_monitor.report.verdict import AxisVerdict, parts_outside, verdicts_of

SIGNS = {'>=': '≥'}
LASTING = ' A warning goes on over standstill and over what could not be judged.'


def verdict_part(verdict: AxisVerdict) -> Markup:
    """Return the verdict as a box."""
    lines = [line for line in (verdict.why, verdict.remedy) if line]
    first = [element('p', f'Normal? {verdict.normal}.')] if verdict.normal else []
    if verdict.remedy:
        lines[-1] = f'What to do: {verdict.remedy[0].lower()}{verdict.remedy[1:]}'
    lines += [verdict.contact] if verdict.contact else []
    return element(
        'div',
        *first,
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
    running, turns = summary.running_time, number(summary.revolutions, 4)
    travel = turns, 'revolutions'
    if case.speaks_feed:
        way = number(summary.revolutions * case.surface.lead, 4)
        travel = f'{way} m', f'travelled, {turns} revolutions'
    facts = (
        (duration(case.survey.span), 'recorded'),
        (duration(running), f'in motion ({share(running, case.survey.span)})'),
        _outside(case, summary),
        (str(len(summary.events)), 'warning' if len(summary.events) == 1 else 'warnings'),
        (f'{number(summary.energy_lost, 4)} J', 'lost to friction in the screw'),
        travel,
    )
    parts = (
        element('div', element('b', value), element('span', text), class_='tile')
        for value, text in facts
    )
    return element('div', *parts, class_='tiles')


def _outside(case: AxisCase, summary: Summary) -> tuple[str, str]:
    """Return the share of the motion surely outside, or outside where nothing tells how surely."""
    sure = min(case.surely_outside, summary.outside_time)
    word, time = ('', summary.outside_time) if math.isnan(sure) else ('surely ', sure)
    part = NONE if summary.says_nothing else share(time, summary.running_time)
    return part, f'of the motion {word}outside the optimal zone'


def shares(case: AxisCase, summary: Summary) -> Markup:
    """Return time in zone and regime, and the energy lost in each zone, as bars."""
    running = summary.running_time
    zone = [
        (summary.optimal_time, 'optimal', 'optimal'),
        *(
            (
                time,
                'perhaps' if word == 'perhaps' else 'outside',
                f'{word} outside the optimal zone'.lstrip(),
            )
            for word, time in parts_outside(case, summary).items()
        ),
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


def events_part(case: AxisCase, most: int) -> Markup:
    """Return the table of the worst warnings, `most` rows, which lead to their moment."""
    events = case.worst_first[:most]
    if not events:
        return joined(element('h3', 'Warnings'), element('p', 'None.'))
    count, worst, rows = len(case.outcome.events), events[0].event_id, []
    advised = any(event.advice for event in events)
    for event in sorted(events, key=lambda event: event.event_id):
        begin, (first, last) = case.since_first(event.start), case.shown(event)
        metal = event.quantity == RCS
        lasts = number(event.duration, 4)
        lasts += ' and still on' if event.active else ', the run ended' if event.run_ended else ''
        limit = f'{SIGNS.get(event.relation, event.relation)} {event.shown(event.limit)}'
        cells = (
            TableCell(str(event.event_id), kind='number', value=event.event_id),
            TableCell(f'{begin:.2f}', kind='number', value=begin),
            TableCell(lasts, kind='number', value=event.duration),
            'oil film too thin (RCS)' if metal else f'too much friction ({event.quantity})',
            TableCell(event.shown(event.worst_value), kind='short', value=badness(event)[0]),
            TableCell(text=limit, kind='short'),
            case.in_its_unit(event.place) or NONE,
            *([case.in_its_unit(event.advice) or NONE] if advised else []),
        )
        kind = 'bad' if event.event_id == worst else ''
        rows.append(TableRow(cells, begin=first, end=last, kind=kind))
    heads = 'No.', 'Begins at [s]', 'Lasts [s]', 'Cause', 'Worst', 'Limit', 'Worst at'
    note = 'A click on a row shows that moment in the charts. The worst one is marked.'
    note += f' The worst {most} of {count} are shown.' if count > most else ''
    return joined(
        element('h3', f'Warnings: {count}'),
        element('p', note + LASTING, class_='muted'),
        table((*heads, 'What to do') if advised else heads, rows, kind='leading sortable'),
    )


def runs_part(case: AxisCase, summary: Summary) -> Iterable[Markup]:
    """Return the runs of a recording that holds several, a row each."""
    if not summary.runs:
        return
    begins = [case.since_first(run.first) if run.first else math.nan for run in summary.runs]
    rows = [
        TableRow(
            (
                TableCell(str(run.number), kind='number', value=run.number),
                TableCell(f'{begin:.2f}' if run.first else NONE, kind='number', value=begin),
                run.words,
            ),
            begin=begin if run.first else None,
            end=begin + run.duration if run.first else None,
        )
        for run, begin in zip(summary.runs, begins, strict=True)
    ]
    yield element('h3', f'Runs: {len(summary.runs)}')
    yield element('p', 'Time begins again with each run, and each is judged apart.')
    yield table(('No.', 'Begins at [s]', 'What it comes to'), rows, kind='leading')


def maps_of(log: LogCase) -> list[OperatingMap]:
    """Return the maps of all axes."""
    return [operating_map(case) for case in log.axes]


def report_page(log: LogCase, maps: Sequence[OperatingMap] | None = None) -> str:
    """Return the page of a recording; its maps may have been made before."""
    maps = maps_of(log) if maps is None else maps
    budgets = axis_budgets(log.axes)
    body = _body(log, maps, budgets)
    bare = _page(log, body, [{'map': plain(chart)} for chart in maps])
    courses = _courses(log, budgets, buckets.PAGE_BYTES - len(bare.encode()))
    records = [
        {'id': _id(number), 'map': plain(chart), 'course': course}
        for number, (chart, course) in enumerate(zip(maps, courses, strict=True))
    ]
    return _page(log, body, records)


def _page(log: LogCase, body: Markup, records: Sequence[Mapping[str, Any]]) -> str:
    data = script_json({'axes': records})
    return page(f'Ball screw report: {log.name}', body, scripts=CHARTS, data=data)


def _courses(log: LogCase, budgets: Sequence[AxisBudget], spare: float) -> list[dict[str, Any]]:
    """Return the courses of all axes, which share what is to spare of the page [bytes]."""
    axes = list(zip(log.axes, budgets, strict=True))
    spare -= sum(time_series.coarse_bytes(*axis) for axis in axes)
    shares = buckets.shares_of_worst(
        spare, log.axes, [time_series.event_bytes(*axis) for axis in axes]
    )
    courses: list[dict[str, Any]] = []
    left = 0.0  # what an axis did not take is for the next one
    for (case, budget), own in zip(axes, shares, strict=True):
        courses.append(time_series.series_record(case, own + left, budget))
        left += own - len(script_json(courses[-1]['fine']))
    return courses


def _body(log: LogCase, maps: Sequence[OperatingMap], budgets: Sequence[AxisBudget]) -> Markup:
    recorded = 'No axis could be judged.'
    if any(math.isnan(case.begins) for case in log.axes):
        span = max(case.survey.span for case in log.axes)
        recorded = f'Recorded over {span:.1f} s, without a date.'
    elif log.axes:
        first = clock_text(min(case.survey.first for case in log.axes)).removesuffix(' UTC')
        last = clock_text(max(case.survey.last for case in log.axes))
        recorded = f'Recorded from {first} to {last}.'
    axes = enumerate(zip(log.axes, maps, budgets, strict=True))
    return element(
        'main',
        element('h1', f'Ball screw report: {log.name}'),
        element('p', recorded, class_='muted'),
        *(verdict_part(verdict) for verdict in verdicts_of(log)),
        *provenance.checks(log.axes),
        *provenance.caution(log.axes),
        *(element('p', f'Note: {note}', class_='hint') for note in log.notes),
        element(
            'noscript', element('p', 'The charts need JavaScript; all else is here without it.')
        ),
        *(_axis_part(_id(number), *axis, log) for number, axis in axes),
    )


def _id(number: int) -> str:
    return f'axis-{number}'


def _axis_part(
    name: str, case: AxisCase, chart: OperatingMap, budget: AxisBudget, log: LogCase
) -> Markup:
    summary = case.outcome.summary()
    known = [] if summary is None else [tiles(case, summary)]
    return element(
        'section',
        element('h2', f'Axis {case.axis}'),
        *known,
        element('h3', f'Operating map at {chart.temperature:g} °C oil'),
        element('div', class_='map'),
        _legend(map_legend(case, chart)),
        *([] if summary is None else [shares(case, summary), *runs_part(case, summary)]),
        events_part(case, budget.events),
        element('h3', 'Course over time'),
        element(
            'p',
            'Drag over a chart to zoom in, double-click to see all. Warnings are shaded.',
            class_='muted screen',
        ),
        element('div', class_='series'),
        _legend([((kind,), text) for kind, text in time_series.BAR_LEGEND]),
        provenance.torque_part(case),
        *([] if case.health is None else [health_chapter(case.health)]),
        provenance.inputs_part(case),
        provenance.gaps_part(case, budget.gaps),
        provenance.assumptions_part(case, log.parameters),
        id=name,
    )


def _legend(entries: Sequence[tuple[tuple[str, ...], str]]) -> Markup:
    items = (element('li', swatch(*sample), text) for sample, text in entries)
    return element('ul', *items, class_='legend')
