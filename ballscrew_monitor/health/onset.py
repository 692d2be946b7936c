# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of contact now, as a speed over that of the baseline, by the upturn of the friction.

Below the onset friction rises towards standstill. Whatever moves the onset, a film starved of oil
or a thinner oil, moves this part of the curve of Stribeck along the speed: an axis with a ratio r
has the friction at speed w that its surface has at w / r. The ratio is that of least chi squared,
beside a constant drag, a factor on all friction and another boundary friction, as in the onset
that `surrogate.identify` fits to a staircase.

"""

from collections.abc import Sequence
import dataclasses
import math

from ballscrew_monitor.health.causes import birge, INTERVAL, PATTERN_DOUBT, vertex
from ballscrew_monitor.health.change import Change, telling
from ballscrew_monitor.health.life import unknown
from ballscrew_monitor.health.model import FILM_EXPONENT, Model
from ballscrew_monitor.health.points import by_place
from ballscrew_monitor.health.records import ComparablePoint, Quantity
from ballscrew_monitor.health.scatter import group_of
import numpy as np
from numpy.typing import NDArray
from surrogate.units import RPM

Array = NDArray[np.float64]
NAME = 'onset of contact'
RATIOS = np.geomspace(1 / 6, 6, 73)
"""Ratios that are tried [-]."""
UPTURN, REACH = 0.5, 3.0
"""Speeds over that of the onset: up to which contact shows in the torque, and places count [-]."""
FEWEST_SLOW, FEWEST = 2, 4
"""Places that are needed up to both."""
BESIDE = 0.3
"""
Standard deviation of a constant drag, of a factor and of the boundary friction that may have
come beside, each over the friction [-].
"""
WIDEST = 3.0
"""Upper over lower end of an interval, above which the ratio is not known [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Low:
    """
    Groups at low speed, as they ran lately.

    `points` have one place each; `mean`, a row for each group, gives the mean over its stretches.
    `at` numbers the groups in the change; `slow` counts those with an upturn, and `onset` [rad/s]
    is the median speed at which contact begins by the surface.

    """

    points: Sequence[ComparablePoint]
    mean: Array
    at: NDArray[np.int64]
    slow: int
    onset: float


def onset_of(
    change: Change | None, lately: Sequence[ComparablePoint], model: Model, reason: str
) -> Quantity:
    """
    Return the speed of the onset over that of the baseline, or why it is not known.

    `lately` are the points that the `change` holds against the baseline. Their own temperatures
    count, for 10 K move the onset by a factor of 2.

    """
    if change is None:
        return unknown(NAME, '-', reason)
    low = low_of(change, lately, model)
    if low is None:
        return unknown(NAME, '-', 'not known: the surface does not reach the motion of these days')
    if low.slow < FEWEST_SLOW or len(low.at) < FEWEST:
        slow, far = (part * low.onset / RPM for part in (UPTURN, REACH))
        return unknown(
            NAME,
            '-',
            f'not known yet: it needs {FEWEST_SLOW} places with a measured torque below '
            f'{slow:.3g} rev/min, where friction turns up, and {FEWEST} below {far:.3g} rev/min',
        )
    return _fitted(change, low, model)


def onset_note(onset: Quantity, tolerance: float, sure: float) -> str:
    """
    Return in a sentence that contact begins faster than in the baseline, or ''.

    Only where the rise lies beyond a `tolerance` [-] by `sure` times the interval.

    """
    if not onset.is_known:
        return ''
    if onset.value * (onset.low / onset.value) ** sure <= 1.0 + tolerance:
        return ''
    return (
        f'contact begins at {onset.value:.2g} times the speed of the baseline ({onset.low:.2g} to '
        f'{onset.high:.2g}): the film is thinner, because oil is missing, thinner or warmer'
    )


def low_of(change: Change, lately: Sequence[ComparablePoint], model: Model) -> Low | None:
    """Return the groups of a change at low speed; None where no point is one of them."""
    number = {group: at for at, group in enumerate(change.groups)}
    alike = [dataclasses.replace(one, first_day=0, days=1, surface='') for one in lately]
    pooled = telling(list(by_place(alike).values()), model)
    points = [one for one in pooled if group_of(one) in number]
    if not points:
        return None
    weights = np.zeros((len(number), len(points)))
    for column, one in enumerate(points):
        weights[number[group_of(one)], column] = one.stretches
    weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1.0)
    onsets = model.onsets(points)
    part = weights @ (np.abs([one.speed for one in points]) / onsets)
    at = np.flatnonzero((part > 0.0) & (part <= REACH))
    kept = np.flatnonzero(weights[at].any(axis=0))
    return Low(
        points=[points[column] for column in kept],
        mean=weights[np.ix_(at, kept)],
        at=at,
        slow=int(np.count_nonzero(part[at] <= UPTURN)),
        onset=float(np.median(onsets)),
    )


def _fitted(change: Change, low: Low, model: Model) -> Quantity:
    """Return the ratio of least chi squared with its 95 % interval."""
    patterns = [low.mean @ model.starved(low.points, r**-FILM_EXPONENT) for r in RATIOS.tolist()]
    apart = change.change[low.at] - patterns
    inverse = np.linalg.inv(_covariance(change, low, model))
    chis = np.einsum('ij,jk,ik->i', apart, inverse, apart)
    tried, chis = RATIOS[np.isfinite(chis)], chis[np.isfinite(chis)]
    value, least = vertex(np.log(tried), chis, int(np.argmin(chis)))
    within = tried[chis <= least + INTERVAL * birge(least, len(low.at))]
    if not tried[0] < within[0] <= within[-1] < min(tried[-1], WIDEST * within[0]):
        return unknown(NAME, '-', _too_wide(change))
    half = math.sqrt(RATIOS[1] / RATIOS[0])
    return Quantity(
        name=NAME,
        value=math.exp(value),
        low=float(within[0]) / half,
        high=float(within[-1]) * half,
        evidence=f'{len(low.at)} places at low speed, {low.slow} of them where friction turns up',
    )


def _covariance(change: Change, low: Low, model: Model) -> Array:
    """Return the covariance of the groups at low speed with what may have come beside [N2 m2]."""
    friction, seen = change.friction[low.at], change.change[low.at]
    drag = np.full_like(friction, friction.mean())
    boundary = low.mean @ model.asperity_share(low.points) * friction.mean()
    beside = BESIDE * np.stack([drag, friction, boundary], axis=1)
    own = np.diag(np.square(PATTERN_DOUBT * seen))
    return np.asarray(change.covariance[np.ix_(low.at, low.at)] + own + beside @ beside.T)


def _too_wide(change: Change) -> str:
    measured = all(one.temperature_measured for one in change.points)
    more = '' if measured else '; measure the oil temperature'
    return f'not known: wiper, warmth and onset look alike at these speeds and loads{more}'
