# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lubricant laws at anchors, limits and by properties."""

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.formulas import lubricant


def test_d341_passes_through_both_anchors_and_between_them():
    """By hand at 65 degC: log log falls from 0.264099 by 3.62445 x 0.033356 to 23.9 mm2/s."""
    found = lubricant.kinematic_viscosity_astm_d341([313.15, 373.15], 68e-6, 8.7e-6)
    assert found == pytest.approx([68e-6, 8.7e-6], rel=1e-12)
    found = lubricant.kinematic_viscosity_astm_d341(338.15, 68e-6, 8.7e-6)
    assert found == pytest.approx(23.88e-6, rel=1e-3)


@given(st.floats(275.0, 370.0))
def test_a_warmer_oil_is_thinner_lighter_and_softer(kelvin):
    from surrogate.parameters import load_lubricant

    oil = lubricant.lubricant_state(load_lubricant('iso_vg_68'), [kelvin, kelvin + 1])
    for name in ('viscosity', 'density', 'pressure_viscosity'):
        cooler, warmer = getattr(oil, name)
        assert warmer < cooler


def test_roelands_printed_value_and_barus_for_small_pressure():
    """At 1 GPa Z is 0.571713, (6.10204)^z 2.81233, e^(6.85659 x 1.81233) x 0.06 = 14 958 Pa s."""
    assert lubricant.viscosity_roelands_1966(1e9, 0.06, 2e-8) == pytest.approx(14958, rel=1e-3)
    rise = np.log(lubricant.viscosity_roelands_1966(1.0e3, 0.06, 2e-8) / 0.06)
    assert rise / 1.0e3 == pytest.approx(2e-8, rel=1e-4)
    assert lubricant.viscosity_roelands_1966(0.0, 0.06, 2e-8) == pytest.approx(0.06, rel=1e-15)


@given(st.floats(1e-6, 1e6))
def test_eyring_is_newtonian_when_slow_and_never_above(rate):
    stress = float(lubricant.shear_stress_eyring_1936(0.06, rate, 5e6))
    assert stress <= 0.06 * rate * (1 + 1e-12)
    if 0.06 * rate < 5e4:
        assert stress == pytest.approx(0.06 * rate, rel=2e-5)
