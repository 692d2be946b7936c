# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Cases of the tables in Moes groups and of the nominal ball screw."""

import numpy as np
import pytest
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.formulas.geometry import Contact


@pytest.fixture(scope='session')
def dimensional(table):
    """Solve the rows of the table in SI units on its domain; return their numbers with them."""
    solved = {}
    for row in table('ehl_dimensional.csv'):
        number = {key: float(text) for key, text in row.items() if key != 'case' and text}
        ellipse = row['case'] == 'ball_screw_ellipse'
        nx, ny = (513, 129) if ellipse else (257, 257)
        stress = {'eyring_stress': number['tau0_MPa'] * 1e6} if 'tau0_MPa' in number else {}
        solved[row['case']] = (
            number,
            solve_contact(
                Contact(
                    radius_x=number['Rx_mm'] * 1e-3,
                    radius_y=number['Ry_mm'] * 1e-3,
                    reduced_modulus=number['E_reduced_GPa'] * 1e9,
                ),
                ContactLubricant(
                    viscosity=number['eta0_Pa_s'],
                    pressure_viscosity=number['alpha_1_Pa'],
                    **stress,
                ),
                Condition(load=number['load_N'], entrainment_speed=number['speed_m_s']),
                settings=Settings(nx=nx, ny=ny, domain=(-4.5, 1.5, 2.0 if ellipse else 3.0)),
            ),
        )
    return solved


@pytest.fixture(scope='session')
def moes_case():
    """Return contact, oil, condition and film unit of a circular contact in Moes groups."""

    def case(
        moes_load,
        moes_material,
        fluid,
        radius=0.0127,
        modulus=226.4e9,
        viscosity=0.04,
        pressure_viscosity=2.2e-8,
    ):
        speed = (moes_material / (pressure_viscosity * modulus)) ** 4
        return (
            Contact(radius_x=radius, radius_y=radius, reduced_modulus=modulus),
            ContactLubricant(
                viscosity=viscosity, pressure_viscosity=pressure_viscosity, law=fluid
            ),
            Condition(
                load=moes_load * modulus * radius**2 * speed**0.75,
                entrainment_speed=speed * modulus * radius / (2 * viscosity),
            ),
            radius * speed**0.5,
        )

    return case


@pytest.fixture(scope='session')
def nominal():
    """Return contact and oil of the nominal ball on screw contact."""
    return (
        Contact(radius_x=2.589e-3, radius_y=77.39e-3, reduced_modulus=226.4e9),
        ContactLubricant(viscosity=0.06, pressure_viscosity=2.0e-8),
    )


@pytest.fixture(scope='session')
def solved(nominal):
    return solve_contact(*nominal, Condition(load=27.6, entrainment_speed=0.5))


@pytest.fixture(scope='session')
def raceway():
    """Return heights z(x, y) of sixty self-affine waves of 30 to 120 um, 0.12 um rms."""
    rng = np.random.default_rng(1)
    number = 2 * np.pi / np.exp(rng.uniform(np.log(30e-6), np.log(120e-6), 60))
    angle, phase = rng.uniform(0, np.pi, 60), rng.uniform(0, 2 * np.pi, 60)
    size = number**-0.8
    size *= 0.12e-6 / np.sqrt(0.5 * (size**2).sum())

    def heights(x, y):
        return sum(
            a * np.cos(k * (np.cos(t) * x + np.sin(t) * y) + p)
            for a, k, t, p in zip(size, number, angle, phase)
        )

    return heights
