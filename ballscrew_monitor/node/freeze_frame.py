# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Freeze frame of an axis: the last seconds before an event, thinned out, for the event log."""

from collections import deque
import math
import operator
from typing import Any

from ballscrew_monitor.core.conversions import celsius, nanoseconds, seconds
from ballscrew_monitor.judge.records import Row
from numpy.typing import NDArray
from surrogate.surface.records import from_array

SPAN, STEP = nanoseconds(10.0), nanoseconds(0.1)
"""What is kept before an event, and the time between two of its samples [ns]."""
QUANTITIES = {
    'speed_rad_s': 'speed',
    'axial_load_N': 'axial_load',
    'temperature_degC': 'temperature',
    'efficiency': 'efficiency',
    'rcs': 'rcs',
    'motor_torque_Nm': 'motor_torque',
}
"""Quantities of a row of the judgement by their names with units, as an entry says them."""


class FreezeFrame:
    """Rows of the last SPAN, one a STEP, and each that begins or ends an event."""

    def __init__(self) -> None:
        self._rows: deque[tuple[Any, ...]] = deque(maxlen=SPAN // STEP + 1)
        self._read = operator.attrgetter('stamp', *QUANTITIES.values())

    def take(self, row: Any) -> None:
        """Take a row of the judgement, if there is one; a clock that is set back begins again."""
        if row is not None and not row.tick and self._wants(row.stamp, row.edge):
            self._keep(row)

    def take_many(self, rows: NDArray[Any]) -> None:
        """Take rows, an array of them, as one after the other."""
        columns = (rows[name].tolist() for name in ('stamp', 'edge', 'tick'))
        for at, (stamp, edge, tick) in enumerate(zip(*columns)):
            if not tick and self._wants(stamp, edge):
                self._keep(from_array(Row, rows[at]))

    def _wants(self, stamp: int, edge: int) -> bool:
        past = stamp - self._rows[-1][0] if self._rows else STEP
        if past < 0:
            self._rows.clear()
        return not 0 <= past < STEP or bool(edge)

    def _keep(self, row: Any) -> None:
        stamp, speed, load, temperature, *others = self._read(row)
        quantities = speed, load, celsius(temperature), *others
        self._rows.append((stamp, *map(_short, quantities)))

    def facts(self, stamp: int) -> dict[str, list[float]]:
        """
        Return the quantities of the SPAN before a stamp [ns] as arrays, NaN where not known.

        `time_s` is that before the stamp; numbers have six digits.

        """
        rows = [row for row in self._rows if 0 <= stamp - row[0] <= SPAN]
        columns = {'time_s': [round(seconds(row[0] - stamp), 3) for row in rows]}
        for at, name in enumerate(QUANTITIES, start=1):
            columns[name] = [row[at] for row in rows]
        return columns


def _short(number: float) -> float:
    """Return a number to six digits."""
    return float(f'{number:.6g}') if math.isfinite(number) else math.nan
