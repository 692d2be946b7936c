# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Whether the speeds of a table make its positions, and in which unit they would."""

from ballscrew_monitor.core.conversions import SECOND, SPEED_UNITS
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.estimates import FACTOR, NEAR
from ballscrew_monitor.recordings.tables.mapping import AxisMap, TableMap
from ballscrew_monitor.recordings.tables.series import Block, speed_factor
import numpy as np

LONG = 3.0  # times the usual time between rows: across more the speed is not known
ALIKE = 0.9  # squared correlation from which a speed and its position are of one motion


class Agreement:
    """Sums over the rows of a table that compare speeds with positions, block by block."""

    def __init__(self, mapping: TableMap, usual_period: float) -> None:
        """Begin with no row; the usual time between rows [s] tells what a gap is."""
        self._fits = [
            _Fit(axis, number)
            for number, axis in enumerate(mapping.axes)
            if {'speed', 'position'} <= set(axis.columns)
        ]
        self._longest = LONG * usual_period

    def add(self, block: Block) -> None:
        """Take further rows."""
        steps = np.diff(block.stamps) / SECOND
        for fit in self._fits:
            fit.add(block, np.where(steps <= self._longest, steps, np.nan))

    def notes(self) -> list[str]:
        """Return a sentence for each axis whose speed and position disagree."""
        return [note for fit in self._fits if (note := fit.note())]


class _Fit:
    """How far an axis moves by its position, over how far by its speed, by least squares."""

    def __init__(self, axis: AxisMap, number: int) -> None:
        self._axis, self._number = axis, number
        self._across = self._by_speed = self._by_position = 0.0

    def add(self, block: Block, steps: Array) -> None:
        """Take rows that are `steps` apart [s], NaN for a gap."""
        axis = block.axes[self._number]
        assert axis.position is not None  # the map has a column of it
        expected = (axis.speed[1:] + axis.speed[:-1]) / 2 * steps
        moved = np.diff(axis.position)
        good = np.isfinite(expected) & np.isfinite(moved)
        self._across += float(moved[good] @ expected[good])
        self._by_speed += float(expected[good] @ expected[good])
        self._by_position += float(moved[good] @ moved[good])

    def note(self) -> str:
        """Return a sentence if both are of one motion but differ in size or sign, else nothing."""
        both = self._by_speed * self._by_position
        if not both or self._across**2 < ALIKE * both:
            return ''
        factor = self._across / self._by_speed
        if 1.0 / FACTOR < factor < FACTOR:
            return ''
        return (
            f'axis {self._axis.name}: its position moves {factor:.4g} times as far as its speed '
            f'in {self._axis.columns["speed"].unit} says: {self._advice(factor)}'
        )

    def _advice(self, factor: float) -> str:
        if factor < 0.0:
            return 'one of both has the wrong sign of its scale'
        needed = factor * speed_factor(self._axis.columns['speed'].unit, self._axis.lead)
        misses = {
            unit: abs(speed_factor(unit, self._axis.lead) / needed - 1.0) for unit in SPEED_UNITS
        }
        best = min(misses, key=misses.__getitem__)
        if misses[best] <= NEAR:
            return f'{best} fits, if unit and scale of the position are right'
        return 'check units and scales of both, the time and the lead'
