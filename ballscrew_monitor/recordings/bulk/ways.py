# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The numbers of messages of several types at once: each message is walked by its own layout."""

from collections.abc import Sequence
import functools
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bulk.layout import Layout, NUMBER, numbers_of, walk, WALKED
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.compiled import compiled

NO_STEPS, NO_LETTERS = np.empty((0, 5), np.int64), np.empty(0, np.uint8)


class Ways:
    """Some layouts, by their numbers."""

    def __init__(self, layouts: Sequence[Layout]) -> None:
        """Join their steps."""
        self._step_ends = np.cumsum([len(layout.steps) for layout in layouts], dtype=np.int64)
        self._joint_ends = np.cumsum([len(layout.joint) for layout in layouts], dtype=np.int64)
        self._steps = np.concatenate([NO_STEPS, *(layout.steps for layout in layouts)])
        self._joints = np.concatenate([NO_LETTERS, *(layout.joint for layout in layouts)])
        codes = [layout.code for layout in layouts]
        self._codes = {code: np.array([other == code for other in codes]) for code in set(codes)}

    def walk(
        self, messages: Sequence[bytes], which: NDArray[np.intp], way: NDArray[np.intp]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.int64]]:
        """
        Follow ways, by their numbers, through some of the messages, by their places.

        Return where there is a number, the number, and the stamp [ns].

        """
        data = np.frombuffer(b''.join(messages), np.uint8)
        ends = np.cumsum(np.fromiter(map(len, messages), np.int64, len(messages)))
        ends = np.concatenate((np.zeros(1, np.int64), ends))
        walked = np.zeros(len(way), dtype=WALKED)
        compiled_walk_each()(
            *(data, ends, which, way),
            *(self._steps, self._step_ends, self._joints, self._joint_ends),
            walked.view(np.recarray),
        )
        number = np.zeros(len(way))
        for code, has_code in self._codes.items():
            of_code = has_code[way]
            number[of_code] = numbers_of(walked['bits'][of_code], code)
        return (
            walked['outcome'] == NUMBER,
            number,
            walked['seconds'] * SECOND + walked['nanoseconds'],
        )


@functools.cache
def compiled_walk_each() -> Any:
    """Return `walk_each`, compiled where there is numba."""
    try:
        return compiled(walk_each)
    except ImportError:
        return walk_each


def walk_each(
    data: Any,
    ends: Any,
    which: Any,
    way: Any,
    steps: Any,
    step_ends: Any,
    joints: Any,
    joint_ends: Any,
    walked: Any,
) -> None:
    """Follow a way through each message `which` of those that end there in `data`, from 0 on."""
    for at in range(len(which)):
        number, after = way[at], which[at] + 1
        first_step = step_ends[number - 1] if number > 0 else 0
        first_letter = joint_ends[number - 1] if number > 0 else 0
        last_step, last_letter = step_ends[number], joint_ends[number]
        walk(
            data,
            ends[which[at]],
            ends[after],
            steps[first_step:last_step],
            joints[first_letter:last_letter],
            walked[at],
        )


def prepare() -> None:
    """Compile the walk through messages, so that the first ones do not wait for it."""
    nothing = np.empty(0, np.intp)
    Ways([]).walk([], nothing, nothing)
