# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Channels of TDMS and MDF, as their libraries give them."""

import contextlib
import math
import sys
import types

from ballscrew_monitor.recordings.tables import foreign
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import pytest

pytestmark = pytest.mark.usefixtures('in_this_process')
COUNT, STEP = 400, 0.002
TIME = np.arange(COUNT) * STEP
SPEED = 90.0 * np.sin(math.tau * TIME)  # [mm/s]
PLACE = 150.0 + 90.0 / math.tau * (1.0 - np.cos(math.tau * TIME))  # [mm]
FAR = 100_000_000
START = np.datetime64('2025-07-14T11:59:50.250')
LATER = START + np.timedelta64(1500, 'ms')


class Channel:
    """A channel as npTDMS gives it."""

    def __init__(self, path, values, **properties):
        self.group_name, _, self.name = path.partition('/')
        self.properties = {f'wf_{name}': one for name, one in properties.items() if name != 'unit'}
        self.properties['unit_string'] = properties.get('unit', 'mm')
        self._values = values

    def __len__(self):
        return len(self._values)

    def __getitem__(self, part):
        return self._values[part]


@pytest.fixture
def tdms(tmp_path, monkeypatch):
    """Write a file whose channels npTDMS would give."""

    def write(*channels):
        names = dict.fromkeys(one.group_name for one in channels)
        groups = [
            types.SimpleNamespace(
                channels=lambda name=name: [one for one in channels if one.group_name == name]
            )
            for name in names
        ]
        file = types.SimpleNamespace(groups=lambda: groups)
        opened = types.SimpleNamespace(open=lambda path: contextlib.nullcontext(file))
        monkeypatch.setitem(sys.modules, 'nptdms', types.SimpleNamespace(TdmsFile=opened))
        path = tmp_path / 'log.tdms'
        path.write_bytes(b'TDSm\x0e' + bytes(64))
        return path

    return write


def speed_and_place(*, of_place, later=0.0, **of_both):
    """Return channels of a motion, the position from some time [s] on."""
    wave = {'increment': STEP} | of_both
    place = np.interp(TIME + later, TIME, PLACE)
    return (
        Channel('run/x velocity', SPEED, unit='mm/s', **wave),
        Channel('run/x position', place, **wave | of_place),
    )


def test_waveforms_that_begin_together_have_one_period(tdms):
    channels = speed_and_place(start_time=START, start_offset=0.5, of_place={})
    made = guess(tdms(*channels))
    assert made.content['time'] == {'rate_Hz': 1.0 / STEP}
    assert made.content['date_from'] == 'header'
    assert any('start 2025-07-14 11:59:50' in line for line in made.picture)
    assert foreign.read_signals(tdms(*channels), 'tdms').start.startswith('2025-07-14T11:59:50.75')


@pytest.mark.parametrize(
    'of_place', [{'start_time': START + np.timedelta64(100, 'ms')}, {'start_offset': 0.1}]
)
def test_waveforms_that_begin_apart_have_times_of_their_own(of_place, tdms):
    path = tdms(*speed_and_place(start_time=START, of_place=of_place, later=0.1))
    content = guess(path).content
    assert content['axes']['x']['position']['time'] == 'x position time [s]'
    series = read_series(path, make_map(content))
    rows = [one for blocks in series.blocks() for one in blocks]
    held = {key: [] for one in rows for key in one.columns}
    for one in rows:
        for key, values in one.columns.items():
            held[key].append(np.stack([one.stamps * 1e-9, values]))
    (stamps, speed), (later, place) = (np.hstack(held[f'x.{of}']) for of in ('speed', 'position'))
    assert later[0] - stamps[0] == pytest.approx(0.1, abs=1e-6)
    assert speed[:5] == pytest.approx(SPEED[:5] * math.tau / 10.0)
    assert place[:5] == pytest.approx(PLACE[50:55] * math.tau / 10.0)


def test_waveforms_of_two_rates_have_times_of_their_own(tdms):
    slow = Channel('slow/x temperature', 30.0 + TIME[:9], increment=0.1, start_time=LATER)
    path = tdms(*speed_and_place(start_time=START, of_place={}), slow)
    signals = foreign.read_signals(path, 'tdms')
    times = {
        name: signals.frame[name].drop_nulls().to_numpy()
        for name in signals.frame.columns
        if 'time' in name
    }
    assert [*times] == ['run.x velocity time [s]', 'slow.x temperature time [s]']
    fast, late = times.values()
    np.testing.assert_allclose(fast, TIME, atol=1e-12)
    np.testing.assert_allclose(late, 1.5 + 0.1 * np.arange(9), atol=1e-12)
    assert math.isnan(signals.period)


def test_a_group_without_steps_beside_waveforms_is_named(tdms, says):
    events = Channel('events/t', TIME[:9], unit='')
    path = tdms(*speed_and_place(start_time=START, of_place={}), events)
    signals = foreign.read_signals(path, 'tdms')
    assert signals.left_out == {'events.t': says('no_wave')}
    assert signals.period == STEP
    assert signals.frame.width == 2


def test_a_start_that_was_never_set_is_no_date(tdms):
    """A waveform whose start is 0 counts from 1904, as times of LabVIEW do."""
    never = np.datetime64('1904-01-01T00:00:00')
    content = guess(tdms(*speed_and_place(start_time=never, of_place={}))).content
    assert 'date_from' not in content
    assert content['assumed']['time.epoch']['value'].startswith('2000')


def test_a_step_that_some_channels_lack_is_asked_for(tdms, says):
    path = tdms(*speed_and_place(of_place={'increment': 0.0}))
    made = guess(path)
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated[0].startswith(says('lacking_step'))


@pytest.mark.parametrize(
    ('key', 'of_place', 'of_other'),
    [
        ('no_begin', {'start_time': None}, {'increment': STEP, 'start_time': START}),
        ('no_step', {'start_time': LATER}, {}),
    ],
)
def test_waveforms_of_which_nothing_tells_how_they_stand_to_others_are_refused(
    key, of_place, of_other, tdms, refused
):
    channels = speed_and_place(start_time=START, of_place=of_place)
    path = tdms(*channels, Channel('run/x force', SPEED, unit='N', **of_other))
    refused(key, guess, path)


def test_signals_of_one_time_of_mdf_are_columns_side_by_side(tmp_path, monkeypatch, refused):
    """As asammdf gives them: signals group by group, each with its times."""

    def signal(name, samples, times, unit=''):
        return types.SimpleNamespace(name=name, unit=unit, samples=samples, timestamps=times)

    later = TIME[:50] * 10.0 + 0.0015
    signals = [
        signal('x velocity', SPEED, TIME, 'mm/s'),
        signal('x position', PLACE, TIME.copy(), 'mm'),
        signal('words', np.array([b'a'] * COUNT), TIME),
        signal('x temperature', later, later, 'degC'),
        signal('x temperature', later + 5.0, later, 'degC'),
    ]
    group = types.SimpleNamespace
    file = types.SimpleNamespace(
        groups=[
            group(channel_group=group(cycles_nr=count), channels=[None] * channels)
            for count, channels in ((COUNT, 4), (50, 3))
        ],
        iter_channels=lambda copy_master: iter(signals),
        header=types.SimpleNamespace(start_time='2025-07-14 11:59:50+00:00'),
    )
    monkeypatch.setitem(sys.modules, 'asammdf', types.SimpleNamespace(MDF=lambda path: file))
    path = tmp_path / 'log.mf4'
    path.write_bytes(b'MDF     4.10' + bytes(64))
    frame = foreign.read_signals(path, 'mdf').frame
    assert frame.columns == [
        'x velocity time [s]',
        'x velocity [mm/s]',
        'x position [mm]',
        'x temperature time [s]',
        'x temperature [degC]',
        'x temperature 2 [degC]',
    ]
    for name, times, values in (
        ('x position [mm]', 'x velocity time [s]', PLACE),
        ('x temperature 2 [degC]', 'x temperature time [s]', later + 5.0),
    ):
        known = frame.select(time=times, value=name).drop_nulls()
        np.testing.assert_array_equal(known['time'], TIME if values is PLACE else later)
        np.testing.assert_array_equal(known['value'], values)
    axis = guess(path).content['axes']['x']
    assert axis['temperature']['time'] == 'x temperature time [s]'
    assert 'time' not in axis['speed']
    path.touch()
    monkeypatch.setattr(file, 'iter_channels', None)
    file.groups[1].channel_group.cycles_nr = FAR
    refused('cycles', foreign.read_signals, path, 'mdf')
