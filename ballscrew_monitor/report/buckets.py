# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns over time for a page: extremes of buckets, and every sample of chosen stretches.

A short recording keeps all its samples. A long one keeps, in each of a fixed number of buckets of
equal time, the smallest and the largest number, so that no peak is lost whatever the length.

"""

from collections.abc import Mapping, Sequence
import dataclasses
from typing import Any

from ballscrew_monitor.report.encoding import codes as encoded_codes
from ballscrew_monitor.report.encoding import doubles, floats, packed
from ballscrew_monitor.report.page_budget import BUCKETS
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Codes = NDArray[np.uint8]

EVEN = 0.05  # [-] of a step, by which samples of an even rate are early or late


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class TimedRows:
    """Rows in the order of their times [s]: numbers by key, NaN for none, and codes by key."""

    time: Array
    numbers: Mapping[str, Array]
    codes: Mapping[str, Codes]


class Buckets:
    """Smallest and largest number, and the largest code, of each of equal parts of a span."""

    def __init__(
        self, span: float, numbers: Sequence[str], codes: Sequence[str], *, count: int = BUCKETS
    ) -> None:
        """Begin empty; `span` [s] is that of the time line, which begins at zero."""
        self.width = max(span, 1e-9) / count
        self._count = count
        self._low = {key: np.full(count, np.inf) for key in numbers}
        self._high = {key: np.full(count, -np.inf) for key in numbers}
        self._codes = {key: np.zeros(count, dtype=np.uint8) for key in codes}

    def add(self, rows: TimedRows) -> None:
        """Take rows, in any order."""
        place = np.clip((rows.time / self.width).astype(int), 0, self._count - 1)
        for key, values in rows.numbers.items():
            known = np.isfinite(values)
            np.minimum.at(self._low[key], place[known], values[known])
            np.maximum.at(self._high[key], place[known], values[known])
        for key, found in rows.codes.items():
            np.maximum.at(self._codes[key], place, found)

    def rows(self) -> TimedRows:
        """Return two rows for each bucket: the smallest, then the largest."""
        middles = (np.arange(2 * self._count) + 0.5) * (self.width / 2.0)
        return TimedRows(
            time=middles.astype(np.float64),
            numbers={key: _pairs(self._low[key], self._high[key]) for key in self._low},
            codes={key: np.repeat(found, 2) for key, found in self._codes.items()},
        )


def _pairs(low: Array, high: Array) -> Array:
    paired = np.stack([low, high], axis=-1).ravel()
    return np.where(np.isfinite(paired), paired, np.nan)


def in_order(rows: TimedRows) -> TimedRows:
    """Return rows sorted by time, equal times in the order in which they came."""
    return _chosen(rows, np.argsort(rows.time, kind='stable'))


def joined_rows(parts: Sequence[TimedRows]) -> TimedRows:
    """Return slices, at least one, as one."""
    return TimedRows(
        time=np.concatenate([part.time for part in parts]),
        numbers=_joined([part.numbers for part in parts]),
        codes=_joined([part.codes for part in parts]),
    )


def _joined(parts: Sequence[Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    return {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}


def between(rows: TimedRows, stretches: Sequence[tuple[float, float]]) -> TimedRows:
    """Return the rows within stretches of time [s], which are in order and do not overlap."""
    edges = np.array(stretches, dtype=float).reshape(-1)
    return _chosen(rows, np.searchsorted(edges, rows.time, side='right') % 2 == 1)


def stretch_of(rows: TimedRows, begin: float, end: float) -> TimedRows:
    """Return the rows between two times [s] of rows that are in order."""
    first, last = np.searchsorted(rows.time, (begin, end))
    return _chosen(rows, slice(first, last))


def with_breaks(rows: TimedRows, longest: float) -> TimedRows:
    """Return rows with one of no number, code 0, after each that is followed by a longer hole."""
    holes = np.flatnonzero(np.diff(rows.time) > longest)
    after = rows.time[holes] + 1e-6
    return TimedRows(
        time=np.insert(rows.time, holes + 1, after),
        numbers={
            key: np.insert(values, holes + 1, np.nan) for key, values in rows.numbers.items()
        },
        codes={key: np.insert(values, holes + 1, 0) for key, values in rows.codes.items()},
    )


def _chosen(rows: TimedRows, which: NDArray[Any] | slice) -> TimedRows:
    return TimedRows(
        time=rows.time[which],
        numbers={key: values[which] for key, values in rows.numbers.items()},
        codes={key: values[which] for key, values in rows.codes.items()},
    )


def coarse_record(rows: TimedRows) -> dict[str, Any]:
    """Return rows as a page carries them."""
    return {
        'time': doubles(rows.time),
        'columns': {key: floats(values) for key, values in rows.numbers.items()},
        'codes': {key: encoded_codes(values) for key, values in rows.codes.items()},
    }


def fine_record(rows: TimedRows) -> dict[str, Any]:
    """Return the numbers of a stretch; its times only where they are not even."""
    record: dict[str, Any] = {
        'begin': float(rows.time[0]),
        'end': float(rows.time[-1]),
        'count': rows.time.size,
        'columns': {key: packed(values) for key, values in rows.numbers.items()},
    }
    return record if _is_even(rows.time) else record | {'time': packed(rows.time)}


def _is_even(time: Array) -> bool:
    even = np.linspace(time[0], time[-1], time.size)
    step = (time[-1] - time[0]) / max(1, time.size - 1)
    return bool(np.abs(time - even).max() <= EVEN * step)
