# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Date of a log whose times count from its begin: by its name, its head or the date of its file.

A date without a time of day is that of midnight, and all are of the universal clock, as no log
states its zone there.

"""

from collections.abc import Iterator, Mapping
import dataclasses
import datetime
from pathlib import Path
import re
from typing import NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.clocks import moments_of
from ballscrew_monitor.recordings.tables.estimates import is_universal
from ballscrew_monitor.recordings.tables.heads import Head
from ballscrew_monitor.recordings.tables.mapping import DATES, TableMap
from ballscrew_monitor.recordings.tables.quantities import SCALES
from ballscrew_monitor.recordings.tables.sources import Source
import numpy as np
from surrogate.files import InputError

NAME, HEADER, MODIFIED = DATES
FIRST_YEAR = 1971
HEAD = 1 << 16
"""Bytes of a text in which its date is looked for."""
AFTER = 200
"""Letters after a date within which the time of day stands."""
_DAY = (
    r'(?<!\d)(?:(?P<year>(?:19|20)\d\d)(?P<sign>[-_./]{optional})(?P<month>\d\d)(?P=sign)'
    r'(?P<day>\d\d)|(?P<day_first>\d\d)(?P<dot>[-_.])(?P<month_second>\d\d)(?P=dot)'
    r'(?P<year_last>(?:19|20)\d\d))'
)
_TIME = r'(?P<hour>\d\d)(?P<colon>[-:._h]?)(?P<minute>\d\d)(?:[-:._m]?(?P<second>\d\d))?(?!\d)'
IN_NAME = re.compile(_DAY.replace('{optional}', '?') + rf'(?:[T _-]*{_TIME}|(?!\d))')
IN_HEAD = re.compile(_DAY.replace('{optional}', '') + r'(?!\d)')
TIME_OF_DAY = re.compile(r'(?<![\d:])(?P<hour>\d{1,2}):(?P<minute>\d\d)(?::(?P<second>\d\d))?')
TEXTS = ('.csv', '.txt', '.tsv', '.log', '.dat')


def dated(log: Source, mapping: TableMap) -> TableMap:
    """
    Return a map whose epoch is the date of the log, if that is where the map says so.

    Raises InputError where no date stands there.

    """
    if not mapping.date_from:
        return mapping
    path = log.path
    if mapping.date_from == MODIFIED:
        moment = datetime.datetime.fromtimestamp(int(path.stat().st_mtime), datetime.UTC)
    elif mapping.date_from == HEADER:
        moment = _known(_by_head(log, mapping), path, 'the lines above its table state none')
    else:
        name = _by_name(path, mapping)
        moment = _known(name, path, 'neither its name nor that of its folder holds one')
    if moment.year < FIRST_YEAR:
        raise InputError(
            f'log {path}: date_from {mapping.date_from} says {moment:%Y}, allowed is {FIRST_YEAR} '
            'or later'
        )
    return dataclasses.replace(mapping, epoch=round(moment.timestamp() * 1e6) * SECOND // 10**6)


class Start(NamedTuple):
    """
    When a log begins by its head, and the `text` and row that say so.

    `moments` [s since 1970] are by the order of day and month, of which both may be possible.

    """

    text: str = ''
    row: int = 0
    moments: Mapping[str, float] = {}

    @property
    def known(self) -> float | None:
        """Return the only moment, None for none or two."""
        return next(iter(self.moments.values())) if len({*self.moments.values()}) == 1 else None


def start_in_head(head: Head) -> Start:
    """Return the start that the head of a log states."""
    if 'start' not in head.properties:
        return Start()
    text, row = head.properties['start'].text, head.properties['start'].row
    clock = f' {head.properties["clock"].text}' if 'clock' in head.properties else ''
    if text.isdigit() and is_universal(np.array([float(text)]), 'filetime'):
        scale, offset = SCALES['filetime']
        return Start(text, row, {'': float(text) * scale + offset})
    for each in (text + clock, text):
        moments = [
            (form.order, moment) for moment, form in moments_of(each) if form.kind != 'hours'
        ]
        if moments:
            return Start(each, row, dict(moments))
    return Start()


def _by_head(log: Source, mapping: TableMap) -> datetime.datetime | None:
    """Return when a log begins by the start that its head states, else by a date in it."""
    start = start_in_head(log.head)
    moment = start.moments.get(mapping.order, start.known)
    if moment is not None:
        return datetime.datetime.fromtimestamp(moment, datetime.UTC)
    if start.moments:
        raise InputError(
            f'log {log.path}: the start in line {start.row} may be of either order of '
            'day and month: state time: {order: dmy} or mdy in the map'
        )
    return date_in_head(_head(log.path))


def _by_name(path: Path, mapping: TableMap) -> datetime.datetime | None:
    """Return the date that the name of a log or of its folder holds."""
    for moment, text, of in dates_by_name(path, mapping.order):
        if moment is None:
            raise InputError(
                f'log {path}: the date {text} in the name of the {of} may be of either order of '
                'day and month: state time: {order: dmy} or mdy in the map'
            )
        return moment
    return None


def _known(moment: datetime.datetime | None, path: Path, reason: str) -> datetime.datetime:
    if moment is None:
        raise InputError(
            f'log {path}: date_from asks for a date and {reason}, such as 2025-07-14, '
            '20250714_115950 or 14.07.2025: state another date_from, or time.epoch'
        )
    return moment


def dates_by_name(
    path: Path, order: str = ''
) -> Iterator[tuple[datetime.datetime | None, str, str]]:
    """
    Yield the dates in the names of the file and of its folder, each as it stands, and of which.

    A date is None where its day and month may be of either order, and `order` does not say it.

    """
    for name, of in ((path.stem, 'file'), (path.absolute().parent.name, 'folder')):
        if (match := _first_date(name)) is not None:
            yield _in_order(match, order), match[0], of


def date_in_name(name: str, order: str = '') -> datetime.datetime | None:
    """
    Return the first date in a name, with the time of day if it follows, None for none.

    It is None as well where day and month may be of either order, and `order` does not say it.

    """
    match = _first_date(name)
    return None if match is None else _in_order(match, order)


def _first_date(name: str) -> re.Match[str] | None:
    return next((match for match in IN_NAME.finditer(name) if _moment(match, match)), None)


def _in_order(match: re.Match[str], order: str) -> datetime.datetime | None:
    """Return the moment of a date in a name by an order; with dots its day is the first."""
    moment, first, second = _moment(match, match), match['day_first'], match['month_second']
    if moment is None or not first or match['dot'] == '.' or first == second or int(first) > 12:
        return moment
    return {'dmy': moment, 'mdy': moment.replace(day=moment.month, month=moment.day)}.get(order)


def date_in_head(text: str) -> datetime.datetime | None:
    """Return the first date in the head of a text, with the time of day that stands after it."""
    for match in IN_HEAD.finditer(text):
        end = match.end() + AFTER
        time = TIME_OF_DAY.search(text, match.end(), end)
        moment = _moment(match, time)
        if moment is not None:
            return moment
    return None


def _moment(date: re.Match[str], time: re.Match[str] | None) -> datetime.datetime | None:
    """Return date and time of day that texts hold, None for such as no calendar has."""
    year, month, day = (
        int(date[name] or date[other])
        for name, other in (('year', 'year_last'), ('month', 'month_second'), ('day', 'day_first'))
    )
    parts = ('hour', 'minute', 'second')
    hour, minute, second = (0 if time is None else int(time[name] or 0) for name in parts)
    try:
        return datetime.datetime(year, month, day, hour, minute, second, tzinfo=datetime.UTC)
    except ValueError:
        return None


def _head(path: Path) -> str:
    if path.suffix.lower() not in TEXTS:
        raise InputError(
            f'log {path}: date_from header is for texts such as CSV, allowed here are name and '
            'modified'
        )
    with path.open('rb') as stream:
        content = stream.read(HEAD)
    if content[:2] in (b'\xff\xfe', b'\xfe\xff'):
        return content.decode('utf-16', 'replace')
    return content.decode('latin-1')
