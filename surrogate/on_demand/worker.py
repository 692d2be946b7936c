# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A process that solves operating points, one after another.

Run `python -P -m surrogate.on_demand.worker PARENT`, the number of the process that asks. Frames
are lines of JSON. In come `{"solve": REQUEST}` and `{"cancel": null}`, out go `{"progress": STEP}`
and at last `{"solved": RESULT}`, `{"failed": SENTENCE}` or `{"cancelled": null}`. The process is
nice to others, runs one thread, is deaf to Ctrl-C, and ends with its input or its parent. It knows
nothing of ROS.

"""

from collections.abc import Callable, Mapping
import ctypes
import json
import os
import queue
import resource
import signal
import sys
import threading
import time
from typing import Any, TextIO

from surrogate.files import to_json

NICENESS = 10
MEMORY = 6 * 2**30
"""Most memory that the process may use [B]."""
PR_SET_PDEATHSIG = 1
PAUSE = 0.2
"""Shortest time between two reports of progress [s]."""


class Mailbox:
    """Requests as they come, and whether the one at work has been taken back."""

    def __init__(self, stream: TextIO) -> None:
        """Begin to read frames; the process ends with the stream."""
        self._requests: queue.Queue[Mapping[str, Any]] = queue.Queue(maxsize=1)
        self.cancelled = threading.Event()
        threading.Thread(target=self._read, args=(stream,), daemon=True).start()

    def _read(self, stream: TextIO) -> None:
        for line in stream:
            frame = json.loads(line)
            if 'solve' in frame:
                self.cancelled.clear()
                self._requests.put(frame['solve'])
            else:
                self.cancelled.set()
        os._exit(0)  # the parent is gone or wants no more, whatever the solver is at

    def take(self) -> Mapping[str, Any]:
        """Wait for a request."""
        return self._requests.get()


def main() -> None:
    """Serve requests until the input ends."""
    _settle()
    # What any library prints must not come between the frames.
    out = os.fdopen(os.dup(sys.stdout.fileno()), 'w')
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    mailbox = Mailbox(sys.stdin)
    while True:
        request = mailbox.take()
        _send(out, _answer(request, mailbox, out))


def _settle() -> None:
    """Let the process be no burden to others, and not outlive its parent."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != int(sys.argv[1]):  # it was gone before that
        os._exit(0)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.nice(NICENESS)
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))


def _answer(request: Mapping[str, Any], mailbox: Mailbox, out: TextIO) -> dict[str, Any]:
    """Solve a request; whatever fails is a sentence, and the process goes on."""
    # The solver is heavy: it is loaded with the first request and not before.
    from surrogate.on_demand.solve import Cancelled, solve_point, solved_frame

    try:
        found = solve_point(request, progress=_reporter(out), cancel=mailbox.cancelled.is_set)
    except Cancelled:
        return {'cancelled': None}
    except MemoryError:
        return {'failed': f'the solve needs more than {MEMORY / 2**30:g} GiB of memory'}
    except Exception as error:  # whatever it is, it belongs to this request alone
        return {'failed': ' '.join(f'{type(error).__name__}: {error}'.split())}
    return {'solved': solved_frame(found)}


def _reporter(out: TextIO) -> Callable[[Mapping[str, Any]], None]:
    """Return what sends progress on, though not more often than anyone can read."""
    last = -PAUSE

    def report(step: Mapping[str, Any]) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= PAUSE:
            last = now
            _send(out, {'progress': step})

    return report


def _send(out: TextIO, frame: Mapping[str, Any]) -> None:
    try:
        out.write(json.dumps(to_json(frame), allow_nan=False) + '\n')
        out.flush()
    except BrokenPipeError:
        os._exit(0)


if __name__ == '__main__':
    main()
