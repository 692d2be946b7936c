# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Frames come back as they were, the connection too, and requests are answered or refused."""

import base64
import json

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    return tab


def decoded(tab, data):
    text = base64.b64encode(data).decode()
    return tab.ask(f"""(() => {{
        const bytes = Uint8Array.from(atob('{text}'), (one) => one.charCodeAt(0));
        const frame = Live.decode(bytes.buffer);
        return {{ ...frame, arrays: Object.fromEntries(Object.entries(frame.arrays)
          .map(([name, values]) => [name, [...values].map(String)])) }};
    }})()""")


def test_any_frame_comes_back(shown, frames):
    @given(st.text(), st.lists(st.floats(), max_size=5), st.lists(st.integers(0, 9), max_size=5))
    def holds(text, one, other):
        found = decoded(shown, frames.encoded({'kind': text}, {'one': one, 'other': other}))
        assert found['kind'] == text
        for name, values in (('one', one), ('other', other)):
            numbers = [float(value.replace('Infinity', 'inf')) for value in found['arrays'][name]]
            np.testing.assert_array_equal(numbers, values)

    holds()


def test_pauses_double_up_to_their_limit(shown):
    pauses = shown.ask('[0, 1, 2, 3, 4, 5, 99].map(Live.pause)')
    assert pauses == [500, 1000, 2000, 4000, 8000, 8000, 8000]


def test_a_lost_connection_is_said_and_comes_back_by_itself(shown, greeted, frames):
    greeted.stop()
    shown.until("document.querySelector('.link').textContent.startsWith('No connection to the')")
    assert not shown.ask("document.querySelector('.link').hidden")
    answer = shown.ask("page.live.ask({ do: 'read' })")
    assert answer == {'ok': False, 'message': {'key': 'link_needed'}, 'arrays': {}}
    greeted.start()
    shown.until("document.querySelector('.link').hidden")
    greeted.send(*frames.state(level='warn'))
    shown.reads('.sign.level .word', 'Outside the optimal zone')
    assert shown.ask('page.live.tries') == 0


def test_a_request_that_is_under_way_is_refused_when_the_connection_is_lost(shown, greeted):
    shown.ask("""globalThis.answer = null;
        page.live.ask({ do: 'read' }).then((one) => { answer = one; }); 0""")
    shown.until('page.live.waiting.size === 1')
    greeted.stop()
    shown.until('answer && answer.ok === false')
    assert shown.ask('page.live.waiting.size') == 0
    greeted.start()


def test_answers_find_their_requests_and_progress_comes_before(shown, greeted):
    greeted.answers['solve'] = lambda one: [
        ({'kind': 'progress', 'share': 0.5}, None),
        ({'kind': 'answer', 'ok': True, 'name': one['name']}, {'path': [1.0, 2.0]}),
    ]
    found = shown.ask("""Promise.all(['a', 'b'].map(async (name) => {
        const heard = [];
        const answer = await page.live.ask({ do: 'solve', name }, (one) => heard.push(one.share));
        return [answer.name, heard, [...answer.arrays.path]];
    }))""")
    assert found == [['a', [0.5], [1, 2]], ['b', [0.5], [1, 2]]]


def test_of_what_follows_a_pointer_only_the_newest_is_asked(shown, greeted, wait_for):
    greeted.answers['read'] = lambda one: [({'kind': 'answer', 'ok': True}, None)]
    shown.ask("""globalThis.heard = [];
        globalThis.ask = page.live.newest((answer, request) => heard.push(request.number));
        for (let number = 0; number < 50; number += 1) { ask({ do: 'read', number }); } 0""")
    shown.until('heard.length === 2')
    assert shown.ask('heard') == [0, 49]
    assert [one['number'] for one in greeted.requests if one['do'] == 'read'] == [0, 49]
    assert all(len(json.dumps(one)) < 4096 for one in greeted.requests)
