# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of an axis are bounded, in order, and drawn by the extremes of their buckets."""

import json

import numpy as np
import pytest

KEPT = 36_000


@pytest.fixture
def rows(tab, greeted):
    """Return the tab with rows of two columns."""
    tab.visit(greeted.url)
    tab.reads('.sign.level .word', 'Optimal zone')
    tab.ask("globalThis.rows = new Rows(['stamp', 'load_N']); 0")
    return tab


def append(tab, stamps, loads):
    given = json.dumps([list(map(float, one)) for one in (stamps, loads)])
    tab.ask(f"""(([stamp, load_N]) => rows.append({{
        stamp: Float64Array.from(stamp), load_N: Float64Array.from(load_N) }}))({given})""")


def during(tab, begin, span, most):
    return tab.ask(f"rows.during({begin}, {span}, ['load_N'], {most})")


def test_the_newest_rows_are_kept_whatever_the_blocks(rows):
    stamps = np.arange(100_000) / 50.0
    for part in np.array_split(stamps, [1, 700, 20_000, 20_001, 95_000]):
        append(rows, part, 2.0 * part)
    assert rows.ask('rows.count') == KEPT
    kept = rows.ask("[...rows.column('stamp')]")
    assert kept == stamps[-KEPT:].tolist()
    assert rows.ask("[...rows.column('load_N')]") == (2.0 * stamps[-KEPT:]).tolist()
    assert rows.ask(f'rows.first({stamps[-1000]})') == KEPT - 1000


def test_time_that_goes_back_begins_again(rows):
    append(rows, [1.0, 2.0, 3.0], [0.0, 0.0, 0.0])
    append(rows, [0.5, 0.6], [7.0, 8.0])
    assert rows.ask("[...rows.column('load_N')]") == [7.0, 8.0]


def test_few_rows_are_all_drawn_and_gaps_interrupt(rows):
    rows.ask("""rows.append({ stamp: Float64Array.of(0, 1, 9, 9.5),
                              load_N: Float64Array.of(1, NaN, 3, 4) })""")
    assert during(rows, 0.0, 10.0, 100) == [[0, 1, 3.5, 9, 9.5], [1, None, None, 3, 4]]


def test_buckets_keep_every_extreme_in_order(rows):
    draw = np.random.default_rng(7)
    stamps, loads = np.arange(10_000) / 50.0, draw.normal(size=10_000)
    append(rows, stamps, loads)
    times, drawn = during(rows, 0.0, 200.0, 400)
    assert len(times) == len(drawn) == 400
    assert times == sorted(times)
    parts = loads.reshape(200, 50)
    assert sorted(drawn) == sorted([*parts.min(axis=1), *parts.max(axis=1)])
    first = parts.argmin(axis=1) < parts.argmax(axis=1)
    assert np.all((np.diff(np.reshape(drawn, (200, 2)), axis=1)[:, 0] > 0) == first)
    # Buckets stay where they are while the window moves on.
    later, _ = during(rows, 0.3, 200.0, 400)
    assert set(times[4:]) >= set(later[4:])


def test_old_data_say_nothing_of_now(rows):
    facts = {'axis': 'x', 'kind': 'state', 'level': 'ok', 'arrays': {}}
    for age, level in ((4.5, 'ok'), (5.5, 'unknown')):
        state = json.dumps(facts | {'age_s': age})
        assert (
            rows.ask(f"""(() => {{ const axis = new Axis({{}});
            axis.take({state}); return axis.level; }})()""")
            == level
        )
    assert rows.ask('new Axis({}).level') == 'unknown'
