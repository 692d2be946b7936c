# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Axes to their health after each log, one task an axis, on processes here or a Dask cluster."""

from collections.abc import Mapping, Sequence
import dataclasses
import itertools
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.health.mixed import Prior, USUAL
from ballscrew_monitor.health.peers import FEWEST_PEERS, priors, Spread, spread_of
from ballscrew_monitor.health.records import Health, KeptHealth
from ballscrew_monitor.health.summary import array_of
from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.health_collect import FEW
from ballscrew_monitor.report.health_folder import axis_folders, read_axis
from ballscrew_monitor.report.health_history import assessed, AxisHistory, by_axis, healths
from ballscrew_monitor.report.machines import MachineAxis
from ballscrew_monitor.report.many_logs import run_mapped, Workers
from ballscrew_monitor.settings.axis import load_surface, settings_of
from surrogate.files import InputError, to_json
from surrogate.surface import Surface
from surrogate.tasks.pool import TaskOutcome
from surrogate.tasks.progress import Progress

Inputs = dict[str, Any]


def joined_axes(axes: Mapping[MachineAxis, Inputs], folder: Path) -> dict[MachineAxis, Inputs]:
    """
    Return all axes with those of a folder of collected logs, and where a task finds each.

    Raises InputError for an axis of the folder that is named elsewhere, too.

    """
    collected = {
        MachineAxis(*key): {'folder': str(path.resolve())}
        for key, path in axis_folders(folder).items()
    }
    for key in collected.keys() & axes.keys():
        raise InputError(
            f'axis {key.axis} of {key.machine} stands in {folder} and in other logs that are '
            'named: collect these, too'
        )
    return {**axes, **collected}


def logged_axes(histories: Sequence[AxisHistory]) -> dict[MachineAxis, Inputs]:
    """Return for each axis the logs that its task is given."""
    return {
        key: {'histories': [to_json(dataclasses.asdict(history)) for history in own]}
        for key, own in by_axis(histories).items()
    }


def assess_axes(
    axes: Mapping[MachineAxis, Inputs],
    titles: Mapping[MachineAxis, str],
    options: Mapping[str, Any],
    workers: Workers,
) -> dict[MachineAxis, list[Health]]:
    """
    Return the health of each axis after each of its logs, those that can be assessed.

    An axis that cannot be assessed is named and stops no other one. `titles` name the axes in
    sentences, `options` are those of `health_history.healths`. Raises InputError for the only
    axis, SurfaceError if a scheduler is lost.

    """
    names = {titles[key]: key for key in axes}
    known = _priors({title: axes[key] for title, key in names.items()}, workers)
    inputs = {
        title: {**axes[key], 'title': title, 'options': {**options, **known.get(title, {})}}
        for title, key in names.items()
    }
    courses: dict[MachineAxis, list[Health]] = {}
    bar = Progress(len(inputs), 'axes')

    def report(outcome: TaskOutcome) -> None:
        bar.step()
        if outcome.result is None:
            if len(inputs) == 1:
                raise InputError(outcome.sentence)
            say(outcome.sentence)
            return
        say(*outcome.result['notes'])
        courses[names[outcome.name]] = [
            record_of(Health, health) for health in outcome.result['course']
        ]

    try:
        run_mapped(assess_task, inputs, workers, report, few=FEW)
    finally:
        bar.close()
    return {key: courses[key] for key in axes if courses.get(key)}


def _priors(axes: Mapping[str, Inputs], workers: Workers) -> dict[str, dict[str, Any]]:
    """Return as an option the prior of each axis that has peers, axes of one screw by name."""
    if len(axes) <= FEWEST_PEERS:
        return {}
    screws: dict[str, dict[str, Spread]] = {}

    def report(outcome: TaskOutcome) -> None:
        if outcome.result is not None:
            plain = outcome.result['spread']
            doubt = math.inf if plain['doubt'] is None else plain['doubt']
            own = Prior(plain['slope'], doubt, tuple(plain['pairs']))
            axes_of_screw = screws.setdefault(outcome.result['surface'], {})
            axes_of_screw[outcome.name] = own, frozenset(map(tuple, plain['groups']))

    run_mapped(spread_task, axes, workers, report, few=FEW)
    return {
        axis: {'prior': prior._asdict()}
        for spreads in screws.values()
        for axis, prior in priors(spreads).items()
        if prior != USUAL
    }


def spread_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return as plain data what the logs of one axis say of its peers: a task of a worker."""
    histories, _ = histories_of(inputs)
    if not histories:
        raise InputError('no log can be read')
    surface = max(histories, key=lambda log: log.first).surface
    cells = array_of(cell for log in histories for cell in log.cells)
    spread = spread_of(cells, Surface.load(Path(surface)).lead)
    if spread is None:
        raise InputError('its logs are too few')
    own, groups = spread
    plain = to_json({**own._asdict(), 'groups': sorted(map(tuple, groups))})
    return {'surface': surface, 'spread': plain}


def histories_of(inputs: Mapping[str, Any]) -> tuple[list[AxisHistory], list[str]]:
    """Return the logs of the axis of a task, and notes on those that cannot be read."""
    if 'folder' in inputs:
        return read_axis(Path(inputs['folder']))
    return [record_of(AxisHistory, history) for history in inputs['histories']], []


def assess_task(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Return as plain data the health of one axis after each of its logs: a task of a worker."""
    title, (histories, notes) = inputs['title'], histories_of(inputs)
    if not histories:
        raise InputError(f'axis {title}: none of its collected logs can be read: {notes[0]}')
    notes += filter(None, [same_start_note(histories, title)])
    options = dict(inputs['options'])
    if options.get('days') is not None:
        options['days'] = tuple(options['days'])
    if prior := options.pop('prior', None):
        options['prior'] = record_of(Prior, prior)
    course = healths(histories, title=title, **options)
    return {'course': [to_json(dataclasses.asdict(health)) for health in course], 'notes': notes}


def same_start_note(histories: Sequence[AxisHistory], title: str) -> str:
    """Return in a sentence how to date logs of one axis that begin at the same instant, or ''."""
    ordered = sorted(histories, key=lambda history: history.first)
    for log, other in itertools.pairwise(ordered):
        if log.first == other.first:
            count = sum(history.first == log.first for history in ordered)
            return (
                f'axis {title}: {count} of {len(ordered)} logs begin at the same instant, '
                f'{clock_text(log.first)}, such as {log.log} and {other.log}, which is no '
                'history: state date_from: name, header or modified in the map of the logs, or '
                'name a log once'
            )
    return ''


def kept_healths(
    folder: Path,
    stored: Mapping[str, KeptHealth],
    titles: Mapping[MachineAxis, str],
    values: Mapping[str, Any],
    options: Mapping[str, Any],
) -> dict[MachineAxis, list[Health]]:
    """
    Return the health of each axis that a node has `stored` in a folder, after each of its days.

    `titles` name the axes in sentences, `values` are the parameters of the node, `options` those
    of `health_history.healths`. Notes on rows that are damaged are said. Raises InputError for an
    axis without parameters.

    """
    courses = {}
    for axis, kept in stored.items():
        if axis not in values['axes']:
            raise InputError(
                f'{folder} keeps axis {axis}, the parameters are of {", ".join(values["axes"])}: '
                'name those of the node with --params'
            )
        key, surface = stored_axis(folder, axis), load_surface(axis, values)
        judged = settings_of(axis, values, surface)
        say(*kept.notes)
        speed_allowed = options['speed_allowed'] or judged.speed_allowed
        courses[key] = assessed(
            titles[key],
            kept,
            surface,
            judged.limits,
            **{**options, 'speed_allowed': speed_allowed},
        )
    return courses


def stored_axis(folder: Path, axis: str) -> MachineAxis:
    """Return the key of an axis of the node that stores its health in a folder."""
    return MachineAxis(str(folder.resolve()), axis)
