# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Faults between a parameter file and a running ROS graph: facts in, findings out.

A finding is a sentence that says what to write instead. Nothing here asks the graph.

"""

from collections.abc import Iterable, Mapping
import dataclasses
import difflib
import math

from ballscrew_monitor.core.conversions import celsius, POSITION_UNITS, Scaling
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source
from ballscrew_monitor.core.links import Link, link_reason
from ballscrew_monitor.messages.reasons import slow_reason, Standing, summary
from surrogate.surface import Surface

SAFE_RATE = 3200.0  # [1/s] messages of speed and load that one core takes
PLAUSIBLE = 1.5  # times the range of the surface
TEMPERATURE_MARGIN = 40.0  # [K] about the range of the surface
NEAR = 0.6  # likeness of two names from which on one may be meant by the other
SI_UNITS = {Source.SPEED: 'rad/s', Source.LOAD: 'N', Source.TEMPERATURE: 'degC'}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Heard:
    """
    What came of an input while it was listened to.

    Lowest and highest number as the messages hold them, NaN without any, and the longest time
    [s] without a message. `moved` says whether the position beside a velocity did.

    """

    status: InputStatus
    low: float = math.nan
    high: float = math.nan
    longest_gap: float = math.nan
    moved: bool = False


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputFacts:
    """
    One configured input: its link, timeout [s] and unit, and what was heard of it.

    `scalings` hold the lines to SI units by unit, and `known` is the range of the surface [SI];
    both are empty where the surface is not known. `problem` is why the field cannot be read, and
    `numbers` are the fields that could. `beside` are field and unit of the position beside it.

    """

    axis: str
    source: Source
    link: Link
    timeout: float
    unit: str
    scalings: Mapping[str, Scaling]
    known: tuple[float, float] | None = None
    heard: Heard | None = None
    problem: str = ''
    numbers: tuple[str, ...] = ()
    beside: tuple[str, str] = ('', '')

    @property
    def parameter(self) -> str:
        """Return the name that the parameters of the input begin with."""
        return f'{self.axis}.{self.source.name.lower()}'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Surroundings:
    """
    Where the doctor listens: domain, discovery range, and who is there.

    `topics` holds the types of each topic that is published, `domains` the other domains that
    processes of this machine are in.

    """

    domain: int
    discovery: str
    localhost_only: bool
    nodes: tuple[str, ...]
    topics: Mapping[str, tuple[str, ...]]
    domains: tuple[int, ...]
    use_sim_time: bool


def findings(
    surroundings: Surroundings, inputs: Iterable[InputFacts], seconds: float
) -> list[str]:
    """Return a sentence for all that is wrong, after listening for `seconds` [s]."""
    inputs, around, sentences = tuple(inputs), surroundings, []
    if not around.nodes:
        cure = 'start the machine, or set ROS_DOMAIN_ID to its domain'
        if around.domains:
            cure = (
                f'processes of this machine are in domain {", ".join(map(str, around.domains))}, '
                f'set ROS_DOMAIN_ID={around.domains[0]}'
            )
        elif around.localhost_only:
            cure = 'ROS_LOCALHOST_ONLY hides other machines, unset it'
        elif around.discovery in ('LOCALHOST', 'OFF'):
            variable = f'ROS_AUTOMATIC_DISCOVERY_RANGE={around.discovery}'
            cure = f'{variable} hides other machines, set it to SUBNET'
        sentences.append(f'nobody else is seen in ROS domain {around.domain}: {cure}')
    if around.use_sim_time and '/clock' not in around.topics:
        sentences.append(
            'use_sim_time is true and nobody publishes /clock: play /clock, or set it to false'
        )
    for facts in inputs:
        sentences += _of_input(facts, around, seconds)
    rates = [
        facts.heard.status.rate
        for facts in inputs
        if facts.heard is not None and facts.source in (Source.SPEED, Source.LOAD)
    ]
    total = math.fsum(rate for rate in rates if math.isfinite(rate))
    if total > SAFE_RATE:
        sentences.append(
            f'speed and load come {total:.0f} times a second in all, safe are {SAFE_RATE:g}: '
            'lower their rates, or give some axes a node of their own'
        )
    return sentences


def _of_input(facts: InputFacts, around: Surroundings, seconds: float) -> list[str]:
    problems = []
    reason = link_reason(facts.link, facts.parameter)
    if reason:
        # A topic that may be meant instead of one that nobody publishes.
        topic = '' if facts.link.publishers else near_topic(facts.link, around.topics)
        instead = f' to {topic} ({" and ".join(around.topics[topic])})' if topic else ''
        problems.append(f'{facts.parameter}: {reason}{instead}')
    if facts.problem and not (reason and facts.link.publishers):
        problems.append(f'{facts.parameter}: {facts.problem}: {_readable(facts)}')
    if facts.heard is not None and facts.heard.moved and not any(_ends(facts.heard)):
        field, unit = facts.beside
        return [
            *problems,
            f'{facts.parameter}: it is 0 or missing while {field} moves: set '
            f"{facts.parameter}.field to '{field}' and {facts.parameter}.unit to '{unit}'",
        ]
    if facts.heard is None:
        return problems
    heard, text = facts.heard, ''
    fine = heard.status.state in (InputState.OK, InputState.STALE)
    if not heard.status.received:
        silence = f'the publisher on {facts.link.topic} has sent nothing within {seconds:g} s'
        text = f'{silence}: start it' if facts.timeout < seconds else ''
    elif fine and heard.longest_gap > facts.timeout:
        text = f'it {slow_reason(heard.longest_gap, facts.parameter)}'
    else:
        standing, text, _ = summary(facts.axis, (heard.status,), {facts.source: facts.link})
        text = '' if standing is Standing.GOOD else text
    problems += [f'{facts.parameter}: {text}'] if text else []
    return [*problems, *unit_doubts(facts, heard)]


def _ends(heard: Heard) -> tuple[float, float]:
    """Return the lowest and the highest number, 0 without any."""
    return (0.0, 0.0) if math.isnan(heard.low) else (heard.low, heard.high)


def _readable(facts: InputFacts) -> str:
    """Return what to write instead of a field that cannot be read."""
    if not facts.numbers:
        return f'set {facts.parameter}.type, or {facts.parameter}.field'
    return f'set {facts.parameter}.field, numbers are {", ".join(facts.numbers)}'


def near_topic(link: Link, topics: Mapping[str, tuple[str, ...]]) -> str:
    """Return the topic that is most like that of a link: by last name, likeness or type."""
    last = link.topic.rpartition('/')[2]
    same = [name for name in topics if name.rpartition('/')[2] == last]
    like = difflib.get_close_matches(link.topic, topics, n=1, cutoff=NEAR)
    of_type = [name for name, types in topics.items() if link.type_name in types]
    return next(iter([*same, *like, *of_type]), '')


def known_range(surface: Surface | None, source: Source, unit: str) -> tuple[float, float] | None:
    """Return the range of a surface [SI] in what an input measures; a position has none."""
    if surface is None or source is Source.TORQUE or unit in POSITION_UNITS:
        return None
    limits: tuple[float, float] = getattr(surface, f'{source.name.lower()}_range')
    return limits


def unit_doubts(facts: InputFacts, heard: Heard) -> list[str]:
    """Return that the numbers are too large for the surface, with units that would suit them."""
    if math.isnan(heard.high) or facts.known is None or facts.unit not in facts.scalings:
        return []
    if _suits(facts, heard, facts.unit):
        return []
    others = [unit for unit in facts.scalings if unit != facts.unit and _suits(facts, heard, unit)]
    numbers = (
        f'{heard.low:.4g} to {heard.high:.4g}' if heard.low < heard.high else f'{heard.low:.4g}'
    )
    span = facts.known
    if facts.source is Source.TEMPERATURE:
        span = celsius(span[0]), celsius(span[1])
    said = (
        f'{facts.parameter}: {numbers} {facts.unit} is far outside the surface '
        f'({span[0]:.4g} to {span[1]:.4g} {SI_UNITS[facts.source]})'
    )
    if not others:
        return [f'{said}: set {facts.parameter}.scale, or build a wider surface']
    more = f' (or {", ".join(others[1:])})' if others[1:] else ''
    return [f'{said}, it looks like {others[0]}{more}: set {facts.parameter}.unit to {others[0]}']


def _suits(facts: InputFacts, heard: Heard, unit: str) -> bool:
    """Return True if what was heard would be near the range of the surface in a unit."""
    assert facts.known is not None
    values = [facts.scalings[unit](number) for number in (heard.low, heard.high)]
    if facts.source is Source.TEMPERATURE:
        low, high = (facts.known[0] - TEMPERATURE_MARGIN, facts.known[1] + TEMPERATURE_MARGIN)
        return all(low <= value <= high for value in values)
    most = PLAUSIBLE * max(map(abs, facts.known))
    return all(abs(value) <= most for value in values)
