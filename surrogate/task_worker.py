# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What runs in a worker process: one task after another, and nothing that outlives its parent.

Light to import, so that a worker starts fast; what a task needs is imported with the task.

"""

from collections.abc import Callable, Mapping
from multiprocessing.connection import Connection
import os
import signal
import socket
import threading
import time
from typing import Any

from surrogate.task_store import plain_result

Task = Callable[[Mapping[str, Any]], Mapping[str, Any]]
"""A pure function at the top level of a module, from plain JSON to plain JSON."""

_notes: list[Connection] = []


def worker_name() -> str:
    """Return the name of this process, host/pid."""
    return f'{socket.gethostname()}/{os.getpid()}'


def begin_worker(notes: Connection, alive: Connection) -> None:
    """
    Set a worker up: one thread for its kernels, deaf to Ctrl-C, gone when its parent is gone.

    `notes` takes a note when a task is begun; `alive` ends when the parent closes it or dies.

    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ['NUMBA_NUM_THREADS'] = '1'
    _notes[:] = [notes]
    threading.Thread(target=_end_with, args=(alive,), daemon=True).start()


def _end_with(alive: Connection) -> None:
    """Wait for the end of a pipe that the parent alone holds open."""
    try:
        alive.recv_bytes()
    except (EOFError, OSError):
        os._exit(1)


def run_noted(task: Task, name: str, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """Run a task in a worker of a process pool and tell the parent that it is begun."""
    # Short enough to be written in one piece, so workers need no lock that a kill would hold.
    _notes[0].send_bytes(f'{worker_name()} {name}'.encode())
    return run_task(task, name, inputs)


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
