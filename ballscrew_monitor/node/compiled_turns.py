# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Choice of how the turns of a node are judged: compiled if events come fast and code is loaded.

The code is compiled into its cache by a process of its own and loaded by a thread, so that the
judgement goes on meanwhile, interpreted. Of the interpreter, which both share, the thread takes
what the judgement leaves: it begins each module that it imports when no message waits. It takes
memory only where it is used.

"""

from collections.abc import Callable, Mapping
import sys
import threading
from typing import Any

from surrogate.tasks.child import result_apart

COMPILED_FROM = 5000.0
"""Events of all inputs in a second [1/s] from which on turns are judged compiled."""
SPAN = 1.0  # [s] over which they are counted
LONGEST_WAIT = 0.02  # [s] of the loading thread before a module, if messages wait at all times
NICENESS = 10  # of the process that compiles
NOT_COMPILED = (
    'messages come faster than {:g} in a second and are judged without compiled code, so some may '
    'be lost ({}): install numba, and let NUMBA_CACHE_DIR name a folder that the node may write to'
)


def load(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Compile what judges many events, or load it out of its cache; a task."""
    from ballscrew_monitor.health import collect
    from ballscrew_monitor.judge import many
    from ballscrew_monitor.recordings.bulk import ways

    many.prepare()
    ways.prepare()
    collect.prepare()
    return {}


class CompiledTurns:
    """Decides how turns are judged, by what arrives."""

    def __init__(self, warn: Callable[[str], object]) -> None:
        """
        Say by `warn`, once, why nothing is compiled where it should be.

        `at_rest` is to be set while no message waits.

        """
        self._warn, self.at_rest = warn, threading.Event()
        self._begin, self._count = 0.0, 0
        self._fast = self._loaded = self._warned = False
        self._problem = ''
        self._thread: threading.Thread | None = None

    @property
    def are_due(self) -> bool:
        """Return True if turns are judged compiled now."""
        return self._fast and self._loaded

    def count(self, events: int, now: float) -> None:
        """Take that so many events have come by `now` [s] of a steady clock."""
        self._count += events
        span = now - self._begin
        if span < SPAN:
            return
        self._fast = self._count >= COMPILED_FROM * span
        self._begin, self._count = now, 0
        if self._fast and self._thread is None:
            self._thread = threading.Thread(target=self._load, name='compile', daemon=True)
            self._thread.start()
        if self._fast and self._problem and not self._warned:
            self._warned = True
            self._warn(NOT_COMPILED.format(COMPILED_FROM, self._problem))

    def give_up(self, error: Exception) -> None:
        """Judge interpreted from now on, since compiled code failed."""
        self._loaded, self._problem = False, f'{type(error).__name__}: {error}'

    def find_spec(self, name: str, *place: object) -> None:
        """
        Find no module; the thread that loads waits, before each one, until nothing waits.

        Who imports something for the first time meanwhile waits for the end of that.

        """
        if threading.current_thread() is self._thread:
            self.at_rest.wait(LONGEST_WAIT)

    def _load(self) -> None:
        """Let a process fill the cache, and load what lies there."""
        try:
            failure = 'the judgement is not compiled'
            result_apart(f'{__name__}:load', {}, memory=0, failure=failure, niceness=NICENESS)
            sys.meta_path = [self, *sys.meta_path]
            load({})
            self._loaded = True
        except Exception as error:  # whatever a compiler raises: the node goes on interpreted
            self._problem = str(error) or type(error).__name__
        finally:
            # Other threads may walk the list at this time, so it is replaced and not changed.
            sys.meta_path = [finder for finder in sys.meta_path if finder is not self]
