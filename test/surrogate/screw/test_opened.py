# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A screw opened for its solvers: once for each sheet, its sides apart, the law when asked for."""

from dataclasses import fields, replace
import math

import pytest
from surrogate.asperities import law
from surrogate.parameters import load_screw
from surrogate.screw.opened import Contacts

SCREW = load_screw('nominal')


def test_equal_sheets_are_opened_once_and_without_the_law(monkeypatch):
    """The law takes seconds, and a solve without asperities does not ask for it."""
    monkeypatch.setattr(law, 'onset_of', None)
    sheet = replace(SCREW, roughness=replace(SCREW.roughness, asperity_friction=0.123))
    opened = Contacts.of(sheet)
    assert Contacts.of(replace(sheet)) is opened
    with pytest.raises(TypeError):
        _ = opened.law


def test_each_side_has_its_conformity():
    """1/Ry of a groove is 1/r_b - 1/r_g; along the track screw and nut curve to either side."""
    opened = Contacts.of(replace(SCREW, conformity_screw=0.52, conformity_nut=0.56))
    ball = 0.5 * SCREW.ball_diameter
    for side, conformity in (('screw', 0.52), ('nut', 0.56)):
        across = 1 / ball - 1 / (conformity * SCREW.ball_diameter)
        assert opened.geometry[side].radius_y == pytest.approx(1 / across)
    assert opened.geometry['screw'].radius_x < ball < opened.geometry['nut'].radius_x
    pressures = {side: contact.working_pressure for side, contact in opened.running.items()}
    assert opened.working_pressure == max(pressures.values()) == pressures['nut']


def test_a_running_contact_holds_what_the_topography_depends_on_alone():
    """A larger load and a coarser profile change it; friction, seals and ratings do not."""
    same = {'name': 'other', 'static_rating': 1e5, 'parasitic_torque': 0.3, 'speed_limit': 5.0}
    usual = Contacts.of(SCREW).running
    assert Contacts.of(replace(SCREW, **same)).running == usual
    sheet = replace(SCREW.roughness, onset_factor=1.3, asperity_friction=0.2)
    assert Contacts.of(replace(SCREW, roughness=sheet)).running == usual
    heavy = Contacts.of(replace(SCREW, working_load=2 * Contacts.of(SCREW).working_load)).running
    for side, contact in usual.items():
        changed = {
            spec.name
            for spec in fields(contact)
            if getattr(contact, spec.name) != getattr(heavy[side], spec.name)
        }
        assert changed == {'working_load', 'working_pressure'}
        assert heavy[side].working_pressure < 2 * contact.working_pressure
        assert math.isfinite(contact.half_length)
