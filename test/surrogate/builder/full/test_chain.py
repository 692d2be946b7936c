# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The unit of work of a full-tier surface is what the solver gives, whoever solves it."""

from dataclasses import asdict, replace
import json
import math

import numpy as np
import pytest
from surrogate.builder.full import chain as full_chain
from surrogate.builder.full.chain import chain_inputs, solve_chain, solved_chain, solved_point
from surrogate.builder.tiers import screw_and_oil
from surrogate.ehl import Settings, Status
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw import contacts as screw_contacts
from surrogate.screw.contacts import GRID_WAVELENGTH, ScrewSettings
from surrogate.screw.solve import solve_screw
from surrogate.surface import FIELDS

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
WARM = 313.15
LOOSE = 6e-4
"""What 0.3 % of the flux changes the torque by at most [-]; docs/notes/full_tier_surface.md."""


def tight(draw):
    """Return how chains are solved, with the tolerances of a point."""
    settings = full_chain.chain_settings(draw, GRID_WAVELENGTH)
    rough = replace(settings.rough, flux_tolerance=1e-4, krylov_tolerance=0.01)
    return replace(settings, rough=rough)


def test_sheets_survive_json():
    """Screw and oil come back as they were, options that are None among them."""
    inputs = chain_inputs(SCREW, OIL, 500.0, WARM, 3, [60.0, 6.0])
    assert screw_and_oil(json.loads(json.dumps(inputs))) == (SCREW, OIL)


def test_a_chain_is_the_points_it_says():
    """Both senses at two speeds, of one draw; the same numbers as single solves from cold."""
    speeds = [60.0, 30.0]
    chain = solve_chain(chain_inputs(SCREW, OIL, 500.0, WARM, 1, speeds))
    assert json.loads(json.dumps(chain)) == chain
    for sense, sign in (('opposing', 1), ('assisting', -1)):
        for record, speed in zip(chain[sense], speeds, strict=True):
            point = OperatingPoint(speed=speed, load=sign * 500.0, temperature=WARM)
            found = solve_screw(SCREW, OIL, point, settings=tight(1))
            assert record['converged']
            assert record['friction_torque'] == pytest.approx(found.friction_torque, rel=LOOSE)
            assert record['film_ratio'] == pytest.approx(found.film_ratio, rel=1e-4)
    assert chain['opposing'][0]['friction_torque'] != chain['assisting'][0]['friction_torque']


def test_the_first_point_of_a_chain_is_a_point_on_its_grid():
    """From cold, at the tolerance of chains: nothing is left to differ by."""
    first = solve_chain(chain_inputs(SCREW, OIL, 500.0, WARM, 1, [60.0]))['opposing'][0]
    point = OperatingPoint(speed=60.0, load=500.0, temperature=WARM)
    settings = full_chain.chain_settings(1, GRID_WAVELENGTH)
    found = solve_screw(SCREW, OIL, point, settings=settings)
    assert first['friction_torque'] == pytest.approx(found.friction_torque, rel=1e-9)


def test_draws_share_their_smooth_contacts(monkeypatch):
    """Two contacts at preload: solved smooth for the first draw, rough for each speed of each."""
    kinds, solve = [], screw_contacts.solve_contact

    def count(*case, roughness=None, **options):
        kinds.append('smooth' if roughness is None else 'rough')
        return solve(*case, roughness=roughness, **options)

    monkeypatch.setattr(screw_contacts, 'solve_contact', count)
    full_chain._smooth.cache_clear()
    chains = [
        solve_chain(chain_inputs(SCREW, OIL, 0.0, WARM, draw, speeds))
        for draw, speeds in enumerate(([60.0, 30.0], [60.0]))
    ]
    assert sorted(kinds) == ['rough'] * 6 + ['smooth'] * 4
    first, second = (chain['opposing'][0] for chain in chains)
    assert first['film_ratio'] == second['film_ratio']
    assert first['friction_torque'] != second['friction_torque']


def test_a_far_speed_leaves_no_trace():
    """Contacts start from cold at an eighth of the last speed: the same bit for bit."""
    both, alone = (
        solve_chain(chain_inputs(SCREW, OIL, 0.0, WARM, 2, speeds))['opposing'][-1]
        for speeds in ([48.0, 6.0], [6.0])
    )
    assert both['converged']
    assert both == alone


def test_a_contact_that_fails_costs_the_others_nothing(monkeypatch):
    """Those of the last speed that converged start the next, and the load is not turned round."""
    starts, solve = [], screw_contacts.solve_contact

    def fail_first(*case, roughness=None, start=None, **options):
        found = solve(*case, roughness=roughness, start=start, **options)
        if roughness is None:
            return found
        starts.append(start)
        failed = len(starts) == 1
        return replace(found, status=Status.DOMAIN_TOO_SMALL) if failed else found

    monkeypatch.setattr(screw_contacts, 'solve_contact', fail_first)
    chain = solve_chain(chain_inputs(SCREW, OIL, 3000.0, WARM, 0, [60.0, 40.0]))
    assert [start is None for start in starts] == [True, True, True, False]
    for sense in ('opposing', 'assisting'):
        assert [record['converged'] for record in chain[sense]] == [False, True]
        assert Status.DOMAIN_TOO_SMALL.value in chain[sense][0]['status']


@pytest.mark.parametrize('speed', [200.0, 100.0])
def test_thick_films_of_cold_oil_are_found(speed):
    """Where linear solves to a tenth alone lead nowhere."""
    chain = solve_chain(chain_inputs(SCREW, OIL, 3057.0, 283.15, 0, [speed]))
    for sense in ('opposing', 'assisting'):
        assert chain[sense][0]['converged']
        assert chain[sense][0]['rcs'] == 0.0


def test_the_looser_flux_of_chains_leaves_contact_alone():
    """A tenth of what a surface is allowed, where some of the load is on asperities."""
    speeds = [1.8, 1.0]
    chain = solve_chain(chain_inputs(SCREW, OIL, 0.0, WARM, 0, speeds))['opposing']
    start = None
    for record, speed in zip(chain, speeds, strict=True):
        point = OperatingPoint(speed=speed, load=0.0, temperature=WARM)
        start = solve_screw(SCREW, OIL, point, settings=tight(0), start=start)
        assert 0.001 < start.rcs < 0.3
        assert abs(record['rcs'] - start.rcs) < 0.1 * max(0.003, 0.05 * start.rcs)
        assert record['friction_torque'] == pytest.approx(start.friction_torque, rel=1e-3)


def test_record_of_a_point():
    """Every field of a surface, the worst contact among those that carry, the free film."""
    small = Settings(nx=65, ny=65, error_estimate=False)
    settings = ScrewSettings(smooth=small, draw=None)
    point = OperatingPoint(speed=60.0, load=500.0, temperature=WARM)
    found = solve_screw(SCREW, OIL, point, settings=settings)
    record = solved_point(found)
    assert {name: getattr(record, name) for name in FIELDS} == {
        name: getattr(found, name) for name in FIELDS
    }
    assert solved_chain({'opposing': [asdict(record)], 'assisting': []}).under(1.0) == (record,)
    ratios = [contact.film_ratio for contact in found.contacts]
    assert record.worst_contact == ratios.index(min(ratios))
    floor = OIL.film_floor
    assert record.film_over_floor == pytest.approx(record.minimum_film / floor)
    free = solve_screw(
        replace(SCREW, preload=0.0), OIL, replace(point, load=0.0), settings=settings
    )
    assert not solved_point(free).converged
    assert math.isnan(solved_point(free).film_over_floor)


def test_shorter_waves_are_solved_when_asked_for():
    """The wavelength reaches the contacts; without one it is that of the solver."""
    films = [
        solve_chain(chain_inputs(SCREW, OIL, 0.0, WARM, 0, [60.0], wavelength))['opposing'][0]
        for wavelength in (40e-6, 16e-6)
    ]
    assert all(record['converged'] for record in films)
    assert films[0]['friction_torque'] != films[1]['friction_torque']
    default = solve_chain(chain_inputs(SCREW, OIL, 0.0, WARM, 0, [60.0]))['opposing'][0]
    assert default == films[1]


def test_nodes_across_do_not_move_with_the_load():
    """Both contacts of a nut at two loads: the same distance, that of five per shortest wave."""
    settings = full_chain.chain_settings(0, GRID_WAVELENGTH)
    distances = []
    for load in (2900.0, 2930.0):
        point = OperatingPoint(speed=60.0, load=load, temperature=WARM)
        found = solve_screw(SCREW, OIL, point, settings=settings)
        distances += [float(np.diff(one.rough.y).mean()) for one in found.contacts if one.rough]
    assert len(distances) == 4
    wave = screw_contacts.shortest_on_grid(SCREW, settings)
    assert distances == pytest.approx([wave / 5] * 4)
