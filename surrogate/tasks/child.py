# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Child processes of this code: started by the name of a module, watched, and gone with their parent.

A child that reads its input ends with it: whatever ends the parent, the kernel closes the pipe.
A child that reads nothing is killed by the kernel when the parent dies. Nothing is shared between
children, so one that is killed, even in the middle of a large result, leaves neither a lock nor
half a message to the others, and it is known at which task it was.

"""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
import contextlib
import ctypes
import json
import os
from pathlib import Path
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
from typing import Any, Self

from surrogate.files import InputError

ONE_THREAD = ('MKL_NUM_THREADS', 'NUMBA_NUM_THREADS', 'OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS')
# Set by the ROS wheels for their own process; a child finds its libraries itself.
WHEEL_VARIABLES = ('LD_LIBRARY_PATH', '_ROS_WHEELS_BOOTSTRAP_COMPLETE')
PR_SET_PDEATHSIG = 1
WORKER = 'surrogate.tasks.worker'
UNWIND = 5.0
"""Longest time that a task has to put things in order when its worker is ended [s]."""
PATIENCE = 2.0
"""Longest time in which a process whose output has ended is gone, or is killed [s]."""
LONGEST_FRAME = 2**29
"""Longest line of a child [B]: a result may hold a surface file as text."""
Frame = dict[str, Any]
"""A message to or from a child: a line of JSON."""
Task = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""A pure function at the top level of a module, from plain JSON to plain JSON."""


def path_to_this_code(more: Iterable[str] | None = None) -> str:
    """Return a PYTHONPATH: the folder of both packages, then `more` or that of this process."""
    folder = str(Path(__file__).parents[2])
    more = [os.environ.get('PYTHONPATH', '')] if more is None else more
    return os.pathsep.join(filter(None, dict.fromkeys([folder, *more])))


def one_thread_environment(*, wheels: bool = False) -> dict[str, str]:
    """Return the environment of a child of one thread and this code; `wheels` keeps ROS there."""
    dropped = () if wheels else WHEEL_VARIABLES
    kept = {name: value for name, value in os.environ.items() if name not in dropped}
    return kept | dict.fromkeys(ONE_THREAD, '1') | {'PYTHONPATH': path_to_this_code()}


def start(module: str, *arguments: str, **options: Any) -> 'subprocess.Popen[Any]':
    """
    Start a module in a session of its own, out of reach of Ctrl-C; `options` are those of Popen.

    By name: plain spawn would import the console script again, and rclpy with it. Call this from
    a thread that lives as long as a child whose input is no pipe. Raises OSError.

    """
    parent = os.getpid()
    if options.get('stdin') != subprocess.PIPE:
        libc = ctypes.CDLL(None)

        def die_with_parent() -> None:
            libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:  # it was gone before that
                os._exit(1)

        options |= {'preexec_fn': die_with_parent}
    # This very code, whatever lies in the working directory.
    command = [sys.executable, '-P', '-m', module, *arguments]
    return subprocess.Popen(command, start_new_session=True, **options)


def stop(process: 'subprocess.Popen[Any]', steps: Iterable[tuple[signal.Signals, float]]) -> int:
    """End a process and all that it started: a signal, a time to heed it [s], the next one."""
    for number, patience in steps:
        if process.poll() is not None:
            break
        _signal_group(process, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(patience)
    _signal_group(process, signal.SIGKILL)
    return process.wait()


def _signal_group(process: 'subprocess.Popen[Any]', number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, number)


class Worker:
    """A process that runs tasks; `hear` gets its frames from a thread, and `lost` at its end."""

    def __init__(
        self,
        hear: Callable[['Worker', Frame], None],
        *,
        niceness: int = 0,
        memory: int = 0,
        environment: Mapping[str, str] | None = None,
        quiet: bool = False,
    ) -> None:
        """
        Start it; `memory` [B] is the most that it may use, 0 any; a `quiet` one shows nothing.

        Raises OSError.

        """
        self._process: Any = start(
            *(WORKER, str(niceness), str(memory)),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if quiet else None,
            env=one_thread_environment() if environment is None else environment,
            text=True,
        )
        threading.Thread(target=self._read, args=(hear,), daemon=True).start()

    @property
    def pid(self) -> int:
        """Return the number of the process."""
        return int(self._process.pid)

    def send(self, frame: Mapping[str, Any]) -> None:
        """Send a frame; that a process is gone is heard, not noticed here."""
        with contextlib.suppress(OSError):
            self._process.stdin.write(json.dumps(frame) + '\n')
            self._process.stdin.flush()

    def end_input(self) -> None:
        """Let the process end in order."""
        with contextlib.suppress(OSError):  # what was not written is for nobody
            self._process.stdin.close()

    def kill(self, patience: float = 0.0) -> None:
        """End the process, after some time [s] whatever it is at."""
        self.end_input()
        try:
            if patience > 0.0:
                self._process.wait(patience)
        except subprocess.TimeoutExpired:
            pass
        finally:  # whatever interrupts the wait
            self._process.kill()
        self._process.wait(PATIENCE)

    def _read(self, hear: Callable[['Worker', Frame], None]) -> None:
        with contextlib.suppress(OSError, ValueError), self._process.stdout as lines:
            while line := lines.readline(LONGEST_FRAME):
                hear(self, json.loads(line))
        try:
            code = self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = self._process.wait()
        killed, ended = f'was killed by signal {-code}', f'ended with exit code {code}'
        hear(self, {'lost': killed if code < 0 else ended})


def result_apart(
    task: str, inputs: Mapping[str, Any], *, memory: int, failure: str, niceness: int = 0
) -> Any:
    """
    Return the result of a task, `module:function`, that reads what may kill its process.

    It runs in a child of a `niceness` that may use `memory` [B]. Raises InputError: `failure` and
    how the child ended, or the sentence of the task; and OSError if there can be no child.

    """
    heard: queue.SimpleQueue[Frame] = queue.SimpleQueue()
    options: dict[str, Any] = {'niceness': niceness, 'memory': memory, 'quiet': True}
    worker = Worker(lambda _, frame: heard.put(frame), **options)
    try:
        worker.send({'task': task, 'inputs': dict(inputs)})
        frame = heard.get()
        while not frame.keys() & {'result', 'lost'}:
            frame = heard.get()
    finally:
        worker.kill()
    if 'lost' in frame:
        allowed = f', it may use {memory / 1e6:.0f} MB of memory' if memory else ''
        raise InputError(f'{failure}: its reader {frame["lost"]}{allowed}')
    if sentence := frame['sentence']:
        lacking = sentence.startswith(MemoryError.__name__)
        reason = f'{failure}: it may use {memory / 1e6:.0f} MB of memory, it needs more'
        raise InputError(reason if lacking else sentence)
    return frame['result']


class Workers:
    """
    A number of workers, each started when it is first needed; one that is lost is replaced.

    Tasks wait for a free worker. For one thread alone.

    """

    def __init__(self, number: int, start_worker: Callable[..., Worker] = Worker) -> None:
        """Begin with no process; `start_worker` is called with what hears the frames of one."""
        self._number, self._start = number, start_worker
        self._waiting: deque[tuple[str, Frame]] = deque()
        self._names: dict[Worker, str] = {}  # of the tasks at work
        self._idle: list[Worker] = []
        self._heard: queue.SimpleQueue[tuple[Worker | str, Frame]] = queue.SimpleQueue()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close(UNWIND)

    def submit(self, name: str, task: str, inputs: Mapping[str, Any]) -> None:
        """Hand a task over, `module:function`, under a name that no other task at work has."""
        self._waiting.append((name, {'task': task, 'inputs': inputs}))
        self._begin()

    def wait(self, seconds: float) -> list[tuple[str, Frame]]:
        """
        Return names of tasks and what is heard of them, within some time [s].

        `begun` has the name of the worker, `step` what the task says of its way; `result` is the
        end of a task, as is `lost`, which says how its worker ended.

        """
        heard = []
        with contextlib.suppress(queue.Empty):
            heard.append(self._heard.get(timeout=seconds) if seconds else self._heard.get_nowait())
            while True:
                heard.append(self._heard.get_nowait())
        frames = [(self._take(source, frame), frame) for source, frame in heard]
        self._begin()
        return [(name, frame) for name, frame in frames if name is not None]

    def cancel(self, name: str) -> None:
        """Let the task of a name know that its result is for nobody."""
        for worker, other in self._names.items():
            if other == name:
                worker.send({'cancel': None})

    def kill(self, name: str) -> None:
        """End the worker of a task; nothing more is heard of it."""
        for worker in [source for source, other in self._names.items() if other == name]:
            del self._names[worker]
            worker.kill()

    def close(self, patience: float = 0.0) -> None:
        """End all workers, those at work after some time [s] at most, and forget all tasks."""
        workers, deadline = [*self._names, *self._idle], time.monotonic() + patience
        self._waiting.clear()
        self._names.clear()
        self._idle.clear()
        for worker in workers:
            worker.end_input()
        try:
            for worker in workers:
                worker.kill(deadline - time.monotonic())
        finally:  # whatever interrupts the wait
            for worker in workers:
                worker.kill()

    def _begin(self) -> None:
        while self._waiting and (self._idle or len(self._names) < self._number):
            name, frame = self._waiting.popleft()
            try:
                worker = self._idle.pop() if self._idle else self._start(self._hear)
            except OSError as error:
                lost = {'lost': f'cannot be started, {error.strerror}'}
                for note in ({'begun': f'{socket.gethostname()}/-'}, lost):
                    self._heard.put((name, note))
                continue
            self._names[worker] = name
            self._heard.put((worker, {'begun': f'{socket.gethostname()}/{worker.pid}'}))
            worker.send(frame)

    def _hear(self, worker: Worker, frame: Frame) -> None:
        self._heard.put((worker, frame))

    def _take(self, source: Worker | str, frame: Frame) -> str | None:
        """Return which task a frame speaks of, None for one that nobody waits for."""
        if isinstance(source, str):
            return source
        name = self._names.get(source)
        if 'lost' in frame:
            self._names.pop(source, None)
            self._idle = [worker for worker in self._idle if worker is not source]
            source.kill()
        elif 'result' in frame and name is not None:
            del self._names[source]
            self._idle.append(source)
        return name
