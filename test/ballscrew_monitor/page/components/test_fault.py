# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The button that makes one file to send, with what became of it."""

import json

import pytest

ANSWERS = """
    globalThis.asked = [];
    globalThis.saved = [];
    globalThis.fetch = async (path, { method }) => {
      asked.push(`${method} ${path}`);
      if (!%(status)d) throw new TypeError('no server');
      return new Response(%(text)s, { status: %(status)d || 200 });
    };
    HTMLAnchorElement.prototype.click = function () { saved.push([this.download, this.href]); };
    0
"""


@pytest.mark.parametrize(
    ('status', 'text', 'key', 'values', 'saves'),
    [
        (200, 'x' * 1234, 'fault_made', {'size': '1.23'}, True),
        (429, 'It is being made.', 'fault_refused', {'why': 'It is being made.'}, False),
        (0, '', 'link_needed', {}, False),
    ],
)
def test_the_button_saves_the_file_or_says_why_not(
    tab, greeted, frames, status, text, key, values, saves
):
    tab.visit(greeted.url)
    tab.reads('.fault-report p', frames.words('en')['fault_hint'])
    tab.ask(ANSWERS % {'status': status, 'text': json.dumps(text)})
    tab.click('.fault-report button')
    tab.reads('.fault-report p', frames.words('en')[key].format(**values))
    assert tab.ask('asked') == ['POST /report-fault']
    saved = tab.ask('saved')
    assert [name for name, _ in saved] == ['ballscrew_fault.zip'] * saves
    assert all(link.startswith('blob:') for _, link in saved)
    assert not tab.ask("document.querySelector('.fault-report button').disabled")
