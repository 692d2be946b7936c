# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `figures` as a user types it."""

import pytest
from surrogate.commands.figures import read_measured
from surrogate.files import InputError

COMMAND = ('figures',)

pytest.importorskip('matplotlib')


def test_one_figure(run, tmp_path, capsys, says):
    """The smooth contact over speed: picture, rows, fields, table; the second run solves none."""
    assert run('--out', tmp_path, '--only', '7') == 0
    said = capsys.readouterr()
    assert says('central_film_smooth') in said.out
    assert said.out == (tmp_path / 'paper.md').read_text(encoding='utf-8')
    assert said.err.count(' solves, ') == 4
    assert str(tmp_path / 'paper_07_smooth_speed.png') in said.err
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {'paper.csv', 'paper.csv.store', 'paper.md', 'paper_07_smooth_speed.png'}
    assert run('--out', tmp_path, '--only', '7') == 0
    assert ' solves, ' not in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        (('--only', '6a'), "figure is '6a', allowed are 4, 6b"),
        (('--draws', '0'), 'draws is 0, allowed is 1 or more'),
        (('--only', '7', '--measured', 'none.csv'), '--measured: none.csv cannot be read'),
    ],
)
def test_bad_input_is_one_sentence(run, tmp_path, words, sentence):
    with pytest.raises(InputError, match=sentence):
        run('--out', tmp_path / 'out', *words)
    assert not (tmp_path / 'out').exists()


def test_measurements_are_read_and_refused(tmp_path):
    path = tmp_path / 'torque.csv'
    path.write_text('speed_rev_min,torque_Nm\n60,0.2\n', encoding='utf-8')
    assert [values.tolist() for values in read_measured(path)] == [[60.0], [0.2], [0.0]]
    for text in (
        *('speed,torque_Nm\n60,0.2\n', 'speed_rev_min,torque_Nm\nx,1\n'),
        *('speed_rev_min,torque_Nm\n0,1\n', 'speed_rev_min,torque_Nm\n'),
    ):
        path.write_text(text, encoding='utf-8')
        with pytest.raises(InputError, match=r'needs numbers|could not convert'):
            read_measured(path)
