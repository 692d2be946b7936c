# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The report of a sweep: every item, for programs (JSON) and for people (a page)."""

from collections.abc import Mapping
import math
from pathlib import Path
from typing import Any

from surrogate.builder.sweep import Built, Item
from surrogate.files import InputError, json_text, replace_file
from surrogate.surface import Surface

JSON_NAME, PAGE_NAME = 'sweep.json', 'sweep.md'


class SweepReport:
    """What has become of every item so far; both files are rewritten after each."""

    def __init__(self, catalogue: Path, items: list[Item], out: Path) -> None:
        self._catalogue, self._out = catalogue, out
        self._items = {item.name: _waiting(item) for item in items}

    def add(self, built: Built) -> None:
        """Take an item; raises InputError when the report cannot be written."""
        self._items[built.item.name].update(_entry(built, self._out))
        self.write()

    def record(self) -> dict[str, Any]:
        """Return the report as plain values; SI units, null where not known."""
        items = list(self._items.values())
        workers: dict[str, dict[str, list[str]]] = {}
        for item in items:
            for name in item['lost_workers']:
                workers.setdefault(name, {'done': [], 'lost_at': []})['lost_at'].append(
                    item['name']
                )
            if item['status'] == 'built':
                worker = workers.setdefault(item['worker'], {'done': [], 'lost_at': []})
                worker['done'].append(item['name'])
        return {
            'catalogue': str(self._catalogue),
            'counts': {
                status: sum(item['status'] == status for item in items)
                for status in ('built', 'failed', 'waiting')
            },
            'workers': dict(sorted(workers.items())),
            'items': items,
        }

    def write(self) -> None:
        """Write both files, each whole or not at all; raises InputError."""
        record = self.record()
        text = json_text(record) + '\n'
        try:
            replace_file(self._out / JSON_NAME, text.encode())
            replace_file(self._out / PAGE_NAME, report_page(record).encode())
        except OSError as error:
            raise InputError(f'{self._out}: cannot be written, {error.strerror}') from None


def _waiting(item: Item) -> dict[str, Any]:
    return {
        'name': item.name,
        'tier': item.tier,
        'screw': item.screw.name,
        'oil': item.lubricant.name,
        'roughness': item.roughness,
        'status': 'waiting',
        'sentence': '',
        'file': '',
        'sha256': '',
        'nodes': 0,
        'masked_nodes': 0,
        'errors': {},
        'worker': '',
        'lost_workers': [],
        'seconds': math.nan,
    }


def _entry(built: Built, out: Path) -> dict[str, Any]:
    outcome = built.outcome
    entry: dict[str, Any] = {
        'status': 'built' if built.data is not None else 'failed',
        'sentence': outcome.sentence,
        'worker': outcome.worker,
        'lost_workers': list(outcome.lost),
        'seconds': outcome.seconds,
    }
    if built.data is None or built.file is None:
        return entry
    surface = Surface(built.data)
    return entry | {
        'file': str(built.file.relative_to(out)),
        'sha256': surface.sha256,
        'nodes': int(built.data.mask.size),
        'masked_nodes': int(built.data.mask.sum()),
        'errors': {
            name: {'max': worst, 'p95': usual} for name, (worst, usual) in surface.errors.items()
        },
    }


def report_page(record: Mapping[str, Any]) -> str:
    """Return the report as a page (Markdown)."""
    counts = record['counts']
    lines = [
        f'# Sweep of {record["catalogue"]}',
        '',
        f'{counts["built"]} built, {counts["failed"]} failed, {counts["waiting"]} waiting.',
        '',
        '| surface | status | largest error: torque [N m] | RCS [-] | s | worker | sha256 |',
        '|---|---|---|---|---|---|---|',
        *map(_row, record['items']),
    ]
    lost = [item for item in record['items'] if item['lost_workers']]
    if lost:
        lines += ['', '## Workers that were lost', '']
        lines += [
            f'* {", ".join(item["lost_workers"])} at {item["name"]}: '
            + (f'done by {item["worker"]}' if item['status'] == 'built' else item['sentence'])
            for item in lost
        ]
    return '\n'.join(lines) + '\n'


def _row(item: Mapping[str, Any]) -> str:
    status = item['status'] + (f': {item["sentence"]}' if item['sentence'] else '')
    torque, rcs = (
        f'{item["errors"][name]["max"]:.2g}' if item['errors'] else '-'
        for name in ('friction_torque', 'rcs')
    )
    seconds = f'{item["seconds"]:.1f}' if math.isfinite(item['seconds']) else '-'
    return (
        f'| {item["file"] or item["name"]} | {status} | {torque} | {rcs} | {seconds} | '
        f'{item["worker"] or "-"} | {item["sha256"][:16] or "-"} |'
    )
