# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns that say of the values beside them whether they are valid, or that they go backward.

A sample that is not valid is not known; a speed that goes backward gets a minus.

"""

from collections.abc import Collection, Mapping, Sequence
import dataclasses
import re
from typing import Any

VALID = {
    True: frozenset('valid validity ok good gültig gueltig gültigkeit'.split()),
    False: frozenset('invalid bad missing stale ungültig ungueltig schlecht'.split()),
    None: frozenset(
        'quality qualität qualitaet qc flag error overload saturated substituted status state '
        'q'.split()
    ),
}
BACKWARD = {
    True: frozenset(
        'backward backwards reverse reversed negative return rückwärts rueckwaerts'.split()
    ),
    False: frozenset('forward forwards vorwärts vorwaerts'.split()),
    None: frozenset('direction dir richtung drehrichtung sign vorzeichen'.split()),
}
"""Words of columns by what a cell of 1 or `true` in them says, None where that is a convention."""
OF_MOTIONS = frozenset('ccw cw bewegung move movement sense stroke hub phase gear'.split())
"""Words of columns that may tell a way, by their cells, or something else of a motion."""
WORDS = frozenset[str]().union(*VALID.values(), *BACKWARD.values()) - {'negative', 'return', 'q'}
STATES = frozenset({'status', 'state'})
"""Words that are also those of a machine, whose codes say nothing of a value."""
SEVERAL = frozenset(
    'axis axes achse achsen machine maschine device gerät geraet joint gelenk drive '
    'antrieb serial slave asset equipment host hostname node station plc robot anlage'.split()
)
NUMBERED = frozenset('name id no nr number nummer label the'.split())
"""Words of a column that tells rows of several axes or machines apart, and those beside them."""
DULL = frozenset('is signal sensor code flag moving motion axis the opc data'.split())
TRUTHS = {
    **dict.fromkeys('1 true yes ja on'.split(), True),
    **dict.fromkeys('0 false no nein off'.split(), False),
}
WAYS = {
    **dict.fromkeys('-1 - backward backwards back bwd reverse negative neg minus'.split(), True),
    **dict.fromkeys('retract return zurück zurueck rückwärts rueckwaerts rückhub'.split(), True),
    **dict.fromkeys('0 1 + +1 forward forwards fwd positive pos plus stop still'.split(), False),
    **dict.fromkeys('advance extend vor vorwärts vorwaerts vorhub rest hold dwell'.split(), False),
    **dict.fromkeys('halt stopp steht idle'.split(), False),
}
"""Cells that say whether a motion goes backward; 1 and 0 alone do not."""
GOOD = re.compile(r'(?i:good|ok|valid|gut|gültig|gueltig)(?![^\W_])|Good(?=[A-Z])')
BAD = frozenset(
    'bad invalid uncertain questionable stale nodata timeout commfail commfailure notconnected '
    'schlecht ungültig ungueltig unsicher'.split()
)
"""Words of a quality by which a value is not known, without blanks and signs."""
GOOD_BYTE = 0x80  # set in a quality of OPC (0xC0) and of PROFIBUS (0x80) that is good
BAD_STATUS = 0xC000_0000  # bits of a status of OPC UA, none of which is set in a good one
LARGEST_BYTE = 0xFF
IN_PER_CENT = frozenset({0, 100})  # of the samples that are good
HEX = re.compile(r'(?:0?x|16#)([\da-f]{1,8})')
STATUS = re.compile(r'(?:0?x|16#)[\da-f]{8}', re.I)
"""A status of OPC UA as it is written."""
FRACTION = re.compile(r'[-+]?\d*[.,]\d*[1-9]\d*(?:[eE][-+]?\d+)?')
"""A cell of a quantity, such as a small error, which is no mark."""
FEW_WAYS = 3  # forward, backward, and at rest
MOST = 16  # different cells of a mark: a column of more is a quantity of its own


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Mark:
    """A column, and those of its cells that say so of the values beside it."""

    column: str
    cells: tuple[str, ...]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Marks:
    """
    What marks the values of a column: as valid, and as backward.

    The numbers `none` stand for no value there, None where it is not said whether some do.

    """

    valid: Mark | None = None
    backward: Mark | None = None
    none: tuple[float, ...] | None = None

    @property
    def numbers_of_none(self) -> tuple[float, ...]:
        """Return the numbers that stand for no value, of either sign where a mark gives one."""
        none = self.none or ()
        return (*none, *(-one for one in none)) if self.backward else none

    @property
    def held(self) -> list[Mark]:
        """Return those that are other columns."""
        return [one for one in (self.valid, self.backward) if one]


def plain_cell(cell: Any) -> str:
    """Return a cell of a mark as a text in small letters, whole numbers without a point."""
    if isinstance(cell, bool):
        return str(cell).lower()
    text = '' if cell is None else str(cell).strip().lower()
    return re.sub(r'^([-+]?\d+)[.,]0*$', r'\1', text)


def bad_qualities(cells: Sequence[str]) -> list[str]:
    """
    Return those of the qualities of a table by which a value is not known.

    Where some say that a value is good, all others say that it is not. Numbers are a byte of OPC
    or PROFIBUS, a status of OPC UA, or per cent; others, such as a state of a machine, say nothing
    of a value.

    """
    codes = _codes(cells)
    values = {*codes.values()}
    words = [cell for cell in cells if cell and cell not in codes]
    are_words = any(map(GOOD.match, words))
    if max(values, default=0) > BAD_STATUS >> 2:
        bad = [cell for cell, code in codes.items() if code & BAD_STATUS]
    elif any(code & GOOD_BYTE for code in values):
        bad = [cell for cell, code in codes.items() if not code & GOOD_BYTE]
    elif values == IN_PER_CENT:
        bad = [cell for cell, code in codes.items() if not code]
    else:
        bad = []
    return [
        *bad,
        *(
            cell
            for cell in words
            if not GOOD.match(cell) and (are_words or re.sub(r'[\W_]+', '', cell.lower()) in BAD)
        ),
    ]


def _codes(cells: Sequence[str]) -> dict[str, int]:
    """Return the codes of cells that are some; eight digits with a zero before are of base 16."""
    plain = {cell: plain_cell(cell) for cell in cells}
    padded = any(re.fullmatch(r'0[\da-f]{7}', text) for text in plain.values())
    codes = {}
    for cell, text in plain.items():
        if match := HEX.fullmatch(text):
            codes[cell] = int(match[1], 16)
        elif padded and re.fullmatch(r'[\da-f]{8}', text):
            codes[cell] = int(text, 16)
        elif re.fullmatch(r'-?\d+', text):
            codes[cell] = int(text) & 0xFFFF_FFFF
    return codes


def valid_cells(words: Collection[str], cells: Sequence[str]) -> list[str] | None:
    """
    Return the cells of a column of qualities that say that a value is valid, None if unclear.

    Without any, it says nothing of a value.

    """
    cells = [cell for cell in cells if cell.strip()]
    of_machine = bool(STATES & set(words))
    bits = any(LARGEST_BYTE < code <= BAD_STATUS >> 2 for code in _codes(cells).values())
    if len(cells) > MOST or (of_machine and bits) or any(map(FRACTION.fullmatch, cells)):
        return []
    bad, says = bad_qualities(cells), _truth(VALID, words)
    if not bad and says is not None:
        bad = [cell for cell in cells if TRUTHS.get(plain_cell(cell)) is not says]
    elif not bad and len(cells) > 1 and not all(map(GOOD.match, cells)):
        return [] if of_machine else None
    return [cell for cell in cells if cell not in bad] or None


def backward_cells(words: Collection[str], cells: Sequence[str]) -> list[str] | None:
    """Return the cells of a column of directions that say backward, None if unclear."""
    plain = {cell: plain_cell(cell) for cell in cells if cell.strip()}
    says = _truth(BACKWARD, words)
    if OF_MOTIONS & set(words) and says is None:
        texts = {*plain.values()}
        ways = {text for text in texts if text in WAYS and not text.isdigit()}
        if not (1 < len(texts) <= FEW_WAYS or (ways and len(texts) <= MOST)):
            return []  # it tells something else of a motion
    table = WAYS if says is None else {cell: each is says for cell, each in TRUTHS.items()}
    back = [cell for cell, text in plain.items() if table.get(text)]
    is_clear = set(plain.values()) <= set(table) and (back or says is not None)
    return back if is_clear or not plain else None


def tells_apart(words: Collection[str]) -> bool:
    """Return True if a column tells by the words of its name of what axis or machine a row is."""
    return bool(SEVERAL & set(words)) and set(words) <= SEVERAL | NUMBERED


def _truth(table: Mapping[bool | None, frozenset[str]], words: Collection[str]) -> bool | None:
    return next((truth for truth, known in table.items() if known & set(words)), None)
