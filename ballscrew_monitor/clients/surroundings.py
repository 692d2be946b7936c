# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surroundings in a ROS graph: domain, nodes, topics, and an input as nodes take it."""

from collections.abc import Callable, Sequence
import contextlib
import math
import os
from pathlib import Path
import time
from typing import Any

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.inputs import Input, InputSample
from ballscrew_monitor.judge.inputs import accept, take_refusal
from ballscrew_monitor.judge.monitor import fill, InputWords
from ballscrew_monitor.judge.records import Event, Memory, Settings
from ballscrew_monitor.messages.doctor import Heard, Surroundings
from rclpy.clock import Clock
from rclpy.node import Node

UDP = Path('/proc/net/udp')
PORTS, PER_DOMAIN, OFFSETS = 7400, 250, range(10, 60)  # DDSI-RTPS 2.3, 9.6.1
POLL = 0.05  # [s] longest wait before a signal is noticed
MOST_DOMAIN = 101  # above, the ports may be those of any client


def spun(
    node: Node, condition: Callable[[], Any], seconds: float, interrupted: Sequence[int] = ()
) -> Any:
    """Spin for some `seconds` [s] until a condition gives something, or until interrupted."""
    assert node.executor is not None
    end = time.monotonic() + seconds
    while not (found := condition()) and time.monotonic() < end and not interrupted:
        node.executor.spin_once(timeout_sec=POLL)
    return found


def surroundings(node: Node) -> Surroundings:
    """Return what is seen around the node."""
    domain, udp_table = node.context.get_domain_id(), ''
    with contextlib.suppress(OSError):
        udp_table = UDP.read_text()
    published = {
        name: tuple(types)
        for name, types in node.get_topic_names_and_types()
        if node.count_publishers(name)
    }
    return Surroundings(
        domain=domain,
        discovery=os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET').upper(),
        localhost_only=os.environ.get('ROS_LOCALHOST_ONLY') == '1',
        nodes=tuple(sorted(name for name in node.get_node_names() if name != node.get_name())),
        topics=published,
        domains=tuple(other for other in domains_of(udp_table) if other != domain),
        use_sim_time=bool(node.get_parameter('use_sim_time').value),
    )


def domains_of(udp_table: str) -> list[int]:
    """Return the ROS domains whose ports a table of UDP sockets, as Linux writes it, shows."""
    found = set()
    for line in udp_table.splitlines()[1:]:
        port = int(line.split()[1].rpartition(':')[2], 16) - PORTS
        domain, offset = divmod(port, PER_DOMAIN)
        if 0 <= domain <= MOST_DOMAIN and offset in OFFSETS:
            found.add(domain)
    return sorted(found)


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
            scaling = self._source.scaling
            self._numbers.append((event.value - scaling.shift) / scaling.factor)
            self._longest_gap = max(self._longest_gap, self._silence(now))
            self._last = now
        else:
            self._words.hear(event, self._memory)
            take_refusal(self._memory, self._record)

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
