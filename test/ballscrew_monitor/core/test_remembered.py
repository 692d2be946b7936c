# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Nothing that a monitor has in mind is left out when it is taken over."""

from ballscrew_monitor.core.remembered import OWN, recall, remind
from ballscrew_monitor.core.snapshot import GIVEN

ELSEWHERE = {
    '_stays',  # event and pending
    '_reader',  # direction
    '_positions',  # of an axis that is judged by its monitor alone
    'shelving',  # nothing in a recording changes it
}


def test_all_that_changes_is_named(core):
    held = set(vars(core.monitor())) - set(GIVEN) - ELSEWHERE
    assert held == {f'_{name}' for name in OWN}


def test_the_parts_hold_nothing_else(core):
    monitor = core.monitor()
    assert set(vars(monitor._stays)) == {'event', '_pending'}
    assert set(vars(monitor._reader)) == {'_direction', '_held_load', '_speeds'}


def test_a_monitor_that_is_reminded_remembers(core):
    monitor = core.monitor()
    remembered = recall(monitor)
    monitor._judged, monitor._stamp = 7, 8
    remind(monitor, remembered)
    assert recall(monitor) == remembered
    assert (monitor.judged, monitor._stamp) == (0, 0)
