# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Random screws of a catalogue: both tiers say the same of the onset, or why there is no screw."""

import math

import pytest


@pytest.mark.parametrize('seed', [1000, 1001, 1003])
def test_both_tiers_have_the_onset_of_a_random_screw_at_one_speed(study, seed):
    found = study('random_screws').run(seed, closed=False)
    assert found.status.startswith(('Solved', 'refused'))
    assert found.status.startswith('refused') or found.full == pytest.approx(
        found.closed_form, rel=0.02
    )
    assert math.isfinite(found.load_N) or found.status.startswith('refused')
