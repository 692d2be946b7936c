# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Heads of tables: the names of the columns stand above the first full row of numbers."""

from ballscrew_monitor.recordings.tables.heads import found_in_lines, names_of, read_head
from ballscrew_monitor.recordings.tables.quantities import Layout
from hypothesis import given, strategies
import pytest


@pytest.mark.parametrize(
    ('text', 'skip', 'rows'),
    [
        ('t,v\n0,1\n1,2', 0, 1),
        ('# a comment\n\nt;v\n0;1\n1;2', 0, 1),
        ('Maschine: 3\nt;v\n0;1\n1;2', 1, 1),
        ('Rate;100\nKunde;Meier\n\nt;v;F\ns;mm/s;N\n0;1;2\n1;2;3', 3, 2),
        ('made,on\nt,v,F\n0,1,2\n1,2,3', 1, 1),
        ('a;b\nX;Y\n1,5;2,5\n1,6;2,6', 1, 1),
        ('t;v\n[s];[mm/s]\n0;1\n1;2', 0, 2),
        ('t;text\n0;x\n1;y', 0, 1),
        ('1;2\n3;4', 0, 1),
        ('', 0, 1),
        ('only words', 0, 1),
        ('t\tF\n2026-01-02T03:04:05Z\t-1e3\n', 0, 1),
        ('Datum;Uhrzeit;v\n01.02.2026;03:04:05,5;1,5', 0, 1),
    ],
)
def test_names_stand_above_the_first_full_row_of_numbers(text, skip, rows):
    assert found_in_lines(text.splitlines()) == Layout(skip=skip, header_rows=rows)


@given(strategies.lists(strategies.text(max_size=20), max_size=9))
def test_whatever_the_lines_are_there_is_a_layout_within_them(lines):
    found = found_in_lines(lines)
    assert 0 <= found.skip < max(len(lines), 1)
    assert found.header_rows in (1, 2)


def test_a_row_below_names_adds_units_or_words():
    assert names_of([['v', 'F', 'x', 't'], ['mm/s', '[N]', 'left']]) == (
        'v [mm/s]',
        'F [N]',
        'x left',
        't',
    )


def test_a_name_of_several_lines_is_in_one_and_tells_no_separator():
    head = read_head(iter(['"a;b,\n', 'c,,,,"\tF\n', '1\t2\n']), Layout())
    assert (head.names, head.separator, head.lines) == (('a;b, c,,,,', 'F'), '\t', 0)
    head = read_head(iter(['"never closed\n', 'x\n']), Layout())
    assert head.names == ('never closed x',)
    with pytest.raises(ValueError, match='no line names its columns'):
        read_head(iter(['#\n', '\n']), Layout())
