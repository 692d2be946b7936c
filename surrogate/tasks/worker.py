# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Worker process: it runs one task after another and never outlives its parent.

Light to import, so that a worker starts fast; what a task needs is imported with the task.

"""

from collections.abc import Callable, Mapping
from contextvars import ContextVar
from multiprocessing import parent_process
from multiprocessing.connection import Connection, wait
import os
import pickle
import signal
import socket
import threading
import time
from typing import Any

from surrogate.tasks.store import plain_result

UNWIND = 5.0
"""Longest time that a call has to put things in order when its process is ended [s]."""
Task = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""A pure function at the top level of a module, from plain JSON to plain JSON."""

OnShare = Callable[[str, float], None]
"""Told the name of a task at work and which share of it is done [-], from any thread."""
SHARE_STEP = 0.01
"""A worker tells when a task has advanced by this share [-]."""


class ShareTeller:
    """Hands on how far a task is, not more often than is worth it."""

    def __init__(self, send: Callable[[float], object]) -> None:
        """Begin a task; `send` takes a share [-]."""
        self._send, self._told = send, 0.0

    def tell(self, share: float) -> None:
        """Tell which share is done [-]."""
        if share - self._told >= SHARE_STEP:
            self._told = share
            self._send(share)


teller: ContextVar[ShareTeller | None] = ContextVar('teller', default=None)
"""Whom the task that runs here tells how far it is, if anybody."""


def tell_share(share: float) -> None:
    """Tell those who wait for the task that runs here which share of it is done [-]."""
    found = teller.get()
    if found is not None:
        found.tell(share)


def worker_name() -> str:
    """Return the name of this process, host/pid."""
    return f'{socket.gethostname()}/{os.getpid()}'


def serve(pipe: Connection) -> None:
    """
    Do the calls that come through a pipe until it ends: the main function of a worker process.

    One thread for its kernels, deaf to Ctrl-C, gone when its parent is gone, also from the middle
    of a call, which ends by SystemExit.

    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _unwind)
    os.environ['NUMBA_NUM_THREADS'] = '1'
    threading.Thread(target=_end_with_parent, daemon=True).start()
    while True:
        try:
            message = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        teller.set(ShareTeller(lambda share: pipe.send(float(share))))
        pipe.send_bytes(_call(message))


def _call(message: bytes) -> bytes:
    """Return what a call returns or raises, pickled; either may be something that cannot be."""
    try:
        function, arguments = pickle.loads(message)
        return pickle.dumps((function(*arguments), None))
    except Exception as error:  # handed to the caller
        try:
            return pickle.dumps((None, error))
        except Exception:  # an exception that holds something else
            return pickle.dumps((None, RuntimeError(describe_failure(error))))


def _unwind(number: int, frame: Any) -> None:
    """End the process in order: what a call has half made is removed."""
    signal.signal(number, signal.SIG_IGN)  # nothing interrupts the removal
    raise SystemExit(1)


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        # To the main thread itself: another one does not wake it from what it waits for.
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)
        time.sleep(UNWIND)  # the process may end meanwhile
        os._exit(1)


def run_task(task: Task, name: str, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    Run a task and return its result, or the sentence of its failure, with worker and seconds.

    A failed task never raises: the others go on.

    """
    began, result, sentence = time.perf_counter(), None, ''
    try:
        result = plain_result(task(inputs))
    except Exception as error:  # whatever it is, it is this task's alone
        sentence = describe_failure(error)
    return {
        'result': result,
        'sentence': sentence,
        'worker': worker_name(),
        'seconds': time.perf_counter() - began,
    }


def describe_failure(error: BaseException) -> str:
    """Return one line about an exception; those that are sentences already stay as they are."""
    text = ' '.join(str(error).split())
    is_sentence = type(error).__name__ in ('InputError', 'SurfaceError')
    return text if is_sentence else f'{type(error).__name__}: {text}'
