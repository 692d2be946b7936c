# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
History of one axis: the friction of both directions in each group of places, log by log.

Half the difference of the torques of both directions is the friction, so that weight,
counterbalance and the zero of the sensor cancel; half their sum is the offset. The torque that the
measured load asks for is taken off before. Groups are bands of speed and load.

"""

import dataclasses
from typing import Any, NamedTuple

from ballscrew_monitor.health.mixed import Logs
from ballscrew_monitor.health.records import CellKind, LoadSource
from ballscrew_monitor.health.rows import DAY
import numpy as np
from numpy.typing import NDArray
from surrogate.units import TURN

Array = NDArray[np.float64]
USUAL_TIME = 2.0  # time in a group and direction at which it weighs half [s]
ROUNDS = 25
PARTS = ('friction', 'offset', 'speed', 'load', 'temperature', 'weight')


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
    [rad/s], load [N, against the motion of the first direction], temperature [K]; `weight` [-];
    `standstill` [N m] of each log, and the `gain` of its torque over the load, over that of an
    ideal screw [-]. `load_known`: the load was measured, or the motion known to be free.

    """

    start: NDArray[np.int64]
    groups: tuple[Group, ...]
    friction: Array
    offset: Array
    speed: Array
    load: Array
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
            history = _history(part, lead, both=both, load_known=load_known)
            if history is not None:
                for cell in cells[cells['kind'] == CellKind.STANDSTILL]:
                    history.standstill[history.start == cell['start']] = cell['motor_torque']
                return dataclasses.replace(history, gain=gains_of(part, history, lead))
    return None


def _history(motion: NDArray[Any], lead: float, *, both: bool, load_known: bool) -> History | None:
    """Return the friction of each log and group, `both` directions together or each alone."""
    entries, pairs = groups_of(motion, both=both)
    cells = motion[np.array(pairs, np.int64).reshape(-1, 2).T]  # both directions by entries
    load = np.where([group.load != 0 for group in entries], cells['axial_load'], 0.0)
    ideal = -load * lead / TURN  # machine frame
    torque, way, time = cells['motor_torque'] - ideal, cells['direction'], cells['duration'].min(0)
    friction = (way * torque).sum(axis=0) / 2.0
    least = np.abs(friction) / (np.abs(friction) + np.abs(ideal).max(axis=0) + 1e-12)
    alone = np.array([first == second for first, second in pairs], dtype=bool)
    values = {
        'friction': friction,
        'offset': np.where(alone, np.nan, torque.sum(axis=0) / 2.0),
        'speed': np.abs(cells['speed']).sum(axis=0) / 2.0,
        'load': -way[0] * load[0],
        'temperature': cells['temperature'].sum(axis=0) / 2.0,
        'weight': least * least * time / (time + USUAL_TIME),
    }
    counts = np.flatnonzero(friction > 0.0)
    if not len(counts):
        return None
    start, rows = np.unique(cells['start'][0][counts], return_inverse=True)
    groups = sorted({entries[at] for at in counts})
    place = {group: at for at, group in enumerate(groups)}
    parts = {name: np.full((len(start), len(groups)), np.nan) for name in PARTS}
    for name, table in parts.items():
        table[rows, [place[entries[at]] for at in counts]] = values[name][counts]
    parts['weight'] = np.nan_to_num(parts['weight'])
    warm = cells['temperature_measured'][:, counts].all(axis=0)
    return History(
        start=start,
        groups=tuple(groups),
        standstill=np.full(len(start), np.nan),
        gain=np.full(len(start), np.nan),
        warm=bool(warm.sum() > 0.9 * len(counts)),
        load_known=load_known,
        **parts,
    )


def groups_of(motion: NDArray[Any], *, both: bool) -> tuple[list[Group], list[tuple[int, int]]]:
    """
    Return the groups in which logs ran, and the places of the cells of both directions.

    Of `motion` (an array of CELL), `both` directions together, or each alone without load.

    """
    logs: dict[tuple[int, int], dict[tuple[int, int], int]] = {}
    names = ['start', 'speed_band', 'load_band', 'direction']
    for at, (start, speed, load, way) in enumerate(motion[names].tolist()):
        log = logs.setdefault((start, speed), {})
        # Where one log has a load from several sources, the longer motion counts.
        other = log.setdefault((load, way), at)
        if motion['duration'][other] < motion['duration'][at]:
            log[load, way] = at
    groups, pairs = [], []
    for (_, speed), log in logs.items():
        for (load, way), at in log.items():
            if not both:
                if load == 0:  # under load alone, an error of the load is one of the friction
                    groups.append(Group(speed, load, False, way))
                    pairs.append((at, at))
            elif way > 0 and (load, -way) in log:
                groups.append(Group(speed, load, False, 0))
                pairs.append((at, log[load, -way]))
            elif way > 0 and (-load, -way) in log and (-load, way) not in log:
                groups.append(Group(speed, load, True, 0))
                pairs.append((at, log[-load, -way]))
    return groups, pairs


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
        weight = ideal * cells['duration']
        torque = cells['motor_torque'] - drag - float(np.mean(history.offset[at, known]))
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
    total = np.where(seen, history.friction, 0.0).sum(axis=0)
    weight = np.where(seen, history.weight * (total / np.maximum(seen.sum(axis=0), 1)), 0.0)
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
