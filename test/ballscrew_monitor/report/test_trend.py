# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Drawings over dates: every mark within its frame, intervals, axes with dates and shares."""

import re

from ballscrew_monitor.report.trend import BOTTOM, Frame, HEIGHT, LEFT, Mark, RIGHT, trend, WIDTH
from hypothesis import given
from hypothesis import strategies as st
import pytest

DAY = 86400.0
SHARES = st.floats(-2.0, 2.0, allow_nan=False)


def marks(*values, reach=float('nan')):
    return [
        Mark(at=n * DAY, value=v, low=v - reach, high=v + reach, kind='outside', title=f'no. {n}')
        for n, v in enumerate(values)
    ]


def test_a_mark_for_each_date_and_an_interval_where_there_is_one():
    drawn = trend(marks(0.1, 0.2, 0.3, reach=0.05), tolerance=0.03)
    assert drawn.count('<circle') == drawn.count('class="line-interval"') == 3
    assert drawn.count('fill-zone') == 1
    assert trend(marks(0.1, 0.2)).count('line-interval') == 0
    assert trend(marks(0.1, 0.2)).count('fill-zone') == 0
    assert all(date in drawn for date in ('1970-01-01', '1970-01-02', '1970-01-03'))


@pytest.mark.parametrize('few', [[], marks(0.1), [marks(0.1)[0], marks(0.2)[0]]])
def test_less_than_two_dates_make_no_drawing(few):
    assert trend(few) == ''


@given(st.lists(SHARES, min_size=2, max_size=9), st.floats(0.0, 1.0), SHARES)
def test_all_lies_within_the_frame_and_higher_is_more(values, reach, normal):
    made = marks(*values, reach=reach)
    frame = Frame(made, normal, 0.03)
    for one in made:
        assert LEFT <= frame.across(one.at) <= WIDTH - RIGHT
        assert 0.0 <= frame.up(one.high) <= frame.up(one.low) <= HEIGHT - BOTTOM
    assert frame.up(normal + 0.03) < frame.up(normal)


def test_a_title_is_text_and_a_link_leads_there():
    one, other = marks(0.1, 0.2)
    hostile = Mark(at=2 * DAY, value=0.3, kind='good', title='<b>', link='a b/report.html')
    drawn = trend([one, other, hostile])
    assert '<b>' not in drawn
    assert re.search('<a href="a b/report.html"><circle', drawn)


@pytest.mark.parametrize(('values', 'bottom'), [((0.1, 0.4), 0.0), ((0.0, 0.0), 0.0)])
def test_shares_stand_on_zero(values, bottom):
    assert Frame(marks(*values), 0.0, 0.0).low == bottom
    assert '>0 %<' in trend(marks(*values))
    assert Frame(marks(*values), 0.0, 0.03).low < -0.03  # a change goes either way
