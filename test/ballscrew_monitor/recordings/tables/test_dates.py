# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Logs with a relative time, dated by their names, their heads or their files."""

import datetime
import os
import pathlib
import tempfile

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.dates import date_in_name
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import make_map
from hypothesis import given
from hypothesis import strategies as st
import polars as pl
import pytest
from surrogate.files import InputError

MOMENT = datetime.datetime(2025, 7, 14, 11, 59, 50, tzinfo=datetime.UTC)
MIDNIGHT = MOMENT.replace(hour=0, minute=0, second=0)
DAYS = '%Y-%m-%d', '%Y%m%d', '%Y_%m_%d', '%d.%m.%Y', '%d-%m-%Y'
TIMES = 'T%H%M%S', '_%H%M%S', '_%H-%M-%S', ' %H.%M.%S', '_%H%M'


def content(**changes):
    return {
        'time': {'column': 't', 'unit': 's'},
        'axes': {'x': {'speed': {'column': 'v', 'unit': 'rad/s'}, 'lead_mm': 10.0}},
        **changes,
    }


def write(path, head=''):
    path.parent.mkdir(exist_ok=True)
    path.write_text(head + 't,v\n' + ''.join(f'{0.1 * n:.1f},{5 + n % 2}\n' for n in range(100)))
    return path


@pytest.mark.parametrize('day', DAYS)
@pytest.mark.parametrize('around', ['{}', 'x_{}', 'axis1-{}_log', '3 {} b'])
def test_a_name_dates_a_log(day, around):
    assert date_in_name(around.format(MOMENT.strftime(day))) == MIDNIGHT
    for time in TIMES:
        found = date_in_name(around.format(MOMENT.strftime(day + time)))
        assert found == MOMENT.replace(second=50 if '%S' in time else 0)


@given(
    st.datetimes(datetime.datetime(1971, 1, 1), datetime.datetime(2099, 12, 31)),
    st.sampled_from(DAYS),
    st.sampled_from(TIMES),
)
def test_any_moment_is_read_as_it_was_written(moment, day, time):
    moment = moment.replace(microsecond=0, tzinfo=datetime.UTC)
    name = f'log_{moment.strftime(day + time)}'
    written = datetime.datetime.strptime(name, f'log_{day}{time}').replace(tzinfo=datetime.UTC)
    either = day == '%d-%m-%Y' and moment.day <= 12 and moment.day != moment.month
    assert date_in_name(name) == (None if either else written)
    assert date_in_name(name, 'dmy') == written


@pytest.mark.parametrize(
    'name',
    ['log', 'log_0001', '12345678', '2025-13-14', '202507141', 'v2.0.25', '2025-07', '30.02.2025'],
)
def test_a_name_without_a_date_has_none(name):
    assert date_in_name(name) is None


@pytest.mark.parametrize('name', ['03-06-2024', 'x_03_06_2024', '03-06-2024_10-15-00'])
def test_a_name_of_either_order_dates_a_log_by_that_of_the_map(name, tmp_path, refused, says):
    log = write(tmp_path / '2025-07-14' / f'{name}.csv')
    mapping = content(date_from='name')
    with refused('either_name', log=log, date=name.removeprefix('x_')):
        TableLog(log, make_map(mapping))
    for order, day in (('dmy', (2024, 6, 3)), ('mdy', (2024, 3, 6))):
        mapping['time']['order'] = order
        assert begin_of(log, mapping).date() == datetime.date(*day)
    log.write_text(log.read_text().replace('t,v', 't [s],X speed [mm/s]'))
    epoch = guess(log).content['assumed']['time.epoch']
    assert epoch['value'].startswith('2000')
    assert says('either_date', date=name.removeprefix('x_')) in epoch['reason']


@pytest.mark.parametrize('name', ['03.06.2024', '20240603', '2024-06-03', '2024_06_03'])
def test_a_date_with_dots_has_the_day_first_and_one_with_the_year_first_the_month(name):
    assert date_in_name(name).date() == datetime.date(2024, 6, 3)


def test_two_logs_of_a_day_with_a_number_have_one_date():
    assert date_in_name('2025-07-14_1') == date_in_name('2025-07-14_2') == MIDNIGHT


@pytest.mark.parametrize(
    'head',
    [
        'Start;14.07.2025 11:59:50\n',
        'Date;2025-07-14\nTime;11:59:50.000\n',
        '# created 2025/07/14, 11:59:50\n',
        'File version 20250713\nDatum: 14.07.2025\nUhrzeit: 11:59:50\n',
    ],
)
def test_a_head_dates_a_log(head, tmp_path):
    assert begin_of(write(tmp_path / 'a.csv', head), content(date_from='header')) == MOMENT


@pytest.mark.parametrize(
    ('start', 'order', 'moment'),
    [
        ('22-7-2026 09:14:03', '', (2026, 7, 22, 9, 14, 3)),
        ('5-2-2025 06:59:42', 'dmy', (2025, 2, 5, 6, 59, 42)),
        ('5-2-2025 06:59:42', 'mdy', (2025, 5, 2, 6, 59, 42)),
        ('7-7-2025 06:59:42', '', (2025, 7, 7, 6, 59, 42)),
        ('Mon Jul  7 06:59:42 2025', '', (2025, 7, 7, 6, 59, 42)),
    ],
)
def test_the_start_of_a_head_dates_a_log(tmp_path, start, order, moment):
    log = write(tmp_path / 'a.csv', f'Scope Export\nStartTime,{start}\n\n')
    mapping = content(date_from='header')
    mapping['time'] |= {'order': order} if order else {}
    assert begin_of(log, mapping) == datetime.datetime(*moment, tzinfo=datetime.UTC)


@pytest.mark.parametrize(
    ('text', 'dates'),
    [
        ('5-2-2025 06:59:42', {'dmy': '2025-02-05', 'mdy': '2025-05-02'}),
        ('25/07/11 06:59:42', {'dmy': '2011-07-25', 'ymd': '2025-07-11'}),
        ('25.07.11', {'dmy': '2011-07-25', 'ymd': '2025-07-11'}),
        ('11-07-10', {'dmy': '2010-07-11', 'mdy': '2010-11-07', 'ymd': '2011-07-10'}),
    ],
)
def test_a_start_of_several_orders_is_refused_until_the_map_says_it(
    text, dates, tmp_path, refused
):
    log = write(tmp_path / 'a.csv', f'Scope Export\nStartTime,{text}\n\n')
    mapping = content(date_from='header')
    with refused(
        'either_order', log=log, orders=' or '.join(map('time: {{order: {}}}'.format, dates))
    ):
        TableLog(log, make_map(mapping))
    for order, day in dates.items():
        mapping['time']['order'] = order
        assert f'{begin_of(log, mapping).date()}' == day


STARTS = 'Start', 'Start time', 'Measurement start', 'T0 ', 'Messbeginn', 'Trigger time'
LATER = 'Created', 'Exported', 'Saved at', 'Date', 'Druckdatum'


@given(
    st.sampled_from(STARTS),
    st.sampled_from(LATER),
    st.booleans(),
    st.sampled_from([': ', ';', ' = ']),
)
def test_the_start_of_a_measurement_dates_it_whatever_else_is_dated(start, other, first, sign):
    lines = [f'{start}{sign}14.07.2025 11:59:50', f'{other}{sign}16.07.2025 08:00:00']
    assert begin_by_head('\n'.join(lines[:: 1 if first else -1])) == MOMENT


@pytest.mark.parametrize(
    'head',
    [
        'Start date: 14.07.2025\nStart time: 11:59:50\nEnd date: 15.07.2025\nEnd time: 00:00:08',
        'Date;2025-07-14\nMeasurement start;2025-07-14 11:59:50',
        'DATE=14.07.2025\nT0 = 14.07.2025 11:59:50',
        'Date: 14.07.2025 00:00\nStart time: 11:59:50',
        'Test date: 14.07.2025; Start: 11:59:50',
        'Created: 2025-07-15 08:00:00\nDate: 2025-07-14\nTime: 11:59:50',
        'Date (yy/mm/dd): 25/07/14\nTime: 11:59:50',
        'Datum (TT.MM.JJ): 14.07.25\nUhrzeit: 11:59:50',
        'StartTime,7/14/2025 11:59:50 AM,133969823900000000',
        'StartTime;7/14/2025 11:59:50 AM;133969823900000000',
        'StartTime\t7/14/2025 11:59:50 AM\t133969823900000000',
    ],
)
def test_lines_of_a_head_that_date_the_start_together(head):
    assert begin_by_head(head) == MOMENT


@pytest.mark.parametrize(
    ('key', 'head'),
    [
        ('two_starts', 'Start: 2025-07-14 11:59:57\nTrigger time: 2025-07-14 12:30'),
        ('head_without_day', 'Created: 2025-07-15 08:00:00\nStart time: 11:59:57'),
    ],
)
def test_starts_that_contradict_each_other_date_nothing(key, head, tmp_path, refused, says):
    log = write(tmp_path / 'a.csv', f'{head}\n\n')
    with refused(key, log=log):
        TableLog(log, make_map(content(date_from='header')))
    log.write_text(log.read_text().replace('t,v', 't [s],X speed [mm/s]'))
    epoch = guess(log).content['assumed']['time.epoch']
    assert epoch['value'].startswith('2000')
    assert says(key, log='').removeprefix('log : ') in epoch['reason']


def test_a_date_without_a_time_of_day_is_said_to_be_one(tmp_path):
    log = write(tmp_path / 'a.csv', 'Date: 2025-07-14\n\n')
    log.write_text(log.read_text().replace('t,v', 't [s],X speed [mm/s]'))
    (found,) = [line for line in guess(log).picture if line.startswith('Found')]
    begin = 'start 2025-07-14 00:00:00 from line 1, a date without a time of day'
    assert begin in found


@pytest.mark.parametrize(
    ('name', 'dates'),
    [
        ('07-14-2025_11-59-50', {'mdy': MOMENT}),
        ('14072025', {'dmy': MIDNIGHT}),
        ('250714_115950', {'dmy': MOMENT.replace(year=2014, day=25), 'ymd': MOMENT}),
        ('25-07-14', {'dmy': MIDNIGHT.replace(year=2014, day=25), 'ymd': MIDNIGHT}),
    ],
)
def test_a_name_may_hold_a_date_in_other_forms(name, dates, tmp_path, says):
    log = write(tmp_path / f'feed_{name}.csv')
    for order, moment in dates.items():
        mapping = content(date_from='name')
        mapping['time'] |= {'order': order} if len(dates) > 1 else {}
        assert begin_of(log, mapping) == moment
    log.write_text(log.read_text().replace('t,v', 't [s],X speed [mm/s]'))
    made = guess(log)
    assert ('date_from' in made.content) is (len(dates) == 1)
    if len(dates) > 1:
        readings = ' or '.join(
            f'{moment.date()} by time: {{order: {order}}}' for order, moment in dates.items()
        )
        reason = made.content['assumed']['time.epoch']['reason']
        assert says('short_name', date=name, readings=readings) in reason


def test_a_log_begins_at_its_date(tmp_path):
    folder = tmp_path / '2025-07-13'
    folder.mkdir()
    named = write(tmp_path / '20250714_115950.csv')
    headed = write(tmp_path / 'headed.csv', '# 14.07.2025 11:59:50\n')
    modified = write(tmp_path / 'modified.csv')
    os.utime(modified, (0, MOMENT.timestamp()))
    for log, place in ((named, 'name'), (headed, 'header'), (modified, 'modified')):
        assert begin_of(log, content(date_from=place)) == MOMENT
    in_folder = begin_of(write(folder / 'a.csv'), content(date_from='name'))
    assert in_folder == MIDNIGHT - datetime.timedelta(days=1)


def begin_by_head(head):
    with tempfile.TemporaryDirectory() as folder:
        log = write(pathlib.Path(folder) / 'a.csv', f'{head}\n\n')
        return begin_of(log, content(date_from='header'))


def begin_of(log, mapping):
    table = TableLog(log, make_map(mapping))
    assert table.end_time - table.start_time == pytest.approx(9.9 * SECOND)
    return datetime.datetime.fromtimestamp(table.start_time / SECOND, datetime.UTC)


def test_an_assumed_epoch_gives_way_and_is_not_told(tmp_path):
    guessed = {'time.epoch': {'value': '2000-01-01T00:00:00Z', 'reason': 'it counts from 0'}}
    mapping = content(date_from='name', assumed=guessed)
    assert begin_of(write(tmp_path / '2025-07-14.csv'), mapping) == MIDNIGHT
    assert make_map(mapping).assumptions == ()


@pytest.mark.parametrize(
    ('key', 'changes'),
    [
        ('not_known', {'date_from': 'folder'}),
        ('blank', {'date_from': None}),
        ('both', {'date_from': 'name', 'time': {'rate_Hz': 10.0, 'epoch': '2000-01-01'}}),
    ],
)
def test_a_map_that_dates_wrongly_is_refused(key, changes, refused):
    refused(key, make_map, content(**changes))


def test_a_log_without_a_date_is_refused(tmp_path, refused):
    log = write(tmp_path / 'log_0001.csv')
    os.utime(log, (0, 1000))
    for place, key in (('name', 'no_name'), ('header', 'no_header'), ('modified', 'no_modified')):
        with refused(key, log=log):
            TableLog(log, make_map(content(date_from=place)))


def test_the_head_of_a_binary_table_has_no_date(tmp_path):
    log = tmp_path / 'a.parquet'
    pl.DataFrame({'t': [0.0, 0.1], 'v': [1.0, 2.0]}).write_parquet(log)
    with pytest.raises(InputError, match='date_from header is for texts such as CSV'):
        TableLog(log, make_map(content(date_from='header')))
