# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Looks after what the axes keep: takes it up, writes it down now and then, ends a shelving."""

from collections.abc import Callable, Mapping

from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.keeping import Keeping
from rclpy.clock import Clock
from rclpy.node import Node

LOOK = 1.0  # [s] between two looks
PERIOD = 5.0  # [s] between two writes of the sums: a node that is killed loses no more of them


class Caretaker:
    """Looks after the stations that `find` returns; `say` is told which axes have news."""

    def __init__(
        self,
        node: Node,
        keeping: Keeping,
        find: Callable[[], Mapping[str, AxisPublisher]],
        say: Callable[[list[str]], None],
        *,
        clock: Clock,
    ) -> None:
        """Look after them on a steady `clock`."""
        self._node = node
        self._keeping = keeping
        self._find = find
        self._say = say
        self._looks = 0
        node.create_timer(LOOK, self._look, clock=clock)

    def restore(self) -> None:
        """Take up what was kept of all axes, and say what came of that."""
        for name, station in self._find().items():
            station.axis.monitor.take_up(self._keeping.recall(name))
        self._restore_corrections()
        self._keeping.log_problem()

    def remember(self) -> None:
        """Keep the sums, events and shelvings of all axes."""
        for station in self._find().values():
            station.alarm.remember()

    def _look(self) -> None:
        stations = self._find()
        over = [name for name, station in stations.items() if station.look()]
        if over:
            self._say(over)
        if stations and self._keeping.reopen(
            {name: station.axis.monitor for name, station in stations.items()}
        ):
            self._restore_corrections()
            self._say(list(stations))
        self._looks += 1
        if self._looks % round(PERIOD / LOOK) == 0:
            self.remember()
        self._keeping.log_problem()

    def _restore_corrections(self) -> None:
        for name, station in self._find().items():
            if said := station.restore():
                self._node.get_logger().info(f'axis {name}: {said}')
