# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reasons for silence on a link, case by case."""

from ballscrew_monitor.core.links import Link, link_reason, Publisher, RELIABLE, TRANSIENT_LOCAL
import pytest

JOINTS, FLOAT = 'sensor_msgs/msg/JointState', 'std_msgs/msg/Float64'
WILLING = Publisher(type_name=JOINTS, reliability=RELIABLE)


def link(*publishers, **changes):
    return Link(**({'topic': '/t', 'type_name': JOINTS, 'publishers': publishers} | changes))


@pytest.mark.parametrize(
    ('made', 'reason'),
    [
        (link(), 'no_publisher'),
        (link(type_name=''), 'no_publisher'),
        (link(Publisher(type_name=FLOAT)), 'other_type'),
        (link(Publisher(type_name=FLOAT), Publisher(type_name=JOINTS), type_name=''), 'two_types'),
        (link(Publisher(type_name=JOINTS), reliability=RELIABLE), 'reliability'),
        (link(Publisher(type_name=JOINTS), durability=TRANSIENT_LOCAL), 'durability'),
        (link(Publisher(type_name=FLOAT), type_name='', problem='field of no use'), 'field'),
        # well, or about to be
        (link(matched=1), ''),
        (link(Publisher(type_name=JOINTS)), ''),
        (link(Publisher(type_name=FLOAT), type_name=''), ''),
        (link(WILLING, reliability=RELIABLE), ''),
        (link(Publisher(type_name=JOINTS), WILLING, reliability=RELIABLE), ''),
        (link(Publisher(type_name=FLOAT), Publisher(type_name=JOINTS)), ''),
    ],
)
def test_each_fault_of_a_link_has_its_sentence(made, reason, says):
    assert link_reason(made, 'x.speed') == (reason and says(reason))


def test_a_publisher_that_was_seen_is_gone():
    assert link_reason(link(), 'x.speed', seen=True) == 'the publisher on /t is gone'
