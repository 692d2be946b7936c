# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A page is whole in itself and lets nothing else run; numbers come back, text ends no element."""

import base64
import hashlib
from html.parser import HTMLParser
import json
import math
import re

from ballscrew_monitor.report import page
from hypothesis import example, given
from hypothesis import strategies as st
import numpy as np
import pytest

OWN = sorted(one.name for one in page.FOLDER.iterdir() if one.name.endswith(('.js', '.css')))
HOSTILE = '</script><script>alert(1)</script>"\'&<img src=x onerror=alert(1)>'
MOST_LINES = 200


def test_uplot_is_what_its_pin_says():
    readme = page.component('uplot/README.md')
    pins = dict(re.findall(r'\| `([\w.]+)` \| `([0-9a-f]{64})` \|', readme))
    assert set(pins) == {'uPlot.iife.min.js', 'uPlot.min.css', 'LICENSE'}
    for name, pin in pins.items():
        data = page.FOLDER.joinpath('uplot', name).read_bytes()
        assert hashlib.sha256(data).hexdigest() == pin, name
    assert 'v1.6.32' in page.component(page.UPLOT_JS)[:100]
    assert 'MIT' in page.component('uplot/LICENSE')


@pytest.mark.parametrize('name', OWN)
def test_own_components_are_plain_and_small(name):
    text = page.component(name)
    assert 'SPDX-License-Identifier: Apache-2.0' in text
    assert len(text.splitlines()) < MOST_LINES
    if name.endswith('.js'):
        assert "'use strict';" in text
        # Text becomes an element only as text.
        assert not re.search(
            r'innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(', text
        )


def test_a_page_asks_for_nothing_and_without_scripts_none_may_run():
    made = page.page('t', page.element('p', 'text'), scripts=page.CHARTS, data='{"axes":[]}')
    addresses = set(re.findall(r'https?://[^\s"\'<>)]+', made))
    assert addresses <= {'https://github.com/leeoniya/uPlot'}  # a comment of uPlot
    assert not re.search(r'<(?:link|img|iframe|object)\b|@import|\bsrc=|fetch\(|XMLHttp', made)
    assert 'script-src &#x27;none&#x27;' in page.page('t', page.element('p', 'text'))


def test_its_policy_names_each_script_and_style_that_is_in_it():
    made = page.page('t', page.element('p', 'text'), scripts=page.CHARTS, data='{}')
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', made)[1].replace(
        '&#x27;', "'"
    )
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    assert 'unsafe' not in policy
    for kind in ('script', 'style'):
        for text in re.findall(rf'<{kind}>(.*?)</{kind}>', made, re.DOTALL):
            digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
            assert f"'sha256-{digest}'" in policy


def test_hostile_text_makes_no_element_and_markup_is_not_escaped_twice():
    assert '<title>&lt;script&gt;</title>' in page.page('<script>', page.element('p', ''))
    assert [tag for tag, _ in parsed(page.element('p', HOSTILE, id=HOSTILE)).tags] == ['p']
    assert page.element('p', page.element('b', 'a & b')) == '<p><b>a &amp; b</b></p>'
    assert page.joined('<', page.element('br')) == '&lt;<br>'


SORTED_TWICE = """
function cell(value) {
  return {
    dataset: { value },
    textContent: value,
    addEventListener(kind, act) { this[kind] = act; },
    getAttribute() { return this.order; },
    setAttribute(name, order) { this.order = order; },
    removeAttribute() { this.order = null; },
  };
}
const head = cell('head');
const rows = ['2', 'nan', '3', '1', 'nan'].map((value) => ({ cells: [cell(value)] }));
let shown = [];
const body = { rows, append(...sorted) { shown = sorted; } };
Table.sortable({ tHead: { rows: [{ cells: [head] }] }, tBodies: [body] });
const orders = [0, 1].map(() => {
  head.click();
  return shown.map((row) => row.cells[0].dataset.value);
});
document.body.textContent = JSON.stringify(orders);
"""


def test_what_is_not_known_is_sorted_last_both_ways(browse, tmp_path):
    path = tmp_path / 'table.html'
    path.write_text(f'<body><script>{page.component("table.js")}{SORTED_TWICE}</script>')
    orders = re.search('<body>(.*)</body>', browse(path, '--dump-dom'), re.DOTALL)[1]
    assert json.loads(orders) == [['1', '2', '3', 'nan', 'nan'], ['3', '2', '1', 'nan', 'nan']]


def unpacked(record):
    steps = np.frombuffer(base64.b64decode(record['data']), dtype='<u2')
    if 'runs' in record:
        steps = np.repeat(steps, np.frombuffer(base64.b64decode(record['runs']), dtype='<u4'))
    step = (record['high'] - record['low']) / page.LEVELS
    return np.where(steps == 0, np.nan, record['low'] + (steps.astype(float) - 1.0) * step)


@given(st.lists(st.floats(-1e6, 1e6) | st.just(math.nan), min_size=1, max_size=200))
@example([0.0, 2.2e-309])
def test_packed_numbers_are_within_half_a_step(values):
    record, numbers = page.packed(values), np.array(values)
    step = (record['high'] - record['low']) / page.LEVELS
    np.testing.assert_allclose(unpacked(record), numbers, rtol=0.0, atol=0.51 * step + 1e-9)


@pytest.mark.parametrize('span', [5e-324, 2.2e-309, 1e-300, 1.0, 1e300, page.LARGEST])
def test_any_span_has_all_its_steps(span):
    record = page.packed([0.0, span, math.nan, 0.0])
    assert base64.b64decode(record['data']) == np.array([1, 65535, 0, 1], dtype='<u2').tobytes()


def test_packed_numbers_at_their_extremes():
    record = page.packed([-1.7e308, 1.0, 1.7e308, math.inf, 3.0])
    assert (record['low'], record['high']) == (1.0, 3.0)
    np.testing.assert_array_equal(unpacked(record), [math.nan, 1.0, math.nan, math.nan, 3.0])
    record = page.packed([3.0, -1.0, math.nan, 2.0])
    assert (record['low'], record['high']) == (-1.0, 3.0)
    record = page.packed([0.0, 2.2e-309, math.nan])
    np.testing.assert_allclose(unpacked(record), [0.0, 0.0, math.nan], atol=2.2e-309)
    record = page.packed(np.repeat([1.0, math.nan, 2.0], 1000))
    assert len(record['data']) < 20
    np.testing.assert_array_equal(unpacked(record), np.repeat([1.0, math.nan, 2.0], 1000))
    assert base64.b64decode(page.floats([1.0])) == np.float32(1.0).tobytes()


@given(st.lists(st.floats(), max_size=20))
def test_any_numbers_can_be_packed(values):
    steps = unpacked(page.packed(values))
    assert steps.size == len(values)
    assert not np.isfinite(steps[~(np.abs(values) <= page.LARGEST)]).any()


def test_no_text_ends_the_element_that_holds_it():
    text = page.script_json({'name': '</script><script>alert(1)</script>&', 'none': math.nan})
    assert not set('<>&') & set(text)
    assert json.loads(text) == {'name': '</script><script>alert(1)</script>&', 'none': None}


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
    found = parsed(page.element('p', text, title=text))
    assert [tag for tag, _ in found.tags] == ['p']
    assert found.text.replace('\r', '') == text.replace('\r', '')


def test_a_table_states_values_and_moments():
    made = page.table(
        ('Name', 'Time [s]'),
        [page.TableRow((HOSTILE, page.TableCell('1.5', value=1.5)), begin=1.0, end=2.0)],
    )
    tags = parsed(made).tags
    assert ('tr', {'data-begin': '1.0000', 'data-end': '2.0000'}) in tags
    assert ('td', {'data-value': '1.5'}) in tags
    assert ('th', {'class': 'number', 'scope': 'col'}) in tags
    assert 'script' not in [tag for tag, _ in tags]


def test_a_bar_has_parts_as_long_as_they_are_large_and_swatches_their_class():
    rects = [
        attrs
        for tag, attrs in parsed(page.share_bar([(3.0, 'a'), (1.0, 'b')], 't')).tags
        if tag == 'rect'
    ]
    assert [rect['width'] for rect in rects] == ['750.00', '250.00']
    assert 'width="0.00"' in page.share_bar([(0.0, 'a')], 't')
    assert 'line-rcs' in page.swatch('rcs', 'line')
    assert 'fill-zone' in page.swatch('zone')
    assert 'line-hatch' in page.swatch('hatch', 'dots')
