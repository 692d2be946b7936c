# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns over time for a page: extremes of buckets, and every sample of chosen stretches.

A short recording keeps all its samples. A long one keeps, in each of a fixed number of buckets of
equal time, the smallest and the largest number, so that no peak is lost whatever the length. The
axes share the page: all is shown of a few; of many the charts are coarser and the tables shorter,
and what is left of the page is for every sample around the worst events.

"""

from collections.abc import Iterable, Sequence
import dataclasses
from typing import Any

from ballscrew_monitor.report import page
from ballscrew_monitor.report.judging import AxisCase, badness
import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.void]
"""Rows in the order of their times: `time` [s], numbers by key, NaN for none, codes by key."""
EVEN = 0.05  # [-] of a step, by which samples of an even rate are early or late


def row_type(numbers: Iterable[str], codes: Iterable[str]) -> np.dtype[np.void]:
    """Return the type of rows with numbers and codes of these keys."""
    fields = [(key, np.float64) for key in ('time', *numbers)]
    return np.dtype([*fields, *((key, np.uint8) for key in codes)], align=True)


def numbers_of(rows: Rows) -> dict[str, NDArray[np.float64]]:
    """Return the numbers of rows by key, which write through."""
    return {key: values for key, values in _columns(rows, 'f').items() if key != 'time'}


def codes_of(rows: Rows) -> dict[str, NDArray[np.uint8]]:
    """Return the codes of rows by key, which write through."""
    return _columns(rows, 'u')


def _columns(rows: Rows, kind: str) -> dict[str, NDArray[Any]]:
    return {key: rows[key] for key in rows.dtype.names or () if rows.dtype[key].kind == kind}


class Buckets:
    """Smallest and largest number, and the largest code, of each of equal parts of a span."""

    def __init__(self, span: float, kind: np.dtype[np.void], *, count: int) -> None:
        """Begin without rows of a `kind`; `span` [s] is that of a time line from zero on."""
        self.width = max(span, 1e-9) / count
        self._low, self._high = np.zeros((2, count), kind)
        for ends, extreme in ((self._low, np.inf), (self._high, -np.inf)):
            for values in numbers_of(ends).values():
                values[:] = extreme

    def add(self, rows: Rows) -> None:
        """Take rows, in any order."""
        place = np.clip((rows['time'] / self.width).astype(int), 0, self._low.size - 1)
        for key, values in numbers_of(rows).items():
            known = np.isfinite(values)
            np.minimum.at(self._low[key], place[known], values[known])
            np.maximum.at(self._high[key], place[known], values[known])
        for key, found in codes_of(rows).items():
            np.maximum.at(self._high[key], place, found)

    def rows(self) -> Rows:
        """Return two rows for each bucket: the smallest, then the largest."""
        made = np.stack([self._low, self._high], axis=-1).ravel()
        made['time'] = (np.arange(made.size) + 0.5) * (self.width / 2.0)
        for values in numbers_of(made).values():
            values[~np.isfinite(values)] = np.nan
        for codes in codes_of(made).values():
            codes[::2] = codes[1::2]
        return made


def in_order(rows: Rows) -> Rows:
    """Return rows sorted by time, equal times in the order in which they came."""
    return rows[np.argsort(rows['time'], kind='stable')]


def between(rows: Rows, stretches: Sequence[tuple[float, float]]) -> Rows:
    """Return the rows within stretches of time [s], which are in order and do not overlap."""
    edges = np.array(stretches, dtype=float).reshape(-1)
    return rows[np.searchsorted(edges, rows['time'], side='right') % 2 == 1]


def with_breaks(rows: Rows, longest: float) -> Rows:
    """Return rows with one of no number, code 0, after each that is followed by a longer hole."""
    holes = np.flatnonzero(np.diff(rows['time']) > longest)
    breaks = np.zeros(holes.size, rows.dtype)
    breaks['time'] = rows['time'][holes] + 1e-6
    for values in numbers_of(breaks).values():
        values[:] = np.nan
    return np.insert(rows, holes + 1, breaks)


def coarse_record(rows: Rows) -> dict[str, Any]:
    """Return rows as a page carries them."""
    return {
        'time': page.doubles(rows['time']),
        'columns': {key: page.floats(values) for key, values in numbers_of(rows).items()},
        'codes': {key: page.codes(values) for key, values in codes_of(rows).items()},
    }


def fine_record(rows: Rows) -> dict[str, Any]:
    """Return the numbers of a stretch; its times only where they are not even."""
    time = rows['time']
    record: dict[str, Any] = {
        'begin': float(time[0]),
        'end': float(time[-1]),
        'count': time.size,
        'columns': {key: page.packed(values) for key, values in numbers_of(rows).items()},
    }
    return record if _is_even(time) else record | {'time': page.packed(time)}


def _is_even(time: NDArray[np.float64]) -> bool:
    even = np.linspace(time[0], time[-1], time.size)
    step = (time[-1] - time[0]) / max(1, time.size - 1)
    return bool(np.abs(time - even).max() <= EVEN * step)


PAGE_BYTES = 4_950_000
FEW = 4  # axes of which all is shown
MANY = 16  # axes from which on the tables of all have fewer rows, too
BUCKETS = 3000
WORST = 50  # events of an axis about which every sample is kept
MOST_ROWS = 1000
"""Rows of a table of which there may be any number; the worst are shown."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisBudget:
    """Most buckets in time, and rows of events and of gaps."""

    buckets: int = BUCKETS
    events: int = MOST_ROWS
    gaps: int = MOST_ROWS


def axis_budgets(cases: Sequence[AxisCase]) -> list[AxisBudget]:
    """Return the budget of each axis of a page."""
    part = min(1.0, FEW / max(1, len(cases)))
    rows = FEW * MOST_ROWS * min(1.0, MANY / max(1, len(cases)))
    events = fair_shares(rows, [min(MOST_ROWS, len(case.outcome.events)) for case in cases])
    gaps = fair_shares(rows, [min(MOST_ROWS, len(case.survey.speed_gaps)) for case in cases])
    return [
        AxisBudget(buckets=max(1, int(part * BUCKETS)), events=int(event_rows), gaps=int(gap_rows))
        for event_rows, gap_rows in zip(events, gaps, strict=True)
    ]


def fair_shares(total: float, wanted: Sequence[float]) -> list[float]:
    """Return what each gets of a total: what it wants, or as much as any other that wants more."""
    shares = [0.0] * len(wanted)
    left = max(0.0, total)
    smallest_first = sorted(range(len(wanted)), key=wanted.__getitem__)
    for number, place in enumerate(smallest_first):
        shares[place] = min(wanted[place], left / (len(wanted) - number))
        left -= shares[place]
    return shares


def shares_of_worst(
    total: float, cases: Sequence[AxisCase], costs: Sequence[float]
) -> list[float]:
    """Return what each axis gets of a total: the cost of its events that are the worst of all."""
    shares = [0.0] * len(cases)
    left = max(0.0, total)
    events = (
        (badness(event), place)
        for place, case in enumerate(cases)
        for event in case.worst_first[:WORST]
    )
    for _, place in sorted(events, reverse=True):
        if costs[place] > left:
            break
        shares[place] += costs[place]
        left -= costs[place]
    # Costs are means: what is left makes up for samples that come in bursts.
    return [share + left / len(cases) for share in shares]
