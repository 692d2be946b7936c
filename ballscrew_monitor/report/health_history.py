# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The part of recordings that the health of an axis rests on, and its health after each."""

from collections.abc import Iterator, Mapping, Sequence
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.health.assess import assess, HealthSettings, recent_of
from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.baseline import learned, LEAST_MOTION, named_or_why
from ballscrew_monitor.health.companions import companions_beside
from ballscrew_monitor.health.peers import FEWEST_PEERS, Peer, ranked
from ballscrew_monitor.health.points import by_place, merged
from ballscrew_monitor.health.records import ComparablePoint, Health, SpectrumBin
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.report.health_logs import AxisHistory, by_axis
from ballscrew_monitor.report.machines import MachineAxis
from surrogate.surface import Surface

NAN = math.nan


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
    ordered = sorted(histories, key=lambda one: one.summary.end)
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
