# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Count of the sources on a small tree, and the two lines that `make test` prints."""

from pathlib import Path
import runpy
import sys

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / 'scripts' / 'count.py'
TOP = """\
# A comment.
'''A module.'''

from surrogate.film import _shared


def main():
    '''
    Print a text.

    '''
    text = '''two
lines'''  # of code

    print(text, _shared())
"""
FILM = """\
from dataclasses import dataclass
import typing

@dataclass(frozen=True)
class Film:
    thickness: float

    def _twice(self):
        return self._half() + self._half()

    def _half(self):
        return 0.5 * self.thickness

class Point(typing.NamedTuple):
    speed: float

class Words:
    def _unused(self):
        pass

def _shared():
    return _homonym()

def _homonym():
    return 1
"""
ROLL = """\
async def roll():
    def _homonym():
        return 2
    return 1
"""


@pytest.fixture
def tree(tmp_path):
    files = {
        'ballscrew_monitor/cli.py': TOP,
        'surrogate/film.py': FILM,
        'surrogate/ehl/kernels/roll.py': ROLL,
        'test/surrogate/test_film.py': 'a = 1\n',
        'test/surrogate/ehl/kernels/test_roll.py': 'a = 1\nb = 2\n',
        'test/conftest.py': 'a = 1\n',
        'bench/speed.py': 'from surrogate.film import _homonym\n',
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path


def test_rooms_packages_and_their_sum(tree):
    """
    Lines, code lines, functions, p90, records, functions named once, lines of tests.

    `_shared` is imported and called, `_half` called twice, and two functions are `_homonym`.

    """
    rows = runpy.run_path(str(SCRIPT))['table'](tree)
    assert rows == {
        'ballscrew_monitor': (15, 5, 1, 4, 0, 0, 0),
        'surrogate/ehl': (4, 4, 2, 3, 0, 0, 2),
        'surrogate': (29, 22, 7, 3, 2, 0, 3),
        'total': (44, 27, 8, 4, 2, 0, 4),
    }


def test_a_private_function_is_named_once(tree):
    table = runpy.run_path(str(SCRIPT))['table']
    film = tree / 'surrogate' / 'film.py'
    film.write_text(FILM.replace('self._half() + self._half()', '2.0 * self._half()'))
    assert table(tree)['surrogate'][5] == 1
    (tree / 'surrogate' / 'ehl' / 'kernels' / 'roll.py').unlink()
    assert table(tree)['surrogate'][5] == 2


def test_two_lines_on_the_whole(tree, monkeypatch, capsys):
    monkeypatch.setattr(sys, 'argv', ['count.py', '--tree', str(tree), '--summary'])
    assert runpy.run_path(str(SCRIPT))['main']() == 0
    assert capsys.readouterr().out.splitlines() == [
        '44 lines, 27 of code, in 8 functions with bodies of at most 4 lines in nine of ten;',
        '2 record types, 0 private functions named once; 4 lines of tests',
    ]


def test_the_table_has_a_column_for_each_count(tree, monkeypatch, capsys):
    monkeypatch.setattr(sys, 'argv', ['count.py', '--tree', str(tree)])
    assert runpy.run_path(str(SCRIPT))['main']() == 0
    head, *rows = capsys.readouterr().out.splitlines()
    assert head.split()[0] == 'lines'
    assert rows[0].split() == ['ballscrew_monitor', '15', '5', '1', '4', '0', '0', '0']


def test_the_sum_is_printed_before_the_tests():
    lines = SCRIPT.with_name('test.sh').read_text().splitlines()
    count = lines.index('.venv/bin/python scripts/count.py --summary')
    assert lines[count + 1].startswith('.venv/bin/pytest')
