# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files that are no rows of cells: the signals of controls and measuring systems."""

import dataclasses
import itertools
import json
import math
import sys

from ballscrew_monitor.recordings.tables import apart, foreign, json_layouts
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
import h5py
import numpy as np
import pytest
import scipy.io

pytestmark = pytest.mark.usefixtures('in_this_process')
COUNT, STEP = 400, 0.002
TIME = np.arange(COUNT) * STEP
SPEED = 90.0 * np.sin(math.tau * TIME)  # [mm/s]
PLACE = 150.0 + 90.0 / math.tau * (1.0 - np.cos(math.tau * TIME))  # [mm]


def sinumerik_json(path):
    names = [('CYCLE', 'CYCLE'), ('DES_POS|1', 'X'), ('ENC_POS|1', 'X'), ('CURRENT|1', 'X')]
    signals = [{'Name': n, 'Type': 'DOUBLE', 'Axis': a, 'Address': n} for n, a in names]
    rows = [[row, PLACE[row] + 0.01, PLACE[row], 1.5] for row in range(COUNT)]
    header = {'CycleTimeMs': 2, 'SignalListHFData': signals}
    header['Initial'] = {'Time': '2025-07-14T11:59:50.000Z', 'HFProbeCounter': 1}
    parts = [{'HFData': rows[:250]}, {'LFData': []}, {'HFData': rows[250:]}]
    path.write_text(json.dumps({'Header': header, 'Payload': parts}))


def test_a_load_of_a_data_recorder_is_a_torque_in_per_cent(tmp_path):
    signals = [{'Name': f'{name}|1', 'Axis': 'X'} for name in ('ENC_POS', 'LOAD')]
    rows = [[PLACE[row], 20.0 * math.cos(row / 50)] for row in range(COUNT)]
    content = {
        'Header': {'CycleTimeMs': 2, 'SignalListHFData': signals},
        'Payload': [{'HFData': rows}],
    }
    path = tmp_path / 'log.json'
    path.write_text(json.dumps(content))
    axis = guess(path).content['axes']['x']
    assert axis['torque'] == {'column': 'X LOAD [%]', 'unit': '%'}
    assert axis['torque_rated_Nm'] is None


@pytest.mark.parametrize('counter', ['CYCLE', 'HFProbeCounter'])
def test_cycles_that_a_data_recorder_lost_are_refused(counter, tmp_path, refused):
    """The counter of the control goes on by 41 behind row 200; one that rises evenly is read."""
    path = tmp_path / 'log.json'
    sinumerik_json(path)
    text = path.read_text().replace('CYCLE"', f'{counter}"')
    path.write_text(text)
    assert guess(path).content['time'] == {'rate_Hz': 500.0}
    content = json.loads(text)
    for part in content['Payload']:
        for row in part.get('HFData', ()):
            row[0] += 40 * (row[0] >= 200)
    path.write_text(json.dumps(content))
    refused('lost_cycles', guess, path)


def test_stamps_between_parts_of_a_data_recorder_tell_lost_cycles(tmp_path, refused):
    """Parts of 10 to 70 rows; the stamps of all from row 200 on count 40 cycles more."""
    path = tmp_path / 'log.json'
    sinumerik_json(path)
    content = json.loads(path.read_text())
    rows = [row[1:] for part in content['Payload'] for row in part.get('HFData', ())]
    content['Header']['SignalListHFData'].pop(0)
    for lost in (0, 40):
        content['Payload'] = []
        for begin, end in itertools.pairwise([0, 60, 130, 200, 210, 270, 330, COUNT]):
            stamp = {'HFProbeCounter': str(7000 + begin + lost * (begin >= 200))}
            content['Payload'] += [{'HFTimestamp': stamp}, {'HFData': rows[begin:end]}]
        path.write_text(json.dumps(content))
        if not lost:
            assert guess(path).content['time'] == {'rate_Hz': 500.0}
    refused('lost_cycles', guess, path)


def write_lists(path, beside):
    path.write_text(json.dumps(beside | {'x position [mm]': [*PLACE], 'x speed [mm/s]': [*SPEED]}))


def write_arrays(path, beside):
    scipy.io.savemat(path, beside | {'x_pos_mm': PLACE, 'x_vel_mm_s': SPEED})


def write_recorder(path, beside):
    sinumerik_json(path)
    content = json.loads(path.read_text())
    content['Header'] |= beside
    path.write_text(json.dumps(content))


@pytest.mark.parametrize('number', [1, 5])
@pytest.mark.parametrize('word', ['Decimation', 'downsampling', 'record_every', 'Averaging'])
@pytest.mark.parametrize(
    ('ending', 'write', 'period'),
    [
        ('json', write_lists, {'dt': STEP}),
        ('mat', write_arrays, {'dt': STEP}),
        ('json', write_recorder, {}),
    ],
)
def test_a_period_beside_a_decimation_is_asked_for(ending, write, period, word, number, tmp_path):
    path = tmp_path / f'log.{ending}'
    write(path, period | {word: number})
    made = guess(path)
    assert (made.content['time']['rate_Hz'] is None) is (number != 1)
    assert (f'{word} = {number}' in ' '.join(made.unstated)) is (number != 1)


@pytest.mark.parametrize(
    ('key', 'change'),
    [
        ('rows', {'Payload': []}),
        ('ragged', {'Payload': [{'HFData': [[1, 2.0], [1]]}]}),
        ('parts', {'Payload': {'HFData': [[1, 2.0]]}}),
        ('signals', {'Header': {'SignalListHFData': ['a', 'b']}}),
        ('cycle', {'Header': {'CycleTimeMs': 'two', 'SignalListHFData': []}}),
        ('deep', {}),
    ],
)
def test_what_is_wrong_with_a_trace_is_said_in_its_own_words(key, change, tmp_path, refused):
    path = tmp_path / 'log.json'
    signals = [] if key == 'cycle' else [{'Name': f'ENC_POS|{at}', 'Axis': 'X'} for at in '12']
    content = {'Header': {'SignalListHFData': signals}, 'Payload': [{'HFData': [[]]}]} | change
    path.write_text('[' * 100_000 if key == 'deep' else json.dumps(content))
    refused(key, guess, path)


def sinumerik_xml(path):
    records = ''.join(
        f'<rec time="{time:.4f}" f1="{place:.6f}" f2="1.5"/>' for time, place in zip(TIME, PLACE)
    )
    path.write_text(
        '<?xml version="1.0"?><traceDataRoot><signals>'
        '<signal key="a" name="X actual position" units="mm"/>'
        '<signal key="b" name="X current" units="A"/></signals><traceData><dataFrame>'
        '<dataSignal id="f1" key="a"/><dataSignal id="f2" key="b"/>'
        f'{records}</dataFrame></traceData></traceDataRoot>'
    )


def trace(path, *, times=True):
    """Write a trace whose signals state axis, unit and interval themselves, of two axes."""
    signals = [('Pos1stEnc64', 'X1', 'mm'), ('Pos1stEnc64', 'Z1', 'mm'), ('VelMot64', 'X1', '°/s')]
    stated = ''.join(
        f'<dataSignal id="f{at}" name="/Nck/!SD/nckServoDataAct{name}" axis="{axis}" '
        f'interval="{STEP}" unitsType="{unit}"/>'
        for at, (name, axis, unit) in enumerate(signals)
    )
    records = ''.join(
        '<rec ' + f'time="{time:.4f}" ' * times + f'f0="{place:.6f}" f1="{2 * place:.6f}" '
        f'f2="{36.0 * speed:.6f}"/>'
        for time, place, speed in zip(TIME, PLACE, SPEED, strict=True)
    )
    path.write_text(
        f'<traceCaptureData><frameHeader/>{stated}{records}</traceCaptureData>', 'utf-8'
    )


@pytest.mark.parametrize('times', [True, False])
def test_signals_of_a_trace_may_state_axis_unit_and_interval_themselves(times, tmp_path):
    """A speed in degrees of a screw of 10 mm, and two axes whose signals have one name."""
    path = tmp_path / 'trace.xml'
    trace(path, times=times)
    content = guess(path).content
    assert list(content['axes']) == ['x', 'z']
    assert content['time'] == ({'column': 'time'} if times else {'rate_Hz': 1.0 / STEP})
    (rows,) = next(read_series(path, make_map(content)).blocks())
    np.testing.assert_allclose(np.diff(rows.stamps), STEP * 1e9, atol=1e3)
    turned = math.tau / 10.0
    np.testing.assert_allclose(rows.columns['x.speed'], SPEED * turned, atol=1e-4)
    np.testing.assert_allclose(rows.columns['z.position'], 2 * PLACE * turned, rtol=1e-6)


def matlab(path):
    log = {'time_s': TIME, 'x': {'position_mm': PLACE, 'current_A': np.full(COUNT, 1.5)}}
    scipy.io.savemat(path, {'log': log, 'note': 'of a mill'})


def hdf(path):
    with h5py.File(path, 'w') as file:
        for name, unit, values in (('time', 's', TIME), ('position', 'mm', PLACE)):
            file[f'x/{name}' if name == 'position' else name] = values
            file[f'x/{name}' if name == 'position' else name].attrs['unit'] = unit
        file['x/current'] = np.full(COUNT, 1.5)
        file['x/current'].attrs['unit'] = 'A'


WRITERS = {
    'trace.json': sinumerik_json,
    'trace.xml': sinumerik_xml,
    'log.mat': matlab,
    'log.h5': hdf,
}


@pytest.mark.parametrize('name', WRITERS)
def test_signals_of_a_control_are_those_of_its_axis(name, tmp_path):
    path = tmp_path / name
    WRITERS[name](path)
    content = guess(path).content
    if name == 'trace.xml':  # which states no unit of its time
        assert content['time'] == {'column': 'time', 'unit': None}
        content['time']['unit'] = 's'
    # A steady current may be one without a sign.
    assert content['axes']['x']['current'].pop('magnitude') is None
    content['axes']['x']['current']['magnitude'] = False
    content['axes']['x']['torque_constant_Nm_per_A'] = 0.2
    series = read_series(path, make_map(content))
    (block,) = [rows for (rows,) in series.blocks()]
    np.testing.assert_allclose(np.diff(block.stamps), STEP * 1e9, atol=1e3)
    np.testing.assert_allclose(block.columns['x.position'], PLACE * math.tau / 10.0, rtol=1e-6)
    middle = slice(5, -5)
    np.testing.assert_allclose(
        block.columns['x.speed'][middle], SPEED[middle] * math.tau / 10.0, atol=0.05
    )
    assert content['axes']['x']['current']['column']


@pytest.mark.parametrize(
    ('attributes', 'factors'),
    [
        ({'scale_factor': 0.5, 'add_offset': 2.0, '_FillValue': -9.0}, ''),
        ({'scale': 0.5, 'offset': 0.0}, 'v: scale 0.5'),
        ({'Gain': 1.0, 'zero_offset': 4}, 'v: zero_offset 4'),
        ({'multiplier': 0.5}, 'v: multiplier 0.5'),
        ({'conversion': 0.5}, 'v: conversion 0.5'),
        ({'slope': 0.5}, 'v: slope 0.5'),
        ({'NI_Scale[0]_Linear_Slope': 0.5}, 'v: NI_Scale[0]_Linear_Slope 0.5'),
        ({'Scaling Coefficients': [0.0, 2.0]}, 'v: Scaling Coefficients [0. 2.]'),
    ],
)
def test_attributes_of_a_dataset_scale_it_by_the_conventions_or_are_named(
    attributes, factors, tmp_path
):
    path = tmp_path / 'log.h5'
    with h5py.File(path, 'w') as file:
        file['v'] = np.array([1.0, -9.0, 3.0])
        file['v'].attrs.update(attributes)
    signals = foreign.read_signals(path, 'hdf')
    assert signals.head().factors == factors
    expected = [1.0, -9.0, 3.0] if factors else [2.5, math.nan, 3.5]
    np.testing.assert_array_equal(signals.frame['v'], expected)


@pytest.mark.parametrize('unit', ['N', b'N', ['N'], np.array([b'N']), np.array([['N']], object)])
def test_a_unit_of_a_dataset_may_be_an_array_of_one(unit, tmp_path):
    path = tmp_path / 'log.h5'
    with h5py.File(path, 'w') as file:
        file['force'] = SPEED
        file['force'].attrs['units'] = unit
    assert foreign.read_signals(path, 'hdf').frame.columns == ['force [N]']


@pytest.mark.parametrize(
    ('attribute', 'of_rate'),
    [
        ('sample_rate', lambda rate: rate),
        ('fs', lambda rate: np.array([rate])),
        ('Sampling_Time', lambda rate: 1.0 / rate),
        ('dt', lambda rate: 1.0 / rate),
    ],
)
@pytest.mark.parametrize('rates', [(100.0, 20.0), (50.0, 50.0)])
def test_datasets_have_the_times_of_their_own_rates(attribute, of_rate, rates, tmp_path):
    path, stated = tmp_path / 'log.h5', dict(zip(('x_vel_mm_s', 'x_force_N'), rates, strict=True))
    with h5py.File(path, 'w') as file:
        for name, rate in stated.items():
            file[name] = np.sin(np.arange(int(11 * rate)) / rate)
            file[name].attrs[attribute] = of_rate(rate)
    made = guess(path)
    axis = made.content['axes']['x']
    times = [axis[kind].get('time', made.content['time']['column']) for kind in ('speed', 'load')]
    assert len({*times}) == len({*rates})
    for name, time in zip(stated, times, strict=True):
        rows = open_table(path, [name, time]).head(9999)
        known = np.isfinite(rows[time])
        expected = np.sin(rows[time][known])
        np.testing.assert_allclose(rows[name][known], expected, atol=1e-9)
        assert rows[time][known][1] == pytest.approx(1.0 / stated[name])


@pytest.mark.parametrize('change', ['t0', 'start_time', 'rate', 'no', 'time'])
def test_rates_of_datasets_that_may_be_others_are_asked_for(change, tmp_path):
    """A start of their own, a rate of whatever, one without a rate, or a time beside them."""
    path = tmp_path / 'log.h5'
    with h5py.File(path, 'w') as file:
        for name in ('x_vel_mm_s', 'x_force_N'):
            file[name] = np.sin(np.arange(99))
            if change != 'no' or name == 'x_force_N':
                file[name].attrs['rate' if change == 'rate' else 'fs'] = 10.0
        if change in ('t0', 'start_time'):
            file['x_force_N'].attrs[change] = 5.0
        if change == 'time':
            file['t_s'] = np.arange(99) / 100
    names = source_of(path).names()
    assert names == sorted({'x_vel_mm_s', 'x_force_N', *['t_s'] * (change == 'time')})


def test_values_on_change_stand_still_between(tmp_path):
    path = tmp_path / 'mill.shdr'
    lines = [f'2025-07-14T11:59:{50 + row / 10:06.3f}Z|Xact|{row}' for row in range(40)]
    lines += ['2025-07-14T12:00:20.000Z|avail|AVAILABLE', '2025-07-14T12:00:20.000Z|Xact|40']
    path.write_text('\n'.join(lines) + '\n')
    series = read_series(path, make_map(guess(path).content))
    rows = [rows for (rows,) in series.blocks()]
    stamps = np.concatenate([one.stamps for one in rows])
    speed = np.concatenate([one.columns['x.speed'] for one in rows])
    still = (stamps - stamps[0] > 5e9) & (stamps - stamps[0] < 29e9)
    assert np.diff(stamps).max() < 0.2e9
    assert still.sum() > 200
    np.testing.assert_allclose(speed[still], 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ('content', 'key', 'module'),
    [(b'TDSm\x0e', 'tdms', 'nptdms'), (b'MDF     4.10', 'mdf', 'asammdf')],
)
def test_a_reader_that_is_not_installed_is_named(
    content, key, module, tmp_path, monkeypatch, refused
):
    monkeypatch.setitem(sys.modules, module, None)
    path = tmp_path / 'log.bin'
    path.write_bytes(content + bytes(64))
    refused(key, guess, path)


@pytest.mark.parametrize(
    ('content', 'key'),
    [
        (b'[1, {"a": 2}]', 'no_json'),
        (b'{"Header": 3, "a": [{"b": 1}, 3]}', 'no_json'),
        (b'<tools><tool id="0" length="1.5"/></tools>', 'no_xml'),
        (b'MATLAB 5.0' + bytes(200), 'no_mat'),
        (b'\x89HDF\r\n\x1a\n' + bytes(200), 'no_hdf'),
    ],
)
def test_a_file_that_is_not_as_its_kind_is_one_sentence(content, key, tmp_path, refused):
    path = tmp_path / 'log'
    path.write_bytes(content)
    refused(key, guess, path)


@pytest.mark.parametrize('error', [KeyError('a'), IndexError(), TypeError('x'), ValueError('y')])
@pytest.mark.parametrize(
    ('kind', 'key'),
    [
        ('json', 'no_json'),
        ('shdr', 'no_shdr'),
        ('echo', 'no_echo'),
        ('long', 'no_long'),
        ('xml', 'no_xml'),
    ],
)
def test_no_reader_says_what_python_says(kind, key, error, tmp_path, monkeypatch, refused):
    def read(path):
        raise error

    broken = dataclasses.replace(foreign.KINDS[kind], read=read)
    monkeypatch.setitem(foreign.KINDS, kind, broken)
    path = tmp_path / 'log'
    path.write_text('{}')
    refused(key, foreign.read_signals, path, kind)


def of_groups(path, lengths):
    """Write an HDF5 file with a group of signals of each length, and what holds no signals."""
    with h5py.File(path, 'w') as file:
        for name, length in lengths.items():
            for signal, unit, values in (('time', 's', TIME), ('x_velocity', 'mm/s', SPEED)):
                file[f'{name}/{signal}'] = values[:length]
                file[f'{name}/{signal}'].attrs['unit'] = unit
        file['pictures'] = np.zeros((3, 4, 5))
        file['words'] = [b'ab', b'cd']


@pytest.mark.parametrize('later', [COUNT, COUNT // 2])
def test_groups_of_arrays_that_are_not_read_are_named(later, tmp_path, says):
    path = tmp_path / 'log.h5'
    of_groups(path, {'first': COUNT, 'later': later})
    for name, length, other in (('first', COUNT, 'later'), ('later', later, 'first')):
        speed = {'column': f'{name}.x_velocity [mm/s]', 'unit': 'mm/s'}
        time = {'column': f'{name}.time [s]', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
        mapping = {'time': time, 'axes': {'x': {'speed': speed, 'lead_mm': 10.0}}}
        series = read_series(path, make_map(mapping))
        speeds = np.concatenate([rows[0].columns['x.speed'] for rows in series.blocks()])
        np.testing.assert_allclose(speeds, math.tau * SPEED[:length] / 10.0)
        assert series.unread == {
            other: says('no_column'),
            'pictures': says('array'),
            'words': says('no_numbers'),
        }


RECORDS = {
    'log.json': lambda names: json.dumps([{name: 1.5} for name in names]),
    'log.xml': lambda names: '<t>' + ''.join(f'<rec {name}="1.5"/>' for name in names) + '</t>',
}


@pytest.mark.parametrize('name', RECORDS)
@pytest.mark.parametrize('count', [100, 101])
def test_records_of_many_names_are_read_by_a_process_of_its_own(
    name, count, tmp_path, monkeypatch
):
    path, tasks, result = tmp_path / name, [], apart.result_apart
    path.write_text(RECORDS[name]([f'a{at}' for at in range(count)]))

    def counted(task, inputs, **options):
        tasks.append(task)
        return result(task, inputs, **options)

    monkeypatch.setattr(apart, 'result_apart', counted)
    monkeypatch.setattr(foreign.limits, 'CELLS_HERE', 100 * 100 * 64)
    assert foreign.read_signals(path, name[4:]).frame.shape == (count, count)
    assert bool(tasks) is (count > 100)


@pytest.mark.parametrize('name', RECORDS)
@pytest.mark.parametrize(
    ('key', 'limit', 'most'),
    [('records_room', 'SPARSE', 20 * 20 * 64 - 1), ('records_wide', 'COLUMNS', 19)],
)
def test_records_are_counted_before_they_are_cells(
    name, key, limit, most, tmp_path, monkeypatch, refused
):
    path = tmp_path / name
    path.write_text(RECORDS[name]([f'a{at}' for at in range(20)]))
    monkeypatch.setattr(json_layouts, 'side_by_side', None)
    monkeypatch.setattr(foreign.limits, limit, most)
    refused(key, foreign.read_signals, path, name[4:])


@pytest.mark.parametrize('name', ['trace.json', 'log.mat'])
def test_a_process_of_its_own_reads_the_same(name, tmp_path, monkeypatch):
    path, kind = tmp_path / name, name.partition('.')[2]
    WRITERS[name](path)
    monkeypatch.setattr(foreign.limits, 'TEXT', 1000)
    here = foreign.read_signals(path, kind)
    monkeypatch.undo()
    monkeypatch.setattr(foreign.limits, 'TEXT', 1000)
    path.touch()
    there = foreign.read_signals(path, kind)
    assert there.frame.equals(here.frame)
    assert repr(there.head()) == repr(here.head())  # a period may be NaN
    assert there.left_out == here.left_out


FAR = 100_000_000  # rows, which come to 800 MB
SCALARS = {f'scalar_{at}': () for at in range(99)}


def hdf_of_shapes(path, shapes):
    """Write datasets of which nothing is stored: they hold zeros."""
    with h5py.File(path, 'w') as file:
        for name, shape in shapes.items():
            packed = {'chunks': (1000, *shape[1:]), 'compression': 'gzip'} if shape else {}
            file.create_dataset(name, shape, 'u1', **packed)


@pytest.mark.parametrize(
    ('key', 'shapes'),
    [
        ('long', {'speed': (FAR,)}),
        (
            'uneven',
            {f'scalar_{at}': () for at in range(99)}
            | {'speed': (FAR // 10,)}
            | {f'last_{at}': (2000,) for at in range(9)},
        ),
        ('matrix', {'runs': (FAR // 10, 9)}),
    ],
)
def test_arrays_that_come_to_more_than_is_allowed_are_not_read(
    key, shapes, tmp_path, refused, monkeypatch
):
    path = tmp_path / 'log.h5'
    hdf_of_shapes(path, shapes)
    monkeypatch.setattr(h5py.Dataset, '__getitem__', None)
    refused(key, foreign.read_signals, path, 'hdf')


def test_arrays_that_are_no_columns_are_not_read(tmp_path, says):
    path = tmp_path / 'log.h5'
    hdf_of_shapes(path, {'film': (FAR, 200, 300)})
    with h5py.File(path, 'a') as file:
        file['v'] = SPEED
    signals = foreign.read_signals(path, 'hdf')
    assert signals.frame.columns == ['v']
    assert signals.left_out == {'film': says('film')}


@pytest.mark.parametrize('kind', ['double', 'uint8'])
def test_variables_of_matlab_are_counted_before_they_are_unpacked(
    kind, tmp_path, refused, monkeypatch
):
    path = tmp_path / 'log.mat'
    values = np.zeros((2000, 5), np.float64 if kind == 'double' else np.uint8)
    scipy.io.savemat(path, {'runs': values, 't': TIME}, do_compression=True)
    monkeypatch.setattr(foreign.limits, 'SPARSE', 90_000)
    monkeypatch.setattr(scipy.io, 'loadmat', None)
    refused('variables', foreign.read_signals, path, 'mat')


@pytest.mark.parametrize(
    ('key', 'content'),
    [
        ('wide_records', [{f'{at}': 0.0} for at in range(100)]),
        ('wide_lists', {'a': [0.0] * 1000} | {f'{at}': [0.0, 1.0] for at in range(9)}),
    ],
)
def test_names_of_json_that_come_to_many_cells_are_counted_before(
    key, content, tmp_path, refused, monkeypatch
):
    path = tmp_path / 'log.json'
    path.write_text(json.dumps(content))
    monkeypatch.setattr(foreign.limits, 'SPARSE', 79_000)
    refused(key, foreign.read_signals, path, 'json')


def test_names_of_a_trace_that_come_to_many_cells_are_counted_before(
    tmp_path, refused, monkeypatch
):
    path = tmp_path / 'log.xml'
    path.write_text(''.join(['<t>', *(f'<rec f{at}="1"/>' for at in range(100)), '</t>']))
    monkeypatch.setattr(foreign.limits, 'SPARSE', 79_000)
    refused('wide_records', foreign.read_signals, path, 'xml')


def test_lists_of_lists_are_named(tmp_path, says):
    """Each of their records may hold names of its own, which would be columns of all."""
    path = tmp_path / 'log.json'
    lists = {'t_s': [*range(9)], 'parts': [0.0, *({f'{at}': at} for at in range(8))]}
    path.write_text(json.dumps(lists))
    signals = foreign.read_signals(path, 'json')
    assert signals.left_out == {'parts': says('cells')}
    assert signals.frame.columns == ['t_s']


def test_cells_of_records_that_are_lists_are_named(tmp_path, says):
    records = [{'t_s': at, 'parts': [{f'{at}': at}]} for at in range(9)]
    path = tmp_path / 'log.json'
    path.write_text(json.dumps(records))
    signals = foreign.read_signals(path, 'json')
    assert signals.left_out == {'parts': says('cells')}
    assert signals.frame['t_s'].to_list() == [*range(9)]


def test_records_beside_those_that_are_read_are_named(tmp_path, says):
    records = [{'time [s]': time, 'x velocity [mm/s]': 7.0} for time in TIME.tolist()]
    path = tmp_path / 'log.json'
    path.write_text(json.dumps({'run': records, 'other': records}))
    assert foreign.read_signals(path, 'json').left_out == {'other': says('records')}


NUMBERS_OF_ONE_PERIOD = [
    ({'fs': 500.0}, 500.0),
    ({'dt': STEP}, 500.0),
    ({'Ts': STEP, 'gain_of_loop': 3.0}, 500.0),
    ({'inverter': {'frequency': 8000.0}}, None),
    ({'motion': {'period': 0.5}}, None),
    ({'fs': 500.0, 'filter': {'fs': 1000.0}}, None),
    ({'dt': STEP, 'filter': {'period': 0.5}}, None),
    ({'controller': {'Ts': 0.001}}, None),
    ({'frequency': 50.0}, None),
    ({'dt': 2.0}, None),
    ({'fs': 0.5}, None),
]


def fields_of(content, before=''):
    """Return the numbers of nested structures with their paths in HDF5."""
    for key, value in content.items():
        if isinstance(value, dict):
            yield from fields_of(value, f'{before}{key}/')
        else:
            yield f'{before}{key}', value


@pytest.mark.parametrize('kind', ['mat', 'h5'])
@pytest.mark.parametrize(('numbers', 'rate'), NUMBERS_OF_ONE_PERIOD)
def test_a_number_is_the_rate_if_it_is_the_only_one_beside_the_arrays(
    numbers, rate, kind, tmp_path
):
    path = tmp_path / f'log.{kind}'
    content = {'x_vel_mm_s': SPEED, 'x_force_N': 10.0 * SPEED} | numbers
    if kind == 'mat':
        scipy.io.savemat(path, content)
    else:
        with h5py.File(path, 'w') as file:
            for name, value in fields_of(content):
                file[name] = value
    result = guess(path)
    assert result.content['time']['rate_Hz'] == rate
    names = [name.replace('/', '.') for name, value in fields_of(numbers) if name[:4] != 'gain']
    assert rate or all(name in ' '.join(result.unstated) for name in names)


@pytest.mark.parametrize(
    ('numbers', 'factors'),
    [
        ({'scale': 2.0}, 'scale 2.0'),
        ({'cal': {'x_vel_mm_s': 2.0}}, 'cal.x_vel_mm_s 2.0'),
        ({'offset': 3.0, 'gain': 1.0}, 'offset 3.0'),
        ({'scale': 1.0, 'offset': 0.0, 'mass': 3.0}, ''),
    ],
)
@pytest.mark.parametrize('kind', ['mat', 'json', 'records'])
def test_numbers_beside_the_signals_that_may_scale_them_are_named(
    numbers, factors, kind, tmp_path
):
    path = tmp_path / f'log.{"mat" if kind == "mat" else "json"}'
    signals = {'t_s': TIME, 'x_vel_mm_s': SPEED}
    lists = {name: values.tolist() for name, values in signals.items()}
    if kind == 'mat':
        scipy.io.savemat(path, signals | numbers)
    elif kind == 'json':
        path.write_text(json.dumps(lists | numbers))
    else:
        names = list(lists)
        rows = [dict(zip(names, row, strict=True)) for row in zip(*lists.values(), strict=True)]
        path.write_text(json.dumps(numbers | {'samples': rows}))
    assert foreign.read_signals(path, 'mat' if kind == 'mat' else 'json').factors == factors


def records_of(begin=0.0, rows=COUNT):
    return [
        {'t_s': begin + TIME[row], 'x_velocity_mm_s': SPEED[row], 'x_force_N': 5.0 * SPEED[row]}
        for row in range(rows)
    ]


def json_of_runs(path, others):
    runs = {f'run{number}': records for number, records in enumerate([records_of(), *others])}
    path.write_text(json.dumps(runs))


def mat_of_runs(path, others):
    runs = {
        f'run{number}': {key: np.array([one[key] for one in records]) for key in records[0]}
        for number, records in enumerate([records_of(), *others])
    }
    scipy.io.savemat(path, runs)


def hdf_of_runs(path, others):
    with h5py.File(path, 'w') as file:
        for number, records in enumerate([records_of(), *others]):
            for key in records[0]:
                file[f'run{number}/{key}'] = [one[key] for one in records]


MAP_OF_RUNS = {
    'time': {'column': 't_s', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'},
    'axes': {
        'x': {
            'lead_mm': 10.0,
            'speed': {'column': 'x_velocity_mm_s', 'unit': 'mm/s'},
            'load': {'column': 'x_force_N', 'unit': 'N'},
        }
    },
}


@pytest.mark.parametrize('others', [[], [400], [250, 30]])
@pytest.mark.parametrize('write', [json_of_runs, mat_of_runs, hdf_of_runs])
def test_runs_that_are_not_read_count_as_rows_that_there_should_be(tmp_path, write, others):
    path = tmp_path / 'log.data'
    write(path, [records_of(20.0 * (at + 1), rows) for at, rows in enumerate(others)])
    before = '' if write is json_of_runs else 'run0.'
    text = json.dumps(MAP_OF_RUNS)
    for name in ('t_s', 'x_velocity_mm_s', 'x_force_N'):
        text = text.replace(f'"{name}"', f'"{before}{name}"')
    log = TableLog(path, make_map(json.loads(text)))
    assert {*log.promised.values()} == {COUNT + sum(others)}
    assert {topic.count for topic in log.topics.values()} == {COUNT}
    assert ('not read' in log.absent) is bool(others)


def test_events_beside_the_samples_are_no_samples(tmp_path):
    path = tmp_path / 'log.json'
    events = [{'t_s': 1.0, 'text': 'door'}] * 30
    path.write_text(json.dumps({'samples': records_of(), 'events': events}))
    assert {*TableLog(path, make_map(MAP_OF_RUNS)).promised.values()} == {COUNT}


def test_json_that_nests_deeply_is_refused_before_it_is_a_table(tmp_path, refused):
    path = tmp_path / 'log.json'
    deep = '[' * 900 + ']' * 900
    path.write_text('[' + ','.join([f'{{"t": 0.0, "x speed": {deep}}}'] * 3) + ']')
    refused('deep_records', guess, path)


def of_arrays(kind, path, arrays):
    if kind == 'mat':
        scipy.io.savemat(path, arrays)
    elif kind == 'json':
        path.write_text(
            json.dumps({name: np.asarray(one).tolist() for name, one in arrays.items()})
        )
    else:
        with h5py.File(path, 'w') as file:
            for name, values in arrays.items():
                file[name] = values


@pytest.mark.parametrize('kind', ['mat', 'h5', 'json'])
@pytest.mark.parametrize('time', [{'time_s': TIME}, {'dt': STEP}, {}])
@pytest.mark.parametrize('count', [COUNT // 2, COUNT - 1, 2 * COUNT])
def test_an_array_of_another_length_than_its_time_has_no_known_time(
    kind, time, count, tmp_path, says, refused
):
    path = tmp_path / f'log.{kind}'
    arrays = {'x_vel_mm_s': SPEED, 'x_force_N': 50.0 * np.cos(np.arange(count))}
    of_arrays(kind, path, time | arrays)
    made = guess(path)
    beside = 'time_s' if 'time_s' in time else 'x_vel_mm_s'
    assert made.content['axes']['x']['load']['time'] is None
    expected = says('uneven_arrays', count=count, beside=beside)
    assert any(one.endswith(expected) for one in made.unstated)
    if 'time_s' not in time:
        assert made.content['time'] == {'rate_Hz': None}
    content = made.content | ({} if 'time_s' in time else {'time': {'rate_Hz': 500.0}})
    del content['axes']['x']['load']['time']
    with refused('uneven_columns', count=count, beside=beside):
        read_series(path, make_map(content))


def test_an_array_that_is_no_signal_does_not_hide_the_rate(tmp_path):
    path = tmp_path / 'log.mat'
    arrays = {'x_vel_mm_s': SPEED, 'x_force_N': SPEED, 'table': np.arange(5.0), 'dt': STEP}
    scipy.io.savemat(path, arrays)
    assert guess(path).content['time'] == {'rate_Hz': 500.0}


def test_arrays_of_texts_with_units_have_lengths_as_well(tmp_path, says):
    path = tmp_path / 'log.json'
    speeds = [f'{at % 7} mm/s' for at in range(80)]
    path.write_text(json.dumps({'t [s]': [at / 10 for at in range(100)], 'x speed': speeds}))
    made = guess(path)
    assert made.content['axes']['x']['speed'] == {
        'column': 'x speed [mm/s]',
        'unit': 'mm/s',
        'time': None,
    }
    assert any(says('uneven_texts') in one for one in made.unstated)
