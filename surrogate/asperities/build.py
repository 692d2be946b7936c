# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The asperity law of a screw and its oil from marches of strips.

Strips with waves of a fifth of the contact, at many pressures and temperatures, give the curve;
two of them marched again with all waves, on the same places of the raceway, move its onset.

"""

from collections.abc import Callable, Mapping, Sequence
import contextlib
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
    LawSettings,
    strip_inputs,
    strip_runs,
    StripInputs,
    StripRun,
)
from surrogate.ehl.moving import MarchStatus
from surrogate.files import InputError
from surrogate.parameters import Lubricant, Screw

Array = NDArray[np.float64]
Marches = Mapping[str, Mapping[str, Any]]
SolveMarches = Callable[[Marches], Mapping[str, Mapping[str, Any] | None]]
"""Solves named marches of plain JSON; None for one that failed."""
NODES = np.linspace(-1.2, 0.75, 14)
"""Logarithms of the speed over that of the onset at which a law is tabulated [-]."""
FEWEST = 3
"""Least marches of which a law is made [-]."""
CONVERGED = (MarchStatus.CONVERGED.name, MarchStatus.SOME_STEPS.name)
STRIP, ALL_WAVES = 'strip', 'all waves'
NEAR = 1.05
"""Factor on a speed over which a slope is taken [-]."""
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

    @property
    def steepness(self) -> float:
        """Exponent of the ratio in the speed at the onset [-]."""
        speeds = self.onset * np.array([1 / NEAR, NEAR])
        slow, fast = film_over_acting(self.given.waves, self.given.line, speeds, self.given.oil)
        return float(math.log(fast / slow) / (2 * math.log(NEAR)))

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

    Raises InputError where fewer than `FEWEST` marches found an onset, as where roughness is so
    fine that it is flattened before it touches.

    """
    runs = strip_runs(screw, lubricant)
    fine = _given(screw, lubricant, runs[:TWINS], FINE)
    coarse = _given(screw, lubricant, runs, COARSE)
    if not coarse:
        strip_inputs(screw, lubricant, runs[0], COARSE)  # raises what it says of the roughness
    tasks = {f'{ALL_WAVES}, {name}': inputs_to_json(one) for name, one in fine.items()}
    tasks |= {f'{STRIP}, {name}': inputs_to_json(one) for name, one in coarse.items()}
    results = solve(tasks)
    marched = _marched(STRIP, coarse, results)
    if len(marched) < FEWEST:
        raise InputError(
            f'asperity law: {len(marched)} of {len(runs)} marches went through the speeds around '
            f'RCS {ONSET_RCS:g}, allowed is {FEWEST} or more'
        )
    all_waves = _marched(ALL_WAVES, fine, results)
    return fit_law(marched, all_waves, f'{screw.name}, {lubricant.name}')


def _given(
    screw: Screw, lubricant: Lubricant, runs: Sequence[StripRun], settings: LawSettings
) -> dict[str, StripInputs]:
    """Return the inputs of those marches of which an onset is expected, by their names."""
    given = {}
    for run in runs:
        with contextlib.suppress(InputError):
            given[run.name] = strip_inputs(screw, lubricant, run, settings)
    return given


def _marched(
    kind: str, given: Mapping[str, StripInputs], results: Mapping[str, Mapping[str, Any] | None]
) -> dict[str, Marched]:
    """Return the marches that converged and found an onset, by their names."""
    return {
        name: Marched(given=one, found=found)
        for name, one in given.items()
        if (found := results[f'{kind}, {name}'])
        and found['status'] in CONVERGED
        and not math.isnan(found['onset'])
    }


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
        math.log(one.onset / expected)
        for one in coarse.values()
        if (expected := one.expected(ratio * (one.pressure / first.pressure) ** power))
    ]
    deviation = float(np.std(missed, ddof=min(2, len(missed) - 1)))
    twins = [(coarse[name], one) for name, one in fine.items() if name in coarse]
    gains = [math.log(one.ratio / twin.ratio) for twin, one in twins] or [0.0]
    every = [*coarse.values(), *fine.values()]
    curves = {name: _falling([one.curve(name) for one in every]) for name in SHARES}
    curves['rcs'] *= ONSET_RCS / float(np.interp(0.0, NODES, curves['rcs']))
    shortest = min(one.given.shortest for one in every)
    return AsperityLaw(
        onset_ratio=ratio * math.exp(np.mean(gains)),
        film_floor=first.given.film_floor,
        pressure=first.pressure,
        pressure_power=power,
        log_speed=tuple(NODES.tolist()),
        **{name: tuple(values.tolist()) for name, values in curves.items()},
        loss_factor=tuple(_line([one.curve('loss_factor') for one in every]).tolist()),
        deviation=deviation,
        standard_error=math.hypot(
            deviation / math.sqrt(len(missed)), _scatter(gains) / every[-1].steepness
        ),
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


def _scatter(gains: Sequence[float]) -> float:
    """Return the standard error of the mean of some numbers [-], 0 for one."""
    return float(np.std(gains, ddof=1)) / math.sqrt(len(gains)) if len(gains) > 1 else 0.0


def _falling(curves: Sequence[Array]) -> Array:
    """
    Return the parabola through the logit of the mean of shares over `NODES` [-].

    A straight line where the parabola does not fall everywhere; InputError where that does not.

    """
    inside, mean, weight = _mean(curves)
    wanted = logit(np.clip(mean, NOTHING, 1 - NOTHING))
    for degree in (2, 1):
        values = np.polyval(np.polyfit(NODES[inside], wanted, degree, w=weight), NODES)
        if np.all(np.diff(values) < 0):
            return np.asarray(expit(values))
    raise InputError('asperity law: contact of the marches does not fall as the speed rises')


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
