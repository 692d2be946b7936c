# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Held-out points that are missed get nodes along the axis that is to blame, and no others."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.full import build as full_build
from surrogate.builder.full.build import build_full
from surrogate.builder.full.finer import nodes_for_misses, Room, with_nodes
from surrogate.builder.full.held_out import HeldOut, judged
from surrogate.builder.full.loads import LoadPieces
from surrogate.builder.full.run import Once
from surrogate.builder.full.settings import default_full_settings, error_target, FullSettings
from surrogate.builder.full.speed_nodes import NodeSample
from surrogate.surface import FIELDS, SolvedPoint, Surface

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
    found, there = (one.lookup(*point) for one in (surface, Surface(whole)))
    mean = SolvedPoint(converged=True, **{name: getattr(there, name) for name in FIELDS})
    axes = (data.speed_coordinate, data.load, data.temperature)
    cell = tuple(int(np.searchsorted(axis, at)) - 1 for axis, at in zip(axes, place))
    samples = (NodeSample(one.friction_torque, one.rcs) for one in (found, mean))
    lead = data.header['inputs']['screw']['lead']
    return HeldOut(point, s, cell, found, mean, judged(target, load, lead).worst(*samples))


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


def test_a_masked_node_hides_no_axis(surface_data, target):
    """Of two nodes that are left out in turn one leads to a masked cell: the other one tells."""
    data = coarse(surface_data, 'speed', 6)
    lead = data.header['inputs']['screw']['lead']
    one = max(
        (
            held_out(data, surface_data, target, (float(s), 610.0, 313.0))
            for s in np.linspace(-0.9, 0.9, 19)
        ),
        key=lambda one: one.miss,
    )
    asked = nodes_for_misses(data, [one], target, lead, PLENTY)[0].tolist()
    for beside in (one.cell[0] - 1, one.cell[0] + 2):
        mask = data.mask.copy()
        mask[beside] = True
        masked = replace(data, mask=mask)
        assert nodes_for_misses(masked, [one], target, lead, PLENTY)[0].tolist() == asked


@pytest.mark.parametrize('jumps', [True, False])
def test_the_jump_at_the_idle_load_is_never_halved(surface_data, target, jumps):
    """Between two breaks of one sign there is nothing to interpolate."""
    lead = surface_data.header['inputs']['screw']['lead']
    ends = surface_data.load[-3:-1]
    everything = np.arange(len(surface_data.speed_coordinate))
    header = {**surface_data.header, 'load_breaks': ends.tolist() if jumps else []}
    data = with_nodes(replace(surface_data, header=header), everything, np.array([-3, -2]))
    one = held_out(data, data, target, (0.0, float(ends.mean()), 313.0))
    missed = replace(one, miss=1e3)
    loads = nodes_for_misses(data, [missed], target, lead, PLENTY)[1]
    assert loads.tolist() == ([] if jumps else [ends.mean()])


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
    twins = once('first', {'a': {'x': 1.0}, 'twin': {'x': 1.0}, 'c': {'x': 3.0}})
    assert twins == {'a': {'of': 'twin'}, 'twin': {'of': 'twin'}, 'c': None}
    found = once('second', {'b': {'x': 1.0}, 'c': {'x': 3.0}, 'd': {'x': 2.0}})
    assert found == {'b': {'of': 'twin'}, 'c': None, 'd': {'of': 'd'}}
    assert once('third', {'e': {'x': 2.0}}) == {'e': {'of': 'd'}}
    assert asked == [('first', ['twin', 'c']), ('second', ['d'])]


SETTINGS = FullSettings(
    speed_range=(0.5, 100.0),
    load_range=(-2000.0, 1000.0),
    temperature_range=(293.15, 333.15),
    temperature_nodes=3,
    draws=2,
    held_out=12,
    load_cells=1,
    accuracy=0.25,
)


def nothing(*of_anything):
    """Ask for no node."""
    return np.empty(0), np.empty(0)


@pytest.fixture(scope='module', name='builds')
def build_twice(screw, oil, stand_in):
    """Return surfaces with and without nodes for misses, with what was solved."""
    found = []
    for more in (nodes_for_misses, nothing):
        asked = []

        def run(purpose, chains, asked=asked):
            asked.extend((purpose, chain) for chain in chains.values())
            return stand_in.run(purpose, chains)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(full_build, 'nodes_for_misses', more)
            found.append((build_full(screw, oil, SETTINGS, run), asked))
    return found


def test_held_out_points_that_are_missed_bring_nodes(builds, stand_in):
    """The surface is nearer to solves, at those points and at others."""
    (more, _), (less, _) = builds
    assert more.header['reached'] < less.header['reached']
    wrong = []
    for data in (more, less):
        surface, drawn, errors = Surface(data), np.random.default_rng(3), []
        for _ in range(200):
            speed = math.exp(drawn.uniform(*np.log(SETTINGS.speed_range)))
            load, heat = drawn.uniform(0, 1000), 313.15
            chain = {'load': load, 'temperature': heat, 'speeds': [speed], **data.header['inputs']}
            solved = [stand_in.solve({**chain, 'draw': draw})['opposing'][0] for draw in range(2)]
            torque = np.mean([record['friction_torque'] for record in solved])
            errors.append(abs(surface.lookup(speed, load, heat).friction_torque / torque - 1))
        wrong.append(np.mean(errors))
    assert wrong[0] < wrong[1]


def test_the_new_nodes_alone_are_solved(builds):
    """More nodes are new speeds or new loads; nothing is solved twice."""
    (more, asked), (less, _) = builds
    new = {
        axis: np.setdiff1d(getattr(more, axis), getattr(less, axis)).tolist()
        for axis in ('speed_coordinate', 'load')
    }
    assert new['speed_coordinate'] or new['load']
    solved = {
        purpose: [
            (chain['load'], chain['temperature'], chain['draw'], speed)
            for of, chain in asked
            if of == purpose
            for speed in chain['speeds']
        ]
        for purpose in ('nodes', 'more nodes', 'held-out points')
    }
    assert all(len(points) == len(set(points)) for points in solved.values())
    assert not set(solved['nodes']) & set(solved['more nodes'])
    surface = Surface(more)
    for load, heat, _, speed in solved['more nodes']:
        s = math.log(speed / surface.onset_speed(-load, heat))
        assert load in np.abs(new['load']) or np.isclose(s, new['speed_coordinate']).any()


def test_a_round_that_loses_a_point_is_not_taken(screw, oil, stand_in, builds):
    """New loads of which no solve converges: the surface is the one before."""

    def run(purpose, chains):
        failed = purpose == 'more nodes'
        return dict.fromkeys(chains) if failed else stand_in.run(purpose, chains)

    data = build_full(screw, oil, SETTINGS, run)
    assert data.sha256 == builds[1][0].sha256


def test_more_nodes_do_not_depend_on_the_order_of_work(screw, oil, stand_in, builds):
    """Nor does their surface."""

    def backwards(purpose, chains):
        return dict(reversed(stand_in.run(purpose, dict(reversed(chains.items()))).items()))

    assert build_full(screw, oil, SETTINGS, backwards).sha256 == builds[0][0].sha256
