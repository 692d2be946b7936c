# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The shipped full-tier surface: whole, of today's datasheets, and what the solver gives."""

import itertools
import math

import numpy as np
import pytest
from surrogate.builder.full.chain import chain_inputs, solve_chain
from surrogate.builder.full.march import FINER, marched_film
from surrogate.files.datasheet import DATA as DATA_FOLDER
from surrogate.parameters import load_screw
from surrogate.screw.screw_onset import with_raceway
from surrogate.surface import find_surface, Surface, Validity
from surrogate.surface.file import read
from surrogate.surface_tools.limit import limit_speed

PATH = find_surface('full')
GENERIC = sorted(sheet.stem for sheet in (DATA_FOLDER / 'screws').glob('iso3408_*.yaml'))
DATA, LARGEST = read(PATH), 2_000_000
SURFACE = Surface(DATA)
CLOSED_FORM = Surface.load(find_surface('closed_form'))


def test_file_is_of_the_datasheets_and_small(screw, oil):
    """A datasheet that changes asks for another build; the package stays small."""
    assert DATA.header['inputs'] == {'screw': screw.stated(), 'lubricant': oil.stated()}
    assert SURFACE.tier == 'full'
    assert PATH.stat().st_size < LARGEST


@pytest.mark.parametrize('name', GENERIC)
def test_each_generic_size_has_a_surface_of_its_sheet(name, oil):
    """
    Without a node that is missing, within one and a half times the error that is aimed at.

    It carries three strips of its raceway and a finer one, and their correction of the law.

    """
    data = read(find_surface('full', name, oil.name))
    strips, sheet = data.header['march'], load_screw(name)
    assert list(strips) == [FINER, 'strip 1', 'strip 2', 'strip 3']
    marched = with_raceway(
        sheet, **marched_film(strips, sheet.roughness.lay, sheet.roughness.state)
    )
    assert marched != sheet
    assert data.header['inputs'] == {'screw': marched.stated(), 'lubricant': oil.stated()}
    assert not data.mask.any()
    assert 0 < data.header['reached'] < 1.5
    assert 0.5 < Surface(data).lookup(100.0, 0.0, 313.15).film_ratio < 20


def test_every_point_has_an_answer_with_its_uncertainty():
    """No masked cell in the ranges, to their corners; the scatter between strips everywhere."""
    ends = (np.log(SURFACE.speed_range), SURFACE.load_range, SURFACE.temperature_range)
    corners = itertools.product((1e-9, 1 - 1e-9), repeat=3)
    inside = np.random.default_rng(3).random((2000, 3)).tolist()
    for fractions in (*corners, *inside):
        speed, load, kelvin = (low + (high - low) * f for (low, high), f in zip(ends, fractions))
        found = SURFACE.lookup(math.exp(speed), load, kelvin)
        assert found.validity is Validity.VALID
        assert 0 <= found.rcs <= 1
        assert found.friction_torque > 0
        assert 0 <= found.rcs_std <= 1


def test_contact_ends_and_stays_away():
    """RCS falls with speed to exactly nothing, and torque has its least between."""
    speeds = np.geomspace(*SURFACE.speed_range, 80)
    points = [SURFACE.lookup(float(w), 500.0, 313.15) for w in speeds]
    shares = np.array([point.rcs for point in points])
    assert (np.diff(shares) <= 1e-12).all()
    assert shares[0] > 0.9
    assert shares[-1] < 1e-4
    torques = [point.friction_torque for point in points]
    assert 0 < int(np.argmin(torques)) < len(torques) - 1


def test_the_limit_is_known_within_the_floors_of_the_oil():
    """A speed below and one above."""
    low, high = SURFACE.limit_band
    assert 0.3 < low < 1 < high < 3


@pytest.mark.parametrize(
    ('load', 'kelvin'),
    [(0.0, 313.15), (0.0, 293.15), (1000.0, 333.15), (2000.0, 313.15), (-3900.0, 313.15)],
)
def test_contact_of_the_closed_form_begins_near_that_of_the_full_tier(load, kelvin):
    """By the same law, within 2 % in speed, at a film ratio as published (0.6 to 1.2)."""
    solved, formulas = (limit_speed(surface, load, kelvin) for surface in (SURFACE, CLOSED_FORM))
    assert formulas == pytest.approx(solved, rel=0.02)
    assert 0.6 < SURFACE.lookup(solved, load, kelvin).film_ratio < 1.2


def test_rcs_falls_with_speed_at_every_node():
    """Also beside the idle load."""
    shares = np.where(DATA.mask, np.nan, DATA.fields['rcs'])
    assert not (np.diff(shares, axis=0) > 0).any()


@pytest.mark.parametrize('s', [-1.5, 1.5])
def test_a_node_is_what_the_solver_gives(screw, oil, s):
    """At 40 degC and preload, on either side of the onset; on the grids of a chain."""
    k = int(np.argmin(np.abs(DATA.temperature - oil.reference_temperature)))
    j = int(np.argmin(np.abs(DATA.load)))
    i = int(np.searchsorted(DATA.speed_coordinate, s))
    speed = math.exp(DATA.speed_coordinate[i] + DATA.log_onset[j, k])
    load, heat = float(DATA.load[j]), float(DATA.temperature[k])
    found = solve_chain(chain_inputs(screw, oil, load, heat, [speed]))['opposing'][0]
    for name in ('film_ratio', 'central_film', 'friction_torque', 'rcs'):
        node = DATA.fields[name][i, j, k]
        assert found[name] == pytest.approx(node, rel=1e-3, abs=1e-9)
