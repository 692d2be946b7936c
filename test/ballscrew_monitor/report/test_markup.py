# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Whatever a log or an axis is called, it stays text."""

from html.parser import HTMLParser

from ballscrew_monitor.report.markup import (
    element,
    joined,
    share_bar,
    swatch,
    table,
    TableCell,
    TableRow,
)
from hypothesis import given
from hypothesis import strategies as st

HOSTILE = '</script><script>alert(1)</script>"\'&<img src=x onerror=alert(1)>'


class Tags(HTMLParser):
    """Collects the tags and the text of a page."""

    def __init__(self):
        super().__init__()
        self.tags, self.text = [], ''

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text += data


def parsed(markup):
    parser = Tags()
    parser.feed(markup)
    parser.close()
    return parser


@given(st.text())
def test_text_and_attributes_come_back_as_they_were(text):
    found = parsed(element('p', text, title=text))
    assert [tag for tag, _ in found.tags] == ['p']
    assert found.text.replace('\r', '') == text.replace('\r', '')


def test_hostile_text_makes_no_element():
    assert [tag for tag, _ in parsed(element('p', HOSTILE, id=HOSTILE)).tags] == ['p']


def test_markup_is_not_escaped_twice():
    assert element('p', element('b', 'a & b')) == '<p><b>a &amp; b</b></p>'
    assert joined(['<', element('br')]) == '&lt;<br>'


def test_a_table_states_values_and_moments():
    made = table(
        ('Name', 'Time [s]'),
        [TableRow((HOSTILE, TableCell('1.5', value=1.5)), begin=1.0, end=2.0)],
    )
    tags = parsed(made).tags
    assert ('tr', {'data-begin': '1.0000', 'data-end': '2.0000'}) in tags
    assert ('td', {'data-value': '1.5'}) in tags
    assert ('th', {'class': 'number', 'scope': 'col'}) in tags
    assert 'script' not in [tag for tag, _ in tags]


def test_a_bar_has_parts_as_long_as_they_are_large():
    rects = [
        attrs
        for tag, attrs in parsed(share_bar([(3.0, 'a'), (1.0, 'b')], 't')).tags
        if tag == 'rect'
    ]
    assert [rect['width'] for rect in rects] == ['750.00', '250.00']


def test_a_bar_of_nothing_is_empty():
    assert 'width="0.00"' in share_bar([(0.0, 'a')], 't')


def test_swatches():
    assert 'line-rcs' in swatch('rcs', 'line')
    assert 'fill-zone' in swatch('zone')
    assert 'line-hatch' in swatch('hatch', 'dots')
