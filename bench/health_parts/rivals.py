# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Two libraries on the summaries that the product has: a mixed model, and a search for changes.

MixedLM of statsmodels has the groups, a temperature slope and a change of the last four logs as
fixed effects, and the log as a random one, by restricted likelihood. PELT of ruptures (Killick
2012) cuts the effects of the logs, less the usual slope of oils, where their mean changes, with
the penalty of the Bayesian criterion. Baseline and logs that are now are those of the product. A
change is worse from 3.35 standard errors on (a probability of 4e-4 without one), of which 2.33 lie
beyond the tolerance (1 %).

"""

from collections.abc import Callable, Iterator
import importlib.util
import math
import warnings

from ballscrew_monitor.health.detection import BASELINE_DAYS, FEWEST_LOGS, Look, NORMAL_95, NOW
from ballscrew_monitor.health.history import effects_of, History
from ballscrew_monitor.health.mixed import SLOPE
from ballscrew_monitor.health.records import TOLERANCE
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
INSTALL = 'python -m pip install --target FOLDER statsmodels ruptures'
FEWEST_BETWEEN = 4  # logs between two changes
ALARM_SIGMAS, TOLERANCE_SIGMAS = 3.35, 2.33


def missing() -> list[str]:
    """Return the libraries that are not installed."""
    return [name for name in ('statsmodels', 'ruptures') if importlib.util.find_spec(name) is None]


def rivals() -> dict[str, Callable[[History], Iterator[Look]]]:
    """Return by name what looks at a history after each of its logs."""
    return {
        'MixedLM, statsmodels': lambda history: _looks(history, mixed_look),
        'PELT, ruptures': lambda history: _looks(history, pelt_look),
    }


def _looks(history: History, look: Callable[[History, int], Look]) -> Iterator[Look]:
    days = history.time - history.time[0]
    for count in range(1, len(days) + 1):
        first = int((days[: count - NOW] <= BASELINE_DAYS).sum()) if count > NOW else 0
        if first < FEWEST_LOGS or count < first + NOW:
            yield Look(count - 1, float(history.time[count - 1]), reason='too few logs')
        else:
            yield look(history.until(count), first)


def mixed_look(history: History, first: int) -> Look:
    """Return the change of the last four logs against the `first` ones by MixedLM."""
    import statsmodels.api as sm

    logs, groups = np.nonzero(history.weight > 0.0)
    warmth = history.temperature[logs, groups] if history.warm else np.zeros(len(logs))
    now = logs >= len(history.start) - NOW
    between = (logs >= first) & ~now
    columns = [now, between] if between.any() else [now]
    design = np.column_stack(
        [np.eye(len(history.groups))[groups], *columns, warmth - warmth.mean()]
    )
    design = design[:, np.ptp(design, axis=0) > 0.0]
    at = int((np.ptp(np.eye(len(history.groups))[groups], axis=0) > 0.0).sum())
    with warnings.catch_warnings():
        warnings.simplefilter('ignore')
        model = sm.MixedLM(np.log(history.friction[logs, groups]), design, groups=logs)
        fit = model.fit(reml=True)
    return _look(history, float(fit.fe_params[at]), float(fit.bse_fe[at]), first)


def pelt_look(history: History, first: int) -> Look:
    """Return the change of the last part of a history against its `first` logs by PELT."""
    import ruptures

    logs = effects_of(history).logs
    values = logs.effect - SLOPE * logs.warmth
    scatter = 1.4826 * float(np.median(np.abs(np.diff(values)))) / math.sqrt(2.0)
    search = ruptures.Pelt(model='l2', min_size=FEWEST_BETWEEN, jump=1).fit(values[:, None])
    *_, begin, _ = [0, 0, *search.predict(pen=2.0 * scatter**2 * math.log(len(values)))]
    now = values[range(max(begin, first), len(values))]
    change = float(now.mean() - values[:first].mean()) if begin else 0.0
    look = _look(history, change, math.nan, first)
    sign = -1 if change < 0.0 else 1
    return look._replace(raised=sign if begin >= first and abs(change) > TOLERANCE else 0)


def _look(history: History, change: float, deviation: float, first: int) -> Look:
    sign, size = (-1 if change < 0.0 else 1), abs(change)
    sure = size > max(ALARM_SIGMAS * deviation, TOLERANCE + TOLERANCE_SIGMAS * deviation)
    reach = NORMAL_95 * deviation
    return Look(
        log=len(history.start) - 1,
        time=float(history.time[-1]),
        change=math.expm1(change),
        low=math.expm1(change - reach),
        high=math.expm1(change + reach),
        raised=sign if sure else 0,
        baseline=first,
        now=NOW,
    )
