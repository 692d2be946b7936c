# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Line preconditioner: every other line along x at once, the inner loops run across them; compiled.

The elastic influence is replaced by its fitted 3x3 near kernel, so that a line is a matrix with
bands -3 to +1, coupled to its two neighbours: all even lines are solved with the odd ones held,
and the other way round (zebra). Lines of either kind are neighbours in memory: line j is number
j // 2 of kind j % 2. Contact rows hold the near kernel itself. The unknown is the total pressure;
on contact nodes the film pressure follows from a second line system.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]


def lines_of_a_kind(ny: int) -> int:
    """Return how many of `ny` lines are even, and at least as many as are odd."""
    return (ny + 1) // 2


@njit(cache=True, error_model='numpy')
def line_factors(
    by_pressure: Array,
    by_gap: Array,
    contact: Mask,
    near: Array,
    inverse: np.floating,
    bands: Array,
    sides: Array,
) -> None:
    """
    Factor all lines, by kind; everything is in Hertz units [-].

    Planes l3, l2, l1, 1/d, u1 of a kind in `bands`; coupling to the sum of both neighbours at -3,
    -2, -1, +1 and 0 in `sides` 0 to 4, that to the south alone at 0 in 5. Contact rows are
    multiplied by `inverse`.

    """
    nx, ny = contact.shape
    k0, k1, m0, m1 = near[0], near[1], near[2], near[3]
    zero = near.dtype.type(0)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            kind, q = j % 2, j // 2
            side, done = sides[kind], bands[kind]
            if contact[i, j]:  # its row at -3 to +1 is c3 to cp
                side[0, i, q] = side[1, i, q] = side[5, i, q] = zero
                side[2, i, q] = side[3, i, q] = m1 * inverse
                side[4, i, q] = m0 * inverse
                c3 = c2 = zero
                c1, c0, cp = k1 * inverse, k0 * inverse, k1 * inverse
            else:
                h0, h1, h5 = by_gap[0, i, j], by_gap[1, i, j], by_gap[5, i, j]
                north = by_pressure[4, i, j]
                side[0, i, q] = h5 * m1
                side[1, i, q] = h5 * m0 + h1 * m1
                side[2, i, q] = h5 * m1 + h1 * m0 + h0 * m1
                side[3, i, q] = h0 * m1
                side[4, i, q] = h1 * m1 + h0 * m0 + north
                side[5, i, q] = by_pressure[3, i, j] - north
                c3, c2 = h5 * k1, h5 * k0 + h1 * k1 + by_pressure[5, i, j]
                c1 = h5 * k1 + h1 * k0 + h0 * k1 + by_pressure[1, i, j]
                c0, cp = h1 * k1 + h0 * k0 + by_pressure[0, i, j], h0 * k1 + by_pressure[2, i, j]
            l3 = l2 = l1 = zero
            if i > 3:
                l3 = c3 * done[3, i - 3, q]
                c2 -= l3 * done[4, i - 3, q]
            if i > 2:
                l2 = c2 * done[3, i - 2, q]
                c1 -= l2 * done[4, i - 2, q]
            if i > 1:
                l1 = c1 * done[3, i - 1, q]
                c0 -= l1 * done[4, i - 1, q]
            done[0, i, q], done[1, i, q], done[2, i, q] = l3, l2, l1
            done[3, i, q] = near.dtype.type(1) / c0
            done[4, i, q] = zero if i == nx - 2 else cp


@njit(cache=True, error_model='numpy')
def mirror(values: Array) -> None:
    """Fill the mirror column of a symmetric field."""
    for i in range(values.shape[0]):
        values[i, 0] = values[i, 2]


@njit(cache=True, error_model='numpy')
def solve_lines(
    bands: Array,
    sides: Array,
    rhs: Array,
    steps: int,
    started: bool,
    symmetric: bool,
    periodic: bool,
    work: Array,
    value: Array,
) -> None:
    """
    Solve the odd lines, the even ones and so on, `steps` times, for the total pressure [-].

    From `value` if started or else zero; `work` is six planes of a kind that once were zero.

    """
    known, total = work[:2], work[2:4]
    part(rhs, known)
    if started:
        part(value, total)
        if periodic:
            _repeat_lines(total, 0)
            _repeat_lines(total, 1)
    else:
        total[:] = 0
    for step in range(steps):
        kind = 1 - step % 2
        count = (rhs.shape[1] - kind) // 2
        coupled = started or step > 0
        if coupled:
            # The south neighbour and the sum of both of each line; none of the first.
            other, south, pair = total[1 - kind], work[4], work[5]
            for i in range(1, rhs.shape[0] - 1):
                if kind == 1:
                    for q in range(count):
                        south[i, q] = other[i, q]
                        pair[i, q] = other[i, q] + other[i, q + 1]
                else:
                    south[i, 0] = pair[i, 0] = 0
                    for q in range(1, count):
                        south[i, q] = other[i, q - 1]
                        pair[i, q] = other[i, q - 1] + other[i, q]
        _solve_kind(
            bands[kind], sides[kind], known[kind], count, coupled, work[4], work[5], total[kind]
        )
        if symmetric and kind == 0:
            for i in range(rhs.shape[0]):
                total[0, i, 0] = total[0, i, 1]
        if periodic:
            _repeat_lines(total, kind)
    join(total, value)


@njit(cache=True, error_model='numpy')
def _repeat_lines(total: Array, kind: int) -> None:
    """Fill the copy beside a period: the first even line, or the last odd one."""
    last = total.shape[2] - 1
    copy, own = (last, 0) if kind == 1 else (0, last)
    for i in range(total.shape[1]):
        total[kind, i, copy] = total[kind, i, own]


@njit(cache=True, error_model='numpy')
def part(values: Array, kinds: Array) -> None:
    """Part the lines [nx, ny] into even and odd ones [2, nx, lines]."""
    nx, ny = values.shape
    even, odd = kinds[0], kinds[1]
    for i in range(nx):
        for q in range(ny // 2):
            even[i, q] = values[i, 2 * q]
            odd[i, q] = values[i, 2 * q + 1]
        if ny % 2 == 1:
            even[i, ny // 2] = values[i, ny - 1]


@njit(cache=True, error_model='numpy')
def join(kinds: Array, values: Array) -> None:
    """Undo `part`."""
    nx, ny = values.shape
    even, odd = kinds[0], kinds[1]
    for i in range(nx):
        for q in range(ny // 2):
            values[i, 2 * q] = even[i, q]
            values[i, 2 * q + 1] = odd[i, q]
        if ny % 2 == 1:
            values[i, ny - 1] = even[i, ny // 2]


@njit(cache=True, error_model='numpy')
def _solve_kind(
    bands: Array,
    sides: Array,
    known: Array,
    count: int,
    coupled: bool,
    south: Array,
    pair: Array,
    value: Array,
) -> None:
    """
    Solve the first `count` lines of a kind, forwards and backwards in `value`.

    A line on the border has an inverse pivot of zero, and stays zero.

    """
    nx = known.shape[0]
    for i in range(1, nx - 1):
        for q in range(count):
            value[i, q] = known[i, q]
        if coupled:
            for q in range(count):
                value[i, q] -= (
                    sides[5, i, q] * south[i, q]
                    + sides[4, i, q] * pair[i, q]
                    + sides[3, i, q] * pair[i + 1, q]
                    + sides[2, i, q] * pair[i - 1, q]
                )
            if i > 2:
                for q in range(count):
                    value[i, q] -= (
                        sides[1, i, q] * pair[i - 2, q] + sides[0, i, q] * pair[i - 3, q]
                    )
        if i > 3:
            for q in range(count):
                value[i, q] -= (
                    bands[2, i, q] * value[i - 1, q]
                    + bands[1, i, q] * value[i - 2, q]
                    + bands[0, i, q] * value[i - 3, q]
                )
        elif i == 3:
            for q in range(count):
                value[i, q] -= bands[2, i, q] * value[i - 1, q] + bands[1, i, q] * value[i - 2, q]
        elif i == 2:
            for q in range(count):
                value[i, q] -= bands[2, i, q] * value[i - 1, q]
    value[nx - 1] = 0
    for i in range(nx - 2, 0, -1):
        for q in range(count):
            value[i, q] = (value[i, q] - bands[4, i, q] * value[i + 1, q]) * bands[3, i, q]


@njit(cache=True, error_model='numpy')
def film_factors(by_pressure: Array, contact: Mask, film: Array) -> None:
    """
    Factor the lines of the film pressure on contact nodes, in Hertz units [-].

    Planes l1, 1/d, u1 of the lines, coupling to the south and the north; elsewhere the row is 1.

    """
    nx, ny = contact.shape
    one, zero = film.dtype.type(1), film.dtype.type(0)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            touches = contact[i, j]
            d1 = by_pressure[1, i, j] if touches else zero
            d0 = by_pressure[0, i, j] if touches else one
            film[2, i, j] = by_pressure[2, i, j] if touches else zero
            film[3, i, j] = by_pressure[3, i, j] if touches else zero
            film[4, i, j] = by_pressure[4, i, j] if touches else zero
            if i > 1:
                d1 *= film[1, i - 1, j]
                d0 -= d1 * film[2, i - 1, j]
            film[0, i, j] = d1
            film[1, i, j] = one / d0


@njit(cache=True, error_model='numpy')
def solve_film_lines(
    film: Array,
    contact: Mask,
    box: tuple[int, int, int, int],
    rhs: Array,
    total: Array,
    steps: int,
    symmetric: bool,
    work: Array,
    value: Array,
) -> None:
    """Solve for the film pressure [-] on contact nodes, in `box`; elsewhere it is the total."""
    nx, ny = rhs.shape
    first, end, left, right = box
    zero = rhs.dtype.type(0)
    known, work = work[0], work[1]
    for i in range(nx):
        for j in range(ny):
            value[i, j] = zero if contact[i, j] else total[i, j]
            known[i, j] = rhs[i, j] if contact[i, j] else total[i, j]
    for _ in range(steps):
        for i in range(first, end):
            for j in range(left, right):
                work[i, j] = (
                    known[i, j] - film[3, i, j] * value[i, j - 1] - film[4, i, j] * value[i, j + 1]
                )
            if i > first:
                for j in range(left, right):
                    work[i, j] -= film[0, i, j] * work[i - 1, j]
        for i in range(end - 1, first - 1, -1):
            for j in range(left, right):
                value[i, j] = (work[i, j] - film[2, i, j] * value[i + 1, j]) * film[1, i, j]
        if symmetric:
            mirror(value)
