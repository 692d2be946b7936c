# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Differences from log to log apart from a fault: seasons, wander, running-in, grease and scatter.

Fresh grease raises the friction for a while, and new seals run in, by the catalogues of profile
rails. The sizes are assumed, as nobody publishes a year of one axis.

"""

from dataclasses import dataclass
import math

from health_parts.machine import Array, CELSIUS, Condition
import numpy as np

WANDER_TIME = 105.0  # [d] fifteen weeks
RUNNING_IN_TIME = 28.0  # [d]


@dataclass(frozen=True, kw_only=True, slots=True)
class Weather:
    """What differs from log to log, apart from the fault; all of one length."""

    hall: Array  # [K]
    warmth: Array  # share of the warm-up at the start
    condition: Condition  # wander, running-in and fresh grease
    scatter: Array  # factor of the day


def draw_weather(
    day: Array,
    rng: np.random.Generator,
    *,
    wander: float | None = None,
    scatter: float | None = None,
) -> Weather:
    """Return the weather of days [d]: wander and scatter are drawn unless they are given."""
    count = len(day)
    hall = hall_temperature(day, rng.uniform(3.0, 6.0)) + rng.normal(0.0, 1.0, count)
    low = rng.uniform(0.0, 0.7)  # some machines are logged cold, some in the middle of a shift
    warmth = rng.uniform(low, low + 0.3, count)
    drawn = rng.uniform(0.0, 0.03), rng.uniform(0.01, 0.03)
    wander = drawn[0] if wander is None else wander
    scatter = drawn[1] if scatter is None else scatter
    # Nut and seals wander apart, so that together they do so by the wander.
    nut, seals = (1.0 + math.sqrt(2.0) * wander * wandering(day, rng) for _ in range(2))
    fresh = rng.uniform(0.04, 0.12) * fresh_grease(day, rng)
    new = rng.uniform(0.08, 0.12) * float(rng.random() < 0.3)
    run_in = 1.0 + new * np.exp(-day / RUNNING_IN_TIME)
    seals = (seals * run_in)[:, None]
    return Weather(
        hall=hall,
        warmth=warmth,
        condition=Condition(
            nut=(nut * run_in * (1.0 + fresh))[:, None],
            wiper=seals,
            guideway=seals,
            bearing=nut[:, None],
        ),
        scatter=np.exp(scatter * rng.standard_normal(count)),
    )


def hall_temperature(day: Array, amplitude: float) -> Array:
    """Return the hall [K] on days [d]: coldest in mid January, with an annual amplitude [K]."""
    annual = -np.cos(2.0 * math.pi * (day - 15.0) / 365.0)
    daily = -np.cos(2.0 * math.pi * (day - 0.2))
    return CELSIUS + 21.0 + amplitude * annual + 1.5 * daily


def wandering(day: Array, rng: np.random.Generator) -> Array:
    """Return an autoregressive walk of unit variance on days [d]."""
    kept = np.exp(-np.diff(day) / WANDER_TIME)
    steps = rng.standard_normal(len(day))
    walk = np.empty_like(day)
    walk[0] = steps[0]
    for k, keeps in enumerate(kept, 1):
        walk[k] = keeps * walk[k - 1] + math.sqrt(1.0 - keeps**2) * steps[k]
    return walk


def fresh_grease(day: Array, rng: np.random.Generator) -> Array:
    """Return how fresh the grease is on days [d]: 1 when it came, every quarter, to 0."""
    times = np.arange(-91.0, day[-1], 91.0)
    times = times + rng.uniform(-10.0, 10.0, len(times))
    since = day[:, None] - times
    return np.max(np.where(since >= 0.0, np.exp(-np.maximum(since, 0.0) / 6.0), 0.0), axis=1)
