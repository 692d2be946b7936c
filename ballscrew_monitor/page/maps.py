# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The surface of an axis as a map, at a point, and at other feeds of the motion of the last minutes.

The frame is that of the map of `report.html`: the amount of the speed, and the load that opposes
the motion.

"""

from collections.abc import Mapping, Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import (
    celsius,
    Direction,
    direction_of,
    kelvin,
    opposing_load,
)
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.judge.certainty import Outside, outside_of
from ballscrew_monitor.judge.full_point import answer
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.judge.zone import BY_VALIDITY
from ballscrew_monitor.page.history import COLUMNS
from ballscrew_monitor.page.phrases import phrase, Said, unjudged, violated
from ballscrew_monitor.page.records import UNKNOWN
from ballscrew_monitor.report.map_record import map_line, map_lines, MapLine, NO_NUMBER, zone_cells
from ballscrew_monitor.report.operating_field import (
    Field,
    is_optimal,
    judged_speeds,
    loads_around,
    NAMES,
    sample,
)
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.surface import look_up_many, Surface
from surrogate.units import RPM

Array = NDArray[np.float64]
BANDS = ('band_unknown', 'band_numerical')
"""Kinds of the lines of the two bands of a surface, each with a low and a high edge."""
LONGEST_STEP = 1.0  # [s] between two rows; more is a gap
MOST_POINTS = 2000  # of the path of a ghost
MOST_UNKNOWN = 0.01  # of the time of a ghost, up to which its energy is that of the rest
SPEEDS = 120  # at which the limit of RCS is looked for
BETWEEN = 12  # and then between those two where RCS falls below its limit, both counted
LEAST_RCS = 1e-9  # [-] which has a logarithm
Answer = tuple[dict[str, Any], dict[str, Any]]


def limits_of(record: Mapping[str, Any]) -> Limits:
    """Return the limits in a record of an axis, as far as the zone asks for them."""
    return Limits(
        rcs=record['rcs_limit'],
        efficiency=record['efficiency_limit'],
        light_load=record['light_load_N'],
        standstill_speed=record['standstill_rpm'] * RPM,
        raise_delay=0,
        clear_delay=0,
        hysteresis=0.0,
    )


@dataclasses.dataclass(frozen=True, kw_only=True)
class Motion:
    """Rows in motion in the frame of the map: speed [rad/s], load [N], steps to the next [s]."""

    speed: Array
    load: Array
    steps: Array

    @classmethod
    def of(cls, rows: Array, limits: Limits) -> 'Motion':
        """Return the motion in rows of a history."""
        stamp, speed, load = (rows[:, COLUMNS.index(name)] for name in COLUMNS[:3])
        steps = np.diff(stamp, append=stamp[-1:])
        known = np.isfinite(speed + load) & (np.abs(speed) * RPM >= limits.standstill_speed)
        opposing = np.where(speed > 0.0, -load, load)
        steps = np.where(steps <= LONGEST_STEP, steps, 0.0)
        return cls(
            speed=np.abs(speed[known]) * RPM, load=opposing[known] + 0.0, steps=steps[known]
        )

    def load_span(self) -> tuple[float, float]:
        """Return the least and the largest load [N], NaN without any."""
        return (
            (float(self.load.min()), float(self.load.max())) if self.load.size else (math.nan,) * 2
        )


def map_of(
    surface: Surface, limits: Limits, temperature: float, motion: Motion, quantity: str
) -> Answer:
    """Return the map of a quantity at a temperature [degC], and the time of a motion in it."""
    if quantity not in NAMES:
        raise InputError(f'quantity is {quantity!r}, allowed is {", ".join(NAMES)}')
    speeds = judged_speeds(surface, limits.standstill_speed)
    loads = loads_around(surface, *motion.load_span(), light_load=limits.light_load)
    field = sample(surface, temperature, speeds=speeds, loads=loads)
    zone = zone_cells(field, limits)
    lines = [*map_lines(field, limits, temperature), *_bands(field, surface, limits)]
    lines = [line for line in lines if line.kind != 'rcs_band']
    record = {
        'quantity': quantity,
        'temperature_degC': temperature,
        'speed': {'low': speeds[0] / RPM, 'high': speeds[1] / RPM, 'scale': 'log'},
        'load': {'low': loads[0], 'high': loads[1]},
        'columns': zone.shape[1],
        'rows': zone.shape[0],
        'light_load_N': limits.light_load,
        'lines': [
            {'kind': line.kind, 'label': line.label, 'height': line.height, 'array': f'line{at}'}
            for at, line in enumerate(lines)
        ],
    }
    edges = field.load, field.speed * RPM
    arrays = {
        'cells': getattr(field.middles(), quantity),
        'zone': np.where(zone == NO_NUMBER, math.nan, zone),
        'dwell': np.histogram2d(motion.load, motion.speed, edges, weights=motion.steps)[0],
    }
    return record, arrays | {f'line{at}': line.points for at, line in enumerate(lines)}


def _bands(field: Field, surface: Surface, limits: Limits) -> list[MapLine]:
    """Return low and high edge of the limit of RCS, by all causes and by the numerics alone."""
    return [
        map_line(field, field.rcs, limits.rcs, kind, '', factor=factor)
        for kind, band in zip(BANDS, (surface.onset_band, surface.numerical_band), strict=True)
        for factor in band
        if math.isfinite(factor)
    ]


def limit_speed(
    surface: Surface, limits: Limits, load: float, temperature: float, *, speed: float
) -> float:
    """
    Return the speed [rad/s] at which RCS falls below its limit next to a `speed`, NaN for none.

    The next faster one for a speed in contact, to which advice leads, else the next slower one: a
    corrected surface may have more than one. At an opposing load [N] and a temperature [degC].

    """
    speeds = np.geomspace(*judged_speeds(surface, limits.standstill_speed), SPEEDS)
    excess = _excess(surface, limits, speeds, load, temperature)
    at = np.flatnonzero((excess[:-1] >= 0.0) & (excess[1:] < 0.0))
    # A corrected cell ends steeply: what lies between two of these speeds is looked at again.
    ends = zip(speeds[at], speeds[at + 1], strict=True)
    between = [np.geomspace(slow, fast, BETWEEN)[1:-1] for slow, fast in ends]
    speeds = np.sort(np.concatenate([speeds, *between]))
    excess = _excess(surface, limits, speeds, load, temperature)
    at = np.flatnonzero((excess[:-1] >= 0.0) & (excess[1:] < 0.0))
    part = excess[at] / (excess[at] - excess[at + 1])
    borders = speeds[at] * (speeds[at + 1] / speeds[at]) ** part
    faster, slower = borders[borders >= speed], borders[borders < speed][::-1]
    # Interpolated like the borders, so that a speed beside one is on its right side.
    here = np.interp(math.log(max(speed, speeds[0])), np.log(speeds), excess)
    border = faster if here >= 0.0 else slower
    return float(border[0]) if border.size else math.nan


def _excess(
    surface: Surface, limits: Limits, speeds: Array, load: float, temperature: float
) -> Array:
    """Return the logarithm of RCS over its limit [-] at speeds [rad/s]."""
    rcs = look_up_many(surface, speeds, *_everywhere(speeds, load, kelvin(temperature)))['rcs']
    return np.log(np.maximum(rcs, LEAST_RCS) / limits.rcs)


def limit_record(
    surface: Surface, limits: Limits, row: Array, warmth: float
) -> dict[str, float] | None:
    """
    Return the speed of the limit of RCS [rev/min] at the load of a row.

    None where there is no limit. `warmth` [degC] is that of a row without its own.

    """
    speed, load, heat = (row[COLUMNS.index(name)] for name in COLUMNS[1:4])
    opposing = opposing_load(load, direction_of(speed))
    degrees, turn = warmth if math.isnan(heat) else heat, abs(speed) * RPM
    limit = limit_speed(surface, limits, opposing, degrees, speed=turn) / RPM
    return None if math.isnan(limit) else {'speed_rpm': limit}


def outside_at(
    surface: Surface, limits: Mapping[str, Any], row: Array, warmth: float, *, zone: int
) -> Outside:
    """Return how surely a row of a `zone` is outside; `warmth` [degC] is that of one without."""
    speed, load, heat, efficiency = (row[COLUMNS.index(name)] for name in COLUMNS[1:5])
    return outside_of(
        zone,
        surface,
        rcs_limit=limits['rcs_limit'],
        efficiency_limit=limits['efficiency_limit'],
        speed=abs(speed) * RPM,
        load=opposing_load(load, direction_of(speed)),
        temperature=kelvin(warmth if math.isnan(heat) else heat),
        efficiency=efficiency,
    )


def _everywhere(like: Array, *values: float) -> tuple[Array, ...]:
    return tuple(np.full(like.size, value) for value in values)


def point_of(
    surface: Surface, limits: Limits, speed: float, load: float, temperature: float
) -> dict[str, Any]:
    """Return what the surface says at a speed [rad/s], opposing load [N], temperature [degC]."""
    point = Row(
        speed=abs(speed),
        axial_load=opposing_load(load, Direction.POSITIVE),
        temperature=kelvin(temperature),
        direction=int(Direction.POSITIVE if speed else Direction.UNKNOWN),
    )
    row = answer(point, surface, rcs_limit=limits.rcs)
    zone, words = judged(row.rcs, row.efficiency, load, limits)
    turns, reason = abs(speed) / RPM, BY_VALIDITY[row.validity]
    return {
        'speed_rpm': turns,
        'load_N': load,
        'temperature_degC': temperature,
        'efficiency': row.efficiency,
        'rcs': row.rcs,
        'film_ratio': row.film_ratio,
        'torque_N_m': row.machine_torque,
        'zone': zone,
        'words': words or unjudged(reason, turns, load, temperature),
    }


def judged(rcs: float, efficiency: float, load: float, limits: Limits) -> tuple[str, Said]:
    """Return the zone of numbers at an opposing load [N], and what is wrong with them."""
    if math.isnan(rcs):
        return UNKNOWN, ''
    if rcs >= limits.rcs:
        return 'outside', violated('rcs', rcs, limits.rcs)
    if abs(load) >= limits.light_load and not efficiency >= limits.efficiency:
        return 'outside', violated('efficiency', efficiency, limits.efficiency)
    return 'optimal', phrase('optimal')


def ghosts_of(
    surface: Surface, limits: Limits, motion: Motion, temperature: float, factors: Sequence[float]
) -> Answer:
    """
    Return what a motion comes to at its feed times factors [-], the loads unchanged.

    Share of the judged time outside the zone [-], energy lost [J], and time [s] of each. Where
    more than `MOST_UNKNOWN` of the time is beyond the surface, the energy is NaN; `words` say why.

    """
    ghosts, arrays = [], {}
    for at, factor in enumerate(factors):
        speed = factor * motion.speed
        steps = motion.steps / factor
        (heat,) = _everywhere(speed, kelvin(temperature))
        fields = look_up_many(surface, speed, motion.load, heat)
        known = np.isfinite(fields['rcs'])
        outside = known & ~is_optimal(motion.load, fields['rcs'], fields['efficiency'], limits)
        judged_time, time = steps[known].sum(), steps.sum()
        unknown = float(steps[~known].sum() / time) if time else math.nan
        lost = (fields['friction_torque'] * speed * steps)[known].sum()
        share = steps[outside].sum() / judged_time if judged_time else math.nan
        ghosts.append(
            {
                'factor': factor,
                'outside_share': float(share),
                'lost_J': float(lost) if unknown <= MOST_UNKNOWN else math.nan,
                'duration_s': float(time),
                'unknown_share': unknown,
                'words': _left_out(unknown),
                'array': f'path{at}',
            }
        )
        every = max(1, math.ceil(speed.size / MOST_POINTS))
        arrays[f'path{at}'] = np.column_stack([speed / RPM, motion.load])[::every]
    return {'ghosts': ghosts}, arrays


def _left_out(unknown: float) -> Said:
    """Return what becomes of the part of a motion [-] that no surface knows."""
    if not unknown > 0.0:
        return ''
    key = 'ghost_left_out' if unknown <= MOST_UNKNOWN else 'ghost_not_known'
    return phrase(key, share={'share': unknown})


def oil_temperature(rows: Array, surface: Surface) -> float:
    """Return the last known temperature of rows [degC], else that of the datasheet of the oil."""
    warmth = rows[:, COLUMNS.index('temperature_degC')]
    known = warmth[np.isfinite(warmth)]
    return float(known[-1]) if known.size else celsius(surface.reference_temperature)
