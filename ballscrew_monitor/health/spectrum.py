# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Motion by load, severity and energy: what life, wear and losses are added up from.

A sample holds until the next one, as in the totals of the judgement. A load that is not known or
only held counts in a band of its own, so that no motion is lost. Severity is the mean pressure
that asperities carry times the speed of sliding, where the surface states the sliding, else that
pressure alone; it is looked up ten times in a second of stamps at most.

`count` keeps to the subset that compiles, as `gather.step` does.

"""

from collections.abc import Iterable
import dataclasses
import itertools
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.bands import (
    LAST_LOAD,
    load_band,
    period_of,
    SEVERITIES,
    severity_class,
    UNKNOWN_LOAD,
)
from ballscrew_monitor.health.records import SpectrumBin
from ballscrew_monitor.health.rows import DAY, has_torque, moves
from ballscrew_monitor.judge.inputs import DERIVED, MEASURED
from ballscrew_monitor.judge.point import NEGATIVE, NO_DIRECTION, opposing_load
from ballscrew_monitor.judge.zone import VALID
from surrogate.surface import look_up, look_up_rest, Surface
from surrogate.surface.records import many
from surrogate.units import TURN

NAN = math.nan
SAMPLING = SECOND // 10  # time between two looks at the severity [ns]
MEAN_PRESSURE = 2.0 / 3.0  # mean over the largest pressure of a Hertzian contact [-]
BANDS = 2 * LAST_LOAD + 2
"""Bands of load from the most negative one on, and the band of loads that are not known."""
CLASSES = len(SEVERITIES) + 1
NO_CLASS = -1


@dataclasses.dataclass(slots=True)
class SpectrumMemory:
    """The sums of one day by band, SI units, and the last sample; stamps [ns]."""

    day: int = 0
    filled: bool = False
    moving: bool = False
    stamp: int = 0
    speed: float = 0.0
    load: float = 0.0
    band: int = 0
    lost: float = NAN  # power [W] by the model, and as measured
    measured: float = NAN
    looked: bool = False
    looked_at: int = 0
    severity: int = NO_CLASS
    time: list[float] = many(BANDS, 0.0)
    angle: list[float] = many(BANDS, 0.0)
    load_angle: list[float] = many(BANDS, 0.0)  # load times angle [N rad]
    energy_lost: list[float] = many(BANDS, 0.0)
    energy_measured: list[float] = many(BANDS, 0.0)
    energy_expected: list[float] = many(BANDS, 0.0)
    measured_time: list[float] = many(BANDS, 0.0)
    wear_time: list[float] = many(BANDS * CLASSES, 0.0)


def sliding_of(surface: Surface) -> float:
    """Return the sliding that a surface states [m/rad], NaN if it does not."""
    return float(surface.header.get('sliding_m_per_rad', NAN))


def count(tables: Any, settings: Any, memory: Any, row: Any, point: Any) -> bool:
    """
    Take a row; return False, and take nothing, where it is of another day than the sums.

    `tables` are those of the surface; `settings` are `GatherSettings` with its sliding; `point` is
    room for a lookup.

    """
    if row.tick:
        return True
    day = row.stamp // DAY
    if memory.filled and memory.day != day:
        return False
    memory.day = day
    span = row.stamp - memory.stamp
    if memory.moving and 0 < span <= settings.max_gap:
        _add_span(memory, span / SECOND)
    memory.stamp = row.stamp
    memory.moving = moves(row) and 0.0 < abs(row.speed) < math.inf
    if memory.moving:
        _set_load(memory, row)
        # What inertia takes and gives back of the power cancels over a cycle.
        known = row.validity == VALID and math.isfinite(row.friction_torque)
        memory.lost = row.friction_torque * memory.speed if known else NAN
        memory.measured = NAN
        if known and has_torque(row) and row.axial_load_source == MEASURED:
            along = 0.0 - row.motor_torque if row.direction == NEGATIVE else row.motor_torque
            memory.measured = (along - memory.load * tables.lead / TURN) * memory.speed
        # A class of severity holds until the next look at it.
        since = row.stamp - memory.looked_at
        if row.validity != VALID or math.isnan(memory.load):
            memory.looked, memory.severity = False, NO_CLASS
        elif not (memory.looked and 0 <= since < SAMPLING):
            memory.looked, memory.looked_at, memory.severity = True, row.stamp, NO_CLASS
            look_up(tables, memory.speed, memory.load, row.temperature, point)
            look_up_rest(tables, memory.load, point)
            severity = point.asperity_share * MEAN_PRESSURE * point.max_pressure
            if math.isfinite(settings.sliding):
                severity *= memory.speed * settings.sliding
            if math.isfinite(severity):
                memory.severity = severity_class(severity)
    return True


def count_many(tables: Any, settings: Any, memory: Any, rows: Any, point: Any, begin: int) -> int:
    """Take rows from `begin` on; return the place of the first one that was not taken."""
    for at in range(begin, len(rows)):
        if not count(tables, settings[0], memory[0], rows[at], point[0]):
            return at
    return len(rows)


def _set_load(memory: Any, row: Any) -> None:
    memory.speed = abs(row.speed)
    source = row.axial_load_source
    known = (source == MEASURED or source == DERIVED) and math.isfinite(row.axial_load)
    if known and row.direction != NO_DIRECTION:
        memory.load = opposing_load(row)
        memory.band = load_band(memory.load) + LAST_LOAD
    else:
        memory.load, memory.band = NAN, BANDS - 1


def _add_span(memory: Any, span: float) -> None:
    """Add a time [s] during which the last sample held."""
    band, angle = memory.band, memory.speed * span
    memory.filled = True
    memory.time[band] += span
    memory.angle[band] += angle
    memory.load_angle[band] += memory.load * angle
    if math.isfinite(memory.lost):
        memory.energy_lost[band] += memory.lost * span
    if math.isfinite(memory.measured):
        memory.measured_time[band] += span
        memory.energy_measured[band] += memory.measured * span
        memory.energy_expected[band] += memory.lost * span
    if memory.severity != NO_CLASS:
        memory.wear_time[band * CLASSES + memory.severity] += span


def take_bins(memory: SpectrumMemory) -> list[SpectrumBin]:
    """Return the bins of the day so far, and begin the sums again."""
    bins = []
    for band in (band for band in range(BANDS) if memory.time[band] > 0.0):
        angle, time, first = memory.angle[band], memory.time[band], band * CLASSES
        known = memory.measured_time[band] > 0.0
        end = first + CLASSES
        bins.append(
            SpectrumBin(
                first_day=memory.day,
                load_band=UNKNOWN_LOAD if band == BANDS - 1 else band - LAST_LOAD,
                axial_load=memory.load_angle[band] / angle if angle > 0.0 else NAN,
                angle=angle,
                speed=angle / time,
                time=time,
                wear_time=tuple(memory.wear_time[first:end]),
                energy_lost=memory.energy_lost[band],
                energy_measured=memory.energy_measured[band] if known else NAN,
                energy_expected=memory.energy_expected[band] if known else NAN,
            )
        )
    for name in _SUMS:
        sums = getattr(memory, name)
        sums[:] = [0.0] * len(sums)
    memory.filled = False
    return bins


_SUMS = [field.name for field in dataclasses.fields(SpectrumMemory) if field.metadata]


def merged_bins(bins: Iterable[SpectrumBin], today: int | None = None) -> list[SpectrumBin]:
    """
    Return bins with those of one period and band added up; older days `today` are merged.

    An energy that is not known adds nothing.

    """
    merged: dict[tuple[int, int, int], SpectrumBin] = {}
    for part in bins:
        first, days = part.first_day, part.days
        if today is not None:
            first, days = period_of(first, days, today)
        key = first, days, part.load_band
        other = merged.get(key)
        if other is None:
            merged[key] = dataclasses.replace(part, first_day=first, days=days)
            continue
        angle, time = other.angle + part.angle, other.time + part.time
        load = other.axial_load * other.angle + part.axial_load * part.angle
        times = itertools.zip_longest(other.wear_time, part.wear_time, fillvalue=0.0)
        energies: dict[str, Any] = {'energy_lost': other.energy_lost + part.energy_lost}
        for name in ('energy_measured', 'energy_expected'):
            pair = getattr(other, name), getattr(part, name)
            known = [energy for energy in pair if not math.isnan(energy)]
            energies[name] = sum(known) if known else NAN
        merged[key] = dataclasses.replace(
            other,
            axial_load=load / angle,
            angle=angle,
            speed=angle / time,
            time=time,
            wear_time=tuple(map(sum, times)),
            **energies,
        )
    return [merged[key] for key in sorted(merged)]
