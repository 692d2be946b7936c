# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The interfaces: every field is explained, zero is UNKNOWN, and version 1 is what it was."""

import importlib
import json
from pathlib import Path
import re

from ballscrew_msgs.msg import BallScrewState, OperatingPoint, PointResult, SurfaceInfo
from geometry_msgs.msg import Point, Quaternion
import pytest
from rclpy.serialization import deserialize_message, serialize_message

TREE = Path(__file__).resolve().parent.parent
SOURCES = sorted(TREE.glob('msg_defs/*/*.*'))
RECORD = json.loads((TREE / 'test' / 'data' / 'type_hashes.json').read_text())
CONSTANT = re.compile(r'(?P<type>\w+) (?P<name>[A-Z][A-Z0-9_]*) *= *(?P<value>\S+)')
UNIT = re.compile(r'\[[^\]]+\]|`unit`')
# Kinds of things, told apart by a number; the first word names the kind.
ENUMERATIONS = {
    *'CODE CONTACT DIRECTION GATE LEVEL NUT REGIME SEVERITY SIDE SOURCE STAMP STATE'.split(),
    *'TIER VALIDITY ZONE CAUSE CONDITION ENDING'.split(),
}


def unexplained_fields(text):
    """Yield line and name of a field that lacks a comment; one holds up to the next empty line."""
    comment = ''
    for number, line in enumerate(map(str.strip, text.splitlines()), 1):
        if line in ('', '---'):
            comment = ''
        elif line.startswith('#'):
            comment += line
        elif not CONSTANT.match(line):
            declaration, _, beside = line.partition('#')
            kind, name = declaration.split()
            if not comment + beside:
                yield number, f'{name} has no comment'
            elif kind.startswith('float') and not UNIT.search(comment + beside):
                yield number, f'{name} has no [unit]'


def constants():
    """Return all numeric constants of all interfaces."""
    found = (CONSTANT.match(line) for path in SOURCES for line in path.read_text().splitlines())
    return {match['name']: int(match['value']) for match in found if match}


def type_of(source):
    module = importlib.import_module(f'ballscrew_msgs.{source.parent.name}')
    return getattr(module, source.stem)


def test_every_field_is_explained():
    offenders = [
        f'{source.name}:{line}: {why}'
        for source in SOURCES
        for line, why in unexplained_fields(source.read_text())
    ]
    assert not offenders, '\n'.join(offenders)


@pytest.mark.parametrize(
    ('text', 'lines'),
    [
        ('uint8 A=1\nuint8 kind', [2]),
        ('# Of both.\nuint8 kind\nuint8 other\n\nuint8 last', [5]),
        ('uint8 a  # text\n---\nuint8 b', [3]),
        ('float64 speed  # of the nut', [1]),
        ('# [rad/s]\nfloat64[] speeds\nfloat64 value  # in `unit`', []),
    ],
)
def test_a_field_without_comment_or_unit_is_named(text, lines):
    assert [line for line, _ in unexplained_fields(text)] == lines


def test_zero_is_unknown_in_every_enumeration():
    numbers = constants()
    kinds = {name.split('_')[0] for name in numbers if not name.startswith('MAX_')}
    assert kinds == ENUMERATIONS
    expected = {name for name, value in numbers.items() if value == 0}
    assert {f'{kind}_UNKNOWN' for kind in kinds} == expected


def test_values_of_an_enumeration_are_consecutive():
    numbers = constants()
    values = {
        kind: [value for name, value in numbers.items() if name.startswith(f'{kind}_')]
        for kind in ENUMERATIONS
    }
    assert values == {kind: list(range(len(found))) for kind, found in values.items()}


def test_all_interfaces_are_generated():
    named = re.findall(r'"(\w+/\w+\.\w+)"', (TREE / 'msg_defs' / 'CMakeLists.txt').read_text())
    assert named == [str(path.relative_to(TREE / 'msg_defs')) for path in SOURCES]
    expected = [f'ballscrew_msgs/{path.parent.name}/{path.stem}' for path in SOURCES]
    assert list(RECORD['hashes']) == expected


def test_type_hashes_are_the_recorded_ones():
    """
    Two sides with different hashes do not understand each other.

    Fields are only appended; the recorded hash is then renewed in the same change.

    """
    kinds = [f'ballscrew_msgs/{source.parent.name}/{source.stem}' for source in SOURCES]
    assert {kind: type_hash(kind) for kind in kinds} == RECORD['hashes']


def type_hash(kind):
    """Return the RIHS01 hash that the build wrote beside the type."""
    package, folder, name = kind.split('/')
    share = Path(importlib.import_module(package).__file__ or '')
    for prefix in share.parents:
        path = prefix / 'share' / package / folder / f'{name}.json'
        if path.exists():
            hashes = json.loads(path.read_text())['type_hashes']
            return next(str(part['hash_string']) for part in hashes if part['type_name'] == kind)
    raise FileNotFoundError(f'{name}.json of {package}')


@pytest.mark.parametrize(
    'message',
    [BallScrewState(), OperatingPoint(), PointResult(), SurfaceInfo()],
    ids=lambda message: type(message).__name__,
)
def test_message_survives_the_wire(message):
    assert deserialize_message(serialize_message(message), type(message)) == message


def test_an_appended_field_is_no_compatibility_on_the_wire():
    """As the reference says; a quaternion is a point with a field more at its end."""
    newer, older = Quaternion(x=1.0, y=2.0, z=3.0, w=4.0), Point(x=1.0, y=2.0, z=3.0)
    assert deserialize_message(serialize_message(newer), Point) == older
    with pytest.raises(RuntimeError, match='failed to deserialize'):
        deserialize_message(serialize_message(older), Quaternion)


@pytest.mark.parametrize('value', [1, True, '1'], ids=repr)
def test_float_field_refuses_what_is_no_float(value, refused):
    """With ROS_PYTHON_CHECK_FIELDS=1; without it an int is silently sent as 5e-324."""
    refused('speed_field_type', OperatingPoint, speed=value)
