# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Settings of the middleware in the environment, made before any of it is loaded.

A middleware that is not there ends the process in C, without a word that helps; a discovery
server without an address leaves it alone in the graph. So both are looked at first.

"""

from collections.abc import Mapping, MutableMapping
import os
from pathlib import Path
import re
import sys

from surrogate.files import InputError

DEFAULT = 'rmw_fastrtps_cpp'
FAST_DDS = (DEFAULT, 'rmw_fastrtps_dynamic_cpp')
CHOICE, SERVERS = 'RMW_IMPLEMENTATION', 'ROS_DISCOVERY_SERVER'
RANGE = 'ROS_AUTOMATIC_DISCOVERY_RANGE'
WHEELS = '_ROS_WHEELS_BOOTSTRAP_COMPLETE'
INDEX = Path('share', 'ament_index', 'resource_index', 'rmw_typesupport')
PROFILE = Path(__file__).with_name('loopback.xml')
PROFILE_VARIABLES = ('FASTRTPS_DEFAULT_PROFILES_FILE', 'FASTDDS_DEFAULT_PROFILES_FILE')
# Would take the discovery out of the hands of the profile.
UNSET = ('ROS_LOCALHOST_ONLY', 'ROS_STATIC_PEERS', 'ROS_SUPER_CLIENT', SERVERS)
SERVER_PORT = 11811
_SERVER = re.compile(
    r'(?:(?:UDPv4|UDPv6|TCPv4|TCPv6):)?(?:\[[^\]\s]+\]|[^\[\]:\s]+)(?::(?P<port>\d{1,5}))?'
)


def check_middleware(
    environment: Mapping[str, str] = os.environ, *, discovers: bool = True
) -> None:
    """
    Raise InputError for a middleware that is not there or a discovery server without an address.

    `discovers`: whether anything is to be found in the graph of the environment.

    """
    chosen, known = environment.get(CHOICE, ''), installed(environment)
    if chosen and known and chosen not in known:
        raise InputError(
            f'{CHOICE} is {chosen}, which is not installed, allowed is {", ".join(sorted(known))}'
            ': unset it, or install the package of that name'
        )
    servers = environment.get(SERVERS, '').split(';') if _is_fast_dds(environment) else []
    for server in filter(None, servers if discovers else ()):
        parts = _SERVER.fullmatch(server)
        if parts is None or not 0 < int(parts['port'] or SERVER_PORT) <= 0xFFFF:
            raise InputError(
                f'{SERVERS} names {server!r}, a server must be HOST:PORT such as '
                f'127.0.0.1:{SERVER_PORT}, several with a semicolon between them'
            )


def installed(environment: Mapping[str, str]) -> set[str]:
    """Return the names of the middlewares that can be loaded; empty if that is not known."""
    prefixes = [sys.prefix]
    if WHEELS not in environment:  # the wheels load their own, whatever else is sourced
        prefixes += filter(None, environment.get('AMENT_PREFIX_PATH', '').split(os.pathsep))
    names = {path.name for prefix in prefixes for path in Path(prefix, INDEX).glob('rmw_*')}
    return names - {'rmw_implementation'}


def _is_fast_dds(environment: Mapping[str, str]) -> bool:
    return environment.get(CHOICE, '') in ('', *FAST_DDS)


def loopback(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """
    Return the variables that bind all ports of FastDDS to 127.0.0.1.

    The profile does what the discovery range LOCALHOST does, and that would add sockets of its
    own. Other middlewares are given that range, which keeps discovery on this machine.

    """
    if not _is_fast_dds(environment):
        return {RANGE: 'LOCALHOST'}
    return (
        dict.fromkeys(PROFILE_VARIABLES, str(PROFILE))
        | dict.fromkeys(UNSET, '')
        | {RANGE: 'SYSTEM_DEFAULT', 'SKIP_DEFAULT_XML_FILE': '1'}
    )


def stay_local(environment: MutableMapping[str, str] = os.environ) -> None:
    """Bind all ports to 127.0.0.1 from now on; raises InputError where that cannot be."""
    if not _is_fast_dds(environment):
        raise InputError(
            f'parameter localhost is true, which needs {DEFAULT}, and {CHOICE} is '
            f'{environment[CHOICE]}: leave localhost out and confine that one by its own settings'
        )
    for name in (*PROFILE_VARIABLES, SERVERS):
        if environment.get(name, '') not in ('', str(PROFILE)):
            raise InputError(
                f'parameter localhost is true and {name} is {environment[name]}: unset one of them'
            )
    environment.update(loopback(environment))
