# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A fleet of simulated axes: few false alarms among all, none withdrawn, and one axis as alone."""

import math

from ballscrew_monitor.health.detection import look
from ballscrew_monitor.health.fleet import (
    ALARM,
    bayes_factor,
    confirmed,
    controlled,
    evidence,
    LEVEL,
    shares,
    told,
)
from ballscrew_monitor.health.history import Group, History
from ballscrew_monitor.health.records import Condition, Health, Quantity
from ballscrew_monitor.health.rows import DAY
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.stats import norm

NEVER = np.iinfo(np.int64).max
WEEKS = 52
FORGOTTEN = 15.0  # [weeks]
OWN = 4e-4  # one-sided probability at which an axis alone alarms
BEGIN = 20_000 * DAY


def stamps_of(axes, weeks=WEEKS):
    """Return a log a week of each axis, on other days."""
    days = np.arange(weeks) * 7
    return [(20_000 + days + axis % 7) * DAY for axis in range(axes)]


def walks(rng, axes, weeks=WEEKS, shift=0.0, faulty=0):
    """
    Return standard normal test statistics that follow each other.

    The first `faulty` axes are shifted from the middle of the year on.

    """
    kept = math.exp(-1.0 / FORGOTTEN)
    z = rng.standard_normal((axes, weeks))
    for week in range(1, weeks):
        z[:, week] = kept * z[:, week - 1] + math.sqrt(1.0 - kept**2) * z[:, week]
    half = weeks // 2
    z[:faulty, half:] += shift
    return z


def factor_of(z, size=5.0):
    """Return the likelihood of a change of `size` of either sign over that of none."""
    return np.cosh(size * z) * math.exp(-0.5 * size**2)


def alarms_of(z):
    """Return where an alarm of the axis alone begins: at the first small probability."""
    beyond = np.abs(z) > norm.isf(OWN)
    return beyond & (np.cumsum(beyond, axis=1) == 1)


def since_of(z):
    return confirmed(stamps_of(len(z), z.shape[1]), factor_of(z), alarms_of(z))


@pytest.mark.parametrize(('axes', 'faulty'), [(40, 0), (40, 8), (5, 1)])
def test_the_share_of_false_alarms_stays_below_the_level(axes, faulty):
    """Axes are in no order: those with a change are the last ones of the fleet, too."""
    rng, shares_false, found, alone = np.random.default_rng(3), [], [], []
    for _ in range(200):
        z = walks(rng, axes, shift=6.0, faulty=faulty)[::-1]
        alarms = since_of(z)[::-1] < NEVER
        shares_false.append(alarms[faulty:].sum() / max(alarms.sum(), 1))
        found.append(alarms[:faulty].mean() if faulty else 1.0)
        alone.append(alarms_of(z)[: axes - faulty].any(axis=1).sum())
    error = np.std(shares_false) / math.sqrt(len(shares_false))
    assert np.mean(shares_false) <= LEVEL + 2.0 * error
    assert np.mean(found) > 0.9
    assert np.mean(alone) <= 1.5 * ALARM * axes  # what the axes alone would say, each by itself


@given(st.integers(0, 1000), st.integers(2, 12), st.integers(1, WEEKS))
def test_neither_later_logs_nor_further_axes_withdraw_an_alarm(seed, axes, until):
    z = walks(np.random.default_rng(seed), axes, shift=5.0, faulty=2)
    whole = since_of(z)
    for part in (since_of(z[:, :until]), since_of(z[: axes // 2 + 1])):
        early = part < NEVER
        assert (whole[: len(part)][early] <= part[early]).all()


def test_the_first_axis_is_told_as_it_would_be_alone():
    """Its own alarm has an e-value of half of 1 over its rate, which is enough for its share."""
    z = np.zeros((3, WEEKS))
    z[0, 30] = norm.isf(OWN) + 1e-9
    assert since_of(z)[0] == BEGIN + 30 * 7 * DAY
    assert since_of(z[[1, 0, 2]])[1] == NEVER


def test_a_mean_of_e_values_is_at_most_one_without_a_change():
    """Likelihood ratios of independent draws, 20 000 axes."""
    rng = np.random.default_rng(1)
    stamps = stamps_of(1)[0]
    none = np.zeros(WEEKS, bool)
    draws = rng.standard_normal((20_000, WEEKS))
    ends = [evidence(stamps, factor_of(draw, 2.0), none)[-1] for draw in draws]
    assert np.mean(ends) < 0.6
    grows = evidence(stamps, factor_of(rng.standard_normal(WEEKS), 2.0), none)
    assert (np.diff(grows) >= 0.0).all()


def test_the_bayes_factor_is_the_odds_after_over_those_before():
    """A year of one change in two years are odds of a half; certainty is bounded."""
    stamps = BEGIN + np.array([0, 365, 730]) * DAY
    factors = bayes_factor(stamps, np.array([0.5, 0.2, 0.0]))
    assert factors[:2] == pytest.approx([0.0, 8.0], rel=1e-3)
    assert factors[2] == pytest.approx(1e12, rel=1e-3)


def sound_year(rng):
    """
    Return weekly logs of a year at one place, whose friction has no lasting change.

    Scatter of logs, a wander that is forgotten over 15 weeks, and a temperature with its slope.

    """
    kept = math.exp(-1.0 / FORGOTTEN)
    walk = rng.standard_normal(WEEKS)
    for at in range(1, WEEKS):
        walk[at] = kept * walk[at - 1] + math.sqrt(1.0 - kept**2) * walk[at]
    warmth = 6.0 * np.sin(2.0 * math.pi * np.arange(WEEKS) / WEEKS + rng.uniform(0.0, 6.3))
    effect = rng.uniform(0.002, 0.02) * walk + rng.uniform(0.01, 0.02) * rng.standard_normal(WEEKS)
    effect += rng.normal(-0.01, 0.004) * warmth
    full = np.ones((WEEKS, 1))
    return History(
        start=(20_000 + 7 * np.arange(WEEKS)) * DAY,
        groups=(Group(10, 0, False, 0),),
        friction=np.exp(effect)[:, None],
        offset=0.0 * full,
        speed=full,
        load=0.0 * full,
        ideal=0.0 * full,
        temperature=300.0 + warmth[:, None],
        weight=full,
        standstill=np.full(WEEKS, np.nan),
        gain=np.full(WEEKS, np.nan),
        warm=True,
        load_known=True,
    )


def test_looks_at_axes_without_a_change_are_valid_evidence():
    """Years of a generator of its own: the mean of what 20 axes add up is below one half."""
    rng, sums = np.random.default_rng(5), []
    for _ in range(20):
        history = sound_year(rng)
        looks = [look(history.until(count)) for count in range(4, WEEKS + 1, 4)]
        stamps = np.array([int(history.start[one.log]) for one in looks])
        factor = bayes_factor(stamps, np.array([one.doubt for one in looks]))
        sums.append(evidence(stamps, factor, np.zeros(len(looks), bool))[-1])
    assert 0.0 < np.mean(sums) < 0.5


def test_shares_of_any_number_of_axes_add_up_to_less_than_all():
    assert shares(3)[0] == pytest.approx(1.0 / (2.0 * math.log(2.0) ** 2 * 2.10974))
    assert 0.9 < shares(1_000_000).sum() < 1.0


def test_axes_with_a_change_help_each_other():
    share = shares(4)
    values = 1.001 / (4.0 * LEVEL * share)
    assert told(values, share).all()
    assert not told(values * [1.0, 1.0, 1.0, 0.99], share).any()


def health(week, worse, doubt=1.0):
    drag = Quantity(name='drag change', value=-0.1, low=-0.12, high=-0.08)
    condition = Condition.WORSE if worse else Condition.NORMAL
    stamp = BEGIN + 7 * week * DAY
    return Health(
        axis='x',
        stamp=stamp,
        condition=condition,
        verdict='Axis x is worse.',
        since=stamp if worse else 0,
        quantities=[drag],
        doubt=doubt,
    )


def test_an_axis_alone_is_left_as_it_is():
    course = [health(week, week > 20, 1e-4) for week in range(30)]
    assert controlled({'x': course}) == ({'x': course}, '')
    assert controlled({'x': course, 'y': []})[1] == ''


def test_a_worse_axis_waits_for_more_evidence_among_others_and_stays_then():
    sound = [health(week, False) for week in range(40)]
    quiet = {f'axis {number:02}': sound for number in range(30)}
    course = [health(week, week > 20, 2e-5 if week > 20 else 1.0) for week in range(40)]
    found, text = controlled(quiet | {'z': course})
    conditions = [one.condition for one in found['z']]
    first = conditions.index(Condition.WORSE)
    assert 21 < first < 30
    assert set(conditions[first:]) == {Condition.WORSE}
    assert set(conditions[21:first]) == {Condition.SLIGHTLY_CHANGED}
    assert 'has slightly changed' in found['z'][21].verdict
    assert 'worse by its own logs' in found['z'][21].notes[0]
    assert text == (
        '31 axes, 1 of them worse: in the mean at most 10 % of such are so by chance; by its own '
        'logs alone each, 1 would be worse, with at most 0.62 false alarms a year'
    )
    assert found['axis 00'] == quiet['axis 00']
