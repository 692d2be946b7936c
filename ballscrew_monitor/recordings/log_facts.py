# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a bag made of a log says of itself in its metadata: parameters, map, assumptions, notes."""

from collections.abc import Mapping
import dataclasses
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.node import parameters
from ballscrew_monitor.node.parameter_row import BARE_LETTERS
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.own_recording import journal_of, recorded_values
from surrogate.files import InputError
import yaml

PREFIX = 'ballscrew_monitor.'


class _Quoting(yaml.SafeDumper):
    """Quotes the letters that ROS reads as true and false."""


_Quoting.add_implicit_resolver(
    'tag:yaml.org,2002:bool',
    re.compile(f'({"|".join(BARE_LETTERS)})$'),
    sorted({word[0] for word in BARE_LETTERS}),
)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Assumption:
    """A value that the log does not say, by its place in the map, and why it is that."""

    key: str
    value: Any
    reason: str


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogFacts:
    """
    What is known of a log: its name, how it is judged and read, what was assumed and amiss.

    `parameters` are those of the node that differ from their defaults, by full name.

    """

    source: str
    parameters: Mapping[str, Any]
    mapping: Mapping[str, Any]
    assumptions: tuple[Assumption, ...]
    notes: tuple[str, ...]

    def texts(self) -> dict[str, str]:
        """Return the facts as the metadata of a bag holds them."""
        content = {
            'source': self.source,
            'parameters': {
                f'/**/{parameters.NODE_NAME}': {'ros__parameters': _nested(self.parameters)}
            },
            'mapping': dict(self.mapping),
            'assumptions': [dataclasses.asdict(one) for one in self.assumptions],
            'notes': list(self.notes),
        }
        return {f'{PREFIX}{key}': _text(value) for key, value in content.items()}

    def sentences(self) -> list[str]:
        """Return what is to be said wherever the log is judged."""
        assumed = ', '.join(f'{one.key} = {one.value}' for one in self.assumptions)
        return [*self.notes, *([f'assumed of {self.source}: {assumed}'] if assumed else [])]


def facts_of(bag: Bag) -> LogFacts | None:
    """Return what a bag says of the log that it was made of, None for any other bag."""
    if f'{PREFIX}source' not in bag.metadata:
        return None
    try:
        content = {
            name: yaml.safe_load(bag.metadata[f'{PREFIX}{name}'])
            for name in ('source', 'mapping', 'assumptions', 'notes')
        }
        return LogFacts(
            source=str(content['source']),
            parameters=parameters_of(bag) or {},
            mapping=content['mapping'],
            assumptions=tuple(Assumption(**one) for one in content['assumptions']),
            notes=tuple(content['notes']),
        )
    except (yaml.YAMLError, KeyError, TypeError, AttributeError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'bag {bag.path}: its metadata are damaged: {reason}') from None


def parameters_of(bag: Bag) -> dict[str, Any] | None:
    """Return every parameter of the node that a bag is to be judged with, None if it has none."""
    text = bag.metadata.get(f'{PREFIX}parameters')
    return None if text is None else parameters.read_text(text, f'bag {bag.path}')


def values_for(bag: Bag, given: Path | None, nominal: Path) -> tuple[dict[str, Any], str]:
    """Return the parameters to judge a bag with, given, its own or nominal, and whose they are."""
    if given is not None:
        return parameters.read_file(given), str(given)
    own = parameters_of(bag)
    if own is not None:
        return own, f'those of {bag.path}'
    if journal_of(bag):
        return recorded_values(bag), f'those that the node recorded in {bag.path}'
    return parameters.read_file(nominal), f'{nominal}, the nominal ones'


def _text(value: Any) -> str:
    return value if isinstance(value, str) else yaml.dump(value, Dumper=_Quoting, sort_keys=False)


def _nested(flat: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters by full name as sections within sections."""
    nested: dict[str, Any] = {}
    for name, value in flat.items():
        *groups, leaf = name.split('.')
        place = nested
        for group in groups:
            place = place.setdefault(group, {})
        place[leaf] = value
    return nested
