# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The unit of work of a full-tier surface is what the solver gives, whoever solves it."""

from dataclasses import asdict, replace
import json
import math

import pytest
from surrogate.builder.full import chain as full_chain
from surrogate.builder.full.chain import (
    chain_inputs,
    COARSE,
    point_inputs,
    solve_chain,
    solved_chain,
)
from surrogate.ehl import Settings, Status
from surrogate.parameters import (
    BallRoughness,
    load_lubricant,
    load_screw,
    OperatingPoint,
    screw_and_oil,
)
from surrogate.screw import contacts as screw_contacts
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.point import kept_point
from surrogate.screw.screw_onset import with_raceway
from surrogate.screw.solve import solve_screw
from surrogate.surface import FIELDS

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
WARM = 313.15
GRIDS = ScrewSettings(smooth=COARSE), ScrewSettings()
"""Those of a chain, and of a single point."""


def chain(load, heat, speeds, screw=SCREW, oil=OIL):
    """Solve a chain as a worker does, through JSON."""
    given = chain_inputs(screw, oil, load, heat, speeds)
    return solve_chain(json.loads(json.dumps(given)))


def test_sheets_survive_json():
    """Screw and oil come back as they were, options that are None among them."""
    for screw in (SCREW, replace(SCREW, ball_roughness=BallRoughness(grade='G10'))):
        inputs = json.loads(json.dumps(chain_inputs(screw, OIL, 500.0, WARM, [60.0, 6.0])))
        assert screw_and_oil(inputs) == (screw, OIL)


def test_a_chain_is_the_points_it_says():
    """Both senses at two speeds: solves from cold on its grids, nearly those on finer ones."""
    speeds = [30.0, 10.0]
    found = chain(500.0, WARM, speeds)
    assert json.loads(json.dumps(found)) == found
    opposing, assisting = solved_chain(found)
    for load, points in ((500.0, opposing), (-500.0, assisting)):
        for solved, speed in zip(points, speeds, strict=True):
            point = OperatingPoint(speed=speed, load=load, temperature=WARM)
            same, single = (solve_screw(OPENED, OIL, point, settings=one) for one in GRIDS)
            assert solved.converged
            assert solved.friction_torque == pytest.approx(same.friction_torque, rel=1e-4)
            assert solved.film_ratio == pytest.approx(same.film_ratio, rel=1e-4)
            assert solved.friction_torque == pytest.approx(single.friction_torque, rel=0.01)
            assert solved.film_ratio == pytest.approx(single.film_ratio, rel=0.005)
            assert solved.rcs == pytest.approx(single.rcs, rel=1e-3)
            assert solved.rcs_deviation == pytest.approx(single.rcs_deviation, rel=1e-3)
        exact = solve_chain(point_inputs(SCREW, OIL, load, WARM, speed))['opposing'][0]
        assert exact == asdict(kept_point(single))
    assert opposing[0].friction_torque != assisting[0].friction_torque
    assert opposing[1].rcs > opposing[0].rcs


def test_the_state_of_the_raceway_counts(one_small_tile):
    """Run in, it touches less at the same speed."""
    with one_small_tile():
        few, many = (
            chain(0.0, WARM, [10.0], with_raceway(SCREW, state=state))['opposing'][0]
            for state in ('run_in', 'new')
        )
    assert few['rcs'] < many['rcs']
    assert few['film_ratio'] == many['film_ratio']


def test_no_load_is_one_point_for_both_senses(monkeypatch):
    """Nothing is turned round."""
    monkeypatch.setattr(full_chain, '_turned', None)
    found = chain(0.0, WARM, [30.0])
    assert found['opposing'] == found['assisting']


def test_balls_that_move_their_forces_are_solved_again():
    """Near the idle load at high speed both senses are what single solves give."""
    load = 2600.0
    chains = chain(load, WARM, [300.0])
    for sense, sign in (('opposing', 1), ('assisting', -1)):
        point = OperatingPoint(speed=300.0, load=sign * load, temperature=WARM)
        same, single = (solve_screw(OPENED, OIL, point, settings=one) for one in GRIDS)
        found = chains[sense][0]
        assert found['friction_torque'] == pytest.approx(same.friction_torque, rel=1e-3)
        assert found['friction_torque'] == pytest.approx(single.friction_torque, rel=0.01)


def test_a_turned_load_is_solved_on_the_flank_that_a_ball_had_left(one_small_tile):
    """Oversize balls near unloading rest on three flanks, and on another one the other way."""
    screw = replace(load_screw('iso3408_40x10'), nut='oversize')
    load = 2.6 * screw.preload
    with one_small_tile():
        found = chain(load, WARM, [15.0], screw)
        for sense, sign in (('opposing', 1), ('assisting', -1)):
            point = OperatingPoint(speed=15.0, load=sign * load, temperature=WARM)
            cold = solve_screw(Contacts.of(screw), OIL, point, settings=GRIDS[0])
            torque = found[sense][0]['friction_torque']
            assert torque == pytest.approx(cold.friction_torque, rel=1e-3)


def test_a_contact_that_fails_costs_the_others_nothing(monkeypatch):
    """The next speed starts from cold and converges; the failed load is not turned round."""
    starts, solve = [], screw_contacts.solve_contact

    def fail_first(*case, start=None, **options):
        found = solve(*case, start=start, **options)
        starts.append(start)
        return replace(found, status=Status.DOMAIN_TOO_SMALL) if len(starts) == 1 else found

    monkeypatch.setattr(screw_contacts, 'solve_contact', fail_first)
    found = chain(3000.0, WARM, [60.0, 40.0])
    assert [start is None for start in starts] == [True] * 4
    for sense in ('opposing', 'assisting'):
        assert [record['converged'] for record in found[sense]] == [False, True]
        assert Status.DOMAIN_TOO_SMALL.value in found[sense][0]['status']


@pytest.mark.parametrize('speed', [200.0, 100.0])
def test_thick_films_of_cold_oil_are_found(speed):
    """Of both senses, beyond the idle load."""
    found = chain(3057.0, 283.15, [speed])
    assert found['opposing'][0]['converged']
    assert found['assisting'][0]['converged']


def test_record_of_a_point():
    """Every field of a surface and the worst contact; no point without a contact."""
    small = Settings(nx=65, ny=65, error_estimate=False)
    settings = ScrewSettings(smooth=small, kinematics='smooth')
    point = OperatingPoint(speed=60.0, load=500.0, temperature=WARM)
    found = solve_screw(OPENED, OIL, point, settings=settings)
    record = kept_point(found)
    assert {name: getattr(record, name) for name in FIELDS} == {
        name: getattr(found, name) for name in FIELDS
    }
    assert math.isnan(record.rcs_deviation)
    ratios = [contact.film_ratio for contact in found.contacts]
    assert record.worst_contact == ratios.index(min(ratios))
    rolling = replace(settings, kinematics='rolling')
    found = solve_screw(OPENED, OIL, replace(point, speed=10.0), settings=rolling)
    record = kept_point(found)
    assert record.rcs_deviation == found.rcs_deviation > 0
    kept = solved_chain({'opposing': [asdict(record)], 'assisting': []})
    assert kept == ((record,), ())
    free = replace(SCREW, preload=0.0)
    unloaded = solve_screw(Contacts.of(free), OIL, replace(point, load=0.0), settings=settings)
    assert not kept_point(unloaded).converged
