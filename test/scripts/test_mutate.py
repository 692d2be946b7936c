# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Mutants: which changes are tried, which tests run, and that results are kept."""

from collections import Counter
import importlib
from pathlib import Path
import shutil
import sys
import time

import pytest

TREE = Path(__file__).resolve().parents[2]
LIMIT = 600.0  # [s] which only ends a hang
SOURCE = '''\
def half(x: 'float | 2') -> 'x + 1':
    """Return a half: 1 + 1."""
    if not x < 2 or x is None:
        raise ValueError(f'{x + 1}')
    return -x / 2.0  # of µ
'''
TEST = """\
from pathlib import Path

from importlib.machinery import SourceFileLoader

def call(x):
    source = str(Path(__file__).parents[2] / 'surrogate' / 'half.py')
    scope = {}
    exec(SourceFileLoader('half', source).get_code('half'), scope)
    return scope['half'](x)

def test_half():
    assert call(1.0) == -0.5

def test_zero():
    assert call(0.0) == 0.0
"""
MODULES = ('mutants', 'mutant_tests', 'mutate')


@pytest.fixture
def scripts(monkeypatch):
    """Return the three scripts as fresh modules."""
    monkeypatch.syspath_prepend(str(TREE / 'scripts'))
    for name in MODULES:
        monkeypatch.delitem(sys.modules, name, raising=False)
    yield {name: importlib.import_module(name) for name in MODULES}
    for name in MODULES:
        sys.modules.pop(name)


@pytest.fixture
def small(scripts, monkeypatch, tmp_path):
    """Return them at work in a tree of one source and one file of tests."""
    for module in scripts.values():
        monkeypatch.setattr(module, 'TREE', tmp_path)
    monkeypatch.setattr(scripts['mutants'], 'EQUIVALENT', tmp_path / 'equivalent.txt')
    monkeypatch.setattr(scripts['mutate'], 'RESULTS', tmp_path / 'build')
    (tmp_path / 'equivalent.txt').touch()
    for path, text in (('surrogate/half.py', SOURCE), ('test/surrogate/test_half.py', TEST)):
        (tmp_path / path).parent.mkdir(parents=True)
        (tmp_path / path).write_text(text)
    return scripts


def test_each_operator_and_number_is_changed_once_and_no_text_or_type(small, tmp_path):
    mutants = list(small['mutants'].mutants(tmp_path / 'surrogate/half.py'))
    assert {mutant.name for mutant in mutants if mutant.after == '(2.5)'} == {
        'surrogate/half.py half: 2.0 -> (2.5) in return -x / 2.0  # of µ'
    }
    assert [f'{mutant.before} -> {mutant.after}' for mutant in mutants] == [
        'not x < 2 or x is None -> (not x < 2 and x is None)',
        'not x < 2 -> (x < 2)',
        'x < 2 -> (x <= 2)',
        '2 -> (3)',
        'x is None -> (x is not None)',
        '-x / 2.0 -> (-x * 2.0)',
        '-x -> (x)',
        '2.0 -> (2.5)',
    ]
    content = (tmp_path / 'surrogate/half.py').read_bytes()
    for mutant in mutants:
        assert content[slice(mutant.begin, mutant.end)].decode() == mutant.before


def test_like_changes_of_a_line_have_names_of_their_own(small, tmp_path):
    path = tmp_path / 'surrogate/half.py'
    path.write_text('ORIGIN = (0.0, 0.0)\n')
    assert [mutant.name for mutant in small['mutants'].mutants(path)] == [
        'surrogate/half.py : 0.0 -> (1.0) in ORIGIN = (0.0, 0.0)',
        'surrogate/half.py : 0.0 -> (1.0) in ORIGIN = (0.0, 0.0) (2)',
    ]


def test_a_sample_has_the_share_of_each_room_and_no_equivalent(scripts, monkeypatch, tmp_path):
    mutants, equivalent = scripts['mutants'], tmp_path / 'equivalent.txt'
    monkeypatch.setattr(mutants, 'EQUIVALENT', equivalent)
    equivalent.touch()
    files = mutants.sources(['surrogate/ehl', 'surrogate/raceway'])
    sample = mutants.sample(files, 100, seed=2)
    assert len(sample) == 100
    assert sample == mutants.sample(files, 100, seed=2) != mutants.sample(files, 100, seed=3)
    rooms = Counter(mutant.room for path in files for mutant in mutants.mutants(path))
    drawn = Counter(mutant.room for mutant in sample)
    for room, number in rooms.items():
        assert abs(drawn[room] - 100 * number / rooms.total()) < 2, room
    equivalent.write_text(f'{sample[7].name}  # changes nothing\n')
    assert mutants.sample(files, 100, seed=2) == sample[:7] + sample[8:]


def test_a_mutant_is_noticed_or_not_and_the_file_stays(small, tmp_path):
    mutants = list(small['mutants'].mutants(tmp_path / 'surrogate/half.py'))
    files = ['test/surrogate/test_half.py']
    runs = [small['mutate'].run_tests(files, one, 'kept', LIMIT) for one in [None, *mutants]]
    caught = ['caught' if caught else 'survived' for caught in (0, 0, 1, 0, 0, 1, 1, 1, 1)]
    assert [run.verdict for run in runs] == caught
    assert [name.rpartition('::')[2] for name in runs[2].failed] == ['test_half', 'test_zero']
    assert (tmp_path / 'surrogate/half.py').read_text() == SOURCE


def test_results_are_kept_and_a_second_call_goes_on(small, monkeypatch, capsys):
    mutate = small['mutate']
    arguments = ['mutate.py', 'surrogate', '--sample', '4']
    monkeypatch.setattr(sys, 'argv', arguments)
    assert mutate.main() == 1
    output = capsys.readouterr().out
    survivors = output.count(', survived: ')
    assert survivors in (1, 2)  # of each pair of neighbours one is drawn
    assert f'{4 - survivors} of 4 mutants caught' in output
    kept = mutate.Lines('sample.tsv')
    with kept.path.open('a') as file:
        file.write('a line that was interru')
    assert mutate.main() == 1
    assert ', 0 min, ' not in capsys.readouterr().out
    monkeypatch.setattr(sys, 'argv', [*arguments, '--again'])
    mutate.main()
    assert capsys.readouterr().out.count(', survived: ') == survivors
    assert len(kept.read()) == 4 + 1 + survivors


def test_a_matrix_tells_which_test_notices_alone(small, monkeypatch, tmp_path, capsys):
    """A test that fails without any mutant notices none."""
    with (tmp_path / 'test/surrogate/test_half.py').open('a') as file:
        file.write('\ndef test_never():\n    assert False\n')
    monkeypatch.setattr(sys, 'argv', ['mutate.py', 'surrogate', '--sample', '8', '--matrix'])
    assert small['mutate'].main() == 0
    assert 'test_never fails without any mutant' in capsys.readouterr().out
    _, *rows = (tmp_path / 'build' / 'tests.tsv').read_text().splitlines()
    counts = {row.rpartition('::')[2]: row.split('\t')[:2] for row in rows}
    assert counts == {'test_never': ['0', '0'], 'test_zero': ['0', '2'], 'test_half': ['3', '5']}


def test_tests_are_found_by_mirror_then_by_imports(small, tmp_path):
    for path, text in (
        ('surrogate/deep/core.py', 'X = 1\n'),
        ('surrogate/shell.py', 'from surrogate.deep.core import X\n'),
        ('test/surrogate/deep/test_core.py', ''),
        ('test/surrogate/deep/test_a_neighbour.py', ''),
        ('test/surrogate/test_direct.py', 'def test():\n    import surrogate.deep.core\n'),
        ('test/surrogate/test_over_shell.py', 'from surrogate import shell\n'),
        ('test/surrogate/far/conftest.py', 'NAME = "surrogate.deep.core"\n'),
        ('test/surrogate/far/test_fixture.py', ''),
        ('test/surrogate/far/deep/test_core.py', ''),
    ):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    assert small['mutant_tests'].candidates('surrogate/deep/core.py') == [
        f'test/surrogate/{name}.py'
        for name in (
            'deep/test_core',
            'test_direct',
            'deep/test_a_neighbour',
            'far/deep/test_core',
            'far/test_fixture',
            'test_over_shell',
        )
    ]


def test_every_source_has_tests(scripts):
    names = [str(path.relative_to(TREE)) for path in scripts['mutants'].sources()]
    assert [name for name in names if not scripts['mutant_tests'].candidates(name)] == []
    assert set(scripts['mutate'].COMPILING) <= set(names)


def test_equivalents_are_mutants_and_have_a_reason(scripts):
    mutants = scripts['mutants']
    for line in mutants.EQUIVALENT.read_text().splitlines():
        name, _, reason = line.partition('  # ')
        assert reason
        assert name in {mutant.name for mutant in mutants.mutants(TREE / name.split()[0])}


def test_nothing_is_left_over_of_a_run(small, tmp_path):
    shutil.rmtree(tmp_path / 'test')
    path = tmp_path / 'test' / 'surrogate' / 'test_half.py'
    path.parent.mkdir(parents=True)
    path.write_text(
        'import os, signal, subprocess\n'
        'def test_child():\n'
        "    child = subprocess.Popen(['sleep', '600'])\n"
        f"    open({str(tmp_path / 'pid')!r}, 'w').write(str(child.pid))\n"
        '    os.kill(os.getpid(), signal.SIGXCPU)\n'
    )
    run = small['mutate'].run_tests(['test/surrogate/test_half.py'], None, 'kept', LIMIT)
    assert run.verdict == 'too long'
    child = Path('/proc', (tmp_path / 'pid').read_text(), 'stat')
    end = time.monotonic() + LIMIT
    while not is_over(child) and time.monotonic() < end:  # what is killed ends a little later
        time.sleep(0.01)
    assert is_over(child)


def is_over(process):
    """Return True for a process, by its file of /proc, that has ended or is ending."""
    try:
        return process.read_text().split()[2] in 'ZX'
    except OSError:
        return True
