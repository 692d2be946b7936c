# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Files of measured raceways: CSV, and areal files of instruments through SurfaceTopography.

The first line of a CSV that is no comment (#) names its columns with their unit, nm, um, mm or m:

    x_um,z_um                                profile along the track; y_um,z_um across it
    x_um,y_um,z_um                           height map, the points of a full grid in any order
    z_um,spacing_x_um=0.5                    profile, one column or one line; or spacing_y_um
    z_um,spacing_x_um=0.5,spacing_y_um=2.0   height map, columns along the track, lines across it

"""

import math
from pathlib import Path
import re

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.files.limits import read_text, TABLE
from surrogate.raceway.measured import measured_surface, MeasuredSurface, Outside

Array = NDArray[np.float64]

UNITS = {'nm': 1e-9, 'um': 1e-6, 'mm': 1e-3, 'm': 1.0}
UNEVEN = 0.01
"""Largest accepted deviation from even spacing, over the spacing [-]."""


def read_surface(
    path: str | Path, *, shortest_wavelength: float | None = None, outside: Outside = 'refuse'
) -> MeasuredSurface:
    """Read a profile or a height map: CSV by its ending, else an areal file; raises InputError."""
    path = Path(path)
    if not path.is_file():
        raise InputError(f'{path}: there is no such file')
    reader = _read_csv if path.suffix.lower() in ('.csv', '.txt') else _read_areal
    heights, spacing_x, spacing_y = reader(path)
    return measured_surface(
        heights,
        spacing_x,
        spacing_y,
        shortest_wavelength=shortest_wavelength,
        outside=outside,
        source=str(path),
    )


def _read_csv(path: Path) -> tuple[Array, float, float]:
    try:
        text = read_text(path, encoding='utf-8-sig', most=TABLE)
    except (OSError, UnicodeDecodeError, InputError) as error:
        raise InputError(f'{path}: cannot be read as text, {error}') from None
    lines = [
        (number, line.strip())
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith('#')
    ]
    if not lines:
        raise InputError(f'{path}: is empty, a line that names the columns comes first')
    columns, spacings = _header(lines[0][1], path)
    table = _numbers(lines[1:], path)
    if len(columns) > 1:
        return _points(table, columns, path)
    heights = table * columns['z']
    if len(spacings) == 2:  # columns along x, lines along y
        return heights.T, spacings['x'], spacings['y']
    if 1 not in heights.shape:
        raise InputError(
            f'{path}: {heights.shape[0]} lines of {heights.shape[1]} heights are a map, which '
            'needs spacing_x and spacing_y in the first line'
        )
    along_x = 'x' in spacings
    gap = spacings['x' if along_x else 'y']
    return heights.reshape((-1, 1) if along_x else (1, -1)), gap, gap


def _header(line: str, path: Path) -> tuple[dict[str, float], dict[str, float]]:
    """Return the units of the columns and the spacings [m] that the first line names."""
    columns: dict[str, float] = {}
    spacings: dict[str, float] = {}
    for word in re.split(r'[,;\s]+', line.strip(',; \t')):
        found = re.fullmatch(r'(spacing_)?([xyz])_([A-Za-zµμ]+)(?:=([-+.\deE]+))?', word)
        if not found or bool(found[1]) != bool(found[4]) or (found[1] and found[2] == 'z'):
            raise InputError(
                f'{path}: the first line has {word!r}, allowed are x_um, y_um, z_um and '
                'spacing_x_um=0.5, spacing_y_um=0.5, with a unit each'
            )
        unit = found[3].replace('µ', 'u').replace('μ', 'u')
        if unit not in UNITS:
            raise InputError(f'{path}: {word} has a wrong unit, allowed are {", ".join(UNITS)}')
        if found[1]:
            spacings[found[2]] = _number(found[4], path, 1) * UNITS[unit]
        else:
            columns[found[2]] = UNITS[unit]
    if list(columns) not in (['x', 'z'], ['y', 'z'], ['x', 'y', 'z'], ['z']) or (
        (len(columns) == 1) != bool(spacings)
    ):
        raise InputError(
            f'{path}: the first line is {line!r}, allowed is x_um,z_um or y_um,z_um or '
            'x_um,y_um,z_um, or z_um with a spacing such as spacing_x_um=0.5'
        )
    return columns, spacings


def _numbers(lines: list[tuple[int, str]], path: Path) -> Array:
    rows: list[list[float]] = []
    for number, line in lines:
        words = re.split(r'\s*[,;]\s*|\s+', line)
        rows.append([_number(word, path, number) for word in words])
        if len(rows[-1]) != len(rows[0]):
            raise InputError(
                f'{path}: line {number} has {len(rows[-1])} numbers, the first has {len(rows[0])}'
            )
    if not rows:
        raise InputError(f'{path}: has no numbers below its first line')
    return np.array(rows)


def _number(word: str, path: Path, line: int) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f'{path}: line {line} has {word!r}, allowed is a finite number')
    return value


def _points(table: Array, columns: dict[str, float], path: Path) -> tuple[Array, float, float]:
    if table.shape[1] != len(columns):
        raise InputError(
            f'{path}: a line has {table.shape[1]} numbers, the first line names {len(columns)}'
        )
    table = table * list(columns.values())
    axes = {
        name: _axis(table[:, column], name, path) for column, name in enumerate(list(columns)[:-1])
    }
    (x, row), (y, column) = (
        axes.get(name, (np.zeros(1), np.zeros(len(table), dtype=int))) for name in 'xy'
    )
    heights = np.full((len(x), len(y)), math.nan)
    heights[row, column] = table[:, -1]
    if heights.size != len(table) or not np.isfinite(heights).all():
        raise InputError(
            f'{path}: {len(table)} points do not fill the {len(x)} x {len(y)} grid of their '
            'places once each'
        )
    gaps = [(axis[-1] - axis[0]) / max(len(axis) - 1, 1) for axis in (x, y)]
    return heights, gaps[0] or gaps[1], gaps[1] or gaps[0]


def _axis(places: Array, name: str, path: Path) -> tuple[Array, NDArray[np.intp]]:
    """Return the sorted places [m] and the number of each point's place."""
    # Places that differ by the rounding of a file are one.
    step = 1e-6 * max(float(np.ptp(places)), 1e-12)
    _, first, row = np.unique(np.round(places / step), return_index=True, return_inverse=True)
    axis = places[first]
    gaps = np.diff(axis)
    if len(gaps) and np.ptp(gaps) > 2 * UNEVEN * gaps.mean():
        raise InputError(
            f'{path}: {name} goes on by {1e6 * gaps.min():.4g} to {1e6 * gaps.max():.4g} um, '
            'allowed is an even spacing'
        )
    return axis, row


def _read_areal(path: Path) -> tuple[Array, float, float]:
    """Read a file of an instrument: heights of shape (nx, ny) and spacings [m]."""
    try:
        from SurfaceTopography import read_topography
    except ImportError:
        raise InputError(
            f'{path}: this kind of file needs SurfaceTopography: pip install SurfaceTopography'
        ) from None
    try:
        topography = read_topography(str(path))
        heights: Array = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), math.nan)
        unit, spacings = topography.unit, np.atleast_1d(topography.pixel_size)
    # A reader of a foreign format may raise anything; what it means is the same.
    except Exception as error:
        raise InputError(f'{path}: cannot be read, {" ".join(str(error).split())}') from None
    unit = str(unit).replace('µ', 'u').replace('μ', 'u')
    if unit not in UNITS:
        raise InputError(f'{path}: its unit is {unit}, allowed are {", ".join(UNITS)}')
    factor = UNITS[unit]
    if heights.ndim == 1:
        heights = heights[:, None]
    return heights * factor, float(spacings[0]) * factor, float(spacings[-1]) * factor
