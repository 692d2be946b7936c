# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The whole page: for everybody, in every light and width, by keys alone, and as it is served."""

import hashlib
import json
import math
from pathlib import Path
import re
import subprocess
import sys
import time

from ballscrew_msgs.msg import BallScrewState
import pytest
from surrogate.units import RPM

AXE = Path(__file__).resolve().parents[3] / 'data' / 'axe'
QUIET = 'page.painter.views.every((view) => !view.news)'
LEVELS = {
    BallScrewState.LEVEL_OK: 'Optimal zone',
    BallScrewState.LEVEL_WARN: 'outside the optimal zone',
    BallScrewState.LEVEL_UNKNOWN: 'Not known',
}
PROMPT = {'x__limits__raise_delay': 0.0, 'x__limits__clear_delay': 0.0}
PROMPT |= {'x__max_future': 3600.0, 'x__publish_period': 0.1}
TOO_THIN = (
    'The oil film is too thin: {} of the load is carried where metal pierces it, the limit is {}.'
)
FAST, SLOW, STILL = (100.0, -1000.0), (0.6, -1500.0), (0.0, -1000.0)
"""Speed [rad/s] and load [N] in the optimal zone, outside, and without motion."""


def open_whole(tab, url, **options):
    """Open a page and wait until all of its parts are drawn."""
    tab.visit(url, **options)
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
    tab.visit(f'http://127.0.0.1:{page.port}/')
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


@pytest.fixture
def beside(tab, node):
    """Return a tab with the page of `ballscrew page` beside a node that is not started yet."""
    process = subprocess.Popen(
        [sys.executable, '-m', 'ballscrew_monitor', 'page', '--port', '0'],
        env=node.environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        tab.visit(process.stdout.readline().split()[1])
        yield tab
    finally:
        process.terminate()
        process.communicate()


def in_digits(value, digits, unit):
    """Return a value as the page writes it."""
    text = f'{float(f"{value:.{digits}g}"):g}'
    return '–' if math.isnan(value) else f'{text} {unit}'


def read_off(tab):
    """Return level, reason, feed, speed, load and efficiency as the screen shows them."""
    found = tab.texts('.numbers :is(.big, .more)')
    # How surely is said in words before it.
    level = (tab.text('.sign.level .word') or '').removeprefix('Surely ').removeprefix('Perhaps ')
    return found and [level, tab.text('.reason'), *found[:3], found[6]]


def reason_of(state):
    """Return why the zone of a state is what it is, in the words of the page."""
    if BallScrewState.GATE_STANDSTILL in state.active_gates:
        return 'the screw stands still'
    shares = (in_digits(100.0 * one, 2, '%') for one in (state.result.rcs, state.rcs_limit))
    return TOO_THIN.format(*shares) if state.zone == BallScrewState.ZONE_OUTSIDE else 'optimal'


def as_shown(state):
    """Return what the screen shall show of a state of the nominal screw, of 10 mm lead."""
    still = BallScrewState.GATE_STANDSTILL in state.active_gates
    turns = state.point.speed / RPM
    return [
        'At rest' if still and state.level != BallScrewState.LEVEL_WARN else LEVELS[state.level],
        reason_of(state),
        in_digits(turns * 0.01, 3, 'm/min'),
        in_digits(turns, 3, 'rev/min'),
        in_digits(state.point.axial_load, 3, 'N'),
        in_digits(math.nan if still else 100.0 * state.result.efficiency, 3, '%'),
    ]


def shown_at(tab, node, move):
    """Publish until the screen shows the state that was received last; return that."""
    states, publish, place = move

    def repeat():
        publish(*place)
        node.spin()

    def is_shown():
        here = states and (states[-1].point.speed, states[-1].point.axial_load) == place
        return here and read_off(tab) == as_shown(states[-1])

    node.wait_for(is_shown, f'{place} on the screen', meanwhile=repeat)
    return states[-1]


def test_a_real_node_is_on_the_screen_as_a_subscriber_hears_it(beside, node):
    node.start(**PROMPT)
    states, publish = node.watched()
    levels = [shown_at(beside, node, (states, publish, at)).level for at in (FAST, SLOW, FAST)]
    assert levels == [BallScrewState.LEVEL_OK, BallScrewState.LEVEL_WARN, BallScrewState.LEVEL_OK]
    assert shown_at(beside, node, (states, publish, STILL)).point.speed == 0.0
    beside.reads('.health-of-inputs b', 'Speed')
    beside.until('page.axis.map')


def test_a_real_node_that_ends_is_gone_and_is_back_once_it_is_started(beside, node, frames):
    left = frames.words('en')['node_left'].format(node=node.name)
    node.start(**PROMPT)
    states, publish = node.watched()
    shown_at(beside, node, (states, publish, FAST))
    node.stop()
    beside.reads('.reason', left)
    beside.reads('.sign.level .word', 'Not known')
    # It stays so, whatever the page is told besides.
    beside.until('page.axis.age > 2')
    assert beside.text('.reason') == left
    states.clear()
    node.start(**PROMPT)
    assert shown_at(beside, node, (states, publish, SLOW)).level == BallScrewState.LEVEL_WARN
