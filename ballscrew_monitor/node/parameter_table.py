# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter of the node, declared once: its default, what is allowed, and a sentence."""

from collections.abc import Callable, Mapping
import dataclasses
import enum
import math
from typing import Any

from ballscrew_monitor.core.conversions import (
    HANDS,
    LINEAR_SPEED_UNITS,
    LOAD_UNITS,
    ROTARY_SPEED_UNITS,
    TEMPERATURE_UNITS,
    TORQUE_UNITS,
)
from ballscrew_monitor.core.fields import check_path
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from surrogate.files import InputError
from surrogate.surface import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT

Value = str | float | bool | list[str]
_TYPE_NAMES = {
    bool: 'true or false',
    float: 'a number with a decimal point',
    str: 'a text',
    list: 'a list of texts',
}
BARE_LETTERS = {'y': True, 'Y': True, 'n': False, 'N': False, 'off': False}
BARE_WORDS = "ROS reads a bare y, n, yes, no, on or off as true or false: quote it, such as 'y'"


class Change(enum.Enum):
    """When a parameter may change."""

    LIVE = 'any time'
    UNCONFIGURED = 'while unconfigured'
    NEVER = 'at start only'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ParameterRow:
    """
    One parameter: numbers lie from `low` to `high`, texts are one of `choices` if there are.

    A `rule` raises InputError for a text that has not the form it must have.

    """

    name: str
    default: Value
    text: str
    unit: str = ''
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()
    nonzero: bool = False
    rule: Callable[[Any], None] | None = None
    change: Change = Change.UNCONFIGURED

    @property
    def allowed(self) -> str:
        """Return what is allowed, in words; empty if anything of the type is."""
        if self.choices:
            return 'one of ' + ', '.join(self.choices)
        if not isinstance(self.default, float):
            return ''
        return f'{self.low:g} to {self.high:g}' + (', not 0' if self.nonzero else '')

    def read(self, value: Any) -> Any:
        """Return `value`, or the choice for which ROS reads it: `N` without quotes is false."""
        if not isinstance(value, bool):
            return value
        return next((word for word in self.choices if BARE_LETTERS.get(word) is value), value)

    def check(self, name: str, value: Any) -> None:
        """Raise InputError unless `value` is allowed for the parameter `name`."""
        value = self.read(value)
        self._check_type(name, value)
        good = not self.choices or value in self.choices
        if isinstance(value, float):
            good = self.low <= value <= self.high and not (self.nonzero and value == 0.0)
        if not good:
            unit = f' {self.unit}' if self.unit else ''
            raise InputError(
                f'parameter {name} is {value!r}{unit}, allowed is {self.allowed}{unit}'
            )
        try:
            if self.rule is not None:
                self.rule(value)
        except InputError as error:
            raise InputError(f'parameter {name}: {error}') from None

    def _check_type(self, name: str, value: Any) -> None:
        parts = value if isinstance(value, list) else [value]
        texts = isinstance(self.default, (str, list))
        if type(value) is type(self.default) and (
            not isinstance(value, list) or all(isinstance(part, str) for part in parts)
        ):
            return
        hint = f', {BARE_WORDS}' if texts and any(isinstance(part, bool) for part in parts) else ''
        allowed = _TYPE_NAMES[type(self.default)]
        raise InputError(f'parameter {name} is {value!r}, it must be {allowed}{hint}')

    def descriptor(self) -> ParameterDescriptor:
        """Return the descriptor that ROS tools show and that rclpy enforces."""
        made = ParameterDescriptor(
            description=f'{self.text} [{self.unit}]' if self.unit else self.text,
            read_only=self.change is Change.NEVER,
        )
        if isinstance(self.default, float):
            made.floating_point_range = [
                FloatingPointRange(from_value=self.low, to_value=self.high)
            ]
        changes = f'changes {self.change.value}' if self.change is not Change.NEVER else ''
        made.additional_constraints = '; '.join(filter(None, (self.allowed, changes)))
        return made


RECORD_ROWS = (
    ParameterRow(
        name='record',
        default='off',
        choices=('off', 'around_events', 'always'),
        text='What the node records of itself: inputs, states, warnings and all a replay needs.',
    ),
    ParameterRow(
        name='record_dir',
        default='auto',
        text='Directory of the recordings; auto: recordings in state_dir.',
    ),
    ParameterRow(
        name='record_before',
        default=60.0,
        unit='s',
        low=20.0,
        high=3600.0,
        text='How much of the time before an event is recorded around it.',
    ),
    ParameterRow(
        name='record_after',
        default=10.0,
        unit='s',
        low=1.0,
        high=3600.0,
        text='How much of the time after the begin or the end of an event is recorded.',
    ),
    ParameterRow(
        name='record_longest',
        default=3600.0,
        unit='s',
        low=10.0,
        high=86400.0,
        text='Length after which a recording is finished and the next one begins.',
    ),
    ParameterRow(
        name='record_largest',
        default=256.0,
        unit='MB',
        low=1.0,
        high=65536.0,
        text='Size after which a recording is finished, before compression.',
    ),
    ParameterRow(
        name='record_total',
        default=2048.0,
        unit='MB',
        low=2.0,
        high=1e6,
        text='Size of all recordings; the oldest make room for new ones.',
    ),
)

NODE_ROWS = (
    ParameterRow(
        name='axes',
        default=['x'],
        change=Change.NEVER,
        text='Names of the axes, lower case; each has parameters and topics under its name.',
    ),
    ParameterRow(
        name='autostart',
        default=True,
        change=Change.NEVER,
        text='Configure and activate at start; false under a lifecycle manager.',
    ),
    ParameterRow(
        name='localhost',
        default=False,
        change=Change.NEVER,
        text='Bind every port of the node to 127.0.0.1: no other machine reaches it.',
    ),
    ParameterRow(
        name='tick_period',
        default=0.1,
        unit='s',
        low=0.01,
        high=10.0,
        change=Change.NEVER,
        text='Grid of stamps on which a state is published while the speed is missing.',
    ),
    ParameterRow(
        name='state_dir',
        default='auto',
        change=Change.NEVER,
        text='Directory for what outlives the node, for this node alone; auto: '
        '$XDG_STATE_HOME/ballscrew_monitor/<name of the node>; empty: nothing is kept.',
    ),
    ParameterRow(
        name='diagnostics_period',
        default=1.0,
        unit='s',
        low=0.1,
        high=60.0,
        change=Change.NEVER,
        text='Period of /diagnostics; a change is published at once.',
    ),
    *RECORD_ROWS,
)


def _input_rows(
    name: str,
    *,
    topic: str,
    type_name: str,
    field: str,
    units: Mapping[str, float],
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
        units=ROTARY_SPEED_UNITS | LINEAR_SPEED_UNITS,
        timeout=0.5,
        what='speed: of the screw in a rotary unit, of the nut in a linear',
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
        what='motor torque at the screw, only compared with the model; empty: none',
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
        text='Part of the preload below which efficiency is not judged.',
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
        text='Part by which RCS and loss must be below their limits to clear the warning.',
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
        text='Period of the state topic, besides each change of the level; '
        '0: a state for every judged speed sample.',
    ),
    ParameterRow(
        name='plain_topics',
        default=False,
        text='Publish efficiency, RCS, film ratio, regime and warning as topics of std_msgs too.',
    ),
)
