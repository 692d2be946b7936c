# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What is kept of an axis over restarts: its sums, its last event, and its shelving."""

import dataclasses

from ballscrew_monitor.core.shelving import NOT_SHELVED, Shelving
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals

RESTARTED = 'ended by a restart of the node'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Memory:
    """What outlives the monitor of an axis; an active event carries the last stamp seen of it."""

    totals: Totals = Totals()
    event: Event = Event()
    shelving: Shelving = NOT_SHELVED


def after_restart(kept: Memory, logged: Event) -> Memory:
    """
    Return the memory to go on with: what was `kept`, and what the log says of the last event.

    The log is written at once and the memory later, or not while a disk is full: whichever knows
    more of the event is right. One that both know as active was interrupted, and is over.

    """
    ended = logged.number == kept.event.number and not logged.active
    event = logged if ended or logged.number > kept.event.number else kept.event
    if event.active:
        event = dataclasses.replace(event, active=False, ending=RESTARTED)
    return dataclasses.replace(kept, event=event)


NOTHING = Memory()
