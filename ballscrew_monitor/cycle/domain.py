# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A ROS domain that nobody on this machine uses: found and kept.

Every DDS participant listens on UDP ports that follow from its domain and its number in it
(DDSI-RTPS 2.3, 9.6.1), so a port that cannot be bound betrays a participant. The port of a
number that no participant reaches serves as a lock between two runs that look at the same time;
it is set free whatever happens to the process.

"""

from collections.abc import Iterator
import contextlib
import random
import socket

from surrogate.files import InputError

DOMAINS = range(1, 101)  # 0 is everybody's default; above, ports may be taken by any client
PORT_BASE, DOMAIN_GAIN, UNICAST_OFFSET, PARTICIPANT_GAIN = 7400, 250, 10, 2
PARTICIPANTS = range(10)  # numbers looked at; they are given out from 0
LOCK_PARTICIPANT = 119
LOOPBACK = '127.0.0.1'


def port(domain: int, participant: int) -> int:
    """Return the UDP port on which a participant of a domain listens for discovery."""
    return PORT_BASE + DOMAIN_GAIN * domain + UNICAST_OFFSET + PARTICIPANT_GAIN * participant


def is_free(domain: int) -> bool:
    """Return True if no participant on this machine listens in `domain`."""
    for participant in PARTICIPANTS:
        bound = _bind(port(domain, participant))
        if bound is None:
            return False
        bound.close()
    return True


@contextlib.contextmanager
def held(domain: int) -> Iterator[bool]:
    """Hold a domain, if it is free; yield True if it is."""
    lock = _bind(port(domain, LOCK_PARTICIPANT), LOOPBACK)
    if lock is None:
        yield False
        return
    with lock:
        yield is_free(domain)


@contextlib.contextmanager
def free_domain() -> Iterator[int]:
    """Give a free domain and hold it; raises InputError when all are taken."""
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        with held(domain) as free:
            if free:
                yield domain
                return
    raise InputError(
        f'no free ROS domain among {DOMAINS[0]} to {DOMAINS[-1]}, '
        'end some of the programs that use one'
    )


def _bind(number: int, address: str = '') -> socket.socket | None:
    """Return a socket bound to a UDP port, None when somebody has it on any address."""
    bound = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        bound.bind((address, number))
    except OSError:
        bound.close()
        return None
    return bound
