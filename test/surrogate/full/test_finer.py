# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Held-out points that are missed get nodes along the axis that is to blame, and no others."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.full.build import build_full
from surrogate.full.finer import nodes_for_misses, Room, with_nodes
from surrogate.full.held_out import HeldOut, judged
from surrogate.full.loads import LoadPieces
from surrogate.full.run import Once
from surrogate.full.settings import default_full_settings, error_target, FullSettings
from surrogate.full.speed_nodes import Sample
from surrogate.surface import FIELDS, Surface

PLENTY = Room(9, 9)


@pytest.fixture(scope='module', name='target')
def make_target(screw):
    """Return the aim of the defaults."""
    return error_target(screw, default_full_settings(screw))


def held_out(data, whole, target, place):
    """Return a point given as coordinates s, load, temperature: `data` against `whole`."""
    s, load, heat = place
    surface = Surface(data)
    point = (math.exp(s) * surface.onset_speed(load, heat), load, heat)
    found, mean = (
        {name: getattr(one.lookup(*point), name) for name in FIELDS}
        for one in (surface, Surface(whole))
    )
    axes = (data.speed_coordinate, data.load, data.temperature)
    cell = tuple(int(np.searchsorted(axis, at)) - 1 for axis, at in zip(axes, place))
    samples = (Sample(one['friction_torque'], one['rcs']) for one in (found, mean))
    lead = data.header['inputs']['screw']['lead']
    return HeldOut(point, cell, found, mean, judged(target, load, lead).worst(*samples))


def coarse(data, axis, step):
    """Return a surface with every `step`-th node of an axis, ends and breaks kept."""
    sizes = {'speed': len(data.speed_coordinate), 'load': len(data.load)}
    kept = {name: np.arange(size) for name, size in sizes.items()}
    fixed = np.flatnonzero(np.isin(data.load, data.header['load_breaks']))
    ends = [0, sizes[axis] - 1, *(fixed if axis == 'load' else ())]
    kept[axis] = np.union1d(kept[axis][::step], ends)
    return with_nodes(data, kept['speed'], kept['load'])


@pytest.mark.parametrize(('axis', 'step'), [('speed', 6), ('load', 8)])
def test_the_axis_with_too_few_nodes_is_to_blame(surface_data, target, axis, step):
    """A surface of formulas that lacks nodes of one axis: the middle of that cell is asked for."""
    data = coarse(surface_data, axis, step)
    nodes = data.speed_coordinate if axis == 'speed' else data.load
    worst = max(
        (
            held_out(data, surface_data, target, place)
            for s in np.linspace(-0.9, 0.9, 19)
            for load in (130.0, 610.0, 1510.0)
            for place in [(float(s), load, 313.0)]
        ),
        key=lambda one: one.miss,
    )
    assert worst.miss > 1
    lead = data.header['inputs']['screw']['lead']
    speeds, loads = nodes_for_misses(data, [worst], target, lead, PLENTY)
    place = worst.cell[0 if axis == 'speed' else 1]
    middle = 0.5 * (nodes[place] + nodes[place + 1])
    asked, other = (speeds, loads) if axis == 'speed' else (loads, speeds)
    assert asked == pytest.approx([abs(middle) if axis == 'load' else middle])
    assert other.size == 0


def test_what_is_met_and_what_no_node_would_mend_asks_for_nothing(surface_data, target):
    """An offset everywhere is not the interpolation's; nor is there anything without room."""
    data = coarse(surface_data, 'speed', 6)
    lead = data.header['inputs']['screw']['lead']
    points = [
        held_out(data, surface_data, target, (float(s), 610.0, 313.0))
        for s in np.linspace(-0.9, 0.9, 19)
    ]
    missed = max(points, key=lambda one: one.miss)
    assert nodes_for_misses(data, [missed, missed], target, lead, PLENTY)[0].size == 1
    for useless, room in (
        (replace(missed, miss=1.0), PLENTY),
        (replace(missed, miss=1e3), PLENTY),
        (missed, Room(0, 9)),
    ):
        speeds, loads = nodes_for_misses(data, [useless], target, lead, room)
        assert speeds.size == loads.size == 0


def test_a_cell_between_breaks_is_to_blame_where_nothing_else_is(surface_data, target):
    """No node beside it can be left out: that of zero load and the end of the range stay."""
    data = coarse(surface_data, 'load', 100)
    lead = data.header['inputs']['screw']['lead']
    missed = replace(held_out(data, surface_data, target, (0.0, 1000.0, 313.0)), miss=1e3)
    speeds, loads = nodes_for_misses(data, [missed], target, lead, PLENTY)
    low, high = data.load[[missed.cell[1], missed.cell[1] + 1]]
    assert {low, high} <= {*data.header['load_breaks'], data.load[-1]}
    assert loads.tolist() == [0.5 * (low + high)]
    assert speeds.size == 0


def test_more_loads_lie_in_their_pieces():
    """Below and above the idle load; a range above it has one piece."""
    pieces = LoadPieces(np.array([0.0, 10.0]), np.array([11.0, 20.0])).with_more(np.array([5, 15]))
    assert pieces.shared.tolist() == [0, 5, 10]
    assert pieces.alone.tolist() == [11, 15, 20]
    above = LoadPieces(np.empty(0), np.array([11.0, 20.0])).with_more(np.array([15]))
    assert above.alone.tolist() == [11, 15, 20]


def test_no_chain_is_solved_twice():
    """Nor one that failed, by whatever name it is asked for."""
    asked = []

    def run(purpose, chains):
        asked.append((purpose, list(chains)))
        return {name: {'of': name} if name != 'c' else None for name in chains}

    once = Once(run)
    assert once('first', {'a': {'x': 1.0}, 'c': {'x': 3.0}}) == {'a': {'of': 'a'}, 'c': None}
    found = once('second', {'b': {'x': 1.0}, 'c': {'x': 3.0}, 'd': {'x': 2.0}})
    assert found == {'b': {'of': 'a'}, 'c': None, 'd': {'of': 'd'}}
    assert once('third', {'e': {'x': 2.0}}) == {'e': {'of': 'd'}}
    assert asked == [('first', ['a', 'c']), ('second', ['d'])]


@pytest.fixture(scope='module', name='builds')
def build_twice(screw, oil, stand_in):
    """Return surfaces that have and do not have room for more loads, with what was solved."""
    settings = FullSettings(
        speed_range=(0.5, 100.0),
        load_range=(-2000.0, 2000.0),
        temperature_range=(293.15, 333.15),
        temperature_nodes=3,
        draws=2,
        held_out=12,
        accuracy=0.25,
    )
    found = []
    for most in (13, 2):
        asked = []

        def run(purpose, chains, asked=asked):
            asked.extend((purpose, chain) for chain in chains.values())
            return stand_in.run(purpose, chains)

        limited = replace(settings, load_nodes=most, load_cells=1)
        found.append((build_full(screw, oil, limited, run), asked))
    return found


def test_held_out_points_that_are_missed_bring_nodes(builds, stand_in):
    """There are more loads then, and the surface is nearer to solves everywhere."""
    wrong = []
    for data, _ in builds:
        surface, drawn, errors = Surface(data), np.random.default_rng(3), []
        for _ in range(200):
            speed = math.exp(drawn.uniform(*np.log([0.5, 100.0])))
            load, heat = drawn.uniform(0, 2000), 313.15
            chain = {'load': load, 'temperature': heat, 'speeds': [speed], **data.header['inputs']}
            solved = [stand_in.solve({**chain, 'draw': draw})['opposing'][0] for draw in range(2)]
            torque = np.mean([record['friction_torque'] for record in solved])
            errors.append(abs(surface.lookup(speed, load, heat).friction_torque / torque - 1))
        wrong.append(np.mean(errors))
    assert wrong[0] < 0.7 * wrong[1]


def test_more_nodes_are_solved_alone(builds):
    """What is there is not solved again: no draw twice at a speed, load and temperature."""
    (data, asked), (limited, _) = builds
    assert 'more nodes' in {purpose for purpose, _ in asked}
    assert len(data.load) > len(limited.load) == 3
    solved = [
        (chain['load'], chain['temperature'], chain['draw'], speed)
        for purpose, chain in asked
        if purpose in ('nodes', 'more nodes')
        for speed in chain['speeds']
    ]
    assert len(solved) == len(set(solved))
    held = [chain for purpose, chain in asked if purpose == 'held-out points']
    assert len(held) == len({str(chain) for chain in held})
