# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Faults of an input and their cures: one sentence each, the same wherever it is said.

A sentence changes with the fault alone: it names parameters, topics and joints, and of numbers
only those to be written.

"""

from collections.abc import Callable, Mapping
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
Cure = Callable[[InputStatus, Link | None, str], str]


def _refused(status: InputStatus, link: Link | None, parameter: str) -> str:
    """Return why messages of an input were refused not long ago."""
    texts = [_refusal_reason(why, link, parameter) for why in status.refusing]
    return f'messages are refused: {"; ".join(texts)}'


def _refusal_reason(why: Why, link: Link | None, parameter: str) -> str:
    if why is Why.SEVERAL and link is not None:
        return several_reason(link, parameter)
    code = why.fault
    return f'{code.said}, {code.cure}'


Happens = Callable[[InputStatus, Link | None], Any]
_TROUBLES: dict[Fault, tuple[Happens, Cure | None]] = {
    # Implausible messages have words of their own.
    Fault.REFUSED: (
        lambda status, link: (
            {*status.refusing} - {Why.IMPLAUSIBLE} and status.refused_share >= SHARE
        ),
        _refused,
    ),
    Fault.GLITCHES: (lambda status, link: status.glitching, None),
    Fault.LOST: (lambda status, link: status.losing, None),
    Fault.SIMULATED_STAMPS: (lambda status, link: status.lag > seconds(YEAR), None),
    Fault.LAG: (lambda status, link: status.lagging, None),
    Fault.SLOW: (
        lambda status, link: status.slow,
        lambda status, link, parameter: slow_reason(status.longest_gap, parameter),
    ),
    Fault.SOURCES_UNKNOWN: (lambda status, link: link is not None and link.several is None, None),
    Fault.LOSS_UNKNOWN: (lambda status, link: status.lost is None, None),
}
"""Faults of inputs that are judged, the worst first: when each happens, and what says it."""


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
    read = [
        (status, links.get(status.source))
        for status in inputs
        if status.state is not InputState.NOT_CONFIGURED
    ]
    for code, (happens, cure) in _TROUBLES.items():
        statuses = [status for status, link in read if happens(status, link)]
        if statuses:
            return (
                Standing.DEGRADED,
                _trouble(axis, statuses, links, cure or f'{code.said}: {code.cure}'),
                code,
            )
    remarks = [Standing.GOOD.value]
    few = [status for status in inputs if status.refusing]
    if few:
        remarks.append(f'a few {_trouble(axis, few, links, _refused)}')
    for status in inputs:
        link = links.get(status.source)
        if link is not None and link.several:
            remarks.append(f'{status.source.name.lower()} comes from {senders(link)}')
    return Standing.GOOD, '; '.join(remarks), Fault.NONE


def _parameter(axis: str, source: Source) -> str:
    return f'{axis}.{source.name.lower()}'


def _trouble(
    axis: str, statuses: list[InputStatus], links: Mapping[Source, Link], cure: str | Cure
) -> str:
    names = [status.source.name.lower() for status in statuses]
    if isinstance(cure, str):
        return f'{" and ".join(names)} {cure}'
    return '; '.join(
        f'{name} {cure(status, links.get(status.source), _parameter(axis, status.source))}'
        for name, status in zip(names, statuses, strict=True)
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
        return status.why.fault if status.why else Fault.INPUT_UNUSABLE
    if status.joints is not None:
        return Fault.INPUT_OTHER_JOINTS
    return Fault[f'INPUT_{status.state.name}']


def _with(what: str, why: str) -> str:
    return f'{what}: {why}' if why else what


def joint_reason(others: OtherJoints, parameter: str) -> str:
    """Return which joints the messages name instead of the one asked for, and what to write."""
    if not others.names:
        return f'the messages name no joints at all, set {parameter}.field to {others.array}[0]'
    names = ', '.join(others.names[:SHOWN_JOINTS])
    more = ', ...' if len(others.names) > SHOWN_JOINTS else ''
    near = difflib.get_close_matches(others.joint, others.names, n=1, cutoff=0.0)
    return (
        f'the messages name {names}{more} and no joint {others.joint}, '
        f'set {parameter}.field to {others.array}[{near[0]}] or another of them'
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
