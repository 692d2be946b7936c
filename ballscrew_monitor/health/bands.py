# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Bands of speed, load and severity, and periods of days.

What lies on a limit belongs to the band above it, by amount; a load of just 50 N is zero. The
functions of a load and of a severity keep to the subset that compiles.

"""

import math

from ballscrew_monitor.health.rows import DAY

SPEED_RATIO = 1.2  # upper over lower limit of a speed band [-]; 1 rad/s is the middle of one
NO_LOAD, LOAD_RATIO = 50.0, 1.5
"""Load up to which the band is zero [N], and the width of a band beyond [-]."""
LAST_LOAD = 24  # number of the last load band; it has no upper limit
UNKNOWN_LOAD = 99  # band of motion under a load that is not known
SEVERITIES = (1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9)
"""Limits between classes of severity, [W/m2] or [Pa], see `spectrum`."""
WEEK, MONTH = 7, 28
"""Periods [days]; both begin with day 0, so that each of them lies within one longer one."""
DAYS_KEPT, WEEKS_KEPT = 60, 730
"""Age [days] of the last day of a week from which it is merged, and of a month's."""
FIRST_DAY = 10957  # 1 January 2000 in days since 1970: a clock that says less was not set
_SPEED_STEP, _LOAD_STEP = math.log(SPEED_RATIO), math.log(LOAD_RATIO)


def speed_band(speed: float) -> int:
    """Return the band of an amount of speed [rad/s] above zero."""
    return round(math.log(speed) / _SPEED_STEP)


def load_band(load: float) -> int:
    """Return the band of a load [N], with its sign."""
    amount = abs(load)
    if amount <= NO_LOAD:
        return 0
    band = min(1 + math.floor(math.log(amount / NO_LOAD) / _LOAD_STEP), LAST_LOAD)
    return band if load > 0.0 else -band


def severity_class(severity: float) -> int:
    """Return the class of a severity, see `SEVERITIES`; 0 is the least."""
    count = 0
    for limit in SEVERITIES:
        if severity >= limit:
            count += 1
    return count


def day_of(stamp: int) -> int:
    """Return the day of a stamp [ns], counted since 1970 (UTC)."""
    return stamp // DAY


def period_of(first_day: int, days: int, today: int) -> tuple[int, int]:
    """
    Return first day and length [days] of the period that holds another one `today`.

    A week is one once its last day is old enough, and so is a month: when a period has become a
    longer one, all others within it have.

    """
    for length, kept in ((MONTH, WEEKS_KEPT), (WEEK, DAYS_KEPT)):
        first = first_day - first_day % length
        if days <= length and first + length - 1 < today - kept:
            return first, length
    return first_day, days
