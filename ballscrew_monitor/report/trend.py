# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A quantity over dates as a drawing of a page: marks with intervals, axes, and what is normal."""

from collections.abc import Iterator, Sequence
import dataclasses
import datetime
import math

from ballscrew_monitor.report.page import element, joined, Markup

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
        self.first, self.last = (pick(one.at for one in marks) for pick in (min, max))
        seen = [part for one in marks for part in (one.value, one.low, one.high)]
        seen += [normal - tolerance, normal + tolerance]
        self.low, self.high = (
            pick(one for one in seen if math.isfinite(one)) for pick in (min, max)
        )
        edge = ROOM * (self.high - self.low)
        self.low, self.high = self.low - edge, self.high + (edge or 0.01)

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
        band.append(
            element(
                'rect',
                x=LEFT,
                y=f'{top:.1f}',
                width=WIDTH - LEFT - RIGHT,
                height=f'{bottom - top:.1f}',
                class_='fill-zone',
            )
        )
    places = ' '.join(f'{frame.across(mark.at):.1f},{frame.up(mark.value):.1f}' for mark in marks)
    return element(
        'svg',
        *band,
        *_axes(frame),
        *(_interval(frame, mark) for mark in marks if math.isfinite(mark.low + mark.high)),
        element('polyline', points=places, class_='line-trend'),
        *(_mark(frame, mark) for mark in marks),
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


def _interval(frame: Frame, mark: Mark) -> Markup:
    x = f'{frame.across(mark.at):.1f}'
    low, high = f'{frame.up(mark.low):.1f}', f'{frame.up(mark.high):.1f}'
    return element('line', x1=x, x2=x, y1=low, y2=high, class_='line-interval')


def _mark(frame: Frame, mark: Mark) -> Markup:
    dot = element(
        'circle',
        element('title', mark.title),
        cx=f'{frame.across(mark.at):.1f}',
        cy=f'{frame.up(mark.value):.1f}',
        r='4',
        class_=f'fill-{mark.kind}',
    )
    return joined(dot) if mark.link is None else element('a', dot, href=mark.link)
