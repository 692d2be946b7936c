# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The golden rows hold: the events that are kept give the rows and states that are kept."""

import json
import types

from ballscrew_monitor.core.derived_load import LoadDerivation
from ballscrew_monitor.core.differentiation import PositionSettings
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.memory import Memory
from ballscrew_monitor.core.shelving import Shelving
from ballscrew_monitor.core.state import Event, MonitorSettings
from ballscrew_monitor.core.tally import Totals
from golden_rows import columns_of, Command, KINDS, ROWS, Run, SURFACE, Tables
import numpy as np
import pytest
from surrogate.surface import Surface, Validity

TOLERANCE = 1e-12  # of numbers, relative, and absolute in SI: sums may run in another order


@pytest.fixture(scope='module')
def golden():
    """Return the arrays on file by name."""
    with np.load(ROWS) as archive:
        return {name: archive[name] for name in archive.files}


def settings_of(text):
    known = json.loads(text)
    for name in ('timeouts', 'plausible'):
        known[name] = {Source[source]: value for source, value in known[name].items()}
    kinds = {'limits': Limits, 'derivation': LoadDerivation, 'positions': PositionSettings}
    for name, kind in kinds.items():
        known[name] = None if known[name] is None else kind(**known[name])
    return MonitorSettings(**known)


def memory_of(text):
    known = json.loads(text)
    shelving = Shelving(until=known['shelved_until'], reason='kept')
    return Memory(
        totals=Totals(**known['totals']), event=Event(**known['event']), shelving=shelving
    )


def event_of(golden, at):
    one = types.SimpleNamespace(
        **{
            name.removeprefix('event_'): column[at].item()
            for name, column in golden.items()
            if name.startswith('event_')
        }
    )
    kind, lost = KINDS[one.kind], None if one.lost < 0 else one.lost
    if kind == 'refusal':
        return Refusal(source=Source(one.source), why=Why(one.why), arrival=one.arrival, lost=lost)
    if kind != 'sample':
        return Command(kind, one.stamp, one.arrival, one.value)
    return InputSample(
        source=Source(one.source),
        value=one.value,
        stamp=one.stamp,
        stamp_source=StampSource(one.stamp_source),
        arrival=one.arrival,
        lost=lost,
    )


def test_the_events_give_the_rows_and_states(golden):
    surface, tables = Surface.load(SURFACE), Tables()
    for number, name in enumerate(golden['run_name'].tolist()):
        run = Run(
            name=name,
            settings=settings_of(golden['run_settings'][number]),
            memory=memory_of(golden['run_memory'][number]),
            events=[event_of(golden, at) for at in np.flatnonzero(golden['event_run'] == number)],
        )
        tables.take(number, run, surface)
    reasons = [list(tables.texts)[row.pop('reason')] for row in tables.rows]
    assert reasons == golden['texts'][golden['row_reason']].tolist()
    assert len(tables.states) == len(golden['state_row'])
    for name, column in {
        **columns_of('row', tables.rows),
        **columns_of('state', tables.states),
    }.items():
        kept = golden[name]
        if kept.dtype == np.int64:
            np.testing.assert_array_equal(column, kept, err_msg=name)
        else:
            np.testing.assert_allclose(
                column, kept, rtol=TOLERANCE, atol=TOLERANCE, err_msg=name, equal_nan=True
            )


def test_the_rows_hold_every_kind_of_judgement(golden):
    assert set(golden['row_validity']) == set(Validity) | {7}
    assert set(golden['event_kind']) == set(range(len(KINDS)))
    assert set(golden['event_why']) == {-1, *Why}
    assert set(golden['row_axial_load_source']) == {0, 1, 3, 4}
    assert golden['row_corrected'].any()
