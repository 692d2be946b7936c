# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A node under load: its inputs, its states, and what it did in a turn."""

from collections.abc import Sequence
import dataclasses
import math
import os
from pathlib import Path
import signal
import subprocess
import time
from typing import NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_msgs.msg import BallScrewState
from geometry_msgs.msg import WrenchStamped
import rclpy
from sensor_msgs.msg import JointState

FAST, SLOW = 100.0, 0.8  # [rad/s] optimal and outside at that load
LOAD = -1000.0  # [N]
WARM_UP = 0.3  # [s] at the start of each turn, in its counts but not in its times
PATIENCE = 60.0  # [s] for a node to start, and to take what waits after a turn
INPUTS = 'speed', 'load'
TURNING = 0.23  # [s] between two changes of the level
STATE_DEPTH = 1000


class Counts(NamedTuple):
    """Messages of the INPUTS of an axis that have come and were lost, as its node counts them."""

    come: tuple[int, ...] = (0, 0)
    lost: tuple[int, ...] = (0, 0)

    @classmethod
    def of(cls, state: BallScrewState) -> 'Counts':
        """Return those of a state; a message that was refused has come, too."""
        inputs = {one.name: one for one in state.inputs}
        come, lost = (
            tuple(getattr(inputs[name], field) for name in INPUTS)
            for field in ('received', 'lost')
        )
        return cls(come, lost)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Turn:
    """
    What one node did in one turn; times in the units that are named.

    A turn begins and ends settled: all that was sent before has come or never will. What is sent
    in between on a topic and has not come is `missing`.

    """

    kind: str
    axes: int
    rate: float  # [Hz] of speed and of load, each axis
    period: float  # [s] publish_period
    sent: int  # messages
    missing: int  # sum over all topics of what was sent and has not come
    missing_topics: int  # that miss any
    lost: int  # of what is missing, by the node's own count
    reached: float  # part of the rate that this process reached [-]
    cpu_percent: float
    cpu_us: float  # per message received [us]
    states: int
    p50_ms: float
    p99_ms: float
    load: float  # load average of the machine


class Peer:
    """A node at work in a process of its own, its inputs and its states."""

    def __init__(self, kind: str, context: rclpy.Context, axes: int, period: float) -> None:
        """Make the topics; `period` [s] is its publish_period."""
        self.kind, self.axes, self.period = kind, axes, period
        self.sent = [0] * axes  # to each topic of an axis
        self._node = rclpy.create_node(f'machine_{kind}', context=context)
        make, names = self._node.create_publisher, axis_names(axes)
        self._speeds = [make(JointState, topic(kind, name, 'speed'), 10) for name in names]
        self._loads = [make(WrenchStamped, topic(kind, name, 'load'), 10) for name in names]
        self._states = [
            self._node.create_subscription(
                BallScrewState, topic(kind, name, 'state'), lambda state: None, STATE_DEPTH
            )
            for name in names
        ]
        self._load = WrenchStamped()
        self._load.wrench.force.x = LOAD
        self._speed = [JointState(name=[name], velocity=[FAST]) for name in names]
        self.counts = [Counts()] * axes
        self._ticked: list[Counts | None] = [None] * axes  # counts at the last tick
        self._settled = [False] * axes
        self._level = 0
        self.times: list[int] = []
        self.process: subprocess.Popen[bytes] | None = None

    def start(self, command: Sequence[str], domain: int) -> float:
        """Start the process; return how long it took to its first state [s]."""
        began = time.time()
        self.process = subprocess.Popen(command, env=child_environment(domain))
        while not self.times:
            if time.time() - began > PATIENCE:
                raise SystemExit(f'no state of the {self.kind} in {PATIENCE:g} s')
            if self._is_matched():
                for axis in range(self.axes):
                    self.publish(axis, FAST)
            time.sleep(0.01)
            for axis in range(self.axes):
                self.look(axis)
        took = time.time() - began
        self.settle()
        return took

    def _is_matched(self) -> bool:
        return all(one.get_subscription_count() for one in (*self._speeds, *self._loads)) and all(
            one.get_publisher_count() for one in self._states
        )

    def stop(self) -> None:
        """End the process."""
        if self.process is not None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait()
        self._node.destroy_node()

    def publish(self, axis: int, speed: float) -> None:
        """Publish load and speed of an axis, stamped with now."""
        message = self._speed[axis]
        message.velocity[0] = speed
        stamp = message.header.stamp
        stamp.sec, stamp.nanosec = divmod(time.time_ns(), SECOND)
        self._load.header.stamp = stamp
        self._loads[axis].publish(self._load)
        self._speeds[axis].publish(message)
        self.sent[axis] += 1

    def look(self, axis: int) -> None:
        """Take the states of an axis that have arrived; no executor, which would be slow."""
        handle = self._states[axis].handle
        while (taken := handle.take_message(BallScrewState, False)) is not None:
            self._take(axis, *taken)

    def _take(self, axis: int, state: BallScrewState, info: dict[str, int]) -> None:
        self.counts[axis] = Counts.of(state)
        stamp = state.header.stamp.sec * SECOND + state.header.stamp.nanosec
        timed = state.result.validity != state.result.VALIDITY_NO_INPUT
        if timed and (self.period == 0.0 or (axis == 0 and state.level != self._level)):
            self.times.append(info['received_timestamp'] - stamp)
        if axis == 0 and timed:
            self._level = state.level
        if not timed:
            self._settled[axis] = self._ticked[axis] == self.counts[axis]
            self._ticked[axis] = self.counts[axis]

    @property
    def processor_time(self) -> float:
        """User and system time of the process [s]."""
        assert self.process is not None
        return time.clock_gettime(~self.process.pid << 3 | 2)  # clock_getcpuclockid(3)

    @property
    def memory(self) -> float:
        """Resident memory of the process [MB]."""
        assert self.process is not None
        pages = int(Path(f'/proc/{self.process.pid}/statm').read_text().split()[1])
        return pages * os.sysconf('SC_PAGE_SIZE') / 1e6

    def run(self, rate: float, duration: float) -> int:
        """Publish at a rate [Hz], the axes in turn, for some time [s]; return the messages."""
        before, step = sum(self.sent), 1.0 / (rate * self.axes)
        begin = due = time.monotonic()
        axis = 0
        while (now := time.monotonic()) - begin < duration:
            if due > now:
                time.sleep(due - now)
            turned = self.period and axis == 0 and (due - begin) % (2 * TURNING) > TURNING
            self.publish(axis, SLOW if turned else FAST)
            self.look(axis)
            axis = (axis + 1) % self.axes
            due += step
        return len(INPUTS) * (sum(self.sent) - before)

    def settle(self) -> None:
        """Wait until two ticks in a row of each axis tell the same: nothing more is to come."""
        self._ticked, self._settled = [None] * self.axes, [False] * self.axes
        end = time.monotonic() + PATIENCE
        while not all(self._settled):
            if time.monotonic() > end:
                raise SystemExit(f'the {self.kind} still counts messages after {PATIENCE:g} s')
            time.sleep(0.02)
            for axis in range(self.axes):
                self.look(axis)

    def missing(self, sent: Sequence[int], counts: Sequence[Counts]) -> list[int]:
        """Return what is missing of each topic since so much was sent and counted, settled."""
        found = []
        for axis, before in enumerate(counts):
            for now, then in zip(self.counts[axis].come, before.come):
                found.append(self.sent[axis] - sent[axis] - (now - then))
        if min(found) < 0:
            raise SystemExit(f'the {self.kind} counts more messages than were sent: {found}')
        return found

    def take_turn(self, rate: float, duration: float) -> Turn:
        """Bring the node under load for some time [s] and return what it did."""
        sent, counts = list(self.sent), list(self.counts)
        self.run(rate, WARM_UP)
        self.times.clear()
        spent, began = self.processor_time, time.monotonic()
        count = self.run(rate, duration)
        wall, spent = time.monotonic() - began, self.processor_time - spent
        self.settle()
        by_topic = self.missing(sent, counts)
        missing, in_all = sum(by_topic), len(INPUTS) * (sum(self.sent) - sum(sent))
        lost = sum(sum(now.lost) - sum(then.lost) for now, then in zip(self.counts, counts))
        times = sorted(self.times) or [math.nan]
        return Turn(
            kind=self.kind,
            axes=self.axes,
            rate=rate,
            period=self.period,
            sent=in_all,
            missing=missing,
            missing_topics=sum(count > 0 for count in by_topic),
            lost=lost,
            reached=count / (2 * rate * self.axes * wall),
            cpu_percent=100 * spent / wall,
            cpu_us=1e6 * spent / count / max(1e-9, 1 - missing / in_all),
            states=len(self.times),
            p50_ms=1e-6 * times[len(times) // 2],
            p99_ms=1e-6 * times[len(times) * 99 // 100],
            load=os.getloadavg()[0],
        )


def axis_names(axes: int) -> list[str]:
    """Return the names of so many axes."""
    return [f'a{number:02d}' for number in range(axes)]


def topic(kind: str, axis: str, what: str) -> str:
    """Return the name of a topic of a node."""
    owner = 'ballscrew_monitor' if kind == 'node' else 'bare'
    return f'/{owner}/{axis}/state' if what == 'state' else f'/{kind}_{axis}/{what}'
