# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The map of a table: which column is which input, and what the log itself does not say.

A value stands in its place, such as `axes: {x: {lead_mm: 10.0}}`, or with its reason under
`assumed`, such as `x.lead_mm: {value: 10.0, reason: ...}`; then it is told wherever the log is
judged.

"""

from collections.abc import Collection, Mapping
import dataclasses
import datetime
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag_files import is_table
from ballscrew_monitor.recordings.log_facts import Assumption
from ballscrew_monitor.recordings.tables.marks import Mark, Marks, plain_cell
from ballscrew_monitor.recordings.tables.quantities import (
    column_name,
    INPUTS,
    Layout,
    MOTION,
    ORDERS,
    OTHER_SIGN,
    RATED,
    UNITS,
)
from ballscrew_monitor.recordings.words import short
from ballscrew_monitor.settings.parameters import check_axes, MOTOR_TORQUE
from surrogate.files import InputError
from surrogate.files.limits import read_text
from surrogate.files.plain_yaml import plain_values
from surrogate.units import MICRO, MILLI

DERIVED = ('current', 'torque', 'motor_torque')
"""A load may be worked out from a current or torque, or by the node from the motor torque."""
MOTOR = ('torque', 'current')
NAMES = {'load': 'force', 'speed': 'speed'}
SIGNED = (*MOTOR, *NAMES)
"""Quantities whose sign decides, which some columns leave out."""
NUMBERS = {
    'lead_mm': (0.1, 1000.0),
    'torque_constant_Nm_per_A': (1e-6, 1e3),
    'torque_rated_Nm': (1e-6, 1e6),
    'efficiency': (0.1, 1.0),
    'torque_uncertainty_Nm': (1e-9, 1e6),
    'inertia_kg_m2': (0.0, 1e3),
    'temperature_degC': (-50.0, 200.0),
    'free_load_N': (-1e6, 1e6),
    'rate_Hz': (1e-3, 1e5),
}
"""Numbers of an axis, and of the time, with the least and the most allowed."""
LINES = {'skip': (0, 1000), 'header_rows': (0, 2)}
"""Numbers of lines, with the least and the most allowed."""
TEXTS = ('screw', 'oil', 'surface')
TOP_TEXTS = ('machine', 'date_from', 'decimal', 'sheet')
DATES = ('name', 'header', 'modified')
PLACES = {
    'decimal': "`'.'` or `','`: decimal sign of columns in which no cell shows it, as 5.400 may "
    'be 5400; the other sign parts thousands',
    'sheet': 'name of the sheet of a workbook; without it the first with a table is read',
    'skip': 'lines before the names of the columns, if these are not found by themselves',
    'header_rows': 'rows of names there: 2 with the units or parts of names below, 0 for a table '
    'without names, whose columns are `column 1`, `column 2` and so on',
    'machine': 'name of the machine, a text: its axes have one history, whatever folder holds a '
    'log',
    'date_from': 'instead of `time.epoch`: the date of the first row is that in the `name` of the '
    'file or else of its folder (2025-07-14, 20250714_115950, 14.07.2025), in its `header`, or '
    'that at which the file was `modified`; UTC',
    'time.column': 'column of the time, unit after `scale` and `offset`; dates and times of day '
    'are read as s, without a zone as UTC; a time of day goes on through midnight',
    'time.rate_Hz': 'instead of a column: rows at equal distances',
    'time.date': 'column of the days, if `column` holds the time of day',
    'time.order': '`dmy`, `mdy` or `ymd`: order of day, month and year in dates of numbers that '
    'may be read in several; it counts for cells, the head and names',
    'AXIS.QUANTITY.time': 'column of the time of a quantity that has one of its own, in the unit '
    'of `time`',
    'time.epoch': 'time of the first row, such as 2000-01-01T00:00:00Z; without it the column '
    'is a '
    'time since 1970',
    'AXIS.speed': 'column of the speed, of the nut in a linear unit or of the screw; this or '
    '`position`',
    'AXIS.position': 'column of the position; without a speed its slope replaces it',
    'AXIS.table_position': 'column of the position of the table by its own scale: beside '
    '`position`, that of the motor, it gives the lost motion at reversals',
    'AXIS.load': 'column of the force on the nut, positive along the axis; or `{from: current}`, '
    '`{from: torque}`, `{from: motor_torque}`, `{unknown: reason}`',
    'AXIS.torque': 'column of the torque at the screw, in N m or % of the rated one',
    'AXIS.current': 'column of the motor current, or % of the rated one',
    'AXIS.torque.magnitude': '`true` for amounts without a sign, which get that of the motion; '
    'also for `current`; needed only if the log does not show it',
    'AXIS.QUANTITY.valid': '`{column: ..., cells: [...]}`: column of qualities, and those of its '
    'cells in whose rows the quantity is valid; in others it is not known',
    'AXIS.QUANTITY.none': '`[-9999]`: numbers that stand for no value; `[]` if all of them are '
    'values; needed only if the log holds such as stand for none elsewhere',
    'AXIS.speed.backward': '`{column: ..., cells: [...]}`: column of directions, and those of its '
    'cells in whose rows the speed gets a minus',
    'AXIS.QUANTITY.hold': '`true` for values that were written when they changed: each stays '
    'until the next; `false` if nothing is known in gaps',
    'AXIS.load.magnitude': '`false` for a force with a sign, also for `speed`; needed only if the '
    'log does not show it',
    'AXIS.temperature': 'column of the oil temperature',
    'AXIS.lead_mm': 'lead of the screw; needed',
    'AXIS.torque_constant_Nm_per_A': 'for a load from the current',
    'AXIS.torque_rated_Nm': 'torque at the screw of 100 %',
    'AXIS.efficiency': 'for a load from current or torque: force = 2 pi x efficiency x torque / '
    'lead (1)',
    'AXIS.torque_uncertainty_Nm': 'for a load from `motor_torque`: half width of the range of '
    'the true torque',
    'AXIS.inertia_kg_m2': 'for a load from `motor_torque`: at the screw (0)',
    'AXIS.temperature_degC': 'oil temperature, if no column states it',
    'AXIS.free_load_N': 'for a load from `motor_torque`: load of motion without process force, '
    'positive '
    'along the axis (0)',
    'AXIS.always_free': 'for a load from `motor_torque`: `true` if the axis has no process '
    'force, so that '
    'its torque is friction',
    'AXIS.screw': 'as the parameter of the node',
    'AXIS.oil': 'as the parameter of the node',
    'AXIS.surface': 'as the parameter of the node',
    'parameters': 'any other parameter of the node, such as `x: {limits: {rcs: 0.02}}`',
}
"""Places of a map with their meaning, `AXIS` being the name of an axis."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Column:
    """
    A column: its name, its unit after factor and offset, and that of its time, if its own.

    `magnitude` says whether it holds amounts without a sign, None where that is not said; `marks`
    are the columns that say where it is valid, and where it goes backward; `hold` whether a value
    stays until the next one is written, None where that is not said. It `is_scaled` if a map says
    how, be it by 1.

    """

    name: str
    unit: str
    scale: float = 1.0
    offset: float = 0.0
    time: str = ''
    magnitude: bool | None = None
    marks: Marks = Marks()
    hold: bool | None = None
    is_scaled: bool = False


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisMap:
    """
    One axis: its columns by input, and what they are worked with.

    Lead [m], constant [N m/A] and rated torque [N m] of the motor, and oil temperature [degC], NaN
    where not said; efficiency [-]; half width of the range of the torque [N m], NaN where not
    said, and inertia [kg m2], for a load that the node works out; load [N] of motion free of
    process force, and whether all motion is; `load_from` says from what the load is; `unknown`
    says of an input why it is not known.

    """

    name: str
    columns: Mapping[str, Column]
    lead: float
    torque_constant: float
    torque_rated: float
    efficiency: float
    torque_uncertainty: float
    inertia: float
    temperature: float
    free_load: float
    always_free: bool
    load_from: str
    unknown: Mapping[str, str]
    texts: Mapping[str, str]

    def without(self, lost: Collection[str]) -> 'AxisMap':
        """Return it without the columns of some names, and without a load that was made of one."""
        held = {kind: one for kind, one in self.columns.items() if one.name not in lost}
        of = {'motor_torque': {'current', 'torque'}}.get(self.load_from, {self.load_from})
        source = self.load_from if of & set(held) else ''
        gone = [*(self.columns.keys() - held), *(['load'] if source != self.load_from else [])]
        unknown = dict.fromkeys(gone, 'its column holds no number')
        return dataclasses.replace(
            self, columns=held, load_from=source, unknown={**self.unknown, **unknown}
        )

    def motor_torque(self, kind: str) -> float:
        """Return the torque [N m] of one unit of its torque or current, NaN where not said."""
        unit = self.columns[kind].unit
        scale = self.torque_rated if unit == RATED else self.torque_constant
        return UNITS[kind][unit] * (1.0 if unit == 'N m' else scale)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class TableMap:
    """
    A checked map.

    Column of the time, or the rate [Hz] of a log without one; `date` names the column of the days
    whose times the other says, if there is one; epoch [ns] of the first row, None when the log
    tells it; `date_from` says where the date of the first row stands, if anywhere; `decimal` sign
    of numbers that may be read with either one, and `order` of day and month, empty where not
    said; `content` is the map as it was written.

    """

    layout: Layout | None
    sheet: str
    decimal: str
    order: str
    time: Column | None
    date: str
    rate: float
    epoch: int | None
    date_from: str
    axes: tuple[AxisMap, ...]
    assumptions: tuple[Assumption, ...]
    parameters: Mapping[str, Any]
    content: Mapping[str, Any]

    @property
    def columns(self) -> list[str]:
        """Return the names of all columns that are read."""
        chosen = [column.name for axis in self.axes for column in axis.columns.values()]
        return list(dict.fromkeys([*self.time_columns, *chosen]))

    @property
    def marks(self) -> dict[str, Marks]:
        """Return what marks the values of columns, by their names."""
        chosen = [column for axis in self.axes for column in axis.columns.values()]
        return {column.name: column.marks for column in chosen if column.marks != Marks()}

    @property
    def time_columns(self) -> list[str]:
        """Return the names of the columns of a time, that of a date after the first."""
        own = [column.time for axis in self.axes for column in axis.columns.values()]
        main = [self.time.name, self.date] if self.time else []
        return list(dict.fromkeys(filter(None, [*main, *own])))


def read_map(path: Path) -> TableMap:
    """Return the map in a file; raises InputError when it holds no map."""
    try:
        return _read(path)
    except InputError:
        if not is_table(path):
            raise
        raise InputError(
            f'map {path} is a table: ballscrew import {path} --guess > map.yaml prints its map'
        ) from None


def _read(path: Path) -> TableMap:
    try:
        content = plain_values(read_text(path))
    except (OSError, UnicodeDecodeError, InputError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'map {path} cannot be read: {reason}') from None
    try:
        return make_map(content)
    except InputError as error:
        raise InputError(f'map {path}: {error}') from None


def make_map(content: Any) -> TableMap:
    """Return a map made of its content; raises InputError when that is not right."""
    known = ('log', 'time', 'axes', 'assumed', 'parameters', *TOP_TEXTS, *LINES)
    _check_keys('the map', content, known)
    machine = content.get('machine', 'unnamed')
    if not isinstance(machine, str) or not machine.strip():
        raise InputError(f'machine is {machine!r}, it must be a text, the name of the machine')
    axes = content.get('axes')
    if not isinstance(axes, dict) or not axes:
        raise InputError('axes is missing, it must name at least one axis with its columns')
    check_axes([str(name) for name in axes])
    for name, section in axes.items():
        _check_keys(f'axis {name}', section, None)
    assumptions = _assumptions(content.get('assumed') or {})
    stated = _flatten(content.get('time') or {}, 'time') | _flatten(axes, '')
    values = _joined(stated, assumptions)
    epoch, date_from = values.pop('time.epoch', None), _date_from(content, stated)
    if date_from:  # an assumed epoch gives way
        epoch, assumptions = None, tuple(one for one in assumptions if one.key != 'time.epoch')
    time = _Part('time', values)
    mapping = TableMap(
        layout=_layout(content),
        sheet=_sheet(content),
        decimal=_decimal(content),
        order=time.order(),
        time=time.column('time', at='time'),
        date=column_name(time.text('date')),
        rate=time.number('rate_Hz'),
        epoch=None if epoch is None else _epoch(epoch),
        date_from=date_from,
        axes=tuple(_axis(str(name), values) for name in axes),
        assumptions=assumptions,
        parameters=_flatten(content.get('parameters') or {}, ''),
        content=content,
    )
    if mapping.time is None and math.isnan(mapping.rate):
        raise InputError('time is missing, it must name a column or a rate_Hz')
    if mapping.time is not None and not math.isnan(mapping.rate):
        raise InputError('time states both column and rate_Hz, one must go')
    if values:
        raise InputError(f'{next(iter(values))} is unknown')
    return mapping


def _date_from(content: Mapping[str, Any], stated: Mapping[str, Any]) -> str:
    """Return where a map says that the date of a log stands, empty where it does not."""
    place = content.get('date_from', '')
    if 'date_from' in content and place not in DATES:
        raise InputError(f'date_from is {_said(place)}, allowed are {", ".join(DATES)}')
    if place and 'time.epoch' in stated:
        raise InputError('date_from and time.epoch both date the first row, one must go')
    return str(place)


def _layout(content: Mapping[str, Any]) -> Layout | None:
    """Return where a map says that the names of the columns stand, None if it does not."""
    lines = {}
    for key, (low, high) in LINES.items():
        value = lines[key] = content.get(key, getattr(Layout(), key))
        if not (isinstance(value, int) and low <= value <= high) or isinstance(value, bool):
            raise InputError(f'{key} is {value!r}, it must be a whole number, {low} to {high}')
    return Layout(**lines) if set(LINES) & set(content) else None


def _sheet(content: Mapping[str, Any]) -> str:
    """Return the name of the sheet that a map states, empty for none."""
    name = content.get('sheet', '')
    if 'sheet' in content and not (isinstance(name, str) and name):
        raise InputError(f'sheet is {_said(name)}, it must be a text, the name of a sheet')
    return str(name)


def _decimal(content: Mapping[str, Any]) -> str:
    """Return the decimal sign that a map states, empty if it leaves that to the cells."""
    sign = content.get('decimal', '')
    if 'decimal' in content and sign not in tuple(OTHER_SIGN):
        raise InputError(f"decimal is {_said(sign)}, it must be '.' or ','")
    return str(sign)


class _Part:
    """The values below one name; each that is asked for is taken out."""

    def __init__(self, prefix: str, values: dict[str, Any]) -> None:
        self._prefix, self._values = prefix, values

    def take(self, name: str, default: Any = None) -> Any:
        return self._values.pop(f'{self._prefix}.{name}', default)

    def number(self, name: str, default: float = math.nan) -> float:
        value = self.take(name, default)
        low, high = NUMBERS[name]
        if value is not default and not (_is_number(value) and low <= value <= high):
            raise InputError(
                f'{self._prefix}.{name} is {_said(value)}, it must be a number from {low:g} to '
                f'{high:g}'
            )
        return float(value)

    def text(self, name: str, default: str = '') -> str:
        value = self.take(name, default)
        if not isinstance(value, str):
            raise InputError(f'{self._prefix}.{name} is {_said(value)}, it must be a text')
        return value

    def order(self) -> str:
        order = self.take('order', '')
        if order not in ('', *ORDERS):
            raise InputError(
                f'{self._prefix}.order is {_said(order)}, it must be {" or ".join(ORDERS)}'
            )
        return str(order)

    def flag(self, name: str, default: bool | None = False) -> bool | None:
        if f'{self._prefix}.{name}' not in self._values:
            return default
        value = self.take(name)
        if not isinstance(value, bool):
            raise InputError(f'{self._prefix}.{name} is {_said(value)}, it must be true or false')
        return value

    def numbers(self, name: str) -> tuple[float, ...] | None:
        """Return a list of numbers, None without one."""
        if f'{self._prefix}.{name}' not in self._values:
            return None
        values = self.take(name)
        if not isinstance(values, list) or not all(map(_is_number, values)):
            raise InputError(
                f'{self._prefix}.{name} is {_said(values)}, it must be a list of numbers'
            )
        return tuple(map(float, values))

    def mark(self, role: str) -> Mark | None:
        """Return the column that marks values, and its cells that do so."""
        column, cells = self.text(f'{role}.column'), self.take(f'{role}.cells', [])
        cells = cells if isinstance(cells, list) else [cells]
        if column and not all(isinstance(one, str | int | float) for one in cells):
            raise InputError(
                f'{self._prefix}.{role}.cells is {_said(cells[0])}, it must be a list of cells of '
                f'{column}'
            )
        plain = tuple(map(plain_cell, cells))
        if bool(column) != bool(plain):
            raise InputError(
                f'{self._prefix}.{role} must name a column and those of its cells that count'
            )
        return Mark(column=column_name(column), cells=plain) if column else None

    def column(self, kind: str, *, at: str = '') -> Column | None:
        """Return the column of a kind of quantity, `at` its place unless that is its name."""
        part = self if at else _Part(f'{self._prefix}.{kind}', self._values)
        name, units, time = part.text('column'), UNITS[kind], '' if at else part.text('time')
        unit = part.take('unit')
        magnitude = part.flag('magnitude', None) if kind in SIGNED else None
        if magnitude and kind not in MOTOR:
            raise InputError(
                f'{part._prefix}.magnitude is true, it must be false: amounts of a {NAMES[kind]} '
                'cannot be judged, name another column or none'
            )
        marks = Marks(
            valid=None if at else part.mark('valid'),
            backward=part.mark('backward') if kind == 'speed' else None,
            none=None if at else part.numbers('none'),
        )
        hold = None if at else part.flag('hold', None)
        is_scaled = f'{part._prefix}.scale' in part._values
        numbers = [part.take(key, default) for key, default in (('scale', 1.0), ('offset', 0.0))]
        if name and not (isinstance(unit, str) and unit in units):
            stated = 'missing' if unit is None else repr(unit)
            raise InputError(f'{part._prefix}.unit is {stated}, allowed are {", ".join(units)}')
        if not all(map(_is_number, numbers)) or not numbers[0]:
            raise InputError(
                f'{part._prefix}: scale and offset are {_said(numbers[0])} and '
                f'{_said(numbers[1])}, they must be numbers, the scale not 0'
            )
        if not name:
            return None
        scale, offset = map(float, numbers)
        return Column(
            name=column_name(name),
            unit=unit,
            scale=scale,
            offset=offset,
            time=column_name(time),
            magnitude=magnitude,
            marks=marks,
            hold=hold,
            is_scaled=is_scaled,
        )


def _axis(name: str, values: dict[str, Any]) -> AxisMap:
    part = _Part(name, values)
    columns = {kind: part.column(kind) for kind in INPUTS}
    axis = AxisMap(
        name=name,
        columns={kind: column for kind, column in columns.items() if column},
        lead=part.number('lead_mm') / MILLI,
        torque_constant=part.number('torque_constant_Nm_per_A'),
        torque_rated=part.number('torque_rated_Nm'),
        efficiency=part.number('efficiency', 1.0),
        torque_uncertainty=part.number('torque_uncertainty_Nm'),
        inertia=part.number('inertia_kg_m2', 0.0),
        temperature=part.number('temperature_degC'),
        free_load=part.number('free_load_N', 0.0),
        always_free=bool(part.flag('always_free')),
        load_from=part.text('load.from'),
        unknown={kind: text for kind in INPUTS if (text := part.text(f'{kind}.unknown'))},
        texts={key: text for key in TEXTS if (text := part.text(key))},
    )
    _check_axis(axis)
    return axis


def _check_axis(axis: AxisMap) -> None:
    """Raise InputError unless an axis says enough for what it holds."""
    if not set(MOTION) & set(axis.columns):
        raise InputError(f'{axis.name} has no speed, it must name a column of speed or position')
    if math.isnan(axis.lead):
        raise InputError(f'{axis.name}.lead_mm is missing, it must be the lead of the screw')
    if 'torque' in axis.columns and math.isnan(axis.motor_torque('torque')):
        raise InputError(f'{axis.name}.torque_rated_Nm is missing, a torque in % is part of it')
    source = axis.load_from
    if (axis.always_free or axis.free_load) and source != MOTOR_TORQUE:
        raise InputError(
            f'{axis.name} states always_free or free_load_N, which replace a load from '
            'motor_torque: load.from must be motor_torque'
        )
    if not source:
        return
    if source not in DERIVED or 'load' in axis.columns:
        raise InputError(
            f'{axis.name}.load.from is {source!r}, allowed is {", ".join(DERIVED)}, without a '
            'column of the load'
        )
    used = {'motor_torque': {'current', 'torque'}}.get(source, {source}) & set(axis.columns)
    if not used:
        raise InputError(f'{axis.name}.load.from is {source!r}, of which no column is named')
    if used == {'current'} and math.isnan(axis.motor_torque('current')):
        rated = axis.columns['current'].unit == RATED
        needed = 'torque_rated_Nm' if rated else 'torque_constant_Nm_per_A'
        raise InputError(f'{axis.name}.{needed} is missing, a load from the current needs it')
    if source == 'motor_torque' and math.isnan(axis.torque_uncertainty):
        raise InputError(
            f'{axis.name}.torque_uncertainty_Nm is missing, a load from motor_torque needs it'
        )


def _assumptions(content: Any) -> tuple[Assumption, ...]:
    _check_keys('assumed', content, None)
    assumptions = []
    for key, entry in content.items():
        _check_keys(f'assumed {key}', entry, ('value', 'reason'))
        if not entry.get('reason') or 'value' not in entry:
            raise InputError(f'assumed {key} must have a value and a reason')
        assumptions.append(
            Assumption(key=str(key), value=entry['value'], reason=str(entry['reason']))
        )
    return tuple(assumptions)


def _joined(stated: dict[str, Any], assumptions: tuple[Assumption, ...]) -> dict[str, Any]:
    for one in assumptions:
        if one.key in stated:
            raise InputError(f'{one.key} is both stated and assumed, one must go')
    return stated | {one.key: one.value for one in assumptions}


def _flatten(section: Any, prefix: str) -> dict[str, Any]:
    _check_keys(prefix or 'axes', section, None)
    flat: dict[str, Any] = {}
    for key, value in section.items():
        name = f'{prefix}.{key}' if prefix else str(key)
        flat |= _flatten(value, name) if isinstance(value, dict) else {name: value}
    return flat


def _check_keys(what: str, section: Any, known: tuple[str, ...] | None) -> None:
    if not isinstance(section, dict):
        raise InputError(f'{what} is {short(repr(section))}, it must hold keys and values')
    for key in section:
        if known is not None and key not in known:
            raise InputError(f'{what} holds {key!r}, allowed are {", ".join(known)}')


def _said(value: Any) -> str:
    return 'blank' if value is None else repr(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _epoch(value: Any) -> int:
    """Return the time [ns] of the universal clock that a text or date of YAML says."""
    try:
        at = value if isinstance(value, datetime.datetime) else None
        at = at or datetime.datetime.fromisoformat(str(value))
    except ValueError:
        raise InputError(
            f'time.epoch is {value!r}, it must be a date such as 2000-01-01T00:00:00Z'
        ) from None
    at = at.replace(tzinfo=at.tzinfo or datetime.UTC)
    nanoseconds = round(at.timestamp() * MICRO) * (SECOND // round(MICRO))
    if nanoseconds <= 0:
        raise InputError(f'time.epoch is {value}, it must be after 1970: a stamp of 0 means none')
    return nanoseconds
