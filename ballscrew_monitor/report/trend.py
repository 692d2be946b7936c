# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A quantity over dates as a drawing of a page: marks with intervals, axes, and what is normal."""

from collections.abc import Iterator, Sequence
import dataclasses
import datetime
import math

from ballscrew_monitor.report.page import element, Markup

WIDTH, HEIGHT = 720.0, 150.0  # of a drawing [px]
LEFT, RIGHT, TOP, BOTTOM = 64.0, 12.0, 10.0, 26.0  # margins around the marks [px]
TICKS = 3
ROOM = 0.05  # above and below the marks, of their range


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Mark:
    """
    A value at one date, `at` [s] since 1970, with its interval if it has one.

    `value`, `low` and `high` are shares [-]; `kind` is the class of its colour, `title` what it
    says, `link` where it leads.

    """

    at: float
    value: float
    low: float = math.nan
    high: float = math.nan
    kind: str
    title: str
    link: str | None = None


class Frame:
    """Places in a drawing of dates and shares."""

    def __init__(self, marks: Sequence[Mark], normal: float, tolerance: float) -> None:
        dates = [mark.at for mark in marks]
        shares = [share for mark in marks for share in (mark.value, mark.low, mark.high)]
        shares = [*filter(math.isfinite, shares), normal - tolerance, normal + tolerance]
        self.first, self.last, self.low, self.high = (
            min(dates),
            max(dates),
            min(shares),
            max(shares),
        )
        edge = ROOM * (self.high - self.low)
        # Shares that are never negative stand on zero.
        self.low = self.low - edge if self.low < 0.0 else 0.0
        self.high += edge or 0.01

    def across(self, at: float) -> float:
        """Return the place of a date [px]."""
        share = (at - self.first) / (self.last - self.first)
        return LEFT + (WIDTH - LEFT - RIGHT) * share

    def up(self, value: float) -> float:
        """Return the place of a share, counted from the top [px]."""
        share = (value - self.low) / (self.high - self.low)
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share


def trend(marks: Sequence[Mark], *, normal: float = 0.0, tolerance: float = 0.0) -> Markup:
    """Return the drawing of marks in the order of their dates; nothing for less than two."""
    if len(marks) < 2 or marks[0].at == marks[-1].at:
        return Markup()
    frame, band = Frame(marks, normal, tolerance), []
    if tolerance > 0.0:
        top, bottom = (frame.up(normal + sign * tolerance) for sign in (1, -1))
        size: dict[str, str | float] = {
            'width': WIDTH - LEFT - RIGHT,
            'height': f'{bottom - top:.1f}',
        }
        band.append(element('rect', x=LEFT, y=f'{top:.1f}', **size, class_='fill-zone'))
    places, intervals, dots = [], [], []
    for mark in marks:
        x, y = f'{frame.across(mark.at):.1f}', f'{frame.up(mark.value):.1f}'
        places.append(f'{x},{y}')
        if math.isfinite(mark.low + mark.high):
            ends = {'y1': f'{frame.up(mark.low):.1f}', 'y2': f'{frame.up(mark.high):.1f}'}
            intervals.append(element('line', x1=x, x2=x, **ends, class_='line-interval'))
        title = element('title', mark.title)
        dot = element('circle', title, cx=x, cy=y, r='4', class_=f'fill-{mark.kind}')
        dots.append(dot if mark.link is None else element('a', dot, href=mark.link))
    return element(
        'svg',
        *band,
        *_axes(frame),
        *intervals,
        element('polyline', points=' '.join(places), class_='line-trend'),
        *dots,
        class_='trend',
        viewBox=f'0 0 {WIDTH:g} {HEIGHT:g}',
        role='img',
    )


def _axes(frame: Frame) -> Iterator[Markup]:
    for number in range(TICKS):
        value = frame.low + (frame.high - frame.low) * number / (TICKS - 1)
        y = f'{frame.up(value):.1f}'
        yield element('line', x1=LEFT, x2=WIDTH - RIGHT, y1=y, y2=y, class_='line-hatch')
        yield _text(LEFT - 6.0, frame.up(value) + 4.0, f'{100.0 * value:.3g} %', 'end')
    for number, anchor in enumerate(('start', 'middle', 'end')):
        at = frame.first + (frame.last - frame.first) * number / 2
        date = datetime.datetime.fromtimestamp(at, tz=datetime.UTC)
        yield _text(frame.across(at), HEIGHT - 6.0, f'{date:%Y-%m-%d}', anchor)


def _text(x: float, y: float, text: str, anchor: str) -> Markup:
    return element(
        'text', text, x=f'{x:.1f}', y=f'{y:.1f}', text_anchor=anchor, class_='trend-text'
    )
