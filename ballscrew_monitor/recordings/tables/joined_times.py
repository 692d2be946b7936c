# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Times whose parts stand in columns of their own, joined in one.

They are seconds and parts of them, as of ROS, or hours, minutes and seconds, perhaps behind year,
month and day. Names tell the parts, and their numbers in the first rows prove them.

"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import dataclasses
from typing import Any

from ballscrew_monitor.recordings.tables.cells import Read, TypesBut
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.unit_names import BRACKETS, words_of
import numpy as np
import polars as pl

PARTS = {
    'year': 'year jahr',
    'month': 'month monat',
    'day': 'day tag',
    'hour': 'hour hours hr hrs stunde hh',
    'minute': 'minute minutes min mins',
    'second': 'second seconds sec secs sekunde',
    'millisecond': 'millisecond milliseconds milli millis millitm msec ms millisekunde',
    'microsecond': 'microsecond microseconds micros usec usecs us',
    'nanosecond': 'nanosecond nanoseconds nanos nanosec nsec nsecs ns',
}
ROLES = {word: part for part, words in PARTS.items() for word in words.split()}
"""Parts of a time by the last word of a name."""
DIGITS = {'millisecond': 3, 'microsecond': 6, 'nanosecond': 9}
"""Digits of parts of a second."""
MOST = {'month': 12, 'day': 31, 'hour': 23, 'minute': 59, 'second': 60}
CLOCK, CALENDAR = ('hour', 'minute', 'second'), ('year', 'month', 'day')
WHOLE = r'^\s*(\d+)(?:[.,]0*)?\s*$'
HALF_DAY = r'(?i)(\s*[ap]\.?\s?m\.?)\s*$'
SECONDS = r'(?i):\d\d\s*(?:[ap]\.?\s?m\.?\s*)?$|^\s*\d+(?:[.,]0*)?\s*$'
"""Texts of whole numbers, of AM and PM, and of times without parts of a second."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class JoinedTime:
    """A time out of several columns by what each is; `moment` is one without parts of seconds."""

    name: str
    columns: Mapping[str, str]

    def of(self, block: pl.DataFrame) -> pl.Series:
        """Return the joined times of some rows as texts."""
        texts = {part: _text(block[name]) for part, name in self.columns.items()}
        sub = next((part for part in DIGITS if part in texts), '')
        frame = pl.DataFrame(texts)
        plain = pl.col('moment' if 'moment' in texts else 'second').str.strip_chars()
        seconds = plain.str.replace(r'[.,]0*$', '') if sub else plain.str.replace(',', '.')
        if sub:
            half_day = plain.str.extract(HALF_DAY).fill_null('')
            seconds = seconds.str.replace(HALF_DAY, '')
            part = pl.col(sub).str.extract(WHOLE)
            seconds = pl.concat_str(seconds, pl.lit('.'), part.str.zfill(DIGITS[sub]))
            seconds = pl.concat_str(seconds, pl.lit('0' * (9 - DIGITS[sub])), half_day)
        if 'hour' in texts:
            clock = [pl.col(part).str.extract(WHOLE).str.zfill(2) for part in CLOCK[:2]]
            padded = seconds.str.replace(r'^(\d)(\.|$)', '0$1$2')
            seconds = pl.concat_str(*clock, padded, separator=':')
        if 'year' in texts:
            days = [pl.col(part).str.extract(WHOLE).str.zfill(2) for part in CALENDAR]
            seconds = pl.concat_str(pl.concat_str(*days, separator='-'), seconds, separator=' ')
        return frame.select(seconds.alias(self.name)).to_series()


def joined_time(names: Sequence[str], rows: Callable[[list[str]], pl.DataFrame]) -> JoinedTime:
    """Return the time whose parts are among columns, by their first `rows`; one without any."""
    for columns in _candidates(names):
        if _are_parts(columns, rows(list(columns.values()))):
            first = names[min(map(names.index, columns.values()))]
            parts = ', '.join(BRACKETS.sub('', one).strip() for one in columns.values())
            counts = _text(rows([first]).to_series()).str.contains(WHOLE).fill_null(False).all()
            of_clock = 'hour' in columns or ('moment' in columns and not counts)
            name = f'time of {parts}' if of_clock else f'time of {parts} [s]'
            return JoinedTime(name=name, columns=columns)
    return JoinedTime(name='', columns={})


def _candidates(names: Sequence[str]) -> Iterator[dict[str, str]]:
    """Yield the columns of which the names may be parts of one time."""
    groups: dict[tuple[str, ...], dict[str, str]] = {}
    for name in names:
        *before, last = words_of(name) or ['']
        if last in ROLES:
            groups.setdefault(tuple(before), {}).setdefault(ROLES[last], name)
    for group in groups.values():
        subs = [part for part in DIGITS if part in group]
        if set(CLOCK) <= set(group):
            calendar = CALENDAR if set(CALENDAR) <= set(group) else ()
            yield {part: group[part] for part in (*calendar, *CLOCK, *subs[:1])}
        elif 'second' in group and subs:
            yield {part: group[part] for part in ('second', subs[0])}
    for moment, name in zip(names, names[1:]):
        part = ROLES.get(''.join(words_of(name)), '')
        if part in DIGITS and read_name(moment).kind == 'time':
            yield {'moment': moment, part: name}


def _are_parts(columns: Mapping[str, str], rows: pl.DataFrame) -> bool:
    """Return True if the first rows hold whole numbers of parts, which together rise."""
    texts = {part: _text(rows[name]) for part, name in columns.items()}
    if rows.height < 2:
        return False
    moment = texts.pop('moment', None)
    if moment is not None and not moment.str.contains(SECONDS).fill_null(False).all():
        return False
    numbers = {
        part: text.str.replace(',', '.').cast(pl.Float64, strict=False).to_numpy()
        for part, text in texts.items()
    }
    if any(not np.isfinite(one).all() or (one < 0.0).any() for one in numbers.values()):
        return False
    subs = [part for part in DIGITS if part in numbers]
    whole = [part for part in numbers if part != 'second' or subs]
    if any((numbers[part] != np.floor(numbers[part])).any() for part in whole):
        return False
    most = {part: 10.0 ** DIGITS[part] - 1.0 for part in subs}
    most |= MOST if 'hour' in numbers else {}
    if any((numbers[part] > most[part]).any() for part in numbers if part in most):
        return False
    if not subs:
        return True
    # Parts of a second rise within each, and begin again with the next.
    seconds = numbers['second'] if moment is None else moment.rle_id().to_numpy()
    within = np.diff(seconds) == 0
    steps = np.diff(numbers[subs[0]])
    if not (within & (steps > 0)).any():
        return False
    begins_again = steps[~within] <= 0 if within.mean() > 0.5 else np.ones(1, bool)
    return bool((steps[within] >= 0).all() and begins_again.all())


def _text(cells: pl.Series) -> pl.Series:
    return cells if cells.dtype == pl.String else cells.cast(pl.String)


def joining(read: Read, time: JoinedTime) -> Read:
    """Return what reads a table as `read` does, and the joined time as one of its columns."""

    def read_joined(names: list[str], types: Mapping[str, Any]) -> Iterator[pl.DataFrame]:
        if time.name not in names:
            yield from read(names, types)
            return
        parts = list(time.columns.values())
        others = [name for name in names if name != time.name]
        for block in read(list(dict.fromkeys([*others, *parts])), TypesBut(types, {time.name})):
            yield block.with_columns(time.of(block)).select(names)

    return read_joined
