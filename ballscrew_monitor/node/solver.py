# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Full solves one after another: a bounded queue before one worker, with a limit of time for each.

The queue waits for nothing, and time is an argument: `poll` is called now and then, moves things
on and returns what has happened. The worker is made when it is first needed; one that is lost is
replaced.

"""

from collections import deque
from collections.abc import Callable
import dataclasses
import enum
import functools
import math
from typing import Any

from surrogate.tasks.child import Frame, Worker, Workers

TASK = 'surrogate.builder.on_demand:solve'
NICENESS = 10
MEMORY = 6 * 2**30
"""Most memory that the worker may use [B]."""
MOST_WAITING = 8  # solves, while one is at work
GRACE = 0.2  # [s] in which a solve may end by itself when it is taken back
NAN = math.nan


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
    """
    A solve that was asked for: the request, and the time [s] that it may take once begun.

    With its `end` it has the result of the worker or a sentence, and its `wall_time` [s].

    """

    request: dict[str, Any]
    timeout: float
    step: Step = Step(stage='waiting')
    began: float = NAN
    cancelled: float = NAN
    end: End | None = None
    result: dict[str, Any] = dataclasses.field(default_factory=dict)
    sentence: str = ''
    wall_time: float = NAN


def start_worker() -> Workers:
    """Return a pool of one, which begins with the first solve and is no burden to others."""
    return Workers(1, functools.partial(Worker, niceness=NICENESS, memory=MEMORY))


class Solver:
    """The queue, and the worker that works on it."""

    def __init__(self, pool: Callable[[], Workers] = start_worker) -> None:
        """Begin with nothing to do; `pool` returns a pool of one."""
        self._pool = pool()
        self._waiting: deque[Job] = deque()
        self._job: Job | None = None
        self._count = 0

    @property
    def busy(self) -> bool:
        """Return True if a solve is at work or waits."""
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
        if job is self._job:
            self._pool.cancel(self._name)

    def close(self) -> None:
        """End the worker and forget all solves."""
        self._waiting.clear()
        self._job = None
        self._pool.close()

    def poll(self, now: float) -> list[Job]:
        """Move on at `now` [s]; return the solves that have ended."""
        done = [job for job in self._waiting if not math.isnan(job.cancelled)]
        for job in done:
            job.end = End.CANCELLED
        self._waiting = deque(job for job in self._waiting if job.end is None)
        if self._job is not None:
            job = self._job
            ended = self._listen(job, now)
            if not ended and (now - job.cancelled >= GRACE or now - job.began >= job.timeout):
                self._pool.kill(self._name)  # it was taken back and did not stop, or is late
                part = 100 * job.step.fraction
                text = f'stopped after its timeout of {job.timeout:g} s, {part:.0f} % done'
                ended = self._end(job, now, {'sentence': text})
            done += ended
        if self._job is None and self._waiting:
            self._job = self._waiting.popleft()
            self._job.began, self._job.step = now, Step(stage='starting')
            self._count += 1
            self._pool.submit(self._name, TASK, self._job.request)
        return done

    @property
    def _name(self) -> str:
        """Return the name of the solve at work."""
        return f'{self._count}'

    def _listen(self, job: Job, now: float) -> list[Job]:
        """Take what is heard of the solve at work; return its end, if that has come."""
        for name, frame in self._pool.wait(0.0):
            if name != self._name:
                continue
            if 'step' in frame:
                job.step = step_of(frame['step'], now - job.began)
            elif 'begun' not in frame:
                return self._end(job, now, frame)
        return []

    def _end(self, job: Job, now: float, frame: Frame) -> list[Job]:
        """End the solve at work, which was taken back perhaps, with the last frame of it."""
        self._job, job.wall_time = None, now - job.began
        if not math.isnan(job.cancelled):
            job.end = End.CANCELLED
        elif frame.get('result') is not None:
            job.end, job.result = End.SOLVED, frame['result']
        elif 'lost' in frame:
            job.end, job.sentence = End.FAILED, f'the process of the solve {frame["lost"]}'
        else:
            job.end, job.sentence = End.FAILED, frame['sentence']
        return [job]


def step_of(frame: dict[str, Any], spent: float) -> Step:
    """Return the step that a frame speaks of, `spent` [s] after the solve began."""
    part = frame.get('fraction', 0.0)
    left = spent * (1.0 - part) / part if part > 0.0 else NAN
    return Step(**frame, seconds_left=left)
