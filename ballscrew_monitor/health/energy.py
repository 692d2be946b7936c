# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Energy lost to friction, against the baseline at equal motion.

The model says what each day would have lost; measured over expected energy is compared before and
now, so that another programme, load or temperature is no loss. Days are the unit of the scatter.

"""

from collections.abc import Iterable, Sequence
import dataclasses
import math

from ballscrew_monitor.health.damage import recent
from ballscrew_monitor.health.records import Baseline, Quantity, quantity, SpectrumBin, unknown
from ballscrew_monitor.health.rows import DAY
from surrogate.units import KILOWATT_HOUR, MINUTE

NAN = math.nan
RECENT = 28
"""Days over which energy is told."""
FEWEST_DAYS = 3
"""Days with a measured torque that a comparison needs on each side."""
FLOOR = 0.01
"""Least scatter of the ratio between days [-]."""
LOST, AGAINST = 'energy lost', 'energy against the baseline'
BEYOND = 'energy beyond the baseline'


@dataclasses.dataclass(frozen=True, slots=True)
class Ratio:
    """Measured over expected energy [-], half width of its 95 % interval, and number of days."""

    value: float
    half_width: float
    days: int


def energy_quantities(
    bins: Sequence[SpectrumBin], baseline: Baseline | None, today: int
) -> list[Quantity]:
    """
    Return what friction cost over the last 28 days, and how much of it the baseline did not.

    `today` counts days since 1970.

    """
    latest = recent(bins, today, RECENT)
    now = ratio_of(latest)
    lost = _lost(latest, now)
    return [lost, *_against(bins, baseline, now, lost)]


def ratio_of(bins: Iterable[SpectrumBin]) -> Ratio:
    """
    Return measured over expected energy by the sums of days, with the scatter between them.

    A weighted mean by expected energy; Student's factor for the number of days.

    """
    days: dict[tuple[int, int], list[float]] = {}
    for one in bins:
        if one.energy_expected > 0.0 and math.isfinite(one.energy_measured):
            sums = days.setdefault((one.first_day, one.days), [0.0, 0.0])
            sums[0] += one.energy_measured
            sums[1] += one.energy_expected
    if not days:
        return Ratio(NAN, NAN, 0)
    total = sum(expected for _, expected in days.values())
    value = sum(measured for measured, _ in days.values()) / total
    weights = [expected / total for _, expected in days.values()]
    apart = [measured / expected - value for measured, expected in days.values()]
    return Ratio(value, _half_width(weights, apart, value), sum(count for _, count in days))


def _half_width(weights: Sequence[float], apart: Sequence[float], value: float) -> float:
    """Return the half width of the 95 % interval of a weighted mean, infinite for one period."""
    count = len(weights)
    if count < 2:
        return math.inf
    spread = sum(w * a * a for w, a in zip(weights, apart, strict=True)) * count / (count - 1)
    effective = sum(w * w for w in weights)
    return student(count - 1) * math.sqrt(max(spread, (FLOOR * value) ** 2) * effective)


def student(freedom: int) -> float:
    """
    Return the 97.5 % point of Student's distribution [-], 3 % low for 2 degrees of freedom.

    Expansion in 1 / nu: Abramowitz, Stegun, Handbook (1964), 26.7.5.

    """
    z, nu = 1.959964, float(freedom)
    first = (z**3 + z) / 4
    second = (5 * z**5 + 16 * z**3 + 3 * z) / 96
    third = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
    return z + first / nu + second / nu**2 + third / nu**3


def _lost(bins: Sequence[SpectrumBin], now: Ratio) -> Quantity:
    """Return the energy lost: by the model, times what was measured over what it expects."""
    modelled = sum(one.energy_lost for one in bins) / KILOWATT_HOUR
    hours = sum(one.time for one in bins) / (60 * MINUTE)
    reason = _few_days(now, f'the last {RECENT} days')
    if not reason and now.value <= 0.0:
        reason = (
            'not known: the measured torque is less than the load needs, as with a load of '
            'another sign or unit'
        )
    if reason:
        return unknown(LOST, 'kWh', reason)
    text = f'{hours:.3g} h of motion in {RECENT} days, torque measured on {now.days}'
    low, high = max(now.value - now.half_width, 0.0), now.value + now.half_width
    return quantity(LOST, 'kWh', (modelled * now.value, modelled * low, modelled * high), text)


def _against(
    bins: Sequence[SpectrumBin], baseline: Baseline | None, now: Ratio, lost: Quantity
) -> tuple[Quantity, Quantity]:
    """Return energy over that of the baseline at equal motion, and the part beyond it."""
    before = Ratio(NAN, NAN, 0) if baseline is None else ratio_of(within(bins, baseline))
    reason = 'not known yet: there is no baseline' if baseline is None else ''
    reason = reason or lost.reason or _few_days(before, 'the baseline')
    if not reason and min(before.value - before.half_width, now.value - now.half_width) <= 0.0:
        reason = 'not known: the measured loss scatters more than it amounts to'
    if reason:
        return unknown(AGAINST, '-', reason), unknown(BEYOND, 'kWh', reason)
    ratio = now.value / before.value
    half = ratio * math.hypot(now.half_width / now.value, before.half_width / before.value)
    text = f'{before.days} days of the baseline and {now.days} of now, at equal motion'
    ends = ratio, ratio - half, ratio + half
    beyond = (lost.value * (1 - 1 / max(end, 1e-9)) for end in ends)
    return (quantity(AGAINST, '-', ends, text), quantity(BEYOND, 'kWh', beyond, text))


def within(bins: Iterable[SpectrumBin], baseline: Baseline) -> list[SpectrumBin]:
    """Return the bins whose period lies in the days of a baseline, or meets them."""
    first, last = baseline.begin // DAY, baseline.end // DAY
    return [one for one in bins if one.first_day <= last and first < one.first_day + one.days]


def _few_days(ratio: Ratio, when: str) -> str:
    if ratio.days < FEWEST_DAYS or not math.isfinite(ratio.half_width):
        return (
            f'not known yet: torque and load were measured on {ratio.days} days of {when}, '
            f'needed are {FEWEST_DAYS}'
        )
    return ''
