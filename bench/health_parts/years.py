# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Axis-years of known truth as comparable points.

The friction is that of the closed form in the true state of the screw. Beside it stand what the
product does not know: a preload law with another power, a contact warmer than the oil by the
history of its load, friction off by a factor, a wiper that fades with the speed and drifts, a load
sensor off by a per cent, days that differ by one to two per cent, noise by stretch.

"""

import dataclasses
import enum

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.bands import place_of
from ballscrew_monitor.health.points import surface_id
from ballscrew_monitor.health.records import CauseCode, ComparablePoint, Place, Stretch
from ballscrew_monitor.health.rows import DAY
from health_parts.machine import Conditions, Course, friction, Ground
from health_parts.programmes import DAYS, draw_rows, Rows
import numpy as np
from numpy.typing import NDArray
from surrogate.formulas.torque import driving_torque
from surrogate.surface import look_up_many

Array = NDArray[np.float64]
FIRST_DAY = 20_458
"""Day since 1970 on which the years begin, a Monday."""
SEAL_SPEED = 5.0
"""Speed at which the excess of the wiper fades [rad/s]."""
SETTLED = 45
"""Day before which nothing changes: the baseline is learned."""


class Truth(enum.Enum):
    """What changes in a year, with the causes that name it rightly."""

    NOTHING = ()
    PRELOAD_10 = (CauseCode.PRELOAD_LOST, 10)
    PRELOAD_20 = (CauseCode.PRELOAD_LOST, 20)
    PRELOAD_38 = (CauseCode.PRELOAD_LOST, 38)
    OIL_THINNER = (CauseCode.OIL_THINNER, CauseCode.WARMER_THAN_MEASURED)
    OIL_THICKER = (CauseCode.OIL_THICKER,)
    FILM_STARVED = (CauseCode.FILM_STARVED,)
    WIPER = (CauseCode.WIPER,)
    TORQUE_GAIN = (CauseCode.TORQUE_CONSTANT,)


LOSSES = {Truth.PRELOAD_10: 0.10, Truth.PRELOAD_20: 0.20, Truth.PRELOAD_38: 0.38}
COURSES = {
    Truth.OIL_THINNER: Course.THINNER,
    Truth.OIL_THICKER: Course.THICKER,
    Truth.FILM_STARVED: Course.FILM,
}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Kind:
    """What is drawn: the truth, whether the axis creeps, whether its oil is measured."""

    truth: Truth
    creeps: bool = True
    oil_measured: bool = True


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Year:
    """
    A year of points in the order of days, with what is true of it.

    `size` by day: preload lost, share of the film lost, of a new oil, wiper torque added over the
    friction, gain added [-]; of each row its `day`, its `group` of speed, load and direction, and
    its friction with the change and without, `drag` and `drag_before` [N m].

    """

    kind: Kind
    points: tuple[ComparablePoint, ...]
    size: Array
    day: NDArray[np.int64]
    group: NDArray[np.int64]
    drag: Array
    drag_before: Array

    def drag_change(self, first: int, last: int, groups: NDArray[np.int64]) -> float:
        """Return by how much the friction of groups has changed in days, first to last [-]."""
        chosen = (self.day >= first) & (self.day <= last) & np.isin(self.group, groups)
        counts = np.bincount(self.group[chosen])
        kept = counts > 0
        now, before = (
            np.bincount(self.group[chosen], values[chosen])[kept] / counts[kept]
            for values in (self.drag, self.drag_before)
        )
        return float(now.sum() / before.sum() - 1.0) if kept.any() else np.nan

    def groups_until(self, day: int) -> NDArray[np.int64]:
        """Return the groups that were seen before a day."""
        return np.unique(self.group[self.day < day])


def draw_year(ground: Ground, kind: Kind, seed: int) -> Year:
    """Return a year of a kind; the same seed gives the same one."""
    drawn = np.random.default_rng([seed, list(Truth).index(kind.truth), kind.creeps])
    rows = draw_rows(drawn, creeps=kind.creeps)
    size = _course_of(drawn, kind.truth)
    drag, before = _drags(ground, kind.truth, rows, size, drawn)
    day_drawn = drawn.uniform(0.01, 0.02) * drawn.standard_normal((2, DAYS))
    place = np.unique(rows.speed, return_inverse=True)[1]
    own = day_drawn[1][(rows.day * 7 + place * 31) % DAYS]  # of a speed on its day
    scatter = 1.0 + 0.8 * day_drawn[0][rows.day] + 0.6 * own
    gain = 1.0 + (size[rows.day] if kind.truth is Truth.TORQUE_GAIN else 0.0)
    seen = rows.load * (1.0 + drawn.uniform(-0.01, 0.01))
    torque = gain * driving_torque(np.sign(rows.speed) * drag * scatter, -rows.load, 0.010)
    noise = _noise(drawn) * np.stack([np.ones_like(drag), drag])  # [N m]
    spread = np.hypot(*noise)
    torque = torque + spread / np.sqrt(rows.count) * drawn.standard_normal(spread.size)
    squares = spread**2 * drawn.chisquare(np.maximum(rows.count - 1, 1e-9))
    points, places = _points(ground, kind, rows, seen, torque, squares)
    return Year(
        kind=kind,
        points=points,
        size=size,
        day=rows.day,
        group=np.unique(places[:, [0, 1, 3]], axis=0, return_inverse=True)[1].ravel(),
        drag=drag,
        drag_before=before,
    )


def _noise(drawn: np.random.Generator) -> Array:
    """Return the scatter of a stretch at 10 Hz or at 1 kHz: [N m], and over the friction [-]."""
    at_10_hz = drawn.random() < 0.5
    return np.array([[0.005], [0.03]] if at_10_hz else [[0.002], [0.012]])


def _course_of(drawn: np.random.Generator, truth: Truth) -> Array:
    """Return the size of the change by day [-]: in weeks to years, or at once."""
    days = np.arange(DAYS)
    begin = drawn.uniform(SETTLED, 150.0)
    length = np.exp(drawn.uniform(np.log(14.0), np.log(200.0)))
    ramp = np.clip((days - begin) / length, 0.0, 1.0)
    sign = -1.0 if drawn.random() < 0.5 else 1.0
    if truth in LOSSES:
        return LOSSES[truth] * ramp
    if truth in (Truth.OIL_THINNER, Truth.OIL_THICKER):
        return (days >= begin).astype(float)
    if truth is Truth.FILM_STARVED:
        return drawn.uniform(0.3, 0.5) * ramp
    if truth is Truth.WIPER:
        return sign * drawn.uniform(0.2, 0.5) * ramp
    if truth is Truth.TORQUE_GAIN:
        return sign * drawn.uniform(0.06, 0.15) * ramp
    return 0.0 * ramp


def _drags(
    ground: Ground, truth: Truth, rows: Rows, size: Array, drawn: np.random.Generator
) -> tuple[Array, Array]:
    """Return the friction torque of each row [N m], with the change and without."""
    speed, now = np.abs(rows.speed), size[rows.day]
    warmer = drawn.uniform(0.0, 8.0) * rows.heat
    where = Conditions(speed=speed, load=np.abs(rows.load), temperature=rows.oil + warmer)
    off, power = drawn.uniform(0.85, 1.15), drawn.uniform(0.8, 1.2)
    before = after = off * friction(ground, Course.PRELOAD, np.ones_like(speed), where)
    if truth in LOSSES:
        changed = friction(ground, Course.PRELOAD, 1.0 - now, where)
        after = off * changed * (1.0 - now) ** (power - 1.0)
    elif truth in COURSES:
        state = 1.0 - now if truth is Truth.FILM_STARVED else now
        after = off * friction(ground, COURSES[truth], state, where)
    wiper = drawn.uniform(0.02, 0.08) * _wander(drawn, 0.05)[rows.day]
    wiper = wiper * (1.0 + drawn.uniform(0.0, 0.5) * _faded(drawn, speed, rows))
    added = now * np.mean(before) if truth is Truth.WIPER else 0.0
    return after + wiper + added, before + wiper


def _faded(drawn: np.random.Generator, speed: Array, rows: Rows) -> Array:
    """Return the excess of the wiper at low speed [-], which drifts."""
    return np.asarray(np.exp(-speed / SEAL_SPEED) * _wander(drawn, 0.2)[rows.day])


def _wander(drawn: np.random.Generator, far: float) -> Array:
    """Return a factor by day that wanders by about `far` in a year [-]."""
    return np.asarray(np.exp(np.cumsum(drawn.normal(0.0, far / np.sqrt(DAYS), DAYS))))


def _points(
    ground: Ground, kind: Kind, rows: Rows, load: Array, torque: Array, squares: Array
) -> tuple[tuple[ComparablePoint, ...], NDArray[np.int64]]:
    """Return the points of all days, and the place of each row; the load is that of its sensor."""
    surface = ground.surfaces[1.0]
    along = np.sign(rows.speed)
    oil = rows.oil if kind.oil_measured else np.full_like(rows.oil, np.median(rows.oil))
    found = look_up_many(surface, np.abs(rows.speed), -along * load, oil)
    residual = torque - along * found['driving_torque']
    places = np.array(
        [
            place_of(
                Stretch(
                    start=(FIRST_DAY + int(day)) * DAY + 8 * 3600 * SECOND,
                    duration=1.0,
                    samples=10,
                    speed=float(speed),
                    axial_load=float(force),
                    temperature=float(heat),
                    motor_torque=0.0,
                )
            )
            for day, speed, force, heat in zip(rows.day, rows.speed, load, oil, strict=True)
        ]
    )
    keys = np.column_stack([rows.day, places])
    unique, inverse = np.unique(keys, axis=0, return_inverse=True)
    inverse = inverse.ravel()
    count = np.bincount(inverse, rows.count)

    def mean(values: Array) -> Array:
        return np.bincount(inverse, rows.count * values) / count

    means = {
        'speed': mean(rows.speed),
        'axial_load': mean(load),
        'temperature': mean(oil),
        'motor_torque': mean(torque),
        'residual': mean(residual),
    }
    apart = (residual - means['residual'][inverse]) ** 2
    total = np.bincount(inverse, squares + rows.count * apart)
    spent = np.bincount(inverse, rows.count * rows.duration)
    points = tuple(
        ComparablePoint(
            first_day=FIRST_DAY + int(key[0]),
            place=Place(*map(int, key[1:])),
            surface=surface_id(surface),
            stretches=int(count[i]),
            duration=float(spent[i]),
            torque_squares=float(total[i]),
            temperature_measured=kind.oil_measured,
            **{name: float(values[i]) for name, values in means.items()},
        )
        for i, key in enumerate(unique)
    )
    return points, places
