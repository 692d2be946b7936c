# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A speed that changes slowly along one track: a whole column of speeds in one march.

What lags behind the speed shows where the same track is marched the other way.

"""

from collections.abc import Sequence
from dataclasses import dataclass, field
import math
import time

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.interface import ContactLubricant, RoughHeights
from surrogate.ehl.moving.interface import MarchSettings, MarchStatus
from surrogate.ehl.moving.line import StripContact
from surrogate.ehl.moving.march import check_transits, contact_march, strip_march
from surrogate.ehl.moving.run import March
from surrogate.ehl.moving.sums import Measure
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact

Array = NDArray[np.float64]
KNOTS_PER_E = 3.0
"""Smooth contacts that are solved over a factor e in speed [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SpeedRamp:
    """
    What a contact did while its speed changed.

    Entrainment speeds of the steps [m/s], central film of the smooth contact at each [m], share of
    the load on punctured nodes, share that asperities carry, rolling loss over that of the
    smooth contact and share of converged steps, averages over the places [-]; steps of a
    transit; status, steps, those that did not converge, wall time [s]. A march that ended early
    holds the steps that all places have.

    """

    status: MarchStatus
    speeds: Array = field(default_factory=lambda: np.empty(0))
    central_films: Array = field(default_factory=lambda: np.empty(0))
    rcs: Array = field(default_factory=lambda: np.empty(0))
    asperity_share: Array = field(default_factory=lambda: np.empty(0))
    loss_factor: Array = field(default_factory=lambda: np.empty(0))
    converged: Array = field(default_factory=lambda: np.empty(0))
    transit: float = math.nan
    steps: int = 0
    steps_failed: int = 0
    wall_time: float = 0.0

    def means(self, transits: float, name: str = 'rcs') -> tuple[Array, Array]:
        """Return speeds [m/s] and RCS or another share [-], each the mean of so many transits."""
        count = max(1, round(self.speeds.size / (transits * self.transit)))
        parts = np.array_split(np.arange(self.speeds.size), count)
        logs = np.log(self.speeds)
        return (
            np.array([math.exp(logs[part].mean()) for part in parts]),
            np.array([getattr(self, name)[part].mean() for part in parts]),
        )

    def film_at(self, speed: float) -> float:
        """Return the smooth central film [m] at an entrainment speed [m/s] of the ramp."""
        order = np.argsort(self.speeds)
        return float(np.interp(speed, self.speeds[order], self.central_films[order]))

    def failed_share(self, speed: float, transits: float = 2.0) -> float:
        """Return the share of steps about a speed [m/s] that failed, over a mean each way [-]."""
        speeds, converged = self.means(transits, 'converged')
        nearest = np.argsort(np.abs(np.log(speeds / speed)))[:2]
        return float(1 - converged[nearest].mean())

    def onset(self, rcs: float = 0.01, transits: float = 2.0) -> float:
        """
        Return the speed at which RCS passes a value [m/s]; NaN if it does not on this ramp.

        Log-linear between means over so many transits, which are first made to rise as the speed
        falls, neighbours being averaged where they do not.

        """
        speeds, means = self.means(transits)
        order = np.argsort(-speeds)
        logs, rising = np.log(speeds[order]), _rising(means[order])
        if not (rising[0] < rcs <= rising[-1]):
            return math.nan
        last = int(np.argmax(rising >= rcs))
        low, high = (math.log(max(rising[k], 1e-9)) for k in (last - 1, last))
        weight = (math.log(rcs) - low) / (high - low)
        return math.exp(logs[last - 1] + weight * (logs[last] - logs[last - 1]))


def _rising(values: Array) -> Array:
    """Return the rising sequence nearest to `values` [any]: neighbours that fall are pooled."""
    pools: list[list[float]] = []
    for value in values:
        pools.append([float(value), 1.0])
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (high, many), (low, few) = pools[-2:]
            pools[-2:] = [[(high * many + low * few) / (many + few), many + few]]
    return np.concatenate([np.full(int(count), value) for value, count in pools])


def ramp_contact(
    contact: Contact,
    lubricant: ContactLubricant,
    load: float,
    speeds: tuple[float, float],
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings,
) -> SpeedRamp:
    """
    March a contact under a load [N] while its speed goes from one of `speeds` to the other [m/s].

    The logarithm of the speed changes evenly over the `transits`, which are shared over the
    places. Raises InputError as `march_contact`, and for speeds that are not above 0.

    """
    check_transits(transits, settings)
    with at(stage='rolling contact'):
        march = contact_march(contact, lubricant, load, knots(speeds), raceway, settings)
        return _ramp(march, transits)


def ramp_strip(
    strip: StripContact,
    lubricant: ContactLubricant,
    speeds: tuple[float, float],
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings,
    enough: float = math.inf,
    turn: float = 2.0,
) -> SpeedRamp:
    """
    March a strip while its speed goes from one of `speeds` to the other [m/s]; see above.

    It ends sooner where the mean RCS over the transits of a `turn` is `enough` [-].

    """
    check_transits(transits, settings)
    with at(stage='rolling contact'):
        march = strip_march(strip, lubricant, knots(speeds), raceway, settings)
        march.enough, march.turn = enough, max(1, round(turn * _steps_of_transit(march)))
        return _ramp(march, transits)


def knots(speeds: tuple[float, float]) -> Sequence[float]:
    """Return the speeds [m/s] at which the smooth contact is solved."""
    first, last = speeds
    if not (0 < first < math.inf and 0 < last < math.inf and first != last):
        raise InputError(f'speeds is {speeds!r} m/s, allowed are two, different and above 0')
    count = 2 + math.ceil(KNOTS_PER_E * abs(math.log(first / last)))
    return [float(speed) for speed in np.geomspace(first, last, count)]


def _ramp(march: March, transits: float) -> SpeedRamp:
    began = time.perf_counter()
    march.run(transits / march.settings.places)
    shortest = min(map(len, march.places), default=0)
    steps = [place[:shortest] for place in march.places]
    speeds = np.array([step.speed for place in steps[:1] for step in place])
    films = losses = np.empty(0)
    if march.path is not None and speeds.size:  # of the smooth contact at these speeds
        order, smooth = np.argsort(march.path.speeds), march.smooth_measures()
        knots = np.log(march.path.speeds)[order]
        films, losses = (
            np.exp(np.interp(np.log(speeds), knots, np.log(values)[order]))
            for values in (
                [measure.centre_film for measure in smooth],
                [measure.rolling_loss for measure in smooth],
            )
        )
    return SpeedRamp(
        status=march.status,
        speeds=speeds,
        central_films=films,
        rcs=_over_places(steps, 'rcs'),
        asperity_share=_over_places(steps, 'asperity_share'),
        loss_factor=_over_places(steps, 'rolling_loss') / losses,
        converged=_over_places(steps, 'converged'),
        transit=_steps_of_transit(march),
        steps=march.steps,
        steps_failed=march.failed,
        wall_time=time.perf_counter() - began,
    )


def _steps_of_transit(march: March) -> float:
    return 2 / (march.settings.stride * march.grid.dx)


def _over_places(places: Sequence[Sequence[Measure]], name: str) -> Array:
    """Return the mean over the places of a number of each step, in its unit [any]."""
    tracks = [[getattr(step, name) for step in place] for place in places]
    return np.asarray(np.mean(tracks, axis=0)) if tracks else np.empty(0)
