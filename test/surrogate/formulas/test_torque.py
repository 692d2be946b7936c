# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Torque balance in four quadrants and the classical comparators."""

import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.formulas import torque as laws
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.load_sharing import nut_forces

LEAD = 0.01
FRICTION, LOAD = st.floats(1e-6, 10.0), st.floats(1.0, 1e5)


def test_constant_friction_table(table):
    """Efficiencies and drag of the constant-friction double nut to 1e-3."""
    row = table('constant_friction.csv')[0]
    mu, preload, angle = float(row['mu']), 1000.0, math.atan(LEAD / (2 * math.pi * 0.016))

    def driven(ratio):
        loaded, relieved = nut_forces(ratio * preload, preload)
        moment = laws.torque_constant_friction(float(loaded), float(relieved), 0.016, angle, mu)
        return ratio * preload * LEAD / (2 * math.pi) / moment

    single = laws.torque_constant_friction(1.0, 0.0, 0.016, angle, mu)
    assert LEAD / (2 * math.pi) / single == pytest.approx(float(row['eta_drive']), abs=1e-3)
    # The load drives: the pressed nut assists the motion.
    back = -laws.torque_constant_friction(0.0, 1.0, 0.016, angle, mu) / (LEAD / (2 * math.pi))
    assert back == pytest.approx(float(row['eta_backdrive']), abs=1e-3)
    drag = laws.torque_constant_friction(preload, preload, 0.016, angle, mu)
    assert drag == pytest.approx(float(row['drag_torque_Nm']), abs=1e-3)
    for ratio in (0.5, 1, 2):
        assert driven(ratio) == pytest.approx(float(row[f'eta_at_{ratio}_preload']), abs=1e-3)


@given(FRICTION, LOAD)
def test_power_in_is_power_out_plus_loss(friction, load):
    """Torque times speed covers lifting and friction; the efficiency is their ratio."""
    torque = laws.driving_torque(friction, load, LEAD)
    ideal = load * LEAD / (2 * math.pi)
    assert torque == pytest.approx(ideal + friction, rel=1e-14)
    assert laws.efficiency(friction, load, LEAD) == pytest.approx(ideal / torque, rel=1e-12)


@given(FRICTION, LOAD)
def test_a_driving_load_gives_what_friction_leaves(friction, load):
    ideal = load * LEAD / (2 * math.pi)
    found = laws.efficiency(friction, -load, LEAD)
    if friction < ideal:
        assert found == pytest.approx((ideal - friction) / ideal, rel=1e-12)
        assert laws.is_back_driving(friction, -load, LEAD)
    else:
        assert found == 0.0
        assert not laws.is_back_driving(friction, -load, LEAD)


@given(FRICTION, LOAD, st.sampled_from([1, -1]))
def test_slope_is_the_derivative(friction, load, sign):
    """The slope agrees with a difference quotient, where the screw moves at all."""
    step, load = 1e-4 * friction, sign * load
    low, high = (laws.efficiency(friction + side * step, load, LEAD) for side in (-1, 1))
    if low > 0 and high > 0:
        expected = (low - high) / (2 * step)
        assert laws.efficiency_slope(friction, load, LEAD) == pytest.approx(expected, rel=1e-3)


def test_efficiencies_that_are_unknown_zero_or_one():
    for load in (1000.0, -1000.0):
        assert math.isnan(laws.efficiency(math.nan, load, LEAD))
    assert math.isnan(laws.efficiency(0.1, math.nan, LEAD))
    assert laws.efficiency(0.1, 0.0, LEAD) == 0.0
    assert laws.efficiency(0.1, -0.0, LEAD) == 0.0
    assert laws.driving_torque(0.1, 0.0, LEAD) == 0.1
    assert laws.efficiency(0.0, 5.0, LEAD) == laws.efficiency(0.0, -5.0, LEAD) == 1.0


@given(
    FRICTION,
    st.sampled_from([0.0, 5e-324, 1e-320, 2.3e-308, 1e-200, 1e308, math.inf, math.nan])
    | st.floats(),
    st.sampled_from([1, -1]),
)
def test_no_float_of_the_load_raises(friction, load, sign):
    """A load whose ideal torque is no normal float counts as no load."""
    ideal = abs(load) * LEAD / (2 * math.pi)
    found = laws.efficiency(friction, sign * load, LEAD)
    slope = laws.efficiency_slope(friction, sign * load, LEAD)
    if ideal < laws.SMALLEST:
        assert found == 0.0
        assert math.isnan(slope)
    elif math.isfinite(ideal):
        assert 0.0 <= found <= 1.0
        assert 0.0 <= slope < math.inf


def test_a_typical_drag_adds_to_the_torque():
    """Of 1 N m of load and 0.1 of friction; a load that assists loses what friction keeps."""
    load = 2 * math.pi / LEAD
    found = laws.with_typical_drag(0.1, load, LEAD, (0.0, 0.4, 0.9))
    assert found['friction_torque_Nm'] == pytest.approx({'low': 0.1, 'typical': 0.5, 'high': 1.0})
    assert found['efficiency'] == pytest.approx({'low': 1 / 1.1, 'typical': 1 / 1.5, 'high': 0.5})
    assert found['drag_Nm'] == {'low': 0.0, 'typical': 0.4, 'high': 0.9}
    assert laws.with_typical_drag(0.1, -load, LEAD, (0.0, 0.4, 0.9))['efficiency'] == (
        pytest.approx({'low': 0.9, 'typical': 0.5, 'high': 0.0}, abs=1e-12)
    )


def test_the_formula_of_jungnickel_by_hand(screw):
    """0.050, 0.088 and 0.126 N m at 100, 300 and 600 rev/min, worked out elsewhere."""
    found = [
        laws.friction_torque_jungnickel_2010(
            2 * screw.loaded_balls_per_nut,
            27.6,
            speed=rpm * math.pi / 30,
            pitch_radius=screw.pitch_radius,
            ball_radius=0.5 * screw.ball_diameter,
            helix_angle=helix_angle(screw),
            kinematic_viscosity=68e-6,
            density=870.0,
        )
        for rpm in (100, 300, 600)
    ]
    assert found == pytest.approx([0.050, 0.088, 0.126], abs=6e-4)


def test_catalogue_drag(screw):
    """0.05 (tan alpha)^-0.5 F L/(2 pi) is 0.25 N m for the nominal nut."""
    found = laws.drag_torque_catalogue(screw.preload, screw.lead, helix_angle(screw))
    expected = 0.05 / math.sqrt(math.tan(helix_angle(screw))) * 990 * 0.01 / 6.2832
    assert found == pytest.approx(expected, rel=1e-4)
    assert found == pytest.approx(0.250, abs=1e-3)
