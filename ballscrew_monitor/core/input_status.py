# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Status of an input: what was received, what is wrong with it, and how fresh it is."""

import dataclasses
import enum
import math

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Source, StampSource, Why


class InputState(enum.IntEnum):
    """State of an input; the numbers of InputHealth.STATE_."""

    UNKNOWN = 0
    OK = 1
    STALE = 2
    MISSING = 3
    BAD = 4
    NOT_CONFIGURED = 5
    DERIVED = 6  # from the other inputs


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputStatus:
    """
    State of one input at one instant.

    age since the arrival [s], rate [Hz] and lag [s], by how much the stamps lie behind the arrival
    at least, are NaN while unknown; an input is `lagging` from a stated lag on; a `slow` one is
    stale between its samples, and a timeout of `longest_gap` [s] would do, NaN for any other.
    `lost` messages never arrived, None: not known; `losing` since not long ago.
    `implausible` samples were refused, `glitching` not long ago. `refusal` is why
    the last message was refused, while it is the last; `joints` are what messages about other
    joints have named since the last sample.

    """

    source: Source
    state: InputState
    stamp_source: StampSource
    age: float
    rate: float
    received: int
    dropped: int
    slow: bool = False
    lag: float = math.nan
    lagging: bool = False
    lost: int | None = 0
    losing: bool = False
    implausible: int = 0
    glitching: bool = False
    longest_gap: float = math.nan
    why: Why | None = None
    refusal: str = ''
    joints: OtherJoints | None = None
