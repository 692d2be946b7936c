# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page over many recordings: a row for each axis of each, and how an axis does over dates."""

from collections.abc import Iterable, Sequence
import dataclasses
import datetime
import math
from urllib.parse import quote

from ballscrew_monitor.health.records import Condition
from ballscrew_monitor.recordings.words import counted, duration, NONE, percent
from ballscrew_monitor.report.health_history import healths, read_history
from ballscrew_monitor.report.log_report import AxisLine, LogResult
from ballscrew_monitor.report.logs import PAGE
from ballscrew_monitor.report.page import element, joined, Markup, page, table, TableCell, TableRow

SCRIPTS = ('format.js', 'table.js', 'overview.js')
WIDTH, HEIGHT, EDGE = 720.0, 110.0, 8.0  # of the picture of a trend [px]
CONDITIONS = {Condition.NORMAL: 'good', Condition.WORSE: 'bad', Condition.UNKNOWN: 'unknown'}
MARKS = {'good': 'optimal', 'bad': 'outside', 'unknown': 'unjudged'}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogEntry:
    """A recording and its folder, with what became of it: a result, or why there is none."""

    name: str
    folder: str
    result: LogResult | None = None
    failure: str = ''

    @property
    def is_bad(self) -> bool:
        """Tell whether nothing was judged on any axis."""
        return self.result is None or not self.result.judged


Listed = tuple[LogEntry, AxisLine]


def overview_page(entries: Sequence[LogEntry], notes: Sequence[str] = ()) -> str:
    """Return the page over recordings, with sentences about what is not among them."""
    listed = [(one, line) for one in entries if one.result for line in one.result.lines]
    listed.sort(key=lambda pair: -math.inf if math.isnan(pair[1].begins) else pair[1].begins)
    bad = [one for one in entries if one.result is None]
    body = element(
        'main',
        element('h1', f'Ball screw reports: {counted(len(entries), "recording")}'),
        *_healths(entries),
        _verdict(entries, listed),
        *(element('p', f'{note[:1].upper()}{note[1:]}.') for note in notes),
        *_failures(bad),
        *_trends(listed),
        element('h2', 'Recordings'),
        table(
            (
                'Recording',
                'Axis',
                'Verdict',
                'Begins (UTC)',
                'Recorded',
                'In motion',
                'Outside [%]',
                'Warnings',
                'Worst warning',
            ),
            (_row(one, line) for one, line in listed),
            kind='sortable',
        ),
    )
    return page('Ball screw reports', body, scripts=SCRIPTS)


def _healths(entries: Sequence[LogEntry]) -> Iterable[Markup]:
    """Yield a sentence for each axis with several recordings: is it normal or worse, and why."""
    found = [
        read_history(one) for entry in entries if entry.result for one in entry.result.histories
    ]
    for axis in dict.fromkeys(one.axis for one in found):
        own = [one for one in found if one.axis == axis]
        if len(own) > 1:
            *_, last = healths(own)
            text = (
                f'{last.verdict} {last.advice[:1].upper()}{last.advice[1:]}.'
                if last.advice
                else last.verdict
            )
            kind = CONDITIONS[last.condition]
            yield element('div', element('p', text, class_='sentence'), class_=f'verdict {kind}')


def _verdict(entries: Sequence[LogEntry], listed: Sequence[Listed]) -> Markup:
    counts = dict.fromkeys(MARKS, 0)
    for _, line in listed:
        counts[line.standing] += 1
    lost = sum(one.result is None for one in entries)
    sentence = (
        f'{counts["bad"]} of {len(listed)} axis recordings ran outside the optimal zone with '
        f'warnings, {counts["good"]} were good, {counts["unknown"]} could not be judged'
    )
    sentence += f'; {counted(lost, "recording")} could not be read.' if lost else '.'
    kind = 'bad' if counts['bad'] else 'unknown' if counts['unknown'] or lost else 'good'
    return element('div', element('p', sentence, class_='sentence'), class_=f'verdict {kind}')


def _failures(bad: Sequence[LogEntry]) -> Iterable[Markup]:
    if bad:
        yield element('h2', 'Recordings that could not be read')
        items = (element('li', element('b', one.name), f': {one.failure}') for one in bad)
        yield element('ul', *items)


def _row(one: LogEntry, line: AxisLine) -> TableRow:
    part = line.outside_time / line.running_time if line.running_time else math.nan
    link = element('a', one.name, href=f'{quote(one.folder)}/{PAGE}')
    return TableRow(
        (
            TableCell(link, kind='place'),
            line.axis,
            TableCell(
                text=element(
                    'span', line.verdict.partition(':')[0], class_=f'tag {line.standing}'
                ),
                kind='short',
            ),
            TableCell(_date(line.begins), kind='short'),
            _time(line.recorded),
            _time(line.running_time),
            TableCell(percent(part).removesuffix(' %'), kind='number', value=part),
            TableCell(str(line.warnings), kind='short', value=line.warnings),
            TableCell(line.worst or NONE, kind='short', value=line.depth),
        ),
        kind='bad' if line.standing == 'bad' else '',
    )


def _time(seconds: float) -> TableCell:
    return TableCell(duration(seconds), kind='short', value=seconds)


def _date(begins: float) -> str:
    if math.isnan(begins):
        return NONE
    moment = datetime.datetime.fromtimestamp(begins, tz=datetime.UTC)
    return f'{moment:%Y-%m-%d %H:%M}'


def _trends(listed: Sequence[Listed]) -> Iterable[Markup]:
    """Yield how each axis with a date in at least two recordings did over them."""
    axes = dict.fromkeys(line.axis for _, line in listed)
    pictures = [_trend(axis, [pair for pair in listed if pair[1].axis == axis]) for axis in axes]
    if any(pictures):
        yield element('h2', 'Share of the motion outside the optimal zone, over dates')
        yield from filter(None, pictures)


def _trend(axis: str, listed: Sequence[Listed]) -> Markup:
    points = [
        (line.begins, line.outside_time / line.running_time, one, line)
        for one, line in listed
        if math.isfinite(line.begins + line.outside_time) and line.running_time > 0.0
    ]
    if len(points) < 2 or points[0][0] == points[-1][0]:
        return Markup()
    most = max(point[1] for point in points) or 0.01
    first, last = points[0][0], points[-1][0]
    marks = []
    places = []
    for begins, part, one, line in points:
        x = EDGE + (WIDTH - 2 * EDGE) * (begins - first) / (last - first)
        y = HEIGHT - EDGE - (HEIGHT - 2 * EDGE) * part / most
        places.append(f'{x:.1f},{y:.1f}')
        marks.append(_mark(x, y, one, line, part))
    drawn = element(
        'svg',
        element('polyline', points=' '.join(places), class_='line-trend'),
        *marks,
        class_='trend',
        viewBox=f'0 0 {WIDTH:g} {HEIGHT:g}',
        role='img',
    )
    span = f'{_date(first)} to {_date(last)}'
    total = math.fsum(line.running_time for _, _, _, line in points)
    text = f'{span}, {duration(total)} in motion; the highest point is {percent(most)}.'
    return joined(element('h3', f'Axis {axis}'), drawn, element('p', text, class_='muted'))


def _mark(x: float, y: float, one: LogEntry, line: AxisLine, part: float) -> Markup:
    title = element('title', f'{one.name}, {_date(line.begins)}: {percent(part)} outside')
    dot = element(
        'circle', title, cx=f'{x:.1f}', cy=f'{y:.1f}', r='4', class_=f'fill-{MARKS[line.standing]}'
    )
    return element('a', dot, href=f'{quote(one.folder)}/{PAGE}')
