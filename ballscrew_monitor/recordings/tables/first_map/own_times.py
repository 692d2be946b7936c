# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Times that columns have of their own, as scopes write them left of the columns they belong to.

An input has the nearest time before it, where the order of the columns tells that.

"""

import math

from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.time_column import row_step, TimeColumn
from ballscrew_monitor.recordings.tables.heads import NO_NAME
from ballscrew_monitor.recordings.tables.names import Named
from ballscrew_monitor.recordings.tables.quantities import SCALES
from ballscrew_monitor.recordings.words import short
import numpy as np

ONE_CLOCK = 0.01  # of the span: times of a row that keep so close are of one clock


class OwnTimes:
    """
    The column of the time of each input.

    `of_inputs` names it; of those `unclear` it may be that of the log as well, and where several
    are `idle`, one of them has no column behind it.

    """

    def __init__(self, draft: Draft, time: TimeColumn) -> None:
        """Give each input its time, if the log has a column of one: the nearest before it."""
        self._draft, self._log, self._time = draft, draft.log, time
        self.of_inputs: dict[str, str] = {}
        self._unclear: set[str] = set()
        self._idle: list[str] = []  # where one of several has no column behind it
        if time.column is None:
            return
        owners = {one.column: self._is_own(time.column, one) for one in self._log.times}
        columns = {column: is_own for column, is_own in owners.items() if is_own is not None}
        held = self._log.source.names()
        behind = False
        for one in self._log.inputs:
            before = held[: held.index(one.column)]
            column = next(
                (each for each in reversed(before) if each in columns), time.column.column
            )
            behind |= not set(before) & set(columns)
            self.of_inputs[one.column] = column
            if not columns[column]:
                self._unclear.add(one.column)
        own = [column for column, is_own in columns.items() if is_own or NO_NAME.fullmatch(column)]
        # A time and its signal again and again: none is idle.
        are_pairs = set(held[::2]) == set(own) and len(held) % 2 == 0
        is_idle = bool(set(own) - set(self.of_inputs.values())) and not are_pairs
        self._idle = own if is_idle or (behind and len(own) > 1) else []

    def _is_own(self, time: Named, one: Named) -> bool | None:
        """
        Return whether a time is that of other columns, None for one that no column has.

        Such a time runs over the times of the log, and differs from them. It returns None where
        both may be times of the same rows, told again or from another zero, and False where it may
        be either.

        """
        log = self._log
        if names.base_of(one.column) == names.base_of(time.column) and one.column in log.data:
            return True
        if one.column not in log.data or not np.ptp(log.extremes[one.column]):
            return None
        if one.kind != 'time' and not log.stands_unnamed(one):
            return None
        values, main = log.data[one.column], log.data[time.column]
        if estimates.is_of_days(log.extremes[one.column]) or self._time.fault(one, values):
            return None
        units = [
            self._time.unit_of(each, column[np.isfinite(column)])[0]
            for each, column in ((time, main), (one, values))
        ]
        is_alike = units[0] == units[1] and (time.column in log.timed) == (one.column in log.timed)
        factors = [SCALES[unit][0] if all(units) else 1.0 for unit in units]
        own = _are_apart(main * factors[0], values * factors[1], is_alike=is_alike)
        if own is None and NO_NAME.fullmatch(one.column) and (main != values).any():
            return False  # no name tells that these are the times of the same rows
        return own

    @property
    def are_known(self) -> bool:
        """Return True if the times of rows are those of a column whose unit is known."""
        return self._time.times is not None

    def times(self, column: str) -> Array:
        """Return the times of the rows of a column [s], none where they are not known."""
        log, time = self._log, self._time
        if time.column is None or time.times is None:
            count = len(log.data[column]) if math.isfinite(log.head.period) else 0
            return np.arange(count, dtype=np.float64) * log.head.period
        own = self.of_inputs.get(column, time.column.column)
        times = time.times if own == time.column.column else log.data[own] * time.unit
        if (np.diff(times) == 0.0).any():  # rows share times, and will be spread
            return times[0] + np.arange(len(times)) * row_step(times)
        return times

    def step(self, time: str, column: str) -> float:
        """Return the usual time between samples of a column [s], by a column of a time."""
        log, of_log = self._log, self._time
        if math.isnan(of_log.unit) or time not in log.data:
            rows = np.diff(np.flatnonzero(np.isfinite(log.data[column])))
            return of_log.step * (float(np.median(rows)) if len(rows) else 1.0)
        values = log.data[time][np.isfinite(log.data[column])]
        return row_step(values[np.isfinite(values)]) * of_log.unit

    def say(self, name: str, kind: str) -> None:
        """Let the map say that an input has another time than the first, or ask if it may have."""
        draft, place = self._draft, self._draft.used[name][kind]
        column, main = place['column'], self._time.column
        time = main.column if main else ''
        own = self.of_inputs.get(column, time)
        first = draft.used[name].get('speed') or draft.used[name].get('position', place)
        if fault := self._log.source.fault_of_length(column, own or first['column']):
            draft.ask(f'{name}.{kind}.time', f', a column of the length of {column}: {fault}')
            return
        if own != time:
            place['time'] = own
        if self._idle:
            draft.ask(
                f'{name}.{kind}.time',
                f', {" or ".join(self._idle)}, the time of {column}: the order of columns does '
                'not tell',
            )
            return
        if not own or names.base_of(own) == names.base_of(time):
            return
        if column not in self._unclear:
            draft.notes.append(
                f'axis {name}: {short(column)} has the times of {short(own)}, which stands '
                'before it'
            )
            return
        self.of_inputs.pop(column)
        draft.ask(
            f'{name}.{kind}.time',
            f', {time} or {own}: {column} stands behind {own}, which has no name and may hold its '
            'times'
            if NO_NAME.fullmatch(own)
            else f', {time} if {column} has the times of its row: it stands behind {own}, which '
            f'has another unit or other years than {time}; where these are its times, give both '
            'in one unit',
        )


def _are_apart(main: Array, other: Array, *, is_alike: bool) -> bool | None:
    """
    Return whether times are those of columns of their own beside others, None for the same rows.

    Both are in one unit, by row of the table, NaN where there is none; they are alike if a map can
    read both.

    """
    apart = (other - main)[np.isfinite(other - main)]
    span = min(np.nanmax(main) - np.nanmin(main), np.nanmax(other) - np.nanmin(other))
    if len(apart) and np.abs(apart).max() <= ONE_CLOCK * span:
        return None
    overlap = min(np.nanmax(main), np.nanmax(other)) - max(np.nanmin(main), np.nanmin(other))
    if overlap > 0.0:
        return is_alike
    return None if len(apart) and np.ptp(apart) <= ONE_CLOCK * span else False
