# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signs and sizes of load, motor torque and motion that contradict each other, and no others."""

import os
from pathlib import Path

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.report.balance import Balance, balance_of
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.report.survey import RowSums, Surveyor
from hypothesis import given, strategies
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.units import TURN

SURFACE = Surface.load(shipped_surface())
LEAD = SURFACE.lead  # [m]
COUNT = 400
TIME = np.arange(COUNT) / 50.0  # [s]
MOTION = np.sign(np.sin(TIME) + 1e-9)
FORCES = {
    'against the motion': -800.0 * MOTION - 100.0 * np.sin(3 * TIME),
    'of a process': -500.0 + 300.0 * np.sin(0.7 * TIME),
    'of a weight that is cut': 2000.0 + 50.0 * np.cos(5 * TIME),
}
NOISE = np.random.default_rng(1).normal(size=COUNT)


def make_surveyor(judged):
    limits = judged.case([judged.rows()]).settings.limits
    return Surveyor('x', SURFACE, limits, max_gap=SECOND // 2)


@pytest.fixture
def balance(judged):
    """Return a function that balances rows in motion, in two blocks."""

    def made(force, torque, motion=MOTION, source=PointSource.MEASURED, modelled=0.2):
        surveyor = make_surveyor(judged)
        direction = np.where(motion > 0, Direction.POSITIVE, Direction.NEGATIVE)
        for part in (slice(150), slice(150, None)):
            surveyor.add(
                judged.rows(
                    count=len(TIME[part]),
                    speed=60.0 * motion[part],
                    direction=direction[part],
                    axial_load=np.broadcast_to(force, COUNT)[part],
                    axial_load_source=source,
                    motor_torque=np.broadcast_to(torque, COUNT)[part],
                    motor_torque_source=PointSource.MEASURED,
                    friction_torque=np.broadcast_to(modelled, COUNT)[part],
                ).rows
            )
        return balance_of(surveyor.sums)

    return made


def torque_of(force, friction=0.2, noise=0.02):
    """Return the motor torque [N m] that a force on the nut [N] and friction need."""
    return -LEAD / TURN * force + friction * MOTION + noise * NOISE


@pytest.mark.parametrize('force', FORCES.values(), ids=FORCES)
@pytest.mark.parametrize(
    ('signs', 'turned'),
    [
        ((1, 1, 1), None),
        ((-1, 1, 1), Source.LOAD),
        ((1, -1, 1), Source.TORQUE),
        ((1, 1, -1), Source.SPEED),
    ],
)
def test_the_sign_that_contradicts_the_others_is_known(force, signs, turned, balance):
    load, torque, motion = signs
    found = balance(load * force, torque * torque_of(force), motion * MOTION)
    assert found == Balance(turned=turned)


@given(
    strategies.floats(10.0, 1e4),
    strategies.floats(0.01, 5.0),
    strategies.floats(-20.0, 20.0),
    strategies.floats(0.85, 1.15),
)
def test_what_obeys_the_law_contradicts_nothing(size, friction, weight, loss):
    force = size * np.sin(1.3 * TIME)
    torque = -loss * LEAD / TURN * force + friction * MOTION + weight
    assert balance_of(RowSums()) == Balance()
    rows = np.stack([-LEAD / TURN * force, MOTION, np.ones(COUNT), torque])
    products = (rows @ rows.T).ravel().tolist()
    sums = RowSums(of_both=products, of_load=products, of_torque=products)
    assert balance_of(sums) == Balance()


def test_a_load_that_follows_the_motion_is_judged_by_it(balance):
    """Where load and motion cannot be told apart, friction decides."""
    force = -800.0 * MOTION
    torque = torque_of(force, noise=0.0)
    assert balance(force, torque).turned is None
    assert balance(-force, torque).turned is Source.LOAD
    assert balance(force, -torque).turned is Source.TORQUE
    assert balance(force, torque, -MOTION).turned is Source.SPEED
    driven = torque_of(-force, noise=0.0)  # the load drives the screw, the motor holds it
    assert balance(-force, driven).turned is None


def test_a_load_or_a_torque_alone_must_not_drive_both_ways(balance):
    nothing, drag = np.full(COUNT, np.nan), torque_of(0.0)
    assert balance(nothing, drag) == Balance()
    assert balance(nothing, -drag).turned is Source.TORQUE
    opposing = -300.0 * MOTION + 100.0
    assert balance(opposing, nothing) == Balance()
    assert balance(-opposing, nothing).turned is Source.LOAD
    assert balance(300.0 * MOTION + 500.0, nothing) == Balance()  # a weight may do so one way
    assert balance(-opposing, nothing, source=PointSource.DERIVED) == Balance()
    assert balance(nothing, -drag, np.ones(COUNT)) == Balance()


def test_noise_and_few_rows_tell_nothing(balance, judged):
    force = FORCES['of a process']
    assert balance(-force, 0.1 * MOTION + 20.0 * NOISE) == Balance()
    surveyor = make_surveyor(judged)
    surveyor.add(judged.rows(count=49, motor_torque=np.linspace(-1, 0, 49)).rows)
    assert balance_of(surveyor.sums) == Balance()


@pytest.mark.parametrize(('load', 'torque', 'friction'), [(1e-3, 1.0, 1.0), (1.0, 1e3, 1e3)])
def test_a_wrong_size_is_told_with_the_friction_beside_it(load, torque, friction, balance):
    force = FORCES['of a process']
    found = balance(load * force, torque * torque_of(force, noise=0.001))
    assert found.turned is None
    assert found.factor == pytest.approx(1e3, rel=0.02)
    assert found.friction == pytest.approx(friction, rel=0.05)


def test_rows_that_are_not_judged_do_not_thin_out_the_friction_of_the_model(balance):
    """A load in a unit that is too small is mostly beyond the surface."""
    force, known = FORCES['of a process'], np.where(np.arange(COUNT) % 50 == 0, 0.2, np.nan)
    torque = torque_of(force, noise=0.001)
    found = balance(1e3 * force, torque, modelled=known)
    assert found.friction == pytest.approx(1.0, rel=0.05)
    unknown = balance(1e3 * force, torque, modelled=np.nan)
    assert unknown.factor == pytest.approx(found.factor)
    assert np.isnan(unknown.friction)


@pytest.mark.skipif(
    'BALLSCREW_RECORDINGS' not in os.environ, reason='BALLSCREW_RECORDINGS names no recordings'
)
@pytest.mark.parametrize(('scale', 'turned'), [(1.0, None), (-1.0, Source.LOAD)])
def test_the_currents_of_a_real_machine_tell_their_sign(scale, turned, tmp_path):
    log = Path(os.environ['BALLSCREW_RECORDINGS']) / 'cnc_mill' / 'experiment_01.csv'
    content = guess(log).content
    content['time']['rate_Hz'] = 10.0
    for axis in 'xy':
        content['axes'][axis]['current'] |= {'scale': scale, 'unit': 'A'}
    convert(log, make_map(content), tmp_path / 'bag')
    bag = Bag(tmp_path / 'bag')
    found = judge_log(bag, parameters_for(bag, None, log)).axes
    assert {case.axis: case.balance.turned for case in found} == {
        'x': turned,
        'y': turned,
        'z': None,
    }
