# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time the contact solver, in seconds and in FFT pairs of the same padded grid in the same run.

Run `python bench/ehl.py [repeats]`. Each line gives the least of the repeats, wall and processor
time (they differ on a busy machine), the FFT pair (the double precision convolution of the full
grid, forward and back), the ratio of processor time to it, which must not rot, the iterations, and
what the film is worth.

"""

import math
import sys
import time

import numpy as np
from scipy import fft
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.ehl.half_space import deform, make_half_space
from surrogate.ehl.kernels.fft import good_length
from surrogate.formulas.geometry import Contact

NOMINAL = Contact(radius_x=2.589e-3, radius_y=77.39e-3, reduced_modulus=226.4e9)
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2.0e-8)
NOMINAL_CONDITION = Condition(load=27.6, entrainment_speed=0.5)
ROUGH = Settings(nx=129, ny=257, domain=(-2.6, 1.4, 1.4), open_inlet=True)


def least(task, repeats):
    """Return the least wall and processor time [ms] of the repeats, and the last result."""
    walls, processor = [], []
    for _ in range(repeats):
        began, used = time.perf_counter(), time.process_time()
        result = task()
        walls.append(1e3 * (time.perf_counter() - began))
        processor.append(1e3 * (time.process_time() - used))
    return min(walls), min(processor), result


def pair(nx, ny):
    """Return the convolution of a full (nx, ny) grid in double precision as a task."""
    space = make_half_space(nx, ny, 0.03, 0.03, symmetric=False)
    field, out = np.zeros((nx, ny)), np.empty((nx, ny))
    return lambda: deform(space, field, out)


def scipy_pair(nx, ny):
    """Return the same convolution with scipy's real transforms."""
    shape = good_length(2 * nx - 3), good_length(2 * ny - 3)
    field, symbol = np.zeros((nx, ny)), np.ones((shape[0], shape[1] // 2 + 1))
    return lambda: fft.irfft2(fft.rfft2(field, shape) * symbol, shape)[:nx, :ny]


def circular(moes_load, moes_material=10.0):
    """Return contact, oil and condition of a circular contact in Moes groups."""
    radius, modulus, viscosity = 0.0127, 226.4e9, 0.04
    speed = (moes_material / (2.2e-8 * modulus)) ** 4
    return (
        Contact(radius_x=radius, radius_y=radius, reduced_modulus=modulus),
        ContactLubricant(viscosity=viscosity, pressure_viscosity=2.2e-8),
        Condition(
            load=moes_load * modulus * radius**2 * speed**0.75,
            entrainment_speed=speed * modulus * radius / (2 * viscosity),
        ),
    )


def raceway(shortest=16e-6, longest=120e-6, rms=0.12e-6, waves=120):
    """Return a deterministic self-affine surface z(x, y) [m]."""
    rng = np.random.default_rng(1)
    number = 2 * np.pi / np.exp(rng.uniform(math.log(shortest), math.log(longest), waves))
    angle, phase = rng.uniform(0, np.pi, waves), rng.uniform(0, 2 * np.pi, waves)
    size = number**-0.8
    size *= rms / np.sqrt(0.5 * (size**2).sum())
    return lambda x, y: sum(
        a * np.cos(k * (x * np.cos(t) + y * np.sin(t)) + p)
        for a, k, t, p in zip(size, number, angle, phase)
    )


def report(name, nx, ny, task, repeats, aim):
    """Print one line and return the last solution."""
    task()
    unit = least(pair(nx, ny), 60)[0]
    wall, processor, found = least(task, repeats)
    print(
        f'{name:34s} {wall:7.1f} ms (processor {processor:7.1f} ms)  pair {unit:6.3f} ms  '
        f'{processor / unit:6.0f} pairs  '
        f'newton {found.newton_iterations:3d} krylov {found.krylov_iterations:4d}  '
        f'film {found.central_film * 1e9:7.2f} nm (error {100 * found.film_error:4.2f} %, '
        f'extrapolated {found.extrapolated_film * 1e9:7.2f})  rcs {found.rcs:.4f}  '
        f'{found.status.name}  aim {aim}',
        flush=True,
    )
    return found


def main(repeats):
    """Run all benchmarks."""
    for nx, ny in ((129, 129), (257, 65), (129, 257), (257, 257)):
        own, their = pair(nx, ny), scipy_pair(nx, ny)
        own()
        print(
            f'FFT pair {nx:3d} x {ny:3d}: own {least(own, 60)[0]:.3f} ms, '
            f'scipy {least(their, 30)[0]:.3f} ms'
        )

    def smooth(**settings):
        chosen = Settings(**settings)
        return lambda: solve_contact(NOMINAL, OIL, NOMINAL_CONDITION, settings=chosen)

    report(
        'nominal 129 x 129 cold',
        129,
        129,
        smooth(nx=129, ny=129, domain=(-2.5, 1.5, 1.5), error_estimate=False),
        repeats,
        '50 ms, 350 pairs',
    )
    report('nominal 257 x 65 cold, production', 257, 65, smooth(), repeats, '80 ms at 0.5 %')
    for nodes, aim in ((129, '1 s at 1 % (extrapolated)'), (257, '1 s at 1 %')):
        chosen = Settings(nx=nodes, ny=nodes, domain=(-2.5, 1.5, 2.0))
        found = report(
            f'circular M = 200, {nodes} x {nodes} cold',
            nodes,
            nodes,
            lambda chosen=chosen: solve_contact(*circular(200.0), settings=chosen),
            max(2, repeats // 3),
            aim,
        )
        unit = found.contact.radius_x * (10.0 / (2.2e-8 * 226.4e9)) ** 2
        print(
            f'    against the table (3.658): on the grid {found.central_film / unit:.3f}, '
            f'extrapolated {found.extrapolated_film / unit:.3f}'
        )
    heights, last = raceway(), None
    for speed in (0.5, 0.35, 0.25, 0.18, 0.12, 0.05, 0.025, 0.015, 0.01, 0.007):
        condition = Condition(load=27.6, entrainment_speed=speed)
        last = report(
            f'mixed 129 x 257 {"warm" if last else "cold"}, {speed} m/s',
            129,
            257,
            lambda condition=condition, start=last: solve_contact(
                NOMINAL, OIL, condition, roughness=heights, settings=ROUGH, start=start
            ),
            2,
            '400 ms warm',
        )


if __name__ == '__main__':
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
