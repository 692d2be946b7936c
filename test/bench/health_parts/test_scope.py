# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A year of exports with relative times, from the first map to the sentence about the axis."""

import contextlib
import io
import json
import re

from ballscrew_monitor.cli import main
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.report import health_collect
from health_parts.axis_year import axis_year
from health_parts.faults import FAULTS
from health_parts.scope import write_year
import pytest

SEED = 7001
GUESSED = '  x.lead_mm: {value: 10.0, reason: the log does not say it; that of nominal}\n'


@pytest.fixture(scope='module')
def year():
    return axis_year(SEED, FAULTS['preload -40 %'])


@pytest.fixture(scope='module')
def logs(year, tmp_path_factory):
    """Return a year of weekly exports."""
    return write_year(year, tmp_path_factory.mktemp('year'))


def guessed_map(log):
    """Return the map that the command proposes for a log."""
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert main(['import', str(log), '--guess']) == 0
    return said.getvalue()


@pytest.fixture(scope='module')
def first_map(logs):
    """Return the map that is proposed for the third week of the year."""
    return guessed_map(logs[2])


def corrected(text, year, **places):
    """Return a first map with the lead of the screw, and other texts in some places."""
    assert GUESSED in text
    lead = f'  x:\n    lead_mm: {1e3 * year.machine.size.lead}\n'
    text = text.replace(GUESSED, '').replace('  x:\n', lead, 1)
    for old, new in places.items():
        text = re.sub(old, new, text)
    return text


def test_the_first_map_dates_the_logs_by_their_heads(first_map, year, tmp_path):
    assert 'date_from: header' in first_map
    assert 'order: dmy' in first_map  # 15-1-2025
    path = tmp_path / 'map.yaml'
    path.write_text(corrected(first_map, year))
    assert read_map(path).date_from == 'header'


def test_a_year_of_exports_tells_the_loss_and_its_date(
    logs, first_map, year, capsys, tmp_path, monkeypatch
):
    """The fault begins on 2 July and takes 56 days; 40 % less preload is the truth."""
    some = [str(path) for path in logs[::3]]
    monkeypatch.setattr(health_collect, 'FEW', len(some))  # in this process
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(corrected(first_map, year))
    assert main(['health', *some, '--map', str(mapping), '--json']) == 0
    captured = capsys.readouterr()
    record = json.loads(captured.out)['x']
    assert len(record['course']) == len(some)
    drag, truth = record['quantities']['drag change'], year.truth.change(slice(0, 13))[-4:]
    assert drag['low'] <= truth.mean() <= drag['high']
    assert record['condition'] == 'worse'
    assert re.search(r'since about \d+ (July|August) 2025 its friction is', record['verdict'])
    assert 'preload is lost' in record['verdict']
    assert captured.err.count('the lead is') <= 1


def test_a_map_that_takes_the_torque_for_a_load_says_so(capsys, tmp_path):
    bare = axis_year(SEED, load=False, temperature=False, days=21.0)
    paths = write_year(bare, tmp_path / 'logs')
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(corrected(guessed_map(paths[2]), bare))
    assert main(['health', str(paths[0].parent), '--map', str(mapping)]) == 0
    said = capsys.readouterr().out
    assert 'the map takes the motor torque for the load' in said
    assert 'no torque was measured' not in said


def test_what_has_one_reason_stands_in_one_line(year, capsys, tmp_path):
    """The nominal sheet has no rating, which five quantities need."""
    paths = write_year(axis_year(SEED, days=21.0), tmp_path / 'logs')
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(corrected(guessed_map(paths[2]), year))
    assert main(['health', str(paths[0].parent), '--map', str(mapping)]) == 0
    assert capsys.readouterr().out.count('the sheet has no dynamic_rating_kN') == 1


def test_logs_that_fail_alike_are_told_once(year, logs, first_map, capsys, tmp_path):
    """Weeks whose day and month may be changed over, by a map that does not tell their order."""
    mapping = tmp_path / 'map.yaml'
    text = corrected(first_map, year, **{', order: dmy': ''})
    mapping.write_text(text)
    some = [str(path) for path in logs[1:8]]
    assert main(['health', *some, '--map', str(mapping)]) == 0
    said = capsys.readouterr().err
    assert said.count('state time: {order: dmy} or time: {order: mdy} in the map') == 2
    assert '3 logs in all cannot be read' in said
