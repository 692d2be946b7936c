# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Times that no recording has are refused, with the rows of the file; in no form is a rate wrong.

The true rate is that of the clock which writes the cells here.

"""

import datetime as dt
from pathlib import Path
import tempfile

from ballscrew_monitor.recordings.tables.clocks import moments_of
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.time_gate import AGAIN, TimeGate
from hypothesis import example, given
from hypothesis import strategies as st
import numpy as np
import openpyxl
import polars as pl
import pytest
from surrogate.files import InputError

YEAR = 365.25 * 86400.0  # [s]
EPOCH = '2000-01-01T00:00:00Z'
AXIS = {
    'lead_mm': 10.0,
    'speed': {'column': 'v', 'unit': 'mm/s'},
    'temperature': {'column': 'w', 'unit': 'degC'},
}


def content_of(time):
    return {'time': time, 'axes': {'x': AXIS}}


@pytest.fixture
def read(tmp_path, write_csv):
    """Return a function that reads a table of times t, in [s] unless told otherwise."""

    def make(times, speeds=None, temperatures=None, *, name='log.csv', **time):
        count = len(times)
        columns = {
            't': times,
            'v': [1.0] * count if speeds is None else speeds,
            'w': [40.0] * count if temperatures is None else temperatures,
        }
        path = tmp_path / name
        if name.endswith('.parquet'):
            pl.DataFrame(columns).write_parquet(path)
        elif name.endswith('.xlsx'):
            book = openpyxl.Workbook()
            for row in [list(columns), *zip(*columns.values(), strict=True)]:
                book.active.append(
                    [getattr(cell, 'item', lambda cell=cell: cell)() for cell in row]
                )
            book.save(path)
        else:
            write_csv(path, columns, form='{:.15g}')
        time = {'column': 't', 'unit': 's', 'epoch': EPOCH} | time
        return read_series(path, make_map(content_of(time)))

    return make


def test_more_rows_in_a_second_than_any_table_has_are_refused(read, refused):
    steps = np.arange(500)
    assert read(steps * 1e-5).count == 500
    assert read(1.7e9 + steps * 1e-5, epoch='2026-01-01T00:00:00Z').count == 500
    refused('fast', read, steps / 1.1e5)
    refused('fast_parquet', read, steps / 1.1e5, name='log.parquet')
    days = 45852.4998842593 + steps * 0.05 / 86400
    refused('days', read, days)
    assert read(days, scale=86400).usual_period == pytest.approx(0.05, rel=0.01)


def test_a_counter_that_overflows_often_is_no_time(read, refused):
    refused('overflow', read, np.arange(1200) * 5000 % 65536, unit='us')
    assert read(np.arange(1200) * 1000 % 65536, unit='us').count == 1200


LATE = dt.datetime(2025, 7, 14, 23, 59, 58)
NOON = dt.datetime(2025, 7, 14, 12, 59, 58)  # an hour after which a clock of 12 hours falls


def texts(begin, form, *, lacking=0, day=''):
    """Return 400 times of a clock each 10 ms, of which some lack from the 200th on."""
    rows = np.append(np.arange(200), 200 + lacking + np.arange(200))
    moments = [begin + dt.timedelta(milliseconds=10 * int(row)) for row in rows]
    return [f'{day}{moment:{form}}'[:-3] for moment in moments]


@pytest.mark.parametrize('lacking', [0, 1, 7, 90])
def test_a_time_goes_on_where_rows_lack_as_its_clock_begins_again(lacking, read):
    counter = (
        2**32 - 2_000_000 + 10_000 * np.append(np.arange(200), 200 + lacking + np.arange(200))
    )
    for times, unit in (
        (counter % 2**32, 'us'),
        (texts(LATE, '%H:%M:%S.%f', lacking=lacking), 's'),
        (texts(LATE, '%H:%M:%S.%f', lacking=lacking, day='14.07.2025 '), 's'),
        (texts(NOON, '%I:%M:%S.%f', lacking=lacking), 's'),
    ):
        series = read(times, unit=unit)
        assert (series.count, series.run_begins) == (400, (series.begin,))
        assert (series.end - series.begin) / 1e9 == pytest.approx(0.01 * (399 + lacking))
        assert any('go on' in note for note in series.notes)


def test_a_date_that_stays_beside_times_through_midnight_is_that_of_the_begin(tmp_path, write_csv):
    times = texts(LATE, '%H:%M:%S.%f')
    columns = {'Date': ['14.07.2025'] * 400, 'Time': times, 'X speed [mm/s]': np.arange(400.0)}
    path = write_csv(tmp_path / 'log.csv', columns, separator=';')
    series = read_series(path, make_map(guess(path).content))
    assert series.begin / 1e9 == LATE.replace(tzinfo=dt.UTC).timestamp()
    assert (series.end - series.begin) / 1e9 == pytest.approx(3.99)
    assert any('86400 s in row 202: times go on there' in note for note in series.notes)


def test_a_clock_of_12_hours_beside_dates_is_asked_for_its_halves(read, refused):
    refused('halves', read, texts(NOON, '%d.%m.%Y %I:%M:%S.%f'))


def test_a_log_of_times_up_to_24_h_that_begins_again_12_h_before_has_runs(read):
    times = [*texts(LATE, '%H:%M:%S.%f')[:200], *texts(LATE, '%I:%M:%S.%f')[200:]]
    series = read(times)
    assert len(series.run_begins) == 2
    assert any('each judged apart' in note for note in series.notes)


def test_milliseconds_without_leading_zeros_are_no_time(read, refused):
    times = [f'2026-01-02 11:59:{54 + row // 500}.{2 * row % 1000}' for row in range(1500)]
    refused('no_zeros', read, times)


@pytest.mark.parametrize('period', [40, 50, 80])
def test_milliseconds_without_leading_zeros_are_no_time_at_slow_rates(period, read, refused):
    """Few rows of a second are late then, fewer than those of a run."""
    stamps = [divmod(period * row, 1000) for row in range(200)]
    refused('no_zeros', read, [f'2026-01-02 11:59:{50 + s:02}.{part}' for s, part in stamps])


def test_more_than_ten_years_are_refused(read, refused):
    steps = np.arange(500.0)
    steps[-1] = 10 * YEAR
    assert read(steps).count == 500
    steps[-1] = 10 * YEAR + 1
    refused('span', read, steps)


@given(st.lists(st.permutations(range(5)), min_size=4, max_size=30), st.integers(1, 40))
def test_rows_that_come_a_little_late_are_no_fault(parts, block):
    times = [0.05 * number + row / 100 for number, part in enumerate(parts) for row in part]
    assert gated(np.array([*times, 1e3]), block).fault() == ('', '')


def test_the_order_is_that_of_the_rows_of_the_motion(read, refused):
    """A slow temperature has rows of its own, out of order and with times that others have."""
    rows, nothing = np.arange(400), ['']
    times = [*(rows / 100), *[3.0] * 900, *np.tile(np.arange(50) / 50, 2), 1.0 + 9 * YEAR]
    speeds = [*rows.tolist(), *nothing * 1001]
    temperatures = [*nothing * 400, *[40.0] * 1001]
    assert read(times, speeds, temperatures).count == 1401
    refused('of_the_motion', read, [*times[:200], *times], [*speeds[:200], *speeds])


def test_a_row_far_off_is_refused_though_it_holds_no_motion(read, refused):
    times, speeds = [*(np.arange(300) / 100), 4e8], [*[1.0] * 300, '']
    refused('span_of_all', read, times, speeds)


BEGIN = dt.datetime(2025, 7, 14, 11, 59, 50)
SINCE_1601 = dt.datetime(1601, 1, 1)


def clock(form, *, digits=6):
    """Return what writes a time [s] since the begin in a form, with digits of the second."""

    def write(time):
        at = BEGIN + dt.timedelta(microseconds=round(time * 1e6))
        fraction = f'{at:%f}'[:digits]
        return at.strftime(form).replace('FFF', fraction)

    return write


def number(scale, *, digits=6, first=0.0, wrap=float('inf')):
    """Return what writes a time [s] as a number of units, from a first one on, which may wrap."""
    return lambda time: f'{(first + time * scale) % wrap:.{digits}f}'


UNIVERSAL = BEGIN.replace(tzinfo=dt.UTC).timestamp()
TEXTS = {
    'iso': clock('%Y-%m-%d %H:%M:%S.FFF', digits=3),
    'iso T': clock('%Y-%m-%dT%H:%M:%S.FFFZ'),
    'iso in whole seconds': clock('%Y-%m-%d %H:%M:%S'),
    'zone': clock('%Y-%m-%d %H:%M:%S.FFF+02:00'),
    'German': clock('%d.%m.%Y %H:%M:%S,FFF', digits=3),
    'German of two digits': clock('%d.%m.%y %H:%M:%S,FFF'),
    'year first': clock('%Y/%m/%d %H:%M:%S.FFF'),
    'month first': clock('%m/%d/%Y %H:%M:%S.FFF'),
    'month first, half days': clock('%m/%d/%Y %I:%M:%S.FFF %p'),
    'day first': clock('%d/%m/%Y %H:%M:%S.FFF'),
    'words': clock('%d-%b-%Y %H:%M:%S.FFF'),
    'of the day': clock('%H:%M:%S.FFF'),
    'of half a day': clock('%I:%M:%S.FFF %p'),
    'colon': clock('%H:%M:%S:FFF', digits=3),
    'minutes': clock('%Y-%m-%d %H:%M'),
    'of the hour': clock('%M:%S.FFF', digits=1),
}
STATED = {
    's': number(1.0),
    'ms': number(1e3, digits=3),
    'us': number(1e6, digits=0, first=5e8),
    'ns': number(1e9, digits=0, first=1.7e18),
    'min': number(1 / 60, digits=9),
    'h': number(1 / 3600, digits=10),
}
UNSTATED = {
    'seconds': number(1.0, digits=4),
    'decimal ms': number(1e3, digits=1),
    'decimal min': number(1 / 60, digits=9),
    'decimal h': number(1 / 3600, digits=10),
    'of 1970': number(1.0, digits=5, first=UNIVERSAL),
    'ms of 1970': number(1e3, digits=0, first=1e3 * UNIVERSAL),
    'us of 1970': number(1e6, digits=0, first=1e6 * UNIVERSAL),
    'whole ms': number(1e3, digits=0, first=12.0),
    'whole ticks of 100 us': number(1e4, digits=0),
    'ms that wrap': number(1e3, digits=0, first=65_000.0, wrap=65_536.0),
    'since 1601': number(1e7, digits=0, first=1e7 * (BEGIN - SINCE_1601).total_seconds()),
    'since the year 1': number(1e7, digits=0, first=638_880_911_900_000_000.0),
    'days of a sheet': number(1 / 86400, digits=10, first=45_852.4998842593),
    'since 1904': number(1.0, digits=4, first=UNIVERSAL + 2_082_844_800.0),
    'whole seconds': number(1.0, digits=0, first=UNIVERSAL),
}
NAMES = ('Time', 'Zeit', 'timestamp', 't')
FORMS = (
    [(name, text) for name in NAMES for text in [*TEXTS.values(), *UNSTATED.values()]]
    + [(f'{name} [{unit}]', text) for name in NAMES for unit, text in STATED.items()]
    + [(f'time_{unit}', STATED[unit]) for unit in ('s', 'ms', 'us', 'ns')]
    + [('Name', text) for text in UNSTATED.values()]
)
COUNT = 240


def gated(times, block, *, wall=False):
    """Return the gate that was shown times in blocks, the first of them in row 2."""
    gate = TimeGate(wall=wall)
    for begin in range(0, len(times), block):
        part = slice(begin, begin + block)
        gate.add(times[part], 2 + np.arange(len(times))[part])
    gate.finish()
    return gate


def test_rows_share_times_by_a_rule_or_are_refused(read, refused):
    rows = np.arange(400)
    assert read(rows // 100).usual_period == pytest.approx(0.01)
    refused('equal', read, rows * 2 // 3)  # one row and two have a time in turn
    refused('equal', read, np.round(rows * 0.5))  # as of finer times that were rounded
    refused('equal', read, np.sort(rows**3 % 50))
    refused('equal', read, np.repeat(np.arange(40), rows[:40] % 19 + 1))


@pytest.mark.parametrize('ending', ['csv', 'parquet', 'xlsx'])
def test_a_time_that_begins_again_is_that_of_another_run(read, ending):
    run = np.arange(300) / 100
    series = read(np.tile(run, 3), np.repeat([80.0, -40.0, 10.0], 300), name=f'log.{ending}')
    stamps = np.concatenate([block.stamps for (block,) in series.blocks()]).reshape(3, 300)
    assert (np.diff(stamps, axis=1) == 10_000_000).all()
    assert (stamps[1:, 0] - stamps[:-1, -1] >= 1e9).all()
    first = {'parquet': 1}.get(ending, 2)
    assert f'rows {first + 300} to {first + 599} (2.99 s)' in series.notes[-1]
    assert '3 runs are each judged apart' in series.notes[-1]


def test_a_clock_that_is_set_back_for_winter_goes_on(read):
    begin = dt.datetime(2025, 10, 26, 2, 59, 58)
    true = [dt.timedelta(seconds=row / 20) for row in range(80)]
    times = [begin + one - dt.timedelta(hours=row >= 40) for row, one in enumerate(true)]
    series = read([f'{one:%d.%m.%Y %H:%M:%S.%f}' for one in times])
    stamps = np.concatenate([block.stamps for (block,) in series.blocks()])
    np.testing.assert_allclose(np.diff(stamps), 5e7, atol=1e3)
    assert 'set back by an hour in row 42' in series.notes[-1]


@pytest.mark.parametrize('block', [1, 7, 40, 80])
@pytest.mark.parametrize(
    ('last', 'left_out'),
    [
        ('2025-03-30 01:59:59.97', True),  # of Berlin
        ('2025-03-30 00:59:59.97', True),  # of London
        ('2025-03-09 01:59:59.97', True),  # of New York
        ('2025-10-05 01:59:59.97', True),  # of Sydney
        ('2025-03-31 01:59:59.97', False),  # a Monday
        ('2025-03-30 01:30:00.00', False),
        ('2025-03-30 13:59:59.97', False),
        ('2025-06-29 01:59:59.97', False),
    ],
)
@pytest.mark.parametrize('wall', [True, False])
def test_a_clock_that_is_set_on_for_summer_leaves_out_an_hour(last, left_out, block, wall):
    begin = dt.datetime.fromisoformat(f'{last}+00:00').timestamp()
    times = begin + np.arange(-39, 41) / 20 + 3600.0 * (np.arange(80) >= 40)
    gate = gated(times, block, wall=wall)
    (run,) = gate.runs
    assert run.end - run.begin == pytest.approx(79 / 20 + 3600.0 * (not (wall and left_out)))
    assert gate.shifts([0.0]) == ({42: -3600.0} if wall and left_out else {})


@pytest.mark.parametrize('zone', ['', '+01:00'])
def test_a_log_of_a_night_in_which_summer_begins_has_no_hole(read, zone):
    begin = dt.datetime(2025, 3, 30, 1, 59, 58)
    true = [dt.timedelta(seconds=row / 20) for row in range(80)]
    times = [begin + one + dt.timedelta(hours=row >= 40) for row, one in enumerate(true)]
    series = read([f'{one:%Y-%m-%d %H:%M:%S.%f}{zone}' for one in times])
    stamps = np.concatenate([block.stamps for (block,) in series.blocks()])
    assert stamps[-1] - stamps[0] == pytest.approx(3.95e9 + 3.6e12 * bool(zone))
    assert ('set on by an hour in row 42' in series.notes[-1]) is not bool(zone)


@given(
    st.floats(0.0, 50.0),
    st.lists(st.integers(AGAIN + 1, 60), min_size=2, max_size=5),
    st.integers(1, 70),
)
def test_runs_that_were_appended_are_found(first, counts, block):
    times = np.concatenate([first + np.arange(count) / 100 for count in counts])
    gate = gated(times, block)
    assert [run.rows for run in gate.runs] == counts
    assert [run.row for run in gate.runs] == (2 + np.cumsum([0, *counts[:-1]])).tolist()
    assert gate.fault() == ('', '')


@given(st.integers(3, 30), st.integers(2, 9), st.integers(1, 40))
def test_a_run_of_few_rows_at_the_end_begins_again_too(count, more, block):
    times = np.concatenate([5.0 + np.arange(count) / 100, np.arange(more) / 100])
    assert len(gated(times, block).runs) == 2


@given(st.integers(12, 60), st.integers(1, 40))
def test_a_column_that_falls_is_no_time(count, block):
    sentence, *_ = gated(np.arange(count)[::-1] / 10.0, block).fault()
    assert sentence.startswith('it falls from row to row')


@given(
    st.lists(st.sampled_from([-3.0, -1e-3, 0.0, 1e-7, 1e-3, 1.0, 4e8]), min_size=1, max_size=60),
    st.integers(1, 60),
)
@example([1.0, 1.0, -3.0, *[1e-3] * 20], 3)
def test_blocks_leave_no_trace(steps, block):
    times = np.cumsum([0.0, *steps])
    made, whole = gated(times, block), gated(times, len(times))
    assert (made.runs, made.late, made.shared) == (whole.runs, whole.late, whole.shared)
    assert made.fault() == whole.fault()


def outcome(name, text, rate, *, appended=False):
    """Return the rate [Hz] that a log with times in a form is read with, None if it is not."""
    times = np.arange(COUNT) / rate
    lines = [f'{text(time)};{20.0 + row % 7};-900' for row, time in enumerate(times)]
    lines *= 1 + appended
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / 'log.csv'
        log.write_text('\n'.join([f'{name};x_vel_mm_s;x_force_N', *lines]) + '\n')
        try:
            series = read_series(log, make_map(guess(log).content))
        except InputError:
            return None
        stamps = np.concatenate([block.stamps for (block,) in series.blocks()])[:COUNT]
    return 1e9 * (len(stamps) - 1) / (stamps[-1] - stamps[0])


@given(st.sampled_from(FORMS), st.floats(-1.0, 3.7), st.booleans())
@example(('Time', UNSTATED['days of a sheet']), 0.0, False)
def test_in_whatever_form_a_time_stands_the_rate_is_right_or_refused(form, decade, appended):
    rate = 10**decade
    found = outcome(*form, rate, appended=appended)
    assert found is None or found == pytest.approx(rate, rel=0.01)


@pytest.mark.parametrize(
    ('month', 'names'),
    [
        (1, 'Januar Jan Jan. Jän. Jänner'),
        (2, 'Februar Feb.'),
        (3, 'März Mär Mär. Mrz Mrz. MÄRZ Maerz March Ma\u0308rz'),
        (4, 'April Apr.'),
        (5, 'Mai MAI May'),
        (6, 'Juni Jun. June'),
        (7, 'Juli Jul. July'),
        (8, 'August Aug.'),
        (9, 'September Sept. Sep.'),
        (10, 'Oktober Okt. OKT October Oct'),
        (11, 'November Nov.'),
        (12, 'Dezember Dez. December Dec'),
    ],
)
@pytest.mark.parametrize('form', ['15. {} 2025', '15.{} 2025', '15-{}-2025', 'Sa., 15. {} 2025'])
def test_a_month_is_told_by_its_name(month, names, form):
    true = dt.datetime(2025, month, 15, 8, 15, 30, tzinfo=dt.UTC).timestamp()
    for name in names.split():
        moments = [moment for moment, _ in moments_of(f'{form.format(name)} 08:15:30.000')]
        assert moments == [true], name


@pytest.mark.parametrize('form', ['iso', 'iso T', 'zone', 'German', 'year first', 'of the day'])
def test_the_forms_of_the_manual_are_read(form):
    assert outcome('Time', TEXTS[form], 50.0) == pytest.approx(50.0, rel=1e-3)


@pytest.mark.parametrize('unit', STATED)
def test_a_unit_in_the_name_is_that_of_the_time(unit):
    assert outcome(f'Time [{unit}]', STATED[unit], 50.0) == pytest.approx(50.0, rel=1e-3)


@pytest.mark.parametrize(
    ('unit', 'first', 'wrap', 'period'),
    [
        ('ms', 2**32 - 1000, 2**32, 2**32),
        ('us', 2**31 - 70_000, 2**31, 2**31),
        ('ms', 86_399_000, 86_400_000, 86_400_000),
        ('ms', 2**31 - 1000, 2**31, 2**32),
    ],
)
def test_a_counter_that_begins_again_goes_on_where_its_steps_do(
    unit, first, wrap, period, read, says
):
    """The last of them counts on from -2^31, as whole numbers with a sign do."""
    step = 20 if unit == 'ms' else 1000
    counted = first + step * np.arange(120)
    told = np.where(counted < wrap, counted, counted - period)
    series = read(told.tolist(), unit=unit, epoch=EPOCH)
    ((rows,),) = series.blocks()
    factor = {'ms': 10**6, 'us': 10**3}[unit]
    np.testing.assert_allclose(
        rows.stamps - rows.stamps[0], factor * step * np.arange(120), atol=2e3
    )
    row, seconds = 2 + int((counted < wrap).sum()), period * factor / 1e9
    assert says('wraps', seconds=f'{seconds:.10g}', row=row) in ' '.join(series.notes)
    later = told + 300 * step * (counted >= wrap)  # no regular step
    assert len(read(later.tolist(), unit=unit, epoch=EPOCH).run_begins) == 2


def test_slow_samples_follow_the_counter_of_the_motion(read):
    counted = 2**32 - 1000 + 20 * np.arange(400)
    warmth = ['' if at % 37 else 40.0 + at for at in range(400)]  # a few rows behind the wrap
    series = read((counted % 2**32).tolist(), temperatures=warmth, unit='ms', epoch=EPOCH)
    stamps = np.concatenate([rows[1].stamps for rows in series.blocks()])
    np.testing.assert_allclose(np.diff(stamps), 37 * 20e6, atol=2e3)


@pytest.mark.parametrize('form', ['{:.1f}', '2025-07-14 12:00:{:04.1f}', '12:00:{:04.1f}'])
@pytest.mark.parametrize('count', [9, 300])
def test_a_table_with_the_newest_row_first_is_to_be_turned_round(form, count, tmp_path, refused):
    path = tmp_path / 'log.csv'
    times = (form.format(0.1 * (count - at)) for at in range(count))
    rows = (f'{time},{at % 7},1.0' for at, time in enumerate(times))
    path.write_text('\n'.join(['time [s],x speed [mm/s],x load [N]', *rows]))
    refused('newest_first', guess, path)
    column = {'column': 'time [s]', 'unit': 's', 'epoch': EPOCH}
    axis = {'lead_mm': 10.0, 'speed': {'column': 'x speed [mm/s]', 'unit': 'mm/s'}}
    refused('newest_first', read_series, path, make_map({'time': column, 'axes': {'x': axis}}))


@pytest.mark.parametrize('column', ['x speed [mm/s]', 'x position [mm]'])
def test_whole_seconds_with_the_newest_row_first_are_no_log_without_time(column, tmp_path):
    path = tmp_path / 'log.csv'
    rows = (f'2025-07-14 12:00:{9 - at // 50:02d},{at % 70}.0,1.0' for at in range(500))
    path.write_text('\n'.join([f'time,{column},x load [N]', *rows]))
    with pytest.raises(InputError, match='the newest row stands first: row 52 has '):
        guess(path)


def test_two_exports_with_the_newest_row_first_are_refused_in_a_sentence(tmp_path):
    path = tmp_path / 'log.csv'
    rows = (f'{(499 - at % 500) / 50},{at % 7},1.0' for at in range(1000))
    path.write_text('\n'.join(['time [s],x speed [mm/s],x load [N]', *rows]))
    with pytest.raises(InputError, match='split the log there|newest row stands first'):
        guess(path)
