# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Worker process: it runs one task after another and never outlives its parent.

Run `python -P -m surrogate.tasks.worker NICENESS MEMORY`, the most memory in bytes, 0 for any.
Frames are lines of JSON. In come `{"task": "module:function", "inputs": INPUTS}` and
`{"cancel": null}`, out go `{"step": STEP}` while the task tells how far it is, and at last what
`run_task` returns. The process is deaf to Ctrl-C and ends with its input, also in the middle of a
task, which ends by SystemExit. Light to import, so that a worker starts fast; a task brings what
it needs.

"""

from collections.abc import Callable, Mapping
from contextvars import ContextVar
import importlib
import json
import os
from pathlib import Path
import queue
import resource
import signal
import socket
import sys
import threading
import time
from typing import Any, TextIO

from surrogate.tasks.child import Frame, Task, UNWIND

AFTER_CALLBACK = 0.02
"""Seconds after which a task that is ended in a callback of C is ended again [s]."""
SHARE_STEP = 0.01
"""A task tells when it has advanced by this share [-]."""
listener: ContextVar[Callable[[Any], object] | None] = ContextVar('listener', default=None)
"""Who hears how far the task is that runs here, if anybody."""
cancelled = threading.Event()
"""Set when the result of the task that runs here is for nobody."""


class ShareTeller:
    """Hands on how far a task is: every step, and of shares no more than is worth it."""

    def __init__(self, send: Callable[[Any], object]) -> None:
        """Begin a task; `send` takes a step, or a share [-]."""
        self._send, self._told = send, 0.0

    def __call__(self, step: Any) -> None:
        """Take a step."""
        if isinstance(step, float):
            if step - self._told < SHARE_STEP:
                return
            self._told = step
        self._send(step)


def tell(step: Any) -> None:
    """Tell those who wait for the task that runs here how far it is, in plain JSON."""
    hear = listener.get()
    if hear is not None:
        hear(step)


def tell_share(share: float) -> None:
    """Tell those who wait for the task that runs here which share of it is done [-]."""
    tell(float(share))


def worker_name() -> str:
    """Return the name of this process, host/pid."""
    return f'{socket.gethostname()}/{os.getpid()}'


def task_name(task: Task) -> str:
    """Return `module:function` of a task, by which another process finds it."""
    module, name = task.__module__, task.__qualname__
    if '.' in name:
        raise TypeError(f'a task is a function at the top level of a module, got {name}')
    if module == '__main__':
        main = sys.modules[module]
        # A script lies in the first folder of the path of its process.
        module = main.__spec__.name if main.__spec__ else Path(str(main.__file__)).stem
    return f'{module}:{name}'


def run_task(name: str, inputs: Mapping[str, Any]) -> Frame:
    """
    Run the task of a name; return its result or its failure in a sentence, worker and seconds.

    A failed task never raises: the others go on.

    """
    began, result, sentence = time.perf_counter(), None, ''
    try:
        module, _, function = name.partition(':')
        result = plain_result(getattr(importlib.import_module(module), function)(inputs))
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
    kind = MemoryError if isinstance(error, MemoryError) else type(error)  # numpy has its own
    return text if is_sentence else f'{kind.__name__}: {text}'


def plain_result(result: Any) -> Any:
    """
    Return a result as it comes back from a worker or a store: dicts, lists, numbers, words.

    Every float comes back bit for bit. Raises TypeError for anything that is not plain JSON.

    """
    if isinstance(result, Mapping):
        if not all(isinstance(key, str) for key in result):
            raise TypeError(f'keys of a result are words, got {list(result)}')
        return {key: plain_result(part) for key, part in result.items()}
    if isinstance(result, list | tuple):
        return [plain_result(part) for part in result]
    if isinstance(result, float):  # numpy's, too
        return float(result)
    if result is None or isinstance(result, str | int):
        return result
    raise TypeError(f'a result is plain JSON, got {type(result).__name__}')


def main() -> None:
    """Run the tasks that come until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def unwind(number: int, frame: Any) -> None:  # what a task has half made is removed
        signal.signal(number, signal.SIG_IGN)  # nothing interrupts the removal
        raise SystemExit(1)

    def unwind_later(lost: 'sys.UnraisableHookArgs') -> None:
        if isinstance(lost.exc_value, SystemExit):  # in a callback of C, which loses exceptions
            signal.setitimer(signal.ITIMER_REAL, AFTER_CALLBACK)
        else:
            sys.__unraisablehook__(lost)

    signal.signal(signal.SIGTERM, unwind)
    signal.signal(signal.SIGALRM, unwind)
    sys.unraisablehook = unwind_later
    niceness, memory = map(int, sys.argv[1:])
    os.nice(niceness)
    if memory:
        resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))
    requests: queue.SimpleQueue[Frame | None] = queue.SimpleQueue()
    frames, out = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), 'w')
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    lock = threading.Lock()

    def send(frame: Frame) -> None:
        text = json.dumps(frame) + '\n'
        try:
            with lock:
                out.write(text)
                out.flush()
        except OSError:
            os._exit(0)  # nobody reads

    threading.Thread(target=_listen, args=(frames, requests), daemon=True).start()
    try:
        while (request := requests.get()) is not None:
            listener.set(ShareTeller(lambda step: send({'step': step})))
            send(run_task(request['task'], request['inputs']))
    except SystemExit:
        os._exit(1)  # at once: the other thread may hold the input
    os._exit(0)


def _listen(frames: TextIO, requests: 'queue.SimpleQueue[Frame | None]') -> None:
    for line in frames:
        frame = json.loads(line)
        if 'task' in frame:
            cancelled.clear()
            requests.put(frame)
        else:
            cancelled.set()
    # The parent is gone or wants no more, whatever the task is at.
    requests.put(None)
    # To the main thread itself: another one does not wake it from what it waits for.
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)
    time.sleep(UNWIND)  # the process may end meanwhile
    os._exit(1)


if __name__ == '__main__':
    # As the module that tasks import, so that there is one listener.
    importlib.import_module('surrogate.tasks.worker').main()
