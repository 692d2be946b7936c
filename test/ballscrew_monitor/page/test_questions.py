# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Requests of browsers, good ones and all others."""

import asyncio
import json

from ballscrew_monitor.page.hub import Browser
from ballscrew_monitor.page.phrases import english
from ballscrew_monitor.page.questions import (
    LARGEST,
    MOST_A_SECOND,
    MOST_FAULTS,
    number_in,
    Questions,
    text_in,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest


async def twice(browser, request):
    return {'number': 2 * number_in(request, 'number')}, {'more': [1.0]}


async def broken(browser, request):
    raise ZeroDivisionError('never')


class Asking:
    """One browser on a clock that stands unless it is set."""

    def __init__(self, parts):
        self.parts, self.now, self.browser = parts, 0.0, Browser()
        self.questions = Questions({'twice': twice, 'broken': broken}, lambda: self.now)

    def ask(self, text):
        """Return whether the browser may stay, and what it is told."""

        async def asking():
            stays = await self.questions.answer(self.browser, text)
            return stays, *self.parts.read(await self.browser.take())

        self.now += 1.0
        return asyncio.run(asking())


@pytest.fixture
def asking(page_parts):
    return Asking(page_parts)


def test_a_request_is_answered_by_its_number(asking):
    stays, record, arrays = asking.ask('{"id": 7, "do": "twice", "number": 4}')
    assert stays
    assert record == {'kind': 'answer', 'id': 7, 'ok': True, 'message': '', 'number': 8.0}
    assert arrays['more'].tolist() == [1.0]


@pytest.mark.parametrize(
    ('text', 'key'),
    [
        ('', 'empty'),
        ('[1]', 'no_object'),
        ('{"id": "1", "do": "twice"}', 'no_object'),
        ('{"id": true, "do": "twice"}', 'no_object'),
        ('{"id": 1}', 'unknown'),
        ('{"id": 1, "do": ["twice"]}', 'unlisted'),
        ('{"id": 1, "do": "twice", "number": NaN}', 'nan'),
        ('{"id": 1, "do": "twice", "number": true}', 'true'),
        ('{"id": 1, "do": "twice", "number": 1e400}', 'infinite'),
        ('x' * (LARGEST + 1), 'long'),
    ],
)
def test_what_is_no_request_is_refused_with_a_sentence(asking, says, text, key):
    stays, record, _ = asking.ask(text)
    assert stays
    assert not record['ok']
    assert record['message'] == says(key)


@given(st.text(max_size=200))
def test_no_text_does_harm(page_parts, text):
    _, record, _ = Asking(page_parts).ask(text)
    assert record['kind'] == 'answer'


@given(st.dictionaries(st.sampled_from(['id', 'do', 'number']), st.one_of(
    st.none(), st.integers(), st.floats(), st.text(max_size=4), st.lists(st.integers())
)))  # fmt: skip
def test_no_object_does_harm(page_parts, request_made):
    _, record, _ = Asking(page_parts).ask(json.dumps(request_made))
    assert record['kind'] == 'answer'


def test_who_goes_on_must_leave(asking):
    stays = [asking.ask('garbage')[0] for _ in range(MOST_FAULTS + 1)]
    assert stays == [*[True] * MOST_FAULTS, False]


def test_too_many_requests_at_once_are_refused(asking, says):
    text, asking.now = '{"id": 1, "do": "twice", "number": 1}', 0.0
    told = []
    for _ in range(MOST_A_SECOND + 1):
        asking.now -= 1.0 - 1e-3  # one comes each millisecond
        told.append(asking.ask(text)[1])
    assert [one['ok'] for one in told] == [*[True] * MOST_A_SECOND, False]
    assert told[-1]['message'] == says('quick')


def test_a_fault_of_the_program_is_an_answer(asking, caplog):
    stays, record, _ = asking.ask('{"id": 1, "do": "broken"}')
    assert stays
    assert 'never' in english(record['message'])
    assert 'ZeroDivisionError' in caplog.text


def test_a_text_has_a_length(refused):
    assert text_in({'name': 'x'}, 'name') == 'x'
    for value in (None, 1, '', 'x' * 201, 'a\nb', '\ud800'):
        refused('text', text_in, {'name': value}, 'name')
