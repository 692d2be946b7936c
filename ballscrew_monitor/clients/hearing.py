# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Listens to one input as the node does, and keeps what is to be told of it."""

import math
from typing import Any

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.inputs import Input, InputSample
from ballscrew_monitor.judge.inputs import accept, take_refusal
from ballscrew_monitor.judge.records import Event, Memory, Settings
from ballscrew_monitor.judge.words import fill, InputWords
from ballscrew_monitor.messages.doctor import Heard
from rclpy.clock import Clock


class Hearing:
    """The messages of one input: their status, their numbers, and the time between them."""

    def __init__(
        self, source: Input, clock: Clock, *, timeout: int, max_future: int, max_lag: int
    ) -> None:
        """Begin to listen on a clock; times [ns]."""
        self._source, self._clock, self._max_future = source, clock, max_future
        self._memory, self._settings, self._words = Memory(), Settings(), InputWords()
        self._settings.configured[source.source] = 1
        self._settings.timeout[source.source] = timeout
        self._settings.max_lag = max_lag
        self._record = Event()
        self.messages = 0
        self._numbers: list[float] = []
        self._last: int | None = None  # [ns]
        self._longest_gap = 0  # [ns]

    def take(self, message: Any) -> None:
        """Take a message."""
        self.messages += 1
        now = self._clock.now().nanoseconds
        event = self._source.read(message, now=now, max_future=self._max_future)
        fill(self._record, event)
        if isinstance(event, InputSample):
            accept(self._memory, self._settings, self._record, event.value)
            self._keep(event, now)
        else:
            self._words.hear(event, self._memory)
            take_refusal(self._memory, self._record)

    def _keep(self, sample: InputSample, now: int) -> None:
        scaling = self._source.scaling
        self._numbers.append((sample.value - scaling.shift) / scaling.factor)
        self._longest_gap = max(self._longest_gap, self._silence(now))
        self._last = now

    def _silence(self, now: int) -> int:
        """Return the time since the last sample [ns], 0 before the first."""
        return 0 if self._last is None else now - self._last

    def heard(self) -> Heard:
        """Return what has come until now."""
        now = self._clock.now().nanoseconds
        return Heard(
            status=self._words.status(self._memory, self._settings, self._source.source, now),
            low=min(self._numbers, default=math.nan),
            high=max(self._numbers, default=math.nan),
            longest_gap=seconds(max(self._longest_gap, self._silence(now))),
        )
