# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
History of one axis: the friction of both directions in each group of places, log by log.

Half the difference of the torques of both directions is the friction, so that weight,
counterbalance and the zero of the sensor cancel; half their sum is the offset. The torque that the
measured load asks for is taken off before. Groups are bands of speed and load.

"""

import dataclasses
import math
from typing import Any, NamedTuple

from ballscrew_monitor.health.mixed import Logs
from ballscrew_monitor.health.records import CellKind, LoadSource
from ballscrew_monitor.health.rows import DAY
import numpy as np
from numpy.typing import NDArray
from surrogate.units import TURN

Array = NDArray[np.float64]
USUAL_TIME = 2.0
"""Time in a group and direction at which it weighs half [s]."""
BOTH, ONE_WAY = 0, 1
ROUNDS = 25


class Group(NamedTuple):
    """
    Bands of speed and of load; `way` is 0 for both directions, else the only one.

    The load is in the machine frame, or `opposes` the motion in both directions.

    """

    speed: int
    load: int
    opposes: bool
    way: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class History:
    """
    The friction of an axis, an entry of each array for log and group, NaN where it did not run.

    `time` [days since 1970] and `start` [ns] of each log; `friction` and `offset` [N m], speed
    [rad/s], load [N, against the motion of the first direction], the `ideal` torque of a load that
    opposes [N m], temperature [K]; `weight` [-]; `standstill` [N m] of each log, and the `gain`
    of its torque over the load, over that of an ideal screw [-]. `load_known`: the load was
    measured, or the motion known to be free.

    """

    start: NDArray[np.int64]
    groups: tuple[Group, ...]
    friction: Array
    offset: Array
    speed: Array
    load: Array
    ideal: Array
    temperature: Array
    weight: Array
    standstill: Array
    gain: Array
    warm: bool
    load_known: bool

    @property
    def time(self) -> Array:
        """Return the time of each log [days since 1970]."""
        return self.start / DAY

    def until(self, count: int) -> 'History':
        """Return the first `count` logs."""
        names = ('start', *PARTS, 'standstill', 'gain')
        return dataclasses.replace(self, **{name: getattr(self, name)[:count] for name in names})


PARTS = ('friction', 'offset', 'speed', 'load', 'ideal', 'temperature', 'weight')


def history_of(cells: NDArray[Any], lead: float) -> History | None:
    """
    Return the history that cells (an array of CELL) hold, None without motion that counts.

    `lead` [m] of the screw. A load that was measured, or is known to be absent, is preferred;
    groups that ran both ways are preferred.

    """
    motion = cells[(cells['kind'] == CellKind.MOTION) & np.isfinite(cells['motor_torque'])]
    known = motion[motion['load_source'] != LoadSource.DERIVED]
    for part, load_known in ((known, True), (motion, False)):
        for both in (True, False):
            entries = _entries(part, lead, both=both)
            if entries:
                rest = cells[cells['kind'] == CellKind.STANDSTILL]
                history = _history(entries, rest, load_known=load_known)
                return dataclasses.replace(history, gain=gains_of(part, history, lead))
    return None


class _Entry(NamedTuple):
    start: int
    group: Group
    friction: float
    offset: float
    speed: float
    load: float
    ideal: float
    temperature: float
    weight: float
    warm: bool


def _entries(motion: NDArray[Any], lead: float, *, both: bool) -> list[_Entry]:
    """Return the friction of each group and log, `both` directions together or each alone."""
    places: dict[tuple[int, int], dict[tuple[int, int], Any]] = {}
    for cell in motion:
        place = places.setdefault((int(cell['start']), int(cell['speed_band'])), {})
        key = int(cell['load_band']), int(cell['direction'])
        # Where one log has a load from several sources, the longer motion counts.
        if key not in place or place[key]['duration'] < cell['duration']:
            place[key] = cell
    entries = []
    for (start, speed), place in places.items():
        for group, cells in _pairs(speed, place) if both else _alone(speed, place):
            entry = _entry(start, group, cells, lead)
            if entry.friction > 0.0:
                entries.append(entry)
    return entries


def _pairs(speed: int, place: dict[tuple[int, int], Any]) -> list[tuple[Group, list[Any]]]:
    pairs, rest = [], {}
    for (load, way), cell in place.items():
        if (load, -way) not in place:
            rest[load, way] = cell
        elif way > 0:
            pairs.append((Group(speed, load, False, 0), [cell, place[load, -way]]))
    for (load, way), cell in rest.items():
        if way > 0 and (-load, -way) in rest:
            pairs.append((Group(speed, load, True, 0), [cell, rest[-load, -way]]))
    return pairs


def _alone(speed: int, place: dict[tuple[int, int], Any]) -> list[tuple[Group, list[Any]]]:
    return [(Group(speed, load, False, way), [cell]) for (load, way), cell in place.items()]


def _entry(start: int, group: Group, cells: list[Any], lead: float) -> _Entry:
    ways = [int(cell['direction']) for cell in cells]
    loads = [float(cell['axial_load']) if group.load else 0.0 for cell in cells]
    ideal = [-load * lead / TURN for load in loads]  # machine frame
    torque = [float(cell['motor_torque']) - part for cell, part in zip(cells, ideal, strict=True)]
    along = [way * part for way, part in zip(ways, torque, strict=True)]
    friction = sum(along) / len(cells)
    time = min(float(cell['duration']) for cell in cells)
    least = abs(friction) / (abs(friction) + max(map(abs, ideal)) + 1e-12)
    return _Entry(
        start=start,
        group=group,
        friction=friction,
        offset=sum(torque) / 2.0 if len(cells) == 2 else math.nan,
        speed=sum(abs(float(cell['speed'])) for cell in cells) / len(cells),
        load=-ways[0] * loads[0],
        ideal=sum(way * part for way, part in zip(ways, ideal, strict=True)) / len(cells),
        temperature=sum(float(cell['temperature']) for cell in cells) / len(cells),
        weight=least * least * time / (time + USUAL_TIME),
        warm=all(bool(cell['temperature_measured']) for cell in cells),
    )


def _history(entries: list[_Entry], rest: NDArray[Any], *, load_known: bool) -> History:
    start = np.unique([entry.start for entry in entries]).astype(np.int64)
    groups = sorted({entry.group for entry in entries})
    rows = np.searchsorted(start, [entry.start for entry in entries])
    place = {group: at for at, group in enumerate(groups)}
    columns = [place[entry.group] for entry in entries]
    shape = len(start), len(groups)
    parts = {name: np.full(shape, np.nan) for name in PARTS}
    for name, values in parts.items():
        values[rows, columns] = [getattr(entry, name) for entry in entries]
    parts['weight'] = np.nan_to_num(parts['weight'])
    standstill = np.full(len(start), np.nan)
    for cell in rest:
        standstill[start == cell['start']] = cell['motor_torque']
    return History(
        start=start,
        groups=tuple(groups),
        standstill=standstill,
        gain=np.full(len(start), np.nan),
        warm=sum(entry.warm for entry in entries) > 0.9 * len(entries),
        load_known=load_known,
        **parts,
    )


def gains_of(motion: NDArray[Any], history: History, lead: float) -> Array:
    """
    Return the torque over the load of each log, over that of an ideal screw [-].

    By least squares over the loaded `motion` (an array of CELL), in whatever direction, less the
    friction that the log has without load at that speed. `lead` [m]; NaN where a log lacks either.

    """
    free = np.array([group.load == 0 and group.way == 0 for group in history.groups])
    loaded = motion[motion['load_band'] != 0]
    gains = np.full(len(history.start), np.nan)
    for at, start in enumerate(history.start):
        cells, known = loaded[loaded['start'] == start], free & (history.weight[at] > 0.0)
        if not (len(cells) and known.any()):
            continue
        order = np.argsort(history.speed[at, known])
        speed, friction = (part[at, known][order] for part in (history.speed, history.friction))
        drag = np.interp(np.abs(cells['speed']), speed, friction) * cells['direction']
        ideal = -cells['axial_load'] * lead / TURN
        offset = float(np.mean(history.offset[at, known]))
        weight = ideal * cells['duration']
        torque = cells['motor_torque'] - drag - offset
        gains[at] = float(weight @ torque) / float(weight @ ideal)
    return gains


class Effects(NamedTuple):
    """
    Effects of logs of a history, and of groups on ln(friction) [-].

    `compared` are the logs whose groups connect them with the first ones. `rest` is what an entry
    has beside the effects of its log and its group [-].

    """

    logs: Logs
    groups: Array
    rest: Array
    compared: NDArray[np.bool_]


def effects_of(history: History) -> Effects:
    """
    Return the effects of logs and groups by least squares of a table with two ways.

    A group weighs by its friction as well, since the mean friction of all motion is what changes.

    """
    compared = connected(history.weight > 0.0)
    seen = (history.weight > 0.0) & compared[:, None]
    usual_friction = np.where(seen, history.friction, 0.0).sum(axis=0) / np.maximum(
        seen.sum(axis=0), 1
    )
    weight = np.where(seen, history.weight * usual_friction, 0.0)
    friction = np.where(seen, np.log(np.where(seen, history.friction, 1.0)), 0.0)
    warmth = np.where(seen, history.temperature, 0.0) if history.warm else np.zeros_like(friction)
    effect, groups = two_ways(friction, weight)
    warm, _ = two_ways(warmth, weight)
    total = weight.sum(axis=1)
    usual = float(np.median(total[compared]))
    noise = 0.5 + 0.5 * np.minimum(usual / np.maximum(total, 1e-9), 9.0)
    rest = np.where(seen, friction - effect[:, None] - groups, np.nan)
    logs = Logs(history.time, effect, warm, noise)
    return Effects(logs, groups, rest, compared)


def two_ways(values: Array, weight: Array) -> tuple[Array, Array]:
    """
    Return the effects of rows and of columns of a table [unit of the values].

    By weighted least squares; the effects of the rows have the mean 0. Entries without weight are
    missing.

    """
    rows, columns = weight.sum(axis=1), weight.sum(axis=0)
    row, column = np.zeros(len(rows)), np.zeros(len(columns))
    for _ in range(ROUNDS):
        column = (weight * (values - row[:, None])).sum(axis=0) / np.maximum(columns, 1e-12)
        row = (weight * (values - column)).sum(axis=1) / np.maximum(rows, 1e-12)
        row = np.where(rows > 0.0, row - row[rows > 0.0].mean(), 0.0)
    return row, column


def connected(seen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which rows share columns with the first row, directly or over others."""
    rows: NDArray[np.bool_] = np.zeros(len(seen), dtype=bool)
    rows[int(seen.any(axis=1).argmax())] = True
    while True:
        columns = seen[rows].any(axis=0)
        more = np.asarray(seen[:, columns].any(axis=1))
        if (more == rows).all():
            return rows
        rows = more
