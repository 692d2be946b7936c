# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Full solves one after another: a bounded queue before one process, with a limit of time for each.

The queue waits for nothing, and time is an argument: `poll` is called now and then, moves things
on and returns what has happened. The process is made when it is first needed; one that is lost is
replaced.

"""

from collections import deque
from collections.abc import Callable
import contextlib
import dataclasses
import enum
import json
import math
import os
from pathlib import Path
import queue
import subprocess
import sys
import threading
from typing import Any

import surrogate

MODULE = 'surrogate.on_demand.worker'
ONE_THREAD = ('MKL_NUM_THREADS', 'NUMBA_NUM_THREADS', 'OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS')
# Set by the ROS wheels for their own process; a child finds its libraries itself.
WHEEL_VARIABLES = ('LD_LIBRARY_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE')
MOST_FRAMES = 1000  # that wait to be read
LONGEST_FRAME = 1_000_000  # [B]
PATIENCE = 2.0  # [s] for a killed process to be gone
MOST_WAITING = 8  # solves, while one is at work
GRACE = 0.2  # [s] in which a solve may end by itself when it is taken back
NAN = math.nan


class SolverProcess:
    """A worker by name, and the frames that it sends."""

    def __init__(self) -> None:
        """Start the worker."""
        self._frames: queue.Queue[dict[str, Any]] = queue.Queue(maxsize=MOST_FRAMES)
        self._process: Any = subprocess.Popen(
            # By name: plain spawn would import the console script again, and rclpy with it.
            [sys.executable, '-P', '-m', MODULE, str(os.getpid())],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=worker_environment(),
            start_new_session=True,
            text=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def pid(self) -> int:
        """Return the number of the process."""
        return int(self._process.pid)

    def send(self, frame: dict[str, Any]) -> None:
        """Send a frame; one that is gone is noticed by the next `frames`."""
        with contextlib.suppress(OSError):
            self._process.stdin.write(json.dumps(frame, allow_nan=False) + '\n')
            self._process.stdin.flush()

    def frames(self) -> list[dict[str, Any]]:
        """Return the frames that have come; the last one of a process that has ended is `lost`."""
        found = [self._frames.get_nowait() for _ in range(self._frames.qsize())]
        if not found and not self._reader.is_alive():
            found.append({'lost': self._describe_end()})
        return found

    def kill(self) -> None:
        """End the process, whatever it is at."""
        self._process.kill()
        self._process.wait(PATIENCE)
        for pipe in (self._process.stdin, self._process.stdout):
            with contextlib.suppress(OSError):  # what was not written is for nobody
                pipe.close()

    def _read(self) -> None:
        with contextlib.suppress(OSError, ValueError):  # killed in the middle of a line
            while line := self._process.stdout.readline(LONGEST_FRAME):
                self._frames.put(json.loads(line))

    def _describe_end(self) -> str:
        code = self._process.wait(PATIENCE)
        how = f'was killed by signal {-code}' if code < 0 else f'ended with exit code {code}'
        return f'the process of the solve {how}'


def worker_environment() -> dict[str, str]:
    """Return the environment of the worker: one thread, this very code, no libraries of ROS."""
    kept = {name: value for name, value in os.environ.items() if name not in WHEEL_VARIABLES}
    return kept | dict.fromkeys(ONE_THREAD, '1') | {'PYTHONPATH': path_to_this_code()}


def path_to_this_code() -> str:
    """Return a PYTHONPATH that begins with the folder of both packages."""
    folder = str(Path(surrogate.__file__).parents[1])
    return os.pathsep.join(filter(None, (folder, os.environ.get('PYTHONPATH', ''))))


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

    def __init__(self, start: Callable[[], SolverProcess] = SolverProcess) -> None:
        """Begin with nothing to do and no process."""
        self._start = start
        self._process: SolverProcess | None = None
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
