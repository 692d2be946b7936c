# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Date of a log whose times count from its begin: by its name, its head or the date of its file.

A date without a time of day is that of midnight, and all are of the universal clock, as no log
states its zone there.

"""

from collections.abc import Iterable, Iterator, Mapping
import contextlib
import dataclasses
import datetime
import itertools
from pathlib import Path
import re
from typing import NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.clocks import either_date, moments_of, order_in_name
from ballscrew_monitor.recordings.tables.estimates import is_universal
from ballscrew_monitor.recordings.tables.heads import Head, Property
from ballscrew_monitor.recordings.tables.layouts import property_of, STARTS
from ballscrew_monitor.recordings.tables.mapping import DATES, TableMap
from ballscrew_monitor.recordings.tables.quantities import DAY, ORDERS, SCALES
from ballscrew_monitor.recordings.tables.sources import Source
import numpy as np
from surrogate.files import InputError

NAME, HEADER, MODIFIED = DATES
FIRST_YEAR = 1971
FIRST = datetime.datetime(FIRST_YEAR, 1, 1, tzinfo=datetime.UTC).timestamp()
ONE_START = 60.0  # [s] within which two lines state the same
HEAD = 1 << 16
"""Bytes of a text in which its date is looked for."""
AFTER = 200
"""Letters after a date within which the time of day stands."""
_SIGN = r'(?P<sign>[-_./]{times})'
_YEAR = r'(?:19|20)\d\d'
DATES_IN_TEXT = (
    rf'(?<!\d)(?P<one>{_YEAR}){_SIGN}(?P<two>\d\d)(?P=sign)(?P<three>\d\d)',
    rf'(?<!\d)(?P<one>\d\d){_SIGN}(?P<two>\d\d)(?P=sign)(?P<three>{_YEAR})',
)
"""Dates in numbers, of which the first has but one order."""
SHORT_DATE = rf'(?<!\d)(?P<one>\d\d){_SIGN}(?P<two>\d\d)(?P=sign)(?P<three>\d\d)'
_TIME = r'(?P<hour>\d\d)(?P<colon>[-:._h]?)(?P<minute>\d\d)(?:[-:._m]?(?P<second>\d\d))?(?!\d)'
IN_NAME = tuple(
    re.compile(each.replace('{times}', '?') + rf'(?:[T _-]*{_TIME}|(?!\d))')
    for each in DATES_IN_TEXT
)
SHORT_IN_NAME = (
    re.compile(SHORT_DATE.replace('{times}', '') + rf'(?:[T _-]+{_TIME}|(?![-_.]?\d))'),
    re.compile(SHORT_DATE.replace('{times}', '{0}') + r'[T_-](?=\d{6}(?!\d))' + _TIME),
)
"""Dates with a year of two digits, which a name may hold; without signs only before a time."""
IN_HEAD = tuple(re.compile(each.replace('{times}', '') + r'(?!\d)') for each in DATES_IN_TEXT)
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
    When a log begins by its head or a name: the `text` that says so, in the row of a head.

    `moments` [s since 1970] are by the order of the date, of which several may be possible. Of
    starts that contradict each other, `doubt` says which. A `bare` date has no time of day.

    """

    text: str = ''
    row: int = 0
    moments: Mapping[str, float] = {}
    doubt: str = ''
    bare: bool = False

    def by(self, order: str = '') -> float | None:
        """Return the moment by an order, or the only one; None for none or several."""
        several = len({*self.moments.values()}) > 1
        return self.moments.get(order) if several else next(iter(self.moments.values()), None)

    def is_near(self, other: 'Start') -> bool:
        """Return True if another start may be the same."""
        pairs = itertools.product(self.moments.values(), other.moments.values())
        return any(abs(one - each) < ONE_START for one, each in pairs)

    def open(self, of: str = '') -> str:
        """Return in words what is not known of it and which key decides, empty if all is."""
        if self.doubt:
            return f'{self.doubt}: state time.epoch in the map'
        if self.by() is not None or not self.moments:
            return ''
        what = f'the date {self.text} in the name of the {of}' if of else f'the start {self.text}'
        line = '' if of else f' in line {self.row}'
        return f'{what}{line} may be {either_date(self.moments)} in the map'


def start_in_head(head: Head) -> Start:
    """
    Return the start that the head of a log states.

    What names the start itself comes before a date, and that before when a file was written. A
    date and a time of a day of one kind belong together, as do the time of a start and a date.

    """
    found: dict[tuple[str, str], list[Start]] = {}
    for one in head.dates:
        kind, start = _stated(one)
        what = property_of(one.label)
        if start.moments:
            what = 'date' if what == 'clock' and kind != 'hours' else what
            found.setdefault((what, kind), []).append(start)
    clocks = found.get(('clock', 'hours'), [])
    for what in STARTS:
        moments, days, hours = (found.get((what, kind), []) for kind in ('moment', 'day', 'hours'))
        if hours and not moments and not days and what == STARTS[0]:
            days = [one for kind in ('moment', 'day') for one in found.get(('date', kind), [])]
            if not days and (saved := found.get(('saved', 'moment'), found.get(('saved', 'day')))):
                return Start(
                    doubt=f'line {hours[0].row} states when it begins without a date, '
                    f'{hours[0].text}, and line {saved[0].row} when it was written, '
                    f'{saved[0].text}'
                )
        hours = hours or clocks[:1]
        starts = moments + [_with_time(day, hour) for day in days for hour in hours]
        starts = starts or [day._replace(bare=True) for day in days]
        differing = [one for one in starts if not starts[0].is_near(one)]
        if differing:
            told = ' and '.join(f'line {one.row}: {one.text}' for one in (starts[0], differing[0]))
            return Start(doubt=f'its head states two starts, {told}')
        if starts:
            return starts[0]
    return Start()


def _stated(one: Property) -> tuple[str, Start]:
    """Return what a line of a head states: a moment, a day or the time of a day, and that."""
    if one.text.isdigit() and is_universal(np.array([float(one.text)]), 'filetime'):
        scale, offset = SCALES['filetime']
        return 'moment', Start(one.text, one.row, {'': float(one.text) * scale + offset})
    for text in (one.text, re.split(',', one.text)[0]):  # another cell may follow
        found = moments_of(text)
        for kind in ('moment', 'day', 'hours'):
            moments = {form.order: moment for moment, form in found if form.kind == kind}
            order = order_in_name(one.label)
            if moments:
                named = {order: moments[order]} if order in moments else moments
                return kind, Start(text, one.row, named)
    return '', Start()


def _with_time(day: Start, hours: Start) -> Start:
    """Return the day of a start with the time of a day."""
    (time,) = {*hours.moments.values()}
    moments = {order: moment - moment % DAY + time for order, moment in day.moments.items()}
    return Start(f'{day.text} {hours.text}', day.row, moments)


def _by_head(log: Source, mapping: TableMap) -> datetime.datetime | None:
    """Return when a log begins by the start that its head states, else by a date in it."""
    start = start_in_head(log.head)
    if not start.moments and not start.doubt:
        start = _date_in_text(_head(log.path))
    return _moment_by(start, log.path, mapping)


def _by_name(path: Path, mapping: TableMap) -> datetime.datetime | None:
    """Return the date that the name of a log or of its folder holds."""
    for start, of in dates_by_name(path):
        return _moment_by(start, path, mapping, of)
    return None


def _moment_by(
    start: Start, path: Path, mapping: TableMap, of: str = ''
) -> datetime.datetime | None:
    """Return the moment of a start by a map; raises InputError for one that may be another."""
    moment = start.by(mapping.order)
    if moment is None and (doubt := start.open(of)):
        if not of and start.moments:  # the same words for each log of a batch
            orders = ' or '.join(
                f'time: {{order: {one}}}' for one in ORDERS if one in start.moments
            )
            doubt = (
                f'the start in line {start.row} may be of several dates: state {orders} in the map'
            )
        raise InputError(f'log {path}: {doubt}')
    return None if moment is None else datetime.datetime.fromtimestamp(moment, datetime.UTC)


def _known(moment: datetime.datetime | None, path: Path, reason: str) -> datetime.datetime:
    if moment is None:
        raise InputError(
            f'log {path}: date_from asks for a date and {reason}, such as 2025-07-14, '
            '20250714_115950 or 14.07.2025: state another date_from, or time.epoch'
        )
    return moment


def dates_by_name(path: Path) -> Iterator[tuple[Start, str]]:
    """
    Yield the dates in the names of the file and of its folder, and of which of them each is.

    One whose year has two digits counts only if no name holds one of four.

    """
    names = ((path.stem, 'file'), (path.absolute().parent.name, 'folder'))
    for patterns in (IN_NAME, SHORT_IN_NAME):
        dates = [(_first_date(name, patterns), of) for name, of in names]
        dates = [(date, of) for date, of in dates if date.moments]
        yield from dates
        if dates:
            return


def date_in_name(name: str, order: str = '') -> datetime.datetime | None:
    """
    Return the first date in a name, with the time of day if it follows, None for none.

    It is None as well where several orders of the date are possible, and `order` states no one.

    """
    moment = _first_date(name, IN_NAME).by(order)
    return None if moment is None else datetime.datetime.fromtimestamp(moment, datetime.UTC)


def _first_date(name: str, patterns: Iterable[re.Pattern[str]]) -> Start:
    for pattern in patterns:
        for match in pattern.finditer(name):
            if moments := _moments(match, match):
                return Start(match[0], moments=moments)
    return Start()


def _date_in_text(text: str) -> Start:
    """Return the first date in the head of a text, with the time of day that stands after it."""
    dates = [
        (match.start(), Start(match[0], text.count('\n', 0, match.start()) + 1, moments))
        for pattern in IN_HEAD
        for match in pattern.finditer(text)
        if (moments := _moments(match, TIME_OF_DAY.search(text, match.end(), match.end() + AFTER)))
    ]
    return min(dates, key=lambda one: one[0])[1] if dates else Start()


def _moments(date: re.Match[str], time: re.Match[str] | None) -> dict[str, float]:
    """Return the moments [s since 1970] of date and time of day by the orders they may have."""
    parts = [date[name] for name in ('one', 'two', 'three')]
    hour, minute, second = (
        0 if time is None else int(time[name] or 0) for name in ('hour', 'minute', 'second')
    )
    long = [at for at, part in enumerate(parts) if len(part) > 2]
    orders = [order for order in ORDERS if not long or order[long[0]] == 'y']
    if date['sign'] == '.':  # of which the month is never the first
        orders = [order for order in orders if order != 'mdy']
    moments = {}
    for order in orders:
        year, month, day = (int(parts[order.index(letter)]) for letter in 'ymd')
        year += 0 if long else 2000 if year < 70 else 1900
        with contextlib.suppress(ValueError):
            at = datetime.datetime(year, month, day, hour, minute, second, tzinfo=datetime.UTC)
            moments[order] = at.timestamp()
    return moments


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
