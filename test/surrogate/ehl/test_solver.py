# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bad input is one sentence, everything else a status; nothing is silently wrong."""

from dataclasses import FrozenInstanceError, replace
import math

import numpy as np
import pytest
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact, Status
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact

NOMINAL = Condition(load=27.6, entrainment_speed=0.5)
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2.0e-8)
SMALL = Settings(nx=33, ny=33)


@pytest.mark.parametrize(
    ('given', 'change'),
    [
        (NOMINAL, {'load': 0.0}),
        (NOMINAL, {'load': -1.0}),
        (NOMINAL, {'load': math.nan}),
        (NOMINAL, {'entrainment_speed': -0.1}),
        (NOMINAL, {'entrainment_speed': math.inf}),
        (NOMINAL, {'load': '27'}),
        (OIL, {'viscosity': 0.0}),
        (OIL, {'pressure_viscosity': -1e-8}),
        (OIL, {'eyring_stress': math.nan}),
        (OIL, {'law': 'water'}),
        (Settings(), {'nx': 64}),
        (Settings(), {'ny': 5}),
        (Settings(), {'nx': 64.5}),
        (Settings(), {'domain': (-0.5, 1.5, 2.0)}),
        (Settings(), {'domain': (-2.0, 1.5)}),
        (Settings(), {'film_floor': 0.0}),
        (Settings(), {'time_cap': -1.0}),
        (Settings(), {'wedge_order': 3}),
        (Settings(), {'wedge_fading': 0.0}),
        (Settings(), {'krylov_tolerance': 0.0}),
        (Settings(), {'krylov_tolerance': 0.6}),
        (Settings(), {'summit_reach': math.nan}),
        (Settings(), {'spacing': 0.0}),
        (Settings(), {'spacing': 4e-6, 'domain': (-2.0, 1.5, 2.0)}),
    ],
)
def test_impossible_inputs_are_refused(given, change):
    with pytest.raises(InputError, match=next(iter(change))):
        replace(given, **change)


@pytest.mark.parametrize(
    'change',
    [{'radius_x': -1e-3}, {'radius_y': 0.0}, {'reduced_modulus': math.nan}, {'radius_y': 99.0}],
)
def test_impossible_contacts_are_refused(nominal, change):
    with pytest.raises(InputError, match='radius|modulus'):
        solve_contact(replace(nominal[0], **change), nominal[1], NOMINAL)


@pytest.mark.parametrize('heights', [np.zeros((3, 3)), np.full((33, 33), np.nan)])
def test_roughness_that_does_not_fit_is_refused(nominal, heights, refused):
    refused('roughness_2', solve_contact, *nominal, NOMINAL, roughness=heights, settings=SMALL)


def test_results_are_frozen_and_statuses_are_sentences(nominal):
    found = solve_contact(*nominal, NOMINAL, settings=SMALL)
    with pytest.raises(FrozenInstanceError):
        found.rcs = 0.5
    assert all(status.value.endswith('.') and ' ' in status.value for status in Status)


def test_no_time_and_no_iterations_are_a_status_without_numbers(nominal):
    """Films, shares and forces are NaN, not those of the last iterate."""
    found = solve_contact(*nominal, NOMINAL, settings=Settings(time_cap=1e-3))
    assert found.status is Status.OUT_OF_TIME
    assert not found.converged
    found = solve_contact(*nominal, NOMINAL, settings=replace(SMALL, newton_limit=1))
    assert found.status is Status.STALLED
    found = solve_contact(*nominal, NOMINAL, settings=Settings(newton_limit=1))
    assert not found.converged
    known = ('central_film', 'minimum_film', 'rcs', 'asperity_share', 'rolling_force')
    assert all(math.isnan(getattr(found, name)) for name in known)


def test_smooth_contact_that_the_grid_makes_up_is_refused(moes_case):
    """M = 1000 on 33 nodes touches with the second-order wedge although its film is far above."""
    contact, oil, condition, unit = moes_case(1000.0, 10.0, 'roelands_dh')
    found = solve_contact(
        contact,
        oil,
        condition,
        settings=Settings(nx=33, ny=33, domain=(-2.5, 1.5, 2.0), refine=False),
    )
    assert found.status is Status.GRID_TOO_COARSE
    fine = solve_contact(
        contact, oil, condition, settings=Settings(nx=257, ny=257, domain=(-2.5, 1.5, 2.0))
    )
    assert fine.converged
    assert fine.rcs == 0.0
    assert fine.minimum_film > 0.9 * unit


def test_contact_that_a_finer_grid_dispels_is_refined_or_refused(moes_case):
    """The least film of M = 500 dips below a floor of 65 nm on the coarse grid, not on finer."""
    *case, _ = moes_case(500.0, 10.0, 'roelands_dh')
    settings = Settings(nx=81, ny=81, film_floor=65e-9)
    coarse = solve_contact(*case, settings=replace(settings, refine=False))
    fine = solve_contact(*case, settings=settings)
    assert coarse.status is Status.GRID_TOO_COARSE
    assert fine.converged, fine.status.value
    assert fine.rcs == 0.0
    assert fine.film.shape[0] > coarse.film.shape[0]


def test_thin_film_of_a_high_load_has_no_false_dip(nominal):
    """With plain differences the ends of the contact dip to 4 nm on the production grid."""
    condition = Condition(load=326.0, entrainment_speed=0.078)
    found = solve_contact(*nominal, condition)
    fine = solve_contact(*nominal, condition, settings=Settings(nx=513, ny=129))
    assert found.converged
    assert found.central_film == pytest.approx(fine.central_film, rel=0.04)
    assert found.minimum_film == pytest.approx(fine.minimum_film, rel=0.04)


def test_contact_at_the_edge_of_the_domain_is_refused(nominal):
    """Waves that carry the ball beyond the side of the grid are seen."""
    found = solve_contact(
        *nominal,
        replace(NOMINAL, entrainment_speed=0.0),
        settings=Settings(nx=65, ny=65, domain=(-1.4, 1.4, 1.06)),
        roughness=lambda x, y: 1e-6 * np.cos(np.pi * y / 0.45e-3) * -1 + 0 * x,
    )
    assert found.status is Status.DOMAIN_TOO_SMALL


def test_a_film_below_the_floor_is_real_contact(nominal):
    found = solve_contact(
        *nominal, Condition(load=27.6, entrainment_speed=1e-5), settings=Settings(film_floor=10e-9)
    )
    assert found.status in (Status.CONVERGED, Status.GRID_TOO_COARSE)
    if found.converged:
        assert found.rcs > 0.9


def test_the_long_axis_works_or_says_no():
    """Entrainment along the long axis of the ellipse."""
    contact = Contact(radius_x=75e-3, radius_y=3e-3, reduced_modulus=226.4e9)
    oil = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
    found = solve_contact(
        contact,
        oil,
        Condition(load=10.0, entrainment_speed=2.0),
        settings=Settings(nx=129, ny=129),
    )
    assert found.converged, found.status.value
    assert found.semi_axis_x > 5 * found.semi_axis_y
    assert 0 < found.minimum_film < found.central_film


def test_a_film_that_hardly_deforms_the_bodies_says_how_much_is_cut_off(nominal):
    """The domain cannot hold the pressure of a film of many height units: 15 % and more."""
    thick = solve_contact(*nominal, Condition(load=0.3, entrainment_speed=3.0))
    unit = thick.semi_axis_x**2 / thick.contact.radius_x
    assert thick.converged, thick.status.value
    assert thick.central_film > 5 * unit
    assert 0.15 <= thick.film_error <= 0.3
