# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The watcher of a solve, and the place that the solve states."""

import pytest
from surrogate.ehl.watch import at, Iteration, tell, watched


def test_without_a_watcher_nothing_happens_and_a_march_says_its_steps():
    tell(1, 0.5)
    seen = []
    with watched(seen.append):
        with at(step=3, steps=8):
            tell(5, 0.5)
        tell(1, 0.5)
    assert [(one.step, one.steps) for one in seen] == [(3, 8), (0, 0)]


def test_a_watcher_is_told_of_what_happens_in_its_context():
    seen = []
    with watched(seen.append):
        tell(1, 0.5)
        with at(nut=2), at(side=1, stage='rough contact'):
            tell(2, 0.25)
        tell(3, 0.125)
    tell(4, 0.0)
    assert seen == [
        Iteration(count=1, residual=0.5),
        Iteration(stage='rough contact', nut=2, side=1, count=2, residual=0.25),
        Iteration(count=3, residual=0.125),
    ]


def test_a_watcher_may_end_a_solve_and_leaves_nothing_behind():
    def stop(now):
        raise InterruptedError

    with pytest.raises(InterruptedError), watched(stop), at(nut=1):
        tell(1, 0.5)
    seen = []
    with watched(seen.append):
        tell(1, 0.5)
    assert seen[0].nut == 0
