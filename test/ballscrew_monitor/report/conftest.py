# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Judged rows as a recording would give them, without a recording, and a real browser."""

import contextlib
import dataclasses
import functools
import shutil
import subprocess
import types

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source, StampSource
from ballscrew_monitor.core.judgement import Level, PointSource, PointValidity, Reason, Zone
from ballscrew_monitor.judge.many import ROW
from ballscrew_monitor.recordings.axis_run import AxisRows
from ballscrew_monitor.recordings.summary import AxisOutcome, EventRecord
from ballscrew_monitor.report import many_logs
from ballscrew_monitor.report.judging import CaseMaker, LogCase
from ballscrew_monitor.report.parameters import AxisFacts
from ballscrew_monitor.report.row_table import RowTable
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_msgs.msg import Totals
import numpy as np
import pytest
from surrogate.surface import Regime
from surrogate.tasks.workers import open_pool
from surrogate.units import TURN

BEGIN = 1_767_600_000 * SECOND
"""First stamp of what is made here [ns]."""
AXIS_FACTS = {field.name for field in dataclasses.fields(AxisFacts)}
DEADLINE = 600.0  # [s] which only ends a hang
BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')


@pytest.fixture(scope='session')
def warm_pool():
    with open_pool(1) as pool:
        yield pool


@pytest.fixture
def one_worker(warm_pool, monkeypatch):
    """Let commands share a worker, whose start takes longer than its work."""
    monkeypatch.setattr(many_logs, 'open_pool', lambda *_, **__: contextlib.nullcontext(warm_pool))


@pytest.fixture
def browse(tmp_path):
    """Return what lets a browser without a window open a page, and gives what it prints."""
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        pytest.skip('no chromium to open the page in, install the package of that name')
    return functools.partial(_browse, found, tmp_path / 'profile')


def _browse(browser, profile, page, *options):
    return subprocess.run(
        [
            browser,
            '--headless',
            '--no-sandbox',
            '--disable-gpu',
            f'--user-data-dir={profile}',
            '--virtual-time-budget=8000',
            *options,
            page.as_uri(),
        ],
        check=True,
        capture_output=True,
        text=True,
        timeout=DEADLINE,
    ).stdout


def make_rows(begin=0, count=100, *, rate=100.0, axis='x', **changes):
    """Return `count` rows from the number `begin` on, in motion and optimal."""
    numbers = np.arange(begin, begin + count)
    stamp = BEGIN + np.rint(numbers * (SECOND / rate)).astype(np.int64)
    measured = {
        f'{name}_source': PointSource.MEASURED for name in ('speed', 'axial_load', 'temperature')
    }
    columns = measured | {
        'stamp': stamp,
        'now': stamp + 1000,
        'speed': 100.0 + 10.0 * np.sin(0.01 * numbers),
        'axial_load': -1000.0 + 50.0 * np.cos(0.02 * numbers),
        'temperature': 313.15,
        'motor_torque': np.nan,
        'efficiency': 0.9,
        'rcs': 1e-3,
        'film_ratio': 2.0,
        'friction_torque': 0.1,
        'machine_torque': 1.5,
        'direction': Direction.POSITIVE,
        'validity': PointValidity.VALID,
        'regime': Regime.MIXED,
        'zone': Zone.OPTIMAL,
        'reason': Reason.JUDGED,
        'level': Level.OK,
    }
    return changed(AxisRows(axis, np.zeros(count, ROW)), **columns | changes)


def changed(block, **columns):
    """Return a copy of rows with other columns."""
    rows = block.rows.copy()
    for name, values in columns.items():
        rows[name] = values
    return AxisRows(block.axis, rows)


def make_table(path, blocks):
    """Return the rows of blocks as a table in a file."""
    table = RowTable(path)
    for block in blocks:
        table.add(block.rows)
    return table


def make_event(number, start, duration, **changes):
    """Return an event that begins `start` [s] after the first row."""
    values = {
        'event_id': number,
        'start': BEGIN + round(start * SECOND),
        'duration': duration,
        'active': False,
        'quantity': 'RCS',
        'relation': '>=',
        'worst_value': 0.1,
        'limit': 0.01,
        'advice': 'at this load run at 573 rev/min',
        'target_speed': 60.0,
        'speed': 45.0,
        'axial_load': -1200.0,
    }
    return EventRecord(**values | changes)


def make_status(source, **changes):
    values = {
        'source': source,
        'state': InputState.OK,
        'stamp_source': StampSource.HEADER,
        'age': 0.0,
        'rate': 100.0,
        'received': 100,
        'dropped': 0,
    }
    return InputStatus(**values | changes)


def make_case(
    folders, blocks, events=(), *, totals=None, values=None, known=None, health=False, **changes
):
    """Return the case of an axis with blocks of rows and events; `folders` makes folders."""
    axis, values = blocks[0].axis, values or make_values(blocks[0].axis)
    rows = sum(len(block.rows) for block in blocks)
    first, last = (int(blocks[at].rows['stamp'][at]) for at in (0, -1))
    span = last - first
    outside = sum(round(event.duration * SECOND) for event in events)
    if totals is None:
        totals = Totals(
            running_time=span / SECOND,
            optimal_time=(span - outside) / SECOND,
            outside_time=outside / SECOND,
            mixed_time=span / SECOND,
            revolutions=628.0 / TURN,
            energy_lost=1000.0,
        )
    facts = {
        'axis': axis,
        'first': first,
        'last': last,
        'rows': rows,
        'states': rows,
        'judged': rows,
        'totals': totals,
        'events': tuple(events),
        'inputs': tuple(make_status(source) for source in Source),
        'refused': {},
        'limits': build_axis(axis, values).monitor.settings.limits,
    }
    outcome = AxisOutcome(**facts | changes)
    maker = CaseMaker(axis, values, health=health)
    for block in blocks:
        maker.add(block.rows)
    known = known or {}
    facts = AxisFacts(**{key: one for key, one in known.items() if key in AXIS_FACTS})
    flags = {key: one for key, one in known.items() if key not in AXIS_FACTS}
    table = make_table(folders.mktemp('rows') / 'x.rows', blocks)
    return maker.case(outcome, rows=table, facts=facts, **flags)


def make_log(*cases, **changes):
    return LogCase(**{'name': 'log', 'parameters': 'my.yaml', 'axes': cases} | changes)


def make_values(axis='x', **changes):
    return defaults([axis]) | {f'{axis}.temperature.topic': 'oil_temperature'} | changes


@pytest.fixture(scope='session')
def judged(tmp_path_factory):
    """Make the parts that tests of reports are built from."""
    return types.SimpleNamespace(
        begin=BEGIN,
        rows=make_rows,
        changed=changed,
        table=make_table,
        event=make_event,
        status=make_status,
        case=functools.partial(make_case, tmp_path_factory),
        log=make_log,
        values=make_values,
    )


@pytest.fixture(scope='session')
def five_minutes(judged):
    """Return five minutes at 1 kHz with 60 events and a measured torque."""
    noise = np.random.default_rng(1)
    rows = 30_000

    def block(number):
        block = make_rows(number * rows, rows, rate=1000.0, motor_torque_source=1)
        made = block.rows
        return changed(
            block,
            speed=made['speed'] + noise.normal(0.0, 1.0, rows),
            axial_load=made['axial_load'] + noise.normal(0.0, 20.0, rows),
            efficiency=made['efficiency'] + noise.normal(0.0, 0.005, rows),
            rcs=made['rcs'] * np.exp(noise.normal(0.0, 0.5, rows)),
            film_ratio=made['film_ratio'] + noise.normal(0.0, 0.05, rows),
            motor_torque=made['machine_torque'] + noise.normal(0.1, 0.05, rows),
        )

    events = [
        make_event(n + 1, 5.0 * n + 1.2, 2.4, worst_value=0.011 + 0.001 * n) for n in range(60)
    ]
    values = make_values(**{'x.torque.topic': 'torque', 'x.torque.field': 'data'})
    return judged.case([block(number) for number in range(10)], events, values=values)
