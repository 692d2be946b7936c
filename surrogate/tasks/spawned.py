# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
An executor of spawned processes that survives the loss of any of them.

Each process has a pipe of its own and a thread here that feeds it. Nothing is shared between the
processes, so one that is killed, even in the middle of a large result, can neither hold a lock nor
leave half a message for the others, and it is known at which call it was. The standard executor
shares a pipe and a lock, and a kill at the wrong moment makes it wait forever; loky shares a queue
of results, too, gives up all its workers when one is lost, and pickles code.

"""

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager
import multiprocessing
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
import os
import queue
import signal
import socket
import threading
import time
from typing import Any

from surrogate.tasks.worker import serve, UNWIND

ONE_THREAD = ('MKL_NUM_THREADS', 'OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS')
Call = tuple[Future[Any], Callable[..., Any], tuple[Any, ...]]


class LostWorker(BrokenExecutor):
    """The process that was at a call has ended; the call may be submitted again."""


@contextmanager
def apart() -> Iterator[None]:
    """
    Let processes and threads that start meanwhile run one thread each and not see Ctrl-C.

    Both are inherited, so there is no moment in which a new process would be hit. Ctrl-C is for
    the main thread alone, which then ends its workers.

    """
    # Started with the first process, the tracker would unblock what is blocked here.
    resource_tracker.ensure_running()
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(dict.fromkeys(ONE_THREAD, '1'))
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


class SpawnedWorkers(Executor):
    """
    Processes that run calls of functions at the top level of modules.

    A call whose process ends fails with LostWorker, and a new process takes its place. The
    processes end at `shutdown`, also those at work, and when this process dies, however it does:
    a call may put things in order before, if that takes no longer than `UNWIND`.

    """

    def __init__(
        self,
        workers: int,
        began: Callable[[tuple[Any, ...], str], None],
        told: Callable[[tuple[Any, ...], float], None] = lambda arguments, share: None,
    ) -> None:
        """
        Prepare for `workers` processes.

        `began` is told arguments and worker of each call, `told` the arguments of a call and the
        share [-] that it says is done; both from any thread. What they raise is raised by the
        call when it is done.

        """
        self._began, self._told = began, told
        self._calls: queue.SimpleQueue[Call | None] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._closed = False
        self._processes: set[SpawnProcess] = set()
        self._threads = [threading.Thread(target=self._feed, daemon=True) for _ in range(workers)]
        with apart():
            for thread in self._threads:
                thread.start()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Hand a call over; arguments by position only, result and arguments are pickled."""
        if kwargs:
            raise TypeError('arguments are handed over by position')
        future: Future[Any] = Future()
        with self._lock:
            if self._closed:
                raise RuntimeError('the workers have been ended')
            self._calls.put((future, fn, args))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """
        End all processes, also those at work; calls that were not begun are cancelled.

        Calls end by SystemExit, if one waits for that; what is still there after `UNWIND` is
        killed.

        """
        with self._lock:
            self._closed = True
            for process in self._processes if wait else ():
                process.terminate()
        for _ in self._threads:
            self._calls.put(None)
        try:
            self._join(time.monotonic() + UNWIND if wait else 0.0)
        finally:  # whatever interrupts the wait
            with self._lock:
                for process in self._processes:
                    process.kill()
        for thread in self._threads if wait else ():
            thread.join()

    def _join(self, deadline: float) -> None:
        """Wait for the end of all calls until a time [s]."""
        for thread in self._threads:
            thread.join(max(0.0, deadline - time.monotonic()))

    def _feed(self) -> None:
        """Serve one process with calls, or several, one after another."""
        process: SpawnProcess | None = None
        pipe: Connection | None = None
        while (call := self._calls.get()) is not None:
            future, fn, args = call
            if self._closed:
                future.cancel()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                if process is None or pipe is None:
                    process, pipe = self._spawn()
                heard = [_error_of(self._began, args, f'{socket.gethostname()}/{process.pid}')]
                pipe.send((fn, args))
                while isinstance(answer := pipe.recv(), float):
                    heard.append(_error_of(self._told, args, answer))
                result, error = answer
                error = next(filter(None, (error, *heard)), None)
            except (EOFError, OSError):
                self._bury(process, pipe)
                process = pipe = None
                future.set_exception(LostWorker('its process has ended'))
                continue
            except Exception as failure:  # what cannot be pickled is this call's alone
                future.set_exception(failure)
                continue
            if error is None:
                future.set_result(result)
            else:
                future.set_exception(error)
        self._bury(process, pipe)

    def _spawn(self) -> tuple[SpawnProcess, Connection]:
        """Start a process; raises OSError when the workers are being ended."""
        context = multiprocessing.get_context('spawn')
        ours, theirs = context.Pipe()
        process = context.Process(target=serve, args=(theirs,), daemon=True)
        with self._lock:
            if self._closed:
                raise OSError('the workers have been ended')
            with apart():
                process.start()
            self._processes.add(process)
        # The other end is the process's alone, so that its end is the end of the pipe.
        theirs.close()
        return process, ours

    def _bury(self, process: SpawnProcess | None, pipe: Connection | None) -> None:
        """Make sure that a process has ended."""
        if process is None or pipe is None:
            return
        pipe.close()
        process.kill()
        process.join()
        with self._lock:
            self._processes.discard(process)


def _error_of(listener: Callable[..., None], *told: Any) -> Exception | None:
    """Return what a listener raises: an OSError of its own is no sign of a lost process."""
    try:
        listener(*told)
    except Exception as error:  # handed to the caller
        return error
    return None
