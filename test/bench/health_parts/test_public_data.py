# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Public measurements are read by their columns, and the drag of the catalogue meets one."""

import math

from health_parts.machine import catalogue_drag, size_of
from health_parts.public_data import (
    ageing_looks,
    Milling,
    public_lines,
    read_ageing,
    read_milling,
    recordings,
    steady_share,
)
import numpy as np
import pytest

FOLDER = recordings()
RECORDED = pytest.mark.skipif(
    FOLDER is None or not (FOLDER / 'xjtu_torque.csv').exists(),
    reason='BALLSCREW_RECORDINGS names no folder with xjtu_torque.csv',
)


def test_ageing_is_read_by_its_columns(tmp_path):
    (tmp_path / 'xjtu_torque.csv').write_text('hours,up,down\n0,.4,.5\n35,.38,.49\n')
    ageing = read_ageing(tmp_path)
    assert list(ageing.hours) == [0.0, 35.0]
    assert list(ageing.up) == [0.4, 0.38]
    assert list(ageing.down) == [0.5, 0.49]


def test_milling_is_read_by_its_names_in_metres(tmp_path):
    folder = tmp_path / 'cnc_mill'
    folder.mkdir()
    (folder / 'experiment_01.csv').write_text(
        'Y1_CurrentFeedback,Y1_ActualVelocity,Y1_ActualPosition,Machining_Process\n'
        '1.5,20.0,300.0,Starting\n-1.5,-20.0,302.0,end\n'
    )
    run = read_milling(tmp_path, 'Y')
    assert list(run.time) == [0.0, 0.1]
    assert list(run.position) == pytest.approx([0.3, 0.302])
    assert list(run.speed) == pytest.approx([0.02, -0.02])
    assert list(run.current) == [1.5, -1.5]


def test_no_folder_is_none(monkeypatch, tmp_path):
    monkeypatch.delenv('BALLSCREW_RECORDINGS', raising=False)
    assert recordings() is None
    monkeypatch.setenv('BALLSCREW_RECORDINGS', str(tmp_path / 'absent'))
    assert recordings() is None
    monkeypatch.setenv('BALLSCREW_RECORDINGS', str(tmp_path))
    assert recordings() == tmp_path


def test_an_ageing_that_loses_a_fifth_at_once_is_found_with_its_size():
    hours, odd = 35.0 * np.arange(30), 1.0 + 0.005 * (-1.0) ** np.arange(30)
    torque = 0.4 * odd * np.where(hours < 500.0, 1.0, 0.8)
    seen = ageing_looks(hours, torque)
    assert not any(look.raised for look in seen[:14])
    assert 15 <= next(look.log for look in seen if look.raised) <= 18
    assert seen[-1].low <= -0.2 <= seen[-1].high
    assert not any(look.raised for look in ageing_looks(hours, 0.4 * odd))


def test_constant_motion_at_ten_samples_a_second_counts_as_steady():
    """Ten passes of 6 s at 20 mm/s and a second of rest after each, with a ripple of 1 %."""
    ripple = 1.0 + 0.01 * np.sin(np.arange(700))
    way = np.repeat(np.where(np.arange(10) % 2, -1.0, 1.0), 70)
    moving = np.tile(np.arange(70) < 60, 10)
    speed = 0.02 * ripple * way * moving
    run = Milling(
        time=np.arange(700) / 10.0,
        position=np.cumsum(speed) / 10.0,
        speed=speed,
        current=3.0 * way,
    )
    motion, steady, speeds = steady_share(run)
    assert motion == pytest.approx(60.0)
    assert 50.0 <= steady <= 60.0
    assert speeds == 1


@RECORDED
def test_public_measurements_have_a_line_each():
    lines = list(public_lines(FOLDER))
    assert [line.split(' | ')[0] for line in lines[2:4] + lines[7:]] == [
        '| first',
        '| second',
        '| X',
        '| Y',
    ]
    assert ' h | -1' in lines[2]  # the first screw is found after it has lost some ten per cent


@RECORDED
def test_catalogue_meets_the_measured_drag_within_its_factors():
    """Lead 8 mm, 1500 N; the diameter of a screw with a rating of 16.4 kN is about 32 mm."""
    ageing = read_ageing(FOLDER)
    drag = catalogue_drag(size_of(32.0, 8.0, 16.4, 40.0, 3000.0, 10.0, 100.0), 1500.0)
    for torque in (ageing.up, ageing.down):
        assert 0.6 < torque[0] / drag < 1.8
    assert ageing.up[-1] / ageing.up[0] == pytest.approx(0.62, abs=0.01)


@RECORDED
def test_milling_run_moves_as_its_speed_says():
    run = read_milling(FOLDER)
    travelled = 0.5 * (run.speed[1:] + run.speed[:-1]) * 0.1
    assert run.position[-1] - run.position[0] == pytest.approx(travelled.sum(), abs=0.02)
    assert math.isclose(run.time[-1], 0.1 * (len(run.speed) - 1))
