# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""With which parameters a recording is judged, where they come from, and what they assume."""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import (
    Assumption,
    ChosenValues,
    facts_of,
    LogFacts,
    parameters_text,
    PREFIX,
    values_for,
)
from surrogate.units import MILLI

TEMPERATURE = 'temperature_degC'
OF_NODE = {
    TEMPERATURE: 'temperature.default',
    'screw': 'screw',
    'oil': 'oil',
    'surface': 'surface',
}
"""Places in the map of an axis that are parameters of the node, and those."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogParameters:
    """
    Values by name, where they come from in words, and what they assume, by what it is about.

    `notes` are about the log, `sentences` all that is to be said of it in a terminal;
    `load_from` says of axes what their load is worked out from, where it is not measured, and
    `stated` what somebody states of them, by its place in a map, `defaulted` what stands at its
    default there. `leads` [m] are those that the map gives. `nominal`: nobody said with what to
    judge. `metadata` are those of a bag that is to be judged alike.

    """

    values: Mapping[str, Any]
    origin: str
    assumptions: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict)
    notes: Sequence[str] = ()
    sentences: Sequence[str] = ()
    load_from: Mapping[str, str] = dataclasses.field(default_factory=dict)
    stated: frozenset[str] = frozenset()
    defaulted: frozenset[str] = frozenset()
    leads: Mapping[str, float] = dataclasses.field(default_factory=dict)
    nominal: bool = False
    metadata: Mapping[str, str] = dataclasses.field(default_factory=dict)

    @property
    def short_origin(self) -> str:
        """Return where they come from without folders, for whom a page is forwarded to."""
        return re.sub(r'\S*/', '', self.origin)

    def stated_of(self, axis: str) -> frozenset[str]:
        """Return the places that the map states of an axis, without its name."""
        return _own(axis, self.stated)

    def defaulted_of(self, axis: str) -> frozenset[str]:
        """Return the places of an axis that stand at their default, without its name."""
        return _own(axis, self.defaulted)

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


def _own(axis: str, names: frozenset[str]) -> frozenset[str]:
    """Return the names of an axis, without it."""
    own = f'{axis}.'
    return frozenset(one.removeprefix(own) for one in names if one.startswith(own))


def parameters_for(bag: Bag, given: Path | None, nominal: Path) -> LogParameters:
    """
    Return the parameters for a recording: those given, else its own, else the nominal ones.

    Raises InputError for a file that cannot be read, and for metadata that are damaged.

    """
    chosen = values_for(bag, given, nominal)
    facts = facts_of(bag)
    if facts is not None:
        facts = dataclasses.replace(facts, assumptions=_still_assumed(facts, chosen))
    known: dict[str, Any] = {
        'values': chosen.values,
        'origin': chosen.origin,
        'nominal': chosen.is_nominal,
        'stated': frozenset(_stated(facts, chosen)),
        'metadata': _metadata(bag, facts, chosen),
    }
    if facts is None:
        return LogParameters(**known)
    return LogParameters(
        **known,
        assumptions={
            one.key: {'value': one.value, 'reason': one.reason} for one in facts.assumptions
        },
        notes=facts.notes,
        sentences=facts.sentences(),
        defaulted=frozenset(_defaulted(facts, chosen)),
        leads=dict(_leads(facts, chosen)),
        load_from={
            axis: source
            for axis in chosen.values['axes']
            for source in [_load_from(facts, axis)]
            if source
        },
    )


def _still_assumed(facts: LogFacts, chosen: ChosenValues) -> tuple[Assumption, ...]:
    """Return the assumptions of a log without those that other parameters take the place of."""
    said = set(_places(facts.mapping.get('parameters') or {}))
    return tuple(
        one
        for one in facts.assumptions
        for axis, _, place in [one.key.partition('.')]
        if place not in OF_NODE or not (chosen.is_given or f'{axis}.{OF_NODE[place]}' in said)
    )


def _stated(facts: LogFacts | None, chosen: ChosenValues) -> Iterator[str]:
    """Yield what is stated of the axes, by its place in a map; the temperature as judged with."""
    assumed = set() if facts is None else {one.key for one in facts.assumptions}
    temperatures = {f'{axis}.{TEMPERATURE}': axis for axis in chosen.values['axes']}
    for name in _places({} if facts is None else facts.mapping.get('axes', {})):
        if name not in temperatures:
            yield name
    for name, axis in temperatures.items():
        if f'{axis}.{OF_NODE[TEMPERATURE]}' in chosen.said and name not in assumed:
            yield name


def _defaulted(facts: LogFacts, chosen: ChosenValues) -> Iterator[str]:
    """Yield of the axes of a log what is judged with as nobody said it: model, limits, and all."""
    if chosen.is_given:
        return
    said = chosen.said - {one.key for one in facts.assumptions}
    for axis in chosen.values['axes']:
        model = not {f'{axis}.surface', f'{axis}.screw'} & said
        limits = not any(name.startswith(f'{axis}.limits.') for name in said)
        yield from [f'{axis}.surface'] if model else []
        yield from [f'{axis}.limits'] if limits else []
        if model and limits and not facts.mapping.get('parameters'):
            yield f'{axis}.parameters'


def _leads(facts: LogFacts, chosen: ChosenValues) -> Iterator[tuple[str, float]]:
    """Yield axis and lead [m] as the map gives it, be it stated or assumed."""
    assumed = {one.key: one.value for one in facts.assumptions}
    for axis in chosen.values['axes']:
        stated = facts.mapping.get('axes', {}).get(axis, {}).get('lead_mm')
        lead = assumed.get(f'{axis}.lead_mm', stated)
        if isinstance(lead, int | float):
            yield axis, lead / MILLI


def _metadata(bag: Bag, facts: LogFacts | None, chosen: ChosenValues) -> dict[str, str]:
    """Return what a bag says of its log, with the parameters that somebody gave for it."""
    own = {key: text for key, text in bag.metadata.items() if key.startswith(PREFIX)}
    if facts is not None:
        own |= {key: text for key, text in facts.texts().items() if key in own}
    if chosen.is_nominal:
        return own
    return own | {f'{PREFIX}parameters': parameters_text(chosen.values, chosen.said)}


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
