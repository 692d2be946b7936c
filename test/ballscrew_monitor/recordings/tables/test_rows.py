# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of messages are what messages one by one are serialised to."""

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.recordings.tables.rows import BLOCK, marks, RowTemplate
import numpy as np
from sensor_msgs.msg import JointState

SECOND = 10**9


def test_rows_are_those_of_one_by_one_to_the_last_bit():
    count = BLOCK + 3
    stamps = np.arange(count, dtype=np.int64) * 123_456_789 + 1_999_999_999 * SECOND
    numbers = [np.linspace(-1e3, 1e3, count), np.full(count, np.nan), np.arange(2.0 * count)[::2]]
    first, second, third = marks(3)
    shape = JointState(name=['x', 'long_name'], velocity=[first, second], effort=[third])
    made = list(RowTemplate(shape, 3).rows(stamps, numbers))
    assert len(made) == count
    for row in (0, 1, BLOCK - 1, BLOCK, count - 1):
        message = JointState(name=['x', 'long_name'])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(stamps[row]), SECOND)
        message.velocity = [float(numbers[0][row]), float(numbers[1][row])]
        message.effort = [float(numbers[2][row])]
        assert made[row] == serialized(message)
