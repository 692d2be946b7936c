# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that does the full solves of a node: started, asked, listened to and ended here."""

import contextlib
import json
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
