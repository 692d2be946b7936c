# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The whole page: for everybody, in every light and width, by keys alone, and as it is served."""

import hashlib
import json
from pathlib import Path
import re
import time

import pytest

AXE = Path(__file__).resolve().parents[3] / 'data' / 'axe'
QUIET = 'page.painter.views.every((view) => !view.news)'


def open_whole(tab, url, **options):
    """Open a page and wait until all of its parts are drawn."""
    tab.open(url, **options)
    tab.until("document.querySelectorAll('.u-over').length === 7")
    tab.until("document.querySelector('.health td')")
    tab.until("document.querySelector('.legend li')")


def test_axe_is_what_its_pin_says():
    pins = re.findall(r'\| `([\w.-]+)` \| `([0-9a-f]{64})` \|', (AXE / 'README.md').read_text())
    assert {name for name, _ in pins} == {'axe.min.js', 'LICENSE', 'LICENSE-3RD-PARTY.txt'}
    for name, pin in pins:
        assert hashlib.sha256((AXE / name).read_bytes()).hexdigest() == pin, name


@pytest.mark.parametrize('dark', [False, True])
@pytest.mark.parametrize('level', ['ok', 'warn', 'unknown'])
def test_nothing_shuts_anybody_out(tab, greeted, frames, dark, level):
    """Contrast, labels, roles and order, in light and dark; by axe-core."""
    greeted.greeting[0] = frames.hello(frames.axis(), frames.axis('y'), acting=True)
    inputs = [{'name': 'load', 'state': 'stale', 'age_s': 4.0, 'words': 'It is 4 s old.'}]
    state = frames.state(level=level, zone='outside', inputs=inputs, advice='Run faster.')
    greeted.greeting.append(state)
    open_whole(tab, greeted.url, dark=dark)
    tab.until(f"document.querySelector('.sign.level').dataset.state === '{level}'")
    tab.ask((AXE / 'axe.min.js').read_text(encoding='utf-8') + '; 0')
    rules = {'runOnly': ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'best-practice']}
    found = tab.ask(f'axe.run({json.dumps(rules)}).then((one) => one.violations)')
    told = [(one['id'], [node['html'][:200] for node in one['nodes']]) for one in found]
    assert not told


@pytest.mark.parametrize('language', ['en', 'de'])
@pytest.mark.parametrize('width', [360, 768, 1280])
def test_no_width_needs_scrolling_sideways(tab, greeted, width, language):
    open_whole(tab, greeted.url, width=width, language=language)
    tab.until(QUIET)
    assert tab.ask('document.documentElement.scrollWidth') <= width
    clipped = tab.ask("""[...document.querySelectorAll('.word, .told p, .big, dt, button')]
        .filter((one) => one.scrollWidth > one.clientWidth + 1 && one.clientWidth)
        .map((one) => one.textContent)""")
    assert not clipped


def test_a_change_of_size_or_light_is_followed(tab, greeted):
    open_whole(tab, greeted.url)
    colour = 'page.whatIf.map.pen.getImageData(page.whatIf.map.area.left, 30, 1, 1).data.join()'
    before = tab.ask(colour)
    scheme = {'name': 'prefers-color-scheme', 'value': 'dark'}
    tab.call('Emulation.setEmulatedMedia', features=[scheme])
    tab.until(f"{colour} !== '{before}'")
    tab.resize(360, 800)
    tab.until('page.strips.panels.every(({ plot }) => plot.width < 360)')
    tab.until("document.querySelector('.map canvas').clientWidth < 360")


def test_the_whole_page_is_reached_by_the_tab_key(tab, greeted, frames):
    greeted.greeting[0] = frames.hello(frames.axis(), frames.axis('y'), acting=True)
    open_whole(tab, greeted.url)
    wanted = set(
        tab.ask("""[...document.querySelectorAll('button, select, input, canvas[tabindex]')]
        .filter((one) => !one.disabled && one.offsetParent).map((one, i) => {
          one.dataset.number = i; return String(i); })""")
    )
    seen = set()
    for _ in range(len(wanted) + 2):
        tab.press('Tab')
        seen.add(tab.ask('document.activeElement.dataset.number ?? null'))
    assert wanted <= seen


def test_a_hello_that_says_nothing_new_leaves_the_page_as_it_is(tab, greeted, frames):
    open_whole(tab, greeted.url)
    tab.ask("document.querySelector('.first').dataset.kept = 'yes'")
    language = {'language': 'en', 'words': frames.words('en')}
    hello, _ = frames.hello(frames.axis(), **language, nodes=[{'name': '/n', 'state': 'active'}])
    greeted.send(hello)
    greeted.send(*frames.state(level='warn'))
    tab.reads('.sign.level .word', 'Outside the optimal zone')
    assert tab.ask("document.querySelector('.first').dataset.kept") == 'yes'
    notices = ['Node /other speaks another version.']
    greeted.send(*frames.hello(waiting='No node is running.', notices=notices, **language))
    tab.reads('.link', f'No node is running. {notices[0]}')
    assert tab.ask("document.querySelectorAll('.detail > *').length") == 0


def test_states_of_the_real_server_are_on_the_screen(tab, served, page_parts):
    """What an axis hears is shown, with its name as text, and why it has no map."""
    page, view = served(), page_parts.axis(axis='<b>x</b>')
    about = {'unit': 'm/min', 'oil': 'iso_vg_68', 'screw': 'nominal'}
    page.call(view.know, about, None, 'the surface file is not on this machine')
    page.call(page.hub.add, view)
    tab.open(f'http://127.0.0.1:{page.port}/')
    tab.reads('.no-map', 'the surface file is not on this machine')
    for number, level in enumerate(('ok', 'warn', 'unknown')):
        state = {'level': level, 'zone': 'outside', 'headline': f'state {number}', 'inputs': []}
        values = {'load_N': 1000.0, 'speed_rpm': 321.0 + number, 'rcs': 1e-3, 'efficiency': 0.9}
        row = page_parts.row(2.0 + number, **values)
        page.call(view.hear, row, state, page_parts.limits, time.monotonic())
        tab.reads('.reason', f'state {number}')
        tab.until(f"document.querySelector('.sign.level').dataset.state === '{level}'")
        found = tab.texts('.numbers :is(.big, .more)')
        assert found[1] == f'{321 + number} rev/min'
        assert found[2] == '1000 N'
    assert tab.ask("document.querySelectorAll('main b').length") == 0
