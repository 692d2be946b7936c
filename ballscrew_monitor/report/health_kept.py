# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The health of the axes of a node, by what its `state_dir` keeps of them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ballscrew_monitor.health.assess import course, HealthSettings
from ballscrew_monitor.health.baseline import since_days
from ballscrew_monitor.health.records import Health, KeptHealth
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.machines import MachineAxis
from ballscrew_monitor.settings.axis import load_surface, settings_of
from surrogate.files import InputError


def kept_healths(
    folder: Path,
    stored: Mapping[str, KeptHealth],
    titles: Mapping[MachineAxis, str],
    values: Mapping[str, Any],
    options: Mapping[str, Any],
) -> dict[MachineAxis, list[Health]]:
    """
    Return the health of each axis that is `stored` in a folder, after each of its days.

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
        found[key] = _course(axis, titles[key], kept, values, **options)
    return found


def stored_axis(folder: Path, axis: str) -> MachineAxis:
    """Return the key of an axis of the node that stores its health in a folder."""
    return MachineAxis(str(folder.resolve()), axis)


def _course(
    axis: str,
    title: str,
    kept: KeptHealth,
    values: Mapping[str, Any],
    *,
    baseline_days: float,
    days: tuple[int, int] | None,
    speed_allowed: bool,
) -> list[Health]:
    """Return the health of an axis after each day, and print notes on rows that are damaged."""
    surface = load_surface(axis, values)
    judged = settings_of(axis, values, surface)
    settings = HealthSettings(
        limits=judged.limits,
        speed_allowed=speed_allowed or judged.speed_allowed,
        baseline_days=baseline_days,
    )
    say(*kept.notes)
    return course(title, since_days(kept, days, surface.screw_name), surface, settings)
