# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Domains that the ports of this machine betray."""

from ballscrew_monitor.clients.surroundings import domains_of
from ballscrew_monitor.cycle.domain import LOCK_PARTICIPANT, port

HEAD = '  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt\n'


def table(*ports):
    return HEAD + ''.join(
        f'  {i}: 00000000:{number:04X} 00000000:0000 07\n' for i, number in enumerate(ports)
    )


def test_ports_tell_domains_and_the_lock_of_a_test_run_is_no_participant():
    ports = [port(0, 0), port(7, 3), port(7, 4), port(101, 0), 53, 40_000]
    assert domains_of(table(*ports)) == [0, 7, 101]
    assert domains_of(table(port(7, LOCK_PARTICIPANT))) == []
    assert domains_of('') == []
