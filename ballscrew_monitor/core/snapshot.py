# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A monitor as plain JSON and back: what a recording must hold to go on from there, bit for bit.

Numbers keep every bit, `nan` and infinities included. Of the classes of the core only those that
are listed are written, and nothing else is ever made from a file. Surface and settings are not
part of it: they belong to the parameters and are given when the monitor is made again.

"""

import collections
from collections.abc import Mapping
import dataclasses
import enum
import math
from typing import Any

from ballscrew_monitor.core import (
    advice,
    conversions,
    derived_load,
    differentiation,
    estimate,
    excursions,
    fields,
    input_status,
    inputs,
    judgement,
    point_reader,
    shelving,
    tally,
)
from ballscrew_monitor.core import state as states
from ballscrew_monitor.core.monitor import Monitor
from surrogate.files import InputError
from surrogate.surface import Regime, Surface, Validity

# Parts of a monitor that are not written.
GIVEN = ('settings', 'surface', '_surface_id', 'observer')
ENUMS: dict[str, type[enum.Enum]] = {
    kind.__name__: kind
    for kind in (
        conversions.Direction,
        estimate.PointSource,
        input_status.InputState,
        inputs.Source,
        inputs.StampSource,
        inputs.Why,
        judgement.Code,
        judgement.Level,
        judgement.Severity,
        judgement.Zone,
        Regime,
        Validity,
    )
}
CLASSES: dict[str, type[Any]] = {
    kind.__name__: kind
    for kind in (
        advice.Advisor,
        derived_load.DerivedLoad,
        differentiation.SlopeFilter,
        differentiation.SpeedFromPosition,
        estimate.MachinePoint,
        fields.OtherJoints,
        input_status.Tracker,
        inputs.InputSample,
        inputs.Refusal,
        judgement.Finding,
        judgement.Hold,
        judgement.Limits,
        judgement.UnbrokenRun,
        point_reader.PointReader,
        shelving.Shelving,
        states.Event,
        excursions.Excursions,
        tally.Account,
        tally.Column,
        tally.Moment,
        tally.WindowTally,
    )
} | {'Stays': excursions.Excursions}  # its name in recordings of version 1


def freeze_monitor(monitor: Monitor) -> dict[str, Any]:
    """Return what a monitor remembers, as JSON takes it; raises TypeError for other classes."""
    return {name: _freeze(part) for name, part in _parts(monitor).items() if name not in GIVEN}


def thaw_monitor(
    frozen: Mapping[str, Any], surface: Surface, settings: states.MonitorSettings
) -> Monitor:
    """
    Return the monitor that remembers what was frozen.

    Raises InputError for what no monitor of this version has written.

    """
    monitor = Monitor(surface, settings)
    wanted = _parts(monitor).keys() - set(GIVEN)
    if frozen.keys() != wanted:
        odd = ', '.join(sorted(frozen.keys() ^ wanted))
        raise InputError(
            f'the recording is of another version of the monitor, it differs in {odd}'
        )
    try:
        for name, part in frozen.items():
            setattr(monitor, name, _thaw(part, surface))
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(f'the recording holds no memory of a monitor: {error}') from None
    return monitor


def _parts(thing: Any) -> dict[str, Any]:
    """Return the attributes of an object, with or without slots."""
    if hasattr(thing, '__slots__'):
        return {name: getattr(thing, name) for name in thing.__slots__}
    return dict(vars(thing))


def _freeze(value: Any) -> Any:
    if isinstance(value, enum.Enum):
        return {'enum': type(value).__name__, 'value': value.value}
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else {'float': repr(value)}
    if isinstance(value, (tuple, collections.deque)):
        kind = 'tuple' if isinstance(value, tuple) else 'deque'
        return {kind: [_freeze(part) for part in value], 'most': getattr(value, 'maxlen', None)}
    if isinstance(value, dict):
        return {'pairs': [[_freeze(key), _freeze(part)] for key, part in value.items()]}
    return _freeze_object(value)


def _freeze_object(value: Any) -> dict[str, Any]:
    name = type(value).__name__
    if CLASSES.get(name) is not type(value):
        raise TypeError(f'{name} is no part of the memory of a monitor')
    parts = _parts(value)
    if name == 'Advisor':  # worked out again when it is asked for
        parts = {'point': value.point, 'limits': value.limits}
    return {'class': name, 'parts': {part: _freeze(one) for part, one in parts.items()}}


def _thaw(value: Any, surface: Surface) -> Any:
    if not isinstance(value, dict):
        return value
    if 'enum' in value:
        return ENUMS[value['enum']](value['value'])
    if 'float' in value:
        return float(value['float'])
    if 'tuple' in value:
        return tuple(_thaw(part, surface) for part in value['tuple'])
    if 'deque' in value:
        parts = [_thaw(part, surface) for part in value['deque']]
        return collections.deque(parts, maxlen=value['most'])
    if 'pairs' in value:
        return {_thaw(key, surface): _thaw(part, surface) for key, part in value['pairs']}
    return _thaw_object(value, surface)


def _thaw_object(value: Mapping[str, Any], surface: Surface) -> Any:
    kind = CLASSES[value['class']]
    parts = {name: _thaw(part, surface) for name, part in value['parts'].items()}
    if kind is advice.Advisor:
        return advice.Advisor(surface=surface, **parts)
    if dataclasses.is_dataclass(kind):
        return kind(**parts)
    made: Any = object.__new__(kind)
    for name, part in parts.items():
        setattr(made, name, part)
    return made
