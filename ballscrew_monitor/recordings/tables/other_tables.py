# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows below or above a log that are of another table: statistics, limits, a spectrum, alarms.

Where no line names them, their times do not go on as those of the log do: they begin after a row
without a time, or before the times above, and are further apart, or go far back at the end.

"""

from collections.abc import Sequence

from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.estimates import NEAR, usual_step
from ballscrew_monitor.recordings.tables.time_gate import Run
import numpy as np

TAIL = 4096  # rows at the end of a log that are looked at
FEWEST = 30  # rows of a log that tell how its times go on
OTHER = 5.0  # times the usual step, or its part, which is one of another table
AGAIN = 5  # rows that begin again, at least, whose steps tell what they are
FAR = 0.2  # of the time of a log, by which no row comes late
LONG = 100.0  # times the usual step, after which a single row is not of the log
STATISTICS = 12  # rows at the end, at most, that go back, and as many before the first
FEW_HOLES = 0.05  # of the rows that hold no sample: in a log with more, these part nothing
TAKE_OUT = 'take them out if they are of another table, or split the log there'
EVEN = 0.9, 2.0  # quantile of the steps of a log, and how many usual ones that is at most


def other_table(times: Array, row: int, step: float) -> str:
    """
    Return which of the last rows of a log are of another table and why, empty for none.

    Their times [s], NaN where there is none, begin in a row of the file, and rise by a usual step.

    """
    known = np.isfinite(times)
    with np.errstate(invalid='ignore'):  # there are breaks beside a row without a time as well
        breaks = (np.flatnonzero(~(np.diff(times) >= 0.0)) + 1).tolist()
    for begin in (at for at in breaks if known[at]):
        end = next((at for at in breaks if at > begin), len(times))
        before, part = times[:begin][known[:begin]], times[begin:end]
        if len(before) < FEWEST:
            continue
        if _is_other(before, part, step, is_apart=not known[begin - 1]):
            words = f'{_rows(row + begin, row + end - 1)} {_distance(part)}'
            zeros = _without_zeros(part[-1] - part[0], usual_step(part), step)
            return f'{words} not as those above, which are {step:.3g} s apart{zeros}'
        far = FAR * np.ptp(before)
        goes_back = before.max() - part[0] > far and np.diff(before).min() >= -far
        is_run = len(part) > 1 and step / OTHER < usual_step(part) < step * OTHER
        if known[begin:].sum() <= STATISTICS and goes_back and not is_run:
            words = f'{_rows(row + begin, row + len(times) - 1)} at the end'
            return f'{words}, from {part[0]:.6g} s on, do not go on from there, as statistics do'
    return ''


def rows_above(runs: Sequence[Run], step: float) -> str:
    """
    Return which of the first rows of a log are of another table and why, empty for none.

    They are a run of few rows, which are further apart than the usual step [s] of the log.

    """
    if len(runs) < 2 or not 1 < runs[0].rows <= STATISTICS or runs[1].rows < FEWEST:
        return ''
    first = runs[0]
    apart = (first.end - first.begin) / (first.rows - 1)
    if apart <= step * OTHER:
        return ''
    words = f'{_rows(first.row, first.last)} above the log are {apart:.3g} s apart'
    zeros = _without_zeros(first.end - first.begin, apart, step)
    return f'{words}, not as those below, which are {step:.3g} s apart{zeros}'


def _is_other(before: Array, part: Array, step: float, *, is_apart: bool) -> bool:
    """Return True if the rows of a part [s] follow each other otherwise than those before it."""
    quantile, most = EVEN
    steps = np.diff(before)
    rising = steps[steps > 0.0]
    if not len(rising) or float(np.quantile(rising, quantile)) > most * step:
        return False  # no even log
    if len(part) < 2:
        return is_apart and part[0] - before[-1] > LONG * step
    return (is_apart or len(part) >= AGAIN) and not step / OTHER < usual_step(part) < step * OTHER


def _without_zeros(span: float, apart: float, step: float) -> str:
    """Return a hint if rows within a second [s] are ten or a hundred usual steps apart."""
    if span >= 1.0 or all(abs(apart / step / times - 1.0) > NEAR for times in (10.0, 100.0)):
        return ''
    return (
        ', as milliseconds are that are written without leading zeros (then state time.rate_Hz '
        'instead of time.column in the map)'
    )


def _rows(first: int, last: int) -> str:
    return f'rows {first} to {last}' if last > first else f'row {first}'


def _distance(part: Array) -> str:
    """Return how far the rows of a part are from each other, in words."""
    return f'are {usual_step(part):.3g} s apart,' if len(part) > 1 else 'stands alone,'
