# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The ledger of an input: messages promised, present, read, judged; a reason for the rest."""

from collections.abc import Mapping
import dataclasses
import math

from ballscrew_monitor.core.inputs import Source, Why
from ballscrew_monitor.core.judgement import Reason
from ballscrew_monitor.recordings.declared import unwritten, written
from ballscrew_monitor.recordings.summary import MessageCounts
from ballscrew_monitor.recordings.words import percent
from ballscrew_monitor.report.judging import AxisCase, LogCase

UNREAD = 'not read from the files'
LOST = 'lost on the way to the node'
OUT_OF_ORDER = 'out of order'
NO_SLOPE = 'out of order or without a position to make a speed with'
IN_GAPS = 'in gaps between samples in motion'
NO_VERDICTS = (Reason.JUDGED, Reason.STANDSTILL)
"""Samples that nothing is missing of: at standstill there is nothing to judge."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Ledger:
    """
    What became of the messages of an input, or of the rows of a table.

    `promised` by the recording, None if it promises no number; `present` in its files; `read`, as
    they are of this input; `judged`, of any input but the speed those that were good to judge
    with. `losses` has the number for each reason of a difference; `others` were of other joints;
    `missed` is the share of the motion that lies between samples [-].

    """

    promised: int | None = written(because='unpromised', default=None)
    present: int
    read: int
    judged: int
    losses: Mapping[str, int]
    others: int = unwritten(default=0)
    missed: float = unwritten(default=0.0)

    @property
    def unpromised(self) -> str:
        """Return why no number was promised."""
        return 'the recording states no number of messages'

    @property
    def expected(self) -> int:
        """Return how many messages of this input there should be."""
        return max(self.promised or 0, self.present, self.read + self.others) - self.others

    @property
    def unjudged_share(self) -> float:
        """Return the share of samples or motion not judged [-], NaN where nothing was to be."""
        left = self.expected - self.judged
        return max(left / self.expected, self.missed) if self.expected > 0 else math.nan

    @property
    def words(self) -> str:
        """Return the reasons with their numbers."""
        reasons = [f'{count} {reason}' for reason, count in self.losses.items()]
        if self.missed:
            reasons.append(f'{percent(self.missed)} of the motion {IN_GAPS}')
        return ', '.join(reasons) or 'none'


def ledger_of(case: AxisCase, source: Source) -> Ledger:
    """Return the ledger of an input of an axis that has a topic."""
    setting, messages = case.inputs[source], _messages(case, source)
    heard, others = messages.heard, messages.others
    present = heard if setting.present is None else setting.present
    promised, lost = setting.promised, 0
    if case.numbered and messages.lost is not None:
        lost = messages.lost
        promised = heard + lost
    absent = 0 if promised is None else promised - present - lost
    losses = {
        setting.absent: absent,
        LOST: lost,
        UNREAD: present - heard,
        Why.OTHER_JOINTS.fault.counted: others,
        **{why.fault.counted: count for why, count in messages.refused.items()},
        NO_SLOPE if setting.from_position else OUT_OF_ORDER: messages.left_out,
    }
    judged, missed = messages.good, 0.0
    if source is Source.SPEED:
        samples = case.survey.samples
        judged = sum(samples.get(reason, 0) for reason in NO_VERDICTS)
        missed = case.survey.missed_share
        losses |= {
            reason.text: count for reason, count in samples.items() if reason not in NO_VERDICTS
        }
    return Ledger(
        promised=promised,
        present=present,
        read=heard - others,
        judged=judged,
        losses={reason: count for reason, count in losses.items() if count > 0},
        others=others,
        missed=missed,
    )


def _messages(case: AxisCase, source: Source) -> MessageCounts:
    if source in case.outcome.messages:
        return case.outcome.messages[source]
    status = next(status for status in case.outcome.inputs if status.source is source)
    return MessageCounts(heard=status.received, left_out=status.dropped)


def speed_ledger(case: AxisCase) -> Ledger | None:
    """Return the ledger of the speed, of which each sample is to be judged, None without one."""
    return ledger_of(case, Source.SPEED) if Source.SPEED in case.inputs else None


def unjudged_share(log: LogCase) -> float:
    """Return the largest share of an axis of a recording that was not judged [-]."""
    shares = [1.0 for _ in log.empty]
    for case in log.axes:
        ledger = speed_ledger(case)
        share = math.nan if ledger is None else ledger.unjudged_share
        shares.append(1.0 if math.isnan(share) else share)
    return max(shares, default=1.0)
