# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Baselines: the first logs, those after a service event, or those of an interval that is named.

What is kept are its limits alone. Its logs are picked from the history.

"""

from collections.abc import Iterable, Mapping, Sequence
import dataclasses
import itertools

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.health.bands import FIRST_DAY
from ballscrew_monitor.health.detection import BASELINE_DAYS, FEWEST_LOGS
from ballscrew_monitor.health.records import Baseline, Cell, CellKind, KeptHealth, SpectrumBin
from ballscrew_monitor.health.rows import DAY
from surrogate.files import InputError

LEARNED = 'learned over the first logs'
LEAP = 0.3  # change everywhere [-] from which another screw is suspected


def motion_by_day(bins: Iterable[SpectrumBin]) -> dict[int, float]:
    """Return the time in motion [s] of each day, or first day of a longer period."""
    motion: dict[int, float] = {}
    for part in bins:
        motion[part.first_day] = motion.get(part.first_day, 0.0) + part.time
    return motion


def named(
    cells: Iterable[Cell], begin: int, end: int, *, reason: str, named_at: int, screw: str = ''
) -> Baseline:
    """
    Return the baseline of the logs that begin within `begin` and `end` [ns].

    Raises InputError for an interval that ends before it begins, without a reason, and with fewer
    logs than a baseline needs.

    """
    if not reason.strip():
        raise InputError('the reason of a baseline is empty, it must say what was changed')
    if end <= begin:
        raise InputError(
            f'the baseline ends at {clock_text(end)}, it must end after it begins at '
            f'{clock_text(begin)}'
        )
    motion = {cell.start for cell in cells if cell.kind == CellKind.MOTION}
    count = sum(begin <= start < end for start in motion)
    if count < FEWEST_LOGS:
        raise InputError(
            f'no baseline: {count} logs with steady motion and torque from {clock_text(begin)} to '
            f'{clock_text(end)}, needed are {FEWEST_LOGS}'
        )
    return Baseline(begin=begin, end=end, reason=reason, named_at=named_at, screw=screw)


def since_days(kept: KeptHealth, days: tuple[int, int] | None, screw: str) -> KeptHealth:
    """Return what is kept of an axis with the baseline of some `days`, begin and end [ns]."""
    if days is None:
        return kept
    reason = 'named by its days'
    baseline = named(kept.cells, *days, reason=reason, named_at=days[1], screw=screw)
    return kept._replace(baselines=(baseline,))


def in_force(
    baselines: Sequence[Baseline], motion: Mapping[int, float], days: float = BASELINE_DAYS
) -> Baseline:
    """
    Return the baseline that counts: the last one, with limits.

    One without an end begins after a motion of `left_out` [s], and lasts some `days`; `motion` is
    the time in motion [s] by day since 1970.

    """
    last = baselines[-1] if baselines else Baseline(begin=FIRST_DAY * DAY, end=0, reason=LEARNED)
    if last.end:
        return last
    begin = last.begin
    if last.left_out > 0.0:
        later = sorted(day for day in motion if day >= -(-last.begin // DAY))
        sums = itertools.accumulate(motion[day] for day in later)
        first = sum(total < last.left_out for total in sums) + 1
        if later:
            begin = (later[first] if first < len(later) else later[-1] + 1) * DAY
    return dataclasses.replace(last, begin=begin, end=begin + round(days * DAY))


def changed_screw(baseline: Baseline, screw: str, changes: Sequence[float]) -> str:
    """
    Return in a sentence why the screw may be another one than that of the baseline, or ''.

    `screw` is the datasheet in use, `changes` the friction of each group over that of the
    baseline, less one [-].

    """
    if baseline.screw and screw and screw != baseline.screw:
        return (
            f'the surface is that of screw {screw!r}, the baseline that of {baseline.screw!r}: '
            'name a new baseline'
        )
    if len(changes) < 2 or not (min(changes) > LEAP or max(changes) < -LEAP):
        return ''
    return (
        f'the friction changed by {100 * min(changes):+.0f} to {100 * max(changes):+.0f} % at all '
        f'{len(changes)} places: if the screw was changed, name a new baseline'
    )
