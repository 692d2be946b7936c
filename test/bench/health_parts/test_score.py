# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The product on twelve years of the independent generator."""

from health_parts.axis_year import axis_year
from health_parts.faults import FAULTS
from health_parts.score import score_of
import pytest

CLEAN = range(5000, 5006)
LOST = range(5100, 5106)


@pytest.fixture(name='clean', scope='module')
def clean_years():
    return [score_of(axis_year(seed, wander=0.01, scatter=0.015)) for seed in CLEAN]


@pytest.fixture(name='lost', scope='module')
def years_of_a_fault():
    fault = FAULTS['preload -40 %']
    return [score_of(axis_year(seed, fault, wander=0.01, scatter=0.015)) for seed in LOST]


def test_clean_years_have_no_alarm_and_intervals_that_hold(clean):
    assert sum(one.early for one in clean) == 0
    assert sum(one.held for one in clean) >= 0.9 * sum(one.known for one in clean)
    assert sorted(one.quarter for one in clean)[3] <= 0.045
    assert all(one.known >= 0.9 * one.looks for one in clean)


def test_a_lost_preload_is_found_with_its_cause(lost):
    found = [one for one in lost if one.found <= 70.0]
    assert len(found) >= 5
    assert sum(one.held for one in lost) >= 0.9 * sum(one.known for one in lost)
    assert all(one.right for one in found if one.told)
    assert sum(one.early for one in lost) == 0
