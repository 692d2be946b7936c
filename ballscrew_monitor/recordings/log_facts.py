# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Facts in the metadata of a bag made of a log: parameters, map, assumptions, notes."""

from collections.abc import Collection, Mapping, Sequence
import dataclasses
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.recordings.bag import Bag, RUN_BORDERS
from ballscrew_monitor.recordings.declared import plain, unwritten
from ballscrew_monitor.recordings.recorded_events import events_topic, recorded_values
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.parameter_row import BARE_LETTERS
from surrogate.files import InputError
from surrogate.files.plain_yaml import plain_values
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
    `run_borders` are stamps [ns] in the pauses between its runs, each of which is judged apart.

    """

    source: str
    parameters: Mapping[str, Any]
    mapping: Mapping[str, Any]
    assumptions: tuple[Assumption, ...]
    notes: tuple[str, ...]
    run_borders: tuple[int, ...] = unwritten(default=())

    def texts(self) -> dict[str, str]:
        """Return the facts as the metadata of a bag holds them."""
        content = plain(self) | {'parameters': _parameters_text(self.parameters)}
        texts = {f'{PREFIX}{key}': _text(value) for key, value in content.items()}
        borders = {RUN_BORDERS: ' '.join(map(str, self.run_borders))}
        return texts | (borders if self.run_borders else {})

    def sentences(self) -> list[str]:
        """Return what is to be said wherever the log is judged."""
        axes = self.mapping.get('axes', {}).keys()
        assumed = {  # by axis, what is about none with each of them
            axis: [
                f'{assumption.key.removeprefix(f"{axis}.")} = {assumption.value}'
                for assumption in self.assumptions
                if assumption.key.partition('.')[0] not in axes - {axis}
            ]
            for axis in axes
        }
        return [
            *self.notes,
            *(
                f'assumed of {self.source}, {whose}: {", ".join(texts)}'
                for whose, texts in grouped(assumed)
            ),
        ]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ChosenValues:
    """
    Every parameter that a bag is to be judged with, and in words whose they are.

    `stated` names those that somebody gave a value; the others stand at their defaults.
    `is_given`: a person gave them for this bag; `is_nominal`: neither a person nor the bag gave
    any.

    """

    values: dict[str, Any]
    origin: str
    stated: frozenset[str] = frozenset()
    is_given: bool = False
    is_nominal: bool = False


def grouped(sentences: Mapping[str, Sequence[str]]) -> list[tuple[str, list[str]]]:
    """Return what is said of axes: first of all of them, then of axes of which the same is."""
    first = next(iter(sentences.values()), [])
    common = [sentence for sentence in first if all(sentence in own for own in sentences.values())]
    groups: dict[tuple[str, ...], list[str]] = {}
    for axis, own in sentences.items():
        groups.setdefault(
            tuple(sentence for sentence in own if sentence not in common), []
        ).append(axis)
    whole = 'all axes' if len(sentences) > 1 else ''.join(f'axis {axis}' for axis in sentences)
    groups_of_axes = [(whole, common)] if common else []
    for rest, axes in groups.items():
        if rest:
            groups_of_axes.append(
                (f'{"axis" if len(axes) == 1 else "axes"} {", ".join(axes)}', list(rest))
            )
    return groups_of_axes


def facts_of(bag: Bag) -> LogFacts | None:
    """Return what a bag says of the log that it was made of, None for any other bag."""
    if f'{PREFIX}source' not in bag.metadata:
        return None
    try:
        content = {
            name: plain_values(bag.metadata[f'{PREFIX}{name}'])
            for name in ('source', 'mapping', 'assumptions', 'notes')
        }
        return LogFacts(
            source=str(content['source']),
            parameters=parameters_of(bag) or {},
            mapping=content['mapping'],
            assumptions=tuple(Assumption(**assumption) for assumption in content['assumptions']),
            notes=tuple(content['notes']),
            run_borders=tuple(bag.run_borders),
        )
    except (InputError, KeyError, TypeError, AttributeError) as error:
        reason = ' '.join(str(error).split())
        raise InputError(f'bag {bag.path}: its metadata are damaged: {reason}') from None


def parameters_of(bag: Bag) -> dict[str, Any] | None:
    """Return every parameter of the node that a bag is to be judged with, None if it has none."""
    text = bag.metadata.get(f'{PREFIX}parameters')
    return None if text is None else parameters.read_text(text, f'bag {bag.path}')


def values_for(bag: Bag, given: Path | None, nominal: Path) -> ChosenValues:
    """Return the parameters to judge a bag with: those given, its own, or the nominal ones."""
    if given is not None:
        values = parameters.read_file(given)
        stated = parameters.names_in_file(given)
        return ChosenValues(values=values, origin=str(given), stated=stated, is_given=True)
    own = parameters_of(bag)
    if own is not None:
        stated = parameters.names_in_text(bag.metadata[f'{PREFIX}parameters'], f'bag {bag.path}')
        return ChosenValues(values=own, origin=f'those of {bag.path}', stated=stated)
    if events_topic(bag):
        values = recorded_values(bag)
        origin = f'those that the node recorded in {bag.path}'
        return ChosenValues(values=values, origin=origin, stated=_not_default(values))
    values = parameters.read_file(nominal)
    return ChosenValues(values=values, origin=f'{nominal}, the nominal ones', is_nominal=True)


def parameters_text(values: Mapping[str, Any], stated: Collection[str] = ()) -> str:
    """Return the text of a ROS parameter file: what is not at its default, or `stated`."""
    shown = _not_default(values) | set(stated)
    return _parameters_text({name: value for name, value in values.items() if name in shown})


def _not_default(values: Mapping[str, Any]) -> frozenset[str]:
    """Return the names of the parameters that are not at their defaults, and that of the axes."""
    usual = parameters.defaults(values['axes'])
    return frozenset(
        name for name, value in values.items() if name == 'axes' or value != usual.get(name)
    )


def _parameters_text(given: Mapping[str, Any]) -> str:
    nested: dict[str, Any] = {}
    for name, value in given.items():
        *groups, leaf = name.split('.')
        place = nested
        for group in groups:
            place = place.setdefault(group, {})
        place[leaf] = value
    return _text({f'/**/{parameters.NODE_NAME}': {'ros__parameters': nested}})


def _text(value: Any) -> str:
    return value if isinstance(value, str) else yaml.dump(value, Dumper=_Quoting, sort_keys=False)
