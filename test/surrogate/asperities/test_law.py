# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The asperity law: its curves at the onset and beyond both ends, contacts as sums of strips."""

from dataclasses import replace
import json
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.asperities.acting import speed_at_ratio, stated_waves, Waves
from surrogate.asperities.law import AsperityLaw, AT_REST, law_from_json, ONSET_RCS, shipped_law
from surrogate.ehl import Condition, ContactLubricant
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.line import line_at
from surrogate.parameters import load_screw

SCREW = load_screw('nominal')
CONTACT, LOAD, FLOOR = screw_contact(SCREW, 'screw'), 27.6, 3e-9
OIL = ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
ROUGH = stated_waves(SCREW.roughness, None)
SMOOTH = Waves(length=ROUGH.length, mean_square=0 * ROUGH.mean_square)
LAW = AsperityLaw(
    onset_ratio=1.5,
    film_floor=FLOOR,
    pressure=0.9e9,
    pressure_power=-0.4,
    log_speed=(-1.0, -0.5, 0.0, 0.5),
    rcs=(0.3, 0.08, 0.01, 0.0005),
    asperity_share=(0.25, 0.07, 0.008, 0.0004),
    loss_factor=(1.5, 1.3, 1.2, 1.1),
    deviation=0.1,
    standard_error=0.05,
    marches=8,
    shortest_wave=3e-6,
    source='made up',
)
ONSET = LAW.onset(ROUGH, CONTACT, LOAD, OIL, FLOOR)


def contact_at(speed, waves=ROUGH, law=LAW, floor=FLOOR):
    """Return what asperities do at an entrainment speed [m/s]."""
    return law.contact(waves, CONTACT, Condition(load=LOAD, entrainment_speed=speed), OIL, floor)


def test_the_curve_passes_its_nodes():
    """RCS 0.01 at the onset; the loss stays at its slow end and goes to 1 at its fast one."""
    found = LAW.at(np.array(LAW.log_speed))
    for name in ('rcs', 'asperity_share', 'loss_factor'):
        assert found[name] == pytest.approx(getattr(LAW, name))
    assert float(LAW.at(np.array(0.0))['rcs']) == pytest.approx(ONSET_RCS)
    loss = LAW.at(np.array([-9.0, 1.5, math.inf]))['loss_factor']
    assert loss == pytest.approx([1.5, 1 + 0.1 * math.exp(-1.0), 1.0])


def test_beyond_the_curve_all_touches_or_nothing():
    """At no speed RCS is 1; fast it goes on as a power of the speed, then is exactly 0."""
    found = LAW.at(np.array([-math.inf, -12.0, 1.0, 3.0, math.inf]))
    power = (0.0005 / 0.01) ** 2 * 0.01
    assert found['rcs'] == pytest.approx([1.0, 1.0, power, 0.0, 0.0], abs=1e-4)
    assert found['asperity_share'][[0, -1]].tolist() == [1.0, 0.0]
    assert found['rcs'][-2:].tolist() == [0.0, 0.0]


@given(x=st.floats(-20.0, 20.0), step=st.floats(1e-3, 3.0))
def test_contact_never_grows_with_the_speed(x, step):
    """RCS and share fall and stay between 0 and 1; share is no more than RCS."""
    found = LAW.at(np.array([x, x + step]))
    for values in (found['rcs'], found['asperity_share']):
        assert 0 <= values[1] <= values[0] <= 1
    assert (found['asperity_share'] <= found['rcs']).all()


@given(speed=st.floats(1e-5, 10.0), faster=st.floats(1.01, 10.0))
def test_contacts_touch_less_the_faster_they_roll(speed, faster):
    """The integral over the strips as each strip."""
    slow, fast = contact_at(speed), contact_at(faster * speed)
    assert 0 <= fast.rcs <= slow.rcs + 1e-12
    assert slow.rcs <= 1
    assert slow.asperity_share <= slow.rcs + 1e-12
    assert slow.rcs_deviation >= 0
    assert 1 - 1e-12 <= slow.loss_factor <= 1.5 + 1e-12


def test_rest_and_films_below_the_floor_touch_everywhere():
    """Whatever the roughness; a smooth raceway above the floor does not touch at all."""
    assert contact_at(0.0) == AT_REST
    for waves in (ROUGH, SMOOTH):
        assert contact_at(1e-6, waves).rcs == pytest.approx(1.0)
    none = contact_at(0.1, SMOOTH)
    assert (none.rcs, none.asperity_share, none.rcs_deviation) == (0.0, 0.0, 0.0)
    assert none.loss_factor == pytest.approx(1.0)
    assert LAW.onset(SMOOTH, CONTACT, LOAD, OIL, FLOOR) == 0.0
    assert contact_at(100 * ONSET).rcs == 0.0


def test_a_contact_is_between_its_extreme_strips():
    """RCS over it is a mean of its places; near the middle one if only lengths differ."""
    place = np.linspace(0.0, 0.999, 200)
    strips = line_at(CONTACT, LOAD, place)
    onsets = speed_at_ratio(ROUGH, strips, OIL, LAW.ratio(FLOOR, strips.max_pressure))
    for over in (0.4, 1.0, 1.5):
        strip = LAW.at(np.log(over * ONSET / onsets))['rcs']
        assert strip.min() <= contact_at(over * ONSET).rcs <= strip.max()
    even = replace(LAW, pressure_power=0.0)
    onset = even.onset(ROUGH, CONTACT, LOAD, OIL, FLOOR)
    assert contact_at(onset, law=even).rcs == pytest.approx(ONSET_RCS, rel=0.5)


def test_a_law_without_scatter_has_no_deviation():
    """And a wider scatter a larger one."""
    few, many = (
        contact_at(0.7 * ONSET, law=replace(LAW, deviation=d)).rcs_deviation for d in (0.0, 0.3)
    )
    assert few == 0.0
    assert many > contact_at(0.7 * ONSET).rcs_deviation > 0


@given(over=st.floats(0.3, 3.0), deviation=st.floats(0.0, 0.5))
def test_the_deviation_of_rcs_is_that_between_half_a_deviation_slower_and_faster(over, deviation):
    """An onset that is higher by a factor is a speed that is lower by it."""
    law, speed = replace(LAW, deviation=deviation), over * ONSET
    slower, faster = (contact_at(speed * math.exp(side * deviation)).rcs for side in (-0.5, 0.5))
    assert contact_at(speed, law=law).rcs_deviation == pytest.approx(slower - faster, abs=1e-12)


def test_the_ratio_goes_with_the_cube_root_of_the_floor():
    """Eight times the floor doubles the film at the onset, which comes at a higher speed."""
    assert float(LAW.ratio(FLOOR, 0.9e9)) == 1.5
    assert float(LAW.ratio(8 * FLOOR, 0.9e9)) == pytest.approx(3.0)
    assert LAW.onset(ROUGH, CONTACT, LOAD, OIL, 8 * FLOOR) > ONSET > 0


def test_the_ratio_is_a_power_of_the_pressure():
    """For many pressures at once, as the strips of a contact have them."""
    found = LAW.ratio(FLOOR, np.array([0.9e9, 1.8e9]))
    assert found == pytest.approx([1.5, 1.5 * 2**-0.4])


def test_a_law_survives_json():
    """As plain JSON there and back, as does the shipped one."""
    for law in (LAW, shipped_law()):
        assert law_from_json(json.loads(json.dumps(law.to_json()))) == law


def test_the_shipped_law_is_a_law():
    """Nodes rise through the onset, RCS falls; a ratio of about one."""
    law = shipped_law()
    assert (np.diff(law.log_speed) > 0).all()
    assert (np.diff(law.rcs) < 0).all()
    assert min(*law.rcs, *law.asperity_share) > 0
    assert float(law.at(np.array(0.0))['rcs']) == pytest.approx(ONSET_RCS, rel=0.01)
    assert 0.1 < law.onset_ratio < 10
    assert law.marches > 0
    assert law.source
