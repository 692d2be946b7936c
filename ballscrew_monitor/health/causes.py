# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Causes of a change: each has a pattern over speed, load and direction, and one size.

The size is that of the least chi squared over a grid; a cause whose least one lies too far above
that of the best does not fit. Nor does one that does not carry the reported change of the drag.

"""

from collections.abc import Callable, Sequence
import dataclasses
import math
from typing import NamedTuple

from ballscrew_monitor.health.change import Change
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import Cause, CauseCode, ComparablePoint, Quantity, TOLERANCE
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pattern = Callable[[Model, Sequence[ComparablePoint], float], Array]
INTERVAL = 3.84
"""Chi squared above the least one at the ends of a 95 % interval, one degree of freedom."""
EXCLUDED = 9.21
"""Chi squared above that of the best cause from which one does not fit: 99 %, two of freedom."""
FEWEST_GROUPS = 3
"""Groups of places without which no pattern tells causes apart."""
LEAST_CARRIED, MOST_CARRIED = 0.5, 2.0
"""Change that a cause alone predicts over the one that is reported, at least and at most [-]."""
PATTERN_DOUBT = 0.1
"""
What a change may differ from the pattern of its cause by at each place, over the change [-].

Another oil is not quite the same oil at another temperature.

"""
NOT_IDENTIFIED = (
    'the torque constant and the gear ratio are not judged: the surface has no parasitic torque, '
    'which a run without load identifies (ballscrew identify)'
)
STEPS = 41
"""Sizes that are tried of each cause."""
GRIDS, FEWEST_STEPS = 3, 6
"""Most grids, each within the one before, and steps that an interval should have."""


class Candidate(NamedTuple):
    """A cause with the sizes that are tried, and its words: what it is, and why it may not be."""

    code: CauseCode
    name: str
    unit: str
    low: float
    high: float
    pattern: Pattern
    means: str
    otherwise: str


def _opposing(points: Sequence[ComparablePoint], values: Sequence[float]) -> Array:
    """Return torques of the machine frame as torques against the motion [N m]."""
    return np.array([np.sign(one.speed) * value for one, value in zip(points, values)])


def _ideal(model: Model, points: Sequence[ComparablePoint]) -> Array:
    return np.array([model.ideal(one) for one in points])


CANDIDATES = (
    Candidate(
        CauseCode.PRELOAD_LOST,
        'preload',
        '-',
        0.3,
        1.2,
        lambda model, points, size: model.relieved(points, size),
        'the preload is {value:.0%} of what it was ({low:.0%} to {high:.0%})',
        'less preload lowers the friction most at low speed and light load',
    ),
    Candidate(
        CauseCode.OIL_THINNER,
        'oil warmer by',
        'K',
        0.0,
        40.0,
        lambda model, points, size: model.warmer(points, size),
        'the oil is thinner, or the contacts are warmer than measured: as if {value:.0f} K warmer '
        '({low:.0f} to {high:.0f})',
        'a thinner oil changes the friction most where the film carries',
    ),
    Candidate(
        CauseCode.OIL_THICKER,
        'oil colder by',
        'K',
        0.0,
        40.0,
        lambda model, points, size: model.warmer(points, -size),
        'the oil is thicker, or the contacts are colder than measured: as if {value:.0f} K colder '
        '({low:.0f} to {high:.0f})',
        'a thicker oil changes the friction most where the film carries',
    ),
    Candidate(
        CauseCode.FILM_STARVED,
        'film',
        '-',
        0.1,
        1.0,
        lambda model, points, size: model.starved(points, size),
        'the film is {value:.0%} of a flooded one ({low:.0%} to {high:.0%}): oil or grease is '
        'missing',
        'a thin film raises the friction at low speed alone',
    ),
    Candidate(
        CauseCode.WIPER,
        'constant drag',
        'N m',
        -0.5,
        0.5,
        lambda model, points, size: np.full(len(points), size),
        'there is a constant drag of {value:+.3f} N m ({low:+.3f} to {high:+.3f}): wipers, '
        'covers or bearings',
        'a wiper adds one torque at all speeds and loads',
    ),
    Candidate(
        CauseCode.CHURNING,
        'drag per speed',
        'N m s/rad',
        -0.01,
        0.01,
        lambda model, points, size: size * np.abs([one.speed for one in points]),
        'there is a drag in proportion to the speed, {value:+.2g} N m s/rad ({low:+.2g} to '
        '{high:+.2g}): grease or oil is churned',
        'churning grows with the speed and vanishes at rest',
    ),
    Candidate(
        CauseCode.LOAD_SIGN_OR_UNIT,
        'load factor',
        '-',
        -2.5,
        2.5,
        lambda model, points, size: size * _ideal(model, points),
        'the residual follows the load ({value:+.2f} of it, {low:+.2f} to {high:+.2f}): its sign, '
        'unit or zero is wrong',
        'a wrong load gives a residual in proportion to the load',
    ),
    Candidate(
        CauseCode.TORQUE_CONSTANT,
        'torque factor',
        '-',
        -0.6,
        0.6,
        lambda model, points, size: size * _opposing(points, [one.motor_torque for one in points]),
        'the residual follows the torque ({value:+.0%}, {low:+.0%} to {high:+.0%}): the torque '
        'constant or the gear ratio is wrong',
        'another torque constant changes all torques by one factor, that of the load as well',
    ),
    Candidate(
        CauseCode.SENSOR_OFFSET,
        'torque offset',
        'N m',
        -1.0,
        1.0,
        lambda model, points, size: _opposing(points, [size] * len(points)),
        'the torque has an offset of {value:+.3f} N m ({low:+.3f} to {high:+.3f}) in both '
        'directions',
        'an offset of the sensor helps one direction and hinders the other',
    ),
)
"""All causes: the one table of them. Both oil causes also stand for another warmth."""


@dataclasses.dataclass(frozen=True, slots=True)
class Fit:
    """The size of the least chi squared, its 95 % interval, and that chi squared."""

    candidate: Candidate
    size: float
    low: float
    high: float
    chi: float

    @property
    def text(self) -> str:
        """Return what the cause would be, with its size."""
        return self.candidate.means.format(value=self.size, low=self.low, high=self.high)


def fits_of(change: Change, model: Model) -> list[Fit]:
    """Return the fit of every cause that has a pattern here, the best first."""
    doubt = np.diag(np.square(PATTERN_DOUBT * change.change))
    inverse: Array = np.linalg.inv(change.covariance + doubt).astype(float)
    found = [_fit(one, change, model, inverse) for one in CANDIDATES]
    return sorted((one for one in found if one is not None), key=lambda one: one.chi)


def causes_of(change: Change, fits: Sequence[Fit]) -> list[Cause]:
    """Return all causes with their weights, the best first; those that do not fit are excluded."""
    if len(change.groups) < FEWEST_GROUPS or not fits:
        return []
    best, scale = fits[0].chi, birge(fits[0].chi, len(change.groups))
    likely = [math.exp(-0.5 * (one.chi - best) / scale) for one in fits]
    return [
        _cause(fit, weight / sum(likely), (fit.chi - best) / scale > EXCLUDED, fits[0])
        for fit, weight in zip(fits, likely)
    ]


def carrying(
    causes: Sequence[Cause], fits: Sequence[Fit], change: Change, model: Model
) -> list[Cause]:
    """
    Return causes of which those that do not carry a reported change are excluded, and last.

    `fits` are theirs, in the same order. So is the torque constant beside a drag that was never
    identified: it is not told from the part of the drag that the surface lacks.

    """
    told, is_identified = [], model.is_identified
    for cause, fit in zip(causes, fits):
        pattern = fit.candidate.pattern(model, change.points, fit.size)
        alone = float(pattern.sum() / change.friction.sum())
        if not cause.excluded and not carries(alone, change.common):
            text = (
                f'{cause.text}, which alone changes the drag by {100.0 * alone:+.0f} %, not by '
                f'{100.0 * change.common:+.0f} %'
            )
            cause = dataclasses.replace(cause, excluded=True, text=text)
        elif cause.code is CauseCode.TORQUE_CONSTANT and not (cause.excluded or is_identified):
            cause = dataclasses.replace(cause, excluded=True, text=NOT_IDENTIFIED)
        told.append(cause)
    return sorted(told, key=lambda one: one.excluded)


def carries(alone: float, reported: float) -> bool:
    """
    Return True if a cause carries the reported change of the mean friction.

    `alone` [-] is the change of the mean friction that the cause alone predicts. It must have the
    sign of the `reported` change [-] and lie between half of it and twice it, or both must lie
    within 3 %, which counts as normal.

    """
    if max(abs(alone), abs(reported)) <= TOLERANCE:
        return True
    part = alone / reported if reported else math.nan
    return LEAST_CARRIED <= part <= MOST_CARRIED


def birge(chi: float, groups: int) -> float:
    """Return by how much the scatter is larger than stated [-], at least 1 (Birge 1932)."""
    return max(1.0, chi / max(groups - 1, 1))


def _fit(candidate: Candidate, change: Change, model: Model, inverse: Array) -> Fit | None:
    """Return the fit of a cause, its grid drawn closer until the interval has several steps."""
    low, high = candidate.low, candidate.high
    for _ in range(GRIDS):
        sizes: Array = np.linspace(low, high, STEPS)
        chis = np.array([_chi(candidate, change, model, inverse, size) for size in sizes])
        if not np.isfinite(chis).any():
            return None
        place = int(np.nanargmin(chis))
        size, chi = vertex(sizes, chis, place)
        limit = chi + INTERVAL * birge(chi, len(change.groups))
        ends = [_crossing(sizes, chis, place, limit, step) for step in (-1, 1)]
        step = float(sizes[1] - sizes[0])
        if ends[1] - ends[0] > FEWEST_STEPS * step:
            break
        low, high = max(size - 2.0 * step, candidate.low), min(size + 2.0 * step, candidate.high)
    return Fit(candidate, size, ends[0], ends[1], chi)


def _chi(candidate: Candidate, change: Change, model: Model, inverse: Array, size: float) -> float:
    apart = change.change - candidate.pattern(model, change.points, size)
    return float(apart @ inverse @ apart)


def vertex(sizes: Array, chis: Array, place: int) -> tuple[float, float]:
    """Return size and chi squared at the vertex of the parabola about the least one."""
    if not 0 < place < len(sizes) - 1 or not np.isfinite(chis[[place - 1, place + 1]]).all():
        return float(sizes[place]), float(chis[place])
    left, middle, right = chis[place - 1], chis[place], chis[place + 1]
    bend = left - 2.0 * middle + right
    if bend <= 0.0:
        return float(sizes[place]), float(middle)
    shift = 0.5 * (left - right) / bend
    step = sizes[1] - sizes[0]
    return float(sizes[place] + shift * step), float(middle - 0.125 * (left - right) ** 2 / bend)


def _crossing(sizes: Array, chis: Array, place: int, limit: float, step: int) -> float:
    """Return where chi squared passes a limit, seen from the least one; the last size if never."""
    at = place
    while 0 <= at + step < len(sizes) and np.isfinite(chis[at + step]):
        if chis[at + step] > limit:
            rise = chis[at + step] - chis[at]
            part = (limit - chis[at]) / rise if rise > 0.0 else 0.0
            return float(sizes[at] + min(max(part, 0.0), 1.0) * (sizes[at + step] - sizes[at]))
        at += step
    return float(sizes[at])


def _cause(fit: Fit, weight: float, excluded: bool, best: Fit) -> Cause:
    candidate = fit.candidate
    size = Quantity(
        name=candidate.name, unit=candidate.unit, value=fit.size, low=fit.low, high=fit.high
    )
    text = f'{candidate.otherwise}, and that is not what is seen' if excluded else fit.text
    return Cause(code=candidate.code, size=size, weight=weight, excluded=excluded, text=text)
