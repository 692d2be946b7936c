# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Shares of the axes in a page, so that one of many axes is no larger than one of a few.

All of it is shown of a few axes; of many the charts are coarser and the tables shorter. What is
then left of the page is for every sample around the worst events.

"""

from collections.abc import Sequence
import dataclasses

from ballscrew_monitor.report.judging import AxisCase, badness

PAGE_BYTES = 4_950_000
FEW = 4  # axes of which all is shown
MANY = 16  # axes from which on the tables of all have fewer rows, too
BUCKETS, PATH_POINTS = 3000, 6000
WORST = 50  # events of an axis about which every sample is kept
MOST_ROWS = 1000
"""Rows of a table of which there may be any number; the worst are shown."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisBudget:
    """Most buckets in time, points of the path, and rows of events and of gaps."""

    buckets: int = BUCKETS
    path_points: int = PATH_POINTS
    events: int = MOST_ROWS
    gaps: int = MOST_ROWS


def axis_budgets(cases: Sequence[AxisCase]) -> list[AxisBudget]:
    """Return the budget of each axis of a page."""
    part = min(1.0, FEW / max(1, len(cases)))
    rows = FEW * MOST_ROWS * min(1.0, MANY / max(1, len(cases)))
    events = fair_shares(rows, [min(MOST_ROWS, len(case.outcome.events)) for case in cases])
    gaps = fair_shares(rows, [min(MOST_ROWS, len(case.survey.speed_gaps)) for case in cases])
    return [
        AxisBudget(
            buckets=max(1, int(part * BUCKETS)),
            path_points=max(1, int(part * PATH_POINTS)),
            events=int(event_rows),
            gaps=int(gap_rows),
        )
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
