# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Decimal signs of texts: point or comma, of which the other one then parts thousands.

In 5.400 the point may be either. A cell such as 12.35 or 1,234.5 shows which it is.

"""

from collections.abc import Callable, Collection, Mapping
import dataclasses
import re

from ballscrew_monitor.recordings.tables.quantities import OTHER_SIGN
from ballscrew_monitor.recordings.words import short
import numpy as np
from numpy.typing import NDArray
import polars as pl

NAMES = {'.': 'point', ',': 'comma'}


def thousands(part: str, groups: str = '') -> str:
    """Return the pattern of a whole number in which a sign parts one group of three, or more."""
    return rf'[1-9]\d{{0,2}}(?:{re.escape(part)}\d{{3}}){groups}'


def are(texts: pl.Series, pattern: str) -> NDArray[np.bool_]:
    """Return which texts are of a pattern, but for blanks around them and + or - before them."""
    whole = rf'^\s*[-+]?(?:{pattern})\s*$'
    return texts.str.contains(whole).fill_null(False).to_numpy()


def _decimal(sign: str) -> str:
    """Return the pattern of numbers with a decimal sign, some of which may be without."""
    mark, groups = re.escape(sign), thousands(OTHER_SIGN[sign], '+')
    plain = rf'(?:\d+{mark}\d*|{mark}\d+)(?:[eE][-+]?\d+)?'
    return rf'{plain}|{groups}{mark}\d*|{thousands(OTHER_SIGN[sign], "{2,}")}'


_DECIMAL = {sign: _decimal(sign) for sign in OTHER_SIGN}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Cell:
    """The text of a cell, and its row in the file."""

    text: str
    row: int

    @property
    def words(self) -> str:
        return f'{short(repr(self.text))} in row {self.row}'

    def readings(self, sign: str) -> str:
        """Return the number that the text is if a sign is decimal, and if it parts thousands."""
        return f'{float(self.text.replace(sign, ".")):g} or {int(self.text.replace(sign, ""))}'


class Signs:
    """The first cell of a column in which each sign is surely decimal, and in which it may be."""

    def __init__(self) -> None:
        """Begin with no cell."""
        self._sure: dict[str, _Cell] = {}
        self._doubtful: dict[str, _Cell] = {}

    def look(
        self,
        texts: pl.Series,
        holding: Mapping[str, Callable[[], NDArray[np.bool_]]],
        unread: NDArray[np.bool_],
        row: int,
    ) -> None:
        """
        Look at further cells, the first of them in a row of the file.

        `holding` tells which of them hold each sign; `unread` are no numbers with either one.

        """
        for sign, other in OTHER_SIGN.items():
            if sign in self._sure:
                continue
            places = np.flatnonzero(holding[sign]())
            if unread.any():
                places = np.union1d(places, np.flatnonzero(holding[other]() & unread))
            if not len(places):
                continue
            some = texts.gather(places)
            doubtful = are(some, thousands(sign))
            sure = are(some, _DECIMAL[sign]) & ~doubtful
            for cells, found in ((self._doubtful, doubtful), (self._sure, sure)):
                if sign not in cells and found.any():
                    at = int(places[found.argmax()])
                    cells[sign] = _Cell(text=texts[at].strip(), row=row + at)

    def shows(self, sign: str) -> bool:
        """Return True if a sign is decimal in a cell that cannot be read otherwise."""
        return sign in self._sure

    @property
    def seen(self) -> dict[str, str]:
        """Return the signs that may be decimal in its numbers, each with a cell in words."""
        return {sign: cell.words for sign, cell in (self._doubtful | self._sure).items()}

    @property
    def doubtful(self) -> dict[str, _Cell]:
        """Return the signs that may part thousands wherever they stand, each with a cell."""
        return {sign: cell for sign, cell in self._doubtful.items() if sign not in self._sure}

    def doubts(self, elsewhere: Mapping[str, str], clear: Collection[str]) -> dict[str, str]:
        """
        Return what is not clear, by the sign that would be decimal instead, in words.

        A sign that is `clear`, as the log shows elsewhere that it is decimal, is so unless the
        numbers of the log hold the other one too: `elsewhere` says where.

        """
        found = {}
        for sign, cell in self.doubtful.items():
            other = OTHER_SIGN[sign]
            if other in elsewhere:
                why = f'have a decimal {NAMES[other]}, too, such as {elsewhere[other]}'
            elif sign not in clear:
                why = f'nowhere show whether the {NAMES[sign]} is decimal or parts thousands'
            else:
                continue
            found[other] = (
                f'holds {cell.words}, which is {cell.readings(sign)}, for numbers of the log '
                f"{why}: state `decimal: '{other}'` or `decimal: '{sign}'` in the map"
            )
        return found
