# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Efficiencies and torques that stand beside those of makers and of measurements."""

import math

import pytest
from surrogate.parameters import load_screw
from surrogate.studies import drag
from surrogate.studies.validation import ValidationCase

pytestmark = pytest.mark.usefixtures('small_tiles')


def test_efficiency_under_a_tenth_of_c():
    """What preload and drag take beside the load is 4 to 15 %, F L/(2 pi) over all torque."""
    whole, of_load = drag.efficiency_with_drag(None), drag.efficiency_of_load(None)
    for name, less, more in zip(drag.SIZES, whole, of_load, strict=True):
        screw = load_screw(name)
        ideal = 0.1 * screw.dynamic_rating * screw.lead / (2 * math.pi)
        lost, of_contacts = ideal / less - ideal, ideal / more - ideal
        assert lost - screw.typical_drag > of_contacts > 0
        assert 0.03 < more - less < 0.2


def test_efficiency_over_the_load():
    """Between that of a constant drag and of twice it: contacts take less than the drag does."""
    for name, ratio in zip(drag.SIZES, drag.efficiency_over_load(None), strict=True):
        screw = load_screw(name)
        share = 2 * math.pi * screw.typical_drag / (screw.preload * screw.lead)
        low, high = ((1 + lost) / (1 + lost / 4) for lost in (share, 2 * share))
        assert low < ratio < high


def test_torque_falls_when_slow_and_rises_when_fast():
    """Shear of a film of the power 0.7 of the speed rises with 0.3, rolling with 0.7 of it."""
    falling, rising = drag.stribeck_branches(ValidationCase())
    assert 0 < falling < 1
    assert 0.3 < rising < 0.7


def test_told_over_measured_torque_rises_with_the_diameter():
    """The drag of catalogues goes with the root of the circle over the lead."""
    told = drag.drag_over_measured(None)
    first, second = told[:3], told[3:]
    assert first == sorted(first)
    one, other = drag.XJTU_TORQUES
    assert [small / big for small, big in zip(second, first)] == pytest.approx([one / other] * 3)
    assert first[2] / first[0] == pytest.approx(math.sqrt(40 / 25), rel=0.1)
