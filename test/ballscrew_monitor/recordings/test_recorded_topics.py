# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a run."""

from ballscrew_monitor.recordings.bag_writer import Offer
from ballscrew_monitor.recordings.recorded_topics import recorded_topics
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_monitor.settings.topics import output


def test_the_latched_topics_come_last():
    topics = recorded_topics(defaults(['x', 'y']))
    names = [topic.name for topic in topics]
    assert names[:2] == ['/joint_states', '/axial_load']
    assert names[-1] == output('y', 'surface_info') == '/ballscrew_monitor/y/surface_info'
    latched = [topic.offer is Offer.LATCHED for topic in topics]
    assert latched == sorted(latched)
    assert len(names) == len(set(names)) == 2 + 2 + 1 + 4
