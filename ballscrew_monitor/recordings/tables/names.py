# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns, read: axis, quantity, unit as it is spelt; and the columns of each axis."""

from collections.abc import Callable, Sequence
import dataclasses
import re

from ballscrew_monitor.core.conversions import ROTARY_POSITION_UNITS
from ballscrew_monitor.recordings.tables import marks
from ballscrew_monitor.recordings.tables.quantities import INPUTS, MOTION, RATED, UNITS
from ballscrew_monitor.recordings.tables.unit_names import (
    BRACKETS,
    converted_unit,
    factor_of,
    kind_by_unit,
    LETTERED,
    unit_and_scale,
    unit_of,
    unknown_unit,
    with_brackets,
    words_of,
    words_without_unit,
)
from ballscrew_monitor.recordings.words import counted, listed, short

LINEAR = frozenset('xyz')
SECONDARY = frozenset('uvw')  # with a number: alone they mean other things, too
ROTARY = frozenset('abc')
AXIS = frozenset({'axis', 'achse'})
SPINDLES = frozenset({'s', 'sp', 'spindle'})
LOADS = frozenset('load zatížení obciążenie carico carga'.split())
KINDS = {
    'speed': frozenset(
        'velocity velo vel speed rpm omega feed frt '
        'geschwindigkeit geschw vorschub drehzahl '
        'vitesse velocità velocidad prędkość posuw rychlost posuv'.split()
    ),
    'position': frozenset(
        'position pos posf lage weg stellung posizione posición pozycja położenie poloha'.split()
    ),
    'load': frozenset('force frc thrust kraft forza fuerza siła síla'.split()) | LOADS,
    'torque': frozenset('torque trq tcmd effort moment drehmoment couple coppia'.split()),
    'current': frozenset(
        'current curr cur amps amp iq strom courant corrente corriente prąd proud'.split()
    ),
    'temperature': frozenset(
        'temperature temp temperatur température temperatura teplota'.split()
    ),
    'time': frozenset(
        'time timestamp stamp t datetime date seconds elapsed clock ticks epoch '
        'zeit zeitstempel messzeit laufzeit uhrzeit datum mjd '
        'temps horodatage tempo tiempo czas čas'.split()
    ),
}
# Words that make a column something else, whatever else its name says.
OTHERS = frozenset(
    'acceleration accel acc jerk ffw diff dev cont ctrl voltage volt volts power error deviation '
    'feedrate rate override max maximum peak threshold feedforward difference '
    'simulated estimated clamping '
    'lag delta increment correction compensation offset remaining go loss noise tolerance '
    'deadband resultant ripple residual window '
    'jog homing home standstill rapid eilgang ratio preload gravity disturbance '
    'program sequence number line block inertia bus count index status limit percent pct '
    'beschleunigung ruck spannung leistung fehler abweichung programm satz zeile nummer '
    'accélération erreur écart tension puissance accelerazione errore scarto potenza '
    'aceleración desviación potencia límite limite'.split()
).union(marks.WORDS)
ELSEWHERE = frozenset(
    'motor drive ambient cabinet winding room air coolant antrieb umgebung wicklung luft'.split()
)
OF_ANOTHER_PART = ELSEWHERE | frozenset(
    'hydraulic hydraulik gearbox gear getriebe reducer spindle spindel controller control '
    'regler steuerung cpu board chip processor inverter converter umrichter transformer sink '
    'heatsink battery brake bremse clutch chuck chiller cooler cooling heater kühl kühlung '
    'compressor pump pumpe tank reservoir water wasser encoder housing gehäuse bed frame bett '
    'workpiece werkstück tool werkzeug table tisch inlet outlet supply return hall halle outside '
    'outdoor environment exhaust fan alarm warning trip rise dew'.split()
)
"""Words of a temperature that is not that of the screw or its oil, whatever else they name."""
OF_ANOTHER_THING = frozenset(
    'tool cutting surface path wheel handwheel turret chuck tailstock grip gripper brake pump fan '
    'conveyor compressor coolant chiller workpiece part '
    'werkzeug werkstück bahn revolver reitstock greifer bremse pumpe lüfter'.split()
)
"""Words of a motion or load of something else, unless the letter of an axis stands beside them."""
BEARINGS = frozenset('bearing bearings lager'.split())
MEASURED = frozenset(
    'actual act feedback fb measured meas encoder enc real pv ist istwert '
    'réelle réel mesurée mesuré reale misurata misurato medida medido'.split()
)
WANTED = frozenset(
    'command commanded cmd com des vcmd set setpoint target reference ref demand desired nominal '
    'soll sollwert nenn nom programmed prog planned interpolator '
    'consigne commande commandée référence comando riferimento consigna referencia'.split()
)
QUALIFIERS = frozenset('filtered smoothed mean average avg rms value wert'.split())
PROCESSED = frozenset('output raw'.split())
OF_A_DIAGRAM = AXIS | {'value', 'values', 'wert', 'werte'}
OF_THE_SCREW = frozenset('oil nut screw lubricant ballscrew öl oel mutter'.split())
ENCODERS = frozenset(
    'encoder enc scale glass linear direct indirect motor messsystem maßstab massstab'.split()
)
"""Words of one of several encoders of an axis, whose numbers name no axis."""
SHORT = {
    'v': 'speed', 'f': 'load', 'i': 'current', 'iq': 'current', 'm': 'torque', 'p': 'position',
    's': 'position',
}  # fmt: skip
"""Letters of quantities that stand alone beside the letter of an axis."""
JOINED = re.compile(
    r'^(?:(?P<axis>[xyzXYZ](?:I(?=\d))?\d?)(?P<word>act[mw]?|com|abs|'
    r'pos(?:ition)?|vel(?:ocity)?|load|frt|[vfips])|'
    r'(?P<letter>[vfipmVFIPM])(?P<of>[xyz]))(?![a-z])'
)
"""
Axis and quantity in one word, as of MTConnect: Xact, X1actm, Zfrt; or Fx, vz.

The inclined axis Y of a lathe is YI1 to controls of Okuma.

"""
OF_CONTROL = re.compile(
    r'(?:^|(?<=[\s.]))(?:[SP]-\d-\d{4}(?:\.\d+)*|[rp]\d{2,5}(?:\[\d+\])?|0x[\da-fA-F]{4}(?::\d+)?)'
    r'(?:[\s,:]+|$)|\s*\(0x[\da-fA-F]{4}(?::\d+)?\)|\bStatus\w*\.(?=\w)|'
    r'\s*-\s*(?:default|slow|fast) sample rate'
)
"""Numbers of parameters, structures and groups of channels beside the words of a name."""
JOINED_WORDS = {
    'act': 'act position',
    'actm': 'act position',
    'actw': 'position',
    'abs': 'position',
    'com': 'command position',
    'frt': 'feed',
    'load': 'load percent',
}
DRIVE_WORDS = {'PL': 'position', 'VL': 'velocity', 'IL': 'current', 'FB': 'actual'}
OF_DRIVES = re.compile(r'\b(?P<loop>PL|VL|IL)\.(?P<value>FB|CMD)\b')
"""Loops of position, velocity and current, as drives of Kollmorgen call their values."""
AMOUNTS = frozenset('magnitude betrag diameter dia durchmesser'.split())
WITHOUT_SIGN = frozenset('abs absolute unsigned norm modulus amplitude amount total'.split())
"""Words of an amount of a speed or force; a position is absolute where its zero is fixed."""
BARS = re.compile(r'\|[^|]+\|')
WITH_SIGN = ('speed', 'position', 'load')
"""Words and bars of a column without the sign or of twice the way, and what is nothing so."""
PERCENT = frozenset({'percent', 'pct'})
AMPLITUDE = re.compile(r'A\s*[(_ ]?\s*(?:p|pk|peak|max)\s*\)?')
OF_RATED = re.compile(r'%|‰|per ?mille?|promille|percent|prozent|rated', re.I)
"""Units of parts of a rated torque or current."""
TELLS_NOTHING = (
    MEASURED
    | WANTED
    | PROCESSED
    | OF_THE_SCREW
    | AXIS
    | (ENCODERS - ELSEWHERE)
    | {'achs', 'axial', 'axes'}
)
ANGLES = frozenset('angle winkel drehwinkel angolo ángulo'.split())
OF_THE_ANGLE = TELLS_NOTHING | ANGLES | {'motor', 'drive', 'antrieb'}
"""Words of an axis beside the unit of an angle, which is then its position, be it of the motor."""
TURNING = {'drehzahl': 'rev/min', 'omega': 'rad/s'}
"""Words of a speed that tell its unit, where nothing else does."""
BY_UNIT = -4  # rank of a column of which the unit alone tells the quantity
_NAME = re.compile(r'[a-z][a-z0-9_]*')
OF_ALL = re.compile(
    r'(?:(?:axis|achse|axe|asse|eje|oś)[\s_-]*)?(?P<letter>[xyz])(?:[\s_-]*(?:axis|achse))?'
    r'(?:[\s_-]*\d+)?',
    re.IGNORECASE,
)
"""A text about all rows that is the name of an axis: a cell, or the name of a sheet."""
IN_FILE = re.compile(r'(?<![^\W_])[xyz](?![^\W_])', re.IGNORECASE)
"""The letter of an axis in the name of a file."""
TIMES_BY_UNIT = frozenset({'ms', 'us', 'ns', 's'})  # of a column that names no quantity


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Named:
    """
    What the name of a column says.

    Axis such as x1, empty for none; `place` is axis, spindle, other or machine; kind of quantity
    or nothing; unit or nothing, with the `scale` to it of another one [-]; `rank` is how much it
    is the measured quantity. `doubtful` is the kind of a column whose unit is not known.

    """

    column: str
    place: str
    axis: str
    kind: str
    unit: str
    rank: int
    scale: float = 1.0
    doubtful: str = ''


def read_name(column: str, text: str = '') -> Named:
    """Return what the name of a column says, or a longer text about it."""
    held, column = column, with_brackets(OF_CONTROL.sub('', column))
    told = LETTERED.sub(r' \1 ', JOINED.sub(_parted, OF_DRIVES.sub(_of_drive, text or column)))
    words = words_of(told)
    place, axis = _place(words)
    kind, rank = _kind_of_unit(column, words) or _kind(words), _rank(words)
    if _is_part_of_the_rated_torque(column, words):
        return Named(column=held, place=place, axis=axis, kind='torque', unit=RATED, rank=rank - 1)
    if place == 'axis' and not kind and not OTHERS & set(words):
        left = set(words_without_unit(told, '')) - {axis, axis[:1], axis[1:]} - MEASURED - WANTED
        kind = SHORT.get(min(left), '') if len(left - AXIS) == 1 else ''
    of_axis = [word for word in words if not word.isdigit() and word not in LINEAR | OF_A_DIAGRAM]
    if place == 'axis' and not kind and not of_axis and unit_of(told, 'time') in TIMES_BY_UNIT:
        place, axis = 'machine', ''  # a time that is named as an axis of a diagram, as X-Axis [ms]
    if not kind and not OTHERS & set(words):
        kind = _kind_by_unit(column, place)
        rank += 0 if is_of_the_screw(column) else BY_UNIT
    unit = unit_of(column, kind) or unit_of(told, kind)
    if kind == 'time' and not unit and words[:1] == ['seconds']:  # such as seconds_elapsed
        unit = 's'
    if kind != 'time' and 'min' in words_without_unit(told, kind):
        kind = ''  # the least of several, as beside a maximum
    scale, doubtful = 1.0, ''
    if kind and not unit:
        unit, scale = converted_unit(column, kind)
    for other in ('current', 'load'):  # FANUC calls a current so, and joints that slide a force
        if kind == 'torque' and not unit and BRACKETS.search(column):
            unit = unit_of(column, other)
            kind = other if unit else kind
    if kind == 'load' and not unit and KINDS['torque'] & set(words):
        unit = unit_of(column, 'torque')
        kind = 'torque' if unit else kind
    in_brackets = words_of(' '.join(BRACKETS.findall(column)))
    of_amounts = AMOUNTS if kind == 'position' else AMOUNTS | WITHOUT_SIGN
    if kind in WITH_SIGN and (of_amounts & {*words, *in_brackets} or BARS.search(column)):
        kind = ''
    # In another unit than those of the quantity it may be another quantity.
    if factor_of(column, kind) or (unknown_unit(column) and not unit):
        kind, doubtful = '', kind
    return Named(
        column=held,
        place=place,
        axis=axis,
        kind=kind,
        unit=unit,
        rank=rank,
        scale=scale,
        doubtful=doubtful,
    )


def _is_part_of_the_rated_torque(column: str, words: Sequence[str]) -> bool:
    """Return True if a name is that of a load in per cent: controls mean the torque by it."""
    of_unit = any(text.strip().lower() in {RATED, *PERCENT} for text in BRACKETS.findall(column))
    others = OTHERS & set(words)
    is_load = bool((LOADS | {'auslastung'}) & set(words))
    return is_load and others <= PERCENT and (of_unit or bool(others))


def _parted(match: re.Match[str]) -> str:
    """Return axis and quantity of a word that joins them, apart."""
    axis = (match['axis'] or match['of']).replace('I', '')
    word = match['word'] or match['letter'].lower()
    return f'{axis} {JOINED_WORDS.get(word, word)} '


def _of_drive(match: re.Match[str]) -> str:
    return ' '.join(DRIVE_WORDS.get(word, word) for word in match.groups())


def is_of_the_screw(column: str) -> bool:
    """Return True if the name of a column says that it is about the screw or its oil."""
    words = set(words_of(column))
    return bool(OF_THE_SCREW & words) and not BEARINGS & words


def turning_unit(column: str) -> str:
    """Return the unit in which the word of a turning speed is usual, empty for any other name."""
    return next((TURNING[word] for word in words_of(column) if word in TURNING), '')


def axis_names(named: Sequence[Named]) -> dict[str, str]:
    """Return the name of the axis for each that is found: the number goes if there is one."""
    found = sorted({one.axis for one in named if one.place == 'axis'})
    letters = [axis.rstrip('0123456789') for axis in found]
    return {
        axis: letter if letter != 'axis' and letters.count(letter) == 1 else axis
        for axis, letter in zip(found, letters)
    }


def axis_of_all(text: str) -> str:
    """Return the letter of the axis that a text about all rows is the name of, else nothing."""
    match = OF_ALL.fullmatch(text.strip())
    return match['letter'].lower() if match else ''


def axis_of_file(stem: str) -> str:
    """Return the only letter of an axis that stands alone in the name of a file, else nothing."""
    letters = {letter.lower() for letter in IN_FILE.findall(stem)}
    return letters.pop() if len(letters) == 1 else ''


def _place(words: Sequence[str]) -> tuple[str, str]:
    lettered = bool(LINEAR & set(words))
    for number, (word, after) in enumerate(zip(words, [*words[1:], ''])):
        digits = after if after.isdigit() else ''
        if (
            word in LINEAR
            or (word in SECONDARY and digits)
            or (word in ('axis', 'achse') and digits)
        ):
            return 'axis', word.replace('achse', 'axis') + digits
        if word in ('spindle', 'spindel', 'sp') or (
            number == 0 and word in SPINDLES and not lettered
        ):
            return 'spindle', ''
        if number == 0 and len(word) == 1 and digits and not lettered:
            return 'rotary' if word in ROTARY else 'machine' if word == 't' else 'other', ''
    return 'machine', ''


def _kind(words: Sequence[str]) -> str:
    """Return the quantity that the last word about one names: `current position` is a place."""
    if OTHERS & set(words):
        return ''
    found = [kind for word in words for kind, known in KINDS.items() if word in known]
    of_screw = OF_THE_SCREW & set(words)
    of_another = (OF_ANOTHER_PART | WANTED | (set() if of_screw else BEARINGS)) & set(words)
    if not found or (found[-1] == 'temperature' and of_another):
        return ''
    of_thing = OF_ANOTHER_THING & set(words) and not (LINEAR | AXIS) & set(words)
    if of_thing and found[-1] not in ('temperature', 'time'):
        return ''
    is_quality = words[-1] == 'q' and found[-1] in WITH_SIGN
    return '' if is_quality else found[-1]


def _kind_of_unit(column: str, words: Sequence[str]) -> str:
    """
    Return the quantity of several that a name states in its unit: a `speed at load` is a speed.

    A load in A or N m is a current or torque of the motor. Empty where the last word is right.

    """
    last = _kind(words)
    found = [kind for kind, known in KINDS.items() if known & set(words)] if last else []
    found += ['torque', 'current'] if last == 'load' and BRACKETS.search(column) else []
    if last in ('', 'time') or unit_and_scale(column, last)[0]:
        return ''
    others = [kind for kind in found if kind not in (last, 'time', 'temperature')]
    return next((kind for kind in others if unit_and_scale(column, kind)[0]), '')


def told_by_units(named: Sequence[Named]) -> list[str]:
    """Return sentences about loads that are torques or currents by their unit."""
    return [
        f'{short(one.column)} is a {one.kind} by its unit, of which the load is worked out'
        for one in named
        if one.kind in ('torque', 'current') and one.unit != RATED and one.place != 'spindle'
        if set(words_of(one.column)) & KINDS['load']
        and not set(words_of(one.column)) & KINDS[one.kind]
    ]


def _kind_by_unit(column: str, place: str) -> str:
    """Return the quantity that the unit of a column tells, where no other word may deny it."""
    kind, before = kind_by_unit(column)
    words = words_without_unit(column, 'position')
    if place == 'axis' and ANGLES & {*words}:
        is_turned = unit_of(column, 'position') in ROTARY_POSITION_UNITS
        kind = 'position'
        told = is_turned and all(len(word) == 1 or word in OF_THE_ANGLE for word in words)
    elif kind == 'time':
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
    words = words_without_unit(OF_CONTROL.sub('', named.column), named.kind)
    dull = TELLS_NOTHING | QUALIFIERS | ELSEWHERE | KINDS.get(named.kind, frozenset())
    numbered = ENCODERS & set(words)
    return '_'.join(
        word for word in words if word not in dull and not (numbered and word.isdigit())
    )


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
    shared = INPUTS if len(groups) == 1 else ('temperature',)
    oil = [
        one
        for one in general
        if one.kind in shared
        and one.column not in grouped
        and not (names and ROTARY & set(words_of(one.column)[:1]))
    ]
    return {name: [*group, *oil] for name, group in groups.items()}


def best(found: Sequence[Named]) -> dict[str, Named]:
    """Return for each kind the column that is most likely the measured quantity."""
    chosen: dict[str, Named] = {}
    for one in sorted(found, key=_likelihood(found)):
        if one.kind in INPUTS:
            chosen.setdefault(one.kind, one)
    return chosen


def is_commanded(one: Named) -> bool:
    """Return True for a column whose name says that it is wanted, and not that it is measured."""
    words = set(words_of(one.column))
    return bool(WANTED & words) and not MEASURED & words


def rivals(found: Sequence[Named], one: Named) -> list[Named]:
    """Return columns of the quantity of a column that are as likely the measured one."""
    of_kind = [each for each in found if each.kind == one.kind]
    likelihood = _likelihood(of_kind)
    return [each for each in of_kind if each is not one and likelihood(each) == likelihood(one)]


def may_agree(one: Named, other: Named) -> bool:
    """Return True if columns of a quantity are the same one where their numbers are alike."""
    is_twice = base_of(one.column) == base_of(other.column)
    return (one.kind == 'position' or is_twice) and one.unit == other.unit


def _likelihood(found: Sequence[Named]) -> Callable[[Named], tuple[bool, bool, int, int, int]]:
    """
    Return the order of columns, the most likely one first.

    What is commanded comes last; else words that others of the quantity do not have, and that say
    of what it is, count more than one that says that it is measured.

    """
    plain = MEASURED | WANTED | PROCESSED | QUALIFIERS | OF_THE_SCREW
    words = {
        one.column: {
            word
            for word in words_without_unit(base_of(one.column), one.kind)
            if not word.isdigit()
        }
        for one in found
    }
    common = {
        kind: set.intersection(*(words[one.column] for one in found if one.kind == kind))
        for kind in {one.kind for one in found}
    }

    def order(one: Named) -> tuple[bool, bool, int, int, int]:
        surplus = words[one.column] - common[one.kind]
        return one.place != 'axis', one.rank < 0, len(surplus - plain), -one.rank, len(surplus)

    return order


def base_of(column: str) -> str:
    """Return the name that a column has in the file, where others may have it too."""
    return re.sub(r'_duplicated_\d+$', '', column)


def marks_of(role: str, one: Named, columns: Sequence[str], first: str) -> list[str]:
    """
    Return the columns of a table that mark the values of an input as `valid` or `backward`.

    Words beside those of the mark are of its input. Where several have none, each stands behind
    its input, unless one stands before the `first` of all: then these are unclear.

    """
    table = marks.VALID if role == 'valid' else marks.BACKWARD
    known = frozenset[str]().union(*table.values(), marks.OF_MOTIONS if role == 'backward' else ())
    words = {column: {*words_of(base_of(column))} for column in columns}
    bases = {
        column: words[column] - known - marks.DULL
        for column in columns
        if known & words[column] and not BRACKETS.search(column) and not read_name(column).kind
    }
    own = {*words_of(one.column), one.axis, one.axis[:1], *KINDS.get(one.kind, ())}
    if named := [column for column, base in bases.items() if base and base <= own]:
        return named
    bare = [column for column, base in bases.items() if not base]
    if len(bare) < 2 or columns.index(bare[0]) < columns.index(first):
        return bare
    behind = columns.index(one.column) + 1
    return [column for column in columns[behind:][:1] if column in bare]


def unknown_units(named: Sequence[Named]) -> list[str]:
    """Return sentences about columns that may be inputs, were their units known."""
    return [
        f'column {short(repr(one.column))} is in '
        f'{short(unknown_unit(one.column, one.doubtful))}, {not_of_maps(one)}: write '
        f'`{_kind_of_map(one)}: {{column: {short(one.column)}, unit: {_unit_of_map(one)}` in the '
        'map, what one of it is'
        for one in named
        if one.doubtful in INPUTS and one.place in ('axis', 'machine')
    ]


def not_of_maps(one: Named) -> str:
    """Return in words that no map states the unit of a column, or that it is of an amplitude."""
    if AMPLITUDE.fullmatch(unknown_unit(one.column, one.doubtful)):
        return 'an amplitude of a current, of which maps state the effective value'
    return f'which is no unit of a {one.doubtful} that maps know'


def _kind_of_map(one: Named) -> str:
    """Return the quantity as which a map states a column in an unknown unit."""
    unit = unknown_unit(one.column, one.doubtful)
    if AMPLITUDE.fullmatch(unit):
        return 'current'
    return 'torque' if one.doubtful == 'load' and OF_RATED.search(unit) else one.doubtful


def _unit_of_map(one: Named) -> str:
    """Return the unit that a map states of a column in an unknown one, and what belongs to it."""
    units = UNITS[_kind_of_map(one)]
    if RATED in units and OF_RATED.search(unknown_unit(one.column, one.doubtful)):
        return f"'{RATED}', scale: ...}}, torque_rated_Nm: ..."
    shifted = ', offset: ...' * (one.doubtful == 'temperature')
    return f'{next(iter(units))}, scale: ...{shifted}}}'


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
        notes.append(
            f'not used, as the spindle is no ball-screw axis: {counted(spindle, "column")} of it'
        )
    others = [one.column for one in left if one.place != 'spindle']
    if others:
        notes.append(f'not used: {listed(others)}')
    return notes


def _by_word(general: Sequence[Named]) -> dict[str, list[Named]]:
    """Return the columns of axes that only a word tells apart; nothing for less than two."""
    words = {}
    for one in general:
        word = word_of_the_axis(one)
        name = f'axis{word}' if word.isdigit() else word
        if one.kind in INPUTS:
            words[one.column] = name if _NAME.fullmatch(name) else ''
    for kind in MOTION:
        axes = sorted({words[one.column] for one in general if one.kind == kind} - {''})
        if len(axes) > 1:
            return {
                axis: [one for one in general if words.get(one.column) == axis] for axis in axes
            }
    return {}
