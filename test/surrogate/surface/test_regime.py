# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The regimes on their limits."""

import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import Regime, regime_of, REGIMES

BELOW_ONE, BELOW_THREE = math.nextafter(1.0, 0.0), math.nextafter(3.0, 0.0)


@pytest.mark.parametrize(
    ('film_ratio', 'regime'),
    [
        (0.0, Regime.BOUNDARY),
        (BELOW_ONE, Regime.BOUNDARY),
        (1.0, Regime.MIXED),
        (BELOW_THREE, Regime.MIXED),
        (3.0, Regime.HYDRODYNAMIC),
        (math.inf, Regime.HYDRODYNAMIC),
        (math.nan, Regime.UNKNOWN),
    ],
)
def test_regime_on_its_limits(film_ratio, regime):
    assert regime_of(film_ratio) is regime


@given(st.floats())
def test_bands_are_exhaustive_and_only_nan_is_unknown(value):
    assert (regime_of(value) is Regime.UNKNOWN) == math.isnan(value)


@given(first=st.floats(0.0, 10.0), second=st.floats(0.0, 10.0))
def test_bands_are_in_order(first, second):
    low, high = sorted((first, second))
    assert regime_of(low) <= regime_of(high)


def test_every_regime_has_its_word():
    assert [regime.word for regime in REGIMES] == ['boundary', 'mixed', 'hydrodynamic']
    assert regime_of(math.nan).word == 'unknown'
    assert [*REGIMES] == [regime for regime in Regime if regime is not Regime.UNKNOWN]
