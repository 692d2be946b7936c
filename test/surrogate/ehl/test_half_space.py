# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Transforms and deformation against numpy, plain sums and Hertz."""

import numpy as np
import pytest
from surrogate.ehl.half_space import deform, influence_love_1929, make_half_space
from surrogate.ehl.kernels.fft import fft_forward, fft_inverse, good_length, make_fft
from surrogate.formulas.geometry import Contact, hertz


def plain_deformation(pressure, dx, dy):
    """Sum the influence of every node on every node."""
    nx, ny = pressure.shape
    x, y = np.arange(nx) * dx, np.arange(ny) * dy
    return sum(
        pressure[i, j] * influence_love_1929(x[:, None] - x[i], y[None, :] - y[j], dx, dy)
        for i in range(nx)
        for j in range(ny)
    )


@pytest.mark.parametrize('length', [4, 6, 8, 12, 16, 24, 36, 64, 108, 128, 144, 192])
@pytest.mark.parametrize(('dtype', 'error'), [(np.float64, 1e-12), (np.float32, 1e-4)])
def test_fft_is_numpys(length, dtype, error):
    rng = np.random.default_rng(length)
    signal = rng.normal(size=(length, 3)) + 1j * rng.normal(size=(length, 3))
    re, im = signal.real.astype(dtype), signal.imag.astype(dtype)
    tables = make_fft(length, dtype)
    fft_forward(re, im, tables.cos, tables.sin)
    expected = np.fft.fft(signal, axis=0)
    assert np.abs((re + 1j * im)[tables.place] - expected).max() < error * length
    fft_inverse(re, im, tables.cos, tables.sin)
    assert np.abs((re + 1j * im) / length - signal).max() < error
    assert re.dtype == dtype


def test_good_lengths_have_only_the_factors_in_hand():
    """The next 3^n * 2^k, multiples of 4, never below what is asked."""
    good = sorted(3**n * 2**k for n in range(7) for k in range(2, 11))
    for least in (*range(1, 300), 511, 513, 577, 635, 649, 769, 1000):
        assert good_length(least) == next(length for length in good if length >= least)


def test_deformation_is_the_plain_sum():
    rng = np.random.default_rng(0)
    pressure = np.zeros((21, 17))
    pressure[1:-1, 1:-1] = rng.random((19, 15))
    found = np.empty_like(pressure)
    deform(make_half_space(21, 17, 0.1, 0.37, symmetric=False), pressure, found)
    assert found == pytest.approx(plain_deformation(pressure, 0.1, 0.37), rel=1e-12)
    even = pressure + pressure[:, ::-1]
    half, found = even[:, 7:].copy(), np.empty((21, 10))
    half[:, 0] = 7.0  # the mirror column is output only
    deform(make_half_space(21, 10, 0.1, 0.37, symmetric=True), half, found)
    assert found == pytest.approx(plain_deformation(even, 0.1, 0.37)[:, 7:], rel=1e-12)


@pytest.mark.parametrize('radius_y', [0.003, 0.06])
def test_hertz_pressure_leaves_a_flat_gap_at_the_approach(radius_y):
    """The gap under Hertz's pressure is constant within 0.2 % of the approach, which it equals."""
    contact = Contact(radius_x=0.003, radius_y=radius_y, reduced_modulus=2.2e11)
    dry = hertz(contact, 30.0)
    x = np.linspace(-1.3, 1.3, 129) * dry.semi_axis_x
    y = np.linspace(-1.3, 1.3, 129) * dry.semi_axis_y
    inside = 1 - (x[:, None] / dry.semi_axis_x) ** 2 - (y[None, :] / dry.semi_axis_y) ** 2
    pressure = dry.max_pressure * np.sqrt(np.maximum(inside, 0))
    space = make_half_space(
        129,
        129,
        x[1] - x[0],
        y[1] - y[0],
        symmetric=False,
        scale=2 / (np.pi * contact.reduced_modulus),
    )
    lift = np.empty((129, 129))
    deform(space, pressure, lift)
    gap = lift + x[:, None] ** 2 / (2 * contact.radius_x) + y[None, :] ** 2 / (2 * radius_y)
    flat = gap[inside > 0.1]
    assert np.ptp(flat) < 2e-3 * dry.approach
    assert flat.mean() == pytest.approx(float(dry.approach), rel=1e-3)


def test_near_kernel_has_the_symbol_of_the_full_one_at_high_frequency():
    """Its symbol equals that of the full kernel at (pi, pi) and stays positive everywhere."""
    space = make_half_space(33, 33, 0.05, 0.4, symmetric=False)
    centre, along, across, corner = space.near
    tx, ty = np.meshgrid(np.linspace(0, np.pi, 65), np.linspace(0, np.pi, 65))
    symbol = (
        centre
        + 2 * along * np.cos(tx)
        + 2 * across * np.cos(ty)
        + 4 * corner * np.cos(tx) * np.cos(ty)
    )
    full = np.fft.rfft2(
        influence_love_1929(
            np.minimum(np.arange(64), 64 - np.arange(64))[:, None] * 0.05,
            np.minimum(np.arange(64), 64 - np.arange(64))[None, :] * 0.4,
            0.05,
            0.4,
        )
    ).real
    assert symbol.min() > 0
    assert symbol[-1, -1] == pytest.approx(full[32, 32], rel=1e-10)


def test_a_periodic_half_space_is_the_sum_of_its_images():
    """Differences of deflection, with images summed up far out; the copies at both ends."""
    rng = np.random.default_rng(1)
    pressure = np.zeros((15, 14))
    pressure[1:-1, 1:-1] = rng.random((13, 12))
    found = np.empty_like(pressure)
    space = make_half_space(15, 14, 0.1, 0.07, symmetric=False, periodic=True)
    deform(space, pressure, found)
    many, period = 401, 12
    wide = np.zeros((15, period * many))
    wide[:] = np.tile(pressure[:, 1:-1], many)
    middle = period * (many // 2) + np.arange(period)
    x, y = 0.1 * np.arange(15), 0.07 * np.arange(period * many)
    twin = np.zeros((15, period))
    for i in range(1, 14):
        for k in range(period):
            lag = y[middle][None, None, :] - y[k::period][:, None, None]
            part = influence_love_1929(x[None, :, None] - x[i], lag, 0.1, 0.07).sum(axis=0)
            twin += pressure[i, k + 1] * part
    assert found[:, 1:-1] - found[7, 6] == pytest.approx(twin - twin[7, 5], abs=2e-5)
    assert (found[:, 0] == found[:, -2]).all()
    assert (found[:, -1] == found[:, 1]).all()


@pytest.mark.parametrize('waves', [1, 3])
def test_a_wave_across_a_periodic_strip_decays_as_in_the_half_space(waves):
    """Of p = cos(q y) on |x| < c, far inside: 2 pi/q times the pressure, in units of 1/r."""
    nx, columns, spacing = 257, 24, 0.05
    width = columns * spacing
    y = (np.arange(columns + 2) - 0.5) * spacing
    number = 2 * np.pi * waves / width
    pressure = np.zeros((nx, columns + 2))
    pressure[1:-1] = np.cos(number * y)
    found = np.empty_like(pressure)
    deform(
        make_half_space(nx, columns + 2, spacing, spacing, symmetric=False, periodic=True),
        pressure,
        found,
    )
    found_there = found[nx // 2] @ pressure[nx // 2] / (pressure[nx // 2] @ pressure[nx // 2])
    blunt = np.sinc(number * spacing / 2 / np.pi)  # the pressure is constant on a cell
    assert found_there == pytest.approx(2 * np.pi / number * blunt, rel=1e-2)
