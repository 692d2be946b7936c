# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The validate command as a user types it, on a short record."""

import json

import pytest
from surrogate.studies import validation

COMMAND = ('validate',)
RECORD = {
    'screw': 'nominal',
    'comparisons': [
        {
            'what': 'film ratio at the onset',
            'source': 'someone 2012',
            'read': 'abstract',
            'published': [0.6, 1.2],
            'tolerance': 0.1,
            'ours': [0.9],
            'unit': '',
            'verdict': 'agrees',
            'reason': 'made up',
        }
    ],
    'without_number': ['nothing'],
    'rolling': [],
    'rolling_over_width': {1.3: 0.94, 6.0: 1.26},
    'torque_Nm': {'plain': 0.11},
}


@pytest.fixture(autouse=True)
def short(monkeypatch):
    """Compute nothing."""
    monkeypatch.setattr(validation, 'validation_record', lambda: RECORD)


def test_the_file_is_what_is_printed(run, tmp_path, capsys):
    path = tmp_path / 'page.md'
    assert run('--out', path) == 0
    printed = capsys.readouterr().out
    assert path.read_text(encoding='utf-8') == printed
    assert '| abstract | 0.60 to 1.20 ± 10 % | 0.90 | agrees | made up |' in printed
    assert '| plain | 0.110 |' in printed


def test_the_record_as_json(run, capsys):
    assert run('--json') == 0
    assert json.loads(capsys.readouterr().out)['comparisons'][0]['ours'] == [0.9]


def test_a_file_that_cannot_be_written_is_one_sentence(run, tmp_path, refused):
    (tmp_path / 'none').write_text('no folder', encoding='utf-8')
    refused('out_no_folder', run, '--out', tmp_path / 'none' / 'page.md')
