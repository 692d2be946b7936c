# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lookup of many points at once: the lookup of one, compiled where numba is there."""

from collections.abc import Callable
import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.compiled import compiled
from surrogate.surface.interpolate import Found, look_up, look_up_rest
from surrogate.surface.lookup import Surface
from surrogate.surface.records import dtype_of
from surrogate.surface.tables import SurfaceTables

Array = NDArray[np.float64]
FOUND = dtype_of(Found)


def look_up_many(
    surface: Surface, speed: Array, opposing_load: Array, temperature: Array
) -> NDArray[Any]:
    """
    Return an array of `Found`: what `Surface.lookup` says of each point, to the last bit.

    Speeds |w| [rad/s], opposing loads [N], temperatures [K].

    """
    points = [np.ascontiguousarray(each, dtype=float) for each in (speed, opposing_load)]
    points.append(np.ascontiguousarray(temperature, dtype=float))
    rows = np.zeros(len(speed), dtype=FOUND)
    try:
        fill = _compiled()
    except ImportError:
        answers = [Found() for _ in rows]
        speeds, loads, heats = (each.tolist() for each in points)
        fill_rows(surface.tables, speeds, loads, heats, answers)
        for name in rows.dtype.names or ():
            rows[name] = [getattr(answer, name) for answer in answers]
    else:
        fill(surface.array_tables, *points, rows)
    return rows


def fill_rows(
    tables: SurfaceTables, speed: Any, opposing_load: Any, temperature: Any, rows: Any
) -> None:
    """Look up points [rad/s, N, K], each into its row."""
    for at in range(len(rows)):
        look_up(tables, speed[at], opposing_load[at], temperature[at], rows[at])
        look_up_rest(tables, opposing_load[at], rows[at])


@functools.cache
def _compiled() -> Callable[..., Any]:
    return compiled(fill_rows)
