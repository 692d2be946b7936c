# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags of other programs as rosbag2 lays them out, with types and topics that nobody asked for."""

from collections.abc import Iterator
import contextlib
import math
import sqlite3
from typing import NamedTuple

from courses import constant, moves
from golden.inputs import FEED, NOMINAL
from mcap.writer import CompressionType, Writer
from rclpy.serialization import serialize_message
from recording import BEGIN
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64, String
import yaml

SECOND = 10**9  # [ns]
RATE = 100  # [Hz]
DURATION = 16.0  # [s]
SPEED = moves((0.5, 80.0), (4.0, 9.0), (6.5, -80.0), (11.0, 0.0), (12.0, 300.0), ramp=0.3)
"""Speed of the screw [rad/s]."""
LOAD = moves((0.3, -1.2), (6.5, 0.9), (13.0, -0.1), ramp=0.2)
"""Force on the nut [kN]."""
OIL = constant(41.5)
LEAD = 0.01  # [m]
DRIVE = """\
# State of a drive, by a maker whose types nobody here has.
std_msgs/Header header
float32[4] currents
string mode
"""
SCHEMAS = {
    'sensor_msgs/msg/JointState': 'std_msgs/Header header\nstring[] name\nfloat64[] position\n'
    'float64[] velocity\nfloat64[] effort\n',
    'sensor_msgs/msg/Temperature': 'std_msgs/Header header\nfloat64 temperature\n'
    'float64 variance\n',
    'std_msgs/msg/Float64': 'float64 data\n',
    'std_msgs/msg/String': 'string data\n',
    'acme_drives/msg/DriveState': DRIVE,
}


class Message(NamedTuple):
    """A message: its topic, the times of its arrival and its sending [ns], and its bytes."""

    topic: str
    arrival: int
    sent: int
    data: bytes


def stamped(message, stamp):
    """Return a message with a stamp [ns]."""
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return message


def cell_messages() -> Iterator[Message]:
    """Yield what a robot cell sends: several joints, a load without a stamp, a foreign drive."""
    position = 0.0
    for number in range(round(DURATION * RATE)):
        time, sent = number / RATE, BEGIN + number * SECOND // RATE
        speed = SPEED.at(time)
        position += speed / RATE
        friction = 0.14 * math.tanh(speed)
        joints = JointState(
            name=['shoulder', 'x_axis', 'tool'],
            position=[0.1, position, 0.0],
            velocity=[0.0, speed, 1.0],
            effort=[3.0, friction - 1000.0 * LOAD.at(time) * LEAD / 2.0 / math.pi, 0.0],
        )
        if number % 7 == 3:
            joints = JointState(name=['shoulder'], position=[0.1], velocity=[0.0])
        data = serialize_message(stamped(joints, sent - 3_000_000))
        yield Message('/cell/joint_states', sent + 100_000, sent, data)
        if number % 5 == 0 and not 9.0 < time < 9.9:
            load = serialize_message(Float64(data=LOAD.at(time)))
            yield Message('/cell/load', sent + 250_000, sent, load[:9] if number == 500 else load)
        if number % 100 == 0:
            oil = Temperature(temperature=OIL.at(time) + 0.01 * time)
            yield Message(
                '/cell/oil', sent + 50_000, sent, serialize_message(stamped(oil, sent - 50_000))
            )
            yield Message('/cell/drive', sent + 60_000, sent, bytes([0, 1, 0, 0]) + bytes(60))
            yield Message(
                '/cell/notes',
                sent + 70_000,
                sent,
                serialize_message(String(data=f'part {number}')),
            )


CELL_TYPES = {
    '/cell/joint_states': 'sensor_msgs/msg/JointState',
    '/cell/load': 'std_msgs/msg/Float64',
    '/cell/oil': 'sensor_msgs/msg/Temperature',
    '/cell/drive': 'acme_drives/msg/DriveState',
    '/cell/notes': 'std_msgs/msg/String',
}
CELL = {
    'axes': ['x'],
    'x': {
        'surface': str(NOMINAL),
        'publish_period': 0.05,
        'max_lag': 0.002,
        'speed': {'topic': '/cell/joint_states', 'field': 'velocity[x_axis]'},
        'load': {'topic': '/cell/load', 'type': '', 'field': 'data', 'unit': 'kN'},
        'temperature': {'topic': '/cell/oil'},
        'torque': {
            'topic': '/cell/joint_states',
            'type': 'sensor_msgs/msg/JointState',
            'field': 'effort[x_axis]',
        },
    },
}


def press_messages() -> Iterator[Message]:
    """Yield what a press sends: angles that start over, currents, the speed of another axis."""
    angle = 350.0
    for number in range(round(DURATION * RATE)):
        time, sent = number / RATE, BEGIN + number * SECOND // RATE
        speed = SPEED.at(time)
        angle = (angle + math.degrees(speed) / RATE) % 360.0
        shown = angle + 120.0 if number == 900 else angle
        joints = JointState(name=['ram'], position=[shown])
        yield Message('/ram', sent, sent, serialize_message(stamped(joints, sent)))
        torque = 0.3 * math.tanh(speed) - 800.0 * LOAD.at(time) * LEAD / 2.0 / math.pi
        current = math.nan if number % 331 == 330 else torque / 0.9
        yield Message('/current', sent + 1000, sent, serialize_message(Float64(data=current)))
        if number % 2 == 0:
            turns = 3.0 * speed
            yield Message('/z/rpm', sent + 2000, sent, serialize_message(Float64(data=turns)))
            force = 1e6 if number == 600 else 400.0
            yield Message('/z/force', sent + 1500, sent, serialize_message(Float64(data=force)))


PRESS_TYPES = {
    '/ram': 'sensor_msgs/msg/JointState',
    '/current': 'std_msgs/msg/Float64',
    '/z/rpm': 'std_msgs/msg/Float64',
    '/z/force': 'std_msgs/msg/Float64',
}
FLOAT = {'type': 'std_msgs/msg/Float64', 'field': 'data'}
PRESS = {
    'axes': ['x', 'z'],
    'x': {
        'surface': str(FEED),
        'screw': 'iso3408_40x10',
        'inertia': 0.002,
        'limits': {'rcs': 0.02, 'raise_delay': 0.2},
        'speed': {'topic': '/ram', 'field': 'position[ram]', 'unit': 'deg', 'wrap': 360.0},
        'load': {'source': 'motor_torque'},
        'torque': {'topic': '/current', 'unit': 'A', 'constant': 0.9, 'uncertainty': 0.03},
        'temperature': {'default': 35.0},
    },
    'z': {
        'surface': str(NOMINAL),
        'handedness': 'left',
        'speed': {'topic': '/z/rpm', 'unit': 'rev/min', **FLOAT},
        'load': {'topic': '/z/force', 'scale': -1.0, 'offset': 5.0, **FLOAT},
    },
}


def parameters(folder, values):
    """Write a parameter file; return its path."""
    path = folder / 'parameters.yaml'
    content = {'/**/ballscrew_monitor': {'ros__parameters': values}}
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    return path


def mcap_bag(folder):
    """Write a bag of two compressed MCAP files; return it and parameters."""
    bag, messages = folder / 'cell', list(cell_messages())
    bag.mkdir()
    half = len(messages) // 2
    names = [f'cell_{number}.mcap' for number in range(2)]
    for name, part in zip(names, (messages[:half], messages[half:])):
        write_mcap(bag / name, part)
    write_metadata(bag, 'mcap', names, messages, CELL_TYPES)
    return bag, parameters(folder, CELL)


def write_mcap(path, messages, compression=CompressionType.ZSTD):
    """Write messages as a recorder of ROS 2 does."""
    with path.open('wb') as stream:
        writer = Writer(stream, chunk_size=65536, compression=compression)
        writer.start('ros2', 'libmcap')
        channels = {}
        for topic, name in CELL_TYPES.items():
            schema = writer.register_schema(name, 'ros2msg', SCHEMAS[name].encode())
            channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for number, one in enumerate(messages):
            writer.add_message(channels[one.topic], one.arrival, one.data, one.sent, number)
        writer.finish()


def sqlite_bag(folder):
    """Write a bag of sqlite3 with rows that are damaged; return it and parameters."""
    bag, messages = folder / 'press', list(press_messages())
    bag.mkdir()
    with contextlib.closing(sqlite3.connect(bag / 'press_0.db3')) as database:
        database.executescript(
            'CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, '
            'serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);'
            'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '
            'timestamp INTEGER NOT NULL, data BLOB);'
            'CREATE INDEX timestamp_idx ON messages (timestamp ASC);'
        )
        numbers = {name: number for number, name in enumerate(PRESS_TYPES, start=1)}
        topics = [(numbers[name], name, kind, 'cdr', '') for name, kind in PRESS_TYPES.items()]
        database.executemany('INSERT INTO topics VALUES (?, ?, ?, ?, ?)', topics)
        rows = [(numbers[one.topic], one.arrival, one.data) for one in messages]
        rows += [(99, BEGIN + SECOND, b'of no topic'), (1, BEGIN + 2 * SECOND, None)]
        database.executemany('INSERT INTO messages VALUES (NULL, ?, ?, ?)', rows)
        database.commit()
    write_metadata(bag, 'sqlite3', ['press_0.db3'], messages, PRESS_TYPES)
    return bag, parameters(folder, PRESS)


def write_metadata(bag, storage, names, messages, types):
    """Write what rosbag2 says of a bag."""
    arrivals = [one.arrival for one in messages]
    topics = [
        {
            'topic_metadata': {
                'name': name,
                'type': kind,
                'serialization_format': 'cdr',
                'offered_qos_profiles': '',
            },
            'message_count': sum(one.topic == name for one in messages),
        }
        for name, kind in types.items()
    ]
    information = {
        'version': 5,
        'storage_identifier': storage,
        'duration': {'nanoseconds': max(arrivals) - min(arrivals)},
        'starting_time': {'nanoseconds_since_epoch': min(arrivals)},
        'message_count': len(messages),
        'topics_with_message_count': topics,
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': names,
    }
    text = yaml.safe_dump({'rosbag2_bagfile_information': information}, sort_keys=False)
    (bag / 'metadata.yaml').write_text(text)


def truncated_mcap(folder):
    """Write the first two thirds of a file of a recorder that was killed; return them."""
    whole = folder / 'whole.mcap'
    write_mcap(whole, cell_messages(), CompressionType.NONE)
    part = folder / 'killed.mcap.active'
    part.write_bytes(whole.read_bytes()[: 2 * whole.stat().st_size // 3])
    return part, parameters(folder, CELL)


FOREIGN = {'mcap': mcap_bag, 'sqlite3': sqlite_bag}
"""What writes a bag, and its parameters, by its storage."""
