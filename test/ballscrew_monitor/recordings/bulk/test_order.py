# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Events put into order by arrays are what the messages of a bag say one by one."""

import heapq
import itertools

from ballscrew_monitor.core.inputs import InputSample
from ballscrew_monitor.judge.records import RUN, TICK
from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk import batches as batches_module
from ballscrew_monitor.recordings.bulk import order
from ballscrew_monitor.recordings.bulk.decode import decode
from ballscrew_monitor.recordings.bulk.events import (
    blank,
    event_of,
    joined,
    Notes,
    places_of_axis,
    TICK_SOURCE,
    ticks,
)
from ballscrew_monitor.recordings.bulk.order import (
    EventOrder,
    LONGEST_HOLE,
    ordered_events,
    REORDER,
)
from ballscrew_monitor.recordings.mcap_file import message_definition
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_monitor.settings.parameters import absolute
from geometry_msgs.msg import WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import CompressionType, IndexType, Writer
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float32, Float64

MS = 1_000_000
BEGIN = 1_700_000_000_000 * MS
PERIOD = 100 * MS
NEVER, END = 2**62, 2**63 - 1  # no tick is due, all has arrived
TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/axial_load': 'geometry_msgs/msg/WrenchStamped',
    '/y/load': 'std_msgs/msg/Float64',
    '/oil': 'std_msgs/msg/Float32',
}
VALUES = parameters.defaults(['x', 'y']) | {
    'x.torque.topic': 'joint_states',
    'x.torque.type': 'sensor_msgs/msg/JointState',
    'x.torque.field': 'effort[x_axis]',
    'y.load.topic': 'y/load',
    'y.load.type': 'std_msgs/msg/Float64',
    'y.load.field': 'data',
    'y.temperature.topic': 'oil',
    'y.temperature.type': 'std_msgs/msg/Float32',
    'y.temperature.field': 'data',
}


@pytest.fixture(scope='module')
def axes():
    """Return two axes whose speeds share a topic."""
    return [build_axis(name, VALUES) for name in ('x', 'y')]


def joints(stamp, *, names=('x_axis', 'y_axis'), speeds=(1.0, 2.0), efforts=(0.5, 0.25), frame=''):
    message = JointState(name=names, velocity=speeds, effort=efforts)
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    return '/joint_states', message


def load(stamp, value):
    message = WrenchStamped()
    message.wrench.force.x = value
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    return '/axial_load', message


def write(path, timed, **options):
    """Write pairs of a log time and (topic, message) to one MCAP file."""
    with path.open('wb') as stream:
        writer = Writer(stream, **{'compression': CompressionType.ZSTD, **options})
        writer.start(profile='ros2', library='test')
        channels = {}
        for name, kind in TYPES.items():
            schema = writer.register_schema(kind, 'ros2msg', message_definition(kind).encode())
            channels[name] = writer.register_channel(name, 'cdr', schema)
        for log_time, (topic, message) in timed:
            data = message if isinstance(message, bytes) else serialize_message(message)
            writer.add_message(
                channels[topic], log_time=log_time, data=data, publish_time=log_time
            )
        writer.finish()


def steady(count):
    """Return speeds and loads of a quiet recording."""
    timed = []
    for number in range(count):
        stamp = BEGIN + number * MS
        timed.append((stamp + 200_000, load(stamp, -100.0 - number)))
        timed.append((stamp + 300_000, joints(stamp, speeds=(float(number), -float(number)))))
        timed.append((stamp + 300_000, ('/y/load', Float64(data=float(number)))))
        if number % 50 == 0:
            timed.append((stamp, ('/oil', Float32(data=20.0 + number))))
    return timed


def faulty():
    """Return a recording with everything that may go wrong and still be read."""
    timed, drawn = [], np.random.default_rng(3)
    now = BEGIN
    for number in range(600):
        now += int(drawn.choice([0, 1, 2, 7])) * MS
        if number % 150 == 149:
            now += int(drawn.choice([1500, 40_000, 70_000])) * MS
        stamp = now - int(drawn.choice([0, 0, 0, 1, 400, 3000, -50, -10_000])) * MS
        stamp = 0 if number % 37 == 5 else stamp
        stamp = -now if number % 37 == 6 else stamp
        kind = drawn.integers(10)
        if kind < 3:
            timed.append((now, joints(stamp, speeds=(float(number), 1.0), frame='f' * kind)))
        elif kind == 3:
            other = {'names': ('y_axis',), 'speeds': (3.0,), 'efforts': ()}
            timed.append((now, joints(stamp, **other)))
        elif kind == 4:
            swapped = {'names': ('y_axis', 'a', 'x_axis'), 'speeds': (3.0, 4.0, float(number))}
            timed.append((now, joints(stamp, **swapped, efforts=())))
        elif kind == 5:
            timed.append((now, load(stamp, float(drawn.choice([np.nan, np.inf, 1e300, 5.0])))))
        elif kind == 6:
            timed.append((now, ('/y/load', Float64(data=float(number)))))
        elif kind == 7:
            whole = serialize_message(load(stamp, 5.0)[1])
            short = [b'', whole[:20], whole[:-9], whole + b'more', b'\0\0' + whole[2:], whole[:4]]
            timed.append((now, ('/axial_load', short[number % len(short)])))
        else:
            timed.append((now, load(stamp, float(number))))
    return timed


def alone(bag, axes):
    """Yield (stamp, source, axis, event) message by message, a tick with neither."""
    readers = {}
    for number, axis in enumerate(axes):
        for source in axis.inputs:
            readers.setdefault(absolute(source.topic), []).append((number, axis, source))
    numbers, grid, waiting, last = itertools.count(), None, [], {}

    def late(log_time):
        while log_time - waiting[0][3] > REORDER:
            yield heapq.heappop(waiting)

    for message in bag.messages(readers):
        now = message.log_time
        if grid is not None:
            for tick in range(grid, min(now, grid + LONGEST_HOLE), PERIOD):
                heapq.heappush(waiting, (tick, TICK_SOURCE, next(numbers), tick, None, None))
                yield from late(tick)
        grid = max(grid or 0, -(-now // PERIOD) * PERIOD)
        decoded = decode(bag, message, readers[message.topic][0][2].message_type)
        for number, axis, source in readers[message.topic]:
            line = number, source.source
            event = source.read(decoded, now=now, max_future=axis.max_future)
            stamp = event.stamp if isinstance(event, InputSample) else now
            if isinstance(event, InputSample):
                if last.get(line, stamp) - stamp > BACKWARD_JUMP:
                    yield from sorted(waiting)
                    waiting.clear()
                last[line] = stamp
            entry = (stamp, event.source, next(numbers), now, number, event)
            heapq.heappush(waiting, entry)
            yield from late(now)
    while waiting:
        yield heapq.heappop(waiting)


def at_once(bag, axes):
    return list(ordered_events(bag, axes, PERIOD, Notes(), on_done=lambda share: None))


def assert_same(bag, axes):
    """Compare the events of each axis with those of the plain twin."""
    expected = list(alone(bag, axes))
    notes = Notes()
    found = list(ordered_events(bag, axes, PERIOD, notes, on_done=lambda share: None))
    for number in range(len(axes)):
        mine = joined([part[places_of_axis(part, number)] for part in found])
        wanted = joined(
            [
                ticks(np.array([stamp]), place=0)
                if event is None
                else event_of(event, notes, axis=number, log_time=now, place=0)
                for stamp, _, _, now, axis, event in expected
                if axis in (None, number)
            ]
        )
        for name in wanted.dtype.names:
            if name != 'place':
                np.testing.assert_array_equal(mine[name], wanted[name], err_msg=name)


LAYOUTS = {
    'zstd': {'chunk_size': 2000},
    'lz4': {'chunk_size': 2000, 'compression': CompressionType.LZ4},
    'one plain chunk': {'compression': CompressionType.NONE},
    'no message index': {'chunk_size': 2000, 'index_types': IndexType.CHUNK},
    'no chunks': {'use_chunking': False},
    'no checksums': {'chunk_size': 2000, 'enable_crcs': False},
}


@pytest.mark.parametrize('layout', LAYOUTS)
def test_a_steady_recording(tmp_path, axes, layout, monkeypatch):
    monkeypatch.setattr(batches_module, 'BATCH', 20_000)
    monkeypatch.setattr(batches_module, 'MESSAGES', 100)
    write(tmp_path / 'bag.mcap', steady(250), **LAYOUTS[layout])
    assert_same(Bag(tmp_path / 'bag.mcap'), axes)


@pytest.mark.parametrize('size', [500, 20_000, 10**9])
def test_a_faulty_recording(tmp_path, axes, size, monkeypatch):
    monkeypatch.setattr(batches_module, 'BATCH', size)
    write(tmp_path / 'bag.mcap', faulty(), chunk_size=1000)
    assert_same(Bag(tmp_path / 'bag.mcap'), axes)


def test_files_that_overlap_and_chunks_out_of_order(tmp_path, axes, monkeypatch):
    """Their messages are put into order, also of runs that are refused in the end."""
    monkeypatch.setattr(batches_module, 'BATCH', 5000)
    monkeypatch.setattr(order, 'check_rising', lambda *given: None)
    timed = faulty()
    drawn = np.random.default_rng(5)
    shuffled = [timed[at] for at in np.argsort(np.arange(len(timed)) + drawn.normal(0, 9, 600))]
    write(tmp_path / 'one.mcap', shuffled[::2], chunk_size=700)
    write(tmp_path / 'two.mcap', shuffled[1::2], chunk_size=1500)
    assert_same(Bag(tmp_path), axes)


def damaged(path, at):
    data = bytearray(path.read_bytes())
    data[at] ^= 0x55
    path.write_bytes(data)


@pytest.mark.parametrize('layout', ['zstd', 'lz4', 'one plain chunk'])
@pytest.mark.parametrize('salvage', [False, True])
def test_a_damaged_chunk_is_named(tmp_path, axes, layout, salvage, refused):
    options = {**LAYOUTS[layout], 'chunk_size': 20_000}
    write(tmp_path / 'bag.mcap', steady(500), **options)
    damaged(tmp_path / 'bag.mcap', 3000)
    bag = Bag(tmp_path / 'bag.mcap', salvage=salvage)
    refused('truncated_damaged_chunk', at_once, bag, axes)


def test_the_share_that_is_done_rises_to_one(tmp_path, axes, monkeypatch):
    monkeypatch.setattr(batches_module, 'BATCH', 5000)
    write(tmp_path / 'bag.mcap', steady(200), chunk_size=2000)
    shares = []
    bag = Bag(tmp_path / 'bag.mcap')
    list(ordered_events(bag, axes, PERIOD, Notes(), on_done=shares.append))
    assert shares == sorted(shares)
    assert len(shares) > 3
    assert shares[-1] == 1.0


def samples(log_times, lags, sources):
    """Return samples by log time, lag of the stamp [ms] and source; the value numbers them."""
    log_time = np.array(log_times, dtype=np.int64)
    return blank(
        len(log_time),
        log_time=log_time,
        place=np.arange(len(log_time)),
        stamp=log_time - np.array(lags, dtype=np.int64) * MS,
        arrival=log_time,
        source=sources,
        value=np.arange(len(log_time), dtype=float),
    )


def one_by_one(found):
    """Return the values in the order in which they leave a heap."""
    waiting, order = [], []
    last = {}
    for at in range(len(found)):
        line, stamp = int(found['source'][at]), int(found['stamp'][at])
        if last.get(line, stamp) - stamp > BACKWARD_JUMP:
            order += [key[2] for key in sorted(waiting)]
            waiting.clear()
        last[line] = stamp
        key = (int(found['stamp'][at]), int(found['source'][at]), at)
        heapq.heappush(waiting, key)
        while found['log_time'][at] - found['log_time'][waiting[0][2]] > REORDER:
            order.append(heapq.heappop(waiting)[2])
    return [*order, *(key[2] for key in sorted(waiting))]


@given(
    steps=st.lists(
        st.tuples(
            st.sampled_from((0, 1, 10, 400, 1200)),
            st.sampled_from((0, 0, 0, 0, 1, 300, 990, 1500, 5000, -200)),
            st.integers(0, 3),
        ),
        min_size=1,
        max_size=60,
    ),
    cuts=st.lists(st.integers(0, 60), max_size=4),
)
def test_batches_come_in_the_order_of_a_heap(steps, cuts):
    wait, lags, sources = zip(*steps)
    found = samples(BEGIN + np.cumsum(wait) * MS, lags, sources)
    order, values = EventOrder(NEVER), []
    bounds = sorted({0, len(found), *(min(cut, len(found)) for cut in cuts)})
    for begin, end in zip(bounds, bounds[1:]):
        values += order.push(found[begin:end], END)['value'].tolist()
    values += order.finish()['value'].tolist()
    assert values == one_by_one(found)


def test_stamps_decades_apart_are_ordered_and_arrivals_wait():
    found = samples([BEGIN, BEGIN, BEGIN], [0, BEGIN // MS, 1], [0, 1, 0])
    order = EventOrder(NEVER)
    parts = [order.push(found, END), order.finish()]
    assert joined(parts)['value'].tolist() == [1.0, 2.0, 0.0]
    found = samples([BEGIN + 3 * MS, BEGIN + MS, BEGIN + 2 * MS], [0, 0, 0], [0, 0, 0])
    order = EventOrder(1000 * MS)
    parts = [order.push(found, BEGIN + 3 * MS), order.push(joined([]), BEGIN + 4 * MS)]
    everything = joined([*parts, order.finish()])
    assert everything['value'][everything['kind'] != TICK].tolist() == [1.0, 2.0, 0.0]


@pytest.mark.parametrize('cut', range(1, 6))
def test_between_runs_there_is_no_tick_but_the_begin_of_the_next(cut):
    times = BEGIN + MS * np.array([0, 150, 250, 3050, 3150, 3250])
    order = EventOrder(PERIOD, [BEGIN + 1600 * MS])
    due = joined([order.ticks(times[:cut]), order.ticks(times[cut:])])
    assert ((due['stamp'] - BEGIN) // MS).tolist() == [0, 100, 200, 1600, 3100, 3200]
    assert due['kind'].tolist() == [TICK] * 3 + [RUN] + [TICK] * 2
