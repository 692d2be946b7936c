# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Friction over solved contacts: the table, closed forms, directions, limits."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.ehl import Condition, punctured_nodes, Settings, solve_contact
from surrogate.ehl.friction import contact_friction, slide_roll_friction, viscosity_of
from surrogate.files import InputError
from surrogate.formulas.lubricant import shear_stress_eyring_1936


def test_friction_table(dimensional):
    """Full-film coefficients at two slide-roll ratios to 3 %."""
    for number, found in dimensional.values():
        if 'mu_1' not in number:
            continue
        assert found.converged, found.status.value
        for which in '12':
            friction = slide_roll_friction(found, number[f'srr_{which}'])
            assert friction.coefficient == pytest.approx(number[f'mu_{which}'], rel=0.03)
            assert friction.asperity_coefficient == 0.0


def test_uniform_slip_opposes_itself(solved):
    """Force, coefficient and power agree; no force across; turning the slip turns the force."""
    along = contact_friction(solved, slip_x=0.01)
    assert along.force_x == pytest.approx(-along.coefficient * 27.6, rel=1e-12)
    assert along.force_y == 0.0
    assert along.power == pytest.approx(-along.force_x * 0.01, rel=1e-12)
    across = contact_friction(solved, slip_x=0.006, slip_y=-0.008)
    assert across.force_x == pytest.approx(0.6 * along.force_x, rel=1e-12)
    assert across.force_y == pytest.approx(-0.8 * along.force_x, rel=1e-12)


def test_spin_has_a_moment_and_no_force_across_the_symmetry(solved):
    """Pure spin: the moment opposes it, the force along x cancels, power = moment times spin."""
    spin = 20.0
    found = contact_friction(
        solved,
        slip_x=-spin * solved.y[None, :] + 0 * solved.x[:, None],
        slip_y=spin * solved.x[:, None] + 0 * solved.y[None, :],
    )
    assert found.spin_moment < 0
    assert found.power == pytest.approx(-found.spin_moment * spin, rel=1e-9)
    assert abs(found.force_x) < 1e-9 * abs(found.force_y)


def test_small_slip_is_newtonian_and_below_the_floor_proportional(solved):
    """At vanishing slip the stress is eta slip / h and doubles with the slip."""
    slip = 1e-12
    found = contact_friction(solved, slip_x=slip)
    wet = solved.film_pressure > 0
    newton = viscosity_of(solved.lubricant, solved.film_pressure) * slip / solved.film
    assert found.traction[wet] == pytest.approx(newton[wet], rel=1e-6)
    assert contact_friction(solved, slip_x=0.0).coefficient == 0.0
    small = contact_friction(solved, slip_x=1e-6, slip_floor=1e-4)
    double = contact_friction(solved, slip_x=2e-6, slip_floor=1e-4)
    assert double.force_x == pytest.approx(2 * small.force_x, rel=1e-3)


def test_traction_is_that_of_each_node_by_the_laws(solved):
    """The plain version: Eyring's stress of the oil, or mu p where the film is at the floor."""
    thin = solved.film.copy()
    thin[100:140, 20:40] = solved.settings.film_floor
    mixed, slip = replace(solved, film=thin), 0.01 + 20.0 * solved.y
    found = contact_friction(
        mixed, slip_x=np.broadcast_to(slip, thin.shape), asperity_friction=0.12
    )
    dry = punctured_nodes(mixed)
    viscosity = viscosity_of(solved.lubricant, solved.film_pressure)
    sheared = shear_stress_eyring_1936(
        viscosity, np.abs(slip) / thin, solved.lubricant.eyring_stress
    )
    sheared[dry | (solved.film_pressure == 0)] = 0.0
    boundary = np.where(dry, 0.12 * mixed.pressure, 0.0)
    assert boundary.any()
    np.testing.assert_allclose(found.traction, sheared + boundary, rtol=1e-12)
    area = (solved.x[1] - solved.x[0]) * (solved.y[1] - solved.y[0])
    power = ((sheared + boundary) * np.abs(slip)).sum() * area
    assert found.power == pytest.approx(power, rel=1e-12)
    assert found.film_coefficient == pytest.approx(sheared.sum() * area / 27.6, rel=1e-12)
    assert found.asperity_coefficient == pytest.approx(boundary.sum() * area / 27.6, rel=1e-12)


def test_a_limiting_shear_stress_bounds_the_oil_alone(solved):
    """A high limit changes next to nothing, a low one makes Coulomb friction of the oil's part."""
    free = contact_friction(solved, slip_x=0.02, asperity_share=0.2)

    def limited(share):
        oil = replace(solved.lubricant, limiting_shear_share=share)
        found = contact_friction(replace(solved, lubricant=oil), slip_x=0.02, asperity_share=0.2)
        assert found.asperity_coefficient == free.asperity_coefficient
        return found

    assert limited(1.0).coefficient == pytest.approx(free.coefficient, rel=1e-4)
    assert limited(1e-4).film_coefficient == pytest.approx(0.8 * 1e-4, rel=1e-2)
    assert limited(0.02).film_coefficient < free.film_coefficient
    assert (limited(0.02).traction <= (0.8 * 0.02 + 0.2 * 0.1) * solved.pressure * 1.001).all()


def test_dry_contact_has_the_boundary_coefficient(nominal, raceway):
    """At rest all load is on punctured nodes; a mixed contact lies between."""
    settings = Settings(nx=65, ny=65, domain=(-2.6, 1.4, 1.4), open_inlet=True)
    dry = solve_contact(
        *nominal, Condition(load=27.6, entrainment_speed=0.0), roughness=raceway, settings=settings
    )
    found = contact_friction(dry, slip_x=0.01, asperity_friction=0.12)
    assert found.coefficient == pytest.approx(0.12, rel=1e-4)
    assert found.film_coefficient == 0.0
    mixed = solve_contact(
        *nominal,
        Condition(load=27.6, entrainment_speed=0.004),
        roughness=raceway,
        settings=settings,
    )
    found = slide_roll_friction(mixed, 0.02)
    assert mixed.converged
    assert found.asperity_coefficient == pytest.approx(0.1 * mixed.rcs, rel=1e-6)
    assert 0 < found.film_coefficient < found.coefficient < 0.12


@pytest.mark.parametrize(
    'wrong',
    [
        {'slip_x': np.zeros(3)},
        {'slip_x': np.nan},
        {'slip_x': 0.0, 'asperity_friction': -0.1},
        {'slip_x': 0.0, 'slip_floor': -1.0},
    ],
)
def test_bad_input_is_one_sentence(solved, wrong):
    with pytest.raises(InputError):
        contact_friction(solved, **wrong)


def test_barus_viscosity(nominal):
    oil = replace(nominal[1], law='barus_incompressible')
    assert float(viscosity_of(oil, 1e9)) == pytest.approx(0.06 * np.exp(20.0))


def test_a_share_from_elsewhere_is_boundary_friction_everywhere(solved):
    """Coefficient mu_a of that share, that of the film of the rest: the ends and between."""
    known = {'slip_x': 0.01, 'asperity_friction': 0.12}
    film = contact_friction(solved, **known, asperity_share=0.0)
    assert film.coefficient == pytest.approx(contact_friction(solved, **known).coefficient)
    for share in (0.3, 1.0):
        mixed = contact_friction(solved, **known, asperity_share=share)
        assert mixed.asperity_coefficient == pytest.approx(0.12 * share, rel=1e-6)
        assert mixed.film_coefficient == pytest.approx((1 - share) * film.coefficient)
        assert mixed.force_x == pytest.approx(-27.6 * mixed.coefficient, rel=1e-9)
