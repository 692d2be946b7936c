# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
All that the online half says of the same inputs is what is on file, see README.md.

Where a change is meant, record the outputs again and read how they differ.

"""

from ballscrew_monitor.node.compiled_turns import CompiledTurns
from golden import compare
from golden.cases import CASES, node_runs
import numpy as np
import pytest

TEXT = 'axis x: 20 samples\nefficiency = 0.8725000000000001, 41 N\nstands still\n'
TABLE = {
    'stamp': np.arange(4, dtype=np.int64),
    'rcs': np.array([np.nan, 0.0, 2.5e-3, -np.inf]),
    'level': np.array(['OK', 'OK', 'WARN', 'OK']),
}


@pytest.mark.parametrize('case', CASES)
def test_outputs_are_those_on_file(case, tmp_path):
    said = compare.compare_all(case, CASES[case](tmp_path))
    text = ''.join('\n  '.join([f'\n{case}/{name}:', *how]) for name, how in said.items())
    assert not said, text


@pytest.mark.long
def test_turns_that_are_judged_compiled_say_the_same(tmp_path, monkeypatch):
    monkeypatch.setattr(CompiledTurns, 'are_due', True)
    recorded = compare.recorded_outputs('live')
    for name, said in node_runs(tmp_path).items():
        assert compare.differences(recorded.get(name), said) == [], name


def test_no_case_is_on_file_alone():
    assert sorted(path.name for path in compare.DATA.iterdir()) == sorted(CASES)


def changed(column, row, value):
    """Return the table with one other value."""
    table = {name: values.copy() for name, values in TABLE.items()}
    table[column][row] = value
    return table


@pytest.mark.parametrize(
    'other',
    [
        TEXT.replace('0.8725000000000001', '0.8725000010000001'),
        TEXT.replace('41 N', '42 N'),
        TEXT.replace('stands', 'stood'),
        TEXT.replace('axis x: 20 samples\n', ''),
        TEXT.replace('0.8725000000000001', 'nan'),
        f'{TEXT}one more\n',
    ],
)
def test_another_text_is_noticed(other):
    assert other != TEXT
    assert compare.differences(TEXT, other)
    assert compare.differences(other, TEXT)


@pytest.mark.parametrize(
    'other',
    [
        changed('rcs', 2, 2.5e-3 * (1.0 + 1e-9)),
        changed('rcs', 0, 0.0),
        changed('rcs', 3, np.inf),
        changed('stamp', 1, 2),
        changed('level', 2, 'OK'),
        {name: values[:-1] for name, values in TABLE.items()},
        {name: values for name, values in TABLE.items() if name != 'level'},
        TEXT,
        None,
    ],
)
def test_another_table_is_noticed(other):
    assert compare.differences(TABLE, other)
    assert compare.differences(other, TABLE)


def test_rounding_is_no_difference():
    assert compare.differences(TEXT, TEXT.replace('0.8725000000000001', '0.8725')) == []
    assert compare.differences(TABLE, changed('rcs', 2, 2.5e-3 * (1.0 + 1e-15))) == []
    assert compare.differences('rest = 0.0', 'rest = 1.7e-19') == []


def test_a_difference_names_its_line_or_row():
    (said,) = compare.differences(TEXT, TEXT.replace('41 N', '42 N'))
    assert said.startswith('line 2:\n')
    (said,) = compare.differences(TABLE, changed('level', 2, 'OK'))
    assert said == "row 2, level: recorded 'WARN', found 'OK'"
    many = compare.differences('a\n' * 99, 'b\n' * 99)
    assert many[-1] == f'and {99 - compare.SHOWN} more'


@pytest.mark.parametrize(
    ('text', 'wanted'),
    [
        ('in {folder}/report: {tree}/config', 'in <folder>/report: <tree>/config'),
        (
            'surface 0c313d8bef0b4ad2, 1767600002060000000 ns',
            'surface <hash>, 1767600002060000000 ns',
        ),
        ('efficiency = 2.345678901234567e-05', 'efficiency = 2.345678901234567e-05'),
        ('version 0.23.1 of 127.0.0.1', 'version <version> of 127.0.0.1'),
        ('3/54 s of the recording, 13.5 per s, 0 s left\nthen\n', 'then\n'),
        ('2026-01-05T08:00:00.123+00:00  x', '<written at>  x'),
    ],
)
def test_what_differs_by_run_is_masked(text, wanted, tmp_path):
    given = text.format(folder=tmp_path, tree=compare.TREE)
    assert compare.masked(given, tmp_path) == wanted


def test_what_is_on_file_comes_back_and_only_differences_are_written(tmp_path, monkeypatch):
    monkeypatch.setattr(compare, 'DATA', tmp_path)
    assert compare.keep('one', {'text': TEXT, 'table': TABLE}).keys() == {'text', 'table'}
    recorded = compare.recorded_outputs('one')
    assert recorded['text'] == TEXT
    assert compare.differences(recorded['table'], TABLE) == []
    before = {path.name: path.stat().st_mtime_ns for path in (tmp_path / 'one').iterdir()}
    near = {'text': TEXT.replace('0.8725000000000001', '0.8725'), 'table': TABLE}
    assert compare.keep('one', near) == {}
    assert before == {path.name: path.stat().st_mtime_ns for path in (tmp_path / 'one').iterdir()}
    assert compare.keep('one', {'table': changed('stamp', 1, 2), 'new': TEXT}).keys() == {
        'text',
        'table',
        'new',
    }
    assert sorted(path.name for path in (tmp_path / 'one').iterdir()) == ['new.txt', 'table.npz']
