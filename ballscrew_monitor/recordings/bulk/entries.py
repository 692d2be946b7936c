# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the messages of a recording say of the inputs of all axes, as arrays."""

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


TICK_SOURCE = max(Source) + 1
"""Place of a tick among the sources: after the samples of equal stamp."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Entries:
    """
    Samples, refusals and ticks.

    `log_time`, `stamp` and `arrival` [ns]; `value` [SI, machine frame]; `place` orders messages of
    equal log time; `header` tells where the stamp is that of a header. `note` is the refusal of a
    refused message and what a message about other joints names, else None.

    """

    log_time: NDArray[np.int64]
    place: NDArray[np.int64]
    axis: NDArray[np.uint8]
    source: NDArray[np.uint8]
    kind: NDArray[np.uint8]
    stamp: NDArray[np.int64]
    arrival: NDArray[np.int64]
    value: NDArray[np.float64]
    header: NDArray[np.bool_]
    note: NDArray[Any]

    def __len__(self) -> int:
        """Return the number of entries."""
        return len(self.stamp)

    def take(self, which: Selection) -> 'Entries':
        """Return some of the entries, or all in another order."""
        return Entries(**{name: getattr(self, name)[which] for name in NAMES})

    def event(self, at: int) -> InputSample | Refusal:
        """Return one entry, which is no tick, as a monitor takes it."""
        source = Source(int(self.source[at]))
        if self.kind[at] == Kind.REFUSED:
            refusal: Refusal = self.note[at]
            return refusal
        if self.kind[at] == Kind.OTHER_JOINTS:
            return Refusal(
                source=source,
                why=Why.OTHER_JOINTS,
                joints=self.note[at],
                arrival=int(self.arrival[at]),
            )
        return InputSample(
            source=source,
            value=float(self.value[at]),
            stamp=int(self.stamp[at]),
            stamp_source=StampSource.HEADER if self.header[at] else StampSource.RECEIVE,
            arrival=int(self.arrival[at]),
        )


NAMES = tuple(field.name for field in dataclasses.fields(Entries))
_TYPES = {
    'log_time': np.int64,
    'place': np.int64,
    'axis': np.uint8,
    'source': np.uint8,
    'kind': np.uint8,
    'stamp': np.int64,
    'arrival': np.int64,
    'value': np.float64,
    'header': np.bool_,
    'note': np.object_,
}


def joined(parts: Sequence[Entries]) -> Entries:
    """Return all entries of `parts`, one part after the other."""
    parts = [part for part in parts if len(part)] or list(parts[:1])
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return made(0)
    return Entries(
        **{name: np.concatenate([getattr(part, name) for part in parts]) for name in NAMES}
    )


def made(count: int, **columns: Any) -> Entries:
    """Return `count` entries of these columns, arrays or one value for all; the rest is zero."""
    arrays = {}
    for name, kind in _TYPES.items():
        given = columns.get(name, None if name == 'note' else 0)
        if isinstance(given, np.ndarray) and given.dtype == kind:
            arrays[name] = given
        else:
            arrays[name] = np.empty(count, dtype=kind)
            arrays[name][:] = given
    return Entries(**arrays)


Told = tuple[InputSample | Refusal, int, int, int]
"""What a message says, its log time [ns], its place and the number of the axis."""


def entries_of(told: Sequence[Told]) -> Entries:
    """Return samples and refusals as entries."""
    events, log_times, places, axes = zip(*told) if told else ((), (), (), ())
    samples = [each if isinstance(each, InputSample) else None for each in events]
    note = np.empty(len(events), dtype=object)
    note[:] = [None if isinstance(each, InputSample) else _note(each) for each in events]
    return made(
        len(events),
        log_time=log_times,
        place=places,
        axis=axes,
        source=[each.source for each in events],
        kind=[_kind(each) for each in events],
        stamp=[at if one is None else one.stamp for one, at in zip(samples, log_times)],
        arrival=[each.arrival for each in events],
        value=[np.nan if one is None else one.value for one in samples],
        header=[one is not None and one.stamp_source is StampSource.HEADER for one in samples],
        note=note,
    )


def _kind(event: InputSample | Refusal) -> Kind:
    if isinstance(event, InputSample):
        return Kind.SAMPLE
    return Kind.OTHER_JOINTS if event.why is Why.OTHER_JOINTS else Kind.REFUSED


def _note(refusal: Refusal) -> Any:
    return refusal.joints if refusal.why is Why.OTHER_JOINTS else refusal
