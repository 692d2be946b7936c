# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Full solves one after another: a bounded queue before one process, with a limit of time for each.

Nothing in here waits, and time is an argument: `poll` is called now and then, moves things on and
returns what has happened. The process is anything with `send`, `frames` and `kill`, and is made
when it is first needed; one that is lost is replaced.

"""

from collections import deque
from collections.abc import Callable
import dataclasses
import enum
import math
from typing import Any, Protocol

MOST_WAITING = 8
"""Solves that may wait while one is at work [-]."""
GRACE = 0.2  # [s] in which a solve may end by itself when it is taken back
NAN = math.nan


class Process(Protocol):
    """What does the solves."""

    def send(self, frame: dict[str, Any]) -> None:
        """Hand a frame over."""

    def frames(self) -> list[dict[str, Any]]:
        """Return the frames that have come back."""

    def kill(self) -> None:
        """End the process."""


class End(enum.Enum):
    """How a solve ended."""

    SOLVED = 'solved'
    FAILED = 'failed'
    CANCELLED = 'cancelled'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """
    How far a solve is.

    Stage in a word; nut 1 loaded, 2 relieved, and side 1 screw, 2 nut, of the contact at work, 0
    none; iteration; relative residual [-], part done [-] and time left [s], NaN while unknown.

    """

    stage: str = ''
    nut: int = 0
    side: int = 0
    iteration: int = 0
    residual: float = NAN
    fraction: float = 0.0
    seconds_left: float = NAN


@dataclasses.dataclass(kw_only=True, eq=False, slots=True)
class Job:
    """A solve that was asked for: the request, and the time [s] that it may take once begun."""

    request: dict[str, Any]
    timeout: float
    step: Step = Step(stage='waiting')
    began: float = NAN
    cancelled: float = NAN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Done:
    """A solve that has ended: the result of the process, or a sentence; `wall_time` [s]."""

    job: Job
    end: End
    result: dict[str, Any] = dataclasses.field(default_factory=dict)
    sentence: str = ''
    wall_time: float = NAN


class Solver:
    """The queue, and the process that works on it."""

    def __init__(self, start: Callable[[], Process]) -> None:
        """Begin with nothing to do and no process."""
        self._start = start
        self._process: Process | None = None
        self._waiting: deque[Job] = deque()
        self._job: Job | None = None

    @property
    def busy(self) -> bool:
        """Tell whether a solve is at work or waits."""
        return self._job is not None or bool(self._waiting)

    @property
    def refusal(self) -> str:
        """Return why no more solves are taken, empty if they are."""
        if len(self._waiting) < MOST_WAITING:
            return ''
        return f'{len(self._waiting)} solves wait already, no more than {MOST_WAITING} may'

    def submit(self, job: Job) -> None:
        """Take a solve; the caller has asked for the `refusal` before."""
        self._waiting.append(job)

    def cancel(self, job: Job, now: float) -> None:
        """Take a solve back at `now` [s]."""
        job.cancelled = now
        if job is self._job and self._process is not None:
            self._process.send({'cancel': None})

    def close(self) -> None:
        """End the process and forget all solves."""
        self._waiting.clear()
        self._job = None
        self._end_process()

    def poll(self, now: float) -> list[Done]:
        """Move on at `now` [s]; return the solves that have ended."""
        done = [
            Done(job=job, end=End.CANCELLED)
            for job in self._waiting
            if not math.isnan(job.cancelled)
        ]
        self._waiting = deque(job for job in self._waiting if math.isnan(job.cancelled))
        ended = self._listen(now) or self._overdue(now)
        if ended is not None:
            self._job = None
            done.append(ended)
        if self._job is None and self._waiting:
            self._begin(self._waiting.popleft(), now)
        return done

    def _begin(self, job: Job, now: float) -> None:
        if self._process is None:
            self._process = self._start()
        self._job, job.began, job.step = job, now, Step(stage='starting')
        self._process.send({'solve': job.request})

    def _listen(self, now: float) -> Done | None:
        """Take the frames of the process; return the end of the solve, if it has come."""
        if self._job is None or self._process is None:
            return None
        for frame in self._process.frames():
            ended = self._take(self._job, frame, now)
            if ended is not None:
                return ended
        return None

    def _take(self, job: Job, frame: dict[str, Any], now: float) -> Done | None:
        if 'progress' in frame:
            job.step = step_of(frame['progress'], now - job.began)
            return None
        if 'lost' in frame:
            self._end_process()
        spent = now - job.began
        if not math.isnan(job.cancelled):
            return Done(job=job, end=End.CANCELLED, wall_time=spent)
        if 'solved' in frame:
            return Done(job=job, end=End.SOLVED, result=frame['solved'], wall_time=spent)
        sentence = frame.get('failed') or frame.get('lost') or 'the process gave no result'
        return Done(job=job, end=End.FAILED, sentence=sentence, wall_time=spent)

    def _overdue(self, now: float) -> Done | None:
        """End a solve that was taken back and did not stop, or that takes too long."""
        job = self._job
        if job is None:
            return None
        spent = now - job.began
        if now - job.cancelled >= GRACE:
            self._end_process()
            return Done(job=job, end=End.CANCELLED, wall_time=spent)
        if spent >= job.timeout:
            self._end_process()
            part = 100 * job.step.fraction
            text = f'stopped after its timeout of {job.timeout:g} s, {part:.0f} % done'
            return Done(job=job, end=End.FAILED, sentence=text, wall_time=spent)
        return None

    def _end_process(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process = None


def step_of(frame: dict[str, Any], spent: float) -> Step:
    """Return the step that a frame speaks of, `spent` [s] after the solve began."""
    known: dict[str, Any] = {
        name: NAN if value is None else value for name, value in frame.items()
    }
    part = known.get('fraction', 0.0)
    left = spent * (1.0 - part) / part if part > 0.0 else NAN
    return Step(**known, seconds_left=left)
