# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
All that a monitor has in mind, for what judges a recording in its place and hands it back.

Of a monitor whose load is an input and whose speed is one: what derives these is not part of it.

"""

import dataclasses

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.input_status import Tracker
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Hold
from ballscrew_monitor.core.monitor import Monitor
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Account, WindowTally


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Remembered:
    """
    What one monitor has in mind.

    `window`, `account` and `inputs` are its own and change with it. `stamp`, of the last verdict,
    `last_tick` and `last_published` in [ns].

    """

    event: Event
    pending: Event | None
    direction: Direction
    judged: int
    hold: Hold
    stamp: int
    last_tick: int
    last_published: int | None
    window: WindowTally
    account: Account
    inputs: dict[Source, Tracker]


def recall(monitor: Monitor) -> Remembered:
    """Return what a monitor has in mind."""
    return Remembered(
        event=monitor._stays.event,
        pending=monitor._stays._pending,
        direction=monitor._reader._direction,
        **{name: getattr(monitor, f'_{name}') for name in OWN},
    )


def remind(monitor: Monitor, remembered: Remembered) -> None:
    """Let a monitor have this in mind from now on."""
    monitor._stays.event = remembered.event
    monitor._stays._pending = remembered.pending
    monitor._reader._direction = remembered.direction
    for name in OWN:
        setattr(monitor, f'_{name}', getattr(remembered, name))


NAMES = tuple(field.name for field in dataclasses.fields(Remembered))
OWN = NAMES[3:]
"""What is an attribute of the monitor itself."""
