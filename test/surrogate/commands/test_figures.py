# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `figures` as a user types it."""

import argparse

import pytest
from surrogate.cli import add_commands
from surrogate.commands.figures import progress_line
from surrogate.files import InputError
from surrogate.paper.cases import Task

pytest.importorskip('matplotlib')


def run(*words: str) -> int:
    """Run one command line."""
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers(required=True))
    args = parser.parse_args(words)
    return args.handler(args)


def test_one_figure(tmp_path, capsys):
    """The smooth contact over speed: picture, rows, fields, table; the second run solves none."""
    assert run('figures', '--out', str(tmp_path), '--only', '7') == 0
    said = capsys.readouterr()
    assert '| central film, smooth, 502.65 mm/s, preload only | 152.4 nm | 153 nm' in said.out
    assert said.err.count(' solves, ') == 4
    assert str(tmp_path / 'paper_07_smooth_speed.png') in said.err
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {'paper.csv', 'paper_fields', 'paper_07_smooth_speed.png'}
    assert run('figures', '--out', str(tmp_path), '--only', '7') == 0
    assert ' solves, ' not in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        (('--only', '6a'), "figure is '6a', allowed are 4, 6b"),
        (('--draws', '0'), 'draws is 0, allowed is 1 or more'),
        (('--only', '7', '--measured', 'none.csv'), '--measured: none.csv cannot be read'),
    ],
)
def test_bad_input_is_one_sentence(tmp_path, words, sentence):
    """Before anything is solved."""
    with pytest.raises(InputError, match=sentence):
        run('figures', '--out', str(tmp_path / 'out'), *words)
    assert not (tmp_path / 'out').exists()


def test_progress_tells_rate_and_time_left():
    """A quarter done in 10 s leaves 30 s."""
    task = Task(kind='screw', rpm=5.0, load=50.0, draw=0)
    line = progress_line(3, 8, 0.25, 10.0, task)
    assert line.startswith('[######                  ] 3/8 solves, 18 per min, 30 s left')
    assert line.endswith('screw 5 rev/min 50 N')
