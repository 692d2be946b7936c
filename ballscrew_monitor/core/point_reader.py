# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From the last samples of the inputs to the operating point of one instant."""

from collections.abc import Mapping
import math

from ballscrew_monitor.core.conversions import Direction, direction_of
from ballscrew_monitor.core.derived_load import derive_load, DerivedLoad, Running, STANDSTILL
from ballscrew_monitor.core.differentiation import SlopeFilter
from ballscrew_monitor.core.estimate import MachinePoint, PointSource
from ballscrew_monitor.core.input_status import InputState, Tracker
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.state import MonitorSettings
from surrogate.surface import Surface

NAN = math.nan
Inputs = Mapping[Source, Tracker]
Reading = tuple[float, PointSource]  # a number and where it comes from
LoadReading = tuple[float, PointSource, DerivedLoad | None]
_FRESH = (PointSource.MEASURED, PointSource.DEFAULT)


class PointReader:
    """Reads the inputs; remembers the direction, the speeds of late, and the last derived load."""

    def __init__(self, settings: MonitorSettings) -> None:
        """Begin without motion."""
        self._direction = Direction.UNKNOWN
        self._held_load = NAN
        self._speeds: SlopeFilter | None = None
        if settings.derivation is not None and settings.derivation.inertia:
            timeout = settings.timeouts[Source.SPEED]
            self._speeds = SlopeFilter(window=settings.derivation.window, max_gap=timeout)

    def take_speed(self, sample: InputSample) -> None:
        """Take a good sample of the speed; the acceleration follows from them."""
        if self._speeds is not None:
            self._speeds.take(sample.stamp, sample.value)

    def forget_direction(self) -> None:
        """Forget which way the screw turned: another time line has begun."""
        self._direction = Direction.UNKNOWN

    def point(
        self, inputs: Inputs, now: int, settings: MonitorSettings, surface: Surface
    ) -> MachinePoint:
        """Return the operating point of what has arrived by `now` [ns]."""
        speed, speed_source = _value(inputs[Source.SPEED], now)
        temperature, temperature_source = _value(inputs[Source.TEMPERATURE], now)
        if temperature_source is PointSource.DEFAULT:
            temperature = settings.default_temperature
        torque, torque_source = _value(inputs[Source.TORQUE], now)
        moving = abs(speed) >= settings.limits.standstill_speed
        if moving and speed_source is PointSource.MEASURED:
            self._direction = direction_of(speed)
        load, load_source = _value(inputs[Source.LOAD], now)
        derived = None
        if settings.derivation is not None:
            fresh = {speed_source, temperature_source, torque_source}.issubset(_FRESH)
            running = Running(
                speed=speed,
                acceleration=NAN if self._speeds is None else self._speeds.slope,
                acceleration_change=NAN if self._speeds is None else self._speeds.change,
                motor_torque=torque,
                temperature=temperature,
                direction=self._direction,
            )
            load, load_source, derived = self._derive(running, settings, surface, moving, fresh)
        return MachinePoint(
            speed=speed,
            axial_load=load,
            temperature=temperature,
            motor_torque=torque,
            speed_source=speed_source,
            axial_load_source=load_source,
            temperature_source=temperature_source,
            motor_torque_source=torque_source,
            direction=self._direction,
            direction_held=not moving and self._direction is not Direction.UNKNOWN,
            derived=derived,
        )

    def _derive(
        self,
        running: Running,
        settings: MonitorSettings,
        surface: Surface,
        moving: bool,
        fresh: bool,
    ) -> LoadReading:
        """Return the derived load; the last one is held while an input is not `fresh`."""
        if not fresh:
            held = math.isfinite(self._held_load)
            source = PointSource.HELD if held else PointSource.UNKNOWN
            return self._held_load, source, DerivedLoad()
        if moving:
            assert settings.derivation is not None
            found = derive_load(running, surface, settings.derivation)
        else:
            found = DerivedLoad(reason=STANDSTILL)
        self._held_load = found.axial_load
        known = math.isfinite(found.axial_load)
        source = PointSource.DERIVED if known else PointSource.UNKNOWN
        return found.axial_load, source, found


def _value(tracker: Tracker, now: int) -> Reading:
    """Return the last value and its standing; one that was followed by a bad one is held."""
    if not tracker.configured:
        has_default = tracker.source is Source.TEMPERATURE
        return NAN, PointSource.DEFAULT if has_default else PointSource.UNKNOWN
    if tracker.last is None:
        return NAN, PointSource.UNKNOWN
    good = tracker.state(now) is InputState.OK
    return tracker.last.value, PointSource.MEASURED if good else PointSource.HELD
