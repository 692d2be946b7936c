# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Vital signs of the node process: time at work, messages that wait, share of a processor."""

from collections import deque
import dataclasses
import math

SPAN = 10.0
"""Time [s] over which the share of a processor is taken."""
BUSY = 0.9
"""Share of one processor [-] from which the node is busy: one thread judges."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class VitalSigns:
    """
    What the node did since the last look.

    `loop_time` [s]: the longest time from taking what waits to the last of it being judged;
    `queue_depth` [-]: the most messages that waited; `processor_share` [-]: processor time of all
    threads of the process over time, NaN until there are two looks.

    """

    loop_time: float = 0.0
    queue_depth: int = 0
    processor_share: float = math.nan

    @property
    def is_busy(self) -> bool:
        """Return True if the process uses up a processor; not while that is unknown."""
        return self.processor_share >= BUSY


class Vitals:
    """Collects what the node does, from one look to the next."""

    def __init__(self) -> None:
        self._loop_time, self._queue_depth = 0.0, 0
        self._looks: deque[tuple[float, float]] = deque()

    def work(self, duration: float, messages: int) -> None:
        """Take that so many messages waited, and that they took a duration [s]."""
        self._loop_time = max(self._loop_time, duration)
        self._queue_depth = max(self._queue_depth, messages)

    def look(self, time: float, used: float) -> VitalSigns:
        """Return the signs at a steady time [s], `used` being the processor time [s] by then."""
        looks = self._looks
        looks.append((time, used))
        while len(looks) > 2 and time - looks[1][0] >= SPAN:
            looks.popleft()
        begin, before = looks[0]
        signs = VitalSigns(
            loop_time=self._loop_time,
            queue_depth=self._queue_depth,
            processor_share=(used - before) / (time - begin) if time > begin else math.nan,
        )
        self._loop_time, self._queue_depth = 0.0, 0
        return signs
