# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Parasitic torque of a screw, and what else was asked for, from torque measured without load.

Least squares over the points of a run. The torque on the screw is the friction torque with the
sign of the motion, the share of the load, and where both directions were measured an offset that
does not change sign. Intervals hold 95 % by Student's t from the Jacobian, that of an onset factor
by its profile.

"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
import math
from typing import Any, Literal

import numpy as np
from scipy.optimize import least_squares
from surrogate.identify.data import Array, NoLoadRun
from surrogate.identify.intervals import correlation, covariance, student_factor, undetermined
from surrogate.identify.model import ContactModel
from surrogate.identify.onset import OnsetScan, refusal_of, scan_onset
from surrogate.identify.problem import drag_problem, DragProblem, FADE_VALUES
from surrogate.parameters import Screw

Loss = Literal['linear', 'soft_l1']
TOLERANCE = 1e-12
"""Relative change of cost, parameters and gradient at which the fit ends [-]."""
ROBUST_ROUNDS = 6
"""Fits by soft_l1, each with the spread that the one before left."""
MODEL_ERROR = 0.005
"""Root mean square over the mean torque [-] that curves of seals and marches are off anyway."""
MEDIAN_TO_SPREAD = 1.4826
"""Standard deviation over the median amount of normal residuals [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ParameterEstimate:
    """
    One parameter in SI units: value, ends of the 95 % interval, standard error.

    Interval and error are NaN with a `reason`.

    """

    name: str
    value: float
    low: float = math.nan
    high: float = math.nan
    standard_error: float = math.nan
    reason: str = ''


@dataclass(frozen=True, kw_only=True, slots=True)
class Identification:
    """
    What an identification found; arrays have one entry per point of the run.

    Whether the fit converged; estimates; names and correlation [-] of those with an interval;
    torque on the screw by the model before and after [N m]; half width of the 95 % band of a
    measured point about it [N m]; friction torque of the contacts after [N m]; root mean square of
    the residual before and after [N m]; degrees of freedom; mean square of the residual over the
    standard deviation [-], NaN where none was given; whether the onset that the points ask for is
    refused, so that no sheet may have what was found.

    """

    converged: bool
    estimates: tuple[ParameterEstimate, ...]
    correlated: tuple[str, ...]
    correlation: Array
    before: Array
    after: Array
    band: Array
    contacts: Array
    rms_before: float
    rms: float
    degrees_of_freedom: int
    reduced_chi_square: float
    onset_refused: bool = False

    def value(self, name: str) -> float:
        """Return the value of a parameter in SI units, NaN when it was not identified."""
        estimate = self.estimate(name)
        return math.nan if estimate is None else estimate.value

    def estimate(self, name: str) -> ParameterEstimate | None:
        """Return the estimate of a parameter, None when it was not identified."""
        return next((estimate for estimate in self.estimates if estimate.name == name), None)


def identify(
    screw: Screw,
    run: NoLoadRun,
    contacts: ContactModel,
    fitted: Sequence[str] = (),
    *,
    loss: Loss = 'linear',
) -> Identification:
    """
    Fit the parasitic torque of `screw` to a run.

    `fitted` may name viscosity_factor and asperity_friction, and the three of the onset together.
    A parameter at the end of its range, or on which no point depends, gets no interval; the onset
    factor has that of its profile, a bound, or is refused. With the loss soft_l1 a point counts
    less the further it is off. Raises InputError for a run that cannot tell.

    """
    problem = drag_problem(screw, run, contacts, fitted)
    sigma = np.ones_like(run.torque) if run.torque_std is None else run.torque_std
    if 'onset_factor' in fitted:
        return _identify_onset(problem, sigma)
    held = problem.without_effect(problem.start)
    values, converged = _fit(problem, problem.start, held, sigma)
    weighted = 0.0
    for _ in range(ROBUST_ROUNDS if loss == 'soft_l1' else 0):
        # The first spread still has the points in it that are far off.
        spread = MEDIAN_TO_SPREAD * float(np.median(np.abs(problem.residual(values)) / sigma))
        if spread > 0:
            weighted = spread
            values, converged = _fit(problem, values, held, sigma, weighted)
    result = _result(problem, values, held, sigma, weighted)
    return replace(result, converged=converged)


def _identify_onset(problem: DragProblem, sigma: Array) -> Identification:
    """Fit everything at each onset factor, then with the factor free or at its bound."""
    place = problem.names.index('onset_factor')

    def at(factor: float) -> Array:
        start = problem.start.copy()
        start[place] = factor
        return start

    def cost(factor: float) -> tuple[float, float]:
        faded, start = problem.with_best_fade(at(factor), (), sigma)
        values, _ = _fit(faded, start, {'onset_factor': ''}, sigma)
        residual = faded.residual(values) / sigma
        return float(residual @ residual), float(np.fmax(faded.misfit(residual), model_error))

    def fitted(start: Array, held: dict[str, str]) -> Identification:
        faded, start = problem.with_best_fade(start, held, sigma)
        held = faded.without_effect(start) | held
        values, converged = _fit(faded, start, held, sigma)
        return replace(_result(faded, values, held, sigma), converged=converged)

    def without_onset(factor: float, reason: str) -> Identification:
        kept = 'not told without the onset: kept as in the datasheet'
        return fitted(at(factor), {'onset_factor': reason, 'asperity_friction': kept})

    def along(scan: OnsetScan) -> Identification:
        if scan.calibrates:
            return fitted(at(scan.best), {})
        factor, reason = scan.bound(stated)
        # Without a calibration no machine is told that it touches later than its datasheet says.
        return told(without_onset(factor, reason), value=max(factor, stated))

    def told(identified: Identification, **onset: Any) -> Identification:
        estimates = [*identified.estimates]
        estimates[place] = replace(estimates[place], **onset)
        return replace(identified, estimates=tuple(estimates))

    freedom = len(sigma) - len(problem.names) - FADE_VALUES
    stated = float(problem.start[place])
    torque = float(np.abs(problem.run.torque).mean())
    model_error = float(np.mean((MODEL_ERROR * torque / sigma) ** 2))
    scan = scan_onset(cost, freedom, problem.contacts.screw.roughness.lay)
    identified = along(scan)
    slowest = int(np.abs(problem.run.speed).argmin())
    upturn = identified.contacts[slowest] - identified.contacts.min()
    if scan.calibrates and not upturn > identified.band[slowest]:
        # The curvature of the rolling loss alone is no sign of contact.
        scan = replace(scan, low=0.0)
        identified = along(scan)
    values = np.array([estimate.value for estimate in identified.estimates])
    refusal = refusal_of(problem, scan, values, problem.run.torque - identified.after, sigma)
    if refusal:
        return replace(without_onset(stated, refusal), onset_refused=True)
    if not scan.calibrates:
        return identified
    onset = identified.estimates[place]
    low, high = scan.interval(onset.value)
    error = onset.value * math.log(high / low) / (2 * student_factor(freedom))
    return told(identified, low=low, high=high, standard_error=error, reason='')


def _fit(
    problem: DragProblem, start: Array, held: Mapping[str, str], sigma: Array, spread: float = 0.0
) -> tuple[Array, bool]:
    """
    Minimise over the parameters that are not held; residuals over `sigma` [N m].

    With a robust `spread` in standard deviations [-], 0 for least squares. Returns the values,
    and whether they were found.

    """
    free = np.array([name not in held for name in problem.names])
    scale = problem.scale[free]

    def values(reduced: Array) -> Array:
        full = start.copy()
        full[free] = np.clip(reduced * scale, problem.low[free], problem.high[free])
        return full

    minimum: Any = least_squares(
        lambda reduced: problem.residual(values(reduced)) / sigma,
        start[free] / scale,
        jac=lambda reduced: -problem.jacobian(values(reduced))[:, free] * scale / sigma[:, None],
        bounds=(problem.low[free] / scale, problem.high[free] / scale),
        # It ends on a bound, not near it.
        method='dogbox',
        loss='soft_l1' if spread > 0 else 'linear',
        f_scale=spread or 1.0,
        xtol=TOLERANCE,
        ftol=TOLERANCE,
        gtol=TOLERANCE,
    )
    return values(minimum.x), bool(minimum.success)


def _result(
    problem: DragProblem,
    values: Array,
    held: Mapping[str, str],
    sigma: Array,
    weighted: float = 0.0,
) -> Identification:
    """Return the fit with how sure it is; a parameter at a bound counts as known."""
    run, names = problem.run, problem.names
    residual, jacobian = problem.residual(values), problem.jacobian(values)
    reasons = dict(held) | problem.at_bounds(values)
    free = [place for place, name in enumerate(names) if name not in reasons]
    scaled = jacobian[:, free] / sigma[:, None]
    freedom = len(sigma) - len(free)
    reasons |= undetermined(tuple(names[place] for place in free), scaled)
    spread = np.zeros((len(names), len(names)))
    spread[np.ix_(free, free)], variance = covariance(scaled, residual / sigma, weighted)
    known = [place for place, name in enumerate(names) if name not in reasons]
    width = student_factor(freedom)
    curve = np.einsum('pi,ij,pj->p', jacobian, spread, jacobian)
    estimates = []
    for place, (name, value) in enumerate(zip(names, values.tolist(), strict=True)):
        if name in reasons:
            interval: dict[str, Any] = {'reason': reasons[name]}
        else:
            error = math.sqrt(spread[place, place])
            low, high = value - width * error, value + width * error
            interval = {'low': low, 'high': high, 'standard_error': error}
        estimates.append(ParameterEstimate(name=name, value=value, **interval))
    before = problem.torque(problem.start)
    chi_square = float(np.sum((residual / sigma) ** 2)) / freedom
    return Identification(
        converged=True,
        estimates=tuple(estimates),
        correlated=tuple(names[place] for place in known),
        correlation=correlation(spread[np.ix_(known, known)]),
        before=before,
        after=problem.torque(values),
        band=width * np.sqrt(variance * sigma**2 + curve),
        contacts=problem.contact_torque(values),
        rms_before=_rms(run.torque - before),
        rms=_rms(residual),
        degrees_of_freedom=freedom,
        reduced_chi_square=math.nan if run.torque_std is None else chi_square,
    )


def _rms(residual: Array) -> float:
    return float(np.sqrt(np.mean(residual**2)))
