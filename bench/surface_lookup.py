# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time the surface lookup and show it as a multiple of one Python call.

Usage: python bench/surface_lookup.py [FILE]. Processor times are the best of several repeats; the
ratio to an empty call, measured in the same run, is the number that must not rot.

"""

import math
from pathlib import Path
import random
import sys
import time
import timeit
import tracemalloc

import numpy as np
from surrogate.surface import Found, look_up, look_up_many, shipped_surface, Surface

POINTS, REPEATS = 5000, 7


def seconds(statement, number: int) -> float:
    """Return the best processor time of one run of `statement` [s]."""
    timer = time.process_time
    return min(timeit.repeat(statement, number=number, repeat=REPEATS, timer=timer)) / number


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


def compiled_time(surface: Surface, points: list[tuple[float, float, float]]) -> float:
    """Return the time of one point of many in compiled code, with every number [s]."""
    columns = [np.array(column) for column in zip(*points, strict=True)]
    look_up_many(surface, *columns)
    return seconds(lambda: look_up_many(surface, *columns), 1) / len(points)


def memory(path: Path) -> tuple[int, int]:
    """Return the bytes that a surface keeps when it is loaded, and when it has looked up."""
    tracemalloc.start()
    surface = Surface.load(path)
    loaded = tracemalloc.get_traced_memory()[0]
    surface.lookup(62.8, 1000.0, 313.15)
    used = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    return loaded, used


def main() -> None:
    """Print the table."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else shipped_surface()
    surface = Surface.load(path)
    points, here = random_points(surface), (62.8, 1000.0, 313.15)
    tables, found = surface.tables, Found()

    def scattered() -> None:
        for point in points:
            look_up(tables, *point, found)

    call = seconds(lambda: None, 100_000)
    rows = [
        ('one Python call', call),
        ('judged numbers, points all over', seconds(scattered, 1) / POINTS),
        ('every number, interpreted', seconds(lambda: surface.lookup(*here), 5000)),
        ('every number, compiled, points all over', compiled_time(surface, points)),
        ('load and verify the file', seconds(lambda: Surface.load(path), 5)),
    ]
    print(f'{"":40} {"microseconds":>12} {"calls":>10}')
    for name, taken in rows:
        print(f'{name:40} {1e6 * taken:12.2f} {taken / call:10.0f}')
    size = path.stat().st_size
    loaded, used = memory(path)
    print(f'file {size} bytes, memory {loaded} bytes loaded, {used} bytes in use')


if __name__ == '__main__':
    main()
