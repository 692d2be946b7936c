# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Finding a ROS domain of one's own."""

from collections import Counter
import socket

from ballscrew_monitor.cycle import domain
import pytest
from surrogate.files import InputError


def test_ports_are_those_of_the_specification():
    # DDSI-RTPS 2.3, 9.6.1.1: PB + DG * domainId + d1 + PG * participantId.
    assert domain.port(0, 0) == 7410
    assert domain.port(42, 3) == 7400 + 250 * 42 + 10 + 2 * 3
    highest = domain.port(domain.DOMAINS[-1], domain.LOCK_PARTICIPANT)
    assert highest < 32768  # from here on the kernel gives ports to clients


def test_two_at_a_time_get_different_domains():
    with domain.free_domain() as one, domain.free_domain() as other:
        assert one != other
        assert {one, other} <= set(domain.DOMAINS)


def test_a_domain_with_a_participant_is_not_free():
    with domain.free_domain() as found:
        assert domain.is_free(found)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
            participant.bind(('', domain.port(found, 1)))
            assert not domain.is_free(found)
        assert domain.is_free(found)


def test_a_domain_is_held_by_one_at_a_time():
    with domain.free_domain() as found:
        with domain.held(found) as free:
            assert not free
    with domain.held(found) as free:
        assert free


def test_when_all_are_taken_it_says_so(monkeypatch):
    with domain.free_domain() as found:
        monkeypatch.setattr(domain, 'DOMAINS', range(found, found + 1))
        with pytest.raises(InputError, match='no free ROS domain'), domain.free_domain():
            pass


def test_domains_are_drawn_at_random(monkeypatch):
    monkeypatch.setattr(domain, 'is_free', lambda number: True)
    found: Counter[int] = Counter()
    for _ in range(20):
        with domain.free_domain() as number:
            found[number] += 1
    assert len(found) > 1
