# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Times and shares in the words of a person."""

from ballscrew_monitor.recordings import words
import pytest


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
