# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record of an axis over a restart."""

import dataclasses

from ballscrew_monitor.core.memory import after_restart, AxisRecord, check_record
import pytest

KEPT = AxisRecord(axis='x', running_time_ns=5, angle_rad=7.5, event=7, stamp_ns=20, start_ns=10)


def test_an_event_that_was_interrupted_is_over():
    record = after_restart(dataclasses.replace(KEPT, active=True))
    assert record == dataclasses.replace(KEPT, ending='RESTARTED')
    assert after_restart(KEPT) is KEPT


@pytest.mark.parametrize('record', [KEPT, AxisRecord(axis='x')])
def test_a_record_of_a_node_is_taken(record):
    check_record(record)


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('running_time_ns', -1),
        ('energy_lost_J', -1.0),
        ('event', 2**32),
        ('cause', 'BAD_LUCK'),
        ('ending', 'LATE'),
    ],
)
def test_a_record_that_no_node_has_written_is_refused(name, value):
    with pytest.raises((ValueError, KeyError)):
        check_record(dataclasses.replace(KEPT, **{name: value}))
