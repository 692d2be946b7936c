# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A warning is shelved for a stated time, at most a day, and acknowledged by a name."""

import math

from ballscrew_monitor.core.conversions import clock_text, SECOND
from ballscrew_monitor.core.judgement import EventEnd
from ballscrew_monitor.core.state import (
    acknowledgement,
    Ending,
    LONGEST_SHELVING,
    NAMELESS,
    NOT_SHELVED,
    shelve,
    Shelving,
)
import pytest

NOW = 1_800_000_000 * SECOND
SEEN = EventEnd.ACKNOWLEDGED


def test_it_holds_until_its_time_and_not_at_it():
    shelving = shelve(NOW, 60.0, ' nut is\nordered ')
    assert shelving == Shelving(until=NOW + 60 * SECOND, reason='nut is ordered')
    assert shelving.at(NOW) is shelving
    assert shelving.at(shelving.until - 1) is shelving
    assert shelving.at(shelving.until) is NOT_SHELVED
    shelving = shelve(NOW, 86400.0, 'why')
    assert shelving.at(shelving.until - LONGEST_SHELVING) is shelving
    assert shelving.at(shelving.until - LONGEST_SHELVING - 1) is NOT_SHELVED
    assert shelving.at(10 * SECOND) is NOT_SHELVED
    assert shelve(NOW, 0.0, '') is NOT_SHELVED


@pytest.mark.parametrize('wrong', [0, 10 * SECOND, NOW - 86400 * SECOND])
def test_a_clock_that_is_behind_does_not_end_it(wrong):
    shelving = shelve(NOW, 60.0, 'why')
    assert not shelving.is_over(wrong)
    assert shelving.at(wrong) is NOT_SHELVED
    assert not shelving.is_over(shelving.until - 1)
    assert shelving.is_over(shelving.until)
    assert not NOT_SHELVED.is_over(NOW)


@pytest.mark.parametrize(
    ('now', 'duration', 'reason', 'sentence'),
    [
        (NOW, -1.0, 'why', 'duration_1_s'),
        (NOW, 86400.1, 'why', 'duration_86400_1'),
        (NOW, math.nan, 'why', 'duration_nan_s'),
        (NOW, math.inf, 'why', 'duration_inf_s'),
        (NOW, 1.0, ' \n', 'reason_has_0'),
        (NOW, 1.0, 'x' * 501, 'reason_has_501'),
        (0, 1.0, 'why', 'clock_node_stands'),
    ],
)
def test_what_is_refused(now, duration, reason, sentence, refused):
    refused(sentence, shelve, now, duration, reason)


def test_an_acknowledgement_is_one_line_each():
    by = acknowledgement(' Ada\nByron ', '\tnut  is ordered\n')
    assert by == Ending(kind=SEEN, name='Ada Byron', reason='nut is ordered')
    assert acknowledgement('A' * 200, ' \n') == Ending(kind=SEEN, name='A' * 200)
    assert acknowledgement('A', 'x' * 500).reason == 'x' * 500


def test_an_event_ends_by_who_and_why(says):
    by = Ending(kind=SEEN, name='Ada', reason='nut is ordered')
    assert by.text == says('by_name_and_reason')
    assert Ending(kind=SEEN, name='Ada').text == says('by_name')
    assert NAMELESS.text == says('by_nobody')
    assert [Ending(kind=kind).text for kind in (EventEnd.UNKNOWN, EventEnd.CLEARED)] == ['', '']


@pytest.mark.parametrize(
    ('name', 'reason', 'sentence'),
    [
        (' \n', 'why', 'name_has_0'),
        ('A' * 201, '', 'name_has_201'),
        ('Ada', 'x' * 501, 'acknowledged_for_501'),
    ],
)
def test_an_acknowledgement_says_who_and_not_too_much(name, reason, sentence, refused):
    refused(sentence, acknowledgement, name, reason)


def test_a_stamp_for_people():
    assert clock_text(NOW + 999_999_999) == '2027-01-15 08:00:00 UTC'
