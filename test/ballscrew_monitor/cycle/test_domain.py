# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A ROS domain of one's own."""

from collections import Counter
import socket

from ballscrew_monitor.cycle import domain as domains
from ballscrew_monitor.cycle.domain import free_domain, port


def test_ports_are_those_of_the_specification():
    # DDSI-RTPS 2.3, 9.6.1.1: PB + DG * domainId + d1 + PG * participantId.
    assert port(0, 0) == 7410
    assert port(42, 3) == 7400 + 250 * 42 + 10 + 2 * 3
    highest = port(domains.DOMAINS[-1], domains.LOCK_PARTICIPANT)
    assert highest < 32768  # from here on the kernel gives ports to clients


def test_a_domain_is_held_by_one_at_a_time_and_not_free_with_a_participant():
    with free_domain() as one, free_domain() as other:
        assert one != other
        assert {one, other} <= set(domains.DOMAINS)
    with free_domain() as found:
        with domains.held(found) as free:
            assert not free
    with domains.held(found) as free:
        assert free
    with free_domain() as found:
        assert domains.is_free(found)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
            participant.bind(('', port(found, 1)))
            assert not domains.is_free(found)
        assert domains.is_free(found)


def test_when_all_are_taken_it_says_so(monkeypatch, refused):
    with free_domain() as found:
        monkeypatch.setattr(domains, 'DOMAINS', range(found, found + 1))
        with refused('free_ros_domain'), free_domain():
            pass


def test_domains_are_drawn_at_random(monkeypatch):
    monkeypatch.setattr(domains, 'is_free', lambda number: True)
    found: Counter[int] = Counter()
    for _ in range(20):
        with free_domain() as number:
            found[number] += 1
    assert len(found) > 1
