# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""An axis made from parameter values."""

import math
from pathlib import Path

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.state import LoadDerivation
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import (
    build_axes,
    build_axis,
    gathering_of,
    named_topics,
    settings_of,
    start_text,
)
import pytest
from std_msgs.msg import Float64
from surrogate.surface import shipped_surface


def build(**changes):
    values = parameters.defaults(['x']) | {
        f'x.{name.replace("__", ".")}': value for name, value in changes.items()
    }
    return build_axis('x', values)


def test_motion_counts_as_free_of_process_force_only_where_the_axis_says_so():
    values = parameters.defaults(['x'])
    assert gathering_of('x', values) == GatherSettings()
    free = {'x.health.free_load': -200.0, 'x.health.always_free': True}
    stated = GatherSettings(free_load=-200.0, always_free=True)
    assert gathering_of('x', values | free) == stated


def test_defaults_make_an_axis_of_the_shipped_surface_and_what_is_plausible():
    axis = build()
    assert (axis.surface.screw_name, axis.surface.oil_name) == ('nominal', 'iso_vg_68')
    assert axis.surface.tier == 'full'
    assert [source.source for source in axis.inputs] == [Source.LOAD, Source.SPEED]
    assert axis.max_future == axis.monitor.settings.tick_period == SECOND // 10
    limits = axis.monitor.settings.limits
    assert limits.light_load == 0.25 * axis.surface.preload
    assert (limits.raise_delay, limits.clear_delay) == (SECOND // 2, SECOND)
    axis = build()
    fastest, load = axis.surface.speed_range[1], axis.surface.load_range[1]
    expected = {Source.SPEED: 3.0 * fastest, Source.LOAD: 3.0 * load}
    assert axis.monitor.settings.plausible == expected
    stated = build(limits__plausible_speed=300.0, limits__plausible_load=5e3)
    assert stated.monitor.settings.plausible == {Source.SPEED: 300.0, Source.LOAD: 5e3}


@pytest.mark.parametrize(('folder', 'key'), [(Path('kept'), 'start'), (None, 'start_unkept')])
def test_one_sentence_says_all_of_an_axis_at_start(folder, key, says):
    axis = build(speed__type='')
    said = start_text(axis, '/mill/monitor', lambda topic: f'/mill/{topic}', folder)
    assert said == says(key, surface=axis.surface.sha256[:16])


@pytest.mark.parametrize('tier', ['closed_form', 'full'])
def test_a_tier_chooses_its_shipped_surface(tier):
    assert build(surface=tier).surface.tier == tier


def test_a_topic_makes_an_input_and_an_empty_type_leaves_it_open():
    axis = build(temperature__topic='oil', torque__topic='torque')
    assert [source.source for source in axis.inputs] == list(Source)
    assert axis.monitor.settings.timeouts[Source.TEMPERATURE] == 30 * SECOND
    axis = build(speed__type='')
    assert [source.source for source in axis.inputs] == [Source.LOAD]
    assert [source.source for source in axis.open_inputs] == [Source.SPEED]
    assert axis.topics == {Source.LOAD: 'axial_load', Source.SPEED: 'joint_states'}


@pytest.mark.parametrize(
    ('unit', 'value', 'expected'), [('rad/s', 3.0, -3.0), ('mm/s', 10.0, 2.0 * math.pi)]
)
def test_units_and_handedness_reach_the_input(unit, value, expected):
    axis = build(
        handedness='left',
        speed__unit=unit,
        speed__type='std_msgs/msg/Float64',
        speed__field='data',
    )
    sample = axis.inputs[-1].read(Float64(data=value), now=5, max_future=0)
    assert sample.value == pytest.approx(expected)


MOTOR = {
    'load__source': 'motor_torque',
    'torque__topic': 'torque',
    'torque__unit': '%',
    'torque__rated': 8.0,
    'torque__gear_ratio': 2.0,
    'torque__uncertainty': 5.0,
}


def test_only_a_load_of_a_topic_has_one_and_is_not_derived():
    axis = build(**MOTOR, inertia=2e-3, load__largest_share=0.25, acceleration_window=0.1)
    assert [source.source for source in axis.inputs] == [Source.TORQUE, Source.SPEED]
    assert axis.topics == {Source.TORQUE: 'torque', Source.SPEED: 'joint_states'}
    assert Source.LOAD not in axis.monitor.settings.timeouts
    assert axis.inputs[0].scaling(50.0) == pytest.approx(0.5 * 8.0 * 2.0)
    assert axis.monitor.settings.derivation == LoadDerivation(
        inertia=2e-3,
        window=SECOND // 10,
        torque_uncertainty=0.05 * 8.0 * 2.0,
        parts_uncertainty=0.2,
        largest_share=0.25,
    )
    assert build().monitor.settings.derivation is None


def test_units_of_a_drive_and_of_positions_reach_the_inputs():
    axis = build(
        torque__topic='current', torque__unit='A', torque__constant=0.5, handedness='left'
    )
    assert axis.inputs[1].scaling(4.0) == -2.0
    assert build().monitor.settings.position_window == 0
    axis = build(speed__unit='deg', speed__field='position[0]', speed__wrap=360.0)
    assert axis.monitor.settings.position_window == SECOND // 20
    assert axis.monitor.settings.wrap == pytest.approx(math.tau)
    assert axis.inputs[-1].scaling(180.0) == pytest.approx(math.pi)


@pytest.mark.parametrize(
    ('changes', 'match'),
    [
        (MOTOR | {'torque__topic': ''}, 'torque_topic_stated'),
        (MOTOR | {'torque__uncertainty': 0.0}, 'torque_uncertainty_0'),
        (MOTOR | {'torque__rated': 0.0}, 'parameters_torque_torque'),
        ({'torque__topic': 'current', 'torque__unit': 'A'}, 'parameters_torque'),
        ({'speed__topic': ''}, 'speed_topic_empty'),
        ({'speed__field': 'velocity'}, 'parameters_speed_field'),
        ({'speed__type': '', 'speed__field': 'velocity['}, 'parameters_speed_name'),
        ({'load__type': 'a/b'}, 'parameters_load_message'),
        ({'surface': '/no/such/file.npz'}, 'such_file_npz'),
        ({'screw': 'other'}, 'other_2'),
        ({'oil': 'olive'}, 'olive_2'),
    ],
)
def test_an_axis_that_cannot_work_is_refused(changes, match, refused):
    refused(match, build, **changes)


def resolve(topic):
    if ' ' in topic:
        raise RuntimeError(topic)
    return f'/{topic}'


def test_an_axis_that_cannot_be_built_leaves_the_others(says):
    changes = {
        'w.load.topic': 'no name',
        'y.oil': 'olive',
        'z.speed.type': 'std_msgs/msg/Float64',
        'z.speed.field': 'data',
    }
    values = parameters.defaults(['w', 'x', 'y', 'z']) | changes
    built, reasons = build_axes(values, resolve)
    assert [axis.name for axis in built] == ['x']
    assert list(reasons) == ['w', 'y', 'z']
    assert reasons['w'] == says('w_load_topic')
    assert "'olive'" in reasons['y']
    assert reasons['z'] == says('topic_joint_states')
    assert named_topics(values, resolve) == {'/axial_load', '/joint_states'}


def test_a_surface_of_another_screw_is_refused(refused):
    refused('configured_other', build, surface=str(shipped_surface()), screw='other')


def test_live_parameters_and_a_new_surface_are_taken_over_at_once():
    axis = build()
    values = parameters.defaults(['x']) | {'x.limits.rcs': 0.5, 'x.max_future': 2.0}
    axis.adapt(values)
    assert axis.monitor.settings == settings_of('x', values, axis.surface)
    assert axis.monitor.settings.limits.rcs == 0.5
    assert axis.max_future == 2 * SECOND
    axis = build()
    other = build().surface
    axis.use_surface(other, parameters.defaults(['x']))
    assert axis.surface is axis.monitor.surface is other
