# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios of motion and load: flapping about the limit, and all four quadrants."""

import math

from courses import constant, moves
from feeding import clears, CREEP, FEED, LATE, later, leaves, LOAD, OIL, RAMP, TOUCHING
from scenario import Expected, ExpectedEvent, LimitPoint, Scenario, Span, Stretch
from surrogate.units import RPM

LEAD = 0.010  # [m]
WEIGHT = 1177.0  # [N] of 120 kg


def flapping() -> Scenario:
    """Dip below the limit speed too shortly for a warning, then longer, too often to clear it."""
    short = _dips(begin=3.0, half=0.3, number=10)
    long = _dips(begin=11.0, half=0.8, number=5)
    speed = moves((0.5, FEED), *short, *long, ramp=0.04)
    first, last = 1 + len(short), len(short + long)
    return Scenario(
        shows='ten dips of 0.3 s raise nothing; five of 0.8 s, 0.8 s apart, are one event',
        duration=22.0,
        speed=speed,
        load=constant(-LOAD),
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK'),
            all_judged=True,
            events=(
                ExpectedEvent(
                    cause='RCS_HIGH', start=leaves(speed, first), end=clears(speed, last)
                ),
            ),
            limit_points=(TOUCHING,),
        ),
    )


def _dips(*, begin: float, half: float, number: int) -> tuple[tuple[float, float], ...]:
    """Return moves to 200 rev/min for `half` [s] and back, a `number` of times."""
    starts = [begin + 2 * half * count for count in range(number)]
    return tuple(move for at in starts for move in ((at, 200.0), (at + half, FEED)))


def vertical_axis() -> Scenario:
    """Lift and lower a weight, and press and retract against a cylinder: four quadrants."""
    speed = moves(
        (0.5, FEED),
        (3.5, -FEED),
        (9.5, FEED),
        (12.5, 0.0),
        (14.0, -CREEP),
        (17.0, FEED),
        ramp=RAMP,
    )
    held = WEIGHT * LEAD / (2 * math.pi)
    more, less = (held + 0.02, held + 0.30), (0.02 - held, 0.30 - held)  # of any sane friction
    limit = 410.0
    # The creeping begins from a stop: outside as soon as the screw is not at standstill.
    start = speed.pass_between(-0.5 / RPM, -0.5 / RPM, 2)
    return Scenario(
        shows='both directions under both signs of the load; creeping down is one event',
        duration=20.0,
        speed=speed,
        load=moves((0.0, -WEIGHT), (6.5, WEIGHT), (12.7, -WEIGHT), ramp=RAMP),
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK'),
            all_judged=True,
            events=(
                ExpectedEvent(
                    cause='RCS_HIGH', start=later(start, 0.0, LATE), end=clears(speed, 4, limit)
                ),
            ),
            stretches=(
                _quadrant('POSITIVE', (0.8, 3.4), more),
                _quadrant('NEGATIVE', (3.8, 6.4), less),
                _quadrant('NEGATIVE', (6.8, 9.4), more),
                _quadrant('POSITIVE', (9.8, 12.4), less),
                Stretch(time=(14.7, 16.9), zone='OUTSIDE', level='WARN', direction='NEGATIVE'),
            ),
            limit_points=(
                LimitPoint(quantity='rcs', value=0.01, speed=limit, load=WEIGHT, oil=OIL),
            ),
        ),
    )


def _quadrant(direction: str, time: Span, torque: Span) -> Stretch:
    return Stretch(time=time, zone='OPTIMAL', direction=direction, torque=torque)
