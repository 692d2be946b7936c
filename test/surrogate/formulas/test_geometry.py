# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Geometry and Hertz against closed forms, the table and scaling laws."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy.special import ellipe, ellipk
from surrogate.formulas.geometry import (
    Contact,
    ellipticity,
    hertz,
    opposite_flank_approach,
    reduced_modulus,
    screw_contact,
)

RADII = st.floats(1e-3, 0.5)


def test_hertz_table(table, screw):
    """Semi-axes, pressure and approach of both contacts and two ball sizes, to 0.5 %."""
    for row in table('hertz.csv'):
        f = float(row['conformity'])
        sized = replace(
            screw,
            ball_diameter=float(row['ball_diameter_mm']) * 1e-3,
            conformity_screw=f,
            conformity_nut=f,
        )
        side = 'screw' if row['contact'] == 'A' else 'nut'
        found = hertz(screw_contact(sized, side), 27.6)
        assert found.semi_axis_y == pytest.approx(float(row['a_um']) * 1e-6, rel=5e-3)
        assert found.semi_axis_x == pytest.approx(float(row['b_um']) * 1e-6, rel=5e-3)
        assert found.max_pressure == pytest.approx(float(row['max_pressure_GPa']) * 1e9, rel=5e-3)
        assert found.approach == pytest.approx(float(row['approach_um']) * 1e-6, rel=5e-3)


def test_sphere_on_flat_is_johnson_and_no_load_is_no_contact():
    """A circle of radius (3 Q R / (4 E*))^(1/3) with approach a^2/R; E* is half of E'."""
    contact = Contact(radius_x=0.01, radius_y=0.01, reduced_modulus=2.2e11)
    found, radius = hertz(contact, 50.0), (0.75 * 50.0 * 0.01 / 1.1e11) ** (1 / 3)
    assert found.semi_axis_x == pytest.approx(radius, rel=1e-12)
    assert found.semi_axis_y == pytest.approx(radius, rel=1e-12)
    assert found.approach == pytest.approx(radius**2 / 0.01, rel=1e-12)
    assert found.max_pressure == pytest.approx(1.5 * 50.0 / (math.pi * radius**2), rel=1e-12)
    contact = Contact(radius_x=0.003, radius_y=0.08, reduced_modulus=2.26e11)
    found = hertz(contact, [0.0, 10.0])
    assert found.max_pressure[0] == found.semi_axis_x[0] == found.approach[0] == 0.0
    assert np.all(np.isfinite(found.approach))


@given(RADII, RADII)
def test_ellipticity_solves_the_legendre_form(radius_x, radius_y):
    """Ry/Rx = (k^2 E - K)/(K - E) at m = 1 - 1/k^2, for the longer axis along either direction."""
    k = ellipticity(Contact(radius_x=radius_x, radius_y=radius_y, reduced_modulus=2e11))
    ratio, k = (radius_y / radius_x, k) if k >= 1 else (radius_x / radius_y, 1 / k)
    if k > 1.001:
        m = 1 - 1 / k**2
        legendre = (k**2 * ellipe(m) - ellipk(m)) / (ellipk(m) - ellipe(m))
        assert legendre == pytest.approx(ratio, rel=1e-6)


@given(RADII, RADII, st.floats(0.1, 1e4))
def test_turning_a_contact_by_90_degrees_swaps_the_axes(radius_x, radius_y, load):
    one = hertz(Contact(radius_x=radius_x, radius_y=radius_y, reduced_modulus=2e11), load)
    other = hertz(Contact(radius_x=radius_y, radius_y=radius_x, reduced_modulus=2e11), load)
    assert one.semi_axis_x == pytest.approx(other.semi_axis_y, rel=1e-9)
    assert one.approach == pytest.approx(other.approach, rel=1e-9)


@given(st.floats(0.1, 1e3), st.floats(1.5, 8.0))
def test_hertz_scales_with_the_cube_root_of_the_load(load, factor):
    contact = Contact(radius_x=0.003, radius_y=0.08, reduced_modulus=2.26e11)
    small, large = hertz(contact, load), hertz(contact, factor**3 * load)
    assert large.max_pressure == pytest.approx(factor * small.max_pressure, rel=1e-9)
    assert large.semi_axis_x == pytest.approx(factor * small.semi_axis_x, rel=1e-9)
    assert large.approach == pytest.approx(factor**2 * small.approach, rel=1e-9)


def test_reduced_modulus_of_steel(screw):
    """E' = E/(1 - nu^2) = 226 GPa for two equal steels, not 113."""
    assert reduced_modulus(screw.raceway, screw.ball) == pytest.approx(206e9 / 0.91, rel=1e-12)


def test_a_ball_swings_towards_the_other_flank(screw):
    """None at the nominal angle; (r_g - r_b) sin(2 beta) per radian of tilt, by geometry."""
    nominal = screw.contact_angle
    gap = (screw.conformity_nut - 0.5) * screw.ball_diameter
    assert opposite_flank_approach(screw, 'nut', nominal, 0.0) == pytest.approx(0.0, abs=1e-15)
    tilted = opposite_flank_approach(screw, 'nut', nominal - 1e-4, 0.0)
    assert tilted == pytest.approx(1e-4 * gap * math.sin(2 * nominal), rel=1e-3)
    assert opposite_flank_approach(screw, 'nut', nominal + 1e-4, 0.0) < 0
    pressed = opposite_flank_approach(screw, 'nut', nominal - 0.2, 1e-6)
    assert pressed > opposite_flank_approach(screw, 'nut', nominal - 0.2, 0.0)
