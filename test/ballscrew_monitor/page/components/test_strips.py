# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Panels show the rows that came, run on or stand still, and do not grow."""

import numpy as np
import pytest

PLOTS = 'page.strips.panels'
DRAWN = "document.querySelectorAll('.u-over').length === 7"


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.until(DRAWN)
    return tab


def test_each_panel_holds_the_rows_in_its_unit(tab, greeted, frames):
    rows = frames.rows(500, -10.0)
    greeted.greeting[1] = ({'kind': 'history', 'axis': '/ballscrew_monitor/x'}, rows)
    greeted.greeting[4] = frames.state(rows=frames.rows(0))
    tab.visit(greeted.url)
    tab.until(DRAWN)
    tab.until(f'{PLOTS}.every((panel) => panel.plot?.data[0].length === 500)')
    drawn = tab.ask(f'{PLOTS}.map((panel) => panel.plot.data)')
    factors = {'speed_rpm': 0.01, 'efficiency': 100.0, 'rcs': 100.0}
    keys = tab.ask(f'{PLOTS}.map((panel) => panel.keys)')
    assert {key for panel in keys for key in panel} == set(frames.columns) - {'stamp', 'level'}
    for panel, (times, *lines) in zip(keys, drawn, strict=True):
        np.testing.assert_array_equal(times, rows['stamp'])
        for key, line in zip(panel, lines, strict=True):
            np.testing.assert_allclose(line, factors.get(key, 1.0) * rows[key], rtol=1e-12)


def test_a_panel_runs_on_stands_still_and_follows_again(shown, greeted, frames):
    ends = f'{PLOTS}.map((panel) => panel.plot.scales.x.max)'
    greeted.send(*frames.state(rows=frames.rows(1, 5.0)))
    shown.until(f'{ends}.every((end) => end === {frames.begin + 5.0})')
    button = "document.querySelector('.strips button')"
    shown.ask(f'{button}.click()')
    assert shown.ask(f'{button}.textContent + {button}.ariaPressed') == 'Run ontrue'
    greeted.send(*frames.state(rows=frames.rows(1, 9.0)))
    shown.until(f"page.axis.rows.last('stamp') === {frames.begin + 9.0}")
    shown.until('page.painter.views.every((view) => !view.news)')
    assert set(shown.ask(ends)) == {frames.begin + 5.0}
    shown.ask(f'{button}.click()')
    shown.until(f'{ends}.every((end) => end === {frames.begin + 9.0})')


def test_a_log_of_an_assumed_date_has_a_time_of_day_and_a_simulated_one_a_time(shown):
    clock = 'page.strips.constructor.clock'
    assert shown.ask(f'{clock}(946684803)').endswith(':03')  # 2000-01-01, as a map assumes it
    assert len(shown.ask(f'{clock}(946684803)')) == 8
    assert shown.ask(f'{clock}(63)') == '1:03'


def test_zoom_keeps_the_middle_and_ends_at_its_limits(shown, frames):
    shown.ask('page.strips.show(page.strips.now - 40, page.strips.now - 20)')
    shown.ask('page.strips.zoom(0.5)')
    begin, end = shown.ask('page.strips.range')
    now = shown.ask('page.strips.now')
    assert (end - begin, (begin + end) / 2) == (pytest.approx(10.0), pytest.approx(now - 30.0))
    shown.ask('for (let i = 0; i < 20; i += 1) { page.strips.zoom(0.5); }')
    assert shown.ask('page.strips.span') == 1
    shown.ask('for (let i = 0; i < 20; i += 1) { page.strips.zoom(2); }')
    assert shown.ask('page.strips.span') == 600


def test_one_cursor_reads_all_panels(shown, wait_for):
    def point():
        """Move the pointer to the newest rows of the first panel; tell whether all are read."""
        shown.ask("document.querySelector('.u-over').scrollIntoView({ block: 'center' })")
        x, y = shown.ask("""(() => {
            const box = document.querySelector('.u-over').getBoundingClientRect();
            return [box.left + 0.9 * box.width, box.top + 10];
        })()""")
        shown.call('Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y)
        return shown.ask("""[...document.querySelectorAll('.strips figcaption .value')]
            .every((one) => /[0-9]/.test(one.textContent))""")

    wait_for(point, 'values beside all titles')


@pytest.mark.parametrize('rate', [50.0])
def test_rows_at_50_hz_for_long_do_not_grow_the_page(shown, greeted, frames, rate):
    def sizes():
        shown.call('HeapProfiler.collectGarbage')
        found = {
            one['name']: one['value'] for one in shown.call('Performance.getMetrics')['metrics']
        }
        return found['JSHeapUsedSize'], found['Nodes']

    def stream(begin, seconds):
        for number in range(round(seconds * rate)):
            time = begin + number / rate
            greeted.send(*frames.state(rows=frames.rows(1, time, rate)))
        shown.until(f"page.axis.rows.last('stamp') === {frames.begin + time}")
        shown.until('page.painter.views.every((view) => !view.news)')

    shown.call('Performance.enable')
    stream(1.0, 5.0)
    heap, nodes = sizes()
    stream(6.0, 20.0)
    grown, more = sizes()
    assert grown - heap < 1_000_000
    assert more - nodes < 100
    assert shown.ask('page.live.waiting.size') == 0
