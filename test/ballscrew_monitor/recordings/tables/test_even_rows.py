# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Slopes of positions whose stamps are rounded or jitter, against the speed of the trajectory."""

import contextlib

from ballscrew_monitor.recordings.tables import sources
from ballscrew_monitor.recordings.tables.amounts import leap_on
from ballscrew_monitor.recordings.tables.estimates import way_per_speed
from ballscrew_monitor.recordings.tables.even_rows import even_rows, EvenRows
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import fits_of, read_series
from hypothesis import example, given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.files import InputError

FASTEST = 75.0  # [mm/s]
KNOTS = np.array([0.0, 0.5, 1.0, 5.0, 5.5, 6.0, 6.5, 11.0, 11.5, 13.0])  # [s]
SPEEDS = np.array([0.0, 0.0, FASTEST, FASTEST, 0.0, 0.0, -40.0, -40.0, 0.0, 0.0])  # [mm/s]
AREAS = np.append(0.0, np.cumsum((SPEEDS[1:] + SPEEDS[:-1]) / 2 * np.diff(KNOTS)))
LEAD = 10.0  # [mm]


def speed_at(times):
    """Return the speeds of trapezoids [mm/s]."""
    return np.interp(times, KNOTS, SPEEDS)


def place_at(times):
    """Return their integral [mm], in closed form."""
    at = np.clip(np.searchsorted(KNOTS, times, 'right') - 1, 0, len(KNOTS) - 2)
    since = times - KNOTS[at]
    ramp = (SPEEDS[at + 1] - SPEEDS[at]) / (KNOTS[at + 1] - KNOTS[at])
    return 120.0 + AREAS[at] + SPEEDS[at] * since + ramp * since**2 / 2


def rows_of(rate, span=12.0):
    return np.arange(round(span * rate)) / rate


def slope_error(stamps, times, shown=None):
    """Return the largest error of a slope away from the knots, over the fastest speed [-]."""
    rows = even_rows(stamps, place_at(times))
    taken = stamps if rows is None else rows.times(stamps)
    slope = np.gradient(place_at(times), taken)
    steady = np.abs(times[:, None] - KNOTS).min(axis=1) > 2.5 * np.median(np.diff(times))
    return float(np.abs(slope - speed_at(times))[steady].max()) / FASTEST


@given(
    rate=st.floats(7.0, 2000.0),
    digits=st.integers(1, 4),
    cut=st.booleans(),
    begin=st.sampled_from([0.0, 0.0004, 86399.0, 1.7e9]),
)
@example(rate=400.0, digits=3, cut=False, begin=0.0)
@example(rate=8.0, digits=1, cut=True, begin=0.0)
@example(rate=99.0, digits=2, cut=False, begin=1.7e9)
@settings(deadline=None)
def test_rounded_stamps_give_the_speed_or_a_question(rate, digits, cut, begin):
    times = rows_of(rate)
    quantum = 10.0**-digits
    if quantum > 0.95 / rate:  # rows share stamps, which has a gate of its own
        return
    near = np.floor if cut else np.round
    stamps = begin + near((times + (begin % 1.0)) / quantum) * quantum
    with contextlib.suppress(ValueError):
        assert slope_error(stamps, times) < 0.03


@given(
    rate=st.sampled_from([20.0, 100.0, 1000.0]),
    part=st.floats(0.03, 0.45),
    seed=st.integers(0, 1000),
    sampled=st.booleans(),
    lost=st.sampled_from([0.0, 0.02]),
)
@example(rate=100.0, part=0.45, seed=1, sampled=False, lost=0.0)
@settings(deadline=None)
def test_stamps_that_jitter_count_if_the_position_was_sampled_at_them(
    rate, part, seed, sampled, lost
):
    draws = np.random.default_rng(seed)
    times = rows_of(rate)
    stamps = times + draws.uniform(-part, part, len(times)) / rate
    kept = draws.random(len(times)) >= lost
    stamps, times = stamps[kept], times[kept]
    with contextlib.suppress(ValueError):
        assert slope_error(stamps, np.abs(stamps) if sampled else times) < 0.03


def test_a_single_late_stamp_makes_no_speed():
    times = rows_of(400.0)
    stamps = times.copy()
    stamps[1000] += 0.0022
    assert slope_error(stamps, times) < 0.01


def test_even_stamps_and_gaps_between_them_stay_as_they_are():
    times = rows_of(100.0)
    kept = np.random.default_rng(1).random(len(times)) > 0.1
    assert even_rows(times, place_at(times)) is None
    assert even_rows(times[kept], place_at(times[kept])) is None


def test_noise_of_a_position_beside_stamps_of_few_digits_asks_for_nothing():
    times = rows_of(300.0)
    noise = np.random.default_rng(3).normal(0.0, 0.05, len(times))
    assert even_rows(np.round(times, 4), place_at(times) + noise) is None


def test_rows_that_miss_between_coarse_stamps_are_a_question():
    times = rows_of(8.0)[np.r_[0:30, 31:60, 61:80]]
    with pytest.raises(ValueError, match='rows are missing'):
        even_rows(np.round(times, 1), place_at(times))


@pytest.mark.parametrize('block', [50, 700, 10_000])
def test_times_of_a_long_log_are_even_whatever_its_blocks_are(block):
    stamps = np.round(rows_of(400.0, span=20.0), 3)
    stamps[4000:] += 3.0  # a gap, and what follows it
    rows = EvenRows(step=0.0025, counts=True)
    told = (
        (at, stamps[at:][:block], {'p': stamps[at:][:block]})
        for at in range(0, len(stamps), block)
    )
    blocks = list(rows.blocks(told))
    times = np.concatenate([times for _, times, _ in blocks])
    steps = np.diff(times)
    assert np.concatenate([columns['p'] for _, _, columns in blocks]).tolist() == stamps.tolist()
    assert [row for row, _, _ in blocks] == np.cumsum(
        [0, *(len(times) for _, times, _ in blocks[:-1])]
    ).tolist()
    assert np.delete(steps, 3999) == pytest.approx(0.0025, rel=0.02)
    assert steps[3999] == pytest.approx(3.0025, abs=0.001)


@pytest.fixture
def series_of(tmp_path, write_csv, monkeypatch):
    """Return a function that reads a log of a motion with stamps and further columns."""
    monkeypatch.setattr(sources, 'BLOCK', 1000)

    def read(stamps, times, digits, speed=None):
        cells = [f'{stamp:.{digits}f}' for stamp in stamps]
        columns = {'t': cells, 'p': place_at(times)} | ({} if speed is None else {'v': speed})
        axis = {'lead_mm': LEAD, 'position': {'column': 'p', 'unit': 'mm'}}
        axis |= {} if speed is None else {'speed': {'column': 'v', 'unit': 'mm/s'}}
        time = {'column': 't', 'unit': 's', 'epoch': '2000-01-01T00:00:00Z'}
        log = write_csv(tmp_path / 'log.csv', columns, form='{:.12g}')
        return read_series(log, make_map({'time': time, 'axes': {'x': axis}}))

    return read


@pytest.mark.parametrize(('rate', 'digits'), [(400.0, 3), (30.0, 2), (8.0, 1)])
def test_a_log_of_rounded_stamps_has_the_speed_of_its_motion_and_says_so(series_of, rate, digits):
    times = rows_of(rate)
    series = series_of(times, times, digits)
    blocks = [rows for (rows,) in series.blocks()]
    speed = np.concatenate([rows.columns['x.speed'] for rows in blocks])
    wanted = 2 * np.pi * np.array([-40.0, FASTEST]) / LEAD
    assert [speed.min(), speed.max()] == pytest.approx(wanted, rel=0.01)
    (note,) = [note for note in series.notes if 'evenly' in note]
    assert 'their stamps do not' in note


def test_a_position_sampled_at_no_time_that_is_known_is_a_question(series_of):
    draws = np.random.default_rng(5)
    times = rows_of(100.0)
    stamps = times + draws.uniform(-0.004, 0.004, len(times))
    sampled = np.abs(times + draws.uniform(-0.004, 0.004, len(times)))
    with pytest.raises(InputError, match='no slope that is a speed.*or state time.rate_Hz'):
        series_of(stamps, sampled, 6)


@pytest.mark.parametrize(('rate', 'digits'), [(8.0, 1), (400.0, 3), (60.0, 2)])
def test_rounded_stamps_contradict_no_speed_beside_its_position(series_of, rate, digits):
    times = rows_of(rate)
    series = series_of(times, times, digits, speed=speed_at(times))
    (fit,) = fits_of(series)
    for (rows,) in series.blocks():
        fit.add(rows)
    assert not fit.note()


@pytest.mark.parametrize('rate', [7.0, 8.0, 12.0, 60.0, 400.0, 700.0])
def test_a_speed_of_rounded_stamps_makes_its_position(rate):
    times = rows_of(rate)
    quantum = {7.0: 0.1, 8.0: 0.1, 12.0: 0.05, 60.0: 0.01}.get(rate, 0.001)
    stamps = np.round(times / quantum) * quantum
    way = way_per_speed((stamps, place_at(times)), (stamps, speed_at(times)))
    assert way == pytest.approx(1.0, rel=0.02)


@given(
    rate=st.floats(20.0, 2000.0),
    begin=st.floats(0.0, 11.9),
    missing=st.floats(0.0, 5.0),
    scale=st.sampled_from([1.0, -1e-3, 2.0]),
)
@example(rate=100.0, begin=5.0, missing=1.0, scale=1.0)
@settings(deadline=None)
def test_rows_that_miss_in_motion_are_a_leap_and_a_pause_is_none(rate, begin, missing, scale):
    times = rows_of(rate)
    left_out = (times >= begin) & (times < begin + missing)
    kept = times[~left_out]
    at = leap_on(scale * place_at(kept))
    assert not at or left_out[round(kept[at] * rate) - 1]
    gone = np.abs(np.diff(place_at(np.array([begin, begin + missing])))).max()
    ran = np.abs(speed_at(np.array([begin - 1.5 / rate, begin + missing + 1.5 / rate])))
    if gone > 25.0 * FASTEST / rate and ran.min() > 0.5 * FASTEST and begin + missing < 5.0:
        assert at


@pytest.mark.parametrize('place', [0.0, 1e4, -300.0])
@pytest.mark.parametrize('at', [20, 570, 590, 1170])
def test_a_position_that_is_set_at_rest_is_no_leap(place, at):
    times = rows_of(100.0)
    assert not leap_on(np.where(np.arange(len(times)) < at, place_at(times), place))


def test_rows_that_miss_in_a_log_without_times_are_named(tmp_path, refused):
    times = rows_of(100.0)
    lines = [f'{place_at(times)[at]:.4f};1' for at in (*range(300), *range(360, 1200))]
    text = '\n'.join(['Sample rate: 100 Hz', 'x position [mm];x force [N]', *lines])
    (tmp_path / 'log.csv').write_text(text + '\n')
    content = {
        'time': {'rate_Hz': 100.0, 'epoch': '2000-01-01T00:00:00Z'},
        'axes': {
            'x': {
                'lead_mm': 10.0,
                'position': {'column': 'x position [mm]', 'unit': 'mm'},
                'load': {'column': 'x force [N]', 'unit': 'N', 'magnitude': False},
            }
        },
    }
    refused('leap', read_series, tmp_path / 'log.csv', make_map(content))
