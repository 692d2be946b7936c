# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lines that are messages: values on change of an adapter, and topics echoed without names."""

import math

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.line_messages import read_shdr
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
import numpy as np
import pytest
from surrogate.files import limits

COUNT, STEP = 300, 0.01
TIME = np.arange(COUNT) * STEP
TURNED = 60.0 * (1.0 - np.cos(math.tau * TIME))  # [rad]
BEGIN = 1752494390  # [s] since 1970


def echoed(joints, *, speeds=True, frame='base'):
    """Return JointStates as the command line of ROS prints them: arrays without their lengths."""
    lines = []
    for at in range(COUNT):
        stamp = round((BEGIN + TIME[at]) * 1e3)
        cells = [stamp // 1000, stamp % 1000 * 1_000_000, frame, *joints]
        cells += [(number + 1) * TURNED[at] for number in range(len(joints))]
        cells += [0.0] * len(joints) if speeds else ['']
        cells += [0.5 * math.cos(at / 10)] * len(joints)
        lines.append(','.join(map(str, cells)))
    return lines


@pytest.mark.parametrize('speeds', [True, False])
@pytest.mark.parametrize('frame', ['base', ''])
def test_joints_of_an_echoed_topic_are_told_by_their_names(speeds, frame, tmp_path):
    path = tmp_path / 'joints.csv'
    lines = echoed(['x_axis', 'y_axis'], speeds=speeds, frame=frame)
    path.write_text('\n'.join(lines) + '\n')
    content = guess(path).content
    assert content['assumed']['x.torque.unit']['value'] == 'N m'
    (rows,) = [rows for (rows,) in read_series(path, make_map(content)).blocks()]
    np.testing.assert_allclose(rows.stamps / 1e9, BEGIN + TIME, atol=1e-6)
    inner = slice(1, -1)
    for axis, factor in (('x', 1.0), ('y', 2.0)):
        np.testing.assert_allclose(rows.columns[f'{axis}.position'], factor * TURNED)
        np.testing.assert_allclose(
            rows.columns[f'{axis}.speed'][inner],
            factor * np.gradient(TURNED, STEP)[inner],
            atol=0.05,  # of a stamp that counts from 1970 in one number
        )


def test_other_topics_without_names_are_refused(tmp_path, refused):
    path = tmp_path / 'wrench.csv'
    lines = [f'{BEGIN},{at * 10_000_000},tool,{at},0.0,0.0,0.0,0.0,0.0' for at in range(1, 50)]
    path.write_text('\n'.join(lines) + '\n')
    refused('wrench', guess, path)
    path.write_text(''.join(f'{math.sin(at)}\n' for at in range(50)))
    refused('numbers', guess, path)


def test_a_topic_of_changing_joints_is_refused(tmp_path, refused):
    path = tmp_path / 'joints.csv'
    pairs = zip(echoed(['x_axis']), echoed(['z_axis']), strict=True)
    path.write_text('\n'.join(line for pair in pairs for line in pair))
    refused('joints', guess, path)


def test_a_line_with_fewer_numbers_than_joints_is_refused(tmp_path, refused):
    path = tmp_path / 'joints.csv'
    lines = [f'{BEGIN},{at * 10_000_000},,x_axis,y_axis,1,2,3' for at in range(50)]
    path.write_text('\n'.join(lines))
    refused('fewer', guess, path)


def adapter(path):
    """Write places and loads on change, on lines of their own, the load without a sign."""
    lines = []
    for at in range(COUNT):
        seconds = at / 3.0
        place = 150.0 + 100.0 * math.sin(seconds / 8.0)
        lines.append((seconds, f'X1actm|{place:.3f}'))
        if at % 4 == 0:
            load = 40.0 + 20.0 * abs(math.cos(seconds / 8.0))
            lines.append((seconds + 0.1, f'X1load|{load:.0f}'))
    lines = [
        f'2025-07-14T{12 + int(s // 3600):02d}:{int(s // 60) % 60:02d}:{s % 60:07.4f}Z|{text}'
        for s, text in sorted(lines)
    ]
    path.write_text('\n'.join(lines) + '\n')


def test_a_load_on_change_holds_until_the_next_and_is_an_amount(tmp_path):
    path = tmp_path / 'mill.shdr'
    adapter(path)
    content = guess(path).content
    axis = content['axes']['x']
    assert axis['torque'] == {'column': 'X1load', 'unit': '%', 'magnitude': True}
    assert axis['torque_rated_Nm'] is None
    axis['torque_rated_Nm'] = 10.0
    (rows,) = [rows for (rows,) in read_series(path, make_map(content)).blocks()]
    seconds = (rows.stamps - rows.stamps[0]) / 1e9
    known = (seconds > 1.5) & (np.abs(np.cos(seconds / 8.0)) > 0.2)
    torque = rows.columns['x.torque'][known]
    wanted = 0.1 * (40.0 + 20.0 * np.abs(np.cos(seconds[known] / 8.0)))
    np.testing.assert_allclose(np.abs(torque), wanted, atol=0.4)
    np.testing.assert_array_equal(np.sign(torque), np.sign(np.cos(seconds[known] / 8.0)))


@pytest.mark.parametrize(
    ('form', 'why'),
    [("1'060", 'other_form'), ('3|100|58 59 60', 'lists'), ('3||58.5 59 60', 'lists')],
)
def test_a_signal_with_lists_or_numbers_of_another_form_is_left_out(form, why, tmp_path, says):
    path = tmp_path / 'mill.shdr'
    adapter(path)
    path.write_text(path.read_text().replace('X1load|60', f'X1load|{form}'))
    source = source_of(path)
    assert source.names() == ['time', 'X1actm']
    assert source.left_out == {'X1load': says(why)}


def test_a_log_whose_motion_is_in_lists_says_so(tmp_path, refused):
    path = tmp_path / 'mill.shdr'
    adapter(path)
    lists = path.read_text().replace('X1actm|', 'X1pos|3|100|1 2 ')
    path.write_text(lists)
    refused('no_motion', guess, path)


@pytest.mark.parametrize('name', ['X1pos', 'X1position', 'X1act'])
def test_positions_of_adapters_have_names_of_several_kinds(name, tmp_path):
    path = tmp_path / 'mill.shdr'
    adapter(path)
    path.write_text(path.read_text().replace('X1actm', name).replace('Z|', 'Z@300.0|'))
    axis = guess(path).content['axes']['x']
    assert {kind: axis[kind]['column'] for kind in ('position', 'torque')} == {
        'position': name,
        'torque': 'X1load',
    }


def test_a_map_may_name_any_key_of_an_adapter_that_holds_numbers(tmp_path):
    path = tmp_path / 'mill.shdr'
    adapter(path)
    path.write_text(path.read_text().replace('X1actm', 'Ax7'))
    axis = {'lead_mm': 10.0, 'position': {'column': 'Ax7', 'unit': 'mm'}}
    mapping = make_map({'time': {'column': 'time', 'unit': 's'}, 'axes': {'x': axis}})
    (rows,) = [rows for (rows,) in read_series(path, mapping).blocks()]
    seconds = (rows.stamps - rows.stamps[0]) / 1e9
    places = rows.columns['x.position'] * 10.0 / math.tau
    np.testing.assert_allclose(places, 150.0 + 100.0 * np.sin(seconds / 8.0), atol=0.01)


def test_the_table_that_changes_make_is_counted_before(tmp_path, refused, monkeypatch):
    path = tmp_path / 'mill.shdr'
    lines = [f'2025-07-14T11:59:50.{row:03d}Z|{"XYZ"[row % 3]}act|{row}' for row in range(60)]
    path.write_text('\n'.join(lines) + '\n')
    monkeypatch.setattr(limits, 'SPARSE', 60 * 4 * limits.NUMBER_CELL)
    assert read_shdr(path).frame.shape == (60, 4)
    monkeypatch.setattr(limits, 'SPARSE', 60 * 4 * limits.NUMBER_CELL - 1)
    refused('wide', source_of, path)
