# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Channels of TDMS and MDF as signals: columns of one period, or behind times of their own."""

from collections import Counter
from collections.abc import Mapping
import dataclasses
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.apart import check_room, library_of
from ballscrew_monitor.recordings.tables.cells import Unreadable
from ballscrew_monitor.recordings.tables.heads import with_unit
from ballscrew_monitor.recordings.tables.signals import (
    behind_times,
    lengths,
    side_by_side,
    Signals,
)
from ballscrew_monitor.recordings.words import listed
import numpy as np

STEP, BEGIN, OFFSET = 'wf_increment', 'wf_start_time', 'wf_start_offset'
"""Properties of a waveform: its step [s], its start, and its first sample after that [s]."""


def read_tdms(path: Path) -> Signals:
    """Return the channels of a TDMS file by their waveforms."""
    library = library_of('nptdms', path, 'TDMS', 'npTDMS')
    with library.TdmsFile.open(path) as file:
        groups = [group for group in file.groups() if group.channels()]
        channels = [channel for group in groups for channel in group.channels()]
        check_room(max(map(len, channels), default=0), len(channels))
        waves = {channel: Waveform.of(channel.properties) for channel in channels}
        timed = {channel.group_name for channel, wave in waves.items() if wave}
        left_out: dict[str, str] = {}
        held: dict[str, Any] = {}
        by_name: dict[str, Waveform | None] = {}
        for channel, wave in waves.items():
            before = f'{channel.group_name}.' if len(groups) > 1 else ''
            unit, name = channel.properties.get('unit_string', ''), f'{before}{channel.name}'
            if timed and channel.group_name not in timed:
                left_out[name] = f'its group states no {STEP}, and others do'
                continue
            name = with_unit(name, unit)
            held[name] = channel[:]
            if held[name].dtype.kind in 'iufb':
                by_name[name] = wave
    return dataclasses.replace(_of_waveforms(held, by_name), left_out=left_out)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Waveform:
    """Times of the samples of a channel: an `offset` [ns] after a `start`, by a `step` [s]."""

    start: np.datetime64 | None
    offset: int
    step: float

    @classmethod
    def of(cls, properties: Mapping[str, Any]) -> 'Waveform | None':
        """Return what a channel states, None for one without a step."""
        step, start = float(properties.get(STEP, 0.0)), properties.get(BEGIN)
        begin = None if start is None else np.datetime64(start, 'ns')
        offset = round(float(properties.get(OFFSET, 0.0)) * SECOND)
        return cls(start=begin, offset=offset, step=step) if 0.0 < step < math.inf else None


def _of_waveforms(held: Mapping[str, Any], waves: Mapping[str, Waveform | None]) -> Signals:
    """Return channels of numbers, with a time before those that begin or step as no others do."""
    by_wave: dict[Waveform | None, list[str]] = {}
    for name, wave in waves.items():
        by_wave.setdefault(wave, []).append(name)
    bare, clocks = by_wave.pop(None, []), [wave for wave in by_wave if wave]
    starts = {wave.start for wave in clocks}
    steps = '; '.join(f'{STEP} = {wave.step:g} of {listed(by_wave[wave])}' for wave in clocks)
    if len(clocks) > 1 and (bare or None in starts and len(starts) > 1):
        lacking = bare or [name for wave in clocks if wave.start is None for name in by_wave[wave]]
        raise Unreadable(
            f'its waveforms begin or step apart, {steps}, and {listed(lacking)} states no '
            f'{STEP if bare else BEGIN}: write it into each channel, or save the signals as CSV '
            'with a column of the time'
        )
    if not clocks:
        return Signals(frame=side_by_side(held), arrays=lengths(held))
    first = min(clocks, key=lambda wave: _begin(wave))
    start = '' if first.start is None else str(first.start + np.timedelta64(first.offset, 'ns'))
    if len(clocks) == 1:
        unclear = f'{steps}, none of {listed(bare)}' if bare else ''
        period = math.nan if bare else first.step
        return Signals(
            frame=side_by_side(held),
            period=period,
            unclear_period=unclear,
            start=start,
            arrays=lengths(held) if bare else {},
        )
    groups = []
    for wave in clocks:
        columns = {name: held[name] for name in by_wave[wave]}
        rows = np.arange(max(lengths(columns).values()))
        begin = (_begin(wave) - _begin(first)) / SECOND
        groups.append((begin + wave.step * rows, columns))
    return Signals(frame=side_by_side(behind_times(groups) | dict(held)), start=start)


def _begin(wave: Waveform) -> int:
    """Return when the first sample of a waveform is [ns]."""
    return (0 if wave.start is None else int(wave.start.astype(np.int64))) + wave.offset


def read_mdf(path: Path) -> Signals:
    """Return the signals of an MDF file; those of one time each stand behind it."""
    file = library_of('asammdf', path, 'MDF').MDF(path)
    rows = [group.channel_group.cycles_nr for group in file.groups]
    check_room(max(rows, default=0), sum(len(group.channels) for group in file.groups))
    groups: list[tuple[Any, dict[str, Any]]] = []
    counts: Counter[str] = Counter()
    for signal in file.iter_channels(copy_master=False):
        if signal.samples.dtype.kind in 'iuf' and signal.samples.ndim == 1:
            if not groups or not np.array_equal(groups[-1][0], signal.timestamps):
                groups.append((signal.timestamps, {}))
            counts[signal.name] += 1
            several = counts[signal.name] > 1
            name = f'{signal.name} {counts[signal.name]}' if several else signal.name
            groups[-1][1][with_unit(name, signal.unit)] = signal.samples
    return Signals(frame=side_by_side(behind_times(groups)), start=str(file.header.start_time))
