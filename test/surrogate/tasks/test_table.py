# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables of results come back as they were written."""

from dataclasses import dataclass
import math

from surrogate.tasks.table import read_table, write_table


@dataclass(frozen=True)
class Line:
    name: str
    count: int
    good: bool
    value: float = math.nan


LINES = [Line('a, b', 3, True, 1 / 3), Line('', -1, False)]


def test_values_come_back_by_their_kinds(tmp_path):
    """All digits unless fewer are asked for; NaN, blanks and commas, too."""
    path = tmp_path / 'new' / 'table.csv'
    assert read_table(path, Line) == []
    write_table(path, Line, LINES)
    first, second = read_table(path, Line)
    assert first == LINES[0]
    assert (second.name, second.count, second.good) == ('', -1, False)
    assert math.isnan(second.value)
    write_table(path, Line, LINES, digits=6)
    assert read_table(path, Line)[0].value == 0.333333
    assert [one.name for one in path.parent.iterdir()] == ['table.csv']


def test_a_missing_column_has_its_default_and_a_missing_value_is_refused(tmp_path, refused):
    """With the path of the table."""
    path = tmp_path / 'table.csv'
    path.write_text('name,count,good\na,1,True\n')
    assert math.isnan(read_table(path, Line)[0].value)
    for text in ('name,count\na,1\n', 'name,count,good\na,one,True\n'):
        path.write_text(text)
        refused('table_cannot_read', read_table, path, Line)
