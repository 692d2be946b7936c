# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The product on twelve years of the independent generator."""

from ballscrew_monitor.health import words
from ballscrew_monitor.health.records import CauseCode
from health_parts import score
from health_parts.axis_year import axis_year
from health_parts.faults import FAULTS, LOOSENED
from health_parts.score import score_of
import pytest

CLEAN = range(5000, 5006)
LOST = range(5100, 5106)


@pytest.fixture(name='clean', scope='module')
def clean_years():
    return [score_of(axis_year(seed, wander=0.01, scatter=0.015), causes=False) for seed in CLEAN]


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


@pytest.mark.parametrize('fault', LOOSENED)
def test_lost_motion_is_a_witness_of_what_is_loose(fault, monkeypatch):
    """Beside the friction it leaves the nut and its support bearing, and nothing else."""
    told = []

    def explained(causes):
        told.append(words.explained(causes))
        return told[-1]

    monkeypatch.setattr(score, 'explained', explained)
    judged = score_of(axis_year(2, LOOSENED[fault], scale=True))
    assert (judged.told, judged.right) == (True, True)
    codes = {cause.code for cause in told[-1][1]}
    assert codes <= {CauseCode.PRELOAD_LOST, CauseCode.WIPER}
