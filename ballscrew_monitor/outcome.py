# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a run came to, and the words for what was lost in it."""

from collections import Counter
from collections.abc import Mapping
import dataclasses
from pathlib import Path

from ballscrew_msgs.msg import BallScrewState


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """
    What a run came to.

    Messages sent by topic and judged by axis; longest time by which a message was sent late and
    processor time of the node [s]; sentences on what failed.

    """

    recording: Path
    sent: Counter[str]
    judged: dict[str, int]
    lateness: float
    cpu_time: float
    failures: tuple[str, ...]


def losses(
    states: Mapping[str, BallScrewState], expected: Mapping[str, int], *, rate: float
) -> list[str]:
    """
    Return a sentence for each axis of which a speed message was not judged.

    `states` are the last ones, `expected` the number of speed messages that were sent.

    """
    found = []
    for axis, count in expected.items():
        judged = int(states[axis].judged) if axis in states else 0
        if judged != count:
            received = _received(states[axis]) if axis in states else 0
            found.append(
                f'axis {axis}: {judged} of {count} speed messages were judged; '
                f'{max(count - received, 0)} did not reach the node, which left out '
                f'{max(received - judged, 0)}' + _hint(rate)
            )
    return found


def _received(state: BallScrewState) -> int:
    return int(next(health.received for health in state.inputs if health.name == 'speed'))


def _hint(rate: float) -> str:
    return f'; at {rate:g}x messages may be lost, a lower rate helps' if rate > 1.0 else ''
