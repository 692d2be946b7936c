# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The CSV of a run without load: units, columns, and one sentence for each mistake."""

import math

import numpy as np
import pytest
from surrogate.identify.data import no_load_run, read_drag_csv

WARM = 313.15


@pytest.fixture
def csv(tmp_path):
    def write(text):
        path = tmp_path / 'drag.csv'
        path.write_text(text, encoding='utf-8')
        return path

    return write


def test_columns_come_in_si_units_whatever_their_order(csv):
    """Comments, blank lines, a byte order mark and other columns are left alone."""
    columns = read_drag_csv(
        csv(
            '\ufeff# no load\n\n'
            'time_s;torque_mNm;speed_rpm;temperature_degC;load_kN;torque_std_mNm\n'
            '0; 120; 60; 40; 0.01; 3\n\n1; -110; -600; 41; -0.01; 4\n'
        )
    )
    assert columns['speed'] == pytest.approx([2 * math.pi, -20 * math.pi])
    assert columns['torque'] == pytest.approx([0.12, -0.11])
    assert columns['torque_std'] == pytest.approx([0.003, 0.004])
    assert columns['load'] == pytest.approx([10.0, -10.0])
    assert columns['temperature'] == pytest.approx([313.15, 314.15])


def test_a_column_named_by_hand_needs_its_unit_and_a_file_a_text(csv, refused, tmp_path):
    path = csv('motor_speed_rad_s,speed_rpm,axis_torque_Nm\n2,1,0.5\n')
    columns = read_drag_csv(path, speed_column='motor_speed_rad_s', torque_column='axis_torque_Nm')
    assert columns['speed'] == [2.0]
    assert columns['torque'] == [0.5]
    path = csv('rpm_speed,torque_Nm\n1,2\n')
    for column in ('rpm_speed', 'torque_Nm'):
        with refused('column_has_unit', column=column):
            read_drag_csv(path, speed_column=column)
    refused('column_nope_missing', read_drag_csv, path, speed_column='nope')
    refused('cannot_read_such', read_drag_csv, tmp_path / 'nothing.csv')
    (tmp_path / 'bytes.csv').write_bytes(b'\xff\xfe\x00\x80')
    refused('cannot_read_as', read_drag_csv, tmp_path / 'bytes.csv')


@pytest.mark.parametrize(
    ('text', 'sentence'),
    [
        ('', 'empty_line_names'),
        ('# nothing\n', 'empty_line_names'),
        ('speed_rpm,torque_Nm\n', 'has_numbers_below'),
        ('speed_rpm,power_W\n1,2\n', 'column_torque_nm_torque_mnm'),
        ('speed_rpm,current_A\n1,2\n', 'current_constant'),
        ('torque_Nm\n1\n', 'column_speed_rpm_speed_rad_s'),
        ('speed_Nm,torque_rpm\n1,2\n', 'column_speed_nm_has'),
        ('speed_rpm,torque_lbfin\n1,2\n', 'column_torque_lbfin_has'),
        ('speed,torque_Nm\n1,2\n', 'column_speed_has'),
        ('speed_rpm,torque_Nm,torque_std\n1,2,3\n', 'column_torque_std_has'),
        ('speed_rpm,torque_Nm,speed_rad_s\n1,2,3\n', 'speed_rpm_speed_rad_s_both'),
        ('speed_rpm,torque_Nm\n1,2\n# x\n2,abc\n', 'line_4_has'),
        ('speed_rpm,torque_Nm\n1,nan\n', 'line_2_has'),
        ('speed_rpm,torque_Nm\n1,2\n1,\n', 'line_3_has'),
        ('speed_rpm,torque_Nm\n1,2,3\n', 'line_2'),
        ('speed_rpm,torque_Nm,torque_std_Nm\n1,2,0\n', 'line_2_has_0'),
    ],
)
def test_a_mistake_is_one_sentence_with_its_line(csv, text, sentence, refused):
    refused(sentence, read_drag_csv, csv(text))


def test_a_current_counts_with_its_constant(csv, refused):
    """In place of a torque that stands beside it, also by the name of a column."""
    path = csv('speed_rpm,current_mA,torque_Nm,motor_A\n60,2000,9,3\n')
    assert read_drag_csv(path, torque_constant=0.1)['torque'] == pytest.approx([0.2])
    named = read_drag_csv(path, torque_constant=-0.1, torque_column='motor_A')
    assert named['torque'] == pytest.approx([-0.3])
    assert read_drag_csv(path)['torque'] == [9.0]
    refused('no_constant', read_drag_csv, path, torque_constant=0.0)


def test_points_at_standstill_are_left_out_and_counted():
    """Friction has no direction there; the columns that are absent get their defaults."""
    run = no_load_run(
        {'speed': np.array([0.0, 1.0, -2.0]), 'torque': np.array([9.0, 1.0, -1.0])},
        source='data',
        temperature=WARM,
    )
    assert run.speed.tolist() == [1.0, -2.0]
    assert run.torque.tolist() == [1.0, -1.0]
    assert run.load.tolist() == [0.0, 0.0]
    assert run.temperature.tolist() == [WARM, WARM]
    assert run.torque_std is None
    assert run.both_directions
    assert run.notes == ('1 points at standstill are left out',)


@pytest.mark.parametrize(
    ('name', 'value'), [('torque', math.nan), ('speed', math.inf), ('torque_std', 0.0)]
)
def test_numbers_that_are_none_are_refused(name, value, refused):
    """Whoever reads the data: a run holds finite numbers only."""
    columns = {'speed': np.ones(2), 'torque': np.ones(2), 'torque_std': np.ones(2)}
    columns[name][1] = value
    with refused('point_2_finite', name=name):
        no_load_run(columns, source='data', temperature=WARM)
