# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A first map of a log, by names, ranges and rates of its columns.

What nothing in the log tells stands under `assumed` with a value and a reason. The rate, the unit
of a time and the decimal sign are not assumed: they stand without a value, to be stated.

"""

from collections.abc import Callable, Iterator, Mapping
import contextlib
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import LINEAR_POSITION_UNITS
from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.cells import Array, Cells
from ballscrew_monitor.recordings.tables.names import Named, read_name
from ballscrew_monitor.recordings.tables.quantities import INPUTS, Layout, RATED, UNITS
from ballscrew_monitor.recordings.tables.read import look_through
from ballscrew_monitor.recordings.tables.sources import layout_of, source_of
from ballscrew_monitor.recordings.tables.time_gate import SHORTEST, TimeGate
from ballscrew_monitor.recordings.words import listed, short, Shown, shown_progress
import numpy as np
from surrogate.files import InputError
from surrogate.surface import find_surface, Surface
from surrogate.units import MILLI
import yaml

SCREW, OIL = 'nominal', 'iso_vg_68'
TORQUE_CONSTANT = 0.1  # [N m/A]
RATED_TORQUE = 5.0  # [N m]
EFFICIENCY = 0.9
TEMPERATURE = 40.0  # [degC]
NUMBERS = 4_000_000  # of the first rows that are in memory
EPOCH = '2000-01-01T00:00:00Z'
FORCE = (
    '2 pi efficiency torque / lead against the torque: friction of guides and seals, and what '
    'accelerates the axis, count as load'
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Guess:
    """
    A map as its content, and what is to be said about it.

    `unstated` says of each place of the map that is null why nothing is assumed there.

    """

    content: dict[str, Any]
    unstated: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def text(self) -> str:
        """Return the map as YAML."""
        head = (
            '# A first map of a machine log. What it assumes is judged with as it stands; who\n'
            '# knows a value writes it in its place and takes it out of `assumed`, such as\n'
            '# `axes: {x: {lead_mm: 5.0, screw: my_screw, oil: my_oil, surface: my_screw.npz}}`.\n'
        )
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


class _Guesser:
    """
    What is found so far.

    `axes` holds the columns of each axis by what they are, `used` what the map says of those that
    say something, by the same names; the `step` between rows [s] is NaN where it is not known.

    """

    def __init__(self, path: Path, shown: Shown) -> None:
        self.path = path
        self.layout = layout_of(path)
        self.source = source = source_of(path, self.layout)
        self.named = [read_name(name) for name in source.names()]
        self.assumed: dict[str, dict[str, Any]] = {}
        self.notes: list[str] = []
        self.used: dict[str, dict[str, dict[str, Any]]] = {}
        self.step = math.nan
        self.axes = {
            name: chosen
            for name, found in names.by_axis(self.named).items()
            if {'speed', 'position'} & set(chosen := names.best(found))
        }
        if not self.axes:
            raise InputError(
                f'log {path}: no column looks like the speed or position of an axis, it holds '
                f'{listed([one.column for one in self.named])}'
            )
        self.times = [one for one in self.named if one.kind == 'time']
        columns = [one for chosen in self.axes.values() for one in chosen.values()]
        used = [one.column for one in [*columns, *self.times]]
        table = look_through(source, used, optional=used, shown=shown)
        self.unstated = list(table.doubts.values())[:1]
        for sign in list(table.doubts)[:1]:
            table = look_through(source, used, decimal=sign, optional=used, shown=shown)
        self.first_row = table.first_row
        rows = NUMBERS // len(used)
        # The first rows tell how the speeds go with the positions, all of them the ranges.
        self.data = table.head(rows)
        self.extremes = {name: one.extremes for name, one in table.readings.items()}
        self.timed = {name for name, one in table.readings.items() if one.is_time}
        times = {one.column for one in self.times}
        # Why a column is not taken for the time.
        self.not_times = [why for name, why in table.left_out.items() if name in times]
        self.notes += [
            f'{why}; it is left out' for name, why in table.left_out.items() if name not in times
        ]
        self.notes += [*table.notes, *names.told_by_words(self.named)]
        if rows < table.rows:
            self.notes.append(f'rate and units are those of the first {rows} of {table.rows} rows')
        self._forget_texts()

    def result(self) -> Guess:
        doubtful = bool(self.unstated)
        time = self._time_column()
        for name in self.axes:
            self._fill(name)
        if not time:
            time = self._time_without_column()
        self._say_what_is_left_out(time)
        usual, found = (dataclasses.asdict(one) for one in (Layout(), self.layout))
        content: dict[str, Any] = {'log': self.path.name}
        content |= {key: value for key, value in found.items() if value != usual[key]}
        content |= {'decimal': None} if doubtful else {}
        content |= {'time': time, 'axes': self.used, 'assumed': self.assumed}
        return Guess(content=content, unstated=tuple(self.unstated), notes=tuple(self.notes))

    def _assume(self, key: str, value: Any, reason: str) -> None:
        self.assumed[key] = {'value': value, 'reason': reason}

    def _forget_texts(self) -> None:
        """Leave out columns without a number, and axes that so have no speed."""
        self.lost = {
            name: [one.column for one in chosen.values() if one.column not in self.data]
            for name, chosen in self.axes.items()
        }
        self.times = [one for one in self.times if one.column in self.data]
        for name, chosen in list(self.axes.items()):
            left = {kind: one for kind, one in chosen.items() if one.column in self.data}
            self.axes[name] = left
            if not {'speed', 'position'} & set(left):
                self.axes.pop(name)
        if not self.axes:
            raise InputError(f'log {self.path}: {"; ".join(self.notes)}')

    def _time_column(self) -> dict[str, Any]:
        """Return what the map says of the time; take the step between rows if it is known."""
        days = next((one for one in self.times if self._is(estimates.is_of_days, one)), None)
        others = [one for one in self.times if one is not days]
        for one in sorted(others, key=lambda one: -one.rank):  # by name, then by unit
            values, dated = self.data[one.column], {}
            if one.column in self.timed and self._is(estimates.is_of_a_day, one):
                if days is None:
                    values = estimates.Midnights().passed(values)
                else:
                    values, dated = self.data[days.column] + values, {'date': days.column}
            if fault := self._fault(one, values):
                self.not_times.append(f'column {short(repr(one.column))}: {fault}')
                continue
            self.notes += [f'{why}; it is left out' for why in self.not_times]
            return self._time_of(one, values) | dated
        return {}

    def _is(self, kind: Callable[[Array], bool], one: Named) -> bool:
        return kind(self.extremes[one.column])

    def _fault(self, one: Named, values: Array) -> str:
        """Return why values are no time of the motion, empty if they are."""
        motion = [
            np.isfinite(self.data[(chosen.get('speed') or chosen['position']).column])
            for chosen in self.axes.values()
        ]
        rows = np.flatnonzero(np.isfinite(values) & np.any(motion, axis=0))
        values, rows = values[rows], rows + self.first_row
        if len(rows) < 2:
            return 'it holds fewer than two numbers beside those of the motion'
        if not estimates.is_rising(values):
            at = int((np.diff(values) <= 0.0).argmax())
            return (
                f'it does not rise, such as from {values[at]:.12g} in row {rows[at]} to '
                f'{values[at + 1]:.12g} in row {rows[at + 1]}'
            )
        gate = TimeGate()
        if unit := self._unit_of_time(one, values)[0]:
            gate.add(values * conversions.TIME_UNITS[unit], rows)
        return gate.fault()[0]

    def _unit_of_time(self, one: Named, values: Array) -> tuple[str, bool]:
        """Return the unit of times, empty if unknown, and if they are since 1970."""
        if stated := 's' if one.column in self.timed else one.unit:
            return stated, estimates.is_universal(values, stated)
        unit = estimates.time_unit(values)
        return unit, bool(unit)

    def _time_of(self, one: Named, values: Array) -> dict[str, Any]:
        unit, absolute = self._unit_of_time(one, values[np.isfinite(values)])
        step = float(np.nanmedian(np.diff(values)))
        if not unit:
            self.unstated.append(
                f'state time.unit in the map: column {one.column} states none that is known; its '
                f'rows are {step:.3g} apart, which may be of any{_rates(step)}'
            )
        if not absolute:
            self._assume_epoch(f'column {one.column} does not count from a known time')
        if unit:
            self.step = step * conversions.TIME_UNITS[unit]
        return {'column': one.column, 'unit': unit or None}

    def _assume_epoch(self, why: str) -> None:
        self._assume('time.epoch', EPOCH, f'{why}, and a stamp of 0 means that there is none')

    def _time_without_column(self) -> dict[str, Any]:
        """Return what the map says of the time of a log whose time is not read."""
        motions = {
            name: self._motion(name)
            for name, chosen in self.axes.items()
            if {'speed', 'position'} <= set(chosen)
            and {self._unit(name, kind) for kind in ('speed', 'position')}
            <= set(conversions.LINEAR_SPEED_UNITS | LINEAR_POSITION_UNITS)
        }
        found = estimates.period(list(motions.values()))
        why = '; '.join(self.not_times or ['no column is named as a time', *self._rising()])
        if math.isfinite(found):
            why += (
                f'; at {1.0 / found:.3g} Hz the speeds of axes {", ".join(motions)} make their '
                'positions best'
            )
        self.unstated.append(f'state time.rate_Hz in the map, the rows in a second: {why}')
        self._assume_epoch('the log has no time that is read')
        return {'rate_Hz': None}

    def _rising(self) -> Iterator[str]:
        """Yield which columns may be a time by their first cells, though not by their names."""
        head = self.source.head()
        for one in self.named:
            if one.column in self.data:
                continue
            cells = Cells(self.path, one.column, self.source.separator)
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
        """Return the unit of an input as the map says or assumes it."""
        assumed = self.assumed.get(f'{name}.{kind}.unit', {}).get('value', '')
        return str(self.used[name][kind].get('unit', assumed))

    def _fill(self, name: str) -> None:
        """Let the map say of an axis what its columns and their numbers tell."""
        chosen = self.axes[name]
        used = self.used[name] = {
            kind: {'column': chosen[kind].column}
            for kind in INPUTS
            if kind in chosen and self._is_used(chosen[kind])
        }
        for kind in used:
            self._set_unit(name, kind)
        lead = Surface.load(find_surface('', SCREW, OIL), screw=SCREW, oil=OIL).lead * MILLI
        for key, value in (('screw', SCREW), ('oil', OIL)):
            self._assume(f'{name}.{key}', value, 'the log does not say it; the shipped one')
        why = f'the log does not say it; that of {SCREW}'
        self._assume(f'{name}.lead_mm', float(f'{lead:.6g}'), why)
        self._set_load(name)
        if 'torque' in used and self._unit(name, 'torque') == RATED:
            self._assume_motor(name, 'torque')
        if 'temperature' in used:
            self._set_oil(name, used['temperature'])
        else:
            self._assume(
                f'{name}.temperature_degC',
                TEMPERATURE,
                'no column is the oil temperature of this axis',
            )
        if 'speed' in used:
            speeds = self.extremes[used['speed']['column']]
            unit = self._unit(name, 'speed')
            self.notes += estimates.oddities(name, speeds, unit, conversions.LINEAR_SPEED_UNITS)

    def _is_used(self, one: Named) -> bool:
        """Tell whether a column says something: a force or current of nothing but 0 is unknown."""
        silent = estimates.is_silent(self.extremes[one.column])
        return one.kind in ('speed', 'position') or not silent

    def _set_unit(self, name: str, kind: str) -> None:
        place, stated = self.used[name][kind], self.axes[name][kind].unit
        if stated:
            place['unit'] = stated
            return
        values = self.extremes[place['column']]
        if kind == 'position':
            unit, why = estimates.position_unit(values)
        elif kind == 'speed' and (turning := names.turning_unit(place['column'])):
            unit, why = turning, 'its name is that of a turning speed'
        elif kind == 'speed':
            metres, speed = self._metres(name), self.data[place['column']]
            motion = None if metres is None else (metres, speed)
            unit, why = estimates.speed_unit(values, motion, self.step)
        elif kind == 'temperature' and np.nanmin(values) > TEMPERATURE * 5:
            unit, why = 'K', f'its least is {np.nanmin(values):.3g}'
        else:
            unit, why = next(iter(UNITS[kind])), 'the usual one'
        self._assume(
            f'{name}.{kind}.unit', unit, f'{place["column"]} states none that is known; {why}'
        )

    def _metres(self, name: str) -> Array | None:
        """Return the position of an axis [m], None if there is none that is linear."""
        if 'position' not in self.used[name]:
            return None
        position = self.axes[name]['position']
        values, extremes = self.data[position.column], self.extremes[position.column]
        unit = position.unit or estimates.position_unit(extremes)[0]
        return values * LINEAR_POSITION_UNITS[unit] if unit in LINEAR_POSITION_UNITS else None

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
                self._assume_motor(name, source)
            return
        silent = [chosen[kind].column for kind in ('load', 'torque', 'current') if kind in chosen]
        lost = [f'{", ".join(self.lost[name])} holds no number'] if self.lost[name] else []
        still = [f'{", ".join(silent)} is always 0'] if silent else []
        why = ', '.join([*lost, *still]) or 'no force, torque or current'
        used['load'] = {'unknown': why}
        self.notes.append(f'axis {name}: the load is not known ({why}), nothing will be judged')

    def _assume_motor(self, name: str, kind: str) -> None:
        """Assume what makes a torque of a current, or of either in % of the rated one."""
        rated = self._unit(name, kind) == RATED
        key = 'torque_rated_Nm' if rated else 'torque_constant_Nm_per_A'
        value = RATED_TORQUE if rated else TORQUE_CONSTANT
        self._assume(
            f'{name}.{key}', value, 'the log does not say it; it is on the plate of the motor'
        )

    def _say_what_is_left_out(self, time: Mapping[str, Any]) -> None:
        used = {part.get('column') for axis in self.used.values() for part in axis.values()}
        used |= {entry['value'] for entry in self.assumed.values()} | set(time.values())
        self.notes += names.left_out([one for one in self.named if one.column not in used])


def _rates(step: float) -> str:
    """Return the rates that a step between rows makes in those units of a time that may be."""
    told = [
        f'{unit} {1.0 / (step * factor):.3g} Hz'
        for unit, factor in conversions.TIME_UNITS.items()
        if SHORTEST <= step * factor <= 1.0 / estimates.SLOWEST
    ]
    return f': in {", in ".join(told)}' if told else ''
