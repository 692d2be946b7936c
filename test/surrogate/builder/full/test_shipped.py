# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The shipped full-tier surface: whole, of today's datasheets, and what the solver gives."""

from dataclasses import asdict
import itertools
import math

import numpy as np
import pytest
from surrogate.builder.full.chain import chain_inputs, solve_chain
from surrogate.surface import find_surface, Surface, Validity
from surrogate.surface.file import read

PATH = find_surface('full')
DATA, LARGEST = read(PATH), 2_000_000
SURFACE = Surface(DATA)


def test_file_is_of_the_datasheets_and_small(screw, oil):
    """A datasheet that changes asks for another build; the package stays small."""
    assert DATA.header['inputs'] == {'screw': asdict(screw), 'lubricant': asdict(oil)}
    assert SURFACE.tier == 'full'
    assert PATH.stat().st_size < LARGEST


def test_every_point_has_an_answer_with_its_uncertainty():
    """No masked cell in the ranges, to their corners; deviations over draws everywhere."""
    ends = (np.log(SURFACE.speed_range), SURFACE.load_range, SURFACE.temperature_range)
    corners = itertools.product((1e-9, 1 - 1e-9), repeat=3)
    inside = np.random.default_rng(3).random((2000, 3)).tolist()
    for fractions in (*corners, *inside):
        speed, load, kelvin = (low + (high - low) * f for (low, high), f in zip(ends, fractions))
        found = SURFACE.lookup(math.exp(speed), load, kelvin)
        assert found.validity is Validity.VALID
        assert 0 <= found.rcs <= 1
        assert found.friction_torque > 0
        assert found.friction_torque_std > 0


def test_contact_ends_and_stays_away():
    """RCS falls with speed to exactly nothing, and torque has its least between."""
    speeds = np.geomspace(*SURFACE.speed_range, 80)
    points = [SURFACE.lookup(float(w), 500.0, 313.15) for w in speeds]
    shares = np.array([point.rcs for point in points])
    assert (np.diff(shares) <= 1e-12).all()
    assert shares[0] > 0.95
    assert shares[-1] == 0.0
    least = speeds[int(np.argmin([point.friction_torque for point in points]))]
    assert 5 < least * 30 / math.pi < 40


def test_rcs_falls_with_speed_at_every_node():
    """Also beside the idle load, where nodes are completed."""
    shares = np.where(DATA.mask, np.nan, DATA.fields['rcs'])
    assert not (np.diff(shares, axis=0) > 0).any()


def test_a_node_is_what_the_solver_gives(screw, oil):
    """At 40 degC and preload, contact ended: films exactly, torque of two draws by the scatter."""
    k = int(np.argmin(np.abs(DATA.temperature - oil.reference_temperature)))
    j = int(np.argmin(np.abs(DATA.load)))
    i = int(np.searchsorted(DATA.speed_coordinate, 1.5))
    speed = math.exp(DATA.speed_coordinate[i] + DATA.log_onset[j, k])
    load, heat = float(DATA.load[j]), float(DATA.temperature[k])
    node = {name: values[i, j, k] for name, values in DATA.fields.items()}
    for draw in (0, 1):
        record = solve_chain(chain_inputs(screw, oil, load, heat, draw, [speed]))['opposing'][0]
        for name in ('film_ratio', 'central_film'):
            assert record[name] == pytest.approx(node[name], rel=1e-4)
        deviation = DATA.deviations['friction_torque'][i, j, k]
        assert abs(record['friction_torque'] - node['friction_torque']) < 4 * deviation
        assert record['rcs'] == node['rcs'] == 0.0
