# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Where a node is: its domain and discovery, who else is there, and which domains are in use."""

import os
from pathlib import Path

from ballscrew_monitor.messages.doctor import Surroundings
from rclpy.node import Node

UDP = Path('/proc/net/udp')
PORTS, PER_DOMAIN, OFFSETS = 7400, 250, range(10, 60)  # DDSI-RTPS 2.3, 9.6.1
MOST_DOMAIN = 101  # above, the ports may be those of any client


def surroundings(node: Node) -> Surroundings:
    """Return what is seen around the node."""
    domain = node.context.get_domain_id()
    published = {
        name: tuple(types)
        for name, types in node.get_topic_names_and_types()
        if node.count_publishers(name)
    }
    return Surroundings(
        domain=domain,
        discovery=os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET').upper(),
        localhost_only=os.environ.get('ROS_LOCALHOST_ONLY') == '1',
        nodes=tuple(sorted(name for name in node.get_node_names() if name != node.get_name())),
        topics=published,
        domains=tuple(other for other in domains_of(_udp_table()) if other != domain),
        use_sim_time=bool(node.get_parameter('use_sim_time').value),
    )


def _udp_table() -> str:
    try:
        return UDP.read_text()
    except OSError:
        return ''


def domains_of(udp_table: str) -> list[int]:
    """Return the ROS domains whose ports a table of UDP sockets, as Linux writes it, shows."""
    found = set()
    for line in udp_table.splitlines()[1:]:
        port = int(line.split()[1].rpartition(':')[2], 16) - PORTS
        domain, offset = divmod(port, PER_DOMAIN)
        if 0 <= domain <= MOST_DOMAIN and offset in OFFSETS:
            found.add(domain)
    return sorted(found)
