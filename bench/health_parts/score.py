# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health of axis-years against their truth: alarms, delays, coverage, causes."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any, NamedTuple

from ballscrew_monitor.health.causes import causes_of, likely
from ballscrew_monitor.health.change import changes_of, marks_of
from ballscrew_monitor.health.detection import Look, looks
from ballscrew_monitor.health.history import History, history_of
from ballscrew_monitor.health.records import CauseCode
from ballscrew_monitor.health.words import explained
from health_parts.axis_year import AxisYear
from health_parts.summaries import cells_of_year
import numpy as np

Judge = Callable[[History], Iterable[Look]]
"""What yields a look after each log of a history."""
EIGHT_WEEKS = 56.0  # [d]
QUARTER = 91.0  # [d]
CAUSES = {
    'preload': {CauseCode.PRELOAD_LOST},
    'viscosity': {CauseCode.OIL_THINNER, CauseCode.OIL_THICKER},
    'film': {CauseCode.FILM_STARVED},
    'wiper': {CauseCode.WIPER},
    'guideway': {CauseCode.WIPER},
    'bearing': {CauseCode.WIPER},
    'torque_constant': {CauseCode.TORQUE_CONSTANT},
}
"""Causes that are right by the part that has changed."""


class Kind(NamedTuple):
    """A way to log, a fault by its name, and the options of the year."""

    way: str
    fault: str
    options: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True, slots=True)
class Course:
    """
    A year as it was judged.

    `found` is the day of the alarm after the fault, NaN for none; `early` counts alarms before it;
    `held` and `known` count looks; half widths [-] after a quarter and at the end. `told` and
    `right` are those of the cause at the alarm.

    """

    lost: float  # change of the friction in the end [-]
    found: float
    early: int
    held: int
    known: int
    looks: int
    quarter: float
    half: float
    told: bool
    right: bool


def score_of(
    year: AxisYear, *, always_free: bool = False, judge: Judge = looks, causes: bool = True
) -> Course:
    """Return how a year was judged; another `judge` than the product has no `causes`."""
    cells = cells_of_year(year, always_free=always_free)
    history = history_of(cells, year.machine.size.lead)
    if history is None:
        return Course(
            lost=0.0,
            found=math.nan,
            early=0,
            held=0,
            known=0,
            looks=len(year.day),
            quarter=math.nan,
            half=math.nan,
            told=False,
            right=False,
        )
    seen = list(judge(history))
    day = year.day[np.searchsorted([log.start for log in year.logs], history.start)]
    first = day - day[0] <= QUARTER
    indicated = (1.0 + year.truth.change(first)) / constant_of(year)
    truth = indicated[np.searchsorted(year.day, day)] - 1.0
    pairs = [(one, _now(truth, one)) for one in seen if math.isfinite(one.low)]
    raised = [one for one in seen if one.raised]
    start = year.fault.start if year.fault.part else math.inf
    after = [one for one in raised if day[one.log] >= start]
    told, right = _cause(history, after[-1], year) if after and causes else (False, False)
    quarter = [one for one in seen if one.is_known and day[one.log] - day[0] >= QUARTER - 3.0]
    return Course(
        lost=float(np.mean(truth[-4:])),
        found=float(day[after[0].log] - start) if after else math.nan,
        early=any(day[one.log] < start for one in raised),
        held=sum(one.low <= value <= one.high for one, value in pairs),
        known=len(pairs),
        looks=len(seen),
        quarter=_half(quarter[0]) if quarter else math.nan,
        half=_half(seen[-1]),
        told=told,
        right=right,
    )


def constant_of(year: AxisYear) -> np.ndarray:
    """Return the torque constant of each log of a year over that of its first one [-]."""
    constant = year.fault.condition(year.day[:, None]).torque_constant
    return np.broadcast_to(constant, (len(year.day), 1))[:, 0]


def _now(truth: np.ndarray, look: Look) -> float:
    first = max(look.log - look.now + 1, 0)
    return float(np.mean(truth[slice(first, look.log + 1)]))


def _half(look: Look) -> float:
    return 0.5 * (look.high - look.low)


def _cause(history: History, look: Look, year: AxisYear) -> tuple[bool, bool]:
    """Return whether a cause is told at a look, and whether the truth is among those told."""
    until = history.until(look.log + 1)
    change, marks = math.log1p(look.change), marks_of(until, look)
    causes = causes_of(changes_of(until, look), marks, change, year.machine.preload)
    _, told = explained(likely(causes))
    codes = {one.code for one in told}
    return bool(codes), bool(codes & CAUSES.get(year.fault.part, set()))


@dataclass(frozen=True, kw_only=True, slots=True)
class Score:
    """A line of the table."""

    kind: Kind
    years: int
    lost: float
    found: float
    soon: float
    delay: float
    early: float
    coverage: float
    quarter: float
    half: float
    unknown: float
    told: float
    right: float

    @classmethod
    def of(cls, kind: Kind, courses: Sequence[Course]) -> 'Score':
        """Return the score of the years of a kind."""
        delays = [one.found for one in courses if math.isfinite(one.found)]
        known = sum(one.known for one in courses)
        found = [one for one in courses if math.isfinite(one.found)]
        told = [one for one in found if one.told]
        return cls(
            kind=kind,
            years=len(courses),
            lost=float(np.mean([one.lost for one in courses])),
            found=len(delays) / len(courses),
            soon=sum(one <= EIGHT_WEEKS for one in delays) / len(courses),
            delay=float(np.median(delays)) if delays else math.nan,
            early=100.0 * sum(one.early for one in courses) / len(courses),
            coverage=sum(one.held for one in courses) / max(known, 1),
            quarter=float(np.nanmedian([one.quarter for one in courses])),
            half=float(np.nanmedian([one.half for one in courses])),
            unknown=1.0 - known / max(sum(one.looks for one in courses), 1),
            told=len(told) / len(found) if found else math.nan,
            right=sum(one.right for one in told) / len(told) if told else math.nan,
        )


def print_table(table: Sequence[Score]) -> None:
    """Print the lines as a table of Markdown."""
    print(
        '| logs | change | years | friction in the end | found | delay | false alarms, 100 years '
        '| interval holds | half width, a quarter, end | cause told, right |'
    )
    print('|---|---|---|---|---|---|---|---|---|---|')
    for one in table:
        print(
            f'| {one.kind.way} | {one.kind.fault} | {one.years} | {100 * one.lost:+.0f} % '
            f'| {_share(one.found)} | {_number(one.delay)} d | {one.early:.1f} '
            f'| {_share(one.coverage)} | {_share(one.quarter)}, {_share(one.half)} '
            f'| {_share(one.told)}, {_share(one.right)} |'
        )


def _share(value: float) -> str:
    return '' if math.isnan(value) else f'{100 * value:.0f} %'


def _number(value: float) -> str:
    return '' if math.isnan(value) else f'{value:.0f}'
