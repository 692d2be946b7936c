# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signals that end a run early and in order, and the exit codes that tell how it ended."""

from collections.abc import Iterator
import contextlib
import signal
import threading
from typing import Any

DONE, FAILED, SIGNALLED = 0, 1, 128  # exit codes; a signal adds its number


@contextlib.contextmanager
def interrupts(stop: threading.Event) -> Iterator[list[int]]:
    """Collect SIGINT, SIGTERM and SIGHUP in a list and set `stop`, instead of dying of them."""
    received: list[int] = []

    def take(number: int, frame: Any) -> None:
        received.append(number)
        stop.set()

    before = {
        number: signal.signal(number, take)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    }
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
