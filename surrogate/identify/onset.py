# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset factor of a machine from the upturn of its torque at low speed: profile, interval, bound.

One lumped factor on the onset speed: it holds what sheet, running in, film floor and law are off
by together. Seals whose drag fades with the speed turn the torque up, too, so at every factor they
fade as fits best: the interval holds what any of them allows. The upturn lies well below the
onset, at which RCS is 0.01 and no torque shows, so the interval adds the scatter of marched strips
about the curve of the law by which the onset is extrapolated.

"""

from collections.abc import Callable
from dataclasses import dataclass
import math

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import t as student
from surrogate.identify.data import Array, NoLoadRun
from surrogate.identify.intervals import CONFIDENCE, student_factor
from surrogate.identify.model import ContactModel, ONSET_BOUNDS
from surrogate.identify.problem import DragProblem
from surrogate.raceway.fractal import Lay
from surrogate.raceway.stated import NINE_OF_TEN
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, with_raceway
from surrogate.units import digits, RPM

FITTED = ('asperity_friction', 'onset_factor', 'seal_torque')
"""What is fitted beside the parasitic torque where the onset is."""
SCANNED = np.geomspace(*ONSET_BOUNDS, 49)
"""Onset factors at which the rest is fitted [-]."""
EXTRAPOLATION = {'isotropic': 0.16, 'longitudinal': 0.41, 'transverse': 0.41}
"""Standard deviation of the logarithm of the onset between a marched strip and the curve of the
law laid through its RCS at a half and a quarter of that speed, by the lay: of 58 and 17 marches
[-]."""
MOST_SEAL, WORST = 0.5, 1.5
"""Fading drag over the constant one, as tried in `studies/onset_machines.py`, and residual without
an onset over that with the best one [-]: the most that is accepted."""
SMALL = 0.01
"""Root mean square of a residual over the mean torque [-] that is accepted anyway."""
WIDEST = 2.5
"""Band of nine of ten [-] beyond which a run tells no more than the law does without one."""


@dataclass(frozen=True, kw_only=True, slots=True)
class OnsetScan:
    """
    Sum of squared residuals at each of `SCANNED`, and where it is least.

    Best factor [-] and ends of the interval by the profile [-], 0 and infinity where the data set
    none; degrees of freedom; standard deviation of the `extrapolation` to the onset [-].

    """

    costs: Array
    best: float
    low: float
    high: float
    freedom: int
    extrapolation: float

    def interval(self, value: float) -> tuple[float, float]:
        """Return the ends of the 95 % interval about a value [-], extrapolation and all."""
        wide = student_factor(self.freedom) * self.extrapolation
        ends = math.log(value / self.low), math.log(self.high / value)
        below, above = (math.hypot(end, wide) for end in ends)
        return value * math.exp(-below), value * math.exp(above)

    def bound(self, stated: float) -> tuple[float, str]:
        """Return the factor nearest to the `stated` one [-] that may be, and the reason."""
        wide = math.exp(float(student.ppf(CONFIDENCE, math.inf)) * self.extrapolation)
        least, most = self.low / wide, self.high * wide
        if self.closed:
            least, most = self.interval(self.best)
            reason = (
                f'seals that fade by other speeds leave {least:.3g} to {most:.3g} (95 %), allowed '
                f'for a calibration is a band of {WIDEST:g} in nine of ten'
            )
        elif self.low:
            reason = f'the torque does not rise at high speed: at least {least:.3g} (95 %)'
        elif math.isfinite(self.high):
            reason = (
                'the torque turns up at low speed no more than with a seal that fades: at most '
                f'{most:.3g} (95 %), the factor of the datasheet is kept'
            )
        else:
            reason = 'the torque tells nothing of it: kept as in the datasheet'
        return min(max(stated, least), most), reason

    @property
    def closed(self) -> bool:
        """Return True if the data set both ends."""
        return self.low > 0 and math.isfinite(self.high)

    @property
    def calibrates(self) -> bool:
        """Return True if the interval is narrow enough to be of use."""
        return self.closed and calibrated_band(*self.interval(self.best)) <= WIDEST


def scan_onset(cost: Callable[[float], tuple[float, float]], freedom: int, lay: Lay) -> OnsetScan:
    """
    Return the profile of a fit over the onset factor, with `freedom` degrees of freedom.

    `cost` fits the rest at a factor [-] and returns the sum of squared residuals and the mean
    square of the misfit. The interval holds the factors whose sum is within t^2 of the least one,
    in units of the larger one of its mean square and the misfit.

    """
    costs, misfits = np.array([cost(factor) for factor in SCANNED.tolist()]).T
    best = int(costs.argmin())
    variance = np.fmax(costs[best] / freedom, misfits[best])
    excess = (costs - costs[best]) / max(variance, np.finfo(float).tiny)
    over = excess - student_factor(freedom) ** 2
    near = np.log(SCANNED[[max(best - 1, 0), min(best + 1, len(SCANNED) - 1)]])
    least = minimize_scalar(lambda x: cost(math.exp(x))[0], bounds=near, method='bounded')
    return OnsetScan(
        costs=costs,
        best=math.exp(least.x) if least.fun < costs[best] else float(SCANNED[best]),
        low=_crossing(over[best::-1], SCANNED[best::-1], 0.0),
        high=_crossing(over[best:], SCANNED[best:], math.inf),
        freedom=freedom,
        extrapolation=EXTRAPOLATION[lay],
    )


def _crossing(over: Array, factors: Array, none: float) -> float:
    """Return the last factor that is allowed, from the best on outwards."""
    outside = over > 0
    # Beyond a rise the profile may fall again; what lies there is allowed, too.
    last = int(np.flatnonzero(~outside)[-1])
    if last == len(over) - 1:
        return none
    share = over[last] / (over[last] - over[last + 1])
    low, high = np.log(factors[[last, last + 1]])
    return float(np.exp(low + share * (high - low)))


def refusal_of(
    problem: DragProblem, scan: OnsetScan, values: Array, residual: Array, sigma: Array
) -> str:
    """
    Return why the onset among the `values` of a fit cannot be that of the screw, else nothing.

    Drag beside the contacts that fades with the speed takes the friction to its bound, the onset
    to speeds that were not measured, or most of the drag. Where an end is open, or both are wide,
    the `residual` that the values leave is held against the least one, both over `sigma` [N m].

    """
    given = dict(zip(problem.names, values.tolist(), strict=True))
    slowest, *_, fastest = np.sort(np.abs(problem.run.speed)) / RPM
    factor, bounds = scan.best, problem.at_bounds(values)
    causes = []
    if scan.calibrates:
        factor = given['onset_factor']
        if 'asperity_friction' in bounds:
            causes.append(f'asperity_friction is {bounds["asperity_friction"]}')
        if given['seal_torque'] > MOST_SEAL * given['parasitic_torque']:
            causes.append(
                f'seal_torque is {given["seal_torque"]:.3g} N m, allowed is {MOST_SEAL:g} of the '
                f'parasitic torque of {given["parasitic_torque"]:.3g} N m'
            )
    elif (
        np.sum((residual / sigma) ** 2) > WORST**2 * scan.costs.min()
        and np.mean(residual**2) > (SMALL * np.abs(problem.run.torque).mean()) ** 2
    ):
        causes.append(
            f'with the friction of the datasheet the residual is {WORST:g} times the least or more'
        )
    onset = onset_speeds(problem.contacts, problem.run, (factor, math.nan, math.nan))[0] / RPM
    if scan.low and not slowest <= onset <= fastest:
        causes.append(
            f'contact would begin at {digits(onset)} rev/min, measured are '
            f'{digits(slowest, 4)} to {digits(fastest, 4)} rev/min'
        )
    odd = 'asperities alone do not turn the torque up like this'
    return f'not told: {" and ".join(causes)}: {odd}' if causes else ''


def onset_speeds(
    contacts: ContactModel, run: NoLoadRun, factors: tuple[float, float, float]
) -> list[float]:
    """Return the screw speeds of the onset [rad/s] under the load of a run, by factors [-]."""
    oil, load = contacts.lubricant, abs(float(run.load.mean()))

    def at(factor: float) -> float:
        if math.isnan(factor):
            return factor
        sheet = Contacts.of(with_raceway(contacts.screw, onset_factor=factor))
        return onset_point(sheet, oil, load, oil.reference_temperature)['speed_rad_s']

    return [at(factor) for factor in factors]


def calibrated_band(low: float, high: float) -> float:
    """Return the factor within which nine of ten onsets lie [-], by a 95 % interval."""
    narrower = NINE_OF_TEN / float(student.ppf(0.5 * (1 + CONFIDENCE), math.inf))
    return float((high / low) ** (0.5 * narrower))
