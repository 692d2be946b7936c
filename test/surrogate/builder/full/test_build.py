# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of the full tier on a fast stand-in: nodes, errors, resumption, failures."""

from dataclasses import replace
import json
import math

import numpy as np
import pytest
from surrogate.builder.full import tier
from surrogate.builder.full.build import build_full
from surrogate.builder.full.chain import chain_inputs, solved_chain
from surrogate.builder.full.draws import draws_of, mean_of_draws
from surrogate.builder.full.settings import FullSettings
from surrogate.files import InputError
from surrogate.surface import FIELDS, Surface, Validity
from surrogate.surface import file as surface_file
from surrogate.surface_tools.describe import info_page, info_record

SETTINGS = FullSettings(
    speed_range=(0.5, 100.0),
    load_range=(-2000.0, 2000.0),
    temperature_range=(293.15, 333.15),
    temperature_nodes=3,
    draws=3,
    held_out=12,
    load_cells=2,
)


@pytest.fixture(scope='module', name='data')
def build(screw, oil, stand_in):
    """Build once."""
    return build_full(screw, oil, SETTINGS, stand_in.run)


@pytest.fixture(name='mean')
def make_mean(screw, oil, data, stand_in):
    """Return speed [rad/s], mean torque [N m] and mean RCS [-] over the draws at a point."""
    surface = Surface(data)

    def mean(s, load, heat):
        speed = surface.onset_speed(load, heat) * math.exp(s)
        sense = 'opposing' if load >= 0 else 'assisting'
        found = [
            stand_in.solve(chain_inputs(screw, oil, abs(load), heat, draw, [speed]))[sense][0]
            for draw in range(SETTINGS.draws)
        ]
        names = ('friction_torque', 'rcs')
        return speed, *(float(np.mean([record[name] for record in found])) for name in names)

    return mean


def test_file_of_the_full_tier_is_read_back(data, tmp_path):
    """Written, verified and looked up; tier, draws and spreads are in it."""
    surface_file.write(tmp_path / 'full.npz', data)
    surface = Surface.load(tmp_path / 'full.npz')
    assert surface.tier == 'full'
    assert surface.header['settings']['draws'] == 3
    point = surface.lookup(20.0, 500.0, 313.15)
    assert point.validity is Validity.VALID
    assert point.friction_torque_std > 0


def test_draws_from_eight_on_are_weighted(screw, oil, stand_in, monkeypatch):
    """Nodes and a check of the file take the same weights; at the last load of twice as many."""
    few = replace(SETTINGS, draws=8, held_out=3, load_range=(0.0, 2700.0))
    data = build_full(screw, oil, few, stand_in.run)
    ensemble = draws_of(screw, 8)
    assert tier.drawn(data.header) == ensemble
    header = json.loads(json.dumps(data.header))
    assert header == data.header
    without = {name: value for name, value in header.items() if name != 'weighted_draws'}
    monkeypatch.setattr(tier, 'solve_chain', stand_in.solve)
    i, k = int(np.argmin(np.abs(data.speed_coordinate))), 1
    heat = float(data.temperature[k])
    for j, draws in ((0, 8), (-1, 16)):
        load, speed = (
            float(data.load[j]),
            math.exp(data.speed_coordinate[i] + data.log_onset[j, k]),
        )
        chains = [
            solved_chain(stand_in.solve(chain_inputs(screw, oil, load, heat, draw, [speed])))
            for draw in range(draws)
        ]
        points = [chain.opposing[0] for chain in chains]
        mean = mean_of_draws(points, ensemble, load)
        plain = float(np.mean([point.rcs for point in points[:8]]))
        assert data.fields['rcs'][i, j, k] == pytest.approx(mean.rcs, rel=1e-9)
        assert mean.rcs != pytest.approx(plain, rel=1e-3)
        again = tier.solve_full(header, speed, load, heat)
        for name in FIELDS:
            assert getattr(again, name) == pytest.approx(getattr(mean, name), rel=1e-9)
        assert tier.solve_full(without, speed, load, heat).rcs == pytest.approx(plain, rel=1e-9)


def test_onset_is_near_rcs_of_one_percent(mean):
    """At s = 0 the mean of the draws is a few percent at most, and not nothing."""
    for load in (0.0, 900.0):
        for heat in (300.0, 325.0):
            _, _, rcs = mean(0.0, load, heat)
            assert 0.001 < rcs < 0.05


def test_every_point_of_the_range_has_an_answer(data):
    """Corners and random points, though columns leave out speeds that no lookup reads."""
    surface, drawn = Surface(data), np.random.default_rng(5)
    for _ in range(300):
        speed = math.exp(drawn.uniform(*np.log(SETTINGS.speed_range)))
        load = float(drawn.choice([-2000.0, 2000.0, drawn.uniform(-2000, 2000)]))
        heat = float(drawn.choice([293.15, 333.15, drawn.uniform(293.15, 333.15)]))
        point = surface.lookup(speed, load, heat)
        assert point.validity is Validity.VALID
        assert all(math.isfinite(value) for value in point.values)


def test_every_corner_is_near_what_solves_give(data, screw, oil, stand_in):
    """Uniform over speed, load and temperature, all of it: also where few columns reach."""
    surface, drawn = Surface(data), np.random.default_rng(11)
    for _ in range(150):
        speed = math.exp(drawn.uniform(*np.log(SETTINGS.speed_range)))
        load, heat = drawn.uniform(-2000, 2000), drawn.uniform(293.15, 333.15)
        sense = 'opposing' if load >= 0 else 'assisting'
        solved = [
            stand_in.solve(chain_inputs(screw, oil, abs(load), heat, draw, [speed]))[sense][0]
            for draw in range(SETTINGS.draws)
        ]
        found = surface.lookup(speed, load, heat)
        torque, rcs = (
            np.mean([record[name] for record in solved]) for name in ('friction_torque', 'rcs')
        )
        assert found.friction_torque == pytest.approx(torque, rel=0.05)
        assert abs(found.friction_torque - torque) < 4 * surface.errors['friction_torque'][0]
        assert abs(found.rcs - rcs) < 4 * surface.errors['rcs'][0] + 1e-4
        # Twice what the builder aims at where it looks.
        assert abs(found.rcs - rcs) < 2 * max(0.003, 0.05 * rcs)


@pytest.mark.parametrize(
    'ranges',
    [
        {'load_range': (0.0, 1500.0)},
        {'load_range': (400.0, 900.0)},
        {'load_range': (-4000.0, 2800.0)},
        {'load_range': (3000.0, 3500.0)},
        {'speed_range': (1.0, 3.0)},
        {'speed_range': (60.0, 90.0)},
        {'temperature_range': (312.15, 314.15)},
        {'draws': 1},
        {'shared_draws': 9},
    ],
)
def test_any_range_is_built_and_answers(screw, oil, stand_in, ranges):
    """Lopsided, one-sided, narrow, far from the onset; one draw and all draws everywhere."""
    settings = replace(SETTINGS, **{'draws': 2, 'held_out': 9, **ranges})
    data = build_full(screw, oil, settings, stand_in.run)
    surface, drawn = Surface(data), np.random.default_rng(7)
    assert math.isfinite(data.header['reached'])
    for _ in range(40):
        speed = math.exp(drawn.uniform(*np.log(settings.speed_range)))
        load = drawn.uniform(*settings.load_range)
        found = surface.lookup(speed, load, drawn.uniform(*settings.temperature_range))
        assert found.validity is Validity.VALID
        assert 0 <= found.rcs <= 1


def test_same_work_same_file(data, screw, oil, stand_in):
    """In another order of chains the file has the same hash."""

    def backwards(purpose, chains):
        return dict(reversed(stand_in.run(purpose, dict(reversed(chains.items()))).items()))

    assert build_full(screw, oil, SETTINGS, backwards).sha256 == data.sha256
    other = replace(SETTINGS, draws=2)
    assert build_full(screw, oil, other, stand_in.run).sha256 != data.sha256


def test_nothing_that_converges_is_one_sentence(screw, oil):
    """No file of masked nodes."""
    with pytest.raises(InputError, match='no point of the surface converged'):
        build_full(screw, oil, SETTINGS, lambda purpose, chains: dict.fromkeys(chains))


def test_a_reversed_range_is_refused_before_any_work(screw, oil):
    """The builder is never asked to solve."""
    wrong = replace(SETTINGS, load_range=(100.0, -100.0))
    with pytest.raises(InputError, match='load range'):
        build_full(screw, oil, wrong, None)


def test_info_says_what_is_certified_and_what_was_reached(data, tmp_path):
    """And nothing where neither is known."""
    path = tmp_path / 'full.npz'
    for known in (True, False):
        told = {'certified_s': 1.0, 'reached': 2.5} if known else {}
        told |= {'weighted_draws': {'count': 1, 'powers': [13.0, 24.0]}} if known else {}
        header = {**data.header, 'certified_s': None, 'reached': None, **told}
        surface_file.write(path, replace(data, header=header))
        page = info_page(info_record(path, surface_file.read(path)))
        assert ('from 2.72 times the onset speed on' in page) is known
        assert ('1 was aimed at, the worst held-out point reaches 2.5' in page) is known
        assert ('1, 2 near the idle load, weighted' in page) is known


def test_accuracy_is_not_known_without_a_held_out_point(screw, oil, stand_in):
    """All of them fail: no number, and errors are NaN."""

    def run(purpose, chains):
        held = purpose == 'held-out points'
        return dict.fromkeys(chains) if held else stand_in.run(purpose, chains)

    found = build_full(screw, oil, replace(SETTINGS, draws=1), run)
    assert found.header['reached'] is None
    assert np.isnan(found.errors['rcs']).all()
