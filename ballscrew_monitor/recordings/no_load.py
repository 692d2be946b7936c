# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Torque over speed out of a bag: steady stretches, binned by speed.

The recording is cut into windows. A window is steady when the speed keeps its sign and drifts
little, and when the window before it was steady at the same speed, so that the torque has settled.
Steady windows of like speed make a point: their mean, and its standard error from the scatter of
window means, because samples within a window share the ripple of one revolution.

"""

from collections.abc import Iterator, Sequence
import itertools
import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.inputs import Input, InputSample, OpenInput, Source, Why
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.decode import decode, named_instead
from ballscrew_monitor.settings.parameters import absolute
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError

Array = NDArray[np.float64]

WINDOW = 0.5  # [s]
FEWEST_SAMPLES = 5  # of speed and of torque in a window
STEADY = 0.01  # largest drift within a window and step to the next, over the speed
SLOWEST = 0.1  # least speed of a steady window [rad/s]
BIN = 0.05  # width of a bin over its least speed
FEWEST_WINDOWS = 3  # in a bin
NO_FUTURE_LIMIT = 1 << 62  # [ns]: in a recording a stamp may differ from the log time


Series = tuple[Array, Array]
"""Times of samples [s], which rise, and their values."""
STATISTICS = 'speed', 'torque', 'temperature'
"""Means of a window: speed [rad/s], torque [N m], temperature [K], NaN without one."""
Window = tuple[float, float, float]


def speed_channel(topic: str, field: str, unit: str, lead: float) -> OpenInput:
    """Return the speed in `unit`; a linear one is turned by the lead [m]."""
    scaling = conversions.speed_scaling(unit, scale=1.0, offset=0.0, lead=lead, handedness='right')
    return _channel(Source.SPEED, topic, field, scaling)


def torque_channel(topic: str, field: str, scale: float) -> OpenInput:
    """Return the torque, `scale` times the field [N m]."""
    scaling = conversions.torque_scaling(1.0, scale=scale, offset=0.0, handedness='right')
    return _channel(Source.TORQUE, topic, field, scaling)


def temperature_channel(topic: str, field: str) -> OpenInput:
    """Return the temperature in [degC] as [K]."""
    scaling = conversions.temperature_scaling('degC', scale=1.0, offset=0.0)
    return _channel(Source.TEMPERATURE, topic, field, scaling)


def _channel(source: Source, topic: str, field: str, scaling: conversions.Scaling) -> OpenInput:
    return OpenInput(source=source, topic=absolute(topic), field=field, scaling=scaling)


def read_no_load(
    bag: Bag, channels: Sequence[OpenInput]
) -> tuple[dict[str, Array], tuple[str, ...]]:
    """
    Return speed, torque and its standard error of every bin, in SI units, and what was left out.

    The columns are those of a run: speed [rad/s], torque and torque_std [N m], temperature [K]
    when it is recorded. Raises InputError for a bag without what is asked for or without a bin.

    """
    series, refused = _read(bag, channels)
    speed, torque = series[Source.SPEED], series[Source.TORQUE]
    begin = max(speed[0][0], torque[0][0])
    windows: list[Window | None] = []  # in turn, None for one that is not steady in itself
    for place in range(int((min(speed[0][-1], torque[0][-1]) - begin) / WINDOW)):
        span = (begin + place * WINDOW, begin + (place + 1) * WINDOW)
        (time, speeds), (_, torques) = _between(speed, *span), _between(torque, *span)
        window = None
        if min(len(speeds), len(torques)) >= FEWEST_SAMPLES and _is_steady(time, speeds):
            heat = math.nan
            if Source.TEMPERATURE in series:  # the last one before, or the first
                times, values = series[Source.TEMPERATURE]
                heat = float(values[max(0, int(np.searchsorted(times, span[1])) - 1)])
            window = float(speeds.mean()), float(torques.mean()), heat
        windows.append(window)
    steady = [
        window
        for before, window in itertools.pairwise(windows)
        if before and window and abs(window[0] / before[0] - 1) <= STEADY
    ]
    bins = [group for group in _bins(steady) if len(group) >= FEWEST_WINDOWS]
    if not bins:
        raise InputError(
            f'bag {bag.path}: {len(steady)} of {len(windows)} windows of {WINDOW:g} s are steady, '
            f'allowed is {FEWEST_WINDOWS} or more at one speed (drift up to {100 * STEADY:g} %)'
        )
    used = sum(len(group) for group in bins)
    notes = [
        f'{used} of {len(windows)} windows of {WINDOW:g} s are steady within {100 * STEADY:g} % '
        f'and make {len(bins)} points'
    ]
    if refused:
        notes.append(f'{refused} messages held no finite number')
    return _columns(bins), tuple(notes)


def largest(bag: Bag, channels: Sequence[OpenInput]) -> dict[Source, float]:
    """Return the largest amount of each source in a bag [SI], NaN of one without a sample."""
    series, _ = _read(bag, channels)
    return {
        source: float(np.max(np.abs(values), initial=0.0)) if len(values) else math.nan
        for source, (_, values) in series.items()
    }


def _read(bag: Bag, channels: Sequence[OpenInput]) -> tuple[dict[Source, Series], int]:
    """Return the samples of every source in the order of their stamps, and how many were bad."""
    inputs = [_input(bag, channel) for channel in channels]
    bag.require({source.topic: source.type_name for source in inputs})
    samples: dict[Source, list[tuple[int, float]]] = {source.source: [] for source in inputs}
    refused = 0
    for message in bag.messages({source.topic for source in inputs}):
        readers = [source for source in inputs if source.topic == message.topic]
        decoded = decode(bag, message, readers[0].message_type)
        refused += decoded is None
        for source in readers if decoded is not None else ():
            read = source.read(decoded, now=message.log_time, max_future=NO_FUTURE_LIMIT)
            if isinstance(read, InputSample):
                samples[source.source].append((read.stamp - bag.start_time, read.value))
            else:
                refused += read.why is not Why.OTHER_JOINTS
    for source, channel in zip(inputs, channels, strict=True):
        if not samples[source.source]:
            raise InputError(
                f'bag {bag.path}: no message of {source.topic} holds {channel.field}, '
                f'at least one must{named_instead(bag, source)}'
            )
    return {source: _series(pairs) for source, pairs in samples.items()}, refused


def _input(bag: Bag, channel: OpenInput) -> Input:
    if channel.topic not in bag.topics:
        raise InputError(
            f'bag {bag.path}: topic {channel.topic} is missing, the bag holds '
            f'{", ".join(sorted(bag.topics))}'
        )
    return channel.close(bag.topics[channel.topic].type_name)


def _series(samples: list[tuple[int, float]]) -> Series:
    ordered = sorted(samples)
    times = np.array([conversions.seconds(stamp) for stamp, _ in ordered])
    return times, np.array([value for _, value in ordered])


def _between(series: Series, begin: float, end: float) -> Series:
    """Return the samples from `begin` up to `end` [s]."""
    time, value = series
    first, last = np.searchsorted(time, [begin, end])
    return time[first:last], value[first:last]


def _is_steady(time: Array, speed: Array) -> bool:
    mean = float(speed.mean())
    time = time - time.mean()
    drift = float(time @ speed) / float(time @ time) * WINDOW
    signs = np.sign(speed)
    return bool(
        abs(mean) >= SLOWEST and (signs == signs[0]).all() and abs(drift) <= STEADY * abs(mean)
    )


def _bins(windows: list[Window]) -> Iterator[list[Window]]:
    """Yield groups of windows of one direction whose speeds differ by less than the width."""
    group: list[Window] = []
    for window in sorted(windows, key=lambda window: (window[0] < 0, abs(window[0]))):
        if group and not 0 < window[0] / group[0][0] <= 1 + BIN:
            yield group
            group = []
        group.append(window)
    if group:
        yield group


def _columns(bins: list[list[Window]]) -> dict[str, Array]:
    """Return the means of the bins; their standard errors share one scatter of windows."""
    count = np.array([len(group) for group in bins])
    squares = sum(float(np.var([torque for _, torque, _ in group])) * len(group) for group in bins)
    scatter = math.sqrt(squares / float((count - 1).sum()))
    means = {
        name: np.array([np.mean([window[place] for window in group]) for group in bins])
        for place, name in enumerate(STATISTICS)
    }
    temperature = means.pop('temperature')
    if scatter > 0:
        means['torque_std'] = scatter / np.sqrt(count)
    return means | ({'temperature': temperature} if np.isfinite(temperature).all() else {})
