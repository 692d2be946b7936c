# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The survey of rows: the same whatever the blocks, gaps, and a time line that can be trusted.

The time surely outside is that of rows beyond both bands of the limit, or of a low efficiency.

"""

import copy
import math

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Limits, Reason, Zone
from ballscrew_monitor.judge.records import LIGHT_LOAD
from ballscrew_monitor.report.survey import Surveyor
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface

GAP, SHORT_GAP = SECOND // 2, SECOND // 20
SURFACE = Surface.load(shipped_surface())
LIMITS = Limits(
    rcs=0.01,
    efficiency=0.5,
    light_load=1.0,
    standstill_speed=0.5,
    raise_delay=0,
    clear_delay=0,
    hysteresis=0.1,
)
LEAST = SURFACE.onset_band[0]


def survey_of(*blocks):
    surveyor = Surveyor('x', SURFACE, LIMITS, max_gap=GAP)
    for block in blocks:
        surveyor.add(block.rows)
    return surveyor.result()


def test_it_does_not_depend_on_the_blocks(judged):
    blocks = [judged.rows(0, 70), judged.rows(70, 30), judged.rows(100, 1)]
    parts, whole = survey_of(*blocks), survey_of(judged.rows(0, 101))
    assert parts.reasons == pytest.approx(whole.reasons)
    assert parts.energy == pytest.approx(whole.energy)
    assert (parts.rows, parts.first, parts.last) == (whole.rows, whole.first, whole.last)
    assert parts.inputs[Source.SPEED].mean == pytest.approx(whole.inputs[Source.SPEED].mean)
    assert whole.span == pytest.approx(1.0)


def test_time_and_energy_are_summed_and_only_measured_inputs_have_extremes(judged):
    found = survey_of(judged.rows(speed=10.0, friction_torque=0.5))
    assert found.reasons == {Reason.JUDGED: pytest.approx(0.99)}
    assert found.energy[Zone.OPTIMAL] == pytest.approx(0.99 * 5.0)
    found = survey_of(judged.rows(speed=0.0, reason=Reason.STANDSTILL, zone=Zone.UNKNOWN))
    assert sum(found.energy.values()) == 0.0
    assert math.isnan(found.opposing.mean)
    found = survey_of(judged.rows(temperature_source=2))
    assert math.isnan(found.inputs[Source.TEMPERATURE].low)
    assert found.inputs[Source.LOAD].high == pytest.approx(-950.0)


def test_gaps_are_listed_longest_first_and_are_no_time_of_a_reason(judged):
    blocks = [judged.rows(0, 10), judged.rows(110, 10), judged.rows(420, 10)]
    found = survey_of(*blocks)
    speed = found.gaps[Source.SPEED]
    assert [length / SECOND for _, length in found.speed_gaps] == pytest.approx([3.01, 1.01])
    assert (speed.count, speed.time) == (2, pytest.approx(4.02))
    assert found.reasons[Reason.JUDGED] == pytest.approx(0.27)
    assert sum(found.reasons.values()) + found.uncounted == pytest.approx(found.span)


def test_the_motion_in_a_gap_between_moving_samples_is_missed(judged):
    moving, still = judged.rows(0, 10, speed=10.0), judged.rows(111, 10, speed=0.0)
    again, later = judged.rows(222, 10, speed=10.0), judged.rows(431, 10, speed=-10.0)
    found = survey_of(moving, still, again, later)
    assert found.missed == pytest.approx(2.0)
    assert found.missed_share == pytest.approx(2.0 / 2.27)
    assert survey_of(moving, still, judged.rows(222, 1, speed=0.0)).missed_share == 0.0


@pytest.mark.parametrize('clock', ['stamp', 'now'])
def test_no_motion_is_missed_where_one_clock_leaps(judged, clock):
    later = judged.rows(10, 10, speed=10.0)
    later.rows[clock] += 5 * SECOND
    assert survey_of(judged.rows(0, 10, speed=10.0), later).missed == 0.0


def test_pauses_between_runs_are_no_time_and_no_gap(judged):
    surveyor = Surveyor('x', SURFACE, LIMITS, max_gap=GAP)
    for run, begin in enumerate([0, 110, 420]):
        for block in (judged.rows(begin, 4), judged.rows(begin + 4, 6)):
            surveyor.add(block.rows, run)
    found = surveyor.result()
    assert (found.runs, found.rest, found.speed_gaps) == (3, 0.0, ())
    assert (found.span, found.pauses) == (pytest.approx(0.27), pytest.approx(4.02))
    assert found.reasons == {Reason.JUDGED: pytest.approx(0.27)}


def test_gaps_of_another_input_are_stretches_without_a_valid_sample(judged):
    sources = np.ones(100)
    sources[40:50] = sources[90:] = 3
    block = judged.rows(axial_load_source=sources)
    halves = [block._replace(rows=rows) for rows in np.split(block.rows, [45])]
    for blocks in ([block], halves):
        gaps = survey_of(*blocks).gaps
        assert (gaps[Source.LOAD].count, gaps[Source.LOAD].time) == (2, pytest.approx(0.19))
        assert gaps[Source.TEMPERATURE].count == 0


def test_a_stray_stamp_makes_the_log_the_time_line(judged):
    block = judged.rows()
    block.rows['stamp'][50] = 1
    found = survey_of(block)
    assert not found.by_stamp
    assert found.span == pytest.approx(0.99)
    assert found.shift == 1000


def test_torque_is_compared_by_direction(judged):
    block = judged.rows(motor_torque_source=1, motor_torque=1.7)
    directions = np.where(np.arange(100) < 50, 1, 2)
    torque = np.where(directions == 1, 1.7, -1.9)
    machine = np.where(directions == 1, 1.5, -1.5)
    found = survey_of(
        judged.changed(block, direction=directions, motor_torque=torque, machine_torque=machine)
    ).torque
    expected = (100, pytest.approx(0.2), pytest.approx(-0.4))
    assert (found.count, found.forward, found.backward) == expected


def test_sums_are_those_of_the_whole_arrays(judged):
    """Rows of any kind, against numpy on columns."""
    draw = np.random.default_rng(1)
    count = 4000
    codes = {
        f'{name}_source': draw.integers(0, 5, count)
        for name in ('speed', 'axial_load', 'temperature', 'motor_torque')
    }
    numbers = {
        name: np.where(draw.random(count) < 0.1, np.nan, draw.normal(mean, 50.0, count))
        for name, mean in [('axial_load', -300.0), ('temperature', 310.0), ('motor_torque', 2.0)]
    }
    step = draw.choice([0, -GAP, GAP // 50, GAP, GAP + 1], count, p=[0.1, 0.1, 0.6, 0.1, 0.1])
    block = judged.rows(
        count=count,
        stamp=judged.begin + np.cumsum(step),
        speed=draw.normal(0.0, 1.0, count),
        friction_torque=np.where(draw.random(count) < 0.1, np.nan, draw.random(count)),
        direction=draw.integers(0, 3, count),
        reason=draw.integers(0, len(Reason), count),
        zone=draw.integers(0, len(Zone), count),
        tick=draw.random(count) < 0.1,
        **codes,
        **numbers,
    )
    rows = block.rows
    found = survey_of(*(block._replace(rows=part) for part in np.split(rows, [7, 2000])))
    moving = np.abs(rows['speed']) >= 0.5
    steps = np.diff(rows['stamp'])
    lasts = np.where((steps > 0) & (steps <= GAP), steps, 0) / SECOND
    for reason, code in zip(Reason, range(len(Reason))):
        held = rows['reason'][:-1] == code
        assert found.reasons.get(reason, 0.0) == pytest.approx(lasts[held].sum())
        held &= moving[:-1] & ~rows['tick'][:-1]
        assert found.moving.get(reason, 0.0) == pytest.approx(lasts[held].sum())
    power = np.where(moving, np.nan_to_num(rows['friction_torque'] * np.abs(rows['speed'])), 0.0)
    for zone in Zone:
        energy = (lasts * power[:-1])[rows['zone'][:-1] == zone].sum()
        assert found.energy[zone] == pytest.approx(energy)
    for source, name in [(Source.LOAD, 'axial_load'), (Source.TORQUE, 'motor_torque')]:
        origin = rows[f'{name}_source']
        known = rows[name][np.isin(origin, (1, 4)) & np.isfinite(rows[name])]
        span = found.inputs[source]
        assert (span.low, span.high) == (known.min(), known.max())
        assert span.mean == pytest.approx(known.mean())
        held = origin == 3
        assert found.gaps[source].count == (held & ~np.insert(held[:-1], 0, False)).sum()
        assert found.gaps[source].time == pytest.approx(lasts[held[:-1]].sum())
    opposing = np.array([np.nan, -1.0, 1.0])[rows['direction']] * rows['axial_load']
    assert found.opposing.mean == pytest.approx(np.nanmean(opposing[moving]))
    compared = moving & (rows['motor_torque_source'] == 1) & (rows['axial_load_source'] != 4)
    residual = (rows['motor_torque'] - rows['machine_torque'])[compared]
    assert found.torque.spread == pytest.approx(np.sqrt(np.nanmean(residual**2)))
    forward = residual[rows['direction'][compared] == 1]
    assert found.torque.forward == pytest.approx(np.nanmean(forward))
    assert found.uncounted == pytest.approx(steps[steps > GAP].sum() / SECOND)


def seconds(rows, surface=SURFACE, *, parts=1):
    """Return the time surely outside of rows that come in parts."""
    surveyor = Surveyor('x', surface, LIMITS, max_gap=SHORT_GAP)
    for part in np.array_split(rows, parts):
        surveyor.add(part)
    return surveyor.sure_time


@pytest.fixture
def outside(judged):
    """Return a function that gives 101 rows outside, a second, at a share of the limit's speed."""
    low, high = SURFACE.speed_range
    for _ in range(60):
        middle = math.sqrt(low * high)
        above = SURFACE.lookup(middle, 1000.0, 313.15).rcs >= LIMITS.rcs
        low, high = (middle, high) if above else (low, middle)

    def rows(share, **changes):
        values = {
            'speed': -share * high,
            'axial_load': 1000.0,
            'direction': Direction.NEGATIVE,
            'zone': Zone.OUTSIDE,
            'rcs': 0.02,
        }
        return judged.rows(0, 101, **values | changes).rows

    return rows


@pytest.mark.parametrize('parts', [1, 7])
@pytest.mark.parametrize(
    ('share', 'sure'), [(0.98 * LEAST, 1.0), (1.02 * LEAST, 0.0), (0.98, 0.0)]
)
def test_slower_than_both_bands_is_sure(outside, share, sure, parts):
    assert seconds(outside(share), parts=parts) == pytest.approx(sure)


def test_too_low_an_efficiency_is_sure_where_it_is_judged(outside):
    assert seconds(outside(0.98, efficiency=0.4)) == pytest.approx(1.0)
    assert seconds(outside(0.98, efficiency=0.4, gates=LIGHT_LOAD)) == 0.0


def test_neither_rows_inside_nor_gaps_count(outside):
    assert seconds(outside(0.5 * LEAST, zone=Zone.OPTIMAL)) == 0.0
    rows = outside(0.5 * LEAST)
    rows['stamp'][50:] += SHORT_GAP
    assert seconds(rows) == pytest.approx(0.99)


def test_a_surface_without_its_bands_does_not_tell(outside):
    surface = copy.copy(SURFACE)
    surface.header = {**SURFACE.header, 'limit_band': (math.nan, math.nan)}
    assert math.isnan(seconds(outside(0.1), surface))
