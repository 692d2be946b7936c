# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Points of torque over speed out of a table: units, columns, a sentence for each mistake."""

import json
import math

from ballscrew_monitor.cli import main
from ballscrew_monitor.recordings.tables.points import PointColumns, read_points
import polars as pl
import pytest

LEAD = 0.01
ASKED = PointColumns(lead=LEAD)


@pytest.fixture
def table(tmp_path):
    def write(text):
        path = tmp_path / 'drag.csv'
        path.write_text(text, encoding='utf-8')
        return path

    return write


def points(path, **asked):
    return read_points(path, PointColumns(lead=LEAD, **asked))[0]


def test_columns_come_in_si_units_whatever_their_order(table):
    """Comments, a byte order mark, decimal commas and other columns are as in any other table."""
    found = points(
        table(
            '\ufeff# no load\n'
            'time_s;torque_mNm;speed_rpm;temperature_degC;load_kN;torque_std_mNm\n'
            '0; 120; 60; 40,5; 0,01; 3\n1; -110; -600; 41; -0,01; 4\n'
        )
    )
    assert found['speed'] == pytest.approx([2 * math.pi, -20 * math.pi])
    assert found['torque'] == pytest.approx([0.12, -0.11])
    assert found['torque_std'] == pytest.approx([0.003, 0.004])
    assert found['load'] == pytest.approx([10.0, -10.0])
    assert found['temperature'] == pytest.approx([313.65, 314.15])


def test_a_speed_of_the_nut_is_turned_by_the_lead(table):
    found = points(table('Vorschub [mm/min],Drehmoment [Nm]\n600,0.1\n1200,0.2\n'))
    assert found['speed'] == pytest.approx([2 * math.pi, 4 * math.pi])


def test_parquet_is_read_too(tmp_path):
    path = tmp_path / 'drag.parquet'
    pl.DataFrame({'speed_rpm': [60.0, 120.0], 'torque_Nm': [0.1, 0.2]}).write_parquet(path)
    assert points(path)['torque'].tolist() == [0.1, 0.2]


def test_a_column_named_by_hand_counts(table):
    path = table('motor_speed_rad_s,speed_rpm,axis_torque_Nm\n2,1,0.5\n3,1,0.6\n')
    found = points(path, speed_column='motor_speed_rad_s', torque_column='axis_torque_Nm')
    assert (found['speed'].tolist(), found['torque'].tolist()) == ([2.0, 3.0], [0.5, 0.6])


def test_a_current_counts_with_its_constant(table):
    """In place of a torque that stands beside it, also by the name of a column."""
    path = table('speed_rpm,current_mA,torque_Nm,motor_A\n60,2000,9,3\n70,1000,8,2\n')
    assert points(path, torque_constant=0.1)['torque'] == pytest.approx([0.2, 0.1])
    named = points(path, torque_constant=-0.1, torque_column='motor_A')
    assert named['torque'] == pytest.approx([-0.3, -0.2])
    assert points(path)['torque'].tolist() == [9.0, 8.0]


@pytest.mark.parametrize(
    ('head', 'key'),
    [
        ('speed_rpm,power_W', 'no_torque'),
        ('speed_rpm,current_A', 'current_alone'),
        ('torque_Nm,power_W', 'no_speed'),
        ('speed,torque_Nm', 'no_unit'),
        ('speed_rpm,torque_lbfin', 'foreign_unit'),
        ('speed_rpm,torque_%', 'share'),
        ('speed_rpm,torque_Nm,speed_rad_s', 'two_speeds'),
    ],
)
def test_a_mistake_is_one_sentence(table, head, key, refused):
    count = head.count(',') + 1
    rows = ''.join(','.join(str(row + at) for at in range(count)) + '\n' for row in (1, 2))
    refused(key, read_points, table(f'{head}\n{rows}'), ASKED)


def test_a_missing_column_and_a_file_that_is_none_are_refused(table, tmp_path, refused):
    path = table('speed_rpm,torque_Nm\n1,2\n2,3\n')
    refused('missing', read_points, path, PointColumns(lead=LEAD, speed_column='nope'))
    refused('no_file', read_points, tmp_path / 'none.csv', ASKED)
    refused('empty', read_points, table(''), ASKED)


def test_the_command_reads_a_table_and_refuses_a_cell_without_a_number(table, capsys, says):
    """A textbook drag that rises with the speed; the same table with a gap."""
    lines = ['speed_rpm,torque_Nm', *(f'{n},{0.2 + 1e-4 * n:.6f}' for n in range(100, 2000, 100))]
    path = table('\n'.join(lines))
    assert main(['identify', str(path), '--json']) == 0
    assert json.loads(capsys.readouterr().out)['points'] == 19
    assert main(['identify', str(table('\n'.join([*lines, '2000,'])))]) == 2
    assert says('gap') in capsys.readouterr().err
