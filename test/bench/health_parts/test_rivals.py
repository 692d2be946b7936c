# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rivals look at the logs that the product has, where their libraries are installed."""

import importlib.util

from ballscrew_monitor.health.history import history_of
from health_parts import rivals
from health_parts.axis_year import axis_year
from health_parts.faults import FAULTS
from health_parts.summaries import cells_of_year
import pytest

INSTALLED = not rivals.missing()


@pytest.fixture(scope='module')
def history():
    year = axis_year(7001, FAULTS['preload -40 %'], wander=0.005, scatter=0.01)
    return history_of(cells_of_year(year), year.machine.size.lead)


def test_what_is_not_installed_is_named(monkeypatch):
    monkeypatch.setattr(importlib.util, 'find_spec', lambda name: None)
    assert rivals.missing() == ['statsmodels', 'ruptures']
    assert all(name in rivals.INSTALL for name in rivals.missing())


def test_each_log_has_a_look_and_the_first_ones_compare_nothing(history, monkeypatch):
    counts = []

    def look(until, first):
        counts.append((len(until.start), first))
        return rivals._look(until, -0.1, 0.01, first)

    seen = list(rivals._looks(history, look))
    assert [one.log for one in seen] == list(range(len(history.start)))
    assert not any(one.is_known for one in seen[:6])
    assert counts[0] == (7, 3)
    assert all(count - first >= rivals.NOW for count, first in counts)
    assert seen[-1].raised == -1
    assert seen[-1].low < -0.095 < seen[-1].high


@pytest.mark.skipif(not INSTALLED, reason='statsmodels or ruptures is not installed')
@pytest.mark.parametrize('name', ['MixedLM, statsmodels', 'PELT, ruptures'])
def test_a_rival_finds_a_large_loss(history, name):
    seen = list(rivals.rivals()[name](history))
    assert seen[-1].raised == -1
    assert -0.35 < seen[-1].change < -0.12
    assert not any(one.raised for one in seen[:7])
