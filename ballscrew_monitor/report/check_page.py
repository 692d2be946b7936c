# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The page of a check: what was read, identified, built, said, and what to do and record next."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
from pathlib import Path
from urllib.parse import quote

from ballscrew_monitor.recordings.words import listed, NONE
from ballscrew_monitor.report.free_run import FreeRun, RECORD
from ballscrew_monitor.report.health_history import by_axis, healths, read_history
from ballscrew_monitor.report.health_part import verdict_box
from ballscrew_monitor.report.overview import LogEntry
from ballscrew_monitor.report.page import element, Markup, table, TableCell, TableRow
from surrogate.surface import onset_of_surface, Surface

NEEDED = {
    'Axial load': 'the axial load, or the motor torque that it can be derived from',
    'Oil temperature': 'the oil temperature at the nut',
    'Motor torque': 'the motor torque, from which friction and preload are told',
}
"""Inputs that are worth recording, with their words."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Checked:
    """
    What a check rests on.

    Names of the sheets of screw and oil, None without one; folders of recordings that are said to
    be `free`, which need not be judged, and what they gave; surfaces by axis; the map or
    parameters that were used by folder; names of `others`, short tables without a motion; which
    other files are `unread`, in words; what a guess could not state, by recording.

    """

    sheets: tuple[str, str] | None
    is_oil_known: bool
    free: frozenset[str]
    runs: tuple[FreeRun, ...]
    surfaces: Mapping[str, str]
    used: Mapping[str, str]
    others: tuple[str, ...]
    unread: tuple[str, ...] = ()
    unstated: Mapping[str, Sequence[str]]


def without_motion(names: Sequence[str]) -> str:
    """Return in a sentence which files are taken for no recordings."""
    return (
        'no recordings, as no column is named as a motion and few rows are of numbers: '
        f'{listed(names)}'
    )


def check_parts(entries: Sequence[LogEntry], checked: Checked) -> list[Markup]:
    """Return the parts of the page beside those of an overview."""
    return [
        element('h2', 'What to do next, and what to record'),
        element('ul', *(element('li', _sentence(one)) for one in next_steps(entries, checked))),
        element('h2', 'What was read'),
        table(
            ('Recording', 'Axis', 'Expected', 'Judged', 'Reasons of the differences', 'Map'),
            _rows(entries, checked),
        ),
        *([element('p', f'{without_motion(checked.others)}.')] if checked.others else []),
        *(element('p', f'{sentence}.') for sentence in checked.unread),
        *(element('p', f'Note: {one}.', class_='hint') for one in notes_of(entries)),
        element('h2', 'Friction beside the contacts'),
        *_identified(checked),
        element('h2', 'Surfaces'),
        *_surfaces(checked),
        element('h2', 'Zone and health'),
        *_zone(entries),
    ]


def notes_of(entries: Sequence[LogEntry]) -> list[str]:
    """Return what is odd about recordings, also where a log contradicts itself or its map."""
    return [f'{one.name}: {note}' for one in entries if one.result for note in one.result.notes]


def _sentence(step: str) -> str:
    return step if step.endswith('?') else f'{step}.'


def next_steps(entries: Sequence[LogEntry], checked: Checked) -> list[str]:
    """Return what to do and what to record, each once, what hinders a verdict first."""
    steps = [f'{name}: {why}' for name, whys in checked.unstated.items() for why in whys]
    steps += [
        f'{one.name}: {one.failure}'
        for one in entries
        if one.result is None and not checked.unstated.get(one.name)
    ]
    if steps:
        first = ': maps/ beside this page holds the first ones'
        steps.append(
            'Lay a map beside each table that needs one, feed.map.yaml for feed.csv'
            + (first if any(checked.unstated.values()) else '')
        )
    judged = [one for one in entries if one.result and one.folder not in checked.free]
    lines = [line for one in judged if one.result for line in one.result.lines]
    steps += [f'Axis {line.axis}: {line.remedy.rstrip(".")}' for line in lines if line.remedy]
    steps += [hint for one in entries if one.result for hint in one.result.hints]
    if checked.sheets is None:
        steps.append(
            'State the screw and the oil of the machine, --screw and --oil, or lay their sheets '
            'into the folder: the shipped ones were assumed'
        )
    elif not checked.is_oil_known:
        steps.append(f'State the oil, --oil: {checked.sheets[1]} was assumed')
    for name, words in NEEDED.items():
        recorded = {line.axis for line in lines if name not in line.missing}
        axes = dict.fromkeys(line.axis for line in lines if line.axis not in recorded)
        if axes:
            steps.append(f'Record {words} of axis {", ".join(axes)}')
    if not any(run.sheet for run in checked.runs):
        steps.append(RECORD)
    return list(dict.fromkeys(steps))


def _rows(entries: Sequence[LogEntry], checked: Checked) -> Iterator[TableRow]:
    for entry in entries:
        used = checked.used.get(entry.folder, '')
        where = element('a', used, href=quote(used)) if used else NONE
        if entry.result is None:
            yield TableRow((entry.name, NONE, NONE, NONE, entry.failure, where))
            continue
        for line in entry.result.lines:
            numbers = (TableCell(str(one), kind='number') for one in (line.expected, line.judged))
            yield TableRow((entry.name, line.axis, *numbers, line.losses or NONE, where))


def _identified(checked: Checked) -> Iterator[Markup]:
    for run in checked.runs:
        yield element('h3', f'Axis {run.axis}, from {run.log}')
        yield element('pre', run.text)
    if not checked.runs:
        yield element('p', 'Not identified: no recording is a free run with a motor torque.')


def _surfaces(checked: Checked) -> Iterator[Markup]:
    for axis, file in checked.surfaces.items():
        surface = Surface.load(file)
        onset = onset_of_surface(surface).sentence()
        yield element('p', f'Axis {axis}: {Path(file).name}, tier {surface.tier}. {onset}.')
    if not checked.surfaces:
        yield element('p', 'Each recording was judged with the surface that it names.')


def _zone(entries: Sequence[LogEntry]) -> Iterator[Markup]:
    for entry in entries:
        for line in entry.result.lines if entry.result else ():
            said = [f'Normal? {line.normal}.'] if line.normal else []
            parts = [element('p', one) for one in said]
            parts.append(element('p', f'{entry.name}: {line.verdict}', class_='sentence'))
            yield element('div', *parts, class_=f'verdict {line.standing}')
    histories = [
        read_history(one) for entry in entries if entry.result for one in entry.result.histories
    ]
    for own in by_axis(histories).values():
        if len(own) > 1:  # it stands first on the page
            continue
        yield verdict_box(list(healths(own))[-1])
