# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Axes to their health after each log, one task an axis, on processes here or a Dask cluster."""

from collections.abc import Mapping, Sequence
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.health.mixed import Prior, USUAL
from ballscrew_monitor.health.peers import FEWEST_PEERS, priors, Spread, spread_of
from ballscrew_monitor.health.records import (
    Baseline,
    Cause,
    CauseCode,
    Condition,
    Health,
    Quantity,
)
from ballscrew_monitor.recordings.words import say
from ballscrew_monitor.report.health_collect import run_mapped, Workers
from ballscrew_monitor.report.health_folder import axis_folders, read_axis
from ballscrew_monitor.report.health_history import (
    AxisHistory,
    by_axis,
    healths,
    known_of,
    read_history,
)
from ballscrew_monitor.report.machines import MachineAxis
import numpy as np
from surrogate.files import InputError, to_json
from surrogate.progress import Progress
from surrogate.surface import Surface
from surrogate.tasks.pool import TaskOutcome

Inputs = dict[str, Any]


def collected_axes(folder: Path) -> dict[MachineAxis, Inputs]:
    """Return for each axis of a folder of collected logs where its task finds them."""
    return {
        MachineAxis(*key): {'folder': str(path.resolve())}
        for key, path in axis_folders(folder).items()
    }


def joined_axes(
    axes: Mapping[MachineAxis, Inputs], others: Mapping[MachineAxis, Inputs], folder: Path
) -> dict[MachineAxis, Inputs]:
    """Return all axes; raises InputError for one of a `folder` that is named elsewhere, too."""
    for key in others.keys() & axes.keys():
        raise InputError(
            f'axis {key.axis} of {key.machine} stands in {folder} and in other logs that are '
            'named: collect these, too'
        )
    return {**axes, **others}


def logged_axes(histories: Sequence[AxisHistory]) -> dict[MachineAxis, Inputs]:
    """Return for each axis the logs that its task is given."""
    return {
        key: {'histories': [to_json(dataclasses.asdict(one)) for one in own]}
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
        courses[names[outcome.name]] = [read_health(one) for one in outcome.result['course']]

    try:
        run_mapped(assess_task, inputs, workers, report)
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
            groups = frozenset(tuple(group) for group in plain.pop('groups'))
            spread = Spread(groups=groups, **{'deviation': math.inf} | known_of(plain))
            screws.setdefault(outcome.result['surface'], {})[outcome.name] = spread

    run_mapped(spread_task, axes, workers, report)
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
    cells = np.concatenate([log.summary.cells for log in histories])
    spread = spread_of(cells, Surface.load(Path(surface)).lead)
    if spread is None:
        raise InputError('its logs are too few')
    plain = to_json({**spread._asdict(), 'groups': sorted(map(tuple, spread.groups))})
    return {'surface': surface, 'spread': plain}


def histories_of(inputs: Mapping[str, Any]) -> tuple[list[AxisHistory], list[str]]:
    """Return the logs of the axis of a task, and notes on those that cannot be read."""
    if 'folder' in inputs:
        return read_axis(Path(inputs['folder']))
    return [read_history(plain) for plain in inputs['histories']], []


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
        options['prior'] = Prior(**{**prior, 'pairs': tuple(prior['pairs'])})
    course = [
        to_json(dataclasses.asdict(one)) for one in healths(histories, title=title, **options)
    ]
    return {'course': course, 'notes': notes}


def same_start_note(histories: Sequence[AxisHistory], title: str) -> str:
    """Return in a sentence how to date logs of one axis that begin at the same instant, or ''."""
    ordered = sorted(histories, key=lambda each: each.first)
    for log, other in zip(ordered[:-1], ordered[1:], strict=True):
        if log.first == other.first:
            count = sum(each.first == log.first for each in ordered)
            return (
                f'axis {title}: {count} of {len(ordered)} logs begin at the same instant, '
                f'{clock_text(log.first)}, such as {log.log} and {other.log}, which is no '
                'history: state date_from: name, header or modified in the map of the logs, or '
                'name a log once'
            )
    return ''


def read_health(plain: Mapping[str, Any]) -> Health:
    """Return the health that `dataclasses.asdict` and JSON have made plain, NaN as None."""
    kept = dict(plain)
    quantities = [_quantity(one) for one in kept.pop('quantities')]
    causes = [
        Cause(code=CauseCode(one.pop('code')), size=_quantity(one.pop('size')), **one)
        for one in map(dict, kept.pop('causes'))
    ]
    baseline = kept.pop('baseline')
    return Health(
        condition=Condition(kept.pop('condition')),
        quantities=quantities,
        causes=causes,
        baseline=None if baseline is None else Baseline(**baseline),
        **kept,
    )


def _quantity(plain: Mapping[str, Any]) -> Quantity:
    """Return a quantity; what is not known is NaN by default."""
    return Quantity(**known_of(plain))
