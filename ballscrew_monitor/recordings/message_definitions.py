# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Text and hash of a message type, as a bag carries them, from the files that its package installs.

No ROS library is needed: `share/<package>/msg/<Name>.msg` is the text and the `.json` beside it
holds the RIHS01 hash and the names of all types inside.

"""

import functools
import json
import os
from pathlib import Path
import sys

from surrogate.files import InputError

SEPARATOR = '=' * 80


def message_definition(type_name: str) -> str:
    """
    Return the `ros2msg` text of a type such as `sensor_msgs/msg/JointState`.

    The definition of each type inside follows after a line of 80 `=` and its name. Raises
    InputError when the type is not installed.

    """
    names = [entry['type_name'] for entry in _described(type_name)]
    texts = [_share_file(type_name, 'msg').read_text()]
    for name in sorted(set(names) - {type_name}):
        package, _, leaf = name.split('/')
        texts.append(f'{SEPARATOR}\nMSG: {package}/{leaf}\n{_share_file(name, "msg").read_text()}')
    return ''.join(text if text.endswith('\n') else f'{text}\n' for text in texts)


def type_hash(type_name: str) -> str:
    """Return the RIHS01 hash of a message type; raises InputError when it is not installed."""
    for entry in _described(type_name):
        if entry['type_name'] == type_name:
            return str(entry['hash_string'])
    raise InputError(f'message type {type_name}: its description holds no hash')


@functools.lru_cache
def _described(type_name: str) -> tuple[dict[str, str], ...]:
    return tuple(json.loads(_share_file(type_name, 'json').read_text())['type_hashes'])


def _share_file(type_name: str, suffix: str) -> Path:
    parts = type_name.split('/')
    if len(parts) != 3:
        raise InputError(f'message type {type_name!r} is not of the form package/msg/Name')
    paths = os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
    prefixes = [*filter(None, paths), sys.prefix]
    for prefix in prefixes:
        path = Path(prefix) / 'share' / parts[0] / parts[1] / f'{parts[2]}.{suffix}'
        if path.is_file():
            return path
    raise InputError(f'message type {type_name} is not installed below {" or ".join(prefixes)}')
