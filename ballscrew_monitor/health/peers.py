# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Axes beside each other: one screw and one programme should take one friction torque.

An axis whose baseline was learned when it was already worse, or drifted with it, looks normal
against itself. Beside its peers it does not.

"""

from collections.abc import Mapping, Sequence
import dataclasses
import math
import statistics
from typing import Any

from ballscrew_monitor.health.detection import binned_logs, FEWEST_LOGS, NOW, now_of
from ballscrew_monitor.health.history import effects_of, history_of
from ballscrew_monitor.health.mixed import estimate, GRID, Logs, Prior, SLOPE, SLOPE_DOUBT, USUAL
from ballscrew_monitor.health.records import Quantity, quantity, TOLERANCE
from ballscrew_monitor.health.words import percent
import numpy as np
from numpy.typing import NDArray

FEWEST_PEERS = 2  # other axes to compare with: beside a single one, either may have changed
LEAST_COMMON = 0.5  # share of the groups of an axis that a peer has, too, to compare them [-]
OWN_DOUBT = 0.02  # standard deviation of the friction of an axis from log to log, at least [-]
NAME = 'friction beside peers'
OWN_SHARES = (0.1, 0.3, 0.5, 0.7, 0.9)
"""Shares of the variance of a slope that axes of one kind do not have in common, all alike [-]."""
ROUNDS = 20  # steps of expectation and maximisation, after which the weights of pairs stay
USUAL_PEERS = 2.0  # peers for which the usual weights of scatter and wander count


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Peer:
    """
    An axis among its peers.

    `difference` [-] of its friction torque from the median of theirs; the range of peers is the
    largest difference between two of them; `is_apart` where the interval lies beyond that range
    and beyond what counts as normal.

    """

    axis: str
    difference: Quantity
    peers: int
    is_apart: bool

    @property
    def text(self) -> str:
        """Return the difference in a sentence."""
        among = 'beyond what these' if self.is_apart else 'no more than these'
        return (
            f'Axis {self.axis}: its friction torque differs by {percent(self.difference)} from '
            f'that of {self.peers} axes with the same programme, {among} differ by.'
        )


def ranked(cells: Mapping[str, NDArray[Any]], lead: float) -> list[Peer]:
    """
    Return axes with at least two peers, the one that differs most first.

    `cells` are those of the logs by axis, arrays of CELL, all of one screw with a `lead` [m].

    """
    levels = {axis: level for axis, own in cells.items() if (level := _level(own, lead))}
    peers = []
    for axis, own in levels.items():
        apart = []  # differences of ln(friction) from those of the peers
        for peer, other in levels.items():
            common = [group for group in own if group in other]
            if peer != axis and len(common) >= LEAST_COMMON * len(own):
                apart.append(statistics.mean(own[group] - other[group] for group in common))
        if len(apart) < FEWEST_PEERS:
            continue
        value, spread = statistics.median(apart), max(apart) - min(apart)
        reach = 1.96 * OWN_DOUBT * math.sqrt(1.0 + 1.0 / len(apart))
        ends = map(math.expm1, (value, value - reach, value + reach))
        evidence = f'{len(own)} places, the last {NOW} logs'
        peers.append(
            Peer(
                axis=axis,
                difference=quantity(NAME, '-', ends, evidence),
                peers=len(apart),
                is_apart=abs(value) - reach > max(TOLERANCE, spread),
            )
        )
    return sorted(peers, key=lambda peer: (not peer.is_apart, -abs(peer.difference.value)))


def _level(cells: NDArray[Any], lead: float) -> dict[Any, float]:
    """Return ln(friction) of the latest logs by group, at one temperature for all axes."""
    history = history_of(cells, lead)
    if history is None:
        return {}
    effects = effects_of(history)
    now = float(np.mean(effects.logs.effect[-NOW:]))
    seen = (history.weight[-NOW:].sum(axis=0) > 0.0).tolist()
    pairs = zip(history.groups, effects.groups, seen, strict=True)
    return {group: float(level) + now for group, level, known in pairs if known}


Spread = tuple[Prior, frozenset[Any]]
"""
The prior of an axis by its own logs alone, and the groups in which it runs.

Its temperature slope has an infinite standard deviation where the logs say nothing of it; pairs of
the grid have their likelihood in place of weights.

"""


def spread_of(cells: NDArray[Any], lead: float) -> Spread | None:
    """Return the spread of an axis with a `lead` [m] by its cells; None for too few logs."""
    history = history_of(cells, lead)
    if history is None:
        return None
    logs, _ = binned_logs(history)
    if len(logs.time) < FEWEST_LOGS + 2:
        return None
    return own_prior(logs, warm=history.warm), frozenset(history.groups)


def own_prior(logs: Logs, *, warm: bool) -> Prior:
    """Return what logs say by themselves; `warm`: the temperature was measured."""
    now = np.arange(len(logs.time)) >= len(logs.time) - now_of(logs.time)
    change = estimate(logs, ~now, now, warm=warm)
    alone = change.pairs / np.exp(GRID.prior)
    pairs = tuple((alone / alone.sum()).tolist())
    variance = change.slope_deviation**2
    information = 1.0 / variance - SLOPE_DOUBT**-2.0
    if information <= 0.0 or not warm:
        return Prior(SLOPE, math.inf, pairs)
    slope = SLOPE + (change.slope - SLOPE) / variance / information
    return Prior(slope, information**-0.5, pairs)


def priors(spreads: Mapping[str, Spread]) -> dict[str, Prior]:
    """Return the prior of each axis by the spreads of its peers; axes of one screw by name."""
    known = {}
    for axis, (_, own) in spreads.items():
        others = [spread for other, spread in spreads.items() if other != axis]
        least = LEAST_COMMON * len(own)
        known[axis] = prior_of([peer for peer, groups in others if len(own & groups) >= least])
    return known


def prior_of(peers: Sequence[Prior]) -> Prior:
    """
    Return what the peers of an axis say of it, by empirical Bayes; the usual for less than two.

    The slopes of axes lie about a mean of their kind. The variance of the usual prior is that of
    both together, and its shares are weighed by their likelihood.

    """
    if len(peers) < FEWEST_PEERS:
        return USUAL
    known = [peer for peer in peers if math.isfinite(peer.doubt)]
    apart = np.array([peer.slope for peer in known]) - SLOPE
    noise = np.array([peer.doubt for peer in known]) ** 2
    means, variances, likelihoods = [], [], []
    for share in OWN_SHARES:
        own, common = share * SLOPE_DOUBT**2, (1.0 - share) * SLOPE_DOUBT**2
        covariance = np.diag(noise + own) + common
        solved = np.linalg.solve(covariance, apart)
        gain = np.linalg.solve(covariance, np.full(len(known), common))
        means.append(common * float(solved.sum()))
        variances.append(own + common - common * float(gain.sum()))
        likelihoods.append(-0.5 * (float(apart @ solved) + np.linalg.slogdet(covariance)[1]))
    weight = np.exp(np.array(likelihoods) - max(likelihoods))
    weight = weight / weight.sum()
    mean = float(weight @ means)
    variance = float(weight @ (np.array(variances) + (np.array(means) - mean) ** 2))
    # Scatter and wander: weights of the grid by expectation and maximisation.
    usual = np.exp(GRID.prior)
    usual = pairs = usual / usual.sum()
    likelihood = np.array([peer.pairs for peer in peers])
    for _ in range(ROUNDS):
        parts = likelihood * pairs
        total = USUAL_PEERS * usual + (parts / parts.sum(axis=1, keepdims=True)).sum(axis=0)
        pairs = total / total.sum()
    return Prior(SLOPE + mean, math.sqrt(variance), tuple(pairs.tolist()))
