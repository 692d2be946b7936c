# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fourier transforms of many columns at once, compiled, in place, one thread.

Real and imaginary parts are separate arrays of shape (length, columns); every inner loop runs over
the columns and vectorises. The forward transform leaves its output in digit-reversed order and the
inverse takes it from there, so a convolution needs no reordering. Lengths are 3^n * 2^k.

"""

from typing import NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray
from surrogate.compiler import njit

Array = NDArray[np.floating]


class Fft(NamedTuple):
    """Tables of one length: cos and sin of the unit roots, place of each frequency."""

    cos: Array
    sin: Array
    place: NDArray[np.int64]


def good_length(least: int) -> int:
    """Return the smallest length 3^n * 2^k, k at least 2, that is not below `least`."""
    best, odd = 4, 1
    while best < least:
        best *= 2
    while 4 * odd < best:
        length = 4 * odd
        while length < least:
            length *= 2
        best, odd = min(best, length), 3 * odd
    return best


def make_fft(length: int, dtype: DTypeLike) -> Fft:
    """Prepare the tables of one length."""
    angle = -2 * np.pi * np.arange(length) / length
    return Fft(
        cos=np.cos(angle).astype(dtype), sin=np.sin(angle).astype(dtype), place=_places(length)
    )


def _places(length: int) -> NDArray[np.int64]:
    """Return where the forward transform leaves each frequency."""
    place = np.zeros(length, dtype=np.int64)
    frequency, block = np.arange(length), length
    while block > 1:
        radix = 3 if block % 3 == 0 else min(block, 4)
        block //= radix
        place += block * (frequency % radix)
        frequency = frequency // radix
    return place


@njit(cache=True, error_model='numpy')
def fft_forward(re: Array, im: Array, cos: Array, sin: Array) -> None:
    """Transform the columns; the output is digit-reversed."""
    size = re.shape[0]
    length = size
    while length % 3 == 0:
        _forward_3(re, im, length, cos, sin)
        length //= 3
    while length >= 4:
        _forward_4(re, im, length, cos, sin)
        length //= 4
    if length == 2:
        _butterfly_2(re, im)


@njit(cache=True, error_model='numpy')
def fft_inverse(re: Array, im: Array, cos: Array, sin: Array) -> None:
    """Invert `fft_forward` but for the factor 1/length, from digit-reversed input."""
    size = re.shape[0]
    length, top = 1, size
    while top % 3 == 0:
        top //= 3
    if (top & 0x55555555) == 0:
        _butterfly_2(re, im)
        length = 2
    while length < top:
        length *= 4
        _inverse_4(re, im, length, cos, sin)
    while length < size:
        length *= 3
        _inverse_3(re, im, length, cos, sin)


@njit(cache=True, error_model='numpy')
def _butterfly_2(re: Array, im: Array) -> None:
    size, columns = re.shape
    for a in range(0, size, 2):
        b = a + 1
        for j in range(columns):
            x, y = re[a, j], im[a, j]
            u, v = re[b, j], im[b, j]
            re[a, j], im[a, j] = x + u, y + v
            re[b, j], im[b, j] = x - u, y - v


@njit(cache=True, error_model='numpy')
def _forward_4(re: Array, im: Array, length: int, cos: Array, sin: Array) -> None:
    size, columns = re.shape
    quarter, step = length // 4, size // length
    for k in range(quarter):
        c1, s1 = cos[k * step], sin[k * step]
        c2, s2 = cos[2 * k * step], sin[2 * k * step]
        c3, s3 = cos[3 * k * step], sin[3 * k * step]
        for a in range(k, size, length):
            b, c, d = a + quarter, a + 2 * quarter, a + 3 * quarter
            for j in range(columns):
                pr, pi = re[a, j] + re[c, j], im[a, j] + im[c, j]
                mr, mi = re[a, j] - re[c, j], im[a, j] - im[c, j]
                qr, qi = re[b, j] + re[d, j], im[b, j] + im[d, j]
                nr, ni = re[b, j] - re[d, j], im[b, j] - im[d, j]
                re[a, j], im[a, j] = pr + qr, pi + qi
                xr, xi = mr + ni, mi - nr
                re[b, j], im[b, j] = xr * c1 - xi * s1, xr * s1 + xi * c1
                xr, xi = pr - qr, pi - qi
                re[c, j], im[c, j] = xr * c2 - xi * s2, xr * s2 + xi * c2
                xr, xi = mr - ni, mi + nr
                re[d, j], im[d, j] = xr * c3 - xi * s3, xr * s3 + xi * c3


@njit(cache=True, error_model='numpy')
def _inverse_4(re: Array, im: Array, length: int, cos: Array, sin: Array) -> None:
    size, columns = re.shape
    quarter, step = length // 4, size // length
    for k in range(quarter):
        c1, s1 = cos[k * step], sin[k * step]
        c2, s2 = cos[2 * k * step], sin[2 * k * step]
        c3, s3 = cos[3 * k * step], sin[3 * k * step]
        for a in range(k, size, length):
            b, c, d = a + quarter, a + 2 * quarter, a + 3 * quarter
            for j in range(columns):
                br, bi = re[b, j] * c1 + im[b, j] * s1, im[b, j] * c1 - re[b, j] * s1
                cr, ci = re[c, j] * c2 + im[c, j] * s2, im[c, j] * c2 - re[c, j] * s2
                dr, di = re[d, j] * c3 + im[d, j] * s3, im[d, j] * c3 - re[d, j] * s3
                pr, pi = re[a, j] + cr, im[a, j] + ci
                mr, mi = re[a, j] - cr, im[a, j] - ci
                qr, qi = br + dr, bi + di
                nr, ni = br - dr, bi - di
                re[a, j], im[a, j] = pr + qr, pi + qi
                re[b, j], im[b, j] = mr - ni, mi + nr
                re[c, j], im[c, j] = pr - qr, pi - qi
                re[d, j], im[d, j] = mr + ni, mi - nr


@njit(cache=True, error_model='numpy')
def _forward_3(re: Array, im: Array, length: int, cos: Array, sin: Array) -> None:
    size, columns = re.shape
    third, step = length // 3, size // length
    half, root = cos[0] * 0.5, -sin[third * step]
    half, root = cos.dtype.type(half), cos.dtype.type(root)
    for k in range(third):
        c1, s1 = cos[k * step], sin[k * step]
        c2, s2 = cos[2 * k * step], sin[2 * k * step]
        for a in range(k, size, length):
            b, c = a + third, a + 2 * third
            for j in range(columns):
                pr, pi = re[b, j] + re[c, j], im[b, j] + im[c, j]
                mr, mi = (re[b, j] - re[c, j]) * root, (im[b, j] - im[c, j]) * root
                tr, ti = re[a, j] - half * pr, im[a, j] - half * pi
                re[a, j], im[a, j] = re[a, j] + pr, im[a, j] + pi
                xr, xi = tr + mi, ti - mr
                re[b, j], im[b, j] = xr * c1 - xi * s1, xr * s1 + xi * c1
                xr, xi = tr - mi, ti + mr
                re[c, j], im[c, j] = xr * c2 - xi * s2, xr * s2 + xi * c2


@njit(cache=True, error_model='numpy')
def _inverse_3(re: Array, im: Array, length: int, cos: Array, sin: Array) -> None:
    size, columns = re.shape
    third, step = length // 3, size // length
    half, root = cos[0] * 0.5, -sin[third * step]
    half, root = cos.dtype.type(half), cos.dtype.type(root)
    for k in range(third):
        c1, s1 = cos[k * step], sin[k * step]
        c2, s2 = cos[2 * k * step], sin[2 * k * step]
        for a in range(k, size, length):
            b, c = a + third, a + 2 * third
            for j in range(columns):
                br, bi = re[b, j] * c1 + im[b, j] * s1, im[b, j] * c1 - re[b, j] * s1
                cr, ci = re[c, j] * c2 + im[c, j] * s2, im[c, j] * c2 - re[c, j] * s2
                pr, pi = br + cr, bi + ci
                mr, mi = (br - cr) * root, (bi - ci) * root
                tr, ti = re[a, j] - half * pr, im[a, j] - half * pi
                re[a, j], im[a, j] = re[a, j] + pr, im[a, j] + pi
                re[b, j], im[b, j] = tr - mi, ti + mr
                re[c, j], im[c, j] = tr + mi, ti - mr
