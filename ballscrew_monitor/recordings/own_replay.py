# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The judgement of a node, repeated from the recording that the node made of itself."""

from collections.abc import Iterator

from ballscrew_monitor.core.inputs import InputSample, Refusal
from ballscrew_monitor.recordings.axis_run import AxisRun, judged_parts, Part
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.entries import entries_of, Told
from ballscrew_monitor.recordings.bulk.source import OnDone
from ballscrew_monitor.recordings.own_recording import OwnRecording, Step

BLOCK = 16384
"""Steps that are judged together."""


def own_parts(
    bag: Bag, *, columns: bool = True, states: bool = True, on_done: OnDone | None = None
) -> Iterator[Part]:
    """
    Yield every state that the node published, the rows that it judged, and all of each axis last.

    The rows come in blocks. An event that an acknowledgement has ended comes with the state after
    that.

    """
    steps = _Steps()
    for step in OwnRecording(bag).steps(on_done):
        if step.axis is None or len(steps) >= BLOCK:
            yield from judged_parts(
                steps.runs, entries_of(steps.taken()), columns=columns, states=states
            )
        if step.axis is not None:
            steps.add(step)
    yield from judged_parts(steps.runs, entries_of(steps.taken()), columns=columns, states=states)
    yield from (run.outcome() for run in steps.runs)


class _Steps:
    """Steps that wait to be judged together, and the axes that they are of."""

    def __init__(self) -> None:
        self.runs: list[AxisRun] = []
        self._numbers: dict[str, int] = {}
        self._waiting: list[Told] = []

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, step: Step) -> None:
        """Let a step wait; a change of an axis takes place at once."""
        assert step.axis is not None
        number = self._numbers.get(step.axis.name)
        if step.event is not None:
            assert number is not None
            self._waiting.append((step.event, _log_time(step.event), len(self), number))
        elif number is None:
            self._numbers[step.axis.name] = len(self.runs)
            self.runs.append(AxisRun(step.axis))
        else:
            self.runs[number].change(step.axis)

    def taken(self) -> list[Told]:
        """Return the steps that wait, and let none wait any more."""
        waiting, self._waiting = self._waiting, []
        return waiting


def _log_time(event: InputSample | Refusal | int) -> int:
    """Return when a step was taken on the clock of the node [ns]."""
    return event if isinstance(event, int) else event.arrival
