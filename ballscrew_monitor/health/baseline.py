# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Baselines: learned over the first hours in motion, or named over an interval.

A baseline is made of complete days, those of its points, so that it can be picked from what is
kept. It holds its points itself.

"""

from collections.abc import Iterable, Mapping, Sequence
import itertools
import math

from ballscrew_monitor.core.conversions import clock_text, TIME_UNITS
from ballscrew_monitor.health.bands import FIRST_DAY
from ballscrew_monitor.health.records import (
    Baseline,
    ComparablePoint,
    KeptHealth,
    LoadSource,
    SpectrumBin,
)
from ballscrew_monitor.health.rows import DAY
from surrogate.files import InputError
from surrogate.units import MINUTE

HOUR = TIME_UNITS['h']
LEARNED_OVER, RUNNING_IN = 8.0 * HOUR, 2.0 * HOUR
"""Motion [s] over which a baseline is learned, and that a new screw runs in before."""
LEAST_MOTION, FEWEST_STRETCHES = 10.0 * MINUTE, 20
"""Motion [s] and number of stretches below which there is no baseline."""
LEARNED = 'learned over the first hours in motion'
LEAP, PLACES_OF_LEAP = 0.3, 3
"""Change everywhere [-] and number of places from which another screw is suspected."""

Motion = Mapping[int, float]
"""Time in motion [s] by day since 1970."""


def motion_by_day(bins: Iterable[SpectrumBin]) -> dict[int, float]:
    """Return the time in motion [s] of each day, or first day of a longer period."""
    found: dict[int, float] = {}
    for one in bins:
        found[one.first_day] = found.get(one.first_day, 0.0) + one.time
    return found


def learned(
    points: Sequence[ComparablePoint],
    *,
    motion: Motion | None = None,
    since: int = 0,
    today: int | None = None,
    over: float = LEARNED_OVER,
    left_out: float = 0.0,
    reason: str = LEARNED,
    named_at: int = 0,
    screw: str = '',
) -> Baseline | str:
    """
    Return the baseline of the first days, or in a sentence why it is not known yet.

    It begins with the first complete day after `since` [ns], and after a motion of `left_out` [s];
    it ends with the day on which the motion reaches `over` [s]. `today` is not complete yet. The
    motion is that of the stretches where `motion` does not tell it.

    """
    usable = [point for point in points if _counts(point)]
    spent = _durations(usable) | dict(motion or {})
    last = math.inf if today is None else today
    days = [day for day in sorted(spent) if max(-(-since // DAY), FIRST_DAY) <= day < last]
    sums = list(itertools.accumulate(spent[day] for day in days))
    first = sum(total < left_out for total in sums) + 1 if left_out > 0.0 else 0
    if first >= len(days):
        return f'no baseline yet: no complete day after {left_out / HOUR:.3g} h in motion'
    moved = [total - sums[first] + spent[days[first]] for total in sums[first:]]
    end = first + sum(total < over for total in moved)
    if end >= len(days):
        return (
            f'no baseline yet: {moved[-1] / HOUR:.3g} of {over / HOUR:.3g} h in motion on '
            'complete days'
        )
    why = ''
    for day in days[end:]:  # longer than stated where there are few stretches
        length = max((point.days for point in usable if point.first_day == day), default=1)
        chosen = days[first] * DAY, (day + length) * DAY
        picked = _picked(usable, *chosen)
        why = _too_little(picked, _motion_within(spent, *chosen))
        if not why:
            break
    if why:
        return why
    return Baseline(
        begin=chosen[0],
        end=chosen[1],
        reason=reason,
        named_at=named_at,
        screw=screw,
        points=picked,
    )


def named(
    points: Sequence[ComparablePoint],
    begin: int,
    end: int,
    *,
    reason: str,
    named_at: int,
    motion: Motion | None = None,
    screw: str = '',
) -> Baseline:
    """
    Return the baseline of the days that lie within `begin` and `end` [ns].

    Raises InputError for an interval that ends before it begins, without a reason, and with less
    motion or fewer stretches than a baseline needs.

    """
    if not reason.strip():
        raise InputError('the reason of a baseline is empty, it must say what was changed')
    if end <= begin:
        raise InputError(
            f'the baseline ends at {clock_text(end)}, it must end after it begins at '
            f'{clock_text(begin)}'
        )
    usable = [point for point in points if _counts(point)]
    picked = _picked(usable, begin, end)
    spent = _durations(usable) | dict(motion or {})
    why = _too_little(picked, _motion_within(spent, begin, end))
    if why:
        raise InputError(f'{why}, from {clock_text(begin)} to {clock_text(end)}')
    return Baseline(
        begin=begin, end=end, reason=reason, named_at=named_at, screw=screw, points=picked
    )


def named_or_why(
    points: Sequence[ComparablePoint],
    days: tuple[int, int],
    *,
    motion: Motion | None = None,
    screw: str = '',
) -> Baseline | str:
    """Return the baseline of `days`, begin and end [ns], or in a sentence why there is none."""
    try:
        reason = 'named by its days'
        return named(points, *days, reason=reason, named_at=days[1], motion=motion, screw=screw)
    except InputError as error:
        return str(error)


def in_force(kept: KeptHealth, *, over: float, today: int, screw: str) -> Baseline | str:
    """
    Return the baseline that counts `today`, or in a sentence why it is not known yet.

    It is the last one that is kept; where this is open, or there is none, it is learned.

    """
    last = kept.baseline or Baseline(begin=0, end=0, reason=LEARNED)
    if last.end:
        return last
    return learned(
        kept.points,
        motion=motion_by_day(kept.spectrum),
        since=last.begin,
        today=today,
        over=over,
        left_out=last.left_out,
        reason=last.reason,
        named_at=last.named_at,
        screw=screw,
    )


def changed_screw(baseline: Baseline, screw: str, changes: Sequence[float]) -> str:
    """
    Return in a sentence why the screw may be another one than that of the baseline, or ''.

    `screw` is the datasheet in use, `changes` the friction of each common place over that of the
    baseline, less one [-].

    """
    if baseline.screw and screw and screw != baseline.screw:
        return (
            f'the surface is that of screw {screw!r}, the baseline that of {baseline.screw!r}: '
            'name a new baseline'
        )
    known = [change for change in changes if math.isfinite(change)]
    if len(known) < PLACES_OF_LEAP or not (min(known) > LEAP or max(known) < -LEAP):
        return ''
    return (
        f'the friction changed by {100 * min(known):+.0f} to {100 * max(known):+.0f} % at all '
        f'{len(known)} places: if the screw was changed, name a new baseline'
    )


def _counts(point: ComparablePoint) -> bool:
    """Tell whether a point says something of the friction."""
    return point.load_source is not LoadSource.DERIVED


def _durations(points: Iterable[ComparablePoint]) -> dict[int, float]:
    found: dict[int, float] = {}
    for point in points:
        found[point.first_day] = found.get(point.first_day, 0.0) + point.duration
    return found


def _picked(
    points: Iterable[ComparablePoint], begin: int, end: int
) -> tuple[ComparablePoint, ...]:
    """Return the points of which all days lie within an interval [ns]."""
    return tuple(
        point
        for point in points
        if begin <= point.first_day * DAY and (point.first_day + point.days) * DAY <= end
    )


def _motion_within(motion: Motion, begin: int, end: int) -> float:
    """Return the motion [s] of the days that begin within an interval [ns]."""
    return sum(time for day, time in motion.items() if begin <= day * DAY < end)


def _too_little(points: Sequence[ComparablePoint], motion: float) -> str:
    """Return why points are too few for a baseline, or ''."""
    stretches = sum(point.stretches for point in points)
    if motion >= LEAST_MOTION and stretches >= FEWEST_STRETCHES:
        return ''
    return (
        f'no baseline: {motion / MINUTE:.3g} min in motion and {stretches} steady stretches with '
        f'torque, needed are {LEAST_MOTION / MINUTE:g} min and {FEWEST_STRETCHES}'
    )
