# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A first map of a log, by names, ranges and rates of its columns.

What nothing in the log tells stands under `assumed` with a value and a reason. The rate, the unit
of a time and the decimal sign are not assumed: they stand without a value, to be stated.

"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import datetime as dt
import functools
import itertools
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import LINEAR_POSITION_UNITS
from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.amounts import (
    are_amounts,
    brakes_always,
    fault_of_speed,
    slopes,
    stays_in_gaps,
)
from ballscrew_monitor.recordings.tables.cells import Array, Cells
from ballscrew_monitor.recordings.tables.dates import (
    dates_by_name,
    FIRST_YEAR,
    HEADER,
    NAME,
    start_in_head,
)
from ballscrew_monitor.recordings.tables.dropouts import column_of, dropped
from ballscrew_monitor.recordings.tables.heads import NO_NAME
from ballscrew_monitor.recordings.tables.interleaved import column_of_sources
from ballscrew_monitor.recordings.tables.mapping import MOTOR, SIGNED
from ballscrew_monitor.recordings.tables.marked import look_at_marks
from ballscrew_monitor.recordings.tables.marks import (
    backward_cells,
    Mark,
    Marks,
    MOST,
    tells_apart,
    valid_cells,
)
from ballscrew_monitor.recordings.tables.names import Named, read_name
from ballscrew_monitor.recordings.tables.other_tables import (
    FEW_HOLES,
    other_table,
    rows_above,
    TAIL,
    TAKE_OUT,
)
from ballscrew_monitor.recordings.tables.own_times import are_pairs, is_own_time
from ballscrew_monitor.recordings.tables.quantities import INPUTS, MOTION, RATED, SCALES, UNITS
from ballscrew_monitor.recordings.tables.read import look_through
from ballscrew_monitor.recordings.tables.series import (
    are_apart,
    of_amounts,
    OF_SLOPE,
    of_slope,
    unclear_brake,
    unclear_direction,
    unclear_factors,
    unclear_gaps,
    unclear_sign,
)
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.recordings.tables.time_gate import RATE, TimeGate
from ballscrew_monitor.recordings.tables.unit_names import unknown_unit, words_of
from ballscrew_monitor.recordings.words import listed, short, Shown, shown_progress
import numpy as np
import polars as pl
from surrogate.files import InputError
from surrogate.surface import find_surface, Surface
from surrogate.units import MILLI, TURN
import yaml

SCREW, OIL = 'nominal', 'iso_vg_68'
OF_DEGF = 'scale 0.555556 and offset -17.7778 make of it'
TORQUE_CONSTANT = 0.1  # [N m/A]
EFFICIENCY = 0.9
TEMPERATURE = 40.0  # [degC]
NUMBERS = 4_000_000  # of the first rows that are in memory
EPOCH = '2000-01-01T00:00:00Z'
LATE = 2_147_483_648.0  # [s] since 1970: no stamp is later
APART = 0.05  # of the rows that hold neither of two signals of joined tables
SAME_WAY = 0.05  # of its way by which a position may differ from another of the same axis
PARTS = {
    **dict.fromkeys('ms msec millis millisecond milliseconds millisekunden'.split(), 1e-3),
    **dict.fromkeys('us usec micros microsecond microseconds'.split(), 1e-6),
    **dict.fromkeys('ns nsec nanos nanosec nanosecond nanoseconds'.split(), 1e-9),
}
"""Names of columns with parts of the seconds in another, and these parts [s]."""
MANY = 10  # rows of which one is not known, of a signal in the rows of another
TURNS = 6.3  # range of a joint from which its unit is no metre
SEPARATED_BY = {';': 'semicolons', ',': 'commas', '\t': 'tabs', '|': 'bars', ' ': 'blanks'}
SPEED_UNITS = {False: conversions.LINEAR_SPEED_UNITS, True: conversions.ROTARY_SPEED_UNITS}
POSITION_UNITS = {False: LINEAR_POSITION_UNITS, True: conversions.ROTARY_POSITION_UNITS}
"""Units of a table, and of a screw."""
SAME_LEAD = 0.01  # part by which a lead out of a log may miss a usual one
LEADS = (1e-3, 0.1)  # [m] of ball screws
ORDER_OR_SIGN = ('.', ',', 'order')
JOINT = re.compile(
    r'(?P<before>.*?)(?P<field>name|position|velocity|effort)(?P<number>\[?_?\d+\]?)$'
)
"""A column of the arrays of joint states."""
FORCE = (
    '2 pi efficiency torque / lead against the torque: friction of guides and seals, and what '
    'accelerates the axis, count as load'
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Guess:
    """
    A map as its content, and what is to be said about it.

    `unstated` says of each place of the map that is null why nothing is assumed there; `picture`
    is what was found in the file.

    """

    content: dict[str, Any]
    unstated: tuple[str, ...]
    notes: tuple[str, ...]
    picture: tuple[str, ...]

    @property
    def text(self) -> str:
        """Return the map as YAML."""
        head = (
            '# A first map of a machine log. What it assumes is judged with as it stands; who\n'
            '# knows a value writes it in its place and takes it out of `assumed`, such as\n'
            '# `axes: {x: {lead_mm: 5.0, screw: my_screw, oil: my_oil, surface: my_screw.npz}}`.\n'
        )
        head += ''.join(f'# {" ".join(line.split())}\n' for line in self.picture)
        if self.unstated:
            head += '# The log cannot be judged before a value stands where this map says null:\n'
        head += ''.join(f'#   {" ".join(why.split())}\n' for why in self.unstated)
        return head + yaml.safe_dump(
            self.content, sort_keys=False, width=96, allow_unicode=True, default_flow_style=None
        )


def guess(path: Path, *, shown: Shown = shown_progress) -> Guess:
    """
    Return a first map of the log at `path`, and show how far it is read.

    Raises InputError when it has no speed.

    """
    return _Guesser(path, shown).result()


def names_motion(path: Path) -> bool:
    """Return False for a table of which no column is named as a motion."""
    with contextlib.suppress(InputError):
        source = source_of(path)
        texts = source.head.symbols
        named = [read_name(name, texts.get(name, '')) for name in source.names()]
        kinds = {kind for one in named for kind in (one.kind, one.doubtful)}
        return bool(kinds & set(MOTION))
    return True


class _Guesser:
    """
    What is found so far.

    `axes` holds the columns of each axis by what they are, `used` what the map says of those that
    say something, by the same names; the `step` between rows [s] is NaN where it is not known.

    """

    def __init__(self, path: Path, shown: Shown) -> None:
        self.path = path
        self.source = source = source_of(path)
        self.head = head = source.head
        if not head.named:
            raise InputError(self._unnamed())
        texts = self._texts()
        self.named = [read_name(name, texts.get(name, '')) for name in source.names()]
        self.assumed: dict[str, dict[str, Any]] = {}
        self.notes: list[str] = []
        self.used: dict[str, dict[str, Any]] = {}
        self.step, self.epoch, self.date_from = math.nan, '', ''
        self.clock: tuple[str, Array, float] | None = None  # time column, its times and unit [s]
        self.order = ''  # of day and month in the head
        self.groups: dict[str, str] = {}
        self.ways: dict[str, float] = {}  # of a position for a unit and second of its speed
        self.unitless: dict[str, dict[str, str]] = {}  # units in which a motion agrees, by axis
        self.unclear_times: set[str] = set()
        self.mark_cells: dict[str, list[str]] = {}
        self.idle_times: list[str] = []  # where one of several has no column behind it
        self.members: dict[tuple[str, tuple[int, int]], str] = {}
        self.times = [one for one in self.named if self._may_be_time(one)]
        self.named = [one for one in self.named if one not in self.times or one.kind == 'time']
        self.by_axis = names.by_axis([one for one in self.named if one.kind != 'time'])
        self.axes = {
            name: chosen
            for name, found in self.by_axis.items()
            if {'speed', 'position'} & set(chosen := names.best(found))
        }
        unknown = names.unknown_units(self.named)
        if not self.axes:
            raise InputError(
                f'log {path}: no column looks like the speed or position of an axis, it holds '
                f'{"; ".join([listed(source.names()), *unknown])}'
            )
        columns = [one for chosen in self.axes.values() for one in chosen.values()]
        self._refuse_several()
        self.marks = self._marks(columns)
        source = self.source = source.marked(self._known_marks())
        others = [
            other
            for name, chosen in self.axes.items()
            for one in chosen.values()
            for other in names.rivals(self.by_axis[name], one)
            if names.may_agree(one, other)
        ]
        used = list(dict.fromkeys(one.column for one in [*columns, *others, *self.times]))
        table = look_through(source, used, optional=used, shown=shown)
        self.unstated = list(table.doubts.values())[:1]
        self.doubts = [key for key in table.doubts if key in ORDER_OR_SIGN][:1]
        for key in self.doubts:
            decided = {'order': 'dmy'} if key == 'order' else {'decimal': key}
            table = look_through(source, used, **decided, optional=used, shown=shown)
        self.table, self.first_row = table, table.first_row
        rows = NUMBERS // len(used)
        # The first rows tell how the speeds go with the positions, all of them the ranges.
        self.data = table.head(rows)
        # Rows that span the table tell signs, which may be seen late.
        self.sampled = {name: table.sampled(name) for name in table.readings}
        self.extremes = {name: one.extremes for name, one in table.readings.items()}
        self.timed = {name for name, one in table.readings.items() if one.is_time}
        times = {one.column for one in self.times}
        # Why a column is not taken for the time.
        self.not_times = [
            why
            for name, why in table.left_out.items()
            if name in {one.column for one in self.times if one.kind == 'time'}
        ]
        self.notes += [
            f'{why}; it is left out' for name, why in table.left_out.items() if name not in times
        ]
        self.notes += [*table.notes, *unknown, *names.told_by_words(self.named)]
        self.notes += names.told_by_units(self.named)
        self._refuse_marks_of_none(columns)
        for one in [one for one in columns if one.column in self.data and one.scale != 1.0]:
            self.data[one.column] = self.data[one.column] * one.scale
            self.sampled[one.column] = self.sampled[one.column] * one.scale
            self.extremes[one.column] = self.extremes[one.column] * one.scale
        if rows < table.rows:
            self.notes.append(f'rate and units are those of the first {rows} of {table.rows} rows')
        self._forget_texts()
        self._forget_speeds()

    def _refuse_several(self) -> None:
        """Raise InputError for rows of several axes or machines that a column tells apart."""
        used = {one.column for chosen in self.axes.values() for one in chosen.values()}
        held = [name for name in self.source.names() if name not in used]
        columns = [name for name in held if tells_apart(words_of(names.base_of(name)))]
        if not columns:
            return
        for column, cells in look_at_marks(self.source.blocks(columns), columns)[1].items():
            if 1 < len(cells) <= MOST:
                raise self._several(column, cells)

    def _several(self, column: str, cells: Sequence[str]) -> InputError:
        """Return the error for rows of several axes or machines."""
        return InputError(
            f'log {self.path}: its rows are of several axes or machines, which column '
            f'{short(repr(column))} tells apart: {listed(cells)}; save a log for each'
        )

    def _refuse_sources_in_turn(self) -> None:
        """Raise InputError for rows of several sources that a column of any name tells apart."""
        if self.clock is None:
            return
        used = {one.column for chosen in self.axes.values() for one in chosen.values()}
        used |= {self.clock[0], *self.mark_cells}
        if others := [name for name in self.source.names() if name not in used]:
            blocks = self.source.blocks(others)
            column, cells = column_of_sources(blocks, others, self.clock[1])
            if column:
                raise self._several(column, cells)

    def _refuse_marks_of_none(self, inputs: Sequence[Named]) -> None:
        """Raise InputError for an input with a number that stands for none, as -9999."""
        for one in [one for one in inputs if one.column in self.data]:
            values = self.data[one.column]
            mark = estimates.mark_of_none(values)
            if math.isfinite(mark):
                raise InputError(
                    f'log {self.path}: column {short(repr(one.column))} holds {mark:g} in '
                    f'{np.count_nonzero(values == mark)} rows, far beyond all others, as a mark '
                    'of no value: leave these cells empty'
                )

    def _marks(self, inputs: Sequence[Named]) -> dict[str, dict[str, dict[str, Any]]]:
        """Return what a map says of the marks of each input: their columns, and cells if clear."""
        held = self.source.names()
        first = min((one.column for one in inputs), key=held.index)
        found: dict[str, dict[str, dict[str, Any]]] = {one.column: {} for one in inputs}
        pairs = [
            (one, role, columns)
            for one in inputs
            for role in ('valid', *(['backward'] if one.kind == 'speed' else []))
            if (columns := names.marks_of(role, one, held, first))
        ]
        if not pairs:
            return found
        read = list(dict.fromkeys([each for one, _, of in pairs for each in (one.column, *of)]))
        signed, cells = look_at_marks(self.source.blocks(read), read)
        for one, role, columns in pairs:
            if role == 'backward' and one.column in signed:
                continue
            of = {'valid': valid_cells, 'backward': backward_cells}[role]
            kept = of(words_of(names.base_of(columns[0])), cells[columns[0]])
            if kept or kept is None:
                clear = kept is not None and len(columns) == 1
                place = {'column': columns[0], 'cells': kept if clear else None}
                found[one.column][role] = place
                self.mark_cells[columns[0]] = cells[columns[0]]
        return found

    def _known_marks(self) -> dict[str, Marks]:
        """Return the marks that are clear, by the columns of inputs."""
        return {
            column: Marks(**{role: Mark(**place) for role, place in places.items()})
            for column, places in self.marks.items()
            if places and all(place['cells'] is not None for place in places.values())
        }

    def _set_marks(self, name: str, kind: str) -> None:
        """Let the map read an input by its marks, or ask for the cells that mark it."""
        place = self.used[name][kind]
        for role, mark in self.marks[place['column']].items():
            place[role] = dict(mark)
            if mark['cells'] is not None:
                self.notes.append(
                    f'axis {name}: {short(place["column"])} is {role} where '
                    f'{short(mark["column"])} is {listed(mark["cells"])}'
                )
            else:
                cells = listed(self.mark_cells[mark['column']])
                self.unstated.append(
                    f'state axes.{name}.{kind}.{role}.cells in the map: the cells of '
                    f'{short(mark["column"])} by which {short(place["column"])} is {role}, of '
                    f'{cells}; or take {role} out of the map'
                )
        if 'valid' not in place:
            self._ask_for_dropouts(name, kind)

    def _ask_for_dropouts(self, name: str, kind: str) -> None:
        """Let the map say where an input is valid that stands still between two jumps."""
        place = self.used[name][kind]
        values = self.data[place['column']]
        lost = dropped(values)
        if not lost.any():
            return
        held = {each.column for chosen in self.axes.values() for each in chosen.values()}
        others = [column for column in self.source.names() if column not in {*held, *self.timed}]
        column, cells = column_of(lost, self.source.blocks(others)) if others else ('', [])
        place['valid'] = {'column': column or None, 'cells': None}
        told = f', while {short(column)} is one of {listed(cells)}' if column else ''
        at = int(np.argmax(lost))
        self.unstated.append(
            f'state axes.{name}.{kind}.valid in the map, the column and its cells by which '
            f'{short(place["column"])} is valid, or leave those cells empty: it jumps to '
            f'{values[at]:g} in row {self.first_row + at} and back after '
            f'{np.count_nonzero(lost)} rows{told}; take valid out of the map if it is so'
        )

    def _unnamed(self) -> str:
        """Return in a sentence how a map names the columns of a table without names."""
        head = self.head
        count = len(head.names)
        between = SEPARATED_BY.get(head.separator, repr(head.separator))
        held = f'{count}, separated by {between}' if count > 1 else 'one'
        rate = f'{1.0 / head.period:g}' if math.isfinite(head.period) else '(rows in a second)'
        epoch = f"epoch: '{EPOCH}'"
        by_column = f' or `time: {{column: column 1, unit: s, {epoch}}}`' if count > 1 else ''
        return (
            f'log {self.path}: no line names its columns, of which it has {held}: a map calls '
            f'them by their numbers, such as `axes: {{x: {{position: {{column: column '
            f'{min(count, 2)}, unit: mm}}, lead_mm: 10.0}}}}`, with `time: {{rate_Hz: '
            f'{rate}, {epoch}}}`{by_column}'
        )

    def _texts(self) -> dict[str, str]:
        """Return what is known of columns besides their names: longer ones, names of joints."""
        texts = {name: f'{symbol} {name}' for name, symbol in self.head.symbols.items()}
        joints = {name: match for name in self.head.names if (match := JOINT.match(name))}
        named = [name for name, match in joints.items() if match['field'] == 'name']
        first = self.source.first_rows() if named else None
        for name, match in joints.items():
            of = f'{match["before"]}name{match["number"]}'
            if first is not None and of in named and match['field'] != 'name':
                joint = str(first[of][0])
                texts[name] = f'{joint} {match["field"]}'
        self.joints = set(texts) & set(joints)
        return texts

    def _may_be_time(self, one: Named) -> bool:
        """Return True if a column may be the time by its name, or as the head names it nothing."""
        return (
            (one.kind == 'time' and one.place in ('machine', 'axis'))
            or one.column in self.head.labelled
            or bool(self._unit_of_program(one))
            or (one is self.named[0] and not one.kind)
            or self._stands_unnamed(one)
        )

    def _stands_unnamed(self, one: Named) -> bool:
        """Return True for a column without a name that stands before or behind one of an input."""
        names, at = self.source.names(), self.source.names().index(one.column)
        behind = at + 1
        after = [name for name in names[behind:] if not NO_NAME.fullmatch(name)]
        is_index = at == 0 and after and read_name(after[0]).kind == 'time'
        return bool(NO_NAME.fullmatch(one.column)) and not is_index

    def _unit_of_program(self, one: Named) -> str:
        """Return the unit of a time that the program writes which made the table, or nothing."""
        program = self.head.program
        if program is None:
            return ''
        labelled = program.labelled if one.column in self.head.labelled else ''
        return dict(program.times).get(one.column.split(' [')[0], labelled)

    def _forget_speeds(self) -> None:
        """Leave out speeds that cannot be those of the position beside them."""
        for name, chosen in self.axes.items():
            if {'speed', 'position'} <= set(chosen):
                speed, position = (chosen[kind].column for kind in ('speed', 'position'))
                extremes = self.extremes[speed], self.extremes[position]
                if fault := fault_of_speed(*extremes, self.sampled[position]):
                    chosen.pop('speed')
                    self.notes.append(of_slope(name, speed, fault))

    def result(self) -> Guess:
        time = self._time_column()
        self._refuse_sources_in_turn()
        for name in self.axes:
            self._fill(name, str(time.get('column', '')))
        if not time:
            time = self._time_without_column()
        self._ask_for_factors()
        self._say_what_is_joined()
        self._say_what_is_left_out(time)
        content: dict[str, Any] = {'log': self.path.name}
        if self.source.sheet and (others := self.source.left_out):
            content['sheet'] = self.source.sheet
            self.notes.append(
                f'sheet {short(self.source.sheet)} is read, not {listed([*others])}: `sheet` in '
                'the map names another'
            )
        content |= {'date_from': self.date_from} if self.date_from else {}
        content |= {'decimal': None} if self._is_decimal_open() else {}
        time |= {'order': self.order} if self.order else {}
        time |= {'order': None} if 'order' in self.doubts else {}
        content |= {'time': time, 'axes': self.used, 'assumed': self.assumed}
        return Guess(
            content=content,
            unstated=tuple(self.unstated),
            notes=tuple(self.notes),
            picture=tuple(self._picture(time)),
        )

    def _is_decimal_open(self) -> bool:
        """Return True if the decimal sign is to be stated, so that no number is known."""
        return '.' in self.doubts or ',' in self.doubts

    def _assume(self, key: str, value: Any, reason: str) -> None:
        self.assumed[key] = {'value': value, 'reason': reason}

    def _forget_texts(self) -> None:
        """Leave out columns without a number, and axes that so have no speed."""
        self.lost = {
            name: [one.column for one in chosen.values() if one.column not in self.data]
            for name, chosen in self.axes.items()
        }
        last = self.source.names()[-1]
        self.times = [
            one
            for one in self.times
            if one.column in self.data
            and not (
                one.column == last
                and NO_NAME.fullmatch(last)
                and estimates.counts_rows(self.data[last])
            )
        ]
        for name, chosen in list(self.axes.items()):
            left = {kind: one for kind, one in chosen.items() if one.column in self.data}
            self.axes[name] = left
            if not {'speed', 'position'} & set(left):
                self.axes.pop(name)
        if not self.axes:
            raise InputError('; '.join(self.notes))

    def _time_column(self) -> dict[str, Any]:
        """Return what the map says of the time; take the step between rows if it is known."""
        days = next((one for one in self.times if self._is(estimates.is_of_days, one)), None)
        others = [one for one in self.times if one is not days]
        # By name, then by unit, and what the head does not name comes last.
        for one in sorted(others, key=lambda one: (one.kind != 'time', -one.rank)):
            values, dated = self.data[one.column], {}
            if one.column in self.timed and self._is(estimates.is_of_a_day, one):
                if days is None:
                    values = estimates.Midnights().passed(values)
                else:
                    values, dated = self.data[days.column] + values, {'date': days.column}
            elif one.kind != 'time' and not self._is_surely_time(one, values):
                continue
            self._refuse_other_table(one, values)
            if fault := self._fault(one, values):
                self.not_times.append(f'column {short(repr(one.column))}: {fault}')
                continue
            if part := self._parts_of_seconds(one, values):
                self.not_times.append(
                    f'column {short(repr(one.column))}: it holds whole seconds, and column '
                    f'{short(repr(part))} their parts: join both in one column'
                )
                continue
            self.notes += [f'{why}; it is left out' for why in self.not_times]
            return self._time_of(one, values) | dated
        return {}

    def _is_surely_time(self, one: Named, values: Array) -> bool:
        """Return True if a column that no name calls a time is one by its numbers or its head."""
        known = values[np.isfinite(values)]
        if len(known) < 2 or one.column in self.head.labelled or self._unit_of_program(one):
            return len(known) > 1
        return one.column in self.timed or bool(estimates.epoch_units(known))

    def _is(self, kind: Callable[[Array], bool], one: Named) -> bool:
        return kind(self.extremes[one.column])

    def _fault(self, one: Named, values: Array) -> str:
        """Return why values are no time of the motion, empty if they are."""
        faults = []
        for chosen in self.axes.values():
            moves = np.isfinite(self.data[(chosen.get('speed') or chosen['position']).column])
            rows = np.flatnonzero(np.isfinite(values) & moves)
            times, numbers = values[rows], rows + self.first_row
            if len(rows) < 2:
                return 'it holds fewer than two numbers beside those of the motion'
            if not np.ptp(times):
                return f'it is {times[0]:.12g} in all rows'
            gate = TimeGate(wall=one.column in self.timed)
            unit = self._unit_of_time(one, times)[0]
            gate.add(times * (SCALES[unit][0] if unit else 1.0), numbers)
            gate.finish()
            if other := rows_above(gate.runs, gate.step):
                column = short(repr(one.column))
                raise InputError(f'log {self.path}: column {column}: {other}: {TAKE_OUT}')
            faults.append((gate.fault() if unit else gate.fault_of_order())[0])
        return next(filter(None, faults), '')

    def _refuse_other_table(self, one: Named, values: Array) -> None:
        """Raise InputError for rows at the end of a whole log that are of another table."""
        holes = self.table.readings[one.column].holes[0]
        if len(values) < self.table.rows or holes > FEW_HOLES * self.table.rows:
            return
        rising = np.diff(values[np.isfinite(values)])
        step = float(np.median(rising[rising > 0.0])) if (rising > 0.0).any() else 0.0
        first = max(len(values) - TAIL, 0)
        if step and (other := other_table(values[first:], self.first_row + first, step)):
            column = short(repr(one.column))
            raise InputError(f'log {self.path}: column {column}: {other}: {TAKE_OUT}')

    def _parts_of_seconds(self, one: Named, values: Array) -> str:
        """Return the column of the parts of whole seconds, where rows spread in them miss it."""
        names_of = {name: ''.join(words_of(names.base_of(name))) for name in self.source.names()}
        part = next((name for name, word in names_of.items() if word in PARTS), '')
        if (
            not part
            or (values != np.floor(values)).any()
            or self._unit_of_time(one, values)[0] != 's'
        ):
            return ''
        cells = self.source.first_rows()[part].cast(pl.Float64, strict=False).to_numpy()
        first = values[: len(cells)]
        steps = np.diff(cells[: len(first)])[np.diff(first) == 0.0] * PARTS[names_of[part]]
        spread = _period(values)
        alike = len(steps) and abs(np.median(steps) / spread - 1.0) < APART
        return '' if not len(steps) or alike else part

    def _unit_of_time(self, one: Named, values: Array) -> tuple[str, str]:
        """Return the unit of times, empty if unknown, and why it is that if nothing states it."""
        if one.column in self.timed:
            return 's', ''
        stated = self._unit_of_program(one) or one.unit
        first, rising = values[:1], np.diff(np.unique(values[:NUMBERS]))
        step = float(np.median(rising)) if len(rising) else math.nan
        epochs = estimates.epoch_units(values) if len(values) > 1 else []
        of_days = stated == 'd' and bool(epochs)
        if stated and not (stated == 's' and epochs == ['labview_s'] and first > LATE or of_days):
            return stated, ''
        if len(epochs) == 1:
            return epochs[0], ''
        periods = {self.head.period, *self.head.periods.values()}
        for period in periods:
            if math.isfinite(period) and (unit := estimates.unit_by_period(step, period)):
                return unit, f'the head states a period of {period:g} s'
        for name, chosen in self.axes.items():
            if {'speed', 'position'} <= set(chosen):
                unit = self._unit_by_motion(one, chosen['position'], chosen['speed'])
                if unit:
                    return unit, f'position and speed of axis {name} agree in no other'
        return '', ''

    def _unit_by_motion(self, one: Named, position: Named, speed: Named) -> str:
        places = [position.unit] if position.unit else list(LINEAR_POSITION_UNITS)
        speeds = [speed.unit] if speed.unit else list(conversions.LINEAR_SPEED_UNITS)
        if not set(places) <= set(LINEAR_POSITION_UNITS) or not set(speeds) <= set(
            conversions.LINEAR_SPEED_UNITS
        ):
            return ''
        return estimates.unit_by_motion(
            *(self.data[each.column] for each in (one, position, speed)),
            places=places,
            speeds=speeds,
        )

    def _time_of(self, one: Named, values: Array) -> dict[str, Any]:
        known = values[np.isfinite(values)]
        unit, why = self._unit_of_time(one, known)
        step = _period(known)
        if not unit:
            self.unstated.append(
                f'state time.unit in the map: column {one.column} states none that is known; its '
                f'rows are {step:.3g} apart, which may be of any{_rates(step)}'
            )
        if why:
            self._assume('time.unit', unit, f'{one.column} states none that is known; {why}')
        if not unit or not estimates.is_universal(known, unit):
            of_day = one.column in self.timed
            self._set_epoch(
                f'column {one.column} does not count from a known time',
                since=float(known[0]) if of_day else None,
            )
        if unit:
            self.step = step * SCALES[unit][0]
            self.clock = one.column, values * SCALES[unit][0], SCALES[unit][0]
        self._set_own_times(one)
        return {'column': one.column} | ({} if why else {'unit': unit or None})

    def _set_own_times(self, time: Named) -> None:
        """Give inputs of another group the column of their time: the nearest before them."""
        columns = {one.column: self._own_time(time, one) for one in self.times}
        columns = {column: own for column, own in columns.items() if own is not None}
        held = self.source.names()
        behind = False
        for one in [one for chosen in self.axes.values() for one in chosen.values()]:
            before = (each for each in reversed(held[: held.index(one.column)]) if each in columns)
            column = next(before, time.column)
            behind |= not set(held[: held.index(one.column)]) & set(columns)
            self.groups[one.column] = column
            if not columns[column]:
                self.unclear_times.add(one.column)
        own = [column for column, is_own in columns.items() if is_own or NO_NAME.fullmatch(column)]
        is_idle = bool(set(own) - set(self.groups.values())) and not are_pairs(held, own)
        self.idle_times = own if is_idle or (behind and len(own) > 1) else []

    def _own_time(self, time: Named, one: Named) -> bool | None:
        """Return whether a time is that of other columns, None for a time of none."""
        if names.base_of(one.column) == names.base_of(time.column) and one.column in self.data:
            return True
        if one.column not in self.data or not np.ptp(self.extremes[one.column]):
            return None
        if one.kind != 'time' and not self._stands_unnamed(one):
            return None
        values, main = self.data[one.column], self.data[time.column]
        if self._is(estimates.is_of_days, one) or self._fault(one, values):
            return None
        units = [
            self._unit_of_time(each, column[np.isfinite(column)])[0]
            for each, column in ((time, main), (one, values))
        ]
        is_alike = units[0] == units[1] and (time.column in self.timed) == (
            one.column in self.timed
        )
        factors = [SCALES[unit][0] if all(units) else 1.0 for unit in units]
        own = is_own_time(main * factors[0], values * factors[1], is_alike=is_alike)
        if own is None and NO_NAME.fullmatch(one.column) and (main != values).any():
            return False  # no name tells that these are the times of the same rows
        return own

    def _set_epoch(self, why: str, *, since: float | None = None) -> None:
        """State the time of the first row by the head or the name of the file, or assume one."""
        start = start_in_head(self.head)
        begin, where, place = start.known, f'from line {start.row}', HEADER
        if begin is None:
            begin, where = self._start_in_name()
            place = NAME
        if begin is None and start.moments:
            why = (
                f'{why}, and its start {start.text} in line {start.row} may be of either order of '
                'day and month: date_from: header with time: {order: dmy} or mdy dates it'
            )
        if since is not None and begin is not None:
            begin = begin - begin % estimates.DAY + since
        if begin is None:
            self._assume('time.epoch', EPOCH, f'{why}, and a stamp of 0 means that there is none')
            return
        moment = dt.datetime.fromtimestamp(begin, dt.UTC)
        text = moment.isoformat(timespec='microseconds' if begin % 1 else 'seconds')
        self.epoch = f'start {moment:%Y-%m-%d %H:%M:%S} {where}'
        if since is None:
            self.date_from = place
            if place == HEADER and len(start.moments) == 1:
                self.order = next(iter(start.moments))
            return
        self._assume('time.epoch', text.replace('+00:00', 'Z'), f'{where}, taken as UTC')

    def _start_in_name(self) -> tuple[float | None, str]:
        """Return when the log begins [s] by its name or that of its folder, and which it is."""
        for moment, of in dates_by_name(self.path):
            if moment is not None and moment.year >= FIRST_YEAR:
                return moment.timestamp(), f'from the name of the {of}'
        return None, ''

    def _period_of(self, time: str, column: str, stated: Mapping[str, Any]) -> float:
        """Return the usual time between samples of a column with its own time [s]."""
        unit = stated.get('unit') or self.assumed.get('time.unit', {}).get('value', '')
        if not time or not unit or time not in self.data:
            return self.step
        values = self.data[time][np.isfinite(self.data[column])]
        return _period(values[np.isfinite(values)]) * SCALES[unit][0]

    def _picture(self, time: Mapping[str, Any]) -> Iterator[str]:
        """Yield what was found in the file, a line each."""
        main = time.get('column', '')
        groups: dict[tuple[str, tuple[int, int]], list[str]] = {}
        for name, kinds in self.used.items():
            for kind in filter(kinds.__contains__, INPUTS):
                if column := kinds[kind].get('column', ''):
                    key = (self.groups.get(column, main), self.table.readings[column].holes)
                    unit = self._unit(name, kind) or 'in an unknown unit'
                    told = f'{name} {kind} {unit} ({column})'
                    groups.setdefault(key, []).append(told)
                    self.members.setdefault(key, column)
        for number, (key, members) in enumerate(groups.items()):
            step = self._period_of(key[0], self.members[key], time)
            known = math.isfinite(step) and not self._is_decimal_open()
            each = f'{1e3 * step:.4g} ms' if known else 'an unknown period'
            yield f'Group {number + 1}: {each}, {", ".join(members)}'
        head = self.head
        between = SEPARATED_BY.get(head.separator, repr(head.separator))
        found = [f'{len(head.names)} columns separated by {between}'] if head.separator else []
        found += [f'first numbers in row {head.first}']
        found += [f'written by {head.program.program}'] if head.program else []
        found += [self.epoch] if self.epoch else []
        found += [self.table.decision.words] if self.table.decision.words else []
        yield f'Found: {"; ".join(found)}'

    def _time_without_column(self) -> dict[str, Any]:
        """Return what the map says of the time of a log whose time is not read."""
        if math.isfinite(self.head.period) and not self.not_times:
            self.step = self.head.period
            self._set_epoch('the log has no time that is read')
            row = f' in line {self.head.period_row}' if self.head.period_row else ''
            self.notes.append(f'the head states a period of {self.step:g} s{row}')
            return {'rate_Hz': float(f'{1.0 / self.step:.9g}')}
        motions = {
            name: self._motion(name)
            for name, chosen in self.axes.items()
            if {'speed', 'position'} <= set(chosen)
            and {self._unit(name, kind) for kind in ('speed', 'position')}
            <= set(conversions.LINEAR_SPEED_UNITS | LINEAR_POSITION_UNITS)
        }
        found = estimates.period(list(motions.values()))
        why = '; '.join(self.not_times or ['no column is named as a time', *self._rising()])
        if unclear := self.head.unclear_period:
            why += (
                f'; the head says {short(repr(unclear))}, which may be the time of something else '
                'than rows'
            )
        if math.isfinite(found):
            why += (
                f'; at {1.0 / found:.3g} Hz the speeds of axes {", ".join(motions)} make their '
                'positions best'
            )
        self.unstated.append(f'state time.rate_Hz in the map, the rows in a second: {why}')
        self._set_epoch('the log has no time that is read')
        return {'rate_Hz': None}

    def _rising(self) -> Iterator[str]:
        """Yield which columns may be a time by their first cells, though not by their names."""
        head = self.source.first_rows()
        for one in self.named:
            if one.column in self.data:
                continue
            cells = Cells(self.path, one.column)
            with contextlib.suppress(InputError):
                cells.add(head[one.column])
                values = cells.reading().numbers(head[one.column])
                if len(values) > 1 and (np.diff(values) > 0.0).all():
                    cell = short(repr(head[one.column][0]))
                    yield (
                        f'column {short(repr(one.column))} rises from {cell} in row '
                        f'{self.first_row} on'
                    )

    def _motion(self, name: str) -> tuple[Array, Array]:
        """Return positions [m] and speeds [m/s] of an axis."""
        chosen = self.axes[name]
        position, speed = (self.data[chosen[kind].column] for kind in ('position', 'speed'))
        return (
            position * LINEAR_POSITION_UNITS[self._unit(name, 'position')],
            speed * conversions.LINEAR_SPEED_UNITS[self._unit(name, 'speed')],
        )

    def _unit(self, name: str, kind: str) -> str:
        """Return the unit of an input as the map says or assumes it, or as it would agree."""
        if unit := self.unitless.get(name, {}).get(kind):
            return unit
        assumed = self.assumed.get(f'{name}.{kind}.unit', {}).get('value', '')
        return str(self.used[name][kind].get('unit', assumed) or '')

    def _fill(self, name: str, time: str) -> None:
        """Let the map say of an axis what its columns and their numbers tell."""
        chosen = self.axes[name]
        used = self.used[name] = {
            kind: {'column': chosen[kind].column}
            | ({'scale': chosen[kind].scale} if chosen[kind].scale != 1.0 else {})
            for kind in INPUTS
            if kind in chosen and self._is_used(chosen[kind])
        }
        self._forget_unitless(name)
        way = self._way_per_speed(name)
        self.ways[name] = abs(way)
        self._compare(name)
        if way < 0.0 and 'speed' in used:
            used['speed']['scale'] = None
            columns = (used[kind]['column'] for kind in MOTION)
            self.unstated.append(unclear_direction(name, *columns))
        for kind in used:
            self._set_unit(name, kind)
            self._set_marks(name, kind)
            self._set_magnitude(name, kind)
            group = self.groups.get(used[kind]['column'], time)
            used[kind] |= {'time': group} if group != time else {}
            self._say_time(name, kind, time)
        for key, value in (('screw', SCREW), ('oil', OIL)):
            stated = self._statement(key) or 'the log does not say it'
            self._assume(f'{name}.{key}', value, f'{stated}; the shipped one')
        self._set_lead(name)
        self._set_load(name)
        self._ask_for_gear(name)
        if 'torque' in used and self._unit(name, 'torque') == RATED:
            self._state_motor(name, 'torque')
        if 'temperature' in used:
            self._set_oil(name, used['temperature'])
        else:
            why = 'no column is the oil temperature of this axis'
            self._set_by_head(name, 'temperature_degC', TEMPERATURE, why)
        if 'speed' in used and not self._is_decimal_open():
            speeds = self.extremes[used['speed']['column']]
            unit = self._unit(name, 'speed')
            self.notes += estimates.oddities(name, speeds, unit, conversions.LINEAR_SPEED_UNITS)
        self._assume_direction(name)
        self._ask_for_gaps(name)
        self._ask_for_columns(name)

    def _ask_for_gaps(self, name: str) -> None:
        """Let the map say whether values stay in gaps, where the speed is the same after them."""
        used = self.used[name]
        if 'speed' not in used or self.clock is None:
            return
        column = used['speed']['column']
        if not stays_in_gaps(self._clock(column), self.data[column]):
            return
        for kind in [kind for kind in ('speed', 'load', *MOTOR) if 'column' in used.get(kind, {})]:
            used[kind]['hold'] = None
        self.unstated.append(unclear_gaps(name, 'speed', column))

    def _assume_direction(self, name: str) -> None:
        """Assume of a speed of one sign without a position that it is of one direction."""
        speed = self.used[name].get('speed')
        if speed and 'position' not in self.used[name]:
            least, most = self.extremes[speed['column']]
            if least * most >= 0.0 and most > least and not {'magnitude', 'backward'} & set(speed):
                self._assume(
                    f'{name}.speed.magnitude',
                    False,
                    f'{speed["column"]} never changes its sign, and no position tells whether it '
                    'has one: all motion is taken to be in one direction',
                )

    def _ask_for_columns(self, name: str) -> None:
        """Let the map name the column of a quantity that several may be."""
        for kind, one in self.axes[name].items():
            if kind not in self.used[name] or kind == 'temperature':
                continue
            others = [
                other.column
                for other in names.rivals(self.by_axis[name], one)
                if not estimates.is_silent(self.extremes.get(other.column, np.ones(1)))
                and not (names.may_agree(one, other) and self._agree(one, other))
            ]
            if others:
                self.used[name][kind]['column'] = None
                self.unstated.append(
                    f'state axes.{name}.{kind}.column in the map: '
                    f'{" or ".join([one.column, *others])}'
                )

    def _agree(self, one: Named, other: Named) -> bool:
        """Return True if two columns of one unit hold the same but for an offset, or no number."""
        if other.column not in self.data:
            return True
        columns = self.sampled[one.column], self.sampled[other.column] * other.scale
        if not (np.isfinite(columns[0]) & np.isfinite(columns[1])).any():
            columns = self.extremes[one.column], self.extremes[other.column] * other.scale
        ways = [
            float(np.nanmax(each) - np.nanmin(each)) for each in (*columns, np.subtract(*columns))
        ]
        return ways[2] <= SAME_WAY * max(ways)

    def _say_time(self, name: str, kind: str, time: str) -> None:
        """Say of an input that it has another time than the first, and ask if it may have."""
        place = self.used[name][kind]
        column, own = place['column'], place.get('time', time)
        if self.idle_times:
            place['time'] = None
            self.unstated.append(
                f'state axes.{name}.{kind}.time in the map, {" or ".join(self.idle_times)}, the '
                f'time of {column}: the order of columns does not tell'
            )
            return
        if not own or names.base_of(own) == names.base_of(time):
            return
        if column not in self.unclear_times:
            self.notes.append(
                f'axis {name}: {short(column)} has the times of {short(own)}, which stands '
                'before it'
            )
            return
        place['time'] = None
        self.groups.pop(column)
        if NO_NAME.fullmatch(own):
            self.unstated.append(
                f'state axes.{name}.{kind}.time in the map, {time} or {own}: {column} stands '
                f'behind {own}, which has no name and may hold its times'
            )
            return
        self.unstated.append(
            f'state axes.{name}.{kind}.time in the map, {time} if {column} has the times of its '
            f'row: it stands behind {own}, which has another unit or other years than {time}; '
            'where these are its times, give both in one unit'
        )

    def _is_used(self, one: Named) -> bool:
        """Tell whether a column says something: a force or current of nothing but 0 is unknown."""
        silent = estimates.is_silent(self.extremes[one.column])
        return one.kind in ('speed', 'position') or not silent

    def _forget_unitless(self, name: str) -> None:
        """Leave out torques and currents of an unknown unit but for that which tells the load."""
        used, chosen = self.used[name], self.axes[name]
        source = next((kind for kind in ('load', *MOTOR) if kind in used), '')
        for kind in MOTOR:
            if kind not in used or kind == source or chosen[kind].unit:
                continue
            column, values = chosen[kind].column, self.extremes[chosen[kind].column]
            if column in self.joints and self._unit_of_joint(name, kind, values):
                continue
            used.pop(kind)
            self.notes.append(
                f'axis {name}: {column} states no unit that is known, and {chosen[source].column} '
                f'tells the load: it is left out; state `{kind}: {{column: {column}, unit: '
                f'{next(iter(UNITS[kind]))}}}` in the map to read it'
            )

    def _set_unit(self, name: str, kind: str) -> None:
        place, stated = self.used[name][kind], self.axes[name][kind].unit
        if 'unit' in place:
            return
        if stated:
            place['unit'] = stated
            return
        values = self.extremes[place['column']]
        if place['column'] in self.joints and (unit := self._unit_of_joint(name, kind, values)):
            why = 'positions of joints are in rad or m, and none is so large in m'
        elif kind == 'position' and name in self.unitless:
            place['unit'] = None  # which is asked for with that of the speed
            return
        elif kind == 'position':
            unit, why = self._unit_of_position(name, place['column'])
        elif kind == 'speed' and (turning := names.turning_unit(place['column'])):
            unit, why = turning, 'its name is that of a turning speed'
        elif kind == 'speed':
            unit, why = self._unit_of_speed(name, place['column'])
        elif kind == 'load':
            unit, why = '', self._unit_of_load(name)
        elif kind in MOTOR:
            unit = ''
            why = f'{place["column"]} states none that is known, and tells the load'
        elif kind == 'temperature' and words_of(place['column'])[-1:] == ['f']:
            unit, why = '', f'{place["column"]} may be in degF: unit degC, {OF_DEGF}'
        elif kind == 'temperature' and np.nanmin(values) > TEMPERATURE * 5:
            unit, why = 'K', f'its least is {np.nanmin(values):.3g}'
        else:
            unit, why = next(iter(UNITS[kind])), 'the usual one'
        if not unit:
            place['unit'] = None
            units = f', {" or ".join(UNITS[kind])}' if kind not in MOTION else ''
            self.unstated.append(f'state axes.{name}.{kind}.unit in the map{units}: {why}')
            return
        self._assume(
            f'{name}.{kind}.unit', unit, f'{place["column"]} states none that is known; {why}'
        )

    def _set_magnitude(self, name: str, kind: str) -> None:
        """Say of a column of one sign whether it holds amounts, or let the map say it."""
        chosen, place = self.axes[name], self.used[name][kind]
        if kind not in SIGNED or 'backward' in place:
            return
        data = {
            each: self._places(self.used[name][each]['column'], chosen[each].unit, self.sampled)
            for each in (*MOTION, *SIGNED)
            if each in self.used[name]
        }
        columns = (self.used[name][each]['column'] for each in {*MOTION, kind} & set(data))
        magnitude = are_amounts(
            kind,
            data,
            makes_load='load' not in self.used[name],
            own_time=len({*map(self.groups.get, columns)}) > 1,
        )
        program = self.head.program
        if magnitude is None and kind in MOTOR and program and program.are_amounts:
            magnitude = True
        if magnitude is None:
            place['magnitude'] = None
            motion = chosen.get('speed') or chosen['position']
            apart = kind in MOTOR and are_apart(self.table, place['column'], motion.column)
            self.unstated.append(unclear_sign(name, kind, place['column'], apart=apart))
        elif magnitude:
            place['magnitude'] = True
            self.notes.append(of_amounts(name, kind, place['column']))
        elif kind in MOTOR and 'load' not in self.used[name] and not self._is_apart(name, kind):
            speed = data['speed'] if 'speed' in data else slopes(data['position'])
            if brakes_always(data[kind], speed):
                scale, place['scale'] = chosen[kind].scale, None
                self.unstated.append(unclear_brake(name, kind, place['column'], scale))

    def _is_apart(self, name: str, kind: str) -> bool:
        """Return True if a column of an axis may have other times than its motion."""
        one, motion = (
            self.axes[name].get(each) or self.axes[name]['position'] for each in (kind, 'speed')
        )
        groups = {self.groups.get(each.column, '') for each in (one, motion)}
        return len(groups) > 1 or are_apart(self.table, one.column, motion.column)

    def _unit_of_load(self, name: str) -> str:
        """Return why the unit of a force is open, and what the load may be of instead."""
        chosen, column = self.axes[name], self.used[name]['load']['column']
        instead = ''
        for kind in [one for one in MOTOR if one in chosen and self._is_used(chosen[one])][:1]:
            other, unit = chosen[kind].column, chosen[kind].unit or next(iter(UNITS[kind]))
            instead = (
                f'; or write `load: {{from: {kind}}}` and `{kind}: {{column: {other}, unit: '
                f'{unit}}}` there, so that {other} tells the load'
            )
        largest = float(np.nanmax(np.abs(self.extremes[column])))
        if words_of(column)[-1:] == ['a'] and not instead:
            instead = (
                f'; or if its A means ampere, write `load: {{from: current}}` and `current: '
                f'{{column: {column}, unit: A}}` there'
            )
        return (
            f'{column} states none that is known, and forces of up to {largest:.3g} may be in '
            f'any{instead}'
        )

    def _unit_of_joint(self, name: str, kind: str, values: Array) -> str:
        """Return the unit of a joint that turns, empty if it may slide."""
        position = self.axes[name].get('position')
        turns = position is not None and np.ptp(self.extremes[position.column]) > TURNS
        return (
            {'position': 'rad', 'speed': 'rad/s', 'torque': 'N m'}.get(kind, '') if turns else ''
        )

    def _unit_of_speed(self, name: str, column: str) -> tuple[str, str]:
        """Return the unit of a speed and why, or no unit and why the map must state it."""
        largest = float(np.nanmax(np.abs(self.extremes[column])))
        if 'position' not in self.used[name]:
            none = f'{column} states none that is known, and no position tells it'
            return '', f'{none}; its largest amount is {largest:.3g}'
        position = self.axes[name]['position']
        unit = position.unit or estimates.position_unit(self.extremes[position.column])[0]
        of_screw = unit in conversions.ROTARY_POSITION_UNITS
        factor = self.ways[name] * conversions.POSITION_UNITS[unit]
        if math.isnan(factor):
            return estimates.largest_speed_unit(largest)
        fitting = estimates.unit_by_factor(factor, SPEED_UNITS[of_screw])
        if fitting and (position.unit or self._is_metric()):
            return fitting, 'it agrees with the position over time'
        if fitting:
            self.unitless[name] = {'position': unit, 'speed': fitting}
            return '', (
                f'neither {column} nor {position.column} states one; they agree in {fitting} and '
                f'{unit}, and so they do in inches or turns: state that of the position, too'
            )
        leads = _leads(factor, of_screw=of_screw)
        told = f'{factor:.3g} {"rad" if of_screw else "m"} in a second for each of it'
        may = f', as it would in {" or ".join(leads)}' if leads else ''
        return '', f'{column} states none that is known, and {position.column} moves {told}{may}'

    def _unit_of_position(self, name: str, column: str) -> tuple[str, str]:
        """Return the unit of a position and why, or no unit and why the map must state it."""
        speed, way = self.axes[name].get('speed'), self.ways[name]
        if speed is None and not self._is_metric():
            return '', f'{column} states none that is known, and no speed tells it'
        if speed is None or not speed.unit or math.isnan(way):
            return estimates.position_unit(self.extremes[column])
        per_unit = conversions.SPEED_UNITS[speed.unit] / way
        of_screw = speed.unit in conversions.ROTARY_SPEED_UNITS
        if fitting := estimates.unit_by_factor(per_unit, POSITION_UNITS[of_screw]):
            return fitting, 'it agrees with the speed over time'
        least, most = LEADS
        for unit, metres in LINEAR_POSITION_UNITS.items():
            if of_screw and least <= (lead := TURN * metres / per_unit) <= most:
                return unit, f'it agrees with the speed at a lead of {lead * MILLI:.3g} mm'
        return '', (
            f'{column} states none that is known, and moves by {way:.3g} in a second for each '
            f'{speed.unit} of {speed.column}'
        )

    def _is_metric(self) -> bool:
        """Return True if the program that wrote the log has lengths in metres and their parts."""
        return bool(self.head.program and self.head.program.metric)

    def _way_per_speed(self, name: str) -> float:
        """Return how far a position moves in a second for each of its speed, NaN if not alike."""
        used = self.used[name]
        if not set(MOTION) <= set(used):
            return math.nan
        speed, position = (used[kind]['column'] for kind in MOTION)
        clocks = [self._clock(column) for column in (position, speed)]
        if not all(map(len, clocks)):
            return math.nan
        places = self._places(position, self.axes[name]['position'].unit, self.data)
        return estimates.way_per_speed((clocks[0], places), (clocks[1], self.data[speed]))

    def _compare(self, name: str) -> None:
        """Leave out a command that the position does not follow, and ask for another unit."""
        chosen, way = self.axes[name], self.ways[name]
        if math.isnan(way):
            self._ask_which_moves(name)
            return
        if not all(chosen[kind].unit for kind in MOTION):
            return
        speed, position = (chosen[kind] for kind in MOTION)
        of_screw = speed.unit in conversions.ROTARY_SPEED_UNITS
        if of_screw != (position.unit in conversions.ROTARY_POSITION_UNITS):
            return
        factor = way * conversions.POSITION_UNITS[position.unit]
        factor /= conversions.SPEED_UNITS[speed.unit]
        if abs(factor - 1.0) < estimates.NEAR:
            return
        why = f'{position.column} moves {factor:.3g} times as far as {speed.column} says'
        if speed.rank < 0:
            del self.used[name]['speed'], chosen['speed']
            self.ways[name] = math.nan
            self.notes.append(f'axis {name}: {why}, a command: {OF_SLOPE}')
            return
        self.used[name]['speed']['unit'] = None
        self.unstated.append(f'state axes.{name}.speed.unit in the map: {why} in {speed.unit}')

    def _ask_which_moves(self, name: str) -> None:
        """Let the map choose between a speed and a position that is not its integral."""
        used = self.used[name]
        if not set(MOTION) <= set(used):
            return
        columns = [used[kind]['column'] for kind in MOTION]
        if all(len(self._clock(one)) and np.ptp(self.extremes[one]) for one in columns):
            used['speed']['unit'] = None
            self.unstated.append(
                f'state axes.{name}.speed.unit in the map: {columns[1]} does not move as '
                f'{columns[0]} says; take one of both out of the map if it is wrong'
            )

    def _set_lead(self, name: str) -> None:
        """Assume the lead of the usual screw; where the log has another the map states it."""
        usual, lead = _usual_lead(), self._lead(name)
        why = f'the log does not say it; that of {SCREW}'
        stated = self.head.machine.get('lead_mm')
        if stated and not abs(lead * MILLI / stated.value - 1.0) > SAME_LEAD:
            self._set_by_head(name, 'lead_mm', math.nan, '')
            return
        if stated:
            self.used[name]['lead_mm'] = None
            self.unstated.append(
                f'state axes.{name}.lead_mm in the map: {self._statement("lead_mm")}, while '
                f'position and speed agree at {lead * MILLI:.3g} mm'
            )
            return
        if abs(lead / usual - 1.0) <= SAME_LEAD:
            why = f'that of {SCREW}, at which position and speed agree'
        elif math.isfinite(lead):
            self.used[name]['lead_mm'] = None
            self.unstated.append(
                f'state axes.{name}.lead_mm in the map: {self.axes[name]["position"].column} and '
                f'{self.axes[name]["speed"].column} agree at {lead * MILLI:.3g} mm; behind a gear '
                'a scale makes of either that of the screw'
            )
            return
        self._assume(f'{name}.lead_mm', float(f'{usual * MILLI:.6g}'), why)

    def _statement(self, key: str) -> str:
        """Return the line of the head that says something of the machine, empty for none."""
        stated = self.head.machine.get(key)
        return f'the head says {short(repr(stated.text))}' if stated else ''

    def _set_by_head(self, name: str, key: str, usual: float, why: str) -> None:
        """Take a number from the head if it is clear, ask if it is not, else assume the usual."""
        stated = self.head.machine.get(key)
        if stated is None:
            self._assume(f'{name}.{key}', usual, why)
        elif math.isfinite(stated.value) and len(self.axes) == 1:
            self._assume(f'{name}.{key}', stated.value, self._statement(key))
        else:
            self.used[name][key] = None
            self.unstated.append(f'state axes.{name}.{key} in the map: {self._statement(key)}')

    def _ask_for_gear(self, name: str) -> None:
        """Let the map scale what may be of the motor where the head states a gear."""
        stated, used = self.head.machine.get('gear'), self.used[name]
        if stated is None:
            self._assume_no_gear(name)
        if stated is None or stated.value == 1.0:
            return
        for kind in (*MOTION, *MOTOR):
            unit = self._unit(name, kind) if kind in used else ''
            turns = unit in (*conversions.ROTARY_POSITION_UNITS, *conversions.ROTARY_SPEED_UNITS)
            makes_load = kind in MOTOR and 'load' in used and used['load'].get('from') == kind
            if turns or (kind in used and (makes_load or 'load' not in used)):
                used[kind]['scale'] = None
                self.unstated.append(
                    f'state axes.{name}.{kind}.scale in the map, what makes '
                    f'{used[kind]["column"]} that of the screw, 1 if it is: '
                    f'{self._statement("gear")}'
                )

    def _assume_no_gear(self, name: str) -> None:
        """Assume of the turning speed of a motor, without a position, that the screw turns so."""
        speed = self.used[name].get('speed')
        if speed is None or 'position' in self.used[name] or 'scale' in speed:
            return
        if 'motor' in words_of(speed['column']) and (
            self._unit(name, 'speed') in conversions.ROTARY_SPEED_UNITS
        ):
            why = f'{speed["column"]} is of the motor, taken to drive the screw without a gear'
            self._assume(f'{name}.speed.scale', 1.0, why)

    def _lead(self, name: str) -> float:
        """Return the lead [m] by which the speed of a screw makes a position, NaN: not known."""
        way = self.ways[name]
        units = [self._unit(name, kind) for kind in MOTION if kind in self.used[name]]
        if math.isnan(way) or not all(units):
            return math.nan
        speed, position = units
        of_screw = speed in conversions.ROTARY_SPEED_UNITS
        if of_screw == (position in conversions.ROTARY_POSITION_UNITS):
            return math.nan
        factor = way * conversions.POSITION_UNITS[position] / conversions.SPEED_UNITS[speed]
        return TURN * factor if of_screw else TURN / factor

    def _clock(self, column: str) -> Array:
        """Return the times of the rows of a column [s], none where they are not known."""
        if self.clock is None:
            count = len(self.data[column]) if math.isfinite(self.head.period) else 0
            return np.arange(count, dtype=np.float64) * self.head.period
        time, times, unit = self.clock
        own = self.groups.get(column, time)
        times = times if own == time else self.data[own] * unit
        if (np.diff(times) == 0.0).any():  # rows share times, and will be spread
            return times[0] + np.arange(len(times)) * _period(times)
        return times

    def _places(self, column: str, unit: str, rows: Mapping[str, Array]) -> Array:
        """Return positions, whole turns counted where they are those of a scale of one turn."""
        turn = TURN / conversions.ROTARY_POSITION_UNITS.get(unit, math.nan)
        if estimates.is_within_turn(self.extremes[column], turn):
            return estimates.Turns(turn).counted(rows[column])
        return rows[column]

    def _set_oil(self, name: str, place: dict[str, Any]) -> None:
        """Say of a temperature that does not say so that it is taken for that of the oil."""
        if not names.is_of_the_screw(place['column']):
            column = place.pop('column')
            self._assume(f'{name}.temperature.column', column, 'taken for that of the oil')

    def _set_load(self, name: str) -> None:
        used, chosen = self.used[name], self.axes[name]
        if 'load' in used:
            return
        source = next((kind for kind in ('torque', 'current') if kind in used), '')
        if source:
            self._assume(f'{name}.load.from', source, f'no force is in the log; {FORCE}')
            self._assume(f'{name}.efficiency', EFFICIENCY, 'usual for a ball screw')
            if source == 'current':
                self._state_motor(name, source)
            return
        silent = [chosen[kind].column for kind in ('load', 'torque', 'current') if kind in chosen]
        lost = [f'{", ".join(self.lost[name])} holds no number'] if self.lost[name] else []
        still = [f'{", ".join(silent)} is always 0'] if silent else []
        doubtful = [
            f'{one.column} is in {unknown_unit(one.column, one.doubtful)}, which is no unit of a '
            f'{one.doubtful}'
            for one in self.named
            if one.doubtful in ('load', *MOTOR)
            and one.axis in ('', *(each.axis for each in chosen.values()))
        ]
        why = ', '.join([*lost, *still, *doubtful]) or 'no force, torque or current'
        used['load'] = {'unknown': why}
        self.notes.append(f'axis {name}: the load is not known ({why}), nothing will be judged')

    def _state_motor(self, name: str, kind: str) -> None:
        """Assume what makes a torque of a current; ask for the rated torque of one in %."""
        if self._unit(name, kind) != RATED:
            why = 'the log does not say it; it is on the plate of the motor'
            self._set_by_head(name, 'torque_constant_Nm_per_A', TORQUE_CONSTANT, why)
            return
        self.used[name]['torque_rated_Nm'] = None
        self.unstated.append(
            f'state axes.{name}.torque_rated_Nm in the map, the torque at the screw of 100 %: '
            f'{self.axes[name][kind].column} is in % of it, and it is on the plate of the motor'
        )

    def _ask_for_factors(self) -> None:
        """Let the map say what scales the columns of a head that states factors."""
        if not self.head.factors:
            return
        self.unstated.append(unclear_factors(self.head.factors))
        for name, used in self.used.items():
            for kind in filter(used.__contains__, INPUTS):
                if 'column' in used[kind]:
                    if scale := used[kind].get('scale'):
                        self.unstated.append(
                            f'axes.{name}.{kind}.scale is times {scale:g}, for the unit of '
                            f'{used[kind]["column"]}'
                        )
                    used[kind]['scale'] = None

    def _say_what_is_joined(self) -> None:
        """Say of signals that hold words such as NaN in the rows of each other what to write."""
        unknown = {
            one.column: np.isnan(self.data[one.column])
            for chosen in self.axes.values()
            for one in chosen.values()
            if self.table.readings[one.column].note
        }
        for (name, rows), (other, others) in itertools.combinations(unknown.items(), 2):
            if min(rows.mean(), others.mean()) > 1.0 / MANY and (rows & others).mean() < APART:
                self.notes.append(
                    f'{short(name)} and {short(other)} hold no number in the rows of each other, '
                    'as joined tables do: leave those cells empty, for a word there is a number '
                    'that is not known'
                )
                return

    def _say_what_is_left_out(self, time: Mapping[str, Any]) -> None:
        used = {
            axis[kind].get('column')
            for axis in self.used.values()
            for kind in INPUTS
            if kind in axis
        }
        used |= {entry['value'] for entry in self.assumed.values()} | set(time.values())
        used |= set(self.groups.values()) | set(self.mark_cells)
        self.notes += names.left_out([one for one in self.named if one.column not in used])


@functools.cache
def _usual_lead() -> float:
    """Return the lead [m] of the screw that is assumed."""
    return Surface.load(find_surface('', SCREW, OIL), screw=SCREW, oil=OIL).lead


def _period(times: Array) -> float:
    """Return the usual time between rows, which may share times."""
    steps = np.diff(times)
    rising = steps[steps > 0.0]
    changes = np.diff(np.flatnonzero(steps > 0.0))
    share = float(np.median(changes)) if len(changes) else 1.0
    return float(np.median(rising)) / share if len(rising) else math.nan


def _leads(factor: float, *, of_screw: bool) -> list[str]:
    """Return the units of a speed with the leads at which it makes its position."""
    leads = {
        unit: of / factor * TURN if of_screw else factor * TURN / of
        for unit, of in SPEED_UNITS[not of_screw].items()
    }
    least, most = LEADS
    return [
        f'{unit} at a lead of {lead * MILLI:.3g} mm'
        for unit, lead in leads.items()
        if least <= lead <= most
    ]


def _rates(step: float) -> str:
    """Return the rates that a step between rows makes in those units of a time that may be."""
    told = [
        f'{unit} {1.0 / (step * factor):.3g} Hz'
        for unit, factor in conversions.TIME_UNITS.items()
        if 0.95 / RATE <= step * factor <= 1.0 / estimates.SLOWEST
    ]
    return f': in {", in ".join(told)}' if told else ''
