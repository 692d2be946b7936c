# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Decimal signs of texts: point or comma, of which the other one then parts thousands.

In 5.400 the point may be either. A cell such as 12.35 or 1,234.5 shows which it is, for all
numbers of a table.

"""

from collections.abc import Mapping
import dataclasses
import math
import re

from ballscrew_monitor.recordings.tables.numerals import plain_numerals
from ballscrew_monitor.recordings.tables.quantities import OTHER_SIGN
from ballscrew_monitor.recordings.words import short
import numpy as np
from numpy.typing import NDArray
import polars as pl

NAMES = {'.': 'point', ',': 'comma'}


THOUSAND = 1000
FIXED = 3  # digits behind a sign that may part thousands
MARKS = r"[ '’\u00a0\u202f\ufffd]"
"""What parts thousands besides a sign: blanks of whatever width, and apostrophes."""
MINUS, PLUS = '-\u2212\u2013', '+'
"""Signs before a number; a word processor makes a longer one of a minus."""
_SIGNED = {sign: rf'^\s*[{marks}]\s*(\d|[.,]\d)' for sign, marks in (('-', MINUS), ('', PLUS))}


def with_plain_sign(texts: pl.Series) -> pl.Series:
    """Return texts without blanks around them, numbers with a plain minus just before them."""
    texts = plain_numerals(texts)
    for sign, pattern in _SIGNED.items():
        texts = texts.str.replace(pattern, f'{sign}$1')
    return texts.str.strip_chars()


def thousands(part: str, groups: str = '') -> str:
    """Return the pattern of a whole number in which a sign parts one group of three, or more."""
    return rf'[1-9]\d{{0,2}}(?:{re.escape(part)}\d{{3}}){groups}'


def are(texts: pl.Series, pattern: str) -> NDArray[np.bool_]:
    """Return which texts are of a pattern, but for blanks around them and a sign before them."""
    whole = rf'^\s*(?:[{MINUS}{PLUS}]\s*)?(?:{pattern})\s*$'
    return texts.str.contains(whole).fill_null(False).to_numpy()


def grouped(sign: str) -> str:
    """Return the pattern of numbers with a decimal sign whose thousands anything else parts."""
    part, mark = re.escape(OTHER_SIGN[sign]), re.escape(sign)
    return rf'[1-9]\d{{0,2}}(?:(?:{part}\d{{3}})+|(?:{MARKS}\d{{3}})+)(?:{mark}\d*)?'


def _decimal(sign: str) -> str:
    """Return the pattern of numbers with a decimal sign, some of which may be without."""
    mark, groups = re.escape(sign), thousands(OTHER_SIGN[sign], '+')
    marked = rf'[1-9]\d{{0,2}}(?:{MARKS}\d{{3}})+{mark}\d+'
    plain = rf'(?:\d+{mark}\d*|{mark}\d+)(?:[eE][-+]?\d+)?'
    return rf'{plain}|{marked}|{groups}{mark}\d*|{thousands(OTHER_SIGN[sign], "{2,}")}'


_DECIMAL = {sign: _decimal(sign) for sign in OTHER_SIGN}


def signless(number: float) -> str:
    """Return a number as a text that holds no decimal sign, such as 605e-1."""
    digits, mark, exponent = repr(number).partition('e')
    whole, _, part = digits.partition('.')
    power = int(exponent or 0) - len(part)
    return repr(number) if not math.isfinite(number) or not part else f'{whole}{part}e{power}'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Cell:
    """The text of a cell, and its row in the file."""

    text: str
    row: int

    @property
    def words(self) -> str:
        return f'{short(repr(self.text))} in row {self.row}'

    def number(self, *, decimal: bool, sign: str) -> str:
        """Return the number that the text is if a sign is decimal, or if it parts thousands."""
        text = with_plain_sign(pl.Series([self.text]))[0]
        if decimal:
            return f'{float(text.replace(sign, ".")):g}'
        return str(int(text.replace(sign, '')))

    def readings(self, sign: str) -> str:
        """Return the numbers that the text may be."""
        decimal, parted = (self.number(decimal=one, sign=sign) for one in (True, False))
        return f'{decimal} or {parted}'


class Signs:
    """Cells of a column in which each sign is surely decimal: their number, and the first."""

    def __init__(self) -> None:
        """Begin with no cell."""
        self.counts = dict.fromkeys(OTHER_SIGN, 0)
        self._sure: dict[str, _Cell] = {}
        self._doubtful: dict[str, _Cell] = {}
        self.most_whole = -math.inf
        """The largest number without a sign beside them, as far as it was looked for."""

    def look(self, texts: pl.Series, row: int) -> None:
        """Look at further cells that hold a sign, the first of them in a row of the file."""
        texts = plain_numerals(texts)
        for sign in OTHER_SIGN:
            doubtful = are(texts, thousands(sign))
            sure = are(texts, _DECIMAL[sign]) & ~doubtful
            self.counts[sign] += int(sure.sum())
            for cells, found in ((self._doubtful, doubtful), (self._sure, sure)):
                if sign not in cells and found.any():
                    at = int(found.argmax())
                    cells[sign] = _Cell(text=texts[at].strip(), row=row + at)

    def shows(self, sign: str) -> bool:
        """Return True if a sign is decimal in a cell that cannot be read otherwise."""
        return sign in self._sure

    def first(self, sign: str) -> str:
        """Return in words the first cell that surely has a decimal sign."""
        return self._sure[sign].words

    def fault(self, texts: pl.Series, decided: str) -> str:
        """
        Return how cells of a column contradict the sign that it shows, empty if they do not.

        A 1.480 beside 60.0 is written by no rule of decimals, which matters where the table has
        another sign, or has `decided` on none.

        """
        sign = next((sign for sign in self._sure if sign in self._doubtful), '')
        if not sign or len(self._sure) > 1 or sign == decided:
            return ''
        plain, mark = plain_numerals(texts), re.escape(sign)
        digits = plain.str.strip_chars().str.extract(rf'{mark}(\d+)$').str.len_chars()
        ends = plain.str.contains(r'0\s*$')
        padded, others = (
            are(plain, pattern) & found.fill_null(False).to_numpy()
            for pattern, found in ((thousands(sign), ends), (_DECIMAL[sign], digits != FIXED))
        )
        if not padded.any() or not others.any():
            return ''
        cell, other = (
            _Cell(text=texts[int(found.argmax())].strip(), row=0) for found in (padded, others)
        )
        number = cell.number(decimal=True, sign=sign)
        return (
            f'holds {short(repr(cell.text))}, which is {cell.readings(sign)}, for it also holds '
            f'{short(repr(other.text))}, and the {NAMES[OTHER_SIGN[sign]]} is decimal elsewhere'
            f": state `decimal: '{sign}'` in the map if it is {number}"
            ', else write the column with one decimal sign'
        )

    @property
    def may_part(self) -> bool:
        """Return True if numbers below 1000 stand without a point beside 5.400 and the like."""
        return '.' in self.doubtful and 0.0 <= self.most_whole < THOUSAND

    @property
    def doubtful(self) -> dict[str, _Cell]:
        """Return the signs that may part thousands wherever they stand, each with a cell."""
        return {sign: cell for sign, cell in self._doubtful.items() if sign not in self._sure}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Decision:
    """
    The decimal sign of a whole table, empty where none is shown, and by how many cells it is so.

    Where cells show both, no sign is that of the table, and `where` names one of each.

    """

    sign: str = ''
    proofs: int = 0
    where: str = ''

    def doubt(self, where: str, signs: Signs) -> dict[str, str]:
        """Return what is not clear of a column, by the sign that would be decimal instead."""
        found = {}
        for sign, cell in signs.doubtful.items():
            if self.sign:
                continue
            other = OTHER_SIGN[sign]
            why = self.where or (
                f'for numbers of the log nowhere show whether the {NAMES[sign]} is decimal or '
                'parts thousands'
            )
            found[other] = (
                f'{where} holds {cell.words}, which is {cell.readings(sign)}, {why}: state '
                f"`decimal: '{other}'` or `decimal: '{sign}'` in the map"
            )
        return found

    @property
    def words(self) -> str:
        """Return what was decided, empty if nothing was."""
        if not self.sign or not self.proofs:
            return ''
        cells = 'cell' if self.proofs == 1 else 'cells'
        return f'{NAMES[self.sign]} is decimal, proven by {self.proofs} {cells}'


def decide(columns: Mapping[str, Signs], stated: str, usual: str) -> Decision:
    """
    Return the decimal sign of a table by all cells of its columns, by name.

    A sign that the map or the head has `stated` counts; without any cell that shows one, the
    `usual` one does, if there is such a thing.

    """
    counts = {sign: sum(one.counts[sign] for one in columns.values()) for sign in OTHER_SIGN}
    if stated:
        return Decision(sign=stated)
    shown = [sign for sign, count in counts.items() if count]
    if len(shown) == 1:
        return Decision(sign=shown[0], proofs=counts[shown[0]])
    if not shown:
        maybe = {sign for one in columns.values() for sign in one.doubtful}
        return Decision(sign=usual if maybe <= {usual} else '')
    cells = [
        f'{one.first(sign)} of column {short(repr(name))}'
        for sign in shown
        for name, one in list(columns.items())
        if one.counts[sign]
    ]
    why = f'for other numbers have either sign, such as {cells[0]} and {cells[-1]}'
    return Decision(where=why)
