# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Year of an axis: programmes of passes, days on which they run, and its oil.

A day has four blocks of two hours. In a block each pass of the programmes of the day is run some
times; passes of one block and kind make one row.

"""

import dataclasses

import numpy as np
from numpy.typing import NDArray
from surrogate.units import RPM, ZERO_CELSIUS

Array = NDArray[np.float64]
DAYS = 365
BLOCKS, BLOCK_HOURS = 4, 2.0
WARMING, HEATING = 1.2, 1.5
"""Times in which the oil and the contact warm up [h]."""
GUIDE, DAMPING = 90.0, 25.0
"""Resistance of the guide: constant [N], and over the speed of the screw [N s/rad] by a factor."""
SEASON = 8.0
"""Swing of the room over a year [K]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Pass:
    """A pass at a speed of the screw [rad/s], signed, under a cut that opposes it [N]."""

    speed: float
    cut: float
    duration: float  # [s]

    @property
    def load(self) -> float:
        """Return the load in the machine frame [N]."""
        resistance = GUIDE + DAMPING * abs(self.speed) / 100.0 + self.cut
        return -float(np.sign(self.speed)) * resistance


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Programme:
    """Passes of one workpiece, and how much they heat the screw, 0 to 1 [-]."""

    passes: tuple[Pass, ...]
    heat: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Rows:
    """
    A row for each pass of each block: day, speed [rad/s, signed], load [N], mean oil [K], heat.

    `count` stretches of `duration` [s] each; `heat` is that of the contact over the oil, 0 to 1.

    """

    day: NDArray[np.int64]
    speed: Array
    load: Array
    oil: Array
    heat: Array
    count: NDArray[np.int64]
    duration: Array


def draw_programme(drawn: np.random.Generator, *, creeps: bool) -> Programme:
    """Return a programme: rapids, feeds under a cut with the way back idle, creeping."""
    passes = []

    def to_and_fro(rpm: float, duration: float, cut: float, back: float) -> None:
        passes.append(Pass(speed=rpm * RPM, cut=cut, duration=duration))
        passes.append(Pass(speed=-rpm * RPM, cut=back, duration=duration))

    rapid = drawn.uniform(1500.0, 2100.0)
    to_and_fro(rapid, 1.0, 0.0, 0.0)
    for _ in range(drawn.integers(2, 4)):
        to_and_fro(drawn.uniform(60.0, 300.0), 6.0, drawn.uniform(200.0, 1500.0), 0.0)
    to_and_fro(drawn.uniform(300.0, 1000.0), 3.0, drawn.uniform(0.0, 400.0), 0.0)
    if creeps:
        to_and_fro(drawn.uniform(10.0, 40.0), 6.0, 0.0, 0.0)
    return Programme(passes=tuple(passes), heat=float(drawn.uniform(0.3, 1.0)))


def draw_rows(drawn: np.random.Generator, *, creeps: bool = True) -> Rows:
    """Return the rows of a year with seasons, cold and warm starts, weekends, holidays."""
    old = [draw_programme(drawn, creeps=creeps) for _ in range(4)]
    new = [*old[:2], *(draw_programme(drawn, creeps=creeps) for _ in range(2))]
    changed = int(drawn.uniform(60, 330)) if drawn.random() < 0.5 else DAYS
    phase, rise = drawn.uniform(0.0, 2 * np.pi), drawn.uniform(5.0, 12.0)
    columns: dict[str, list[float]] = {field.name: [] for field in dataclasses.fields(Rows)}
    for day in _working_days(drawn):
        room = 22.0 + SEASON * np.sin(2 * np.pi * day / DAYS + phase) + drawn.normal(0.0, 1.0)
        since = 3.0 if drawn.random() < 0.3 else 0.0  # a shift ran before
        chosen = drawn.choice(4, size=drawn.integers(1, 4), replace=False)
        running = [(old if day < changed else new)[number] for number in chosen]
        heat = float(np.mean([programme.heat for programme in running]))
        for block in range(BLOCKS):
            hours = since + (block + 0.5) * BLOCK_HOURS
            oil = room + rise * heat * (1.0 - np.exp(-hours / WARMING)) + ZERO_CELSIUS
            warm = heat * (1.0 - np.exp(-hours / HEATING))
            for programme in running:
                for one in programme.passes:
                    _append(columns, drawn, day, one, oil, warm)
    return Rows(**{name: np.array(values) for name, values in columns.items()})


def _append(columns, drawn, day: int, one: Pass, oil: float, warm: float) -> None:
    repeats = int(drawn.poisson(6.0))
    if not repeats:
        return
    for name, value in (
        ('day', day),
        ('speed', one.speed),
        ('load', one.load),
        ('oil', oil + drawn.normal(0.0, 0.2)),
        ('heat', warm),
        ('count', repeats),
        ('duration', one.duration),
    ):
        columns[name].append(value)


def _working_days(drawn: np.random.Generator) -> list[int]:
    """Return the days with motion: no weekends, some days lost, some weeks missing."""
    missing = set(drawn.choice(np.arange(6, 50), size=drawn.integers(2, 7), replace=False))
    return [
        day
        for day in range(DAYS)
        if day % 7 < 5 and day // 7 not in missing and drawn.random() > 0.05
    ]
