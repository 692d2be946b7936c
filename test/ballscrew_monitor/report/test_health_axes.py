# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew health STATE_DIR`: what a node gathered, read whether or not it runs."""

import contextlib
import json
import math
import shutil

from ballscrew_monitor.cli import main
from ballscrew_monitor.health.records import Baseline, SpectrumBin, Stretch
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import HealthStore, read_health
from ballscrew_monitor.health.summary import add
from ballscrew_monitor.report import health_axes, health_history
from ballscrew_monitor.settings.parameters import defaults
import pytest

FIRST, MONTHS = 20_000, 3
SPEEDS = 3.0, 12.0, 40.0, 100.0


@pytest.fixture(name='folder')
def kept_folder(tmp_path):
    """Return the folder of a node whose friction is 40 % higher after the second month."""
    cells = {}
    for day in range(FIRST, FIRST + 28 * MONTHS, 4):
        factor = 1.0 if day < FIRST + 56 else 1.4
        for speed in (*SPEEDS, *(-one for one in SPEEDS)):
            for second in range(6):
                torque = math.copysign(0.4 * factor, speed)
                stretch = Stretch(
                    start=day * DAY + second,
                    duration=60.0,
                    samples=100,
                    speed=speed,
                    axial_load=0.0,
                    temperature=313.0,
                    motor_torque=torque * (1.0 + 0.002 * (second % 3 - 1)),
                )
                add(cells, stretch)
    one = SpectrumBin(
        first_day=FIRST, load_band=0, axial_load=0.0, angle=9.0, speed=9.0, time=9000.0
    )
    folder = tmp_path / 'state'
    with contextlib.closing(HealthStore(folder)) as store:
        store.load()
        store.add('x', cells.values(), [one])
        begin, end = FIRST * DAY, (FIRST + 33) * DAY
        store.keep_baseline('x', Baseline(begin=begin, end=end, reason='oil'))
    return folder


def test_the_command_follows_what_a_node_gathered(folder, capsys, tmp_path):
    out = tmp_path / 'out'
    assert main(['health', str(folder), '--out', str(out), '--json']) == 0
    record = json.loads(capsys.readouterr().out)['x']
    assert record['condition'] == 'worse'
    assert record['baseline']['reason'] == 'oil'
    conditions = [one['condition'] for one in record['course']]
    assert len(conditions) == 21
    assert set(conditions[6:14]) == {'normal'}
    assert set(conditions[16:]) == {'worse'}
    days = [one['stamp_ns'] // DAY - FIRST for one in record['course']]
    assert days == list(range(0, 84, 4))
    assert (out / 'health.png').stat().st_size > 0


@pytest.mark.parametrize(('parameter', 'option'), [(True, False), (False, True), (False, False)])
def test_another_speed_is_advised_where_the_parameters_or_the_command_let_it(
    folder, monkeypatch, parameter, option
):
    asked = []
    monkeypatch.setattr(health_history, 'course', lambda *parts: asked.append(parts[-1]))
    values = defaults(['x']) | {'x.advice.speed': parameter}
    options = {'baseline_days': 91.0, 'days': None, 'speed_allowed': option}
    stored = read_health(folder)
    titles = {health_axes.stored_axis(folder, 'x'): 'x'}
    health_axes.kept_healths(folder, stored, titles, values, options)
    assert {one.speed_allowed for one in asked} == {parameter or option}


def test_two_nodes_with_one_axis_x_each_are_told_apart(folder, capsys, tmp_path):
    other = tmp_path / 'lathe' / 'state'
    shutil.copytree(folder, other)
    assert main(['health', str(folder), str(other), '--json']) == 0
    records = json.loads(capsys.readouterr().out)
    here = f'{tmp_path.name}/state'
    assert {key: one['machine'] for key, one in records.items()} == {
        f'x of {here}': here,
        'x of lathe/state': 'lathe/state',
    }
    assert records['x of lathe/state']['verdict'].startswith('Axis x of lathe/state is worse: ')


@pytest.mark.parametrize('name', ['health.json', 'health.png'])
def test_files_of_somebody_else_are_not_replaced(folder, name, capsys, says, tmp_path):
    theirs = tmp_path / 'out' / name
    theirs.parent.mkdir()
    theirs.write_text('{"patient": {"name": "x"}}')
    command = ['health', str(folder), '--out', str(theirs.parent)]
    assert main(command) == 2
    assert says('foreign', name=name) in capsys.readouterr().err
    assert theirs.read_text() == '{"patient": {"name": "x"}}'
    assert list(theirs.parent.iterdir()) == [theirs]
    theirs.unlink()
    assert [main(command), main(command)] == [0, 0]


def test_an_axis_without_parameters_is_refused(folder, capsys, says):
    with contextlib.closing(HealthStore(folder)) as store:
        store.load()
        store.add('z', store.read('x').cells)
    assert main(['health', str(folder)]) == 2
    assert says('no_parameters', folder=folder) in capsys.readouterr().err
