# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A warning that is known and shelved for a time, so that nobody is called for it again and again.

Shelving changes what is said of a warning, never the judgement. Time is an argument [ns], the
clock of the node.

"""

import dataclasses
import math

from ballscrew_monitor.core.conversions import nanoseconds, SECOND, seconds
from surrogate.files import InputError

LONGEST = 86400 * SECOND
"""No warning is shelved longer than this [ns], however the clock is set."""
LONGEST_REASON = 500
"""Characters of a reason; a state carries it."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Shelving:
    """Until when [ns] a warning is shelved, and why; `until` 0: it is not."""

    until: int = 0
    reason: str = ''

    def at(self, now: int) -> 'Shelving':
        """Return what of it holds at `now` [ns]: nothing if it is over or ends too far ahead."""
        return self if 0 < self.until - now <= LONGEST else NOT_SHELVED

    def is_over(self, now: int) -> bool:
        """Tell whether it has ended at `now` [ns]; not by a clock that is behind or at zero."""
        return 0 < self.until <= now


NOT_SHELVED = Shelving()


def shelve(now: int, duration: float, reason: str) -> Shelving:
    """
    Return the shelving from `now` [ns] for a `duration` [s], none for a duration of 0.

    Raises InputError for a duration out of range and for a missing reason.

    """
    longest = seconds(LONGEST)
    if not (math.isfinite(duration) and 0.0 <= duration <= longest):
        raise InputError(f'duration is {duration:g} s, allowed is 0 to {longest:g} s')
    if duration == 0.0:
        return NOT_SHELVED
    reason = ' '.join(reason.split())
    if not reason or len(reason) > LONGEST_REASON:
        raise InputError(
            f'reason has {len(reason)} characters, it must say why in 1 to {LONGEST_REASON}'
        )
    if now == 0:
        raise InputError('the clock of the node stands at zero, play /clock first')
    return Shelving(until=now + nanoseconds(duration), reason=reason)
