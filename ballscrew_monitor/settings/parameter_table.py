# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The table of parameters, first those of the node itself, then those that each axis has.

The names of an axis row begin with the name of the axis; `{axis}` in a default is that name.

"""

from collections.abc import Iterable

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.fields import check_path
from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.settings.parameter_row import LIVE, NEVER, ParameterRow
from surrogate.surface import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT

LOAD_SOURCES = ('topic', 'motor_torque')

NODE_ROWS = (
    ParameterRow('axes', ['x'], change=NEVER).says(
        'Names of the axes, lower case; each has parameters and topics under its name.'
    ),
    ParameterRow('autostart', True, change=NEVER).says(
        'Configure and activate at start; false under a lifecycle manager.'
    ),
    ParameterRow('machine', '', change=NEVER).says(
        'Name of the machine: axes have one history for each machine; empty: the folder of a log, '
        'or state_dir.'
    ),
    ParameterRow('localhost', False, change=NEVER).says(
        'Bind every port of the node to 127.0.0.1: no other machine reaches it.'
    ),
    ParameterRow('tick_period', 0.1, 's', 0.01, 10.0, NEVER).says(
        'Grid of stamps on which a state is published while the speed is missing.'
    ),
    ParameterRow('state_dir', 'auto', change=NEVER).says(
        'Directory for what outlives the node, for this node alone; auto: '
        '$XDG_STATE_HOME/ballscrew_monitor/<name of the node>; empty: nothing is kept.'
    ),
    ParameterRow('state_limit', 64.0, 'MB', 1.0, 1e6, NEVER).says(
        'Limit of what is kept in state_dir; the oldest entries of the event log go first.'
    ),
    ParameterRow('diagnostics_period', 1.0, 's', 0.1, 60.0, NEVER).says(
        'Period of /diagnostics; a change is published at once.'
    ),
    ParameterRow('record', 'never', choices=('never', 'around_events', 'always')).says(
        'What the node records of itself: the events that it judges, states and warnings.'
    ),
    ParameterRow('record_inputs', True).says(
        'Record the messages of the inputs too, for other tools; a replay needs them only to '
        'read them in another way.'
    ),
    ParameterRow('record_dir', 'auto').says(
        'Directory of the recordings; auto: recordings in state_dir.'
    ),
    ParameterRow('record_before', 60.0, 's', 20.0, 3600.0).says(
        'How much of the time before an event is recorded around it.'
    ),
    ParameterRow('record_after', 10.0, 's', 1.0, 3600.0).says(
        'How much of the time after the begin or the end of an event is recorded.'
    ),
    ParameterRow('record_longest', 3600.0, 's', 10.0, 86400.0).says(
        'Length after which a recording is finished and the next one begins.'
    ),
    ParameterRow('record_largest', 256.0, 'MB', 1.0, 65536.0).says(
        'Size after which a recording is finished, before compression.'
    ),
    ParameterRow('record_total', 2048.0, 'MB', 2.0, 1e6).says(
        'Size of all recordings; the oldest make room for new ones.'
    ),
)


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
        ParameterRow(f'{name}.topic', topic).says(f'Topic of the {what}.'),
        ParameterRow(f'{name}.type', type_name).says(
            'Its message type; empty: that of the publisher on the topic.'
        ),
        ParameterRow(f'{name}.field', field, rule=check_path).says(
            'Field to read, such as wrench.force.x, position[0] or velocity[joint_name].'
        ),
        ParameterRow(f'{name}.unit', next(iter(units)), choices=tuple(units)).says(
            'Unit of the field after scale and offset.'
        ),
        ParameterRow(f'{name}.scale', 1.0, '', -1e12, 1e12, nonzero=True).says(
            'Factor on the field.'
        ),
        ParameterRow(f'{name}.offset', 0.0, '', -1e12, 1e12).says(
            'Added after the factor, in the unit above.'
        ),
        ParameterRow(f'{name}.timeout', timeout, 's', 1e-3, 3600.0).says(
            'Age from which a sample is stale and no longer judged.'
        ),
    )


AXIS_ROWS = (
    ParameterRow('screw', 'nominal').says('Name of the screw that the surface is for.'),
    ParameterRow('oil', 'iso_vg_68').says('Name of the oil that the surface is for.'),
    ParameterRow('surface', '').says(
        'Path of the surface file, or a tier of those shipped; empty: full, if shipped.'
    ),
    ParameterRow('correct_surface', True, change=LIVE).says(
        'Let a full solve correct the surface where it is known better; full tier only.'
    ),
    ParameterRow('solve_on_dwell', False, change=LIVE).says(
        'Solve where the axis dwells and the stated error reaches a limit of the zone.'
    ),
    ParameterRow('handedness', 'right', choices=tuple(conversions.HANDS)).says(
        'Hand of the thread; counts for speeds in rotary units and for the torque.'
    ),
    *_input_rows(
        'speed',
        topic='joint_states',
        type_name='sensor_msgs/msg/JointState',
        field='velocity[{axis}_axis]',
        units=(*conversions.SPEED_UNITS, *conversions.POSITION_UNITS),
        timeout=0.5,
        what='speed: of the screw in a rotary unit, of the nut in a linear',
    ),
    ParameterRow('speed.window', 0.05, 's', 1e-3, 10.0).says(
        'Time over which positions, in a unit without time, give a speed by least squares; '
        'half of it is the delay.'
    ),
    ParameterRow('speed.wrap', 0.0, '', 0.0, 1e12).says(
        'Position, in the unit above, at which it starts over, such as 360.0; 0: never.'
    ),
    *_input_rows(
        'load',
        topic='axial_load',
        type_name='geometry_msgs/msg/WrenchStamped',
        field='wrench.force.x',
        units=conversions.LOAD_UNITS,
        timeout=0.5,
        what='axial force on the nut, positive along the axis',
    ),
    ParameterRow('load.source', LOAD_SOURCES[0], choices=LOAD_SOURCES).says(
        'Where the load comes from: its topic, or the motor torque by the surface.'
    ),
    ParameterRow('load.parts_uncertainty', 0.2, '-', 0.0, 1.0).says(
        'Uncertainty of inertia torque and drag over themselves, for a load from the torque.'
    ),
    ParameterRow('load.largest_share', 0.5, '-', 0.0, 1.0).says(
        'Share of inertia and drag in the motor torque above which no load is derived.'
    ),
    ParameterRow('inertia', 0.0, 'kg m2', 0.0, 1e3).says(
        'Inertia of screw, coupling and rotor, at the screw; its torque is taken off before '
        'a load is derived.'
    ),
    ParameterRow('acceleration_window', 0.05, 's', 1e-3, 10.0).says(
        'Time over which speeds give the acceleration for it by least squares; half of it is '
        'the delay.'
    ),
    *_input_rows(
        'temperature',
        topic='',
        type_name='sensor_msgs/msg/Temperature',
        field='temperature',
        units=conversions.TEMPERATURE_UNITS,
        timeout=30.0,
        what='oil temperature; empty: the default below',
    ),
    ParameterRow('temperature.default', 40.0, 'degC', -50.0, 200.0, LIVE).says(
        'Oil temperature while no topic is configured.'
    ),
    *_input_rows(
        'torque',
        topic='',
        type_name='std_msgs/msg/Float64',
        field='data',
        units=conversions.TORQUE_UNITS,
        timeout=0.5,
        what='motor torque, compared with the model or the source of the load; empty: none',
    ),
    ParameterRow('torque.constant', 0.0, 'N m/A', 0.0, 1e6).says(
        'Torque constant of the motor, for the unit A; 0: not stated.'
    ),
    ParameterRow('torque.rated', 0.0, 'N m', 0.0, 1e6).says(
        'Rated torque of the motor, for the unit %; 0: not stated.'
    ),
    ParameterRow('torque.gear_ratio', 1.0, '-', 1e-3, 1e3).says(
        'Turns of the motor per turn of the screw; a gear without loss.'
    ),
    ParameterRow('torque.uncertainty', 0.0, '', 0.0, 1e12).says(
        'Half width of the range of the true torque, in the unit above; a load derived from '
        'the torque needs it; 0: not stated.'
    ),
    ParameterRow('limits.rcs', RCS_LIMIT, '-', 1e-6, 0.999, LIVE).says(
        'RCS from which a point is outside the optimal zone.'
    ),
    ParameterRow('limits.efficiency', EFFICIENCY_LIMIT, '-', 0.01, 0.999, LIVE).says(
        'Efficiency below which a point is outside the optimal zone.'
    ),
    ParameterRow('limits.light_load_fraction', LIGHT_LOAD, '-', 0.0, 4.0, LIVE).says(
        'Part of the preload below which efficiency is not judged; it is judged again from '
        '(1 + hysteresis) times that load on.'
    ),
    ParameterRow('limits.standstill_speed', 0.5, 'rad/s', 1e-3, 100.0, LIVE).says(
        'Screw speed below which nothing is judged.'
    ),
    ParameterRow('limits.raise_delay', 0.5, 's', 0.0, 3600.0, LIVE).says(
        'Time outside the zone after which the warning is raised.'
    ),
    ParameterRow('limits.clear_delay', 1.0, 's', 0.0, 3600.0, LIVE).says(
        'Time inside the zone after which the warning is cleared.'
    ),
    ParameterRow('limits.hysteresis', 0.1, '-', 0.0, 0.9, LIVE).says(
        'Part by which RCS and loss must be below their limits to clear the warning, and the '
        'load above the light one to be judged again.'
    ),
    ParameterRow('limits.plausible_speed', 0.0, 'rad/s', 0.0, 1e6, LIVE).says(
        'Screw speed above which a sample is refused; 0: three times that of the surface.'
    ),
    ParameterRow('limits.plausible_load', 0.0, 'N', 0.0, 1e9, LIVE).says(
        'Axial load above which a sample is refused; 0: three times that of the surface.'
    ),
    ParameterRow('max_future', 0.1, 's', 0.0, 3600.0, LIVE).says(
        'A stamp further ahead of the clock is refused.'
    ),
    ParameterRow('max_lag', 0.2, 's', 1e-3, 3600.0).says(
        'Stamps further behind their arrival are warned of; they are judged all the same.'
    ),
    ParameterRow('one_source', True, change=LIVE).says(
        'Judge nothing while several publishers send the same input; false: judge all the same.'
    ),
    ParameterRow('publish_period', 0.1, 's', 0.0, 3600.0, LIVE).says(
        'Period of the state topic, besides each change of the level; 0: a state for every '
        'judged speed sample. Above 1 s it rises only while unconfigured.'
    ),
    ParameterRow('warning.policy', 'zone', choices=tuple(WarningPolicy), change=LIVE).says(
        'What the diagnostics warn of: a point outside the zone, an axis that is worse than its '
        'baseline, or both.'
    ),
    ParameterRow('advice.speed', False, change=LIVE).says(
        'Let all advice, on warnings and of health, name another speed: the process leaves it '
        'free.'
    ),
    ParameterRow('health.enabled', True).says(
        'Gather in state_dir what tells whether the axis is normal or worse, and publish it.'
    ),
    ParameterRow('health.free_load', 0.0, 'N', -1e6, 1e6).says(
        'Axial load in a reference run whose load is derived from the torque, positive along the '
        'axis: the weight of a vertical axis.'
    ),
    ParameterRow('health.always_free', False).says(
        'The axis has no process force: health.free_load holds in all motion whose load is '
        'derived from the torque, which then tells of the friction.'
    ),
    ParameterRow('health.period', 3600.0, 's', 1.0, 1e6, LIVE).says(
        'Time between two assessments of health.'
    ),
    ParameterRow('health.baseline_days', 91.0, 'd', 1.0, 1e4, LIVE).says(
        'Days whose logs are the baseline, from the first one on; three logs at least.'
    ),
    ParameterRow('plain_topics', False).says(
        'Publish efficiency, RCS, film ratio, regime and warning as topics of std_msgs too.'
    ),
)
