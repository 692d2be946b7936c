# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Which columns of a log belong to which axis."""

from collections.abc import Sequence
import re

from ballscrew_monitor.recordings.tables.mapping import INPUTS
from ballscrew_monitor.recordings.tables.names import axis_names, Named, word_of_the_axis

MOTION = ('speed', 'position')
_NAME = re.compile(r'[a-z][a-z0-9_]*')


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
