# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Products of the parameter table: defaults, checks, files of parameters, and names of topics.

The rows of `AXIS_ROWS` hold for every axis, under its name; `{axis}` in a default is that name.

"""

from collections.abc import Iterator, Mapping
import contextlib
import pathlib
import re
from typing import Any

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.settings.parameter_row import BARE_LETTERS, BARE_WORDS, ParameterRow
from ballscrew_monitor.settings.parameter_table import AXIS_ROWS, LOAD_SOURCES, NODE_ROWS
from surrogate.files import InputError, limits

NODE_NAME = 'ballscrew_monitor'
REFUSALS = 'solve_rejected'
"""Child of the node's logger that says why a solve is rejected."""
MOTOR_TORQUE = LOAD_SOURCES[1]
OPTIONAL = (Source.TEMPERATURE, Source.TORQUE)
# Parameters, or first parts of their names, that any node may be given; they are not of the table.
ROS_NAMES = frozenset({'qos_overrides', 'start_type_description_service', 'use_sim_time'})
_AXIS_NAME = re.compile(r'[a-z][a-z0-9_]*')


def check_axes(axes: list[str]) -> None:
    """Raise InputError unless `axes` are usable and distinct names."""
    if not axes:
        raise InputError("parameter axes is empty, it must name at least one axis, such as ['x']")
    for axis in axes:
        if not _AXIS_NAME.fullmatch(axis):
            raise InputError(
                f'parameter axes holds {axis!r}, a name must be lower case letters, '
                'digits and underscores, beginning with a letter'
            )
    if len(set(axes)) != len(axes):
        raise InputError(f'parameter axes names an axis twice: {", ".join(axes)}')


def table(axes: list[str]) -> dict[str, ParameterRow]:
    """Return the row of every parameter of a node with `axes`, by full name, in order."""
    check_axes(axes)
    rows = {row.name: row for row in NODE_ROWS}
    for axis in axes:
        for row in AXIS_ROWS:
            rows[f'{axis}.{row.name}'] = row
    return rows


def default_of(name: str, row: ParameterRow) -> Any:
    """Return the default of the parameter `name`."""
    if isinstance(row.default, str):
        return row.default.replace('{axis}', name.partition('.')[0])
    return row.default


def defaults(axes: list[str]) -> dict[str, Any]:
    """Return every parameter of a node with `axes` and its default."""
    return {name: default_of(name, row) for name, row in table(axes).items()} | {'axes': axes}


def is_of_ros(name: str) -> bool:
    """Return True if a parameter is one of any ROS node, and not of this one."""
    return name.partition('.')[0] in ROS_NAMES


def check(rows: Mapping[str, ParameterRow], values: Mapping[str, Any]) -> None:
    """Raise InputError for the first parameter that is unknown or has a bad value."""
    for name, value in values.items():
        if name not in rows:
            raise InputError(f'parameter {name} is unknown')
        rows[name].check(name, value)


def read_file(path: str | pathlib.Path) -> dict[str, Any]:
    """
    Return every parameter of a node started with the ROS parameter file at `path`.

    The node is in the root namespace. Raises InputError when the file cannot be read or holds a
    parameter that is unknown or bad.

    """
    return read_text(_text_of(path), str(path))


def read_text(text: str, origin: str) -> dict[str, Any]:
    """Return what `read_file` does, of the text of such a file; `origin` names it in errors."""
    with _named(origin):
        given = _given(text)
        axes = given.get('axes', NODE_ROWS[0].default)
        NODE_ROWS[0].check('axes', axes)
        rows = table(axes)
        check(rows, given)
        given = {name: rows[name].read(value) for name, value in given.items()}
    return defaults(axes) | given


def names_in_file(path: str | pathlib.Path) -> frozenset[str]:
    """Return the names of the parameters to which the file at `path` gives a value."""
    return names_in_text(_text_of(path), str(path))


def names_in_text(text: str, origin: str) -> frozenset[str]:
    """Return what `names_in_file` does, of the text of such a file, which `origin` names."""
    with _named(origin):
        return frozenset(_given(text))


def read_ros_parameters(path: str | pathlib.Path) -> dict[str, Any]:
    """
    Return what the file at `path` says of the parameters of any ROS node, such as `use_sim_time`.

    Raises InputError when the file cannot be read, or says nothing to the node at all.

    """
    text = _text_of(path)
    with _named(path):
        return _given(text, of_ros=True)


def sections(path: str | pathlib.Path) -> dict[str, Any]:
    """Return what the file at `path` says by nodes; raises InputError if it cannot be read."""
    return _sections(_text_of(path))


def explain(error: Exception) -> str:
    """Return an error of the start as one sentence; ROS does not say what to write instead."""
    sentence = ' '.join(str(error).split())
    mixed = "Value type 'bool' do not belong" in sentence
    return f'{sentence}, {BARE_WORDS}' if mixed else sentence


@contextlib.contextmanager
def _named(origin: object) -> Iterator[None]:
    """Let an error begin with the name of what is read."""
    try:
        yield
    except InputError as error:
        raise InputError(f'{origin}: {error}') from None


def _given(text: str, *, of_ros: bool = False) -> dict[str, Any]:
    """Return what a text says to the node: parameters of the table, or those of any ROS node."""
    given: dict[str, Any] = {}
    for key, section in _sections(text).items():
        if key.lstrip('/') in ('**', NODE_NAME, f'**/{NODE_NAME}'):
            values = section.get('ros__parameters')
            if not isinstance(values, dict):
                raise InputError(
                    f'{key} holds no parameters, they must stand below ros__parameters'
                )
            given |= flatten(values)
    if not given:
        raise InputError(f'it says nothing to the node, begin it with /**/{NODE_NAME}:')
    return {name: value for name, value in given.items() if is_of_ros(name) is of_ros}


def _text_of(path: str | pathlib.Path) -> str:
    try:
        return limits.read_text(path)
    except (OSError, UnicodeDecodeError, InputError) as error:
        raise InputError(f'{path}: the parameter file cannot be read: {error}') from None


def _sections(text: str) -> dict[str, Any]:
    from surrogate.files.plain_yaml import plain_values  # the node is handed its parameters by ROS

    try:
        nodes = plain_values(text, change=_take_letters_as_ros)
    except InputError as error:
        raise InputError(f'the parameter file cannot be read: {error}') from None
    if not isinstance(nodes, dict) or not all(
        isinstance(key, str) and isinstance(section, dict) for key, section in nodes.items()
    ):
        raise InputError('no ROS parameter file, it must be node names with ros__parameters below')
    return nodes


def _take_letters_as_ros(root: Any) -> None:
    """Make a value that is a bare letter true or false, as ROS reads it; a key stays a text."""
    waiting, seen = [root], set()
    while waiting:
        part = waiting.pop()
        if id(part) in seen:  # an alias
            continue
        seen.add(id(part))
        if part.id == 'mapping':
            waiting += [value for _, value in part.value]
        elif part.id == 'sequence':
            waiting += part.value
        elif not part.style and part.value in BARE_LETTERS:
            part.tag = 'tag:yaml.org,2002:bool'
            part.value = str(BARE_LETTERS[part.value])


def flatten(section: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """Return the values in sections within sections by their full names."""
    flat: dict[str, Any] = {}
    for key, value in section.items():
        if isinstance(value, dict):
            flat |= flatten(value, f'{prefix}{key}.')
        else:
            flat[f'{prefix}{key}'] = value
    return flat


def is_configured(name: str, values: Mapping[str, Any], source: Source) -> bool:
    """Return True if the axis `name` has an input; some may be left out, or be derived."""
    if source is Source.LOAD and values[f'{name}.load.source'] == MOTOR_TORQUE:
        return False
    return source not in OPTIONAL or bool(values[f'{name}.{source.name.lower()}.topic'])


def absolute(topic: str) -> str:
    """Return the full name of a topic that a node in the root namespace names."""
    return topic if topic.startswith('/') else f'/{topic}'


def input_topics(values: Mapping[str, Any]) -> dict[str, str]:
    """Return topic and type of every input configured in the parameters `values`."""
    types = {}
    for axis in values['axes']:
        for source in reversed(Source):
            prefix = f'{axis}.{source.name.lower()}'
            topic = values[f'{prefix}.topic']
            if topic and is_configured(axis, values, source):
                types[absolute(topic)] = values[f'{prefix}.type']
    return types


def with_types(values: Mapping[str, Any], types: Mapping[str, str]) -> dict[str, Any]:
    """Return the parameters with each empty message type filled in from `types` by topic."""
    filled = dict(values)
    for name, topic in values.items():
        prefix, _, leaf = name.rpartition('.')
        if leaf == 'topic' and topic and not values[f'{prefix}.type']:
            filled[f'{prefix}.type'] = types.get(absolute(topic), '')
    return filled


def output(axis: str, name: str) -> str:
    """Return the full name of an output of the node, such as `state`."""
    return absolute(f'{NODE_NAME}/{axis}/{name}')
