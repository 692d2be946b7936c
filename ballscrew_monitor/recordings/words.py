# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Words to people: numbers as they read them, shares, lists; notes and progress on a terminal."""

from collections.abc import Callable, Iterator, Sequence
import contextlib
import math
import re
import sys
import time

from surrogate.files import printable
from surrogate.tasks.progress import Progress

NONE = '–'
TURNS = re.compile(r'(?:\S+ rad/s \()?(-?[\d.]+(?:e[+-]?\d+)?) rev/min\)?')
"""A speed of the screw as words of an event state it."""
MOST, LONGEST = 60, 80
"""Names that are listed, and letters of each."""


def number(value: float, digits: int = 3) -> str:
    """Return a number with some digits that count, a dash for none."""
    if not math.isfinite(value):
        return NONE
    text = f'{value:.{digits}g}'
    if 'e' in text and 1e-4 <= abs(value) < 1e6:
        return f'{float(text):.0f}' if abs(value) >= 1.0 else f'{float(text):f}'.rstrip('0')
    return text


def duration(seconds: float) -> str:
    """Return a time [s] in the unit that a person would use."""
    if not math.isfinite(seconds):
        return NONE
    if seconds < 120.0:
        return f'{number(seconds)} s'
    return f'{number(seconds / 60.0)} min' if seconds < 7200.0 else f'{number(seconds / 3600.0)} h'


def percent(part: float) -> str:
    """Return a part of one as percent, never 0 or 100 for what is only near."""
    if not math.isfinite(part):
        return NONE
    if 0.0 < part < 0.001:
        return 'less than 0.1 %'
    if 0.99 < part < 1.0:
        return f'{min(100.0 * part, 99.9):.1f} %'
    return f'{100.0 * part:.2g} %' if part < 0.995 else f'{100.0 * part:.0f} %'


def feed_first(text: str, lead: float) -> str:
    """Return words with each speed of the screw as a feed, the speed beside it; lead [m]."""

    def shown(speed: re.Match[str]) -> str:
        turns = float(speed[1])
        return f'{number(turns * lead)} m/min, {speed[1]} rev/min'

    return TURNS.sub(shown, text)


def shown_unit(unit: str) -> str:
    """Return the sign of a unit that parameters write without it."""
    return '°C' if unit == 'degC' else unit


def share(part: float, whole: float) -> str:
    """Return a part of a whole as percent, a dash where there is no whole."""
    return percent(part / whole) if whole > 0.0 else NONE


def counted(count: int, name: str) -> str:
    """Return a count with the name of what is counted: 1 warning, 2 warnings."""
    return f'{count} {name}{"" if count == 1 else "s"}'


def list_of(parts: Sequence[str]) -> str:
    """Return phrases as one: a, b; and c."""
    return parts[0] if len(parts) == 1 else f'{"; ".join(parts[:-1])}; and {parts[-1]}'


def listed(names: Sequence[str]) -> str:
    """Return names after each other, the first of many, and only the begin of long ones."""
    more = [f'and {len(names) - MOST} more'] if len(names) > MOST else []
    return ', '.join([*map(short, names[:MOST]), *more])


def short(text: str) -> str:
    """Return a text, or the begin of a long one."""
    return text if len(text) <= LONGEST else f'{text[:LONGEST]}…'


def say(*notes: str) -> None:
    """Print notes to standard error, each with the name of the command."""
    for note in notes:
        print(printable(f'ballscrew: {note}'), file=sys.stderr)


PATIENCE = 2.0  # [s] of work before anything is said
Shown = Callable[[float, str], contextlib.AbstractContextManager[Callable[[float], None]]]
"""Shows how far a total of some unit is done, as `shown_progress` does."""


@contextlib.contextmanager
def shown_progress(
    total: float,
    unit: str = 's of the recording',
    *,
    progress: Progress | None = None,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Callable[[float], None]]:
    """Give what shows the share [-] done of a total of some unit, if it takes long."""
    whole, begin = max(round(total), 1), clock()
    bar = progress or Progress(whole, unit)
    bar.show(0, whole)

    def show(share: float) -> None:
        if clock() - begin >= PATIENCE:
            bar.show(min(max(round(share * whole), 1), whole), whole)

    try:
        yield show
    finally:
        bar.close()
