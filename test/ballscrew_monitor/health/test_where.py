# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Places of a screw in years of axes by catalogues and textbooks, which share no law with it.

The generator stands in `bench/health_parts`: a worn place is a raised cosine there, and the table
follows the motor by a play operator, with pitch errors, growth, skew and noise.

"""

from collections import namedtuple
from dataclasses import replace
from pathlib import Path
import sys

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.assess import assess, HealthSettings
from ballscrew_monitor.health.records import (
    Baseline,
    CauseCode,
    Cell,
    CellKind,
    KeptHealth,
    Stretch,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.stroke import StrokeSums
from ballscrew_monitor.health.summary import array_of
from ballscrew_monitor.health.where import (
    LOST,
    LOST_CHANGE,
    lost_motion,
    lost_motion_grew,
    LOST_TREND,
    where_on_screw,
)
import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[3] / 'bench'))
from health_parts.along import WORN_AT  # noqa: E402, I100
from health_parts.axis_year import axis_year  # noqa: E402
from health_parts.faults import CLEAN, FAULTS, LOOSENED  # noqa: E402
from health_parts.summaries import cells_of_year, reversals_of  # noqa: E402

Steady = namedtuple('Steady', 'begin end speed')


def steady_parts(log):
    """Yield where the speed of a log stays within a twentieth of its mean, half a second long."""
    rate = 1.0 / (log.time[1] - log.time[0])
    smooth = np.convolve(log.speed, np.ones(5) / 5.0, 'same')
    still = np.abs(np.gradient(smooth)) * rate < 0.3 * np.abs(smooth) + 1e-9
    still &= np.abs(smooth) > 1.0
    edges = np.flatnonzero(np.diff(np.concatenate(([0], still.astype(int), [0]))))
    for begin, end in zip(edges[::2] + 4, edges[1::2] - 4):
        if end - begin >= 0.5 * rate:
            yield Steady(begin, end, float(np.mean(log.speed[begin:end])))


def cells_of_log(log, lead):
    stamps = log.start + np.rint(log.time * SECOND).astype(np.int64)
    stroke = StrokeSums()
    stroke.add(stamps, log.position, log.torque)
    stroke.take(
        Stretch(
            start=int(stamps[part.begin]),
            duration=(int(stamps[part.end - 1]) - int(stamps[part.begin])) / SECOND,
            samples=part.end - part.begin,
            speed=part.speed,
            axial_load=0.0,
            temperature=float(np.mean(log.temperature)),
            motor_torque=float(np.mean(log.torque[slice(part.begin, part.end)])),
        )
        for part in steady_parts(log)
    )
    return stroke.cells(log.start) + reversals_of(log, lead)


def told(seed, fault, **changes):
    """Return what is said at the end of a year, its baseline the first quarter."""
    year = axis_year(seed, fault, **changes)
    lead = year.machine.size.lead
    cells = array_of(cell for log in year.logs for cell in cells_of_log(log, lead))
    begin = year.logs[0].start
    return year, *where_on_screw(cells, Baseline(begin=begin, end=begin + 91 * DAY, reason=''))


def ratios(quantities):
    return {
        tuple(map(float, one.name.split()[2:5:2])): one
        for one in quantities
        if one.name.startswith('friction at ')
    }


@pytest.mark.parametrize('seed', range(4))
def test_a_worn_place_is_told_where_it_is(seed):
    year, quantities, (note,) = told(seed, FAULTS['worn place'])
    worn = WORN_AT * year.machine.stroke * 1e3
    low, high = max(ratios(quantities), key=lambda span: ratios(quantities)[span].value)
    width = high - low
    assert low - 0.5 * width <= worn <= high + 0.5 * width
    assert f'{low:.0f} to {high:.0f} mm of the stroke' in note


@pytest.mark.parametrize('fault', ['clean', 'preload -20 %', 'starved film', 'wiper swollen'])
def test_a_change_of_the_whole_stroke_is_no_place(fault):
    held, steps = 0, 0
    for seed in range(6 if fault == 'clean' else 2):
        _, quantities, notes = told(seed, FAULTS[fault])
        assert notes == []
        assert len(quantities) >= 5
        held += sum(one.low <= 1.0 <= one.high for one in quantities)
        steps += len(quantities)
    if fault == 'clean':
        assert held >= 0.9 * steps


@pytest.mark.parametrize('seed', range(2))
def test_play_that_grows_is_told_with_its_size(seed):
    _, quantities, notes = told(seed, FAULTS['play 20 um'], scale=True)
    found = {one.name: one for one in quantities}
    for name in (LOST, LOST_CHANGE):
        assert found[name].value == pytest.approx(20.0, abs=2.0)
    assert found[LOST_TREND].low > 0.0
    assert sum('the lost motion at reversals has grown by' in note for note in notes) == 1


@pytest.mark.parametrize('seed', range(2))
def test_play_that_grows_counts_from_its_date_on(seed):
    """Begun at a day of the year; of a date long after it, the play was there before."""
    year = axis_year(seed, replace(FAULTS['play 20 um'], ramp=0.0), scale=True)
    lead = year.machine.size.lead
    cells = array_of(cell for log in year.logs for cell in cells_of_log(log, lead))
    cells = cells[cells['kind'] == CellKind.REVERSAL]
    first, end = year.logs[0].start, year.logs[-1].start
    begun = first + round(year.fault.start) * DAY
    assert lost_motion_grew(cells, begun, end)
    assert lost_motion_grew(cells, begun - 28 * DAY, end)
    assert not lost_motion_grew(cells, begun + 56 * DAY, end)
    assert not lost_motion_grew(cells, begun - 56 * DAY, begun - 7 * DAY)
    assert not lost_motion_grew(cells, begun, begun + 5 * DAY)  # one log after it


NUT, BEARING = LOOSENED.values()


def causes_in(seed, fault, limits, surface, *, with_table=True):
    """Return the likely causes at the end of a year, the best first, and all of them by code."""
    year = axis_year(seed, fault, scale=True)
    cells = [cell for cell in cells_of_year(year) if with_table or cell.kind != CellKind.REVERSAL]
    settings = HealthSettings(limits=limits)
    health = assess('x', KeptHealth(cells), surface, settings, now=year.logs[-1].start + SECOND)
    return [one.code for one in health.causes if not one.excluded], health


@pytest.mark.parametrize('fault', [NUT, BEARING], ids=['nut', 'bearing'])
@pytest.mark.parametrize('seed', [0, 2])
def test_play_that_comes_with_a_loss_of_friction_tells_nut_or_support_bearing(
    seed, fault, usual_limits, surface, says
):
    codes, health = causes_in(seed, fault, usual_limits, surface)
    assert codes[0] is CauseCode.PRELOAD_LOST
    assert set(codes) <= {CauseCode.PRELOAD_LOST, CauseCode.WIPER}
    assert CauseCode.WIPER in codes or fault is NUT
    assert health.since
    if (seed, fault) == (2, NUT):
        assert health.verdict == says('lost_motion_as_well')


@pytest.mark.parametrize('fault', ['preload -40 %', 'wiper torn'])
def test_lost_motion_that_has_not_grown_proves_nothing(fault, usual_limits, surface):
    """A nut with less preload has none, so the causes are those without a second position."""
    with_table, without = (
        causes_in(1, FAULTS[fault], usual_limits, surface, with_table=measured)[1].causes
        for measured in (True, False)
    )
    assert with_table == without
    assert sum(not one.excluded for one in without) >= 2


def test_an_axis_that_keeps_its_play_has_no_note():
    held = 0
    for seed in range(5):
        _, quantities, notes = told(seed, CLEAN, scale=True)
        assert notes == []
        found = {one.name: one for one in quantities}
        assert abs(found[LOST].value) < 1.0
        assert found[LOST].low <= 0.0 <= found[LOST].high
        held += found[LOST_CHANGE].low <= 0.0 <= found[LOST_CHANGE].high
    assert held >= 4


def reversal(day, lost):
    return Cell(
        start=day * DAY, first_day=day, kind=CellKind.REVERSAL, stretches=10, backlash=lost
    )


def test_the_trend_of_lost_motion_is_that_of_a_line():
    """A line with alternating errors has the slope of the line, and the interval holds it."""
    days = np.arange(0, 364, 7)
    lost = 10e-6 + 5e-6 * days / 365.25 + 0.5e-6 * (-1.0) ** np.arange(len(days))
    cells = array_of(reversal(20_000 + int(day), one) for day, one in zip(days, lost))
    baseline = Baseline(begin=20_000 * DAY, end=20_091 * DAY, reason='')
    quantities, note = lost_motion(cells, baseline)
    found = {one.name: one for one in quantities}
    assert found[LOST_TREND].value == pytest.approx(5.0, abs=0.1)
    assert found[LOST_TREND].low < 5.0 < found[LOST_TREND].high
    assert found[LOST].value == pytest.approx(10.0 + 5.0 * np.mean(days[-4:]) / 365.25, abs=0.1)
    assert found[LOST_CHANGE].low > 2.0
    assert 'the lost motion at reversals has grown by' in note


def test_what_is_missing_is_said():
    nothing = array_of([])
    assert where_on_screw(nothing, None) == ([], [])
    few = array_of(reversal(20_000 + day, 1e-5) for day in range(2))
    assert lost_motion(few, None)[0][0].reason == 'not known yet: it needs three logs'
    some = array_of(reversal(20_000 + day, 1e-5) for day in range(5))
    (change,) = [one for one in lost_motion(some, None)[0] if one.name == LOST_CHANGE]
    assert change.reason == 'not known yet: it needs two logs in the baseline, and two after it'
