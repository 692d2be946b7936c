# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sliding friction over an ellipse and elastic hysteresis, against closed forms."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.formulas.geometry import hertz, screw_contact
from surrogate.formulas.load_sharing import normal_force
from surrogate.formulas.lubricant import lubricant_state
from surrogate.formulas.sliding import (
    ellipse_nodes,
    hysteresis_force,
    largest_sliding,
    mean_sliding_speed,
    sliding_friction,
)


@pytest.mark.parametrize('side', ['screw', 'nut'])
def test_hysteresis_is_the_work_on_the_front_half(screw, side):
    """Pressure times the slope x/Rx of the front half, integrated over the ellipse of Hertz."""
    contact = screw_contact(screw, side)
    ellipse = hertz(contact, 27.6)
    x, y, weight = ellipse_nodes(40, 400)
    pressure = float(ellipse.max_pressure) * np.sqrt(1 - x * x - y * y)
    area = weight * float(ellipse.semi_axis_x * ellipse.semi_axis_y)
    sinking = np.maximum(x, 0) * float(ellipse.semi_axis_x) / contact.radius_x
    # Both surfaces roll: the work of a distance is lost once, half of it on each.
    lost = 0.01 * float((pressure * sinking * area).sum()) / 2
    found = hysteresis_force(0.01, 27.6, float(ellipse.semi_axis_x), contact.radius_x)
    assert found == pytest.approx(lost, rel=1e-3)
    assert math.isclose(hysteresis_force(0.0, 27.6, 5e-5, 3e-3), 0.0)


def test_largest_sliding_is_that_of_a_ball_under_preload(screw):
    """Of the side that slides more; without preload a light load stands for it."""
    load = float(normal_force(screw, screw.preload))
    sides = [mean_sliding_speed(screw, side, load, 1.0) for side in ('screw', 'nut')]
    assert largest_sliding(screw) == max(sides)
    assert 0 < largest_sliding(replace(screw, preload=0.0)) < max(sides)


@pytest.mark.parametrize('side', ['screw', 'nut'])
def test_mean_sliding_is_the_loss_over_the_friction_of_a_dry_contact(screw, oil, side):
    """In either direction."""
    load, speed = np.array(27.6), np.array(60.0)
    ellipse = hertz(screw_contact(screw, side), load)
    state = lubricant_state(oil, np.array(313.15))
    film, share = np.array(1e-7), np.array(1.0)
    torque, _ = sliding_friction(screw, side, ellipse, film, share, state, speed)
    lost, friction = torque * speed, screw.roughness.asperity_friction * 27.6
    assert mean_sliding_speed(screw, side, 27.6, -60.0) == pytest.approx(lost / friction, rel=1e-3)


def test_a_limiting_shear_stress_bounds_the_oil_alone(screw, oil):
    """A high limit changes no bit; a low one is nearly Coulomb friction."""

    def friction(share, touching=0.0):
        state = lubricant_state(replace(oil, limiting_shear_share=share), 313.15)
        ellipse = hertz(screw_contact(screw, 'screw'), np.array([27.6]))
        given = np.array([150e-9]), np.array([touching]), state, np.array([60.0])
        return sliding_friction(screw, 'screw', ellipse, *given)

    assert friction(0.2)[0].tobytes() == friction(None)[0].tobytes()
    assert friction(0.02)[0] < friction(None)[0]
    _, low = friction(0.01)
    assert 0.008 < low < 0.01  # the rim shears below the limit
    _, mixed = friction(0.01, touching=0.5)
    assert mixed == pytest.approx(0.5 * low + 0.5 * 0.1, rel=1e-6)
