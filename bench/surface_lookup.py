# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time the surface lookup and show it as a multiple of one Python call.

Usage: python bench/surface_lookup.py [FILE]. Times are the best of several repeats; the ratio to
an empty call, measured in the same run, is the number that must not rot.

"""

import math
from pathlib import Path
import random
import sys
import timeit
import tracemalloc

from surrogate.surface import shipped_surface, Surface

POINTS, REPEATS = 5000, 7


def seconds(statement, number: int) -> float:
    """Return the best time of one run of `statement` [s]."""
    return min(timeit.repeat(statement, number=number, repeat=REPEATS)) / number


def random_points(surface: Surface) -> list[tuple[float, float, float]]:
    """Return points all over the surface, always the same ones."""
    drawn = random.Random(1)
    slow, fast = surface.speed_range
    return [
        (
            math.exp(drawn.uniform(math.log(slow), math.log(fast))),
            drawn.uniform(*surface.load_range),
            drawn.uniform(*surface.temperature_range),
        )
        for _ in range(POINTS)
    ]


def read_all(surface: Surface, point: tuple[float, float, float]) -> tuple[object, ...]:
    """Look up one point and read every number that the node publishes."""
    found = surface.lookup(*point)
    return (
        found.validity,
        found.efficiency,
        found.friction_torque,
        found.driving_torque,
        found.back_driving,
        found.rcs,
        found.asperity_share,
        found.film_ratio,
        found.central_film,
        found.minimum_film,
        found.friction_coefficient,
        found.max_pressure,
        found.worst_nut,
        found.worst_side,
        found.efficiency_error,
        found.rcs_error,
    )


def memory(path: Path) -> int:
    """Return the bytes that a loaded surface keeps."""
    tracemalloc.start()
    surface = Surface.load(path)
    kept = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert surface.sha256
    return kept


def main() -> None:
    """Print the table."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else shipped_surface()
    surface = Surface.load(path)
    points, here = random_points(surface), (62.8, 1000.0, 313.15)

    def scattered() -> None:
        for point in points:
            surface.lookup(*point)

    call = seconds(lambda: None, 100_000)
    rows = [
        ('one Python call', call),
        ('lookup, one point again and again', seconds(lambda: surface.lookup(*here), 20_000)),
        ('lookup, points all over the surface', seconds(scattered, 1) / POINTS),
        (
            'lookup and every number the node needs',
            seconds(lambda: read_all(surface, here), 20_000),
        ),
        ('load and verify the file', seconds(lambda: Surface.load(path), 5)),
    ]
    print(f'{"":40} {"microseconds":>12} {"calls":>10}')
    for name, time in rows:
        print(f'{name:40} {1e6 * time:12.2f} {time / call:10.0f}')
    size = path.stat().st_size
    kept = memory(path)
    print(f'file {size} bytes, memory {kept} bytes: {kept / size:.2f} times the file')


if __name__ == '__main__':
    main()
