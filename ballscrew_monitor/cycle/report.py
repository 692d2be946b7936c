# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What is left of a run: the summary on the terminal and the picture, both from the recording."""

from collections.abc import Iterator
from pathlib import Path

from ballscrew_monitor.cycle.outcome import loss, Outcome, unjudged
from ballscrew_monitor.cycle.plan import Plan
from ballscrew_monitor.cycle.state_trace import Trace, Tracer
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.summary import Summarizer, Summary
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.topics import absolute, output
from ballscrew_msgs.msg import BallScrewState, OutOfZone
from rclpy.serialization import deserialize_message

LOG = 'node.log'


def read_outputs(bag: Bag, axis: str) -> tuple[Summary | None, Trace | None]:
    """Return the summary and the columns of `axis` in a recording; None without a state."""
    state, event = output(axis, 'state'), output(axis, 'out_of_zone')
    summarizer, tracer = Summarizer(), Tracer()
    for message in bag.messages({state, event} & set(bag.topics)):
        if message.topic == state:
            decoded = deserialize_message(message.data, BallScrewState)
            summarizer.add_state(decoded)
            tracer.add_state(decoded)
        else:
            summarizer.add_event(deserialize_message(message.data, OutOfZone))
    return summarizer.result(), tracer.result()


def losses(plan: Plan, outcome: Outcome) -> tuple[str, ...]:
    """Return a sentence for each axis of which a speed message was not judged."""
    sentences = (
        loss(
            outcome,
            axis.name,
            sent=_sent(outcome, axis),
            expected=plan.expected[axis.name],
            unjudged=unjudged(_states(outcome, axis)),
            rate=plan.rate,
        )
        for axis in plan.axes
        if outcome.judged(axis.name) != plan.expected[axis.name]
    )
    return tuple(sentences)


def picture(plan: Plan, axis: Axis) -> Path:
    """Return where the picture of an axis is written."""
    return plan.out / ('cycle.png' if len(plan.axes) == 1 else f'cycle_{axis.name}.png')


def report(plan: Plan, outcome: Outcome) -> None:
    """Print the summary of every axis, write its picture, and name the files."""
    if not outcome.recorded:
        print(f'files       {plan.out / LOG}; nothing was recorded')
        return
    recorded = Bag(outcome.recording)
    pictures = [_report_axis(plan, outcome, axis, recorded) for axis in plan.axes]
    files = [path for path in pictures if path is not None] + [plan.out / LOG]
    print(
        f'\nnode        {outcome.cpu_time:.1f} s of processor time, its start included; '
        f'messages sent at most {1e3 * outcome.lateness:.0f} ms late'
    )
    print(
        f'files       {outcome.recording} ({outcome.recording.stat().st_size / 1e6:.1f} MB), '
        + ', '.join(str(file) for file in files)
    )


def _report_axis(plan: Plan, outcome: Outcome, axis: Axis, recorded: Bag) -> Path | None:
    """Print the summary of an axis and write its picture; return where, None without a state."""
    print(
        f'\naxis {axis.name}: screw {axis.surface.screw_name}, oil {axis.surface.oil_name}, '
        f'{axis.surface.tier.replace("_", "-")} model'
    )
    summary, trace = read_outputs(recorded, axis.name)
    print(
        f'samples     {_sent(outcome, axis)} sent, {outcome.judged(axis.name)} judged, '
        f'{summary.states if summary else 0} states recorded'
    )
    if summary is None or trace is None:
        return None
    print('\n'.join(summary.lines()))
    path = picture(plan, axis)
    # Imported here: it takes longer than everything else of the program.
    from ballscrew_monitor.cycle.plot import draw

    draw(trace, summary, axis.surface, path)
    return path


def _sent(outcome: Outcome, axis: Axis) -> int:
    return outcome.sent[absolute(axis.inputs[-1].topic)]


def _states(outcome: Outcome, axis: Axis) -> Iterator[BallScrewState]:
    """Yield the recorded states of an axis."""
    if not outcome.recorded:
        return
    for message in Bag(outcome.recording).messages({output(axis.name, 'state')}):
        yield deserialize_message(message.data, BallScrewState)
