# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mask over texts that leave this machine: it hides hosts, users and their homes, persons and tokens.

Each is replaced by a word for its kind, so that a reader sees what stood there.

"""

from collections import Counter
from collections.abc import Collection, Iterable
import contextlib
import enum
import functools
import getpass
import json
import os
from pathlib import Path
import pwd
import re
import socket
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_msgs.msg import AxisHealth, BallScrewState, OutOfZone
from rclpy.serialization import deserialize_message

LEAST = 2  # characters of a name that is looked for: a single one is in every text


class Secret(enum.StrEnum):
    """Kind of what is hidden, and the word that takes its place."""

    HOST = 'HOST'
    USER = 'USER'
    NAME = 'NAME'
    TOKEN = 'TOKEN'


ALWAYS = {
    Secret.USER: r'(?:(?<=/home/)|(?<=/Users/)|(?<=\\Users\\))[^/\\\s"\':,;]+',
    Secret.HOST: r'(?<![\d.])(?:\d{1,3}\.){3}\d{1,3}(?![\d.])',
    Secret.NAME: r'(?<![\w.+-])[\w.+-]{1,64}@[\w-]{1,63}(?:\.[\w-]{1,63})+',
    Secret.TOKEN: r'(?<=Bearer )\S+|(?<=://)[^/\s:@]+:[^/\s@]+(?=@)'
    r'|(?<=password=)\S+|(?<=token=)\S+|(?<=password: )\S+|(?<=token: )\S+'
    r'|(?<="password": ")[^"]+|(?<="token": ")[^"]+',
}
"""What is hidden wherever it stands, by its form: homes, addresses, and texts behind their key."""

BYTES = re.compile(r'sequence<(?:u?int8|octet|char)\b')
NESTED = re.compile(r'(\w+)/(\w+)')
"""Types of fields, as a message states them: sequences of bytes, and messages."""


class Mask:
    """Hides all kinds of secrets but those that are `shown`; it counts what it has hidden."""

    def __init__(self, shown: Collection[Secret] = (), tokens: Iterable[str] = ()) -> None:
        """Know this machine and its user, and `tokens`, which are never shown."""
        self._hidden = [kind for kind in Secret if kind is Secret.TOKEN or kind not in shown]
        self._known: dict[Secret, set[str]] = {kind: set() for kind in Secret}
        self.count: Counter[Secret] = Counter()
        self._compiled: re.Pattern[str] | None = None
        self.learn(Secret.HOST, host_names())
        self.learn(Secret.USER, user_names())
        self.learn(Secret.TOKEN, tokens)

    def learn_reasons(self, texts: Iterable[Any]) -> None:
        """Hide why persons did something, but not where that is a word of this product."""
        self.learn(Secret.NAME, texts, but=product_words())

    def learn(
        self, kind: Secret, texts: Iterable[Any], *, but: Collection[str] = frozenset()
    ) -> None:
        """Hide these texts from now on, as they are, in JSON, and in letters of one byte."""
        known = self._known[kind]
        wholes = [str(text) for text in texts]
        lines = [line for whole in wholes for line in whole.splitlines()]
        for word in {text.strip() for text in (*wholes, *lines)} - known:
            if len(word) >= LEAST and word.lower() not in but:
                narrow = word.encode('latin-1', 'replace').decode('utf-8', 'surrogateescape')
                known |= {word, json.dumps(word)[1:-1], narrow}
                self._compiled = None

    @property
    def _pattern(self) -> re.Pattern[str]:
        if self._compiled is not None:
            return self._compiled
        groups = []
        for kind in self._hidden:
            # The longest first: a home before the name of its user.
            words = '|'.join(map(re.escape, sorted(self._known[kind], key=len, reverse=True)))
            known = [rf'(?<![^\W_])(?:{words})(?![^\W_])'] if words else []
            groups.append(f'(?P<{kind.name}>{"|".join([*known, ALWAYS[kind]])})')
        self._compiled = re.compile('|'.join(groups), re.IGNORECASE)
        return self._compiled

    def text(self, text: str) -> str:
        """Return a text without secrets; line by line, so that other threads have their turn."""
        pattern = self._pattern
        return ''.join(pattern.sub(self._word, line) for line in text.splitlines(keepends=True))

    def _word(self, match: re.Match[str]) -> str:
        kind = Secret[str(match.lastgroup)]
        self.count[kind] += 1
        return kind.value

    def message(self, type_name: str, data: bytes) -> bytes:
        """Return a serialised message without secrets; raises InputError for an unknown type."""
        message = deserialize_message(data, message_class(type_name))
        if not self._pattern.search(data.decode('utf-8', 'replace')):
            return data
        return serialized(self._of_message(message))

    def _of_message(self, message: Any) -> Any:
        for name in message.get_fields_and_field_types():
            setattr(message, name, self._of_value(getattr(message, name)))
        return message

    def _of_value(self, value: Any) -> Any:
        if isinstance(value, str):
            return self.text(value)
        if isinstance(value, list):
            return [self._of_value(element) for element in value]
        return self._of_message(value) if hasattr(value, 'get_fields_and_field_types') else value


@functools.cache
def product_words() -> frozenset[str]:
    """Return the words of parameters, and of fields and constants of messages, in small."""
    kinds = (AxisHealth, BallScrewState, OutOfZone)
    names = [name for kind in kinds for name in (*kind.get_fields_and_field_types(), *dir(kind))]
    return frozenset(
        re.findall('[a-z]+', ' '.join([*defaults(['x']), *names]).lower().replace('_', ' '))
    )


def holds_bytes(type_name: str) -> bool:
    """
    Return True if messages can hold a picture or such, in which nothing can be hidden.

    Raises InputError for an unknown type.

    """
    if type_name.startswith('ballscrew_msgs/'):
        return False
    kinds = message_class(type_name).get_fields_and_field_types().values()
    parts = {'/msg/'.join(part.groups()) for part in map(NESTED.search, kinds) if part}
    return any(map(BYTES.match, kinds)) or any(map(holds_bytes, parts))


def host_names() -> set[str]:
    """Return the names of this machine, with and without its domain."""
    return with_short(socket.gethostname())


def with_short(host: str) -> set[str]:
    """Return the name of a host, with and without its domain; an address stays whole."""
    short = host.partition('.')[0]
    return {host} if short.isdigit() else {host, short}


def user_names() -> set[str]:
    """Return home, login names and full name of whoever runs this."""
    names = {os.environ.get(name, '') for name in ('USER', 'LOGNAME', 'SUDO_USER')}
    with contextlib.suppress(OSError, KeyError):
        names |= {getpass.getuser(), pwd.getpwuid(os.getuid()).pw_gecos.partition(',')[0]}
    home = str(Path.home())
    return names | ({home} if home != os.sep else set())
