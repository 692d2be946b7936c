# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signals that end a run early and in order, and the exit codes that tell how it ended."""

from collections.abc import Iterator
import contextlib
import os
import signal
import sys
import threading
from typing import Any

DONE, FAILED, BAD_INPUT, SIGNALLED = 0, 1, 2, 128  # exit codes; a signal adds its number


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


def end_at_once() -> None:
    """
    Let SIGINT and SIGTERM end the process with one line and their exit code.

    For the time in which there is nothing to be put in order, such as that of imports: an
    exception in the middle of one has many faces.

    """
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _leave)


def leave_to_python() -> None:
    """Undo `end_at_once`: SIGINT raises KeyboardInterrupt."""
    if signal.getsignal(signal.SIGINT) is _leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def raise_signals() -> None:
    """Undo `end_at_once`: both signals are exceptions, so that what is half made is removed."""
    if signal.getsignal(signal.SIGINT) is _leave:
        leave_to_python()
        signal.signal(signal.SIGTERM, _exit)


def _exit(number: int, frame: Any) -> None:
    signal.signal(number, signal.SIG_IGN)  # nothing interrupts the removal
    print('ballscrew: interrupted', file=sys.stderr)
    raise SystemExit(SIGNALLED + number)


def _leave(number: int, frame: Any) -> None:
    os.write(2, b'ballscrew: interrupted\n')
    os._exit(SIGNALLED + number)
