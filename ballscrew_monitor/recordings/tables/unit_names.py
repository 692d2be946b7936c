# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Units in the names of columns, as they are spelt, and the words beside them."""

from collections.abc import Iterator
import re

from ballscrew_monitor.recordings.tables.quantities import NAMED_BY_MAPS, UNITS

_CAPITAL = 'A-ZÄÖÜÉÓĄĆĘŁŃŚŹŻČŘŠŽÁÍÚŮÝĚ'
_SMALL = 'a-zäöüßàéèóíąćęłńśźżčřšžáúůýěµμ°'
WORD = re.compile(rf'[{_CAPITAL}]+(?![{_SMALL}])|[{_CAPITAL}]?[{_SMALL}]+|\d+')
"""A word of a name: of one case, or of small letters after a capital; or a number."""
COMPOUND = re.compile(
    '(ist|soll|motor|antrieb|achs|axial|vorschub|öl|oel|mutter)?s?'
    '(geschwindigkeit|geschw|drehzahl|position|lage|weg|winkel|kraft|moment|drehmoment|strom'
    '|temperatur|temp(?!s$)|zeit)s?(istwert|sollwert|wert)?'
)
"""A German word of several, such as Motorstrom."""
BRACKETS = re.compile(r'[\[(]((?:[^\[\]()]|\([^()]*\))+)[\])]')
"""What stands in brackets, which may hold further ones, as A(p) does."""
TREATED = frozenset('filtered unfiltered gefiltert smoothed raw mean average avg'.split())
"""Words in brackets that are no unit."""
LETTERED = re.compile(r'[\[(]([XYZxyz]\d?)[\])]')
"""The letter of an axis in brackets, as of FANUC."""
OF_QUOTIENT = re.compile(r'(?P<name>.*?[^\W_])(?P<sign>\s*/\s*|\s+in\s+)(?P<unit>[^\s\[\]()]+)')
"""A name over its unit, such as F/N, or before it, such as F in N."""
_PER = re.compile(r'[\s_]*(?:/|_|\s|(?<![a-z])per(?![a-z]))[\s_]*')
_CAMEL_PER = re.compile(r'(?<=[a-z])Per(?=[A-Z])')
_LONGEST = 4  # words of a unit, such as m per min in camel case
_PREFIX = re.compile(r'(?<![^\W\d_])(?:da|[munkMGhcdµμ])$')
"""A prefix of the SI that begins a word: what follows is no unit by itself, as N in daN."""
_BY_ITSELF = 2  # letters of a unit that says without brackets which quantity it is of
_OTHER_WORDS = frozenset(
    'min rev rad radian radians deg degree degrees grad nm ma amp amps arms'.split()
)
_ALIASES = {
    'mm': ('millimeter', 'millimetre'),
    'mm/s': ('mmps', 'mm/sec', 'millimeter/second'),
    'm/s': ('mps', 'm/sec'),
    'mm/min': ('mmpm',),
    'm/min': ('mpm',),
    'rev/min': (
        *'rpm 1/min r/min u/min upm umdr/min tr/min turns/min min-1 min^-1 min⁻¹'.split(),
        'revolution/minute',
    ),
    'rad/s': ('radps', 'rad/sec'),
    'rad': ('radian', 'radians'),
    'deg': ('°', 'degree', 'degrees', 'grad'),
    'N': ('newton', 'newtons'),
    'N m': ('nm', 'n.m', 'n*m', 'n·m', 'newton/meter'),
    'degC': ('c', '°c', 'deg/c', '°/c', 'grad/c', 'celsius'),
    'A': ('amp', 'amps', 'ampere', 'amperes', 'arms', 'a(rms)', 'a/rms', 'aeff', 'a/eff'),
    's': ('sec', 'seconds', 'sek', 'sekunden'),
    'ms': ('msec', 'millis', 'milliseconds'),
    'us': ('usec', 'µs', 'μs', 'microseconds'),
    'ns': ('nanoseconds',),
    'd': ('day', 'days', 'tage'),
}


_CONVERTED: dict[str, dict[str, tuple[str, float]]] = {
    'speed': {
        'in/min': ('mm/min', 25.4),
        'ipm': ('mm/min', 25.4),
        'in/s': ('mm/s', 25.4),
        'ips': ('mm/s', 25.4),
        'cm/s': ('mm/s', 10.0),
        **dict.fromkeys(('um/s', 'µm/s', 'μm/s'), ('mm/s', 1e-3)),
        **dict.fromkeys(('deg/s', 'deg/sec', 'degps', '°/s', 'grad/s'), ('rev/min', 1.0 / 6.0)),
        **dict.fromkeys(('degree/s', 'degrees/s', 'degree/second'), ('rev/min', 1.0 / 6.0)),
        **dict.fromkeys(('deg/min', '°/min', 'grad/min'), ('rev/min', 1.0 / 360.0)),
        **dict.fromkeys(('rad/min',), ('rad/s', 1.0 / 60.0)),
        'mrad/s': ('rad/s', 1e-3),
        'rev/s': ('rev/min', 60.0),
        'rps': ('rev/min', 60.0),
        'u/s': ('rev/min', 60.0),
    },
    'position': {
        'in': ('mm', 25.4),
        'inch': ('mm', 25.4),
        'cm': ('mm', 10.0),
        'um': ('mm', 1e-3),
        'µm': ('mm', 1e-3),
        'μm': ('mm', 1e-3),
    },
    'load': {
        'dan': ('N', 10.0),
        'dn': ('N', 0.1),
        'lbf': ('N', 4.4482216152605),
        'kgf': ('N', 9.80665),
        'kp': ('N', 9.80665),
    },
    'torque': {
        'mnm': ('N m', 1e-3),
        'cnm': ('N m', 1e-2),
        'ncm': ('N m', 1e-2),
        'dnm': ('N m', 1e-1),
        'knm': ('N m', 1e3),
        'lbf/in': ('N m', 0.1129848290276167),
        'lbf/ft': ('N m', 1.3558179483314004),
    },
    'current': {'ka': ('A', 1e3)},
}
"""Spellings of units that a map writes as one of its own and a scale."""
_BY_CASE: dict[str, dict[str, tuple[str, float]]] = {
    'load': {'mN': ('N', 1e-3), 'MN': ('N', 1e6)},
    'torque': {'MNm': ('N m', 1e6), 'MN m': ('N m', 1e6)},
}
"""Units in brackets that are others in small letters."""
_IN_BRACKETS = frozenset({'in', 'kp', 'dn'})  # which are words, too
_POWER = r'(?:10+(?:\s*\^\s*[-+]?\d+)?|0?[.,]0*1|1[eE][-+]?\d+)(?![\d.,])'
_FACTOR = re.compile(
    rf'(?:(?<=[\s_\[(])x|[×*÷/])\s*{_POWER}|[×*÷]\s*\d[\d.,]*|'
    rf'(?<![\w.,]){_POWER}\s*[x×*](?![^\W_])|\d+\s*[×*]|'
    r'[\[(][^\])\d]*\d+[.,]\d+\s*[\])]',
    re.I,
)
"""A factor that a name states beside its unit: a number by sign, or alone in brackets."""
_MULTIPLE = re.compile(
    rf'(?<![^\W_])(?<![.,/^-])(?:{_POWER}[\s_]*|\d+[.,]\d+[\s_]*|\d*[2-9]\d*|\d{{2,}})'
    r'(?=[^\W\d_])'
)
"""A number before a unit that counts the unit, which that of an axis or a signal does not."""


def with_brackets(column: str) -> str:
    """Return a name whose unit is %, stands below a bar or behind `in`, with it in brackets."""
    column = re.sub(r'(?<=[^\W_])\s*%$', ' [%]', column.strip())
    match = OF_QUOTIENT.fullmatch(column)
    if match is None or not is_unit(match['unit']):
        return column
    by_bar = any(unit_of(match['unit'], kind) for kind in ('load', 'torque', 'current'))
    before = re.split(r'[\W_]', match['name'])[-1]
    if '/' in match['sign'] and (is_unit(before) or not by_bar):
        return column  # such as mm/s, or Nm/A
    return f'{match["name"]} [{match["unit"]}]'


def converted_unit(column: str, kind: str) -> tuple[str, float]:
    """
    Return the unit of a map and the scale to it [-] of a unit that it does not know.

    The unit is empty where a name of a column states none that is so many times one of a map.

    """
    by_case, known = _BY_CASE.get(kind, {}), _CONVERTED.get(kind, {})
    for text in BRACKETS.findall(column):
        if text.strip() in by_case:
            return by_case[text.strip()]
    inside = (_plain(text) for text in BRACKETS.findall(column))
    texts = [*inside, *(text for text in _ends(column) if text not in _IN_BRACKETS)]
    return next((known[text] for text in texts if text in known), ('', 1.0))


def unit_and_scale(column: str, kind: str) -> tuple[str, float]:
    """Return the unit of a map that a name states, empty if none, and the scale to it [-]."""
    unit = unit_of(column, kind)
    return (unit, 1.0) if unit else converted_unit(column, kind)


def factor_of(column: str, kind: str) -> str:
    """Return what a name states beside or before the unit of a quantity that scales it, if any."""
    known = set(_SPELLINGS.get(kind, {})) | set(_CONVERTED.get(kind, {}))
    if factor := _FACTOR.search(column):
        return factor[0].strip(' []()')
    bare = BRACKETS.sub(' ', column).strip()
    texts = (bare[slice(match.start(), None)] for match in _MULTIPLE.finditer(bare))
    return next((text for text in texts if _plain(text.lstrip('0123456789.,^+ _')) in known), '')


def unknown_unit(column: str, kind: str = '') -> str:
    """
    Return what a name states that is no unit, no axis and no number of a field, else nothing.

    It is in the last brackets, or a factor beside the unit of a kind of quantity.

    """
    texts = [
        text
        for text in BRACKETS.findall(LETTERED.sub(' ', column))
        if not text.isdigit() and not ({*words_of(text)} and {*words_of(text)} <= TREATED)
    ]
    last = texts[-1].strip() if texts else ''
    factor = factor_of(column, kind)
    return last if factor in last else factor


def unit_of(column: str, kind: str) -> str:
    """Return the unit of a kind of quantity that a name of a column states, empty if none."""
    known = _SPELLINGS.get(kind, {})
    return next((known[text] for text in _stated(column) if text in known), '')


def is_unit(text: str) -> bool:
    """Tell whether a text is a unit of any quantity, in brackets or not."""
    plain = _plain(text.strip().strip('[]()'))
    spelt = [*map(set, _SPELLINGS.values()), *map(set, _CONVERTED.values())]
    return any(plain in known for known in spelt)


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
    words = [word.lower() for word in WORD.findall(BRACKETS.sub(' ', text))]
    return [part for word in words for part in _parts(word)]


def words_without_unit(column: str, kind: str) -> list[str]:
    """Return the words of a name, without the unit of a kind of quantity at its end."""
    known = set(_SPELLINGS.get(kind, {})) | set(_CONVERTED.get(kind, {}))
    text = next((text for text in _ends(column) if text in known), '')
    return words_of(_before(column, text) if text else column)


def _parts(word: str) -> list[str]:
    compound = COMPOUND.fullmatch(word)
    return [word] if compound is None else [part for part in compound.groups() if part]


def _stands_alone(text: str) -> bool:
    return len(text) >= _BY_ITSELF and text not in _OTHER_WORDS


def _stated(column: str) -> Iterator[str]:
    """Yield what may be a unit: in brackets, the whole, the end, `rpm` anywhere, longer inside."""
    yield from (_plain(text) for text in BRACKETS.findall(column))
    yield _plain(BRACKETS.sub(' ', column))
    yield from _ends(column)
    bare = BRACKETS.sub(' ', column)
    spans = [match.span() for match in WORD.finditer(bare)]
    yield from (word for word in words_of(column) if word == 'rpm')
    for length in range(_LONGEST, 0, -1):
        for first in range(1, len(spans) - length + 1):
            begin, end = spans[first][0], spans[first + length - 1][1]
            text = _plain(bare[begin:end])
            if _stands_alone(text) and not _PREFIX.search(bare[:begin]):
                yield text


def _ends(column: str) -> list[str]:
    """Return the last words of a name as they are joined, most of them first, but never all."""
    bare = BRACKETS.sub(' ', column).strip()
    starts = [match.start() for match in WORD.finditer(bare)][1:]
    whole = [start for start in starts if not _PREFIX.search(bare[:start])]
    return [_plain(bare[start:]) for start in whole[-_LONGEST:]]


def _before(column: str, unit: str) -> str:
    """Return a name without its brackets and without a unit at its end."""
    bare = BRACKETS.sub(' ', column).strip()
    starts = [match.start() for match in WORD.finditer(bare)]
    cut = next((start for start in starts if _plain(bare[start:]) == unit), len(bare))
    return bare[:cut]


def _plain(text: str) -> str:
    """Return a spelling with one sign for all that stands between its words: / ."""
    return _PER.sub('/', _CAMEL_PER.sub('/', text.strip()).lower()).strip('/')


_SPELLINGS = {
    kind: {_plain(unit): unit for unit in units}
    | {_plain(alias): unit for unit in units for alias in _ALIASES.get(unit, ())}
    for kind, units in UNITS.items()
    if kind not in NAMED_BY_MAPS
}
