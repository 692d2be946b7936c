# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The program of a reference run in each dialect: its moves, and what each control wants."""

import re

from ballscrew_monitor.cli import main
from ballscrew_monitor.health.fingerprint import LEAST_TIME, planned, STAIRCASE
from ballscrew_monitor.health.part_program import DIALECTS, program_of
import pytest
from surrogate.surface import shipped_surface
from surrogate.units import TURN

LEAD, TRAVEL = 0.01, 0.3
MOVES = {
    'iso': r'^G1 X(-?[\d.]+) F([\d.]+)$',
    'linuxcnc': r'^G1 X(-?[\d.]+) F([\d.]+)$',
    'sinumerik': r'^G1 X=(-?[\d.]+) F([\d.]+)$',
    'heidenhain': r'^\d+ L IX([+-][\d.]+) R0 F(\d+)$',
}
"""Blocks of linear moves as the manuals of the controls write them."""
COMMENTS = {
    'iso': r'\(.*\)',
    'linuxcnc': r'\(.*\)',
    'sinumerik': '; .*',
    'heidenhain': r'\d+ ; .*',
}
ENDS = {
    'iso': ['%', 'M30', '%'],
    'linuxcnc': ['G21 G90 G94 G61', 'G90', 'M2'],
    'sinumerik': ['G710 G90 G94', 'G90', 'M30'],
    'heidenhain': ['BEGIN PGM FINGERPRINT MM', 'M30', 'END PGM FINGERPRINT MM'],
}
"""First block and last two of a program."""


@pytest.fixture(params=sorted(DIALECTS))
def dialect(request):
    return request.param


def lines(dialect, **changes):
    return list(
        program_of(planned(LEAD, TRAVEL), 'X', TRAVEL, dialect=DIALECTS[dialect], **changes)
    )


def moves(dialect, text):
    found = re.findall(MOVES[dialect], '\n'.join(text), re.MULTILINE)
    return [(float(length), float(feed)) for length, feed in found]


def test_the_program_moves_for_long_enough_at_each_step_and_returns(dialect):
    steps = planned(LEAD, TRAVEL)
    assert [one.feed for one in steps] == pytest.approx([s * LEAD / TURN for s in STAIRCASE])
    assert all(one.time >= 2 * LEAST_TIME * 0.999 for one in steps)
    found = moves(dialect, lines(dialect))
    assert sum(length for length, _ in found) == pytest.approx(0.0)
    assert max(abs(length) for length, _ in found) <= 300.0
    assert sorted({feed for _, feed in found}) == [100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0]
    time = sum(abs(length) / feed * 60.0 for length, feed in found)
    assert time == pytest.approx(sum(one.time for one in steps))


def test_comments_and_ends_are_those_of_the_control(dialect):
    text = lines(dialect)
    bare = [line.partition(' ')[2] for line in text] if dialect == 'heidenhain' else text
    assert [bare[0], *bare[-2:]] == ENDS[dialect]
    comments = [line for line in text if 'rev/min' in line]
    assert len(comments) == len(STAIRCASE)
    assert all(re.fullmatch(COMMENTS[dialect], line) for line in comments)
    assert all(line.isascii() and line.count('(') <= 1 for line in text)
    numbers = [line.partition(' ')[0] for line in text]
    counted = numbers == [str(number) for number in range(len(text))]
    assert counted == (dialect == 'heidenhain')


def test_relative_moves_stand_between_their_words(dialect):
    """Of a conversational program each move is relative by itself."""
    text = lines(dialect)
    at = [i for i, line in enumerate(text) if re.match(MOVES[dialect], line)]
    if dialect == 'heidenhain':
        assert not {'G90', 'G91'} & set(text)
    else:
        assert (text[at[0] - 1], text[at[-1] + 1]) == ('G91', 'G90')


@pytest.mark.parametrize(
    ('dialect', 'dwell'),
    [
        ('iso', ['G4 X120.0']),
        ('sinumerik', ['G4 F120.0']),
        ('linuxcnc', ['G4 P120.0']),
        ('heidenhain', ['CYCL DEF 9.0 DWELL TIME', 'CYCL DEF 9.1 DWELL 120.0']),
    ],
)
def test_runs_are_repeated_after_a_dwell_in_the_unit_of_the_control(dialect, dwell):
    single, text = lines(dialect), lines(dialect, runs=3)
    assert len(moves(dialect, text)) == 3 * len(moves(dialect, single))
    bare = [line.partition(' ')[2] for line in text] if dialect == 'heidenhain' else text
    assert [line for line in bare if line in dwell] == 2 * dwell


@pytest.mark.parametrize(
    ('dialect', 'block'),
    [
        ('iso', 'G1 X-12.500 F5000.0'),
        ('sinumerik', 'G1 X=-12.500 F5000.0'),
        ('linuxcnc', 'G1 X-12.500 F5000.0'),
        ('heidenhain', 'L X-12.500 R0 F5000'),
    ],
)
def test_it_goes_to_its_start_first_if_one_is_stated(dialect, block):
    text = [line.removeprefix(f'{at} ') for at, line in enumerate(lines(dialect, start=-0.0125))]
    assert text.count(block) == 1
    assert not any(line.startswith('L IX') for line in text[: text.index(block)])
    assert 'G91' not in text[: text.index(block)]


def test_the_command_prints_a_program(capsys):
    surface = '--surface', str(shipped_surface())
    assert main(['fingerprint', *surface, '--travel-mm', '300']) == 0
    out = capsys.readouterr().out.splitlines()
    assert '(10 rev/min, 100 mm/min: 1 times forth and back, 12 s)' in out
    assert 'G1 X10.000 F100.0' in out
    options = '--dialect', 'heidenhain', '--runs', '2', '--start-mm', '-5', '--axis', 'Z'
    assert main(['fingerprint', *surface, '--travel-mm', '300', *options]) == 0
    out = capsys.readouterr().out
    assert 'L Z-5.000 R0' in out
    assert out.count('DWELL TIME') == 1


@pytest.mark.parametrize(
    ('key', 'wrong'),
    [
        ('travel', ('--travel-mm', '0')),
        ('axis', ('--travel-mm', '9', '--axis', 'X1')),
        ('runs', ('--travel-mm', '9', '--runs', '0')),
        ('start', ('--travel-mm', '9', '--start-mm', 'nan')),
    ],
)
def test_what_cannot_be_is_refused(says, capsys, key, wrong):
    assert main(['fingerprint', *wrong]) == 2
    assert says(key) in capsys.readouterr().err
