# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""An axis made from parameter values."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.node import parameters
from ballscrew_monitor.node.axis import build_axes, build_axis, named_topics, settings_of
import pytest
from std_msgs.msg import Float64
from surrogate.files import InputError
from surrogate.surface import shipped_surface


def build(**changes):
    values = parameters.defaults(['x']) | {
        f'x.{name.replace("__", ".")}': value for name, value in changes.items()
    }
    return build_axis('x', values)


def test_defaults_make_an_axis_of_the_shipped_surface():
    axis = build()
    assert (axis.surface.screw_name, axis.surface.oil_name) == ('nominal', 'iso_vg_68')
    assert axis.surface.tier == 'full'
    assert [source.source for source in axis.inputs] == [Source.LOAD, Source.SPEED]
    assert axis.max_future == axis.monitor.settings.tick_period == SECOND // 10
    limits = axis.monitor.settings.limits
    assert limits.light_load == 0.25 * axis.surface.preload
    assert (limits.raise_delay, limits.clear_delay) == (SECOND // 2, SECOND)


@pytest.mark.parametrize('tier', ['closed_form', 'full'])
def test_a_tier_chooses_its_shipped_surface(tier):
    assert build(surface=tier).surface.tier == tier


def test_a_topic_makes_an_input():
    axis = build(temperature__topic='oil', torque__topic='torque')
    assert [source.source for source in axis.inputs] == list(Source)
    assert axis.monitor.settings.timeouts[Source.TEMPERATURE] == 30 * SECOND


def test_an_empty_type_leaves_the_input_open():
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


@pytest.mark.parametrize(
    ('changes', 'match'),
    [
        ({'speed__topic': ''}, 'parameter x.speed.topic is empty'),
        ({'speed__field': 'velocity'}, "parameters x.speed: field 'velocity' .* not a number"),
        ({'speed__type': '', 'speed__field': 'velocity['}, 'parameters x.speed: .* is not a name'),
        ({'load__type': 'a/b'}, "parameters x.load: message type 'a/b'"),
        ({'surface': '/no/such/file.npz'}, 'axis x: .*/no/such/file.npz'),
        ({'screw': 'other'}, "axis x: .*'other'"),
        ({'oil': 'olive'}, "axis x: .*'olive'"),
    ],
)
def test_an_axis_that_cannot_work_is_refused(changes, match):
    with pytest.raises(InputError, match=match):
        build(**changes)


def resolve(topic):
    if ' ' in topic:
        raise RuntimeError(topic)
    return f'/{topic}'


def test_an_axis_that_cannot_be_built_leaves_the_others():
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
    assert reasons['w'] == "parameter w.load.topic is 'no name', no topic name"
    assert "'olive'" in reasons['y']
    assert reasons['z'] == (
        'topic /joint_states is configured as sensor_msgs/msg/JointState and as '
        'std_msgs/msg/Float64'
    )
    assert named_topics(values, resolve) == {'/axial_load', '/joint_states'}


def test_a_surface_of_another_screw_is_refused():
    with pytest.raises(InputError, match="configured is 'other'"):
        build(surface=str(shipped_surface()), screw='other')


def test_live_parameters_are_taken_over():
    axis = build()
    values = parameters.defaults(['x']) | {'x.limits.rcs': 0.5, 'x.max_future': 2.0}
    axis.adapt(values)
    assert axis.monitor.settings == settings_of('x', values, axis.surface)
    assert axis.monitor.settings.limits.rcs == 0.5
    assert axis.max_future == 2 * SECOND


def test_what_is_plausible_is_stated_or_three_times_the_surface():
    axis = build()
    fastest, load = axis.surface.speed_range[1], axis.surface.load_range[1]
    assert axis.monitor.settings.plausible == {
        Source.SPEED: 3.0 * fastest,
        Source.LOAD: 3.0 * load,
    }
    stated = build(limits__plausible_speed=300.0, limits__plausible_load=5e3)
    assert stated.monitor.settings.plausible == {Source.SPEED: 300.0, Source.LOAD: 5e3}


def test_a_new_surface_is_used_at_once():
    axis = build()
    other = build().surface
    axis.use_surface(other, parameters.defaults(['x']))
    assert axis.surface is axis.monitor.surface is other
