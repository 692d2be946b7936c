# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The subcommand `figures` as a user types it."""

import pytest
from surrogate.files import InputError

COMMAND = ('figures',)

pytest.importorskip('matplotlib')


def test_one_figure(run, tmp_path, capsys):
    """The torque over speed: picture, rows, table; the second run solves none."""
    assert run('--out', tmp_path, '--only', '6b') == 0
    said = capsys.readouterr()
    assert '| friction torque [mN m], preload only |' in said.out
    assert said.out == (tmp_path / 'paper.md').read_text(encoding='utf-8')
    assert '/12 solves, ' in said.err
    assert str(tmp_path / 'paper_06b_torque.png') in said.err
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {'paper.csv', 'paper.csv.store', 'paper.md', 'paper_06b_torque.png'}
    assert run('--out', tmp_path, '--only', '6b') == 0
    assert ' solves, ' not in capsys.readouterr().err


@pytest.mark.parametrize(
    ('words', 'sentence'),
    [
        (('--only', '6a'), "figure is '6a', allowed are 6b, 11"),
        (('--draws', '0'), 'draws is 0, allowed is 1 or more'),
    ],
)
def test_bad_input_is_one_sentence(run, tmp_path, words, sentence):
    with pytest.raises(InputError, match=sentence):
        run('--out', tmp_path / 'out', *words)
    assert not (tmp_path / 'out').exists()
