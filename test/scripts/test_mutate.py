# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mutants: which changes are tried, and that they run without touching the tree."""

from pathlib import Path
import runpy

import pytest

TREE = Path(__file__).resolve().parents[2]
SOURCE = '''\
def half(x: 'float | 2') -> 'x + 1':
    """Return a half: 1 + 1."""
    if not x < 2 or x is None:
        raise ValueError(f'{x + 1}')
    return -x / 2.0  # of µ
'''
TEST = """\
from pathlib import Path
import runpy

from importlib.machinery import SourceFileLoader

def test_half():
    source = str(Path(__file__).parents[1] / 'half.py')
    scope = {}
    exec(SourceFileLoader('half', source).get_code('half'), scope)
    assert scope['half'](1.0) == -0.5
"""


@pytest.fixture
def script():
    """Return the names of the script."""
    return runpy.run_path(str(TREE / 'scripts' / 'mutate.py'))


@pytest.fixture
def mutate(script, tmp_path):
    """Return the names of the script, at work on a tree of one file."""
    for function in ('mutants', 'mirror', 'substitute'):
        script[function].__globals__['TREE'] = tmp_path
    (tmp_path / 'half.py').write_text(SOURCE)
    (tmp_path / 'test').mkdir()
    (tmp_path / 'test' / 'test_half.py').write_text(TEST)
    return script


def test_each_operator_and_number_is_changed_once_and_no_text_or_type(mutate, tmp_path, says):
    found = list(mutate['mutants'](tmp_path / 'half.py'))
    assert [one.name.partition(': ')[2] for one in found] == [
        says('2_none_2'),
        'not x < 2 -> (x < 2)',
        'x < 2 -> (x <= 2)',
        '2 -> (3)',
        'x is None -> (x is not None)',
        '-x / 2.0 -> (-x * 2.0)',
        '-x -> (x)',
        '2.0 -> (2.5)',
    ]
    assert {one.name.partition(': ')[0] for one in found} == {'half.py half'}
    content = (tmp_path / 'half.py').read_bytes()
    for one in found:
        assert content[slice(one.begin, one.end)].decode() == one.before


def test_a_mutant_is_noticed_or_not_and_the_file_stays(mutate, tmp_path):
    found = list(mutate['mutants'](tmp_path / 'half.py'))
    tests = mutate['mirror']('half.py')
    assert mutate['passes'](tests, None, 60.0)
    noticed = [not mutate['passes'](tests, one, 60.0) for one in found]
    assert noticed == [False, True, False, False, True, True, True, True]
    assert (tmp_path / 'half.py').read_text() == SOURCE


def test_equivalents_are_mutants_and_have_a_reason(script):
    for line in script['EQUIVALENT'].read_text().splitlines():
        name, _, reason = line.partition('  # ')
        assert reason
        assert name in {one.name for one in script['mutants'](TREE / name.split()[0])}
