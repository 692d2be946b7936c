# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the screw over draws of the roughness."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.ehl import Settings
from surrogate.files import InputError
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.ensemble import DRAWN_FIELDS, solve_ensemble, spread
from surrogate.screw.solve import solve_screw

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
SMALL = Settings(nx=65, ny=65, error_estimate=False)
SETTINGS = ScrewSettings(
    smooth=SMALL, rough=Settings(nx=65, ny=65, error_estimate=False), nodes_per_wave=1.0
)
SLOW = OperatingPoint(speed=5 * math.pi / 30, load=500.0, temperature=313.15)


def test_spread_is_that_of_the_draws():
    """Mean and deviation of the single solves, whose draws differ."""
    found = solve_ensemble(SCREW, OIL, SLOW, 2, settings=replace(SETTINGS, draw=3))
    assert found.failed == 0
    single = [
        solve_screw(SCREW, OIL, SLOW, settings=replace(SETTINGS, draw=draw)) for draw in (3, 4)
    ]
    for name in DRAWN_FIELDS:
        values = [getattr(one, name) for one in single]
        assert values[0] != values[1]
        assert found.spreads[name].mean == pytest.approx(np.mean(values), rel=1e-6)
        assert found.spreads[name].deviation == pytest.approx(np.std(values, ddof=1), rel=1e-6)


def test_draws_that_fail_are_counted_and_left_out():
    """With nothing solved nothing is known."""
    broken = replace(SETTINGS, smooth=Settings(newton_limit=1))
    found = solve_ensemble(SCREW, OIL, SLOW, 2, settings=broken)
    assert found.failed == 2
    assert math.isnan(found.spreads['rcs'].mean)


def test_error_of_the_mean_and_too_few_values():
    """Standard error of three values; one value has no deviation."""
    found = spread([1.0, 2.0, 3.0])
    assert (found.mean, found.deviation) == (2.0, 1.0)
    assert found.error == pytest.approx(1 / math.sqrt(3))
    assert math.isnan(spread([1.0]).deviation)


def test_no_draw_is_refused():
    """The sentence says what is allowed."""
    with pytest.raises(InputError, match='draws is 0, allowed is 1 or more'):
        solve_ensemble(SCREW, OIL, SLOW, 0)
