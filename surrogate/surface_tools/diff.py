# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Two surfaces compared where both answer: inputs, axes, fields, and the limits of the zone."""

from collections.abc import Iterator, Mapping
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.surface import FIELDS, Surface, SurfaceError, Validity
from surrogate.surface.aims import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT
from surrogate.surface.file import SurfaceData
from surrogate.surface_tools.fields import FIELD_TEXTS

Array = NDArray[np.float64]

SPEEDS = 40
"""Speeds in equal ratios at which fields are compared [-]."""
LINES = (31, 7)
"""Loads and temperatures at which the limits of the zone are compared [-]."""
SCAN, BISECTIONS = 50, 20
"""Speeds per line of the search for the zone, and halvings of the step in which it ends [-]."""
LONGEST = 40
"""Characters of a value of a header that a page shows [-]."""
Ranges = tuple[tuple[float, float], tuple[float, float], tuple[float, float]]


def diff_record(first: SurfaceData, second: SurfaceData) -> dict[str, Any]:
    """
    Return how the second surface differs from the first; SurfaceError without common ranges.

    SI units. Fields are compared in every cell over the common ranges, efficiency and zone where
    the load is at least a quarter of the preload.

    """
    surfaces = (Surface(first), Surface(second))
    common = []
    for name in ('speed_range', 'load_range', 'temperature_range'):
        (low, high), (other_low, other_high) = (getattr(surface, name) for surface in surfaces)
        low, high = max(low, other_low), min(high, other_high)
        if not low < high:
            raise SurfaceError(f'the surfaces have no {name.replace("_", " ")} in common')
        common.append((low, high))
    ranges = common[0], common[1], common[2]
    slow, fast = (math.log(speed) for speed in ranges[0])
    # The exponential rounds, and an end that is passed by a rounding has no answer.
    speeds = np.clip(np.exp(np.linspace(slow, fast, SPEEDS)), *ranges[0]).tolist()
    loads = _middles(first.load, second.load, ranges[1])
    kelvins = _middles(first.temperature, second.temperature, ranges[2])
    lattice = [(w, force, kelvin) for kelvin in kelvins for force in loads for w in speeds]
    return {
        'sha256': [surface.sha256 for surface in surfaces],
        'inputs': list(_differences(first.header, second.header)),
        'axes': {
            name: [_axis(data, name) for data in (first, second)]
            for name in ('speed_coordinate', 'load', 'temperature')
        },
        'common_speed_rad_s': list(ranges[0]),
        'common_load_N': list(ranges[1]),
        'common_temperature_K': list(ranges[2]),
        **_compare_fields(*surfaces, lattice),
        'zone': _compare_zones(*surfaces, ranges),
    }


def _axis(data: SurfaceData, name: str) -> dict[str, Any]:
    nodes = getattr(data, name)
    return {'nodes': len(nodes), 'low': float(nodes[0]), 'high': float(nodes[-1])}


def _differences(first: Any, second: Any, where: str = '') -> Iterator[dict[str, Any]]:
    """Yield what differs between two headers, by its path."""
    if isinstance(first, Mapping) and isinstance(second, Mapping):
        for key in sorted({*first, *second}):
            yield from _differences(
                first.get(key), second.get(key), f'{where}.{key}' if where else key
            )
    elif first != second:
        yield {'what': where, 'first': first, 'second': second}


def _compare_fields(
    first: Surface, second: Surface, lattice: list[tuple[float, float, float]]
) -> dict[str, Any]:
    """Return largest and 95th percentile of the difference per field, and where it is largest."""
    points, one_sided = [], 0
    gaps: dict[str, list[float]] = {name: [] for name in (*FIELDS, 'efficiency')}
    for point in lattice:
        here, there = first.lookup(*point), second.lookup(*point)
        valid = [answer.validity is Validity.VALID for answer in (here, there)]
        one_sided += valid[0] != valid[1]
        if not all(valid):
            continue
        points.append(point)
        for name, gap in gaps.items():
            gap.append(abs(getattr(here, name) - getattr(there, name)))
        if abs(point[1]) < LIGHT_LOAD * max(first.preload, second.preload):
            gaps['efficiency'][-1] = math.nan
    return {
        'points': len(points),
        'answered_by_one_only': one_sided,
        'fields': {name: _summary(gap, points) for name, gap in gaps.items()},
    }


def _middles(first: Array, second: Array, ends: tuple[float, float]) -> list[float]:
    middles = {0.5 * (low + high) for axis in (first, second) for low, high in zip(axis, axis[1:])}
    return sorted({*ends, *(float(node) for node in middles if ends[0] < node < ends[1])})


def _summary(gaps: list[float], points: list[tuple[float, float, float]]) -> dict[str, Any]:
    values = np.asarray(gaps)
    known = values[np.isfinite(values)]
    if not known.size:
        return {'max': math.nan, 'p95': math.nan, 'at': []}
    worst = int(np.nanargmax(values))
    return {
        'max': float(known.max()),
        'p95': float(np.quantile(known, 0.95)),
        'at': list(points[worst]),
    }


def _compare_zones(first: Surface, second: Surface, ranges: Ranges) -> dict[str, Any]:
    """Return how far the slow and the fast limit of the zone move, as a ratio of speeds less 1."""
    light = LIGHT_LOAD * max(first.preload, second.preload)
    shifts: list[tuple[float, float]] = []
    lines = one_sided = 0
    for load in np.linspace(*ranges[1], LINES[0]).tolist():
        for kelvin in np.linspace(*ranges[2], LINES[1]).tolist():
            if abs(load) < light:
                continue
            lines += 1
            limits = [zone_limits(surface, load, kelvin, ranges[0]) for surface in (first, second)]
            one_sided += (limits[0] is None) != (limits[1] is None)
            if limits[0] is not None and limits[1] is not None:
                shifts.append(
                    (_shift(limits[0][0], limits[1][0]), _shift(limits[0][1], limits[1][1]))
                )
    return {
        'lines': lines,
        'in_one_only': one_sided,
        'largest_shift_slow': max((slow for slow, _ in shifts), default=math.nan),
        'largest_shift_fast': max((fast for _, fast in shifts), default=math.nan),
    }


def _shift(speed: float, other: float) -> float:
    return max(speed / other, other / speed) - 1.0


def zone_limits(
    surface: Surface, load: float, temperature: float, speed_range: tuple[float, float]
) -> tuple[float, float] | None:
    """
    Return the slowest and the fastest speed [rad/s] of the optimal zone, or None without a zone.

    At an opposing load [N] and a temperature [K], RCS < 0.01 and efficiency >= 0.85.

    """

    def is_optimal(log_speed: float) -> bool:
        speed = min(max(math.exp(log_speed), speed_range[0]), speed_range[1])
        point = surface.lookup(speed, load, temperature)
        return point.rcs < RCS_LIMIT and point.efficiency >= EFFICIENCY_LIMIT

    slow, fast = (math.log(speed) for speed in speed_range)
    scan = np.linspace(slow, fast, SCAN).tolist()
    inside = [is_optimal(log_speed) for log_speed in scan]
    if not any(inside):
        return None
    begin, end = inside.index(True), SCAN - 1 - inside[::-1].index(True)
    limits = [scan[begin], scan[end]]
    for place, (good, bad) in enumerate(((begin, begin - 1), (end, end + 1))):
        if not 0 <= bad < SCAN:
            continue
        inner, outer = scan[good], scan[bad]
        for _ in range(BISECTIONS):
            middle = 0.5 * (inner + outer)
            if is_optimal(middle):
                inner = middle
            else:
                outer = middle
        limits[place] = inner
    return math.exp(limits[0]), math.exp(limits[1])


def exceeded(record: Mapping[str, Any], tolerances: Mapping[str, float]) -> list[str]:
    """Return one sentence per difference that exceeds its tolerance; NaN exceeds."""
    zone = record['zone']
    differences = {
        'efficiency': record['fields']['efficiency']['max'],
        'rcs': record['fields']['rcs']['max'],
        'zone': max(zone['largest_shift_slow'], zone['largest_shift_fast']),
    }
    if not zone['lines'] or math.isnan(differences['zone']):
        differences.pop('zone')
    sentences = [
        f'{name} differs by {value:.3g}, allowed is {tolerances[name]:g}'
        for name, value in differences.items()
        if not value <= tolerances[name]
    ]
    if record['answered_by_one_only']:
        sentences.append(
            f'{record["answered_by_one_only"]} points are answered by one surface only'
        )
    if zone['in_one_only']:
        sentences.append(f'{zone["in_one_only"]} lines have a zone on one surface only')
    return sentences


def diff_page(record: Mapping[str, Any], sentences: list[str]) -> str:
    """Return the record as a page."""
    lines = [f'A {record["sha256"][0]}', f'B {record["sha256"][1]}']
    if not record['inputs']:
        lines.append('inputs and settings: the same')
    lines += [
        f'{item["what"]}: {_short(item["first"])} in A, {_short(item["second"])} in B'
        for item in record['inputs']
    ]
    for name, (first, second) in record['axes'].items():
        lines.append(
            f'{name.replace("_", " ")}: {first["nodes"]} nodes {first["low"]:.4g} to '
            f'{first["high"]:.4g} in A, {second["nodes"]} nodes {second["low"]:.4g} to '
            f'{second["high"]:.4g} in B'
        )
    lines.append(f'{"difference at " + str(record["points"]) + " points":44} max         p95')
    for name, gap in record['fields'].items():
        unit = (FIELD_TEXTS[name].unit if name in FIELD_TEXTS else '') or '-'
        lines.append(f'  {name + " [" + unit + "]":42} {gap["max"]:<10.3g}  {gap["p95"]:.3g}')
    zone = record['zone']
    lines.append(
        f'limits of the zone move by up to {100 * zone["largest_shift_slow"]:.2g} % (slow) and '
        f'{100 * zone["largest_shift_fast"]:.2g} % (fast) of the speed, {zone["lines"]} lines'
    )
    return '\n'.join([*lines, *sentences] if sentences else [*lines, 'within the tolerances'])


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= LONGEST else f'{text[:LONGEST]} ...'
