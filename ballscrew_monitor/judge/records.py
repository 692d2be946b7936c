# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The declarations of the judgement: settings, event, memory and row, numbers alone.

Each is a record of `surrogate.surface.records`: an object where one sample is judged, an element
of an array where many are. Codes are the numbers of the enumerations in `core`. Lists have one
number for each input, in the order of `Source`, unless their comment says otherwise.

"""

import dataclasses
import math

from ballscrew_monitor.core.inputs import Source, Why
import numpy as np
from surrogate.surface import Found
from surrogate.surface.records import dtype_of, many, small

NAN = math.nan
INPUTS = len(Source)
WHYS = len(Why)
RATE_SAMPLES = 20
"""Samples over which rate and lag of an input are taken."""
SHOWN = 10_000_000_000
"""Time for which a loss or a refusal is shown, and over which the share of these is taken [ns]."""
COLUMNS = 5
"""Quantities of a window: speed, axial load, efficiency, RCS, film ratio."""
EVENTS_VERSION = 2
"""Version of the events in files, and of the message that holds them."""
MEMORY_VERSION = 3
"""Version of a memory in files: `Memory`, `SlopeRing` and what `snapshot` adds to them."""
MEMORY_LAYOUT = 'f9431ac77409a642'
"""SHA-256 of names and types of their fields; another one is another version."""

SAMPLE, REFUSAL, TICK, STEP, RUN = 0, 1, 2, 3, 4
"""Kinds of an event."""
NOT_KNOWN = -1
"""
Number of lost messages that is not known, the why of an input without a refusal, and the note of
an event without one.

"""
ALL_AXES = 255
"""Axis of a tick and of a step of the clock, which are of every axis."""


@dataclasses.dataclass(slots=True)
class Settings:
    """
    The limits and parameters of a judgement.

    rcs, efficiency, hysteresis and largest_share [-], light_load [N], standstill_speed [rad/s],
    default_temperature [K], wrap [rad], inertia [kg m2], torque_uncertainty [N m]; times [ns].
    `plausible` is the largest amount [SI] of a sample. `derives` tells that the load follows
    from the motor torque, `positions` that samples of the speed are positions.

    """

    rcs: float = NAN
    efficiency: float = NAN
    light_load: float = NAN
    standstill_speed: float = NAN
    raise_delay: int = 0
    clear_delay: int = 0
    hysteresis: float = 0.0
    default_temperature: float = NAN
    publish_period: int = 0
    max_future: int = 0
    max_lag: int = 0
    tick_period: int = 0
    configured: list[int] = many(INPUTS, 0)
    timeout: list[int] = many(INPUTS, 0)
    plausible: list[float] = many(INPUTS, math.inf)
    derives: bool = False
    inertia: float = 0.0
    acceleration_window: int = 0
    torque_uncertainty: float = 0.0
    parts_uncertainty: float = 0.0
    largest_share: float = 0.0
    positions: bool = False
    position_window: int = 0
    wrap: float = 0.0


@dataclasses.dataclass(slots=True)
class Event:
    """
    A sample, a refused message, a tick, a step of the clock of the node, or another run of a log.

    `value` [SI, machine frame]; stamp and arrival [ns], of a tick its grid stamp, of a refusal its
    arrival, of a run a stamp in the pause before it; `steady` [ns] is when the node took it, 0
    where no node did. Of a step, `stamp` is the time that the clock would show if it had run on as
    steadily as before, and `arrival` the one that it shows. `stamp_source` is a StampSource;
    `lost` messages were sent just before and never arrived. A refusal has a `why` and up to two
    numbers for its sentence. In a recording, `axis` is the number of the axis, `log_time` [ns] and
    `place` tell where the message lies, and `note` is the number of the joints that the message
    names.

    """

    kind: int = small(np.uint8, SAMPLE)
    source: int = small(np.uint8)
    why: int = small(np.uint8)
    stamp_source: int = small(np.uint8)
    axis: int = small(np.uint8)
    note: int = small(np.int16, NOT_KNOWN)
    stamp: int = 0
    arrival: int = 0
    steady: int = 0
    lost: int = 0
    value: float = NAN
    first: float = NAN
    second: float = NAN
    log_time: int = 0
    place: int = 0


EVENT = dtype_of(Event)
"""Type of an array of events."""


@dataclasses.dataclass(slots=True)
class Memory:
    """All that is remembered of one axis but slopes; stamps and times [ns], the rest SI."""

    # inputs: counts
    received: list[int] = many(INPUTS, 0)
    dropped: list[int] = many(INPUTS, 0)
    refused: list[int] = many(INPUTS * WHYS, 0)  # by input, then by why
    refused_last: list[int] = many(INPUTS * WHYS, -SHOWN)
    lost: list[int] = many(INPUTS, 0)
    lost_known: list[int] = many(INPUTS, 1)
    lost_last: list[int] = many(INPUTS, -SHOWN)
    # inputs: samples and refusals of the span of SHOWN that has begun, and of the one before
    span_begin: list[int] = many(INPUTS, 0)
    span_taken: list[int] = many(INPUTS, 0)
    span_refused: list[int] = many(INPUTS, 0)
    before_taken: list[int] = many(INPUTS, 0)
    before_refused: list[int] = many(INPUTS, 0)
    # inputs: the refusal of the last message, if it was refused
    refusal: list[int] = many(INPUTS, NOT_KNOWN)
    refusal_first: list[float] = many(INPUTS, NAN)
    refusal_second: list[float] = many(INPUTS, NAN)
    # inputs: the last good sample
    known: list[int] = many(INPUTS, 0)
    value: list[float] = many(INPUTS, NAN)
    sample_stamp: list[int] = many(INPUTS, 0)
    arrival: list[int] = many(INPUTS, 0)
    stamp_source: list[int] = many(INPUTS, 0)
    # inputs: rings of the last stamps and lags
    stamps: list[int] = many(INPUTS * RATE_SAMPLES, 0)
    stamps_taken: list[int] = many(INPUTS, 0)
    lags: list[int] = many(INPUTS * RATE_SAMPLES, 0)
    lags_taken: list[int] = many(INPUTS, 0)
    long_gaps: list[int] = many(INPUTS, 0)  # in a row
    longest_gap: list[int] = many(INPUTS, 0)  # of those
    last_gap: list[int] = many(INPUTS, 0)
    others: list[int] = many(INPUTS, 0)  # messages about other joints since the last sample
    # operating point
    direction: int = 0
    held_load: float = NAN
    light: bool = False  # the light-load gate is shut
    # held level and the runs of samples that may change it
    level: int = 0
    level_since: int = 0
    raising: bool = False
    raising_start: int = 0
    raising_last: int = 0
    clearing: bool = False
    clearing_start: int = 0
    clearing_last: int = 0
    stamp: int = 0  # of the last row
    last_tick: int = 0
    clock_step: int = 0  # of the node's clock, since the last speed sample
    published: bool = False  # a state, on this time line
    last_published: int = 0
    judged: int = 0
    # excursions: the one that is active or was the last, and the one that may be raised
    event_number: int = 0
    event_active: bool = False
    event_stamp: int = 0
    pending: bool = False
    event_start: list[int] = many(2, 0)
    event_code: list[int] = many(2, 0)
    event_worst: list[float] = many(2, NAN)
    event_limit: list[float] = many(2, NAN)
    event_speed: list[float] = many(2, NAN)
    event_load: list[float] = many(2, NAN)
    event_temperature: list[float] = many(2, NAN)
    event_direction: list[int] = many(2, 0)
    event_derived: list[int] = many(2, 0)
    shelved_until: int = 0
    # totals
    running_time: int = 0
    unjudged_time: int = 0
    regime_time: list[int] = many(4, 0)  # by regime
    zone_time: list[int] = many(3, 0)  # by zone
    angle: float = 0.0
    energy_lost: float = 0.0
    since: int = 0
    moment: bool = False  # a sample to add up from
    moment_stamp: int = 0
    moment_speed: float = 0.0
    moment_power: float = 0.0
    moment_regime: int = 0
    moment_zone: int = 0
    # window since the last state
    window_told: bool = False
    window_count: list[int] = many(COLUMNS, 0)
    window_low: list[float] = many(COLUMNS, math.inf)
    window_high: list[float] = many(COLUMNS, -math.inf)
    window_total: list[float] = many(COLUMNS, 0.0)


@dataclasses.dataclass(slots=True)
class Row(Found):
    """
    The judgement of one speed sample, or of a tick without a fresh one.

    Stamp, and arrival or tick `now` [ns]; speed [rad/s], axial_load and its uncertainty [N],
    temperature [K], motor_torque and machine_torque [N m]; NaN is not known. The numbers of the
    surface are those of `Found`. `edge` is EVENT_BEGINS or EVENT_ENDS where the sample does that.

    """

    stamp: int = 0
    now: int = 0
    tick: bool = False
    published: bool = False
    speed: float = NAN
    axial_load: float = NAN
    temperature: float = NAN
    motor_torque: float = NAN
    speed_source: int = 0
    axial_load_source: int = 0
    temperature_source: int = 0
    motor_torque_source: int = 0
    direction: int = 0
    direction_held: bool = False
    derived: int = 0  # a code of `derived_load` with its numbers, 0 where the load is an input
    derived_first: float = NAN
    derived_second: float = NAN
    derived_third: float = NAN
    axial_load_uncertainty: float = NAN
    machine_torque: float = NAN
    machine_nut: int = 0
    regime: int = 0
    contact_state: int = 0
    gates: int = 0  # bits STANDSTILL and LIGHT_LOAD
    zone: int = 0
    reason: int = 0
    clears: bool = False
    level: int = 0
    level_since: int = 0
    event_id: int = 0
    edge: int = 0


EVENT_BEGINS, EVENT_ENDS = 1, 2
STANDSTILL, LIGHT_LOAD = 1, 2
"""Bits of `Row.gates`."""
