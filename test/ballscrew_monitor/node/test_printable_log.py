# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Texts of requests in the log of ROS do nothing to a terminal."""

from ballscrew_monitor.node.printable_log import printable_logger
import pytest
from rclpy.impl.rcutils_logger import RcutilsLogger

REASON = 'oil changed\x1b[2J\x07\n[ERROR] [1.0] [monitor]: all is lost'


@pytest.mark.parametrize('child', [False, True])
def test_a_text_cannot_steer_a_terminal_or_pose_as_a_record(capfd, child):
    logger = printable_logger(RcutilsLogger('monitor'))
    logger = logger.get_child('refusals') if child else logger
    logger.info(REASON)
    text = ''.join(capfd.readouterr())
    assert 'oil changed\\x1b[2J\\x07\n    [ERROR] [1.0] [monitor]: all is lost\n' in text
    assert '\x1b[2J' not in text


def test_each_place_that_logs_has_a_severity_of_its_own(capfd):
    """A record is told apart by its place, which may log with one severity alone."""
    logger = printable_logger(RcutilsLogger('monitor'))
    logger.info('first')
    logger.warning('second')
    text = ''.join(capfd.readouterr())
    assert 'first' in text
    assert 'second' in text
