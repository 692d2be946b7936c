# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Places of a screw that have changed: friction along the stroke, lost motion and its trend.

The friction of a step counts over that of the whole stroke in the same log, so that temperature,
wander and torque constant cancel. The scatter is that of logs about their means, common to all
steps; that of the lost motion follows from successive logs, which a trend does not widen.

"""

from collections.abc import Sequence
import math
from typing import Any

from ballscrew_monitor.health.detection import NOW
from ballscrew_monitor.health.energy import student
from ballscrew_monitor.health.mixed import YEAR
from ballscrew_monitor.health.records import (
    Baseline,
    CellKind,
    Quantity,
    quantity,
    TOLERANCE,
    unknown,
)
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.stroke import span_of
import numpy as np
from numpy.typing import NDArray
from surrogate.units import MICRO, MILLI

Array = NDArray[np.float64]
SURE = 1.9  # half width of the 99.9 % interval over that of 95 %
FEWEST_STEPS = 3
LEAST_LOST = 2e-6  # growth of the lost motion that is worth a note [m]
ENCODERS = 0.5e-6  # half width of what encoders and fit leave of a lost motion of zero [m]
LOST, LOST_CHANGE, LOST_TREND = 'lost motion', 'lost motion change', 'lost motion trend'
NO_BASELINE = 'not known yet: it needs two logs in the baseline, and two after it'


def where_on_screw(
    cells: NDArray[Any], baseline: Baseline | None
) -> tuple[list[Quantity], list[str]]:
    """
    Return quantities along the stroke and at reversals, and notes on those that have changed.

    `cells` (an array of CELL) of the last logs are held against those of the baseline.

    """
    stroke, worst = along_stroke(cells[cells['kind'] == CellKind.STROKE], baseline)
    lost, growth = lost_motion(cells[cells['kind'] == CellKind.REVERSAL], baseline)
    return [*stroke, *lost], list(filter(None, (worst, growth)))


def along_stroke(cells: NDArray[Any], baseline: Baseline | None) -> tuple[Sequence[Quantity], str]:
    """Return the friction ratio of each step of the stroke, and a note on the worst one, or ''."""
    if not len(cells) or baseline is None:
        return (), ''
    level = int(cells['load_band'].max())
    steps = cells['speed_band'] >> (level - cells['load_band'])
    starts, first = np.unique(cells['start']), int(steps.min())
    shape = len(starts), int(steps.max()) - first + 1
    places = np.searchsorted(starts, cells['start']), steps - first
    total, time = np.zeros(shape), np.zeros(shape)
    np.add.at(total, places, cells['duration'] * np.log(cells['motor_torque']))
    np.add.at(time, places, cells['duration'])
    friction = np.where(time > 0.0, total / np.where(time > 0.0, time, 1.0), np.nan)
    before, now = _parts(starts, baseline)
    both = np.isfinite(friction[before]).sum(axis=0) >= 2
    both &= np.isfinite(friction[now]).any(axis=0) if now.any() else False
    if both.sum() < FEWEST_STEPS:
        return (), ''
    local = friction[:, both] - np.nanmedian(friction[:, both], axis=1, keepdims=True)
    squares, freedom, means, doubt = 0.0, 0, [], 0.0
    for part in (local[before], local[now]):
        count = np.isfinite(part).sum(axis=0)
        means.append(np.nansum(part, axis=0) / count)
        squares += float(np.nansum((part - means[-1]) ** 2))
        freedom += int(count.sum()) - len(count)
        doubt = doubt + 1.0 / count
    if freedom < 1:
        return (), ''
    change = means[1] - means[0]
    reach = student(freedom) * (math.sqrt(squares / freedom) * np.sqrt(doubt))
    spans = [
        '{:.0f} to {:.0f} mm'.format(*(MILLI * end for end in span_of(first + at, level)))
        for at in np.flatnonzero(both).tolist()
    ]
    quantities = [
        quantity(
            f'friction at {span}',
            '-',
            map(math.exp, (value, value - width, value + width)),
            f'over that of the whole stroke, {before.sum()} logs and {now.sum()} now',
        )
        for span, value, width in zip(spans, change.tolist(), reach.tolist(), strict=True)
    ]
    at = int(np.argmax(np.abs(change) - SURE * reach))
    if abs(change[at]) - SURE * reach[at] < TOLERANCE:
        return quantities, ''
    worst = quantities[at]
    value, low, high = (100.0 * (end - 1.0) for end in (worst.value, worst.low, worst.high))
    return quantities, (
        f'at {spans[at]} of the stroke the friction has changed by {value:+.0f} % '
        f'({low:+.0f} to {high:+.0f} %) against the rest of it: look at screw and guideway there'
    )


def lost_motion(cells: NDArray[Any], baseline: Baseline | None) -> tuple[Sequence[Quantity], str]:
    """Return the lost motion now, its change and its trend, and a note on its growth, or ''."""
    if not len(cells):
        return (), ''
    cells = cells[np.argsort(cells['start'], kind='stable')]
    lost, time = cells['backlash'], cells['start'] / DAY
    if len(lost) < 3:
        return [unknown(LOST, 'um', 'not known yet: it needs three logs')], ''
    spread, now, apart = _spread(lost), lost[-NOW:], time - time.mean()
    rests = f'{int(cells["stretches"].sum())} reversals in {len(lost)} logs'

    def measured(name: str, unit: str, value: float, width: float) -> Quantity:
        ends = (value, value - width, value + width)
        return quantity(name, unit, (MICRO * end for end in ends), rests)

    width = math.hypot(spread / math.sqrt(len(now)), ENCODERS)
    mean = measured(LOST, 'um', float(now.mean()), width)
    slope = float(apart @ lost / (apart @ apart)) * YEAR
    width = spread / math.sqrt(float(apart @ apart)) * YEAR
    trend = measured(LOST_TREND, 'um/year', slope, width)
    parts = () if baseline is None else _parts(cells['start'].astype(np.int64), baseline)
    counts = [int(part.sum()) for part in parts]
    if min(counts, default=0) < 2:
        return [mean, trend, unknown(LOST_CHANGE, 'um', NO_BASELINE)], ''
    before, after = (float(lost[part].mean()) for part in parts)
    width = spread * math.sqrt(1.0 / counts[0] + 1.0 / counts[1])
    change = after - before
    grown = measured(LOST_CHANGE, 'um', change, width)
    if change - SURE * width <= LEAST_LOST:
        return [mean, grown, trend], ''
    return [mean, grown, trend], (
        f'the lost motion at reversals has grown by {grown.value:.3g} um ({grown.low:.3g} to '
        f'{grown.high:.3g} um) and is {mean.value:.3g} um now: measure the backlash of '
        'nut and support bearings'
    )


def lost_motion_grew(cells: NDArray[Any], since: int, until: int) -> bool:
    """
    Return True if lost motion has grown beyond doubt at or after a date, by cells of REVERSAL.

    The last logs up to `until` [ns] are held against the last ones before `since` [ns], at least
    two each, so that play which was there before does not count.

    """
    cells = np.sort(cells[cells['start'] <= until], order='start')
    lost = cells['backlash']
    before, after = lost[cells['start'] < since][-NOW:], lost[cells['start'] >= since][-NOW:]
    if min(len(before), len(after)) < 2:
        return False
    width = _spread(lost) * math.sqrt(1.0 / len(before) + 1.0 / len(after))
    return float(after.mean() - before.mean()) > math.hypot(width, ENCODERS)


def _spread(lost: Array) -> float:
    """Return the half width that one log has by its scatter, from successive logs [m]."""
    freedom = len(lost) - 1
    return student(freedom) * math.sqrt(float(np.sum(np.diff(lost) ** 2)) / (2.0 * freedom))


def _parts(starts: NDArray[np.int64], baseline: Baseline) -> tuple[Any, Any]:
    """Return which logs are of the baseline, and which are the last ones after it."""
    before = (starts >= baseline.begin) & (starts < baseline.end)
    after = np.flatnonzero(starts >= baseline.end)[-NOW:]
    return before, np.isin(np.arange(len(starts)), after)
