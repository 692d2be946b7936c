# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Parts of every generator: topics, messages as bytes, and the bag that appears when complete.

The bytes are the same every time.

"""

from collections.abc import Iterable, Mapping
import dataclasses
from pathlib import Path

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag_writer import Offer, Topic, whole_bag
from builtin_interfaces.msg import Time
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Header

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


def joint_state(stamp: int, position: float, velocity: float, *effort: float) -> bytes:
    """Return the joint `x_axis`: screw angle [rad], its speed [rad/s], torque [N m] if any."""
    return serialized(
        JointState(
            header=_header(stamp, 'x_axis'),
            name=['x_axis'],
            position=[position],
            velocity=[velocity],
            effort=list(effort),
        )
    )


def wrench(stamp: int, force: float) -> bytes:
    """Return the force on the nut [N]."""
    message = WrenchStamped(header=_header(stamp, 'x_nut'))
    message.wrench.force.x = force
    return serialized(message)


def temperature(stamp: int, degrees: float) -> bytes:
    """Return the oil temperature [degC]."""
    return serialized(
        Temperature(header=_header(stamp, 'x_nut'), temperature=degrees, variance=0.0025)
    )


def _header(stamp: int, frame: str) -> Header:
    seconds, rest = divmod(stamp, SECOND)
    return Header(stamp=Time(sec=seconds, nanosec=rest), frame_id=frame)


def write_bag(
    directory: Path, records: Iterable[Record], texts: Mapping[str, str] | None = None
) -> None:
    """
    Write the bag to `directory`, which appears, or is replaced, only when it is complete.

    `texts` are its metadata, such as the parameters to judge it with.

    """
    # Uncompressed, so that the bytes do not depend on the version of a compressor.
    with whole_bag(directory, directory.resolve().name, compress=False) as writer:
        if texts:
            writer.add_metadata(texts)
        for topic in TOPICS:
            writer.add_topic(topic)
        for record in records:
            writer.write(
                record.topic, record.data, log_time=record.log_time, publish_time=record.stamp
            )
