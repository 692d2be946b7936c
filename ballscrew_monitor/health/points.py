# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Comparable points: stretches of one place, one day and one surface, and older days merged.

Every stretch counts once, whatever its length. Means and squares are pooled exactly, so that the
order of merging changes nothing but roundings, and no stretch is lost or counted twice.

"""

from collections import Counter
from collections.abc import Iterable, MutableMapping
import dataclasses
import datetime
import math
from typing import NamedTuple

from ballscrew_monitor.core.conversions import direction_of, opposing_load, signed
from ballscrew_monitor.health.bands import day_of, FIRST_DAY, period_of, place_of
from ballscrew_monitor.health.records import ComparablePoint, LoadSource, Place, Stretch
from surrogate.surface import Surface

MOST_PLACES = 400
"""Places in one period; those with the fewest stretches go first."""
SURFACE_DIGITS = 16
"""Digits of the hash of a surface without its corrections."""
MEANS = ('speed', 'axial_load', 'temperature', 'motor_torque', 'residual')


class Key(NamedTuple):
    """What tells points apart: period [days], place, surface and sources."""

    first_day: int
    days: int
    place: Place
    surface: str
    load_source: LoadSource
    temperature_measured: bool


Points = MutableMapping[Key, ComparablePoint]
"""Points by what tells them apart."""


class Aged(NamedTuple):
    """
    Points with older days merged.

    `future` are those of days to come, which do not count; `dropped` counts points of too many
    places; `notes` say both.

    """

    points: tuple[ComparablePoint, ...]
    future: tuple[ComparablePoint, ...]
    dropped: int
    notes: tuple[str, ...]


def key_of(point: ComparablePoint) -> Key:
    """Return what tells a point from others."""
    return Key(**{name: getattr(point, name) for name in Key._fields})


def by_place(points: Iterable[ComparablePoint]) -> dict[Key, ComparablePoint]:
    """Return points by what tells them apart; those that nothing tells apart are merged."""
    found: dict[Key, ComparablePoint] = {}
    for point in points:
        _put(found, point)
    return found


def surface_id(surface: Surface) -> str:
    """Return what points remember of a surface: full solves that correct it make no other one."""
    return surface.base_sha256[:SURFACE_DIGITS]


def model_torque(surface: Surface, speed: float, axial_load: float, temperature: float) -> float:
    """
    Return the driving torque [N m] of the model in the machine frame, NaN outside the surface.

    speed [rad/s] with its sign, axial_load [N, machine frame], temperature [K].

    """
    direction = direction_of(speed)
    opposing = opposing_load(axial_load, direction)
    found = surface.lookup(abs(speed), opposing, temperature)
    return signed(found.driving_torque, direction)


def add(points: Points, stretch: Stretch, surface: Surface, today: int | None = None) -> str:
    """
    Add a stretch to the points of its day; return in a sentence why it does not count, or ''.

    `today` is the day of the clock since 1970, by which stamps are checked where it is known.

    """
    day = day_of(stretch.start)
    why = _why_not(stretch, day, today)
    if why:
        return why
    model = model_torque(surface, stretch.speed, stretch.axial_load, stretch.temperature)
    if not math.isfinite(stretch.motor_torque - model):
        return 'a stretch does not count: the surface has no torque at its mean speed and load'
    point = ComparablePoint(
        first_day=day,
        place=place_of(stretch),
        surface=surface_id(surface),
        stretches=1,
        duration=stretch.duration,
        speed=stretch.speed,
        axial_load=stretch.axial_load,
        temperature=stretch.temperature,
        motor_torque=stretch.motor_torque,
        residual=stretch.motor_torque - model,
        load_source=LoadSource(stretch.load_source),
        temperature_measured=stretch.temperature_measured,
    )
    is_new = key_of(point) not in points
    _put(points, point)
    if is_new and _drop_rare(points, (day, 1)):
        return f'a stretch does not count: the day has {MOST_PLACES} places already'
    return ''


def _why_not(stretch: Stretch, day: int, today: int | None) -> str:
    if stretch.load_source == LoadSource.DERIVED:
        return 'a stretch does not count: its load follows from its torque'
    return clock_objection(day, today)


def clock_objection(day: int, today: int | None) -> str:
    """Return in a sentence why motion of a `day` cannot be of `today`, both since 1970, or ''."""
    if day < FIRST_DAY:
        return f'motion of {date_text(day)} does not count: the clock was not set'
    if today is not None and abs(day - today) > 1:
        return (
            f'motion of {date_text(day)} does not count: the clock says {date_text(today)}, '
            'one day off is allowed'
        )
    return ''


def date_text(day: int) -> str:
    """Return a day since 1970 for people, UTC."""
    try:
        return f'{datetime.date(1970, 1, 1) + datetime.timedelta(days=day)}'
    except OverflowError:
        return f'day {day}'


def merged(one: ComparablePoint, other: ComparablePoint) -> ComparablePoint:
    """Return two points of one key as one: pooled means, and squares about the pooled mean."""
    stretches = one.stretches + other.stretches
    share = other.stretches / stretches
    # Of points that know no residual, what the torques differ by is an upper bound.
    name = 'residual' if math.isfinite(one.residual - other.residual) else 'motor_torque'
    between = getattr(other, name) - getattr(one, name)
    squares = one.torque_squares + other.torque_squares
    means = {
        name: getattr(one, name) + share * (getattr(other, name) - getattr(one, name))
        for name in MEANS
    }
    return dataclasses.replace(
        one,
        stretches=stretches,
        duration=one.duration + other.duration,
        torque_squares=squares + one.stretches * share * between * between,
        **means,
    )


def aged(points: Iterable[ComparablePoint], today: int) -> Aged:
    """
    Return points with days merged into weeks and weeks into periods of 28 days by their age.

    `today` in days since 1970. Points of days to come are left out, and as they are.

    """
    found: dict[Key, ComparablePoint] = {}
    future = []
    for point in points:
        if point.first_day > today + 1:
            future.append(point)
            continue
        first_day, days = period_of(point.first_day, point.days, today)
        _put(found, dataclasses.replace(point, first_day=first_day, days=days))
    periods = Counter((key.first_day, key.days) for key in found)
    dropped = sum(
        _drop_rare(found, period) for period, places in periods.items() if places > MOST_PLACES
    )
    notes = []
    if future:
        first = date_text(min(point.first_day for point in future))
        notes.append(
            f'{len(future)} points from {first} on do not count: the clock says {date_text(today)}'
        )
    if dropped:
        notes.append(f'{dropped} rare places left out, a period holds {MOST_PLACES}')
    return Aged(tuple(found[key] for key in sorted(found)), tuple(future), dropped, tuple(notes))


def _put(points: Points, point: ComparablePoint) -> None:
    key = key_of(point)
    points[key] = merged(points[key], point) if key in points else point


def _drop_rare(points: Points, period: tuple[int, int]) -> int:
    """Drop the places with the fewest stretches above the limit of a period; return how many."""
    keys = [key for key in points if key[:2] == period]
    rare = sorted(keys, key=lambda key: -points[key].stretches)[MOST_PLACES:]
    for key in rare:
        del points[key]
    return len(rare)
