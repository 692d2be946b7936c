# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Entries of all axes out of the messages of a recording, as arrays."""

from collections.abc import Sequence
import dataclasses
import enum
from typing import Any

from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
import numpy as np
from numpy.typing import NDArray

Selection = slice | NDArray[Any]


class Kind(enum.IntEnum):
    """What an entry is."""

    SAMPLE = 0
    REFUSED = 1
    OTHER_JOINTS = 2
    TICK = 3
    CHECK = 4  # no event: a place at which the note is called


UNKNOWN_LOSS = -1
"""Number of lost messages that is not known."""
TICK_SOURCE = max(Source) + 1
"""Place of a tick among the sources: after the samples of equal stamp."""


def _column(kind: Any) -> Any:
    """Declare an array by the type of its numbers."""
    return dataclasses.field(metadata={'kind': kind})


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Entries:
    """
    Samples, refusals and ticks.

    `log_time`, `stamp` and `arrival` [ns]; `value` [SI, machine frame]; `place` orders messages of
    equal log time; `header` tells where the stamp is that of a header; `lost` messages never
    arrived before one, -1: not known; a node took those of one `burst` together. `note` is the
    refusal of a refused message, what a message about other joints names, or what a check calls.

    """

    log_time: NDArray[np.int64] = _column(np.int64)
    place: NDArray[np.int64] = _column(np.int64)
    axis: NDArray[np.uint8] = _column(np.uint8)
    source: NDArray[np.uint8] = _column(np.uint8)
    kind: NDArray[np.uint8] = _column(np.uint8)
    stamp: NDArray[np.int64] = _column(np.int64)
    arrival: NDArray[np.int64] = _column(np.int64)
    value: NDArray[np.float64] = _column(np.float64)
    header: NDArray[np.bool_] = _column(np.bool_)
    lost: NDArray[np.int64] = _column(np.int64)
    burst: NDArray[np.int64] = _column(np.int64)
    note: NDArray[Any] = _column(np.object_)

    def __len__(self) -> int:
        """Return the number of entries."""
        return len(self.stamp)

    def take(self, which: Selection) -> 'Entries':
        """Return some of the entries, or all in another order."""
        return Entries(**{name: getattr(self, name)[which] for name in TYPES})


TYPES = {field.name: field.metadata['kind'] for field in dataclasses.fields(Entries)}


def joined(parts: Sequence[Entries]) -> Entries:
    """Return all entries of `parts`, one part after the other."""
    parts = [part for part in parts if len(part)] or list(parts[:1])
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return made(0)
    return Entries(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in TYPES}
    )


def made(count: int, **columns: Any) -> Entries:
    """Return `count` entries of these columns, arrays or one value for all; the rest is zero."""
    arrays = {}
    for name, kind in TYPES.items():
        given = columns.get(name, None if name == 'note' else 0)
        if isinstance(given, np.ndarray) and given.dtype == kind:
            arrays[name] = given
        else:
            arrays[name] = np.empty(count, dtype=kind)
            arrays[name][:] = given
    return Entries(**arrays)


def ticks(count: int, stamp: Any, **columns: Any) -> Entries:
    """Return `count` ticks at one stamp or an array of stamps [ns]; `columns` as in `made`."""
    times = {'log_time': stamp, 'stamp': stamp, 'arrival': stamp}
    return made(count, source=TICK_SOURCE, kind=Kind.TICK, **times, **columns)


Told = tuple[InputSample | Refusal | int, int, int, int]
"""What a message says, or the stamp of a tick [ns]; log time [ns], place, number of the axis."""


def entries_of(told: Sequence[Told]) -> Entries:
    """Return samples, refusals and ticks as entries."""
    entries = made(len(told))
    for at, (event, log_time, place, axis) in enumerate(told):
        entries.log_time[at], entries.place[at], entries.axis[at] = log_time, place, axis
        if isinstance(event, int):
            entries.source[at], entries.kind[at] = TICK_SOURCE, Kind.TICK
            entries.stamp[at] = entries.arrival[at] = event
            continue
        entries.source[at], entries.arrival[at] = event.source, event.arrival
        entries.lost[at] = UNKNOWN_LOSS if event.lost is None else event.lost
        if isinstance(event, InputSample):
            entries.stamp[at], entries.value[at] = event.stamp, event.value
            entries.header[at] = event.stamp_source is StampSource.HEADER
        elif event.why is Why.OTHER_JOINTS:
            entries.kind[at], entries.note[at] = Kind.OTHER_JOINTS, event.joints
            entries.stamp[at] = log_time
        else:
            entries.kind[at], entries.note[at] = Kind.REFUSED, event
            entries.stamp[at] = log_time
    return entries
