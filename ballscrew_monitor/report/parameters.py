# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""With which parameters a recording is judged, where they come from, and what they assume."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import facts_of, LogFacts, values_for

NOMINAL = 'the nominal ones'
"""How an origin ends where neither a person nor the recording gave parameters."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogParameters:
    """
    Values by name, where they come from in words, and what they assume, by what it is about.

    `notes` are about the log, `sentences` all that is to be said of it in a terminal;
    `load_from` says of axes what their load is worked out from, where it is not measured, and
    `stated` what the map of the log states, by place. `nominal`: nobody said with what to judge.

    """

    values: Mapping[str, Any]
    origin: str
    assumptions: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict)
    notes: Sequence[str] = ()
    sentences: Sequence[str] = ()
    load_from: Mapping[str, str] = dataclasses.field(default_factory=dict)
    stated: frozenset[str] = frozenset()
    nominal: bool = False

    @property
    def short_origin(self) -> str:
        """Return where they come from without folders, for whom a page is forwarded to."""
        return re.sub(r'\S*/', '', self.origin)

    def stated_of(self, axis: str) -> frozenset[str]:
        """Return the places that the map states of an axis, without its name."""
        own = f'{axis}.'
        return frozenset(one.removeprefix(own) for one in self.stated if one.startswith(own))

    def of_axis(self, axis: str) -> dict[str, Mapping[str, Any]]:
        """Return the assumptions about an axis, without its name, and those about all axes."""
        axes = self.values['axes']
        own = {
            key.removeprefix(f'{axis}.'): one
            for key, one in self.assumptions.items()
            if key.startswith(f'{axis}.')
        }
        return own | {
            key: one for key, one in self.assumptions.items() if key.partition('.')[0] not in axes
        }


def parameters_for(bag: Bag, given: Path | None, nominal: Path) -> LogParameters:
    """
    Return the parameters for a recording: those given, else its own, else the nominal ones.

    Raises InputError for a file that cannot be read, and for metadata that are damaged.

    """
    values, origin = values_for(bag, given, nominal)
    facts = facts_of(bag)
    if facts is None:
        return LogParameters(values=values, origin=origin, nominal=origin.endswith(NOMINAL))
    assumed = {one.key: {'value': one.value, 'reason': one.reason} for one in facts.assumptions}
    return LogParameters(
        values=values,
        origin=origin,
        assumptions=assumed,
        notes=facts.notes,
        sentences=facts.sentences(),
        stated=frozenset(_places(facts.mapping.get('axes', {}))),
        load_from={
            axis: source
            for axis in values['axes']
            for source in [_load_from(facts, axis)]
            if source
        },
    )


def _places(section: Mapping[str, Any], prefix: str = '') -> Iterator[str]:
    """Yield the full names of all values in sections within sections."""
    for key, value in section.items():
        if isinstance(value, Mapping):
            yield from _places(value, f'{prefix}{key}.')
        else:
            yield f'{prefix}{key}'


def _load_from(facts: LogFacts, axis: str) -> str:
    """Return the input that the load of an axis is worked out from, empty if it is none."""
    assumed = next((one.value for one in facts.assumptions if one.key == f'{axis}.load.from'), '')
    stated = facts.mapping.get('axes', {}).get(axis, {}).get('load', {})
    return str(assumed or (stated.get('from', '') if isinstance(stated, Mapping) else ''))
