# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The interfaces: every field is explained, zero is UNKNOWN, and version 1 is what it was."""

import importlib
import json
from pathlib import Path
import re

from ballscrew_msgs.msg import BallScrewState, OperatingPoint, PointResult, SurfaceInfo
import pytest
from rclpy.serialization import deserialize_message, serialize_message

TREE = Path(__file__).resolve().parent.parent
SOURCES = sorted(TREE.glob('msg_defs/*/*.*'))
RECORD = json.loads((TREE / 'test' / 'data' / 'type_hashes.json').read_text())
CONSTANT = re.compile(r'(?P<type>\w+) (?P<name>[A-Z][A-Z0-9_]*) *= *(?P<value>\S+)')
# Kinds of things, told apart by a number; the first word names the kind.
ENUMERATIONS = {
    *'CODE CONTACT DIRECTION GATE LEVEL NUT REGIME SEVERITY SIDE SOURCE STAMP STATE'.split(),
    *'TIER VALIDITY ZONE CAUSE CONDITION'.split(),
}


def fields(source):
    """Yield type, name and comment of each field; a comment holds up to the next empty line."""
    comment = ''
    for line in map(str.strip, source.read_text().splitlines()):
        if line in ('', '---'):
            comment = ''
        elif line.startswith('#'):
            comment += line
        elif not CONSTANT.match(line):
            declaration, _, beside = line.partition('#')
            kind, name = declaration.split()
            yield kind, name, comment + beside


def constants():
    """Return all numeric constants of all interfaces."""
    found = (CONSTANT.match(line) for path in SOURCES for line in path.read_text().splitlines())
    return {match['name']: int(match['value']) for match in found if match}


def type_of(source):
    module = importlib.import_module(f'ballscrew_msgs.{source.parent.name}')
    return getattr(module, source.stem)


@pytest.mark.parametrize('source', SOURCES, ids=lambda path: path.name)
def test_every_field_is_explained(source):
    for kind, name, comment in fields(source):
        assert comment, f'{name} has no comment'
        if kind.startswith('float'):
            assert re.search(r'\[[^\]]+\]|`unit`', comment), f'{name} has no [unit]'


def test_zero_is_unknown_in_every_enumeration():
    numbers = constants()
    kinds = {name.split('_')[0] for name in numbers if not name.startswith('MAX_')}
    assert kinds == ENUMERATIONS
    expected = {name for name, value in numbers.items() if value == 0}
    assert {f'{kind}_UNKNOWN' for kind in kinds} == expected


@pytest.mark.parametrize('kind', sorted(ENUMERATIONS))
def test_values_of_an_enumeration_are_consecutive(kind):
    values = [value for name, value in constants().items() if name.startswith(f'{kind}_')]
    assert values == list(range(len(values)))


def test_all_interfaces_are_generated():
    named = re.findall(r'"(\w+/\w+\.\w+)"', (TREE / 'msg_defs' / 'CMakeLists.txt').read_text())
    assert named == [str(path.relative_to(TREE / 'msg_defs')) for path in SOURCES]
    expected = [f'ballscrew_msgs/{path.parent.name}/{path.stem}' for path in SOURCES]
    assert list(RECORD['hashes']) == expected


@pytest.mark.parametrize('source', SOURCES, ids=lambda path: path.name)
def test_type_hash_is_the_recorded_one(source):
    """
    Two sides with different hashes do not understand each other.

    Fields are only appended; the recorded hash is then renewed in the same change.

    """
    kind = f'ballscrew_msgs/{source.parent.name}/{source.stem}'
    assert type_hash(kind) == RECORD['hashes'][kind]


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


@pytest.mark.parametrize('value', [1, True, '1'], ids=repr)
def test_float_field_refuses_what_is_no_float(value, refused):
    """With ROS_PYTHON_CHECK_FIELDS=1; without it an int is silently sent as 5e-324."""
    refused('speed_field_type', OperatingPoint, speed=value)
