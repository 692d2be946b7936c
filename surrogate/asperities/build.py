# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The asperity law of a screw and its oil from marches of strips.

Strips with waves of a fifth of the contact, at many pressures and temperatures, give the curve;
two of them marched again with all waves, on the same places of the raceway, move its onset.

"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logit
from surrogate.asperities.acting import film_over_acting, speed_at_ratio
from surrogate.asperities.law import AsperityLaw, NOTHING, ONSET_RCS
from surrogate.asperities.marches import (
    COARSE,
    FINE,
    inputs_to_json,
    strip_inputs,
    strip_runs,
    StripInputs,
)
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]
Marches = Mapping[str, Mapping[str, Any]]
SolveMarches = Callable[[Marches], Mapping[str, Mapping[str, Any] | None]]
"""Solves named marches of plain JSON; None for one that failed."""
NODES = np.linspace(-1.2, 0.75, 14)
"""Logarithms of the speed over that of the onset at which a law is tabulated [-]."""
APART = 0.2
"""Least span of the logarithm of the pressure over which a power is fitted [-]."""
SHARES = ('rcs', 'asperity_share')
TWINS = 2
"""First marches of a law that are made again with all waves [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Marched:
    """A march, what it returned, and the film over the acting rms at its onset [-]."""

    given: StripInputs
    found: Mapping[str, Any]

    @property
    def onset(self) -> float:
        """Entrainment speed of the onset [m/s]."""
        return float(self.found['onset'])

    @property
    def pressure(self) -> float:
        """Hertz pressure of the strip [Pa]."""
        return self.given.strip.max_pressure

    @property
    def ratio(self) -> float:
        """Smooth film by formula over the rms of the acting waves that were marched [-]."""
        speed = np.array(self.onset)
        return float(film_over_acting(self.given.waves, self.given.line, speed, self.given.oil))

    def expected(self, ratio: float) -> float:
        """Return the speed of the onset [m/s] that a ratio [-] gives this march."""
        wanted = np.array(ratio)
        return float(speed_at_ratio(self.given.waves, self.given.line, self.given.oil, wanted))

    def curve(self, name: str) -> Array:
        """Return a column of the march over `NODES` [-]; NaN beyond its speeds."""
        order = np.argsort(self.found['speed'])
        x = np.log(np.array(self.found['speed'])[order] / self.onset)
        values = np.array(self.found[name])[order]
        return np.interp(NODES, x, values, left=np.nan, right=np.nan)


def build_law(screw: Screw, lubricant: Lubricant, solve: SolveMarches) -> AsperityLaw:
    """
    Return the law of a screw and oil from marches that `solve` makes.

    Raises InputError where no march found an onset, as for smooth raceways.

    """
    runs = strip_runs(screw, lubricant)
    given = {
        name: {run.name: strip_inputs(screw, lubricant, run, settings) for run in some}
        for name, some, settings in (('all waves', runs[:TWINS], FINE), ('strip', runs, COARSE))
    }
    tasks = {
        f'{kind}, {name}': inputs_to_json(one)
        for kind, some in given.items()
        for name, one in some.items()
    }
    results = solve(tasks)
    fine, coarse = (
        {
            name: Marched(given=one, found=found)
            for name, one in some.items()
            if (found := results[f'{kind}, {name}']) and not math.isnan(found['onset'])
        }
        for kind, some in given.items()
    )
    if not coarse:
        raise InputError('asperity law: no march through the speeds around 0.01 of RCS succeeded')
    return fit_law(coarse, fine, f'{screw.name}, {lubricant.name}')


def fit_law(
    coarse: Mapping[str, Marched], fine: Mapping[str, Marched], source: str
) -> AsperityLaw:
    """
    Return the law of marches by the name of their run; `source` names screw and oil.

    The ratio is that of the coarse marches, a power of the pressure, times what all waves make of
    the same places; without fine marches it is that of the coarse ones.

    """
    first = next(iter(coarse.values()))
    power, ratio = _over_pressure(list(coarse.values()), first.pressure)
    missed = [
        math.log(one.onset / one.expected(ratio * (one.pressure / first.pressure) ** power))
        for one in coarse.values()
    ]
    twins = [(coarse[name], one) for name, one in fine.items() if name in coarse]
    gain = float(np.mean([math.log(one.ratio / twin.ratio) for twin, one in twins] or [0.0]))
    every = [*coarse.values(), *fine.values()]
    curves = {name: _falling([one.curve(name) for one in every]) for name in SHARES}
    curves['rcs'] *= ONSET_RCS / float(np.interp(0.0, NODES, curves['rcs']))
    shortest = min(one.given.shortest for one in every)
    return AsperityLaw(
        onset_ratio=ratio * math.exp(gain),
        film_floor=first.given.film_floor,
        pressure=first.pressure,
        pressure_power=power,
        log_speed=tuple(NODES.tolist()),
        **{name: tuple(values.tolist()) for name, values in curves.items()},
        loss_factor=tuple(_line([one.curve('loss_factor') for one in every]).tolist()),
        deviation=float(np.std(missed, ddof=min(2, len(missed) - 1))),
        marches=len(every),
        shortest_wave=shortest,
        source=source,
    )


def _over_pressure(marches: Sequence[Marched], pressure: float) -> tuple[float, float]:
    """Return the power of the ratio of marches over pressure and the ratio at one [Pa]."""
    x = np.log([one.pressure / pressure for one in marches])
    y = np.log([one.ratio for one in marches])
    if np.ptp(x) < APART:
        return 0.0, float(np.exp(y.mean()))
    power, level = np.polyfit(x, y, 1)
    return float(power), float(np.exp(level))


def _falling(curves: Sequence[Array]) -> Array:
    """Return the parabola through the logit of the mean of shares over `NODES` [-]."""
    inside, mean, weight = _mean(curves)
    fit = np.polyfit(NODES[inside], logit(np.clip(mean, NOTHING, 1 - NOTHING)), 2, w=weight)
    return np.asarray(expit(np.minimum.accumulate(np.polyval(fit, NODES))))


def _line(curves: Sequence[Array]) -> Array:
    """Return the straight line through the mean of numbers over `NODES` [-]."""
    inside, mean, weight = _mean(curves)
    return np.asarray(np.polyval(np.polyfit(NODES[inside], mean, 1, w=weight), NODES))


def _mean(curves: Sequence[Array]) -> tuple[NDArray[np.bool_], Array, Array]:
    """Return which of `NODES` any curve reaches, the mean there [-], and its weight [-]."""
    known = np.array(curves)
    count = np.isfinite(known).sum(axis=0)
    inside = count > 0
    mean = np.nansum(known[:, inside], axis=0) / count[inside]
    return inside, mean, np.sqrt(count[inside])
