# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Construction of an axis from parameter values: its surface, its inputs and its monitor."""

from collections.abc import Callable, Iterable, Mapping
import contextlib
import dataclasses
from pathlib import Path
from typing import Any
import weakref

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import nanoseconds, POSITION_UNITS, Scaling
from ballscrew_monitor.core.fields import check_path
from ballscrew_monitor.core.inputs import Input, OpenInput, Source
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import LoadDerivation, MonitorSettings
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.settings.parameters import is_configured, MOTOR_TORQUE
from surrogate.files import InputError
from surrogate.surface import find_surface, Surface, SurfaceError

PLAUSIBLE = 3.0  # times the largest of the surface: what lies beyond is a glitch
_LOADED: weakref.WeakValueDictionary[str, Surface] = weakref.WeakValueDictionary()
"""Surfaces in use by their hash: their tables take megabytes."""
UNITS = {
    Source.SPEED: tuple(conversions.SPEED_UNITS),
    Source.LOAD: tuple(conversions.LOAD_UNITS),
    Source.TEMPERATURE: tuple(conversions.TEMPERATURE_UNITS),
}


@dataclasses.dataclass(kw_only=True, slots=True)
class Axis:
    """One axis at work; `open_inputs` wait for the message type of their publisher."""

    name: str
    surface: Surface
    inputs: tuple[Input, ...]
    open_inputs: tuple[OpenInput, ...]
    monitor: Monitor

    @property
    def topics(self) -> dict[Source, str]:
        """Return the topic of each input as it is configured."""
        configured: list[Input | OpenInput] = [*self.inputs, *self.open_inputs]
        return {each.source: each.topic for each in configured}

    @property
    def max_future(self) -> int:
        """Return how far a stamp may be ahead of the clock [ns]."""
        return self.monitor.settings.max_future

    @property
    def one_source(self) -> bool:
        """Return True if an input that several publishers send is refused."""
        return self.monitor.settings.one_source

    def adapt(self, values: Mapping[str, Any]) -> None:
        """Take over the parameters that may change at any time."""
        self.monitor.settings = settings_of(self.name, values, self.surface)

    def use_surface(self, surface: Surface, values: Mapping[str, Any]) -> None:
        """Judge with another surface from now on."""
        self.surface = surface
        self.monitor.use_surface(surface)
        self.adapt(values)


def build_axis(name: str, values: Mapping[str, Any]) -> Axis:
    """Return the axis `name` made of parameter `values` by full name; raises InputError."""
    surface = load_surface(name, values)
    inputs: list[Input] = []  # in the order in which equal stamps are taken
    open_inputs: list[OpenInput] = []
    for source in Source:
        if not is_configured(name, values, source):
            continue
        prefix = f'{name}.{source.name.lower()}'
        topic, field, kind = (values[f'{prefix}.{leaf}'] for leaf in ('topic', 'field', 'type'))
        if not topic:
            raise InputError(f'parameter {prefix}.topic is empty, it must name a topic')
        scaling = scaling_of(name, values, source, surface.lead)
        try:
            opened = OpenInput(source=source, topic=topic, field=field, scaling=scaling)
            if kind:
                inputs.append(opened.close(kind))
            else:
                check_path(field)
                open_inputs.append(opened)
        except InputError as error:
            raise InputError(f'parameters {prefix}: {error}') from None
    return Axis(
        name=name,
        surface=surface,
        inputs=tuple(inputs),
        open_inputs=tuple(open_inputs),
        monitor=Monitor(surface, settings_of(name, values, surface)),
    )


def build_axes(
    values: Mapping[str, Any], resolve: Callable[[str], str]
) -> tuple[list[Axis], dict[str, str]]:
    """
    Return the axes that can be built of parameter `values`, and by name why others cannot.

    `resolve` returns the full name of a topic, and raises RuntimeError for what is no name.

    """
    built: list[Axis] = []
    reasons: dict[str, str] = {}
    for name in values['axes']:
        try:
            axis = build_axis(name, values)
            check_topics([*built, axis], resolve)
            built.append(axis)
        except InputError as error:
            reasons[name] = str(error)
    return built, reasons


def check_topics(axes: Iterable[Axis], resolve: Callable[[str], str]) -> None:
    """Raise InputError for a name that `resolve` refuses, and for a topic of two types."""
    types: dict[str, str] = {}
    for axis in axes:
        for source, topic in axis.topics.items():
            resolved_topic(axis.name, source, topic, resolve)
        for known in axis.inputs:
            name = resolve(known.topic)
            if types.setdefault(name, known.type_name) != known.type_name:
                raise InputError(
                    f'topic {name} is configured as {types[name]} and as {known.type_name}'
                )


def named_topics(values: Mapping[str, Any], resolve: Callable[[str], str]) -> set[str]:
    """Return the full names of all topics that parameters `values` name, as far as they are."""
    topics = set()
    for axis in values['axes']:
        for source in Source:
            if topic := values[f'{axis}.{source.name.lower()}.topic']:
                with contextlib.suppress(InputError):
                    topics.add(resolved_topic(axis, source, topic, resolve))
    return topics


def start_text(axis: Axis, node: str, resolve: Callable[[str], str], folder: Path | None) -> str:
    """
    Return what a configured axis reads, what judges it and where it speaks, in one sentence.

    `node` is the full name of its node, `folder` the state directory, None: none is kept;
    `resolve` returns the full name of a topic.

    """
    read = [
        f'{source.name.lower()} from {resolve(topic)}' for source, topic in axis.topics.items()
    ]
    surface = axis.surface
    return (
        f'axis {axis.name} reads {" and ".join(read)}, is judged by the {surface.tier} surface '
        f'{surface.sha256[:16]} of {surface.screw_name} with {surface.oil_name}, publishes on '
        f'{node}/{axis.name}, and is {f"kept in {folder}" if folder else "not kept: no state_dir"}'
    )


def resolved_topic(axis: str, source: Source, topic: str, resolve: Callable[[str], str]) -> str:
    """Return the full name of the topic of an input; raises InputError for what is no name."""
    try:
        return str(resolve(topic))
    except RuntimeError:
        raise InputError(
            f'parameter {axis}.{source.name.lower()}.topic is {topic!r}, no topic name'
        ) from None


def surface_file(name: str, values: Mapping[str, Any]) -> Path:
    """Return the surface file of the axis `name`; raises SurfaceError when none is shipped."""
    screw, oil = values[f'{name}.screw'], values[f'{name}.oil']
    return find_surface(values[f'{name}.surface'], screw, oil)


def load_surface(name: str, values: Mapping[str, Any]) -> Surface:
    """
    Return the verified surface of the axis `name`, one for all axes with the same content.

    Raises InputError with the reason.

    """
    screw, oil = values[f'{name}.screw'], values[f'{name}.oil']
    try:
        surface = Surface.load(surface_file(name, values), screw=screw, oil=oil)
    except SurfaceError as error:
        raise InputError(f'axis {name}: {error}') from None
    return _LOADED.setdefault(surface.sha256, surface)


def reload_surface(axis: Axis, values: Mapping[str, Any]) -> Surface:
    """Return the surface of `axis` as its file is now; raises InputError if it does not fit."""
    surface = load_surface(axis.name, values)
    if surface.lead != axis.surface.lead:  # the speeds are scaled with it
        raise InputError(
            f'axis {axis.name}: the new surface is of a lead of {surface.lead:g} m, '
            f'the old one of {axis.surface.lead:g} m'
        )
    return surface


def settings_of(name: str, values: Mapping[str, Any], surface: Surface) -> MonitorSettings:
    """Return the settings of the monitor; some limits are in parts of those of the surface."""
    prefix, unit, window, wrap = f'{name}.limits.', values[f'{name}.speed.unit'], 0, 0.0
    if unit in POSITION_UNITS:
        window = nanoseconds(values[f'{name}.speed.window'])
        wrap = values[f'{name}.speed.wrap'] * conversions.screw_turn(unit, lead=surface.lead)
    largest = {
        Source.SPEED: surface.speed_range[1],
        Source.LOAD: max(map(abs, surface.load_range)),
    }
    return MonitorSettings(
        axis=name,
        limits=Limits(
            rcs=values[prefix + 'rcs'],
            efficiency=values[prefix + 'efficiency'],
            light_load=values[prefix + 'light_load_fraction'] * surface.preload,
            standstill_speed=values[prefix + 'standstill_speed'],
            raise_delay=nanoseconds(values[prefix + 'raise_delay']),
            clear_delay=nanoseconds(values[prefix + 'clear_delay']),
            hysteresis=values[prefix + 'hysteresis'],
        ),
        timeouts={
            source: nanoseconds(values[f'{name}.{source.name.lower()}.timeout'])
            for source in Source
            if is_configured(name, values, source)
        },
        default_temperature=conversions.kelvin(values[f'{name}.temperature.default']),
        publish_period=nanoseconds(values[f'{name}.publish_period']),
        max_future=nanoseconds(values[f'{name}.max_future']),
        max_lag=nanoseconds(values[f'{name}.max_lag']),
        one_source=values[f'{name}.one_source'],
        speed_allowed=values[f'{name}.advice.speed'],
        tick_period=nanoseconds(values['tick_period']),
        plausible={
            source: values[f'{prefix}plausible_{source.name.lower()}'] or PLAUSIBLE * most
            for source, most in largest.items()
        },
        fields={source: values[f'{name}.{source.name.lower()}.field'] for source in Source},
        derivation=derivation_of(name, values),
        position_window=window,
        wrap=wrap,
    )


def gathering_of(name: str, values: Mapping[str, Any]) -> GatherSettings:
    """Return what the axis states of its motion without process force."""
    return GatherSettings(
        free_load=values[f'{name}.health.free_load'],
        always_free=values[f'{name}.health.always_free'],
    )


def derivation_of(name: str, values: Mapping[str, Any]) -> LoadDerivation | None:
    """
    Return how the load follows from the motor torque, None where it is an input.

    Raises InputError where the torque or its uncertainty is not stated.

    """
    if values[f'{name}.load.source'] != MOTOR_TORQUE:
        return None
    for leaf, what in (('topic', 'the topic of the torque'), ('uncertainty', 'how sure that is')):
        if not values[f'{name}.torque.{leaf}']:
            raise InputError(
                f'parameter {name}.torque.{leaf} is {values[f"{name}.torque.{leaf}"]!r}, not '
                f'stated, {name}.load.source {MOTOR_TORQUE} needs {what}'
            )
    uncertainty = values[f'{name}.torque.uncertainty']
    return LoadDerivation(
        inertia=values[f'{name}.inertia'],
        window=nanoseconds(values[f'{name}.acceleration_window']),
        torque_uncertainty=uncertainty * _torque_unit(name, values),
        parts_uncertainty=values[f'{name}.load.parts_uncertainty'],
        largest_share=values[f'{name}.load.largest_share'],
    )


def _torque_unit(name: str, values: Mapping[str, Any]) -> float:
    """Return the torque at the screw [N m] that one unit of the input is."""
    leaves = ('constant', 'rated', 'gear_ratio')
    motor = {leaf: values[f'{name}.torque.{leaf}'] for leaf in leaves}
    try:
        return conversions.torque_unit(values[f'{name}.torque.unit'], **motor)
    except InputError as error:
        raise InputError(f'parameters {name}.torque: {error}') from None


def scaling_of(name: str, values: Mapping[str, Any], source: Source, lead: float) -> Scaling:
    """
    Return the line to SI units of an input of the axis `name`; lead of the screw [m].

    Raises InputError for a torque in a unit whose constant is not stated.

    """
    prefix = f'{name}.{source.name.lower()}'
    unit, hand = values[f'{prefix}.unit'], values[f'{name}.handedness']
    line = {leaf: values[f'{prefix}.{leaf}'] for leaf in ('scale', 'offset')}
    if source is Source.SPEED:
        return conversions.speed_scaling(unit, **line, lead=lead, handedness=hand)
    if source is Source.LOAD:
        return conversions.load_scaling(unit, **line)
    if source is Source.TEMPERATURE:
        return conversions.temperature_scaling(unit, **line)
    return conversions.torque_scaling(_torque_unit(name, values), **line, handedness=hand)


def scalings_of(
    name: str, values: Mapping[str, Any], source: Source, lead: float
) -> dict[str, Scaling]:
    """
    Return the line to SI units of an input for every unit that it may have; lead [m].

    A torque has that of its own unit alone, for others may lack a constant; a position has none,
    only the speed that is worked out from it.

    """
    name_of_unit = f'{name}.{source.name.lower()}.unit'
    units = UNITS.get(source, (values[name_of_unit],))
    return {unit: scaling_of(name, {**values, name_of_unit: unit}, source, lead) for unit in units}
