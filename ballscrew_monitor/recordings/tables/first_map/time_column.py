# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The column of the time of a log, its unit and its begin; or why none is."""

from collections.abc import Iterator
import datetime as dt
import math
from typing import Any

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import LINEAR_POSITION_UNITS, LINEAR_SPEED_UNITS
from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.dates import (
    dates_by_name,
    FIRST,
    HEADER,
    NAME,
    start_in_head,
)
from ballscrew_monitor.recordings.tables.first_map.columns import EPOCH
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.names import Named
from ballscrew_monitor.recordings.tables.other_tables import (
    FEW_HOLES,
    other_table,
    rows_above,
    TAIL,
    TAKE_OUT,
)
from ballscrew_monitor.recordings.tables.quantities import MOTION, SCALES, SINCE_1904
from ballscrew_monitor.recordings.tables.stated_rate import first_numbers
from ballscrew_monitor.recordings.tables.time_gate import OF_A_CLOCK, RATE, TimeGate
from ballscrew_monitor.recordings.tables.unit_names import unit_of, words_of
from ballscrew_monitor.recordings.words import short
import numpy as np
import polars as pl
from surrogate.files import InputError

LATE = 2_147_483_648.0  # [s] since 1970: no stamp is later
APART = 0.05  # of the step by which spread rows may differ from parts of their seconds
PARTS = {
    **dict.fromkeys('ms msec millis millisecond milliseconds millisekunden'.split(), 1e-3),
    **dict.fromkeys('us usec micros microsecond microseconds'.split(), 1e-6),
    **dict.fromkeys('ns nsec nanos nanosec nanosecond nanoseconds'.split(), 1e-9),
}
"""Names of columns with parts of the seconds in another, and these parts [s]."""


class TimeColumn:
    """
    The time of a log by the names and numbers of its columns.

    `stated` is what a map says of it, nothing where no column is one; `column` is that, of
    `times` [s] in the first rows, None where their unit is not known, which is `unit` [s]; `step`
    between rows [s] is NaN where it is not known.

    """

    def __init__(self, draft: Draft) -> None:
        """Find the time among the columns that may be one."""
        self._draft, self._log = draft, draft.log
        self.column: Named | None = None
        self.times: Array | None = None
        self.unit, self.step, self._falling = math.nan, math.nan, ''
        self.stated = self._found()

    def _found(self) -> dict[str, Any]:
        """Return what the map says of the time; take the step between rows if it is known."""
        log, notes = self._log, self._draft.notes
        of_days = (one for one in log.times if estimates.is_of_days(log.extremes[one.column]))
        days = next(of_days, None)
        others = [one for one in log.times if one is not days]
        # By name, then by unit, and what the head does not name comes last.
        for one in sorted(others, key=lambda one: (one.kind != 'time', -one.rank)):
            values, dated = log.data[one.column], {}
            if one.column in log.timed and estimates.is_of_a_day(log.extremes[one.column]):
                if days is None:
                    values = estimates.Midnights().passed(values)
                else:
                    values, dated = log.data[days.column] + values, {'date': days.column}
            elif one.kind != 'time' and not self._is_surely_time(one, values):
                continue
            self._refuse_other_table(one, values)
            fault = self.fault(one, values)
            if not fault and (part := self._parts_of_seconds(one, values)):
                fault = (
                    f'it holds whole seconds, and column {short(repr(part))} their parts: join '
                    'both in one column'
                )
            if not fault:
                notes += [f'{why}; it is left out' for why in log.not_times]
                return self._time_of(one, values) | dated
            log.not_times.append(f'column {short(repr(one.column))}: {fault}')
        return {}

    def _is_surely_time(self, one: Named, values: Array) -> bool:
        """Return True if a column that no name calls a time is one by its numbers or its head."""
        log, known = self._log, values[np.isfinite(values)]
        sure = one.column in log.head.labelled or one.column in log.twins
        if len(known) < 2 or sure or log.unit_of_program(one):
            return len(known) > 1
        return one.column in log.timed or bool(estimates.epoch_units(known))

    def fault(self, one: Named, values: Array) -> str:
        """Return why values are no time of the motion, empty if they are."""
        faults, log = [], self._log
        for chosen in log.axes.values():
            moves = np.isfinite(log.data[(chosen.get('speed') or chosen['position']).column])
            rows = np.flatnonzero(np.isfinite(values) & moves)
            times, numbers = values[rows], rows + log.first_row
            if len(rows) < 2:
                return 'it holds fewer than two numbers beside those of the motion'
            if not np.ptp(times):
                return f'it is {times[0]:.12g} in all rows'
            is_timed = one.column in log.timed
            gate = TimeGate(wall=is_timed, wraps=OF_A_CLOCK if is_timed else ())
            unit = self.unit_of(one, times)[0]
            gate.add(times * (SCALES[unit][0] if unit else 1.0), numbers)
            gate.finish()
            if other := rows_above(gate.runs, gate.step):
                column = short(repr(one.column))
                raise InputError(f'log {log.path}: column {column}: {other}: {TAKE_OUT}')
            if gate.falls:
                self._falling = (
                    f'column {short(repr(one.column))}: {": ".join(gate.fault_of_order())}'
                )
            faults.append((gate.fault() if unit else gate.fault_of_order())[0])
        return next(filter(None, faults), '')

    def _refuse_other_table(self, one: Named, values: Array) -> None:
        """Raise InputError for rows at the end of a whole log that are of another table."""
        log = self._log
        holes, rows = log.table.readings[one.column].holes[0], log.table.rows
        if len(values) < rows or holes > FEW_HOLES * rows:
            return
        step, first = estimates.usual_step(values), max(len(values) - TAIL, 0)
        if step and (other := other_table(values[first:], log.first_row + first, step)):
            column = short(repr(one.column))
            raise InputError(f'log {log.path}: column {column}: {other}: {TAKE_OUT}')

    def _parts_of_seconds(self, one: Named, values: Array) -> str:
        """Return the column of the parts of whole seconds, where rows spread in them miss it."""
        source = self._log.source
        names_of = {name: ''.join(words_of(names.base_of(name))) for name in source.names()}
        part = next((name for name, word in names_of.items() if word in PARTS), '')
        if not part or (values != np.floor(values)).any() or self.unit_of(one, values)[0] != 's':
            return ''
        cells = source.first_rows()[part].cast(pl.Float64, strict=False).to_numpy()
        first = values[: len(cells)]
        steps = np.diff(cells[: len(first)])[np.diff(first) == 0.0] * PARTS[names_of[part]]
        alike = len(steps) and abs(np.median(steps) / row_step(values) - 1.0) < APART
        return '' if not len(steps) or alike else part

    def unit_of(self, one: Named, values: Array) -> tuple[str, str]:
        """Return the unit of times, empty if unknown, and why it is that if nothing states it."""
        log = self._log
        if one.column in log.timed:
            return 's', ''
        by_name = unit_of(names.base_of(one.column), 'time') if one.column in log.twins else ''
        stated = log.unit_of_program(one) or one.unit or by_name
        first, rising = values[:1], np.diff(np.unique(values))
        step = float(np.median(rising)) if len(rising) else math.nan
        epochs = estimates.epoch_units(values) if len(values) > 1 else []
        of_days = stated == 'd' and bool(epochs)
        if stated and not (stated == 's' and epochs == ['labview_s'] and first > LATE or of_days):
            return stated, ''
        if len(epochs) == 1:
            return epochs[0], ''
        for period in {log.head.period, *log.head.periods.values()}:
            if math.isfinite(period) and (unit := estimates.unit_by_period(step, period)):
                return unit, f'the head states a period of {period:g} s'
        for name, chosen in log.axes.items():
            if set(MOTION) <= set(chosen):
                speed, position = (chosen[kind] for kind in MOTION)
                places = [position.unit] if position.unit else list(LINEAR_POSITION_UNITS)
                speeds = [speed.unit] if speed.unit else list(LINEAR_SPEED_UNITS)
                linear = {*places, *speeds} <= {*LINEAR_POSITION_UNITS, *LINEAR_SPEED_UNITS}
                numbers = (log.data[each.column] for each in (one, position, speed))
                if linear and (
                    unit := estimates.unit_by_motion(*numbers, places=places, speeds=speeds)
                ):
                    return unit, f'position and speed of axis {name} agree in no other'
        return '', ''

    def _time_of(self, one: Named, values: Array) -> dict[str, Any]:
        """Take a column for the time, and return what the map says of it."""
        known = values[np.isfinite(values)]
        unit, why = self.unit_of(one, known)
        step, self.column = row_step(known), one
        if not unit:
            rates = [
                f'{each} {1.0 / (step * factor):.3g} Hz'
                for each, factor in conversions.TIME_UNITS.items()
                if 0.95 / RATE <= step * factor <= 1.0 / estimates.SLOWEST
            ]
            words = f': in {", in ".join(rates)}' if rates else ''
            if math.isfinite(period := self._log.head.period):
                words += (
                    f'; the head states a period of {period:.4g} s: unit s, and a scale of '
                    f'{period / step:.4g} makes of them'
                )
            self._draft.unstated.append(
                f'state time.unit in the map: column {one.column} states none that is known; its '
                f'rows are {step:.3g} apart, which may be of any{words}'
            )
        if why:
            self._draft.assume('time.unit', unit, f'{one.column} states none that is known; {why}')
        if unit == 'spreadsheet_days' and not self._log.source.sheet:
            words = f'{one.column} holds days of a spreadsheet, taken to count from 1900'
            self._draft.assume('time.offset', 0.0, f'{words}; {SINCE_1904} if from 1904')
        if not unit or not estimates.is_universal(known, unit):
            of_day = one.column in self._log.timed
            self._set_epoch(
                f'column {one.column} does not count from a known time',
                since=float(known[0]) if of_day else None,
            )
        if unit:
            self.unit = SCALES[unit][0]
            self.step, self.times = step * self.unit, values * self.unit
        column = None if unit and self._is_denied(one.column, known * self.unit) else one.column
        return {'column': column} | ({} if why else {'unit': unit or None})

    def _is_denied(self, column: str, times: Array) -> bool:
        """Return True, and ask for the time, if the head states another rate than times [s]."""
        period, steps = self._log.head.period, np.diff(times)
        usual = steps[(steps > 0.0) & (steps < estimates.LONG * np.median(steps))]
        # Stamps may be rounded, and rows that share one will be spread.
        step = float(usual.mean()) if len(usual) and not (steps == 0.0).any() else self.step
        if math.isnan(period) or abs(step / period - 1.0) <= estimates.NEAR:
            return False
        self._draft.unstated.append(
            f'state time.column: {column} in the map, by which the rows are {step:.4g} s '
            f'apart, or time.rate_Hz: {1.0 / period:.6g} instead of column and unit: the head '
            f'states a period of {period:.4g} s'
        )
        return True

    def _set_epoch(self, why: str, *, since: float | None = None) -> None:
        """State the time of the first row by the head or the name of the file, or assume one."""
        draft, start = self._draft, start_in_head(self._log.head)
        begin, where, place = start.by(), f'from line {start.row}', HEADER
        if start.bare and since is None:
            where += ', a date without a time of day, taken as its midnight'
        doubts = [start.open() + ' and date_from: header' * bool(start.moments)]
        if begin is None:
            place = NAME
            for date, of in dates_by_name(self._log.path):
                if (stamp := date.by()) is None:
                    doubts.append(f'{date.open(of)} and date_from: name')
                    break
                if begin is None and stamp >= FIRST:
                    begin, where = stamp, f'from the name of the {of}'
        if begin is None:
            why = ', and '.join([why, *filter(None, doubts)])
        if since is not None and begin is not None:
            begin = begin - begin % estimates.DAY + since
        if begin is None:
            why = f'{why}, and a stamp of 0 means that there is none'
            draft.assume('time.epoch', EPOCH, why)
            return
        moment = dt.datetime.fromtimestamp(begin, dt.UTC)
        draft.begin = f'start {moment:%Y-%m-%d %H:%M:%S} {where}'
        if since is None:
            draft.date_from = place
            if place == HEADER and len(start.moments) == 1:
                draft.order = next(iter(start.moments))
            return
        text = moment.isoformat(timespec='microseconds' if begin % 1 else 'seconds')
        draft.assume('time.epoch', text.replace('+00:00', 'Z'), f'{where}, taken as UTC')

    def without_column(self) -> dict[str, Any]:
        """
        Return what the map says of the time of a log whose time is not read.

        Raises InputError for one whose rows stand in the order of time, but the newest first.

        """
        draft, log = self._draft, self._log
        if self._falling:  # at a rate alone, all would move the other way
            raise InputError(f'log {log.path}: {self._falling}')
        if math.isfinite(log.head.period) and not log.not_times:
            self.step = log.head.period
            self._set_epoch('the log has no time that is read')
            row = f' in line {log.head.period_row}' if log.head.period_row else ''
            draft.notes.append(f'the head states a period of {self.step:g} s{row}')
            return {'rate_Hz': float(f'{1.0 / self.step:.9g}')}
        motions = {}
        for name, chosen in log.axes.items():
            if set(MOTION) <= set(chosen):
                speed, position = (draft.unit(name, kind) for kind in MOTION)
                if speed in LINEAR_SPEED_UNITS and position in LINEAR_POSITION_UNITS:
                    motions[name] = (
                        log.data[chosen['position'].column] * LINEAR_POSITION_UNITS[position],
                        log.data[chosen['speed'].column] * LINEAR_SPEED_UNITS[speed],
                    )
        period = estimates.period(list(motions.values()))
        why = '; '.join(log.not_times or ['no column is named as a time', *self._rising()])
        if unclear := log.head.unclear_period:
            why += (
                f'; the head says {short(repr(unclear))}, which may be the time of something else '
                'than rows'
            )
        if math.isfinite(period):
            why += (
                f'; at {1.0 / period:.3g} Hz the speeds of axes {", ".join(motions)} make their '
                'positions best'
            )
        draft.unstated.append(f'state time.rate_Hz in the map, the rows in a second: {why}')
        self._set_epoch('the log has no time that is read')
        return {'rate_Hz': None}

    def _rising(self) -> Iterator[str]:
        """Yield which columns may be a time by their first cells, though not by their names."""
        log = self._log
        others = [one.column for one in log.named if one.column not in log.data]
        for name, values in first_numbers(log.source, others).items():
            if len(values) > 1 and (np.diff(values) > 0.0).all():
                yield (
                    f'column {short(repr(name))} rises from {values[0]:.12g} in row '
                    f'{log.first_row} on'
                )


def row_step(times: Array) -> float:
    """Return the usual time between rows, which may share times, NaN where it never rises."""
    steps = np.diff(times)
    changes = np.diff(np.flatnonzero(steps > 0.0))
    share = float(np.median(changes)) if len(changes) else 1.0
    return float(np.median(steps[steps > 0.0])) / share if (steps > 0.0).any() else math.nan
