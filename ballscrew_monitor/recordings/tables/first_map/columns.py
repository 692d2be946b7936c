# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Columns of a log that may be inputs of axes or times: their names, marks and numbers."""

from collections.abc import Mapping
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.core.conversions import ROTARY_POSITION_UNITS
from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.amounts import fault_of_speed
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.doubts import of_slope
from ballscrew_monitor.recordings.tables.heads import Head, NO_NAME
from ballscrew_monitor.recordings.tables.interleaved import (
    cells_of_sources,
    column_of_sources,
    of_several,
)
from ballscrew_monitor.recordings.tables.marked import look_at_marks
from ballscrew_monitor.recordings.tables.marks import backward_cells, Mark, Marks, valid_cells
from ballscrew_monitor.recordings.tables.names import Named, read_name
from ballscrew_monitor.recordings.tables.quantities import MOTION
from ballscrew_monitor.recordings.tables.read import look_through
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.recordings.tables.stated_rate import twin_times
from ballscrew_monitor.recordings.tables.unit_names import words_of
from ballscrew_monitor.recordings.words import listed, Shown
from surrogate.files import InputError
from surrogate.units import TURN

EPOCH = '2000-01-01T00:00:00Z'
SEPARATED_BY = {';': 'semicolons', ',': 'commas', '\t': 'tabs', '|': 'bars', ' ': 'blanks'}
ORDER_OR_SIGN = ('.', ',', 'order')
FEW_NAMED = 3  # parts of a file that are not read
BY_HAND = (
    'a map may name one, such as `axes: {x: {speed: {column: ..., unit: mm/s}, lead_mm: 10.0}}`'
)
JOINT = re.compile(
    r'(?P<before>.*?)(?P<field>name|position|velocity|effort)(?P<number>\[?_?\d+\]?)$'
)
"""A column of the arrays of joint states."""


class Columns:
    """
    Columns of a log, the more likely ones of which are looked through.

    `times` may be the time; `axes` has the columns of each axis by what they are, `by_axis` all
    that may be; `joints` are named by the cells of others. `marks` says what a map says of the
    marks of each input, `mark_cells` the cells of these. `data` are the first rows, `sampled` rows
    that span the log, since signs may be seen late, and `extremes` the least and the most. `none`
    are the numbers of inputs that may stand for no value, `twins` columns of one name that
    rise evenly. `not_times` says why columns are no time, `lost` which of an axis hold no number;
    `doubts` are the decimal sign or the `order` of dates that the log does not show, `unclear`
    says so.

    """

    def __init__(self, path: Path, most: int, shown: Shown) -> None:
        """
        Look through a log, of which about so many numbers are in memory; show how far that is.

        Raises InputError when it has no speed.

        """
        self.path, self.source = path, source_of(path)
        self.head = self.source.head
        if not self.head.named:
            raise InputError(_unnamed(path, self.head))
        self._choose()
        self._look_at_sources()
        self.mark_cells: dict[str, list[str]] = {}
        self.marks = self._marks()
        self._look_through(most, shown)
        self._forget_texts()
        for name, chosen in self.axes.items():
            if set(MOTION) <= set(chosen):
                speed, position = (chosen[kind].column for kind in MOTION)
                extremes = self.extremes[speed], self.extremes[position]
                if fault := fault_of_speed(*extremes, self.sampled[position]):
                    chosen.pop('speed')
                    self.notes.append(of_slope(name, speed, fault))

    @property
    def inputs(self) -> list[Named]:
        """Return the columns of all axes."""
        return [one for chosen in self.axes.values() for one in chosen.values()]

    @property
    def is_decimal_open(self) -> bool:
        """Return True if the decimal sign is to be stated, so that no number is known."""
        return '.' in self.doubts or ',' in self.doubts

    @property
    def is_metric(self) -> bool:
        """Return True if the program that wrote the log has lengths in metres and their parts."""
        return bool(self.head.program and self.head.program.metric)

    def unit_of_program(self, one: Named) -> str:
        """Return the unit of a time that the program writes which made the table, or nothing."""
        program = self.head.program
        if program is None:
            return ''
        labelled = program.labelled if one.column in self.head.labelled else ''
        return dict(program.times).get(names.base_of(one.column.split(' [')[0]), labelled)

    def stands_unnamed(self, one: Named) -> bool:
        """Return True for a column without a name that stands before or behind one of an input."""
        columns, at = self.source.names(), self.source.names().index(one.column)
        behind = at + 1
        after = [name for name in columns[behind:] if not NO_NAME.fullmatch(name)]
        is_index = at == 0 and after and read_name(after[0]).kind == 'time'
        return bool(NO_NAME.fullmatch(one.column)) and not is_index

    def places(self, column: str, unit: str, rows: Mapping[str, Array]) -> Array:
        """Return positions, whole turns counted where they are those of a scale of one turn."""
        turn = TURN / ROTARY_POSITION_UNITS.get(unit, math.nan)
        if estimates.is_within_turn(self.extremes[column], turn):
            return estimates.Turns(turn).counted(rows[column])
        return rows[column]

    def refuse_sources_in_turn(self, time: str, times: Array) -> None:
        """Raise InputError for rows of several sources that a column of any name tells apart."""
        used = {*(one.column for one in self.inputs), time, *self.mark_cells}
        if others := [name for name in self.source.names() if name not in used]:
            column, cells = column_of_sources(self.source.blocks(others), others, times)
            if column:
                raise InputError(f'log {self.path}: {of_several(column, cells)}')

    def _choose(self) -> None:
        """Choose the columns of the time and of each axis by their names."""
        texts = self._texts()
        named = [read_name(name, texts.get(name, '')) for name in self.source.names()]
        twins = twin_times(self.source)
        self.twins = {*twins}
        self.times = [
            one
            for at, one in enumerate(named)
            if (one.kind == 'time' and one.place in ('machine', 'axis'))
            or one.column in self.head.labelled
            or self.unit_of_program(one)
            or (at == 0 and not one.kind)
            or self.stands_unnamed(one)
            or one.column in twins
        ]
        self.named = [one for one in named if one not in self.times or one.kind == 'time']
        self.by_axis = names.by_axis([one for one in self.named if one.kind != 'time'])
        self.axes = {
            name: chosen
            for name, found in self.by_axis.items()
            if set(MOTION) & set(chosen := names.best(found))
        }
        if not self.axes:
            of_no_unit = names.unknown_units(self.named)
            unread = [f'not {name}, as {why}' for name, why in self.source.left_out.items()]
            held = [listed(self.source.names()), *unread[:FEW_NAMED], *(of_no_unit or [BY_HAND])]
            raise InputError(
                f'log {self.path}: no column looks like the speed or position of an axis, it '
                f'holds {"; ".join(held)}'
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

    def _look_at_sources(self) -> None:
        """
        Name the only axis by what tells it of all rows: a column, the sheet or the file.

        Raises InputError for rows of several axes or machines that a column tells apart.

        """
        told = cells_of_sources(self.source, {one.column for one in self.inputs})
        for column, cells in told.items():
            if len(cells) > 1:
                raise InputError(f'log {self.path}: {of_several(column, cells)}')
        texts = [*(cell for cells in told.values() for cell in cells), self.source.sheet]
        of_all = [*map(names.axis_of_all, texts), names.axis_of_file(self.path.stem)]
        name = next(filter(None, of_all), '')
        if name and not names.axis_names(self.named) and 'x' in self.axes:
            self.axes = {name: self.axes['x']}
            self.by_axis = {name: self.by_axis['x']}

    def _marks(self) -> dict[str, dict[str, dict[str, Any]]]:
        """Return what a map says of the marks of each input: their columns, and cells if clear."""
        held, inputs = self.source.names(), self.inputs
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

    def _look_through(self, most: int, shown: Shown) -> None:
        """Read the columns that may be inputs or times, by those marks that are clear."""
        clear = {
            column: Marks(
                **{role: Mark(**place) for role, place in places.items()}  # type: ignore[arg-type]
            )
            for column, places in self.marks.items()
            if places and all(place['cells'] is not None for place in places.values())
        }
        self.source, self.none = self.source.marked(clear), dict[str, Array]()
        self._read(most, shown)
        self.none = {
            one.column: self.data[one.column]
            for one in self.inputs
            if one.column in self.data and estimates.marks_of_none(self.data[one.column])
        }
        if self.none:
            without = {
                name: Marks(none=estimates.marks_of_none(values))
                for name, values in self.none.items()
            }
            self.source = self.source.marked(without)
            self._read(most, shown)
        for one in self.inputs:
            if one.column in self.data and one.scale != 1.0:
                for numbers in (self.data, self.sampled, self.extremes):
                    numbers[one.column] = numbers[one.column] * one.scale

    def _read(self, most: int, shown: Shown) -> None:
        """Read the columns that may be inputs or times, by the decimal sign that they show."""
        inputs = self.inputs
        others = [
            other
            for name, chosen in self.axes.items()
            for one in chosen.values()
            for other in names.rivals(self.by_axis[name], one)
            if names.may_agree(one, other)
        ]
        used = list(dict.fromkeys(one.column for one in [*inputs, *others, *self.times]))
        table = look_through(self.source, used, optional=used, shown=shown)
        self.unclear = list(table.doubts.values())[:1]
        self.doubts = [key for key in table.doubts if key in ORDER_OR_SIGN][:1]
        for key in self.doubts:
            decided = {'order': 'dmy'} if key == 'order' else {'decimal': key}
            table = look_through(self.source, used, **decided, optional=used, shown=shown)
        self.table, self.first_row = table, table.first_row
        rows = most // len(used)
        self.data = table.head(rows)
        self.sampled = {name: table.sampled(name) for name in table.readings}
        self.extremes = {name: one.extremes for name, one in table.readings.items()}
        self.timed = {name for name, one in table.readings.items() if one.is_time}
        kinds = {one.column: one.kind for one in self.times}
        self.not_times = [why for name, why in table.left_out.items() if kinds.get(name) == 'time']
        left_out = [why for name, why in table.left_out.items() if name not in kinds]
        self.notes = [
            *(f'{why}; it is left out' for why in left_out),
            *table.notes,
            *names.unknown_units(self.named),
            *names.told_by_words(self.named),
            *names.told_by_units(self.named),
        ]
        if rows < table.rows:
            self.notes.append(f'rate and units are those of the first {rows} of {table.rows} rows')

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
            if not set(MOTION) & set(left):
                self.axes.pop(name)
        if not self.axes:
            raise InputError(f'{"; ".join(self.notes)}; {BY_HAND}')


def _unnamed(path: Path, head: Head) -> str:
    """Return in a sentence how a map names the columns of a table without names."""
    count = len(head.names)
    between = SEPARATED_BY.get(head.separator, repr(head.separator))
    held = f'{count}, separated by {between}' if count > 1 else 'one'
    rate = f'{1.0 / head.period:g}' if math.isfinite(head.period) else '(rows in a second)'
    epoch = f"epoch: '{EPOCH}'"
    by_column = f' or `time: {{column: column 1, unit: s, {epoch}}}`' if count > 1 else ''
    loaded = (
        f'; of a force beside `load: {{column: column {count}, unit: N}}`, of a torque `torque: '
        f'{{column: column {count}, unit: N m}}, load: {{from: torque}}`'
        if count > 2
        else ''
    )
    return (
        f'log {path}: no line names its columns, of which it has {held}: a map calls them by '
        f'their numbers, such as `axes: {{x: {{position: {{column: column {min(count, 2)}, unit: '
        f'mm}}, lead_mm: 10.0}}}}`, with `time: {{rate_Hz: {rate}, {epoch}}}`{by_column}{loaded}'
    )
