# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The time between rows is spent in the cell of the earlier one, in the frame of the map."""

import math

import numpy as np
import pytest


def spend(tab, stamps, speeds, loads):
    given = [[float(one) for one in each] for each in (stamps, speeds, loads)]
    tab.ask(f"""(([stamp, speed_rpm, load_N]) => page.whatIf.map.over.spend({{
        stamp: Float64Array.from(stamp), speed_rpm: Float64Array.from(speed_rpm),
        load_N: Float64Array.from(load_N) }}))({given})""")


@pytest.fixture
def shown(tab, greeted):
    tab.visit(greeted.url)
    tab.until("document.querySelector('.over')?.height > 150")
    tab.until('page.whatIf.map.over.area')
    tab.ask(
        'page.whatIf.map.record.arrays.dwell.fill(0); page.whatIf.map.over.before = undefined; 0'
    )
    return tab


def dwell(tab, frames):
    record, _ = frames.map()
    found = tab.ask('[...page.whatIf.map.record.arrays.dwell]')
    return np.reshape(found, (record['rows'], record['columns']))


def test_time_is_spent_where_the_axis_was_and_gaps_are_not_counted(shown, frames):
    # Backward with a positive load: the load opposes the motion.
    for part in (([10.0, 10.5], [-400.0] * 2), ([11.0, 30.0], [-400.0, 5.1])):
        spend(shown, part[0], part[1], [1000.0, 1000.0])
    record, _ = frames.map()
    found = dwell(shown, frames)
    speed, load = record['speed'], record['load']
    column = math.log(400.0 / speed['low']) / math.log(speed['high'] / speed['low'])
    row = (1000.0 - load['low']) / (load['high'] - load['low'])
    cell = int(row * record['rows']), int(column * record['columns'])
    assert found[cell] == pytest.approx(1.0)
    assert found.sum() == pytest.approx(1.0)


def test_what_is_beside_the_map_is_spent_nowhere(shown, frames):
    spend(shown, [1.0, 2.0, 3.0, 4.0], [0.0, 1e4, 400.0, 1.0], [0.0] * 4)
    assert dwell(shown, frames).sum() == pytest.approx(1.0)


def test_the_axis_is_marked_where_it_is_while_that_is_known(shown, greeted, frames):
    def differs():
        """Tell whether the canvas has paint about the place."""
        return shown.ask("""(() => {
            const { over } = page.whatIf.map;
            over.draw();
            const ratio = devicePixelRatio;
            const [x, y] = [over.x(800) * ratio, over.y(2000) * ratio];
            return over.pen.getImageData(x - 14, y - 14, 28, 28).data.some((one) => one > 0);
        })()""")

    assert not differs()
    rows = frames.rows(1, 5.0, speed_rpm=800.0, load_N=-2000.0)
    greeted.send(*frames.state(rows=rows))
    shown.until("page.axis.rows.last('load_N') === -2000")
    assert differs()


def test_the_mark_has_the_colour_of_every_level(shown):
    """Those that the first screen knows, each of them a colour of the page."""
    names = shown.ask(
        'Object.keys(SIGNS).filter((name) => Words.say(`level_${name}`) !== `level_${name}`)'
    )
    assert {'surely', 'perhaps', 'usual', 'rest'} <= set(names)
    colours = shown.ask(
        'Object.fromEntries(Object.entries(Trail.LEVELS).map(([level, name]) => '
        '[level, Format.colour(name)]))'
    )
    assert set(colours) == set(names)
    assert all(colours.values())
    assert len({colours[name] for name in ('ok', 'surely', 'perhaps', 'rest')}) == 4
