# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The golden events and rows on file, see `test_golden`."""

import dataclasses
import json
from pathlib import Path
import types

from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import (
    LoadDerivation,
    MonitorSettings,
    NOT_ENDED,
    NOT_SHELVED,
    Shelving,
)
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.judge.views import PARTS
from ballscrew_monitor.judge.zone import ACTIVE
import numpy as np
import pytest
from surrogate.surface import FIELDS, Surface

DATA = Path(__file__).resolve().parents[2] / 'data'
ROWS = DATA / 'golden_rows.npz'
KINDS = ('sample', 'refusal', 'tick', 'acknowledge', 'shelve', 'correct', 'reset')
with np.load(ROWS) as archive:
    NAMES = archive['run_name'].tolist()


@pytest.fixture(params=range(len(NAMES)), ids=NAMES)
def run(request):
    return request.param


@pytest.fixture(scope='session')
def golden():
    return Golden()


class Golden:
    """The runs on file, and the surface that their rows were made with."""

    def __init__(self):
        with np.load(ROWS) as archive:
            self.arrays = {name: archive[name] for name in archive.files}
        self.surface = Surface.load(DATA / 'golden_surface.npz')

    def table(self, prefix, which):
        columns = {
            name.removeprefix(prefix): column[which].tolist()
            for name, column in self.arrays.items()
            if name.startswith(prefix)
        }
        return [types.SimpleNamespace(**dict(zip(columns, row))) for row in zip(*columns.values())]

    def numbers(self, run):
        return np.flatnonzero(self.arrays['event_run'] == run)

    def monitor(self, run):
        settings = settings_of(self.arrays['run_settings'][run])
        made = Monitor(self.surface, settings)
        # The end of a shelving, not what is left of it, is on file: on a clock of 1 ns.
        made.take_up(kept_of(self.arrays['run_memory'][run]), 1)
        return made

    def event(self, stored):
        """Return a sample, a refusal, or the stamp of a tick; None for a command."""
        kind, lost = KINDS[stored.kind], None if stored.lost < 0 else stored.lost
        if kind == 'tick':
            return stored.stamp
        if kind == 'refusal':
            source, why = Source(stored.source), Why(stored.why)
            return Refusal(source=source, why=why, arrival=stored.arrival, lost=lost)
        if kind != 'sample':
            return None
        return InputSample(
            source=Source(stored.source),
            value=stored.value,
            stamp=stored.stamp,
            arrival=stored.arrival,
            stamp_source=StampSource(stored.stamp_source),
            lost=lost,
        )

    def command(self, monitor, stored):
        kind = KINDS[stored.kind]
        if kind == 'acknowledge':
            monitor.acknowledge(stored.stamp)
        elif kind == 'shelve':
            monitor.shelving = Shelving(until=stored.stamp, reason='known')
        elif kind == 'correct':
            pull = self.table('pull_', slice(None))[int(stored.value)]
            solved = {name: getattr(pull, f'solved_{name}') for name in FIELDS}
            solution = types.SimpleNamespace(**solved)
            monitor.use_surface(monitor.surface.with_correction(pull, solution))
        else:
            monitor.reset_totals()


def settings_of(text):
    known = json.loads(text)
    for name in ('timeouts', 'plausible'):
        known[name] = {Source[source]: value for source, value in known[name].items()}
    kinds = {'limits': Limits, 'derivation': LoadDerivation}
    for name, kind in kinds.items():
        known[name] = None if known[name] is None else kind(**known[name])
    positions = known.pop('positions') or {'window': 0, 'wrap': 0.0}
    return MonitorSettings(**known, position_window=positions['window'], wrap=positions['wrap'])


def kept_of(text):
    known = json.loads(text)
    event, totals = known['event'], known['totals']
    memory = Memory(
        event_number=event['number'],
        event_active=event.get('active', False),
        event_stamp=event.get('stamp', 0),
        **{name: totals.get(name, 0) for name in ('running_time', 'unjudged_time', 'since')},
        **{name: totals.get(name, 0.0) for name in ('angle', 'energy_lost')},
    )
    memory.event_start[ACTIVE] = event.get('start', 0)
    for name, (part, place) in PARTS.items():
        getattr(memory, part)[place] = totals.get(name, 0)
    left = max(known['shelved_until'] - 1, 0)
    record = AxisRecord.of('x', memory, NOT_ENDED, NOT_SHELVED, 0)
    return dataclasses.replace(record, left_ns=left, reason='kept')
