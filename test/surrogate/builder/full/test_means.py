# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Means over all draws from few of them: exact where draws differ as is assumed."""

import warnings

import numpy as np
import pytest
from surrogate.builder.full.means import (
    carried_spread,
    fading,
    filled,
    joined,
    middle_mean,
    moved_shares,
    other_mean,
)

S = np.array([-3.0, -2.0, -1.2, -0.9, -0.6, -0.2, 0.2, 0.6, 1.5, 3.0, 5.0])
FULL = ((S >= -1.25) & (S <= 1.5)) | (S == 5.0)
WHOLE = np.ones((len(S), 1))
FACTORS = np.array([0.7, 1.1, 0.9, 1.4])


def falling(s):
    """Return a share that falls from 1 to 0."""
    return 1 / (1 + np.exp(4 * (s + 1)))


def only_few_beyond(values):
    """Remove all but two draws where the onset is far."""
    solved = values.copy()
    solved[~FULL, :, 2:] = np.nan
    return solved


def mean_of(values, few, fade, *, share):
    """Return the mean at all speeds with the plain one where all draws are solved."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RuntimeWarning)
        whole = np.nanmean(values, axis=-1)
    return middle_mean(S, values, whole, FULL, few, fade, share=share)


def moved_share(own, middle, mean):
    """Return the mean share of a single load."""
    return moved_shares(S, own[:, None], middle[:, None], mean[:, None], FULL)[:, 0]


def test_draws_that_differ_by_a_factor_have_their_plain_mean():
    """Everywhere, though two of four are solved beyond the onset."""
    values = np.exp(0.6 * S)[:, None, None] * FACTORS * np.array([[1.0], [2.0]])
    mean = mean_of(only_few_beyond(values), 2, WHOLE, share=False)
    assert mean == pytest.approx(values.mean(axis=-1), rel=1e-12)


def test_shares_are_scaled_by_what_they_lack_of_one_below_the_onset():
    """Exact where draws differ by a factor there, and never outside 0 to 1."""
    lacking = (1 - falling(S))[:, None, None] * np.array([0.7, 0.9, 0.8, 1.0])
    mean = mean_of(only_few_beyond(1 - lacking), 2, WHOLE, share=True)
    slow = FULL | (S < 0)
    assert mean[slow] == pytest.approx(1 - lacking[slow].mean(axis=-1), rel=1e-12)
    steep = np.clip(falling(S)[:, None, None] * FACTORS, 0, 1)
    mean = mean_of(only_few_beyond(steep), 2, WHOLE, share=True)
    assert ((mean >= 0) & (mean <= 1)).all()
    assert mean[-1] == pytest.approx(0.0, abs=1e-6)


def test_another_temperature_has_the_factor_of_the_middle_one():
    """Two draws of four there, one of them lost at some speeds."""
    middle = np.exp(0.6 * S)[:, None, None] * FACTORS
    own = 1.7 * middle[..., :2]
    own[3:5, 0, 1] = np.nan
    mean = other_mean(S, own, middle[..., :2], middle.mean(axis=-1))
    assert mean == pytest.approx(1.7 * middle.mean(axis=-1), rel=1e-12)


def test_a_moved_share_is_found_through_noise():
    """A shift and a stretch of the coordinate come back from two noisy draws."""
    shifts = np.array([-0.15, 0.05, 0.2, 0.3])
    moved = S + 0.04 - 0.02 * np.clip(S, -1.2, 1.5)
    middle = falling(S[:, None] + shifts)
    noise = np.random.default_rng(4).normal(0, 0.003, (len(S), 2)) * FULL[:, None]
    own = falling(moved[:, None] + shifts[:2]) + noise
    found = moved_share(own, middle[:, :2], middle.mean(axis=-1))
    wanted = falling(moved[:, None] + shifts).mean(axis=-1)
    # What a cubic between these nodes makes of the curve is most of the difference.
    assert np.abs(found - wanted)[FULL].max() < 0.008
    assert (np.diff(found) <= 1e-9).all()


def test_loads_share_the_line_that_moves_their_shares():
    """Noise that would move a single load by far is averaged over twelve of them."""
    middle = np.stack([falling(S + shift) for shift in np.linspace(-0.2, 0.2, 12)], axis=1)
    middle = np.repeat(middle[..., None], 2, axis=-1)
    noise = np.random.default_rng(3).normal(0, 0.02, middle.shape) * FULL[:, None, None]
    found = moved_shares(S, middle + noise, middle, middle.mean(axis=-1), FULL)
    wrong = np.abs(found - middle[..., 0])[FULL].max(axis=0)
    alone = [
        np.abs(
            moved_share(middle[:, j] + noise[:, j], middle[:, j], middle[:, j, 0])
            - middle[:, j, 0]
        )
        for j in range(12)
    ]
    # The mean of two draws alone is off by 0.02 over the root of two.
    assert wrong.max() < 0.014
    assert np.max([one[FULL].max() for one in alone]) > 2 * wrong.max()


def test_a_share_goes_on_as_that_of_the_middle_temperature():
    """Where it was not solved; slower than the middle one its own few draws speak."""
    middle = falling(S[:, None] + np.zeros(2))
    own, mean = middle.copy(), middle.mean(axis=-1)
    own[:3] = np.nan
    assert moved_share(own, middle, mean) == pytest.approx(mean, abs=1e-6)
    cut = np.where(np.arange(len(S)) < 2, np.nan, mean)
    found = moved_share(middle, np.where(np.isnan(cut)[:, None], np.nan, middle), cut)
    assert found[:2] == pytest.approx(mean[:2])
    own = np.where(np.arange(len(S))[:, None] < 1, np.nan, middle)
    nothing = np.full_like(middle, np.nan)
    assert moved_share(own, nothing, nothing[:, 0])[1:] == pytest.approx(own[1:, 0])


def test_differences_fade_where_asperities_carry_everything():
    """As what a share lacks of one; draws that are alike at full contact have their plain mean."""
    shares = falling(S)[:, None, None] * np.ones((1, 2))
    fade = fading(shares, FULL, 2)
    edge = 1 - falling(-1.2)
    assert fade[:2, 0] == pytest.approx((1 - falling(S[:2])) / edge)
    assert (fade[2:] == 1).all()
    holed = np.concatenate([shares, shares], axis=1)
    holed[0, 1] = np.nan
    assert fading(holed, FULL, 2)[0, 1] == fade[0, 0]
    factors = 1 + (FACTORS - 1) * (1 - falling(np.clip(S, -9, -1.2)))[:, None] / edge
    values = factors[:, None, :] * (2 - S)[:, None, None] ** 2
    mean = mean_of(only_few_beyond(values), 2, fade, share=False)
    slow = S < 0
    assert mean[slow, 0] == pytest.approx(values.mean(axis=-1)[slow, 0], rel=0.03)


def test_a_spread_is_carried_relative_to_the_mean():
    """Exact for a constant relative spread, at every speed; unknown where it never is known."""
    values = np.exp(0.6 * S)[:, None, None] * FACTORS
    mean, own = values.mean(axis=-1), values.std(axis=-1, ddof=1)
    known = np.where(FULL[:, None], own, 7.0)
    assert carried_spread(S, known, mean, FULL, WHOLE, share=False) == pytest.approx(own)
    nothing = carried_spread(S, np.full_like(own, np.nan), mean, FULL, WHOLE, share=False)
    assert np.isnan(nothing).all()


def test_a_lost_draw_moves_nothing():
    """One of the two that are solved everywhere fails at a far speed: the other is moved alone."""
    values = only_few_beyond(np.exp(0.6 * S)[:, None, None] * FACTORS)
    whole = mean_of(values, 2, WHOLE, share=False)
    values[9, 0, 1] = np.nan
    lost = mean_of(values, 2, WHOLE, share=False)
    assert lost == pytest.approx(whole, rel=1e-12)


def test_columns_go_on_in_the_shape_of_their_neighbour():
    """Where they were not asked for; what failed stays unknown."""
    beside = np.exp(0.6 * S)[:, None]
    column, asked = 1.3 * beside, np.ones((len(S), 1), dtype=bool)
    column[[0, 1, 4, 10]] = np.nan
    asked[[0, 1, 10]] = False
    found = joined(S, column, beside, asked, share=False)
    known = np.arange(len(S)) != 4
    assert found[known] == pytest.approx(1.3 * beside[known])
    assert np.isnan(found[4])
    shares = joined(S, column, beside, asked, share=True)
    assert shares[[0, 10]] == pytest.approx(beside[[0, 10]])


def test_the_oil_is_forgotten_where_asperities_carry_everything():
    """A factor between temperatures is held among known speeds and beyond, and fades below."""
    beside = np.exp(0.6 * S)[:, None]
    column, asked = 1.3 * beside, np.ones((len(S), 1), dtype=bool)
    column[[0, 1, 2, 6, 10]] = np.nan
    asked[[0, 1, 2, 6, 10]] = False
    fade = np.ones((len(S), 1))
    fade[:5, 0] = [0.0, 0.3, 0.2, 0.4, 0.8]
    found = joined(S, column, beside, asked, share=False, fade=fade)
    assert (found / beside)[[6, 10], 0] == pytest.approx(1.3)
    assert (found / beside)[:4, 0] == pytest.approx([1.0, 1.15, 1.15, 1.3])


def test_gaps_are_straight_and_ends_are_held():
    """Each column for itself; one without anything has what is given."""
    values = np.array([[np.nan, 1.0, np.nan], [2.0, np.nan, np.nan], [np.nan, 4.0, np.nan]])
    found = filled(np.array([0.0, 1.0, 3.0]), values, 7.0)
    assert found.T.tolist() == [[2.0, 2.0, 2.0], [1.0, 2.0, 4.0], [7.0, 7.0, 7.0]]
