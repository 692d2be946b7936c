# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The health of the axes of a node, by what its `state_dir` keeps of them."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ballscrew_monitor.health.assess import HealthSettings
from ballscrew_monitor.health.bands import MONTH
from ballscrew_monitor.health.baseline import in_force, motion_by_day, named_or_why
from ballscrew_monitor.health.companions import companions_beside
from ballscrew_monitor.health.keeper import assess_kept
from ballscrew_monitor.health.points import surface_id
from ballscrew_monitor.health.records import Health, KeptHealth
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.machines import MachineAxis
from ballscrew_monitor.settings.axis import load_surface, settings_of, surface_file
from surrogate.files import InputError

MOST_MONTHS = 24
"""Assessments of a course, one each four weeks, the last ones."""


def kept_healths(
    folder: Path,
    stored: Mapping[str, KeptHealth],
    titles: Mapping[MachineAxis, str],
    values: Mapping[str, Any],
    options: Mapping[str, Any],
) -> dict[MachineAxis, list[Health]]:
    """
    Return the health of each axis that is `stored` in a folder, each four weeks of its days.

    `titles` name the axes in sentences, `values` are the parameters of the node, `options` those
    of `health_history.healths`. Raises InputError for an axis without parameters.

    """
    found = {}
    for axis, kept in stored.items():
        if axis not in values['axes']:
            raise InputError(
                f'{folder} keeps axis {axis}, the parameters are of {", ".join(values["axes"])}: '
                'name those of the node with --params'
            )
        key = stored_axis(folder, axis)
        found[key] = list(_course(folder, axis, titles[key], kept, values, **options))
    return found


def stored_axis(folder: Path, axis: str) -> MachineAxis:
    """Return the key of an axis of the node that stores its health in a folder."""
    return MachineAxis(str(folder.resolve()), axis)


def _course(
    folder: Path,
    axis: str,
    title: str,
    kept: KeptHealth,
    values: Mapping[str, Any],
    *,
    over: float,
    days: tuple[int, int] | None,
    speed_allowed: bool,
) -> Iterator[Health]:
    """Yield the health of an axis after each four weeks, the last one with what cannot be read."""
    surface = load_surface(axis, values)
    companions = companions_beside(surface_file(axis, values), surface)
    if kept.points and surface_id(surface) not in {one.surface for one in kept.points}:
        say(
            f'{folder}: axis {axis} was gathered with another surface than {surface.screw_name}, '
            f'{surface.oil_name}: name the parameters of the node with --params'
        )
    judged = settings_of(axis, values, surface)
    settings = HealthSettings(
        limits=judged.limits,
        speed_allowed=speed_allowed or judged.speed_allowed,
        always_free=values[f'{axis}.health.always_free'],
    )
    periods = [(one.first_day, one.days) for one in kept.points]
    periods += [(one.first_day, one.days) for one in kept.spectrum]
    first, last = min(periods)[0], max(day + days - 1 for day, days in periods)
    screw, motion = surface.screw_name, motion_by_day(kept.spectrum)
    baseline = (
        in_force(kept, over=over, today=last + 1, screw=screw)
        if days is None
        else named_or_why(kept.points, days, motion=motion, screw=screw)
    )
    say(*kept.notes)
    for day in range(last, max(first, last - MOST_MONTHS * MONTH) - 1, -MONTH)[::-1]:
        now = (day + 1) * DAY - 1
        yield assess_kept(title, now, kept, baseline, surface, companions, settings)
