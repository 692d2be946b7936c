# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Part programs of a reference run, in the dialects of controls.

A program moves one axis from its start forth and back in increments, waits between runs, and ends
where it began. Feeds are in mm/min, lengths in mm.

"""

from collections.abc import Iterable, Iterator, Sequence
import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.fingerprint import LEAST_TIME, PAUSE, Step
from surrogate.units import MILLI, MINUTE, RPM

BETWEEN = 2 * PAUSE // SECOND
"""Time between two runs, so that they are known apart [s]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Dialect:
    """
    How a control writes its blocks.

    Formats of a comment, of a relative and of an absolute move with the fields `axis`, `length`
    and `feed`, of a dwell of some `time` [s]; blocks that begin and end a program, and those
    around relative moves. `numbers` the blocks from 0, as conversational programs do.

    """

    comment: str
    move: str
    place: str
    dwell: Sequence[str]
    head: Sequence[str]
    tail: Sequence[str]
    relative: Sequence[str] = ('G91',)
    absolute: Sequence[str] = ('G90',)
    numbers: bool = False


ISO = Dialect(
    comment='({})',
    move='G1 {axis}{length:.3f} F{feed:.1f}',
    place='G1 {axis}{length:.3f} F{feed:.1f}',
    dwell=('G4 X{time:.1f}',),
    head=('%', 'O9001', 'G21 G90 G94'),
    tail=('M30', '%'),
)
DIALECTS = {
    'iso': ISO,
    'sinumerik': dataclasses.replace(
        ISO,
        comment='; {}',
        move='G1 {axis}={length:.3f} F{feed:.1f}',
        place='G1 {axis}={length:.3f} F{feed:.1f}',
        dwell=('G4 F{time:.1f}',),
        head=('G710 G90 G94',),
        tail=('M30',),
    ),
    'heidenhain': Dialect(
        comment='; {}',
        move='L I{axis}{length:+.3f} R0 F{feed:.0f}',
        place='L {axis}{length:+.3f} R0 F{feed:.0f}',
        dwell=('CYCL DEF 9.0 DWELL TIME', 'CYCL DEF 9.1 DWELL {time:.1f}'),
        head=('BEGIN PGM FINGERPRINT MM',),
        tail=('M30', 'END PGM FINGERPRINT MM'),
        relative=(),
        absolute=(),
        numbers=True,
    ),
    'linuxcnc': dataclasses.replace(
        ISO, dwell=('G4 P{time:.1f}',), head=('G21 G90 G94 G61',), tail=('M2',)
    ),
}
"""Dialects by the names of `--dialect`."""


def program_of(
    steps: Sequence[Step],
    axis: str,
    travel: float,
    *,
    dialect: Dialect = ISO,
    runs: int = 1,
    start: float = math.nan,
) -> Iterator[str]:
    """
    Yield the program of some runs over a `travel` [m] on an axis, from `start` [m] or where it is.

    The axis moves in its positive direction first.

    """
    blocks = _blocks(steps, axis, travel, dialect, runs, start)
    for number, block in enumerate(blocks):
        yield f'{number} {block}' if dialect.numbers else block


def _blocks(
    steps: Sequence[Step], axis: str, travel: float, dialect: Dialect, runs: int, start: float
) -> Iterator[str]:
    yield from dialect.head
    yield from map(dialect.comment.format, _notes(steps, axis, travel, start))
    if math.isfinite(start):
        slow = MILLI * MINUTE * max(step.feed for step in steps)
        yield dialect.place.format(axis=axis, length=MILLI * start, feed=slow)
    yield from dialect.relative
    for run in range(runs):
        if run:
            yield from (block.format(time=BETWEEN) for block in dialect.dwell)
        yield from _moves(steps, axis, travel, dialect)
    yield from dialect.absolute
    yield from dialect.tail


def _moves(steps: Iterable[Step], axis: str, travel: float, dialect: Dialect) -> Iterator[str]:
    for step in steps:
        length = MILLI * min(travel, LEAST_TIME * step.feed)
        feed = MILLI * MINUTE * step.feed
        for _ in range(step.strokes):
            for way in (length, -length):
                yield dialect.move.format(axis=axis, length=way, feed=feed)


def _notes(steps: Sequence[Step], axis: str, travel: float, start: float) -> Iterator[str]:
    place = f'{MILLI * start:g} mm' if math.isfinite(start) else 'where it stands'
    yield f'free of load, warm, without cutting; {axis} moves {MILLI * travel:g} mm from {place}'
    for step in steps:
        yield (
            f'{step.speed / RPM:.0f} rev/min, {MILLI * MINUTE * step.feed:.0f} mm/min: '
            f'{step.strokes} times forth and back, {step.time:.0f} s'
        )
    yield f'{sum(step.time for step in steps):.0f} s in motion'
