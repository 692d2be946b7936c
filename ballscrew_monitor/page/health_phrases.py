# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Verdict and advice of health as phrases, out of the numbers and codes of its message."""

import functools
import math
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.health.records import CauseCode, Condition
from ballscrew_monitor.health.words import ADVICE, cause_name, explained
from ballscrew_monitor.messages.health_messages import stamp_of
from ballscrew_monitor.page.phrases import free, Phrase, phrase, Said
from ballscrew_msgs.msg import AxisHealth, HealthCause, HealthQuantity

DRAG, PRELOAD = 'drag change', 'preload'
DATE = len('2025-07-14')
VERDICTS = {
    AxisHealth.CONDITION_UNKNOWN: 'verdict_unsure',
    AxisHealth.CONDITION_NORMAL: 'verdict_normal',
    AxisHealth.CONDITION_WORSE: 'verdict_worse',
    int(Condition.SLIGHTLY_CHANGED): 'verdict_slight',
}
DATED = {
    AxisHealth.CONDITION_WORSE: 'verdict_worse_since',
    int(Condition.SLIGHTLY_CHANGED): 'verdict_slight_since',
}
CHANGED = tuple(DATED)
Known = dict[str, HealthQuantity]
"""Quantities with an interval, by their names."""


def verdict_phrase(health: AxisHealth) -> Said:
    """Return the condition of an axis, the size of its change and its cause."""
    named = {quantity.name: quantity for quantity in health.quantities}
    if DRAG not in named or health.condition not in VERDICTS:
        return free(health.verdict) if health.verdict else ''
    known = {
        name: quantity
        for name, quantity in named.items()
        if math.isfinite(quantity.high - quantity.low)
    }
    if DRAG not in known:
        return phrase('verdict_unknown', axis=health.axis, why=free(named[DRAG].reason))
    values = {'axis': health.axis, **_interval(known[DRAG])}
    if health.condition in CHANGED:
        values['why'] = _why(health, known)
        if since := stamp_of(health.since):
            day = clock_text(since)[:DATE]  # UTC
            return phrase(DATED[health.condition], **values, since=day)
    return phrase(VERDICTS[health.condition], **values)


def advice_phrase(health: AxisHealth) -> Said:
    """Return what to do about the likely causes; an advice on oil or feed is free."""
    _, likely = explained(health.causes)
    names = [cause_name(cause) for cause in likely]
    if health.condition not in CHANGED or not names or '' in names:
        return free(health.advice) if health.advice else ''
    # Two causes may have one remedy, which is said once.
    remedies = {ADVICE[name]: phrase(f'remedy_{name}') for name in names}
    return functools.reduce(
        lambda first, second: phrase('either_or', first=first, second=second), remedies.values()
    )


def _why(health: AxisHealth, known: Known) -> Phrase:
    certainty, likely = explained(health.causes)
    why = f'why_{certainty.name.lower()}'
    if not likely:
        return phrase(why)
    causes = [_cause(cause, known) for cause in likely]
    together = functools.reduce(
        lambda first, second: phrase('cause_or', first=first, second=second), causes
    )
    return phrase(why, cause=together)


def _cause(cause: HealthCause, known: Known) -> Phrase:
    name = cause_name(cause)
    if not name:  # of another version
        return free(cause.text)
    lost = cause.code == CauseCode.PRELOAD_LOST
    size = known.get(PRELOAD, cause.size) if lost else cause.size
    return phrase(f'change_{name}', **_interval(size))


def _interval(quantity: HealthQuantity) -> dict[str, Any]:
    ends = ('value', 'low', 'high')
    return {name: {'value': getattr(quantity, name), 'unit': quantity.unit} for name in ends}
