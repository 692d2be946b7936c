# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Keys and units of records come from their declarations alone."""

from collections.abc import Sequence
import dataclasses
import enum
import json
import math
from typing import NamedTuple

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.recordings.declared import keys, plain, record_of, unwritten, written
import pytest


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Part:
    count: int = 2


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Whole:
    load: float = written('N')
    start: int = written('ns', key='start_stamp', default=5)
    speed: float = written('rad_s', because='silence', default=math.nan)
    hidden: str = unwritten(default='none')
    parts: tuple[Part, ...] = (Part(),)
    by_input: dict[Source, Part] = dataclasses.field(
        default_factory=lambda: {Source.LOAD: Part(count=3)}
    )
    doubled: float = written(form=lambda value: 2.0 * value, default=1.5)

    @property
    def silence(self):
        return 'no valid sample'


def test_a_record_is_written_as_it_is_declared_with_its_keys():
    record = plain(Whole(load=-1.5))
    assert math.isnan(record.pop('speed_rad_s'))
    assert record == {
        'load_N': -1.5,
        'start_stamp_ns': 5,
        'speed_rad_s_reason': 'no valid sample',
        'parts': [{'count': 2}],
        'by_input': {'load': {'count': 3}},
        'doubled': 3.0,
    }
    assert 'speed_rad_s_reason' not in plain(Whole(load=0.0, speed=0.0))
    assert plain(Whole(load=0.0, speed=None))['speed_rad_s_reason'] == 'no valid sample'
    written_keys = 'load_N start_stamp_ns speed_rad_s parts by_input doubled'
    assert list(keys(Whole)) == written_keys.split()


class Colour(enum.Enum):
    RED = 'r'


class Place(NamedTuple):
    colour: Colour
    band: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Tree:
    depth: float
    places: tuple[Place, ...]
    parts: Sequence[Part]
    best: Part | None
    none: Part | None = None
    text: str = 'default'


def test_a_record_comes_back_out_of_json():
    tree = Tree(depth=1.5, places=(Place(Colour.RED, 3),), parts=[Part(), Part()], best=Part())
    content = json.dumps(dataclasses.asdict(tree), default=lambda colour: colour.value)
    assert record_of(Tree, json.loads(content)) == tree
    content = {'depth': None, 'places': [['r', 3]], 'parts': [{}], 'best': None}
    back = record_of(Tree, content)
    assert math.isnan(back.depth)
    assert (back.places, back.parts, back.best) == (tree.places, [Part()], None)


@pytest.mark.parametrize('content', [{'tall': 1}, {'depth': 1.0}])
def test_what_is_no_such_record_is_refused(content):
    with pytest.raises((KeyError, TypeError)):
        record_of(Tree, content)
