# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sums over time: statistics of the current window, and totals since they were reset."""

from collections.abc import Mapping, Sequence
import dataclasses
import math

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate
from ballscrew_monitor.core.judgement import Gate, Verdict, Zone
from surrogate.surface import Regime
from surrogate.units import TURN

NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Extremes:
    """Smallest, mean and largest value, NaN when there was none."""

    low: float = NAN
    mean: float = NAN
    high: float = NAN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class WindowStatistics:
    """Extremes since the last publication: [rad/s], [N], [-], [-], [-]."""

    count: int
    speed: Extremes
    axial_load: Extremes
    efficiency: Extremes
    rcs: Extremes
    film_ratio: Extremes


class Column:
    """Running extremes and sum of one quantity."""

    __slots__ = ('count', 'low', 'high', 'total')

    def __init__(self) -> None:
        self.count = 0
        self.low = math.inf
        self.high = -math.inf
        self.total = 0.0

    def add(self, value: float) -> None:
        self.count += 1
        self.total += value
        if value < self.low:
            self.low = value
        if value > self.high:
            self.high = value

    def add_many(self, values: Sequence[float]) -> None:
        if values:
            self.count += len(values)
            self.low = min(self.low, min(values))
            self.high = max(self.high, max(values))
            for value in values:  # not sum(), which may add in a cleverer way
                self.total += value

    def extremes(self) -> Extremes:
        if not self.count:
            return Extremes()
        return Extremes(low=self.low, mean=self.total / self.count, high=self.high)


class WindowTally:
    """
    Statistics of the samples that were judged, until they are taken.

    Efficiency has values only from the samples whose efficiency was judged.

    """

    def __init__(self) -> None:
        """Begin empty."""
        self._clear()

    def _clear(self) -> None:
        self._speed, self._load = Column(), Column()
        self._efficiency, self._rcs, self._film_ratio = Column(), Column(), Column()

    def add(self, point: MachinePoint, estimate: PointEstimate, verdict: Verdict) -> None:
        """Add one sample, if it was judged."""
        if verdict.zone is Zone.UNKNOWN or estimate.numbers is None:
            return
        self._speed.add(point.speed)
        self._load.add(point.axial_load)
        self._rcs.add(estimate.rcs)
        self._film_ratio.add(estimate.numbers.film_ratio)
        if Gate.LIGHT_LOAD not in verdict.gates:
            self._efficiency.add(estimate.efficiency)

    def add_many(
        self,
        *,
        speed: Sequence[float],
        axial_load: Sequence[float],
        rcs: Sequence[float],
        film_ratio: Sequence[float],
        efficiency: Sequence[float],
    ) -> None:
        """
        Add samples that were judged, in order.

        speed [rad/s], axial_load [N], rcs, film_ratio, and efficiency where it was judged [-].

        """
        self._speed.add_many(speed)
        self._load.add_many(axial_load)
        self._rcs.add_many(rcs)
        self._film_ratio.add_many(film_ratio)
        self._efficiency.add_many(efficiency)

    def take(self) -> WindowStatistics:
        """Return the statistics and begin anew."""
        taken = WindowStatistics(
            count=self._speed.count,
            speed=self._speed.extremes(),
            axial_load=self._load.extremes(),
            efficiency=self._efficiency.extremes(),
            rcs=self._rcs.extremes(),
            film_ratio=self._film_ratio.extremes(),
        )
        if taken.count:
            self._clear()
        return taken


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Totals:
    """
    Sums since they were reset.

    Times [ns] so that they add up exactly, angle [rad] of both directions counted up, energy_lost
    [J]; `since` is the stamp [ns] of their first sample, 0 before it.

    """

    running_time: int = 0
    unjudged_time: int = 0
    boundary_time: int = 0
    mixed_time: int = 0
    hydrodynamic_time: int = 0
    optimal_time: int = 0
    outside_time: int = 0
    angle: float = 0.0
    energy_lost: float = 0.0
    since: int = 0

    @property
    def revolutions(self) -> float:
        """Return the revolutions of the screw [-]."""
        return self.angle / TURN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Moment:
    """What the totals need to know of one sample."""

    stamp: int
    speed: float  # amount [rad/s], 0 at standstill
    power_lost: float  # [W]
    regime: Regime
    zone: Zone


def moment(stamp: int, point: MachinePoint, estimate: PointEstimate, verdict: Verdict) -> Moment:
    """Return what the totals need to know of the sample at `stamp` [ns]."""
    speed = 0.0 if Gate.STANDSTILL in verdict.gates else abs(point.speed)
    power = 0.0 if estimate.numbers is None else estimate.numbers.friction_torque * speed
    return Moment(
        stamp=stamp,
        speed=speed,
        power_lost=power if math.isfinite(power) else 0.0,
        regime=estimate.regime,
        zone=verdict.zone,
    )


class Account:
    """Totals; each sample is taken to last until the next one."""

    def __init__(self) -> None:
        """Begin at zero."""
        self.reset()
        self._last: Moment | None = None

    def reset(self) -> None:
        """Set every sum to zero."""
        self._running = self._unjudged = 0
        self._in_regime = dict.fromkeys(Regime, 0)
        self._in_zone = dict.fromkeys(Zone, 0)
        self._angle = self._energy = 0.0
        self._since = 0

    def take_up(self, kept: Totals) -> None:
        """Add sums that were kept from before."""
        self._running += kept.running_time
        self._unjudged += kept.unjudged_time
        self._in_regime[Regime.BOUNDARY] += kept.boundary_time
        self._in_regime[Regime.MIXED] += kept.mixed_time
        self._in_regime[Regime.HYDRODYNAMIC] += kept.hydrodynamic_time
        self._in_zone[Zone.OPTIMAL] += kept.optimal_time
        self._in_zone[Zone.OUTSIDE] += kept.outside_time
        self._angle += kept.angle
        self._energy += kept.energy_lost
        self._since = kept.since or self._since

    def move(self, shift: int) -> None:
        """Move the beginning by `shift` [ns] with the clock, so that it lies as far back."""
        self._since = max(0, self._since + shift) if self._since else 0

    def forget(self) -> None:
        """Forget the last sample, so that nothing is added up to the next one."""
        self._last = None

    def add(self, now: Moment, *, max_gap: int) -> None:
        """Add the time since the last sample, unless that is longer than `max_gap` [ns]."""
        last, self._last = self._last, now
        self._since = self._since or now.stamp
        if last is None or last.speed == 0.0 or not 0 < now.stamp - last.stamp <= max_gap:
            return
        span = now.stamp - last.stamp
        self._running += span
        self._angle += last.speed * seconds(span)
        self._energy += last.power_lost * seconds(span)
        if last.zone is Zone.UNKNOWN:
            self._unjudged += span
            return
        self._in_regime[last.regime] += span
        self._in_zone[last.zone] += span

    @property
    def last(self) -> Moment | None:
        """Return the last sample."""
        return self._last

    def add_sums(
        self,
        *,
        running: int,
        unjudged: int,
        in_regime: Mapping[Regime, int],
        in_zone: Mapping[Zone, int],
        angles: Sequence[float],
        energies: Sequence[float],
        first: int,
        last: Moment,
    ) -> None:
        """
        Add the sums over samples from the `first` stamp to the `last` one, as `add` would.

        Times and stamp [ns]; `angles` [rad] and `energies` [J] in their order.

        """
        self._running += running
        self._unjudged += unjudged
        for regime, time in in_regime.items():
            self._in_regime[regime] += time
        for zone, time in in_zone.items():
            self._in_zone[zone] += time
        for angle, energy in zip(angles, energies, strict=True):
            self._angle += angle
            self._energy += energy
        self._since = self._since or first
        self._last = last

    def totals(self) -> Totals:
        """Return the sums."""
        return Totals(
            running_time=self._running,
            unjudged_time=self._unjudged,
            boundary_time=self._in_regime[Regime.BOUNDARY],
            mixed_time=self._in_regime[Regime.MIXED],
            hydrodynamic_time=self._in_regime[Regime.HYDRODYNAMIC],
            optimal_time=self._in_zone[Zone.OPTIMAL],
            outside_time=self._in_zone[Zone.OUTSIDE],
            angle=self._angle,
            energy_lost=self._energy,
            since=self._since,
        )
