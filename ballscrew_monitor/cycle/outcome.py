# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The plan of a run, checked before anything is started or written, and its outcome.

The words for what was lost, the summary, and the report.

"""

from collections import Counter
from collections.abc import Mapping, Sequence
import dataclasses
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.prerequisites import require
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import LogFacts, parameters_text, PREFIX
from ballscrew_monitor.recordings.replay import speed_messages
from ballscrew_monitor.recordings.summary import summary_of
from ballscrew_monitor.recordings.words import counted, say
from ballscrew_monitor.report.logs import check_output, JUDGED, PAGE, PICTURE
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, build_axis
from ballscrew_monitor.settings.parameters import absolute, input_topics, output, with_types
from ballscrew_msgs.msg import BallScrewState, InputHealth, OutOfZone
from rclpy.serialization import deserialize_message
from surrogate.files import InputError

RECORDING = 'cycle'  # in the output directory, without its ending
LOG = 'node.log'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Plan:
    """
    A checked run: what is played, with which parameters, and where it is written.

    `expected` counts the speed messages by axis, `rate` is bag time over wall time [-].

    """

    bag: Bag
    params: Path
    values: dict[str, Any]
    axes: Sequence[Axis]
    expected: dict[str, int]
    rate: float
    out: Path


def plan(bag: Path, params: Path, out: Path, rate: float) -> Plan:
    """
    Return a checked plan for bag time over wall time `rate` [-].

    A bag that has lost its end is played up to there; its notes say how much that is. Raises
    InputError before anything is started or written.

    """
    require('numba', 'matplotlib', 'polars', 'contourpy')  # for the report, at the end
    if not 0.0 < rate <= 1000.0:
        raise InputError(f'rate is {rate:g}, allowed is above 0 to 1000')
    check_output(out)
    opened = Bag(bag, salvage=True)
    values = with_types(parameters.read_file(params), opened.types)
    axes = [build_axis(name, values) for name in values['axes']]
    taken = {(out / f'{RECORDING}.mcap').resolve(), (out / JUDGED / f'{JUDGED}.mcap').resolve()}
    if any(file.resolve() in taken for file in opened.files):
        raise InputError(
            f'bag {bag} would be overwritten by the recording in {out}, '
            'another output directory must be given'
        )
    opened.require(input_topics(values))
    return Plan(
        bag=opened,
        params=params,
        values=values,
        axes=axes,
        rate=rate,
        out=out,
        expected=speed_messages(opened, axes),
    )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """
    What a run came to.

    Messages sent by topic, messages recorded, and the last state by axis; longest time by which a
    message was sent late and processor time of the node [s]; sentences on what failed.

    """

    recording: Path
    sent: Counter[str]
    recorded: int
    states: Mapping[str, BallScrewState]
    lateness: float
    cpu_time: float
    failures: tuple[str, ...]

    def judged(self, axis: str) -> int:
        """Return how many speed samples of `axis` were judged."""
        return int(self.states[axis].judged) if axis in self.states else 0

    def speed(self, axis: str) -> InputHealth:
        """Return the health of the speed of `axis` at last."""
        return speed_health(self.states[axis]) if axis in self.states else InputHealth()


def speed_health(state: BallScrewState) -> InputHealth:
    """Return what a state says of its speed input."""
    return next(health for health in state.inputs if health.name == 'speed')


def losses(plan: Plan, outcome: Outcome) -> tuple[str, ...]:
    """Return a sentence for each axis of which a speed message was not judged."""
    sentences = (
        loss(outcome, axis.name, _sent(outcome, axis), plan.expected[axis.name], plan.rate)
        for axis in plan.axes
    )
    return tuple(filter(None, sentences))


def loss(outcome: Outcome, axis: str, sent: int, expected: int, rate: float) -> str:
    """
    Return the sentence on the speed messages of `axis` that were not judged, empty without any.

    `sent` messages of the topic of the speed, `expected` of them with the speed of this axis, were
    sent at `rate` [-], bag time over wall time.

    """
    judged, health = outcome.judged(axis), outcome.speed(axis)
    if judged >= expected:
        return ''
    lost = max(sent - health.received, 0)
    # Messages that speak of other joints only are dropped too, as they should be.
    refused = max(health.dropped - max(sent - expected, 0), 0)
    rest = expected - judged - lost - refused
    parts = [f'{lost} did not reach the node'] if lost else []
    parts += [f'the node refused {refused}'] if refused else []
    parts += [f'{rest} had no verdict, the recorded states name the reason'] if rest > 0 else []
    slower = (
        f'; at {rate:g}x messages may be lost, a lower rate helps' if rate > 1 and lost else ''
    )
    why = ', '.join(parts)
    return f'axis {axis}: {judged} of {expected} speed messages were judged; {why}{slower}'


def facts(plan: Plan, outcome: Outcome) -> dict[str, str]:
    """Return what a recording says of itself: the parameters of the run, and what became of it."""
    judged = [
        f'axis {axis}: during the run the node judged '
        f'{counted(int(state.judged), "speed sample")} and raised '
        f'{counted(int(state.event_id), "warning")}, '
        f'{state.totals.outside_time:.1f} s were outside the zone; '
        'this page judges the recorded inputs again'
        for axis, state in outcome.states.items()
    ]
    notes = (*judged, *outcome.failures)
    stated = parameters.names_in_file(plan.params)
    log_facts = LogFacts(
        source=plan.bag.path.name, parameters={}, mapping={}, assumptions=(), notes=notes
    )
    return log_facts.texts() | {f'{PREFIX}parameters': parameters_text(plan.values, stated)}


def report(plan: Plan, outcome: Outcome) -> None:
    """Print the summary of every axis, write the report of the recording, and name the files."""
    if not outcome.recorded:
        print(f'files       {plan.out / LOG}; nothing was recorded')
        return
    recorded = Bag(outcome.recording)
    for axis in plan.axes:
        kinds = {
            output(axis.name, 'state'): BallScrewState,
            output(axis.name, 'out_of_zone'): OutOfZone,
        }
        summary = summary_of(
            deserialize_message(message.data, kinds[message.topic])
            for message in recorded.messages(kinds)
        )
        surface = axis.surface
        print(
            f'\naxis {axis.name}: screw {surface.screw_name}, oil {surface.oil_name}, '
            f'{surface.tier.replace("_", "-")} model',
            f'samples     {_sent(outcome, axis)} sent, {outcome.judged(axis.name)} judged, '
            f'{summary.states if summary else 0} states recorded',
            *(summary.lines() if summary else ()),
            sep='\n',
        )
    # Imported here: it takes longer than everything else of the program.
    from ballscrew_monitor.report.log_report import report_log

    try:
        report_log(recorded, plan.out, parameters_for(recorded, None, plan.params), picture=True)
    except InputError as error:  # of a run that ended too early
        say(f'no report: {error}')
    written = [name for name in (PAGE, PICTURE) if (plan.out / name).exists()]
    size = outcome.recording.stat().st_size / 1e6
    files = ', '.join(str(plan.out / name) for name in (*written, LOG))
    print(
        f'\nnode        {outcome.cpu_time:.1f} s of processor time, its start included; '
        f'messages sent at most {1e3 * outcome.lateness:.0f} ms late\n'
        f'files       {outcome.recording} ({size:.1f} MB), {files}'
    )


def _sent(outcome: Outcome, axis: Axis) -> int:
    return outcome.sent[absolute(axis.inputs[-1].topic)]
