# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What every generator shares: topics, messages as bytes, and the bag that appears when complete.

The bytes are the same every time.

"""

from collections.abc import Iterable
import dataclasses
import os
from pathlib import Path
import shutil
import struct
import tempfile

from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic

BEGIN = 1_767_600_000_000_000_000  # [ns] 2026-01-05 08:00 UTC
JOINT_STATES = Topic(
    name='/joint_states', type_name='sensor_msgs/msg/JointState', offer=Offer.SENSOR
)
AXIAL_LOAD = Topic(
    name='/axial_load', type_name='geometry_msgs/msg/WrenchStamped', offer=Offer.SENSOR
)
OIL_TEMPERATURE = Topic(
    name='/oil_temperature', type_name='sensor_msgs/msg/Temperature', offer=Offer.SENSOR
)
TOPICS = (JOINT_STATES, AXIAL_LOAD, OIL_TEMPERATURE)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Record:
    """One message: topic, stamp and log time [ns], serialised."""

    topic: str
    stamp: int
    log_time: int
    data: bytes


class Cdr:
    """Little-endian CDR with zeroed padding, which a ROS serialiser does not promise."""

    def __init__(self, stamp: int, frame: str) -> None:
        """Begin a message with its header."""
        self._bytes = bytearray()
        self.put('i', stamp // 1_000_000_000)
        self.put('I', stamp % 1_000_000_000)
        self.text(frame)

    def put(self, kind: str, *values: float) -> None:
        """Append numbers of one kind, aligned to its size."""
        size = struct.calcsize(f'<{kind}')
        self._bytes += bytes(-len(self._bytes) % size)
        self._bytes += struct.pack(f'<{len(values)}{kind}', *values)

    def text(self, value: str) -> None:
        """Append a text."""
        data = value.encode() + b'\0'
        self.put('I', len(data))
        self._bytes += data

    def doubles(self, *values: float) -> None:
        """Append a sequence of float64."""
        self.put('I', len(values))
        if values:
            self.put('d', *values)

    def message(self) -> bytes:
        """Return the serialised message."""
        return b'\0\1\0\0' + bytes(self._bytes)


def joint_state(stamp: int, position: float, velocity: float, *effort: float) -> bytes:
    """Return the joint `x_axis`: screw angle [rad], its speed [rad/s], torque [N m] if any."""
    cdr = Cdr(stamp, 'x_axis')
    cdr.put('I', 1)
    cdr.text('x_axis')
    cdr.doubles(position)
    cdr.doubles(velocity)
    cdr.doubles(*effort)
    return cdr.message()


def wrench(stamp: int, force: float) -> bytes:
    """Return the force on the nut [N]."""
    cdr = Cdr(stamp, 'x_nut')
    cdr.put('d', force, 0.0, 0.0, 0.0, 0.0, 0.0)
    return cdr.message()


def temperature(stamp: int, degrees: float) -> bytes:
    """Return the oil temperature [degC]."""
    cdr = Cdr(stamp, 'x_nut')
    cdr.put('d', degrees, 0.0025)
    return cdr.message()


def write_bag(directory: Path, records: Iterable[Record]) -> None:
    """Write the bag to `directory`, which appears, or is replaced, only when it is complete."""
    directory = directory.resolve()
    directory.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(tempfile.mkdtemp(prefix=f'.{directory.name}.', dir=directory.parent))
    try:
        _write(partial, directory.name, records)
        partial.chmod(0o755)
        if directory.exists():
            shutil.rmtree(directory)
        os.replace(partial, directory)
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _write(directory: Path, name: str, records: Iterable[Record]) -> None:
    # Uncompressed, so that the bytes do not depend on the version of a compressor.
    with BagWriter(directory, name, compress=False) as writer:
        for topic in TOPICS:
            writer.add_topic(topic)
        for record in records:
            writer.write(
                record.topic, record.data, log_time=record.log_time, publish_time=record.stamp
            )
