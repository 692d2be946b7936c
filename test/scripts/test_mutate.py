# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mutants: which changes are tried, and that they run without touching the tree."""

from pathlib import Path
import runpy

import pytest

TREE = Path(__file__).resolve().parents[2]
DEADLINE = 600.0  # [s] which only ends a hang
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
    return runpy.run_path(str(TREE / 'scripts' / 'mutate.py'))


@pytest.fixture
def mutate(script, tmp_path):
    for function in ('mutants', 'tests_of', 'substitute'):
        script[function].__globals__['TREE'] = tmp_path
    (tmp_path / 'half.py').write_text(SOURCE)
    (tmp_path / 'test').mkdir()
    (tmp_path / 'test' / 'test_half.py').write_text(TEST)
    return script


def test_each_operator_and_number_is_changed_once_and_no_text_or_type(mutate, tmp_path):
    found = list(mutate['mutants'](tmp_path / 'half.py'))
    assert {one.name for one in found if one.after == '(2.5)'} == {
        'half.py half: 2.0 -> (2.5) in return -x / 2.0  # of µ'
    }
    assert [f'{one.before} -> {one.after}' for one in found] == [
        'not x < 2 or x is None -> (not x < 2 and x is None)',
        'not x < 2 -> (x < 2)',
        'x < 2 -> (x <= 2)',
        '2 -> (3)',
        'x is None -> (x is not None)',
        '-x / 2.0 -> (-x * 2.0)',
        '-x -> (x)',
        '2.0 -> (2.5)',
    ]
    content = (tmp_path / 'half.py').read_bytes()
    for one in found:
        assert content[slice(one.begin, one.end)].decode() == one.before


def test_a_mutant_is_noticed_or_not_and_the_file_stays(mutate, tmp_path):
    found = list(mutate['mutants'](tmp_path / 'half.py'))
    assert mutate['passes']('half.py', None, DEADLINE)
    noticed = [not mutate['passes']('half.py', one, DEADLINE) for one in found]
    assert noticed == [False, True, False, False, True, True, True, True]
    assert (tmp_path / 'half.py').read_text() == SOURCE


def test_every_source_but_pictures_has_tests(script):
    files = {path for room in script['ROOMS'] for path in (TREE / room).glob('*.py')}
    names = {str(path.relative_to(TREE)) for path in files if list(script['mutants'](path))}
    assert set(script['PICTURES']) | {*script['COMPILING'], script['KERNELS']} <= names
    tests = {name: script['tests_of'](name) for name in names - set(script['PICTURES'])}
    assert all(tests.values())
    for name, others in script['COVERED'].items():
        named = {str(Path('test', name).with_name(f'test_{one}.py')) for one in others.split()}
        assert named <= set(tests[name])


def test_equivalents_are_mutants_and_have_a_reason(script):
    for line in script['EQUIVALENT'].read_text().splitlines():
        name, _, reason = line.partition('  # ')
        assert reason
        assert name in {one.name for one in script['mutants'](TREE / name.split()[0])}
