# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Times and shares in the words of a person."""

import io

from ballscrew_monitor.core.advice import speed_advice
from ballscrew_monitor.recordings import words
from ballscrew_monitor.recordings.words import shown_progress
import pytest
from surrogate.tasks.progress import Progress
from surrogate.units import RPM


@pytest.mark.parametrize(
    ('seconds', 'text'),
    [(0.0, '0 s'), (14.86, '14.9 s'), (600.0, '10 min'), (9000.0, '2.5 h'), (float('nan'), '–')],
)
def test_durations(seconds, text):
    assert words.duration(seconds) == text


@pytest.mark.parametrize(
    ('part', 'text'),
    [
        (0.0, '0 %'),
        (1e-5, 'less than 0.1 %'),
        (0.0656, '6.6 %'),
        (0.25, '25 %'),
        (0.98, '98 %'),
        (0.9947, '99.5 %'),
        (0.9999, '99.9 %'),
        (1.0, '100 %'),
        (float('nan'), '–'),
    ],
)
def test_percents_are_never_all_or_nothing_by_rounding(part, text):
    assert words.percent(part) == text


@pytest.mark.parametrize(
    ('value', 'text'),
    [(1234.0, '1230'), (1.5e9, '1.5e+09'), (0.00012, '0.00012'), (float('inf'), '–')],
)
def test_numbers_are_not_in_powers_of_ten_where_they_need_not(value, text):
    assert words.number(value) == text


def test_shares_lists_and_units():
    assert (words.share(1.0, 0.0), words.share(1.0, 4.0)) == ('–', '25 %')
    assert (words.list_of(['a']), words.list_of(['a', 'b', 'c'])) == ('a', 'a; b; and c')
    assert (words.shown_unit('degC'), words.shown_unit('mm/s')) == ('°C', 'mm/s')


def said(step):
    """Return what is said of 1000 s whose tenths take `step` [s] each."""
    now, stream = [0.0], io.StringIO()
    bar = Progress(1000, 's of the recording', stream=stream, clock=lambda: now[0])
    with shown_progress(1000.0, progress=bar, clock=lambda: now[0]) as show:
        for tenth in range(1, 11):
            now[0] += step
            show(tenth / 10)
    return stream.getvalue()


def test_short_work_is_silent_and_long_work_tells_rate_and_time_left(says):
    assert said(0.1) == ''
    assert says('500_1000_s') in said(1.0)


@pytest.mark.parametrize(
    ('text', 'shown'),
    [
        (speed_advice(60 * RPM), 'at this load run at 0.6 m/min, 60 rev/min'),
        (speed_advice(-250 * RPM), 'at this load run at 2.5 m/min, 250 rev/min'),
        ('at 430 rev/min and -1200 N', 'at 4.3 m/min, 430 rev/min and -1200 N'),
        ('at -7.32 rev/min: faster', 'at -0.0732 m/min, -7.32 rev/min: faster'),
        ('check the oil', 'check the oil'),
    ],
)
def test_a_feed_stands_first_beside_the_speed_of_the_screw(text, shown):
    """In the words of an advice and of a place, for a lead of 10 mm."""
    assert words.feed_first(text, 0.01) == shown


def test_names_are_listed_up_to_a_number_and_a_length():
    assert words.listed(['a', 'b']) == 'a, b'
    assert words.listed([]) == ''
    many = words.listed([*'a' * words.MOST, 'x', 'y'])
    assert many.endswith('a, and 2 more')
    assert words.listed(['n' * 999]) == 'n' * words.LONGEST + '…'
    assert words.short('n' * words.LONGEST) == 'n' * words.LONGEST
