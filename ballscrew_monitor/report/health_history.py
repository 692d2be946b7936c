# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The part of recordings that the health of an axis rests on, and its health after each."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.health.assess import assess, HealthSettings, recent_of
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import learned, LEAST_MOTION, named_or_why
from ballscrew_monitor.health.collect import Collected, Collector
from ballscrew_monitor.health.companions import companions_beside
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.peers import FEWEST_PEERS, Peer, ranked
from ballscrew_monitor.health.points import add, by_place, merged
from ballscrew_monitor.health.records import (
    ComparablePoint,
    Health,
    LoadSource,
    Place,
    SpectrumBin,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.report.machines import MachineAxis
from numpy.typing import NDArray
from surrogate.surface import Surface

NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisHistory:
    """
    What one recording holds of one axis: comparable points and the spectrum of its loads.

    `surface` is the file it was judged with; `last` [ns] is the stamp of its last row; `machine`
    is the one that the axis is of. Advice may name another speed if `speed_allowed`.

    """

    axis: str
    surface: str
    limits: Limits
    last: int
    points: Sequence[ComparablePoint]
    bins: Sequence[SpectrumBin]
    always_free: bool = False
    speed_allowed: bool = False
    machine: str = ''


class HistoryMaker:
    """Gathers the rows of one axis in order."""

    def __init__(self, surface: Surface, settings: GatherSettings | None = None) -> None:
        """Begin with nothing; `surface` is that of the judgement."""
        self._surface, self._collector = surface, Collector(surface, settings)
        self._always_free = settings is not None and settings.always_free
        self._points: dict[Any, ComparablePoint] = {}
        self._bins: list[SpectrumBin] = []
        self._last = 0

    def add(self, rows: NDArray[Any]) -> None:
        """Take the next rows, an array of ROW."""
        self._last = int(rows['stamp'][-1])
        self._take(self._collector.take_many(rows))

    def history(
        self, axis: str, surface: Path, settings: MonitorSettings, *, machine: str = ''
    ) -> AxisHistory:
        """Return what came of all rows."""
        self._take(self._collector.finish())
        return AxisHistory(
            axis=axis,
            surface=str(surface),
            limits=settings.limits,
            last=self._last,
            points=tuple(self._points.values()),
            bins=tuple(merged_bins(self._bins)),
            always_free=self._always_free,
            speed_allowed=settings.speed_allowed,
            machine=machine,
        )

    def _take(self, found: Collected) -> None:
        for stretch in found.stretches:
            add(self._points, stretch, self._surface)
        self._bins += found.bins


def read_history(record: Mapping[str, Any]) -> AxisHistory:
    """Return a history of plain data, as `dataclasses.asdict` and JSON leave it."""
    kept = dict(record)
    points = [
        ComparablePoint(
            place=Place(*one.pop('place')), load_source=LoadSource(one.pop('load_source')), **one
        )
        for one in map(_known, kept.pop('points'))
    ]
    bins = [
        SpectrumBin(
            wear_time=tuple(one.pop('wear_time')), axial_load=one.pop('axial_load', NAN), **one
        )
        for one in map(_known, kept.pop('bins'))
    ]
    return AxisHistory(points=points, bins=bins, limits=Limits(**kept.pop('limits')), **kept)


def _known(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fields that are known; for the others the defaults stand."""
    return {key: value for key, value in record.items() if value is not None}


def healths(
    histories: Sequence[AxisHistory],
    *,
    over: float = LEAST_MOTION,
    days: tuple[int, int] | None = None,
    speed_allowed: bool = False,
    title: str = '',
) -> Iterator[Health]:
    """
    Yield the health of one axis after each of its recordings, in the order of their stamps.

    `title` names the axis in sentences if its own name does not tell it apart from others.
    The baseline is that of `days`, begin and end [ns], or learned over the first `over` [s] in
    motion. All are held against the surface of the last recording. Its parameters let the advice
    name another speed, or `speed_allowed` does.

    """
    ordered = sorted(histories, key=lambda one: one.last)
    file = Path(ordered[-1].surface)
    surface = Surface.load(file)
    companions = companions_beside(file, surface)
    settings = HealthSettings(
        limits=ordered[-1].limits,
        speed_allowed=speed_allowed or ordered[-1].speed_allowed,
        always_free=ordered[-1].always_free,
    )
    points: dict[Any, ComparablePoint] = {}
    bins: list[SpectrumBin] = []
    for one in ordered:
        for key, point in by_place(one.points).items():
            points[key] = merged(points[key], point) if key in points else point
        bins = merged_bins([*bins, *one.bins])
        kept = list(points.values())
        screw, today = surface.screw_name, day_of(one.last) + 1
        baseline = (
            learned(kept, over=over, screw=screw, today=today)
            if days is None
            else named_or_why(kept, days, screw=screw)
        )
        now = (day_of(one.last) + 1) * DAY - 1
        name = title or one.axis
        yield assess(name, now, baseline, kept, bins, surface, companions, settings)


def health_after(history: AxisHistory) -> Health:
    """Return the health of an axis by one recording alone."""
    return next(healths([history]))


def by_axis(histories: Sequence[AxisHistory]) -> dict[MachineAxis, list[AxisHistory]]:
    """Return histories by machine and axis."""
    found: dict[MachineAxis, list[AxisHistory]] = {}
    for one in histories:
        found.setdefault(MachineAxis(one.machine, one.axis), []).append(one)
    return found


def peers_among(histories: Sequence[AxisHistory], titles: Mapping[MachineAxis, str]) -> list[Peer]:
    """Return how axes with one surface rank over the latest weeks of all of them."""
    found: list[Peer] = []
    for file in dict.fromkeys(one.surface for one in histories):
        own = [one for one in histories if one.surface == file]
        if len(axes := by_axis(own)) > FEWEST_PEERS:
            today = day_of(max(one.last for one in own)) + 1
            points = {
                titles[axis]: recent_of([point for one in kept for point in one.points], today)
                for axis, kept in axes.items()
            }
            found += ranked(points, Surface.load(Path(file)))
    return found
