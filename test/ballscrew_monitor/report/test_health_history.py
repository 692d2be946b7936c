# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of months: plain data and back, and the command that tells their health."""

import dataclasses
import json
import math
from types import SimpleNamespace

from ballscrew_monitor.cli import main
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import Cell, Condition, Health, Quantity, SpectrumBin
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.judge.many import ROW
from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.report.health_axes import assess_axes, logged_axes
from ballscrew_monitor.report.health_command import days_of
from ballscrew_monitor.report.health_history import (
    AxisHistory,
    by_axis,
    health_after,
    healths,
    HistoryMaker,
    peers_among,
)
from ballscrew_monitor.report.health_part import health_chapter
from ballscrew_monitor.report.health_picture import figure_health
from ballscrew_monitor.report.log_report import AxisLine, LogResult
from ballscrew_monitor.report.machines import axis_titles
from ballscrew_monitor.report.many_logs import Workers
from ballscrew_monitor.report.overview import overview_page
import numpy as np
import pytest
from surrogate.files import to_json
from surrogate.surface import shipped_surface, Surface

FIRST, MONTH = 20_000, 30


@pytest.fixture(scope='module')
def months(usual_limits):
    """Return histories of twelve months, each of one day, under a wiper that grows."""
    return [history(usual_limits, number, 0.01 * number) for number in range(12)]


def history(limits, number, wiper):
    day, cells = FIRST + MONTH * number, []
    for band, speed in enumerate((3.0, 12.0, 40.0, 120.0)):
        for sign in (1, -1):
            cells.append(
                Cell(
                    start=day * DAY,
                    first_day=day,
                    speed_band=band,
                    direction=sign,
                    stretches=8,
                    duration=160.0,
                    speed=sign * speed,
                    axial_load=0.0,
                    temperature=313.0,
                    motor_torque=sign * (0.3 + 0.1 * band + wiper),
                )
            )
    one = SpectrumBin(
        first_day=day,
        load_band=99,
        axial_load=math.nan,
        angle=1.0,
        speed=10.0,
        time=1280.0,
        wear_time=(1.0, 2.0),
    )
    return AxisHistory(
        axis='x',
        surface=str(shipped_surface()),
        limits=limits,
        first=day * DAY,
        last=day * DAY + 1,
        cells=tuple(cells),
        bins=(one,),
    )


def test_a_log_of_a_clock_that_was_not_set_is_not_known_and_disturbs_no_other(
    months, usual_limits, says
):
    rows = np.zeros(1000, ROW)
    rows['stamp'] = 5 * SECOND + np.arange(1000) * (SECOND // 100)  # in 1970
    rows['speed'], rows['motor_torque'], rows['temperature'] = 50.0, 0.5, 313.0
    for name in ('motor_torque_source', 'axial_load_source', 'temperature_source', 'direction'):
        rows[name] = 1
    maker = HistoryMaker(Surface.load(shipped_surface()))
    maker.add(rows)
    settings = SimpleNamespace(limits=usual_limits, speed_allowed=False)
    unset = maker.history('x', shipped_surface(), settings)
    assert (len(unset.cells), unset.bins) == (1, ())
    assert health_after(unset).verdict == says('clock_not_set')
    assert healths([*months, unset]) == healths(months)


def test_a_history_survives_json(months, usual_limits):
    plain = json.loads(json.dumps(to_json(dataclasses.asdict(months[3]))))
    found = record_of(AxisHistory, plain)
    assert repr(found.cells) == repr(list(months[3].cells))
    (one,) = found.bins
    assert (one.wear_time, one.time) == ((1.0, 2.0), 1280.0)
    assert math.isnan(one.axial_load)
    assert (found.axis, found.last, found.limits) == ('x', months[3].last, usual_limits)


def test_health_follows_the_recordings_whatever_their_order(months):
    courses = healths(months[::-1])
    assert [one.stamp // DAY for one in courses] == [FIRST + MONTH * n for n in range(12)]
    assert courses[0].condition is Condition.UNKNOWN
    assert courses[-1].condition is Condition.WORSE
    assert 'the drag of a wiper, seal, guideway or bearing' in courses[-1].verdict
    assert courses[-1].baseline.begin == FIRST * DAY
    assert courses[-1].since > courses[-1].baseline.begin


def test_the_overview_begins_with_normal_or_worse(months):
    page = overview_page([entry(one) for one in months])
    assert page.index('Axis x is worse') < page.index('ran outside the optimal zone')
    assert 'ook at wipers, covers, guideway and bearings' in page
    alone = overview_page([entry(months[0])])
    assert 'normal or worse' not in alone


def test_a_picture_shows_the_interval_or_says_why_there_is_none():
    reason = 'not known yet: 2 logs so far'
    one = Health(
        axis='x',
        stamp=FIRST * DAY,
        condition=Condition.WORSE,
        verdict='',
        quantities=[Quantity(name='drag change', value=-0.2, low=-0.25, high=-0.15)],
    )
    other = dataclasses.replace(one, quantities=[Quantity(name='drag change', reason=reason)])
    first, second = figure_health({'x': [one], 'y': [other]}).axes
    assert first.get_ylabel() == 'change of the friction [%]'
    assert second.texts[0].get_text() == reason


def test_the_command_tells_what_one_recording_lacks(capsys, tmp_path):
    assert main(['health', 'bags/nominal_cycle', '--out', str(tmp_path), '--json']) == 0
    record = json.loads(capsys.readouterr().out)['x']
    assert record['condition'] == 'unknown'
    assert 'no torque was measured while the axis moved' in record['verdict']
    assert (tmp_path / 'health.png').stat().st_size > 0
    assert json.loads((tmp_path / 'health.json').read_text())['x']['course']


def test_the_command_says_what_is_odd_about_a_bag_once(miscounted_bag, capsys):
    assert main(['health', str(miscounted_bag)]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if 'counts other' in line]
    assert [line.startswith(f'ballscrew: {miscounted_bag}: bag ') for line in lines] == [True]


def test_where_no_log_can_be_read_nothing_is_written(capsys, tmp_path, says):
    assert main(['health', 'none.mcap', '--out', str(tmp_path / 'out')]) == 2
    assert capsys.readouterr().err.splitlines()[0] == says('no_log')
    assert not (tmp_path / 'out').exists()


def test_the_overview_draws_trends_and_ranks_axes_with_one_programme(months):
    entries = [entry(one) for one in months]
    entries += [entry(dataclasses.replace(months[0], axis=name)) for name in 'yz']
    page = overview_page(entries)
    assert 'Axis x: change of the friction, with 95 % intervals' in page
    assert page.count('class="line-interval"') >= 8
    assert page.count('apart from its peers') == 1
    assert 'Axis x: its friction torque differs by +' in page


def test_an_axis_of_another_machine_has_a_history_of_its_own(months):
    """The wiper of one axis x grows, that of the other does not; together both would be lost."""
    worn = [dataclasses.replace(one, machine='/hall/a') for one in months]
    sound = [dataclasses.replace(aged(months[0], at), machine='/hall/b') for at in range(12)]
    page = overview_page([entry(one) for one in (*worn, *sound)])
    assert 'Axis x of a is worse' in page
    assert 'Axis x of b is normal: its friction has changed by +0 % (' in page
    assert 'Axis x of b: change of the friction, with 95 % intervals' in page
    kept = by_axis([*sound, *worn])
    drags = {axis: healths(own)[-1].quantity('drag change') for axis, own in kept.items()}
    assert drags['/hall/b', 'x'].value == pytest.approx(0.0, abs=1e-6)
    assert drags['/hall/a', 'x'].low > 0.1


def test_axes_of_one_name_on_three_machines_are_peers(months):
    sound = aged(months[0], 11)
    made = [dataclasses.replace(sound, machine=f'/hall/{name}') for name in 'bcd']
    worn = [dataclasses.replace(one, machine='/hall/a') for one in months]
    titles = axis_titles(by_axis([*worn, *made]))
    apart = [one.axis for one in peers_among([*worn, *made], titles) if one.is_apart]
    assert apart == ['x of a']


def test_three_machines_of_one_screw_share_what_they_know(months):
    histories = [dataclasses.replace(one, machine=name) for name in 'abc' for one in months[:8]]
    options = {'baseline_days': 91.0, 'days': None, 'speed_allowed': False}
    widths = []
    for some in (histories[:8], histories):
        axes = logged_axes(some)
        found = assess_axes(axes, axis_titles(axes), options, Workers())
        drag = found[histories[0].key][-1].quantity('drag change')
        widths.append(drag.high - drag.low)
    assert widths[1] < 0.98 * widths[0]


def entry(one):
    line = AxisLine(axis=one.axis, standing='bad', verdict='Outside: always', machine=one.machine)
    return LogResult(name='month', folder='month', lines=[line], histories=[one])


def aged(one, months):
    """Return a history as of some months later."""
    later = MONTH * months
    cells = [
        dataclasses.replace(cell, start=cell.start + later * DAY, first_day=cell.first_day + later)
        for cell in one.cells
    ]
    first, last = one.first + later * DAY, one.last + later * DAY
    return dataclasses.replace(one, cells=cells, first=first, last=last)


def test_a_chapter_tells_the_known_and_why_the_rest_is_not(months):
    chapter = health_chapter(health_after(months[0]))
    assert chapter.index('Health: normal or worse') < chapter.index('class="verdict')
    assert 'drag change' in chapter
    assert 'not known' in chapter
    worse = health_chapter(healths(months)[-1])
    assert 'the drag of a wiper, seal, guideway or bearing has changed' in worse
    assert '<td>excluded</td>' in worse


def test_a_feed_is_advised_only_where_the_parameters_leave_it_free(months):
    """Beside the oil, which is advised in any case: a programme of one feed in warm oil."""
    warm = [dataclasses.replace(one, temperature=320.0) for one in months[0].cells[4:6]]
    bound = dataclasses.replace(months[0], cells=warm)
    free = dataclasses.replace(bound, speed_allowed=True)
    said = [health_after(one).advice for one in (bound, free)]
    assert ['oil temperature of 40 degC' in one for one in said] == [True, True]
    assert ['feeds of' in one for one in said] == [False, True]
    assert [one.advice for one in healths([bound], speed_allowed=True)] == said[1:]


def test_the_baseline_may_be_named_by_its_days(months, refused):
    later = days_of('2024-11-01', '2025-01-30')
    last = healths(months, days=later)[-1]
    assert (last.baseline.begin, last.baseline.reason) == (later[0], 'named by its days')
    assert last.condition is Condition.WORSE
    with refused('too_few'):
        healths(months, days=days_of('2024-11-01', '2024-11-30'))


def test_recordings_that_begin_at_one_instant_have_no_order(months):
    (only,) = healths([*months, months[0]])
    assert only.condition is Condition.UNKNOWN
    assert 'two recordings begin at 2024-10-04 00:00:00 UTC' in only.verdict


@pytest.mark.parametrize('dates', [('2020-13-45', '2026-01-01'), ('monday', '2026-01-01')])
def test_dates_that_cannot_be_are_one_sentence(refused, dates):
    with refused('dates', dates=' '.join(dates)):
        days_of(*dates)
