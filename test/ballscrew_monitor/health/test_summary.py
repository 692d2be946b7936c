# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Cells: means and squares of stretches, merging in any order, age, and motion left out."""

import dataclasses
import functools
import math

from ballscrew_monitor.health.records import CELL, Cell, CellKind, LoadSource, Missing
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.summary import (
    add,
    aged,
    array_of,
    by_place,
    merged,
    MOST_PLACES,
    nothing,
    PLACE,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface.records import from_array

SUMS = ('speed', 'axial_load', 'temperature', 'motor_torque')


@pytest.fixture(name='cells', scope='session')
def cells_strategy(motion):
    """Return a strategy of cells of two places and of many days."""
    number = st.floats(-100.0, 100.0)

    def build(day, load, **values):
        return motion.cell(first_day=day, load_band=load, **values)

    return st.builds(
        build,
        day=st.integers(motion.today - 900, motion.today),
        load=st.integers(0, 1),
        stretches=st.integers(1, 50),
        duration=st.floats(0.5, 500.0),
        **dict.fromkeys(SUMS, number),
    )


def totals(cells):
    """Return the numbers that no merging changes: counts and sums over time."""
    sums = [sum(one.duration * getattr(one, name) for one in cells) for name in SUMS]
    return [sum(one.stretches for one in cells), sum(one.duration for one in cells), *sums]


def test_a_log_has_means_and_squares_of_its_stretches(motion):
    torques, cells = np.array([0.5, 0.56, 0.43]), {}
    for torque in torques:
        assert add(cells, motion.stretch(motor_torque=torque), motion.noon, motion.today) == ''
    (cell,) = cells.values()
    assert (cell.start, cell.first_day, cell.days) == (motion.noon, motion.today, 1)
    assert (cell.stretches, cell.duration, cell.speed_band) == (3, 15.0, 21)
    assert cell.motor_torque == pytest.approx(torques.mean())


def test_other_places_sources_and_logs_are_other_cells(motion):
    cells = {}
    changes = [
        {},
        {'speed': -50.0},
        {'speed': 90.0},
        {'axial_load': -500.0},
        {'load_source': int(LoadSource.FREE)},
        {'temperature_measured': False},
        {'start': motion.noon + DAY},
        {'speed': 0.0},
    ]
    for change in changes:
        assert add(cells, motion.stretch(**change)) == ''
    assert len(cells) == len(changes)
    assert all(PLACE(cell) == key for key, cell in cells.items())
    assert by_place(cells.values()) == cells
    assert [one.kind for one in cells.values()][-1] == CellKind.STANDSTILL


def test_cells_and_their_array_are_the_same_in_the_order_of_logs(motion):
    cells = [motion.cell(first_day=motion.today + day) for day in (3, 1, 2)]
    cells.append(nothing(motion.noon, Missing.TORQUE))
    array = array_of(cells)
    assert array.dtype == CELL
    assert sorted(array['start'].tolist()) == array['start'].tolist()
    again = [from_array(Cell, element) for element in array]
    assert repr(again) == repr(sorted(cells, key=lambda one: one.start))
    assert array_of([]).shape == (0,)


@pytest.mark.parametrize(('change', 'key'), [({'start': DAY + 1}, 'clock_not_set')])
def test_a_stretch_without_a_date_is_left_out_with_a_sentence(motion, says, change, key):
    cells = {}
    assert add(cells, motion.stretch(**change)) == says(key)
    assert not cells


def test_a_clock_that_leaps_by_a_year_is_told_and_one_day_off_is_not(motion, says):
    cells = {}
    leap = motion.stretch(start=motion.noon + 365 * DAY)
    assert add(cells, leap, today=motion.today) == says('clock_leaps')
    for day in (-1, 0, 1):
        stretch = motion.stretch(start=motion.noon + day * DAY)
        assert add(cells, stretch, today=motion.today) == ''
    assert add(cells, motion.stretch(start=motion.noon - 2 * DAY), today=motion.today)
    assert len(cells) == 3


def test_cells_of_days_to_come_do_not_count_and_are_kept(motion, says):
    tomorrow, ahead = (motion.cell(first_day=motion.today + days) for days in (1, 366))
    cells, notes = aged([motion.cell(), ahead, tomorrow], motion.today)
    assert len(cells) == 3
    assert cells[-1] == ahead
    assert notes == [says('clock_ahead')]
    assert aged(cells, motion.today + 366)[1] == []


def test_a_period_has_a_bounded_number_of_places(motion, says):
    """The rare places go, and a new one of a full day is rare."""
    many = [
        motion.cell(load_band=100 + number, stretches=2 + number)
        for number in range(MOST_PLACES + 5)
    ]
    kept, notes = aged(many, motion.today)
    assert notes == [says('rare')]
    assert min(one.stretches for one in kept) == 7
    cells = by_place(kept)
    assert add(cells, motion.stretch()) == says('full_day')
    assert add(cells, motion.stretch(start=motion.noon + DAY)) == ''
    assert len(cells) == MOST_PLACES + 1


def test_an_unknown_mean_is_that_of_the_cell_that_knows_it(motion):
    both = merged(motion.cell(temperature=math.nan), motion.cell(temperature=300.0))
    assert both.temperature == 300.0


@given(data=st.data())
def test_merging_is_associative_and_keeps_counts_and_sums(cells, data):
    one, two, three = (
        dataclasses.replace(data.draw(cells), first_day=0, start=0, load_band=0) for _ in range(3)
    )
    found = merged(merged(one, two), three)
    other = merged(one, merged(three, two))
    for name in (*SUMS, 'stretches', 'duration'):
        assert getattr(found, name) == pytest.approx(getattr(other, name), abs=1e-9)
    assert totals([found]) == pytest.approx(totals([one, two, three]), abs=1e-6)


@given(data=st.data())
def test_merging_of_single_stretches_is_their_mean(motion, data):
    torques = data.draw(st.lists(st.floats(-1.0, 1.0), min_size=1, max_size=20))
    single = [motion.cell(stretches=1, motor_torque=one) for one in torques]
    found = functools.reduce(merged, single)
    assert found.stretches == len(torques)
    assert found.motor_torque == pytest.approx(np.mean(torques), abs=1e-12)


@given(data=st.data(), later=st.integers(0, 2000))
def test_age_merges_and_loses_nothing_whenever_it_is_done(motion, cells, data, later):
    many = data.draw(st.lists(cells, max_size=15))
    once, notes = aged(many, motion.today + later)
    twice, _ = aged(aged(many, motion.today)[0], motion.today + later)
    assert totals(once) == pytest.approx(totals(many), rel=1e-6, abs=1e-6)
    assert [PLACE(one) for one in once] == [PLACE(one) for one in twice]
    assert notes == []
    for one in once:
        assert one.days == 1 or one.first_day % one.days == 0
