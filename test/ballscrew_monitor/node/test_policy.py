# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The SROS2 policy against the graph of a running node."""

from pathlib import Path
import xml.etree.ElementTree as ElementTree

import pytest
from rclpy.action import get_action_server_names_and_types_by_node

CONFIG = Path(__file__).resolve().parents[3] / 'config'


@pytest.fixture
def policy():
    """Return the names of a kind that the policy allows for a use, in full."""
    profile = ElementTree.parse(CONFIG / 'sros2_policy.xml').find('.//profile')
    node = profile.get('ns') + profile.get('node')

    def allowed(kind, use):
        texts = [
            one.text.replace('~', node)
            for group in profile.findall(kind)
            if group.get(use) == 'ALLOW'
            for one in group
        ]
        assert len(set(texts)) == len(texts)
        return {text if text.startswith('/') else f'/{text}' for text in texts}

    return allowed


def test_the_policy_allows_all_that_the_node_has(node, policy):
    topics = {'x__temperature__topic': 'oil_temperature', 'x__torque__topic': 'motor_torque'}
    node.start(use_sim_time='true', x__plain_topics='true', **topics)
    node.until(lambda: node.lifecycle() == 'active')
    own = (node.name.strip('/'), '/')
    node.until(lambda: own in node.node.get_node_names_and_namespaces(), 'the node in the graph')
    of_graph = {
        ('topics', 'publish'): node.node.get_publisher_names_and_types_by_node,
        ('topics', 'subscribe'): node.node.get_subscriber_names_and_types_by_node,
        ('services', 'reply'): node.node.get_service_names_and_types_by_node,
    }
    for use, find in of_graph.items():
        node.until(lambda find=find: find(*own))
        found = {name for name, _ in find(*own) if '/_action/' not in name}
        assert found
        assert found <= policy(*use)
    node.until(lambda: get_action_server_names_and_types_by_node(node.node, *own))
    actions = {name for name, _ in get_action_server_names_and_types_by_node(node.node, *own)}
    assert actions == policy('actions', 'execute')
    assert set(topics.values()) <= {name.strip('/') for name in policy('topics', 'subscribe')}
