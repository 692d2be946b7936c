# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measure how many times faster than real time recordings are judged, on one core.

Usage: python bench/replay.py [--seconds S] [--long L] [--repeats N]. Makes a recording of one axis
at 1 kHz of S seconds and one at 100 Hz of L seconds in a temporary folder, and prints duration
over processor time, which other work on the machine changes little: judged alone, with the load
out of the torque, with the speed out of positions, of the recording that a node makes of itself,
and end to end as `ballscrew replay --out` does it, with table, page and judged bag; a CSV and a
Parquet of the same signals, L seconds long; and how fast a CSV becomes a bag. A floor is what the
same data need at least: zstd and the walk over the records of a bag, or polars for a table, and
the bare step. The bare step over the same events, measured in turns
with the recording of a node, tells what reading that costs. Beside them the time of one Python
call, measured in the same run, of a lookup all over the surface, and how large recordings of a
node are.

"""

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping
import contextlib
import os
from pathlib import Path
import tempfile
import time
import timeit
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.judge.many import ManyJudge
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk.chunks import chunk_indexes, read_chunk
from ballscrew_monitor.recordings.bulk.events import joined, Notes
from ballscrew_monitor.recordings.bulk.order import ordered_events
from ballscrew_monitor.recordings.log_facts import parameters_of
from ballscrew_monitor.recordings.recorded_events import recorded_values, RecordedEvents
from ballscrew_monitor.recordings.replay import axes_for, ignore, replay, replay_parts
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.report.log_report import LogResult, report_log
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.settings import parameters
from geometry_msgs.msg import WrenchStamped
from node_parts.alone import record_alone
import numpy as np
import polars as pl
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from surrogate.surface import look_up_many, shipped_surface, Surface

BEGIN = 1_700_000_000_000_000_000  # [ns]
CYCLE = 20.0  # [s] of a motion to and fro
CHUNK = 768 * 1024  # [bytes] as `ros2 bag record` writes them
POINTS = 200_000
TORQUE = {
    'load__source': 'motor_torque',
    'torque__topic': 'joint_states',
    'torque__type': 'sensor_msgs/msg/JointState',
    'torque__field': 'effort[x_axis]',
    'torque__unit': 'N m',
    'torque__uncertainty': 0.02,
    'inertia': 0.0012,
}
POSITION = {'speed__field': 'position[x_axis]', 'speed__unit': 'rad'}
TABLE = {
    'time': {'column': 'time', 'unit': 's', 'epoch': '2023-11-14T22:13:20Z'},
    'axes': {
        'x': {
            'lead_mm': 10.0,
            'speed': {'column': 'velocity', 'unit': 'rad/s'},
            'position': {'column': 'position', 'unit': 'rad'},
            'load': {'column': 'load', 'unit': 'N'},
            'torque': {'column': 'effort', 'unit': 'N m'},
        }
    },
}
TYPES = {'/joint_states': 'sensor_msgs/msg/JointState', '/load': 'geometry_msgs/msg/WrenchStamped'}


def signals(duration: float, rate: float) -> dict[str, np.ndarray]:
    """Return times [s], speeds [rad/s], positions [rad], loads [N] and torques [N m] at a rate."""
    time_ = np.arange(int(duration * rate)) / rate
    phase = 2 * np.pi * time_ / CYCLE
    load = -1200.0 * np.sign(np.sin(phase)) + 300 * np.sin(7 * phase)
    return {
        'time': time_,
        'velocity': 150.0 * np.sin(phase),
        'position': 150.0 * CYCLE / (2 * np.pi) * (1.0 - np.cos(phase)),
        'load': load,
        'effort': 0.25 * np.sign(np.sin(phase)) - 1.6e-3 * load,
    }


def bursts(duration: float, rate: float) -> Iterator[tuple[int, list[tuple[str, Any]]]]:
    """Yield stamps [ns] with a load and a joint state, at a rate [Hz]; these are reused."""
    joint, wrench = JointState(name=['x_axis']), WrenchStamped()
    made = signals(duration, rate)
    for at, speed, position, load, effort in zip(
        *(column.tolist() for column in made.values()), strict=True
    ):
        joint.velocity, joint.position, joint.effort = [speed], [position], [effort]
        wrench.wrench.force.x = load
        stamp = BEGIN + round(at * 1e9)
        for message in (wrench, joint):
            clock = message.header.stamp
            clock.sec, clock.nanosec = divmod(stamp, 10**9)
        yield stamp, [('/load', wrench), ('/joint_states', joint)]


def write(folder: Path, duration: float, rate: float) -> Bag:
    """Return a recording of loads and joint states at a rate [Hz]."""
    with BagWriter(folder, 'bag', chunk_size=CHUNK) as writer:
        for name, kind in TYPES.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for stamp, messages in bursts(duration, rate):
            for topic, message in messages:
                data = serialize_message(message)
                writer.write(topic, data, log_time=stamp + 200_000, publish_time=stamp)
    return Bag(folder)


def values(period: float, **changes: object) -> dict[str, object]:
    """Return the parameters with `changes` of those of the axis; states each `period` [s]."""
    made = parameters.defaults(['x']) | {'x.load.topic': 'load', 'x.publish_period': period}
    return made | {f'x.{name.replace("__", ".")}': value for name, value in changes.items()}


def spent(repeats: int, make: Callable[[], Iterable[object]]) -> float:
    """Return the least processor time [s] of running through what `make` returns."""
    best = float('inf')
    for _ in range(repeats):
        begin = time.process_time()
        run_through(make())
        best = min(best, time.process_time() - begin)
    return best


def run_through(items: Iterable[object]) -> None:
    """Take all items."""
    for _ in items:
        pass


def report(bag: Bag, out: Path) -> LogResult:
    """Write the report of a recording with states each 0.1 s."""
    return report_log(bag, out, LogParameters(values=values(0.1), origin='the bench'))


def write_tables(folder: Path, duration: float, rate: float) -> tuple[Path, Path]:
    """Return a CSV and a Parquet of the signals at a rate [Hz]."""
    text, packed = folder / 'table.csv', folder / 'table.parquet'
    frame = pl.DataFrame(signals(duration, rate))
    frame.write_csv(text)
    frame.write_parquet(packed)
    return text, packed


@contextlib.contextmanager
def unseen(total: float, unit: str) -> Iterator[Callable[[float], None]]:
    """Show nothing."""
    yield lambda share: None


def judge_table(path: Path) -> Iterator[object]:
    """Yield what a table comes to by its own parameters."""
    log = TableLog(path, make_map(TABLE), unseen)
    return replay_parts(log, parameters_of(log) or {}, states=False)


def floor_of(
    log: Bag | TableLog, given: Mapping[str, Any], read: Callable[[], object]
) -> Callable[[], Iterable[object]]:
    """Return what judges a recording at least: it is read, and the step takes its events."""
    axes, period = axes_for(log, given), nanoseconds(given['tick_period'])
    events = list(ordered_events(log, axes, period, Notes(), on_done=ignore))

    def run() -> Iterator[object]:
        yield read()
        judge = ManyJudge(axes_for(log, given)[0].monitor)
        for part in events:
            yield from judge.judge(part)

    return run


def floor_of_bag(bag: Bag) -> Callable[[], Iterable[object]]:
    """Return what judges a bag at least: chunks by zstd, their messages by the compiled walk."""

    def read() -> None:
        for file in bag.files:
            with file.open('rb') as stream:
                for place in chunk_indexes(stream, bag.topics)[0]:
                    read_chunk(stream, place)

    return floor_of(bag, values(0.1), read)


def floor_of_table(path: Path) -> Callable[[], Iterable[object]]:
    """Return what judges a table at least, which polars reads."""
    log = TableLog(path, make_map(TABLE), unseen)
    read = pl.read_csv if path.suffix == '.csv' else pl.read_parquet
    return floor_of(log, parameters_of(log) or {}, lambda: read(path))


def lookups(repeats: int) -> float:
    """Return how many points are looked up in a second."""
    surface, drawn = Surface.load(shipped_surface()), np.random.default_rng(1)
    slow, fast = np.log(surface.speed_range)
    points = (
        np.exp(drawn.uniform(slow, fast, POINTS)),
        drawn.uniform(*surface.load_range, POINTS),
        drawn.uniform(*surface.temperature_range, POINTS),
    )
    return POINTS / spent(repeats, lambda: [look_up_many(surface, *points)])


class Row(NamedTuple):
    """A way to judge a bag, and how many times faster than real time it is to be."""

    name: str
    aim: int
    bag: Bag
    run: Callable[[], Iterable[object]]


def rows_of(asked: argparse.Namespace, folder: Path) -> list[Row]:
    """Return what is measured, its recordings written."""
    quick = write(folder / 'quick', asked.seconds, 1000.0)
    long = write(folder / 'long', asked.long, 100.0)
    own = record_alone(folder / 'own', values(0.1), bursts(asked.seconds, 1000.0))
    table, packed = write_tables(folder, asked.long, 1000.0)
    made = folder / 'of_table'
    text, fast = (TableLog(path, make_map(TABLE), unseen) for path in (table, packed))
    torque, position = values(0.1, **TORQUE), values(0.1, **POSITION)
    return [
        Row('1 kHz, columns', 0, quick, lambda: replay_parts(quick, values(0.1), states=False)),
        Row('1 kHz, its floor', 0, quick, floor_of_bag(quick)),
        Row('1 kHz, states each 0.1 s', 0, quick, lambda: replay(quick, values(0.1))),
        Row('1 kHz, report, end to end', 200, quick, lambda: [report(quick, folder / 'report')]),
        Row('100 Hz, columns', 8000, long, lambda: replay_parts(long, values(0.1), states=False)),
        Row(
            '1 kHz, load of torque', 900, quick, lambda: replay_parts(quick, torque, states=False)
        ),
        Row(
            '1 kHz, speed of positions',
            1000,
            quick,
            lambda: replay_parts(quick, position, states=False),
        ),
        Row('1 kHz, CSV', 1000, text, lambda: judge_table(table)),
        Row('1 kHz, CSV, its floor', 0, text, floor_of_table(table)),
        Row('1 kHz, Parquet', 0, fast, lambda: judge_table(packed)),
        Row('1 kHz, Parquet, its floor', 0, fast, floor_of_table(packed)),
        Row(
            '1 kHz, a CSV to a bag',
            0,
            text,
            lambda: [convert(table, make_map(TABLE), made, shown=unseen)],
        ),
        Row('1 kHz, own recording', 2500, own, lambda: replay_own(own)),
        Row('1 kHz, the bare step', 0, own, bare_step(own)),
    ]


def replay_own(own: Bag) -> Iterable[object]:
    """Return the parts of the recording of a node."""
    return replay_parts(own, recorded_values(own), states=False)


def bare_step(own: Bag) -> Callable[[], Iterable[object]]:
    """Return what judges the events of the recording of a node, which are in memory already."""
    recorded = RecordedEvents(own, Notes(), recorded_values(own))
    events = joined(list(recorded.events(lambda share: None)))
    monitor = recorded.runs[0].axis.monitor
    return lambda: ManyJudge(monitor).judge(events)


def print_recordings(folder: Path, seconds: float, own: Bag, repeats: int) -> None:
    """Print what reading the recording of a node costs beside the step, and its size."""
    ways = [lambda: replay_own(own), bare_step(own)]
    turns = [[spent(1, way) for way in ways] for _ in range(10 * repeats)]
    replayed, bare = (min(times) for times in zip(*turns, strict=True))
    print(f'own recording: {replayed / bare:.2f} times the time of the bare step')
    alone = record_alone(folder / 'alone', values(0.1), bursts(seconds, 1000.0), raw=False)
    for name, bag in (('with the messages of its inputs', own), ('without them', alone)):
        size = sum(file.stat().st_size for file in bag.files)
        print(f'own recording {name}: {3600 * size / seconds / 1e6:.0f} MB an hour')


def measure(asked: argparse.Namespace, folder: Path) -> None:
    """Print the table."""
    rows = rows_of(asked, folder)
    print(f'first run, which compiles: {spent(1, rows[0].run):.1f} s')
    print(f'{"":28} {"x real time":>12} {"aim":>6} {"us a sample":>12}')
    costs: dict[str, float] = {}
    for row in rows:
        run_through(row.run())
        cost = costs[row.name] = spent(asked.repeats, row.run)
        each = 1e6 * cost / row.bag.topics['/joint_states'].count
        print(f'{row.name:28} {row.bag.duration / cost:12.0f} {row.aim or "":>6} {each:12.2f}')
    for name, floor in (
        ('1 kHz, columns', '1 kHz, its floor'),
        ('1 kHz, Parquet', '1 kHz, Parquet, its floor'),
    ):
        print(f'{name}: {costs[name] / costs[floor]:.2f} times its floor, aim 1.6')
    call = min(timeit.repeat(lambda: None, number=100_000, repeat=7)) / 100_000
    print(f'one Python call takes {1e6 * call:.3f} us')
    print_recordings(folder, asked.seconds, rows[-1].bag, asked.repeats)
    run_through([lookups(1)])
    print(f'one lookup takes {1e6 / lookups(asked.repeats):.2f} us, aim 1')


def main() -> None:
    """Measure in a temporary folder."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n\n')[0].strip())
    parser.add_argument('--seconds', type=float, default=60.0, help='of the one at 1 kHz [s]')
    parser.add_argument(
        '--long',
        type=float,
        default=900.0,
        help='of the one at 100 Hz, and of tables at 1 kHz [s]',
    )
    parser.add_argument('--repeats', type=int, default=3, help='runs, the best counts')
    with tempfile.TemporaryDirectory() as folder:
        measure(parser.parse_args(), Path(folder))


if __name__ == '__main__':
    os.environ.pop('ROS_PYTHON_CHECK_FIELDS', None)  # as a user has it
    main()
