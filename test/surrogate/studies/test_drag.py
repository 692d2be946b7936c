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


def test_trends_of_measured_papers():
    """The heavier the load, the better; torque turns up towards slow and fast speeds."""
    assert all(1 < ratio < 1.5 for ratio in drag.efficiency_over_load(None))
    assert all(1.05 < branch < 10 for branch in drag.stribeck_branches(ValidationCase()))
