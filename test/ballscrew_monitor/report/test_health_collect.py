# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Logs collected in a folder: only new ones; a damaged entry hides itself; a lost cluster."""

import dataclasses
import datetime
import json
import math
from pathlib import Path
import re
import shutil

from ballscrew_monitor.cli import main
from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.health.records import (
    Baseline,
    Cause,
    CauseCode,
    CELL,
    CellKind,
    Condition,
    Health,
    Quantity,
    UsualWarning,
)
from ballscrew_monitor.health.summary import array_of
from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.report import health_collect, many_logs
from ballscrew_monitor.report.health_axes import same_start_note
from ballscrew_monitor.report.health_collect import collect
from ballscrew_monitor.report.health_folder import (
    axis_folders,
    held_logs,
    identity_of,
    is_health_folder,
    read_axis,
    read_entry,
)
from ballscrew_monitor.report.machines import MachineAxis
from ballscrew_monitor.report.many_logs import Given, Workers
import numpy as np
import polars as pl
import pytest
from surrogate.files import to_json
from surrogate.surface import SurfaceError

NOMINAL = Path('config/nominal_cycle.yaml')
MAP = """
machine: {machine}
time: {{column: t, unit: s, epoch: {epoch}}}
axes:
  x:
    speed: {{column: v, unit: rad/s}}
    position: {{column: s, unit: mm}}
    torque: {{column: M, unit: N m}}
    load: {{column: F, unit: N}}
    temperature: {{column: T, unit: degC}}
    lead_mm: 10.0
"""
FRICTION = 0.4  # [N m]


def write_log(path, *, epoch='2026-01-05T06:00:00Z', machine='mill 3', friction=FRICTION):
    """Write a log of passes at three speeds with an even friction, and its map; return both."""
    rows, clock = ['t,v,s,M,F,T'], 0.0
    for speed in (10.0, 40.0, 120.0):
        feed = speed * 10.0 / (2.0 * math.pi)  # [mm/s]
        for way in (1.0, -1.0):
            for tick in range(round(300.0 / feed / 0.05)):
                place = feed * 0.05 * tick
                place = place if way > 0 else 300.0 - place
                rows.append(f'{clock:.3f},{way * speed},{place:.4f},{way * friction:.6f},0.0,40.0')
                clock += 0.05
            for _ in range(20):
                rows.append(f'{clock:.3f},0.0,{150 + 150 * way},0.0,0.0,40.0')
                clock += 0.05
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text('\n'.join(rows) + '\n')
    mapping = path.with_suffix('.yaml')
    mapping.write_text(MAP.format(epoch=epoch, machine=machine))
    return path, mapping


@pytest.fixture(scope='module')
def collected(tmp_path_factory):
    """Return a folder into which one log was collected, and that log with its map."""
    base = tmp_path_factory.mktemp('collected')
    log, mapping = write_log(base / 'logs' / 'monday.csv')
    folder = base / 'kept'
    assert collect([log], folder, Given(None, mapping, NOMINAL), Workers()) == 0
    return folder, log, mapping


@pytest.fixture
def judgements(monkeypatch):
    """Return the names of the logs that are judged from here on."""
    names, opened = [], health_collect.opened_by_task

    def noted(inputs, reading):
        names.append(Path(inputs['log']).name)
        return opened(inputs, reading)

    monkeypatch.setattr(health_collect, 'opened_by_task', noted)
    return names


def test_an_entry_lies_by_machine_axis_and_day_and_is_small(collected):
    folder, _, _ = collected
    (file,) = folder.rglob('*.parquet')
    assert file.parent == folder / 'machine=mill 3' / 'axis=x' / 'day=2026-01-05'
    assert file.stat().st_size < 16_000
    frame = pl.read_parquet(file)
    assert set(CELL.names) | {'machine', 'axis', 'log', 'facts'} == set(frame.columns)
    assert is_health_folder(folder)
    assert not is_health_folder(file.parent)


def test_an_entry_holds_the_friction_of_the_log(collected):
    """The torque of the log is a number that was written in it."""
    folder, log, _ = collected
    ((key, path),) = axis_folders(folder).items()
    (history,), notes = read_axis(path)
    assert key == history.key == MachineAxis('mill 3', 'x')
    assert notes == []
    assert Path(history.log) == log
    cells = array_of(history.cells)
    motion = cells[cells['kind'] == CellKind.MOTION]
    assert np.abs(motion['motor_torque']) == pytest.approx(FRICTION)
    assert (np.sign(motion['motor_torque']) == motion['direction']).all()
    stroke = cells[cells['kind'] == CellKind.STROKE]
    assert stroke['motor_torque'] == pytest.approx(FRICTION)
    assert len(stroke) == 8  # 300 mm in steps of 40 mm
    assert history.first == 1_767_592_800 * 10**9


def test_a_log_that_is_there_is_not_judged_again(collected, judgements, capsys):
    folder, log, mapping = collected
    given = Given(None, mapping, NOMINAL)
    assert collect([log], folder, given, Workers()) == 0
    assert judgements == []
    assert '0 logs collected' in capsys.readouterr().out


def test_a_log_or_map_that_has_changed_takes_the_place_of_what_was_kept(tmp_path, judgements):
    log, mapping = write_log(tmp_path / 'logs' / 'a.csv')
    folder, given = tmp_path / 'kept', Given(None, mapping, NOMINAL)
    collect([log], folder, given, Workers())
    write_log(log, epoch='2026-01-06T06:00:00Z', friction=0.123456)
    collect([log], folder, given, Workers())
    assert judgements == ['a.csv', 'a.csv']
    (history,), _ = read_axis(next(iter(axis_folders(folder).values())))
    cells = array_of(history.cells)
    motion = cells[cells['kind'] == CellKind.MOTION]
    assert np.abs(motion['motor_torque']) == pytest.approx(0.123456)
    assert len(list(folder.rglob('*.parquet'))) == 1


def test_what_was_stopped_between_two_axes_is_collected_again(collected, tmp_path):
    _, log, mapping = collected
    (files,) = held_logs(collected[0]).values()
    known = identity_of(log, (None, mapping))
    assert health_collect.is_complete(files, known)
    first = [path.with_name(path.name.replace('-0.', '-1.')) for path in files]
    assert not health_collect.is_complete(first, known)


@pytest.fixture(scope='module')
def two_days(tmp_path_factory):
    """Return a folder into which the logs of two days were collected."""
    base = tmp_path_factory.mktemp('two_days')
    for day in (5, 6):
        log, mapping = write_log(base / 'logs' / f'{day}.csv', epoch=f'2026-01-0{day}T06:00:00Z')
        collect([log], base / 'kept', Given(None, mapping, NOMINAL), Workers())
    return base / 'kept'


@pytest.mark.parametrize('damage', ['cut', 'text', 'empty', 'no facts', 'facts'])
def test_a_damaged_entry_hides_only_itself(two_days, tmp_path, damage):
    folder = shutil.copytree(two_days, tmp_path / 'kept')
    bad, good = sorted(folder.rglob('*.parquet'))
    frame = pl.read_parquet(bad)
    if damage == 'cut':
        bad.write_bytes(bad.read_bytes()[:-100])
    elif damage == 'no facts':
        frame.drop('facts').write_parquet(bad)
    elif damage == 'facts':
        frame.with_columns(facts=pl.lit('{"start": "x"}')).write_parquet(bad)
    else:
        bad.write_bytes(b'' if damage == 'empty' else b'no table')
    (path,) = axis_folders(folder).values()
    (history,), (note,) = read_axis(path)
    assert history.first == read_entry(good).first
    assert note.startswith(f'{bad} is damaged and left out (')
    assert note.endswith('): delete it, and collect its log again')


def test_a_log_that_cannot_be_read_stops_no_other_one(tmp_path, capsys):
    log, mapping = write_log(tmp_path / 'logs' / 'good.csv')
    bad = log.with_name('bad.csv')
    bad.write_text('no,table\n')
    folder = tmp_path / 'kept'
    assert collect([bad, log], folder, Given(None, mapping, NOMINAL), Workers()) == 1
    captured = capsys.readouterr()
    assert f'{bad}: column' in captured.err
    assert '1 log collected' in captured.out
    assert len(held_logs(folder)) == 1


def test_two_machines_with_an_axis_of_one_name_stay_apart(tmp_path):
    folder = tmp_path / 'kept'
    for machine in ('mill 3', 'hall/4: mill'):
        log, mapping = write_log(tmp_path / machine[-1] / 'x.csv', machine=f"'{machine}'")
        collect([log], folder, Given(None, mapping, NOMINAL), Workers())
    assert set(axis_folders(folder)) == {('mill 3', 'x'), ('hall/4: mill', 'x')}
    assert [path.parent.parent for path in axis_folders(folder).values()] == [folder] * 2
    for path in axis_folders(folder).values():
        assert len(read_axis(path)[0]) == 1


def test_logs_that_begin_at_one_instant_are_no_history(tmp_path, says):
    folder = tmp_path / 'kept'
    for name in ('a.csv', 'b.csv'):
        log, mapping = write_log(tmp_path / 'logs' / name, epoch='2000-01-01T00:00:00Z')
        collect([log], folder, Given(None, mapping, NOMINAL), Workers())
    histories, _ = read_axis(next(iter(axis_folders(folder).values())))
    logs = sorted(str(tmp_path / 'logs' / name) for name in ('a.csv', 'b.csv'))
    found = sorted(history.log for history in histories)
    assert found == logs
    assert same_start_note(histories, 'x') == says(
        'begin_at_one_instant', first=histories[0].log, second=histories[1].log
    )
    assert same_start_note(histories[:1], 'x') == ''


def test_a_cluster_that_is_lost_ends_in_a_sentence_and_the_next_run_goes_on(
    tmp_path, monkeypatch, capsys
):
    logs = []
    for day in (5, 6, 7):
        log, mapping = write_log(
            tmp_path / 'logs' / f'{day}.csv', epoch=f'2026-01-0{day}T06:00:00Z'
        )
        logs.append(log)
    folder, given = tmp_path / 'kept', Given(None, mapping, NOMINAL)

    class LostPool:
        """A pool that does the first two tasks and then loses its scheduler."""

        def __init__(self, *args, **more):
            self.waiting = []

        def __enter__(self):
            return self

        def __exit__(self, *error):
            pass

        def submit(self, name, task, inputs):
            self.waiting.append((name, inputs))

        def wait(self, seconds):
            if len(self.waiting) == 1:
                raise SurfaceError('the scheduler was lost; run the command again')
            name, inputs = self.waiting.pop(0)
            result = health_collect.collect_task(inputs)
            return [(name, {'result': result, 'sentence': '', 'worker': 'w', 'seconds': 0.0})]

    monkeypatch.setattr(many_logs, 'open_pool', LostPool)
    with pytest.raises(SurfaceError, match='the scheduler was lost'):
        collect(logs, folder, given, Workers(dask='tcp://nowhere:8786'))
    assert len(held_logs(folder)) == 2
    monkeypatch.undo()
    assert collect(logs, folder, given, Workers()) == 0
    assert '1 log collected' in capsys.readouterr().out
    assert len(held_logs(folder)) == 3


def test_the_command_needs_logs_and_a_place(capsys, says):
    assert main(['health', 'collect', 'bags/nominal_cycle']) == 2
    assert main(['health', 'collect', '--out', 'kept']) == 2
    lines = capsys.readouterr().err.splitlines()
    assert [line.partition(': ')[2] for line in lines] == [says('collect_needs')] * 2


@pytest.fixture(scope='module')
def two_machines(tmp_path_factory):
    """Return a folder with weeks of logs of two machines, collected, and the logs."""
    base = tmp_path_factory.mktemp('two_machines')
    folder, logs = base / 'kept', base / 'logs'
    for machine in ('mill 3', 'mill 4'):
        for week in range(8):
            day = datetime.date(2026, 1, 5) + datetime.timedelta(weeks=week)
            epoch = f'{day}T06:00:00Z' if machine == 'mill 3' else '2000-01-01T00:00:00Z'
            log, mapping = write_log(
                logs / machine[-1] / f'{day}.csv', epoch=epoch, machine=machine
            )
            collect([log], folder, Given(None, mapping, NOMINAL), Workers())
    return folder, logs


def test_an_axis_without_dates_is_not_known_and_stops_no_other_one(two_machines, capsys):
    folder, _ = two_machines
    assert main(['health', str(folder), '--json']) == 0
    captured = capsys.readouterr()
    records = json.loads(captured.out)
    assert list(records) == ['x of mill 3', 'x of mill 4']
    assert 'two recordings begin at 2000-01-01' in records['x of mill 4']['verdict']
    assert 'two recordings begin at' not in records['x of mill 3']['verdict']
    assert 'axis x of mill 4: 8 of 8 logs begin at the same instant' in captured.err


def test_collected_logs_and_logs_named_are_assessed_alike(two_machines, tmp_path, capsys):
    folder, logs = two_machines
    assert main(['health', str(folder), '--json']) == 0
    kept = json.loads(capsys.readouterr().out)['x of mill 3']
    text = (
        next((logs / '3').glob('*.yaml'))
        .read_text()
        .replace('time: {', 'date_from: name\ntime: {')
    )
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(re.sub(', epoch: [^}]*', '', text))
    assert main(['health', str(logs / '3'), '--map', str(mapping), '--json']) == 0
    named = json.loads(capsys.readouterr().out)['x']
    assert len(kept['course']) == len(named['course']) == 8
    assert {key: kept['quantities'][key] for key in kept['quantities']} == named['quantities']
    assert kept['condition'] == named['condition']


def test_an_axis_that_is_named_twice_is_refused(two_machines, tmp_path, capsys):
    folder, _ = two_machines
    other = tmp_path / 'copy'
    shutil.copytree(folder, other)
    assert main(['health', str(folder), str(other)]) == 2
    assert 'stands in' in capsys.readouterr().err


def test_health_survives_plain_data():
    health = Health(
        axis='x',
        stamp=5,
        condition=Condition.WORSE,
        verdict='a verdict',
        since=3,
        quantities=[Quantity(name='a', value=1.0, low=0.5, high=2.0), Quantity(name='b')],
        causes=[
            Cause(
                code=CauseCode.WIPER,
                size=Quantity(name='c', unit='N m', value=0.1),
                weight=0.7,
                excluded=False,
                text='a wiper',
            )
        ],
        baseline=Baseline(begin=1, end=2, reason='named'),
        notes=['a note'],
        usual_warnings=(UsualWarning(Code.RCS_HIGH, 3, -2, 1),),
    )
    plain = json.loads(json.dumps(to_json(dataclasses.asdict(health))))
    again = record_of(Health, plain)
    assert repr(again) == repr(health)
