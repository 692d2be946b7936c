# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Times as tables write them: texts of dates and hours, and numbers that count from an epoch.

Each date, time of day and epoch is an entry of a table. A date in numbers that may be of several
orders is an entry each, and all cells decide between them.

"""

from collections.abc import Iterable, Iterator, Mapping
import dataclasses
import datetime as dt
import functools
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.quantities import DAY, ORDERS
import polars as pl

KNOWN = (631_152_000.0, 4_102_444_800.0)  # [s] of the universal clock: 1990 to 2100
DATES = (
    ('', '%Y-%m-%d'),
    ('', '%Y/%m/%d'),
    ('', '%Y.%m.%d'),
    ('', '%Y%m%d'),
    ('', '%d.%m.%Y'),
    ('dmy', '%d.%m.%y'),
    ('ymd', '%y.%m.%d'),
    ('dmy', '%d/%m/%Y'),
    ('mdy', '%m/%d/%Y'),
    ('dmy', '%d-%m-%Y'),
    ('mdy', '%m-%d-%Y'),
    ('dmy', '%d/%m/%y'),
    ('mdy', '%m/%d/%y'),
    ('ymd', '%y/%m/%d'),
    ('dmy', '%d-%m-%y'),
    ('mdy', '%m-%d-%y'),
    ('ymd', '%y-%m-%d'),
    ('', '%d-%B-%Y'),
    ('', '%d-%B-%y'),
    ('', '%d %B %Y'),
    ('', '%d. %B %Y'),
    ('', '%B %d %Y'),
    ('', '%Y-%B-%d'),
    ('', '%Y %B %d'),
)
"""Dates, with the order of year, month and day where another one is possible as well."""
HOURS = (
    '%H:%M:%S%.f',
    '%I:%M:%S%.f %p',
    '%H:%M:%S%.f%z',
    '%H:%M:%S%.f %z',
    '%H:%M',
    '%I:%M %p',
    '%H%M%S%.f',
)
"""Times of a day; the last one stands behind a date alone."""
LATE_HOURS = r'^\s*(2[4-9]|[3-9]\d|[1-9]\d\d):\d\d:\d\d'
"""Hours of a clock that goes on after midnight, and of one that counts from a begin."""
MINUTES = '%M:%S.%f'
"""Minutes and seconds of an hour, as a spreadsheet shows a time in tenths of seconds."""
MONTHS = (
    (r'(?i)\bj(?:an|än|aen)(?:uar|ner)?\b', 'Jan'),
    (r'(?i)\bfebruar\b', 'Feb'),
    (r'(?i)\bm(?:(?:ä|ae|a\x{308})rz?|rz)\b', 'Mar'),
    (r'(?i)\bmai\b', 'May'),
    (r'(?i)\bjuni\b', 'Jun'),
    (r'(?i)\bjuli\b', 'Jul'),
    (r'(?i)\bsept\b', 'Sep'),
    (r'(?i)\bokt(?:ober)?\b', 'Oct'),
    (r'(?i)\bdez(?:ember)?\b', 'Dec'),
)
"""German names of months that differ from the English ones."""
MILLISECONDS = (
    (r'(\d:\d\d:\d\d\.)0(\d{3})(\D|$)', '$1$2$3'),
    (r'(\d:\d\d:\d\d\.)00(\d{3,})', '$1$2'),
)
"""
What follows a colon behind the seconds is a whole number of them, be it of fewer digits.

Trends of Rockwell write a semicolon there.

"""
STEPS = (
    (r'^\s+|\s+$', ''),
    (r'(?i)^(?:mon|tue|wed|thu|fri|sat|sun|mo|di|mi|do|fr|sa|so)[a-z]*\.?,? +', ''),
    (r'(\d)T(\d)', '$1 $2'),
    (r'(?i)\s*(?:Z|UTC|GMT)$', ''),
    (r'^(\p{L}{3} +\d{1,2}) +(\d\d:\d\d:\d\d) +(\d{4})$', '$1 $3 $2'),
    (r'(\d:\d\d),(\d)', '$1.$2'),
    (r'(\d:\d\d:\d\d)[:;](\d)', '$1.00$2'),
    *MILLISECONDS,
    (r'(?i)\s*\b?([ap])\.? ?m\.?$', ' ${1}m'),
    (r'(\d\.)([\p{L}\p{M}]{3})', '$1 $2'),
    (r'([\p{L}\p{M}]{3,})\.(\d)', '$1 $2'),
    (r'([\p{L}\p{M}]{3,})\.', '$1'),
    (r'(\d)[-_](\d\d?:)', '$1 $2'),
    (r'[,\s_]+', ' '),
)
"""What is replaced in a text before its form is looked for, each only where it occurs."""
LONGEST_TIME = 64
"""Letters of the longest text that is taken for a time."""
PART = '([dty]{1,4}|[jm]{1,4})'
ORDER_IN_NAME = re.compile(rf'(?<![^\W\d_]){PART}[-/. ]+{PART}[-/. ]+{PART}(?![^\W\d_])', re.I)
"""A date by its parts, as yy/mm/dd or TT.MM.JJJJ."""
LETTERS = {'d': 'd', 't': 'd', 'm': 'm', 'y': 'y', 'j': 'y'}
"""Parts of a date by the letters of English and German."""
SAMPLE = 60  # cells by which the forms of a column are found


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class TimeForm:
    """
    A form of times: its pattern, and the order of its date where there is another one.

    `steps` are the replacements that its texts need; `kind` says whether it is a `moment`, a
    `day` or a time of a day, `hours`; `zoned` is a moment whose zone is written.

    """

    pattern: str
    kind: str
    order: str = ''
    steps: tuple[tuple[str, str], ...] = ()
    zoned: bool = False

    def __call__(self, texts: pl.Series) -> pl.Series:
        """Return texts as times since 1970 or midnight [s], null where one is of another form."""
        return self._seconds(_replaced(texts, self.steps))

    def _seconds(self, texts: pl.Series) -> pl.Series:
        if self.kind == 'hours':
            if self.pattern == MINUTES:
                texts = '0:' + texts
            pattern = '%H:%M:%S%.f' if self.pattern == MINUTES else self.pattern
            hours = texts.str.to_time(pattern, strict=False)
            seconds = hours.cast(pl.Int64).cast(pl.Float64) / SECOND
            if pattern != HOURS[0]:
                return seconds
            late = texts.str.extract(LATE_HOURS).cast(pl.Float64)
            if late.null_count() == len(late):
                return seconds
            within = texts.str.replace(r'^\d+', '0').str.to_time(pattern, strict=False)
            of_day = within.cast(pl.Int64).cast(pl.Float64) / SECOND + 3600.0 * late
            return seconds.zip_with(late.is_null(), of_day)
        if self.kind == 'day':
            days = texts.str.to_date(self.pattern, strict=False)
            seconds = days.cast(pl.Int64).cast(pl.Float64) * DAY
        else:
            moments = texts.str.to_datetime(self.pattern, time_unit='ns', strict=False)
            seconds = moments.cast(pl.Int64).cast(pl.Float64) / SECOND
        return seconds.set(~seconds.is_between(*KNOWN).fill_null(True), None)


def time_forms(texts: pl.Series) -> Iterator[tuple[TimeForm, ...]]:
    """Yield the forms that some texts may have; those of one date in two orders together."""
    filled = texts.drop_nulls().unique(maintain_order=True)
    sample = filled.gather_every(max(len(filled) // SAMPLE, 1))
    if not len(sample) or not sample.str.contains(r'\d').any():
        return
    steps = []
    counted = sample.str.contains(r'\d:\d\d:\d\d[:;]\d').any()
    for step in STEPS:
        replaced = _replaced(sample, [step])
        if counted if step in MILLISECONDS else not replaced.equals(sample):
            steps.append(step)
            sample = replaced
    english = _replaced(sample, MONTHS)
    by_hours: dict[str, list[TimeForm]] = {}
    signs = {letter for letter in ''.join(sample) if not letter.isalnum()}
    written = [text for text in english.to_list() if len(text) <= LONGEST_TIME]
    for form, (needed, shape) in _all_forms().items():
        if not needed <= signs or not any(map(shape.fullmatch, written)):
            continue
        made = dataclasses.replace(form, steps=(*steps, *(MONTHS if '%B' in form.pattern else ())))
        if made._seconds(english).null_count() < len(sample):
            key = re.sub('%[dmy]', '', form.pattern) if form.order else form.pattern
            by_hours.setdefault(key, []).append(made)
    yield from map(tuple, by_hours.values())


def _replaced(texts: pl.Series, steps: Iterable[tuple[str, str]]) -> pl.Series:
    for pattern, replacement in steps:
        texts = texts.str.replace_all(pattern, replacement)
    return texts


PARTS = {'%B': r'\w+\.?', '%p': '[AaPp][Mm]', '%z': r'[-+]\d+:?\d*', '%.f': r'(?:\.\d*)?'}
"""Patterns of the parts of a form that are no whole numbers."""


@functools.cache
def _all_forms() -> dict[TimeForm, tuple[set[str], re.Pattern[str]]]:
    """Return all forms, the signs that each needs, and what its texts look like."""
    moments = (
        TimeForm(pattern=f'{date} {hours}', kind='moment', order=order, zoned='%z' in hours)
        for order, date in DATES
        for hours in HOURS
    )
    of_day = (
        TimeForm(pattern=hours, kind='hours')
        for hours in (*HOURS[:-1], MINUTES)
        if '%z' not in hours
    )
    days = (TimeForm(pattern=date, kind='day', order=order) for order, date in DATES)
    forms = {}
    for form in (*moments, *of_day, *days):
        parts = re.split(r'(%\.?\w)', form.pattern)
        shapes = (PARTS.get(one, r' *\d+') if one[:1] == '%' else re.escape(one) for one in parts)
        forms[form] = set(''.join(parts[::2])), re.compile(''.join(shapes))
    return forms


def order_in_name(name: str) -> str:
    """Return the order of dates that a name states, as `yy/mm/dd`, empty if it states none."""
    for match in ORDER_IN_NAME.finditer(name):
        parts = [{LETTERS[letter] for letter in part.lower()} for part in match.groups()]
        order = ''.join(''.join(part) for part in parts)
        if all(len(part) == 1 for part in parts) and order in ORDERS:
            return order
    return ''


def either_date(moments: Mapping[str, float]) -> str:
    """Return in words which dates [s since 1970] are meant by which orders of a map."""
    words = [
        f'{dt.datetime.fromtimestamp(moments[order], dt.UTC):%Y-%m-%d} by time: {{order: {order}}}'
        for order in ORDERS
        if order in moments
    ]
    return ' or '.join(words)


def moments_of(text: str) -> list[tuple[float, TimeForm]]:
    """Return the times that a text may be [s], each with its form."""
    cells = pl.Series([text])
    found = [(form(cells)[0], form) for forms in time_forms(cells) for form in forms]
    return [(seconds, form) for seconds, form in found if seconds is not None]
