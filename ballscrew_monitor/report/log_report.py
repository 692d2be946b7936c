# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One recording, judged and reported into a directory of its own.

Judged rows wait there in a table, so that a recording may be larger than memory, and pages ask for
what they draw. The folder of the table is hidden and does not outlive the report: a process keeps
a lock in it as long as it lives, so that one that was left by a killed process is known from one
in use, also on a network file system that knows locks.

"""

from collections.abc import Collection, Iterator, Sequence
import contextlib
import csv
import dataclasses
import fcntl
import math
from pathlib import Path
import shutil
import uuid

from ballscrew_monitor.core.judgement import Code
from ballscrew_monitor.health.records import UsualWarning
from ballscrew_monitor.health.usual import warning_at
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.declared import keys, plain
from ballscrew_monitor.recordings.replay import ignore
from ballscrew_monitor.recordings.summary import EventRecord
from ballscrew_monitor.recordings.words import counted
from ballscrew_monitor.report import logs
from ballscrew_monitor.report.health_history import AxisHistory, health_after
from ballscrew_monitor.report.inputs_seen import hints_on, missing_inputs
from ballscrew_monitor.report.judged_bag import judged_bag
from ballscrew_monitor.report.judging import badness, judge_log, LogCase, OnShare, RCS
from ballscrew_monitor.report.ledger import speed_ledger, unjudged_share
from ballscrew_monitor.report.log_page import maps_of, report_page
from ballscrew_monitor.report.machines import MachineAxis
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.report.printed import summary_record
from ballscrew_monitor.report.row_table import RowStore
from ballscrew_monitor.report.verdict import VerdictKind, verdicts_of
from surrogate.files import json_text, new_file, new_folder, replace_file

PREFIX, LOCK = '.rows-', 'lock'


@contextlib.contextmanager
def scratch_folder(directory: Path) -> Iterator[Path]:
    """Give a folder in `directory` until the block ends, and remove what was left of others."""
    with new_folder(directory):
        remove_left(directory)
        # Named before it is there, so that no interrupt comes between its making and the `try`.
        folder = directory / f'{PREFIX}{uuid.uuid4().hex}'
        try:
            folder.mkdir(mode=0o700)
            with (folder / LOCK).open('w') as lock:
                with contextlib.suppress(OSError):  # without locks, nobody removes what is left
                    fcntl.flock(lock, fcntl.LOCK_EX)
                yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def remove_left(directory: Path) -> None:
    """Remove the folders in `directory` whose process is gone."""
    for folder in directory.glob(f'{PREFIX}*'):
        with contextlib.suppress(OSError), (folder / LOCK).open('r+') as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)


JUDGED_SHARE, STORED_SHARE = 0.92, 0.95
"""Share of the work [-] that is done when all is judged, and when the rows are one file."""
MADE = 'made'
"""Folder in which a report is made, within the one of its rows."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisLine:
    """
    What an overview says of an axis of a recording, and its machine.

    `begins` [s] since 1970, time recorded, in motion, outside and surely so [s], NaN where not
    known; the worst event in words, and its depth [-]. How many samples of the speed there should
    be, how many were judged, and why no others; what to do, whether it is normal, and the inputs
    that were not measured. `places` hold kind and place of each warning, as far as it is known,
    and `usual` of how many the baseline already had.

    """

    axis: str
    standing: str
    verdict: str
    begins: float = math.nan
    recorded: float = math.nan
    running_time: float = math.nan
    outside_time: float = math.nan
    surely_outside: float = math.nan
    warnings: int = 0
    worst: str = ''
    depth: float = math.nan
    machine: str = ''
    expected: int = 0
    judged: int = 0
    losses: str = ''
    remedy: str = ''
    normal: str = ''
    missing: Sequence[str] = ()
    places: Sequence[Sequence[int]] = ()
    usual: int = 0

    def with_usual(self, usual_warnings: Collection[tuple[int, ...]]) -> 'AxisLine':
        """Return it with its usual warnings counted; where all are usual, so is its standing."""
        usual = sum(tuple(place) in usual_warnings for place in self.places)
        standing = 'usual' if usual and usual == self.warnings else self.standing
        return dataclasses.replace(self, usual=usual, standing=standing)

    @property
    def tag(self) -> str:
        """Return the verdict in a word or two."""
        return 'Usual' if self.standing == 'usual' else VerdictKind(self.standing).word

    @property
    def told(self) -> str:
        """Return the verdict, and how many of the warnings are usual."""
        if not self.usual:
            return self.verdict
        return (
            f'{self.verdict} Usual for this axis, as its baseline had them: {self.usual} of '
            f'{counted(self.warnings, "warning")}.'
        )

    @property
    def key(self) -> MachineAxis:
        """Return what it is told apart by."""
        return MachineAxis(self.machine, self.axis)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LogResult:
    """
    What became of a recording: a line for each axis, and those on which nothing was judged.

    Its `folder` is below that of the page over all; `failure` is why it could not be read, empty
    if it could. `hints` say what contradicts itself among the inputs; `unjudged_share` is the
    largest share of an axis that was not judged [-]; `histories` are what the health of its axes
    rests on.

    """

    name: str
    folder: str = ''
    failure: str = ''
    lines: Sequence[AxisLine] = ()
    unjudged: Sequence[str] = ()
    notes: Sequence[str] = ()
    hints: Sequence[str] = ()
    unjudged_share: float = 1.0
    missed_share: float = 0.0
    histories: Sequence[AxisHistory] = ()

    @property
    def judged(self) -> bool:
        """Return True if something was judged on at least one axis."""
        return len(self.unjudged) < len(self.lines)


def report_log(
    bag: Bag,
    out: Path,
    parameters: LogParameters,
    *,
    on_share: OnShare = ignore,
    picture: bool = False,
) -> LogResult:
    """
    Judge a recording; write page, states, events, summary and judged bag into `out`.

    `on_share` is told which share of all that is done [-]; a `picture` of the page is made too if
    that is asked for. All is made in a hidden folder first:
    what stops it, be it an error or an interrupt, leaves what was in `out` before. Raises
    InputError when it cannot be read with the parameters.

    """
    logs.check_output(out)
    with scratch_folder(out) as folder:
        store, report = RowStore(folder), folder / MADE
        with judged_bag(
            bag, parameters.values, report / logs.JUDGED, parameters.metadata
        ) as add_state:
            log = judge_log(
                bag,
                parameters,
                on_share=lambda judged: on_share(JUDGED_SHARE * judged),
                rows=store,
                on_state=add_state,
                health=True,
            )
        log = with_health(log)
        with new_file(report / logs.STATES) as partial:
            store.write(partial)
        on_share(STORED_SHARE)
        write_events(report / logs.EVENTS, log)
        replace_file(report / logs.SUMMARY, json_text(summary_record(log)).encode())
        maps = maps_of(log)
        replace_file(report / logs.PAGE, report_page(log, maps).encode())
        if picture and maps:
            from ballscrew_monitor.report.picture import draw_log  # slow to load, seldom needed

            draw_log(log, maps, report / logs.PICTURE)
        logs.replace_report(report, out)
        on_share(1.0)
        return _result(log)


def with_health(log: LogCase) -> LogCase:
    """Return a recording with the health of its axes, as far as it alone tells it."""
    axes = [
        case
        if case.history is None
        else dataclasses.replace(case, health=health_after(case.history))
        for case in log.axes
    ]
    return dataclasses.replace(log, axes=axes)


def write_events(path: Path, log: LogCase) -> None:
    """Write the events of all axes, those of an axis in order."""
    with new_file(path) as partial, partial.open('w', newline='', encoding='utf-8') as file:
        heads = dict.fromkeys(('axis', 'event_id', 'start_stamp_ns', 'start_s'))
        writer = csv.DictWriter(file, list(heads | keys(EventRecord)), lineterminator='\n')
        writer.writeheader()
        for case in log.axes:
            for event in case.outcome.events:
                more = {'axis': case.axis, 'start_s': case.since_first(event.start)}
                writer.writerow(plain(event) | more)


def _result(log: LogCase) -> LogResult:
    cases = {case.axis: case for case in log.axes}
    lines = []
    for axis, verdict in zip([*cases, *log.empty], verdicts_of(log), strict=True):
        line = AxisLine(
            axis=axis,
            standing=verdict.standing.value,
            verdict=verdict.whole,
            machine=log.machine,
            remedy=verdict.remedy,
            normal=verdict.normal,
        )
        if case := cases.get(axis):
            summary, worst = case.outcome.summary(), next(iter(case.worst_first), None)
            ledger = speed_ledger(case)
            line = dataclasses.replace(
                line,
                expected=ledger.expected if ledger else 0,
                judged=ledger.judged if ledger else 0,
                losses=ledger.words if ledger else '',
                missing=missing_inputs(case),
                begins=case.begins,
                recorded=case.survey.span,
                running_time=math.nan if summary is None else summary.running_time,
                outside_time=case.outside_time,
                surely_outside=min(case.surely_outside, case.outside_time),
                warnings=len(case.outcome.events),
                places=[place for place in map(_place, case.outcome.events) if place is not None],
                worst=f'{worst.quantity} {worst.shown(worst.worst_value)}' if worst else '',
                depth=badness(worst)[0] if worst else math.nan,
            )
        lines.append(line)
    return LogResult(
        name=log.name,
        lines=lines,
        unjudged=log.unjudged,
        notes=log.notes,
        hints=hints_on(log.axes),
        unjudged_share=unjudged_share(log),
        missed_share=log.missed_share,
        histories=[case.history for case in log.axes if case.history],
    )


def _place(event: EventRecord) -> UsualWarning | None:
    code = Code.RCS_HIGH if event.quantity == RCS else Code.EFFICIENCY_LOW
    return warning_at(code, speed=event.speed, axial_load=event.axial_load)
