# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lines that are messages: those of an MTConnect adapter (SHDR), and of `ros2 topic echo --csv`.

An adapter sends a value when it changes, and it holds until the next: a load is that at the times
of the motion of its axis.

"""

from collections.abc import Iterator, Mapping, Sequence
import csv
import math
from pathlib import Path
import re

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables import names
from ballscrew_monitor.recordings.tables.apart import check_room
from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.codings import text_of
from ballscrew_monitor.recordings.tables.layouts import ADAPTER
from ballscrew_monitor.recordings.tables.long_form import FEWEST, is_number
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.quantities import MOTION
from ballscrew_monitor.recordings.tables.signals import Signals
from ballscrew_monitor.recordings.words import short
import numpy as np
import polars as pl

SHDR = re.compile(rb'^\d{4}-\d\d-\d\dT[\d:.]+Z?(?:@[\d.]+)?\|[^|\r\n\d.,+-][^|\r\n]*\|', re.M)
STAMP = '%Y-%m-%dT%H:%M:%S%.f'
HELD = 1.5  # times the usual time between changes, after which a value is repeated
MOST_HELD = 100_000  # repeated values of a signal
LIST = re.compile(r'\d+\|[\d.]*\|[-+\d.eE]+(?: +[-+\d.eE]+)+')
"""Number, rate and values of a time series of an adapter."""
TOPIC_STAMP = re.compile(r'\d{1,10},\d{1,9}')
MARKS = '#-'  # of a line that is no message
FIELDS = ('position', 'velocity', 'effort')
"""Arrays of a JointState after the names, each of as many numbers or of none."""


def is_shdr(text: bytes) -> bool:
    """Return True if most lines of a text are those of an adapter."""
    lines = max(text[: len(text) // 2].count(b'\n'), 1)
    return 2 * len(SHDR.findall(text)) > lines


def read_shdr(path: Path) -> Signals:
    """
    Return the signals of lines of an adapter that hold numbers; a value that stays is repeated.

    A key with a list of values, or with numbers that are written in another way, is left out.

    """
    found: dict[str, tuple[list[str], list[float]]] = {}
    left_out: dict[str, str] = {}
    with path.open(encoding='utf-8', errors='replace') as stream:
        for line in stream:
            stamp, *rest = line.rstrip('\r\n').split('|')
            moment = stamp.partition('@')[0].rstrip('Z')  # behind @ stands a duration
            for at in range(0, len(rest) - 1 if stamp[:1].isdigit() else 0, 2):
                name, value = rest[at].rpartition(':')[2], rest[at + 1]
                if not name[:1].isalpha():
                    continue
                stamps, values = found.setdefault(name, ([], []))
                stamps.append(moment)
                values.append(_number(value))
                if LIST.fullmatch('|'.join(rest[slice(at + 1, at + 4)])):
                    left_out[name] = 'it holds lists of values, and single ones are read'
                elif math.isnan(values[-1]) and value[-1:].isdigit() and read_name(name).kind:
                    left_out[name] = f'{short(repr(value))} is no number with a decimal point'
    frames = {}
    for name, (stamps, values) in found.items():
        times = pl.Series(stamps).str.to_datetime(STAMP, time_unit='ns', strict=False)
        frame = pl.DataFrame({'time': times, name: values}).drop_nulls('time').sort('time')
        if name not in left_out and frame[name].is_finite().sum() > 1:
            frames[name] = frame.unique('time', keep='last', maintain_order=True)
    rows = list(_by_axis(frames))
    check_room(sum(frame.height for frame in rows), 1 + len(frames))
    frame = pl.concat(rows, how='diagonal').sort('time') if rows else pl.DataFrame()
    return Signals(frame=frame, left_out=left_out, program=ADAPTER)


def _by_axis(frames: Mapping[str, pl.DataFrame]) -> Iterator[pl.DataFrame]:
    """Yield the motion of each axis with what else is known of it then, and other signals."""
    named = [read_name(name) for name in frames]
    joined: set[str] = set()
    for axis in {one.axis: None for one in named if one.place == 'axis'}:
        of_axis = [one for one in named if one.axis == axis]
        chosen = names.best(of_axis)
        motion = next((chosen[kind].column for kind in MOTION if kind in chosen), '')
        if not motion:
            continue
        frame = _held(frames[motion].filter(pl.col(motion).is_finite()), motion)
        for one in of_axis:
            if one.kind and one.kind not in MOTION:
                known = frames[one.column]
                frame = frame.join_asof(known, on='time').with_columns(
                    pl.col(one.column).fill_null(math.nan)
                )
                joined.add(one.column)
        joined.add(motion)
        yield frame
    for name, frame in frames.items():
        if name not in joined:
            yield _held(frame.filter(pl.col(name).is_finite()), name)


def is_echo(lines: Sequence[str]) -> bool:
    """Return True if lines are messages: seconds, nanoseconds, a text, and more."""
    held = [line for line in lines if line.strip() and line[0] not in MARKS]
    if len(held) < FEWEST:
        return False
    stamps = []
    for cells in csv.reader(held):
        if len(cells) < 4 or not TOPIC_STAMP.fullmatch(','.join(cells[:2])) or is_number(cells[2]):
            return False
        stamps.append(int(cells[0]) * SECOND + int(cells[1]))
    whole = sum(stamp % SECOND > 1000 for stamp in stamps)
    return whole > len(stamps) // 2 and all(a <= b for a, b in zip(stamps, stamps[1:]))


def read_echo(path: Path) -> pl.DataFrame:
    """Return the joints of a topic that `ros2 topic echo --csv` wrote; raises ValueError."""
    text = text_of(path.read_bytes())
    lines = [line for line in text.splitlines() if line.strip() and line[0] not in MARKS]
    parts = [_message(cells) for cells in csv.reader(lines)]
    joints = parts[0][1]
    if not joints:
        raise Unreadable(
            'its lines are those of `ros2 topic echo --csv` without names: seconds, nanoseconds, '
            f'frame and {len(next(csv.reader(lines))) - 3} cells. Only joints state theirs: '
            'record the topic by `ros2 bag record`, which ballscrew replay reads as it is, or '
            'write names above the columns'
        )
    if any(names != joints for _, names, _ in parts):
        raise Unreadable('its lines are of different joints: echo one topic at a time')
    held = {'stamp': pl.Series([stamp for stamp, _, _ in parts]).cast(pl.Datetime('ns'))}
    for number, joint in enumerate(joints):
        held[f'name_{number}'] = pl.Series([joint] * len(parts))
        for place, field in enumerate(FIELDS):
            cells = [arrays[place][number] if arrays[place] else '' for *_, arrays in parts]
            if any(cells):
                held[f'{field}_{number}'] = pl.Series(cells)
    return pl.DataFrame(held)


def _held(frame: pl.DataFrame, name: str) -> pl.DataFrame:
    """Return changes of a value and, where it stays for long, its repetitions."""
    times = frame['time'].cast(pl.Int64).to_numpy()
    steps = np.diff(times)
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else math.inf
    counts = np.where(steps > HELD * usual, np.ceil(steps / usual).astype(np.int64) - 1, 0)
    if not math.isfinite(usual) or counts.sum() > MOST_HELD:
        return frame
    places = np.concatenate([np.arange(count) for count in counts.tolist()] or [np.zeros(0)])
    later = np.repeat(times[1:], counts) - (np.repeat(counts, counts) - places) * usual
    more = pl.DataFrame(
        {
            'time': pl.Series(later.astype(np.int64)).cast(pl.Datetime('ns')),
            name: np.repeat(frame[name].to_numpy()[:-1], counts),
        }
    )
    return pl.concat([frame, more]).sort('time').unique('time', keep='last', maintain_order=True)


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def _message(cells: Sequence[str]) -> tuple[int, list[str], list[list[str]]]:
    """Return stamp [ns], names and arrays of the joints in a line, none for another message."""
    try:
        stamp = int(cells[0]) * SECOND + int(cells[1])
    except (ValueError, IndexError):
        raise Unreadable(f'a line begins with {short(repr(cells[:2]))}, no stamp') from None
    rest = [cell.strip() for cell in cells[3:]]
    count = next((at for at, cell in enumerate(rest) if not cell or is_number(cell)), len(rest))
    names, rest = rest[:count], rest[count:]
    arrays: list[list[str]] = []
    for _ in FIELDS if names else ():
        if not rest:
            raise Unreadable(f'a line ends before the numbers of its {count} joints')
        size = 1 if rest[:1] == [''] else count
        arrays.append([] if rest[:1] == [''] else rest[:size])
        rest = rest[size:]
    if names and (rest or any(len(one) not in (0, count) for one in arrays)):
        raise Unreadable(f'a line holds other numbers than those of its {count} joints')
    return stamp, names, arrays
