# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of solved contacts: keys, friction against a table and in its limits, the page."""

from dataclasses import replace
import json

import numpy as np
import pytest
from surrogate.contact.case import CaseDomain, CaseGrid, CaseRoughness, load_case
from surrogate.contact.record import contact_page, contact_record, friction_coefficient, KEYS
from surrogate.contact.solve import solve_case
from surrogate.ehl import Settings, solve_contact
from surrogate.files import to_json

SMALL = replace(load_case('nominal_smooth'), grid=CaseGrid(nx=65, ny=33))


def table_case(rows, name, side):
    """Return a case of the table on its domain, on a grid fine enough for friction."""
    (found,) = (row for row in rows if row['case'] == name)
    row = {key: float(value) for key, value in found.items() if key != 'case' and value}
    return row, replace(
        SMALL,
        radius_x=1e-3 * row['Rx_mm'],
        radius_y=1e-3 * row['Ry_mm'],
        reduced_modulus=1e9 * row['E_reduced_GPa'],
        load=row['load_N'],
        entrainment_speed=row['speed_m_s'],
        viscosity=row['eta0_Pa_s'],
        pressure_viscosity=row['alpha_1_Pa'],
        eyring_stress=1e6 * row['tau0_MPa'],
        slide_roll_ratio=(row['srr_1'], row['srr_2']),
        domain=CaseDomain(inlet=-4.5, outlet=1.5, side=side),
        grid=CaseGrid(nx=385, ny=129),
    )


def test_the_record_has_the_declared_keys_and_friction_grows_with_slip():
    """All keys, JSON types; no slip, no friction; then monotonic, linear at first."""
    solution, _ = solve_case(SMALL)
    record = contact_record(SMALL, solution)
    assert record.keys() == KEYS.keys()
    assert record['grid'] == [65, 33]
    assert record['converged'] is True
    assert record['rcs'] == record['asperity_share'] == 0.0
    assert len(record['friction_coefficient']) == 3
    assert json.loads(json.dumps(record)) == record
    ratios = (0.0, 1e-9, 2e-9, 0.01, 0.1, 1.0)
    found = [friction_coefficient(solution, ratio, 0.1) for ratio in ratios]
    assert found[0] == 0.0
    assert found[2] == pytest.approx(2 * found[1], rel=1e-6)
    assert np.all(np.diff(found) > 0)


def test_what_did_not_converge_is_not_told():
    """The last iterate of a solve that stopped is no result: null, with the status as reason."""
    solution = solve_contact(
        SMALL.contact, SMALL.lubricant, SMALL.condition, settings=Settings(newton_limit=1)
    )
    record = to_json(contact_record(SMALL, solution))
    assert record.keys() == KEYS.keys()
    assert record['converged'] is False
    assert record['status'] == solution.status.value
    assert record['friction_coefficient'] == [None] * 3
    for key in ('central_film_m', 'minimum_film_m', 'rcs', 'asperity_share', 'rolling_force_N'):
        assert record[key] is None
    assert record['hertz_pressure_Pa'] > 0


@pytest.mark.parametrize(
    ('name', 'side'), [('steel_ball_on_flat', 3.0), ('ball_screw_ellipse', 2.0)]
)
def test_friction_and_films_of_the_table(table, name, side):
    """Friction within 3 %, central film within 1.5 %, rolling within 3 % on the domain stated."""
    row, case = table_case(table('ehl_dimensional.csv'), name, side)
    solution, _ = solve_case(case)
    record = contact_record(case, solution)
    assert record['converged']
    assert record['central_film_m'] == pytest.approx(1e-9 * row['hc_nm'], rel=0.015)
    assert record['friction_coefficient'] == pytest.approx([row['mu_1'], row['mu_2']], rel=0.03)
    if 'rolling_coefficient' in row:
        rolling = record['rolling_force_N'] / case.load
        assert rolling == pytest.approx(row['rolling_coefficient'], rel=0.03)


def test_a_dry_contact_has_boundary_friction():
    """At speed 0 asperities carry all: the boundary coefficient times RCS 1."""
    rough = CaseRoughness(rms=0.0, asperity_friction=0.13)
    case = replace(SMALL, entrainment_speed=0.0, slide_roll_ratio=(0.0, 0.02), roughness=rough)
    solution, _ = solve_case(case)
    record = contact_record(case, solution)
    assert record['rcs'] == pytest.approx(1.0, abs=1e-6)
    assert record['friction_coefficient'] == pytest.approx([0.0, 0.13], rel=1e-6)


def test_the_page_says_everything_a_person_asks(says):
    """Workshop units, one line each, the status last."""
    solution, surface = solve_case(SMALL)
    page = contact_page(contact_record(SMALL, solution), SMALL, solution, surface)
    assert page.splitlines()[0] == says('contact_2_5888')
    assert page.splitlines()[-1].startswith('  status: Converged')
    for words in ('roughness              none', 'central film           1', 'friction, slip 5 %'):
        assert words in page
