# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Times and shares in the words of a person."""

from ballscrew_monitor.recordings.words import (
    duration,
    list_of,
    number,
    percent,
    share,
    shown_unit,
)
import pytest


@pytest.mark.parametrize(
    ('seconds', 'text'),
    [(0.0, '0 s'), (14.86, '14.9 s'), (600.0, '10 min'), (9000.0, '2.5 h'), (float('nan'), '–')],
)
def test_durations(seconds, text):
    assert duration(seconds) == text


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
    assert percent(part) == text


def test_numbers_are_not_in_powers_of_ten_where_they_need_not():
    assert [number(value) for value in (1234.0, 1.5e9, 0.00012, float('inf'))] == [
        '1230',
        '1.5e+09',
        '0.00012',
        '–',
    ]


def test_a_share_of_nothing_is_not_known():
    assert (share(1.0, 0.0), share(1.0, 4.0)) == ('–', '25 %')


def test_lists():
    assert list_of(['a']) == 'a'
    assert list_of(['a', 'b', 'c']) == 'a; b; and c'


def test_a_unit_is_shown_with_its_sign():
    assert shown_unit('degC') == '°C'
    assert shown_unit('mm/s') == 'mm/s'
