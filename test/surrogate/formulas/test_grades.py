# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Viscosities carried over temperatures and grades by ASTM D341."""

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas.grades import (
    equivalent_temperature,
    HOT,
    ISO_VG,
    slope_astm_d341,
    temperature_astm_d341,
    WARM,
)
from surrogate.formulas.lubricant import kinematic_viscosity_astm_d341
from surrogate.parameters import load_lubricant

VG_68 = 68e-6, 8.7e-6


@given(st.floats(5e-6, 1e-3), st.floats(10e-6, 1e-3), st.floats(0.05, 0.5))
def test_the_temperature_of_a_viscosity_is_the_inverse(viscosity, at_40, ratio):
    at_100 = max(ratio * at_40, 2.1e-6)
    temperature = temperature_astm_d341(viscosity, at_40, at_100)
    found = kinematic_viscosity_astm_d341(temperature, at_40, at_100)
    assert float(found) == pytest.approx(viscosity, rel=1e-6)


def test_the_line_passes_through_both_numbers_of_a_sheet():
    assert temperature_astm_d341(VG_68[0], *VG_68) == pytest.approx(WARM)
    assert temperature_astm_d341(VG_68[1], *VG_68) == pytest.approx(HOT)
    assert 3 < slope_astm_d341(*VG_68) < 4  # usual of mineral oils


@pytest.mark.parametrize('grade', [32, 100])
@pytest.mark.parametrize('temperature', [293.15, 313.15, 333.15])
def test_another_grade_is_this_oil_at_another_temperature(grade, temperature):
    """Within 4 % of the other sheet, which states a slope of its own."""
    oil, other = load_lubricant('iso_vg_68'), load_lubricant(f'iso_vg_{grade}')
    own = oil.kinematic_viscosity_40, oil.kinematic_viscosity_100
    there = equivalent_temperature(temperature, other.kinematic_viscosity_40, *own)
    stated = kinematic_viscosity_astm_d341(
        temperature, other.kinematic_viscosity_40, other.kinematic_viscosity_100
    )
    assert float(kinematic_viscosity_astm_d341(there, *own)) == pytest.approx(stated, rel=0.04)


def test_a_thinner_oil_is_a_warmer_one():
    """Grade by grade; the own grade changes nothing."""
    found = [equivalent_temperature(300.0, grade * 1e-6, *VG_68) for grade in ISO_VG]
    assert found == sorted(found, reverse=True)
    assert found[ISO_VG.index(68)] == pytest.approx(300.0)
