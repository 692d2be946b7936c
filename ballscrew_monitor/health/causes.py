# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Causes of a change that is proven: each has a sign, one size, and a pattern over speed and load.

A pattern is the change of ln(friction) of the whole drag at each group, taken from the curve that
the axis itself had in its baseline. What the data do not tell apart is an answer together.

"""

from collections.abc import Callable, Sequence
import dataclasses
import math
from typing import Any, NamedTuple

from ballscrew_monitor.health.change import GroupChange, LEAST_GAIN, Marks
from ballscrew_monitor.health.records import Cause, CauseCode, Quantity
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHARED = 0.02
"""Standard deviation of a change that all groups have in common, beside their cause [-]."""
PATTERN_DOUBT = 0.4
"""Doubt of a pattern at each group over the size of the change [-]."""
PRELOAD_TILT = 0.3
"""Doubt of the loss by less preload: its change with ln(speed), over the loss [-]."""
EXCLUDED = 7.0
"""Chi squared above that of the best cause from which one is excluded."""
TOO_FAR = 9.0
"""Chi squared over the number of groups above which no cause fits."""
FEWEST_GROUPS = 2
LEAST_CARRIED, MOST_CARRIED = 0.5, 2.0
"""Mean change that a cause fits alone over the one that is reported, at least and at most [-]."""
PRELOAD_EXPONENT = 1.2
"""Exponent of the drag of a nut over its preload, at most."""
NUT_SHARES = (0.33, 0.66)
"""Share of the drag that follows the preload, usual range [-]."""
FREED = 2.83
"""Axial load over the preload at which one nut is free."""
LOW_SPEED = 0.7
"""Exponent with which the friction of a starved film falls over the speed."""


class Candidate(NamedTuple):
    """
    A cause: the sign of its size, 0 for both, its pattern, and what is said of it.

    `with_play` is said of it where the lost motion has grown as well, '' if it has no part in it.

    """

    code: CauseCode
    sign: int
    pattern: Callable[[GroupChange, float], Array]
    text: str
    otherwise: str
    with_play: str = ''


def alike(groups: GroupChange, preload: float) -> Array:
    """Return the pattern of a factor: all friction alike, whatever the preload [N]."""
    return np.ones(len(groups.change))


def of_preload(groups: GroupChange, preload: float) -> Array:
    """Return the pattern of the preload [N]: all speeds alike, less where a load frees a nut."""
    if not math.isfinite(preload) or preload <= 0.0:
        return alike(groups, preload)
    return np.asarray(1.0 - np.clip(np.abs(groups.load) / (FREED * preload), 0.0, 1.0))


def constant(groups: GroupChange, preload: float) -> Array:
    """Return the pattern of a constant drag, whatever the preload [N]."""
    return np.asarray(float(groups.friction.mean()) / groups.friction)


def low_speed(groups: GroupChange, preload: float) -> Array:
    """Return the pattern of a starved film: friction at low speed, at any preload [N]."""
    return np.asarray((groups.speed.min() / groups.speed) ** LOW_SPEED)


def of_viscosity(groups: GroupChange, preload: float) -> Array:
    """Return the pattern of a viscosity, which moves the curve over speed; any preload [N]."""
    speed, friction = np.log(groups.speed), np.log(groups.friction)
    if np.ptp(speed) < 0.7:
        return np.zeros(len(speed))
    bend = np.polyfit(speed, friction, 2 if len(np.unique(speed.round(2))) > 3 else 1)
    return np.asarray(np.polyval(np.polyder(bend), speed))


LESS_PRELOAD = 'preload is lost ({least:.0f} % of it or more, if the nut is the cause)'
CANDIDATES = (
    Candidate(
        CauseCode.PRELOAD_LOST,
        -1,
        of_preload,
        LESS_PRELOAD,
        'less preload lowers the friction at all speeds alike',
        LESS_PRELOAD,
    ),
    Candidate(
        CauseCode.TORQUE_CONSTANT,
        0,
        alike,
        'the torque constant is another one ({share:+.0f} % of torque)',
        'another torque constant changes all torques by one factor, over the load as well',
    ),
    Candidate(
        CauseCode.OIL_THINNER,
        -1,
        of_viscosity,
        'the oil is thinner, or warmer than measured: {share:.0f} % of its viscosity',
        'a thinner oil moves the curve of friction over speed',
    ),
    Candidate(
        CauseCode.OIL_THICKER,
        1,
        of_viscosity,
        'the oil is thicker, or colder than measured: {share:.0f} % of its viscosity',
        'a thicker oil moves the curve of friction over speed',
    ),
    Candidate(
        CauseCode.FILM_STARVED,
        1,
        low_speed,
        'the film is starved: friction at low speed is {share:+.0f} %',
        'a starved film raises the friction at low speed',
    ),
    Candidate(
        CauseCode.WIPER,
        0,
        constant,
        'the drag of a wiper, seal, guideway or bearing has changed ({size:+.2g} N m)',
        'a wiper or a guideway has one torque at all speeds',
        'the support bearing has play ({size:+.2g} N m of drag)',
    ),
)
"""All causes of a change of the friction: the one table of them."""


class Fit(NamedTuple):
    """
    The size of the least chi squared with its standard deviation, and that chi squared.

    `share` is the mean of the pattern, weighed as in the reported change.

    """

    candidate: Candidate
    size: float
    deviation: float
    chi: float
    share: float


def causes_of(groups: GroupChange, marks: Marks, reported: float, preload: float) -> list[Cause]:
    """
    Return the causes of a `reported` proven change of ln(friction) [-], the best first.

    `preload` [N], NaN where no sheet tells it. Empty where the groups are too few for any.

    """
    if len(groups.change) < FEWEST_GROUPS:
        return []
    size = len(groups.change)
    covariance = SHARED**2 + np.diag(
        groups.deviation**2 + (PATTERN_DOUBT * np.abs(groups.change)) ** 2
    )
    tilt = PRELOAD_TILT * reported * np.log(groups.speed / np.exp(np.log(groups.speed).mean()))
    doubts = {CauseCode.PRELOAD_LOST: covariance + np.outer(tilt, tilt)}
    fits = [
        _fit(one, groups, np.asarray(np.linalg.inv(doubts.get(one.code, covariance))), preload)
        for one in CANDIDATES
    ]
    allowed = [_objection(fit, marks, reported, size) for fit in fits]
    least = min(
        (fit.chi for fit, why in zip(fits, allowed, strict=True) if not why), default=math.inf
    )
    reasons = [why or _too_far(fit, least) for fit, why in zip(fits, allowed, strict=True)]
    stand = {fit.candidate.code for fit, why in zip(fits, reasons, strict=True) if not why}
    played = marks.lost_motion and CauseCode.PRELOAD_LOST in stand
    if played:
        reasons = [why or _without_play(fit) for fit, why in zip(fits, reasons, strict=True)]
    causes = [
        _cause(fit if why else _carrying(fit, reported), why, groups, least, played=played)
        for fit, why in zip(fits, reasons, strict=True)
    ]
    total = sum(cause.weight for cause in causes) or 1.0
    causes = [dataclasses.replace(cause, weight=cause.weight / total) for cause in causes]
    return sorted(
        causes,
        key=lambda cause: (
            cause.excluded,
            played and cause.code is not CauseCode.PRELOAD_LOST,
            -cause.weight,
        ),
    )


def _fit(candidate: Candidate, groups: GroupChange, inverse: NDArray[Any], preload: float) -> Fit:
    pattern = candidate.pattern(groups, preload)
    normal = float(pattern @ inverse @ pattern)
    if normal <= 0.0:
        return Fit(candidate, 0.0, math.inf, math.inf, 0.0)
    size = float(pattern @ inverse @ groups.change) / normal
    if candidate.sign and size * candidate.sign < 0.0:
        size = 0.0
    rest = groups.change - size * pattern
    weight = groups.time * groups.friction
    share = float(weight @ pattern / weight.sum())
    return Fit(candidate, size, normal**-0.5, float(rest @ inverse @ rest), share)


def _objection(fit: Fit, marks: Marks, reported: float, groups: int) -> str:
    """Return why a cause is excluded whatever the others are, or ''."""
    candidate = fit.candidate
    if fit.size == 0.0 or not LEAST_CARRIED <= fit.size * fit.share / reported <= MOST_CARRIED:
        return f'{candidate.otherwise}, and that is not what is seen'
    if fit.chi > TOO_FAR * groups:
        return f'{candidate.otherwise}, and that is not what is seen'
    gain = marks.gain
    if math.isfinite(gain.value):
        moved = gain.is_proven(LEAST_GAIN)
        follows = abs(gain.value - reported) < max(0.5 * abs(reported), 2.0 * gain.deviation)
        of_motor = candidate.code is CauseCode.TORQUE_CONSTANT
        if of_motor and not (moved and follows):
            return 'the torque over the measured load has not changed, as with another constant'
        if moved and follows and not of_motor:
            return 'the torque over the measured load has changed as much, as no friction does'
    return ''


def _too_far(fit: Fit, least: float) -> str:
    far = fit.chi - least > EXCLUDED
    return f'{fit.candidate.otherwise}, and that is not what is seen' if far else ''


def _without_play(fit: Fit) -> str:
    seen = 'the lost motion at reversals has grown as well, as by less preload'
    return '' if fit.candidate.with_play else seen


def _carrying(fit: Fit, reported: float) -> Fit:
    """Return a fit with the size at which the cause alone makes the reported change."""
    return fit._replace(size=reported / fit.share)


def _cause(fit: Fit, why: str, groups: GroupChange, least: float, *, played: bool) -> Cause:
    size = _size(fit, groups)
    candidate = fit.candidate
    text = why or (candidate.with_play if played else candidate.text).format(
        least=100.0 * (1.0 - size.high), size=size.value, share=100.0 * size.value
    )
    return Cause(
        code=fit.candidate.code,
        size=size,
        weight=0.0 if why else math.exp(-0.5 * (fit.chi - least)),
        excluded=bool(why),
        text=text,
    )


def _size(fit: Fit, groups: GroupChange) -> Quantity:
    """Return the size of a cause in its own unit."""
    ends = fit.size, fit.size - 2.0 * fit.deviation, fit.size + 2.0 * fit.deviation
    if fit.candidate.code is CauseCode.PRELOAD_LOST:
        return preload_bound(-math.expm1(fit.size))
    if fit.candidate.pattern is constant:
        scale = float(groups.friction.mean())
        value, low, high = (scale * math.expm1(end) for end in ends)
        return Quantity(name='constant drag', unit='N m', value=value, low=low, high=high)
    turn = math.exp if fit.candidate.pattern is of_viscosity else math.expm1
    value, low, high = (turn(min(max(end, -3.0), 3.0)) for end in ends)
    name = 'viscosity' if fit.candidate.pattern is of_viscosity else 'friction'
    return Quantity(name=name, value=value, low=low, high=high)


def preload_bound(loss: float) -> Quantity:
    """
    Return the share of the preload that is left [-] if the nut is the cause of a loss of drag [-].

    The drag of a nut follows the preload with an exponent of 1.2 at most. The upper end holds if
    all of the drag is that of the nut, the lower one if a third of it is.

    """
    low, high = (1.0 - loss / PRELOAD_EXPONENT / share for share in (NUT_SHARES[0], 1.0))
    middle = 1.0 - loss / PRELOAD_EXPONENT / NUT_SHARES[1]
    return Quantity(name='preload', value=max(middle, 0.0), low=max(low, 0.0), high=high)


def likely(causes: Sequence[Cause]) -> list[Cause]:
    """Return the causes that are not excluded."""
    return [cause for cause in causes if not cause.excluded]
