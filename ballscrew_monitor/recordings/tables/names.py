# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the name of a column says: which axis, which quantity, which unit."""

from collections.abc import Mapping, Sequence
import dataclasses
import re

from ballscrew_monitor.recordings.tables.mapping import UNITS

_WORD = re.compile(r'[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+')
_BRACKETS = re.compile(r'[\[(]([^\])]+)[\])]')
LINEAR = frozenset('xyz')
SECONDARY = frozenset('uvw')  # with a number: alone they mean other things, too
ROTARY = frozenset('abc')
SPINDLES = frozenset({'s', 'sp', 'spindle'})
KINDS = {
    'speed': {'velocity', 'vel', 'speed', 'rpm', 'omega'},
    'position': {'position', 'pos'},
    'load': {'force', 'load', 'thrust'},
    'torque': {'torque', 'trq', 'moment'},
    'current': {'current', 'amps', 'amp', 'iq'},
    'temperature': {'temperature', 'temp'},
    'time': {'time', 'timestamp', 'stamp', 't', 'datetime', 'date', 'seconds', 'elapsed'},
}
# Words that make a column something else, whatever else its name says.
OTHERS = frozenset(
    'acceleration accel acc jerk voltage volt volts power error deviation feedrate override '
    'program sequence number line block inertia bus count index status limit percent pct'.split()
)
ELSEWHERE = frozenset('motor drive ambient cabinet winding room air coolant'.split())
MEASURED = frozenset('actual act feedback fb measured meas encoder real'.split())
WANTED = frozenset(
    'command commanded cmd set setpoint target reference ref demand desired nominal'.split()
)
OF_THE_SCREW = frozenset('oil nut screw lubricant ballscrew'.split())
_ALIASES = {
    'mm/s': ('mm_s', 'mmps', 'mm/sec'),
    'm/s': ('m_s', 'mps', 'm/sec'),
    'mm/min': ('mm_min', 'mmpm'),
    'm/min': ('m_min',),
    'rev/min': ('rpm', '1/min', 'r/min', 'u/min', 'min-1'),
    'rad/s': ('rad_s', 'radps', 'rad/sec'),
    'N m': ('nm', 'n.m', 'n*m', 'n_m'),
    'degC': ('c', '°c', 'deg_c', 'celsius'),
    'A': ('a', 'amp', 'amps'),
    's': ('sec', 'seconds'),
    'ms': ('msec', 'millis'),
    'us': ('usec', 'µs'),
}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Named:
    """
    What the name of a column says.

    Axis such as x1, empty for none; `place` is axis, spindle, other or machine; kind of quantity
    or nothing; unit or nothing; `rank` is how much it is the measured quantity.

    """

    column: str
    place: str
    axis: str
    kind: str
    unit: str
    rank: int


def read_name(column: str) -> Named:
    """Return what the name of a column says."""
    words = [word.lower() for word in _WORD.findall(_BRACKETS.sub(' ', column))]
    place, axis = _place(words)
    kind = _kind(words)
    unit = _unit(column, kind)
    # In another unit than those of the quantity it is another quantity, such as a load in percent.
    if _BRACKETS.search(column) and not unit:
        kind = ''
    return Named(column=column, place=place, axis=axis, kind=kind, unit=unit, rank=_rank(words))


def is_of_the_screw(column: str) -> bool:
    """Tell whether the name of a column says that it is about the screw or its oil."""
    return bool(OF_THE_SCREW & {word.lower() for word in _WORD.findall(column)})


def axis_names(named: Sequence[Named]) -> dict[str, str]:
    """Return the name of the axis for each that is found: the number goes if there is one."""
    found = sorted({one.axis for one in named if one.place == 'axis'})
    letters = [axis.rstrip('0123456789') for axis in found]
    return {
        axis: letter if letter != 'axis' and letters.count(letter) == 1 else axis
        for axis, letter in zip(found, letters)
    }


def _place(words: Sequence[str]) -> tuple[str, str]:
    for number, (word, after) in enumerate(zip(words, [*words[1:], ''])):
        digits = after if after.isdigit() else ''
        if word in LINEAR or (word in SECONDARY and digits) or (word == 'axis' and digits):
            return 'axis', word + digits
        if word == 'spindle' or (number == 0 and word in SPINDLES):
            return 'spindle', ''
        if number == 0 and len(word) == 1 and digits:
            return ('rotary' if word in ROTARY else 'other'), ''
    return 'machine', ''


def _kind(words: Sequence[str]) -> str:
    """Return the quantity that the last word about one names: `current position` is a place."""
    if OTHERS & set(words):
        return ''
    found = [kind for word in words for kind, known in KINDS.items() if word in known]
    if not found or (found[-1] == 'temperature' and ELSEWHERE & set(words)):
        return ''
    return found[-1]


def _rank(words: Sequence[str]) -> int:
    present = set(words)
    return (
        2 * bool(MEASURED & present)
        + bool(OF_THE_SCREW & present)
        - 3 * bool(WANTED & present)
        - bool({'output', 'raw'} & present)
    )


def _unit(column: str, kind: str) -> str:
    """Return the unit in brackets or at the end of a name, if it is one of the quantity."""
    allowed = _spellings(UNITS.get(kind, {}))
    brackets = _BRACKETS.findall(column)
    parts = column.split('_')
    ends = ['_'.join(parts[-number:]) for number in (2, 1) if len(parts) > number]
    words = [word.lower() for word in _WORD.findall(column)]
    for text in [*brackets, *ends, *(word for word in words if word == 'rpm')]:
        if text.strip().lower() in allowed:
            return allowed[text.strip().lower()]
    return ''


def _spellings(units: Mapping[str, float]) -> dict[str, str]:
    spelt = {unit.lower(): unit for unit in units}
    return spelt | {alias: unit for unit in units for alias in _ALIASES.get(unit, ())}
