# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page of a check: what was read, identified, built, said, and what to do and record next."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
from pathlib import Path
from typing import Any
from urllib.parse import quote

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.tables.guess import Guess
from ballscrew_monitor.recordings.words import listed, NONE
from ballscrew_monitor.report.free_run import FreeRun, RECORD
from ballscrew_monitor.report.health_history import by_axis, healths
from ballscrew_monitor.report.health_part import verdict_box
from ballscrew_monitor.report.log_report import LogResult
from ballscrew_monitor.report.page import element, Markup, table, TableCell, TableRow
from surrogate.surface import onset_of_surface, shipped_surface, Surface

NEEDED = {
    'Axial load': 'the axial load, or the motor torque that it can be derived from',
    'Oil temperature': 'the oil temperature at the nut',
    'Motor torque': 'the motor torque, from which friction and preload are told',
}
"""Inputs that are worth recording, with their words."""


@dataclasses.dataclass(kw_only=True, slots=True)
class CheckedLog:
    """
    A recording with its map or parameters below `out`, and what became of it.

    `failure` says why it cannot be judged, which a free run need not be; what is `is_other` is a
    short table without a motion.

    """

    path: Path
    folder: str
    out: Path
    is_free: bool
    guess: Guess | None = None
    mapping: Path | None = None
    params: Path | None = None
    bag: Bag | None = None
    values: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    failure: str = ''
    is_other: bool = False
    reported: LogResult | None = None

    @property
    def is_free_run(self) -> bool:
        """Return True if it is said to be a free run and can be read."""
        return self.is_free and not self.failure

    @property
    def used(self) -> str:
        """Return the file of its map or of its parameters that was written, if any."""
        file = self.mapping or self.params
        return '' if file is None else str(file.relative_to(self.out))

    @property
    def result(self) -> LogResult:
        """Return what became of it."""
        return self.reported or LogResult(
            name=self.path.name, folder=self.folder, failure=self.failure
        )


def without_motion(others: Sequence[CheckedLog]) -> str:
    """Return in a sentence which files are taken for no recordings."""
    return (
        'no recordings, as no column is named as a motion and few rows are of numbers: '
        f'{listed([log.path.name for log in others])}'
    )


def check_parts(
    logs: Sequence[CheckedLog],
    asides: Sequence[str],
    runs: Sequence[FreeRun],
    surfaces: Mapping[str, str],
    steps: Sequence[str],
) -> list[Markup]:
    """
    Return the parts of the page beside those of an overview.

    `asides` say which files are no recordings; `surfaces` are files by axis.

    """
    sentences = (step if step.endswith('?') else f'{step}.' for step in steps)
    friction = [
        part
        for run in runs
        for part in (element('h3', f'Axis {run.axis}, from {run.log}'), element('pre', run.text))
    ]
    if not runs:
        text = 'Not identified: no recording is a free run with a motor torque.'
        friction.append(element('p', text))
    return [
        element('h2', 'What to do next, and what to record'),
        element('ul', *(element('li', sentence) for sentence in sentences)),
        element('h2', 'What was read'),
        table(
            ('Recording', 'Axis', 'Expected', 'Judged', 'Reasons of the differences', 'Map'),
            _rows(logs),
        ),
        *(element('p', f'{aside}.') for aside in asides),
        *(element('p', f'Note: {note}.', class_='hint') for note in notes_of(logs)),
        element('h2', 'Friction beside the contacts'),
        *friction,
        element('h2', 'Surfaces'),
        *_surfaces(surfaces),
        element('h2', 'Zone and health'),
        *_zone([log.result for log in logs]),
    ]


def notes_of(logs: Sequence[CheckedLog]) -> list[str]:
    """Return what is odd about recordings, also where a log contradicts itself or its map."""
    return [f'{log.path.name}: {note}' for log in logs for note in log.result.notes]


def next_steps(
    logs: Sequence[CheckedLog],
    runs: Sequence[FreeRun],
    *,
    screw: str,
    of_screw: Sequence[str],
    assumed_oil: str,
) -> list[str]:
    """
    Return what to do and what to record, each once, what hinders a verdict first.

    `screw` is the name of the sheet, empty without one, by which axes `of_screw` were judged.

    """
    guesses = {log.path.name: log.guess.unstated for log in logs if log.guess}
    steps = [f'{name}: {why}' for name, whys in guesses.items() for why in whys]
    steps += [
        f'{log.path.name}: {log.result.failure}'
        for log in logs
        if log.result.failure and not guesses.get(log.path.name)
    ]
    if steps:
        first = ': maps/ beside this page holds the first ones'
        steps.append(
            'Lay a map beside each table that needs one, feed.map.yaml for feed.csv'
            + (first if any(guesses.values()) else '')
        )
    lines = [line for log in logs if not log.is_free_run for line in log.result.lines]
    steps += [f'Axis {line.axis}: {line.remedy.rstrip(".")}' for line in lines if line.remedy]
    steps += [hint for log in logs for hint in log.result.hints]
    if len(of_screw) > 1:
        steps.append(
            f'The sheet {screw} is that of one screw, and axes {listed(of_screw)} were judged '
            'by it: the verdict is that of the axis with this screw alone. Lay the logs of each '
            'other axis into a folder of their own with its sheet, or state screw, lead_mm and '
            'surface of that axis in a map beside its log'
        )
    if not screw:
        steps.append(
            'State the screw and the oil of the machine, --screw and --oil, or lay their sheets '
            'into the folder: the shipped ones were assumed'
        )
    elif assumed_oil:
        steps.append(f'State the oil, --oil: {assumed_oil} was assumed')
    for name, words in NEEDED.items():
        recorded = {line.axis for line in lines if name not in line.missing}
        axes = dict.fromkeys(line.axis for line in lines if line.axis not in recorded)
        if axes:
            steps.append(f'Record {words} of axis {", ".join(axes)}')
    if not any(run.sheet for run in runs):
        steps.append(RECORD)
    return list(dict.fromkeys(steps))


def _rows(logs: Sequence[CheckedLog]) -> Iterator[TableRow]:
    for log in logs:
        name, result = log.path.name, log.result
        where = element('a', log.used, href=quote(log.used)) if log.used else NONE
        if result.failure:
            yield TableRow((name, NONE, NONE, NONE, result.failure, where))
        for line in result.lines:
            counts = (
                TableCell(str(count), kind='number') for count in (line.expected, line.judged)
            )
            yield TableRow((name, line.axis, *counts, line.losses or NONE, where))


def _surfaces(surfaces: Mapping[str, str]) -> Iterator[Markup]:
    for axis, file in surfaces.items():
        surface = Surface.load(file)
        onset = onset_of_surface(surface)
        text = f'Axis {axis}: {Path(file).name}, tier {surface.tier}. {onset.sentence()}.'
        is_own = surface.tier == 'full' and Path(file).parent != shipped_surface().parent
        if is_own and not (onset.marched or onset.calibrated):
            text += ' Its raceway was not marched: `ballscrew surface build` marches it.'
        yield element('p', text)
    if not surfaces:
        yield element('p', 'Each recording was judged with the surface that it names.')


def _zone(entries: Sequence[LogResult]) -> Iterator[Markup]:
    for entry in entries:
        for line in entry.lines:
            parts = [element('p', f'Normal? {line.normal}.')] if line.normal else []
            parts.append(element('p', f'{entry.name}: {line.told}', class_='sentence'))
            yield element('div', *parts, class_=f'verdict {line.standing}')
    histories = [history for entry in entries for history in entry.histories]
    for own in by_axis(histories).values():
        if len(own) > 1:  # it stands first on the page
            continue
        yield verdict_box(list(healths(own))[-1])
