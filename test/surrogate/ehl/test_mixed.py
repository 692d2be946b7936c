# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rough contacts from full film to dry, and the dry limit against an independent solver."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.ehl import Condition, Settings, solve_contact
from surrogate.ehl.case import ScaledCase

SETTINGS = Settings(nx=65, ny=129, domain=(-2.6, 1.4, 1.4), open_inlet=True, film_floor=5e-9)
SPEEDS = (1.0, 0.5, 0.25, 0.12, 0.06, 0.03, 0.015, 0.008, 0.004, 0.002, 0.001, 0.0)


@pytest.fixture(scope='module')
def chain(nominal, raceway):
    """Solve from the fastest speed down to the dry contact, each from its neighbour."""
    solved, last = [], None
    for speed in SPEEDS:
        last = solve_contact(
            *nominal,
            Condition(load=27.6, entrainment_speed=speed),
            roughness=raceway,
            settings=SETTINGS,
            start=last,
        )
        solved.append(last)
    return solved


def test_every_speed_converges_and_keeps_its_promises(chain):
    """Load, complementarity and floor hold at every speed; shares are in [0, 1] and ordered."""
    for found in chain:
        area = (found.x[1] - found.x[0]) * (found.y[1] - found.y[0])
        assert found.converged, found.status.value
        assert found.pressure.sum() * area == pytest.approx(27.6, rel=1e-5)
        assert found.film_pressure.min() >= 0
        assert found.asperity_pressure.min() > -1e-4 * found.max_pressure
        assert found.minimum_film >= (1 - 1e-4) * SETTINGS.film_floor
        assert not found.asperity_pressure[~found.contact_mask].any()
        touching = found.film[found.contact_mask]
        assert touching == pytest.approx(SETTINGS.film_floor, rel=2e-3)
        assert -1e-9 <= found.asperity_share <= found.rcs + 1e-9 <= 1 + 1e-6


@pytest.mark.parametrize(
    ('place', 'tolerance', 'films', 'shares'),
    [(3, 1e-4, 2e-5, 1e-5), (3, 3e-3, 1e-3, 1e-4), (6, 1e-4, 2e-5, 1e-5), (6, 3e-3, 1e-3, 1e-3)],
)
def test_the_rest_of_the_flux_moves_nothing(
    chain, nominal, raceway, place, tolerance, films, shares
):
    """Against a thousandth of the tolerance: thin films and RCS, as contact begins and grows."""
    exact, found = (
        solve_contact(
            *nominal,
            Condition(load=27.6, entrainment_speed=SPEEDS[place]),
            roughness=raceway,
            settings=replace(SETTINGS, flux_tolerance=flux, error_estimate=False),
            start=chain[place - 1],
        )
        for flux in (1e-3 * tolerance, tolerance)
    )
    assert found.residual > 10 * exact.residual
    assert found.central_film == pytest.approx(exact.central_film, rel=films)
    assert found.rcs == pytest.approx(exact.rcs, abs=shares)
    thin = exact.film < 3 * exact.central_film
    assert found.film[thin] == pytest.approx(exact.film[thin], rel=20 * films)


def test_rcs_grows_as_the_speed_falls(chain):
    """From exactly nothing at 1 m/s to all of the load at rest."""
    shares = [found.rcs for found in chain]
    assert shares[0] == 0.0
    assert np.all(np.diff(shares) >= 0)
    assert shares[-1] == pytest.approx(1.0, abs=1e-6)
    assert shares[-2] > 0.98


def test_slow_limit_is_the_dry_contact(chain, nominal, raceway):
    """The chain ends at the dry contact that is solved from cold, and 1 mm/s is near it."""
    cold = solve_contact(
        *nominal, Condition(load=27.6, entrainment_speed=0.0), roughness=raceway, settings=SETTINGS
    )
    assert cold.converged, cold.status.value
    assert (cold.contact_mask == chain[-1].contact_mask).all()
    assert cold.pressure == pytest.approx(chain[-1].pressure, abs=1e-3 * cold.max_pressure)
    assert not cold.film_pressure.any()
    distance = np.abs(chain[-2].pressure - cold.pressure).sum() / cold.pressure.sum()
    assert distance < 0.03


def test_dry_contact_is_that_of_an_independent_solver(nominal, raceway):
    """Contact area, pressure and approach of ContactMechanics on the same grid, to 1 %."""
    mechanics = pytest.importorskip('ContactMechanics')
    topography = pytest.importorskip('SurfaceTopography')
    contact, _ = nominal
    found = solve_contact(
        *nominal,
        Condition(load=27.6, entrainment_speed=0.0),
        roughness=raceway,
        settings=replace(SETTINGS, domain=(-1.4, 1.4, 1.4), film_floor=1e-9),
    )
    assert found.converged, found.status.value
    shape = found.film.shape
    dx, dy = found.x[1] - found.x[0], found.y[1] - found.y[0]
    x, y = np.meshgrid(found.x, found.y, indexing='ij')
    ball = x**2 / (2 * contact.radius_x) + y**2 / (2 * contact.radius_y)
    size = (shape[0] * dx, shape[1] * dy)
    system = mechanics.make_system(
        interaction='hardwall',
        surface=topography.Topography(raceway(x, y) - ball, size),
        substrate=mechanics.FreeFFTElasticHalfSpace(shape, contact.reduced_modulus / 2, size),
    )
    assert system.minimize_proxy(external_force=27.6, pentol=1e-12, maxiter=2000).success
    pressure = np.asarray(system.force)[: shape[0], : shape[1]] / (dx * dy)
    assert found.contact_mask.sum() == pytest.approx((pressure > 0).sum(), rel=0.01)
    assert found.max_pressure == pytest.approx(pressure.max(), rel=0.01)
    assert np.abs(found.pressure - pressure).sum() < 0.01 * pressure.sum()
    assert found.approach == pytest.approx(float(system.offset), rel=0.01)


def test_vanishing_roughness_is_the_smooth_contact(nominal, raceway):
    """A thousandth of the roughness, solved with another wedge, gives the smooth film to 1 %."""
    condition = Condition(load=27.6, entrainment_speed=0.5)
    settings = replace(SETTINGS, nx=129, ny=65)
    fine = solve_contact(*nominal, condition, settings=replace(settings, nx=257))
    smooth = solve_contact(*nominal, condition, settings=settings)
    rough = solve_contact(
        *nominal, condition, settings=settings, roughness=lambda x, y: 1e-3 * raceway(x, y)
    )
    assert smooth.converged
    assert rough.converged
    assert rough.rcs == smooth.rcs == 0.0
    assert rough.central_film == pytest.approx(fine.extrapolated_film, rel=0.01)


def test_heights_and_function_are_the_same_roughness(chain, nominal, raceway):
    x, y = np.meshgrid(chain[0].x, chain[0].y, indexing='ij')
    found = solve_contact(
        *nominal,
        Condition(load=27.6, entrainment_speed=0.25),
        roughness=raceway(x, y),
        settings=SETTINGS,
        start=chain[1],
    )
    assert found.pressure == pytest.approx(chain[2].pressure, abs=1e-3 * found.max_pressure)


def test_half_grid_says_how_far_films_and_shares_are_known(chain, nominal, raceway):
    """Both errors are there and cover the change to a grid twice as fine."""
    found = chain[SPEEDS.index(0.004)]
    fine = solve_contact(
        *nominal,
        found.condition,
        roughness=raceway,
        settings=replace(SETTINGS, nx=129, ny=257, error_estimate=False),
        start=found,
    )
    assert fine.converged, fine.status.value
    assert math.isnan(fine.rcs_error)
    assert 0 < found.film_error < 0.1
    assert abs(fine.rcs - found.rcs) < found.rcs_error


def test_heights_at_nodes_give_the_same_errors(chain, nominal, raceway):
    found = chain[SPEEDS.index(0.015)]
    x, y = np.meshgrid(found.x, found.y, indexing='ij')
    again = solve_contact(
        *nominal, found.condition, roughness=raceway(x, y), settings=SETTINGS, start=found
    )
    assert again.rcs_error == pytest.approx(found.rcs_error, abs=1e-4)


@pytest.mark.parametrize('speed', [0.03, 0.004])
def test_the_half_grid_leads_to_the_same_solution(nominal, raceway, speed, monkeypatch):
    """From cold, without and with contact: the same solution, with fewer Krylov iterations."""
    condition = Condition(load=27.6, entrainment_speed=speed)
    short = solve_contact(*nominal, condition, roughness=raceway, settings=SETTINGS)
    monkeypatch.setattr(ScaledCase, 'has_heights_on', lambda case, shape: False)
    long = solve_contact(*nominal, condition, roughness=raceway, settings=SETTINGS)
    assert short.converged, short.status
    assert long.converged, long.status
    assert (long.rcs > 0.01) == (speed < 0.01)
    assert short.rcs == pytest.approx(long.rcs, rel=1e-4)
    assert np.abs(short.film - long.film).max() < 1e-3 * long.central_film


def test_a_start_of_another_load_is_not_taken(chain, nominal, raceway):
    """Ripples do not stretch with the load: the solve goes its way from cold."""
    condition = Condition(load=40.0, entrainment_speed=SPEEDS[5])
    settings = replace(SETTINGS, error_estimate=False)
    cold = solve_contact(*nominal, condition, roughness=raceway, settings=settings)
    near = solve_contact(*nominal, condition, roughness=raceway, settings=settings, start=chain[5])
    assert near.newton_iterations == cold.newton_iterations
    assert np.array_equal(near.film, cold.film)


@pytest.mark.parametrize(('place', 'taken'), [(1, True), (2, False), (11, True)])
def test_a_start_of_a_far_speed_is_not_taken(chain, nominal, raceway, place, taken):
    """From 1 m/s the way to 0.25 m/s is longer than that from cold, to 0.5 m/s it is not."""
    condition = Condition(load=27.6, entrainment_speed=SPEEDS[place])
    settings = replace(SETTINGS, error_estimate=False)
    start = chain[0] if place < 11 else chain[10]
    cold = solve_contact(*nominal, condition, roughness=raceway, settings=settings)
    found = solve_contact(*nominal, condition, roughness=raceway, settings=settings, start=start)
    assert (found.krylov_iterations < cold.krylov_iterations) == taken
    assert np.array_equal(found.film, cold.film) != taken
    assert found.rcs == pytest.approx(cold.rcs, abs=1e-4)
