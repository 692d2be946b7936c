# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The monitor node as a child process that never outlives its parent."""

import os
from pathlib import Path
import resource
import signal
import subprocess

from ballscrew_monitor.settings.middleware import loopback
from surrogate.tasks.child import path_to_this_code, start, stop, WHEEL_VARIABLES

PATIENCE = ((signal.SIGINT, 30.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 5.0))  # [s] after each


class NodeProcess:
    """The node, its log in a file; it is gone after `stop`."""

    def __init__(self, params: Path, log: Path, *, domain: int) -> None:
        """Start the node on simulated time in `domain`; call this from the main thread."""
        self.log = log
        with log.open('wb') as stream:
            self._process = start(
                *('ballscrew_monitor.node', '--ros-args', '--params-file', str(params)),
                *('-p', 'use_sim_time:=true'),
                # Every run is the same: none takes up what solves of an earlier one corrected.
                *('-p', "state_dir:=''"),
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                env=child_environment(domain) | {'PYTHONPATH': path_to_this_code()},
            )

    @property
    def returncode(self) -> int | None:
        """Return the exit code, negative for a signal; None while it runs."""
        return self._process.poll()

    @property
    def pid(self) -> int:
        """Return the process id, which is that of its session too."""
        return self._process.pid

    def stop(self) -> int:
        """End the node and all it started: asked, then told, then killed; return its code."""
        return stop(self._process, PATIENCE)

    @property
    def cpu_time(self) -> float:
        """Return the processor time of the children of this process that have ended [s]."""
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    def last_words(self) -> str:
        """Return the last line of the log, empty if there is none."""
        lines = self.log.read_text(errors='replace').strip().splitlines()
        return lines[-1].strip() if lines else ''


def child_environment(domain: int) -> dict[str, str]:
    """Return the environment of a child process in `domain`."""
    environment = dict(os.environ)
    if '_ROS_WHEELS_BOOTSTRAP_COMPLETE' in environment:
        for name in WHEEL_VARIABLES:
            environment.pop(name, None)
    return environment | confined(domain) | {'PYTHONUNBUFFERED': '1'}


def confined(domain: int) -> dict[str, str]:
    """Return the variables that put a process into `domain`, all its ports on 127.0.0.1."""
    return ros_environment(domain) | loopback()


def ros_environment(domain: int) -> dict[str, str]:
    """Return the variables with which a ROS process finds those in `domain` on this machine."""
    return {'ROS_DOMAIN_ID': str(domain), 'ROS_AUTOMATIC_DISCOVERY_RANGE': 'LOCALHOST'}
