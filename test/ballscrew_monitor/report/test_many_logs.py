# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Several recordings: how far they are, and reports of them on a Dask cluster."""

import shutil

from ballscrew_monitor import cli
from ballscrew_monitor.report import many_logs
from ballscrew_monitor.report.many_logs import LogsProgress, size_of
import pytest

TABLE_MAP = """
log: log.csv
time: {column: t, unit: s, epoch: '2026-01-01T00:00:00Z'}
axes:
  x:
    speed: {column: v, unit: rad/s}
    load: {column: f, unit: N}
    lead_mm: 10.0
"""


class Shown:
    """Takes what a bar would show."""

    def __init__(self):
        self.lines = []

    def show(self, done, total, *, share):
        self.lines.append((done, total, share))


def test_a_long_recording_among_short_ones_is_seen_to_go():
    shown = Shown()
    progress = LogsProgress({'long': 900, 'short': 50, 'bad': 50}, shown)
    progress.done('bad')
    progress.tell('long', 0.5)
    progress.tell('long', 0.4)  # a worker was lost, another one began again
    progress.tell('of another run', 0.5)
    progress.done('short')
    progress.done('long')
    assert shown.lines == [(1, 3, 0.05), (1, 3, 0.5), (1, 3, 0.5), (2, 3, 0.55), (3, 3, 1.0)]


def test_the_passes_over_a_table_count_for_half_of_it(monkeypatch):
    told = []
    monkeypatch.setattr(many_logs, 'tell_share', told.append)
    table, bag = many_logs.ReadingShare(), many_logs.ReadingShare()
    for unit in ('rows looked through', 'times looked through'):
        with table(1000, unit) as show:
            show(0.5)
            show(1.0)
    table.tell_judged(0.5)
    bag.tell_judged(0.5)
    assert told == pytest.approx([1 / 8, 2 / 8, 3 / 8, 0.5, 0.75, 0.5])


def test_a_table_among_many_recordings_tells_how_far_it_is(monkeypatch, tmp_path):
    told = []
    monkeypatch.setattr(many_logs, 'tell_share', told.append)
    rows = (f'{0.01 * row:.2f},{10.0 + row % 7},-500\n' for row in range(200))
    (tmp_path / 'log.csv').write_text('t,v,f\n' + ''.join(rows))
    (tmp_path / 'map.yaml').write_text(TABLE_MAP)
    inputs = {
        'log': str(tmp_path / 'log.csv'),
        'out': str(tmp_path / 'out'),
        'params': None,
        'map': str(tmp_path / 'map.yaml'),
        'nominal': '',
    }
    assert many_logs.report_task(inputs)['unjudged'] == []
    assert told == sorted(told)
    assert {0.5, 1.0} <= set(told)
    assert told[0] < 0.5


def test_a_recording_that_is_not_there_or_empty_has_a_size_too(tmp_path):
    (tmp_path / 'bag').mkdir()
    assert size_of(tmp_path / 'gone.mcap') == size_of(tmp_path / 'bag') == 1
    for name in ('a.mcap', 'b.mcap'):
        (tmp_path / 'bag' / name).write_bytes(bytes(50))
    assert size_of(tmp_path / 'bag') == 100


def test_a_cluster_makes_the_reports_that_can_be_made(short_bag, dask_address, tmp_path, capsys):
    for name in ('first', 'second'):
        shutil.copytree(short_bag, tmp_path / 'logs' / name)
    (tmp_path / 'logs' / 'broken.mcap').write_bytes(b'no recording')
    out = tmp_path / 'out'
    arguments = ['replay', str(tmp_path / 'logs'), '--out', str(out)]
    assert cli.main([*arguments, '--dask', dask_address]) == 1
    shown = capsys.readouterr()
    assert 'broken.mcap: bag' in shown.err
    assert '3/3 recordings' in shown.err
    assert '3 recordings, 1 bad' in shown.out
    assert sorted(path.name for path in out.iterdir()) == ['first', 'index.html', 'second']
    for name in ('first', 'second'):
        assert {'report.html', 'states.parquet'} <= {p.name for p in (out / name).iterdir()}
