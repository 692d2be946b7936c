# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The process that writes the recording of a node, so that no judgement waits for a disk.

Run `python -P -m ballscrew_monitor.recordings.black_box FOLDER SETTINGS`, the settings as JSON.
Frames come in on standard input, and each change of what is wrong goes out as a line. The process
is deaf to Ctrl-C, finishes its recording when the node is gone, however that ended, and knows no
ROS.

"""

import json
import os
from pathlib import Path
import signal
import sys
import time

from ballscrew_monitor.recordings.frames import read_frames
from ballscrew_monitor.recordings.retention import KeepSettings, Retention

NICENESS = 5


def main() -> None:
    """Keep what comes until the input ends."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    os.nice(NICENESS)
    retention = Retention(Path(sys.argv[1]), KeepSettings(**json.loads(sys.argv[2])))
    said = ''
    for frame in read_frames(sys.stdin.buffer):
        retention.take(frame, time.monotonic())
        said = _say(retention.problem, said)
    retention.close()
    _say(retention.problem, said)


def _say(problem: str, said: str) -> str:
    """Tell the node of a change; it may be gone."""
    if problem != said:
        try:
            print(problem, flush=True)
        except OSError:
            pass
    return problem


if __name__ == '__main__':
    main()
