# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A point of the closed-form tier as a record: warnings on their limits, and its numbers."""

from dataclasses import replace
import math

import pytest
from surrogate.formulas.load_sharing import UNLOADING_RATIO
from surrogate.parameters import OperatingPoint
from surrogate.screw import closed_form
from surrogate.screw.closed_form_record import closed_form_record, page
from surrogate.screw.opened import Contacts
from surrogate.screw.record import rating_warnings
from surrogate.units import RPM, ZERO_CELSIUS

REST = OperatingPoint(speed=0.0, load=0.0, temperature=313.15)


@pytest.fixture
def warned(screw, oil):
    """Return the function that tells which warnings a point at given numbers has."""

    def begins(made=screw, lubricant=oil, **place):
        found = rating_warnings(made, lubricant, replace(REST, **place))
        return [text.split(':')[0] for text in found]

    return begins


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_what_is_allowed_is_not_warned_of(warned, screw, oil, sign):
    above = lambda value: math.nextafter(value, math.inf)  # noqa: E731
    speed = 50.0
    held = replace(screw, speed_limit=speed * 2 * screw.pitch_radius)
    assert warned(held, speed=sign * speed) == []
    assert warned(held, speed=sign * above(speed)) == ['speed']
    stiff = replace(screw, static_rating=2000.0)
    assert warned(stiff, load=sign * 2000.0) == []
    assert warned(stiff, load=sign * above(2000.0)) == ['load']
    unloads = UNLOADING_RATIO * screw.preload
    assert warned(load=sign * math.nextafter(unloads, 0.0)) == []
    assert warned(load=sign * unloads) == ['load']
    assert warned(replace(screw, preload=0.0), load=sign * unloads) == []
    for end, beyond in ((oil.minimum_temperature, 0.0), (oil.maximum_temperature, math.inf)):
        assert warned(temperature=end) == []
        assert warned(temperature=math.nextafter(end, beyond)) == ['temperature']


def test_a_warning_says_the_value_and_what_is_allowed(screw, oil):
    point = OperatingPoint(speed=3000 * RPM, load=60000.0, temperature=110 + ZERO_CELSIUS)
    speed, load, _, temperature = rating_warnings(screw, oil, point)
    assert speed.startswith('speed: D n is 96')
    assert load.startswith('load: 60000 N, the static rating is 55000 N')
    assert temperature.startswith('temperature: 110 degC, the oil sheet covers 0 to 100 degC')


@pytest.mark.parametrize('load', [800.0, -800.0, 0.0])
def test_a_record_holds_the_numbers_of_its_solve(screw, oil, load):
    point = replace(REST, speed=60.0, load=load)
    record, found = (
        closed_form_record(screw, oil, point),
        closed_form.solve(Contacts.of(screw), oil, 60.0, load, 313.15),
    )
    assert record['friction_torque_Nm'] == float(found.friction_torque)
    ideal = load * screw.lead / math.tau
    assert record['driving_torque_Nm'] == pytest.approx(ideal + float(found.friction_torque))
    forces = record['normal_force_loaded_N'], record['normal_force_relieved_N']
    assert forces == tuple(float(found.contacts[place].normal_force) for place in (0, 2))
    assert (forces[0] > forces[1]) is (load != 0.0)
    assert 0.0 <= record['wall_s'] < 600.0
    lines = page(record)
    assert ('load drives the screw' in lines) is (load < 0.0)
    assert '(estimate)' in lines
    assert '  contact: ' not in lines
    assert '  contact: by hand' in page(record | {'asperity_law': 'by hand', 'tier': 'full'})


def test_a_nut_without_load_has_no_film_and_says_so(screw, oil):
    point = replace(REST, speed=60.0, load=3.0 * screw.preload)
    contacts = closed_form_record(screw, oil, point)['contacts']
    assert [bool(one['reason']) for one in contacts] == [False, False, True, True]
    assert [one['normal_force_N'] > 0.0 for one in contacts] == [True, True, False, False]
