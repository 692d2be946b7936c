# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Scenarios of the screw and its oil: warm-up, wrong oil, lost preload.

The measured torque is that of the closed form, not of the surface that the monitor looks up.

"""

import math

from ballscrew_monitor.core.conversions import kelvin
from courses import constant, Course, moves, Steps
from feeding import CLEAR_DELAY, FEED, LATE, later, LOAD, OIL, RAMP, TOUCHING
from scenario import Expected, ExpectedEvent, LimitPoint, OIL_PERIOD, ResidualChange, Scenario
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw.closed_form import solve
from surrogate.screw.opened import Contacts
from surrogate.units import RPM

LIGHT_LOAD = 247.5  # [N] a quarter of the preload: efficiency is judged from here on
LEAD = 0.010  # [m]
DAY, WEEK = 86_400.0, 604_800.0
TORQUE_PARAMETERS = {
    'x.torque.topic': 'joint_states',
    'x.torque.type': 'sensor_msgs/msg/JointState',
    'x.torque.field': 'effort[x_axis]',
}
PRELOAD_WEEKS = 6  # 1015 h
PRELOAD_LOSS = (0.38, 0.27)  # [-] of the friction torque at their end, up and down
PRELOAD_STRETCH = 6.0  # [s] recorded of each week


def friction(oil: str, speed: float = FEED, load: float = LOAD) -> float:
    """Return the friction torque [N m] of the nominal screw with an oil, by the closed form."""
    screw, lubricant = load_screw('nominal'), load_lubricant(oil)
    return float(
        solve(Contacts.of(screw), lubricant, speed * RPM, load, kelvin(OIL)).friction_torque
    )


def warm_up() -> Scenario:
    """Feed while the oil warms up: thick oil costs efficiency, thin oil lets asperities touch."""
    oil = Course(((2.0, 20.0), (52.0, 75.0)))
    load = moves((2.0, -600.0), ramp=RAMP)
    thin_enough = oil.pass_between(34.8, 40.3)  # efficiency 0.865, 0.0036 a degree, 0.01 off
    too_thin = oil.pass_between(54.5, 59.0)  # the limit speed grows by 40 rev/min a degree
    return Scenario(
        shows='oil from 20 to 75 degC at one speed: the axis enters the zone, and leaves it again',
        duration=54.0,
        speed=moves((0.5, FEED), ramp=RAMP),
        load=load,
        oil=oil,
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK', 'WARN'),
            all_judged=True,
            events=(
                ExpectedEvent(
                    cause='EFFICIENCY_LOW',
                    start=later((load.passes(-LIGHT_LOAD)[0],) * 2, 0.0, LATE),
                    end=later(thin_enough, CLEAR_DELAY, CLEAR_DELAY + OIL_PERIOD + LATE),
                ),
                ExpectedEvent(
                    cause='RCS_HIGH', start=later(too_thin, 0.0, OIL_PERIOD + LATE), end=None
                ),
            ),
            limit_points=(
                LimitPoint(quantity='efficiency', value=0.865, speed=FEED, load=600.0, oil=37.5),
                LimitPoint(quantity='rcs', value=0.01, speed=FEED, load=600.0, oil=56.8),
            ),
        ),
    )


def wrong_oil() -> Scenario:
    """Feed with the oil of the surface, and a day later with ISO VG 100 in its stead."""
    turns = (*_to_and_fro(0.0), *_to_and_fro(8.0))
    right, wrong = friction('iso_vg_68'), friction('iso_vg_100')
    held = LOAD * LEAD / (2 * math.pi)
    torque = [(time, part * (held + (right if time < 8.0 else wrong))) for time, part in turns]
    return Scenario(
        shows='filled with ISO VG 100 in place of 68: the torque residual grows, and no warning',
        duration=16.0,
        speed=moves(*((time, part * FEED) for time, part in turns), ramp=RAMP),
        load=moves(*((time, -part * LOAD) for time, part in turns), ramp=RAMP),
        torque=moves(*torque, ramp=RAMP),
        pauses=Steps(((8.0, DAY),)),
        parameters=TORQUE_PARAMETERS,
        expected=Expected(
            levels=('UNKNOWN', 'OK'),
            all_judged=True,
            limit_points=(TOUCHING,),
            residuals=(
                ResidualChange(since=(1.0, 3.9), time=(9.0, 11.9), change=wrong - right),
                ResidualChange(since=(4.5, 7.4), time=(12.5, 15.4), change=right - wrong),
            ),
        ),
    )


def preload_loss() -> Scenario:
    """
    Lift and lower once a week, with friction that falls as published of a ball screw that aged.

    Over 1015 h the torque fell by 38 % one way and by 27 % the other (XJTU ball-screw degradation
    data); between its ends it is taken as straight.

    """
    weeks = [week * PRELOAD_STRETCH for week in range(PRELOAD_WEEKS + 1)]
    new, held = friction('iso_vg_68'), LOAD * LEAD / (2 * math.pi)
    up, down = (
        [loss * new * w / PRELOAD_WEEKS for w in range(len(weeks))] for loss in PRELOAD_LOSS
    )
    speed, torque, residuals = [], [], []
    for at, less_up, less_down in zip(weeks, up, down):
        speed += [(at + 0.3, FEED), (at + 3.0, -FEED), (at + 5.6, 0.0)]
        torque += [(at + 0.3, held + new - less_up), (at + 3.0, held - new + less_down)]
        torque += [(at + 5.6, held)]
        residuals += [
            ResidualChange(since=(0.5, 2.9), time=(at + 0.5, at + 2.9), change=-less_up),
            ResidualChange(since=(3.2, 5.5), time=(at + 3.2, at + 5.5), change=less_down),
        ]
    return Scenario(
        shows='friction falls by 38 % up and 27 % down in six weeks: seen in the torque residual',
        duration=len(weeks) * PRELOAD_STRETCH,
        speed=moves(*speed, ramp=RAMP),
        load=constant(-LOAD),
        torque=moves(*torque, ramp=RAMP),
        pauses=Steps(tuple((at, number * WEEK) for number, at in enumerate(weeks))),
        parameters=TORQUE_PARAMETERS,
        expected=Expected(
            levels=('UNKNOWN', 'OK'),
            all_judged=True,
            limit_points=(TOUCHING,),
            residuals=tuple(residuals),
        ),
    )


def _to_and_fro(begin: float) -> tuple[tuple[float, float], ...]:
    """Return a feed and its return as parts of FEED, from a `begin` [s], over 7.5 s."""
    return (begin + 0.5, 1.0), (begin + 4.0, -1.0), (begin + 7.5, 0.0)
