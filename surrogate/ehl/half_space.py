# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Deformation of the elastic half-space: influence of a pressed rectangle and its fast convolution.

Arrays have x along the first axis and y along the second. A symmetric half-space carries the half
y >= 0 in columns 1 on and keeps column 0 for the mirror image at y = -dy; otherwise all columns
are nodes. The pressure is zero in the last row, in the first row and in the last column (and in
the first column if not symmetric), as on every contact grid here, so that lengths of about twice
the grid are enough. A periodic half-space repeats its columns 1 to the last but one for ever; the
first and the last column are copies.

"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray
from surrogate.compiler import njit
from surrogate.ehl.kernels.fft import Fft, fft_forward, fft_inverse, good_length, make_fft

Array = NDArray[np.floating]
MOST_LANES = 128
"""Pairs of rows that one transform along y takes at a time, at most."""

IMAGES = 20
"""Images of a periodic load on each side that are summed up one by one [-]."""

BLOCK = 8
"""Lanes that are turned from rows into columns together."""


class HalfSpace(NamedTuple):
    """
    Spectrum, tables and work space of a convolution; `symbol` in natural order.

    Tables of y and x, spectrum in the order of the transforms (two planes), scratch (real,
    imaginary) of both transforms, and whether the half y >= 0 stands for all, or a period.

    """

    y: Fft
    x: Fft
    spectrum: Array
    tile: Array
    columns: Array
    symmetric: bool
    periodic: bool
    near: Array


def influence_love_1929(x: Array, y: Array, dx: float, dy: float) -> Array:
    """
    Return the integral of 1/r over a dx by dy rectangle at the origin, seen from (x, y) [length].

    Sum over the corners of a asinh(b/|a|) + b asinh(a/|b|): Love, Phil. Trans. A 228 (1929) 377.

    """

    def corner(a: Array, b: Array) -> Array:
        size_a, size_b = np.abs(a), np.abs(b)
        return np.asarray(
            a * np.arcsinh(b / np.where(size_a > 0, size_a, 1))
            + b * np.arcsinh(a / np.where(size_b > 0, size_b, 1))
        )

    west, east, south, north = x - dx / 2, x + dx / 2, y - dy / 2, y + dy / 2
    return corner(east, north) - corner(east, south) - corner(west, north) + corner(west, south)


def make_half_space(
    nx: int,
    ny: int,
    dx: float,
    dy: float,
    *,
    symmetric: bool,
    periodic: bool = False,
    scale: float = 1.0,
    dtype: DTypeLike = np.float64,
) -> HalfSpace:
    """
    Prepare `scale` times the influence of all nodes of an (nx, ny) array on each other.

    Periodic across, it is but for a constant: the deflection under a load without end has none.
    The number of columns less two is then a length of the transforms.

    """
    length_x = good_length(2 * nx - 3)
    length_y = good_length(4 * (ny - 1) - 5 if symmetric else 2 * ny - 3)
    if periodic:
        length_y = ny - 2
        assert length_y == good_length(length_y)
    # The kernel is homogeneous of degree one: only the shape of a cell matters, but for a factor.
    symbol = scale * dx * _symbol(length_x, length_y, float(f'{dy / dx:.12g}'), periodic)
    if periodic:  # the constant left out must not depend on the grid
        symbol[0, 0] -= scale * dx * 2 * length_x * np.log(dx)
    x, y = make_fft(length_x, dtype), make_fft(length_y, dtype)
    spectrum = (symbol / (length_x * length_y))[None]
    if symmetric:  # (Ga + Gb)/2 and (Ga - Gb)/2 of real columns a, b in one
        half = (spectrum.shape[2] + 1) // 2
        first, second = spectrum[0, :, :half], np.zeros_like(spectrum[0, :, :half])
        second[:, : spectrum.shape[2] - half] = spectrum[0, :, half:]
        spectrum = np.stack([first + second, first - second]) / 2
    # The 3x3 kernel k00, k10, k01, k11 equals the symbol at (pi/2, pi/2), (pi, pi/2), (pi/2, pi)
    # and (pi, pi): a truncated one would be indefinite on elongated cells.
    quarter_x, quarter_y = round(length_x / 4), round((symbol.shape[1] - 1) / 2)
    both, fast_x = symbol[quarter_x, quarter_y], symbol[length_x // 2, quarter_y]
    fast_y, fastest = symbol[quarter_x, length_y // 2], symbol[length_x // 2, length_y // 2]
    k10, k01 = (both - fast_x) / 2, (both - fast_y) / 2
    near = np.array([both, k10, k01, (fastest - both + 2 * k10 + 2 * k01) / 4])
    ordered = np.empty_like(spectrum)
    ordered[:, x.place] = spectrum
    columns = spectrum.shape[2]
    tiles = -(-nx // (2 * MOST_LANES))
    lanes = -(-nx // (2 * tiles))
    return HalfSpace(
        y=y,
        x=x,
        spectrum=ordered.astype(dtype),
        symmetric=symmetric,
        periodic=periodic,
        tile=np.zeros((2, length_y, lanes), dtype),
        near=near.astype(dtype),
        columns=np.zeros((2, length_x, columns), dtype),
    )


@lru_cache(maxsize=32)
def _symbol(length_x: int, length_y: int, aspect: float, periodic: bool) -> Array:
    """Return the spectrum of the kernel between cells of size 1 by `aspect`."""
    lag_x, lag_y = 1.0 * np.arange(length_x // 2 + 1), aspect * np.arange(length_y // 2 + 1)
    x, y = lag_x[:, None], lag_y[None, :]
    if periodic:  # the cell and its images every `width`, less a constant
        width = length_y * aspect
        quarter: Array = np.zeros(np.broadcast_shapes(x.shape, y.shape))
        for image in range(-IMAGES, IMAGES + 1):
            quarter += influence_love_1929(x, y + image * width, 1.0, aspect)
        # Beyond them the load is spread evenly, so that their sum is an integral from a distance
        # s on, -aspect/width ln(s + sqrt(s^2 + x^2)), to either side.
        reach = (IMAGES + 0.5) * width
        for beyond in (reach - y, reach + y):
            quarter -= aspect / width * np.log(beyond + np.hypot(beyond, x))
    else:
        quarter = influence_love_1929(x, y, 1.0, aspect)
    rows = np.fft.hfft(quarter, axis=1)[:, : length_y // 2 + 1]
    symbol = np.fft.hfft(rows, axis=0)
    symbol.flags.writeable = False
    return symbol


@njit(cache=True, error_model='numpy')
def deform(space: HalfSpace, pressure: Array, out: Array) -> None:
    """Convolve: out = influence * pressure [-], with the mirror column where symmetric."""
    if space.symmetric:
        _rows_to_spectrum_even(space, pressure)
        fft_forward(space.columns[0], space.columns[1], space.x.cos, space.x.sin)
        # Two real columns as one complex: Z(k) mean + conj Z(-k) half difference.
        re, im = space.columns[0], space.columns[1]
        mean, half, place = space.spectrum[0], space.spectrum[1], space.x.place
        size = place.size
        for k in range(size // 2 + 1):
            a, b = place[k], place[(size - k) % size]
            for j in range(re.shape[1]):
                ar, ai, br, bi = re[a, j], im[a, j], re[b, j], im[b, j]
                m, h = mean[a, j], half[a, j]
                re[a, j], im[a, j] = m * ar + h * br, m * ai - h * bi
                if a != b:
                    re[b, j], im[b, j] = m * br + h * ar, m * bi - h * ai
        fft_inverse(space.columns[0], space.columns[1], space.x.cos, space.x.sin)
        _spectrum_to_rows_even(space, out)
    else:
        _rows_to_spectrum(space, pressure)
        fft_forward(space.columns[0], space.columns[1], space.x.cos, space.x.sin)
        re, im, factor = space.columns[0], space.columns[1], space.spectrum[0]
        for i in range(re.shape[0]):
            for j in range(re.shape[1]):
                re[i, j] *= factor[i, j]
                im[i, j] *= factor[i, j]
        fft_inverse(space.columns[0], space.columns[1], space.x.cos, space.x.sin)
        _spectrum_to_rows(space, out)
        if space.periodic:
            repeat(out)


@njit(cache=True, error_model='numpy')
def _load_tile(
    tile: Array, values: Array, start: int, symmetric: bool, periodic: bool = False
) -> None:
    """Copy two rows into each lane, zero beyond, mirrored when symmetric, a period of them."""
    nx, ny = values.shape
    length, lanes = tile.shape[1], tile.shape[2]
    first = 1 if symmetric or periodic else 0
    used = ny - 2 if periodic else ny - first
    for part in range(2):
        plane, offset = tile[part], start + part * lanes
        rows = max(0, min(lanes, nx - offset))
        for lane in range(rows):
            for j in range(used):
                plane[j, lane] = values[offset + lane, first + j]
        for j in range(used):
            for lane in range(rows, lanes):
                plane[j, lane] = 0
        for j in range(used, length):
            for lane in range(lanes):
                plane[j, lane] = 0
        if symmetric:
            for j in range(1, used):
                for lane in range(lanes):
                    plane[length - j, lane] = plane[j, lane]


@njit(cache=True, error_model='numpy')
def _store_tile(
    tile: Array, values: Array, start: int, symmetric: bool, periodic: bool = False
) -> None:
    """Copy the lanes back into rows, with the mirror column or the copies of a period."""
    nx, ny = values.shape
    lanes = tile.shape[2]
    first = 1 if symmetric or periodic else 0
    end = ny - 1 if periodic else ny
    for part in range(2):
        plane, offset = tile[part], start + part * lanes
        rows = max(0, min(lanes, nx - offset))
        for lane in range(rows):
            for j in range(end - first):
                values[offset + lane, first + j] = plane[j, lane]
    if symmetric:
        for i in range(nx):
            values[i, 0] = values[i, 2]


@njit(cache=True, error_model='numpy')
def repeat(values: Array) -> None:
    """Fill the copies on both sides of a period [any unit]."""
    last = values.shape[1] - 1
    for i in range(values.shape[0]):
        values[i, 0] = values[i, last - 1]
        values[i, last] = values[i, 1]


@njit(cache=True, error_model='numpy')
def _rows_to_spectrum_even(space: HalfSpace, values: Array) -> None:
    """Transform even rows, two in one: both spectra are real."""
    tile, re, im = space.tile, space.columns[0], space.columns[1]
    half, place, lanes = re.shape[1], space.y.place, tile.shape[2]
    frequencies, nx = place.size // 2 + 1, values.shape[0]
    for start in range(0, nx, 2 * lanes):
        _load_tile(tile, values, start, True)
        fft_forward(tile[0], tile[1], space.y.cos, space.y.sin)
        for part in range(2):
            plane, offset = tile[part], start + part * lanes
            for lane in range(min(lanes, nx - offset)):
                for k in range(half):
                    re[offset + lane, k] = plane[place[k], lane]
                for k in range(half, frequencies):
                    im[offset + lane, k - half] = plane[place[k], lane]
    rest = frequencies - half
    im[:nx, rest:] = 0
    re[nx:] = 0
    im[nx:] = 0


@njit(cache=True, error_model='numpy')
def _spectrum_to_rows_even(space: HalfSpace, values: Array) -> None:
    tile, re, im = space.tile, space.columns[0], space.columns[1]
    half, place, lanes = re.shape[1], space.y.place, tile.shape[2]
    size, nx = place.size, values.shape[0]
    frequencies = size // 2 + 1
    for start in range(0, nx, 2 * lanes):
        for part in range(2):
            plane, offset = tile[part], start + part * lanes
            for lane in range(min(lanes, nx - offset)):
                for k in range(half):
                    plane[place[k], lane] = re[offset + lane, k]
                for k in range(half, frequencies):
                    plane[place[k], lane] = im[offset + lane, k - half]
            for k in range(1, size // 2):
                a, b = place[size - k], place[k]
                for lane in range(lanes):
                    plane[a, lane] = plane[b, lane]
        fft_inverse(tile[0], tile[1], space.y.cos, space.y.sin)
        _store_tile(tile, values, start, True)


@njit(cache=True, error_model='numpy')
def _rows_to_spectrum(space: HalfSpace, values: Array) -> None:
    """Transform real rows, two in one complex row, and part their spectra."""
    tile, re, im = space.tile, space.columns[0], space.columns[1]
    place, lanes = space.y.place, tile.shape[2]
    size, half, nx = place.size, re.dtype.type(0.5), values.shape[0]
    for start in range(0, nx, 2 * lanes):
        _load_tile(tile, values, start, False, space.periodic)
        fft_forward(tile[0], tile[1], space.y.cos, space.y.sin)
        real, imaginary, second = tile[0], tile[1], start + lanes
        for block in range(0, min(lanes, nx - start), BLOCK):
            stop = min(block + BLOCK, lanes, nx - start)
            stop_second = min(stop, nx - second)
            for k in range(size // 2 + 1):
                a, b = place[k], place[(size - k) % size]
                for lane in range(block, stop):
                    re[start + lane, k] = half * (real[a, lane] + real[b, lane])
                    im[start + lane, k] = half * (imaginary[a, lane] - imaginary[b, lane])
                for lane in range(block, stop_second):
                    re[second + lane, k] = half * (imaginary[a, lane] + imaginary[b, lane])
                    im[second + lane, k] = half * (real[b, lane] - real[a, lane])
    re[nx:] = 0
    im[nx:] = 0


@njit(cache=True, error_model='numpy')
def _spectrum_to_rows(space: HalfSpace, values: Array) -> None:
    tile, re, im = space.tile, space.columns[0], space.columns[1]
    place, lanes = space.y.place, tile.shape[2]
    size, nx = place.size, values.shape[0]
    for start in range(0, nx, 2 * lanes):
        real, imaginary, second = tile[0], tile[1], start + lanes
        for block in range(0, min(lanes, nx - start), BLOCK):
            stop = min(block + BLOCK, lanes, nx - start)
            stop_second = min(stop, nx - second)
            for k in range(size // 2 + 1):
                a, b = place[k], place[(size - k) % size]
                for lane in range(block, stop_second):
                    i, n = start + lane, second + lane
                    real[b, lane] = re[i, k] + im[n, k]
                    imaginary[b, lane] = re[n, k] - im[i, k]
                    real[a, lane] = re[i, k] - im[n, k]
                    imaginary[a, lane] = im[i, k] + re[n, k]
                for lane in range(max(block, stop_second), stop):
                    i = start + lane
                    real[b, lane], imaginary[b, lane] = re[i, k], -im[i, k]
                    real[a, lane], imaginary[a, lane] = re[i, k], im[i, k]
        fft_inverse(tile[0], tile[1], space.y.cos, space.y.sin)
        _store_tile(tile, values, start, False, space.periodic)
