# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parameters with which a recording is judged, their origin, and their assumptions."""

from collections.abc import Mapping, Sequence
import dataclasses
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings import log_facts
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import ChosenValues, LogFacts, PREFIX
from ballscrew_monitor.recordings.positions import by_position, still_speed
from ballscrew_monitor.recordings.recorded_events import judged_by_events
from ballscrew_monitor.settings.parameters import flatten
from surrogate.units import MILLI

Assumed = Mapping[str, Mapping[str, Any]]
"""What is assumed by what it is about, each with value and reason."""
TEMPERATURE = 'temperature_degC'
OF_NODE = {
    TEMPERATURE: 'temperature.default',
    'screw': 'screw',
    'oil': 'oil',
    'surface': 'surface',
}
"""Places in the map of an axis that are parameters of the node, and those."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisFacts:
    """
    What is known of an axis but for its rows.

    `load_from` is the input that its load is worked out from, empty where the load is measured;
    `assumed` says by name what else is not known, each with value and reason; `stated` names what
    somebody states, by its place in a map, `defaulted` what stands at its default there; `lead`
    [m] is that of the map, NaN without one, `motion_unit` that of its column of speed or position.

    """

    load_from: str = ''
    assumed: Assumed = dataclasses.field(default_factory=dict)
    stated: frozenset[str] = frozenset()
    defaulted: frozenset[str] = frozenset()
    lead: float = math.nan
    motion_unit: str = ''

    @property
    def is_mapped(self) -> bool:
        """Return True if its inputs are columns of a table, as a map says."""
        return 'lead_mm' in self.stated or 'lead_mm' in self.assumed  # no map is without it

    @property
    def torque_is_load(self) -> bool:
        """Return True if the map takes the motor torque, or its current, for the load."""
        return self.load_from in ('torque', 'current')

    @property
    def torque_from_current(self) -> bool:
        """Return True if its motor torque is a current times the torque constant of the map."""
        named = self.stated | set(self.assumed)
        return 'current.column' in named and 'torque.column' not in named

    def column_of(self, name: str) -> str:
        """Return what an input is read from by the map: `load` may be the torque or current."""
        if name == 'load' and self.load_from:
            name = self.load_from.removeprefix('motor_')
        if name == 'torque' and self.torque_from_current:
            return 'current'
        return 'position' if name == 'speed' and 'speed' in self.assumed else name

    @property
    def default_temperature_known(self) -> str:
        """Return how its default oil temperature is known, stated or assumed."""
        return 'stated' if 'temperature_degC' in self.stated else 'assumed'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogParameters:
    """
    Values by name, where they come from in words, and what they assume, by what it is about.

    `notes` are about the log, `sentences` all that is to be said of it in a terminal; `axes` is
    what is known of each axis but for a recording. `nominal`: nobody said with what to judge.
    `metadata` are those of a bag that is to be judged alike. `machine` is the one that the map of
    the log or the parameters state, or ''.

    """

    values: Mapping[str, Any]
    origin: str
    assumptions: Assumed = dataclasses.field(default_factory=dict)
    notes: Sequence[str] = ()
    sentences: Sequence[str] = ()
    axes: Mapping[str, AxisFacts] = dataclasses.field(default_factory=dict)
    nominal: bool = False
    metadata: Mapping[str, str] = dataclasses.field(default_factory=dict)
    machine: str = ''

    @property
    def short_origin(self) -> str:
        """Return where they come from without folders, for whom a page is forwarded to."""
        return re.sub(r'\S*/', '', self.origin)


def parameters_for(bag: Bag, params: Path | None, nominal: Path) -> LogParameters:
    """
    Return the parameters for a recording: those given, else its own, else the nominal ones.

    Raises InputError for a file that cannot be read, and for metadata that are damaged.

    """
    chosen = log_facts.values_for(bag, params, nominal)
    facts, assumptions = log_facts.facts_of(bag), {}
    chosen, still = _by_position(bag, chosen) if facts is None else (chosen, ())
    if facts is not None:
        # Other parameters take the place of assumptions.
        given = flatten(facts.mapping.get('parameters') or {})
        still_assumed = []
        for assumption in facts.assumptions:
            axis, _, place = assumption.key.partition('.')
            known = place in OF_NODE and (chosen.is_given or f'{axis}.{OF_NODE[place]}' in given)
            still_assumed += [] if known else [assumption]
        facts = dataclasses.replace(facts, assumptions=tuple(still_assumed))
        assumptions = {
            assumption.key: {'value': assumption.value, 'reason': assumption.reason}
            for assumption in facts.assumptions
        }
    mapped = '' if facts is None else str(facts.mapping.get('machine', '')).strip()
    return LogParameters(
        values=chosen.values,
        origin=chosen.origin,
        assumptions=assumptions,
        notes=still if facts is None else facts.notes,
        sentences=still if facts is None else facts.sentences(),
        axes={
            axis: _axis_facts(axis, facts, assumptions, chosen) for axis in chosen.values['axes']
        },
        nominal=chosen.is_nominal,
        metadata=_metadata(bag, facts, chosen),
        machine=mapped or chosen.values['machine'].strip(),
    )


def _by_position(bag: Bag, chosen: ChosenValues) -> tuple[ChosenValues, tuple[str, ...]]:
    """Return values that read no speed which is 0 while the axis moves; a sentence of each."""
    if judged_by_events(bag, chosen.values):
        return chosen, ()
    values, notes = dict(chosen.values), []
    for axis, (field, unit) in by_position(bag, values).items():
        notes.append(still_speed(axis, values[f'{axis}.speed.field'], field, unit))
        values |= {f'{axis}.speed.field': field, f'{axis}.speed.unit': unit}
    return dataclasses.replace(chosen, values=values), tuple(notes)


def _axis_facts(
    axis: str, facts: LogFacts | None, assumptions: Assumed, chosen: ChosenValues
) -> AxisFacts:
    """Return what is stated and assumed of an axis; the temperature as judged with."""
    assumed = assumed_of(assumptions, axis, chosen.values['axes'])
    mapped = {} if facts is None else facts.mapping.get('axes', {}).get(axis, {})
    known = flatten(mapped) | {key: assumption['value'] for key, assumption in assumed.items()}
    stated = set(known) - {*assumed, TEMPERATURE}
    if f'{axis}.{OF_NODE[TEMPERATURE]}' in chosen.stated and TEMPERATURE not in assumed:
        stated.add(TEMPERATURE)
    lead, defaulted = known.get('lead_mm'), set[str]()
    if facts is not None and not chosen.is_given:  # what nobody said: model, limits, all
        given = chosen.stated - {assumption.key for assumption in facts.assumptions}
        if not {f'{axis}.surface', f'{axis}.screw'} & given:
            defaulted.add('surface')
        if not any(name.startswith(f'{axis}.limits.') for name in given):
            defaulted.add('limits')
        if len(defaulted) == 2 and not facts.mapping.get('parameters'):
            defaulted.add('parameters')
    return AxisFacts(
        load_from=str(known.get('load.from') or ''),
        assumed=assumed,
        stated=frozenset(stated),
        defaulted=frozenset(defaulted),
        lead=lead / MILLI if isinstance(lead, int | float) else math.nan,
        motion_unit=str(known.get('speed.unit') or known.get('position.unit') or ''),
    )


def assumed_of(assumptions: Assumed, axis: str, axes: Sequence[str]) -> Assumed:
    """Return the assumptions about an axis, without its name, and those about all axes."""
    own, general = {}, {}
    for key, assumption in assumptions.items():
        whose, _, place = key.partition('.')
        if whose == axis:
            own[place] = assumption
        elif whose not in axes:
            general[key] = assumption
    return own | general


def _metadata(bag: Bag, facts: LogFacts | None, chosen: ChosenValues) -> dict[str, str]:
    """Return what a bag says of its log, with the parameters that somebody gave for it."""
    own = {key: text for key, text in bag.metadata.items() if key.startswith(PREFIX)}
    if facts is not None:
        own |= {key: text for key, text in facts.texts().items() if key in own}
    if chosen.is_nominal:
        return own
    text = log_facts.parameters_text(chosen.values, chosen.stated)
    return own | {f'{PREFIX}parameters': text}
