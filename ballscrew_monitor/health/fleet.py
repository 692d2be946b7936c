# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Alarms of a fleet: the share of false ones among the axes that are worse.

An axis is worse by the probability that nothing lasting has come beyond the tolerance, its local
false discovery rate. The mean of such probabilities is the share of false alarms to expect, so
that a fleet of any size keeps the level of one axis, and no axis waits for another.

"""

from collections.abc import Iterable, Sequence

from ballscrew_monitor.health.detection import DOUBT
from ballscrew_monitor.health.records import Condition, Health

SOUND_ALARMS = 0.01
"""Probability that an axis without a change alarms within a year, at most, as measured [-]."""


def fleet_note(courses: Iterable[Sequence[Health]]) -> str:
    """Return what is to be expected of the alarms of several axes, '' for less than two."""
    latest = [course[-1] for course in courses if course]
    worse = sum(health.condition is Condition.WORSE for health in latest)
    if len(latest) < 2:
        return ''
    return (
        f'{len(latest)} axes, {worse} of them worse: in the mean at most {100 * DOUBT:.0f} % of '
        f'such alarms are false, and where no axis changes, at most '
        f'{SOUND_ALARMS * len(latest):.2g} of them come a year'
    )
