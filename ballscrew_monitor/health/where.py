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
from typing import Any, NamedTuple

from ballscrew_monitor.health.energy import student
from ballscrew_monitor.health.records import Baseline, CellKind, Quantity, TOLERANCE
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.stroke import span_of
import numpy as np
from numpy.typing import NDArray
from surrogate.units import MICRO, MILLI

Array = NDArray[np.float64]
NOW = 4
"""Logs that count as now."""
SURE = 1.9
"""Half width of the 99.9 % interval over that of 95 %."""
FEWEST_STEPS = 3
LEAST_LOST = 2e-6
"""Growth of the lost motion that is worth a note [m]."""
ENCODERS = 0.5e-6
"""Half width of what two encoders and the fit leave of a lost motion of zero [m]."""
YEAR = 365.25
LOST, LOST_CHANGE, LOST_TREND = 'lost motion', 'lost motion change', 'lost motion trend'
NO_BASELINE = 'not known yet: it needs two logs in the baseline, and two after it'


class Where(NamedTuple):
    """Quantities along the stroke and at reversals, and notes on those that have changed."""

    quantities: tuple[Quantity, ...]
    notes: tuple[str, ...]


def where_on_screw(cells: NDArray[Any], baseline: Baseline | None) -> Where:
    """Return where on the screw the last logs differ from those of the baseline, by CELL."""
    stroke, worst = along_stroke(cells[cells['kind'] == CellKind.STROKE], baseline)
    lost, growth = lost_motion(cells[cells['kind'] == CellKind.REVERSAL], baseline)
    return Where((*stroke, *lost), tuple(filter(None, (worst, growth))))


def along_stroke(cells: NDArray[Any], baseline: Baseline | None) -> tuple[Sequence[Quantity], str]:
    """Return the friction ratio of each step of the stroke, and a note on the worst one, or ''."""
    if not len(cells) or baseline is None:
        return (), ''
    level = int(cells['load_band'].max())
    steps = cells['speed_band'] >> (level - cells['load_band'])
    starts, first = np.unique(cells['start']), int(steps.min())
    friction = _by_log(cells, starts, steps - first)
    before, now = _parts(starts, baseline)
    both = np.isfinite(friction[before]).sum(axis=0) >= 2
    both &= np.isfinite(friction[now]).any(axis=0) if now.any() else False
    if both.sum() < FEWEST_STEPS:
        return (), ''
    local = friction[:, both] - np.nanmedian(friction[:, both], axis=1, keepdims=True)
    change, deviation, freedom = _change(local, before, now)
    if freedom < 1:
        return (), ''
    reach = student(freedom) * deviation
    spans = [span_of(first + at, level) for at in np.flatnonzero(both).tolist()]
    quantities = [
        Quantity(
            name=f'friction at {_span_text(span)}',
            value=math.exp(value),
            low=math.exp(value - width),
            high=math.exp(value + width),
            evidence=f'over that of the whole stroke, {before.sum()} logs and {now.sum()} now',
        )
        for span, value, width in zip(spans, change.tolist(), reach.tolist(), strict=True)
    ]
    at = int(np.argmax(np.abs(change) - SURE * reach))
    if abs(change[at]) - SURE * reach[at] < TOLERANCE:
        return quantities, ''
    return quantities, worst_note(spans[at], quantities[at])


def worst_note(span: tuple[float, float], ratio: Quantity) -> str:
    """Return in words where on the stroke [m] the friction has changed, and by what ratio."""
    value, low, high = (100.0 * (one - 1.0) for one in (ratio.value, ratio.low, ratio.high))
    return (
        f'at {_span_text(span)} of the stroke the friction has changed by {value:+.0f} % '
        f'({low:+.0f} to {high:+.0f} %) against the rest of it: look at screw and guideway there'
    )


def lost_motion(cells: NDArray[Any], baseline: Baseline | None) -> tuple[Sequence[Quantity], str]:
    """Return the lost motion now, its change and its trend, and a note on its growth, or ''."""
    if not len(cells):
        return (), ''
    cells = cells[np.argsort(cells['start'], kind='stable')]
    lost, time = cells['backlash'], cells['start'] / DAY
    if len(lost) < 3:
        return [_unknown(LOST, 'um', 'not known yet: it needs three logs')], ''
    spread = _spread(lost)
    now = lost[-NOW:]
    width = math.hypot(spread / math.sqrt(len(now)), ENCODERS)
    rests = f'{int(cells["stretches"].sum())} reversals in {len(lost)} logs'
    apart = time - time.mean()
    slope = float(apart @ lost / (apart @ apart)) * YEAR
    slope_width = spread / math.sqrt(float(apart @ apart)) * YEAR
    quantities = [
        _micrometres(LOST, 'um', float(now.mean()), width, rests),
        _micrometres(LOST_TREND, 'um/year', slope, slope_width, rests),
    ]
    before, after = (
        (None, None) if baseline is None else _parts(cells['start'].astype(np.int64), baseline)
    )
    if before is None or after is None or before.sum() < 2 or after.sum() < 2:
        return [*quantities, _unknown(LOST_CHANGE, 'um', NO_BASELINE)], ''
    change = float(lost[after].mean() - lost[before].mean())
    width = spread * math.sqrt(1.0 / before.sum() + 1.0 / after.sum())
    quantities.insert(1, _micrometres(LOST_CHANGE, 'um', change, width, rests))
    note = lost_note(quantities[0], quantities[1])
    return quantities, note if change - SURE * width > LEAST_LOST else ''


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


def lost_note(lost: Quantity, change: Quantity) -> str:
    """Return in words by how much the lost motion has grown."""
    return (
        f'the lost motion at reversals has grown by {change.value:.3g} um ({change.low:.3g} to '
        f'{change.high:.3g} um) and is {lost.value:.3g} um now: measure the backlash of nut and '
        'support bearings'
    )


def _by_log(cells: NDArray[Any], starts: NDArray[Any], steps: NDArray[Any]) -> Array:
    """Return ln(friction) of logs by steps, NaN where a log has none; cells of a step by time."""
    shape = len(starts), int(steps.max()) + 1
    rows = np.searchsorted(starts, cells['start'])
    total, time = np.zeros(shape), np.zeros(shape)
    np.add.at(total, (rows, steps), cells['duration'] * np.log(cells['motor_torque']))
    np.add.at(time, (rows, steps), cells['duration'])
    return np.where(time > 0.0, total / np.where(time > 0.0, time, 1.0), np.nan)


def _parts(starts: NDArray[np.int64], baseline: Baseline) -> tuple[Any, Any]:
    """Return which logs are of the baseline, and which are the last ones after it."""
    before = (starts >= baseline.begin) & (starts < baseline.end)
    after = np.flatnonzero(starts >= baseline.end)[-NOW:]
    return before, np.isin(np.arange(len(starts)), after)


def _change(local: Array, before: Any, now: Any) -> tuple[Array, Array, int]:
    """Return the change of each step, its standard deviation, and the degrees of freedom."""
    squares, freedom, means, counts = 0.0, 0, [], []
    for part in (before, now):
        rows = local[part]
        count = np.isfinite(rows).sum(axis=0)
        mean = np.nansum(rows, axis=0) / count
        squares += float(np.nansum((rows - mean) ** 2))
        freedom += int(count.sum()) - len(count)
        means.append(mean)
        counts.append(count)
    scatter = math.sqrt(squares / freedom) if freedom else math.nan
    return means[1] - means[0], scatter * np.sqrt(1.0 / counts[0] + 1.0 / counts[1]), freedom


def _span_text(span: tuple[float, float]) -> str:
    return f'{span[0] * MILLI:.0f} to {span[1] * MILLI:.0f} mm'


def _micrometres(name: str, unit: str, value: float, width: float, rests: str) -> Quantity:
    value, low, high = (MICRO * one for one in (value, value - width, value + width))
    return Quantity(name=name, unit=unit, value=value, low=low, high=high, evidence=rests)


def _unknown(name: str, unit: str, reason: str) -> Quantity:
    return Quantity(name=name, unit=unit, reason=reason)
