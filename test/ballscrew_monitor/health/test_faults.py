# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that are wrong from the first day: each is told by the residual of the baseline."""

import dataclasses
import math

from ballscrew_monitor.health.faults import input_fault, NEITHER, NOT_IDENTIFIED, NOT_TOLD
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import Place
import pytest

SPEEDS, LOADS = (2.0, 8.0, 30.0, 100.0), (-1200.0, -400.0, 0.0, 800.0)


@pytest.fixture
def told(motion, surface):
    """Return what tells the fault of points that a change of torque and load was made to."""
    model, shipped = Model(surface), surface

    def tell(changed, factor=1.2, constant=0.03, surface=shipped):
        found = []
        for band, speed in enumerate(SPEEDS):
            for load_band, load in enumerate(LOADS):
                for sign in (1, -1):
                    point = motion.point(
                        place=Place(band, load_band, 0, sign),
                        speed=sign * speed,
                        axial_load=load,
                        residual=math.nan,
                    )
                    friction = factor * model.friction([point])[0] + constant
                    torque = sign * (friction + model.ideal(point))
                    found.append(changed(dataclasses.replace(point, motor_torque=torque)))
        return input_fault(found, surface)

    return tell


def replaced(**factors):
    """Return a change of fields by factors."""

    def change(point):
        values = {name: factor * getattr(point, name) for name, factor in factors.items()}
        return dataclasses.replace(point, **values)

    return change


@pytest.mark.parametrize(('factor', 'constant'), [(1.0, 0.0), (0.8, 0.06), (1.3, 0.0)])
def test_a_friction_within_the_doubt_of_the_surface_is_no_fault(told, factor, constant):
    assert told(lambda point: point, factor, constant) == ''


def test_a_load_of_the_wrong_sign_is_told(told):
    assert told(replaced(axial_load=-1.0)).startswith('the measured torque follows -1')
    assert 'has the wrong sign' in told(replaced(axial_load=-1.0))


def test_a_load_of_another_unit_is_told_with_its_factor(told):
    found = told(replaced(axial_load=2.5))
    assert found.endswith('check unit and scale of the load')
    assert float(found.split()[4]) == pytest.approx(0.4, rel=0.2)
    assert 'does not tell why' in told(replaced(axial_load=0.05))


def test_another_torque_constant_is_told_with_its_factor(told, identified):
    found = told(replaced(motor_torque=3.0), 1.0, 0.0, identified)
    assert found.endswith('check torque constant and gear ratio')
    assert float(found.split()[4]) == pytest.approx(3.0, rel=0.1)


def test_a_drag_that_was_never_identified_says_nothing_of_the_torque_constant(told):
    assert told(replaced(motor_torque=3.0), 1.0, 0.0) == NOT_IDENTIFIED


def test_what_is_not_told_by_a_drag_that_was_never_identified_names_no_torque_constant(
    told, identified
):
    assert told(replaced(axial_load=0.05)) == NEITHER
    assert told(replaced(axial_load=0.05), surface=identified) == NOT_TOLD
    assert 'torque constant' not in NEITHER


def test_a_factor_beyond_any_unit_is_not_told(told, identified):
    assert told(replaced(motor_torque=1e4), 1.0, 0.0, identified) == NOT_TOLD
    assert told(replaced(motor_torque=-1e4), 1.0, 0.0, identified) == NOT_TOLD
    found = told(replaced(motor_torque=-1.0), 1.0, 0.0, identified)
    assert float(found.split()[4]) == pytest.approx(-1.0, rel=0.1)


def test_an_offset_is_told(told):
    def shifted(point):
        return dataclasses.replace(point, motor_torque=point.motor_torque + 1.5)

    found = told(shifted, 1.0, 0.0)
    assert 'is shifted by +1.5 N m in both directions' in found


def test_few_places_tell_nothing(motion, surface):
    assert input_fault([motion.point(motor_torque=9.0)] * 3, surface) == ''
