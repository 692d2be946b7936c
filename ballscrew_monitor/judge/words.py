# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Samples and refusals as records of the judgement, and the words that the records leave out."""

import dataclasses
from typing import Any

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, InputStatus, Refusal, Source, Why
from ballscrew_monitor.judge.records import Event, NOT_KNOWN, REFUSAL, SAMPLE
from ballscrew_monitor.judge.views import input_status_of

EARLIEST, LATEST = -(2**61), 2**61
"""Stamps that are judged [ns]; stamps beyond count as these."""
MOST_OTHERS = 16
"""Kinds of messages about other joints that are told apart."""


def within(stamp: int) -> int:
    """Return a stamp [ns] so that differences of stamps fit into 64 bits."""
    return min(max(stamp, EARLIEST), LATEST)


def fill(record: Event, event: InputSample | Refusal) -> None:
    """Fill a record with a sample or a refusal."""
    record.source, record.arrival = int(event.source), within(event.arrival)
    record.lost = NOT_KNOWN if event.lost is None else event.lost
    if isinstance(event, Refusal):
        record.kind, record.why = REFUSAL, int(event.why)
        return
    record.kind, record.value = SAMPLE, float(event.value)
    record.stamp, record.stamp_source = within(event.stamp), int(event.stamp_source)


class InputWords:
    """The sentences of the last refusals, and the joints that messages about others name."""

    def __init__(self) -> None:
        """Begin with nothing heard."""
        self.texts: dict[Source, str] = {}
        self.joints: dict[Source, dict[OtherJoints, None]] = {source: {} for source in Source}

    def hear(self, refusal: Refusal, memory: Any) -> None:
        """Keep the words of a refusal that the memory has not taken yet."""
        if refusal.why is not Why.OTHER_JOINTS:
            self.texts[refusal.source] = refusal.text
        elif refusal.joints is not None:
            heard = self.joints[refusal.source]
            if not memory.others[refusal.source]:  # a good sample has come since
                heard.clear()
            if len(heard) < MOST_OTHERS:
                heard[refusal.joints] = None

    def status(self, memory: Any, settings: Any, source: Source, now: int) -> InputStatus:
        """Return how well an input does at `now` [ns]."""
        joints = self._named(source)
        return input_status_of(memory, settings, source, now, self.texts, joints)

    def _named(self, source: Source) -> OtherJoints | None:
        """Return the joints of all messages about others, of however many publishers."""
        heard = self.joints[source]
        if not heard:
            return None
        names = sorted({name for others in heard for name in others.names})
        return dataclasses.replace(next(iter(heard)), names=tuple(names))
