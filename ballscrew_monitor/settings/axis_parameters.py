# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parameters that each axis has under its name; `{axis}` in a default is that name."""

from collections.abc import Iterable

from ballscrew_monitor.core.conversions import (
    HANDS,
    LOAD_UNITS,
    POSITION_UNITS,
    SPEED_UNITS,
    TEMPERATURE_UNITS,
    TORQUE_UNITS,
)
from ballscrew_monitor.core.fields import check_path
from ballscrew_monitor.settings.parameter_row import Change, ParameterRow
from surrogate.surface import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT

LOAD_SOURCES = ('topic', 'motor_torque')


def _input_rows(
    name: str,
    *,
    topic: str,
    type_name: str,
    field: str,
    units: Iterable[str],
    timeout: float,
    what: str,
) -> tuple[ParameterRow, ...]:
    return (
        ParameterRow(name=f'{name}.topic', default=topic, text=f'Topic of the {what}.'),
        ParameterRow(
            name=f'{name}.type',
            default=type_name,
            text='Its message type; empty: that of the publisher on the topic.',
        ),
        ParameterRow(
            name=f'{name}.field',
            default=field,
            rule=check_path,
            text='Field to read, such as wrench.force.x, position[0] or velocity[joint_name].',
        ),
        ParameterRow(
            name=f'{name}.unit',
            default=next(iter(units)),
            choices=tuple(units),
            text='Unit of the field after scale and offset.',
        ),
        ParameterRow(
            name=f'{name}.scale',
            default=1.0,
            low=-1e12,
            high=1e12,
            nonzero=True,
            text='Factor on the field.',
        ),
        ParameterRow(
            name=f'{name}.offset',
            default=0.0,
            low=-1e12,
            high=1e12,
            text='Added after the factor, in the unit above.',
        ),
        ParameterRow(
            name=f'{name}.timeout',
            default=timeout,
            unit='s',
            low=1e-3,
            high=3600.0,
            text='Age from which a sample is stale and no longer judged.',
        ),
    )


AXIS_ROWS = (
    ParameterRow(
        name='screw', default='nominal', text='Name of the screw that the surface is for.'
    ),
    ParameterRow(name='oil', default='iso_vg_68', text='Name of the oil that the surface is for.'),
    ParameterRow(
        name='surface',
        default='',
        text='Path of the surface file, or a tier of those shipped; empty: full, if shipped.',
    ),
    ParameterRow(
        name='correct_surface',
        default=True,
        change=Change.LIVE,
        text='Let a full solve correct the surface where it is known better; full tier only.',
    ),
    ParameterRow(
        name='solve_on_dwell',
        default=False,
        change=Change.LIVE,
        text='Solve where the axis dwells and the stated error reaches a limit of the zone.',
    ),
    ParameterRow(
        name='handedness',
        default='right',
        choices=tuple(HANDS),
        text='Hand of the thread; counts for speeds in rotary units and for the torque.',
    ),
    *_input_rows(
        'speed',
        topic='joint_states',
        type_name='sensor_msgs/msg/JointState',
        field='velocity[{axis}_axis]',
        units=(*SPEED_UNITS, *POSITION_UNITS),
        timeout=0.5,
        what='speed: of the screw in a rotary unit, of the nut in a linear',
    ),
    ParameterRow(
        name='speed.window',
        default=0.05,
        unit='s',
        low=1e-3,
        high=10.0,
        text='Time over which positions, in a unit without time, give a speed by least squares; '
        'half of it is the delay.',
    ),
    ParameterRow(
        name='speed.wrap',
        default=0.0,
        low=0.0,
        high=1e12,
        text='Position, in the unit above, at which it starts over, such as 360.0; 0: never.',
    ),
    *_input_rows(
        'load',
        topic='axial_load',
        type_name='geometry_msgs/msg/WrenchStamped',
        field='wrench.force.x',
        units=LOAD_UNITS,
        timeout=0.5,
        what='axial force on the nut, positive along the axis',
    ),
    ParameterRow(
        name='load.source',
        default=LOAD_SOURCES[0],
        choices=LOAD_SOURCES,
        text='Where the load comes from: its topic, or the motor torque by the surface.',
    ),
    ParameterRow(
        name='load.parts_uncertainty',
        default=0.2,
        unit='-',
        low=0.0,
        high=1.0,
        text='Uncertainty of inertia torque and drag over themselves, for a load from the torque.',
    ),
    ParameterRow(
        name='load.largest_share',
        default=0.5,
        unit='-',
        low=0.0,
        high=1.0,
        text='Share of inertia and drag in the motor torque above which no load is derived.',
    ),
    ParameterRow(
        name='inertia',
        default=0.0,
        unit='kg m2',
        low=0.0,
        high=1e3,
        text='Inertia of screw, coupling and rotor, at the screw; its torque is taken off before '
        'a load is derived.',
    ),
    ParameterRow(
        name='acceleration_window',
        default=0.05,
        unit='s',
        low=1e-3,
        high=10.0,
        text='Time over which speeds give the acceleration for it by least squares; half of it is '
        'the delay.',
    ),
    *_input_rows(
        'temperature',
        topic='',
        type_name='sensor_msgs/msg/Temperature',
        field='temperature',
        units=TEMPERATURE_UNITS,
        timeout=30.0,
        what='oil temperature; empty: the default below',
    ),
    ParameterRow(
        name='temperature.default',
        default=40.0,
        unit='degC',
        low=-50.0,
        high=200.0,
        change=Change.LIVE,
        text='Oil temperature while no topic is configured.',
    ),
    *_input_rows(
        'torque',
        topic='',
        type_name='std_msgs/msg/Float64',
        field='data',
        units=TORQUE_UNITS,
        timeout=0.5,
        what='motor torque, compared with the model or the source of the load; empty: none',
    ),
    ParameterRow(
        name='torque.constant',
        default=0.0,
        unit='N m/A',
        low=0.0,
        high=1e6,
        text='Torque constant of the motor, for the unit A; 0: not stated.',
    ),
    ParameterRow(
        name='torque.rated',
        default=0.0,
        unit='N m',
        low=0.0,
        high=1e6,
        text='Rated torque of the motor, for the unit %; 0: not stated.',
    ),
    ParameterRow(
        name='torque.gear_ratio',
        default=1.0,
        unit='-',
        low=1e-3,
        high=1e3,
        text='Turns of the motor per turn of the screw; a gear without loss.',
    ),
    ParameterRow(
        name='torque.uncertainty',
        default=0.0,
        low=0.0,
        high=1e12,
        text='Half width of the range of the true torque, in the unit above; a load derived from '
        'the torque needs it; 0: not stated.',
    ),
    ParameterRow(
        name='limits.rcs',
        default=RCS_LIMIT,
        unit='-',
        low=1e-6,
        high=0.999,
        change=Change.LIVE,
        text='RCS from which a point is outside the optimal zone.',
    ),
    ParameterRow(
        name='limits.efficiency',
        default=EFFICIENCY_LIMIT,
        unit='-',
        low=0.01,
        high=0.999,
        change=Change.LIVE,
        text='Efficiency below which a point is outside the optimal zone.',
    ),
    ParameterRow(
        name='limits.light_load_fraction',
        default=LIGHT_LOAD,
        unit='-',
        low=0.0,
        high=4.0,
        change=Change.LIVE,
        text='Part of the preload below which efficiency is not judged; it is judged again from '
        '(1 + hysteresis) times that load on.',
    ),
    ParameterRow(
        name='limits.standstill_speed',
        default=0.5,
        unit='rad/s',
        low=1e-3,
        high=100.0,
        change=Change.LIVE,
        text='Screw speed below which nothing is judged.',
    ),
    ParameterRow(
        name='limits.raise_delay',
        default=0.5,
        unit='s',
        low=0.0,
        high=3600.0,
        change=Change.LIVE,
        text='Time outside the zone after which the warning is raised.',
    ),
    ParameterRow(
        name='limits.clear_delay',
        default=1.0,
        unit='s',
        low=0.0,
        high=3600.0,
        change=Change.LIVE,
        text='Time inside the zone after which the warning is cleared.',
    ),
    ParameterRow(
        name='limits.hysteresis',
        default=0.1,
        unit='-',
        low=0.0,
        high=0.9,
        change=Change.LIVE,
        text='Part by which RCS and loss must be below their limits to clear the warning, and the '
        'load above the light one to be judged again.',
    ),
    ParameterRow(
        name='limits.plausible_speed',
        default=0.0,
        unit='rad/s',
        low=0.0,
        high=1e6,
        change=Change.LIVE,
        text='Screw speed above which a sample is refused; 0: three times that of the surface.',
    ),
    ParameterRow(
        name='limits.plausible_load',
        default=0.0,
        unit='N',
        low=0.0,
        high=1e9,
        change=Change.LIVE,
        text='Axial load above which a sample is refused; 0: three times that of the surface.',
    ),
    ParameterRow(
        name='max_future',
        default=0.1,
        unit='s',
        low=0.0,
        high=3600.0,
        change=Change.LIVE,
        text='A stamp further ahead of the clock is refused.',
    ),
    ParameterRow(
        name='max_lag',
        default=0.2,
        unit='s',
        low=1e-3,
        high=3600.0,
        text='Stamps further behind their arrival are warned of; they are judged all the same.',
    ),
    ParameterRow(
        name='publish_period',
        default=0.1,
        unit='s',
        low=0.0,
        high=3600.0,
        change=Change.LIVE,
        text='Period of the state topic, besides each change of the level; 0: a state for every '
        'judged speed sample. Above 1 s it rises only while unconfigured.',
    ),
    ParameterRow(
        name='plain_topics',
        default=False,
        text='Publish efficiency, RCS, film ratio, regime and warning as topics of std_msgs too.',
    ),
)
