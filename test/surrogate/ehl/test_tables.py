# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Smooth contacts against the published and computed tables, each on its own domain."""

import numpy as np
import pytest
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.formulas.geometry import Contact


def test_circular_table(reference_rows, moes_case):
    """Films extrapolated from 129 and 257 nodes: 1 and 2 % up to M = 200, 2 and 4 % above."""
    for row in reference_rows('ehl_circular.csv'):
        load = float(row['M'])
        contact, oil, condition, unit = moes_case(load, float(row['L']), row['fluid'])
        domain = (-4.5, 1.5, 3.0) if load <= 100 else (-2.5, 1.5, 2.0)
        found = solve_contact(
            contact, oil, condition, settings=Settings(nx=257, ny=257, domain=domain)
        )
        slack = 1 if load <= 200 else 2
        assert found.converged, found.status.value
        assert found.rcs == found.asperity_share == 0.0
        assert found.extrapolated_film == pytest.approx(float(row['Hc']) * unit, rel=0.01 * slack)
        assert found.extrapolated_minimum == pytest.approx(
            float(row['Hm']) * unit, rel=0.02 * slack
        )
        assert abs(found.central_film / (float(row['Hc']) * unit) - 1) == pytest.approx(
            found.film_error, abs=4e-3
        )


def test_dimensional_table(reference_rows):
    """Central film 1.5 %, minimum 2.5 % (ellipse 4 %), rolling 3 % on the domain of the table."""
    for row in reference_rows('ehl_dimensional.csv'):
        number = {key: float(text) for key, text in row.items() if key != 'case' and text}
        ellipse = row['case'] == 'ball_screw_ellipse'
        nx, ny = (513, 129) if ellipse else (257, 257)
        settings = Settings(nx=nx, ny=ny, domain=(-4.5, 1.5, 2.0 if ellipse else 3.0))
        found = solve_contact(
            Contact(
                radius_x=number['Rx_mm'] * 1e-3,
                radius_y=number['Ry_mm'] * 1e-3,
                reduced_modulus=number['E_reduced_GPa'] * 1e9,
            ),
            ContactLubricant(
                viscosity=number['eta0_Pa_s'], pressure_viscosity=number['alpha_1_Pa']
            ),
            Condition(load=number['load_N'], entrainment_speed=number['speed_m_s']),
            settings=settings,
        )
        assert found.converged, found.status.value
        assert found.central_film * 1e9 == pytest.approx(number['hc_nm'], rel=0.015)
        assert found.minimum_film * 1e9 == pytest.approx(
            number['hmin_nm'], rel=0.04 if ellipse else 0.025
        )
        if 'pmax_hertz_GPa' in number:
            assert found.hertz_pressure * 1e-9 == pytest.approx(number['pmax_hertz_GPa'], rel=1e-3)
        if 'rolling_coefficient' in number:
            assert found.rolling_force / number['load_N'] == pytest.approx(
                number['rolling_coefficient'], rel=0.03
            )


def test_grid_convergence_table(reference_rows, moes_case):
    """M = 20, L = 10, Barus: each grid to 0.5 %, and order 2."""
    contact, oil, condition, _ = moes_case(20.0, 10.0, 'barus_incompressible')
    films = []
    for row in reference_rows('ehl_grid_convergence.csv')[:4]:
        nodes = int(row['n']) + 1
        found = solve_contact(
            contact,
            oil,
            condition,
            settings=Settings(nx=nodes, ny=nodes, domain=(-4.5, 1.5, 3.0), error_estimate=False),
        )
        films.append(found.central_film * contact.radius_x / found.semi_axis_x**2)
        lowest = found.minimum_film * contact.radius_x / found.semi_axis_x**2
        assert found.converged, found.status.value
        if int(row['n']) > 64:
            assert films[-1] == pytest.approx(float(row['Hc']), rel=5e-3)
            assert lowest == pytest.approx(float(row['Hm']), rel=5e-3)
    steps = np.diff(films)
    assert np.log2(steps[:-1] / steps[1:]) == pytest.approx([2.0, 2.0], abs=0.15)
