# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Columns over time for a page: extremes of buckets, and every sample of chosen stretches.

A short recording keeps all its samples. A long one keeps, in each of a fixed number of buckets of
equal time, the smallest and the largest number, so that no peak is lost whatever the length. The
axes share the page: all is shown of a few; of many the charts are coarser and the tables shorter,
and what is left of the page is for every sample around the worst events.

"""

from collections.abc import Sequence
import dataclasses
from typing import Any

from ballscrew_monitor.report import page
from ballscrew_monitor.report.judging import AxisCase, badness
from ballscrew_monitor.report.row_table import RowTable
import numpy as np
import polars as pl
import polars.selectors as cs

NUMBERS, CODES = cs.float() - cs.by_name('time', require_all=False), cs.by_dtype(pl.UInt8)
"""Columns of rows beside their `time` [s]: numbers, NaN for none, and codes."""
EVEN = 0.05  # [-] of a step, by which samples of an even rate are early or late


def bucketed(
    table: RowTable, columns: Sequence[pl.Expr], span: float, count: int
) -> tuple[pl.DataFrame, float]:
    """
    Return two rows for each of `count` equal parts of a span, and the width of these [s].

    `columns` make rows of those of a table, whose times begin at zero. The first of the two rows
    has the smallest numbers, the second the largest; both have the largest codes.

    """
    width = max(span, 1e-9) / count
    place = over(pl.col('time'), width).cast(pl.Int64).clip(0, count - 1).alias('place')
    known = pl.when(NUMBERS.is_finite()).then(NUMBERS)
    ends = (NUMBERS.min().name.prefix('low_'), NUMBERS.max().name.prefix('high_'), CODES.max())

    def query(part: pl.LazyFrame) -> pl.LazyFrame:
        return part.select(*columns).select(place, known, CODES).group_by('place').agg(*ends)

    parts = (
        table.collect(query)
        .group_by('place')
        .agg(cs.starts_with('low_').min(), cs.starts_with('high_').max(), CODES.max())
    )
    every = pl.DataFrame({'place': np.arange(count)}).join(parts, 'place', 'left').sort('place')
    rows: dict[str, Any] = {'time': (np.arange(2 * count) + 0.5) * (width / 2.0)}
    for name in every.columns:
        if name.startswith('low_'):
            both = every.select(name, name.replace('low_', 'high_', 1)).fill_null(np.nan)
            rows[name.removeprefix('low_')] = both.to_numpy().ravel()
    for codes in every.select(CODES):
        rows[codes.name] = np.repeat(codes.fill_null(0).to_numpy(), 2)
    return pl.DataFrame(rows), width


def over(value: pl.Expr, divisor: float) -> pl.Expr:
    """Return a quotient that is rounded once: polars multiplies with the inverse of a number."""

    def quotient(numbers: pl.Series) -> pl.Series:
        return pl.Series(numbers.to_numpy() / divisor)

    return value.map_batches(quotient, return_dtype=pl.Float64, is_elementwise=True)


def between(stretches: Sequence[tuple[float, float]]) -> pl.Expr:
    """Return which times lie within stretches [s], which are in order and do not overlap."""
    edges = pl.Series(np.array(stretches, dtype=float).reshape(-1))
    return pl.lit(edges).search_sorted(pl.col('time'), side='right') % 2 == 1


def with_breaks(rows: pl.DataFrame, longest: float) -> pl.DataFrame:
    """Return rows with one of no number, code 0, after each that is followed by a longer hole."""
    holes = rows.filter(pl.col('time').shift(-1) - pl.col('time') > longest)
    breaks = holes.with_columns(
        pl.col('time') + 1e-6, NUMBERS * np.nan, CODES * pl.lit(0, pl.UInt8)
    )
    return pl.concat([rows, breaks]).sort('time', maintain_order=True)


def coarse_record(rows: pl.DataFrame) -> dict[str, Any]:
    """Return rows as a page carries them."""
    return {
        'time': page.doubles(rows['time']),
        'columns': {column.name: page.floats(column) for column in rows.select(NUMBERS)},
        'codes': {column.name: page.codes(column) for column in rows.select(CODES)},
    }


def fine_record(rows: pl.DataFrame) -> dict[str, Any]:
    """Return the numbers of a stretch; its times only where they are not even."""
    time = rows['time'].to_numpy()
    record: dict[str, Any] = {
        'begin': float(time[0]),
        'end': float(time[-1]),
        'count': time.size,
        'columns': {column.name: page.packed(column) for column in rows.select(NUMBERS)},
    }
    even = np.linspace(time[0], time[-1], time.size)
    step = (time[-1] - time[0]) / max(1, time.size - 1)
    is_even = np.abs(time - even).max() <= EVEN * step
    return record if is_even else record | {'time': page.packed(time)}


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
