# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Comparison of what is played with what the monitors that listen take, by their own diagnostics.

Their inputs are best effort: the middleware does not hold the player back for them.

"""

from collections.abc import Callable, Mapping
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node
from rclpy.time import Time

DIAGNOSTICS, PART = '/diagnostics', ': Inputs'
TAKEN, LOST, MATCHED = ' received [-]', ' lost [-]', ' publishers [-]'
FRESH = ('Speed state', 'OK')
FIRST_WORD, LAST_WORD = 2.0, 5.0  # [s] that a monitor may take to tell what it has taken
POLL = 0.05  # [s]
DEPTH = 1000
LATEST = 2**63
Counts = Mapping[str, int]
"""Messages by the input of an axis and whether they are taken or lost."""


class Following:
    """What the monitors have taken and lost since the first that was heard of them."""

    def __init__(self, node: Node, topics: Mapping[tuple[str, str], str]) -> None:
        """Listen on a node, which is spun here alone; `topics` by axis and input, if known."""
        self._node, self._topics = node, topics
        self._first: dict[str, Counts] = {}
        self._last: dict[str, Counts] = {}
        self._resting: set[str] = set()  # monitors whose counts do after the end
        self._unmatched: set[str] = set()  # those that miss the publisher of an input
        self._end = LATEST
        node.create_subscription(DiagnosticArray, DIAGNOSTICS, self._hear, DEPTH)

    def begin(self) -> None:
        """
        Wait a little for what the monitors have taken before, and until they know the player.

        Without a monitor it does not wait.

        """
        deadline = time.monotonic() + FIRST_WORD
        while (not self._first or self._unmatched) and time.monotonic() < deadline:
            if not self._node.count_publishers(DIAGNOSTICS):
                break
            self._take(POLL)

    def settle(self, end: int, run_on: Callable[[Callable[[], bool], float], object]) -> None:
        """
        Let the clock run on until the counts of all monitors rest after the `end` [ns].

        Their speeds are stale then: a tick comes after all that waits.

        """
        self._end = end

        def rest() -> bool:
            self._take()
            return self._resting == self._last.keys()

        if self._first:
            run_on(rest, LAST_WORD)

    def complaint(self, rate: float, sent: Mapping[str, int]) -> str:
        """
        Return which input has lost most at a `rate` [-], of how many; empty if none has.

        Of an input whose topic is known all that was `sent` on it counts, of another one what the
        monitor knows to be lost: it cannot know that of the last messages.

        """
        found = []
        for name, counts in self._last.items():
            where = name.removesuffix(PART)
            for source in (one.removesuffix(TAKEN) for one in counts if one.endswith(TAKEN)):
                taken = self._gained(name, source + TAKEN)
                if not taken:  # it listens to something else
                    continue
                key = where.rpartition(': ')[2], source.lower()
                count = sent.get(self._topics.get(key, ''), 0) or taken + self._gained(
                    name, source + LOST
                )
                found.append((count - taken, taken, count, where, source.lower()))
        lost, taken, count, where, source = max(found, default=(0, 0, 0, '', ''))
        if lost <= 0:
            return ''
        return (
            f'{where} did not follow at {rate:g}x: it took {taken} of {count} messages of its '
            f'{source}; lower --rate'
        )

    def _gained(self, name: str, one: str) -> int:
        return self._last[name].get(one, 0) - self._first[name].get(one, 0)

    def _hear(self, message: DiagnosticArray) -> None:
        late = Time.from_msg(message.header.stamp).nanoseconds > self._end
        for status in message.status:
            if not status.name.endswith(PART):
                continue
            counts = _counts(status)
            fresh = any((pair.key, pair.value) == FRESH for pair in status.values)
            if late and not fresh and counts == self._last.get(status.name):
                self._resting.add(status.name)
            missing = any(
                pair.key.endswith(MATCHED) and pair.value == '0' for pair in status.values
            )
            (self._unmatched.add if missing else self._unmatched.discard)(status.name)
            self._first.setdefault(status.name, counts)
            self._last[status.name] = counts

    def _take(self, patience: float = 0.0) -> None:
        """Take a word of a monitor if one has come within a time [s]."""
        assert self._node.executor is not None
        self._node.executor.spin_once(timeout_sec=patience)


def _counts(status: DiagnosticStatus) -> Counts:
    """Return how many messages were taken and lost, as far as a status tells."""
    return {
        pair.key: int(pair.value)
        for pair in status.values
        if pair.key.endswith((TAKEN, LOST)) and pair.value.isdecimal()
    }
