# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a run came to, and the words for what was lost in it."""

from collections import Counter
from collections.abc import Iterable, Mapping
import dataclasses
from pathlib import Path

from ballscrew_msgs.msg import BallScrewState, InputHealth, PointResult

# Why a sample was not judged, where the sentence in the state names a number of its own.
REASONS = {
    PointResult.VALIDITY_SPEED_BELOW_RANGE: 'speed below the surface',
    PointResult.VALIDITY_SPEED_ABOVE_RANGE: 'speed above the surface',
    PointResult.VALIDITY_LOAD_OUT_OF_RANGE: 'load outside the surface',
    PointResult.VALIDITY_TEMPERATURE_OUT_OF_RANGE: 'oil temperature outside the surface',
}


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


def unjudged(states: Iterable[BallScrewState]) -> Counter[str]:
    """
    Return how many of the states of one axis hold a speed sample without a verdict, by reason.

    Standstill is a verdict, whatever the inputs; a state of a tick holds no sample.

    """
    return Counter(
        REASONS.get(state.result.validity) or state.result.reason or 'the model gives no number'
        for state in states
        if state.zone == BallScrewState.ZONE_UNKNOWN
        and BallScrewState.GATE_STANDSTILL not in state.active_gates
        and speed_health(state).state == InputHealth.STATE_OK
    )


def loss(
    outcome: Outcome,
    axis: str,
    *,
    sent: int,
    expected: int,
    unjudged: Mapping[str, int],
    rate: float,
) -> str:
    """
    Return the sentence on the speed messages of `axis` that were not judged, empty without any.

    `sent` messages of the topic of the speed, `expected` of them with the speed of this axis, were
    sent at `rate` [-], bag time over wall time; `unjudged` are those in the recording, by reason.

    """
    judged, health = outcome.judged(axis), outcome.speed(axis)
    if judged == expected:
        return ''
    lost = max(sent - health.received, 0)
    # Messages that speak of other joints only are dropped too, as they should be.
    refused = max(health.dropped - max(sent - expected, 0), 0)
    parts = [f'{lost} did not reach the node'] if lost else []
    parts += [f'the node refused {refused}'] if refused else []
    parts += [f'{count} had no verdict ({reason})' for reason, count in unjudged.items()]
    return (
        f'axis {axis}: {judged} of {expected} speed messages were judged; '
        + (', '.join(parts) or 'the recording does not say why')
        + (f'; at {rate:g}x messages may be lost, a lower rate helps' if rate > 1 and lost else '')
    )
