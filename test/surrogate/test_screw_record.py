# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the full tier as a record, and the command that prints it."""

import json
import math

import pytest
from surrogate.ehl import Settings
from surrogate.nut import ScrewSettings
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.plain_json import to_json
from surrogate.point import closed_form_record, page
from surrogate.screw_record import full_record

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
SMALL = Settings(nx=65, ny=65, error_estimate=False)
SETTINGS = ScrewSettings(smooth=SMALL, rough=Settings(nx=65, ny=129, error_estimate=False))


def record(rpm, load, settings=SETTINGS):
    """Solve a point at 40 degC."""
    point = OperatingPoint(speed=rpm * math.pi / 30, load=load, temperature=313.15)
    return point, full_record(SCREW, OIL, point, settings)


def test_record_has_the_keys_of_the_formulas_and_is_plain_json():
    """One reader serves both tiers; the page prints it."""
    point, found = record(60, 800.0)
    formulas = closed_form_record(SCREW, OIL, point)
    assert formulas.keys() <= found.keys()
    assert formulas['contacts'][0].keys() <= found['contacts'][0].keys()
    assert found['tier'] == 'full'
    assert json.loads(json.dumps(to_json(found), allow_nan=False))
    assert '(estimate)' not in page(found)


def test_parts_of_the_contacts_add_up_to_the_torque():
    """Sliding and rolling of all four contacts are the friction torque without parasitic part."""
    _, found = record(60, 800.0)
    parts = sum(c['sliding_torque_Nm'] + c['rolling_torque_Nm'] for c in found['contacts'])
    assert parts == pytest.approx(found['friction_torque_Nm'], rel=1e-9)
    assert found['energy_error'] < 1e-8
    assert found['rcs'] == max(c['rcs'] for c in found['contacts'])
    worst = min(found['contacts'], key=lambda c: c['film_ratio'])
    assert found['worst_contact'] == {'nut': worst['nut'], 'side': worst['side']}


def test_friction_coefficient_lies_between_film_and_boundary():
    """At rest it is the boundary coefficient, with a film well below it."""
    _, rest = record(0, 500.0)
    _, moving = record(600, 500.0)
    assert rest['friction_coefficient'] == pytest.approx(
        SCREW.roughness.asperity_friction, rel=0.02
    )
    assert 0 < moving['friction_coefficient'] < 0.5 * rest['friction_coefficient']


def test_idle_nut_and_failure_give_a_reason():
    """No number without a contact, and none after a solve that failed."""
    _, idle = record(600, 3.0 * SCREW.preload)
    assert [bool(c['reason']) for c in idle['contacts']] == [False, False, True, True]
    assert idle['normal_force_relieved_N'] == 0.0
    failed = ScrewSettings(smooth=Settings(newton_limit=1), draw=None)
    _, none = record(600, 500.0, failed)
    assert 'smooth contact' in none['status']
    assert to_json(none)['efficiency'] is None
    assert none['contacts'][0]['reason'] == none['status']
