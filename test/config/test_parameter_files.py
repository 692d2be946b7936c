# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parameter files to start from: each makes the axes that it is about."""

from pathlib import Path

from ballscrew_monitor.core.conversions import TURN
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axes
import pytest

CONFIG = Path(__file__).resolve().parents[2] / 'config'
FILES = sorted(CONFIG.glob('*.yaml'))


def axes_of(name):
    values = parameters.read_file(CONFIG / name)
    axes, reasons = build_axes(values, lambda topic: f'/{topic}')
    assert not reasons
    return {axis.name: axis for axis in axes}


def inputs_of(axis):
    return {one.source: one for one in axis.inputs}


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.stem)
def test_each_file_makes_its_axes(path):
    assert all(axis.inputs for axis in axes_of(path.name).values())


def test_three_axes_have_joints_of_their_own_in_one_topic():
    axes = axes_of('three_axes.yaml')
    assert list(axes) == ['x', 'y', 'z']
    assert {axis.topics[Source.SPEED] for axis in axes.values()} == {'joint_states'}
    assert len({axis.topics[Source.LOAD] for axis in axes.values()}) == 3
    assert inputs_of(axes['y'])[Source.SPEED].scaling(1.0) == -1.0
    assert Source.TEMPERATURE not in inputs_of(axes['z'])
    assert inputs_of(axes['z'])[Source.LOAD].scaling(0.0) == -850.0


def test_a_prismatic_joint_turns_the_screw_once_a_lead():
    axis = axes_of('prismatic_joint.yaml')['x']
    inputs = inputs_of(axis)
    assert inputs[Source.SPEED].scaling(axis.surface.lead) == pytest.approx(TURN, rel=1e-12)
    assert inputs[Source.LOAD].scaling(5.0) == -5.0
    assert Source.TORQUE not in inputs


def test_a_motor_current_takes_the_place_of_the_load():
    axis = axes_of('motor_current.yaml')['x']
    inputs = inputs_of(axis)
    assert set(inputs) == {Source.TORQUE, Source.SPEED}
    assert inputs[Source.TORQUE].scaling(10.0) == pytest.approx(6.2)
    derivation = axis.monitor.settings.derivation
    assert derivation.torque_uncertainty == pytest.approx(0.15 * 0.62)
    assert derivation.inertia == 0.0012


def test_numbers_of_a_plc_carry_no_stamp():
    inputs = inputs_of(axes_of('plc.yaml')['x'])
    assert set(inputs) == set(Source)
    assert not any(one.stamped for one in inputs.values())
    assert inputs[Source.SPEED].scaling(60.0) == pytest.approx(TURN, rel=1e-12)
    assert inputs[Source.LOAD].scaling(1.0) == 1000.0
