# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Energy lost to friction, against the baseline at equal motion.

The model says what each day would have lost; measured over expected energy is compared before and
now, so that another programme, load or temperature is no loss. Days are the unit of the scatter.

"""

from collections.abc import Iterable, Sequence
import math

from ballscrew_monitor.health.life import recent
from ballscrew_monitor.health.records import Baseline, Quantity, quantity, SpectrumBin, unknown
from ballscrew_monitor.health.rows import DAY
from surrogate.units import KILOWATT_HOUR, MINUTE

NAN = math.nan
RECENT = 28  # days over which energy is given
FEWEST_DAYS = 3  # days with a measured torque that a comparison needs on each side
FLOOR = 0.01  # least scatter of the ratio between days [-]
LOST, AGAINST = 'energy lost', 'energy against the baseline'
BEYOND = 'energy beyond the baseline'


def energy_quantities(
    bins: Sequence[SpectrumBin], baseline: Baseline | None, today: int
) -> list[Quantity]:
    """
    Return what friction cost over the last 28 days, and how much of it the baseline did not.

    `today` counts days since 1970. The energy lost is that of the model, times what was measured
    over what it expects; the comparison is one at equal motion.

    """
    latest = recent(bins, today, RECENT)
    now, now_half, now_days = ratio_of(latest)
    reason = _ratio_reason(now_half, now_days, f'the last {RECENT} days')
    if not reason and now <= 0.0:
        reason = (
            'not known: the measured torque is less than the load needs, as with a load of '
            'another sign or unit'
        )
    if reason:
        lost = unknown(LOST, 'kWh', reason)
    else:
        modelled = sum(each.energy_lost for each in latest) / KILOWATT_HOUR
        hours = sum(each.time for each in latest) / (60 * MINUTE)
        ratios = now, max(now - now_half, 0.0), now + now_half
        text = f'{hours:.3g} h of motion in {RECENT} days, torque measured on {now_days}'
        lost = quantity(LOST, 'kWh', (modelled * ratio for ratio in ratios), text)
    before, before_half, before_days = ratio_of(within(bins, baseline) if baseline else ())
    reason = 'not known yet: there is no baseline' if baseline is None else reason
    reason = reason or _ratio_reason(before_half, before_days, 'the baseline')
    if not reason and min(before - before_half, now - now_half) <= 0.0:
        reason = 'not known: the measured loss scatters more than it amounts to'
    if reason:
        return [lost, unknown(AGAINST, '-', reason), unknown(BEYOND, 'kWh', reason)]
    ratio = now / before
    half = ratio * math.hypot(now_half / now, before_half / before)
    text = f'{before_days} days of the baseline and {now_days} of now, at equal motion'
    ends = ratio, ratio - half, ratio + half
    beyond = (lost.value * (1 - 1 / max(end, 1e-9)) for end in ends)
    return [lost, quantity(AGAINST, '-', ends, text), quantity(BEYOND, 'kWh', beyond, text)]


def _ratio_reason(half_width: float, days: int, when: str) -> str:
    """Return why a ratio of energies is not known, '' where it is."""
    if days >= FEWEST_DAYS and math.isfinite(half_width):
        return ''
    return (
        f'not known yet: torque and load were measured on {days} days of {when}, needed are '
        f'{FEWEST_DAYS}'
    )


def ratio_of(bins: Iterable[SpectrumBin]) -> tuple[float, float, int]:
    """
    Return measured over expected energy [-], half its 95 % interval, and the number of days.

    A weighted mean of the sums of days by expected energy; Student's factor for their number. The
    half width is infinite for one period, both are NaN for none.

    """
    sums: dict[tuple[int, int], list[float]] = {}
    for each in bins:
        if each.energy_expected > 0.0 and math.isfinite(each.energy_measured):
            day = sums.setdefault((each.first_day, each.days), [0.0, 0.0])
            day[0] += each.energy_measured
            day[1] += each.energy_expected
    if not sums:
        return NAN, NAN, 0
    total = sum(expected for _, expected in sums.values())
    value = sum(measured for measured, _ in sums.values()) / total
    days, count = sum(length for _, length in sums), len(sums)
    if count < 2:
        return value, math.inf, days
    weights = [expected / total for _, expected in sums.values()]
    apart = [measured / expected - value for measured, expected in sums.values()]
    spread = sum(w * a * a for w, a in zip(weights, apart, strict=True)) * count / (count - 1)
    scatter = max(spread, (FLOOR * value) ** 2) * sum(w * w for w in weights)
    return value, student(count - 1) * math.sqrt(scatter), days


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


def within(bins: Iterable[SpectrumBin], baseline: Baseline) -> list[SpectrumBin]:
    """Return the bins whose period lies in the days of a baseline, or meets them."""
    first, last = baseline.begin // DAY, baseline.end // DAY
    return [b for b in bins if b.first_day <= last and first < b.first_day + b.days]
