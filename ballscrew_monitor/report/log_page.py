# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The report of one recording: a page that a person reads, forwards and prints."""

from collections.abc import Mapping, Sequence
import math
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.recordings.declared import plain
from ballscrew_monitor.report import page_budget, parts, provenance, time_series
from ballscrew_monitor.report.judging import AxisCase, LogCase
from ballscrew_monitor.report.map_record import map_legend, operating_map, OperatingMap
from ballscrew_monitor.report.page import CHARTS, element, Markup, page, script_json, swatch
from ballscrew_monitor.report.page_budget import axis_budgets, AxisBudget
from ballscrew_monitor.report.verdict import verdicts_of


def maps_of(log: LogCase) -> list[OperatingMap]:
    """Return the maps of all axes, as a page has room for them."""
    budgets = axis_budgets(log.axes)
    return [
        operating_map(case, budget.path_points)
        for case, budget in zip(log.axes, budgets, strict=True)
    ]


def report_page(log: LogCase, maps: Sequence[OperatingMap] | None = None) -> str:
    """Return the page of a recording; its maps may have been made before."""
    maps = maps_of(log) if maps is None else maps
    budgets = axis_budgets(log.axes)
    body = _body(log, maps, budgets)
    bare = _page(log, body, [{'map': plain(chart)} for chart in maps])
    courses = _courses(log, budgets, page_budget.PAGE_BYTES - len(bare.encode()))
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
    shares = page_budget.shares_of_worst(
        spare, log.axes, [time_series.event_bytes(*axis) for axis in axes]
    )
    made: list[dict[str, Any]] = []
    left = 0.0  # what an axis did not take is for the next one
    for (case, budget), share in zip(axes, shares, strict=True):
        made.append(time_series.series_record(case, share + left, budget))
        left += share - len(script_json(made[-1]['fine']))
    return made


def _body(log: LogCase, maps: Sequence[OperatingMap], budgets: Sequence[AxisBudget]) -> Markup:
    axes = enumerate(zip(log.axes, maps, budgets, strict=True))
    return element(
        'main',
        element('h1', f'Ball screw report: {log.name}'),
        element('p', _when(log), class_='muted'),
        *(parts.verdict_part(verdict) for verdict in verdicts_of(log)),
        *provenance.caution(log.axes),
        *(element('p', f'Note: {note}', class_='hint') for note in log.notes),
        element(
            'noscript', element('p', 'The charts need JavaScript; all else is here without it.')
        ),
        *(_axis_part(_id(number), *axis, log) for number, axis in axes),
    )


def _id(number: int) -> str:
    return f'axis-{number}'


def _when(log: LogCase) -> str:
    if not log.axes:
        return 'No axis could be judged.'
    first = min(case.survey.first for case in log.axes)
    last = max(case.survey.last for case in log.axes)
    if any(math.isnan(case.begins) for case in log.axes):
        return f'Recorded over {(last - first) * 1e-9:.1f} s, without a date.'
    return f'Recorded from {clock_text(first).removesuffix(" UTC")} to {clock_text(last)}.'


def _axis_part(
    name: str, case: AxisCase, chart: OperatingMap, budget: AxisBudget, log: LogCase
) -> Markup:
    summary = case.outcome.summary()
    known = [] if summary is None else [parts.tiles(case, summary)]
    return element(
        'section',
        element('h2', f'Axis {case.axis}'),
        *known,
        element('h3', f'Operating map at {chart.temperature:g} °C oil'),
        element('div', class_='map'),
        _legend(map_legend(case, chart)),
        *([] if summary is None else [parts.shares(case, summary)]),
        parts.events_part(case, budget.events),
        element('h3', 'Course over time'),
        element(
            'p',
            'Drag over a chart to zoom in, double-click to see all. Warnings are shaded.',
            class_='muted screen',
        ),
        element('div', class_='series'),
        _legend([((kind,), text) for kind, text in time_series.BAR_LEGEND]),
        provenance.torque_part(case),
        provenance.inputs_part(case),
        provenance.gaps_part(case, budget.gaps),
        provenance.assumptions_part(case, log.parameters),
        id=name,
    )


def _legend(entries: Sequence[tuple[tuple[str, ...], str]]) -> Markup:
    items = (element('li', swatch(*sample), text) for sample, text in entries)
    return element('ul', *items, class_='legend')
