# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Positions of an axis out of a recording, which the judgement of its speed does not need.

In a bag they stand beside the speed in its JointState, or are what the speed is worked out from. A
table may hold that of the table of the machine as well, by its own scale.

"""

from collections.abc import Mapping
import dataclasses
import functools
from typing import Any

from ballscrew_monitor.core.conversions import nanoseconds, POSITION_UNITS, Scaling
from ballscrew_monitor.core.inputs import Input, OpenInput, Source
from ballscrew_monitor.health.stroke import Positions
from ballscrew_monitor.judge.records import SAMPLE
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.events import Notes
from ballscrew_monitor.recordings.bulk.order import ordered_events
from ballscrew_monitor.settings.axis import build_axis, scaling_of
from ballscrew_monitor.settings.parameters import absolute, with_types
import numpy as np
from surrogate.files import InputError
from surrogate.units import TURN

NO_STAMPS, NO_VALUES = np.zeros(0, np.int64), np.zeros(0)
JOINT_STATE = 'sensor_msgs/msg/JointState'
OF_JOINTS = ('rad/s', 'm/s')
"""Units of a joint's velocity, with a position in rad and m beside it."""


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


def _input(bag: Bag, axis: str, values: Mapping[str, Any], lead: float) -> Input | None:
    """Return the input that reads the position of an axis [rad], None where there is none."""
    topic, field, unit, kind = (
        values[f'{axis}.speed.{leaf}'] for leaf in ('topic', 'field', 'unit', 'type')
    )
    if absolute(topic) not in bag.topics:
        return None
    if unit not in POSITION_UNITS:
        if kind != JOINT_STATE or unit not in OF_JOINTS or 'velocity' not in field:
            return None
        field = field.replace('velocity', 'position')
    line = scaling_of(axis, values, Source.SPEED, lead)
    scaling = Scaling(factor=line.factor, shift=0.0)
    try:
        return OpenInput(source=Source.SPEED, topic=topic, field=field, scaling=scaling).close(
            kind
        )
    except InputError:
        return None
