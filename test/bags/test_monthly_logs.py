# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The monthly logs hold the torque of the closed form at their preload and in their oil."""

import dataclasses
import datetime as dt
import json
import math

from ballscrew_monitor.cli import main
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import parameters_of
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.summary import summary_of
from ballscrew_monitor.report import health_collect
import monthly_logs
import numpy as np
import pytest
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw.closed_form import solve
from surrogate.screw.opened import Contacts
from surrogate.units import RPM, ZERO_CELSIUS

LAST = monthly_logs.months('preload')[-1]
TOLD = {'preload': 'preload is lost (', 'oil': 'the oil is thinner, or warmer than measured: '}
BEGUN = {'preload': slice(1, 8), 'oil': slice(monthly_logs.CHANGED - 1, monthly_logs.CHANGED + 2)}
"""
Logs with which the change may be said to begin.

The preload falls from the second log on; the oil changes with one log, which may be dated by the
log before or after it.

"""
SMALL = monthly_logs.Plan(cuts=(600.0, 1500.0), period=0.1)
SMALL_LAST = monthly_logs.months('preload', SMALL)[-1]
STEADY = {'rapid': 2000.0, 'rough cut': 50.0, 'idle': -50.0, 'probe': -20.0, 'medium': 300.0}


@pytest.fixture(scope='module')
def motion():
    return monthly_logs.samples_of(monthly_logs.motion_of(LAST))


def steady(motion, rpm):
    """Return the places of samples that have run at a speed [rev/min] for five samples."""
    near = np.abs(motion.speed - rpm * RPM) < 1e-6 * abs(rpm)
    return np.flatnonzero(np.convolve(near, np.ones(5), 'full')[: near.size] == 5)


@pytest.mark.parametrize('rpm', STEADY.values(), ids=STEADY)
def test_the_torque_is_that_of_the_closed_form_and_of_the_wiper(motion, rpm):
    places = steady(motion, rpm)[:40:20]
    screw = load_screw('iso3408_40x10')
    loosened = Contacts.of(dataclasses.replace(screw, preload=0.4 * screw.preload))
    run_in = loosened.with_law(Contacts.of(screw).law)
    torque = monthly_logs.torque_of(LAST, motion)[places]
    speed, load, oil = abs(rpm) * RPM, motion.load[places], motion.oil[places]
    solved = solve(run_in, load_lubricant('iso_vg_68'), speed, load, oil + ZERO_CELSIUS)
    wiper = 0.04 + 0.02 * math.exp(-speed / 5.0)
    drag = math.copysign(1.0, rpm) * (solved.friction_torque + wiper)
    assert torque == pytest.approx(drag - load * 0.010 / (2 * math.pi), abs=1e-3, rel=0.002)


def test_a_cut_opposes_the_motion_and_costs_torque(motion):
    torque = monthly_logs.torque_of(LAST, motion)
    for rpm in (100.0, -100.0):
        places = steady(motion, rpm)
        assert (np.sign(rpm) * motion.load[places]).max() < -80.0  # always the guide
        assert (np.sign(rpm) * motion.load[places]).min() < -900.0
        assert (np.sign(rpm) * torque[places]).min() > 0.0


def test_the_preload_falls_to_four_tenths_or_the_oil_changes():
    preload, oil = (monthly_logs.months(cause) for cause in ('preload', 'oil'))
    assert [month.preload for month in preload] == pytest.approx(np.linspace(1.0, 0.4, 12))
    assert {month.oil for month in preload} == {'iso_vg_68'}
    assert [month.oil for month in oil] == ['iso_vg_68'] * 5 + ['iso_vg_32'] * 7
    assert {month.preload for month in oil} == {1.0}


def test_the_oil_follows_the_season_and_stays_where_friction_is_solved():
    ends = np.array(
        [monthly_logs.motion_of(month).oil[[0, -1]] for month in monthly_logs.months('oil')]
    )
    assert ends.min() > monthly_logs.OIL_NODES[0]
    assert ends.max() < monthly_logs.OIL_NODES[-1]
    assert ends[6] == pytest.approx(ends[0] + 12.0)
    assert (ends[:, 1] - ends[:, 0] > 8.0).all()


def test_a_log_is_judged_with_its_own_parameters_and_nothing_is_refused(tmp_path):
    path = next(monthly_logs.generate(tmp_path, plan=SMALL))
    bag = Bag(path)
    states = []

    def said():
        for state, event in replay(bag, parameters_of(bag)):
            states.append(state)
            yield state
            if event is not None:
                yield event

    summary = summary_of(said())
    assert path.name == 'month_01'
    sent = bag.topics['/joint_states'].count
    assert sent - 1 <= summary.judged <= sent  # the direction of the first one may be open
    assert {one.name: one.dropped for one in states[-1].inputs} == dict.fromkeys(
        ['speed', 'load', 'temperature', 'torque'], 0
    )
    assert summary.running_time > 170.0


def test_the_same_source_gives_the_same_messages():
    first = monthly_logs.records_of(SMALL_LAST)
    monthly_logs.programme.cache_clear()
    assert monthly_logs.records_of(SMALL_LAST) == first


@pytest.mark.parametrize('cause', ['preload', 'oil'])
def test_twelve_months_end_in_the_right_sentence(cause, tmp_path, capsys, monkeypatch, says):
    """The size is held against the friction that was written into the logs."""
    monkeypatch.setattr(health_collect, 'FEW', SMALL.logs)  # in this process
    for _ in monthly_logs.generate(tmp_path, cause, SMALL):
        pass
    assert main(['health', str(tmp_path), '--json']) == 0
    record = json.loads(capsys.readouterr().out)['x']
    drag = record['quantities']['drag change']
    assert drag['low'] < change_of(cause) < drag['high']
    days = [month.begin // monthly_logs.DAY for month in monthly_logs.months(cause, SMALL)]
    assert record['since_ns'] // monthly_logs.DAY in days[BEGUN[cause]]
    low, high = sorted(abs(drag[end]) for end in ('low', 'high'))
    date = dt.datetime.fromtimestamp(record['since_ns'] / 1e9, dt.UTC)
    percents = {'value': -drag['value'], 'low': low, 'high': high}
    head = says(
        'worse',
        date=f'{date.day} {date:%B %Y}',
        **{name: f'{100.0 * share:.0f}' for name, share in percents.items()},
    )
    assert record['verdict'].startswith(head)
    assert TOLD[cause] in record['verdict']
    assert len(record['course']) == 12


def change_of(cause):
    """
    Return the change of the mean friction of the last two logs over the first four [-].

    At the speeds that run forth and back under one load, and at the mean oil of these six logs.

    """
    speed = np.array([20.0, 180.0, 300.0, 600.0, 1500.0, 2000.0]) * RPM
    logs = monthly_logs.months(cause, SMALL)
    first, last = logs[:4], logs[-2:]
    oil = np.mean([monthly_logs.motion_of(log).oil.mean() for log in (*first, *last)])
    load, oils = np.full(len(speed), 100.0), np.full(len(speed), oil)
    seal = monthly_logs.SEAL * np.exp(-speed / monthly_logs.SEAL_SPEED)
    before, now = (
        np.mean([monthly_logs.friction(log, speed, load, oils) for log in part], axis=0)
        + monthly_logs.WIPER
        + seal
        for part in (first, last)
    )
    return now.mean() / before.mean() - 1.0
