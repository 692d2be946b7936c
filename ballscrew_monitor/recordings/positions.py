# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Positions of an axis out of a recording, which the judgement of its speed does not need.

In a bag they stand beside the speed in its JointState, or are what the speed is worked out from. A
table may hold that of the table of the machine as well, by its own scale.

"""

from collections.abc import Iterator, Mapping
import contextlib
import dataclasses
import functools
from typing import Any

from ballscrew_monitor.core.conversions import nanoseconds, POSITION_UNITS, Scaling, SECOND
from ballscrew_monitor.core.inputs import Input, OpenInput, Source
from ballscrew_monitor.health.stroke import Positions
from ballscrew_monitor.judge.records import SAMPLE
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.events import Notes
from ballscrew_monitor.recordings.bulk.order import ordered_events
from ballscrew_monitor.settings.axis import Axis, build_axis, scaling_of
from ballscrew_monitor.settings.parameters import absolute, with_types
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.units import TURN

NO_STAMPS, NO_VALUES = np.zeros(0, np.int64), np.zeros(0)
JOINT_STATE = 'sensor_msgs/msg/JointState'
OF_JOINTS = {'rad/s': 'rad', 'm/s': 'm'}
"""Units of a joint's velocity, with that of the position beside it."""
MOVED = 0.1  # [rad] of the screw, more than the noise of the encoder of an axis at rest


@functools.singledispatch
def positions_of(bag: Bag, axis: str, values: Mapping[str, Any]) -> Positions | None:
    """Return the positions of an axis in `bag`, None where the bag holds none."""
    values = with_types(values, bag.types)
    built = build_axis(axis, values)
    position = _input(bag, axis, values, built.surface.lead)
    if position is None:
        return None
    alone = dataclasses.replace(built, inputs=(position,), open_inputs=())
    period, parts = nanoseconds(values['tick_period']), [(NO_STAMPS, NO_VALUES)]
    again = Bag(bag.path, salvage=True)  # remarks on messages are those of the judgement
    for events in ordered_events(again, [alone], period, Notes(), on_done=lambda share: None):
        samples = events[(events['kind'] == SAMPLE) & np.isfinite(events['value'])]
        parts.append((samples['stamp'], samples['value']))
    stamps, turned = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    order = np.argsort(stamps, kind='stable')
    if not len(order):
        return None
    return Positions(stamps[order], turned[order] * built.surface.lead / TURN)


def position_beside(values: Mapping[str, Any], axis: str, kind: str) -> tuple[str, str] | None:
    """Return field and unit of the position beside a joint's velocity; None for other speeds."""
    field, unit = (values[f'{axis}.speed.{leaf}'] for leaf in ('field', 'unit'))
    if kind != JOINT_STATE or unit not in OF_JOINTS or 'velocity' not in field:
        return None
    return field.replace('velocity', 'position'), OF_JOINTS[unit]


def by_position(bag: Bag, values: Mapping[str, Any]) -> dict[str, tuple[str, str]]:
    """
    Return by axis field and unit of the position that is to be read in place of the velocity.

    This is so where the velocity is 0 or missing throughout a bag, and the position moves.

    """
    positions = {}
    values = with_types(values, bag.types)
    for axis in values['axes']:
        topic = absolute(values[f'{axis}.speed.topic'])
        beside = position_beside(values, axis, values[f'{axis}.speed.type'])
        if beside is None or topic not in bag.topics:
            continue
        with contextlib.suppress(InputError):  # the judgement says what is wrong
            built = build_axis(axis, values)
            speed = next(source for source in built.inputs if source.source is Source.SPEED)
            position = _input(bag, axis, values, built.surface.lead)
            if position is None or any(part.any() for part in _numbers(bag, built, speed)):
                continue
            parts = list(_numbers(bag, built, position))
            if parts and np.ptp([(part.min(), part.max()) for part in parts]) > MOVED:
                positions[axis] = beside
    return positions


def still_speed(axis: str, velocity: str, position: str, unit: str) -> str:
    """Return what is read in place of a velocity that is 0 while the axis moves."""
    return (
        f'axis {axis}: {velocity} is 0 or missing throughout while {position} moves: the speed is '
        f"the slope of the position, as with {axis}.speed.field '{position}' and "
        f"{axis}.speed.unit '{unit}'"
    )


def _numbers(bag: Bag, built: Axis, source: Input) -> Iterator[NDArray[np.float64]]:
    """Yield the samples of an input of an axis, in parts that hold some [SI]."""
    alone = dataclasses.replace(built, inputs=(source,), open_inputs=())
    again = Bag(bag.path, salvage=True)  # remarks on messages are those of the judgement
    for events in ordered_events(again, [alone], SECOND, Notes(), on_done=lambda share: None):
        values = events['value'][(events['kind'] == SAMPLE) & np.isfinite(events['value'])]
        if len(values):
            yield values


def _input(bag: Bag, axis: str, values: Mapping[str, Any], lead: float) -> Input | None:
    """Return the input that reads the position of an axis [rad], None where there is none."""
    topic, field, unit, kind = (
        values[f'{axis}.speed.{leaf}'] for leaf in ('topic', 'field', 'unit', 'type')
    )
    if absolute(topic) not in bag.topics:
        return None
    if unit not in POSITION_UNITS:
        beside = position_beside(values, axis, kind)
        if beside is None:
            return None
        field = beside[0]
    line = scaling_of(axis, values, Source.SPEED, lead)
    scaling = Scaling(factor=line.factor, shift=0.0)
    try:
        return OpenInput(source=Source.SPEED, topic=topic, field=field, scaling=scaling).close(
            kind
        )
    except InputError:
        return None
