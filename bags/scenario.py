# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A scenario: what the machine does in closed form, and what the monitor must say of it.

Signals are without noise, so that an expectation follows from the courses alone. Times [s] count
from the begin of the bag by the source's clock.

"""

from collections.abc import Callable, Iterator, Mapping
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag_writer import Topic
from courses import constant, Course, Steps
from recording import (
    AXIAL_LOAD,
    BEGIN,
    joint_state,
    JOINT_STATES,
    OIL_TEMPERATURE,
    Record,
    temperature,
    wrench,
    write_bag,
)
from surrogate.files import replace_file
from surrogate.units import RPM
import yaml

NOMINAL_PARAMETERS = Path(__file__).resolve().parents[1] / 'config' / 'nominal_cycle.yaml'
PARAMETERS = 'parameters.yaml'
PERIOD = 0.02  # [s] of speed and load samples
OIL_PERIOD = 1.0  # [s] of oil samples
DELAYS = {OIL_TEMPERATURE.name: 100_000, AXIAL_LOAD.name: 200_000, JOINT_STATES.name: 400_000}
"""Times from the measurement to its arrival [ns]."""

Span = tuple[float, float]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ExpectedEvent:
    """A stay outside: start and end lie in spans [s]; without an end it is still on at last."""

    cause: str
    start: Span
    end: Span | None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Stretch:
    """
    A steady stretch: every state in the span `time` [s] is as said; None may be anything.

    `reason` is a part of the sentence that says why nothing was judged; `torque` [N m] is the span
    of the model's torque along the motion, negative when the load drives.

    """

    time: Span
    zone: str | None = None
    level: str | None = None
    validity: str | None = None
    reason: str | None = None
    direction: str | None = None
    torque: Span | None = None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ResidualChange:
    """Mean torque residual in one span [s] less that in an earlier one [N m]."""

    since: Span
    time: Span
    change: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LimitPoint:
    """
    A point at which the surface is said to have a certain value of `quantity`, rcs or efficiency.

    Speed [rev/min], opposing load [N], oil [degC]. For rcs the speed may be 10 % off, an
    efficiency 0.01: expectations hold within that.

    """

    quantity: str
    value: float
    speed: float
    load: float
    oil: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Expected:
    """
    What the monitor must say.

    Events; the held levels in order, the last one at the end; whether all speed samples are judged
    and how many messages are refused; lag of the stamps [s], None: not looked at.

    """

    levels: tuple[str, ...]
    events: tuple[ExpectedEvent, ...] = ()
    stretches: tuple[Stretch, ...] = ()
    limit_points: tuple[LimitPoint, ...] = ()
    residuals: tuple[ResidualChange, ...] = ()
    all_judged: bool = False
    all_refused: bool = False
    lag: float | None = None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Scenario:
    """
    What happens on the axis.

    Speed of the screw [rev/min], force on the nut along the axis [N], oil [degC], torque at the
    screw [N m] or none. `pauses` [s] are added to all times, `clock` [s] to the stamps alone;
    `silences` are topics with the span in which nothing comes of them. `parameters` are those that
    differ from config/nominal_cycle.yaml.

    """

    shows: str
    duration: float
    speed: Course
    load: Course
    oil: Course = dataclasses.field(default_factory=lambda: constant(40.0))
    torque: Course | None = None
    pauses: Steps = dataclasses.field(default_factory=Steps)
    clock: Steps = dataclasses.field(default_factory=Steps)
    silences: tuple[tuple[Topic, Span], ...] = ()
    parameters: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    expected: Expected

    def records(self) -> list[Record]:
        """Return every message in the order of its arrival."""
        made = [*self._oil(), *self._load(), *self._joint()]
        return sorted(made, key=lambda record: (record.log_time, record.topic))

    def stamp(self, time: float) -> int:
        """Return the stamp [ns] of what is measured at `time` [s], by the source's clock."""
        return self._arrival(time) + round(self.clock.at(time) * SECOND)

    def _arrival(self, time: float) -> int:
        return BEGIN + round((time + self.pauses.at(time)) * SECOND)

    def _oil(self) -> Iterator[Record]:
        for time in self._times(OIL_TEMPERATURE, OIL_PERIOD):
            yield self._record(OIL_TEMPERATURE, time, temperature, self.oil.at(time))

    def _load(self) -> Iterator[Record]:
        for time in self._times(AXIAL_LOAD, PERIOD):
            yield self._record(AXIAL_LOAD, time, wrench, self.load.at(time))

    def _joint(self) -> Iterator[Record]:
        angle = 0.0
        for time in self._times(JOINT_STATES, PERIOD):
            speed = self.speed.at(time) * RPM
            angle += speed * PERIOD
            effort = () if self.torque is None else (self.torque.at(time),)
            yield self._record(JOINT_STATES, time, joint_state, angle, speed, *effort)

    def _times(self, topic: Topic, period: float) -> Iterator[float]:
        """Yield the times [s] at which `topic` is measured and not silent."""
        silent = [span for name, span in self.silences if name is topic]
        for number in range(math.ceil(self.duration / period)):
            time = number * period
            if not any(begin <= time < end for begin, end in silent):
                yield time

    def _record(
        self, topic: Topic, time: float, encode: Callable[..., bytes], *values: float
    ) -> Record:
        stamp = self.stamp(time)
        return Record(
            topic=topic.name,
            stamp=stamp,
            log_time=self._arrival(time) + DELAYS[topic.name],
            data=encode(stamp, *values),
        )


def generate(scenario: Scenario, directory: Path) -> None:
    """Write the bag to `directory`, and in it the parameters of the node."""
    write_bag(directory, scenario.records())
    text = yaml.safe_dump(parameters(scenario), sort_keys=False)
    replace_file(directory / PARAMETERS, text.encode())


def parameters(scenario: Scenario) -> dict[str, Any]:
    """Return the content of the parameter file: that of the nominal cycle and what differs."""
    content: dict[str, Any] = yaml.safe_load(NOMINAL_PARAMETERS.read_text())
    (node,) = content.values()
    nested(scenario.parameters, node['ros__parameters'])
    return content


def nested(values: Mapping[str, Any], within: dict[str, Any] | None = None) -> dict[str, Any]:
    """Return parameters by full name as sections within sections, or added to those `within`."""
    made = {} if within is None else within
    for name, value in values.items():
        *groups, leaf = name.split('.')
        place = made
        for group in groups:
            place = place.setdefault(group, {})
        place[leaf] = value
    return made
