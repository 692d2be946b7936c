# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A fault begins on its day, ends where it says, and moves its part alone."""

from dataclasses import fields, replace

from health_parts.faults import CLEAN, FAULTS, joined
from health_parts.machine import Condition, MOUNTED
import numpy as np
import pytest


@pytest.mark.parametrize('fault', FAULTS.values(), ids=FAULTS)
def test_only_the_part_moves(fault):
    condition = fault.condition(np.array([0.0, 181.0, 300.0]))
    for field in fields(Condition):
        mounted = getattr(MOUNTED, field.name)
        expected = [mounted, mounted, fault.size if field.name == fault.part else mounted]
        assert np.broadcast_to(getattr(condition, field.name), 3) == pytest.approx(expected)


def test_ramp_is_straight_over_eight_weeks():
    ramp = FAULTS['preload -40 %']
    days = ramp.start + np.array([-1.0, 0.0, 14.0, 28.0, 56.0, 99.0])
    assert ramp.progress(days) == pytest.approx([0.0, 0.0, 0.25, 0.5, 1.0, 1.0])


def test_step_is_there_on_its_day():
    step = replace(FAULTS['preload -40 %'], ramp=0.0)
    assert step.progress(step.start + np.array([-1e-9, 0.0])) == pytest.approx([0.0, 1.0])


def test_clean_axis_is_as_mounted():
    assert CLEAN.condition(np.array([300.0])) == MOUNTED


def test_conditions_join():
    both = joined(Condition(preload=0.8, zero=0.1), Condition(preload=0.5, wiper=2.0, zero=0.2))
    assert both == replace(MOUNTED, preload=0.4, wiper=2.0, zero=pytest.approx(0.3))
