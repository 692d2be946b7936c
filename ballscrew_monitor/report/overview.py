# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page over many recordings: a row for each axis of each, and how an axis does over dates."""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import datetime
import math
from urllib.parse import quote

from ballscrew_monitor.health.records import Health
from ballscrew_monitor.recordings.words import counted, duration, NONE, percent
from ballscrew_monitor.report.health_history import by_axis, healths, peers_among
from ballscrew_monitor.report.health_part import health_trends, peers_table, verdict_box
from ballscrew_monitor.report.log_report import AxisLine, LogResult
from ballscrew_monitor.report.logs import PAGE
from ballscrew_monitor.report.machines import axis_titles, folders_note, MachineAxis
from ballscrew_monitor.report.page import element, Markup, page, table, TableCell, TableRow
from ballscrew_monitor.report.trend import Mark, trend

SCRIPTS = ('format.js', 'table.js', 'overview.js')
MARKS = {
    'good': 'optimal',
    'bad': 'outside',
    'perhaps': 'perhaps',
    'usual': 'unjudged',
    'unknown': 'unjudged',
}


Listed = tuple[LogResult, AxisLine]
Titles = Mapping[MachineAxis, str]
"""Names of axes, with their machine where several have one of that name."""
Courses = Mapping[MachineAxis, Sequence[Health]]
"""The health after each recording of an axis that has several."""


def overview_page(
    entries: Sequence[LogResult],
    notes: Sequence[str] = (),
    *,
    title: str = '',
    parts: Sequence[Markup] = (),
) -> str:
    """
    Return the page over recordings, with sentences about what is not among them.

    `parts` come below the verdict; the page bears a `title` of its own, if any.

    """
    courses = _courses(entries)
    entries = _with_usual(entries, courses)
    listed = [(entry, line) for entry in entries for line in entry.lines]
    listed.sort(key=lambda pair: -math.inf if math.isnan(pair[1].begins) else pair[1].begins)
    axes = [line.key for _, line in listed]
    titles = axis_titles(axes)
    bad = [entry for entry in entries if entry.failure]
    failures = (element('li', element('b', entry.name), f': {entry.failure}') for entry in bad)
    first, trends = _health(entries, courses, titles)
    notes = [*notes, *filter(None, [folders_note(axes)])]
    body = element(
        'main',
        element('h1', title or f'Ball screw reports: {counted(len(entries), "recording")}'),
        *first,
        _verdict(entries, listed),
        *(element('p', f'{note[:1].upper()}{note[1:]}.') for note in notes),
        *parts,
        *([element('h2', 'Recordings that could not be read')] if bad else []),
        *([element('ul', *failures)] if bad else []),
        *([element('h2', 'Normal or worse, over dates')] if trends else []),
        *trends,
        *_trends(listed, titles),
        element('h2', 'Recordings'),
        table(
            (
                'Verdict',
                'Recording',
                'Axis',
                'Begins (UTC)',
                'Recorded',
                'Judged',
                'In motion',
                'Surely outside [%]',
                'Outside [%]',
                'Warnings',
                'Worst warning',
            ),
            (_row(entry, line, titles[line.key]) for entry, line in listed),
            kind='sortable verdicts',
        ),
    )
    return page('Ball screw reports', body, scripts=SCRIPTS)


def with_usual(entries: Sequence[LogResult]) -> list[LogResult]:
    """Return recordings with those warnings counted that the baselines of their axes had."""
    return _with_usual(entries, _courses(entries))


def _with_usual(entries: Sequence[LogResult], courses: Courses) -> list[LogResult]:
    known = {axis: course[-1].usual_warnings for axis, course in courses.items()}
    return [
        dataclasses.replace(
            entry, lines=[line.with_usual(known.get(line.key, ())) for line in entry.lines]
        )
        for entry in entries
    ]


def _courses(entries: Sequence[LogResult]) -> Courses:
    titles = axis_titles([line.key for entry in entries for line in entry.lines])
    histories = by_axis([history for entry in entries for history in entry.histories])
    return {
        axis: healths(own, title=titles[axis]) for axis, own in histories.items() if len(own) > 1
    }


def _health(
    entries: Sequence[LogResult], courses: Courses, titles: Titles
) -> tuple[list[Markup], list[Markup]]:
    peers = peers_among([history for entry in entries for history in entry.histories], titles)
    first = [verdict_box(course[-1]) for course in courses.values()]
    first += [element('p', peer.text, class_='hint') for peer in peers if peer.is_apart]
    trends = [drawn for course in courses.values() for drawn in health_trends(course)]
    return first, [*trends, *peers_table(peers)]


def _verdict(entries: Sequence[LogResult], listed: Sequence[Listed]) -> Markup:
    counts = dict.fromkeys(MARKS, 0)
    for _, line in listed:
        counts[line.standing] += 1
    lost = sum(bool(entry.failure) for entry in entries)
    sentence = (
        f'{counts["bad"]} of {len(listed)} axis recordings ran outside the optimal zone, '
        f'{counts["perhaps"]} perhaps, '
        + (f'{counts["usual"]} as usual for their axis, ' if counts['usual'] else '')
        + f'{counts["good"]} were good, {counts["unknown"]} could not be judged'
    )
    sentence += f'; {counted(lost, "recording")} could not be read.' if lost else '.'
    worst = {**counts, 'unknown': counts['unknown'] + lost}
    kind = next((kind for kind in MARKS if kind != 'good' and worst[kind]), 'good')
    return element('div', element('p', sentence, class_='sentence'), class_=f'verdict {kind}')


def _row(entry: LogResult, line: AxisLine, title: str) -> TableRow:
    sure, part = (
        time / line.running_time if line.running_time else math.nan
        for time in (line.surely_outside, line.outside_time)
    )
    link = element('a', entry.name, href=f'{quote(entry.folder)}/{PAGE}')
    return TableRow(
        (
            TableCell(text=element('span', line.tag, class_=f'tag {line.standing}'), kind='short'),
            TableCell(link, kind='place'),
            title,
            TableCell(_date(line.begins), kind='short'),
            _time(line.recorded),
            TableCell(f'{line.judged} of {line.expected}', kind='short', value=line.judged),
            _time(line.running_time),
            TableCell(percent(sure).removesuffix(' %'), kind='number', value=sure),
            TableCell(percent(part).removesuffix(' %'), kind='number', value=part),
            TableCell(_warnings(line), kind='short', value=line.warnings),
            TableCell(line.worst or NONE, kind='short', value=line.depth),
        ),
        kind=line.standing if line.standing in ('bad', 'usual') else '',
    )


def _warnings(line: AxisLine) -> str:
    """Return how many warnings there were, and how many of them are usual."""
    return f'{line.warnings}, usual {line.usual}' if line.usual else str(line.warnings)


def _time(seconds: float) -> TableCell:
    return TableCell(duration(seconds), kind='short', value=seconds)


def _date(begins: float) -> str:
    if math.isnan(begins):
        return NONE
    moment = datetime.datetime.fromtimestamp(begins, tz=datetime.UTC)
    return f'{moment:%Y-%m-%d %H:%M}'


def _trends(listed: Sequence[Listed], titles: Titles) -> Iterable[Markup]:
    """Yield how each axis with a date in at least two recordings did over them."""
    pictures = []
    for axis in dict.fromkeys(line.key for _, line in listed):
        own = [pair for pair in listed if pair[1].key == axis]
        marks = []
        for entry, line in own:
            if math.isfinite(line.begins + line.outside_time) and line.running_time > 0.0:
                part = line.outside_time / line.running_time
                mark = Mark(
                    at=line.begins,
                    value=part,
                    kind=MARKS[line.standing],
                    title=f'{entry.name}, {_date(line.begins)}: {percent(part)} outside',
                    link=f'{quote(entry.folder)}/{PAGE}',
                )
                marks.append(mark)
        if drawn := trend(marks):
            times = (line.running_time for _, line in own if math.isfinite(line.running_time))
            most = max(mark.value for mark in marks)
            text = f'{duration(math.fsum(times))} in motion; the highest point is {percent(most)}.'
            pictures += [element('h3', f'Axis {titles[axis]}'), drawn]
            pictures.append(element('p', text, class_='muted'))
    if pictures:
        yield element('h2', 'Share of the motion outside the optimal zone, over dates')
        yield from pictures
