# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction of a feed axis by catalogues and textbooks; it shares no code and no law with the product.

Sources, by part:

* screw: diameters, leads and ratings are round values of catalogues of ground double nuts. Drag of
  a preloaded nut by JIS B 1192: Tp = Kp F0 Ph / (2 pi), Kp = 0.05 tan(lead angle)^-0.5, at 100
  rev/min, in oil of 68 mm2/s, without wipers; catalogues allow 30 to 60 % about it. Nuts under an
  axial load by the straight preload diagram of the catalogues, where the relieved nut is free at
  three times the preload.
* that drag over speed and oil: a Stribeck curve over viscosity times speed (Stribeck 1902, Hersey
  1914), and a rolling resistance with the power 0.6 of it (SKF, general catalogue of 2008).
* support bearings: Palmgren 1957 (SKF, general catalogue of 1989), M0 = f0 1e-7 (nu n)^(2/3) dm^3
  and M1 = f1 P1 dm in N mm.
* guideway: catalogues of profile rails, F = mu W + seals, mu 0.002 to 0.003, and grease.
* oil: Vogel 1921 through the kinematic viscosities at 40 and 100 degC of viscosity index 95.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CELSIUS = 273.15  # [K] of 0 degC
PER_MINUTE = math.pi / 30.0  # [rad/s] of 1 rev/min
GRAVITY = 9.81  # [m/s2]
VOGEL = 178.0  # [K] Vogel's third constant of mineral oils
STATED_SPEED = 100.0  # [rev/min] of the catalogue's drag
STATED_VISCOSITY = 68.0  # [mm2/s]
ROLLING_POWER = 0.6  # of viscosity times speed
PALMGREN_LIMIT = 2000.0  # [mm2/s rev/min] below which M0 stays what it is there
RUBBER = -3e-3  # [1/K] grip of seals
# Grade: kinematic viscosities at 40 and 100 degC [mm2/s].
OILS = {32: (32.0, 5.4), 46: (46.0, 6.8), 68: (68.0, 8.7), 100: (100.0, 11.2), 150: (150.0, 14.7)}


@dataclass(frozen=True, kw_only=True, slots=True)
class Size:
    """A size of catalogue with the bearings, guideway and table that go with it."""

    diameter: float  # [m]
    lead: float  # [m]
    contact_angle: float  # [rad] of the balls
    rating: float  # [N] dynamic
    bearing_diameter: float  # [m] mean, of the support bearings
    bearing_preload: float  # [N]
    carriage: float  # [N] resistance of a carriage's seals
    mass: float  # [kg] table


def size_of(
    diameter: float,
    lead: float,
    rating: float,
    bearing: float,
    preload: float,
    carriage: float,
    mass: float,
) -> Size:
    """Return a size of a catalogue's units: lengths [mm], rating [kN], forces [N], mass [kg]."""
    return Size(
        diameter=1e-3 * diameter,
        lead=1e-3 * lead,
        contact_angle=math.radians(45.0),
        rating=1e3 * rating,
        bearing_diameter=1e-3 * bearing,
        bearing_preload=preload,
        carriage=carriage,
        mass=mass,
    )


SIZES = {
    '16x5': size_of(16.0, 5.0, 12.0, 22.0, 1000.0, 4.0, 30.0),
    '20x5': size_of(20.0, 5.0, 15.0, 25.0, 1300.0, 6.0, 60.0),
    '32x10': size_of(32.0, 10.0, 38.0, 43.5, 3000.0, 12.0, 250.0),
    '40x10': size_of(40.0, 10.0, 50.0, 46.0, 3300.0, 18.0, 500.0),
    '50x10': size_of(50.0, 10.0, 60.0, 65.0, 5000.0, 25.0, 900.0),
    '63x20': size_of(63.0, 20.0, 110.0, 75.0, 6000.0, 35.0, 2000.0),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Condition:
    """State of the parts, as factors of what was mounted; numbers, or arrays for many logs."""

    preload: float | Array = 1.0
    viscosity: float | Array = 1.0  # of the oil
    film: float | Array = 1.0  # speed of the Stribeck upturn
    nut: float | Array = 1.0  # drag of the nut: running-in, fresh grease
    wiper: float | Array = 1.0
    guideway: float | Array = 1.0
    bearing: float | Array = 1.0
    torque_constant: float | Array = 1.0
    zero: float | Array = 0.0  # offset of the torque, over the catalogue's drag
    load_gain: float | Array = 1.0
    worn: float | Array = 1.0  # friction where the stroke is worn
    play: float | Array = 0.0  # [m] backlash of nut and bearings
    every: float | Array = 1.0  # of all friction: scatter of a day


MOUNTED = Condition()


@dataclass(frozen=True, kw_only=True, slots=True)
class Machine:
    """One axis as it was built; `draw` gives one of many."""

    size: Size
    grade: int  # ISO VG of the oil
    preload: float  # [N]
    catalogue_factor: float  # drag of this nut over the catalogue's
    preload_power: float  # by which the drag follows the preload
    rolling: float  # share of the catalogue's drag which follows oil and speed
    upturn: float  # height of the Stribeck upturn over the floor
    film: float  # viscosity times speed of half the upturn, over the catalogue's
    wiper: float  # [N m] Coulomb part of the wipers at 20 degC
    wiper_viscous: float  # share of it added at 1000 rev/min in the catalogue's oil
    bearing_f0: float
    bearing_f1: float
    guide_friction: float  # coefficient
    guide_viscous: float  # [N s/m] in the catalogue's oil, of all carriages
    asymmetry: float  # half the difference of the directions over their mean
    standing_force: float  # [N] towards positive: weight less counterbalance, or a constant load
    stroke: float  # [m]
    inertia: float  # [kg m2] of all that turns and travels, at the screw
    warm_up: float  # [K] of nut and oil over the hall, in the end
    warm_up_time: float  # [s]
    preload_rise: float  # [1/K] of the preload, over the warm-up
    motor_warm_up: float  # [K]
    motor_warm_up_time: float  # [s]
    torque_gain: float  # indicated torque over the true one, cold
    torque_step: float  # [N m] of the quantised current
    torque_noise: float  # over the catalogue's drag
    zero: float  # [N m] offset of the indicated torque
    thermometer: float  # [K] its offset
    thermometer_share: float  # share of the warm-up that it sees


def draw_machine(seed: int, *, size: str | None = None, axis: str = 'horizontal') -> Machine:
    """Return the machine of a seed; `axis`: horizontal, vertical or constant (a constant load)."""
    if axis not in ('horizontal', 'vertical', 'constant'):
        raise ValueError(f'axis must be horizontal, vertical or constant, not {axis}')
    rng = np.random.default_rng([seed, 1])
    between = rng.uniform
    name = str(rng.choice(list(SIZES)))
    built = SIZES[size or name]
    preload = between(0.03, 0.10) * built.rating
    drag = catalogue_drag(built, preload)
    left = between(-0.05, 0.4)
    standing = {
        'horizontal': 0.0,
        'vertical': -left * built.mass * GRAVITY,
        'constant': -between(0.3, 1.5) * preload,
    }[axis]
    return Machine(
        size=built,
        grade=int(rng.choice([46, 68, 100])),
        preload=preload,
        catalogue_factor=between(0.6, 1.6),
        preload_power=between(1.1, 1.3),
        rolling=between(0.03, 0.12),
        upturn=between(0.3, 1.0),
        film=between(0.1, 0.5),
        wiper=between(0.1, 0.5) * drag,
        wiper_viscous=between(0.05, 0.3),
        bearing_f0=between(2.0, 5.0),
        bearing_f1=between(0.0004, 0.001),
        guide_friction=between(0.002, 0.003),
        guide_viscous=between(0.2, 1.0) * 4.0 * built.carriage / 0.5,
        asymmetry=between(-0.08, 0.08),
        standing_force=standing,
        stroke=between(12.0, 25.0) * built.diameter,
        inertia=between(1.0, 2.0) * inertia(built),
        warm_up=between(3.0, 12.0),
        warm_up_time=between(1200.0, 3600.0),
        preload_rise=between(0.0, 0.006),
        motor_warm_up=between(10.0, 40.0),
        motor_warm_up_time=between(900.0, 2400.0),
        torque_gain=between(0.92, 1.08),
        torque_step=float(rng.choice([0.002, 0.01, 0.03])) * drag,
        torque_noise=between(0.01, 0.05),
        zero=between(-0.08, 0.08) * drag,
        thermometer=between(-2.0, 2.0),
        thermometer_share=between(0.6, 1.0),
    )


def catalogue_drag(size: Size, preload: float) -> float:
    """Return the drag [N m] of a preloaded nut, JIS B 1192; preload [N]."""
    tangent = size.lead / (math.pi * size.diameter)
    return 0.05 * tangent**-0.5 * preload * size.lead / (2.0 * math.pi)


def inertia(size: Size) -> float:
    """Return the inertia [kg m2] of a screw of 30 diameters, a rotor like it, and the table."""
    rod = 7850.0 * math.pi / 4.0 * size.diameter**2 * 30.0 * size.diameter
    return rod * size.diameter**2 / 4.0 + size.mass * (size.lead / (2.0 * math.pi)) ** 2


def viscosity(grade: int, temperature: float | Array) -> Array:
    """Return the kinematic viscosity [mm2/s] of an oil at a temperature [K], Vogel 1921."""
    warm, hot = OILS[grade]
    nearer, farther = 1.0 / (CELSIUS + 40.0 - VOGEL), 1.0 / (CELSIUS + 100.0 - VOGEL)
    slope = math.log(warm / hot) / (nearer - farther)
    return np.asarray(warm * np.exp(slope * (1.0 / (temperature - VOGEL) - nearer)))


def nut_load(machine: Machine, force: float | Array, preload: float | Array) -> Array:
    """Return the mean over both nuts of (load / mounted preload)^power; force [N], preload [N]."""
    ratio = np.abs(force) / preload
    loaded = np.where(ratio < 3.0, 1.0 + 2.0 * ratio / 3.0, ratio)
    relieved = np.maximum(1.0 - ratio / 3.0, 0.0)
    shares = 0.5 * (loaded**machine.preload_power + relieved**machine.preload_power)
    return np.asarray(shares * (preload / machine.preload) ** machine.preload_power)


def friction_parts(
    machine: Machine,
    speed: float | Array,
    temperature: float | Array,
    *,
    warm: float | Array = 0.0,
    force: float | Array | None = None,
    condition: Condition = MOUNTED,
) -> dict[str, Array]:
    """
    Return the friction [N m] of the parts at the screw, without the sign of the motion.

    Speed [rad/s], temperature [K] of the oil, of which `warm` [K] lies over the hall, external
    force [N] (the standing force if none is given).

    """
    force = machine.standing_force if force is None else force
    turns = np.abs(speed) / PER_MINUTE  # [rev/min]
    oil = viscosity(machine.grade, temperature) * condition.viscosity
    slip = oil * turns / (STATED_VISCOSITY * STATED_SPEED)
    preload = machine.preload * condition.preload * (1.0 + machine.preload_rise * np.asarray(warm))
    upturn = machine.film * np.asarray(condition.film)
    # Where too little oil comes in, less of it is squeezed through the inlets, too.
    fed = np.asarray(condition.film) ** -0.25
    curve = stribeck(slip, machine.upturn, upturn) / stribeck(1.0, machine.upturn, machine.film)
    contacts = (1.0 - machine.rolling) * curve * nut_load(machine, force, preload)
    rolling = machine.rolling * slip**ROLLING_POWER * fed
    drag = machine.catalogue_factor * catalogue_drag(machine.size, machine.preload)
    grip = 1.0 + RUBBER * (temperature - CELSIUS - 20.0)
    thick = oil / STATED_VISCOSITY
    viscous = machine.wiper_viscous * np.sqrt(thick * turns / 1000.0)
    guide = 4.0 * machine.size.carriage + machine.guide_friction * (
        machine.size.mass * GRAVITY + 0.2 * np.abs(force)
    )
    grease = viscosity(machine.grade, temperature - np.asarray(warm)) / STATED_VISCOSITY
    travel = np.abs(speed) * machine.size.lead / (2.0 * math.pi)
    guide = guide + machine.guide_viscous * np.sqrt(grease) * travel
    factor = np.asarray(condition.every)
    return {
        'nut': factor * condition.nut * drag * (contacts + rolling),
        'wiper': factor * condition.wiper * machine.wiper * (grip + viscous),
        'bearing': factor * condition.bearing * bearing_friction(machine, oil * turns, force),
        'guideway': factor * condition.guideway * guide * machine.size.lead / (2.0 * math.pi),
    }


def friction(
    machine: Machine,
    speed: float | Array,
    temperature: float | Array,
    *,
    warm: float | Array = 0.0,
    force: float | Array | None = None,
    condition: Condition = MOUNTED,
) -> Array:
    """Return the sum [N m] of the parts; arguments as there, speed [rad/s], temperature [K]."""
    parts = friction_parts(
        machine, speed, temperature, warm=warm, force=force, condition=condition
    )
    return np.asarray(sum(parts.values()))


def stribeck(slip: float | Array, upturn: float, film: float | Array) -> Array:
    """Return the Stribeck curve over viscosity times speed: 1 + upturn at rest, 1 in full film."""
    return np.asarray(1.0 + upturn / (1.0 + (slip / film) ** 1.5))


def bearing_friction(machine: Machine, product: Array, force: float | Array) -> Array:
    """Return Palmgren's friction [N m]; product of oil and speed [mm2/s rev/min], force [N]."""
    mean = 1e3 * machine.size.bearing_diameter  # [mm]
    churned = np.maximum(product, PALMGREN_LIMIT) ** (2.0 / 3.0)
    load = machine.size.bearing_preload + 0.5 * np.abs(force)
    free = machine.bearing_f0 * 1e-7 * churned * mean**3  # [N mm]
    return 1e-3 * (free + machine.bearing_f1 * load * mean)
