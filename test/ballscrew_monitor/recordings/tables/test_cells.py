# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Texts as numbers or times: the form that reads the most cells, whatever the blocks are."""

import datetime as dt
from pathlib import Path

from ballscrew_monitor.recordings.tables.cells import Cells
from ballscrew_monitor.recordings.tables.clocks import order_in_name
from ballscrew_monitor.recordings.words import counted
from hypothesis import assume, example, given, strategies
import numpy as np
import polars as pl
import pytest

DAY = 1_767_312_000.0  # 2026-01-02 [s]
READ = {
    ' 12 ': {'point': 12.0, 'comma': 12.0},
    '1.5': {'point': 1.5},
    '2,5': {'comma': 2.5},
    '-1e3': {'point': -1e3, 'comma': -1e3},
    '1.234,5': {'comma': 1234.5},
    '1,234,5': {},
    'inf': {},
    'text': {},
    None: {},
    '2026-01-02T03:04:05.5Z': {'iso': DAY + 11045.5},
    '02.01.2026 03:04:05,5': {'german': DAY + 11045.5},
    '2026/01/02 03:04:05': {'slash': DAY + 11045.0},
    '03:04:05,25': {'clock': 11045.25},
    '02.01.2026': {'german day': DAY},
    '2026-01-02': {'iso day': DAY},
    '2026/01/02': {'slash day': DAY},
}
FORMS = (
    *('point', 'comma', 'iso', 'german', 'slash', 'clock'),
    *('iso day', 'german day', 'slash day'),
)
"""In the order in which the first of those that read as many cells is taken."""


def plain(texts):
    """Return the cells in the form of most of them, by one look at all of them."""
    made = {form: [READ[text].get(form) for text in texts] for form in FORMS}
    good = {form: sum(one is not None for one in column) for form, column in made.items()}
    best = max(good.values())
    alike = {tuple(made[form]) for form in FORMS if good[form] == best}
    assume(len(alike) == 1)
    return made[max(good, key=good.__getitem__)]


NUMBERS = [text for text, read in READ.items() if not read.keys() - {'point', 'comma'}]
BOTH = strategies.sampled_from(NUMBERS), strategies.sampled_from(list(READ))
LISTS = [strategies.lists(cells, min_size=1, max_size=12) for cells in BOTH]


@given(LISTS[0], strategies.integers(1, 12))
@example(['1.5', '2,5', '2,5'], 1)
@example(['1.5', '2,5', '2,5', '2,5', ' 12 '], 1)
@example(['1.5', ' 12 ', '2,5', '2,5'], 1)
def test_numbers_are_read_with_the_sign_of_most_part_by_part(texts, block):
    check_column(texts, block)


@given(LISTS[1])
def test_cells_are_read_in_the_form_of_most(texts):
    check_column(texts, len(texts))


def check_column(texts, block):
    cells = Cells(Path('log'), 'a')
    column = pl.Series(texts, dtype=pl.String)
    for begin in range(0, len(texts), block):
        cells.add(column.slice(begin, block))
    expected = plain(texts)
    if all(one is None for one in expected):
        with pytest.raises(ValueError, match='holds no number'):
            cells.reading()
        return
    reading = cells.reading()
    wanted = np.array([np.nan if one is None else one for one in expected])
    np.testing.assert_allclose(reading.numbers(column), wanted, rtol=0, atol=1e-6)
    np.testing.assert_allclose(reading.extremes, [np.nanmin(wanted), np.nanmax(wanted)], atol=1e-6)
    missing = int(np.isnan(wanted).sum()) - texts.count(None)
    assert (f'holds {counted(missing, "cell")} without a number' in reading.note) == bool(missing)


LETTERS = 'dmy', 'mdy', 'ymd'


def in_order(texts, form):
    """Return the days of texts by the calendar of Python, None for other texts."""
    try:
        days = [dt.datetime.strptime(text, form).replace(tzinfo=dt.UTC) for text in texts]
    except ValueError:
        return None
    return [day.timestamp() for day in days] if min(days).year >= 1990 else None


def read_column(texts, name='Date', order='', block=3):
    cells = Cells(Path('log'), name, order=order)
    for begin in range(0, len(texts), block):
        cells.add(pl.Series(texts[begin:][:block]))
    return cells, cells.reading(order=order).numbers(pl.Series(texts))


@given(
    strategies.lists(
        strategies.dates(dt.date(1990, 1, 1), dt.date(2068, 12, 31)), min_size=1, max_size=4
    ),
    strategies.sampled_from('/-.'),
    strategies.sampled_from(LETTERS),
)
@example([dt.date(2025, 7, 11)], '/', 'ymd')
@example([dt.date(2025, 7, 11)], '.', 'ymd')
@example([dt.date(2026, 11, 28)], '-', 'ymd')
@example([dt.date(2025, 7, 14), dt.date(2032, 7, 14)], '/', 'ymd')
def test_years_of_two_digits_are_read_by_the_only_order_or_all_are_named(days, sign, order):
    allowed = [one for one in LETTERS if sign != '.' or one != 'mdy']  # no month first with dots
    assume(order in allowed)
    forms = {one: sign.join(f'%{letter}' for letter in one) for one in allowed}
    texts = [day.strftime(forms[order]) for day in days]
    readings = {one: read for one in allowed if (read := in_order(texts, forms[one]))}
    cells, numbers = read_column(texts)
    if len({*map(tuple, readings.values())}) == 1:
        assert not cells.doubt()
        np.testing.assert_array_equal(numbers, readings[order])
        return
    assert not cells.order
    doubt = cells.doubt()
    for one in LETTERS:
        assert (f'{{order: {one}}}' in doubt) is (one in readings)
    for one, read in readings.items():
        first = dt.datetime.fromtimestamp(read[0], dt.UTC)
        assert f'{first:%Y-%m-%d} by time: {{order: {one}}}' in doubt
        np.testing.assert_array_equal(read_column(texts, order=one)[1], read)


@pytest.mark.parametrize(
    ('form', 'order'),
    [
        ('%y/%m/%d', 'ymd'),
        ('%d.%m.%y', 'dmy'),
        ('%m-%d-%y', 'mdy'),
        ('%d/%m/%Y', 'dmy'),
        ('%m/%d/%Y', 'mdy'),
    ],
)
@pytest.mark.parametrize('midnight', [(2025, 7, 11), (2025, 8, 1), (2026, 1, 1)])
def test_rows_that_go_on_through_midnight_show_the_order_of_their_dates(form, order, midnight):
    begin = dt.datetime(*midnight, tzinfo=dt.UTC) - dt.timedelta(seconds=1)
    moments = [begin + dt.timedelta(seconds=at / 4) for at in range(9)]
    texts = [f'{one.strftime(form)} {one:%H:%M:%S.%f}' for one in moments]
    cells, numbers = read_column(texts)
    assert (cells.doubt(), cells.order) == ('', order)
    np.testing.assert_allclose(numbers, [one.timestamp() for one in moments], atol=1e-6)


def test_an_order_of_the_map_leaves_dates_alone_that_do_not_have_it():
    for order in ('mdy', 'ymd'):
        _, numbers = read_column(['14/07/2025' if order == 'ymd' else '14.07.2025'], order=order)
        assert numbers[0] == dt.datetime(2025, 7, 14, tzinfo=dt.UTC).timestamp()
    cells, _ = read_column(['25.07.11'], order='mdy')
    assert '{order: dmy}' in cells.doubt('mdy')
    assert not cells.doubt('ymd')


def test_days_that_lie_apart_show_no_order():
    """Which is a month later or a day, at other times of the day."""
    cells, _ = read_column(['04/07/2025 18:00:00', '05/07/2025 08:00:00'])
    assert not cells.order
    assert '2025-07-04 by time: {order: dmy} or 2025-04-07 by time: {order: mdy}' in cells.doubt()


@pytest.mark.parametrize(
    ('name', 'day'),
    [
        ('Date (yy/mm/dd)', (2025, 7, 11)),
        ('Date [dd/mm/yy]', (2011, 7, 25)),
        ('Datum TT.MM.JJ hh:mm:ss', (2011, 7, 25)),
        ('Y/M/D', (2025, 7, 11)),
    ],
)
def test_a_name_states_the_order_of_its_dates(name, day):
    cells, numbers = read_column(['25/07/11'], name)
    assert numbers[0] == dt.datetime(*day, tzinfo=dt.UTC).timestamp()
    assert cells.decided.endswith('its name says so')


@pytest.mark.parametrize('name', ['Date', 'dmy', 'my day', 'X/Y/Z', 'm/d', 'd-d-d', 'Date (mm)'])
def test_other_names_state_no_order(name):
    assert order_in_name(name) == ''
