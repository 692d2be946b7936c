# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Where a page shows every sample of a long recording: about both ends of the worst events."""

from collections.abc import Iterable

from ballscrew_monitor.report.case import AxisCase

WORST, AROUND = 50, 1.0  # events of which every sample is kept, and for how long about an end [s]
SAMPLE_BYTES = 8 / 3  # of one number of a stretch in the page
STRETCH_BYTES = 1000  # of a stretch in the page besides its numbers


def worst_stretches(case: AxisCase, longest: float) -> tuple[int, list[tuple[float, float]]]:
    """Return of how many of the worst events samples are kept, and where; `longest` in all [s]."""
    chosen: list[tuple[float, float]] = []
    count = 0
    for event in case.worst_first[:WORST]:
        ends = case.since_first(event.start), case.since_first(event.end)
        more = _merged([*chosen, *((at - AROUND, at + AROUND) for at in ends)])
        if length(more) > longest:
            break
        count, chosen = count + 1, more
    return count, chosen


def bytes_per_second(case: AxisCase, columns: int) -> float:
    """Return how much a second of some columns takes in a page, at the mean rate [bytes/s]."""
    return columns * SAMPLE_BYTES * case.survey.rows / max(case.survey.span, 1e-9)


def length(stretches: Iterable[tuple[float, float]]) -> float:
    """Return how long stretches are in all [s]."""
    return sum(end - begin for begin, end in stretches)


def _merged(stretches: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return stretches in order, those that touch as one."""
    made: list[tuple[float, float]] = []
    for begin, end in sorted(stretches):
        if made and begin <= made[-1][1]:
            made[-1] = made[-1][0], max(made[-1][1], end)
        else:
            made.append((begin, end))
    return made
