# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Plays a bag over DDS: the serialised messages as they are, and `/clock` from their log times.

`/clock` ticks at 100 Hz and before each message, so that a subscriber on simulated time never
sees a message from its future. The messages are offered reliably: a subscriber that asks for
best effort gets them as such, one that asks for more is not refused.

"""

from collections import Counter
from collections.abc import Callable, Sequence
import dataclasses
import threading
import time

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.recordings.bag import Bag
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from rosgraph_msgs.msg import Clock
from surrogate.files import InputError

CLOCK_PERIOD = 0.01  # [s] of wall time
MATCH_POLL = 0.02  # [s] between two looks at who has matched
DELIVERY = 5.0  # [s] that the last messages may take
CLOCK_QOS = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
DATA_QOS = QoSProfile(
    history=QoSHistoryPolicy.KEEP_LAST,
    depth=1000,
    reliability=QoSReliabilityPolicy.RELIABLE,
    durability=QoSDurabilityPolicy.VOLATILE,
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Played:
    """
    What has been played.

    Messages sent by topic; whether the end of the bag was reached; the longest time by which a
    message was late [s].

    """

    sent: Counter[str]
    complete: bool
    lateness: float


class Player:
    """Publishes the messages of a bag on a node, which need not be spun."""

    def __init__(
        self, node: Node, bag: Bag, *, rate: float = 1.0, topics: Sequence[str] | None = None
    ) -> None:
        """Make the publishers; `rate` is bag time over wall time, above 0; topics None: all."""
        if not 0.0 < rate < float('inf'):
            raise InputError(f'rate is {rate:g}, it must be above 0')
        self._bag, self._rate = bag, rate
        self._sent: Counter[str] = Counter()
        self._now = bag.start_time
        self._publishers = {
            topic: node.create_publisher(
                message_class(bag.topics[topic].type_name), topic, DATA_QOS
            )
            for topic in (bag.topics if topics is None else topics)
        }
        # Made last: who hears it has heard of the others.
        self._clock = node.create_publisher(Clock, '/clock', CLOCK_QOS)

    @property
    def now(self) -> int:
        """Return the time that `/clock` shows [ns]."""
        return self._now

    @property
    def elapsed(self) -> float:
        """Return the bag time played so far [s]."""
        return (self._now - self._bag.start_time) / SECOND

    @property
    def sent(self) -> Counter[str]:
        """Return the number of messages sent so far, by topic."""
        return self._sent

    def unmatched(self, wanted: int = 1) -> list[str]:
        """Return the topics with fewer than `wanted` subscribers, and /clock if it has none."""
        missing = [
            topic
            for topic, publisher in self._publishers.items()
            if publisher.get_subscription_count() < wanted
        ]
        return missing + (['/clock'] if self._clock.get_subscription_count() == 0 else [])

    def wait_for_subscribers(self, timeout: float, stop: threading.Event) -> list[str]:
        """Wait until every topic has a subscriber, at most `timeout` [s]; return those without."""
        deadline = time.monotonic() + timeout
        while (missing := self.unmatched()) and time.monotonic() < deadline:
            if stop.wait(MATCH_POLL):
                break
        return missing

    def show_begin(self) -> None:
        """Publish the time at which the bag begins, so that a listener may answer to it."""
        self._tick(self._bag.start_time)

    def play(self, stop: threading.Event) -> Played:
        """Publish the bag until its end or until `stop` is set; raises InputError on damage."""
        begin, latest = time.monotonic(), 0.0
        for message in self._bag.messages(self._publishers):
            due = begin + (message.log_time - self._bag.start_time) / SECOND / self._rate
            if not self._wait(due, stop, begin):
                return Played(sent=self._sent, complete=False, lateness=latest)
            self._tick(message.log_time)
            self._publishers[message.topic].publish(message.data)
            self._sent[message.topic] += 1
            latest = max(latest, time.monotonic() - due)
        self._deliver()
        return Played(sent=self._sent, complete=True, lateness=latest)

    def _deliver(self) -> None:
        """Wait until reliable subscribers have all: what is under way dies with its publisher."""
        deadline = time.monotonic() + DELIVERY
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(Duration(seconds=max(0.0, deadline - time.monotonic())))

    def run_on(self, finished: Callable[[], bool], timeout: float, stop: threading.Event) -> bool:
        """
        Let `/clock` go on after the end until `finished`, at most `timeout` [s] of wall time.

        Returns what `finished` says at last. A subscriber with a timer on simulated time can so
        notice that the data have ended.

        """
        begin, base = time.monotonic(), self._now
        while not finished() and time.monotonic() < begin + timeout:
            if stop.wait(CLOCK_PERIOD):
                break
            self._tick(base + round((time.monotonic() - begin) * self._rate * SECOND))
        return finished()

    def _wait(self, due: float, stop: threading.Event, begin: float) -> bool:
        """Tick the clock until `due` [s] of the steady clock; False when stopped."""
        while (left := due - time.monotonic()) > 0.0:
            if stop.wait(min(left, CLOCK_PERIOD)):
                return False
            at = self._bag.start_time + round((time.monotonic() - begin) * self._rate * SECOND)
            if time.monotonic() < due:
                self._tick(at)
        return not stop.is_set()

    def _tick(self, now: int) -> None:
        """Publish the time `now` [ns], which never goes back."""
        self._now = max(now, self._now)
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(self._now, SECOND)
        self._clock.publish(message)
