# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows on disk: parts of the file, and the table that users get."""

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.report import row_table
from ballscrew_monitor.report.row_table import CODES, COLUMNS, FIELDS, RowStore
import numpy as np
import polars as pl
import pytest


@pytest.fixture
def small_parts(monkeypatch):
    monkeypatch.setattr(row_table, 'PART', 30)


def test_a_table_holds_the_columns_of_all_rows(judged, tmp_path, small_parts):
    blocks = [
        judged.rows(0, 70, zone=np.arange(70) % 3, tick=np.arange(70) % 2 == 0),
        judged.rows(70, 1, event_id=3),
        judged.rows(71, 40, machine_nut=2),
    ]
    found = pl.concat(judged.table(tmp_path / 'x.rows', blocks).parts())
    wanted = np.concatenate([block.rows for block in blocks])
    assert found.columns == list(COLUMNS)
    for name, field in FIELDS.items():
        np.testing.assert_array_equal(found[name].to_numpy(), wanted[field], err_msg=name)


@pytest.mark.parametrize('ahead', [0, 1])
def test_parts_hold_each_row_once_and_what_lies_ahead(judged, tmp_path, small_parts, ahead):
    table = judged.table(tmp_path / 'x.rows', [judged.rows(0, 50), judged.rows(50, 25)])
    stamps = [part['stamp'].to_list() for part in table.parts(ahead=ahead)]
    wanted = judged.rows(0, 75).rows['stamp'].tolist()
    first, second = min(30 + ahead, 75), min(60 + ahead, 75)
    assert stamps == [wanted[:first], wanted[30:second], wanted[60:]]
    found = table.collect(lambda part: part.filter(pl.col('stamp') > wanted[28]).select('stamp'))
    assert found['stamp'].to_list() == wanted[29:]


@pytest.mark.parametrize('codes', CODES.values())
def test_codes_count_from_zero_without_a_hole(codes):
    assert [member.value for member in codes] == list(range(len(codes)))


def test_parquet_holds_all_rows_by_axis_or_none_with_the_same_columns(
    judged, tmp_path, small_parts
):
    store = RowStore(tmp_path)
    for block in (judged.rows(0, 60), judged.rows(0, 40, axis='y'), judged.rows(60, 40)):
        store.add(block.axis, block.rows)
    store.write(tmp_path / 'states.parquet')
    found = pl.read_parquet(tmp_path / 'states.parquet')
    assert found.columns == ['axis', *COLUMNS]
    assert found['axis'].to_list() == ['x'] * 100 + ['y'] * 40
    assert found['zone'].unique().to_list() == [Zone.OPTIMAL.name]
    wanted = np.concatenate([judged.rows(0, 100).rows, judged.rows(0, 40).rows])
    for name, field in FIELDS.items():
        numbers = found[name].to_physical() if name in CODES else found[name]
        np.testing.assert_array_equal(numbers.to_numpy(), wanted[field], err_msg=name)
    RowStore(tmp_path).write(tmp_path / 'none.parquet')
    assert pl.read_parquet(tmp_path / 'none.parquet').schema == found.schema
