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
from typing import NamedTuple

from ballscrew_monitor.health.change import GroupChange, LEAST_GAIN, Marks
from ballscrew_monitor.health.records import Cause, CauseCode, Quantity, quantity
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHARED = 0.02  # standard deviation of a change that all groups share, beside their cause [-]
PATTERN_DOUBT = 0.4  # doubt of a pattern at each group over the size of the change [-]
PRELOAD_TILT = 0.3  # doubt of the loss by less preload: its change with ln(speed), over it [-]
EXCLUDED = 7.0  # chi squared above that of the best cause from which one is excluded
TOO_FAR = 9.0  # chi squared over the number of groups above which no cause fits
FEWEST_GROUPS = 2
LEAST_CARRIED, MOST_CARRIED = 0.5, 2.0
"""Mean change that a cause fits alone over the one that is reported, at least and at most [-]."""
PRELOAD_EXPONENT = 1.2  # of the drag of a nut over its preload, at most
NUT_SHARES = (0.33, 0.66)  # share of the drag that follows the preload, usual range [-]
FREED = 2.83  # axial load over the preload at which one nut is free
LOW_SPEED = 0.7  # exponent with which the friction of a starved film falls over the speed


class Candidate(NamedTuple):
    """A cause: the sign of its size, 0 for both, its pattern, and what is said of it."""

    code: CauseCode
    sign: int
    pattern: Callable[[GroupChange, float], Array]
    text: str
    unseen: str


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


UNSEEN = ', and that is not what is seen'
CANDIDATES = (
    Candidate(
        CauseCode.PRELOAD_LOST,
        -1,
        of_preload,
        'preload is lost ({least:.0f} % of it or more, if the nut is the cause)',
        'less preload lowers the friction at all speeds alike' + UNSEEN,
    ),
    Candidate(
        CauseCode.TORQUE_CONSTANT,
        0,
        alike,
        'the torque constant is another one ({share:+.0f} % of torque)',
        'another torque constant changes all torques by one factor, over the load as well'
        + UNSEEN,
    ),
    Candidate(
        CauseCode.OIL_THINNER,
        -1,
        of_viscosity,
        'the oil is thinner, or warmer than measured: {share:.0f} % of its viscosity',
        'a thinner oil moves the curve of friction over speed' + UNSEEN,
    ),
    Candidate(
        CauseCode.OIL_THICKER,
        1,
        of_viscosity,
        'the oil is thicker, or colder than measured: {share:.0f} % of its viscosity',
        'a thicker oil moves the curve of friction over speed' + UNSEEN,
    ),
    Candidate(
        CauseCode.FILM_STARVED,
        1,
        low_speed,
        'the film is starved: friction at low speed is {share:+.0f} %',
        'a starved film raises the friction at low speed' + UNSEEN,
    ),
    Candidate(
        CauseCode.WIPER,
        0,
        constant,
        'the drag of a wiper, seal, guideway or bearing has changed ({size:+.2g} N m)',
        'a wiper or a guideway has one torque at all speeds' + UNSEEN,
    ),
)
"""All causes of a change of the friction: the one table of them."""
WITH_PLAY = (CauseCode.PRELOAD_LOST, CauseCode.WIPER)
"""Causes that stand where the lost motion has grown as well: the nut, or its support bearing."""
WITHOUT_PLAY = 'the lost motion at reversals has grown as well, as by less preload'
BEARING_DRAG = 'drag of a bearing with play'
"""Name of the size of a constant drag where the lost motion has grown as well."""
BEARING_PLAY = 'the support bearing has play ({size:+.2g} N m of drag)'


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
    scatter = groups.deviation**2 + (PATTERN_DOUBT * np.abs(groups.change)) ** 2
    covariance = SHARED**2 + np.diag(scatter)
    tilt = PRELOAD_TILT * reported * np.log(groups.speed / np.exp(np.log(groups.speed).mean()))
    tilted = covariance + np.outer(tilt, tilt)
    fits = {
        candidate.code: _fit(candidate, groups, tilted if at == 0 else covariance, preload)
        for at, candidate in enumerate(CANDIDATES)  # the first is the preload
    }
    why = {code: _objection(fit, marks, reported, len(scatter)) for code, fit in fits.items()}
    least = min((fit.chi for code, fit in fits.items() if not why[code]), default=math.inf)
    for code, fit in fits.items():
        if not why[code] and fit.chi - least > EXCLUDED:
            why[code] = fit.candidate.unseen
    played = marks.lost_motion and not why[CauseCode.PRELOAD_LOST]
    if played:
        why = {code: text or WITHOUT_PLAY * (code not in WITH_PLAY) for code, text in why.items()}
    weight = {
        code: 0.0 if why[code] else math.exp(-0.5 * (fit.chi - least))
        for code, fit in fits.items()
    }
    total = sum(weight.values()) or 1.0
    causes = []
    for code, fit in fits.items():
        # A cause that stands has the size at which it alone makes the reported change.
        size = _size(fit if why[code] else fit._replace(size=reported / fit.share), groups)
        text = fit.candidate.text
        if played and code is CauseCode.WIPER:
            text, size = BEARING_PLAY, dataclasses.replace(size, name=BEARING_DRAG)
        numbers = {'least': 100.0 * (1.0 - size.high), 'share': 100.0 * size.value}
        causes.append(
            Cause(
                code=code,
                size=size,
                weight=weight[code] / total,
                excluded=bool(why[code]),
                text=why[code] or text.format(size=size.value, **numbers),
            )
        )

    def order(cause: Cause) -> tuple[bool, bool, float]:
        second = played and cause.code is not CauseCode.PRELOAD_LOST
        return cause.excluded, second, -cause.weight

    return sorted(causes, key=order)


def _fit(candidate: Candidate, groups: GroupChange, covariance: Array, preload: float) -> Fit:
    pattern, inverse = candidate.pattern(groups, preload), np.linalg.inv(covariance)
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
    candidate, gain = fit.candidate, marks.gain
    if fit.size == 0.0 or not LEAST_CARRIED <= fit.size * fit.share / reported <= MOST_CARRIED:
        return candidate.unseen
    if fit.chi > TOO_FAR * groups:
        return candidate.unseen
    if math.isfinite(gain.value):
        near = max(0.5 * abs(reported), 2.0 * gain.deviation)
        follows = gain.is_proven(LEAST_GAIN) and abs(gain.value - reported) < near
        of_motor = candidate.code is CauseCode.TORQUE_CONSTANT
        if of_motor and not follows:
            return 'the torque over the measured load has not changed, as with another constant'
        if follows and not of_motor:
            return 'the torque over the measured load has changed as much, as no friction does'
    return ''


def _size(fit: Fit, groups: GroupChange) -> Quantity:
    """Return the size of a cause in its own unit."""
    pattern = fit.candidate.pattern
    ends = fit.size, fit.size - 2.0 * fit.deviation, fit.size + 2.0 * fit.deviation
    if pattern is of_preload:
        return preload_bound(-math.expm1(fit.size))
    if pattern is constant:
        scale = float(groups.friction.mean())
        return quantity('constant drag', 'N m', (scale * math.expm1(end) for end in ends))
    bounded = (min(max(end, -3.0), 3.0) for end in ends)
    if pattern is of_viscosity:
        return quantity('viscosity', '-', map(math.exp, bounded))
    return quantity('friction', '-', map(math.expm1, bounded))


def preload_bound(loss: float) -> Quantity:
    """
    Return the share of the preload that is left [-] if the nut is the cause of a loss of drag [-].

    The drag of a nut follows the preload with an exponent of 1.2 at most. The upper end holds if
    all of the drag is that of the nut, the lower one if a third of it is.

    """
    low, high = (1.0 - loss / PRELOAD_EXPONENT / share for share in (NUT_SHARES[0], 1.0))
    middle = 1.0 - loss / PRELOAD_EXPONENT / NUT_SHARES[1]
    return quantity('preload', '-', (max(middle, 0.0), max(low, 0.0), high))


def likely(causes: Sequence[Cause]) -> list[Cause]:
    """Return the causes that are not excluded."""
    return [cause for cause in causes if not cause.excluded]
