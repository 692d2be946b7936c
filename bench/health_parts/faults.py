# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Faults of an axis: what they change, from which day and how fast."""

from dataclasses import dataclass, fields, replace

from health_parts.machine import Array, Condition, MOUNTED
import numpy as np

RAMP = 56.0  # [d] of a slow fault


@dataclass(frozen=True, kw_only=True, slots=True)
class Fault:
    """A part that changes to `size`, as a field of the condition, at once or over a ramp."""

    name: str
    part: str = ''  # field of the condition; nothing changes if empty
    size: float = 1.0  # the field's value in the end
    start: float = 182.0  # [d] of the year
    ramp: float = RAMP  # [d], 0 for a step

    def progress(self, day: float | Array) -> Array:
        """Return the share of the fault that is there at a day [d] of the year."""
        day = np.asarray(day, dtype=float)
        if self.ramp == 0.0:
            return np.where(day >= self.start, 1.0, 0.0)
        return np.clip((day - self.start) / self.ramp, 0.0, 1.0)

    def condition(self, day: Array) -> Condition:
        """Return the condition of the axis on days [d]."""
        if not self.part:
            return MOUNTED
        mounted = getattr(MOUNTED, self.part)
        value = mounted + (self.size - mounted) * self.progress(day)
        return replace(MOUNTED, **{self.part: value})


class Loosened(Fault):
    """A part that is nearly lost, and has play when three quarters of it are gone."""

    def condition(self, day: Array) -> Condition:
        """Return the condition of the axis on days [d]."""
        begin = self.start + 0.75 * self.ramp
        play = Fault(name='play', part='play', size=20e-6, start=begin, ramp=0.0)
        return joined(Fault.condition(self, day), play.condition(day))


CLEAN = Fault(name='clean')
FAULTS = {
    fault.name: fault
    for fault in (
        CLEAN,
        Fault(name='preload -10 %', part='preload', size=0.9),
        Fault(name='preload -20 %', part='preload', size=0.8),
        Fault(name='preload -40 %', part='preload', size=0.6),
        Fault(name='thinner oil', part='viscosity', size=0.68, ramp=0.0),
        Fault(name='thicker oil', part='viscosity', size=1.47, ramp=0.0),
        Fault(name='starved film', part='film', size=8.0),
        Fault(name='wiper swollen', part='wiper', size=2.0),
        Fault(name='wiper torn', part='wiper', size=0.3, ramp=0.0),
        Fault(name='torque constant -10 %', part='torque_constant', size=0.9),
        Fault(name='zero', part='zero', size=0.1, ramp=0.0),
        Fault(name='load gain', part='load_gain', size=0.85, ramp=0.0),
        Fault(name='guideway +25 %', part='guideway', size=1.25),
        Fault(name='support bearing', part='bearing', size=1.6),
        Fault(name='worn place', part='worn', size=1.3),
        Fault(name='play 20 um', part='play', size=20e-6),
    )
}


def joined(first: Condition, second: Condition) -> Condition:
    """Return both conditions at once: their factors multiplied, zeros and plays added."""
    both = {
        field.name: getattr(first, field.name) * getattr(second, field.name)
        for field in fields(Condition)
    }
    added = {name: getattr(first, name) + getattr(second, name) for name in ('zero', 'play')}
    return Condition(**both | added)


STEP = Fault(name='step of 10 %', part='torque_constant', size=1.0 / 0.9, ramp=0.0)
"""All torques fall by a tenth, at all speeds alike."""
LOOSENED = {
    fault.name: fault
    for fault in (
        Loosened(name='nut lost, with play', part='preload', size=0.1),
        Loosened(name='bearing loose, with play', part='bearing', size=0.1),
    )
}
