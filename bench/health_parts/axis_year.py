# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A year of logs of one axis with its fault, weather, wear, regreasing and sensors, and the truth.

The friction stands in `machine.py`. Magnets of neodymium lose 0.1 % of their flux per kelvin by
their data sheets. Warm-up and ripples are assumed.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

from health_parts.along import table_position, worn_place
from health_parts.cycles import cutting, feed_passes, Motion, motion, Move, varied
from health_parts.faults import CLEAN, Fault, joined
from health_parts.machine import Array, catalogue_drag, Condition, draw_machine, friction, Machine
from health_parts.weather import draw_weather, Weather
import numpy as np

DAY = 86_400_000_000_000  # [ns]
NEW_YEAR = 1_735_689_600_000_000_000  # [ns] 2025-01-01 00:00 UTC
MAGNETS = -1e-3  # [1/K]


@dataclass(frozen=True, kw_only=True, slots=True)
class Schedule:
    """When an axis is logged and how."""

    days: float  # [d] from log to log
    duration: float  # [s]
    rate: float  # [Hz]
    ripple: float  # of the reported speed


SCHEDULES = {
    'weekly': Schedule(days=7.0, duration=150.0, rate=20.0, ripple=0.003),
    'daily': Schedule(days=1.0, duration=150.0, rate=20.0, ripple=0.003),
    'monthly': Schedule(days=30.0, duration=90.0, rate=10.0, ripple=0.03),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Log:
    """One log as a control writes it; a force pushes the axis towards positive."""

    start: int  # [ns] UTC
    time: Array  # [s] from the start
    speed: Array  # [rad/s]
    torque: Array  # [N m]
    position: Array  # [m] by the motor
    table: Array | None  # [m] position of the table by its scale
    load: Array | None  # [N] external, towards positive
    temperature: Array | None  # [K]


@dataclass(frozen=True, kw_only=True, slots=True)
class Truth:
    """
    Mean friction of each log in free motion at the programme's speeds, at one temperature.

    Both directions averaged; with wander, running-in, fresh grease and fault, without the scatter
    of the day.

    """

    speeds: Array  # [rad/s]
    temperature: float  # [K]
    friction: Array  # [N m] of each log
    by_speed: Array  # [N m] logs by speeds
    fault_change: Array  # of the friction, by the fault alone
    indicated_change: Array  # of the indicated friction, by the fault alone

    def change(self, baseline: slice | Array) -> Array:
        """Return the relative change of the friction against its mean over the baseline's logs."""
        return self.friction / np.mean(self.friction[baseline]) - 1.0


@dataclass(frozen=True, kw_only=True, slots=True)
class AxisYear:
    """What a year of one axis put out, and what was the case."""

    machine: Machine
    fault: Fault
    day: Array  # [d] of each log
    moves: tuple[Move, ...]
    logs: tuple[Log, ...]
    truth: Truth


def axis_year(
    seed: int,
    fault: Fault = CLEAN,
    *,
    schedule: str = 'weekly',
    programme: str = 'passes',
    axis: str = 'horizontal',
    size: str | None = None,
    load: bool = True,
    temperature: bool = True,
    scale: bool = False,
    wander: float | None = None,
    scatter: float | None = None,
    days: float = 364.0,
) -> AxisYear:
    """
    Return the year of a seed; two faults of one seed have machine, weather and noise in common.

    Programmes are passes and cutting, axes horizontal, vertical and constant. Load, temperature
    and scale tell whether the log has these columns, the last one the position of the table;
    wander and scatter replace the drawn ones, as standard deviations over the friction.

    """
    machine = draw_machine(seed, size=size, axis=axis)
    plan = SCHEDULES[schedule]
    rng = np.random.default_rng([seed, 2])
    moves = {'passes': feed_passes(rng), 'cutting': cutting(rng, machine)}[programme]
    day = (
        np.arange(0.0, days, plan.days) + 0.25 + rng.uniform(0.0, 0.3, math.ceil(days / plan.days))
    )
    day = day[np.sort(rng.permutation(len(day))[: math.ceil(0.97 * len(day))])]
    weather = draw_weather(day, rng, wander=wander, scatter=scatter)
    time = np.arange(round(plan.duration * plan.rate)) / plan.rate
    motions = [
        motion(varied(moves, rng) if programme == 'cutting' else moves, machine, time) for _ in day
    ]
    state = joined(weather.condition, fault.condition(day[:, None]))
    columns = measure(
        machine, plan, time, motions, weather, state, np.random.default_rng([seed, 3])
    )
    tables = tables_of(seed, machine, weather, motions, time, state) if scale else None
    logs = tuple(
        Log(
            start=NEW_YEAR + round(date * DAY),
            time=time,
            speed=columns['speed'][k],
            torque=columns['torque'][k],
            position=motions[k].position,
            table=None if tables is None else tables[k],
            load=columns['load'][k] if load else None,
            temperature=columns['temperature'][k] if temperature else None,
        )
        for k, date in enumerate(day)
    )
    return AxisYear(
        machine=machine,
        fault=fault,
        day=day,
        moves=moves,
        logs=logs,
        truth=truth(machine, moves, fault, day, weather),
    )


def measure(
    machine: Machine,
    plan: Schedule,
    time: Array,
    motions: Sequence[Motion],
    weather: Weather,
    condition: Condition,
    rng: np.random.Generator,
) -> dict[str, Array]:
    """Return the columns of all logs, one log a row: speed, load, torque and temperature."""
    speed, acceleration, position, process = (
        np.stack([getattr(moved, name) for moved in motions])
        for name in ('speed', 'acceleration', 'position', 'force')
    )
    shape = speed.shape
    cutting_ripple = 1.0 + 0.1 * rng.standard_normal(shape)
    force = machine.standing_force + process * cutting_ripple
    start = weather.warmth[:, None]
    warm = machine.warm_up * (1.0 - (1.0 - start) * np.exp(-time / machine.warm_up_time))
    motor = machine.motor_warm_up * (
        1.0 - (1.0 - start) * np.exp(-time / machine.motor_warm_up_time)
    )
    oil = weather.hall[:, None] + warm
    state = replace(condition, every=weather.scatter[:, None])
    drag = friction(machine, speed, oil, warm=warm, force=force, condition=state)
    turns = position / machine.size.lead
    drag = drag * (1.0 + 0.03 * np.sin(2.0 * math.pi * position / machine.stroke + 1.0))
    drag = drag * (1.0 + 0.03 * np.sin(2.0 * math.pi * turns))
    drag = drag * worn_place(position / machine.stroke, state.worn)
    torque = drive_torque(machine, speed, acceleration, drag, force)
    noise = machine.torque_noise * catalogue_drag(machine.size, machine.preload)
    torque = torque + noise * rng.standard_normal(shape)
    indicated = indicated_torque(machine, torque, motor, state)
    # Root mean square 1: once a turn, and as noise.
    ripple = np.sin(2.0 * math.pi * turns) + math.sqrt(0.5) * rng.standard_normal(shape)
    cell = 0.01 * machine.preload * rng.standard_normal(shape)
    seen = weather.hall[:, None] + machine.thermometer_share * warm + machine.thermometer
    return {
        'speed': speed * (1.0 + plan.ripple * ripple),
        'load': state.load_gain * force + cell,
        'torque': stepped(indicated, machine.torque_step),
        'temperature': stepped(seen + 0.05 * rng.standard_normal(shape), 0.1),
    }


def tables_of(
    seed: int,
    machine: Machine,
    weather: Weather,
    motions: Sequence[Motion],
    time: Array,
    condition: Condition,
) -> list[Array]:
    """Return the position [m] of the table in each log, by its scale."""
    rng = np.random.default_rng([seed, 4])
    play = np.broadcast_to(condition.play, (len(motions), 1))[:, 0]
    warm = machine.warm_up * weather.warmth
    return [
        table_position(moved, time, machine.size.lead, play=play[k], warm=warm[k], rng=rng)
        for k, moved in enumerate(motions)
    ]


def drive_torque(
    machine: Machine, speed: Array, acceleration: Array, drag: Array, force: float | Array
) -> Array:
    """
    Return the torque [N m] of the motor at the screw.

    Speed [rad/s], acceleration [rad/s2], friction [N m] without its sign; a force [N] towards
    positive drives the axis there.

    """
    sense = np.sign(speed)
    driven = force * machine.size.lead / (2.0 * math.pi)
    return (
        sense * (1.0 + machine.asymmetry * sense) * drag + machine.inertia * acceleration - driven
    )


def indicated_torque(
    machine: Machine, torque: Array, motor_warm: float | Array, condition: Condition
) -> Array:
    """Return what the drive indicates for a torque [N m]; the winding is warmer by [K]."""
    constant = condition.torque_constant * (1.0 + MAGNETS * np.asarray(motor_warm))
    zero = machine.zero + condition.zero * catalogue_drag(machine.size, machine.preload)
    return np.asarray(machine.torque_gain * torque / constant + zero)


def stepped(values: Array, step: float) -> Array:
    """Return values rounded to whole steps of the same unit."""
    return np.asarray(step * np.round(values / step))


def truth(
    machine: Machine, moves: Sequence[Move], fault: Fault, day: Array, weather: Weather
) -> Truth:
    """Return the friction of all logs on days [d], at the mean temperature of the year."""
    speeds = np.array(sorted({move.speed for move in moves if move.force == 0.0}))
    warm = machine.warm_up * float(np.mean(weather.warmth))
    temperature = float(np.mean(weather.hall)) + warm
    faulty = fault.condition(day[:, None])

    def at(condition: Condition) -> Array:
        drag = friction(machine, speeds, temperature, warm=warm, condition=condition)
        return np.broadcast_to(drag, (len(day), len(speeds)))

    by_speed = at(joined(weather.condition, faulty))
    mean, clean = by_speed.mean(axis=1), at(weather.condition).mean(axis=1)
    constant = np.broadcast_to(faulty.torque_constant, (len(day), 1))[:, 0]
    return Truth(
        speeds=speeds,
        temperature=temperature,
        friction=mean,
        by_speed=by_speed,
        fault_change=mean / clean - 1.0,
        indicated_change=mean / constant / clean - 1.0,
    )
