# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns, read: axis, quantity, unit as it is spelt; and the columns of each axis."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
import re

from ballscrew_monitor.recordings.tables.mapping import INPUTS, UNITS

WORD = re.compile(r'[A-ZÄÖÜ]+(?![a-zäöüßµμ°])|[A-ZÄÖÜ]?[a-zäöüßµμ°]+|\d+')
"""A word of a name: of one case, or of small letters after a capital; or a number."""
BRACKETS = re.compile(r'[\[(]([^\])]+)[\])]')
_PER = re.compile(r'[\s_]*(?:/|_|\s|(?<![a-z])per(?![a-z]))[\s_]*')
_CAMEL_PER = re.compile(r'(?<=[a-z])Per(?=[A-Z])')
_LONGEST = 4  # words of a unit, such as m per min in camel case
_BY_ITSELF = 2  # letters of a unit that says without brackets which quantity it is of
_OTHER_WORDS = frozenset({'min', 'rev', 'rad', 'deg', 'nm', 'ma', 'amp', 'amps'})
_ALIASES = {
    'mm/s': ('mmps', 'mm/sec'),
    'm/s': ('mps', 'm/sec'),
    'mm/min': ('mmpm',),
    'm/min': ('mpm',),
    'rev/min': ('rpm', '1/min', 'r/min', 'u/min', 'min-1', 'min^-1', 'min⁻¹', 'turns/min'),
    'rad/s': ('radps', 'rad/sec'),
    'N m': ('nm', 'n.m', 'n*m', 'n·m'),
    'degC': ('c', '°c', 'deg/c', '°/c', 'celsius'),
    'A': ('amp', 'amps'),
    's': ('sec', 'seconds'),
    'ms': ('msec', 'millis'),
    'us': ('usec', 'µs', 'μs'),
}


def unit_of(column: str, kind: str) -> str:
    """Return the unit of a kind of quantity that a name of a column states, empty if none."""
    known = _SPELLINGS.get(kind, {})
    return next((known[text] for text in _stated(column) if text in known), '')


def kind_by_unit(column: str) -> tuple[str, str]:
    """
    Return the only quantity that is stated in a unit, and the words of the name before the unit.

    Both are empty when the name states no unit, or one that without brackets may be a word.

    """
    inside = [_plain(text) for text in BRACKETS.findall(column)]
    texts = [*inside, *(text for text in _ends(column) if _stands_alone(text))]
    for text in texts:
        kinds = [kind for kind, known in _SPELLINGS.items() if text in known]
        if len(kinds) == 1:
            return kinds[0], _before(column, text)
    return '', ''


def words_of(text: str) -> list[str]:
    """Return the words of a name in small letters, without what stands in brackets."""
    return [word.lower() for word in WORD.findall(BRACKETS.sub(' ', text))]


def words_without_unit(column: str, kind: str) -> list[str]:
    """Return the words of a name, without the unit of a kind of quantity at its end."""
    known = _SPELLINGS.get(kind, {})
    text = next((text for text in _ends(column) if text in known), '')
    return words_of(_before(column, text) if text else column)


def _stands_alone(text: str) -> bool:
    return len(text) >= _BY_ITSELF and text not in _OTHER_WORDS


def _stated(column: str) -> Iterator[str]:
    """Yield what may be a unit: in brackets, at the end, `rpm` anywhere, longer inside."""
    yield from (_plain(text) for text in BRACKETS.findall(column))
    yield from _ends(column)
    bare = BRACKETS.sub(' ', column)
    spans = [match.span() for match in WORD.finditer(bare)]
    yield from (word for word in words_of(column) if word == 'rpm')
    for length in range(_LONGEST, 0, -1):
        for first in range(1, len(spans) - length + 1):
            begin, end = spans[first][0], spans[first + length - 1][1]
            text = _plain(bare[begin:end])
            if _stands_alone(text):
                yield text


def _ends(column: str) -> list[str]:
    """Return the last words of a name as they are joined, most of them first, but never all."""
    bare = BRACKETS.sub(' ', column).strip()
    starts = [match.start() for match in WORD.finditer(bare)][1:]
    return [_plain(bare[start:]) for start in starts[-_LONGEST:]]


def _before(column: str, unit: str) -> str:
    """Return a name without its brackets and without a unit at its end."""
    bare = BRACKETS.sub(' ', column).strip()
    starts = [match.start() for match in WORD.finditer(bare)]
    cut = next((start for start in starts if _plain(bare[start:]) == unit), len(bare))
    return bare[:cut]


def _plain(text: str) -> str:
    """Return a spelling with one sign for all that stands between its words: / ."""
    return _PER.sub('/', _CAMEL_PER.sub('/', text.strip()).lower()).strip('/')


def _spellings(units: Mapping[str, float]) -> dict[str, str]:
    spelt = {_plain(unit): unit for unit in units}
    return spelt | {_plain(alias): unit for unit in units for alias in _ALIASES.get(unit, ())}


_SPELLINGS = {kind: _spellings(units) for kind, units in UNITS.items()}


LINEAR = frozenset('xyz')
SECONDARY = frozenset('uvw')  # with a number: alone they mean other things, too
ROTARY = frozenset('abc')
SPINDLES = frozenset({'s', 'sp', 'spindle'})
KINDS = {
    'speed': frozenset('velocity vel speed rpm omega feed geschwindigkeit drehzahl'.split()),
    'position': frozenset('position pos'.split()),
    'load': frozenset('force load thrust kraft axialkraft'.split()),
    'torque': frozenset('torque trq moment drehmoment'.split()),
    'current': frozenset('current amps amp iq strom'.split()),
    'temperature': frozenset('temperature temp temperatur'.split()),
    'time': frozenset(
        'time timestamp stamp t datetime date seconds elapsed clock ticks '
        'zeit zeitstempel messzeit laufzeit uhrzeit datum'.split()
    ),
}
# Words that make a column something else, whatever else its name says.
OTHERS = frozenset(
    'acceleration accel acc jerk voltage volt volts power error deviation feedrate rate override '
    'program sequence number line block inertia bus count index status limit percent pct'.split()
)
ELSEWHERE = frozenset('motor drive ambient cabinet winding room air coolant'.split())
MEASURED = frozenset('actual act feedback fb measured meas encoder real ist'.split())
WANTED = frozenset(
    'command commanded cmd set setpoint target reference ref demand desired nominal soll'.split()
)
QUALIFIERS = frozenset('filtered smoothed mean average avg rms value'.split())
PROCESSED = frozenset('output raw'.split())
OF_THE_SCREW = frozenset('oil nut screw lubricant ballscrew öl oel'.split())
TELLS_NOTHING = MEASURED | WANTED | PROCESSED | OF_THE_SCREW | {'axis'}
BY_UNIT = -4  # rank of a column of which the unit alone tells the quantity
MOTION = ('speed', 'position')
_NAME = re.compile(r'[a-z][a-z0-9_]*')
TIMES_BY_UNIT = frozenset({'ms', 'us', 'ns', 's'})  # of a column that names no quantity


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
    words = words_of(column)
    place, axis = _place(words)
    kind, rank = _kind(words), _rank(words)
    if not kind and not OTHERS & set(words):
        kind = _kind_by_unit(column, place)
        rank += 0 if is_of_the_screw(column) else BY_UNIT
    unit = unit_of(column, kind)
    # In another unit than those of the quantity it is another quantity, such as a load in percent.
    if BRACKETS.search(column) and not unit:
        kind = ''
    return Named(column=column, place=place, axis=axis, kind=kind, unit=unit, rank=rank)


def is_of_the_screw(column: str) -> bool:
    """Tell whether the name of a column says that it is about the screw or its oil."""
    return bool(OF_THE_SCREW & set(words_of(column)))


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


def _kind_by_unit(column: str, place: str) -> str:
    """Return the quantity that the unit of a column tells, where no other word may deny it."""
    kind, before = kind_by_unit(column)
    if kind == 'time':
        told = place == 'machine' and unit_of(column, kind) in TIMES_BY_UNIT
    else:
        told = all(len(word) == 1 or word in TELLS_NOTHING for word in words_of(before))
    return kind if told else ''


def _rank(words: Sequence[str]) -> int:
    present = set(words)
    return (
        2 * bool(MEASURED & present)
        + bool(OF_THE_SCREW & present)
        - 3 * bool(WANTED & present)
        - bool(PROCESSED & present)
    )


def word_of_the_axis(named: Named) -> str:
    """Return the words of a name that say neither quantity nor unit: which axis is left."""
    words = words_without_unit(named.column, named.kind)
    dull = TELLS_NOTHING | QUALIFIERS | ELSEWHERE | KINDS.get(named.kind, frozenset())
    return '_'.join(word for word in words if word not in dull)


def by_axis(named: Sequence[Named]) -> dict[str, list[Named]]:
    """
    Return the columns of each axis.

    Axes are told by letters such as X or X1. Without any, they are told by the part in which the
    names of several speeds (or positions) differ, and otherwise all is of the only axis, x.

    """
    names = axis_names(named)
    general = [one for one in named if one.place == 'machine']
    groups = (
        {name: [one for one in named if one.axis == axis] for axis, name in names.items()}
        if names
        else _by_word(general)
    )
    if not groups:
        return {'x': general}
    grouped = {one.column for group in groups.values() for one in group}
    oil = [one for one in general if one.kind == 'temperature' and one.column not in grouped]
    return {name: [*group, *oil] for name, group in groups.items()}


def best(found: Sequence[Named]) -> dict[str, Named]:
    """Return for each kind the column that is most likely the measured quantity."""
    ranked = sorted(found, key=lambda one: -one.rank)
    chosen: dict[str, Named] = {}
    for one in ranked:
        if one.kind in INPUTS:
            chosen.setdefault(one.kind, one)
    return chosen


def told_by_words(named: Sequence[Named]) -> list[str]:
    """Return a sentence if axes are told by words alone, which may mean other things, too."""
    words = {} if axis_names(named) else _by_word([one for one in named if one.place == 'machine'])
    return [f'axes {", ".join(words)} are told by words: are all of them ball screws?'] * bool(
        words
    )


def left_out(left: Sequence[Named]) -> list[str]:
    """Return sentences about columns of which nothing is used."""
    notes = []
    spindle = sum(one.place == 'spindle' for one in left)
    if spindle:
        notes.append(f'{spindle} columns are of the spindle, which is no ball-screw axis')
    others = [one.column for one in left if one.place != 'spindle']
    if others:
        notes.append(f'not used: {", ".join(others)}')
    return notes


def _by_word(general: Sequence[Named]) -> dict[str, list[Named]]:
    """Return the columns of axes that only a word tells apart; nothing for less than two."""
    words = {one.column: _axis_name(one) for one in general if one.kind in INPUTS}
    for kind in MOTION:
        axes = sorted({words[one.column] for one in general if one.kind == kind} - {''})
        if len(axes) > 1:
            return {
                axis: [one for one in general if words.get(one.column) == axis] for axis in axes
            }
    return {}


def _axis_name(one: Named) -> str:
    """Return the name of an axis by the word that tells it, empty if that makes no name."""
    word = word_of_the_axis(one)
    name = f'axis{word}' if word.isdigit() else word
    return name if _NAME.fullmatch(name) else ''
