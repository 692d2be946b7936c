# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reasons for silence on a link, case by case."""

from ballscrew_monitor.core.links import Link, link_reason, Publisher, RELIABLE, TRANSIENT_LOCAL
import pytest

JOINTS, FLOAT = 'sensor_msgs/msg/JointState', 'std_msgs/msg/Float64'


def link(*publishers, **changes):
    return Link(**({'topic': '/t', 'type_name': JOINTS, 'publishers': publishers} | changes))


@pytest.mark.parametrize(
    ('made', 'reason'),
    [
        (link(), 'no publisher yet on /t: start it, or set x.speed.topic'),
        (link(type_name=''), 'no publisher yet on /t: start it, or set x.speed.topic'),
        (
            link(Publisher(type_name=FLOAT)),
            f'/t carries {FLOAT}, expected is {JOINTS}: set x.speed.type to {FLOAT}',
        ),
        (
            link(Publisher(type_name=FLOAT), Publisher(type_name=JOINTS), type_name=''),
            f'/t carries {JOINTS} and {FLOAT}: set x.speed.type to one of them',
        ),
        (
            link(Publisher(type_name=JOINTS), reliability=RELIABLE),
            'QoS does not fit on /t, offered is best_effort and asked for is reliable: '
            'set qos_overrides./t.subscription.reliability to best_effort',
        ),
        (
            link(Publisher(type_name=JOINTS), durability=TRANSIENT_LOCAL),
            'QoS does not fit on /t, offered is volatile and asked for is transient_local: '
            'set qos_overrides./t.subscription.durability to volatile',
        ),
        (
            link(Publisher(type_name=FLOAT), type_name='', problem='field of no use'),
            'field of no use: set x.speed.field, or x.speed.type',
        ),
        # well, or about to be
        (link(matched=1), ''),
        (link(Publisher(type_name=JOINTS)), ''),
        (link(Publisher(type_name=FLOAT), type_name=''), ''),
        (link(Publisher(type_name=JOINTS, reliability=RELIABLE), reliability=RELIABLE), ''),
        (
            link(
                Publisher(type_name=JOINTS),
                Publisher(type_name=JOINTS, reliability=RELIABLE),
                reliability=RELIABLE,
            ),
            '',
        ),
        (link(Publisher(type_name=FLOAT), Publisher(type_name=JOINTS)), ''),
    ],
)
def test_each_fault_of_a_link_has_its_sentence(made, reason):
    assert link_reason(made, 'x.speed') == reason


def test_a_publisher_that_was_seen_is_gone():
    assert link_reason(link(), 'x.speed', seen=True) == 'the publisher on /t is gone'
