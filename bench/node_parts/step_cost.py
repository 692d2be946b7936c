# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cost of judging in a process, interpreted or compiled for each sample, without DDS.

Run `python bench/node_parts/step_cost.py WAY AXES RATE SECONDS`, WAY being `interpreted` or
`compiled`. Prints the time from the start of the interpreter to the first state [s], the largest
resident memory [MB], the processor time over the time of the samples, one speed and one load each,
and the time of one Python call [us].

"""

import dataclasses
import math
import operator
import os
from pathlib import Path
import resource
import sys
import time
import timeit

from ballscrew_monitor.core.inputs import InputSample, Source, StampSource
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from surrogate.surface import Surface

BEGIN = 1_700_000_000_000_000_000  # [ns]
TICK = 100_000_000  # [ns]


class CompiledMonitor(Monitor):
    """A monitor that takes each event as an array of one through the compiled step."""

    def __init__(self, surface: Surface, settings: MonitorSettings) -> None:
        """Import numba and load the step out of its cache."""
        from ballscrew_monitor.judge import many
        import numpy as np

        super().__init__(surface, settings)
        self._many, self._entry = many, many.compiled_step()
        parts = (self.numbers, self.memory, self.speeds, self.positions)
        self._arrays = [many.as_array(part) for part in parts]
        self._events = np.zeros(1, dtype=many.EVENT)
        self._rows = np.zeros(1, dtype=many.ROW)
        self._places = np.zeros(1, dtype=np.int64)
        self._memories = np.zeros(2, dtype=many.MEMORY)
        self._fields = operator.attrgetter(*dataclasses.asdict(self._event))

    def _step(self) -> Row | None:
        self._events[0] = self._fields(self._event)
        room = self._events, self._rows, self._places, self._memories
        _, _, told = self._entry(self.surface.array_tables, *self._arrays, *room, True)
        if not told:
            return None
        self.memory = self._many.from_array(self._many.Memory, self._memories[0])
        return self._many.from_array(self._many.Row, self._rows[0])


def since_start() -> float:
    """Return the time since the interpreter started [s]."""
    ticks = int(Path('/proc/self/stat').read_text().rpartition(')')[2].split()[19])
    return time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf('SC_CLK_TCK')


def monitors_of(way: str, count: int) -> list[Monitor]:
    """Return the monitors of so many axes."""
    names = [f'axis{number}' for number in range(count)]
    values = parameters.defaults(names)
    made = [build_axis(name, values).monitor for name in names]
    if way == 'interpreted':
        return made
    return [CompiledMonitor(one.surface, one.settings) for one in made]


def feed(monitors: list[Monitor], rate: float, first: int, count: int) -> int:
    """Feed samples number `first` to `first` + `count` at a rate [Hz]; return the states."""
    period, states = round(1e9 / rate), 0
    for number in range(first, first + count):
        stamp = BEGIN + number * period
        angle = 2e-9 * math.pi * (stamp - BEGIN) / 20.0
        speed, load = 150.0 * math.sin(angle), -1200.0 * math.copysign(1.0, math.sin(angle))
        for monitor in monitors:
            for source, value in ((Source.LOAD, load), (Source.SPEED, speed)):
                sample = InputSample(
                    source=source,
                    value=value,
                    stamp=stamp,
                    arrival=stamp,
                    stamp_source=StampSource.HEADER,
                )
                states += monitor.update(sample) is not None
            if stamp % TICK == 0:
                monitor.tick(stamp)
    return states


def main() -> None:
    """Measure one way."""
    way, axes, rate, seconds = sys.argv[1], int(sys.argv[2]), *map(float, sys.argv[3:5])
    monitors = monitors_of(way, axes)
    while not feed(monitors[:1], rate, 0, 1):
        pass
    start, begin = since_start(), time.process_time()
    states = feed(monitors, rate, 1, round(seconds * rate))
    share = (time.process_time() - begin) / seconds
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    call = min(timeit.repeat(lambda: None, number=100_000, repeat=7)) / 100_000
    print(
        f'{way:12} {axes:3} axes {rate:6.0f} Hz: first state {start:.2f} s, {memory:.0f} MB, '
        f'{100 * share:.1f} % of a core, {1e6 * share / axes / rate:.1f} us a sample, '
        f'{states} states; one Python call {1e6 * call:.3f} us'
    )


if __name__ == '__main__':
    main()
