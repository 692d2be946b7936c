# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Scenarios of inputs that fail: lost, late, early, beyond the surface."""

from courses import constant, Course, moves, Steps
from feeding import (
    CLEAR_DELAY,
    clears,
    CREEP,
    FEED,
    LATE,
    later,
    leaves,
    LOAD,
    OIL,
    RAMP,
    TOUCHING,
)
from recording import AXIAL_LOAD, JOINT_STATES, OIL_TEMPERATURE
from scenario import Expected, ExpectedEvent, PERIOD, Scenario, Span, Stretch

STALE, OIL_STALE = 0.5, 2.5  # [s] timeouts: the default, and that of the oil in the dropout


def sensor_dropout() -> Scenario:
    """Lose each input in turn, inside the zone, during a warning and while it would clear."""
    speed = moves((0.5, FEED), (10.0, CREEP), (24.5, FEED), ramp=RAMP)
    back = 26.0  # the load, lost before the second of clearing is over, comes again
    return Scenario(
        shows='load, speed and oil are lost in turn: not judged, and a warning stays',
        duration=30.0,
        speed=speed,
        load=constant(-LOAD),
        silences=(
            (AXIAL_LOAD, (4.0, 7.0)),
            (JOINT_STATES, (13.0, 17.0)),
            (OIL_TEMPERATURE, (18.5, 22.5)),
            (AXIAL_LOAD, (24.9, back)),
        ),
        parameters={'x.temperature.timeout': OIL_STALE},
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK'),
            events=(
                ExpectedEvent(
                    cause='RCS_HIGH',
                    start=leaves(speed, 1),
                    end=(back + CLEAR_DELAY, back + CLEAR_DELAY + LATE),
                ),
            ),
            stretches=(
                _lost('load', (4.0 + STALE, 6.97), 'OK'),
                Stretch(time=(7.0, 9.9), validity='VALID', zone='OPTIMAL', level='OK'),
                _lost('speed', (13.0 + STALE + 0.1, 16.9), 'WARN'),
                Stretch(time=(17.0, 18.4), validity='VALID', zone='OUTSIDE', level='WARN'),
                _lost('temperature', (18.0 + OIL_STALE + LATE, 22.9), 'WARN'),
                Stretch(time=(23.0, 24.4), validity='VALID', zone='OUTSIDE', level='WARN'),
                _lost('load', (24.9 + STALE, back - 0.03), 'WARN'),
            ),
            limit_points=(TOUCHING,),
        ),
    )


def _lost(source: str, time: Span, level: str) -> Stretch:
    return Stretch(
        time=time,
        zone='UNKNOWN',
        level=level,
        validity='NO_INPUT',
        reason=f'no valid sample of {source}',
    )


def clock_jump() -> Scenario:
    """Set the clock of the source back by 3 s during a warning, and forward again after it."""
    speed, back = moves((0.5, FEED), (5.0, CREEP), (13.0, FEED), ramp=RAMP), -3.0
    return Scenario(
        shows='stamps leap back 3 s in a warning and forward later: one event, as long as it was',
        duration=24.0,
        speed=speed,
        load=constant(-LOAD),
        clock=Steps(((9.0, back), (20.0, 0.0))),
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK'),
            events=(
                ExpectedEvent(
                    cause='RCS_HIGH',
                    # The event moves with the clock, but for the time between two samples.
                    start=later(leaves(speed, 1), back, back + PERIOD),
                    end=later(clears(speed, 2), back, back),
                ),
            ),
            limit_points=(TOUCHING,),
        ),
    )


def clock_behind() -> Scenario:
    """Let the clock of the source lag by 2 s all the time."""
    speed, behind = moves((0.5, FEED), (5.0, CREEP), (9.0, FEED), ramp=RAMP), -2.0
    return Scenario(
        shows='stamps 2 s behind their arrival: all is judged at its stamp, the lag is stated',
        duration=14.0,
        speed=speed,
        load=constant(-LOAD),
        clock=Steps(((0.0, behind),)),
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN', 'OK'),
            all_judged=True,
            lag=-behind,
            events=(
                ExpectedEvent(
                    cause='RCS_HIGH',
                    start=later(leaves(speed, 1), behind, behind),
                    end=later(clears(speed, 2), behind, behind),
                ),
            ),
            limit_points=(TOUCHING,),
        ),
    )


def clock_ahead() -> Scenario:
    """Let the clock of the source run 2 s ahead: its future is not judged."""
    return Scenario(
        shows='stamps 2 s ahead of their arrival: every message is refused, nothing is judged',
        duration=10.0,
        speed=moves((0.5, FEED), (4.0, CREEP), ramp=RAMP),
        load=constant(-LOAD),
        clock=Steps(((0.0, 2.0),)),
        expected=Expected(
            levels=('UNKNOWN',),
            all_refused=True,
            stretches=(
                Stretch(time=(0.5, 9.9), zone='UNKNOWN', level='UNKNOWN', validity='NO_INPUT'),
            ),
        ),
    )


def outside_surface() -> Scenario:
    """Exceed speed, load and oil of the surface in turn, at last in the middle of a warning."""
    speed = moves((0.5, FEED), (4.0, 2300.0), (7.0, FEED), (20.0, CREEP), (26.0, 0.0), ramp=RAMP)
    high = 'outside the surface'
    return Scenario(
        shows='speed, load and oil beyond the surface: not judged, a warning before it stays on',
        duration=28.0,
        speed=speed,
        load=moves((0.5, -LOAD), (10.0, -4500.0), (13.0, -LOAD), (23.0, -4500.0), ramp=RAMP),
        oil=Course(((15.4, OIL), (15.6, 85.0), (17.4, 85.0), (17.6, OIL))),
        expected=Expected(
            levels=('UNKNOWN', 'OK', 'WARN'),
            events=(ExpectedEvent(cause='RCS_HIGH', start=leaves(speed, 1), end=None),),
            stretches=(
                _beyond('SPEED_ABOVE_RANGE', 'above the surface', (4.15, 6.95), 'OK'),
                _beyond('LOAD_OUT_OF_RANGE', high, (10.15, 12.95), 'OK'),
                _beyond('TEMPERATURE_OUT_OF_RANGE', high, (16.02, 17.95), 'OK'),
                Stretch(time=(18.02, 19.9), validity='VALID', zone='OPTIMAL', level='OK'),
                _beyond('LOAD_OUT_OF_RANGE', high, (23.15, 25.95), 'WARN'),
                Stretch(time=(26.2, 27.9), zone='UNKNOWN', level='WARN'),
            ),
            limit_points=(TOUCHING,),
        ),
    )


def _beyond(validity: str, reason: str, time: Span, level: str) -> Stretch:
    return Stretch(time=time, zone='UNKNOWN', level=level, validity=validity, reason=reason)
