# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The part of one recording that the health of an axis rests on, as plain data and back."""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.health.collect import Collected, Collector
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.records import CELL, Cell, LogSummary, Missing, SpectrumBin
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.stroke import motion_of, Positions, ReversalSums, StrokeSums
from ballscrew_monitor.health.summary import add, array_of, nothing
from ballscrew_monitor.report.machines import MachineAxis
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.surface import Surface

DATES = 'state date_from: name, header or modified in the map of the logs'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisHistory:
    """
    What one recording holds of one axis: the summary of the log and the spectrum of its loads.

    `log` is its name, `surface` the file that it was judged with. Advice may name another speed if
    `speed_allowed`.

    """

    summary: LogSummary
    surface: str
    limits: Limits
    bins: Sequence[SpectrumBin]
    log: str = ''
    always_free: bool = False
    speed_allowed: bool = False

    @property
    def key(self) -> MachineAxis:
        """Return the key of the history that it belongs to."""
        return MachineAxis(self.summary.machine, self.summary.axis)


class HistoryMaker:
    """Gathers the rows of one axis in order."""

    def __init__(
        self,
        surface: Surface,
        settings: GatherSettings | None = None,
        *,
        log: str = '',
        positions: Positions | None = None,
    ) -> None:
        """Begin with nothing of a `log`; `surface` is that of the judgement."""
        self._lead, self._collector = surface.lead, Collector(surface, settings)
        self._always_free = settings is not None and settings.always_free
        self._log, self._positions = log, positions
        self._stroke, self._reversals = StrokeSums(), ReversalSums()
        self._cells: dict[Any, Cell] = {}
        self._bins: list[SpectrumBin] = []
        self._first = self._last = 0
        self._missing = Missing.MOTION

    def add(self, rows: NDArray[Any]) -> None:
        """Take the next rows, an array of ROW."""
        self._first = self._first or int(rows['stamp'][0])
        self._last = int(rows['stamp'][-1])
        motion = motion_of(rows, self._lead)
        if len(motion.stamps) and self._missing != Missing.STEADY:
            torque = np.isfinite(motion.torque).any()
            self._missing = Missing.STEADY if torque else Missing.TORQUE
        if self._positions is not None:
            motor, table = self._positions.at(motion.stamps)
            self._stroke.add(motion.stamps, motor, motion.torque)
            self._reversals.add(motion.stamps, motion.speed, motor, table)
        self._take(self._collector.take_many(rows))

    def history(
        self, axis: str, surface: Path, settings: MonitorSettings, *, machine: str = ''
    ) -> AxisHistory:
        """Return what came of all rows."""
        self._take(self._collector.finish())
        cells = list(self._cells.values())
        if all(cell.kind != CellKind.MOTION for cell in cells):
            cells.append(nothing(self._first, self._missing))
        cells += self._stroke.cells(self._first) + self._reversals.cells(self._first)
        return AxisHistory(
            summary=LogSummary(machine, axis, self._first, self._last, array_of(cells)),
            surface=str(surface),
            limits=settings.limits,
            bins=tuple(merged_bins(self._bins)),
            log=self._log,
            always_free=self._always_free,
            speed_allowed=settings.speed_allowed,
        )

    def _take(self, found: Collected) -> None:
        for stretch in found.stretches:
            if add(self._cells, stretch, self._first):
                self._missing = Missing.CLOCK
        self._stroke.take(found.stretches)
        self._bins += found.bins


def plain_history(history: AxisHistory) -> dict[str, Any]:
    """Return a history as plain data: its cells by columns, all else by names."""
    summary = history.summary
    plain = {
        field.name: getattr(history, field.name)
        for field in dataclasses.fields(AxisHistory)
        if field.name not in ('summary', 'limits', 'bins')
    }
    return plain | {
        'machine': summary.machine,
        'axis': summary.axis,
        'start': summary.start,
        'end': summary.end,
        'limits': dataclasses.asdict(history.limits),
        'bins': [dataclasses.asdict(one) for one in history.bins],
        'cells': {name: summary.cells[name].tolist() for name in CELL.names or ()},
    }


def read_history(plain: Mapping[str, Any]) -> AxisHistory:
    """Return a history of plain data, as `plain_history` and JSON leave it, NaN as None."""
    kept = dict(plain)
    columns = kept.pop('cells')
    cells = np.zeros(len(columns['start']), dtype=CELL)
    for name in CELL.names or ():
        cells[name] = [np.nan if one is None else one for one in columns[name]]
    names = ('machine', 'axis', 'start', 'end')
    summary = LogSummary(**{name: kept.pop(name) for name in names}, cells=cells)
    bins = [
        SpectrumBin(
            axial_load=one.pop('axial_load', np.nan), wear_time=tuple(one.pop('wear_time')), **one
        )
        for one in map(_known, kept.pop('bins'))
    ]
    return AxisHistory(
        summary=summary, bins=bins, limits=Limits(**_known(kept.pop('limits'))), **kept
    )


def _known(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that are known; for the others the defaults stand."""
    return {key: value for key, value in record.items() if value is not None}


def by_axis(histories: Iterable[AxisHistory]) -> dict[MachineAxis, list[AxisHistory]]:
    """Return histories by machine and axis, those of one axis by their starts."""
    found: dict[MachineAxis, list[AxisHistory]] = {}
    for one in sorted(histories, key=lambda each: each.summary.start):
        found.setdefault(one.key, []).append(one)
    return found


def check_starts(histories: Sequence[AxisHistory], title: str) -> None:
    """Raise InputError for logs of one axis, by their starts, of which two begin at one time."""
    for one, other in zip(histories, histories[1:], strict=False):
        if one.summary.start == other.summary.start:
            count = sum(each.summary.start == one.summary.start for each in histories)
            raise InputError(
                f'axis {title}: {count} of {len(histories)} logs begin at the same instant, '
                f'{clock_text(one.summary.start)}, such as {one.log} and {other.log}, which is no '
                f'history: {DATES}, or name a log once'
            )
