# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The axial load that a motor torque states: inertia is taken off, the surface is turned round.

    torque - inertia dw/dt = driving torque(|w|, load, temperature)

The driving torque of a surface holds the friction of the nuts and the parasitic torque of its
datasheet, so drag is not taken off a second time. It rises with the load but for a few newtons
about the idle load of a nut, so all loads that the torque may state are scanned, and the first and
the last crossing are refined. No clock. In the subset of Python that also compiles.

"""

import math
from typing import Any

from ballscrew_monitor.judge.records import Row, Settings
from surrogate.surface import is_inside, look_up, look_up_rest, scan, scan_part, SurfaceTables
from surrogate.units import TURN

NAN = math.nan
TOLERANCE = 1e-6  # [N] of the last step to a root, which converges faster than linearly
MOST_STEPS = 60
UNKNOWN, VALID, OUTSIDE_LOADS, NO_ANSWER = 0, 1, 4, 6  # validities of a surface
POSITIVE, NEGATIVE = 1, 2  # directions
DERIVED_OK, NO_ACCELERATION, TOO_MUCH_INERTIA, SEVERAL_LOADS = 1, 2, 3, 4
OUTSIDE, NO_NUMBER, STANDSTILL, NOT_FRESH = 5, 6, 7, 8
"""Codes of `Row.derived`; 0 is a load that is an input."""


def no_load(row: Row, validity: int, code: int, first: float, second: float, third: float) -> None:
    """
    Say in a row why no load follows from its torque.

    TOO_MUCH_INERTIA has the torque of inertia and drag and the measured one [N m], and the largest
    share [-], SEVERAL_LOADS the lowest and highest of them, opposing [N], OUTSIDE the torque along
    the motion [N m] and the lowest and highest opposing load of the surface [N]. With NO_NUMBER
    the validity says why.

    """
    row.validity, row.derived = validity, code
    row.axial_load = row.axial_load_uncertainty = NAN
    row.derived_first, row.derived_second, row.derived_third = first, second, third


def derive_load(
    tables: SurfaceTables, settings: Settings, row: Row, acceleration: float, change: float
) -> None:
    """
    Fill in the load that the torque of a moving screw states, or why it is not known.

    The row holds speed, motor torque, temperature and direction; acceleration and its change
    [rad/s2] are in the machine frame too. The validity of the row is VALID with a load,
    and says why not without. Lookups go to the row.

    """
    taken = settings.inertia * acceleration if settings.inertia != 0.0 else 0.0
    if math.isnan(taken):
        no_load(row, UNKNOWN, NO_ACCELERATION, NAN, NAN, NAN)
        return
    drag = tables.parasitic_torque + tables.parasitic_torque_rate * abs(row.speed)
    parts, measured = abs(taken) + drag, abs(row.motor_torque)
    if parts > settings.largest_share * measured:
        no_load(row, UNKNOWN, TOO_MUCH_INERTIA, parts, measured, settings.largest_share)
        return
    driving = row.motor_torque - taken
    driving = 0.0 - driving if row.direction == NEGATIVE else driving
    margin = settings.torque_uncertainty + settings.parts_uncertainty * parts
    if settings.inertia != 0.0:
        margin += settings.inertia * change
    solve(tables, row, driving, margin)
    if row.direction == POSITIVE:
        # Subtracted from zero: a zero load must not become -0.0.
        row.axial_load = 0.0 - row.axial_load


def solve(tables: SurfaceTables, row: Row, driving: float, margin: float) -> None:
    """
    Fill in the opposing load of a driving torque [N m] that is known within a margin [N m].

    Several loads are one answer where the margin cannot tell them apart.

    """
    begin, end = part_of(tables, row, driving, margin)
    first, last, gap = crossings(tables.scan_torques, driving, begin, end)
    if gap:
        no_load(row, NO_ANSWER, NO_NUMBER, NAN, NAN, NAN)
        return
    if first < 0:
        nothing_crosses(tables, row, driving)
        return
    low = root(tables, row, driving, first)
    high = low if last == first else root(tables, row, driving, last)
    if high - low > 2.0 * margin / (tables.lead / TURN):
        no_load(row, UNKNOWN, SEVERAL_LOADS, low, high, NAN)
        return
    load = 0.5 * (low + high)
    if look_up(tables, abs(row.speed), load, row.temperature, row) != VALID:
        no_load(row, NO_ANSWER, NO_NUMBER, NAN, NAN, NAN)
        return
    look_up_rest(tables, load, row)
    error = row.friction_torque_error
    stated = error if math.isfinite(error) else 0.0
    error = row.friction_torque_stderr
    margin += stated + (error if math.isfinite(error) else 0.0)
    no_load(row, VALID, DERIVED_OK, NAN, NAN, NAN)
    row.axial_load = load
    row.axial_load_uncertainty = reach_of(tables, begin, end, driving, load, margin)


def part_of(tables: SurfaceTables, row: Row, driving: float, margin: float) -> tuple[int, int]:
    """
    Scan the loads whose torque may be the driving one within the margin; return their places.

    Torques [N m]. A known torque stands at either side, unless there is none: beyond it all
    torques are on the same side of the margin.

    """
    speed, temperature = abs(row.speed), row.temperature
    loads = tables.scan_loads
    if not is_inside(tables, speed, temperature):
        return 0, 0
    per_newton, reach = tables.lead / TURN, margin + tables.torque_error
    begin, end = 0, len(loads)
    while begin < end and loads[begin] * per_newton + tables.torque_high < driving - reach:
        begin += 1
    while end > begin and loads[end - 1] * per_newton + tables.torque_low > driving + reach:
        end -= 1
    scan_part(tables, speed, temperature, begin, end)
    known = False
    while begin > 0 and not known:
        begin -= 1
        known = scan_part(tables, speed, temperature, begin, begin + 1) > 0
    known = False
    while end < len(loads) and not known:
        end += 1
        known = scan_part(tables, speed, temperature, end - 1, end) > 0
    return begin, end


def crossings(torques: Any, driving: float, begin: int, end: int) -> tuple[int, int, bool]:
    """
    Return the places before the first and the last crossing of the driving torque [N m].

    -1 without one; and whether a torque that is not known lies within a crossing.

    """
    first, last, before = -1, -1, -1
    for i in range(begin, end):
        if math.isnan(torques[i]):
            continue
        if before >= 0 and (torques[i] - driving > 0.0) != (torques[before] - driving > 0.0):
            if i - before > 1:
                return first, last, True
            first = before if first < 0 else first
            last = before
        before = i
    return first, last, False


def nothing_crosses(tables: SurfaceTables, row: Row, driving: float) -> None:
    """Say why no load has a driving torque [N m] at the speed and temperature of a row."""
    speed, temperature = abs(row.speed), row.temperature
    loads, torques = tables.scan_loads, tables.scan_torques
    if scan(tables, speed, temperature) == 0:
        validity = look_up(tables, speed, loads[len(loads) // 2], temperature, row)
        validity = NO_ANSWER if validity == VALID else validity
        no_load(row, validity, NO_NUMBER, NAN, NAN, NAN)
        return
    begin, end = 0, len(loads) - 1
    while math.isnan(torques[begin]):
        begin += 1
    while math.isnan(torques[end]):
        end -= 1
    no_load(row, OUTSIDE_LOADS, OUTSIDE, driving, loads[begin], loads[end])


def reach_of(
    tables: SurfaceTables, begin: int, end: int, driving: float, load: float, margin: float
) -> float:
    """
    Return how far from `load` [N] a load may lie whose torque the margin cannot tell apart.

    Torques [N m] at the scanned loads, linear between them; beyond their ends friction counts as
    constant, and a load takes the torque that it would without friction.

    """
    loads, torques = tables.scan_loads, tables.scan_torques
    per_newton = tables.lead / TURN
    reach, before = 0.0, -1
    for i in range(begin, end):
        excess = torques[i] - driving
        if math.isnan(excess):
            continue
        if abs(excess) <= margin:
            reach = max(reach, abs(loads[i] - load))
        if before < 0:
            left = excess + margin
            if left > 0.0:
                reach = max(reach, abs(loads[i] - load) + left / per_newton)
        else:
            other = torques[before] - driving
            for level in (-margin, margin):
                if (excess > level) != (other > level):
                    part = (level - other) / (excess - other)
                    place = loads[before] + part * (loads[i] - loads[before])
                    reach = max(reach, abs(place - load))
        before = i
    left = margin - (torques[before] - driving)
    if left > 0.0:
        reach = max(reach, abs(loads[before] - load) + left / per_newton)
    return reach


def root(tables: SurfaceTables, row: Row, driving: float, place: int) -> float:
    """
    Return the load [N] of a driving torque [N m] above a place of the scan; NaN if it is lost.

    Anderson and Bjorck, BIT 13 (1973) 253: the secant, with the rest of an end that stays made
    smaller.

    """
    low, high = tables.scan_loads[place], tables.scan_loads[place + 1]
    below = tables.scan_torques[place] - driving
    above = tables.scan_torques[place + 1] - driving
    if above == 0.0:
        return high
    for _ in range(MOST_STEPS):
        middle = (low * above - high * below) / (above - below)
        look_up(tables, abs(row.speed), middle, row.temperature, row)
        here = row.driving_torque - driving
        if here == 0.0 or math.isnan(here):
            return middle if here == 0.0 else NAN
        if (here > 0.0) == (above > 0.0):
            smaller = 1.0 - here / above
            below *= smaller if smaller > 0.0 else 0.5
        else:
            low, below = high, above
        moved = abs(middle - high)
        high, above = middle, here
        if moved <= TOLERANCE:
            return middle
    return NAN
