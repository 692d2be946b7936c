# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Snapshot of all that a monitor remembers as JSON, and back, bit for bit, for recordings."""

import base64
import binascii
from collections.abc import Mapping
import enum
from typing import Any

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Source, StampSource, Why
from ballscrew_monitor.core.judgement import Code, EventEnd, Level, Zone
from ballscrew_monitor.core.state import Ending, MonitorSettings
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.judge.slopes import MOST, SlopeRing
import numpy as np
from surrogate.files import InputError
from surrogate.surface import Regime, Surface
from surrogate.surface.records import as_array, dtype_of, from_array

CODES: dict[str, type[enum.IntEnum]] = {
    'direction': Direction,
    'level': Level,
    'event_code': Code,
    'event_direction': Direction,
    'moment_regime': Regime,
    'moment_zone': Zone,
    'stamp_source': StampSource,
}
"""Codes in a memory and what they are numbers of."""


def snapshot(monitor: Monitor) -> dict[str, Any]:
    """Return all that a monitor remembers, as JSON takes it; every bit of a number is kept."""
    parts = {name: getattr(monitor, name) for name in ('memory', 'speeds', 'positions')}
    return {
        'records': {
            name: base64.b64encode(as_array(part).tobytes()).decode()
            for name, part in parts.items()
            if not isinstance(part, SlopeRing) or part.count
        },
        'joints': {
            source.name: [[others.array, others.joint, *others.names] for others in heard]
            for source, heard in monitor.joints.named.items()
            if heard
        },
        'shelve_reason': monitor.shelve_reason,
        'ending': [monitor.ending.kind.name, monitor.ending.name, monitor.ending.reason],
    }


def restored(taken: Mapping[str, Any], surface: Surface, settings: MonitorSettings) -> Monitor:
    """
    Return the monitor that remembers what a snapshot holds.

    Raises InputError for what no monitor has remembered.

    """
    monitor = Monitor(surface, settings)
    try:
        records = taken['records']
        monitor.memory = _record(Memory, records['memory'])
        for name in {'speeds', 'positions'} & {*records}:
            setattr(monitor, name, _record(SlopeRing, records[name]))
        for name, heard in taken['joints'].items():
            others = (OtherJoints(array, joint, tuple(names)) for array, joint, *names in heard)
            monitor.joints.named[Source[name]] = dict.fromkeys(others)
        monitor.shelve_reason = str(taken['shelve_reason'])
        kind, name, reason = taken['ending']
        monitor.ending = Ending(kind=EventEnd[kind], name=str(name), reason=str(reason))
        _check(monitor)
    except (AttributeError, KeyError, TypeError, ValueError, binascii.Error) as error:
        raise InputError(f'the memory is damaged: {error}') from None
    return monitor


def _check(monitor: Monitor) -> None:
    """Raise ValueError for a number that is no place in a list and no code of the judgement."""
    memory = monitor.memory
    for name, kind in CODES.items():
        codes = getattr(memory, name)
        for number in codes if isinstance(codes, list) else [codes]:
            kind(number)
    for why in memory.refusal:
        Why(max(why, 0))
    for ring in (monitor.speeds, monitor.positions):
        if not (0 <= ring.begin < MOST and 0 <= ring.count <= MOST):
            raise ValueError(f'a window of {ring.count} samples from {ring.begin} on')


def _record(kind: type[Any], text: str) -> Any:
    """Return a record out of its bytes; raises ValueError for another length."""
    (element,) = np.frombuffer(base64.b64decode(text, validate=True), dtype=dtype_of(kind))
    return from_array(kind, element)
