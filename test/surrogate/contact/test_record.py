# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of solved contacts: keys, friction against a table and in its limits, the page."""

from dataclasses import replace
import json

import numpy as np
import pytest
from surrogate.contact.case import CaseDomain, CaseGrid, CaseRoughness, load_case
from surrogate.contact.record import (
    contact_page,
    contact_record,
    friction_coefficient,
    KEYS,
    ROLLING_KEYS,
)
from surrogate.contact.solve import solve_case
from surrogate.ehl import Settings, solve_contact
from surrogate.ehl.moving import MarchStatus, MovingSolution
from surrogate.files import json_text, to_json

AVERAGED = (
    *'rcs asperity_share mean_film_m film_rms_m least_film_m max_pressure_Pa hard_share'.split(),
    *'film_traction rolling_force_N smooth_rolling_force_N central_film_m film_ratio'.split(),
    *'memory_length_m'.split(),
)
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
    record = contact_record(SMALL, solution, None)
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
    record = to_json(contact_record(SMALL, solution, None))
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
    record = contact_record(case, solution, None)
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
    record = contact_record(case, solution, None)
    assert record['rcs'] == pytest.approx(1.0, abs=1e-6)
    assert record['friction_coefficient'] == pytest.approx([0.0, 0.13], rel=1e-6)


def test_the_page_says_everything_a_person_asks(says):
    """Workshop units, one line each, the status last."""
    solution, surface = solve_case(SMALL)
    page = contact_page(contact_record(SMALL, solution, None), SMALL, solution, surface)
    assert page.splitlines()[0] == says('contact_2_5888')
    assert page.splitlines()[-1].startswith('  status: Converged')
    for words in ('roughness              none', 'central film           1', 'friction, slip 5 %'):
        assert words in page


def strict(record):
    """Return a record as it is read from its JSON."""
    return json.loads(json_text(record))


def test_the_record_of_a_march_is_strict_json(rolling_case, marched, says):
    """Lambda is the smooth central film over the whole Rq; shares are in order."""
    record = contact_record(rolling_case, *marched)
    averages = {key for key in record if '_standard_error' not in key}
    assert averages == ROLLING_KEYS.keys()
    assert {'rcs_standard_error', 'mean_film_standard_error_m'} <= record.keys()
    assert strict(record)['strip_width_m'] is None
    assert record['kinematics'] == 'rolling'
    assert record['grid'] == [65, 33]
    assert record['converged'] is True
    solution, surface = marched
    record = contact_record(rolling_case, solution, surface)
    assert record['film_ratio'] == pytest.approx(solution.central_film / 0.1e-6)
    expected = solution.memory * solution.x_nodes[-1] / solution.x[-1]
    assert record['memory_length_m'] == pytest.approx(expected, rel=1e-6)
    assert record['thin_film_m'] == [1e-9, 3e-9, 5e-9, 10e-9]
    assert np.all(np.diff(record['thin_share']) >= 0)
    assert record['rcs'] >= record['asperity_share'] > 0
    assert record['rcs_standard_error'] > 0
    rough = record['roughness']
    assert rough['sentence'].startswith(says('rq_0_1'))
    assert rough['sentence'].endswith('are left out')
    assert rough['cutoff_by_table'] is False
    assert rough['fractal_roughness_m'] > 0
    assert rough['shortest_wavelength_m'] >= 20e-6


def test_the_ball_counts_in_the_film_ratio_and_one_place_has_no_error(rolling_case, marched):
    rough = replace(rolling_case.roughness, ball_rms=0.05e-6)
    record = contact_record(replace(rolling_case, roughness=rough), *marched)
    assert record['roughness']['rms_m'] == pytest.approx(np.hypot(0.1e-6, 0.05e-6))
    assert 'ball Rq 0.05 um' in record['roughness']['sentence']
    solution, surface = marched
    rcs = replace(solution.rcs, error=float('nan'))
    one = replace(solution, rcs=rcs)
    record = contact_record(rolling_case, one, surface)
    assert strict(record)['rcs_standard_error'] is None
    (line,) = [
        line
        for line in contact_page(record, rolling_case, one, surface).splitlines()
        if line.startswith('  RCS')
    ]
    assert '+-' not in line


def test_what_was_not_averaged_is_null_and_the_page_says_all_a_person_asks(
    rolling_case, marched, says
):
    """A march without a smooth film has a status and no numbers; the page has workshop units."""
    solution, surface = marched
    inputs = {
        one: getattr(solution, one) for one in ('contact', 'lubricant', 'condition', 'settings')
    }
    bare = MovingSolution(**inputs, status=MarchStatus.NO_SMOOTH_FILM)
    record = strict(contact_record(rolling_case, bare, surface))
    assert record['converged'] is False
    assert record['status'] == MarchStatus.NO_SMOOTH_FILM.value
    assert [record[key] for key in AVERAGED] == [None] * len(AVERAGED)
    assert record['thin_share'] == [None] * 4
    record = contact_record(rolling_case, solution, surface)
    lines = contact_page(record, rolling_case, solution, surface).splitlines()
    assert lines[0].startswith(says('rolling_contact_10'))
    assert lines[-1] == f'  status: {solution.status.value}'
    names = [line[2:25].strip() for line in lines[1:-1]]
    assert names[-1] == 'march'
    assert {'smooth central film', 'RCS', 'asperity share', 'zone below 10 nm'} < set(names)
    assert 'nan' not in '\n'.join(lines)
