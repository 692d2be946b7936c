# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Faults of an input and their cures: one sentence each, the same wherever it is said.

A sentence changes with the fault alone: it names parameters, topics and joints, and of numbers
only those to be written.

"""

from collections.abc import Callable, Iterator, Mapping
import difflib
import enum
import math
from typing import Any

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source, Why, YEAR
from ballscrew_monitor.core.links import Link, link_reason, senders, several_reason

SHOWN_JOINTS = 8  # names that a sentence lists
ROUND = (1.0, 2.0, 5.0, 10.0)  # leading digits of a timeout that is proposed
MOST_TIMEOUT = 3600.0  # [s] as the parameter allows it
SHARE = 0.01  # [-] of refused messages from which on they are warned of
_FAULTS = (InputState.STALE, InputState.MISSING, InputState.BAD, InputState.UNKNOWN)
_PLAUSIBLE = (
    'mend the source, its unit or scale, or raise limits.plausible_speed or limits.plausible_load'
)
_REFUSED = {
    Why.NOT_A_NUMBER: 'it is not a finite number, mend its source or read another field',
    Why.FUTURE: 'its stamps lie ahead of the clock, set the clocks alike or raise max_future',
    Why.OTHER_CLOCK: 'its stamps are of the wall clock and the node runs on simulated time, '
    'stamp with /clock or unset use_sim_time',
    Why.NOT_DECODED: 'its messages do not decode, record them with the type of their publisher',
    Why.IMPLAUSIBLE: f'it is beyond the plausible range, {_PLAUSIBLE}',
    Why.NEGATIVE: 'its stamps are negative, mend the clock of its source',
    Why.SEVERAL: 'several publishers send it, stop all but one or set one_source to false',
    Why.TOO_SHORT: 'its array ends before the element, let the source fill it',
    Why.HOLE: 'its positions come less often than its timeout allows, raise speed.timeout',
}
Cure = Callable[[InputStatus, Link | None, str], str]


def _refused(status: InputStatus, link: Link | None, parameter: str) -> str:
    """Return why messages of an input were refused not long ago."""
    texts = [_refusal_reason(why, link, parameter) for why in status.refusing]
    return f'messages are refused: {"; ".join(texts)}'


def _refusal_reason(why: Why, link: Link | None, parameter: str) -> str:
    if why is Why.SEVERAL and link is not None:
        return several_reason(link, parameter)
    return _REFUSED[why]


def _slow(status: InputStatus, link: Link | None, parameter: str) -> str:
    return slow_reason(status.longest_gap, parameter)


def _is_refused(status: InputStatus) -> bool:
    """Tell whether many messages are refused; implausible ones have words of their own."""
    others = set(status.refusing) - {Why.IMPLAUSIBLE}
    return bool(others) and status.refused_share >= SHARE


_TROUBLES: tuple[tuple[Callable[[InputStatus, Link | None], Any], str | Cure, Fault], ...] = (
    (lambda status, link: _is_refused(status), _refused, Fault.REFUSED),
    (
        lambda status, link: status.glitching,
        f'samples beyond the plausible range were refused: {_PLAUSIBLE}',
        Fault.GLITCHES,
    ),
    (
        lambda status, link: status.losing,
        'messages are lost on the way: lower their rate, raise publish_period, or give the node '
        'fewer axes or more of the processor',
        Fault.LOST,
    ),
    (
        lambda status, link: status.lag > seconds(YEAR),
        'stamps are of simulated time and the node runs on the wall clock: set use_sim_time',
        Fault.SIMULATED_STAMPS,
    ),
    (
        lambda status, link: status.lagging,
        'stamps lag behind their arrival: set the clocks alike, or raise max_lag',
        Fault.LAG,
    ),
    (lambda status, link: status.slow, _slow, Fault.SLOW),
    (
        lambda status, link: link is not None and link.several is None,
        'loss is unknown, and so is whether one source alone sends it: let the topic have one '
        'publisher, or a middleware that numbers messages',
        Fault.SOURCES_UNKNOWN,
    ),
    (
        lambda status, link: status.lost is None,
        'loss is unknown: let the topic have one publisher that numbers its messages',
        Fault.LOSS_UNKNOWN,
    ),
)


class Standing(enum.Enum):
    """How the inputs of an axis stand, as the worst of them does."""

    GOOD = 'all inputs arrive'
    DEGRADED = 'judged, but something is to be mended'
    LOST = 'an input is missing'


def summary(
    axis: str, inputs: tuple[InputStatus, ...], links: Mapping[Source, Link]
) -> tuple[Standing, str, Fault]:
    """
    Return a sentence for each fault, with what mends it; the worst kind of fault alone.

    The code is that of the first one.

    """
    faulty = [status for status in inputs if status.state in _FAULTS]
    if faulty:
        texts = [
            fault(status, links.get(status.source), _parameter(axis, status.source))
            for status in faulty
        ]
        return Standing.LOST, '; '.join(texts), fault_code(faulty[0])
    for happens, text, code in _TROUBLES:
        found = [status for status in inputs if happens(status, links.get(status.source))]
        if found:
            return Standing.DEGRADED, _trouble(axis, found, links, text), code
    remarks = _remarks(axis, inputs, links)
    return Standing.GOOD, '; '.join([Standing.GOOD.value, *remarks]), Fault.NONE


def _remarks(
    axis: str, inputs: tuple[InputStatus, ...], links: Mapping[Source, Link]
) -> Iterator[str]:
    """Yield what is worth a word of inputs that are well."""
    few = [status for status in inputs if status.refusing]
    if few:
        yield f'a few {_trouble(axis, few, links, _refused)}'
    for status in inputs:
        link = links.get(status.source)
        if link is not None and link.several:
            yield f'{status.source.name.lower()} comes from {senders(link)}'


def _parameter(axis: str, source: Source) -> str:
    return f'{axis}.{source.name.lower()}'


def _trouble(
    axis: str, found: list[InputStatus], links: Mapping[Source, Link], cure: str | Cure
) -> str:
    names = [status.source.name.lower() for status in found]
    if isinstance(cure, str):
        return f'{" and ".join(names)} {cure}'
    return '; '.join(
        f'{name} {cure(status, links.get(status.source), _parameter(axis, status.source))}'
        for name, status in zip(names, found, strict=True)
    )


def fault(status: InputStatus, link: Link | None, parameter: str) -> str:
    """Return what is wrong with an input that is not well, `parameter` being `axis.input`."""
    name = status.source.name.lower()
    if status.state is InputState.BAD:
        why = status.refusal
        if status.why and status.why is not Why.TOO_SHORT:
            why = _refusal_reason(status.why, link, parameter)
        return _with(f'{name} is not usable', why)
    seen = status.state is InputState.STALE
    if status.joints is not None:
        return _with(f'{name} has no sample', joint_reason(status.joints, parameter))
    reason = link_reason(link, parameter, seen=seen) if link else ''
    if seen:
        slow = f'it {slow_reason(status.longest_gap, parameter)}' if status.slow else ''
        return _with(f'{name} is stale', slow or reason)
    if status.state is InputState.UNKNOWN:
        return f'{name} is unknown'
    if link and not reason:
        reason = f'the publisher on {link.topic} has sent nothing yet'
    return _with(f'{name} was never received', reason)


def fault_code(status: InputStatus) -> Fault:
    """Return the code of what is wrong with an input that is not well."""
    if status.state is InputState.BAD:
        return Fault[f'INPUT_{status.why.name}'] if status.why else Fault.INPUT_UNUSABLE
    if status.joints is not None:
        return Fault.INPUT_OTHER_JOINTS
    return Fault[f'INPUT_{status.state.name}']


def _with(what: str, why: str) -> str:
    return f'{what}: {why}' if why else what


def joint_reason(found: OtherJoints, parameter: str) -> str:
    """Return which joints the messages name instead of the one asked for, and what to write."""
    if not found.names:
        return f'the messages name no joints at all, set {parameter}.field to {found.array}[0]'
    names = ', '.join(found.names[:SHOWN_JOINTS])
    more = ', ...' if len(found.names) > SHOWN_JOINTS else ''
    near = difflib.get_close_matches(found.joint, found.names, n=1, cutoff=0.0)
    return (
        f'the messages name {names}{more} and no joint {found.joint}, '
        f'set {parameter}.field to {found.array}[{near[0]}] or another of them'
    )


def slow_reason(gap: float, parameter: str) -> str:
    """Return that gaps of `gap` [s] are too long for the timeout, with one that would do."""
    return (
        'comes less often than its timeout allows: '
        f'set {parameter}.timeout to {enough_timeout(gap)} or more'
    )


def enough_timeout(gap: float) -> float:
    """Return a round timeout [s] of at least twice a `gap` [s] between messages."""
    wanted = min(2.0 * gap, MOST_TIMEOUT)
    decade = 10.0 ** math.floor(math.log10(wanted))
    digit = next(digit for digit in ROUND if digit * decade >= wanted * (1.0 - 1e-9))
    return min(float(f'{digit * decade:.3g}'), MOST_TIMEOUT)
