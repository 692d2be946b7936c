# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Plain values of a YAML text: depth and number are bounded before a value is made."""

from collections.abc import Callable
import sys
from typing import Any

from surrogate.files import InputError
from surrogate.files.limits import DEPTH, MEGA, TEXT, VALUES
import yaml


class _Loader(yaml.SafeLoader):
    """YAML of a bounded number of values, in which an alias counts with its values."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self._depth = self._count = 0
        self._counts: dict[int, int] = {}  # of the values in a node

    def compose_node(self, parent: Any, index: Any) -> Any:
        """Return the next node; raises YAMLError at a limit."""
        before, is_alias = self._count, self.check_event(yaml.AliasEvent)
        self._depth += 1
        if self._depth > DEPTH:
            raise yaml.YAMLError(f'it nests deeper than {DEPTH}')
        node = super().compose_node(parent, index)
        self._depth -= 1
        if is_alias and id(node) not in self._counts:
            raise yaml.YAMLError('a part holds itself')
        self._count += self._counts[id(node)] if is_alias else 1
        self._counts[id(node)] = self._count - before
        if self._count > VALUES:
            raise yaml.YAMLError(f'it holds more than {VALUES} values')
        return node

    def construct_yaml_int(self, node: yaml.ScalarNode) -> int:
        """Return a whole number; raises YAMLError for one that no float is as large as."""
        number = int(super().construct_yaml_int(node))
        if abs(number) > sys.float_info.max:
            line = node.start_mark.line + 1
            raise yaml.YAMLError(f'the whole number in line {line} is beyond 1.8e308')
        return number


_Loader.add_constructor('tag:yaml.org,2002:int', _Loader.construct_yaml_int)


class _StrictLoader(_Loader):
    """YAML in which a key that stands twice is a mistake and not an overwriting."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Return the mapping; raises YAMLError for a key that stands twice."""
        mapping = super().construct_mapping(node, deep)
        left = set(mapping)
        for entry, _ in node.value:
            key = self.construct_object(entry, deep=True)
            if key not in left:
                raise yaml.YAMLError(f'key {entry.value} stands twice')
            left.remove(key)
        return mapping


def plain_values(
    text: str, *, strict: bool = False, change: Callable[[yaml.Node], None] | None = None
) -> Any:
    """
    Return the plain values of a YAML text; raises InputError.

    A `strict` text holds no key twice; `change` may change the tree before values are made of it.

    """
    if len(text) > TEXT:
        raise InputError(f'it is larger than {TEXT / MEGA:g} MB')
    try:
        loader = (_StrictLoader if strict else _Loader)(text)
        root = loader.get_single_node()
        if root is not None and change is not None:
            change(root)
        return None if root is None else loader.construct_document(root)
    except Exception as error:  # noqa: BLE001 a bad date or tag raises anything
        reason = ' '.join(str(error).split())
        is_syntax = isinstance(error, yaml.YAMLError)
        raise InputError(
            reason if is_syntax else f'a value is not of its kind ({reason})'
        ) from None
