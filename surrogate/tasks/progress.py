# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Progress of long work on a terminal or in a log: a bar there, a line now and then here."""

from collections.abc import Callable
import sys
import time
from typing import TextIO

WIDTH = 40
"""Length of the bar in characters."""
LOG_SHARE, LOG_PAUSE = 0.1, 10.0
"""A log gets a line per this share of the work [-], or after this time [s] if that is sooner."""
OnProgress = Callable[[int, int], None]
"""Told how much is done, of how much: `Progress.show`, or whatever takes its place."""


def bar(share: float, width: int, *, blank: str = ' ') -> str:
    """Return a bar of `width` characters for the `share` done [-], full only when all is."""
    filled = '#' * int(width * min(max(share, 0.0), 1.0))
    return f'{filled:{blank}<{width}}'


class Progress:
    """
    Counts what is done out of a total, with the rate and the time that is left.

    What was there before, such as kept results, counts as done but not for the rate. Where nobody
    can see it, such as in a closed stream, nothing is shown and the work goes on.

    """

    def __init__(
        self,
        total: int,
        unit: str,
        *,
        stream: TextIO | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Begin; `clock` returns seconds, `stream` is stderr by default."""
        self._total, self._unit, self._clock = total, unit, clock
        # Python itself has no stderr where that was closed from the start.
        self._stream: TextIO | None = sys.stderr if stream is None else stream
        self._terminal = self._stream is not None and self._stream.isatty()
        self._begin = self._last = clock()
        self._done = self._there = 0
        self._said = 0.0
        self._open = False
        self._share: float | None = None
        self._note = ''

    def add(self, number: int) -> None:
        """Tell that the work has grown by `number`."""
        self._total += number

    def step(self, *, there: bool = False) -> None:
        """Count one as done; `there` when it was done before."""
        self._there += there
        self.show(self._done + 1, self._total)

    def show(self, done: int, total: int, *, share: float | None = None, note: str = '') -> None:
        """
        Show how much is done out of a total; the clock begins when nothing is.

        Where steps differ, `share` says how far the work is [-], also before the first is done; a
        `note` ends the line.

        """
        self._done, self._total, self._share, self._note = done, total, share, note
        if not done and not share:
            self._begin = self._last = self._clock()
        elif self._terminal:
            self._draw()
        elif self._is_due():
            self._print(self._text())
            self._said, self._last = self._part(), self._clock()

    def beat(self) -> None:
        """Tell a log that the work goes on, where nothing was done for a while."""
        if not self._terminal and self._clock() - self._last >= LOG_PAUSE:
            self._print(self._text())
            self._last = self._clock()

    def close(self) -> None:
        """End the line of a terminal where the work ended early."""
        if self._open:
            self._print('')
            self._open = False

    def _print(self, text: str, end: str = '\n') -> None:
        """Print, until whoever reads has gone."""
        if self._stream is not None:
            try:
                print(text, end=end, file=self._stream, flush=True)
            except OSError:
                self._stream = None

    def _draw(self) -> None:
        drawn = bar(self._part(), WIDTH)
        self._open = self._done < self._total
        end = '' if self._open else '\n'
        # The end of an older, longer line is wiped.
        self._print(f'\r[{drawn}] {self._text()}\x1b[K', end)

    def _part(self) -> float:
        return self._done / max(self._total, 1) if self._share is None else self._share

    def _is_due(self) -> bool:
        return (
            self._done == self._total
            or round(self._part() - self._said, 9) >= LOG_SHARE
            or self._clock() - self._last >= LOG_PAUSE
        )

    def _text(self) -> str:
        return ', '.join(filter(None, (self._count(), self._rate(), self._note)))

    def _count(self) -> str:
        return f'{self._done}/{self._total} {self._unit}'

    def _rate(self) -> str:
        """Return rate and time left, nothing as long as nothing new is done."""
        new, spent = self._done - self._there, self._clock() - self._begin
        if spent <= 0 or not (new or self._share):
            return ''
        if self._share:
            left = spent * (1 - self._share) / self._share
        else:
            left = (self._total - self._done) * spent / new
        if left < 90:
            words = f'{left:.0f} s'
        else:
            words = f'{left / 60:.0f} min' if left < 5400 else f'{left / 3600:.1f} h'
        return ', '.join(filter(None, (_speed(new / spent), f'{words} left')))


def _speed(rate: float) -> str:
    """Return how many come in a second, or how long each takes if that is longer."""
    if rate >= 1:
        return f'{rate:.3g} per s'
    return f'{1 / rate:.2g} s each' if rate else ''
