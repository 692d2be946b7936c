# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The summaries of recordings, and the health of an axis by those of its history."""

from collections.abc import Mapping, Sequence
import dataclasses
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.health.assess import course, HealthSettings, without_order
from ballscrew_monitor.health.bands import day_of, FIRST_DAY
from ballscrew_monitor.health.baseline import since_days
from ballscrew_monitor.health.collect import Collected, Collector
from ballscrew_monitor.health.detection import BASELINE_DAYS
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.mixed import Prior, USUAL
from ballscrew_monitor.health.peers import FEWEST_PEERS, Peer, ranked
from ballscrew_monitor.health.records import (
    Cell,
    Health,
    KeptHealth,
    Missing,
    SpectrumBin,
    Stretch,
)
from ballscrew_monitor.health.rows import has_torque_many, moves_many
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.stroke import Positions, reversal_cells, stroke_cells
from ballscrew_monitor.health.summary import add, array_of, nothing
from ballscrew_monitor.report.machines import MachineAxis
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface
from surrogate.units import TURN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisHistory:
    """
    What one recording holds of one axis: the cells of its summary and the spectrum of its loads.

    `surface` is the file it was judged with; `first` and `last` [ns] are the stamps of its rows;
    `machine` is the one that the axis is of, `log` names the recording. Advice may name another
    speed if `speed_allowed`.

    """

    axis: str
    surface: str
    limits: Limits
    first: int
    last: int
    cells: Sequence[Cell]
    bins: Sequence[SpectrumBin]
    speed_allowed: bool = False
    machine: str = ''
    log: str = ''

    @property
    def key(self) -> MachineAxis:
        """Return the key of the history that it belongs to."""
        return MachineAxis(self.machine, self.axis)


MOTION = np.dtype([('stamp', np.int64), ('speed', float), ('torque', float)])
"""Samples of motion: stamp [ns], speed of the table [m/s], torque [N m], NaN where unknown."""


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
        self._collector, self._lead = Collector(surface, settings), surface.lead
        self._log, self._positions = log, positions
        self._motion: list[NDArray[Any]] = []  # stamps, speeds and torques along the stroke
        self._stretches: list[Stretch] = []
        self._cells: dict[Any, Cell] = {}
        self._bins: list[SpectrumBin] = []
        self._first = self._last = 0
        self._moved = self._measured = False

    def add(self, rows: NDArray[Any]) -> None:
        """Take the next rows, an array of ROW."""
        self._first = self._first or int(rows['stamp'][0])
        self._last = int(rows['stamp'][-1])
        moving = moves_many(rows)
        self._moved |= bool(moving.any())
        self._measured |= bool((moving & has_torque_many(rows)).any())
        if self._positions is not None:
            motion = rows[moving & np.isfinite(rows['speed'])]
            part = np.zeros(len(motion), MOTION)
            part['stamp'], part['speed'] = motion['stamp'], motion['speed'] * self._lead / TURN
            part['torque'] = np.where(has_torque_many(motion), motion['motor_torque'], np.nan)
            self._motion.append(part)
        self._take(self._collector.take_many(rows))

    def history(
        self,
        axis: str,
        surface: Path,
        settings: MonitorSettings,
        *,
        machine: str = '',
        torque_is_load: bool = False,
    ) -> AxisHistory:
        """Return what came of all rows; `torque_is_load`: the map takes the torque for a load."""
        self._take(self._collector.finish())
        cells, bins = list(self._cells.values()), merged_bins(self._bins)
        if all(cell.direction == 0 for cell in cells):
            cells.append(nothing(self._first, self._missing(torque_is_load=torque_is_load)))
        if self._positions is not None and self._motion:
            motion = np.concatenate(self._motion)
            stamps, speed, torque = motion['stamp'], motion['speed'], motion['torque']
            motor, table = self._positions.at(stamps)
            cells += stroke_cells(stamps, motor, torque, self._stretches, self._first)
            cells += reversal_cells(stamps, speed, motor, table, self._first)
        if day_of(self._first) < FIRST_DAY:
            cells, bins = [nothing(self._first, Missing.CLOCK)], []
        return AxisHistory(
            axis=axis,
            surface=str(surface),
            limits=settings.limits,
            first=self._first,
            last=self._last,
            cells=tuple(cells),
            bins=tuple(bins),
            speed_allowed=settings.speed_allowed,
            machine=machine,
            log=self._log,
        )

    def _missing(self, *, torque_is_load: bool) -> Missing:
        if not self._moved:
            return Missing.MOTION
        if self._measured:
            return Missing.STEADY
        return Missing.LOAD if torque_is_load else Missing.TORQUE

    def _take(self, collected: Collected) -> None:
        for stretch in collected.stretches:
            add(self._cells, stretch, self._first)
        if self._positions is not None:
            self._stretches += collected.stretches
        self._bins += collected.bins


def read_history(record: Mapping[str, Any]) -> AxisHistory:
    """Return a history of plain data, as `dataclasses.asdict` and JSON leave it."""
    kept = dict(record)
    cells = [Cell(**one) for one in map(known_of, kept.pop('cells'))]
    bins = [
        SpectrumBin(
            wear_time=tuple(one.pop('wear_time')),
            axial_load=one.pop('axial_load', float('nan')),
            **one,
        )
        for one in map(known_of, kept.pop('bins'))
    ]
    return AxisHistory(cells=cells, bins=bins, limits=Limits(**kept.pop('limits')), **kept)


def known_of(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that are known; for the others the defaults stand."""
    return {key: value for key, value in record.items() if value is not None}


def healths(
    histories: Sequence[AxisHistory],
    *,
    baseline_days: float = BASELINE_DAYS,
    days: tuple[int, int] | None = None,
    speed_allowed: bool = False,
    title: str = '',
    prior: Prior = USUAL,
) -> list[Health]:
    """
    Return the health of one axis after each of its recordings, in the order of their stamps.

    `title` names the axis in sentences if its own name does not tell it apart from others; the
    `prior` is that of its peers.
    The baseline is that of `days`, begin and end [ns], or of the first `baseline_days`. Life and
    causes are those of the surface of the last recording. Its parameters let the advice name
    another speed, or `speed_allowed` does. Recordings that begin at one instant have no order and
    are no history.

    """
    ordered = sorted(histories, key=lambda one: one.first)
    last = ordered[-1]
    if same := _same_start(ordered):
        return [without_order(title or last.axis, same)]
    surface = Surface.load(Path(last.surface))
    settings = HealthSettings(
        limits=last.limits,
        speed_allowed=speed_allowed or last.speed_allowed,
        baseline_days=baseline_days,
        prior=prior,
    )
    kept = KeptHealth(
        [cell for log in ordered for cell in log.cells],
        merged_bins([each for log in ordered for each in log.bins]),
    )
    kept = since_days(kept, days, surface.screw_name)
    return course(title or last.axis, kept, surface, settings)


def _same_start(ordered: Sequence[AxisHistory]) -> int:
    """Return the first instant [ns] at which two recordings begin, 0 for none."""
    pairs = zip(ordered[:-1], ordered[1:], strict=True)
    return next((log.first for log, other in pairs if log.first == other.first), 0)


def health_after(history: AxisHistory) -> Health:
    """Return the health of an axis by one recording alone."""
    return healths([history])[-1]


def by_axis(histories: Sequence[AxisHistory]) -> dict[MachineAxis, list[AxisHistory]]:
    """Return histories by machine and axis."""
    axes: dict[MachineAxis, list[AxisHistory]] = {}
    for one in sorted(histories, key=lambda each: each.first):
        axes.setdefault(one.key, []).append(one)
    return axes


def peers_among(histories: Sequence[AxisHistory], titles: Mapping[MachineAxis, str]) -> list[Peer]:
    """Return how axes with one surface rank over their latest logs."""
    peers: list[Peer] = []
    for file in dict.fromkeys(one.surface for one in histories):
        axes = by_axis([one for one in histories if one.surface == file])
        if len(axes) > FEWEST_PEERS:
            lead = Surface.load(Path(file)).lead
            cells = {
                titles[axis]: array_of(cell for log in kept for cell in log.cells)
                for axis, kept in axes.items()
            }
            peers += ranked(cells, lead)
    return peers
