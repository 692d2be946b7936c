# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fatigue life: closed forms, the springs of Hertz, and where the standard joins its branches."""

import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.life import (
    combined_damage,
    damage_palmgren_1924,
    fatigue_limit_iso_281_2007,
    life_factor_iso_281_2007,
    life_iso_3408_2006,
    nut_forces_iso_3408_2006,
    SEPARATION,
    viscosity_ratio_iso_1281_2008,
)
from surrogate.formulas.load_sharing import nut_forces

FORCES, SHARES = st.floats(1.0, 1e5), st.floats(1e-6, 1.0)
SPECTRA = st.lists(st.tuples(FORCES, st.floats(1.0, 1e6)), min_size=1, max_size=8)


def test_nominal_life():
    """A million revolutions under the rating, a thousand times that under a tenth of it."""
    assert life_iso_3408_2006(37890.0, 37890.0) == 1e6
    assert life_iso_3408_2006(37890.0, 3789.0) == pytest.approx(1e9)
    assert life_iso_3408_2006(37890.0, 0.0) == math.inf


@given(SPECTRA, FORCES)
def test_the_cubic_mean_wears_a_nut_out_as_the_spectrum_does(spectrum, rating):
    """Of the loads over their turns: ISO 3408-5:2006, 7.1; Palmgren's sum is the same law."""
    turns = sum(count for _, count in spectrum)
    load = (sum(load**3 * count for load, count in spectrum) / turns) ** (1 / 3)
    shared = turns / life_iso_3408_2006(rating, load)
    assert damage_palmgren_1924(spectrum, rating) == pytest.approx(shared, rel=1e-9)


def test_an_empty_spectrum():
    """Nothing is used up."""
    assert damage_palmgren_1924([], 1e4) == 0


def test_two_equal_nuts():
    """2^(9/10) of the damage of one; an idle nut changes nothing."""
    assert combined_damage(0.25, 0.25) == pytest.approx(0.25 * 2**0.9)
    assert combined_damage(0.25, 0.0) == pytest.approx(0.25)
    assert combined_damage(0.0, 0.0) == 0
    assert combined_damage(1e-300, 1e-300) == pytest.approx(1e-300 * 2**0.9, rel=1e-12)
    assert math.isnan(combined_damage(1.0, math.nan))


@given(SHARES, SHARES)
def test_turning_the_load_over_gains_seven_percent_at_most(first, second):
    """Damage on one nut is the worst: shared, it is less by up to 2^(1/10)."""
    shared, alone = combined_damage(first, second), combined_damage(first + second, 0.0)
    assert alone / 2**0.1 <= shared * (1 + 1e-12)
    assert shared <= alone * (1 + 1e-12)


@pytest.mark.parametrize('preload', [0.0, 1894.0])
def test_nut_forces_at_both_ends(preload):
    """Equal without load; beyond separation the pressed nut is alone, whatever the sign."""
    assert nut_forces_iso_3408_2006(0.0, preload) == (preload, preload)
    limit = SEPARATION * preload
    pressed, relieved = nut_forces_iso_3408_2006(limit * (1 - 1e-12), preload)
    assert pressed == pytest.approx(limit)
    assert relieved == pytest.approx(0.0, abs=1e-6)
    assert nut_forces_iso_3408_2006(-limit - 1.0, preload) == (limit + 1.0, 0.0)


@given(st.floats(0.0, 4.0))
def test_the_standard_is_near_the_springs_of_hertz(ratio):
    """It has the same ends and overstates the pressed nut in between by up to 2.5 %."""
    pressed, relieved = nut_forces_iso_3408_2006(ratio * 1000.0, 1000.0)
    exact, _ = nut_forces(ratio * 1000.0, 1000.0)
    assert 1 - 1e-9 <= pressed / float(exact) <= 1.025
    assert pressed - relieved == pytest.approx(ratio * 1000.0, abs=1e-6)


def test_the_fatigue_limit_of_ball_bearings():
    """C0/22, less for rings above 100 mm."""
    assert fatigue_limit_iso_281_2007(22e3, 0.0413) == pytest.approx(1e3)
    assert fatigue_limit_iso_281_2007(22e3, 0.4) == pytest.approx(500.0)


def test_the_viscosity_ratio_by_the_film_ratio():
    assert viscosity_ratio_iso_1281_2008(1.0) == 1.0
    assert viscosity_ratio_iso_1281_2008(2.0) == pytest.approx(2.4623, abs=1e-4)
    assert viscosity_ratio_iso_1281_2008(-1.0) == 0.0
    assert math.isnan(viscosity_ratio_iso_1281_2008(math.nan))


@pytest.mark.parametrize('joint', [0.4, 1.0])
@given(share=SHARES)
def test_branches_of_the_factor_join(joint, share):
    """Which they do with the exponent 0.19087, and not with the 0.019087 of some copies."""
    below, above = (life_factor_iso_281_2007(joint + side, share) for side in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=1e-3)


@given(SHARES)
def test_the_least_factor_is_a_tenth_whatever_the_load(share):
    """The standard's coefficients end at 0.1 for kappa 0.1; less film is no worse."""
    assert life_factor_iso_281_2007(0.1, share) == pytest.approx(0.1, rel=4e-3)
    least = life_factor_iso_281_2007(0.1, share)
    assert life_factor_iso_281_2007(0.0, share) == least
    assert life_factor_iso_281_2007(9.0, share) == life_factor_iso_281_2007(4.0, share)


@given(st.floats(0.0, 9.0), st.floats(0.0, 9.0), SHARES)
def test_more_film_lives_longer(thin, thick, share):
    """Between a tenth and fifty."""
    thin, thick = sorted((thin, thick))
    worse, better = (life_factor_iso_281_2007(kappa, share) for kappa in (thin, thick))
    assert 0.0999 <= worse <= better * (1 + 1e-12)
    assert better <= 50.0


def test_the_factor_by_hand():
    """Worked with a pocket calculator from the printed equations."""
    assert life_factor_iso_281_2007(1.0, 0.1) == pytest.approx(2.43, rel=2e-3)
    assert life_factor_iso_281_2007(4.0, 0.1) == pytest.approx(7.20, rel=2e-3)
    assert life_factor_iso_281_2007(4.0, 5.0) == 50.0
    assert math.isnan(life_factor_iso_281_2007(math.nan, 0.1))
    assert math.isnan(life_factor_iso_281_2007(1.0, math.nan))
