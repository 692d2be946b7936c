# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signs of columns, which some meters and controls leave out."""

from collections.abc import Mapping
import math

from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.mapping import MOTOR, SIGNED
import numpy as np

STEADY = 0.02  # of the usual speed, by which it changes from row to row at most
FAST = 0.2  # of the usual speed, from which on friction is told
ALWAYS = 0.9  # of the steady rows in each direction
MANY = 8  # rows that tell whether torques are amounts
CLEARLY = 2.0  # times the sum of squares of the better of two readings
BARELY = 0.05  # of an amount is noise about zero
USUAL = 0.99  # quantile of ways from row to row, or speeds, that are no jumps
BACK = 0.01  # of the way of an axis that reverses, at least, leads in either direction
FINEST = 1e-6  # of the usual way from row to row: less is rounding
JUMP = 10.0  # times the usual way from row to row
ALIKE = 0.05  # part by which two ways may differ that are of one size
COARSE = 0.1  # of the usual way from row to row: a finer step disturbs no slope
CHANGES = 0.2  # of the rows in motion at which the way changes, though the axis runs evenly
FEWEST_GAPS = 2  # a single one is a logger that stood
GAP = 5.0  # times the usual time between rows, in which a value may have stayed
SAME_MOTION = 0.9  # correlation of a position's way with its speed, whatever their signs
SAME_TURN = 0.2  # of the largest mean torque of motions that turns with none of them


def are_amounts(
    kind: str, data: Mapping[str, Array], *, makes_load: bool, own_time: bool = False
) -> bool | None:
    """
    Return whether a column of an axis holds amounts, None if unclear, by kind of quantity.

    `data` has what else is known of the axis in the same rows, in whatever unit [-]; `makes_load`
    says that the load is worked out from the torque or current. With an `own_time` it has other
    rows than the motion, and both signs are those of any motion.

    """
    values = data[kind]
    if kind == 'speed':
        pushes = [data[each] for each in SIGNED if each in data and each != 'speed']
        unclear = 'position' not in data and not (values < -BARELY * np.nanmax(values)).any()
        turns = unclear and any(turns_by_torque(push, values) for push in pushes)
        return None if turns else False
    speed = data['speed'] if 'speed' in data else slopes(data['position'])
    still = np.zeros(len(values))
    if not is_one_sided(values, speed) or (own_time and not is_one_sided(values, still)):
        return False
    if kind in MOTOR:
        return is_magnitude(values, speed, makes_load=makes_load)
    return None if reverses(speed) else False


def is_one_sided(values: Array, speed: Array) -> bool:
    """
    Return True if values [-] have one sign while an axis moves by its speed [-], but for noise.

    Values at other times than the speed count in motion and at rest. Each direction counts by
    itself, however many rows it has; a jump, as of a position that is set again, is no motion.

    """
    known = np.isfinite(values) & (values != 0.0)
    speed = np.nan_to_num(speed)
    amounts = np.abs(speed)
    moving = known & (amounts > BARELY * _usual(amounts))
    moving = moving if moving.any() else known
    side = np.sign(values[moving].sum()) or 1.0
    ways = [values[moving & way] for way in (known, speed > 0.0, speed < 0.0)]
    against = [float(np.maximum(-side * way, 0.0).sum()) for way in ways]
    totals = [float(np.abs(way).sum()) for way in ways]
    few = all(part <= BARELY * total for part, total in zip(against, totals, strict=True))
    return bool(moving.any()) and few


def _usual(amounts: Array) -> float:
    """Return the largest amount but for the few of jumps, 0 if all are."""
    amounts = amounts[amounts > 0.0]
    return float(np.quantile(amounts, USUAL)) if len(amounts) else 0.0


def reverses(ways: Array) -> bool:
    """
    Return True if an axis moves in both directions by its ways from row to row, or its speeds [-].

    Jitter at rest makes little way, and a jump, such as to the begin of another run, is a single
    step.

    """
    ways = ways[np.isfinite(ways) & (ways != 0.0)]
    if len(ways) < 2:
        return False
    same = np.sign(ways[1:]) == np.sign(ways[:-1])
    lasting = np.append(same, False) | np.append(False, same)
    usual = _usual(np.abs(ways))
    steps = np.clip(ways[lasting], -usual, usual)
    ahead, back = float(steps[steps > 0.0].sum()), -float(steps[steps < 0.0].sum())
    return min(ahead, back) > BACK * (ahead + back)


def is_magnitude(torque: Array, speed: Array, *, makes_load: bool) -> bool | None:
    """
    Return whether torques of one sign are amounts [-] in rows at equal distances, None if unclear.

    Friction, viscous or not, turns with the motion, a weight does not, and what accelerates does
    so with neither: amounts have an even part of the speed [-], torques with a sign an odd one.
    An axis that does not reverse shows no amounts; torques at other times show nothing. Amounts
    that differ by direction look as torques with a sign do: where a torque makes the load, it is
    unclear whether it has one.

    """
    if len(speed) < MANY:
        return None if reverses(speed) else False
    push = np.gradient(speed)
    good = np.isfinite(torque) & np.isfinite(speed) & np.isfinite(push) & (speed != 0.0)
    known = np.isfinite(torque).sum(), (np.isfinite(speed) & (speed != 0.0)).sum()
    if good.sum() < MANY:
        return None if min(known) >= MANY else False
    torque, speed, push = torque[good], speed[good], push[good]
    if not reverses(speed):
        return False
    ways, once = np.sign(speed), np.ones(len(speed))
    misses = []
    for parts in ([once, np.abs(speed), ways * push], [once, ways, speed, push]):
        terms = np.column_stack(parts)
        fit = np.linalg.lstsq(terms, torque, rcond=None)[0]
        misses.append(float(np.sum((torque - terms @ fit) ** 2)))
    amounts, signed = (miss + 1e-9 * float(torque @ torque) for miss in misses)
    if max(amounts, signed) < CLEARLY * min(amounts, signed):
        return None
    return None if signed < amounts and makes_load else amounts < signed


def brakes_always(torque: Array, speed: Array) -> bool:
    """
    Return True if a torque [-] is against the motion at steady speeds in both directions.

    Friction asks for one that goes with it. A weight, or a force that pulls to one side, is
    against one direction alone; what accelerates the axis is not steady.

    """
    amounts = np.abs(speed)
    usual = _usual(amounts[np.isfinite(amounts)])
    if len(speed) < MANY:
        return False
    changes = np.abs(np.gradient(np.convolve(np.nan_to_num(speed), np.ones(5) / 5, 'same')))
    fast = np.isfinite(torque) & (torque != 0.0) & (amounts > FAST * usual)
    steady = fast & (changes <= STEADY * usual)
    shares = []
    for way in (speed > 0.0, speed < 0.0):
        rows = way & (steady if (steady & way).sum() >= MANY else fast)
        against = np.sign(torque[rows]) == -np.sign(speed[rows])
        shares.append(float(against.mean()) if len(against) >= MANY else 0.0)
    return min(shares) >= ALWAYS


def slopes(positions: Array) -> Array:
    """Return the changes of positions from row to row [-], of those that hold one."""
    known = np.flatnonzero(np.isfinite(positions))
    slope = np.full(len(positions), math.nan)
    if len(known) > 1:
        slope[known] = np.gradient(positions[known])
    return slope


def fault_of_speed(speed: Array, position: Array, places: Array) -> str:
    """
    Return why speeds are not those of a position, empty if they may be.

    Of both the least and the most [-] are given, and the first `places` [-] in a row. A channel
    that is not connected gives nothing but zeros, and a meter may give amounts.

    """
    if not np.nan_to_num(speed).any():
        return 'is always 0 while the position moves' if np.ptp(position) > 0.0 else ''
    least, most = sorted(abs(float(end)) for end in speed)
    is_one_sided = speed[0] * speed[1] >= 0.0 or least <= BARELY * most
    if is_one_sided and reverses(np.diff(places[np.isfinite(places)])):
        return 'never changes its sign while the position goes back and forth'
    return ''


def turns_by_torque(torque: Array, speed: Array) -> bool:
    """
    Return True if a torque or force [-] turns with motions whose speed [-] never does.

    The mean over a motion is that of friction and load, since what accelerates also brakes.

    """
    good = np.isfinite(torque) & np.isfinite(speed)
    torque, speed = torque[good], np.abs(speed[good])
    moving = speed > BARELY * speed.max(initial=0.0)
    ends = np.flatnonzero(np.diff(moving)) + 1
    means = [
        float(part.mean())
        for part, moves in zip(np.split(torque, ends), np.split(moving, ends), strict=True)
        if len(part) >= MANY and moves[0]
    ]
    least, most = min(means, default=0.0), max(means, default=0.0)
    return least < -SAME_TURN * most and most > -SAME_TURN * least


def leap_on(places: Array) -> int:
    """Return the row to which a position [-] goes on far more than beside it, 0 for none."""
    ways = np.diff(places)
    amounts = np.abs(ways)
    if len(ways) < MANY or not (amounts > 0.0).any():
        return 0
    usual = _usual(np.nan_to_num(amounts))
    moving = np.sign(ways) * (amounts > FAST * usual)
    same = (moving[1:-1] == moving[:-2]) | (moving[1:-1] == moving[2:])
    leaps = np.flatnonzero(same & (amounts[1:-1] > JUMP * usual))
    return int(leaps[0]) + 2 if len(leaps) else 0


def fault_of_slope(places: Array, runs: int) -> str:
    """
    Return why positions [-] in rows at equal distances have no speed as slope, empty if they may.

    A position that is asked for more seldom than the rows are written stays between; a coarse one
    goes on in few steps of one size; and a counter that is full begins again, as a run may.

    """
    ways = np.abs(np.diff(places[np.isfinite(places)]))
    usual = float(np.quantile(ways[ways > 0.0], 0.9)) if ways.any() else 0.0
    moves = np.flatnonzero(ways > FINEST * usual)
    if len(moves) < MANY:
        return ''
    jumps = ways[ways > JUMP * usual]
    if len(jumps) > max(runs - 1, 2) and np.ptp(jumps) <= 2.0 * usual:
        return f'jumps by {np.median(jumps):.4g} again and again'
    stays = float(np.median(np.diff(moves)))
    if stays >= 2.0:
        return f'stays for {stays:.0f} rows at a time while the axis moves'
    finest = float(ways[moves].min())
    parts = ways[moves] / finest
    pairs = np.diff(ways)[np.isin(np.arange(len(ways) - 1), moves)]
    changes = float((np.abs(pairs) > finest / 2).mean())
    is_coarse = finest > COARSE * usual and changes > CHANGES
    if is_coarse and (np.abs(parts - np.round(parts)) < ALIKE).all():
        return f'moves in steps of {finest:.3g}, up to {usual:.3g} from row to row'
    return ''


@np.errstate(over='ignore', invalid='ignore')
def opposes(speed: Array, position: Array) -> bool:
    """
    Return True if a position [-] goes the other way than its speed [-] says, row by row.

    Both are of one motion but for the sign; a jump, such as to the begin of a run, counts nothing.

    """
    moved, expected = np.diff(position), (speed[1:] + speed[:-1]) / 2
    good = np.isfinite(moved) & np.isfinite(expected)
    moved, expected = moved[good], expected[good]
    if len(moved) < MANY:
        return False
    usual = np.abs(moved) <= JUMP * np.quantile(np.abs(moved), 0.99)
    moved, expected = moved[usual], expected[usual]
    both = math.sqrt(float(moved @ moved)) * math.sqrt(float(expected @ expected))
    return 0.0 < both < math.inf and float(moved @ expected) < -SAME_MOTION * both


@np.errstate(over='ignore', invalid='ignore')
def stays_in_gaps(times: Array, speed: Array) -> bool:
    """
    Return True if gaps between times lie in even motion by its speed [-], as values on change do.

    Before and after such a gap the speed is about the same; they are more than a few of the
    motion.

    """
    known = np.isfinite(times) & np.isfinite(speed)
    steps, speed = np.diff(times[known]), speed[known]
    if int((steps > 0.0).sum()) < MANY:
        return False
    largest, changes = float(np.abs(speed).max()), np.abs(np.diff(speed))
    moving = (np.abs(speed[1:]) > BARELY * largest) & (steps > 0.0)
    moving &= np.sign(speed[1:]) == np.sign(speed[:-1])
    long = moving & (steps > GAP * np.median(steps[steps > 0.0]))
    of_rows = changes[moving & ~long]
    if len(of_rows) and float((of_rows == 0.0).mean()) > BARELY:
        return False  # values are written again though they stay
    # After a gap the first value is written that has changed.
    usual = float(np.quantile(of_rows, 0.9)) if len(of_rows) else 0.0
    gaps = long & (changes <= max(ALIKE * largest, usual))
    gaps &= np.append(steps[1:] >= 0.0, True)  # no row comes late into the gap
    few = gaps.sum() < FEWEST_GAPS or steps[gaps].sum() <= BARELY * steps[moving].sum()
    return not few
