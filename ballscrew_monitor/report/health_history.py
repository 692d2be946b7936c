# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The summaries of recordings, and the health of an axis by those of its history."""

from collections.abc import Mapping, Sequence
import dataclasses
import itertools
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
from ballscrew_monitor.health.records import Cell, Health, KeptHealth, Missing, SpectrumBin
from ballscrew_monitor.health.rows import has_torque_many, moves_many
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.stroke import motion_of, Positions, ReversalSums, StrokeSums
from ballscrew_monitor.health.summary import add, array_of, nothing
from ballscrew_monitor.report.machines import MachineAxis
from numpy.typing import NDArray
from surrogate.surface import Surface


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
        self._stroke, self._reversals = StrokeSums(), ReversalSums()
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
            stamps, speed, torque = motion_of(rows, self._lead)
            motor, table = self._positions.at(stamps)
            self._stroke.add(stamps, motor, torque)
            self._reversals.add(stamps, speed, motor, table)
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
        cells += self._stroke.cells(self._first) + self._reversals.cells(self._first)
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
        self._stroke.take(collected.stretches)
        self._bins += collected.bins


def assessed(
    title: str,
    kept: KeptHealth,
    surface: Surface,
    limits: Limits,
    *,
    speed_allowed: bool,
    baseline_days: float = BASELINE_DAYS,
    days: tuple[int, int] | None = None,
    prior: Prior = USUAL,
) -> list[Health]:
    """
    Return the health of an axis after each log of what is kept of it, as judged with `limits`.

    The baseline is that of `days`, begin and end [ns], or of the first `baseline_days`; the
    `prior` is that of its peers.

    """
    settings = HealthSettings(
        limits=limits, speed_allowed=speed_allowed, baseline_days=baseline_days, prior=prior
    )
    return course(title, since_days(kept, days, surface.screw_name), surface, settings)


def healths(
    histories: Sequence[AxisHistory],
    *,
    title: str = '',
    speed_allowed: bool = False,
    **options: Any,
) -> list[Health]:
    """
    Return the health of one axis after each of its recordings, in the order of their stamps.

    `title` names the axis in sentences if its own name does not tell it apart from others;
    `options` are those of `assessed`. Life and causes are those of the surface of the last
    recording. Its parameters let the advice name another speed, or `speed_allowed` does.
    Recordings that begin at one instant have no order and are no history.

    """
    ordered = sorted(histories, key=lambda history: history.first)
    last = ordered[-1]
    for log, other in itertools.pairwise(ordered):
        if log.first == other.first:
            return [without_order(title or last.axis, log.first)]
    kept = KeptHealth(
        [cell for log in ordered for cell in log.cells],
        merged_bins([load for log in ordered for load in log.bins]),
    )
    return assessed(
        title or last.axis,
        kept,
        Surface.load(Path(last.surface)),
        last.limits,
        speed_allowed=speed_allowed or last.speed_allowed,
        **options,
    )


def health_after(history: AxisHistory) -> Health:
    """Return the health of an axis by one recording alone."""
    return healths([history])[-1]


def by_axis(histories: Sequence[AxisHistory]) -> dict[MachineAxis, list[AxisHistory]]:
    """Return histories by machine and axis."""
    axes: dict[MachineAxis, list[AxisHistory]] = {}
    for history in sorted(histories, key=lambda log: log.first):
        axes.setdefault(history.key, []).append(history)
    return axes


def peers_among(histories: Sequence[AxisHistory], titles: Mapping[MachineAxis, str]) -> list[Peer]:
    """Return how axes with one surface rank over their latest logs."""
    peers: list[Peer] = []
    for file in dict.fromkeys(history.surface for history in histories):
        axes = by_axis([history for history in histories if history.surface == file])
        if len(axes) > FEWEST_PEERS:
            lead = Surface.load(Path(file)).lead
            cells = {
                titles[axis]: array_of(cell for log in kept for cell in log.cells)
                for axis, kept in axes.items()
            }
            peers += ranked(cells, lead)
    return peers
