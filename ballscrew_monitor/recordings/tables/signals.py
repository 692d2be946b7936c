# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Signals of a file that has no rows of cells: columns by their names, each with a unit and a time.

Each reader of a kind of file returns them. Columns of a time of their own stand behind it. Numbers
beside the columns may state the period of their rows, or scale them.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
import dataclasses
import math
import re
from typing import Any

from ballscrew_monitor.recordings.tables.apart import check_room
from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.heads import factor_word, Head, Property, unlike
from ballscrew_monitor.recordings.tables.layouts import Format, LONGEST_PERIOD, OTHER_ROWS
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.signs import signless
from ballscrew_monitor.recordings.tables.unit_names import BRACKETS, words_of
import numpy as np
import polars as pl
from surrogate.files import limits

Columns = Mapping[str, Any]
"""Values by the names of their columns."""
NUMBERS = 'iuf'  # kinds of types
RATES = frozenset(
    'fs rate samplerate samplingrate samplefrequency samplingfrequency frequency'.split()
)
PERIODS = frozenset('ts dt sampletime samplingtime sampleperiod samplingperiod period'.split())
DOUBTFUL = frozenset('rate frequency period'.split())
"""Names of numbers that may be the rate or period of rows; the doubtful ones may be of others."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Signals:
    """
    Signals of a file as a frame, and what the file says besides them; a period in [s].

    Cells that are texts were parted by a `separator`; `factors` says of a signal that it may have
    to be scaled, `unclear_period` of numbers that they may be the period. `left_out` has the
    reason why a part of the file is not among them, by its name, and `more_rows` the records there
    of the same signals; `empty_rows` are numbers of records without any; `arrays` are the lengths
    of those that stand side by side.

    """

    frame: pl.DataFrame
    period: float = math.nan
    start: str = ''
    separator: str = ''
    program: Format | None = None
    factors: str = ''
    unclear_period: str = ''
    left_out: Mapping[str, str] = dataclasses.field(default_factory=dict)
    more_rows: int = 0
    empty_rows: Sequence[int] = ()
    arrays: Mapping[str, int] = dataclasses.field(default_factory=dict)

    def head(self) -> Head:
        """Return what the head of a text would say."""
        dates = (Property(text=self.start, row=1, label='start'),) if self.start else ()
        return Head(
            names=unlike(self.frame.columns),
            separator=self.separator,
            program=self.program,
            begin=0,
            first=1,
            dates=dates,
            period=self.period,
            unclear_period=self.unclear_period,
            factors=self.factors,
        )


def signals_of(columns: Columns, beside: Columns, stated: Columns, **more: Any) -> Signals:
    """
    Return columns side by side, by the numbers that stand `beside` them.

    Some of these have `stated` periods [s]; another one may be the period by its name, if nothing
    speaks against it. `told` is what else the file says.

    """
    numbers = {
        name: float(one)
        for name, one in beside.items()
        if np.ndim(one) == 0 and np.asarray(one).dtype.kind in NUMBERS
    }
    periods = {**stated, **periods_of(numbers)}
    others = [
        name
        for name, number in numbers.items()
        if OTHER_ROWS.search(' '.join(words_of(name))) and number != 1.0
    ]
    # Quantities of several lengths: a period is that of one of them alone.
    uneven = len({len(held) for name, held in columns.items() if read_name(name).kind}) > 1
    period = math.nan
    if len(periods) == 1 and not others and not uneven:
        name, only = next(iter(periods.items()))
        group, _, last = name.rpartition('.')
        beside_it = all(other.rpartition('.')[0] == group for other in columns)
        is_plain = name in stated or (beside_it and last.lower() not in DOUBTFUL)
        period = only if is_plain and only <= LONGEST_PERIOD else math.nan
    unclear = ', '.join(f'{name} = {numbers[name]:g}' for name in [*periods, *others])
    return Signals(
        frame=side_by_side(columns),
        period=period,
        unclear_period=unclear if math.isnan(period) else '',
        arrays=lengths(columns),
        **{'factors': ', '.join(stated_factors(beside)), **more},
    )


def periods_of(numbers: Mapping[str, float]) -> dict[str, float]:
    """Return the periods [s] that numbers may be by their names."""
    last = {name: re.sub('[_ ]', '', name.rpartition('.')[2].lower()) for name in numbers}
    return {
        name: 1.0 / value if last[name] in RATES else value
        for name, value in numbers.items()
        if last[name] in RATES | PERIODS and value > 0.0
    }


def stated_factors(content: Mapping[str, Any], before: str = '') -> Iterator[str]:
    """Yield numbers besides the signals that may scale these, by the words of their paths."""
    for key, value in content.items():
        name = f'{before}{key}'
        if isinstance(value, dict):
            yield from stated_factors(value, f'{name}.')
            continue
        of = next((word for part in name.split('.') if (word := _factor(part))), '')
        if of and np.asarray(value).dtype.kind in NUMBERS:
            if (np.asarray(value) != (0.0 if of == 'offset' else 1.0)).any():
                yield f'{name} {np.squeeze(value)}'


def _factor(label: str) -> str:
    """Return the word of a label for what scales or shifts the values, empty for any other."""
    return 'cal' if label.lower() == 'cal' else factor_word(label.replace('_', ' '))


def lengths(columns: Columns) -> dict[str, int]:
    """Return how many values each column holds."""
    return {name: len(column) for name, column in columns.items()}


def side_by_side(columns: Columns) -> pl.DataFrame:
    """Return columns of several lengths as a frame, those of one length together."""
    by_length = dict.fromkeys(map(len, columns.values()))
    height = max(by_length, default=0)
    check_room(height, len(columns))
    series = [
        pl.Series(name, _told_apart(column), strict=False).extend_constant(None, height - length)
        for length in by_length
        for name, column in columns.items()
        if len(column) == length
    ]
    return pl.DataFrame(series)


def _told_apart(column: Any) -> Any:
    """Return cells, numbers beside texts so that they show no decimal sign for these."""
    if not isinstance(column, list) or not {str, float} <= {*map(type, column)}:
        return column
    return [signless(cell) if isinstance(cell, float) else cell for cell in column]


def behind_times(groups: Sequence[tuple[Any, Columns]]) -> dict[str, Any]:
    """Return the columns of groups of one time each [s], which stands before them."""
    held: dict[str, Any] = {}
    for times, columns in groups:
        first = BRACKETS.sub('', next(iter(columns))).strip()
        held['time [s]' if len(groups) == 1 else f'{first} time [s]'] = times
        held |= columns
    return held


def columns_of_records(
    records: Sequence[Mapping[str, Any]], without: Collection[str] = ()
) -> dict[str, list[Any]]:
    """Return records as rows, with a column for each name that one of them holds."""
    names = {name: None for record in records for name in record if name not in without}
    check_room(len(records), len(names), limits.RECORD_CELL)
    if len(names) > limits.COLUMNS:
        raise Unreadable(f'it has {len(names)} columns, allowed are {limits.COLUMNS}')
    return {name: [record.get(name) for record in records] for name in names}
